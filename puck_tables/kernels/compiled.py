"""The one door to numba: how every compiled function of the package is made and cached."""

from __future__ import annotations

import gc
from collections.abc import Callable
from functools import partial
from typing import Any, TypeVar

import numba
from numba import types
from numba.core import event

from puck_tables.kernels.cache import compiling
from puck_tables.kernels.kept_code import KeptCode
from puck_tables.kernels.linking import LinkedAtDoors

Function = TypeVar("Function", bound=Callable[..., Any])


class _Announcer(event.Listener):
    """Hears of what is compiled anew; what is only pasted into others is soon done.

    Compiling makes millions of small objects that live until it ends.  To look through them again
    and again for garbage takes a sixth of the time, so that it is done less often meanwhile.
    """

    def __init__(self) -> None:
        self._found: list[tuple[int, int, int]] = []

    def on_start(self, event: Any) -> None:
        self._found.append(gc.get_threshold())
        gc.set_threshold(100_000, *self._found[-1][1:])
        if type(event.data["dispatcher"]._cache).__name__ != "NullCache":
            compiling()

    def on_end(self, event: Any) -> None:
        gc.set_threshold(*self._found.pop())


event.register("numba:compile", _Announcer())  # type: ignore[no-untyped-call]


def kernel(function: Function) -> Function:
    """Compile a function: no Python objects, no GIL, IEEE rules except fused multiply-add.

    It works in the arrays that it is given, and neither makes arrays nor gives any to a function
    that does: it is compiled without counting references, which in a loop over small steps takes
    longer than the steps.  Division by zero gives inf or NaN as in NumPy; kernels report trouble by
    status codes.
    """
    return _compile(function, forceinline=False, counts=False)


def inlined(function: Function) -> Function:
    """Compile a kernel that is pasted into every caller, so that loops over it vectorise.

    The callers keep what was compiled; it needs no cache of its own, and no door to Python, which
    would take a third of the time to compile it.  Called from Python it runs as it is written.
    """
    return _compile(function, forceinline=True, counts=False)


def inner(function: Function) -> Function:
    """Compile a kernel that only kernels call: without a door to Python, as :func:`inlined`.

    A door unpacks every array of every record that is handed in, which takes longer to compile
    than many a function; for what is too long to be pasted into each caller.  A function without a
    door is optimised with those behind which it lies (:mod:`puck_tables.kernels.linking`).
    """
    return _compile(function, forceinline=False, counts=False, door=False)


def allocating(function: Function) -> Function:
    """Compile a function that makes arrays; it calls kernels that return numbers only."""
    return _compile(function, forceinline=False, counts=True)


def _compile(function: Function, forceinline: bool, counts: bool, door: bool = True) -> Function:
    door = door and not forceinline
    options: dict[str, Any] = {
        "forceinline": forceinline, "_nrt": counts,
        "no_cpython_wrapper": not door, "no_cfunc_wrapper": not door,
    }  # fmt: skip
    compiled: Any = numba.njit(
        nogil=True, fastmath={"contract"}, error_model="numpy", pipeline_class=LinkedAtDoors,
        **options,
    )(function)  # fmt: skip
    compiled.get_call_template = partial(_whatever_its_value, compiled.get_call_template)
    if not door:
        compiled._insert = _not_entered
        compiled._compile_for_args = lambda *_, **__: function
    else:
        compiled._cache = KeptCode(function)
    return compiled


def _whatever_its_value(template_for: Callable[..., Any], args: Any, named: Any) -> Any:
    """Compile for any number where a constant is handed in, not for each constant anew."""
    of_any = tuple(types.unliteral(kind) for kind in args)  # type: ignore[no-untyped-call]
    return template_for(of_any, named)


def _not_entered(*_: Any, **__: Any) -> None:
    """What is compiled for other kernels has no door to Python."""

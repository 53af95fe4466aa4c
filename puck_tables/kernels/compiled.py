"""The one door to numba: how every compiled function of the package is made and cached."""

from __future__ import annotations

import contextlib
import gc
import sys
from collections.abc import Callable, Iterator
from functools import partial, update_wrapper
from types import FunctionType
from typing import Any, Protocol

import numba
from numba import types
from numba.core import event
from numba.core.compiler_lock import global_compiler_lock
from numba.core.registry import cpu_target
from numba.core.typing.typeof import typeof_impl

from puck_tables.kernels import (
    as_written,
    records,  # noqa: F401 - numba knows them from then on
    register_blocks,
    vectors,
)
from puck_tables.kernels.as_written import behind
from puck_tables.kernels.cache import cache_folder, is_importable
from puck_tables.kernels.on_demand import put_cell, type_of_call
from puck_tables.kernels.patience import patience

# private parts of numba, worth it while they are there: 2.5 to 3 times the first compile of scenes,
# and a cache that is safe
linked_at_doors: Any = None
kept_code: Any = None
quick: Any = contextlib.nullcontext
fingerprint: Any = None
with contextlib.suppress(ImportError, AttributeError):
    from puck_tables.kernels.linking import CALLED_LATE, Called, is_for_another, put_at
    from puck_tables.kernels.linking import LinkedAtDoors as linked_at_doors
with contextlib.suppress(ImportError, AttributeError):
    from puck_tables.kernels.kept_code import KeptCode as kept_code
with contextlib.suppress(ImportError, AttributeError):
    from puck_tables.kernels.quick_compiler import quick
with contextlib.suppress(ImportError):
    from numba._dispatcher import compute_fingerprint as fingerprint
_settings: Any = numba.config
_DEEP = 100_000  # words of a frame, for which Python takes 1 MB of stack at once


class _Announcer(event.Listener):
    """Hears of what is compiled anew.

    Compiling makes millions of small objects that live until it ends.  To look through them again
    and again for garbage takes a fifth of the time, so that it is hardly done meanwhile, which
    takes up to 100 MB.
    """

    def __init__(self) -> None:
        self._thresholds: list[tuple[int, int, int]] = []

    def on_start(self, event: Any) -> None:
        self._thresholds.append(gc.get_threshold())
        gc.set_threshold(1_000_000, *self._thresholds[-1][1:])

    def on_end(self, event: Any) -> None:
        if self._thresholds:  # none where a function of somebody else's began before this was here
            gc.set_threshold(*self._thresholds.pop())


event.register("numba:compile", _Announcer())  # type: ignore[no-untyped-call]

# what numba cannot write, by what stands for it in Python
_intrinsics: dict[Any, Any] = {patience: vectors.patience} | {
    getattr(as_written, name): one
    for module in (register_blocks, vectors)
    for name, one in vars(module).items()
    if hasattr(one, "_defn") and hasattr(as_written, name)
}
_dispatchers: dict[tuple[Any, bool], Any] = {}
_entries: dict[tuple[Any, bytes], Any] = {}
_whole: dict[Any, Any] = {}  # kernels that functions of others link
_late: dict[Any, Any] = {}  # types of kernels that are compiled on demand


def _deep(function: Callable[..., Any]) -> Callable[..., Any]:
    """A function within which calls lie deep.

    Else Python takes each piece of its stack from the system, and gives it back, at every call that
    crosses the border of two: 400,000 times while a scene is compiled, a tenth of the time.
    """

    def run(*args: Any) -> Any:
        return function(*args)

    run.__code__ = run.__code__.replace(co_stacksize=_DEEP)
    return update_wrapper(run, function)


class KernelDoor(Protocol):
    """What is read of a :class:`puck_tables.kernels.compile.Door`, which stands above."""

    py_func: Any
    counts: bool
    fuses: bool
    returns: tuple[str, ...]

    @property
    def compiled(self) -> Any:
        """Numba's object for it."""

    def announce(self) -> None:
        """Say that it is compiled."""

    def callable_for(self, *args: Any) -> Callable[..., Any]:
        """What to call with such arguments."""


@contextlib.contextmanager
def _compiling(door: KernelDoor) -> Iterator[None]:
    """What is compiled within may fuse a·b + c or not, as its door wants it."""
    lock: Any = global_compiler_lock
    with lock, quick():
        before, vectors.fuses = vectors.fuses, door.fuses
        try:
            yield
        finally:
            vectors.fuses = before


def type_at(door: KernelDoor) -> Any:
    """What a kernel that Python calls is to those that call it."""
    if linked_at_doors is not None and not linked_at_doors.has_doors:
        return types.Dispatcher(dispatcher_of(door.py_func, door.fuses))
    if not (door.returns and linked_at_doors and kept_code):  # numba's cache keeps no cells
        return types.Dispatcher(_linked_whole(door) if _is_linked() else door.compiled)
    if door not in _late:
        _late[door] = type_of_call(door.py_func, door.returns, partial(_symbol_for, door))
    return _late[door]


def _is_linked() -> bool:
    """Whether who calls a kernel links it, as functions do that are not of the package."""
    return bool(linked_at_doors and kept_code) and is_for_another()


def _linked_whole(door: KernelDoor) -> Any:
    """Numba's object for such a kernel: kept code is not there to be linked."""
    if door not in _whole:
        _whole[door] = _dispatcher(door.py_func, door.fuses, door=True, counts=door.counts)
        _whole[door].get_call_template = partial(_at_door, door, _whole[door].get_call_template)
    return _whole[door]


def _symbol_for(door: KernelDoor, kinds: tuple[Any, ...]) -> str:
    """Under which the address of a kernel for such arguments is found."""
    name = f"{door.py_func.__module__}.{door.py_func.__qualname__}"
    symbol = f"{name}({', '.join(map(str, kinds))})"
    CALLED_LATE[symbol] = Called(door.py_func.__module__, door.py_func.__qualname__, kinds, symbol)
    put_cell(symbol, partial(_address_of, door, kinds))
    return symbol


@_deep
def _address_of(door: KernelDoor, kinds: tuple[Any, ...]) -> int:
    """Where a kernel for such arguments is, compiled or read."""
    target: Any = cpu_target.target_context
    if not (kinds in door.compiled.overloads or door.compiled._cache.keeps(kinds, target)):
        door.announce()
    with _compiling(door):
        door.compiled.compile(kinds)
    code = door.compiled.overloads[kinds]
    return code.library.get_pointer_to_function(code.fndesc.llvm_func_name)


@typeof_impl.register(FunctionType)
def _type_of_function(function: Any, purpose: Any) -> Any:
    """A kernel is its compiled code, where kernels call it."""
    if function in behind and not _is_linked():  # it has no address that others could call
        return types.Dispatcher(dispatcher_of(function, vectors.fuses))
    if function in _intrinsics:
        context: Any = cpu_target.typing_context
        return context.resolve_value_type(_intrinsics[function])
    return typeof_impl.dispatch(object)(function, purpose)


def dispatcher_of(function: Any, fuses: bool) -> Any:
    """Numba's object for a kernel that only kernels call."""
    if (function, fuses) not in _dispatchers:
        made = _dispatcher(function, fuses, door=False, pasted=behind.get(function, False))
        made.get_call_template = partial(_whatever_its_value, made.get_call_template)
        if linked_at_doors:
            made._insert = lambda *_, **__: None  # it has no door to Python
        _dispatchers[function, fuses] = made
    return _dispatchers[function, fuses]


def dispatcher_at(door: KernelDoor) -> Any:
    """Numba's object for a kernel that Python calls."""
    made = _dispatcher(door.py_func, door.fuses, door=True, counts=door.counts)
    made.get_call_template = partial(_at_door, door, made.get_call_template)
    if kept_code:
        made._cache = kept_code(door.py_func, _put_at_hand)
    elif (folder := cache_folder()) is not None:  # named by the sources: it sees no edit elsewhere
        _settings.CACHE_DIR = str(folder)
        made.enable_caching()
    made._compile_for_args = door.callable_for  # asked where nothing was compiled for arguments
    return made


def _dispatcher(
    function: Any, fuses: bool, door: bool, pasted: bool = False, counts: bool = False
) -> Any:
    options: dict[str, Any] = {"fastmath": {"contract"} if fuses else False}
    if linked_at_doors:
        options |= {
            "forceinline": pasted, "_nrt": counts, "pipeline_class": linked_at_doors,
            "no_cpython_wrapper": not door, "no_cfunc_wrapper": not door,
        }  # fmt: skip
    return numba.njit(nogil=True, error_model="numpy", **options)(function)


def keeps(dispatcher: Any, args: tuple[Any, ...]) -> bool:
    """Whether code for such arguments was compiled in this process, or is kept on disk."""
    kinds = tuple(dispatcher.typeof_pyval(one) for one in args)
    if kinds in dispatcher.overloads:
        return True
    return bool(kept_code and dispatcher._cache.keeps(kinds, dispatcher.targetctx))


def entry_for(dispatcher: Any, args: tuple[Any, ...]) -> Any:
    """The compiled code for such arguments, which looks at no types; None where there is none."""
    if fingerprint is None:
        return None
    request = dispatcher, fingerprint(args)  # 9 µs; their types of a board 0.8 ms
    if request not in _entries:
        code = dispatcher.overloads.get(tuple(dispatcher.typeof_pyval(one) for one in args))
        if code is None:
            return None
        _entries[request] = code.entry_point
    return _entries[request]


@_deep
def code_for(door: KernelDoor, args: tuple[Any, ...]) -> Callable[..., Any]:
    """Compiled code for such arguments, from disk if it is kept."""
    with _compiling(door):
        code: Callable[..., Any] = type(door.compiled)._compile_for_args(door.compiled, *args)
    return code


def _at_door(door: KernelDoor, template_for: Callable[..., Any], args: Any, named: Any) -> Any:
    with _compiling(door):
        template = _whatever_its_value(template_for, args, named)
    if linked_at_doors and kept_code:  # numba's own cache would not bring the door along
        # a library says at which door it is, so that it is called and not linked
        function = door.py_func
        for kinds, code in door.compiled.overloads.items() if is_importable(function) else ():
            place = function.__module__, function.__qualname__
            code.library.door = Called(*place, kinds, code.fndesc.llvm_func_name)
    return template


def _put_at_hand(called: Any) -> None:
    """Put a door, compiled or read, at the symbol under which kept code calls it."""
    door = getattr(sys.modules[called.module], called.name)  # whoever calls it has imported it
    if door.returns:
        _symbol_for(door, called.kinds)
        return
    with _compiling(door):
        door.compiled.compile(called.kinds)
    code = door.compiled.overloads[called.kinds]
    put_at(called.symbol, code)


def _whatever_its_value(template_for: Callable[..., Any], args: Any, named: Any) -> Any:
    """Compile for any number where a constant is handed in, not for each constant anew."""
    of_any = tuple(types.unliteral(kind) for kind in args)  # type: ignore[no-untyped-call]
    return template_for(of_any, named)

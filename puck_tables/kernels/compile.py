"""What the package's kernels are made with: compiled by numba, or left as they are written.

What Python calls of them it runs as they are written, or compiled.  A kernel stays the function
that is written there; how it is to be compiled is noted beside it, and read by
:mod:`puck_tables.kernels.compiled` when that is needed.  Only what Python calls is wrapped.
"""

from __future__ import annotations

import os
import re
import sys
import threading
import time
import warnings
from collections.abc import Callable, Iterator
from functools import cached_property, update_wrapper
from typing import Any, TypeVar

import numpy as np

from puck_tables._core.own_folder import say
from puck_tables.errors import InputError, PuckError
from puck_tables.kernels.as_written import (
    BLOCK,
    LINE,
    as_written,
    behind,
    bits_of,
    into_line,
    into_row,
    into_rows,
    number_of,
    row_of,
    rows_of,
    spline_polynomials,
    spline_slopes,
    spline_values,
    stream_line,
    summed,
    turn_square,
    weighted_rows,
)
from puck_tables.kernels.cache import is_any_kept
from puck_tables.kernels.patience import AT_FIRST, OutOfPatience, here, patience

Function = TypeVar("Function", bound=Callable[..., Any])

_PER_INSTRUCTION = 3e-4  # s, to compile an instruction of Python; of some machine
_TO_LOAD_NUMBA = 0.6  # s, of such a machine
_SAID = 0.5  # s; what takes less is not worth a sentence
_SILENT = 1.0  # s of computing as it is written; then it is said, as other kernels take as long
_WORTH = 0.4  # of the time of compiling that is tried without: so little is lost where it ends so
_WORTH_OF_ARRAYS = 3.3  # of it where arrays answer, which mostly are done by then
_importing = threading.RLock()
# of the environment, what ends numba in the middle of its import: how it must look, and in words
_FATAL = {
    "NUMBA_NUM_THREADS": (r"\s*\+?0*[1-9]\d*\s*", "a whole number from 1 on"),
    "NUMBA_CPU_FEATURES": (r"([+-][\w.-]+(,[+-][\w.-]+)*)?", "features like +avx2,-fma"),
}
# and what numba does not understand and leaves out
_NOT_UNDERSTOOD = re.compile(r"Environment variable '(\w+)'")
_unusable: set[str] = set()

__all__ = [
    "BLOCK", "LINE", "allocating", "arrays_at_first", "bits_of", "entry_of", "inlined", "inner",
    "into_line", "into_row", "into_rows", "kernel", "look_up", "number_of", "on_demand", "patience",
    "row_of", "rows_of", "spline_polynomials", "spline_slopes", "spline_values", "stream_line",
    "summed", "turn_square", "weighted_rows",
]  # fmt: skip


class Door:
    """A kernel that Python calls.

    ``counts``: references to arrays; ``fuses``: a·b + c is rounded once where the machine can;
    ``at_first``: what runs at first in place of the function as it is written; ``returns``: the
    types of the numbers that it gives, if it is compiled on demand of compiled code.
    """

    def __init__(self, function: Callable[..., Any], counts: bool, fuses: bool) -> None:
        update_wrapper(self, function)
        self.at_first = function
        self.returns: tuple[str, ...] = ()
        self.py_func, self.counts, self.fuses = function, counts, fuses
        self.spent = 0.0  # s of computing, as it is written
        self._ready: Any = None

    def __call__(self, *args: Any) -> Any:
        """Run it."""
        if here.as_written:
            return self.at_first(*args)
        if self._ready is not None:
            return self._ready(*args)
        return self.callable_for(*args)(*args)

    def __reduce__(self) -> str:
        return self.py_func.__qualname__

    @property
    def compiled(self) -> Any:
        """Of numba, with what was compiled in this process."""
        if self._ready is None:
            with _importing:
                self._ready = _from_numba().dispatcher_at(self)
        return self._ready

    @property
    def _numba_type_(self) -> Any:
        """What it is to kernels that call it."""
        return _from_numba().type_at(self)

    def callable_for(self, *args: Any) -> Callable[..., Any]:
        """What to call with such arguments: it, as it is written at first, or its compiled code."""
        if here.at_once or (here.kept_first and self._keeps(args)) or self.spent >= self._allowed:
            return self._compile(*args)
        return self._try

    def entry(self, *args: Any) -> Callable[..., Any] | None:
        """What runs it for arguments of just these types, None where nothing is compiled yet."""
        return None if self._ready is None else _from_numba().entry_for(self._ready, args)

    @property
    def _allowed(self) -> float:
        """How long it may run as it is written, s: the longer, the longer compiling takes."""
        if is_any_kept(self.py_func):
            return AT_FIRST
        worth = _WORTH if self.at_first is self.py_func else _WORTH_OF_ARRAYS
        return max(AT_FIRST, worth * self.seconds)

    def _keeps(self, args: tuple[Any, ...]) -> bool:
        """Whether compiled code for such arguments is there, in this process or on disk."""
        there = self._ready is not None or is_any_kept(self.py_func)
        return there and bool(_from_numba().keeps(self.compiled, args))

    def _compile(self, *args: Any) -> Callable[..., Any]:
        if not self._keeps(args):
            self.announce()
        return _from_numba().code_for(self, args)

    def announce(self) -> None:
        """Say that it is compiled, if that takes a while."""
        if self.seconds > _SAID:
            say(self._announcement)

    @property
    def _name(self) -> str:
        return f"{self.py_func.__module__}.{self.py_func.__qualname__}"

    @cached_property
    def _announcement(self) -> str:
        """What is said before it is compiled: the same by whichever thread."""
        wait = self.seconds + (0.0 if "numba" in sys.modules else _TO_LOAD_NUMBA)
        return f"compiling {self._name} for this machine, once: about {wait:.2g} s"

    def _try(self, *args: Any) -> Any:
        """Run it as it is written while patience lasts, or else compiled from the same arguments.

        Compiled code has inf or NaN where Python refuses; a broken power of a negative number is
        complex here.
        """
        before = [(array, array.copy()) for array in arrays_in(args) if array.flags.writeable]
        begin = time.thread_time()
        here.as_written, here.until = True, begin + self._allowed - self.spent
        here.silent_until = min(here.until, begin + _SILENT - self.spent)
        here.sentence = (
            f"{self._name} is not compiled: it runs in Python, up to {self._allowed:.0f} s"
        )
        try:
            with np.errstate(all="ignore"):
                result = self.at_first(*args)
            if not _is_complex(result):
                return result
        except (OutOfPatience, ArithmeticError, ValueError, TypeError) as error:
            if isinstance(error, PuckError):
                raise
        except BaseException:
            _put_back(before)
            raise
        finally:
            here.as_written = False
            self.spent += time.thread_time() - begin
        _put_back(before)
        return self._compile(*args)(*args)

    @cached_property
    def seconds(self) -> float:
        """How long compiling takes, roughly: by what is written, here and in what it calls."""
        return _PER_INSTRUCTION * sum(len(one.__code__.co_code) // 2 for one in _called(self))


def _called(door: Door) -> set[Any]:
    """The function behind a door, and all kernels that it calls and that are not kept."""
    result: set[Any] = set()
    waiting: list[Any] = [door.py_func]
    while waiting:
        function = waiting.pop()
        if function not in result:
            result.add(function)
            cells = (cell.cell_contents for cell in function.__closure__ or ())
            names = (function.__globals__.get(name) for name in function.__code__.co_names)
            for one in (*cells, *names):
                if isinstance(one, Door):
                    if not one.returns and not is_any_kept(one.py_func):
                        waiting.append(one.py_func)
                elif callable(one) and one in behind:
                    waiting.append(one)
    return result


def arrays_in(values: tuple[Any, ...]) -> Iterator[Any]:
    """The arrays among arguments, and in tuples of them."""
    for value in values:
        if isinstance(value, np.ndarray):
            yield value
        elif isinstance(value, tuple):
            yield from arrays_in(value)


def _put_back(before: list[tuple[Any, Any]]) -> None:
    for array, copy in before:
        array[...] = copy


def _is_complex(result: Any) -> bool:
    """Whether a number is complex, or one of a tuple."""
    if isinstance(result, tuple):
        return any(_is_complex(one) for one in result)
    return isinstance(result, complex)


def _from_numba() -> Any:
    """What compiles, loaded by one thread; errors as of :func:`read_settings`."""
    with _importing:
        if "puck_tables.kernels.compiled" not in sys.modules:
            read_settings()
        from puck_tables.kernels import compiled

    return compiled


def _door(function: Function, counts: bool, fuses: bool = False) -> Function:
    made: Any = function if as_written() else Door(function, counts, fuses)
    return made


def entry_of(made: Callable[..., Any], *args: Any) -> Callable[..., Any] | None:
    """What runs a kernel for arguments of just these types, None where it is not compiled.

    For who calls it often with the same record: to look at a hundred arrays takes 9 µs, the call
    itself 2.
    """
    return made.entry(*args) if isinstance(made, Door) and not here.as_written else None


def kernel(function: Function) -> Function:
    """A function for the compiler: no Python objects, no GIL, IEEE rules: the bits of Python.

    It works in the arrays that it is given, and neither makes arrays nor gives any to a function
    that does: it is compiled without counting references, which in a loop over small steps takes
    longer than the steps.  Division by zero gives inf or NaN as in NumPy; kernels report trouble by
    status codes.
    """
    return _door(function, counts=False)


def allocating(function: Function) -> Function:
    """A function for the compiler that makes arrays; it calls kernels that return numbers only."""
    return _door(function, counts=True)


def arrays_at_first(arrays: Callable[..., Any]) -> Callable[[Function], Function]:
    """A kernel in whose place arrays answer until compiling it pays.

    ``arrays``: takes what the kernel takes, and gives the same or fills the same outputs, by NumPy.
    """

    def door(made: Function) -> Function:
        one: Any = made
        if not isinstance(one, Door):
            return arrays  # type: ignore[return-value]
        one.at_first = arrays
        return made

    return door


def on_demand(*returns: str) -> Callable[[Function], Function]:
    """A kernel of a module that compiled code compiles when it first calls it: few scenes need it.

    ``returns``: the types of the numbers that it gives.  For what takes seconds to compile: a call
    takes a few ns more.
    """

    def door(function: Function) -> Function:
        if "<locals>" in function.__qualname__:
            raise TypeError("only a kernel of a module is found again by its name")
        made: Any = kernel(function)
        if isinstance(made, Door):
            made.returns = returns
        return made

    return door


def look_up(function: Function) -> Function:
    """A kernel as :func:`allocating` that reads a table for many: it may fuse products and sums.

    That takes a tenth to a sixth off it, and changes last bits.
    """
    return _door(function, counts=True, fuses=True)


def inlined(function: Function) -> Function:
    """A kernel that is pasted into every caller, so that loops over it vectorise.

    The callers keep what was compiled; it needs no cache of its own, and no door to Python, which
    would take a third of the time to compile it.  Called from Python it runs as it is written.
    """
    behind[function] = True
    return function


def inner(function: Function) -> Function:
    """A kernel that only kernels call: without a door to Python, as :func:`inlined`.

    A door unpacks every array of every record that is handed in, which takes longer to compile
    than many a function; for what is too long to be pasted into each caller.  A function without a
    door is optimised with those behind which it lies (:mod:`puck_tables.kernels.linking`).
    """
    behind[function] = False
    return function


def read_settings() -> None:
    """Import numba; InputError if it cannot use the environment variables set for it."""
    for name, (form, words) in _FATAL.items():
        value = os.environ.get(name)
        if value is not None and not re.fullmatch(form, value):
            raise InputError(f"{name}={value}: set it to {words}, or not at all")
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        import numba  # noqa: F401 - it reads them as it is imported
    result = (_NOT_UNDERSTOOD.match(str(one.message)) for one in said)
    _unusable.update(match[1] for match in result if match)
    for name in sorted(_unusable):
        raise InputError(f"{name}={os.environ.get(name)}: numba cannot use it; leave it out")

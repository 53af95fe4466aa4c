"""Compiled code on disk: one sealed file for each function and types of arguments.

numba's own cache trusts whatever its files hold: a flipped bit in machine code computes wrong
numbers in silence, one in its index ends the program, and of two processes that save at once one
may find the code of the other's types under its own.  Here a file holds what it is for, and nothing
is opened that does not match its digest; what is missing or damaged is compiled anew; the folder is
that of :func:`puck_tables.kernels.cache.cache_folder`, which only this user can write.  (The digest
proves a file whole; that nobody else made it is for the folder to prove.)  A wheel for one kind of
machine brings such files along, made for the oldest processors that it serves: see
:class:`MadeFor`.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import platform
import sys
import tempfile
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numba
from llvmlite import binding, ir
from numba.core import serialize
from numba.core.compiler import CompileResult

from puck_tables.kernels.cache import brought_folder, cache_folder, file_stem, is_importable

_DIGEST = hashlib.sha256().digest_size
_dumps: Any = serialize.dumps
_settings: Any = numba.config


class KeptCode:
    """The place of one function's compiled code, as numba's dispatchers ask for it.

    ``at_hand``: puts a door that it calls at the symbol under which it does.
    """

    def __init__(self, function: Callable[..., Any], at_hand: Callable[[Any], None]) -> None:
        self._function, self._at_hand = function, at_hand
        self._name = file_stem(function)

    @property
    def cache_path(self) -> str | None:
        """The folder."""
        folder = cache_folder()
        return None if folder is None else str(folder)

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """What was compiled for a signature, or None."""
        _leave_out_blas()
        target_context.refresh()
        for path, key in self._places(sig, target_context.codegen()):
            # not there, or whatever numba's objects raise
            with contextlib.suppress(Exception):
                content = read_sealed(path)
                if content is None:
                    continue
                kept_key, calls, payload = serialize.loads(content)
                if kept_key != key:
                    continue
                for called in calls:
                    self._at_hand(called)
                result: Any = CompileResult
                return result._rebuild(target_context, *payload)
        return None

    def keeps(self, sig: Any, target_context: Any) -> bool:
        """Whether a file is there that was made for a signature."""
        return any(path.exists() for path, _ in self._places(sig, target_context.codegen()))

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep what was compiled for a signature, unless the disk is full."""
        folder = cache_folder()
        if folder is None or data.lifted or data.library.has_dynamic_globals:
            return  # addresses in it hold for this process only
        parts = _taken_apart(data, is_importable(self._function))
        self.keep(folder, sig, data.codegen.magic_tuple(), data.library, parts)

    def keep(
        self, folder: Path, sig: Any, target: tuple[str, ...], library: Any, parts: tuple[Any, ...]
    ) -> None:
        """Write what was compiled for a signature and a machine, taken apart."""
        key = self._key(sig, target)
        write_sealed(self._path(folder, key), _dumps((key, getattr(library, "calls", ()), parts)))

    def _places(self, sig: Any, codegen: Any) -> Iterator[tuple[Path, tuple[str, ...]]]:
        """Where it may be, and what is written there: this user's folder, then what came along."""
        machine, brought = codegen.magic_tuple(), brought_for()
        for folder, target in ((cache_folder(), machine), (brought_folder(), brought)):
            if folder is not None and target is not None:
                key = self._key(sig, target)
                yield self._path(folder, key), key

    def _key(self, sig: Any, target: tuple[str, ...]) -> tuple[str, ...]:
        """All that the compiled code depends on besides the sources of the package."""
        enclosed = [cell.cell_contents for cell in self._function.__closure__ or ()]
        return (
            self._name, str(sig), repr(target), repr(enclosed), numba.__version__,
            str(sys.implementation.cache_tag), repr(_settings.BOUNDSCHECK), repr(_settings.OPT),
        )  # fmt: skip

    def _path(self, folder: Path, key: tuple[str, ...]) -> Path:
        return folder / f"{self._name}-{hashlib.sha256(repr(key).encode()).hexdigest()[:16]}.code"


def _taken_apart(data: Any, by_symbol: bool) -> tuple[Any, ...]:
    """What was compiled, as numba takes it apart, but for what nobody reads.

    That is a text on types, and the code that callers link: a function with a door ``by_symbol`` is
    called there (:mod:`puck_tables.kernels.linking`), and only names are asked for.
    """
    (name, kind, (made, linked)), *others = data._reduce()
    others[5] = ""
    if by_symbol and hasattr(data.library, "calls"):
        names = ir.Module()
        for one in data.library.get_defined_functions():
            function = ir.Function(names, ir.FunctionType(ir.VoidType(), []), one.name)
            ir.IRBuilder(function.append_basic_block()).unreachable()
        linked = binding.parse_assembly(str(names)).as_bitcode()
    return (name, kind, (made, linked)), *others


class MadeFor(NamedTuple):
    """For which machines a wheel's compiled code was made; the file ``target.json`` says it.

    ``place``: Python's names of system and processor; ``codegen``: numba's triple, name and
    features; ``needs``: features that it uses.
    """

    place: tuple[str, ...]
    codegen: tuple[str, ...]
    needs: tuple[str, ...]

    @classmethod
    def read(cls, folder: Path) -> MadeFor | None:
        """Of the code in a folder, None where there is none."""
        try:
            kept = json.loads((folder / "target.json").read_text(encoding="utf-8"))
            return cls(*(tuple(kept[name]) for name in cls._fields))
        except (OSError, ValueError, KeyError, TypeError):
            return None


@cache
def brought_for() -> tuple[str, ...] | None:
    """For what the code was made that came along; None where this processor cannot run it.

    Whoever names a processor to numba gets code for that one.
    """
    target = MadeFor.read(brought_folder())
    if target is None or _settings.CPU_NAME or _settings.CPU_FEATURES:
        return None
    features = binding.get_host_cpu_features()
    here = sys.platform, platform.machine().lower()
    return target.codegen if here == target.place and all(map(features.get, target.needs)) else None


@cache
def _leave_out_blas() -> None:
    """Keep numba from loading scipy's linear algebra, which takes as long as numpy.

    It looks for a BLAS as it first compiles or reads anything; no kernel multiplies matrices.
    """
    from numba.np import linalg

    def no_blas() -> None:
        raise ImportError

    ensure_blas: Any = linalg.ensure_blas
    linalg.ensure_blas = no_blas
    try:
        import numba.np.arraymath  # noqa: F401 - it asks as it is imported
    finally:
        linalg.ensure_blas = ensure_blas


def read_sealed(path: Path) -> bytes | None:
    """What a file holds, None where it is not there or not as it was written."""
    try:
        kept = path.read_bytes()
    except OSError:
        return None
    return kept[_DIGEST:] if hashlib.sha256(kept[_DIGEST:]).digest() == kept[:_DIGEST] else None


def write_sealed(path: Path, content: bytes) -> None:
    """A whole file, or none where the disk is full; two processes may write the same at once."""
    with contextlib.suppress(OSError):
        descriptor, name = tempfile.mkstemp(dir=path.parent, prefix=".", suffix=".part")
        try:
            with open(descriptor, "wb") as file:
                file.write(hashlib.sha256(content).digest() + content)
            os.replace(name, path)
        except BaseException:
            with contextlib.suppress(OSError):
                os.unlink(name)
            raise

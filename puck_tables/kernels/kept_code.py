"""Compiled code on disk: one sealed file for each function and types of arguments.

numba's own cache trusts whatever its files hold: a flipped bit in machine code computes wrong
numbers in silence, one in its index ends the program, and of two processes that save at once one
may find the code of the other's types under its own.  Here a file holds what it is for, and nothing
is opened that does not match its digest; what is missing or damaged is compiled anew; the folder is
that of :func:`puck_tables.kernels.cache.cache_folder`, which only this user can write.  (The digest
proves a file whole; that nobody else made it is for the folder to prove.)
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import sys
import tempfile
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numba
from numba.core import serialize
from numba.core.compiler import CompileResult

from puck_tables.kernels.cache import cache_folder, file_stem

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
        key = self._key(sig, target_context.codegen())
        path = self._path(key)
        if path is None:
            return None
        try:
            kept = path.read_bytes()
            content = kept[_DIGEST:]
            if hashlib.sha256(content).digest() != kept[:_DIGEST]:
                return None
            kept_key, calls, payload = serialize.loads(content)
            if kept_key != key:
                return None
            for called in calls:
                self._at_hand(called)
            result: Any = CompileResult
            return result._rebuild(target_context, *payload)
        except Exception:  # not there, or whatever numba's objects raise
            return None

    def keeps(self, sig: Any, target_context: Any) -> bool:
        """Whether a file is there that was made for a signature."""
        path = self._path(self._key(sig, target_context.codegen()))
        return path is not None and path.exists()

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep what was compiled for a signature, unless the disk is full."""
        key = self._key(sig, data.codegen)
        path = self._path(key)
        if path is None or data.lifted or data.library.has_dynamic_globals:
            return  # addresses in it hold for this process only
        content = _dumps((key, getattr(data.library, "calls", ()), data._reduce()))
        with contextlib.suppress(OSError):
            _write(path, hashlib.sha256(content).digest() + content)

    def _key(self, sig: Any, codegen: Any) -> tuple[str, ...]:
        """All that the compiled code depends on besides the sources of the package."""
        enclosed = [cell.cell_contents for cell in self._function.__closure__ or ()]
        return (
            self._name, str(sig), repr(codegen.magic_tuple()), repr(enclosed), numba.__version__,
            sys.version, repr(_settings.BOUNDSCHECK), repr(_settings.OPT),
        )  # fmt: skip

    def _path(self, key: tuple[str, ...]) -> Path | None:
        folder = cache_folder()
        if folder is None:
            return None
        return folder / f"{self._name}-{hashlib.sha256(repr(key).encode()).hexdigest()[:16]}.code"


@cache
def _leave_out_blas() -> None:
    """Keep numba from loading scipy's linear algebra, which takes as long as numpy.

    It looks for a BLAS as it first compiles or reads anything; no kernel multiplies matrices.
    """
    from numba.np import linalg

    def no_blas() -> None:
        raise ImportError

    found: Any = linalg.ensure_blas
    linalg.ensure_blas = no_blas
    try:
        import numba.np.arraymath  # noqa: F401 - it asks as it is imported
    finally:
        linalg.ensure_blas = found


def _write(path: Path, content: bytes) -> None:
    """A whole file or none; two processes may write the same at once."""
    descriptor, name = tempfile.mkstemp(dir=path.parent, prefix=".", suffix=".part")
    try:
        with open(descriptor, "wb") as file:
            file.write(content)
        os.replace(name, path)
    except BaseException:
        with contextlib.suppress(OSError):
            os.unlink(name)
        raise

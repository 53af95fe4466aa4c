"""What is done of long work, kept in a file, so that it goes on after any end.

One file: a header of one page that says which work it belongs to, by a digest of everything that
determines its results; then for each chunk its checksum and its results.  A chunk is taken for done
only if its checksum is right, so an end at any moment, even of the machine, costs at most the
chunks on hand.
"""

from __future__ import annotations

import contextlib
import errno
import hashlib
import io
import json
import os
import platform
import sys
import tempfile
import threading
import zlib
from collections.abc import Callable, Mapping
from importlib.metadata import version
from pathlib import Path
from types import TracebackType
from typing import Any

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables._core.executor import Progress, run_chunks
from puck_tables._core.safe_read import read_whole
from puck_tables._core.sources import source_digest
from puck_tables.errors import InputError, OutputError

_PAGE, _MARK = 4096, 8
_LARGEST_FILE = 1 << 26


def work_digest(**what: Any) -> str:
    """Digest of everything that determines the bits of a long work.

    Parameters
    ----------
    what : numbers, texts, None, arrays, and lists and mappings of them
        The arguments, by content: not the name of a file, but what :func:`files_named` reads of it.
        The sources of the package and what compiles and runs them are added here.

    Examples
    --------
    >>> work_digest(tol=1e-8, w0=np.arange(3)) == work_digest(tol=1e-8, w0=np.arange(3.0))
    False
    """
    runs = [source_digest(), version("numba"), version("llvmlite"), np.__version__,
            platform.machine(), platform.processor(), sys.version]  # fmt: skip
    text = json.dumps([what, runs], sort_keys=True, default=_told_apart)
    return hashlib.sha256(text.encode()).hexdigest()


def _told_apart(value: Any) -> Any:
    """An array as a digest of all that it is; whatever else JSON does not know is refused."""
    if isinstance(value, np.ndarray | np.generic):
        array = np.asarray(value)
        content = hashlib.sha256(np.ascontiguousarray(array).tobytes()).hexdigest()
        return [str(array.dtype), array.shape, content]
    if isinstance(value, Mapping):
        return dict(value)
    raise TypeError(f"{type(value).__name__} does not say what it is")


def files_named(value: Any) -> dict[str, str]:
    """Digests of the content of all files whose names stand anywhere in a nested structure.

    Examples
    --------
    >>> files_named({"force": {"file": "/nowhere/force.csv"}, "wall": [{"x": 1.0}]})
    {'/nowhere/force.csv': 'cannot be read'}
    """
    if isinstance(value, Mapping):
        value = list(value.values())
    if isinstance(value, list | tuple):
        return {name: digest for item in value for name, digest in files_named(item).items()}
    if not isinstance(value, str) or not (value.lower().endswith(".csv") or os.path.isfile(value)):
        return {}
    try:
        content = read_whole(value, _LARGEST_FILE)
    except (OSError, ValueError):  # whoever needs it says why
        return {value: "cannot be read"}
    return {value: hashlib.sha256(content).hexdigest()}


class Checkpoint:
    """Results (rows, items) and status (items,) of chunked work, in a file; a context manager.

    What is done is in memory too (``values``, ``status``): the file may be cut or removed by others
    while the work goes on.

    Parameters
    ----------
    path : where it is kept; gone on with if it exists and belongs to the same work
    digest : what the work is, see :func:`work_digest`
    rows, items, chunk : its size and how it is cut

    Raises
    ------
    InputError
        If the file belongs to other work, or another process is at it.
    OutputError
        If it cannot be made.

    Examples
    --------
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     with Checkpoint(folder + "/a.progress", "work", rows=1, items=5, chunk=2) as kept:
    ...         kept.put(2, 4, np.ones((1, 2)), np.zeros(2, np.int8))
    ...     with Checkpoint(folder + "/a.progress", "work", rows=1, items=5, chunk=2) as kept:
    ...         kept.is_done(0), kept.is_done(2), kept.values[0, 2:4].tolist()
    (False, True, [1.0, 1.0])
    """

    def __init__(self, path: str | Path, digest: str, rows: int, items: int, chunk: int) -> None:
        self.path, self.chunk, self.items = Path(path), chunk, items
        header = json.dumps(
            {"puck-tables": "progress", "digest": digest, "rows": rows, "items": items,
             "chunk": chunk}, sort_keys=True,
        ).encode()  # fmt: skip
        total = _PAGE + _MARK * -(-items // chunk) + (8 * rows + 1) * items
        try:
            _create_unless_there(self.path, header, total)
            self._file = _locked(self.path)
        except OSError as error:
            raise OutputError(f"cannot keep {self.path}: {error.strerror or error}") from None
        if os.fstat(self._file.fileno()).st_size != total or not _begins_with(self._file, header):
            self._file.close()
            raise InputError(
                f"{self.path} is not what is done of this work: give the arguments and files it "
                "was begun with, or remove it"
            )
        self._one_at_a_time = threading.Lock()
        self._block = _MARK + (8 * rows + 1) * chunk
        self.values: FloatArray = np.full((rows, items), np.nan)
        self.status: npt.NDArray[np.int8] = np.zeros(items, np.int8)

    def is_done(self, start: int) -> bool:
        """Whether the chunk from ``start`` is there, whole; then it is in memory, too."""
        stop = min(start + self.chunk, self.items)
        count, rows = stop - start, len(self.values)
        with self._one_at_a_time:
            self._file.seek(self._place(start))
            block = self._file.read(_MARK + (8 * rows + 1) * count)
        content = block[_MARK:]
        if len(content) < (8 * rows + 1) * count or block[:_MARK] != _mark(content):
            return False
        values = np.frombuffer(content, np.float64, rows * count)
        self.values[:, start:stop] = values.reshape(rows, count)
        self.status[start:stop] = np.frombuffer(content, np.int8, count, 8 * rows * count)
        return True

    def put(self, start: int, stop: int, values: FloatArray, status: npt.NDArray[np.int8]) -> None:
        """Keep the results of a chunk.

        Raises
        ------
        OutputError
            If the disk does not take them; what was kept before stays.
        """
        self.values[:, start:stop], self.status[start:stop] = values, status
        content = np.ascontiguousarray(values).tobytes() + status.tobytes()
        block = _mark(content) + content
        try:
            with self._one_at_a_time:
                self._file.seek(self._place(start))
                if self._file.write(block) != len(block):
                    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        except OSError as error:
            raise OutputError(f"cannot keep {self.path}: {error.strerror or error}") from None

    def _place(self, start: int) -> int:
        return _PAGE + self._block * (start // self.chunk)

    def __enter__(self) -> Checkpoint:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        with contextlib.suppress(OSError):
            os.fsync(self._file.fileno())
        self._file.close()


def _mark(content: bytes) -> bytes:
    """What stands before a whole chunk: never zeros, and hardly before another content."""
    return b"done" + zlib.crc32(content).to_bytes(4, "little")


def _create_unless_there(path: Path, header: bytes, total: int) -> None:
    """A file of full size under a temporary name, then the name: never a part of one."""
    if path.exists():
        return
    with tempfile.NamedTemporaryFile(dir=path.parent, prefix=".puck-", suffix=".part") as file:
        file.write(header)
        file.truncate(total)
        file.flush()
        if hasattr(os, "posix_fallocate"):  # a full disk is met here, not in the middle
            os.posix_fallocate(file.fileno(), 0, total)
        with contextlib.suppress(FileExistsError):  # another process was quicker
            os.link(file.name, path)


def _locked(path: Path) -> io.FileIO:
    """The file opened, exclusively locked where the system has locks."""
    file = io.FileIO(path, "r+")
    try:
        import fcntl

        fcntl.flock(file.fileno(), fcntl.LOCK_EX | fcntl.LOCK_NB)
    except ImportError:
        pass
    except OSError:
        file.close()
        raise InputError(f"another process is at work on {path}: wait for it to end") from None
    return file


def _begins_with(file: io.FileIO, header: bytes) -> bool:
    file.seek(0)
    return file.read(_PAGE) == header.ljust(_PAGE, b"\0")


def chunked(
    piece: Callable[[int, int], tuple[FloatArray, npt.NDArray[np.int8]]],
    rows: int, size: int, chunk: int, threads: int | None, progress: Progress | None,
    path: str | Path | None, work: Mapping[str, Any],
) -> tuple[FloatArray, npt.NDArray[np.int8]]:  # fmt: skip
    """Results (rows, size) and status (size,) of chunked work, kept in a file if one is given.

    ``piece``: what there is from one item to another; ``work``: what determines the bits, as
    :func:`work_digest` takes it.

    Raises
    ------
    InputError, OutputError
        As :class:`Checkpoint`.

    Examples
    --------
    >>> found = lambda start, stop: (np.ones((2, stop - start)), np.zeros(stop - start, np.int8))
    >>> chunked(found, 2, 5, 2, 1, None, None, {})[0].sum()
    np.float64(10.0)
    """
    if path is None:
        out, status = np.empty((rows, size)), np.empty(size, np.int8)

        def fill(start: int, stop: int) -> None:
            out[:, start:stop], status[start:stop] = piece(start, stop)

        run_chunks(fill, size, chunk, threads, progress)
        return out, status
    with Checkpoint(path, work_digest(**work), rows, size, chunk) as kept:

        def go_on(start: int, stop: int) -> None:
            if not kept.is_done(start):
                kept.put(start, stop, *piece(start, stop))

        run_chunks(go_on, size, chunk, threads, progress)
        return kept.values, kept.status

"""What is done of long work, kept in a file, so that it goes on after any end.

One file: a header of one page that says which work it belongs to, one number for each chunk (0: not
done; else its checksum and a set bit), then the results.  A chunk is taken for done only if its
checksum is right, so an end at any moment, even of the machine, costs at most the chunks on hand.
"""

from __future__ import annotations

import contextlib
import json
import os
import tempfile
import zlib
from pathlib import Path
from types import TracebackType

import numpy as np
import numpy.typing as npt

from puck_tables.errors import InputError, OutputError

FloatArray = npt.NDArray[np.float64]

_PAGE = 4096
_DONE = 1 << 32


class Checkpoint:
    """Results (rows, items) and status (items,) of chunked work, in a file; a context manager.

    Parameters
    ----------
    path : where it is kept; gone on with if it exists and belongs to the same work
    digest : what the work is
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
        chunks = -(-items // chunk)
        sizes = (_PAGE, 8 * chunks, items, -(_PAGE + 8 * chunks + items) % 8, 8 * rows * items)
        marks, status, _, values = np.cumsum(sizes)[:-1].tolist()
        total = sum(sizes)
        try:
            _create_unless_there(self.path, header, total)
            self._lock = _locked(self.path)
        except OSError as error:
            raise OutputError(f"cannot keep {self.path}: {error.strerror or error}") from None
        try:
            if self.path.stat().st_size != total or not _begins_with(self.path, header):
                raise InputError(
                    f"{self.path} is not what is done of this sweep: give the arguments it was "
                    "begun with, or remove it"
                )
            memory = np.memmap(self.path, np.uint8, "r+")
        except BaseException:
            os.close(self._lock)
            raise
        self._memory = memory
        self.marks = memory[marks:status].view(np.uint64)
        self.status = memory[status : status + items].view(np.int8)
        self.values: FloatArray = memory[values:].view(np.float64).reshape(rows, items)

    def is_done(self, start: int) -> bool:
        """Whether the chunk from ``start`` is there, whole."""
        mark = int(self.marks[start // self.chunk])
        return mark != 0 and mark == self._sum(start, min(start + self.chunk, self.items))

    def put(self, start: int, stop: int, values: FloatArray, status: npt.NDArray[np.int8]) -> None:
        """Keep the results of a chunk."""
        self.values[:, start:stop], self.status[start:stop] = values, status
        self.marks[start // self.chunk] = self._sum(start, stop)

    def _sum(self, start: int, stop: int) -> int:
        crc = zlib.crc32(self.status[start:stop].tobytes())
        return _DONE | zlib.crc32(np.ascontiguousarray(self.values[:, start:stop]).tobytes(), crc)

    def __enter__(self) -> Checkpoint:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._memory.flush()
        os.close(self._lock)


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


def _locked(path: Path) -> int:
    """An open, exclusively locked descriptor, where the system has locks."""
    descriptor = os.open(path, os.O_RDWR)
    try:
        import fcntl

        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except ImportError:
        pass
    except OSError:
        os.close(descriptor)
        raise InputError(f"another process is at work on {path}: wait for it to end") from None
    return descriptor


def _begins_with(path: Path, header: bytes) -> bool:
    with open(path, "rb") as file:
        return file.read(_PAGE) == header.ljust(_PAGE, b"\0")

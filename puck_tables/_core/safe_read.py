"""Reading files that others give: regular ones of a bounded size, never waiting for one.

What by its beginning is certainly no table is refused with what to do.
"""

from __future__ import annotations

import errno
import os
import stat
from pathlib import Path
from typing import BinaryIO

from puck_tables._core.arrays import shown
from puck_tables._core.text import HEAD, encoding_of
from puck_tables.errors import InputError


def read_whole(path: str | Path, largest: int) -> bytes:
    """The bytes of a file.

    ``path``: path of a regular file; ``largest``: how many bytes it may have.  Raises OSError with
    a ``strerror`` that says why: missing, a folder, pipe or device, too large.

    >>> read_whole("/dev/zero", 100)
    Traceback (most recent call last):
    ...
    OSError: [Errno 22] it is not a regular file, save what it gives as one: '/dev/zero'
    """
    with opened(path, largest) as file:
        return file.read(os.fstat(file.fileno()).st_size)  # not more: it is allocated before


def content_of(path: str | Path, largest: int) -> bytes:
    """The bytes of a file as :func:`read_whole` has them; InputError says why there are none."""
    try:
        return read_whole(path, largest)
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror or error}") from None


def opened(path: str | Path, largest: int) -> BinaryIO:
    """A regular file, open for reading; refused as by :func:`read_whole`."""
    # not blocking: to open a pipe would wait for who writes to it
    if not isinstance(path, str | os.PathLike) or "\0" in os.fspath(path):
        raise OSError(errno.EINVAL, "it is no path of a file", shown(path))
    flags = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)
    if Path(path).exists() and not Path(path).is_file():
        raise _irregular(path)
    file = open(os.open(path, flags), "rb")  # noqa: SIM115 - for the caller to close
    try:
        status = os.fstat(file.fileno())
        if not stat.S_ISREG(status.st_mode):
            raise _irregular(path)
        if status.st_size > largest:
            raise OSError(errno.EFBIG, f"it is too large, {largest} bytes are the most", str(path))
    except OSError:
        file.close()
        raise
    return file


def _irregular(path: str | Path) -> OSError:
    """What is no file to read from, and what to do."""
    do = "it is a folder: name a file in it" if Path(path).is_dir() else "save what it gives as one"
    return OSError(errno.EINVAL, f"it is not a regular file, {do}", str(path))


def is_number(text: str) -> bool:
    """Whether a cell is a number.

    >>> is_number("1e-3"), is_number("speed")
    (True, False)
    """
    try:
        float(text)
    except ValueError:
        return False
    return True


HDF5, ZIP = b"\x89HDF\r\n\x1a\n", b"PK\x03\x04"
_PICKLED = "a pickle, which could run anything: save the table as CSV (df.to_csv)"
_OTHERS = (  # how files begin that are none of ours
    (b"\x80\x02", _PICKLED), (b"\x80\x03", _PICKLED), (b"\x80\x04", _PICKLED),
    (b"\x80\x05", _PICKLED), (b"ccopy_reg", _PICKLED), (b"\x1f\x8b", "compressed: unpack it first"),
    (b"BZh", "compressed: unpack it first"), (b"\xfd7zXZ", "compressed: unpack it first"),
    (b"\x93NUMPY", "a NumPy array: save it as CSV (numpy.savetxt)"),
    (b"PAR1", "a Parquet file: save the table as CSV"),
    (b"MATLAB", "a MATLAB file: save the table as CSV"),
    (b"\xd0\xcf\x11\xe0", "a spreadsheet: save its table as CSV"),
    (b"RIFF", "a film, not a table: first follow the puck in it, with Tracker for one"),
    (b"%PDF", "a PDF: save the table as CSV"), (b"{\\rtf", "formatted text: save it as plain text"),
    (b"\xff\xd8\xff", "a picture, not a table"), (b"\x89PNG", "a picture, not a table"),
    (b"GIF8", "a picture, not a table"), (b"<!doctype html", "a web page, not a table"),
    (b"<!DOCTYPE html", "a web page, not a table"), (b"<html", "a web page, not a table"),
)  # fmt: skip


def beginning(path: str | Path, largest: int) -> bytes:
    """How a file begins that may hold a table.

    ``path``: the file; ``largest``: bytes that it may have.  Raises InputError if it is empty, or
    of a kind in which no table stands; OSError if it cannot be read.

    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     _ = Path(folder, "a.csv").write_text("t,x,y")
    ...     beginning(Path(folder, "a.csv"), 100)
    b't,x,y'
    """
    with opened(path, largest) as file:
        head = file.read(HEAD)
    refuse_others(path, head)
    return head


def refuse_others(path: str | Path, head: bytes) -> None:
    """Refuse a file that is empty, or of a kind in which no table stands.

    >>> refuse_others("a.csv", b"")
    Traceback (most recent call last):
    ...
    puck_tables.errors.InputError: a.csv is empty
    """
    if not head:
        raise InputError(f"{path} is empty")
    for begin, what in _OTHERS:
        if head.startswith(begin):
            raise InputError(f"{path} is {what}")
    if head[4:8] == b"ftyp":
        raise InputError(
            f"{path} is a film, not a table: first follow the puck in it, with Tracker for one"
        )


def refuse_no_text(path: str | Path, head: bytes) -> None:
    """Refuse a file that is no table in a text file.

    >>> refuse_no_text("a.json", b"{}")
    Traceback (most recent call last):
    ...
    puck_tables.errors.InputError: a.json looks like JSON: save the table as CSV
    """
    for begin, what in ((HDF5, "an HDF5 file"), (ZIP, "a zip archive")):
        if head.startswith(begin):
            raise InputError(f"{path} is {what}: save the table as CSV")
    text = head[:400].decode(encoding_of(path, head), errors="ignore").lstrip("\ufeff \t\r\n")
    if text.startswith("<"):
        raise InputError(f"{path} looks like XML: save the table as CSV")
    if text.startswith(("{", "[")):
        raise InputError(f"{path} looks like JSON: save the table as CSV")

"""Reading files that others give: regular ones of a bounded size, never waiting for one."""

from __future__ import annotations

import errno
import os
import stat
from pathlib import Path
from typing import BinaryIO

from puck_tables._core.arrays import shown


def read_whole(path: str | Path, largest: int) -> bytes:
    """The bytes of a file.

    Parameters
    ----------
    path : path of a regular file
    largest : how many bytes it may have

    Raises
    ------
    OSError
        With a ``strerror`` that says why: missing, a folder, pipe or device, too large.

    Examples
    --------
    >>> read_whole("/dev/zero", 100)
    Traceback (most recent call last):
    ...
    OSError: [Errno 22] it is not a regular file, save what it gives as one: '/dev/zero'
    """
    with opened(path, largest) as file:
        return file.read(os.fstat(file.fileno()).st_size)  # not more: it is allocated before


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
        found = os.fstat(file.fileno())
        if not stat.S_ISREG(found.st_mode):
            raise _irregular(path)
        if found.st_size > largest:
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

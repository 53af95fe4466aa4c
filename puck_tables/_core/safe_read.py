"""Reading files that others give: regular ones of a bounded size, never waiting for one."""

from __future__ import annotations

import csv
import errno
import os
import stat
from collections.abc import Sequence
from pathlib import Path
from typing import BinaryIO

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables._core.real import shown
from puck_tables.errors import InputError


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
    """A regular file, open for reading.

    Parameters
    ----------
    path : path of a regular file
    largest : how many bytes it may have

    Raises
    ------
    OSError
        As :func:`read_whole`.

    Examples
    --------
    >>> opened("/dev/zero", 100)
    Traceback (most recent call last):
    ...
    OSError: [Errno 22] it is not a regular file, save what it gives as one: '/dev/zero'
    """
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


def read_numbers(given: str | Sequence[Sequence[float]], most: int) -> FloatArray:
    """Rows of numbers, given or from a CSV file; an array of no rows where some are none.

    Raises
    ------
    InputError
        If the file cannot be read.

    Examples
    --------
    >>> read_numbers(((0.0, 1.0), (2.0, 3.0)), 100).shape
    (2, 2)
    """
    try:
        cells = read_rows(given, most) if isinstance(given, str) else given
        return np.array([[float(cell) for cell in row] for row in cells])
    except OSError as error:
        raise InputError(f"cannot read {given}: {error.strerror or error}") from None
    except ValueError:
        return np.empty((0, 0))


def read_rows(path: str | Path, largest: int) -> list[list[str]]:
    """The cells of a CSV file of numbers, row by row, without header, comments (#) and blank lines.

    Parameters
    ----------
    path : path of a regular file
    largest : how many bytes it may have

    Raises
    ------
    OSError
        As :func:`read_whole`.
    ValueError
        If it is not text, or no CSV.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder, "law.csv")
    ...     _ = file.write_bytes(b"speed,f;0,0.3;;1,0.2".replace(b";", b"%c" % 10))
    ...     read_rows(file, 100)
    [['0', '0.3'], ['1', '0.2']]
    """
    text = read_whole(path, largest).decode("utf-8-sig")
    try:
        cells = list(csv.reader(text.splitlines()))
    except csv.Error as error:
        raise ValueError(str(error)) from None
    rows = [row for row in cells if any(map(str.strip, row)) and not row[0].startswith("#")]
    return rows[1:] if rows and not is_number(rows[0][0]) else rows


def is_number(text: str) -> bool:
    """Whether a cell is a number.

    Examples
    --------
    >>> is_number("1e-3"), is_number("speed")
    (True, False)
    """
    try:
        float(text)
    except ValueError:
        return False
    return True

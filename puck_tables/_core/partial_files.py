"""Parts: what is being written, under a name of its own, until it is whole and is renamed.

Whoever writes holds a lock on his part, which ends with his process, however that ends.  A part
that nobody holds is of the dead, and the next who writes into its folder removes it.
"""

from __future__ import annotations

import contextlib
import os
import re
import secrets
import shutil
import stat
import time
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path

try:
    import fcntl
except ImportError:  # a system without such locks: parts are of the dead when they are a day old
    fcntl = None  # type: ignore[assignment]

_PREFIX, _SUFFIX = ".puck-", ".part"
_NAME = re.compile(re.escape(_PREFIX) + "[0-9a-f]{16}" + re.escape(_SUFFIX))
_PATIENCE = 30.0  # s: renames take milliseconds
_OLD = 86400.0  # s: a part as old is nobody's, where no locks tell
_own: set[Path] = set()  # of this process


def new_part(folder: Path) -> Path:
    """A name for a part in a folder, known from now on as one of this process."""
    part = folder / f"{_PREFIX}{secrets.token_hex(8)}{_SUFFIX}"
    _own.add(part)
    return part


def forget(part: Path) -> None:
    """It is renamed, or gone."""
    _own.discard(part)


def hold(descriptor: int) -> None:
    """Hold an open part, a file or a folder, as long as it is open.

    Raises OSError if another took it for one of the dead before it was held.
    """
    if fcntl is not None:
        with contextlib.suppress(OSError):  # a file system without locks
            fcntl.flock(descriptor, fcntl.LOCK_SH)
    if os.fstat(descriptor).st_nlink == 0:
        raise OSError(11, "it was just removed: try again")


def identity(path: Path | int) -> tuple[int, int] | None:
    """What a name stands for, whatever it is renamed to; None for nothing."""
    try:
        status = os.fstat(path) if isinstance(path, int) else os.lstat(path)
    except FileNotFoundError:
        return None
    return status.st_dev, status.st_ino


def if_dead(path: Path, then: Callable[[Path], object]) -> bool:
    """Do something with a file or folder that nobody holds, nor can meanwhile; whether it was."""
    try:
        kind = os.lstat(path).st_mode
        if not (stat.S_ISDIR(kind) or stat.S_ISREG(kind)):
            return False
        descriptor = os.open(path, os.O_RDONLY if stat.S_ISDIR(kind) else os.O_RDWR)
    except OSError:  # another's, or gone
        return False
    try:
        dead = _is_free(descriptor, path)
        if dead:
            then(path)
        return dead
    finally:
        os.close(descriptor)


def _is_free(descriptor: int, path: Path) -> bool:
    """Whether nobody holds it, nor can while it is open here."""
    if fcntl is None:
        return _is_old(path)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:  # a file system without locks
        return _is_old(path)
    return True


def _is_old(path: Path) -> bool:
    return path.stat().st_mtime < time.time() - _OLD


def remove(path: Path) -> None:
    """Remove a part, a file or a folder with all that is in it."""
    with contextlib.suppress(OSError):
        path.unlink()
    shutil.rmtree(path, ignore_errors=True)
    forget(path)


def remove_dead(folder: Path) -> None:
    """Remove the parts of the dead in a folder."""
    with contextlib.suppress(OSError), os.scandir(folder) as entries:
        for name in [entry.name for entry in entries if _NAME.fullmatch(entry.name)]:
            if_dead(folder / name, remove)


@cache
def remove_dead_once(folder: Path) -> None:
    """Remove the parts of the dead once in a process: a folder may be large, written to often."""
    remove_dead(folder)


def remove_own() -> None:
    """Remove the parts of this process, which ends."""
    for part in list(_own):
        remove(part)


@contextlib.contextmanager
def alone_in(folder: Path) -> Iterator[None]:
    """Nobody else of this program renames stores in the folder meanwhile, on this machine.

    Raises OSError if the folder cannot be opened, or another holds it all the time.
    """
    if fcntl is None:
        yield
        return
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        end = time.monotonic() + _PATIENCE
        while True:
            try:
                fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
                break
            except BlockingIOError:
                if time.monotonic() > end:
                    raise OSError(11, "another process holds its folder") from None
                time.sleep(0.02)
            except OSError:  # a file system without locks
                break
        yield
    finally:
        os.close(descriptor)

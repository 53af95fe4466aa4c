"""Writing files so that nothing is lost: checked before the work, whole or not at all after."""

from __future__ import annotations

import contextlib
import os
import secrets
import stat
import tempfile
from pathlib import Path

from puck_tables.errors import OutputError

_PREFIX, _SUFFIX = ".puck-", ".part"
PART_PATTERN = f"{_PREFIX}*{_SUFFIX}"  # of what an end in the middle of writing leaves


def check_target(path: str | Path, overwrite: bool = False) -> Path:
    """Refuse an output that could not be written later, before any work is done.

    Parameters
    ----------
    path : path of the output file
    overwrite : whether an existing file may be replaced

    Returns
    -------
    Path

    Raises
    ------
    OutputError
        If the file exists (without ``overwrite``), is a folder, or its folder is missing or
        cannot be written.

    Examples
    --------
    >>> check_target("/nowhere/a.csv")
    Traceback (most recent call last):
    ...
    puck_tables.errors.OutputError: cannot write /nowhere/a.csv: the folder /nowhere does not exist
    """
    try:
        target = Path(os.path.realpath(path))  # a link is followed, not replaced
        folder = target.parent
        if not folder.is_dir():
            raise OutputError(f"cannot write {path}: the folder {folder} does not exist")
        if target.is_dir():
            raise OutputError(f"cannot write {path}: it is a folder; give a file name")
        if target.exists() and not target.is_file():
            raise OutputError(f"cannot write {path}: it is not a regular file")
        if target.exists() and not overwrite:
            raise OutputError(
                f"{path} exists already; use --overwrite (overwrite=True) to replace it"
            )
        with tempfile.TemporaryFile(dir=folder):
            pass
    except (OSError, ValueError) as error:  # also where the folder one stands in is gone
        if isinstance(error, OutputError):
            raise
        reason = getattr(error, "strerror", None) or error
        raise OutputError(f"cannot write {path} in its folder: {reason}") from None
    return target


def write_bytes(path: str | Path, content: bytes, overwrite: bool = False) -> None:
    """Write a whole file under a temporary name, then rename it: never a half-written file.

    Raises
    ------
    OutputError
        As :func:`check_target`, and when the disk is full; the target is then as it was.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     write_bytes(folder + "/a.txt", b"puck")
    ...     Path(folder, "a.txt").read_bytes()
    b'puck'
    """
    target = check_target(path, overwrite)
    temporary = None
    try:
        before = target.stat() if target.exists() else None
        temporary, descriptor = _part(target.parent, private=before is not None)
        with open(descriptor, "wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        if before is not None:
            _give_rights(temporary, before)
        if overwrite:
            temporary.replace(target)
        else:
            # link() fails if another process made the target meanwhile; rename would replace it
            _rename_new(temporary, target)
        temporary = None
    except OSError as error:
        raise OutputError(f"cannot write {target}: {error.strerror or error}") from None
    finally:
        if temporary is not None:
            temporary.unlink(missing_ok=True)


def _part(folder: Path, private: bool) -> tuple[Path, int]:
    """A new file under a name of its own, open for writing.

    The system takes the umask from its rights: to ask for the umask is to change it, for all
    threads, for a moment.
    """
    flags = os.O_RDWR | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0)
    path = folder / f"{_PREFIX}{secrets.token_hex(8)}{_SUFFIX}"
    return path, os.open(path, flags, 0o600 if private else 0o666)


def _give_rights(path: Path, like: os.stat_result) -> None:
    """The owner and the rights of the file that is replaced."""
    if hasattr(os, "chown") and (like.st_uid, like.st_gid) != (os.geteuid(), os.getegid()):
        with contextlib.suppress(OSError):  # only root may give files away
            os.chown(path, like.st_uid, like.st_gid)
    path.chmod(stat.S_IMODE(like.st_mode) & 0o777)


def _rename_new(temporary: Path, target: Path) -> None:
    try:
        os.link(temporary, target)
    except FileExistsError:
        raise
    except OSError:  # a file system without hard links
        temporary.replace(target)
        return
    temporary.unlink()

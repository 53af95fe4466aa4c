"""Writing files so that nothing is lost: checked before the work, whole or not at all after."""

from __future__ import annotations

import contextlib
import os
import stat
import tempfile
from collections.abc import Iterator
from pathlib import Path

from puck_tables._core.arrays import instance
from puck_tables._core.partial_files import forget, hold, new_part, remove_dead_once
from puck_tables.errors import OutputError


def as_utf8(text: str) -> str:
    r"""A text that a file can hold: what names of files have that are no text is escaped.

    >>> as_utf8("law" + chr(0xDCFF) + ".csv"), as_utf8("Stück")
    ('law\\udcff.csv', 'Stück')
    """
    return text if text.isascii() else text.encode("utf-8", "backslashreplace").decode()


def check_target(path: str | Path, overwrite: bool = False) -> Path:
    """Refuse an output that could not be written later, before any work is done.

    ``path``: path of the output file; ``overwrite``: whether an existing file may be replaced.
    Raises InputError if it is no name; OutputError if the file exists (without ``overwrite``), is a
    folder, or its folder is missing or cannot be written.

    >>> check_target("/nowhere/a.csv")
    Traceback (most recent call last):
    ...
    puck_tables.errors.OutputError: cannot write /nowhere/a.csv: the folder /nowhere does not exist
    """
    instance("path", path, str, Path)
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

    Raises OutputError as :func:`check_target`, and when the disk is full; the target is then as it
    was.

    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     write_bytes(folder + "/a.txt", b"puck")
    ...     Path(folder, "a.txt").read_bytes()
    b'puck'
    """
    target = check_target(path, overwrite)
    try:
        remove_dead_once(target.parent)
        before = target.stat() if target.exists() else None
        with written_part(target.parent, content, private=before is not None) as part:
            if before is not None:
                _give_rights(part, before)
            if overwrite:
                part.replace(target)
            else:
                # link() fails if another process made the target meanwhile; rename would replace it
                _rename_new(part, target)
    except OSError as error:
        raise OutputError(f"cannot write {target}: {error.strerror or error}") from None


@contextlib.contextmanager
def written_part(
    folder: Path, content: bytes | memoryview, private: bool = False, at: int | None = None
) -> Iterator[Path]:
    """A whole file under a name of its own, held while it is renamed; else nothing is left of it.

    ``folder``: where it is; ``content``: of the file; ``private``: whether only this user may read
    it; else the umask says who; ``at``: the folder, open, in which it is made whatever that is
    called meanwhile, for content that carries a checksum: the disk is not waited for.
    """
    part = new_part(folder)
    name = part if at is None else part.name
    # the system takes the umask from the rights: to ask for the umask is to change it, for all
    # threads, for a moment
    flags = os.O_RDWR | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0)
    try:
        descriptor = os.open(name, flags, 0o600 if private else 0o666, dir_fd=at)
        hold(descriptor)
        held = os.name != "nt"  # there an open file cannot be renamed
        try:
            with open(descriptor, "wb", buffering=0, closefd=not held) as file:
                rest = memoryview(content)
                while rest:
                    rest = rest[file.write(rest) :]
                if at is None:
                    os.fsync(descriptor)
            yield part
        finally:
            if held:
                os.close(descriptor)
    finally:
        with contextlib.suppress(FileNotFoundError):
            os.unlink(name, dir_fd=at)
        forget(part)


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

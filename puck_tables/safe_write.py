"""Writing files so that nothing is lost: checked before the work, whole or not at all after."""

from __future__ import annotations

import os
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
    except (OSError, ValueError) as error:
        if isinstance(error, OutputError):
            raise
        reason = getattr(error, "strerror", None) or error
        raise OutputError(f"cannot write {path} in the folder {folder}: {reason}") from None
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
        with tempfile.NamedTemporaryFile(
            dir=target.parent, prefix=_PREFIX, suffix=_SUFFIX, delete=False
        ) as file:
            temporary = Path(file.name)
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        temporary.chmod(0o666 & ~_umask())
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


def _rename_new(temporary: Path, target: Path) -> None:
    try:
        os.link(temporary, target)
    except FileExistsError:
        raise
    except OSError:  # a file system without hard links
        temporary.replace(target)
        return
    temporary.unlink()


def _umask() -> int:
    mask = os.umask(0o022)
    os.umask(mask)
    return mask

"""The user's cache folder: only this user may write there, or it is not used.

What is read back from it runs as this user (compiled code) or is computed with (tables), so that a
folder in which others can plant files is refused: the program goes on without, and says so.
"""

from __future__ import annotations

import os
import stat
import sys
import threading
from pathlib import Path

_said: set[str] = set()
_saying = threading.Lock()


def say(text: str) -> None:
    """A sentence on stderr, once; those of several threads do not run together."""
    with _saying:
        if text in _said or sys.stderr is None:
            return
        _said.add(text)
        sys.stderr.write(f"{text}\n")


def user_cache() -> Path | None:
    """Where this user's programs keep what they can make again; None where there is no such place.

    ``XDG_CACHE_HOME`` or ``~/.cache``, ``~/Library/Caches`` on macOS, ``LOCALAPPDATA`` on Windows.
    """
    if sys.platform == "win32":
        base = os.environ.get("LOCALAPPDATA") or os.path.expanduser("~/AppData/Local")
    elif sys.platform == "darwin":
        base = os.path.expanduser("~/Library/Caches")
    else:
        base = os.environ.get("XDG_CACHE_HOME", "")
        if not os.path.isabs(base):  # unset, or void by the XDG specification
            base = os.path.expanduser("~/.cache")
    # where nobody has a home '~' stays: that would be a folder wherever the program stands
    return Path(base) / "puck-tables" if os.path.isabs(base) else None


def make_private(folder: Path) -> None:
    """Make a folder, and those above it, that only this user can open; refuse any other.

    Raises OSError if it cannot be made, or others could put files into it or another in its place;
    its ``strerror`` says which folder, and what to do.

    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as place:
    ...     make_private(Path(place, "kept"))
    ...     oct(Path(place, "kept").stat().st_mode & 0o777)
    '0o700'
    """
    refuse_shared(folder)  # nothing is made below a folder of others
    for one in [*reversed(folder.parents), folder]:
        if not one.is_dir():
            one.mkdir(mode=0o700, exist_ok=True)
    refuse_shared(folder)
    if hasattr(os, "geteuid") and stat.S_IMODE(folder.stat().st_mode) != 0o700:
        folder.chmod(0o700)


def refuse_shared(folder: Path) -> None:
    """Refuse a folder into which others can put files, or another in its place.

    Those that are not there yet are left out.  Above the folder itself, folders of root and such as
    /tmp, where nobody can move what belongs to others, are safe.

    Raises OSError.
    """
    if not hasattr(os, "geteuid"):  # rights are kept in another way there
        return
    mine = os.geteuid()
    real = Path(os.path.realpath(folder))
    # those that lead to it, and where links among them lead
    for one in dict.fromkeys([real, *real.parents, folder, *folder.parents]):
        try:
            status = one.lstat()
        except FileNotFoundError:
            continue
        owners = (mine,) if one == real else (mine, 0)
        if status.st_uid not in owners:
            raise PermissionError(
                1, f"the folder {one} belongs to another user: give one of your own"
            )
        if stat.S_ISLNK(status.st_mode):  # its rights say nothing
            continue
        # many systems give each user a group of the same number, in which nobody else is
        private = status.st_gid == mine == os.getegid()
        shared = stat.S_IWOTH if private else stat.S_IWOTH | stat.S_IWGRP
        kept_apart = one != real and status.st_mode & stat.S_ISVTX
        if status.st_mode & shared and not kept_apart:
            raise PermissionError(
                1, f"others may write to the folder {one}: remove it, or give one of your own"
            )

"""The user's cache folder, and where in it compiled code is kept; needs no numba.

numba's own disk cache notices an edit of the file a function stands in, but not an edit of the
functions it calls from elsewhere.  So the cache folder carries a digest of every source file of
the package: after any edit, nothing compiled before can be found.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import shutil
import sys
import tempfile
import time
from collections.abc import Callable
from functools import cache
from pathlib import Path

_PACKAGE = Path(__file__).resolve().parent.parent


@cache
def source_digest(*folders: str) -> str:
    """Digest of the sources in these folders of the package, or of all (16 hexadecimal digits)."""
    digest = hashlib.sha256()
    within = [_PACKAGE / folder for folder in folders] or [_PACKAGE]
    for path in sorted(path for folder in within for path in folder.rglob("*.py")):
        digest.update(path.relative_to(_PACKAGE).as_posix().encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()[:16]


def user_cache() -> Path | None:
    """Where this user's programs keep what they can make again; None where there is no such place.

    ``XDG_CACHE_HOME`` or ``~/.cache``, ``~/Library/Caches`` on macOS, ``LOCALAPPDATA`` on Windows.

    Examples
    --------
    >>> user_cache().name
    'puck-tables'
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


@cache
def cache_folder() -> str | None:
    """Where compiled code is kept; None where no folder can be written.

    ``NUMBA_CACHE_DIR`` if set, else the user's cache folder.  Never beside the package: what an
    uninstalled package leaves in its folder would hide the one that is installed next.
    """
    chosen = os.environ.get("NUMBA_CACHE_DIR")
    base = Path(chosen) if chosen else user_cache()
    if base is None:
        return None
    folder = base / f"compiled-{source_digest()}"
    try:
        if not folder.exists():
            _forget_unused(base)
            folder.mkdir(parents=True, exist_ok=True)
        os.utime(folder)
        tempfile.TemporaryFile(dir=folder).close()
    except OSError:
        return None
    return str(folder)


def _forget_unused(base: Path) -> None:
    """Remove what versions of the package not run for a month have left."""
    for folder in base.glob("compiled-????????????????"):
        if folder.stat().st_mtime < time.time() - 30 * 86400:
            shutil.rmtree(folder, ignore_errors=True)


# Called once, when something is compiled because it is not kept yet.
announcements: list[Callable[[], None]] = []


def compiling() -> None:
    """Tell those who asked that something is being compiled; an error of theirs is no error here.

    Examples
    --------
    >>> heard: list[str] = []
    >>> announcements.append(lambda: heard.append("compiling"))
    >>> compiling(), compiling(), heard
    (None, None, ['compiling'])
    """
    while announcements:
        with contextlib.suppress(Exception):
            announcements.pop()()

"""Where compiled code is kept; needs no numba.

numba's own disk cache notices an edit of the file a function stands in, but not an edit of the
functions it calls from elsewhere.  So the cache folder carries a digest of every source file of
the package: after any edit, nothing compiled before can be found.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import sys
import tempfile
import time
from functools import cache
from pathlib import Path

_PACKAGE = Path(__file__).resolve().parent.parent


@cache
def source_digest() -> str:
    """Digest of all sources of the package (16 hexadecimal digits)."""
    digest = hashlib.sha256()
    for path in sorted(_PACKAGE.rglob("*.py")):
        digest.update(path.relative_to(_PACKAGE).as_posix().encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()[:16]


def _user_cache() -> Path:
    if sys.platform == "win32":
        base = os.environ.get("LOCALAPPDATA") or os.path.expanduser("~/AppData/Local")
    elif sys.platform == "darwin":
        base = os.path.expanduser("~/Library/Caches")
    else:
        base = os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache")
    return Path(base) / "puck-tables"


@cache
def cache_folder() -> str | None:
    """Where compiled code is kept; None where no folder can be written.

    ``NUMBA_CACHE_DIR`` if set, else the user's cache folder.  Never beside the package: what an
    uninstalled package leaves in its folder would hide the one that is installed next.
    """
    chosen = os.environ.get("NUMBA_CACHE_DIR")
    base = Path(chosen) if chosen else _user_cache()
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


def is_empty() -> bool:
    """Whether nothing of this version has been compiled yet on this machine.

    Examples
    --------
    >>> isinstance(is_empty(), bool)
    True
    """
    folder = cache_folder()
    return folder is None or not any(Path(folder).iterdir())

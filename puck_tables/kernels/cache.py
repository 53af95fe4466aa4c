"""Where compiled code is kept; needs no numba.

numba's own disk cache notices an edit of the file a function stands in, but not an edit of the
functions it calls from elsewhere.  So the cache folder carries a digest of every source file of
the package: after any edit, nothing compiled before can be found.
"""

from __future__ import annotations

import contextlib
import os
import shutil
import tempfile
import time
from collections.abc import Callable
from functools import cache
from pathlib import Path

from puck_tables._core.own_folder import make_private, say, user_cache
from puck_tables._core.sources import source_digest


@cache
def cache_folder() -> Path | None:
    """Where compiled code is kept; None, with a sentence on stderr, where no folder will do.

    ``NUMBA_CACHE_DIR`` if set, else the user's cache folder.  Never beside the package: what an
    uninstalled package leaves in its folder would hide the one that is installed next.
    """
    chosen = os.environ.get("NUMBA_CACHE_DIR")
    base = Path(chosen).absolute() if chosen else user_cache()
    if base is None:
        say("there is no cache folder for compiled code on this machine: it is not kept")
        return None
    folder = base / f"compiled-{source_digest()}"
    try:
        if not chosen:
            make_private(base)
        if not folder.exists():
            _forget_unused(base)
        make_private(folder)
        os.utime(folder)
        tempfile.TemporaryFile(dir=folder).close()
    except OSError as error:
        say(f"compiled code is not kept for the next time: {error.strerror or error}")
        return None
    return folder


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

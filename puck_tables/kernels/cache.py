"""Where compiled code is kept; needs no numba.

numba's own disk cache notices an edit of the file a function stands in, but not an edit of the
functions it calls from elsewhere.  So the cache folder carries a digest of every source file of
the package: after any edit, nothing compiled before can be found.
"""

from __future__ import annotations

import contextlib
import os
import re
import shutil
import sys
import tempfile
import time
from collections.abc import Callable
from functools import cache, lru_cache
from pathlib import Path
from typing import Any

from puck_tables._core.own_folder import make_private, say, user_cache
from puck_tables._core.sources import source_digest

_PACKAGE = Path(__file__).resolve().parent.parent


@cache
def cache_folder() -> Path | None:
    """Where compiled code is kept; None, with a sentence on stderr, where no folder will do.

    ``NUMBA_CACHE_DIR`` if set, else the user's cache folder.  Never beside the package: what an
    uninstalled package leaves in its folder would hide the one that is installed next.
    """
    folder = _place()
    if folder is None:
        say("there is no cache folder for compiled code on this machine: it is not kept")
        return None
    try:
        if not os.environ.get("NUMBA_CACHE_DIR"):
            make_private(folder.parent)
        if not folder.exists():
            _forget_unused(folder.parent)
        make_private(folder)
        os.utime(folder)
        tempfile.TemporaryFile(dir=folder).close()
    except OSError as error:
        say(f"compiled code is not kept for the next time: {error.strerror or error}")
        return None
    return folder


def _place() -> Path | None:
    """Where it would be kept."""
    chosen = os.environ.get("NUMBA_CACHE_DIR")
    base = Path(chosen).absolute() if chosen else user_cache()
    return None if base is None else base / f"compiled-{source_digest()}"


def file_stem(function: Callable[..., Any]) -> str:
    """How the names of files begin that keep compiled code of a function.

    >>> file_stem(Path.exists)
    'pathlib-Path-exists'
    """
    return re.sub(r"\W+", "-", f"{function.__module__}.{function.__qualname__}")


def is_importable(function: Callable[..., Any]) -> bool:
    """Whether a function is found again by its names: then compiled code calls it at its door.

    >>> is_importable(file_stem), is_importable(Path.exists)
    (True, False)
    """
    return hasattr(sys.modules.get(function.__module__), function.__qualname__)


def is_any_kept(function: Callable[..., Any]) -> bool:
    """Whether compiled code of a function is kept, for whatever arguments."""
    stem = file_stem(function)
    for folder in (_place(), brought_folder()):
        with contextlib.suppress(OSError):  # not there yet
            if folder is not None and stem in _kept(folder, folder.stat().st_mtime):
                return True
    return False


def brought_folder() -> Path:
    """Where a wheel for this machine brings compiled code along; in a clone there is none."""
    return _PACKAGE / f"compiled-{source_digest()}"


@lru_cache(maxsize=2)
def _kept(folder: Path, changed: float) -> set[str]:
    """Of which functions, since the folder was changed last."""
    return {path.name.rpartition("-")[0] for path in folder.glob("*.code")}


def _forget_unused(base: Path) -> None:
    """Remove what versions of the package not run for a month have left."""
    for folder in base.glob("compiled-????????????????"):
        if folder.stat().st_mtime < time.time() - 30 * 86400:
            shutil.rmtree(folder, ignore_errors=True)

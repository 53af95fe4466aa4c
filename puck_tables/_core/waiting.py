"""Somebody waits: long work deep inside the library says how far it is to whoever asked for that.

The command line asks; in a program of one's own nothing is said.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext

Progress = Callable[[int, int], None]
Watcher = Callable[[str], AbstractContextManager[Progress]]

watchers: list[Watcher] = []  # the last one is told


def watched(what: str) -> AbstractContextManager[Progress]:
    """A place to tell (done, total) of what takes long."""
    return watchers[-1](what) if watchers else nullcontext(lambda done, total: None)

"""What is measured: a method of answering, made ready, with its errors."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from puck_tables._core.arrays import FloatArray


@dataclass(frozen=True)
class Ready:
    """A method made ready: ``run`` answers ``items`` questions on one thread.

    ``time_error`` and ``place_error`` (n,): at every start of the truth; for resultants the first
    is zero and the second the largest error of the three.  ``bytes`` it keeps.
    """

    run: Callable[[], object]
    items: int
    time_error: FloatArray
    place_error: FloatArray
    bytes: int = 0


@dataclass(frozen=True)
class Contender:
    """A method before it is measured; ``build`` makes what it needs, ``ready`` then all else."""

    question: str
    method: str
    setting: str
    build: Callable[[], object]
    ready: Callable[[object], Ready]
    outsider: bool = False

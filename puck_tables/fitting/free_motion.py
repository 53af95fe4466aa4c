"""Frames at the ends of a track that are no free motion: a hand before, a grip or a wall after."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from puck_tables.fitting.estimate import Estimate
from puck_tables.fitting.seen import FEWEST, Seen

_FEWEST_OUT = 3  # frames at an end that are more than single outliers
_MOSTLY = 0.7  # of them are outliers


def trimmed(found: Estimate) -> tuple[Seen, ...]:
    """The tracks without what lies at their ends and is not of the motion."""
    films = []
    for film, (x, _, _) in zip(found.problem.films, found.problem.each(), strict=True):
        out = ~found.kept[x]
        first = _foreign(out)
        last = film.time.size - _foreign(out[::-1])
        inner = np.arange(film.time.size)
        chosen = (inner >= first) & (inner < last)
        whole = bool(chosen.all()) or chosen.sum() < FEWEST + 2
        films.append(film if whole else film.part(chosen))
    same = all(a is b for a, b in zip(films, found.problem.films, strict=True))
    return found.problem.films if same else tuple(films)


def _foreign(out: npt.NDArray[np.bool_]) -> int:
    """How many frames at the beginning are mostly outliers."""
    counts = np.cumsum(out)
    sizes = np.arange(1, out.size + 1)
    blocks = out & (counts >= _MOSTLY * sizes) & (sizes >= _FEWEST_OUT)
    found = np.flatnonzero(blocks)
    return int(found[-1]) + 1 if found.size else 0

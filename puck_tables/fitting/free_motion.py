"""Frames at the ends of a track that are no free motion: a hand before, a grip or a wall after."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from puck_tables.fitting.estimate import FARTHEST, Estimate
from puck_tables.fitting.residual_tests import drift, runs
from puck_tables.fitting.seen import FEWEST, Seen, noise_of

_FEWEST_OUT = 3  # frames at an end that are more than single outliers
_BESIDE = 0.1  # of the frames that are left, at most
_HOPELESS, _CLEAN, _CHANCE = 10.0, 1.2, 0.01  # times the noise of a smooth motion; probability
_SHARES = (0.15, 0.3, 0.45)  # of the frames: a hand or what a wall did, the smaller part
_MOSTLY = 0.7  # of them are outliers


def trimmed(found: Estimate) -> tuple[Seen, ...]:
    """The tracks without what lies at their ends and is not of the motion.

    A hand that lets go slows otherwise by about J, and is off by as much as an outlier only the
    time √(2 · 4σ/J) before: so long beside what is foreign is left out, too.
    """
    films = []
    problem = found.problem
    decel = problem.asked.scales(problem.found(found.x))[0]
    hidden = math.sqrt(2.0 * FARTHEST * problem.noise[0] / decel)
    for film, (x, _, _) in zip(problem.films, problem.each(), strict=True):
        out = ~found.kept[x]
        first, after = _foreign(out), _foreign(out[::-1])
        beside = math.ceil(min(hidden / film.usual_step, _BESIDE * (out.size - first - after)))
        first += beside if first else 0
        last = out.size - after - (beside if after else 0)
        inner = np.arange(film.time.size)
        chosen = (inner >= first) & (inner < last)
        whole = bool(chosen.all()) or chosen.sum() < FEWEST + 2
        films.append(film if whole else film.part(chosen))
    same = all(a is b for a, b in zip(films, found.problem.films, strict=True))
    return found.problem.films if same else tuple(films)


def is_hopeless(found: Estimate) -> bool:
    """Whether the motion of a track is so far off that something else is in it."""
    return _excess(found) > _HOPELESS


def is_clean(found: Estimate) -> bool:
    """Whether what is left of a track is noise."""
    return _excess(found) < _CLEAN and min(runs(found), drift(found)) > _CHANCE


def _excess(found: Estimate) -> float:
    """The residuals over those of any smooth motion; 1 where these are not known."""
    smooth = noise_of(list(found.problem.films))[0]
    size = found.problem.noise[0] * math.sqrt(found.chi2 / max(found.degrees, 1))
    return size / smooth if smooth > 0.0 else 1.0


def without_ends(film: Seen) -> list[Seen]:
    """A track without some of its first frames, or some of its last, the longest first."""
    order = np.arange(film.time.size)
    parts = []
    for share in _SHARES:
        count = round(share * order.size)
        if order.size - count >= FEWEST + 2:
            parts += [film.part(order >= count), film.part(order < order.size - count)]
    return parts


def _foreign(out: npt.NDArray[np.bool_]) -> int:
    """How many frames at the beginning are mostly outliers."""
    counts = np.cumsum(out)
    sizes = np.arange(1, out.size + 1)
    blocks = out & (counts >= _MOSTLY * sizes) & (sizes >= _FEWEST_OUT)
    found = np.flatnonzero(blocks)
    return int(found[-1]) + 1 if found.size else 0

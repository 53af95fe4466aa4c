"""Frames at the ends of a track that are no free motion: a hand before, a grip or a wall after."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from puck_tables.fitting.estimate import FARTHEST, Estimate
from puck_tables.fitting.problem import UNSEEN
from puck_tables.fitting.residual_tests import drift, runs
from puck_tables.fitting.seen import FEWEST, Seen, noise_of, rests_from
from puck_tables.fitting.touched import pushed, touched

_FEWEST_OUT = 3  # frames at an end that are more than single outliers
_BESIDE = 0.1  # of the frames that are left, at most
_SMALLER = 0.45  # of the frames: a hand or what a wall did
_SLACK = 3  # frames
_MOSTLY = 0.7  # of them are outliers


def trimmed(found: Estimate, uncut: tuple[Seen, ...]) -> tuple[Seen, ...]:
    """The tracks without what lies at their ends and is not of the motion.

    What is off there is left out where something touches the puck (:mod:`.touched`); else it is the
    model that is wrong.  A hand that lets go slows otherwise by about J, and is off by as much as
    an outlier only the time √(2 · 4σ/J) before: so long beside what is foreign is left out, too.
    ``uncut``: the tracks with all frames.
    """
    films = []
    problem = found.problem
    decel = problem.asked.scales(problem.found(found.x))[0]
    hidden = math.sqrt(2.0 * FARTHEST * problem.noise[0] / decel)
    for film, whole, (x, _, _) in zip(problem.films, uncut, problem.each(), strict=True):
        out = ~found.kept[x] & (problem.kinds[x] != UNSEEN)
        ends = [_foreign(out), _foreign(out[::-1])]
        beside = math.ceil(min(hidden / film.usual_step, _BESIDE * (out.size - sum(ends))))
        for n, before in enumerate(ends):
            edge = before if n == 0 else out.size - before
            at = int(np.searchsorted(whole.frame, film.frame[min(edge, out.size - 1)]))
            at += edge == out.size
            ends[n] = before + beside if before and _ends(whole, at, beside, n == 0) else 0
        inner = np.arange(film.time.size)
        chosen = (inner >= ends[0]) & (inner < out.size - ends[1])
        same = bool(chosen.all()) or chosen.sum() < FEWEST + 2
        films.append(film if same else film.part(chosen))
    same = all(a is b for a, b in zip(films, found.problem.films, strict=True))
    return found.problem.films if same else tuple(films)


def _ends(whole: Seen, at: int, beside: int, first: bool) -> bool:
    """Whether the free motion begins, or ends, about a frame since something touches the puck."""
    rests = rests_from(whole, noise_of([whole])[0])
    if not whole.cuttable[0 if first else 1] or (first and at >= rests - FEWEST):
        return False
    if touched(whole, at - beside - _SLACK, at + beside + _SLACK) is not None:
        return True
    count = whole.time.size
    foreign, free = ((0, at), (at, count)) if first else ((at, count), (0, at))
    return pushed(whole, *foreign) and not pushed(whole, *free)


def is_clean(found: Estimate, excess: float = 1.2, chance: float = 0.01) -> bool:
    """Whether what is left of a track is noise, no more than that of a smooth motion."""
    return _excess(found) < excess and min(runs(found), drift(found)) > chance


def _excess(found: Estimate) -> float:
    """The residuals over those of any smooth motion; 1 where these are not known."""
    smooth = noise_of(list(found.problem.films))[0]
    size = found.problem.noise[0] * math.sqrt(found.chi2 / max(found.degrees, 1))
    return size / smooth if smooth > 0.0 else 1.0


def without_ends(film: Seen) -> list[Seen]:
    """A track without what lies before or after a touch, where that is the smaller part."""
    order = np.arange(film.time.size)
    count = round(_SMALLER * order.size)
    parts = []
    at = touched(film, 0, count) if film.cuttable[0] else None
    if at is not None:
        parts.append(film.part(order >= at))
    at = touched(film, order.size - count, order.size) if film.cuttable[1] else None
    if at is not None:
        parts.append(film.part(order < at))
    return [part for part in parts if part.time.size >= FEWEST + 2]


def _foreign(out: npt.NDArray[np.bool_]) -> int:
    """How many frames at the beginning are mostly outliers."""
    counts = np.cumsum(out)
    sizes = np.arange(1, out.size + 1)
    blocks = out & (counts >= _MOSTLY * sizes) & (sizes >= _FEWEST_OUT)
    found = np.flatnonzero(blocks)
    return int(found[-1]) + 1 if found.size else 0

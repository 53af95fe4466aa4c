"""Frames at the ends of a track that are no free motion: a hand before, a grip or a wall after."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from puck_tables.fitting.estimate import FARTHEST, Estimate
from puck_tables.fitting.observations import FEWEST, Observations, noise_of, rests_from
from puck_tables.fitting.problem import UNSEEN
from puck_tables.fitting.residual_tests import drift, runs
from puck_tables.fitting.touch_detection import first_touch, pushed

_FEWEST_OUT = 3  # frames at an end that are more than single outliers
_BESIDE = 0.1  # of the frames that are left, at most
_SMALLER = 0.45  # of the frames: a hand or what a wall did
_SLACK = 3  # frames
_MOSTLY = 0.7  # of them are outliers


def trimmed(result: Estimate, uncut: tuple[Observations, ...]) -> tuple[Observations, ...]:
    """The tracks without what lies at their ends and is not of the motion.

    What is off there is left out where something touches the puck (:mod:`.first_touch`); else it is
    the model that is wrong.  A hand that lets go slows otherwise by about J, and is off by as much
    as an outlier only the time √(2 · 4σ/J) before: so long beside what is foreign is left out, too.
    ``uncut``: the tracks with all frames.
    """
    films = []
    problem = result.problem
    decel = problem.spec.scales(problem.numbers_at(result.x))[0]
    hidden = math.sqrt(2.0 * FARTHEST * problem.noise[0] / decel)
    for film, whole, (x, _, _) in zip(problem.films, uncut, problem.each(), strict=True):
        out = ~result.kept[x] & (problem.kinds[x] != UNSEEN)
        ends = [_foreign(out), _foreign(out[::-1])]
        close = math.ceil(min(hidden / film.usual_step, _BESIDE * (out.size - sum(ends))))
        for n, before in enumerate(ends):
            edge = before if n == 0 else out.size - before
            at = int(np.searchsorted(whole.frame, film.frame[min(edge, out.size - 1)]))
            at += edge == out.size
            ends[n] = before + close if before and _ends(whole, at, close, n == 0) else 0
        inner = np.arange(film.time.size)
        chosen = (inner >= ends[0]) & (inner < out.size - ends[1])
        same = bool(chosen.all()) or chosen.sum() < FEWEST + 2
        films.append(film if same else film.part(chosen))
    same = all(a is b for a, b in zip(films, result.problem.films, strict=True))
    return result.problem.films if same else tuple(films)


def _ends(whole: Observations, at: int, close: int, first: bool) -> bool:
    """Whether the free motion begins, or ends, about a frame since something touches the puck."""
    rests = rests_from(whole, noise_of([whole])[0])
    if not whole.cuttable[0 if first else 1] or (first and at >= rests - FEWEST):
        return False
    if first_touch(whole, at - close - _SLACK, at + close + _SLACK) is not None:
        return True
    count = whole.time.size
    foreign, free = ((0, at), (at, count)) if first else ((at, count), (0, at))
    return pushed(whole, *foreign) and not pushed(whole, *free)


def is_clean(result: Estimate, excess: float = 1.2, chance: float = 0.01) -> bool:
    """Whether what is left of a track is noise, no more than that of a smooth motion."""
    return _excess(result) < excess and min(runs(result), drift(result)) > chance


def _excess(result: Estimate) -> float:
    """The residuals over those of any smooth motion; 1 where these are not known."""
    smooth = noise_of(list(result.problem.films))[0]
    size = result.problem.noise[0] * math.sqrt(result.chi2 / max(result.degrees, 1))
    return size / smooth if smooth > 0.0 else 1.0


def without_ends(film: Observations) -> list[Observations]:
    """A track without what lies before or after a touch, where that is the smaller part."""
    order = np.arange(film.time.size)
    count = round(_SMALLER * order.size)
    parts = []
    at = first_touch(film, 0, count) if film.cuttable[0] else None
    if at is not None:
        parts.append(film.part(order >= at))
    at = first_touch(film, order.size - count, order.size) if film.cuttable[1] else None
    if at is not None:
        parts.append(film.part(order < at))
    return [part for part in parts if part.time.size >= FEWEST + 2]


def _foreign(out: npt.NDArray[np.bool_]) -> int:
    """How many frames at the beginning are mostly outliers."""
    counts = np.cumsum(out)
    sizes = np.arange(1, out.size + 1)
    blocks = out & (counts >= _MOSTLY * sizes) & (sizes >= _FEWEST_OUT)
    result = np.flatnonzero(blocks)
    return int(result[-1]) + 1 if result.size else 0

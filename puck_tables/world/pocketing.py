"""Launches after which a puck falls into a pocket: not single ones, but regions with a middle."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.world.engine_state import Whole
from puck_tables.world.launches import good
from puck_tables.world.shots import Landings, Shots
from puck_tables.world.solving import HEADINGS, Which

_FIRST = 1e-7  # of the range: the first step from a launch to the ends of its interval
_LADDER = 24  # steps, each twice the one before
_CUT, _CUTS = 12, 4  # into how many parts a bracket of an end is cut, and how often
_WITHIN = 31  # places in an interval that are looked at
_TURNS = 2  # from the middle of one interval to that of the other
_MOST = 16  # regions


class Regions(NamedTuple):
    """Launches (n, 2) in the middle, the widths (n, 2) of the intervals there, where they land."""

    launches: FloatArray
    widths: FloatArray
    landings: Landings


class Pocketing:
    """Regions of launches on a board that end in the obstacle ``fate``, with few enough impacts.

    ``most``: how many; ``asked``: whether by the way asked for; ``low``, ``high``: between which
    the speed (or spin) may be.
    """

    def __init__(
        self, shots: Shots, outcome: int, most: int, wanted: bool, low: float, high: float
    ) -> None:
        self.shots, self.fate, self.most, self.asked = shots, outcome, most, wanted
        self.low, self.high = low, high

    def falls(self, landings: Landings) -> Which:
        """Which of them end there."""
        return good(landings, self.most, self.asked) & (landings.fates == self.fate)

    def regions(self, launches: FloatArray) -> Regions:
        """The regions in which some of these launches lie, the widest first.

        Each is given by a launch half-way between the ends of both intervals through it, of the
        heading and of the speed (or spin); ends are those of what is met first.
        """
        landings = self.shots.land(launches)
        inside = np.flatnonzero(self.falls(landings))
        inside = self._some(inside, landings.prints)
        middles = launches[inside].copy()
        widths = np.zeros_like(middles)
        for turn in range(2 * _TURNS):
            axis = (turn + 1) % 2
            if len(middles):
                ends = self._interval(middles, axis)
                middles[:, axis] += 0.5 * (ends[:, 0] + ends[:, 1])
                widths[:, axis] = ends[:, 1] - ends[:, 0]
        landings = self.shots.land(middles)
        order = np.flatnonzero(self.falls(landings) & (widths > 0.0).all(axis=1))
        share = (widths / np.array([HEADINGS, self.high - self.low])).min(axis=1)
        kept: list[int] = []
        for n in order[np.argsort(-share[order], kind="stable")].tolist():
            gaps = middles[kept] - middles[n]
            gaps[:, 0] = (gaps[:, 0] + math.pi) % HEADINGS - math.pi
            same = landings.prints[kept] == landings.prints[n]
            if not (same & (np.abs(gaps) < 0.5 * widths[kept]).all(axis=1)).any():
                kept.append(n)
        return Regions(middles[kept], widths[kept], landings.at(np.array(kept, np.int64)))

    def _some(self, inside: Whole, prints: Whole) -> Whole:
        """A few of each course in turn."""
        seen: dict[int, int] = {}
        turns = []
        for n in inside.tolist():
            seen[int(prints[n])] = seen.get(int(prints[n]), 0) + 1
            turns.append(seen[int(prints[n])])
        return inside[np.argsort(turns, kind="stable")[:_MOST]]

    def _interval(self, middles: FloatArray, axis: int) -> FloatArray:
        """How far the intervals of one number reach to both sides, (n, 2)."""
        span = HEADINGS if axis == 0 else self.high - self.low
        ends = np.empty((len(middles), 2))
        for side, sign in enumerate((-1.0, 1.0)):
            room = np.full(len(middles), 0.5 * span)
            if axis == 1:
                room = sign * ((self.low, self.high)[side] - middles[:, 1])
            steps = np.minimum(_FIRST * span * 2.0 ** np.arange(_LADDER), room[:, None])
            inner, outer = self._last_in(middles, axis, sign, np.zeros_like(room), steps)
            for _ in range(_CUTS):
                parts = np.linspace(0.0, 1.0, _CUT + 1)[1:]
                steps = inner[:, None] + (outer - inner)[:, None] * parts
                inner, outer = self._last_in(middles, axis, sign, inner, steps)
            within = inner[:, None] * (np.arange(_WITHIN) + 1.0) / _WITHIN
            inner, _ = self._last_in(middles, axis, sign, np.zeros_like(room), within)
            ends[:, side] = sign * inner
        return ends

    def _last_in(
        self, middles: FloatArray, axis: int, sign: float, known: FloatArray, steps: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """The last of steps (n, k) from the middles before one leads out, and the next.

        The same where none does.  ``known`` (n,): one that does not.
        """
        tried = np.repeat(middles[:, None], steps.shape[1], axis=1)
        tried[:, :, axis] += sign * steps
        falls = self.falls(self.shots.land(tried.reshape(-1, 2))).reshape(steps.shape)
        last = np.where(falls.all(axis=1), steps.shape[1], np.argmin(falls, axis=1))[:, None]
        ladder = np.hstack([known[:, None], steps])
        after = np.minimum(last + 1, steps.shape[1])
        return (
            np.take_along_axis(ladder, last, 1)[:, 0], np.take_along_axis(ladder, after, 1)[:, 0]
        )  # fmt: skip

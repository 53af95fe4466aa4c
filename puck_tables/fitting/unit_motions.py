"""Motions of one kind of puck, at any launch and height, and how they change with these.

All motions of a puck of one pressure law, height and spread of mass are one curve, up to rotation,
reflection and scale.  A fit asks for that curve at angles and heights that change a little from one
question to the next:

* plain pucks are looked up in the stop table;
* in full contact the friction ratios of every law are polynomials of degree 2 in δ, so one small
  table of resultants gives the section of every height;
* a uniform puck with δ > 1 has a section of its own for each height, at a fifth of a second each;
  there motions are interpolated between heights :data:`HEIGHT_STEP` apart, which are kept.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Self

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.contact.laws import Law, law_of
from puck_tables.motion.body import body_of, plain_up_to
from puck_tables.motion.frame import frame_of
from puck_tables.motion.state import HEADING, ORIENTATION, PUCK_X, PUCK_Y, SPEED, SPIN, STATE_ROWS
from puck_tables.stopping.launch_arrays import launches_in
from puck_tables.stopping.launch_frame import fill_placed_states
from puck_tables.stopping.plain_states import fill_state_slopes
from puck_tables.stopping.state_values import directions, looked_up
from puck_tables.stopping.stop_table import StopTable
from puck_tables.stopping.variational import Variations, unit_states, variations_by
from puck_tables.table.friction_slopes import slopes_at_one_height, slopes_of_table
from puck_tables.table.resultant_table import ResultantTable, full_contact

# of δ, between heights: a cubic through four of them errs by 3e-5 of the path at 3.83, less below:
# test_motions_between_the_heights_of_tall_pucks_are_those_of_the_puck
HEIGHT_STEP = 0.05
HIGHEST = 3.9  # δ, below the fold of the balance at 3.96 (contact.one_sided)
_ACCURACY = 1e-7  # of friction ratios; a film knows places to 1e-4 of the path
_LOCAL = 1e-9  # of a step: a hundredth of that
_BY_DELTA = 4  # of the derivatives of unit states


class UnitMotions:
    """Motions of pucks of one kind; ``highest``: the largest δ for which they are known.

    ``accuracy``: of the path, to which places are; ``angle``: at which a body stands at the launch,
    rad; None of round ones, which look alike.
    """

    highest: float
    accuracy: float = 1e-7  # that of friction ratios, below
    angle: float | None = None

    def facing(self, angle: float) -> Self:
        """Motions of a body that stands at an angle (rad) at the launch."""
        return self

    def own(self, delta: float, cosine: float, sine: float, tau: FloatArray) -> FloatArray:
        """States with Q = J = r = 1 and their derivatives, (n, 6, 6), as of ``unit_states``."""
        raise NotImplementedError

    def states(self, launches: FloatArray, times: FloatArray) -> FloatArray:
        """States (6, m, n), x, y, body angle, vx, vy, ω, of launches from (0, 0).

        ``launches`` (6, m): vx, vy, ω, δ, J, r of each; ``times`` (m, n): s, ≥ 0.
        """
        out = np.zeros((6, *times.shape))
        for k, launch in enumerate(launches.T):
            if launch[:3].any():
                out[:, k] = self.states_and_slopes(launch, times[k])[0]
        return out

    def states_and_slopes(
        self, launch: FloatArray, times: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """States (6, n) of a launch (6,), and their derivatives (n, 6, 7) by it and by time."""
        vx, vy, spin, _, decel, radius = launch.tolist()
        frame, slopes = frame_of((vx, vy), spin, decel, radius), np.empty((times.size, 6, 7))
        ratios = frame.speed / frame.slip, frame.rim / frame.slip
        own = self.own(float(launch[3]), *ratios, times / frame.time)
        fill_placed_states(launch, times, own, slopes)
        x, y, turn, ahead, aside, rim = own[:, :, 0].T
        pace = frame.slip / frame.length
        states = np.stack([
            *frame.place(x, y), frame.side * (frame.length / frame.radius) * turn,
            *(pace * np.array(frame.place(ahead, aside))),
            frame.side * (frame.slip / frame.radius) * rim,
        ])  # fmt: skip
        return states, slopes


class PlainMotions(UnitMotions):
    """Homogeneous pucks under uniform pressure, δ ≤ 1, looked up.

    >>> launch = np.array([[1.0, 0.0, 1.0, 1.0, 1.0, 1.0]]).T
    >>> PlainMotions().states(launch, np.array([[9.0]]))[:2, 0, 0].round(8).tolist()  # the stop
    [0.64818746, -0.08594902]
    """

    highest, accuracy = 1.0, 1e-9

    def states(self, launches: FloatArray, times: FloatArray) -> FloatArray:
        """By the stop table."""
        table = StopTable.shipped()
        which = np.repeat(np.arange(len(times)), times.shape[1])
        rows = looked_up(table, table.pucks(launches_in(launches)), which, times.ravel())
        headings = directions(launches[0], launches[1])[:, None]
        return cartesian(rows.reshape(STATE_ROWS, *times.shape), headings)

    def states_and_slopes(
        self, launch: FloatArray, times: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """By the slopes of the stop table."""
        table, one = StopTable.shipped(), np.zeros(1, np.int64)
        pucks = table.pucks(launches_in(launch[:, None]))
        rows, slopes = looked_up(table, pucks, one, times), np.empty((times.size, 6, 7))
        fill_state_slopes(table, pucks, one, times, rows, slopes)
        return cartesian(rows, directions(launch[:1], launch[1:2])), slopes


class LawMotions(UnitMotions):
    """Pucks of any pressure law and spread of mass, in full contact.

    >>> ring = LawMotions(law_of("ring"), 1.0)
    >>> launch = np.array([[1.0, 0.0, 1.0, 0.0, 1.0, 1.0]]).T
    >>> speed, _, spin = ring.states(launch, np.array([[0.5]]))[3:, 0, 0]  # its limit motion
    >>> round(float(spin / speed), 6)
    1.0
    """

    def __init__(self, law: Law, gyration: float) -> None:
        self._table, self._gyration = _law_table(law), gyration
        self.highest = full_contact(law)

    def own(self, delta: float, cosine: float, sine: float, tau: FloatArray) -> FloatArray:
        """By the table of the law."""
        friction = variations_by(slopes_of_table(self._table, delta), self._gyration)
        return unit_states(friction, cosine, sine, tau, _LOCAL)


class TallMotions(UnitMotions):
    """Uniform pucks of any height: motions interpolated between those of a few heights.

    >>> launch = np.array([[1.0, 0.0, 5.0, 2.0, 1.0, 1.0]]).T
    >>> TallMotions(0.5**0.5).states(launch, np.array([[99.0]]))[:2, 0, 0].round(5).tolist()
    [2.40884, -0.57795]
    """

    highest = HIGHEST

    def __init__(self, gyration: float) -> None:
        self._gyration, self._plain = gyration, PlainMotions()
        self._is_plain = plain_up_to("uniform", gyration) > 0.0

    def states_and_slopes(
        self, launch: FloatArray, times: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Cubic in δ through the motions of four heights; looked up up to δ = 1."""
        if self._is_plain and launch[3] <= self._plain.highest:
            return self._plain.states_and_slopes(launch, times)
        return super().states_and_slopes(launch, times)

    def own(self, delta: float, cosine: float, sine: float, tau: FloatArray) -> FloatArray:
        """Of that cubic, by δ exactly."""
        out = np.zeros((tau.size, 6, 6))
        for height, weight, slope in _heights(delta):
            friction = _tall_variations(height, self._gyration)
            result = unit_states(friction, cosine, sine, tau, _LOCAL)
            result[:, :, _BY_DELTA] = 0.0
            out += weight * result
            out[:, :, _BY_DELTA] += slope * result[:, :, 0]
        return out


def _heights(delta: float) -> list[tuple[float, float, float]]:
    """Four heights around δ, their weights in the cubic through them, and these by δ."""
    first = min(max(int(delta / HEIGHT_STEP) - 1, 0), round(HIGHEST / HEIGHT_STEP) - 3)
    place, result = delta / HEIGHT_STEP - first, []
    for k in range(4):
        others = [m for m in range(4) if m != k]
        below = math.prod(k - m for m in others)
        weight = math.prod(place - m for m in others) / below
        slope = sum(math.prod(place - m for m in others if m != n) for n in others) / below
        result.append((round((first + k) * HEIGHT_STEP, 9), weight, slope / HEIGHT_STEP))
    return result


@lru_cache(maxsize=64)
def _tall_variations(delta: float, gyration: float) -> Variations:
    section = body_of("uniform", delta, gyration).friction(_ACCURACY)
    return variations_by(slopes_at_one_height(section), gyration)


@lru_cache(maxsize=32)
def _law_table(law: Law) -> ResultantTable:
    return ResultantTable.build(law, _ACCURACY)


@lru_cache(maxsize=64)
def unit_motions_of(pressure: str | Law, gyration: float, tall: bool = False) -> UnitMotions:
    """The motions of a kind of puck; ``tall``: whether part of the base may lift.

    >>> type(unit_motions_of("uniform", 0.5**0.5)).__name__, unit_motions_of("ring", 1.0).highest
    ('PlainMotions', 2.0)
    """
    law = pressure if isinstance(pressure, Law) else law_of(pressure)
    if law.can_lift and tall:
        return TallMotions(gyration)
    if plain_up_to(law, gyration) > 0.0:
        return PlainMotions()
    return LawMotions(law, gyration)


def cartesian(rows: FloatArray, headings: FloatArray | float) -> FloatArray:
    """States (6, …) with vx and vy from those with speed and heading."""
    heading, speed = rows[HEADING] + headings, rows[SPEED]
    return np.stack([
        rows[PUCK_X], rows[PUCK_Y], rows[ORIENTATION], speed * np.cos(heading),
        speed * np.sin(heading), rows[SPIN],
    ])  # fmt: skip

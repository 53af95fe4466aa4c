"""Motions of one kind of puck, at any launch and height, and how they change with these.

All motions of a puck of one pressure law, height and spread of mass are one curve, up to rotation,
reflection and scale.  A fit asks for that curve at angles and heights that change a little from one
question to the next:

* plain pucks are looked up in the stop table;
* in full contact the friction ratios of every law are polynomials of degree 2 in δ, so one small
  table of resultants gives the section of every height;
* a uniform puck with δ > 1 has a section of its own for each height, at a fifth of a second each;
  there motions are interpolated between heights :data:`HEIGHT_STEP` apart, which are kept.

Motions on a base that is not round depend on how the body stands to its velocity, so they are no
one curve: each is integrated.  With θ the angle of the body at the launch and R(θ) the rotation by
it,

    s(v, θ) = R(θ) s(R(−θ) v, 0) ,   ds/dθ = J s − (ds/dv) J v ,   J = R(π/2) ,

so what is known of θ = 0 tells all.  Derivatives are differences of motions nearby.
"""

from __future__ import annotations

import math
from copy import copy
from functools import lru_cache
from typing import Self

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.contact.base import Base
from puck_tables.contact.laws import Law, law_of
from puck_tables.kernels.base_friction import packed
from puck_tables.motion.body import body_of, plain_up_to
from puck_tables.motion.state import HEADING, ORIENTATION, PUCK_X, PUCK_Y, SPEED, SPIN, STATE_ROWS
from puck_tables.motion.unit_motion import Frame, frame_of
from puck_tables.stopping.launch_arrays import launches_in
from puck_tables.stopping.launch_derivatives import fill_placed_states
from puck_tables.stopping.solvers import followed
from puck_tables.stopping.state_values import directions, fill_state_slopes, looked_up
from puck_tables.stopping.stop_table import StopTable
from puck_tables.stopping.variational import Variations, unit_states, variations_by
from puck_tables.table.friction_section import slopes_at_one_height, slopes_of_table
from puck_tables.table.resultant_table import ResultantTable, full_contact

_LOCAL_ON_BASE = 1e-8  # of a step; a film knows places to 1e-4 of the path
_STEP = 1e-3  # of each argument, to both sides: slopes to some 1e-5
# of δ, between heights: a cubic through four of them errs by 3e-5 of the path at 3.83, less below:
# test_motions_between_the_heights_of_tall_pucks_are_those_of_the_puck
HEIGHT_STEP = 0.05
HIGHEST = 3.9  # δ, below the fold of the balance at 3.96 (contact.one_sided)
_ACCURACY = 1e-7  # of friction ratios; a film knows places to 1e-4 of the path
_LOCAL = 1e-9  # of a step: a hundredth of that
_BY_DELTA = 4  # of the derivatives of unit states
Sloped = tuple[FloatArray, FloatArray]  # some values, and their derivatives


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

    def own(self, delta: float, frame: Frame, times: FloatArray) -> FloatArray:
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

    def states_and_slopes(self, launch: FloatArray, times: FloatArray) -> Sloped:
        """States (6, n) of a launch (6,), and their derivatives (n, 6, 7) by it and by time."""
        vx, vy, spin, _, decel, radius = launch.tolist()
        frame, slopes = frame_of((vx, vy), spin, decel, radius), np.empty((times.size, 6, 7))
        own = self.own(float(launch[3]), frame, times)
        fill_placed_states(launch, times, own, slopes)
        angle = frame.side / frame.radius
        units = np.repeat([frame.length, frame.slip], 3) * [1.0, 1.0, angle, 1.0, 1.0, angle]
        return units[:, None] * own[:, :, 0].T, slopes


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

    def states_and_slopes(self, launch: FloatArray, times: FloatArray) -> Sloped:
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

    def own(self, delta: float, frame: Frame, times: FloatArray) -> FloatArray:
        """By the table of the law."""
        friction = variations_by(slopes_of_table(self._table, delta), self._gyration)
        return unit_states(friction, frame, times, _LOCAL)


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

    def states_and_slopes(self, launch: FloatArray, times: FloatArray) -> Sloped:
        """Cubic in δ through the motions of four heights; looked up up to δ = 1."""
        if self._is_plain and launch[3] <= self._plain.highest:
            return self._plain.states_and_slopes(launch, times)
        return super().states_and_slopes(launch, times)

    def own(self, delta: float, frame: Frame, times: FloatArray) -> FloatArray:
        """Of that cubic, by δ exactly."""
        out = np.zeros((times.size, 6, 6))
        for height, weight, slope in _heights(delta):
            friction = _tall_variations(height, self._gyration)
            result = unit_states(friction, frame, times, _LOCAL)
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


def cartesian(rows: FloatArray, headings: FloatArray | float) -> FloatArray:
    """States (6, …) with vx and vy from those with speed and heading."""
    heading, speed = rows[HEADING] + headings, rows[SPEED]
    return np.stack([
        rows[PUCK_X], rows[PUCK_Y], rows[ORIENTATION], speed * np.cos(heading),
        speed * np.sin(heading), rows[SPIN],
    ])  # fmt: skip


class BaseMotions(UnitMotions):
    """Pucks on one base, up to the height at which part of it would lift.

    ``radius`` of a launch is the reach of the base; ``gyration``: over that.

    >>> box = BaseMotions(Base.box(0.2, 0.1), 0.5)
    >>> launch = np.array([[1.0, 0.0, 0.0, 0.0, 2.0, box.reach]]).T
    >>> box.states(launch, np.array([[0.25, 9.0]]))[0].round(9).tolist()  # v t - J t²/2
    [[0.1875, 0.25]]
    """

    angle: float = 0.0
    accuracy = _LOCAL_ON_BASE

    def __init__(self, base: Base, gyration: float) -> None:
        self._gyration = gyration
        self.reach, self._packed = base.reach, packed(base, 0.0)
        self.highest = (4.0 - 1e-12) * base.highest_lever / base.reach  # a puck of it is one, too

    def facing(self, angle: float) -> Self:
        """Motions of a base that stands at an angle (rad) at the launch."""
        turned = copy(self)
        turned.angle = angle
        return turned

    def states(self, launches: FloatArray, times: FloatArray) -> FloatArray:
        """Integrated, at times that ascend."""
        rows = launches.copy()
        cosine, sine = math.cos(self.angle), math.sin(self.angle)
        turn = np.array([[cosine, -sine], [sine, cosine]])
        rows[:2] = turn.T @ launches[:2]
        rows[3], rows[5] = 0.25 * launches[3] * launches[5], self._gyration * launches[5]
        slip = np.hypot(np.hypot(rows[0], rows[1]), rows[5] * rows[2])
        moments = times * (rows[4] / np.maximum(slip, 1e-300))[:, None]
        ends = times.shape[1] * np.arange(len(times) + 1)
        _, rows_out, status = followed(self._packed, rows, _LOCAL_ON_BASE, moments.ravel(), ends, 1)
        rows_out[np.repeat(status != 0, times.shape[1])] = math.nan
        out = cartesian(rows_out.T.reshape(-1, *times.shape), 0.0)
        out[:2] = np.tensordot(turn, out[:2], 1)
        out[3:5] = np.tensordot(turn, out[3:5], 1)
        return out

    def states_and_slopes(self, launch: FloatArray, times: FloatArray) -> Sloped:
        """By motions to both sides in every argument, and in time."""
        slip = math.hypot(launch[0], launch[1], launch[5] * launch[2])
        sizes = np.array([slip, slip, slip / launch[5], self.highest, *launch[4:]])
        steps = _STEP * sizes
        nearby = launch[:, None] + np.diag(steps) * np.array([1.0, -1.0])[:, None, None]
        every = np.concatenate([launch[:, None], *nearby], axis=1)
        base, later = self.states(every, np.tile(times, (13, 1))), _STEP * slip / launch[4]
        slopes = np.empty((times.size, 6, 7))
        ahead, behind = base[:, 1:7], base[:, 7:]
        slopes[:, :, :6] = ((ahead - behind) / (2.0 * steps[:, None])).transpose(2, 0, 1)
        one = launch[:, None]
        soon = [self.states(one, np.maximum(times + by, 0.0)[None])[:, 0] for by in (later, -later)]
        slopes[:, :, 6] = (soon[0] - soon[1]).T / (2.0 * later)
        slopes[:, :3, 6] = base[3:, 0].T[:, :3]
        return base[:, 0], slopes


@lru_cache(maxsize=64)
def unit_motions_of(contact: str | Law | Base, gyration: float, tall: bool = False) -> UnitMotions:
    """The motions of a kind of puck, under a pressure law or on a base.

    ``gyration``: over r, or the reach of the base; ``tall``: whether part of the base may lift.

    >>> type(unit_motions_of("uniform", 0.5**0.5)).__name__, unit_motions_of("ring", 1.0).highest
    ('PlainMotions', 2.0)
    >>> round(unit_motions_of(Base.disc(0.05), 0.5**0.5).highest, 9)
    1.0
    """
    if isinstance(contact, Base):
        return BaseMotions(contact, gyration)
    law = contact if isinstance(contact, Law) else law_of(contact)
    if law.can_lift and tall:
        return TallMotions(gyration)
    if plain_up_to(law, gyration) > 0.0:
        return PlainMotions()
    return LawMotions(law, gyration)

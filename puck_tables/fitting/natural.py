"""Motions of one kind of puck in natural units, at any slip angle and height.

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
from abc import ABC, abstractmethod
from functools import lru_cache

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.accuracy.methods import FrictionForm
from puck_tables.contact.laws import Law, law_of
from puck_tables.motion.body import body_of, plain_up_to
from puck_tables.motion.frame import frame_of
from puck_tables.motion.friction_source import Friction, section_friction
from puck_tables.motion.limits import log_ratio
from puck_tables.motion.state import HEADING, ORIENTATION, PUCK_X, PUCK_Y, SPIN, STATE_ROWS, T
from puck_tables.motion.steppers import Stepping
from puck_tables.motion.tableaus import DORMAND_PRINCE
from puck_tables.motion.unit_motion import MotionRun, at_constant_slip, integrated
from puck_tables.stopping.plain_states import fill_state_slopes
from puck_tables.stopping.state_values import known_pucks, looked_up
from puck_tables.stopping.stop_table import StopTable
from puck_tables.stopping.variational import Varied, natural_states, varied_by
from puck_tables.table.friction_section import section_of_table
from puck_tables.table.friction_slopes import flow_at_one_height, flow_of_table
from puck_tables.table.resultant_table import ResultantTable
from puck_tables.table.resultant_values import full_contact

HEIGHT_STEP = 0.05
HIGHEST = 3.9
_ACCURACY = 1e-7  # of friction ratios; a film knows places to 1e-4 of the path
_STEPPING = Stepping(DORMAND_PRINCE, 0.0, 1e-9)
_KEPT = 8
PATH, RATE, BY_PHI, BY_DELTA = range(4)
_PATH_ROWS = [PUCK_X, PUCK_Y, ORIENTATION]
_ODD = [PUCK_Y, HEADING, ORIENTATION, SPIN]  # change sign with the spin


class Curve(ABC):
    """States of pucks of one kind, with Q₀ = J = r = 1 and the launch along x.

    ``highest``: the largest δ for which it is known.
    """

    highest: float

    @abstractmethod
    def first_quadrant(self, phi: FloatArray, delta: FloatArray, tau: FloatArray) -> FloatArray:
        """States for 0 ≤ φ ≤ π/2, as :meth:`states`."""

    @abstractmethod
    def varied(self, phi: float, delta: float, tau: FloatArray) -> FloatArray:
        """Paths and their derivatives for 0 ≤ φ ≤ π/2, as :meth:`with_slopes`."""

    def states(self, phi: FloatArray, delta: FloatArray, tau: FloatArray) -> FloatArray:
        """States at natural times.

        Parameters
        ----------
        phi : array (m,), slip angle of the launch, atan2(rω, v), negative for clockwise spin
        delta : array (m,), δ of each
        tau : array (m, n), t J/Q of each, ≥ 0

        Returns
        -------
        array (6, m, n)
            x, y, heading from that of the launch, body angle, v, ω.
        """
        out = self.first_quadrant(np.abs(phi), delta, tau)
        clockwise = phi < 0.0
        if clockwise.any():
            for row in _ODD:
                out[row, clockwise] *= -1.0
        return out

    def with_slopes(self, phi: float, delta: float, tau: FloatArray) -> FloatArray:
        """One path and its derivatives.

        Parameters
        ----------
        phi : slip angle of the launch, negative for clockwise spin
        delta : δ
        tau : array (n,), t J/Q, ≥ 0

        Returns
        -------
        array (4, 3, n)
            Of x, y and body angle: themselves, their rates, by φ, by δ.
        """
        out = self.varied(abs(phi), delta, tau)
        if phi < 0.0:
            out[:, 1:] *= -1.0  # y and the body angle are odd
            out[BY_PHI] *= -1.0
        return out


class PlainCurve(Curve):
    """Homogeneous pucks under uniform pressure, δ ≤ 1, looked up.

    Examples
    --------
    >>> one = np.array([math.pi / 4]), np.array([1.0]), np.array([[9.0]])
    >>> PlainCurve().states(*one)[:2, 0, 0].round(8).tolist()  # X, Y at the stop
    [0.32409373, -0.04297451]
    """

    highest = 1.0

    def first_quadrant(self, phi: FloatArray, delta: FloatArray, tau: FloatArray) -> FloatArray:
        """By the stop table."""
        count, frames = tau.shape
        launches = np.zeros((6, count))
        launches[0], launches[2], launches[3] = np.cos(phi), np.sin(phi), delta
        launches[4:] = 1.0
        which = np.repeat(np.arange(count), frames)
        table = StopTable.shipped()
        found = looked_up(table, known_pucks(table, launches), which, tau.ravel())
        return found.reshape(STATE_ROWS, count, frames)

    def varied(self, phi: float, delta: float, tau: FloatArray) -> FloatArray:
        """By the slopes of the stop table."""
        launch = np.array([[math.cos(phi), 0.0, math.sin(phi), delta, 1.0, 1.0]]).T
        table = StopTable.shipped()
        pucks, one = known_pucks(table, launch), np.zeros(1, np.int64)
        values, slopes = looked_up(table, pucks, one, tau), np.empty((tau.size, 6, 7))
        fill_state_slopes(table, pucks, one, tau, values, slopes)
        by_speed, _, by_rim, by_delta, _, _, rate = slopes[:, :3].T
        out = np.empty((4, 3, tau.size))
        out[PATH], out[RATE], out[BY_DELTA] = values[_PATH_ROWS], rate, by_delta
        out[BY_PHI] = math.cos(phi) * by_rim - math.sin(phi) * by_speed
        return out


class IntegratedCurve(Curve):
    """Pucks whose friction is a section."""

    @abstractmethod
    def friction(self, delta: float) -> Friction:
        """Their friction at one height."""

    @abstractmethod
    def flow(self, delta: float) -> Varied:
        """The same with its derivatives."""

    def varied(self, phi: float, delta: float, tau: FloatArray) -> FloatArray:
        """By variational equations."""
        return _varied(phi, self.flow(delta), tau)

    def first_quadrant(self, phi: FloatArray, delta: FloatArray, tau: FloatArray) -> FloatArray:
        """Each integrated."""
        out = np.empty((STATE_ROWS, *tau.shape))
        for n, (angle, height) in enumerate(zip(phi.tolist(), delta.tolist(), strict=True)):
            out[:, n] = self.motion(angle, height, tau[n])
        return out

    def motion(self, phi: float, delta: float, tau: FloatArray) -> FloatArray:
        """States (6, n) of one launch."""
        return _integrated(phi, self.friction(delta), tau)


class LawCurve(IntegratedCurve):
    """Pucks of any pressure law and spread of mass, in full contact.

    Examples
    --------
    >>> ring = LawCurve(law_of("ring"), 1.0)
    >>> one = np.array([math.pi / 4]), np.array([0.0]), np.array([[0.5]])
    >>> speed, spin = ring.states(*one)[4:, 0, 0]  # its limit motion
    >>> round(float(spin / speed), 6)
    1.0
    """

    def __init__(self, law: Law, gyration: float) -> None:
        self._table, self._gyration = _law_table(law), gyration
        self.highest = full_contact(law)
        self._kept: dict[float, Friction] = {}

    def friction(self, delta: float) -> Friction:
        """From the table of the law; the last few are kept."""
        if delta not in self._kept:
            section = section_of_table(self._table, delta, 1.0)
            cut = section.for_motion(self._gyration)
            if len(self._kept) >= _KEPT:
                self._kept.pop(next(iter(self._kept)))
            self._kept[delta] = Friction(FrictionForm.TABLE, delta, cut, section.tolerance)
        return self._kept[delta]

    def flow(self, delta: float) -> Varied:
        """From the table of the law."""
        return varied_by(flow_of_table(self._table, delta), self._gyration)


class TallCurve(IntegratedCurve):
    """Uniform pucks of any height: motions interpolated between those of a few heights.

    Examples
    --------
    >>> one = np.array([math.atan(5.0)]), np.array([2.0]), np.array([[9.0]])
    >>> place = TallCurve(0.5**0.5).states(*one)[:2, 0, 0] * 26.0
    >>> place.round(5).tolist()  # of v = 1, r ω = 5
    [2.40884, -0.57795]
    """

    highest = HIGHEST

    def __init__(self, gyration: float) -> None:
        self._gyration, self._plain = gyration, PlainCurve()
        self._is_plain = plain_up_to("uniform", gyration) > 0.0

    def friction(self, delta: float) -> Friction:
        """A section of its own."""
        return section_friction(body_of("uniform", delta, self._gyration), _ACCURACY)

    def flow(self, delta: float) -> Varied:
        """The same: how motions change with δ, their cubic tells."""
        return _tall_flow(delta, self._gyration)

    def motion(self, phi: float, delta: float, tau: FloatArray) -> FloatArray:
        """Cubic in δ through the motions of four heights; looked up up to δ = 1."""
        if self._is_plain and delta <= self._plain.highest:
            one = np.array([phi]), np.array([delta]), tau[None, :]
            return self._plain.first_quadrant(*one)[:, 0]
        out = np.zeros((STATE_ROWS, tau.size))
        for height, weight, _ in _heights(delta):
            if weight != 0.0:
                out += weight * _integrated(phi, self.friction(height), tau)
        return out

    def varied(self, phi: float, delta: float, tau: FloatArray) -> FloatArray:
        """Of the same cubic, by δ exactly."""
        if self._is_plain and delta <= self._plain.highest:
            return self._plain.varied(phi, delta, tau)
        out = np.zeros((4, 3, tau.size))
        for height, weight, slope in _heights(delta):
            found = _varied(phi, self.flow(height), tau)
            out[:BY_DELTA] += weight * found[:BY_DELTA]
            out[BY_DELTA] += slope * found[PATH]
        return out


def _heights(delta: float) -> list[tuple[float, float, float]]:
    """Four heights around δ, their weights in the cubic through them, and these by δ."""
    first = min(max(int(delta / HEIGHT_STEP) - 1, 0), round(HIGHEST / HEIGHT_STEP) - 3)
    place, found = delta / HEIGHT_STEP - first, []
    for k in range(4):
        others = [m for m in range(4) if m != k]
        below = math.prod(k - m for m in others)
        weight = math.prod(place - m for m in others) / below
        slope = sum(math.prod(place - m for m in others if m != n) for n in others) / below
        found.append((round((first + k) * HEIGHT_STEP, 9), weight, slope / HEIGHT_STEP))
    return found


@lru_cache(maxsize=64)
def _tall_flow(delta: float, gyration: float) -> Varied:
    section = body_of("uniform", delta, gyration).friction(_ACCURACY)
    return varied_by(flow_at_one_height(section), gyration)


@lru_cache(maxsize=32)
def _law_table(law: Law) -> ResultantTable:
    return ResultantTable.build(law, _ACCURACY)


@lru_cache(maxsize=64)
def curve_of(pressure: str | Law, gyration: float, tall: bool = False) -> Curve:
    """The motions of a kind of puck.

    Parameters
    ----------
    pressure, gyration
        As :class:`puck_tables.Puck`.
    tall : whether part of the base may lift

    Examples
    --------
    >>> type(curve_of("uniform", 0.5**0.5)).__name__, curve_of("ring", 1.0).highest
    ('PlainCurve', 2.0)
    """
    law = pressure if isinstance(pressure, Law) else law_of(pressure)
    if law.can_lift and tall:
        return TallCurve(gyration)
    if plain_up_to(law, gyration) > 0.0:
        return PlainCurve()
    return LawCurve(law, gyration)


def _integrated(phi: float, friction: Friction, tau: FloatArray) -> FloatArray:
    """States (6, n) of one launch at natural times."""
    speed, rim = math.cos(phi), math.sin(phi)
    run = _run(speed, rim, friction)
    frame = frame_of((speed, 0.0), rim, 1.0, 1.0)
    moments = np.where(tau < float(run.stop[T]), tau, np.inf)
    return np.stack(frame.states(*run.states(moments)))


def _varied(phi: float, friction: Varied, tau: FloatArray) -> FloatArray:
    """A path and its derivatives, as :meth:`Curve.with_slopes`."""
    cosine, sine = math.cos(phi), math.sin(phi)
    own = natural_states(friction, cosine, sine, tau, _STEPPING.local)[0][:, :3].T
    return np.stack([own[0], own[5], cosine * own[3] - sine * own[1], own[4]])


def _run(speed: float, rim: float, friction: Friction) -> MotionRun:
    if rim <= 1e-12:
        return at_constant_slip("C0", -math.inf, friction)
    if speed <= 1e-12:
        return at_constant_slip("B0", math.inf, friction)
    return integrated(log_ratio(speed, rim), friction, _STEPPING)

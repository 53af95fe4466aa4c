"""One motion in natural units: spin positive, start along x, Q₀ = J = r = 1.

The layer between the compiled loop and :mod:`puck_tables.trajectory`: elementary motions, and
integrated ones as fine as the tolerance asks.  Nobody has measured beforehand how far off a motion
is for every law and height.  Where friction is a section it is measured on the motion itself, by a
run of higher accuracy and by one with a coarser section.

In the world places are turned by the heading of the launch, mirrored for negative spin, and scaled:
times by Q₀/J, places by Q₀²/J.

And how much of the base carries load along a motion.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.accuracy.method_errors import Selection
from puck_tables.accuracy.methods import FrictionForm, Method
from puck_tables.contact.one_sided import loaded_share
from puck_tables.errors import PuckError
from puck_tables.kernels.quadratic import LINE
from puck_tables.motion.body import UnitPuck
from puck_tables.motion.equations_of_motion import (
    at_constant_angle,
    derivatives,
    inertia,
    kinetic_energy,
)
from puck_tables.motion.friction_source import Friction, FrictionSource
from puck_tables.motion.limits import log_ratio, regime_of
from puck_tables.motion.path import STOPPED, TURN_SHARE, integrate, states_at
from puck_tables.motion.solve import FINEST_LOCAL, ErrorEstimate, Setting, close_enough, refined
from puck_tables.motion.state import LENGTH, PSI, SIZE, THETA, WORK, T, U, X, Y
from puck_tables.motion.steppers import DORMAND_PRINCE, Stepping, Tableau
from puck_tables.table.singular_lines import opening_angle

GENERIC = ("B", "C")  # regimes that are integrated; the others are elementary

_FINEST_CHECK = 4e-15  # of a step: below, rounding is all that two runs differ by
_STEP_LIMIT = 20_000  # room for so many is made; more is a motion that does not end
_SAFETY = 1.5  # states between the moments compared
_ROUNDING = 1e-14  # of a motion as long as Q/J
_UNSEEN_SHARE = 0.1  # of the error of a section: two coarse ones may err alike
_MOMENTS = 16  # at which two motions are compared
_COARSER_BY = 4.0  # half as many cells are 16 times as bad; a quarter of that is believed


class Frame(NamedTuple):
    """A launch as a frame: ``speed`` v, ``rim`` r|ω|, ``slip`` Q₀ m/s, ``time`` s, ``length`` m.

    ``side`` is −1 for clockwise spin, ``east``, ``north`` and ``heading`` the direction of the
    velocity, x where there is none.
    """

    speed: float
    rim: float
    slip: float
    time: float
    length: float
    radius: float
    side: float
    east: float
    north: float
    heading: float

    def place(self, x: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray]:
        """World coordinates, m, from natural ones."""
        along, left = self.length * x, self.side * self.length * y
        return (
            along * self.east - left * self.north + 0.0,
            along * self.north + left * self.east + 0.0,
        )

    def unit_times(self, times: FloatArray, stop_time: float) -> FloatArray:
        """Times (n,) s in natural units; infinite from the stop on."""
        return np.where(times < stop_time, times, np.inf) / (self.time or 1.0)

    def states(self, q: FloatArray, y: FloatArray) -> tuple[FloatArray, ...]:
        """States of the puck from Q/Q₀ (n,) and natural states (n, 8), six arrays (n,).

        X, y m; heading rad, from that at the launch; body angle rad; v m/s; ω rad/s.
        """
        cosine, sine = direction(y[:, U])
        turned = self.side * y[:, THETA] * (self.length / self.radius) + 0.0
        spin = self.side * (self.slip * q * sine / self.radius) + 0.0  # Q/r may overflow, ω not
        speed = self.slip * q * cosine
        return *self.place(y[:, X], y[:, Y]), self.side * y[:, PSI], turned, speed, spin


def frame_of(velocity: tuple[float, float], spin: float, decel: float, radius: float) -> Frame:
    """The frame of a launch.

    ``velocity``, ``spin``: m/s, rad/s; ``decel``, ``radius``: J m/s², r m.

    >>> frame = frame_of((0.0, 3.0), -2.0, 5.0, 2.0)
    >>> frame.slip, frame.time, frame.length
    (5.0, 1.0, 5.0)
    >>> [float(x) for x in frame.place(np.array(1.0), np.array(0.5))]
    [2.5, 5.0]
    """
    vx, vy = velocity
    speed, rim = math.hypot(vx, vy), radius * abs(spin)
    slip = math.hypot(speed, rim)
    east, north = (vx / speed, vy / speed) if speed > 0.0 else (1.0, 0.0)
    return Frame(
        speed, rim, slip, slip / decel, slip / decel * slip, radius, -1.0 if spin < 0.0 else 1.0,
        east, north, math.atan2(vy, vx) if speed > 0.0 else 0.0,
    )  # fmt: skip


def direction(u: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Cos φ and sin φ from u = ln tan φ, to the last digits at both ends.

    >>> [float(x.round(6)) for x in direction(np.array(-np.inf))]
    [1.0, 0.0]
    """
    k = np.exp(-np.abs(u))
    large = 1.0 / np.sqrt(1.0 + k * k)
    return np.where(u > 0.0, k * large, large), np.where(u > 0.0, large, k * large)


@dataclass
class MotionRun:
    """Step ends (z, state) from launch to stop; ``stop`` is the state there, its ψ the turn.

    ``regime``: as :func:`puck_tables.motion.limits.regime_of` has it.
    """

    friction: Friction
    tableau: Tableau
    z: FloatArray
    y: FloatArray
    stop: FloatArray
    turn_rate: float
    energy_residual: float
    steps: int
    error: float
    regime: str = ""

    def states(self, times: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Q/Q₀ (n,) and states (n, 8) at times; at and after the stop Q = 0."""
        if not times.any():  # the launch alone, as a report needs it: nothing to compile
            return np.ones(times.size), np.tile(self.y[0], (times.size, 1))
        q, y = np.empty(times.size), np.empty((times.size, SIZE))
        states_at(
            times, self.z, self.y, self.stop, self.tableau, self.friction.coefficients,
            self.friction.delta, q, y,
        )  # fmt: skip
        return q, y


def solve(
    source: FrictionSource, speed: float, rim: float, tol: float, method: Method | None = None
) -> tuple[MotionRun, Selection]:
    """The motion of a launch with speed v and rim speed r|ω| in natural units, and how it was got.

    Raises AccuracyError if the tolerance is out of reach; ContactError if part of the base would be
    lifted on the way, where that is not computed.

    >>> from puck_tables.motion.body import body_of
    >>> from puck_tables.motion.friction_source import source_of
    >>> run, selection = solve(source_of(body_of("uniform", 0.0, 0.5**0.5)), 1.0, 5.0, 1e-9)
    >>> round(float(run.stop[T]), 6), run.regime, selection.scheme.name  # T(φ) of Q/J
    (0.774875, 'B', 'adaptive, table')
    """
    selection = source.selected("trajectory", tol, method)
    regime = regime_of(speed, rim, source.limit, source.limit_width)
    u = {"A": -math.inf, "B0": math.inf, "C0": -math.inf}.get(regime) or log_ratio(speed, rim)
    if regime not in GENERIC:
        source.refuse(u)
        friction, at_limit, rounding = source.at_constant_angle(tol)
        run = at_constant_slip(regime, u, friction)
        error = (rounding + (at_limit if regime == "D" else 0.0)) * max(1.0, float(run.stop[T]))
        run.error = error
        return run, selection
    # φ moves monotonically to φ₀ and the tilt falls with φ: the smaller of both is the worst
    source.refuse(min(u, source.limit))
    attempt = partial(_attempt, source, u, tol)
    finer = partial(refined, tol=tol, friction=source.next_accuracy)
    first = source.first(selection)
    run, estimate, setting = close_enough(first, attempt, finer, tol, "this puck")
    if setting is not first or not source.is_measured:
        selection = source.explained(selection, setting, estimate)
    run.error, run.regime = estimate.total, regime
    return run, selection


def at_constant_slip(regime: str, u: float, friction: Friction) -> MotionRun:
    """A motion in elementary functions, u = ln(r|ω|/v) throughout.

    >>> from puck_tables.motion.friction_source import closed_form_friction
    >>> float(at_constant_slip("C0", -math.inf, closed_form_friction(0.5)).stop[T])
    1.0
    """
    start, stop, turned = np.zeros((1, SIZE)), np.zeros(SIZE), np.zeros(SIZE)
    start[0, U] = stop[U] = u
    residual = 0.0
    if regime != "A":
        at_constant_angle(1.0, start[0], 0.0, friction.coefficients, friction.delta, stop)
        at_constant_angle(1.0, start[0], TURN_SHARE, friction.coefficients, friction.delta, turned)
        stop[PSI] = turned[PSI]
        energy = kinetic_energy(1.0, u, inertia(friction.coefficients))
        residual = abs(stop[WORK] - energy) / energy
    rate = -turned[PSI] / math.log(TURN_SHARE)
    return MotionRun(
        friction, DORMAND_PRINCE, np.zeros(1), start, stop, rate, residual, 0, math.inf, regime
    )


def integrated(u: float, friction: Friction, stepping: Stepping) -> MotionRun:
    """A motion by one setting of the integrator, its error not known.

    Raises PuckError if the stop is not reached.

    >>> from puck_tables.motion.friction_source import closed_form_friction
    >>> from puck_tables.motion.steppers import RK4
    >>> run = integrated(0.0, closed_form_friction(1.0), Stepping(RK4, 64.0, 1.0))
    >>> float(run.stop[T].round(6))
    0.986476
    """
    z, y = np.empty(_STEP_LIMIT), np.empty((_STEP_LIMIT, SIZE))
    result = np.empty(SIZE + 1)
    status, count = integrate(
        u, stepping.tableau, float(stepping.steps), stepping.local, 1.0, friction.coefficients,
        friction.delta, _STEP_LIMIT, z, y, result,
    )  # fmt: skip
    if status != STOPPED:
        raise PuckError(
            f"the integration did not reach the stop in {_STEP_LIMIT} steps: ask for less accuracy"
        )
    rates = np.empty(SIZE)  # at z = 0, dz = −d ln Q/4
    derivatives(0.0, y[count - 1], friction.coefficients, friction.delta, rates)
    return MotionRun(
        friction,
        stepping.tableau,
        z=z[:count].copy(),
        y=y[:count].copy(),
        stop=result[:SIZE],
        turn_rate=0.25 * float(rates[PSI]),
        energy_residual=float(result[SIZE]),
        steps=count - 1,
        error=math.inf,
    )


def _attempt(
    source: FrictionSource, u: float, tol: float, setting: Setting
) -> tuple[MotionRun, ErrorEstimate]:
    """A motion by one setting, and its error: by a run of higher accuracy, and by its friction.

    Where the error of the friction is known the stop is compared; else whole motions are, also with
    one by a coarser section.
    """
    stepping, friction = setting.stepping, source.friction(setting.accuracy)
    run = integrated(u, friction, stepping)
    coarser = source.coarser(setting.accuracy)
    if coarser is None:
        finer = integrated(u, friction, stepping.finer(2.0, 0.1, _FINEST_CHECK))
        difference = float(np.abs(run.stop[T : X + 2] - finer.stop[T : X + 2]).max())
        return run, ErrorEstimate(difference + 0.01 * tol, friction.error)
    finer = integrated(u, friction, stepping.finer(2.0, 0.01, FINEST_LOCAL))
    by_steps = _SAFETY * (apart(run, finer) + unseen_tail(stepping))
    by_friction = apart(run, integrated(u, coarser, stepping)) / _COARSER_BY
    rounding = _ROUNDING * max(1.0, float(run.stop[T]))
    return run, ErrorEstimate(by_steps, by_friction + _UNSEEN_SHARE * friction.error, rounding)


def unseen_tail(stepping: Stepping) -> float:
    """What two settings of the integrator may miss alike: the last of Q, at constant angle.

    >>> unseen_tail(Stepping(DORMAND_PRINCE, 0.0, 1e-8))
    1e-10
    """
    return (2.0 * stepping.steps) ** -4.0 if stepping.fixed else 0.01 * stepping.local


def apart(one: MotionRun, other: MotionRun) -> float:
    """How far two motions of a launch are apart: at the stop, and at moments of the first."""
    speed, rim = _speeds((1.0 - one.z) ** 4, one.y[:, U])
    # where the speeds change most, errors of the time count most
    varied = np.cumsum(np.abs(np.diff(speed)) + np.abs(np.diff(rim)))
    at = 1 + np.unique(np.searchsorted(varied, np.linspace(0.02, 0.98, _MOMENTS) * varied[-1]))
    here, speed, rim = one.y[at], speed[at], rim[at]
    q_there, there = other.states(here[:, T])
    speed_there, rim_there = _speeds(q_there, there[:, U])
    off = [
        (one.stop - other.stop)[T:WORK],
        *(here - there)[:, [X, Y, THETA, LENGTH]].T,
        speed - speed_there,
        rim - rim_there,
        np.minimum(speed, speed_there) * (here - there)[:, PSI],
    ]
    return max(float(np.abs(row).max()) for row in off)


def _speeds(q: FloatArray, u: FloatArray) -> tuple[FloatArray, FloatArray]:
    """V and r|ω| from Q and u."""
    cosine, sine = direction(u)
    return q * cosine, q * sine


@dataclass(frozen=True)
class Contact:
    """How much of the base carries load along a motion.

    ``launch`` and ``least``: the share of the base, 1 in full contact.  ``opens``, ``closes``: when
    part of the base lifts and when all of it is down again, in units of Q₀/J; None: never.
    """

    launch: float = 1.0
    least: float = 1.0
    opens: float | None = None
    closes: float | None = None


def contact_of(body: UnitPuck, run: MotionRun) -> Contact:
    """What carries load along a motion: the share grows with φ, and φ is monotonic in time.

    >>> from puck_tables.motion.body import body_of
    >>> from puck_tables.motion.friction_source import source_of
    >>> from puck_tables.motion.unit_motion import solve
    >>> body = body_of("uniform", 2.0, 0.5**0.5)
    >>> run, _ = solve(source_of(body), 1.0, 0.0, 1e-6)
    >>> round(contact_of(body, run).least, 6)
    0.647743
    """
    if run.friction.source is not FrictionForm.SECTION or run.regime == "A":
        return Contact()
    opening = opening_angle(body.delta) if body.law.can_lift else 0.0
    if opening == 0.0:
        return Contact()
    start = math.atan(math.exp(min(run.y[0, U], 700.0)))
    end = math.atan(body.limit_ratio) if run.regime in GENERIC else start
    launch, last = loaded_share([start, end], body.delta).tolist()
    lifted, lifts = start < opening, end < opening
    if lifted == lifts:
        return Contact(launch, min(launch, last))
    lines = run.friction.coefficients[::2, LINE]  # a step ends exactly on the line
    line = lines[np.abs(lines - math.log(math.tan(opening))).argmin()]
    ends = np.flatnonzero(run.y[:, U] == line)
    time = float(run.y[ends[0], T]) if ends.size else 0.0
    return Contact(launch, min(launch, last), *((time, None) if lifts else (None, time)))

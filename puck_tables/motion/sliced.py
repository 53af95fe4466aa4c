"""One motion of any puck: any pressure law, any radius of gyration, part of the base lifted.

Friction is a slice (:mod:`puck_tables.table.friction_slice`), made for the puck and as fine as the
tolerance needs.  Nobody has measured beforehand how far off a motion is for every law and height.
It is measured on the motion itself, by a run of higher accuracy and by one with a coarser slice,
and what is not good enough is done again.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
import numpy.typing as npt

from puck_tables._core.real import real, rounded_up
from puck_tables.accuracy.front import ADAPTIVE_EXACT, COARSEST, RK4_EXACT, Choice, choose
from puck_tables.contact.one_sided import loaded_share
from puck_tables.errors import AccuracyError
from puck_tables.kernels.slice_spline import LINE
from puck_tables.motion.body import Body
from puck_tables.motion.equations import LENGTH, PSI, THETA, WORK, T, U, X, Y
from puck_tables.motion.limits import log_ratio, regime_of
from puck_tables.motion.run import (
    CONSTANT_ANGLE,
    Friction,
    Run,
    at_constant_slip,
    step_ends,
    turn_rate_at,
)
from puck_tables.motion.steppers import DORMAND_PRINCE, RK4, Tableau
from puck_tables.table.friction_slice import FINEST_ACCURACY

FloatArray = npt.NDArray[np.float64]

FINEST_TOL = 1e-11
STATES_TOL = 1e-9
# A start this close to the limit ratio (in ln(rω/v)) is the limit motion: truth is good to 1e-13.
LIMIT_WIDTH = 1e-12

# Looser, a step of a very tall puck leaps over the bend below φ = π/4, and no estimate sees it.
LOOSEST_LOCAL = 1e-7
_FINEST_LOCAL = 1e-15
_MOST_STEPS = 4096
_SAFETY = 1.5  # states between the moments compared
_ROUNDING = 1e-14  # of a motion as long as Q/J
_UNSEEN_SHARE = 0.1  # of the error of a slice: two coarse ones may err alike
_MOMENTS = 16  # at which two motions are compared
_COARSER_BY = 4.0  # half as many cells are 16 times as bad; a quarter of that is believed
_FROM_FRICTION = 20.0  # tol that surely goes with an error of the friction


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


def checked_tol(tol: float) -> float:
    """A tolerance that can be met for every puck.

    Raises
    ------
    AccuracyError

    Examples
    --------
    >>> checked_tol(1e-9)
    1e-09
    """
    wanted = real("tol", tol, "dimensionless")
    if not FINEST_TOL <= wanted <= COARSEST:
        raise AccuracyError(
            f"tol must be from {FINEST_TOL:g} to {COARSEST:g} for a puck under another pressure "
            f"law, with another radius of gyration or delta above 1, got {wanted:g}"
        )
    return wanted


@lru_cache(maxsize=64)
def friction_of(body: Body, accuracy: float, coarser: bool = False) -> Friction:
    """The friction of a puck as the integrator reads it.

    Raises
    ------
    AccuracyError
        If its pressure law is too rough for it; it says which ``tol`` is not.
    """
    try:
        found = body.friction(accuracy)
    except AccuracyError as error:
        if error.reachable is None:
            raise
        finest = rounded_up(_FROM_FRICTION * error.reachable)
        raise AccuracyError(
            f"an error of {accuracy:.1g} of the friction is out of reach under the pressure law "
            f"{body.law.name}: give tol (--tol) of {finest:g} or more"
        ) from None
    return Friction(body.delta, found.for_motion(body.gyration, coarser), found.error)


def run_sliced(
    body: Body, regime: str, speed: float, rim: float, tol: float, method: str | None = None
) -> tuple[Run, Choice]:
    """The motion of a launch with speed v and rim speed r|ω| in natural units, and how it was got.

    Raises
    ------
    AccuracyError
        If the tolerance is out of reach.

    Examples
    --------
    >>> from puck_tables.motion.body import body_of
    >>> run, choice = run_sliced(body_of("uniform", 2.0, 0.5**0.5), "C", 0.8, 0.6, 1e-6)
    >>> round(float(run.stop[T]), 5), run.error <= 1e-6
    (1.13721, True)
    """
    accuracy = max(0.5 * tol, FINEST_ACCURACY)
    if regime in CONSTANT_ANGLE:
        ends = {"A": -math.inf, "B0": math.inf, "C0": -math.inf}
        u = ends[regime] if regime in ends else log_ratio(speed, rim)
        friction = friction_of(body, accuracy)
        run = at_constant_slip(regime, u, friction)
        share = 4.0 * friction.error * max(1.0, 0.5 / body.inertia) if regime == "D" else 0.0
        error = (share + _ROUNDING) * max(1.0, float(run.stop[T]))
        return replace(run, error=error), _choice(body, accuracy, ADAPTIVE_EXACT, "", error, tol)
    u = log_ratio(speed, rim)
    stepper = RK4_EXACT if method == "rk4" else ADAPTIVE_EXACT
    tableau = RK4 if method == "rk4" else DORMAND_PRINCE
    known = choose("trajectory", tol, (stepper,)).way  # good for δ ≤ 1: where to begin
    steps = known.number("steps") if method == "rk4" else 0.0
    local = 1.0 if method == "rk4" else min(known.number("local"), LOOSEST_LOCAL)
    while True:
        friction = friction_of(body, accuracy)
        run = _run(u, friction, tableau, steps, local)
        finer = _run(u, friction, tableau, 2.0 * steps, max(0.01 * local, _FINEST_LOCAL))
        by_steps = _apart(run, finer) + unseen_tail(steps, local)
        other = _run(u, friction_of(body, accuracy, coarser=True), tableau, steps, local)
        by_slice = _apart(run, other) / _COARSER_BY + _UNSEEN_SHARE * friction.error
        error = _SAFETY * by_steps + by_slice + _ROUNDING * max(1.0, float(run.stop[T]))
        if error <= tol:
            break
        if by_slice > by_steps and accuracy > FINEST_ACCURACY:
            accuracy = max(0.1 * accuracy, FINEST_ACCURACY)
        elif by_slice > by_steps or steps >= _MOST_STEPS or local <= _FINEST_LOCAL:
            raise AccuracyError(
                f"tol = {tol:g} is out of reach for this puck: give tol (--tol) of "
                f"{rounded_up(2.0 * error):g} or more"
            )
        else:
            gain = min(max(0.5 * tol / error, 0.1), 0.5)  # an error falls like the local one
            steps, local = math.ceil(steps / gain**0.25), max(gain * local, _FINEST_LOCAL)
    setting = f"steps={steps:g}" if method == "rk4" else f"local={local:g}"
    return replace(run, error=error), _choice(body, accuracy, stepper, setting, error, tol)


def _run(u: float, friction: Friction, tableau: Tableau, steps: float, local: float) -> Run:
    """A motion by one setting of the integrator, its error not known."""
    z, y, result = step_ends(u, friction, tableau, steps, local)
    return Run(
        friction,
        tableau,
        z=z,
        y=y,
        stop=result[:-1],
        turn_rate=turn_rate_at(y[-1], friction),
        energy_residual=float(result[-1]),
        steps=len(z) - 1,
        error=math.inf,
    )


def unseen_tail(steps: float, local: float) -> float:
    """What two settings of the integrator may miss alike: the last of Q, at constant angle.

    Examples
    --------
    >>> unseen_tail(0.0, 1e-8), unseen_tail(10.0, 1.0)
    (1e-10, 6.25e-06)
    """
    return 0.01 * local if steps == 0.0 else (2.0 * steps) ** -4.0


def _apart(one: Run, other: Run) -> float:
    """How far two motions of a launch are apart: at the stop, and at moments of the first."""
    speed, rim = _speeds((1.0 - one.z) ** 4, one.y[:, U])
    # where the speeds change most, errors of the time count most
    way = np.cumsum(np.abs(np.diff(speed)) + np.abs(np.diff(rim)))
    at = 1 + np.unique(np.searchsorted(way, np.linspace(0.02, 0.98, _MOMENTS) * way[-1]))
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
    """V and r|ω| from Q and u, to the last digits at both ends."""
    k = np.exp(-np.abs(u))
    large = q / np.sqrt(1.0 + k * k)
    return np.where(u > 0.0, k * large, large), np.where(u > 0.0, large, k * large)


def _choice(
    body: Body, accuracy: float, stepper: str, setting: str, error: float, tol: float
) -> Choice:
    """What was taken, and why, in words."""
    spline = body.friction(accuracy).spline
    way = choose("trajectory", COARSEST, (stepper,)).way
    method = stepper.replace("closed forms", "slice")
    way = replace(way, method=method, setting=setting, error=error)
    why = [
        f"asked         error <= {tol:.3g} of Q/J (times) and Q^2/J (places)",
        f"taken         {way.name}",
        f"friction      {len(spline.sides)} sides of {spline.cells} cells, ratios to "
        f"{float(spline.error.max()):.2g}, measured against the law itself",
        f"measured      {error:.2g} on this motion, by finer steps and by half the cells",
    ]
    return Choice(way, tol, "\n".join(why))


def contact_of(body: Body, regime: str, run: Run) -> Contact:
    """What carries load along a motion: the share grows with φ, and φ is monotonic in time.

    Examples
    --------
    >>> from puck_tables.motion.body import body_of
    >>> body = body_of("uniform", 2.0, 0.5**0.5)
    >>> run, _ = run_sliced(body, "C0", 1.0, 0.0, 1e-6)
    >>> round(contact_of(body, "C0", run).least, 6)
    0.647743
    """
    found = body.friction(COARSEST)
    if found.opening == 0.0 or regime == "A":
        return Contact()
    start = math.atan(math.exp(min(run.y[0, U], 700.0)))
    end = math.atan(body.limit_ratio) if regime in ("B", "C") else start
    launch, last = loaded_share([start, end], body.delta).tolist()
    lifted, lifts = start < found.opening, end < found.opening
    if lifted == lifts:
        return Contact(launch, min(launch, last))
    # a step ends exactly on the line
    line = min(range(len(found.lines)), key=lambda n: abs(found.lines[n] - found.opening))
    ends = np.flatnonzero(run.y[:, U] == found.cut[2 * line, LINE])
    time = float(run.y[ends[0], T]) if ends.size else 0.0
    return Contact(launch, min(launch, last), *((time, None) if lifts else (None, time)))


def states_of(body: Body, launch: FloatArray, times: FloatArray) -> FloatArray:
    """States of one puck at times (n,) s: x, y, heading from that at the launch, body angle, v, ω.

    Parameters
    ----------
    body : Body
    launch : array (6,): vx, vy, ω, δ, J, r
    times : array (n,), s, ≥ 0

    Returns
    -------
    array (6, n)

    Examples
    --------
    >>> from puck_tables.motion.body import body_of
    >>> launch = np.array([1.0, 0.0, 0.0, 2.0, 1.0, 1.0])
    >>> states = states_of(body_of("uniform", 2.0, 0.5**0.5), launch, np.array([0.5, 2.0]))
    >>> states[0].round(12).tolist()
    [0.375, 0.5]
    """
    vx, vy, spin, _, decel, radius = launch.tolist()
    speed, rim = math.hypot(vx, vy), radius * abs(spin)
    q0 = math.hypot(speed, rim)
    if q0 == 0.0:
        return np.zeros((6, times.size))
    regime = regime_of(speed, rim, body.limit, LIMIT_WIDTH)
    run, _ = run_sliced(body, regime, speed, rim, STATES_TOL)
    time, length = q0 / decel, q0 / decel * q0
    q, y = run.states(np.where(times < run.stop[T] * time, times / time, np.inf))
    slower, turning = _speeds(q, y[:, U])
    side = -1.0 if spin < 0.0 else 1.0
    east, north = (vx / speed, vy / speed) if speed > 0.0 else (1.0, 0.0)
    along, left = length * y[:, X], side * length * y[:, Y]
    return np.stack(
        [
            along * east - left * north,
            along * north + left * east,
            side * y[:, PSI],
            side * y[:, THETA] * (length / radius),
            q0 * slower,
            side * (q0 * turning / radius),  # Q/r may overflow where ω does not
        ]
    )

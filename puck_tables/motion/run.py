"""One motion in natural units: spin positive, start along x, Q₀ = J = r = 1.

The layer between the compiled loop and :mod:`puck_tables.trajectory`: which regime, which friction
(table or closed forms), which integrator.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from puck_tables.accuracy.front import Choice
from puck_tables.contact.closed_form import by_closed_form
from puck_tables.contact.integrals import SlipDirection
from puck_tables.contact.resultants import CONTACT_SLACK, pressure_tilt
from puck_tables.errors import PuckError
from puck_tables.kernels.closed_form import outside_full_contact
from puck_tables.motion.equations import (
    PSI,
    SIZE,
    WORK,
    T,
    U,
    X,
    at_constant_angle,
    derivatives,
    inertia,
    kinetic_energy,
)
from puck_tables.motion.limits import LIMIT_WIDTH, log_ratio
from puck_tables.motion.path import STOPPED, TURN_SHARE, integrate, states_at
from puck_tables.motion.steppers import DORMAND_PRINCE, RK4, Tableau
from puck_tables.table.resultant_table import ResultantTable

FloatArray = npt.NDArray[np.float64]

CONSTANT_ANGLE = ("A", "B0", "C0", "D")  # regimes with a solution in elementary functions

_STEP_LIMIT = 20_000


@dataclass(frozen=True)
class Friction:
    """What the loop reads at one δ: a table cut there, a slice, or nothing (closed forms)."""

    delta: float
    cut: FloatArray
    error: float


def closed_form_friction(delta: float) -> Friction:
    """Friction by the closed forms.

    Examples
    --------
    >>> closed_form_friction(0.5).error
    0.0
    """
    return Friction(delta, np.empty(0), 0.0)


def table_friction(delta: float, table: ResultantTable) -> Friction:
    """Friction by a table.

    Raises
    ------
    InputError
        If δ is outside its range, or it is of another pressure law.

    Examples
    --------
    >>> table_friction(0.5, ResultantTable.shipped()).error
    2e-11
    """
    return Friction(delta, table.section(delta), table.tolerance)


@dataclass(frozen=True)
class Run:
    """Step ends (z, state) from launch to stop; ``stop`` is the state there, its ψ the turn."""

    friction: Friction
    tableau: Tableau
    z: FloatArray
    y: FloatArray
    stop: FloatArray
    turn_rate: float
    energy_residual: float
    steps: int
    error: float

    def states(self, times: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Q/Q₀ (n,) and states (n, 8) at times; at and after the stop Q = 0."""
        if not times.any():  # the launch alone, as a report needs it: nothing to compile
            return np.ones(times.size), np.tile(self.y[0], (times.size, 1))
        q, y = np.empty(times.size), np.empty((times.size, SIZE))
        states_at(
            times, self.z, self.y, self.stop, self.tableau, self.friction.cut,
            self.friction.delta, q, y,
        )  # fmt: skip
        return q, y


def run_motion(
    regime: str,
    speed: float,
    rim: float,
    limit: float,
    friction: Friction,
    choice: Choice,
) -> Run:
    """The motion of a launch with speed v and rim speed r|ω| in natural units.

    ``limit`` is ln tan φ₀, where the motion tends to; ``choice`` the integrator and its setting.

    Raises
    ------
    ContactError
        If part of the base would be lifted on the way.

    Examples
    --------
    >>> from puck_tables.accuracy.front import INTEGRATED, choose
    >>> run = run_motion(
    ...     "B", 1.0, 5.0, 0.426, closed_form_friction(0.0), choose("trajectory", 1e-9, INTEGRATED)
    ... )
    >>> round(float(run.stop[T]), 6)  # T(φ) of Q/J
    0.774875
    """
    start = _log_ratio(regime, speed, rim)
    if regime in CONSTANT_ANGLE:
        _check_contact(friction.delta, start)
        return at_constant_slip(regime, start, closed_form_friction(friction.delta))
    # φ moves monotonically to φ₀ and the tilt falls with φ: the smaller of both is the worst
    _check_contact(friction.delta, min(start, limit))
    return _integrated(start, friction, choice)


def _log_ratio(regime: str, speed: float, rim: float) -> float:
    """U = ln(r|ω|/v); rest counts as sliding."""
    return {"A": -math.inf, "B0": math.inf, "C0": -math.inf}.get(regime) or log_ratio(speed, rim)


def at_constant_slip(regime: str, u: float, friction: Friction) -> Run:
    """A motion in elementary functions, u = ln(r|ω|/v) throughout.

    Examples
    --------
    >>> float(at_constant_slip("C0", -math.inf, closed_form_friction(0.5)).stop[T])
    1.0
    """
    start, stop, turned = np.zeros((1, SIZE)), np.zeros(SIZE), np.zeros(SIZE)
    start[0, U] = stop[U] = u
    residual = 0.0
    if regime != "A":
        at_constant_angle(1.0, start[0], 0.0, friction.cut, friction.delta, stop)
        at_constant_angle(1.0, start[0], TURN_SHARE, friction.cut, friction.delta, turned)
        stop[PSI] = turned[PSI]
        energy = kinetic_energy(1.0, u, inertia(friction.cut))
        residual = abs(stop[WORK] - energy) / energy
    return Run(
        friction,
        DORMAND_PRINCE,
        z=np.zeros(1),
        y=start,
        stop=stop,
        turn_rate=-turned[PSI] / math.log(TURN_SHARE),
        energy_residual=residual,
        steps=0,
        error=2.0 * LIMIT_WIDTH if regime == "D" else 1e-15,
    )


def _integrated(u: float, friction: Friction, choice: Choice) -> Run:
    """By the integrator; its error from a run of higher accuracy, plus that of the table."""
    steps, tolerance, tableau = 0.0, 1.0, DORMAND_PRINCE
    if choice.way.method.startswith("rk4"):
        steps, tableau = choice.way.number("steps"), RK4
    else:
        tolerance = choice.way.number("local")
    z, y, result = step_ends(u, friction, tableau, steps, tolerance)
    _, _, finer = step_ends(u, friction, tableau, 2.0 * steps, max(0.1 * tolerance, 4e-15))
    difference = float(np.abs(result[T : X + 2] - finer[T : X + 2]).max())
    return Run(
        friction,
        tableau,
        z=z,
        y=y,
        stop=result[:SIZE],
        turn_rate=turn_rate_at(y[-1], friction),
        energy_residual=float(result[SIZE]),
        steps=len(z) - 1,
        error=difference + 0.01 * choice.tol + friction.error,
    )


def turn_rate_at(state: FloatArray, friction: Friction) -> float:
    """Turn of the heading for each factor e of Q."""
    rates = np.empty(SIZE)
    derivatives(0.0, state, friction.cut, friction.delta, rates)
    return 0.25 * float(rates[PSI])  # at z = 0, dz = −d ln Q/4


def step_ends(
    u: float, friction: Friction, tableau: Tableau, steps: float, tolerance: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """The step ends z (n,), y (n, 8) of an integration, and its stop with the energy residual.

    Raises
    ------
    PuckError
        If the stop is not reached.
    """
    z, y = np.empty(_STEP_LIMIT), np.empty((_STEP_LIMIT, SIZE))
    result = np.empty(SIZE + 1)
    status, count = integrate(
        u, tableau, float(steps), tolerance, 1.0, friction.cut, friction.delta, _STEP_LIMIT, z, y,
        result,
    )  # fmt: skip
    if status != STOPPED:
        raise PuckError(
            f"the integration did not reach the stop in {_STEP_LIMIT} steps: ask for less accuracy"
        )
    return z[:count].copy(), y[:count].copy(), result


def _check_contact(delta: float, u: float) -> None:
    """Above δ = 1 the linear law holds state by state: refuse a u that lies outside it."""
    if delta <= 1.0:
        return
    direction = SlipDirection(np.asarray(math.exp(-abs(u))), np.asarray(u > 0.0))
    phi = math.atan(math.exp(min(u, 700.0)))
    tilt = pressure_tilt(by_closed_form(phi, delta), direction, delta)
    if not tilt <= 1.0 + CONTACT_SLACK:
        raise outside_full_contact(phi, delta)

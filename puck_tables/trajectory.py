"""One trajectory: from a launch to the stop, with states at any time and an energy account."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from puck_tables.contact.integrals import SlipDirection
from puck_tables.contact.resultants import CONTACT_SLACK, pressure_tilt
from puck_tables.errors import AccuracyError, InputError, PuckError
from puck_tables.puck import positive, real, velocity_array
from puck_tables.real import finite_array
from puck_tables.table.file import load_table
from puck_tables.table.table import Table

FloatArray = npt.NDArray[np.float64]

DEFAULT_ACCURACY = 1e-9
DEFAULT_FRAMES = 101
FINEST_ACCURACY = 1e-13
MAX_FRAMES = 10_000_000
_STEP_LIMIT = 20_000

CONSTANT_ANGLE = ("A", "B0", "C0", "D")  # regimes with a solution in elementary functions


@dataclass(frozen=True)
class Trajectory:
    """A motion from launch to stop.

    Scalars (SI): what went in (``v0`` m/s, ``w0`` rad/s, ``radius`` m, ``delta``, ``decel`` m/s²,
    ``mass`` kg), and

    * ``regime``: A rest, B0 pure spin, C0 pure translation, D limit motion, B, C generic;
    * ``stop_time`` s, ``stop_position`` (2,) m from the launch, ``path_length`` m;
    * ``turn_angle`` rad: how far the heading has turned when Q = hypot(v, rω) has fallen to 1/1000
      of its start; for δ > 0 it turns on, by ``turn_rate`` rad for each factor e of Q, and no
      final direction exists;
    * ``body_angle`` rad: how far the puck itself has turned;
    * ``limit_angle`` rad: φ₀(δ), which every generic motion approaches;
    * ``kinetic_energy`` J at the launch; ``energy_residual``: the largest difference between
      energy lost and work of friction along the path, as a share of it;
    * ``method``, ``steps``, and ``error_estimate`` in units of Q/J (times) and Q²/J (places).

    Arrays over ``time`` (n,) s: ``x``, ``y`` m; ``heading`` rad (of the velocity; at rest the
    heading of turn_angle); ``orientation`` rad (of the body); ``speed`` v m/s; ``spin`` ω rad/s;
    ``slip_speed`` Q m/s; ``slip_angle`` φ rad (at rest its limit).
    """

    v0: tuple[float, float]
    w0: float
    radius: float
    delta: float
    decel: float
    mass: float
    regime: str
    stop_time: float
    stop_position: tuple[float, float]
    path_length: float
    turn_angle: float
    turn_rate: float
    body_angle: float
    limit_angle: float
    kinetic_energy: float
    energy_residual: float
    method: str
    steps: int
    error_estimate: float
    time: FloatArray = field(repr=False)
    x: FloatArray = field(repr=False)
    y: FloatArray = field(repr=False)
    heading: FloatArray = field(repr=False)
    orientation: FloatArray = field(repr=False)
    speed: FloatArray = field(repr=False)
    spin: FloatArray = field(repr=False)
    slip_speed: FloatArray = field(repr=False)
    slip_angle: FloatArray = field(repr=False)


@dataclass(frozen=True)
class _Run:
    """A dimensionless run: step ends and the stop, spin positive, start along x."""

    s: FloatArray
    y: FloatArray
    result: FloatArray
    steps: int


def simulate(
    v0: npt.ArrayLike,
    w0: float,
    *,
    delta: float = 0.5,
    decel: float = 1.0,
    radius: float = 1.0,
    mass: float = 1.0,
    frames: int | None = None,
    times: npt.ArrayLike | None = None,
    accuracy: float = DEFAULT_ACCURACY,
    method: str = "adaptive",
    exact: bool = False,
    table: Table | None = None,
) -> Trajectory:
    """The motion of one puck until it stops.

    Parameters
    ----------
    v0 : (vx, vy), m/s
    w0 : spin, rad/s, counter-clockwise positive
    delta : dimensionless height 2fh/r
        In the table's range (0 to 1); with ``exact`` also above, where contact stays full.
    decel : J = fg, m/s², > 0
    radius : m, > 0
    mass : kg, > 0; only the energy depends on it
    frames : int, optional
        How many states, equally spaced from the launch to the stop (1: the launch); default 101.
    times : array_like, s, ≥ 0, any order, optional
        The times of the states instead; after the stop the puck is at rest.
    accuracy : float
        Largest error wanted, in units of Q/J (times) and Q²/J (places).
    method : 'adaptive' (Dormand–Prince 5(4)) or 'rk4'
    exact : bool
        Closed forms instead of the table.
    table : Table, optional
        The default table if left out.

    Returns
    -------
    Trajectory

    Raises
    ------
    InputError
        If an argument is not finite, has the wrong shape or lies outside its range.
    ContactError
        If part of the base would be lifted on the way: the linear pressure law ends there.
    AccuracyError
        If the accuracy is out of reach of table or method.

    References
    ----------
    Salnikova, Treschev, Gallyamov 2012, eq. 6.2–6.7.

    Examples
    --------
    >>> run = simulate((1.0, 0.0), 5.0)
    >>> run.regime, round(run.stop_time, 8), round(run.stop_position[0], 8)
    ('B', 3.96299205, 2.21395163)
    """
    velocity = velocity_array(v0)
    if velocity.shape != (2,):
        raise InputError(f"v0 must be one velocity (vx, vy) in m/s, got shape {velocity.shape}")
    vx, vy = (float(component) for component in velocity)
    spin = real("w0", w0, "rad/s")
    r, J = positive("radius", radius, "m"), positive("decel", decel, "m/s^2")
    m = positive("mass", mass, "kg")
    height = real("delta", delta, "")
    if exact and table is not None:
        raise InputError("exact and table exclude each other: closed forms need no table")
    if method not in ("adaptive", "rk4"):
        raise InputError(f"method must be 'adaptive' or 'rk4', got {method!r}")
    friction = _friction(height, exact, load_table() if table is None else table)
    _check_accuracy(accuracy, friction, exact)
    _check_frames(frames, times)

    from puck_tables.motion.limits import limit_log_ratio, regime_of

    speed, rim = math.hypot(vx, vy), r * abs(spin)
    q0 = math.hypot(speed, rim)
    limit = limit_log_ratio(height) if height < 2.0 else math.nan
    regime = regime_of(speed, rim, limit)
    scale_time, scale_length = q0 / J, q0 / J * q0
    if not math.isfinite(scale_length / r) or not math.isfinite(0.5 * m * q0 * q0):
        raise InputError(
            f"v0, w0 and decel give a motion too large for floating point (Q = {q0:g} m/s, "
            f"J = {J:g} m/s^2): use larger units"
        )

    if regime in CONSTANT_ANGLE:
        friction = _friction(height, exact=True, table=None)
    run, estimate = _run(regime, speed, rim, friction, height, accuracy, method)
    _check_contact(run, height)
    at = run.result
    stop_time = at[2] * scale_time
    moments = _moments(frames, times, stop_time)
    scaled = np.where(moments < stop_time, moments, np.inf) / (scale_time if q0 > 0.0 else 1.0)
    s, states = _states(run, regime, scaled, friction, height, method)

    side = -1.0 if spin < 0.0 else 1.0
    heading0 = math.atan2(vy, vx) if speed > 0.0 else 0.0
    east, north = (vx / speed, vy / speed) if speed > 0.0 else (1.0, 0.0)
    along, left = scale_length * states[:, 3], side * scale_length * states[:, 4]
    end_along, end_left = scale_length * at[3], side * scale_length * at[4]
    q = np.exp(-s)
    moving = np.isfinite(s)
    angle = _slip_angle(states[:, 0], regime, limit, moving)
    fraction = np.where(moving, q, 0.0)
    return Trajectory(
        v0=(vx, vy), w0=spin, radius=r, delta=height, decel=J, mass=m, regime=regime,
        stop_time=float(stop_time),
        stop_position=(
            float(end_along * east - end_left * north) + 0.0,
            float(end_along * north + end_left * east) + 0.0,
        ),
        path_length=float(at[6] * scale_length),
        turn_angle=float(side * at[1]) + 0.0,
        turn_rate=float(side * _turn_rate(run, regime, friction, height)) + 0.0,
        body_angle=float(side * at[5] * (scale_length / r)) + 0.0,
        limit_angle=math.atan(math.exp(limit)),
        kinetic_energy=0.5 * m * (speed * speed + 0.5 * rim * rim),
        energy_residual=float(at[8]),
        method=_method_name(regime, method, exact),
        steps=run.steps,
        error_estimate=estimate,
        time=moments,
        x=along * east - left * north + 0.0,
        y=along * north + left * east + 0.0,
        heading=heading0 + side * states[:, 1],
        orientation=side * states[:, 5] * (scale_length / r) + 0.0,
        speed=q0 * fraction * (np.cos(angle) if regime != "B0" else 0.0),
        spin=side * q0 / r * fraction * np.sin(angle) + 0.0,
        slip_speed=q0 * fraction,
        slip_angle=side * angle + 0.0,
    )  # fmt: skip


@dataclass(frozen=True)
class _Friction:
    """What the loop reads: the table cut at δ, or nothing for the closed forms."""

    cut: FloatArray
    error: float


def _friction(delta: float, exact: bool, table: Table | None) -> _Friction:
    if delta < 0.0:
        raise InputError(f"delta = 2 f h / r must not be negative, got {delta:g}")
    if exact or table is None:
        return _Friction(np.empty(0), 0.0)
    from puck_tables.kernels.spline import cut

    table.checked_range(delta)
    contracted = np.empty(6 * table.coefficients.shape[2])
    cut(table.coefficients, delta / table.delta_axis.upper, contracted)
    return _Friction(contracted, table.tolerance)


def _check_accuracy(accuracy: float, friction: _Friction, exact: bool) -> None:
    finest = max(FINEST_ACCURACY, 5.0 * friction.error)
    if not finest <= accuracy <= 0.01:
        raise AccuracyError(
            f"accuracy must be from {finest:.1g} to 0.01 (of Q/J and Q^2/J), got {accuracy:g}"
            + ("" if exact else "; closed forms (--exact) reach 1e-13")
        )


def _run(
    regime: str,
    speed: float,
    rim: float,
    friction: _Friction,
    delta: float,
    accuracy: float,
    method: str,
) -> tuple[_Run, float]:
    """The run and its error estimate: against a run of higher accuracy, plus the table's error."""
    from puck_tables.motion.equations import SIZE, at_constant_angle
    from puck_tables.motion.limits import log_ratio
    from puck_tables.motion.path import TURN_FALL
    from puck_tables.stops import RK4_CONSTANT

    if regime in CONSTANT_ANGLE:
        start, result = np.zeros((1, SIZE)), np.zeros(SIZE + 2)
        u = {"A": -math.inf, "B0": math.inf, "C0": -math.inf}.get(regime)
        start[0, 0] = result[0] = log_ratio(speed, rim) if u is None else u
        if regime != "A":
            turned = np.empty(SIZE)
            at_constant_angle(0.0, start[0], TURN_FALL, friction.cut, delta, turned)
            at_constant_angle(0.0, start[0], math.inf, friction.cut, delta, result[:SIZE])
            result[1] = turned[1]
            energy = _kinetic(start[0, 0])
            result[8] = abs(result[7] - energy) / energy
        return _Run(np.zeros(1), start, result, 0), 1e-15
    u = log_ratio(speed, rim)
    steps, tolerance = 0.0, 0.4 * accuracy
    if method == "rk4":
        steps = max(8.0, math.ceil((RK4_CONSTANT / accuracy) ** 0.25))
    run = _integrate(u, method, steps, tolerance, friction, delta)
    finer = _integrate(u, method, 2.0 * steps, max(0.1 * tolerance, 4e-15), friction, delta)
    difference = np.abs(run.result[2:5] - finer.result[2:5]).max()
    return run, float(difference) + friction.error + 1e-14


def _integrate(
    u: float, method: str, steps: float, tolerance: float, friction: _Friction, delta: float
) -> _Run:
    from puck_tables.motion.equations import SIZE
    from puck_tables.motion.path import STOPPED, integrate
    from puck_tables.motion.steppers import DORMAND_PRINCE, RK4

    s, y = np.empty(_STEP_LIMIT), np.empty((_STEP_LIMIT, SIZE))
    result = np.empty(SIZE + 2)
    status, count = integrate(
        u,
        DORMAND_PRINCE if method == "adaptive" else RK4,
        float(steps),
        tolerance,
        friction.cut,
        delta,
        _STEP_LIMIT,
        s,
        y,
        result,
    )
    if status != STOPPED:
        raise PuckError(
            f"the integration did not reach the stop in {_STEP_LIMIT} steps: ask for less accuracy"
        )
    return _Run(s[:count].copy(), y[:count].copy(), result, count - 1)


def _check_contact(run: _Run, delta: float) -> None:
    """Above δ = 1 the linear law holds state by state: refuse a path that leaves it."""
    if delta <= 1.0:
        return
    from puck_tables.kernels.closed_form import outside_full_contact
    from puck_tables.table.check import by_closed_form

    for u in run.y[:, 0]:
        fast = np.asarray(u > 0.0)
        direction = SlipDirection(np.asarray(math.exp(-abs(u))), fast)
        phi = math.atan(math.exp(u)) if u < 700.0 else 0.5 * math.pi
        tilt = pressure_tilt(by_closed_form(phi, delta), direction, delta)
        if not tilt <= 1.0 + CONTACT_SLACK:
            raise outside_full_contact(phi, delta)


def _check_frames(frames: int | None, times: npt.ArrayLike | None) -> None:
    if times is not None and frames is not None:
        raise InputError("frames and times both choose the states: give one of them")
    if frames is not None and not 1 <= frames <= MAX_FRAMES:
        raise InputError(f"frames must be from 1 to {MAX_FRAMES}, got {frames}")


def _moments(frames: int | None, times: npt.ArrayLike | None, stop_time: float) -> FloatArray:
    if times is None:
        return np.linspace(0.0, stop_time, DEFAULT_FRAMES if frames is None else frames)
    moments = np.atleast_1d(finite_array("times", times, "s"))
    if moments.ndim != 1 or moments.size == 0 or not np.all(moments >= 0.0):
        raise InputError("times must be a list of numbers >= 0 s")
    return moments


def _states(
    run: _Run,
    regime: str,
    times: FloatArray,
    friction: _Friction,
    delta: float,
    method: str,
) -> tuple[FloatArray, FloatArray]:
    from puck_tables.motion.path import states_at
    from puck_tables.motion.steppers import DORMAND_PRINCE, RK4

    s, y = np.empty(times.size), np.empty((times.size, run.y.shape[1]))
    if regime == "A":
        s.fill(math.inf)
        y[:] = run.result[: y.shape[1]]
        return s, y
    tableau = DORMAND_PRINCE if method == "adaptive" else RK4
    states_at(times, run.s, run.y, run.result, tableau, friction.cut, delta, s, y)
    return s, y


def _slip_angle(
    u: FloatArray, regime: str, limit: float, moving: npt.NDArray[np.bool_]
) -> FloatArray:
    """|φ|; at rest its limit, which for a puck that never moved is 0."""
    with np.errstate(over="ignore"):
        angle: FloatArray = np.arctan(np.exp(u))
    if regime in ("B", "C"):
        angle = np.where(moving, angle, math.atan(math.exp(limit)))
    return angle


def _turn_rate(run: _Run, regime: str, friction: _Friction, delta: float) -> float:
    """Turn of the heading for each factor e of Q, at the end."""
    if regime in ("A", "B0", "C0"):
        return 0.0
    from puck_tables.motion.equations import derivatives

    out = np.empty(run.y.shape[1])
    derivatives(0.0, run.y[-1], friction.cut, delta, out)
    return float(out[1])


def _kinetic(u: float) -> float:
    from puck_tables.motion.equations import kinetic_energy

    return float(kinetic_energy(0.0, u))


def _method_name(regime: str, method: str, exact: bool) -> str:
    source = "closed forms" if exact else "table"
    if regime in CONSTANT_ANGLE:
        return "exact solution at constant slip angle"
    stepper = "Dormand-Prince 5(4), adaptive" if method == "adaptive" else "Runge-Kutta 4"
    return f"{stepper}, {source}"

"""One trajectory: from a launch to the stop, with states at any time and an energy account."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from puck_tables.errors import InputError
from puck_tables.front import Choice, Way
from puck_tables.puck import positive, real, velocity_array
from puck_tables.real import finite_array, instance
from puck_tables.solvers import choose_with
from puck_tables.table.file import load_table
from puck_tables.table.table import Table

FloatArray = npt.NDArray[np.float64]

DEFAULT_TOL = 1e-9
DEFAULT_FRAMES = 101
MAX_FRAMES = 1_000_000
LOOK_UP_FRAMES = 10_000  # from here on states are looked up: 0.2 µs each instead of 4


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
    * ``method``, ``steps``, and ``error_estimate`` in units of Q/J (times) and Q²/J (places);
      ``choice``: what the tolerance led to (None where the motion is elementary).

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
    choice: Choice | None = field(repr=False)
    time: FloatArray = field(repr=False)
    x: FloatArray = field(repr=False)
    y: FloatArray = field(repr=False)
    heading: FloatArray = field(repr=False)
    orientation: FloatArray = field(repr=False)
    speed: FloatArray = field(repr=False)
    spin: FloatArray = field(repr=False)
    slip_speed: FloatArray = field(repr=False)
    slip_angle: FloatArray = field(repr=False)


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
    tol: float = DEFAULT_TOL,
    method: str | None = None,
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
    tol : float
        Largest error of the stop wanted, in units of Q/J (time) and Q²/J (place); 1e-13 to 0.01.
        The cheapest integrator whose measured error is below it is taken (a trajectory is
        integrated and not looked up: it carries an account of its energy); ``choice`` of the result
        says which and why.
    method : 'adaptive' (Dormand–Prince 5(4)) or 'rk4', optional
        Only this one.
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
        If the tolerance is out of reach of table or method.

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
    height = real("delta", delta, "dimensionless")
    instance("table", table, Table, type(None))
    if exact and table is not None:
        raise InputError("exact and table exclude each other: closed forms need no table")
    _check_frames(frames, times)
    if not 0.0 <= height < 2.0:
        raise InputError(
            f"delta = 2 f h / r must be from 0 to below 2, got {height:g}: the linear pressure law "
            "of full contact holds at every phi up to 1, and beyond 2 in no motion but pure spin"
        )

    from puck_tables.motion.equations import LENGTH, PSI, THETA, T, X, Y
    from puck_tables.motion.limits import limit_log_ratio, regime_of
    from puck_tables.run import closed_form_friction, run_motion, table_friction

    wanted = real("tol", tol, "dimensionless")
    if method not in (None, "adaptive", "rk4"):
        raise InputError(f"method must be 'adaptive' or 'rk4', got {method!r}")
    chosen = load_table() if table is None else table
    if not exact:
        chosen.checked_range(height)
    choice = choose_with("trajectory", wanted, method, table, exact)
    by_closed_form = exact or (table is None and choice.way.method.endswith("closed forms"))
    friction = closed_form_friction(height) if by_closed_form else table_friction(height, chosen)
    speed, rim = math.hypot(vx, vy), r * abs(spin)
    q0 = math.hypot(speed, rim)
    limit = limit_log_ratio(height)
    regime = regime_of(speed, rim, limit)
    scale_time, scale_length = q0 / J, q0 / J * q0
    energy = 0.5 * m * (speed * speed + 0.5 * rim * rim)
    if not all(map(math.isfinite, (scale_time, scale_length, scale_length / r, q0 / r, energy))):
        raise InputError(
            f"v0, w0, radius, decel and mass give a motion too large for floating point "
            f"(Q = {q0:g} m/s, J = {J:g} m/s^2): use larger units"
        )

    run = run_motion(regime, speed, rim, limit, friction, choice)
    stop_time = float(run.stop[T] * scale_time)
    moments = _moments(frames, times, stop_time)
    look_up = (
        moments.size >= LOOK_UP_FRAMES
        and regime in ("B", "C")
        and not exact
        and table is None
        and method is None
        and wanted >= DEFAULT_TOL
    )
    if look_up:
        till_rest = np.where(moments < stop_time, moments, 2.0 * stop_time)
        columns = _looked_up((vx, vy), spin, till_rest, height, J, r, math.atan(math.exp(limit)))
    else:
        scaled = np.where(moments < stop_time, moments, np.inf) / (scale_time if q0 > 0.0 else 1.0)
        q, states = run.states(scaled)
        columns = _integrated(q, states, (vx, vy), spin, q0, scale_length, r, regime, limit)
    side = -1.0 if spin < 0.0 else 1.0
    east, north = (vx / speed, vy / speed) if speed > 0.0 else (1.0, 0.0)
    end_along, end_left = scale_length * run.stop[X], side * scale_length * run.stop[Y]
    return Trajectory(
        v0=(vx, vy), w0=spin, radius=r, delta=height, decel=J, mass=m, regime=regime,
        stop_time=stop_time,
        stop_position=(
            float(end_along * east - end_left * north) + 0.0,
            float(end_along * north + end_left * east) + 0.0,
        ),
        path_length=float(run.stop[LENGTH] * scale_length),
        turn_angle=float(side * run.stop[PSI]) + 0.0,
        turn_rate=float(side * run.turn_rate) + 0.0,
        body_angle=float(side * run.stop[THETA] * (scale_length / r)) + 0.0,
        limit_angle=math.atan(math.exp(limit)),
        kinetic_energy=energy,
        energy_residual=run.energy_residual,
        method=_method_name(regime, choice.way, by_closed_form)
        + ("; states by look-up" if look_up else ""),
        steps=run.steps,
        error_estimate=run.error,
        choice=choice if regime in ("B", "C") else None,
        time=moments,
        **columns,
    )  # fmt: skip


def _integrated(
    q: FloatArray, states: FloatArray, v0: tuple[float, float], spin: float, q0: float,
    scale_length: float, radius: float, regime: str, limit: float,
) -> dict[str, FloatArray]:  # fmt: skip
    """States in natural units as the columns of a trajectory."""
    from puck_tables.motion.equations import PSI, THETA, U, X, Y

    side = -1.0 if spin < 0.0 else 1.0
    speed = math.hypot(*v0)
    heading0 = math.atan2(v0[1], v0[0]) if speed > 0.0 else 0.0
    east, north = (v0[0] / speed, v0[1] / speed) if speed > 0.0 else (1.0, 0.0)
    along, left = scale_length * states[:, X], side * scale_length * states[:, Y]
    cosine, sine = _direction(states[:, U])
    return {
        "x": along * east - left * north + 0.0,
        "y": along * north + left * east + 0.0,
        "heading": heading0 + side * states[:, PSI],
        "orientation": side * states[:, THETA] * (scale_length / radius) + 0.0,
        "speed": q0 * q * cosine,
        "spin": side * (q0 / radius) * q * sine + 0.0,
        "slip_speed": q0 * q,
        "slip_angle": side * _slip_angle(states[:, U], regime, limit, q > 0.0) + 0.0,
    }


def _looked_up(
    v0: tuple[float, float], spin: float, moments: FloatArray, delta: float, decel: float,
    radius: float, limit_angle: float,
) -> dict[str, FloatArray]:  # fmt: skip
    """The same by look-up: for many states the cheaper way."""
    from puck_tables.states import flow

    states = flow(v0, spin, moments, delta=delta, decel=decel, radius=radius)
    names = ("x", "y", "heading", "orientation", "speed", "spin", "slip_speed", "slip_angle")
    columns = {name: getattr(states, name) for name in names}
    at_rest = states.slip_speed == 0.0
    columns["slip_angle"] = np.where(
        at_rest, math.copysign(limit_angle, spin), columns["slip_angle"]
    )
    return columns


def _check_frames(frames: int | None, times: npt.ArrayLike | None) -> None:
    if times is not None and frames is not None:
        raise InputError("frames and times both choose the states: give one of them")
    if frames is not None and not (isinstance(frames, int) and 1 <= frames <= MAX_FRAMES):
        raise InputError(f"frames must be from 1 to {MAX_FRAMES}, got {frames}")


def _moments(frames: int | None, times: npt.ArrayLike | None, stop_time: float) -> FloatArray:
    if times is None:
        return np.linspace(0.0, stop_time, DEFAULT_FRAMES if frames is None else frames)
    moments = np.atleast_1d(finite_array("times", times, "s"))
    if moments.ndim != 1 or moments.size == 0 or not np.all(moments >= 0.0):
        raise InputError("times must be a list of numbers >= 0 s")
    return moments


def _direction(u: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Cos φ and sin φ from u = ln tan φ, to the last digits at both ends."""
    k = np.exp(-np.abs(u))
    large = 1.0 / np.sqrt(1.0 + k * k)
    return np.where(u > 0.0, k * large, large), np.where(u > 0.0, large, k * large)


def _slip_angle(
    u: FloatArray, regime: str, limit: float, moving: npt.NDArray[np.bool_]
) -> FloatArray:
    """|φ|; at rest its limit, which for a puck that never moved is 0."""
    with np.errstate(over="ignore"):
        angle: FloatArray = np.arctan(np.exp(u))
    if regime in ("B", "C"):
        angle = np.where(moving, angle, math.atan(math.exp(limit)))
    return angle


def _method_name(regime: str, way: Way, by_closed_form: bool) -> str:
    source = "closed forms" if by_closed_form else "table"
    if regime not in ("B", "C"):
        return "exact solution at constant slip angle"
    stepper = (
        "Dormand-Prince 5(4), adaptive" if way.method.startswith("adaptive") else "Runge-Kutta 4"
    )
    return f"{stepper}, {source}"

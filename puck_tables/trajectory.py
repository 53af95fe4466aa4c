"""One trajectory: from a launch to the stop, with states at any time and an energy account."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables.body import Body, body_of, is_plain
from puck_tables.contact.laws import HOMOGENEOUS, Law
from puck_tables.errors import InputError
from puck_tables.front import Choice, Way
from puck_tables.puck import positive, real, velocity_array
from puck_tables.real import finite_array, instance
from puck_tables.solvers import choose_with
from puck_tables.table.resultant_table import ResultantTable

if TYPE_CHECKING:
    from puck_tables.run import Run
    from puck_tables.sliced import Contact

FloatArray = npt.NDArray[np.float64]

DEFAULT_TOL = 1e-9
DEFAULT_FRAMES = 101
MAX_FRAMES = 1_000_000
LOOK_UP_FRAMES = 10_000  # from here on states are looked up: 0.2 µs each instead of 4


@dataclass(frozen=True)
class Trajectory:
    """A motion from launch to stop.

    Scalars (SI): what went in (``v0`` m/s, ``w0`` rad/s, ``radius`` m, ``delta``, ``decel`` m/s²,
    ``mass`` kg, ``pressure`` the name of the law, ``gyration`` the radius of gyration over r), and

    * ``regime``: A rest, B0 pure spin, C0 pure translation, D limit motion, B, C generic;
    * ``stop_time`` s, ``stop_position`` (2,) m from the launch, ``path_length`` m;
    * ``turn_angle`` rad: how far the heading has turned when Q = hypot(v, rω) has fallen to 1/1000
      of its start; for δ > 0 it turns on, by ``turn_rate`` rad for each factor e of Q, and no
      final direction exists;
    * ``body_angle`` rad: how far the puck itself has turned;
    * ``limit_angle`` rad: φ₀, which every generic motion approaches; 0 where the spin dies out
      first, π/2 where the sliding does;
    * ``loaded_share`` of the base at the launch and the least on the way, ``least_loaded_share``: 1
      in full contact; ``contact_opens``, ``contact_closes`` s: when part of the base lifts, and
      when all of it is down again (None: never);
    * ``kinetic_energy`` J at the launch; ``energy_residual``: the largest difference between
      energy lost and work of friction along the path, as a share of it;
    * ``method``, ``steps``, and ``error_estimate`` in units of Q/J (times) and Q²/J (places);
      ``choice``: what the tolerance led to (None where the motion is elementary).

    Arrays over ``time`` (n,) s: ``x``, ``y`` m; ``heading`` rad (of the velocity; at rest the
    heading of turn_angle); ``orientation`` rad (of the body); ``speed`` v m/s; ``spin`` ω rad/s;
    ``slip_speed`` Q m/s; ``slip_angle`` φ = atan2(rω, v) rad, and so 0 at rest (what it tends to is
    ``limit_angle``).  :meth:`at` gives the states of the same motion at other times.
    """

    v0: tuple[float, float]
    w0: float
    radius: float
    delta: float
    decel: float
    mass: float
    pressure: str
    gyration: float
    regime: str
    stop_time: float
    stop_position: tuple[float, float]
    path_length: float
    turn_angle: float
    turn_rate: float
    body_angle: float
    limit_angle: float
    loaded_share: float
    least_loaded_share: float
    contact_opens: float | None
    contact_closes: float | None
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
    motion: Run = field(repr=False, compare=False)

    def at(self, times: npt.ArrayLike) -> Trajectory:
        """The same motion with its states at other times; nothing is integrated again.

        Parameters
        ----------
        times : array_like, s, ≥ 0, any order

        Raises
        ------
        InputError
            If they are not such times.

        Examples
        --------
        >>> simulate((1.0, 0.0), 5.0, frames=1).at([2.0, 0.0]).x.round(6).tolist()
        [1.590682, 0.0]
        """
        moments = checked_times(times)
        states: dict[str, Any] = _integrated(
            self.motion, moments, self.stop_time, self.v0, self.w0, self.decel, self.radius
        )
        return replace(self, time=moments, **states)


def simulate(
    v0: npt.ArrayLike,
    w0: float,
    *,
    delta: float = 0.5,
    decel: float = 1.0,
    radius: float = 1.0,
    mass: float = 1.0,
    pressure: str | Law = "uniform",
    gyration: float = HOMOGENEOUS,
    frames: int | None = None,
    times: npt.ArrayLike | None = None,
    tol: float = DEFAULT_TOL,
    method: str | None = None,
    exact: bool = False,
    table: ResultantTable | None = None,
) -> Trajectory:
    """The motion of one puck until it stops.

    Parameters
    ----------
    v0 : (vx, vy), m/s
    w0 : spin, rad/s, counter-clockwise positive
    delta : dimensionless height 2fh/r
        Below 3.9637 under uniform pressure (from 1 on part of the base may lift), up to the full
        contact of another law.
    decel : J = fg, m/s², > 0
    radius : m, > 0
    mass : kg, > 0; only the energy depends on it
    pressure : the contact pressure: uniform, galin, hertz, ring, annulus:INNER, a CSV file of ρ, W,
        or a Law
    gyration : radius of gyration about the vertical axis over r, 0.1 to 10; √½ for a homogeneous
        puck
    frames : int, optional
        How many states, equally spaced from the launch to the stop (1: the launch); default 101.
    times : array_like, s, ≥ 0, any order, optional
        The times of the states instead; after the stop the puck is at rest.
    tol : float
        Largest error of the stop wanted, in units of Q/J (time) and Q²/J (place); 1e-13 to 0.01,
        from 1e-11 on for a puck with δ > 1, another law or radius of gyration.  Of these the states
        on the way keep it too, speed and rω in units of Q; those of other pucks may be off by 3
        times that (measured: 2.8, launched next to φ = π/4).
        The cheapest integrator whose measured error is below it is taken (a trajectory is
        integrated and not looked up: it carries an account of its energy); ``choice`` of the result
        says which and why.
    method : 'adaptive' (Dormand–Prince 5(4)) or 'rk4', optional
        Only this one.
    exact : bool
        Closed forms instead of the table: a homogeneous puck under uniform pressure in full
        contact.
    table : Table of resultants, optional
        Under the pressure law of the puck.  Left out: the default table, or the law itself.

    Returns
    -------
    Trajectory

    Raises
    ------
    InputError
        If an argument is not finite, has the wrong shape or lies outside its range.
    ContactError
        If the puck tips (δ ≥ 4), its contact is not determined (δ > 3.9637), or, with ``exact``,
        part of the base would be lifted on the way.
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
    height, wanted = real("delta", delta, "dimensionless"), real("tol", tol, "dimensionless")
    instance("table", table, ResultantTable, type(None))
    if exact and table is not None:
        raise InputError("exact and table exclude each other: closed forms need no table")
    if method not in (None, "adaptive", "rk4"):
        raise InputError(f"method must be 'adaptive' or 'rk4', got {method!r}")
    _check_frames(frames, times)
    plain = is_plain(pressure, gyration, height)
    if exact and not is_plain(pressure, gyration, 0.0):
        raise InputError(
            "closed forms are for a homogeneous puck under uniform pressure: leave out exact, or "
            "pressure and gyration"
        )
    by_table = table is not None and is_plain(pressure, gyration, 0.0)
    body = None if plain or exact or by_table else body_of(pressure, height, gyration, table)
    square = 0.5 if body is None else body.inertia
    speed, rim = math.hypot(vx, vy), r * abs(spin)
    q0 = math.hypot(speed, rim)
    scale_time, scale_length = q0 / J, q0 / J * q0
    energy = 0.5 * m * (speed * speed + square * rim * rim)
    longest = 2.0 if body is None else body.longest
    sizes = (longest * scale_time, longest * scale_length, longest * scale_length / r, energy)
    if not all(map(math.isfinite, sizes)):
        raise InputError(
            f"v0, w0, radius, decel and mass give a motion too large for floating point "
            f"(Q = {q0:g} m/s, J = {J:g} m/s^2): use larger units"
        )

    from puck_tables.motion.equations import LENGTH, PSI, THETA, T, X, Y

    if body is None:
        solved = _solved_plainly(height, speed, rim, wanted, method, exact, table)
    else:
        solved = _solved_by_slice(body, speed, rim, wanted, method)
    regime, limit, run, contact, choice, source = solved
    stop_time = float(run.stop[T] * scale_time)
    moments = _moments(frames, times, stop_time)
    look_up = (
        moments.size >= LOOK_UP_FRAMES
        and regime in ("B", "C")
        and body is None
        and not exact
        and table is None
        and method is None
        and wanted >= DEFAULT_TOL
    )
    if look_up:
        till_rest = np.where(moments < stop_time, moments, 2.0 * stop_time)
        columns = _looked_up((vx, vy), spin, till_rest, height, J, r)
    else:
        columns = _integrated(run, moments, stop_time, (vx, vy), spin, J, r)
    side = -1.0 if spin < 0.0 else 1.0
    east, north = (vx / speed, vy / speed) if speed > 0.0 else (1.0, 0.0)
    end_along, end_left = scale_length * run.stop[X], side * scale_length * run.stop[Y]
    return Trajectory(
        v0=(vx, vy), w0=spin, radius=r, delta=height, decel=J, mass=m,
        pressure="uniform" if body is None else body.law.name,
        gyration=HOMOGENEOUS if body is None else body.gyration,
        regime=regime,
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
        loaded_share=contact.launch,
        least_loaded_share=contact.least,
        contact_opens=None if contact.opens is None else contact.opens * scale_time,
        contact_closes=None if contact.closes is None else contact.closes * scale_time,
        kinetic_energy=energy,
        energy_residual=run.energy_residual,
        method=_method_name(regime, choice.way, source)
        + ("; states by look-up" if look_up else ""),
        steps=run.steps,
        error_estimate=run.error,
        choice=choice if regime in ("B", "C") else None,
        time=moments,
        motion=run,
        **columns,
    )  # fmt: skip


class _Solved(NamedTuple):
    """A motion in natural units; ``limit`` is ln tan φ₀, ``source`` where the friction is from."""

    regime: str
    limit: float
    run: Run
    contact: Contact
    choice: Choice
    source: str


def _solved_plainly(
    delta: float, speed: float, rim: float, tol: float, method: str | None, exact: bool,
    table: ResultantTable | None,
) -> _Solved:  # fmt: skip
    """A homogeneous puck under uniform pressure in full contact."""
    from puck_tables.motion.limits import limit_log_ratio, regime_of
    from puck_tables.run import closed_form_friction, run_motion, table_friction
    from puck_tables.sliced import Contact

    if not 0.0 <= delta < 2.0:
        raise InputError(
            f"delta = 2 f h / r must be from 0 to below 2, got {delta:g}: the linear pressure law "
            "of full contact holds at every phi up to 1, and beyond 2 in no motion but pure spin"
        )
    chosen = ResultantTable.shipped() if table is None else table
    if not exact:
        chosen.checked_range(delta)
    choice = choose_with("trajectory", tol, method, table, exact)
    by_closed_form = exact or (table is None and choice.way.method.endswith("closed forms"))
    friction = closed_form_friction(delta) if by_closed_form else table_friction(delta, chosen)
    limit = limit_log_ratio(delta)
    regime = regime_of(speed, rim, limit)
    run = run_motion(regime, speed, rim, limit, friction, choice)
    source = "closed forms" if by_closed_form else "table"
    return _Solved(regime, limit, run, Contact(), choice, source)


def _solved_by_slice(
    body: Body, speed: float, rim: float, tol: float, method: str | None
) -> _Solved:
    """Any other."""
    from puck_tables.motion.limits import regime_of
    from puck_tables.sliced import LIMIT_WIDTH, checked_tol, contact_of, run_sliced

    wanted = checked_tol(tol)
    limit = body.limit
    regime = regime_of(speed, rim, limit, LIMIT_WIDTH)
    run, choice = run_sliced(body, regime, speed, rim, wanted, method)
    return _Solved(regime, limit, run, contact_of(body, regime, run), choice, "slice")


def _integrated(
    run: Run, moments: FloatArray, stop_time: float, v0: tuple[float, float], spin: float,
    decel: float, radius: float,
) -> dict[str, FloatArray]:  # fmt: skip
    """States of a motion in natural units as the columns of a trajectory."""
    from puck_tables.motion.equations import PSI, THETA, U, X, Y

    side = -1.0 if spin < 0.0 else 1.0
    speed = math.hypot(*v0)
    q0 = math.hypot(speed, radius * abs(spin))
    scale_length = q0 / decel * q0
    scaled = np.where(moments < stop_time, moments, np.inf) / (q0 / decel if q0 > 0.0 else 1.0)
    q, states = run.states(scaled)
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
        "spin": side * (q0 * q * sine / radius) + 0.0,  # Q/r may overflow where ω does not
        "slip_speed": q0 * q,
        "slip_angle": np.where(q > 0.0, side * np.arctan2(sine, cosine), 0.0) + 0.0,
    }


def _looked_up(
    v0: tuple[float, float], spin: float, moments: FloatArray, delta: float, decel: float,
    radius: float,
) -> dict[str, FloatArray]:  # fmt: skip
    """The same by look-up: for many states the cheaper way."""
    from puck_tables.states import flow

    states = flow(v0, spin, moments, delta=delta, decel=decel, radius=radius)
    names = ("x", "y", "heading", "orientation", "speed", "spin", "slip_speed", "slip_angle")
    return {name: getattr(states, name) for name in names}


def _check_frames(frames: int | None, times: npt.ArrayLike | None) -> None:
    if times is not None and frames is not None:
        raise InputError("frames and times both choose the states: give one of them")
    if frames is not None and not (isinstance(frames, int) and 1 <= frames <= MAX_FRAMES):
        raise InputError(f"frames must be from 1 to {MAX_FRAMES}, got {frames}")


def _moments(frames: int | None, times: npt.ArrayLike | None, stop_time: float) -> FloatArray:
    if times is None:
        return np.linspace(0.0, stop_time, DEFAULT_FRAMES if frames is None else frames)
    return checked_times(times)


def checked_times(times: npt.ArrayLike) -> FloatArray:
    """Times of states, s, as an array (n,).

    Raises
    ------
    InputError

    Examples
    --------
    >>> checked_times(2)
    array([2.])
    """
    moments = np.atleast_1d(finite_array("times", times, "s"))
    if moments.ndim != 1 or moments.size == 0 or not np.all(moments >= 0.0):
        raise InputError("times must be a list of numbers >= 0 s")
    return moments


def _direction(u: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Cos φ and sin φ from u = ln tan φ, to the last digits at both ends."""
    k = np.exp(-np.abs(u))
    large = 1.0 / np.sqrt(1.0 + k * k)
    return np.where(u > 0.0, k * large, large), np.where(u > 0.0, large, k * large)


def _method_name(regime: str, way: Way, source: str) -> str:
    if regime not in ("B", "C"):
        return "exact solution at constant slip angle"
    stepper = (
        "Dormand-Prince 5(4), adaptive" if way.method.startswith("adaptive") else "Runge-Kutta 4"
    )
    return f"{stepper}, {source}"

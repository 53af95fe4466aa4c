"""One trajectory: from a launch to the stop, with states at any time and an energy account."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.real import finite_array, instance, one_velocity, real
from puck_tables.accuracy.front import Choice, Way
from puck_tables.errors import InputError
from puck_tables.io.dataset import Dataset, variable
from puck_tables.motion.body import Body, body_of, is_plain
from puck_tables.puck import PUCK_UNITS, Puck
from puck_tables.result import Result
from puck_tables.stopping.solvers import choose_with
from puck_tables.table.resultant_table import ResultantTable

if TYPE_CHECKING:
    from puck_tables.motion.run import Run
    from puck_tables.motion.sliced import Contact

FloatArray = npt.NDArray[np.float64]

STATES = (
    "x", "y", "vx", "vy", "heading", "orientation", "speed", "spin", "slip_speed", "slip_angle",
)  # fmt: skip
SCALARS = {  # and their units
    "regime": "", "stop_time": "s", "stop_position": "m", "path_length": "m", "turn_angle": "rad",
    "turn_rate": "rad", "body_angle": "rad", "limit_angle": "rad", "loaded_share": "1",
    "least_loaded_share": "1", "contact_opens": "s", "contact_closes": "s", "kinetic_energy": "J",
    "energy_residual": "1", "method": "", "steps": "1", "error_estimate": "1",
    "launch_velocity": "m/s", "launch_spin": "rad/s",
}  # fmt: skip
DEFAULT_TOL = 1e-9
DEFAULT_FRAMES = 101
MAX_FRAMES = 1_000_000
LOOK_UP_FRAMES = 10_000  # from here on states are looked up: 0.2 µs each instead of 4


@dataclass(frozen=True, eq=False, repr=False)
class Trajectory(Result):
    """A motion from launch to stop.

    ``puck``, ``launch_velocity`` (2,) m/s, ``launch_spin`` rad/s: what went in.  Scalars (SI):

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

    Arrays over ``time`` (n,) s: ``x``, ``y`` m; ``vx``, ``vy`` m/s; ``heading`` rad (of the
    velocity; at rest the heading of turn_angle); ``orientation`` rad (of the body); ``speed`` v
    m/s; ``spin`` ω rad/s; ``slip_speed`` Q m/s; ``slip_angle`` φ = atan2(rω, v) rad, and so 0 at
    rest (what it tends to is ``limit_angle``).  Called with times it gives the states of the same
    motion there.
    """

    puck: Puck
    launch_velocity: tuple[float, float]
    launch_spin: float
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

    picture: ClassVar[str] = "trajectory"

    def __call__(self, times: npt.ArrayLike) -> Trajectory:
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
        >>> Puck.similar().simulate((1.0, 0.0), 5.0, frames=1)([2.0, 0.0]).x.round(6).tolist()
        [1.590682, 0.0]
        """
        moments = checked_times(times)
        states: dict[str, Any] = _integrated(
            self.motion, moments, self.stop_time, self.launch_velocity, self.launch_spin,
            self.puck.decel, self.puck.radius,
        )  # fmt: skip
        return replace(self, time=moments, **states)

    @property
    def vx(self) -> FloatArray:
        """Velocity along x, m/s."""
        return self.speed * np.cos(self.heading)

    @property
    def vy(self) -> FloatArray:
        """Velocity along y, m/s."""
        return self.speed * np.sin(self.heading)

    def __repr__(self) -> str:
        x, y = self.stop_position
        return (
            f"Trajectory(regime {self.regime}, stops after {self.stop_time:.6g} s at ({x:.6g}, "
            f"{y:.6g}) m, {self.time.size} states)"
        )

    def explain(self) -> str:
        """Which method was taken, and why."""
        if self.choice is None:
            return "solved in elementary functions: the slip angle is constant"
        return self.choice.why

    def summary(self) -> dict[str, Any]:
        """The scalars with what went in, and the units of all, ready for JSON.

        Examples
        --------
        >>> Puck.similar().simulate((1.0, 0.0)).summary()["stop_position"]
        [0.5, 0.0]
        """
        values = {name: getattr(self, name) for name in SCALARS}
        units = {name: unit for name, unit in {**SCALARS, **PUCK_UNITS}.items() if unit}
        listed = {n: list(v) if isinstance(v, tuple) else v for n, v in values.items()}
        return {**listed, **self.puck.described(), "units": units}

    def dataset(self) -> Dataset:
        """States over time; the scalars as attributes."""
        columns = {name: variable(name, getattr(self, name), ("time",)) for name in STATES}
        scalars = {
            n: np.asarray(v) if isinstance(v, list) else v
            for n, v in self.summary().items()
            if v is not None and n != "units"  # None: contact that never opens or closes
        }
        attributes = {"title": "Trajectory of a sliding, spinning puck", **scalars}
        return Dataset({"time": variable("time", self.time, ("time",))}, columns, attributes)


def simulate(
    puck: Puck, velocity: npt.ArrayLike, spin: float, *, frames: int | None,
    times: npt.ArrayLike | None, tol: float, method: str | None, exact: bool,
    table: ResultantTable | None,
) -> Trajectory:  # fmt: skip
    """The motion of a puck until it stops, as :meth:`puck_tables.Puck.simulate` has it."""
    vx, vy = one_velocity(velocity)
    w = real("spin", spin, "rad/s")
    r, J, m, height = puck.radius, puck.decel, puck.mass, puck.delta
    wanted = real("tol", tol, "dimensionless")
    instance("table", table, ResultantTable, type(None))
    if exact and table is not None:
        raise InputError("exact and table exclude each other: closed forms need no table")
    if method not in (None, "adaptive", "rk4"):
        raise InputError(f"method must be 'adaptive' or 'rk4', got {method!r}")
    _check_frames(frames, times)
    plain = is_plain(puck.pressure, puck.gyration, height)
    if exact and not is_plain(puck.pressure, puck.gyration, 0.0):
        raise InputError(
            "closed forms are for a homogeneous puck under uniform pressure: leave out exact, or "
            "pressure and gyration"
        )
    by_table = table is not None and is_plain(puck.pressure, puck.gyration, 0.0)
    body = None
    if not (plain or exact or by_table):
        body = body_of(puck.pressure, height, puck.gyration, table)
    square = 0.5 if body is None else body.inertia
    speed, rim = math.hypot(vx, vy), r * abs(w)
    q0 = math.hypot(speed, rim)
    scale_time, scale_length = q0 / J, q0 / J * q0
    energy = 0.5 * m * (speed * speed + square * rim * rim)
    longest = 2.0 if body is None else body.longest
    sizes = (longest * scale_time, longest * scale_length, longest * scale_length / r, energy)
    if not all(map(math.isfinite, sizes)):
        raise InputError(
            f"velocity, spin, radius, decel and mass give a motion too large for floating point "
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
        columns = _looked_up((vx, vy), w, till_rest, height, J, r)
    else:
        columns = _integrated(run, moments, stop_time, (vx, vy), w, J, r)
    side = -1.0 if w < 0.0 else 1.0
    east, north = (vx / speed, vy / speed) if speed > 0.0 else (1.0, 0.0)
    end_along, end_left = scale_length * run.stop[X], side * scale_length * run.stop[Y]
    return Trajectory(
        puck=puck,
        launch_velocity=(vx, vy),
        launch_spin=w,
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
    from puck_tables.motion.run import closed_form_friction, run_motion, table_friction
    from puck_tables.motion.sliced import Contact

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
    from puck_tables.motion.sliced import LIMIT_WIDTH, checked_tol, contact_of, run_sliced

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
    from puck_tables.stopping.states import states

    found = states(v0, spin, moments, delta=delta, decel=decel, radius=radius)
    names = ("x", "y", "heading", "orientation", "speed", "spin", "slip_speed", "slip_angle")
    return {name: getattr(found, name) for name in names}


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

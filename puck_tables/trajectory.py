"""One trajectory: from a launch to the stop, with states at any time and an energy account."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import (
    FloatArray,
    checked_flag,
    finite_array,
    one_velocity,
    real,
    whole,
)
from puck_tables.accuracy.method_errors import Selection
from puck_tables.accuracy.methods import INTEGRATORS, method_named
from puck_tables.errors import InputError
from puck_tables.io.columns import Dataset, variable
from puck_tables.motion.base_slides import BaseSlide, slide_of
from puck_tables.motion.body import UnitPuck
from puck_tables.motion.friction_source import source_of
from puck_tables.motion.puck_spec import PuckSpec
from puck_tables.motion.state import LENGTH, PSI, THETA, T, U, X, Y
from puck_tables.motion.unit_motion import GENERIC, Frame, MotionRun, contact_of, frame_of, solve
from puck_tables.result import TimedResult
from puck_tables.table.resultant_table import ResultantTable
from puck_tables.table.table import refuse_other_kind

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
DEFAULT_TOL = 1e-9  # of Q/(fg), Q²/(fg)
DEFAULT_FRAMES = 101  # a hundred steps: smooth in a picture
MAX_FRAMES = 1_000_000  # more is a slip of the hand
_LARGEST_U = 700.0  # of ln tan φ; beyond, φ is π/2
LOOK_UP_FRAMES = 10_000  # from here on states are looked up: 0.2 µs each instead of 4


@dataclass(frozen=True, eq=False, repr=False)
class Trajectory(TimedResult):
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
    * ``method``, ``steps``, and ``error_estimate`` in units of Q/(fg) (times) and Q²/(fg) (places);
      ``selection``: the method selected for the tolerance (None where the motion is elementary).

    Arrays over ``time`` (n,) s: ``x``, ``y`` m; ``vx``, ``vy`` m/s; ``heading`` rad (of the
    velocity; at rest the heading of turn_angle); ``orientation`` rad (of the body); ``speed`` v
    m/s; ``spin`` ω rad/s; ``slip_speed`` Q m/s; ``slip_angle`` φ = atan2(rω, v) rad, and so 0 at
    rest (what it tends to is ``limit_angle``).  Called with times it gives the states of the same
    motion there.

    On a base that is not round Q = hypot(v, kω) and φ = atan2(kω, v) with the radius of gyration k
    for r; ``heading`` lies between −π and π, at rest it is that just before; ``regime`` tells how
    it ends: rest, 'together', 'slide last', 'spin last', 'pivot' (about one of its feet) or 'cycle'
    (tall and nearly symmetric: in no direction at all); ``turn_angle``, ``turn_rate`` and
    ``limit_angle`` are None.
    """

    puck: PuckSpec
    launch_velocity: tuple[float, float]
    launch_spin: float
    regime: str
    stop_time: float
    stop_position: tuple[float, float]
    path_length: float
    turn_angle: float | None
    turn_rate: float | None
    body_angle: float
    limit_angle: float | None
    loaded_share: float
    least_loaded_share: float
    contact_opens: float | None
    contact_closes: float | None
    kinetic_energy: float
    energy_residual: float
    method: str
    steps: int
    error_estimate: float
    selection: Selection | None = field(repr=False)
    time: FloatArray = field(repr=False)
    x: FloatArray = field(repr=False)
    y: FloatArray = field(repr=False)
    heading: FloatArray = field(repr=False)
    orientation: FloatArray = field(repr=False)
    speed: FloatArray = field(repr=False)
    spin: FloatArray = field(repr=False)
    slip_speed: FloatArray = field(repr=False)
    slip_angle: FloatArray = field(repr=False)
    motion: MotionRun | BaseSlide = field(repr=False, compare=False)

    picture: ClassVar[str] = "trajectory"

    def __call__(self, times: npt.ArrayLike) -> Trajectory:
        """The motion with its states at other times; of a round puck it is not done anew.

        Parameters
        ----------
        times : array_like, s, ≥ 0, any order

        Raises
        ------
        InputError
            If they are not such times.

        Examples
        --------
        >>> from puck_tables import Puck
        >>> Puck.similar().simulate((1.0, 0.0), 5.0, frames=1)([2.0, 0.0]).x.round(6).tolist()
        [1.590682, 0.0]
        """
        moments = checked_times(times)
        columns: dict[str, Any] = {}
        if isinstance(self.motion, BaseSlide):
            columns |= _slid(self.motion, moments)
        else:
            decel, radius = self.puck.decel, self.puck.radius
            frame = frame_of(self.launch_velocity, self.launch_spin, decel, radius)
            columns |= _integrated(self.motion, frame, moments, self.stop_time)
        return replace(self, time=moments, **columns)

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
        if isinstance(self.motion, BaseSlide):
            return self.motion.explanation
        if self.selection is None:
            return "solved in elementary functions: the slip angle is constant"
        return self.selection.explanation

    def summary(self) -> dict[str, Any]:
        """The scalars with what went in, and the units of all, ready for JSON.

        >>> from puck_tables import Puck
        >>> Puck.similar().simulate((1.0, 0.0)).summary()["stop_position"]
        [0.5, 0.0]
        """
        values = {name: getattr(self, name) for name in SCALARS}
        known = {**SCALARS, **self.puck.units}
        if isinstance(self.motion, BaseSlide):
            values["launch_orientation"] = self.motion.orientation
            known["launch_orientation"] = "rad"
        units = {name: unit for name, unit in known.items() if unit}
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
    puck: PuckSpec, velocity: npt.ArrayLike, spin: float, *, frames: int | None,
    times: npt.ArrayLike | None, tol: float, method: str | None, exact: bool,
    table: ResultantTable | None, orientation: float,
) -> Trajectory:  # fmt: skip
    """The motion of a puck until it stops, as :meth:`puck_tables.Puck.simulate` has it."""
    if orientation != 0.0:
        raise InputError(
            "orientation is of a puck on a base: a round one slides alike, however it is turned"
        )
    launch, w = one_velocity(velocity), real("spin", spin, "rad/s")
    wanted = real("tol", tol, "dimensionless")
    refuse_other_kind(table, ResultantTable)
    checked_flag("exact", exact)
    if exact and table is not None:
        raise InputError("exact and table exclude each other: closed forms need no table")
    stepper = method_named(method, INTEGRATORS)
    _check_frames(frames, times)
    frame = frame_of(launch, w, puck.decel, puck.radius)
    body = puck.body
    body = body if body.has_closed_forms else body.with_table(table)
    energy = 0.5 * puck.mass * (frame.speed * frame.speed + body.inertia * frame.rim * frame.rim)
    _refuse_too_large(frame, body, energy, puck.decel)

    source = source_of(body, table, exact)
    run, selection = solve(source, frame.speed, frame.rim, wanted, stepper)
    generic = run.regime in GENERIC
    contact = contact_of(body, run)
    stop_time = float(run.stop[T] * frame.time)
    moments = _moments(frames, times, stop_time)
    default = not exact and table is None and method is None and wanted >= DEFAULT_TOL
    look_up = moments.size >= LOOK_UP_FRAMES and generic and body.is_plain and default
    if look_up:
        columns = _looked_up(puck, launch, w, moments, stop_time)
    else:
        columns = _integrated(run, frame, moments, stop_time)
    title = "exact solution at constant slip angle"
    if generic:
        title = f"{selection.method.words}, {run.friction.source}"
    x, y = frame.place(run.stop[X], run.stop[Y])
    return Trajectory(
        puck=puck, launch_velocity=launch, launch_spin=w, regime=run.regime, stop_time=stop_time,
        stop_position=(float(x), float(y)), path_length=float(run.stop[LENGTH] * frame.length),
        turn_angle=float(frame.side * run.stop[PSI]) + 0.0,
        turn_rate=float(frame.side * run.turn_rate) + 0.0,
        body_angle=float(frame.side * run.stop[THETA] * (frame.length / puck.radius)) + 0.0,
        limit_angle=math.atan(math.exp(source.limit)),
        loaded_share=contact.launch, least_loaded_share=contact.least,
        contact_opens=None if contact.opens is None else contact.opens * frame.time,
        contact_closes=None if contact.closes is None else contact.closes * frame.time,
        kinetic_energy=energy, energy_residual=run.energy_residual,
        method=title + ("; states by look-up" if look_up else ""), steps=run.steps,
        error_estimate=run.error, selection=selection if generic else None, time=moments,
        motion=run, **columns,
    )  # fmt: skip


def simulate_on_base(
    puck: PuckSpec, velocity: npt.ArrayLike, spin: float, *, frames: int | None,
    times: npt.ArrayLike | None, tol: float, orientation: float,
) -> Trajectory:  # fmt: skip
    """The motion of a puck on a base that is not round, as :meth:`puck_tables.Puck.simulate`."""
    launch, w = one_velocity(velocity), real("spin", spin, "rad/s")
    wanted = real("tol", tol, "dimensionless")
    _check_frames(frames, times)
    run = slide_of(puck, launch, w, wanted, real("orientation", orientation, "rad"))
    energy = 0.5 * puck.mass * run.slip * run.slip
    if not math.isfinite(energy):
        raise InputError(f"mass = {puck.mass:g} kg gives an energy too large for floating point")
    moments = _moments(frames, times, run.stop_time)
    return Trajectory(
        puck=puck, launch_velocity=launch, launch_spin=w, regime=run.end, stop_time=run.stop_time,
        stop_position=run.stop_position, path_length=run.path_length, turn_angle=None,
        turn_rate=None, body_angle=run.body_angle, limit_angle=None, loaded_share=1.0,
        least_loaded_share=1.0, contact_opens=None, contact_closes=None, kinetic_energy=energy,
        energy_residual=run.energy_residual, steps=run.steps, error_estimate=run.error,
        method="Dormand-Prince 8(5,3), adaptive, friction summed along the base", selection=None,
        time=moments, motion=run, **_slid(run, moments),
    )  # fmt: skip


def _slid(run: BaseSlide, moments: FloatArray) -> dict[str, FloatArray]:
    """States of a slide on a base as the columns of a trajectory."""
    x, y, heading, orientation, speed, spin = run.states(moments)
    rim = run.puck.inertia_radius * spin
    return {
        "x": x, "y": y, "heading": heading, "orientation": orientation, "speed": speed,
        "spin": spin, "slip_speed": np.hypot(speed, rim), "slip_angle": np.arctan2(rim, speed),
    }  # fmt: skip


def _refuse_too_large(frame: Frame, body: UnitPuck, energy: float, decel: float) -> None:
    """Refuse a motion that leaves floating point."""
    times, lengths = body.longest * frame.time, body.longest * frame.length
    if not all(map(math.isfinite, (times, lengths, lengths / frame.radius, energy))):
        raise InputError(
            f"velocity, spin, radius, decel and mass give a motion too large for floating point "
            f"(Q = {frame.slip:g} m/s, J = {decel:g} m/s^2): use larger units"
        )


def _integrated(
    run: MotionRun, frame: Frame, moments: FloatArray, stop_time: float
) -> dict[str, FloatArray]:
    """States of a motion in natural units as the columns of a trajectory."""
    q, unit_states = run.states(frame.unit_times(moments, stop_time))
    x, y, turn, orientation, speed, spin = frame.states(q, unit_states)
    phi = np.arctan(np.exp(np.minimum(unit_states[:, U], _LARGEST_U)))
    slip_angle = np.where(q > 0.0, frame.side * phi, 0.0) + 0.0
    return {
        "x": x, "y": y, "heading": frame.heading + turn, "orientation": orientation,
        "speed": speed, "spin": spin, "slip_speed": frame.slip * q, "slip_angle": slip_angle,
    }  # fmt: skip


def _looked_up(
    puck: PuckSpec, launch: tuple[float, float], spin: float, moments: FloatArray, stop_time: float
) -> dict[str, FloatArray]:
    """States by look-up as columns of a trajectory: cheaper for many."""
    from puck_tables.stopping.states import states

    till_rest = np.where(moments < stop_time, moments, 2.0 * stop_time)
    rows = states(launch, spin, till_rest, delta=puck.delta, decel=puck.decel, radius=puck.radius)
    names = ("x", "y", "heading", "orientation", "speed", "spin", "slip_speed", "slip_angle")
    return {name: getattr(rows, name) for name in names}


def _check_frames(frames: int | None, times: npt.ArrayLike | None) -> None:
    if times is not None and frames is not None:
        raise InputError("frames and times both choose the states: give one of them")
    if frames is not None:
        whole("frames", frames, 1, MAX_FRAMES)


def _moments(frames: int | None, times: npt.ArrayLike | None, stop_time: float) -> FloatArray:
    if times is None:
        return np.linspace(0.0, stop_time, DEFAULT_FRAMES if frames is None else frames)
    return checked_times(times)


def checked_times(times: npt.ArrayLike) -> FloatArray:
    """Times of states, s, as an array (n,).

    >>> checked_times(2)
    array([2.])
    """
    moments = np.atleast_1d(finite_array("times", times, "s"))
    if moments.ndim != 1 or moments.size == 0 or not np.all(moments >= 0.0):
        raise InputError("times must be a list of numbers >= 0 s")
    return moments

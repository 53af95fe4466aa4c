"""The exact answer to a case: states at any times, forces on the floor, bounds of its error."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.errors import InputError
from puck_tables.io.columns import Dataset, Variable, derived, following, variable
from puck_tables.motion.puck_spec import PuckSpec
from puck_tables.reference.cases import TOL, ReferenceCase, case_named
from puck_tables.reference.floor_reaction import on_the_floor, ratios, slip_over
from puck_tables.reference.frame_times import frame_times
from puck_tables.result import Result
from puck_tables.scene.entries import tables_of
from puck_tables.scene.parts import Floor, Force
from puck_tables.scene.pucks_and_posts import ScenePuck
from puck_tables.scene.run import Run
from puck_tables.world.named_pucks import pucks_of

STATE = ("x", "y", "orientation", "vx", "vy", "spin")
ON_FLOOR = ("slip_speed", "epsilon", "slip_ratio", "floor_fx", "floor_fy", "floor_torque")
BOUNDS = ("time_bound", "place_bound", "speed_bound")
_STATES = 3.0  # states on the way may be off by that times tol


@dataclass(frozen=True, eq=False, repr=False)
class Answer(Result):
    """What exactly happens in a case.

    ``case``: name, version, title, scene; ``end``, ``end_time`` s: how and when it ends;
    ``names`` of the pucks, none of a single one; ``time`` (n,) s; ``columns``: arrays (n,), of
    several pucks (n, pucks), by name, each also an attribute: places, angle, velocity and spin,
    ``slip_speed`` Q, ``epsilon`` = v/(r|ω|) and ``slip_ratio`` = r|ω|/v of the slip over the floor,
    ``floor_fx``, ``floor_fy`` N and ``floor_torque`` N m, what the puck does to the floor.  Of a
    base that is not round r is the reach, how far it extends from the centre of mass.

    ``speed_scale`` m/s: Q of the launch, with the speed of a floor that moves added to it;
    ``rate_scale`` m/s²: f g, of the largest f; ``time_bound`` s, ``place_bound`` m and
    ``speed_bound`` m/s: what times, places (and r times angles), speeds (and r times spins) may at
    most be wrong by.  ``limit_epsilon``: what ε tends to where it stops by friction alone, else
    None.  Called with times it gives the states there.
    """

    case: ReferenceCase
    run: Run
    time: FloatArray
    columns: Mapping[str, FloatArray] = field(repr=False)

    picture: ClassVar[str] = "reference"

    def __call__(self, times: npt.ArrayLike) -> Answer:
        """The answer with its states at other times, s, ≥ 0, in any order.

        InputError if one is later than a case that never stops is followed.

        >>> reference_case("slide")([0.5, 0.0]).vx.round(6).tolist()
        [0.019, 1.0]
        """
        wanted = np.atleast_1d(np.asarray(times, dtype=np.float64))
        if self.run.end == "time is up" and wanted.max() > self.end_time:
            raise InputError(
                f"case {self.case.name} is followed for {self.end_time:.9g} s and does not stop "
                f"by then: give no later times, got {wanted.max():.9g} s"
            )
        ordered, back = np.unique(wanted, return_inverse=True)
        stays = self.run.end == "carried by the floor"
        run = self.run(np.minimum(ordered, self.end_time) if stays else ordered)
        states = {name: np.asarray(run.columns[name])[back] for name in STATE}
        if self.run.end == "at rest" and not self.names:  # no rounding is left of the slip
            last = self.run.last
            rests = wanted >= self.end_time
            states = {name: np.where(rests, last[name], row) for name, row in states.items()}
        if stays:  # at rest on a belt it goes on with it
            belt = self.run.scene.floor.velocity
            more = np.maximum(wanted - self.end_time, 0.0)
            states["x"], states["y"] = states["x"] + belt[0] * more, states["y"] + belt[1] * more
        return replace(self, run=run, time=wanted, columns=states)

    @property
    def names(self) -> tuple[str, ...]:
        """Of the pucks, in their order; none of a single one."""
        return self.run.names if self.run.scene.pucks else ()

    @property
    def pucks(self) -> tuple[ScenePuck, ...]:
        """The pucks."""
        return pucks_of(self.run.scene)

    @property
    def is_body(self) -> bool:
        """Whether it is of a body on a base that is not round: it has no δ, and r is its reach."""
        return self.pucks[0].shape is not None

    @property
    def floor(self) -> Floor:
        """The floor."""
        return self.run.scene.floor

    @property
    def end(self) -> str:
        """How it ends: 'at rest', 'carried by the floor' or 'time is up'."""
        return self.run.end

    @property
    def end_time(self) -> float:
        """When, s."""
        return self.run.end_time

    @property
    def speed_scale(self) -> float:
        """Q of the launch, m/s."""
        if not self.names:
            return self.run.speed_scale
        return max(
            float(
                np.hypot(
                    np.hypot(*(one.launch.velocity or (0.0, 0.0))), one.radius * one.launch.spin
                )
            )
            for one in self.pucks
        )

    @property
    def rate_scale(self) -> float:
        """J, m/s²."""
        if not self.names:
            return self.run.rate_scale
        return max(one.decel for one in self.pucks)

    @property
    def share_bound(self) -> float:
        """What times, places and speeds may be wrong by, in units of Q/(fg), Q²/(fg) and Q."""
        length = self.speed_scale**2 / self.rate_scale
        return _STATES * max(self.run.end_error / length, TOL)

    @property
    def time_bound(self) -> float:
        """Seconds."""
        return self.share_bound * self.speed_scale / self.rate_scale

    @property
    def place_bound(self) -> float:
        """Metres."""
        return self.share_bound * self.speed_scale**2 / self.rate_scale

    @property
    def speed_bound(self) -> float:
        """Metres a second."""
        return self.share_bound * self.speed_scale

    @property
    def limit_epsilon(self) -> float | None:
        """What v/(r|ω|) tends to at the stop; None where none or not friction alone decides."""
        floor = self.floor
        scene = self.run.scene
        free = not (self.names or floor.slope or floor.turning or scene.walls)
        free = free and not floor.over_time and scene.force == Force()
        slips = self.speed_scale > 0.0 and scene.launch.spin != 0.0
        moves = np.hypot(*slip_over(floor, _launch(scene.launch))[:2]) > 0.0
        puck = self.puck_at_end if free and slips and moves else None
        return None if puck is None else puck.limit_epsilon

    @property
    def puck_at_end(self) -> PuckSpec | None:
        """The one puck with the friction that it stops on; None: its base lies on several.

        None, too, where friction depends on the slip, a base is not round, or pucks are several.
        """
        floor = self.floor
        if self.is_body or self.names or floor.patches or floor.law or floor.orthotropic:
            return None
        puck = self.run.scene.puck
        if floor.strips is None:
            return puck
        strips, last = floor.strips, self.last()
        place = math.cos(strips.direction) * last["x"] + math.sin(strips.direction) * last["y"]
        off = place - np.array(strips.borders)
        if (np.abs(off) < puck.radius).any():
            return None
        friction = strips.friction[int((off > 0.0).sum())]
        return replace(puck, friction=friction) if isinstance(friction, float) else None

    def puck_number(self, name: str | None) -> int | None:
        """Which of several pucks a name means; None of a single one.

        Raises
        ------
        InputError
            If there is no such puck, or several and none is named.
        """
        if not self.names:
            if name is not None:
                raise InputError(f"case {self.case.name} has one puck: leave puck (--puck) out")
            return None
        if name not in self.names:
            words = (
                "which puck it is" if name is None else f"a puck that is in it, not {name!r:.40}"
            )
            raise InputError(
                f"case {self.case.name} has the pucks {', '.join(self.names)}: say {words} with "
                "puck (--puck)"
            )
        return self.names.index(name)

    def end_time_of(self, puck: int | None) -> float:
        """When it ends for one of several pucks, s; None: the single one."""
        if puck is None:
            return self.end_time
        return min(float(self.run.stop_times[puck]), self.end_time)

    def states_of(self, puck: int | None) -> dict[str, FloatArray]:
        """The time and the columns of one of several pucks; None: the single one.

        >>> reference_case("slide", times=[0.0]).states_of(None)["vx"].tolist()
        [1.0]
        """
        rows = {"time": self.time, **self.columns}
        return {name: row if row.ndim == 1 else row[:, puck] for name, row in rows.items()}

    def __getattr__(self, name: str) -> FloatArray:
        """A column by its name."""
        columns: Mapping[str, FloatArray] = self.__dict__.get("columns", {})
        if name in columns:
            return columns[name]
        if name in ON_FLOOR:
            return self._on_floor()[name]
        return following(self, name)

    def _on_floor(self) -> dict[str, FloatArray]:
        """Slip and forces, of every puck."""
        rows = []
        for n, puck in enumerate(self.pucks):
            mine = self.states_of(n if self.names else None)
            slip = slip_over(self.floor, mine)
            epsilon, ratio = ratios(slip.beyond(self.speed_bound, puck.radius), puck.radius)
            fx, fy, torque = on_the_floor(puck, self.run.scene, mine, self.speed_bound)
            q = slip.sizes(puck.radius)[2]
            rows.append((q, epsilon, ratio, fx, fy, torque))
        whole = (np.stack(one, axis=-1) for one in zip(*rows, strict=True))
        return {
            name: one if self.names else one[:, 0]
            for name, one in zip(ON_FLOOR, whole, strict=True)
        }

    def __repr__(self) -> str:
        return (
            f"Answer({self.case.label}: {self.end} after {self.end_time:.9g} s, "
            f"{self.time.size} states)"
        )

    def explain(self) -> str:
        """How it was computed."""
        return self.run.explain()

    def summary(self) -> dict[str, Any]:
        """The scalars, and the scene with its numbers, ready for JSON.

        >>> told = reference_case("slide").summary()
        >>> told["case"], told["version"], round(told["end_time"], 9)
        ('slide', 1, 0.509683996)
        """
        return {
            "case": self.case.name, "version": self.case.version, "title": self.case.title,
            "tests": self.case.tests, "end": self.end, "end_time": self.end_time,
            "stop": self.last(), "pucks": list(self.names), "speed_scale": self.speed_scale,
            "rate_scale": self.rate_scale, "limit_epsilon": self.limit_epsilon,
            "delta": None if self.is_body else [one.delta for one in self.pucks],
            **{name: getattr(self, name) for name in BOUNDS},
            "scene": tables_of(self.run.scene),
        }  # fmt: skip

    def last(self) -> dict[str, Any]:
        """The state at the end, numbers by name (lists of several pucks)."""
        return {name: np.asarray(self.run.last[name]).tolist() for name in STATE}

    def dataset(self) -> Dataset:
        """States over time (and pucks), with the bounds of their errors in each row."""
        dims = ("time", "puck") if self.names else ("time",)
        axes = {"time": variable("time", self.time, ("time",))}
        columns: dict[str, Variable] = {"case": variable("case", self.case.label, ())}
        if self.names:
            axes["puck"] = variable("puck", np.arange(len(self.names)), ("puck",))
            columns["name"] = variable("name", list(self.names), ("puck",))
        whole = {**self.columns, **self._on_floor()}
        for name, row in {**whole, **derived(whole)}.items():
            columns[name] = variable(name, row, dims)
        for name in BOUNDS:
            columns[name] = variable(name, np.asarray(getattr(self, name)), ())
        kept = {
            name: value for name, value in self.summary().items()
            if value is not None and name not in ("stop", "scene", "pucks", *BOUNDS)
        }  # fmt: skip
        return Dataset(axes, columns, kept, self.run.dataset().texts)


def _launch(launch: Any) -> dict[str, FloatArray]:
    (vx, vy), (x, y) = launch.velocity or (0.0, 0.0), launch.position
    values = {"time": launch.time, "x": x, "y": y, "vx": vx, "vy": vy, "spin": launch.spin}
    return {name: np.array([value]) for name, value in values.items()}


def reference_case(
    name: str, *, dt: float | None = None, fps: float | None = None,
    times: npt.ArrayLike | str | Path | None = None,
) -> Answer:  # fmt: skip
    """The exact answer to a benchmark case, at the frame times of an engine.

    Parameters
    ----------
    name : of the case, see ``puck reference``
    dt : s, between two frames
    fps : frames a second, in place of ``dt``
    times : s, ≥ 0, or a file of them (its column of times), in place of both
        Without any of the three: 101 frames from the launch to the end.

    Returns
    -------
    Answer
        Places in m from where the case says, angles counter-clockwise.  Times are off by at most
        ``time_bound``, below 1e-10 of Q/(fg) for free pucks.

    Raises
    ------
    InputError
        If there is no such case, or the times are none of it.

    Notes
    -----
    ``height`` is the full height of a homogeneous cylinder, its centre of mass lies half as high:
    δ = 2fh/r.

    References
    ----------
    Salnikova, Treschev, Gallyamov 2012, eq. 6.2–6.7.

    Examples
    --------
    >>> coin = reference_case("coin", dt=0.05)
    >>> coin.time.round(9).tolist(), (1e3 * coin.x).round(6).tolist()
    ([0.0, 0.05, 0.1, 0.15], [0.0, 7.755159, 11.260037, 11.628348])
    >>> round(coin.end_time, 9)
    0.123811759
    """
    case = case_named(name)
    run: Any = case.scene().simulate([0.0])
    answer = Answer(case, run, np.zeros(1), {name: run.columns[name] for name in STATE})
    return answer(frame_times(answer.end_time, dt=dt, fps=fps, times=times))

"""The inverse problem: which launches come to rest at a given place, or at each of many."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import (
    FloatArray,
    broadcast,
    checked_threads,
    finite_array,
    positive,
    whole,
)
from puck_tables._core.executor import run_chunks
from puck_tables.errors import InputError
from puck_tables.io.columns import COLUMNS as VARIABLES
from puck_tables.io.columns import Dataset, variable
from puck_tables.motion.puck_spec import PUCK_UNITS, PuckSpec
from puck_tables.result import Result
from puck_tables.stopping.jacobian import STOP_NAMES, Differentiated
from puck_tables.stopping.launch_arrays import positive_array
from puck_tables.stopping.launch_search import (
    ANGLE,
    OF,
    SPIN,
    STOP_TIME,
    VX,
    VY,
    LaunchSearch,
    misses,
)
from puck_tables.stopping.stops import Stops, stop

MAX_COUNT = 10_000  # launches of an answer: each a row
_CHUNK = 4096  # targets that a thread takes at a time
_TRIED = 100  # launches that are integrated to tell how well they do
_LARGEST_ANGLE = 1e6  # rad: of more too few digits are left of a turn
_ROWS = (  # of a file
    "launch_spin", "launch_vx", "launch_vy", "launch_speed", "launch_heading", "launch_slip_angle",
    "stop_time", "body_angle",
)  # fmt: skip
_UNITS = {"spin": "rad/s", "speed": "m/s", "stop_time": "s", "angle": "rad"}


@dataclass(frozen=True, eq=False, repr=False)
class Aim(Differentiated, Result):
    """Launches that come to rest at ``target`` (2,) or at one of many (…, 2), m from their start.

    ``launches`` (…): how many lead to each target.  Arrays (n,) of all, target after target and
    ordered by spin, the most clockwise first: ``target_index``, counted through all targets,
    ``launch_velocity`` (n, 2) m/s, ``launch_spin`` rad/s, ``launch_speed`` m/s, ``launch_heading``
    rad, ``launch_slip_angle`` φ rad, ``stop_time`` s, ``body_angle`` rad by which the puck turns.
    ``miss`` m, integrated when first asked for: how far from its target each launch ends.
    ``jacobian`` (n, 3, 3), and ``derivative`` by names: of place and body angle at the stop by
    speed, heading and spin of the launch; ``spread`` says how far they scatter where those do.
    ``answer`` is one sentence: what was found, or why nothing leads to the one target.  ``aim[2]``
    or ``aim[2, 3]`` has the launches to some of the targets.
    """

    search: LaunchSearch = field(repr=False)
    target: FloatArray
    wanted: FloatArray
    target_index: npt.NDArray[np.int64]
    launch_velocity: FloatArray
    launch_spin: FloatArray
    stop_time: FloatArray
    body_angle: FloatArray
    threads: int | None = None

    picture: ClassVar[str] = "aim"
    JACOBIAN_ROWS: ClassVar[tuple[str, ...]] = ("stop_x", "stop_y", "body_angle")
    JACOBIAN_COLUMNS: ClassVar[tuple[str, ...]] = (  # type: ignore[misc]
        "launch_speed", "launch_heading", "launch_spin",
    )  # fmt: skip

    def __repr__(self) -> str:
        at = f"at ({self.target[0]:g}, {self.target[1]:g}) m: " if self.is_one else ""
        return f"Aim({at}{self.answer})"

    def __len__(self) -> int:
        return 1 if self.is_one else len(self.target)

    def __getitem__(self, index: Any) -> Aim:
        """The launches to one target, or to some of them."""
        shape = self.target.shape[:-1]
        chosen = np.arange(math.prod(shape)).reshape(shape)[index]
        place = np.full(math.prod(shape), -1)
        place[chosen] = np.arange(np.size(chosen)).reshape(np.shape(chosen))
        of = place[self.target_index]
        which = np.flatnonzero(of >= 0)
        which = which[np.argsort(of[which], kind="stable")]
        return Aim(
            self.search, self.target[index], np.asarray(self.wanted[index]), of[which],
            self.launch_velocity[which], self.launch_spin[which], self.stop_time[which],
            self.body_angle[which], self.threads,
        )  # fmt: skip

    @property
    def puck(self) -> PuckSpec:
        """What is launched."""
        return self.search.puck

    @property
    def is_one(self) -> bool:
        """Whether there is one target, (2,), not an array of them."""
        return self.target.ndim == 1

    @property
    def launches(self) -> npt.NDArray[np.int64]:
        """How many launches lead to each target, of the shape of the targets."""
        shape = self.target.shape[:-1]
        return np.bincount(self.target_index, minlength=math.prod(shape)).reshape(shape)

    @property
    def launch_vx(self) -> FloatArray:
        """Launch velocity along x, m/s."""
        return self.launch_velocity[:, 0]

    @property
    def launch_vy(self) -> FloatArray:
        """Launch velocity along y, m/s."""
        return self.launch_velocity[:, 1]

    @property
    def launch_speed(self) -> FloatArray:
        """Launch speed, m/s."""
        return np.hypot(self.launch_vx, self.launch_vy)

    @property
    def launch_heading(self) -> FloatArray:
        """Direction of the velocity at the launch, rad."""
        return np.arctan2(self.launch_vy, self.launch_vx)

    @property
    def launch_slip_angle(self) -> FloatArray:
        """Slip angle atan2(rω, v) at the launch, rad."""
        return np.arctan2(self.puck.radius * self.launch_spin, self.launch_speed)

    @property
    def _places(self) -> FloatArray:
        """The target of each launch, (n, 2)."""
        return self.target.reshape(-1, 2)[self.target_index]

    @property
    def target_x(self) -> FloatArray:
        """Of the target of each launch, m."""
        return self._places[:, 0]

    @property
    def target_y(self) -> FloatArray:
        """Of the target of each launch, m."""
        return self._places[:, 1]

    @cached_property
    def jacobian(self) -> FloatArray:
        """Derivatives (n, 3, 3) of place and body angle by speed, heading, spin; when asked for.

        Raises
        ------
        AccuracyError
            If an error of 1e-7 is out of reach for such a puck.

        Examples
        --------
        >>> from puck_tables import Puck
        >>> found = Puck.similar().aim((2.0, 0.1), spin=5.0)
        >>> found.derivative("stop_x", "launch_speed").round(4).tolist()  # m by m/s
        [2.2984]
        >>> found.spread(np.diag([0.02, 0.01, 0.1]) ** 2).deviation.round(4).tolist()  # m, m, rad
        [[0.0599, 0.0202, 0.3753]]
        """
        every = self._stops(self._arguments, jacobian=True).jacobian
        rows = every[:, [STOP_NAMES.index(name) for name in self.JACOBIAN_ROWS]]
        by_vx, by_vy, by_spin, *_ = np.moveaxis(rows, -1, 0)
        vx, vy = self.launch_velocity.T[:, :, None]
        cosine, sine = np.cos(self.launch_heading)[:, None], np.sin(self.launch_heading)[:, None]
        columns = by_vx * cosine + by_vy * sine, by_vy * vx - by_vx * vy, by_spin
        return np.stack(columns, axis=-1)

    @property
    def _arguments(self) -> FloatArray:  # type: ignore[override]
        return np.stack([self.launch_speed, self.launch_heading, self.launch_spin])

    def _again(self, arguments: FloatArray) -> FloatArray:
        stops = self._stops(arguments)
        return np.stack([getattr(stops, name) for name in self.JACOBIAN_ROWS])

    def _stops(self, arguments: FloatArray, *, jacobian: bool = False) -> Stops:
        speed, heading, spin = arguments
        velocity = speed[:, None] * np.stack([np.cos(heading), np.sin(heading)], axis=-1)
        how = {**self.puck.arguments(), "threads": self.threads}
        return stop(velocity, spin, jacobian=jacobian, **how)

    @cached_property
    def miss(self) -> FloatArray:
        """How far from its target an integration of each launch ends, m."""
        return self._missed(np.arange(self.launch_spin.size))

    def _missed(self, which: npt.NDArray[np.int64]) -> FloatArray:
        return misses(
            self.puck, self._places[which], self.launch_velocity[which], self.launch_spin[which],
            self.threads,
        )  # fmt: skip

    @cached_property
    def answer(self) -> str:
        """How many launches there are, and to how many targets there is none, or why not."""
        count, none = self.launch_spin.size, int((self.launches == 0).sum())
        if self.is_one and none:
            distance = np.array([math.hypot(*self.target.tolist())])
            return self.search.reason(self.wanted.reshape(1), distance)
        text = f"{count} launch{'' if count == 1 else 'es'}"
        if self.is_one:
            return text
        text += f" to {self.launches.size} targets"
        return f"{text}, none to {none} of them" if none else text

    def explain(self) -> str:
        """What was found, how, and how well: of some launches, integrated."""
        looked = "the stop table" if self.puck.body.is_plain else "the curve of all its launches"
        if not self.launch_spin.size:
            return self.answer
        some = np.unique(np.linspace(0, self.launch_spin.size - 1, _TRIED).astype(np.int64))
        error, count = self._missed(some).max(), some.size
        tried = f"{count} of them, integrated, end" if count > 1 else "One, integrated, ends"
        return f"{self.answer}.\nLooked up in {looked}.\n{tried} at most {error:.1g} m off."

    @property
    def _rows(self) -> tuple[str, ...]:
        """Columns of a file; no miss, which has to be integrated."""
        return _ROWS if self.is_one else ("target_index", "target_x", "target_y", *_ROWS)

    def summary(self) -> dict[str, Any]:
        """The launches with what went in, and the units of all, ready for JSON."""
        name, rows = "target" if self.is_one else "targets", self._rows
        return {
            name: self.target.tolist(), **self.puck.described(), "answer": self.answer,
            **{row: getattr(self, row).tolist() for row in rows},
            "units": {name: "m", **PUCK_UNITS, **{row: VARIABLES[row].unit for row in rows}},
        }  # fmt: skip

    def dataset(self) -> Dataset:
        """One row a launch, with its target if there are many; the puck as attributes."""
        columns = {name: variable(name, getattr(self, name), ("launch",)) for name in self._rows}
        where: dict[str, Any] = {"targets": self.launches.size}
        if self.is_one:
            where = {"target": self.target.tolist()}
        title = f"Launches that come to rest at {'a target' if self.is_one else 'targets'}"
        attributes = {"title": title, **where, "answer": self.answer, **self.puck.described()}
        return Dataset({}, columns, attributes)


def aim(
    puck: PuckSpec, target: npt.ArrayLike, *, spin: npt.ArrayLike | None,
    speed: npt.ArrayLike | None, stop_time: npt.ArrayLike | None, angle: npt.ArrayLike | None,
    max_speed: float | None, max_spin: float | None, count: int, threads: int | None,
) -> Aim:  # fmt: skip
    """Launches after which a puck comes to rest at targets: :meth:`puck_tables.Puck.aim`."""
    checked_threads(threads)
    places = finite_array("target", target, "m")
    if places.ndim == 0 or places.shape[-1] != 2:
        raise InputError(
            f"target must be one place (x, y) in m, or (..., 2) of them, got shape {places.shape}"
        )
    wished, wish = _wish({"spin": spin, "speed": speed, "stop_time": stop_time, "angle": angle})
    bounds = _checked_bounds(max_speed, max_spin, count)
    x, y, wanted = broadcast(
        target_x=places[..., 0], target_y=places[..., 1], **{wished or "wish": wish}
    )
    places = np.stack([x, y], axis=-1)
    with np.errstate(over="ignore"):
        distance = np.hypot(x, y)
    if not np.isfinite(distance).all():
        far = places[~np.isfinite(distance)][0]
        raise InputError(
            f"target ({far[0]:g}, {far[1]:g}) m is too far for floating point: use larger units"
        )
    search = LaunchSearch(puck, wished, bounds, int(count))
    flat = places.reshape(-1, 2), wanted.reshape(-1), distance.reshape(-1)
    result: dict[int, FloatArray] = {}

    def work(start: int, stop: int) -> None:
        launches = search.launches(*(one[start:stop] for one in flat))
        launches[:, OF] += start
        result[start] = launches

    run_chunks(work, distance.size, _CHUNK, threads)
    rows = np.concatenate([np.empty((0, ANGLE + 1)), *(result[n] for n in sorted(result))])
    aimed = Aim(
        search, places, np.asarray(wanted), rows[:, OF].astype(np.int64), rows[:, [VX, VY]],
        rows[:, SPIN].copy(), rows[:, STOP_TIME].copy(), rows[:, ANGLE].copy(), threads,
    )  # fmt: skip
    if aimed.is_one:
        _ = aimed.answer  # a question out of floating point is refused at once
    return aimed


def _wish(wishes: dict[str, Any]) -> tuple[str | None, FloatArray]:
    """The one wish that is there, if any, and what is wished; two are refused."""
    wished = [name for name, value in wishes.items() if value is not None]
    if len(wished) > 1:
        raise InputError(f"{wished[0]} and {wished[1]} both pick a launch: give one of them")
    if not wished:
        return None, np.zeros(())
    name = wished[0]
    checked = finite_array if name in ("spin", "angle") else positive_array
    values = checked(name, wishes[name], _UNITS[name])
    if name == "angle" and np.abs(values).max(initial=0.0) > _LARGEST_ANGLE:
        raise InputError(
            f"angle must be within {_LARGEST_ANGLE:g} rad, got {np.abs(values).max():g}: it counts "
            "up to whole turns"
        )
    return name, values


def _checked_bounds(
    max_speed: float | None, max_spin: float | None, count: int
) -> tuple[float, float]:
    """Bounds on speed and spin, infinite where there is none."""
    whole("count", count, 1, MAX_COUNT)
    return (
        math.inf if max_speed is None else positive("max_speed", max_speed, "m/s"),
        math.inf if max_spin is None else positive("max_spin", max_spin, "rad/s"),
    )

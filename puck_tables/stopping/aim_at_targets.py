"""The inverse problem: which launches come to rest at a given place, or at each of many."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables._core.executor import run_chunks
from puck_tables._core.real import broadcast, checked_threads, finite_array, positive, shown
from puck_tables.errors import InputError
from puck_tables.io.columns import COLUMNS as VARIABLES
from puck_tables.io.dataset import Dataset, variable
from puck_tables.motion.puck_spec import PUCK_UNITS, PuckSpec
from puck_tables.result import Result
from puck_tables.stopping.launch_arrays import positive_array
from puck_tables.stopping.launch_search import (
    ANGLE,
    OF,
    QUANTITIES,
    SPIN,
    STOP_TIME,
    VX,
    VY,
    LaunchSearch,
    misses,
)

MAX_COUNT = 10_000  # launches of an answer: each a row
_CHUNK = 4096  # targets that a thread takes at a time
_TRIED = 100  # launches that are integrated to tell how well they do
_LARGEST_ANGLE = 1e6  # rad: of more too few digits are left of a turn
_UNITS = {"spin": "rad/s", "speed": "m/s", "stop_time": "s", "angle": "rad"}


class LaunchColumns(Result):
    """Launches of a ``puck`` that were found: velocities (n, 2) m/s and spins (n,) rad/s."""

    puck: PuckSpec
    launch_velocity: FloatArray
    launch_spin: FloatArray
    answer: str
    ROWS: ClassVar[tuple[str, ...]] = (  # of a file
        "launch_spin", "launch_vx", "launch_vy", "launch_speed", "launch_heading",
        "launch_slip_angle", "stop_time", "body_angle",
    )  # fmt: skip

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

    def _summary(self, name: str, target: list[Any]) -> dict[str, Any]:
        """The launches with what went in, and the units of all, ready for JSON."""
        return {
            name: target, **self.puck.described(), "answer": self.answer,
            **{row: getattr(self, row).tolist() for row in self.ROWS},
            "units": {name: "m", **PUCK_UNITS, **{r: VARIABLES[r].unit for r in self.ROWS}},
        }  # fmt: skip

    def _dataset(self, title: str, **attributes: Any) -> Dataset:
        """One row a launch; the puck as attributes."""
        columns = {name: variable(name, getattr(self, name), ("launch",)) for name in self.ROWS}
        told = {"title": title, **attributes, "answer": self.answer, **self.puck.described()}
        return Dataset({}, columns, told)


@dataclass(frozen=True, eq=False, repr=False)
class Aim(LaunchColumns):
    """Launches of a ``puck`` that come to rest at ``target`` (2,) m from where they start.

    Arrays (n,), ordered by spin, the most clockwise first: ``launch_velocity`` (n, 2) m/s,
    ``launch_spin`` rad/s, ``launch_speed`` m/s, ``launch_heading`` rad, ``launch_slip_angle`` φ
    rad, ``stop_time`` s, ``body_angle`` rad by which the puck turns, and ``miss`` m: how far from
    the target an integration of the launch ends.  ``answer`` is one sentence: what was found, or
    why nothing can be.
    """

    puck: PuckSpec
    target: tuple[float, float]
    launch_velocity: FloatArray
    launch_spin: FloatArray
    stop_time: FloatArray
    body_angle: FloatArray
    miss: FloatArray
    answer: str

    picture: ClassVar[str] = "aim"
    ROWS: ClassVar[tuple[str, ...]] = (*LaunchColumns.ROWS, "miss")

    def __repr__(self) -> str:
        return f"Aim(at ({self.target[0]:g}, {self.target[1]:g}) m: {self.answer})"

    def explain(self) -> str:
        """What was found, or why nothing can be."""
        return self.answer

    def summary(self) -> dict[str, Any]:
        """The launches with what went in, and the units of all, ready for JSON."""
        return self._summary("target", list(self.target))

    def dataset(self) -> Dataset:
        """One row a launch; puck and target as attributes."""
        return self._dataset("Launches that come to rest at a target", target=list(self.target))


@dataclass(frozen=True, eq=False, repr=False)
class Aims(LaunchColumns):
    """Launches of a ``puck`` that come to rest at one of many targets from where they start.

    ``target`` (…, 2) m; ``launches`` (…): how many lead to each.  Arrays (n,) of all launches,
    target after target and ordered by spin: ``target_index``, counted through all targets,
    ``launch_velocity`` (n, 2) m/s, ``launch_spin`` rad/s, ``launch_speed`` m/s, ``launch_heading``
    rad, ``launch_slip_angle`` φ rad, ``stop_time`` s, ``body_angle`` rad.  ``miss`` m, integrated
    when first asked for: how far from its target an integration of the launch ends.  ``aims[2]``
    or ``aims[2, 3]`` is the :class:`Aim` at one target: with the reason where there is no launch.
    """

    puck: PuckSpec
    target: FloatArray
    target_index: npt.NDArray[np.int64]
    launch_velocity: FloatArray
    launch_spin: FloatArray
    stop_time: FloatArray
    body_angle: FloatArray
    wish: dict[str, FloatArray] = field(repr=False)
    rest: dict[str, Any] = field(repr=False)
    threads: int | None = None

    picture: ClassVar[str] = "aims"
    # of a file: no miss, which has to be integrated
    ROWS: ClassVar[tuple[str, ...]] = (
        "target_index", "target_x", "target_y", *LaunchColumns.ROWS,
    )  # fmt: skip

    def __repr__(self) -> str:
        return f"Aims({self.answer})"

    def __len__(self) -> int:
        return len(self.target)

    def __getitem__(self, index: Any) -> Aim:
        """The launches to one target, each integrated, and what was found in words."""
        place = self.target[index]
        if place.shape != (2,):
            raise InputError(f"an index of one target is needed, got {index!r}")
        wish: Any = {name: float(values[index]) for name, values in self.wish.items()}
        none: Any = dict.fromkeys(QUANTITIES)
        found = aim(self.puck, place, **{**none, **wish, **self.rest}, threads=self.threads)
        assert isinstance(found, Aim)
        return found

    @property
    def launches(self) -> npt.NDArray[np.int64]:
        """How many launches lead to each target, of the shape of the targets."""
        shape = self.target.shape[:-1]
        return np.bincount(self.target_index, minlength=math.prod(shape)).reshape(shape)

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
    def miss(self) -> FloatArray:
        """How far from its target an integration of each launch ends, m."""
        return misses(self.puck, self._places, self.launch_velocity, self.launch_spin, self.threads)

    @property
    def answer(self) -> str:  # type: ignore[override]
        """How many launches there are, and to how many targets there is none."""
        none, n = int((self.launches == 0).sum()), self.launches.size
        text = f"{self.launch_spin.size} launches to {n} targets"
        return f"{text}, none to {none} of them" if none else text

    def explain(self) -> str:
        """What was found, how, and how well: of some launches, integrated."""
        looked = "the stop table" if self.puck.body.is_plain else "the curve of all its launches"
        text = f"{self.answer}.\nLooked up in {looked}."
        if not self.launch_spin.size:
            return text
        some = np.unique(np.linspace(0, self.launch_spin.size - 1, _TRIED).astype(np.int64))
        error = misses(
            self.puck, self._places[some], self.launch_velocity[some], self.launch_spin[some],
            self.threads,
        )  # fmt: skip
        return f"{text}\n{some.size} of them, integrated, end at most {error.max():.1g} m off."

    def summary(self) -> dict[str, Any]:
        """The launches with what went in, and the units of all, ready for JSON."""
        return self._summary("targets", self.target.tolist())

    def dataset(self) -> Dataset:
        """One row a launch, with its target; the puck as attributes."""
        title = "Launches that come to rest at targets"
        return self._dataset(title, targets=self.launches.size)


def aim(
    puck: PuckSpec, target: npt.ArrayLike, *, spin: npt.ArrayLike | None,
    speed: npt.ArrayLike | None, stop_time: npt.ArrayLike | None, angle: npt.ArrayLike | None,
    max_speed: float | None, max_spin: float | None, count: int, threads: int | None,
) -> Aim | Aims:  # fmt: skip
    """Launches after which a puck comes to rest at targets: :meth:`puck_tables.Puck.aim`.

    One target is many of which there is one; its launches are put right by integration.
    """
    checked_threads(threads)
    places = finite_array("target", target, "m")
    if places.ndim == 0 or places.shape[-1] != 2:
        raise InputError(
            f"target must be one place (x, y) in m, or (..., 2) of them, got shape {places.shape}"
        )
    wished, given = _wish({"spin": spin, "speed": speed, "stop_time": stop_time, "angle": angle})
    bounds = _checked_bounds(max_speed, max_spin, count)
    x, y, wanted = broadcast(
        target_x=places[..., 0], target_y=places[..., 1], **{wished or "wish": given}
    )
    places = np.stack([x, y], axis=-1)
    with np.errstate(over="ignore"):
        distance = np.hypot(x, y)
    if not np.isfinite(distance).all():
        far = places[~np.isfinite(distance)][0]
        raise InputError(
            f"target ({far[0]:g}, {far[1]:g}) m is too far for floating point: use larger units"
        )
    is_one = places.ndim == 1
    search = LaunchSearch(puck, wished, bounds, count, exact=is_one)
    flat = places.reshape(-1, 2), wanted.reshape(-1), distance.reshape(-1)
    if is_one:
        rows = search.launches(*flat)
        velocity, spins = rows[:, [VX, VY]], rows[:, SPIN].copy()
        answer = f"{len(rows)} launch{'' if len(rows) == 1 else 'es'}"
        return Aim(
            puck, (x.item(), y.item()), velocity, spins, rows[:, STOP_TIME].copy(),
            rows[:, ANGLE].copy(), misses(puck, places, velocity, spins, threads),
            answer if len(rows) else search.reason(*flat[1:]),
        )  # fmt: skip
    result: dict[int, FloatArray] = {}

    def work(start: int, stop: int) -> None:
        found = search.launches(*(one[start:stop] for one in flat))
        found[:, OF] += start
        result[start] = found

    run_chunks(work, distance.size, _CHUNK, threads)
    rows = np.concatenate([np.empty((0, ANGLE + 1)), *(result[n] for n in sorted(result))])
    return Aims(
        puck, places, rows[:, OF].astype(np.int64), rows[:, [VX, VY]], rows[:, SPIN].copy(),
        rows[:, STOP_TIME].copy(), rows[:, ANGLE].copy(),
        {} if wished is None else {wished: wanted},
        {"max_speed": max_speed, "max_spin": max_spin, "count": count}, threads,
    )  # fmt: skip


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
    if not isinstance(count, int) or not 1 <= count <= MAX_COUNT:
        raise InputError(f"count must be a whole number from 1 to {MAX_COUNT}, got {shown(count)}")
    return (
        math.inf if max_speed is None else positive("max_speed", max_speed, "m/s"),
        math.inf if max_spin is None else positive("max_spin", max_spin, "rad/s"),
    )

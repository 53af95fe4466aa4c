"""The inverse problem for many targets at once."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables._core.executor import run_chunks
from puck_tables._core.real import broadcast, checked_threads, finite_array
from puck_tables.errors import InputError
from puck_tables.io.columns import COLUMNS as VARIABLES
from puck_tables.io.dataset import Dataset, variable
from puck_tables.motion.puck_spec import PUCK_UNITS, PuckSpec
from puck_tables.stopping.aim_at_target import (
    BEYOND,
    COLUMNS,
    SLACK,
    TOO_LARGE,
    Aim,
    aim_at,
    checked_bounds,
    refuse_both,
)
from puck_tables.stopping.aim_lookup import BEND, RIM, SPEED, TIME
from puck_tables.stopping.launch_arrays import fits, positive_array
from puck_tables.stopping.launch_columns import Aimed
from puck_tables.stopping.launch_family import LaunchCurve, launch_curve
from puck_tables.stopping.launch_ranges import between, joined, sample
from puck_tables.stopping.target_error import misses

ROWS = ("target_index", "target_x", "target_y", *COLUMNS[:-1])  # of a file: no miss, see Aims
_CHUNK = 4096  # targets that a thread takes at a time
_TRIED = 100  # launches that are integrated to tell how well they do
_QUANTITIES = {"spin": RIM, "speed": SPEED, "stop_time": TIME}
_UNITS = {"spin": "rad/s", "speed": "m/s", "stop_time": "s"}
_LARGEST_LOG = 708.0  # exp of it is still a number
_OF, _SPIN, _VX, _VY, _TIME = range(5)
_LAUNCH = 5  # columns: vx, vy, ω, time, miss


@dataclass(frozen=True, eq=False, repr=False)
class Aims(Aimed):
    """Launches of a ``puck`` that come to rest at one of many targets from where they start.

    ``target`` (…, 2) m; ``launches`` (…): how many lead to each.  Arrays (n,) of all launches,
    target after target and ordered by spin: ``target_index``, counted through all targets,
    ``launch_velocity`` (n, 2) m/s, ``launch_spin`` rad/s, ``launch_speed`` m/s, ``launch_heading``
    rad, ``launch_slip_angle`` φ rad, ``stop_time`` s.  ``miss`` m, integrated when first asked for:
    how far from its target an integration of the launch ends.  ``aims[2]`` or ``aims[2, 3]`` is the
    :class:`Aim` at one target: with the reason where there is no launch.
    """

    puck: PuckSpec
    target: FloatArray
    target_index: npt.NDArray[np.int64]
    launch_velocity: FloatArray
    launch_spin: FloatArray
    stop_time: FloatArray
    wish: dict[str, FloatArray] = field(repr=False)
    rest: dict[str, Any] = field(repr=False)
    threads: int | None = None

    picture: ClassVar[str] = "aims"

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
        return aim_at(self.puck, place, **{**_NO_WISH, **wish, **self.rest})

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
    def answer(self) -> str:
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
        off = misses(
            self.puck, self._places[some], self.launch_velocity[some], self.launch_spin[some],
            self.threads,
        )  # fmt: skip
        return f"{text}\n{some.size} of them, integrated, end at most {off.max():.1g} m off."

    def summary(self) -> dict[str, Any]:
        """The launches with what went in, and the units of all, ready for JSON."""
        return {
            "targets": self.target.tolist(), **self.puck.described(), "answer": self.answer,
            **{name: getattr(self, name).tolist() for name in ROWS},
            "units": {"targets": "m", **PUCK_UNITS, **{n: VARIABLES[n].unit for n in ROWS}},
        }  # fmt: skip

    def dataset(self) -> Dataset:
        """One row a launch, with its target; the puck as attributes."""
        columns = {name: variable(name, getattr(self, name), ("launch",)) for name in ROWS}
        attributes = {
            "title": "Launches that come to rest at targets",
            "targets": self.launches.size, "answer": self.answer, **self.puck.described(),
        }  # fmt: skip
        return Dataset({}, columns, attributes)


_NO_WISH: dict[str, Any] = dict.fromkeys(_QUANTITIES)


def aim(
    puck: PuckSpec, target: npt.ArrayLike, *, spin: npt.ArrayLike | None,
    speed: npt.ArrayLike | None, stop_time: npt.ArrayLike | None, max_speed: float | None,
    max_spin: float | None, count: int, threads: int | None,
) -> Aim | Aims:  # fmt: skip
    """Launches after which a puck comes to rest at targets: :meth:`puck_tables.Puck.aim`."""
    checked_threads(threads)
    places = finite_array("target", target, "m")
    if places.ndim == 0 or places.shape[-1] != 2:
        raise InputError(
            f"target must be one place (x, y) in m, or (..., 2) of them, got shape {places.shape}"
        )
    wishes = {"spin": spin, "speed": speed, "stop_time": stop_time}
    wished = refuse_both(**wishes)
    given = np.zeros(())
    if wished == "spin":
        given = finite_array("spin", wishes["spin"], "rad/s")  # type: ignore[arg-type]
    elif wished is not None:
        given = positive_array(wished, wishes[wished], _UNITS[wished])  # type: ignore[arg-type]
    rest: dict[str, Any] = {"max_speed": max_speed, "max_spin": max_spin, "count": count}
    if places.ndim == 1 and given.ndim == 0:
        own = {} if wished is None else {wished: given.item()}
        return aim_at(puck, places, **{**_NO_WISH, **own, **rest})
    bounds = checked_bounds(max_speed, max_spin, count)
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
    search = _Search(puck, wished, bounds, count)
    found: dict[int, FloatArray] = {}
    flat = places.reshape(-1, 2), wanted.reshape(-1), distance.reshape(-1)

    def work(start: int, stop: int) -> None:
        rows = search.launches(*(one[start:stop] for one in flat))
        rows[:, _OF] += start
        found[start] = rows

    run_chunks(work, distance.size, _CHUNK, threads)
    rows = np.concatenate([np.empty((0, _LAUNCH)), *(found[start] for start in sorted(found))])
    wish = {} if wished is None else {wished: wanted}
    return Aims(
        puck, places, rows[:, _OF].astype(np.int64), rows[:, [_VX, _VY]], rows[:, _SPIN].copy(),
        rows[:, _TIME].copy(), wish, rest, threads,
    )  # fmt: skip


@dataclass(frozen=True)
class _Search:
    """Launches to many targets: ``wished`` picks some of each family, within ``bounds``."""

    puck: PuckSpec
    wished: str | None
    bounds: tuple[float, float]
    count: int

    @cached_property
    def curve(self) -> LaunchCurve:
        return launch_curve(self.puck.body)

    @property
    def _limits(self) -> FloatArray:
        """Ln of the largest speed and rim speed."""
        fastest, widest = self.bounds
        return np.array([math.log(fastest), math.log(widest) + math.log(self.puck.radius)])

    def launches(self, places: FloatArray, wanted: FloatArray, distance: FloatArray) -> FloatArray:
        """Rows (m, 5) of launches to targets (n, 2): of which, ω, vx, vy, stop time."""
        puck, away = self.puck, np.flatnonzero(distance > 0.0)
        rows = [self._on_the_spot(n, wanted[n]) for n in np.flatnonzero(distance == 0.0).tolist()]
        with np.errstate(divide="ignore"):
            half_d, half_j = 0.5 * np.log(distance[away]), 0.5 * math.log(puck.decel)
        scales = np.stack([half_j + half_d, half_j + half_d, half_d - half_j, 0.0 * half_d], axis=1)
        which, logs = self._logs(scales, wanted[away])
        limits = self._limits
        good = (logs[:, [SPEED, RIM]] <= limits + SLACK).all(axis=1)
        which, logs = which[good], logs[good]
        slides = logs[:, RIM] == -math.inf
        if not (np.abs(logs[:, [SPEED, TIME]]) < _LARGEST_LOG).all():
            raise InputError(TOO_LARGE)
        log_spin = logs[~slides, RIM] - math.log(puck.radius)
        if not (np.abs(log_spin) < _LARGEST_LOG).all():
            raise InputError(TOO_LARGE)
        speed, time, turning = np.exp(logs[:, SPEED]), np.exp(logs[:, TIME]), np.zeros(which.size)
        turning[~slides] = np.exp(log_spin)
        bearing = np.arctan2(places[away, 1], places[away, 0])[which]
        for sense in (-1.0, 1.0):
            chosen = ~slides | (sense > 0.0)
            if self.wished == "spin":
                chosen &= np.copysign(1.0, wanted[away][which]) == sense
                chosen |= slides & (sense > 0.0)
            heading = bearing - sense * logs[:, BEND]
            both = [away[which], sense * turning, speed * np.cos(heading), speed * np.sin(heading),
                    time]  # fmt: skip
            rows.append(np.stack(both, axis=1)[chosen])
        found = np.concatenate(rows) + 0.0  # no negative zero
        self._refuse_too_large(found)
        return found[np.lexsort((found[:, _SPIN], found[:, _OF]))]

    def _logs(self, scales: FloatArray, wanted: FloatArray) -> tuple[npt.NDArray[Any], FloatArray]:
        """Of which target, and ln v, ln r|ω|, ln t₀ and arg Z, of all launches that are wished."""
        if self.wished is None:
            which, u = self._sampled(scales)
            return which, self.curve.looked_up(u) + scales[which]
        quantity = _QUANTITIES[self.wished]
        with np.errstate(divide="ignore"):
            log = np.log(np.abs(wanted))
        log += math.log(self.puck.radius) if quantity == RIM else 0.0
        values = log - scales[:, quantity]
        which, u = self.curve.roots(quantity, values)
        none = np.bincount(which, minlength=wanted.size) == 0
        if quantity == RIM:
            still = np.flatnonzero(wanted == 0.0)
            none[still] = False
            which, u = np.append(which, still), np.append(u, np.full(still.size, -math.inf))
        else:
            best = self.curve.extreme(quantity)[1]
            none &= (values > best) != (quantity == SPEED)
        if none.any():
            raise InputError(BEYOND)
        logs = self.curve.looked_up(u) + scales[which]
        logs[:, quantity] = log[which]
        return which, logs

    def _sampled(self, scales: FloatArray) -> tuple[npt.NDArray[Any], FloatArray]:
        """A sample of the family of each target: of which, and u."""
        n, limits = len(scales), self._limits
        if not np.isfinite(limits).any():  # of all the same
            one = np.array(sample([(-math.inf, math.inf)], self.count))
            return np.repeat(np.arange(n), one.size), np.tile(one, n)
        ends: list[set[float]] = [{-math.inf, math.inf} for _ in range(n)]
        for quantity, limit in zip((SPEED, RIM), limits.tolist(), strict=True):
            of, u = self.curve.roots(quantity, limit - scales[:, quantity])
            for target, end in zip(of.tolist(), u.tolist(), strict=True):
                ends[target].add(end)
        intervals = [list(pairwise(sorted(one))) for one in ends]
        middles = np.array([between(*one) for some in intervals for one in some])
        sizes = [len(some) for some in intervals]
        logs = self.curve.looked_up(middles) + np.repeat(scales, sizes, axis=0)
        allowed = np.all(logs[:, [SPEED, RIM]] <= limits, axis=1)
        inside = iter(allowed.tolist())
        us = [sample(joined(some, [next(inside) for _ in some]), self.count) for some in intervals]
        which = np.repeat(np.arange(n), [len(one) for one in us])
        return which, np.array([u for one in us for u in one])

    def _on_the_spot(self, n: int, wanted: float) -> FloatArray:
        """Launches to a target where the puck lies."""
        wish = {} if self.wished is None else {self.wished: float(wanted)}
        found = aim_at(
            self.puck, (0.0, 0.0), **{**_NO_WISH, **wish}, max_speed=None, max_spin=None, count=1
        )
        rows = np.zeros((found.launch_spin.size, _LAUNCH))
        rows[:, _OF], rows[:, _SPIN], rows[:, _TIME] = n, found.launch_spin, found.stop_time
        return rows

    def _refuse_too_large(self, rows: FloatArray) -> None:
        puck = self.puck
        same = (np.full(len(rows), value) for value in (puck.delta, puck.decel, puck.radius))
        launched = np.stack([*rows[:, [_VX, _VY, _SPIN]].T, *same])
        if not fits(launched, puck.body.longest).all():
            raise InputError(TOO_LARGE)

"""Stops over ranges of whatever a launch or a puck has, and of launches that scatter: as work."""

from __future__ import annotations

from collections.abc import Container, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray, one_velocity
from puck_tables._core.memory import check_memory
from puck_tables._core.own_folder import say
from puck_tables._core.waiting import Progress
from puck_tables.bulk.finish import Doing, finish
from puck_tables.bulk.spreads import checked_samples
from puck_tables.bulk.work import Columns, Tally, Work
from puck_tables.errors import ContactError, InputError
from puck_tables.io.columns import Dataset, variable
from puck_tables.motion.puck_spec import PuckSpec
from puck_tables.result import Result
from puck_tables.stopping.per_height import HEIGHT_COST, MOST_HEIGHTS, SolverPerHeight, refuse_many
from puck_tables.stopping.population import (
    COLUMN,
    Population,
    StopMap,
    StopSample,
    drawn,
    labelled,
    law_name,
    ranged,
    velocities,
)
from puck_tables.stopping.solvers import OUTPUTS, STATUS_MEANINGS, BaseSolver

if TYPE_CHECKING:
    from puck_tables.accuracy.method_errors import Selection

# Arrays, the encoded HDF5 file and working copies; as text (CSV) much more.
BYTES_PER_LAUNCH, BYTES_PER_ROW = 160, 850
BLOCKS = (1 << 14, 1 << 18), (1 << 8, 1 << 13)  # launches; the latter where one takes long
_SLAB = 1 << 20  # pucks whose heights are sorted at once
Kind = tuple[int, float]  # number of the pressure law, radius of gyration
By = tuple[float, str | None, Any]  # tolerance, method, table


class StopWork(Work):
    """Stops of many launches.

    ``launches``: their numbers; ``puck``: whose base they have, if it is not round, and whose
    gyration where it is not among them; ``by``: tolerance, method and table; ``part``: as ``chunk``
    of :meth:`puck_tables.Puck.sweep`.
    """

    code = "status"

    def __init__(self, launches: Population, puck: PuckSpec, by: By, part: int) -> None:
        self.launches, self.tol, self.part = launches, by[0], part
        self.shape = launches.shape
        self.columns = {COLUMN[name]: () for name in launches.spreads}
        self.is_sample = bool(launches.spreads)
        self._how, self._base = by, puck.shape
        self._gyration = puck.gyration if puck.shape is None else puck.inertia_radius
        self._solvers: dict[Kind, Any] = {}  # a SolverPerHeight each, or one BaseSolver
        if puck.shape is not None:
            puck.refuse_for_round(method=by[1], table=by[2])
            self._solvers[0, self._gyration] = BaseSolver(puck.shape, self.tol)
            self.columns |= dict.fromkeys(BaseSolver.outputs, ())
            return
        self.columns |= dict.fromkeys(OUTPUTS, ())
        if launches.axes.keys().isdisjoint(("pressure", "gyration")):  # a wrong one at once
            self._solver((0, float(launches.values.get("gyration", self._gyration))))

    def refuse_memory(self) -> None:
        """By its launches."""
        check_memory(self.shape, BYTES_PER_LAUNCH)

    @property
    def block(self) -> int:  # type: ignore[override]
        """Fewer launches where each takes long."""
        fewest, most = BLOCKS[self.method != "look-up"]
        return min(most, max(fewest, self.size // 64))

    def _solver(self, kind: Kind) -> Any:
        if kind not in self._solvers:
            self._solvers[kind] = SolverPerHeight(self.launches.laws[kind[0]], kind[1], *self._how)
        return self._solvers[kind]

    def prepared(self, threads: int | None, progress: Progress | None) -> Progress | None:
        """Make the solvers of all pucks there are; on a base that is not round none is made."""
        if self._base is not None:
            return progress
        heights = self._heights()
        wanted = {
            kind: int(np.count_nonzero(self._solver(kind).needs_preparation(sought)))
            for kind, (sought, _) in heights.items()
        }
        first = HEIGHT_COST * sum(wanted.values())
        total, before = first + self.size, 0
        for kind, (sought, counts) in heights.items():

            def on_heights(done: int, _: int, before: int = before) -> None:
                if progress is not None:
                    progress(before + HEIGHT_COST * done, total)

            self._solver(kind).prepare(sought, counts, threads, on_heights)
            before += HEIGHT_COST * wanted[kind]

        def on_stops(done: int, _: int) -> None:
            if progress is not None:
                progress(first + done, total)

        return on_stops

    def _heights(self) -> dict[Kind, tuple[FloatArray, npt.NDArray[np.int64]]]:
        """The different heights of each kind of puck, and how many launches have them.

        Of plain heights, which need nothing, one stands for all.
        """
        pucks = self.launches.of_pucks()
        each = self.size // pucks.size
        sought: dict[Kind, dict[float, int]] = {}
        for start in range(0, pucks.size, _SLAB):
            stop = min(start + _SLAB, pucks.size)
            numbers = self._rows(pucks.at(start, stop), stop - start)
            for kind, mine in self._kinds(numbers):
                delta = self._solver(kind).checked_range(numbers[3, mine])
                other = self._solver(kind).needs_preparation(delta)
                heights, counts = np.unique(delta[other], return_counts=True)
                if not other.all():
                    plain = delta[~other]
                    heights = np.append(heights, plain[0])
                    counts = np.append(counts, plain.size)
                of_kind = sought.setdefault(kind, {})
                for height, count in zip(heights.tolist(), counts.tolist(), strict=True):
                    of_kind[height] = of_kind.get(height, 0) + each * count
                self._refuse_many(sought)
        return {
            kind: (np.array(list(one)), np.array(list(one.values()), np.int64))
            for kind, one in sought.items()
        }

    def _refuse_many(self, pucks: Mapping[Kind, Mapping[float, int]]) -> None:
        """Refuse more pucks than can be prepared."""
        wanted = 0
        for kind, one in pucks.items():
            heights = np.array(list(one))
            others = heights[self._solver(kind).needs_preparation(heights)]
            refuse_many(others)
            wanted += others.size
        if max(wanted, len(pucks)) > MOST_HEIGHTS:
            raise InputError(
                f"{max(wanted, len(pucks))} different pucks or more (of pressure, gyration, delta) "
                f"are too many, each takes about a second to prepare: give at most {MOST_HEIGHTS}"
            )

    def _kinds(self, numbers: FloatArray) -> list[tuple[Kind, Any]]:
        """The kinds of pucks among launches (8, n), and where they are."""
        if not self._many_kinds:
            return [((0, float(numbers[7, 0])), slice(None))]
        kinds, which = np.unique(numbers[6:], axis=1, return_inverse=True)
        if kinds.shape[1] > MOST_HEIGHTS:
            self._refuse_many({(0, k): {} for k in kinds[1].tolist()})
        return [
            ((int(law), float(gyration)), which.ravel() == n)
            for n, (law, gyration) in enumerate(kinds.T)
        ]

    @property
    def _many_kinds(self) -> bool:
        one = self.launches
        return bool(
            one.over.get("pressure") or one.over.get("gyration") or "gyration" in one.spreads
        )

    def _rows(self, one: Mapping[str, Any], count: int) -> FloatArray:
        """Rows vx, vy, ω, δ, J, r, law, k of launches by their numbers, array (8, count).

        On a base that is not round f z in place of δ, and k in place of r.
        """
        rows, base = np.empty((8, count)), self._base
        rows[:2] = velocities(one, count)
        rows[2], friction = one.get("spin", 0.0), one.get("friction", 1.0)
        rows[5] = self._gyration if base is not None else one["radius"]
        with np.errstate(over="ignore", under="ignore"):
            if base is not None:
                rows[3] = 0.5 * friction * one["height"]
            elif "delta" in one:
                rows[3] = one["delta"]
            else:
                rows[3] = 2.0 * friction * one["height"] / one["radius"]
            rows[4] = one["decel"] if "decel" in one else friction * one["gravity"]
        if not (np.isfinite(rows[3]).all() and np.isfinite(rows[4]).all() and rows[4].all()):
            radius, delta = ("radius, ", "a delta or ") if base is None else ("", "")
            raise InputError(
                f"{radius}height, friction and gravity give {delta}a J out of the range of "
                "floating point: use numbers of a real puck"
            )
        if base is not None and count and rows[3].max() > base.highest_lever:
            raise ContactError(
                f"friction times height = {2.0 * rows[3].max():.6g} m: part of the base would "
                f"lift; it stays down up to {2.0 * base.highest_lever:.6g} m; a Scene moves it, "
                "one-sided"
            )
        rows[6], rows[7] = one.get("pressure", 0.0), one.get("gyration", self._gyration)
        return rows

    def of(self, start: int, stop: int) -> Columns:
        """Stops of some launches."""
        one = self.launches.at(start, stop)
        numbers = self._rows(one, stop - start)
        kinds = self._kinds(numbers)
        if len(kinds) == 1:
            out, status = self._solver(kinds[0][0]).all(numbers[:6])
        else:
            out, status = np.empty((len(OUTPUTS), stop - start)), np.empty(stop - start, np.int8)
            for kind, mine in kinds:
                out[:, mine], status[mine] = self._solver(kind).all(numbers[:6, mine])
        sought: Columns = {COLUMN[name]: one[name] for name in self.launches.spreads}
        values = zip(OUTPUTS, out, strict=True)
        sought |= {name: row for name, row in values if name in self.columns}
        return sought | {self.code: status}

    @property
    def identity(self) -> Mapping[str, Any]:
        """Solvers, launches and tolerance."""
        solvers = [[*kind, one.work] for kind, one in sorted(self._solvers.items())]
        return {"solvers": solvers, "launches": self.launches.identity, "tol": self.tol}

    def checked(self, tally: Tally) -> None:
        """Refuse launches all of which are too large for floating point."""
        if self.size and not tally.counts.get(0):
            raise InputError(
                "all these launches are too large for floating point: use larger units"
            )

    def labelled(self, columns: Columns) -> Dataset:
        """The stops over what ranges; the rest as attributes."""
        axes, variables = self.launches.variables()
        labels = dict(variables)
        for name in self.columns:
            labels[name] = variable(name, columns[name], self.launches.dims)
        labels["status"] = variable(
            "status", columns["status"], self.launches.dims, STATUS_MEANINGS
        )
        attributes = {
            "title": "Stops of sliding, spinning pucks", **self.launches.fixed, "tol": self.tol,
            "method": self.method, "table": self.source,
        }  # fmt: skip
        if self.launches.spreads:
            drawn = {COLUMN[name]: str(one) for name, one in self.launches.spreads.items()}
            attributes |= {f"drawn_{name}": text for name, text in drawn.items()}
            attributes["seed"] = self.launches.seed
        if self._base is not None:
            attributes |= {"base": self._base.name, "gyration": self._gyration}
        return Dataset(axes, labels, attributes)

    def result(self, columns: Columns) -> StopMap:
        """A map, or samples."""
        return (StopSample if self.launches.spreads else StopMap)(
            self.launches, self.tol, self.method, self.source, self.selections, self.explain(),
            self.labelled(columns),
        )  # fmt: skip

    @property
    def method(self) -> str:
        """'look-up', 'integrated' or both."""
        words = sorted({word for one in self._used for word in one.method.split(" and ")})
        return " and ".join(sorted(words, key=lambda word: word != "look-up"))

    @property
    def source(self) -> str:
        """What the stops come from, in words."""
        return "; ".join(dict.fromkeys(one.source for one in self._used))

    @property
    def selections(self) -> tuple[Selection, ...]:
        """What was selected for the tolerance."""
        return tuple(selection for one in self._used for selection in one.selections)

    def explain(self, tally: Tally | None = None) -> str:
        """What was taken for which launches, and why."""
        texts = [
            f"{law_name(self.launches.laws[law])}, k/r = {gyration:g}:\n{solver.explanation}"
            if len(self._solvers) > 1 else solver.explanation
            for (law, gyration), solver in sorted(self._solvers.items())
        ]  # fmt: skip
        return "\n".join(texts)

    @property
    def _used(self) -> list[Any]:
        return [solver for _, solver in sorted(self._solvers.items())]


DEFAULT_SPEED = np.linspace(0.0, 2.0, 41)
DEFAULT_SPIN = np.linspace(-4.0, 4.0, 41)


def sweep(puck: Any, chosen: Mapping[str, Any], launches: Any, by: By, how: Doing) -> Result:
    """Stops of all combinations of numbers: :meth:`puck_tables.Puck.sweep`; ``by``: computed so."""
    numbers = numbers_of(puck, chosen)
    if launches is None:
        if not {"spin", "speed", "vx", "vy"} & numbers.keys():
            scale = 1.0 if puck.shape is None else 2.0 * puck.inertia_radius
            numbers |= {"spin": DEFAULT_SPIN / scale, "speed": DEFAULT_SPEED}
        laws = numbers.pop("pressure", puck.pressure)
        return _done(puck, ranged(_whole(puck, numbers, numbers), laws), by, how)
    if not (hasattr(launches, "variables") and hasattr(launches, "sizes")):
        raise InputError("launches must be an xarray.Dataset, with variables such as launch_spin")
    laws = numbers.pop("pressure", puck.pressure)
    names = {*numbers, *(argument for argument, column in COLUMN.items()
                         if column in launches.variables)}  # fmt: skip
    read = set(COLUMN.values())
    if unread := [str(name) for name in launches.data_vars if name not in read]:
        say(f"launches: variables not read: {', '.join(unread)[:400]}")
    return _done(puck, labelled(launches, _whole(puck, numbers, names), laws), by, how)


def sample(
    puck: Any, count: int, seed: int, chosen: Mapping[str, Any], by: By, how: Doing
) -> Result:
    """Stops of launches that scatter: :meth:`puck_tables.Puck.sample`."""
    count, seed = checked_samples(count, seed)
    numbers = numbers_of(puck, chosen)
    laws = numbers.pop("pressure", puck.pressure)
    return _done(puck, drawn(_whole(puck, numbers, numbers), laws, count, seed), by, how)


def numbers_of(puck: Any, chosen: Mapping[str, Any]) -> dict[str, Any]:
    """What was given, by the names of arguments; a velocity by its components."""
    numbers = {name: value for name, value in chosen.items() if value is not None}
    _refuse_of_round(puck, numbers)
    if "velocity" in numbers:
        if {"speed", "heading", "vx", "vy"} & numbers.keys():
            raise InputError(
                "velocity and speed both give the velocity (and heading, vx, vy): give one of them"
            )
        numbers["vx"], numbers["vy"] = one_velocity(numbers.pop("velocity"))
    return numbers


def _whole(puck: Any, numbers: Mapping[str, Any], names: Container[str]) -> dict[str, Any]:
    """The numbers given, of arguments of these names, and what else a launch needs."""
    if "friction" not in names:
        puck.refuse_unless_free()
    whole: dict[str, Any] = {}
    if not any(name in names for name in ("speed", "vx", "vy")):
        whole["speed"] = 1.0
    elif "vx" in names and "vy" not in names:
        whole["vy"] = 0.0
    elif "vy" in names and "vx" not in names:
        whole["vx"] = 0.0
    whole |= {} if "spin" in names else {"spin": 0.0}
    if puck.shape is not None:
        return {**whole, **_on_base(puck, names), **numbers}
    whole |= {} if "radius" in names else {"radius": puck.radius}
    dimensions = [name in names for name in ("height", "friction", "radius")]
    if "delta" not in names:
        name = "height" if any(dimensions) else "delta"
        whole |= {} if name in names else {name: getattr(puck, name)}
    if "decel" not in names:
        name = "gravity" if "friction" in names or "gravity" in names else "decel"
        whole |= {} if name in names else {name: getattr(puck, name)}
    real = any(one in names or one in {*whole, *numbers} for one in ("height", "gravity"))
    if real and "friction" not in names:
        whole["friction"] = puck.friction
    return {**whole, **numbers}


def _on_base(puck: Any, names: Container[str]) -> dict[str, Any]:
    """What else a launch of a puck on a base needs; what it cannot have is refused."""
    _refuse_of_round(puck, names)
    whole = {name: getattr(puck, name) for name in ("height", "friction") if name not in names}
    if "decel" not in names and "gravity" not in names:
        name = "gravity" if "friction" in names else "decel"
        whole[name] = getattr(puck, name)
    return whole


def _refuse_of_round(puck: Any, names: Container[str]) -> None:
    """Refuse numbers that a puck on a base does not have, or has once for all."""
    for name in ("radius", "delta", "pressure", "gyration"):
        if name in names:
            puck.refuse_base(f"{name} of a sweep or a sample")


def _done(puck: Any, launches: Population, by: By, how: Doing) -> Result:
    """The result, or what stands in the store."""
    result: Result = finish(StopWork(launches, puck, by, how.chunk), how)
    return result

"""Many stops of pucks on one base that is not round, as work."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables._core.executor import Progress
from puck_tables.accuracy.method_errors import Selection
from puck_tables.bulk.work import Columns, Tally
from puck_tables.errors import ContactError, InputError
from puck_tables.io.dataset import Dataset
from puck_tables.motion.puck_spec import PuckSpec
from puck_tables.stopping.base_solver import BaseSolver
from puck_tables.stopping.population import COLUMN, Population
from puck_tables.stopping.stop_map import StopMap, StopSample
from puck_tables.stopping.sweep_work import StopWork, velocities


class BaseStopWork(StopWork):
    """Stops of many launches of pucks on one base, of heights and frictions that may range.

    Parameters
    ----------
    launches : their numbers
    puck : whose base and radius of gyration they have
    tol, part
        As :meth:`puck_tables.Puck.sweep` takes them.
    """

    method = "integrated"
    selections: tuple[Selection, ...] = ()

    def __init__(self, launches: Population, puck: PuckSpec, tol: float, part: int) -> None:
        assert puck.shape is not None
        self.launches, self.tol, self.part = launches, tol, part
        self.shape = launches.shape
        self._puck, self._base_solver = puck, BaseSolver(puck.shape, tol)
        self.columns = {COLUMN[name]: () for name in launches.spreads}
        self.columns |= dict.fromkeys(BaseSolver.outputs, ())
        self.is_sample = bool(launches.spreads)

    def prepared(self, threads: int | None, progress: Progress | None) -> Progress | None:
        """Nothing."""
        return progress

    def _launches_of(self, one: Mapping[str, Any], count: int) -> FloatArray:
        """Launches (6, count): vx, vy, ω, f z, J, k."""
        rows = np.empty((6, count))
        rows[:2] = velocities(one, count)
        friction = one.get("friction", self._puck.friction)
        with np.errstate(over="ignore", under="ignore"):
            rows[2], rows[3] = one.get("spin", 0.0), 0.5 * friction * one["height"]
            rows[4] = one["decel"] if "decel" in one else friction * one["gravity"]
        rows[5] = self._puck.inertia_radius
        if not (np.isfinite(rows[3]).all() and np.isfinite(rows[4]).all() and rows[4].all()):
            raise InputError(
                "height, friction and gravity give a J out of the range of floating point: use "
                "numbers of a real puck"
            )
        highest = self._puck.shape.highest_lever if self._puck.shape is not None else 0.0
        if count and rows[3].max() > highest:
            raise ContactError(
                f"friction times height = {2.0 * rows[3].max():.6g} m: part of the base would "
                f"lift; it stays down up to {2.0 * highest:.6g} m"
            )
        return rows

    def of(self, start: int, stop: int) -> Columns:
        """Stops of some launches."""
        one = self.launches.at(start, stop)
        out, status = self._base_solver.all(self._launches_of(one, stop - start))
        sought: Columns = {COLUMN[name]: one[name] for name in self.launches.spreads}
        return sought | self._base_solver.named(out) | {self.code: status}

    @property
    def identity(self) -> Mapping[str, Any]:
        """Base, launches and tolerance."""
        numbers = [self._puck.inertia_radius, self._puck.friction]
        return {
            "solver": self._base_solver.work, "puck": numbers, "launches": self.launches.identity,
            "tol": self.tol,
        }  # fmt: skip

    def labelled(self, columns: Columns) -> Dataset:
        """The stops over what ranges; the rest as attributes, with the base."""
        found = super().labelled(columns)
        assert self._puck.shape is not None
        told = {"base": self._puck.shape.name, "gyration": self._puck.inertia_radius}
        return Dataset(found.axes, found.columns, {**found.attributes, **told})

    def result(self, columns: Columns) -> StopMap:
        """A map, or samples."""
        return (StopSample if self.launches.spreads else StopMap)(
            self.launches, self.tol, self.method, self.source, (), self.explain(),
            self.labelled(columns),
        )  # fmt: skip

    @property
    def source(self) -> str:
        """What the stops come from, in words."""
        return self._base_solver.source

    def explain(self, tally: Tally | None = None) -> str:
        """What was taken, and why."""
        return self._base_solver.explanation

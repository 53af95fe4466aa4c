"""Solvers of stops, each for the heights that it is good for: by look-up, or by integration.

A new one is a class here or beside, and its place in :mod:`puck_tables.stopping.per_height`.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables._core.executor import in_slices
from puck_tables.accuracy.methods import Method
from puck_tables.motion.steppers import Stepping
from puck_tables.stopping.lookup import STOP_POWERS
from puck_tables.stopping.stop_section import StopSection
from puck_tables.stopping.stop_table import StopTable

Status = npt.NDArray[np.int8]

OUTPUTS = ("stop_time", "stop_x", "stop_y", "path_length", "turn_angle", "body_angle")
STATUS_MEANINGS = ("stopped", "step_limit", "overflow")
_OVERFLOW = STATUS_MEANINGS.index("overflow")


class StopSolver(ABC):
    """Stops of launches of the heights that it is for.

    ``method``: how; ``error``: the largest, as promised or measured.
    """

    method: Method
    error: float

    @property
    @abstractmethod
    def work(self) -> dict[str, Any]:
        """What determines the bits besides the launches."""

    @abstractmethod
    def all(self, launches: FloatArray) -> tuple[FloatArray, Status]:
        """All of :data:`OUTPUTS` (6, n) and status (n,) of checked launches (6, n)."""

    def first(self, launches: FloatArray) -> tuple[FloatArray, Status]:
        """Stop time, x, y (3, n), or all of the outputs if they cost no more; status (n,)."""
        return self.all(launches)


@dataclass(frozen=True)
class LookUp(StopSolver):
    """Stops from a stop table, as coarse a cut of it as is good enough: nothing is integrated."""

    table: StopTable
    powers: int = STOP_POWERS
    thinning: int = 1
    error: float = 0.0
    method: Method = Method.LOOK_UP

    @property
    def work(self) -> dict[str, Any]:
        """The table, and its cut."""
        return {
            "by": self.method, "values": self.table.values, "powers": self.powers,
            "thinning": self.thinning,
        }  # fmt: skip

    def first(self, launches: FloatArray) -> tuple[FloatArray, Status]:
        """Stop time, x, y (3, n) and status (n,)."""
        out, overflows = self.table.stops(launches, self.powers, self.thinning)
        status = np.zeros(out.shape[1], np.int8)
        if overflows:
            mark_too_large(out, status, launches, 2.0)
        return out, status

    def all(self, launches: FloatArray) -> tuple[FloatArray, Status]:
        """All of the outputs (6, n) and status (n,)."""
        from puck_tables.stopping.curve_lookup import BODY, LENGTH, TURN

        known = self.table.known(launches)
        first, status = self.first(launches)
        out = np.concatenate([first, known[[LENGTH, TURN, BODY]]])
        out[:, status != 0] = np.nan
        return out, status


@dataclass(frozen=True)
class SectionLookUp(StopSolver):
    """Stops of the pucks of one height from a stop section."""

    section: StopSection
    error: float
    method: Method = Method.LOOK_UP

    @property
    def work(self) -> dict[str, Any]:
        """The section."""
        return {"by": self.method, "section": self.section.cut}

    def all(self, launches: FloatArray) -> tuple[FloatArray, Status]:
        """All of the outputs (6, n) and status (n,)."""
        from puck_tables.stopping.section_lookup import fill_section_stops

        out = np.empty((len(OUTPUTS), launches.shape[1]))
        status = np.zeros(launches.shape[1], np.int8)
        fill_section_stops(launches, self.section.cut, out)
        mark_too_large(out, status, launches, self.section.body.longest)
        return out, status


@dataclass(frozen=True)
class Integration(StopSolver):
    """Stops by an integrator.

    ``columns``: of a table of resultants; ``section``: of one puck, whose height all launches must
    have; both empty: closed forms.  ``longest``: how many Q/J a motion may last.
    """

    columns: FloatArray = field(repr=False)
    section: FloatArray = field(repr=False)
    stepping: Stepping
    method: Method
    error: float = 0.0
    longest: float = 2.0

    @property
    def work(self) -> dict[str, Any]:
        """The friction, and the setting of the integrator."""
        return {
            "by": self.method, "values": self.columns if self.columns.size > 0 else self.section,
            "steps": self.stepping.steps, "tolerance": self.stepping.local,
        }  # fmt: skip

    def all(self, launches: FloatArray) -> tuple[FloatArray, Status]:
        """All of the outputs (6, n) and status (n,)."""
        from puck_tables.motion.bulk import fill_stops

        out = np.empty((len(OUTPUTS), launches.shape[1]))
        status = np.empty(launches.shape[1], np.int8)

        def work(start: int, stop: int) -> None:
            some, part = np.ascontiguousarray(launches[:, start:stop]), out[:, start:stop].copy()
            fill_stops(some, *self.stepping, self.columns, self.section, part, status[start:stop])
            out[:, start:stop] = part

        in_slices(work, launches.shape[1])
        if self.longest > 2.0:
            mark_too_large(out, status, launches, self.longest)
        return out, status


def mark_too_large(out: FloatArray, status: Status, launches: FloatArray, longest: float) -> None:
    """Status 2 and NaN where a motion is too large for floating point."""
    status[~fits(launches, longest)] = _OVERFLOW
    out[:, status != 0] = np.nan


def fits(launches: FloatArray, longest: float = 2.0) -> npt.NDArray[np.bool_]:
    """Whether Q/J, Q²/J and Q²/(J r) of launches (6, n) are within floating point, (n,).

    ``longest``: how many times as large times, places and angles may get.

    Examples
    --------
    >>> fits(np.array([[1.0, 1e200], [0, 0], [0, 0], [0, 0], [1, 1], [1, 1]])).tolist()
    [True, False]
    """
    vx, vy, spin, _, decel, radius = launches
    with np.errstate(over="ignore", invalid="ignore"):
        slip = np.hypot(np.hypot(vx, vy), radius * spin)
        size = longest * slip / decel * slip
        inside: npt.NDArray[np.bool_] = np.isfinite(size / radius + size)
    return inside

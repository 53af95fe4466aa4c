"""Solvers of stops, each for the heights that it is good for: by look-up, or by integration.

A new one is a class here, and its place in :mod:`puck_tables.stopping.per_height`.  Each has a
``method`` and an ``error``, the largest, as promised or measured; ``work``, what determines the
bits besides the launches; and ``all``, the outputs (6, n) and status (n,) of checked launches, with
``threads`` = 1 where others cut the work.

On a base that is not round each launch is integrated.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray, real
from puck_tables._core.executor import in_slices, run_chunks
from puck_tables.accuracy.method_errors import COARSEST, Selection
from puck_tables.accuracy.methods import Method
from puck_tables.contact.base import Base
from puck_tables.kernels.base_friction import packed
from puck_tables.kernels.quadratic import NO_COLUMNS
from puck_tables.motion.base_motion import STATE_SIZE
from puck_tables.motion.base_slides import OUT_ROWS, WHY_INTEGRATED, fill_slides, local_error
from puck_tables.motion.body import UnitPuck
from puck_tables.motion.friction_source import Sections, source_of
from puck_tables.motion.solve import FINEST_LOCAL, ErrorEstimate, Setting, close_enough, refined
from puck_tables.motion.state import LENGTH, PSI, THETA, T, X, Y
from puck_tables.motion.steppers import Stepping
from puck_tables.motion.unit_motion import frame_of, solve, unseen_tail
from puck_tables.stopping.launch_arrays import Launches, fits, in_chunks, launches_in
from puck_tables.stopping.lookup import STOP_POWERS
from puck_tables.stopping.stop_section import StopSection
from puck_tables.stopping.stop_table import StopTable
from puck_tables.stopping.stop_values import OTHERS

_CHUNK = 64  # motions that a thread takes at once
Status = npt.NDArray[np.int8]

OUTPUTS = ("stop_time", "stop_x", "stop_y", *OTHERS)
STATUS_MEANINGS = ("stopped", "step_limit", "overflow")
_PROBES = 40  # launches over all φ, besides those next to lines, on which a setting is tried
_OVERFLOW = STATUS_MEANINGS.index("overflow")


class BaseSolver:
    """Stops of pucks on one base, any launches, heights and radii of gyration.

    ``shape``, ``tol``: the base, and the largest error, of Q/(fg) and Q²/(fg), Q = hypot(v, kω).
    """

    method = "integrated"
    selections: tuple[Selection, ...] = ()
    launch_columns = ("launch_vx", "launch_vy", "launch_spin")
    outputs = tuple(name for name in OUTPUTS if name != "turn_angle")

    def __init__(self, shape: Base, tol: float) -> None:
        self.tol = real("tol", tol, "dimensionless")
        self.local, self._shape = local_error(self.tol), shape
        self._base = packed(shape, 0.0)

    @property
    def explanation(self) -> str:
        """What was taken, and why."""
        return (
            f"Asked: an error of at most {self.tol:.3g} of Q/(f g) (times) and "
            "Q^2/(f g) (places).\n"
            f"Taken: each launch integrated, order 8, steps that err by {self.local:.2g} at most.\n"
            f"{WHY_INTEGRATED}"
        )

    @property
    def source(self) -> str:
        """What the stops come from, in words."""
        return f"friction integrated over base {self._shape.name}"

    @property
    def work(self) -> dict[str, Any]:
        """What determines the bits besides the launches."""
        return {"by": self.method, "base": self._base, "local": self.local}

    def first(self, launches: Launches, threads: int | None) -> First:
        """All of the outputs of checked launches."""
        values, status = self.all(launches.matrix, threads)
        mark = launches.mark() if launches.is_held else 0
        return First(values[0], values[1:3].T, status, mark, values[3:])

    def all(self, launches: FloatArray, threads: int | None = 1) -> tuple[FloatArray, Status]:
        """Outputs (6, n), as of round pucks, and status (n,) of launches (6, n)."""
        count = launches.shape[1]
        none = np.empty(0), np.zeros(count + 1, np.int64)
        out, _, status = followed(self._base, launches, self.local, *none, threads)
        return out[: len(OUTPUTS)], status


def followed(
    base: FloatArray, launches: FloatArray, local: float, moments: FloatArray,
    ends: npt.NDArray[np.int64], threads: int | None,
) -> tuple[FloatArray, FloatArray, Status]:  # fmt: skip
    """What comes out of launches (6, n), their states at moments, and status, shared by threads."""
    count = launches.shape[1]
    out, status = np.empty((OUT_ROWS, count)), np.empty(count, np.int8)
    states = np.empty((moments.size, STATE_SIZE))

    def work(start: int, stop: int) -> None:
        some = np.ascontiguousarray(launches[:, start:stop])
        part = np.empty((OUT_ROWS, stop - start))
        first, last = ends[start], ends[stop]
        own = ends[start : stop + 1] - first
        fill_slides(
            base, some, local, own, moments[first:last], part, states[first:last],
            status[start:stop],
        )  # fmt: skip
        out[:, start:stop] = part

    _shared(work, count, threads)
    return out, states, status


def _shared(work: Callable[[int, int], None], count: int, threads: int | None) -> None:
    """Call ``work(start, stop)`` for chunks of motions; on this thread where others cut them."""
    if threads == 1:
        in_slices(work, count)
    else:
        run_chunks(work, count, _CHUNK, threads)


class First(NamedTuple):
    """Stop times (n,), places (n, 2), status (n,), the mark of their launches, and the rest."""

    time: FloatArray
    place: FloatArray
    status: Status
    mark: int
    rest: FloatArray | None = None


@dataclass(frozen=True)
class LookUp:
    """Stops from a stop table: nothing is integrated.

    Time and place from as coarse a cut of it as is good enough, all outputs from the whole table.
    """

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

    def first(self, launches: Launches, threads: int | None) -> First:
        """Stop times (n,), places (n, 2), status (n,) and the mark of launches."""
        time, place, doubtful, mark = self.table.stops(
            launches, self.powers, self.thinning, threads
        )
        status = np.zeros(time.size, np.int8)
        if doubtful:
            status[~fits(launches.matrix)] = _OVERFLOW
            time[status != 0], place[status != 0] = np.nan, np.nan
        return First(time, place, status, mark)

    def all(self, launches: FloatArray, threads: int | None = 1) -> tuple[FloatArray, Status]:
        """All of the outputs (6, n) and status (n,)."""
        out, doubtful = self.table.filled(len(OUTPUTS), launches_in(launches), threads)
        status = np.zeros(launches.shape[1], np.int8)
        if doubtful:
            mark_too_large(out, status, launches)
        return out, status

    def rest(self, launches: Launches, threads: int | None) -> FloatArray:
        """Path length, turn of heading and of the body (3, n)."""
        return self.table.filled(len(OTHERS), launches, threads)[0]


@dataclass(frozen=True)
class SectionLookUp:
    """Stops of the pucks of one height from a stop section."""

    section: StopSection
    error: float
    method: Method = Method.LOOK_UP

    @property
    def work(self) -> dict[str, Any]:
        """The section."""
        return {"by": self.method, "section": self.section.coefficients}

    def all(self, launches: FloatArray, threads: int | None = 1) -> tuple[FloatArray, Status]:
        """All of the outputs (6, n) and status (n,)."""
        return self._filled(launches.shape[1], lambda a, b: launches[:, a:b], threads)

    def of(self, launches: Launches, threads: int | None) -> tuple[FloatArray, Status]:
        """All outputs (6, n) and status (n,) of checked launches, copied chunk by chunk."""
        return self._filled(launches.size, launches.rows, threads)

    def _filled(
        self, size: int, rows: Callable[[int, int], FloatArray], threads: int | None
    ) -> tuple[FloatArray, Status]:
        from puck_tables.stopping.stop_section import fill_section_stops

        out, status = np.empty((len(OUTPUTS), size)), np.zeros(size, np.int8)
        longest = self.section.body.longest

        def work(start: int, stop: int) -> None:
            some, part = rows(start, stop), out[:, start:stop]
            if fill_section_stops(some, self.section.coefficients, longest, part):
                mark_too_large(part, status[start:stop], some, longest)

        in_chunks(work, size, threads)
        return out, status


@dataclass(frozen=True)
class Integration:
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

    def all(self, launches: FloatArray, threads: int | None = 1) -> tuple[FloatArray, Status]:
        """All of the outputs (6, n) and status (n,)."""
        from puck_tables.motion.bulk_stops import fill_stops

        out = np.empty((len(OUTPUTS), launches.shape[1]))
        status = np.empty(launches.shape[1], np.int8)

        def work(start: int, stop: int) -> None:
            some, part = np.ascontiguousarray(launches[:, start:stop]), out[:, start:stop].copy()
            fill_stops(some, *self.stepping, self.columns, self.section, part, status[start:stop])
            out[:, start:stop] = part

        _shared(work, launches.shape[1], threads)
        if self.longest > 2.0:
            mark_too_large(out, status, launches, self.longest)
        return out, status


def integration_of(body: UnitPuck, tol: float, method: Method | None = None) -> Integration:
    """An integration good for every launch of a puck, tried at both sides of singular lines."""
    source, probes = Sections(body), _probes(body)
    selection = source.selected("stop", tol, method)

    def attempt(setting: Setting) -> tuple[Integration, ErrorEstimate]:
        stepping = setting.stepping
        coefficients = source.friction(setting.accuracy).coefficients
        coarse = source.coarser(setting.accuracy).coefficients
        finer = stepping.finer(2.0, 0.01, FINEST_LOCAL)
        result, by_finer, by_coarse = (
            Integration(NO_COLUMNS, *how, selection.method, longest=body.longest)
            for how in ((coefficients, stepping), (coefficients, finer), (coarse, stepping))
        )
        answer = result.all(probes)[0][:3]
        steps, friction = (
            2.0 * float(np.abs(answer - other.all(probes)[0][:3]).max())
            for other in (by_finer, by_coarse)
        )
        return result, ErrorEstimate(steps + 2.0 * unseen_tail(stepping), friction / 8.0)

    finer = partial(refined, tol=tol, friction=source.next_accuracy)
    result, error, _ = close_enough(source.first(selection), attempt, finer, tol, "these pucks")
    return replace(result, error=error.total)


def _probes(body: UnitPuck) -> FloatArray:
    """Launches (6, n) with Q = J = r = 1: anywhere, and next to all lines and both ends."""
    lines = np.array([0.0, *body.friction(COARSEST).lines, 0.5 * np.pi])
    near = (lines[:, None] + np.outer([-1.0, 1.0], 10.0 ** -np.arange(1.0, 8.0)).ravel()).ravel()
    phi = np.concatenate([np.linspace(0.01, 1.56, _PROBES), near])
    phi = phi[(phi > 0.0) & (phi < 0.5 * np.pi)]
    one = np.ones(phi.size)
    return np.stack([np.cos(phi), 0.0 * one, np.sin(phi), body.delta * one, one, one])


@dataclass
class EachAlone:
    """Stops of few launches of one height, each integrated as finely as it needs itself.

    So a first question waits for no measurement of what other launches would need.
    ``tol``: of each; ``error``: the largest of those that were answered.
    """

    body: UnitPuck
    tol: float
    method: Method
    error: float = 0.0

    @property
    def work(self) -> dict[str, Any]:
        """The tolerance: each launch has its own setting."""
        return {"by": self.method, "tol": self.tol}

    def all(self, launches: FloatArray, threads: int | None = 1) -> tuple[FloatArray, Status]:
        """All of the outputs (6, n) and status (n,)."""
        out, status = np.zeros((len(OUTPUTS), launches.shape[1])), np.zeros(launches.shape[1], "i1")
        source = source_of(self.body)
        mark_too_large(out, status, launches, self.body.longest)
        for n in np.flatnonzero(status == 0):
            vx, vy, spin, _, decel, radius = launches[:, n].tolist()
            frame = frame_of((vx, vy), spin, decel, radius)
            if frame.slip == 0.0:
                continue
            run, _ = solve(source, frame.speed, frame.rim, self.tol, self.method)
            stop = run.stop
            out[0, n] = stop[T] * frame.time
            out[1:3, n] = frame.place(stop[X], stop[Y])
            out[3, n] = stop[LENGTH] * frame.length
            out[4, n] = frame.side * stop[PSI]
            out[5, n] = frame.side * stop[THETA] * (frame.length / frame.radius)
            self.error = max(self.error, run.error)
        return out, status


StopSolver = LookUp | SectionLookUp | Integration | EachAlone


def mark_too_large(
    out: FloatArray, status: Status, launches: FloatArray, longest: float = 2.0
) -> None:
    """Status 2 and NaN where a motion is too large for floating point."""
    status[~fits(launches, longest)] = _OVERFLOW
    out[:, status != 0] = np.nan

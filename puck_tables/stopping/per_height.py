"""For each height the solver of stops that fits it.

Plain pucks are looked up in the stop table that comes along, or integrated where it is not exact
enough.  Every other height needs preparation: a stop section where its launches are many, a setting
of the integrator that was tried where they are few.  All is made before the first launch is
answered and depends on the kind of puck alone, so that the numbers do not depend on how the work is
cut.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray, real
from puck_tables._core.executor import run_chunks
from puck_tables._core.waiting import Progress
from puck_tables.accuracy.method_errors import COARSEST, UNITS, Selection, select
from puck_tables.accuracy.methods import (
    INTEGRATED,
    LOOK_UP,
    FrictionForm,
    Method,
    Scheme,
    method_named,
)
from puck_tables.contact.closed_form import checked_delta
from puck_tables.contact.laws import Law, law_of
from puck_tables.errors import AccuracyError, InputError
from puck_tables.kernels.quadratic import NO_COLUMNS, NO_SECTION
from puck_tables.motion.body import UnitPuck, body_of, plain_up_to
from puck_tables.motion.friction_source import Sections, integration_selected
from puck_tables.motion.steppers import stepping_of
from puck_tables.stopping.launch_arrays import Launches, launches_in
from puck_tables.stopping.solvers import (
    OUTPUTS,
    EachAlone,
    First,
    Integration,
    LookUp,
    SectionLookUp,
    Status,
    StopSolver,
    integration_of,
)
from puck_tables.stopping.stop_section import FINEST_SECTION, stop_section_for
from puck_tables.stopping.stop_table import StopTable
from puck_tables.stopping.stop_values import UPPER_DELTA
from puck_tables.table.resultant_table import ResultantTable
from puck_tables.table.table import refuse_other_kind

AnyTable = ResultantTable | StopTable | None

ALONE = 32  # launches of one height up to which each is tried itself
MANY = 300  # launches of one height from which on a stop section costs less than integrating them
MOST_HEIGHTS = 500  # each takes about a second to prepare
HEIGHT_COST = 2000  # launches that take as long as the preparation of a height


class SolverPerHeight:
    """Stops of the pucks of one pressure law and radius of gyration, of any heights.

    ``pressure``, ``gyration``, ``tol``, ``method``, ``table``: as :func:`puck_tables.stop` takes
    them.

    >>> solver = SolverPerHeight("uniform", 0.5**0.5, 1e-6, None, None)
    >>> solver.prepare(np.array([0.5, 1.0, 1.5]))
    >>> solver.method
    'look-up and integrated'
    """

    launch_columns = ("launch_vx", "launch_vy", "launch_spin", "delta")
    outputs = OUTPUTS

    def __init__(
        self, pressure: str | Law, gyration: float, tol: float, method: str | None, table: AnyTable
    ) -> None:
        self.tol = real("tol", tol, "dimensionless")
        refuse_other_kind(table, ResultantTable, StopTable)
        self._wanted = method_named(method)
        self._pressure, self._gyration, self._table = pressure, gyration, table
        self._plain_up_to = plain_up_to(pressure, gyration)
        self._law_table: ResultantTable | None = None
        if table is not None and self._plain_up_to > 0.0:
            self._plain_up_to = math.inf  # it refuses itself what it does not hold
        elif table is not None and isinstance(table, StopTable):
            raise InputError(
                "tables of stops are of a homogeneous puck under uniform pressure: leave out "
                "table, or pressure and gyration"
            )
        else:
            self._law_table = table
        self._plain: StopSolver | None = None
        self._plain_selection: Selection | None = None
        self._plain_source = ""
        self._sections: dict[float, StopSolver] = {}
        self._launches = 0, 0  # of plain heights, of others

    def checked_range(self, delta: npt.ArrayLike) -> FloatArray:
        """``delta`` as an array, refused where the friction is not known."""
        if self._table is not None and self._law_table is None:
            return self._table.checked_range(delta)
        height = checked_delta(delta)
        if height.size and height.max() > self._plain_up_to:
            self._body(float(height.max()))
        return height

    def prepare(
        self, delta: FloatArray, each: npt.ArrayLike = 1, threads: int | None = None,
        progress: Progress | None = None, alone: int = 0,
    ) -> None:  # fmt: skip
        """Make what launches of heights ``delta`` (n,) need, of each of them so many.

        Up to ``alone`` of one height are each tried themselves: for what is asked once, not in
        blocks.
        """
        all_plain = not delta.size or float(delta.max()) <= self._plain_up_to
        others = delta[:0] if all_plain else delta[delta > self._plain_up_to]
        launches = np.broadcast_to(np.asarray(each, np.int64), delta.shape)
        many = launches[:0] if all_plain else launches[delta > self._plain_up_to]
        self._launches = int(launches.sum()) - int(many.sum()), int(many.sum())
        if others.size < delta.size or not delta.size:
            self._prepare_plain()
        if not others.size:
            return
        if self._wanted is Method.LOOK_UP and self.tol < FINEST_SECTION:
            raise AccuracyError(
                f"tol must be from {FINEST_SECTION:g} on for look-up of such pucks, got "
                f"{self.tol:g}: give a tol in that range, or another method"
            )
        heights, which = np.unique(others, return_inverse=True)
        counts = np.zeros(heights.size, np.int64)
        np.add.at(counts, which, many)
        refuse_many(heights)
        law = self._pressure if isinstance(self._pressure, Law) else law_of(self._pressure)

        def work(start: int, stop: int) -> None:
            for height, count in zip(heights[start:stop], counts[start:stop], strict=True):
                body = body_of(law, float(height), self._gyration).with_table(self._law_table)
                self._sections[body.delta] = self._made(body, int(count), alone)

        run_chunks(work, heights.size, 1, threads, progress)

    def kinds(self, delta: FloatArray) -> tuple[npt.NDArray[np.bool_], dict[float, UnitPuck]]:
        """Which of the heights ``delta`` (n,) are plain, and the pucks of the others."""
        plain = delta <= self._plain_up_to
        return plain, {height: self._body(height) for height in np.unique(delta[~plain]).tolist()}

    def needs_preparation(self, delta: FloatArray) -> npt.NDArray[np.bool_]:
        """Which heights are not plain, (n,)."""
        return delta > self._plain_up_to

    def _body(self, delta: float) -> UnitPuck:
        return body_of(self._pressure, delta, self._gyration).with_table(self._law_table)

    def _prepare_plain(self) -> None:
        table, wanted = self._table, self._wanted
        if table is not None and isinstance(table, StopTable):
            if wanted not in (None, Method.LOOK_UP):
                raise InputError(f"method {wanted} needs a table of resultants, not of stops")
            if not table.tolerance <= self.tol <= COARSEST:
                raise AccuracyError(
                    f"tol must be from {table.tolerance:.1g} (that of the stop table) to "
                    f"{COARSEST:g}, got {self.tol:g}: give a tol in that range; a finer table "
                    "comes from 'puck build-tables --kind stops --accuracy A' with A down to 1e-11"
                )
            self._plain, self._plain_source = LookUp(table, error=table.tolerance), table.source
            return
        if table is not None and wanted is Method.LOOK_UP:
            raise InputError("method look-up needs a table of stops, not of resultants")
        if table is None and wanted in (None, Method.LOOK_UP):
            schemes = (LOOK_UP,) if wanted is Method.LOOK_UP else (LOOK_UP, *INTEGRATED)
            selection = select("stop", self.tol, schemes)
        else:
            selection = integration_selected("stop", self.tol, wanted, table)
        self._plain_selection = selection
        if selection.method is Method.LOOK_UP:
            self._plain, self._plain_source = _shipped_look_up(selection)
            return
        columns = NO_COLUMNS
        self._plain_source = FrictionForm.CLOSED_FORMS
        if table is not None or selection.scheme.source is FrictionForm.TABLE:
            resultants = table or ResultantTable.shipped()
            columns, self._plain_source = resultants.columns, resultants.source
        stepping = stepping_of(selection)
        self._plain = Integration(columns, NO_SECTION, stepping, selection.method, selection.error)

    def _made(self, body: UnitPuck, launches: int, alone: int) -> StopSolver:
        """A solver for the launches of one height that is not plain."""
        look_up = self._wanted is Method.LOOK_UP
        if look_up or (not self._wanted and launches >= MANY and self.tol >= FINEST_SECTION):
            try:
                section = stop_section_for(body, self.tol)
                return SectionLookUp(section, section.error)
            except AccuracyError:  # functions too steep for a spline: not so for the integrator
                if look_up:
                    raise
        if launches <= alone:
            taken = Sections(body).selected("trajectory", self.tol, self._wanted)
            return EachAlone(body, self.tol, taken.method)
        return integration_of(body, self.tol, self._wanted)

    def prepare_for(self, launches: Launches, threads: int | None) -> None:
        """Make what launches need, whose heights are refused where the friction is not known."""
        delta = launches.delta
        bound = -math.inf
        if self._table is None:
            bound = self._plain_up_to
        elif isinstance(self._table, StopTable):
            bound = UPPER_DELTA
        if launches.tallest <= bound:
            self._launches = launches.size, 0
            self._prepare_plain()
            return
        launches.refuse_bad()
        self.checked_range(delta)
        self.prepare(delta, launches.size // max(delta.size, 1), threads, alone=ALONE)

    def first(self, launches: Launches, threads: int | None) -> First:
        """Stop times, places, status and mark of launches, and the rest if it costs no more."""
        if not self._sections and type(self._plain) is LookUp:
            return self._plain.first(launches, threads)
        if not self._sections:  # else it was looked at for them
            launches.refuse_bad()
        only = next(iter(self._sections.values())) if len(self._sections) == 1 else None
        if self._plain is None and isinstance(only, SectionLookUp):
            values, status = only.of(launches, threads)
        else:
            rows = launches.matrix
            values, status = self.all(rows, threads)
            plain = rows[3] <= self._plain_up_to
            if isinstance(self._plain, LookUp) and plain.any():  # the same bits beside any others
                some = self._plain.first(launches_in(rows[:, plain]), threads)
                values[0, plain], values[1:3, plain] = some.time, some.place.T
        mark = launches.mark() if launches.is_held else 0
        return First(values[0], values[1:3].T, status, mark, values[3:])

    def rest(self, launches: Launches, threads: int | None) -> FloatArray:
        """The rest of the outputs (3, n) of launches whose first did not come with it."""
        assert isinstance(self._plain, LookUp)
        return self._plain.rest(launches, threads)

    def all(self, launches: FloatArray, threads: int | None = 1) -> tuple[FloatArray, Status]:
        """All of the outputs of a stop (6, n) and status (n,) of launches (6, n)."""
        if not self._sections and self._plain is not None:
            return self._plain.all(launches, threads)
        plain = launches[3] <= self._plain_up_to
        if len(self._sections) == 1 and not plain.any():
            return next(iter(self._sections.values())).all(launches, threads)
        out = np.empty((len(OUTPUTS), launches.shape[1]))
        status = np.empty(launches.shape[1], np.int8)
        order = np.argsort(np.where(plain, -1.0, launches[3]), kind="stable")
        heights = launches[3, order]
        ends = [int(plain.sum())]
        for height in sorted(self._sections):
            ends.append(ends[-1] + int(np.searchsorted(heights[ends[-1] :], height, side="right")))
        solvers = [self._plain, *(self._sections[height] for height in sorted(self._sections))]
        for solver, start, stop in zip(solvers, [0, *ends], ends, strict=False):
            mine = order[start:stop]
            if solver is not None and mine.size:
                out[:, mine], status[mine] = solver.all(launches[:, mine], threads)
        return out, status

    @property
    def _all(self) -> list[StopSolver]:
        plain = [] if self._plain is None else [self._plain]
        return [*plain, *self._sections.values()]

    @property
    def method(self) -> str:
        """'look-up', 'integrated' or both."""
        looked = {solver.method is Method.LOOK_UP for solver in self._all}
        names = ((True, Method.LOOK_UP.value), (False, "integrated"))
        return " and ".join(name for one, name in names if one in looked)

    @property
    def source(self) -> str:
        """What the stops come from, in words."""
        sources = [self._plain_source] if self._plain is not None else []
        if self._sections:
            of = "" if self._law_table is None else f" of {self._law_table.source}"
            body = self._body(next(iter(self._sections)))
            sources.append(f"sections{of} of pressure {body.law.name}, k/r = {body.gyration:g}")
        return "; ".join(sources)

    @property
    def work(self) -> dict[str, Any]:
        """What determines the bits besides the launches."""
        plain = {} if self._plain is None else {"plain": self._plain.work}
        others = {repr(height): self._sections[height].work for height in sorted(self._sections)}
        return {"asked": self._wanted or "any", **plain, **others}

    @property
    def selections(self) -> tuple[Selection, ...]:
        """What was selected for the tolerance: for plain heights, and for the others."""
        result = [] if self._plain_selection is None else [self._plain_selection]
        for looked in (True, False):
            solvers = [
                one for one in self._sections.values() if (one.method is Method.LOOK_UP) == looked
            ]
            if solvers:
                result.append(self._of_sections(solvers))
        return tuple(result)

    def _of_sections(self, solvers: list[StopSolver]) -> Selection:
        """What was selected for heights that are not plain, and their largest error."""
        error = max(solver.error for solver in solvers)
        scheme = Scheme(solvers[0].method, FrictionForm.SECTION)
        what = "height" if len(solvers) == 1 else "heights"
        few_or_many = f"less than {MANY}"
        if scheme.method is Method.LOOK_UP:
            few_or_many = f"{MANY} or more"
        why = "" if self._wanted else f", with {few_or_many} launches each"
        explanation = (
            f"Asked: an error of at most {self.tol:.3g} {UNITS}.\n"
            f"Taken: {scheme.name}, for {len(solvers)} {what}{why}.\n"
            f"It errs by {error:.2g} at the worst, measured against integration of higher accuracy."
        )
        return Selection(scheme, "", error, self.tol, explanation)

    @property
    def explanation(self) -> str:
        """What was taken for how many launches, and why."""
        texts = [selection.explanation for selection in self.selections]
        if self._plain is not None and self._plain_selection is None:
            texts.insert(0, "looked up in the stop table given")
        plain, others = self._launches
        if not (plain and others):
            return "\n".join(texts)
        words = [
            f"{plain} of {plain + others} launches, of heights delta <= {self._plain_up_to:g}:",
            f"{others} of {plain + others} launches, of heights above:",
        ]
        return "\n".join([words[0], texts[0], words[1], *texts[1:]])


@lru_cache(maxsize=64)
def _shipped_look_up(selection: Selection) -> tuple[LookUp, str]:
    """The look-up that was selected, from the stop table that comes along; and its name."""
    shipped = StopTable.shipped()
    powers, thinning = int(selection.number("powers")), int(selection.number("thinning"))
    return LookUp(shipped, powers, thinning, selection.error), shipped.source


def refuse_many(heights: FloatArray) -> None:
    """Refuse more different heights than can be prepared."""
    if heights.size > MOST_HEIGHTS:
        raise InputError(
            f"{heights.size} different delta are too many for such pucks, each takes about a "
            f"second to prepare: give at most {MOST_HEIGHTS}"
        )

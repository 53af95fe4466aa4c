"""Where a motion at one height has its friction from: closed forms, a table, or a section.

A source gives friction as the integrator reads it, and knows what it adds to the error of a motion.
Which a puck has is asked once, in :func:`source_of`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property, lru_cache

import numpy as np

from puck_tables._core.arrays import FloatArray, rounded_up
from puck_tables.accuracy.method_errors import COARSEST, UNITS, Selection, named, select
from puck_tables.accuracy.methods import INTEGRATORS, FrictionForm, Method, Scheme, schemes_of
from puck_tables.contact.closed_form import CONTACT_SLACK, by_closed_form, pressure_tilt
from puck_tables.contact.integrals import SlipDirection
from puck_tables.errors import AccuracyError, InputError
from puck_tables.kernels.closed_form_kernel import outside_full_contact
from puck_tables.kernels.quadratic import NO_SECTION
from puck_tables.motion.body import UnitPuck
from puck_tables.motion.limits import LIMIT_WIDTH, limit_log_ratio
from puck_tables.motion.solve import ErrorEstimate, Setting
from puck_tables.motion.steppers import stepping_of
from puck_tables.table.friction_section import FINEST_ACCURACY
from puck_tables.table.resultant_table import ResultantTable

FINEST_TOL = 1e-11  # of a motion whose friction is a section
TABLE_FACTOR = 5.0  # an error of the friction enters a stop at most so many times
# Looser, a step of a very tall puck leaps over the bend below φ = π/4, and no estimate sees it.
LOOSEST_LOCAL = 1e-7
_ROUNDING = 1e-15  # of Q/J: of elementary functions
_FROM_FRICTION = 20.0  # tol that surely goes with an error of the friction
_SECTION_WIDTH = 1e-12  # of u: nearer to the limit angle a section cannot tell
_HIGHEST_CLOSED = 2.0  # δ: from there on some of the base lifts in every motion but pure spin


@dataclass(frozen=True)
class Friction:
    """Friction at one δ for :mod:`puck_tables.motion.equations_of_motion`; its error."""

    source: FrictionForm
    delta: float
    coefficients: FloatArray = field(repr=False)
    error: float


def closed_form_friction(delta: float) -> Friction:
    """Friction by the closed forms.

    >>> closed_form_friction(0.5).error
    0.0
    """
    return Friction(FrictionForm.CLOSED_FORMS, delta, NO_SECTION, 0.0)


def table_friction(delta: float, table: ResultantTable) -> Friction:
    """Friction by a table of uniform pressure.

    Raises InputError if δ is outside its range, or it is of another pressure law.

    >>> table_friction(0.5, ResultantTable.shipped()).error
    2e-11
    """
    return Friction(FrictionForm.TABLE, delta, table.section(delta), table.tolerance)


@lru_cache(maxsize=64)
def section_friction(body: UnitPuck, accuracy: float, coarser: bool = False) -> Friction:
    """Friction by a section; ``coarser``: of half as many cells, to see what the spline adds.

    Raises AccuracyError if its pressure law is too rough for it; it says which ``tol`` is not.

    >>> from puck_tables.motion.body import body_of
    >>> section_friction(body_of("ring", 0.5, 1.0), 1e-6).error <= 1e-6
    True
    """
    try:
        friction = body.friction(accuracy)
    except AccuracyError as error:
        if error.reachable is None:
            raise
        finest = rounded_up(_FROM_FRICTION * error.reachable)
        raise AccuracyError(
            f"an error of {accuracy:.1g} of the friction is out of reach under the pressure law "
            f"{body.law.name}: give tol (--tol) of {finest:g} or more"
        ) from None
    coefficients = friction.for_motion(body.gyration, coarser)
    return Friction(FrictionForm.SECTION, body.delta, coefficients, friction.error)


@dataclass(frozen=True)
class FullContact:
    """Closed forms, or a table where that is cheaper: a plain puck.

    ``delta``: dimensionless height 2fh/r; ``table``: one's own instead of the shipped one and
    closed forms; ``exact``: closed forms only.
    """

    delta: float
    table: ResultantTable | None = None
    exact: bool = False
    limit_width = LIMIT_WIDTH  # of ln(rω/v): a start so close to the limit is the limit motion
    is_measured = True  # whether the measured front is of such friction

    @cached_property
    def limit(self) -> float:
        """Ln of the ratio rω/v that motions tend to."""
        return limit_log_ratio(self.delta)

    def selected(self, question: str, tol: float, method: Method | None) -> Selection:
        """The cheapest that was measured to be within the tolerance."""
        return integration_selected(question, tol, method, self.table, self.exact)

    def first(self, selection: Selection) -> Setting:
        """The setting that was selected: its accuracy is 0 with closed forms, else the table's."""
        exact = self.exact or selection.scheme.source is FrictionForm.CLOSED_FORMS
        accuracy = 0.0 if exact else ResultantTable.shipped().tolerance
        if self.table is not None:
            accuracy = self.table.tolerance
        return Setting(stepping_of(selection), accuracy)

    def explained(self, selection: Selection, setting: Setting, error: ErrorEstimate) -> Selection:
        """More than what was selected."""
        source = FrictionForm.TABLE if setting.accuracy else FrictionForm.CLOSED_FORMS
        scheme = Scheme(selection.method, source)
        more = f"This motion needed more: {named(scheme.name, setting.words)}."
        return Selection(
            scheme, setting.words, error.total, selection.tol, f"{selection.explanation}\n{more}"
        )

    def next_accuracy(self, accuracy: float) -> float | None:
        """Closed forms after the shipped table."""
        return 0.0 if accuracy > 0.0 and self.table is None else None

    def friction(self, accuracy: float) -> Friction:
        """Closed forms, or a table at this height."""
        if accuracy == 0.0:
            return closed_form_friction(self.delta)
        return table_friction(self.delta, self.table or ResultantTable.shipped())

    def coarser(self, accuracy: float) -> Friction | None:
        """None: its error is known."""
        return None

    def refuse(self, least_log_ratio: float) -> None:
        """Above δ = 1 the linear law of pressure holds state by state: refuse where it does not.

        Raises ContactError.
        """
        u = least_log_ratio
        if self.delta <= 1.0:
            return
        direction = SlipDirection(np.asarray(math.exp(-abs(u))), np.asarray(u > 0.0))
        phi = math.atan(math.exp(min(u, 700.0)))
        tilt = pressure_tilt(by_closed_form(phi, self.delta), direction, self.delta)
        if not tilt <= 1.0 + CONTACT_SLACK:
            raise outside_full_contact(phi, self.delta)

    def at_constant_angle(self, tol: float) -> tuple[Friction, float, float]:
        """Closed forms."""
        return closed_form_friction(self.delta), 2.0 * LIMIT_WIDTH, _ROUNDING


@dataclass(frozen=True)
class Sections:
    """The section of a table at the height of a puck, made for it and as fine as it needs."""

    body: UnitPuck
    limit_width = _SECTION_WIDTH  # its truth is good to 1e-13
    is_measured = False

    @property
    def limit(self) -> float:
        """Ln of the ratio rω/v that motions tend to."""
        return self.body.limit

    def selected(self, question: str, tol: float, method: Method | None) -> Selection:
        """What is good with closed forms for δ ≤ 1: where to begin."""
        if not FINEST_TOL <= tol <= COARSEST:
            raise AccuracyError(
                f"tol must be from {FINEST_TOL:g} to {COARSEST:g} for a puck under another "
                "pressure law, with another radius of gyration or delta above 1, got "
                f"{tol:g}"
            )
        schemes = schemes_of([method or Method.ADAPTIVE], [FrictionForm.CLOSED_FORMS])
        return select(question, tol, schemes)

    def first(self, selection: Selection) -> Setting:
        """The setting that was selected, with friction to half of the tolerance."""
        accuracy = max(0.5 * selection.tol, FINEST_ACCURACY)
        return Setting(stepping_of(selection, LOOSEST_LOCAL), accuracy)

    def explained(self, selection: Selection, setting: Setting, error: ErrorEstimate) -> Selection:
        """The setting in the end, and what was measured."""
        scheme = Scheme(selection.method, FrictionForm.SECTION)
        spline = self.body.friction(setting.accuracy).spline
        explanation = (
            f"Asked: an error of at most {selection.tol:.3g} {UNITS}.\n"
            f"Taken: {named(scheme.name, setting.words)}.\n"
            f"Its friction is a section of {len(spline.sides)} sides with {spline.cells} cells "
            f"each, whose ratios err by {float(spline.error.max()):.2g}, measured against the law "
            "itself.\n"
            f"It errs by {error.total:.2g}, measured by finer steps and by half the cells."
        )
        return Selection(scheme, setting.words, error.total, selection.tol, explanation)

    def next_accuracy(self, accuracy: float) -> float | None:
        """A tenth."""
        return max(0.1 * accuracy, FINEST_ACCURACY) if accuracy > FINEST_ACCURACY else None

    def friction(self, accuracy: float) -> Friction:
        """A section so fine."""
        return section_friction(self.body, accuracy)

    def coarser(self, accuracy: float) -> Friction:
        """Of half as many cells."""
        return section_friction(self.body, accuracy, coarser=True)

    def refuse(self, least_log_ratio: float) -> None:
        """Nothing: it holds for every motion."""

    def at_constant_angle(self, tol: float) -> tuple[Friction, float, float]:
        """A section, whose error shows at the limit angle."""
        friction = self.friction(max(0.5 * tol, FINEST_ACCURACY))
        at_limit = 4.0 * friction.error * max(1.0, 0.5 / self.body.inertia)
        return friction, at_limit, 10.0 * _ROUNDING


FrictionSource = FullContact | Sections


def source_of(
    body: UnitPuck, table: ResultantTable | None = None, exact: bool = False
) -> FrictionSource:
    """Where the friction of a puck comes from.

    ``table``: of resultants under its pressure law, instead of the shipped one or the law itself;
    ``exact``: closed forms only.  Raises InputError if the puck has no closed forms, or is outside
    the range of the table.

    >>> from puck_tables.motion.body import body_of
    >>> type(source_of(body_of("ring", 0.5, 1.0))).__name__
    'Sections'
    """
    if not body.has_closed_forms:
        if exact:
            raise InputError(
                "closed forms are for a homogeneous puck under uniform pressure: leave out exact, "
                "or pressure and gyration"
            )
        return Sections(body)
    if exact and not body.delta < _HIGHEST_CLOSED:
        raise InputError(
            f"delta = 2 f h / r must be from 0 to below {_HIGHEST_CLOSED:g} with closed forms, got "
            f"{body.delta:g}: the linear pressure law of full contact holds at every phi up to 1, "
            "and beyond 2 in no motion but pure spin"
        )
    if table is not None:
        table.checked_range(body.delta)
    if table is None and not exact and not body.is_plain:
        return Sections(body)
    return FullContact(body.delta, table, exact)


def integration_selected(
    question: str, tol: float, method: Method | None, table: ResultantTable | None,
    exact: bool = False,
) -> Selection:  # fmt: skip
    """The cheapest integration of plain pucks to a tolerance.

    With a table of one's own the error is that of the integrator with closed forms, and what the
    table adds: at most five times its own error.

    >>> integration_selected("trajectory", 1e-9, Method.RK4, None).scheme.name
    'rk4, table'
    """
    own = None if table is None else (table.source, TABLE_FACTOR * table.tolerance)
    return _selected(question, tol, method, own, exact or table is not None)


@lru_cache(maxsize=256)
def _selected(
    question: str, tol: float, method: Method | None, own: tuple[str, float] | None, exact: bool
) -> Selection:
    sources = (
        (FrictionForm.CLOSED_FORMS,) if exact else (FrictionForm.TABLE, FrictionForm.CLOSED_FORMS)
    )
    methods = INTEGRATORS if method is None else (method,)
    return select(question, tol, schemes_of(methods, sources), own)

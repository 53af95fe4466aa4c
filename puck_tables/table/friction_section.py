"""Friction of one puck: its three friction ratios over the slip angle, straight from truth.

For a pressure law and a height δ the ratios 1/ρ_∥, ρ_⊥/ρ_∥, ρ_ω/ρ_∥ are functions of φ alone,
analytic between a few lines (:mod:`puck_tables.table.singular_lines`).

Derivatives of motions need the ratios' derivatives by δ at the same φ besides.  In full contact the
ratios are polynomials of degree 2 in δ; in partial contact the balance of moments is differentiated
(:func:`puck_tables.contact.one_sided.height_slopes`).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from typing import Any, ClassVar

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables._core.waiting import Progress
from puck_tables.contact import one_sided
from puck_tables.contact.closed_form import Resultants, checked_delta
from puck_tables.contact.laws import HOMOGENEOUS, Law, law_of
from puck_tables.contact.one_sided import critical_delta
from puck_tables.errors import AccuracyError, InputError
from puck_tables.kernels.quadratic import LINE, RATIOS, SLOPES
from puck_tables.table.build import COARSEST, checked_accuracy
from puck_tables.table.check import Accuracy, CheckReport
from puck_tables.table.law_record import is_named
from puck_tables.table.resultant_table import ResultantTable
from puck_tables.table.section_table import SectionTable
from puck_tables.table.singular_lines import lines_of, opening_angle, refuse_height, tall_resultants
from puck_tables.table.slip_spline import GRADING_POWER, LawAxis, SlipSpline, sides_of, slip_spline
from puck_tables.table.spline_fit import height_terms, ratios_at
from puck_tables.table.table_store import fetch

RATES_ACCURACY = 1e-9  # motions differentiated with it err by at most 1e-8
DEFAULT_ACCURACY, FINEST_ACCURACY = 1e-9, 5e-13  # truth itself is good to 1e-13
_NODE_ERROR = 1e-10  # how well the law is known at a node
AT_THE_LIMIT = 1e-6  # relative: so close to it, a section says that motions tend there
_FULL_CONTACT = 1.0  # δ up to which the whole base is loaded in every motion


@dataclass(frozen=True, eq=False)
class FrictionSlopes:
    """The friction ratios of a puck, then their derivatives by δ, as a spline over φ.

    ``spline``: six functions; ``delta``: the height; ``error``: the largest, of the ratios.
    """

    spline: SlipSpline = field(repr=False)
    delta: float
    error: float

    def for_motion(self, gyration: float) -> FloatArray:
        """What compiled motions read: the ratios alone, as a friction section gives them."""
        ratios = SlipSpline(self.spline.sides, self.spline.values[..., :RATIOS], True)
        return motion_coefficients(ratios, gyration)

    def for_slopes(self, gyration: float) -> FloatArray:
        """What their derivatives read: all six."""
        square, factors = inertia_of(gyration)
        return self.spline.with_inertia(square, np.tile(factors, SLOPES // RATIOS))


@lru_cache(maxsize=64)
def friction_slopes_of(law: Law, delta: float, accuracy: float = RATES_ACCURACY) -> FrictionSlopes:
    """Tabulate the friction of one puck with its derivatives by the height.

    ``delta``: dimensionless height 2fh/r; ``accuracy``: the largest error of a friction ratio.

    >>> from puck_tables.contact.laws import law_of
    >>> found = friction_slopes_of(law_of("ring"), 1.0, 1e-6)
    >>> (found.spline.at(np.array([0.0]))[0].round(6) + 0.0).tolist()  # 1, δ/4, 1 − δ²/8 …
    [1.0, 0.25, 0.875, 0.0, 0.25, -0.25]
    """
    sides = sides_of(lines_of(law, delta)[::-1])
    spline = slip_spline(lambda phi: slopes_at(law, phi, delta), sides, accuracy, even=True)
    return FrictionSlopes(spline, delta, float(spline.error[:RATIOS].max()))


def slopes_of_table(table: ResultantTable, delta: float) -> FrictionSlopes:
    """Friction with its derivatives by the height, from a table of resultants.

    >>> found = slopes_of_table(ResultantTable.build("ring", 1e-6), 1.0)
    >>> (found.spline.at(np.array([0.0]))[0].round(5) + 0.0).tolist()
    [1.0, 0.25, 0.875, 0.0, 0.25, -0.25]
    """
    values, error = ratios_of_table(table, delta)
    sides, by_side = table.axis.sides, table.axis.by_side(values)
    return FrictionSlopes(SlipSpline(sides, by_side, True), delta, error)


def slopes_at_one_height(section: FrictionSection) -> FrictionSlopes:
    """Friction from a section, for who asks nothing about other heights: slopes by δ are 0."""
    spline = section.spline
    values = np.concatenate([spline.values, np.zeros_like(spline.values)], axis=2)
    return FrictionSlopes(SlipSpline(spline.sides, values, True), section.delta, section.error)


def slopes_at(law: Law, phi: FloatArray, delta: float) -> FloatArray:
    """The friction ratios at slip angles (n,) by the law, then their derivatives by δ, (n, 6)."""
    ends = np.array([0.0, law.delta_max])
    rho = np.stack(law.resultants(phi[:, None], ends), axis=-1)
    out = ratios_at(height_terms(rho, ends), delta)
    if law.can_lift:
        opened = critical_delta(phi) < delta
        if opened.any():
            some = phi[opened], np.full(int(opened.sum()), delta)
            values, by_height = one_sided.height_slopes(*some)
            along, across, spin = values
            by_along, by_across, by_spin = by_height
            inverse = 1.0 / along
            ratios = np.stack([inverse, across * inverse, spin * inverse], axis=-1)
            by = np.stack([-inverse * by_along, by_across, by_spin], axis=-1)
            by[:, 1:] -= ratios[:, 1:] * by_along[:, None]
            out[opened] = np.concatenate([ratios, by * inverse[:, None]], axis=-1)
    return out


@dataclass(frozen=True, eq=False, repr=False)
class FrictionSection(SectionTable):
    """The friction ratios of a puck over its slip angle.

    ``values`` (nodes of φ, 3): 1/ρ_∥, ρ_⊥/ρ_∥, ρ_ω/ρ_∥.
    """

    kind = "friction section"
    algorithm = "one-sided balance by quadrature, or integrals of the law; 1"
    functions: ClassVar[Mapping[str, str]] = {
        "inverse_parallel": "1/rho_parallel",
        "perpendicular_share": "rho_perpendicular/rho_parallel",
        "spin_share": "rho_omega/rho_parallel",
    }
    quantities = tuple(functions)
    words: ClassVar[Mapping[str, str]] = {
        "title": "Friction of one sliding, spinning puck",
        "interpretation": (
            "Ratios of the friction resultants rho of a puck under the named pressure law, at one "
            "height delta = 2 f h / r, over phi = atan2(r omega, v): force on the puck "
            "-f N cos(phi) rho_parallel along its velocity, -f N sin(phi) cos(phi) "
            "rho_perpendicular across it (to the left), torque -(f N r / 2) sin(phi) rho_omega. "
            "Even in phi. Where part of the base lifts the pressure is max(0, a + b x + c y). "
            "Salnikova, Treschev, Gallyamov 2012, section 6."
        ),
        "method": "balance of moments by quadrature, 1e-13",
        "phi_map": f"two sides for each line: tan(phi - line) = extent xi^{GRADING_POWER}",
    }

    @cached_property
    def opening(self) -> float:
        """The slip angle up to which part of the base is lifted, radians; 0 where none ever is."""
        return opening_angle(self.delta) if self.law.can_lift else 0.0

    @property
    def error(self) -> float:
        """The largest error of a ratio, measured."""
        return float(self.spline.error.max())

    @property
    def lines(self) -> tuple[float, ...]:
        """The singular lines, radians, ascending."""
        return tuple(side.line for side in self.spline.sides[::2])

    @cached_property
    def coefficients(self) -> FloatArray:
        """What compiled code reads: the pure ratios, for no motion in particular."""
        return self.spline.with_inertia(0.5, np.ones(3))

    def for_motion(self, gyration: float, coarser: bool = False) -> FloatArray:
        """Coefficients for the motion of a puck with radius of gyration k (in units of r).

        The third ratio is multiplied by r²/(2k²): only r ω' = −(r²/2k²) J sin φ ρ_ω feels how the
        mass is spread.  ``coarser``: by every other node only, to see what the spline contributes
        to an error.
        """
        return motion_coefficients(self.spline.coarser() if coarser else self.spline, gyration)

    def ratios(self, phi: FloatArray) -> FloatArray:
        """1/ρ_∥, ρ_⊥/ρ_∥, ρ_ω/ρ_∥ at slip angles (n,), (n, 3)."""
        return self.spline.at(phi)

    def at_ends(self) -> FloatArray:
        """The ratios at φ = 0 and π/2, (2, 3), as tabulated: without an error of the spline."""
        return np.stack([self.spline.values[0, -1], self.spline.values[-1, -1]])

    def validate(self, progress: Progress | None = None, points: int = 600) -> CheckReport:
        """Judge the section by the law, at so many ``points`` of each kind."""
        allowed = min(self.tolerance, COARSEST)
        return self.judged(
            lambda phi: self.ratios(phi) - friction_ratios(self.law, phi, self.delta), "the law",
            points, allowed, max(allowed, _NODE_ERROR), progress,
        )  # fmt: skip

    # the record of the kind

    @classmethod
    def is_of(cls, of: object) -> bool:
        """A pressure law and a height."""
        return isinstance(of, tuple) and len(of) == 2 and isinstance(of[0], Law | str)

    @classmethod
    def built(cls, of: Any, accuracy: float | None = None, **how: Any) -> FrictionSection:
        """The friction of one puck, see :meth:`puck_tables.Table.build`."""
        law = of[0] if isinstance(of[0], Law) else law_of(of[0])
        units = "an absolute error of the friction ratios"
        wanted = checked_accuracy(accuracy, DEFAULT_ACCURACY, FINEST_ACCURACY, units)
        return friction_section(law, float(checked_delta(of[1])), wanted, **how)


def motion_coefficients(spline: SlipSpline, gyration: float) -> FloatArray:
    """What compiled motions of a puck with this k/r read of its friction ratios."""
    square, factors = inertia_of(gyration)
    coefficients = spline.with_inertia(square, factors)
    # a line that is the limit of the motion is never crossed: rounding would, again and again
    limit = np.abs(spline.values[:, 0, 2] * factors[2] - 1.0) < AT_THE_LIMIT
    coefficients[limit, LINE] = math.inf
    return coefficients


def inertia_of(gyration: float) -> tuple[float, FloatArray]:
    """k²/r², and what the friction ratios are multiplied with: the third by r²/(2k²)."""
    # exactly 1 and ½ for a homogeneous puck
    square = 0.5 if gyration == HOMOGENEOUS else gyration * gyration
    return square, np.array([1.0, 1.0, 0.5 / square])


def section_of_table(table: ResultantTable, delta: float, accuracy: float) -> FrictionSection:
    """The section of a table of resultants at one height: the table is all that is asked.

    ``table``: of the puck's pressure law; ``delta``: dimensionless height 2fh/r; ``accuracy``: the
    largest error of a friction ratio.

    >>> table = ResultantTable.build("ring", 1e-8)
    >>> inverse, across, spin = section_of_table(table, 1.0, 1e-6).ratios(np.array([0.0]))[0]
    >>> round(float(across / inverse), 6)  # ρ_⊥
    0.25
    """
    values, error = ratios_of_table(table, delta)
    if table.axis.cells % 2:
        raise InputError(
            f"{table.source} has an odd number of cells ({table.axis.cells}), which motions cannot "
            "halve to see what it contributes to an error: build one with --accuracy"
        )
    if error > accuracy:
        raise AccuracyError(
            f"{table.source} gives the friction ratios to {error:.1g}, not to {accuracy:.1g}: "
            "give a finer table, or a larger tol (--tol)", reachable=error,
        )  # fmt: skip
    everywhere = (error,) * 3, (error,) * 3, (error,) * 3, (0.0,) * 3, (delta,) * 3
    return FrictionSection(
        values[:, :RATIOS], law=table.law, delta=delta, cotangents=table.law.edges, tolerance=error,
        accuracy=Accuracy(*everywhere, promised=3, order=0.0, points=0), source=table.source,
    )  # fmt: skip


def ratios_of_table(table: ResultantTable, delta: float) -> tuple[FloatArray, float]:
    """The friction ratios and their derivatives by the height at its nodes (n, 6), their error."""
    table.checked_range(delta, table.law)
    values = ratios_at(height_terms(table.values, table.heights), delta)
    # an error of ρ_∥ stands in every ratio
    return values, table.tolerance * float(values[:, 0].max() * (1.0 + values[:, :RATIOS].max()))


def friction_ratios(law: Law, phi: FloatArray, delta: float) -> FloatArray:
    """The friction ratios by the law, (n, 3): for few angles, and to judge."""
    return _ratios(law.friction(phi, delta))


def many_ratios(law: Law, phi: FloatArray, delta: float) -> FloatArray:
    """The friction ratios of many angles, (n, 3), by compiled truth where contact opens."""
    tall = law.can_lift and delta > _FULL_CONTACT
    return _ratios(tall_resultants(phi, delta)) if tall else friction_ratios(law, phi, delta)


def _ratios(rho: Resultants) -> FloatArray:
    return np.stack([1.0 / rho.parallel, rho.perpendicular / rho.parallel,
                     rho.spin / rho.parallel], axis=-1)  # fmt: skip


@lru_cache(maxsize=64)
def friction_section(law: Law, delta: float, accuracy: float = DEFAULT_ACCURACY) -> FrictionSection:
    """Tabulate the friction of one puck; the same call again costs nothing.

    ``delta``: dimensionless height 2fh/r, up to 3.9637 under uniform pressure, to ``law.delta_max``
    under another; ``accuracy``: the largest error of a friction ratio.

    Salnikova, Treschev, Gallyamov 2012, section 6; beyond full contact the same balance of moments
    with σ = max(0, a + b x + c y).

    >>> from puck_tables.contact.laws import law_of
    >>> found = friction_section(law_of("uniform"), 2.0, 1e-7)
    >>> inverse, across, spin = found.ratios(np.array([0.5]))[0]
    >>> round(float(spin / inverse), 6)  # ρ_ω
    0.219633
    """
    cotangents = lines_of(law, delta)
    spline = slip_spline(
        lambda phi: many_ratios(law, phi, delta), sides_of(cotangents[::-1]), accuracy, even=True
    )
    assert spline.accuracy is not None
    return FrictionSection(
        LawAxis(cotangents, spline.cells).concatenated(spline.values), law=law, delta=delta,
        cotangents=cotangents, tolerance=accuracy,
        accuracy=replace(spline.accuracy, at_second=3 * (delta,)),
    )  # fmt: skip


@lru_cache(maxsize=64)
def friction_for(law: Law, delta: float, accuracy: float) -> FrictionSection:
    """The friction of one puck: where that takes long, read if it is kept, else tabulated.

    ``law``, ``delta``, ``accuracy``: as in :func:`friction_section`.

    >>> from puck_tables.contact.laws import law_of
    >>> friction_for(law_of("ring"), 0.5, 1e-6).grid  # under other laws it takes no time
    '129 phi nodes'
    """
    if not (law.can_lift and delta > _FULL_CONTACT and is_named(law)):
        return friction_section(law, delta, accuracy)
    refuse_height(law, delta)
    return fetch(
        f"tall-{delta:g}-{accuracy:g}", {"law": law, "delta": delta, "accuracy": accuracy},
        lambda: friction_section(law, delta, accuracy),
    )  # fmt: skip

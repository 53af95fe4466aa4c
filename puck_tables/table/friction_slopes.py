"""Friction of one puck and how it changes with the height, over the slip angle.

What derivatives of motions need besides the friction ratios: their derivatives by δ at the same φ.
In full contact the ratios are polynomials of degree 2 in δ; in partial contact the balance of
moments is differentiated (:func:`puck_tables.contact.one_sided.height_slopes`).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.contact import one_sided
from puck_tables.contact.laws import Law
from puck_tables.contact.opening import critical_delta
from puck_tables.kernels.section_spline import RATIOS, SLOPES
from puck_tables.table.friction_section import (
    FrictionSection,
    inertia_of,
    motion_coefficients,
    ratios_of_table,
)
from puck_tables.table.resultant_table import ResultantTable
from puck_tables.table.singular_lines import lines_of
from puck_tables.table.slip_axis import sides_of
from puck_tables.table.slip_spline import SlipSpline, slip_spline
from puck_tables.table.spline_fit import height_terms, ratios_at

FLOW_ACCURACY = 1e-9  # motions differentiated with it err by at most 1e-8


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
def friction_slopes_of(law: Law, delta: float, accuracy: float = FLOW_ACCURACY) -> FrictionSlopes:
    """Tabulate the friction of one puck with its derivatives by the height.

    Parameters
    ----------
    law : Law
    delta : dimensionless height 2fh/r
    accuracy : the largest error of a friction ratio

    Examples
    --------
    >>> from puck_tables.contact.laws import law_of
    >>> found = friction_slopes_of(law_of("ring"), 1.0, 1e-6)
    >>> (found.spline.at(np.array([0.0]))[0].round(6) + 0.0).tolist()  # 1, δ/4, 1 − δ²/8 …
    [1.0, 0.25, 0.875, 0.0, 0.25, -0.25]
    """
    sides = sides_of(lines_of(law, delta)[::-1])
    found = slip_spline(lambda phi: slopes_at(law, phi, delta), sides, accuracy, even=True)
    return FrictionSlopes(found, delta, float(found.error[:RATIOS].max()))


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

"""The table of friction resultants: built from its pressure law, and judged by it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Self

from puck_tables.contact.laws import Law, law_of
from puck_tables.table.check import CheckReport
from puck_tables.table.metadata import KINDS, Progress
from puck_tables.table.resultant_values import ResultantValues


@dataclass(frozen=True, eq=False, repr=False)
class ResultantTable(ResultantValues):
    """Friction resultants under a pressure law, 0 ≤ δ ≤ 4⟨x²⟩, with the spline through them.

    Parameters
    ----------
    values : array (nodes of φ, 4, 3)
        ρ_∥, ρ_⊥, ρ_ω at the nodes of ``axis`` and at δ = 0, ⅓, ⅔ and 1 of ``delta_max``.
    law : Law
    """

    def validate(self, progress: Progress | None = None, points: int | None = None) -> CheckReport:
        """Judge the table by the law itself, under uniform pressure also by independent routes.

        Parameters
        ----------
        progress : callable (done, total), optional
        points : int, optional
            Number of random points.

        Returns
        -------
        CheckReport
            Deviations from the law (closed forms under uniform pressure) at random points, next to
            the singular lines, in every cell and at every node; under uniform pressure also from
            direct quadrature, from the elementary entries, and of exact identities.  Other points
            at every call.

        Examples
        --------
        >>> ResultantTable.shipped().validate(points=50).passed
        True
        """
        from puck_tables.table.resultant_check import judged

        return judged(self, progress, points)

    @classmethod
    def is_of(cls, of: object) -> bool:
        """Pressure laws and their names."""
        return isinstance(of, Law) or (isinstance(of, str) and of not in KINDS)

    @classmethod
    def built(cls, of: Any, accuracy: float | None = None, **how: Any) -> Self:
        """A table under a pressure law, see :meth:`puck_tables.Table.build`."""
        from puck_tables.table.resultant_check import tabulated

        return tabulated(cls, of if isinstance(of, Law) else law_of(of), accuracy, **how)

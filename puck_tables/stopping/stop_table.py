"""The table of stops: built by integration, and judged by independent routes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Self

from puck_tables._core.waiting import Progress
from puck_tables.stopping.stop_values import StopValues
from puck_tables.table.check import CheckReport


@dataclass(frozen=True, eq=False, repr=False)
class StopTable(StopValues):
    """Where and when any puck stops, as functions of slip angle φ and height δ alone.

    Parameters
    ----------
    values : array (2 cells + 1, 9, 7)
        At the nodes of φ (ascending) and of δ (:func:`puck_tables.stopping.lookup.heights`):
        ``time`` T; ``along`` X/cos φ; ``across`` Y/(δ sin φ cos φ); ``length`` path/cos φ; ``body``
        angle/sin φ (all: :mod:`puck_tables.stopping.lookup`); ``curve`` κR; ``turn`` S/δ
        (:mod:`puck_tables.stopping.similarity`).

    Notes
    -----
    Errors are those of T, X, Y, path and body angle in units of Q/J, Q²/J and Q²/(J r), for which
    the tolerance is promised, and of κR and S.
    """

    def validate(self, progress: Progress | None = None) -> CheckReport:
        """Judge the table by independent routes.

        Parameters
        ----------
        progress : callable (done, total), optional

        Returns
        -------
        CheckReport
            Against the integrator with closed forms, in every cell of slip and at points that are
            other ones at every call; against the equations that T, X + iY, ln Q and ψ satisfy, with
            resultants by direct quadrature; against elementary values at φ = 0, π/2 and at the
            limit angle.
        """
        from puck_tables.stopping.stop_check import judged

        return judged(self, progress)

    @classmethod
    def is_of(cls, of: object) -> bool:
        """Its name."""
        return isinstance(of, str) and of == cls.kind

    @classmethod
    def built(cls, of: Any, accuracy: float | None = None, **how: Any) -> Self:
        """A table of stops, see :meth:`puck_tables.Table.build`."""
        from puck_tables.stopping.stop_check import tabulated

        return tabulated(cls, accuracy, **how)

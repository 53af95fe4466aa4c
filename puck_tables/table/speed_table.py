"""The table of friction by slip speed: built from its friction law, and judged by it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Self

from puck_tables.contact.speed_law import SpeedLaw
from puck_tables.table.check import CheckReport
from puck_tables.table.metadata import Progress
from puck_tables.table.speed_values import SpeedValues


@dataclass(frozen=True, eq=False, repr=False)
class SpeedTable(SpeedValues):
    """The friction integrals at all slips of one law f(|u|), for pucks of every height.

    Parameters
    ----------
    values : array (nodes, 4)
        p_a, p_b, p_d, p_e at the nodes of all patches, one after the other, ζ running fastest.
    breaks : array (k + 1,), m/s
        Speeds from 0 to the top between which the patches lie.
    cells : integer array (patches, 2)
        Cells along ξ and ζ of every patch, see :mod:`puck_tables.kernels.speed_spline`.
    largest_f : float
        Largest f of the law up to the top, the unit of the errors.
    law : SpeedLaw or FrictionLaw, optional
        The friction law; none if it was given as a function.

    Notes
    -----
    Errors are those of cos φ p_a, sin φ p_b, sin φ p_d and cos φ p_e in units of ``largest_f``.
    """

    def validate(
        self, progress: Progress | None = None, points: int = 2000, law: Any = None
    ) -> CheckReport:
        """Judge the table by quadrature.

        Parameters
        ----------
        progress : callable (done, total), optional
        points : how many points are compared at random, as many next to φ = 0, π/4, π/2, as many
            where a rim slips at one of the breaks, and as many or more in all patches alike;
            besides, the nodes that fit their neighbours least
        law : callable, optional
            The friction law, where the table was made of a function and does not hold it.

        Returns
        -------
        CheckReport
            Deviations of cos φ p_a, sin φ p_b, sin φ p_d and cos φ p_e in units of the largest f of
            the law; the second place of a deviation is v + r|ω| in m/s.

        Raises
        ------
        InputError
            If the law is a function and is not given.

        Examples
        --------
        >>> def f(u):
        ...     return 0.2 + 0.1 * u
        >>> table = SpeedTable.build(f, top_speed=1.0, accuracy=1e-4)
        >>> table.validate(points=300, law=f).passed
        True
        """
        from puck_tables.table.speed_check import judged

        return judged(self, self.law if law is None else law, points, progress)

    @classmethod
    def is_of(cls, of: object) -> bool:
        """Friction laws over the slip speed: points or functions."""
        return isinstance(of, SpeedLaw) or callable(of)

    @classmethod
    def built(cls, of: Any, accuracy: float | None = None, **how: Any) -> Self:
        """A table of a friction law, see :meth:`puck_tables.Table.build`."""
        from puck_tables.table.speed_build import tabulated

        return tabulated(cls, of, accuracy, **how)

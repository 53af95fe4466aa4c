"""The table of friction by slip speed: built from its friction law, and judged by it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.contact.integrals import slip_direction
from puck_tables.contact.speed_law import SpeedLaw
from puck_tables.errors import InputError
from puck_tables.table.build import COARSEST
from puck_tables.table.check import CheckReport, Route, judged
from puck_tables.table.speed_build import largest_f, tabulated
from puck_tables.table.speed_truth import truth_at
from puck_tables.table.speed_values import SpeedValues
from puck_tables.table.table import Progress


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
    law : SpeedLaw or FrictionLaw, optional
        The friction law; none if it was given as a function.
    pressure : Law
        The pressure law.
    reach : float
        The part of the radius on which the load stands.

    Notes
    -----
    Errors are those of cos φ p_a, sin φ p_b, sin φ p_d and cos φ p_e in units of the
    largest f of the law up to the top.
    """

    def validate(
        self, progress: Progress | None = None, points: int = 2000, law: Any = None
    ) -> CheckReport:
        """Judge the table by quadrature.

        Parameters
        ----------
        progress : callable (done, total), optional
        points : how many points are compared at random, as many next to φ = 0, π/4, π/2, as many
            where a rim slips at one of the breaks, and as many or more in all patches alike
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
        law = self.law if law is None else law
        if law is None:
            raise InputError("the friction law of this table is a function: give it as law=")
        rng = np.random.default_rng()

        def scattered(smallest: float) -> FloatArray:
            """Either side of 0, at all distances."""
            sizes = 10.0 ** -rng.uniform(smallest, 15.0, points)
            return np.asarray(rng.choice([-1.0, 1.0], points) * sizes)

        near = rng.choice([0.0, 0.25 * np.pi, 0.5 * np.pi], points) + scattered(0.5)
        U = self.top * rng.random((2, points)) ** rng.choice([1.0, 4.0], points)
        at_break = self.breaks[rng.integers(0, len(self.breaks), points)] * (1.0 + scattered(1.0))
        other = self.top * rng.random(points)
        fastest, slowest = np.maximum(at_break, other), np.minimum(at_break, other)
        side = rng.choice([-1.0, 1.0], points)
        equal = 0.25 * np.pi + side * np.arctan(slowest / fastest)
        unit = largest_f(law, self.top) or 1.0  # what the table says of it is not asked

        def off(phi: FloatArray, speeds: FloatArray) -> FloatArray:
            cosine, sine = np.cos(phi), np.sin(phi)
            Q = speeds / (cosine + sine) * (1.0 - 1e-15)
            got = self.integrals(phi, Q)
            truth = truth_at(law, self.round_load, self.top, slip_direction(phi), Q, plain=True)
            missed = np.stack([got.a, got.b, got.d, got.e]) - np.moveaxis(truth, -1, 0)
            return np.stack([cosine, sine, sine, cosine]) / unit * missed

        allowed = min(self.tolerance, COARSEST)
        return judged(self.source, self.tolerance, [
            Route(f"quadrature, {where}", self.quantities, phi, speeds, off, allowed)
            for where, phi, speeds in (
                ("random points", rng.uniform(0.0, 0.5 * np.pi, points), U[0]),
                ("next to 0, pi/4, pi/2", np.clip(near, 0.0, 0.5 * np.pi), U[1]),
                ("a rim at a break", np.clip(equal, 0.0, 0.5 * np.pi),
                 np.minimum(fastest, self.top)),
                ("in every patch", *self._in_every_patch(-(-points // len(self.patches)), rng)),
            )
        ], progress)  # fmt: skip

    def _in_every_patch(
        self, count: int, rng: np.random.Generator
    ) -> tuple[FloatArray, FloatArray]:
        """φ and v + r|ω| at so many random places of each patch."""
        found = []
        for patch in self.patches:
            direction, Q = patch.place(*rng.random((2, count)))
            cosine, sine = np.sqrt(direction.cos_squared), np.sqrt(direction.sin_squared)
            found.append((np.arctan2(sine, cosine), Q * (cosine + sine)))
        phi, fastest = np.concatenate(found, axis=1)
        return phi, fastest

    @classmethod
    def is_of(cls, of: object) -> bool:
        """Friction laws over the slip speed: points or functions."""
        return isinstance(of, SpeedLaw) or callable(of)

    @classmethod
    def built(cls, of: Any, accuracy: float | None = None, **how: Any) -> Self:
        """A table of a friction law, see :meth:`puck_tables.Table.build`."""
        return tabulated(cls, of, accuracy, **how)

"""Tables over the slip angle under a pressure law, and those of them at one height."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable
from dataclasses import KW_ONLY, dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables._core.waiting import Progress
from puck_tables.contact.laws import Law
from puck_tables.io.columns import Variable
from puck_tables.table.check import CheckReport, Route, judged
from puck_tables.table.slip_spline import LawAxis, SlipSpline
from puck_tables.table.table import Table


@dataclass(frozen=True, eq=False, repr=False)
class LawTable(Table):
    """A table over the slip angle under a pressure law; ``values`` (nodes of φ, …)."""

    _: KW_ONLY
    law: Law

    ends_too: ClassVar[bool] = False  # whether φ = 0 and π/2 are singular lines besides

    @property
    @abstractmethod
    def lines_at(self) -> tuple[float, ...]:
        """Cot φ of the singular lines, ascending."""

    @cached_property
    def axis(self) -> LawAxis:
        """The slip angles of its nodes."""
        sides = 2 * (len(self.lines_at) + self.ends_too)
        return LawAxis(self.lines_at, (len(self.values) - 1) // sides, self.ends_too)

    @property
    def pressure_law(self) -> str:
        """The name of the pressure law."""
        return self.law.name


@dataclass(frozen=True, eq=False, repr=False)
class SectionTable(LawTable):
    """Functions of the slip angle of a puck of one height; ``values`` (nodes of φ, functions).

    ``delta``: dimensionless height 2fh/r; ``cotangents``: cot φ of the singular lines, ascending.
    """

    _: KW_ONLY
    delta: float
    cotangents: tuple[float, ...]

    second = "delta"

    @property
    def lines_at(self) -> tuple[float, ...]:
        """Where it is singular."""
        return self.cotangents

    @cached_property
    def spline(self) -> SlipSpline:
        """Through the nodes."""
        by_side = self.axis.by_side(self.values)
        return SlipSpline(self.axis.sides, by_side, not self.ends_too, self.accuracy)

    def judged(
        self, error: Callable[[FloatArray], FloatArray], truth: str, points: int, allowed: float,
        at_nodes: float, progress: Progress | None,
    ) -> CheckReport:  # fmt: skip
        """How far off it is (``error``: of φ (n,), as (n, functions)) from what truth, in words.

        ``points`` are compared at random, and as many next to the lines, in cells and at nodes.
        """
        rng = np.random.default_rng()
        nodes = self.axis.nodes()
        near = rng.choice([*np.arctan2(1.0, self.cotangents), 0.0, 0.5 * np.pi], points)
        near += rng.choice([-1.0, 1.0], points) * 10.0 ** -rng.uniform(0.3, 15.0, points)
        some = rng.permutation(nodes.size - 1)[:points]
        inside = nodes[some] + rng.random(some.size) * np.diff(nodes)[some]
        routes = (
            ("random points", rng.uniform(0.0, 0.5 * np.pi, points), allowed),
            ("next to the lines", np.clip(near, 0.0, 0.5 * np.pi), allowed),
            ("in the cells", inside, allowed),
            ("nodes", nodes[rng.permutation(nodes.size)[:points]], at_nodes),
        )
        return judged(self.source, self.tolerance, [
            Route(f"{truth}, {where}", self.quantities, phi, 0.0 * phi + self.delta,
                  lambda phi, _: error(phi).T, most)
            for where, phi, most in routes
        ], progress)  # fmt: skip

    @property
    def valid_range(self) -> str:
        """Where it holds, in words."""
        return f"|phi| <= pi/2, delta = {self.delta:g} only"

    @property
    def axes(self) -> dict[str, Variable]:
        """Slip angle."""
        return {"phi": Variable(self.axis.nodes(), ("phi",), "rad", "slip angle atan2(r omega, v)")}

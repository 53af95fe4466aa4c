"""Tables over the slip angle at one height, of a puck under a pressure law."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import KW_ONLY, dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.table.check import Check, CheckReport, compared
from puck_tables.table.law_table import LawTable
from puck_tables.table.metadata import Axis, Progress
from puck_tables.table.singular_lines import singular_lines
from puck_tables.table.slip_spline import SlipSpline

_SAME = 1e-9  # of lines


@dataclass(frozen=True, eq=False, repr=False)
class SectionTable(LawTable):
    """Functions of the slip angle of a puck of one height.

    Parameters
    ----------
    values : array (nodes of φ, functions)
    law : Law
    delta : dimensionless height 2fh/r
    cotangents : cot φ of the singular lines, ascending
    """

    _: KW_ONLY
    delta: float
    cotangents: tuple[float, ...]

    second = "delta"
    entries: ClassVar[Mapping[str, type]] = {**LawTable.entries, "delta": float, "cotangents": str}

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
        self, off: Callable[[FloatArray], FloatArray], truth: str, points: int, allowed: float,
        at_nodes: float, progress: Progress | None,
    ) -> CheckReport:  # fmt: skip
        """How far off it is (``off``: of φ (n,), as (n, functions)) from what truth, in words.

        ``points`` are compared at random, and as many next to the lines, in cells and at nodes.
        """
        rng = np.random.default_rng()
        nodes = self.axis.nodes()
        near = rng.choice([*np.arctan2(1.0, self.cotangents), 0.0, 0.5 * np.pi], points)
        near += rng.choice([-1.0, 1.0], points) * 10.0 ** -rng.uniform(0.3, 15.0, points)
        some = rng.permutation(nodes.size - 1)[:points]
        inside = nodes[some] + rng.random(some.size) * np.diff(nodes)[some]
        odd = self.odd_nodes(points // 2)
        routes = (
            ("random points", rng.uniform(0.0, 0.5 * np.pi, points), allowed),
            ("next to the lines", np.clip(near, 0.0, 0.5 * np.pi), allowed),
            ("in the cells", inside, allowed),
            ("the oddest nodes", nodes[odd], at_nodes),
        )
        checks: list[Check] = []
        for done, (where, phi, most) in enumerate(routes, 1):
            second = 0.0 * phi + self.delta
            checks += compared(f"{truth}, {where}", self.quantities, off(phi).T, phi, second, most)
            if progress is not None:
                progress(done, len(routes))
        return CheckReport(self.source, self.tolerance, tuple(checks))

    @property
    def grid(self) -> str:
        """How many nodes it has, in words."""
        return f"{len(self.values)} phi nodes"

    @property
    def valid_range(self) -> str:
        """Where it holds, in words."""
        return f"|phi| <= pi/2, delta = {self.delta:g} only"

    @property
    def axes(self) -> dict[str, Axis]:
        """Slip angle."""
        return {"phi": Axis(self.axis.nodes(), "rad", "slip angle atan2(r omega, v)")}

    @property
    def parameters(self) -> dict[str, int | float | str]:
        """Those of its law, height and lines."""
        lines = json.dumps(self.cotangents)
        return {**super().parameters, "delta": self.delta, "cotangents": lines}

    @classmethod
    def fields(cls, attributes: dict[str, Any], arrays: dict[str, FloatArray]) -> dict[str, Any]:
        """Law, height and lines of a file."""
        found = super().fields(attributes, arrays)
        lines = tuple(float(line) for line in json.loads(attributes["cotangents"]))
        needed = np.array(singular_lines(found["law"], attributes["delta"]))
        if np.any(np.abs(np.subtract.outer(needed, lines)).min(axis=1) > _SAME * needed):
            raise ValueError("its lines are not those of its puck")
        return found | {"delta": attributes["delta"], "cotangents": lines}

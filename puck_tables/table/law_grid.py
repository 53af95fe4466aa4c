"""Slip axis of a table under any pressure law: regions from the law, nodes crowded at their edges.

The instantaneous centre of rotation crosses an edge of the load, at radius e, where cot φ = e; the
resultants are singular on these lines and analytic between them.  Every interval between two lines
is halved, so that each *side* of the axis runs from one singular line φ_e outwards:

    tan(φ − φ_e) = ± E ξ⁴,   ξ = i/n from the line,   ξ = 1 at φ = 0, π/2 or half way.

With the one edge e = 1 these are the two sides of φ = π/4 of :mod:`puck_tables.table.grid`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables.errors import InputError
from puck_tables.table.grid import GRADING_POWER

FloatArray = npt.NDArray[np.float64]

MAX_CELLS = 1 << 16


class Side(NamedTuple):
    """From the singular line ``line`` to ``end`` (radians), tan(end − line) = ``extent``."""

    line: float
    end: float
    extent: float


@dataclass(frozen=True)
class LawAxis:
    """The slip angles of a table under a law with these edges.

    Parameters
    ----------
    edges : tuple of float
        Radii of the edges of the load, ascending, the last 1.
    cells : int
        Cells on each side of each singular line, at least 4.

    Examples
    --------
    >>> [round(side.end, 4) for side in LawAxis((0.5, 1.0), 8).sides]
    [0.0, 0.9463, 0.9463, 1.5708]
    """

    edges: tuple[float, ...]
    cells: int

    def __post_init__(self) -> None:
        if not 4 <= self.cells <= MAX_CELLS:
            raise InputError(f"cells must be from 4 to {MAX_CELLS}, got {self.cells}")

    @property
    def sides(self) -> tuple[Side, ...]:
        """The sides in the order of φ: below and above each line."""
        lines = np.arctan2(1.0, self.edges[::-1])
        between = 0.5 * (lines[:-1] + lines[1:])
        ends = np.concatenate([[0.0], np.repeat(between, 2), [0.5 * np.pi]])
        owners = np.repeat(lines, 2)
        # tan(end − line) with 1/e = tan line: exact at both ends of the axis
        extents = np.tan(ends - owners)
        extents[0], extents[-1] = -1.0, self.edges[0]
        return tuple(Side(*map(float, side)) for side in zip(owners, ends, extents, strict=True))

    def phi(self) -> FloatArray:
        """φ at the nodes, (sides, cells + 1), from each line to the end of its side."""
        xi = (np.arange(self.cells + 1) / self.cells) ** GRADING_POWER
        rows = [side.line + np.arctan(side.extent * xi) for side in self.sides]
        phi = np.stack(rows)
        phi[:, -1] = [side.end for side in self.sides]
        return phi

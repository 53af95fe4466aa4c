"""The axis of slip angles: cut at the singular lines of a pressure law, nodes crowded there.

The instantaneous centre of rotation crosses an edge of the load, at radius e, where cot φ = e; the
resultants are singular on these lines and analytic between them.  Every interval between two lines
is halved, so that each *side* of the axis runs from one singular line φ_e outwards:

    tan(φ − φ_e) = ± E ξ⁴,   ξ = i/n from the line,   ξ = 1 at φ = 0, π/2 or half way.

Uniform pressure has the one edge e = 1, the two sides of φ = π/4.  There the resultants behave like
x² ln|x|: the fourth power crowds the nodes so that a cubic spline in ξ keeps order 4; a square is
not enough (its slope tends to 4 only like 4 − 1/ln n), a cube needs a cube root.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.errors import InputError

# of ξ: nodes crowd at a line, where derivatives end; less, and splines lose their order:
# test_order_4_through_every_singular_line
GRADING_POWER = 4
MAX_CELLS = 1 << 16  # a side: more is a damaged file


class Side(NamedTuple):
    """From the singular line ``line`` to ``end`` (radians), tan(end − line) = ``extent``."""

    line: float
    end: float
    extent: float


@dataclass(frozen=True)
class LawAxis:
    """The slip angles of a table under a law with these edges, ascending from 0 to π/2.

    Parameters
    ----------
    edges : tuple of float
        Radii of the edges of the load, ascending, the last 1; more generally cot φ of the lines.
    cells : int
        Cells on each side of each singular line, at least 4.
    ends_too : bool
        Whether φ = 0 and π/2 are singular lines besides.

    Examples
    --------
    >>> axis = LawAxis((1.0,), 4)
    >>> axis.size, axis.nodes().round(4).tolist()[:4]
    (9, [0.0, 0.479, 0.723, 0.7815])
    """

    edges: tuple[float, ...]
    cells: int
    ends_too: bool = False

    def __post_init__(self) -> None:
        if not 4 <= self.cells <= MAX_CELLS:
            raise InputError(f"cells must be from 4 to {MAX_CELLS}, got {self.cells}")

    @property
    def sides(self) -> tuple[Side, ...]:
        """The sides in the order of φ: below and above each line."""
        return sides_of(self.edges[::-1], self.ends_too)

    @property
    def size(self) -> int:
        """Number of nodes; neighbouring sides share one."""
        return len(self.sides) * self.cells + 1

    def nodes(self) -> FloatArray:
        """φ at the nodes, radians; 0, the lines and π/2 exactly."""
        by_side = graded(self.sides, np.arange(self.cells + 1) / self.cells)
        falls = self._falls
        by_side[falls] = by_side[falls, ::-1]
        return np.append(by_side[:, :-1], by_side[-1, -1])

    @property
    def _falls(self) -> npt.NDArray[np.bool_]:
        """Which sides run from their line towards smaller φ."""
        return np.array([side.end < side.line for side in self.sides])

    @property
    def numbers(self) -> npt.NDArray[np.int64]:
        """Numbers of the nodes from each line outwards, (sides, cells + 1)."""
        first = self.cells * np.arange(len(self.sides))[:, None]
        outwards = np.arange(self.cells + 1)
        return first + np.where(self._falls[:, None], outwards[::-1], outwards)

    def by_side(self, values: FloatArray) -> FloatArray:
        """Values at the nodes (size, …) from each line outwards, (sides, cells + 1, …)."""
        return values[self.numbers]

    def concatenated(self, by_side: FloatArray) -> FloatArray:
        """The way back."""
        values = np.empty((self.size, *by_side.shape[2:]))
        values[self.numbers] = by_side
        return values


def sides_of(cotangents: Sequence[float], ends_too: bool = False) -> tuple[Side, ...]:
    """The sides of the singular lines with these cot φ, in the order of φ.

    Parameters
    ----------
    cotangents : floats > 0, descending
    ends_too : whether φ = 0 and π/2 are singular lines besides

    Examples
    --------
    >>> [round(side.end, 4) for side in sides_of([1.0], ends_too=True)]
    [0.3927, 0.3927, 1.1781, 1.1781]
    """
    lines = np.arctan2(1.0, cotangents)
    if ends_too:
        lines = np.concatenate([[0.0], lines, [0.5 * np.pi]])
    owners = np.repeat(lines, 2)
    between = np.repeat(0.5 * (lines[:-1] + lines[1:]), 2)
    if ends_too:
        owners, ends = owners[1:-1], between
        extents = np.tan(ends - owners)
    else:
        ends = np.concatenate([[0.0], between, [0.5 * np.pi]])
        # tan(end − line): exact at both ends of the axis
        extents = np.tan(ends - owners)
        extents[0], extents[-1] = -1.0 / cotangents[0], cotangents[-1]
    return tuple(Side(*map(float, side)) for side in zip(owners, ends, extents, strict=True))


def graded(sides: Sequence[Side], xi: FloatArray) -> FloatArray:
    """φ at ξ ∈ [0, 1] (n,) on every side, (sides, n); ξ = 1 is the end of a side exactly.

    >>> graded(sides_of([1.0]), np.array([0.0, 1.0])).round(4).tolist()
    [[0.7854, 0.0], [0.7854, 1.5708]]
    """
    phi = np.stack([side.line + np.arctan(side.extent * xi**GRADING_POWER) for side in sides])
    phi[:, xi == 1.0] = np.array([[side.end] for side in sides])
    return phi

"""Splines over the slip angle alone, as fine as asked: how friction and stops of one puck are kept.

The axis of slip angles is cut at the singular lines of a pressure law.  The instantaneous centre of
rotation crosses an edge of the load, at radius e, where cot φ = e; the resultants are singular on
these lines and analytic between them.  Every interval between two lines is halved, so that each
*side* of the axis runs from one singular line φ_e outwards:

    tan(φ − φ_e) = ± E ξ⁴,   ξ = i/n from the line,   ξ = 1 at φ = 0, π/2 or half way.

Uniform pressure has the one edge e = 1, the two sides of φ = π/4.  There the resultants behave like
x² ln|x|: the fourth power crowds the nodes so that a cubic spline in ξ keeps order 4; a square is
not enough (its slope tends to 4 only like 4 − 1/ln n), a cube needs a cube root.

The functions are known wherever they are asked for, at some cost.  The axis is refined by halving
its cells, so that what was computed to measure the error of one level, the functions in the middles
of the cells, are nodes of the next.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.contact.integrals import slip_direction
from puck_tables.errors import AccuracyError, InputError
from puck_tables.kernels.quadratic import (
    HEADER,
    INERTIA,
    INVERSE_EXTENT,
    LINE,
    LINE_COS,
    LINE_SIN,
    UPPER_COS,
    UPPER_SIN,
    fill_section,
)
from puck_tables.table.check import Accuracy
from puck_tables.table.spline_fit import sided_coefficients

# of ξ: nodes crowd at a line, where derivatives end; less, and splines lose their order:
# test_order_4_through_every_singular_line
GRADING_POWER = 4
MAX_CELLS = 1 << 16  # a side: more is a damaged file
Functions = Callable[[FloatArray], FloatArray]  # of φ (n,), as (n, functions)

COARSEST_CELLS, FINEST_CELLS = 16, 2048  # a side, doubled between


class Side(NamedTuple):
    """From the singular line ``line`` to ``end`` (radians), tan(end − line) = ``extent``."""

    line: float
    end: float
    extent: float


@dataclass(frozen=True)
class LawAxis:
    """The slip angles of a table under a law with these edges, ascending from 0 to π/2.

    ``edges``: tuple of float, radii of the edges of the load, ascending, the last 1; more generally
    cot φ of the lines; ``cells``: cells on each side of each singular line, at least 4;
    ``ends_too``: whether φ = 0 and π/2 are singular lines besides.

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

    ``cotangents``: floats > 0, descending; ``ends_too``: whether φ = 0 and π/2 are singular lines
    besides.

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


@dataclass(frozen=True)
class SlipSpline:
    """Functions of φ ∈ [0, π/2] by cubic splines between singular lines.

    ``sides``: tuple of Side; ``values``: array (sides, cells + 1, functions), at the nodes, from
    each line outwards; ``even``: whether the functions are even about φ = 0 and π/2 (and these no
    singular lines); ``accuracy``: the errors in the middles of the cells; none while they are not
    known.
    """

    sides: tuple[Side, ...]
    values: FloatArray = field(repr=False)
    even: bool
    accuracy: Accuracy | None = None

    @property
    def error(self) -> FloatArray:
        """The largest error of each function."""
        if self.accuracy is None:
            return np.full(self.values.shape[2], np.inf)
        return np.array(self.accuracy.largest)

    @property
    def cells(self) -> int:
        """Cells on each side."""
        return int(self.values.shape[1]) - 1

    @cached_property
    def coefficients(self) -> FloatArray:
        """The matrix that :mod:`puck_tables.kernels.quadratic` reads; inertia left 0."""
        rows = np.zeros((len(self.sides), HEADER + self.values.shape[2] * (self.cells + 3)))
        rows[:, HEADER:] = sided_coefficients(self.values, self.even).reshape(len(rows), -1) / 6.0
        for n, side in enumerate(self.sides):
            upper = max(side.line, side.end)
            rows[n, LINE_COS], rows[n, LINE_SIN] = _direction(side.line)
            rows[n, LINE] = _log_tangent(side.line)
            rows[n, UPPER_COS], rows[n, UPPER_SIN] = _direction(upper)
            rows[n, INVERSE_EXTENT] = 1.0 / abs(side.extent)
        return rows

    def at(self, phi: FloatArray) -> FloatArray:
        """The functions at slip angles (n,), radians, as (n, functions)."""
        direction = slip_direction(phi)
        out = np.empty((self.values.shape[2], phi.size))
        fill_section(
            self.coefficients, self.values.shape[2], direction.ratio, direction.fast_spin, out
        )
        return out.T

    def coarser(self) -> SlipSpline:
        """The spline through every other node."""
        return SlipSpline(self.sides, self.values[:, ::2], self.even)

    def with_inertia(self, square: float, factors: FloatArray) -> FloatArray:
        """Its :attr:`coefficients` with this inertia, the functions multiplied by ``factors``."""
        rows = self.coefficients.copy()
        rows[:, INERTIA] = square
        rows[:, HEADER:] *= np.tile(factors, self.cells + 3)
        return rows


def _direction(phi: float) -> tuple[float, float]:
    if phi == 0.25 * math.pi:
        return math.sqrt(0.5), math.sqrt(0.5)  # equal, so that their difference is exact there
    return (0.0, 1.0) if phi == 0.5 * math.pi else (math.cos(phi), math.sin(phi))


def _log_tangent(phi: float) -> float:
    cosine, sine = _direction(phi)
    if sine == 0.0 or cosine == 0.0:
        return math.copysign(math.inf, sine - cosine)
    return math.log(sine / cosine)


def slip_spline(
    functions: Functions, sides: tuple[Side, ...], accuracy: float, even: bool,
    counted: slice = slice(None), weights: Functions | None = None, finest: int = FINEST_CELLS,
) -> SlipSpline:  # fmt: skip
    """Splines of these functions, refined until they are as good as asked.

    The error falls like cells⁻⁴.

    ``functions``: callable, φ (n,) → (n, functions); ``sides``: tuple of Side; ``accuracy``: the
    largest error allowed in the middle of a cell; ``even``: see :class:`SlipSpline`; ``counted``:
    of which functions it must hold; ``weights``: what the errors of the functions are multiplied
    with before they are judged; ``finest``: the most cells on a side.

    >>> from puck_tables.table.slip_spline import sides_of
    >>> found = slip_spline(lambda phi: np.cos(phi)[:, None] ** 2, sides_of([1.0]), 1e-6, True)
    >>> found.cells, float(found.at(np.array([0.5]))[0, 0].round(6))
    (64, 0.770151)
    """
    for spline, xi, off in refinements(functions, sides, even, COARSEST_CELLS, finest):
        if weights is not None:
            off *= _at(weights, sides, xi)
        worst = float(off[..., counted].max())
        if worst <= accuracy:
            errors, phi = off.reshape(-1, off.shape[2]).T, graded(sides, xi).ravel()
            return replace(spline, accuracy=Accuracy.of(errors, phi, 0.0 * phi, None))
    raise AccuracyError(
        f"an accuracy of {accuracy:.1g} is out of reach for this puck: {spline.cells} cells give "
        f"{worst:.1e}; ask for less",
        reachable=worst,
    )


def refinements(
    functions: Functions, sides: tuple[Side, ...], even: bool, coarsest: int, finest: int
) -> Iterator[tuple[SlipSpline, FloatArray, FloatArray]]:
    """Splines of from ``coarsest`` to ``finest`` cells a side, doubled between.

    With the ξ of the middles of their cells, and how far off the functions are there, (sides,
    cells, functions).
    """
    cells = coarsest
    values = _at(functions, sides, np.arange(cells + 1) / cells)
    while True:
        spline = SlipSpline(sides, values, even)
        xi = (np.arange(cells) + 0.5) / cells
        between = _at(functions, sides, xi)
        guess = spline.at(graded(sides, xi).ravel()).reshape(between.shape)
        yield spline, xi, np.abs(guess - between)
        if 2 * cells > finest:
            return
        finer = np.empty((len(sides), 2 * cells + 1, values.shape[2]))
        finer[:, ::2], finer[:, 1::2] = values, between
        values, cells = finer, 2 * cells


def _at(functions: Functions, sides: tuple[Side, ...], xi: FloatArray) -> FloatArray:
    """The functions at ξ on every side, (sides, ξ, functions)."""
    phi = graded(sides, xi)
    return functions(phi.ravel()).reshape(*phi.shape, -1)

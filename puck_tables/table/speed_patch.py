"""One patch of a table by slip speed: its node values, and how good the spline through them is.

Splines are of degree 5 on uniform nodes; what they miss is seen where every other node is left out.
"""

from __future__ import annotations

import math
from functools import lru_cache
from math import comb

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.contact.integrals import SlipDirection
from puck_tables.contact.round_load import RoundLoad
from puck_tables.contact.speed_law import SpeedLaw
from puck_tables.kernels.speed_spline import DEGREE, fill_patch
from puck_tables.table.speed_grid import COARSEST_CELLS, HALVINGS, RayPatch, SlipPatch
from puck_tables.table.speed_truth import Law, truth_at

# the B-splines, times 120
_AT_NODE = (1.0, 26.0, 66.0, 26.0, 1.0)
_BAND = 6  # bands of the matrix beside its diagonal
# half-way between nodes
_AT_MIDDLE = (1.0 / 32, 237.0 / 32, 1682.0 / 32, 1682.0 / 32, 237.0 / 32, 1.0 / 32)
_ORDER = 64.0  # 2⁶, of what half the nodes miss: the spline's own share
_LOW_ORDER = 6.0  # where half powers cross a patch, 2^2.5 to 2^3.5
_ALSO = 0.2  # of what the other axis misses: refined too
_PROBES = 100  # random points of a patch


def quintic_coefficients(values: FloatArray) -> FloatArray:
    """Coefficients of the uniform spline of degree 5 with not-a-knot ends, along two axes.

    Parameters
    ----------
    values : array (n + 1, m + 1, functions), n, m ≥ 5

    Returns
    -------
    array (n + 5, m + 5, functions), over 120² as the kernel takes them

    Examples
    --------
    >>> bool(np.allclose(120**2 * quintic_coefficients(np.ones((6, 7, 1))), 1.0))
    True
    """
    along = _solved(values)
    return np.ascontiguousarray(_solved(along.swapaxes(0, 1)).swapaxes(0, 1))


def missed_by_half(values: FloatArray) -> FloatArray:
    """At the odd nodes of axis 0 (2n + 1, …): the spline through the even ones less the values.

    >>> float(np.abs(missed_by_half(np.arange(21.0)[:, None] ** 5)).max() / 21**5) < 1e-13
    True
    """
    c = _solved(values[::2])
    n = len(values) // 2
    spline = sum(weight * c[m : m + n] for m, weight in enumerate(_AT_MIDDLE))
    return np.asarray(spline - values[1::2])


def _solved(values: FloatArray) -> FloatArray:
    """From n + 1 values at the nodes to n + 5 coefficients over 120, along axis 0."""
    from scipy.linalg import solve_banded  # a fifth of a second that few commands need

    right = np.zeros((len(values) + 4, *values.shape[1:]))
    right[2:-2] = values
    flat = solve_banded((_BAND, _BAND), _system(len(values) - 1), right.reshape(len(right), -1))
    return np.asarray(flat).reshape(right.shape)


@lru_cache(maxsize=32)
def _system(n: int) -> FloatArray:
    """The conditions as bands: no jump of the fifth derivative, the values, no jump."""
    full = np.zeros((n + DEGREE, n + DEGREE))
    for node in range(n + 1):
        full[node + 2, node : node + DEGREE] = _AT_NODE
    jump = [(-1.0) ** k * comb(6, k) for k in range(7)]
    for row, start in ((0, 0), (1, 1), (n + 3, n - 3), (n + 4, n - 2)):
        full[row, start : start + 7] = jump
    bands = np.zeros((2 * _BAND + 1, n + DEGREE))
    for offset in range(-_BAND, _BAND + 1):
        diagonal = np.diagonal(full, offset)
        first = max(offset, 0)
        bands[_BAND - offset, first : first + diagonal.size] = diagonal
    return bands


class FilledPatch:
    """A patch with its node values; it is made empty, filled, and refined as long as it lacks."""

    def __init__(
        self, patch: SlipPatch | RayPatch, law: Law, load: RoundLoad, unit: float, number: int,
        rules: int,
    ):  # fmt: skip
        self._law, self._load, self._unit, self._rules = law, load, unit, rules
        self.patch = patch
        self.cells = [COARSEST_CELLS, COARSEST_CELLS]
        self._probes = _probes(np.random.default_rng([1960, number]), patch)
        self.missed: list[float] = []  # nothing is known yet
        self.first: float | None = None  # how bad the coarsest grid was

    @property
    def nodes(self) -> int:
        """How many it has so far."""
        return (self.cells[0] + 1) * (self.cells[1] + 1) if self.missed else 0

    def fill(self) -> None:
        """The coarsest grid."""
        self.values = self._at(*(np.arange(n + 1) / n for n in self.cells))
        self._judge()
        self.first = self.badness

    def _at(self, xi: FloatArray, zeta: FloatArray) -> FloatArray:
        """The integrals on a grid, (ξ, ζ, 4)."""
        direction, Q = self.patch.place(xi[:, None], zeta)
        return truth_at(self._law, self._load, self.patch.top, direction, Q, self._rules)

    def _judge(self) -> None:
        """Errors (4, probes) of the spline, and what is missed along ξ and ζ by half the nodes."""
        xi, zeta = self._probes
        direction, self.speeds = self.patch.place(xi, zeta)
        found = np.empty((xi.size, 4))
        along, across = self.cells
        fill_patch(quintic_coefficients(self.values).ravel(), along, across, xi, zeta, found)
        truth = truth_at(self._law, self._load, self.patch.top, direction, self.speeds)
        self.errors = np.abs(self._weights(direction) * (found - truth))
        self.phi = np.arctan2(np.sqrt(direction.sin_squared), np.sqrt(direction.cos_squared))
        self.worst = float(self.errors.max())
        nodes = [np.arange(n + 1) / n for n in self.cells]
        weights = self._weights(self.patch.place(nodes[0][:, None], nodes[1])[0])
        by_half = (
            np.abs(missed_by_half(self.values) * weights[1::2]),
            np.abs(missed_by_half(self.values.swapaxes(0, 1)) * weights.swapaxes(0, 1)[1::2]),
        )
        crossed = isinstance(self.patch, RayPatch) and isinstance(self._law, SpeedLaw)
        order = _LOW_ORDER if crossed else _ORDER
        self.missed = [float(part.max()) / order for part in by_half]

    def _weights(self, direction: SlipDirection) -> FloatArray:
        """How the integrals enter the forces, over the largest f, (…, 4)."""
        cosine, sine = np.sqrt(direction.cos_squared), np.sqrt(direction.sin_squared)
        return np.stack([cosine, sine, sine, cosine], axis=-1) / self._unit

    def lacks(self, accuracy: float) -> list[int]:
        """The axes along which it has too few nodes."""
        if self.good(accuracy):
            return []
        most = max(self.missed)
        axes = [axis for axis in (0, 1) if self.missed[axis] >= _ALSO * most]
        return [axis for axis in axes if self.cells[axis] < COARSEST_CELLS << HALVINGS]

    def good(self, accuracy: float) -> bool:
        """Whether it is as good as asked wherever that was looked at."""
        return self.badness <= accuracy

    @property
    def badness(self) -> float:
        """The largest error that was seen, or is to be feared."""
        return max(self.worst, *self.missed)

    def size_with(self, axes: list[int]) -> int:
        """How many nodes it has once these axes are refined."""
        u, w = (2 * n if axis in axes else n for axis, n in enumerate(self.cells))
        return (u + 1) * (w + 1)

    def refine(self, axes: list[int]) -> None:
        """Halve the cells along these axes."""
        for axis in axes:
            n = self.cells[axis]
            between = [np.arange(m + 1) / m for m in self.cells]
            between[axis] = (np.arange(n) + 0.5) / n
            shape = list(self.values.shape)
            shape[axis] = 2 * n + 1
            finer = np.moveaxis(np.empty(shape), axis, 0)
            finer[::2] = np.moveaxis(self.values, axis, 0)
            finer[1::2] = np.moveaxis(self._at(*between), axis, 0)
            self.values = np.ascontiguousarray(np.moveaxis(finer, 0, axis))
            self.cells[axis] = 2 * n
        self._judge()

    def share(self, accuracy: float) -> float:
        """How far it has come, 0 to 1, on the way of its error from the coarsest grid."""
        if self.first is None or self.good(accuracy):
            return float(self.first is not None)
        return max(0.0, math.log(self.first / self.badness) / math.log(self.first / accuracy))


def _probes(rng: np.random.Generator, patch: SlipPatch | RayPatch) -> tuple[FloatArray, FloatArray]:
    """Points of a patch, ξ and ζ: anywhere, and next to all edges and corners."""
    share = rng.random((2, _PROBES))
    near = rng.random((2, _PROBES)) ** 6
    edge = np.where(rng.random((2, _PROBES)) < 0.5, near, 1.0 - near)
    xi, zeta = np.where(rng.random((2, _PROBES)) < 0.5, share, edge)
    if patch.is_mirrored:
        return np.maximum(xi, zeta), np.minimum(xi, zeta)
    return xi, zeta

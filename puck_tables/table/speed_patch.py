"""One patch of a table by slip speed: its node values, and how good the spline through them is.

Splines are of degree 5 on uniform nodes; what they miss is seen where every other node is left out.

A table is made and judged of integrals by quadrature, under any round load.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import lru_cache
from math import comb

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables._core.executor import keep_on
from puck_tables.contact.friction_laws import FrictionLaw
from puck_tables.contact.integrals import SlipDirection
from puck_tables.contact.round_load import RoundLoad
from puck_tables.contact.speed_law import SpeedLaw
from puck_tables.contact.speed_quadrature import SpeedFunction, speed_integrals
from puck_tables.kernels.circle_quadrature import fill_load
from puck_tables.kernels.speed_quadrature_kernel import FEW_POWERS, FINE, fill_integrals
from puck_tables.kernels.speed_spline import DEGREE, fill_patch
from puck_tables.table.speed_grid import COARSEST_CELLS, HALVINGS, RayPatch, SlipPatch

Law = SpeedLaw | FrictionLaw | SpeedFunction
Flags = npt.NDArray[np.bool_]

_SHORT = 0.3  # of its place
# points between two looks whether to go on: some 0.1 s
_AT_ONCE, _OF_CIRCLES = 20_000, 200
# the B-splines, times 120
_AT_NODE = (1.0, 26.0, 66.0, 26.0, 1.0)
_BAND = 6  # bands of the matrix beside its diagonal
# half-way between nodes
_AT_MIDDLE = (1.0 / 32, 237.0 / 32, 1682.0 / 32, 1682.0 / 32, 237.0 / 32, 1.0 / 32)
_ORDER = 64.0  # 2⁶, of what half the nodes miss: the spline's own share
_LOW_ORDER = 6.0  # where half powers cross a patch, 2^2.5 to 2^3.5
_ALSO = 0.2  # of what the other axis misses: refined too
_PROBES = 100  # random points of a patch


def truth_at(
    law: Law, load: RoundLoad, top: float, direction: SlipDirection, speed: FloatArray,
    rules: int = FINE, plain: bool = False,
) -> FloatArray:  # fmt: skip
    """p_a, p_b, p_d, p_e by quadrature, (…, 4).

    ``law``, ``load``: of friction and of pressure; ``top``: what the slip goes up to, m/s;
    ``direction``, ``speed``: of the slip, of one shape; m/s; ``plain``: discs by
    :mod:`puck_tables.contact.speed_quadrature`, as for a law that is a function.

    >>> from puck_tables.contact.integrals import slip_direction
    >>> from puck_tables.contact.laws import law_of
    >>> viscous = SpeedLaw([0.0, 2.0], [0.0, 0.2])
    >>> ring = RoundLoad(law_of("ring"))
    >>> truth_at(viscous, ring, 2.0, slip_direction(np.array([0.7])), np.ones(1)).round(9).tolist()
    [[0.1, 0.05, 0.1, -0.05]]
    """
    if not len(load.discs):
        return _over_circles(law, load, top, direction, speed, rules)
    total = np.zeros((*np.shape(speed), 4))
    for radius, share in load.discs:
        if radius == 1.0:
            part = _of_disc(law, top, direction, speed, rules, plain)
            norm = np.ones(np.shape(speed))
        else:
            seen, norm = _of_rim(direction, radius)
            part = _of_disc(law, top, seen, speed * norm, rules, plain)
            part = part * np.array([1.0, radius**2, radius**2, radius**2])
        total += share * part / np.expand_dims(norm, -1)
    return total


def _of_rim(direction: SlipDirection, radius: float) -> tuple[SlipDirection, FloatArray]:
    """The slip of a disc of another radius: its direction, and its Q over that of the whole."""
    cosine, sine = np.sqrt(direction.cos_squared), radius * np.sqrt(direction.sin_squared)
    fast = sine > cosine
    ratio = np.where(fast, cosine, sine) / np.where(fast, sine, cosine)
    return SlipDirection(ratio, fast), np.hypot(cosine, sine)


def _of_disc(
    law: Law, top: float, direction: SlipDirection, speed: FloatArray, rules: int, plain: bool
) -> FloatArray:
    ratio, fast = direction.ratio, direction.fast_spin
    if plain or not isinstance(law, SpeedLaw | FrictionLaw):
        p = speed_integrals(np.where(fast, np.arctan2(1.0, ratio), np.arctan(ratio)), speed, law)
        return np.stack([p.a, p.b, p.d, p.e], axis=-1)
    ends, pieces = law.pieces(top)
    flat, inside, Q, out = _flat(ratio, fast, speed)
    for part in _parts(Q.size, max(1, _AT_ONCE // max(1, len(pieces) // 4))):
        fill_integrals(ends, pieces, flat[part], inside[part], Q[part], rules, out[part])
    return out.reshape(*np.shape(ratio), 4)


def _over_circles(
    law: Law, load: RoundLoad, top: float, direction: SlipDirection, speed: FloatArray, rules: int
) -> FloatArray:
    assert isinstance(law, SpeedLaw | FrictionLaw)  # a function has been refused
    ends, pieces = law.pieces(top)
    power, rows = load.circles
    kinks = _kinks(ends, pieces)
    flat, inside, Q, out = _flat(direction.ratio, direction.fast_spin, speed)
    for part in _parts(Q.size, max(1, _OF_CIRCLES // max(1, len(rows)))):
        fill_load(
            ends, pieces, kinks, power, rows, load.reach, flat[part], inside[part], Q[part], rules,
            out[part],
        )  # fmt: skip
    return out.reshape(*np.shape(direction.ratio), 4)


def _kinks(ends: FloatArray, pieces: FloatArray) -> FloatArray:
    """Speeds of the corners of a law of cubics; of a smooth one those between which it bends most.

    Smooth laws stand in pieces as long as a series allows: such a piece is much shorter than its
    distance from slip zero.
    """
    if pieces.shape[1] <= FEW_POWERS:
        return ends[1:-1]
    short = np.flatnonzero(np.diff(ends) < _SHORT * ends[1:])
    return np.setdiff1d(ends[np.union1d(short, short + 1)], ends[[0, -1]])


def _flat(
    ratio: FloatArray, fast: Flags, speed: FloatArray
) -> tuple[FloatArray, Flags, FloatArray, FloatArray]:
    flat = np.ravel(ratio).copy()
    inside = np.array(np.broadcast_to(fast, np.shape(ratio)), bool).ravel()
    return flat, inside, np.ravel(speed).copy(), np.empty((flat.size, 4))


def _parts(size: int, each: int) -> Iterator[slice]:
    """Slices of so many, with a look whether to go on before each."""
    for start in range(0, size, each):
        keep_on()
        yield slice(start, start + each)


def quintic_coefficients(values: FloatArray) -> FloatArray:
    """Coefficients of the uniform spline of degree 5 with not-a-knot ends, along two axes.

    ``values``: array (n + 1, m + 1, functions), n, m ≥ 5.  Returns array (n + 5, m + 5, functions),
    over 120² as the kernel takes them.

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
        values = np.empty((xi.size, 4))
        along, across = self.cells
        fill_patch(quintic_coefficients(self.values).ravel(), along, across, xi, zeta, values)
        truth = truth_at(self._law, self._load, self.patch.top, direction, self.speeds)
        self.errors = np.abs(self._weights(direction) * (values - truth))
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

"""Building a table of friction that depends on the slip speed: each patch as fine as it needs."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import TypeVar

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables._core.executor import keep_on, run_chunks
from puck_tables._core.real import rounded_up
from puck_tables.contact.friction_laws import FrictionLaw
from puck_tables.contact.speed_law import SpeedLaw
from puck_tables.contact.speed_quadrature import SpeedFunction, speed_integrals
from puck_tables.errors import AccuracyError
from puck_tables.kernels.speed_quadrature_kernel import COARSE, FINE, fill_integrals
from puck_tables.kernels.speed_spline import fill_patch
from puck_tables.table.accuracy import Accuracy
from puck_tables.table.build import COARSEST
from puck_tables.table.speed_fit import missed_by_half, quintic_coefficients
from puck_tables.table.speed_grid import COARSEST_CELLS, HALVINGS, SlipPatch, breaks_of, patches_of
from puck_tables.table.speed_values import SpeedValues
from puck_tables.table.table import Progress

Law = SpeedLaw | FrictionLaw | SpeedFunction

K = TypeVar("K", bound=SpeedValues)  # the kind that is made

DEFAULT_ACCURACY = 1e-6  # of f
FINEST_ACCURACY = 1e-13  # of f: finer is rounding
MAX_NODES = 2_000_000  # more is an accuracy out of reach
_ORDER = 64.0  # to the power 6, of what half the nodes miss: the spline's own share
_ALSO = 0.2  # of what the other axis misses: refined too
_NEXT = 0.03  # of the largest error: refined in the same round
_PROBES = 100  # random points of a patch
_SAFETY = 2.0  # for points that were not measured
_COARSE_FROM = 5e-10  # from here on nodes of laws without corners are coarser; probes are not
_BETWEEN_WORDS = 0.1  # s
_AT_ONCE = 20_000  # nodes between two looks whether to go on: some 0.1 s


class _Filled:
    """One patch with its node values, and how good the spline through them is."""

    def __init__(self, patch: SlipPatch, law: Law, unit: float, number: int, rules: int):
        self._law, self._unit, self._rules = law, unit, rules
        self.patch = patch
        self.cells = [COARSEST_CELLS, COARSEST_CELLS]
        self._probes = _probes(np.random.default_rng([1960, number]), patch)
        self.missed: list[float] = []  # nothing is known yet

    @property
    def nodes(self) -> int:
        """How many it has so far."""
        return (self.cells[0] + 1) * (self.cells[1] + 1) if self.missed else 0

    def fill(self) -> None:
        """The coarsest grid."""
        self.values = self._at(*(np.arange(n + 1) / n for n in self.cells))
        self._judge()

    def _at(self, xi: FloatArray, zeta: FloatArray) -> FloatArray:
        """The integrals on a grid, (ξ, ζ, 4)."""
        direction, Q = self.patch.place(xi[:, None], zeta)
        fast = bool(self.patch.fast)
        return truth_at(self._law, self.patch.top, direction.ratio, fast, Q, self._rules)

    def _judge(self) -> None:
        """Errors (4, probes) of the spline, and what is missed along ξ and ζ by half the nodes."""
        xi, zeta = self._probes
        direction, self.speeds = self.patch.place(xi, zeta)
        found = np.empty((xi.size, 4))
        along, across = self.cells
        fill_patch(quintic_coefficients(self.values).ravel(), along, across, xi, zeta, found)
        truth = truth_at(
            self._law, self.patch.top, direction.ratio, bool(self.patch.fast), self.speeds
        )
        cosine, sine = np.sqrt(direction.cos_squared), np.sqrt(direction.sin_squared)
        weights = np.stack([cosine, sine, sine, cosine], axis=-1) / self._unit
        self.errors = np.abs(weights * (found - truth))
        self.phi = np.arctan2(sine, cosine)
        self.worst = float(self.errors.max())
        nodes = [np.arange(n + 1) / n for n in self.cells]
        at_nodes, _ = self.patch.place(nodes[0][:, None], nodes[1])
        cosine, sine = np.sqrt(at_nodes.cos_squared), np.sqrt(at_nodes.sin_squared)
        weights = np.stack([cosine, sine, sine, cosine], axis=-1) / self._unit
        by_half = (
            np.abs(missed_by_half(self.values) * weights[1::2]),
            np.abs(missed_by_half(self.values.swapaxes(0, 1)) * weights.swapaxes(0, 1)[1::2]),
        )
        self.missed = [float(part.max()) / _ORDER for part in by_half]

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

    def nodes_in_the_end(self, accuracy: float) -> float:
        """How many it will have, as far as can be told."""
        u, w = self.cells
        for part in self.missed:
            if part > accuracy:
                halvings = math.ceil(math.log2(part / accuracy) / 6.0)
                u, w = (u << halvings, w) if part == self.missed[0] else (u, w << halvings)
        return (u + 1.0) * (w + 1.0)


def tabulated(
    kind: type[K],
    law: Law,
    accuracy: float | None = None,
    top_speed: float | None = None,
    scale: float | None = None,
    progress: Progress | None = None,
) -> K:
    """Friction with a coefficient that depends on the slip speed, in full contact, tabulated.

    The grid is cut at the corners of the law, and every patch is as fine as it needs.

    Parameters
    ----------
    law, accuracy, top_speed, scale : as in :meth:`puck_tables.Table.build`
    progress : callable (done, total), optional
        Told of nodes; how many they will be is an estimate that improves.

    Raises
    ------
    InputError
        If a number is out of range or the law gives no f.
    AccuracyError
        If the accuracy is out of range or would take more than 2 million nodes; it says which
        accuracy can be reached.

    Examples
    --------
    >>> from puck_tables.table.speed_table import SpeedTable
    >>> table = tabulated(SpeedTable, SpeedLaw([0.0, 0.5, 1.0, 3.0], [0.3, 0.22, 0.2, 0.25]), 1e-8)
    >>> table.accuracy.worst < 1e-8, table.top
    (True, 3.0)
    """
    accuracy = DEFAULT_ACCURACY if accuracy is None else accuracy
    if not FINEST_ACCURACY <= accuracy <= COARSEST:
        raise AccuracyError(
            f"the accuracy of a table of speeds must be from {FINEST_ACCURACY:g} to "
            f"{COARSEST:g} (of the largest f), got {accuracy:g}"
        )
    law = law.checked() if isinstance(law, FrictionLaw) else law
    breaks = breaks_of(law, top_speed, scale)
    largest = largest_f(law, float(breaks[-1]))
    goal = accuracy / _SAFETY
    patches = patches_of(breaks, law.grade if isinstance(law, SpeedLaw | FrictionLaw) else 1)
    rules = COARSE if isinstance(law, FrictionLaw) and accuracy >= _COARSE_FROM else FINE
    parts = [_Filled(patch, law, largest or 1.0, n, rules) for n, patch in enumerate(patches)]
    share, told = 0.0, 0.0

    def tell() -> None:
        nonlocal share, told
        if progress is None or time.monotonic() < told + _BETWEEN_WORDS:
            return
        told = time.monotonic()
        done = sum(part.nodes for part in parts)
        share = max(share, done / sum(part.nodes_in_the_end(goal) for part in parts))
        progress(int(1000 * min(share, 1.0)), 1000)

    _each(parts, _Filled.fill, tell)
    while pending := [part for part in parts if part.lacks(goal)]:
        chosen, room = [], MAX_NODES - sum(part.nodes for part in parts)
        worst = max(part.badness for part in pending)
        for part in sorted(pending, key=lambda part: -part.badness):
            if part.badness < _NEXT * worst:
                break  # not before the worst are mended: there may be no room for all
            room -= part.size_with(part.lacks(goal)) - part.nodes
            if room < 0:
                break
            chosen.append(part)
        if not chosen:
            raise _out_of_reach(parts, accuracy)
        _each(chosen, lambda part: part.refine(part.lacks(goal)), tell)
    if not all(part.good(goal) for part in parts):
        raise _out_of_reach(parts, accuracy)
    kept = law if isinstance(law, SpeedLaw | FrictionLaw) else None
    cells = np.array([part.cells for part in parts], np.int64)
    values = np.concatenate([part.values.reshape(-1, 4) for part in parts])
    return kind(
        values, breaks=breaks, cells=cells, law=kept, tolerance=accuracy, accuracy=_measured(parts),
    )  # fmt: skip


def _each(parts: list[_Filled], work: Callable[[_Filled], None], tell: Callable[[], None]) -> None:
    """Do it to every patch, on several threads."""

    def some(start: int, stop: int) -> None:
        for part in parts[start:stop]:
            work(part)

    run_chunks(some, len(parts), 1, progress=lambda done, total: tell())


def _out_of_reach(parts: list[_Filled], accuracy: float) -> AccuracyError:
    reached = _SAFETY * max(part.badness for part in parts)
    return AccuracyError(
        f"an accuracy of {accuracy:g} is out of reach for this friction law with its "
        f"corners: {rounded_up(reached):g} can be reached",
        reachable=rounded_up(reached),
    )


def largest_f(law: Law, top: float) -> float:
    """The largest f up to a speed: at a point of a law that does not overshoot, or sampled.

    Examples
    --------
    >>> largest_f(SpeedLaw([0.0, 1.0], [0.2, 0.3]), 0.5)
    0.25
    """
    if isinstance(law, SpeedLaw | FrictionLaw):
        return law.largest(top)
    speeds = top * np.linspace(0.0, 1.0, 1001) ** 3
    return float(np.abs(speed_integrals(0.0, speeds, law).a).max())


def truth_at(
    law: Law, top: float, ratio: FloatArray, fast: npt.ArrayLike, speed: FloatArray,
    rules: int = FINE,
) -> FloatArray:  # fmt: skip
    """p_a, p_b, p_d, p_e by quadrature, (…, 4); ``top``: what the slip goes up to, m/s."""
    if not isinstance(law, SpeedLaw | FrictionLaw):
        p = speed_integrals(np.where(fast, np.arctan2(1.0, ratio), np.arctan(ratio)), speed, law)
        return np.stack([p.a, p.b, p.d, p.e], axis=-1)
    ends, pieces = law.pieces(top)
    flat, Q = np.ravel(ratio).copy(), np.ravel(speed).copy()
    inside = np.array(np.broadcast_to(fast, flat.shape), bool)
    out = np.empty((flat.size, 4))
    each = max(1, _AT_ONCE // max(1, len(pieces) // 4))
    for start in range(0, flat.size, each):
        keep_on()
        part = slice(start, start + each)
        fill_integrals(ends, pieces, flat[part], inside[part], Q[part], rules, out[part])
    return out.reshape(*np.shape(ratio), 4)


def _probes(rng: np.random.Generator, patch: SlipPatch) -> tuple[FloatArray, FloatArray]:
    """Points of a patch, ξ and ζ: anywhere, and next to all edges and corners."""
    share = rng.random((2, _PROBES))
    near = rng.random((2, _PROBES)) ** 6
    edge = np.where(rng.random((2, _PROBES)) < 0.5, near, 1.0 - near)
    xi, zeta = np.where(rng.random((2, _PROBES)) < 0.5, share, edge)
    if patch.slab > 0 and patch.part == patch.slab + 1:  # one half mirrors the other
        return np.maximum(xi, zeta), np.minimum(xi, zeta)
    return xi, zeta


def _measured(parts: list[_Filled]) -> Accuracy:
    errors = np.concatenate([part.errors for part in parts]).T
    phi = np.concatenate([part.phi for part in parts])
    fastest = np.concatenate([part.speeds for part in parts]) * (np.cos(phi) + np.sin(phi))
    return Accuracy.of(errors, phi, fastest, None)

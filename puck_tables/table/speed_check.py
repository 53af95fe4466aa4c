"""A table of friction that depends on the slip speed judged by quadrature, at points of its own."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.contact.integrals import SlipDirection
from puck_tables.contact.speed_quadrature import SpeedFunction, speed_integrals
from puck_tables.errors import InputError
from puck_tables.table.build import COARSEST
from puck_tables.table.check import Check, CheckReport, compared
from puck_tables.table.metadata import Progress
from puck_tables.table.oddities import odd_nodes
from puck_tables.table.speed_build import largest_f
from puck_tables.table.speed_values import SpeedValues

IntArray = npt.NDArray[np.int64]
BoolArray = npt.NDArray[np.bool_]


def judged(
    table: SpeedValues, law: SpeedFunction | None, points: int, progress: Progress | None
) -> CheckReport:
    """The report of :meth:`SpeedTable.validate`."""
    if law is None:
        raise InputError("the friction law of this table is a function: give it as law=")
    rng = np.random.default_rng()
    near = rng.choice([0.0, 0.25 * np.pi, 0.5 * np.pi], points)
    near += rng.choice([-1.0, 1.0], points) * 10.0 ** -rng.uniform(0.5, 15.0, points)
    U = table.top * rng.random((2, points)) ** rng.choice([1.0, 4.0], points)
    at_break = table.breaks[rng.integers(0, len(table.breaks), points)]
    at_break = at_break * (
        1.0 + rng.choice([-1.0, 1.0], points) * 10.0 ** -rng.uniform(1, 9, points)
    )
    other = table.top * rng.random(points)
    fastest, slowest = np.maximum(at_break, other), np.minimum(at_break, other)
    fastest = np.minimum(fastest, table.top)
    equal = 0.25 * np.pi + rng.choice([-1.0, 1.0], points) * np.arctan(slowest / fastest)
    each = -(-points // len(table.patches))
    patches = np.repeat(np.arange(len(table.patches)), each)
    anywhere = _phi_and_fastest(*_slips(table, patches, rng.random((2, patches.size))))
    odd = oddest(table, points // 20)
    at_odd = _phi_and_fastest(*_slips(table, odd[:, 0], _places(table, odd)))
    unit = largest_f(law, table.top) or 1.0  # what the table says of it is not asked
    allowed = min(table.tolerance, COARSEST)
    checks: list[Check] = []
    routes = (
        ("quadrature, random points", rng.uniform(0.0, 0.5 * np.pi, points), U[0]),
        ("quadrature, next to 0, pi/4, pi/2", np.clip(near, 0.0, 0.5 * np.pi), U[1]),
        ("quadrature, a rim at a break", np.clip(equal, 0.0, 0.5 * np.pi), fastest),
        ("quadrature, in every patch", *anywhere),
        ("quadrature, the oddest nodes", *at_odd),
    )
    for done, (name, phi, speeds) in enumerate(routes, 1):
        cosine, sine = np.cos(phi), np.sin(phi)
        Q = speeds / (cosine + sine) * (1.0 - 1e-15)
        got, truth = table.integrals(phi, Q), speed_integrals(phi, Q, law)
        off = np.stack([got.a - truth.a, got.b - truth.b, got.d - truth.d, got.e - truth.e])
        errors = np.stack([cosine, sine, sine, cosine]) / unit * off
        checks += compared(name, table.quantities, errors, phi, speeds, allowed)
        if progress is not None:
            progress(done, len(routes))
    return CheckReport(table.source, table.tolerance, tuple(checks))


def oddest(table: SpeedValues, count: int) -> IntArray:
    """Nodes that fit their neighbours least: patch, ξ and ζ number, (n, 3).

    About ``count`` of all patches that have equally many cells.
    """
    values, found = table.by_patch(), []
    for cells in np.unique(table.cells, axis=0):
        alike = np.flatnonzero((table.cells == cells).all(axis=1))
        nodes = odd_nodes(np.stack([values[patch] for patch in alike]), (1, 2), count)
        found.append(np.column_stack([alike[nodes[:, 0]], nodes[:, 1:]]))
    return np.concatenate(found)


def _places(table: SpeedValues, nodes: IntArray) -> FloatArray:
    """ξ and ζ of nodes (n, 3)."""
    return np.asarray((nodes[:, 1:] / table.cells[nodes[:, 0]]).T)


def _slips(
    table: SpeedValues, patches: IntArray, places: FloatArray
) -> tuple[FloatArray, BoolArray, FloatArray]:
    """Ratio, side and Q of the slip at places (2, n) in patches (n,)."""
    ratio, fast, Q = np.empty(patches.size), np.empty(patches.size, bool), np.empty(patches.size)
    for number in np.unique(patches):
        chosen = patches == number
        direction, Q[chosen] = table.patches[number].place(*places[:, chosen])
        ratio[chosen], fast[chosen] = direction.ratio, direction.fast_spin
    return ratio, fast, Q


def _direction(ratio: FloatArray, fast: BoolArray) -> tuple[FloatArray, FloatArray]:
    """Cos φ and sin φ."""
    direction = SlipDirection(ratio, fast)
    return np.sqrt(direction.cos_squared), np.sqrt(direction.sin_squared)


def _phi_and_fastest(
    ratio: FloatArray, fast: BoolArray, Q: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """φ and v + r|ω|."""
    cosine, sine = _direction(ratio, fast)
    return np.arctan2(sine, cosine), Q * (cosine + sine)

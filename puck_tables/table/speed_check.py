"""A table of friction that depends on the slip speed judged by quadrature, at points of its own."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from puck_tables.contact.integrals import slip_direction
from puck_tables.contact.speed_law import SpeedLaw
from puck_tables.contact.speed_quadrature import SpeedFunction, speed_resultants
from puck_tables.errors import InputError
from puck_tables.table.check import Check, CheckReport, in_every_cell, worst_of
from puck_tables.table.oddities import odd_nodes
from puck_tables.table.speed_table import SpeedTable
from puck_tables.table.table import FUNCTIONS

FloatArray = npt.NDArray[np.float64]

_COARSEST = 0.01  # the most that a table may promise


def validate_speed(
    table: SpeedTable, law: SpeedFunction | None = None, points: int = 2000
) -> CheckReport:
    """Judge a table of friction that depends on the slip speed.

    Parameters
    ----------
    table : SpeedTable
    law : callable, optional
        The friction law, where the table was made of a function and does not hold it.
    points : how many points are compared at random, and as many next to φ = 0, π/4, π/2

    Returns
    -------
    CheckReport
        Deviations of F_∥/N, F_⊥/N and 2M/(N r) in units of the largest f; the second place of a
        deviation is v + r|ω| in m/s.

    Raises
    ------
    InputError
        If the law is a function and is not given.

    Examples
    --------
    >>> from puck_tables.table.speed_table import build_speed_table
    >>> def f(u):
    ...     return 0.2 + 0.1 * u
    >>> table = build_speed_table(f, 1.0, top_speed=1.0, accuracy=1e-4)
    >>> validate_speed(table, f, points=300).passed
    True
    """
    judge = table.law if law is None else law
    if judge is None:
        raise InputError("the friction law of this table is a function: give it as law=")
    rng = np.random.default_rng()
    allowed = min(table.tolerance, _COARSEST)
    unit = table.largest_f or 1.0
    nodes, speeds = table.phi_axis.nodes(), table.speed_axis.nodes()
    if isinstance(judge, SpeedLaw):  # what errors are measured with is the law's to say
        unit = float(np.max(judge(speeds))) or 1.0
    near = rng.choice([0.0, 0.25 * np.pi, 0.5 * np.pi], points)
    near += rng.choice([-1.0, 1.0], points) * 10.0 ** -rng.uniform(0.5, 15.0, points)
    checks: list[Check] = []
    any_speed = speeds[-1] * rng.random(points) ** rng.choice([1.0, 4.0], points)
    for name, phi, U in (
        ("quadrature, random points", rng.uniform(0.0, 0.5 * np.pi, points), any_speed),
        ("quadrature, next to 0, pi/4, pi/2", np.clip(near, 0.0, 0.5 * np.pi), any_speed),
        ("quadrature, every cell", *in_every_cell(nodes, speeds, rng, 3 * points)),
        ("quadrature, the oddest nodes", *_oddest(table, points)),
    ):
        ratio = slip_direction(phi).ratio
        Q = U * np.sqrt(1.0 + ratio**2) / (1.0 + ratio)
        got, truth = table.resultants(phi, Q), speed_resultants(phi, Q, judge, table.height_ratio)
        weights = np.cos(phi) / unit, np.sin(phi) * np.cos(phi) / unit, np.sin(phi) / unit
        checks += [
            worst_of(name, function, w * np.abs(a - b), phi, U, allowed)
            for function, w, a, b in zip(FUNCTIONS, weights, got, truth, strict=True)
        ]
    return CheckReport(table.source, table.tolerance, tuple(checks))


def _oddest(table: SpeedTable, count: int) -> tuple[FloatArray, FloatArray]:
    """φ and U of the nodes that fit their neighbours least."""
    row, column = odd_nodes(table.values, (0, 1), count).T
    return table.phi_axis.nodes()[row], table.speed_axis.nodes()[column]


def node_errors(
    table: SpeedTable, rows: npt.NDArray[np.int64], columns: npt.NDArray[np.int64]
) -> FloatArray:
    """Errors of values at nodes (n,) of a table that holds its law, in units of the largest f.

    Weighted as forces and torque are, (3, n).

    Examples
    --------
    >>> from puck_tables.contact.speed_law import SpeedLaw
    >>> from puck_tables.table.speed_table import build_speed_table
    >>> table = build_speed_table(SpeedLaw([0.0, 1.0], [0.2, 0.3]), accuracy=1e-4)
    >>> bool(node_errors(table, np.array([0, 3]), np.array([1, 2])).max() < 1e-14)
    True
    """
    assert table.law is not None
    direction = table.phi_axis.slip_direction()
    phi, U = table.phi_axis.nodes()[rows], table.speed_axis.nodes()[columns]
    ratio = direction.ratio[rows]
    Q = U * np.sqrt(1.0 + ratio**2) / (1.0 + ratio)
    truth = np.stack(speed_resultants(phi, Q, table.law, table.height_ratio))
    weights = np.stack([np.cos(phi), np.sin(phi) * np.cos(phi), np.sin(phi)])
    error = np.abs(table.values[rows, columns].T - truth)
    return np.asarray(weights * error / (table.largest_f or 1.0))

"""A table of a pressure law judged by the law itself, by direct quadrature over the patch."""

from __future__ import annotations

import numpy as np

from puck_tables.contact.laws import Law
from puck_tables.table.check import Check, CheckReport, worst_of
from puck_tables.table.law_table import HEIGHTS, LawTable
from puck_tables.table.table import FUNCTIONS

_COARSEST = 0.01  # what a table may promise at most
_NODE = 1e-10  # how well node values are known


def validate_law(table: LawTable, law: Law | None = None, points: int = 3000) -> CheckReport:
    """Judge a table of a pressure law against the law.

    Parameters
    ----------
    table : LawTable
    law : Law, optional
        Left out: the one the table says it is of.
    points : how many random points are compared

    Returns
    -------
    CheckReport
        Deviations at random points, at all distances from the singular lines, at every node and in
        every cell of φ; the points are other ones at every call.

    Raises
    ------
    InputError
        If the law is a profile that is neither given nor in the file (before format 2).

    Examples
    --------
    >>> from puck_tables.contact.laws import law_of
    >>> from puck_tables.table.law_table import build_law_table
    >>> validate_law(build_law_table(law_of("hertz"), accuracy=1e-5), points=300).passed
    True
    """
    judge = table.law if law is None else law
    rng = np.random.default_rng()
    allowed = min(table.tolerance, _COARSEST)
    lines = rng.choice([side.line for side in table.axis.sides], points)
    near = lines + rng.choice([-1.0, 1.0], points) * 10.0 ** -rng.uniform(0.5, 15.0, points)
    checks: list[Check] = []
    for name, phi in (
        ("quadrature, random points", rng.uniform(0.0, 0.5 * np.pi, points)),
        ("quadrature, next to the edges", np.clip(near, 0.0, 0.5 * np.pi)),
    ):
        delta = table.delta_max * rng.random(points)
        got, truth = table.resultants(phi, delta), judge.resultants(phi, delta)
        checks += [
            worst_of(name, function, np.abs(a - b), phi, delta, allowed)
            for function, a, b in zip(FUNCTIONS, got, truth, strict=True)
        ]
    heights = np.linspace(0.0, table.delta_max, HEIGHTS)
    nodes = table.axis.phi()
    truth = judge.resultants(nodes[..., None], heights)
    phi, delta = (axis.ravel() for axis in np.broadcast_arrays(nodes[..., None], heights))
    for i, function in enumerate(FUNCTIONS):
        error = np.abs(table.values[..., i] - truth[i]).ravel()
        checks.append(worst_of("every node", function, error, phi, delta, min(allowed, _NODE)))
    cells = nodes[:, :-1] + rng.random((len(nodes), table.axis.cells)) * np.diff(nodes, axis=1)
    phi, delta = cells.ravel(), table.delta_max * rng.random(cells.size)
    got, truth = table.resultants(phi, delta), judge.resultants(phi, delta)
    checks += [
        worst_of("quadrature, every cell", function, np.abs(a - b), phi, delta, allowed)
        for function, a, b in zip(FUNCTIONS, got, truth, strict=True)
    ]
    return CheckReport(table.source, table.tolerance, tuple(checks))

"""A table of partial contact judged: by the one-sided balance, closed forms and known entries."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from puck_tables.contact import closed_form
from puck_tables.contact.integrals import slip_direction
from puck_tables.contact.one_sided import balance
from puck_tables.contact.opening import critical_delta
from puck_tables.contact.resultants import moment_balance
from puck_tables.table.check import Check, CheckReport, worst_of
from puck_tables.table.oddities import odd_nodes
from puck_tables.table.partial_grid import FAST_END, UPPER_DELTA, ZETA_END, PartialAxes, height_at
from puck_tables.table.partial_table import PartialTable
from puck_tables.table.table import FUNCTIONS, Accuracy

FloatArray = npt.NDArray[np.float64]

_COARSEST, _NODE = 0.01, 1e-10  # the most a table may promise; how well its nodes are known


def adversarial_points(
    axes: PartialAxes, count: int, seed: int | None
) -> tuple[FloatArray, FloatArray]:
    """Points of partial contact where a table is worst, and random ones.

    Parameters
    ----------
    axes : whose cells are probed
    count : about how many
    seed : of the random generator; None: other points at every call

    Returns
    -------
    phi, delta : arrays (n,)
        Both uniform and in the coordinates of the table; next to tipping at φ = π/4, where the
        resultants are steepest; where the slip axis ends; above the opening and on both sides of
        π/4 at all distances; cell middles.

    Examples
    --------
    >>> phi, delta = adversarial_points(PartialAxes(8), 100, seed=1)
    >>> bool(delta.max() <= 3.9 and (delta > critical_delta(phi)).all())
    True
    """
    rng = np.random.default_rng(seed)
    part = count // 6

    def angle(xi: FloatArray) -> FloatArray:
        """φ at signed distances from π/4 in ξ."""
        return 0.25 * np.pi + np.arctan(np.where(xi > 0.0, FAST_END, 1.0) * np.sign(xi) * xi**4)

    def at_zeta(phi: FloatArray, zeta: FloatArray) -> FloatArray:
        return height_at(critical_delta(phi), zeta)

    anywhere = rng.uniform(0.0, 1.2, part)
    gridded = angle(rng.uniform(-1.0, 1.0, part))
    corner = 0.25 * np.pi + rng.uniform(-0.03, 0.03, part // 2)
    ridge = 0.25 * np.pi - rng.uniform(0.004, 0.018, 3 * part // 2)
    high = np.minimum(UPPER_DELTA, rng.uniform(3.88, 3.905, ridge.size))
    last = angle(rng.uniform(0.9, 1.0, part // 2))
    distance = 10.0 ** -rng.uniform(1.0, 16.0, part // 2)
    close = 0.25 * np.pi + rng.choice([-1.0, 1.0], part // 2) * distance
    opening = np.append(rng.uniform(0.0, 1.2, part // 2), [0.0, 1e-300, 0.25 * np.pi])
    just = 10.0 ** -rng.uniform(1.0, 15.0, opening.size)
    middles = angle((rng.integers(-axes.cells, axes.cells, part) + 0.5) / axes.cells)
    rows = axes.shape[1] - 1
    middle_zeta = ZETA_END * (rng.integers(0, rows, part) + 0.5) / rows
    phi = np.concatenate([anywhere, gridded, corner, ridge, last, close, opening, middles])
    delta = np.concatenate([
        rng.uniform(1.0, UPPER_DELTA, part),
        at_zeta(gridded, ZETA_END * rng.random(part)),
        rng.uniform(3.6, UPPER_DELTA, part // 2),
        high,
        rng.uniform(2.5, UPPER_DELTA, part // 2),
        rng.uniform(1.2, UPPER_DELTA, part // 2),
        at_zeta(opening, just),
        at_zeta(middles, middle_zeta),
    ])  # fmt: skip
    kept = (delta > critical_delta(phi)) & (delta <= UPPER_DELTA)
    return phi[kept], delta[kept]


def measure(table: PartialTable, half: PartialTable | None = None, count: int = 4000) -> Accuracy:
    """The errors of a table against the one-sided balance.

    Parameters
    ----------
    table : PartialTable
    half : PartialTable, optional
        A table with half as many cells; gives the order.
    count : int
        About how many points.

    Returns
    -------
    Accuracy

    Examples
    --------
    >>> from puck_tables.table.partial_file import load_partial_table
    >>> measure(load_partial_table(), count=300).worst < 1e-6
    True
    """
    phi, delta = adversarial_points(table.axes, count, seed=2012)
    truth = np.stack(balance(phi, delta)[0])
    error = np.abs(np.stack(table.resultants(phi, delta)) - truth)
    where = error.argmax(axis=1)
    order = 0.0
    if half is not None:
        half_error = np.abs(np.stack(half.resultants(phi, delta)) - truth)
        order = float(np.log2(half_error.max() / error.max()))
    return Accuracy(
        largest=tuple(error.max(axis=1).tolist()),
        rms=tuple(np.sqrt((error**2).mean(axis=1)).tolist()),
        p999=tuple(np.quantile(error, 0.999, axis=1).tolist()),
        at_phi=tuple(phi[where].tolist()),
        at_delta=tuple(delta[where].tolist()),
        entry_residual=float(_sliding(table)[0].max()),
        order=order,
        points=phi.size,
    )


def validate_partial(table: PartialTable, points: int = 3000) -> CheckReport:
    """Judge a table of partial contact, each line against the table's own tolerance.

    Parameters
    ----------
    table : PartialTable
    points : int
        About how many are compared with the one-sided balance.

    Returns
    -------
    CheckReport
        Deviations from the balance by quadrature at random and adversarial points, all over the
        table (other points at every call) and at the nodes that fit their neighbours least, from
        the closed forms of full contact where contact opens, and from ρ_∥ = 1, ρ_⊥ = δ/4 at φ = 0.

    Examples
    --------
    >>> from puck_tables.table.partial_file import load_partial_table
    >>> validate_partial(load_partial_table(), points=300).passed
    True
    """
    checks: list[Check] = []
    allowed = min(table.tolerance, _COARSEST)
    for name, (phi, delta) in (
        ("one-sided balance", adversarial_points(table.axes, points, seed=None)),
        ("the same, all over the table", _all_over(table, points // 2)),
    ):
        error = np.abs(np.stack(table.resultants(phi, delta)) - np.stack(balance(phi, delta)[0]))
        for function, row in zip(FUNCTIONS, error, strict=True):
            checks.append(worst_of(name, function, row, phi, delta, allowed))
    # all nodes are looked at: those that do not fit their neighbours are compared
    odd = odd_nodes(table.values[:, 1:], (0, 1), points // 2) + np.array([0, 1])
    phi, delta = table.axes.phi()[odd[:, 0]], table.axes.delta()[odd[:, 0], odd[:, 1]]
    error = np.abs(table.values[odd[:, 0], odd[:, 1]].T - np.stack(balance(phi, delta)[0]))
    for function, row in zip(FUNCTIONS, error, strict=True):
        checks.append(worst_of("the oddest nodes", function, row, phi, delta, _NODE))
    phi = np.linspace(0.0, 1.2, 2001)
    delta = critical_delta(phi) * (1.0 + 1e-12)
    phi, delta = phi[delta < UPPER_DELTA], delta[delta < UPPER_DELTA]
    truth = moment_balance(closed_form.integrals(phi), slip_direction(phi), delta)
    error = np.abs(np.stack(table.resultants(phi, delta)) - np.stack(truth))
    for function, row in zip(FUNCTIONS, error, strict=True):
        checks.append(worst_of("closed forms at the opening", function, row, phi, delta, allowed))
    error, delta = _sliding(table)
    for function, row in zip(FUNCTIONS[:2], error, strict=True):
        checks.append(worst_of("pure sliding", function, row, 0.0 * delta, delta, allowed))
    return CheckReport(table.source, table.tolerance, tuple(checks))


def _all_over(table: PartialTable, count: int) -> tuple[FloatArray, FloatArray]:
    """One random point in each of about so many equal parts of the table."""
    rng = np.random.default_rng()
    nodes, zeta = table.axes.phi(), table.axes.zeta()
    rows, columns = nodes.size - 1, zeta.size - 1
    step = max(1, round((rows * columns / count) ** 0.5))
    row, column = (
        grid.ravel() for grid in np.mgrid[0:rows:step, 0:columns:step].astype(np.float64)
    )
    row = np.minimum(row + step * rng.random(row.size), rows * (1.0 - 1e-12))
    column = np.minimum(column + step * rng.random(column.size), columns * (1.0 - 1e-12))
    i = row.astype(np.int64)
    phi = nodes[i] + (row - i) * np.diff(nodes)[i]
    delta = height_at(critical_delta(phi), zeta[-1] * column / columns)
    kept = (delta > critical_delta(phi)) & (delta <= UPPER_DELTA)
    return phi[kept], delta[kept]


def _sliding(table: PartialTable) -> tuple[FloatArray, FloatArray]:
    """Deviations of ρ_∥ and ρ_⊥ from 1 and δ/4 at φ = 0, (2, n), and the heights."""
    delta = np.linspace(1.0, UPPER_DELTA, 1001)
    rho = table.resultants(0.0, delta)
    return np.abs([rho.parallel - 1.0, rho.perpendicular - 0.25 * delta]), delta

"""The table of friction resultants built from its pressure law, measured and judged by it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TypeVar

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.contact import quadrature
from puck_tables.contact.integrals import slip_direction
from puck_tables.contact.laws import Law
from puck_tables.contact.resultants import Resultants, moment_balance
from puck_tables.table.accuracy import Accuracy
from puck_tables.table.build import COARSEST, Goal, built
from puck_tables.table.check import Check, CheckReport, compared
from puck_tables.table.metadata import Progress
from puck_tables.table.resultant_values import HEIGHTS, ResultantValues, full_contact
from puck_tables.table.slip_axis import LawAxis

Tell = Callable[[int], None]
K = TypeVar("K", bound=ResultantValues)  # the kind that is made

# where truth is closed forms, and where it is quadrature
_EXACT = Goal(2e-11, 1e-13, "an absolute error of the dimensionless resultants", 1.2, 1 << 16)
_BY_QUADRATURE = Goal(1e-9, 1e-11, _EXACT.units, 2.0, 2048, safety=1.25)
_PROBES, _FEW_PROBES = 60_000, 2400  # about as many points are measured
_CHUNK = 256  # angles between two reports of progress
# How many times the tolerance an identity between several values of a table may be off: each enters
# with its own error.
IDENTITY_FACTOR = 5.0
_CEILING, _FLOOR = 3.0, 1e-13  # largest error × cells⁴, twice what was measured, and of the nodes
_NODE = 1e-10  # how well nodes under a law of quadrature are known


def tabulated(
    kind: type[K],
    law: Law,
    accuracy: float | None = None,
    cells: int | None = None,
    progress: Progress | None = None,
) -> K:
    """The table of a law, see :meth:`puck_tables.Table.build`."""
    probes = _PROBES if law.can_lift else _FEW_PROBES

    def telling(work: int) -> Tell:
        done = 0

        def tell(count: int) -> None:
            nonlocal done
            done += count
            if progress is not None:
                progress(min(done, work), work)

        return tell

    tell = telling(probes)

    def at(cells: int) -> K:
        nonlocal tell
        tell = telling(LawAxis(law.edges, cells).size + probes)
        return tabulate(kind, law, cells, tell)

    goal = _EXACT if law.can_lift else _BY_QUADRATURE
    return built(at, lambda table: _measured(table, probes, tell), goal, accuracy, cells)


def tabulate(kind: type[K], law: Law, cells: int, tell: Tell | None = None) -> K:
    """The node values of a table, without a measured accuracy.

    Examples
    --------
    >>> from puck_tables.contact.laws import law_of
    >>> from puck_tables.table.resultant_table import ResultantTable
    >>> tabulate(ResultantTable, law_of("annulus:0.5"), 8).values.shape
    (33, 4, 3)
    """
    phi = LawAxis(law.edges, cells).nodes()
    heights = np.linspace(0.0, full_contact(law), HEIGHTS)
    return kind(_truth(law, phi[:, None], heights, tell), law=law)


def _truth(law: Law, phi: FloatArray, delta: FloatArray, tell: Tell | None = None) -> FloatArray:
    """The resultants by the law, (…, 3); ``phi`` (n, …), ``delta`` alike or of one φ."""
    parts = []
    for start in range(0, len(phi), _CHUNK):
        some = slice(start, start + _CHUNK)
        at = delta if delta.shape[:1] != phi.shape[:1] else delta[some]
        parts.append(np.stack(law.resultants(phi[some], at), axis=-1))
        if tell is not None:
            tell(len(parts[-1]))
    return np.concatenate(parts)


def _measured(table: ResultantValues, probes: int, tell: Tell | None) -> Accuracy:
    """The errors of a table against its law."""
    phi, delta = adversarial_points(table, probes, seed=2012)
    truth = _truth(table.law, phi, delta, tell).T
    errors = np.abs(np.stack(table.resultants(phi, delta)) - truth)
    coarse = None
    if table.axis.cells % 2 == 0 and table.axis.cells >= 8:
        half = replace(table, values=table.values[::2])
        coarse = np.abs(np.stack(half.resultants(phi, delta)) - truth)
    return Accuracy.of(errors, phi, delta, coarse)


def adversarial_points(
    table: ResultantValues, count: int, seed: int | None
) -> tuple[FloatArray, FloatArray]:
    """Points where a table is worst, and random ones.

    Parameters
    ----------
    table : whose cells are probed
    count : about how many
    seed : of the random generator; None: other points at every call

    Returns
    -------
    phi, delta : arrays (n,)
        Random; both sides of the singular lines and of 0 and π/2 at all distances; nodes and
        middles of cells.

    Examples
    --------
    >>> from puck_tables.contact.laws import law_of
    >>> from puck_tables.table.resultant_table import ResultantTable
    >>> phi, delta = adversarial_points(tabulate(ResultantTable, law_of("uniform"), 8), 100, seed=1)
    >>> bool(np.abs(phi).min() == 0.0 and delta.max() == 1.0)
    True
    """
    rng = np.random.default_rng(seed)
    part = count // 6
    lines = np.array([0.0, 0.5 * np.pi, *{side.line for side in table.axis.sides}])
    near = rng.choice(lines, part)
    near += rng.choice([-1.0, 1.0], part) * 10.0 ** -np.where(
        rng.random(part) < 0.1, rng.uniform(16.0, 300.0, part), rng.uniform(0.3, 16.0, part)
    )
    nodes = table.axis.nodes()
    middles = 0.5 * (nodes[1:] + nodes[:-1])
    phi = np.concatenate([
        lines, near[(near >= 0.0) & (near <= 0.5 * np.pi)],
        rng.choice(nodes, min(nodes.size, part), replace=False),
        rng.choice(middles, min(middles.size, 2 * part), replace=False),
        rng.uniform(0.0, 0.5 * np.pi, 2 * part),
    ])  # fmt: skip
    special = np.array([0.0, 5e-324, 1e-8, 0.1, 0.5, 0.9, 1.0 - 2.0**-53, 1.0])
    share = np.where(
        rng.random(phi.size) < 0.3, rng.choice(special, phi.size), rng.random(phi.size)
    )
    return rng.choice([-1.0, 1.0], phi.size) * phi, table.delta_max * share


def judged(table: ResultantValues, progress: Progress | None, points: int | None) -> CheckReport:
    """The report of :meth:`ResultantTable.validate`."""
    uniform = table.law.can_lift
    count = (40_000 if uniform else 3000) if points is None else points
    rng = np.random.default_rng()
    names, cells = table.functions, table.axis.cells
    allowed = min(table.tolerance, COARSEST)
    if uniform:  # what it promises, but no more than its grid can need
        allowed = min(table.tolerance, _CEILING / cells**4 + _FLOOR)
    truth = "closed forms" if uniform else "quadrature"
    checks: list[Check] = []
    done, steps = 0, 5 if uniform else 3

    def step() -> None:
        nonlocal done
        done += 1
        if progress is not None:
            progress(done, steps)

    def compare(name: str, phi: FloatArray, delta: FloatArray, right: FloatArray) -> None:
        errors = np.stack(table.resultants(phi, delta)) - right
        checks.extend(compared(name, names, errors, phi, delta, allowed))
        step()

    phi, delta = adversarial_points(table, count, seed=None)
    compare(truth, phi, delta, _truth(table.law, phi, delta).T)
    nodes = table.axis.nodes()
    phi = nodes[:-1] + rng.random(nodes.size - 1) * np.diff(nodes)
    delta = table.delta_max * rng.random(phi.size)
    compare(f"{truth}, every cell", phi, delta, _truth(table.law, phi, delta).T)
    right = _truth(table.law, nodes[:, None], table.heights)
    phi, delta = (axis.ravel() for axis in np.broadcast_arrays(nodes[:, None], table.heights))
    errors = (table.values - right).reshape(-1, len(names)).T
    node = min(allowed, _NODE)
    checks += compared("every node", names, errors, phi, delta, node)
    step()
    if uniform:
        phi, delta = adversarial_points(table, min(count, 4000), seed=None)
        direct = moment_balance(quadrature.integrals(phi), slip_direction(phi), delta)
        compare("direct quadrature", phi, delta, np.stack(direct))
        phi, delta, entries = elementary_entries(np.linspace(0.0, 1.0, 101))
        compare("elementary entries", phi, delta, np.stack(entries))
        checks += _identities(table, rng, IDENTITY_FACTOR * allowed)
    return CheckReport(table.source, table.tolerance, tuple(checks))


def elementary_entries(delta: FloatArray) -> tuple[FloatArray, FloatArray, Resultants]:
    """The resultants under uniform pressure in elementary form at φ = 0, π/4, π/2.

    Parameters
    ----------
    delta : array (n,)

    Returns
    -------
    phi, delta, resultants : arrays (3 n,)

    References
    ----------
    Salnikova, Treschev, Gallyamov 2012, table 6.1.

    Examples
    --------
    >>> elementary_entries(np.array([1.0]))[2].parallel.round(6).tolist()
    [1.0, 1.18524, 0.9]
    """
    q = (45.0 * np.pi) ** 2 + (16.0 * delta) ** 2
    n = 9.0 + delta**2
    one = np.ones_like(delta)
    spin_quarter = 16.0 * np.sqrt(2.0) / (9.0 * np.pi) * ((45.0 * np.pi) ** 2 - 2048.0 * delta**2)
    rho = Resultants(
        np.concatenate([one, 5400.0 * np.sqrt(2.0) * np.pi / q, 9.0 / n]),
        np.concatenate([delta / 4.0, 7680.0 * delta / q, 3.0 * delta / n]),
        np.concatenate([(4.0 - delta**2) / 8.0, spin_quarter / q, 4.0 / 3.0 * one]),
    )
    return np.repeat([0.0, 0.25 * np.pi, 0.5 * np.pi], delta.size), np.tile(delta, 3), rho


def _identities(table: ResultantValues, rng: np.random.Generator, allowed: float) -> list[Check]:
    """Identities of full contact under uniform pressure, all from the table alone.

    With p_a = ρ_∥(φ, 0), p_d = ρ_ω(φ, 0)/2 and p_b = ρ_⊥/(δ ρ_∥):
    ρ_∥(φ, 0) = ρ_∥(π/2 − φ, 0);   p_a/ρ_∥ = 1 − δ² sin²φ p_b (p_b − p_d);
    ρ_ω/2 = p_d + δ² cos²φ ρ_∥ p_b (p_d − 2 p_b).
    """
    phi = rng.uniform(0.0, 0.5 * np.pi, 4000)
    delta = table.delta_max * rng.uniform(0.05, 1.0, 4000)
    rho = table.resultants(phi, delta)
    flat = table.resultants(phi, 0.0)
    p_a, p_d = flat.parallel, 0.5 * flat.spin
    p_b = rho.perpendicular / (delta * rho.parallel)
    sin2, cos2 = np.sin(phi) ** 2, np.cos(phi) ** 2
    mirrored = table.resultants(0.5 * np.pi - phi, 0.0).parallel
    balance = p_a / rho.parallel - 1.0 + delta**2 * sin2 * p_b * (p_b - p_d)
    turning = p_d + delta**2 * cos2 * rho.parallel * p_b * (p_d - 2.0 * p_b) - 0.5 * rho.spin
    return [
        *compared("identity p_a(phi) = p_a(pi/2 - phi)", ["parallel"], [p_a - mirrored], phi, delta,
                  allowed),
        *compared("identity pressure balance", ["perpendicular"], [balance], phi, delta, allowed),
        *compared("identity p_e = p_d - 2 p_b", ["spin"], [turning], phi, delta, allowed),
    ]  # fmt: skip

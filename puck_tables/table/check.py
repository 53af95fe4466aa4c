"""A table judged: by closed forms, direct quadrature, known entries and exact identities."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from puck_tables.contact import closed_form, quadrature
from puck_tables.contact.integrals import slip_direction
from puck_tables.contact.resultants import Resultants, moment_balance
from puck_tables.real import instance
from puck_tables.table.grid import PhiAxis
from puck_tables.table.table import FUNCTIONS, Accuracy, Table

FloatArray = npt.NDArray[np.float64]
Progress = Callable[[int, int], None]

# How many times the table's tolerance an identity between several of its values may be off: each
# value enters with its own error.
IDENTITY_FACTOR = 5.0
# largest error × (cells per side)⁴, twice what was measured, and the error of the nodes
_CEILING, _FINEST = 3.0, 1e-13


@dataclass(frozen=True)
class Check:
    """One line of a report: what was compared, the largest deviation, and what is allowed."""

    name: str
    function: str
    points: int
    deviation: float
    allowed: float
    at_phi: float
    at_delta: float

    @property
    def passed(self) -> bool:
        """Whether the deviation is a number within what is allowed."""
        return bool(self.deviation <= self.allowed)


@dataclass(frozen=True)
class CheckReport:
    """All checks of one table."""

    source: str
    tolerance: float
    checks: tuple[Check, ...]

    @property
    def passed(self) -> bool:
        """Whether every check passed."""
        return all(check.passed for check in self.checks)


def adversarial_points(
    phi_axis: PhiAxis, delta_max: float, random_points: int, seed: int | None
) -> tuple[FloatArray, FloatArray]:
    """Points where a table is worst: cell middles, ends, and both sides of 0, π/4, π/2.

    Parameters
    ----------
    phi_axis : the axis whose cells are probed
    delta_max : the largest δ
    random_points : how many uniform random points to add
    seed : of the random generator; None: other points at every call

    Returns
    -------
    phi, delta : arrays (n,)

    Examples
    --------
    >>> phi, delta = adversarial_points(PhiAxis(9), 1.0, 10, seed=1)
    >>> bool(np.abs(phi).min() == 0.0 and delta.max() == 1.0)
    True
    """
    rng = np.random.default_rng(seed)
    near = 10.0 ** -np.concatenate([np.linspace(0.5, 16.0, 63), [30.0, 100.0, 300.0]])
    near = near[near < 0.25 * np.pi]
    nodes = phi_axis.nodes()
    tau = phi_axis.tau()
    middles = 0.25 * np.pi + np.arctan(np.concatenate([0.5 * (tau[:-1] + tau[1:])]))
    special = np.concatenate([
        [0.0, 0.25 * np.pi, 0.5 * np.pi],
        near, 0.25 * np.pi - near, 0.25 * np.pi + near, 0.5 * np.pi - near,
        rng.choice(nodes, min(len(nodes), 4000), replace=False),
        rng.choice(middles, min(len(middles), 4000), replace=False),
    ])  # fmt: skip
    heights = delta_max * np.array([0.0, 5e-324, 1e-8, 0.1, 0.5, 0.9, 1.0 - 2.0**-53, 1.0])
    heights = np.append(heights, delta_max * rng.random(8))
    phi, delta = (grid.ravel() for grid in np.meshgrid(special, heights))
    signs = rng.choice([-1.0, 1.0], phi.size)
    return (
        np.concatenate([signs * phi, rng.uniform(-0.5 * np.pi, 0.5 * np.pi, random_points)]),
        np.concatenate([delta, delta_max * rng.random(random_points)]),
    )


def in_every_cell(
    phi: FloatArray, delta: FloatArray, rng: np.random.Generator, most: int = 20_000
) -> tuple[FloatArray, FloatArray]:
    """Points in all cells of a grid: the nodes, and one at a random place in each cell.

    Parameters
    ----------
    phi, delta : arrays (n,), (m,), ascending nodes
    rng : random generator
    most : how many of each kind are taken, at random, where there are more

    Returns
    -------
    phi, delta : arrays (k,)

    Examples
    --------
    >>> axis = np.array([0.0, 0.5, 1.0])
    >>> in_every_cell(axis, axis, np.random.default_rng(1))[0].size  # 9 nodes, 4 cells
    13
    """
    points = []
    for inner in (0, 1):
        rows, columns = phi.size - inner, delta.size - inner
        chosen = np.arange(rows * columns)
        if chosen.size > most:
            chosen = rng.choice(chosen, most, replace=False)
        row, column = np.divmod(chosen, columns)
        share = rng.random((2, chosen.size)) * inner
        points.append((
            phi[row] + share[0] * (phi[row + inner] - phi[row]),
            delta[column] + share[1] * (delta[column + inner] - delta[column]),
        ))  # fmt: skip
    nodes, inside = points
    return np.concatenate([nodes[0], inside[0]]), np.concatenate([nodes[1], inside[1]])


def by_closed_form(phi: npt.ArrayLike, delta: npt.ArrayLike) -> Resultants:
    """Resultants by elliptic integrals, uncompiled.

    Examples
    --------
    >>> float(by_closed_form(0.0, 1.0).spin)
    0.375
    """
    return moment_balance(closed_form.integrals(phi), slip_direction(phi), delta)


def by_quadrature(phi: npt.ArrayLike, delta: npt.ArrayLike) -> Resultants:
    """Resultants by direct quadrature.

    Examples
    --------
    >>> float(by_quadrature(0.0, 1.0).spin.round(14))
    0.375
    """
    return moment_balance(quadrature.integrals(phi), slip_direction(phi), delta)


def known_entries(delta: FloatArray) -> tuple[FloatArray, FloatArray, Resultants]:
    """The resultants in elementary form at φ = 0, π/4, π/2.

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
    >>> known_entries(np.array([1.0]))[2].parallel.round(6).tolist()
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


def measure(table: Table, half: Table | None = None) -> Accuracy:
    """The errors of a table against the closed forms.

    Parameters
    ----------
    table : Table
    half : Table, optional
        A table with half as many cells in φ; gives the order.

    Returns
    -------
    Accuracy

    Examples
    --------
    >>> from puck_tables import load_table
    >>> measure(load_table()).worst < 5e-9
    True
    """
    upper = table.delta_axis.upper
    phi, delta = adversarial_points(table.phi_axis, upper, 40_000, seed=2012)
    truth = by_closed_form(phi, delta)
    error = np.abs(np.stack(table.resultants(phi, delta)) - np.stack(truth))
    where = error.argmax(axis=1)
    entry_phi, entry_delta, entries = known_entries(table.delta_axis.nodes())
    residual = np.abs(np.stack(table.resultants(entry_phi, entry_delta)) - np.stack(entries))
    order = 0.0
    if half is not None:
        half_error = np.abs(np.stack(half.resultants(phi, delta)) - np.stack(truth))
        ratio = table.phi_axis.cells_per_side / half.phi_axis.cells_per_side
        order = float(np.log(half_error.max() / error.max()) / np.log(ratio))
    return Accuracy(
        largest=tuple(error.max(axis=1).tolist()),
        rms=tuple(np.sqrt((error**2).mean(axis=1)).tolist()),
        p999=tuple(np.quantile(error, 0.999, axis=1).tolist()),
        at_phi=tuple(phi[where].tolist()),
        at_delta=tuple(delta[where].tolist()),
        entry_residual=float(residual.max()),
        order=order,
        points=phi.size,
    )


def validate(
    table: Table, progress: Progress | None = None, random_points: int = 4000
) -> CheckReport:
    """Judge a table by truths that share no code with it.

    Parameters
    ----------
    table : Table
    progress : callable (done, total), optional
    random_points : int
        Number of random points for the comparison with direct quadrature.

    Notes
    -----
    The points are other ones at every call, and one at least lies in every cell of φ.  What is
    allowed is what the table promises, but no more than its grid can need.

    Returns
    -------
    CheckReport
        Deviations from direct quadrature and closed forms at random and adversarial points, from
        the elementary entries, and of the exact identities between the tabulated functions; each
        against the table's own tolerance.

    Identities of full contact under uniform pressure, all from the table alone, with
    p_a = ρ_∥(φ, 0), p_d = ρ_ω(φ, 0)/2 and p_b = ρ_⊥/(δ ρ_∥):
    ρ_∥(φ, 0) = ρ_∥(π/2 − φ, 0);   p_a/ρ_∥ = 1 − δ² sin²φ p_b (p_b − p_d);
    ρ_ω/2 = p_d + δ² cos²φ ρ_∥ p_b (p_d − 2 p_b).

    Examples
    --------
    >>> from puck_tables import load_table
    >>> validate(load_table(), random_points=50).passed
    True
    """
    instance("table", table, Table)
    upper = table.delta_axis.upper
    checks: list[Check] = []
    steps = 5 + -(-random_points // 500)
    done = 0

    def step() -> None:
        nonlocal done
        done += 1
        if progress is not None:
            progress(done, steps)

    def compare(
        name: str, phi: FloatArray, delta: FloatArray, truth: Resultants, allowed: float
    ) -> None:
        error = np.abs(np.stack(table.resultants(phi, delta)) - np.stack(truth))
        for function, row in zip(FUNCTIONS, error, strict=True):
            checks.append(worst_of(name, function, row, phi, delta, allowed))

    rng = np.random.default_rng()
    allowed = min(table.tolerance, _CEILING / table.phi_axis.cells_per_side**4 + _FINEST)
    edge, _ = adversarial_points(table.phi_axis, upper, 0, seed=None)
    phi = np.concatenate([
        rng.uniform(-0.5 * np.pi, 0.5 * np.pi, random_points // 2),
        rng.choice(edge, random_points - random_points // 2),
    ])  # fmt: skip
    delta = upper * rng.random(random_points)
    delta[::10] = upper
    parts = []
    for start in range(0, random_points, 500):
        part = slice(start, start + 500)
        parts.append(np.stack(by_quadrature(phi[part], delta[part])))
        step()
    compare("direct quadrature", phi, delta, Resultants(*np.concatenate(parts, axis=1)), allowed)
    step()

    phi, delta = adversarial_points(table.phi_axis, upper, 40_000, seed=None)
    compare("closed forms", phi, delta, by_closed_form(phi, delta), allowed)
    step()
    phi, delta = in_every_cell(table.phi_axis.nodes(), table.delta_axis.nodes(), rng)
    compare("closed forms, every cell", phi, delta, by_closed_form(phi, delta), allowed)
    step()
    entry_phi, entry_delta, entries = known_entries(upper * np.linspace(0.0, 1.0, 101))
    compare("elementary entries", entry_phi, entry_delta, entries, allowed)
    step()
    checks.extend(_identities(table, rng, IDENTITY_FACTOR * allowed))
    step()
    return CheckReport(table.source, table.tolerance, tuple(checks))


def _identities(table: Table, rng: np.random.Generator, allowed: float) -> list[Check]:
    phi = rng.uniform(0.0, 0.5 * np.pi, 4000)
    delta = table.delta_axis.upper * rng.uniform(0.05, 1.0, 4000)
    rho = table.resultants(phi, delta)
    flat = table.resultants(phi, 0.0)
    p_a, p_d = flat.parallel, 0.5 * flat.spin
    p_b = rho.perpendicular / (delta * rho.parallel)
    sin2, cos2 = np.sin(phi) ** 2, np.cos(phi) ** 2
    mirrored = table.resultants(0.5 * np.pi - phi, 0.0).parallel
    balance = p_a / rho.parallel - 1.0 + delta**2 * sin2 * p_b * (p_b - p_d)
    turning = p_d + delta**2 * cos2 * rho.parallel * p_b * (p_d - 2.0 * p_b) - 0.5 * rho.spin
    return [
        worst_of(f"identity {name}", function, np.abs(residual), phi, delta, allowed)
        for name, function, residual in (
            ("p_a(phi) = p_a(pi/2 - phi)", "parallel", p_a - mirrored),
            ("pressure balance", "perpendicular", balance),
            ("p_e = p_d - 2 p_b", "spin", turning),
        )
    ]


def worst_of(
    name: str, function: str, error: FloatArray, phi: FloatArray, delta: FloatArray, allowed: float
) -> Check:
    """The line of a report for errors at points: the largest, and where it stands; NaN is largest.

    Examples
    --------
    >>> places = np.array([0.1, 0.2])
    >>> worst_of("rule", "spin", np.array([1e-9, 1e-7]), places, places, 1e-8).passed
    False
    """
    worst = int(np.argmax(np.where(np.isnan(error), np.inf, error)))
    return Check(
        name, function, error.size, float(error[worst]), allowed,
        float(phi[worst]), float(delta[worst]),
    )  # fmt: skip

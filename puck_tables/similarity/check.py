"""A stop table judged: by the integrator, by the equations it satisfies, by elementary values.

The equations.  On the way from a to b along a motion, with ln Q as in
:mod:`puck_tables.similarity.curve`,

    T(a) = ∫ Q/Q_a · N/(ρ_∥ ρ) du + (Q_b/Q_a) T(b)
    Z(a) = ∫ (Q/Q_a)² cos φ e^{i(ψ − ψ_a)} N/(ρ_∥ ρ) du + (Q_b/Q_a)² e^{i(ψ_b − ψ_a)} Z(b)

with Z = X + iY: the integrals of the linear differential equations of T and Z, with nothing to
differentiate.  They are taken with resultants by direct quadrature over the patch, which share no
code with the closed forms that the table was built from.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import numpy.typing as npt
from numpy.polynomial import chebyshev

from puck_tables.contact import quadrature
from puck_tables.contact.integrals import slip_direction
from puck_tables.contact.resultants import moment_balance
from puck_tables.kernels.spline import basis
from puck_tables.motion.limits import limit_ratio
from puck_tables.real import instance
from puck_tables.similarity.axes import HEIGHTS, SlipAxis, heights, ratio_at
from puck_tables.similarity.curve import limits, regular_parts
from puck_tables.similarity.curve_lookup import (
    BODY,
    CURVE_SUM,
    HEADING,
    KAPPA,
    LENGTH,
    LOG_N,
    T_LAUNCH,
    TURN_SUM,
    TURNING,
)
from puck_tables.similarity.exact import exact_stops
from puck_tables.similarity.lookup import CURVE_ROW
from puck_tables.similarity.node_equations import all_slopes, missed_by_curve, missed_by_stops
from puck_tables.similarity.stop_table import StopAccuracy, StopTable
from puck_tables.table.check import Check, CheckReport

FloatArray = npt.NDArray[np.float64]
Progress = Callable[[int, int], None]

NAMES = ("time", "x", "y", "path", "body", "curve", "turn")
_RANDOM, _CURVE_HEIGHTS = 1500, (0.0, 0.05, 0.3, 0.62, 0.9, 0.99, 1.0)
_REFINED = 3
_NODES = chebyshev.chebpts1(14)
# How many times the tolerance an equation between several values may be off.
EQUATION_FACTOR = 4.0
# largest error × cells⁴ of stops and of the curve, about twice what was measured, and the errors of
# the polynomials in δ²
_CEILING, _POLYNOMIAL = 1.6, 5e-12
_CURVE_CEILING, _CURVE_POLYNOMIAL = 10.0, 2e-10


def launch_points(
    axis: SlipAxis, random_points: int, seed: int | None
) -> tuple[FloatArray, FloatArray]:
    """Launches (u, δ) where a stop table is worst: cell middles, ends, both sides of π/4.

    Examples
    --------
    >>> u, delta = launch_points(SlipAxis(8), 10, seed=1)
    >>> bool(np.isinf(u).any()), float(delta.max())
    (True, 1.0)
    """
    rng = np.random.default_rng(seed)
    middle = (np.arange(axis.cells) + 0.5) / axis.cells
    q4 = (middle * (2.0 - middle)) ** 4
    middles = np.log(q4 / (2.0 - q4))
    near = 10.0 ** -np.arange(0.5, 16.5)
    u = np.concatenate([
        [-math.inf, -700.0, 0.0, 700.0, math.inf],
        near, -near, np.log(near), -np.log(near),
        *(sign * rng.choice(middles, min(axis.cells, 200), replace=False) for sign in (1.0, -1.0)),
        rng.normal(scale=2.0, size=random_points // 2),
        rng.choice([-1.0, 1.0], random_points // 2)
        * np.exp(rng.uniform(-12.0, 4.0, random_points // 2)),
    ])  # fmt: skip
    special = np.array([0.0, 1e-9, 0.02, 0.5, 0.98, 1.0 - 2.0**-53, 1.0])
    delta = np.where(rng.random(u.size) < 0.4, rng.choice(special, u.size), rng.random(u.size))
    delta[:2] = 0.0, 1.0
    return u, delta


def launches_at(u: FloatArray, delta: FloatArray) -> FloatArray:
    """Launches (6, n) along x with Q = J = r = 1.

    Examples
    --------
    >>> launches_at(np.array([0.0]), np.array([0.5])).round(3).ravel().tolist()
    [0.707, 0.0, 0.707, 0.5, 1.0, 1.0]
    """
    k = np.exp(-np.abs(u))
    large = 1.0 / np.hypot(1.0, k)
    one = np.ones_like(k)
    cosine = np.where(u > 0.0, k, 1.0) * large
    sine = np.where(u > 0.0, 1.0, k) * large
    return np.stack([cosine, 0.0 * k, sine, delta, one, one])


def looked_up(table: StopTable, u: FloatArray, delta: FloatArray) -> FloatArray:
    """T, X, Y, path length and body angle as the table gives them, (n, 5).

    Examples
    --------
    >>> from puck_tables import load_stop_table
    >>> looked_up(load_stop_table(), np.array([0.0]), np.array([1.0])).round(8).tolist()[0][:3]
    [0.98647594, 0.32409373, -0.04297451]
    """
    launches = launches_at(u, delta)
    stops, _ = table.stops(launches)
    known = table.known(launches)
    return np.concatenate([stops, known[LENGTH : BODY + 1]]).T


def measure(table: StopTable, half: StopTable | None) -> StopAccuracy:
    """Errors of a table against the integrator and, for the curve, against quadrature.

    Examples
    --------
    >>> from puck_tables.similarity.build import tabulate
    >>> measure(tabulate(SlipAxis(16)), None).worst < 2e-5
    True
    """
    u, delta = launch_points(table.axis, _RANDOM, seed=20)
    reference = exact_stops(u, delta)
    error = np.abs(looked_up(table, u, delta) - reference)
    phi = np.arctan(np.exp(np.minimum(u, 700.0)))
    largest, rms, at_phi, at_delta = [], [], [], []
    for column in error.T:
        worst = int(np.argmax(np.where(np.isnan(column), np.inf, column)))
        largest.append(float(column[worst]))
        rms.append(float(np.sqrt(np.mean(column**2))))
        at_phi.append(float(phi[worst]))
        at_delta.append(float(delta[worst]))
    between = SlipAxis(_REFINED * table.axis.cells)
    for function, factor in ((CURVE_SUM, True), (TURN_SUM, False)):
        deviation = np.stack(
            [
                np.abs(
                    _curve_between(table, function, d)
                    - regular_parts(between, d)[:, 0 if factor else 1]
                    * (limits(d).kappa if factor else 1.0)
                )
                for d in _CURVE_HEIGHTS
            ]
        )
        height, node = np.unravel_index(int(np.argmax(deviation)), deviation.shape)
        largest.append(float(deviation.max()))
        rms.append(float(np.sqrt(np.mean(deviation**2))))
        at_phi.append(float(between.phi()[node]))
        at_delta.append(_CURVE_HEIGHTS[height])
    order = 0.0  # not measured
    if half is not None:
        coarse = np.abs(looked_up(half, u, delta) - reference)[:, 0].max()
        order = math.log2(coarse / largest[0])
    return StopAccuracy(tuple(largest), tuple(rms), tuple(at_phi), tuple(at_delta), order, u.size)


def _curve_between(table: StopTable, function: int, delta: float) -> FloatArray:
    """κR or S at the nodes of an axis three times as fine, as the table's splines give them."""
    c = table.curve_coefficients.reshape(2, -1, CURVE_ROW)[:, :, function * HEIGHTS :][
        :, :, :HEIGHTS
    ]
    at_height = c @ (2.0 * delta**2 - 1.0) ** np.arange(HEIGHTS)
    n = table.axis.cells
    sides = np.empty((2, _REFINED * n + 1))
    for part in range(_REFINED):
        weights = basis(part / _REFINED)
        sides[:, part:-1:_REFINED] = sum(w * at_height[:, j : n + j] for j, w in enumerate(weights))
    sides[:, -1] = sum(w * at_height[:, n - 1 + j] for j, w in enumerate(basis(1.0)))
    values = np.concatenate([sides[0], sides[1, -2::-1]])
    return values * (delta if function == TURN_SUM else 1.0)


def validate_stops(table: StopTable, progress: Progress | None = None) -> CheckReport:
    """Judge a stop table by independent routes.

    Parameters
    ----------
    table : StopTable
    progress : callable (done, total), optional

    Returns
    -------
    CheckReport
        Against the integrator with closed forms, in every cell of slip and at points that are other
        ones at every call; against the equations that T, X + iY, ln Q and
        ψ satisfy, with resultants by direct quadrature; against elementary values at φ = 0, π/2
        and at the limit angle.

    Examples
    --------
    >>> from puck_tables import load_stop_table
    >>> validate_stops(load_stop_table()).passed
    True
    """
    instance("table", table, StopTable)

    def step(done: int) -> None:
        if progress is not None:
            progress(done, 3)

    rng = np.random.default_rng()
    cells = table.axis.cells
    allowed = min(table.tolerance, _CEILING / cells**4 + _POLYNOMIAL)
    checks = []
    for route, (u, delta) in (
        ("integrator", launch_points(table.axis, 750, seed=None)),
        ("integrator, every cell", _in_every_cell(table.axis, rng)),
    ):
        error = np.abs(looked_up(table, u, delta) - exact_stops(u, delta))
        checks += [
            _check(route, name, column, u, delta, allowed)
            for name, column in zip(NAMES, error.T, strict=False)
        ]
    step(1)
    checks += _equations(table, rng, 400, allowed, _CURVE_CEILING / cells**4 + _CURVE_POLYNOMIAL)
    checks += _at_nodes(table)
    step(2)
    checks += _elementary(table, allowed)
    step(3)
    return CheckReport(table.source, table.tolerance, tuple(checks))


def _equations(
    table: StopTable, rng: np.random.Generator, count: int, allowed: float, by_curve: float
) -> list[Check]:
    delta = rng.random(count)
    start = rng.choice([-1.0, 1.0], count) * np.exp(rng.uniform(-9.0, 3.5, count))
    limit = np.array([limits(float(d)).u for d in delta])
    # towards the limit, far from its pole and from the singularity at u = 0
    start = np.where(np.abs(start - limit) < 0.02, limit + 0.02, start)
    reach = np.minimum(np.minimum(0.4 * np.abs(start), 0.3 * np.abs(start - limit)), 0.4)
    end = start + np.sign(limit - start) * reach * rng.random(count)
    middle, half = 0.5 * (start + end), 0.5 * (end - start)
    u = middle + half * _NODES[:, None]
    phi = np.arctan(np.exp(u))
    direction = slip_direction(phi)
    rho = moment_balance(quadrature.integrals(phi), direction, delta)
    cos2, sin2 = direction.cos_squared, direction.sin_squared
    spin = rho.spin / rho.parallel
    norm = 1.0 / (cos2 + sin2 * spin)
    rate = (1.0 - spin) * norm
    turn = np.sqrt(sin2) * rho.perpendicular / rho.parallel * norm
    log_q = -half * _integrals(1.0 / rate)
    psi = -half * _integrals(turn / rate)
    q, end_q = np.exp(log_q[:-1]), np.exp(log_q[-1])
    way = q * norm / (rho.parallel * rate)
    time = half * _integrals(way)[-1]
    place = half * _integrals(q * way * np.sqrt(cos2) * np.exp(1j * psi[:-1]))[-1]
    first, last = looked_up(table, start, delta), looked_up(table, end, delta)
    turned = np.exp(1j * psi[-1])
    rest_time = first[:, 0] - time - end_q * last[:, 0]
    rest_place = (
        first[:, 1] + 1j * first[:, 2] - place
        - end_q**2 * turned * (last[:, 1] + 1j * last[:, 2])
    )  # fmt: skip
    curve = _along_curve(table, end, delta) - _along_curve(table, start, delta)
    return [
        _check("equation", name, np.abs(residual), start, delta, EQUATION_FACTOR * most)
        for name, residual, most in (
            ("time", rest_time, allowed),
            ("x", rest_place.real, allowed),
            ("y", rest_place.imag, allowed),
            ("curve", curve[0] - log_q[-1], by_curve),
            ("turn", curve[1] - psi[-1], by_curve),
        )
    ]  # fmt: skip


def _in_every_cell(axis: SlipAxis, rng: np.random.Generator) -> tuple[FloatArray, FloatArray]:
    """Two launches (u, δ) in every cell of slip, one of them at a height of the table."""
    shape = 4, axis.cells
    xi = (np.arange(axis.cells) + rng.random(shape)) / axis.cells
    u = np.log(ratio_at(xi)) * np.array([[1.0], [-1.0], [1.0], [-1.0]])
    delta = rng.random(shape)
    delta[2:] = rng.choice(heights(), shape)[2:]
    return u.ravel(), delta.ravel()


def _at_nodes(table: StopTable) -> list[Check]:
    """All node values in the equations they satisfy, see ``node_equations``."""
    axis = table.axis
    slow = np.log(np.maximum(ratio_at(np.arange(axis.cells + 1) / axis.cells), 1e-300))
    u, delta = np.broadcast_arrays(np.stack([slow, -slow])[..., None], heights())
    missed, allowed = missed_by_stops(axis, table.values)
    of_curve = [missed_by_curve(axis, table.values, j, all_slopes) for j in range(HEIGHTS)]
    by_curve, allowed_curve = np.stack([one for one, _ in of_curve], axis=2), of_curve[0][1]
    columns = [(missed[..., i], allowed) for i in range(5)]
    columns += [(by_curve[..., i], allowed_curve) for i in range(2)]
    return [
        _check("equation, every node", name, error.ravel(), u.ravel(), delta.ravel(), most)
        for name, (error, most) in zip(NAMES, columns, strict=True)
    ]


def _along_curve(table: StopTable, u: FloatArray, delta: FloatArray) -> FloatArray:
    """Ln Q and ψ by the table, each up to a function of δ, (2, n)."""
    known = table.known(launches_at(u, delta))
    log_q = known[LOG_N] / known[KAPPA] - np.log(known[T_LAUNCH])
    return np.stack([log_q, known[TURNING] * log_q + known[HEADING]])


def _integrals(values: npt.NDArray[np.inexact]) -> npt.NDArray[np.inexact]:
    """Integrals from −1 to each Chebyshev node and to 1, along axis 0."""
    series = chebyshev.chebfit(_NODES, values, len(_NODES) - 1)
    primitive = chebyshev.chebint(series, lbnd=-1.0)
    return chebyshev.chebval(np.append(_NODES, 1.0), primitive).T


def _elementary(table: StopTable, allowed: float) -> list[Check]:
    """T, X, path and body angle of pure sliding and pure spin; T and X + iY of the limit motion."""
    delta = np.linspace(0.0, 1.0, 41)
    checks = []
    for u, values in (
        (-math.inf, (1.0, 0.5, 0.0, 0.5, 0.0)),
        (math.inf, (0.75, 0.0, 0.0, 0.0, 0.375)),
    ):
        at = np.full_like(delta, u)
        error = np.abs(looked_up(table, at, delta) - values)
        checks += [
            _check("pure motion", name, column, at, delta, 0.0)
            for name, column in zip(NAMES, error.T, strict=False)
        ]
    u0 = np.log(limit_ratio(delta))
    phi = np.arctan(np.exp(u0))
    rho = moment_balance(quadrature.integrals(phi), slip_direction(phi), delta)
    turning = np.sin(phi) * rho.perpendicular / rho.parallel
    spiral = np.cos(phi) / (rho.parallel * (2.0 + 1j * turning))
    got = looked_up(table, u0, delta)
    for column, name, value in (
        (0, "time", 1.0 / rho.parallel), (1, "x", spiral.real), (2, "y", spiral.imag),
    ):  # fmt: skip
        error = np.abs(got[:, column] - value)
        checks.append(_check("limit motion", name, error, u0, delta, allowed))
    return checks


def _check(
    route: str, name: str, error: FloatArray, u: FloatArray, delta: FloatArray, allowed: float
) -> Check:
    worst = int(np.argmax(np.where(np.isnan(error), np.inf, error)))
    phi = math.atan(math.exp(min(float(u[worst]), 700.0)))
    return Check(route, name, error.size, float(error[worst]), allowed, phi, float(delta[worst]))

"""A stop table built, measured and judged.

Node values are stops integrated one by one to rounding, not solutions of the linear equations that
T and X + iY satisfy: the integrator exists, reaches 1e-15 with closed forms at a local tolerance of
2e-14, and leaves those equations to judge by.

The equations.  On the way from a to b along a motion, with ln Q as in
:mod:`puck_tables.stopping.similarity`,

    T(a) = ∫ Q/Q_a · N/(ρ_∥ ρ) du + (Q_b/Q_a) T(b)
    Z(a) = ∫ (Q/Q_a)² cos φ e^{i(ψ − ψ_a)} N/(ρ_∥ ρ) du + (Q_b/Q_a)² e^{i(ψ_b − ψ_a)} Z(b)

with Z = X + iY: the integrals of the linear differential equations of T and Z, with nothing to
differentiate.  They are taken with resultants by direct quadrature over the patch, which share no
code with the closed forms that the table was built from.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TypeVar

import numpy as np
import numpy.typing as npt
from numpy.polynomial import chebyshev

from puck_tables._core.arrays import FloatArray
from puck_tables._core.executor import run_chunks
from puck_tables._core.waiting import Progress
from puck_tables.contact import quadrature
from puck_tables.contact.closed_form import moment_balance
from puck_tables.contact.integrals import slip_direction
from puck_tables.contact.laws import law_of
from puck_tables.kernels.quadratic import basis
from puck_tables.motion.limits import limit_ratio
from puck_tables.motion.unit_motion import direction
from puck_tables.stopping.exact import exact_stops
from puck_tables.stopping.launch_arrays import launches_in
from puck_tables.stopping.lookup import HEIGHTS, SlipAxis, heights, ratio_at
from puck_tables.stopping.similarity import limits, regular_parts
from puck_tables.stopping.similarity_lookup import (
    BODY,
    HEADING0,
    KAPPA,
    LENGTH,
    LOG_FUNCTION,
    LOG_N,
    MOTION_WIDTH,
    T_LAUNCH,
    TURN_FUNCTION,
    TURNING,
)
from puck_tables.stopping.stop_section import end_values
from puck_tables.stopping.stop_values import STOPS, StopValues
from puck_tables.table.build import Goal, built
from puck_tables.table.check import Accuracy, Check, CheckReport, compared
from puck_tables.table.friction_section import friction_ratios

_GOAL = Goal(1e-10, 1e-11, "in units of Q/(f g) and Q^2/(f g)", 0.62, 1 << 12)
_CHUNK = 64  # launches at once, of integrations
K = TypeVar("K", bound=StopValues)  # the kind that is made
NAMES = StopValues.quantities
# launches drawn; heights, both ends and between nodes
_RANDOM, _MOTION_HEIGHTS = 1500, (0.0, 0.05, 0.3, 0.62, 0.9, 0.99, 1.0)
_MOTIONS = 400  # on which the equations are judged, each by 14 quadratures of friction
_REFINED = 3  # places looked at in a cell
_NODES = chebyshev.chebpts1(14)
# How many times the tolerance an equation between several values may be off.
EQUATION_FACTOR = 4.0
# largest error × cells⁴ of stops and of the curve, about twice what was measured, and the errors of
# the polynomials in δ²
_CEILING, _POLYNOMIAL = 1.6, 5e-12
_MOTION_CEILING, _MOTION_POLYNOMIAL = 10.0, 2e-10  # of the curve


def launch_points(
    axis: SlipAxis, random_points: int, seed: int | None
) -> tuple[FloatArray, FloatArray]:
    """Launches (u, δ) where a stop table is worst: cell middles, ends, both sides of π/4."""
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
    """Launches (6, n) along x with Q = J = r = 1."""
    (cosine, sine), one = direction(u), np.ones_like(u)
    return np.stack([cosine, 0.0 * one, sine, delta, one, one])


def looked_up(table: StopValues, u: FloatArray, delta: FloatArray) -> FloatArray:
    """T, X, Y, path length and body angle as the table gives them, (n, 5).

    >>> from puck_tables import Table
    >>> looked_up(Table.shipped("stops"), np.array([0.0]), np.array([1.0])).round(8).tolist()[0][:3]
    [0.98647594, 0.32409373, -0.04297451]
    """
    launches = launches_at(u, delta)
    time, place, _, _ = table.stops(launches_in(launches))
    known = table.known(launches)
    return np.concatenate([time[None], place.T, known[LENGTH : BODY + 1]]).T


def tabulated(
    kind: type[K],
    accuracy: float | None = None,
    cells: int | None = None,
    progress: Progress | None = None,
) -> K:
    """A table of stops, see :meth:`puck_tables.Table.build`."""
    return built(lambda n: tabulate(kind, SlipAxis(n), progress), measured, _GOAL, accuracy, cells)


def tabulate(kind: type[K], axis: SlipAxis, progress: Progress | None = None) -> K:
    """The node values of a stop table, without a measured accuracy.

    >>> from puck_tables.stopping.stop_table import StopTable
    >>> tabulate(StopTable, SlipAxis(8)).values[8, :, 0].round(6).tolist()[::4]  # T at π/4
    [0.948026, 0.967044, 0.98618]
    """
    delta = heights()
    log_k = np.log(axis.ratio()[1:])
    inner = np.concatenate([log_k, -log_k[-2::-1]])  # all nodes but the two ends
    u, height = (grid.ravel() for grid in np.meshgrid(inner, delta, indexing="ij"))
    stops = np.empty((u.size, 5))

    def work(start: int, stop: int) -> None:
        stops[start:stop] = exact_stops(u[start:stop], height[start:stop])

    run_chunks(work, u.size, _CHUNK, None, progress)
    shaped = stops.reshape(inner.size, HEIGHTS, 5)
    values = np.empty((axis.size, HEIGHTS, len(StopValues.functions)))
    cosine, sine = direction(inner[:, None])
    values[1:-1, :, 0] = shaped[:, :, 0]
    values[1:-1, :, 1] = shaped[:, :, 1] / cosine
    values[1:-1, :, 2] = shaped[:, :, 2] / (delta * sine * cosine)
    values[1:-1, :, 3] = shaped[:, :, 3] / cosine
    values[1:-1, :, 4] = shaped[:, :, 4] / sine
    law, ends = law_of("uniform"), np.array([0.0, 0.5 * np.pi])
    for j, one in enumerate(delta):
        at_ends = end_values(friction_ratios(law, ends, float(one)), 0.5)[:, :STOPS]
        values[[0, -1], j, :STOPS] = at_ends / [1.0, 1.0, one, 1.0, 1.0]
        parts = regular_parts(axis, float(one))
        values[:, j, 5] = limits(float(one)).kappa * parts[:, 0]
        values[:, j, 6] = parts[:, 1] / one
    return kind(values)


def measured(table: StopValues) -> Accuracy:
    """Errors of a table against the integrator and, for the curve, against quadrature.

    >>> from puck_tables.stopping.stop_table import StopTable
    >>> measured(tabulate(StopTable, SlipAxis(16))).worst < 2e-5
    True
    """
    u, delta = launch_points(table.axis, _RANDOM, seed=20)
    reference = exact_stops(u, delta)
    coarse = None
    if table.axis.cells % 2 == 0 and table.axis.cells >= 16:
        half = looked_up(replace(table, values=table.values[::2]), u, delta)
        coarse = np.abs(half - reference)[:, :1].T
    phi = np.arctan(np.exp(np.minimum(u, 700.0)))
    errors = np.abs(looked_up(table, u, delta) - reference).T
    stops = Accuracy.of(errors, phi, delta, None)
    between = SlipAxis(_REFINED * table.axis.cells)
    deviation = np.empty((2, len(_MOTION_HEIGHTS), between.size))
    for row, one in enumerate(_MOTION_HEIGHTS):
        parts = regular_parts(between, one)
        deviation[0, row] = (
            _similarity_between(table, LOG_FUNCTION, one) - limits(one).kappa * parts[:, 0]
        )
        deviation[1, row] = _similarity_between(table, TURN_FUNCTION, one) - parts[:, 1]
    nodes, height = np.broadcast_arrays(between.phi(), np.array(_MOTION_HEIGHTS)[:, None])
    accuracy = Accuracy.of(np.abs(deviation).reshape(2, -1), nodes.ravel(), height.ravel(), None)
    both = {
        field: getattr(stops, field) + getattr(accuracy, field)
        for field in ("largest", "rms", "p999", "at_phi", "at_second")
    }
    order = 0.0 if coarse is None else math.log2(coarse.max() / stops.largest[0])
    return replace(stops, **both, order=order)


def _similarity_between(table: StopValues, function: int, delta: float) -> FloatArray:
    """κR or S at the nodes of an axis three times as fine, as the table's splines give them."""
    c = table.launch_coefficients.reshape(2, -1, HEIGHTS, MOTION_WIDTH)[..., function]
    at_height = c @ (2.0 * delta**2 - 1.0) ** np.arange(HEIGHTS)
    n = table.axis.cells
    sides = np.empty((2, _REFINED * n + 1))
    for part in range(_REFINED):
        weights = basis(part / _REFINED)
        sides[:, part:-1:_REFINED] = sum(w * at_height[:, j : n + j] for j, w in enumerate(weights))
    sides[:, -1] = sum(w * at_height[:, n - 1 + j] for j, w in enumerate(basis(1.0)))
    values = np.concatenate([sides[0], sides[1, -2::-1]])
    return values * (delta if function == TURN_FUNCTION else 1.0)


def judged(table: StopValues, progress: Progress | None) -> CheckReport:
    """The report of :meth:`StopTable.validate`."""

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
        errors = (looked_up(table, u, delta) - exact_stops(u, delta)).T
        checks += _checks(route, NAMES[:STOPS], errors, u, delta, allowed)
    step(1)
    of_functions = _MOTION_CEILING / cells**4 + _MOTION_POLYNOMIAL
    checks += _equations(table, rng, allowed, of_functions) + _at_nodes(table, of_functions)
    step(2)
    checks += _elementary(table, allowed)
    step(3)
    return CheckReport(table.source, table.tolerance, tuple(checks))


def _equations(
    table: StopValues, rng: np.random.Generator, allowed: float, by_similarity: float
) -> list[Check]:
    delta = rng.random(_MOTIONS)
    start = rng.choice([-1.0, 1.0], _MOTIONS) * np.exp(rng.uniform(-9.0, 3.5, _MOTIONS))
    limit = np.array([limits(float(d)).u for d in delta])
    # towards the limit, far from its pole and from the singularity at u = 0
    start = np.where(np.abs(start - limit) < 0.02, limit + 0.02, start)
    reach = np.minimum(np.minimum(0.4 * np.abs(start), 0.3 * np.abs(start - limit)), 0.4)
    end = start + np.sign(limit - start) * reach * rng.random(_MOTIONS)
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
    duration = q * norm / (rho.parallel * rate)
    time = half * _integrals(duration)[-1]
    place = half * _integrals(q * duration * np.sqrt(cos2) * np.exp(1j * psi[:-1]))[-1]
    first, last = looked_up(table, start, delta), looked_up(table, end, delta)
    turned = np.exp(1j * psi[-1])
    rest_time = first[:, 0] - time - end_q * last[:, 0]
    rest_place = (
        first[:, 1] + 1j * first[:, 2] - place
        - end_q**2 * turned * (last[:, 1] + 1j * last[:, 2])
    )  # fmt: skip
    along = _along_motion(table, end, delta) - _along_motion(table, start, delta)
    stops = np.stack([rest_time, rest_place.real, rest_place.imag])
    rises = np.stack([along[0] - log_q[-1], along[1] - psi[-1]])
    return [
        *_checks("equation", NAMES[:3], stops, start, delta, EQUATION_FACTOR * allowed),
        *_checks("equation", NAMES[STOPS:], rises, start, delta, EQUATION_FACTOR * by_similarity),
    ]


def _in_every_cell(axis: SlipAxis, rng: np.random.Generator) -> tuple[FloatArray, FloatArray]:
    """Two launches (u, δ) in every cell of slip, one of them at a height of the table."""
    shape = 4, axis.cells
    xi = (np.arange(axis.cells) + rng.random(shape)) / axis.cells
    u = np.log(ratio_at(xi)) * np.array([[1.0], [-1.0], [1.0], [-1.0]])
    delta = rng.random(shape)
    delta[2:] = rng.choice(heights(), shape)[2:]
    return u.ravel(), delta.ravel()


def _at_nodes(table: StopValues, allowed: float) -> list[Check]:
    """Every value of the curve, by quadrature anew; stops are looked at in every cell."""
    missed = np.empty((table.axis.size, HEIGHTS, 2))
    for j, one in enumerate(heights()):
        parts = regular_parts(table.axis, float(one))
        missed[:, j] = table.values[:, j, STOPS:] * [1.0, one]
        missed[:, j] -= parts * [limits(float(one)).kappa, 1.0]
    with np.errstate(divide="ignore"):
        u = np.log(np.tan(table.axis.phi()))
    u, delta = (one.ravel() for one in np.broadcast_arrays(u[:, None], heights()))
    return _checks("every node", NAMES[STOPS:], missed.reshape(-1, 2).T, u, delta, allowed)


def _along_motion(table: StopValues, u: FloatArray, delta: FloatArray) -> FloatArray:
    """Ln Q and ψ by the table, each up to a function of δ, (2, n)."""
    known = table.known(launches_at(u, delta))
    log_q = known[LOG_N] / known[KAPPA] - np.log(known[T_LAUNCH])
    return np.stack([log_q, known[TURNING] * log_q + known[HEADING0]])


def _integrals(values: npt.NDArray[np.inexact]) -> npt.NDArray[np.inexact]:
    """Integrals from −1 to each Chebyshev node and to 1, along axis 0."""
    series = chebyshev.chebfit(_NODES, values, len(_NODES) - 1)
    primitive = chebyshev.chebint(series, lbnd=-1.0)
    return chebyshev.chebval(np.append(_NODES, 1.0), primitive).T


def _elementary(table: StopValues, allowed: float) -> list[Check]:
    """T, X, path and body angle of pure sliding and pure spin; T and X + iY of the limit motion."""
    delta = np.linspace(0.0, 1.0, 41)
    checks = []
    for u, values in (
        (-math.inf, (1.0, 0.5, 0.0, 0.5, 0.0)),
        (math.inf, (0.75, 0.0, 0.0, 0.0, 0.375)),
    ):
        at = np.full_like(delta, u)
        errors = (looked_up(table, at, delta) - values).T
        checks += _checks("pure motion", NAMES[:STOPS], errors, at, delta, 0.0)
    u0 = np.log(limit_ratio(delta))
    phi = np.arctan(np.exp(u0))
    rho = moment_balance(quadrature.integrals(phi), slip_direction(phi), delta)
    turning = np.sin(phi) * rho.perpendicular / rho.parallel
    spiral = np.cos(phi) / (rho.parallel * (2.0 + 1j * turning))
    errors = looked_up(table, u0, delta)[:, :3].T - [1.0 / rho.parallel, spiral.real, spiral.imag]
    return checks + _checks("limit motion", NAMES[:3], errors, u0, delta, allowed)


def _checks(
    route: str, names: tuple[str, ...], errors: FloatArray, u: FloatArray, delta: FloatArray,
    allowed: float,
) -> list[Check]:  # fmt: skip
    """Lines of the report for errors (functions, points) at launches u."""
    phi = np.arctan(np.exp(np.minimum(u, 700.0)))
    return compared(route, names, errors, phi, delta, allowed)

"""What besides dry friction on a level table may move a puck: a slope, drag, air; to first order.

A small push at one moment changes the motion after it as another launch from there would.  With
V(t) = ∂(vx, vy, ω)(t)/∂(vx, vy, ω)(0), which a fit has anyway, small forces change velocity and
spin by

    δ(vx, vy, ω)(t) = ∫ V(t) V(s)⁻¹ (ax, ay, α)(s) ds .
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.fitting.certainty import Certainty, shifted_by
from puck_tables.fitting.estimate import Estimate
from puck_tables.fitting.forward_model import (
    DELTA,
    RATE,
    Moving,
    states_and_slopes,
    states_of,
)
from puck_tables.fitting.least_squares import inside
from puck_tables.fitting.problem import Problem

SLOPE, DRAG, AIR = (0, 1), (2,), (3,)  # forces: m/s² along x and y; 1/s; 1/m
_KINDS = {SLOPE: "a table out of level by {:.2g} degrees", DRAG: "drag", AIR: "air"}
_FORCES = 4
_MOMENTS = 32
_ENDS = 0.9995  # of the motion: at its end nothing is carried on
_REST = 1e-3  # of the greatest slip
_TRIED = 0.1  # degrees of a table that nobody levelled with care
_STEEP = 3.0  # degrees: nobody takes that for a level table
_ALIKE = 6.0  # of χ²: forces that explain about as much
_LAW = 0.2  # of a friction, by which it may change up to the fastest slip
_ROUNDS, _CLOSE = 40, 1e-4
_RANK, _SEEN = 1e-9, 2e-3


class SideForces(NamedTuple):
    """What a slope, drag or air would do to a fit.

    ``chance``: the probability of residuals that one of them explains so well; ``words``: which
    may; ``level``: how well the slope is told, degrees; ``by_slope``: by how much it changes each
    number of the puck if the table is out of level by 0.1 degrees; ``by_law`` (m,): what a friction
    that grows by a fifth to the fastest slip does to the unknowns; ``biases`` (m, k): what each
    that may explain residuals would have done to them.
    """

    chance: float = 1.0
    words: str = ""
    level: float = 0.0
    by_slope: Mapping[str, float] = {}
    by_law: FloatArray = np.empty(0)
    biases: FloatArray = np.empty((0, 0))


def side_forces(result: Estimate, certainty: Certainty) -> SideForces:
    """What these forces do to an estimate; nothing is said of impacts and of laws over speed."""
    problem = result.problem
    if problem.impact_specs or problem.spec.speeds or any(problem.rests):
        return SideForces()
    kept = result.kept[:, None]
    columns = _weighed(problem, _along(problem, result.x)) * kept
    changes = shifted_by(result, certainty, columns)
    slopes = result.jacobian * kept
    slopes = slopes / np.maximum(np.linalg.norm(slopes, axis=0), 1e-300)
    ways, sizes, _ = np.linalg.svd(slopes[:, np.equal(certainty.pinned, 0)], full_matrices=False)
    ways = ways[:, sizes > _RANK * sizes.max(initial=0.0)]
    rows = result.residuals * result.kept
    rows = rows - ways @ (ways.T @ rows)
    lengths = np.maximum(np.linalg.norm(columns, axis=0), 1e-300)
    columns = (columns - ways @ (ways.T @ columns)) / lengths
    if not rows.any() or result.degrees <= _FORCES:
        return SideForces()
    told = {kind: _explained(columns[:, kind], rows, result.degrees) for kind in _KINDS}
    forces = {kind: one.force / lengths[list(kind)] for kind, one in told.items()}
    values = problem.numbers_at(result.x)
    decel, _, radius = problem.spec.scales(values)
    gravity = {**problem.spec.known(), **values}["gravity"]
    tilt = math.degrees(math.hypot(*forces[SLOPE]) / gravity)
    best = max(one.gain for one in told.values())
    near = [kind for kind, one in told.items() if one.gain > best - _ALIKE]
    if tilt > _STEEP and len(near) > 1:
        near = [kind for kind in near if kind != SLOPE]
    slope = np.hypot(*changes[:, SLOPE].T) * gravity * math.radians(_TRIED)
    _, _, vx, vy, spin, _ = problem.launches(result.x).T
    fastest = float((np.hypot(vx, vy) + radius * np.abs(spin)).max())
    return SideForces(
        min(len(_KINDS) * min(one.chance for one in told.values()), 1.0),
        " or ".join(_KINDS[kind].format(tilt) for kind in near),
        math.degrees(told[SLOPE].error / lengths[list(SLOPE)].max() / gravity),
        dict(zip(problem.spec.free, slope.tolist(), strict=False)),
        changes[:, DRAG[0]] * _LAW * decel / max(fastest, 1e-300),
        np.stack([changes[:, kind] @ forces[kind] for kind in near], axis=1),
    )  # fmt: skip


class _Explained(NamedTuple):
    """The force that leaves least, χ² less, the chance of that, and the error of the force."""

    force: FloatArray
    gain: float
    chance: float
    error: float


def _explained(columns: FloatArray, rows: FloatArray, degrees: int) -> _Explained:
    """What forces (n, k), as shares of all they do, explain of residuals that no unknown does.

    What is left of them below :data:`_SEEN` is what is computed inexactly, and tells nothing.
    """
    from scipy.special import fdtrc

    ways, sizes, turned = np.linalg.svd(columns, full_matrices=False)
    ways, seen, turned = (
        ways[:, sizes > _SEEN], sizes[sizes > _SEEN], turned[sizes > _SEEN]
    )  # fmt: skip
    along, left, count = ways.T @ rows, float(rows @ rows), seen.size
    less = float(along @ along)
    noise = max((left - less) / (degrees - count), 1e-300)
    chance = float(fdtrc(count, degrees - count, less / count / noise)) if count else 1.0
    error = math.sqrt(noise) / float(seen.min()) if count == sizes.size else math.inf
    return _Explained(-(along / seen) @ turned, less / noise, chance, error)


def forced(result: Estimate, kind: tuple[int, ...]) -> tuple[list[FloatArray], FloatArray]:
    """How far a force of a kind leaves the tracks off (3, n), and the force that leaves least."""
    from scipy.optimize import least_squares

    problem, count = result.problem, result.x.size
    latest: dict[bytes, FloatArray] = {}

    def residuals(values: FloatArray) -> FloatArray:
        rows, slopes = problem.residuals_and_jacobian(values[:count])
        pushed = _weighed(problem, [one[..., kind] for one in _along(problem, values[:count])])
        latest.clear()
        latest[values.tobytes()] = np.column_stack([slopes, pushed])[result.kept]
        return (rows + pushed @ values[count:])[result.kept]

    def jacobian(values: FloatArray) -> FloatArray:
        if values.tobytes() not in latest:
            residuals(values)
        return latest[values.tobytes()]

    start = np.append(result.x, np.zeros(len(kind)))
    free = np.array([track >= 0 for track, _ in problem.names] + [True] * len(kind))
    low, high = (
        np.where(free, far, np.append(ends, np.zeros(len(kind))))
        for ends, far in zip(problem.limits, (-np.inf, np.inf), strict=True)
    )
    found = least_squares(
        residuals, inside(start, low, high), jacobian, bounds=(low, high), x_scale="jac",
        max_nfev=_ROUNDS, ftol=_CLOSE, xtol=_CLOSE,
    ).x  # fmt: skip
    x, force = found[:count], found[count:]
    along = [one[..., kind] @ force for one in _along(problem, x)]
    return [off + one for off, one in zip(problem.deviations(x), along, strict=True)], force


def _weighed(problem: Problem, along: list[FloatArray]) -> FloatArray:
    """What is along the tracks (3, n, k) each, in units of the noise, (residuals, k)."""
    rows = [problem.weighed(n, one) for n, one in enumerate(along)]
    return np.concatenate([*rows, np.zeros((len(problem.priors), along[0].shape[2]))])


def _along(problem: Problem, x: FloatArray) -> list[FloatArray]:
    """What a unit of each force does to the places and angles of each track, (3, n, forces)."""
    numbers = problem.numbers_at(x)
    moving = problem.moving(numbers)
    return [
        _along_one(moving, launch, problem.times(n, numbers))
        for n, launch in enumerate(problem.launches(x))
    ]


def _along_one(moving: Moving, launch: FloatArray, times: FloatArray) -> FloatArray:
    """The same of one motion.

    V(t) = ∂(vx, vy, ω)(t)/∂(vx, vy, ω)(0) carries changes on, from each moment to the next.
    """
    from scipy.interpolate import CubicSpline

    vx, vy, w = states_of(moving, launch, times)[RATE]
    slips = np.hypot(np.hypot(vx, vy), moving.radius * w)
    moves = int((slips > _REST * slips.max()).sum())
    end = float(times[moves - 1]) if moves else 0.0
    if 1 < moves < times.size:  # it slows at about a constant rate until it stops
        before, last = slips[moves - 2 : moves]
        end += last / (before - last) * (end - float(times[moves - 2]))
    end *= _ENDS
    if not end > 0.0:
        return np.zeros((3, times.size, _FORCES))
    moments = np.linspace(0.0, end, _MOMENTS)
    states, slopes = states_and_slopes(moving, launch, moments)
    carried, rates = slopes[:, RATE, :DELTA], states[RATE].T
    onwards = carried[1:] @ np.linalg.inv(carried[:-1])
    forces = np.zeros((_MOMENTS, 3, _FORCES))
    forces[:, [0, 1], [0, 1]] = 1.0
    forces[:, :, DRAG[0]] = -rates
    forces[:, :2, AIR[0]] = -rates[:, :2] * np.hypot(*rates[:, :2].T)[:, None]
    half = 0.5 * moments[1]
    changes = np.zeros_like(forces)
    for k, on in enumerate(onwards):
        changes[k + 1] = on @ (changes[k] + half * forces[k]) + half * forces[k + 1]
    path = CubicSpline(moments, changes).antiderivative()(np.minimum(times, end))
    result: FloatArray = np.moveaxis(path, 0, 1)
    return result

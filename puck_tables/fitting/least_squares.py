"""Least squares from one start, or from many abreast; residuals in as few rows as may be.

Residuals of one kind in one track hang on few unknowns: those of its own launch, and those shared.
Turned in their space (QR) they become as many rows as these and one more; sums of squares, products
of residuals and slopes, and singular values stay what they are, to rounding.

Steps are those of Levenberg and Marquardt within bounds (δ ≥ 0); where the Jacobian has no full
rank, which is not rare here, they stand still.  Many starts go abreast, of which fewer and fewer go
on.  scipy's ``least_squares`` cannot stop and compare, and of so few unknowns its step costs twice
what the motion of a track costs.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.errors import InputError
from puck_tables.fitting.problem import ANGLE, PLACE, PRIOR, ROUGH, Problem


class Compact(NamedTuple):
    """``rows`` (k,), ``slopes`` (k, m), and the kinds (k,) of residuals that they stand for."""

    rows: FloatArray
    slopes: FloatArray
    kinds: npt.NDArray[np.int64]


def compact(
    problem: Problem, rows: FloatArray, slopes: FloatArray, kept: npt.NDArray[np.bool_] | None
) -> Compact:
    """Fewer rows for residuals (n,), derivatives (n, m); ``kept``: which count, all if None."""
    if kept is not None:
        rows, slopes = rows * kept, slopes * kept[:, None]
    few, slope, kinds = [], [], []
    for n, (x, y, turn) in enumerate(problem.each()):
        unknowns = enumerate(problem.names)
        moved = [k for k, (of, _) in unknowns if of in (-1, n) or problem.impact_specs]
        for part, kind in ((slice(x.start, y.stop), PLACE), (turn, ANGLE)):
            turned = triangle(np.column_stack([slopes[part][:, moved], rows[part]]))
            wide = np.zeros((len(turned), slopes.shape[1]))
            wide[:, moved] = turned[:, :-1]
            few.append(turned[:, -1])
            slope.append(wide)
            kinds.append(np.full(len(turned), kind))
    priors = problem.kinds == PRIOR
    every = (*few, rows[priors]), (*slope, slopes[priors]), (*kinds, problem.kinds[priors])
    return Compact(*(np.concatenate(one) for one in every))


def triangle(rows: FloatArray) -> FloatArray:
    """Rows of the same products, no more than columns: R of QR, part by part.

    As one, tall rows (n, m) make BLAS take threads, which wait for each other longer than they
    work.
    """
    size = max(_PART, 2 * rows.shape[1])
    while len(rows) > size:
        even = len(rows) // size * size
        parts = np.asarray(np.linalg.qr(rows[:even].reshape(-1, size, rows.shape[1]), mode="r"))
        rows = np.concatenate([parts.reshape(-1, rows.shape[1]), rows[even:]])
    return np.asarray(np.linalg.qr(rows, mode="r")) if len(rows) > rows.shape[1] else rows


_PART = 128  # rows, at the least
ROBUST = 3.0  # residuals that are larger count less
# steps, and how many starts then go on
FROM_AFAR = ((1, 10), (4, 5), (12, 4))
FROM_NEARBY = ((4, 2), (30, 1))
FROM_SLOWING = ((3, 3), (8, 2), (30, 1))
_DAMPED, _EASED, _HARDER = 1e-3, 0.1, 10.0
_LEAST = 1e-9  # damping: what is not seen stays where it is
_HARDEST = 1e6  # the damping where a start has arrived
_STEPS = 300  # to a minimum: a curved valley takes a hundred
_NOTHING = 1e-12  # of a cost, or of 1: what a last step would gain
_ROUNDING = 1e-24  # of the largest square of slopes
_APART = 1e-2  # starts that are nearer have met


def multi_start(
    starts: list[tuple[Problem, FloatArray]], rounds: tuple[tuple[int, int], ...],
    scale: float = math.inf, allowance: float = 0.0, kept: npt.NDArray[np.bool_] | None = None,
    held: int | None = None,
) -> list[tuple[FloatArray, float]]:  # fmt: skip
    """Unknowns at the deepest minima that starts lead to, and the cost there, the deepest first.

    Starts, of the same residuals, that have met go on as one.  ``rounds``: steps, and how many
    starts go on after them; residuals r count squared, or of a ``scale`` s as ½ s² ln(1 + (r/s)²)
    with s at least twice their median; ``allowance``: what a start may cost more than the best and
    goes on, however many do; ``kept``: residuals that count, all where it is left out; ``held``:
    what stays.
    """
    walkers = [_Walker(problem, x, scale, kept, held) for problem, x in starts]
    for steps, most in rounds:
        for walker in walkers:
            for _ in range(steps):
                if not walker.arrived:
                    walker.step()
        every, walkers = sorted(walkers, key=lambda one: one.cost), []
        for one in every:  # those that no deeper one has met
            if all(np.abs(one.x - other.x).max() > _APART * np.abs(other.x).max()
                   for other in walkers):  # fmt: skip
                walkers.append(one)
        near = sum(one.cost < walkers[0].cost + allowance for one in walkers)
        walkers = walkers[: max(most, near)]
    return [(walker.x, walker.cost) for walker in walkers]


def minimise_robustly(problem: Problem, x: FloatArray, steps: int = 40) -> tuple[FloatArray, float]:
    """The unknowns at the minimum from a start, to a ten-thousandth of the robust cost there."""
    return multi_start([(problem, x)], ((steps, 1),), ROBUST)[0]


def minimise(
    problem: Problem, x: FloatArray, kept: npt.NDArray[np.bool_] | None = None
) -> tuple[FloatArray, float]:
    """The unknowns at the minimum from a start, and the cost, half the sum of squares, there.

    ``kept``: residuals that count, all where it is left out.
    """
    walker = _Walker(problem, x, math.inf, kept, None, problem.level)
    for _ in range(_STEPS):
        if not walker.arrived:
            walker.step()
    if not (math.isfinite(walker.cost) and np.isfinite(walker.slopes).all()):
        words = ", ".join(f"{n} {value:.3g}" for n, value in problem.numbers_at(walker.x).items())
        raise InputError(
            "the fit is led astray, to a motion that cannot be computed"
            f"{f' ({words})' if words else ''}: give bounds or a prior of what it finds,"
            " or find less"
        )
    return walker.x, walker.cost


class _Walker:
    """A start on its way."""

    def __init__(
        self, problem: Problem, x: FloatArray, scale: float,
        kept: npt.NDArray[np.bool_] | None, held: int | None, level: float = ROUGH,
    ) -> None:  # fmt: skip
        self.problem, self.scale, self.held, self.level = problem, scale, held, level
        self.weights = 1.0 if kept is None else kept.astype(np.float64)
        self.x, self.damping, self.arrived = np.clip(x, *problem.limits), _DAMPED, False
        self.rows, self.slopes = self._at(self.x)

    def _at(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        rows, slopes = self.problem.residuals_and_jacobian(x)
        if self.held is not None:
            slopes[:, self.held] = 0.0
        return self.weights * rows, slopes

    @property
    def cost(self) -> float:
        """By the same scale for all."""
        return _cost(self.rows, self.scale)

    def step(self) -> None:
        """One step, or none where it leads up."""
        scale = self.scale
        if scale < math.inf:
            scale = max(scale, 2.0 * self.problem.usual(self.rows))
        slopes, weights = self.slopes, self.weights / (1.0 + (self.rows / scale) ** 2)
        square = (slopes.T * weights) @ slopes
        size = np.diag(square)
        seen = size > _ROUNDING * size.max()  # of the others slopes are rounding
        damped = square + np.diag(np.where(seen, self.damping * size, 1.0))
        down = slopes.T @ (weights * self.rows)
        change = np.linalg.solve(damped, down)
        if not np.isfinite(change).all():
            self.arrived = True
            return
        new = np.clip(self.x - change, *self.problem.limits)
        free = new == self.x - change
        if not free.all():  # some end on their bounds: the others step as these do, not as wanted
            short = down - damped @ np.where(free, 0.0, self.x - new)
            change[free] = np.linalg.solve(damped[free][:, free], short[free])
            new[free] = np.clip(self.x - change, *self.problem.limits)[free]
        change = self.x - new
        if change @ (down - 0.5 * (square @ change)) < _NOTHING * max(self.cost, 1.0):
            self.arrived = True
            return
        rows, slopes = self._at(new)
        before, after = _cost(self.rows, scale), _cost(rows, scale)
        if after < before:
            self.arrived = before - after < self.level * before
            self.x, self.rows, self.slopes = new, rows, slopes
            self.damping = max(_EASED * self.damping, _LEAST)
        else:
            self.arrived = self.damping > _HARDEST
            self.damping *= _HARDER


def _cost(rows: FloatArray, scale: float) -> float:
    if scale == math.inf:
        return 0.5 * float(rows @ rows)
    return 0.5 * scale * scale * float(np.log1p((rows / scale) ** 2).sum())

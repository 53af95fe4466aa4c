"""Steps towards a minimum from many starts abreast, of which fewer and fewer go on.

They are of Levenberg and Marquardt, our own: scipy's least squares cannot stop and compare, and of
so few unknowns its step costs twice what the motion of a track costs.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.fitting.problem import Problem

# steps, and how many starts then go on
FROM_AFAR = ((1, 10), (4, 5), (12, 4))
FROM_BESIDE = ((4, 2), (30, 1))
ROBUST = 3.0  # where residuals begin to count less, in units of the noise
_DAMPED, _EASED, _HARDER = 1e-3, 0.1, 10.0
_LEAST = 1e-9  # damping: what is not seen stays where it is
_LEVEL, _HARDEST = 1e-4, 1e6  # what costs fall by, or the damping, where a start has arrived
_ROUNDING = 1e-24  # of the largest square of slopes
_APART = 1e-2  # starts that are nearer have met


def multi_start(
    starts: list[tuple[Problem, FloatArray]], rounds: tuple[tuple[int, int], ...],
    scale: float = math.inf, allowance: float = 0.0, kept: npt.NDArray[np.bool_] | None = None,
    held: int | None = None,
) -> list[tuple[FloatArray, float]]:  # fmt: skip
    """Unknowns at the deepest minima that starts lead to, and the cost there, the deepest first.

    Starts that have met go on as one.

    Parameters
    ----------
    starts : problems of the same residuals, each with unknowns
    rounds : steps, and how many starts go on after them
    scale : s; residuals r count as ½ s² ln(1 + (r/s)²), with s at least twice their median
    allowance : what a start may cost more than the best and goes on, however many do
    kept : residuals that count, all where it is left out
    held : an unknown that stays
    """
    walkers = [_Walker(problem, x, scale, kept, held) for problem, x in starts]
    for steps, most in rounds:
        for walker in walkers:
            for _ in range(steps):
                if not walker.arrived:
                    walker.step()
        walkers.sort(key=lambda one: one.cost)
        walkers = _apart(walkers)
        near = sum(one.cost < walkers[0].cost + allowance for one in walkers)
        walkers = walkers[: max(most, near)]
    return [(walker.x, walker.cost) for walker in walkers]


class _Walker:
    """A start on its way."""

    def __init__(
        self, problem: Problem, x: FloatArray, scale: float,
        kept: npt.NDArray[np.bool_] | None, held: int | None,
    ) -> None:  # fmt: skip
        self.problem, self.scale, self.held = problem, scale, held
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
        rows, slopes = self._at(new)
        before, after = _cost(self.rows, scale), _cost(rows, scale)
        if after < before:
            self.arrived = before - after < _LEVEL * before
            self.x, self.rows, self.slopes = new, rows, slopes
            self.damping = max(_EASED * self.damping, _LEAST)
        else:
            self.arrived = self.damping > _HARDEST
            self.damping *= _HARDER


def _cost(rows: FloatArray, scale: float) -> float:
    if scale == math.inf:
        return 0.5 * float(rows @ rows)
    return 0.5 * scale * scale * float(np.log1p((rows / scale) ** 2).sum())


def _apart(walkers: list[_Walker]) -> list[_Walker]:
    """Those that no deeper one has met."""
    result: list[_Walker] = []
    for one in walkers:
        if all(np.abs(one.x - other.x).max() > _APART * np.abs(other.x).max() for other in result):
            result.append(one)
    return result

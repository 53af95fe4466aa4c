"""The door to scipy's least squares: bounds, a robust loss, and what that costs.

The optimiser is scipy's trust region reflective method: it takes bounds (δ ≥ 0), knows robust
losses, and stands still where the Jacobian has no full rank, which is not rare here.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.errors import InputError
from puck_tables.fitting.compact import compact
from puck_tables.fitting.problem import Problem


class How(NamedTuple):
    """``loss`` of scipy, the residual where it begins to count less, and the most evaluations."""

    loss: str
    scale: float
    evaluations: int
    tolerance: float


_FAR = 1e3  # ends that are farther, and those of launches, would only bend steps to a minimum

LOOSE = How("cauchy", 3.0, 40, 1e-4)
ROBUST = How("cauchy", 3.0, 30, 1e-4)
SQUARES = How("linear", 1.0, 60, 1e-9)


def minimise(
    problem: Problem, x: FloatArray, how: How, kept: npt.NDArray[np.bool_] | None = None,
    held: int | None = None,
) -> tuple[FloatArray, float]:  # fmt: skip
    """The unknowns at the minimum from a start, and the cost ½ Σ loss there.

    ``kept``: residuals that count, all where it is left out; ``held``: an unknown that stays.
    """
    from scipy.optimize import least_squares

    moved = np.array([k for k in range(x.size) if k != held], np.int64)
    whole = x.copy()
    limits = [ends[moved] for ends in problem.limits]
    low, high = (
        np.where(_near(ends, problem, moved), ends, far)
        for ends, far in zip(limits, (-np.inf, np.inf), strict=True)
    )
    begun = inside(x[moved], low, high)
    latest: dict[bytes, FloatArray] = {}

    def residuals(values: FloatArray) -> FloatArray:
        whole[moved] = values
        rows, slopes = problem.residuals_and_jacobian(whole)
        if not (np.isfinite(slopes).all() and np.isfinite(rows).all()):
            raise InputError(_astray(problem, whole))
        if how.loss == "linear":  # only their squares and products count
            rows, slopes, _ = compact(problem, rows, slopes, kept)
        latest.clear()
        latest[values.tobytes()] = slopes[:, moved]
        return rows

    def jacobian(values: FloatArray) -> FloatArray:
        if values.tobytes() not in latest:
            residuals(values)
        return latest[values.tobytes()]

    scale = how.scale
    if how.loss != "linear":  # far from the minimum all residuals are large, none an outlier
        scale = max(scale, 2.0 * problem.usual(residuals(begun)))
    while True:
        result: Any = least_squares(
            residuals, begun, jacobian, bounds=(low, high), x_scale="jac", loss=how.loss,
            f_scale=scale, max_nfev=how.evaluations, ftol=how.tolerance, xtol=how.tolerance,
            gtol=1e-12,
        )  # fmt: skip
        beyond = (result.x < limits[0]) | (result.x > limits[1])
        if beyond.any():  # it ran away: the rest is sought with these on their ends
            low, high = (np.where(beyond, ends, near)
                         for ends, near in zip(limits, (low, high), strict=True))  # fmt: skip
            begun = inside(np.clip(result.x, *limits), low, high)
            continue
        if scale <= how.scale:
            whole[moved] = np.clip(result.x, *limits)
            return whole, float(result.cost)
        begun = inside(result.x, low, high)
        scale = max(how.scale, min(0.25 * scale, 2.0 * problem.usual(result.fun)))


def _astray(problem: Problem, x: FloatArray) -> str:
    """A sentence on unknowns of which no motion can be computed."""
    told = ", ".join(f"{name} {value:.3g}" for name, value in problem.numbers_at(x).items())
    return (
        "the fit is led astray, to a motion that cannot be computed"
        f"{f' ({told})' if told else ''}: give bounds or a prior of what it finds, or find less"
    )


def _near(
    ends: FloatArray, problem: Problem, moved: npt.NDArray[np.int64]
) -> npt.NDArray[np.bool_]:
    """Ends that count from the first: of the puck, and bounds that are given."""
    given = [problem.names[k][0] == -1 or problem.names[k][1] in problem.spec.bounds
             for k in moved]  # fmt: skip
    near: npt.NDArray[np.bool_] = (np.abs(ends) < _FAR) & np.array(given, bool)
    return near


def inside(x: FloatArray, low: FloatArray, high: FloatArray) -> FloatArray:
    """Strictly within bounds, as the method wants its start."""
    width = np.where(np.isfinite(high - low), high - low, np.maximum(1.0, np.abs(x)))
    room = 1e-9 * width
    within: FloatArray = np.minimum(np.maximum(x, low + room), high - room)
    return within

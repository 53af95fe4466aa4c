"""How far launches that are known with errors scatter: covariance in, covariance out.

With the Jacobian A of what is asked by what is uncertain, C_out = A C Aᵀ: exact for a motion that
is linear over the scatter.  Samples say whether it is.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray, finite_array, listed, shown
from puck_tables.bulk.spreads import checked_seed
from puck_tables.errors import InputError

Again = Callable[[FloatArray], FloatArray]

_SYMMETRIC = 1e-9  # relative: rounding of a covariance as printed
_MOST_SAMPLES = 10**9  # launches: more is refused by name
_AT_ONCE = 1 << 20  # samples in memory
_TRUSTED = 0.05  # of a deviation
_NOISE = 4.0  # deviations of what samples themselves scatter by
_LOWEST = dict.fromkeys(("delta", "decel", "radius", "friction", "height", "time"), 0.0)
_ABOVE = ("decel", "radius", "friction")  # their lowest


@dataclass(frozen=True, eq=False, repr=False)
class ResultSpread:
    """How results scatter when launches do.

    Parameters
    ----------
    names : what scatters, in the order of the rows
    covariance : array (…, rows, rows), SI units: linear, by the Jacobian
    samples : how many were drawn of each launch; 0: none
    sampled_covariance : array (…, rows, rows), of the samples; None without
    shift : array (…, rows): mean of the samples less the result of the mean launch; None without
    """

    names: tuple[str, ...]
    covariance: FloatArray
    samples: int = 0
    sampled_covariance: FloatArray | None = None
    shift: FloatArray | None = None

    def __repr__(self) -> str:
        return f"Spread({', '.join(self.names)}; {self.samples} samples)"

    @property
    def deviation(self) -> FloatArray:
        """Standard deviations (…, rows), linear."""
        return _deviation(self.covariance)

    @property
    def ratio(self) -> FloatArray:
        """Standard deviations of the samples over the linear ones, (…, rows); both 0: 1.

        Raises
        ------
        InputError
            If no samples were drawn.
        """
        linear, sampled = self.deviation, _deviation(self._sampled[0])
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio: FloatArray = np.where(sampled == linear, 1.0, sampled / linear)
        return ratio

    @property
    def is_linear(self) -> npt.NDArray[np.bool_]:
        """Whether the linear covariance is to be trusted, (…).

        That is where deviations and means of the samples agree with it to 5 % of a deviation,
        beyond what so few samples scatter by themselves.

        Raises
        ------
        InputError
            If no samples were drawn.
        """
        shift, linear = self._sampled[1], self.deviation
        allowed = _TRUSTED + _NOISE / np.sqrt(2.0 * self.samples)
        wide = np.abs(self.ratio - 1.0) <= allowed
        allowed = _TRUSTED + _NOISE / np.sqrt(self.samples)
        trusted: npt.NDArray[np.bool_] = (wide & (np.abs(shift) <= allowed * linear)).all(axis=-1)
        return trusted

    @property
    def _sampled(self) -> tuple[FloatArray, FloatArray]:
        if self.sampled_covariance is None or self.shift is None:
            raise InputError("no samples were drawn: give samples=10000 or so")
        return self.sampled_covariance, self.shift

    def explain(self) -> str:
        """How it was got, and whether to trust it."""
        if self.sampled_covariance is None:
            return "linear, by the Jacobian; samples=10000 or so would say whether to trust it"
        good = int(np.count_nonzero(self.is_linear))
        error = float(np.abs(self.ratio - 1.0).max())
        return (
            f"linear, by the Jacobian, and by {self.samples} samples, whose deviations differ by "
            f"at most {100.0 * error:.3g} %: the linear one is to be trusted for {good} of "
            f"{self.is_linear.size} launches"
        )


def spread_of(
    names: tuple[str, ...], columns: tuple[str, ...], jacobian: FloatArray, arguments: FloatArray,
    again: Again, covariance: npt.ArrayLike, of: Sequence[str], samples: int, seed: int,
    highest: float,
) -> ResultSpread:  # fmt: skip
    """The spread of results.

    Parameters
    ----------
    names, columns : of rows and columns of the Jacobian
    jacobian : array (…, rows, columns)
    arguments : array (columns, n), launches in the order of the columns
    again : results (rows, m) of arguments (columns, m)
    covariance, of, samples, seed
        As :meth:`puck_tables.results.Stops.spread`.
    highest : the largest δ of a sample that ``again`` takes; it may refuse others itself
    """
    which = [_place(name, columns) for name in listed("of", of, "arguments")]
    if len(set(which)) < len(which) or not which:
        raise InputError(f"of must name different arguments of {', '.join(columns)}")
    shape = jacobian.shape[:-2]
    root = _root(covariance, len(which), shape)
    if not isinstance(samples, int) or isinstance(samples, bool) or samples == 1 or samples < 0:
        raise InputError(f"samples must be 0 or a whole number from 2 on, got {shown(samples)}")
    seed = checked_seed(seed)
    if not np.isfinite(jacobian).all():
        raise InputError(
            "a launch has no derivative (pure spin, the path by vx and vy; or too large for "
            "floating point): leave it out"
        )
    scattered = jacobian[..., which] @ root
    linear = scattered @ np.swapaxes(scattered, -1, -2)
    if not samples:
        return ResultSpread(names, linear)
    count = arguments.shape[1]
    if samples * count > _MOST_SAMPLES:
        raise InputError(
            f"{samples} samples of {count} launches are more than {_MOST_SAMPLES:g}: give fewer"
        )
    roots = np.broadcast_to(root, (*shape, *root.shape[-2:])).reshape(count, *root.shape[-2:])
    shift, sampled = np.empty((count, len(names))), np.empty((count, len(names), len(names)))
    drawn = np.random.default_rng(seed)
    for n in range(count):
        total, squares, done = np.zeros(len(names)), np.zeros((len(names), len(names))), 0
        middle = again(arguments[:, n : n + 1])
        while done < samples:
            part = min(_AT_ONCE, samples - done)
            tried = np.repeat(arguments[:, n : n + 1], part, axis=1)
            tried[which] += roots[n] @ drawn.standard_normal((len(which), part))
            _refuse_outside(tried, columns, highest)
            error = again(tried) - middle
            total, squares, done = total + error.sum(axis=1), squares + error @ error.T, done + part
        shift[n] = total / samples
        sampled[n] = (squares - samples * np.outer(shift[n], shift[n])) / (samples - 1)
    return ResultSpread(
        names, linear, samples, sampled.reshape(linear.shape), shift.reshape(linear.shape[:-1])
    )


def _place(name: str, columns: tuple[str, ...]) -> int:
    if not isinstance(name, str) or name not in columns:
        raise InputError(f"of must name arguments of {', '.join(columns)}, got {shown(name)}")
    return columns.index(name)


def _root(covariance: npt.ArrayLike, count: int, shape: tuple[int, ...]) -> FloatArray:
    """A matrix R with R Rᵀ = covariance."""
    matrix = finite_array("covariance", covariance, "1")
    try:
        np.broadcast_shapes(matrix.shape, (*shape, count, count))
        fits = matrix.shape[-2:] == (count, count) and matrix.ndim <= len(shape) + 2
    except ValueError:
        fits = False
    if not fits:
        raise InputError(
            f"covariance must have the shape {(count, count)}, or one such matrix for each launch, "
            f"got {matrix.shape}"
        )
    scale = np.sqrt(np.maximum(np.diagonal(matrix, axis1=-2, axis2=-1), 0.0))
    scale = np.where(scale > 0.0, scale, 1.0)
    unit = matrix / scale[..., :, None] / scale[..., None, :]
    values, vectors = np.linalg.eigh(0.5 * (unit + np.swapaxes(unit, -1, -2)))
    skew = np.abs(unit - np.swapaxes(unit, -1, -2)).max() if unit.size else 0.0
    if skew > _SYMMETRIC or (values < -_SYMMETRIC).any():
        raise InputError(
            "covariance must be symmetric and without negative variances in any direction"
        )
    root: FloatArray = scale[..., None] * vectors * np.sqrt(np.maximum(values, 0.0))[..., None, :]
    return root


def _refuse_outside(tried: FloatArray, columns: tuple[str, ...], highest: float) -> None:
    for name, row in zip(columns, tried, strict=True):
        low = row.min()
        if (name in _ABOVE and low <= 0.0) or low < _LOWEST.get(name, -np.inf):
            outside = low
        elif name == "delta" and row.max() > highest:
            outside = row.max()
        else:
            continue
        raise InputError(
            f"samples of {name} reach {outside:.3g}, outside its range: give a smaller covariance, "
            "or samples=0"
        )


def _deviation(covariance: FloatArray) -> FloatArray:
    deviation: FloatArray = np.sqrt(np.diagonal(covariance, axis1=-2, axis2=-1))
    return deviation

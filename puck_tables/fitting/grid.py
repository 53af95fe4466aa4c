"""Places, or angles, that are rounded to a step: what is left of them is no independent noise.

Where a puck crosses a step in a frame or less, rounding is about white, a step over √12; where it
crosses one in several frames, what is off runs through all of the step and is 0 in the mean.  But
where a coordinate stays at one value and comes back, or ends there, all these frames are off by one
and the same amount: they count as two.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray

ROUNDED = 1.0 / math.sqrt(12.0)  # of a step: the spread of what is rounded to it
_COARSE = 2.0  # times the noise that frames show: a step below is hidden by noise
_OFF = 0.05  # of a step, as its multiples may be off in a file
_FEWEST = 6  # values that differ


def step_of(*columns: FloatArray) -> float:
    """The step of which all values of some columns (n,) are multiples, from any one on; else 0.

    Examples
    --------
    >>> x = 0.3 * np.arange(40) ** 1.5
    >>> step_of(x), round(step_of(0.5 * np.round(2.0 * x), 0.0 * x), 9)
    (0.0, 0.5)
    """
    found = [np.unique(column[np.isfinite(column)]) for column in columns]
    gaps = np.concatenate([np.diff(values) for values in found])
    if gaps.size < _FEWEST:
        return 0.0
    # values that are one to rounding of the file are no step
    gaps = gaps[gaps > 1e-9 * max(float(np.ptp(values)) for values in found)]
    repeated = any(1 < one.size < column.size for one, column in zip(found, columns, strict=True))
    if not gaps.size or not (repeated or gaps.max() > 1.5 * gaps.min()):  # it goes on evenly
        return 0.0
    near = gaps[gaps < 1.5 * gaps.min()]
    step = float(np.median(near))
    size = np.round(gaps / step)
    step = float((gaps * size).sum() / (size * size).sum())
    off = np.concatenate([
        np.diff(values) / step - np.round(np.diff(values) / step) for values in found
    ])  # fmt: skip
    return step if np.abs(off).max() < _OFF else 0.0


def coarse(step: float, noise: float) -> float:
    """The step, if noise (NaN where it is not known) does not hide it; else 0."""
    return 0.0 if step <= _COARSE * noise else step


def counting(values: FloatArray) -> npt.NDArray[np.bool_]:
    """Which of some values in the order of time (n,) count, where they are rounded.

    Examples
    --------
    >>> counting(np.array([0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 2.0, 2.0, 2.0, 2.0, 1.0])).astype(int)
    array([1, 0, 1, 1, 1, 1, 1, 0, 0, 1, 1])
    """
    edges = np.flatnonzero(np.diff(values)) + 1
    firsts, ends = np.append(0, edges), np.append(edges, values.size)
    counts = np.ones(values.size, bool)
    for k, (first, end) in enumerate(zip(firsts, ends, strict=True)):
        inner = 0 < k < firsts.size - 1
        if inner and (values[first - 1] < values[first]) == (values[first] < values[end]):
            continue  # it crosses the step
        counts[first + 1 : end - 1] = False
    return counts

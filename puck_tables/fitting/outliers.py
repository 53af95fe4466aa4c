"""Frames that are off a motion: strays, which no motion goes through, or a motion that is another.

A mark that is lost for a frame, or a blurred one, lies beside its neighbours.  Frames that lie far
off together, and go there smoothly, are good ones: it is the model that is wrong.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray

_AROUND = 4  # frames to either side
_FEW = 5  # frames in a row that may be strays by chance
_LEAP, _MORE = 6.0, 3.0  # standard deviations, and times the way between frames beside


def outliers_of(
    deviations: FloatArray, outlying: npt.NDArray[np.bool_], limit: float
) -> npt.NDArray[np.bool_]:
    """Which of the frames that are far off are strays (n,).

    Parameters
    ----------
    deviations : (n, k), residuals of each frame in units of the noise
    outlying : (n,), whether they are so large that the frame seems to be none of the motion
    limit : of the square of residuals, from which on they are

    Examples
    --------
    >>> deviations = np.zeros((40, 1))
    >>> deviations[20:, 0] = np.linspace(0.0, 20.0, 20)  # a motion that is another
    >>> deviations[7] = 30.0
    >>> np.flatnonzero(outliers_of(deviations, np.abs(deviations[:, 0]) > 4.0, 16.0)).tolist()
    [7]
    """
    if outlying.sum() < _FEW:
        return outlying
    result = outlying.copy()
    usual = np.stack([
        np.median(deviations[max(0, n - _AROUND) : n + _AROUND + 1], axis=0) for n in
        range(len(deviations))
    ])  # fmt: skip
    together = outlying & (((deviations - usual) ** 2).sum(axis=1) <= limit)
    for start, stop in _intervals(together):
        ends = (
            start > 0 and not _leaps(deviations, start),
            stop < len(deviations) and not _leaps(deviations, stop),
        )
        if stop - start >= _FEW and any(ends):
            result[start:stop] &= ~together[start:stop]
    return result


def _intervals(together: npt.NDArray[np.bool_]) -> list[tuple[int, int]]:
    """From where to where frames lie off together, over single ones that do not."""
    filled = together.copy()
    filled[1:-1] |= together[:-2] & together[2:]
    edges = np.flatnonzero(np.diff(np.concatenate([[False], filled, [False]]).astype(int)))
    return list(zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True))


def _leaps(deviations: FloatArray, at: int) -> bool:
    """Whether residuals leap between two frames, and not those beside."""
    ways = np.linalg.norm(np.diff(deviations[max(0, at - 3) : at + 3], axis=0), axis=1)
    middle = at - max(0, at - 3) - 1
    close = np.delete(ways, middle)
    return bool(ways[middle] > max(_LEAP, _MORE * float(np.median(close))))

"""Which values of a table look altered: those that break the smoothness of their neighbourhood."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray

_ORDER, _APART = 4, 5  # of the differences; beyond so many nodes they do not share one
_NOTHING = 1e-13  # relative: differences of rounding are not odd


def odd_nodes(values: FloatArray, axes: tuple[int, ...], count: int) -> npt.NDArray[np.int64]:
    """Nodes where fourth differences are largest against those of their neighbours.

    An altered value stands in five of the differences along an axis, and in no others.  Nothing is
    judged here: these are the nodes to be compared with the truth.

    Parameters
    ----------
    values : array (…, functions)
    axes : along which the functions are smooth, each of 5 nodes or more
    count : about how many nodes are wanted

    Returns
    -------
    array (n, dimensions − 1), indices of nodes; n ≤ ``count``

    Examples
    --------
    >>> line = np.sin(np.linspace(0.0, 1.0, 40))[:, None]
    >>> line[17] += 1e-6
    >>> [17] in odd_nodes(line, (0,), 10).tolist()
    True
    """
    centres = []
    for axis in axes:
        along = np.moveaxis(values, axis, 0)
        if len(along) < _ORDER + 1:
            continue
        difference = np.abs(np.diff(along, _ORDER, axis=0))
        padded = np.pad(difference, [(_APART, _APART), *[(0, 0)] * (difference.ndim - 1)], "edge")
        around = np.minimum(padded[: -2 * _APART], padded[2 * _APART :])
        score = (difference / (around + _NOTHING * (np.abs(along).max() or 1.0))).max(axis=-1)
        most = min(-(-count // (_ORDER + 1) // len(axes)), score.size)
        best = np.argpartition(score, score.size - most, axis=None)[-most:]
        place = np.stack(np.unravel_index(best, score.shape), axis=-1)
        for shift in range(_ORDER + 1):
            node = place.copy()
            node[:, 0] += shift
            order = [*range(1, axis + 1), 0, *range(axis + 1, node.shape[1])]
            centres.append(node[:, order])
    found = np.concatenate(centres) if centres else np.empty((0, values.ndim - 1), np.int64)
    return np.unique(found, axis=0)[:count].astype(np.int64)

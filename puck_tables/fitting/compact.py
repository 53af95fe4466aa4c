"""Residuals and their derivatives in as few rows as there are unknowns to tell apart.

Residuals of one kind in one track hang on few unknowns: those of its own launch, and those shared.
Turned in their space (QR) they become as many rows as these and one more; sums of squares, products
of residuals and slopes, and singular values stay what they are, to rounding.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.fitting.problem import ANGLE, PLACE, PRIOR, Problem


class Compact(NamedTuple):
    """``rows`` (k,), ``slopes`` (k, m), and the kinds (k,) of residuals that they stand for."""

    rows: FloatArray
    slopes: FloatArray
    kinds: npt.NDArray[np.int64]


def compact(
    problem: Problem, rows: FloatArray, slopes: FloatArray, kept: npt.NDArray[np.bool_] | None
) -> Compact:
    """Those of residuals (n,) with derivatives (n, m); ``kept``: which count, all if left out."""
    if kept is not None:
        rows, slopes = rows * kept, slopes * kept[:, None]
    few, slope, kinds = [], [], []
    for n, (x, y, turn) in enumerate(problem.each()):
        moved = [
            k for k, (of, _) in enumerate(problem.names) if of in (-1, n) or problem.impact_specs
        ]
        for part, kind in ((slice(x.start, y.stop), PLACE), (turn, ANGLE)):
            turned: FloatArray = np.column_stack([slopes[part][:, moved], rows[part]])
            if len(turned) > len(moved) + 1:
                turned = np.asarray(np.linalg.qr(turned, mode="r"))
            wide = np.zeros((len(turned), slopes.shape[1]))
            wide[:, moved] = turned[:, :-1]
            few.append(turned[:, -1])
            slope.append(wide)
            kinds.append(np.full(len(turned), kind))
    of_priors = problem.kinds == PRIOR
    few.append(rows[of_priors])
    slope.append(slopes[of_priors])
    kinds.append(problem.kinds[of_priors])
    return Compact(np.concatenate(few), np.concatenate(slope), np.concatenate(kinds))

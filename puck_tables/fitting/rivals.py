"""Other motions that fit a track as well: its likelihood may have more than one summit.

Without angles a puck that slides straight without spin looks as one that spins at the ratio which
every motion tends to: both lose speed at a constant rate, but not the same share of J.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.fitting.certainty import Z95, Certainty, certainty_of
from puck_tables.fitting.estimate import Estimate
from puck_tables.fitting.least_squares import SQUARES, minimise
from puck_tables.fitting.numbers import plausible_for
from puck_tables.fitting.problem import Found
from puck_tables.fitting.starts import minima_of

_APART = 4.0  # standard errors: another summit


def rivals_of(found: Estimate, certainty: Certainty) -> tuple[Found, ...]:
    """The numbers of the puck at other summits within the 95 % limit.

    Of one track; several have not been seen to have any.  With angles they are motions of whole
    turns more from frame to frame, where frames are few or noisy.
    """
    problem = found.problem
    if len(problem.films) > 1 or problem.meetings or problem.asked.speeds:
        return ()
    rivals: list[FloatArray] = []
    summits = [(found.x, *_known(found, certainty))]
    for start in found.minima or minima_of(problem):
        x, cost = minimise(problem, start, SQUARES, found.kept)
        off = [(np.abs(x - one)[: seen.size] > apart)[seen] for one, seen, apart in summits]
        if 2.0 * cost < found.chi2 + Z95**2 and all(one.any() for one in off):
            # what one motion tells another may not: each summit is as wide as it is
            own = certainty_of(problem.jacobian(x)[found.kept], plausible_for(problem, x))
            summits.append((x, *_known(found, own)))
            rivals.append(x)
    return tuple(problem.found(x) for x in rivals)


def _known(found: Estimate, certainty: Certainty) -> tuple[npt.NDArray[np.bool_], FloatArray]:
    """Which numbers of the puck a summit tells, and how far off another summit is."""
    lost = certainty.undetermined[: len(found.problem.asked.free)]
    seen = np.array([not one for one in lost], bool)
    return seen, _APART * np.sqrt(np.diag(certainty.covariance))[: seen.size]

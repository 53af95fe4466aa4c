"""Other motions that fit a track as well: its likelihood may have more than one summit.

Without angles a puck that slides straight without spin looks as one that spins at the ratio which
every motion tends to: both lose speed at a constant rate, but not the same share of J.  A path
bends to a side that its spin and the tilt choose; one that is not seen to bend is its own mirror
image, and does not say which way the puck spins.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.fitting.certainty import Z95, Certainty, certainty_of
from puck_tables.fitting.compact import compact
from puck_tables.fitting.estimate import Estimate
from puck_tables.fitting.least_squares import SQUARES, minimise
from puck_tables.fitting.numbers import plausible_for
from puck_tables.fitting.problem import Found
from puck_tables.fitting.starts import minima_of

_APART = 4.0  # standard errors: another summit
_SPIN = "launch_spin"


def rivals_of(found: Estimate, certainty: Certainty) -> tuple[Found, ...]:
    """The numbers of the puck, and its launch spin, at other summits within the 95 % limit.

    Of one track; several have not been seen to have any.  With angles they are motions of whole
    turns more from frame to frame, where frames are few or noisy.
    """
    problem = found.problem
    if len(problem.films) > 1 or problem.meetings or problem.asked.speeds:
        return ()
    rivals, marked = [], problem.films[0].angle is not None
    summits = [(found.x, *_known(found, certainty))]
    for start in found.minima or minima_of(problem):
        x, cost = minimise(problem, start, SQUARES, found.kept)
        off = [
            (np.abs(_told(x, marked) - _told(one, marked)) > apart)[seen]
            for one, seen, apart in summits
        ]
        if 2.0 * cost < found.chi2 + Z95**2 and all(one.any() for one in off):
            # what one motion tells another may not: each summit is as wide as it is
            own = certainty_of(problem.jacobian(x)[found.kept], plausible_for(problem, x))
            summits.append((x, *_known(found, own)))
            rivals.append(x)
    mine = [(k, name) for k, (track, name) in enumerate(problem.names)
            if track == -1 or name == _SPIN]  # fmt: skip
    return tuple({name: float(x[k]) for k, name in mine} for x in rivals)


def mirrored(found: Estimate, certainty: Certainty) -> tuple[int, ...]:
    """Tracks without angles that the opposite spin fits as well.

    Where it does the tilt hardly differs from its least, to which it then falls, and what the other
    unknowns can do is linear.
    """
    problem, low, high = found.problem, *found.problem.limits
    tilts = [k for k, (_, name) in enumerate(problem.names) if name in ("delta", "height")]
    errors, alike = certainty.errors, []
    for k, (n, name) in enumerate(problem.names):
        if name != _SPIN or problem.films[n].angle is not None:
            continue
        x = found.x.copy()
        x[k] = -x[k]
        if not (abs(x[k]) > _APART * errors[k] and low[k] <= x[k] <= high[k]):
            continue
        x[tilts] = low[tilts]
        few = compact(problem, *problem.residuals_and_jacobian(x), found.kept)
        q, _ = np.linalg.qr(np.delete(few.slopes, tilts, axis=1))
        left = few.rows - q @ (few.rows @ q)
        if float(left @ left) < found.chi2 + Z95**2:
            alike.append(n)
    return tuple(alike)


def _told(x: FloatArray, marked: bool) -> FloatArray:
    """Unknowns as they are compared: without angles a mirror image is no other motion."""
    return x if marked else np.abs(x)


def _known(found: Estimate, certainty: Certainty) -> tuple[npt.NDArray[np.bool_], FloatArray]:
    """Which numbers of the puck, and whether its spin, a summit tells; how far off another is."""
    names = found.problem.names
    asked = np.array([track == -1 or name == _SPIN for track, name in names], bool)
    seen = asked & ~np.array(certainty.undetermined, bool)
    return seen, _APART * np.sqrt(np.diag(certainty.covariance))

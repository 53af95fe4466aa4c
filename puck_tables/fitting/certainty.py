"""How well each number is known, and which the tracks cannot tell.

The Fisher matrix JᵀJ, its unknowns measured by what is plausible for them, has a singular value
below :data:`BLIND` for every direction along which the likelihood hardly changes over the plausible
range.  Numbers that such a direction moves are *not determined*: they get no standard error.  Where
a likelihood is no parabola the 95 % interval is that of the profile likelihood.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.fitting.estimate import Estimate
from puck_tables.fitting.least_squares import SQUARES, minimise

Z95 = 1.959963984540054
BLIND = 2.0  # plausible ranges per standard deviation
_MEMBER = 0.2  # component of a direction that counts
_PARABOLIC = 0.04  # of the drop of the likelihood
_SEARCHES = 14
_OUTWARDS = 3.0
_HARDLY = 0.05


@dataclass(frozen=True, eq=False)
class Certainty:
    """Of the unknowns of an estimate.

    ``covariance`` (m, m); ``blind``: directions that are not seen, each a component for every
    unknown in units of its plausible range; ``undetermined`` (m,): unknowns that one of them moves;
    ``plausible`` (m,); ``quantile``: half a 95 % interval in standard errors, that of Student's t
    where the noise is that of the residuals.
    """

    covariance: FloatArray
    blind: FloatArray
    undetermined: tuple[bool, ...]
    plausible: FloatArray
    quantile: float = Z95

    def error_of(self, slope: FloatArray, plausible: float) -> float:
        """The standard error of what changes with the unknowns by ``slope`` (m,).

        Infinite where a direction that is not seen changes it by a fifth of what is plausible.
        """
        by_blind = np.abs(self.blind @ (slope * self.plausible))
        if by_blind.max(initial=0.0) > _MEMBER * plausible:
            return math.inf
        return math.sqrt(max(float(slope @ self.covariance @ slope), 0.0))

    @property
    def errors(self) -> FloatArray:
        """Standard errors (m,), infinite of what is not determined."""
        found = np.sqrt(np.diag(self.covariance))
        return np.where(self.undetermined, np.inf, found)

    @property
    def correlation(self) -> FloatArray:
        """Correlations (m, m), NaN with what is not determined."""
        root = self.errors
        with np.errstate(invalid="ignore"):
            found: FloatArray = self.covariance / np.outer(root, root)
        found[~np.isfinite(root), :] = found[:, ~np.isfinite(root)] = np.nan
        return found


def quantile_of(degrees: int) -> float:
    """Half a 95 % interval in standard errors that so many degrees of freedom told.

    Examples
    --------
    >>> round(quantile_of(10), 3), round(quantile_of(10**6), 3)
    (2.228, 1.96)
    """
    from scipy.special import stdtrit

    return float(stdtrit(max(degrees, 1), 0.975))


def certainty_of(jacobian: FloatArray, plausible: FloatArray, quantile: float = Z95) -> Certainty:
    """How well unknowns are known, from a Jacobian (n, m) in units of the noise.

    Examples
    --------
    >>> known = certainty_of(np.array([[10.0, 10.0], [0.0, 0.0]]), np.array([1.0, 1.0]))
    >>> known.undetermined, known.blind.round(3).tolist()  # their sum alone is seen
    ((True, True), [[-0.707, 0.707]])
    """
    square = np.zeros((plausible.size, plausible.size))
    triangle = np.linalg.qr(jacobian * plausible, mode="r")
    square[: len(triangle)] = triangle
    _, full, rows = np.linalg.svd(square)
    seen = full > BLIND
    blind = rows[~seen]
    # along what is not seen: no more than what is plausible
    spread = np.where(seen, 1.0 / np.maximum(full, BLIND), 1.0)
    scaled = (rows.T * spread**2) @ rows
    lost = np.abs(blind).max(axis=0, initial=0.0) > _MEMBER
    return Certainty(
        scaled * np.outer(plausible, plausible), blind, tuple(lost.tolist()), plausible,
        quantile,
    )  # fmt: skip


@dataclass(frozen=True)
class Interval:
    """A 95 % interval; ``profiled``: by the profile likelihood, not by the standard error.

    An end that the tracks do not bound is that of the range in which the number was looked for.
    """

    low: float
    high: float
    profiled: bool


def interval_of(found: Estimate, certainty: Certainty, k: int) -> Interval:
    """The 95 % interval of an unknown.

    Both ends of the quadratic one are tried; where the likelihood there is not that of a parabola
    the ends are searched for.
    """
    x, error = float(found.x[k]), math.sqrt(float(certainty.covariance[k, k]))
    low, high = (float(ends[k]) for ends in found.problem.limits)
    if certainty.undetermined[k]:
        return Interval(low, high, False)
    ends, profiled = [], False
    for side, limit in ((-1.0, low), (1.0, high)):
        end, searched = _end(
            found, certainty, k, side, x + side * certainty.quantile * error, limit
        )
        ends.append(end)
        profiled |= searched
    return Interval(ends[0], ends[1], profiled)


def _end(
    found: Estimate, certainty: Certainty, k: int, side: float, guess: float, limit: float
) -> tuple[float, bool]:
    """One end, and whether it is not the guess.

    The root of the rise of χ² is followed outwards, by way of the limit where there is one: a
    likelihood may level off below what bounds anything.
    """
    x0, start = float(found.x[k]), found.x
    near, near_root = x0, 0.0
    far: tuple[float, float] | None = None
    at = side * min(side * guess, side * limit)
    for n in range(_SEARCHES):
        cost, moved = profile_point(found, certainty, k, at, start)
        root = math.sqrt(max(cost - found.chi2, 0.0))
        exact = abs(root / certainty.quantile - 1.0)
        if n == 0 and at == guess and exact < 0.5 * _PARABOLIC:
            return guess, False
        if exact < 0.25 * _PARABOLIC or (root < certainty.quantile and at == limit):
            return at, True
        if root < certainty.quantile:
            near, near_root, start = at, root, moved
        else:
            far = at, root
        if far is None:
            at = limit if math.isfinite(limit) else x0 + _OUTWARDS * (at - x0)
        else:
            share = (certainty.quantile - near_root) / (far[1] - near_root)
            at = near + min(max(share, 0.1), 0.9) * (far[0] - near)
    return at, True


def profile_point(
    found: Estimate, certainty: Certainty, k: int, at: float, start: FloatArray
) -> tuple[float, FloatArray]:
    """The least χ² with an unknown held at a value, and the other unknowns there."""
    moved = start.copy()
    variance = float(certainty.covariance[k, k])
    if variance > 0.0:
        moved += certainty.covariance[:, k] / variance * (at - start[k])
    moved[k] = at
    best = minimise(found.problem, moved, SQUARES, found.kept, held=k)
    if any(film.angle is None for film in found.problem.films):
        # without angles a motion with hardly any spin may be another minimum
        spins = [n for n, (_, name) in enumerate(found.problem.names) if name == "launch_spin"]
        slow = moved.copy()
        slow[spins] *= _HARDLY
        other = minimise(found.problem, slow, SQUARES, found.kept, held=k)
        best = min(best, other, key=lambda one: one[1])
    return 2.0 * best[1], best[0]

"""How well each number is known, and which the tracks cannot tell.

The Fisher matrix JᵀJ, its unknowns measured by what is plausible for them, has a singular value
below :data:`BLIND` for every direction along which the likelihood hardly changes over the plausible
range.  Numbers that such a direction moves are *not determined*: they get no standard error.  Where
a likelihood is no parabola the 95 % interval is that of the profile likelihood.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.fitting.estimate import Estimate
from puck_tables.fitting.problem import FROM_NEARBY, multi_start, triangle
from puck_tables.fitting.slides import NumbersOf

Z95 = 1.959963984540054  # standard deviations to the ends of a 95 % interval of a normal
BLIND = 2.0  # plausible ranges per standard deviation
_MEMBER = 0.2  # component of a direction that counts
_PARABOLIC = 0.04  # of the drop of the likelihood
_SEARCHES = 14  # values tried for an end of an interval; each is a fit
_OUTWARDS, _BEYOND, _LOOKS = 3.0, 1.15, 3  # times a way; times the root foreseen; tries of it
_FAR, _NARROW = 2.0, 0.005  # times the rise wanted; of the way: a jump, where two minima meet
_HARDLY = 0.05  # of a spin: from there another minimum with hardly any is looked for
_ON_BOUND = 1e-4  # of a bound, or of an error: an unknown lies on it
_OFF_BOUND = 0.5  # errors from a bound: it does not, however small numbers are
_ROUNDING = 1e-6  # of what is plausible: by less nothing follows from an end
_PARTS, _FINE = (2, 4, 8), 16  # parts that a jackknife leaves out one by one
_UNTOLD = 1e5  # times the variance of a number: what is left does not tell it


@dataclass(frozen=True, eq=False)
class Certainty:
    """Of the unknowns of an estimate.

    ``covariance`` (m, m) where the noise is as it was found; ``blind``: directions that are not
    seen, each a component for every unknown in units of its plausible range; ``undetermined`` (m,):
    unknowns that one of them moves; ``plausible`` (m,); ``degrees``: how many residuals told the
    noise, infinite where it is known; ``pinned`` (m,): −1 for an unknown on the lower end of its
    range, 1 on the upper: χ² has no minimum there, so that it has no standard error (NaN);
    ``widened``: whether the covariance is that of a model that does not fit; ``narrow``: what it
    was before anything widened it, None where nothing did.
    """

    covariance: FloatArray
    blind: FloatArray
    undetermined: tuple[bool, ...]
    plausible: FloatArray
    degrees: float = math.inf
    pinned: tuple[int, ...] = ()
    widened: bool = False
    narrow: FloatArray | None = None

    def lost(self) -> Certainty:
        """Certainty where nothing is seen: no motion comes near the tracks."""
        count = self.plausible.size
        return replace(self, blind=np.eye(count), undetermined=(True,) * count)

    @property
    def quantile(self) -> float:
        """Half a 95 % interval where the noise is as it was found: that of Student's t."""
        if self.degrees == math.inf:
            return Z95
        from scipy.special import stdtrit

        return float(stdtrit(max(self.degrees, 1), 0.975))

    def wider(self, covariance: FloatArray, widened: bool) -> Certainty:
        """With a larger covariance (m, m)."""
        narrow = self.covariance if self.narrow is None else self.narrow
        widened |= self.widened
        return replace(self, covariance=covariance, widened=widened, narrow=narrow)

    def observed(self) -> Certainty:
        """The certainty that the film alone gives, before anything widened it."""
        covariance = self.covariance if self.narrow is None else self.narrow
        return replace(self, covariance=covariance, narrow=None)

    def ratio(self, k: int) -> float:
        """By how much the error of an unknown is wider than the likelihood says."""
        if self.narrow is None or not self.narrow[k, k] > 0.0:
            return 1.0
        return math.sqrt(float(self.covariance[k, k] / self.narrow[k, k]))

    @property
    def spread(self) -> float:
        """A standard deviation of Student's t: by so much few residuals make errors larger."""
        few = self.degrees < math.inf
        return math.sqrt(self.degrees / max(self.degrees - 2.0, 0.2)) if few else 1.0

    @property
    def reach(self) -> float:
        """Half a 95 % interval in standard errors."""
        return self.quantile / self.spread

    def error_of(self, slope: FloatArray, plausible: float) -> float:
        """The standard error of what changes with the unknowns by ``slope`` (m,).

        Infinite where a direction that is not seen changes it by a fifth of what is plausible, or
        where nothing is seen.
        """
        unseen = np.abs(self.blind @ (slope * self.plausible)).max(initial=0.0)
        if all(self.undetermined) or unseen > _MEMBER * plausible:
            return math.inf
        return self.spread * math.sqrt(max(float(slope @ self.covariance @ slope), 0.0))

    def follows_end(self, slope: FloatArray, plausible: float) -> bool:
        """Whether what changes by ``slope`` (m,) follows from what is on the end of its range."""
        by_each = np.abs(slope * self.plausible)[np.flatnonzero(self.pinned)]
        return bool(by_each.max(initial=0.0) > _ROUNDING * plausible)

    @property
    def errors(self) -> FloatArray:
        """Standard errors (m,), infinite of what is not determined, NaN on the end of a range."""
        result = self.spread * np.sqrt(np.diag(self.covariance))
        result[np.flatnonzero(self.pinned)] = np.nan
        return np.where(self.undetermined, np.inf, result)

    @property
    def correlation(self) -> FloatArray:
        """Correlations (m, m), NaN with what is not determined."""
        root = self.errors
        with np.errstate(invalid="ignore"):
            result: FloatArray = self.spread**2 * self.covariance / np.outer(root, root)
        result[~np.isfinite(root), :] = result[:, ~np.isfinite(root)] = np.nan
        return result


class OtherMinimum(NamedTuple):
    """A minimum beside the best: estimate, certainty, χ² more, tracks that spin otherwise."""

    estimate: Estimate
    certainty: Certainty
    rise: float
    tracks: tuple[int, ...]

    @property
    def numbers(self) -> NumbersOf:
        """The numbers of the puck there, and the launch spins of tracks that spin otherwise."""
        problem, x = self.estimate.problem, self.estimate.x
        spins = problem.launches(x)[:, 4]
        alone = len(problem.films) == 1
        return problem.numbers_at(x) | {
            "launch_spin" if alone else f"launch_spin of {problem.films[n].name}": float(spins[n])
            for n in self.tracks
        }


def certainty_of(
    jacobian: FloatArray, plausible: FloatArray, degrees: float = math.inf
) -> Certainty:
    """How well unknowns are known, from a Jacobian (n, m) in units of the noise.

    >>> known = certainty_of(np.array([[10.0, 10.0], [0.0, 0.0]]), np.array([1.0, 1.0]))
    >>> known.undetermined, known.blind.round(3).tolist()  # their sum alone is seen
    ((True, True), [[-0.707, 0.707]])
    >>> round(replace(known, degrees=10).quantile, 3)
    2.228
    """
    square = np.zeros((plausible.size, plausible.size))
    few = triangle(jacobian * plausible)
    square[: len(few)] = few
    _, full, rows = np.linalg.svd(square)
    seen = full > BLIND
    blind = rows[~seen]
    # along what is not seen: no more than what is plausible
    spread = np.where(seen, 1.0 / np.maximum(full, BLIND), 1.0)
    scaled = (rows.T * spread**2) @ rows
    lost = np.abs(blind).max(axis=0, initial=0.0) > _MEMBER
    covariance = scaled * np.outer(plausible, plausible)
    return Certainty(covariance, blind, tuple(lost.tolist()), plausible, degrees)


def certainty_at(result: Estimate, degrees: float = math.inf) -> Certainty:
    """How well the unknowns of an estimate are known."""
    plausible = result.problem.plausible(result.x)
    return certainty_of(result.jacobian[result.kept], plausible, degrees)


def pinned_of(result: Estimate, certainty: Certainty) -> tuple[int, ...]:
    """Which unknowns that are seen lie on the end of their range: −1 the lower, 1 the upper."""
    seen = np.isfinite(certainty.errors)
    errors, on = np.where(seen, certainty.errors, 0.0), []
    for end in result.problem.limits:
        width = np.minimum(_ON_BOUND * np.maximum(np.abs(end), 1.0), _OFF_BOUND * errors)
        width = np.maximum(width, _ON_BOUND * errors)
        on.append(seen & np.isfinite(end) & (np.abs(result.x - end) <= width))
    return tuple(np.where(on[0], -1, on[1].astype(int)).tolist())


def widened(
    result: Estimate, certainty: Certainty, biases: FloatArray, most: float = math.inf
) -> Certainty:
    """Certainty under a model that misfits: with the jackknife's of halves, quarters, eighths.

    ``biases`` (m, k): what k forces may have done to the unknowns, too; ``most``: no error becomes
    so many times wider: parts of few frames, and forces, tell little, what they do is mostly noise.
    """
    more = biases @ biases.T + sum(_without_parts(result, certainty, count) for count in _PARTS)
    own, shown = np.diag(certainty.covariance), np.maximum(np.diag(more), 1e-300)
    share = np.sqrt(np.minimum((most * most - 1.0) * own / shown, 1.0))
    return certainty.wider(certainty.covariance + more * np.outer(share, share), True)


def of_rounded(result: Estimate, certainty: Certainty) -> Certainty:
    """Certainty of rounded tracks: errors that sixteenths of the frames show, where larger."""
    shown = np.diag(_without_parts(result, certainty, _FINE))
    wider = np.sqrt(np.maximum(shown / np.maximum(np.diag(certainty.covariance), 1e-300), 1.0))
    return certainty.wider(certainty.covariance * np.outer(wider, wider), False)


def shifted_by(result: Estimate, certainty: Certainty, columns: FloatArray) -> FloatArray:
    """What changes of the residuals (n, k) do to the unknowns (m, k)."""
    slopes, square = _scaled(result, certainty)
    changes = np.linalg.solve(square, slopes.T @ columns)
    return -changes * certainty.plausible[:, None]


def _scaled(result: Estimate, certainty: Certainty) -> tuple[FloatArray, FloatArray]:
    """Derivatives that count in units of what is plausible, and their square, bounded by that."""
    slopes = result.jacobian * certainty.plausible * result.kept[:, None]
    slopes[:, np.flatnonzero(certainty.pinned)] = 0.0
    return slopes, slopes.T @ slopes + np.eye(certainty.plausible.size)


def _without_parts(result: Estimate, certainty: Certainty, count: int) -> FloatArray:
    """The covariance that leaving out a part of the frames at a time shows: the jackknife's.

    Without a part that alone tells a number (all of a slide up to an impact): that shows nothing.
    """
    slopes, square = _scaled(result, certainty)
    rows, changes = result.residuals * result.kept, []
    # what little is left of a slope at the minimum, parts that hardly tell a number would magnify
    rows = rows - slopes @ np.linalg.lstsq(slopes, rows, rcond=None)[0]
    for film in result.problem.each():
        parts = zip(*(np.array_split(np.r_[one], count) for one in film), strict=True)
        for frames in (np.concatenate(part) for part in parts):
            mine = slopes[frames]
            left = square - mine.T @ mine
            if np.linalg.eigvals(np.linalg.solve(left, square)).real.max() < _UNTOLD:
                changes.append(np.linalg.solve(left, mine.T @ rows[frames]))
    each = np.reshape(changes, (-1, certainty.plausible.size)) * certainty.plausible
    each -= each.mean(axis=0) if len(each) else 0.0
    return (1.0 - 1.0 / max(len(each), 1)) * each.T @ each


@dataclass(frozen=True)
class Interval:
    """A 95 % interval; ``profiled``: by the profile likelihood, not by the standard error.

    An end that the tracks do not bound is that of the range in which the number was looked for.
    """

    low: float
    high: float
    profiled: bool

    def wider(self, value: float, ratio: float, low: float, high: float) -> Interval:
        """An interval whose ends are farther from a value by a ratio, within a range."""
        ends = [value + ratio * (end - value) for end in (self.low, self.high)]
        return replace(self, low=max(ends[0], low), high=min(ends[1], high))


def interval_of(result: Estimate, certainty: Certainty, k: int) -> Interval:
    """The 95 % interval of an unknown.

    Both ends of the quadratic one are tried; where the likelihood there is not that of a parabola
    the ends are searched for.  What widens the error widens it, too.
    """
    low, high = (float(ends[k]) for ends in result.problem.limits)
    ratio = certainty.ratio(k)
    if ratio > 1.0 and not certainty.undetermined[k]:
        own = interval_of(result, certainty.observed(), k)
        return own.wider(float(result.x[k]), ratio, low, high)
    x, error = float(result.x[k]), math.sqrt(float(certainty.covariance[k, k]))
    if certainty.undetermined[k]:
        return Interval(low, high, False)
    (one, searched), (other, too) = (
        _end(result, certainty, k, side, x + side * certainty.quantile * error, limit)
        for side, limit in ((-1.0, low), (1.0, high))
    )
    return Interval(one, other, searched or too)


def _end(
    result: Estimate, certainty: Certainty, k: int, side: float, guess: float, limit: float
) -> tuple[float, bool]:
    """One end, and whether it is not the guess.

    The root of the rise of χ² is followed outwards, in the end by way of the limit where there is
    one: a likelihood may level off below what bounds anything.  Between two values the end is
    sought by false position; a value that stays the second time counts half (Illinois).
    """
    x0, start, wanted = float(result.x[k]), result.x, certainty.quantile
    near, far = (x0, -wanted), (math.nan, math.inf)  # value, and how far its root is off
    at, last = side * min(side * guess, side * limit), 0.0
    for n in range(_SEARCHES):
        cost, moved = profile_point(result, certainty, k, at, start)
        deviations = math.sqrt(max(cost - result.chi2, 0.0)) - wanted
        if n == 0 and at == guess and abs(deviations) < 0.5 * _PARABOLIC * wanted:
            return guess, False
        if abs(deviations) < 0.25 * _PARABOLIC * wanted or (deviations < 0.0 and at == limit):
            return at, True
        if deviations < 0.0:
            far = (far[0], 0.5 * far[1]) if last < 0.0 else far
            near, start = (at, deviations), moved
        else:
            near = (near[0], 0.5 * near[1]) if last > 0.0 else near
            far = at, min(deviations, _FAR * wanted)
        last = deviations
        if far[1] < math.inf:
            at = near[0] + min(max(near[1] / (near[1] - far[1]), 0.1), 0.9) * (far[0] - near[0])
            if abs(far[0] - near[0]) < _NARROW * abs(far[0] - x0):  # another minimum begins there
                return at, True
        elif deviations > -0.5 * wanted and n < _LOOKS:
            farther = _BEYOND * wanted / (wanted + deviations) * abs(at - x0)
            at = x0 + side * min(farther, abs(limit - x0))
        else:
            at = limit if math.isfinite(limit) else x0 + _OUTWARDS * (at - x0)
    return at, True


def profile_point(
    result: Estimate, certainty: Certainty, k: int, at: float, start: FloatArray
) -> tuple[float, FloatArray]:
    """The least χ² with an unknown held at a value, and the other unknowns there."""
    moved = start.copy()
    variance = float(certainty.covariance[k, k])
    if variance > 0.0:
        moved += certainty.covariance[:, k] / variance * (at - start[k])
    moved[k] = at
    starts = [(result.problem, moved)]
    if any(film.angle is None for film in result.problem.films):
        # without angles a motion with hardly any spin may be another minimum
        spins = [n for n, (_, name) in enumerate(result.problem.names) if name == "launch_spin"]
        slow = moved.copy()
        slow[spins] *= _HARDLY
        starts.append((result.problem, slow))
    (best, cost), *_ = multi_start(starts, FROM_NEARBY, kept=result.kept, held=k)
    return 2.0 * cost, best

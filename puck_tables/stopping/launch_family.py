"""The launches that stop at one distance, as functions of u = ln(r|ω|/v): where they turn back.

All launches of a puck that stop at distance D are one curve over u, with J = D = r = 1

    ln Q = −½ ln|Z|,   Z = X + iY,   ln v = ln Q + ln cos φ,   ln r|ω| = ln v + u,
    ln t₀ = ln Q + ln T,   ln θ = 2 ln Q + ln Θ, the angle by which the puck turns.

T and Z obey linear equations in u (:mod:`puck_tables.stopping.similarity`), so that the derivatives
of the curve need nothing but its values and the friction, with σ = (r²/2k²) ρ_ω

    (ρ_∥ − σ) (ln v, ln r|ω|, ln t₀)′ = ½ cos φ Re(1/Z) − (ρ_∥, σ, 1/T),
    (ρ_∥ − σ) (ln θ)′ = cos φ Re(1/Z) − sin φ/Θ,
    (ρ_∥ − σ) (arg Z)′ = sin φ ρ_⊥ − cos φ Im(1/Z).

Of a tall puck speed and time are not monotonic: paths bend, and a launch with spin may be the
fastest of all.  The curve is resolved until cubics through its values and derivatives predict it;
where one of these turns, the curve turns.  With the middles that were predicted it is looked up in
pieces of the fifth degree.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.quadratic import NO_SECTION
from puck_tables.motion.body import UnitPuck
from puck_tables.motion.unit_motion import direction
from puck_tables.stopping.aim_lookup import (
    DEFLECTION,
    LOGS,
    NO_PIECES,
    PIECE,
    POWERS,
    RIM,
    SLIDE,
    SPEED,
    TURN,
    fill_logs,
    fill_roots,
)
from puck_tables.stopping.exact import integrated_stops
from puck_tables.stopping.lookup import WIDTH, at_height
from puck_tables.stopping.stop_table import StopTable

LARGEST_U = 600.0  # beyond, ratios of spin to speed leave floating point
SECTION_ACCURACY = 5e-10  # of friction: what answers are good to, 1e-9, with a margin of two
_LOCAL = 1e-12  # of a step, where friction is a section
_PLAIN_LOCAL = 2e-13  # of a step, with closed forms
_SCANNED, _SPACING = 36.0, 0.25  # of u: beyond, nodes are far; and between nodes
_RESOLVED = 1e-8  # of logarithms: how far a cubic may be off in the middle
_LOG_ERROR = 1e-10  # of logarithms, what a look-up is good to
_NARROWEST = 1e-7  # of u between nodes: next to a line it does not get smooth
_NEAR_LIMIT = 1e-3  # of |ρ_∥ − σ|: the derivatives are 0/0 at the limit of the motion
_OF_STOPS = [0, 1, 2, 4]  # columns of what is integrated: time, place, angle
_SLACK = 1e-12  # of logarithms: rounding
_ROUNDED = 1e-9  # values closer than this to the slide's are rounding

_AT = np.array([0.0, 0.5, 1.0])[:, None]
_POWERS_AT = np.concatenate([  # of a piece at both ends and in the middle, then their slopes
    _AT ** np.arange(POWERS),
    np.arange(POWERS) * _AT ** np.maximum(np.arange(POWERS) - 1, 0),
])  # fmt: skip

SLIDE_ROW = np.array([SLIDE, -math.inf, SLIDE, -math.inf, 0.0])  # of a slide without spin
_FROM_NOTHING = (RIM, TURN)  # which the slide without spin has none of
Indices = npt.NDArray[np.int64]


@dataclass(frozen=True)
class LaunchFamily:
    """Ln v, ln r|ω|, ln t₀ and ln θ of all launches that stop at 1 m, J = 1 m/s², r = 1 m.

    ``u``: array (n,), ascending; between two all four quantities are monotonic; ``values``: array
    (n, 4); ``limits``: array (m, 32), see :mod:`puck_tables.stopping.aim_lookup`; none of a plain
    puck; ``fit``: array (m,), which of them fit the curve.
    """

    body: UnitPuck
    u: FloatArray = field(repr=False)
    values: FloatArray = field(repr=False)
    limits: FloatArray = field(repr=False)
    fit: npt.NDArray[np.bool_] = field(repr=False)

    def rows(self, u: FloatArray) -> FloatArray:
        """Ln v, ln r|ω|, ln t₀, ln θ, and arg Z for ω > 0, at u (n,), (n, 5); u = −∞ slides."""
        return np.column_stack(_logs(u, _stops(self.body, u)))

    @cached_property
    def _section(self) -> FloatArray:
        if self.body.is_plain:
            return at_height(StopTable.shipped().thinned(), self.body.delta)
        return np.empty((2, WIDTH))

    def is_tabulated(self, u: FloatArray) -> npt.NDArray[np.bool_]:
        """Where the curve is looked up (n,): not far out, nor where its pieces do not fit it."""
        if self.body.is_plain:
            return np.abs(u) <= LARGEST_U
        starts = self.limits[:, 0]
        piece = np.searchsorted(starts, u, side="right") - 1
        last = starts[-1] + 1.0 / self.limits[-1, 1]
        inside: npt.NDArray[np.bool_] = (piece >= 0) & (u <= last) & self.fit[np.maximum(piece, 0)]
        return inside

    def looked_up(self, u: FloatArray) -> FloatArray:
        """The columns of :meth:`rows` to 1e-10, integrated only where they are not tabulated."""
        slides = u == -math.inf
        inside = self.is_tabulated(u)
        out = np.empty((u.size, LOGS))
        fill_logs(np.where(inside | slides, u, 0.0), self._section, self.limits, out)
        others = ~inside & ~slides
        if others.any():
            out[others] = self.rows(u[others])
        return out

    def roots(self, quantity: int, values: FloatArray) -> tuple[Indices, FloatArray, FloatArray]:
        """All u where a quantity has one of ``values`` (n,): of which, u (m,), the rows (m, 5).

        In ascending order; −∞ is the slide without spin.  To 1e-10, as :meth:`looked_up`.
        """
        which, low, high = self.brackets(quantity, values)
        wanted, u, single = values[which], np.empty(which.size), low == high
        # brackets end where pieces do
        blind = ~single & ~self.is_tabulated(0.5 * low + 0.5 * high)
        first = np.where(blind, high, low)
        fill_roots(quantity, wanted, first, high, self._section, self.limits, u)
        rows = self.looked_up(u)
        for n in np.flatnonzero(blind):
            u[n] = self.searched(quantity, wanted[n], low[n], high[n])
            rows[n] = self.rows(u[n : n + 1])[0]
        order = np.lexsort((u, which))
        which, u, rows = which[order], u[order], rows[order]
        fresh = np.ones(which.size, bool)
        fresh[1:] = (which[1:] != which[:-1]) | (u[1:] != u[:-1])
        return which[fresh], u[fresh], rows[fresh]

    def searched(self, quantity: int, wanted: float, low: float, high: float) -> float:
        """A root between two u by integrations alone."""
        from scipy.optimize import brentq

        def error(u: float) -> float:
            return float(self.rows(np.array([u]))[0, quantity]) - wanted

        return float(brentq(error, low, high, xtol=1e-14, rtol=1e-15))

    def brackets(self, quantity: int, values: FloatArray) -> tuple[Indices, FloatArray, FloatArray]:
        """Where a quantity has one of ``values`` (n,): of which, and intervals of u, (m,) each.

        In each is one such place.  Both ends are the same where it turns just there, and −∞ where
        the slide without spin has the value.  A value beyond a turn by 1e-9 counts as met there: so
        it may have been printed.
        """
        u, levels, turns = self._branches[quantity]
        result: list[tuple[Indices, Any, Any]] = [(np.empty(0, np.int64), 0.0, 0.0)]
        finite = np.isfinite(values)
        values = np.where(finite, values, 0.0)
        least, largest = values.min(initial=math.inf), values.max(initial=-math.inf)
        if quantity not in _FROM_NOTHING:
            past = values - SLIDE
            behind = past * (levels[0] - values)
            slides = (np.abs(past) <= _SLACK) | ((np.abs(past) <= _ROUNDED) & (behind < 0.0))
            result.append((np.flatnonzero(finite & slides), -math.inf, -math.inf))
            between = np.flatnonzero(finite & ~slides & (behind > 0.0))
            result.append((between, -LARGEST_U, u[0]))
        for first, last in pairwise(turns):
            bottom, top = sorted((levels[first], levels[last]))
            if top < least or bottom > largest:
                continue
            up = levels[last] >= levels[first]
            sign = 1.0 if up else -1.0
            own = sign * levels[first : last + 1]
            at = np.searchsorted(own, sign * values, side="left" if up else "right")
            inside = np.flatnonzero(finite & (at > 0) & (at < own.size))
            after = first + at[inside]
            result.append((inside, u[after - 1], u[after]))
        for turn in turns[1:-1]:
            error = levels[turn] - values
            beyond = error * (levels[turn] - levels[turn - 1]) <= 0.0
            short = np.flatnonzero(finite & beyond & (np.abs(error) <= _ROUNDED))
            result.append((short, u[turn], u[turn]))
        which = np.concatenate([one for one, _, _ in result])
        low, high = (
            np.concatenate([np.broadcast_to(row[end], row[0].shape) for row in result])
            for end in (1, 2)
        )
        return which, low, high

    @cached_property
    def _branches(self) -> list[tuple[FloatArray, FloatArray, list[int]]]:
        """Of each quantity: u, its levels, and at which it turns, with both ends.

        Of speed and time from where they leave those of the slide without spin.
        """
        result = []
        for quantity, levels in enumerate(self.values.T):
            away = np.abs(levels - SLIDE) > _ROUNDED
            begin = 0 if quantity in _FROM_NOTHING else int(np.flatnonzero(away)[0])
            levels = np.ascontiguousarray(levels[begin:])
            up = np.sign(np.diff(levels))
            moves = np.flatnonzero(up)
            turns = moves[1:][up[moves[1:]] != up[moves[:-1]]]
            result.append((self.u[begin:], levels, [0, *turns.tolist(), levels.size - 1]))
        return result

    def extreme(self, quantity: int) -> tuple[float, float]:
        """The u and the value where the speed is greatest, or the time least; u = −∞: the slide."""
        sign = 1.0 if quantity == SPEED else -1.0
        n = int((sign * self.values[:, quantity]).argmax())
        if sign * (self.values[n, quantity] - SLIDE) <= _ROUNDED:
            return -math.inf, SLIDE
        return float(self.u[n]), float(self.values[n, quantity])


@lru_cache(maxsize=64)
def launch_family_of(body: UnitPuck) -> LaunchFamily:
    """Of a puck: kept, the same call again costs nothing.

    >>> from puck_tables.motion.body import body_of
    >>> family = launch_family_of(body_of("uniform", 0.5, 0.5**0.5))
    >>> family.roots(RIM, np.array([1.0]))[1].round(6).tolist()
    [1.216315]
    >>> u, fastest = launch_family_of(body_of("uniform", 3.9, 0.1)).extreme(SPEED)
    >>> u > -4.0, fastest > 0.5 * math.log(2.0)
    (True, True)
    """
    ends = np.array([-LARGEST_U, LARGEST_U])
    if body.is_plain:  # the quantities never turn
        return LaunchFamily(body, ends, _values(body, ends), NO_PIECES, np.empty(0, bool))
    u = _first_nodes(body)
    values, slopes = _with_slopes(body, u)
    middles = np.full((2, u.size - 1, LOGS), np.nan)  # values and slopes there
    fresh = np.ones(u.size - 1, bool)
    while fresh.any():
        n = np.flatnonzero(fresh)
        width = u[n + 1] - u[n]
        new, new_slopes = middles[:, n] = _with_slopes(body, 0.5 * (u[n] + u[n + 1]))
        guess = 0.5 * (values[n] + values[n + 1])
        guess += 0.125 * width[:, None] * (slopes[n] - slopes[n + 1])
        error = np.abs(guess - new).max(axis=1)
        # no derivative next to the limit, where the curve is analytic
        kept = np.isfinite(new_slopes).all(axis=1)
        into = kept & ~(error <= _RESOLVED) & (width > _NARROWEST)
        n = n[into]
        u = np.insert(u, n + 1, 0.5 * (u[n] + u[n + 1]))
        values = np.insert(values, n + 1, new[into], axis=0)
        slopes = np.insert(slopes, n + 1, new_slopes[into], axis=0)
        middles = np.insert(middles, n + 1, np.nan, axis=1)
        fresh = np.zeros(u.size - 1, bool)
        both = n + np.arange(n.size)
        fresh[both], fresh[both + 1] = True, True
    limits, fit = _pieces(body, u, values, slopes, middles)
    turns = np.unique(_turns(u, values[:, :DEFLECTION], slopes[:, :DEFLECTION]))
    more = np.concatenate([ends, turns])
    u = np.concatenate([u, more])
    values = np.concatenate([values[:, :DEFLECTION], _values(body, more)])
    order = np.argsort(u, kind="stable")
    return LaunchFamily(body, u[order], values[order], limits, fit)


def _first_nodes(body: UnitPuck) -> FloatArray:
    """Everywhere, and next to the lines of the friction on both sides; none next to the limit."""
    lines = np.log(np.tan(np.array(body.friction(SECTION_ACCURACY).lines)))
    near = np.outer([-1.0, 1.0], 10.0 ** -np.arange(1.0, 6.5, 0.5)).ravel()
    steps = round(2.0 * _SCANNED / _SPACING) + 1
    u = np.concatenate([
        np.linspace(-_SCANNED, _SCANNED, steps), lines, (lines[:, None] + near).ravel(),
    ])  # fmt: skip
    u = np.unique(u)
    away: FloatArray = u[np.isfinite(_with_slopes(body, u)[1]).all(axis=1)]
    return away


def _turns(u: FloatArray, values: FloatArray, slopes: FloatArray) -> FloatArray:
    """Where the cubics between nodes turn."""
    from scipy.interpolate import CubicHermiteSpline

    rates = CubicHermiteSpline(u, values, slopes).derivative()
    turns: FloatArray = np.concatenate(rates.roots(discontinuity=False, extrapolate=False))
    return turns[np.isfinite(turns)]  # NaN: the same from there to the next node


def _stops(body: UnitPuck, u: FloatArray) -> FloatArray:
    """T, X, Y, Θ at u (n,), (n, 4)."""
    heights, unit = np.full(u.size, body.delta), direction(u)[0]
    if body.is_plain:
        return integrated_stops(u, heights, NO_SECTION, _PLAIN_LOCAL, unit)[:, _OF_STOPS]
    section = body.friction(SECTION_ACCURACY).for_motion(body.gyration)
    return integrated_stops(u, heights, section, _LOCAL, unit)[:, _OF_STOPS]


def _logs(u: FloatArray, stops: FloatArray) -> tuple[FloatArray, ...]:
    """Ln v, ln r|ω|, ln t₀, ln θ and arg Z from stops."""
    time, x, y, turn = stops.T
    log_q = -0.5 * np.log(np.hypot(x, y))
    larger = log_q - 0.5 * np.log1p(np.exp(-2.0 * np.abs(u)))
    with np.errstate(divide="ignore"):
        log_turn = 2.0 * log_q + np.log(turn)
    return (
        larger - np.maximum(u, 0.0), larger + np.minimum(u, 0.0), log_q + np.log(time), log_turn,
        np.arctan2(y, x),
    )  # fmt: skip


def _values(body: UnitPuck, u: FloatArray) -> FloatArray:
    return np.column_stack(_logs(u, _stops(body, u))[:DEFLECTION])


def _with_slopes(body: UnitPuck, u: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Values and their derivatives, both (n, 5); the derivatives NaN next to the limit."""
    stops = _stops(body, u)
    values = np.column_stack(_logs(u, stops))
    time, x, y, turn = stops.T
    inverse, across, spin = body.friction(SECTION_ACCURACY).ratios(np.arctan(np.exp(u))).T
    along = 1.0 / inverse
    turning = 0.5 / body.inertia * spin * along
    (cosine, sine), size2 = direction(u), x * x + y * y
    common = 0.5 * cosine * x / size2
    gap = along - turning
    gap[np.abs(gap) < _NEAR_LIMIT] = np.nan
    swung = sine * across * along + cosine * y / size2
    fading = 2.0 * common - sine / turn
    raw = np.column_stack([common - along, common - turning, common - 1.0 / time, fading, swung])
    return values, raw / gap[:, None]


def _pieces(
    body: UnitPuck, u: FloatArray, values: FloatArray, slopes: FloatArray, middles: FloatArray
) -> tuple[FloatArray, npt.NDArray[np.bool_]]:
    """The powers of u between nodes, (n − 1, 32), and which of them fit, (n − 1,).

    From values and slopes at both ends and in the middle; where that has no slope, without it, and
    tried against an integration on both sides of it.
    """
    width = np.diff(u)
    level, slope = (
        np.stack([one[:-1], middle, one[1:]])
        for one, middle in zip((values, slopes), middles, strict=True)
    )
    known = np.concatenate([level, slope * width[:, None]])
    blind = ~np.isfinite(slope[1]).all(axis=1)
    result = np.zeros((POWERS, width.size, LOGS))
    for rows, chosen in (([0, 1, 2, 3, 4, 5], ~blind), ([0, 1, 2, 3, 5], blind)):
        at = _POWERS_AT[rows][:, : len(rows)]
        one = known[rows][:, chosen]
        result[: len(rows), chosen] = np.linalg.solve(at, one.reshape(len(rows), -1)).reshape(
            one.shape
        )
    limits = np.empty((width.size, PIECE))
    limits[:, 0], limits[:, 1] = u[:-1], 1.0 / width
    limits[:, 2:] = result.transpose(1, 2, 0).reshape(width.size, -1)
    fit = np.ones(width.size, bool)
    for share in (0.25, 0.75):
        there = u[:-1][blind] + share * width[blind]
        truth = np.column_stack(_logs(there, _stops(body, there)))
        guess = np.empty((there.size, LOGS))
        fill_logs(there, np.empty((2, WIDTH)), limits, guess)
        fit[blind] &= (np.abs(guess - truth) <= _LOG_ERROR).all(axis=1)
    return limits, fit

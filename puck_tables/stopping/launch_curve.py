"""The launches that stop at one distance, as functions of u = ln(r|ω|/v): where they turn back.

All launches of a puck that stop at distance D are one curve over u, with J = D = 1

    ln Q = −½ ln|Z|,   Z = X + iY,   ln v = ln Q + ln cos φ,   ln r|ω| = ln v + u,
    ln t₀ = ln Q + ln T.

T and Z obey linear equations in u (:mod:`puck_tables.stopping.curve`), so that the derivatives of
the curve need nothing but its values and the friction,

    (ρ_∥ − σ) (ln v, ln r|ω|, ln t₀)′ = ½ cos φ Re(1/Z) − (ρ_∥, σ, 1/T),   σ = (r²/2k²) ρ_ω .

Of a tall puck speed and time are not monotonic: paths bend, and a launch with spin may be the
fastest of all.  The curve is resolved until cubics through its values and derivatives predict it;
where one of these turns, the curve turns.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.section_spline import NO_SECTION
from puck_tables.motion.body import Body
from puck_tables.stopping.exact import integrated_stops
from puck_tables.stopping.launches import launches_of
from puck_tables.stopping.stop_table import StopTable

SPEED, RIM, TIME = range(3)
BEND = 3  # arg Z, no quantity to be met
LARGEST_U = 600.0  # beyond, ratios of spin to speed leave floating point
SECTION_ACCURACY = 5e-10
_LOCAL = 1e-12
_PLAIN_LOCAL = 2e-13
_SAMPLED_U = math.log(math.tan(math.radians(80.0)))  # as far as is sampled without a bound
_SCANNED, _SPACING = 36.0, 0.25
_RESOLVED = 1e-8
_NARROWEST = 1e-7
_NEAR_LIMIT = 1e-3  # of |ρ_∥ − σ|: the derivatives are 0/0 at the limit of the motion
SLIDE = 0.5 * math.log(2.0)  # ln v = ln t₀ of the slide without spin
_SECTIONS, _NARROW = 200, 1e-4  # of a bracket of u, and how narrow it gets
_SLACK = 1e-12
_ROUNDED = 1e-9  # values closer than this to the slide's are rounding


@dataclass(frozen=True)
class LaunchCurve:
    """Ln v, ln r|ω| and ln t₀ of all launches that stop at distance 1 m, J = 1 m/s².

    Parameters
    ----------
    body : Body
    u : array (n,), ascending; between two all three quantities are monotonic
    values : array (n, 3)
    """

    body: Body
    u: FloatArray = field(repr=False)
    values: FloatArray = field(repr=False)

    def rows(self, u: FloatArray) -> FloatArray:
        """Ln v, ln r|ω|, ln t₀ and arg Z for ω > 0, at u (n,), (n, 4); u = −∞ slides."""
        return np.column_stack(_logs(u, _stops(self.body, u)))

    def brackets(self, quantity: int, value: float) -> list[tuple[float, float]]:
        """Where a quantity has a value: intervals of u with one such place in each.

        Both ends are the same where it turns just there, and −∞ where the slide without spin has
        the value.  A value beyond a turn by 1e-9 counts as met there: so it may have been printed.
        """
        if not math.isfinite(value):
            return []
        u, off, found = self.u, self.values[:, quantity] - value, []
        if quantity != RIM:
            above = np.flatnonzero(np.abs(self.values[:, quantity] - SLIDE) > _ROUNDED)
            u, off = u[above[0] :], off[above[0] :]
            past = value - SLIDE
            if abs(past) <= _SLACK or (abs(past) <= _ROUNDED and past * off[0] < 0.0):
                found.append((-math.inf, -math.inf))
            elif past * off[0] > 0.0:
                found.append((-LARGEST_U, float(u[0])))
        sign = off >= 0.0
        for n in np.flatnonzero(sign[:-1] != sign[1:]):
            found.append((float(u[n]), float(u[n + 1])))
        before, after = off[1:-1] - off[:-2], off[1:-1] - off[2:]
        short = (before * after > 0.0) & (off[1:-1] * before <= 0.0)
        for n in np.flatnonzero(short & (np.abs(off[1:-1]) <= _ROUNDED)):
            found.append((float(u[n + 1]), float(u[n + 1])))
        return found

    def extreme(self, quantity: int) -> tuple[float, float]:
        """The u and the value where the speed is greatest, or the time least; u = −∞: the slide."""
        sign = 1.0 if quantity == SPEED else -1.0
        n = int((sign * self.values[:, quantity]).argmax())
        if sign * (self.values[n, quantity] - SLIDE) <= _ROUNDED:
            return -math.inf, SLIDE
        return float(self.u[n]), float(self.values[n, quantity])


@lru_cache(maxsize=64)
def launch_curve(body: Body) -> LaunchCurve:
    """Of a puck: kept, the same call again costs nothing.

    Examples
    --------
    >>> from puck_tables.motion.body import body_of
    >>> launch_curve(body_of("uniform", 0.5, 0.5**0.5)).brackets(RIM, 1.0)
    [(-600.0, 600.0)]
    >>> u, fastest = launch_curve(body_of("uniform", 3.9, 0.1)).extreme(SPEED)
    >>> u > -4.0, fastest > 0.5 * math.log(2.0)
    (True, True)
    """
    ends = np.array([-LARGEST_U, LARGEST_U])
    if body.is_plain:  # the quantities never turn
        return LaunchCurve(body, ends, _values(body, ends))
    u = _first_nodes(body)
    values, slopes = _with_slopes(body, u)
    fresh = np.ones(u.size - 1, bool)
    while fresh.any():
        n = np.flatnonzero(fresh)
        width = u[n + 1] - u[n]
        middle = 0.5 * (u[n] + u[n + 1])
        new, new_slopes = _with_slopes(body, middle)
        guess = 0.5 * (values[n] + values[n + 1])
        guess += 0.125 * width[:, None] * (slopes[n] - slopes[n + 1])
        off = np.abs(guess - new).max(axis=1)
        # no derivative next to the limit, where the curve is analytic
        kept = np.isfinite(new_slopes).all(axis=1)
        split = np.zeros(u.size - 1, bool)
        split[n] = kept & ~(off <= _RESOLVED) & (width > _NARROWEST)
        n, into = np.flatnonzero(split), kept & split[n]
        u = np.insert(u, n + 1, middle[into])
        values = np.insert(values, n + 1, new[into], axis=0)
        slopes = np.insert(slopes, n + 1, new_slopes[into], axis=0)
        fresh = np.zeros(u.size - 1, bool)
        both = n + np.arange(n.size)
        fresh[both], fresh[both + 1] = True, True
    turns = np.unique(_turns(u, values, slopes))
    more = np.concatenate([ends, turns])
    u = np.concatenate([u, more])
    values = np.concatenate([values, _values(body, more)])
    order = np.argsort(u, kind="stable")
    return LaunchCurve(body, u[order], values[order])


def sample(ranges: list[tuple[float, float]], count: int) -> list[float]:
    """Equally spaced slip angles, as u: each range of u has its share of them, at least one.

    Examples
    --------
    >>> [round(u, 3) for u in sample([(-math.inf, 0.0), (1.0, math.inf)], 5)]
    [-inf, -1.317, -0.549, 0.0, 1.0]
    """
    if not ranges:
        return []
    ends = [(low, high if high < math.inf else max(low + 1.0, _SAMPLED_U)) for low, high in ranges]
    angles = [(math.atan(math.exp(low)), math.atan(math.exp(high))) for low, high in ends]
    shares = [1] * len(ranges)
    for _ in range(count - len(ranges)):
        densest = max(range(len(ranges)), key=lambda n: (angles[n][1] - angles[n][0]) / shares[n])
        shares[densest] += 1
    us: list[float] = []
    for (low, high), (first, last), share in zip(ends, angles, shares, strict=True):
        inner = np.log(np.tan(np.linspace(first, last, share)[1:-1])).tolist()
        us += [low, *inner, high] if share > 1 else [low]  # the ends to the last digit
    return us


def looked_up_root(
    body: Body, quantity: int, wanted: float, low: float, high: float
) -> tuple[float, FloatArray] | None:
    """Where a quantity has a value between two u, by look-up, and the slopes (4,) of all there.

    None of other than plain pucks, and where the values of the table do not tell, such as next to
    the slide without spin, of which all speeds are nearly those.

    Examples
    --------
    >>> from puck_tables.motion.body import body_of
    >>> u, _ = looked_up_root(body_of("uniform", 0.5, 0.5**0.5), RIM, 1.0, -600.0, 600.0)
    >>> rows = launch_curve(body_of("uniform", 0.5, 0.5**0.5)).rows(np.array([u]))
    >>> bool(abs(rows[0, RIM] - 1.0) < 1e-9)
    True
    """
    if not body.is_plain:
        return None
    while True:
        u = np.linspace(low, high, _SECTIONS)
        rows = _looked_up(body.delta, u)
        above = rows[:, quantity] >= wanted
        changed = np.flatnonzero(above[:-1] != above[1:])
        if changed.size != 1:
            return None
        n = int(changed[0])
        low, high = float(u[n]), float(u[n + 1])
        if high - low < _NARROW:
            break
    slopes = (rows[n + 1] - rows[n]) / (high - low)
    return low + float((wanted - rows[n, quantity]) / slopes[quantity]), slopes


def _looked_up(delta: float, u: FloatArray) -> FloatArray:
    """Ln v, ln r|ω|, ln t₀ and arg Z, (n, 4), from the stop table."""
    cosine, sine = cosine_of(u), cosine_of(-u)
    launches = launches_of(np.column_stack([cosine, 0.0 * u]), sine, delta, 1.0, 1.0)
    time, place, _, _ = StopTable.shipped().stops(launches)
    return np.column_stack(_logs(u, np.column_stack([time, place])))


def _first_nodes(body: Body) -> FloatArray:
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
    width = np.diff(u)[:, None]
    secant = np.diff(values, axis=0) / width
    # slope over x from 0 to 1: a x² + b x + c
    c, end = slopes[:-1], slopes[1:]
    a = 3.0 * (c + end - 2.0 * secant)
    b = end - c - a
    with np.errstate(divide="ignore", invalid="ignore"):
        root = -0.5 * (b + np.copysign(np.sqrt(b * b - 4.0 * a * c), b))
        places = np.stack([root / a, c / root])
        inside = (places > 0.0) & (places < 1.0)
    at = u[:-1, None] + width * np.where(inside, places, 0.0)
    turns: FloatArray = at[inside]
    return turns


def _stops(body: Body, u: FloatArray) -> FloatArray:
    """T, X, Y at u (n,), (n, 3)."""
    heights = np.full(u.size, body.delta)
    if body.is_plain:
        return integrated_stops(u, heights, NO_SECTION, _PLAIN_LOCAL, cosine_of(u))[:, :3]
    cut = body.friction(SECTION_ACCURACY).for_motion(body.gyration)
    return integrated_stops(u, heights, cut, _LOCAL, cosine_of(u))[:, :3]


def _logs(u: FloatArray, stops: FloatArray) -> tuple[FloatArray, ...]:
    """Ln v, ln r|ω|, ln t₀ and arg Z from stops."""
    time, x, y = stops.T
    log_q = -0.5 * np.log(np.hypot(x, y))
    larger = log_q - 0.5 * np.log1p(np.exp(-2.0 * np.abs(u)))
    return (
        larger - np.maximum(u, 0.0), larger + np.minimum(u, 0.0), log_q + np.log(time),
        np.arctan2(y, x),
    )  # fmt: skip


def cosine_of(u: FloatArray) -> FloatArray:
    """Cos φ from u = ln tan φ."""
    cosine: FloatArray = np.exp(-np.maximum(u, 0.0)) / np.sqrt(1.0 + np.exp(-2.0 * np.abs(u)))
    return cosine


def _values(body: Body, u: FloatArray) -> FloatArray:
    return np.column_stack(_logs(u, _stops(body, u))[:BEND])


def _with_slopes(body: Body, u: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Values and their derivatives, both (n, 3); the derivatives NaN next to the limit."""
    stops = _stops(body, u)
    values = np.column_stack(_logs(u, stops)[:BEND])
    time, x, y = stops.T
    inverse, _, spin = body.friction(SECTION_ACCURACY).ratios(np.arctan(np.exp(u))).T
    along = 1.0 / inverse
    turning = 0.5 / body.inertia * spin * along
    common = 0.5 * cosine_of(u) * x / (x * x + y * y)
    gap = along - turning
    gap[np.abs(gap) < _NEAR_LIMIT] = np.nan
    raw = common[:, None] - np.column_stack([along, turning, 1.0 / time])
    return values, raw / gap[:, None]

"""The balance of one-sided contact, compiled: one slip direction after the other.

The same mathematics as :mod:`puck_tables.contact.one_sided` and
:mod:`puck_tables.contact.loaded_chord`, where it is explained; those stay the judge.  Directions
come in order, so that each balance starts from its neighbours' and one or two steps of Newton's
method settle it.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.contact.integrals import SlipDirection
from puck_tables.contact.one_sided import balanced
from puck_tables.kernels.compile import (
    BLOCK,
    allocating,
    arrays_at_first,
    inlined,
    inner,
    into_row,
    patience,
    row_of,
)
from puck_tables.kernels.elementary import cosine_sine_of

PARALLEL, PERPENDICULAR, SPIN, OFFSET, BEARING = range(5)
BALANCE = 5  # numbers of a balance
_STEPS, _MAX_TURN = 60, 0.3  # of Newton's method at most; rad of a step
_CONVERGED = 1e-7  # a step of that size leaves an error of its square
_GAUSS_2 = 3.0**-0.5  # node of Gauss's rule of two points, exact up to degree 3
_FRICTION_X, _FRICTION_Y, _BARE_X, _BARE_Y, _TURNED_X, _TURNED_Y, _FOOT, _TORQUE = range(8)
_SUMS = 8  # the eight above
_NEIGHBOURS = 3  # a parabola goes through
# rows of a block of lines
_LEVEL, _SLOPE, _MIDDLE, _HALF, _COS_A, _SIN_A, _AT_FOOT, _ELEMENT, _BY_LENGTH = range(9)
_ROWS = 9  # the nine above


@inlined
def _line(x: float, away: float) -> float:
    """The parameter of the line through a point: a modulo π."""
    angle = math.atan2(x, away)
    return angle - math.copysign(math.pi, angle) if abs(angle) > 0.5 * math.pi else angle


@inner
def _find_lines(
    ratio: float, fast: bool, offset: float, n_x: float, n_y: float, low_end: float,
    high_end: float, rule: FloatArray, room: FloatArray,
) -> None:  # fmt: skip
    """What the lines of one interval meet, into rows of ``room``."""
    half, middle = 0.5 * (high_end - low_end), 0.5 * (high_end + low_end)
    other2 = (1.0 - ratio) * (1.0 + ratio)
    for n in range(rule.shape[1]):
        cosine, sine = cosine_sine_of(middle + half * rule[0, n])
        weight = half * rule[1, n]
        other = math.sqrt(cosine * cosine + other2 * sine * sine)
        sin_a, cos_a = (sine, cosine) if fast else (ratio * sine, other)
        foot, half_chord = (ratio * sine, other) if fast else (sine, cosine)
        level = foot * (n_x * cos_a + n_y * sin_a) - offset
        slope = n_x * sin_a - n_y * cos_a
        low, high = level - half_chord * slope, level + half_chord * slope
        deepest, shallowest = max(low, high), min(low, high)
        whole = shallowest >= 0.0
        span = 1.0 if whole | (deepest <= 0.0) else deepest - shallowest
        share = 1.0 if whole else max(deepest, 0.0) / span
        side = 1.0 if high > low else -1.0
        # R dl da = element + by_length l: with s over R to infinity when the puck only slides
        element = ratio * cos_a if fast else cosine
        by_length = 1.0 if fast else cosine * ratio / other
        weight *= half_chord * share
        into_row(room, _LEVEL, n, level)
        into_row(room, _SLOPE, n, slope)
        into_row(room, _MIDDLE, n, side * half_chord * (1.0 - share))
        into_row(room, _HALF, n, half_chord * share)
        into_row(room, _COS_A, n, cos_a)
        into_row(room, _SIN_A, n, sin_a)
        into_row(room, _AT_FOOT, n, foot)
        into_row(room, _ELEMENT, n, weight * element)
        into_row(room, _BY_LENGTH, n, weight * by_length)


@inner
def _add_lines(
    ratio: float, fast: bool, n_x: float, n_y: float, count: int, room: FloatArray,
    sums: FloatArray,
) -> None:  # fmt: skip
    """Sums over two points of each line, exact for polynomials of degree 3 along it."""
    friction_x, friction_y, bare_x, bare_y = 0.0, 0.0, 0.0, 0.0
    turned_x, turned_y, on_foot, torque = 0.0, 0.0, 0.0, 0.0
    for n in range(count):
        cos_a, sin_a = row_of(room, _COS_A, n), row_of(room, _SIN_A, n)
        foot, middle, half = (
            row_of(room, _AT_FOOT, n), row_of(room, _MIDDLE, n), row_of(room, _HALF, n)
        )  # fmt: skip
        element, by_length = row_of(room, _ELEMENT, n), row_of(room, _BY_LENGTH, n)
        level, slope = row_of(room, _LEVEL, n), row_of(room, _SLOPE, n)
        bare, loaded, turned, moment = 0.0, 0.0, 0.0, 0.0
        for side in (-_GAUSS_2, _GAUSS_2):
            along = middle + side * half
            weight = element + by_length * along
            x, y = foot * cos_a + along * sin_a, foot * sin_a - along * cos_a
            pressed = weight * (level + along * slope)
            bare += weight
            loaded += pressed
            turned += weight * (n_x * y - n_y * x)
            curving = along if fast else foot * (x + ratio * y * foot / (1.0 + cos_a))
            moment += pressed * curving
        friction_x += loaded * cos_a
        friction_y += loaded * sin_a
        bare_x += bare * cos_a
        bare_y += bare * sin_a
        turned_x += turned * cos_a
        turned_y += turned * sin_a
        on_foot += loaded * foot
        torque += moment
    sums[_FRICTION_X] += friction_x
    sums[_FRICTION_Y] += friction_y
    sums[_BARE_X] += bare_x
    sums[_BARE_Y] += bare_y
    sums[_TURNED_X] += turned_x
    sums[_TURNED_Y] += turned_y
    sums[_FOOT] += on_foot
    sums[_TORQUE] += torque


@inner
def _sum_up(
    ratio: float, fast: bool, offset: float, bearing: float, rule: FloatArray, room: FloatArray,
    sums: FloatArray,
) -> None:  # fmt: skip
    """All sums over the loaded part: three intervals of lines between the ends of the chord."""
    n_x, n_y = math.cos(bearing), math.sin(bearing)
    arc = math.acos(min(max(offset, -1.0), 1.0))
    x, y = math.cos(bearing - arc), math.sin(bearing - arc)
    one = _line(x, ratio - y if fast else abs(ratio - y))
    x, y = math.cos(bearing + arc), math.sin(bearing + arc)
    two = _line(x, ratio - y if fast else abs(ratio - y))
    for i in range(_SUMS):
        sums[i] = 0.0
    start = -0.5 * math.pi
    for end in (min(one, two), max(one, two), 0.5 * math.pi):
        _find_lines(ratio, fast, offset, n_x, n_y, start, end, rule, room)
        _add_lines(ratio, fast, n_x, n_y, rule.shape[1], room, sums)
        start = end


@inner
def _segment(offset: float, rule: FloatArray) -> tuple[float, float, float, float]:
    """Area, moment, load and lever of the loaded segment."""
    arc = math.acos(max(offset, -1.0))
    beyond = max(-1.0 - offset, 0.0)
    area, moment, load, second = 0.0, 0.0, 0.0, 0.0
    for n in range(rule.shape[1]):
        t = 0.5 * arc * (1.0 + rule[0, n])
        x, sine = cosine_sine_of(t)
        _, one = cosine_sine_of(0.5 * (arc + t))
        _, two = cosine_sine_of(0.5 * (arc - t))
        element, xi = arc * rule[1, n] * sine * sine, 2.0 * one * two + beyond
        area += element
        moment += element * x
        load += element * xi
        second += element * xi * x
    return area, moment, load, second / load


@inner
def _steady(
    ratio: float, fast: bool, delta: float, lines: FloatArray, gauss: FloatArray,
    room: FloatArray, sums: FloatArray, chord: FloatArray,
) -> bool:  # fmt: skip
    """Newton's method from a chord to the solved one, in place; whether it settled."""
    for _ in range(_STEPS):
        offset, bearing = chord[0], chord[1]
        if not (offset < 1.0):
            return False
        _sum_up(ratio, fast, offset, bearing, lines, room, sums)
        area, moment, load, lever = _segment(offset, gauss)
        n_x, n_y = math.cos(bearing), math.sin(bearing)
        scale = 0.25 * delta / load
        f_x, f_y = scale * sums[_FRICTION_X], scale * sums[_FRICTION_Y]
        off_x, off_y = lever * n_x - f_x, lever * n_y - f_y
        lever_slope = (lever * area - moment) / load
        d_x = lever_slope * n_x - (f_x * area / load - scale * sums[_BARE_X])
        d_y = lever_slope * n_y - (f_y * area / load - scale * sums[_BARE_Y])
        g_x = -lever * n_y - scale * sums[_TURNED_X]
        g_y = lever * n_x - scale * sums[_TURNED_Y]
        determinant = d_x * g_y - d_y * g_x
        step = (g_x * off_y - g_y * off_x) / determinant
        turn = (d_y * off_x - d_x * off_y) / determinant
        space = 1.0 - offset
        chord[0] = 1.0 - min(max(space - step, 0.5 * space), 2.2 * space)
        chord[1] = bearing + min(max(turn, -_MAX_TURN), _MAX_TURN)
        if abs(step) <= _CONVERGED * space and abs(turn) <= _CONVERGED:
            return True
    return False


def _by_arrays(
    ratio: FloatArray, fast: npt.NDArray[np.bool_], delta: float, guess: FloatArray,
    lines: FloatArray, gauss: FloatArray, out: FloatArray,
) -> int:  # fmt: skip
    """What :func:`fill_balances` fills, thirty times slower, by arrays with rules of their own."""
    patience(1)
    result, chord = balanced(SlipDirection(ratio, fast), np.full(ratio.size, delta))
    out[:] = np.column_stack([*result, *chord])
    return 0


@arrays_at_first(_by_arrays)
@allocating
def fill_balances(
    ratio: FloatArray, fast: npt.NDArray[np.bool_], delta: float, guess: FloatArray,
    lines: FloatArray, gauss: FloatArray, out: FloatArray,
) -> int:  # fmt: skip
    """Resultants and chord of directions (n,) into ``out`` (n, 5), NaN where not solved; how many.

    ``ratio``, ``fast``: min(v, r|ω|)/max(v, r|ω|), and whether r|ω| > v; neighbours next to each
    other; ``delta``: dimensionless height, in partial contact at all of them; ``guess`` (2, n):
    offset and bearing of the chord; ``lines``, ``gauss`` (2, m): nodes and weights on [−1, 1]; m at
    most 128.
    """
    patience(ratio.size)
    room, sums, chord = np.empty(_ROWS * BLOCK), np.empty(_SUMS), np.empty(2)
    solved, lost = 0, 0
    for n in range(ratio.size):
        patience(1)
        done = False
        if solved == _NEIGHBOURS:  # on from three neighbours by a parabola
            for i in range(2):
                at = OFFSET + i
                chord[i] = 3.0 * (out[n - 1, at] - out[n - 2, at]) + out[n - 3, at]
            jump = abs(chord[0] - out[n - 1, OFFSET]) + abs(chord[1] - out[n - 1, BEARING])
            if jump < 0.1 * (1.0 - out[n - 1, OFFSET]):
                done = _steady(ratio[n], fast[n], delta, lines, gauss, room, sums, chord)
        if not done:
            chord[0], chord[1] = guess[0, n], guess[1, n]
            done = _steady(ratio[n], fast[n], delta, lines, gauss, room, sums, chord)
        solved = min(solved + 1, _NEIGHBOURS) if done else 0
        lost += 0 if done else 1
        out[n, OFFSET], out[n, BEARING] = chord[0], chord[1]
        _sum_up(ratio[n], fast[n], chord[0], chord[1], lines, room, sums)
        _, _, load, _ = _segment(chord[0], gauss)
        k = ratio[n]
        large = 1.0 / math.sqrt(1.0 + k * k)
        cosine, sine = (k * large, large) if fast[n] else (large, k * large)
        across, torque = sums[_FOOT] / load, sums[_TORQUE] / load
        out[n, PARALLEL] = sums[_FRICTION_X] / load / cosine if done else math.nan
        out[n, PERPENDICULAR] = across / (cosine * cosine)
        out[n, SPIN] = 2.0 * (
            torque / sine if fast[n] else (torque - 0.25 * delta * across) / cosine
        )
    return lost

"""Straight lines in the plane: cushions, edges, borders, and when a puck gets to them.

On a step the gap to a line is followed by the polynomial of degree 5 with its value, rate and
acceleration at both ends.  Between the turning points of that polynomial the gap is monotonic, so
that none is passed and passed back unseen; the gaps there, and the crossing, are then taken on real
steps of the method.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import allocating, inlined
from puck_tables.scene.cushions import NX, NY
from puck_tables.scene.equations import SIZE
from puck_tables.scene.explicit import STAGES
from puck_tables.scene.friction import VX, VY, X, Y
from puck_tables.scene.ingredients import Stretch, carried_along
from puck_tables.scene.steps import step

BOUNCES, BORDER, EDGE = 2, 4, 5  # among what happens on the way
BORDER_NUMBER, BORDER_SIDE = 3, 4  # columns of a border
DEGREE = 5
_SHORTEST = 1e-10  # of a step: turning points closer than this are one
_CLOSE = 1e-8  # of a step: from so close a crossing is known by its slope
_AT_END = 1e-4  # of a step: so close to its end by its slope and bend there


class Boundaries(NamedTuple):
    """Straight lines that mean something, rows n_x, n_y, c of n·x = c.

    ``walls``: (n, 6) with restitution, tangential restitution and greatest friction coefficient, c
    moved in by the radius; ``edges``: (n, 3), the run ends beyond; ``borders``: (n, 5), parallel,
    ascending, between the zones of a floor of strips, see :mod:`puck_tables.scene.zones`.
    """

    walls: FloatArray
    edges: FloatArray
    borders: FloatArray


class Line(NamedTuple):
    """One of them: n_x, n_y, and how far the puck is from it at the start of a step."""

    x: float
    y: float
    gap: float


class Arc(NamedTuple):
    """Velocity and acceleration in the laboratory at both ends of a step, and its way."""

    vx: float
    vy: float
    ax: float
    ay: float
    last_vx: float
    last_vy: float
    last_ax: float
    last_ay: float
    dx: float
    dy: float


@inlined
def arc_of(stretch: Stretch, first: FloatArray, last: FloatArray, new: FloatArray) -> Arc:
    """From the rates at both ends of a step and its end."""
    surface = stretch.model.surface
    cx, cy = carried_along(surface, first[X], first[Y])
    dx, dy = carried_along(surface, last[X], last[Y])
    return Arc(
        first[X], first[Y], first[VX] + cx, first[VY] + cy,
        last[X], last[Y], last[VX] + dx, last[VY] + dy, new[SIZE], new[SIZE + 1],
    )  # fmt: skip


@inlined
def gap_polynomial(line: Line, arc: Arc, h: float, out: FloatArray) -> bool:
    """Its six coefficients in Bernstein's basis; whether it might fall below 0 on the step."""
    rate, bend = line.x * arc.vx + line.y * arc.vy, line.x * arc.ax + line.y * arc.ay
    last = line.gap + (line.x * arc.dx + line.y * arc.dy)
    last_rate = line.x * arc.last_vx + line.y * arc.last_vy
    last_bend = line.x * arc.last_ax + line.y * arc.last_ay
    out[0] = line.gap
    out[1] = line.gap + 0.2 * h * rate
    out[2] = line.gap + 0.4 * h * rate + 0.05 * h * h * bend
    out[3] = last - 0.4 * h * last_rate + 0.05 * h * h * last_bend
    out[4] = last - 0.2 * h * last_rate
    out[5] = last
    below = line.gap < 0.0 and rate <= 0.0
    for i in range(1, DEGREE + 1):
        below = below or not out[i] >= 0.0
    return below


@inlined
def _value(b: FloatArray, degree: int, s: float) -> float:
    """A polynomial in Bernstein's basis, by Horner's scheme."""
    left, power, choose, total = 1.0 - s, 1.0, 1.0, b[0]
    for i in range(1, degree + 1):
        power *= s
        choose *= (degree - i + 1) / i
        total = total * left + choose * power * b[i]
    return total


@allocating
def _turning_points(b: FloatArray, out: FloatArray) -> int:
    """Where in (0, 1) the derivative of the gap polynomial vanishes, ascending into ``out``.

    Bernstein coefficients of one sign mean no root, one change of sign one root; else the interval
    is halved (de Casteljau).
    """
    degree, count, waiting = DEGREE - 1, 0, 1
    stack, spans = np.empty((64, DEGREE)), np.empty((64, 2))
    slope = np.empty(DEGREE)
    for i in range(DEGREE):
        slope[i] = b[i + 1] - b[i]
        stack[0, i] = slope[i]
    spans[0, 0], spans[0, 1] = 0.0, 1.0
    while waiting > 0 and count < len(out):
        waiting -= 1
        low, high = spans[waiting, 0], spans[waiting, 1]
        part = stack[waiting].copy()
        changes, sign = 0, 0.0
        if low > 0.0 and part[0] == 0.0:  # the halves meet at a root
            out[count] = low
            count += 1
            if count == len(out):
                break
        for i in range(DEGREE):
            if part[i] != 0.0:
                now = 1.0 if part[i] > 0.0 else -1.0
                changes += 1 if now == -sign else 0
                sign = now
        if changes == 0:
            continue
        if changes == 1 and part[0] * part[degree] < 0.0:
            left, right = low, high
            while True:
                middle = 0.5 * (left + right)
                if middle <= left or middle >= right or right - left <= 1e-3 * _SHORTEST:
                    break
                if (_value(slope, degree, middle) > 0.0) == (part[0] > 0.0):
                    left = middle
                else:
                    right = middle
            out[count] = 0.5 * (left + right)
            count += 1
            continue
        middle = 0.5 * (low + high)
        if high - low <= _SHORTEST or waiting + 2 > len(stack):
            out[count] = middle
            count += 1
            continue
        for i in range(DEGREE):  # the right half is looked at later
            stack[waiting, degree - i] = part[degree - i]
            stack[waiting + 1, i] = part[0]
            for j in range(degree - i):
                part[j] = 0.5 * (part[j] + part[j + 1])
        spans[waiting, 0], spans[waiting, 1] = middle, high
        spans[waiting + 1, 0], spans[waiting + 1, 1] = low, middle
        waiting += 2
    return count


@inlined
def _root(b: FloatArray, low: float, high: float) -> float:
    """Where a polynomial in Bernstein's basis, positive at one place, is 0 before the other."""
    before, after = _value(b, DEGREE, low), _value(b, DEGREE, high)
    for _ in range(50):
        if high - low <= _SHORTEST or not before > 0.0 > after:
            break
        guess = min(max((low * after - high * before) / (after - before), low), high)
        value = _value(b, DEGREE, guess)
        if value < 0.0:
            high, after, before = guess, value, 0.5 * before
        elif value > 0.0:
            low, before, after = guess, value, 0.5 * after
        else:
            return guess
    return 0.5 * (low + high)


@allocating
def crossing(
    line: Line, gaps: FloatArray, stretch: Stretch, t: float, h: float, y: FloatArray,
    scale: FloatArray, work: FloatArray, new: FloatArray,
) -> float:  # fmt: skip
    """When within a step of which ``gaps`` is the polynomial a line is first passed; inf: never."""
    turns = np.empty(8)
    count = _turning_points(gaps, turns)
    low, high, found = 0.0, h, False
    for k in range(count + 1):
        value = gaps[DEGREE]
        moment = h
        if k < count:
            moment = h * turns[k]
            step(stretch, t, moment, y, scale, work, new)
            value = line.gap + (line.x * new[SIZE] + line.y * new[SIZE + 1])
        if value < 0.0:
            high, found = moment, True
            break
        low = moment
    if not found:
        return math.inf
    if low == 0.0 and line.gap <= 0.0:
        return 0.0
    rate, bend = DEGREE * (gaps[DEGREE] - gaps[DEGREE - 1]), gaps[DEGREE] - gaps[DEGREE - 1]
    bend = DEGREE * (DEGREE - 1) * (bend - gaps[DEGREE - 1] + gaps[DEGREE - 2])
    back = gaps[DEGREE] / rate if rate < 0.0 else math.inf
    if count == 0 and back <= _AT_END and abs(bend) * back <= -_AT_END * rate:
        return h * (1.0 - back * (1.0 + 0.5 * bend * back / rate))
    guess = h * _root(gaps, low / h, high / h)
    first, last, before = low, high, math.inf  # a line that is grazed is passed twice beside them
    for _ in range(100):
        step(stretch, t, guess, y, scale, work, new)
        value = line.gap + (line.x * new[SIZE] + line.y * new[SIZE + 1])
        slope = line.x * work[STAGES - 1, X] + line.y * work[STAGES - 1, Y]
        if value > 0.0:
            low = guess
        else:
            high = guess
        better = guess - value / slope if slope != 0.0 else low
        inside, off = low <= better <= high, abs(better - guess)
        alone = off <= _CLOSE * min(better - first, last - better)  # the square of that is rounding
        close = inside and off <= _CLOSE * h and (alone or off >= 0.5 * before)
        guess, before = (better if inside else 0.5 * (low + high)), off
        if close or high - low <= 1e-15 * h:
            break
    return guess


@inlined
def first_crossing(
    bounds: Boundaries, room: FloatArray, region: int, leans: npt.NDArray[np.bool_],
    stretch: Stretch, t: float, h: float, y: FloatArray, scale: FloatArray, work: FloatArray,
    end: FloatArray, gaps: FloatArray, new: FloatArray,
) -> tuple[int, int, float]:  # fmt: skip
    """The first wall, edge or border on a step to ``end``: what, which, when; −1: none.

    ``room``: how far the puck is from every wall at the start, counted from the last impact there.
    """
    happens, which, moment = -1, -1, math.inf
    walls, edges, borders = bounds.walls, bounds.edges, bounds.borders
    arc = arc_of(stretch, work[0], work[STAGES - 1], end)
    for i in range(len(walls) + len(edges) + len(borders)):
        what, number = BOUNCES, i
        if i < len(walls):
            if leans[i]:
                continue
            line = Line(walls[i, 0], walls[i, 1], room[i])
        elif i < len(walls) + len(edges):
            what, number = EDGE, i - len(walls)
            line = line_to(edges, number, 1.0, y)
        else:
            border = i - len(walls) - len(edges)
            if border != region - 1 and border != region:  # not at this region
                continue
            what = BORDER
            number, sign = (region - 1, 1.0) if border == region - 1 else (region + 1, -1.0)
            line = line_to(borders, border, sign, y)
        if not gap_polynomial(line, arc, h, gaps):
            continue
        when = crossing(line, gaps, stretch, t, h, y, scale, work, new)
        if when < moment:
            happens, which, moment = what, number, when
    return happens, which, moment


@inlined
def line_to(rows: FloatArray, i: int, sign: float, y: FloatArray) -> Line:
    """A line of these rows as the puck at ``y`` has it, from the side of the sign."""
    gap = rows[i, 0] * y[X] + rows[i, 1] * y[Y] - rows[i, 2]
    return Line(sign * rows[i, 0], sign * rows[i, 1], sign * gap)


@inlined
def room_to(rows: FloatArray, i: int, y: FloatArray) -> float:
    """How far the puck is from a wall, or its centre from an edge."""
    return line_to(rows, i, 1.0, y).gap


@inlined
def outward(rows: FloatArray, i: int, y: FloatArray) -> float:
    """How fast a state in the laboratory goes away from a wall or an edge."""
    return rows[i, NX] * y[VX] + rows[i, NY] * y[VY]

"""Straight lines in the plane: cushions, edges, borders, and when a puck gets to them."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables.kernels.compile import inlined, kernel
from puck_tables.scene.friction import VX, VY, X, Y
from puck_tables.scene.impact import rebound
from puck_tables.scene.ingredients import Body, Stretch
from puck_tables.scene.steps import step

FloatArray = npt.NDArray[np.float64]

BOUNCES, BORDER, EDGE = 2, 4, 5  # among what happens on the way
_LEAN = 1e-9  # of the scale of speeds: a rebound slower than this is none
_LEFT = 1e-12  # a wall is left


class Boundaries(NamedTuple):
    """Straight lines that mean something, rows n_x, n_y, c of n·x = c.

    ``walls``: (n, 6) with restitution, tangential restitution and greatest friction coefficient, c
    moved in by the radius; ``edges``: (n, 3), the run ends beyond; ``borders``: (n, 3), parallel,
    ascending, between the regions of the floor.
    """

    walls: FloatArray
    edges: FloatArray
    borders: FloatArray


class Line(NamedTuple):
    """One of them: n_x, n_y, c."""

    x: float
    y: float
    c: float


@inlined
def _line(rows: FloatArray, i: int, sign: float) -> Line:
    return Line(sign * rows[i, 0], sign * rows[i, 1], sign * rows[i, 2])


@inlined
def _gap(line: Line, y: FloatArray) -> tuple[float, float]:
    """Distance from a line on its inner side, and its rate."""
    return line.x * y[X] + line.y * y[Y] - line.c, line.x * y[VX] + line.y * y[VY]


@kernel
def _crossing(
    line: Line, stretch: Stretch, t: float, h: float, y: FloatArray, scale: FloatArray,
    work: FloatArray, end: FloatArray, new: FloatArray,
) -> float:  # fmt: skip
    """When within a step from y to ``end`` the puck first passes a line outwards; inf: never."""
    gap, rate = _gap(line, y)
    last, last_rate = _gap(line, end)
    low, high = 0.0, h
    if gap <= 0.0 and rate <= 0.0 and last < 0.0:
        return 0.0
    if last >= 0.0 and not (rate < 0.0 and last_rate > 0.0):
        return math.inf
    if last >= 0.0 or gap <= 0.0:  # in and out again, or away and back: find the turning point
        sign = 1.0 if last >= 0.0 else -1.0
        for _ in range(60):
            middle = 0.5 * (low + high)
            if middle <= low or middle >= high:
                break
            step(stretch, t, middle, y, scale, work, new)
            if sign * _gap(line, new)[1] < 0.0:
                low = middle
            else:
                high = middle
        step(stretch, t, high, y, scale, work, new)
        if last >= 0.0:
            if _gap(line, new)[0] >= 0.0:
                return math.inf
            low = 0.0
        else:
            low, high = high, h
    guess = 0.5 * (low + high)
    for _ in range(100):
        step(stretch, t, guess, y, scale, work, new)
        value, slope = _gap(line, new)
        if value > 0.0:
            low = guess
        else:
            high = guess
        better = guess - value / slope if slope != 0.0 else low
        if not low < better < high:
            better = 0.5 * (low + high)
        if better == guess or high - low <= 1e-15 * h:
            break
        guess = better
    return guess


@inlined
def normals(bounds: Boundaries, leans: npt.NDArray[np.bool_]) -> FloatArray:
    """Normals of the walls that the puck leans on."""
    chosen = np.empty((leans.sum(), 2))
    count = 0
    for i in range(leans.size):
        if leans[i]:
            chosen[count, 0], chosen[count, 1] = bounds.walls[i, 0], bounds.walls[i, 1]
            count += 1
    return chosen


@inlined
def left(bounds: Boundaries, y: FloatArray, leans: npt.NDArray[np.bool_], speed: float) -> bool:
    """Whether the puck has left a wall that it leant on."""
    left = False
    for i in range(leans.size):
        if leans[i] and _gap(_line(bounds.walls, i, 1.0), y)[1] > _LEFT * speed:
            leans[i] = False
            left = True
    return left


@inlined
def bounced(
    bounds: Boundaries, which: int, body: Body, y: FloatArray,
    leans: npt.NDArray[np.bool_], speed: float, least: float,
) -> bool:  # fmt: skip
    """Rebound from a wall; whether the puck stays there, as it does if slower than ``least``."""
    walls = bounds.walls
    rebound(body, walls[which], y)
    stays = _gap(_line(walls, which, 1.0), y)[1] <= max(_LEAN * speed, least)
    if stays:
        leans[which] = True
    for i in range(leans.size):  # no velocity is left towards or away from where it leans
        away = _gap(_line(walls, i, 1.0), y)[1]
        if leans[i] and (away < 0.0 or i == which or away > _LEFT * speed):
            if abs(away) > max(_LEAN * speed, least) or (away > 0.0 and i != which):
                leans[i] = False  # it bounces there next, or has left already
            else:
                y[VX] -= away * walls[i, 0]
                y[VY] -= away * walls[i, 1]
    return stays


@inlined
def first_crossing(
    bounds: Boundaries, stretch: Stretch, region: int, leans: npt.NDArray[np.bool_], t: float,
    h: float, y: FloatArray, scale: FloatArray, work: FloatArray, end: FloatArray, new: FloatArray,
) -> tuple[int, int, float]:  # fmt: skip
    """The first wall, edge or border on a step: what, which, when; −1: none."""
    happens, which, moment = -1, -1, math.inf
    walls, edges, borders = bounds.walls, bounds.edges, bounds.borders
    for i in range(len(walls) + len(edges) + len(borders)):
        what, number = BOUNCES, i
        if i < len(walls):
            if leans[i]:
                continue
            line = _line(walls, i, 1.0)
        elif i < len(walls) + len(edges):
            what, number = EDGE, i - len(walls)
            line = _line(edges, number, 1.0)
        else:
            border = i - len(walls) - len(edges)
            if border != region - 1 and border != region:  # not at this region
                continue
            what = BORDER
            number, sign = (region - 1, 1.0) if border == region - 1 else (region + 1, -1.0)
            line = _line(borders, border, sign)
        when = _crossing(line, stretch, t, h, y, scale, work, end, new)
        if when < moment:
            happens, which, moment = what, number, when
    return happens, which, moment

"""Sums of the slip direction over a disc under a cone of pressure, and under a tabulated one.

Under a cone, 1 at the centre and 0 at its radius a, they are (1/a) ∫ D(ρ) dρ up to a, D those over
a disc of radius ρ.  Each of the four that symmetry leaves is aⁿ, n = 2, 3, 3, 4, times a function
of a/c, c the distance of the centre of rotation.  With q = (a − c)/(a + c) these are singular as
q³ ln|q| where the rim passes that centre, so that they are tabulated over √|q|, on either side; and
far out as (c/a)ⁿ⁺¹ ln(a/c), which is taken from them first.
"""

from __future__ import annotations

import math

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.contact import closed_form
from puck_tables.kernels.base_boundary import disc_sums
from puck_tables.kernels.compile import inlined, inner, spline_values

Four = tuple[float, float, float, float]  # e_x, y e_x, x e_y and y (x e_y − y e_x)

_SPANS, _POWERS, _WIDTH = 32, 10, 4  # of √|q| from 0 to 1; coefficients in each; functions
_DEGREES = np.array([2.0, 3.0, 3.0, 4.0])
FAR = (-math.pi / 8.0, -5.0 * math.pi / 64.0, math.pi / 64.0, math.pi / 16.0)
_FAR = np.array(FAR)


def _discs(t: FloatArray) -> FloatArray:
    """The four sums (4, …) over discs of radius t, over tⁿ, their centre of rotation at 1."""
    fast = t > 1.0
    a, b, d = closed_form.shape_integrals(
        np.minimum(t, 1.0 / np.maximum(t, 1.0)), fast.astype(np.float64)
    )
    length = np.hypot(1.0, t)
    slides, turns = math.pi / length, math.pi * t / length
    return np.stack([slides * a, turns * (b - d), turns * b, slides * (d - 2.0 * b)])


def _along(sine_of: float, first: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Coefficients (spans, powers, 4) by the place in a span, −1 to 1, and the cones at a = c.

    ``sine_of``: the sign of q; ``first``: the cones where that side begins, at a = 0 or c = 1.
    """
    node, weight = (rule[:, None] for rule in np.polynomial.legendre.leggauss(24))
    place = -np.cos(np.linspace(0.0, math.pi, _POWERS))
    y = (np.arange(_SPANS)[:, None] + 0.5 + 0.5 * place[:-1]).ravel() / _SPANS
    y = (
        np.append(y, 1.0)[::-1] if sine_of < 0.0 else y
    )  # of q > 0 without its end, where a/c has none
    half = 0.5 * np.diff(y)
    at = y[:-1] + half + half * node
    share = 1.0 - sine_of * at * at
    t = (1.0 + sine_of * at * at) / share
    by = weight * half * 4.0 * sine_of * at / (share * share)
    powers = _DEGREES[:, None] + 1.0
    steps = (by * _discs(t) * t ** (powers[:, None] - 1.0)).sum(axis=1)
    cones = np.cumsum(np.concatenate([first[:, None], steps], axis=1), axis=1)
    t = (1.0 + sine_of * y * y) / (1.0 - sine_of * y * y)
    if sine_of > 0.0:
        values = (cones - _FAR[:, None] * np.log(t)) / t**powers
        values = np.append(values, _discs(np.array([1e300])) / powers, axis=1)
    else:
        values = np.append(_discs(np.zeros(1)) / powers, cones[:, 1:] / t[1:] ** powers, axis=1)
        values = values[:, ::-1]
    spans = np.arange(_SPANS)[:, None] * (_POWERS - 1) + np.arange(_POWERS)
    return np.linalg.solve(np.vander(place, increasing=True), values.T[spans]), cones[:, -1]


def _tabulated() -> FloatArray:
    """Of both sides, q < 0 first, flat."""
    inside, touching = _along(-1.0, np.zeros(4))
    outside, _ = _along(1.0, touching)
    return np.concatenate([inside.ravel(), outside.ravel()])


_TABLE = _tabulated()
_SIDE = _TABLE.size // 2


@inlined
def cone_sums(alpha: float, beta: float, size: float, farthest: float) -> Four:
    """Under a cone of a radius > 0, times that radius; ``farthest``: ln(βa/α) where that is > 0."""
    rim = beta * size
    q = (rim - alpha) / (rim + alpha)
    place = math.sqrt(abs(q)) * _SPANS
    span = min(int(place), _SPANS - 1)
    first = (_SIDE if q > 0.0 else 0) + _WIDTH * _POWERS * span
    e, ye, xe, moment = spline_values(
        _TABLE, first, (1.0,), 2.0 * (place - span) - 1.0, _WIDTH, _POWERS
    )
    square = size * size
    cube, fourth = square * size, square * square
    if q > 0.0:
        ratio = alpha / rim
        more = ratio * ratio * ratio * farthest
        e, ye, xe = e + more * FAR[0], ye + ratio * more * FAR[1], xe + ratio * more * FAR[2]
        moment += ratio * ratio * more * FAR[3]
    return cube * e, fourth * ye, fourth * xe, size * fourth * moment


@inlined
def _far(alpha: float, rim: float) -> float:
    return math.log(rim / alpha) if rim > alpha > 0.0 else 0.0


@inner
def pile_up(rows: FloatArray, room: FloatArray, count: int, alpha: float, beta: float) -> None:
    """Into their room what :func:`piled` needs of a slip: for each row the cone, and the pile."""
    slope = rows[2 * count + 1 : 3 * count + 2]
    e, ye, xe, moment = 0.0, 0.0, 0.0, 0.0
    before: Four = (0.0, 0.0, 0.0, 0.0)
    start = rows[0]
    if start > 0.0:
        hole = disc_sums(alpha, beta, start)
        height = rows[count + 1] + slope[1] * start
        e, ye, xe, moment = height * hole[0], height * hole[3], height * hole[4], height * hole[7]
    for i in range(count):
        here: Four = (0.0, 0.0, 0.0, 0.0)
        if rows[i] > 0.0:
            here = cone_sums(alpha, beta, rows[i], _far(alpha, beta * rows[i]))
        if i > 0:
            e += slope[i] * (here[0] - before[0])
            ye += slope[i] * (here[1] - before[1])
            xe += slope[i] * (here[2] - before[2])
            moment += slope[i] * (here[3] - before[3])
        room[8 * i], room[8 * i + 1], room[8 * i + 2], room[8 * i + 3] = here
        room[8 * i + 4], room[8 * i + 5], room[8 * i + 6], room[8 * i + 7] = e, ye, xe, moment
        before = here


@inner
def piled(
    rows: FloatArray, room: FloatArray, count: int, alpha: float, beta: float, size: float
) -> Four:
    """Under a tabulated pressure up to a radius ≤ 1."""
    if size <= rows[0]:
        return 0.0, 0.0, 0.0, 0.0
    i = count - 1
    while rows[i] > size:
        i -= 1
    disc = disc_sums(alpha, beta, size)
    part = min(i + 1, count - 1)
    slope = rows[2 * count + 1 + part]
    height = rows[count + part] + slope * size
    cone = (
        cone_sums(alpha, beta, size, _far(alpha, beta * size))
        if size > rows[i]
        else (room[8 * i], room[8 * i + 1], room[8 * i + 2], room[8 * i + 3])
    )
    return (
        height * disc[0] - room[8 * i + 4] - slope * (cone[0] - room[8 * i]),
        height * disc[3] - room[8 * i + 5] - slope * (cone[1] - room[8 * i + 1]),
        height * disc[4] - room[8 * i + 6] - slope * (cone[2] - room[8 * i + 2]),
        height * disc[7] - room[8 * i + 7] - slope * (cone[3] - room[8 * i + 3]),
    )

"""The sums of :mod:`puck_tables.kernels.law_sums` by arrays, where nothing is compiled yet.

All points of the contour at once: as it is written a kernel takes thirty times as long.
"""

from __future__ import annotations

import math

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.contact.law_moments import DEGREE, MOMENTS
from puck_tables.kernels.base_sums import Sums, moved
from puck_tables.kernels.law_panels import (
    NODES,
    arc_from_nearest,
    begin_of,
    circle_end,
    panels_far_off,
    side_panel,
)
from puck_tables.kernels.polygon_sums import (
    ABOUT_X,
    ABOUT_Y,
    BEGIN_X,
    BEGIN_Y,
    LENGTH,
    PIECE_COLUMNS,
    RADIUS,
    START,
    TANGENT_X,
    TANGENT_Y,
    TURN,
)

# the rule of both
FAR = 6.0  # times the reach of the base: nearer, 1e-13 is lost to cancellation at most
NODE, WEIGHT = np.polynomial.legendre.leggauss(NODES)
ON_SIDE = 1e-14  # of the reach: closer, C lies on a side, and nothing is left of it

Points = tuple[FloatArray, FloatArray, FloatArray]  # of a contour, and r × dr, or dx and dy


def law_sums_at_first(
    room: FloatArray, first: int, last: int, reach: float, law: FloatArray, ux: float, uy: float,
    w: float,
) -> Sums:  # fmt: skip
    """Sums over what a contour bounds under a law of the slip speed, before it is compiled."""
    rows = room[first:last].reshape(-1, PIECE_COLUMNS)
    if math.sqrt(ux * ux + uy * uy) > FAR * reach * abs(w):
        return _far(rows, law, ux, uy, w)
    cx, cy = -uy / w, ux / w
    parts = [
        _on_side(row, law, abs(w), cx, cy, reach) if row[TURN] == 0.0
        else _on_arc(row, law, abs(w), cx, cy)
        for row in rows
    ]  # fmt: skip
    rx, ry, area = (np.concatenate(rows) for rows in zip(*parts, strict=True))
    distance = np.hypot(rx, ry)
    h = _polynomials(law, abs(w) * distance)
    ex, ey = -ry / distance, rx / distance
    one, two, three = area * h[:, 1], area * h[:, 2], area * distance * h[:, 3]
    terms = [one * ex, one * ey, two * ex * rx, two * ex * ry, two * ey * rx, two * ey * ry,
             three * rx, three * ry]  # fmt: skip
    return _signed(moved(_summed(terms), cx, cy), w)


def _summed(terms: list[FloatArray]) -> Sums:
    return tuple(np.array(terms).sum(axis=1).tolist())


def _signed(sums: Sums, w: float) -> Sums:
    return sums if w > 0.0 else tuple(-one for one in sums)  # type: ignore[return-value]


def _polynomials(law: FloatArray, u: FloatArray) -> FloatArray:
    """F, H₁, H₂ and H₃ at slip speeds (n,), array (n, 4)."""
    count = int(law[0])
    ends = law[1 : 2 + count]
    piece = np.searchsorted(ends[1:-1], u, "right")
    t = (2.0 * u - ends[piece] - ends[piece + 1]) / (ends[piece + 1] - ends[piece])
    rows = law[2 + count :][: count * MOMENTS * (DEGREE + 1)].reshape(count, MOMENTS, DEGREE + 1)
    rows, found = rows[piece], np.zeros((len(u), MOMENTS))
    for power in range(DEGREE, -1, -1):
        found = found * t[:, None] + rows[:, :, power]
    return found


def _on_side(
    row: FloatArray, law: FloatArray, spin: float, cx: float, cy: float, reach: float
) -> Points:
    px, py, tx, ty = row[BEGIN_X] - cx, row[BEGIN_Y] - cy, row[TANGENT_X], row[TANGENT_Y]
    d, begin = px * ty - py * tx, px * tx + py * ty
    if abs(d) <= ON_SIDE * reach:
        return np.zeros(0), np.zeros(0), np.zeros(0)
    low, high = math.asinh(begin / abs(d)), math.asinh((begin + row[LENGTH]) / abs(d))
    found = []
    for way, y, last in ((1.0, max(low, 0.0), high), (-1.0, max(-high, 0.0), -low)):
        piece = begin_of(law, spin * abs(d) * math.cosh(y)) if y < last else 1
        while y < last:
            end, piece = side_panel(law, spin, abs(d), piece, y, last)
            half = 0.5 * (end - y)
            found.append(np.stack([way * (y + half * (1.0 + NODE)), half * WEIGHT]))
            y = end
    at, weight = np.concatenate(found, axis=1)
    s, distance = abs(d) * np.sinh(at), abs(d) * np.cosh(at)
    return d * ty + s * tx, s * ty - d * tx, weight * d * distance


def _on_arc(row: FloatArray, law: FloatArray, spin: float, cx: float, cy: float) -> Points:
    gx, gy, size = row[ABOUT_X] - cx, row[ABOUT_Y] - cy, row[RADIUS]
    off, nearest = math.hypot(gx, gy), math.atan2(-gy, -gx)
    low, high = arc_from_nearest(row[START], row[TURN], nearest)
    number, found = math.floor(low / math.pi), [np.zeros((2, 0))]
    while low < high:
        edge = min(math.pi * (number + 1), high)
        side, ends, last = 1.0, [low - math.pi * number], edge - math.pi * number
        if number % 2 == 1:
            side, ends = -1.0, [math.pi * (number + 1) - edge]
            last = math.pi * (number + 1) - low
        while ends[-1] < last:
            ends.append(circle_end(law, spin, off, size, ends[-1], last))
        half = 0.5 * np.diff(ends)[:, None]
        turns = np.array(ends)[:-1, None] + half * (1.0 + NODE)
        found.append(np.stack([side * turns.ravel(), (half * WEIGHT).ravel()]))
        low, number = edge, number + 1
    turn, weight = np.concatenate(found, axis=1)
    c, s = np.cos(nearest + turn), np.sin(nearest + turn)
    area = np.sign(row[TURN]) * weight * size * (size + gx * c + gy * s)
    return gx + size * c, gy + size * s, area


def _far(rows: FloatArray, law: FloatArray, ux: float, uy: float, w: float) -> Sums:
    """With C far away: the inner integral from the distance of C to the contour."""
    parts = []
    for row in rows:
        if row[TURN] == 0.0:
            half = 0.5 * row[LENGTH] * np.array([row[TANGENT_X], row[TANGENT_Y]])
            at = row[[BEGIN_X, BEGIN_Y]] + half + NODE[:, None] * half
            parts.append(np.hstack([at, WEIGHT[:, None] * half]))
            continue
        panels = panels_far_off(row[TURN])
        half = 0.5 * row[TURN] / panels
        turn = row[START] + half * (2.0 * np.arange(panels)[:, None] + 1.0 + NODE).ravel()
        out = row[RADIUS] * np.stack([np.cos(turn), np.sin(turn)], 1)
        around = half * np.tile(WEIGHT, panels)[:, None] * np.stack([-out[:, 1], out[:, 0]], 1)
        parts.append(np.hstack([row[[ABOUT_X, ABOUT_Y]] + out, around]))
    qx, qy, dx, dy = np.vstack(parts).T
    speed, spin = math.hypot(ux, uy), abs(w)
    vx, vy = ux - w * qy, uy + w * qx
    slip = np.hypot(vx, vy)
    sign = -1.0 if w < 0.0 else 1.0
    deep = sign * (2.0 * (uy * qx - ux * qy) + w * (qx * qx + qy * qy)) / (slip + speed)
    s = 0.5 * deep[:, None] * (1.0 + NODE)
    u = speed + spin * s
    part = 0.5 * deep[:, None] * WEIGHT * _polynomials(law, u.ravel())[:, 0].reshape(u.shape) * u
    k0, k1, k2 = ((part * s**power).sum(axis=1) for power in range(3))
    weight = (vx * dx + vy * dy) / (slip * slip)
    outx, outy = sign * vy / slip, -sign * vx / slip
    bx, by = qx - deep * outx, qy - deep * outy
    lever = qx * outx + qy * outy - deep
    fx, fy = sign * weight * vx / slip, sign * weight * vy / slip
    ax, ay = bx * k0 + outx * k1, by * k0 + outy * k1
    terms = [fx * k0, fy * k0, fx * ax, fx * ay, fy * ax, fy * ay,
             weight * (lever * ax + bx * k1 + outx * k2),
             weight * (lever * ay + by * k1 + outy * k2)]  # fmt: skip
    return _summed(terms)

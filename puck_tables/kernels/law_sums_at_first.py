"""The sums of :mod:`puck_tables.kernels.law_sums` by arrays, where nothing is compiled yet.

All points of the contour at once: as it is written a kernel takes thirty times as long.
"""

from __future__ import annotations

import math

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.contact.law_moments import DEGREE, MOMENTS
from puck_tables.kernels.base_friction import DISCS, HEAD, REACH, SIDES
from puck_tables.kernels.base_sums import Sums, moved
from puck_tables.kernels.law_panels import NODES, begin_of, circle_end, side_panel
from puck_tables.kernels.polygon_sums import (
    ABOUT_X,
    ABOUT_Y,
    BEGIN_X,
    BEGIN_Y,
    LENGTH,
    PIECE_COLUMNS,
    RADIUS,
    TANGENT_X,
    TANGENT_Y,
    TURN,
)

# the rule of both
FAR = 6.0  # times the reach of the base: nearer, 1e-13 is lost to cancellation at most
NODE, WEIGHT = np.polynomial.legendre.leggauss(NODES)
ON_SIDE = 1e-14  # of the reach: closer, C lies on a side, and nothing is left of it

Points = tuple[FloatArray, FloatArray, FloatArray]  # of a contour, and r × dr, or dx and dy


def law_sums_at_first(base: FloatArray, law: FloatArray, ux: float, uy: float, w: float) -> Sums:
    """Sums over a base under a law of the slip speed, before their kernel is compiled."""
    if math.sqrt(ux * ux + uy * uy) > FAR * base[REACH] * abs(w):
        return _far(base, law, ux, uy, w)
    cx, cy = -uy / w, ux / w
    parts = [_on_side(row, law, abs(w), cx, cy, base[REACH]) for row in _sides(base)]
    parts += [_on_circle(row, law, abs(w), cx, cy) for row in _discs(base)]
    rx, ry, area = (np.concatenate(rows) for rows in zip(*parts, strict=True))
    distance = np.hypot(rx, ry)
    h = _polynomials(law, abs(w) * distance)
    ex, ey = -ry / distance, rx / distance
    one, two, three = area * h[:, 1], area * h[:, 2], area * distance * h[:, 3]
    terms = [one * ex, one * ey, two * ex * rx, two * ex * ry, two * ey * rx, two * ey * ry,
             three * rx, three * ry]  # fmt: skip
    return _signed(moved(_summed(terms), cx, cy), w)


def _sides(base: FloatArray) -> FloatArray:
    end = HEAD + PIECE_COLUMNS * int(base[SIDES])
    return base[HEAD:end].reshape(-1, PIECE_COLUMNS)


def _discs(base: FloatArray) -> FloatArray:
    """The middle of each, its radius, and 1, or −1 of a hole."""
    begin, count = HEAD + PIECE_COLUMNS * int(base[SIDES]), int(base[DISCS])
    rows = base[begin : begin + PIECE_COLUMNS * count].reshape(-1, PIECE_COLUMNS)
    return np.column_stack([rows[:, [ABOUT_X, ABOUT_Y, RADIUS]], np.sign(rows[:, TURN])])


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


def _on_circle(row: FloatArray, law: FloatArray, spin: float, cx: float, cy: float) -> Points:
    gx, gy, size = row[0] - cx, row[1] - cy, row[2]
    ends = [0.0]
    while ends[-1] < math.pi:
        ends.append(circle_end(law, spin, math.hypot(gx, gy), size, ends[-1]))
    panels = np.array(ends)[:, None]
    halves = 0.5 * (panels[1:] - panels[:-1])
    turn, weight = (panels[:-1] + halves * (1.0 + NODE)).ravel(), (halves * WEIGHT).ravel()
    weight = np.concatenate([weight, weight])
    angle = math.atan2(-gy, -gx) + np.concatenate([turn, -turn])
    c, s = np.cos(angle), np.sin(angle)
    area = row[3] * weight * size * (size + gx * c + gy * s)
    return gx + size * c, gy + size * s, area


def _far(base: FloatArray, law: FloatArray, ux: float, uy: float, w: float) -> Sums:
    """With C far away: the inner integral from the distance of C to the contour."""
    parts, turn = [], np.arange(2 * NODES) * (math.pi / NODES)
    for row in _sides(base):
        half = 0.5 * row[LENGTH] * np.array([row[TANGENT_X], row[TANGENT_Y]])
        at = row[[BEGIN_X, BEGIN_Y]] + half + NODE[:, None] * half
        parts.append(np.hstack([at, WEIGHT[:, None] * half]))
    for row in _discs(base):
        out = row[2] * np.stack([np.cos(turn), np.sin(turn)], 1)
        around = row[3] * (math.pi / NODES) * np.stack([-out[:, 1], out[:, 0]], 1)
        parts.append(np.hstack([row[:2] + out, around]))
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

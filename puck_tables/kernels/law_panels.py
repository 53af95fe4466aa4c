"""Where the panels of a contour end over which a friction law by the slip speed is summed.

A law bends at its corners, and a steep one is short pieces: a rule that goes across misses that by
parts in ten thousand.  From the point of a side, or of a circle, that is nearest to the
instantaneous centre, the slip speed only grows, both ways.

Where nothing is compiled yet, the sums of :mod:`puck_tables.kernels.law_sums` are had by arrays,
all points of the contour at once: as it is written a kernel takes thirty times as long.
"""

from __future__ import annotations

import math

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.contact.law_moments import DEGREE, MOMENTS
from puck_tables.kernels.base_sums import Sums, moved
from puck_tables.kernels.compile import inlined
from puck_tables.kernels.elementary import log_of
from puck_tables.kernels.elliptic_sums import Ellipse, end_of_panel, panel_to
from puck_tables.kernels.law_axes import (
    LEAST_GAP,
    BranchPoints,
    branches_of_circle,
    branches_of_side,
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

# of Gauss's rule a panel, and across the base where C is far away; on it and on ARC rests that sums
# are good to 1e-10: test_a_law_is_integrated_as_exactly_as_a_constant
NODES = 8
PANEL = 2.0  # of y
ARC = 0.9  # of an angle, over how far it is from the singularity next to C
_AHEAD = 4  # pieces of a smooth law: a panel across them is good to 1e-11
_BEYOND = 1.0 + 1e-9  # times a slip speed: a corner there is passed
_STEP = 1e-12  # the shortest panel of a circle
# of a panel, over how far it is from where 1/|A e| branches: test_sums_are_those_of_points_on_rays
_GROWTH = 1.0


@inlined
def begin_of(law: FloatArray, u: float) -> int:
    """Where in a law the begin of the piece stands in which a slip speed lies; the last goes on."""
    low, high = 1, 1 + int(law[0])
    while high - low > 1:
        middle = (low + high) // 2
        if u >= law[middle]:
            low = middle
        else:
            high = middle
    return low


@inlined
def next_end(law: FloatArray, u: float) -> float:
    """Up to which slip speed a rule may go from one: the next corner, or some pieces on; or inf."""
    count, after = int(law[0]), begin_of(law, u) + _AHEAD
    cut = law[after] if after <= count else math.inf
    corners = 2 + count + count * MOMENTS * (DEGREE + 1)
    for k in range(int(law[corners])):
        corner = law[corners + 1 + k]
        if u * _BEYOND < corner < cut:
            cut = corner
    return cut


@inlined
def side_panel(
    law: FloatArray, spin: float, away: float, piece: int, y: float, last: float,
    branches: BranchPoints,
) -> tuple[float, int]:  # fmt: skip
    """Where the panel ends that begins at y ≥ 0, s = away sinh y, in a piece of the law.

    Also, in which piece the next one begins: no panel of a side goes across two.
    """
    end, after = last, piece
    if piece < int(law[0]):
        reach = law[piece + 1] / spin
        root = math.sqrt(max((reach - away) * (reach + away), 0.0))
        there = log_of((reach + root) / away)
        if there < last:
            end, after = max(there, y), piece + 1
    if branches.near < math.inf:
        near = end_of_panel(y, end, branches.first, branches.near, _GROWTH)
        near = end_of_panel(y, near, branches.second, branches.close, _GROWTH)
        end, after = (near, piece) if near < end else (end, after)
    panels = 1 + int((end - y) / PANEL)
    return (end, after) if panels == 1 else (y + (end - y) / panels, piece)


@inlined
def circle_end(
    law: FloatArray, spin: float, off: float, size: float, turn: float, last: float,
    branches: BranchPoints,
) -> float:  # fmt: skip
    """Where the panel ends that begins at a turn from 0 to π; ``off``: how far its middle is.

    ``last``: where the arc ends, or turns back.
    """
    gap, left = abs(off - size), last - turn
    near = min(max(gap / size, LEAST_GAP), 1.0)
    length = ARC * math.sqrt(near * near + turn * turn)
    if length >= 0.7 * left:
        length = left if length >= left else 0.5 * left
    end = turn + length if length < left else last
    product, h = 4.0 * off * size, math.sin(0.5 * turn)
    reach = next_end(law, spin * math.sqrt(gap * gap + product * h * h)) / spin
    if reach < math.inf:
        square = (reach - gap) * (reach + gap)
        if square < product:
            there = 2.0 * math.asin(math.sqrt(max(square, 0.0) / product))
            end = min(end, max(there, turn + _STEP))
    if branches.near < math.inf:
        near = panel_to(turn, end, branches.first, branches.near, _GROWTH)
        near = panel_to(turn, near, branches.second, branches.close, _GROWTH)
        end = max(near, min(end, turn + LEAST_GAP))  # C may lie there
    return end


@inlined
def arc_from_nearest(start: float, turn: float, nearest: float) -> tuple[float, float]:
    """From where to where an arc goes, counter-clockwise, counted from an angle of its circle."""
    whole = 2.0 * math.pi
    if abs(turn) == whole:  # it begins nowhere
        return 0.0, whole
    low = (start if turn > 0.0 else start + turn) - nearest
    low -= whole * math.floor(low / whole)
    return low, low + abs(turn)


@inlined
def panels_far_off(turn: float) -> int:
    """How many panels an arc takes where C is far away."""
    return 1 + int(abs(turn) / ARC)


# the rule of both
FAR = 6.0  # times the reach of the base: nearer, 1e-13 is lost to cancellation at most
NODE, WEIGHT = np.polynomial.legendre.leggauss(NODES)
ON_SIDE = 1e-14  # of the reach: closer, C lies on a side, and nothing is left of it

Points = tuple[FloatArray, FloatArray, FloatArray]  # of a contour, and r × dr, or dx and dy


def law_sums_at_first(
    room: FloatArray, first: int, last: int, reach: float, law: FloatArray, axes: Ellipse,
    ux: float, uy: float, w: float,
) -> Sums:  # fmt: skip
    """Sums over what a contour bounds under a law of the slip speed, before it is compiled."""
    rows = room[first:last].reshape(-1, PIECE_COLUMNS)
    if math.sqrt(ux * ux + uy * uy) > FAR * reach * abs(w):
        return _far(rows, law, axes, ux, uy, w)
    cx, cy = -uy / w, ux / w
    parts = [
        _on_side(row, law, axes, abs(w), cx, cy, reach) if row[TURN] == 0.0
        else _on_arc(row, law, axes, abs(w), cx, cy)
        for row in rows
    ]  # fmt: skip
    rx, ry, area = (np.concatenate(rows) for rows in zip(*parts, strict=True))
    distance = np.hypot(rx, ry)
    h = _polynomials(law, abs(w) * distance)
    ex, ey = _against(axes, -ry / distance, rx / distance)
    one, two, three = area * h[:, 1], area * h[:, 2], area * (rx * ey - ry * ex) * h[:, 3]
    terms = [one * ex, one * ey, two * ex * rx, two * ex * ry, two * ey * rx, two * ey * ry,
             three * rx, three * ry]  # fmt: skip
    return _signed(moved(_summed(terms), cx, cy), w)


def _summed(terms: list[FloatArray]) -> Sums:
    return tuple(np.array(terms).sum(axis=1).tolist())


def _against(axes: Ellipse, ex: FloatArray, ey: FloatArray) -> tuple[FloatArray, FloatArray]:
    """What keeps elements of f N = 1 slipping along unit vectors."""
    c, s = axes.cosine, axes.sine
    x, y = axes.along * (c * ex + s * ey), axes.across * (c * ey - s * ex)
    size = np.hypot(x, y)
    x, y = axes.along * x / size, axes.across * y / size
    return c * x - s * y, s * x + c * y


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
    row: FloatArray, law: FloatArray, axes: Ellipse, spin: float, cx: float, cy: float,
    reach: float,
) -> Points:  # fmt: skip
    px, py, tx, ty = row[BEGIN_X] - cx, row[BEGIN_Y] - cy, row[TANGENT_X], row[TANGENT_Y]
    d, begin = px * ty - py * tx, px * tx + py * ty
    if abs(d) <= ON_SIDE * reach:
        return np.zeros(0), np.zeros(0), np.zeros(0)
    low, high = math.asinh(begin / abs(d)), math.asinh((begin + row[LENGTH]) / abs(d))
    found = []
    for way, y, last in ((1.0, max(low, 0.0), high), (-1.0, max(-high, 0.0), -low)):
        piece = begin_of(law, spin * abs(d) * math.cosh(y)) if y < last else 1
        branches = branches_of_side(axes, way * d, tx, ty)
        while y < last:
            end, piece = side_panel(law, spin, abs(d), piece, y, last, branches)
            half = 0.5 * (end - y)
            found.append(np.stack([way * (y + half * (1.0 + NODE)), half * WEIGHT]))
            y = end
    at, weight = np.concatenate(found, axis=1)
    s, distance = abs(d) * np.sinh(at), abs(d) * np.cosh(at)
    return d * ty + s * tx, s * ty - d * tx, weight * d * distance


def _on_arc(
    row: FloatArray, law: FloatArray, axes: Ellipse, spin: float, cx: float, cy: float
) -> Points:
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
        branches = branches_of_circle(axes, gx, gy, size, nearest, side)
        while ends[-1] < last:
            ends.append(circle_end(law, spin, off, size, ends[-1], last, branches))
        half = 0.5 * np.diff(ends)[:, None]
        turns = np.array(ends)[:-1, None] + half * (1.0 + NODE)
        found.append(np.stack([side * turns.ravel(), (half * WEIGHT).ravel()]))
        low, number = edge, number + 1
    turn, weight = np.concatenate(found, axis=1)
    c, s = np.cos(nearest + turn), np.sin(nearest + turn)
    area = np.sign(row[TURN]) * weight * size * (size + gx * c + gy * s)
    return gx + size * c, gy + size * s, area


def _far(rows: FloatArray, law: FloatArray, axes: Ellipse, ux: float, uy: float, w: float) -> Sums:
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
    weight = sign * (vx * dx + vy * dy) / (slip * slip)
    outx, outy = sign * vy / slip, -sign * vx / slip
    bx, by = qx - deep * outx, qy - deep * outy
    tx, ty = _against(axes, vx / slip, vy / slip)
    lever, turning = bx * ty - by * tx, outx * ty - outy * tx
    fx, fy = weight * tx, weight * ty
    ax, ay = bx * k0 + outx * k1, by * k0 + outy * k1
    terms = [fx * k0, fy * k0, fx * ax, fx * ay, fy * ax, fy * ay,
             weight * (lever * ax + turning * (bx * k1 + outx * k2)),
             weight * (lever * ay + turning * (by * k1 + outy * k2))]  # fmt: skip
    return _summed(terms)

"""Where the panels of a contour end over which a friction law by the slip speed is summed.

A law bends at its corners, and a steep one is short pieces: a rule that goes across misses that by
parts in ten thousand.  From the point of a side, or of a circle, that is nearest to the
instantaneous centre, the slip speed only grows, both ways.

Where nothing is compiled yet, the sums of :mod:`puck_tables.kernels.law_sums` are had by arrays,
all points of the contour at once: as it is written a kernel takes thirty times as long.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.contact.law_moments import DEGREE, MOMENTS
from puck_tables.kernels.base_sums import Sums, moved
from puck_tables.kernels.compile import inlined
from puck_tables.kernels.elementary import cosine_sine_of, exp_of, log_of
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
# where C is far away: of an angle, and points around a circle:
# test_where_it_turns_far_away_a_disc_or_half_of_it_is_what_points_sum
_FAR_ARC = 1.3
_AROUND = 20
_AHEAD = 4  # pieces of a smooth law: a rule across the base is good to 1e-11 there
_BEYOND = 1.0 + 1e-9  # times a slip speed: a corner there is passed
_WHOLE = 2.0 * math.pi
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
def is_smooth_between(law: FloatArray, low: float, high: float) -> bool:
    """Whether a law is smooth from a slip speed to another, and not steep."""
    count, after = int(law[0]), begin_of(law, low) + _AHEAD
    corners = 2 + count + count * MOMENTS * (DEGREE + 1)
    smooth = after > count or high <= law[after]
    for k in range(int(law[corners])):
        smooth = smooth and not low * _BEYOND < law[corners + 1 + k] < high
    return smooth


class Nearest(NamedTuple):
    """Where a piece of a contour is nearest to C, from there on.

    ``x``, ``y``: the outward normal of a side, or of an arc where its circle is nearest; ``off``:
    how far C is along it to a side, or behind the middle of the circle; ``size``: its radius;
    ``low``, ``high``: from where to where the piece goes, in y = asinh(s/|off|), or in the angle
    from −π on; of a side where it begins, and ``begin``, s there, of a circle its middle.
    """

    x: float
    y: float
    off: float
    size: float
    low: float
    high: float
    from_x: float
    from_y: float
    begin: float


@inlined
def nearest_to(room: FloatArray, i: int, cx: float, cy: float, reach: float) -> Nearest:
    """Of a row of a contour from C."""
    turn = room[i + TURN]
    if turn == 0.0:
        tx, ty, x, y = (
            room[i + TANGENT_X],
            room[i + TANGENT_Y],
            room[i + BEGIN_X],
            room[i + BEGIN_Y],
        )
        px, py = x - cx, y - cy
        d, begin = px * ty - py * tx, px * tx + py * ty
        low, high = 0.0, 0.0
        if abs(d) > _ON_SIDE * reach:
            low, high = _asinh(begin / d, d), _asinh((begin + room[i + LENGTH]) / d, d)
        return Nearest(ty, -tx, d, 0.0, low, high, x, y, begin)
    x, y = room[i + ABOUT_X], room[i + ABOUT_Y]
    gx, gy = cx - x, cy - y
    off = math.sqrt(gx * gx + gy * gy)
    nx, ny = (gx / off, gy / off) if off > 0.0 else (1.0, 0.0)
    low, high = -math.pi, math.pi
    if abs(turn) < _WHOLE:
        start = room[i + START]
        low = (start if turn > 0.0 else start + turn) - math.atan2(ny, nx)
        low -= _WHOLE * math.floor((low + math.pi) / _WHOLE)
        high = low + abs(turn)
    return Nearest(nx, ny, off, room[i + RADIUS], low, high, x, y, 0.0)


@inlined
def _asinh(of_d: float, d: float) -> float:
    """Asinh(s/|d|) of s/d, with the sign of s."""
    size = abs(of_d)
    y = log_of(size + math.sqrt(1.0 + size * size)) if size > 0.1 else math.asinh(size)
    return y if (of_d >= 0.0) == (d >= 0.0) else -y


@inlined
def interval_of(k: int, place: Nearest, arc: bool) -> tuple[float, float, float, float]:
    """From where to where the kth interval of a piece goes, and whether ahead and back: 1 or 0.

    Of two of a side, and three of an arc, that may go around its circle.
    """
    low, high = place.low, place.high
    wrapped = high - _WHOLE if arc else -math.inf
    one, other = abs(low), abs(wrapped if arc and high > math.pi else high)
    begin, last = 0.0, min(one, other)
    if k == 1:
        begin, last = last, max(one, other)
    elif k == 2:
        begin, last = max(one, other), math.pi
    middle = 0.5 * (begin + last)
    ahead = low <= middle <= high or middle <= wrapped
    back = low <= -middle <= high or -middle <= wrapped
    return begin, last, 1.0 if ahead else 0.0, 1.0 if back else 0.0


@inlined
def distance_at(place: Nearest, at: float, arc: bool) -> float:
    """How far from C a point of a piece is."""
    if not arc:
        up = exp_of(at)
        return 0.5 * abs(place.off) * (up + 1.0 / up)
    gap, (_, h) = place.size - place.off, cosine_sine_of(0.5 * at)
    return math.sqrt(gap * gap + 4.0 * place.off * place.size * h * h)


@inlined
def branches_of(place: Nearest, axes: Ellipse, side: float, arc: bool) -> BranchPoints:
    """Where 1/|A e| branches beside a piece, ahead, or back (``side`` −1)."""
    if arc:
        gx, gy = -place.off * place.x, -place.off * place.y
        return branches_of_circle(axes, gx, gy, place.size, math.atan2(place.y, place.x), side)
    return branches_of_side(axes, side * place.off, -place.y, place.x)


@inlined
def panel_end(
    law: FloatArray, spin: float, place: Nearest, piece: int, begin: float, last: float,
    branches: BranchPoints, arc: bool,
) -> tuple[float, int]:  # fmt: skip
    """Where the panel ends that begins in a piece of the law, and in which the next one begins."""
    end, after = _arc_end(place, begin, last) if arc else last, piece
    if piece < int(law[0]):
        there = _place_of(place, law[piece + 1] / spin, arc)
        if there < end:
            end, after = max(there, begin), piece + 1
    if branches.near < math.inf:
        if arc:
            near = panel_to(begin, end, branches.first, branches.near, _GROWTH)
            near = panel_to(begin, near, branches.second, branches.close, _GROWTH)
            near = max(near, min(end, begin + LEAST_GAP))  # C may lie there
        else:
            near = end_of_panel(begin, end, branches.first, branches.near, _GROWTH)
            near = end_of_panel(begin, near, branches.second, branches.close, _GROWTH)
        end, after = (near, piece) if near < end else (end, after)
    if not arc:
        panels = 1 + int((end - begin) / PANEL)
        end, after = (end, after) if panels == 1 else (begin + (end - begin) / panels, piece)
    return end, after


@inlined
def _arc_end(place: Nearest, turn: float, last: float) -> float:
    """Where a panel of an arc ends at most that begins at a turn from 0 to π."""
    left, near = last - turn, min(max(abs(place.off / place.size - 1.0), LEAST_GAP), 1.0)
    length = ARC * math.sqrt(near * near + turn * turn)
    if length >= 0.7 * left:
        length = left if length >= left else 0.5 * left
    return turn + length if length < left else last


@inlined
def _place_of(place: Nearest, distance: float, arc: bool) -> float:
    """Where on a piece a distance from C is reached; inf: nowhere."""
    if not arc:
        away = abs(place.off)
        root = math.sqrt(max((distance - away) * (distance + away), 0.0))
        return log_of((distance + root) / away)
    gap, product = place.size - place.off, 4.0 * place.off * place.size
    square = (distance - gap) * (distance + gap)
    if not square < product or product == 0.0:
        return math.inf
    return 2.0 * math.asin(math.sqrt(max(square, 0.0) / product))


@inlined
def points_far_off(turn: float) -> int:
    """How many points a piece of a contour takes where C is far away."""
    return _AROUND if abs(turn) == _WHOLE else NODES * (1 + int(abs(turn) / _FAR_ARC))


@inlined
def far_point(turn: float, k: int) -> tuple[float, float]:
    """What share of the piece lies before its kth point, and the weight of that."""
    if abs(turn) == _WHOLE:
        return k / _AROUND, 1.0 / _AROUND
    panels, n = points_far_off(turn) // NODES, k % NODES
    return (k // NODES + 0.5 + 0.5 * NODE[n]) / panels, 0.5 * WEIGHT[n] / panels


# the rule of both
FAR = 6.0  # times the reach of the base: nearer, 1e-13 is lost to cancellation at most
NODE, WEIGHT = np.polynomial.legendre.leggauss(NODES)
_ON_SIDE = 1e-14  # of the reach: closer, C lies on a side, and nothing is left of it

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
        _points(row, law, axes, abs(w), nearest_to(row, 0, cx, cy, reach)) for row in rows
    ]  # fmt: skip
    rx, ry, area = (np.concatenate(rows) for rows in zip(*parts, strict=True))
    distance = np.hypot(rx, ry)
    h = _polynomials(law, abs(w) * distance)
    ex, ey = _against(axes, -ry / distance, rx / distance)
    one, two, three = area * h[:, 1], area * h[:, 2], area * (rx * ey - ry * ex) * h[:, 3]
    terms = [one * ex, one * ey, two * ex * rx, two * ex * ry, two * ey * rx, two * ey * ry,
             three * rx, three * ry]  # fmt: skip
    sums = moved(_summed(terms), cx, cy)
    return sums if w > 0.0 else tuple(-one for one in sums)  # type: ignore[return-value]


def _summed(terms: list[FloatArray]) -> Sums:
    return tuple(np.array(terms).sum(axis=1).tolist())


def _against(axes: Ellipse, ex: FloatArray, ey: FloatArray) -> tuple[FloatArray, FloatArray]:
    """What keeps elements of f N = 1 slipping along unit vectors."""
    c, s = axes.cosine, axes.sine
    x, y = axes.along * (c * ex + s * ey), axes.across * (c * ey - s * ex)
    size = np.hypot(x, y)
    x, y = axes.along * x / size, axes.across * y / size
    return c * x - s * y, s * x + c * y


def _polynomials(law: FloatArray, u: FloatArray) -> FloatArray:
    """F, H₁, H₂ and H₃ at slip speeds (n,), array (n, 4)."""
    count = int(law[0])
    ends = law[1 : 2 + count]
    piece = np.searchsorted(ends[1:-1], u, "right")
    t = (2.0 * u - ends[piece] - ends[piece + 1]) / (ends[piece + 1] - ends[piece])
    rows = law[2 + count :][: count * MOMENTS * (DEGREE + 1)].reshape(count, MOMENTS, DEGREE + 1)
    rows, values = rows[piece], np.zeros((len(u), MOMENTS))
    for power in range(DEGREE, -1, -1):
        values = values * t[:, None] + rows[:, :, power]
    return values


def _points(row: FloatArray, law: FloatArray, axes: Ellipse, spin: float, place: Nearest) -> Points:
    arc, points = bool(row[TURN] != 0.0), [np.zeros((2, 0))]
    for side in (1.0, -1.0):
        branches = branches_of(place, axes, side, arc)
        for k in range(3 if arc else 2):
            begin, last, *both = interval_of(k, place, arc)
            if both[0 if side > 0.0 else 1] == 0.0 or not begin < last:
                continue
            ends, piece = [begin], begin_of(law, spin * distance_at(place, begin, arc))
            while ends[-1] < last:
                end, piece = panel_end(law, spin, place, piece, ends[-1], last, branches, arc)
                ends.append(end)
            half = 0.5 * np.diff(ends)[:, None]
            turns = np.array(ends)[:-1, None] + half * (1.0 + NODE)
            points.append(np.stack([side * turns.ravel(), (half * WEIGHT).ravel()]))
    at, weight = np.concatenate(points, axis=1)
    off, size = place.off, place.size
    if arc:
        x, y, area = size * np.cos(at) - off, size * np.sin(at), size * (size - off * np.cos(at))
    else:
        x, y, area = np.full(len(at), off), abs(off) * np.sinh(at), off * abs(off) * np.cosh(at)
    whole = (-1.0 if row[TURN] < 0.0 else 1.0) * weight * area
    return x * place.x - y * place.y, x * place.y + y * place.x, whole


def _far(rows: FloatArray, law: FloatArray, axes: Ellipse, ux: float, uy: float, w: float) -> Sums:
    """With C far away: the inner integral from the distance of C to the contour."""
    parts = []
    for row in rows:
        turn = float(row[TURN])
        points = [far_point(turn, k) for k in range(points_far_off(turn))]
        share, weight = np.array(points).T[:, :, None]
        if turn == 0.0:
            along = row[LENGTH] * row[[TANGENT_X, TANGENT_Y]]
            parts.append(np.hstack([row[[BEGIN_X, BEGIN_Y]] + share * along, weight * along]))
            continue
        angle = row[START] + share * turn
        out = row[RADIUS] * np.hstack([np.cos(angle), np.sin(angle)])
        around = weight * turn * np.stack([-out[:, 1], out[:, 0]], 1)
        parts.append(np.hstack([row[[ABOUT_X, ABOUT_Y]] + out, around]))
    qx, qy, dx, dy = np.vstack(parts).T
    speed, spin = math.hypot(ux, uy), abs(w)
    vx, vy = ux - w * qy, uy + w * qx
    slip = np.hypot(vx, vy)
    sign = -1.0 if w < 0.0 else 1.0
    deep = sign * (2.0 * (uy * qx - ux * qy) + w * (qx * qx + qy * qy)) / (slip + speed)
    moments, low, high = np.zeros((3, len(deep))), np.minimum(deep, 0.0), np.maximum(deep, 0.0)
    first = begin_of(law, float((speed + spin * low).min()))
    last = begin_of(law, float((speed + spin * high).max()))
    for piece in range(first, last + 1):  # rays are cut where it ends
        begin = low if piece == first else np.clip((law[piece] - speed) / spin, low, high)
        end = high if piece == last else np.clip((law[piece + 1] - speed) / spin, low, high)
        half = 0.5 * (end - begin)[:, None]
        s = begin[:, None] + half * (1.0 + NODE)
        u = speed + spin * s
        part = half * WEIGHT * _polynomials(law, u.ravel())[:, 0].reshape(u.shape) * u
        moments += np.sign(deep) * np.array([(part * s**power).sum(axis=1) for power in range(3)])
    k0, k1, k2 = moments
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

"""Friction of a base on any floor by points on rays from the instantaneous centre.

All along a ray the slip is in one direction.  Rays are cut where they cross the outline of the base
or a border of the floor; Gauss's rule of three nodes on each piece is exact for what is summed
there, of more under a law of the slip speed, where rays are cut at its corners, too.  Angles are
summed by panels between the directions of all corners, crossings and tangents.  A curve is a
straight piece (ax, ay, bx, by) or a circle (cx, cy, r).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from itertools import combinations, pairwise

import numpy as np

Curve = tuple[float, ...]
# from places (n,) and unit slips to what keeps an element of the load 1 slipping there
Local = Callable[[np.ndarray, np.ndarray, np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]
FAR = 50.0  # m: where straight borders end
NODE, WEIGHT = np.polynomial.legendre.leggauss(24)


def sides(corners: Sequence[Sequence[float]]) -> list[Curve]:
    """The pieces of a polygon."""
    return [(*a, *b) for a, b in zip(corners, [*corners[1:], corners[0]], strict=True)]


def within(
    outlines: Sequence[Sequence[Sequence[float]]],
) -> Callable[[np.ndarray, np.ndarray], np.ndarray]:
    """Whether places lie in polygons, in an odd number of them."""

    def inside(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        found = np.zeros(x.shape, bool)
        for ax, ay, bx, by in (side for corners in outlines for side in sides(corners)):
            if ay != by:
                found ^= ((ay > y) != (by > y)) & (x < ax + (y - ay) / (by - ay) * (bx - ax))
        return found

    return inside


def border(angle: float, place: float) -> Curve:
    """A straight border across a direction."""
    c, s = math.cos(angle), math.sin(angle)
    return place * c - FAR * s, place * s + FAR * c, place * c + FAR * s, place * s - FAR * c


def _met(one: Curve, other: Curve) -> list[tuple[float, float]]:
    """Where two curves meet."""
    if len(one) == 3 and len(other) == 3:
        (ax, ay, r), (bx, by, s) = one, other
        d = math.hypot(bx - ax, by - ay)
        if not abs(r - s) < d < r + s:
            return []
        along = (d * d + r * r - s * s) / (2 * d)
        off, ex, ey = math.sqrt(r * r - along * along), (bx - ax) / d, (by - ay) / d
        return [(ax + along * ex - k * off * ey, ay + along * ey + k * off * ex) for k in (-1, 1)]
    if len(one) == 3:
        one, other = other, one
    ax, ay, bx, by = one
    dx, dy = bx - ax, by - ay
    if len(other) == 3:
        cx, cy, r = other
        roots = np.roots([dx * dx + dy * dy, 2 * ((ax - cx) * dx + (ay - cy) * dy),
                          (ax - cx) ** 2 + (ay - cy) ** 2 - r * r])  # fmt: skip
        return [(ax + t * dx, ay + t * dy) for t in roots.real] if np.isreal(roots).all() else []
    ex, ey = other[2] - other[0], other[3] - other[1]
    cross = dx * ey - dy * ex
    if abs(cross) < 1e-14:
        return []
    t = ((other[0] - ax) * ey - (other[1] - ay) * ex) / cross
    return [(ax + t * dx, ay + t * dy)]


def _angles(curves: Sequence[Curve], cx: float, cy: float) -> np.ndarray:
    """Directions from (cx, cy) between which what rays cross changes smoothly."""
    places = [p for one, two in combinations(curves, 2) for p in _met(one, two)]
    found = [0.0, 2 * math.pi]
    for curve in curves:
        if len(curve) == 4:
            places += [curve[:2], curve[2:]]
            continue
        away = math.hypot(curve[0] - cx, curve[1] - cy)
        to = math.atan2(curve[1] - cy, curve[0] - cx)
        if away > curve[2]:
            found += [(to + k * math.asin(curve[2] / away)) % (2 * math.pi) for k in (-1, 1)]
    found += [math.atan2(y - cy, x - cx) % (2 * math.pi) for x, y in places]
    return np.array(sorted(set(found)))


def points_on_rays(
    curves: Sequence[Curve], centre: tuple[float, float], panels: int = 4, inner: int = 3
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:  # fmt: skip
    """Places and areas of the plane as far as the last curve: all that curves cut is told apart."""
    cx, cy = centre
    nodes, part = np.polynomial.legendre.leggauss(inner)
    theta, weight = [], []
    for low, high in pairwise(_angles(curves, cx, cy)):
        ends = np.linspace(0.0, 1.0, panels + 1)
        share = (ends[:-1, None] + 0.5 / panels * (1.0 + NODE)).ravel()
        # 35 s⁴ − … : whose slopes vanish at both ends, where roots may begin
        way = share**4 * (35 + share * (-84 + share * (70 - 20 * share)))
        slope = 140 * share**3 * (1 - share) ** 3
        theta.append(low + (high - low) * way)
        weight.append((high - low) * slope * np.tile(0.5 / panels * WEIGHT, panels))
    angle, w = np.concatenate(theta), np.concatenate(weight)
    nx, ny = np.cos(angle), np.sin(angle)
    cuts = [np.zeros_like(angle)]
    with np.errstate(divide="ignore", invalid="ignore"):
        for curve in curves:
            if len(curve) == 4:
                ax, ay, bx, by = curve[0] - cx, curve[1] - cy, curve[2] - cx, curve[3] - cy
                cross = nx * (by - ay) - ny * (bx - ax)
                far = (ax * (by - ay) - ay * (bx - ax)) / cross
                share = (ax * ny - ay * nx) / cross
                cuts.append(np.where((share >= 0) & (share <= 1) & (far > 0), far, 0.0))
            else:
                ax, ay = curve[0] - cx, curve[1] - cy
                middle, across = ax * nx + ay * ny, ax * ny - ay * nx
                half = np.sqrt(np.maximum(curve[2] ** 2 - across**2, 0.0))
                cuts += [np.maximum(middle - half, 0.0), np.maximum(middle + half, 0.0)]
    cut = np.sort(np.array(cuts), axis=0)
    low, high = cut[:-1], cut[1:]
    far = 0.5 * (low + high) + 0.5 * nodes[:, None, None] * (high - low)
    area = 0.5 * part[:, None, None] * (high - low) * far * w
    return (cx + far * nx).ravel(), (cy + far * ny).ravel(), area.ravel()


def friction_of(
    curves: Sequence[Curve], inside: Callable[[np.ndarray, np.ndarray], np.ndarray], local: Local,
    velocity: Sequence[float], lever: float = 0.0, panels: int = 4, inner: int = 3,
) -> np.ndarray:  # fmt: skip
    """Force and torque at the load 1 about the origin, of what lies inside and slips so.

    ``lever``: the height of the origin, m: by so much does friction tilt the linear pressure.
    """
    vx, vy, w = velocity
    x, y, area = points_on_rays(curves, (-vy / w, vx / w), panels, inner)
    keep = inside(x, y) & (area > 0.0) & (np.hypot(vx - w * y, vy + w * x) > 0.0)
    x, y, area = x[keep], y[keep], area[keep]
    ux, uy = vx - w * y, vy + w * x
    slip = np.hypot(ux, uy)
    tx, ty = local(x, y, ux / slip, uy / slip)
    rows = np.stack([np.ones_like(x), x, y])
    pull = [np.zeros(3), -(rows * area) @ tx * lever, -(rows * area) @ ty * lever]
    matrix = (rows * area) @ rows.T + np.stack(pull)
    load = area * (np.linalg.solve(matrix, [1.0, 0.0, 0.0]) @ rows)
    return -np.array([load @ tx, load @ ty, load @ (x * ty - y * tx)])


def where_it_bends(
    velocity: Sequence[float], speeds: Sequence[float], axes: Sequence[float]
) -> list[Curve]:
    """Where slips have a speed, and, through C, where they are along axes or across."""
    vx, vy, w = velocity
    cx, cy = -vy / w, vx / w
    turned = [axis + k * math.pi / 2 for axis in axes for k in range(2)]
    lines = [border(angle, cx * math.cos(angle) + cy * math.sin(angle)) for angle in turned]
    return [*((cx, cy, speed / abs(w)) for speed in speeds), *lines]


def by_ellipse(
    pair: Sequence[float], angle: float, ex: np.ndarray, ey: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:  # fmt: skip
    """What keeps elements of the load 1 slipping along e, on a floor with axes at an angle."""
    c, s = math.cos(angle), math.sin(angle)
    one, two = pair[0] * (c * ex + s * ey), pair[1] * (c * ey - s * ex)
    root = np.hypot(one, two)
    one, two = pair[0] * one / root, pair[1] * two / root
    return c * one - s * two, s * one + c * two

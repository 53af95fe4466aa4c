"""Whether polygons and discs cross, touch, or lie in each other."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray

_BLOCK = 512  # sides that are looked at together

Outline = Sequence[tuple[float, float]]
Shape = tuple[Sequence[Outline], Sequence[tuple[float, float, float, float]]]


def crossing(outline: Outline, other: Outline | None = None) -> bool:
    """Whether sides of an outline cross or touch those of another, or, left out, its own.

    >>> crossing([(0, 0), (1, 1), (1, 0), (0, 1)]), crossing([(0, 0), (1, 0), (1, 1), (0, 1)])
    (True, False)
    """
    p, own = np.array(outline, np.float64), other is None
    a = p if other is None else np.array(other, np.float64)
    q, b = np.roll(p, -1, axis=0), np.roll(a, -1, axis=0)
    number = np.arange(len(a))
    for begin in range(0, len(p), _BLOCK):
        one = slice(begin, begin + _BLOCK)
        cross = _meet(p[one, None], q[one, None], a[None], b[None])
        if own:  # a side meets itself, and those beside it at their common corner
            apart = np.abs(np.arange(len(p))[one, None] - number[None])
            cross &= (apart > 1) & (apart < len(p) - 1)
        if cross.any():
            return True
    return own and _folds(p)


def _meet(p: FloatArray, q: FloatArray, a: FloatArray, b: FloatArray) -> npt.NDArray[np.bool_]:
    """Whether pieces from p to q and from a to b have a point in common."""

    def side(u: FloatArray, v: FloatArray, w: FloatArray) -> FloatArray:
        return np.sign((v - u)[..., 0] * (w - u)[..., 1] - (v - u)[..., 1] * (w - u)[..., 0])

    boxes = (np.minimum(p, q) <= np.maximum(a, b)) & (np.minimum(a, b) <= np.maximum(p, q))
    across = (side(p, q, a) * side(p, q, b) <= 0.0) & (side(a, b, p) * side(a, b, q) <= 0.0)
    return np.asarray(across & boxes.all(axis=-1))


def _folds(p: FloatArray) -> bool:
    """Whether a side runs back along the one before."""
    u, v = p - np.roll(p, 1, axis=0), np.roll(p, -1, axis=0) - p
    cross, along = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0], (u * v).sum(axis=1)
    return bool(((cross == 0.0) & (along < 0.0)).any())


def inside(outline: Outline, place: tuple[float, float]) -> bool:
    """Whether a place lies in an outline.

    >>> inside([(0, 0), (1, 0), (0, 1)], (0.2, 0.2)), inside([(0, 0), (1, 0), (0, 1)], (1.0, 1.0))
    (True, False)
    """
    (x, y), p = place, np.array(outline, np.float64)
    q = np.roll(p, -1, axis=0)
    spans = (p[:, 1] > y) != (q[:, 1] > y)
    rise = np.where(spans, q[:, 1] - p[:, 1], 1.0)
    at = p[:, 0] + (y - p[:, 1]) * (q[:, 0] - p[:, 0]) / rise
    return bool(np.count_nonzero(spans & (at > x)) % 2)


def _distance(outline: Outline, place: tuple[float, float]) -> float:
    """How far a place is from the sides."""
    p = np.array(outline, np.float64)
    along = np.roll(p, -1, axis=0) - p
    off = np.array(place) - p
    share = np.clip((off * along).sum(axis=1) / (along * along).sum(axis=1), 0.0, 1.0)
    return float(np.hypot(*(off - share[:, None] * along).T).min())


def _holds(shape: Shape, place: tuple[float, float]) -> bool:
    """Whether a place lies in a shape with its holes."""
    outlines, discs = shape
    count = sum(
        (1 if _turn(outline) > 0.0 else -1) for outline in outlines if inside(outline, place)
    )
    return count + sum(d[3] for d in discs if math.dist(d[:2], place) < d[2]) > 0.0


def _turn(outline: Outline) -> float:
    """Twice its area, negative where it runs clockwise."""
    x, y = np.array(outline, np.float64).T
    return float(x @ np.roll(y, -1) - y @ np.roll(x, -1))


def overlap(one: Shape, other: Shape) -> bool:
    """Whether two shapes, of outlines and discs with holes, overlap.

    >>> foot, near = ((), [(0.0, 0.0, 0.1, 1.0)]), ((), [(0.15, 0.0, 0.1, 1.0)])
    >>> overlap(foot, near), overlap(foot, ((), [(0.3, 0.0, 0.1, 1.0)]))
    (True, False)
    """
    for first, second in ((one, other), (other, one)):
        for outline in first[0]:
            if any(crossing(outline, theirs) for theirs in second[0]):
                return True
            for x, y, radius, _ in second[1]:
                far = max(math.dist(corner, (x, y)) for corner in outline)
                if _distance(outline, (x, y)) < radius < far:
                    return True
            if _holds(second, outline[0]):
                return True
        for x, y, radius, sign in first[1]:
            for a, b, size, _ in second[1]:
                if abs(radius - size) < math.dist((x, y), (a, b)) < radius + size:
                    return True
            if sign > 0.0 and (_holds(second, (x + radius, y)) or _holds(second, (x, y))):
                return True
    return False

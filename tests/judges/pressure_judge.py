"""Friction under any axisymmetric pressure on several frictions, judged circle by circle.

Shares no code with the package: on a circle about the centre the slip direction is what it is at
every point, and f what it is where the point lies; the double exponential rule integrates between
the angles at which something changes, and over the radii between those at which those appear.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise

import numpy as np
from astride_judge import FloorMap, under_linear_load

_T = np.linspace(-3.4, 3.4, 103)
_SPREAD = np.exp(0.5 * math.pi * np.sinh(-np.abs(_T)))
_FROM_END = _SPREAD / (_SPREAD + 1.0 / _SPREAD)
_RULE = (0.5 * math.pi * np.cosh(_T) * (_T[1] - _T[0])) * 2.0 * _FROM_END * (1.0 - _FROM_END)


def value(ground: FloorMap, x: float, y: float) -> float:
    """f at a place."""
    for cx, cy, r, f in ground.discs:
        if math.hypot(x - cx, y - cy) < r:
            return f
    for corners, f in ground.polygons:
        within = False
        for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
            if (a[1] > y) != (b[1] > y) and x < a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]):
                within = not within
        if within:
            return f
    return ground.around(x)


def _edges(ground: FloorMap) -> list[tuple[np.ndarray, np.ndarray]]:
    return [
        (a, b)
        for corners, _ in ground.polygons
        for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True)
    ]


def _angles(ground: FloorMap, rho: float) -> list[float]:
    """Where a circle about the centre passes from one friction to another."""
    found = []
    for border in ground.borders:
        if abs(border) < rho:
            found += [math.acos(border / rho), -math.acos(border / rho)]
    for cx, cy, r, _ in ground.discs:
        apart = math.hypot(cx, cy)
        if abs(rho - r) < apart < rho + r:
            cosine = (apart**2 + rho**2 - r**2) / (2.0 * apart * rho)  # beyond 1 is rounding
            turn = math.acos(min(max(cosine, -1.0), 1.0))
            found += [math.atan2(cy, cx) + turn, math.atan2(cy, cx) - turn]
    for a, b in _edges(ground):
        way = b - a
        room = (a @ way) ** 2 - (way @ way) * (a @ a - rho * rho)
        if room > 0.0:
            for side in (-1.0, 1.0):
                share = (side * math.sqrt(room) - a @ way) / (way @ way)
                if 0.0 < share < 1.0:
                    found.append(math.atan2(*(a + share * way)[::-1]))
    return found


def _radii(ground: FloorMap) -> list[float]:
    """Where such angles appear."""
    found = [abs(border) for border in ground.borders]
    for cx, cy, r, _ in ground.discs:
        found += [abs(math.hypot(cx, cy) - r), math.hypot(cx, cy) + r]
    for a, b in _edges(ground):
        way = b - a
        found.append(math.hypot(*a))
        if 0.0 < -(a @ way) < way @ way:
            found.append(abs(a[0] * way[1] - a[1] * way[0]) / math.hypot(*way))
    return found


def on_circle(ground: FloorMap, ux: float, uy: float, w: float, rho: float) -> np.ndarray:
    """∮ f (e, x_k e_j, x_k (x e_y − y e_x)) by the angle."""
    away = math.atan2(ux, -uy) if w > 0.0 else math.atan2(-ux, uy)  # of the centre of rotation
    stops = sorted({a % (2.0 * math.pi) for a in [*_angles(ground, rho), away, away + math.pi]})
    total = np.zeros(8)
    for low, high in pairwise([*stops, stops[0] + 2.0 * math.pi]):
        step, weight = (high - low) * _FROM_END, (high - low) * _RULE
        begin, turn = np.where(_T < 0.0, low, high), np.where(_T < 0.0, step, -step)
        middle = 0.5 * (low + high)
        f = value(ground, rho * math.cos(middle), rho * math.sin(middle))
        x, y = rho * np.cos(begin + turn), rho * np.sin(begin + turn)
        vx, vy = ux - w * y, uy + w * x
        if w != 0.0:  # near the centre of rotation without cancellation
            mx, my = -uy / w, ux / w
            bx, by = rho * np.cos(begin) - mx, rho * np.sin(begin) - my
            sx = -2.0 * rho * np.sin(begin + 0.5 * turn) * np.sin(0.5 * turn)
            sy = 2.0 * rho * np.cos(begin + 0.5 * turn) * np.sin(0.5 * turn)
            vx, vy = -w * (by + sy), w * (bx + sx)
        size = np.maximum(np.hypot(vx, vy), 1e-300)
        ex, ey = vx / size, vy / size
        m = x * ey - y * ex
        total += f * (np.stack([ex, ey, x * ex, y * ex, x * ey, y * ey, x * m, y * m]) @ weight)
    return total


def friction(
    ground: FloorMap, slip: tuple[float, float, float], law: Callable[[float, float], float] | None,
    height: float, mean_square: float, bends: tuple[float, ...] = (),
) -> np.ndarray:  # fmt: skip
    """∫ f σ e dA / N and its moment over r; ``law`` W at ρ and 1 − ρ (None: the ring)."""
    ux, uy, w = slip
    if law is None:
        m = on_circle(ground, *slip, 1.0) / (2.0 * math.pi)
    else:
        away = math.hypot(ux, uy) / abs(w) if w else 2.0
        stops = sorted({0.0, 1.0, *(a for a in [*_radii(ground), away, *bends] if 0.0 < a < 1.0)})
        m = np.zeros(8)
        for low, high in pairwise(stops):
            for t, share, rule in zip(_T, _FROM_END, _RULE, strict=True):
                step = (high - low) * share
                rho = low + step if t < 0.0 else high - step
                short = 1.0 - rho if t < 0.0 or high < 1.0 else step
                if rho > 0.0:
                    weight = (high - low) * rule * law(rho, short) * rho / math.pi
                    m += weight * on_circle(ground, *slip, rho)
    return under_linear_load(m, height / mean_square)

"""Friction on a base that lies on several frictions, judged by scanning it line by line.

Shares no code with the package: along a straight line across the base the friction is elementary,
and over the lines the double exponential rule integrates between all places where they change.
The motion is that of scipy.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

_T = np.linspace(-3.35, 3.35, 81)
_SPREAD = np.exp(0.5 * math.pi * np.sinh(-np.abs(_T)))
_FROM_END = _SPREAD / (_SPREAD + 1.0 / _SPREAD)  # of the nearer end, without cancellation
_RULE = (0.5 * math.pi * np.cosh(_T) * (_T[1] - _T[0])) * 2.0 * _FROM_END * (1.0 - _FROM_END)

Spans = Callable[[np.ndarray], list[tuple[float, np.ndarray, np.ndarray]]]


class FloorMap:
    """Frictions around (0, 0) in axes across the borders; places in radii.

    ``borders``, ``values``: of strips; ``discs``: (x, y, radius, f); ``polygons``: (corners, f).
    """

    def __init__(
        self, borders: list[float], values: list[float],
        discs: list[tuple[float, float, float, float]] | None = None,
        polygons: list[tuple[np.ndarray, float]] | None = None,
    ) -> None:  # fmt: skip
        self.borders, self.values = borders, values
        self.discs, self.polygons = discs or [], polygons or []

    def around(self, f: float) -> float:
        return self.values[int(np.searchsorted(self.borders, f, "right"))]

    def stops(self, size: float) -> list[float]:
        """Places between which the lines meet the same pieces."""
        places = [*self.borders]
        for x, y, r, _ in self.discs:
            places += [x - r, x + r]
            apart = math.hypot(x, y)
            if abs(size - r) < apart < size + r:
                along = (apart * apart + size * size - r * r) / (2.0 * apart)
                aside = math.sqrt(size * size - along * along)
                places += [(along * x + s * aside * y) / apart for s in (-1.0, 1.0)]
        for corners, _ in self.polygons:
            places += corners[:, 0].tolist()
            for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
                way = b - a
                square, middle = way @ way, a @ way
                room = middle * middle - square * (a @ a - size * size)
                if room > 0.0:
                    places += [
                        float(a[0] + (s * math.sqrt(room) - middle) / square * way[0])
                        for s in (-1.0, 1.0)
                    ]
        return places

    def spans(self, p: np.ndarray, size: float) -> list[tuple[float, np.ndarray, np.ndarray]]:
        """Pieces of the lines at p within the base: f more than what is below them, from, to."""
        middle = float(p[len(p) // 2])
        half = np.sqrt(np.maximum(size * size - p * p, 0.0))
        found = [(self.around(middle), -half, half)]
        for x, y, r, f in self.discs:
            if abs(middle - x) < r:
                reach = np.sqrt(np.maximum(r * r - (p - x) ** 2, 0.0))
                low = np.clip(y - reach, -half, half)
                found.append((f - self.around(x), low, np.clip(y + reach, -half, half)))
        for corners, f in self.polygons:
            cuts = []
            for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
                if min(a[0], b[0]) < middle < max(a[0], b[0]):
                    cuts.append(a[1] + (p - a[0]) / (b[0] - a[0]) * (b[1] - a[1]))
            cuts.sort(key=lambda row: row[len(p) // 2])
            for low, high in zip(cuts[::2], cuts[1::2], strict=True):
                low, high = np.clip(low, -half, half), np.clip(high, -half, half)
                found.append((f - self.around(float(corners[:, 0].mean())), low, high))
        return found


def sums(floor_map: FloorMap, ux: float, uy: float, w: float, size: float = 1.0) -> np.ndarray:
    """∫ f e_j, ∫ f x_k e_j and ∫ f x_k (x e_y − y e_x) over a disc; e of the slip (ux, uy), w."""
    straight = abs(w) <= 1e-12 * math.hypot(ux, uy)  # else its centre is too far away to be told
    centre = (0.0, 0.0) if straight else (-uy / w, ux / w)
    stops = {-size, size, *(s for s in [*floor_map.stops(size), centre[0]] if -size < s < size)}
    ordered = sorted(stops)
    total = np.zeros(8)
    for low, high in pairwise(ordered):
        step = (high - low) * _FROM_END
        p, weight = np.where(_T < 0.0, low + step, high - step), (high - low) * _RULE
        off = np.where(_T < 0.0, (low - centre[0]) + step, (high - centre[0]) - step)
        for f, begin, end in floor_map.spans(p, size):
            if straight:
                one = _straight(p, begin, end, ux, uy)
            else:
                one = math.copysign(1.0, w) * _lines(p, off, begin, end, centre[1])
            total += f * (one @ weight)
    return total


def _straight(p: np.ndarray, begin: np.ndarray, end: np.ndarray, ux: float, uy: float) -> Any:
    x, y = ux / math.hypot(ux, uy), uy / math.hypot(ux, uy)
    l0, l1, l2 = end - begin, 0.5 * (end**2 - begin**2), (end**3 - begin**3) / 3.0
    return np.stack([
        x * l0, y * l0, x * p * l0, x * l1, y * p * l0, y * l1,
        p * (y * p * l0 - x * l1), y * p * l1 - x * l2,
    ])  # fmt: skip


def _lines(p: np.ndarray, off: np.ndarray, begin: np.ndarray, end: np.ndarray, c: float) -> Any:
    """Along lines at p, a distance ``off`` beside the centre of rotation, which is level with c."""

    def ends(q: np.ndarray) -> np.ndarray:
        r = np.hypot(off, q)
        with np.errstate(divide="ignore", invalid="ignore"):
            turn = np.where(off != 0.0, np.arcsinh(q / np.abs(off)), 0.0)
        one, two = r, 0.5 * (q * r - off * off * turn)  # ∫ q/R, ∫ q²/R
        three = r**3 / 3.0 - off * off * r
        x0, x1, x2 = -one, -(two + c * one), -(three + 2.0 * c * two + c * c * one)
        y0, y1 = off * turn, off * (r + c * turn)
        return np.stack([
            x0, y0, p * x0, x1, p * y0, y1, p * (p * y0 - x1), p * y1 - x2,
        ])  # fmt: skip

    return ends(end - c) - ends(begin - c)


def friction(
    floor_map: FloorMap, ux: float, uy: float, w: float, lever: float = 0.0, hole: float = 0.0
) -> np.ndarray:
    """∫ f σ e dA / N and its moment over r, for σ = (1 + b·x)/A with b = lever · ∫ f σ e dA / N."""
    m = sums(floor_map, ux, uy, w)
    if hole:
        m = m - sums(floor_map, ux, uy, w, hole)
    return under_linear_load(m / (math.pi * (1.0 - hole * hole)), lever)


def under_linear_load(m: np.ndarray, lever: float) -> np.ndarray:
    """Force and moment from sums over a level load of 1, ``lever`` as of :func:`friction`."""
    b = np.linalg.solve(np.eye(2) - lever * np.array([[m[2], m[3]], [m[4], m[5]]]), lever * m[:2])
    return np.array([
        m[0] + b @ m[2:4], m[1] + b @ m[4:6], m[4] - m[3] + b @ m[6:8],
    ])  # fmt: skip


class Motion:
    """A puck over a floor of strips and patches, as a scene has them, with a constant pull."""

    def __init__(self, scene: Any) -> None:
        puck, floor = scene.puck, scene.floor
        self.radius, self.mass = puck.radius, puck.mass
        self.inertia = puck.mass * (puck.gyration * puck.radius) ** 2
        self.normal = puck.mass * puck.gravity * math.cos(floor.slope)
        down = puck.mass * puck.gravity * math.sin(floor.slope)
        self.pull = down * np.array([math.cos(floor.downhill), math.sin(floor.downhill)])
        self.pull = self.pull + scene.force.constant
        self.torque = scene.force.torque
        law = str(puck.pressure)
        self.hole = float(law.partition(":")[2]) if law.startswith("annulus") else 0.0
        self.lever = 2.0 * puck.height / (puck.radius * (1.0 + self.hole**2))
        self.floor, self.friction = floor, puck.friction
        self.belt = np.array(floor.velocity)

    def floor_map(self, x: float, y: float) -> tuple[FloorMap, float]:
        strips, r = self.floor.strips, self.radius
        turn = 0.0 if strips is None else strips.direction
        c, s = math.cos(turn), math.sin(turn)
        frame = np.array([[c, s], [-s, c]])
        place = frame @ (x, y)
        borders = [] if strips is None else [(b - place[0]) / r for b in strips.borders]
        values = [self.friction] if strips is None else list(strips.friction)
        discs, polygons = [], []
        for patch in self.floor.patches:
            if patch.corners:
                polygons.append(((np.array(patch.corners) @ frame.T - place) / r, patch.friction))
            else:
                middle = (frame @ patch.centre - place) / r
                discs.append((*middle.tolist(), patch.radius / r, patch.friction))
        return FloorMap(borders, values, discs, polygons), turn

    def force(self, y: np.ndarray) -> np.ndarray:
        """Force and torque of the floor at a state x, y, θ, vx, vy, ω."""
        floor_map, turn = self.floor_map(y[0], y[1])
        c, s = math.cos(turn), math.sin(turn)
        ux, uy = y[3] - self.belt[0], y[4] - self.belt[1]
        found = self.normal * friction(
            floor_map, c * ux + s * uy, c * uy - s * ux, self.radius * y[5], self.lever, self.hole
        )
        return -np.array([
            c * found[0] - s * found[1], s * found[0] + c * found[1], self.radius * found[2],
        ])  # fmt: skip

    def rates(self, _: float, y: np.ndarray) -> list[float]:
        fx, fy, torque = self.force(y)
        return [
            *y[3:], (fx + self.pull[0]) / self.mass, (fy + self.pull[1]) / self.mass,
            (torque + self.torque) / self.inertia,
        ]  # fmt: skip

    def states(self, scene: Any, times: np.ndarray) -> np.ndarray:
        """States (6, n) at ascending times."""
        launch = scene.launch
        start = [*launch.position, launch.orientation, *launch.velocity, launch.spin]
        speed = math.hypot(*launch.velocity) + self.radius * abs(launch.spin)
        found = solve_ivp(
            self.rates, (0.0, float(times[-1])), start, "DOP853", t_eval=times, rtol=1e-12,
            atol=1e-13 * speed * min(1.0, float(times[-1])),
        )  # fmt: skip
        assert found.success
        return found.y

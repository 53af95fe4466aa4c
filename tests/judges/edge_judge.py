"""A polygon over edges, judged: halves of planes cut it, scipy finds its pressure and motion.

Friction is had in polar coordinates about the instantaneous centre, by Gauss's rule along
every side in asinh of the way from where it is nearest, over its distance there; a law over the
slip speed by Gauss's rule along every ray, too; one by direction is the same all along a ray.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import root

from puck_tables._core.arrays import FloatArray


class Brushed(NamedTuple):
    """Friction along axes that are turned by an angle, and across, times that by the slip speed."""

    along: float
    across: float
    angle: float
    by_speed: Callable[[FloatArray], FloatArray] = np.ones_like

    def keeps(self, e: FloatArray) -> FloatArray:
        """What keeps elements of the load 1 slipping along e (n, 2)."""
        turn = np.array([[math.cos(self.angle), -math.sin(self.angle)],
                         [math.sin(self.angle), math.cos(self.angle)]])  # fmt: skip
        stretched = e @ turn * [self.along, self.across]
        size = np.hypot(*stretched.T)[:, None]
        kept: FloatArray = (stretched / size * [self.along, self.across]) @ turn.T
        return kept


Law = Callable[[FloatArray], FloatArray] | Brushed

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(120)
_REST = np.zeros(2)
_RAY, _SHARES = np.polynomial.legendre.leggauss(30)


def beyond(corners: FloatArray, normal: FloatArray, place: float) -> FloatArray:
    """The corners of what of a polygon has normal·x ≥ place."""
    kept = []
    gaps = corners @ normal - place
    for k in range(len(corners)):
        p, q, one, two = corners[k - 1], corners[k], gaps[k - 1], gaps[k]
        if one * two < 0.0:
            kept.append(p + one / (one - two) * (q - p))
        if two >= 0.0:
            kept.append(q)
    return np.array(kept).reshape(-1, 2)


def balance(corners: FloatArray, law: FloatArray) -> FloatArray:
    """∫ p dA and ∫ p x dA of p = law·(1, x), by triangles and the middles of their sides."""
    out = np.zeros(3)
    for k in range(1, len(corners) - 1):
        a, b, c = corners[0], corners[k], corners[k + 1]
        area = 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
        for middle in ((a + b) / 2.0, (b + c) / 2.0, (c + a) / 2.0):
            row = np.array([1.0, *middle])
            out += area / 3.0 * (law @ row) * row
    return out


def pressed(corners: FloatArray, law: FloatArray) -> FloatArray:
    """What of a polygon has p > 0."""
    return corners if not law[1:].any() else beyond(corners, law[1:], -law[0])


def pressure(
    corners: FloatArray, lever: float = 0.0, v: FloatArray = _REST, w: float = 0.0,
    grip: Law | None = None,
) -> FloatArray:  # fmt: skip
    """(a, b, c) of p = max(0, a + b x + c y) that bears a weight of 1 at the origin.

    ``lever``: the height of the centre of mass, over f where f is a number.
    """
    size = math.sqrt(abs(balance(corners, np.array([1.0, 0.0, 0.0]))[0]))
    corners, lever, w = corners / size, lever / size, w * size

    def carried(part: FloatArray, law: FloatArray, share: float) -> FloatArray:
        there = balance(part, law)
        if share > 0.0:
            there[1:] += share * friction(part, law, v, w, grip)[:2]
        return there

    law = np.zeros(3)
    for share in (0.0,) if lever == 0.0 else (0.0, 0.5 * lever, lever):

        def missed(law: FloatArray, share: float = share) -> FloatArray:
            return carried(pressed(corners, law), law, share) - np.array([1.0, 0.0, 0.0])

        def slopes(law: FloatArray, share: float = share) -> FloatArray:
            part = pressed(corners, law)
            return np.column_stack([carried(part, row, share) for row in np.eye(3)])

        if share == 0.0:
            law = np.linalg.solve(slopes(np.array([1.0, 0.0, 0.0])), [1.0, 0.0, 0.0])
        for method in ("hybr", "lm"):
            law = root(missed, law, jac=slopes, method=method, tol=1e-13).x
    assert np.abs(missed(law)).max() < 1e-10
    return law / np.array([size**2, size**3, size**3])


def _along_rays(
    far: FloatArray, there: float, slope: FloatArray, w: float, grip: Law | None
) -> tuple[FloatArray, FloatArray]:  # fmt: skip
    """∫ f p R dR and ∫ f p R² dR from the centre to the sides, over R²."""
    if isinstance(grip, Brushed):
        grip = grip.by_speed
    if grip is None:
        return there / 2.0 + slope * far / 3.0, there * far / 3.0 + slope * far * far / 4.0
    r = 0.5 * far[:, None] * (1.0 + _RAY)
    part = grip(abs(w) * r) * (there + slope[:, None] * r) * r * 0.5 * _SHARES
    return part.sum(axis=1) / far, (part * r).sum(axis=1) / far


def friction(
    part: FloatArray, law: FloatArray, v: FloatArray, w: float, grip: Law | None = None
) -> FloatArray:  # fmt: skip
    """Force and torque over N of a polygon, all pressed, that slips at v + w × x; over f N.

    ``grip``: its coefficient by the slip speed, or the direction.
    """
    if abs(w) * np.abs(part).max() < 1e-9 * np.hypot(*v):
        load = balance(part, law)
        way = v / np.hypot(*v)
        if isinstance(grip, Brushed):
            way = grip.keeps(way[None])[0] * grip.by_speed(np.hypot(*v))
        elif grip is not None:
            way = way * grip(np.hypot(*v))
        return -np.array([*(load[0] * way), load[1] * way[1] - load[2] * way[0]])
    centre = np.array([-v[1], v[0]]) / w
    sign, force, torque = math.copysign(1.0, w), np.zeros(2), 0.0
    there = law[0] + law[1:] @ centre
    p = part - centre
    for k in range(len(p)):
        a, b = p[k - 1], p[k]
        length = math.dist(a, b)
        way = (b - a) / length
        away, begin = (a[0] * way[1] - a[1] * way[0]), a @ way
        if abs(away) < 1e-12 * length:
            continue
        low, high = np.arcsinh(np.array([begin, begin + length]) / abs(away))
        y = low + 0.5 * (1.0 + _NODES) * (high - low)
        s = abs(away) * np.sinh(y)
        r = a + (s - begin)[:, None] * way
        swept = away * abs(away) * np.cosh(y) * 0.5 * (high - low) * _WEIGHTS
        far = np.hypot(*r.T)
        e = np.column_stack([-r[:, 1], r[:, 0]]) / far[:, None]
        push, turn = _along_rays(far, there, r @ law[1:] / far, w, grip)
        if isinstance(grip, Brushed):
            e = grip.keeps(e)
            turn = turn * (r[:, 0] * e[:, 1] - r[:, 1] * e[:, 0]) / far
        force += (swept * push) @ e
        torque += float(swept @ turn)
    force = sign * force
    torque = sign * torque + centre[0] * force[1] - centre[1] * force[0]
    return -np.array([*force, torque])


def left_of(corners: FloatArray, edges: list[FloatArray], state: FloatArray) -> FloatArray:
    """What edges leave of a polygon in a state x, y, angle, vx, vy, spin, about its centre."""
    c, s = math.cos(state[2]), math.sin(state[2])
    left = corners @ np.array([[c, s], [-s, c]])
    for nx, ny, place in edges:
        left = beyond(left, np.array([nx, ny]), place - nx * state[0] - ny * state[1])
    return left


def under(
    corners: FloatArray, edges: list[FloatArray], state: FloatArray, lever: float = 0.0,
    grip: Law | None = None,
) -> FloatArray:  # fmt: skip
    """Force and torque over f N on a polygon in a state; ``lever``: as of :func:`pressure`."""
    left = left_of(corners, edges, state)
    law = pressure(left, lever, state[3:5], state[5], grip)
    return friction(pressed(left, law), law, state[3:5], state[5], grip)


def slide(
    corners: FloatArray, edges: list[FloatArray], decel: float, gyration: float, state: FloatArray,
    lever: float = 0.0, grip: Law | None = None,
) -> tuple[float, FloatArray]:  # fmt: skip
    """When, and in which state, its load is 4 mm from an edge, or it is at rest.

    ``decel``: f g, or g with a ``grip``.
    """

    def rates(_: float, y: FloatArray) -> FloatArray:
        push = decel * under(corners, edges, y, lever, grip)
        return np.array([*y[3:], push[0], push[1], push[2] / gyration**2])

    def tips(_: float, y: FloatArray) -> float:
        load = y[:2] - (lever * under(corners, edges, y, lever, grip)[:2] if lever else 0.0)
        return min(nx * load[0] + ny * load[1] - place for nx, ny, place in edges) - 4e-3

    def rests(_: float, y: FloatArray) -> float:
        return math.hypot(y[3], y[4], gyration * y[5]) - 1e-4

    tips.terminal = rests.terminal = True  # type: ignore[attr-defined]
    run = solve_ivp(
        rates, (0.0, 5.0), state, method="DOP853", rtol=1e-9, atol=1e-11, max_step=4e-3,
        events=[tips, rests],
    )  # fmt: skip
    return float(run.t[-1]), run.y[:, -1]

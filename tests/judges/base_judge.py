"""Slides of bodies on any base by scipy, with friction summed by Gauss panels of its own.

A base is told by what it is made of: polygons (n, 2) and discs (x, y, r, sign), m from the centre
of mass.  Near the instantaneous centre C the boundary is cut into panels in asinh(s/|d|) along
sides and graded towards C along rims, far away the area itself is cut into triangles and rings.
The state moves in the axes of the body, in dτ = dt/Q, to Q = 1e-13 Q₀.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

_NODE, _WEIGHT = np.polynomial.legendre.leggauss(16)
_FAR = 3.0  # reaches: from there on e is smooth all over the base


class Judge:
    """Friction and slides of one base.

    ``lever``: friction times the height of the centre of mass; ``k``: radius of gyration, m.
    """

    def __init__(self, polygons: list, discs: list, lever: float, k: float) -> None:
        self.polygons = [np.array(one, float) for one in polygons]
        self.discs, self.lever, self.k = discs, lever, k
        corners = [np.hypot(*one.T).max() for one in self.polygons]
        self.reach = max(corners + [np.hypot(x, y) + r for x, y, r, _ in discs])
        self.points, self.weights = self._area()
        ones = self._one_x_y(self.points)
        self.moments = np.einsum("ni,nj,n->ij", ones, ones, self.weights)  # (1, x, y) twice

    @classmethod
    def of_puck(cls, puck: Any) -> Judge:
        """The judge of a puck that stands on a base."""
        base, middle = puck.shape, np.array(puck.shape.middle)
        discs = [(x - middle[0], y - middle[1], r, sign) for x, y, r, sign in base.discs]
        lever = 0.5 * puck.friction * puck.height
        return cls([np.array(one) - middle for one in base.outlines], discs, lever, puck.gyration)

    @staticmethod
    def _one_x_y(points: np.ndarray) -> np.ndarray:
        return np.column_stack([np.ones(len(points)), points])

    def _area(self) -> tuple[np.ndarray, np.ndarray]:
        """Points over the area and their weights: triangles from the origin, of either sign."""
        node, weight = 0.5 * (_NODE + 1.0), 0.5 * _WEIGHT
        points, weights = [], []
        for p in self.polygons:
            q = np.roll(p, -1, axis=0)
            along = p[:, None] + node[None, :, None] * (q - p)[:, None]
            cross = p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]
            points.append((along[:, :, None] * node[None, None, :, None]).reshape(-1, 2))
            both = cross[:, None, None] * weight[None, :, None] * (weight * node)[None, None, :]
            weights.append(both.ravel())
        turn = 2.0 * np.pi * np.arange(48) / 48
        circle = np.column_stack([np.cos(turn), np.sin(turn)])
        for x, y, r, sign in self.discs:
            points.append(((r * node)[:, None, None] * circle + np.array([x, y])).reshape(-1, 2))
            ring = sign * weight * node * r * r * 2.0 * np.pi / 48
            weights.append(np.repeat(ring, 48))
        return np.concatenate(points), np.concatenate(weights)

    def _panels(self, c: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Points on the boundary seen from C, and the angles dt that they stand for."""
        points, angles = [], []
        for p in self.polygons:
            for a, b in zip(p, np.roll(p, -1, axis=0), strict=True):
                t = (b - a) / np.hypot(*(b - a))
                d = (a - c)[0] * t[1] - (a - c)[1] * t[0]
                if abs(d) < 1e-15 * self.reach:
                    continue  # seen from C it has no width
                ends = np.arcsinh(np.array([(a - c) @ t, (b - c) @ t]) / abs(d))
                cuts = np.linspace(*ends, 2 + int((ends[1] - ends[0]) / 1.5))
                half = 0.5 * np.diff(cuts)[:, None]
                y = (cuts[:-1, None] + half + half * _NODE).ravel()
                foot = c + d * np.array([t[1], -t[0]])
                points.append(foot + abs(d) * np.sinh(y)[:, None] * t)
                angles.append((half * _WEIGHT).ravel() * np.sign(d) / np.cosh(y))
        for x, y, r, sign in self.discs:
            off = np.array([x, y]) - c
            gap = abs(r - np.hypot(*off)) / r
            grades = np.pi * 0.5 ** np.arange(np.clip(np.ceil(4.0 - np.log2(gap + 1e-15)), 4, 45))
            cuts = np.concatenate([-grades, [0.0], grades[::-1]])
            half = 0.5 * np.diff(cuts)[:, None]
            turn, width = (cuts[:-1, None] + half + half * _NODE).ravel(), (half * _WEIGHT).ravel()
            nearest = np.arctan2(-off[1], -off[0])
            out = np.column_stack([np.cos(nearest + turn), np.sin(nearest + turn)])
            place = off + r * out
            points.append(c + place)
            # (place x tangent)/R^2 ds, its small difference next to C without cancellation
            gap = r - np.hypot(*off)
            across = r * gap + 2.0 * r * np.hypot(*off) * np.sin(0.5 * turn) ** 2
            square = gap * gap + 4.0 * r * np.hypot(*off) * np.sin(0.5 * turn) ** 2
            angles.append(sign * width * across / np.maximum(square, 1e-300))
        return np.concatenate(points), np.concatenate(angles)

    def sums(self, ux: float, uy: float, w: float) -> tuple[np.ndarray, np.ndarray]:
        """∫ e (1, x, y) (2, 3) and ∫ (x × e) (1, x, y) (3,) over the base."""
        if np.hypot(ux, uy) > _FAR * self.reach * abs(w):
            x, y = self.points.T
            e = np.column_stack([ux - w * y, uy + w * x])
            speed = np.hypot(*e.T)
            e *= (self.friction_at(speed) / speed)[:, None]
            ones = self._one_x_y(self.points) * self.weights[:, None]
            return e.T @ ones, (x * e[:, 1] - y * e[:, 0]) @ ones
        c = np.array([-uy, ux]) / w
        place, angle = self._panels(c)
        ray = place - c
        far = np.hypot(*ray.T)
        ray = ray / np.maximum(far, 1e-300)[:, None]
        e = np.sign(w) * np.column_stack([-ray[:, 1], ray[:, 0]])
        lever = c[0] * e[:, 1] - c[1] * e[:, 0]
        powers = self.along_rays(far, abs(w))
        first, second = (  # the integral of R and of R² times (1, x, y) along a ray
            np.column_stack([one, one[:, None] * c + more[:, None] * ray])
            for one, more in pairwise(powers)
        )
        turn = lever[:, None] * first + np.sign(w) * second
        return (e * angle[:, None]).T @ first, angle @ turn

    def friction_at(self, speed: np.ndarray) -> np.ndarray:
        """Friction at slip speeds, over f."""
        return np.ones_like(speed)

    def along_rays(self, far: np.ndarray, w: float) -> list[np.ndarray]:
        """∫ friction R^n dR along rays so long from the instantaneous centre, n = 1, 2, 3."""
        return [far ** (n + 1) / (n + 1) for n in (1, 2, 3)]

    def friction(self, ux: float, uy: float, w: float) -> tuple[np.ndarray, float]:
        """Force and torque over f N, in the axes of the body."""
        force, torque = self.sums(ux, uy, w)
        balance = self.moments.copy()
        balance[1:] -= self.lever * force  # moment of friction at the height of the centre
        pressure = np.linalg.solve(balance, [1.0, 0.0, 0.0])
        return -force @ pressure, float(-torque @ pressure)

    def slide(
        self, velocity: tuple[float, float], spin: float, decel: float, rtol: float = 1e-12
    ) -> np.ndarray:
        """Stop time, x, y, path length, and the angle of the body: (5,)."""
        found, q0 = self._followed(velocity, spin, decel, rtol)
        angle, time, x, y, length = found.y[3:, -1]
        return np.array([
            time * q0 / decel, *(np.array([x, y, length]) * q0 * q0 / decel),
            angle * q0 * q0 / (decel * self.k),
        ])  # fmt: skip

    def states(
        self, velocity: tuple[float, float], spin: float, decel: float, times: np.ndarray
    ) -> np.ndarray:
        """X, y, angle of the body, vx, vy, spin at moments before the stop: (6, n)."""
        found, q0 = self._followed(velocity, spin, decel, 1e-12)
        rows = []
        for time in times * decel / q0:
            i = int(np.searchsorted(found.t, found.t[found.y[4] <= time][-1], "right"))
            span = found.t[i - 1], found.t[i]
            at = brentq(lambda tau: found.sol(tau)[4] - time, *span, xtol=1e-15)  # noqa: B023
            ux, uy, s, angle, _, x, y, _ = found.sol(at)
            angle *= q0 * q0 / (decel * self.k)
            c, sn = np.cos(angle), np.sin(angle)
            v, place = q0 * np.array([c * ux - sn * uy, sn * ux + c * uy]), np.array([x, y])
            rows.append([*(place * q0 * q0 / decel), angle, *v, q0 * s / self.k])
        return np.array(rows).T

    def _followed(
        self, velocity: tuple[float, float], spin: float, decel: float, rtol: float
    ) -> tuple[Any, float]:
        """What scipy makes of a slide, and Q at its start."""
        k = self.k
        q0 = float(np.hypot(np.hypot(*velocity), k * spin))
        turning = q0 * q0 / (decel * k)

        def rates(_: float, z: np.ndarray) -> np.ndarray:
            u, s, angle = z[:2], z[2], z[3]
            q = np.hypot(np.hypot(*u), s)
            force, torque = self.friction(u[0], u[1], s / k)
            swirl = turning * s * q
            c, sn = np.cos(turning * angle), np.sin(turning * angle)
            return np.array([
                q * force[0] + swirl * u[1], q * force[1] - swirl * u[0], q * torque / k, q * s,
                q, q * (c * u[0] - sn * u[1]), q * (sn * u[0] + c * u[1]), q * np.hypot(*u),
            ])  # fmt: skip

        def over(_: float, z: np.ndarray) -> float:
            return float(np.log(np.hypot(np.hypot(*z[:2]), z[2]) / 1e-13))

        over.terminal = True  # type: ignore[attr-defined]
        start = np.array([*np.array(velocity) / q0, k * spin / q0, *np.zeros(5)])
        found = solve_ivp(
            rates, (0.0, 2000.0), start, "DOP853", rtol=rtol, atol=1e-14, events=over, max_step=1.0,
            dense_output=True,
        )  # fmt: skip
        assert found.status == 1, found.message
        return found, q0

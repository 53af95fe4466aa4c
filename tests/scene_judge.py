"""A scene integrated by scipy with friction by direct quadrature: the judge of the scene engine.

It reads the same tables and shares nothing else: friction from the quadrature of the patch,
constraints by solving Newton's law and A V′ + A′ V = 0 together.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from puck_tables.contact.closed_form import moment_balance
from puck_tables.contact.integrals import slip_direction
from puck_tables.contact.quadrature import integrals


class Judge:
    """State: x, y, θ, vx, vy, ω."""

    def __init__(self, scene: dict[str, Any]) -> None:
        puck, floor, launch = scene["puck"], scene.get("floor", {}), scene["launch"]
        self.m, self.r = puck.get("mass", 1.0), puck["radius"]
        self.inertia = self.m * (puck.get("gyration", math.sqrt(0.5)) * self.r) ** 2
        self.f, g = puck.get("friction", 0.0), puck.get("gravity", 9.80665)
        self.delta = 2.0 * self.f * puck.get("height", 0.0) / self.r
        slope, down = floor.get("slope", 0.0), floor.get("downhill", 0.0)
        self.load = self.f * self.m * g * math.cos(slope)
        force = scene.get("force", {})
        self.pull = np.array([*force.get("constant", (0.0, 0.0)), force.get("torque", 0.0)])
        self.pull[:2] += self.m * g * math.sin(slope) * np.array([math.cos(down), math.sin(down)])
        self.belt = np.array(floor.get("velocity", (0.0, 0.0)))
        self.centre = np.array(floor.get("centre", (0.0, 0.0)))
        self.turning = floor.get("turning", 0.0)
        drag = scene.get("drag", {})
        self.drag = np.array([drag.get("sliding", 0.0)] * 2 + [drag.get("spinning", 0.0)])
        self.drive = (
            np.loadtxt(force["over_time"], delimiter=",") if force.get("over_time") else None
        )
        self.hold = scene.get("constraint")
        self.start = np.array([
            *launch.get("position", (0.0, 0.0)), launch.get("orientation", 0.0),
            *launch.get("velocity", (0.0, 0.0)), launch.get("spin", 0.0),
        ])  # fmt: skip
        if self.hold and self.hold["kind"] == "pivot":
            angle = self.start[2] + self.hold.get("angle", 0.0)
            arm = self.hold["reach"] * np.array([math.sin(angle), -math.cos(angle)])
            self.start[3:5] = np.array(self.hold.get("velocity", (0.0, 0.0))) + self.start[5] * arm

    def friction(self, u: np.ndarray, w: float) -> np.ndarray:
        """Force and torque at a velocity and a spin relative to the floor."""
        v, rim = math.hypot(*u), self.r * w
        q = math.hypot(v, rim)
        if q == 0.0 or self.load == 0.0:
            return np.zeros(3)
        phi = math.atan2(rim, v)
        rho = moment_balance(integrals(abs(phi)), slip_direction(abs(phi)), self.delta)
        ahead = u / v if v > 0.0 else np.array([1.0, 0.0])
        left = np.array([-ahead[1], ahead[0]])
        cosine, sine = math.cos(phi), math.sin(phi)
        push = -cosine * rho.parallel * ahead - sine * cosine * rho.perpendicular * left
        return self.load * np.array([*push, -0.5 * self.r * sine * rho.spin])

    def floor(self, place: np.ndarray) -> np.ndarray:
        arm = place - self.centre
        return np.array([*(self.belt + self.turning * np.array([-arm[1], arm[0]])), self.turning])

    def row(self, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Rows A of the constraint A V = e, and A′ V."""
        kind, angle = self.hold["kind"], self.hold.get("angle", 0.0)
        if kind == "rail":
            return np.array([[-math.sin(angle), math.cos(angle), 0.0]]), np.zeros(1)
        c, s, (vx, vy, w) = math.cos(y[2] + angle), math.sin(y[2] + angle), y[3:]
        if kind == "blade":  # over the floor, whose velocity there changes by Ω × v
            n, (sx, sy, _) = np.array([-s, c]), self.floor(y[:2])
            change = n @ (self.turning * np.array([-vy, vx]))
            drift = -w * (c * (vx - sx) + s * (vy - sy)) - change
            return np.array([[-s, c, 0.0]]), np.array([drift])
        arm = self.hold["reach"]
        return (
            np.array([[1.0, 0.0, -arm * s], [0.0, 1.0, arm * c]]),
            -arm * w * w * np.array([c, s]),
        )

    def rates(self, t: float, y: np.ndarray, piece: tuple[np.ndarray, np.ndarray] | None):
        relative = y[3:] - self.floor(y[:2])
        force = self.pull + self.friction(relative[:2], relative[2]) - self.drag * relative
        if piece is not None:
            before, after = piece
            share = (t - before[0]) / (after[0] - before[0])
            force = force + before[1:] + share * (after - before)[1:]
        mass = np.diag([self.m, self.m, self.inertia])
        if not self.hold:
            return [*y[3:], *np.linalg.solve(mass, force)]
        a, drift = self.row(y)
        none = np.zeros((len(a), len(a)))
        whole = np.block([[mass, -a.T], [a, none]])
        return [*y[3:], *np.linalg.solve(whole, [*force, *-drift])[:3]]

    def states(self, times: np.ndarray) -> np.ndarray:
        """States (6, n) at ascending times > 0, with a new start at every corner of the force."""
        knots = [] if self.drive is None else [t for t in self.drive[:, 0] if 0 < t < times[-1]]
        ends, y, found = [0.0, *knots, float(times[-1])], self.start, []
        for low, high in pairwise(ends):
            piece, middle = None, 0.5 * (low + high)
            if self.drive is not None and self.drive[0, 0] < middle < self.drive[-1, 0]:
                i = int(np.searchsorted(self.drive[:, 0], middle))
                piece = self.drive[i - 1], self.drive[i]
            wanted = times[(times > low) & (times <= high)]
            solution = solve_ivp(
                self.rates, (low, high), y, "DOP853", t_eval=[*wanted[wanted < high], high],
                rtol=1e-12, atol=1e-13, args=(piece,),
            )  # fmt: skip
            assert solution.success
            y = solution.y[:, -1]
            found.append(solution.y[:, : len(wanted)])
        return np.hstack(found)

"""Skate blades on turntables and belts, under forces and torques, by scipy in the blade's own axes.

With e along the blade, n to its left, s the floor's velocity under the centre, Ω its spin, the puck
goes at v = p e + σ n + s (σ the side slip), and spins at w over the floor.  The blade takes what is
across it, so that along it and about the centre

    p′ = F·e/m + σ (w + Ω) − Ω (k×v)·e,    w′ = T/I,

friction among F and T.  Steps are in dt/Q, Q the slip: none is next to nothing.  At rest the floor
holds while what it must give lies within the curve of what it has in a slip along the blade.

The allowed error of the end and of the last stop is tol times the measured amplification.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
from contact_truth import tabled, tabled_friction
from report import engine
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

NUDGE = 1e-7
_SLOW = 1e-9  # of the scale of slips: from there it stops on a straight line
_EARLY = 1e-7  # of it: a slip that has begun
X, Y, TURN, P, W, TIME = range(6)
STEPS = 20_000


def draw(seed: int, index: int) -> dict[str, Any]:
    """A scene; ``class``: what acts."""
    rng = np.random.default_rng([seed, index, 17])
    radius, mass = float(10.0 ** rng.uniform(-2.0, -0.5)), float(10.0 ** rng.uniform(-1.0, 0.5))
    friction, delta = float(rng.choice([0.1, 0.3])), float(rng.choice([0.0, 0.5, 1.0]))
    speed, weight = float(10.0 ** rng.uniform(-0.7, 0.5)), 9.80665 * mass
    unit = speed / (friction * 9.80665)
    scene: dict[str, Any] = {
        "puck": {
            "radius": radius, "mass": mass, "height": delta * radius / (2.0 * friction),
            "gyration": float(rng.choice([0.4, 0.7, 1.0])), "friction": friction,
        },
        "floor": {
            "turning": float(rng.choice([-1.0, 1.0]) * rng.uniform(0.1, 1.5) / unit),
            "centre": (0.3 * speed * unit * rng.normal(size=2)).tolist(),
        },
        "launch": {
            "spin": float(rng.choice([0.0, 1.0, -4.0])) * speed / radius,
            "orientation": float(rng.uniform(-math.pi, math.pi)),
        },
        "constraint": {"kind": "blade", "angle": float(rng.uniform(-math.pi, math.pi))},
        "force": {
            "constant": (friction * weight * rng.choice([0.2, 0.6]) * rng.normal(size=2)).tolist(),
            "torque": float(rng.choice([0.0, 0.2]) * friction * weight * radius * rng.normal()),
        },
        "time": 4.0 * unit, "frames": 1,
    }  # fmt: skip
    acts = ["force"]
    if index % 3 == 1:
        rows = np.zeros((4, 4))
        rows[:, 0] = unit * np.array([-0.5, 0.8, 2.0, 5.0])
        rows[:, 1:] = 0.7 * friction * weight * rng.normal(size=(4, 3)) * [1.0, 1.0, 0.3 * radius]
        scene["drive"] = rows.tolist()
        acts.append("over time")
    if index % 4 == 2:
        scene["floor"]["velocity"] = (0.5 * speed * rng.normal(size=2)).tolist()
        acts.append("belt")
    if index % 5 == 3:
        scene["constraint"]["side_slip"] = float(0.1 * speed * rng.normal())
        acts.append("side slip")
    skate = Skate(scene | {"launch": scene["launch"] | {"velocity": (0.0, 0.0)}})
    skate.launch[P] = speed * rng.normal()
    scene["launch"]["velocity"] = skate.velocity(skate.launch).tolist()
    return scene | {"class": " + ".join(acts)}


class Skate:
    """What acts on it, and the motion; ``change`` (6,): of launch p and w, and of the forces."""

    def __init__(
        self, scene: dict[str, Any], change: np.ndarray | None = None, close: float = 1e-12
    ) -> None:
        change = np.zeros(6) if change is None else change
        puck, floor, launch = scene["puck"], scene["floor"], scene["launch"]
        self.m, self.r, self.close = puck["mass"], puck["radius"], close
        self.inertia = self.m * (puck["gyration"] * self.r) ** 2
        self.load = puck["friction"] * self.m * 9.80665
        self.ends, self.series = tabled(
            "uniform", round(2.0 * puck["friction"] * puck["height"] / self.r, 13)
        )
        self.turning, self.centre = floor["turning"], np.array(floor["centre"])
        self.belt = np.array(floor.get("velocity", (0.0, 0.0)))
        self.pull = np.array([*scene["force"]["constant"], scene["force"]["torque"]])
        self.drive = np.array(scene.get("drive", np.zeros((0, 4))))
        self.pull, self.grown = self.pull * (1.0 + change[2:5]), 1.0 + change[5]
        self.sigma = scene["constraint"].get("side_slip", 0.0)
        self.angle = scene["constraint"]["angle"]
        z = np.array([0.0, 0.0, launch["orientation"], 0.0, launch["spin"] - self.turning, 0.0])
        e, _ = self.axes(z)
        z[P] = (np.array(launch["velocity"]) - self.ground(z)) @ e
        self.launch = z * np.array([1.0, 1.0, 1.0, 1.0 + change[0], 1.0 + change[1], 1.0])
        self.until = scene["time"]
        self.speed, self.rate = self.slip(z), self.load / self.m

    def axes(self, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        c, s = math.cos(z[TURN] + self.angle), math.sin(z[TURN] + self.angle)
        return np.array([c, s]), np.array([-s, c])

    def ground(self, z: np.ndarray) -> np.ndarray:
        dx, dy = z[X] - self.centre[0], z[Y] - self.centre[1]
        return self.belt + self.turning * np.array([-dy, dx])

    def velocity(self, z: np.ndarray) -> np.ndarray:
        e, n = self.axes(z)
        return z[P] * e + self.sigma * n + self.ground(z)

    def slip(self, z: np.ndarray) -> float:
        return math.sqrt(z[P] ** 2 + self.sigma**2 + (self.r * z[W]) ** 2)

    def friction(self, p: float, rim: float) -> tuple[float, float]:
        """Along the blade, and torque over r, N."""
        out = np.empty(3)
        tabled_friction(self.ends, self.series, len(self.series), p, self.sigma, rim, out)
        return self.load * out[0], self.load * out[2]

    def driven(self, z: np.ndarray) -> tuple[float, float]:
        """What all but friction does along the blade, N, and about the centre, over r."""
        pull, (e, _) = self.pull.copy(), self.axes(z)
        if len(self.drive):
            for i in range(3):
                pull[i] += self.grown * np.interp(z[TIME], self.drive[:, 0], self.drive[:, 1 + i])
        v = self.velocity(z)
        turned = self.turning * (e[0] * v[1] - e[1] * v[0])
        spin = z[W] + self.turning
        return float(pull[:2] @ e + self.m * (self.sigma * spin + turned)), pull[2] / self.r

    def gains(self, z: np.ndarray, p: float, rim: float) -> tuple[float, float]:
        """p′ and r w′ in a slip."""
        (along, about), (pull, twist) = self.friction(p, rim), self.driven(z)
        return (pull + along) / self.m, self.r**2 * (twist + about) / self.inertia

    def rates(self, z: np.ndarray) -> np.ndarray:
        up, turn = self.gains(z, z[P], self.r * z[W])
        return np.array([*self.velocity(z), z[W] + self.turning, up, turn / self.r, 1.0])

    def slides(self, z: np.ndarray, until: float) -> tuple[np.ndarray, bool]:
        """To a moment or to rest; which."""

        def over(_: float, y: np.ndarray) -> np.ndarray:
            return self.rates(y) * self.slip(y)

        def late(_: float, y: np.ndarray) -> float:
            return float(y[TIME] - until)

        def rests(_: float, y: np.ndarray) -> float:
            return self.slip(y) - _SLOW * self.speed

        late.terminal = rests.terminal = True  # type: ignore[attr-defined]
        rests.direction = -1.0  # type: ignore[attr-defined]
        run = solve_ivp(
            over, (0.0, 1e30), z, "LSODA", events=[late, rests], rtol=self.close,
            atol=1e-3 * self.close * np.array([*[self.speed] * 4, self.speed / self.r, 1.0]),
        )  # fmt: skip
        if run.status != 1:
            raise ValueError(run.message)
        for state in run.y.T:
            up, turn = self.gains(state, state[P], self.r * state[W])
            self.speed = max(self.speed, self.slip(state))
            self.rate = max(self.rate, math.hypot(up, turn))
        z = run.y[:, -1]
        if len(run.t_events[1]) == 0:
            return z + (until - z[TIME]) * self.rates(z), False
        up, turn = self.gains(z, z[P], self.r * z[W])
        wait = self.slip(z) ** 2 / -(z[P] * up + self.r * z[W] * turn)
        z = z + wait * self.rates(z)
        z[P] = z[W] = 0.0
        return z, True

    def carried(self, z: np.ndarray, t: float) -> np.ndarray:
        """At rest on the floor from z on."""
        angle = self.turning * (t - z[TIME])
        pole = self.centre + np.array([-self.belt[1], self.belt[0]]) / self.turning
        c, s = math.cos(angle), math.sin(angle)
        arm = z[:2] - pole
        place = pole + np.array([c * arm[0] - s * arm[1], s * arm[0] + c * arm[1]])
        return np.array([*place, z[TURN] + angle, 0.0, 0.0, t])

    def excess(self, z: np.ndarray) -> float:
        """By how much more, as a share, it would take to hold than the floor has."""
        need = -np.array(self.driven(z))
        if not need.any():
            return -1.0

        def aside(phi: float) -> float:
            have = self.friction(math.cos(phi), math.sin(phi))
            return float(have[0] * need[1] - have[1] * need[0])

        # what friction has turns about the origin once, as the slip does, against it
        middle = math.atan2(-need[1], -need[0])
        low = brentq(aside, middle - 0.5 * math.pi, middle + 0.5 * math.pi, xtol=1e-15)
        return float(np.hypot(*need) / np.hypot(*self.friction(math.cos(low), math.sin(low)))) - 1.0

    def grows(self, z: np.ndarray) -> tuple[float, float]:
        """The direction of a slip of no size that keeps it, and the rate at which it grows."""

        def aside(phi: float) -> float:
            up, turn = self.gains(z, math.cos(phi), math.sin(phi))
            return up * math.sin(phi) - turn * math.cos(phi)

        best, growth = 0.0, -math.inf
        grid = np.linspace(-math.pi, math.pi, 200) + 1e-3
        values = np.sign([aside(phi) for phi in grid])
        for i in np.flatnonzero(values[:-1] != values[1:]):
            phi = brentq(aside, grid[i], grid[i + 1], xtol=1e-15)
            up, turn = self.gains(z, math.cos(phi), math.sin(phi))
            if up * math.cos(phi) + turn * math.sin(phi) > growth:
                best, growth = phi, up * math.cos(phi) + turn * math.sin(phi)
        return best, growth

    def begins(self, z: np.ndarray) -> np.ndarray:
        """When a slip that begins at z is still next to nothing: it keeps to its direction."""
        wait, size = 1e-5 * self.speed / self.rate, 0.0
        while size <= _EARLY * self.speed:
            wait, size = 2.0 * wait, 0.0
            for place, weight in zip(*np.polynomial.legendre.leggauss(6), strict=True):
                then = self.carried(z, z[TIME] + 0.5 * wait * (1.0 + place))
                size += 0.5 * wait * weight * self.grows(then)[1]
        late = self.carried(z, z[TIME] + wait)
        phi, _ = self.grows(late)
        late[P], late[W] = size * math.cos(phi), size * math.sin(phi) / self.r
        e, _ = self.axes(late)
        late[:2] += wait / 3.0 * late[P] * e  # for it grows like the square of the time
        late[TURN] += wait / 3.0 * late[W]
        return late

    def follow(self) -> tuple[np.ndarray, list[float]]:
        """The end, and when it came to rest on the way."""
        z, stops, rests = self.launch.copy(), [], False
        for until in [*(t for t in self.drive[:, 0] if 0.0 < t < self.until), self.until]:
            while z[TIME] < until:
                if not rests:
                    z, rests = self.slides(z, until)
                    if rests:
                        stops.append(float(z[TIME]))
                    continue
                times = np.linspace(z[TIME], until, 1000)
                loose = [self.excess(self.carried(z, t)) for t in times]
                above = np.flatnonzero(np.array(loose) > 0.0)
                if not len(above):
                    z = self.carried(z, until)
                    continue
                when, first = times[above[0]], above[0]
                if first > 0:
                    when = brentq(
                        lambda t, z=z: self.excess(self.carried(z, t)), times[first - 1], when,
                        xtol=1e-15,
                    )  # fmt: skip
                z, rests = self.begins(self.carried(z, when)), False
        return z, stops


def truth(
    scene: dict[str, Any], change: np.ndarray | None = None, close: float = 1e-12
) -> dict[str, Any]:
    """The end (6,) in the laboratory, the stops, and the scales of slip and acceleration."""
    skate = Skate(scene, change, close)
    z, stops = skate.follow()
    end = np.array([*z[:3], *skate.velocity(z), z[W] + skate.turning])
    return {"end": end, "stops": stops, "speed": skate.speed, "rate": skate.rate}


def known(scene: dict[str, Any]) -> dict[str, Any]:
    """Truth, how well it is known, and how it amplifies."""
    best, rng = truth(scene), np.random.default_rng(3)
    unit, r = best["speed"] / best["rate"], scene["puck"]["radius"]
    length = best["speed"] * unit
    best["scale"] = np.array(
        [length] * 2 + [length / r] + [best["speed"]] * 2 + [length / unit / r]
    )
    best["unit"] = unit

    def apart(other: dict[str, Any]) -> float:
        gap = float(np.max(np.abs(other["end"] - best["end"]) / best["scale"]))
        if len(other["stops"]) != len(best["stops"]):
            return math.inf
        late = np.abs(np.subtract(other["stops"], best["stops"]))
        return max(gap, float(np.max(late, initial=0.0)) / unit)

    best["doubt"] = apart(truth(scene, close=1e-11))
    changes = [NUDGE * rng.choice([-1.0, 1.0], 6) for _ in range(2)]
    best["amplification"] = max(1.0, *(apart(truth(scene, way)) / NUDGE for way in changes))
    return best


def judged(
    scene: dict[str, Any], best: dict[str, Any], tol: float, folder: Path
) -> tuple[str, float, str, int]:
    """A word, error over what is allowed, why, and how many steps the engine took."""
    run, words = engine(scene, tol, folder)
    if run is None:
        return "refused", math.inf, words, 10**6
    found = [run.last[name] for name in ("x", "y", "orientation", "vx", "vy", "spin")]
    allowed = tol * best["amplification"] + 10.0 * best["doubt"]
    share = float(np.max(np.abs(found - best["end"]) / best["scale"])) / allowed
    stops = [event.time for event in run.events if event.what == "stick"]
    if best["stops"]:
        off = abs(stops[-1] - best["stops"][-1]) if stops else math.inf
        share = max(share, off / best["unit"] / allowed)
    why = f"amplification {best['amplification']:.3g}, doubt {best['doubt']:.1g}, {run.steps} steps"
    return ("right" if share <= 1.0 else "wrong"), share, why, run.steps

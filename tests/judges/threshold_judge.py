"""Stick and slip next to the limit of friction: coming to rest below it, leaving rest above it.

A force and a torque of a share of what friction has in the slip n.  'stops': constant, share < 1,
from a small slip in another direction.  'starts': constant, share > 1, from rest: uniformly
accelerated along the slip that keeps its direction, in closed form.  'peak': straight up to share
> 1 and down again: slips when the share is 1, rests later (in closed form next to 1).  Elsewhere
by Radau in Cartesian velocities.

The allowed error is tol of the motion's own time and length over |share − 1|, by which a change of
the force is amplified.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
from contact_truth import tabled, tabled_friction
from report import engine
from scipy.integrate import solve_ivp
from scipy.optimize import fsolve

BELOW = (0.9, 0.99, 0.999, 0.9999, 0.99999, 0.999999)
ABOVE = (1.000001, 1.00001, 1.0001, 1.001, 1.01, 1.1)
KINDS = ("stops", "starts", "peak")


class Slider:
    """Accelerations (ax, ay, r ω′) of a puck that slips at n, by friction alone, and by a pull."""

    def __init__(self, scene: dict[str, Any]) -> None:
        puck, self.f = scene["puck"], scene["puck"]["friction"]
        self.m, self.r = puck["mass"], puck["radius"]
        self.inertia = self.m * (puck["gyration"] * self.r) ** 2
        self.ends, self.series = tabled("uniform", round(2 * self.f * puck["height"] / self.r, 13))
        self.load = self.f * self.m * 9.80665
        self.over = np.array([1 / self.m, 1 / self.m, self.r * self.r / self.inertia])
        self.out = np.empty(3)

    def friction(self, n: np.ndarray) -> np.ndarray:
        """Force and torque over r, N."""
        tabled_friction(self.ends, self.series, len(self.series), n[0], n[1], n[2], self.out)
        return self.load * self.out

    def steady(self, pull: np.ndarray, guess: np.ndarray) -> tuple[np.ndarray, float]:
        """The slip that keeps its direction under a pull (Fx, Fy, torque/r), and its rate."""

        def misfit(z: np.ndarray) -> np.ndarray:
            size = math.sqrt(z[0] ** 2 + z[1] ** 2 + z[2] ** 2)
            n = z[:3] / size
            return np.array([
                *((self.over * (pull + self.friction(n)) - z[3] * self.rate * n) / self.rate),
                size - 1.0,
            ])  # fmt: skip

        self.rate = self.load / self.m
        n, gain = guess, float(guess @ (self.over * (pull + self.friction(guess)))) / self.rate
        z, _, _, words = fsolve(misfit, [*n, gain], xtol=1e-15, full_output=True)
        if np.max(np.abs(misfit(z))) > 1e-11:
            raise ValueError(words)
        return z[:3] / np.linalg.norm(z[:3]), float(z[3] * self.rate)


def draw(seed: int, index: int) -> dict[str, Any]:
    """A scene; ``class`` and what the judge needs to know under ``limit``."""
    rng = np.random.default_rng([seed, index, 13])
    kind = KINDS[index % 3]
    share = float((BELOW if kind == "stops" else ABOVE)[index // 3 % 6])
    if kind == "peak":  # a slip shows from 1e-11 of the scale of speeds on
        share = max(share, 1.0001)
    radius, mass = float(10.0 ** rng.uniform(-2.0, -1.0)), float(10.0 ** rng.uniform(-1.0, 0.5))
    friction, delta = float(rng.choice([0.1, 0.3])), float(rng.choice([0.0, 0.5, 1.0, 2.0, 3.0]))
    puck = {
        "radius": radius, "mass": mass, "height": delta * radius / (2.0 * friction),
        "gyration": float(rng.choice([0.5, math.sqrt(0.5), 1.0])), "friction": friction,
    }  # fmt: skip
    scene: dict[str, Any] = {"class": kind, "puck": puck}
    slider = Slider(scene)
    phi, psi = float(rng.choice([0.0, 0.3, 0.7, 0.9, 1.3])), rng.uniform(-math.pi, math.pi)
    n = np.array([math.cos(phi) * math.cos(psi), math.cos(phi) * math.sin(psi), math.sin(phi)])
    limit = -slider.friction(n)
    span = float(10.0 ** rng.uniform(-1.0, 0.5))
    scene["limit"] = {"share": share, "n": n.tolist(), "pull": limit.tolist(), "span": span}
    if kind == "peak":
        rows = np.zeros((3, 4))
        rows[:, 0] = 0.0, span, 2.0 * span
        rows[1, 1:] = share * limit * [1.0, 1.0, radius]
        scene["drive"] = rows.tolist()
        scene["launch"] = {}
        scene |= {"time": 2.0 * span, "frames": 1}
        return scene
    pull = share * limit
    scene["force"] = {"constant": pull[:2].tolist(), "torque": float(pull[2] * radius)}
    if kind == "starts":
        scene["launch"] = {}
        scene |= {"time": span, "frames": 1}
        return scene
    size = abs(1.0 - share) * friction * 9.80665 * span
    slip = n + 0.5 * rng.normal(size=3)
    slip *= size / np.linalg.norm(slip)
    scene["launch"] = {"velocity": slip[:2].tolist(), "spin": float(slip[2] / radius)}
    scene |= {"time": 20.0 * span, "frames": 1}
    return scene


def _pull(scene: dict[str, Any], t: float) -> np.ndarray:
    """The pull at a time since the launch, of a peak since the share was 1."""
    limit = scene["limit"]
    share, span = limit["share"], limit["span"]
    if scene["class"] == "peak":
        top = _top(scene)
        share = 1.0 + share * t / span if t <= top else max(share - share * (t - top) / span, 0.0)
    return share * np.array(limit["pull"])


def _top(scene: dict[str, Any]) -> float:
    """When a peak is reached, since its share was 1."""
    share = scene["limit"]["share"]
    return float(scene["limit"]["span"] * (share - 1.0) / share)


def closeness(scene: dict[str, Any]) -> float:
    """Tolerance above the rounding of the force that is left, and far below what is allowed."""
    return max(1e-10, 1e-14 / abs(scene["limit"]["share"] - 1.0))


def cartesian(
    scene: dict[str, Any], slider: Slider, t: float, z: np.ndarray, u: np.ndarray, size: float,
    until: float,
) -> tuple[float, np.ndarray]:  # fmt: skip
    """When the slip ends, and the way (x, y, r θ), by Radau; kinks of the force end a piece."""

    def rates(t: float, y: np.ndarray) -> np.ndarray:
        slip = np.linalg.norm(y[3:])
        n = y[3:] / slip if slip > 0.0 else y[3:]
        return np.array([*y[3:], *(slider.over * (_pull(scene, t) + slider.friction(n)) / size)])

    def ends(t: float, y: np.ndarray) -> float:
        return float(np.linalg.norm(y[3:]) - 1e-9)

    ends.terminal, ends.direction = True, -1.0  # type: ignore[attr-defined]
    y = np.array([*(z / size), *(u / size)])
    close = closeness(scene)
    kinks = [_top(scene)] if scene["class"] == "peak" else []
    for stop in [k for k in kinks if k > t] + [until]:
        # no rate depends on the place: scipy's differences by it take ever longer steps
        with np.errstate(over="ignore"):
            run = solve_ivp(
                rates, (t, stop), y, "Radau", events=ends, rtol=close, atol=1e-2 * close
            )
        if not run.success:
            raise ValueError(run.message)
        t, y = float(run.t[-1]), run.y[:, -1]
        if run.status == 1:
            slip = y[3:]
            toward = -float(slip @ rates(t, y)[3:]) / 1e-9
            wait = 1e-9 / toward
            return t + wait, size * (y[:3] + 0.5 * wait * slip)
    return math.inf, size * y[:3]


def truth(scene: dict[str, Any]) -> dict[str, Any]:
    """``rests``, ``slips`` (s, or None), ``way`` (x, y, θ), the motion's time and length."""
    slider, limit = Slider(scene), scene["limit"]
    share, span, n = limit["share"], limit["span"], np.array(limit["n"])
    kind, turn = scene["class"], np.array([1.0, 1.0, 1.0 / scene["puck"]["radius"]])
    if kind == "starts":
        n, gain = slider.steady(_pull(scene, 0.0), n)
        way = 0.5 * gain * span**2 * n
        return {
            "stick": None, "slip": 0.0, "way": way * turn, "time": span,
            "length": 0.5 * gain * span**2,
        }  # fmt: skip
    if kind == "stops":
        launch = scene["launch"]
        u = np.array([*launch["velocity"], launch["spin"] * scene["puck"]["radius"]])
        size = float(np.linalg.norm(u))
        rests, way = cartesian(scene, slider, 0.0, np.zeros(3), u, size, scene["time"])
        return {
            "stick": rests, "slip": None, "way": way * turn, "time": rests,
            "length": size * rests,
        }  # fmt: skip
    if share <= 1.00002:
        # the growth of the slip is straight over time, up and down, but for a share of share − 1
        top = _top(scene)
        n, gain = slider.steady(_pull(scene, top), n)
        pace, after = gain / top, (1.0 + math.sqrt(2.0)) * top
        way = pace * (
            top**3 / 6.0 + top * top * after / 2.0 + top * after**2 / 2.0 - after**3 / 6.0
        )
        return {
            "stick": span / share + top + after, "slip": span / share, "way": way * n * turn,
            "time": top + after, "length": way, "doubt": 3.0 * (share - 1.0),
        }  # fmt: skip
    # the slip begins along the one that keeps its direction, for its size is next to nothing
    wait = 1e-3 * _top(scene)
    speed = 0.0
    for place, weight in zip(*np.polynomial.legendre.leggauss(4), strict=True):
        _, gain = slider.steady(_pull(scene, 0.5 * wait * (1.0 + place)), n)
        speed += 0.5 * wait * weight * gain
    n, _ = slider.steady(_pull(scene, wait), n)
    size = (share - 1.0) ** 2 * slider.load / slider.m * span
    u, z = speed * n, speed * wait / 3.0 * n
    lasts, way = cartesian(scene, slider, wait, z, u, size, 2.0 * span)
    return {
        "stick": span / share + lasts, "slip": span / share, "way": way * turn, "time": lasts,
        "length": size * lasts,
    }  # fmt: skip


def judged(
    scene: dict[str, Any], best: dict[str, Any], tol: float, folder: Path
) -> tuple[str, float, str, int]:
    """A word, error over what is allowed, why, and how many steps the engine took."""
    bare = {key: part for key, part in scene.items() if key != "limit"}
    run, words = engine(bare, tol, folder)
    if run is None:
        return "refused", math.inf, words, 10**6
    grown = tol / abs(scene["limit"]["share"] - 1.0) + best.get("doubt", 0.0)
    radius = scene["puck"]["radius"]
    found = np.array([run.last["x"], run.last["y"], radius * run.last["orientation"]])
    true = best["way"] * [1.0, 1.0, radius]
    shares = {
        "way": float(np.max(np.abs(found - true))) / max(grown * best["length"], 1e-14 * radius)
    }
    for name in ("stick", "slip"):
        times = [event.time for event in run.events if event.what == name]
        if best[name] is not None and best[name] > 0.0:
            off = abs(times[-1] - best[name]) if times else math.inf
            shares[name] = off / max(grown * best["time"], 1e-11 * scene["limit"]["span"])
    worst = max(shares, key=lambda name: shares[name])
    why = f"{worst}: {shares[worst]:.3g} of what is allowed; {run.end}, {run.steps} steps"
    return ("right" if shares[worst] <= 1.0 else "wrong"), shares[worst], why, run.steps

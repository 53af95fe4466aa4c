"""Films that are drawn: pucks, launches, cameras, floors of many kinds, and what is true of them.

Under dry friction of one coefficient motions are those of ``film_judge``; other floors, and drag,
are summed over the elements of a flat base.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import film_judge
import numpy as np
from scipy.integrate import solve_ivp

import puck_tables as pt

KINDS = (
    "marked", "unmarked", "straight", "straight unmarked", "fast", "few", "stamps",
    "stamps unmarked", "falling", "rising", "drag", "air table", "hand", "wall",
)  # fmt: skip
MISFITS = ("falling", "rising", "drag", "air table")  # of one friction coefficient


@dataclass(frozen=True)
class Drawn:
    """A film.

    ``truth`` by the name of a number; ``turns`` a frame at the launch; ``foreign``: how many frames
    a hand or a wall spoils.
    """

    kind: str
    seed: int
    track: pt.Track
    puck: pt.Puck
    truth: dict[str, float]
    turns: float
    noise: tuple[float, float]
    foreign: int
    how: dict[str, Any] = field(default_factory=dict)


def drawn(kind: str, seed: int) -> Drawn:
    """The film of a kind and a seed."""
    rng = np.random.default_rng([KINDS.index(kind), seed])
    radius, friction = rng.uniform(0.02, 0.05), math.exp(rng.uniform(math.log(0.04), math.log(0.4)))
    delta, speed, heading = rng.uniform(0.05, 0.8), rng.uniform(0.5, 2.5), rng.uniform(0.0, 6.28)
    noise = 1e-3 * rng.uniform(0.1, 0.6), 1e-3 * rng.uniform(2.0, 10.0)
    fps, ratio, sign = rng.uniform(60.0, 240.0), rng.uniform(0.2, 2.0), rng.choice([-1.0, 1.0])
    seen = rng.uniform(0.5, 1.15)  # of the run
    if kind in ("falling", "rising", "drag", "air table"):
        delta = 0.0
    if kind == "air table":
        friction, speed, noise = rng.uniform(1e-3, 3e-3), rng.uniform(0.15, 0.5), (3e-5, 2e-3)
    decel = friction * film_judge.G
    spin = sign * ratio * speed / radius
    if kind.startswith("straight"):
        spin = 0.0
    slow = speed / decel * (1.0 + 0.5 * abs(radius * spin / speed))  # about the time of the run
    if kind in ("fast", "few"):
        count = int(rng.integers(7, 14)) if kind == "few" else int(rng.integers(16, 60))
        turned = 2.0 * math.pi * rng.uniform(0.55, 2.5) * (count - 1)
        # spin * seen * (speed + 0.4 r spin) / J = turned
        root = math.sqrt(speed**2 + 1.6 * radius * turned * decel / seen)
        spin = sign * (root - speed) / (0.8 * radius)
        fps = (count - 1) * abs(spin) / turned
        slow = turned / abs(spin) / seen
    span = min(seen * slow, 1.5) if kind == "air table" else seen * slow
    if kind not in ("fast", "few"):
        fps = min(max(fps, 40.0 / span), 300.0 / span)
        count = int(span * fps) + 1
    times = np.arange(count) / fps
    law: Law | None = None
    if kind == "falling":
        least, scale = friction * rng.uniform(0.3, 0.7), rng.uniform(0.05, 0.5)
        law = lambda u: least + (friction - least) * np.exp(-u / scale)  # noqa: E731
    elif kind == "rising":
        slope = friction * rng.uniform(0.1, 0.6)
        law = lambda u: friction + slope * u  # noqa: E731
    elif kind in ("drag", "air table"):
        slope = rng.uniform(0.05, 0.5) / film_judge.G
        law = lambda u: friction + slope * u  # noqa: E731
    velocity = speed * math.cos(heading), speed * math.sin(heading)
    if law is None:
        true = film_judge.path(velocity, spin, decel, delta, radius, times)
    else:
        true = summed(velocity, spin, law, radius, times)
    foreign = 0
    if kind == "hand":  # it pushes with a steady force until it lets go
        foreign = int(rng.uniform(0.08, 0.35) * count)
        back, push = times[:foreign] - times[foreign], rng.uniform(0.2, 1.0) * speed
        way = speed * back + 0.5 * push / times[foreign] * back**2
        before = np.stack([*np.outer(np.array(velocity) / speed, way), spin * back])
        true = np.concatenate([before, true[:, : count - foreign]], axis=1)
    elif kind == "wall":  # that turns it back
        foreign = int(rng.uniform(0.08, 0.35) * count)
        at = true[:, count - foreign - 1, None]
        true[:, count - foreign :] = at - rng.uniform(0.3, 0.9) * (true[:, count - foreign :] - at)
    place, angle = film_judge.noisy(rng, true, noise)
    place += np.array([0.3, -0.1])
    stamps = np.round(times, 3) if kind.startswith("stamps") else times
    marked = not kind.endswith("unmarked")
    track = pt.Track(
        stamps, place + np.array([0.3, -0.1]), angle if marked else None, f"{kind} {seed}"
    )
    truth = {"launch_vx": velocity[0], "launch_vy": velocity[1], "launch_spin": spin}
    if law is None:
        truth |= {"friction": friction, "delta": delta}
    turns = abs(spin) / (2.0 * math.pi * fps)
    return Drawn(kind, seed, track, pt.Puck(radius=radius), truth, turns, noise, foreign)


Law = Callable[[np.ndarray], np.ndarray]


def summed(
    velocity: tuple[float, float], spin: float, law: Law, radius: float, times: np.ndarray
) -> np.ndarray:
    """x, y and angle (3, n) of a flat puck whose friction is a law over slip speed."""
    rho = radius * np.sqrt((np.arange(24) + 0.5) / 24)
    theta = 2.0 * math.pi * (np.arange(48) + 0.5) / 48
    px, py = (np.outer(rho, trig).ravel() for trig in (np.cos(theta), np.sin(theta)))

    def rates(_: float, z: np.ndarray) -> list[float]:
        ux, uy = z[3] - z[5] * py, z[4] + z[5] * px
        u = np.hypot(ux, uy)
        pull = film_judge.G * law(u) / np.maximum(u, 1e-9)
        turn = -2.0 / radius**2 * np.mean(pull * (px * uy - py * ux))
        return [*z[3:], -np.mean(pull * ux), -np.mean(pull * uy), turn]

    stop = lambda _, z: math.hypot(z[3], z[4], radius * z[5]) - 1e-3  # noqa: E731
    stop.terminal = True
    start = [0.0, 0.0, 0.0, *velocity, spin]
    found = solve_ivp(
        rates, (0.0, float(times[-1]) + 1e-9), start, "RK45", rtol=1e-6, atol=1e-8,
        dense_output=True, events=stop,
    )  # fmt: skip
    sums: np.ndarray = found.sol(np.minimum(times, found.t[-1]))[:3]
    return sums


def wrong(film: Drawn, found: pt.Fit, errors: float = 4.0) -> dict[str, float]:
    """Numbers called determined that are off by more than so many errors, and by how many."""
    launch = found.launch().numbers
    off = {}
    for name, truth in film.truth.items():
        if name in launch and film.kind == "hand":  # it begins when the hand lets go
            continue
        number = launch[name] if name in launch else found[name]
        if number.determined and not number.at_bound and number.error > 0.0:
            away = abs(number.value - truth) / number.error
            if away > errors:
                off[name] = away
    return off


def cut(film: Drawn, found: pt.Fit) -> float:
    """The share of free frames that are cut off the ends; negative of foreign ones that are not."""
    ((_, first, last),) = found.left_out
    return (first + last - film.foreign) / (film.track.time.size - film.foreign)

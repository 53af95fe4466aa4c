"""Films that are drawn: pucks, launches, cameras, floors of many kinds, and what is true of them.

Under dry friction of one coefficient motions are those of ``film_judge``, with air, a slope or a
push; on other floors, and with drag, those of ``disc_judge``.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import film_judge
import numpy as np
from disc_judge import Law, slid

import puck_tables as pt

KINDS = (
    "marked", "unmarked", "straight", "straight unmarked", "fast", "few", "stamps",
    "stamps unmarked", "falling", "rising", "drag", "air table", "hand", "wall", "grid",
    "grid unmarked", "falling unmarked", "rising unmarked", "drag unmarked", "air", "air unmarked",
    "sloped", "sloped unmarked", "push", "push unmarked",
)  # fmt: skip
LAWS = ("falling", "rising", "drag", "air table", "air")  # of no one friction coefficient
SLOPE = 0.5  # degrees, at most


@dataclass(frozen=True)
class Drawn:
    """A film.

    ``truth`` by the name of a number; ``turns`` a frame at the launch; ``foreign``: how many frames
    a hand or a wall spoils; ``friction``: the least and the largest that acts; ``slope``: degrees.
    """

    kind: str
    seed: int
    track: pt.Track
    puck: pt.Puck
    truth: dict[str, float]
    turns: float
    noise: tuple[float, float]
    foreign: int
    friction: tuple[float, float]
    slope: float = 0.0


def drawn(kind: str, seed: int) -> Drawn:
    """The film of a kind and a seed."""
    rng, floor = np.random.default_rng([KINDS.index(kind), seed]), kind.removesuffix(" unmarked")
    radius, friction = rng.uniform(0.02, 0.05), math.exp(rng.uniform(math.log(0.04), math.log(0.4)))
    delta, speed, heading = rng.uniform(0.05, 0.8), rng.uniform(0.5, 2.5), rng.uniform(0.0, 6.28)
    noise = 1e-3 * rng.uniform(0.1, 0.6), 1e-3 * rng.uniform(2.0, 10.0)
    fps, ratio, sign = rng.uniform(60.0, 240.0), rng.uniform(0.2, 2.0), rng.choice([-1.0, 1.0])
    seen = rng.uniform(0.5, 1.15)  # of the run
    if floor in LAWS:
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
    if floor == "falling":
        least, scale = friction * rng.uniform(0.3, 0.7), rng.uniform(0.05, 0.5)
        law = lambda u: least + (friction - least) * np.exp(-u / scale)  # noqa: E731
    elif floor == "rising":
        slope = friction * rng.uniform(0.1, 0.6)
        law = lambda u: friction + slope * u  # noqa: E731
    elif floor in ("drag", "air table"):
        slope = rng.uniform(0.05, 0.5) / film_judge.G
        law = lambda u: friction + slope * u  # noqa: E731
    velocity = speed * math.cos(heading), speed * math.sin(heading)
    tilt, besides, foreign, acts = 0.0, None, 0, (friction, friction)
    if floor == "air":
        air = rng.uniform(0.03, 0.5)  # 1/m
        acts = friction, friction + air * speed**2 / film_judge.G
        besides = lambda t, v, w: (*(-air * math.hypot(*v) * v), 0.0)  # noqa: E731
    elif floor == "sloped":
        tilt, down = rng.uniform(0.0, SLOPE), rng.uniform(0.0, 6.28)
        pull = film_judge.G * math.radians(tilt) * np.array([math.cos(down), math.sin(down), 0.0])
        besides = lambda t, v, w: pull  # noqa: E731
    elif floor == "push":
        besides = pushing(rng, speed, radius, times)
    if law is None:
        true = film_judge.path(velocity, spin, decel, delta, radius, times, besides=besides)
    else:
        true = slid(law, radius, velocity, spin, times)
        some = law(np.linspace(0.0, speed + radius * abs(spin), 99))
        acts = float(some.min()), float(some.max())
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
    if floor == "grid":
        place = (step := rng.uniform(1.0, 20.0) * noise[0]) * np.round(place / step)
    stamps = np.round(times, 3) if kind.startswith("stamps") else times
    marked = not kind.endswith("unmarked")
    track = pt.Track(
        stamps, place + np.array([0.3, -0.1]), angle if marked else None, f"{kind} {seed}"
    )
    truth = {"launch_vx": velocity[0], "launch_vy": velocity[1], "launch_spin": spin}
    if floor not in LAWS:
        truth |= {"friction": friction, "delta": delta}
    turns = abs(spin) / (2.0 * math.pi * fps)
    return Drawn(
        kind, seed, track, pt.Puck(radius=radius), truth, turns, noise, foreign, acts, tilt
    )


def pushing(
    rng: np.random.Generator, speed: float, radius: float, times: np.ndarray
) -> film_judge.Besides:
    """A hand over the puck in 3 to 8 frames somewhere: it pushes, and may turn it."""
    last = int(rng.integers(3, 9))
    first = int((0, rng.integers(1, times.size - last - 1), times.size - last - 1)[rng.integers(3)])
    since, until = times[first], times[first + last]
    gain = speed * rng.uniform(0.1, 0.6) * rng.choice([-1.0, 1.0]) / (until - since)
    angle, turned = rng.uniform(0.0, 6.28), rng.choice([0.0, rng.uniform(-1.0, 1.0)])
    force = gain * np.array([math.cos(angle), math.sin(angle), turned / radius])
    return lambda t, v, w: force * float(since <= t <= until)


def wrong(film: Drawn, found: pt.results.Fit, errors: float = 4.0) -> dict[str, float]:
    """Numbers called determined that are off by more than so many errors, and by how many."""
    launch = found.launch().numbers
    off = {}
    for name, truth in film.truth.items():
        if name in launch and film.kind.startswith(("hand", "push")):  # it begins afterwards
            continue
        number = launch[name] if name in launch else found[name]
        if number.determined and not number.at_bound and number.error > 0.0:
            away = abs(number.value - truth) / number.error
            if away > errors:
                off[name] = away
    number, (low, high) = found["friction"], film.friction
    if number.determined and not number.at_bound and "friction" not in film.truth:
        away = max(low - number.value, number.value - high) / number.error
        if away > errors:
            off["friction"] = away
    return off


def cut(film: Drawn, found: pt.results.Fit) -> float:
    """The share of free frames that are cut off the ends; negative of foreign ones that are not."""
    ((_, first, last),) = found.left_out
    return (first + last - film.foreign) / (film.track.time.size - film.foreign)

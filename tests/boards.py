"""Boards for the tests of several pucks: random ones, racks, and their judges."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from pucks_judge import Disc, Line, Straight

import puck_tables as pt


def puck_at(x: float, y: float, velocity: Any = None, spin: float = 0.0, **how: Any) -> pt.Puck:
    """A puck of 3 cm, 0.1 kg, f = 0.2."""
    kept = {"radius": 0.03, "mass": 0.1, "friction": 0.2, "height": 0.01, **how}
    return pt.Puck(launch=pt.Launch(velocity, spin, (x, y)), **kept)


def cushions(side: float = 0.6, restitution: float = 0.8, **rim: float) -> list[pt.Wall]:
    """Four around a square."""
    return [
        pt.Wall((-side * x, -side * y), normal=(x, y), restitution=restitution, **rim)
        for x, y in ((1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0))
    ]


def draw(
    seed: int, count: int, *, side: float = 0.4, speed: float = 1.5, walls: bool = True
) -> pt.Scene:
    """Random pucks in a square: different sizes, masses, rims, some at rest."""
    rng = np.random.default_rng(seed)
    pucks: list[pt.Puck] = []
    while len(pucks) < count:
        radius = rng.uniform(0.015, 0.04)
        place = rng.uniform(-side + radius, side - radius, 2)
        clear = (math.dist(place, p.launch.position) - p.radius - radius for p in pucks)
        if min(clear, default=1.0) <= 1e-3:
            continue
        moves = rng.random() < 0.6 or not pucks
        pucks.append(puck_at(
            *place.tolist(),
            (speed * rng.normal(size=2)).tolist() if moves else None,
            float(rng.normal() * speed / radius) if moves else 0.0,
            radius=radius, mass=float(rng.uniform(0.02, 0.3)),
            friction=float(rng.uniform(0.05, 0.4)), height=float(rng.uniform(0.0, 0.4) * radius),
            restitution=float(rng.uniform(0.3, 1.0)),
            tangential=float(rng.choice([-1.0, 0.0, rng.uniform(-1.0, 0.8)])),
            rim=float(rng.choice([math.inf, rng.uniform(0.0, 0.5)])),
        ))  # fmt: skip
    cushions = [
        pt.Wall((-side * nx, -side * ny), normal=(nx, ny), restitution=float(rng.uniform(0.3, 1.0)),
                tangential=float(rng.uniform(-1.0, 0.8)), friction=float(rng.uniform(0.0, 0.5)))
        for nx, ny in ((1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0))
    ]  # fmt: skip
    return pt.Scene(pucks=pucks, walls=cushions if walls else [])


def draw_pucks(seed: int, count: int) -> pt.Scene:
    """The same in a frame of four walls with ends, and four such walls among the pucks."""
    rng, bare = np.random.default_rng([seed, 3]), draw(seed, count, walls=False)
    corners = [(-0.4, -0.4), (0.4, -0.4), (0.4, 0.4), (-0.4, 0.4)]
    ends = list(zip(corners, corners[1:] + corners[:1], strict=True))
    while len(ends) < 8:
        a = rng.uniform(-0.35, 0.35, 2)
        b = a + rng.uniform(0.05, 0.3) * rng.normal(size=2)
        wall = Straight(a, b, 1.0, 0.0, 0.0)
        gaps = (math.dist(p.launch.position, wall.nearest(np.array(p.launch.position))) - p.radius
                for p in bare.pucks)  # fmt: skip
        if np.abs(b).max() < 0.4 and min(gaps) > 1e-3:
            ends.append((tuple(a.tolist()), tuple(b.tolist())))
    walls = [
        pt.Wall(a, b, restitution=float(rng.uniform(0.3, 1.0)),
                tangential=float(rng.uniform(-1.0, 0.8)), friction=float(rng.uniform(0.0, 0.5)))
        for a, b in ends
    ]  # fmt: skip
    return pt.Scene(pucks=bare.pucks, walls=walls)


def judged(scene: pt.Scene) -> tuple[list[Disc], list[Line | Straight]]:
    """The same for the judge."""
    discs = [
        Disc(p.radius, p.mass, p.friction, p.height,
             np.array([*p.launch.position, p.launch.orientation, *(p.launch.velocity or (0.0, 0.0)),
                       p.launch.spin]), p.restitution, p.tangential, p.rim)
        for p in scene.pucks
    ]  # fmt: skip
    lines: list[Line | Straight] = []
    for w in scene.walls:
        law: Any = w.restitution, w.tangential, w.friction
        if w.point is None:
            lines.append(Straight(np.array(w.start), np.array(w.end), *law))
        else:
            lines.append(Line(w.normal, float(np.dot(w.normal, w.point)), *law))
    return discs, lines


def hexagon(rings: int, pitch: float) -> list[tuple[float, float]]:
    """Places of a hexagonal rack, its centre first."""
    rows = [
        (pitch * (a + 0.5 * b), pitch * math.sqrt(0.75) * b)
        for a in range(-rings, rings + 1) for b in range(-rings, rings + 1)
        if abs(a + b) <= rings
    ]  # fmt: skip
    return sorted(rows, key=lambda place: math.hypot(*place))

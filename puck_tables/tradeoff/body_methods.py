"""Methods for the stop of bodies: a box, a box whose friction falls with speed, a curling stone."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.contact.friction_laws import CurlingLaw, FrictionLaw, StribeckLaw
from puck_tables.puck import Puck
from puck_tables.scene.parts import Floor, Launch
from puck_tables.tradeoff.scipy_methods import patch_script, ring_patches, scripted
from puck_tables.tradeoff.truth import Contender, Made, Question, kept_arrays
from puck_tables.world.scene import Scene

# of Q/(fg), Q²/(fg), asked for; sums under a law by speed take longer
_TOLS, _TOLS_OF_A_LAW = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10), (1e-6, 1e-8)
_GRIDS = (5, 10, 20)  # patches across the shorter way, twice as many along the other
_LAUNCHES = 24  # judged, and timed
_BY_SCIPY = 6  # of them asked of what takes a second


@dataclass(frozen=True)
class ThrownBody:
    """A puck on a base, how friction falls with the slip speed (m/s), and patches of the base.

    ``patches``: (x, y), m, of so many, (2, n), and their weights (n,); ``few``: of the points that
    a physics engine would have it stand on.
    """

    puck: Puck
    law: FrictionLaw | None
    patches: Callable[[int], tuple[FloatArray, FloatArray]]
    few: tuple[FloatArray, FloatArray]

    def friction(self, speed: FloatArray) -> FloatArray:
        """The coefficient at slip speeds (m/s)."""
        return speed * 0.0 + self.puck.friction if self.law is None else self.law.formula(speed)

    def units(self, launches: FloatArray) -> FloatArray:
        """Q/J, Q²/J and Q²/J of launches (3, n), with J = f g at the speed Q."""
        q = np.hypot(np.hypot(*launches[:2]), self.puck.inertia_radius * launches[2])
        return np.stack([q, q * q, q * q]) / (self.puck.gravity * self.friction(q))


def _of_a_box(count: int) -> tuple[FloatArray, FloatArray]:
    """Centres of equal patches of the box, and their weights."""
    x, y = (side * ((np.arange(n) + 0.5) / n - 0.5)
            for side, n in zip(_SIDES, (2 * count, count), strict=True))  # fmt: skip
    points = np.stack(np.meshgrid(x, y)).reshape(2, -1)
    return points, np.full(points.shape[1], 1.0 / points.shape[1])


_SIDES, _BAND = (0.2, 0.1), (0.0555, 0.0635)  # m
# m: of the box, (2, 4)
_CORNERS = 0.5 * np.array([[1.0, 1.0, -1.0, -1.0], [1.0, -1.0, 1.0, -1.0]]) * np.c_[_SIDES,]
_FEW = _CORNERS, np.full(4, 0.25)
_BOX = Puck(base="box:0.2x0.1", friction=0.25, height=0.04)
BODIES = {
    "box": ThrownBody(_BOX, None, _of_a_box, _FEW),
    "box, friction falls with speed": ThrownBody(
        replace(_BOX, friction=0.0, height=0.0), StribeckLaw(0.35, 0.2, 0.1), _of_a_box, _FEW
    ),
    "curling stone": ThrownBody(
        Puck(base="annulus:0.0635x0.0555", height=0.114, mass=19.96, gyration=0.1025),
        CurlingLaw(0.00200985, 0.06385782, 0.00626286),
        lambda count: ring_patches(*_BAND, count, 12 * count), ring_patches(*_BAND, 1, 12),
    ),
}  # fmt: skip


def contenders() -> Iterator[Contender]:
    """All methods to the stop of a body, and what one would write."""
    for name, body in BODIES.items():
        rows = kept_arrays("body_starts.npz")[name]  # vx, vy, ω of launches, and their stops
        launches = np.ascontiguousarray(rows[:3])
        question = Question(name, launches, rows[3:] / body.units(launches), launches)
        for tol in _TOLS if body.law is None else _TOLS_OF_A_LAW:
            make = partial(_integrated, body, tol)
            yield Contender(question, "sums over the base", f"tol={tol:g}", make, _LAUNCHES)
        some, make = question.some(slice(_BY_SCIPY)), partial(_scripted, body, *body.few)
        for patches in map(body.patches, _GRIDS):
            words, many = f"patches={patches[1].size}", partial(_scripted, body, *patches)
            yield Contender(some, "patches and scipy RK45", words, many, 2, outsider=True)
        yield Contender(some, "a few points, RK45", "", make, 2, outsider=True)


def _integrated(body: ThrownBody, tol: float) -> Made:
    """Many launches on one thread."""

    def run(launches: FloatArray) -> FloatArray:
        velocity: Any = launches[:2].T
        spin: Any = launches[2]
        if body.law is None:
            stops = body.puck.stop(velocity, spin, tol=tol, threads=1)
            found = stops.stop_time, stops.stop_x, stops.stop_y
        else:
            scene = Scene(body.puck, Floor(law=body.law), Launch(velocity, spin=spin), tol=tol)
            ends = scene.sweep(threads=1)
            found = ends.end_time, ends.x, ends.y
        return np.stack(found) / body.units(launches)

    return None, run


def _scripted(body: ThrownBody, points: FloatArray, weights: FloatArray) -> Made:
    """What one would write: friction summed over points, scipy's solver over time."""
    k, height, gravity = body.puck.inertia_radius, 0.5 * body.puck.height, body.puck.gravity
    _, run = scripted(patch_script(points, weights, k, height, gravity, body.friction))
    return None, lambda launches: run(launches) / body.units(launches)

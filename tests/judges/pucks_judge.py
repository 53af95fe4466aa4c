"""Several pucks by scipy: the judge of :mod:`puck_tables.world`, which shares no code with it.

All that moves is integrated together in time (DOP853), friction by the elliptic integrals of
``reference.py``, contacts by scipy's event location.  Impacts are solved as small linear systems in
the velocities of both discs, not by the formulas of the engine.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from reference import friction
from scipy.integrate import solve_ivp

G = 9.80665
_STOP = 3e-8  # m/s: slower, a puck is at rest


@dataclass
class Disc:
    """A puck: SI units; e, beta, mu of its rim."""

    radius: float
    mass: float
    f: float
    height: float
    e: float
    beta: float
    mu: float
    state: np.ndarray  # x, y, angle, vx, vy, spin

    @property
    def inertia(self) -> float:
        return 0.5 * self.mass * self.radius**2

    def rates(self, s: np.ndarray) -> np.ndarray:
        vx, vy, rim, decel = s[3], s[4], self.radius * s[5], self.f * G
        speed = math.hypot(vx, vy)
        if math.hypot(speed, rim) < 0.01 * _STOP:
            return np.zeros(6)
        if abs(rim) <= 1e-13 * speed:
            ax, ay, turn = -vx / speed, -vy / speed, 0.0
        elif speed <= 1e-13 * abs(rim):
            ax, ay, turn = 0.0, 0.0, -4.0 / 3.0 * math.copysign(1.0, rim)
        else:
            ax, ay, turn = friction(vx, vy, rim, 2.0 * self.f * self.height / self.radius)
        return np.array([vx, vy, s[5], decel * ax, decel * ay, decel * turn / self.radius])


@dataclass
class Line:
    """A straight cushion: unit normal into the field, place along it."""

    normal: tuple[float, float]
    place: float
    e: float
    beta: float
    mu: float


@dataclass
class Straight:
    """A cushion from one place to another: what counts is the place of it next to a centre."""

    start: np.ndarray
    end: np.ndarray
    e: float
    beta: float
    mu: float

    def nearest(self, places: np.ndarray) -> np.ndarray:
        """Of each of the places (2,) or (2, n)."""
        way = self.end - self.start
        share = np.clip((way @ (places.T - self.start).T) / (way @ way), 0.0, 1.0)
        return (self.start + np.multiply.outer(share, way)).T


@dataclass
class Told:
    """Times and partners of impacts, and the last states."""

    impacts: list[tuple[float, int, int]] = field(default_factory=list)
    states: np.ndarray | None = None


def play(
    discs: list[Disc], lines: list[Line | Straight], until: float, most: int = 10**6
) -> Told:  # fmt: skip
    """Follow them until a time, or so many impacts."""
    told, t = Told(), 0.0
    y = np.array([d.state for d in discs], float)
    pairs = [(i, j) for i in range(len(discs)) for j in range(i + 1, len(discs))]
    meetings = pairs + [(i, -1 - k) for i in range(len(discs)) for k in range(len(lines))]

    def gap(i: int, j: int, z: np.ndarray) -> Any:
        if j >= 0:
            return np.hypot(*(z[i, :2] - z[j, :2])) - discs[i].radius - discs[j].radius
        line = lines[-1 - j]
        if isinstance(line, Straight):
            return np.hypot(*(z[i, :2] - line.nearest(z[i, :2]))) - discs[i].radius
        return np.dot(line.normal, z[i, :2]) - line.place - discs[i].radius

    def moves(i: int) -> bool:
        return math.hypot(y[i, 3], y[i, 4], discs[i].radius * y[i, 5]) > _STOP

    while t < until and len(told.impacts) < most:
        going = [i for i in range(len(discs)) if moves(i)]
        for i in range(len(discs)):
            if i not in going:
                y[i, 3:] = 0.0
        if not going:
            break
        base = y.copy()

        def whole(flat: np.ndarray, going=going, base=base) -> np.ndarray:
            z = base.copy()
            z[going] = flat.reshape(-1, 6)
            return z

        def rates(_: float, flat: np.ndarray, going=going) -> np.ndarray:
            rows = flat.reshape(-1, 6)
            return np.concatenate([discs[i].rates(row) for i, row in zip(going, rows, strict=True)])

        events, kinds = [], []
        for i, j in meetings:
            if i in going or j in going:

                def meets(_: float, flat: np.ndarray, i=i, j=j, whole=whole) -> float:
                    return gap(i, j, whole(flat))

                meets.terminal, meets.direction = True, -1.0  # type: ignore[attr-defined]
                events.append(meets)
                kinds.append((i, j))
        meeting = list(kinds)
        for n, i in enumerate(going):

            def slow(_: float, flat: np.ndarray, n=n, i=i) -> float:
                row = flat[6 * n : 6 * n + 6]
                return math.hypot(row[3], row[4], discs[i].radius * row[5]) - _STOP

            slow.terminal, slow.direction = True, -1.0  # type: ignore[attr-defined]
            events.append(slow)
            kinds.append((i, None))
        # finer, rounding of the elliptic integrals where a spin is slow asks for steps of 1e-9 s
        for longest in (0.02, 0.0005):
            found = solve_ivp(
                rates, (t, until), y[going].ravel(), "DOP853", rtol=1e-11, atol=1e-13,
                max_step=longest, events=events, dense_output=True,
            )  # fmt: skip
            assert found.success
            between = found.sol(np.arange(t, found.t[-1], 2e-4)).T
            states = np.moveaxis(np.stack([whole(z) for z in between]), 0, -1)
            if not any((gap(*kind, states) < -1e-7).any() for kind in meeting):
                break  # else two have met, and were apart again, within a step
        t = float(found.t[-1])
        y = whole(found.y[:, -1])
        for kind, hits in zip(kinds, found.t_events, strict=True):
            if len(hits) and kind[1] is None:
                y[kind[0], 3:] = 0.0
            elif len(hits):
                collide(discs, lines, kind[0], kind[1], y)
                told.impacts.append((t, *kind))
    told.states = y
    return told


def collide(
    discs: list[Disc], lines: list[Line | Straight], i: int, j: int, y: np.ndarray
) -> None:  # fmt: skip
    """The impact of two, as linear equations in their six velocities and two impulses."""
    d = discs[i]
    if j >= 0:
        other = discs[j]
        n = (y[j, :2] - y[i, :2]) / math.dist(y[i, :2], y[j, :2])
        e, beta, mu = min(d.e, other.e), min(d.beta, other.beta), min(d.mu, other.mu)
        masses = [d.mass, d.mass, d.inertia, other.mass, other.mass, other.inertia]
        reach = other.radius
    else:
        line = lines[-1 - j]
        if isinstance(line, Straight):
            n = (line.nearest(y[i, :2]) - y[i, :2]) / d.radius
        else:
            n = -np.array(line.normal)
        e, beta, mu = line.e, line.beta, line.mu
        masses, reach = [d.mass, d.mass, d.inertia], 0.0
    s = np.array([-n[1], n[0]])
    normal = np.array([*n, 0.0, *(-n), 0.0])[: len(masses)]
    along = np.array([*s, d.radius, *(-s), reach])[: len(masses)]
    v = np.concatenate([y[i, 3:], y[j, 3:] if j >= 0 else []])
    inverse = 1.0 / np.array(masses)
    un, ut = normal @ v, along @ v
    # v⁺ + M⁻¹ (n P_n + t P_t) = v, n v⁺ = −e u_n, and t v⁺ = −β u_t or P_t = ± μ P_n
    size = len(masses)
    for way in (0.0, 1.0, -1.0):
        matrix, right = np.zeros((size + 2, size + 2)), np.zeros(size + 2)
        matrix[:size, :size] = np.eye(size)
        matrix[:size, size], matrix[:size, size + 1] = inverse * normal, inverse * along
        right[:size] = v
        matrix[size, :size], right[size] = normal, -e * un
        if way == 0.0:
            matrix[size + 1, :size], right[size + 1] = along, -beta * ut
        else:
            matrix[size + 1, size], matrix[size + 1, size + 1] = -way * mu, 1.0
        solution = np.linalg.solve(matrix, right)
        push, rub = solution[size:]
        if way == 0.0 and abs(rub) <= mu * push:
            break
        if way != 0.0 and rub * ut >= 0.0:
            break
    y[i, 3:] = solution[:3]
    if j >= 0:
        y[j, 3:] = solution[3:6]

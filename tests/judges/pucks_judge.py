"""Several pucks by scipy, on floors that move or change, too, pulled and led.

The judge of :mod:`puck_tables.world`, which shares no code with it.

All that moves is integrated together in time (DOP853), friction by the elliptic integrals of
``reference.py`` at velocities over the floor.  A constraint is a function g(t, q, V) = 0, linear in
V; accelerations and multipliers come from one linear system, its rates of change from a complex
step.  Impacts are one linear system, too.  Heat of the floor and work of the supports are
integrated beside the states.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from astride_judge import FloorMap
from astride_judge import friction as astride
from reference import friction
from scipy.integrate import solve_ivp

G = 9.80665
_STOP = 3e-8  # m/s: slower, a puck rests on its floor


@dataclass
class Floor:
    """A belt or turntable, strips (direction, borders, frictions), a pull per mass (ax, ay).

    ``spots``: round patches (x, y, radius, friction).  A base on several frictions feels each under
    its own part, by ``astride_judge.py``.
    """

    vx: float = 0.0
    vy: float = 0.0
    turning: float = 0.0
    centre: tuple[float, float] = (0.0, 0.0)
    strips: tuple[float, list[float], list[float]] | None = None
    pull: tuple[float, float] = (0.0, 0.0)
    spots: tuple[tuple[float, float, float, float], ...] = ()

    def velocity(self, q: np.ndarray) -> np.ndarray:
        dx, dy = q[0] - self.centre[0], q[1] - self.centre[1]
        return np.array([self.vx - self.turning * dy, self.vy + self.turning * dx, self.turning])

    def along(self, q: np.ndarray) -> float:
        return math.cos(self.strips[0]) * q[0] + math.sin(self.strips[0]) * q[1]

    def shores(self, q: np.ndarray, radius: float) -> list[float]:
        """How far the rim is from where it comes over something, or leaves it; of both signs."""
        found = []
        if self.strips is not None:
            place = self.along(q)
            found += [place - b + s * radius for b in self.strips[1] for s in (-1.0, 1.0)]
        for x, y, reach, _ in self.spots:
            away = math.hypot(q[0] - x, q[1] - y)
            found += [away - reach + s * radius for s in (-1.0, 1.0)]
        return found

    def under(self, q: np.ndarray, radius: float, f: float) -> float | FloorMap:
        """The one friction under a base, or all that there are around it."""
        if self.strips is None and not self.spots:
            return f
        turn, borders, values = self.strips or (0.0, [], [f])
        c, s = math.cos(turn), math.sin(turn)
        place = np.array([c * q[0] + s * q[1], c * q[1] - s * q[0]])
        spots = []
        for x, y, reach, spot in self.spots:
            away = math.hypot(q[0] - x, q[1] - y)
            if away <= reach - radius:
                return spot
            if away < reach + radius:
                middle = np.array([c * x + s * y, c * y - s * x]) - place
                spots.append((*(middle / radius).tolist(), reach / radius, spot))
        first = int(np.searchsorted(borders, place[0] - radius, "right"))
        last = int(np.searchsorted(borders, place[0] + radius, "left"))
        if first == last and not spots:
            return values[first]
        return FloorMap([(b - place[0]) / radius for b in borders], list(values), spots)

    def rub(self, d: Disc, q: np.ndarray, u: np.ndarray) -> np.ndarray:
        """Force and torque of the floor at a slip u of a disc."""
        found = self.under(q, d.radius, d.f)
        rim = d.radius * u[2]
        if isinstance(found, FloorMap):
            turn = 0.0 if self.strips is None else self.strips[0]
            c, s = math.cos(turn), math.sin(turn)
            along, across, torque = astride(
                found, c * u[0] + s * u[1], c * u[1] - s * u[0], rim, 2.0 * d.height / d.radius
            )
            whole = -(c * along - s * across), -(s * along + c * across), -d.radius * torque
            return np.array(whole) * d.mass * G
        if found == 0.0:
            return np.zeros(3)
        x, y, turning = friction(u[0], u[1], rim, 2.0 * found * d.height / d.radius)
        return found * d.mass * G * np.array([x, y, 0.5 * d.radius * turning])


Led = Callable[[float, np.ndarray, np.ndarray], np.ndarray]


def rail(angle: float, vx: float = 0.0, vy: float = 0.0) -> Led:
    n = np.array([-math.sin(angle), math.cos(angle)])
    return lambda t, q, v: np.array([n @ (v[:2] - np.array([vx, vy]))])


def pivot(angle: float, reach: float, vx: float = 0.0, vy: float = 0.0) -> Led:
    def led(t: float, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        c, s = np.cos(q[2] + angle), np.sin(q[2] + angle)
        return np.array([v[0] - reach * s * v[2] - vx, v[1] + reach * c * v[2] - vy])

    return led


def blade(floor: Floor, angle: float, side: float = 0.0) -> Led:
    def led(t: float, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        c, s = np.cos(q[2] + angle), np.sin(q[2] + angle)
        u = v - floor.velocity(q)
        return np.array([c * u[1] - s * u[0] - side])

    return led


@dataclass
class Disc:
    """A puck: SI units; e, beta, mu of its rim; force: t → Fx, Fy, torque."""

    radius: float
    mass: float
    f: float
    height: float
    state: np.ndarray
    e: float = 1.0
    beta: float = -1.0
    mu: float = math.inf
    force: Callable[[float], np.ndarray] | None = None
    led: Led | None = None

    @property
    def masses(self) -> np.ndarray:
        return self.mass * np.array([1.0, 1.0, 0.5 * self.radius**2])


@dataclass
class Line:
    """A straight cushion: unit normal into the field, place along it."""

    normal: tuple[float, float]
    place: float
    e: float = 1.0
    beta: float = -1.0
    mu: float = math.inf


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
    """Times and partners of impacts, the last states, heat of the floor, work of the supports."""

    impacts: list[tuple[float, int, int]] = field(default_factory=list)
    states: np.ndarray | None = None
    heat: float = 0.0
    support: float = 0.0


def jacobian(led: Led, t: float, q: np.ndarray, v: np.ndarray) -> np.ndarray:
    zero = led(t, q, np.zeros(3))
    return np.stack([led(t, q, one) - zero for one in np.eye(3)], axis=1)


def rates(floor: Floor, d: Disc, t: float, s: np.ndarray) -> tuple[np.ndarray, float, float]:
    """Accelerations, power of the floor's heat, and of supports."""
    q, v = s[:3], s[3:]
    ground = floor.velocity(q)
    u = v - ground
    slips = math.hypot(u[0], u[1], d.radius * u[2]) > 0.01 * _STOP
    rub = floor.rub(d, q, u) if slips else np.zeros(3)
    given = np.array([d.mass * floor.pull[0], d.mass * floor.pull[1], 0.0])
    if d.force is not None:
        given = given + d.force(t)
    total, support = rub + given, float(rub @ ground)
    if d.led is None:
        return total / d.masses, -float(rub @ u), support
    a = jacobian(d.led, t, q, v)
    h = 1e-30
    drift = d.led(t, q + 1j * h * v, v.astype(complex)).imag / h
    k = len(a)
    matrix = np.block([[np.diag(d.masses), -a.T], [a, np.zeros((k, k))]])
    found = np.linalg.solve(matrix, np.concatenate([total, -drift]))
    return found[:3], -float(rub @ u), support + float(found[3:] @ (a @ v))


def play(
    floor: Floor, discs: list[Disc], lines: list[Line | Straight], until: float, most: int = 10**6
) -> Told:  # fmt: skip
    """Follow them until a time, or so many impacts."""
    told, t = Told(), 0.0
    y = np.array([d.state for d in discs], float)
    count = len(discs)
    meetings = [(i, j) for i in range(count) for j in range(i + 1, count)]
    meetings += [(i, -1 - k) for i in range(count) for k in range(len(lines))]
    rests = [False] * count

    def gap(i: int, j: int, z: np.ndarray) -> Any:
        if j >= 0:
            return np.hypot(*(z[i, :2] - z[j, :2])) - discs[i].radius - discs[j].radius
        line = lines[-1 - j]
        if isinstance(line, Straight):
            return np.hypot(*(z[i, :2] - line.nearest(z[i, :2]))) - discs[i].radius
        return np.dot(line.normal, z[i, :2]) - line.place - discs[i].radius

    while t < until and len(told.impacts) < most:

        def whole(time: float, flat: np.ndarray) -> np.ndarray:
            out = np.zeros_like(flat)
            for i, d in enumerate(discs):
                row = flat[6 * i : 6 * i + 6]
                out[6 * i : 6 * i + 3] = row[3:]
                if rests[i]:
                    ground = floor.velocity(row)
                    turned = floor.turning * np.array([-ground[1], ground[0]])
                    out[6 * i + 3 : 6 * i + 5] = turned
                    holds = d.mass * (turned - floor.pull[:2])  # against what pulls, while it moves
                    if d.force is not None:
                        holds = holds - d.force(time)[:2]
                    out[-1] += float(holds @ ground[:2])
                    continue
                a, heat, support = rates(floor, d, time, row)
                out[6 * i + 3 : 6 * i + 6] = a
                out[-2] += heat
                out[-1] += support
            return out

        events, kinds = [], []

        def watch(kind: tuple, value: Callable, direction: float = -1.0) -> None:
            def event(_: float, flat: np.ndarray) -> float:
                return value(flat[:-2].reshape(-1, 6))

            event.terminal, event.direction = True, direction  # type: ignore[attr-defined]
            events.append(event)  # noqa: B023
            kinds.append(kind)  # noqa: B023

        for i, j in meetings:
            watch(("hit", i, j), lambda z, i=i, j=j: gap(i, j, z))
        for i, d in enumerate(discs):
            if not rests[i]:

                def slip(z: np.ndarray, i: int = i, r: float = d.radius) -> float:
                    u = z[i, 3:] - floor.velocity(z[i])
                    return math.hypot(u[0], u[1], r * u[2]) - _STOP

                watch(("rest", i), slip)
            for k, away in enumerate(floor.shores(y[i], d.radius)):
                if abs(away) > 1e-10:  # else it has just come over it
                    watch(
                        ("cross", i),
                        lambda z, i=i, k=k, r=d.radius: floor.shores(z[i], r)[k], 0.0,
                    )  # fmt: skip
        start = np.concatenate([y.ravel(), [told.heat, told.support]])
        for longest in (0.02, 0.0005):
            found = solve_ivp(
                whole, (t, until), start, "DOP853", rtol=1e-11, atol=1e-13, max_step=longest,
                events=events, dense_output=True,
            )  # fmt: skip
            assert found.success
            between = found.sol(np.arange(t, found.t[-1], 2e-4))[:-2].reshape(count, 6, -1)
            if not any((gap(*meeting, between) < -1e-7).any() for meeting in meetings):
                break  # else two have met, and were apart again, within a step
        t, told.heat, told.support = float(found.t[-1]), *found.y[-2:, -1].tolist()
        y = found.y[:-2, -1].reshape(-1, 6).copy()
        for kind, hits in zip(kinds, found.t_events, strict=True):
            if not len(hits):
                continue
            if kind[0] == "rest":
                rests[kind[1]] = True
                y[kind[1], 3:] = floor.velocity(y[kind[1]])
            elif kind[0] == "hit":
                collide(discs, lines, t, *kind[1:], y)
                told.impacts.append((t, *kind[1:]))
                for disc in kind[1:]:
                    if disc >= 0:
                        rests[disc] = False
    told.states = y
    return told


def collide(
    discs: list[Disc], lines: list[Line | Straight], t: float, i: int, j: int, y: np.ndarray
) -> None:  # fmt: skip
    """The impact of two: impulses and those of constraints in one linear system."""
    who = [i, j] if j >= 0 else [i]
    if j >= 0:
        n = (y[j, :2] - y[i, :2]) / math.dist(y[i, :2], y[j, :2])
        rims = discs[i], discs[j]
    else:
        line = lines[-1 - j]
        rims = (line,)
        if isinstance(line, Straight):
            n = (line.nearest(y[i, :2]) - y[i, :2]) / discs[i].radius
        else:
            n = -np.array(line.normal)
    e, beta, mu = (min(getattr(rim, name) for rim in rims) for name in ("e", "beta", "mu"))
    s = np.array([-n[1], n[0]])
    normal, along, blocks = [], [], []
    for sign, k in zip((1.0, -1.0), who, strict=False):
        normal += [*(sign * n), 0.0]
        along += [*(sign * s), discs[k].radius]
        led = discs[k].led
        blocks.append(np.zeros((0, 3)) if led is None else jacobian(led, t, y[k, :3], y[k, 3:]))
    rows = sum(map(len, blocks))
    a = np.zeros((rows, 3 * len(who)))
    first = 0
    for number, block in enumerate(blocks):
        a[first : first + len(block), 3 * number : 3 * number + 3] = block
        first += len(block)
    masses = np.concatenate([discs[k].masses for k in who])
    v = np.concatenate([y[k, 3:] for k in who])
    ut, size = float(np.dot(along, v)), len(v)
    # after Poisson: the impulses that stop approach and slip, enlarged by 1 + e and 1 + beta
    matrix = np.block([[np.diag(masses), -a.T], [a, np.zeros((rows, rows))]])
    jets = np.zeros((size + rows, 2))
    jets[:size, 0], jets[:size, 1] = normal, along
    change = np.linalg.lstsq(matrix, jets, rcond=None)[0][:size]
    w = np.array([normal, along]) @ change
    stops = np.linalg.solve(w, np.array([normal, along]) @ v)
    bound = mu * (1.0 + e) / (1.0 + beta) if beta > -1.0 else 0.0
    if abs(stops[1]) > bound * stops[0]:
        way = math.copysign(bound, ut)
        push = float(np.dot(normal, v)) / (w[0, 0] + way * w[0, 1])
        stops = np.array([push, way * push])
    v = v - change @ (stops * np.array([1.0 + e, 1.0 + beta]))
    for number, k in enumerate(who):
        y[k, 3:] = v[3 * number : 3 * number + 3]

"""The inverse problem: which launches come to rest at a given place."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables._core.real import finite_array, positive, real, shown
from puck_tables.errors import InputError
from puck_tables.io.columns import COLUMNS as VARIABLES
from puck_tables.io.dataset import Dataset, variable
from puck_tables.motion.puck_spec import PUCK_UNITS, PuckSpec
from puck_tables.stopping.aim_lookup import RIM, SPEED, TIME
from puck_tables.stopping.launch_arrays import fits
from puck_tables.stopping.launch_columns import Aimed
from puck_tables.stopping.launch_family import LaunchCurve, launch_curve
from puck_tables.stopping.launch_ranges import between, joined, sample
from puck_tables.stopping.target_error import misses

COLUMNS = (
    "launch_spin", "launch_vx", "launch_vy", "launch_speed", "launch_heading", "launch_slip_angle",
    "stop_time", "miss",
)  # fmt: skip
MAX_COUNT = 10_000  # launches of an answer: each a row
SLACK = 1e-12  # relative: a bound as printed is met
_LEAST_LOG, _LARGEST_LOG = -708.0, 709.0  # exp of them is still a number
_SMALL_STEP = 1e-6  # of u, after which what a step leaves is less than rounding
BEYOND = (
    "that takes a launch whose ratio of spin to speed is beyond 1e-260 to 1e260: "
    "out of the range of floating point"
)
TOO_LARGE = (
    "target, decel and radius ask for launches out of the range of floating point: use larger units"
)


@dataclass(frozen=True, eq=False, repr=False)
class Aim(Aimed):
    """Launches of a ``puck`` that come to rest at ``target`` (2,) m from where they start.

    Arrays (n,), ordered by spin, the most clockwise first: ``launch_velocity`` (n, 2) m/s,
    ``launch_spin`` rad/s, ``launch_speed`` m/s, ``launch_heading`` rad, ``launch_slip_angle`` φ
    rad, ``stop_time`` s, and ``miss`` m: how far from the target an integration of the launch ends.
    ``answer`` is one sentence: what was found, or why nothing can be.
    """

    puck: PuckSpec
    target: tuple[float, float]
    launch_velocity: FloatArray
    launch_spin: FloatArray
    stop_time: FloatArray
    miss: FloatArray
    answer: str

    picture: ClassVar[str] = "aim"

    def __repr__(self) -> str:
        return f"Aim(at ({self.target[0]:g}, {self.target[1]:g}) m: {self.answer})"

    def explain(self) -> str:
        """What was found, or why nothing can be."""
        return self.answer

    def summary(self) -> dict[str, Any]:
        """The launches with what went in, and the units of all, ready for JSON."""
        names = {name: VARIABLES[name].unit for name in COLUMNS}
        return {
            "target": list(self.target), **self.puck.described(), "answer": self.answer,
            **{name: getattr(self, name).tolist() for name in COLUMNS},
            "units": {"target": "m", **PUCK_UNITS, **names},
        }  # fmt: skip

    def dataset(self) -> Dataset:
        """One row a launch; puck and target as attributes."""
        columns = {name: variable(name, getattr(self, name), ("launch",)) for name in COLUMNS}
        attributes = {
            "title": "Launches that come to rest at a target", "target": list(self.target),
            "answer": self.answer, **self.puck.described(),
        }  # fmt: skip
        return Dataset({}, columns, attributes)


@dataclass(frozen=True)
class _Family:
    """The launches that stop at distance D, by u = ln(r|ω|/v): one for each u and sense of spin.

    From displacement = (Q²/J) Rot(ψ)(X, Y): Q² = J D/|X + iY|, ψ = bearing − arg(X ± iY).  Speeds
    are √(JD) and times √(D/J) times those of the curve; all here are logarithms.
    """

    distance: float
    decel: float
    curve: LaunchCurve
    found: dict[float, tuple[float, ...]] = field(default_factory=dict)  # what stands at a u

    @property
    def scales(self) -> FloatArray:
        """Of speed, rim speed and time; 0 for the angle."""
        half_j, half_d = 0.5 * math.log(self.decel), 0.5 * math.log(self.distance)
        return np.array([half_j + half_d, half_j + half_d, half_d - half_j, 0.0])

    def at(self, u: float) -> tuple[float, float, float, float]:
        """Speed, rim speed, stop time, and arg(X + iY) for ω > 0."""
        if u not in self.found:
            self.found[u] = tuple((self.curve.rows(np.array([u]))[0] + self.scales).tolist())
        speed, rim, time, bend = self.found[u]
        return speed, rim, time, bend

    def all_where(self, quantity: int, value: float) -> list[float]:
        """All u where a quantity of the curve has a value; −∞ is a slide without spin."""
        wanted = value - float(self.scales[quantity])
        _, *ends = self.curve.brackets(quantity, np.array([wanted]))
        roots = []
        for low, high in zip(*(one.tolist() for one in ends), strict=True):
            u = low if low == high else self._looked_up(quantity, wanted, low, high)
            roots.append(self.curve.searched(quantity, wanted, low, high) if u is None else u)
        return sorted(set(roots))

    def _looked_up(self, quantity: int, wanted: float, low: float, high: float) -> float | None:
        """A root looked up, put right by one integration; None where that is no way."""
        near = self.curve.near(quantity, wanted, low, high)
        if near is None:
            return None
        u, slopes = near
        row = self.curve.rows(np.array([u]))[0]
        step = (wanted - row[quantity]) / slopes[quantity]
        if not abs(step) < _SMALL_STEP:
            return None
        row += slopes * step
        row[quantity] = wanted
        self.found[u + step] = tuple((row + self.scales).tolist())
        return float(u + step)

    def extreme(self, quantity: int) -> tuple[float, float]:
        """The greatest speed or the least time of all, and the rim speed there."""
        u, value = self.curve.extreme(quantity)
        return value + float(self.scales[quantity]), self.at(u)[RIM]

    def ranges(self, fastest: float, widest: float) -> list[tuple[float, float]]:
        """The u, interval by interval, where speed and rim speed are within these bounds."""
        ends = {-math.inf, math.inf}
        for quantity, bound in ((SPEED, fastest), (RIM, widest)):
            if bound < math.inf:
                ends.update(self.all_where(quantity, bound))
        intervals = list(pairwise(sorted(ends)))
        inside = []
        for low, high in intervals:
            speed, rim, _, _ = self.at(between(low, high))
            inside.append(speed <= fastest and rim <= widest)
        return joined(intervals, inside)


def aim_at(
    puck: PuckSpec, target: npt.ArrayLike, *, spin: float | None, speed: float | None,
    stop_time: float | None, max_speed: float | None, max_spin: float | None, count: int,
) -> Aim:  # fmt: skip
    """Launches after which a puck comes to rest at one target: :meth:`puck_tables.Puck.aim`."""
    x, y = finite_array("target", target, "m").tolist()
    r, J = puck.radius, puck.decel
    refuse_both(spin=spin, speed=speed, stop_time=stop_time)
    fastest, widest = checked_bounds(max_speed, max_spin, count)
    none = np.empty(0)
    given = Aim(puck, (x, y), np.empty((0, 2)), none, none, none, "")
    distance = math.hypot(x, y)
    if distance == 0.0:
        return _on_the_spot(given, spin, speed, stop_time)
    if distance == math.inf:
        raise InputError(f"target ({x:g}, {y:g}) m is too far for floating point: use larger units")
    family = _Family(distance, J, launch_curve(puck.body))
    bounds = math.log(fastest), math.log(widest) + math.log(r)
    us: list[float] = []
    senses: tuple[float, ...] = (-1.0, 1.0)
    answer = ""
    if spin is not None:
        wanted = real("spin", spin, "rad/s")
        senses = (math.copysign(1.0, wanted),)
        us = [-math.inf]
        if wanted != 0.0:
            us = _found_roots(family.all_where(RIM, math.log(abs(wanted)) + math.log(r)))
    elif speed is not None:
        us, answer = _met(family, SPEED, positive("speed", speed, "m/s"), r)
    elif stop_time is not None:
        us, answer = _met(family, TIME, positive("stop_time", stop_time, "s"), r)
    else:
        us = sample(family.ranges(*bounds), count)
    allowed = [u for u in us if _within(family, u, bounds)]
    if not allowed and not answer:
        answer = _out_of_bounds(family, us, fastest, widest, r)
    bearing = math.atan2(y, x)
    launches = []
    for u in allowed:
        log_speed, log_rim, log_time, bend = family.at(u)
        v, time = _number(log_speed), _number(log_time)
        turning = _number(log_rim - math.log(r)) if u > -math.inf else 0.0
        for sense in senses if u > -math.inf else (1.0,):
            heading = bearing - sense * bend
            launches.append((sense * turning, v * math.cos(heading), v * math.sin(heading), time))
    return _found(given, launches, answer)


def refuse_both(**wishes: object) -> str | None:
    """The one wish that is there, if any; two are refused."""
    wished = [name for name, value in wishes.items() if value is not None]
    if len(wished) > 1:
        raise InputError(f"{wished[0]} and {wished[1]} both pick a launch: give one of them")
    return wished[0] if wished else None


def checked_bounds(
    max_speed: float | None, max_spin: float | None, count: int
) -> tuple[float, float]:
    """Bounds on speed and spin, infinite where there is none."""
    if not isinstance(count, int) or not 1 <= count <= MAX_COUNT:
        raise InputError(f"count must be a whole number from 1 to {MAX_COUNT}, got {shown(count)}")
    return (
        math.inf if max_speed is None else positive("max_speed", max_speed, "m/s"),
        math.inf if max_spin is None else positive("max_spin", max_spin, "rad/s"),
    )


def _found_roots(us: list[float]) -> list[float]:
    """The same, refused where there is none though there must be one."""
    if not us:
        raise InputError(BEYOND)
    return us


def _met(family: _Family, quantity: int, wanted: float, radius: float) -> tuple[list[float], str]:
    """All u with this speed or stop time, or why there is none."""
    us = family.all_where(quantity, math.log(wanted))
    best, log_rim = family.extreme(quantity)
    if us or (math.log(wanted) > best) != (quantity == SPEED):
        return _found_roots(us), ""
    spin = "no spin"
    if log_rim > -math.inf:
        spin = f"a spin of {_number(log_rim - math.log(radius)):.9g} rad/s either way"
    if quantity == SPEED:
        return [], (
            f"no launch at {wanted:g} m/s stops {family.distance:g} m away: the fastest has "
            f"{_number(best):.9g} m/s and {spin}"
        )
    return [], (
        f"no launch stops {family.distance:g} m away after {wanted:g} s: the quickest takes "
        f"{_number(best):.9g} s and has {spin}"
    )


def _found(given: Aim, launches: list[tuple[float, float, float, float]], answer: str) -> Aim:
    """The aim with its launches (ω, vx, vy, stop time), each integrated for its miss."""
    rows = np.array(sorted(launches)).reshape(-1, 4)
    if not answer:
        answer = f"{len(rows)} launch{'' if len(rows) == 1 else 'es'}"
    found = replace(
        given, launch_velocity=rows[:, 1:3], launch_spin=rows[:, 0], stop_time=rows[:, 3],
        answer=answer,
    )  # fmt: skip
    puck = given.puck
    same = [np.full(len(rows), value) for value in (puck.delta, puck.decel, puck.radius)]
    launched = np.stack([*found.launch_velocity.T, found.launch_spin, *same])
    if not fits(launched, puck.body.longest).all():
        raise InputError(TOO_LARGE)
    target = np.array(found.target)
    return replace(found, miss=misses(puck, target, found.launch_velocity, found.launch_spin))


def _on_the_spot(
    given: Aim, spin: float | None, speed: float | None, stop_time: float | None
) -> Aim:
    """The target is where the puck lies: pure spin stays there, ¾ r|ω|/J for a plain puck."""
    puck = given.puck
    factor = puck.body.spin_time
    if spin is not None:
        wanted = real("spin", spin, "rad/s")
        time = _moderate(puck.radius * abs(wanted) / puck.decel * factor, wanted)
        return _found(given, [(wanted, 0.0, 0.0, time)], "")
    if stop_time is not None:
        time = positive("stop_time", stop_time, "s")
        turning = _moderate(time / factor * puck.decel / puck.radius, time)
        return _found(given, [(s * turning, 0.0, 0.0, time) for s in (-1.0, 1.0)], "")
    if speed is not None:
        return _found(given, [], "no launch with speed comes to rest where it began")
    return _found(given, [], "the target is where the puck lies: any spin alone stays there")


def _moderate(number: float, cause: float) -> float:
    """A number, refused where it left floating point."""
    if not math.isfinite(number) or (number == 0.0 and cause != 0.0):
        raise InputError("radius and decel give a spin out of floating point: use other units")
    return number


def _number(log: float) -> float:
    if not _LEAST_LOG < log < _LARGEST_LOG:
        raise InputError(TOO_LARGE if log > 0.0 else TOO_LARGE.replace("larger", "smaller"))
    return math.exp(log)


def _within(family: _Family, u: float, bounds: tuple[float, float]) -> bool:
    return all(value <= bound + SLACK for value, bound in zip(family.at(u), bounds, strict=False))


def _out_of_bounds(
    family: _Family, us: list[float], fastest: float, widest: float, radius: float
) -> str:
    """Why the bounds leave nothing, in a sentence."""
    if us:
        taken = []
        for u in us:
            log_speed, log_rim, _, _ = family.at(u)
            spin = 0.0 if u == -math.inf else _number(log_rim - math.log(radius))
            taken.append(f"{_number(log_speed):.9g} m/s and {spin:.9g} rad/s")
        return f"the launch asked for takes {' or '.join(taken)}: out of the bounds"
    roots = _found_roots(family.all_where(SPEED, math.log(fastest)))
    log_rim = min(family.at(u)[RIM] for u in roots)
    return (
        f"no launch stops {family.distance:g} m away with at most {fastest:g} m/s and "
        f"{widest:g} rad/s: at {fastest:g} m/s it takes {_number(log_rim - math.log(radius)):.9g} "
        "rad/s"
    )

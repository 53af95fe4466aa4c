"""The inverse problem: which launches come to rest at a given place."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from puck_tables.body import Body, body_of, is_plain
from puck_tables.contact.laws import HOMOGENEOUS, Law
from puck_tables.contact.resultants import checked_delta
from puck_tables.errors import InputError
from puck_tables.puck import positive, real
from puck_tables.real import finite_array
from puck_tables.trajectory import simulate

FloatArray = npt.NDArray[np.float64]

DEFAULT_COUNT = 8
MAX_COUNT = 10_000
_LARGEST_U = 600.0
_SAMPLED_U = math.log(math.tan(math.radians(80.0)))
_SLACK = 1e-12
_LARGEST_LOG = 709.0
_CHECK_TOL = 1e-10
_SLICE_ACCURACY, _SLICE_LOCAL = 1e-9, 1e-12
_SLACK_SLICE = 1e-8
_SCANNED = 481


@dataclass(frozen=True)
class Aim:
    """Launches that come to rest at ``target`` (2,) m from where they start.

    Arrays (n,), ordered by spin, the most clockwise first: ``v0`` (n, 2) m/s, ``w0`` rad/s,
    ``speed`` m/s, ``direction`` rad, ``slip_angle`` φ rad, ``stop_time`` s, and ``miss`` m: how far
    from the target an integration of the launch ends.  ``answer`` is one sentence: what was found,
    or why nothing can be.  ``body``: the kind of puck, None for a homogeneous one under uniform
    pressure with δ ≤ 1.
    """

    target: tuple[float, float]
    delta: float
    decel: float
    radius: float
    v0: FloatArray
    w0: FloatArray
    stop_time: FloatArray
    miss: FloatArray
    answer: str
    body: Body | None = field(default=None, repr=False)

    @property
    def speed(self) -> FloatArray:
        """Launch speed, m/s."""
        return np.hypot(self.v0[:, 0], self.v0[:, 1])

    @property
    def direction(self) -> FloatArray:
        """Of the velocity at the launch, rad."""
        return np.arctan2(self.v0[:, 1], self.v0[:, 0])

    @property
    def slip_angle(self) -> FloatArray:
        """Slip angle atan2(rω, v) at the launch, rad."""
        return np.arctan2(self.radius * self.w0, self.speed)


@dataclass(frozen=True)
class _Family:
    """The launches that stop at distance D, by u = ln(r|ω|/v): one for each u and sense of spin.

    From displacement = (Q²/J) Rot(ψ)(X, Y): Q² = J D/|X + iY|, ψ = bearing − arg(X ± iY).
    """

    distance: float
    delta: float
    decel: float
    body: Body | None = None

    @cached_property
    def _cut(self) -> FloatArray | None:
        """Friction of a puck that is not plain."""
        from puck_tables.sliced import friction_of

        return None if self.body is None else friction_of(self.body, _SLICE_ACCURACY).cut

    def at(self, u: float) -> tuple[float, float, float, float]:
        """Ln of speed, rim speed and stop time, and arg(X + iY) for ω > 0."""
        rows = self.rows(np.array([u]))
        return rows[0, 0], rows[0, 1], rows[0, 2], rows[0, 3]

    def rows(self, u: FloatArray) -> FloatArray:
        """The same at many u (n,), (n, 4)."""
        from puck_tables.similarity.exact import exact_stops, integrated_stops

        heights = np.full(u.size, self.delta)
        if self._cut is None:
            stops = exact_stops(u, heights)
        else:
            stops = integrated_stops(u, heights, self._cut, _SLICE_LOCAL)
        return np.array([self._row(*row) for row in zip(u, *stops[:, :3].T, strict=True)])

    def _row(self, u: float, time: float, x: float, y: float) -> tuple[float, float, float, float]:
        log_q = 0.5 * (math.log(self.decel) + math.log(self.distance) - math.log(math.hypot(x, y)))
        larger = log_q - 0.5 * math.log1p(math.exp(-2.0 * abs(u)))
        speed, rim = larger - max(u, 0.0), larger + min(u, 0.0)
        return speed, rim, log_q + math.log(time) - math.log(self.decel), math.atan2(y, x)

    def all_where(self, quantity: int, value: float) -> list[float]:
        """All u where the speed (0), the rim speed (1) or the stop time (2) has a value.

        Of a plain puck all three are monotonic in u; of tall ones (δ from about 3.5 on, and others)
        speed and stop time may not be, and more than one launch answers.
        """
        if self.body is None or quantity == 1:
            return [self.where(quantity, value)]
        from scipy.optimize import brentq

        target = math.log(value)
        u = np.concatenate([[-_LARGEST_U], np.linspace(-12.0, 12.0, _SCANNED), [_LARGEST_U]])
        off = self.rows(u)[:, quantity] - target
        found = [-math.inf] if abs(off[0]) <= _SLACK_SLICE else []
        for n in np.flatnonzero(off[:-1] * off[1:] < 0.0):
            if n == 0 and found:
                continue
            found.append(float(brentq(
                lambda x: self.at(x)[quantity] - target, u[n], u[n + 1], xtol=1e-13, rtol=1e-14
            )))  # fmt: skip
        return found

    def where(self, quantity: int, value: float) -> float:
        """U where the speed (0), the rim speed (1) or the stop time (2) has a value.

        All three are monotonic in u: speed falls, rim speed and stop time grow.  −∞, a slide
        without spin, where speed or stop time is that of it.
        """
        from scipy.optimize import brentq

        target = math.log(value)

        def difference(u: float) -> float:
            return self.at(u)[quantity] - target

        low, high = difference(-_LARGEST_U), difference(_LARGEST_U)
        if quantity != 1 and abs(low) <= _SLACK:
            return -math.inf
        if low * high > 0.0:
            raise InputError(
                "that takes a launch whose ratio of spin to speed is beyond 1e-260 to 1e260: "
                "out of the range of floating point"
            )
        return float(brentq(difference, -_LARGEST_U, _LARGEST_U, xtol=1e-14, rtol=1e-15))


def aim(
    target: npt.ArrayLike,
    *,
    w0: float | None = None,
    speed: float | None = None,
    stop_time: float | None = None,
    max_speed: float | None = None,
    max_spin: float | None = None,
    count: int = DEFAULT_COUNT,
    delta: float = 0.5,
    decel: float = 1.0,
    radius: float = 1.0,
    pressure: str | Law = "uniform",
    gyration: float = HOMOGENEOUS,
) -> Aim:
    """Launches after which a puck comes to rest at a given displacement.

    They are a family: one for each slip angle and sense of spin.  A spin, a speed or a stop time
    picks one or two of it; without any, a sample is given.

    Parameters
    ----------
    target : (x, y), m from the launch
    w0 : spin wanted, rad/s, with its sign
    speed : launch speed wanted, m/s
    stop_time : duration wanted, s
    max_speed, max_spin : bounds on speed (m/s) and on |spin| (rad/s)
    count : how many slip angles a sample has, for each sense of spin
        Equally spaced from the least spin that ``max_speed`` allows (0 without it) to ``max_spin``
        (without it: to φ = 80°).
    delta : dimensionless height 2fh/r
        Below 3.9637 under uniform pressure, up to the full contact of another law.
    decel, radius : J = fg in m/s² and m, > 0
    pressure, gyration
        As :func:`puck_tables.simulate`.

    Returns
    -------
    Aim
        With no launch, and the reason in ``answer``, where there is none.  Errors of about 1e-12 of
        the distance, 1e-9 for δ > 1 or another kind of puck; every launch is integrated and its
        ``miss`` reported.

    Raises
    ------
    InputError
        If an argument is not finite or outside its range, or two of ``w0``, ``speed`` and
        ``stop_time`` are given.

    Notes
    -----
    Displacement = (Q²/J) Rot(ψ)(X, ±Y)(φ, δ), so at each φ the place fixes Q and ψ.  As φ goes from
    0 to π/2 the speed falls from √(2JD) to 0, spin and stop time grow without bound from 0 and
    √(2D/J), D the distance: each value is met once for each sense of spin.  For tall pucks, δ
    from about 3.5 on, speed and time are not monotonic, and a value may be met three times.

    References
    ----------
    Salnikova, Treschev, Gallyamov 2012, section 2: the symmetry of the motion.

    Examples
    --------
    >>> found = aim((2.0, 0.1), w0=5.0)
    >>> found.v0.round(6).tolist(), found.stop_time.round(6).tolist()
    ([[0.899671, 0.109151]], [3.927704])
    """
    place = finite_array("target", target, "m")
    if place.shape != (2,):
        raise InputError(f"target must be one place (x, y) in m, got shape {place.shape}")
    x, y = place.tolist()
    r, J = positive("radius", radius, "m"), positive("decel", decel, "m/s^2")
    height = float(checked_delta(real("delta", delta, "dimensionless")))
    plain = is_plain(pressure, gyration, height)
    body = None if plain else body_of(pressure, height, gyration)
    wishes = {"w0": w0, "speed": speed, "stop_time": stop_time}
    wished = [name for name, value in wishes.items() if value is not None]
    if len(wished) > 1:
        raise InputError(f"{wished[0]} and {wished[1]} both pick a launch: give one of them")
    fastest = math.inf if max_speed is None else positive("max_speed", max_speed, "m/s")
    widest = math.inf if max_spin is None else positive("max_spin", max_spin, "rad/s")
    if not isinstance(count, int) or not 1 <= count <= MAX_COUNT:
        raise InputError(f"count must be a whole number from 1 to {MAX_COUNT}, got {count!r}")
    none = np.empty(0)
    given = Aim((x, y), height, J, r, np.empty((0, 2)), none, none, none, "", body)
    distance = math.hypot(x, y)
    if distance == 0.0:
        return _on_the_spot(given, w0, speed, stop_time)
    family = _Family(distance, height, J, body)
    slide = math.sqrt(2.0) * math.sqrt(J) * math.sqrt(distance)
    quickest = math.sqrt(2.0) * math.sqrt(distance) / math.sqrt(J)
    us: list[float] = []
    senses: tuple[float, ...] = (-1.0, 1.0)
    answer = ""
    if w0 is not None:
        spin = real("w0", w0, "rad/s")
        senses = (math.copysign(1.0, spin),)
        us = [-math.inf if spin == 0.0 else family.where(1, r * abs(spin))]
    elif speed is not None:
        wanted = positive("speed", speed, "m/s")
        if wanted <= slide * (1.0 + _SLACK):
            us = family.all_where(0, wanted)
        else:
            answer = (
                f"no launch at {wanted:g} m/s stops {distance:g} m away: the fastest has "
                f"{slide:.9g} m/s and no spin"
            )
    elif stop_time is not None:
        wanted = positive("stop_time", stop_time, "s")
        if wanted >= quickest * (1.0 - _SLACK):
            us = family.all_where(2, wanted)
        else:
            answer = (
                f"no launch stops {distance:g} m away after {wanted:g} s: the quickest takes "
                f"{quickest:.9g} s and has no spin"
            )
    else:
        least = -math.inf if fastest >= slide else family.where(0, fastest)
        most = family.where(1, r * widest) if widest < math.inf else max(least + 1.0, _SAMPLED_U)
        if least <= most:
            first, last = np.arctan(np.exp([least, most])).tolist()
            with np.errstate(divide="ignore"):
                us = np.log(np.tan(np.linspace(first, last, count))).tolist()
    allowed = [u for u in us if _within(family, u, fastest, r * widest)]
    if not allowed and not answer:
        answer = _out_of_bounds(family, us, fastest, widest, r)
    bearing = math.atan2(y, x)
    launches = []
    for u in allowed:
        log_speed, log_rim, log_time, bend = family.at(u)
        v, spin, time = _number(log_speed), _number(log_rim) / r, _number(log_time)
        for sense in senses if u > -math.inf else (1.0,):
            heading = bearing - sense * bend
            launches.append((sense * spin, v * math.cos(heading), v * math.sin(heading), time))
    return _found(given, launches, answer)


def _found(given: Aim, launches: list[tuple[float, float, float, float]], answer: str) -> Aim:
    """The aim with its launches (ω, vx, vy, stop time), each integrated for its miss."""
    rows = np.array(sorted(launches)).reshape(-1, 4)
    miss = np.array([_miss(row, given) for row in rows])
    if not answer:
        answer = f"{len(rows)} launch{'' if len(rows) == 1 else 'es'}"
    return replace(
        given, v0=rows[:, 1:3], w0=rows[:, 0], stop_time=rows[:, 3], miss=miss, answer=answer
    )


def _on_the_spot(given: Aim, w0: float | None, speed: float | None, stop_time: float | None) -> Aim:
    """The target is where the puck lies: pure spin stays there, ¾ r|ω|/J for a plain puck."""
    turning = given.radius / given.decel * (0.75 if given.body is None else given.body.spin_time)
    if w0 is not None:
        spin = real("w0", w0, "rad/s")
        return _found(given, [(spin, 0.0, 0.0, turning * abs(spin))], "")
    if stop_time is not None:
        time = positive("stop_time", stop_time, "s")
        return _found(given, [(s * time / turning, 0.0, 0.0, time) for s in (-1.0, 1.0)], "")
    if speed is not None:
        return _found(given, [], "no launch with speed comes to rest where it began")
    return _found(given, [], "the target is where the puck lies: any spin alone stays there")


def _number(log: float) -> float:
    if log > _LARGEST_LOG:
        raise InputError(
            "target and decel ask for launches too large for floating point: use larger units"
        )
    return math.exp(log)


def _within(family: _Family, u: float, fastest: float, widest: float) -> bool:
    log_speed, log_rim, _, _ = family.at(u)
    return (
        _number(log_speed) <= fastest * (1.0 + _SLACK)
        and _number(log_rim) <= widest * (1.0 + _SLACK)
    )  # fmt: skip


def _out_of_bounds(
    family: _Family, us: list[float], fastest: float, widest: float, radius: float
) -> str:
    """Why the bounds leave nothing, in a sentence."""
    if us:
        log_speed, log_rim, _, _ = family.at(us[0])
        return (
            f"the launch asked for takes {_number(log_speed):.9g} m/s and "
            f"{_number(log_rim) / radius:.9g} rad/s: out of the bounds"
        )
    _, log_rim, _, _ = family.at(family.where(0, fastest))
    return (
        f"no launch stops {family.distance:g} m away with at most {fastest:g} m/s and "
        f"{widest:g} rad/s: at {fastest:g} m/s it takes {_number(log_rim) / radius:.9g} rad/s"
    )


def kind_of_puck(found: Aim) -> dict[str, Any]:
    """Pressure law and radius of gyration of an aim, as the other functions take them."""
    if found.body is None:
        return {}
    return {"pressure": found.body.law, "gyration": found.body.gyration}


def _miss(launch: FloatArray, given: Aim) -> float:
    """How far from the target the integrated motion ends."""
    w0, vx, vy, _ = launch.tolist()
    run = simulate(
        (vx, vy), w0, delta=given.delta, decel=given.decel, radius=given.radius, frames=1,
        tol=_CHECK_TOL if given.body is None else _SLICE_ACCURACY, **kind_of_puck(given),
    )  # fmt: skip
    return math.dist(run.stop_position, given.target)

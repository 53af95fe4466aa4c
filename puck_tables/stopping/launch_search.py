"""The launches that come to rest at targets, on the curve of all that stop at one distance.

From displacement = (Q²/J) Rot(ψ)(X, Y): Q² = J D/|X + iY|, ψ = bearing − arg(X ± iY), D the way.
Speeds are √(JD), times √(D/J) and angles D/r times those of the curve
(:mod:`puck_tables.stopping.launch_family`); all here are logarithms.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.errors import InputError
from puck_tables.motion.friction_source import source_of
from puck_tables.motion.puck_spec import PuckSpec
from puck_tables.motion.unit_motion import direction
from puck_tables.stopping.aim_lookup import DEFLECTION, RIM, SPEED, TIME, TURN  # two are bounded
from puck_tables.stopping.exact import integrated_stops
from puck_tables.stopping.launch_arrays import fits
from puck_tables.stopping.launch_family import (
    SECTION_ACCURACY,
    SLIDE_ROW,
    LaunchFamily,
    launch_family_of,
)

QUANTITIES = {"spin": RIM, "speed": SPEED, "stop_time": TIME, "angle": TURN}
OF, SPIN, VX, VY, STOP_TIME, ANGLE = range(6)  # columns of launches that were found
_SAMPLED_U = math.log(math.tan(math.radians(80.0)))  # as far as is sampled without a bound
_SLACK = 1e-11  # relative: a bound as printed, or rounded, is met
_LARGEST_LOG = 708.0  # exp of it is still a number
_CHECK_LOCAL = 1e-11  # of a step: finer than an answer, and another than it was found with
_BEYOND = (
    "that takes a launch whose ratio of spin to speed is beyond 1e-260 to 1e260: "
    "out of the range of floating point"
)
_TOO_LARGE = (
    "target, decel and radius ask for launches out of the range of floating point: use larger units"
)


@dataclass(frozen=True)
class LaunchSearch:
    """Launches to targets: ``wished`` picks some of each family, within ``bounds``.

    ``bounds``: the largest speed and spin, infinite where there is none; ``count``: how many slip
    angles a sample has, or how many numbers of whole turns are tried for each sense of spin.
    """

    puck: PuckSpec
    wished: str | None
    bounds: tuple[float, float]
    count: int

    @cached_property
    def family(self) -> LaunchFamily:
        """Of the puck."""
        return launch_family_of(self.puck.body)

    @property
    def _limits(self) -> FloatArray:
        """Ln of the largest speed and rim speed."""
        fastest, widest = self.bounds
        return np.array([math.log(fastest), math.log(widest) + math.log(self.puck.radius)])

    def _scales(self, distance: FloatArray) -> FloatArray:
        """Of speed, rim speed, time and angle (n, 5); 0 for the direction."""
        half_d, half_j = 0.5 * np.log(distance), 0.5 * math.log(self.puck.decel)
        fast, turn = half_j + half_d, 2.0 * half_d - math.log(self.puck.radius)
        return np.stack([fast, fast, half_d - half_j, turn, 0.0 * half_d], axis=1)

    def launches(self, places: FloatArray, wanted: FloatArray, distance: FloatArray) -> FloatArray:
        """Rows (m, 6) of launches to targets (n, 2): of which, ω, vx, vy, stop time, body angle."""
        puck, away, limits = self.puck, np.flatnonzero(distance > 0.0), self._limits
        which, sense, logs = self._of_both_senses(self._scales(distance[away]), wanted[away])
        if min(self.bounds) < math.inf:
            good = (logs[:, :TIME] <= limits + _SLACK).all(axis=1)
            which, sense, logs = which[good], sense[good], logs[good]
            logs[:, :TIME] = np.minimum(logs[:, :TIME], limits)
        of = away[which]
        speed, turning, time = _numbers(logs[:, :TURN] - [0.0, math.log(puck.radius), 0.0]).T
        heading = np.arctan2(places[of, 1], places[of, 0]) - sense * logs[:, DEFLECTION]
        rows = np.empty((of.size, ANGLE + 1))
        rows[:, OF], rows[:, SPIN], rows[:, STOP_TIME] = of, sense * turning, time
        with np.errstate(over="ignore"):  # then the launch does not fit either
            rows[:, ANGLE] = sense * np.exp(logs[:, TURN])
        rows[:, VX], rows[:, VY] = speed * np.cos(heading), speed * np.sin(heading)
        if away.size < distance.size:
            rows = np.concatenate([rows, self._on_the_spot(distance, wanted)])
        rows += 0.0  # no negative zero
        result = np.empty((6, len(rows)))
        result[:3] = rows[:, [VX, VY, SPIN]].T
        result[3], result[4], result[5] = puck.delta, puck.decel, puck.radius
        if not fits(result, puck.body.longest).all():
            raise InputError(_TOO_LARGE)
        return rows[np.lexsort((rows[:, SPIN], rows[:, OF]))]

    def _of_both_senses(
        self, scales: FloatArray, wanted: FloatArray
    ) -> tuple[npt.NDArray[Any], FloatArray, FloatArray]:
        """Of which target, the sense of spin ±1, and the logarithms of all that are wished."""
        if self.wished == "angle":
            return self._turned(scales, wanted)
        which, logs = self._logs(scales, wanted)
        if self.wished == "spin":
            return which, np.copysign(1.0, wanted[which]), logs
        # both, but of the slide without spin
        spins = np.flatnonzero(logs[:, RIM] > -math.inf)
        sense = np.repeat((-1.0, 1.0), (spins.size, which.size))
        each = np.concatenate([spins, np.arange(which.size)])
        return which[each], sense, logs[each]

    def _turned(
        self, scales: FloatArray, wanted: FloatArray
    ) -> tuple[npt.NDArray[Any], FloatArray, FloatArray]:
        """Launches that end at an angle of the body: of each sense the fewest whole turns first.

        The slower a launch the more it turns, so that a largest speed says the fewest.
        """
        fewest, top = np.zeros(len(scales)), self._limits[SPEED]
        if top < math.inf:
            of, _, rows = self.family.roots(SPEED, top - scales[:, SPEED])
            least = np.full(len(scales), math.inf)
            np.minimum.at(least, of, np.exp(rows[:, TURN] + scales[of, TURN]))
            fewest = np.where(least < math.inf, least, 0.0) * (1.0 - 1e-9)
        roots = []
        for sense in (-1.0, 1.0):
            first = np.mod(sense * wanted, 2.0 * math.pi)
            first += 2.0 * math.pi * np.maximum(np.ceil((fewest - first) / (2.0 * math.pi)), 0.0)
            turns = (first[:, None] + 2.0 * math.pi * np.arange(self.count)).ravel()
            each = np.repeat(np.arange(len(scales)), self.count)
            with np.errstate(divide="ignore"):
                log = np.log(turns)
            which, _, rows = self.family.roots(TURN, log - scales[each, TURN])
            logs = rows + scales[each[which]]
            logs[:, TURN] = log[which]
            roots.append((each[which], np.full(which.size, sense), logs))
            if sense > 0.0:  # no turn at all: the slide without spin, which has no sense
                still = each[turns == 0.0]
                slides = np.tile(SLIDE_ROW, (still.size, 1)) + scales[still]
                roots.append((still, np.ones(still.size), slides))
        which, senses, logs = (np.concatenate(one) for one in zip(*roots, strict=True))
        return which, senses, logs

    def _logs(self, scales: FloatArray, wanted: FloatArray) -> tuple[npt.NDArray[Any], FloatArray]:
        """Of which target, and ln v, ln r|ω|, ln t₀, ln θ and arg Z, of all that are wished."""
        if self.wished is None:
            which, u = self._sampled(scales)
            return which, self.family.looked_up(u) + scales[which]
        quantity = QUANTITIES[self.wished]
        with np.errstate(divide="ignore"):
            log = np.log(np.abs(wanted))
        log += math.log(self.puck.radius) if quantity == RIM else 0.0
        values = log - scales[:, quantity]
        which, _, rows = self.family.roots(quantity, values)
        none = np.bincount(which, minlength=wanted.size) == 0
        if quantity == RIM:
            still = np.flatnonzero(wanted == 0.0)
            if still.size:
                none[still] = False
                which = np.append(which, still)
                rows = np.concatenate([rows, np.tile(SLIDE_ROW, (still.size, 1))])
        else:
            best = self.family.extreme(quantity)[1]
            none &= (values > best) != (quantity == SPEED)
        if none.any():
            raise InputError(_BEYOND)
        logs = rows + scales[which]
        logs[:, quantity] = log[which]
        return which, logs

    def _sampled(self, scales: FloatArray) -> tuple[npt.NDArray[Any], FloatArray]:
        """A sample of the family of each target: of which, and u."""
        n, limits = len(scales), self._limits
        if not np.isfinite(limits).any():  # of all the same
            one = np.array(sample([(-math.inf, math.inf)], self.count))
            return np.repeat(np.arange(n), one.size), np.tile(one, n)
        ends: list[set[float]] = [{-math.inf, math.inf} for _ in range(n)]
        for quantity, limit in zip((SPEED, RIM), limits.tolist(), strict=True):
            of, u, _ = self.family.roots(quantity, limit - scales[:, quantity])
            for target, end in zip(of.tolist(), u.tolist(), strict=True):
                ends[target].add(end)
        intervals = [list(pairwise(sorted(one))) for one in ends]
        middles = np.array([between(*one) for some in intervals for one in some])
        sizes = [len(some) for some in intervals]
        logs = self.family.looked_up(middles) + np.repeat(scales, sizes, axis=0)
        inside = iter(np.all(logs[:, :TIME] <= limits, axis=1).tolist())
        us = [
            sample(concatenated(some, [next(inside) for _ in some]), self.count)
            for some in intervals
        ]
        which = np.repeat(np.arange(n), [len(one) for one in us])
        return which, np.array([u for one in us for u in one])

    def _on_the_spot(self, distance: FloatArray, wanted: FloatArray) -> FloatArray:
        """Launches to targets where the puck lies: pure spin stays, ¾ r|ω|/J for a plain puck."""
        if self.wished not in ("spin", "stop_time", "angle"):
            return np.empty((0, ANGLE + 1))
        which = np.flatnonzero(distance == 0.0)
        puck, limits = self.puck, wanted[which]
        slowing = puck.decel / puck.radius / puck.body.spin_time  # rad/s², evenly
        with np.errstate(over="ignore", under="ignore", invalid="ignore"):
            if self.wished == "spin":
                turning = limits
            elif self.wished == "stop_time":
                which, turning = np.repeat(which, 2), np.repeat(limits * slowing, 2)
                turning *= np.tile([-1.0, 1.0], limits.size)
            else:
                sense = np.array([-1.0, 1.0])[:, None]
                first = np.mod(sense * limits[:, None, None], 2.0 * math.pi)
                turns = (sense * (first + 2.0 * math.pi * np.arange(self.count))).ravel()
                which = np.repeat(which, 2 * self.count)
                turning = np.copysign(np.sqrt(2.0 * slowing * np.abs(turns)), turns)
            time = np.abs(turning) / slowing
            angle = 0.5 * turning * time
        if not (np.isfinite(turning + time) & ((turning == 0.0) == (time == 0.0))).all():
            raise InputError("radius and decel give a spin out of floating point: use other units")
        rows = np.stack([which, turning, 0.0 * time, 0.0 * time, time, angle], axis=1)
        return rows[np.abs(turning) <= self.bounds[1] * (1.0 + _SLACK)]

    def reason(self, wanted: FloatArray, distance: FloatArray) -> str:
        """Why no launch leads to the one target, in a sentence."""
        if distance[0] == 0.0:
            if self.wished is None:
                return "the target is where the puck lies: any spin alone stays there"
            if self.wished == "speed":
                return "no launch with speed comes to rest where it began"
            return f"the spin that is asked for is above the bound of {self.bounds[1]:g} rad/s"
        scales, (fastest, widest) = self._scales(distance), self.bounds
        if self.wished is None:
            _, _, rows = self.family.roots(SPEED, math.log(fastest) - scales[:, SPEED])
            if not rows.size:
                raise InputError(_BEYOND)
            return (
                f"no launch stops {distance[0]:g} m away with at most {fastest:g} m/s and "
                f"{widest:g} rad/s: at {fastest:g} m/s it takes "
                f"{self._spin(rows[:, RIM].min() + scales[0, RIM]):.9g} rad/s"
            )
        _, _, logs = self._of_both_senses(scales, wanted)
        if logs.size:
            least = logs[np.unique(logs[:, RIM], return_index=True)[1][:2]]
            taken = " or ".join(
                f"{_numbers(row[SPEED]):.9g} m/s and {self._spin(row[RIM]):.9g} rad/s"
                for row in least
            )
            return f"the launch asked for takes {taken}: out of the bounds"
        quantity = QUANTITIES[self.wished]
        u, _ = self.family.extreme(quantity)
        row = self.family.looked_up(np.array([u]))[0] + scales[0]
        spin = "no spin"
        if u > -math.inf:
            spin = f"a spin of {self._spin(row[RIM]):.9g} rad/s either way"
        if quantity == SPEED:
            return (
                f"no launch at {wanted[0]:g} m/s stops {distance[0]:g} m away: the fastest has "
                f"{_numbers(row[SPEED]):.9g} m/s and {spin}"
            )
        return (
            f"no launch stops {distance[0]:g} m away after {wanted[0]:g} s: the quickest takes "
            f"{_numbers(row[TIME]):.9g} s and has {spin}"
        )

    def _spin(self, log_rim: float) -> FloatArray:
        return _numbers(log_rim - math.log(self.puck.radius))


def _numbers(logs: npt.ArrayLike) -> FloatArray:
    """Numbers from logarithms, refused where they leave floating point; −∞ is 0."""
    logs = np.asarray(logs)
    if (logs >= _LARGEST_LOG).any():
        raise InputError(_TOO_LARGE)
    if ((logs <= -_LARGEST_LOG) & (logs > -math.inf)).any():
        raise InputError(_TOO_LARGE.replace("larger", "smaller"))
    numbers: FloatArray = np.exp(logs)
    return numbers


def between(low: float, high: float) -> float:
    """A u inside an interval, one end of which may be infinite, or both.

    >>> between(-math.inf, 1.0), between(0.0, 1.0)
    (-0.5, 0.5)
    """
    return 0.5 * (max(low, min(high, 0.0) - 2.0) + min(high, max(low, 0.0) + 2.0))


def concatenated(
    intervals: list[tuple[float, float]], inside: list[bool]
) -> list[tuple[float, float]]:
    """The intervals that are inside, neighbours as one.

    >>> concatenated([(0.0, 1.0), (1.0, 2.0), (2.0, 3.0)], [True, True, False])
    [(0.0, 2.0)]
    """
    within: list[tuple[float, float]] = []
    for (low, high), one in zip(intervals, inside, strict=True):
        if one:
            follows = within and within[-1][1] == low
            within[-1:] = [(within[-1][0], high)] if follows else [*within[-1:], (low, high)]
    return within


def sample(ranges: list[tuple[float, float]], count: int) -> list[float]:
    """Equally spaced slip angles, as u: each range of u has its share of them, at least one.

    >>> [round(u, 3) for u in sample([(-math.inf, 0.0), (1.0, math.inf)], 5)]
    [-inf, -1.317, -0.549, 0.0, 1.0]
    """
    if not ranges:
        return []
    ends = [(low, high if high < math.inf else max(low + 1.0, _SAMPLED_U)) for low, high in ranges]
    angles = [(math.atan(math.exp(low)), math.atan(math.exp(high))) for low, high in ends]
    shares = [1] * len(ranges)
    for _ in range(count - len(ranges)):
        densest = max(range(len(ranges)), key=lambda n: (angles[n][1] - angles[n][0]) / shares[n])
        shares[densest] += 1
    us: list[float] = []
    for (low, high), (first, last), share in zip(ends, angles, shares, strict=True):
        inner = np.log(np.tan(np.linspace(first, last, share)[1:-1])).tolist()
        us += [low, *inner, high] if share > 1 else [low]  # the ends to the last digit
    return us


def misses(
    puck: PuckSpec, target: FloatArray, velocity: FloatArray, spin: FloatArray,
    threads: int | None = None,
) -> FloatArray:  # fmt: skip
    """How far from its target (n, 2) or (2,) the integrated motion of each launch ends, (n,) m.

    From the launches as they are given.  Friction of a plain puck is that of the table, where
    launches are found with closed forms or with the table of stops.

    >>> from puck_tables import Puck
    >>> puck = Puck.similar(delta=0.0)
    >>> slide = np.array([[1.0, 0.0]]), np.zeros(1)  # stops after half a metre
    >>> misses(puck, np.array([0.5, 0.1]), *slide).round(9).tolist()
    [0.1]
    """
    coefficients = source_of(puck.body).friction(SECTION_ACCURACY).coefficients
    place = np.broadcast_to(target[..., 0] + 1j * target[..., 1], spin.shape)
    distance, miss = np.abs(place), np.zeros(spin.size)
    moved = distance > 0.0  # pure spin stays where it is
    distance, velocities, turning = distance[moved], velocity[moved], spin[moved]
    with np.errstate(divide="ignore"):
        speed = np.log(np.hypot(*velocities.T))
        rim = np.log(np.abs(turning)) + math.log(puck.radius)
    u = rim - speed
    heights = np.full(u.size, puck.delta)
    stops = integrated_stops(u, heights, coefficients, _CHECK_LOCAL, direction(u)[0], threads)
    log_q = np.maximum(speed, rim) + 0.5 * np.log1p(np.exp(-2.0 * np.abs(u)))
    displacement = stops[:, 1] + 1j * np.copysign(1.0, turning) * stops[:, 2]
    # logarithms: Q²/J may be far larger than the distance
    scale = 2.0 * log_q - math.log(puck.decel) - np.log(distance)
    displacement *= np.exp(scale + 1j * np.arctan2(velocities[:, 1], velocities[:, 0]))
    miss[moved] = distance * np.abs(displacement - place[moved] / distance)
    return miss

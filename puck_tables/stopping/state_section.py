"""States of many pucks of one kind, looked up: the motion itself over the slip angle.

Along every motion ln Q and the heading ψ are functions of φ alone, up to a constant.  With
u = ln tan φ, c = cos φ, s = sin φ, the friction ratio σ = (r²/2k²) ρ_ω/ρ_∥, N = 1/(c² + s² σ),

    du/d ln Q = −ρ,    ρ = (1 − σ) N,    dψ/d ln Q = h = s (ρ_⊥/ρ_∥) N,

they have poles at the limit φ₀ and run straight at both ends; what is left is bounded,

    ln Q = (1/κ) ln|s² − s₀²| − (1/A) ln s − (1/B) ln c + R,
    ψ = h₀ ln Q + (h₀/A) ln s + ((h₀ − h₁)/B) ln c + S,

κ = −dρ/du at φ₀, A = ρ(0), B = −ρ(π/2), h₁ = h(π/2).  Motions that end in pure sliding or in pure
spin have no φ₀: 1/κ = h₀ = 0.  R and S stand beside the functions of a stop on the axis of the stop
section.  The time that is left is Q T: a state is where ln Q + ln T has fallen as far as its
logarithm.  For a motion from one end, pure sliding or pure spin, to its limit, with m the square of
sin φ or cos φ there, in

    x = ln(s²/(m − s²))    or    ln(c²/(m − c²))

it falls like −x/2A (or −x/2B) first and like −x/κ last: secants in a bracket find its place in a
few steps.  (Plain pucks have closed forms, by which both parts go on smoothly across φ₀ and the
inverse stands in a table: :mod:`puck_tables.stopping.similarity`.)

Source: Salnikova, Treschev, Gallyamov 2012, eq. 6.2–6.7, where the motion is found in quadratures.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import numpy.typing as npt
from scipy.optimize import brentq

from puck_tables._core.arrays import FloatArray
from puck_tables.errors import AccuracyError
from puck_tables.kernels.compile import inlined, look_up, patience, weighted_rows
from puck_tables.kernels.quadratic import LINE, basis
from puck_tables.motion.body import UnitPuck
from puck_tables.motion.path import TURN_SHARE
from puck_tables.motion.state import HEADING, SPEED, STATE_ROWS
from puck_tables.stopping.launch_arrays import in_chunks
from puck_tables.stopping.similarity_lookup import state_at_one_angle, state_there
from puck_tables.stopping.state_values import TOL, directions, integrate, states_of
from puck_tables.stopping.stop_section import StopSection, place_of, stop_section_for
from puck_tables.table.friction_section import FrictionSection
from puck_tables.table.slip_spline import SlipSpline

MANY = 1500  # launches of one height from which on splines cost less than integrating each
_STOPS, _OF_FRICTION = 4e-10, 0.1  # accuracy of the stops that states are read from; of that
_STEP = 1e-3  # of φ, in differences for the slope at the limit
_STEEP = 1e-2  # of A and B: motions that hardly leave an end are integrated
_GAUSS_NODES, _GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(8)  # a cell
_SAMPLE, _NEARBY = 16, 10.0 ** -np.arange(1.0, 8.0, 2.0)  # slip angles that are tried
_SHARES = np.array([0.02, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99])  # of the way to the stop, when
_FINER = 0.1  # than these, what they are held against
_OF_STOPS = [0, 1, 2, 4]  # time, along, across, body angle
_FUNCTIONS = 6  # these, R and S
# of the constants
_SLOW, _FAST, _LAST, _BY_SLOW, _BY_FAST, _TURNING, _TURN_SLOW, _TURN_FAST = range(8)
# of ln Q, as good as there; before the last secant; secants at most
_ROUNDED, _CLOSE, _MOST = 1e-12, 1e-8, 80
_LEAST = 1e-300  # its logarithm is a number
_FALLEN = -math.log(TURN_SHARE)  # ln Q, when the heading of a puck at rest is read


@dataclass(frozen=True)
class StateSection:
    """The motions of one kind of puck.

    ``coefficients``: splines over φ of T, X/cos φ, Y/(sin φ cos φ), body angle/sin φ, R and S;
    ``constants``: array (8,): m of motions from pure sliding and from pure spin, 1/κ, 1/2A, 1/2B,
    h₀, h₀/2A, (h₀ − h₁)/2B.
    """

    coefficients: FloatArray
    constants: FloatArray

    def states(
        self, launches: FloatArray, which: npt.NDArray[np.int64], moments: FloatArray,
        threads: int | None = None,
    ) -> FloatArray:  # fmt: skip
        """States (6, n) of launches (6, m), ``which`` (n,) at ``moments`` (n,); headings from x."""
        out, towards = np.empty((STATE_ROWS, moments.size)), directions(launches[0], launches[1])

        def work(start: int, stop: int) -> None:
            part = slice(start, stop)
            fill_section_states(
                launches, which[part], moments[part], self.coefficients, self.constants,
                out[:, part],
            )  # fmt: skip

        in_chunks(work, moments.size, threads)
        out[HEADING] += towards[which]
        return out


@lru_cache(maxsize=64)
def state_section(body: UnitPuck) -> StateSection | None:
    """The motions of a puck; None where splines are not good to 1e-9: there it is integrated.

    So it is at a line of the friction that is the limit of the motion, and where motions hardly
    leave pure sliding or pure spin.

    >>> from puck_tables.motion.body import body_of
    >>> section = state_section(body_of("uniform", 0.5, 0.3))
    >>> launch = np.array([[1.0], [0.0], [1.0], [0.5], [1.0], [1.0]])
    >>> section.states(launch, np.array([0]), np.array([0.5]))[:2, 0].round(6).tolist()
    [0.384492, -0.007863]
    """
    try:
        stops = stop_section_for(body, _STOPS)
        friction = body.friction(_OF_FRICTION * _STOPS)
        poles = _Poles(friction, body)
        parts = poles.regular_parts(stops.axis.nodes())
        values = np.concatenate([stops.values[:, _OF_STOPS], parts], axis=1)
        spline = SlipSpline(stops.axis.sides, stops.axis.by_side(values), False)
        section = StateSection(spline.coefficients, poles.constants)
        return section if _missed(section, body, stops, friction.lines) <= TOL else None
    except AccuracyError:
        return None


def _missed(
    section: StateSection, body: UnitPuck, stops: StopSection, lines: tuple[float, ...]
) -> float:
    """How far states are off integrated ones: over all φ, and next to what is singular."""
    near = np.outer([-1.0, 1.0], _NEARBY)
    singular = np.array([0.0, *lines, math.atan(body.limit_ratio), 0.5 * np.pi])
    phi = np.append(np.linspace(0.0, 0.5 * np.pi, _SAMPLE), singular[:, None, None] + near)
    phi = phi[(phi > 0.0) & (phi < 0.5 * np.pi)]
    cosine, sine, one = np.cos(phi), np.sin(phi), np.ones(phi.size)
    launches = np.stack([cosine, 0.0 * one, sine, body.delta * one, one, one])
    worst = 0.0
    for n, end in enumerate(stops.spline.at(phi)[:, 0]):
        moments, which = end * _SHARES, np.full(_SHARES.size, n)
        truth = states_of(body, launches[:, n], moments, _FINER * TOL)
        off = np.abs(section.states(launches, which, moments, 1) - truth)
        off[HEADING] *= truth[SPEED]
        worst = max(worst, float(off.max()))
    return worst


class _Poles:
    """Poles and regular parts of ln Q and the heading, by the friction of a puck."""

    def __init__(self, friction: FrictionSection, body: UnitPuck) -> None:
        self._friction, self._factor = friction, 0.5 / body.inertia
        (_, _, slow), (_, across, fast) = friction.at_ends() * [1.0, 1.0, self._factor]
        self._slow, self._fast, self._end_turn = 1.0 - slow, 1.0 - 1.0 / fast, across / fast
        self._limit = self._one_limit = self._turning = 0.0
        at_line = np.isinf(friction.for_motion(body.gyration)[:, LINE]).any()
        if at_line or min(abs(self._slow), abs(self._fast)) < _STEEP:
            raise AccuracyError("such motions are integrated")
        if self._slow > 0.0 and self._fast > 0.0:
            self._find_limit(math.atan(body.limit_ratio))

    def _find_limit(self, near: float) -> None:
        """Where the spline itself says that φ stays, and how steeply it is drawn there."""

        def spin(phi: float) -> float:
            return self._factor * float(self._friction.ratios(np.array([phi]))[0, 2]) - 1.0

        if not spin(near - _STEP) * spin(near + _STEP) < 0.0:
            raise AccuracyError("such motions are integrated")
        self._limit = float(brentq(spin, near - _STEP, near + _STEP, xtol=1e-15))
        at = self._limit + _STEP * np.array([-2.0, -1.0, 1.0, 2.0])
        by_phi = self._factor * self._friction.ratios(at)[:, 2] @ [1.0, -8.0, 8.0, -1.0]
        cosine, sine = math.cos(self._limit), math.sin(self._limit)
        self._one_limit = 12.0 * _STEP / (cosine * sine * float(by_phi))
        self._turning = sine * float(self._friction.ratios(np.array([self._limit]))[0, 1])

    @property
    def constants(self) -> FloatArray:
        """What a :class:`StateSection` holds of them, (8,)."""
        h0, by_slow, by_fast = self._turning, 0.5 / self._slow, 0.5 / self._fast
        shares = math.sin(self._limit) ** 2 or 1.0, math.cos(self._limit) ** 2
        turns = h0, h0 * by_slow, (h0 - self._end_turn) * by_fast
        return np.array([*shares, self._one_limit, by_slow, by_fast, *turns])

    def _slopes(self, phi: FloatArray) -> FloatArray:
        """dR/dφ and dS/dφ at slip angles (n,), (n, 2)."""
        c, s = np.cos(phi), np.sin(phi)
        _, across, spin = (self._friction.ratios(phi) * [1.0, 1.0, self._factor]).T
        below = c * c + s * s * spin
        by_phi = below / ((1.0 - spin) * (s * c))  # −d ln Q/dφ
        at_ends = c / (s * self._slow), s / (c * self._fast)
        slip = at_ends[0] - at_ends[1] - by_phi
        if self._one_limit:
            apart = np.sin(phi - self._limit) * np.sin(phi + self._limit)
            slip -= self._one_limit * (2.0 * s * c / apart)
        h0 = self._turning
        turn = (h0 - s * across / below) * by_phi - h0 * at_ends[0]
        return np.stack([slip, turn + (h0 - self._end_turn) * at_ends[1]], axis=1)

    def regular_parts(self, phi: FloatArray) -> FloatArray:
        """R and S at ascending slip angles (n,), 0 at the first, (n, 2).

        What rounding adds where the limit is passed is the same for all beyond: no motion passes.
        """
        half = 0.5 * np.diff(phi)[:, None]
        at = phi[:-1, None] + half * (1.0 + _GAUSS_NODES)
        slopes = self._slopes(at.ravel()).reshape(*at.shape, 2)
        cells = (slopes * (half * _GAUSS_WEIGHTS)[:, :, None]).sum(axis=1)
        return np.concatenate([np.zeros((1, 2)), np.cumsum(cells, axis=0)])


@inlined
def _logs(x: float, share: float) -> tuple[float, float, float]:
    """Ln of the smaller square, of the other one and of |s² − s₀²| at x; ``share``: m."""
    log_apart = math.log(share) - max(x, 0.0) - math.log1p(math.exp(-abs(x)))
    other = (1.0 - share) + math.exp(log_apart)
    return log_apart + x, math.log(other) if share < 1.0 else log_apart, log_apart


@inlined
def _place_at(
    x: float, is_fast: bool, section: FloatArray, constants: FloatArray
) -> tuple[float, float, float, float, float, float, float, float, float]:
    """Ln Q, ln Q + ln T, the heading at x; cos φ and sin φ; T, along, across, body angle."""
    smaller, other, apart = _logs(x, constants[_FAST] if is_fast else constants[_SLOW])
    log_c2, log_s2 = (smaller, other) if is_fast else (other, smaller)
    cosine, sine = math.exp(0.5 * log_c2), math.exp(0.5 * log_s2)
    side, i, place = place_of(cosine, sine, section, _FUNCTIONS)
    time, along, across, body, slip, turn = weighted_rows(
        section.reshape(-1), side * section.shape[1] + i, basis(place), _FUNCTIONS
    )
    slip += constants[_LAST] * apart
    slip -= constants[_BY_SLOW] * log_s2 + constants[_BY_FAST] * log_c2
    turn += constants[_TURNING] * slip
    turn += constants[_TURN_SLOW] * log_s2 + constants[_TURN_FAST] * log_c2
    return slip, slip + math.log(time), turn, cosine, sine, time, along, across, body


@inlined
def _x_of(cosine: float, sine: float, constants: FloatArray) -> tuple[bool, float]:
    """Whether a motion comes from pure spin, and the place x, at cos φ and sin φ."""
    if constants[_LAST] > 0.0:
        limit = math.sqrt(constants[_SLOW])
        is_fast, apart = sine > limit, abs(sine - limit) * (sine + limit)
    else:
        is_fast = constants[_BY_FAST] > 0.0
        apart = sine * sine if is_fast else cosine * cosine
    smaller = cosine if is_fast else sine
    return is_fast, 2.0 * math.log(max(smaller, _LEAST)) - math.log(max(apart, _LEAST))


@inlined
def _x_after(
    x0: float, fall: float, with_time: bool, begin: float, is_fast: bool, section: FloatArray,
    constants: FloatArray,
) -> float:  # fmt: skip
    """Where ln Q, or ln Q + ln T, has fallen by ``fall`` from ``begin`` at x0."""
    by_first = constants[_BY_FAST] if is_fast else constants[_BY_SLOW]
    by_last = constants[_LAST]
    if by_last == 0.0:
        by_last = -constants[_BY_SLOW] if is_fast else -constants[_BY_FAST]
    room = max(-x0, 0.0) * by_first
    x: float = x0 + fall / by_first if fall < room else max(x0, 0.0) + (fall - room) / by_last
    low, high, before, error_before = x0, math.inf, x0, fall
    for _ in range(_MOST):
        there = _place_at(x, is_fast, section, constants)
        error = (there[1] if with_time else there[0]) - begin + fall
        if abs(error) <= _ROUNDED or x == before:
            break
        low, high = (x, high) if error > 0.0 else (low, x)
        slope = (error - error_before) / (x - before)
        before, error_before = x, error
        x -= error / slope if slope < 0.0 else -1.0
        if not low < x < high:
            x = 0.5 * (low + high) if high < math.inf else low + 2.0 * (low - x0) + 1.0
        elif abs(error) <= _CLOSE:
            break
    return x


@look_up
def fill_section_states(
    launches: FloatArray, which: npt.NDArray[np.int64], times: FloatArray, section: FloatArray,
    constants: FloatArray, out: FloatArray,
) -> None:  # fmt: skip
    """States of launches (6, m), ``which`` (n,) at ``times`` (n,), into ``out`` (6, n).

    Headings from that at the launch; ``section`` and ``constants`` of a StateSection, whose pucks
    they are.
    """
    held, is_fast, is_pure = -1, False, False
    x0 = rest = slip = speed = stop_time = 0.0
    stop = 0.0, 0.0, 0.0
    here = _place_at(0.0, True, section, constants)
    for n in range(times.size):
        patience(1)
        mine = which[n]
        vx, vy, spin = launches[0, mine], launches[1, mine], launches[2, mine]
        decel, radius, around = launches[4, mine], launches[5, mine], 1.0 if spin > 0.0 else -1.0
        if mine != held:
            held = mine
            speed, edge = math.hypot(vx, vy), radius * spin
            slip = math.hypot(speed, edge)
            one = slip if slip > 0.0 else 1.0
            is_fast, x0 = _x_of(speed / one, abs(edge) / one, constants)
            here = _place_at(x0, is_fast, section, constants)
            scale = slip / decel
            along, across = scale * here[6], edge / decel * here[7]
            stop_time = scale * here[5]
            stop = along * vx - across * vy, along * vy + across * vx, scale * spin * here[8]
            is_pure = speed == 0.0 or spin == 0.0
            rest = 0.0 if is_pure else math.nan
        left = 1.0 - times[n] / stop_time if times[n] < stop_time else 0.0
        if left == 0.0 and math.isnan(rest):
            x = _x_after(x0, _FALLEN, False, here[0], is_fast, section, constants)
            rest = around * (_place_at(x, is_fast, section, constants)[2] - here[2])
        if is_pure or left == 0.0 or left == 1.0:
            state = state_at_one_angle(left, stop, speed, spin, rest)
        else:
            x = _x_after(x0, -math.log(left), True, here[1], is_fast, section, constants)
            there = _place_at(x, is_fast, section, constants)
            smaller, larger = min(there[3], there[4]), max(there[3], there[4])
            state = state_there(
                (vx, vy, spin, 1.0, decel, radius, speed), stop, there[4] > there[3],
                2.0 * smaller / (smaller + larger), slip * (left * here[5] / there[5]),
                around * (there[2] - here[2]), there[6:],
            )  # fmt: skip
        for k in range(STATE_ROWS):
            out[k, n] = state[k]


def fill_others(
    bodies: dict[float, UnitPuck], launches: FloatArray, pucks: npt.NDArray[np.int64],
    which: npt.NDArray[np.int64], moments: FloatArray, out: FloatArray, threads: int | None,
) -> int:  # fmt: skip
    """States of ``pucks`` that no stop table holds into their places in ``out`` (6, n).

    Looked up where they are many of one height; headings from x.  ``which`` (n,): puck each moment
    is of.  Returns of how many pucks they are looked up.
    """
    heights, counts = np.unique(launches[3, pucks], return_counts=True)
    looked = 0
    for height, count in zip(heights.tolist(), counts.tolist(), strict=True):
        section = state_section(bodies[height]) if count >= MANY else None
        if section is not None:
            mine = launches[3, which] == height
            out[:, mine] = section.states(launches, which[mine], moments[mine], threads)
            pucks, looked = pucks[launches[3, pucks] != height], looked + count
    integrate(bodies, launches, pucks, which, moments, out, threads)
    return looked

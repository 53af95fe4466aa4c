"""Motions of a puck that no look-up has: friction over the slip speed, drags beside friction.

Beside friction v′ = … − (c + k v) v and ω′ = … − (c + s) ω with c (1/s) of speed and spin alike, k
(1/m) of the square of the speed, as air has it, and s (1/s) of the spin alone.  With one friction
for all speeds the integrals of the base are closed forms.

A table of friction serves one law f(u); a fit asks for another at every step.  So the integrals of
the base are taken as they are needed, in a time that shrinks with the slip, Q = Q₀ exp(−s) but for
the tilt of the load, so that the stop is reached smoothly.  Fourth order, with steps so small that
places are right to some 1e-6 of the path, far below what a film tells.

How motions change with a launch or a law is told by motions nearby, which run abreast: their
integrals are those of the first, carried on to first order in the direction of slip, its speed and
the law.

Laws of friction by a name and three numbers are f(u) = f + (f₀ − f) φ(u/w) with f of fast slip, f₀
at rest and a speed w:

==========  =====================================  ==================
name        φ(x)                                   known as
==========  =====================================  ==================
stribeck    exp(−x)                                Stribeck's
hyperbola   1/(1 + x)                              a/(u + b) + c
two-valued  1 below x = 1, 0 above (a short slope)  static and kinetic
==========  =====================================  ==================
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.contact.speed_law import SpeedLaw
from puck_tables.kernels.closed_form_kernel import full_integrals
from puck_tables.kernels.compile import allocating, inlined, kernel, patience
from puck_tables.kernels.speed_quadrature_kernel import COARSE, integrals_at

# of s, of which friction alone takes about 50
_STEP, _LARGEST, _STEPS = 0.08, 0.32, 440
SPEED_ACCURACY = 3e-6  # of the way: test_motions_are_those_of_an_independent_integrator
_REST = 1e-4  # of the slip at the launch: what is left of the path is the square of it
_ROOM = 48  # edges of panels, besides those at corners of the law
_NEARBY = 1e-5  # of ratios and of slip speeds: so close integrals are differenced
AHEAD, ASIDE, RIM, X, Y, TURN, TIME = range(7)  # speeds along x and y, of the rim; place, angle
# of a slide: one friction for all speeds, 0: the law; 2h/r; over the gyration squared; drags, push
EVEN, GRAVITY, HEIGHT, INERTIA, RADIUS, LINEAR, AIR, SPINNING, PUSH_X, PUSH_Y = range(10)
_ANY = np.zeros(2), np.zeros((1, 6))  # of no law


_SLOPE = 0.05  # of w: so wide is the slope of the two values, that it can be fitted
_SHAPES = {  # u/w: the last is faster than anything slips, for a cubic does not go on as they do
    "stribeck": np.array([0.0, 0.25, 0.5, 0.8, 1.2, 1.7, 2.4, 3.4, 5.0, 8.0, 13.0, 1e6]),
    "hyperbola": np.array([0.0, 0.2, 0.5, 1.0, 2.0, 4.0, 8.0, 20.0, 60.0, 200.0, 1e3, 1e4, 1e6]),
    "two-valued": np.array([0.0, 1.0 - _SLOPE, 1.0 + _SLOPE, 4.0]),
}
LAWS = tuple(_SHAPES)


def shape(name: str, x: FloatArray) -> FloatArray:
    """φ of a law at u/w (n,).

    >>> shape("stribeck", np.array([0.0, 1.0])).round(4).tolist()
    [1.0, 0.3679]
    """
    if name == "stribeck":
        return np.exp(-x)
    if name == "hyperbola":
        return 1.0 / (1.0 + x)
    return np.clip(0.5 + (1.0 - x) / (2.0 * _SLOPE), 0.0, 1.0)


def law_named(name: str, fast: float, rest: float, speed: float) -> SpeedLaw:
    """The law with these numbers, between rows that are close where it bends.

    >>> law = law_named("stribeck", 0.1, 0.2, 0.05)
    >>> round(float(law(0.0)), 4), round(float(law(0.05)), 3)
    (0.2, 0.137)
    """
    x = _SHAPES[name]
    values = fast + (rest - fast) * shape(name, x)
    return SpeedLaw((speed * x).tolist(), np.maximum(values, 1e-9).tolist(),
                    "linear" if name == "two-valued" else "cubic")  # fmt: skip


class SpeedFriction(NamedTuple):
    """Friction over slip speed, or one for all, gravity m/s², radius of gyration over r.

    ``drags``: of speed and spin 1/s, of the speed squared 1/m, of the spin 1/s, all over the mass;
    ``push``: m/s² along x and y, of a slope; ``belt``: m/s, of the floor along x and y.
    """

    law: SpeedLaw | float
    gravity: float
    gyration: float
    drags: tuple[float, ...] = (0.0, 0.0, 0.0)
    push: tuple[float, float] = (0.0, 0.0)
    belt: tuple[float, float] = (0.0, 0.0)


class SpeedLaunch(NamedTuple):
    """A launch under such friction: 2h/r, r m, velocity (2,) m/s, spin rad/s."""

    friction: SpeedFriction
    height: float
    radius: float
    velocity: FloatArray
    spin: float


@inlined
def _is_fast(y: FloatArray) -> bool:
    fast: bool = abs(y[RIM]) > math.hypot(y[AHEAD], y[ASIDE])
    return fast


@inlined
def _ratio_at(y: FloatArray, fast: bool) -> float:
    """v/r|ω| where it spins fast, else r|ω|/v; up to 1, and hardly more next to such a motion."""
    v, rim = math.hypot(y[AHEAD], y[ASIDE]), abs(y[RIM])
    return v / rim if fast else (rim / v if v > 0.0 else 0.0)


@inlined
def _slip_of(y: FloatArray) -> float:
    return math.hypot(math.hypot(y[AHEAD], y[ASIDE]), y[RIM])


@kernel
def _rates(slide: FloatArray, p: FloatArray, y: FloatArray, out: FloatArray) -> None:
    """d/ds of a state (7,) of a slide under integrals p of friction and base."""
    a, b, d, e = p[0], p[1], p[2], p[3]
    g, height, inertia = slide[GRAVITY], slide[HEIGHT], slide[INERTIA]
    v, slip = math.hypot(y[AHEAD], y[ASIDE]), _slip_of(y)
    cosine, sine = v / slip, y[RIM] / slip
    bottom = 1.0 - height * height * sine * sine * b * (b - d)
    ahead = (slide[LINEAR] + slide[AIR] * v) / g
    turning = (slide[LINEAR] + slide[SPINNING]) / g
    slowing = cosine * cosine * a + sine * sine * inertia * d
    pushed = (abs(slide[PUSH_X]) + abs(slide[PUSH_Y])) / g
    per_length = slip / (slowing + slip * max(ahead, turning) + pushed)  # dt g/ds
    spun = d + height * height * cosine * cosine * a * b * e / bottom
    along, across = a / (bottom * slip) + ahead, sine * height * a * b / (bottom * slip)
    out[AHEAD] = -per_length * (along * y[AHEAD] - across * y[ASIDE] - slide[PUSH_X] / g)
    out[ASIDE] = -per_length * (along * y[ASIDE] + across * y[AHEAD] - slide[PUSH_Y] / g)
    out[RIM] = -per_length * (inertia * sine * spun + turning * y[RIM])
    out[TIME] = per_length / g
    out[X] = out[TIME] * y[AHEAD]
    out[Y] = out[TIME] * y[ASIDE]
    out[TURN] = out[TIME] * y[RIM] / slide[RADIUS]


@inlined
def _even_integrals(even: float, y: FloatArray, p: FloatArray) -> None:
    """Of one friction for all speeds: closed forms."""
    fast = _is_fast(y)
    a, b, d = full_integrals(_ratio_at(y, fast), 1.0 if fast else 0.0)
    p[0], p[1], p[2], p[3] = even * a, even * b, even * d, even * (d - 2.0 * b)


@inlined
def _stage_at(
    states: FloatArray, rates: FloatArray, stage: int, step: float, y: FloatArray
) -> None:
    part = 0.0 if stage == 0 else (step if stage == 3 else 0.5 * step)
    for i in range(7):
        y[i] = states[i] + (part * rates[stage - 1, i] if stage > 0 else 0.0)


@inlined
def _changes(
    breaks: FloatArray, pieces: FloatArray, ratio: float, fast: bool, slip: float, p: FloatArray,
    edges: FloatArray, by: FloatArray,
) -> None:  # fmt: skip
    """By how much integrals ``p`` change with the ratio, with the slip, and to each other law."""
    aside = ratio + _NEARBY if ratio + _NEARBY < 1.0 else ratio - _NEARBY
    integrals_at(breaks[0], pieces[0], aside, fast, slip, COARSE, edges, by[0])
    faster = slip + _NEARBY * slip
    integrals_at(breaks[0], pieces[0], ratio, fast, faster, COARSE, edges, by[1])
    for i in range(4):
        by[0, i] = (by[0, i] - p[i]) / (aside - ratio)
        by[1, i] = (by[1, i] - p[i]) / (faster - slip)
    for k in range(1, len(breaks)):
        integrals_at(breaks[k], pieces[k], ratio, fast, slip, COARSE, edges, by[k + 1])
        for i in range(4):
            by[k + 1, i] -= p[i]


@allocating
def _integrate(
    breaks: FloatArray, pieces: FloatArray, of_law: npt.NDArray[np.int64], slides: FloatArray,
    until: float, states: FloatArray,
) -> int:  # fmt: skip
    """States after each step into ``states`` (n + 1, m, 7), of which the first are given.

    ``breaks`` (k, …), ``pieces`` (k, …): of the law of the first slide, and others; ``of_law``
    (m,): which is that of each; ``until`` s.  How many states there are then.
    """
    count, even = len(slides), slides[0, EVEN] > 0.0
    edges, q, y = np.empty(_ROOM + breaks.shape[1]), np.empty(4), np.empty(7)
    p, rates, at = np.empty((4, 4)), np.empty((count, 4, 7)), np.empty((4, 7))
    by, fast = np.empty((4, len(breaks) + 1, 4)), np.zeros(4, np.bool_)
    first = _slip_of(states[0, 0])
    for n in range(len(states) - 1):
        patience(1)
        # the slower it is the less of the path is left
        step = min(_STEP * math.sqrt(math.sqrt(first / _slip_of(states[n, 0]))), _LARGEST)
        for stage in range(4):
            _stage_at(states[n, 0], rates[0], stage, step, at[stage])
            if even:
                _even_integrals(slides[0, EVEN], at[stage], p[stage])
            else:
                spins = _is_fast(at[stage])
                ratio, slip = _ratio_at(at[stage], spins), _slip_of(at[stage])
                integrals_at(breaks[0], pieces[0], ratio, spins, slip, COARSE, edges, p[stage])
                if count > 1:
                    _changes(breaks, pieces, ratio, spins, slip, p[stage], edges, by[stage])
                fast[stage] = spins
            _rates(slides[0], p[stage], at[stage], rates[0, stage])
        for k in range(1, count):
            for stage in range(4):
                _stage_at(states[n, k], rates[k], stage, step, y)
                if even:
                    _even_integrals(slides[k, EVEN], y, q)
                else:
                    turned = _ratio_at(y, fast[stage]) - _ratio_at(at[stage], fast[stage])
                    faster = _slip_of(y) - _slip_of(at[stage])
                    for i in range(4):
                        q[i] = p[stage, i] + by[stage, 0, i] * turned + by[stage, 1, i] * faster
                        if of_law[k] > 0:
                            q[i] += by[stage, of_law[k] + 1, i]
                _rates(slides[k], q, y, rates[k, stage])
        for k in range(count):
            for i in range(7):
                states[n + 1, k, i] = states[n, k, i] + step / 6.0 * (
                    rates[k, 0, i] + 2.0 * rates[k, 1, i] + 2.0 * rates[k, 2, i] + rates[k, 3, i]
                )
        if _slip_of(states[n + 1, 0]) < _REST * first or states[n + 1, :, TIME].min() > until:
            return n + 2
    return len(states)


def speed_paths(
    launches: Sequence[SpeedLaunch], times: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Motions from (0, 0) of a launch and of others nearby, at times (n,) s, ascending.

    States (m, 6, n): displacement and turn, velocity and spin; acceleration (3, n) of the first.
    Beyond the top speed of a law its last piece goes on.

    >>> even = SpeedFriction(0.1, 10.0, 0.5**0.5)
    >>> slide = SpeedLaunch(even, 0.5, 1.0, np.array([1.0, 0.0]), 0.0)
    >>> states, gains = speed_paths([slide], np.array([0.5, 2.0]))
    >>> states[0, [0, 3]].round(3).tolist(), gains[0].round(3).tolist()
    ([[0.375, 0.5], [0.5, 0.0]], [-1.0, 0.0])
    """
    velocities = np.array([[*one.friction.belt, 0.0] for one in launches])
    states = np.zeros((_STEPS + 1, len(launches), 7))
    states[0, :, :3] = [[*one.velocity, one.radius * one.spin] for one in launches] - velocities
    drifts = velocities[:, :, None] * times, np.repeat(velocities[:, :, None], times.size, axis=2)
    if not states[0, 0].any():
        return np.concatenate(drifts, axis=1), np.zeros((3, times.size))
    slides, laws, of_law = [], dict[SpeedLaw, int](), []
    for (law, g, gyration, drags, push, _), height, radius, *_ in launches:
        of_law.append(laws.setdefault(law, len(laws)) if isinstance(law, SpeedLaw) else 0)
        even = 0.0 if isinstance(law, SpeedLaw) else law
        slides.append([even, g, height, gyration**-2, radius, *drags, *push])
    parts = [law.pieces(law.top_speed) for law in laws] or [_ANY]
    breaks, pieces = (np.stack(part) for part in zip(*parts, strict=True))
    count = _integrate(
        breaks, pieces, np.array(of_law), np.array(slides), float(times.max(initial=0.0)), states
    )
    return _at_times(states[:count], np.array(slides)[:, RADIUS], times, drifts)


def _at_times(
    states: FloatArray, radius: FloatArray, times: FloatArray, drifts: tuple[FloatArray, FloatArray]
) -> tuple[FloatArray, FloatArray]:
    """Between steps (n, m, 7), by cubics; ``drifts``: of the belt, (m, 3, n) each."""
    known, time = states[:, :, X : TURN + 1], states[:, :, TIME]
    speeds = states[:, :, : RIM + 1] / np.stack([1.0 + 0.0 * radius, 1.0 + 0.0 * radius, radius], 1)
    last = len(states) - 2
    n = np.clip(np.searchsorted(time[:, 0], times, side="right") - 1, 0, last)
    h = (time[n + 1] - time[n])[..., None]
    moves = h > 0.0  # not where numbers that ran away leave no time between steps
    h = np.where(moves, h, 1.0)
    u = (np.minimum(times[:, None], time[-1]) - time[n])[..., None] / h
    left, right, rise = speeds[n] * h, speeds[n + 1] * h, known[n + 1] - known[n]
    kink, twist = 3.0 * rise - 2.0 * left - right, left + right - 2.0 * rise
    path = known[n] + u * (left + u * (kink + u * twist))
    rate = np.where(moves, (left + u * (2.0 * kink + 3.0 * u * twist)) / h, speeds[n])
    on = (times[:, None] < time[-1])[..., None]
    gains = np.where(on, 2.0 * (kink + 3.0 * u * twist) / h**2, 0.0)[:, 0].T
    rows = [np.moveaxis(path, 0, 2), np.moveaxis(np.where(on, rate, 0.0), 0, 2)]
    return np.concatenate([a + b for a, b in zip(rows, drifts, strict=True)], axis=1), gains

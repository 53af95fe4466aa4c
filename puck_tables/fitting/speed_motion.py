"""Motions of a puck that no look-up has: friction over the slip speed, drags beside friction.

Beside friction v′ = … − (c + k v) v and ω′ = … − (c + s) ω with c (1/s) of speed and spin alike, k
(1/m) of the square of the speed, as air has it, and s (1/s) of the spin alone.  With one friction
for all speeds the integrals of the base are closed forms.

A table of friction serves one law f(u); a fit asks for another at every step.  So the integrals of
the base are taken as they are needed, in a time that shrinks with the slip, Q = Q₀ exp(−s) but for
the tilt of the load, so that the stop is reached smoothly.  Fourth order, with steps so small that
places are right to 1e-6 of the path, far below what a film tells.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.contact.speed_law import SpeedLaw
from puck_tables.kernels.closed_form_kernel import full_integrals
from puck_tables.kernels.compile import allocating, kernel, patience
from puck_tables.kernels.speed_quadrature_kernel import COARSE, integrals_at

_STEP, _STEPS = 0.08, 440  # of which friction alone takes half
_REST = 1e-6  # of the slip at the launch
_ROOM = 48
AHEAD, ASIDE, RIM, X, Y, TURN, TIME = range(7)  # speeds along x and y, of the rim; place, angle
_ANY = np.zeros((1, 4)), np.zeros(2)  # of no law


class Drags(NamedTuple):
    """Drag besides friction: of speed and spin 1/s, of the speed squared 1/m, of the spin 1/s.

    All over the mass, or the moment of inertia.
    """

    linear: float = 0.0
    quadratic: float = 0.0
    spinning: float = 0.0


class SpeedFriction(NamedTuple):
    """Friction over slip speed, or one for all, gravity m/s², radius of gyration over r, drags.

    ``push``: m/s² along x and y, of a slope; ``belt``: m/s, of the floor along x and y.
    """

    law: SpeedLaw | float
    gravity: float
    gyration: float
    drags: Drags = Drags()
    push: tuple[float, float] = (0.0, 0.0)
    belt: tuple[float, float] = (0.0, 0.0)


@kernel
def _rates(
    breaks: FloatArray, pieces: FloatArray, even: float, g: float, height: float, inertia: float,
    radius: float, drags: FloatArray, y: FloatArray, edges: FloatArray, p: FloatArray,
    out: FloatArray,
) -> None:  # fmt: skip
    """d/ds of a state; ``even``: one friction for all speeds, 0: the law; ``height`` 2h/r."""
    v, rim = math.hypot(y[AHEAD], y[ASIDE]), abs(y[RIM])
    slip = math.sqrt(v * v + rim * rim)
    fast = rim > v
    ratio = v / rim if fast else (rim / v if v > 0.0 else 0.0)
    if even > 0.0:
        a, b, d = full_integrals(ratio, 1.0 if fast else 0.0)
        a, b, d = even * a, even * b, even * d
        e = d - 2.0 * b
    else:
        integrals_at(breaks, pieces, ratio, fast, slip, COARSE, edges, p)
        a, b, d, e = p[0], p[1], p[2], p[3]
    cosine, sine = v / slip, y[RIM] / slip
    bottom = 1.0 - height * height * sine * sine * b * (b - d)
    ahead, turning = (drags[0] + drags[1] * v) / g, (drags[0] + drags[2]) / g
    slowing = cosine * cosine * a + sine * sine * inertia * d
    pushed = (abs(drags[3]) + abs(drags[4])) / g
    pace = slip / (slowing + slip * max(ahead, turning) + pushed)  # dt g/ds
    spun = d + height * height * cosine * cosine * a * b * e / bottom
    along, across = a / (bottom * slip) + ahead, sine * height * a * b / (bottom * slip)
    out[AHEAD] = -pace * (along * y[AHEAD] - across * y[ASIDE] - drags[3] / g)
    out[ASIDE] = -pace * (along * y[ASIDE] + across * y[AHEAD] - drags[4] / g)
    out[RIM] = -pace * (inertia * sine * spun + turning * y[RIM])
    out[TIME] = pace / g
    out[X] = out[TIME] * y[AHEAD]
    out[Y] = out[TIME] * y[ASIDE]
    out[TURN] = out[TIME] * y[RIM] / radius


@allocating
def _integrate(
    breaks: FloatArray, pieces: FloatArray, even: float, g: float, height: float, inertia: float,
    radius: float, drags: FloatArray, states: FloatArray,
) -> int:  # fmt: skip
    """States after each step into ``states`` (n + 1, 7), of which the first is given; how many."""
    edges, p, k, y = np.empty(_ROOM + len(breaks)), np.empty(4), np.empty((4, 7)), np.empty(7)
    slip = math.hypot(math.hypot(states[0, AHEAD], states[0, ASIDE]), states[0, RIM])
    for n in range(len(states) - 1):
        patience(1)
        for stage in range(4):
            part = 0.0 if stage == 0 else (1.0 if stage == 3 else 0.5)
            for i in range(7):
                y[i] = states[n, i] + (part * _STEP * k[stage - 1, i] if stage > 0 else 0.0)
            _rates(breaks, pieces, even, g, height, inertia, radius, drags, y, edges, p, k[stage])
        for i in range(7):
            states[n + 1, i] = states[n, i] + _STEP / 6.0 * (
                k[0, i] + 2.0 * k[1, i] + 2.0 * k[2, i] + k[3, i]
            )
        left = math.hypot(
            math.hypot(states[n + 1, AHEAD], states[n + 1, ASIDE]), states[n + 1, RIM]
        )
        if left < _REST * slip:
            return n + 2
    return len(states)


def speed_path(
    friction: SpeedFriction, height: float, radius: float, velocity: FloatArray, spin: float,
    times: FloatArray,
) -> tuple[FloatArray, FloatArray]:  # fmt: skip
    """Displacement and turn (3, n), velocity and spin (3, n) at times (n,) s after a launch.

    Parameters
    ----------
    friction : f(u), beyond whose top speed the last piece goes on; gravity, gyration, drags
    height : 2h/r
    radius : m
    velocity, spin : m/s, rad/s
    times : s, ascending

    Examples
    --------
    >>> even = SpeedFriction(0.1, 10.0, 0.5**0.5)
    >>> path, rate = speed_path(
    ...     even, 0.5, 1.0, np.array([1.0, 0.0]), 0.0, np.array([0.5, 2.0]))
    >>> path[0].round(4).tolist(), rate[0].round(4).tolist()
    ([0.375, 0.5], [0.5, 0.0])
    """
    law, gravity, gyration, drags, push, belt = friction
    carried = np.array([*belt, 0.0])
    vx, vy = (velocity - belt).tolist()
    if vx == 0.0 and vy == 0.0 and spin == 0.0:
        return carried[:, None] * times, np.repeat(carried[:, None], times.size, axis=1)
    states = np.zeros((_STEPS + 1, 7))
    states[0, :3] = vx, vy, radius * spin
    even = law if isinstance(law, float) else 0.0
    parts = (_ANY[1], _ANY[0]) if isinstance(law, float) else law.pieces(law.top_speed)
    count = _integrate(
        *parts, even, gravity, height, gyration**-2, radius, np.array([*drags, *push]), states
    )
    ahead, aside, rim, x, y, turn, time = states[:count].T
    known = np.stack([x, y, turn])
    slopes = np.stack([ahead, aside, rim / radius])
    at = np.minimum(times, time[-1])
    n = np.clip(np.searchsorted(time, at, side="right") - 1, 0, count - 2)
    h = time[n + 1] - time[n]
    moves = h > 0.0  # not where numbers that ran away leave no time between steps
    u = np.divide(at - time[n], h, out=np.zeros(at.size), where=moves)
    one, two, left, right = known[:, n], known[:, n + 1], slopes[:, n] * h, slopes[:, n + 1] * h
    rise = two - one
    kink, twist = 3.0 * rise - 2.0 * left - right, left + right - 2.0 * rise
    path = one + u * (left + u * (kink + u * twist))
    change = left + u * (2.0 * kink + 3.0 * u * twist)
    rate = np.divide(change, h, out=slopes[:, n].copy(), where=moves)
    rate = np.where(times < time[-1], rate, 0.0)
    return path + carried[:, None] * times, rate + carried[:, None]

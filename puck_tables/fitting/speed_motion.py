"""Motions of a puck whose friction coefficient depends on the slip speed, while a fit looks for it.

A table of friction serves one law f(u); a fit asks for another at every step.  So the integrals of
the base are taken as they are needed, in a time that shrinks with the slip, Q = Q₀ exp(−s) but for
the tilt of the load, so that the stop is reached smoothly.  Fourth order, with steps so small that
places are right to 1e-6 of the path, far below what a film tells.
"""

from __future__ import annotations

import math

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.contact.speed_law import SpeedLaw
from puck_tables.kernels.compile import allocating, kernel, patience
from puck_tables.kernels.speed_quadrature_kernel import FINE, integrals_at

_STEP, _STEPS = 0.08, 220
_REST = 1e-7  # of the slip at the launch
_ROOM = 48
V, RIM, HEADING, X, Y, TURN, TIME = range(7)


@kernel
def _rates(
    breaks: FloatArray, pieces: FloatArray, g: float, height: float, inertia: float,
    radius: float, y: FloatArray, edges: FloatArray, p: FloatArray, out: FloatArray,
) -> None:  # fmt: skip
    """d/ds of a state; ``height`` 2h/r, ``inertia`` (r/k)²."""
    v, rim = y[V], abs(y[RIM])
    slip = math.sqrt(v * v + rim * rim)
    fast = rim > v
    ratio = v / rim if fast else (rim / v if v > 0.0 else 0.0)
    integrals_at(breaks, pieces, ratio, fast, slip, FINE, edges, p)
    a, b, d, e = p[0], p[1], p[2], p[3]
    cosine, sine = v / slip, y[RIM] / slip
    bottom = 1.0 - height * height * sine * sine * b * (b - d)
    pace = slip / (cosine * cosine * a + sine * sine * inertia * d)  # dt g/ds
    out[V] = -pace * cosine * a / bottom
    out[RIM] = -pace * inertia * sine * (d + height * height * cosine * cosine * a * b * e / bottom)
    out[HEADING] = -pace * sine * height * a * b / (bottom * slip)
    out[TIME] = pace / g
    out[X] = out[TIME] * v * math.cos(y[HEADING])
    out[Y] = out[TIME] * v * math.sin(y[HEADING])
    out[TURN] = out[TIME] * y[RIM] / radius


@allocating
def _integrate(
    breaks: FloatArray, pieces: FloatArray, g: float, height: float, inertia: float,
    radius: float, states: FloatArray,
) -> int:  # fmt: skip
    """States after each step into ``states`` (n + 1, 7), of which the first is given; how many."""
    edges, p, k, y = np.empty(_ROOM + len(breaks)), np.empty(4), np.empty((4, 7)), np.empty(7)
    slip = math.hypot(states[0, V], states[0, RIM])
    for n in range(len(states) - 1):
        patience(1)
        for stage in range(4):
            part = 0.0 if stage == 0 else (1.0 if stage == 3 else 0.5)
            for i in range(7):
                y[i] = states[n, i] + (part * _STEP * k[stage - 1, i] if stage > 0 else 0.0)
            _rates(breaks, pieces, g, height, inertia, radius, y, edges, p, k[stage])
        for i in range(7):
            states[n + 1, i] = states[n, i] + _STEP / 6.0 * (
                k[0, i] + 2.0 * k[1, i] + 2.0 * k[2, i] + k[3, i]
            )
        if math.hypot(states[n + 1, V], states[n + 1, RIM]) < _REST * slip:
            return n + 2
    return len(states)


def speed_path(
    law: SpeedLaw, gravity: float, height: float, gyration: float, radius: float,
    velocity: FloatArray, spin: float, times: FloatArray,
) -> tuple[FloatArray, FloatArray]:  # fmt: skip
    """Displacement and turn (3, n), velocity and spin (3, n) at times (n,) s after a launch.

    Parameters
    ----------
    law : f(u); beyond its top speed the last piece goes on
    gravity : m/s²
    height : 2h/r
    gyration : radius of gyration over r
    radius : m
    velocity, spin : m/s, rad/s
    times : s, ascending

    Examples
    --------
    >>> flat = SpeedLaw([0.0, 9.0], [0.1, 0.1])
    >>> path, rate = speed_path(
    ...     flat, 10.0, 0.5, 0.5**0.5, 1.0, np.array([1.0, 0.0]), 0.0, np.array([0.5, 2.0]))
    >>> path[0].round(4).tolist(), rate[0].round(4).tolist()
    ([0.375, 0.5], [0.5, 0.0])
    """
    vx, vy = velocity.tolist()
    speed = math.hypot(vx, vy)
    if speed == 0.0 and spin == 0.0:
        return np.zeros((3, times.size)), np.zeros((3, times.size))
    states = np.zeros((_STEPS + 1, 7))
    states[0, :3] = speed, radius * spin, math.atan2(vy, vx) if speed > 0.0 else 0.0
    count = _integrate(*law.pieces(law.top_speed), gravity, height, gyration**-2, radius, states)
    v, rim, heading, x, y, turn, time = states[:count].T
    known = np.stack([x, y, turn])
    slopes = np.stack([v * np.cos(heading), v * np.sin(heading), rim / radius])
    at = np.minimum(times, time[-1])
    n = np.clip(np.searchsorted(time, at, side="right") - 1, 0, count - 2)
    h = time[n + 1] - time[n]
    u = (at - time[n]) / h
    one, two, left, right = known[:, n], known[:, n + 1], slopes[:, n] * h, slopes[:, n + 1] * h
    rise = two - one
    bend, twist = 3.0 * rise - 2.0 * left - right, left + right - 2.0 * rise
    path = one + u * (left + u * (bend + u * twist))
    rate = np.where(times < time[-1], (left + u * (2.0 * bend + 3.0 * u * twist)) / h, 0.0)
    return path, rate

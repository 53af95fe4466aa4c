"""Where a launched puck is at the moments of a film, and how that depends on what is to be found.

With Q = hypot(v, rω), φ = atan2(rω, v) and the natural motion (X, Y, Θ)(t J/Q; φ, δ),

    place = (Q²/J) Rot(ψ)(X, Y),   turn = Q²/(J r) Θ .

So only the derivatives to φ and δ are those of a motion (:meth:`Curve.with_slopes`); those to Q, J,
ψ and r follow from the similarity and from the velocity.

Drag c, in 1/s, that brakes speed and spin alike, v′ = … − c v, ω′ = … − c ω, needs no motion of its
own: v = e^(−ct) V(s), ω = e^(−ct) W(s) with s = (e^(ct) − 1)/c, where V and W are those without
drag, since dry friction depends on their direction only.  So place = ∫ V ds/(1 + cs)², by parts

    place = X(s)/(1 + cs)² + 2c ∫ X ds/(1 + cs)³ ,

and so for every derivative of it.  For a homogeneous flat puck under uniform pressure this is the
law f(u) = f + (c/g) u of a coefficient that rises (c > 0) or falls (c < 0) with the slip speed u.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.contact.speed_law import SpeedLaw
from puck_tables.fitting.speed_motion import speed_path
from puck_tables.fitting.unit_motions import BY_DELTA, BY_PHI, PATH, RATE, UnitMotions
from puck_tables.motion.state import HEADING, ORIENTATION, PUCK_X, PUCK_Y, SPEED
from puck_tables.motion.state import SPIN as TURNING

_SPEED_STEP = 1e-6
_SLOWEST = 1e-9  # of Q: a launch that only spins is taken to go that fast along its velocity
_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(4)

# what places and turns are differentiated to
VX, VY, SPIN, DECEL, DELTA, RADIUS, TIME = range(7)
_PATH, _RATE, _SLOPES = range(3)  # what is wanted: places; rates, too; derivatives, too


class SpeedFriction(NamedTuple):
    """A friction coefficient over slip speed, gravity m/s², and the radius of gyration over r."""

    law: SpeedLaw
    gravity: float
    gyration: float


class Moving(NamedTuple):
    """What moves a puck: the scale J m/s², δ, r m, drag c 1/s, and its curve.

    ``by_speed``: f over slip speed in place of the curve; J and δ are then those at rest.
    """

    decel: float
    delta: float
    radius: float
    drag: float
    motions: UnitMotions
    by_speed: SpeedFriction | None = None


def path_of(moving: Moving, velocity: FloatArray, spin: float, times: FloatArray) -> FloatArray:
    """Displacement x, y (m) and turn of the body (rad) at times (n,) s after a launch, (3, n).

    Examples
    --------
    >>> from puck_tables.fitting.unit_motions import unit_motions_of
    >>> plain = Moving(1.0, 0.5, 1.0, 0.0, unit_motions_of("uniform", 0.5**0.5))
    >>> path_of(plain, np.array([1.0, 0.0]), 5.0, np.array([2.0]))[0].round(6).tolist()
    [1.590682]
    """
    return _path(moving, velocity, spin, times, _PATH)[0]


def path_with_slopes(
    moving: Moving, velocity: FloatArray, spin: float, times: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """The same (3, n), and its derivatives (7, 3, n) to vx, vy, ω, J, δ, r and time."""
    return _path(moving, velocity, spin, times, _SLOPES)


def path_and_rate(
    moving: Moving, velocity: FloatArray, spin: float, times: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """The same (3, n), with velocity (m/s) and spin (rad/s) at these times, (3, n).

    Examples
    --------
    >>> from puck_tables.fitting.unit_motions import unit_motions_of
    >>> plain = Moving(1.0, 0.5, 1.0, 0.0, unit_motions_of("uniform", 0.5**0.5))
    >>> path_and_rate(plain, np.array([1.0, 0.0]), 0.0, np.array([0.25]))[1].ravel().tolist()
    [0.75, 0.0, 0.0]
    """
    path, slopes = _path(moving, velocity, spin, times, _RATE)
    return path, slopes[-1]


def rates_of(moving: Moving, velocity: FloatArray, spin: float, times: FloatArray) -> FloatArray:
    """Velocity (m/s) and spin (rad/s) at times (n,) s after a launch, (3, n)."""
    return path_and_rate(moving, velocity, spin, times)[1]


def _path(
    moving: Moving, velocity: FloatArray, spin: float, times: FloatArray, want: int
) -> tuple[FloatArray, FloatArray]:
    c = moving.drag
    if moving.by_speed is not None:
        return _by_speed(moving, velocity, spin, times, want)
    if c == 0.0:
        return _dry_friction(moving, velocity, spin, times, want)
    s = np.expm1(c * times) / c
    ends = np.concatenate([[0.0], s])
    half, middle = 0.5 * np.diff(ends), 0.5 * (ends[1:] + ends[:-1])
    inner = middle[:, None] + half[:, None] * _POINTS
    path, slope = _dry_friction(moving, velocity, spin, np.concatenate([s, inner.ravel()]), want)
    weights = half[:, None] * _WEIGHTS / (1.0 + c * inner) ** 3

    def dragged(rows: FloatArray) -> FloatArray:
        at = rows[..., : s.size]
        within = rows[..., s.size :].reshape(*rows.shape[:-1], s.size, _POINTS.size)
        integral = np.cumsum((within * weights).sum(axis=-1), axis=-1)
        result: FloatArray = at / (1.0 + c * s) ** 2 + 2.0 * c * integral
        return result

    if want == _PATH:
        return dragged(path), slope
    result = dragged(slope)
    result[-1] = slope[-1, :, : s.size] * np.exp(-c * times)
    return dragged(path), result


def _by_speed(
    moving: Moving, velocity: FloatArray, spin: float, times: FloatArray, want: int
) -> tuple[FloatArray, FloatArray]:
    """The same where friction depends on the slip speed: no similarity, so all by differences.

    J does nothing, its place is taken by the numbers of the law.
    """
    assert moving.by_speed is not None
    law, gravity, gyration = moving.by_speed

    def path(by: FloatArray) -> tuple[FloatArray, FloatArray]:
        vx, vy, w, _, delta, radius = by.tolist()
        friction = moving.decel / gravity
        return speed_path(
            law, gravity, delta / friction, gyration, radius, np.array([vx, vy]), w, times
        )

    at = np.array([*velocity, spin, moving.decel, moving.delta, moving.radius])
    result, rate = path(at)
    if want != _SLOPES:
        return result, rate[None]
    out = np.zeros((7, 3, times.size))
    scale = max(abs(at[0]), abs(at[1]), moving.radius * abs(spin))
    steps = {VX: scale, VY: scale, SPIN: scale / moving.radius, DELTA: 1.0, RADIUS: moving.radius}
    for k, size in steps.items():
        step = np.zeros(6)
        step[k] = _SPEED_STEP * size
        out[k] = (path(at + step)[0] - result) / step[k]
    out[TIME] = rate
    return result, out


def _dry_friction(
    moving: Moving, velocity: FloatArray, spin: float, times: FloatArray, want: int
) -> tuple[FloatArray, FloatArray]:
    vx, vy = velocity.tolist()
    rim, speed = moving.radius * spin, math.hypot(vx, vy)
    slip = math.hypot(speed, rim)
    if slip == 0.0:
        return np.zeros((3, times.size)), np.zeros((7, 3, times.size))
    phi = math.atan2(rim, speed)
    cosine, sine = (vx / speed, vy / speed) if speed > 0.0 else (1.0, 0.0)
    turn = np.array([[cosine, -sine], [sine, cosine]])
    length = slip * slip / moving.decel
    tau = times * (moving.decel / slip)
    motions, height = moving.motions, moving.delta
    if want != _SLOPES:
        states = motions.states(np.array([phi]), np.array([height]), tau[None])[:, 0]
        path = _turned(turn, length, moving.radius, states[[PUCK_X, PUCK_Y, ORIENTATION]])
        if want == _PATH:
            return path, np.empty((0, 3, times.size))
        heading, ahead = states[HEADING], states[SPEED]
        motion = np.stack([ahead * np.cos(heading), ahead * np.sin(heading), states[TURNING]])
        return path, _turned(turn, slip, moving.radius, motion)[None]
    unit_motion = _turned(turn, 1.0, moving.radius, motions.with_slopes(phi, height, tau))
    path, to_phi, rate = (
        length * unit_motion[PATH],
        length * unit_motion[BY_PHI],
        slip * unit_motion[RATE],
    )
    to_log_slip = 2.0 * path - times * rate
    to_speed = (math.cos(phi) / slip) * to_log_slip - (math.sin(phi) / slip) * to_phi
    to_rim = (math.sin(phi) / slip) * to_log_slip + (math.cos(phi) / slip) * to_phi
    across = path[:2] / max(speed, _SLOWEST * slip)
    out = np.empty((7, 3, times.size))
    out[VX], out[VY] = cosine * to_speed, sine * to_speed
    out[VX, 0] += sine * across[1]
    out[VX, 1] -= sine * across[0]
    out[VY, 0] -= cosine * across[1]
    out[VY, 1] += cosine * across[0]
    out[SPIN], out[RADIUS], out[TIME] = moving.radius * to_rim, spin * to_rim, rate
    out[RADIUS, 2] -= path[2] / moving.radius
    out[DECEL] = (times * rate - path) / moving.decel
    out[DELTA] = length * unit_motion[BY_DELTA]
    return path, out


def _turned(turn: FloatArray, unit: float, radius: float, unit_motion: FloatArray) -> FloatArray:
    """x, y and body angle (…, 3, n) from natural ones, in a unit of length."""
    whole = np.zeros((3, 3))
    whole[:2, :2], whole[2, 2] = turn, 1.0 / radius
    result: FloatArray = (unit * whole) @ unit_motion
    return result

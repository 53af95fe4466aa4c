"""Friction of a flat polygon under uniform pressure, in closed form, and a step of its motion.

The sums are those of :mod:`puck_tables.kernels.polygon_sums`.
"""

from __future__ import annotations

from math import cos, log, sin, sqrt

from puck_tables.export.program.intrinsics import Numbers, Out, room
from puck_tables.export.program.plain_motion import refused

# what the program of a file is given: sides (where each begins, from the centre of mass, its unit
# tangent with the base to the left, its length), the area, the farthest corner, k², Gauss's rule
BASE_SIDES: Numbers = ()
BASE_COUNT = 0
BASE_AREA = BASE_FARTHEST = BASE_SQUARE = 1.0
BASE_NODES: Numbers = ()
BASE_WEIGHTS: Numbers = ()
BASE_RULE = 8  # nodes
FAR_AWAY = 6.0  # times the farthest corner: from there on the centre of rotation is far away
ON_A_SIDE = 1e-17  # of a length
STEP_SHARE = 0.05  # of the slip that friction takes in a step of its own, and rad, at most
LAST_SHARE = 1e-7  # of the slip at first: with less it goes straight to its rest
STEP_ERROR = 1e-6  # of Q²/decel, Q, over k of angles and spins: of a step
MOST_PARTS = 100000  # steps of its own: a share of 0.05 takes 320 to the last


def near_sums(ux: float, uy: float, w: float, out: Out) -> None:
    """Integrals of the slip direction and of its moment, by one logarithm a side."""
    cx: float = -uy / w
    cy: float = ux / w
    ex: float = 0.0
    ey: float = 0.0
    size: float = 0.0
    for n in range(BASE_COUNT):
        px: float = BASE_SIDES[5 * n] - cx
        py: float = BASE_SIDES[5 * n + 1] - cy
        tx: float = BASE_SIDES[5 * n + 2]
        ty: float = BASE_SIDES[5 * n + 3]
        length: float = BASE_SIDES[5 * n + 4]
        d: float = px * ty - py * tx
        begin: float = px * tx + py * ty
        end: float = begin + length
        near: float = sqrt(px * px + py * py)
        far: float = sqrt(d * d + end * end)
        both: float = near + far
        gap: float = both - length
        gap = gap if gap > ON_A_SIDE * length else ON_A_SIDE * length
        along: float = d * log((both + length) / gap)
        a1: float = length * (begin + end) / both
        ex = ex + d * (along * tx - a1 * ty)
        ey = ey + d * (along * ty + a1 * tx)
        size = size + d * (end * far - begin * near + d * along)
    sign: float = 1.0 if w > 0.0 else -1.0
    out[0] = 0.5 * sign * ex
    out[1] = 0.5 * sign * ey
    out[2] = sign * size / 6.0 + cx * out[1] - cy * out[0]


def far_sums(ux: float, uy: float, w: float, out: Out) -> None:
    """Integrals of the slip direction and of its moment, where the centre of rotation is far."""
    speed: float = sqrt(ux * ux + uy * uy)
    spin: float = abs(w)
    sign: float = -1.0 if w < 0.0 else 1.0
    out[0] = 0.0
    out[1] = 0.0
    out[2] = 0.0
    for n in range(BASE_COUNT):
        half: float = 0.5 * BASE_SIDES[5 * n + 4]
        hx: float = half * BASE_SIDES[5 * n + 2]
        hy: float = half * BASE_SIDES[5 * n + 3]
        for m in range(BASE_RULE):
            qx: float = BASE_SIDES[5 * n] + hx + BASE_NODES[m] * hx
            qy: float = BASE_SIDES[5 * n + 1] + hy + BASE_NODES[m] * hy
            vx: float = ux - w * qy
            vy: float = uy + w * qx
            slip: float = sqrt(vx * vx + vy * vy)
            deep: float = sign * (2.0 * (uy * qx - ux * qy) + w * (qx * qx + qy * qy))
            deep = deep / (slip + speed)
            k0: float = deep * (speed + 0.5 * spin * deep)
            k1: float = deep * deep * (0.5 * speed + spin * deep / 3.0)
            weight: float = BASE_WEIGHTS[m] * (vx * hx + vy * hy) / (slip * slip)
            lever: float = sign * (qx * vy - qy * vx) / slip - deep
            out[0] = out[0] + sign * weight * vx / slip * k0
            out[1] = out[1] + sign * weight * vy / slip * k0
            out[2] = out[2] + weight * (lever * k0 + k1)


def wrench(vx: float, vy: float, spin: float, orientation: float, out: Out) -> int:
    """Friction over f m g on the base: force along x and y, and torque in metres, into out[3].

    (vx, vy) is the slip of its centre of mass over the floor, spin in rad/s, orientation in rad.
    Error 2e-13, wherever the centre of rotation is.  Returns 0, or 1 and NaN where it does not
    slip, or an argument is not finite.
    """
    sums = room(3)
    bad: float = vx * 0.0 + vy * 0.0 + spin * 0.0 + orientation * 0.0
    speed: float = sqrt(vx * vx + vy * vy)
    if not (bad == 0.0 and speed + abs(spin) > 0.0):
        return refused(out, 3, 1)
    c: float = cos(orientation)
    s: float = sin(orientation)
    if speed > FAR_AWAY * BASE_FARTHEST * abs(spin):
        far_sums(c * vx + s * vy, c * vy - s * vx, spin, sums)
    else:
        near_sums(c * vx + s * vy, c * vy - s * vx, spin, sums)
    out[0] = (s * sums[1] - c * sums[0]) / BASE_AREA
    out[1] = (-s * sums[0] - c * sums[1]) / BASE_AREA
    out[2] = -sums[2] / BASE_AREA
    return 0


def add_rates(y: Numbers, rates: Numbers, h: float, decel: float, out: Out, to: Out) -> None:
    """The state y + h rates into to[6], and its rates into out[6]; at rest there are none."""
    found = room(3)
    for n in range(6):
        to[n] = y[n] + h * rates[n]
    refusal: int = wrench(to[3], to[4], to[5], to[2], found)
    for n in range(3):
        out[n] = to[3 + n]
        out[3 + n] = decel * found[n] if refusal == 0 else 0.0
    out[5] = out[5] / BASE_SQUARE


def step(
    x: float, y: float, orientation: float, vx: float, vy: float, spin: float, decel: float,
    dt: float, out: Out,
) -> int:  # fmt: skip
    """The state after dt into out[6]: x, y, orientation, vx, vy, spin; at rest it stays there.

    decel is f g.  By steps of its own of order 4, at most a twentieth of the slip and of a rad
    each: it errs by up to STEP_ERROR.  Returns 0, or 1 and NaN where an argument is not finite,
    decel <= 0 or dt < 0, or 2 where they would be over 100000.
    """
    now = room(6)
    place = room(6)
    one = room(6)
    two = room(6)
    three = room(6)
    four = room(6)
    now[0] = x
    now[1] = y
    now[2] = orientation
    now[3] = vx
    now[4] = vy
    now[5] = spin
    bad: float = decel * 0.0 + dt * 0.0
    for n in range(6):
        bad = bad + now[n] * 0.0
    if not (bad == 0.0 and decel > 0.0 and dt >= 0.0):
        return refused(out, 6, 1)
    first: float = sqrt(vx * vx + vy * vy + BASE_SQUARE * spin * spin)
    left: float = dt
    part: int = 0
    while left > 0.0 and part < MOST_PARTS:
        q: float = sqrt(now[3] * now[3] + now[4] * now[4] + BASE_SQUARE * now[5] * now[5])
        if q <= LAST_SHARE * first:
            # straight to its rest: what is left is less than the error
            for n in range(3):
                now[3 + n] = 0.0
            left = 0.0
        else:
            h: float = STEP_SHARE * q / decel
            angle: float = abs(now[5]) * h
            h = STEP_SHARE / angle * h if angle > STEP_SHARE else h
            h = left if left < h else h
            add_rates(now, now, 0.0, decel, one, place)
            add_rates(now, one, 0.5 * h, decel, two, place)
            add_rates(now, two, 0.5 * h, decel, three, place)
            add_rates(now, three, h, decel, four, place)
            for n in range(6):
                now[n] = now[n] + h / 6.0 * (one[n] + 2.0 * two[n] + 2.0 * three[n] + four[n])
            left = left - h
        part = part + 1
    if left > 0.0:
        return refused(out, 6, 2)
    for n in range(6):
        out[n] = now[n]
    return 0

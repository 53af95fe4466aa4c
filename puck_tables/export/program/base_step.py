"""Friction of a base of polygons and discs under linear pressure, in closed form; a step by it.

The sums are those of :mod:`puck_tables.kernels.polygon_sums` and, of discs, those of
:mod:`puck_tables.kernels.base_boundary`; pressure is that of
:mod:`puck_tables.kernels.base_friction`.
"""

from __future__ import annotations

from math import cos, log, sin, sqrt

from puck_tables.export.program.intrinsics import Numbers, Out, room
from puck_tables.export.program.launch_motion import refused
from puck_tables.export.program.resultant_formulas import HALF_PI, shape_integrals

# what the program of a file is given: sides (where each begins, from the centre of mass, its unit
# tangent with the base to the left, its length), discs (middle, radius, how hard it is pressed, -1:
# a hole), integrals of 1, x and x x, the farthest point, whether the pressure is tilted, and by
# friction how much (f times the height of the centre of mass), k², Gauss's rule, and of the slip
# what friction takes in a step of its own, and rad, at most
BASE_SIDES: Numbers = ()
BASE_DISCS: Numbers = ()
BASE_COUNT = BASE_DISC_COUNT = BASE_TILTED = 0
BASE_AREA = BASE_FARTHEST = BASE_SQUARE = 1.0
BASE_SHARE = 0.05
BASE_X = BASE_Y = BASE_XX = BASE_XY = BASE_YY = BASE_LEVER = 0.0
BASE_NODES: Numbers = ()
BASE_WEIGHTS: Numbers = ()
BASE_RULE = 8  # nodes
FAR_AWAY = 6.0  # times the farthest corner: from there on the centre of rotation is far away
ON_A_SIDE = 1e-17  # of a length
SHORT_SIDE = 0.05  # of the distances of its ends: a series is exact
LAST_SHARE = 1e-7  # of the slip at first: with less it goes straight to its rest
STEP_ERROR = 1e-6  # of Q²/decel, Q, over k of angles and spins: of a step
MOST_PARTS = 100000  # steps of its own: a share of 0.05 takes 320 to the last


def near_sums(ux: float, uy: float, w: float, out: Out) -> None:
    """The sums over what sides bound, by one logarithm a side."""
    cx: float = -uy / w
    cy: float = ux / w
    ex: float = 0.0
    ey: float = 0.0
    size: float = 0.0
    rx: float = 0.0
    ry: float = 0.0
    xx: float = 0.0
    mean: float = 0.0
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
        square: float = d * d * log((both + length) / gap)
        q: float = length / both
        a1: float = q * (begin + end)
        product: float = end * far - begin * near
        a2: float = 0.5 * (product - square)
        if q < SHORT_SIDE:
            q2: float = q * q
            g: float = 2.0 / 35.0 + q2 * (2.0 / 63.0 + q2 * (2.0 / 99.0 + q2 * (2.0 / 143.0)))
            g = q * q2 * (2.0 / 3.0 + q2 * (2.0 / 15.0 + q2 * g))
            a2 = 0.25 * ((begin + end) * (begin + end) * (2.0 * q - g) + both * both * g)
        b0: float = 0.5 * (product + square)
        b1: float = a1 * (far * far + far * near + near * near) / 3.0
        ex = ex + square * tx - d * a1 * ty
        ey = ey + square * ty + d * a1 * tx
        size = size + d * b0
        rx = rx + d * (d * b0 * ty + b1 * tx)
        ry = ry + d * (b1 * ty - d * b0 * tx)
        one: float = d * d * a1
        other: float = d * (square - a2)
        xx = xx + one * (tx * tx - ty * ty) + other * tx * ty
        mean = mean + 2.0 * one * tx * ty - 0.5 * other * (tx * tx - ty * ty)
    sign: float = 1.0 if w > 0.0 else -1.0
    ex = 0.5 * sign * ex
    ey = 0.5 * sign * ey
    size = sign * size / 3.0
    xx = sign * xx / 3.0
    mean = sign * mean / 3.0
    xy: float = mean - 0.5 * size
    yx: float = mean + 0.5 * size
    swing: float = size + cx * ey - cy * ex
    out[0] = ex
    out[1] = ey
    out[2] = xx + ex * cx
    out[3] = xy + ex * cy
    out[4] = yx + ey * cx
    out[5] = ey * cy - xx
    out[6] = 0.25 * sign * rx + cx * yx - cy * xx + swing * cx
    out[7] = 0.25 * sign * ry - cx * xx - cy * xy + swing * cy


def far_sums(ux: float, uy: float, w: float, out: Out) -> None:
    """The sums over what sides bound, where the centre of rotation is far."""
    speed: float = sqrt(ux * ux + uy * uy)
    spin: float = abs(w)
    sign: float = -1.0 if w < 0.0 else 1.0
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
            k2: float = deep * deep * deep * (speed / 3.0 + 0.25 * spin * deep)
            weight: float = BASE_WEIGHTS[m] * (vx * hx + vy * hy) / (slip * slip)
            dx: float = sign * vy / slip
            dy: float = -sign * vx / slip
            bx: float = qx - deep * dx
            by: float = qy - deep * dy
            lever: float = qx * dx + qy * dy - deep
            px: float = bx * k0 + dx * k1
            py: float = by * k0 + dy * k1
            fx: float = sign * weight * vx / slip
            fy: float = sign * weight * vy / slip
            out[0] = out[0] + fx * k0
            out[1] = out[1] + fy * k0
            out[2] = out[2] + fx * px
            out[3] = out[3] + fx * py
            out[4] = out[4] + fy * px
            out[5] = out[5] + fy * py
            out[6] = out[6] + weight * (lever * px + bx * k1 + dx * k2)
            out[7] = out[7] + weight * (lever * py + by * k1 + dy * k2)


def add_disc(n: int, ux: float, uy: float, w: float, out: Out) -> None:
    """Add the sums over a disc: in closed form about its middle, turned and moved."""
    p = room(3)
    cx: float = BASE_DISCS[4 * n]
    cy: float = BASE_DISCS[4 * n + 1]
    radius: float = BASE_DISCS[4 * n + 2]
    area: float = BASE_DISCS[4 * n + 3] * 2.0 * HALF_PI * radius * radius
    vx: float = ux - w * cy
    vy: float = uy + w * cx
    speed: float = sqrt(vx * vx + vy * vy)
    c: float = vx / speed if speed > 0.0 else 1.0
    s: float = vy / speed if speed > 0.0 else 0.0
    rim: float = radius * abs(w)
    fast: bool = rim > speed
    shape_integrals(speed / rim if fast else rim / speed, fast, p)
    length: float = sqrt(speed * speed + rim * rim)
    force: float = area * speed / length * p[0]
    turns: float = area * radius * radius * w / length
    across: float = turns * (p[1] - p[2])
    along: float = turns * p[1]
    second: float = area * radius * radius * speed / length * (p[2] - 2.0 * p[1])
    ex: float = c * force
    ey: float = s * force
    xx: float = -c * s * (across + along)
    xy: float = c * c * across - s * s * along
    yx: float = c * c * along - s * s * across
    swing: float = yx - xy + cx * ey - cy * ex
    out[0] = out[0] + ex
    out[1] = out[1] + ey
    out[2] = out[2] + xx + ex * cx
    out[3] = out[3] + xy + ex * cy
    out[4] = out[4] + yx + ey * cx
    out[5] = out[5] - xx + ey * cy
    out[6] = out[6] - s * second + cx * yx - cy * xx + swing * cx
    out[7] = out[7] + c * second - cx * xx - cy * xy + swing * cy


def press(sums: Numbers, out: Out) -> None:
    """The pressure a + b·x for a weight of 1 that balances the moment of friction, into out[3]."""
    tx: float = BASE_X - BASE_LEVER * sums[0]
    ty: float = BASE_Y - BASE_LEVER * sums[1]
    ox: float = BASE_X / BASE_AREA
    oy: float = BASE_Y / BASE_AREA
    xx: float = BASE_XX - BASE_LEVER * sums[2] - tx * ox
    xy: float = BASE_XY - BASE_LEVER * sums[3] - tx * oy
    yx: float = BASE_XY - BASE_LEVER * sums[4] - ty * ox
    yy: float = BASE_YY - BASE_LEVER * sums[5] - ty * oy
    inverse: float = -1.0 / BASE_AREA / (xx * yy - xy * yx)
    out[1] = inverse * (yy * tx - xy * ty)
    out[2] = inverse * (xx * ty - yx * tx)
    out[0] = (1.0 - BASE_X * out[1] - BASE_Y * out[2]) / BASE_AREA


def wrench(vx: float, vy: float, spin: float, orientation: float, out: Out) -> int:
    """Friction over f m g on the base: force along x and y, and torque in metres, into out[3].

    (vx, vy) is the slip of its centre of mass over the floor, spin in rad/s, orientation in rad.
    Error 2e-13, wherever the centre of rotation is.  Returns 0, or 1 and NaN where it does not
    slip, or an argument is not finite.
    """
    sums = room(8)
    load = room(3)
    bad: float = vx * 0.0 + vy * 0.0 + spin * 0.0 + orientation * 0.0
    speed: float = sqrt(vx * vx + vy * vy)
    if not (bad == 0.0 and speed + abs(spin) > 0.0):
        return refused(out, 3, 1)
    c: float = cos(orientation)
    s: float = sin(orientation)
    ux: float = c * vx + s * vy
    uy: float = c * vy - s * vx
    for n in range(8):
        sums[n] = 0.0
    if speed > FAR_AWAY * BASE_FARTHEST * abs(spin):
        far_sums(ux, uy, spin, sums)
    else:
        near_sums(ux, uy, spin, sums)
    for n in range(BASE_DISC_COUNT):
        add_disc(n, ux, uy, spin, sums)
    load[0] = 1.0 / BASE_AREA
    load[1] = 0.0
    load[2] = 0.0
    if BASE_TILTED > 0:
        press(sums, load)
    fx: float = load[0] * sums[0] + load[1] * sums[2] + load[2] * sums[3]
    fy: float = load[0] * sums[1] + load[1] * sums[4] + load[2] * sums[5]
    out[0] = s * fy - c * fx
    out[1] = -s * fx - c * fy
    out[2] = load[0] * (sums[3] - sums[4]) - load[1] * sums[6] - load[2] * sums[7]
    return 0


def add_rates(y: Numbers, rates: Numbers, h: float, decel: float, out: Out, to: Out) -> None:
    """The state y + h rates into to[6], and its rates into out[6]; at rest there are none."""
    load = room(3)
    for n in range(6):
        to[n] = y[n] + h * rates[n]
    refusal: int = wrench(to[3], to[4], to[5], to[2], load)
    for n in range(3):
        out[n] = to[3 + n]
        out[3 + n] = decel * load[n] if refusal == 0 else 0.0
    out[5] = out[5] / BASE_SQUARE


def step(
    x: float, y: float, orientation: float, vx: float, vy: float, spin: float, decel: float,
    dt: float, out: Out,
) -> int:  # fmt: skip
    """The state after dt into out[6]: x, y, orientation, vx, vy, spin; at rest it stays there.

    decel is f g.  By steps of its own of order 4, at most a twentieth of the slip and of a rad
    each, less on small feet: it errs by up to STEP_ERROR.  Returns 0, or 1 and NaN where an
    argument is not finite, decel <= 0 or dt < 0, or 2 where they would be over 100000.
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
            h: float = BASE_SHARE * q / decel
            angle: float = abs(now[5]) * h
            h = BASE_SHARE / angle * h if angle > BASE_SHARE else h
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

"""How friction under a base changes with the slip: second derivatives of what it dissipates.

With the pressure p = a + b·x held, f N ∫ p |u| dA is convex in (u_x, u_y, w), its gradient is the
force and torque that keep the slip going, and its Hessian is, n the direction from the
instantaneous centre C, R the distance,

    ∫ p/|u| g ⊗ g dA,   g = (n_x, n_y, x × n):   as x = c + R n,  x × n = c × n,  and all that is
    needed is ∫ n ⊗ n/R dA and, where b is not 0, ∫ n ⊗ n ⊗ n dA.

Along a straight side, N its outward normal, with d, s, R and A₀ as in
:mod:`puck_tables.kernels.polygon_sums`, k₀ = [s/R], k₁ = −d [1/R], k₂ = A₀ − [s/R],

    ∫ n ⊗ n/R dA = Σ d (k₀ N ⊗ N + k₁ (N ⊗ t + t ⊗ N) + k₂ t ⊗ t).

Over a disc they are elliptic integrals (:mod:`puck_tables.contact.closed_form`).  Where C lies far
away the integral along a ray begins at the distance of C, as there.
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.base_friction import (
    AREA,
    DISCS,
    FIRST_X,
    FIRST_Y,
    HEAD,
    LEVER,
    REACH,
    SECOND_XX,
    SECOND_XY,
    SECOND_YY,
    SIDES,
    base_sums,
    disc_in,
    grip,
    pressure_on,
    under_load,
)
from puck_tables.kernels.base_sums import NOTHING
from puck_tables.kernels.closed_form_kernel import few_elliptic, full_elliptic
from puck_tables.kernels.compile import inlined, inner, summed
from puck_tables.kernels.polygon_sums import (
    ANEW,
    BEGIN_X,
    BEGIN_Y,
    FAR,
    LEAST,
    LENGTH,
    NODE,
    NODES,
    PIECE_COLUMNS,
    TANGENT_X,
    TANGENT_Y,
    WEIGHT,
    ray_to,
)

Hessian = tuple[float, float, float, float, float, float]  # xx, xy, yy, xw, yw, ww
Wrench = tuple[float, float, float]
_FLAT: Hessian = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)  # where force does not change with motion
_TINY = 1e-300  # of a distance: C at a corner, where what is divided by it is 0
_FEW = 0.99  # of the smaller rate over the larger: up to it few steps of the mean do
_SMALL = 0.01  # of k²: below it 4 (D − G) − 3 B cancels, and eight terms of its series do


@inlined
def _about(xx: float, xy: float, yy: float, cx: float, cy: float) -> Hessian:
    """From the sums over n ⊗ n those over g ⊗ g, with C at (cx, cy)."""
    return (
        xx, xy, yy, cx * xy - cy * xx, cx * yy - cy * xy,
        cy * cy * xx - 2.0 * cx * cy * xy + cx * cx * yy,
    )  # fmt: skip


@inlined
def _sides_near(
    base: FloatArray, a: float, bx: float, by: float, ux: float, uy: float, w: float
) -> Hessian:  # fmt: skip
    cx, cy = -uy / w, ux / w
    xx, xy, yy, far = 0.0, 0.0, 0.0, 0.0
    at_c = a + bx * cx + by * cy
    for i in range(HEAD, HEAD + PIECE_COLUMNS * int(base[SIDES]), PIECE_COLUMNS):
        px, py = base[i + BEGIN_X] - cx, base[i + BEGIN_Y] - cy
        tx, ty, length = base[i + TANGENT_X], base[i + TANGENT_Y], base[i + LENGTH]
        near = math.sqrt(px * px + py * py) if base[i + ANEW] != 0.0 else far
        d, begin = px * ty - py * tx, px * tx + py * ty
        end = begin + length
        far = math.sqrt(d * d + end * end)
        both = near + far
        first, last = 1.0 / max(near, _TINY), 1.0 / max(far, _TINY)
        k0 = end * last - begin * first
        k1 = d * first - d * last
        k2 = math.log((both + length) / max(both - length, LEAST * length)) - k0
        across, along = 0.5 * (bx * ty - by * tx), 0.5 * (bx * tx + by * ty)
        a1 = length * (begin + end) / both
        nn = d * (at_c * k0 + d * (across * k0 + along * k1))
        nt = d * (at_c * k1 + d * (across * k1 + along * k2))
        tt = d * (at_c * k2 + d * (across * k2 - along * k1) + along * a1)
        xx += nn * ty * ty + 2.0 * nt * tx * ty + tt * tx * tx
        xy += nt * (ty * ty - tx * tx) + (tt - nn) * tx * ty
        yy += nn * tx * tx - 2.0 * nt * tx * ty + tt * ty * ty
    spin = abs(w)
    return _about(xx / spin, xy / spin, yy / spin, cx, cy)


@inlined
def _sides_far(
    base: FloatArray, a: float, bx: float, by: float, ux: float, uy: float, w: float
) -> Hessian:  # fmt: skip
    sign = -1.0 if w < 0.0 else 1.0
    xx, xy, yy, xw, yw, ww = _FLAT
    for i in range(HEAD, HEAD + PIECE_COLUMNS * int(base[SIDES]), PIECE_COLUMNS):
        half = 0.5 * base[i + LENGTH]
        hx, hy = half * base[i + TANGENT_X], half * base[i + TANGENT_Y]
        mx, my = base[i + BEGIN_X] + hx, base[i + BEGIN_Y] + hy
        for node in range(NODES):
            qx, qy = mx + NODE[node] * hx, my + NODE[node] * hy
            vx, vy, slip, deep = ray_to(ux, uy, w, qx, qy)
            inverse = 1.0 / slip
            nx, ny = vy * inverse, -vx * inverse
            turn = qx * ny - qy * nx
            weight = sign * WEIGHT[node] * (vx * hx + vy * hy) * inverse * inverse * deep
            weight *= a + bx * qx + by * qy - 0.5 * sign * deep * (bx * nx + by * ny)
            xx, xy, yy = (
                summed(xx, weight * nx * nx), summed(xy, weight * nx * ny),
                summed(yy, weight * ny * ny),
            )  # fmt: skip
            xw, yw, ww = (
                summed(xw, weight * nx * turn), summed(yw, weight * ny * turn),
                summed(ww, weight * turn * turn),
            )  # fmt: skip
    return xx, xy, yy, xw, yw, ww


@inlined
def _disc(
    size: float, middle: float, along: float, across: float, speed: float, w: float
) -> Hessian:
    """A disc that slips along x, about its own middle.

    ``middle``: the pressure there; ``along``, ``across``: its slope along the slip, to the left.
    """
    rim = size * abs(w)
    fast = rim > speed
    rate = rim if fast else speed
    k = (speed if fast else rim) / rate
    m, m1 = k * k, (1.0 - k) * (1.0 + k)
    b, d, g = few_elliptic(k) if k < _FEW else full_elliptic(k)
    x, rest = d - g, m1 * d
    slope = 0.2 * (b + 2.0 * rest + x)
    if fast:
        q0, q1 = b + 2.0 * rest, 0.2 * k * (4.0 * b + 8.0 * rest - x)
    else:
        q0 = x
        q1 = 0.2 * (4.0 * x - 3.0 * b + 2.0 * m * x) / k if m > _SMALL else _series(m) * k
    scale = 4.0 / 3.0 * size * size / rate
    sign = -1.0 if w < 0.0 else 1.0
    across *= sign * size
    q = scale * (middle * q0 + across * q1)
    z = -scale * along * size * slope * (k if fast else 1.0)
    side, arm = (1.0, k * size) if fast else (k, size)
    yy = scale * (middle * (2.0 * b + rest) + across * k * slope)
    return (
        side * side * q, sign * side * z, yy, -sign * side * arm * q, -arm * z, arm * arm * q,
    )  # fmt: skip


@inlined
def _series(m: float) -> float:
    """3 π/32 times the hypergeometric function F(½, 5/2; 4; m)."""
    total, term = 0.0, 3.0 * math.pi / 32.0
    for i in range(8):
        total += term
        term *= m * (0.5 + i) * (2.5 + i) / ((4.0 + i) * (1.0 + i))
    return total


@inlined
def _disc_at(
    cx: float, cy: float, size: float, a: float, bx: float, by: float, ux: float, uy: float,
    w: float,
) -> Hessian:  # fmt: skip
    """A disc about a place: about its own middle, turned and moved."""
    ux, uy = ux - w * cy, uy + w * cx
    speed = math.sqrt(ux * ux + uy * uy)
    c, s = (ux / speed, uy / speed) if speed > 0.0 else (1.0, 0.0)
    xx, xy, yy, xw, yw, ww = _disc(
        size, a + bx * cx + by * cy, c * bx + s * by, c * by - s * bx, speed, w
    )
    turned_xw, turned_yw = c * xw - s * yw, s * xw + c * yw
    mixed = c * s * (xx - yy) + (c * c - s * s) * xy
    first = c * c * xx - 2.0 * c * s * xy + s * s * yy
    last = s * s * xx + 2.0 * c * s * xy + c * c * yy
    # x × n = (middle of the disc) × n + (x from there) × n
    return (
        first, mixed, last, turned_xw + cx * mixed - cy * first, turned_yw + cx * last - cy * mixed,
        ww + 2.0 * (cx * turned_yw - cy * turned_xw) + cx * cx * last - 2.0 * cx * cy * mixed
        + cy * cy * first,
    )  # fmt: skip


@inner
def pressed_hessian(
    base: FloatArray, a: float, bx: float, by: float, ux: float, uy: float, w: float
) -> Hessian:  # fmt: skip
    """∫ p/|u| g ⊗ g dA over a base, in its own axes, with the pressure p = a + b·x."""
    sums = _FLAT
    if base[SIDES] > 0.0:
        if math.sqrt(ux * ux + uy * uy) > FAR * base[REACH] * abs(w):
            sums = _sides_far(base, a, bx, by, ux, uy, w)
        else:
            sums = _sides_near(base, a, bx, by, ux, uy, w)
    for k in range(int(base[DISCS])):
        cx, cy, size, sign = disc_in(base, k)
        one = _disc_at(cx, cy, size, a, bx, by, ux, uy, w)
        sums = (
            sums[0] + sign * one[0], sums[1] + sign * one[1], sums[2] + sign * one[2],
            sums[3] + sign * one[3], sums[4] + sign * one[4], sums[5] + sign * one[5],
        )  # fmt: skip
    return sums


@inner
def grip_slopes(base: FloatArray, ux: float, uy: float, w: float, out: FloatArray) -> Wrench:
    """What keeps a slip going, over f N, and its derivatives into ``out`` (3, 3), in its own axes.

    Row i: of F_x, F_y and the torque; column j: to u_x, u_y and w.  Where friction tilts the load
    the pressure changes, too: the three balances of it are B (a, b) = (1, 0), and dB (a, b) is the
    change of the force with the pressure held, times −z f.
    """
    lever, fx, fy = base[LEVER], base[FIRST_X], base[FIRST_Y]
    sums = base_sums(base, ux, uy, w) if lever != 0.0 else NOTHING
    a, bx, by = pressure_on(base, sums)
    xx, xy, yy, xw, yw, ww = pressed_hessian(base, a, bx, by, ux, uy, w)
    out[0, 0], out[0, 1], out[0, 2] = xx, xy, xw
    out[1, 0], out[1, 1], out[1, 2] = xy, yy, yw
    out[2, 0], out[2, 1], out[2, 2] = xw, yw, ww
    if lever == 0.0:
        return grip(base, ux, uy, w)
    ex, ey, turn = sums[0], sums[1], sums[4] - sums[3]
    gx, gy = (fx - lever * ex) / base[AREA], (fy - lever * ey) / base[AREA]
    mxx = base[SECOND_XX] - lever * sums[2] - gx * fx
    mxy = base[SECOND_XY] - lever * sums[3] - gx * fy
    myx = base[SECOND_XY] - lever * sums[4] - gy * fx
    myy = base[SECOND_YY] - lever * sums[5] - gy * fy
    scale = lever / (mxx * myy - mxy * myx)
    for j in range(3):
        dbx = scale * (myy * out[0, j] - mxy * out[1, j])
        dby = scale * (mxx * out[1, j] - myx * out[0, j])
        da = -(fx * dbx + fy * dby) / base[AREA]
        out[0, j] += ex * da + sums[2] * dbx + sums[3] * dby
        out[1, j] += ey * da + sums[4] * dbx + sums[5] * dby
        out[2, j] += turn * da + sums[6] * dbx + sums[7] * dby
    return under_load(sums, a, bx, by)

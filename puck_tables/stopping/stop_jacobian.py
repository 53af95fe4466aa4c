"""Derivatives of stops by look-up, compiled.

With a = rω, s = sin φ, c = cos φ and D_f = f_u/(s c²) of :mod:`puck_tables.stopping.slopes`, in the
frame of the launch (along its velocity, and to the left of it; w = vx + i vy), for a ≥ 0,

    ∂t/∂v = c (T − s D_T)/J,    ∂t/∂a = (s T + c² D_T)/J,
    ∂z/∂v = [Q (α + c² (α − s D_α)) + i δ a (β − s c² D_β)]/J,    ∂z/∂v_⊥ = i z/v,
    ∂z/∂a = v [s α + c² D_α + i δ (β + s c² D_β)]/J,    ∂z/∂δ = v [Q α_δ + i a (β + δ β_δ)]/J,

and likewise for path and body angle: nothing is divided by v or a, so that pure spin and pure
sliding are cases like all others.  z/v = (Q α + i δ a β)/J.
"""

from __future__ import annotations

import math

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import allocating, inlined, spline_polynomials
from puck_tables.kernels.spline import basis, cell_at
from puck_tables.stopping.lookup import LARGEST, SMALLEST, quick_place, slip_place
from puck_tables.stopping.slopes import STOP_FUNCTIONS, STOP_POWERS, STOP_WIDTH

# what is differentiated, and by what; rows of arrays
TIME, STOP_X, STOP_Y, LENGTH, BODY = range(5)
STOP_ROWS = 5
BY_VX, BY_VY, BY_SPIN, BY_DELTA, BY_DECEL, BY_RADIUS, BY_TIME = range(7)
LAUNCH_COLUMNS = 6

# what a place on the curve says of a stop: five functions, D of each; all again, derived by δ
T, ALONG, ACROSS, TURNED, WAY = range(STOP_FUNCTIONS)
D, BY_HEIGHT = STOP_FUNCTIONS, STOP_WIDTH
STOP_FOUND = 2 * STOP_WIDTH
# of a stop in the frame of its launch: value, by v, by a, by δ; J = 1
BY_SPEED, BY_RIM, BY_TILT = 1, 2, 3
_BLOCK, _ROW = 64, STOP_POWERS * STOP_WIDTH


@inlined
def stop_found(
    slopes: FloatArray, cells: int, side: int, xi: float, delta: float, found: FloatArray
) -> None:
    """The functions of the stop at a place of the curve, into ``found`` (24,); ``slopes`` flat."""
    p = xi * cells
    i = cell_at(p, cells)
    _functions_in(slopes, (side * (cells + 3) + i) * _ROW, p - i, delta, found)


@inlined
def _functions_in(
    slopes: FloatArray, first: int, inside: float, delta: float, found: FloatArray
) -> None:
    s = 2.0 * delta * delta - 1.0
    values = spline_polynomials(slopes, first, basis(inside), s, STOP_WIDTH, STOP_POWERS)
    for f in range(STOP_WIDTH):
        found[f] = values[f]
    for f in range(STOP_FUNCTIONS):
        found[BY_HEIGHT + f] = 4.0 * delta * values[STOP_WIDTH + f]


@inlined
def stop_by_speeds(
    speed: float, rim: float, slip: float, c: float, s: float, delta: float, found: FloatArray,
    out: FloatArray,
) -> None:  # fmt: skip
    """Time, z/v, way and body angle and their derivatives by v, a ≥ 0 and δ, into ``out`` (5, 4).

    Rows: time, along, to the left, path, body angle; J = r = 1.  Along and left: of z, but the
    first column holds z/v.
    """
    c2, sc2 = c * c, s * c * c
    t, dt = found[T], found[D + T]
    out[TIME, 0] = slip * t
    out[TIME, BY_SPEED], out[TIME, BY_RIM] = c * (t - s * dt), s * t + c2 * dt
    out[TIME, BY_TILT] = slip * found[BY_HEIGHT + T]
    f, df = found[ALONG], found[D + ALONG]
    out[STOP_X, 0] = slip * f
    out[STOP_X, BY_SPEED] = slip * (f + c2 * (f - s * df))
    out[STOP_X, BY_RIM] = speed * (s * f + c2 * df)
    out[STOP_X, BY_TILT] = speed * slip * found[BY_HEIGHT + ALONG]
    f, df = found[ACROSS], found[D + ACROSS]
    out[STOP_Y, 0] = delta * rim * f
    out[STOP_Y, BY_SPEED] = delta * rim * (f - sc2 * df)
    out[STOP_Y, BY_RIM] = delta * speed * (f + sc2 * df)
    out[STOP_Y, BY_TILT] = speed * rim * (f + delta * found[BY_HEIGHT + ACROSS])
    f, df = found[WAY], found[D + WAY]
    out[LENGTH, 0] = slip * speed * f
    out[LENGTH, BY_SPEED] = slip * f + speed * c * (f - s * df)
    out[LENGTH, BY_RIM] = speed * (s * f + c2 * df)
    out[LENGTH, BY_TILT] = slip * speed * found[BY_HEIGHT + WAY]
    f, df = found[TURNED], found[D + TURNED]
    out[BODY, 0] = slip * rim * f
    out[BODY, BY_SPEED] = rim * c * (f - s * df)
    out[BODY, BY_RIM] = slip * f + rim * (s * f + c2 * df)
    out[BODY, BY_TILT] = slip * rim * found[BY_HEIGHT + TURNED]


@inlined
def place_stop(
    launch: FloatArray, speed: float, slip: float, own: FloatArray, out: FloatArray
) -> None:
    """From the frame of the launch and Q = J = r = 1, ``own`` (5, 4), to ``out`` (5, 6)."""
    vx, vy, spin, radius = launch[0], launch[1], launch[2], launch[5]
    unit, bend = 1.0 / launch[4], 1.0 / radius
    duration = slip * unit
    place = slip * duration
    east, north = (vx / speed, vy / speed) if speed > 0.0 else (1.0, 0.0)
    around = 1.0 if spin >= 0.0 else -1.0
    for row in (TIME, LENGTH, BODY):
        whole = duration if row == TIME else place
        part = unit if row == TIME else duration
        by_rim = around * part
        if row == BODY:  # changes its sign with the spin
            whole, part, by_rim = around * bend * whole, around * bend * part, bend * part
        value, by_speed = whole * own[row, 0], part * own[row, BY_SPEED]
        by_rim *= own[row, BY_RIM]
        out[row, BY_VX], out[row, BY_VY] = east * by_speed, north * by_speed
        out[row, BY_SPIN] = radius * by_rim
        out[row, BY_DELTA] = whole * own[row, BY_TILT]
        out[row, BY_DECEL] = -value * unit
        out[row, BY_RADIUS] = spin * by_rim - (value * bend if row == BODY else 0.0)
    # z = e (ahead + i aside) v: the derivatives along the velocity and across it
    ahead, aside = duration * own[STOP_X, 0], around * duration * own[STOP_Y, 0]  # z/v
    along, left = duration * own[STOP_X, BY_SPEED], around * duration * own[STOP_Y, BY_SPEED]
    xe, ye = east * along - north * left, east * left + north * along
    xn, yn = -east * aside - north * ahead, east * ahead - north * aside
    out[STOP_X, BY_VX], out[STOP_Y, BY_VX] = east * xe - north * xn, east * ye - north * yn
    out[STOP_X, BY_VY], out[STOP_Y, BY_VY] = north * xe + east * xn, north * ye + east * yn
    along, left = around * duration * own[STOP_X, BY_RIM], duration * own[STOP_Y, BY_RIM]
    x, y = east * along - north * left, east * left + north * along
    out[STOP_X, BY_SPIN], out[STOP_Y, BY_SPIN] = radius * x, radius * y
    out[STOP_X, BY_RADIUS], out[STOP_Y, BY_RADIUS] = spin * x, spin * y
    along, left = place * own[STOP_X, BY_TILT], around * place * own[STOP_Y, BY_TILT]
    out[STOP_X, BY_DELTA] = east * along - north * left
    out[STOP_Y, BY_DELTA] = east * left + north * along
    out[STOP_X, BY_DECEL] = -unit * (ahead * vx - aside * vy)
    out[STOP_Y, BY_DECEL] = -unit * (ahead * vy + aside * vx)


@allocating
def fill_stop_jacobians(launches: FloatArray, slopes: FloatArray, out: FloatArray) -> None:
    """∂(time, x, y, path, body angle)/∂(vx, vy, ω, δ, J, r) of launches (6, n) into (n, 5, 6).

    ``slopes``: :attr:`puck_tables.stopping.slopes.Slopes.stops`.  NaN for a launch at rest, where
    the time has no derivative, and for the path of pure spin by vx and vy, which grows like |v|.
    """
    cells = slopes.shape[1] - 3
    flat = slopes.reshape(-1)
    found, own = np.empty(STOP_FOUND), np.empty((STOP_ROWS, 4))
    first = np.empty(_BLOCK, np.int64)
    inside, speeds = np.empty(_BLOCK), np.empty(_BLOCK)
    rims, slips = np.empty(_BLOCK), np.empty(_BLOCK)
    for start in range(0, launches.shape[1], _BLOCK):
        block = launches[:, start : start + _BLOCK]
        unsafe = 0
        for n in range(block.shape[1]):
            vx, vy, rim = block[0, n], block[1, n], abs(block[5, n] * block[2, n])
            speed2 = vx * vx + vy * vy
            slip2 = speed2 + rim * rim
            speed, slip = math.sqrt(speed2), math.sqrt(slip2)
            unsafe += 0 if (speed2 > SMALLEST) & (slip2 < LARGEST) else 1
            cell, inside[n] = quick_place(speed, rim, float(cells))
            first[n] = _ROW * (int(cell) + (cells + 3 if rim > speed else 0))
            speeds[n], rims[n], slips[n] = speed, rim, slip
        if unsafe > 0:  # anew, with care for rest along the way, and for the largest and smallest
            for n in range(block.shape[1]):
                vx, vy, rim = block[0, n], block[1, n], rims[n]
                speed2 = vx * vx + vy * vy
                if (speed2 > SMALLEST) & (speed2 + rim * rim < LARGEST):
                    continue  # the same bits whatever else is in the block
                speed = math.hypot(vx, vy)
                slip = math.hypot(speed, rim)
                side, xi = slip_place(speed, rim)
                i = cell_at(xi * cells, cells)
                inside[n], first[n] = xi * cells - i, _ROW * (i + side * (cells + 3))
                speeds[n], slips[n] = speed, slip
        for n in range(block.shape[1]):
            delta = block[3, n]
            _functions_in(flat, first[n], inside[n], delta, found)
            speed, rim, slip = speeds[n], rims[n], slips[n]
            cosine, sine = speed / slip, rim / slip
            stop_by_speeds(cosine, sine, 1.0, cosine, sine, delta, found, own)
            here = out[start + n]
            place_stop(block[:, n], speed, slip, own, here)
            if speed == 0.0:
                here[LENGTH, BY_VX] = here[LENGTH, BY_VY] = math.nan


@allocating
def fill_placed_stops(launches: FloatArray, own: FloatArray, out: FloatArray) -> None:
    """Derivatives of stops (n, 5, 6) from natural ones ``own`` (n, 5, 4) of launches (6, n)."""
    for n in range(launches.shape[1]):
        launch = launches[:, n]
        speed = math.hypot(launch[0], launch[1])
        slip = math.hypot(speed, launch[5] * launch[2])
        place_stop(launch, speed, slip, own[n], out[n])
        if speed == 0.0:
            out[n, LENGTH, BY_VX] = out[n, LENGTH, BY_VY] = math.nan

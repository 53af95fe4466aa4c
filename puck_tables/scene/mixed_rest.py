"""What a floor holds of a puck at rest astride several frictions.

At rest the demand on the floor fixes where the load stands, b = z F/N; under a puck that is
guided, which leaves open what the floor takes up across, friction in the slip that begins does.
With the pressure known, friction holds a force and a torque if no slip gains energy: P·n ≤ D(n) =
∫ f σ |u| dA for all slips n = (u_x, u_y, r ω), P = (F_x, F_y, T/r).  D is convex and its gradient
is the wrench of friction, so that the worst slip is the least of D on the plane P·n = 1.  Where the
puck is held only just, this is the same as friction in that slip being P.
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, inner
from puck_tables.kernels.law_sums import coefficient_at_rest
from puck_tables.scene.base_balance import friction_held, rub_at_rest
from puck_tables.scene.floor_map import (
    ACROSS_X,
    ACROSS_Y,
    AXES,
    BELTS,
    BORDERS,
    LEVER,
    MIDDLE_X,
    MIDDLE_Y,
    OVER_X,
    OVER_Y,
    PATCHES,
    PLACE_X,
    PLACE_Y,
    REACH,
    SHARE,
    border_of,
    law_on,
    patch_of,
    sum_over,
    summed_load,
)

Yield = tuple[float, float, float, float]

_NARROW = 1e-9  # of the slip: what is left of a bracket; the excess errs by the square
_WIDEST, _TRIALS = 60, 60  # at most: to bracket, and in the bracket
_TILTED = 1e-14  # of friction: what the load's tilt is known to


@inlined
def _at_rest(floor_map: FloatArray, part: int) -> float:
    """F N on a stretch at slip zero, in the direction of the least."""
    law, load = law_on(floor_map, part), summed_load(floor_map, part)
    if law == 0:
        return load
    by_speed, least = floor_map[law + AXES :], min(floor_map[law], floor_map[law + 1])
    return load * least * (coefficient_at_rest(by_speed) if by_speed[0] > 0.0 else 1.0)


@inner
def least_under(floor_map: FloatArray, radius: float) -> float:
    """The least f N that a base may have under a part of it."""
    x, y = floor_map[PLACE_X], floor_map[PLACE_Y]
    place = floor_map[ACROSS_X] * x + floor_map[ACROSS_Y] * y
    least = math.inf
    for i in range(int(floor_map[BORDERS]) + 1):
        below = i == 0 or border_of(floor_map, i - 1) < place + radius
        if below and (i == int(floor_map[BORDERS]) or border_of(floor_map, i) > place - radius):
            least = min(least, _at_rest(floor_map, i))
    for k in range(int(floor_map[PATCHES])):
        dx, dy = patch_of(floor_map, k, MIDDLE_X) - x, patch_of(floor_map, k, MIDDLE_Y) - y
        if math.sqrt(dx * dx + dy * dy) < radius + patch_of(floor_map, k, REACH):
            least = min(least, _at_rest(floor_map, int(floor_map[BORDERS]) + 1 + k))
    return floor_map[SHARE] * least


@inner
def _held(
    floor_map: FloatArray, radius: float, nx: float, ny: float, rim: float, mx: float, my: float
) -> tuple[float, float, float]:
    """∫ f σ e dA and its moment over r at a slip of Q = 1, of a load at (mx, my), m.

    Of belts the one is summed that states are relative to.
    """
    if floor_map[BELTS] != 0.0:
        sum_over(floor_map, floor_map[OVER_X], floor_map[OVER_Y], False)
    fx, fy, turning = friction_held(floor_map, nx, ny, rim / radius, mx, my)
    if floor_map[BELTS] != 0.0:
        sum_over(floor_map, 0.0, 0.0, True)
    return fx, fy, turning / radius


@inner
def _slope_along(
    floor_map: FloatArray, radius: float, bx: float, by: float, n: tuple[float, float, float],
    direction: tuple[float, float, float], a: float,
) -> float:  # fmt: skip
    nx, ny, nw = n[0] + a * direction[0], n[1] + a * direction[1], n[2] + a * direction[2]
    whole = math.sqrt(nx * nx + ny * ny + nw * nw)  # at a slip of any size D is as steep
    gx, gy, gw = _held(floor_map, radius, nx / whole, ny / whole, nw / whole, bx, by)
    return gx * direction[0] + gy * direction[1] + gw * direction[2]


@inner
def _least_along(
    floor_map: FloatArray, radius: float, bx: float, by: float, n: tuple[float, float, float],
    direction: tuple[float, float, float], size: float,
) -> float:  # fmt: skip
    """Where on the line n + a way D is least: its slope grows; false position (Illinois)."""
    first = _slope_along(floor_map, radius, bx, by, n, direction, 0.0)
    if first == 0.0:
        return 0.0
    side = -1.0 if first > 0.0 else 1.0
    low, high, last, reach = 0.0, 0.0, first, 0.25 * size
    for _ in range(_WIDEST):
        high = side * reach
        last = _slope_along(floor_map, radius, bx, by, n, direction, high)
        if last * first <= 0.0:
            break
        low, first = high, last
        reach *= 4.0
    for _ in range(_TRIALS):
        if abs(high - low) <= _NARROW * (size + abs(high)) or last == 0.0:
            break
        middle = (low * last - high * first) / (last - first)
        value = _slope_along(floor_map, radius, bx, by, n, direction, middle)
        low, first = (high, last) if value * last <= 0.0 else (low, 0.5 * first)
        high, last = middle, value
    return high


@inner
def mixed_yield(
    floor_map: FloatArray, most: float, static: float, radius: float, fx: float, fy: float,
    torque: float, guided: bool,
) -> Yield:  # fmt: skip
    """By how much the power of the best slip at Q = 1 exceeds friction, and that slip.

    What other belts do to it is force, too.  ``most``: f N of the largest f; ``static``: times what
    friction is in a slip; ``guided``: the puck can slip along the force only, and turn.
    """
    force = math.sqrt(fx * fx + fy * fy)
    lever = floor_map[LEVER]
    bx, by = lever * fx, lever * fy
    if force > most:  # it slips: what tilts is friction
        bx, by = bx * most / force, by * most / force
    if floor_map[BELTS] != 0.0:
        rx, ry, turning, _ = rub_at_rest(floor_map, bx, by)
        fx, fy, torque = fx + rx, fy + ry, torque + turning
        force = math.sqrt(fx * fx + fy * fy)
    rim = torque / radius
    size = math.sqrt(force * force + rim * rim)
    if size == 0.0:
        gx, _, _ = _held(floor_map, radius, 1.0, 0.0, 0.0, 0.0, 0.0)
        return -static * gx, 1.0, 0.0, 0.0
    ex, ey = (fx / force, fy / force) if force > 0.0 else (1.0, 0.0)
    px, pw = force / size, rim / size
    n = (px * ex, px * ey, pw)
    gx, gy, gw = _held(floor_map, radius, n[0], n[1], n[2], bx, by)
    if math.isnan(gx):  # no pressure carries it: nothing is to be looked for
        return math.nan, n[0], n[1], n[2] / radius
    level, turns = (-ey, ex, 0.0), (-pw * ex, -pw * ey, px)
    for _ in range(_TRIALS):
        a = _least_along(floor_map, radius, bx, by, n, turns, 1.0)
        m = (n[0] + a * turns[0], n[1] + a * turns[1], n[2] + a * turns[2])
        if not guided:
            # of the least along every parallel of ``turns``: its slope across them grows, too
            m = _least_in_plane(floor_map, radius, bx, by, n, level, turns)
        whole = math.sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2])
        m = (m[0] / whole, m[1] / whole, m[2] / whole)
        gx, gy, gw = _held(floor_map, radius, m[0], m[1], m[2], bx, by)
        if not guided:
            break
        # what tilts is friction, also that across, which the guide bears
        tilts = lever * static
        off = abs(tilts * gx - bx) + abs(tilts * gy - by)
        bx, by = tilts * gx, tilts * gy
        if off <= _TILTED * most * lever:
            break
    power = static * (gx * m[0] + gy * m[1] + gw * m[2])
    return fx * m[0] + fy * m[1] + rim * m[2] - power, m[0], m[1], m[2] / radius


@inner
def _slope_across(
    floor_map: FloatArray, radius: float, bx: float, by: float, n: tuple[float, float, float],
    level: tuple[float, float, float], turns: tuple[float, float, float], b: float,
) -> tuple[float, float]:  # fmt: skip
    """The slope of D along ``level`` where it is least along ``turns``, and how far that is."""
    p = (n[0] + b * level[0], n[1] + b * level[1], n[2] + b * level[2])
    size = math.sqrt(1.0 + b * b)
    a = _least_along(floor_map, radius, bx, by, p, turns, size)
    p = (p[0] + a * turns[0], p[1] + a * turns[1], p[2] + a * turns[2])
    return _slope_along(floor_map, radius, bx, by, p, level, 0.0), a


@inner
def _least_in_plane(
    floor_map: FloatArray, radius: float, bx: float, by: float, n: tuple[float, float, float],
    level: tuple[float, float, float], turns: tuple[float, float, float],
) -> tuple[float, float, float]:  # fmt: skip
    """Where on the plane n + b level + a turns D is least."""
    first, a = _slope_across(floor_map, radius, bx, by, n, level, turns, 0.0)
    low, high, last = 0.0, 0.0, first
    side, reach = (-1.0 if first > 0.0 else 1.0), 0.25
    if first != 0.0:
        for _ in range(_WIDEST):
            high = side * reach
            last, a = _slope_across(floor_map, radius, bx, by, n, level, turns, high)
            if last * first <= 0.0:
                break
            low, first = high, last
            reach *= 4.0
    for _ in range(_TRIALS):
        if abs(high - low) <= _NARROW * (1.0 + abs(high)) or last == 0.0:
            break
        middle = (low * last - high * first) / (last - first)
        value, a = _slope_across(floor_map, radius, bx, by, n, level, turns, middle)
        low, first = (high, last) if value * last <= 0.0 else (low, 0.5 * first)
        high, last = middle, value
    return (
        n[0] + high * level[0] + a * turns[0],
        n[1] + high * level[1] + a * turns[1],
        n[2] + high * level[2] + a * turns[2],
    )

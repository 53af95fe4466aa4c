"""How a base is carried by its floor, or by what edges leave of it there, and the friction then."""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.base_friction import (
    AREA,
    REACH,
    base_sums,
    is_uniform,
    moments_in,
    pressure_over,
    under_load,
)
from puck_tables.kernels.base_sums import NOTHING, Sums
from puck_tables.kernels.compile import inner
from puck_tables.kernels.pressed_part import MOST_ROUNDS, Pressed, next_pressed
from puck_tables.scene.base_on_floor import friction_sums
from puck_tables.scene.floor_map import (
    ANGLE,
    BASE,
    BORDERS,
    LAW,
    LEAST_WIDTH,
    LEFT,
    LEVER,
    LIFTS,
    PATCHES,
    SHARE,
    load_of,
)
from puck_tables.scene.over_edges import left_on_floor


@inner
def sums_and_pressure(
    floor_map: FloatArray, ux: float, uy: float, w: float, moving: float, lever: float,
    mx: float, my: float,
) -> tuple[Sums, float, float, float]:  # fmt: skip
    """Sums over what is pressed, and a, b_x and b_y of its pressure; no numbers where it tips.

    ``lever``: of what slips its height over N, m/N; (mx, my): where the load of what is at rest
    stands; both in the axes of the base.
    """
    base = floor_map[int(floor_map[BASE]) :]
    first, last, to = left_on_floor(floor_map)
    if first < int(floor_map[LEFT]) and floor_map[LIFTS] == 0.0:  # all of it
        one = floor_map[BORDERS] == 0.0 and floor_map[PATCHES] == 0.0 and floor_map[LAW] == 0.0
        if one and is_uniform(base):
            a = floor_map[SHARE] * load_of(floor_map, 0) / base[AREA]
            return base_sums(base, ux, uy, w), a, 0.0, 0.0
        sums = friction_sums(floor_map, first, last, ux, uy, w, moving)
        a, bx, by = pressure_over(moments_in(base), sums, lever, mx, my)
        return sums, a, bx, by
    narrowest = floor_map[LEAST_WIDTH]
    sums, part, rounds = NOTHING, Pressed(first, last, 0.0, 0.0, 0.0, math.inf), 0
    while part.moved > 0.0 and rounds < MOST_ROUNDS:
        if lever != 0.0:
            sums = friction_sums(floor_map, part.first, part.last, ux, uy, w, moving)
        part = next_pressed(
            floor_map, first, last, to, base[REACH], narrowest, part, sums, lever, mx, my
        )  # fmt: skip
        rounds += 1
    if lever == 0.0:
        sums = friction_sums(floor_map, part.first, part.last, ux, uy, w, moving)
    a = part.a if part.moved == 0.0 else math.nan
    return sums, a, part.bx, part.by


@inner
def friction_of_base(
    floor_map: FloatArray, ux: float, uy: float, w: float, moving: float
) -> tuple[float, float, float, float]:
    """Force, torque and the power they take, at velocities relative to the floor, not all 0.

    ``moving`` 0: with the friction at slip zero, whatever the slip.
    """
    c, s = math.cos(floor_map[ANGLE]), math.sin(floor_map[ANGLE])
    lever = floor_map[LEVER]
    sums, a, bx, by = sums_and_pressure(
        floor_map, c * ux + s * uy, c * uy - s * ux, w, moving, lever, 0.0, 0.0
    )  # fmt: skip
    x, y, torque = under_load(sums, a, bx, by)
    fx, fy = c * x - s * y, s * x + c * y
    return -fx, -fy, -torque, fx * ux + fy * uy + torque * w


@inner
def friction_held(
    floor_map: FloatArray, ux: float, uy: float, w: float, mx: float, my: float
) -> tuple[float, float, float]:
    """∫ f p e dA and its moment, of the pressure that carries a moment (mx, my) of the load, m."""
    c, s = math.cos(floor_map[ANGLE]), math.sin(floor_map[ANGLE])
    sums, a, bx, by = sums_and_pressure(
        floor_map, c * ux + s * uy, c * uy - s * ux, w, 0.0, 0.0, c * mx + s * my, c * my - s * mx
    )
    x, y, torque = under_load(sums, a, bx, by)
    return c * x - s * y, s * x + c * y, torque

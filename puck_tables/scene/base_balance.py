"""How a base is carried by its floor, or by what edges leave of it there, and the friction then.

On stretches of the floor with velocities of their own each part of the base is summed with its own
slip: those of one velocity together, with all others left out.  Sums are in axes of the base, and
add up there; then the load tilts as it does on several frictions.  States are relative to one of
the velocities.  What moves at it rests on its part of the floor, which holds it against what the
others do: their friction is a force like any other.
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.base_clipping import beyond_line, whole_contour
from puck_tables.kernels.base_friction import (
    AREA,
    REACH,
    base_sums,
    is_uniform,
    moments_in,
    pressure_over,
    under_load,
)
from puck_tables.kernels.base_sums import NOTHING, Sums, plus
from puck_tables.kernels.compile import inlined, inner
from puck_tables.kernels.pressed_part import MOST_ROUNDS, Pressed, next_pressed
from puck_tables.scene.base_on_floor import friction_sums
from puck_tables.scene.floor_map import (
    ACROSS_X,
    ACROSS_Y,
    BASE,
    BELTS,
    BORDERS,
    COSINE,
    EDGES,
    LAW,
    LEAST_WIDTH,
    LEFT,
    LEVER,
    LIFTS,
    OVER_X,
    OVER_Y,
    PATCHES,
    PLACE_X,
    PLACE_Y,
    ROOM,
    SHARE,
    SINE,
    belt_of,
    border_of,
    distance_to,
    edge_of,
    load_of,
    parts_in,
    sum_over,
)

# of the reach: the centre of mass is taken to be this far on the floor at least, for what is
# pressed shrinks to a line as it comes to an edge
_LEAST = 1e-4

Far = tuple[float, float, float]  # Σ over the parts of velocity times e, x e and y e

_NO_POWER: Far = (0.0, 0.0, 0.0)  # W, of what moves at the velocity that states are relative to


@inner
def left_on_floor(floor_map: FloatArray) -> tuple[int, int, int]:
    """Where the contour begins and ends that edges leave of a base, and where there is room.

    That of the base itself where no edge is under it.
    """
    begin, one = int(floor_map[BASE]), int(floor_map[LEFT])
    reach, to, other = floor_map[begin + REACH], one, (one + int(floor_map[ROOM])) // 2
    first, last = whole_contour(floor_map[begin:], begin)
    for k in range(int(floor_map[EDGES])):
        east, north, place = edge_of(floor_map, k)
        place -= east * floor_map[PLACE_X] + north * floor_map[PLACE_Y]
        if place > -reach:
            c, s = floor_map[COSINE], floor_map[SINE]
            nx, ny = c * east + s * north, c * north - s * east
            place = min(place, -_LEAST * reach)
            end = beyond_line(floor_map, first, last, to, nx, ny, place, math.inf, math.inf)
            first, last, to, other = to, end, other, to
    return first, last, to


@inner
def _lies_on(floor_map: FloatArray, area: int, x: float, y: float, radius: float) -> bool:
    """Whether a base at a place may have a part on a strip, or after all of them a patch."""
    strips = int(floor_map[BORDERS]) + 1
    if area >= strips:
        return distance_to(floor_map, area - strips, x, y) < radius
    place = floor_map[ACROSS_X] * x + floor_map[ACROSS_Y] * y
    if area > 0 and place + radius <= border_of(floor_map, area - 1):
        return False
    if area < strips - 1 and place - radius >= border_of(floor_map, area):
        return False
    covered = False
    for k in range(int(floor_map[PATCHES])):
        covered = covered or distance_to(floor_map, k, x, y) <= -radius
    return not covered


@inlined
def _is_first(floor_map: FloatArray, area: int) -> bool:
    """Whether no stretch before has the same velocity."""
    vx, vy = belt_of(floor_map, area)
    for before in range(area):
        ox, oy = belt_of(floor_map, before)
        if ox == vx and oy == vy:
            return False
    return True


@inner
def nearest_belt(
    floor_map: FloatArray, x: float, y: float, radius: float, vx: float, vy: float
) -> tuple[float, float, float]:
    """Of the velocities under a base at a place the one nearest to (vx, vy), and how far it is."""
    least, bx, by = math.inf, floor_map[OVER_X], floor_map[OVER_Y]
    for area in range(parts_in(floor_map)):
        ox, oy = belt_of(floor_map, area)
        off = math.sqrt((vx - ox) * (vx - ox) + (vy - oy) * (vy - oy))
        if off < least and _lies_on(floor_map, area, x, y, radius):
            least, bx, by = off, ox, oy
    return bx, by, least


@inner
def is_rubbed(floor_map: FloatArray, radius: float) -> bool:
    """Whether parts of a base may lie on velocities that differ."""
    if floor_map[BELTS] == 0.0:
        return False
    for area in range(parts_in(floor_map)):
        ox, oy = belt_of(floor_map, area)
        other = ox != floor_map[OVER_X] or oy != floor_map[OVER_Y]
        if other and _lies_on(floor_map, area, floor_map[PLACE_X], floor_map[PLACE_Y], radius):
            return True
    return False


@inner
def _sums_over_belts(
    floor_map: FloatArray, first: int, last: int, ux: float, uy: float, w: float, moving: float
) -> tuple[Sums, Far]:
    """Sums over all parts of a contour that slip, each at its own velocity, in axes of the base.

    And what they take to far off.
    """
    c, s = floor_map[COSINE], floor_map[SINE]
    sums, one, two, three = NOTHING, 0.0, 0.0, 0.0
    for area in range(parts_in(floor_map)):
        bx, by = belt_of(floor_map, area)
        ox, oy = bx - floor_map[OVER_X], by - floor_map[OVER_Y]
        px, py = c * ox + s * oy, c * oy - s * ox
        vx, vy = ux - px, uy - py
        if (vx == 0.0 and vy == 0.0 and w == 0.0) or not _is_first(floor_map, area):
            continue
        sum_over(floor_map, bx, by, False)
        part = friction_sums(floor_map, first, last, vx, vy, w, moving)
        sums = plus(sums, 1.0, part)
        one += px * part[0] + py * part[1]
        two += px * part[2] + py * part[4]
        three += px * part[3] + py * part[5]
    sum_over(floor_map, 0.0, 0.0, True)
    return sums, (one, two, three)


@inlined
def _sums(
    floor_map: FloatArray, first: int, last: int, ux: float, uy: float, w: float, moving: float,
    by_belts: bool,
) -> tuple[Sums, Far]:  # fmt: skip
    """Sums over a contour, of belts each at its own slip or those that are summed now at one."""
    if by_belts and floor_map[BELTS] != 0.0:
        return _sums_over_belts(floor_map, first, last, ux, uy, w, moving)
    return friction_sums(floor_map, first, last, ux, uy, w, moving), _NO_POWER


@inner
def sums_and_pressure(
    floor_map: FloatArray, ux: float, uy: float, w: float, moving: float, lever: float,
    mx: float, my: float, by_belts: bool,
) -> tuple[Sums, Far, float, float, float]:  # fmt: skip
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
            return base_sums(base, ux, uy, w), _NO_POWER, a, 0.0, 0.0
        sums, far = _sums(floor_map, first, last, ux, uy, w, moving, by_belts)
        a, bx, by = pressure_over(moments_in(base), sums, lever, mx, my)
        return sums, far, a, bx, by
    narrowest = floor_map[LEAST_WIDTH]
    sums, far, rounds = NOTHING, _NO_POWER, 0
    part = Pressed(first, last, 0.0, 0.0, 0.0, math.inf)
    while part.moved > 0.0 and rounds < MOST_ROUNDS:
        if lever != 0.0:
            sums, far = _sums(floor_map, part.first, part.last, ux, uy, w, moving, by_belts)
        part = next_pressed(
            floor_map, first, last, to, base[REACH], narrowest, part, sums, lever, mx, my
        )  # fmt: skip
        rounds += 1
    if lever == 0.0:
        sums, far = _sums(floor_map, part.first, part.last, ux, uy, w, moving, by_belts)
    a = part.a if part.moved == 0.0 else math.nan
    return sums, far, a, part.bx, part.by


@inner
def _friction(
    floor_map: FloatArray, ux: float, uy: float, w: float, moving: float, lever: float,
    mx: float, my: float,
) -> tuple[float, float, float, float]:  # fmt: skip
    """Force, torque and heat; of what is at rest (lever 0) what other belts do."""
    c, s = floor_map[COSINE], floor_map[SINE]
    sums, far, a, bx, by = sums_and_pressure(
        floor_map, c * ux + s * uy, c * uy - s * ux, w, moving, lever, c * mx + s * my,
        c * my - s * mx, True,
    )  # fmt: skip
    x, y, torque = under_load(sums, a, bx, by)
    fx, fy = c * x - s * y, s * x + c * y
    heat = fx * ux + fy * uy + torque * w - (a * far[0] + bx * far[1] + by * far[2])
    return -fx, -fy, -torque, heat


@inner
def friction_on_floor(
    floor_map: FloatArray, ux: float, uy: float, w: float, moving: float
) -> tuple[float, float, float, float]:
    """Force, torque, and the heat of all parts, at velocities relative to the floor, not all 0.

    ``moving`` 0: with the friction at slip zero, whatever the slip.
    """
    return _friction(floor_map, ux, uy, w, moving, floor_map[LEVER], 0.0, 0.0)


@inner
def rub_at_rest(floor_map: FloatArray, mx: float, my: float) -> tuple[float, float, float, float]:
    """Force, torque and heat of other belts on who rests, whose load stands at (mx, my), m."""
    return _friction(floor_map, 0.0, 0.0, 0.0, 1.0, 0.0, mx, my)  # they slip


@inlined
def heat_at_rest(floor_map: FloatArray, fx: float, fy: float) -> float:
    """The heat of other belts under who rests, where the floor does the force (fx, fy) to it."""
    if not is_rubbed(floor_map, floor_map[int(floor_map[BASE]) + REACH]):
        return 0.0  # also as it tips, where nothing is known of its pressure
    return rub_at_rest(floor_map, -floor_map[LEVER] * fx, -floor_map[LEVER] * fy)[3]


@inner
def friction_held(
    floor_map: FloatArray, ux: float, uy: float, w: float, mx: float, my: float
) -> tuple[float, float, float]:
    """∫ f p e dA and its moment, of the pressure that carries a moment (mx, my) of the load, m."""
    c, s = floor_map[COSINE], floor_map[SINE]
    mx, my = c * mx + s * my, c * my - s * mx
    sums, _, a, bx, by = sums_and_pressure(
        floor_map, c * ux + s * uy, c * uy - s * ux, w, 0.0, 0.0, mx, my, False
    )
    x, y, torque = under_load(sums, a, bx, by)
    return c * x - s * y, s * x + c * y, torque

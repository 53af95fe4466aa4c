"""How the compiled engine of many pucks reads its arrays.

A *disc* is a puck, or a body whose motion is given.  States are rows x, y, angle, vx, vy, spin of
the laboratory (:mod:`puck_tables.scene.friction`).  Impacts and sustained contacts are between
two discs, or a disc and an obstacle that stands still; a partner is one number: a disc ``j ≥ 0``
by itself, an obstacle ``k`` as ``−1 − k``.  A restitution is one number too: ``e ≥ 0`` by itself, a
law as ``−1`` less its place.

By which law a disc meets its partner: of two discs the smaller of each number counts, of
restitutions at the speed at which they meet; an obstacle says it alone; a law of a pair comes
before both.  ``rims`` (…,) is one array, for every array that is handed to a kernel takes its time:
how many kinds of rims there are, c; for every two kinds, c² numbers, where in it the restitution,
tangential restitution and friction of such a pair stand (−1: none; NaN where one is as without);
these; and the numbers of all laws of restitution.

An obstacle has a gap to a disc, a normal, a curvature, and where it ends: walls and edges go on for
ever, sides between two ends at which corners stand; posts and pockets are circles from outside,
arcs parts of circles from within.
"""

from __future__ import annotations

import math

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined
from puck_tables.scene.forces import DRAGS, acts
from puck_tables.scene.restitution_at import restitution_at

OF_PAIR_RESTITUTION, OF_PAIR_TANGENTIAL, OF_PAIR_FRICTION = range(3)
# columns of a disc; one whose motion is given has the inverses 0
RADIUS, INV_MASS, INV_INERTIA, DECEL, DELTA = range(5)  # r, 1/m, 1/I, J = f g, 2 f h/r
RESTITUTION, TANGENTIAL, FRICTION = 5, 6, 7  # of its rim
# 1: also alone; what is known of its motion is an integral, no table.  2: nor does DECEL say what
# holds it at rest
INTEGRATED = 8
MAKE = 9  # which kind of rim it has, where pairs of kinds have a law of their own
PULL_X, PULL_Y, TWIST = 10, 11, 12  # accelerations of slope and given forces, m/s², rad/s²
# one :class:`~puck_tables.scene.ingredients.VelocityConstraint`, fixed in place at t = 0
HOLD, HOLD_X, HOLD_Y, HOLD_REACH, HOLD_ANGLE, HOLD_VX, HOLD_VY, HOLD_PLACE = range(13, 21)
REGION = 21  # of the dry friction under it: where on the floor it is, times discs, and its number
NORMAL, HEIGHT_RATIO = 22, 23  # N, and 2h/r over 4⟨x²⟩/r²: where friction depends on the slip
# how the floor moves that it is on, of belts the one nearest to its own velocity, and how that
# changes
BELT_X, BELT_Y, BELT_SPIN, BELT_AX, BELT_AY, BELT_TURN = range(24, 30)
DRAG = 30  # the first of what acts over the floor, see :func:`puck_tables.scene.forces.drags_of`
# from here on how its base lies to every border of strips, and then to every patch
# (:mod:`puck_tables.world.floor_under`)
LIES = DRAG + DRAGS
DISC_COLUMNS = LIES  # without those

# columns of an obstacle: for a wall or edge (A, B) is its unit normal, into the field, and C its
# place along it; for the others (A, B) is the centre, C the radius; [FROM, FROM + SPAN] are the
# angles of an arc.  A side is a wall between two ends, (START_X, START_Y) and (END_X, END_Y), its
# normal to the left of the way from one to the other; a corner a post of radius 0 that is met from
# beyond two walls only, along which these four are unit vectors from it.  Of a border or patch A is
# its number among both: the ground knows the rest.  Of an overhang EDGE_NUMBER is that of the edge
KIND, A, B, C = range(4)
WALL_RESTITUTION, WALL_TANGENTIAL, WALL_FRICTION = 4, 5, 6
FROM, SPAN = 7, 8
EDGE_NUMBER = 7
START_X, START_Y, END_X, END_Y = range(9, 13)
OBSTACLE_MAKE = 13
OBSTACLE_COLUMNS = 14

# of pocket and edge the centre counts; where the rim comes over an edge is told, and no more
WALL, POST, ARC, SIDE, CORNER, POCKET, EDGE, OVERHANG, BORDER, PATCH = range(10)
NO_CUSHION = POCKET  # from there on: no impact
ON_FLOOR = BORDER  # from there on: where friction changes under the base


@inlined
def _pair_of(rims: FloatArray, discs: FloatArray, obstacles: FloatArray, i: int, j: int) -> int:
    """Where the numbers of a pair stand; −1: none."""
    kinds = int(rims[0])
    if kinds == 0:
        return -1
    other = discs[j, MAKE] if j >= 0 else obstacles[-1 - j, OBSTACLE_MAKE]
    return int(rims[1 + int(discs[i, MAKE]) * kinds + int(other)])


@inlined
def along_of_pair(
    rims: FloatArray, discs: FloatArray, obstacles: FloatArray, i: int, j: int
) -> tuple[float, float]:
    """Tangential restitution and friction where disc i meets its partner j."""
    if j >= 0:
        beta = min(discs[i, TANGENTIAL], discs[j, TANGENTIAL])
        mu = min(discs[i, FRICTION], discs[j, FRICTION])
    else:
        beta, mu = obstacles[-1 - j, WALL_TANGENTIAL], obstacles[-1 - j, WALL_FRICTION]
    at = _pair_of(rims, discs, obstacles, i, j)
    if at >= 0:
        own, grip = rims[at + OF_PAIR_TANGENTIAL], rims[at + OF_PAIR_FRICTION]
        beta = beta if math.isnan(own) else own
        mu = mu if math.isnan(grip) else grip
    return beta, mu


@inlined
def restitutions_of_pair(
    rims: FloatArray, discs: FloatArray, obstacles: FloatArray, i: int, j: int
) -> tuple[float, float]:
    """The restitutions, numbers or laws, the smaller of which counts."""
    at = _pair_of(rims, discs, obstacles, i, j)
    if at >= 0 and not math.isnan(rims[at + OF_PAIR_RESTITUTION]):
        return rims[at + OF_PAIR_RESTITUTION], rims[at + OF_PAIR_RESTITUTION]
    if j >= 0:
        return discs[i, RESTITUTION], discs[j, RESTITUTION]
    k = -1 - j
    return obstacles[k, WALL_RESTITUTION], obstacles[k, WALL_RESTITUTION]


@inlined
def smaller_at(rims: FloatArray, one: float, other: float, speed: float) -> float:
    """The smaller of two restitutions at a speed of approach; −1 beyond the end of a table."""
    if one < 0.0:
        one = restitution_at(rims, int(-1.0 - one), speed)
    if other < 0.0:
        other = restitution_at(rims, int(-1.0 - other), speed)
    return min(one, other)


@inlined
def kinetic(disc: FloatArray, vx: float, vy: float, spin: float) -> float:
    """½ m v² + ½ I ω², J; nothing of what is driven."""
    if disc[INV_MASS] == 0.0:
        return 0.0
    return 0.5 * (vx * vx + vy * vy) / disc[INV_MASS] + 0.5 * spin * spin / disc[INV_INERTIA]


@inlined
def write_over(row: FloatArray, values: FloatArray) -> None:
    """Make the first numbers of a row those of another, or of some whole numbers."""
    for column in range(values.shape[0]):
        row[column] = values[column]


@inlined
def feels_floor(disc: FloatArray) -> bool:
    """Whether dry friction, or anything else over the floor, acts on a disc."""
    return disc[DECEL] > 0.0 or acts(disc[DRAG:])


TOUCH = 1e-12  # of the radius: a gap as small is none
ROUNDED = 1e-15  # of the places: a gap as small is none


@inlined
def in_span(angle: float, start: float, span: float) -> bool:
    """Whether an angle lies in [start, start + span]."""
    turns = (angle - start) / (2.0 * math.pi)
    return 2.0 * math.pi * (turns - float(np.floor(turns))) <= span


@inlined
def beyond_ends(obstacle: FloatArray, x: float, y: float) -> tuple[float, float, float]:
    """How far a centre is beyond where a side or a corner is met, less than 0 within; its gradient.

    The same sums decide about a side and about the corners at its ends.
    """
    if obstacle[KIND] == SIDE:
        ux, uy = obstacle[B], -obstacle[A]
        before = (obstacle[START_X] - x) * ux + (obstacle[START_Y] - y) * uy
        after = (x - obstacle[END_X]) * ux + (y - obstacle[END_Y]) * uy
        return (before, -ux, -uy) if before > after else (after, ux, uy)
    dx, dy = x - obstacle[A], y - obstacle[B]
    one = dx * obstacle[START_X] + dy * obstacle[START_Y]
    other = dx * obstacle[END_X] + dy * obstacle[END_Y]
    if one > other:
        return one, obstacle[START_X], obstacle[START_Y]
    return other, obstacle[END_X], obstacle[END_Y]


@inlined
def slack_of(radius: float, x: float, y: float) -> float:
    """How far sides reach beyond their ends: no rounding leaves a gap between them and corners.

    Of what touches it is then a side, no corner.  What runs off a side does so twice as far away.
    """
    return TOUCH * radius + 4.0 * ROUNDED * (abs(x) + abs(y))


@inlined
def normal_to(
    obstacle: FloatArray, radius: float, x: float, y: float, slack: float
) -> tuple[float, float, float, bool]:
    """The gap of a disc to an obstacle, the unit normal towards it, and whether it is there.

    ``slack``: see :func:`slack_of`, or 0.
    """
    kind = int(obstacle[KIND])
    if kind in (WALL, EDGE, OVERHANG):
        margin = 0.0 if kind == EDGE else radius
        gap = obstacle[A] * x + obstacle[B] * y - obstacle[C] - margin
        return gap, -obstacle[A], -obstacle[B], True
    if kind == SIDE:
        away = obstacle[A] * x + obstacle[B] * y - obstacle[C]
        face = -1.0 if away < 0.0 else 1.0
        there = beyond_ends(obstacle, x, y)[0] <= slack
        return face * away - radius, -face * obstacle[A], -face * obstacle[B], there
    dx, dy = obstacle[A] - x, obstacle[B] - y
    size = math.hypot(dx, dy)
    nx, ny = (dx / size, dy / size) if size > 0.0 else (1.0, 0.0)
    if kind == CORNER:
        return size - radius, nx, ny, beyond_ends(obstacle, x, y)[0] < -slack
    if kind == ARC:
        there = in_span(math.atan2(-ny, -nx), obstacle[FROM], obstacle[SPAN])
        return obstacle[C] - radius - size, -nx, -ny, there
    return size - obstacle[C] - (0.0 if kind == POCKET else radius), nx, ny, True


@inlined
def curvature(obstacle: FloatArray, radius: float, gap: float) -> float:
    """κ, 1/m: a slip v along an obstacle opens the gap of a disc with κ v²."""
    shape = int(obstacle[KIND])
    if shape in (WALL, SIDE):
        return 0.0
    if shape == ARC:
        return -1.0 / (obstacle[C] - radius - gap)
    return 1.0 / (obstacle[C] + radius + gap)


@inlined
def to_end(obstacle: FloatArray, radius: float, x: float, y: float) -> float:
    """How far a disc is within the ends: m at a side or a corner, rad at an arc; inf: has none."""
    shape = int(obstacle[KIND])
    if shape == SIDE:
        return 2.0 * slack_of(radius, x, y) - beyond_ends(obstacle, x, y)[0]
    if shape == CORNER:
        return -beyond_ends(obstacle, x, y)[0]
    if shape != ARC or obstacle[SPAN] >= 2.0 * math.pi:
        return math.inf
    half = 0.5 * obstacle[SPAN]
    off = math.atan2(y - obstacle[B], x - obstacle[A]) - obstacle[FROM] - half
    off -= 2.0 * math.pi * round(off / (2.0 * math.pi))
    return half - abs(off)

"""How the compiled engine of many pucks reads its arrays.

A *disc* is a puck, or a body whose motion is given.  States are rows x, y, angle, vx, vy, spin of
the laboratory (:mod:`puck_tables.scene.friction`).  Impacts and sustained contacts are between
two discs, or a disc and an obstacle that stands still; a partner is one number: a disc ``j ≥ 0``
by itself, an obstacle ``k`` as ``−1 − k``.
"""

from __future__ import annotations

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined

# columns of a disc; one whose motion is given has the inverses 0
RADIUS, LIGHTNESS, TURNABILITY, DECEL, DELTA = range(5)  # r, 1/m, 1/I, J = f g, 2 f h/r
DAMPING, SPIN_DAMPING, WAKE = 5, 6, 7  # drag over mass, over inertia, 1/s; quadratic, 1/m
RESTITUTION, TANGENTIAL, FRICTION = 8, 9, 10  # of its rim
INTEGRATED = 11  # 1: also alone; what is known of its motion is an integral, no table
DISC_COLUMNS = 12

# columns of an obstacle: for a wall (A, B) is its unit normal into the field and C its place along
# it; for the others (A, B) is the centre, C the radius and [FROM, FROM + SPAN] the angles of an arc
KIND, A, B, C = range(4)
WALL_RESTITUTION, WALL_TANGENTIAL, WALL_FRICTION = 4, 5, 6
FROM, SPAN = 7, 8
OBSTACLE_COLUMNS = 9

WALL, POST, ARC, POCKET, EDGE = range(5)  # of the last two only the centre counts: no impact


@inlined
def law_of_pair(
    discs: FloatArray, obstacles: FloatArray, i: int, j: int
) -> tuple[float, float, float]:
    """Restitution, tangential restitution and friction where disc i meets its partner j.

    Of two discs the smaller of each; an obstacle says it alone.
    """
    if j < 0:
        k = -1 - j
        return (
            obstacles[k, WALL_RESTITUTION], obstacles[k, WALL_TANGENTIAL],
            obstacles[k, WALL_FRICTION],
        )  # fmt: skip
    return (
        min(discs[i, RESTITUTION], discs[j, RESTITUTION]),
        min(discs[i, TANGENTIAL], discs[j, TANGENTIAL]),
        min(discs[i, FRICTION], discs[j, FRICTION]),
    )

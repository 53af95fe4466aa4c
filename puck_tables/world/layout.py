"""How the compiled engine of many pucks reads its arrays.

A *disc* is a puck, or a body whose motion is given.  States are rows x, y, angle, vx, vy, spin of
the laboratory (:mod:`puck_tables.scene.friction`).  Impacts and sustained contacts are between
two discs, or a disc and an obstacle that stands still; a partner is one number: a disc ``j ≥ 0``
by itself, an obstacle ``k`` as ``−1 − k``.  A restitution is one number too: ``e ≥ 0`` by itself, a
law as ``−1`` less its place, see :mod:`puck_tables.world.rims`.
"""

from __future__ import annotations

# columns of a disc; one whose motion is given has the inverses 0
RADIUS, LIGHTNESS, TURNABILITY, DECEL, DELTA = range(5)  # r, 1/m, 1/I, J = f g, 2 f h/r
DAMPING, SPIN_DAMPING, WAKE = 5, 6, 7  # drag over mass, over inertia, 1/s; quadratic, 1/m
RESTITUTION, TANGENTIAL, FRICTION = 8, 9, 10  # of its rim
INTEGRATED = 11  # 1: also alone; what is known of its motion is an integral, no table
MAKE = 12  # which kind of rim it has, where pairs of kinds have a law of their own
DISC_COLUMNS = 13

# columns of an obstacle: for a wall (A, B) is its unit normal into the field and C its place along
# it; for the others (A, B) is the centre, C the radius and [FROM, FROM + SPAN] the angles of an arc
KIND, A, B, C = range(4)
WALL_RESTITUTION, WALL_TANGENTIAL, WALL_FRICTION = 4, 5, 6
FROM, SPAN = 7, 8
OBSTACLE_MAKE = 9
OBSTACLE_COLUMNS = 10

WALL, POST, ARC, POCKET, EDGE = range(5)  # of the last two only the centre counts: no impact

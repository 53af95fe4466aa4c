"""Where two rims touch: the normal, the gap, and how fast the rims approach and slip.

With n from the first to the second, t = n turned by +90°, Δ = first − second, R the radii and ω the
spins, the rims slip by u = Δv·t + R₁ω₁ + R₂ω₂, and

    gap′ = −Δv·n,   gap″ = −Δa·n + κ (Δv·t)²,   u′ = Δa·t + R₁α₁ + R₂α₂ + κ (Δv·t)(Δv·n),

κ being one over the distance of the centres: from a post or a corner as from a disc; 0 at a wall;
and minus one over the distance from its centre within an arc.
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, kernel, patience
from puck_tables.motion.impact_law import along_normal
from puck_tables.scene.friction import SPIN, VX, VY, X, Y
from puck_tables.scene.ingredients import FREE
from puck_tables.world.group import (
    ALONG,
    APPROACH,
    ARM,
    BEND,
    FAR_ARM,
    GAP,
    GRIP,
    NX,
    NY,
    SLIP,
    TO_END,
    Group,
    GroupBuffer,
    IntArray,
)
from puck_tables.world.holds import forbid
from puck_tables.world.layout import HOLD, RADIUS, along_of_pair
from puck_tables.world.obstacle_shapes import curvature, normal_to, to_end


@inlined
def look_at_ties(
    group: Group, members: IntArray, t: float, y: FloatArray, buffer: GroupBuffer
) -> None:
    """What rails, pivots and blades forbid the members at the states y (m, 6)."""
    count = 0
    for place in range(members.shape[0]):
        disc = group.discs[members[place]]
        if disc[HOLD] != FREE:
            more = forbid(
                disc, group.surface, t, y[place], buffer.ties[count:], buffer.strays[count:]
            )
            for _ in range(more):
                buffer.tied[count] = place
                count += 1
    buffer.number[0] = count


@kernel
def look(group: Group, members: IntArray, pairs: IntArray, y: FloatArray, out: FloatArray) -> None:
    """What is seen of contacts ``pairs`` (c, 2) at the states y (m, 6), into ``out`` (≥ c, 11)."""
    for c in range(pairs.shape[0]):
        patience(1)
        one, other, sight = pairs[c, 0], pairs[c, 1], out[c]
        i = members[one]
        radius = group.discs[i, RADIUS]
        if other >= 0:
            j = members[other]
            far = group.discs[j, RADIUS]
            dx, dy = y[other, X] - y[one, X], y[other, Y] - y[one, Y]
            distance = math.hypot(dx, dy)
            sight[NX], sight[NY], sight[BEND] = dx / distance, dy / distance, 1.0 / distance
            sight[GAP], sight[FAR_ARM], sight[TO_END] = distance - radius - far, far, math.inf
            vx, vy = y[one, VX] - y[other, VX], y[one, VY] - y[other, VY]
            turning = radius * y[one, SPIN] + far * y[other, SPIN]
        else:
            j, obstacle, at_x, at_y = other, group.obstacles[-1 - other], y[one, X], y[one, Y]
            sight[GAP], sight[NX], sight[NY], _ = normal_to(obstacle, radius, at_x, at_y, 0.0)
            sight[BEND] = curvature(obstacle, radius, sight[GAP])
            sight[FAR_ARM], sight[TO_END] = 0.0, to_end(obstacle, radius, at_x, at_y)
            vx, vy, turning = y[one, VX], y[one, VY], radius * y[one, SPIN]
        sight[ARM] = radius
        sight[APPROACH], sight[ALONG] = along_normal(vx, vy, 0.0, sight[NX], sight[NY])
        sight[SLIP] = sight[ALONG] + turning
        tangential, friction = along_of_pair(group.rims, group.discs, group.obstacles, i, j)
        sight[GRIP] = friction if tangential > -1.0 else 0.0  # −1: smooth

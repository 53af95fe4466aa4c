"""A puck against a straight cushion.

With n the unit normal of the wall, into the field, and τ = (−n_y, n_x), the rim touches the wall at
−r n and slides along it with u = v·τ − r ω.  The impulses are

    P_n = −(1 + e) m v·n,    P_τ = −(1 + e_τ) u/(1/m + r²/I),   |P_τ| ≤ μ P_n,

e the restitution, e_τ the tangential one (−1: a smooth wall, 0: the rim rolls off, 1: u reversed),
μ the friction of the cushion.  They act at the rim, so v and ω change by P/m and −r P_τ/I.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from puck_tables.kernels.compile import inlined
from puck_tables.scene.friction import SPIN, VX, VY
from puck_tables.scene.ingredients import Body

FloatArray = npt.NDArray[np.float64]


@inlined
def rebound(body: Body, wall: FloatArray, y: FloatArray) -> None:
    """Velocity and spin of the state ``y`` after the impact; ``wall``: n_x, n_y, c, e, e_τ, μ."""
    nx, ny, restitution, tangential, friction = wall[0], wall[1], wall[3], wall[4], wall[5]
    normal = (1.0 + restitution) * body.mass * max(-(nx * y[VX] + ny * y[VY]), 0.0)
    slip = nx * y[VY] - ny * y[VX] - body.radius * y[SPIN]
    compliance = 1.0 / body.mass + body.radius * body.radius / body.inertia
    along = -(1.0 + tangential) * slip / compliance
    along = min(max(along, -friction * normal), friction * normal)
    y[VX] += (normal * nx - along * ny) / body.mass
    y[VY] += (normal * ny + along * nx) / body.mass
    y[SPIN] -= body.radius * along / body.inertia

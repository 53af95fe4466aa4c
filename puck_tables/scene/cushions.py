"""A puck against straight cushions: impacts, and the rim along them.

With n the unit normal of the wall, into the field, and τ = (−n_y, n_x), the rim touches the wall at
−r n and slides along it with u = v·τ − r ω.  The impulses of an impact are

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

# columns of a wall, its place moved in by the radius
NX, NY, PLACE, RESTITUTION, TANGENTIAL, FRICTION = range(6)


@inlined
def rebound(body: Body, wall: FloatArray, y: FloatArray) -> None:
    """Velocity and spin of the state ``y``, in the laboratory, after the impact."""
    nx, ny = wall[NX], wall[NY]
    normal = (1.0 + wall[RESTITUTION]) * body.mass * max(-(nx * y[VX] + ny * y[VY]), 0.0)
    slip = rim_slip(body, nx, ny, y[VX], y[VY], y[SPIN])
    along = -(1.0 + wall[TANGENTIAL]) * slip / rim_compliance(body)
    along = min(max(along, -wall[FRICTION] * normal), wall[FRICTION] * normal)
    y[VX] += (normal * nx - along * ny) / body.mass
    y[VY] += (normal * ny + along * nx) / body.mass
    y[SPIN] -= body.radius * along / body.inertia


@inlined
def rim_slip(body: Body, nx: float, ny: float, vx: float, vy: float, spin: float) -> float:
    """How fast the rim slides along a wall."""
    return nx * vy - ny * vx - body.radius * spin


@inlined
def rim_compliance(body: Body) -> float:
    """Change of the rim's slip for each unit of impulse along the wall."""
    return 1.0 / body.mass + body.radius * body.radius / body.inertia


@inlined
def push_rim(body: Body, nx: float, ny: float, change: float, y: FloatArray) -> None:
    """Change the rim's slip along a wall by an impulse there; ``y`` in the laboratory."""
    along = change / rim_compliance(body)
    y[VX] -= along * ny / body.mass
    y[VY] += along * nx / body.mass
    y[SPIN] -= body.radius * along / body.inertia

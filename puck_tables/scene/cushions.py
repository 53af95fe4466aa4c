"""A puck against straight cushions: impacts, and the rim along them.

With n the unit normal of the wall, into the field, and τ = (−n_y, n_x), the rim touches the wall at
−r n and slides along it with u = v·τ − r ω.  The impulses of an impact are

    P_n = −(1 + e) m v·n,    P_τ = −(1 + e_τ) u/(1/m + r²/I),   |P_τ| ≤ μ P_n,

e the restitution, e_τ the tangential one (−1: a smooth wall, 0: the rim rolls off, 1: u reversed),
μ the friction of the cushion.  They act at the rim, so v and ω change by P/m and −r P_τ/I.

Of rebounds that die out each next normal impulse is that before times q, P q, P q², …, and so are
the hops τ, τ q, …  Between two of them what acts changes the rim's slip u at a steady rate a, and
each changes it by −(1 + e_τ) u, at most by μ c P_j (c the compliance of the rim).  All this is of
the order of the rest of the time R, or is a slip that is reversed without end; so the impulses are
given as one at the start, such that the puck gets as far as with all of them, and one at the end.
That is right up to R².
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, inner
from puck_tables.scene.friction import SPIN, VX, VY
from puck_tables.scene.ingredients import Body

# columns of a wall, its place moved in by the radius
NX, NY, PLACE, RESTITUTION, TANGENTIAL, FRICTION = range(6)

_LONGEST = 200_000  # rebounds that are taken one by one
_NOTHING = 1e-18  # of the first: no impulse


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


@inner
def rest_of_rim(
    slip: float, rate: float, hop: float, ratio: float, most: float, tangential: float
) -> tuple[float, float, bool]:
    """Changes of the rim's slip over the rest of a series: on average, in all; whether it rolls.

    ``slip``: after the last rebound; ``rate``: m/s² by what else acts; ``hop``: s to the next one;
    ``ratio``: of each to the one before; ``most``: m/s that the next one may change; ``tangential``
    : restitution e_τ.
    """
    total, area, u, tau, cap = 0.0, 0.0, slip, hop, most
    for _ in range(_LONGEST):
        area += total * tau
        u += rate * tau
        tau *= ratio
        wish = -(1.0 + tangential) * u
        change = min(max(wish, -cap), cap)
        total += change
        u += change
        cap *= ratio
        left = tau / (1.0 - ratio)
        if change != wish:
            budget = cap / (1.0 - ratio)
            least = abs(u) - abs(rate) * left - budget
            if (1.0 + tangential) * least >= cap:  # it slides for good
                sign = 1.0 if u > 0.0 else -1.0
                area += total * left - sign * budget * (left - tau / (1.0 - ratio * ratio))
                total -= sign * budget
                return area * (1.0 - ratio) / hop, total, False
        elif cap == math.inf:
            grows = abs(u)
        else:
            share = abs(tangential) / ratio
            grows = (abs(u) + abs(rate) * tau / (1.0 - share)) if share < 1.0 else math.inf
        if change == wish and (1.0 + tangential) * grows <= cap:  # reversed for good
            # u_j → −e_τ (u_j + a τ_j): one part follows the hops, the rest is reversed
            gap = ratio + tangential
            part = -tangential * rate / gap if abs(gap) > 1e-3 else 0.0
            squares = tau / (1.0 - ratio * ratio)
            area += (total - u) * left + (u - part * tau) * tau / (1.0 + tangential * ratio)
            area += part * tau * squares - rate * left * (left - squares)
            total -= u + rate * left
            return area * (1.0 - ratio) / hop, total, True
        if cap <= _NOTHING * most and tau <= _NOTHING * hop:
            break
    return area * (1.0 - ratio) / hop, total, abs(u) <= 1e-15 * (abs(slip) + most)

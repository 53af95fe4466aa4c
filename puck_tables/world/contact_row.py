"""What is known of a contact at an instant, and what its impacts do: one row of numbers."""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined
from puck_tables.motion.impact_law import along_normal
from puck_tables.scene.friction import SPIN, VX, VY, X, Y
from puck_tables.world.engine_state import Engine
from puck_tables.world.group_forces import acceleration
from puck_tables.world.holds import response
from puck_tables.world.layout import (
    HOLD,
    INV_INERTIA,
    INV_MASS,
    RADIUS,
    along_of_pair,
    curvature,
    normal_to,
    restitutions_of_pair,
)

# columns of a contact in work: normal, inverse masses 1/m_n and 1/m_t, law, whether it acts in this
# round, impulses of the round and of all, approach and slip at the first, energy lost, and the two
# restitutions, numbers or laws, of which E is the smaller
NX, NY, SOFT, SLICK, E, BETA, MU, ACTS, PN, PT, SUM_N, SUM_T, FIRST_N, FIRST_T, LOSS = range(15)
ONE, OTHER = 15, 16
CROSS = 17  # how much a unit of one impulse changes what the other one is against: of what is led
HOPS = 18  # whether impacts that brought nothing apart follow each other on it
CONTACT_COLUMNS = 19


@inlined
def approach(
    engine: Engine, i: int, j: int, nx: float, ny: float, states: FloatArray
) -> tuple[float, float]:
    """u_n and u_t."""
    vx, vy = states[i, VX], states[i, VY]
    rim = engine.discs[i, RADIUS] * states[i, SPIN]
    if j >= 0:
        vx -= states[j, VX]
        vy -= states[j, VY]
        rim += engine.discs[j, RADIUS] * states[j, SPIN]
    return along_normal(vx, vy, rim, nx, ny)


@inlined
def got_impulse(row: FloatArray) -> bool:
    """Whether a contact has had an impulse; rims without bound may have one along them alone."""
    return row[SUM_N] > 0.0 or row[SUM_T] != 0.0


@inlined
def _inverse_masses(
    disc: FloatArray, state: FloatArray, nx: float, ny: float
) -> tuple[float, float, float]:
    """How much a unit impulse changes approach and slip: 1/m_n, 1/m_t, and one the other."""
    light, radius = disc[INV_MASS], disc[RADIUS]
    if disc[HOLD] == 0.0:
        return light, light + disc[INV_INERTIA] * radius * radius, 0.0
    dx, dy, turn = response(disc, state, nx, ny, 0.0)
    cross = dy * nx - dx * ny + radius * turn
    ex, ey, spin = response(disc, state, -ny, nx, radius)
    return dx * nx + dy * ny, ey * nx - ex * ny + radius * spin, cross


@inlined
def prepare_contact(engine: Engine, i: int, j: int, states: FloatArray, row: FloatArray) -> None:
    """Normal, inverse masses and law of a contact that has had no impulse yet."""
    discs = engine.discs
    if j >= 0:
        dx, dy = states[j, X] - states[i, X], states[j, Y] - states[i, Y]
        size = math.hypot(dx, dy)
        row[NX], row[NY] = dx / size, dy / size
    else:
        _, row[NX], row[NY], _ = normal_to(
            engine.obstacles[-1 - j], discs[i, RADIUS], states[i, X], states[i, Y], 0.0
        )
    soft, slick, cross = _inverse_masses(discs[i], states[i], row[NX], row[NY])
    if j >= 0:
        more, slicker, twist = _inverse_masses(discs[j], states[j], -row[NX], -row[NY])
        soft, slick, cross = soft + more, slick + slicker, cross + twist
    row[SOFT], row[SLICK], row[CROSS] = soft, slick, cross
    row[BETA], row[MU] = along_of_pair(engine.rims, discs, engine.obstacles, i, j)
    row[ONE], row[OTHER] = restitutions_of_pair(engine.rims, discs, engine.obstacles, i, j)
    row[E] = min(row[ONE], row[OTHER])
    row[ACTS] = row[PN] = row[PT] = row[SUM_N] = row[SUM_T] = 0.0
    row[FIRST_N] = row[FIRST_T] = row[LOSS] = 0.0


@inlined
def opening(engine: Engine, i: int, j: int, t: float, row: FloatArray, states: FloatArray) -> float:
    """The second derivative of the gap of a contact if its discs flew on alone."""
    nx, ny = row[NX], row[NY]
    wx, wy = states[i, VX], states[i, VY]
    ax, ay = acceleration(engine, i, t, states[i])
    pull = ax * nx + ay * ny
    if j >= 0:
        wx -= states[j, VX]
        wy -= states[j, VY]
        kappa = 1.0 / (engine.discs[i, RADIUS] + engine.discs[j, RADIUS])
        ax, ay = acceleration(engine, j, t, states[j])
        pull -= ax * nx + ay * ny
    else:
        kappa = curvature(engine.obstacles[-1 - j], engine.discs[i, RADIUS], 0.0)
    across = wy * nx - wx * ny
    return kappa * across * across - pull

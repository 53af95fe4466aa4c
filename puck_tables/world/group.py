"""A group of discs of which some press on each other or on obstacles, and the arrays to work in.

Everything is in the order of the group's *members*; a contact is a pair of places in that order,
or of one and an obstacle.  What a member does is one of HELD … MOVES, what a contact does is how
its rims slip: −1 or 1 (they slide, the slip has that sign), STICKS, or APART.

Where two rims touch they have a normal and a gap, and approach and slip.  With n from the first to
the second, t = n turned by +90°, Δ = first − second, R the radii and ω the spins, the rims slip by
u = Δv·t + R₁ω₁ + R₂ω₂, and

    gap′ = −Δv·n,   gap″ = −Δa·n + κ (Δv·t)²,   u′ = Δa·t + R₁α₁ + R₂α₂ + κ (Δv·t)(Δv·n),

κ being one over the distance of the centres: from a post or a corner as from a disc; 0 at a wall;
and minus one over the distance from its centre within an arc.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, kernel, patience
from puck_tables.motion.impact_law import along_normal
from puck_tables.motion.steppers import DORMAND_PRINCE
from puck_tables.scene.friction import SPIN, VX, VY, X, Y
from puck_tables.scene.ingredients import FREE
from puck_tables.world.engine_state import Engine
from puck_tables.world.holds import forbid
from puck_tables.world.layout import HOLD, RADIUS, along_of_pair, curvature, normal_to, to_end
from puck_tables.world.step_ledger import LEDGER

IntArray = npt.NDArray[np.int64]

# of a contact, besides −1 and 1
STICKS, APART = 0, 2

# of a member.  HELD: at rest.  YIELDS: its slip over the floor has just begun, or would begin if
# nothing stood in its way; friction is against the direction in which it is driven
HELD, YIELDS, MOVES, DRIVEN = range(4)

# how a stretch ends
(
    TIME_UP, PARTS, RIM_STOPS, RIM_GIVES, RUNS_OFF, RESTS, SETS_OFF, FULL, UNSOLVED, NOT_FINITE,
    OFF_BORDER,
) = range(11)  # fmt: skip

# columns of what is seen of a contact: the normal from the first to the second; how much a slip of
# the centres opens it, 1/m; that slip, the approach, the slip of the rims, the gap; the radii of
# the rims (0: an obstacle), their friction, and how far the end of an arc is, rad
NX, NY, CURVATURE, ALONG, APPROACH, SLIP, GAP, ARM, FAR_ARM, GRIP, TO_END = range(11)
KINEMATICS = 11

WATCHES = 4  # of a contact: what becomes negative at PARTS, RIM_STOPS, RIM_GIVES, RUNS_OFF

STILL = 1e-12  # of the scale of speeds: as good as at rest
SMOOTH_SLIP = 1e-13  # of the scale of speeds: a rim that slips no more
LEVEL = 1e-12  # of the scale of accelerations: none
GAINS = 1e-10  # of the scale of accelerations: what gains less stays at rest


class Scales(NamedTuple):
    """Speed Q, m/s, and acceleration J, m/s², and the error of a step in units of Q and Q²/J.

    Both are positive; where nothing accelerates, J is Q² over a radius.
    """

    speed: float
    rate: float
    tol: float


class GroupBuffer(NamedTuple):
    """Arrays to work in for m members and c contacts, of which h members are led.

    ``pairs``: the contacts by places of members; ``states``: at the start and the end of a step and
    at a trial (3, m, 6); ``stages`` (8, m, 6) and ``powers`` (10, 8): rates of states and ledger;
    ``own``, ``rates`` (m, 3): accelerations without and with contacts; ``inverse`` (m, 2): 1/m, 1/I
    of those that can move; ``kinematics``, ``midway`` (c, 11): at the end and midway in a step;
    ``watched`` (2, c, 4): see :func:`puck_tables.world.stepping.watch`; ``pushes`` (c, 2): λ, τ;
    ``slips`` (m, 3), ``turn_rates`` (m, 2): where what yields slips to, and how fast that turns;
    ``ties`` (2h, 3), ``led_places``, ``tautness`` (2h,): what leads members, whom, how it pulls,
    ``strays`` (2h, 3): see :func:`puck_tables.world.holds.forbid`, ``number`` (1,): how many there
    are; ``rows``, ``columns`` (k, 6), ``owners`` (k, 2), ``order`` (k,), k = 2c + 2h: the
    constraints, and the members concerned; ``matrix``, ``factors`` (k, k), ``vectors`` (4, k);
    ``variables`` (4c, 5), ``first``, ``basis`` (4c,), ``tableau`` (4c, 8c + 2): of
    :mod:`puck_tables.world.complementarity`; ``modes`` (2, c), ``motions`` (m,): trials; ``gives``
    (c,): to which side rims begin to slip; ``film`` (9,); ``floor_accels`` (m, 3): what the floor
    asks of each acceleration; ``passed`` (m,): rows of forces over time; ``clock`` (1,): now;
    ``firm`` (m,): by what friction is more of what yields and has not begun to slip.
    """

    pairs: IntArray
    states: FloatArray
    stages: FloatArray
    powers: FloatArray
    own: FloatArray
    rates: FloatArray
    inverse: FloatArray
    kinematics: FloatArray
    midway: FloatArray
    watched: FloatArray
    pushes: FloatArray
    slips: FloatArray
    turn_rates: FloatArray
    ties: FloatArray
    led_places: IntArray
    tautness: FloatArray
    strays: FloatArray
    number: IntArray
    rows: FloatArray
    columns: FloatArray
    owners: IntArray
    order: IntArray
    matrix: FloatArray
    factors: FloatArray
    vectors: FloatArray
    variables: FloatArray
    first: IntArray
    basis: IntArray
    tableau: FloatArray
    modes: IntArray
    motions: IntArray
    gives: IntArray
    film: FloatArray
    floor_accels: FloatArray
    passed: IntArray
    clock: FloatArray
    firm: FloatArray


def buffer_for(members: int, contacts: int, led: int = 0) -> GroupBuffer:
    """A buffer for groups of up to so many members and contacts, of whom so many are led.

    >>> buffer_for(3, 2).matrix.shape, buffer_for(3, 2, 1).matrix.shape
    ((4, 4), (6, 6))
    """
    m, c, h, k = max(members, 1), max(contacts, 1), max(2 * led, 1), max(2 * (contacts + led), 1)
    stages = len(DORMAND_PRINCE.c)
    return GroupBuffer(
        pairs=np.zeros((c, 2), np.int64), states=np.zeros((3, m, 6)),
        stages=np.zeros((stages + 1, m, 6)), powers=np.zeros((stages + 3, LEDGER)),
        own=np.zeros((m, 3)), rates=np.zeros((m, 3)), inverse=np.zeros((m, 2)),
        kinematics=np.zeros((c, KINEMATICS)), midway=np.zeros((c, KINEMATICS)),
        watched=np.zeros((2, c, WATCHES)), pushes=np.zeros((c, 2)),
        slips=np.zeros((m, 3)), turn_rates=np.zeros((m, 2)), ties=np.zeros((h, 3)),
        led_places=np.zeros(h, np.int64), tautness=np.zeros(h), strays=np.zeros((h, 3)),
        number=np.zeros(1, np.int64),
        rows=np.zeros((k, 6)), columns=np.zeros((k, 6)), owners=np.zeros((k, 2), np.int64),
        order=np.zeros(k, np.int64), matrix=np.empty((k, k)), factors=np.empty((k, k)),
        vectors=np.zeros((4, k)), variables=np.zeros((4 * c, 5)), first=np.zeros(4 * c, np.int64),
        basis=np.zeros(4 * c, np.int64), tableau=np.empty((4 * c, 8 * c + 2)),
        modes=np.zeros((2, c), np.int64), motions=np.zeros(m, np.int64),
        gives=np.zeros(c, np.int64), film=np.zeros(9),
        floor_accels=np.zeros((m, 3)), passed=np.zeros(m, np.int64), clock=np.zeros(1),
        firm=np.ones(m),
    )  # fmt: skip


@inlined
def small_slip(scales: Scales) -> float:
    """A slip, m/s, in which an error of its direction of its own size over Q is below ``tol``."""
    return math.sqrt(scales.tol) * scales.speed


@inlined
def find_places(members: IntArray, contacts: IntArray, buffer: GroupBuffer) -> None:
    """The contacts, given by numbers of discs, by places of members."""
    for c in range(contacts.shape[0]):
        for side in range(2):
            number = contacts[c, side]
            buffer.pairs[c, side] = number
            for place in range(members.shape[0]):
                if members[place] == number:
                    buffer.pairs[c, side] = place


@inlined
def look_at_ties(
    engine: Engine, members: IntArray, t: float, y: FloatArray, buffer: GroupBuffer
) -> None:
    """What rails, pivots and blades forbid the members at the states y (m, 6)."""
    count = 0
    for place in range(members.shape[0]):
        disc = engine.discs[members[place]]
        if disc[HOLD] != FREE:
            more = forbid(
                disc, engine.surface, t, y[place], buffer.ties[count:], buffer.strays[count:]
            )
            for _ in range(more):
                buffer.led_places[count] = place
                count += 1
    buffer.number[0] = count


@kernel
def look(
    engine: Engine, members: IntArray, pairs: IntArray, y: FloatArray, out: FloatArray
) -> None:
    """What is seen of contacts ``pairs`` (c, 2) at the states y (m, 6), into ``out`` (≥ c, 11)."""
    for c in range(pairs.shape[0]):
        patience(1)
        one, other, contact = pairs[c, 0], pairs[c, 1], out[c]
        i = members[one]
        radius = engine.discs[i, RADIUS]
        if other >= 0:
            j = members[other]
            far = engine.discs[j, RADIUS]
            dx, dy = y[other, X] - y[one, X], y[other, Y] - y[one, Y]
            distance = math.hypot(dx, dy)
            contact[NX], contact[NY], contact[CURVATURE] = (
                dx / distance,
                dy / distance,
                1.0 / distance,
            )
            contact[GAP], contact[FAR_ARM], contact[TO_END] = distance - radius - far, far, math.inf
            vx, vy = y[one, VX] - y[other, VX], y[one, VY] - y[other, VY]
            turning = radius * y[one, SPIN] + far * y[other, SPIN]
        else:
            j, obstacle, at_x, at_y = other, engine.obstacles[-1 - other], y[one, X], y[one, Y]
            contact[GAP], contact[NX], contact[NY], _ = normal_to(obstacle, radius, at_x, at_y, 0.0)
            contact[CURVATURE] = curvature(obstacle, radius, contact[GAP])
            contact[FAR_ARM], contact[TO_END] = 0.0, to_end(obstacle, radius, at_x, at_y)
            vx, vy, turning = y[one, VX], y[one, VY], radius * y[one, SPIN]
        contact[ARM] = radius
        contact[APPROACH], contact[ALONG] = along_normal(vx, vy, 0.0, contact[NX], contact[NY])
        contact[SLIP] = contact[ALONG] + turning
        tangential, friction = along_of_pair(engine.rims, engine.discs, engine.obstacles, i, j)
        contact[GRIP] = friction if tangential > -1.0 else 0.0  # −1: smooth

"""Walls that a puck touches: which it leans on, and rebounds that die out.

Rebounds from a wall towards which the puck is driven are a geometric series: each is slower than
the last by a factor q < 1 (the restitution, and what friction takes on the way), and takes less
time by the same factor.  So the rest of the series takes τ q/(1 − q) after a rebound that took τ,
and on average the wall bears the force towards it, less the momentum that is left to be taken.
From where that rest is so short that nothing else changes in it, up to its square, the puck leans.
Between two walls that leave it no room impacts follow each other at one place: there it is stuck.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables.kernels.compile import allocating, inlined
from puck_tables.scene.boundaries import Boundaries, outward, room_to
from puck_tables.scene.cushions import (
    FRICTION,
    GRIP,
    LEAN_COLUMNS,
    NX,
    NY,
    PLACE,
    RIM,
    TANGENTIAL,
    come_to_lean,
    rebound,
    rim_slip,
)
from puck_tables.scene.friction import SPIN, VX, VY, X, Y
from puck_tables.scene.ingredients import Body

FloatArray = npt.NDArray[np.float64]

_STILL = 1e-13  # of the scale of speeds: no speed
_JAM = 50  # impacts on two walls at one place: it is stuck between them
_LEFT = 1e-12  # a wall is left, or a rim slides


class Contacts(NamedTuple):
    """What is known of every wall; arrays (n,).

    ``leans``: whether the puck leans on it; ``rim``: −1, 0, 1, how the rim then slides; ``share``:
    of the force that it bears; ``room``: how far the puck is from it, counted from the last impact;
    ``hit``, ``pace``: when that was, and how fast the puck left; ``chain`` (2,): the wall that was
    hit last, and how many impacts before it were at the same place; ``rows``: room for
    :func:`touching`.
    """

    leans: npt.NDArray[np.bool_]
    rim: FloatArray
    share: FloatArray
    room: FloatArray
    hit: FloatArray
    pace: FloatArray
    chain: npt.NDArray[np.int64]
    rows: FloatArray


@allocating
def contacts_for(walls: int) -> Contacts:
    """With so many walls, none of them looked at."""
    return Contacts(
        np.zeros(walls, np.bool_), np.zeros(walls), np.ones(walls), np.zeros(walls),
        np.zeros(walls), np.zeros(walls), np.zeros(2, np.int64), np.empty((walls, LEAN_COLUMNS)),
    )  # fmt: skip


@inlined
def _rim_of(body: Body, wall: FloatArray, y: FloatArray, speed: float) -> float:
    slip = rim_slip(body, wall[NX], wall[NY], y[VX], y[VY], y[SPIN])
    if abs(slip) <= _LEFT * speed:
        return 0.0
    return 1.0 if slip > 0.0 else -1.0


@inlined
def look_at_walls(
    bounds: Boundaries, contacts: Contacts, body: Body, y: FloatArray, speed: float
) -> None:
    """At a launch ``y``, in the laboratory: it leans where it touches and does not move away."""
    contacts.chain[0], contacts.chain[1] = -1, 0
    for i in range(contacts.leans.size):
        wall = bounds.walls[i]
        contacts.leans[i], contacts.rim[i], contacts.share[i] = False, 0.0, 1.0
        contacts.room[i] = room_to(bounds, i, y)
        rounding = 4e-16 * (abs(wall[NX] * y[X]) + abs(wall[NY] * y[Y]) + abs(wall[PLACE]))
        if abs(contacts.room[i]) <= rounding:
            contacts.room[i] = 0.0
            if abs(outward(bounds, i, y)) <= _STILL * speed:
                contacts.leans[i] = True
                contacts.rim[i] = _rim_of(body, wall, y, speed)


@inlined
def touching(bounds: Boundaries, contacts: Contacts) -> int:
    """How many walls the puck leans on; into ``rows``: normal, friction at the rim, its slip."""
    count = 0
    for i in range(contacts.leans.size):
        if contacts.leans[i]:
            wall, row = bounds.walls[i], contacts.rows[count]
            smooth = wall[TANGENTIAL] == -1.0
            row[NX], row[NY] = wall[NX], wall[NY]
            row[GRIP] = 0.0 if smooth else wall[FRICTION] * contacts.share[i]
            row[RIM] = contacts.rim[i]
            count += 1
    return count


@inlined
def settled(contacts: Contacts) -> None:
    """The rebounds have died out: walls bear all of the force."""
    contacts.share[:] = 1.0


@inlined
def departed(bounds: Boundaries, contacts: Contacts, y: FloatArray, speed: float) -> bool:
    """Whether the puck, in the laboratory, has left a wall that it leant on."""
    left = False
    for i in range(contacts.leans.size):
        if contacts.leans[i] and outward(bounds, i, y) > _LEFT * speed:
            contacts.leans[i] = False
            contacts.room[i] = 0.0
            left = True
    return left


@inlined
def rims_after(
    bounds: Boundaries, contacts: Contacts, body: Body, y: FloatArray, stuck: int, speed: float
) -> bool:
    """Whether a rim has begun to slide along a wall, or has stopped: that of row ``stuck``."""
    changed, row = False, 0
    for i in range(contacts.leans.size):
        if not contacts.leans[i]:
            continue
        now = 0.0 if row == stuck else contacts.rim[i]
        if now == 0.0 and row != stuck:
            now = _rim_of(body, bounds.walls[i], y, speed)
        changed = changed or now != contacts.rim[i]
        contacts.rim[i] = now
        row += 1
    return changed


@inlined
def bounced(
    bounds: Boundaries, contacts: Contacts, which: int, body: Body, y: FloatArray, t: float,
    speed: float, time: float, tolerance: float,
) -> float:  # fmt: skip
    """Rebound of a puck, in the laboratory, from a wall.

    How long the rebounds go on if the puck leans on the wall from now on; −1: it does not.
    ``speed`` and ``time``: scales; ``tolerance``: local error in units of them.
    """
    before = contacts.chain[0]
    here = 4e-16 * (abs(y[X]) + abs(y[Y]))  # rounding: no room left between two walls
    jams = before >= 0 and before != which and contacts.room[before] <= here
    contacts.chain[1] = contacts.chain[1] + 1 if jams else 0
    came = -outward(bounds, which, y)
    rebound(body, bounds.walls[which], y)
    goes = outward(bounds, which, y)
    rest_time = -1.0
    if goes <= max(0.01 * tolerance, _STILL) * speed:
        rest_time = 0.0
    elif contacts.chain[1] >= _JAM:
        rest_time = 0.0
        contacts.leans[before] = True
        contacts.room[before] = 0.0
    elif contacts.chain[0] == which and goes < contacts.pace[which] and goes <= 0.01 * speed:
        hop = t - contacts.hit[which]
        ratio = goes / contacts.pace[which]
        rest = hop * ratio / (1.0 - ratio)
        if hop > 0.0 and rest * rest <= tolerance * time * time:
            rest_time = rest
            drive = (contacts.pace[which] + came) / hop
            contacts.share[which] = min(max(1.0 - goes / (drive * rest), 0.0), 1.0)
    contacts.room[which] = 0.0
    contacts.hit[which], contacts.pace[which], contacts.chain[0] = t, goes, which
    if rest_time >= 0.0:
        contacts.leans[which] = True
    for i in range(contacts.leans.size):  # an impact may push it off others, or into them
        if (
            contacts.chain[1] < _JAM
            and contacts.leans[i]
            and i != which
            and abs(outward(bounds, i, y)) > _STILL * speed
        ):
            contacts.leans[i] = False
            contacts.room[i] = 0.0
    if rest_time >= 0.0:
        come_to_lean(contacts.rows[: touching(bounds, contacts)], y)
        for i in range(contacts.leans.size):
            if contacts.leans[i]:
                wall = bounds.walls[i]
                off = wall[NX] * y[X] + wall[NY] * y[Y] - wall[PLACE]  # rounding of the rebounds
                y[X] -= off * wall[NX]
                y[Y] -= off * wall[NY]
                contacts.rim[i] = _rim_of(body, bounds.walls[i], y, speed)
    return rest_time

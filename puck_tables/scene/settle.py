"""Walls that a puck touches: which it leans on, and rebounds that die out.

Rebounds from a wall towards which the puck is driven are a geometric series: each is slower than
the last by a factor q < 1 (the restitution, and what friction takes on the way), and takes less
time by the same factor.  So the rest of the series takes τ q/(1 − q) after a rebound that took τ.
From where that rest is so short that nothing else changes in it, up to its square, the puck leans;
what the rest of the rebounds does to a rough rim is summed up.
Between two walls that leave it no room, where it is slow enough, or where impacts follow each other
at one place, the puck comes to lie in their corner.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import allocating, inlined
from puck_tables.scene.boundaries import Boundaries, outward, room_to
from puck_tables.scene.cushions import (
    FRICTION,
    NX,
    NY,
    PLACE,
    RESTITUTION,
    TANGENTIAL,
    push_rim,
    rebound,
    rest_of_rim,
    rim_compliance,
    rim_slip,
)
from puck_tables.scene.friction import SPIN, VX, VY, X, Y, size
from puck_tables.scene.ingredients import Body
from puck_tables.scene.leaning import GRIP, LEAN_COLUMNS, LOCKS, RIM, come_to_lean

_STILL = 1e-13  # of the scale of speeds: no speed
_SLOWEST = 1e-12  # of it: rebounds next to what is rest on the floor
_AT_ONCE = 100_000  # impacts between walls without restitution, at most
_JAM = 50  # impacts on two walls at one place: it is stuck between them
_PARALLEL = 1e-12  # walls between which no corner is
_LEFT = 1e-12  # a wall is left, or a rim slides


class Contacts(NamedTuple):
    """What is known of every wall; arrays (n,).

    ``leans``: whether the puck leans on it; ``rim``: −1, 0, 1, how the rim then slides; ``dying``:
    whether rebounds still die out, ``last``: by how much they change the rim's slip at their end,
    ``rolls``: whether it then rolls; ``room``: how far the puck is from the wall, counted from the
    last impact; ``hit``, ``pace``, ``slid``: when that was, how fast the puck left, and how fast
    its rim then slid; ``chain`` (2,): the wall that was hit last, and how many impacts before it
    were at the same place; ``rows``: room for :func:`touching`.
    """

    leans: npt.NDArray[np.bool_]
    rim: FloatArray
    dying: npt.NDArray[np.bool_]
    last: FloatArray
    rolls: npt.NDArray[np.bool_]
    room: FloatArray
    hit: FloatArray
    pace: FloatArray
    slid: FloatArray
    chain: npt.NDArray[np.int64]
    rows: FloatArray


@allocating
def contacts_for(walls: int) -> Contacts:
    """With so many walls, none of them looked at."""
    return Contacts(
        np.zeros(walls, np.bool_), np.zeros(walls), np.zeros(walls, np.bool_), np.zeros(walls),
        np.zeros(walls, np.bool_), np.zeros(walls), np.zeros(walls), np.zeros(walls),
        np.zeros(walls), np.zeros(2, np.int64), np.empty((walls, LEAN_COLUMNS)),
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
        contacts.leans[i], contacts.rim[i], contacts.dying[i] = False, 0.0, False
        contacts.hit[i] = -math.inf
        contacts.room[i] = room_to(bounds.walls, i, y)
        rounding = 4e-16 * (abs(wall[NX] * y[X]) + abs(wall[NY] * y[Y]) + abs(wall[PLACE]))
        if abs(contacts.room[i]) <= rounding:
            contacts.room[i] = 0.0
            if abs(outward(bounds.walls, i, y)) <= _STILL * speed:
                contacts.leans[i] = True
                contacts.rim[i] = _rim_of(body, wall, y, speed)


@inlined
def touching(bounds: Boundaries, contacts: Contacts) -> int:
    """How many walls the puck leans on, into ``rows``: normal, place, friction at the rim, slip."""
    count = 0
    for i in range(contacts.leans.size):
        if contacts.leans[i]:
            wall, row = bounds.walls[i], contacts.rows[count]
            smooth = wall[TANGENTIAL] == -1.0
            row[NX], row[NY], row[PLACE] = wall[NX], wall[NY], wall[PLACE]
            row[GRIP] = 0.0 if smooth or contacts.dying[i] else min(wall[FRICTION], LOCKS)
            row[RIM] = contacts.rim[i]
            count += 1
    return count


@inlined
def settled(
    bounds: Boundaries, contacts: Contacts, body: Body, y: FloatArray, speed: float
) -> None:
    """The rebounds of a puck, in the laboratory, have died out: their last impulses at the rim."""
    for i in range(contacts.leans.size):
        if contacts.dying[i]:
            wall = bounds.walls[i]
            change = contacts.last[i]
            if contacts.rolls[i]:
                change = -rim_slip(body, wall[NX], wall[NY], y[VX], y[VY], y[SPIN])
            push_rim(body, wall[NX], wall[NY], change, y)
            contacts.dying[i] = False
    look_at_rims(bounds, contacts, body, y, speed)


@inlined
def look_at_rims(
    bounds: Boundaries, contacts: Contacts, body: Body, y: FloatArray, speed: float
) -> None:
    """How the rims of a puck, in the laboratory, slide along the walls that it leans on."""
    for i in range(contacts.leans.size):
        if contacts.leans[i]:
            contacts.rim[i] = _rim_of(body, bounds.walls[i], y, speed)


@inlined
def departed(bounds: Boundaries, contacts: Contacts, y: FloatArray, speed: float) -> bool:
    """Whether the puck, in the laboratory, has left a wall that it leant on."""
    left = False
    for i in range(contacts.leans.size):
        if contacts.leans[i] and outward(bounds.walls, i, y) > _LEFT * speed:
            contacts.leans[i] = contacts.dying[i] = False
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
        wall, now = bounds.walls[i], contacts.rim[i]
        if row == stuck:
            now = 0.0
            push_rim(
                body, wall[NX], wall[NY],
                -rim_slip(body, wall[NX], wall[NY], y[VX], y[VY], y[SPIN]), y,
            )  # fmt: skip
        elif now == 0.0 or stuck >= 0:
            now = _rim_of(body, wall, y, speed)
        changed = changed or now != contacts.rim[i]
        contacts.rim[i] = now
        row += 1
    return changed


@inlined
def _corner_near(bounds: Boundaries, contacts: Contacts, which: int, reach: float) -> int:
    """Another wall within ``reach``, with which the wall that is hit makes a corner; −1: none."""
    wall = bounds.walls[which]
    for i in range(contacts.leans.size):
        other = bounds.walls[i]
        crosses = abs(wall[NX] * other[NY] - wall[NY] * other[NX]) > _PARALLEL
        if crosses and (contacts.leans[i] or contacts.room[i] <= reach):
            return i
    return -1


@inlined
def _dead_ahead(
    bounds: Boundaries, contacts: Contacts, which: int, y: FloatArray, here: float, speed: float
) -> int:
    """A wall without restitution into which a puck at another such goes at once; −1: none."""
    if bounds.walls[which, RESTITUTION] > 0.0:
        return -1
    for i in range(contacts.leans.size):
        touches = i == which or contacts.leans[i] or contacts.room[i] <= here
        dead = bounds.walls[i, RESTITUTION] == 0.0
        if touches and dead and outward(bounds.walls, i, y) < -_STILL * speed:
            return i
    return -1


@inlined
def _into_corner(one: FloatArray, other: FloatArray, y: FloatArray) -> None:
    """Put a state at rest to where two walls leave it no room."""
    cross = one[NX] * other[NY] - one[NY] * other[NX]
    if abs(cross) > _PARALLEL:
        first = one[PLACE] - (one[NX] * y[X] + one[NY] * y[Y])
        second = other[PLACE] - (other[NX] * y[X] + other[NY] * y[Y])
        y[X] += (first * other[NY] - second * one[NY]) / cross
        y[Y] += (second * one[NX] - first * other[NX]) / cross
        y[VX] = y[VY] = 0.0


@inlined
def _doubt(
    body: Body, wall: FloatArray, along: float, spin: float, ground: tuple[float, float, float],
    hops: float, changes: float,
) -> float:  # fmt: skip
    """By how much the velocity may be wrong where a puck leans, but rebounds at up to ``hops``.

    Rebounds turn the slip of a puck that leans, and with it the friction of the floor, by hops/slip
    at most, to and fro.  In a slip that is none, and that no ``changes`` make one, there is nothing
    to turn.
    """
    nx, ny, (sx, sy, turning) = wall[NX], wall[NY], ground
    along -= nx * sy - ny * sx
    slip = size(along, nx * sx + ny * sy, body.radius * (spin - turning))
    share = hops / slip if slip > hops else 1.0
    return min(hops * share * share, slip + changes)


@inlined
def bounced(
    bounds: Boundaries, contacts: Contacts, which: int, image: int, body: Body, y: FloatArray,
    t: float, ground: tuple[float, float, float], speed: float, time: float, tolerance: float,
) -> float:  # fmt: skip
    """Rebound of a puck, in the laboratory, from a wall.

    How long the rebounds go on if the puck leans on the wall from now on; −1: it does not.
    ``image``: another wall that it hits at the same moment as the mirror image of this one, or −1.
    ``ground``: velocity and spin of the floor; ``speed`` and ``time``: scales; ``tolerance``: local
    error in units of them.
    """
    before = contacts.chain[0]
    here = 4e-16 * (abs(y[X]) + abs(y[Y]))  # rounding: no room left between two walls
    jams = before >= 0 and before != which and contacts.room[before] <= here
    contacts.chain[1] = contacts.chain[1] + 1 if jams else 0
    wall, came = bounds.walls[which], -outward(bounds.walls, which, y)
    slips = rim_slip(body, wall[NX], wall[NY], y[VX], y[VY], y[SPIN])
    hits, hit = which, 0
    if image >= 0:
        y[VX], y[VY] = -wall[RESTITUTION] * y[VX], -wall[RESTITUTION] * y[VY]
        hits = -1
    while hits >= 0 and hit < _AT_ONCE:
        rebound(body, bounds.walls[hits], y)
        hits = _dead_ahead(bounds, contacts, which, y, here, speed)
        hit += 1
    goes = outward(bounds.walls, which, y)
    slides = rim_slip(body, wall[NX], wall[NY], y[VX], y[VY], y[SPIN])
    rest_time = -1.0
    corner = _corner_near(bounds, contacts, which, max(tolerance, _STILL) * speed * time)
    if corner >= 0 and size(y[VX], y[VY], 0.0) > max(tolerance, _STILL) * speed:
        corner = -1
    if contacts.chain[1] >= _JAM:
        corner = before
    if corner >= 0 and image >= 0:
        corner = image
    tiny = goes <= max(0.01 * tolerance, _SLOWEST) * speed
    if tiny or corner >= 0:
        rest_time = 0.0
    # a wall that gives nothing back ends it at once
    falls = before == which and 0.0 < goes < contacts.pace[which] and goes <= 0.01 * speed
    if falls and (corner < 0 or image >= 0):
        hop = t - contacts.hit[which]
        ratio = goes / contacts.pace[which]
        rest = hop * ratio / (1.0 - ratio)
        changes = (abs(slips - contacts.slid[which]) + abs(slides - slips)) * ratio / (1.0 - ratio)
        along = wall[NX] * y[VY] - wall[NY] * y[VX] if image < 0 else 0.0
        doubt = _doubt(body, wall, along, y[SPIN], ground, speed * rest / time, changes)
        short = hop > 0.0 and rest * rest <= tolerance * time * time
        if short and (tiny or doubt <= tolerance * speed):
            rest_time = rest
            if wall[TANGENTIAL] != -1.0:
                most = wall[FRICTION] * (1.0 + wall[RESTITUTION]) * body.mass * came * ratio
                change, last, contacts.rolls[which] = rest_of_rim(
                    slides, (slips - contacts.slid[which]) / hop, hop * ratio, ratio,
                    most * rim_compliance(body), wall[TANGENTIAL],
                )  # fmt: skip
                push_rim(body, wall[NX], wall[NY], change, y)
                contacts.last[which], contacts.dying[which] = last - change, True
    contacts.room[which], contacts.slid[which] = 0.0, slides
    contacts.hit[which], contacts.pace[which], contacts.chain[0] = t, goes, which
    if image >= 0:
        contacts.room[image], contacts.hit[image], contacts.pace[image] = 0.0, t, goes
    if rest_time >= 0.0:
        contacts.leans[which], corner = True, max(corner, image)
    if corner >= 0:
        contacts.leans[corner], contacts.room[corner] = True, 0.0
        _into_corner(wall, bounds.walls[corner], y)
        if body.radius * abs(y[SPIN]) <= _LEFT * speed:  # rims that roll on both
            y[SPIN] = 0.0
    for i in range(contacts.leans.size):  # an impact may push it off others, or into them
        if (
            contacts.leans[i]
            and i != which
            and i != corner
            and abs(outward(bounds.walls, i, y)) > _STILL * speed
        ):
            contacts.leans[i] = contacts.dying[i] = False
            contacts.room[i] = 0.0
    if rest_time >= 0.0:
        come_to_lean(contacts.rows[: touching(bounds, contacts)], y)
        for i in range(contacts.leans.size):
            if contacts.leans[i]:
                wall = bounds.walls[i]
                off = wall[NX] * y[X] + wall[NY] * y[Y] - wall[PLACE]  # rounding of the rebounds
                y[X] -= off * wall[NX]
                y[Y] -= off * wall[NY]
    look_at_rims(bounds, contacts, body, y, speed)  # an impact elsewhere turns a rim's slip, too
    return rest_time


@inlined
def gripped(
    bounds: Boundaries, contacts: Contacts, body: Body, fx: float, fy: float, y: FloatArray,
    speed: float,
) -> bool:  # fmt: skip
    """Whether friction without bound stops a rim on a wall towards which (fx, fy) drives the puck.

    What is a state in the laboratory goes on without the slip; in a corner nothing goes on.
    """
    found = False
    for i in range(contacts.leans.size):
        wall = bounds.walls[i]
        nx, ny = wall[NX], wall[NY]
        grips = wall[TANGENTIAL] != -1.0 and wall[FRICTION] >= LOCKS and not contacts.dying[i]
        if not (contacts.leans[i] and contacts.rim[i] != 0.0 and grips):
            continue
        if -(nx * fx + ny * fy) <= _LEFT * size(fx, fy, 0.0):
            continue
        found = True
        vx, vy = y[VX], y[VY]
        push_rim(body, nx, ny, -rim_slip(body, nx, ny, vx, vy, y[SPIN]), y)
        for j in range(contacts.leans.size):
            other = bounds.walls[j]
            change = other[NX] * (y[VX] - vx) + other[NY] * (y[VY] - vy)
            if contacts.leans[j] and j != i and change < -_LEFT * speed:
                y[VX] = y[VY] = y[SPIN] = 0.0
            elif j != i and change > _LEFT * speed:
                contacts.leans[j] = contacts.dying[j] = False
    if found:
        look_at_rims(bounds, contacts, body, y, speed)
    return found

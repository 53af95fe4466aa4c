"""Two lines that are met at once: which is first, and whether that matters.

Where a puck hits two cushions at the same moment, the motion that follows may jump with the launch:
a hair to one side it hits this one first, a hair to the other side that one, and what the first
does to the spin, or to the way, changes what the second does.  No law makes that one motion.  So
both orders are tried on the spot, each to the end of its rebounds.  If they give the same, nothing
is open: two smooth cushions at a right angle, say.  If not, and the moments are closer than what
the errors of a run may be, the run is followed in both orders; where that gives two ends,
finer steps are tried, and at last the scene is refused by name.  The same with a cushion and an
edge of the field.
"""

from __future__ import annotations

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, inner
from puck_tables.scene.boundaries import BOUNCES, EDGE, Boundaries, outward, room_to
from puck_tables.scene.cushions import FRICTION, NX, NY, RESTITUTION, TANGENTIAL, rebound
from puck_tables.scene.friction import SPIN, VX, VY, size
from puck_tables.scene.ingredients import Body
from puck_tables.scene.settle import Contacts

AS_IT_COMES, FIRST_BY_NUMBER, LAST_BY_NUMBER = 0, -1, 1  # orders of lines that are met at once
GROWN = 100.0  # times the local error: what the errors of a run may be
_STILL = 1e-13  # of the scale of speeds: no speed
_REBOUNDS = 200  # at one place; by then the slowest are over, or the same


@inner
def _rebounds(body: Body, wall: FloatArray, other: FloatArray, y: FloatArray) -> None:
    """A state in the laboratory after a wall and another one at the same place, and so on."""
    for i in range(_REBOUNDS):
        now = wall if i % 2 == 0 else other
        if i > 0 and now[NX] * y[VX] + now[NY] * y[VY] >= 0.0:
            return
        rebound(body, now, y)


@inlined
def _order_matters(
    body: Body, wall: FloatArray, other: FloatArray, level: float, y: FloatArray, one: FloatArray,
    two: FloatArray,
) -> bool:  # fmt: skip
    """Whether velocities and rim speed after both walls differ by more than ``level``."""
    for i in range(SPIN + 1):
        one[i] = two[i] = y[i]
    _rebounds(body, wall, other, one)
    _rebounds(body, other, wall, two)
    turned = body.radius * (one[SPIN] - two[SPIN])
    return size(one[VX] - two[VX], one[VY] - two[VY], turned) > level


@inlined
def _mirrored(wall: FloatArray, other: FloatArray, y: FloatArray, speed: float) -> bool:
    """Whether a puck comes along the line that bisects two walls, which are alike and smooth."""
    smooth = wall[TANGENTIAL] == -1.0 or wall[FRICTION] == 0.0
    smooth = smooth and (other[TANGENTIAL] == -1.0 or other[FRICTION] == 0.0)
    off = (wall[NX] - other[NX]) * y[VX] + (wall[NY] - other[NY]) * y[VY]
    return smooth and wall[RESTITUTION] == other[RESTITUTION] and abs(off) <= _STILL * speed


@inlined
def _nears(bounds: Boundaries, i: int, y: FloatArray) -> float:
    """How fast a puck nears a line, counted walls and then edges."""
    walls = len(bounds.walls)
    return -(outward(bounds.walls, i, y) if i < walls else outward(bounds.edges, i - walls, y))


@inlined
def _since(
    bounds: Boundaries, contacts: Contacts, i: int, t: float, y: FloatArray, length: float
) -> float:
    """For how long errors have grown in when a line is met: since it was, or for all the way."""
    way = length / max(_nears(bounds, i, y), 0.0)
    return min(way, t - contacts.hit[i]) if i < len(bounds.walls) else way


@inlined
def met_at_once(
    bounds: Boundaries, contacts: Contacts, happens: int, which: int, order: int, body: Body,
    t: float, y: FloatArray, speed: float, time: float, tolerance: float, one: FloatArray,
    two: FloatArray,
) -> tuple[int, int, int, int]:  # fmt: skip
    """What a puck, in the laboratory at ``y``, meets first; and another line, −1: that is sure.

    Also another wall that it hits as the mirror image of this one, −1: none.

    ``happens``, ``which``: the wall or edge that it is about to pass; ``order``: of lines of which
    it is not sure; ``speed``, ``time``: scales; ``tolerance``: local error in units of them;
    ``one``, ``two``: to work in.
    """
    walls, edges = len(bounds.walls), len(bounds.edges)
    still = max(tolerance, _STILL) * speed
    number = which if happens == BOUNCES else walls + which
    pick, unsure, image, unclear = number, -1, -1, 0
    length = speed * time
    doubt = GROWN * tolerance * _since(bounds, contacts, number, t, y, length)
    for i in range(walls + edges):
        if i == number or (i >= walls and happens == EDGE):  # over one edge or over another
            continue
        if i < walls and contacts.leans[i]:
            continue
        nears = _nears(bounds, i, y)
        room = contacts.room[i] if i < walls else room_to(bounds.edges, i - walls, y)
        after = doubt + GROWN * tolerance * _since(bounds, contacts, i, t, y, length)
        if nears <= still or room > nears * after:
            continue
        if number < walls and i < walls:
            wall, other = bounds.walls[number], bounds.walls[i]
            if not _order_matters(body, wall, other, still, y, one, two):
                continue
            if abs(room) <= _STILL * length and _mirrored(wall, other, y, speed):
                image = i
        unsure, unclear = i, unclear + 1
        if order == FIRST_BY_NUMBER:
            pick = min(pick, i)
        elif order == LAST_BY_NUMBER:
            pick = max(pick, i)
    if image >= 0 and unclear == 1:
        return BOUNCES, min(number, image), -1, max(number, image)
    if pick < walls:
        return BOUNCES, pick, unsure, -1
    return EDGE, pick - walls, unsure, -1

"""Rebounds that die out: when those that press on each other stay in contact.

Where rebounds are lower than 1e-13 of the radius, than 1e-14 of the places, or than a hundredth of
the error of a step (in units of Q²/J), they have died out.  Those of a disc that others squeeze
follow each other, none of them the last: they are told by how soon one comes after the other.  How
long what dies out would have lasted is kept: of one puck it is part of the error estimate.
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined
from puck_tables.scene.friction import VX, VY, X, Y
from puck_tables.world.contact_row import HOPS, NX, NY, E, approach, opening
from puck_tables.world.engine_state import IMPACT, N_EVENTS, PARTNER, TIME, WHAT, WHO, Engine, Whole
from puck_tables.world.floor_under import over_floor
from puck_tables.world.layout import RADIUS

_FLAT = 1e-13  # of the radius: rebounds as low have died out,
_LOW = 1e-14  # of the places: as these, whose height is rounding,
_LEAST = 1e-2  # and of the error of a step, in units of Q²/J
_LASTING = 0.99  # of the rebound before, at most: so long is the next one taken to be
_PRESSED = 1e-3  # of the scale of accelerations: what presses less brings no rebounds to an end
_SLOW = 1e-6  # of the scale of speeds: an impact that only what pushes brings about
MOST_BACK = 64  # events


@inlined
def _slip2(engine: Engine, i: int, states: FloatArray) -> float:
    """Q² of a disc over the floor."""
    vx, vy, spin = over_floor(engine.surface, engine.discs[i], states[i])
    rim = engine.discs[i, RADIUS] * spin
    return vx**2 + vy**2 + rim * rim


@inlined
def _lasting(
    engine: Engine, i: int, j: int, t: float, row: FloatArray, states: FloatArray, un: float,
    rising: float,
) -> float:  # fmt: skip
    """How long rebounds from an obstacle would last, of which the first begins at un.

    They are braked by ``rising`` on the way up; on the way down the rims and the floor rub back.
    """
    for side in range(2):  # there and back
        turn = (2.0 - 4.0 * side) * un
        states[i, VX] += turn * row[NX]
        states[i, VY] += turn * row[NY]
        if side == 0:
            falling = -opening(engine, i, j, t, row, states)
    if falling <= 0.0 or rising <= _PRESSED * engine.scale[1]:
        return 0.0
    share = math.sqrt(falling / rising)
    return un / rising * (1.0 + 1.0 / share) / (1.0 - min(row[E] * share, _LASTING))


@inlined
def dies_out(engine: Engine, i: int, j: int, t: float, row: FloatArray, states: FloatArray) -> bool:
    """Whether both press on each other so that this rebound and those after it are too low."""
    if row[E] >= 1.0:
        return False
    un, _ = approach(engine, i, j, row[NX], row[NY], states)
    closing = -opening(engine, i, j, t, row, states)
    way = _slip2(engine, i, states)
    if j >= 0:
        way = max(way, _slip2(engine, j, states))
    rounded = _LOW * (abs(states[i, X]) + abs(states[i, Y]))
    least = _LEAST * engine.scale[2] * way / engine.scale[1]
    height = max(rounded, _FLAT * engine.discs[i, RADIUS], least)
    if closing <= 0.0 or un > 0.0 or un * un > 2.0 * closing * height:
        return False
    if j < 0:
        engine.scale[4] += _lasting(engine, i, j, t, row, states, -un, closing)
    return True


@inlined
def is_squeezed(
    engine: Engine, t: float, contacts: Whole, count: int, rows: FloatArray, states: FloatArray
) -> bool:
    """Whether slow impacts follow so soon on the last of the same two that these never parted.

    So go on those that are squeezed by what pushes and rubs them, such as a disc between another
    one and a cushion: no single rebound of them dies out, and they would never end.  HOPS of a row
    tells who meets whom so.
    """
    slow, since = _SLOW * engine.scale[0], math.inf
    for n in range(count):
        i, j, row = contacts[n, 0], contacts[n, 1], rows[n]
        un, _ = approach(engine, i, j, row[NX], row[NY], states)
        if un > slow:
            return False
        row[HOPS] = 1.0 if un > 0.0 else 0.0
        if un <= 0.0 or since < t:
            continue
        early, last = t - _FLAT * engine.discs[i, RADIUS] / un, math.inf
        for back in range(1, min(engine.counts[N_EVENTS], MOST_BACK) + 1):
            event = engine.events[engine.counts[N_EVENTS] - back]
            if event[TIME] < early and since == math.inf:
                break
            if event[WHAT] == IMPACT and event[WHO] == i and event[PARTNER] == j:
                if since < t:  # each rebound lasts a share of the one before: what is left of them
                    hop, share = t - last, (t - last) / (last - event[TIME])
                    low = 8.0 * _FLAT * engine.discs[i, RADIUS] / (_PRESSED * engine.scale[1])
                    if row[E] > 0.0 and share < _LASTING and hop * hop < low:
                        engine.scale[4] += hop * share / (1.0 - share)
                    break
                since, last = early, event[TIME]
    if since == math.inf:
        return False
    for back in range(1, min(engine.counts[N_EVENTS], MOST_BACK) + 1):
        event = engine.events[engine.counts[N_EVENTS] - back]
        if event[TIME] < since:
            break
        for n in range(count):
            i, j, row = contacts[n, 0], contacts[n, 1], rows[n]
            if event[WHAT] == IMPACT and event[WHO] == i and event[PARTNER] == j:
                un, _ = approach(engine, i, j, row[NX], row[NY], states)
                row[HOPS] = 1.0 if un >= -slow else 0.0
    return True

"""When pucks come to rest on the floor and leave that rest, told from the segments they had."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import kernel, patience
from puck_tables.scene.friction import SPIN, X, Y
from puck_tables.scene.parts import Floor
from puck_tables.world import engine_state as g
from puck_tables.world.floor_under import least_slip
from puck_tables.world.lasting import STUCK, at_rest_below, middle_of
from puck_tables.world.layout import DECEL, INTEGRATED, LIGHTNESS
from puck_tables.world.record import segments_of, states_on
from puck_tables.world.segment import GONE, LOOKED_UP, PATH, START, UNTIL

STATE = SPIN + 1  # numbers of a state
Rest = tuple[float, str, int, float, float]  # when, stick or slip, which disc, where


def rests_of(engine: g.Engine) -> list[Rest]:
    """Every stick and slip until now; what an impact or a launch sets off is no slip."""
    found: list[Rest] = []
    for rest in _described(engine):
        if rest[1] == "slip" and found and found[-1][:3] == (rest[0], "stick", rest[2]):
            found.pop()  # it stopped, and was not held
        else:
            found.append(rest)
    return found


def _described(engine: g.Engine) -> list[Rest]:
    """Every stick and slip until now, also a rest that ends at once, disc by disc."""
    discs, ends, states = segments_of(engine)
    segments, kinds = engine.history[: len(discs), 2:], engine.history[: len(discs), 1]
    starts, stops = segments[:, START], np.where(kinds == LOOKED_UP, segments[:, UNTIL], ends)
    near, rows = at_rest_below(engine), engine.discs
    both = np.stack([starts, ends], 1)
    resting: npt.NDArray[np.bool_] = np.less_equal(slips_over(engine, discs, states, both), near)
    moves: npt.NDArray[np.bool_] = np.logical_not(resting.all(axis=1))
    unsure = np.flatnonzero((kinds == PATH) & ~moves & (starts < ends))  # perhaps rest to rest
    if unsure.size:
        middles = np.array([middle_of(engine, n, ends[n]) for n in unsure.tolist()])
        there = states_on(engine, unsure, middles)
        moves[unsure] = slips_over(engine, discs[unsure], there, middles) > STUCK * engine.scale[0]
    # none of what is driven, or what nothing can hold
    held = (rows[:, LIGHTNESS] > 0.0) & ((rows[:, DECEL] > 0.0) | (rows[:, INTEGRATED] > 0.0))
    own = np.argsort(discs, kind="stable")
    found: list[tuple[int, float, str]] = []
    disc, rested = -1, True
    for n in own[held[discs[own]]].tolist():
        if discs[n] != disc:
            disc, rested = discs[n], True  # what lies at the start has not come to rest
        if kinds[n] == GONE:
            continue
        first, last = resting[n]
        if first and not rested:
            found.append((n, starts[n], "stick"))
        if first and moves[n] and kinds[n] == PATH and starts[n] > 0.0:
            found.append((n, starts[n], "slip"))
        rested = last
        if last and moves[n]:
            found.append((n, min(stops[n], ends[n]), "stick"))
    at, times = np.array([n for n, *_ in found], np.int64), np.array([one[1] for one in found])
    places = states_on(engine, at, times)[:, [X, Y]].tolist() if found else []
    return [
        (float(time), what, int(discs[n]), x, y)
        for (n, time, what), (x, y) in zip(found, places, strict=True)
    ]


def slips_over(
    engine: g.Engine, discs: g.Whole, states: FloatArray, times: FloatArray
) -> FloatArray:
    """How fast the rims of discs (n,) slip over the floor at states (n, …, 6) and times, m/s."""
    slips, count = np.empty(states.shape[:-1]), len(discs)
    _fill_slips(
        engine, discs, states.reshape(count, -1, STATE), times.reshape(count, -1),
        slips.reshape(count, -1),
    )  # fmt: skip
    return slips


@kernel
def _fill_slips(
    engine: g.Engine, discs: g.Whole, states: FloatArray, times: FloatArray, out: FloatArray
) -> None:
    for n in range(states.shape[0]):
        for k in range(states.shape[1]):
            patience(1)
            out[n, k] = least_slip(engine, discs[n], states[n, k], times[n, k])


def floor_under(floor: Floor, x: float, y: float) -> str:
    """What a puck with its centre at (x, y) rests on, in words.

    >>> floor_under(Floor(), 0.0, 0.0)
    'floor'
    """
    if floor.strips is None:
        return "floor"
    along = math.cos(floor.strips.direction) * x + math.sin(floor.strips.direction) * y
    return f"strip {sum(along >= border for border in floor.strips.borders)}"

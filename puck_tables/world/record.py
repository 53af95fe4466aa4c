"""What was, told from the segments that discs had: their states at any moment, and their rests.

And what pushed them: the force with which constraints lead their discs, and what pucks gave a disc
that is driven, by impacts and by pushing it for a while.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, kernel, patience
from puck_tables.scene.equations import (
    FIRST,
    FORCE_WORK,
    LAMBDA,
    ROW,
    SIZE,
    rates,
    slip_speed,
    to_laboratory,
)
from puck_tables.scene.friction import SPIN, X, Y
from puck_tables.scene.ingredients import FREE, NO_DIRECTION, SLIDES, Phase
from puck_tables.scene.over_time import rows_passed
from puck_tables.scene.parts import Floor
from puck_tables.world.engine_state import (
    IMPACT,
    N_EVENTS,
    N_HISTORY,
    N_WORK_ROWS,
    NORMAL_X,
    NORMAL_Y,
    PARTNER,
    PUSH,
    RUB,
    WHAT,
    WHO,
    Engine,
    Whole,
)
from puck_tables.world.floor_under import friction_under_disc, least_slip, lie_at
from puck_tables.world.lasting import STUCK, at_rest_below, middle_of
from puck_tables.world.layout import (
    DECEL,
    HOLD,
    INTEGRATED,
    INV_MASS,
    KIND,
    NO_CUSHION,
    RADIUS,
    normal_to,
)
from puck_tables.world.lone_model import model_of
from puck_tables.world.segment import GONE, LOOKED_UP, PATH, RIDES, ROOM, START, UNTIL, state_at
from puck_tables.world.step_ledger import (
    BACK_X,
    BACK_Y,
    DURATION,
    LED_BY,
    LEDGER,
    SEGMENT,
    SEVERAL,
    WORK_START,
    add_worked,
)

_NEAR = 1e-9  # of the radius: what is as near may press
STATE = SPIN + 1  # numbers of a state
Rest = tuple[float, str, int, float, float]  # when, stick or slip, which disc, where


def reactions(
    engine: Engine, times: FloatArray, states: FloatArray, in_play: FloatArray
) -> FloatArray:
    """The multipliers λ of every disc (times, discs, 2), N, at states (times, discs, 6).

    ``in_play`` (times, discs): 0 of those that have left.

    0 of what is free, and of what rests: there the floor shares the force, and nobody knows how.
    NaN where a disc touches another or a cushion, which may press it too.
    """
    regions = engine.regions._replace(floor_map=engine.regions.floor_map.copy())
    own = engine._replace(discs=engine.discs.copy(), regions=regions)
    out = np.zeros((len(times), len(engine.discs), 2))
    _fill_reactions(own, times, in_play, states, np.empty(SIZE), np.empty((1, ROW)), out)
    return out


@kernel
def _fill_reactions(
    engine: Engine, times: FloatArray, in_play: FloatArray, states: FloatArray,
    y: FloatArray, work: FloatArray, out: FloatArray,
) -> None:  # fmt: skip
    for i in range(engine.discs.shape[0]):
        if int(engine.discs[i, HOLD]) == FREE:
            continue
        model, drive = model_of(engine, i), engine.forcing[engine.spans[i, 0] : engine.spans[i, 1]]
        for n in range(times.size):
            patience(1)
            for k in range(SIZE):
                y[k] = states[n, i, k] if k < FORCE_WORK else 0.0
            lie_at(engine, i, y[X], y[Y])
            to_laboratory(model.surface, y, -1.0)
            slips = slip_speed(engine.discs[i, RADIUS], y) > at_rest_below(engine)
            if in_play[n, i] == 0.0 or not slips:
                continue
            if _touches(engine, i, states[n]):
                out[n, i, 0] = out[n, i, 1] = math.nan
                continue
            rows = rows_passed(drive, 0, len(drive), times[n])
            friction = friction_under_disc(engine, i)
            phase = Phase(model, friction, rows, SLIDES, NO_DIRECTION, 0.0)
            rates(phase, times[n], y, work, FIRST)
            out[n, i, 0], out[n, i, 1] = work[0, LAMBDA], work[0, LAMBDA + 1]


@inlined
def _touches(engine: Engine, i: int, states: FloatArray) -> bool:
    """Whether a disc touches a cushion or another disc, at states (n, 6)."""
    x, y, radius = states[i, X], states[i, Y], engine.discs[i, RADIUS]
    for k in range(engine.obstacles.shape[0]):
        gap, _, _, there = normal_to(engine.obstacles[k], radius, x, y, 0.0)
        if there and gap < _NEAR * radius and int(engine.obstacles[k, KIND]) < NO_CUSHION:
            return True
    for j in range(engine.discs.shape[0]):
        gap = math.hypot(states[j, X] - x, states[j, Y] - y) - radius - engine.discs[j, RADIUS]
        if j != i and gap < _NEAR * radius:
            return True
    return False


class Reported(NamedTuple):
    """Until when it was told: time, s, how many events and works, and the first not at its end."""

    time: float = 0.0
    events: int = 0
    work_rows: int = 0
    open: int = 0


def pushed_back(engine: Engine, i: int, since: Reported) -> tuple[FloatArray, Reported]:
    """The impulse (2,) N s on a disc since then, and until when it is told now.

    NaN where several that are driven pushed the same pucks: nobody knows how they share it.
    """
    now, counts = float(engine.clock[0]), engine.counts
    impulse = _of_impacts(engine.events[since.events : counts[N_EVENTS]], i)
    still_open = int(counts[N_WORK_ROWS])
    ends: dict[int, float] = {}
    for n in range(since.open, int(counts[N_WORK_ROWS])):
        row = engine.work_rows[n]
        segment = int(row[SEGMENT])
        if segment not in ends:
            ends[segment] = _end_of(engine, segment)
        end = ends[segment]
        if min(float(row[WORK_START] + row[DURATION]), end) > now:
            still_open = min(still_open, n)
        driver = int(row[LED_BY])
        if driver not in (i, SEVERAL) or min(now, end) < row[WORK_START]:
            continue
        total = _worked(row, min(now, end))
        if n < since.work_rows:
            total -= _worked(row, min(since.time, end))
        impulse += total if driver == i else math.nan
    return impulse, Reported(now, int(counts[N_EVENTS]), int(counts[N_WORK_ROWS]), still_open)


def _of_impacts(events: FloatArray, i: int) -> FloatArray:
    """The impulse (2,) of impacts on a disc."""
    hits = events[events[:, WHAT] == IMPACT]
    sign = (hits[:, PARTNER] == i) * 1.0 - (hits[:, WHO] == i)
    nx, ny, push, rub = hits[:, [NORMAL_X, NORMAL_Y, PUSH, RUB]].T
    return np.array([sign @ (push * nx - rub * ny), sign @ (push * ny + rub * nx)])


def _worked(row: FloatArray, t: float) -> FloatArray:
    """What of a row was given by t."""
    ledger = np.zeros(LEDGER)
    if t >= row[WORK_START]:
        add_worked(row, t, ledger)
    return ledger[[BACK_X, BACK_Y]]


def _end_of(engine: Engine, segment: int) -> float:
    """When a segment, a row of the history, ended; inf: not yet, or it is none."""
    if segment < 0:
        return math.inf
    later = engine.history[segment + 1 : engine.counts[N_HISTORY]]
    own = np.flatnonzero(later[:, 0] == engine.history[segment, 0])
    return float(later[own[0], 2 + START]) if own.size else math.inf


def rests_of(engine: Engine) -> list[Rest]:
    """Every stick and slip until now; what an impact or a launch sets off is no slip."""
    rests: list[Rest] = []
    for rest in _described(engine):
        if rest[1] == "slip" and rests and rests[-1][:3] == (rest[0], "stick", rest[2]):
            rests.pop()  # it stopped, and was not held
        else:
            rests.append(rest)
    return rests


def _described(engine: Engine) -> list[Rest]:
    """Every stick and slip until now, also a rest that ends at once, disc by disc."""
    discs, ends, states = segments_of(engine)
    segments, kinds = engine.history[: len(discs), 2:], engine.history[: len(discs), 1]
    starts, stops = segments[:, START], np.where(kinds == LOOKED_UP, segments[:, UNTIL], ends)
    near, rows = at_rest_below(engine), engine.discs
    both = np.stack([starts, ends], 1)
    resting: npt.NDArray[np.bool_] = np.less_equal(slips_over(engine, discs, states, both), near)
    moves: npt.NDArray[np.bool_] = np.logical_not(resting.all(axis=1))
    unsure = np.flatnonzero(
        (kinds == PATH) & ~moves & (segments[:, RIDES] == 0.0) & (starts < ends)
    )  # perhaps rest to rest
    if unsure.size:
        middles = np.array([middle_of(engine, n, ends[n]) for n in unsure.tolist()])
        there = states_on(engine, unsure, middles)
        moves[unsure] = slips_over(engine, discs[unsure], there, middles) > STUCK * engine.scale[0]
    # none of what is driven, or what nothing can hold
    held = (rows[:, INV_MASS] > 0.0) & ((rows[:, DECEL] > 0.0) | (rows[:, INTEGRATED] > 0.0))
    own = np.argsort(discs, kind="stable")
    rests: list[tuple[int, float, str]] = []
    disc, rested = -1, True
    for n in own[held[discs[own]]].tolist():
        if discs[n] != disc:
            disc, rested = discs[n], True  # what lies at the start has not come to rest
        if kinds[n] == GONE:
            continue
        first, last = resting[n]
        if first and not rested:
            rests.append((n, starts[n], "stick"))
        if first and moves[n] and kinds[n] == PATH and starts[n] > 0.0:
            rests.append((n, starts[n], "slip"))
        rested = last
        if last and moves[n]:
            rests.append((n, min(stops[n], ends[n]), "stick"))
    at = np.array([n for n, *_ in rests], np.int64)
    times = np.array([time for _, time, _ in rests])
    places = states_on(engine, at, times)[:, [X, Y]].tolist() if rests else []
    return [
        (float(time), what, int(discs[n]), x, y)
        for (n, time, what), (x, y) in zip(rests, places, strict=True)
    ]


def slips_over(engine: Engine, discs: Whole, states: FloatArray, times: FloatArray) -> FloatArray:
    """How fast the rims of discs (n,) slip over the floor at states (n, …, 6) and times, m/s."""
    slips, count = np.empty(states.shape[:-1]), len(discs)
    _fill_slips(
        engine, discs, states.reshape(count, -1, STATE), times.reshape(count, -1),
        slips.reshape(count, -1),
    )  # fmt: skip
    return slips


@kernel
def _fill_slips(
    engine: Engine, discs: Whole, states: FloatArray, times: FloatArray, out: FloatArray
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


def states_now(engine: Engine, work: FloatArray) -> FloatArray:
    """States of all discs now, array (discs, 6); ``work``: of a room."""
    out = np.empty((len(engine.discs), 6))
    _fill_now(engine, work, out)
    return out


def states_at(engine: Engine, times: FloatArray) -> FloatArray:
    """States of all discs, array (times, discs, 6), at ascending times up to now, s.

    One that has left play stays where it left.
    """
    count, moments = len(engine.discs), np.asarray(times, np.float64)
    rows, segments = np.empty((len(moments), count), np.int64), int(engine.counts[N_HISTORY])
    _fill_rows(engine.history, segments, moments, np.full(count, len(moments)), rows)
    states = states_on(engine, rows.ravel(), np.repeat(moments, count))
    return states.reshape(len(moments), count, 6)


def segments_of(engine: Engine) -> tuple[Whole, FloatArray, FloatArray]:
    """The disc of every segment, when it ended, and its states then and at its start.

    Arrays (segments,), (segments,) and (segments, 2, 6), the start first.
    """
    history = engine.history[: engine.counts[N_HISTORY]]
    discs, starts = history[:, 0].astype(np.int64), history[:, 2 + START]
    ends, own = np.full(len(discs), engine.clock[0]), np.argsort(discs, kind="stable")
    before, after = own[:-1], own[1:]
    one = discs[before] == discs[after]
    ends[before[one]] = starts[after[one]]
    rows = np.repeat(np.arange(len(discs)), 2)
    states = states_on(engine, rows, np.stack([starts, ends], 1).ravel())
    return discs, ends, states.reshape(-1, 2, 6)


def states_on(engine: Engine, rows: Whole, times: FloatArray) -> FloatArray:
    """States (n, 6) on the segments in these rows at these times."""
    out = np.empty((len(rows), 6))
    _fill(engine, rows, times, np.empty(ROOM), out)
    return out


@inlined
def first_from(times: FloatArray, t: float) -> int:
    """The first of ascending times that is not before t; their number: none."""
    low, high = 0, times.size
    while low < high:
        middle = (low + high) // 2
        if times[middle] < t:
            low = middle + 1
        else:
            high = middle
    return low


@kernel
def _fill_rows(
    history: FloatArray, segments: int, times: FloatArray, open_to: Whole, out: Whole
) -> None:
    """On which segments discs are, rows of the history (times, discs).

    ``open_to`` (discs,): before which time nothing is filled yet, at first all.
    """
    for n in range(segments - 1, -1, -1):
        i = int(history[n, 0])
        begin = first_from(times, history[n, 2 + START])
        for k in range(begin, open_to[i]):
            patience(1)
            out[k, i] = n
        open_to[i] = min(open_to[i], begin)


@kernel
def _fill_now(engine: Engine, work: FloatArray, out: FloatArray) -> None:
    for i in range(engine.discs.shape[0]):
        state_at(
            engine.kinds[i], engine.segments[i], engine.discs[i], engine.lookups, engine.pieces,
            engine.clock[0], work, out[i],
        )  # fmt: skip


@kernel
def _fill(
    engine: Engine, rows: Whole, times: FloatArray, work: FloatArray, out: FloatArray
) -> None:
    for n in range(rows.size):
        patience(1)
        segment = engine.history[rows[n]]
        state_at(
            int(segment[1]), segment[2:], engine.discs[int(segment[0])], engine.lookups,
            engine.pieces, times[n], work, out[n],
        )  # fmt: skip

"""A step of a lone puck as pieces of its path, and what they did to the energies.

A step of order 8 is longer than a polynomial of degree five is as good as the promise.  Its stages
tell of all states within it, with an error of one order less; between such it is cut into as many
pieces as are needed, and once, in its middle, it is looked at what acts.
"""

from __future__ import annotations

import math
from typing import NamedTuple, cast

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, inner
from puck_tables.scene.equations import (
    DRY,
    FIRST,
    FORCE_WORK,
    ROW,
    SIZE,
    SUPPORT,
    VISCOUS,
    rates,
    to_laboratory,
)
from puck_tables.scene.friction import SPIN, THETA, VX, VY, X, Y
from puck_tables.scene.ingredients import FREE, Phase, floor_velocity, surface_now
from puck_tables.scene.radau import RADAU_ROWS
from puck_tables.scene.steps import SHARES, STAGES, accelerations, come_by, rate_at, step
from puck_tables.world import step_ledger
from puck_tables.world.engine_state import N_HISTORY, N_PIECES, N_WORK_ROWS, Engine
from puck_tables.world.paths import BEGINS, DURATION, on_piece
from puck_tables.world.paths import FIRST as PLACES

COARSER = 10.0  # times the error of a step: of a piece, whose errors do not add up
_BETWEEN = 3.0  # times what its stages miss in the middle of a step are errors elsewhere
_ROUNDED = 1e-15  # of a place: so well its change over a piece is known, and velocities by that
_SAFE = 0.8  # of how long a step could be, by what the last one missed
# of a polynomial of degree five that is wrong by d in its second derivative in the middle, over h:
_PLACE, _RATE = 1.0 / 24.0, 0.144  # its places are off by so much d h² at most, its rates d h
_WORK = 0.144  # and of one of degree four that is wrong by d in its first derivative there, over h


class LoneBuffer(NamedTuple):
    """Where to work: rows of one array, for each array that comes from Python costs its call.

    Rates of the stages of a step (22, 12), and in its middle (1, 12); states at its start, its end
    and in its middle (12,); scales of a state; a place on a piece; states and rates at the start,
    the end and in the middle of a piece (3, 12); powers at its start, its energies, powers at its
    end, and the energies half way (4, …).
    """

    stages: FloatArray
    middle: FloatArray
    y: FloatArray
    new: FloatArray
    trial: FloatArray
    scale: FloatArray
    place: FloatArray
    states: FloatArray
    ends: FloatArray
    ledgers: FloatArray


# rows of a buffer, in the order of its arrays
_SINGLE = RADAU_ROWS + 1
_STATES = _SINGLE + 5
_ENDS, _LEDGERS = _STATES + 3, _STATES + 6
BUFFER_ROWS = _LEDGERS + 4
BEGUN, ENDED, HALF = cast(int, np.int64(0)), cast(int, np.int64(1)), cast(int, np.int64(2))


@inlined
def buffer_on(rows: FloatArray) -> LoneBuffer:
    """A buffer on rows (38, 12)."""
    return LoneBuffer(
        rows[:RADAU_ROWS], rows[RADAU_ROWS:_SINGLE], rows[_SINGLE], rows[_SINGLE + 1],
        rows[_SINGLE + 2], rows[_SINGLE + 3], rows[_SINGLE + 4], rows[_STATES:_ENDS],
        rows[_ENDS:_LEDGERS], rows[_LEDGERS:BUFFER_ROWS],
    )  # fmt: skip


@inlined
def _write_piece(phase: Phase, begin: float, h: float, row: FloatArray, buffer: LoneBuffer) -> None:
    """A piece of the path between two states."""
    row[BEGINS], row[DURATION] = begin, h
    for end in range(2):
        state = buffer.states[end]
        floor = surface_now(phase, begin + end * h)
        ax, ay, turn = accelerations(floor, state, buffer.ends, end)
        first = PLACES + 9 * end
        for n in range(3):
            row[first + n], row[first + 3 + n] = state[n], buffer.ends[end, n]
        row[first + 6], row[first + 7], row[first + 8] = ax, ay, turn


@inlined
def _write_work(engine: Engine, begin: float, h: float, number: int, buffer: LoneBuffer) -> None:
    """What a piece, after so many others, did to the energies."""
    row = engine.work_rows[engine.counts[N_WORK_ROWS] + number]
    before, done, after, half = (
        buffer.ledgers[0], buffer.ledgers[1], buffer.ledgers[2], buffer.ledgers[3],
    )  # fmt: skip
    states, ends = buffer.states, buffer.ends
    for n in range(FORCE_WORK, SIZE):
        entry = step_ledger.PULL_WORK
        if n == DRY:
            entry = step_ledger.FLOOR_HEAT
        elif n == VISCOUS:
            entry = step_ledger.DRAG_HEAT
        elif n == SUPPORT:
            entry = step_ledger.SUPPORT_WORK
        before[entry], after[entry] = ends[BEGUN, n], ends[ENDED, n]
        done[entry] = states[ENDED, n] - states[BEGUN, n]
        half[entry] = states[HALF, n] - states[BEGUN, n]
    row[step_ledger.SEGMENT] = engine.counts[N_HISTORY]
    step_ledger.write_work(row, begin, h, before, done, after, half)


@inlined
def _put(share: int, phase: Phase, t: float, h: float, to: int, buffer: LoneBuffer) -> None:
    """State and rates at so many shares of a step over h to where those of a piece stand."""
    state, row, stages = buffer.states[to], buffer.ends[to], buffer.stages
    if share == SHARES:
        for n in range(ROW):
            state[n], row[n] = buffer.new[n], stages[STAGES - 1, n]
    elif 2 * share == SHARES:
        for n in range(ROW):
            state[n], row[n] = buffer.trial[n], buffer.middle[0, n]
    else:
        for n in range(SIZE):
            state[n], row[n] = buffer.y[n] + come_by(share, h, stages, n), rate_at(share, stages, n)
        floor = surface_now(phase, t + share * h / SHARES)
        sx, sy, turning = floor_velocity(floor, state[X], state[Y])
        row[X], row[Y], row[THETA] = state[VX] + sx, state[VY] + sy, state[SPIN] + turning


@inlined
def _end_as_led(row: FloatArray, buffer: LoneBuffer) -> None:
    """Let a piece end where its velocities lead, by a polynomial through that in its middle, too.

    A place that does not fit them by as much as it may be wrong spoils them on a short piece.
    """
    h = row[DURATION]
    for n in range(3):
        first, last = PLACES + n, PLACES + 9 + n
        moved = (7.0 * (row[first + 3] + row[last + 3]) + 16.0 * buffer.ends[HALF, n]) / 30.0
        row[last] = row[first] + h * (moved + h * (row[first + 6] - row[last + 6]) / 60.0)
        buffer.states[ENDED, n] = row[last]


@inner
def _write_parts(
    engine: Engine, phase: Phase, t: float, h: float, number: int, parts: int, tol: float,
    buffer: LoneBuffer,
) -> float:  # fmt: skip
    """Write an explicit step as so many pieces, with their works; how wrong they are in the middle.

    Over what they may be, by what their accelerations there lack of what acts.
    """
    scale, place, states, ends = buffer.scale, buffer.place, buffer.states, buffer.ends
    each, stride, largest = h / parts, SHARES // parts, 0.0
    for n in range(ROW):
        states[BEGUN, n], ends[BEGUN, n] = buffer.y[n], buffer.stages[0, n]
    for part in range(parts):
        begin, row = t + part * each, engine.pieces[engine.counts[N_PIECES] + number + part]
        _put((part + 1) * stride, phase, t, h, ENDED, buffer)
        _put(part * stride + stride // 2, phase, t, h, HALF, buffer)
        _write_piece(phase, begin, each, row, buffer)
        if part + 1 < parts:
            _end_as_led(row, buffer)
        on_piece(row, begin + 0.5 * each, place)
        acts = accelerations(surface_now(phase, begin + 0.5 * each), states[HALF], ends, HALF)
        for n in range(3):
            gap, off = each * abs(place[6 + n] - acts[n]), abs(place[3 + n] - ends[HALF, n])
            largest = max(largest, _PLACE * each * gap / scale[n], _RATE * gap / scale[VX + n])
            off -= _ROUNDED * (abs(states[BEGUN, n]) + abs(states[ENDED, n])) / each
            largest = max(largest, off / scale[VX + n])
        for n in range(FORCE_WORK, SIZE):
            both, done = ends[BEGUN, n] + ends[ENDED, n], states[ENDED, n] - states[BEGUN, n]
            gap = each * (ends[HALF, n] + 0.25 * both) - 1.5 * done
            largest = max(largest, _WORK * abs(gap) / scale[n])
        _write_work(engine, begin, each, number + part, buffer)
        for n in range(ROW):
            states[BEGUN, n], ends[BEGUN, n] = states[ENDED, n], ends[ENDED, n]
    return largest / (COARSER * tol)


@inlined
def _look_between(phase: Phase, t: float, h: float, piece: FloatArray, buffer: LoneBuffer) -> float:
    """What acts in the middle of an explicit step; how wrong it is between its ends, in scales.

    That is inf where only its ends, and the ``piece`` between them, satisfy a constraint.
    """
    trial, stages, off = buffer.trial, buffer.stages, 0.0
    for n in range(SIZE):
        trial[n] = buffer.y[n] + come_by(SHARES // 2, h, stages, n)
    if phase.model.hold.kind != FREE:
        on_piece(piece, t + 0.5 * h, buffer.place)
        for n in range(FORCE_WORK):
            trial[n] = buffer.place[n]
        to_laboratory(surface_now(phase, t + 0.5 * h), trial, -1.0)
        off = math.inf
    rates(phase, t + 0.5 * h, trial, buffer.middle, FIRST)
    for n in range(FORCE_WORK):
        missed = abs(buffer.middle[0, n] - rate_at(SHARES // 2, stages, n))
        past = abs(buffer.y[n] + come_by(SHARES, h, stages, n) - buffer.new[n])
        off = max(off, _BETWEEN * h * missed / buffer.scale[n], past / buffer.scale[n])
    return off


@inlined
def _missed_halfway(
    phase: Phase, t: float, h: float, piece: FloatArray, tol: float, buffer: LoneBuffer
) -> float:
    """How wrong an implicit step is as a piece, over what it may be: by half a step.

    By accelerations one would not see it, for friction magnifies what they lack.
    """
    on_piece(piece, t + 0.5 * h, buffer.place)
    middle, largest = buffer.states[HALF], 0.0
    error = step(phase, t, 0.5 * h, buffer.y, buffer.scale, buffer.stages, middle)
    if not error < math.inf:
        for n in range(FORCE_WORK, SIZE):  # as short as it may be, the step is taken all the same
            middle[n] = 0.5 * (buffer.states[BEGUN, n] + buffer.states[ENDED, n])
        return math.inf
    to_laboratory(surface_now(phase, t + 0.5 * h), middle, 1.0)
    for n in range(FORCE_WORK):
        largest = max(largest, abs(buffer.place[n] - middle[n]) / buffer.scale[n])
    return largest / (COARSER * tol)


@inner
def write_step(
    engine: Engine, phase: Phase, t: float, h: float, number: int, tol: float, most: int,
    buffer: LoneBuffer,
) -> tuple[int, float, float]:  # fmt: skip
    """Write a step, after so many pieces, as ``most`` more at most.

    How many, how wrong they are over what they may be, and how long the step may be for that.
    """
    first = engine.pieces[engine.counts[N_PIECES] + number]
    states, ends = buffer.states, buffer.ends
    for n in range(ROW):
        states[BEGUN, n], ends[BEGUN, n] = buffer.y[n], buffer.stages[0, n]
    _put(SHARES, phase, t, h, ENDED, buffer)
    _write_piece(phase, t, h, first, buffer)
    if phase.newton > 0.0:
        coarse = _missed_halfway(phase, t, h, first, tol, buffer)
        _write_work(engine, t, h, number, buffer)
        return 1, coarse, _as_long(coarse, 0.2, h)
    off = _look_between(phase, t, h, first, buffer) / (COARSER * tol)
    if not math.isfinite(buffer.middle[0, VX]):  # it tips there
        return 1, math.inf, 0.2 * h
    whole, parts = _write_parts(engine, phase, t, h, number, 1, tol, buffer), 1
    if not off < math.inf:
        return 1, whole, _as_long(whole, 0.2, h)
    coarse, share = whole, float(most) ** 5
    while coarse > 1.0 and parts < most and off <= 1.0:
        parts *= 2
        if whole <= float(parts) ** 5 or parts == most:
            coarse = _write_parts(engine, phase, t, h, number, parts, tol, buffer)
    coarse, longest = max(coarse, off), _as_long(off, 1.0 / 7.0, h)
    longest = min(
        longest, _as_long(whole / share, 0.2, h), h * (_SAFE if coarse > 1.0 else math.inf)
    )
    return parts, coarse, longest


@inlined
def _as_long(coarse: float, power: float, h: float) -> float:
    """How long a step may be, where one over h was wrong by so many times what it may be.

    ``power``: of its error over the length.
    """
    return h * max(0.2, _SAFE * coarse**-power) if coarse > 0.0 else math.inf

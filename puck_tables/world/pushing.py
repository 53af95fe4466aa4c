"""A group of discs in sustained contact, followed in time until something changes.

The modes of the contacts (which press, which rims stick) and who is at rest are known, see
:func:`puck_tables.world.pressing.press`; while they hold the motion is smooth, and integrated by
Dormand–Prince 5(4) in time.  Where a slip ends, the direction of friction turns within Q/|Q′|: a
step is at most half of that, down to 1e-12 of the scale of speeds.  Whatever changes is found on
real steps.
"""

from __future__ import annotations

from typing import cast

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, inner, patience
from puck_tables.motion.steppers import times_as_long
from puck_tables.scene.friction import VX, VY, X, Y
from puck_tables.world.engine_state import Engine
from puck_tables.world.floor_under import is_over, moves_along, nears_another, room_on_floor
from puck_tables.world.group import (
    DRIVEN,
    FULL,
    GAP,
    HELD,
    MOVES,
    NOT_FINITE,
    OFF_BORDER,
    PARTS,
    RESTS,
    SETS_OFF,
    STILL,
    TIME_UP,
    UNSOLVED,
    YIELDS,
    GroupBuffer,
    IntArray,
    Scales,
    find_places,
    look,
    small_slip,
)
from puck_tables.world.group_forces import can_rest, count_rows, slip_at
from puck_tables.world.layout import INV_MASS, LIES, RADIUS, ROUNDED, write_over
from puck_tables.world.paths import BEGINS, DURATION, on_piece, piece_at
from puck_tables.world.stepping import (
    BEGIN,
    END,
    add_work,
    first_negative,
    longest_step,
    rates_at,
    sets_off,
    step,
    watch,
    write_piece,
)

_CLOSED = 0.05  # of a radius times the error of a step: the gap of discs in touch between steps
_FIRST = 1e-3  # of Q/J: the first step
_BRIEF = 1e-6  # of Q/J: on as short a step gaps are rounding
_SHORTEST = 1e-16  # of Q/J: shorter steps lead nowhere
_CLOSE = 1e-14  # of a step: how close a moment is found
_ULP = 4e-16  # of a time: to which it is rounded, twice
_OVER = 1e-12  # of a radius: beyond a border
_NOBODY = _OVER_BORDER = cast(int, np.int64(-1))  # in place of a contact, of what it does


@inlined
def _next_row(
    engine: Engine,
    members: IntArray,
    motions: IntArray,
    t: float,
    t_end: float,
    buffer: GroupBuffer,
) -> float:
    """The next moment, at most ``t_end``, at which a film or a force turns to its next row."""
    end = t_end
    for place in range(members.shape[0]):
        row = engine.spans[members[place], 0] + buffer.passed[place]
        if row < engine.spans[members[place], 1]:
            end = min(end, engine.forcing[row, 0])
        if motions[place] == DRIVEN:
            first, last = engine.drives[members[place], 0], engine.drives[members[place], 1]
            row = engine.pieces[piece_at(engine.pieces, first, last, t)]
            turns = row[BEGINS] + row[DURATION]
            if t < turns < end:
                end = turns
    return end


@inner
def _advance(
    engine: Engine, members: IntArray, modes: IntArray, motions: IntArray, t: float, h: float,
    scales: Scales, buffer: GroupBuffer,
) -> float:  # fmt: skip
    """A step, and what is watched at its end; the error."""
    error = step(engine, members, modes, motions, t, h, scales, buffer)
    watch(buffer, modes, scales, True)
    return error


@inlined
def _room_of(engine: Engine, members: IntArray, place: int, y: FloatArray) -> float:
    """How far a member is from a border, in radii, and a little more."""
    number = members[place]
    room = room_on_floor(engine, number, y[place])
    return room / engine.discs[number, RADIUS] + _OVER


@inlined
def _comes_over(engine: Engine, members: IntArray, buffer: GroupBuffer) -> int:
    """Which member has come over a border, or left it, on a step: there friction bends; −1: none.

    One that only just touches one has long been there.
    """
    for place in range(members.shape[0]):
        if engine.discs[members[place], INV_MASS] > 0.0:
            before = _room_of(engine, members, place, buffer.states[0])
            if before > 0.0 > _room_of(engine, members, place, buffer.states[1]):
                return place
    return -1


@inlined
def _changes_belts(engine: Engine, members: IntArray, buffer: GroupBuffer) -> bool:
    """Whether a member has come nearer to the velocity of another belt under it, on a step."""
    for place in range(members.shape[0]):
        y = buffer.states[1, place]
        if nears_another(engine, members[place], y[X], y[Y], y[VX], y[VY]):
            return True
    return False


@inlined
def _watched(
    engine: Engine, members: IntArray, modes: IntArray, motions: IntArray, c: int, kind: int,
    scales: Scales, buffer: GroupBuffer,
) -> float:  # fmt: skip
    """What turns negative, at the end of a step."""
    if kind == _OVER_BORDER:
        return _room_of(engine, members, c, buffer.states[1])
    if c >= 0:
        return buffer.watched[1, c, kind]
    return -1.0 if sets_off(engine, members, modes, motions, scales, buffer) != 0 else 1.0


@inner
def _moment(
    engine: Engine, members: IntArray, modes: IntArray, motions: IntArray, t: float, h: float,
    c: int, kind: int, scales: Scales, buffer: GroupBuffer,
) -> float:  # fmt: skip
    """Until when within a step what is watched is positive; the step ends just after.

    By false position, with the weight of an end that stays halved (Illinois).  ``c``: a contact, or
    the place of a member that comes over a border, up to _OVER beyond it; −1: until when nobody at
    rest is set off, by halves.
    """
    low, high, first, last, enough, close = 0.0, h, 1.0, -1.0, 0.0, _CLOSE * h
    if c < 0 and kind != _OVER_BORDER:
        close = max(close, _ULP * t)  # a moment after t, or nothing ever moves on
    if kind == _OVER_BORDER:
        first, enough = _room_of(engine, members, c, buffer.states[0]), -_OVER
        last = _room_of(engine, members, c, buffer.states[1])
    elif c >= 0:
        first, last = buffer.watched[0, c, kind], buffer.watched[1, c, kind]
    for _ in range(80):
        middle = (low * last - high * first) / (last - first)
        if c < 0 or not low < middle < high:
            middle = 0.5 * (low + high)
        if high - low <= close or last > enough or not low < middle < high:
            break
        _advance(engine, members, modes, motions, t, middle, scales, buffer)
        value = _watched(engine, members, modes, motions, c, kind, scales, buffer)
        if value < 0.0:
            high, last, first = middle, value, 0.5 * first
        else:
            low, first, last = middle, value, 0.5 * last
    _advance(engine, members, modes, motions, t, high, scales, buffer)
    return high


@inlined
def _opens_midway(
    engine: Engine, members: IntArray, contacts: int, pieces: FloatArray, count: int, start: float,
    h: float, tol: float, buffer: GroupBuffer,
) -> float:  # fmt: skip
    """How far apart, or into each other, discs in touch are midway, over what they may be.

    There the polynomials between the ends of a step are off by most.
    """
    if contacts == 0:
        return 0.0
    trial, largest = buffer.states[2], 0.0
    for place in range(members.shape[0]):
        piece = pieces[place, count]
        write_piece(piece, start, h, place, buffer)
        on_piece(piece, start + 0.5 * h, buffer.film)
        write_over(trial[place], buffer.film[:6])
    look(engine, members, buffer.pairs[:contacts], trial, buffer.midway)
    for c in range(contacts):
        place = buffer.pairs[c, 0]
        radius = engine.discs[members[place], RADIUS]
        rounded = ROUNDED * (abs(trial[place, X]) + abs(trial[place, Y]) + radius)
        if buffer.pairs[c, 1] >= 0:
            radius = min(radius, engine.discs[members[buffer.pairs[c, 1]], RADIUS])
        largest = max(largest, abs(buffer.midway[c, GAP]) / (_CLOSED * tol * radius + rounded))
    return largest


@inlined
def _first_change(
    engine: Engine, members: IntArray, modes: IntArray, motions: IntArray, contacts: int, t: float,
    length: float, still_there: bool, scales: Scales, buffer: GroupBuffer,
) -> tuple[int, int, float, bool]:  # fmt: skip
    """What is the first to change on a step, of which contact or member, when, and if it was cut.

    ``still_there``: whether anybody is at rest whom somebody touches.
    """
    how, which, is_short = TIME_UP, -1, False
    while True:
        c, kind = first_negative(buffer, 1, contacts)
        if c < 0:
            break
        how, which, is_short = PARTS + kind, c, True
        length = _moment(engine, members, modes, motions, t, length, c, kind, scales, buffer)
        if first_negative(buffer, 1, contacts) == (c, kind):
            break
    if still_there:
        goes = sets_off(engine, members, modes, motions, scales, buffer)
        if goes < 0:
            return UNSOLVED, which, length, is_short
        if goes > 0:
            how, which, is_short = SETS_OFF, -1, True
            length = _moment(
                engine, members, modes, motions, t, length, _NOBODY, BEGIN, scales, buffer
            )
    if how == TIME_UP and engine.discs.shape[1] > LIES:  # there are borders on the floor
        which = _comes_over(engine, members, buffer)
        if which >= 0:
            how, is_short = OFF_BORDER, True
            length = _moment(
                engine, members, modes, motions, t, length, which, _OVER_BORDER, scales, buffer
            )
        elif _changes_belts(engine, members, buffer):
            how = OFF_BORDER
    return how, which, length, is_short


@inlined
def _slips(
    engine: Engine, members: IntArray, motions: IntArray, t: float, length: float, how: int,
    which: int, scales: Scales, buffer: GroupBuffer,
) -> tuple[int, int, bool]:  # fmt: skip
    """What changes, and of whom, with those that come to rest on a step; and if a slip has begun.

    Then it is so large that it has a direction of its own.
    """
    begun = False
    for place in range(members.shape[0]):
        number = members[place]
        earlier = slip_at(engine, number, buffer.states[0, place], t)
        q = slip_at(engine, number, buffer.states[1, place], t + length)
        if motions[place] == YIELDS and (q > small_slip(scales) or q < earlier):
            motions[place], begun = MOVES, True
        elif how == TIME_UP and motions[place] == MOVES and can_rest(engine, number):
            how = RESTS if q <= STILL * scales.speed and q < earlier else how
            which = place if how == RESTS else which
    return how, which, begun


@inlined
def _go_on_from(size: int, contacts: int, buffer: GroupBuffer) -> None:
    """The end of a step is the start of the next."""
    for place in range(size):
        write_over(buffer.states[0, place], buffer.states[1, place])
        write_over(buffer.stages[0, place], buffer.stages[END, place])
    write_over(buffer.powers[0], buffer.powers[END])
    for c in range(contacts):
        write_over(buffer.watched[0, c], buffer.watched[1, c])


@inlined
def _is_touched_at_rest(
    engine: Engine, members: IntArray, contacts: int, motions: IntArray
) -> bool:
    """Whether anybody is at rest whom somebody touches, or what acts on whom changes."""
    for place in range(members.shape[0]):
        number = members[place]
        forced = engine.spans[number, 0] < engine.spans[number, 1]
        over = is_over(engine, number) and moves_along(engine.surface)
        changes = contacts > 0 or forced or over or engine.surface.spin != 0.0
        if motions[place] == HELD and changes:
            return True
    return False


@inner
def follow(
    engine: Engine, members: IntArray, contacts: IntArray, states: FloatArray, t: float,
    t_end: float, scales: Scales, modes: IntArray, motions: IntArray, pieces: FloatArray,
    work_rows: FloatArray, buffer: GroupBuffer,
) -> tuple[int, int, float, int]:  # fmt: skip
    """Follow a group from t until something changes, at most until ``t_end``.

    Parameters
    ----------
    members : (m,) numbers of discs
    contacts : (c, 2) pairs of a disc and its partner, see :mod:`puck_tables.world.layout`
    states : (n, 6) of all discs at t in the laboratory; those of members are moved on
    scales : what errors refer to
    modes, motions : (c,) and (m,), as :func:`puck_tables.world.pressing.press` leaves them
        Contacts that are APART are not looked at.
    pieces : (≥ m, rows, 20), the ways, see :mod:`puck_tables.world.paths`
        ``pieces[a, :count]`` are those of member a, one row for each step.
    work_rows : (rows, 37), where the energy went, see :mod:`puck_tables.world.step_ledger`
        ``work_rows[:count]``, one row for each step, but for its first two columns.
    buffer : to work on

    Returns
    -------
    how it ended (TIME_UP … OFF_BORDER), which contact or member is concerned, when, and the number
    of rows for each member
    """
    size = members.shape[0]
    find_places(members, contacts, buffer)
    y = buffer.states[0]
    for place in range(size):
        write_over(y[place], states[members[place]])
    unit = scales.speed / scales.rate
    count_rows(engine, members, t, buffer)
    rates_at(engine, members, modes, motions, t, y, BEGIN, scales, buffer)
    watch(buffer, modes, scales, False)
    still_there = _is_touched_at_rest(engine, members, contacts.shape[0], motions)
    h, start, passed, count = _FIRST * unit, t, 0.0, 0
    how, which = TIME_UP, -1
    c, kind = first_negative(buffer, 0, contacts.shape[0])
    if c >= 0:
        return PARTS + kind, c, t, 0
    while t < t_end:
        patience(1)
        if count == pieces.shape[1]:
            how = FULL
            break
        count_rows(engine, members, t, buffer)
        target = _next_row(engine, members, motions, t, t_end, buffer)
        h = min(h, longest_step(engine, members, motions, buffer))
        landed = 1.1 * h >= target - t
        length = target - t if landed else h
        error = _advance(engine, members, modes, motions, t, length, scales, buffer)
        grows = times_as_long(error, scales.tol, 0.2, 0.1)
        if not error <= scales.tol:
            h = length * grows
            if h < _SHORTEST * unit:
                how = NOT_FINITE
                break
            continue
        opens = _opens_midway(
            engine, members, contacts.shape[0], pieces, count, start + passed, length, scales.tol,
            buffer,
        )  # fmt: skip
        shorter = 5.0 if opens <= 1e-6 else 0.9 * opens ** (-1.0 / 6.0)
        if opens > 1.0 and length * shorter > _BRIEF * unit:
            h = length * shorter
            continue
        h = length * min(shorter, grows)
        how, which, length, is_short = _first_change(
            engine, members, modes, motions, contacts.shape[0], t, length, still_there, scales,
            buffer,
        )  # fmt: skip
        if how == UNSOLVED:
            break
        add_work(length, start + passed, work_rows[count], buffer)
        for place in range(size):
            write_piece(pieces[place, count], start + passed, length, place, buffer)
        how, which, begun = _slips(engine, members, motions, t, length, how, which, scales, buffer)
        count += 1
        passed += length
        t = target if landed and not is_short else start + passed
        _go_on_from(size, contacts.shape[0], buffer)
        if begun:
            rates_at(engine, members, modes, motions, t, y, BEGIN, scales, buffer)
        if how != TIME_UP:
            break
    for place in range(size):
        write_over(states[members[place]], y[place])
    return how, which, t, count

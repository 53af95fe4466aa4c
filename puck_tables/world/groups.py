"""Discs that push each other: who they are, and the ways on which they go until that changes.

The engine says when contacts press; here those that do become groups, each is followed
(:mod:`puck_tables.world.pushing`), and its ways become the segments of its discs.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.errors import PuckError
from puck_tables.scene.friction import SPIN, VX, VY, X, Y
from puck_tables.scene.ingredients import FREE
from puck_tables.world.contact_row import ACTS, NX, NY
from puck_tables.world.engine_state import (
    CONTACT,
    LOST,
    N_CONTACTS,
    N_EVENTS,
    N_GROUPS,
    N_HELD,
    N_HISTORY,
    N_PIECES,
    N_WORKS,
    TOGETHER,
    Engine,
    Whole,
)
from puck_tables.world.floor_under import moves_along
from puck_tables.world.group import (
    APART,
    HELD,
    LEVEL,
    PARTS,
    RESTS,
    RIM_GIVES,
    RIM_STOPS,
    RUNS_OFF,
    STICKS,
    UNSOLVED,
    Group,
    Scales,
    buffer_for,
)
from puck_tables.world.layout import (
    HOLD,
    HOLD_VX,
    HOLD_VY,
    LIGHTNESS,
    PULL_X,
    PULL_Y,
    RADIUS,
    REGION,
    TURNABILITY,
    TWIST,
)
from puck_tables.world.paths import DURATION, FIRST, FOR_EVER, PIECE_COLUMNS
from puck_tables.world.paths import START as BEGINS
from puck_tables.world.pressing import press
from puck_tables.world.pushing import follow
from puck_tables.world.segment import (
    ANGLE,
    FIRST_PIECE,
    PATH,
    PLACE_X,
    PLACE_Y,
)  # fmt: skip
from puck_tables.world.segment_starts import (
    CONCERNED,
    NOT_CONCERNED,
    SENT,
    Room,
    fly_along,
    keep_segment,
    note,
    stay,
)  # fmt: skip
from puck_tables.world.step_ledger import (
    BACK_X,
    BACK_Y,
    DONE,
    LED_BY,
    LEDGER,
    NO_SEGMENT,
    NONE,
    RIM_HEAT,
    SEGMENT,
    SEVERAL,
    WORK_COLUMNS,
)
from puck_tables.world.step_ledger import START as WORK_START

ROWS = 400  # steps of a group before its segments end for a new look
FINEST = 1e-13  # error of a step in units of the scales: finer is rounding
_TRIES = 100  # contacts given up at one moment, at most: more is no motion
LOST_SHARE = 1e-15  # of the energy of free pucks: less lost as rims grip is rounding


def push_on(engine: Engine, room: Room) -> Engine:
    """Send the groups that push now on their way; marks say who is left to fly alone."""
    contacts = room.contacts[: engine.counts[N_CONTACTS]]
    contacts = contacts[room.rows[: len(contacts), ACTS] > 0.0]
    held = engine.held[: engine.counts[N_HELD]]
    held = held[engine.group[held[:, 0]] > 0]  # others have flown alone since
    held_before = {frozenset(pair) for pair in held.tolist()}
    for i in np.flatnonzero(room.marks == CONCERNED):
        engine.group[i] = 0
    held = held[engine.group[held[:, 0]] > 0]
    t, scales = float(engine.clock[0]), _scales_of(engine)
    films, reels = _driven_now(engine, t)
    shared = Group(
        engine.discs, engine.obstacles, engine.regions, engine.surface, engine.rims, films, reels,
        engine.forcing, engine.spans,
    )  # fmt: skip
    for part in _components(contacts, len(engine.discs)):
        members = np.unique(part[part >= 0])
        before = room.states.copy()
        kept, t_end, ways, jump, work_rows = _follow(shared, members, part, room.states, t, scales)
        _note_contacts(engine, t, part, kept, held_before, float(jump[RIM_HEAT]), before, room)
        led = _led_by(engine, members)
        if jump[RIM_HEAT] != 0.0 and led >= 0 and (part >= 0).all():  # no cushion shares it
            jump[[BACK_X, BACK_Y]] = _momentum(engine, members, before - room.states)
        jump[RIM_HEAT] = 0.0  # the event has it
        for i in members:  # a rim that gripped at once has changed what touches it, too
            if room.marks[i] == NOT_CONCERNED and (room.states[i] != before[i]).any():
                room.marks[i] = CONCERNED
        if not len(kept):
            engine = _book(engine, NO_SEGMENT, t, jump, work_rows, led)
            continue
        engine.counts[N_GROUPS] += 1
        held = np.vstack([held, kept])
        segment = NO_SEGMENT
        for place, i in enumerate(members):
            engine.group[i] = engine.counts[N_GROUPS]
            if engine.drives[i, 0] < engine.drives[i, 1]:
                continue  # it stays on its own way
            room.marks[i] = SENT
            if t_end == math.inf:
                stay(engine, int(i), t, room)
            else:
                engine = _set_out(engine, int(i), t, t_end, ways[place])
            segment = int(engine.counts[N_HISTORY]) - 1
        engine = _book(engine, segment, t, jump, work_rows, led)
    engine.held[: len(held)], engine.counts[N_HELD] = held, len(held)
    return engine


def _scales_of(engine: Engine) -> Scales:
    speed, rate, tol = engine.scale[:3].tolist()
    return Scales(speed, rate, max(tol, FINEST))


def _driven_now(engine: Engine, t: float) -> tuple[FloatArray, Whole]:
    """The piece on which each driven disc is now, or at whose end it stays; their rows."""
    films, reels = np.zeros((0, PIECE_COLUMNS)), np.zeros_like(engine.drives)
    for i in np.flatnonzero(engine.drives[:, 0] < engine.drives[:, 1]):
        if engine.kinds[i] == PATH:
            row = engine.pieces[int(engine.segments[i, FIRST_PIECE])]
        else:
            row = np.zeros(PIECE_COLUMNS)
            row[BEGINS], row[DURATION] = t, FOR_EVER
            row[FIRST : FIRST + 3] = engine.segments[i, [PLACE_X, PLACE_Y, ANGLE]]
            row[FIRST + 9 : FIRST + 12] = row[FIRST : FIRST + 3]
        reels[i] = len(films), len(films) + 1
        films = np.vstack([films, row])
    return films, reels


def _note_contacts(
    engine: Engine, t: float, part: Whole, kept: Whole, held_before: set[frozenset[int]],
    lost: float, before: FloatArray, room: Room,
) -> None:  # fmt: skip
    """Write down the contacts that are new, and what was lost where rims gripped at once."""
    free = engine.discs[:, LIGHTNESS] > 0.0
    fresh = [pair for pair in kept.tolist() if frozenset(pair) not in held_before]
    if not fresh and abs(lost) > LOST_SHARE * float(_energies(engine, before[free], free).sum()):
        fresh = part[:1].tolist()
    for i, j in fresh:
        row = room.rows[room.contacts[: engine.counts[N_CONTACTS]].tolist().index([i, j])]
        x, y = room.states[i, X : Y + 1] + engine.discs[i, RADIUS] * row[[NX, NY]]
        note(engine, t, CONTACT, i, j, float(x), float(y))
        engine.events[engine.counts[N_EVENTS] - 1, LOST] = lost
        lost = 0.0


def _energies(engine: Engine, states: FloatArray, free: npt.NDArray[np.bool_]) -> FloatArray:
    """Kinetic energies of discs that can move, J."""
    squares = states[:, VX] ** 2 + states[:, VY] ** 2
    discs = engine.discs[free]
    energies: FloatArray = 0.5 * (
        squares / discs[:, LIGHTNESS] + states[:, SPIN] ** 2 / discs[:, TURNABILITY]
    )
    return energies


def _components(contacts: Whole, discs: int) -> list[Whole]:
    """Contacts that hang together."""
    root = np.arange(discs)

    def find(i: int) -> int:
        while root[i] != i:
            i = int(root[i])
        return i

    for i, j in contacts:
        if j >= 0:
            a, b = find(int(i)), find(int(j))
            root[max(a, b)] = min(a, b)
    roots = np.array([find(int(i)) for i in contacts[:, 0]], np.int64)
    return [contacts[roots == one] for one in np.unique(roots)]


def _follow(
    shared: Group, members: Whole, contacts: Whole, states: FloatArray, t: float, scales: Scales
) -> tuple[Whole, float, FloatArray, FloatArray, FloatArray]:
    """The contacts of a group that press, until when it is known, and pieces (m, rows, 21).

    And the ledger (8,) of what jumped at once, and the works (rows, 37) of the way.

    No contacts where none presses; where all rest until they are hit, for ever and no pieces.
    """
    discs, surface = shared.discs[members], shared.surface
    pulled = discs[:, [PULL_X, PULL_Y, TWIST]].any(axis=1)
    spans = [span for span in shared.spans[members] if span[0] < span[1]]
    rows = [shared.forcing[slice(*span), 0] for span in spans]
    kinks = rows if surface.changes != 0.0 else map(_jumps_in, rows)
    jumps = [row for times in kinks for row in times if row > t]
    # what is pulled or carried may go on for ever, and gets faster than bounds should be
    driven = pulled.any() or any(surface[:2]) or surface.spin != 0.0
    driven = driven or bool(jumps) or discs[:, [HOLD_VX, HOLD_VY]].any()
    ends = [shared.films[first, DURATION] for first, last in shared.reels[members] if first < last]
    driven = driven or any(duration >= FOR_EVER for duration in ends)  # by hand, until it turns
    horizon = t + 2.0 * scales.speed / scales.rate if driven else math.inf
    horizon = min([horizon, *jumps])
    swings = surface.spin != 0.0 and (pulled.any() or bool(jumps))
    swings = swings or (surface.changes != 0.0 and bool(jumps))
    # what holds those who lie astride changes as they are carried on
    over = shared.regions.astride[discs[:, REGION].astype(np.int64)].any()
    swings = swings or bool(over and moves_along(surface))
    for first, last in shared.reels[members]:
        if first < last:  # what drives may turn where its piece ends
            horizon = min(horizon, float(shared.films[first, [BEGINS, DURATION]].sum()))
    nothing = np.zeros((len(members), 0, PIECE_COLUMNS))
    jump, idle = np.zeros(LEDGER), np.zeros((0, WORK_COLUMNS))
    modes = np.full(len(contacts), STICKS)
    for _ in range(_TRIES):
        buffer = buffer_for(len(members), len(contacts), int((discs[:, HOLD] != FREE).sum()))
        motions = np.zeros(len(members), np.int64)
        how = press(shared, members, contacts, states, t, scales, modes, motions, jump, buffer)
        if how == UNSOLVED:
            break
        contacts, modes = contacts[modes != APART], modes[modes != APART]
        if not len(contacts):
            return contacts, t, nothing, jump, idle
        if (motions == HELD).all() and not (jumps or swings):
            return contacts, math.inf, nothing, jump, idle
        pieces = np.zeros((len(members), ROWS, PIECE_COLUMNS))
        work_rows = np.zeros((ROWS, WORK_COLUMNS))
        moved = states.copy()
        how, which, t_end, count = follow(
            shared, members, contacts, moved, t, horizon, scales, modes, motions, pieces, work_rows,
            buffer,
        )  # fmt: skip
        if t_end > t and count > 0:
            return contacts, t_end, pieces[:, :count], jump, work_rows[:count]
        if how not in (PARTS, RIM_STOPS, RIM_GIVES, RUNS_OFF, RESTS):
            break
        states[members] = moved[members]  # sooner than a time is rounded to
        modes = np.full(len(contacts), STICKS)
        if how == RIM_GIVES:
            modes[which] = -1 if buffer.pushes[which, 1] < 0.0 else 1
        elif how in (PARTS, RUNS_OFF):
            parts = buffer.watched[0, : len(contacts), 0] < LEVEL * scales.rate  # all that do
            parts[which] = True
            contacts, modes = contacts[~parts], modes[~parts]
        if not len(contacts):
            return contacts, t, nothing, jump, idle
    raise PuckError(TOGETHER.format(time=t))


def _jumps_in(times: FloatArray) -> list[float]:
    """When rows over time may jump: at the first, the last and where a time stands twice."""
    return [times[0], times[-1], *times[1:][np.diff(times) == 0.0]]


def _with_rows(engine: Engine, name: str, count: int, rows: FloatArray) -> Engine:
    """With rows at the end of its pieces or works, of which so many are counted there."""
    first, there = int(engine.counts[count]), getattr(engine, name)
    if first + len(rows) > len(there):
        more: dict[str, Any] = {name: np.zeros((2 * (first + len(rows)), rows.shape[1]))}
        more[name][:first], there = there[:first], more[name]
        engine = engine._replace(**more)
    there[first : first + len(rows)] = rows
    engine.counts[count] = first + len(rows)
    return engine


def _led_by(engine: Engine, members: Whole) -> int:
    """Which of them is driven."""
    driven = members[engine.discs[members, LIGHTNESS] == 0.0]
    if len(driven) > 1:
        return SEVERAL
    return int(driven[0]) if len(driven) else NONE


def _momentum(engine: Engine, members: Whole, states: FloatArray) -> FloatArray:
    """The momentum of those of them that can move, N s."""
    free = members[engine.discs[members, LIGHTNESS] > 0.0]
    total: FloatArray = (states[free, VX : VY + 1] / engine.discs[free, LIGHTNESS, None]).sum(
        axis=0
    )
    return total


def _book(
    engine: Engine, segment: int, t: float, jump: FloatArray, work_rows: FloatArray, led: int
) -> Engine:
    """Keep what was worked on a segment from t on, and at its start, perhaps led by a disc."""
    if jump.any():
        row = np.zeros((1, WORK_COLUMNS))
        row[0, WORK_START], row[0, DONE : DONE + LEDGER] = t, jump
        work_rows = np.vstack([row, work_rows])
    work_rows[:, SEGMENT], work_rows[:, LED_BY] = segment, led
    return _with_rows(engine, "work_rows", N_WORKS, work_rows)


def _set_out(engine: Engine, i: int, t: float, t_end: float, rows: FloatArray) -> Engine:
    """The segment of a disc along rows of a way, which are kept."""
    engine = _with_rows(engine, "pieces", N_PIECES, rows)
    last = int(engine.counts[N_PIECES])
    fly_along(engine.segments[i], engine.pieces, last - len(rows), last, t, t_end)
    engine.kinds[i] = PATH
    keep_segment(engine, i)
    return engine

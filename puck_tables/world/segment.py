"""Where a disc is between two events: its segment, known as a whole from its start.

A segment is a row: what :mod:`puck_tables.stopping.similarity_lookup` knows of a launch, when and
where it starts, until when it holds, and two bounds, of its speed and of its acceleration.  Of its
kinds

- STILL is at rest, GONE has left play;
- LOOKED_UP is the motion of a plain puck, looked up;
- DAMPED has drag alone, v′ = −γ v − w |v| v and the spin alike, so that with E = (1 − e^{−γs})/γ

      v = v₀ e^{−γs}/(1 + w v₀ E),   path = ln(1 + w v₀ E)/w;

- PATH is a path in pieces (:mod:`puck_tables.world.paths`): integrated, or given;
- RIDING rests on a turntable, and goes round with it.

On a belt the first three are motions over the belt, and drift with it.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, inner
from puck_tables.motion.state import HEADING, ORIENTATION, PUCK_X, PUCK_Y, SPEED
from puck_tables.motion.state import SPIN as PUCK_SPIN
from puck_tables.scene.forces import damped, farthest, per_speed
from puck_tables.scene.friction import SPIN, THETA, VX, VY, X, Y
from puck_tables.scene.ingredients import Surface, floor_velocity
from puck_tables.stopping.similarity_lookup import (
    LAUNCH_COLUMNS,
    LAUNCH_ROWS,
    LENGTH,
    STOP_X,
    STOP_Y,
    TIME,
    look_up_launch,
    look_up_state,
)
from puck_tables.world.layout import DECEL, DELTA, DRAG, RADIUS, feels_floor, write_over
from puck_tables.world.paths import on_piece, piece_at

STILL, LOOKED_UP, DAMPED, PATH, GONE, RIDING = range(6)

KNOWN = LAUNCH_COLUMNS  # before it the launch: vx, vy, ω, δ, J, r
START = LAUNCH_COLUMNS + LAUNCH_ROWS  # s, when; behind what is known of the launch
PLACE_X, PLACE_Y, ANGLE, UNTIL, FASTEST, STRONGEST = range(START + 1, START + 7)
FIRST_PIECE, LAST_PIECE = START + 7, START + 8  # of its path, of all pieces of the engine
OFF_X, OFF_Y, OFF_ANGLE = range(START + 9, START + 12)  # what the look-up says just after the start
RIDES = OFF_X  # of a path: 1 where the floor carries a disc all along
DRIFT_X, DRIFT_Y = START + 12, START + 13  # velocity of the belt on which it moves or rests
SEGMENT_COLUMNS = START + 14  # all

ROOM = 9  # numbers to work in: a piece of a path
_SOON = 1e-16  # of the time until rest


class Lookups(NamedTuple):
    """The tables of stops of plain pucks, as the kernels read them."""

    stops: FloatArray
    functions: FloatArray
    states: FloatArray
    constants: FloatArray


@inlined
def _damped_state(segment: FloatArray, disc: FloatArray, time: float, out: FloatArray) -> None:
    vx, vy, spin = segment[0], segment[1], segment[2]
    left, length, turns, angle = damped(disc[DRAG:], math.hypot(vx, vy), spin, time)
    out[X], out[Y] = segment[PLACE_X] + vx * length, segment[PLACE_Y] + vy * length
    out[THETA] = segment[ANGLE] + spin * angle
    out[VX], out[VY] = vx * left, vy * left
    out[SPIN] = spin * turns


@inlined
def drifts(segment: FloatArray) -> bool:
    """Whether a disc is on a belt."""
    return segment[DRIFT_X] != 0.0 or segment[DRIFT_Y] != 0.0


@inlined
def moves_until(kind: int, segment: FloatArray) -> float:
    """When a disc comes to rest, or what is known of it ends."""
    if drifts(segment):
        return math.inf
    if kind in (LOOKED_UP, PATH):
        return segment[UNTIL]
    return math.inf if kind in (DAMPED, RIDING) else -math.inf


@inner
def state_at(
    kind: int, segment: FloatArray, disc: FloatArray, lookups: Lookups, pieces: FloatArray,
    t: float, room: FloatArray, out: FloatArray,
) -> None:  # fmt: skip
    """X, y, angle, vx, vy, spin at the time t into ``out`` (6,)."""
    if kind == LOOKED_UP:
        looked_up = room
        look_up_state(segment, t - segment[START], lookups.states, looked_up)
        later = 1.0 if t > segment[START] else 0.0
        out[X] = segment[PLACE_X] + (looked_up[PUCK_X] - later * segment[OFF_X])
        out[Y] = segment[PLACE_Y] + (looked_up[PUCK_Y] - later * segment[OFF_Y])
        out[THETA] = segment[ANGLE] + (looked_up[ORIENTATION] - later * segment[OFF_ANGLE])
        speed = looked_up[SPEED]
        out[VX], out[VY], out[SPIN] = 0.0, 0.0, looked_up[PUCK_SPIN]
        if speed > 0.0:
            start = math.hypot(segment[0], segment[1])
            cosine, sine = math.cos(looked_up[HEADING]), math.sin(looked_up[HEADING])
            east, north = segment[0] / start, segment[1] / start
            out[VX] = speed * (cosine * east - sine * north)
            out[VY] = speed * (sine * east + cosine * north)
    elif kind == DAMPED:
        _damped_state(segment, disc, t - segment[START], out)
    elif kind == PATH:
        piece = piece_at(pieces, int(segment[FIRST_PIECE]), int(segment[LAST_PIECE]), t)
        on_piece(pieces[piece], t, room)
        write_over(out, room[:6])
    elif kind == RIDING:
        turning = segment[2]
        angle = turning * (t - segment[START])
        cosine, sine = math.cos(angle), math.sin(angle)
        dx, dy = segment[PLACE_X] - segment[0], segment[PLACE_Y] - segment[1]
        arm_x, arm_y = cosine * dx - sine * dy, sine * dx + cosine * dy
        out[X], out[Y], out[THETA] = segment[0] + arm_x, segment[1] + arm_y, segment[ANGLE] + angle
        out[VX], out[VY], out[SPIN] = -turning * arm_y, turning * arm_x, turning
    else:
        out[X], out[Y], out[THETA] = segment[PLACE_X], segment[PLACE_Y], segment[ANGLE]
        out[VX], out[VY], out[SPIN] = 0.0, 0.0, 0.0
    if drifts(segment):
        out[X] += segment[DRIFT_X] * (t - segment[START])
        out[Y] += segment[DRIFT_Y] * (t - segment[START])
        out[VX] += segment[DRIFT_X]
        out[VY] += segment[DRIFT_Y]


@inner
def start_segment(
    state: FloatArray, disc: FloatArray, surface: Surface, lookups: Lookups, t: float,
    room: FloatArray, segment: FloatArray,
) -> int:  # fmt: skip
    """The segment of a disc alone, from its state at t; its kind.  Of pieces it knows nothing.

    On a turntable it rests there, or has neither friction nor drag.
    """
    sx, sy, turning = 0.0, 0.0, 0.0
    if feels_floor(disc):
        sx, sy, turning = floor_velocity(surface, state[X], state[Y])
    vx, vy, spin = state[VX] - sx, state[VY] - sy, state[SPIN] - turning
    speed = math.hypot(vx, vy)
    segment[0], segment[1], segment[2] = vx, vy, spin
    segment[3], segment[4], segment[5] = disc[DELTA], disc[DECEL], disc[RADIUS]
    segment[START], segment[PLACE_X], segment[PLACE_Y] = t, state[X], state[Y]
    segment[ANGLE], segment[UNTIL] = state[THETA], math.inf
    segment[FASTEST], segment[STRONGEST] = 0.0, 0.0
    segment[FIRST_PIECE], segment[LAST_PIECE] = 0.0, 0.0
    segment[OFF_X], segment[OFF_Y], segment[OFF_ANGLE] = 0.0, 0.0, 0.0
    segment[DRIFT_X], segment[DRIFT_Y] = 0.0, 0.0
    if turning != 0.0:
        segment[0], segment[1], segment[2] = (
            state[X] - sy / turning, state[Y] + sx / turning, turning,
        )  # fmt: skip
        segment[FASTEST] = math.hypot(sx, sy)
        segment[STRONGEST] = abs(turning) * segment[FASTEST]
        return RIDING
    segment[DRIFT_X], segment[DRIFT_Y] = sx, sy
    segment[FASTEST] = speed + math.hypot(sx, sy)
    if speed == 0.0 and spin == 0.0:
        return STILL
    if disc[DECEL] > 0.0:
        look_up_launch(
            segment, lookups.stops, lookups.functions, lookups.constants, segment[KNOWN:]
        )
        segment[UNTIL] = t + segment[KNOWN + TIME]
        # places that are looked up are off by some 1e-12 of Q²/J: discs that touch must not jump
        looked_up = room
        look_up_state(segment, _SOON * segment[KNOWN + TIME], lookups.states, looked_up)
        segment[OFF_X], segment[OFF_Y] = looked_up[PUCK_X], looked_up[PUCK_Y]
        segment[OFF_ANGLE] = looked_up[ORIENTATION]
        segment[STRONGEST] = disc[DECEL]
        return LOOKED_UP
    segment[STRONGEST] = speed * per_speed(disc[DRAG:], speed)
    return DAMPED


@inlined
def corridor(
    kind: int, segment: FloatArray, disc: FloatArray, state: FloatArray, horizon: float, now: float
) -> tuple[float, float, float, float, float]:
    """Where the centre will be at most, from now until the horizon: a chord, and a margin about it.

    A path of the length L over a chord of the length C lies in the ellipse about its ends, at most
    (L − C)/2 beyond them and ½√(L² − C²) beside.  Of a motion that is looked up, and of a disc at
    rest, the state is not asked.
    """
    x, y = segment[PLACE_X], segment[PLACE_Y]
    if drifts(segment):
        return x, y, x, y, segment[FASTEST] * (horizon - segment[START])
    if kind == RIDING:
        return segment[0], segment[1], segment[0], segment[1], segment[FASTEST] / abs(segment[2])
    if kind == LOOKED_UP:
        across, up = segment[KNOWN + STOP_X], segment[KNOWN + STOP_Y]
        length, over = segment[KNOWN + LENGTH], math.hypot(across, up)
        slack = max(length - over, 0.0) + 1e-9 * length  # what the table may be wrong by
        return x, y, x + across, y + up, 0.5 * slack + 0.5 * math.sqrt(slack * (length + over))
    if kind in (DAMPED, PATH):
        x, y = state[X], state[Y]
    if kind == DAMPED:
        reach = min(horizon - now, farthest(disc[DRAG:], 1.0))
        if reach == math.inf:
            return x, y, x, y, math.inf
        return x, y, x + reach * state[VX], y + reach * state[VY], 0.0
    if kind == PATH:
        return x, y, x, y, segment[FASTEST] * (min(horizon, segment[UNTIL]) - now)
    return x, y, x, y, 0.0

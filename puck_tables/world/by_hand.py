"""What a hand does to discs: how far what is led may go, and forces that are added."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray, finite_array, real
from puck_tables.errors import InputError
from puck_tables.kernels.compile import inlined, kernel
from puck_tables.scene.friction import SPIN, THETA, VX, VY, X, Y
from puck_tables.scene.over_time import FORCED, with_angles
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.world.engine_state import N_PIECES, Engine, Whole
from puck_tables.world.floor_under import step_onto
from puck_tables.world.floors import INTEGRATED, regions_of
from puck_tables.world.holds import forbid
from puck_tables.world.layout import (
    ARC,
    CORNER,
    END_X,
    END_Y,
    FROM,
    KIND,
    POST,
    RADIUS,
    SIDE,
    SPAN,
    START_X,
    START_Y,
    WALL,
    A,
    B,
    C,
    in_span,
)
from puck_tables.world.lone import LONGEST
from puck_tables.world.named_pucks import pucks_of
from puck_tables.world.paths import fill_straight, on_piece
from puck_tables.world.segment import ANGLE, FIRST_PIECE, PATH, PLACE_X

SHORT_OF = 1e-9  # of its radius: so far from cushions stops what is led, and never presses them
_OFF = 1e-9  # of its radius: farther off its constraint a puck cannot be put


def led_state(engine: Engine, i: int) -> FloatArray:
    """The state (6,) of a disc that is driven, now."""
    segment = engine.segments[i]
    if engine.kinds[i] != PATH:
        return np.array([*segment[PLACE_X : ANGLE + 1].tolist(), 0.0, 0.0, 0.0])
    piece: Any = engine.pieces[int(segment[FIRST_PIECE])].tolist()  # lists are faster, from Python
    state: Any = [0.0] * 9
    on_piece(piece, float(engine.clock[0]), state)
    return np.array(state[:6])


def with_room_to_lead(engine: Engine) -> Engine:
    """With room for one piece more."""
    count = int(engine.counts[N_PIECES])
    if count < len(engine.pieces):
        return engine
    more = np.zeros((max(LONGEST, count), engine.pieces.shape[1]))
    return engine._replace(pieces=np.vstack([engine.pieces, more]))


@inlined
def lead(engine: Engine, i: int, state: FloatArray, duration: float) -> None:
    """A disc is to go straight on from a state for so long, or until it is at a cushion."""
    count = engine.counts[N_PIECES]
    go_straight(
        engine.obstacles, engine.discs[i, RADIUS], engine.clock[0], duration, state,
        engine.pieces[count],
    )  # fmt: skip
    engine.drives[i, 0], engine.drives[i, 1] = count, count + 1
    engine.counts[N_PIECES] = count + 1


@kernel
def go_straight(
    obstacles: FloatArray, radius: float, start: float, duration: float, state: FloatArray,
    piece: FloatArray,
) -> None:  # fmt: skip
    """The piece from a state for so long, or until one of that radius is at what stands."""
    moves = state[VX] != 0.0 or state[VY] != 0.0 or state[SPIN] != 0.0
    longest = min(duration, _free_for(obstacles, radius, state)) if moves else 0.0
    fill_straight(start, longest, state, piece)


@inlined
def _free_for(obstacles: FloatArray, radius: float, state: FloatArray) -> float:
    """How long one of that radius can go straight on before it is at what stands, s."""
    x, y, vx, vy = state[X], state[Y], state[VX], state[VY]
    radius *= 1.0 + SHORT_OF
    longest, speed2 = math.inf, vx * vx + vy * vy
    for k in range(obstacles.shape[0]):
        row = obstacles[k]
        if row[KIND] == WALL:
            closes = -(row[A] * vx + row[B] * vy)
            if closes > 0.0:
                gap = row[A] * x + row[B] * y - row[C] - radius
                longest = min(longest, max(gap, 0.0) / closes)
        elif row[KIND] == SIDE:
            away = row[A] * x + row[B] * y - row[C]
            closes = -math.copysign(row[A] * vx + row[B] * vy, away * (row[A] * vx + row[B] * vy))
            if closes > 0.0:
                out = max(abs(away) - radius, 0.0) / closes
                px, py = x + out * vx, y + out * vy
                before = (px - row[START_X]) * row[B] - (py - row[START_Y]) * row[A]
                after = (px - row[END_X]) * row[B] - (py - row[END_Y]) * row[A]
                if before >= 0.0 >= after:
                    longest = min(longest, out)
        elif row[KIND] in (POST, CORNER, ARC):
            dx, dy = x - row[A], y - row[B]
            along = dx * vx + dy * vy
            reach = row[C] + (-radius if row[KIND] == ARC else radius)
            rest = dx * dx + dy * dy - reach * reach
            root = along * along - speed2 * rest
            if row[KIND] != ARC and along < 0.0 < root:
                longest = min(longest, max(rest, 0.0) / (math.sqrt(root) - along))
            elif row[KIND] == ARC and speed2 > 0.0 and math.hypot(dx, dy) < row[C]:
                out = max((math.sqrt(max(root, 0.0)) - along) / speed2, 0.0)
                angle = math.atan2(dy + out * vy, dx + out * vx)
                if row[SPAN] >= 2.0 * math.pi or in_span(angle, row[FROM], row[SPAN]):
                    longest = min(longest, out)
    return longest


def refuse_off_hold(engine: Engine, i: int, state: FloatArray, name: str) -> None:
    """Refuse a place where the constraint of a puck does not let it be."""
    rows, off = np.zeros((2, 3)), np.zeros((2, 3))
    forbid(engine.discs[i], engine.surface, float(engine.clock[0]), state, rows, off)
    away = float(np.abs(off[:, 0]).max())
    if away > _OFF * engine.discs[i, RADIUS]:
        raise InputError(
            f"{name} would be {away:.3g} m off the rail or pivot that leads it: put it on that"
        )


def with_force(
    engine: Engine, scene: SceneSpec, order: Whole, i: int, force: FloatArray, until: float
) -> Engine:
    """With a force (Fx, Fy, torque) on a disc from now to then, N and N m, beside all others."""
    begin = float(engine.clock[0])
    mine = engine.forcing[slice(*engine.spans[i])]
    times = np.unique(np.concatenate([mine[:, 0], [begin, until]])).tolist()
    rows: list[FloatArray] = []
    for start, end in pairwise(times):
        for row in (_just(mine, start, True), _just(mine, end, False)):
            if begin <= start and end <= until:
                row[1:FORCED] += force
            if not rows or (row != rows[-1]).any():
                rows.append(row)
    parts = [engine.forcing[slice(*span)] for span in engine.spans]
    parts[i] = with_angles(np.array(rows))
    ends = np.cumsum([0, *map(len, parts)])
    spans = np.stack([ends[:-1], ends[1:]], axis=1)
    engine = engine._replace(forcing=np.vstack(parts), spans=spans)
    return with_integrated(engine, scene, order, np.array([i]))


def _just(rows: FloatArray, t: float, after: bool) -> FloatArray:
    """The row just after, or just before, a time: beyond all rows no force, the rest as there."""
    j = int((rows[:, 0] <= t).sum() if after else (rows[:, 0] < t).sum())
    row = np.zeros(rows.shape[1])
    if 0 < j < len(rows):
        one, two = rows[j - 1], rows[j]
        row = one + (t - one[0]) / (two[0] - one[0]) * (two - one)
    elif len(rows):
        row[FORCED:] = rows[max(j - 1, 0), FORCED:]
    row[0] = t
    return row


def with_integrated(engine: Engine, scene: SceneSpec, order: Whole, discs: Whole) -> Engine:
    """With motions of discs that are integrated from now on, wherever they are."""
    count = len(engine.discs)
    floors = engine.floors.copy()
    how = floors.reshape(-1, count, floors.shape[1])[:, :, 2]
    how[:, discs] = np.maximum(how[:, discs], INTEGRATED)
    regions = engine.regions
    if not engine.floors[:, 2].any():  # its friction is asked for often from now on
        pucks = [pucks_of(scene)[number] for number in order]
        regions = regions_of(scene, pucks, floors, 0.0)
    engine = engine._replace(floors=floors, regions=regions)
    for i in discs.tolist():
        step_onto(engine, i)
    return engine


def slips_of(discs: FloatArray, states: FloatArray) -> FloatArray:
    """How fast rims slip on a floor at rest, m/s."""
    speeds: FloatArray = np.hypot(states[..., VX], states[..., VY])
    return np.hypot(speeds, discs[..., RADIUS] * states[..., SPIN])


def row_of(
    position: npt.ArrayLike | None, angle: float | None, velocity: npt.ArrayLike | None,
    spin: float | None,
) -> FloatArray:  # fmt: skip
    """A state (6,) of what is given; NaN of the rest."""
    row = np.full(6, math.nan)
    if position is not None:
        row[X : Y + 1] = two_of("position", position, "m")
    if angle is not None:
        row[THETA] = real("angle", angle, "rad")
    if velocity is not None:
        row[VX : VY + 1] = two_of("velocity", velocity, "m/s")
    if spin is not None:
        row[SPIN] = real("spin", spin, "rad/s")
    return row


def two_of(name: str, values: Any, unit: str) -> FloatArray:
    """Two numbers in a unit, array (2,)."""
    if type(values) is tuple and len(values) == 2 and type(values[0]) is type(values[1]) is float:
        pair = np.array(values)  # most are so, and quickly seen to
        if math.isfinite(values[0]) and math.isfinite(values[1]):
            return pair
    pair = finite_array(name, values, unit)
    if pair.shape != (2,):
        raise InputError(f"{name} must be two numbers in {unit}, got the shape {pair.shape}")
    return pair

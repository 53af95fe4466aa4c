"""A scene as the compiled engine reads it."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.errors import InputError
from puck_tables.scene.by_speed import load_under
from puck_tables.scene.floor_parts import belts_of
from puck_tables.scene.forces import drags_of
from puck_tables.scene.friction import SPIN, THETA, VX, VY
from puck_tables.scene.ingredients import RAIL, Surface, hold_of
from puck_tables.scene.launch_constraints import allowed_velocity
from puck_tables.scene.over_time import FLOOR_SPIN, FLOOR_X, FLOOR_Y, FORCED, motion_of, over_time
from puck_tables.scene.parts import Floor
from puck_tables.scene.pucks_and_posts import ScenePuck
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.stopping.stop_table import StopTable
from puck_tables.world import layout
from puck_tables.world.agreement import steps_for
from puck_tables.world.engine_state import (
    COUNTS,
    EVENT_COLUMNS,
    HISTORY_COLUMNS,
    LAUNCH_COLUMNS,
    N_PIECES,
    NOTHING,
    Engine,
    Whole,
    led_rows,
)
from puck_tables.world.floor_under import law_goes_to, lay_down, step_onto
from puck_tables.world.floors import (
    fastest_rim,
    floors_of,
    normal_on,
    regions_of,
    velocities_under,
)  # fmt: skip
from puck_tables.world.lone import LONGEST
from puck_tables.world.named_pucks import pucks_of, start_of
from puck_tables.world.obstacles import borders_of, number_for, obstacles_of, rims_of
from puck_tables.world.paths import FIRST, PIECE_COLUMNS, pieces_along, rows_of
from puck_tables.world.segment import (
    ANGLE,
    FIRST_PIECE,
    PLACE_X,
    PLACE_Y,
    SEGMENT_COLUMNS,
    Lookups,
)  # fmt: skip
from puck_tables.world.segment_starts import drive_on, hang_over, room_for
from puck_tables.world.step_ledger import WORK_COLUMNS

SWIFTEST = 1e100  # m/s: its square is a number
FAR = 1e12  # radii that a puck may slide: its rounding is a thousandth of a radius
ROWS = 256  # of events and segments at first
# of what steps are for, of each: one of 416 drawn scenes errs by more than all are for, with ten
# times as much seventeen (test_scene_checked)
STEP_SHARE = 1e-2


class Start(NamedTuple):
    """A scene at its start, prepared once for all its runs.

    ``order``: the numbers of the pucks in the order in which the engine has them; ``engine``: its
    arrays, nothing has taken off yet, so EVERYBODY is to look ahead; ``states`` (n, 6): then.  A
    run takes copies.
    """

    scene: SceneSpec
    order: Whole
    engine: Engine
    states: FloatArray


def order_of(scene: SceneSpec) -> Whole:
    """The numbers of the pucks in the order in which the engine has them.

    It depends on where they are, not on how they are numbered: so no bit of a result does.
    """
    places = np.array([start_of(puck) for puck in pucks_of(scene)])
    return np.lexsort((places[:, 1], places[:, 0]))


def shipped_lookups() -> Lookups:
    """The table of stops that comes along, as the engine reads it."""
    table = StopTable.shipped()
    return Lookups(
        table.thinned(), table.launch_coefficients, table.state_coefficients, table.constants
    )


def _surface_of(floor: Floor) -> Surface:
    """How a floor moves in the end, as its fastest belt, and holds."""
    belts = belts_of(floor)
    (vx, vy), spin, changes = belts[np.hypot(*belts.T).argmax()].tolist(), floor.turning, 0.0
    if floor.over_time:
        (vx, vy, spin), changes = motion_of(floor)[-1, 1:].tolist(), 1.0  # it goes on so
    return Surface(vx, vy, *floor.centre, spin, 0.0, 0.0, 0.0, changes, floor.static_ratio)


def prepared(scene: SceneSpec, order: Whole | None = None, runs: int = 1) -> Start:
    """A scene without ranges at its start; its pucks in an order, else that of their places.

    ``runs``: how many launches it is for.

    Raises PuckError if a file or a law that it names does not serve, or numbers in it are too
    large.
    """
    order = order_of(scene) if order is None else order
    pucks = [pucks_of(scene)[number] for number in order]
    count = len(pucks)
    lies = len(borders_of(scene)) + len(scene.floor.patches)
    discs, states = np.zeros((count, layout.DISC_COLUMNS + lies)), np.zeros((count, 6))
    surface = _surface_of(scene.floor)
    spans = np.zeros((count, 2), np.int64)
    forcing: list[FloatArray] = []
    drives, motions = np.zeros((count, 2), np.int64), [np.zeros((0, PIECE_COLUMNS))]
    launches = []
    rims, discs[:, layout.MAKE], makes, called = rims_of(scene, pucks)
    for i, puck in enumerate(pucks):
        driven = bool(puck.path)
        _fill_disc(scene, puck, called, discs[i])
        if not driven:
            first = sum(map(len, forcing))
            forcing.append(over_time(scene.floor, puck.force))
            spans[i] = first, first + len(forcing[-1])
        launch = puck.launch
        velocity = allowed_velocity(launch, puck.constraint, scene.floor)
        states[i, :2], states[i, 2] = start_of(puck), launch.orientation
        if driven:
            first = sum(map(len, motions))
            motions.append(pieces_along(rows_of(puck.path)))
            drives[i] = first, first + len(motions[-1])
            states[i, THETA] = motions[-1][0, FIRST + THETA]
        elif launch.time > 0.0:
            launches.append([launch.time, i, *velocity, launch.spin])
        else:
            states[i, 3:5], states[i, 5] = velocity, launch.spin
    rim = fastest_rim(pucks, states, surface)
    floors = floors_of(scene, pucks, rim)
    regions = regions_of(scene, pucks, floors, rim, runs)
    steps = 2 * LONGEST if floors[:, 2].any() else 0  # the first path, and room for another
    engine = Engine(
        discs=discs,
        regions=regions,
        floors=floors,
        surface=surface,
        forcing=np.vstack(forcing) if forcing else np.empty((0, FORCED)),
        spans=spans,
        rims=rims,
        obstacles=obstacles_of(scene, called, makes),
        lookups=shipped_lookups(),
        clock=np.zeros(1),
        kinds=np.zeros(count, np.int64),
        segments=np.zeros((count, SEGMENT_COLUMNS)),
        group=np.zeros(count, np.int64),
        held=np.zeros((6 * count + 16, 2), np.int64),
        next_time=np.full(count, math.inf),
        next_partner=np.full(count, NOTHING),
        launches=np.array(sorted(launches)).reshape(-1, LAUNCH_COLUMNS),
        pieces=np.vstack([*motions, np.zeros((steps, PIECE_COLUMNS))]),
        drives=drives,
        hangs=np.zeros((count, len(scene.edges)), np.int64),
        events=np.zeros((ROWS + (8 + len(scene.edges)) * count, EVENT_COLUMNS)),
        history=np.zeros((ROWS + 4 * count, HISTORY_COLUMNS)),
        work_rows=np.zeros((steps, WORK_COLUMNS)),
        counts=np.zeros(COUNTS, np.int64),
        scale=np.array([0.0, 0.0, STEP_SHARE * steps_for(scene), 0.0, 0.0]),
    )
    for i in range(count):
        if scene.edges:
            hang_over(engine, i, 0.0, states[i])
        lay_down(engine, i, states[i])
    engine.counts[N_PIECES] = drives.max()
    engine.segments[:, [PLACE_X, PLACE_Y, ANGLE]] = states[:, :3]
    for i in np.flatnonzero(drives[:, 0] < drives[:, 1]).tolist():
        states[i, VX:] = engine.pieces[drives[i, 0], FIRST + VX : FIRST + SPIN + 1]
        engine.segments[i, FIRST_PIECE] = drives[i, 0]
        room = room_for(count)
        room.states[i] = states[i]
        drive_on(engine, i, 0.0, room)
    set_scales(engine, states)
    return Start(scene, order, engine, states)


def _fill_disc(
    scene: SceneSpec, puck: ScenePuck, called: dict[object, float], disc: FloatArray
) -> None:
    """What a disc is, and what acts on it."""
    disc[layout.RADIUS], disc[layout.TANGENTIAL] = puck.radius, puck.tangential
    disc[layout.RESTITUTION] = number_for(puck.restitution, called)
    disc[layout.FRICTION] = puck.rim
    if puck.path:
        return
    inertia = puck.mass * puck.inertia_radius**2
    disc[layout.INV_MASS], disc[layout.INV_INERTIA] = 1.0 / puck.mass, 1.0 / inertia
    disc[layout.PULL_X : layout.TWIST + 1] = _pull_on(scene, puck, inertia)
    disc[layout.HOLD : layout.HOLD_PLACE + 1] = _hold_on(puck)
    disc[layout.DRAG : layout.LIES] = drags_of(scene.drag, scene.lateral, puck.mass, inertia)
    disc[layout.NORMAL] = normal_on(scene, puck)
    disc[layout.HEIGHT_RATIO] = 2.0 * puck.height / puck.radius
    if scene.floor.law and (load := load_under(puck)) is not None:
        disc[layout.HEIGHT_RATIO] /= 4.0 * load.mean_square  # of uniform pressure it is 1/4


def with_law_up_to(
    engine: Engine, scene: SceneSpec, order: Whole, fastest: float, runs: int = 1
) -> Engine:
    """With a friction law by name for slips of the rim up to ``fastest``, m/s.

    ``runs``: how many launches it is for.
    """
    pucks = [pucks_of(scene)[number] for number in order]
    floors = floors_of(scene, pucks, fastest)
    regions = regions_of(scene, pucks, floors, fastest, runs)
    engine = engine._replace(regions=regions, floors=floors)
    for i in range(len(pucks)):
        step_onto(engine, i)
    return engine


def set_scales(engine: Engine, states: FloatArray) -> None:
    """Scales of speed and acceleration that hold for these states, and for those before."""
    speed, rate = scales_of(engine, np.array([fastest(engine, states)]))[0]
    engine.scale[:2] = max(engine.scale[0], speed), max(engine.scale[1], rate)


def fastest(engine: Engine, states: FloatArray) -> float:
    """The largest slip of these states, of launches to come and of what is driven, m/s."""
    rims = engine.discs[:, layout.RADIUS] * np.abs(states[:, SPIN])
    driven = led_rows(engine)[:, FIRST + VX : FIRST + VY + 1]
    speeds = np.hypot(engine.launches[:, 2], engine.launches[:, 3])
    led = np.hypot(*engine.discs[:, [layout.HOLD_VX, layout.HOLD_VY]].T)
    floor = velocities_under(engine, states)
    return max(
        float(np.hypot(np.hypot(states[:, VX], states[:, VY]), rims).max()),
        float(np.hypot(*driven.T).max(initial=0.0)),
        float(speeds.max(initial=0.0)),
        float(led.max(initial=0.0)),
    ) + max(float(np.hypot(*floor[:, :2].T).max(initial=0.0)), _swiftest(engine, states))


def scales_of(engine: Engine, speeds: FloatArray) -> FloatArray:
    """Scales of speed and acceleration (n, 2) where the largest slips are ``speeds`` (n,).

    What is at rest on a steep slope has the speed that it gets within a radius; where nothing moves
    and nothing pulls or rubs, that is a radius a second.

    Raises InputError if a puck would slide so far that its places, good to a share of that, mean
    nothing here.
    """
    radius, steady = least_scales(engine)
    _refuse_far(engine, float(speeds.max(initial=0.0)), radius)
    turning = abs(engine.surface.spin)
    steady = max(steady, turning * float(speeds.max(initial=0.0)), _shaken(engine))
    speeds = np.where(speeds > 0.0, speeds, math.sqrt(steady * radius) or radius)
    return np.stack([speeds, np.where(steady > 0.0, steady, speeds**2 / radius)], axis=1)


def least_scales(engine: Engine) -> tuple[float, float]:
    """The least radius, m, and the largest acceleration by friction, slope and forces, m/s²."""
    radius = float(engine.discs[:, layout.RADIUS].min())
    return radius, max(float(engine.floors[:, 0].max()), _strongest(engine))


def _swiftest(engine: Engine, states: FloatArray) -> float:
    """The largest velocity that a floor over time ever has under these states, m/s."""
    if engine.surface.changes == 0.0:
        return 0.0
    far = np.hypot(states[:, 0] - engine.surface.cx, states[:, 1] - engine.surface.cy).max()
    rows = engine.forcing
    speeds = np.hypot(rows[:, FLOOR_X], rows[:, FLOOR_Y]) + far * np.abs(rows[:, FLOOR_SPIN])
    return float(speeds.max(initial=0.0))


def _shaken(engine: Engine) -> float:
    """The largest acceleration of a floor over time at its centre, m/s²."""
    if engine.surface.changes == 0.0:
        return 0.0
    free = int(np.argmax(np.diff(engine.spans)[:, 0]))  # what is driven has no rows
    rows = engine.forcing[slice(*engine.spans[free])]
    steps = np.diff(rows[:, 0])
    rates = np.hypot(*np.diff(rows[:, [FLOOR_X, FLOOR_Y]], axis=0)[steps > 0.0].T)
    return float((rates / steps[steps > 0.0]).max(initial=0.0))


def _refuse_far(engine: Engine, speed: float, radius: float) -> None:
    """Refuse looked-up pucks whose slide, at the largest slip, is beyond what digits can tell."""
    if not speed < SWIFTEST:
        raise InputError(
            f"a slip of {speed:.3g} m/s is too fast for floating point: use other units"
        )
    least = _weakest(engine)
    if speed > 0.0 and speed / least > FAR * radius / speed:
        raise InputError(
            f"at a slip of {speed:.3g} m/s and the least friction, {least:.3g} m/s^2, a puck would "
            f"slide some {speed / least * speed:.3g} m, and places are good to 1e-15 of that: use "
            f"speeds up to {math.sqrt(FAR * radius * least):.3g} m/s, more friction, or none at all"
        )


def _weakest(engine: Engine) -> float:
    """The least friction, m/s², of what is looked up; inf: none is."""
    decels = engine.floors[(engine.floors[:, 2] == 0.0) & (engine.floors[:, 0] > 0.0), 0]
    return float(decels.min(initial=math.inf))


def fastest_allowed(engine: Engine) -> float:
    """The largest slip, m/s, of which places still mean something, and friction is known."""
    far = math.sqrt(FAR * least_scales(engine)[0] * _weakest(engine))
    return min(SWIFTEST, far, law_goes_to(engine.regions))


def _strongest(engine: Engine) -> float:
    """The largest acceleration by slope and given forces, m/s²."""
    counts = engine.spans[:, 1] - engine.spans[:, 0]
    discs, forced = engine.discs, np.repeat(np.arange(len(counts)), counts)
    of = np.concatenate([np.arange(len(counts)), forced])  # each without its force, and with it
    forces = engine.forcing[:, :FORCED]
    rows, discs = np.vstack([np.zeros((len(counts), FORCED)), forces]), discs[of]
    light, turns = discs[:, layout.INV_MASS], discs[:, layout.INV_INERTIA]
    ax = discs[:, layout.PULL_X] + light * rows[:, 1]
    ay = discs[:, layout.PULL_Y] + light * rows[:, 2]
    rim = discs[:, layout.RADIUS] * (discs[:, layout.TWIST] + turns * rows[:, 3])
    return max(float(np.hypot(ax, ay).max()), float(np.abs(rim).max()))


def _pull_on(scene: SceneSpec, puck: ScenePuck, inertia: float) -> tuple[float, float, float]:
    """Accelerations by the slope and the constant forces, m/s², rad/s²."""
    floor, (fx, fy) = scene.floor, puck.force.constant
    pull = puck.gravity * math.sin(floor.slope)
    return (
        pull * math.cos(floor.downhill) + fx / puck.mass,
        pull * math.sin(floor.downhill) + fy / puck.mass,
        puck.force.torque / inertia,
    )


def _hold_on(puck: ScenePuck) -> tuple[float, ...]:
    """The constraint of a puck, with the place of a rail along its normal."""
    hold, (x, y) = hold_of(puck.constraint, puck.launch), puck.launch.position
    place = hold.ax * x + hold.ay * y if hold.kind == RAIL else 0.0
    return (*hold, place)

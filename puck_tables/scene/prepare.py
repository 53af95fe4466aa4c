"""A scene as the compiled loop takes it: only what it has, in one set of scales."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from puck_tables.errors import InputError
from puck_tables.executor import in_slices
from puck_tables.safe_read import read_rows
from puck_tables.scene.boundaries import Boundaries
from puck_tables.scene.bulk import follow_many
from puck_tables.scene.equations import SIZE
from puck_tables.scene.friction import SPIN, THETA, VX, VY, X, Y
from puck_tables.scene.ingredients import (
    BLADE,
    FREE,
    PIVOT,
    RAIL,
    Body,
    Drag,
    Hold,
    Model,
    Pull,
    Regions,
    Surface,
)
from puck_tables.scene.loop import Ask, follow
from puck_tables.scene.regions import regions_of
from puck_tables.scene.scene import Scene, launch_velocity

FloatArray = npt.NDArray[np.float64]

LOCAL_SHARE = 0.01  # of the error wanted, per step and in units of the scales
DEFAULT_TIME = 1000.0  # in units of the time scale, where a scene does not say
STEP_LIMIT = 1_000_000
MAX_DRIVE = 1 << 26  # bytes of a file of forces
MAX_EVENTS = 10_000


@dataclass(frozen=True)
class Prepared:
    """Arguments of the loop for a scene, and for others that are only launched otherwise."""

    model: Model
    regions: Regions
    bounds: Boundaries
    scene: Scene
    state: FloatArray
    ask: Ask

    def follow(
        self, frames: FloatArray, rows: FloatArray, events: FloatArray
    ) -> tuple[int, float, int, int, int, float]:
        """Run it, see :func:`puck_tables.scene.loop.follow`."""
        region = int(self.starts(self.state[None, :])[0])
        return follow(
            self.model, self.regions, self.bounds, self.ask, self.state.copy(), region,
            frames, rows, events,
        )  # fmt: skip

    def follow_all(self, states: FloatArray, out: FloatArray, status: npt.NDArray[np.int8]) -> None:
        """Run it from other launches (n, 10), see :func:`puck_tables.scene.bulk.follow_many`."""
        asks, starts = self.asks(states), self.starts(states)

        def work(start: int, stop: int) -> None:
            part = out[:, start:stop].copy()
            follow_many(
                self.model, self.regions, self.bounds, asks[start:stop],
                self.scene.run.time is not None, self.ask.tolerance, STEP_LIMIT, MAX_EVENTS,
                states[start:stop], starts[start:stop], part, status[start:stop],
            )  # fmt: skip
            out[:, start:stop] = part

        in_slices(work, len(states))

    def starts(self, states: FloatArray) -> npt.NDArray[np.int64]:
        """Region of the floor in which launches (n, 10) start."""
        strips = self.scene.floor.strips
        if strips is None:
            return np.zeros(len(states), np.int64)
        across = _direction(strips.direction)
        along = across[0] * states[:, X] + across[1] * states[:, Y]
        return np.searchsorted(strips.borders, along, side="right").astype(np.int64)

    def asks(self, states: FloatArray) -> FloatArray:
        """Time limit, scale of speeds and scales of the state for launches (n, 10); (n, 12)."""
        return _asks(self.scene, self.model, self.regions, states)


def prepare(scene: Scene, last_time: float | None = None) -> Prepared:
    """The loop's arguments; on a moving floor a run goes on to ``last_time``.

    Raises
    ------
    InputError
        If the height is outside the tables, the file of forces is no such file, or the scales of
        the scene are too large for floating point.
    """
    puck, floor = scene.puck, scene.floor
    inertia = puck.mass * (puck.gyration * puck.radius) ** 2
    regions = regions_of(scene)
    weight = puck.mass * floor.gravity
    pull_x = scene.force.constant[0] + weight * math.sin(floor.slope) * math.cos(floor.downhill)
    pull_y = scene.force.constant[1] + weight * math.sin(floor.slope) * math.sin(floor.downhill)
    moves = any(floor.velocity) or floor.turning != 0.0
    drag = scene.drag
    model = Model(
        body=Body(puck.mass, inertia, puck.radius),
        surface=Surface(*floor.velocity, *floor.centre, floor.turning),
        drag=Drag(drag.sliding, drag.spinning),
        pull=Pull(pull_x, pull_y, scene.force.torque),
        drive=read_drive(scene.force.file) if scene.force.file else np.empty((0, 4)),
        hold=_hold(scene),
    )
    state = np.zeros(SIZE)
    state[[X, Y]], state[THETA] = scene.launch.position, scene.launch.orientation
    state[[VX, VY]], state[SPIN] = launch_velocity(scene), scene.launch.spin
    asks = _asks(scene, model, regions, state[None, :])[0]
    until, to_the_end = scene.run.time, True
    if until is None:
        to_the_end = moves and bool(last_time)
        until = last_time if to_the_end and last_time else float(asks[0])
    tolerance = LOCAL_SHARE * scene.run.tol
    ask = Ask(until, to_the_end, tolerance, asks[2:], float(asks[1]), STEP_LIMIT)
    return Prepared(model, regions, _bounds(scene), scene, state, ask)


def _hold(scene: Scene) -> Hold:
    """The constraint, fixed to where the puck is launched."""
    hold = scene.constraint
    if hold is None:
        return Hold(FREE, *[0.0] * 6)
    if hold.kind == "rail":
        nx, ny = -math.sin(hold.angle), math.cos(hold.angle)
        return Hold(RAIL, nx, ny, 0.0, 0.0, *hold.velocity)
    if hold.kind == "blade":
        return Hold(BLADE, 0.0, 0.0, 0.0, hold.angle, hold.side_slip, 0.0)
    ex, ey = _direction(scene.launch.orientation + hold.angle)
    x, y = scene.launch.position
    return Hold(
        PIVOT, x + hold.reach * ex, y + hold.reach * ey, hold.reach, hold.angle, *hold.velocity
    )


def _bounds(scene: Scene) -> Boundaries:
    """Walls (moved in by the radius), edges and borders as lines n·x = c."""
    walls, edges, borders = [], [], []
    for wall in scene.wall:
        nx, ny, c = _line(wall.point, wall.normal)
        walls.append([
            nx, ny, c + scene.puck.radius, wall.restitution, wall.tangential,
            min(wall.friction, 1e300),
        ])  # fmt: skip
    for edge in scene.edge:
        edges.append(_line(edge.point, edge.normal))
    if scene.floor.strips is not None:
        across = _direction(scene.floor.strips.direction)
        borders = [(*across, place) for place in scene.floor.strips.borders]
    return Boundaries(
        np.array(walls).reshape(-1, 6), np.array(edges).reshape(-1, 3),
        np.array(borders).reshape(-1, 3),
    )  # fmt: skip


def _line(point: tuple[float, float], normal: tuple[float, float]) -> tuple[float, float, float]:
    size = math.hypot(*normal)
    nx, ny = normal[0] / size, normal[1] / size
    return nx, ny, nx * point[0] + ny * point[1]


def _direction(angle: float) -> tuple[float, float]:
    return math.cos(angle), math.sin(angle)


def _asks(scene: Scene, model: Model, regions: Regions, states: FloatArray) -> FloatArray:
    """Time limit, scale of speeds and scales of the state for launches (n, 10); (n, 12)."""
    with np.errstate(over="ignore", invalid="ignore"):
        speed, time = _scales(scene, model, regions, states)
        radius, length = scene.puck.radius, speed * time
        slow = max(1.0, 2.0 * scene.puck.gyration**2)  # by as much longer a spin takes to brake
        energy = scene.puck.mass * speed * speed
        until = scene.run.time
        asks: FloatArray = np.stack([
            np.full_like(speed, until) if until is not None else DEFAULT_TIME * time, speed,
            length, length, length / radius, speed, speed, speed / (slow * radius),
            energy, energy, energy, energy,
        ], axis=1)  # fmt: skip
    squares = np.all(speed > 1e-140) and np.all(speed < 1e140)  # of 1e-13 of it, too
    if not (np.all(np.isfinite(asks)) and np.all(asks > 0.0) and squares):
        raise InputError(
            "this scene is too large or too small for floating point (speeds of "
            f"{speed.max():g} m/s, times of {time.max():g} s): use other units"
        )
    return asks


def _scales(
    scene: Scene, model: Model, regions: Regions, states: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Scales of speed and time (n,) of launches, from what moves and from what slows it down."""
    puck, floor = scene.puck, scene.floor
    pull, lever = model.pull, puck.mass * puck.radius
    rate = max(
        float(regions.load.max()) / puck.mass,
        math.hypot(pull.x, pull.y) / puck.mass,
        abs(pull.torque) / lever,
        float(np.hypot(model.drive[:, 1], model.drive[:, 2]).max(initial=0.0)) / puck.mass,
        float(np.abs(model.drive[:, 3]).max(initial=0.0)) / lever,
    )
    size = puck.radius + np.hypot(states[:, X] - floor.centre[0], states[:, Y] - floor.centre[1])
    speed = np.max([
        np.hypot(states[:, VX] - floor.velocity[0], states[:, VY] - floor.velocity[1]),
        np.hypot(states[:, VX], states[:, VY]), puck.radius * np.abs(states[:, SPIN]),
        np.full(len(states), math.hypot(*floor.velocity)), abs(floor.turning) * size,
    ], axis=0)  # fmt: skip
    speed[speed == 0.0] = math.sqrt(rate * puck.radius) if rate > 0.0 else 1.0
    times = [speed / rate] if rate > 0.0 else []
    if model.drag.sliding > 0.0:
        times.append(np.full_like(speed, puck.mass / model.drag.sliding))
    if floor.turning != 0.0:
        times.append(np.full_like(speed, 1.0 / abs(floor.turning)))
    if not times:
        times = [np.full_like(speed, 1.0 if scene.run.time is None else scene.run.time)]
    return speed, np.min(times, axis=0)


def read_drive(path: str) -> FloatArray:
    """Rows (n, 4) of t, Fx, Fy and torque from a CSV file that may lack the torque.

    Raises
    ------
    InputError
        If it cannot be read, or is no such file.
    """
    try:
        rows = np.array([[float(cell) for cell in row] for row in read_rows(path, MAX_DRIVE)])
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror or error}") from None
    except ValueError:
        rows = np.empty((0, 0))
    good = rows.ndim == 2 and len(rows) >= 2 and rows.shape[1] in (3, 4)
    if not (good and np.all(np.isfinite(rows)) and np.all(np.diff(rows[:, 0]) > 0.0)):
        raise InputError(
            f"{Path(path).name}: forces are a CSV file of t, Fx, Fy and perhaps torque, in s, N "
            "and N m, two rows or more, the times ascending"
        )
    return np.pad(rows, ((0, 0), (0, 4 - rows.shape[1])))

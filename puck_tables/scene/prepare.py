"""A scene as the compiled loop takes it: only what it has, in one set of scales."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables._core.executor import in_slices
from puck_tables.errors import InputError
from puck_tables.scene.agreement import launch_velocity
from puck_tables.scene.at_once import AS_IT_COMES
from puck_tables.scene.boundaries import Boundaries
from puck_tables.scene.bulk import follow_many
from puck_tables.scene.desk import Ask, desk_for
from puck_tables.scene.equations import SIZE
from puck_tables.scene.forces import forces_of, impulse_over_time, strongest
from puck_tables.scene.friction import SPIN, THETA, VX, VY, X, Y
from puck_tables.scene.ground import own_ground, patches_on
from puck_tables.scene.ingredients import (
    CARRIED,
    NO_WAY,
    PIVOT,
    RAIL,
    Body,
    Model,
    Regions,
    Stretch,
    Surface,
    dry_in,
    hold_of,
)
from puck_tables.scene.leaning import LEAN_COLUMNS
from puck_tables.scene.loop import follow
from puck_tables.scene.regions import friction_error, regions_of
from puck_tables.scene.rest import excess_at_rest
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.scene.zones import zones_of

LOCAL_SHARE = 0.01  # of the error wanted, per step and in units of the scales
FINEST_LOCAL = 3e-14  # rounding
DEFAULT_TIME = 1000.0  # times what the least friction takes, where a scene does not say
RELATIVE_REST = 1e-12  # of the speeds of puck and floor: their difference is rounding
STEP_LIMIT = 1_000_000
MAX_EVENTS = 100_000


class Twin(NamedTuple):
    """A run with so many times the error per step, and none of its steps the same.

    ``share``: see :class:`puck_tables.scene.loop.Ask`.
    """

    coarser: float
    share: float


@dataclass(frozen=True)
class Prepared:
    """Arguments of the loop for a scene, and for others that are only launched otherwise.

    ``speed``, ``rate``: Q in m/s and J in m/s², to which its tolerance refers.
    """

    model: Model
    regions: Regions
    bounds: Boundaries
    scene: SceneSpec
    state: FloatArray
    ask: Ask
    speed: float
    rate: float

    def follow(
        self, frames: FloatArray, rows: FloatArray, events: FloatArray, twin: Twin | None = None,
        order: int = AS_IT_COMES,
    ) -> tuple[tuple[int, float, int, int, int, float], FloatArray]:  # fmt: skip
        """Run it, see :func:`puck_tables.scene.loop.follow`; and what was met at once (4,).

        ``twin``: otherwise, to see what errors grow to; also with friction wrong by what its ratios
        may be.  ``order``: of what is met at once, see :mod:`puck_tables.scene.at_once`.
        """
        region = int(self.starts(self.state[None, :])[0])
        ask, off = self.ask._replace(order=order), 1.0
        if twin is not None:
            ask = ask._replace(tolerance=twin.coarser * ask.tolerance, twin=twin.share)
            off = 1.0 + friction_error(self.scene)
        regions = self.regions._replace(
            load=off * self.regions.load,
            ground=own_ground(self.regions.ground, off),
            by_speed=self.regions.by_speed._replace(normal=off * self.regions.by_speed.normal),
        )
        desk = desk_for(self.bounds, patches_on(self.regions.ground))
        found = follow(
            self.model, regions, self.bounds, ask, self.state, region, frames, rows, events, desk
        )
        return found, desk.at_once

    def follow_all(self, states: FloatArray, out: FloatArray, status: npt.NDArray[np.int8]) -> None:
        """Run it from other launches (n, 10), see :func:`puck_tables.scene.bulk.follow_many`."""
        asks, starts = self.asks(states), self.starts(states)

        def work(start: int, stop: int) -> None:
            part = out[:, start:stop].copy()
            follow_many(
                self.model, self.regions, self.bounds, asks[start:stop],
                self.scene.time is not None, self.ask.tolerance, STEP_LIMIT, MAX_EVENTS,
                states[start:stop], starts[start:stop], part, status[start:stop],
            )  # fmt: skip
            out[:, start:stop] = part

        in_slices(work, len(states))

    def starts(self, states: FloatArray) -> npt.NDArray[np.int64]:
        """Zone of the floor in which launches (n, 10) start."""
        lines = self.bounds.borders
        if not len(lines):
            return np.zeros(len(states), np.int64)
        along = states[:, [X, Y]] @ lines[0, :2]
        return np.searchsorted(lines[:, 2], along, side="right").astype(np.int64)

    def asks(self, states: FloatArray) -> FloatArray:
        """Time limit, scale of speeds and scales of the state for launches (n, 10); (n, 12)."""
        return _asks(self.scene, self.model, self.regions, states)


def prepare(scene: SceneSpec, last_time: float | None = None, reach: float = 1.0) -> Prepared:
    """The loop's arguments; on a moving floor a run goes on to ``last_time``.

    ``reach``: of the table of a friction law, see :mod:`puck_tables.scene.by_speed`.

    Raises
    ------
    InputError
        If the height is outside the tables, the file of forces is no such file, or the scales of
        the scene are too large for floating point.
    """
    puck, floor = scene.puck, scene.floor
    inertia = puck.mass * (puck.gyration * puck.radius) ** 2
    regions = regions_of(scene, reach)
    moves = any(floor.velocity) or floor.turning != 0.0
    model = Model(
        body=Body(puck.mass, inertia, puck.radius),
        surface=Surface(*floor.velocity, *floor.centre, floor.turning),
        forces=forces_of(scene),
        hold=hold_of(scene.constraint, scene.launch),
    )
    state = np.zeros(SIZE)
    state[[X, Y]], state[THETA] = scene.launch.position, scene.launch.orientation
    state[[VX, VY]], state[SPIN] = launch_velocity(scene), scene.launch.spin
    asks = _asks(scene, model, regions, state[None, :])[0]
    until, to_the_end = scene.time, True
    if until is None:
        to_the_end = moves and bool(last_time)
        until = last_time if to_the_end and last_time else float(asks[0])
    tolerance = max(LOCAL_SHARE * scene.tol, FINEST_LOCAL)
    ask = Ask(until, to_the_end, tolerance, asks[2:], float(asks[1]), STEP_LIMIT, 0.0, AS_IT_COMES)
    speed, rate, _ = _scales(scene, model, regions, state[None, :])
    bounds = _bounds(scene)
    return Prepared(model, regions, bounds, scene, state, ask, float(speed[0]), float(rate[0]))


def _bounds(scene: SceneSpec) -> Boundaries:
    """Walls (moved in by the radius), edges and borders as lines n·x = c."""
    walls, edges = [], []
    for wall in scene.walls:
        nx, ny, c = _line(wall.point, wall.normal)
        walls.append([
            nx, ny, c + scene.puck.radius, wall.restitution, wall.tangential,
            min(wall.friction, 1e300),
        ])  # fmt: skip
    for edge in scene.edges:
        edges.append(_line(edge.point, edge.normal))
    return Boundaries(
        np.array(walls).reshape(-1, 6), np.array(edges).reshape(-1, 3),
        zones_of(scene).lines,
    )  # fmt: skip


def _line(point: tuple[float, float], normal: tuple[float, float]) -> tuple[float, float, float]:
    size = math.hypot(*normal)
    nx, ny = normal[0] / size, normal[1] / size
    return nx, ny, nx * point[0] + ny * point[1]


def _asks(scene: SceneSpec, model: Model, regions: Regions, states: FloatArray) -> FloatArray:
    """Time limit, scale of speeds and scales of the state for launches (n, 10); (n, 12)."""
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        speed, rate, floor = _scales(scene, model, regions, states)
        radius, mass = scene.puck.radius, scene.puck.mass
        time = speed / rate
        length = speed * time
        slow = max(1.0, 2.0 * scene.puck.gyration**2)  # by as much longer a spin takes to brake
        # what rounding leaves of places far out, and of what a fast floor does
        ulp = 4e-16 / max(LOCAL_SHARE * scene.tol, FINEST_LOCAL)
        turning = abs(scene.floor.turning)
        place = np.maximum(length, ulp * (np.hypot(states[:, X], states[:, Y]) + floor * time))
        swift = np.maximum(speed, ulp * turning * floor * time)
        angle = np.maximum(length / radius, ulp * turning * time)
        energy = mass * speed * (speed + floor)
        until = scene.time
        asks: FloatArray = np.stack([
            np.full_like(speed, until) if until is not None
            else DEFAULT_TIME * _slowest(scene, model, regions, speed, rate),
            speed, place, place, angle, swift, swift, swift / (slow * radius),
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
    scene: SceneSpec, model: Model, regions: Regions, states: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Scales of the slip and of what changes it, and the speed of the floor; (n,) of launches.

    ``tol`` refers to the first two: Q is the slip hypot(u, rω) at the launch over the floor, or of
    the floor against a rail or pivot; where there is none, what the rate J brings over a radius.  J
    is the largest of friction, given forces and what a turning floor asks, over the mass.
    """
    puck, floor, hold = scene.puck, scene.floor, model.hold
    arm = states[:, [X, Y]] - floor.centre
    sx = floor.velocity[0] - floor.turning * arm[:, 1]
    sy = floor.velocity[1] + floor.turning * arm[:, 0]
    ground = np.hypot(sx, sy)
    speed = np.hypot(
        np.hypot(states[:, VX] - sx, states[:, VY] - sy),
        puck.radius * (states[:, SPIN] - floor.turning),
    )
    if hold.kind in (RAIL, PIVOT):
        speed = np.maximum(speed, np.hypot(hold.vx - sx, hold.vy - sy))
    lab = np.maximum(ground, np.hypot(states[:, VX], states[:, VY]))
    speed[speed <= RELATIVE_REST * (lab + puck.radius * abs(floor.turning))] = 0.0
    pull = np.maximum(regions.load.max(), strongest(model.forces, puck.radius, speed))
    turning = abs(floor.turning)
    rate = np.max([pull / puck.mass, turning * ground, speed * turning], axis=0)
    still = speed == 0.0
    speed[still] = np.where(rate[still] > 0.0, np.sqrt(rate[still] * puck.radius), 1.0)
    run = 1.0 if scene.time is None else scene.time
    rate = np.where(rate > 0.0, rate, speed / run)
    return speed, rate, ground


def _slowest(
    scene: SceneSpec, model: Model, regions: Regions, speed: FloatArray, rate: FloatArray
) -> FloatArray:
    """In what time, at most, a motion of this scene should come to rest, s (n,).

    From all speed that the launch, the floor and forces over time can give, and from the least that
    any part of the floor leaves to brake it.
    """
    puck, forces = scene.puck, model.forces
    impulse, last = impulse_over_time(forces, puck.radius)
    fast = speed + math.hypot(*scene.floor.velocity) + impulse / puck.mass
    brakes = []
    for number in range(len(regions.load)):
        load = float(regions.load[number])
        if load > 0.0 and not regions.astride[number]:
            dry = dry_in(regions, number)
            at_rest = Stretch(model, dry, np.empty((0, LEAN_COLUMNS)), 0, CARRIED, NO_WAY, 0.0, 0.0)
            excess = abs(float(excess_at_rest(at_rest, 0.0, np.zeros(SIZE))[0]))
            brakes.append(min(excess, load) if math.isfinite(excess) else load)
    slow = max(1.0, 2.0 * puck.gyration**2)
    brake = [b / puck.mass / slow for b in brakes if b > 1e-9 * regions.load.max()]
    time = fast / (min(brake) if brake else rate)
    if forces.sliding > 0.0:
        time = np.maximum(time, puck.mass / forces.sliding)
    return np.maximum(time, speed / rate) + last

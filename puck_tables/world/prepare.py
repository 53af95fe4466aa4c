"""A scene of several pucks as the compiled engine reads it."""

from __future__ import annotations

import math

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.scene.friction import SPIN, VX, VY
from puck_tables.scene.ingredients import Regions
from puck_tables.scene.regions import NO_LAW
from puck_tables.scene.scene import Scene
from puck_tables.stopping.stop_table import StopTable
from puck_tables.world import layout
from puck_tables.world.agreement import pieces_of, start_of
from puck_tables.world.drive import pieces_along, rows_of
from puck_tables.world.engine import EVERYBODY, Room, advance, drive_on, keep_flight, room_for
from puck_tables.world.flight import FLIGHT_COLUMNS, Curves, start_flight
from puck_tables.world.game import (
    COUNTS,
    EVENT_COLUMNS,
    HISTORY_COLUMNS,
    LAUNCH_COLUMNS,
    N_PIECES,
    NOTHING,
    Game,
    Whole,
)
from puck_tables.world.paths import FIRST

ROWS = 256  # of events and flights at first


def order_of(scene: Scene) -> Whole:
    """The numbers of the pucks in the order in which the engine has them.

    It depends on where they are, not on how they are numbered: so no bit of a result does.
    """
    places = np.array([start_of(piece) for piece in pieces_of(scene)])
    return np.lexsort((places[:, 1], places[:, 0]))


def game_of(scene: Scene, order: Whole) -> tuple[Game, Room]:
    """The engine's arrays at the start of a scene, and room for it to work in."""
    pieces = [pieces_of(scene)[number] for number in order]
    count, table = len(pieces), StopTable.shipped()
    curves = Curves(
        table.stop_coefficients, table.curve_coefficients, table.time_inverse, table.turn_inverse,
        table.constants,
    )  # fmt: skip
    discs, states = np.zeros((count, layout.DISC_COLUMNS)), np.zeros((count, 6))
    drives, ways = np.zeros((count, 2), np.int64), [np.zeros((0, 20))]
    launches = []
    for i, piece in enumerate(pieces):
        driven = bool(piece.path)
        inertia = piece.mass * (piece.gyration * piece.radius) ** 2
        if not driven:
            discs[i, layout.LIGHTNESS], discs[i, layout.TURNABILITY] = 1.0 / piece.mass, 1 / inertia
            discs[i, layout.DECEL], discs[i, layout.DELTA] = piece.decel, piece.delta
            discs[i, layout.DAMPING] = scene.drag.sliding / piece.mass
            discs[i, layout.WAKE] = scene.drag.quadratic / piece.mass
            discs[i, layout.SPIN_DAMPING] = scene.drag.spinning / inertia
        discs[i, layout.RADIUS] = piece.radius
        discs[i, layout.RESTITUTION], discs[i, layout.TANGENTIAL] = (
            piece.restitution, piece.tangential,
        )  # fmt: skip
        discs[i, layout.FRICTION] = piece.rim
        launch = piece.launch
        velocity = launch.velocity or (0.0, 0.0)
        states[i, :2], states[i, 2] = start_of(piece), launch.orientation
        if driven:
            first = sum(map(len, ways))
            ways.append(pieces_along(rows_of(piece.path)))
            drives[i] = first, first + len(ways[-1])
        elif launch.time > 0.0:
            launches.append([launch.time, i, *velocity, launch.spin])
        else:
            states[i, 3:5], states[i, 5] = velocity, launch.spin
    load = np.divide(discs[:, layout.DECEL], discs[:, layout.LIGHTNESS],
                     out=np.zeros(count), where=discs[:, layout.LIGHTNESS] > 0.0)  # fmt: skip
    game = Game(
        discs=discs,
        regions=Regions(load, discs[:, layout.DELTA].copy(), np.empty((count, 0)), NO_LAW),
        obstacles=_obstacles(scene),
        curves=curves,
        clock=np.zeros(1),
        kinds=np.zeros(count, np.int64),
        flights=np.zeros((count, FLIGHT_COLUMNS)),
        group=np.zeros(count, np.int64),
        held=np.zeros((6 * count + 16, 2), np.int64),
        next_time=np.full(count, math.inf),
        next_partner=np.full(count, NOTHING),
        launches=np.array(sorted(launches)).reshape(-1, LAUNCH_COLUMNS),
        pieces=np.vstack(ways),
        drives=drives,
        events=np.zeros((ROWS + 8 * count, EVENT_COLUMNS)),
        history=np.zeros((ROWS + 4 * count, HISTORY_COLUMNS)),
        counts=np.zeros(COUNTS, np.int64),
        pace=np.zeros(2),
    )
    set_pace(game, states)
    game.counts[N_PIECES] = len(game.pieces)
    room = room_for(count)
    room.states[:] = states
    for i in range(count):
        game.kinds[i] = start_flight(states[i], discs[i], curves, 0.0, room.work, game.flights[i])
        if drives[i, 0] < drives[i, 1]:
            game.flights[i, -2] = drives[i, 0]
            drive_on(game, i, 0.0, room)
        else:
            keep_flight(game, i)
    advance(game, 0.0, EVERYBODY, room.one, room)
    return game, room


def set_pace(game: Game, states: FloatArray) -> None:
    """Scales of speed and acceleration that hold for these states, and for those before."""
    rims = game.discs[:, layout.RADIUS] * np.abs(states[:, SPIN])
    driven = game.pieces[:, FIRST + VX : FIRST + VY + 1]
    launched = np.hypot(game.launches[:, 2], game.launches[:, 3])
    game.pace[0] = max(
        game.pace[0], float(np.hypot(np.hypot(states[:, VX], states[:, VY]), rims).max()),
        float(np.hypot(*driven.T).max(initial=0.0)), float(launched.max(initial=0.0)),
    )  # fmt: skip
    fastest, smallest = game.pace[0], float(game.discs[:, layout.RADIUS].min())
    steady = float(game.discs[:, layout.DECEL].max())
    game.pace[1] = max(game.pace[1], steady if steady > 0.0 else fastest**2 / smallest)


def _obstacles(scene: Scene) -> FloatArray:
    """Rows of :mod:`puck_tables.world.layout`: walls, posts, arcs, pockets, edges."""
    rows = []
    for wall in scene.walls:
        rows.append([layout.WALL, *_line(wall.point, wall.normal), wall.restitution,
                     wall.tangential, wall.friction, 0.0, 0.0])  # fmt: skip
    for post in scene.posts:
        rows.append([layout.POST, *post.point, post.radius, post.restitution, post.tangential,
                     post.friction, 0.0, 0.0])  # fmt: skip
    for arc in scene.arcs:
        rows.append([layout.ARC, *arc.point, arc.radius, arc.restitution, arc.tangential,
                     arc.friction, arc.start, arc.span])  # fmt: skip
    for pocket in scene.pockets:
        rows.append([layout.POCKET, *pocket.point, pocket.radius, *[0.0] * 5])
    for edge in scene.edges:
        rows.append([layout.EDGE, *_line(edge.point, edge.normal), *[0.0] * 5])
    return np.array(rows, np.float64).reshape(-1, layout.OBSTACLE_COLUMNS)


def obstacle_names(scene: Scene) -> list[str]:
    """What the rows of the obstacles are called, in their order."""
    lists = {"wall": scene.walls, "post": scene.posts, "arc": scene.arcs,
             "pocket": scene.pockets, "edge": scene.edges}  # fmt: skip
    return [f"{name} {number}" for name, ones in lists.items() for number in range(len(ones))]


def _line(point: tuple[float, float], normal: tuple[float, float]) -> tuple[float, float, float]:
    """Unit normal of a line, and its place along it."""
    size = math.hypot(*normal)
    nx, ny = normal[0] / size, normal[1] / size
    return nx, ny, nx * point[0] + ny * point[1]

"""What stands on a board, and where its floor changes, as rows of the compiled engine."""

from __future__ import annotations

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.scene.parts import Wall
from puck_tables.scene.pucks_and_posts import Arc, Post
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.scene.sides import corners_in, cushions_in, ends_of_floor, line_of, sides_in
from puck_tables.world import layout
from puck_tables.world.rim_laws import number_for


def obstacles_of(scene: SceneSpec, called: dict[object, float], makes: FloatArray) -> FloatArray:
    """Rows of :mod:`puck_tables.world.layout`: what stands, edges twice, then borders."""

    def rim(cushion: Wall | Post | Arc) -> list[float]:
        return [number_for(cushion.restitution, called), cushion.tangential, cushion.friction]

    rows: list[list[float]] = []
    sides = sides_in(scene)
    for number, wall in enumerate(scene.walls):
        if wall.point is not None:
            rows.append([layout.WALL, *line_of(wall), *rim(wall)])
        for side in sides:
            if side.wall == number:
                (nx, ny), (x, y) = side.normal, side.start
                row = [layout.SIDE, nx, ny, nx * x + ny * y, *rim(wall), 0.0, 0.0]
                rows.append([*row, *side.start, *side.end])
    for post in scene.posts:
        rows.append([layout.POST, *post.point, post.radius, *rim(post)])
    for arc in scene.arcs:
        rows.append([layout.ARC, *arc.point, arc.radius, *rim(arc), arc.start, arc.span])
    for corner in corners_in(scene):
        row = [layout.CORNER, *corner.point, 0.0, *rim(scene.walls[corner.wall]), 0.0, 0.0]
        rows.append([*row, *corner.one, *corner.other])
    for pocket in scene.pockets:
        rows.append([layout.POCKET, *pocket.point, pocket.radius])
    for edge in scene.edges:
        rows.append([layout.EDGE, *line_of(edge)])
    for number in ends_of_floor(scene):
        rows.append([layout.OVERHANG, *line_of(scene.edges[number]), 0.0, 0.0, 0.0, float(number)])
    borders = len(borders_of(scene))
    for number in range(borders + len(scene.floor.patches)):
        rows.append([layout.BORDER if number < borders else layout.PATCH, float(number)])
    found = np.zeros((len(rows), layout.OBSTACLE_COLUMNS))
    for place, one in enumerate(rows):
        found[place, : len(one)] = one
    found[:, layout.OBSTACLE_MAKE] = makes
    return found


def obstacle_names(scene: SceneSpec) -> list[str]:
    """What the rows of the obstacles are called, in their order."""
    lists = (("pocket", range(len(scene.pockets))), ("edge", range(len(scene.edges))),
             ("edge", ends_of_floor(scene)), ("border", range(len(borders_of(scene)))),
             ("patch", range(len(scene.floor.patches))))  # fmt: skip
    more = [(name, number) for name, numbers in lists for number in numbers]
    return [f"{name} {number}" for name, number in cushions_in(scene) + more]


def borders_of(scene: SceneSpec) -> tuple[float, ...]:
    """The borders of its strips."""
    return scene.floor.strips.borders if scene.floor.strips is not None else ()

"""Where the pucks of a scene begin, and what is wrong with that: they overlap, or lie in walls."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from puck_tables.scene.map_of_floor import edges_under
from puck_tables.scene.pucks_and_posts import ScenePuck
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.scene.sides import ends_of_floor, gap_along, gap_to, line_of
from puck_tables.world.named_pucks import called, start_of, who
from puck_tables.world.paths import rows_of

TOUCH = 1e-12  # of the radius: pucks that overlap less touch
# of the reach: nearer to an edge what presses is a line, and friction by rounding known no better;
# and so little off an edge, in rad, is along it
_NARROW, _ALONG = 4e-4, 1e-3


def misplaced(scene: SceneSpec, pucks: tuple[ScenePuck, ...]) -> list[str]:
    """What is wrong with where pucks begin, and where they are driven."""
    return [
        *_overlaps(pucks), *_out_of_bounds(scene, pucks), *_driven_through(scene, pucks),
        *_wide_pockets(scene), *_balancing(scene, pucks),
    ]  # fmt: skip


def _overlaps(pucks: tuple[ScenePuck, ...]) -> Iterator[str]:
    """Pucks that overlap at the start."""
    places = np.array([start_of(puck) for puck in pucks])
    radii = np.array([puck.radius for puck in pucks])
    for number in range(len(pucks)):
        gaps = np.hypot(*(places[:number] - places[number]).T) - radii[:number] - radii[number]
        for other in np.flatnonzero(gaps < -TOUCH * radii[number]):
            yield (
                f"{called(pucks[other], int(other))} and {called(pucks[number], number)} overlap "
                f"by {-gaps[other]:.3g} m at the start: move one of them"
            )


def _out_of_bounds(scene: SceneSpec, pucks: tuple[ScenePuck, ...]) -> Iterator[str]:
    """Pucks that start in a cushion or a hole."""
    for number, puck in enumerate(pucks):
        place, name = start_of(puck), who(scene, number)
        for path, what, depth in obstructing(scene, place, puck.radius, holes=not puck.path):
            yield f"{path}: {name} at {list(place)} {what} by {depth:.3g} m: move one of them"


def _balancing(scene: SceneSpec, pucks: tuple[ScenePuck, ...]) -> Iterator[str]:
    """Pucks that set off along an edge, so near to it that whether they fall is rounding."""
    for number, puck in enumerate(pucks):
        reach = (puck.shape.reach if puck.shape else puck.radius) * _NARROW
        (vx, vy), spin = puck.launch.velocity or (0.0, 0.0), puck.launch.spin
        speed = math.hypot(vx, vy, puck.radius * spin)
        edges = [] if puck.path else edges_under(scene.alone(puck)).tolist()
        for k, (nx, ny, at) in zip(ends_of_floor(scene), edges, strict=False):
            inside = nx * puck.launch.position[0] + ny * puck.launch.position[1] - at
            if inside < reach and speed > 0.0 and abs(nx * vx + ny * vy) <= _ALONG * speed:
                yield (
                    f"edge[{k}]: {who(scene, number)} sets off along it, its centre of mass "
                    f"{max(inside, 0.0):.3g} m from it: whether it falls is not known there; move "
                    f"it at least {reach:.3g} m onto the floor"
                )


def _driven_through(scene: SceneSpec, pucks: tuple[ScenePuck, ...]) -> Iterator[str]:
    """Paths of driven bodies that lead through what stands, at rest at their start or later."""
    for number, puck in enumerate(pucks):
        if not puck.path:
            continue
        rows = rows_of(puck.path)
        before, after = rows[:-1, 1:3], rows[1:, 1:3]
        gaps = {}
        for k, wall in enumerate(scene.walls):
            gaps[f"wall[{k}]"] = np.array(
                [gap_to(wall, tuple(place)) for place in after] if wall.point is not None
                else [gap_along(wall, *ends) for ends in zip(before, after, strict=True)]
            )  # fmt: skip
        for k, post in enumerate(scene.posts):
            ends, off = after - before, np.array(post.point) - before
            square = np.maximum((ends * ends).sum(axis=1), 1e-300)
            share = np.clip((ends * off).sum(axis=1) / square, 0.0, 1.0)
            gaps[f"post[{k}]"] = np.hypot(*(off - share[:, None] * ends).T) - post.radius
        for k, arc in enumerate(scene.arcs):
            if arc.span >= 2.0 * math.pi:
                gaps[f"arc[{k}]"] = arc.radius - np.hypot(*(after - arc.point).T)
        starts_in = [one for one, *_ in obstructing(scene, start_of(puck), puck.radius, False)]
        for path, gap in gaps.items():
            deep = np.flatnonzero(gap - puck.radius < -TOUCH * puck.radius)
            if deep.size and path not in starts_in:
                row = int(deep[0])
                start, end = rows[row : row + 2, 0]
                yield (
                    f"{path}: {who(scene, number)} is driven through it between {start:g} s and "
                    f"{end:g} s, {puck.radius - gap[row]:.3g} m deep: lead its path around it"
                )


def obstructing(
    scene: SceneSpec, place: tuple[float, float], radius: float, holes: bool
) -> Iterator[tuple[str, str, float]]:
    """What keeps a puck from lying at a place: its path, how, and by how much, m.

    ``holes``: whether pockets and edges do.

    >>> from puck_tables import Puck, Scene, Wall
    >>> board = Scene(pucks=[Puck(0.1)], walls=[Wall((0.0, 0.5), normal=(0.0, -1.0))])
    >>> list(obstructing(board, (0.0, 0.45), 0.1, holes=True))[0][:2]
    ('wall[0]', 'reaches through it')
    """
    gaps = {f"wall[{k}]": gap_to(one, place) - radius for k, one in enumerate(scene.walls)}
    for k, post in enumerate(scene.posts):
        gaps[f"post[{k}]"] = math.dist(place, post.point) - radius - post.radius
    for k, arc in enumerate(scene.arcs):
        if arc.span >= 2.0 * math.pi:
            gaps[f"arc[{k}]"] = arc.radius - radius - math.dist(place, arc.point)
    if holes:
        for k, pocket in enumerate(scene.pockets):
            gaps[f"pocket[{k}]"] = math.dist(place, pocket.point) - pocket.radius
        for k, edge in enumerate(scene.edges):
            nx, ny, at = line_of(edge)
            gaps[f"edge[{k}]"] = nx * place[0] + ny * place[1] - at
    for path, gap in gaps.items():
        if gap < -TOUCH * radius:
            what = "lies in it" if path.startswith(("pocket", "edge")) else "reaches through it"
            yield path, what, -gap


def _wide_pockets(scene: SceneSpec) -> Iterator[str]:
    """Pockets wider than the board between two facing walls without ends."""
    lines = [(k, line_of(one), one.point) for k, one in enumerate(scene.walls) if one.point]
    for k, pocket in enumerate(scene.pockets):
        for place, (number, (nx, ny, at), _) in enumerate(lines):
            for other, (ox, oy, _), facing in lines[:place]:
                width = nx * facing[0] + ny * facing[1] - at
                if nx * ox + ny * oy < -0.999 and 2.0 * pocket.radius >= width:
                    yield (
                        f"pocket[{k}].radius = {pocket.radius:g}: wider than the board, {width:g} "
                        f"m between wall[{other}] and wall[{number}]"
                    )

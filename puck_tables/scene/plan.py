"""The cheapest model that is exact for a scene, and why it is not a cheaper one.

The ladder: closed form (rest, pure spin, pure translation, limit motion); look-up (all motions of
a free puck on a level floor are one curve); and for everything that breaks that symmetry the
friction ratios at the scene's δ, a slice of the table, integrated with what acts.  A
floor that moves steadily only shifts the frame; walls, edges and borders that the free puck does
not reach are not there.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

from puck_tables.body import is_plain
from puck_tables.motion.limits import regime
from puck_tables.scene.scene import Floor, Scene, distance, launch_velocity
from puck_tables.sliced import FINEST_TOL
from puck_tables.stops import stop

_NAMES = {"A": "rest", "B0": "pure spin", "C0": "pure translation", "D": "the limit motion"}


@dataclass(frozen=True)
class Plan:
    """``model``: what is taken; ``plain``: a free puck; ``why``: lines of text."""

    model: str
    plain: bool
    why: str


def ingredients(scene: Scene) -> list[str]:
    """What acts beside dry friction on a level floor that moves steadily or not at all.

    Examples
    --------
    >>> from puck_tables.scene.scene import Floor, Launch, Puck
        >>> ingredients(Scene(Puck(1.0), Floor(0.1, slope=0.2), Launch((1.0, 0.0), 5.0)))
        ['slope']
    """
    floor, force, puck = scene.floor, scene.force, scene.puck
    homogeneous_and_uniform = is_plain(puck.pressure, puck.gyration, height_ratio(scene))
    there = {
        "slope": floor.slope > 0.0,
        "turntable": floor.turning != 0.0,
        "strips": floor.strips is not None,
        "drag": scene.drag.sliding > 0.0 or scene.drag.spinning > 0.0,
        "force": any(force.constant) or force.torque != 0.0,
        "force over time": bool(force.file),
        "walls": bool(scene.wall),
        "edges": bool(scene.edge),
        scene.constraint.kind if scene.constraint else "constraint": scene.constraint is not None,
        "friction law": bool(floor.law),
        "a tolerance finer than for free pucks of this kind": not homogeneous_and_uniform
        and scene.run.tol < FINEST_TOL,
        "no dry friction": floor.strips is None and floor.friction == 0.0 and not floor.law,
    }
    return [name for name, is_there in there.items() if is_there]


def height_ratio(scene: Scene) -> float:
    """δ = 2fh/r on the floor outside of strips.

    Examples
    --------
    >>> from puck_tables.scene.scene import Floor, Puck
    >>> height_ratio(Scene(Puck(0.5, 1.0), Floor(0.1)))
    0.4
    """
    return 2.0 * scene.floor.friction * scene.puck.height / scene.puck.radius


def free_puck(scene: Scene) -> dict[str, Any]:
    """The arguments of a free puck's motion, in the frame of the floor."""
    vx, vy = launch_velocity(scene)
    return {
        "v0": (vx - scene.floor.velocity[0], vy - scene.floor.velocity[1]),
        "w0": scene.launch.spin,
        "delta": height_ratio(scene),
        "decel": scene.floor.friction * scene.floor.gravity,
        "radius": scene.puck.radius,
        "pressure": scene.puck.pressure,
        "gyration": scene.puck.gyration,
    }


def out_of_reach(scene: Scene) -> Scene:
    """The scene without the walls, edges and borders that its puck, then free, never meets."""
    bare = replace(scene, wall=(), edge=(), floor=_without_borders(scene))
    if bare == scene or ingredients(bare) or any(scene.floor.velocity):
        return scene
    way = float(stop(**free_puck(bare)).path_length) * (1.0 + 1e-6)
    place, radius = scene.launch.position, scene.puck.radius
    room = [distance(wall, place) - radius for wall in scene.wall]
    room += [distance(edge, place) for edge in scene.edge]
    strips = scene.floor.strips
    if strips is not None:
        across = (math.cos(strips.direction), math.sin(strips.direction))
        along = across[0] * place[0] + across[1] * place[1]
        room += [abs(along - border) for border in strips.borders]
    return bare if way < min(room) else scene


def _without_borders(scene: Scene) -> Floor:
    """The floor with the friction of the region in which the puck starts."""
    strips = scene.floor.strips
    if strips is None:
        return scene.floor
    across = (math.cos(strips.direction), math.sin(strips.direction))
    along = across[0] * scene.launch.position[0] + across[1] * scene.launch.position[1]
    region = sum(along >= border for border in strips.borders)
    return replace(scene.floor, strips=None, friction=strips.friction[region])


def plan_for(scene: Scene) -> Plan:
    """The plan for one run.

    Examples
    --------
    >>> from puck_tables.scene.scene import Floor, Launch, Puck
        >>> plan_for(Scene(Puck(1.0), Floor(0.1), Launch((1.0, 0.0), 0.0))).model
        'closed form: pure translation'
    """
    acting = ingredients(scene)
    if acting:
        model = "slice of the table at fixed delta, integrated"
        if "friction law" in acting:
            model = "table of f over slip angle and speed, integrated"
        elif "no dry friction" in acting:
            model = "integrated"
        lines = [
            f"taken         {model}",
            f"acting        {', '.join([*acting, *_moving(scene)])}",
            "cheaper, no   look-up: not a free puck on a level floor",
        ]
        return Plan(model, False, "\n".join(lines))
    free = free_puck(scene)
    kind = regime(**{name: value for name, value in free.items() if name != "decel"})
    frame = "in the frame of the belt" if any(scene.floor.velocity) else "a free puck, level floor"
    if kind in _NAMES:
        model = f"closed form: {_NAMES[kind]}"
        return Plan(model, True, f"taken         {model}, {frame}\ncheaper, no   there is none")
    model = "free puck: similarity, slice of the table"
    lines = [
        f"taken         {model}, {frame}",
        f"cheaper, no   closed form: generic motion ({kind})",
        "dearer        integration in the laboratory: nothing here breaks the similarity",
    ]
    return Plan(model, True, "\n".join(lines))


def _moving(scene: Scene) -> list[str]:
    return ["moving floor"] if any(scene.floor.velocity) else []

"""The cheapest model that is exact for a scene, and why it is not a cheaper one.

The ladder: closed form (rest, pure spin, pure translation, limit motion); look-up (all motions of
a free puck on a level floor are one curve); and for everything that breaks that symmetry the
friction ratios at the scene's δ, a slice of the table, integrated with what acts.  A
floor that moves steadily only shifts the frame; walls, edges and borders that the free puck does
not reach are not there.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from functools import lru_cache
from typing import Any, NamedTuple

from puck_tables.errors import PuckError
from puck_tables.motion.body import is_plain
from puck_tables.motion.friction import FINEST_TOL
from puck_tables.puck import Puck
from puck_tables.scene.fields import Kind
from puck_tables.scene.scene import Floor, Scene, distance, launch_velocity

_NAMES = {"A": "rest", "B0": "pure spin", "C0": "pure translation", "D": "the limit motion"}


@dataclass(frozen=True)
class Plan:
    """``model``: what is taken; ``plain``: a free puck; ``why``: lines of text."""

    model: str
    plain: bool
    why: str


class Ingredient(NamedTuple):
    """What may act: its name, the entries of a scene that describe it, and whether it is there."""

    name: str
    paths: tuple[str, ...]
    acts: Callable[[Scene], bool]


# every entry that a scene may have, so that none can be left out by mistake: first those that the
# motion of a free puck on a level floor takes into account
FREE = (
    "title", "puck.radius", "puck.height", "puck.mass", "puck.gyration", "puck.pressure",
    "floor.friction", "floor.gravity", "floor.velocity",
    "launch.velocity", "launch.spin", "launch.position", "launch.orientation",
    "run.time", "run.frames", "run.tol",
)  # fmt: skip
INGREDIENTS = (
    Ingredient("slope", ("floor.slope", "floor.downhill"), lambda s: s.floor.slope > 0.0),
    Ingredient("turntable", ("floor.turning", "floor.centre"), lambda s: s.floor.turning != 0.0),
    Ingredient(
        "strips", ("floor.strips.borders", "floor.strips.friction", "floor.strips.direction"),
        lambda s: s.floor.strips is not None,
    ),
    Ingredient(
        "drag", ("drag.sliding", "drag.spinning"),
        lambda s: s.drag.sliding > 0.0 or s.drag.spinning > 0.0,
    ),
    Ingredient(
        "force", ("force.constant", "force.torque"),
        lambda s: any(s.force.constant) or s.force.torque != 0.0,
    ),
    Ingredient("force over time", ("force.file",), lambda s: bool(s.force.file)),
    Ingredient(
        "walls",
        ("wall.point", "wall.normal", "wall.restitution", "wall.tangential", "wall.friction"),
        lambda s: bool(s.wall),
    ),
    Ingredient("edges", ("edge.point", "edge.normal"), lambda s: bool(s.edge)),
    Ingredient(
        "constraint",
        ("constraint.kind", "constraint.angle", "constraint.reach", "constraint.velocity",
         "constraint.side_slip"),
        lambda s: s.constraint is not None,
    ),
    Ingredient("friction law", ("floor.law",), lambda s: bool(s.floor.law)),
)  # fmt: skip
KNOWN = frozenset([*FREE, *(path for one in INGREDIENTS for path in one.paths)])


def ingredients(scene: Scene) -> list[str]:
    """What acts beside dry friction on a level floor that moves steadily or not at all.

    Raises
    ------
    PuckError
        If an entry of the scene belongs to nothing that is known here: it would be left out.

    Examples
    --------
    >>> from puck_tables.scene.scene import Floor, Launch, Puck
    >>> ingredients(Scene(Puck(1.0), Floor(0.1, slope=0.2), Launch((1.0, 0.0), 5.0)))
    ['slope']
    """
    kind: Any = type(scene)
    if stray := _stray(kind):
        raise PuckError(f"{', '.join(stray)}: the plan of a run knows no such ingredient")
    there = [one.name for one in INGREDIENTS if one.acts(scene)]
    if scene.constraint is not None:
        there[there.index("constraint")] = scene.constraint.kind
    puck = scene.puck
    plain = is_plain(puck.pressure, puck.gyration, height_ratio(scene))
    if not plain and scene.run.tol < FINEST_TOL:
        there.append("a tolerance finer than for free pucks of this kind")
    if scene.floor.strips is None and scene.floor.friction == 0.0 and not scene.floor.law:
        there.append("no dry friction")
    return there


@lru_cache(maxsize=16)
def _stray(kind: type, path: str = "") -> list[str]:
    """Entries that a scene, or a part of it, may have and that are not known here."""
    found = []
    for spec in fields(kind):
        what: Kind = spec.metadata["kind"]
        if what.part is not None:
            found += _stray(what.part, f"{path}{spec.name}.")
        elif f"{path}{spec.name}" not in KNOWN:
            found.append(f"{path}{spec.name}")
    return found


def height_ratio(scene: Scene) -> float:
    """δ = 2fh/r on the floor outside of strips.

    Examples
    --------
    >>> from puck_tables.scene.scene import Floor, Puck
    >>> height_ratio(Scene(Puck(0.5, 1.0), Floor(0.1)))
    0.4
    """
    return 2.0 * scene.floor.friction * scene.puck.height / scene.puck.radius


def free_puck(scene: Scene) -> Puck:
    """The puck on its floor, where nothing else acts."""
    puck, floor = scene.puck, scene.floor
    return Puck(
        puck.radius, puck.height, floor.friction, puck.mass, floor.gravity, puck.pressure,
        puck.gyration,
    )  # fmt: skip


def free_velocity(scene: Scene) -> tuple[float, float]:
    """The launch velocity in the frame of the floor, m/s."""
    vx, vy = launch_velocity(scene)
    return vx - scene.floor.velocity[0], vy - scene.floor.velocity[1]


def out_of_reach(scene: Scene) -> Scene:
    """The scene without the walls, edges and borders that its puck, then free, never meets."""
    bare = replace(scene, wall=(), edge=(), floor=_without_borders(scene))
    if bare == scene or ingredients(bare) or any(scene.floor.velocity):
        return scene
    stopped = free_puck(bare).stop(free_velocity(bare), bare.launch.spin)
    way = float(stopped.path_length) * (1.0 + 1e-6)
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
    kind = free_puck(scene).regime(free_velocity(scene), scene.launch.spin)
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

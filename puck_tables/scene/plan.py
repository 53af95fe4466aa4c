"""The cheapest model that is exact for a scene, and why it is not a cheaper one.

The ladder: closed form (rest, pure spin, pure translation, limit motion); look-up (all motions of
a free puck on a level floor are one curve); and for everything that breaks that symmetry the
friction ratios at the scene's δ, a section of the table, integrated with what acts.  A
floor that moves steadily only shifts the frame; walls, edges and borders that the free puck does
not reach are not there.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

from puck_tables._core.fields import specs
from puck_tables.errors import PuckError
from puck_tables.motion.body import is_plain
from puck_tables.motion.friction_source import FINEST_TOL
from puck_tables.motion.limits import regime
from puck_tables.scene.agreement import distance, launch_velocity
from puck_tables.scene.entries import entries
from puck_tables.scene.floor_patches import distances
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.stopping.stops import stop

OVERHANG = (
    "a rim comes over an edge; until its centre does, a puck is carried as if none of it hung in "
    "the air, which it is not: its motion from there on is a guess"
)
EMPIRICAL = (
    "The lateral force is empirical, as somebody fitted it: no dry friction over the contact "
    "explains it."
)
_NAMES = {"A": "rest", "B0": "pure spin", "C0": "pure translation", "D": "the limit motion"}


@dataclass(frozen=True)
class Plan:
    """``model``: what is taken; ``plain``: a free puck; ``why``: lines of text."""

    model: str
    plain: bool
    why: str


# what the motion of a free puck on a level floor takes into account, and what makes a scene one of
# many pucks, which :mod:`puck_tables.world` runs
FREE = (
    "title", "puck", "launch", "time", "frames", "tol", "puck[]", "post", "arc", "pocket", "rim",
)  # fmt: skip


def ingredients(scene: SceneSpec) -> list[str]:
    """What acts beside dry friction on a level floor that moves steadily or not at all.

    Raises
    ------
    PuckError
        As :func:`acting`.

    Examples
    --------
    >>> from puck_tables import Floor, Launch, Puck, Scene
    >>> ingredients(Scene(Puck(1.0, friction=0.1), Floor(slope=0.2), Launch((1.0, 0.0), 5.0)))
    ['slope']
    """
    there = acting(scene)
    puck = scene.puck
    plain = is_plain(puck.pressure, puck.gyration, puck.delta)
    if not plain and scene.tol < FINEST_TOL:
        there.append("a tolerance finer than for free pucks of this kind")
    floor = scene.floor
    own = floor.strips is not None or bool(floor.law) or floor.orthotropic is not None
    if not own and not any(scene.frictions):
        there.append("no dry friction")
    return there


def acting(scene: SceneSpec) -> list[str]:
    """What a scene says that acts, in its order.

    Raises
    ------
    PuckError
        If an entry of the scene does not say what acts with it: it would be left out.

    Examples
    --------
    >>> from puck_tables import Drag, Puck, Scene
    >>> acting(Scene(Puck(1.0), drag=Drag(sliding=0.1)))
    ['drag']
    """
    kind: Any = type(scene)
    if stray := _stray(kind):
        raise PuckError(f"{', '.join(stray)}: the plan of a run knows no such ingredient")
    told_of = (entry for entry in entries(scene) if entry.value is not None and entry.acts)
    there = list(dict.fromkeys(one.acts or "" for one in told_of if one.value != one.default))
    if scene.constraint is not None:
        there[there.index("constraint")] = scene.constraint.kind
    return there


@lru_cache(maxsize=16)
def _stray(kind: Any) -> list[str]:
    """Entries that a scene, or a part of it, may have and that do not say what acts with them."""
    return [path for name in specs(kind) if name not in FREE for path in _mute(kind, name, name)]


def _mute(kind: Any, name: str, path: str) -> list[str]:
    spec = specs(kind)[name]
    part = spec.metadata["kind"].part
    if part is None:
        return [path] if spec.metadata["acts"] is None else []
    return [one for inner in specs(part) for one in _mute(part, inner, f"{path}.{inner}")]


def free_velocity(scene: SceneSpec) -> tuple[float, float]:
    """The launch velocity in the frame of the floor, m/s."""
    vx, vy = launch_velocity(scene)
    return vx - scene.floor.velocity[0], vy - scene.floor.velocity[1]


def out_of_reach(scene: SceneSpec) -> SceneSpec:
    """The scene without the walls, edges and borders that its puck, then free, never meets."""
    strips, patches = scene.floor.strips, scene.floor.patches
    if not (scene.walls or scene.edges or strips or patches) or any(scene.floor.velocity):
        return scene
    bare = _without_boundaries(scene)
    if ingredients(bare):
        return scene
    stopped = stop(free_velocity(bare), bare.launch.spin, **bare.puck.arguments())
    way = float(stopped.path_length) * (1.0 + 1e-6)
    place, radius = scene.launch.position, scene.puck.radius
    room = [distance(wall, place) - radius for wall in scene.walls]
    room += [distance(edge, place) - radius for edge in scene.edges]  # the rim may hang over it
    if strips is not None:
        across = (math.cos(strips.direction), math.sin(strips.direction))
        along = across[0] * place[0] + across[1] * place[1]
        room += [abs(along - border) - radius for border in strips.borders]
    room += [abs(away) - radius for away in distances(scene.floor, place)]
    return bare if way < min(room) else scene


def _without_boundaries(scene: SceneSpec) -> SceneSpec:
    """The scene with the friction of the region in which the puck starts."""
    strips, friction = scene.floor.strips, scene.puck.friction
    if strips is None and not scene.floor.patches:
        return replace(scene, walls=(), edges=())
    if strips is not None:
        across = (math.cos(strips.direction), math.sin(strips.direction))
        along = across[0] * scene.launch.position[0] + across[1] * scene.launch.position[1]
        friction = strips.friction[sum(along >= border for border in strips.borders)]
    away = distances(scene.floor, scene.launch.position)
    for patch, gap in zip(scene.floor.patches, away, strict=True):
        friction = patch.friction if gap < 0.0 else friction
    return replace(
        scene, walls=(), edges=(), puck=replace(scene.puck, friction=friction),
        floor=replace(scene.floor, strips=None, patches=()),
    )  # fmt: skip


def plan_for(scene: SceneSpec) -> Plan:
    """The plan for one run.

    Examples
    --------
    >>> from puck_tables import Launch, Puck, Scene
    >>> plan_for(Scene(Puck(1.0, friction=0.1), launch=Launch((1.0, 0.0)))).model
    'closed form: pure translation'
    """
    acts = ingredients(scene)
    if acts:
        model = "friction at fixed delta, integrated"
        if "friction law" in acts:
            model = "friction by slip speed, integrated"
        elif "orthotropic friction" in acts:
            model = "friction by quadrature over the base, integrated"
        elif "no dry friction" in acts:
            model = "integrated"
        why = (
            f"Taken: {model}; what acts: {', '.join([*acts, *_moving(scene)])}.\n"
            "A look-up would be cheaper, but it is of free pucks on a level floor."
        )
        if scene.lateral.strength != 0.0:
            why += f"\n{EMPIRICAL}"
        if scene.floor.strips is not None or scene.floor.patches:
            piled = scene.puck.body.law.profile is not None
            why += (
                "\nWhile the base is astride two frictions they are integrated over its parts, "
                f"about {'forty' if piled else 'ten'} times the cost of a step elsewhere."
            )
        return Plan(model, False, why)
    puck = scene.puck
    kind = regime(
        free_velocity(scene),
        scene.launch.spin,
        puck.delta,
        puck.radius,
        puck.pressure,
        puck.gyration,
    )
    frame = "in the frame of the belt" if any(scene.floor.velocity) else "a free puck, level floor"
    if kind in _NAMES:
        model = f"closed form: {_NAMES[kind]}"
        return Plan(model, True, f"Taken: {model}; {frame}.\nNothing is cheaper.")
    model = "free puck, by similarity"
    why = (
        f"Taken: {model}; {frame}.\n"
        f"A closed form would be cheaper, but the motion is generic ({kind}).\n"
        "Integration in the laboratory would tell no more: nothing here breaks the similarity."
    )
    return Plan(model, True, why)


def _moving(scene: SceneSpec) -> list[str]:
    return ["moving floor"] if any(scene.floor.velocity) else []

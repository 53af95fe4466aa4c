"""What acts in a scene; how its pucks are moved, why so, and by which law they meet, in words."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

from puck_tables._core.fields import specs
from puck_tables.errors import PuckError
from puck_tables.scene.by_speed import laws_in
from puck_tables.scene.entries import entries
from puck_tables.scene.floor_parts import belts_of, has_laws_by_place
from puck_tables.scene.pucks_and_posts import ScenePuck
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.world.agreement import (
    TABLE_ERROR,
    frictions_under,
    has_closed_forms,
    is_integrated,
    segment_error,
)
from puck_tables.world.floors import may_be_mixed
from puck_tables.world.named_pucks import called, pucks_of
from puck_tables.world.obstacles import rule_of

_NAMED = 6  # pucks of one way
_CLOSER = f"closer than look-ups, which err by {TABLE_ERROR:g}"
_EMPIRICAL = (
    "The lateral force is empirical, as somebody fitted it: no dry friction over the contact "
    "explains it."
)
_OF_EACH = ("force", "constraint")
# entries that change no motion, or where it begins and ends, or whom it meets
_FREE = (
    "title", "puck", "launch", "time", "frames", "tol", "puck[]", "post", "arc", "pocket", "line",
    "rim",
)  # fmt: skip
_NOT_OF_EACH = (*_FREE, "wall", "edge", "gravity")
_ON_FLOOR = ("strips", "patches", "belts", "static friction")


def acting(scene: SceneSpec) -> list[str]:
    """What a scene says that acts beside dry friction, in its order.

    Raises PuckError if an entry of the scene does not say what acts with it: it would be left out.

    >>> from puck_tables import Drag, Puck, Scene
    >>> acting(Scene(Puck(1.0), drag=Drag(sliding=0.1)))
    ['drag']
    """
    kind: Any = type(scene)
    if stray := _stray(kind):
        raise PuckError(f"{', '.join(stray)}: the plan of a run knows no such ingredient")
    effects = (entry for entry in entries(scene) if entry.value is not None and entry.acts)
    there = list(dict.fromkeys(one.acts or "" for one in effects if one.value != one.default))
    if scene.constraint is not None:
        there[there.index("constraint")] = scene.constraint.kind
    return there


@lru_cache(maxsize=16)
def _stray(kind: Any) -> list[str]:
    """Entries that a scene, or a part of it, may have and that do not say what acts with them."""
    return [path for name in specs(kind) if name not in _FREE for path in _mute(kind, name, name)]


def _mute(kind: Any, name: str, path: str) -> list[str]:
    spec = specs(kind)[name]
    part = spec.metadata["kind"].part
    if part is None:
        return [path] if spec.metadata["acts"] is None else []
    return [one for inner in specs(part) for one in _mute(part, inner, f"{path}.{inner}")]


def plan_of(scene: SceneSpec) -> tuple[str, str]:
    """How the pucks of a scene are moved, in a line; and which they are and why, in lines of text.

    Raises PuckError if an entry of the scene does not say what acts with it: it would be left out.

    >>> from puck_tables import Floor, Launch, Puck, Scene
    >>> print(plan_of(Scene(Puck(0.1, friction=0.1), Floor(slope=0.05)))[1])
    1 puck integrated from impact to impact: slope
    a look-up would be cheaper: of round pucks on which only dry friction and a belt act
    """
    pucks = pucks_of(scene)
    methods: dict[str, list[str]] = {}
    known: dict[tuple[object, ...], str] = {}
    for number, puck in enumerate(pucks):
        force, hold = puck.force, puck.constraint
        key = (
            puck.radius, puck.height, puck.friction, puck.gravity, str(puck.pressure),
            puck.gyration, str(puck.base), force.constant, force.torque, bool(force.over_time),
            hold and hold.kind, bool(puck.path),
        )  # fmt: skip
        if key not in known:
            known[key] = _method_of(scene, puck)
        methods.setdefault(known[key], []).append(called(puck, number))
    lines = []
    for method, names in methods.items():
        shown = ""
        if len(methods) > 1:
            more = f" and {len(names) - _NAMED} more" if len(names) > _NAMED else ""
            shown = f" ({', '.join(names[:_NAMED])}{more})"
        lines.append(f"{len(names)} puck{'s' if len(names) != 1 else ''} {method}{shown}")
    model = ", ".join(lines)
    if any("integrated from" in one and not one.endswith(f": {_CLOSER}") for one in methods):
        lines.append(
            "a look-up would be cheaper: of round pucks on which only dry friction and a belt act"
        )
    if has_laws_by_place(scene.floor):
        lines.append(
            "friction by slip speed or direction differs by place, or goes by both: it is summed "
            "over every base wherever it lies, in every step along the contour of its parts, each "
            "by its own law, direction or number"
        )
    elif may_be_mixed(scene):
        piled = any(one.shape is None and one.body.law.profile is not None for one in pucks)
        lines.append(
            "while a base is astride several frictions, or over an edge, they are integrated over "
            f"its parts, about {'forty' if piled else 'ten'} times the cost of a step elsewhere"
        )
    if scene.floor.static_ratio > 1.0:
        lines.append(
            f"at rest friction holds {scene.floor.static_ratio:g} times what it brakes in a slip"
        )
    if scene.lateral.strength != 0.0:
        lines.append(_EMPIRICAL)
    if len(pucks) > 1 or scene.walls or scene.posts or scene.arcs:
        lines.append(rule_of(scene))
    return model, "\n".join(lines)


def _acting_on(scene: SceneSpec, puck: ScenePuck) -> list[str]:
    """What acts on a puck beside dry friction on a level floor that moves steadily or not at all.

    Raises PuckError as :func:`acting`.
    """
    one = scene.alone(puck)
    for name in specs(type(scene)):
        if name not in _NOT_OF_EACH:
            value = getattr(puck if name in _OF_EACH else scene, name)
            object.__setattr__(one, name, value)
    return [what for what in acting(one) if what not in _ON_FLOOR]


def _method_of(scene: SceneSpec, puck: ScenePuck) -> str:
    """How a puck is moved, and why it is not looked up."""
    acts = _acting_on(scene, puck)
    if puck.path:
        return "driven along a path"
    frictions = frictions_under(scene, puck)
    integrated = [is_integrated(scene, puck, friction) for friction in frictions]
    if any(integrated):
        if not all(has_closed_forms(puck, one) for one in frictions):
            acts.append("no closed forms")
        if puck.shape is not None:
            acts.append("a base that is not round")
        if laws_in(scene) and not scene.floor.law:
            acts.append("friction law")
        if segment_error(scene) < TABLE_ERROR:
            acts.append(_CLOSER)
        where = "" if all(integrated) else " on some of the floor"
        return f"integrated from impact to impact{where}: {', '.join(acts)}"
    if not any(frictions):
        return "in closed form, without dry friction"
    method = "looked up from impact to impact"
    if may_be_mixed(scene):
        method = "looked up from impact or border to the next, integrated astride or over an edge"
    return f"{method}, over the belt" if belts_of(scene.floor).any() else method

"""What is wrong with the floor of a scene: its friction, strips, belts, patches and motion."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from puck_tables.contact.friction_laws import NAMED, FrictionLaw
from puck_tables.contact.laws import Law
from puck_tables.contact.round_load import RoundLoad
from puck_tables.errors import InputError
from puck_tables.scene.floor_parts import (
    belt_faults,
    directions_in,
    has_belts,
    has_laws_by_place,
    has_sums,
    law_of,
)
from puck_tables.scene.floor_patches import patch_faults
from puck_tables.scene.orthotropic import LEAST_RATIO
from puck_tables.scene.over_time import (
    does_turn,
    drive_of,
    grip_faults,
    largest_factors,
    motion_of,
)
from puck_tables.scene.parts import Floor, Orthotropic

if TYPE_CHECKING:
    from puck_tables.scene.scene_spec import SceneSpec

_MOST_ROWS = 60  # of a tabulated pressure astride: each row adds to the cost of a look
_SLOWEST = 1e-9  # rad/s, of a turntable: what lies on a slower one meets a border after 1e10 s
_GRIPS = 1000.0  # the largest coefficient that a rim may come over


def floor_faults(scene: SceneSpec) -> list[str]:
    """What is wrong with the friction of the floor, under the puck."""
    faults = []
    if scene.floor.law and scene.floor.strips:
        faults.append(
            "floor.law and floor.strips: strips say all friction of the floor, each a number or a "
            "law of its own; give one of them"
        )
    faults += grip_faults(scene.floor) + belt_faults(scene.floor)
    faults += _bad_motion(scene.floor) + _bad_rows(scene)
    if faults:
        return faults
    faults += _bad_axes(scene.floor)
    if scene.puck.shape is not None:
        return faults + (bad_strips(scene.floor) or patch_faults(scene.floor))
    if has_laws_by_place(scene.floor) or scene.floor.orthotropic is not None:
        faults += _bad_load(scene)
    elif scene.floor.law:
        try:
            RoundLoad(scene.puck.body.law)
        except InputError as error:
            faults.append(f"floor.law: {error}")
    return faults + (bad_strips(scene.floor) or patch_faults(scene.floor) or _bad_mixed(scene))


def _bad_load(scene: SceneSpec) -> list[str]:
    """Why friction by place or direction that is no number is not known under a round load."""
    law = scene.puck.body.law
    if _is_linear(law):
        return []
    by_place = scene.floor.strips is not None or bool(scene.floor.patches)
    what = "floor.strips or floor.patch with a friction law" if by_place else "floor.orthotropic"
    return [
        f"{what}: known under uniform pressure only, over any base, not with puck.pressure = "
        f"{law.name!r}; leave it out{', or give numbers' if by_place else ''}"
    ]


def _is_linear(law: Law) -> bool:
    """Whether pressure is linear over the base, with or without a hole."""
    return law.name == "uniform" or law.name.startswith("annulus:")


def _bad_motion(floor: Floor) -> list[str]:
    """What is wrong with the motion of a floor."""
    if 0.0 < abs(floor.turning) < _SLOWEST:
        return [
            f"floor.turning = {floor.turning:g}: must be 0, or at least {_SLOWEST:g} rad/s either "
            "way, a turn in 200 years"
        ]
    if not floor.over_time:
        return []
    others = [name for name in ("velocity", "turning") if getattr(floor, name) not in (0.0, (0, 0))]
    others += ["strips or patches with velocities of their own"] * has_belts(floor)
    try:
        motion_of(floor)
    except InputError as error:
        return [f"floor.over_time: {str(error).removeprefix('floor.over_time ')}"]
    return [f"floor.over_time and floor.{name}: give one of them" for name in others]


def _strongest(scene: SceneSpec) -> float:
    """The largest coefficient that friction ever has under the puck, at rest too."""
    factors = largest_factors(scene.floor)
    return scene.floor.static_ratio * float((factors * scene.frictions).max())


def _bad_mixed(scene: SceneSpec) -> list[str]:
    """Why friction is not known that is summed over the base: on several, or over time."""
    floor, law = scene.floor, scene.puck.body.law
    if floor.law or floor.orthotropic is not None:
        return []
    if not has_sums(floor, scene.puck.height):
        return []
    name = "floor.strips" if floor.strips is not None else "floor.patch"
    name = "floor.static_ratio" if floor.static_ratio > 1.0 else name
    name = "floor.grip" if floor.grips else name
    if law.profile is not None and len(law.profile[0]) > _MOST_ROWS:
        return [
            f"{name}: friction that is summed over the base takes a tabulated puck.pressure of up "
            f"to {_MOST_ROWS} rows, it has {len(law.profile[0])}: give fewer"
        ]
    if _strongest(scene) > _GRIPS:
        return [
            f"{name}: a friction of {_strongest(scene):g} stops a rim within its first "
            f"micrometres, which takes minutes to follow; give at most {_GRIPS:g}"
        ]
    highest = 2.0 * _strongest(scene) * scene.puck.height / scene.puck.radius
    if highest > law.delta_max * (1.0 + 1e-12) and not _is_linear(law):
        return [
            f"{name}: friction that is summed over the base is known under puck.pressure = "
            f"{law.name!r} while that is loaded everywhere, delta = 2 f h / r up to "
            f"{law.delta_max:g}; its largest f makes {highest:g}: give uniform pressure, a lower "
            "puck.height or less friction"
        ]
    return []


def bad_strips(floor: Floor) -> list[str]:
    """What is wrong with the strips of a floor.

    >>> bad_strips(Floor())
    []
    """
    strips = floor.strips
    if strips is None:
        return []
    faults = []
    if len(strips.friction) != len(strips.borders) + 1 or not strips.borders:
        faults.append(
            f"floor.strips.friction = {list(strips.friction)}: must be one number more than "
            f"floor.strips.borders ({len(strips.borders)})"
        )
    if any(b <= a for a, b in zip(strips.borders, strips.borders[1:], strict=False)):
        faults.append(f"floor.strips.borders = {list(strips.borders)}: must ascend")
    return faults


def _bad_axes(floor: Floor) -> list[str]:
    """What is wrong with friction that depends on the direction."""
    faults = []
    if floor.orthotropic is not None and floor.law:
        faults.append(
            "floor.orthotropic and floor.law: friction by speed and direction is "
            "floor.orthotropic.law, its friction then factors of the law; leave floor.law out"
        )
    if floor.orthotropic is not None and floor.strips is not None:
        faults.append(
            "floor.orthotropic and floor.strips: strips say all friction of the floor, each may "
            "have a direction of its own; give one of them"
        )
    for name, two in directions_in(floor).items():
        if name != "floor.orthotropic" and two.fixed_to == "floor" and does_turn(floor):
            faults.append(
                f"{name}: not on a floor that turns, where borders stand still and its axes would "
                "not; leave one out"
            )
        if min(two.friction) < LEAST_RATIO * max(two.friction):
            faults.append(
                f"{name}.friction = {list(two.friction)}: one must be at least {LEAST_RATIO:g} of "
                "the other"
            )
    return faults


def _bad_rows(scene: SceneSpec) -> list[str]:
    """What is wrong with tables that stand in the scene; those in files are read when it runs."""
    faults = []
    law, force, strips = scene.floor.law, scene.force.over_time, scene.floor.strips
    tables: list[tuple[str, Any, Any]] = [("floor.law", law, law_of)]
    tables += [
        (f"floor.strips.friction[{k}]", one, law_of)
        for k, one in enumerate(strips.friction if strips else ())
    ]
    tables += [
        (f"floor.patch[{k}].friction", one.friction, law_of)
        for k, one in enumerate(scene.floor.patches)
    ]
    tables += [(f"{name}.law", two.law, law_of) for name, two in directions_in(scene.floor).items()]
    for name, rows, made in (*tables, ("force.over_time", force, drive_of)):
        if isinstance(rows, float | Orthotropic):
            continue
        if isinstance(rows, FrictionLaw):
            faults += [f"{name}: {fault}" for fault in rows.faults()]
        elif name.endswith(".law") and isinstance(rows, str) and rows in NAMED:
            faults.append(
                f"{name} = {rows!r}: a law by name is a table, {name}.kind = {rows!r} with "
                "its numbers ('puck scene fields' lists them)"
            )
        elif rows and not isinstance(rows, str):
            try:
                made(rows)
            except InputError as error:
                faults.append(str(error) if name in str(error) else f"{name}: {error}")
    return faults

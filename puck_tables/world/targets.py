"""What an aim on a board is at: which puck is sent off, and which is to end where."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import numpy.typing as npt

from puck_tables._core.arrays import finite_array
from puck_tables.errors import InputError
from puck_tables.scene.parts import Floor, Force
from puck_tables.scene.pucks_and_posts import ScenePuck
from puck_tables.scene.run import number_of
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.world.agreement import (
    TOUCH,
    called,
    disagreements,
    has_closed_forms,
    obstructing,
    pucks_of,
    refuse_endless,
    start_of,
)
from puck_tables.world.obstacles import obstacle_names

_LEAST_SHARE = 0.75  # of f m g, over the way of a puck with δ ≤ 1: what friction takes at least


class Target(NamedTuple):
    """The numbers of the striker, the puck, and of one to be hit (−1: any); where it is to end.

    ``place`` m: the centre of the pocket if ``pocket`` ≥ 0.
    """

    striker: int
    puck: int
    through: int
    place: tuple[float, float]
    pocket: int

    def obstacle(self, scene: SceneSpec) -> int:
        """The pocket as the engine calls it."""
        return -1 - obstacle_names(scene).index(f"pocket {self.pocket}")


def target_of(
    scene: SceneSpec, target: npt.ArrayLike | None, pocket: int | str | None,
    puck: int | str | None, striker: int | str | None, hits: int | str | None,
) -> Target:  # fmt: skip
    """The numbers of what a caller names.

    Raises
    ------
    InputError
        If there is no such thing, it is not clear which is meant, or nothing can lie there.
    """
    faults = disagreements(scene.single())
    if faults:
        raise InputError("\n  ".join(["aim on a board:", *faults]))
    refuse_endless(scene)
    if any(scene.floor.velocity) or scene.floor.turning != 0.0:
        raise InputError("aim is for boards on which pucks come to rest, not for a moving floor")
    pucks = pucks_of(scene)
    names = tuple(called(puck, number) for number, puck in enumerate(pucks))
    sent = _striker(pucks, names, striker)
    aimed = _puck(pucks, names, puck, sent)
    through = -1
    if hits is not None:
        through = number_of(hits, names)
        if through in (aimed, sent):
            itself = "the striker" if through == sent else "the puck that is to end there"
            raise InputError(f"hits = {names[through]}: this is {itself} itself, name another")
    if (target is None) == (pocket is None):
        given = "both are given" if target is not None else "neither is given"
        raise InputError(f"target or pocket says where {names[aimed]} is to end: {given}, give one")
    if pocket is not None:
        number = _pocket(scene, pocket)
        return Target(sent, aimed, through, scene.pockets[number].point, number)
    place = finite_array("target", target if target is not None else (), "m")
    if place.shape != (2,):
        raise InputError(f"target must be one place (x, y) in m, got shape {place.shape}")
    x, y = place.tolist()
    _refuse_where_nothing_lies(scene, (x, y), pucks[aimed].radius, names[aimed])
    return Target(sent, aimed, through, (x, y), -1)


def _striker(pucks: tuple[ScenePuck, ...], names: tuple[str, ...], wanted: int | str | None) -> int:
    """The puck that is named, or the one that the scene sends off."""
    if wanted is None:
        moving = [
            number for number, puck in enumerate(pucks)
            if puck.launch.velocity not in (None, (0.0, 0.0)) or puck.launch.spin != 0.0
        ]  # fmt: skip
        if len(pucks) == 1:
            moving = [0]
        if len(moving) != 1:
            which = "none" if not moving else ", ".join(names[number] for number in moving)
            raise InputError(
                f"striker: which puck is to be sent off? The scene sends off {which}: name one"
            )
        number = moving[0]
    else:
        number = number_of(wanted, names)
    _refuse_driven(pucks, names, number, "be sent off")
    hold = pucks[number].constraint
    if hold is not None:
        raise InputError(
            f"striker {names[number]} is led by a {hold.kind}: aim is for pucks that go where they "
            "are sent"
        )
    if pucks[number].launch.time > 0.0:
        raise InputError(
            f"striker {names[number]} is sent off at {pucks[number].launch.time:g} s: aim is for "
            "launches at the start, set its launch.time to 0"
        )
    return number


def _puck(
    pucks: tuple[ScenePuck, ...], names: tuple[str, ...], wanted: int | str | None, striker: int
) -> int:
    """The puck that is named, or the only one that can be meant."""
    others = [n for n, puck in enumerate(pucks) if n != striker and not puck.path]
    if wanted is None:
        if len(others) > 1:
            raise InputError(
                f"puck: which is to end there? Name one of the {len(pucks)}, such as "
                f"{names[others[0]]}, or {names[striker]} itself"
            )
        return others[0] if others else striker
    number = number_of(wanted, names)
    _refuse_driven(pucks, names, number, "be aimed")
    return number


def _refuse_driven(
    pucks: tuple[ScenePuck, ...], names: tuple[str, ...], number: int, what: str
) -> None:
    if pucks[number].path:
        raise InputError(
            f"{names[number]} is driven along its path and cannot {what}: name another"
        )


def _pocket(scene: SceneSpec, wanted: int | str) -> int:
    """The number of a pocket, from itself or from 'pocket 2'."""
    count = len(scene.pockets)
    if not count:
        raise InputError("pocket: the board has none; give a target (x, y), or add [[pocket]]")
    text = str(wanted).removeprefix("pocket ").strip()
    if isinstance(wanted, bool) or not text.isascii() or not text.isdecimal() or int(text) >= count:
        numbers = "one, 0" if count == 1 else f"{count}, from 0 to {count - 1}"
        raise InputError(f"no pocket {wanted!r}: the board has {numbers}")
    return int(text)


def _refuse_where_nothing_lies(
    scene: SceneSpec, place: tuple[float, float], radius: float, name: str
) -> None:
    """Refuse a place in a cushion, a post, a pocket or over an edge."""
    for path, what, depth in obstructing(scene, place, radius, holes=True):
        hint = f", or ask for pocket {path[7:-1]}" if path.startswith("pocket") else ""
        raise InputError(
            f"target {list(place)}: {name} cannot rest there, with {path} in the way it {what} by "
            f"{depth:.3g} m: choose another place{hint}"
        )


def lying_there(scene: SceneSpec, target: Target) -> str:
    """Who lies so close to the target that it would have to be moved away; '' if nobody does."""
    pucks = pucks_of(scene)
    radius = pucks[target.puck].radius
    for number, puck in enumerate(pucks):
        if number in (target.puck, target.striker) or target.pocket >= 0 or puck.path:
            continue
        if math.dist(start_of(puck), target.place) < (radius + puck.radius) * (1.0 - TOUCH):
            return called(puck, number)
    return ""


def without_pocket(scene: SceneSpec, target: Target) -> SceneSpec | None:
    """The board without the pocket aimed at, None if none is.

    Launches that stop where its middle was fall in, also where few do.
    """
    if target.pocket < 0:
        return None
    left = scene.pockets[: target.pocket] + scene.pockets[target.pocket + 1 :]
    return replace(scene, pockets=left)


def out_of_reach(scene: SceneSpec, target: Target, speed: float, spin: float) -> str:
    """Why no launch up to a speed and spin can exist, in words; '' where that is not known.

    Friction takes at least f m g times the way that the mean slip of the base goes, and that is no
    shorter than (1 − δ²/4) of the way of the centre: 3/4 of it for a plain puck with δ ≤ 1, all of
    it for a flat one on any base.  No impact gives energy.
    """
    pucks = pucks_of(scene)
    striker, puck = pucks[target.striker], pucks[target.puck]
    others = [puck for number, puck in enumerate(pucks) if number != target.striker]
    at_rest = not any(
        one.path or one.launch.velocity not in (None, (0.0, 0.0)) or one.launch.spin
        for one in others
    )
    plain = all(
        one.height == 0.0 if one.shape is not None
        else has_closed_forms(one, one.friction) and one.delta <= 1.0
        for one in (striker, puck)
    )  # fmt: skip
    pushed = scene.floor != Floor() or any(one.force != Force() for one in pucks)
    if not (at_rest and plain) or pushed:
        return ""
    way = math.dist(start_of(puck), target.place)
    if target.pocket >= 0:
        way = max(way - scene.pockets[target.pocket].radius, 0.0)
    ways = [(puck, way)]
    if target.puck != target.striker:
        gaps = (
            math.dist(start_of(striker), start_of(one)) - striker.radius - one.radius
            for one in others
        )
        ways.append((striker, max(min(gaps), 0.0)))
    needed = sum(_LEAST_SHARE * one.decel * one.mass * length for one, length in ways)
    rim = striker.inertia_radius * spin
    given = 0.5 * striker.mass * (speed * speed + rim * rim)
    if given >= needed:
        return ""
    return (
        f"exists: friction takes at least {needed:.4g} J until {puck.name or 'the puck'} is there, "
        f"and such a launch has at most {given:.4g} J"
    )

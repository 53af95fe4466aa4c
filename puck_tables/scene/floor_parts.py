"""The stretches of a floor that may have friction and a velocity of their own: strips, patches."""

from __future__ import annotations

import math
import re
from bisect import bisect_right
from dataclasses import replace
from typing import Any

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.contact.friction_laws import FrictionLaw
from puck_tables.contact.speed_law import SpeedLaw
from puck_tables.errors import InputError
from puck_tables.scene.floor_patches import corners_of
from puck_tables.scene.parts import Floor, Orthotropic, Patch, Rows, Strips

Friction = float | SpeedLaw | FrictionLaw | Orthotropic

_WHERE = re.compile(r"(strip|patch) (\d+)")


def needs_sums(floor: Floor, height: float) -> bool:
    """Whether friction under a round puck changes with more than its slip: it is summed.

    >>> needs_sums(Floor(static_ratio=1.5), 0.0), needs_sums(Floor(static_ratio=1.5), 0.02)
    (False, True)
    """
    tilts = floor.static_ratio > 1.0 and height > 0.0
    return bool(floor.grips) or tilts or has_laws_by_place(floor)


def has_sums(floor: Floor, height: float) -> bool:
    """Whether friction under a round puck is summed over its base anywhere, by coefficients.

    >>> has_sums(Floor(), 0.02), has_sums(Floor(strips=Strips((0.0,), (0.1, 0.2))), 0.0)
    (False, True)
    """
    return floor.strips is not None or bool(floor.patches) or needs_sums(floor, height)


def law_of(entry: str | Rows | FrictionLaw) -> SpeedLaw | FrictionLaw:
    """A friction law by name, or of rows of slip speed and coefficient, or of a file of them.

    Raises
    ------
    InputError
        If it is none.
    """
    if isinstance(entry, FrictionLaw):
        return entry
    if isinstance(entry, str):
        return SpeedLaw.from_csv(entry)
    if any(len(row) != 2 for row in entry):
        raise InputError("each row must be two numbers, slip speed in m/s and f")
    speeds, values = zip(*entry, strict=True)
    return SpeedLaw(speeds, values)


def frictions_on(floor: Floor, own: float) -> list[Friction]:
    """The friction of all stretches; ``own``: of a puck, where the floor has none.

    Raises InputError if one is no law.

    >>> frictions_on(Floor(patches=(Patch(0.1, radius=1.0),)), 0.2)
    [0.2, 0.1]
    """
    strips, first = floor.strips, law_of(floor.law) if floor.law else floor.orthotropic or own
    frictions: list[Any] = [first] if strips is None else list(strips.friction)
    frictions += [patch.friction for patch in floor.patches]
    return [_read(one) for one in frictions]


def _read(friction: Any) -> Friction:
    """A friction whose law is read."""
    if isinstance(friction, Orthotropic) and friction.law:
        law: Any = law_of(friction.law)
        return replace(friction, law=law)
    return law_of(friction) if isinstance(friction, tuple) else friction


def largest_of(friction: Friction, top: float) -> float:
    """The largest coefficient of a friction up to a slip speed, m/s.

    >>> largest_of(0.2, 1.0)
    0.2
    """
    return friction if isinstance(friction, float) else friction.largest(top)


def has_laws_by_place(floor: Floor) -> bool:
    """Whether friction is summed over every base wherever it lies, by laws and directions.

    Where strips or patches stand beside a law, by slip speed or direction, or have their own, and
    where one goes by both.

    >>> has_laws_by_place(Floor(patches=(Patch(((0.0, 0.1), (1.0, 0.2)), radius=1.0),)))
    True
    """
    frictions = () if floor.strips is None else floor.strips.friction
    own = any(
        not isinstance(one, float) for one in (*frictions, *(p.friction for p in floor.patches))
    )
    both = floor.orthotropic is not None and bool(floor.orthotropic.law)
    return own or both or bool((floor.law or floor.orthotropic) and floor.patches)


def directions_in(floor: Floor) -> dict[str, Orthotropic]:
    """Where friction goes by the direction, by what these are called in a message.

    >>> list(directions_in(Floor(patches=(Patch(Orthotropic((0.1, 0.2)), radius=1.0),))))
    ['floor.patch[0].friction']
    """
    strips = () if floor.strips is None else floor.strips.friction
    directions = {
        "floor.orthotropic": floor.orthotropic,
        **{f"floor.strips.friction[{k}]": one for k, one in enumerate(strips)},
        **{f"floor.patch[{k}].friction": one.friction for k, one in enumerate(floor.patches)},
    }
    return {name: one for name, one in directions.items() if isinstance(one, Orthotropic)}


def count_parts(floor: Floor) -> int:
    """How many there are; all of a floor without strips is one.

    >>> count_parts(Floor())
    1
    """
    return (1 if floor.strips is None else len(floor.strips.friction)) + len(floor.patches)


def floor_part(floor: Floor, where: str) -> int:
    """The number of the stretch of a floor that is called so; −1: all of it.

    Raises InputError if there is none.

    >>> floor_part(Floor(), "floor")
    -1
    """
    if where == "floor":
        return -1
    match, strips = _WHERE.fullmatch(where), floor.strips
    there = {
        "strip": 0 if strips is None else len(strips.friction), "patch": len(floor.patches),
    }  # fmt: skip
    if match is None or not int(match[2]) < there[match[1]]:
        known = ["'floor'"]
        for name, count in there.items():
            last = f" to '{name} {count - 1}'" if count > 1 else ""
            known += [f"'{name} 0'{last}"] * (count > 0)
        raise InputError(f"where = {where!r}: must be {' or '.join(known)}")
    before = count_parts(floor) - len(floor.patches) if match[1] == "patch" else 0
    return before + int(match[2])


def belts_of(floor: Floor) -> FloatArray:
    """The velocities (n, 2) of all stretches, m/s; on a turntable that of its centre.

    >>> belts_of(Floor(strips=Strips((0.0,), (0.1, 0.1), across=(0.5, 0.2)))).tolist()
    [[0.5, 0.0], [0.2, 0.0]]
    """
    strips = floor.strips
    velocities = np.tile(np.array(floor.velocity), (count_parts(floor), 1))
    if strips is not None and (strips.across or strips.along):
        c, s = math.cos(strips.direction), math.sin(strips.direction)
        for k in range(len(strips.friction)):
            across = strips.across[k] if strips.across else 0.0
            along = strips.along[k] if strips.along else 0.0
            velocities[k] = across * c - along * s, across * s + along * c
    first = len(velocities) - len(floor.patches)
    for k, patch in enumerate(floor.patches):
        around = velocities[_strip_under(patch, strips)]
        velocities[first + k] = around if patch.velocity is None else patch.velocity
    return velocities


def _strip_under(patch: Patch, strips: Strips | None) -> int:
    """The strip on which a patch lies."""
    if strips is None:
        return 0
    places = corners_of(patch)
    x, y = places.mean(axis=0).tolist() if len(places) else patch.centre
    place = math.cos(strips.direction) * x + math.sin(strips.direction) * y
    return bisect_right(strips.borders, place)


def has_belts(floor: Floor) -> bool:
    """Whether its stretches move with velocities that differ.

    >>> has_belts(Floor(velocity=(0.5, 0.0)))
    False
    """
    velocities = belts_of(floor)
    return bool((velocities != velocities[0]).any())


def belt_faults(floor: Floor) -> list[str]:
    """What is wrong with the velocities of strips and patches.

    >>> belt_faults(Floor(strips=Strips((0.0,), (0.1, 0.1), across=(0.5,))))
    ['floor.strips.across = [0.5]: must be one number for each of 2 strips']
    """
    strips, faults, own = floor.strips, [], ""
    for name in ("across", "along") if strips is not None else ():
        speeds = getattr(strips, name)
        if speeds:
            own = f"floor.strips.{name}"
        if strips is not None and speeds and len(speeds) != len(strips.friction):
            faults.append(
                f"floor.strips.{name} = {list(speeds)}: must be one number for each of "
                f"{len(strips.friction)} strips"
            )
    if own and any(floor.velocity):
        faults.append(f"{own} and floor.velocity: strips have one velocity, give one of them")
    for k, patch in enumerate(floor.patches):
        own = own if patch.velocity is None else f"floor.patch[{k}].velocity"
    if own and floor.turning != 0.0:
        faults.append(f"{own}: not on a floor that turns, floor.turning; leave one out")
    return faults

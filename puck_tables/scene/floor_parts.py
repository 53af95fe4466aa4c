"""The stretches of a floor that may have friction and a velocity of their own: strips, patches."""

from __future__ import annotations

import math
import re
from bisect import bisect_right

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.errors import InputError
from puck_tables.scene.floor_patches import corners_of
from puck_tables.scene.parts import Floor, Patch, Strips

_WHERE = re.compile(r"(strip|patch) (\d+)")


def needs_sums(floor: Floor, height: float) -> bool:
    """Whether friction under a round puck changes with more than its slip: it is summed.

    Examples
    --------
    >>> needs_sums(Floor(static_ratio=1.5), 0.0), needs_sums(Floor(static_ratio=1.5), 0.02)
    (False, True)
    """
    return bool(floor.grips) or (floor.static_ratio > 1.0 and height > 0.0)


def count_parts(floor: Floor) -> int:
    """How many there are; all of a floor without strips is one.

    Examples
    --------
    >>> count_parts(Floor())
    1
    """
    return (1 if floor.strips is None else len(floor.strips.friction)) + len(floor.patches)


def floor_part(floor: Floor, where: str) -> int:
    """The number of the stretch of a floor that is called so; −1: all of it.

    Raises
    ------
    InputError
        If there is none.

    Examples
    --------
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

    Examples
    --------
    >>> belts_of(Floor(strips=Strips((0.0,), (0.1, 0.1), across=(0.5, 0.2)))).tolist()
    [[0.5, 0.0], [0.2, 0.0]]
    """
    strips = floor.strips
    found = np.tile(np.array(floor.velocity), (count_parts(floor), 1))
    if strips is not None and (strips.across or strips.along):
        c, s = math.cos(strips.direction), math.sin(strips.direction)
        for k in range(len(strips.friction)):
            across = strips.across[k] if strips.across else 0.0
            along = strips.along[k] if strips.along else 0.0
            found[k] = across * c - along * s, across * s + along * c
    first = len(found) - len(floor.patches)
    for k, patch in enumerate(floor.patches):
        around = found[_strip_under(patch, strips)]
        found[first + k] = around if patch.velocity is None else patch.velocity
    return found


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

    Examples
    --------
    >>> has_belts(Floor(velocity=(0.5, 0.0)))
    False
    """
    found = belts_of(floor)
    return bool((found != found[0]).any())


def belt_faults(floor: Floor) -> list[str]:
    """What is wrong with the velocities of strips and patches.

    Examples
    --------
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

"""Stops over ranges of whatever a launch or a puck has, and of launches that scatter."""

from __future__ import annotations

from collections.abc import Container, Mapping
from typing import Any

import numpy as np

from puck_tables._core.arrays import one_velocity
from puck_tables._core.own_folder import say
from puck_tables.bulk.finish import Doing, finish
from puck_tables.bulk.spreads import checked_samples
from puck_tables.errors import InputError
from puck_tables.result import Result
from puck_tables.stopping.population import COLUMN, Population, drawn, labelled, ranged
from puck_tables.stopping.sweep_work import By, StopWork

DEFAULT_SPEED = np.linspace(0.0, 2.0, 41)
DEFAULT_SPIN = np.linspace(-4.0, 4.0, 41)


def sweep(puck: Any, chosen: Mapping[str, Any], launches: Any, by: By, how: Doing) -> Result:
    """Stops of all combinations of numbers: :meth:`puck_tables.Puck.sweep`; ``by``: computed so."""
    numbers = numbers_of(puck, chosen)
    if launches is None:
        if not {"spin", "speed", "vx", "vy"} & numbers.keys():
            scale = 1.0 if puck.shape is None else 2.0 * puck.inertia_radius
            numbers |= {"spin": DEFAULT_SPIN / scale, "speed": DEFAULT_SPEED}
        laws = numbers.pop("pressure", puck.pressure)
        return _done(puck, ranged(_whole(puck, numbers, numbers), laws), by, how)
    if not (hasattr(launches, "variables") and hasattr(launches, "sizes")):
        raise InputError("launches must be an xarray.Dataset, with variables such as launch_spin")
    laws = numbers.pop("pressure", puck.pressure)
    names = {*numbers, *(argument for argument, column in COLUMN.items()
                         if column in launches.variables)}  # fmt: skip
    read = set(COLUMN.values())
    if unread := [str(name) for name in launches.data_vars if name not in read]:
        say(f"launches: variables not read: {', '.join(unread)[:400]}")
    return _done(puck, labelled(launches, _whole(puck, numbers, names), laws), by, how)


def sample(
    puck: Any, count: int, seed: int, chosen: Mapping[str, Any], by: By, how: Doing
) -> Result:
    """Stops of launches that scatter: :meth:`puck_tables.Puck.sample`."""
    count, seed = checked_samples(count, seed)
    numbers = numbers_of(puck, chosen)
    laws = numbers.pop("pressure", puck.pressure)
    return _done(puck, drawn(_whole(puck, numbers, numbers), laws, count, seed), by, how)


def numbers_of(puck: Any, chosen: Mapping[str, Any]) -> dict[str, Any]:
    """What was given, by the names of arguments; a velocity by its components."""
    numbers = {name: value for name, value in chosen.items() if value is not None}
    _refuse_of_round(puck, numbers)
    if "velocity" in numbers:
        if {"speed", "heading", "vx", "vy"} & numbers.keys():
            raise InputError(
                "velocity and speed both give the velocity (and heading, vx, vy): give one of them"
            )
        numbers["vx"], numbers["vy"] = one_velocity(numbers.pop("velocity"))
    return numbers


def _whole(puck: Any, numbers: Mapping[str, Any], names: Container[str]) -> dict[str, Any]:
    """The numbers given, of arguments of these names, and what else a launch needs."""
    if "friction" not in names:
        puck.refuse_unless_free()
    whole: dict[str, Any] = {}
    if not any(name in names for name in ("speed", "vx", "vy")):
        whole["speed"] = 1.0
    elif "vx" in names and "vy" not in names:
        whole["vy"] = 0.0
    elif "vy" in names and "vx" not in names:
        whole["vx"] = 0.0
    whole |= {} if "spin" in names else {"spin": 0.0}
    if puck.shape is not None:
        return {**whole, **_on_base(puck, names), **numbers}
    whole |= {} if "radius" in names else {"radius": puck.radius}
    dimensions = [name in names for name in ("height", "friction", "radius")]
    if "delta" not in names:
        name = "height" if any(dimensions) else "delta"
        whole |= {} if name in names else {name: getattr(puck, name)}
    if "decel" not in names:
        name = "gravity" if "friction" in names or "gravity" in names else "decel"
        whole |= {} if name in names else {name: getattr(puck, name)}
    real = any(one in names or one in {*whole, *numbers} for one in ("height", "gravity"))
    if real and "friction" not in names:
        whole["friction"] = puck.friction
    return {**whole, **numbers}


def _on_base(puck: Any, names: Container[str]) -> dict[str, Any]:
    """What else a launch of a puck on a base needs; what it cannot have is refused."""
    _refuse_of_round(puck, names)
    whole = {name: getattr(puck, name) for name in ("height", "friction") if name not in names}
    if "decel" not in names and "gravity" not in names:
        name = "gravity" if "friction" in names else "decel"
        whole[name] = getattr(puck, name)
    return whole


def _refuse_of_round(puck: Any, names: Container[str]) -> None:
    """Refuse numbers that a puck on a base does not have, or has once for all."""
    for name in ("radius", "delta", "pressure", "gyration"):
        if name in names:
            puck.refuse_base(f"{name} of a sweep or a sample")


def _done(puck: Any, launches: Population, by: By, how: Doing) -> Result:
    """The result, or what stands in the store."""
    found: Result = finish(StopWork(launches, puck, by, how.chunk), how)
    return found

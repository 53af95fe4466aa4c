"""Ranges of a scene: what they are of, and batches of launches among them."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables._core.reading import MAX_COUNT, Range, Reading, read_values
from puck_tables.errors import InputError
from puck_tables.scene.entries import LAUNCH, is_batch
from puck_tables.scene.parts import Launch


class Ranges(dict[str, Any]):
    """Ranges, and the parts of the scene that they are of."""

    def __init__(self, axes: Mapping[str, FloatArray], parts: Mapping[str, Any]) -> None:
        super().__init__(axes)
        self.parts = parts

    def __reduce__(self) -> Any:
        return Ranges, (dict(self), self.parts)

    def of_the_same(self, parts: Mapping[str, Any]) -> dict[str, FloatArray]:
        """Without those of parts that another scene has replaced."""
        kept = [name for name, part in parts.items() if part is self.parts.get(name)]
        return {path: one for path, one in self.items() if re.split(r"[.\[]", path)[0] in kept}


def refuse_twice(kind: type, tables: Mapping[str, Any], ranges: Any) -> None:
    """Refuse ranges that are none, or of numbers that are lists already."""
    if not isinstance(ranges, Mapping) or not all(isinstance(path, str) for path in ranges):
        raise InputError("ranges must be a mapping from paths such as 'launch.spin' to values")
    if ranges:
        reading = Reading([], {})
        read_values(kind, tables, "", reading)
        listed = {*(reading.ranges or {}), *reading.batches}
        many = [path for path in ranges if is_batch(path) and reading.batches]
        twice = [path for path in ranges if path in listed] + many
        if twice:
            raise InputError(f"{', '.join(twice)}: given as a list and in ranges: give one of them")


def batch_of(
    pairs: Mapping[str, FloatArray], ranges: dict[str, Range], errors: list[str]
) -> dict[str, FloatArray]:
    """What belongs to many launches, by path; it is no range of its own then."""
    if not pairs:
        return {}
    owners = sorted({owner_of(path) for path in pairs})
    if len(owners) > 1:
        errors.append(
            f"{', '.join(pairs)}: many launches at once are of one puck, the others have one each"
        )
        return {}
    count = len(next(iter(pairs.values())))
    if count > MAX_COUNT:
        errors.append(f"{count} launches: at most {MAX_COUNT} in one scene")
    numbers: dict[str, FloatArray] = {
        path: ranges.pop(path).numbers()
        for path in (f"{owners[0]}.spin", f"{owners[0]}.orientation")
        if path in ranges and ranges[path].listed
    }
    batch: dict[str, FloatArray] = {**pairs, **numbers}
    for path, values in batch.items():
        if len(values) != count:
            errors.append(
                f"{path}: {len(values)} values for {count} launches: give one for each, or a range "
                "'START:STOP:COUNT' for all of them"
            )
    return batch


def owner_of(path: str) -> str:
    """The axis of many launches that an entry of a launch belongs to.

    >>> owner_of("puck[1].launch.velocity")
    'puck[1].launch'
    """
    return path.rpartition(".")[0]


def launch_rows(launch: Launch, batch: Mapping[str, FloatArray], owner: str) -> FloatArray:
    """Rows of vx, vy, spin, x, y, orientation, array (n, 6), of the axis ``owner``."""
    rows = np.empty((len(next(iter(batch.values()))), len(LAUNCH)))
    rows[:, 0:2] = batch.get(f"{owner}.velocity", launch.velocity or (0.0, 0.0))
    rows[:, 2] = batch.get(f"{owner}.spin", launch.spin)
    rows[:, 3:5] = batch.get(f"{owner}.position", launch.position)
    rows[:, 5] = batch.get(f"{owner}.orientation", launch.orientation)
    return rows

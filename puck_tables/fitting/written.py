"""What a fit found, as columns of a file and as JSON."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from puck_tables.fitting.estimate import Estimate
from puck_tables.fitting.numbers import FoundLaunch, Number
from puck_tables.fitting.tied import Impact
from puck_tables.io.dataset import Variable, variable

_FRAMES = (
    "track", "frame", "time", "seen_x", "seen_y", "seen_angle", "fit_x", "fit_y", "fit_angle",
    "counts_place", "counts_angle",
)  # fmt: skip


def frames_of(found: Estimate) -> dict[str, Variable]:
    """Columns of all frames: what was seen, the model, and whether it counts."""
    problem, kept = found.problem, found.kept
    rows: dict[str, list[Any]] = {name: [] for name in _FRAMES}
    parts = zip(problem.films, problem.paths(found.x), problem.each(), strict=True)
    for n, (film, path, (x, _, turn)) in enumerate(parts):
        angle = np.full(film.time.size, np.nan) if film.angle is None else film.angle
        counts = np.zeros(film.time.size, np.int8)
        counts[np.isfinite(angle)] = kept[turn]
        values = (
            np.full(film.time.size, n), film.frame, film.start + film.time, film.place[:, 0],
            film.place[:, 1], angle, path[0], path[1], path[2], kept[x].astype(np.int8), counts,
        )  # fmt: skip
        for name, value in zip(rows, values, strict=True):
            rows[name].append(value)
    return {
        name: variable(name, np.concatenate(values), ("observation",))
        for name, values in rows.items()
    }


def numbers_told(numbers: Mapping[str, Number]) -> dict[str, Variable]:
    """Columns of the numbers of the puck."""
    known = {name: number for name, number in numbers.items() if math.isfinite(number.value)}
    columns = {"number_name": variable("number_name", list(known), ("number",))}
    for what in ("value", "error", "low", "high"):
        of_all = np.array([getattr(number, what) for number in known.values()])
        columns[f"number_{what}"] = variable(f"number_{what}", of_all, ("number",))
    return columns


def told(number: Number) -> dict[str, Any]:
    """A number as JSON has it."""
    return {**number._asdict(), "determined": number.determined, "at_bound": number.at_bound}


def launch_told(one: FoundLaunch) -> dict[str, Any]:
    """A launch as JSON has it."""
    return {
        "track": one.name, "time": one.time, "place": list(one.place),
        "velocity": list(one.velocity), "spin": one.spin, "angle": one.angle,
        "numbers": {name: told(number) for name, number in one.numbers.items()},
    }  # fmt: skip


def impact_told(one: Impact) -> dict[str, Any]:
    """An impact as JSON has it."""
    return {
        **one._asdict(), "place": list(one.place), "restitution": told(one.restitution),
        "rim": told(one.rim),
        "mass_ratio": None if one.mass_ratio is None else told(one.mass_ratio),
    }  # fmt: skip


def without_nan(value: Any) -> Any:
    """The same with None for what is no number: JSON has none."""
    if isinstance(value, dict):
        return {name: without_nan(one) for name, one in value.items()}
    if isinstance(value, list | tuple):
        return [without_nan(one) for one in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    if isinstance(value, np.bool_):
        return bool(value)
    return value

"""What a fit found, as columns of a file and as JSON, and read back from its JSON file."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from puck_tables._core.arrays import one_velocity, real
from puck_tables._core.safe_read import read_whole
from puck_tables.errors import InputError
from puck_tables.fitting.estimate import Estimate
from puck_tables.fitting.numbers import EstimatedLaunch, Number
from puck_tables.fitting.parameters import INTEGRATED
from puck_tables.io.columns import Variable, variable
from puck_tables.puck import Puck

KIND = "puck-tables fit 1"
_ENTRIES = {  # of a scene, that have what a free puck has not
    "drag": "drag.sliding and drag.spinning", "air": "drag.quadratic (air times mass)",
    "spin_drag": "drag.spinning", "slope_x": "floor.slope", "slope_y": "floor.slope",
    "belt_x": "floor.velocity", "belt_y": "floor.velocity", "friction_rest": "floor.law",
    "law_speed": "floor.law",
}  # fmt: skip
_FRAMES = (
    "track", "frame", "time", "seen_x", "seen_y", "seen_angle", "fit_x", "fit_y", "fit_angle",
    "counts_place", "counts_angle",
)  # fmt: skip


def frames_of(result: Estimate) -> dict[str, Variable]:
    """Columns of all frames: what was seen, the model, and whether it counts."""
    problem, kept = result.problem, result.kept
    rows: dict[str, list[Any]] = {name: [] for name in _FRAMES}
    parts = zip(problem.films, problem.paths(result.x), problem.each(), strict=True)
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


def numbers_as_json(numbers: Mapping[str, Number]) -> dict[str, Variable]:
    """Columns of the numbers of the puck."""
    known = {name: number for name, number in numbers.items() if math.isfinite(number.value)}
    columns = {"number_name": variable("number_name", list(known), ("number",))}
    for what in ("value", "error", "low", "high"):
        of_all = np.array([getattr(number, what) for number in known.values()])
        columns[f"number_{what}"] = variable(f"number_{what}", of_all, ("number",))
    return columns


def as_json(value: Any) -> Any:
    """What JSON holds of a result, by names, with None for NaN and infinity: JSON has none."""
    if isinstance(value, Number):
        value = {**value._asdict(), "determined": value.determined, "at_bound": value.at_bound}
    elif isinstance(value, EstimatedLaunch):
        value = {"track": value.name, **value._asdict()}
        del value["name"]
    elif hasattr(value, "_asdict"):
        value = value._asdict()
    if isinstance(value, dict):
        return {name: as_json(one) for name, one in value.items()}
    if isinstance(value, list | tuple):
        return [as_json(one) for one in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return bool(value) if isinstance(value, np.bool_) else value


_LARGEST = 1 << 26  # bytes
_PUCK = ("height", "friction", "mass", "gravity", "gyration")


def puck_and_launch(
    path: str | Path, track: str | None = None
) -> tuple[Puck, dict[str, Any], tuple[str, ...]]:
    """The puck, and how it was launched, of a track in a file of ``puck fit -o fit.json``.

    That is the velocity (m/s), the spin (rad/s) and, on a base that is not round, the orientation
    (rad) of :meth:`Puck.simulate`.  And sentences on what its tracks did not determine, and on what
    is hard to believe.

    ``path``: .json; ``track``: its name or number, where the file has several.  Raises InputError
    if the file is none of a fit, has no such track, its puck has drag or friction over slip speed,
    or nobody would believe what was found.
    """
    fault = f"{path}: no file of puck fit (.json)"
    try:
        data: Any = json.loads(read_whole(path, _LARGEST))
    except (ValueError, RecursionError):
        raise InputError(fault) from None
    kind = data.get("kind") if isinstance(data, dict) else None
    if isinstance(kind, str) and kind != KIND and kind.startswith(KIND[:-1]):
        raise InputError(f"{path} is of {kind:.40}, and this version reads {KIND}: fit again")
    if kind != KIND:
        raise InputError(fault)
    try:
        launches = {str(one["track"]): one for one in data["launches"]}
        contact = ("base",) if "base" in data["puck"] else ("radius", "pressure")
        puck = Puck(**{name: data["puck"][name] for name in (*contact, *_PUCK)})
        drags = {
            name: real(name, data["numbers"][name]["value"], "")
            for name in ("drag", *INTEGRATED) if name in data["numbers"]
        }  # fmt: skip
        chosen = launches[_chosen(list(launches), track, path)]
        launch: dict[str, Any] = {
            "velocity": one_velocity(chosen["velocity"]),
            "spin": real("spin", chosen["spin"], "rad/s"),
        }
        if puck.shape is not None:
            launch["orientation"] = real("angle", chosen["angle"], "rad")
        unknown = tuple(str(one) for one in (*data["not_determined"], *data["doubts"]))
        astray, speeds = str(data["astray"]), [*data["slip_speeds"]]
    except (KeyError, TypeError, AttributeError):
        raise InputError(fault) from None
    refuse_unplayable(drags, speeds, astray, f"{path}: ")
    return puck, launch, unknown


def refuse_unplayable(
    drags: Mapping[str, float], speeds: Sequence[float], astray: str, where: str = ""
) -> None:
    """Refuse a puck that nobody would believe, or whose motion no free puck has.

    ``drags``: values of drag and :data:`INTEGRATED`; ``speeds``: slip speeds at which friction was
    found; ``astray``: why nobody would believe it; ``where``: what begins the sentence.
    """
    if astray:
        raise InputError(f"{where}{astray}: there is nothing to play")
    entries = {"friction over slip speed": "floor.law"} if speeds else {}
    entries |= {f"{n} of {one:.3g}": _ENTRIES[n] for n, one in drags.items() if one != 0.0}
    for what, entry in entries.items():
        raise InputError(
            f"{where}the puck was found with {what}, which a free puck has not: make a scene of "
            f"it, with {entry}"
        )


def _chosen(names: list[str], track: str | None, path: str | Path) -> str:
    """The name of a track."""
    listed = ", ".join(names)
    if track is None:
        if len(names) != 1:
            raise InputError(f"{path} has {len(names)} tracks: say which (--track): {listed}")
        return names[0]
    if track in names:
        return track
    if track.isascii() and track.isdigit() and 1 <= int(track) <= len(names):
        return names[int(track) - 1]
    raise InputError(f"{path} has no track '{track}': there are {listed}")

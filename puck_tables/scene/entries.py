"""The entries of a scene one by one: what they are, and the scene as tables again."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Iterator, Mapping
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from puck_tables._core.arrays import finite_array, shown
from puck_tables._core.fields import Kind, Unsaid, in_tables, specs
from puck_tables.errors import InputError

BATCH = "launch"  # the axis of many launches
# what a launch is, in the order of the columns of a batch
LAUNCH = (
    "launch.velocity[0]", "launch.velocity[1]", "launch.spin", "launch.position[0]",
    "launch.position[1]", "launch.orientation",
)  # fmt: skip


def is_batch(path: str) -> bool:
    """Whether an axis is one of many launches, of the puck or of one of several.

    >>> is_batch("launch"), is_batch("puck[2].launch"), is_batch("launch.spin")
    (True, True, False)
    """
    return path == BATCH or path.endswith(f"].{BATCH}")


def launch_paths(batch: str) -> tuple[str, ...]:
    """What a launch of such an axis is, in the order of its columns.

    >>> launch_paths("puck[0].launch")[2]
    'puck[0].launch.spin'
    """
    return tuple(batch.removesuffix(BATCH) + path for path in LAUNCH)


class Entry(NamedTuple):
    """One entry: path, value (None: left out), what it allows, what it is, default, what acts."""

    path: str
    value: Any
    kind: Kind
    doc: str
    default: Any
    acts: str | None


def entries(part: Any, prefix: str = "", kind: Any = None) -> Iterator[Entry]:
    """Every entry of a scene or of a part of it, also those left out; of a ``kind`` its fields.

    >>> from puck_tables.scene.parts import Edge
    >>> [entry.path for entry in entries(Edge((0.0, 1.0), normal=(0.0, -1.0)), "edge[0].")]
    ['edge[0].point', 'edge[0].normal', 'edge[0].beyond']
    """
    whole: Any = kind or type(part)
    for name, table, kind, doc, default, acts in _described(whole):
        value, path = getattr(part, name), prefix + table
        if kind.shape == "part" and value is not None:
            yield from entries(value, f"{path}.", kind.part)
        elif kind.shape == "parts":
            for i, item in enumerate(value):
                yield from entries(item, f"{path}[{i}].")
        else:
            yield Entry(path, value, kind, doc, default, acts)
            if kind.kinds:
                each = [(f"{path}[{i}]", one) for i, one in enumerate(value)] if (
                    kind.shape == "numbers"
                ) else [(path, value)]  # fmt: skip
                for at, one in each:
                    if isinstance(one, tuple(kind.kinds.values())):
                        yield from entries(one, f"{at}.")


@lru_cache(maxsize=64)
def _described(part: Any) -> list[tuple[str, str, Kind, str, Any, str | None]]:
    """Of a part's fields: name, that in tables, what it allows, what it is, default, what acts."""
    return [
        (spec.name, in_tables(name), spec.metadata["kind"], spec.metadata["doc"], spec.default,
         spec.metadata["acts"])
        for name, spec in specs(part).items()
    ]  # fmt: skip


def units_of(scene: Any) -> dict[str, str]:
    """Units of the entries of a scene by path, all walls or edges under one.

    >>> from puck_tables import Puck, Scene
    >>> units_of(Scene(Puck(0.04)))["launch.spin"]
    'rad/s'
    """
    measured = ("number", "pair", "numbers")
    return {
        re.sub(r"\[\d+\]", "", entry.path): entry.kind.unit or "1"
        for entry in entries(scene)
        if entry.kind.shape in measured
    }


def entry_at(scene: Any, path: str) -> Entry:
    """The entry of a path, or of the list of numbers that the path leads into.

    >>> from puck_tables import Puck, Scene
    >>> entry_at(Scene(Puck(0.04)), "launch.position[1]").kind.unit
    'm'
    """
    whole = re.sub(r"\[\d+\]$", "", path)
    match = next((entry for entry in entries(scene) if entry.path == whole), None)
    if match is None:
        raise InputError(f"the scene has no entry {shown(path)}: see 'puck scene fields'")
    return match


def tables_of(part: Any, kind: Any = None) -> dict[str, Any]:
    """A scene as nested tables that :meth:`puck_tables.Scene.from_tables` takes, without ranges.

    What is left out stays out, and so does a number without bound, and a gravity that a puck was
    not given; of a ``kind`` its fields.

    >>> from puck_tables import Puck, Scene
    >>> tables_of(Scene(Puck(0.04)))["floor"]["velocity"]
    [0.0, 0.0]
    """
    tables: dict[str, Any] = {}
    for name, spec in specs(kind or type(part)).items():
        value = _plain(getattr(part, spec.name), spec.metadata["kind"].part)
        unsaid = isinstance(value, Unsaid) and spec.default in (None, value)
        if not (
            unsaid or value is None or value == [] or (type(value) is float and value == np.inf)
        ):
            tables[in_tables(name)] = value
    if "gravity" in tables and "puck" in tables:  # a scene that gave it to its pucks
        pucks = tables["puck"]
        for puck in pucks if isinstance(pucks, list) else [pucks]:
            if isinstance(puck.get("gravity"), Unsaid):
                del puck["gravity"]
    return tables


def _plain(value: Any, kind: Any = None) -> Any:
    """A record as a table, a tuple as a list; of a ``kind`` its fields."""
    if isinstance(value, Mapping):
        return {name: _plain(one) for name, one in value.items()}
    if isinstance(value, tuple | list | np.ndarray):
        return [_plain(one, kind) for one in value]
    read = dataclasses.is_dataclass(value) and bool(specs(type(value)))
    return tables_of(value, kind) if read else value


def columns_of(path: str, values: Any) -> list[tuple[str, Any]]:
    """What ranges along an axis: entries by path, and what they take.

    Raises InputError if many launches are not rows of six numbers.

    >>> [path for path, _ in columns_of("launch", np.zeros((2, 6)))][:2]
    ['launch.velocity', 'launch.spin']
    """
    if not is_batch(path):
        return [(path, values)]
    rows = finite_array(f"ranges[{path!r}]", values, "m/s, rad/s, m and rad")
    if rows.ndim != 2 or rows.shape[1] != len(LAUNCH):
        raise InputError(
            f"ranges[{path!r}] has the shape {rows.shape}: must be rows of vx, vy, spin, x, y and "
            "orientation"
        )
    return [
        (f"{path}.velocity", rows[:, 0:2]), (f"{path}.spin", rows[:, 2]),
        (f"{path}.position", rows[:, 3:5]), (f"{path}.orientation", rows[:, 5]),
    ]  # fmt: skip


def set_path(tables: dict[str, Any], path: str, value: Any) -> None:
    """Put a value at a path such as launch.velocity[0] or wall[1].restitution.

    Raises InputError if the path leads nowhere.

    >>> tables = {"launch": {"velocity": [1.0, 0.0]}}
    >>> set_path(tables, "launch.velocity[0]", 2.0)
    >>> set_path(tables, "floor.slope", 0.1)
    >>> tables
    {'launch': {'velocity': [2.0, 0.0]}, 'floor': {'slope': 0.1}}
    """
    if not re.fullmatch(r"\w+(\[\d{1,6}\])?(\.\w+(\[\d{1,6}\])?)*", path):
        raise InputError(f"{path!r} is no path: write one like launch.spin or wall[0].restitution")
    steps: list[str | int] = [
        int(number) if number else name for name, number in re.findall(r"(\w+)|\[(\d+)\]", path)
    ]
    at: Any = tables
    for step, following in zip(steps, [*steps[1:], None], strict=True):
        try:
            if following is None:
                at[step] = value
            elif isinstance(step, str) and step not in at:
                at[step] = {} if isinstance(following, str) else [0.0, 0.0]
                at = at[step]
            else:
                at = at[step]
        except (IndexError, TypeError, KeyError):
            raise InputError(
                f"{path}: the scene has no such entry to set: write that part into its file "
                "('puck scene show NAME > mine.toml' begins one; 'puck scene fields' lists what "
                "may stand there, of a list each part by its number, as puck[0], wall[1])"
            ) from None

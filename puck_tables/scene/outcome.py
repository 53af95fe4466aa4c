"""How runs of a scene end, what happens on the way, and the scene as the text of a scene file."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables._core.safe_write import as_utf8
from puck_tables.errors import InputError
from puck_tables.io.columns import following
from puck_tables.scene.entries import columns_of, is_batch, set_path, tables_of
from puck_tables.scene.library import files_of
from puck_tables.scene.scene_spec import SceneSpec

ENDS = (
    "at rest", "carried by the floor", "carried round", "time is up", "over the edge",
    "in a pocket", "tipped over", "step limit", "events crowd together",
    "impacts without end", "unsolved", "faster than a table of restitution goes",
    "no end found", "refused",
)  # fmt: skip
# their places: those of a run that has ended, up to LAST_END; of one that failed; and of one of
# many, which go on
AT_REST, CARRIED_AWAY, CARRIED_ROUND, TIME_UP, OVER_EDGE, IN_POCKET, TIPPED = range(7)
LAST_END = TIPPED
STEP_LIMIT, EVENT_LIMIT = range(7, 9)
IMPACTS_WITHOUT_END, UNSOLVED, TOO_FAST, NO_END, REFUSED = range(9, 14)
EVENTS = (
    "stick",
    "slip",
    "impact",
    "contact",
    "entry",
    "edge",
    "exit",
    "overhang",
    "line",
    "tip",
)


def as_toml(scene: SceneSpec) -> str:
    """A scene as the text of a scene file, with its ranges.

    A pressure law or friction law that is a function stands there by its name.

    >>> from puck_tables import Puck, Scene
    >>> scene = Scene(Puck(0.04), ranges={"puck.height": np.array([0.0, 0.5, 1.0])})
    >>> as_toml(scene).splitlines()[4:7]
    ['[puck]', 'radius = 0.04', 'height = "0.0:1.0:3"']
    """
    tables = tables_of(scene)
    for path, values in scene.ranges.items():
        for entry, column in columns_of(path, values):
            set_path(tables, entry, column.tolist() if is_batch(path) else _range(column))
    return "\n".join(_lines(tables, "")).lstrip("\n") + "\n"


def _range(values: FloatArray) -> str | list[float]:
    """A range as 'START:STOP:COUNT' where that gives the same numbers, else the numbers."""
    first, last = float(values[0]), float(values[-1])
    if values.size > 1 and np.array_equal(values, np.linspace(first, last, values.size)):
        return f"{first!r}:{last!r}:{values.size}"
    return [float(value) for value in values]


def _lines(table: Mapping[str, Any], path: str) -> Iterator[str]:
    """A table line by line: its own entries first, for what follows a header belongs to it."""
    inner = {name: value for name, value in table.items() if _holds_tables(value)}
    for name, value in table.items():
        if name not in inner:
            yield f"{name} = {_value(value)}"
    for name, value in inner.items():
        for part in value if isinstance(value, list) else [value]:
            header = f"{path}{name}"
            yield f"\n[[{header}]]" if isinstance(value, list) else f"\n[{header}]"
            yield from _lines(part, f"{header}.")


def _holds_tables(value: Any) -> bool:
    return isinstance(value, dict) or (
        isinstance(value, list) and bool(value) and all(isinstance(one, dict) for one in value)
    )


def _value(value: Any) -> str:
    """A number, a text, a table or a list of them; a TOML text escapes like one of JSON."""
    if isinstance(value, dict):
        return f"{{{', '.join(f'{name} = {_value(one)}' for name, one in value.items())}}}"
    if isinstance(value, list):
        return f"[{', '.join(map(_value, value))}]"
    if isinstance(value, int | float | np.number):
        return repr(float(value))
    value = value if isinstance(value, str) else str(value.name)
    return json.dumps(as_utf8(value), ensure_ascii=False).replace("\x7f", "\\u007f")


def refuse_changed(scene: SceneSpec, files: Mapping[str, str]) -> None:
    """Refuse to go on with a run of a scene whose files are no longer what they were."""
    if files_of(scene) != files:
        raise InputError("a file that the scene names has changed since the run: run it again")


def column_of(result: Any, name: str) -> FloatArray:
    """A column as an attribute of a result of a scene.

    Raises
    ------
    AttributeError
    """
    columns: Mapping[str, FloatArray] = result.__dict__.get("columns", {})
    column: FloatArray = columns[name] if name in columns else following(result, name)
    return column


def plain_name(path: str) -> str:
    """A path of a scene as a name: no brackets or dots, which other programs stumble over.

    >>> plain_name("launch.velocity[0]")
    'launch_velocity_0'
    """
    return path.replace("[", "_").replace("]", "").replace(".", "_")


def scene_texts(scene: SceneSpec, files: Mapping[str, str]) -> dict[str, tuple[str, str]]:
    """A scene as a scene file, the files it names, and what they are."""
    named = {
        plain_name(path): (text, f"what stands in the file that {path} of the scene names")
        for path, text in files.items()
    }
    return {"scene": (as_toml(scene), "the scene as a scene file (TOML)"), **named}

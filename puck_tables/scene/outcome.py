"""How runs of a scene end, and what happens on the way."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from puck_tables._core.arrays import FloatArray
from puck_tables.errors import InputError
from puck_tables.io.columns import following
from puck_tables.scene.library import files_of
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.scene.scene_text import as_toml

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

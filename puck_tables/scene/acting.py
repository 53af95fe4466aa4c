"""What acts on a puck beside dry friction, by the entries of a scene that say so."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

from puck_tables._core.fields import specs
from puck_tables.errors import PuckError
from puck_tables.scene.entries import entries
from puck_tables.scene.scene_spec import SceneSpec

OVERHANG = (
    "a rim comes over an edge; until its centre does, a puck is carried as if none of it hung in "
    "the air, which it is not: its motion from there on is a guess"
)
CARRIED_BY_REST = (
    "what comes over an edge carries nothing: a base is pressed on what is left of it, linearly, "
    "and stays level until its load is over the edge, where it tips"
)
EMPIRICAL = (
    "The lateral force is empirical, as somebody fitted it: no dry friction over the contact "
    "explains it."
)
# entries that change no motion, or where it begins and ends, or whom it meets
FREE = (
    "title", "puck", "launch", "time", "frames", "tol", "puck[]", "post", "arc", "pocket", "line",
    "rim",
)  # fmt: skip


def acting(scene: SceneSpec) -> list[str]:
    """What a scene says that acts, in its order.

    Raises PuckError if an entry of the scene does not say what acts with it: it would be left out.

    >>> from puck_tables import Drag, Puck, Scene
    >>> acting(Scene(Puck(1.0), drag=Drag(sliding=0.1)))
    ['drag']
    """
    kind: Any = type(scene)
    if stray := _stray(kind):
        raise PuckError(f"{', '.join(stray)}: the plan of a run knows no such ingredient")
    effects = (entry for entry in entries(scene) if entry.value is not None and entry.acts)
    there = list(dict.fromkeys(one.acts or "" for one in effects if one.value != one.default))
    if scene.constraint is not None:
        there[there.index("constraint")] = scene.constraint.kind
    return there


@lru_cache(maxsize=16)
def _stray(kind: Any) -> list[str]:
    """Entries that a scene, or a part of it, may have and that do not say what acts with them."""
    return [path for name in specs(kind) if name not in FREE for path in _mute(kind, name, name)]


def _mute(kind: Any, name: str, path: str) -> list[str]:
    spec = specs(kind)[name]
    part = spec.metadata["kind"].part
    if part is None:
        return [path] if spec.metadata["acts"] is None else []
    return [one for inner in specs(part) for one in _mute(part, inner, f"{path}.{inner}")]

"""Scene files: those that come along, and the user's own."""

from __future__ import annotations

import os
import tomllib
from difflib import get_close_matches
from importlib.resources import files
from typing import Any

from puck_tables.errors import InputError
from puck_tables.scene.scene import read_scene


def shipped_scenes() -> dict[str, str]:
    """Names and titles of the scenes that come along.

    Examples
    --------
    >>> shipped_scenes()["incline"]
    'Puck on an incline'
    """
    texts = {name: shipped_text(name) for name in _names()}
    return {name: str(tomllib.loads(text).get("title", "")) for name, text in texts.items()}


def shipped_text(name: str) -> str:
    """The file of a scene that comes along, to start one's own from.

    Raises
    ------
    InputError
        If there is none of that name.

    Examples
    --------
    >>> shipped_text("incline").splitlines()[1]
    'title = "Puck on an incline"'
    """
    if name not in _names():
        raise InputError(f"no scene {name!r} comes along{_meant(name)}: there are {_listed()}")
    return (_folder() / f"{name}.toml").read_text(encoding="utf-8")


def find_scene(name: str) -> dict[str, Any]:
    """The tables of a scene: a file, or the name of one that comes along.

    Raises
    ------
    InputError
        If there is neither, or it is not TOML.

    Examples
    --------
    >>> find_scene("incline")["floor"]["friction"]
    0.15
    """
    try:
        os.lstat(name)
    except FileNotFoundError:
        if name in _names():
            return tomllib.loads(shipped_text(name))
        raise InputError(
            f"no file {name}, and no scene of that name comes along{_meant(name)}: there are "
            f"{_listed()}"
        ) from None
    except (OSError, ValueError) as error:
        raise InputError(f"cannot read {name}: {getattr(error, 'strerror', error)}") from None
    return read_scene(name)


def _folder() -> Any:
    return files("puck_tables.scene") / "examples"


def _meant(name: str) -> str:
    """What a misspelt name may have been meant to be, in words.

    Examples
    --------
    >>> _meant("airhockey")
    ' (did you mean air-hockey?)'
    """
    near = get_close_matches(name, _names(), 1, 0.7)
    return f" (did you mean {near[0]}?)" if near else ""


def _listed() -> str:
    return ", ".join(_names())


def _names() -> list[str]:
    return sorted(item.name[:-5] for item in _folder().iterdir() if item.name.endswith(".toml"))

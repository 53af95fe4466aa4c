"""Scene files: those that come along, the user's own, and a scene as the text of one."""

from __future__ import annotations

import json
import os
import re
import tomllib
from codecs import BOM_UTF16_BE, BOM_UTF16_LE
from collections.abc import Iterator, Mapping
from dataclasses import is_dataclass
from functools import lru_cache
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables._core.fields import Kind, in_tables, specs
from puck_tables._core.safe_read import content_of
from puck_tables._core.safe_write import as_utf8
from puck_tables._core.wording import meant
from puck_tables.errors import InputError
from puck_tables.scene.entries import columns_of, is_batch, set_path, tables_of
from puck_tables.scene.scene_spec import SceneSpec

MAX_FILE = 1 << 20  # bytes of a scene: more is no scene
_PARTS = 50  # of a dotted key
_POINT = re.compile(r"(?<!\.)\.(?!\.)")
MAX_NAMED = 1 << 26  # bytes of a file that a scene names


def shipped_scenes() -> dict[str, str]:
    """Names and titles of the scenes that come along.

    >>> shipped_scenes()["incline"]
    'Puck on an incline'
    """
    texts = {name: shipped_text(name) for name in _names()}
    return {name: str(tomllib.loads(text).get("title", "")) for name, text in texts.items()}


def shipped_text(name: str) -> str:
    """The file of a scene that comes along, to start one's own from.

    Raises InputError if there is none of that name.

    >>> shipped_text("incline").splitlines()[1]
    'title = "Puck on an incline"'
    """
    if name not in _names():
        raise InputError(f"no scene {name!r} comes along{_others(name)}")
    return (_folder() / f"{name}.toml").read_text(encoding="utf-8")


def find_scene(name: str) -> dict[str, Any]:
    """The tables of a scene: a file, or the name of one that comes along.

    Raises InputError if there is neither, or it is not TOML.

    >>> find_scene("incline")["puck"]["friction"]
    0.15
    """
    if not name.strip():
        raise InputError(
            f"the name of the scene is empty: give a file, or one of {', '.join(_names())}"
        )
    try:
        os.lstat(name)
    except FileNotFoundError:
        if name in _names():
            return tomllib.loads(shipped_text(name))
        raise InputError(
            f"no file {name}, and no scene of that name comes along{_others(name)}"
        ) from None
    except (OSError, ValueError) as error:
        raise InputError(f"cannot read {name}: {getattr(error, 'strerror', error)}") from None
    return read_scene(name)


def _folder() -> Any:
    return files("puck_tables.scene") / "examples"


def _others(name: str) -> str:
    return f"{meant(name, _names(), 0.7)}: there are {', '.join(_names())}"


def _names() -> list[str]:
    return sorted(item.name[:-5] for item in _folder().iterdir() if item.name.endswith(".toml"))


def toml_in(text: str) -> dict[str, Any]:
    """The tables in a text; keys of very many parts, which take minutes to read, are refused.

    Raises ValueError if it is none.

    >>> toml_in("puck.radius = 0.04")
    {'puck': {'radius': 0.04}}
    """
    keys = re.split(r"[=\[\]{},\n\r#]", text)
    if any(len(_POINT.findall(key)) >= _PARTS for key in keys):
        raise tomllib.TOMLDecodeError(f"a key in it has more than {_PARTS} parts")
    return tomllib.loads(text)


def read_scene(path: str | Path) -> dict[str, Any]:
    """The tables of a scene file.

    Raises InputError if it cannot be read or is not TOML.
    """
    content = content_of(path, MAX_FILE)
    try:
        wide = content.startswith((BOM_UTF16_LE, BOM_UTF16_BE))  # as '>' of PowerShell writes it
        tables = toml_in(content.decode("utf-16" if wide else "utf-8-sig"))
    except UnicodeDecodeError as error:
        raise InputError(f"{path} is not text in UTF-8: see its byte {error.start}") from None
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"{path} is not a scene file (TOML): {error}") from None
    except (ValueError, RecursionError):
        raise InputError(
            f"{path}: a number in it has thousands of digits, or its lists are nested too deeply"
        ) from None
    _find_in(Path(path).parent, tables, SceneSpec)
    return tables


def _find_in(folder: Path, tables: Any, part: Any) -> None:
    """Let all files that the tables of a part name be in a folder."""
    for name, spec in specs(part).items() if isinstance(tables, dict) else ():
        kind, value = spec.metadata["kind"], tables.get(in_tables(name))
        if kind.names_file(value):
            tables[name] = str(folder / value)
        for one in value if isinstance(value, list) else [value]:
            if kind.part is not None and isinstance(value, list) == (kind.shape == "parts"):
                _find_in(folder, one, kind.part)
            elif kind.kinds and isinstance(one, dict):
                _find_in(folder, one, kind.kinds.get(str(one.get("kind")), Kind))


def files_of(scene: SceneSpec) -> dict[str, str]:
    """What stands in the files that a scene names, by the path of the entry that names them.

    Raises InputError if one cannot be read.

    >>> from puck_tables import Puck, Scene
    >>> files_of(Scene(Puck(0.04)))
    {}
    """
    texts = {}
    for path, file in _named_in(scene, ""):
        text = content_of(file, MAX_NAMED).decode("utf-8-sig", "replace")
        texts[path] = text.replace("\0", "\ufffd")
    return texts


def _named_in(part: Any, prefix: str) -> Iterator[tuple[str, str]]:
    """Path and name of every file that a scene or a part of it names."""
    whole: Any = type(part)
    for spec, table, kind in _may_name(whole):
        value, path = getattr(part, spec), prefix + table
        if kind.names_file(value):
            yield path, value
        elif kind.shape in ("parts", "numbers"):
            for i, item in enumerate(value):
                yield from _named_in(item, f"{path}[{i}].")
        else:
            yield from _named_in(value, f"{path}.")


@lru_cache(maxsize=64)
def _may_name(part: Any) -> list[tuple[str, str, Kind]]:
    """The fields of a part, if it is one, that may name a file, or parts that do."""
    known = specs(part) if is_dataclass(part) else {}
    kinds = {name: spec.metadata["kind"] for name, spec in known.items()}
    return [
        (known[name].name, in_tables(name), kind)
        for name, kind in kinds.items()
        if kind.file is not None
        or any(map(_may_name, [kind.part, *(kind.kinds.values() if kind.kinds else ())]))
    ]


def refuse_changed(scene: SceneSpec, files: Mapping[str, str]) -> None:
    """Refuse to go on with a run of a scene whose files are no longer what they were."""
    if files_of(scene) != files:
        raise InputError("a file that the scene names has changed since the run: run it again")


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

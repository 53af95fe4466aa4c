"""The store of tables that the program builds for itself, in the user's cache folder; its list.

The name of a kept file ends in the digest of its recipe: all that determines the values, and the
sources that compute them, so that no table of another version of the program is taken for today's.
What is there is trusted only after its seal and its recipe proved right; what cannot be kept is
built and used all the same.
"""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Callable, Iterable
from datetime import UTC, datetime
from importlib.resources import files
from pathlib import Path
from typing import Any, TypeVar

from puck_tables._core.own_folder import make_private, refuse_shared, say, user_cache
from puck_tables._core.partial_files import remove_dead
from puck_tables._core.sources import source_digest
from puck_tables.errors import InputError, OutputError, TableError
from puck_tables.table.table import Table

AnyTable = TypeVar("AnyTable", bound=Table)

_NAME = re.compile(r"[\w.+-]+-[0-9a-f]{16}\.h5")
_OF_A_WHOLE_ONE = ("kind", "pressure_law", "valid_range", "accuracy")


def fetch(
    stem: str, recipe: dict[str, Any], kind: type[AnyTable], build: Callable[[], AnyTable],
    rooms: tuple[str, ...] = (), most: int | None = None,
) -> AnyTable:  # fmt: skip
    """A table from the store, built and put there unless it is.

    Parameters
    ----------
    stem : how the name of its file begins
    recipe : what determines the values, as JSON has it
    kind : of table
    build : how it is made
    rooms : whose sources determine the values, besides those of tables
    most : so many are kept of those whose names begin alike, up to the first -
    """
    sources = source_digest("contact", "kernels", "table", *rooms)
    whole = json.dumps([recipe, kind.algorithm, sources], sort_keys=True)
    digest = hashlib.sha256(whole.encode()).hexdigest()[:16]
    command = f"kept by the program: {kind.kind} {stem}, recipe {digest}"
    folder = tables_folder()
    if folder is None:
        say("there is no cache folder for built tables on this machine: this one is not kept")
        return build()
    path = folder / f"{file_stem(stem)}-{digest}.h5"
    try:
        make_private(folder.parent)
        make_private(folder)
        if path.exists() or path.is_symlink():
            try:
                kept = kind.load(path)
                if kept.metadata["command"] == command:
                    return kept
                say(f"{path} is another table than its name says: it is built again")
            except TableError:
                say(f"{path} is damaged: it is built again")
            folder_there = path.is_dir() and not path.is_symlink()
            path.rmdir() if folder_there else path.unlink(missing_ok=True)
        if most is not None:  # a sweep over many heights shall not fill the disk
            alike = [one for one in kept_files() if one.name.startswith(stem.split("-")[0] + "-")]
            for one in sorted(alike, key=lambda one: one.stat().st_mtime)[: 1 - most or None]:
                one.unlink(missing_ok=True)
    except OSError as error:
        say(f"the table is used but not kept for the next time: {error.strerror or error}")
        return build()
    table = build()
    try:
        return table.save(path, overwrite=True, command=command)
    except (OSError, OutputError) as error:
        reason = getattr(error, "strerror", None) or error
        say(f"the table is used but not kept for the next time: {reason}")
        return table


def file_stem(name: str) -> str:
    """A file name for what has this name.

    Examples
    --------
    >>> file_stem("annulus:0.8"), file_stem("my stone.csv")
    ('annulus-0.8', 'my-stone')
    """
    return re.sub(r"[^\w.+-]", "-", name.removesuffix(".csv"))


def tables_folder() -> Path | None:
    """Where built tables are kept; None where the user has no cache folder.

    Examples
    --------
    >>> tables_folder().parts[-2:]
    ('puck-tables', 'tables')
    """
    base = user_cache()
    return None if base is None else base / "tables"


def kept_files() -> list[Path]:
    """The files of the store that are tables by their names, in alphabetical order.

    Examples
    --------
    >>> all(path.suffix == ".h5" for path in kept_files())
    True
    """
    folder = tables_folder()
    try:
        if folder is None or not folder.is_dir():
            return []
        refuse_shared(folder)
    except OSError as error:
        say(f"{folder} is not used: {error.strerror or error}")
        return []
    named = (one for one in folder.iterdir() if _NAME.fullmatch(one.name))
    return sorted(one for one in named if one.is_file() and not one.is_symlink())


def shipped_and_kept() -> list[dict[str, Any]]:
    """The table files that come along, and those kept in the user's cache.

    Of each its name, place, what it holds in short (None of a damaged one), bytes, date, and
    whether it is whole.

    Examples
    --------
    >>> [entry["name"] for entry in shipped_and_kept() if entry["place"] == "comes along"]
    ['resultants.h5', 'stops.h5']
    """
    along = [Path(str(one)) for one in files("puck_tables.tables").iterdir()]
    places = {path: "comes along" for path in sorted(along) if path.suffix == ".h5"}
    entries = []
    for path, place in (places | {path: str(path.parent) for path in kept_files()}).items():
        try:
            about = path.stat()
        except FileNotFoundError:  # another process has just removed it
            continue
        date = datetime.fromtimestamp(about.st_mtime, UTC).isoformat(timespec="seconds")
        holds: tuple[Any, ...] = (None,) * len(_OF_A_WHOLE_ONE)
        try:
            table = Table.load(path)
            holds = table.kind, table.pressure_law, table.valid_range, table.tolerance
            date, whole = table.metadata["created"], True
        except TableError:
            whole = False
        entries.append({
            "name": path.name, "place": place, **dict(zip(_OF_A_WHOLE_ONE, holds, strict=True)),
            "bytes": about.st_size, "date": date, "whole": whole,
        })  # fmt: skip
    return entries


def remove(names: Iterable[str] | None = None) -> list[Path]:
    """Remove kept tables of these names, or all and what killed builders left; which they were.

    Raises
    ------
    InputError
        If one of them is none; then nothing is removed.
    OutputError
        If the system does not let one go.
    """
    kept = {path.name: path for path in kept_files()}
    for name in names or ():
        if name not in kept:
            raise InputError(f"no table {name} is kept: 'puck tables' lists those that are")
    paths = [kept[name] for name in dict.fromkeys(kept if names is None else names)]
    for path in paths:
        try:
            path.unlink(missing_ok=True)
        except OSError as error:
            raise OutputError(f"cannot remove {path}: {error.strerror or error}") from None
    if names is None and kept:
        remove_dead(paths[0].parent)
    return paths

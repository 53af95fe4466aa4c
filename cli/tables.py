"""``puck tables``: the tables there are, and clearing away those that the program has kept."""

from __future__ import annotations

import json
import re
from contextlib import suppress
from importlib.resources import files
from pathlib import Path
from typing import Any

import click
from puck_tables.cli.printing import say

from puck_tables._core import own_folder
from puck_tables.errors import InputError, TableError
from puck_tables.report.lines_and_tables import columns


@click.command()
@click.option("--json", "as_json", is_flag=True, help="Print one JSON list.")
@click.option("--remove", "names", metavar="NAME", multiple=True, help="Remove a kept table.")
@click.option("--clean", is_flag=True, help="Remove all kept tables.")
def tables(as_json: bool, names: tuple[str, ...], clean: bool) -> None:
    """List the tables that come along, and those the program has built and kept.

    Kept tables lie in the user's cache folder; what is removed there is built again when it is
    needed.  Tables of 'puck build-tables' are yours and lie where you put them: see 'puck info'.

    \b
    puck tables
    puck tables --remove NAME
    puck tables --clean
    """  # noqa: D301 - click reads the backspace
    if clean + bool(names) + as_json > 1:
        raise InputError("--json, --remove and --clean clash: give one of them")
    kept = {path.name: path for path in kept_files()}
    if names or clean:
        _remove(kept, list(dict.fromkeys(names or kept)), clean)
        return
    along = sorted(Path(str(one)) for one in files("puck_tables.tables").iterdir())
    places = {path: "comes along" for path in along if path.suffix == ".h5"}
    places |= {path: str(path.parent) for path in kept.values()}
    entries = [entry for path, place in places.items() for entry in _entries(path, place)]
    if as_json:
        click.echo(json.dumps(entries))
    else:
        say(_lines(entries))


def kept_files() -> list[Path]:
    """The kept files that are tables by their names, in alphabetical order."""
    from puck_tables.table.table_store import ENDING, tables_folder

    folder = tables_folder()
    try:
        if folder is None or not folder.is_dir():
            return []
        own_folder.refuse_shared(folder)
    except OSError as error:
        own_folder.say(f"{folder} is not used: {error.strerror or error}")
        return []
    named = (one for one in folder.iterdir() if re.fullmatch(r"[\w.+-]+" + ENDING, one.name))
    return sorted(one for one in named if one.is_file() and not one.is_symlink())


def _remove(kept: dict[str, Path], names: list[str], clean: bool) -> None:
    """Remove kept tables of these names, all or none; ``clean``: what killed builders left, too."""
    from puck_tables._core.partial_files import remove_dead

    for name in names:
        if name not in kept:
            raise InputError(f"no table {name} is kept: 'puck tables' lists those that are")
    for name in names:
        kept[name].unlink(missing_ok=True)
        click.echo(f"removed {click.format_filename(kept[name])}")
    if not names:
        click.echo("nothing is kept: nothing to remove")
    elif clean:
        remove_dead(kept[names[0]].parent)


def _entries(path: Path, place: str) -> list[dict[str, Any]]:
    """What a table file holds in short, None if it is damaged; none where it was just removed."""
    from puck_tables.table.table import Table

    table = None
    with suppress(TableError):
        table = Table.load(path)
    with suppress(FileNotFoundError):
        return [{
            "name": path.name, "place": place, "kind": table and table.kind,
            "pressure_law": table and table.pressure_law, "bytes": path.stat().st_size,
            "valid_range": table and table.valid_range, "accuracy": table and table.tolerance,
            "date": table and table.metadata["created"], "whole": table is not None,
        }]  # fmt: skip
    return []


def _lines(entries: list[dict[str, Any]]) -> str:
    heads = {
        "name": "", "holds": "", "pressure": "", "accuracy": "g", "kB": ".0f", "made": "",
        "state": "", "range": "",
    }  # fmt: skip
    rows = [
        (one["name"], one["kind"] or "-", one["pressure_law"] or "-", one["accuracy"],
         one["bytes"] / 1000, (one["date"] or "-")[:10], "whole" if one["whole"] else "damaged",
         one["valid_range"] or "-")
        for one in entries
    ]  # fmt: skip
    places = dict.fromkeys(one["place"] for one in entries if one["place"] != "comes along")
    kept = [f"kept in {click.format_filename(place)}" for place in places]
    return "\n".join([columns(heads, rows), *kept])

"""``puck tables``: the tables there are, and clearing away those that the program has kept."""

from __future__ import annotations

import json
from typing import Any

import click
from puck_tables.cli.printing import say

from puck_tables.errors import InputError
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
    from puck_tables.table import table_store

    if names or clean:
        removed = table_store.remove(None if clean else names)
        for path in removed:
            click.echo(f"removed {click.format_filename(path)}")
        if not removed:
            click.echo("nothing is kept: nothing to remove")
        return
    entries = table_store.shipped_and_kept()
    if as_json:
        click.echo(json.dumps(entries))
    else:
        say(_lines(entries))


def _lines(entries: list[dict[str, Any]]) -> str:
    heads = {
        "name": "", "holds": "", "pressure": "", "accuracy": "g", "kB": ".0f", "made": "",
        "state": "", "range": "",
    }  # fmt: skip
    rows = [
        (one["name"], one["kind"] or "-", one["pressure_law"] or "-", one["accuracy"],
         one["bytes"] / 1000, one["date"][:10] or "-", "whole" if one["whole"] else "damaged",
         one["valid_range"] or "-")
        for one in entries
    ]  # fmt: skip
    places = dict.fromkeys(one["place"] for one in entries if one["place"] != "comes along")
    kept = [f"kept in {click.format_filename(place)}" for place in places]
    return "\n".join([columns(heads, rows), *kept])

"""``puck tables``: the tables there are, and clearing away those that the program has kept."""

from __future__ import annotations

import json
from typing import Any

import click
from puck_tables.cli.options import printable

from puck_tables.errors import InputError


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
    from puck_tables.table import table_list, table_store

    if names or clean:
        removed = table_store.remove(None if clean else names)
        for path in removed:
            click.echo(f"removed {click.format_filename(path)}")
        if not removed:
            click.echo("nothing is kept: nothing to remove")
        return
    entries = table_list.shipped_and_kept()
    if as_json:
        click.echo(json.dumps(entries))
    else:
        click.echo(printable(_lines(entries)))


def _lines(entries: list[dict[str, Any]]) -> str:
    titles = ("name", "holds", "pressure", "accuracy", "kB", "made", "state", "range")
    rows = [titles]
    for entry in entries:
        accuracy = entry["accuracy"]
        rows.append((
            entry["name"], entry["kind"] or "-", entry["pressure_law"] or "-",
            "-" if accuracy is None else f"{accuracy:g}",
            str(round(entry["bytes"] / 1000)), entry["date"][:10] or "-",
            "whole" if entry["whole"] else "damaged", entry["valid_range"] or "-",
        ))  # fmt: skip
    widths = [max(len(row[i]) for row in rows) for i in range(len(titles))]
    lines = [
        "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()
        for row in rows
    ]
    places = dict.fromkeys(one["place"] for one in entries if one["place"] != "comes along")
    return "\n".join(lines + [f"kept in {click.format_filename(place)}" for place in places])

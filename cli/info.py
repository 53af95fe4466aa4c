"""``puck info``: what a table holds and how good it is."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click
from puck_tables.cli.options import FILE, printable, tables_named

if TYPE_CHECKING:
    from puck_tables.table.table import Table


@click.command()
@click.argument("file", type=FILE, required=False)
def info(file: Path | None) -> None:
    """Say what a table holds, how good it is, and whether its digest is right.

    Without FILE: the tables that come along.
    """
    click.echo(printable("\n\n".join(describe(table) for table in tables_named(file))))


def describe(table: Table) -> str:
    """A table in a dozen lines.  It was loaded, so its digest is right."""
    said, accuracy = table.metadata, table.accuracy
    assert accuracy is not None
    lines = {
        "table": table.source,
        "holds": f"{table.kind} ({', '.join(table.functions)}); {table.pressure_law} pressure",
        "grid": table.grid,
        "valid": table.valid_range,
        "tolerance": f"{table.tolerance:g}",
        "measured": f"at {accuracy.points} random and adversarial points ({table.errors}):",
    }
    columns = {"largest": accuracy.largest, "rms": accuracy.rms, "99.9 %": accuracy.p999}
    text = [f"{name:<11} {value}" for name, value in lines.items()]
    text.append(
        f"{'':<26}" + "".join(f"{name:>10}" for name in columns) + f"   at phi, {table.second}"
    )
    for i, name in enumerate(table.quantities):
        errors = "".join(f"{values[i]:>10.1e}" for values in columns.values())
        place = f"{accuracy.at_phi[i]:.6g}, {accuracy.at_second[i]:.6g}"
        text.append(f"{'':<11} {name:<14}{errors}   {place}")
    rest = {"order": f"{accuracy.order:.2f} in phi, against half the cells"}
    if not accuracy.order:
        rest = {"order": "not measured"}
    rest |= {
        "made by": f"{said['command']}  (puck-tables {said['package_version']}, {said['created']})",
        "format": f"{said['format']} {said['format_version']}",
        "digest": f"sha256 {said['digest'][:16]}..., right",
    }
    return "\n".join(text + [f"{name:<11} {value}" for name, value in rest.items()])

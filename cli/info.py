"""``puck info``: what a table holds and how good it is."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click
from puck_tables.cli.options import FILE, printable, tables_named

if TYPE_CHECKING:
    from puck_tables.catalogue import AnyTable


@click.command()
@click.argument("file", type=FILE, required=False)
def info(file: Path | None) -> None:
    """Say what a table holds, how good it is, and whether its digest is right.

    Without FILE: the tables that come along.
    """
    click.echo(printable("\n\n".join(describe(table) for table in tables_named(file))))


def describe(table: AnyTable) -> str:
    """A table in a dozen lines.  It was loaded, so its digest is right."""
    from puck_tables.catalogue import functions_and_grid
    from puck_tables.table.speed_table import SpeedAccuracy
    from puck_tables.table.table import Accuracy

    passport, accuracy = table.passport, table.accuracy
    assert accuracy is not None
    names, grid = functions_and_grid(table)
    lines = {
        "table": table.source,
        "holds": f"{passport['kind']} ({', '.join(names)}); {passport['pressure_law']} pressure",
        "grid": grid,
        "valid": passport["valid_range"],
        "tolerance": f"{table.tolerance:g}",
        "measured": f"at {accuracy.points} random and adversarial points (absolute errors):",
    }
    columns = {"largest": accuracy.largest, "rms": accuracy.rms}
    rest = {}
    second = "delta"
    if isinstance(accuracy, SpeedAccuracy):
        second, places = "v + r|omega|", accuracy.at_speed
        columns["99.9 %"] = accuracy.p999
        lines["measured"] = f"at {accuracy.points} points (errors over the largest f):"
    else:
        places = accuracy.at_delta
        rest["order"] = (
            f"{accuracy.order:.2f} in phi, against half the cells"
            if accuracy.order
            else "not measured: too few cells"
        )
    if isinstance(accuracy, Accuracy):
        columns["99.9 %"] = accuracy.p999
        rest["entries"] = f"residual {accuracy.entry_residual:.1e} at elementary entries"
    text = [f"{name:<11} {value}" for name, value in lines.items()]
    text.append(f"{'':<26}" + "".join(f"{name:>10}" for name in columns) + f"   at phi, {second}")
    for i, name in enumerate(names):
        errors = "".join(f"{values[i]:>10.1e}" for values in columns.values())
        text.append(f"{'':<11} {name:<14}{errors}   {accuracy.at_phi[i]:.6g}, {places[i]:.6g}")
    rest |= {
        "made by": f"{passport['command']}  (puck-tables {passport['package_version']}, "
        f"{passport['created']})",
        "format": f"{passport['format']} {passport['format_version']}",
        "digest": f"sha256 {passport['content_digest'][:16]}..., right",
    }
    return "\n".join(text + [f"{name:<11} {value}" for name, value in rest.items()])

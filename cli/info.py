"""``puck info``: what a table holds and how good it is."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click
from puck_tables.cli.options import FILE, tables_named

if TYPE_CHECKING:
    from puck_tables.similarity.stop_table import StopTable
    from puck_tables.table.table import Table


@click.command()
@click.argument("file", type=FILE, required=False)
def info(file: Path | None) -> None:
    """Say what a table holds, how good it is, and whether its digest is right.

    Without FILE: the tables that come along.
    """
    click.echo("\n\n".join(describe(table) for table in tables_named(file)))


def describe(table: Table | StopTable) -> str:
    """A table in a dozen lines.  It was loaded, so its digest is right."""
    from puck_tables.table.table import FUNCTIONS, Table

    passport, accuracy = table.passport, table.accuracy
    assert accuracy is not None
    if isinstance(table, Table):
        names: tuple[str, ...] = FUNCTIONS
        grid = f"{table.phi_axis.size} phi x {table.delta_axis.size} delta nodes"
    else:
        from puck_tables.similarity.check import NAMES

        names = NAMES
        grid = f"{table.axis.size} phi x {table.values.shape[1]} delta nodes"
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
    if isinstance(table, Table):
        assert table.accuracy is not None
        columns["99.9 %"] = table.accuracy.p999
        rest["entries"] = f"residual {table.accuracy.entry_residual:.1e} at phi = 0, pi/4, pi/2"
    text = [f"{name:<11} {value}" for name, value in lines.items()]
    text.append(f"{'':<26}" + "".join(f"{name:>10}" for name in columns) + "   at phi, delta")
    for i, name in enumerate(names):
        errors = "".join(f"{values[i]:>10.1e}" for values in columns.values())
        text.append(
            f"{'':<11} {name:<14}{errors}   {accuracy.at_phi[i]:.6g}, {accuracy.at_delta[i]:.6g}"
        )
    rest |= {
        "order": f"{accuracy.order:.2f} in phi, against half the cells"
        if accuracy.order
        else "not measured: too few cells",
        "made by": f"{passport['command']}  (puck-tables {passport['package_version']}, "
        f"{passport['created']})",
        "format": f"{passport['format']} {passport['format_version']}",
        "digest": f"sha256 {passport['content_digest'][:16]}..., right",
    }
    return "\n".join(text + [f"{name:<11} {value}" for name, value in rest.items()])

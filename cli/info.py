"""``puck info``: what a table holds and how good it is."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click
from puck_tables.cli.options import FILE, open_table

if TYPE_CHECKING:
    from puck_tables.table.table import Table


@click.command()
@click.argument("file", type=FILE, required=False)
def info(file: Path | None) -> None:
    """Say what a table holds, how good it is, and whether its digest is right.

    Without FILE: the default table.
    """
    click.echo(describe(open_table(file)))


def describe(table: Table) -> str:
    """A table in a dozen lines.  It was loaded, so its digest is right."""
    from puck_tables.table.table import FUNCTIONS

    accuracy, passport = table.accuracy, table.passport
    assert accuracy is not None
    lines = {
        "table": table.source,
        "holds": f"{passport['kind']} {', '.join(FUNCTIONS)}; {passport['pressure_law']} pressure",
        "grid": f"{table.phi_axis.size} phi x {table.delta_axis.size} delta nodes",
        "valid": passport["valid_range"],
        "tolerance": f"{table.tolerance:g}",
        "measured": f"at {accuracy.points} random and adversarial points (absolute errors):",
    }
    text = [f"{name:<11} {value}" for name, value in lines.items()]
    text.append(f"{'':<11} {'':<14}{'largest':>9}{'99.9 %':>10}{'rms':>10}   at phi, delta")
    for i, name in enumerate(FUNCTIONS):
        text.append(
            f"{'':<11} {name:<14}{accuracy.largest[i]:>9.1e}{accuracy.p999[i]:>10.1e}"
            f"{accuracy.rms[i]:>10.1e}   {accuracy.at_phi[i]:.6g}, {accuracy.at_delta[i]:.6g}"
        )
    rest = {
        "entries": f"residual {accuracy.entry_residual:.1e} at phi = 0, pi/4, pi/2",
        "order": f"{accuracy.order:.2f} in phi, against half the cells"
        if accuracy.order
        else "not measured: too few cells",
        "made by": f"{passport['command']}  (puck-tables {passport['package_version']}, "
        f"{passport['created']})",
        "format": f"{passport['format']} {passport['format_version']}",
        "digest": f"sha256 {passport['content_digest'][:16]}..., right",
    }
    return "\n".join(text + [f"{name:<11} {value}" for name, value in rest.items()])

"""``puck info``: what a table holds and how good it is."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click
from puck_tables.cli.options import FILE, tables_named
from puck_tables.cli.printing import columns, listed, say

if TYPE_CHECKING:
    from puck_tables.table.table import Table


@click.command()
@click.argument("file", type=FILE, required=False)
def info(file: Path | None) -> None:
    """Say what a table holds, how good it is, and whether its digest is right.

    Without FILE: the tables that come along.
    """
    say("\n\n".join(describe(table) for table in tables_named(file)))


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
    heads = {"": "", "largest": ".1e", "rms": ".1e", "99.9 %": ".1e", "at phi": ".6g"}
    errors = zip(
        table.quantities, accuracy.largest, accuracy.rms, accuracy.p999, accuracy.at_phi,
        accuracy.at_second, strict=True,
    )  # fmt: skip
    order = f"{accuracy.order:.2f} in phi, against half the cells"
    rest = {
        "order": order if accuracy.order else "not measured",
        "made by": f"{said['command']}  (puck-tables {said['package_version']}, {said['created']})",
        "format": f"{said['format']} {said['format_version']}",
        "digest": f"sha256 {said['digest'][:16]}..., right",
    }
    return "\n".join(
        [listed(lines, 11), columns({**heads, table.second: ".6g"}, errors), listed(rest, 11)]
    )

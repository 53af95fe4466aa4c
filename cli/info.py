"""``puck info``: what a table holds and how good it is."""

from __future__ import annotations

from pathlib import Path

import click
from puck_tables.cli.options import FILE, tables_named
from puck_tables.cli.printing import say


@click.command()
@click.argument("file", type=FILE, required=False)
def info(file: Path | None) -> None:
    """Say what a table holds, how good it is, and whether its digest is right.

    Without FILE: the tables that come along.
    """
    say("\n\n".join(map(str, tables_named(file))))

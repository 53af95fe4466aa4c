"""``puck validate``: judge a table."""

from __future__ import annotations

from pathlib import Path

import click
from puck_tables.cli.options import FILE, tables_named
from puck_tables.cli.printing import progress, say

FAILED = 3  # exit status: 1 and 2 are those of errors and of wrong usage


@click.command()
@click.argument("file", type=FILE, required=False)
def validate(file: Path | None) -> None:
    """Judge a table by independent routes.

    Resultants: direct quadrature and closed forms; those under other pressure laws and friction
    laws: quadrature.  Stops: the integrator, the equations they satisfy
    with friction by quadrature, elementary solutions.

    Without FILE: the tables that come along.  Ends with code 3 if anything is out of a table's own
    tolerance.
    """
    passed = True
    for table in tables_named(file):
        with progress("validating") as show:
            report = table.validate(show)
        say(str(report))
        passed = passed and report.passed
    if not passed:
        click.echo("Error: the table is out of its own tolerance", err=True)
        raise SystemExit(FAILED)

"""``puck validate``: judge a table."""

from __future__ import annotations

from pathlib import Path

import click
from puck_tables.cli.options import FILE, open_table, progress

FAILED = 3


@click.command()
@click.argument("file", type=FILE, required=False)
def validate(file: Path | None) -> None:
    """Judge a table by direct quadrature, closed forms, known entries and exact identities.

    Without FILE: the default table.  Ends with code 3 if anything is out of the table's own
    tolerance.
    """
    table = open_table(file)
    from puck_tables.table.check import validate as judge

    with progress("validating") as show:
        report = judge(table, show)
    click.echo(f"{report.source}: tolerance {report.tolerance:g}")
    click.echo(
        f"{'check':<36}{'function':<15}{'points':>7}{'largest':>10}{'allowed':>10}  result"
        "   at phi, delta"
    )
    for check in report.checks:
        click.echo(
            f"{check.name:<36}{check.function:<15}{check.points:>7}{check.deviation:>10.1e}"
            f"{check.allowed:>10.1e}  {'pass' if check.passed else 'FAIL'}"
            f"     {check.at_phi:.6g}, {check.at_delta:.6g}"
        )
    if not report.passed:
        click.echo("Error: the table is out of its own tolerance", err=True)
        raise SystemExit(FAILED)

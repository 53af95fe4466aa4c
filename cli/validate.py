"""``puck validate``: judge a table."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click
from puck_tables.cli.options import FILE, printable, progress, tables_named

if TYPE_CHECKING:
    from puck_tables.table.check import CheckReport

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
        click.echo(printable(_lines(report, table.second)))
        passed = passed and report.passed
    if not passed:
        click.echo("Error: the table is out of its own tolerance", err=True)
        raise SystemExit(FAILED)


def _lines(report: CheckReport, second: str) -> str:
    text = [
        f"{report.source}: tolerance {report.tolerance:g}",
        f"{'check':<36}{'function':<15}{'points':>7}{'largest':>10}{'allowed':>10}  result"
        f"   at phi, {second}",
    ]
    for check in report.checks:
        text.append(
            f"{check.name:<36}{check.function:<15}{check.points:>7}{check.deviation:>10.1e}"
            f"{check.allowed:>10.1e}  {'pass' if check.passed else 'FAIL'}"
            f"     {check.at_phi:.6g}, {check.at_second:.6g}"
        )
    return "\n".join(text)

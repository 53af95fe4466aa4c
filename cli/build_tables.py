"""``puck build-tables``: tabulate the resultants."""

from __future__ import annotations

from pathlib import Path

import click
from puck_tables.cli.info import describe
from puck_tables.cli.options import FILE, NUMBER, prepare_outputs, progress, told

from puck_tables.errors import InputError


@click.command("build-tables")
@click.option(
    "--accuracy",
    type=NUMBER,
    help="Largest error of the resultants, 1e-13 to 0.01.  [default: 2e-11]",
)
@click.option("--n-phi", type=int, help="Number of phi nodes instead: odd, at least 9.")
@click.option("--n-delta", type=int, help="Number of delta nodes, at least 4.  [default: 4, exact]")
@click.option(
    "-o",
    "--output",
    type=FILE,
    metavar="FILE",
    default="resultants.h5",
    show_default=True,
    help="The table file.",
)
@click.option("--overwrite", is_flag=True, help="Replace the file if it exists.")
def build_tables(
    accuracy: float | None, n_phi: int | None, n_delta: int | None, output: Path, overwrite: bool
) -> None:  # fmt: skip
    """Tabulate the friction resultants and measure how exact the table is.

    \b
    puck build-tables --accuracy 1e-8 -o coarse.h5
    puck build-tables --n-phi 1025 -o fine.h5
    """  # noqa: D301 - click reads the backspace
    if output.suffix.lower() != ".h5":
        raise InputError(f"{output}: a table is an HDF5 file: give a name that ends in .h5")
    prepare_outputs(output, overwrite=overwrite)
    from puck_tables.table.build import build_table
    from puck_tables.table.file import save_table

    with progress("tabulating") as show:
        table = build_table(accuracy, n_phi, n_delta, show)
    command = "puck build-tables"
    for name, value in (("--accuracy", accuracy), ("--n-phi", n_phi), ("--n-delta", n_delta)):
        if value is not None:
            command += f" {name} {value}"
    written = save_table(table, output, overwrite, command)
    told(output)
    click.echo(describe(written))

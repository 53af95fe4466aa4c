"""``puck build-tables``: tabulate the resultants, or the stops."""

from __future__ import annotations

from pathlib import Path

import click
from puck_tables.cli.info import describe
from puck_tables.cli.options import FILE, NUMBER, prepare_outputs, progress, told

from puck_tables.errors import InputError


@click.command("build-tables")
@click.option(
    "--kind",
    type=click.Choice(["resultants", "stops"]),
    default="resultants",
    show_default=True,
    help="Friction resultants, or stops and the way to them.",
)
@click.option(
    "--accuracy",
    type=NUMBER,
    help="Largest error: of resultants 1e-13 to 0.01 [default: 2e-11], of stops 1e-11 to 0.01 in "
    "units of Q/J and Q^2/J [default: 1e-10].",
)
@click.option("--n-phi", type=int, help="Resultants: number of phi nodes instead, odd, at least 9.")
@click.option(
    "--n-delta",
    type=int,
    help="Resultants: number of delta nodes, at least 4.  [default: 4, exact]",
)
@click.option("--cells", type=int, help="Stops: cells on either side of phi = pi/4 instead.")
@click.option(
    "-o", "--output", type=FILE, metavar="FILE", help="The table file.  [default: KIND.h5]"
)
@click.option("--overwrite", is_flag=True, help="Replace the file if it exists.")
def build_tables(
    kind: str, accuracy: float | None, n_phi: int | None, n_delta: int | None, cells: int | None,
    output: Path | None, overwrite: bool,
) -> None:  # fmt: skip
    """Tabulate friction resultants or stops, and measure how exact the table is.

    \b
    puck build-tables --accuracy 1e-8 -o coarse.h5
    puck build-tables --n-phi 1025 -o fine.h5
    puck build-tables --kind stops --accuracy 1e-11 -o fine-stops.h5
    """  # noqa: D301 - click reads the backspace
    options = {"--accuracy": accuracy, "--n-phi": n_phi, "--n-delta": n_delta, "--cells": cells}
    given = {name: value for name, value in options.items() if value is not None}
    for name in ("--n-phi", "--n-delta") if kind == "stops" else ("--cells",):
        if name in given:
            raise InputError(f"{name} does not go with --kind {kind}")
    path = Path(f"{kind}.h5") if output is None else output
    if path.suffix.lower() != ".h5":
        raise InputError(f"{path}: a table is an HDF5 file: give a name that ends in .h5")
    prepare_outputs(path, overwrite=overwrite)
    command = " ".join(
        ["puck build-tables", *(["--kind stops"] if kind == "stops" else [])]
        + [f"{name} {value}" for name, value in given.items()]
    )
    if kind == "stops":
        from puck_tables.similarity.build import build_stop_table
        from puck_tables.similarity.file import save_stop_table

        with progress("tabulating") as show:
            stops = build_stop_table(accuracy, cells, show)
        text = describe(save_stop_table(stops, path, overwrite, command))
    else:
        from puck_tables.table.build import build_table
        from puck_tables.table.file import save_table

        with progress("tabulating") as show:
            table = build_table(accuracy, n_phi, n_delta, show)
        text = describe(save_table(table, path, overwrite, command))
    told(path)
    click.echo(text)

"""``puck tradeoff``: accuracy against speed, measured on this machine."""

from __future__ import annotations

from pathlib import Path

import click
from puck_tables.cli.options import FILE, Outputs, outputs
from puck_tables.cli.printing import progress


@click.command()
@click.option("--quick", is_flag=True, help="Fewer repeats and points: under a minute.")
@click.option("-o", "--output", "files", type=FILE, metavar="FILE", multiple=True,
              help="Save everything: .h5, or .csv.  May be given twice.")  # fmt: skip
@outputs(None)
def tradeoff(quick: bool, files: tuple[Path, ...], out: Outputs) -> None:
    """Measure accuracy against speed of every method to answer.

    Resultants, stops, trajectories and states: by closed forms, tables, integrators, look-up, and
    by what others do; worst and median error, cost on one thread, memory.  Some minutes.

    \b
    puck tradeoff --quick
    puck tradeoff -o tradeoff.h5 -o tradeoff.csv --plot tradeoff.png
    """  # noqa: D301 - click reads the backspace
    for path in files:
        Outputs(path, overwrite=out.overwrite).prepare()
    out.prepare(others=files)
    from puck_tables.tradeoff.measurement import measure

    with progress("measuring") as show:
        measured = measure(quick, show)
    for path in files:
        Outputs(path, overwrite=out.overwrite).deliver(measured)
    out.deliver(measured)
    click.echo(measured)

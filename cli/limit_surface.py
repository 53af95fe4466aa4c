"""``puck limit-surface``: force and torque that friction takes up, over the direction of slip."""

from __future__ import annotations

from pathlib import Path

import click
from puck_tables.cli.options import (
    FILE,
    NUMBER,
    body_options,
    chosen_puck,
    deliver,
    output_options,
    prepare_outputs,
    puck_options,
)


@click.command("limit-surface")
@click.option(
    "--points",
    type=click.IntRange(5, 1_000_001),
    default=181,
    show_default=True,
    help="How many slip angles.",
)
@puck_options(mass=True)
@click.option("--delta", type=NUMBER, help="delta = 2 f h / r instead.  [default: 0.5]")
@body_options()
@click.option(
    "-o",
    "--output",
    type=FILE,
    metavar="FILE",
    help="Save it: .h5, .csv, .json, .jsonl or .parquet.  Without -o and --plot, CSV goes to "
    "stdout.",
)
@output_options
def limit_surface(
    points: int, radius: float | None, height: float | None, friction: float | None,
    gravity: float | None, mass: float | None, decel: float | None, delta: float | None,
    pressure: str, gyration: float | None, output: Path | None, plot: Path | None, overwrite: bool,
) -> None:  # fmt: skip
    """Tabulate the limit surface of a puck, and what planar pushing takes for it.

    Force and torque that a pusher gives to keep a slip going, over phi = atan2(r w, v) for a
    velocity along x; the outward normal in (F, M/r), which is the twist for delta = 0.  The best
    ellipsoid and the best convex polynomial of order 4 are told on stderr, with their errors.

    \b
    puck limit-surface --radius 0.0381 --height 0.0254 --friction 0.1 --mass 0.17 -o surface.csv
    puck limit-surface --delta 0 --pressure ring --plot surface.png
    """  # noqa: D301 - click reads the backspace
    prepare_outputs(output, plot=plot, overwrite=overwrite, inputs=(pressure,))
    puck = chosen_puck(
        radius, height, friction, gravity, delta, decel, pressure, gyration, mass=mass
    )
    surface = puck.limit_surface(points)
    deliver(surface, output, plot, overwrite)
    if output is None and plot is None:
        from puck_tables.io.csv import encode

        click.echo(encode(surface.dataset()).decode(), nl=False)
    click.echo(surface.explain(), err=True)

"""``puck limit-surface``: force and torque that friction takes up, over the direction of slip."""

from __future__ import annotations

import click
from puck_tables.cli.options import RESULTS, Outputs, PuckChoice, outputs, packed, puck_options


@click.command("limit-surface")
@click.option("--points", type=click.IntRange(5, 1_000_001),
              help="How many slip angles.  [default: 181; with --base 31]")  # fmt: skip
@packed("choice", PuckChoice, *puck_options(mass=True))
@outputs(f"Save it: {RESULTS}.  Without -o and --plot, CSV goes to stdout.")
def limit_surface(points: int | None, choice: PuckChoice, out: Outputs) -> None:
    """Tabulate the limit surface of a puck, and what planar pushing takes for it.

    Force and torque that a pusher gives to keep a slip going, over phi = atan2(r w, v) for a
    velocity along x; the outward normal in (F_x, F_y, M/r), which is the twist for delta = 0.
    With --base over the direction of slip, too, with the radius of gyration for r.  The best
    ellipsoid and the best convex polynomial of order 4 are told on stderr, with their errors.

    \b
    puck limit-surface --radius 0.0381 --height 0.0254 --friction 0.1 --mass 0.17 -o surface.csv
    puck limit-surface --delta 0 --pressure ring --plot surface.png
    puck limit-surface --base box:0.2x0.1 --friction 0.3 --plot surface.png
    """  # noqa: D301 - click reads the backspace
    out.prepare(choice.pressure)
    surface = choice.puck().limit_surface(points)
    out.deliver(surface, printed=True)
    click.echo(surface.explain(), err=True)

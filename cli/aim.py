"""``puck aim``: launches that come to rest at a given place."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import TYPE_CHECKING

import click
from puck_tables.cli.options import (
    FILE,
    NUMBER,
    Vector,
    body_options,
    deliver,
    output_options,
    prepare_outputs,
    puck_given,
    puck_options,
)

from puck_tables.errors import InputError

if TYPE_CHECKING:
    from puck_tables.stopping.aim import Aim


@click.command()
@click.option(
    "--target",
    type=Vector(),
    required=True,
    help="Where to stop, in m from the launch, like 2,0.1.",
)
@click.option("--w0", type=NUMBER, help="The launch with this spin, in rad/s, with its sign.")
@click.option("--speed", type=NUMBER, help="The launches with this speed, in m/s.")
@click.option(
    "--time", "stop_time", type=NUMBER, help="The launches that stop after this time, in s."
)
@click.option("--max-speed", type=NUMBER, help="No launch faster than this, in m/s.")
@click.option("--max-spin", type=NUMBER, help="No launch with more spin than this, in rad/s.")
@click.option(
    "--count",
    type=int,
    default=8,
    show_default=True,
    help="Slip angles of a sample, for each sense of spin.",
)
@puck_options(mass=False)
@click.option("--delta", type=NUMBER, help="delta = 2 f h / r instead.  [default: 0.5]")
@body_options
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")
@click.option("-o", "--output", type=FILE, metavar="FILE", help="Save the launches: .csv.")
@output_options
def aim(
    target: tuple[float, float], w0: float | None, speed: float | None, stop_time: float | None,
    max_speed: float | None, max_spin: float | None, count: int, radius: float | None,
    height: float | None, friction: float | None, gravity: float | None, decel: float | None,
    delta: float | None, pressure: str, gyration: float | None, as_json: bool,
    output: Path | None, plot: Path | None, overwrite: bool,
) -> None:  # fmt: skip
    """Find launches after which a puck comes to rest at a target.

    There is one for each slip angle and sense of spin.  --w0, --speed or --time picks one or two;
    without them a sample of the family is shown.  Each is integrated, and how far from the target
    that ends stands in the last column.  That there is none is an answer too.

    \b
    puck aim --target 2,0.1 --w0 5
    puck aim --target 2,0.1 --time 3
    puck aim --target 2,0.1 --max-speed 1.5 --max-spin 10 --plot aim.png
    """  # noqa: D301 - click reads the backspace
    picked = [
        n for n, v in (("--w0", w0), ("--speed", speed), ("--time", stop_time)) if v is not None
    ]
    if len(picked) > 1:
        raise InputError(f"{picked[0]} and {picked[1]} clash: each picks a launch")
    prepare_outputs(output, plot=plot, overwrite=overwrite, inputs=(pressure,))
    puck = puck_given(radius, height, friction, gravity, delta, decel, pressure, gyration)
    found = puck.aim(
        target, spin=w0, speed=speed, stop_time=stop_time, max_speed=max_speed, max_spin=max_spin,
        count=count,
    )  # fmt: skip
    something = found.launch_spin.size > 0
    deliver(found, output, plot if something else None, overwrite)
    if plot is not None and not something:
        click.echo(f"no picture: there is nothing to draw in {plot}", err=True)
    if as_json:
        click.echo(json.dumps(found.summary()))
    else:
        given = any(x is not None for x in (radius, height, friction, delta, decel))
        click.echo(_report(found, "" if given else "   (defaults: see --help for a real puck)"))


def _report(found: Aim, note: str) -> str:
    """The answer, and the launches line by line."""
    x, y = found.target
    puck = found.puck
    kind = f", {puck.body.kind}" if puck.body.kind else ""
    text = [
        f"puck    r = {puck.radius:g} m, delta = {puck.delta:.6g}, "
        f"J = {puck.decel:.6g} m/s^2{kind}{note}",
        f"target  ({x:g}, {y:g}) m",
        f"answer  {found.answer}",
    ]
    if found.launch_spin.size:
        text.append(
            f"\n{'w0 rad/s':>13} {'v0 x m/s':>12} {'v0 y m/s':>12} {'speed m/s':>12}"
            f" {'heading deg':>11} {'phi deg':>8} {'time s':>12} {'miss m':>7}"
        )
    for n in range(found.launch_spin.size):
        degrees = [math.degrees(a) for a in (found.launch_heading[n], found.launch_slip_angle[n])]
        text.append(
            f"{found.launch_spin[n]:>13.6g} {found.launch_vx[n]:>12.6g} {found.launch_vy[n]:>12.6g}"
            f" {found.launch_speed[n]:>12.6g} {degrees[0]:>11.5f} {degrees[1]:>8.3f}"
            f" {found.stop_time[n]:>12.6g} {found.miss[n]:>7.0e}"
        )
    return "\n".join(text)

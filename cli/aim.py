"""``puck aim``: launches that come to rest at a given place."""

from __future__ import annotations

import json
import math
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from puck_tables.cli.board_aim import aim_on_board, number_or_name
from puck_tables.cli.options import (
    FILE,
    NUMBER,
    SPEED,
    SPIN,
    TIME,
    body_options,
    chosen_puck,
    deliver,
    json_option,
    output_options,
    prepare_outputs,
    puck_options,
)
from puck_tables.cli.scene_run import files_read, scene_options, scene_tables
from puck_tables.cli.values import Vector

from puck_tables.errors import InputError
from puck_tables.kernels.patience import one_question

if TYPE_CHECKING:
    from puck_tables._core.arrays import FloatArray
    from puck_tables.motion.puck_spec import PuckSpec
    from puck_tables.stopping.aim_at_targets import Aim, Aims

_LARGEST_FILE = 1 << 30  # bytes: more is no file of targets, and would fill the memory


@click.command()
@click.option(
    "--target",
    "targets",
    type=Vector("m"),
    multiple=True,
    help="Where to stop, in m from the launch, like 2,0.1; in a scene, on the board.",
)
@click.option(
    "--targets",
    "targets_file",
    type=FILE,
    metavar="FILE",
    help="Many at once: a CSV file of x,y in m, one target a line.",
)
@click.option("--pocket", "pockets", multiple=True, metavar="NUMBER", help="In a scene: which.")
@click.option("--puck", "puck_name", metavar="NAME", help="In a scene: which is to end there.")
@click.option("--striker", metavar="NAME", help="In a scene: which is sent off.")
@click.option("--hits", metavar="NAME", help="In a scene: a puck to be hit on the way.")
@click.option("--max-impacts", type=int, help="In a scene: at most so many.  [default: 3]")
@click.option("--w0", type=SPIN, help="The launch with this spin, in rad/s, with its sign.")
@click.option("--speed", type=SPEED, help="The launches with this speed, in m/s.")
@click.option(
    "--time", "stop_time", type=TIME, help="The launches that stop after this time, in s."
)
@click.option("--max-speed", type=SPEED, help="No launch faster than this, in m/s.")
@click.option("--max-spin", type=SPIN, help="No launch with more spin than this, in rad/s.")
@click.option(
    "--count",
    type=int,
    help="Slip angles of a sample, for each sense of spin [default: 8]; in a scene launches "
    "that are given [default: 16].",
)
@puck_options(mass=False)
@click.option("--delta", type=NUMBER, help="delta = 2 f h / r instead.  [default: 0.5]")
@body_options()
@json_option
@click.option(
    "-o",
    "--output",
    type=FILE,
    metavar="FILE",
    help="Save the launches: .csv, .h5, .jsonl or .parquet.",
)
@output_options
@scene_options
@click.pass_context
def aim(
    ctx: click.Context, targets: tuple[tuple[float, float], ...], targets_file: Path | None,
    pockets: tuple[str, ...],
    puck_name: str | None, striker: str | None, hits: str | None, max_impacts: int | None,
    w0: float | None, speed: float | None, stop_time: float | None,
    max_speed: float | None, max_spin: float | None, count: int | None, radius: float | None,
    height: float | None, friction: float | None, gravity: float | None, decel: float | None,
    delta: float | None, pressure: str, gyration: float | None, as_json: bool,
    output: Path | None, plot: Path | None, overwrite: bool, scene: str | None,
    changes: tuple[str, ...],
) -> None:  # fmt: skip
    """Find launches after which a puck comes to rest at a target.

    There is one for each slip angle and sense of spin.  --w0, --speed or --time picks one or two;
    without them a sample of the family is shown.  Each is integrated, and how far from the target
    that ends stands in the last column.  That there is none is an answer too.

    \b
    puck aim --target 2,0.1 --w0 5
    puck aim --target 2,0.1 --time 3
    puck aim --target 2,0.1 --max-speed 1.5 --max-spin 10 --plot aim.png
    puck aim --targets holes.csv --time 3 -o shots.csv

    With --scene others lie on the board: launches of the striker after which a puck, or it itself,
    ends at a target or in a pocket, also off cushions and other pucks.  Each is run on the whole
    board; those whose end changes least with heading and speed come first.

    \b
    puck aim --scene curling-take-out --puck yellow --target 0.5,-0.5
    puck aim --scene crokinole --puck shot --pocket 0 --plot shot.png
    """  # noqa: D301 - click reads the backspace
    picked = [
        n for n, v in (("--w0", w0), ("--speed", speed), ("--time", stop_time)) if v is not None
    ]
    if len(picked) > 1:
        raise InputError(f"{picked[0]} and {picked[1]} clash: each picks a launch")
    for name, given in (("--target", targets), ("--pocket", pockets)):
        if len(given) > 1:
            raise InputError(f"{name} is given {len(given)} times: one place at a time")
    if targets_file is not None and targets:
        raise InputError("--target and --targets both say where: give one of them")
    if scene is not None or changes:
        if targets_file is not None:
            raise InputError("--targets has no place in a scene: give one --target")
        own = (
            "targets", "pockets", "puck_name", "striker", "hits", "w0", "speed", "max_speed",
            "max_spin", "max_impacts", "count",
        )  # fmt: skip
        if stop_time is not None:
            raise InputError("--time has no place in a scene: leave it out")
        tables = scene_tables(ctx, scene, changes, own)
        prepare_outputs(output, plot=plot, overwrite=overwrite, inputs=files_read(scene, tables))
        wishes = {
            "target": targets[0] if targets else None, "pocket": pockets[0] if pockets else None,
            "puck": number_or_name(puck_name), "striker": number_or_name(striker),
            "hits": number_or_name(hits), "spin": w0, "speed": speed, "max_speed": max_speed,
            "max_spin": max_spin, "max_impacts": max_impacts, "count": count,
        }  # fmt: skip
        given_wishes = {name: wish for name, wish in wishes.items() if wish is not None}
        aim_on_board(tables, scene or "scene", given_wishes, as_json, output, plot, overwrite)
        return
    _refuse_of_scenes(pockets, puck_name, striker, hits, max_impacts)
    if not targets and targets_file is None:
        raise click.MissingParameter(param_hint="'--target'", param_type="option")
    read = (pressure, targets_file)
    prepare_outputs(output, plot=plot, overwrite=overwrite, inputs=read)
    with one_question() if targets_file is None else nullcontext():
        puck = chosen_puck(radius, height, friction, gravity, delta, decel, pressure, gyration)
        where = targets[0] if targets_file is None else _read_targets(targets_file)
        result: Any = puck.aim(
            where, spin=w0, speed=speed, stop_time=stop_time, max_speed=max_speed,
            max_spin=max_spin, count=8 if count is None else count,
        )  # fmt: skip
    something = result.launch_spin.size > 0
    deliver(result, output, plot if something else None, overwrite)
    if plot is not None and not something:
        click.echo(f"no picture: there is nothing to draw in {plot}", err=True)
    if as_json:
        click.echo(json.dumps(result.summary()))
    else:
        told = any(x is not None for x in (radius, height, friction, delta, decel))
        note = "" if told else "   (defaults: see --help for a real puck)"
        click.echo(_report(result, note) if targets_file is None else _in_short(result, note))


def _read_targets(path: Path) -> FloatArray:
    """Places (n, 2) from a file."""
    from puck_tables._core.quantities import X, Y
    from puck_tables._core.read_columns import numbers_of

    return numbers_of(path, (X, Y), 2, _LARGEST_FILE).rows


def _refuse_of_scenes(
    pockets: tuple[str, ...], puck: str | None, striker: str | None, hits: str | None,
    max_impacts: int | None,
) -> None:  # fmt: skip
    """Refuse what needs other pucks."""
    for name, given in (
        ("--pocket", pockets), ("--puck", puck), ("--striker", striker), ("--hits", hits),
        ("--max-impacts", max_impacts),
    ):  # fmt: skip
        if given not in (None, ()):
            raise InputError(f"{name} is for a board: give --scene FILE|NAME, too")


def _puck_line(puck: PuckSpec, note: str) -> str:
    kind = f", {puck.body.kind}" if puck.body.kind else ""
    return (
        f"puck    r = {puck.radius:g} m, delta = {puck.delta:.6g}, "
        f"J = {puck.decel:.6g} m/s^2{kind}{note}"
    )


def _in_short(result: Aims, note: str) -> str:
    """How many launches there are, and how well they do."""
    first, *others = result.explain().splitlines()
    lines = [_puck_line(result.puck, note), f"answer  {first.rstrip('.')}", *others]
    return "\n".join(lines)


def _report(result: Aim, note: str) -> str:
    """The answer, and the launches line by line."""
    x, y = result.target
    text = [_puck_line(result.puck, note), f"target  ({x:g}, {y:g}) m", f"answer  {result.answer}"]
    if result.launch_spin.size:
        text.append(
            f"\n{'w0 rad/s':>13} {'v0 x m/s':>12} {'v0 y m/s':>12} {'speed m/s':>12}"
            f" {'heading deg':>11} {'phi deg':>8} {'time s':>12} {'miss m':>7}"
        )
    for n in range(result.launch_spin.size):
        degrees = [math.degrees(a) for a in (result.launch_heading[n], result.launch_slip_angle[n])]
        text.append(
            f"{result.launch_spin[n]:>13.6g} {result.launch_vx[n]:>12.6g} "
            f"{result.launch_vy[n]:>12.6g}"
            f" {result.launch_speed[n]:>12.6g} {degrees[0]:>11.5f} {degrees[1]:>8.3f}"
            f" {result.stop_time[n]:>12.6g} {result.miss[n]:>7.0e}"
        )
    return "\n".join(text)

"""``puck reference``: benchmark cases with their exact answer, at the times of an engine."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from puck_tables.cli.completion import cases
from puck_tables.cli.options import (
    FILE,
    NUMBER,
    TIME,
    deliver,
    explain_option,
    json_option,
    output_options,
    prepare_outputs,
    reported,
)
from puck_tables.cli.values import Times

from puck_tables.errors import InputError
from puck_tables.kernels.patience import one_question

if TYPE_CHECKING:
    from puck_tables.reference.answer import Answer
    from puck_tables.reference.floor_friction import FloorFriction


@click.command()
@click.argument("case", required=False, shell_complete=cases)
@click.option("--dt", type=TIME, help="Time between two frames, s.")
@click.option("--fps", type=NUMBER, help="Frames a second.")
@click.option(
    "--times",
    type=FILE,
    metavar="FILE",
    help="The times of the frames, s: one a line, or the column t of a table.",
)
@click.option(
    "--epsilon",
    type=Times(),
    metavar="E1,E2,...|START:STOP:COUNT",
    help="Force and torque on the floor at these v/(r w), in place of the motion.",
)
@click.option("--friction", is_flag=True, help="The same at 81 of them from 0.01 to 100.")
@explain_option
@json_option
@click.option(
    "-o",
    "--output",
    type=FILE,
    metavar="FILE",
    help="Save: .h5, .csv, .json, .jsonl or .parquet, each with bounds of the errors.",
)
@output_options
def reference(
    case: str | None, dt: float | None, fps: float | None, times: Path | None,
    epsilon: tuple[float, ...] | None, friction: bool, explain: bool, as_json: bool,
    output: Path | None, plot: Path | None, overwrite: bool,
) -> None:  # fmt: skip
    """Give the exact answer to a benchmark CASE; without one, list the cases.

    The height of a puck is the full height of a homogeneous cylinder, its centre of mass lies half
    as high.  Angles and spins are counter-clockwise positive.

    \b
    puck reference
    puck reference coin
    puck reference coin --dt 0.001 -o coin.csv --plot coin.png
    puck reference slide-spin-5 --times mine.csv -o exact.h5
    puck reference coin --friction -o friction.csv
    puck reference astride-spin --fps 1000 -o astride.csv
    """  # noqa: D301 - click reads the backspace
    if case is None:
        click.echo(_listed(as_json))
        return
    frames: dict[str, Any] = {"dt": dt, "fps": fps, "times": times}
    over = epsilon is not None or friction
    if over and any(value is not None for value in frames.values()):
        raise InputError(
            "--epsilon and --friction are of no motion: leave --dt, --fps, --times out"
        )
    if epsilon is not None and friction:
        raise InputError("--epsilon and --friction both choose the ratios: give one of them")
    prepare_outputs(output, plot=plot, overwrite=overwrite, inputs=(times,))
    result: Any
    with one_question():
        if over:
            from puck_tables.reference.floor_friction import floor_friction

            result = floor_friction(case, epsilon)
        else:
            from puck_tables.reference.answer import reference_case

            result = reference_case(case, **frames)
    deliver(result, output, plot, overwrite)
    words = _friction if over else report
    reported(result, explain, False, _with_columns if as_json else words)


def _listed(as_json: bool) -> str:
    from puck_tables.reference.cases import CASES

    if as_json:
        fields = ("name", "version", "title", "tests")
        return json.dumps([{name: getattr(case, name) for name in fields} for case in CASES])
    width = max(len(case.name) for case in CASES)
    return "\n".join(f"{case.name:<{width}}  {case.version}  {case.title}" for case in CASES)


def _with_columns(result: Answer | FloorFriction) -> str:
    """The summary and the columns of a file as one JSON object."""
    from puck_tables.io.json import encode

    columns = json.loads(encode(result.dataset()))["columns"]
    return json.dumps({**result.summary(), "columns": columns}, allow_nan=False)


def report(answer: Answer) -> str:
    """A case and its answer."""
    from puck_tables.reference.case_text import lines_of

    lines = lines_of(answer)
    lines["frames"] = (
        f"{answer.time.size} from {answer.time.min():g} to {answer.time.max():.6g} s: -o FILE "
        "saves them, --json prints them"
    )
    return "\n".join(f"{name:<12} {text}" for name, text in lines.items())


def _friction(result: FloorFriction) -> str:
    """A few rows of force and torque over ε."""
    head = f"{'v/(r w)':>12} {'r w/v':>12} {'F along/fN':>14} {'F across/fN':>14} {'M/(fNr)':>14}"
    step = max(1, result.epsilon.size // 20)
    rows = [
        f"{result.epsilon[n]:>12.6g} {result.slip_ratio[n]:>12.6g} {result.share_along[n]:>14.10f} "
        f"{result.share_across[n]:>14.10f} {result.share_torque[n]:>14.10f}"
        for n in range(0, result.epsilon.size, step)
    ]
    what = (
        f"{result.case.label}: on the floor, fN = {result.load:.6g} N, r = {result.puck.radius:g} m"
    )
    if step > 1:
        rows.append(
            f"one row in {step} of {result.epsilon.size}: -o FILE saves all, --json prints them"
        )
    return "\n".join([what, head, *rows])

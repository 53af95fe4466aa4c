"""``puck reference``: benchmark cases with their exact answer, at the times of an engine."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from puck_tables.cli.completion import cases
from puck_tables.cli.options import FILE, RESULTS, Outputs, number, outputs
from puck_tables.cli.printing import columns, listed
from puck_tables.cli.values import Times, not_none

from puck_tables.errors import InputError
from puck_tables.kernels.patience import one_question

if TYPE_CHECKING:
    from puck_tables.reference.answer import Answer
    from puck_tables.reference.floor_friction import FloorFriction

_ROWS = 20  # of friction that are shown


@click.command()
@click.argument("case", required=False, shell_complete=cases)
@number("--dt", "s", help="Time between two frames, s.")
@number("--fps", help="Frames a second.")
@click.option("--times", type=FILE, metavar="FILE",
              help="The times of the frames, s: one a line, or the column t of a table."
              )  # fmt: skip
@number("--epsilon", "", Times, metavar="E1,E2,...|START:STOP:COUNT",
        help="Force and torque on the floor at these v/(r w), in place of the motion.")  # fmt: skip
@click.option("--friction", is_flag=True, help="The same at 81 of them from 0.01 to 100.")
@outputs(f"Save: {RESULTS}, each with bounds of the errors.", explain=True, as_json=True)
def reference(
    case: str | None, dt: float | None, fps: float | None, times: Path | None,
    epsilon: tuple[float, ...] | None, friction: bool, out: Outputs,
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
        click.echo(_listed(out.as_json))
        return
    frames = not_none({"dt": dt, "fps": fps, "times": times})
    over = epsilon is not None or friction
    if over and frames:
        raise InputError(
            "--epsilon and --friction are of no motion: leave --dt, --fps, --times out"
        )
    if epsilon is not None and friction:
        raise InputError("--epsilon and --friction both choose the ratios: give one of them")
    out.prepare(times)
    result: Any
    with one_question():
        if over:
            from puck_tables.reference.floor_friction import floor_friction

            result = floor_friction(case, epsilon)
        else:
            from puck_tables.reference.answer import reference_case

            result = reference_case(case, **frames)
    out.deliver(result)
    words = _friction if over else report
    replace(out, as_json=False).report(result, _with_columns if out.as_json else words)


def _listed(as_json: bool) -> str:
    from puck_tables.reference.cases import CASES

    if as_json:
        fields = ("name", "version", "title", "tests")
        return json.dumps([{name: getattr(case, name) for name in fields} for case in CASES])
    return listed({case.name: f" {case.version}  {case.title}" for case in CASES})


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
    return listed(lines, 12)


def _friction(result: FloorFriction) -> str:
    """A few rows of force and torque over ε."""
    heads = {
        "v/(r w)": ".6g", "F along/fN": ".10f", "F across/fN": ".10f",
        "M/(fNr)": ".10f",
    }  # fmt: skip
    step = max(1, result.epsilon.size // _ROWS)
    rows = zip(
        *(values[::step] for values in (
            result.epsilon, result.share_along, result.share_across,
            result.share_torque,
        )), strict=True,
    )  # fmt: skip
    what = f"on the floor, fN = {result.load:.6g} N, r = {result.puck.radius:g} m"
    lines = [f"{result.case.label}: {what}", columns(heads, rows)]
    if step > 1:
        lines.append(
            f"one row in {step} of {result.epsilon.size}: -o FILE saves all, --json prints them"
        )
    return "\n".join(lines)

"""``puck compare``: runs of an engine against the exact answer to a case."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

import click
from puck_tables.cli.completion import cases
from puck_tables.cli.options import (
    FILE,
    TIME,
    deliver,
    explain_option,
    json_option,
    note,
    output_options,
    prepare_outputs,
    reported,
)
from puck_tables.cli.values import Times

if TYPE_CHECKING:
    from puck_tables.reference.comparison import Comparison

_SHORT = {
    "step": "step", "rest_time": "rests after", "rest_time_error": "its error",
    "stop_place_error": "stop off by", "place_error_max": "place off by",
    "speed_error_max": "v off by", "spin_error_max": "w off by", "epsilon_seen": "v/(r w)",
    "epsilon_error": "its error",
}  # fmt: skip


@click.command()
@click.argument("files", type=FILE, nargs=-1, required=True, metavar="THEIRS...")
@click.option("--case", required=True, shell_complete=cases, help="Which: see 'puck reference'.")
@click.option(
    "--threshold",
    "thresholds",
    multiple=True,
    metavar="SPEED|SPIN",
    help="Slower counts as at rest: 0.1rad/s or 1mm/s; as often as needed.  [default: "
    "hypot(v, r w) below 1 % of that of the launch]",
)
@click.option(
    "--steps",
    type=Times("s"),
    metavar="DT1,DT2,...",
    help="Step of the engine in each file, s.  [default: the distance of its rows]",
)
@click.option("--columns", metavar="NAMES", help="Headings in place of the file's, - to leave out.")
@click.option("--unit", help="Of lengths (and velocities, a second) where a file says none: m.")
@click.option("--angle-unit", help="Of angles (and spins, a second) where a file says none: rad.")
@click.option("--up", help="The axis that points up, y or z, where there are three.")
@click.option("--puck", help="Which puck, of a case of several: its name.")
@click.option(
    "--launch-time",
    type=TIME,
    default=0.0,
    show_default=True,
    help="When the launch is in the files, s.",
)
@explain_option
@json_option
@click.option(
    "-o",
    "--output",
    type=FILE,
    metavar="FILE",
    help="Save, a row a file: .h5, .csv, .json, .jsonl or .parquet.",
)
@click.option("--report", type=FILE, metavar="FILE.html", help="One page with all of it.")
@output_options
def compare(
    files: tuple[Path, ...], case: str, thresholds: tuple[str, ...],
    steps: tuple[float, ...] | None, columns: str | None, unit: str | None, angle_unit: str | None,
    up: str | None, puck: str | None, launch_time: float, explain: bool, as_json: bool,
    output: Path | None, report: Path | None, plot: Path | None, overwrite: bool,
) -> None:  # fmt: skip
    """Say what runs of an engine are off by in a case, and what only seems to be an error.

    THEIRS are tables with columns t, x, y and an angle or a quaternion (qw qx qy qz), velocities vx
    vy and the spin w, in any order, with units in the header; several files of falling step give
    the order of convergence.

    \b
    puck compare mine.csv --case coin
    puck compare a.csv b.csv c.csv --case coin --threshold 0.1rad/s --report coin.html
    puck compare log.csv --case tall-1 --unit m --angle-unit rad --up z
    """  # noqa: D301 - click reads the backspace
    prepare_outputs(output, plot=plot, others=(report,), overwrite=overwrite, inputs=files)
    if report is not None:
        from puck_tables.plot.comparison_page import checked_page

        checked_page(report)
    from puck_tables.reference.comparison import compare as compared

    result = compared(
        files, case, columns=columns, unit=unit, angle_unit=angle_unit, up=up, puck=puck,
        launch_time=launch_time, thresholds=thresholds, steps=steps,
    )  # fmt: skip
    deliver(result, output, plot, overwrite)
    if report is not None:
        from puck_tables.plot.comparison_page import save_page

        save_page(result, report, overwrite)
        note(report)
    reported(result, explain, as_json, in_words)


def in_words(result: Comparison) -> str:
    """The numbers of every run in a table, and what they say."""
    from puck_tables.io.columns import COLUMNS

    answer = result.answer
    lines = [
        f"case {answer.case.label}: {answer.case.title}",
        f"exact: {result.whose}{answer.end} after {result.end_time:.9g} s, known to "
        f"{answer.time_bound:.1e} s and {answer.place_bound:.1e} m",
        f"rest counts from {', '.join(map(str, result.thresholds))} on; errors: theirs less exact",
        "",
    ]
    width = max(4, *(len(run.log.name) for run in result.runs))
    units = [COLUMNS[name].unit for name in _SHORT]
    heads = [f"{word} {'' if unit == '1' else unit}".rstrip()
             for word, unit in zip(_SHORT.values(), units, strict=True)]  # fmt: skip
    lines.append(f"{'file':<{width}} " + " ".join(f"{head:>14}" for head in heads))
    for run, row in zip(result.runs, result.rows(), strict=True):
        cells = (f"{row[name]:.6g}" if math.isfinite(row[name]) else "-" for name in _SHORT)
        lines.append(f"{run.log.name:<{width}} " + " ".join(f"{cell:>14}" for cell in cells))
    if untold := result.untold():
        lines += ["", "not told:", *(f"  {one}" for one in untold)]
    if fallen := result.convergence():
        lines += ["", "as the step falls:", *(f"  {name}: {what}" for name, what in fallen.items())]
    if truths := result.truths():
        lines += ["", "truth and not error:", *(f"  {one}" for one in truths)]
    return "\n".join(lines)

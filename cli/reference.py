"""``puck reference``, ``compare``: cases at the times of an engine, and its runs beside them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from puck_tables.cli.completion import cases
from puck_tables.cli.options import FILE, RESULTS, Outputs, number, outputs, packed
from puck_tables.cli.printing import note
from puck_tables.cli.values import Times, not_none

from puck_tables.errors import InputError
from puck_tables.kernels.patience import one_question
from puck_tables.report.lines_and_tables import listed

if TYPE_CHECKING:
    from puck_tables.reference.answer import Answer
    from puck_tables.reference.floor_reaction import FloorFriction


@click.command()
@click.argument("files", type=FILE, nargs=-1, required=True, metavar="THEIRS...")
@packed(
    "how", dict,
    click.option("--case", required=True, shell_complete=cases,
                 help="Which: see 'puck reference'."),
    click.option("--threshold", "thresholds", multiple=True, metavar="SPEED|SPIN",
                 help="Slower counts as at rest: 0.1rad/s or 1mm/s; as often as needed.  "
                 "[default: hypot(v, r w) below 1 % of that of the launch]"),
    number("--steps", "s", Times, metavar="DT1,DT2,...",
           help="Step of the engine in each file, s.  [default: the distance of its rows]"),
    click.option("--columns", metavar="NAMES",
                 help="Headings in place of the file's, - to leave out."),
    click.option("--unit", help="Of lengths (and velocities, a second) where a file says none: m."),
    click.option("--angle-unit",
                 help="Of angles (and spins, a second) where a file says none: rad."),
    click.option("--up", help="The axis that points up, y or z, where there are three."),
    click.option("--puck", help="Which puck, of a case of several: its name."),
    number("--launch-time", "s", default=0.0, show_default=True,
           help="When the launch is in the files, s."),
)  # fmt: skip
@click.option("--report", type=FILE, metavar="FILE.html", help="One page with all of it.")
@outputs(f"Save, a row a file: {RESULTS}.", explain=True, as_json=True)
def compare(
    files: tuple[Path, ...], how: dict[str, Any], report: Path | None, out: Outputs
) -> None:
    """Say what runs of an engine are off by in a case, and what only seems to be an error.

    THEIRS are tables with columns t, x, y and an angle or a quaternion (qw qx qy qz), velocities vx
    vy and the spin w, in any order, with units in the header; several files of falling step give
    the order of convergence.

    \b
    puck compare mine.csv --case coin
    puck compare a.csv b.csv c.csv --case coin --threshold 0.1rad/s --report coin.html
    puck compare log.csv --case tall-1 --unit m --angle-unit rad --up z
    """  # noqa: D301 - click reads the backspace
    out.prepare(*files, others=(report,))
    if report is not None:
        from puck_tables.plot.html_page import checked_page

        checked_page(report)
    from puck_tables.reference.comparison import compare as compared

    result = compared(files, **how)
    out.deliver(result)
    if report is not None:
        from puck_tables.plot.comparison_figure import page
        from puck_tables.plot.html_page import save_page

        save_page(page, result, report, out.overwrite)
        note(report)
    out.report(result)


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
            from puck_tables.reference.floor_reaction import floor_friction

            result = floor_friction(case, epsilon)
        else:
            from puck_tables.reference.answer import reference_case

            result = reference_case(case, **frames)
    out.deliver(result)
    out.report(result, summary=_with_columns)


def _listed(as_json: bool) -> str:
    from puck_tables.reference.cases import CASES

    if as_json:
        fields = ("name", "version", "title", "tests")
        return json.dumps([{name: getattr(case, name) for name in fields} for case in CASES])
    return listed({case.name: f" {case.version}  {case.title}" for case in CASES})


def _with_columns(result: Answer | FloorFriction) -> dict[str, Any]:
    """The summary, and the columns of a file."""
    from puck_tables.io.json import encode

    return {**result.summary(), "columns": json.loads(encode(result.dataset()))["columns"]}

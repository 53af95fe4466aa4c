"""``puck reference``, ``compare``, ``limit-surface``, ``export``: for engines and robots.

Cases at the times of an engine, and its runs beside them; force and torque that friction takes up,
over the direction of slip; and the look-ups as a source file of another language.
"""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from puck_tables.cli.options import (
    FILE,
    RESULTS,
    Outputs,
    PuckChoice,
    PuckCommand,
    body_options,
    number,
    outputs,
    packed,
    puck_options,
)
from puck_tables.cli.printing import note
from puck_tables.cli.scene_run import SceneChoice, scene_options, scene_tables
from puck_tables.cli.values import Times, cases, not_none

from puck_tables.errors import InputError
from puck_tables.kernels.patience import one_question
from puck_tables.report.lines_and_tables import listed

if TYPE_CHECKING:
    from puck_tables.reference.answer import Answer
    from puck_tables.reference.floor_reaction import FloorFriction


@click.command(cls=PuckCommand)
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


@click.command(cls=PuckCommand)
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


@click.command("limit-surface", cls=PuckCommand)
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


@click.command(cls=PuckCommand)
@click.option("--language", required=True, metavar="NAME",
              help="c, js or python; of a scene c or js.")  # fmt: skip
@click.option("--target", metavar="MACHINE", help="Of a scene in C: x86_64- or aarch64- before "
              "linux, macos or windows.  [default: this machine]")  # fmt: skip
@click.option("--what", default="stop,state,resultants", show_default=True, metavar="PARTS",
              help="Where and when launches stop, states at any time, friction resultants;"
                   " of a --base wrench, of friction, and a step of its motion."
              )  # fmt: skip
@number("--tol", default=1e-6, show_default=True,
        help="Largest error, in units of Q/(f g), Q^2/(f g), Q: 1e-9 to 0.01.")  # fmt: skip
@packed("choice", PuckChoice, *body_options())
@scene_options
@outputs("The file.", plot=False, required=True)
@click.pass_context
def export(
    ctx: click.Context, language: str, target: str | None, what: str, tol: float,
    choice: PuckChoice, chosen: SceneChoice, out: Outputs,
) -> None:  # fmt: skip
    """Write one self-contained source file that computes motions without this program.

    The tables are in it, as small as the error allows, the licence, and self_test, which returns
    how many numbers of the test vectors in the file are missed: 0.  For one pressure law and one
    radius of gyration, and all heights under which the whole base stays loaded: delta up to 1 under
    uniform pressure, 0.8 under Hertz's, 4/3 under Galin's, 2 on a ring, 1 + a^2 on annulus:a.

    \b
    puck export --language c -o puck.c
    puck export --language c --pressure annulus:0.8 --gyration 0.905539 -o washer.c
    puck export --language js --what stop,state --tol 1e-4 -o puck.js
    puck export --language c --base box:0.2x0.1 --what wrench -o box.c

    With --scene it plays a board, as World does in Python (strike, place, drive, advance, state,
    copy): engine and scene in WebAssembly for browsers and Node, beside it types for TypeScript, or
    a header in C, beside it a static library of machine code, for C++, Rust and C# as well.  The
    same calls give the same bits in all of them.

    \b
    puck export --language js --scene carrom-break -o carrom.js
    puck export --language c --scene carrom-break -o carrom.h
    puck export --language c --target aarch64-linux --scene carrom-break -o carrom.h
    """  # noqa: D301 - click reads the backspace
    if chosen:
        return _export_board(ctx, language, target, chosen, out)
    if target is not None:
        raise InputError("--target is for a board: give --scene FILE|NAME, too")
    from puck_tables.export.source import checked_ending, checked_request, export_source

    parts = checked_request(language, what, tol)
    assert out.output is not None
    checked_ending(out.output, language)
    out.prepare(choice.pressure, saved=False)
    source = export_source(language, parts, tol, choice.puck())
    click.echo(repr(source), err=True)
    out.deliver(source)


def _export_board(
    ctx: click.Context, language: str, target: str | None, chosen: SceneChoice, out: Outputs
) -> None:
    """Write what plays the board of a scene."""
    from puck_tables.export.board_source import companion_path, export_board
    from puck_tables.world.scene import Scene

    if language not in ("c", "js"):
        raise InputError(f"--language {language}: boards are exported to c and js")
    tables = scene_tables(ctx, chosen, ("language", "target"))
    assert out.output is not None
    name = re.sub(r"\W", "_", out.output.stem, flags=re.ASCII)
    companion = companion_path(out.output, language, name)
    out.prepare(*chosen.reads(tables), others=(companion,), saved=False)
    scene = Scene.from_tables(tables, chosen.name)
    source = export_board(scene, language, target=target, name=name)
    click.echo(repr(source), err=True)
    out.deliver(source)
    note(companion)

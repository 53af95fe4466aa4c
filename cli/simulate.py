"""``puck simulate``: one trajectory."""

from __future__ import annotations

from contextlib import nullcontext
from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from click.core import ParameterSource
from puck_tables.cli.options import (
    FILE,
    Outputs,
    PuckChoice,
    number,
    outputs,
    packed,
    puck_options,
    table_option,
)
from puck_tables.cli.printing import say
from puck_tables.cli.scene_run import SceneChoice, scene_options, scene_tables
from puck_tables.cli.values import Times, Vector

from puck_tables.accuracy.methods import INTEGRATORS
from puck_tables.errors import InputError
from puck_tables.kernels.patience import one_question

if TYPE_CHECKING:
    from puck_tables.puck import Puck
    from puck_tables.result import TimedResult


@click.command()
@click.option("--fit", "fit_path", type=FILE, metavar="FILE",
              help="The puck and the launch that 'puck fit -o FILE.json' found.")  # fmt: skip
@click.option("--track", help="Which track of --fit, by its name or number from 1.")
@number("--v0", "m/s", Vector, help="Launch velocity in m/s, like 1,0.")
@number("--w0", "rad/s", default=0.0, show_default=True, help="Launch spin in rad/s.")
@packed("choice", PuckChoice, *puck_options(mass=True))
@click.option("--frames", type=int, help="Number of states to save.  [default: 101]")
@number("--times", "s", Times, help="Times of the states to save, in s.")
@number("--tol", default=1e-9, show_default=True, help="Largest error, in units of Q/(f g) (times) "
        "and Q^2/(f g) (places), Q = hypot(v0, r w0): the cheapest method whose measured error is "
        "below it is taken.")  # fmt: skip
@click.option("--method", type=click.Choice([method.value for method in INTEGRATORS]),
              help="Dormand-Prince 5(4), or Runge-Kutta 4.  [default: the cheaper]")  # fmt: skip
@click.option("--exact", is_flag=True, help="Closed forms instead of the table.")
@table_option
@outputs(movie=True, explain=True, as_json=True)
@scene_options
@click.pass_context
def simulate(
    ctx: click.Context, fit_path: Path | None, track: str | None,
    v0: tuple[float, float] | None, w0: float, choice: PuckChoice, frames: int | None,
    times: tuple[float, ...] | None, tol: float, method: str | None, exact: bool,
    table_path: Path | None, out: Outputs, chosen: SceneChoice,
) -> None:  # fmt: skip
    """Slide one puck until it stops, or run a scene of one or of several.

    \b
    puck simulate --v0 1,0 --w0 5
    puck simulate --v0 2,0 --w0 30 --radius 0.0381 --height 0.0254 --friction 0.1
    puck simulate --v0 1,0 --w0 5 --frames 200 -o run.csv --plot run.png
    puck simulate --scene air-hockey --set launch.spin=100 --plot air-hockey.png
    puck simulate --scene carrom-break --movie carrom.html
    puck simulate --v0 1,0 --w0 5 --delta 2
    puck simulate --v0 1,0 --w0 5 --pressure annulus:0.8 --gyration 0.9
    puck simulate --v0 1,0 --w0 10 --base box:20cmx10cm --friction 0.3 --plot box.png
    puck simulate --fit fit.json --track 1
    """  # noqa: D301 - click reads the backspace
    unknown: tuple[str, ...] = ()
    run: TimedResult
    report_only = out.output is None and out.plot is None and times is None
    if chosen:
        from puck_tables.world.scene import Scene

        tables = scene_tables(ctx, chosen)
        out.prepare(*chosen.reads(tables))
        board = isinstance(tables.get("puck"), list)  # quicker by what was compiled before
        with nullcontext() if board else one_question():
            run = Scene.from_tables(tables, chosen.name).simulate((0.0,) if report_only else times)
    else:
        if track is not None and fit_path is None:
            raise InputError("--track chooses a track of --fit: give that, too")
        if exact and table_path is not None:
            raise InputError("--exact and --table clash: closed forms need no table")
        out.prepare(table_path, choice.pressure, choice.base, fit_path)
        if fit_path is not None:
            puck, launch, unknown = _from_fit(ctx, fit_path, track)
        elif v0 is not None:
            puck, launch = choice.puck(), {"velocity": v0, "spin": w0}
        else:
            raise click.MissingParameter(param_hint="'--v0'", param_type="option")
        from puck_tables.table.resultant_table import ResultantTable

        with one_question():
            run = puck.simulate(
                **launch, frames=1 if report_only and frames is None else frames, times=times,
                tol=tol, method=method, exact=exact,
                table=None if table_path is None else ResultantTable.load(table_path),
            )  # fmt: skip
    for sentence in unknown:
        say(f"{fit_path}: {sentence}", err=True)
    out.deliver(run)
    out.report(run, "" if chosen or fit_path else choice.note)


def _from_fit(
    ctx: click.Context, path: Path, track: str | None
) -> tuple[Puck, dict[str, Any], tuple[str, ...]]:
    """The puck and the launch of a fit, which no option contradicts, and what it left open."""
    for name in ("v0", "w0", *(one.name for one in fields(PuckChoice))):
        if ctx.get_parameter_source(name) is ParameterSource.COMMANDLINE:
            raise InputError(
                f"--fit and --{name} clash: the file of the fit has the puck and its launch"
            )
    from puck_tables.fitting.fit_files import puck_and_launch

    return puck_and_launch(path, track)

"""``puck simulate``, ``explore``, ``scene``: one trajectory, its page, and scene files."""

from __future__ import annotations

import webbrowser
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
    PuckCommand,
    number,
    outputs,
    packed,
    puck_options,
    table_option,
)
from puck_tables.cli.printing import note, say
from puck_tables.cli.scene_run import SceneChoice, scene_options, scene_tables
from puck_tables.cli.values import Times, Vector, scenes

from puck_tables.accuracy.methods import INTEGRATORS
from puck_tables.errors import InputError, OutputError
from puck_tables.kernels.patience import one_question
from puck_tables.report.lines_and_tables import listed

if TYPE_CHECKING:
    from puck_tables.puck import Puck
    from puck_tables.result import TimedResult


@click.command(cls=PuckCommand)
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
    from puck_tables.fitting.numbers import puck_and_launch

    return puck_and_launch(path, track)


@click.command(cls=PuckCommand)
@scene_options
@outputs("Only write the page there.", plot=False, file="FILE.html")
@click.pass_context
def explore(ctx: click.Context, chosen: SceneChoice, out: Outputs) -> None:
    """Open a page in which a launch is dragged, and its motion seen at once.

    One file, without a server or a network: path, stop, speeds and their ratio over time, pressure
    under the base, stop times around; click where the puck shall stop.  Of pucks under uniform
    pressure, Hertz's, that of a washer and of a hoop, whole base loaded, within 1e-6 of Q/(f g) and
    Q^2/(f g); or of a flat base that you draw, within 5e-6.

    \b
    puck explore
    puck explore -o explorer.html

    With --scene it is a board to play on: drag a puck, and see its way and that of all others
    before you let it go; lead a mallet.

    \b
    puck explore --scene carrom-break
    """  # noqa: D301 - click reads the backspace
    from puck_tables._core.own_folder import make_private, user_cache
    from puck_tables._core.safe_write import write_bytes

    if out.output is not None:
        if out.output.suffix.lower() not in (".html", ".htm"):
            raise InputError(f"{out.output}: the explorer is a page: call it FILE.html")
        out.prepare(saved=False)
        write_bytes(out.output, _page(ctx, chosen).encode(), out.overwrite)
        note(out.output)
        return
    folder = user_cache()
    if folder is None:
        raise InputError(
            "there is no cache folder to put the page in: say where, with -o FILE.html"
        )
    try:
        make_private(folder)
    except OSError as error:
        raise OutputError(f"{folder}: {error.strerror or error}: give -o FILE.html") from None
    page = folder / ("board.html" if chosen else "explorer.html")
    write_bytes(page, _page(ctx, chosen).encode(), overwrite=True)
    note(page)
    if not webbrowser.open(page.as_uri()):
        click.echo("No browser could be opened: open that file in one.", err=True)


def _page(ctx: click.Context, chosen: SceneChoice) -> str:
    """The explorer, or the board of a scene."""
    from puck_tables.explore.page import explorer_page

    if not chosen:
        return explorer_page()
    from puck_tables.plot.played_board import board_page
    from puck_tables.world.scene import Scene

    return board_page(Scene.from_tables(scene_tables(ctx, chosen), chosen.name))


@click.group()
def scene() -> None:
    """Scene files: list, show and check them, and what may stand in them.

    A scene is one puck or several, a floor, launches and what acts on them, in SI units; 'puck
    simulate --scene' and 'puck sweep --scene' run it.
    """


@scene.command("list")
def list_scenes() -> None:
    """List the scenes that come along."""
    from puck_tables.scene.library import shipped_scenes

    click.echo(listed(shipped_scenes(), 24))


@scene.command()
@click.argument("name", shell_complete=scenes)
def show(name: str) -> None:
    """Print a scene that comes along, to start one of your own from.

    \b
    puck scene show incline > mine.toml
    """  # noqa: D301 - click reads the backspace
    from puck_tables.scene.library import shipped_text

    click.echo(shipped_text(name), nl=False)


@scene.command("fields")
def list_fields() -> None:
    """List every entry that a scene may have: what is allowed, its default, what it is."""
    from puck_tables._core.fields import described
    from puck_tables.world.scene import Scene

    for path, allowed, text in described(Scene):
        click.echo(f"{path:<24} {allowed:<44} {text}".rstrip())


@scene.command()
@click.argument("name", metavar="FILE|NAME", shell_complete=scenes)
def check(name: str) -> None:
    """Check a scene: every error at once, or what it holds and how it would be run."""
    from puck_tables.world.plan import plan_of
    from puck_tables.world.prepare import prepared
    from puck_tables.world.scene import Scene
    from puck_tables.world.scene_ends import axes_of

    whole = Scene.load(name)
    prepared(whole)  # files and heights
    say(f"{name}: a scene" + (f", {whole.title}" if whole.title else ""))
    for path, values in axes_of(whole).items():
        click.echo(f"ranges        {path} from {values[0]:g} to {values[-1]:g}, {values.size}")
    say(plan_of(whole)[1])

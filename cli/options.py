"""Options that several commands share, and how their values are read."""

from __future__ import annotations

import json
import os
import sys
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click
from puck_tables.cli.completion import laws
from puck_tables.cli.values import NumberParam

from puck_tables.errors import InputError

if TYPE_CHECKING:
    from puck_tables.puck import Puck
    from puck_tables.result import Result, TimedResult
    from puck_tables.table.resultant_table import ResultantTable
    from puck_tables.table.table import Table

Command = TypeVar("Command", bound=Callable[..., Any])
Progress = Callable[[int, int], None]

# dimensionless, m/s²: of a puck that nothing is said of, as the library has it
DEFAULT_DELTA, DEFAULT_DECEL = 0.5, 1.0
QUIET_TIME, BETWEEN_LINES = 2.0, 10.0  # s, where stderr is no terminal

NUMBER, LENGTH, SPEED, SPIN, TIME = map(NumberParam, ("", "m", "m/s", "rad/s", "s"))
FILE = click.Path(readable=False, path_type=Path)


def puck_options(mass: bool, kind: type[NumberParam] = NumberParam) -> Callable[[Command], Command]:
    """The puck and the floor: by δ and J, or by dimensions and friction; numbers of one kind."""
    options = [
        click.option(
            "--radius",
            type=kind("m"),
            help="Radius r in m, or with its unit: 38.1mm.  [default: 1]",
        ),
        click.option(
            "--height",
            type=kind("m"),
            help="Height h of the puck in m, twice that of its centre of mass; with --friction.",
        ),
        click.option("--friction", type=kind(), help="Coulomb coefficient f; with --height."),
        click.option("--gravity", type=kind("m/s^2"), help="Gravity in m/s^2.  [default: 9.80665]"),
        click.option("--decel", type=kind("m/s^2"), help="J = f g in m/s^2 instead.  [default: 1]"),
    ]
    if mass:
        options.insert(
            4, click.option("--mass", type=NumberParam("kg"), help="Mass in kg (energies, forces).")
        )

    def decorate(command: Command) -> Command:
        for option in reversed(options):
            command = option(command)
        return command

    return decorate


def body_options(
    kind: type[NumberParam] = NumberParam, many: bool = False
) -> Callable[[Command], Command]:
    """The kind of puck: how it presses on the floor and how its mass is spread.

    ``kind``: of the radius of gyration; ``many``: whether several laws may be given.
    """
    words = "Contact pressure: uniform, galin, hertz, ring, annulus:INNER, or a CSV file of rho, W."
    if many:
        words += "  As often as wanted; annulus:START:STOP:COUNT is a range of them."
    options = [
        click.option(
            "--gyration",
            type=kind(),
            help="Radius of gyration about the vertical axis over r (a ratio, also with --radius), "
            "0.1 to 10.  [default: 0.7071, homogeneous]",
        ),
        click.option(
            "--pressure",
            metavar="LAW",
            shell_complete=laws,
            default=("uniform",) if many else "uniform",
            multiple=many,
            show_default=True,
            help=words,
        ),
    ]

    def decorate(command: Command) -> Command:
        for option in options:
            command = option(command)
        return command

    return decorate


def base_option(command: Command) -> Command:
    """The base of a puck that is not round, or whose centre of mass is not its middle."""
    return click.option(
        "--base",
        metavar="BASE",
        help="In place of --radius: box:LENGTHxWIDTH, disc:RADIUS, annulus:RADIUSxINNER, in m or "
        "with units (box:20cmx10cm), or a CSV file of corners x, y; @X,Y after it is the centre of "
        "mass.  --gyration is then in m.",
    )(command)


def output_options(command: Command) -> Command:
    """Where results go."""
    for option in (
        click.option(
            "--overwrite",
            is_flag=True,
            help="Replace output files that exist; pictures and movies always are.",
        ),
        click.option("--plot", type=FILE, metavar="FILE", help="Draw: .png, .svg or .pdf."),
    ):
        command = option(command)
    return command


def table_option(command: Command) -> Command:
    """Which table to use."""
    return click.option(
        "--table", "table_path", type=FILE, metavar="FILE",
        help="Table file of 'puck build-tables'.  [default: the one that comes along]",
    )(command)  # fmt: skip


def json_option(command: Command) -> Command:
    """A report as JSON."""
    return click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")(command)


def explain_option(command: Command) -> Command:
    """Whether to say what the tolerance led to."""
    return click.option(
        "--explain", is_flag=True, help="Say which method was taken, and why (on stderr)."
    )(command)


def explained(result: Result) -> None:
    """Say on stderr how a result was got."""
    click.echo(printable(result.explain()), err=True)


def reported(result: Any, explain: bool, as_json: bool, in_words: Callable[[Any], str]) -> None:
    """A report on stdout, in words or as JSON; if asked for, on stderr how it was got."""
    if explain:
        explained(result)
    if as_json:
        click.echo(json.dumps(result.summary(), allow_nan=False))
    else:
        click.echo(printable(in_words(result)))


def chosen_puck(
    radius: float | None,
    height: float | None,
    friction: float | None,
    gravity: float | None,
    delta: float | None,
    decel: float | None,
    pressure: str,
    gyration: float | None,
    mass: float | None = None,
    base: str | None = None,
) -> Puck:
    """The puck from either set of options: by its dimensions and friction, or by δ and J.

    On a base it is flat where no height is given, and has f = 1 where no friction is.

    Raises
    ------
    InputError
        If options of both sets are given (naming two of them), or one set is not complete.
    """
    from puck_tables.puck import Puck

    kind = {"pressure": pressure, "gyration": gyration, "mass": mass}
    real = {"--height": height, "--friction": friction, "--gravity": gravity}
    scaled = {"--delta": delta, "--decel": decel}
    given_real = [name for name, value in real.items() if value is not None]
    given_scaled = [name for name, value in scaled.items() if value is not None]
    if given_real and given_scaled:
        raise InputError(
            f"{given_real[0]} and {given_scaled[0]} clash: give the real puck (--radius --height "
            "--friction --gravity) or the scaled one (--radius --delta --decel)"
        )
    if base is not None:
        if radius is not None or delta is not None:
            other = "--radius" if radius is not None else "--delta"
            raise InputError(f"--base and {other} clash: {other} is of round pucks")
        if given_real and friction is None:
            raise InputError(f"{given_real[0]} needs --friction too")
        if not given_real:
            friction, gravity = 1.0, DEFAULT_DECEL if decel is None else decel
        numbers = {"height": height, "friction": friction, "gravity": gravity}
        return Puck(**_only(base=base, **numbers, **kind))
    if given_real:
        needed = {"--radius": radius, "--height": height, "--friction": friction}
        missing = [name for name, value in needed.items() if value is None]
        if missing:
            raise InputError(
                f"{given_real[0]} needs {' and '.join(missing)} too: a real puck is given by "
                "--radius --height --friction (and --gravity)"
            )
        dimensions = {"radius": radius, "height": height, "friction": friction, "gravity": gravity}
        return Puck(**_only(**dimensions, **kind))
    return Puck.similar(**_only(radius=radius, delta=delta, decel=decel, **kind))


def _only(**values: Any) -> dict[str, Any]:
    """Those that were given."""
    return {name: value for name, value in values.items() if value is not None}


def prepare_outputs(
    *outputs: Path | None, plot: Path | None = None, movie: Path | None = None,
    others: Iterable[Path | None] = (), overwrite: bool, inputs: Iterable[Path | str | None] = (),
) -> None:  # fmt: skip
    """Refuse, before any work, what could not be written, or would replace what is read.

    Parameters
    ----------
    outputs : files of results, in the format that the ending says
    plot, movie : a picture, a movie
    others : further files that are written
    overwrite : whether existing files may be replaced; a picture or movie may by another
    inputs : the files that the command reads; names that are no files are left out
    """
    from puck_tables._core.safe_write import check_target
    from puck_tables.io.formats import encoder_for

    for path in outputs:
        if path is not None:
            encoder_for(path)
    if plot is not None:
        from puck_tables.plot.style import checked_kind, require_matplotlib

        checked_kind(plot)
        require_matplotlib()
    if movie is not None:
        from puck_tables.plot.movie import checked_movie

        checked_movie(movie)
    chosen: list[Path] = []
    for path in (*outputs, plot, movie, *others):
        if path is None:
            continue
        target = check_target(path, overwrite or (path in (plot, movie) and _redrawn(path)))
        for other in chosen:
            if _same(target, other):
                raise InputError(f"{path} is named for two outputs: give two file names")
        for read in inputs:
            if read is not None and os.path.isfile(read) and _same(target, Path(read)):
                raise InputError(f"{path} is read by this command: give the output another name")
        chosen.append(path)


def _redrawn(path: Path) -> bool:
    """Whether a picture or a movie lies there, that is drawn again without a word."""
    from puck_tables.plot.style import may_replace

    return may_replace(path)


def deliver(result: Result, output: Path | None, plot: Path | None, overwrite: bool) -> None:
    """Save and draw a result, and say so on stderr."""
    if output is not None:
        result.save(output, overwrite)
        note(output)
    if plot is not None:
        result.plot(plot, overwrite=overwrite)
        note(plot)


def filmed(run: TimedResult, movie: Path | None, overwrite: bool) -> None:
    """Make a movie of a motion, and say so on stderr."""
    if movie is not None:
        run.movie(movie, overwrite)
        note(movie)


def _same(one: Path, other: Path) -> bool:
    """Whether two names lead to one file, that may not be there yet."""
    if os.path.exists(one) and os.path.exists(other):
        return os.path.samefile(one, other)
    return os.path.realpath(one) == os.path.realpath(other)


def printable(text: str) -> str:
    r"""A text, perhaps from a file, without what a terminal would obey.

    Examples
    --------
    >>> printable("red: " + chr(27) + "[31m")
    'red: \\x1b[31m'
    """
    return "".join(
        sign if sign.isprintable() or sign == "\n" else repr(sign)[1:-1] for sign in text
    )


def open_table(path: Path | None) -> ResultantTable:
    """The table of resultants asked for."""
    from puck_tables.table.resultant_table import ResultantTable

    return ResultantTable.shipped() if path is None else ResultantTable.load(path)


def tables_named(path: Path | None) -> list[Table]:
    """The table in a file, of any kind, or those that come along."""
    from puck_tables.table.table import Table

    return [Table.shipped(), Table.shipped("stops")] if path is None else [Table.load(path)]


def note(path: Path) -> None:
    """Say on stderr that a file was written."""
    click.echo(f"wrote {click.format_filename(path)}", err=True)


@contextmanager
def progress(label: str) -> Iterator[Progress]:
    """A progress bar on stderr; where that is no terminal a line now and then, if it takes long."""
    if sys.stderr is None:
        yield lambda done, total: None
        return
    if not sys.stderr.isatty():
        due = time.monotonic() + QUIET_TIME

        def say(done: int, total: int) -> None:
            nonlocal due
            if time.monotonic() >= due:
                click.echo(f"{label}: {100 * done // total} %", err=True)
                due = time.monotonic() + BETWEEN_LINES

        yield say
        return
    with click.progressbar(length=1000, label=label, file=sys.stderr, show_pos=False) as bar:

        def show(done: int, total: int) -> None:
            bar.update(1000 * done // total - bar.pos)

        yield show


@contextmanager
def said_first(label: str) -> Iterator[Progress]:
    """The same for work that nobody asked for by name: said before it begins."""
    if sys.stderr is not None and not sys.stderr.isatty():
        click.echo(label, err=True)
    with progress(label) as show:
        yield show

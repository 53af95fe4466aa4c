"""Options that several commands share, and what they make together: a puck, outputs."""

from __future__ import annotations

import json
import os
from collections import Counter
from collections.abc import Callable, Container, Iterable
from dataclasses import asdict, dataclass
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click
from puck_tables.cli.printing import note, say
from puck_tables.cli.values import DOUBTS, SAID, NumberParam, laws, not_none

from puck_tables._core.doubts import MOST_FRICTION, OF_A_PUCK
from puck_tables.errors import InputError

if TYPE_CHECKING:
    from puck_tables.puck import Puck
    from puck_tables.table.table import Table

Command = TypeVar("Command", bound=Callable[..., Any])
Option = Callable[[Command], Command]

# dimensionless, m/s²: of a puck that nothing is said of, as the library has it
DEFAULT_DELTA, DEFAULT_DECEL = 0.5, 1.0
SCALED = "delta", "decel"  # in place of height, friction and gravity
RESULTS = ".h5, .csv, .json, .jsonl or .parquet"

FILE = click.Path(readable=False, path_type=Path)


class PuckCommand(click.Command):
    """A command that questions its numbers at its end, and takes no option of one value twice."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Read what is given, each option once unless it may be repeated."""
        *_, order = self.make_parser(ctx).parse_args(list(args))
        for one, times in Counter(order).items():
            if (
                times > 1 and isinstance(one, click.Option) and not one.multiple
                and (one.secondary_opts or not one.is_flag)  # a flag says the same again
            ):  # fmt: skip
                flag = "/".join([*one.opts[:1], *one.secondary_opts])
                raise InputError(f"{flag} is given twice: give it once")
        return super().parse_args(ctx, args)

    def invoke(self, ctx: click.Context) -> Any:
        """Run it, and question its numbers; wrong usage is said alone."""
        from puck_tables._core.doubts import question, unquestioned

        doubts = ctx.meta.pop(DOUBTS, [])
        try:
            with unquestioned({number for _, number, *_ in ctx.meta.pop(SAID, [])}):
                return super().invoke(ctx)
        except click.UsageError:
            doubts = []
            raise
        finally:
            for one in doubts:
                question(*one)


def number(
    flag: str, unit: str = "", kind: type[NumberParam] = NumberParam, usual: float = 0.0,
    **more: Any,
) -> Option[Any]:  # fmt: skip
    """An option that takes numbers of one kind, in a unit; one beyond the usual is questioned."""
    return click.option(flag, type=kind(unit, usual), **more)


# of a puck: the unit of each, up to which it is usual, and what it is
PUCK_NUMBERS = {
    "radius": ("m", OF_A_PUCK, "Radius r in m, or with its unit: 38.1mm."),
    "height": ("m", OF_A_PUCK, "Height h of the puck in m, twice that of its centre of mass"),
    "friction": ("", MOST_FRICTION, "Coulomb coefficient f"),
    "gravity": ("m/s^2", 0.0, "Gravity in m/s^2.  [default: 9.80665]"),
    "mass": ("kg", 0.0, "Mass in kg (energies, forces)."),
}


def puck_number(name: str, more: str = "", kind: type[NumberParam] = NumberParam) -> Option[Any]:
    """The option of a number of a puck, with more words on it."""
    unit, usual, words = PUCK_NUMBERS[name]
    return number(f"--{name}", unit, kind, usual, help=words + more)


def packed(name: str, make: Callable[..., Any], *options: Option[Any]) -> Option[Any]:
    """Options that a command gets as one argument: what is made of them by their names."""

    def decorate(command: Callable[..., Any]) -> Callable[..., Any]:
        @wraps(command)
        def whole(*arguments: Any, **values: Any) -> Any:
            mine = {one: values.pop(one) for one in names}
            return command(*arguments, **values, **{name: make(**mine)})

        before = len(getattr(whole, "__click_params__", ()))
        for option in reversed(options):
            option(whole)
        names = [one.name for one in getattr(whole, "__click_params__")[before:]]  # noqa: B009
        return whole

    return decorate


def puck_options(
    mass: bool = False, kind: type[NumberParam] = NumberParam, many: bool = False
) -> list[Option[Any]]:
    """The puck and the floor: by δ and J, or by dimensions and friction; numbers of one kind.

    ``mass``: whether it may be given; ``many``: several pressure laws.
    """
    return [
        number("--delta", "", kind, help="delta = 2 f h / r.  [default: 0.5]"),
        puck_number("radius", "  [default: 1]", kind),
        puck_number("height", "; with --friction.", kind),
        puck_number("friction", "; with --height.", kind),
        puck_number("gravity", "", kind),
        *([puck_number("mass")] if mass else []),
        number("--decel", "m/s^2", kind, help="f g in m/s^2 instead of --friction.  [default: 1]"),
        *body_options(kind, many),
    ]  # fmt: skip


def body_options(kind: type[NumberParam] = NumberParam, many: bool = False) -> list[Option[Any]]:
    """The kind of puck: how it presses on the floor, how its mass is spread, its base."""
    words = "Contact pressure: uniform, galin, hertz, ring, annulus:INNER, or a CSV file of rho, W."
    if many:
        words += "  As often as wanted; annulus:START:STOP:COUNT is a range of them."
    return [
        click.option("--pressure", metavar="LAW", shell_complete=laws, multiple=many, help=words,
                     default=("uniform",) if many else "uniform", show_default=True),
        number("--gyration", "", kind, help="Radius of gyration about the vertical axis over r (a "
               "ratio, also with --radius), 0.1 to 10.  [default: 0.7071, homogeneous]"),
        click.option(
            "--base", metavar="BASE", help="In place of --radius: box:LENGTHxWIDTH, disc:RADIUS, "
            "annulus:RADIUSxINNER, polygon:X,Y;X,Y;X,Y, feet:RADIUS;X,Y;X,Y (or X,Y,LOAD), in m or "
            "with units (box:20cmx10cm), or a CSV file of corners x, y; @X,Y after it is the "
            "centre of mass.  --gyration is then in m.",
        ),
    ]  # fmt: skip


@dataclass(frozen=True)
class PuckChoice:
    """A puck from either set of options: by its dimensions and friction, or by δ and J."""

    pressure: str
    gyration: float | None = None
    radius: float | None = None
    height: float | None = None
    friction: float | None = None
    gravity: float | None = None
    delta: float | None = None
    decel: float | None = None
    mass: float | None = None
    base: str | None = None

    @property
    def note(self) -> str:
        """What is said where nothing of it was chosen, or its size without friction."""
        chosen = {*not_none(asdict(self))}
        if chosen & {"radius", "base"} and not chosen & {"friction", "decel"}:
            more = "" if self.base else " and --height, or --decel"
            return f"f g is a default: give --friction{more}."
        if chosen - {"pressure", "mass"}:
            return ""
        return "The puck is a default one: --help says how to give a real one."

    def puck(self) -> Puck:
        """The puck; on a base it is flat without a height, and has f = 1 without a friction."""
        from puck_tables.puck import Puck

        chosen = not_none(asdict(self))
        real = real_numbers(chosen)
        if self.base is not None:
            if real and "friction" not in chosen:
                raise InputError(f"--{real[0]} needs --friction too")
            if not real:
                chosen |= {"friction": 1.0, "gravity": chosen.pop("decel", DEFAULT_DECEL)}
            return Puck(**chosen)
        if not real:
            return Puck.similar(**chosen)
        missing = [f"--{n}" for n in ("radius", "height", "friction") if n not in chosen]
        if missing:
            raise InputError(
                f"--{real[0]} needs {' and '.join(missing)} too: a real puck is given by "
                "--radius --height --friction (and --gravity)"
            )
        return Puck(**chosen)


def real_numbers(chosen: Container[str]) -> list[str]:
    """Which of the numbers chosen are of a real puck; with those of a scaled one they are refused.

    As those of a round one are with a base.
    """
    real = [name for name in ("height", "friction", "gravity") if name in chosen]
    scaled = [name for name in SCALED if name in chosen]
    if real and scaled:
        raise InputError(
            f"--{real[0]} and --{scaled[0]} clash: give the real puck (--radius --height "
            "--friction --gravity) or the scaled one (--radius --delta --decel)"
        )
    for other in ("radius", "delta"):
        if "base" in chosen and other in chosen:
            raise InputError(f"--base and --{other} clash: --{other} is of round pucks")
    return real


@dataclass(frozen=True)
class Outputs:
    """Where a result goes: files, a picture, a movie, and what is printed of it."""

    output: Path | None = None
    plot: Path | None = None
    overwrite: bool = False
    movie: Path | None = None
    explain: bool = False
    as_json: bool = False

    def prepare(
        self, *inputs: Path | str | None, others: Iterable[Path | None] = (), saved: bool = True
    ) -> None:
        """Refuse, before any work, what could not be written, or would replace what is read.

        ``inputs``: the files that the command reads; names that are no files are left out;
        ``others``: further files that are written; ``saved``: whether the output is a result, in
        the format that its ending says.
        """
        from puck_tables._core.safe_write import check_target
        from puck_tables.io.formats import encoder_for
        from puck_tables.plot.style import checked_kind, may_replace, require_matplotlib

        if saved and self.output is not None:
            encoder_for(self.output)
        if self.plot is not None:
            checked_kind(self.plot)
            require_matplotlib()
        if self.movie is not None:
            from puck_tables.plot.movie import checked_movie

            checked_movie(self.movie)
        chosen: list[Path] = []
        for path in (self.output, self.plot, self.movie, *others):
            if path is None:
                continue
            again = path in (self.plot, self.movie) and may_replace(path)
            target = check_target(path, self.overwrite or again)
            if any(_same(target, other) for other in chosen):
                raise InputError(f"{path} is named for two outputs: give two file names")
            if any(read and os.path.isfile(read) and _same(target, Path(read)) for read in inputs):
                raise InputError(f"{path} is read by this command: give the output another name")
            chosen.append(path)

    def deliver(self, result: Any, printed: bool = False, empty: bool = False) -> None:
        """Save, draw and film a result, and say so on stderr; what is empty is not drawn.

        ``printed``: whether CSV goes to stdout where no file is named.
        """
        if self.output is not None:
            result.save(self.output, self.overwrite)
            note(self.output)
        if self.plot is not None and empty:
            click.echo(f"no picture: there is nothing to draw in {self.plot}", err=True)
        elif self.plot is not None:
            result.plot(self.plot, overwrite=self.overwrite)
            note(self.plot)
        if self.movie is not None:
            result.movie(self.movie, self.overwrite)
            note(self.movie)
        if printed and self.output is None and self.plot is None:
            from puck_tables.io.csv import encode

            click.echo(encode(result.dataset()).decode(), nl=False)

    def report(
        self, result: Any, remark: str = "", summary: Callable[[Any], dict[str, Any]] | None = None
    ) -> None:  # fmt: skip
        """A report on stdout, in words or as JSON; if asked for, on stderr how it was got.

        ``remark``: a sentence on what was not chosen; ``summary``: the object of JSON, if the
        result has more to say than its own.
        """
        if self.explain:
            say(result.explain(), err=True)
        if self.as_json:
            summed_up = result.summary() if summary is None else summary(result)
            click.echo(json.dumps(summed_up, allow_nan=False))
        else:
            say(str(result))
            if remark:
                say(remark, err=True)


def outputs(
    save: str | None = f"Save: {RESULTS}.", *, plot: bool = True, movie: bool = False,
    explain: bool = False, as_json: bool = False, required: bool = False, file: str = "FILE",
) -> Option[Any]:  # fmt: skip
    """Where results go, as ``out``.

    ``save``: the help of -o, if there is one; ``required``: whether it must be given; ``file``: how
    its help calls it.
    """
    options: list[Option[Any]] = []
    if explain:
        options.append(click.option(
            "--explain", is_flag=True, help="Say which method was taken, and why (on stderr)."
        ))  # fmt: skip
    if as_json:
        options.append(json_option)
    if save is not None:
        options.append(click.option("-o", "--output", type=FILE, metavar=file, help=save,
                                    required=required))  # fmt: skip
    if movie:
        options.append(click.option(
            "--movie", type=FILE, metavar="FILE", help="Show the motion: .html (one file for any "
            "browser, with a time slider), .gif or .mp4.",
        ))  # fmt: skip
    words = "Replace output files that exist."
    if plot:
        options.append(
            click.option("--plot", type=FILE, metavar="FILE", help="Draw: .png, .svg or .pdf.")
        )
        words = "Replace output files that exist; pictures and movies always are."
    options.append(click.option("--overwrite", is_flag=True, help=words))
    return packed("out", Outputs, *options)


json_option = click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")
table_option = click.option(
    "--table", "table_path", type=FILE, metavar="FILE",
    help="Table file of 'puck build-tables'.  [default: the one that comes along]",
)  # fmt: skip


def _same(one: Path, other: Path) -> bool:
    """Whether two names lead to one file, that may not be there yet."""
    if os.path.exists(one) and os.path.exists(other):
        return os.path.samefile(one, other)
    return os.path.realpath(one) == os.path.realpath(other)


def tables_named(path: Path | None) -> list[Table]:
    """The table in a file, of any kind, or those that come along."""
    from puck_tables.table.table import Table

    return [Table.shipped(), Table.shipped("stops")] if path is None else [Table.load(path)]

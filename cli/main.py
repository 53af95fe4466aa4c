"""The command ``puck``: its commands, and how it ends when something is wrong.

Exit codes: 0 all well; 1 a file or an optional package is at fault; 2 bad input; 3 a table failed
its validation; 130 interrupted; 143 ended by SIGTERM; 141 nobody reads the results any more, as
after '| head'.
"""

from __future__ import annotations

import contextlib
import io
import os
import signal
import sys
from collections.abc import Iterator
from functools import partial
from itertools import chain
from typing import Any

import click
from puck_tables.cli import endings
from puck_tables.cli.aim import aim
from puck_tables.cli.asperity import asperity
from puck_tables.cli.fit import fit, track
from puck_tables.cli.printing import printable, progress
from puck_tables.cli.reference import compare, export, limit_surface, reference
from puck_tables.cli.simulate import explore, scene, simulate
from puck_tables.cli.sweep import sweep
from puck_tables.cli.tables import build_tables, info, tables, tradeoff, validate, warm_up

from puck_tables._core.waiting import watchers
from puck_tables._version import __version__
from puck_tables.errors import InputError, PuckError

BROKEN_PIPE = 141  # 128 + SIGPIPE, as shells count


SECTIONS = {  # of the help: by what one wants
    "One shot, a scene, a board": (simulate, scene, explore),
    "Very many, or a target": (sweep, aim),
    "Films of real pucks": (track, fit),
    "Engines and robots": (reference, compare, limit_surface, export),
    "Tables, and how exact": (build_tables, validate, info, tables, tradeoff),
    "Else": (warm_up, asperity),
}
MEANT = {  # what others call an option
    "--omega": "--w0", "--spin": "--w0", "--velocity": "--v0", "--mu": "--friction",
    "--tolerance": "--tol", "--slope": "--set floor.slope=5deg",
}  # fmt: skip


class PuckGroup(click.Group):
    """A group that ends every refusal with one sentence and an exit code."""

    def main(self, *args: Any, **named: Any) -> Any:
        """Run the program; help and usage, too, are written whole or not at all."""
        _whole_writes()
        with _written():
            try:
                return super().main(*args, **named)
            finally:
                if sys.stdout is not None:
                    sys.stdout.flush()

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the commands into the help by what one wants."""
        for heading, commands in SECTIONS.items():
            with formatter.section(heading):
                rows = [(one.name or "", one.get_short_help_str(limit=200)) for one in commands]
                formatter.write_dl(rows)

    def invoke(self, ctx: click.Context) -> Any:
        """Run a command."""
        at_start = [one for one in endings.ENDINGS if signal.getsignal(one) is endings.end_at_once]
        for one in at_start:
            signal.signal(one, endings.interrupt)
        try:
            with _written():  # before click makes its own of it
                result = super().invoke(ctx)
                if sys.stdout is not None:
                    sys.stdout.flush()
                return result
        except click.NoSuchOption as error:
            meant = MEANT.get(error.option_name)
            if meant is None:
                raise
            words = f"No such option '{error.option_name}'. Did you mean '{meant}'?"
            raise click.NoSuchOption(error.option_name, words, ctx=error.ctx) from None
        except PuckError as error:
            click.echo(f"Error: {printable(click.format_filename(str(error)))}", err=True)
            ctx.exit(2 if isinstance(error, InputError) else 1)
        except MemoryError:
            click.echo("Error: not enough memory: ask for fewer points", err=True)
            ctx.exit(1)
        except KeyboardInterrupt:
            click.echo(endings.last_words[-1](), err=True)
            ctx.exit(128 + endings.received)
        finally:
            for one in at_start:
                signal.signal(one, endings.end_at_once)


@contextlib.contextmanager
def _written() -> Iterator[None]:
    """End with a sentence where results cannot be written, in silence where nobody reads them."""
    try:
        yield
    except PuckError:  # says itself what is wrong
        raise
    except BrokenPipeError:
        _drop(sys.stdout)
        _drop(sys.stderr)
        raise SystemExit(BROKEN_PIPE) from None
    except OSError as error:
        _drop(sys.stdout)
        what = "write the results" if error.filename is None else f"use {error.filename}"
        click.echo(f"Error: {printable(f'cannot {what}: {error.strerror or error}')}", err=True)
        raise SystemExit(1) from None


def _whole_writes() -> None:
    """Buffer stdout even under PYTHONUNBUFFERED.

    Python drops there, in silence, what a full disk or a closed pipe did not take of one write.
    """
    raw = getattr(sys.stdout, "buffer", None)
    if isinstance(raw, io.RawIOBase):
        sys.stdout = io.TextIOWrapper(
            io.BufferedWriter(raw), sys.stdout.encoding, sys.stdout.errors,
            line_buffering=sys.stdout.isatty(),
        )  # fmt: skip


def _drop(stream: Any) -> None:
    """What is still buffered is not to be tried again, and complained about, at the exit."""
    with contextlib.suppress(AttributeError, OSError, ValueError):  # closed, or a test's
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


@click.group(cls=PuckGroup, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, package_name="puck-tables", prog_name="puck")
def main() -> None:
    """Motion of a flat puck that slides and spins under dry friction, until it stops."""
    watchers[:] = [partial(progress, begin=True)]
    del endings.last_words[1:]


for _command in chain.from_iterable(SECTIONS.values()):
    main.add_command(_command)

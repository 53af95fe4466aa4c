"""What commands say: texts, notes of files, how far work is."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import click

from puck_tables._core.waiting import Progress

SILENCE, BETWEEN_LINES = 2.0, 10.0  # s, where stderr is no terminal


def printable(text: str) -> str:
    r"""A text, perhaps from a file, without what a terminal would obey.

    >>> printable("red: " + chr(27) + "[31m")
    'red: \\x1b[31m'
    """
    return "".join(
        sign if sign.isprintable() or sign == "\n" else repr(sign)[1:-1] for sign in text
    )


def say(text: str, err: bool = False) -> None:
    """Print a text, perhaps from a file."""
    click.echo(printable(text), err=err)


def note(path: Path) -> None:
    """Say on stderr that a file was written."""
    click.echo(f"wrote {click.format_filename(path)}", err=True)


@contextmanager
def progress(label: str, begin: bool = False) -> Iterator[Progress]:
    """A progress bar on stderr; where that is no terminal a line now and then, if it takes long.

    ``begin``: whether a line is said before it begins, too: of work that nobody asked for by name.
    """
    if sys.stderr is None:
        yield lambda done, total: None
    elif sys.stderr.isatty():
        with click.progressbar(length=1000, label=label, file=sys.stderr, show_pos=False) as bar:
            yield lambda done, total: bar.update(1000 * done // total - bar.pos)
    else:
        due = time.monotonic() + SILENCE
        if begin:
            click.echo(label, err=True)

        def tell(done: int, total: int) -> None:
            nonlocal due
            if time.monotonic() >= due:
                click.echo(f"{label}: {100 * done // total} %", err=True)
                due = time.monotonic() + BETWEEN_LINES

        yield tell

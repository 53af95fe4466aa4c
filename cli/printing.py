"""What commands say: reports in lines and tables, notes of files, how far work is."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import click

Progress = Callable[[int, int], None]
QUIET_TIME, BETWEEN_LINES = 2.0, 10.0  # s, where stderr is no terminal


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


def say(text: str, err: bool = False) -> None:
    """Print a text, perhaps from a file."""
    click.echo(printable(text), err=err)


def note(path: Path) -> None:
    """Say on stderr that a file was written."""
    click.echo(f"wrote {click.format_filename(path)}", err=True)


def listed(entries: Mapping[str, str], width: int = 0) -> str:
    """Names and what is said of them, a line each.

    Examples
    --------
    >>> print(listed({"puck": "r = 1 m", "contact": "full"}))
    puck    r = 1 m
    contact full
    """
    width = max(width, *map(len, entries))
    return "\n".join(f"{name:<{width}} {text}" for name, text in entries.items())


def columns(heads: Mapping[str, str], rows: Iterable[Iterable[Any]], most: int = 60) -> str:
    """A table: headings with the formats of their columns; texts stand left, numbers right.

    ``most``: signs of a text.  None and nan are shown as a dash.

    Examples
    --------
    >>> print(columns({"file": "", "time s": ".3f"}, [("one.csv", 0.5), ("b", None)]))
    file     time s
    one.csv   0.500
    b             -
    """
    cells = [list(heads)]
    for row in rows:
        cells.append([
            "-" if one is None or one != one else
            format(one, form) if form else one if len(one) <= most else f"{one[: most - 3]}..."
            for one, form in zip(row, heads.values(), strict=True)
        ])  # fmt: skip
    widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
    sides = [">" if form else "<" for form in heads.values()]
    return "\n".join(
        "  ".join(f"{cell:{side}{width}}" for cell, side, width in
                  zip(line, sides, widths, strict=True)).rstrip()
        for line in cells
    )  # fmt: skip


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
        due = time.monotonic() + QUIET_TIME
        if begin:
            click.echo(label, err=True)

        def tell(done: int, total: int) -> None:
            nonlocal due
            if time.monotonic() >= due:
                click.echo(f"{label}: {100 * done // total} %", err=True)
                due = time.monotonic() + BETWEEN_LINES

        yield tell

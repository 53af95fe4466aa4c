"""``puck build-tables``: tabulate resultants or stops."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import click
from puck_tables.cli.completion import laws
from puck_tables.cli.options import FILE, Outputs, number, outputs
from puck_tables.cli.printing import note, progress, say

from puck_tables.errors import InputError


@click.command("build-tables")
@click.option("--kind", type=click.Choice(["resultants", "stops"]), default="resultants",
              show_default=True, help="Friction resultants in full contact, or stops and the way "
              "to them.")  # fmt: skip
@click.option("--pressure", metavar="LAW", shell_complete=laws,
              help="Resultants under uniform, galin, hertz, ring, annulus:INNER or a profile "
              "FILE.csv (columns rho in units of r, and W).  [default: uniform]")  # fmt: skip
@click.option("--speed-law", type=FILE, metavar="FILE", help="Resultants with a coefficient that "
              "depends on the slip speed (CSV of it in m/s, and f).")  # fmt: skip
@number("--accuracy", help="Largest error: of resultants 1e-13 to 0.01 [default: 2e-11], of those "
        "under other laws than uniform pressure 1e-11 to 0.01 [default: 1e-9], of stops 1e-11 to "
        "0.01 in units of Q/(f g) and Q^2/(f g) [default: 1e-10], with --speed-law 1e-13, under "
        "other pressures 1e-9, to 0.01 of the largest f [default: 1e-6].")  # fmt: skip
@click.option("--cells", type=int, help="Grid size by hand instead: cells on each side of each "
              "singular line, at least 4, for stops 8.")  # fmt: skip
@outputs("The table file.  [default: KIND.h5 or LAW.h5, here]", plot=False)
def build_tables(
    kind: str, pressure: str | None, speed_law: Path | None, accuracy: float | None,
    cells: int | None, out: Outputs,
) -> None:  # fmt: skip
    """Tabulate friction resultants or stops, and measure how exact the table is.

    The file is written where you stand, or to FILE, for --table, info and validate.  (What the
    program builds for its own use it keeps elsewhere: see 'puck tables'.)

    \b
    puck build-tables --accuracy 1e-8 -o coarse.h5
    puck build-tables --cells 512 -o fine.h5
    puck build-tables --kind stops --accuracy 1e-11 -o fine-stops.h5
    puck build-tables --pressure annulus:0.8 -o stone.h5
    puck build-tables --speed-law law.csv -o felt.h5
    puck build-tables --speed-law law.csv --pressure ring -o cup.h5
    """  # noqa: D301 - click reads the backspace
    if kind != "resultants" and (pressure is not None or speed_law is not None):
        word = "--pressure" if speed_law is None else "--speed-law"
        raise InputError(f"{word} goes with --kind resultants, not with --kind {kind}")
    if speed_law is not None and cells is not None:
        raise InputError("--cells does not go with --speed-law: give --accuracy")
    of, stem, words = _wanted(kind, pressure, speed_law)
    path = out.output or Path(f"{stem}.h5")
    if path.suffix.lower() != ".h5":
        raise InputError(f"{path}: a table is an HDF5 file: give a name that ends in .h5")
    replace(out, output=path).prepare(speed_law, pressure, saved=False)
    options = {"--accuracy": accuracy, "--cells": cells}
    given = [f"{name} {value}" for name, value in options.items() if value is not None]
    grid: dict[str, Any] = {} if cells is None else {"cells": cells}
    if speed_law is not None and pressure is not None:
        grid["pressure"] = pressure
    with progress("tabulating") as show:
        from puck_tables.table.table import Table

        table = Table.build(of, accuracy, progress=show, **grid)
        saved = table.save(path, out.overwrite, " ".join(["puck build-tables", *words, *given]))
    note(path)
    say(str(saved))


def _wanted(kind: str, pressure: str | None, speed_law: Path | None) -> tuple[Any, str, list[str]]:
    """What a table is wanted of, a name for its file, and the options that said so."""
    if speed_law is not None:
        from puck_tables.contact.speed_law import SpeedLaw

        words = [f"--speed-law {speed_law}"]
        words += [] if pressure is None else [f"--pressure {pressure}"]
        return SpeedLaw.from_csv(speed_law), "speed", words
    if kind != "resultants":
        return kind, kind, [f"--kind {kind}"]
    if pressure in (None, "uniform"):
        return "uniform", kind, []
    from puck_tables.contact.laws import law_of

    law = law_of(str(pressure))
    return law, _file_stem(law.name), [f"--pressure {pressure}"]


def _file_stem(name: str) -> str:
    """A file name for what has this name.

    >>> _file_stem("annulus:0.8"), _file_stem("my stone.csv")
    ('annulus-0.8', 'my-stone')
    """
    return re.sub(r"[^\w.+-]", "-", name.removesuffix(".csv"))

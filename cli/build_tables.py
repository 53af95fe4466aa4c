"""``puck build-tables``: tabulate resultants or stops."""

from __future__ import annotations

from pathlib import Path

import click
from puck_tables.cli.info import describe
from puck_tables.cli.options import FILE, NUMBER, prepare_outputs, printable, progress, told

from puck_tables.errors import InputError


@click.command("build-tables")
@click.option(
    "--kind",
    type=click.Choice(["resultants", "stops", "partial"]),
    default="resultants",
    show_default=True,
    help="Friction resultants, stops and the way to them, or resultants of partial contact.",
)
@click.option(
    "--pressure",
    metavar="LAW",
    help="Resultants under uniform, galin, hertz, ring, annulus:INNER or a profile FILE.csv "
    "(columns rho in units of r, and W).  [default: uniform]",
)
@click.option(
    "--accuracy",
    type=NUMBER,
    help="Largest error: of resultants 1e-13 to 0.01 [default: 2e-11; other laws 1e-9], of stops "
    "1e-11 to 0.01 in units of Q/J and Q^2/J [default: 1e-10], partial 1e-8 to 0.01 "
    "[default: 1e-6], with --speed-law 1e-13 to 0.01 of the largest f [default: 1e-6].",
)
@click.option("--n-phi", type=int, help="Resultants: number of phi nodes instead, odd, at least 9.")
@click.option(
    "--n-delta",
    type=int,
    help="Resultants: number of delta nodes, at least 4.  [default: 4, exact]",
)
@click.option(
    "--cells",
    type=int,
    help="Other than uniform resultants: cells on a side of a singular line instead.",
)
@click.option(
    "-o",
    "--output",
    type=FILE,
    metavar="FILE",
    help="The table file.  [default: KIND.h5 or LAW.h5, here]",
)
@click.option(
    "--speed-law",
    type=FILE,
    metavar="FILE",
    help="Resultants with a coefficient that depends on the slip speed: CSV of speed in m/s and f.",
)
@click.option("--overwrite", is_flag=True, help="Replace the file if it exists.")
def build_tables(
    kind: str, pressure: str | None, accuracy: float | None, n_phi: int | None,
    n_delta: int | None, cells: int | None, output: Path | None, speed_law: Path | None,
    overwrite: bool,
) -> None:  # fmt: skip
    """Tabulate friction resultants or stops, and measure how exact the table is.

    The file is written where you stand, or to FILE, for --table, info and validate.  (What the
    program builds for its own use it keeps elsewhere: see 'puck tables'.)

    \b
    puck build-tables --accuracy 1e-8 -o coarse.h5
    puck build-tables --n-phi 1025 -o fine.h5
    puck build-tables --kind stops --accuracy 1e-11 -o fine-stops.h5
    puck build-tables --pressure annulus:0.8 -o stone.h5
    puck build-tables --speed-law law.csv -o felt.h5
    """  # noqa: D301 - click reads the backspace
    plain = kind == "resultants" and pressure in (None, "uniform") and speed_law is None
    options = {
        "--accuracy": accuracy,
        "--n-phi": n_phi,
        "--n-delta": n_delta,
        "--cells": cells,
    }
    given = {name: value for name, value in options.items() if value is not None}
    what = f"--kind {kind}" if pressure is None else f"--pressure {pressure}"
    if speed_law is not None:
        if kind != "resultants" or pressure not in (None, "uniform") or cells is not None:
            raise InputError("--speed-law goes with --accuracy only")
        what = f"--speed-law {speed_law}"
    if pressure is not None and kind != "resultants":
        raise InputError(f"--pressure goes with --kind resultants, not with --kind {kind}")
    for name in ("--cells",) if plain else ("--n-phi", "--n-delta"):
        if name in given:
            raise InputError(f"{name} does not go with {what}")
    law, stem = None, kind if speed_law is None else "speed"
    if kind == "resultants" and not plain and speed_law is None:
        from puck_tables.contact.laws import law_of
        from puck_tables.store import file_stem

        law = law_of(pressure or "")
        stem = file_stem(law)
    path = Path(f"{stem}.h5") if output is None else output
    if path.suffix.lower() != ".h5":
        raise InputError(f"{path}: a table is an HDF5 file: give a name that ends in .h5")
    prepare_outputs(others=(path,), overwrite=overwrite, inputs=(speed_law, pressure))
    words = ["puck build-tables"] + ([] if plain else [what])
    command = " ".join(words + [f"{name} {value}" for name, value in given.items()])
    with progress("tabulating") as show:
        if law is not None:
            from puck_tables.table.law_file import save_law_table
            from puck_tables.table.law_table import build_law_table

            by_law = build_law_table(law, accuracy, cells, show)
            text = describe(save_law_table(by_law, path, overwrite, command))
        elif speed_law is not None:
            from puck_tables.contact.speed_law import SpeedLaw
            from puck_tables.table.speed_build import DEFAULT_ACCURACY, build_speed_table
            from puck_tables.table.speed_file import save_speed_table

            wanted = DEFAULT_ACCURACY if accuracy is None else accuracy
            points = SpeedLaw.from_csv(speed_law)
            speeds = build_speed_table(points, accuracy=wanted, progress=show)
            text = describe(save_speed_table(speeds, path, overwrite, command))
        elif kind == "stops":
            from puck_tables.similarity.build import build_stop_table
            from puck_tables.similarity.file import save_stop_table

            stops = build_stop_table(accuracy, cells, show)
            text = describe(save_stop_table(stops, path, overwrite, command))
        elif kind == "partial":
            from puck_tables.table.partial_build import build_partial_table
            from puck_tables.table.partial_file import save_partial_table

            partial = build_partial_table(accuracy, cells, show)
            text = describe(save_partial_table(partial, path, overwrite, command))
        else:
            from puck_tables.table.build import build_table
            from puck_tables.table.file import save_table

            table = build_table(accuracy, n_phi, n_delta, show)
            text = describe(save_table(table, path, overwrite, command))
    told(path)
    click.echo(printable(text))

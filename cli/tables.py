"""``puck tables``, ``info``, ``validate``, ``build-tables``, ``tradeoff``, ``warm-up``.

How good tables are, and what is computed or compiled ahead.
"""

from __future__ import annotations

import json
import re
from contextlib import suppress
from dataclasses import replace
from importlib.resources import files
from pathlib import Path
from typing import Any

import click
from puck_tables.cli.options import FILE, Outputs, PuckCommand, number, outputs, tables_named
from puck_tables.cli.printing import note, progress, say
from puck_tables.cli.values import laws

from puck_tables._core import own_folder
from puck_tables.errors import InputError, TableError
from puck_tables.report.lines_and_tables import columns

FAILED = 3  # exit status: 1 and 2 are those of errors and of wrong usage


@click.command(cls=PuckCommand)
@click.option("--quick", is_flag=True, help="Fewer repeats and points: under a minute.")
@click.option("-o", "--output", "files", type=FILE, metavar="FILE", multiple=True,
              help="Save everything: .h5, or .csv.  May be given twice.")  # fmt: skip
@outputs(None)
def tradeoff(quick: bool, files: tuple[Path, ...], out: Outputs) -> None:
    """Measure accuracy against speed of every method to answer.

    Resultants, stops, trajectories and states: by closed forms, tables, integrators, look-up, and
    by what others do; worst and median error, cost on one thread, memory.  Some minutes.

    \b
    puck tradeoff --quick
    puck tradeoff -o tradeoff.h5 -o tradeoff.csv --plot tradeoff.png
    """  # noqa: D301 - click reads the backspace
    for path in files:
        Outputs(path, overwrite=out.overwrite).prepare()
    out.prepare(others=files)
    from puck_tables.tradeoff.measurement import measure

    with progress("measuring") as show:
        measured = measure(quick, show)
    for path in files:
        Outputs(path, overwrite=out.overwrite).deliver(measured)
    out.deliver(measured)
    click.echo(measured)


@click.command(cls=PuckCommand)
@click.argument("file", type=FILE, required=False)
def validate(file: Path | None) -> None:
    """Judge a table by independent routes.

    Resultants: direct quadrature and closed forms; those under other pressure laws and friction
    laws: quadrature.  Stops: the integrator, the equations they satisfy
    with friction by quadrature, elementary solutions.

    Without FILE: the tables that come along.  Ends with code 3 if anything is out of a table's own
    tolerance.
    """
    passed = True
    for table in tables_named(file):
        with progress("validating") as show:
            report = table.validate(show)
        say(str(report))
        passed = passed and report.passed
    if not passed:
        click.echo("Error: the table is out of its own tolerance", err=True)
        raise SystemExit(FAILED)


@click.command(cls=PuckCommand)
@click.argument("file", type=FILE, required=False)
def info(file: Path | None) -> None:
    """Say what a table holds, how good it is, and whether its digest is right.

    Without FILE: the tables that come along.
    """
    say("\n\n".join(map(str, tables_named(file))))


@click.command("build-tables", cls=PuckCommand)
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
    chosen = [f"{name} {value}" for name, value in options.items() if value is not None]
    grid: dict[str, Any] = {} if cells is None else {"cells": cells}
    if speed_law is not None and pressure is not None:
        grid["pressure"] = pressure
    with progress("tabulating") as show:
        from puck_tables.table.table import Table

        table = Table.build(of, accuracy, progress=show, **grid)
        saved = table.save(path, out.overwrite, " ".join(["puck build-tables", *words, *chosen]))
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


@click.command(cls=PuckCommand)
@click.option("--json", "as_json", is_flag=True, help="Print one JSON list.")
@click.option("--remove", "names", metavar="NAME", multiple=True, help="Remove a kept table.")
@click.option("--clean", is_flag=True, help="Remove all kept tables.")
def tables(as_json: bool, names: tuple[str, ...], clean: bool) -> None:
    """List the tables that come along, and those the program has built and kept.

    Kept tables lie in the user's cache folder; what is removed there is built again when it is
    needed.  Tables of 'puck build-tables' are yours and lie where you put them: see 'puck info'.

    \b
    puck tables
    puck tables --remove NAME
    puck tables --clean
    """  # noqa: D301 - click reads the backspace
    if clean + bool(names) + as_json > 1:
        raise InputError("--json, --remove and --clean clash: give one of them")
    kept = {path.name: path for path in kept_files()}
    if names or clean:
        _remove(kept, list(dict.fromkeys(names or kept)), clean)
        return
    along = sorted(Path(str(one)) for one in files("puck_tables.tables").iterdir())
    places = {path: "comes along" for path in along if path.suffix == ".h5"}
    places |= {path: str(path.parent) for path in kept.values()}
    entries = [entry for path, place in places.items() for entry in _entries(path, place)]
    if as_json:
        click.echo(json.dumps(entries))
    else:
        say(_lines(entries))


def kept_files() -> list[Path]:
    """The kept files that are tables by their names, in alphabetical order."""
    from puck_tables.table.table_store import ENDING, tables_folder

    folder = tables_folder()
    try:
        if folder is None or not folder.is_dir():
            return []
        own_folder.refuse_shared(folder)
    except OSError as error:
        own_folder.say(f"{folder} is not used: {error.strerror or error}")
        return []
    named = (one for one in folder.iterdir() if re.fullmatch(r"[\w.+-]+" + ENDING, one.name))
    return sorted(one for one in named if one.is_file() and not one.is_symlink())


def _remove(kept: dict[str, Path], names: list[str], clean: bool) -> None:
    """Remove kept tables of these names, all or none; ``clean``: what killed builders left, too."""
    from puck_tables._core.partial_files import remove_dead

    for name in names:
        if name not in kept:
            raise InputError(f"no table {name} is kept: 'puck tables' lists those that are")
    for name in names:
        kept[name].unlink(missing_ok=True)
        click.echo(f"removed {click.format_filename(kept[name])}")
    if not names:
        click.echo("nothing is kept: nothing to remove")
    elif clean:
        remove_dead(kept[names[0]].parent)


def _entries(path: Path, place: str) -> list[dict[str, Any]]:
    """What a table file holds in short, None if it is damaged; none where it was just removed."""
    from puck_tables.table.table import Table

    table = None
    with suppress(TableError):
        table = Table.load(path)
    with suppress(FileNotFoundError):
        return [{
            "name": path.name, "place": place, "kind": table and table.kind,
            "pressure_law": table and table.pressure_law, "bytes": path.stat().st_size,
            "valid_range": table and table.valid_range, "accuracy": table and table.tolerance,
            "date": table and table.metadata["created"], "whole": table is not None,
        }]  # fmt: skip
    return []


def _lines(entries: list[dict[str, Any]]) -> str:
    heads = {
        "name": "", "holds": "", "pressure": "", "accuracy": "g", "kB": ".0f", "made": "",
        "state": "", "range": "",
    }  # fmt: skip
    rows = [
        (one["name"], one["kind"] or "-", one["pressure_law"] or "-", one["accuracy"],
         one["bytes"] / 1000, (one["date"] or "-")[:10], "whole" if one["whole"] else "damaged",
         one["valid_range"] or "-")
        for one in entries
    ]  # fmt: skip
    places = dict.fromkeys(one["place"] for one in entries if one["place"] != "comes along")
    kept = [f"kept in {click.format_filename(place)}" for place in places]
    return "\n".join([columns(heads, rows), *kept])


@click.command(cls=PuckCommand)
def warm_up() -> None:
    """Compile what games and services call, once for this machine.

    It takes some minutes, or a second where it was done before; stderr says how far it is.  Without
    it nothing is missing: what takes long is compiled when it is first asked.

    \b
    puck warm-up
    """  # noqa: D301 - click reads the backspace
    from puck_tables.warming import warm_up

    warm_up()

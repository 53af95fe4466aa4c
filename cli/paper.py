"""``puck paper``: the paper behind the model, reproduced."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import click
from puck_tables.cli.options import FILE, prepare_outputs, progress, told

from puck_tables.errors import OutputError

DIFFERS = 3


@click.command()
@click.option(
    "--out",
    "folder",
    type=FILE,
    required=True,
    metavar="DIR",
    help="Folder for the pictures and claims.csv; made if missing.",
)
@click.option("--overwrite", is_flag=True, help="Replace output files that exist.")
def paper(folder: Path, overwrite: bool) -> None:
    """Draw the figures of the paper behind the model and check its claims.

    Salnikova, Treschev, Gallyamov 2012.  Writes figure_02.png to figure_11.png and claims.csv, and
    prints each claim beside what is computed here: "off X <= Y" is the deviation and how large it
    may be, "X to spare" the room left to an inequality.  Known errata of the paper are marked; ends
    with code 3 if any other claim differs.

    \b
    puck paper --out paper
    """  # noqa: D301 - click reads the backspace
    from puck_tables.plot.style import require_matplotlib, save_figure

    require_matplotlib()
    from puck_tables._core.safe_write import write_bytes
    from puck_tables.paper.claim import as_csv, as_text
    from puck_tables.paper.claims import all_claims
    from puck_tables.paper.figures import FIGURES
    from puck_tables.plot.panels import draw

    table = folder / "claims.csv"
    pictures = {folder / f"figure_{number:02}.png": figure for number, figure in FIGURES.items()}
    with _made(folder):
        prepare_outputs(others=(table, *pictures), overwrite=overwrite)
        with progress("claims") as show:
            claims = all_claims(show)
        write_bytes(table, as_csv(claims).encode(), overwrite)
        told(table)
        with progress("figures") as show:
            for done, (path, figure) in enumerate(pictures.items(), start=1):
                save_figure(draw(figure()), path, overwrite)
                told(path)
                show(done, len(pictures))
    click.echo(as_text(claims))
    if any(claim.verdict == "DIFFERS" for group in claims.values() for claim in group):
        click.echo("Error: a claim differs that is not a known erratum of the paper", err=True)
        raise SystemExit(DIFFERS)


@contextmanager
def _made(folder: Path) -> Iterator[None]:
    """The folder and those above it, gone again if the work ends before a file is in them."""
    try:
        new = [path for path in (folder, *folder.parents) if not path.exists()]
        folder.mkdir(parents=True, exist_ok=True)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise OutputError(f"cannot make the folder {folder}: {reason}") from None
    try:
        yield
    finally:
        with suppress(OSError):  # not empty, as it should be
            for path in new:
                path.rmdir()

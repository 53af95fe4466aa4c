"""``puck track``: what files of tracks hold, and how it is understood."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click
from puck_tables.cli.options import FILE, output_options, prepare_outputs, printable, told
from puck_tables.cli.track_options import read_all, track_options


@click.command()
@click.argument("files", type=FILE, nargs=-1, required=True, metavar="FILE...")
@track_options
@click.option(
    "-o",
    "--output",
    type=FILE,
    metavar="FILE",
    help="Save all tracks in m, s and rad: .csv, .h5, .json, .jsonl (puck fit reads these) or "
    ".parquet (for other programs).",
)
@output_options
def track(
    files: tuple[Path, ...], how: dict[str, Any], output: Path | None, plot: Path | None,
    overwrite: bool,
) -> None:  # fmt: skip
    """Say what was read of filmed pucks: frames, times, places, angles, and what looks odd.

    Files may be tables of times or frame numbers and places (CSV and other text, with any header),
    files and exports of Tracker (.trk, .trz), and tables of trackpy, DeepLabCut and SLEAP (of the
    latter two HDF5, too).  What a file does not say is asked for.

    \b
    puck track run.csv --unit cm --plot run.png
    puck track film.trk -o run.csv
    puck track points.csv --fps 120 --scale 0.5mm
    puck track pose.h5 --fps 120 --marks floor.csv --centre red,blue --toward red
    puck track bare.txt --columns "t [ms],x [mm],y [mm],-"
    """  # noqa: D301 - click reads the backspace
    prepare_outputs(output, plot=plot, overwrite=overwrite, inputs=[*files, how["marks"]])
    from puck_tables.film.pairs import marks_of_one
    from puck_tables.film.report import dataset, described

    tracks = read_all(files, how)
    if output is not None:
        from puck_tables.io.formats import save

        save(dataset(tracks), output, overwrite)
        told(output)
    if plot is not None:
        from puck_tables.plot.style import save_figure
        from puck_tables.plot.track_figure import draw

        save_figure(draw(tracks), plot, overwrite)
        told(plot)
    for one in tracks:
        click.echo(printable("\n".join(described(one))))
    if said := marks_of_one(tracks):
        click.echo(printable(f"{said}."))

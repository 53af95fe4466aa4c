"""``puck track``: what files of tracks hold, and how it is understood."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click
from puck_tables.cli.options import FILE, Outputs, outputs
from puck_tables.cli.printing import note, say
from puck_tables.cli.track_options import read_all, track_options


@click.command()
@click.argument("files", type=FILE, nargs=-1, required=True, metavar="FILE...")
@track_options
@outputs("Save all tracks in m, s and rad: .csv, .h5, .json, .jsonl (puck fit reads these) or "
         ".parquet (for other programs).")  # fmt: skip
def track(files: tuple[Path, ...], how: dict[str, Any], out: Outputs) -> None:
    """Say what was read of filmed pucks: frames, times, places, angles, and what looks odd.

    Files may be tables of times or frame numbers and places (CSV and other text, with any header,
    spreadsheets), files and exports of Tracker (.trk, .trz), tables of trackpy, DeepLabCut and
    SLEAP (of the latter two HDF5, too), exports of Qualisys, Vicon, OptiTrack, C3D, ROS, and of
    phones' gyroscopes.  What a file does not say is asked for.

    \b
    puck track run.csv --unit cm --plot run.png
    puck track film.trk -o run.csv
    puck track points.csv --fps 120 --scale 0.5mm
    puck track pose.h5 --fps 120 --marks floor.csv --centre red,blue --toward red
    puck track bare.txt --columns "t [ms],x [mm],y [mm],-"
    """  # noqa: D301 - click reads the backspace
    out.prepare(*files, how["marks"])
    from puck_tables.film.pairs import marks_of_one
    from puck_tables.film.report import dataset, described

    tracks = read_all(files, how)
    if out.output is not None:
        from puck_tables.io.formats import save

        save(dataset(tracks), out.output, out.overwrite)
        note(out.output)
    if out.plot is not None:
        from puck_tables.plot.style import save_figure
        from puck_tables.plot.track_figure import draw

        save_figure(draw(tracks), out.plot, out.overwrite)
        note(out.plot)
    for one in tracks:
        say("\n".join(described(one)))
    if remark := marks_of_one(tracks):
        say(f"{remark}.")

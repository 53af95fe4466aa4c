"""``puck track``: what files of tracks hold, and how it is understood."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from puck_tables.cli.options import FILE, Outputs, number, outputs, packed
from puck_tables.cli.printing import note, say

if TYPE_CHECKING:
    from puck_tables.film.puck_track import Track

track_options = packed(
    "how", dict,
    number("--fps", help="Frames a second, for frame numbers."),
    click.option("--unit", metavar="UNIT",
                 help="Unit of the places, where the file does not say: m, cm, px."),
    click.option("--scale", metavar="SIZE", help="Size of a pixel, a number and a unit: 0.5mm; "
                 "or a scale bar: 240px=30cm."),
    click.option("--angle-unit", metavar="UNIT", help="Unit of angles: deg, rad or turn."),
    click.option("--y-down/--y-up", default=None,
                 help="Which way y grows in the file.  [default: down for pixels, else up]"),
    click.option("--columns", metavar="NAMES", help="Headings for all columns, in place of the "
                 "file's, - for those to leave out: 'frame,red_x [px],red_y [px],-'."),
    click.option("--marks", type=FILE, metavar="FILE", help="Four marks or more on the floor, for "
                 "a tilted camera: a CSV file of u,v,x [m],y [m], their pixels and places."),
    click.option("--centre", metavar="MARKS",
                 help="The marks on a puck, with commas, in whose middle its centre lies; of "
                 "several pucks what their names have in common."),
    click.option("--toward", metavar="MARK", help="The mark on a puck that its angle points to."),
    number("--likelihood",
           help="Places less likely are not seen.  [default: 0.6; not used of SLEAP]"),
    click.option("--up", type=click.Choice(["x", "y", "z"]), help="The axis that points up, of "
                 "places in space.  [default: as the file says, else z]"),
    click.option("--pucks", metavar="NAMES", help="Read these only, with commas."),
)  # fmt: skip


def read_all(files: Iterable[Path], how: Mapping[str, Any]) -> list[Track]:
    """The tracks in files, in their order."""
    from puck_tables.film.track_files import read_tracks

    return [track for file in files for track in read_tracks(file, **how)]


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
    from puck_tables.film.puck_track import marks_of_one
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

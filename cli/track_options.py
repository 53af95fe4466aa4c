"""How files of tracks are to be read: options that commands share, and the reading itself."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from puck_tables.cli.options import FILE, NUMBER, packed

if TYPE_CHECKING:
    from puck_tables.film.puck_track import Track

track_options = packed(
    "how", dict,
    click.option("--fps", type=NUMBER, help="Frames a second, for frame numbers."),
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
    click.option("--likelihood", type=NUMBER,
                 help="Places less likely are not seen.  [default: 0.6; not used of SLEAP]"),
    click.option("--up", type=click.Choice(["x", "y", "z"]), help="The axis that points up, of "
                 "places in space.  [default: as the file says, else z]"),
    click.option("--pucks", metavar="NAMES", help="Read these only, with commas."),
)  # fmt: skip


def read_all(files: Iterable[Path], how: Mapping[str, Any]) -> list[Track]:
    """The tracks in files, in their order."""
    from puck_tables.film.track_files import read_tracks

    return [track for file in files for track in read_tracks(file, **how)]

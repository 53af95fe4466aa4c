"""``puck track``, ``fit``: what files of tracks hold, and friction and tilt of a puck from them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from puck_tables.cli.options import (
    FILE,
    RESULTS,
    Outputs,
    PuckCommand,
    body_options,
    number,
    outputs,
    packed,
    puck_number,
)
from puck_tables.cli.printing import note, progress, say
from puck_tables.cli.values import named, names, not_none, number_or_text, parted, read_as

from puck_tables.errors import InputError

if TYPE_CHECKING:
    from puck_tables.film.film import Track

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
_ANY_RADIUS = 0.04  # m: of a slide without spin it does not matter


def read_all(files: Iterable[Path], how: Mapping[str, Any]) -> list[Track]:
    """The tracks in files, in their order."""
    from puck_tables.film.track_files import read_tracks

    return [track for file in files for track in read_tracks(file, **how)]


@click.command(cls=PuckCommand)
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
    from puck_tables.film.film import marks_of_one
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


def _held(texts: tuple[str, ...], option: str) -> dict[str, Any]:
    """NAME=VALUE, several times."""
    return {name: number_or_text(text) for name, text in named(texts, option).items()}


def _pairs(texts: tuple[str, ...], option: str) -> dict[str, list[Any]]:
    """NAME=NUMBER:NUMBER, several times."""
    pairs = named(texts, option).items()
    return {name: parted(text, ":", f"{option} {name}") for name, text in pairs}


def _noise(text: str, option: str) -> list[Any]:
    """PLACE in m, or with ANGLE in rad."""
    numbers = [number_or_text(part) for part in text.split(",")]
    return [*numbers, None] if len(numbers) == 1 else [*numbers]


def _numbers(text: str, option: str) -> list[Any]:
    return parted(text, ",", option)


def _walls(texts: tuple[str, ...], option: str) -> list[Any]:
    """Lines by two points of each."""
    return [[_numbers(end, option) for end in text.split(":")] for text in texts]


def _held_out(text: str, option: str) -> float | list[str]:
    share = number_or_text(text)
    return share if isinstance(share, float) else names(text, option)


@click.command(cls=PuckCommand)
@click.argument("files", type=FILE, nargs=-1, required=True, metavar="TRACK...")
@track_options
@packed(
    "known", dict,
    puck_number("radius", "  Of slides along a line without angles it does not matter."),
    puck_number("height", ", if known: the tilt then follows from f."),
    puck_number("friction", ", if known."),
    puck_number("mass"),
    puck_number("gravity"),
    *body_options(),
)  # fmt: skip
@packed(
    "wanted", dict,
    click.option("--free", metavar="NAMES", callback=read_as(names),
                 help="What is found, with commas: friction, delta, height, decel, gyration, inner "
                 "(of an annulus), drag, air, spin_drag, slope_x, slope_y, belt_x, belt_y, mark_x, "
                 "mark_y (of what is tracked, off the centre), radius, gravity; of impacts "
                 "tangential, mass_ratio.  "
                 "[default: friction and delta, friction alone if --height is given]"),
    click.option("--fix", "fixed", multiple=True, metavar="NAME=VALUE", callback=read_as(_held),
                 help="Hold a number; also launch_spin and the like."),
    click.option("--prior", multiple=True, metavar="NAME=VALUE:SIGMA",
                 callback=read_as(_pairs), help="What is known of a number besides: its value "
                 "and its standard deviation (to hold a number, --fix)."),
    click.option("--bound", "bounds", multiple=True, metavar="NAME=LOW:HIGH",
                 callback=read_as(_pairs), help="Look for a number within; also for launch_x, "
                 "_y, _vx, _vy, _spin, _angle."),
    click.option("--start", multiple=True, metavar="NAME=VALUE", callback=read_as(_held),
                 help="Begin there, too; also with launch_spin."),
    click.option("--noise", metavar="PLACE[,ANGLE]", callback=read_as(_noise),
                 help="Standard deviation of places in m and angles in rad.  [default: that of "
                 "the residuals]"),
    number("--since", "s", help="Start of the free motion, in s of the track: no frame after it is "
           "left out at the start."),
    number("--until", "s", help="End of the free motion, in s of the track: no frame before it is "
           "left out at the end."),
    click.option("--keep-all", is_flag=True, help="All frames are of free motion: none is left "
                 "out where something seems to touch the puck."),
    click.option("--impacts", is_flag=True, help="The tracks may hold impacts, with walls or of "
                 "two pucks: find restitution and friction of the rims, which join the slides."),
    click.option("--wall", "walls", multiple=True, metavar="X,Y:X,Y", callback=read_as(_walls),
                 help="A straight wall, by two points on it in m: impacts are then looked for, as "
                 "with --impacts, and other walls are found."),
    click.option("--jitter", metavar="SECONDS|find",
                 callback=read_as(lambda text, option: number_or_text(text)),
                 help="Standard deviation of the time stamps of frames, or find it."),
    click.option("--rows", metavar="FIRST,LAST", callback=read_as(_numbers),
                 help="Of a rolling shutter: y in m of the first and the last line of the "
                 "picture. Its readout time is found, T/2 +- T/2 of the time T between frames "
                 "unless --prior or --bound say more."),
    click.option("--slip-speeds", metavar="U,...", callback=read_as(_numbers),
                 help="Find the friction coefficient at these slip speeds in m/s, from 0 to the "
                 "fastest: two for f0 + f1 u, up to 8."),
    click.option("--between", type=click.Choice(["cubic", "linear"]), default="cubic",
                 show_default=True, help="How friction goes between --slip-speeds; cubic, as the "
                 "law of a scene, rises and falls only where f at them does."),
    click.option("--law", type=click.Choice(["stribeck", "hyperbola", "two-valued"]),
                 help="Find friction over slip speed by a law with three numbers: friction (of "
                 "fast slip), friction_rest, law_speed."),
    click.option("--laws", metavar="LAW,...", callback=read_as(names),
                 help="Compare pressure laws, with +drag, +air, +slope, +belt, +stribeck, "
                 "+hyperbola or +two-valued also floors: uniform,hertz,annulus:0.8,uniform+drag; "
                 "floors: all of these, and which the film supports."),
    click.option("--hold-out", metavar="SHARE|NAMES", callback=read_as(_held_out),
                 help="Predict this last share of each track, or the later half of the tracks "
                 "named, from the rest."),
)  # fmt: skip
@click.option("--report", "worksheet", type=FILE, metavar="PAGE",
              help="Write one page for a class (.html): pictures, numbers, residuals, what was "
              "assumed, and blanks.")  # fmt: skip
@outputs(f"Save: {RESULTS}; .json is what simulate --fit takes, the others have frames and "
         "residuals.", explain=True, as_json=True)  # fmt: skip
def fit(
    files: tuple[Path, ...], how: dict[str, Any], known: dict[str, Any], wanted: dict[str, Any],
    worksheet: Path | None, out: Outputs,
) -> None:  # fmt: skip
    """Find friction, tilt and launches of a sliding puck from tracks of it.

    A track is what a film tells of one puck: times, places and, better, angles of a mark on it.
    What the tracks cannot tell is said, with what would tell it.

    \b
    puck fit run.csv --radius 0.0381
    puck fit run.csv --fps 120 --unit px --scale 0.5mm --radius 0.0381 --height 0.0254
    puck fit one.csv two.csv --radius 0.0381 --laws uniform,hertz,ring --plot fit.png
    puck fit slide.csv --unit cm --report page.html
    puck fit block.csv --base box:20cmx10cm --height 4cm
    puck fit run.csv --radius 0.0381 --prior friction=0.2:0.05 --hold-out 0.3 -o fit.json
    puck simulate --fit fit.json
    """  # noqa: D301 - click reads the backspace
    if worksheet is not None:
        from puck_tables.plot.html_page import checked_page

        checked_page(worksheet)
    out.prepare(*files, how["marks"], known["pressure"], others=[worksheet])
    from puck_tables.fitting.fit_tracks import fit as find
    from puck_tables.puck import Puck

    tracks = read_all(files, how)
    if known["radius"] is None and known["base"] is None:
        if not all(one.angle is None and one.along_line for one in tracks):
            raise InputError(
                "give the radius of the puck (--radius 38mm), or its base (--base box:20cmx10cm)"
            )
        known["radius"] = _ANY_RADIUS
        if wanted["free"] is None and known["height"] is None:
            wanted["free"] = [] if known["friction"] is not None else ["friction"]
    puck = Puck(**not_none(known))
    free, fixed = wanted["free"], wanted["fixed"]
    for name in ("friction", "height"):
        if (value := known[name]) is not None:
            if free is not None and name in free:
                raise InputError(
                    f"--{name} {value:g} says that {name} is known, --free {name} that it is not: "
                    f"leave out one; --start {name}={value:g} begins there"
                )
            if name in fixed:
                raise InputError(f"--{name} and --fix {name} say the same: leave out one of them")
            if not (name == "height" and free is not None and "delta" in free):
                fixed[name] = value
    with progress("fitting") as show:
        result = find(tracks, puck, progress=show, **not_none(wanted))
    out.deliver(result)
    if worksheet is not None:
        result.report(worksheet, out.overwrite)
        note(worksheet)
    out.report(result)

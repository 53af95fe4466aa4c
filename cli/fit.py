"""``puck fit``: friction and tilt of a puck from tracks of it."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import click
from puck_tables.cli.fit_report import report
from puck_tables.cli.options import (
    FILE,
    LENGTH,
    NUMBER,
    TIME,
    body_options,
    deliver,
    explain_option,
    json_option,
    note,
    output_options,
    prepare_outputs,
    progress,
    reported,
)
from puck_tables.cli.track_options import read_all, track_options
from puck_tables.cli.values import NumberParam

from puck_tables.errors import InputError


@click.command()
@click.argument("files", type=FILE, nargs=-1, required=True, metavar="TRACK...")
@track_options
@click.option("--radius", type=LENGTH, required=True, help="Radius r of the puck in m.")
@click.option(
    "--height", type=LENGTH, help="Height h in m, if known: the tilt then follows from f."
)
@click.option("--friction", type=NUMBER, help="Coulomb coefficient f, if known.")
@click.option(
    "--mass", type=NumberParam("kg"), help="Mass in kg (for energies of what is simulated later)."
)
@click.option("--gravity", type=NumberParam("m/s^2"), help="Gravity in m/s^2.  [default: 9.80665]")
@body_options()
@click.option(
    "--free",
    metavar="NAMES",
    help="What is found, with commas: friction, delta, height, decel, gyration, inner (of an "
    "annulus), drag, radius, gravity; of impacts tangential, mass_ratio.  [default: friction and "
    "delta, friction alone if --height is given]",
)
@click.option(
    "--fix",
    multiple=True,
    metavar="NAME=VALUE",
    help="Hold a number; also launch_spin and the like.",
)
@click.option(
    "--prior", multiple=True, metavar="NAME=VALUE:SIGMA", help="What is known of a number besides."
)
@click.option(
    "--bound",
    multiple=True,
    metavar="NAME=LOW:HIGH",
    help="Look for a number within; also for launch_x, _y, _vx, _vy, _spin, _angle.",
)
@click.option(
    "--start", multiple=True, metavar="NAME=VALUE", help="Begin there, too; also with launch_spin."
)
@click.option(
    "--noise",
    metavar="PLACE[,ANGLE]",
    help="Standard deviation of places in m and angles in rad.  [default: that of the residuals]",
)
@click.option(
    "--since",
    type=TIME,
    help="Start of the free motion, in s of the track: no frame after it is left out at the start.",
)
@click.option(
    "--until",
    type=TIME,
    help="End of the free motion, in s of the track: no frame before it is left out at the end.",
)
@click.option(
    "--keep-all",
    is_flag=True,
    help="All frames are of free motion: none is left out where something seems to touch the puck.",
)
@click.option(
    "--impacts",
    is_flag=True,
    help="The tracks may hold impacts, with walls or of two pucks: find restitution and friction "
    "of the rims, which join the slides.",
)
@click.option(
    "--wall",
    multiple=True,
    metavar="X,Y:X,Y",
    help="A straight wall, by two points on it in m: impacts are then looked for, as with "
    "--impacts, and other walls are found.",
)
@click.option(
    "--jitter",
    metavar="SECONDS|find",
    help="Standard deviation of the time stamps of frames, or find it.",
)
@click.option(
    "--rows",
    metavar="FIRST,LAST",
    help="Of a rolling shutter: y in m of the first and the last line of the picture. Its readout "
    "time is found, T/2 +- T/2 of the time T between frames unless --prior or --bound say more.",
)
@click.option(
    "--slip-speeds",
    metavar="U,...",
    help="Find the friction coefficient at these slip speeds in m/s, from 0 to the fastest: two "
    "for f0 + f1 u, up to 8.",
)
@click.option(
    "--between",
    type=click.Choice(["cubic", "linear"]),
    default="cubic",
    show_default=True,
    help="How friction goes between --slip-speeds; cubic, as the law of a scene, rises and falls "
    "only where f at them does.",
)
@click.option(
    "--laws",
    metavar="LAW,...",
    help="Compare pressure laws; with +drag also a coefficient that changes with the slip speed: "
    "uniform,hertz,annulus:0.8,uniform+drag.",
)
@click.option(
    "--hold-out",
    metavar="SHARE|NAMES",
    help="Predict this last share of each track, or the later half of the tracks named, from the "
    "rest.",
)
@explain_option
@json_option
@click.option(
    "-o",
    "--output",
    type=FILE,
    metavar="FILE",
    help="Save: .json (for simulate --fit), .h5, .csv, .jsonl or .parquet (frames and residuals).",
)
@output_options
def fit(
    files: tuple[Path, ...], how: dict[str, Any], radius: float, height: float | None,
    friction: float | None, mass: float | None, gravity: float | None, pressure: str,
    gyration: float | None, free: str | None, fix: tuple[str, ...], prior: tuple[str, ...],
    bound: tuple[str, ...], start: tuple[str, ...], noise: str | None, since: float | None,
    until: float | None, keep_all: bool, impacts: bool, wall: tuple[str, ...], jitter: str | None,
    rows: str | None, slip_speeds: str | None, between: str, laws: str | None,
    hold_out: str | None, explain: bool, as_json: bool,
    output: Path | None, plot: Path | None, overwrite: bool,
) -> None:  # fmt: skip
    """Find friction, tilt and launches of a sliding puck from tracks of it.

    A track is what a film tells of one puck: times, places and, better, angles of a mark on it.
    What the tracks cannot tell is said, with what would tell it.

    \b
    puck fit run.csv --radius 0.0381
    puck fit run.csv --fps 120 --unit px --scale 0.5mm --radius 0.0381 --height 0.0254
    puck fit one.csv two.csv --radius 0.0381 --laws uniform,hertz,ring --plot fit.png
    puck fit run.csv --radius 0.0381 --prior friction=0.2:0.05 --hold-out 0.3 -o fit.json
    puck simulate --fit fit.json
    """  # noqa: D301 - click reads the backspace
    from puck_tables.io.formats import FORMATS, ending_of

    is_json = output is not None and ending_of(output, FORMATS) == ".json"
    prepare_outputs(
        *(() if is_json else (output,)), others=(output,) if is_json else (), plot=plot,
        overwrite=overwrite, inputs=[*files, how["marks"], pressure],
    )  # fmt: skip
    from puck_tables.fitting.fit_tracks import fit as find
    from puck_tables.puck import Puck

    texts = {
        "height": height, "friction": friction, "gravity": gravity, "gyration": gyration,
        "mass": mass,
    }  # fmt: skip
    puck = Puck(
        radius=radius, pressure=pressure, **{n: v for n, v in texts.items() if v is not None}
    )
    fixed = {n: _number(v, "--fix", n) for n, v in _named(fix, "--fix").items()}
    wanted = None if free is None else _names(free, "--free", "friction,delta")
    for name, value in (("friction", friction), ("height", height)):
        if value is not None:
            if wanted is not None and name in wanted:
                raise InputError(
                    f"--{name} {value:g} says that {name} is known, --free {name} that it is not: "
                    f"leave out one; --start {name}={value:g} begins there"
                )
            if name in fixed:
                raise InputError(f"--{name} and --fix {name} say the same: leave out one of them")
            if not (name == "height" and wanted is not None and "delta" in wanted):
                fixed[name] = value
    tracks = read_all(files, how)
    with progress("fitting") as show:
        result = find(
            tracks, puck, free=wanted, fixed=fixed,
            prior=_pairs(prior, "--prior", "VALUE:SIGMA"),
            bounds=_pairs(bound, "--bound", "LOW:HIGH"),
            start={n: _number(v, "--start", n) for n, v in _named(start, "--start").items()},
            noise=_noise(noise), since=-math.inf if since is None else since,
            until=math.inf if until is None else until, keep_all=keep_all,
            jitter=_jitter(jitter), rows=None if rows is None else _point(rows, "--rows"),
            impacts=impacts, walls=[_wall(one) for one in wall],
            slip_speeds=None if slip_speeds is None
            else [_number(one, "--slip-speeds", "u") for one in slip_speeds.split(",")],
            between=between,
            laws=() if laws is None else _names(laws, "--laws", "uniform,hertz"),
            hold_out=_held(hold_out), progress=show,
        )  # fmt: skip
    if is_json and output is not None:
        result.save(output, overwrite)
        note(output)
    deliver(result, None if is_json else output, plot, overwrite)
    reported(result, explain, as_json, report)


def _names(text: str, option: str, like: str) -> list[str]:
    """Names with commas.

    Raises
    ------
    InputError
    """
    names = [name.strip() for name in text.split(",")]
    if not all(names):
        raise InputError(f"{option} '{text}' must be names with commas, like {like}")
    return names


def _named(texts: tuple[str, ...], option: str) -> dict[str, str]:
    """NAME=VALUE, several times.

    Raises
    ------
    InputError
    """
    result: dict[str, str] = {}
    for text in texts:
        name, equals, value = text.partition("=")
        if not equals or not name.strip() or not value.strip():
            raise InputError(f"{option} '{text}' must be NAME=VALUE, like friction=0.2")
        if name.strip() in result:
            raise InputError(f"{option} names {name.strip()} twice: give it once")
        result[name.strip()] = value.strip()
    return result


_UNITS = {
    "place": "m", "radius": "m", "height": "m", "launch_x": "m", "launch_y": "m", "angle": "rad",
    "launch_angle": "rad", "launch_vx": "m/s", "launch_vy": "m/s", "launch_spin": "rad/s",
    "u": "m/s", "gravity": "m/s^2", "decel": "m/s^2",
}  # fmt: skip


def _number(text: str, option: str, name: str) -> float:
    from puck_tables._core.units import measured

    try:
        number = measured(text, _UNITS.get(name, ""))
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise InputError(f"{option} {name}={text}: '{text}' is not a finite number")
    return number


def _pairs(texts: tuple[str, ...], option: str, form: str) -> dict[str, tuple[float, float]]:
    """NAME=NUMBER:NUMBER, several times.

    Raises
    ------
    InputError
    """
    from puck_tables._core.units import UNIT_EACH, without_unit

    result = {}
    for name, text in _named(texts, option).items():
        parts = text.split(":")
        if len(parts) != 2:
            raise InputError(f"{option} {name}={text} must be {name}={form}, like {name}=0.2:0.05")
        if bare := without_unit(parts, _UNITS.get(name, "")):
            raise InputError(f"{option} {name}={text}: {UNIT_EACH.format(bare)}")
        result[name] = _number(parts[0], option, name), _number(parts[1], option, name)
    return result


def _noise(text: str | None) -> tuple[float, float | None] | None:
    if text is None:
        return None
    parts = text.split(",")
    if len(parts) > 2:
        raise InputError(f"--noise {text} must be PLACE or PLACE,ANGLE, like 0.0003,0.005")
    numbers = [
        _number(part, "--noise", name)
        for part, name in zip(parts, ("place", "angle"), strict=False)
    ]
    return numbers[0], numbers[1] if len(numbers) == 2 else None


def _jitter(text: str | None) -> float | str | None:
    from puck_tables._core.units import measured

    try:
        return text if text is None else measured(text, "s")
    except ValueError:
        return text


def _point(text: str, option: str) -> tuple[float, float]:
    """Two numbers.

    Raises
    ------
    InputError
    """
    parts = text.split(",")
    if len(parts) != 2:
        raise InputError(f"{option}: '{text}' must be two numbers in m with a comma, like 0.1,0.5")
    return _number(parts[0], option, "place"), _number(parts[1], option, "place")


def _wall(text: str) -> tuple[tuple[float, float], tuple[float, float]]:
    """A line by two points.

    Raises
    ------
    InputError
    """
    ends = text.split(":")
    if len(ends) != 2:
        raise InputError(f"--wall '{text}' must be two points on it in m, like 1.5,0:1.5,2")
    return _point(ends[0], "--wall"), _point(ends[1], "--wall")


def _held(text: str | None) -> float | tuple[str, ...] | None:
    if text is None:
        return None
    try:
        return float(text)
    except ValueError:
        return tuple(_names(text, "--hold-out", "one.csv,two.csv"))

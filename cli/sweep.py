"""``puck sweep``: maps of stops, and samples."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from puck_tables.cli.options import (
    FILE,
    NUMBER,
    body_options,
    chosen_puck,
    explain_option,
    output_options,
    progress,
    puck_options,
    table_option,
    tables_named,
)
from puck_tables.cli.scene_run import files_read, scene_options, scene_tables, summary_of_map
from puck_tables.cli.sweep_options import Whole, chosen_laws, chosen_spreads, samples_checked
from puck_tables.cli.values import MAX_COUNT, RangeParam, Vector

from puck_tables.accuracy.methods import METHODS
from puck_tables.errors import InputError

if TYPE_CHECKING:
    from puck_tables.puck import Puck
    from puck_tables.stopping.stop_table import StopTable
    from puck_tables.table.resultant_table import ResultantTable

ARGUMENTS = {  # of the library by the names of options
    "w0": "spin", "speed": "speed", "heading": "heading", "vx": "vx", "vy": "vy",
    "radius": "radius", "height": "height", "friction": "friction", "gravity": "gravity",
    "delta": "delta", "decel": "decel", "gyration": "gyration",
}  # fmt: skip
REAL = ("height", "friction", "gravity")


@click.command()
@click.option("--w0", type=RangeParam("rad/s"), help="Launch spin in rad/s.")
@click.option(
    "--speed", type=RangeParam("m/s"), help="Launch speed in m/s, along x without --heading."
)
@click.option("--heading", type=RangeParam("rad"), help="Direction of the launch from x, in rad.")
@click.option("--v0", type=Vector("m/s"), help="One launch velocity in m/s instead of --speed.")
@click.option("--delta", type=RangeParam(), help="delta = 2 f h / r.  [default: 0.5]")
@puck_options(mass=False, kind=RangeParam)
@body_options(kind=RangeParam, many=True)
@click.option(
    "--random", type=click.IntRange(2, MAX_COUNT), metavar="COUNT",
    help="Samples instead of ranges: so many launches whose numbers scatter.",
)  # fmt: skip
@click.option("--seed", type=click.IntRange(0, 2**64 - 1), help="Of the samples.  [default: 0]")
@click.option(
    "--spread", "spreads", multiple=True, metavar="NAME=SPREAD",
    help="How a number scatters: w0=normal:5:0.2, speed=uniform:0.9:1.1; in scenes "
    "launch.spin=...; numbers may have units, w0=normal:50rpm:2rpm; as often as needed.",
)  # fmt: skip
@click.option(
    "--inside", "regions", multiple=True, metavar="X,Y,R|X1,Y1,X2,Y2",
    help="Say with which chance samples end inside a disc or a rectangle, in m.",
)  # fmt: skip
@click.option(
    "--tol",
    type=NUMBER,
    default=1e-8,
    show_default=True,
    help="Largest error, in units of Q/J (times) and Q^2/J (places): the cheapest method whose "
    "measured error is below it is taken.",
)
@click.option(
    "--method",
    type=click.Choice([method.value for method in METHODS]),
    help="Only this one.  [default: the cheapest]",
)
@explain_option
@click.option("--threads", type=click.IntRange(1, 1024), help="[default: all cores]")
@click.option(
    "--cluster", metavar="local:N|tcp://HOST:PORT|tls://HOST:PORT",
    help="Let N processes, or a Dask cluster that runs, do it; with -o NAME.zarr.",
)  # fmt: skip
@table_option
@click.option(
    "-o",
    "--output",
    type=FILE,
    metavar="FILE",
    help="Save the map: .h5, .csv, .json, .jsonl, .parquet; or .zarr, which may be larger than "
    "memory and goes on after any end.  Without -o and --plot, CSV goes to stdout; of samples, a "
    "summary does in any case.",
)
@output_options
@scene_options
@click.pass_context
def sweep(
    ctx: click.Context, /, v0: tuple[float, float] | None, pressure: tuple[str, ...],
    random: int | None, seed: int | None, spreads: tuple[str, ...], regions: tuple[str, ...],
    tol: float, method: str | None, explain: bool, threads: int | None, cluster: str | None,
    table_path: Path | None, output: Path | None, plot: Path | None, overwrite: bool,
    scene: str | None, changes: tuple[str, ...], **numbers: Any,
) -> None:  # fmt: skip
    """Map where and when pucks stop, or how a scene ends.

    Ranges are START:STOP:COUNT, ends included, or lists: --w0 0,10,20.  What is left out is fixed at --speed 1 --w0 0
    --delta 0.5 --radius 1 --decel 1; without --w0, --speed and --v0 the map is that of speeds from
    0 to 2 m/s by spins from -4 to 4 rad/s.  The status of a stop is 0, or 2 where the motion is too
    large for floating point.

    \b
    puck sweep --plot map.png
    puck sweep --v0 1,0 --w0 0:10:101 -o stops.csv
    puck sweep --speed 0:2:201 --w0 -20:20:401 --delta 0:1:5 -o map.h5
    puck sweep --w0 0:10:101 --pressure uniform --pressure hertz --pressure annulus:0.1:0.9:5 -o laws.h5
    puck sweep --speed 0:2:9000 --w0 -4:4:9000 -o map.zarr --cluster local:4
    puck sweep --random 1000000 --spread w0=normal:5:0.2 --spread speed=uniform:0.9:1.1 --plot where.png
    puck sweep --scene incline --set launch.spin=0:80:81 --set floor.slope=0:0.14:71 --plot map.png

    Each delta above 1, or with another --pressure or --gyration, takes about a second to prepare.
    """  # noqa: D301, E501 - click reads the backspace
    from puck_tables.io.columns import COLUMNS
    from puck_tables.stopping.population import COLUMN

    is_scene = scene is not None or bool(changes)
    inside = samples_checked(random, seed, spreads, regions, "launch.spin" if is_scene else "w0")
    whole = Whole(threads, cluster, output, plot, overwrite, explain, inside)
    if is_scene:
        scattering = [one.partition("=")[0].strip() for one in spreads]
        tables = scene_tables(ctx, scene, changes, scattering=scattering)
        whole.refuse_outputs(files_read(scene, tables))
        from puck_tables.world.scene import Scene

        with progress("runs") as show:
            one = Scene.from_tables(tables)
            if random is None:
                ends: Any = one.sweep(progress=show, **whole.how)
            else:
                drawn = chosen_spreads(spreads, None, one.unit_of)
                ends = one.sample(random, seed or 0, drawn, progress=show, **whole.how)
        whole.deliver(ends, summary_of_map(ends))
        return
    drawn = chosen_spreads(spreads, ARGUMENTS, lambda name: COLUMNS[COLUMN[name]].unit)
    if v0 is not None and numbers["speed"] is not None:
        raise InputError("--v0 and --speed clash: both give the launch velocity")
    for name, option in ARGUMENTS.items():
        if option in drawn and numbers.get(name) is not None:
            raise InputError(f"--{name} and --spread {name}=... clash: both give it")
    whole.refuse_outputs((table_path, *pressure))
    chosen = {
        ARGUMENTS[name]: value for name, value in numbers.items() if value is not None
    } | drawn
    ranged = {name: value for name, value in chosen.items() if isinstance(value, tuple | list)}
    laws = chosen_laws(pressure)
    if random is not None and (ranged or len(laws) > 1):
        first = next(iter(ranged), "pressure")
        raise InputError(
            f"--random draws samples: {first} cannot range, give one number or a --spread"
        )
    if (
        plot is not None
        and random is None
        and chosen.keys() & {"spin", "speed"} | ({"spin"} if v0 is not None else set())
        and not ranged
        and len(laws) == 1
    ):
        raise InputError(
            "--plot needs a range: give --w0, --speed, --delta or another number as "
            "START:STOP:COUNT or a list"
        )
    sizes = [one[2] if isinstance(one, tuple) else len(one) for one in ranged.values()]
    whole.refuse_memory([*sizes, len(laws)], random)
    puck = _puck(chosen, laws)
    launch = {name: _values(value) for name, value in chosen.items() if name not in _OF_PUCK}
    launch |= {name: _values(value) for name, value in chosen.items()
               if name in _OF_PUCK and not isinstance(value, float)}  # fmt: skip
    if "radius" in launch and not chosen.keys() & set(REAL):  # similar pucks stay similar
        launch |= {name: launch.get(name, getattr(puck, name)) for name in ("delta", "decel")}
    launch |= {} if v0 is None else {"velocity": v0}
    launch |= {} if len(laws) == 1 else {"pressure": laws}
    table = None if table_path is None else _table_of_stops(table_path)
    how: dict[str, Any] = {"tol": tol, "method": method, "table": table, **whole.how}
    with progress("stops") as show:
        if random is None:
            stops: Any = puck.sweep(**launch, progress=show, **how)
        else:
            stops = puck.sample(random, seed or 0, **launch, progress=show, **how)
    whole.deliver(stops, _summary(stops))


_OF_PUCK = ("radius", "height", "friction", "gravity", "delta", "decel", "gyration")


def _puck(chosen: dict[str, Any], laws: list[str]) -> Puck:
    """The puck, with the lowest number of each range, and the middle of each spread."""
    alone: dict[str, Any] = {name: _first(chosen.get(name)) for name in _OF_PUCK}
    return chosen_puck(**alone, pressure=laws[0])


def _first(value: Any) -> float | None:
    if isinstance(value, tuple | list):
        return float(value[0])
    if value is None or isinstance(value, float):
        return value
    middle: float = value.mean if hasattr(value, "mean") else 0.5 * (value.low + value.high)
    return middle


def _table_of_stops(path: Path) -> ResultantTable | StopTable:
    """A table that stops can come from."""
    from puck_tables.stopping.stop_table import StopTable
    from puck_tables.table.resultant_table import ResultantTable

    table = tables_named(path)[0]
    if not isinstance(table, ResultantTable | StopTable):
        raise InputError(f"{path} holds '{table.kind}': stops come from 'stops' or 'resultants'")
    return table


def _values(chosen: Any) -> Any:
    import numpy as np

    return np.linspace(*chosen) if isinstance(chosen, tuple) else chosen


def _summary(stops: Any) -> str:
    from puck_tables.bulk.finish import Stored
    from puck_tables.bulk.work import Tally
    from puck_tables.stopping.solvers import STATUS_MEANINGS

    stored = isinstance(stops, Stored)
    tally = stops.tally if stored else Tally.of(stops.status)
    one = stops.work.launches if stored else stops
    work = stops.work if stored else stops
    shape = stops.work.shape if stored else stops.status.shape
    ranged = " x ".join(f"{name} ({n})" for name, n in zip(one.dims, shape, strict=True))
    fixed = ", ".join(f"{name} = {value:g}" for name, value in one.fixed.items())
    counts = ", ".join(
        f"{tally.counts.get(code, 0)} {meaning.replace('_', ' ')}"
        for code, meaning in enumerate(STATUS_MEANINGS)
        if code == 0 or code in tally.counts
    )
    source = work.source if stored else work.table
    return f"{ranged or 'one launch'} at {fixed}: {counts}; {work.method}, {source}"

"""``puck sweep``: maps of stops, and samples."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click
from puck_tables.cli.options import (
    Outputs,
    PuckChoice,
    number,
    outputs,
    packed,
    puck_options,
    table_option,
    tables_named,
)
from puck_tables.cli.printing import progress
from puck_tables.cli.scene_run import SceneChoice, scene_options, scene_tables
from puck_tables.cli.sweep_options import Whole, chosen_laws, chosen_spreads, samples_checked
from puck_tables.cli.values import MAX_COUNT, RangeParam, Vector, not_none

from puck_tables.accuracy.methods import METHODS
from puck_tables.errors import InputError

_OF_PUCK = ("radius", "height", "friction", "gravity", "delta", "decel", "gyration")
# of the library by the names of options
ARGUMENTS = {"w0": "spin", **{name: name for name in ("speed", "heading", "vx", "vy", *_OF_PUCK)}}


@click.command()
@number("--w0", "rad/s", RangeParam, help="Launch spin in rad/s.")
@number("--speed", "m/s", RangeParam, help="Launch speed in m/s, along x without --heading.")
@number("--heading", "rad", RangeParam, help="Direction of the launch from x, in rad.")
@number("--v0", "m/s", Vector, help="One launch velocity in m/s instead of --speed.")
@packed("numbers", dict, *puck_options(kind=RangeParam, many=True))
@packed(
    "sample", dict,
    click.option("--random", type=click.IntRange(2, MAX_COUNT), metavar="COUNT",
                 help="Samples instead of ranges: so many launches whose numbers scatter."),
    click.option("--seed", type=click.IntRange(0, 2**64 - 1), help="Of the samples.  [default: 0]"),
    click.option("--spread", "spreads", multiple=True, metavar="NAME=SPREAD",
                 help="How a number scatters: w0=normal:5:0.2, speed=uniform:0.9:1.1; in scenes "
                 "launch.spin=...; numbers may have units, w0=normal:50rpm:2rpm; as often as "
                 "needed."),
    click.option("--inside", "regions", multiple=True, metavar="X,Y,R|X1,Y1,X2,Y2",
                 help="Say with which chance samples end inside a disc or a rectangle, in m."),
)  # fmt: skip
@number("--tol", default=1e-8, show_default=True, help="Largest error, in units of Q/(f g) (times) "
        "and Q^2/(f g) (places): the cheapest method whose measured error is below it is "
        "taken.")  # fmt: skip
@click.option("--method", type=click.Choice([method.value for method in METHODS]),
              help="Only this one.  [default: the cheapest]")  # fmt: skip
@click.option("--threads", type=click.IntRange(1, 1024), help="[default: all cores]")
@click.option("--cluster", metavar="local:N|tcp://HOST:PORT|tls://HOST:PORT", help="Let N "
              "processes, or a Dask cluster that runs, do it; with -o NAME.zarr.")  # fmt: skip
@table_option
@outputs("Save the map: .h5, .csv, .json, .jsonl, .parquet; or .zarr, which may be larger than "
         "memory and goes on after any end.  Without -o and --plot, CSV goes to stdout; of "
         "samples, a summary does in any case.", explain=True)  # fmt: skip
@scene_options
@click.pass_context
def sweep(
    ctx: click.Context, /, w0: Any, speed: Any, heading: Any, v0: tuple[float, float] | None,
    numbers: dict[str, Any], sample: dict[str, Any], tol: float, method: str | None,
    threads: int | None, cluster: str | None, table_path: Path | None, out: Outputs,
    chosen: SceneChoice,
) -> None:  # fmt: skip
    """Map where and when pucks stop, or how a scene ends.

    Ranges are START:STOP:COUNT, ends included, or lists: --w0 0,10,20.  What is left out is fixed at --speed 1 --w0 0
    --delta 0.5 --radius 1 --decel 1; without --w0, --speed and --v0 the map is that of speeds from
    0 to 2 m/s by spins from -4 to 4 rad/s.  The status of a stop is 0, or 2 where the motion is too
    large for floating point.  With --base the launch heads along the x axis of the body, or by
    --heading from there; spins are then from -2 m/s over k to 2 m/s over k.

    \b
    puck sweep --plot map.png
    puck sweep --v0 1,0 --w0 0:10:101 -o stops.csv
    puck sweep --speed 0:2:201 --w0 -20:20:401 --delta 0:1:5 -o map.h5
    puck sweep --w0 0:10:101 --pressure uniform --pressure hertz --pressure annulus:0.1:0.9:5 -o laws.h5
    puck sweep --speed 0:2:9000 --w0 -4:4:9000 -o map.zarr --cluster local:4
    puck sweep --random 1000000 --spread w0=normal:5:0.2 --spread speed=uniform:0.9:1.1 --plot where.png
    puck sweep --base box:20cmx10cm --friction 0.3 --speed 0:2:41 --w0 -30:30:61 --plot box.png
    puck sweep --scene incline --set launch.spin=0:80:81 --set floor.slope=0:0.14:71 --plot map.png

    Each delta above 1, or with another --pressure or --gyration, takes about a second to prepare.
    """  # noqa: D301, E501 - click reads the backspace
    from puck_tables.io.columns import COLUMNS
    from puck_tables.stopping.population import COLUMN

    inside = samples_checked(**sample, name_of_spin="launch.spin" if chosen else "w0")
    random, seed, spreads = sample["random"], sample["seed"] or 0, sample["spreads"]
    whole = Whole(threads, cluster, out, inside)
    if chosen:
        scattering = [one.partition("=")[0].strip() for one in spreads]
        tables = scene_tables(ctx, chosen, scattering=scattering)
        whole.refuse_outputs(*chosen.reads(tables))
        from puck_tables.world.scene import Scene

        with progress("runs") as show:
            one = Scene.from_tables(tables)
            if random is None:
                ends: Any = one.sweep(progress=show, **whole.how)
            else:
                drawn = chosen_spreads(spreads, None, one.unit_of)
                ends = one.sample(random, seed, drawn, progress=show, **whole.how)
        whole.deliver(ends)
        return
    pressure, base = numbers.pop("pressure"), numbers.pop("base")
    drawn = chosen_spreads(spreads, ARGUMENTS, lambda name: COLUMNS[COLUMN[name]].unit)
    if v0 is not None and speed is not None:
        raise InputError("--v0 and --speed clash: both give the launch velocity")
    numbers = not_none({"w0": w0, "speed": speed, "heading": heading, **numbers})
    for name in numbers:
        if ARGUMENTS[name] in drawn:
            raise InputError(f"--{name} and --spread {name}=... clash: both give it")
    whole.refuse_outputs(table_path, base, *pressure)
    values = {ARGUMENTS[name]: value for name, value in numbers.items()} | drawn
    ranged = {name: value for name, value in values.items() if isinstance(value, tuple | list)}
    laws = chosen_laws(pressure)
    if random is not None and (ranged or len(laws) > 1):
        first = next(iter(ranged), "pressure")
        raise InputError(
            f"--random draws samples: {first} cannot range, give one number or a --spread"
        )
    is_one = not ranged and len(laws) == 1 and (v0 or values.keys() & {"spin", "speed"})
    if out.plot is not None and random is None and is_one:
        raise InputError(
            "--plot needs a range: give --w0, --speed, --delta or another number as "
            "START:STOP:COUNT or a list"
        )
    sizes = [one[2] if isinstance(one, tuple) else len(one) for one in ranged.values()]
    whole.refuse_memory([*sizes, len(laws)], random)
    numbers = {name: _first(values[name]) for name in _OF_PUCK if name in values}
    puck = PuckChoice(laws[0], base=base, **numbers).puck()
    launch = {
        name: _all(value) for name, value in values.items()
        if name not in _OF_PUCK or not isinstance(value, float)
    }  # fmt: skip
    if "radius" in launch and not values.keys() & {"height", "friction", "gravity"}:
        # similar pucks stay similar
        launch |= {name: launch.get(name, getattr(puck, name)) for name in ("delta", "decel")}
    launch |= not_none({"velocity": v0, "pressure": laws if len(laws) > 1 else None})
    how: dict[str, Any] = {"tol": tol, "method": method, "table": _table(table_path), **whole.how}
    with progress("stops") as show:
        if random is None:
            stops: Any = puck.sweep(**launch, progress=show, **how)
        else:
            stops = puck.sample(random, seed, **launch, progress=show, **how)
    whole.deliver(stops)


def _first(value: Any) -> float:
    """The lowest number of a range, the middle of a spread."""
    if isinstance(value, float):
        return value
    if isinstance(value, tuple | list):
        return float(value[0])
    middle: float = value.mean if hasattr(value, "mean") else 0.5 * (value.low + value.high)
    return middle


def _all(value: Any) -> Any:
    import numpy as np

    return np.linspace(*value) if isinstance(value, tuple) else value


def _table(path: Path | None) -> Any:
    """A table that stops can come from."""
    if path is None:
        return None
    from puck_tables.stopping.stop_table import StopTable
    from puck_tables.table.resultant_table import ResultantTable

    table = tables_named(path)[0]
    if not isinstance(table, ResultantTable | StopTable):
        raise InputError(f"{path} holds '{table.kind}': stops come from 'stops' or 'resultants'")
    return table

"""``puck sweep``: maps of stops, and samples; spreads, pressure laws, and where a sweep goes."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from puck_tables.cli.endings import last_words
from puck_tables.cli.options import (
    Outputs,
    PuckChoice,
    PuckCommand,
    number,
    outputs,
    packed,
    puck_options,
    table_option,
    tables_named,
)
from puck_tables.cli.printing import note, progress, say
from puck_tables.cli.scene_run import SceneChoice, scene_options, scene_tables
from puck_tables.cli.values import MAX_COUNT, RangeParam, Vector, named, not_none, parted

from puck_tables.accuracy.methods import METHODS
from puck_tables.errors import InputError, OutputError

if TYPE_CHECKING:
    from puck_tables.bulk.spreads import Spread

SUMMED = 1_000_000  # samples (of each puck) of a store that are summed up unasked: some 200 MB
_RINGS = re.compile(r"annulus:([^:]*):([^:]*):([0-9]{1,10})")
_OF_PUCK = ("radius", "height", "friction", "gravity", "delta", "decel", "gyration")
# of the library by the names of options
ARGUMENTS = {"w0": "spin", **{name: name for name in ("speed", "heading", "vx", "vy", *_OF_PUCK)}}


def chosen_spreads(
    spreads: Iterable[str], names: Mapping[str, str] | None, unit_of: Callable[[str], str]
) -> dict[str, Spread]:
    """Spreads by what scatters.

    ``names``: the arguments by the names that are allowed; None: any, as they are; ``unit_of``:
    the unit of each.
    """
    from puck_tables.bulk.spreads import spread_named

    chosen: dict[str, Spread] = {}
    for name, text in named(spreads, "--spread", "NAME=SPREAD, like w0=normal:5:0.2").items():
        if names is not None and name not in names:
            raise InputError(f"--spread {name} does not scatter: give {', '.join(names)}")
        argument = name if names is None else names[name]
        chosen[argument] = spread_named(text, unit_of(argument))
    return chosen


def samples_checked(
    random: int | None, seed: int | None, spreads: tuple[str, ...], regions: tuple[str, ...],
    name_of_spin: str,
) -> list[list[Any]]:  # fmt: skip
    """The regions asked for; options of samples that stand alone are refused."""
    from puck_tables.bulk.summary import checked_regions

    if random is None:
        alone = {"--seed": seed is not None, "--spread": spreads, "--inside": regions}
        for name, is_set in alone.items():
            if is_set:
                raise InputError(f"{name} is for samples: give --random COUNT too")
        return []
    if not spreads:
        raise InputError(
            f"--random needs a --spread: say what scatters, like {name_of_spin}=normal:5:0.2"
        )
    numbers = [parted(one, ",", "--inside") for one in regions]
    checked_regions(numbers)
    return numbers


def chosen_laws(pressure: tuple[str, ...]) -> list[str]:
    """Pressure laws, annulus:START:STOP:COUNT as so many of them."""
    import numpy as np

    from puck_tables.stopping.population import MOST_LAWS

    laws: list[str] = []
    for one in pressure or ("uniform",):
        rings = _RINGS.fullmatch(one)
        count = 1 if rings is None else int(rings[3])
        if len(laws) + count > MOST_LAWS:
            raise InputError(
                f"--pressure {one}: more than {MOST_LAWS} pressure laws, each is a kind of puck of "
                "its own that takes about a second to prepare: give fewer"
            )
        if rings is None:
            laws.append(one)
            continue
        try:
            inner = np.linspace(float(rings[1]), float(rings[2]), count).tolist()
        except ValueError:
            raise InputError(
                f"--pressure {one}: write annulus:INNER, or annulus:START:STOP:COUNT"
            ) from None
        laws += [f"annulus:{number!r}" for number in inner]
    if len(set(laws)) < len(laws):
        raise InputError("--pressure names the same law twice")
    return laws


@dataclass(frozen=True)
class Whole:
    """Where a sweep is done, and where it goes."""

    threads: int | None
    cluster: str | None
    out: Outputs
    regions: list[list[Any]]  # the chances of ending inside which are asked for

    @property
    def store(self) -> Path | None:
        """The Zarr store it goes to, if it does."""
        from puck_tables.io.formats import STORE

        path = self.out.output
        return path if path is not None and path.suffix.lower() == STORE else None

    @property
    def files(self) -> Outputs:
        """The outputs that are no store."""
        return self.out if self.store is None else replace(self.out, output=None)

    @property
    def how(self) -> dict[str, Any]:
        """Keyword arguments of a sweep of the library."""
        return {
            "threads": self.threads, "cluster": self.cluster, "overwrite": self.out.overwrite,
            "store": self.store,
        }  # fmt: skip

    def refuse_outputs(self, *inputs: Path | str | None) -> None:
        """Refuse, before any work, what could not be written."""
        from puck_tables.io.formats import FORMATS, STORE, ending_of

        if self.out.output is not None:
            ending_of(self.out.output, (*FORMATS, STORE))
        self.files.prepare(*inputs)
        if self.cluster is not None:
            if self.store is None:
                raise InputError("--cluster writes to a Zarr store: give -o NAME.zarr too")
            from puck_tables.bulk.cluster import checked_address

            checked_address(self.cluster)
        if self.store is not None:
            import puck_tables.bulk.store  # noqa: F401 - says what is not installed

            folder = self.store.absolute().parent
            if not folder.is_dir():
                raise OutputError(f"cannot write {self.store}: the folder {folder} does not exist")
            last_words.append(self._kept)

    def _kept(self) -> str:
        """What is said when the sweep is ended."""
        from puck_tables.bulk.store_folder import sibling_of

        if self.store is not None and self.store.exists():
            if sibling_of(Path(os.path.realpath(self.store))).exists():
                return (
                    f"Interrupted: {self.store} is as it was; what is done of the new one is kept "
                    "beside it: the same command goes on."
                )
            return f"Interrupted: {self.store} keeps what is done; the same command goes on."
        return last_words[0]()

    def refuse_memory(self, sizes: list[int], samples: int | None) -> None:
        """Refuse a map that would not fit in memory, as its format needs it."""
        from puck_tables._core.memory import check_memory
        from puck_tables.stopping.stop_sweep import BYTES_PER_LAUNCH, BYTES_PER_ROW

        shape = tuple(n for n in sizes if n > 1) if samples is None else (samples,)
        if self.store is not None:
            if self.out.plot is not None or self.regions:
                advice = "--plot and --inside read a whole store, leave them out"
                check_memory(shape, BYTES_PER_LAUNCH, advice)
            return
        path, plot = self.out.output, self.out.plot
        as_text = plot is None if path is None else path.suffix.lower() != ".h5"
        check_memory(shape, BYTES_PER_ROW if as_text else BYTES_PER_LAUNCH)

    def deliver(self, result: Any) -> None:
        """Save, draw and sum up."""
        from puck_tables.bulk.finish import Stored
        from puck_tables.bulk.summary import Summary

        if self.store is not None:
            note(self.store)
            last_words[:] = last_words[:1]
        kept = isinstance(result, Stored)
        many = kept and result.work.size * max(1, len(getattr(result.work, "names", ()))) > SUMMED
        summed = kept and result.is_sample and (bool(self.regions) or not many)
        drawn = result.load() if summed or (kept and self.out.plot is not None) else result
        if isinstance(drawn, Summary):
            drawn = drawn.within(*self.regions)
        self.files.deliver(drawn, printed=not kept and not isinstance(result, Summary))
        say(str(result), err=True)
        if isinstance(drawn, Summary):
            click.echo(drawn.summary())
        elif kept and result.is_sample:
            click.echo(
                f"More than {SUMMED:,} samples are summed up only with --plot or --inside, in "
                "memory (some 200 bytes each); or open the store with xarray.",
                err=True,
            )
        if self.out.explain:
            say(result.explain(), err=True)


@click.command(cls=PuckCommand)
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

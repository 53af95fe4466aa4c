"""``puck aim``: launches that come to rest at a given place."""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import nullcontext
from pathlib import Path
from typing import Any

import click
from puck_tables.cli.options import (
    FILE,
    Outputs,
    PuckChoice,
    PuckCommand,
    number,
    outputs,
    packed,
    puck_options,
)
from puck_tables.cli.printing import progress
from puck_tables.cli.scene_run import SceneChoice, scene_options, scene_tables
from puck_tables.cli.values import Vector, named, not_none, number_or_text

from puck_tables.errors import InputError
from puck_tables.kernels.patience import one_question

_LARGEST_FILE = 1 << 30  # bytes: more is no file of targets, and would fill the memory
_ON_BOARDS = ("pocket", "puck", "striker", "hits", "max_impacts", "odds", "within")
_SCATTERS = {"heading": "rad", "speed": "1", "w0": "rad/s"}  # for --odds


@click.command(cls=PuckCommand)
@click.option("--target", "targets", type=Vector("m"), multiple=True, help="Where to stop, in m "
              "from the launch, like 2,0.1; in a scene, on the board.")  # fmt: skip
@click.option("--targets", "targets_file", type=FILE, metavar="FILE",
              help="Many at once: a CSV file of x,y in m, one target a line.")  # fmt: skip
@packed(
    "wishes", dict,
    click.option("--pocket", multiple=True, metavar="NUMBER", help="In a scene: which."),
    click.option("--puck", metavar="NAME", help="In a scene: which is to end there."),
    click.option("--striker", metavar="NAME", help="In a scene: which is sent off."),
    click.option("--hits", metavar="NAME", help="In a scene: a puck to be hit on the way."),
    click.option("--max-impacts", type=int, help="In a scene: at most so many.  [default: 3]"),
    click.option("--odds", multiple=True, metavar="NAME=DEVIATION", help="In a scene: how likely "
                 "the first launch does it where heading, speed (a share of it) or w0 scatter by "
                 "so much, like heading=0.5deg, and which aim does it most often."),
    number("--within", "m", help="For --odds of a target: how near the puck is to end, in m."),
    number("--w0", "rad/s", help="The launch with this spin, in rad/s, with its sign."),
    number("--speed", "m/s", help="The launches with this speed, in m/s."),
    number("--time", "s", help="The launches that stop after this time, in s."),
    number("--angle", "rad", help="The launches after which the body rests at this angle up to "
           "whole turns, in rad or like 90deg; it begins at 0."),
    number("--max-speed", "m/s", help="No launch faster than this, in m/s."),
    number("--max-spin", "rad/s", help="No launch with more spin than this, in rad/s."),
    click.option("--count", type=int, help="Slip angles of a sample, or numbers of turns, for each "
                 "sense of spin [default: 8]; in a scene launches that are given [default: 16]."),
)  # fmt: skip
@packed("choice", PuckChoice, *puck_options())
@outputs("Save the launches: .csv, .h5, .jsonl or .parquet.", as_json=True)
@scene_options
@click.pass_context
def aim(
    ctx: click.Context, targets: tuple[tuple[float, float], ...], targets_file: Path | None,
    wishes: dict[str, Any], choice: PuckChoice, out: Outputs, chosen: SceneChoice,
) -> None:  # fmt: skip
    """Find launches after which a puck comes to rest at a target.

    There is one for each slip angle and sense of spin.  --w0, --speed or --time picks one or two,
    --angle one for each number of whole turns; without them a sample of the family is shown.  They
    are looked up, some 1e-10 of the distance off.  That there is none is an answer too.

    \b
    puck aim --target 2,0.1 --w0 5
    puck aim --target 2,0.1 --time 3
    puck aim --target 2,0.1 --angle 90deg --count 2
    puck aim --target 2,0.1 --max-speed 1.5 --max-spin 10 --plot aim.png
    puck aim --targets holes.csv --time 3 -o shots.csv
    puck aim --target 0.5,0.1 --base box:20cmx10cm --friction 0.3 --w0 10

    With --base the puck, whose body begins along x, is run to its stop for each launch tried, as in
    a scene: one --target, without --time and --angle, which are of round pucks; without --w0 and
    --speed it does not spin.

    With --scene others lie on the board: launches of the striker after which a puck, or it itself,
    ends at a target or in a pocket, also off cushions and other pucks.  Each is run on the whole
    board; those whose end changes least with heading and speed come first.

    \b
    puck aim --scene curling-take-out --puck yellow --target 0.5,-0.5
    puck aim --scene crokinole --puck shot --pocket 0 --plot shot.png
    puck aim --scene crokinole --puck shot --pocket 0 --odds heading=0.5deg --odds speed=0.05
    """  # noqa: D301 - click reads the backspace
    picked = [f"--{name}" for name in ("w0", "speed", "time", "angle") if wishes[name] is not None]
    if len(picked) > 1:
        raise InputError(f"{picked[0]} and {picked[1]} clash: each picks a launch")
    for name, places in (("--target", targets), ("--pocket", wishes["pocket"])):
        if len(places) > 1:
            raise InputError(f"{name} is given {len(places)} times: one place at a time")
    if targets_file is not None and targets:
        raise InputError("--target and --targets both say where: give one of them")
    wishes["pocket"], wishes["odds"] = next(iter(wishes["pocket"]), None), wishes["odds"] or None
    wishes = not_none(wishes)
    if chosen or choice.base is not None:
        if targets_file is not None:
            wishes["targets"] = targets_file
        if targets:
            wishes["target"] = targets[0]
        return _aim_in_scene(ctx, wishes, choice, out, chosen)
    for name in _ON_BOARDS:
        if name in wishes:
            flag = f"--{name.replace('_', '-')}"
            raise InputError(f"{flag} is for a board: give --scene FILE|NAME, too")
    if not targets and targets_file is None:
        raise click.MissingParameter(param_hint="'--target'", param_type="option")
    out.prepare(choice.pressure, targets_file)
    where: Any = targets[0] if targets else _read_targets(targets_file)
    names = {"w0": "spin", "time": "stop_time"}
    with one_question() if targets else nullcontext():
        result: Any = choice.puck().aim(
            where, **{names.get(name, name): value for name, value in wishes.items()}
        )
    out.deliver(result, empty=not result.launch_spin.size)
    out.report(result, choice.note)


def _aim_in_scene(
    ctx: click.Context, wishes: dict[str, Any], choice: PuckChoice, out: Outputs,
    chosen: SceneChoice,
) -> None:  # fmt: skip
    """Aim of a striker on a board, or of a puck on a base."""
    for name, instead in (
        ("targets", "give one --target"), ("time", "leave it out"), ("angle", "leave it out"),
    ):  # fmt: skip
        if name in wishes:
            at = "in a scene" if chosen else "with --base"
            raise InputError(f"--{name} has no place {at}: {instead}")
    scatter, near = _scatter_of(wishes.pop("odds", ())), wishes.pop("within", None)
    if (near is not None) != (bool(scatter) and "target" in wishes):
        raise InputError("--within, how near the puck is to end, is for --odds of a --target")
    tables = scene_tables(ctx, chosen, ("targets", "odds", "within", *wishes))
    out.prepare(*chosen.reads(tables))
    wishes |= {name: number_or_name(wishes[name]) for name in ("puck", "striker", "hits")
               if name in wishes}  # fmt: skip
    if "w0" in wishes:
        wishes["spin"] = wishes.pop("w0")
    from puck_tables.world.scene import Scene

    with progress("searches") as show:
        aimed = Scene.from_tables(tables, chosen.name).aim(**wishes, progress=show)
    out.deliver(aimed, empty=not len(aimed))
    odds = aimed.odds(within=near, **scatter) if scatter and len(aimed) else None
    summary = None if odds is None else lambda one: {**one.summary(), "odds": odds.summary()}
    out.report(aimed, "" if chosen else choice.note, summary)
    if odds is not None and not out.as_json:
        click.echo(f"\n{odds}")


def _scatter_of(odds: Iterable[str]) -> dict[str, Any]:
    """Deviations by the names that the library has."""
    from puck_tables._core.arrays import real

    scatter: dict[str, Any] = {}
    for name, text in named(odds, "--odds", "NAME=DEVIATION, like heading=0.5deg").items():
        if name not in _SCATTERS:
            raise InputError(f"--odds {name} does not scatter: give {', '.join(_SCATTERS)}")
        number = real(f"--odds {name}", number_or_text(text), _SCATTERS[name])
        scatter["spin" if name == "w0" else name] = number
    return scatter


def _read_targets(path: Path | None) -> Any:
    """Places (n, 2) from a file."""
    from puck_tables._core.quantities import X, Y
    from puck_tables._core.read_columns import numbers_of

    assert path is not None
    return numbers_of(path, (X, Y), 2, _LARGEST_FILE).rows


def number_or_name(text: str | None) -> int | str | None:
    """A puck as it is given on the command line: a number, or a name.

    >>> number_or_name("2"), number_or_name("queen")
    (2, 'queen')
    """
    return int(text) if text is not None and text.isascii() and text.isdecimal() else text

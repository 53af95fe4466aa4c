"""``puck sweep``: maps of stops."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from puck_tables.cli.options import (
    FILE,
    NUMBER,
    Range,
    Vector,
    body_options,
    deliver,
    explain_option,
    explained,
    output_options,
    prepare_outputs,
    printable,
    progress,
    puck_given,
    puck_options,
    table_option,
    tables_named,
)
from puck_tables.cli.scene_run import files_read, scene_options, scene_tables, summary_of_map
from puck_tables.cli.start import last_words

from puck_tables.accuracy.methods import METHODS
from puck_tables.errors import InputError

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    from puck_tables.stopping.stop_table import StopTable
    from puck_tables.stopping.sweep import StopMap
    from puck_tables.table.resultant_table import ResultantTable

RANGE = Range()


@click.command()
@click.option("--w0", type=RANGE, help="Launch spin in rad/s.")
@click.option("--speed", type=RANGE, help="Launch speed along x in m/s.")
@click.option("--v0", type=Vector(), help="One launch velocity in m/s instead of --speed.")
@click.option("--delta", type=RANGE, help="delta = 2 f h / r.  [default: 0.5]")
@puck_options(mass=False)
@body_options
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
@table_option
@click.option(
    "-o",
    "--output",
    type=FILE,
    metavar="FILE",
    help="Save the map: .h5, .csv, .json, .jsonl or .parquet.  Without -o and --plot, CSV goes to "
    "stdout.",
)
@click.option(
    "--resume",
    is_flag=True,
    help="Keep what is done in FILE.progress; the same command goes on from there.",
)
@output_options
@scene_options
@click.pass_context
def sweep(
    ctx: click.Context, w0: float | tuple[float, float, int] | None,
    speed: float | tuple[float, float, int] | None,
    v0: tuple[float, float] | None, delta: float | tuple[float, float, int] | None,
    radius: float | None, height: float | None, friction: float | None, gravity: float | None,
    decel: float | None, pressure: str, gyration: float | None, tol: float,
    method: str | None, explain: bool, threads: int | None,
    table_path: Path | None, output: Path | None, resume: bool, plot: Path | None, overwrite: bool,
    scene: str | None, changes: tuple[str, ...],
) -> None:  # fmt: skip
    """Map where and when pucks stop, or how a scene ends.

    Ranges are START:STOP:COUNT, ends included.  What is left out is fixed at --speed 1 --w0 0
    --delta 0.5 --radius 1 --decel 1; without --w0, --speed and --v0 the map is that of speeds from
    0 to 2 m/s by spins from -4 to 4 rad/s.  The status of a stop is 0, or 2 where the motion is too
    large for floating point.

    \b
    puck sweep --plot map.png
    puck sweep --v0 1,0 --w0 0:10:101 -o stops.csv
    puck sweep --speed 0:2:201 --w0 -20:20:401 --delta 0:1:5 -o map.h5
    puck sweep --v0 1,0 --w0 0:10:101 --delta 2 -o tall.csv
    puck sweep --scene incline --set launch.spin=0:80:81 --set floor.slope=0:0.14:71 --plot map.png

    Each delta above 1, or with --pressure or --gyration, takes about a second to prepare.
    """  # noqa: D301 - click reads the backspace
    if scene is not None or changes:
        tables = scene_tables(ctx, scene, changes)
        prepare_outputs(output, plot=plot, overwrite=overwrite, inputs=files_read(scene, tables))
        _sweep_scene(tables, explain, threads, output, resume, plot, overwrite)
        return
    if v0 is not None and speed is not None:
        raise InputError("--v0 and --speed clash: both give the launch velocity")
    prepare_outputs(output, plot=plot, overwrite=overwrite, inputs=(table_path, pressure))
    from puck_tables.io.csv import encode
    from puck_tables.stopping.sweep import BYTES_PER_LAUNCH, BYTES_PER_ROW, check_memory

    lowest = delta[0] if isinstance(delta, tuple) else delta
    puck = puck_given(radius, height, friction, gravity, lowest, decel, pressure, gyration)
    given = any(x is not None for x in (w0, speed, v0))
    if plot is not None and given and not any(isinstance(x, tuple) for x in (w0, speed, delta)):
        raise InputError("--plot needs a range: give --w0, --speed or --delta START:STOP:COUNT")
    as_text = plot is None if output is None else output.suffix.lower() != ".h5"
    check_memory(
        tuple(x[2] for x in (w0, speed, delta) if isinstance(x, tuple)),
        BYTES_PER_ROW if as_text else BYTES_PER_LAUNCH,
    )
    table = None if table_path is None else _table_of_stops(table_path)
    kept = _going_on(output) if resume else None
    with progress("stops") as show:
        stops = puck.sweep(
            None if w0 is None else _values(w0), None if speed is None else _values(speed),
            velocity=v0, delta=_values(delta) if isinstance(delta, tuple) else None, tol=tol,
            method=method, table=table, threads=threads, progress=show, checkpoint=kept,
        )  # fmt: skip
    if not (stops.status == 0).any():
        raise InputError("all these launches are too large for floating point: use larger units")
    deliver(stops, output, None, overwrite)
    _done_with(kept, output)
    deliver(stops, None, plot, overwrite)
    if output is None and plot is None:
        click.echo(encode(stops.dataset()).decode(), nl=False)
    click.echo(printable(_summary(stops)), err=True)
    if explain:
        explained(stops)


def _sweep_scene(
    tables: dict[str, Any], explain: bool, threads: int | None, output: Path | None, resume: bool,
    plot: Path | None, overwrite: bool,
) -> None:  # fmt: skip
    """A map over a scene, to the end of the command."""
    from puck_tables.io.csv import encode
    from puck_tables.scene.scene import Scene

    kept = _going_on(output) if resume else None
    with progress("runs") as show:
        stops = Scene.from_tables(tables).sweep(threads=threads, progress=show, checkpoint=kept)
    deliver(stops, output, None, overwrite)
    _done_with(kept, output)
    deliver(stops, None, plot, overwrite)
    if output is None and plot is None:
        click.echo(encode(stops.dataset()).decode(), nl=False)
    click.echo(printable(summary_of_map(stops)), err=True)
    if explain:
        explained(stops)


def _done_with(kept: Path | None, output: Path | None) -> None:
    """Remove what is kept of a sweep that is saved, or say that something is left."""
    if kept is not None:
        kept.unlink(missing_ok=True)
    elif output is not None and _kept(output).exists():
        click.echo(f"{_kept(output)} is left of an interrupted sweep: remove it", err=True)


def _table_of_stops(path: Path) -> ResultantTable | StopTable:
    """A table that stops can come from."""
    from puck_tables.stopping.stop_table import StopTable
    from puck_tables.table.resultant_table import ResultantTable

    table = tables_named(path)[0]
    if not isinstance(table, ResultantTable | StopTable):
        raise InputError(f"{path} holds '{table.kind}': stops come from 'stops' or 'resultants'")
    return table


def _kept(output: Path | None) -> Path:
    """Where a sweep that may be interrupted keeps what is done."""
    if output is None:
        raise InputError("--resume needs -o FILE: what is done is kept beside it")
    return output.with_name(output.name + ".progress")


def _going_on(output: Path | None) -> Path:
    """The same, and what is said of it after Ctrl-C."""
    kept = _kept(output)
    words = f"Interrupted: {kept} keeps what is done; the same command goes on."
    last_words.append(lambda: words if kept.exists() else last_words[0]())
    return kept


def _values(given: float | tuple[float, float, int]) -> npt.NDArray[np.float64]:
    import numpy as np

    return np.linspace(*given) if isinstance(given, tuple) else np.asarray(given)


def _summary(stops: StopMap) -> str:
    from puck_tables.stopping.solvers import STATUS_MEANINGS

    ranged = " x ".join(f"{name} ({values.size})" for name, values in stops.axes.items())
    fixed = ", ".join(f"{name} = {value:g}" for name, value in stops.fixed.items())
    counts = ", ".join(
        f"{int((stops.status == code).sum())} {meaning.replace('_', ' ')}"
        for code, meaning in enumerate(STATUS_MEANINGS)
        if code == 0 or (stops.status == code).any()
    )
    return f"{ranged or 'one launch'} at {fixed}: {counts}; {stops.method}, {stops.table}"

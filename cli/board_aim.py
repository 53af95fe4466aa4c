"""``puck aim --scene``: launches on a board, and what is said of them."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from puck_tables.cli.options import deliver, progress, reported

if TYPE_CHECKING:
    from puck_tables.world.aimed import BoardAim

_WIDEST = 60  # signs of a course in the table


def aim_on_board(
    tables: dict[str, Any], source: str, wishes: dict[str, Any], as_json: bool,
    output: Path | None, plot: Path | None, overwrite: bool,
) -> None:  # fmt: skip
    """An aim on a board, to the end of its command."""
    from puck_tables.world.scene import Scene

    scene = Scene.from_tables(tables, source)
    with progress("searches") as show:
        result = scene.aim(**wishes, progress=show)
    deliver(result, output, plot if len(result) else None, overwrite)
    if plot is not None and not len(result):
        click.echo(f"no picture: there is nothing to draw in {plot}", err=True)
    reported(result, False, as_json, _report)


def number_or_name(text: str | None) -> int | str | None:
    """A puck as it is given on the command line: a number, or a name.

    Examples
    --------
    >>> number_or_name("2"), number_or_name("queen")
    (2, 'queen')
    """
    return int(text) if text is not None and text.isascii() and text.isdecimal() else text


def _report(result: BoardAim) -> str:
    """The answer, and the launches line by line."""
    lines = [
        f"scene    {result.scene.title or 'without a title'}",
        f"wanted   {result.puck} {result.where}, {result.striker} sent off {result.limit}".rstrip(),
        f"answer   {result.answer}",
    ]
    if not len(result):
        return "\n".join(lines)
    names = {
        "per_degree": ("m per deg", 1.0), "per_percent": ("m per %", 1.0),
        "heading_width": ("width deg", math.degrees(1.0)), "speed_width": ("width m/s", 1.0),
        "spin_width": ("width 1/s", 1.0),
    }  # fmt: skip
    kinds = [name for name in names if name in result.columns]
    lines.append(
        f"\n{'speed m/s':>11} {'heading deg':>12} {'w0 rad/s':>9} "
        + " ".join(f"{names[kind][0]:>10}" for kind in kinds)
        + f" {'time s':>9} {'miss m':>7}  impacts"
    )
    for n, course in enumerate(result.courses):
        margins = " ".join(
            f"{result.columns[kind][n] * names[kind][1]:>10.4g}" for kind in kinds
        )  # fmt: skip
        shown = course if len(course) <= _WIDEST else course[: _WIDEST - 3] + "..."
        lines.append(
            f"{result.launch_speed[n]:>11.6f} {math.degrees(result.launch_heading[n]):>12.5f} "
            f"{result.launch_spin[n]:>9.5g} {margins} {result.stop_time[n]:>9.6g} "
            f"{result.miss[n]:>7.0e}  {shown or 'none'}"
        )
    return "\n".join(lines)

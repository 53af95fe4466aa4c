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
        found = scene.aim(**wishes, progress=show)
    deliver(found, output, plot if len(found) else None, overwrite)
    if plot is not None and not len(found):
        click.echo(f"no picture: there is nothing to draw in {plot}", err=True)
    reported(found, False, as_json, _report)


def number_or_name(given: str | None) -> int | str | None:
    """A puck as it is given on the command line: a number, or a name.

    Examples
    --------
    >>> number_or_name("2"), number_or_name("queen")
    (2, 'queen')
    """
    return int(given) if given is not None and given.isascii() and given.isdecimal() else given


def _report(found: BoardAim) -> str:
    """The answer, and the launches line by line."""
    lines = [
        f"scene    {found.scene.title or 'without a title'}",
        f"wanted   {found.puck} {found.where}, {found.striker} sent off {found.limit}".rstrip(),
        f"answer   {found.answer}",
    ]
    if not len(found):
        return "\n".join(lines)
    names = {
        "per_degree": ("m per deg", 1.0), "per_percent": ("m per %", 1.0),
        "heading_width": ("width deg", math.degrees(1.0)), "speed_width": ("width m/s", 1.0),
        "spin_width": ("width 1/s", 1.0),
    }  # fmt: skip
    kinds = [name for name in names if name in found.columns]
    lines.append(
        f"\n{'speed m/s':>11} {'heading deg':>12} {'w0 rad/s':>9} "
        + " ".join(f"{names[kind][0]:>10}" for kind in kinds)
        + f" {'time s':>9} {'miss m':>7}  impacts"
    )
    for n, course in enumerate(found.courses):
        margins = " ".join(
            f"{found.columns[kind][n] * names[kind][1]:>10.4g}" for kind in kinds
        )  # fmt: skip
        shown = course if len(course) <= _WIDEST else course[: _WIDEST - 3] + "..."
        lines.append(
            f"{found.launch_speed[n]:>11.6f} {math.degrees(found.launch_heading[n]):>12.5f} "
            f"{found.launch_spin[n]:>9.5g} {margins} {found.stop_time[n]:>9.6g} "
            f"{found.miss[n]:>7.0e}  {shown or 'none'}"
        )
    return "\n".join(lines)

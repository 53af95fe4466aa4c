"""``puck aim --scene``: launches on a board, and what is said of them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from puck_tables.cli.options import Outputs
from puck_tables.cli.printing import columns, listed, progress

if TYPE_CHECKING:
    from puck_tables.world.aimed import BoardAim

_MARGINS = {  # headings, and what a number is multiplied by
    "per_degree": ("m per deg", 1.0), "per_percent": ("m per %", 1.0),
    "heading_width": ("width deg", math.degrees(1.0)), "speed_width": ("width m/s", 1.0),
    "spin_width": ("width 1/s", 1.0),
}  # fmt: skip


def aim_on_board(tables: dict[str, Any], source: str, wishes: dict[str, Any], out: Outputs) -> None:
    """An aim on a board, to the end of its command."""
    from puck_tables.world.scene import Scene

    scene = Scene.from_tables(tables, source)
    with progress("searches") as show:
        result = scene.aim(**wishes, progress=show)
    out.deliver(result, empty=not len(result))
    out.report(result, _report)


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
    wanted = f"{result.puck} {result.where}, {result.striker} sent off {result.limit}".rstrip()
    first = listed({
        "scene": result.scene.title or "without a title", "wanted": wanted, "answer": result.answer,
    }, 8)  # fmt: skip
    if not len(result):
        return first
    margins = [(*_MARGINS[name], result.columns[name]) for name in _MARGINS
               if name in result.columns]  # fmt: skip
    heads = {
        "speed m/s": ".6f", "heading deg": ".5f", "w0 rad/s": ".5g",
        **{head: ".4g" for head, _, _ in margins}, "time s": ".6g", "miss m": ".0e", "impacts": "",
    }  # fmt: skip
    rows = zip(
        result.launch_speed, math.degrees(1.0) * result.launch_heading, result.launch_spin,
        *(factor * values for _, factor, values in margins), result.stop_time, result.miss,
        (course or "none" for course in result.courses), strict=True,
    )  # fmt: skip
    return f"{first}\n\n{columns(heads, rows)}"

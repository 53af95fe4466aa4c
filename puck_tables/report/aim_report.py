"""What is told of launches that come to rest at a place."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from puck_tables.report.lines_and_tables import columns, listed, puck_words

if TYPE_CHECKING:
    from puck_tables.stopping.aim_at_targets import Aim
    from puck_tables.world.aimed import BoardAim

_MARGINS = {  # headings, and what a number is multiplied by
    "per_degree": ("m per deg", 1.0), "per_percent": ("m per %", 1.0),
    "heading_width": ("width deg", math.degrees(1.0)), "speed_width": ("width m/s", 1.0),
    "spin_width": ("width 1/s", 1.0),
}  # fmt: skip


def report(result: Aim) -> str:
    """The answer; of one target the launches, line by line, of many how well they do."""
    words = puck_words(result.puck)
    if not result.is_one:
        first, *others = result.explain().splitlines()
        return "\n".join([listed({"puck": words, "answer": first.rstrip(".")}, 7), *others])
    x, y = result.target
    first = listed({"puck": words, "target": f"({x:g}, {y:g}) m", "answer": result.answer}, 7)
    if not result.launch_spin.size:
        return first
    heads = {
        "w0 rad/s": ".6g", "v0 x m/s": ".6g", "v0 y m/s": ".6g", "speed m/s": ".6g",
        "heading deg": ".5f", "phi deg": ".3f", "time s": ".6g", "body deg": ".5g",
    }  # fmt: skip
    degrees = math.degrees(1.0)
    rows = zip(
        result.launch_spin, result.launch_vx, result.launch_vy, result.launch_speed,
        degrees * result.launch_heading, degrees * result.launch_slip_angle, result.stop_time,
        degrees * result.body_angle, strict=True,
    )  # fmt: skip
    return f"{first}\n\n{columns(heads, rows)}"


def board_report(result: BoardAim) -> str:
    """The answer, and the launches line by line."""
    scene = result.scene
    wanted = f"{result.puck} {result.where}, {result.striker} sent off {result.limit}".rstrip()
    first = {"scene": scene.title or "without a title", "wanted": wanted}
    if not (scene.title or scene.pucks):
        first = {"puck": puck_words(scene.puck), "target": result.where.removeprefix("at ")}
    lines = listed({**first, "answer": result.answer}, 8 if "scene" in first else 7)
    if not len(result):
        return lines
    margins = [(*_MARGINS[name], result.columns[name]) for name in _MARGINS
               if name in result.columns]  # fmt: skip
    heads = {
        "speed m/s": ".6f", "heading deg": ".5f", "w0 rad/s": ".5g",
        **{head: ".4g" for head, _, _ in margins}, "time s": ".6g", "miss m": ".0e", "impacts": "",
    }  # fmt: skip
    rows = zip(
        result.launch_speed, math.degrees(1.0) * result.launch_heading, result.launch_spin,
        *(factor * values for _, factor, values in margins), result.stop_time, result.miss,
        (sequence or "none" for sequence in result.sequences), strict=True,
    )  # fmt: skip
    return f"{lines}\n\n{columns(heads, rows)}"

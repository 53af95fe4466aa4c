"""The plane of a scene as a panel: the path, and all that stands or acts there, each labelled."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.plot.animation import film_of_one
from puck_tables.plot.base_outlines import MARK, draw_along
from puck_tables.plot.board import draw_board, show
from puck_tables.plot.floor_axes import Box
from puck_tables.plot.style import BLUE, LAUNCH, ORANGE, RED, STOP
from puck_tables.plot.titles import legend_below, noted
from puck_tables.scene.acting import acting
from puck_tables.scene.run import Run
from puck_tables.scene.scene_spec import SceneSpec

if TYPE_CHECKING:
    from matplotlib.axes import Axes


_PUCKS_DRAWN = 12  # outlines along a track: more run into each other
# ingredients that are seen in the plane; others are named above it
_DRAWN = (
    "slope",
    "turntable",
    "strips",
    "patches",
    "force",
    "walls",
    "edges",
    "rail",
    "pivot",
    "blade",
)
_PURPLE = "#8b2fa0"
_SHAPE = 2.2  # width of the panel over its height
_LEGEND_ROW = 4  # entries


def draw_plane(axes: Axes, run: Run, columns: dict[str, FloatArray]) -> None:
    """Draw the plane of a run; ``columns``: its states close to each other, (n,) by name."""
    scene, x, y = run.scene, columns["x"], columns["y"]
    film = film_of_one(run, columns, _SHAPE)
    draw_board(axes, film)
    axes.plot(x, y, color=BLUE, linewidth=1.4, zorder=3)
    _draw_pucks(axes, scene, columns)
    turns = [event for event in run.events if event.what in ("impact", "contact")]
    if turns:
        axes.plot(
            [e.x for e in turns], [e.y for e in turns], ".", markersize=6, color=RED, zorder=4,
            label="impact of the rim", rasterized=True,
        )  # fmt: skip
    _draw_constraint(axes, scene, run.end_time)
    also = _draw_pulls(axes, scene, x, y, film.box)
    if notes := [words for words in (also, film.hidden) if words]:
        noted(axes, "; ".join(notes))
    axes.plot(x[0], y[0], **LAUNCH, label="launch")
    axes.plot(x[-1], y[-1], **STOP, label=run.end)
    show(axes, film.box)
    legend_below(axes, _LEGEND_ROW, 0.13)


def _draw_pucks(axes: Axes, scene: SceneSpec, columns: dict[str, FloatArray]) -> None:
    """The puck at some places of its path, with a mark on it, and the blade that leads it."""
    x, y, angle, hold = columns["x"], columns["y"], columns["orientation"], scene.constraint
    drawn = draw_along(axes, scene.puck, x, y, angle, _PUCKS_DRAWN)
    if hold is None or hold.kind != "blade":
        return
    half = scene.puck.radius * (1.0 if scene.puck.shape is None else MARK)
    for n in drawn:
        dx, dy = half * math.cos(angle[n] + hold.angle), half * math.sin(angle[n] + hold.angle)
        axes.plot(
            [x[n] - dx, x[n] + dx], [y[n] - dy, y[n] + dy], color=_PURPLE, linewidth=1.6, zorder=2,
            label="blade" if n == drawn[0] else "",
        )  # fmt: skip


def _draw_constraint(axes: Axes, scene: SceneSpec, end_time: float) -> None:
    """The rail at the launch, or the pivot with its way."""
    hold, start = scene.constraint, scene.launch.position
    if hold is None or hold.kind == "blade":
        return
    moving = f", moving at ({hold.velocity[0]:g}, {hold.velocity[1]:g}) m/s"
    words = hold.kind + (moving if any(hold.velocity) else "")
    if hold.kind == "rail":
        further = start[0] + math.cos(hold.angle), start[1] + math.sin(hold.angle)
        axes.axline(start, further, color=_PURPLE, linewidth=1.2, linestyle="-.", label=words)
        return
    bearing = scene.launch.orientation + hold.angle
    at = (start[0] + hold.reach * math.cos(bearing), start[1] + hold.reach * math.sin(bearing))
    way = [at, tuple(p + v * end_time for p, v in zip(at, hold.velocity, strict=True))]
    axes.plot(*zip(*way, strict=True), color=_PURPLE, linewidth=1.2, linestyle="-.", zorder=2)
    axes.plot(*at, "P", color=_PURPLE, markersize=8, zorder=5, linestyle="", label=words)


def _draw_pulls(axes: Axes, scene: SceneSpec, x: FloatArray, y: FloatArray, box: Box) -> str:
    """Slope and constant force as arrows in corners that the path leaves free; what else pulls."""
    pulls = []
    if scene.floor.slope > 0.0:
        pulls.append((scene.floor.downhill, f"downhill, slope {scene.floor.slope:.4g} rad", ORANGE))
    fx, fy = scene.force.constant
    if fx != 0.0 or fy != 0.0:
        pulls.append((math.atan2(fy, fx), f"force ({fx:g}, {fy:g}) N", RED))
    size = 0.12 * (box.high - box.low)
    free = _free_corners(x, y, box, 1.6 * size)
    for (angle, words, color), (px, py) in zip(pulls, free, strict=False):
        dx, dy = size * math.cos(angle), size * math.sin(angle)
        axes.annotate(
            "", (px + dx, py + dy), xytext=(px - dx, py - dy), zorder=4,
            arrowprops={"arrowstyle": "-|>", "color": color, "linewidth": 2.0},
        )  # fmt: skip
        axes.plot([], [], color=color, marker=">", label=words)
    also = [name for name in acting(scene) if name not in _DRAWN]
    if scene.force.torque != 0.0:
        also.append(f"torque {scene.force.torque:g} N m")
    return f"also acting: {', '.join(also)}" if also else ""


def _free_corners(
    x: FloatArray, y: FloatArray, box: Box, inset: float
) -> list[tuple[float, float]]:
    """Places in the four corners, those farthest from the path first."""
    corners = [
        (px, py)
        for px in (box.left + inset, box.right - inset)
        for py in (box.high - inset, box.low + inset)
    ]
    return sorted(corners, key=lambda at: -float(np.hypot(x - at[0], y - at[1]).min()))

"""Picture of a run: of one puck its plane, speeds and energies; of several all their ways.

The plane has the path, and all that stands or acts there, each labelled.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.plot import board
from puck_tables.plot.animation import film_of_one, states_drawn
from puck_tables.plot.base_outlines import MARK, draw_along
from puck_tables.plot.board import draw_board, show
from puck_tables.plot.floor_axes import Box
from puck_tables.plot.style import BLUE, GREEN, GREY, LAUNCH, ORANGE, RED, STOP, canvas
from puck_tables.plot.titles import legend_below, noted, titled
from puck_tables.scene.run import Run
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.world.plan import acting

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

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
_ENERGIES = {
    "kinetic_energy": ("kinetic", BLUE),
    "heat_dry": ("dry friction", ORANGE),
    "heat_viscous": ("drag", GREEN),
    "heat_rims": ("rims", "#7a4b2a"),
    "heat_impact": ("impacts", RED),
    "work_given": ("work of forces", "#8b2fa0"),
    "work_support": ("work of supports", GREY),
}
_EVENTS_DRAWN = 60  # as lines over time


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
    ends = [at, tuple(p + v * end_time for p, v in zip(at, hold.velocity, strict=True))]
    axes.plot(*zip(*ends, strict=True), color=_PURPLE, linewidth=1.2, linestyle="-.", zorder=2)
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


def draw(run: Run) -> Figure:
    """The whole motion, with every event, whatever states the run has: it is run again.

    Of one puck the path among all that is in the plane; speeds; and the energy ledger.
    """
    if run.scene.pucks:
        return board.draw(run)
    columns = states_drawn(run)
    figure = canvas(10.0, 9.0)
    grid = figure.add_gridspec(2, 2, height_ratios=(1.35, 1.0))
    draw_plane(figure.add_subplot(grid[0, :]), run, columns)
    speeds = figure.add_subplot(grid[1, 0])
    time, radius = columns["time"], run.scene.puck.radius
    speeds.plot(time, np.hypot(columns["vx"], columns["vy"]), color=BLUE, label="speed v")
    speeds.plot(time, radius * columns["spin"], color=ORANGE, label="rim speed rω")
    energies = figure.add_subplot(grid[1, 1], sharex=speeds)
    largest = max(float(np.abs(columns[name]).max()) for name in _ENERGIES)
    for name, (label, color) in _ENERGIES.items():
        if np.abs(columns[name]).max() > 1e-9 * largest:
            energies.plot(time, columns[name], color=color, label=label)
    for axes, unit in ((speeds, "m/s"), (energies, "joule")):
        axes.axhline(0.0, color=GREY, linewidth=0.6)
        axes.set(xlabel="time / s", ylabel=unit)
        _draw_events(axes, run)
        legend_below(axes)
    title = run.scene.title or "Scene"
    titled(figure, f"{title}: {run.end} after {run.end_time:.4g} s")
    return figure


def draw_on(axes: Axes, run: Run) -> None:
    """The plane or the board alone."""
    if run.scene.pucks:
        board.draw_on(axes, run)
    else:
        draw_plane(axes, run, states_drawn(run))


def _draw_events(axes: Axes, run: Run) -> None:
    """Thin lines at what happens, as long as there are not too many; else how many there are."""
    events = [e for e in run.main_events if e.what != "edge"]
    if len(events) > _EVENTS_DRAWN:
        noted(axes, f"the moments of {len(events)} events are not drawn")
        return
    for event in events:
        axes.axvline(event.time, color=GREY, linewidth=0.5, linestyle=":")

"""The plane of a scene as a panel: the path, and all that stands or acts there, each labelled."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.plot.base_outlines import MARK, outline_of, path_of, placed
from puck_tables.plot.board_parts import (
    Painted,
    RoundPart,
    StraightPart,
    draw_painted,
    draw_rounds,
    painted_on,
    rounds_of,
    straight_parts,
)
from puck_tables.plot.floor_axes import Box, draw_floor
from puck_tables.plot.style import BLUE, GREY, LAUNCH, ORANGE, RED, STOP
from puck_tables.plot.titles import legend_below, noted, out_of_sight
from puck_tables.scene.acting import acting
from puck_tables.scene.parts import Edge, Wall
from puck_tables.scene.run import Run
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.scene.sides import line_of

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
_SHAPE = 2.2  # width of the panel over its height
_PURPLE = "#8b2fa0"
_LEGEND_ROW = 4  # entries


def draw_plane(axes: Axes, run: Run, columns: dict[str, FloatArray]) -> None:
    """Draw the plane of a run; ``columns``: its states close to each other, (n,) by name."""
    scene, radius = run.scene, run.scene.puck.radius
    x, y = columns["x"], columns["y"]
    painted, sides = painted_on(scene), straight_parts(scene)
    box = _box(*_with_lines(x, y, [*painted, *sides]), 1.6 * radius)
    draw_floor(axes, scene.floor, box, max(scene.frictions))
    axes.plot(x, y, color=BLUE, linewidth=1.4, zorder=3)
    _draw_pucks(axes, scene, columns)
    endless = [wall for wall in scene.walls if wall.point is not None]
    walls = _draw_lines(axes, endless, box, "wall", color="black", linewidth=2.5)
    edges = _draw_lines(axes, scene.edges, box, "edge", color=RED, linestyle="--")
    seen = [side for side in sides if _in_sight(side, box)]
    for number, side in enumerate(seen):
        label = None if walls + number else "wall"
        axes.plot(side.x, side.y, color="black", linewidth=2.5, zorder=1, label=label)
    draw_painted(axes, painted)
    rounds = [one for one in rounds_of(scene) if _meets(box, one)]
    draw_rounds(axes, rounds)
    turns = [event for event in run.events if event.what in ("impact", "contact")]
    if turns:
        axes.plot(
            [e.x for e in turns], [e.y for e in turns], ".", markersize=6, color=RED, zorder=4,
            label="impact of the rim", rasterized=True,
        )  # fmt: skip
    _draw_constraint(axes, scene, columns, box, run.end_time)
    also = _draw_pulls(axes, scene, x, y, box)
    hidden = out_of_sight(
        [("wall",)] * (len(endless) + len(sides))
        + [("edge",)] * len(scene.edges)
        + [(one.kind,) for one in rounds_of(scene)],
        [("wall",)] * (walls + len(seen)) + [("edge",)] * edges + [(one.kind,) for one in rounds],
    )
    if notes := [words for words in (also, hidden) if words]:
        noted(axes, "; ".join(notes))
    axes.plot(x[0], y[0], **LAUNCH, label="launch")
    axes.plot(x[-1], y[-1], **STOP, label=run.end)
    axes.set(xlabel="x / m", ylabel="y / m", xlim=box[:2], ylim=box[2:])
    axes.set_aspect("equal")
    legend_below(axes, _LEGEND_ROW, 0.13)


def _box(x: FloatArray, y: FloatArray, margin: float) -> Box:
    """Limits of the plane around a path, of the shape of the panel."""
    middle = ((x.min() + x.max()) / 2, (y.min() + y.max()) / 2)
    wide, high = float(np.ptp(x)) / 2 + margin, float(np.ptp(y)) / 2 + margin
    wide, high = 1.05 * max(wide, _SHAPE * high), 1.05 * max(high, wide / _SHAPE)
    return Box(middle[0] - wide, middle[0] + wide, middle[1] - high, middle[1] + high)


def _with_lines(
    x: FloatArray, y: FloatArray, lines: list[Painted | StraightPart]
) -> tuple[FloatArray, FloatArray]:
    """The path, with the lines that lie where it goes."""
    for line in lines:
        over = min(line.x) <= x.max() and x.min() <= max(line.x)
        if over and min(line.y) <= y.max() and y.min() <= max(line.y):
            x, y = np.append(x, line.x), np.append(y, line.y)
    return x, y


def _in_sight(side: StraightPart, box: Box) -> bool:
    """Whether a side may be in sight."""
    over = min(side.x) <= box.right and box.left <= max(side.x)
    return over and min(side.y) <= box.high and box.low <= max(side.y)


def _meets(box: Box, part: RoundPart) -> bool:
    """Whether a round part may be in sight."""
    x, y = min(max(part.x, box.left), box.right), min(max(part.y, box.low), box.high)
    corners = [math.hypot(p - part.x, q - part.y) for p in box[:2] for q in box[2:]]
    inside = part.kind == "arc" and max(corners) < part.radius
    return math.hypot(x - part.x, y - part.y) <= part.radius and not inside


def _draw_pucks(axes: Axes, scene: SceneSpec, columns: dict[str, FloatArray]) -> None:
    """The puck at some places of its path, with a mark on it, or the blade that leads it."""
    from matplotlib.patches import PathPatch

    x, y, radius = columns["x"], columns["y"], scene.puck.radius
    outline, mark = outline_of(scene.puck), radius * (1.0 if scene.puck.shape is None else MARK)
    hold = scene.constraint
    blade = hold is not None and hold.kind == "blade"
    angle = columns["orientation"] + (hold.angle if hold is not None and blade else 0.0)
    way = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
    count = min(_PUCKS_DRAWN, max(2, int(way[-1] / (2.2 * radius)) + 1))
    chosen = np.unique(np.searchsorted(way, np.linspace(0.0, way[-1], count)).clip(0, x.size - 1))
    for n in chosen:
        there = path_of(placed(outline, x[n], y[n], columns["orientation"][n]))
        axes.add_patch(PathPatch(there, fill=False, color=GREY, linewidth=0.8, zorder=2))
        dx, dy = mark * math.cos(angle[n]), mark * math.sin(angle[n])
        back = 1.0 if blade else 0.0
        style: dict[str, Any] = {"color": _PURPLE, "linewidth": 1.6} if blade else {"color": GREY}
        label: dict[str, Any] = {"label": "blade"} if blade and n == chosen[0] else {}
        axes.plot(
            [x[n] - back * dx, x[n] + dx], [y[n] - back * dy, y[n] + dy], zorder=2,
            **{"linewidth": 0.8, **style}, **label,
        )  # fmt: skip


def _draw_constraint(
    axes: Axes, scene: SceneSpec, columns: dict[str, FloatArray], box: Box, end_time: float
) -> None:
    """The rail at the launch, or the pivot with its way."""
    hold, start = scene.constraint, scene.launch.position
    if hold is None or hold.kind == "blade":
        return
    moving = f", moving at ({hold.velocity[0]:g}, {hold.velocity[1]:g}) m/s"
    words = hold.kind + (moving if any(hold.velocity) else "")
    if hold.kind == "rail":
        normal = (-math.sin(hold.angle), math.cos(hold.angle))
        _draw_line(axes, start, normal, box, color=_PURPLE, linewidth=1.2, linestyle="-.",
                   label=words)  # fmt: skip
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


def _draw_lines(
    axes: Axes, lines: Sequence[Wall | Edge], box: Box, label: str, **style: Any
) -> int:
    """Walls or edges, the first that is in sight with the label; how many are in sight."""
    in_view = 0
    for line in lines:
        words = "" if in_view else label
        nx, ny, at = line_of(line)
        in_view += _draw_line(axes, (nx * at, ny * at), (nx, ny), box, label=words, **style)
    return in_view


def _draw_line(
    axes: Axes, point: tuple[float, float], normal: tuple[float, float], box: Box, **style: Any
) -> bool:
    """A line of a unit normal, drawn only where it is in sight; whether it is."""
    nx, ny = normal
    middle = ((box.left + box.right) / 2, (box.low + box.high) / 2)
    half = math.hypot(box.right - box.left, box.high - box.low)
    off = nx * (middle[0] - point[0]) + ny * (middle[1] - point[1])
    reach = 0.5 * (abs(nx) * (box.right - box.left) + abs(ny) * (box.high - box.low))
    if abs(off) > reach:
        return False
    foot = (middle[0] - off * nx, middle[1] - off * ny)
    axes.plot(
        [foot[0] - half * ny, foot[0] + half * ny], [foot[1] + half * nx, foot[1] - half * nx],
        zorder=1, **style,
    )  # fmt: skip
    return True

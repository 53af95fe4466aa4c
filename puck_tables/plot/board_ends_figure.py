"""Picture of many runs of several pucks: where each of them ends, on the board."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables._core.colours import on_white
from puck_tables._core.wording import counted
from puck_tables.errors import InputError
from puck_tables.plot.animation import Animation, film_of
from puck_tables.plot.board import close_up, draw_board, finished, panels_for, show
from puck_tables.plot.floor_axes import Box
from puck_tables.plot.sample_figure import HELD, cloud_of, draw_regions
from puck_tables.plot.style import GREY
from puck_tables.plot.titles import legend_below, noted
from puck_tables.scene.run import LAST_END
from puck_tables.world.scene_ends import Sample, SceneEnds
from puck_tables.world.simulate import simulate

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_NAMED = 8  # pucks: a legend of more hides the picture
_MOST_ENDS = (0.02, 0.98)  # of the ends stand in a close-up
_BOARD = ("wall", "edge", "post", "arc", "pocket", "floor")  # what may range and is drawn once


def draw(ends: SceneEnds) -> Figure:
    """The ends of all runs as points in the colours of the pucks, crosses where they left play."""
    film = _board(ends)
    boxes = [_box(ends, film), *_close_up(ends, film)]
    figure, panels = panels_for(boxes)
    for axes, box in zip(panels, boxes, strict=True):
        _draw(axes, ends, film, box)
    _note(panels[0], ends, film)
    for axes, box in zip(panels[1:], boxes[1:], strict=True):
        x, y = (ends.columns[name].ravel() for name in ("x", "y"))
        inside = (x >= box[0]) & (x <= box[1]) & (y >= box[2]) & (y <= box[3])
        beyond = int((np.isfinite(x) & ~inside).sum())
        noted(axes, f"close-up; {beyond} of {np.isfinite(x).sum()} ends lie outside")
    title = f"{ends.title}: ends of {counted(ends.end.size, 'run')}"
    if isinstance(ends, Sample):
        title += f", {ends.drawn_words}"
    finished(figure, panels, boxes, title)
    return figure


def draw_on(axes: Axes, ends: SceneEnds) -> None:
    """The board alone."""
    film = _board(ends)
    _draw(axes, ends, film, _box(ends, film))
    _note(axes, ends, film)
    legend_below(axes)


def _board(ends: SceneEnds) -> Animation:
    ended = np.flatnonzero(ends.end.ravel() <= LAST_END)
    if not ended.size:
        remarks = ends.endless or ("no run has an end",)
        raise InputError(f"there is nothing to draw: {'; '.join(remarks)}")
    return film_of(simulate(ends.scene.at(ends.numbers(int(ended[0])))))


def _draw(axes: Axes, ends: SceneEnds, film: Animation, box: Box) -> None:
    """The board, and every end on it."""
    draw_board(axes, film)
    named = len(ends.names) <= _NAMED
    total = {True: 0, False: 0}
    for number, (name, body) in enumerate(zip(ends.names, film.bodies, strict=True)):
        x, y, playing = (ends.columns[c][..., number].ravel() for c in ("x", "y", "in_play"))
        for stays, marker in ((True, "."), (False, "x")):
            mine = (playing > 0.0) if stays else (playing == 0.0)  # NaN: no end
            count = int(mine.sum())
            total[stays] += count
            words = f"{name}: {count} {'in' if stays else 'left'} play"
            axes.plot(
                x[mine], y[mine], linestyle="", marker=marker, markersize=3.0 if stays else 4.0,
                color=on_white(body.colour), zorder=3, rasterized=True,
                label=(" " * words.startswith("_") + words) if named and count else None,
            )  # fmt: skip
        if isinstance(ends, Sample):
            _hold(axes, x[playing > 0.0], y[playing > 0.0], body.line)
    if isinstance(ends, Sample):
        draw_regions(axes, ends)
        axes.plot(
            [], [], color=GREY, linewidth=1.0, label=f"holds {100 * HELD:.0f} % of a puck in play"
        )
    for stays, marker in ((True, "."), (False, "x")):
        if not named and total[stays]:
            words = f"{total[stays]} {'in' if stays else 'left'} play"
            axes.plot([], [], linestyle="", marker=marker, color=GREY, label=words)
    show(axes, box)


def _hold(axes: Axes, x: FloatArray, y: FloatArray, colour: str) -> None:
    """A line around most of the places of a puck that stays in play, where they are a cloud."""
    cloud = cloud_of(x, y)
    if cloud is None:
        return
    level = np.quantile(cloud.at_samples, 1.0 - HELD)
    if level > 0.0:
        axes.contour(
            *cloud.middles, cloud.density, levels=[level], colors=[colour], linewidths=1.0, zorder=4
        )


def _note(axes: Axes, ends: SceneEnds, film: Animation) -> None:
    """Say above the board what is not on it."""
    lost = ends.end.size - ends.ended
    notes = [f"{lost} of {counted(ends.end.size, 'run')} without an end"] if lost else []
    if any(path.startswith(_BOARD) for path in ends.ranging):
        notes.append("the board is that of the first run")
    if film.hidden:
        notes.append(film.hidden)
    if notes:
        noted(axes, "; ".join(notes))


def _close_up(ends: SceneEnds, film: Animation) -> list[Box]:
    """Around most of the ends, where pucks are too small to be seen."""
    there = ends.columns["in_play"] > 0.0  # NaN: no end
    if not there.any():
        return []
    x, y = (ends.columns[name][there] for name in ("x", "y"))
    middle = [np.quantile(row, _MOST_ENDS) for row in (x, y)]
    radius = max(body.radius for body in film.bodies)
    return close_up(_box(ends, film), np.stack(middle, axis=1), radius)


def _box(ends: SceneEnds, film: Animation) -> Box:
    """What shows the board and all ends."""
    left, right, low, top = film.box
    radius = max(puck.radius for puck in ends.scene.pucks) if ends.scene.pucks else 0.0

    def sides(name: str) -> tuple[float, float]:
        result: FloatArray = ends.columns[name]
        return float(np.nanmin(result)) - radius, float(np.nanmax(result)) + radius

    (west, east), (south, north) = sides("x"), sides("y")
    return Box(min(left, west), max(right, east), min(low, south), max(top, north))

"""Picture of tracks as they were read: the paths, and places and angles over time."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from puck_tables._core.wording import counted
from puck_tables.film.film import Track
from puck_tables.plot.style import COLORS, canvas, labelled
from puck_tables.plot.titles import legend_below, titled

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_LABELLED = 12  # marks: a legend of more hides the picture


def draw(tracks: Sequence[Track]) -> Figure:
    """The paths beside x, y and the angle (without leaps of more than half a turn) over time."""
    turning = any(track.angle is not None for track in tracks)
    rows = 3 if turning else 2
    figure = canvas(10.0, 2.2 * rows + 0.6)
    grid = figure.add_gridspec(rows, 2)
    plane = figure.add_subplot(grid[:, 0])
    panels = [figure.add_subplot(grid[row, 1]) for row in range(rows)]
    for number, track in enumerate(tracks):
        look: dict[str, Any] = {
            "color": COLORS[number % len(COLORS)], "linewidth": 0.8, "marker": ".", "markersize": 3,
        }  # fmt: skip
        plane.plot(track.place[:, 0], track.place[:, 1], **look)
        plane.plot(*track.place[track.seen][0], marker="o", color=look["color"])
        label = track.name if 1 < len(tracks) <= _LABELLED else None
        panels[0].plot(track.time, track.place[:, 0], label=label, **look)
        panels[1].plot(track.time, track.place[:, 1], **look)
        if track.angle is not None:
            angle, known = track.angle.copy(), np.isfinite(track.angle)
            angle[known] = np.unwrap(angle[known])
            panels[2].plot(track.time, angle, **look)
    for panel, what in zip(panels, ("x / m", "y / m", "angle / rad"), strict=False):
        panel.set_ylabel(what)
        panel.grid(color="#e4e4e4", linewidth=0.6)
    panels[-1].set_xlabel("time / s")
    plane.set_aspect("equal", adjustable="datalim")
    labelled(plane, "x / m", "y / m")
    legend_below(figure, 4)
    seen = sum(int(np.count_nonzero(track.seen)) for track in tracks)
    unseen = sum(track.time.size for track in tracks) - seen
    name = tracks[0].name if len(tracks) == 1 else f"{len(tracks)} tracks"
    without = f", {unseen} without a place" if unseen else ""
    titled(figure, f"{name}, {counted(seen, 'frame')}{without}")
    return figure

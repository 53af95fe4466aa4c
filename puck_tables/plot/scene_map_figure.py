"""Pictures of maps over a scene: where and when it ends, and how."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from puck_tables.plot.style import (
    BLUE,
    GREEN,
    ORANGE,
    RED,
    across_of,
    canvas,
    draw_over,
    edges_of,
    in_order,
)
from puck_tables.plot.titles import legend_below, noted, titled
from puck_tables.scene.run import CARRIED_ROUND, ENDS
from puck_tables.world.map import Map

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_MAPS = {
    "end_time": "end time / s",
    "x": "end x / m",
    "y": "end y / m",
    "orientation": "orientation at the end / rad",
    "heat_dry": "heat of dry friction / J",
    "impacts": "impacts",
}
_PANELS = 5  # of these, beside how it ends
_LOOKS = (
    (BLUE, "o"), (GREEN, "^"), ("#6f9a25", "o"), (ORANGE, "D"), (RED, "v"), ("#1b4f9c", "v"),
    ("#555555", "x"), ("#8b2fa0", "x"), ("black", "x"), ("#119eae", "x"), ("#c2185b", "x"),
    ("#7a4b2a", "x"), ("#3f51b5", "x"), ("#a8840f", "x"), ("#939393", "x"),
)  # fmt: skip
_HATCH = "///"
_MARKS = 40  # of one kind on a curve: more of them hide it
_LEGEND_ROW = 5  # entries


def draw(stops: Map) -> Figure:
    """Maps when two numbers range, curves when one does or has few values.

    The last panel says how each run ends, by colour, and so do the marks on curves; a run without
    an end has no other values.  With more than two ranges, the maps are drawn at the middle of the
    first ones.
    """
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    figure = canvas(12.0, 7.6)
    panels = figure.subplots(2, 3, sharex=True)
    place, at = _middle(stops)
    shown = [name for name in _MAPS if name in stops.columns][:_PANELS]
    columns = [stops.columns[name][place] for name in shown]
    axes, (end, *columns) = in_order(_last_two(stops), stops.end[place], *columns)
    labels = {name: _label(stops, name) for name in axes}
    for panel, name, values in zip(panels.flat, shown, columns, strict=False):
        draw_over(panel, axes, labels, values, _MAPS[name])
        if panel.lines:
            _mark_ends(panel, axes, values, end)
        else:
            _hatch(panel, axes, end)
    handles, words = panels.flat[0].get_legend_handles_labels()
    _draw_ends(panels.flat[_PANELS], axes, labels, end)
    for code in np.unique(end).tolist():
        color, marker = _LOOKS[code]
        handles.append(Line2D([], [], color=color, marker=marker, linestyle=""))
        words.append(ENDS[code])
    if not panels.flat[0].lines and (end > CARRIED_ROUND).any():
        handles.append(Patch(facecolor="white", edgecolor="black", hatch=_HATCH))
        words.append("not at rest at the end")
    legend_below(figure, _LEGEND_ROW, shown=(handles, words))
    titled(figure, stops.title + (f" at {at}" if at else ""))
    return figure


def draw_on(axes: Axes, stops: Map) -> None:
    """How each run ends, by colour; with more than two ranges at the middle of the first ones."""
    place, at = _middle(stops)
    ranged, (end,) = in_order(_last_two(stops), stops.end[place])
    _draw_ends(axes, ranged, {name: _label(stops, name) for name in ranged}, end)
    if at:
        noted(axes, f"at {at}")


def _middle(stops: Map) -> tuple[tuple[int, ...], str]:
    """Where all ranges but the last two are held, and that in words."""
    fixed = {name: stops.axes[name].size // 2 for name in list(stops.axes)[:-2]}
    words = (
        f"{name} = {stops.axes[name][n]:g} {stops.scene.unit_of(name)}".rstrip()
        + f" (one of {stops.axes[name].size})"
        for name, n in fixed.items()
    )
    return tuple(fixed.values()), ", ".join(words)


def _last_two(stops: Map) -> dict[str, Any]:
    return {name: stops.axes[name] for name in list(stops.axes)[-2:]}


def _label(stops: Map, name: str) -> str:
    unit = stops.scene.unit_of(name)
    return f"{name} / {unit}" if unit else name


def _mark_ends(
    panel: Axes, axes: Mapping[str, Any], values: Any, end: npt.NDArray[np.int8]
) -> None:
    """Marks on curves that say how each run ends; of many runs that end alike not on each."""
    along = list(axes).index(across_of(axes))
    places = np.meshgrid(*axes.values(), indexing="ij")[along]
    each = -(-end.shape[along] // _MARKS)
    for line in panel.lines:
        line.set_marker("")
    for code in np.unique(end).tolist():
        color, marker = _LOOKS[code]
        mine = end == code
        mine &= np.cumsum(mine, axis=along) % each == 1 % each
        panel.plot(
            places[mine], values[mine], color=color, marker=marker, markersize=4, linestyle="",
            zorder=3,
        )  # fmt: skip


def _hatch(panel: Axes, axes: Mapping[str, Any], end: npt.NDArray[np.int8]) -> None:
    """Hatch what is no rest on a map."""
    rows, columns = axes.values()
    moving = (end > CARRIED_ROUND).astype(np.float64)
    if moving.any():
        panel.contourf(columns, rows, moving, levels=[0.5, 1.5], colors="none", hatches=[_HATCH])


def _draw_ends(
    panel: Axes, axes: Mapping[str, Any], labels: Mapping[str, str], end: npt.NDArray[np.int8]
) -> None:
    """How each run ends: a patch of colour for it, over one axis or two."""
    from matplotlib.colors import ListedColormap

    names = list(axes)
    if names[-1] != across_of(axes):  # as in the panel above
        names, end = names[::-1], end.T
    rows, codes = (axes[names[0]], end) if len(names) == 2 else (np.zeros(1), end[None])
    panel.pcolormesh(
        edges_of(axes[names[-1]]), edges_of(rows), codes, rasterized=True,
        cmap=ListedColormap([color for color, _ in _LOOKS]), vmin=-0.5, vmax=len(_LOOKS) - 0.5,
    )  # fmt: skip
    panel.set_title("how it ends", fontsize=10)
    panel.set_xlabel(labels[names[-1]])
    if len(names) == 2:
        panel.set_ylabel(labels[names[0]])
    else:
        panel.set_yticks([])

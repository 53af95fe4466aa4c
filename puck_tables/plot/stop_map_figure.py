"""Picture of a sweep: where and when launches stop, over what was ranged."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from puck_tables.errors import InputError
from puck_tables.io.columns import COLUMNS
from puck_tables.plot.style import FEW, canvas, draw_over, in_order
from puck_tables.plot.titles import legend_below, noted, titled
from puck_tables.stopping.population import StopMap

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw(stops: StopMap) -> Figure:
    """Maps when two quantities are ranged, curves when one is or one has few values.

    With more ranged quantities the maps are drawn at the middle values of the first ones.
    """
    axes, fixed, left_out, place = _sections(stops)
    figure = canvas(11.0, 6.8)
    panels = figure.subplots(2, 3, sharex=True)
    for panel, name in zip(panels.flat, stops.outputs, strict=False):
        _draw(panel, stops, axes, name, place)
    for n, panel in enumerate(panels.flat[len(stops.outputs) :], start=len(stops.outputs)):
        panel.set_visible(False)
        panels.flat[n - 3].tick_params(labelbottom=True)
    legend_below(figure, FEW)
    base = stops.dataset().attributes.get("base")
    on = f", base {base}" if base else ""
    titled(figure, _fixed_title(fixed) + on + (f" ({left_out})" if left_out else ""))
    return figure


def draw_on(panel: Axes, stops: StopMap) -> None:
    """The stop time alone."""
    axes, _, left_out, place = _sections(stops)
    _draw(panel, stops, axes, "stop_time", place)
    if left_out:
        noted(panel, left_out)


def _draw(
    panel: Axes, stops: StopMap, axes: dict[str, Any], name: str, place: tuple[int, ...]
) -> None:
    """One column over the axes; pressure laws by their names, not by their numbers."""
    labels = {axis: COLUMNS[axis].axis if axis in COLUMNS else axis for axis in axes}
    ordered, (values,) = in_order(axes, getattr(stops, name)[place])
    draw_over(panel, ordered, labels, values, COLUMNS[name].axis)
    what = COLUMNS["pressure"].axis
    for line in panel.lines:
        for number, law in enumerate(stops.laws):
            if line.get_label() == f"{what}: {number}":
                line.set_label(law)
    for axis in (panel.xaxis, panel.yaxis):
        if axis.get_label_text() == what:
            axis.set_ticks(range(len(stops.laws)), labels=list(stops.laws))


def _sections(stops: StopMap) -> tuple[dict[str, Any], dict[str, float], str, tuple[int, ...]]:
    """At most two of the axes, what is fixed then, in words, and where."""
    sizes = dict(zip(stops.dims, stops.status.shape, strict=True))
    axes = {dim: stops.axes.get(dim, np.arange(float(n))) for dim, n in sizes.items()}
    fixed = dict(stops.fixed)
    if not axes:
        raise InputError("there is nothing to draw: range at least one of spin, speed, delta")
    place, words = [], []
    for name in list(axes)[:-2]:
        middle = axes[name].size // 2
        place.append(middle)
        fixed[name] = float(axes[name][middle])
        words.append(f"one of {axes[name].size} values of {name}")
        if name == "pressure":
            words[-1] += f", {stops.laws[middle]}"
        del axes[name]
    return axes, fixed, "; ".join(words), tuple(place)


def _fixed_title(fixed: dict[str, float]) -> str:
    short = {"decel": "fg", "radius": "r", "delta": "δ", "height": "h", "friction": "f",
             "gravity": "g", "gyration": "k/r", "launch_speed": "v₀", "launch_spin": "ω₀",
             "launch_heading": "heading"}  # fmt: skip
    parts = []
    if "launch_vx" in fixed and "launch_vy" in fixed:
        parts.append(f"v₀ = ({fixed['launch_vx']:g}, {fixed['launch_vy']:g}) m/s")
    for name, value in fixed.items():
        if name in short:
            unit = COLUMNS[name].unit.replace("^2", "²")
            parts.append(f"{short[name]} = {value:.4g}" + ("" if unit == "1" else f" {unit}"))
    return "stops at " + ", ".join(parts)

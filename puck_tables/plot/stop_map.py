"""Picture of a sweep: where and when launches stop, over what was ranged."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from puck_tables.errors import InputError
from puck_tables.io.columns import COLUMNS
from puck_tables.plot.style import FEW, canvas, draw_over, titled
from puck_tables.stopping.solvers import OUTPUTS
from puck_tables.stopping.sweep import StopMap

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw(stops: StopMap) -> Figure:
    """Maps when two quantities are ranged, curves when one is or one has few values.

    With three ranged quantities the maps are drawn at the middle value of the first.
    """
    axes, fixed, left_out, place = _sections(stops)
    figure = canvas(11.0, 6.8)
    panels = figure.subplots(2, 3, sharex=True)
    labels = {name: COLUMNS[name].axis for name in axes}
    for panel, name in zip(panels.flat, OUTPUTS, strict=True):
        draw_over(figure, panel, axes, labels, getattr(stops, name)[place], COLUMNS[name].axis)
    if any(panel.get_legend_handles_labels()[1] for panel in panels.flat):
        handles, words = panels.flat[0].get_legend_handles_labels()
        figure.legend(handles, words, loc="outside lower center", ncols=FEW, frameon=False)
    titled(figure, _fixed_title(fixed) + left_out)
    return figure


def draw_on(panel: Axes, stops: StopMap) -> None:
    """The stop time alone."""
    axes, _, _, place = _sections(stops)
    figure = panel.get_figure(root=True)
    assert figure is not None
    labels = {name: COLUMNS[name].axis for name in axes}
    draw_over(figure, panel, axes, labels, stops.stop_time[place], COLUMNS["stop_time"].axis)


def _sections(
    stops: StopMap,
) -> tuple[dict[str, Any], dict[str, float], str, tuple[int, ...]]:
    """At most two of the axes, what is fixed then, in words, and where.

    Raises
    ------
    InputError
        If nothing is ranged.
    """
    axes, fixed = dict(stops.axes), dict(stops.fixed)
    if not axes:
        raise InputError("there is nothing to draw: range at least one of spin, speed, delta")
    if len(axes) < 3:
        return axes, fixed, "", ()
    name, nodes = next(iter(axes.items()))
    middle = nodes.size // 2
    fixed[name] = float(nodes[middle])
    return axes, fixed, f" (one of {axes.pop(name).size} values of {name})", (middle,)


def _fixed_title(fixed: dict[str, float]) -> str:
    units = {"decel": ("J", " m/s²"), "radius": ("r", " m"), "delta": ("δ", ""),
             "launch_speed": ("v₀", " m/s"), "launch_spin": ("ω₀", " rad/s")}  # fmt: skip
    parts = []
    if "launch_vx" in fixed:
        parts.append(f"v₀ = ({fixed['launch_vx']:g}, {fixed['launch_vy']:g}) m/s")
    parts += [f"{units[n][0]} = {v:.4g}{units[n][1]}" for n, v in fixed.items() if n in units]
    return "stops at " + ", ".join(parts)

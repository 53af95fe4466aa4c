"""Picture of a run: of one puck its plane, speeds and energies; of several all their ways."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from puck_tables.plot import pucks_figure
from puck_tables.plot.animation import states_drawn
from puck_tables.plot.plane_panel import draw_plane
from puck_tables.plot.style import BLUE, GREEN, GREY, ORANGE, RED, canvas
from puck_tables.plot.titles import legend_below, noted, titled
from puck_tables.scene.run import Run

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

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


def draw(run: Run) -> Figure:
    """The whole motion, with every event, whatever states the run has: it is run again.

    Of one puck the path among all that is in the plane; speeds; and the energy ledger.
    """
    if run.scene.pucks:
        return pucks_figure.draw(run)
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
        pucks_figure.draw_on(axes, run)
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

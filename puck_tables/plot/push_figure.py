"""The picture of a push: outlines of the puck on its way, the finger or fence, its force."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from puck_tables.plot.base_outlines import outline_of, placed
from puck_tables.plot.style import BLUE, GREY, ORANGE, canvas, labelled
from puck_tables.plot.titles import legend_below, titled
from puck_tables.wrench.push import Push

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_DRAWN = 7  # outlines: more run into each other
_LENGTH = 0.5  # of the reach: of the arrow of a force f m g


def draw(run: Push) -> Figure:
    """The way of the puck; velocity, spin and force over time."""
    figure = canvas(10.5, 4.8)
    left, right = figure.subplots(1, 2, width_ratios=(1.4, 1.0))
    draw_on(left, run)
    right.plot(run.time, run.speed, color=BLUE, label="speed / (m/s)")
    right.plot(run.time, run.puck.radius * run.spin, color=ORANGE,
               label="rω / (m/s), r of the farthest point")  # fmt: skip
    labelled(right, "time / s", "")
    legend_below(right)
    force = np.hypot(run.push_x, run.push_y)
    titled(figure, f"{run.contact[0]} at first; force {force.min():.3g} to {force.max():.3g} N")
    return figure


def draw_on(axes: Axes, run: Push) -> None:
    """The way of the puck alone."""
    unit = run.puck.friction * run.puck.mass * run.puck.gravity
    chosen = np.unique(np.linspace(0, run.time.size - 1, _DRAWN).round().astype(int))
    for n in chosen.tolist():
        there = run.x[n], run.y[n], run.orientation[n]
        for part in placed(outline_of(run.puck), *there):
            closed = np.append(part, part[:1], axis=0)
            axes.plot(*closed.T, color=BLUE if n == chosen[-1] else GREY)
        if run.fence is not None:
            face = np.array([-np.sin(run.fence.facing), np.cos(run.fence.facing)])
            half = min(0.5 * run.fence.width, 1.5 * run.puck.radius)
            place = np.array([run.fence_x[n], run.fence_y[n]])
            axes.plot(*(np.outer([-half, half], face) + place).T, color=ORANGE, linewidth=1.4)
    axes.plot(run.x, run.y, color=BLUE, linewidth=0.9, label="centre of mass")
    axes.plot(run.finger_x, run.finger_y, color=ORANGE, marker="o", markevery=chosen.tolist(),
              label="where it is pushed")  # fmt: skip
    axes.quiver(
        run.finger_x[chosen], run.finger_y[chosen], run.push_x[chosen], run.push_y[chosen],
        color=ORANGE, angles="xy", scale_units="xy", scale=unit / (_LENGTH * run.puck.radius),
        width=0.004, label="its force",
    )  # fmt: skip
    axes.set_aspect("equal", adjustable="datalim")
    axes.set(xlabel="x / m", ylabel="y / m")
    legend_below(axes)

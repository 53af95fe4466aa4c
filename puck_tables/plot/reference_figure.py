"""Picture of a case: the plane, the path, speed and rim, their ratio, and what the floor feels."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from puck_tables.plot import run_figure
from puck_tables.plot.style import (
    BLUE,
    COLORS,
    GREEN,
    GREY,
    LAUNCH,
    ORANGE,
    STOP,
    canvas,
    labelled,
    no_rounding,
)
from puck_tables.plot.titles import noted, titled
from puck_tables.reference.answer import Answer

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_POINTS = 400  # points of a curve
_DOTS = 200  # states asked for: more would be one line


def draw(answer: Answer) -> Figure:
    """The plane to scale; the path stretched; v and rω, their ratio, and forces over time."""
    figure = canvas(10.0, 11.0)
    grid = figure.add_gridspec(3, 2, height_ratios=(1.25, 1.0, 1.0))
    draw_on(figure.add_subplot(grid[0, :]), answer)
    panels = [figure.add_subplot(grid[n]) for n in ((1, 0), (1, 1), (2, 0), (2, 1))]
    whole = answer(np.linspace(0.0, answer.end_time, _POINTS))
    _draw_path(panels[0], answer, whole)
    radii = [puck.radius for puck in answer.pucks]
    for n, (radius, style) in enumerate(zip(radii, ("-", "--", ":") * len(radii), strict=False)):
        name = f" ({answer.names[n]})" if answer.names else ""

        def of(column: str, n: int = n) -> np.ndarray:
            row = np.asarray(getattr(whole, column))
            return row[:, n] if answer.names else row

        speed, rim = np.hypot(of("vx"), of("vy")), radius * of("spin")
        panels[1].plot(whole.time, speed, style, color=BLUE, label=f"v{name}")
        panels[1].plot(whole.time, rim, style, color=ORANGE, label=f"rω{name}")
        panels[2].plot(whole.time, of("epsilon"), style, color=BLUE, label=f"v/(rω){name}")
        force = np.hypot(of("floor_fx"), of("floor_fy"))
        panels[3].plot(whole.time, force, style, color=BLUE, label=f"force / N{name}")
        turn = of("floor_torque") / radius
        panels[3].plot(whole.time, turn, style, color=ORANGE, label=f"torque / r / N{name}")
    if answer.limit_epsilon is not None:
        panels[2].axhline(answer.limit_epsilon, color=GREY, linewidth=0.8, label="its limit")
    _tame(panels[2], whole.epsilon)
    words = ("v, rω / m/s", "ε = v/(rω)", "on the floor / N")
    for panel, what in zip(panels[1:], words, strict=True):
        labelled(panel, "time / s", what)
        panel.legend(frameon=False, fontsize=8)
    titled(figure, f"{answer.case.label}: {answer.case.title}")
    return figure


def _tame(panel: Axes, epsilon: np.ndarray) -> None:
    """No zoom out to a ratio that grows without bound."""
    finite = epsilon[np.isfinite(epsilon)]
    if finite.size and finite.max() > 20.0 * max(float(np.median(finite)), 1e-3):
        panel.set_ylim(0.0, 5.0 * float(np.median(finite)) or 1.0)
        noted(panel, f"it goes up to {finite.max():.3g}")


def draw_on(axes: Axes, answer: Answer) -> None:
    """The plane to scale: floor and walls, the pucks, and their ways."""
    run_figure.draw_on(axes, answer.run)


def _draw_path(axes: Axes, answer: Answer, whole: Answer) -> None:
    """The path with the states asked for, as wide and as high as there is room: bends are seen."""
    for n, puck in enumerate(answer.pucks):
        x, y, px, py = (
            np.asarray(row)[:, n] if answer.names else row
            for row in (whole.x, whole.y, answer.x, answer.y)
        )
        colour = puck.colour or COLORS[n % len(COLORS)]
        axes.plot(x, y, color=colour, label=answer.names[n] if answer.names else None)
        if answer.time.size <= _DOTS:
            axes.plot(px, py, ".", color=colour if answer.names else GREEN, markersize=4)
        axes.plot(x[0], y[0], **LAUNCH)
        axes.plot(x[-1], y[-1], **STOP)
    no_rounding(axes)
    labelled(axes, "x / m", "y / m")
    axes.set_title("path, not to scale", fontsize=10)
    if answer.names:
        axes.legend(frameon=False, fontsize=8)

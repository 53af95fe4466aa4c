"""Picture of an aim: all its launches, on their way to one place."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from puck_tables.errors import InputError
from puck_tables.io.columns import COLUMNS
from puck_tables.plot.style import BLUE, GREY, LAUNCH, ORANGE, canvas, colour_bar
from puck_tables.plot.titles import titled
from puck_tables.stopping.aim_at_targets import Aim
from puck_tables.stopping.states import states as states_at

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.cm import ScalarMappable
    from matplotlib.figure import Figure

    from puck_tables.motion.puck_spec import PuckSpec


def draw(result: Aim) -> Figure:
    """The paths of launches to their target, and their speeds against their spins."""
    figure = canvas(10.0, 4.4)
    paths, launches = figure.subplots(1, 2, width_ratios=(1.7, 1.0))
    colours = draw_on(paths, result)
    for sense in (result.launch_spin <= 0.0, result.launch_spin >= 0.0):
        line = result.launch_spin[sense], result.launch_speed[sense]
        launches.plot(*line, color=GREY, linewidth=0.8, zorder=1)
    launches.scatter(
        result.launch_spin, result.launch_speed, c=colours.to_rgba(result.launch_spin), zorder=2
    )
    x, y = result.target
    caption(figure, launches, result.puck, f"launches that stop at ({x:g}, {y:g}) m")
    return figure


def caption(figure: Figure, launches: Axes, puck: PuckSpec, answer: str) -> None:
    """Label the panel of speeds against spins, and say above all what is drawn, of which puck."""
    launches.set(xlabel=COLUMNS["launch_spin"].axis, ylabel=COLUMNS["launch_speed"].axis)
    launches.set_ylim(bottom=0.0)
    words = (
        f"{answer}: r = {puck.radius:g} m, δ = 2fh/r = {puck.delta:.4g}, fg = {puck.decel:.4g} m/s²"
    )
    titled(figure, words)


def draw_on(paths: Axes, result: Aim) -> ScalarMappable:
    """The paths alone, coloured by spin; the colours."""
    if result.launch_spin.size == 0:
        raise InputError(f"there is nothing to draw: {result.answer}")
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import LinearSegmentedColormap, Normalize

    largest = float(np.abs(result.launch_spin).max()) or 1.0
    ramp = LinearSegmentedColormap.from_list("spin", [BLUE, "#303030", ORANGE])
    colours = ScalarMappable(Normalize(-largest, largest), ramp)
    shares = np.linspace(0.0, 1.0, 200)
    states = states_at(
        result.launch_velocity[:, None, :], result.launch_spin[:, None],
        result.stop_time[:, None] * shares, **result.puck.arguments(),
    )  # fmt: skip
    for n, spin in enumerate(result.launch_spin):
        paths.plot(states.x[n], states.y[n], color=colours.to_rgba(spin), linewidth=1.3)
    paths.plot(0.0, 0.0, **LAUNCH)
    paths.plot(*result.target, "x", color="black", markersize=8, markeredgewidth=1.8, zorder=5)
    x, y = result.target.tolist()
    outwards = 1 if x >= 0.0 else -1  # labels stand clear of the paths
    for text, place, side in (("launch", (0.0, 0.0), -outwards), ("target", (x, y), outwards)):
        paths.annotate(
            text, place, xytext=(9 * side, -3), textcoords="offset points", fontsize=9,
            ha="left" if side > 0 else "right",
        )  # fmt: skip
    paths.set(xlabel="x / m", ylabel="y / m (not to scale)")
    paths.margins(0.18, 0.2)
    colour_bar(paths, colours, COLUMNS["launch_spin"].axis)
    return colours

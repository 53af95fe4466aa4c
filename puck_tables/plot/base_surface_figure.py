"""The picture of the limit surface of a base: its sections and those of its models."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.plot.style import COLORS, GREY, canvas, labelled
from puck_tables.plot.titles import legend_below, titled
from puck_tables.wrench.base_surface import BaseSurface
from puck_tables.wrench.friction_hold import holds

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_LEVELS = (0.0, 0.5, 0.75, 0.9)  # of the largest torque
_STYLES = ("-", "--", ":")  # of friction, ellipsoid and 4th order
_DIRECTIONS = 181  # of a section: every two degrees
_HALVES = 40  # of a force


def draw(surface: BaseSurface) -> Figure:
    """Forces at constant torques, and force against torque along two axes."""
    figure = canvas(10.5, 5.2)
    left, right = figure.subplots(1, 2)
    draw_on(left, surface)
    turn = np.linspace(-0.5 * np.pi, 0.5 * np.pi, _DIRECTIONS)
    torque = surface.puck.inertia_radius * np.sin(turn)
    for way, axis, color in ((0, "x", COLORS[0]), (1, "y", COLORS[2])):
        force = np.zeros((turn.size, 2))
        force[:, way] = np.cos(turn)
        for n, style in enumerate(_STYLES):
            size = _size(surface, force, torque, n)
            right.plot(
                size * force[:, way], size * torque, linestyle=style, color=color,
                label="" if n else f"force along {axis}",
            )  # fmt: skip
    labelled(right, "force F / N", "torque M / (N m)")
    right.legend(frameon=False)
    shape = surface.puck.shape
    titled(figure, f"limit surface of {shape.name if shape else ''}")
    return figure


def draw_on(axes: Axes, surface: BaseSurface) -> None:
    """The forces at constant torques alone."""
    turn = np.linspace(0.0, 2.0 * np.pi, _DIRECTIONS)
    directions = np.stack([np.cos(turn), np.sin(turn)], axis=-1)
    most = float(np.max(surface.torque))
    for style, name in zip(_STYLES, ("friction", "ellipsoid", "4th order"), strict=True):
        axes.plot([], [], linestyle=style, color=GREY, label=name)
    for level, color in zip(_LEVELS, COLORS, strict=False):
        for n, style in enumerate(_STYLES):
            force = _force_at(surface, directions, level * most, n)
            axes.plot(
                *(force[:, None] * directions).T, linestyle=style, color=color,
                label="" if n else f"M = {level * most:.3g} N m",
            )  # fmt: skip
    labelled(axes, "force F_x / N", "force F_y / N")
    axes.set_aspect("equal", adjustable="datalim")
    legend_below(axes, columns=4, down=0.11)


def _size(surface: BaseSurface, force: FloatArray, torque: FloatArray, n: int) -> FloatArray:
    if n == 0:
        return holds(surface.puck, force, torque, 0.0).margin
    return 1.0 / (surface.ellipsoid, surface.quartic)[n - 1].gauge(force, torque)


def _force_at(surface: BaseSurface, directions: FloatArray, torque: float, n: int) -> FloatArray:
    """The force in each direction with which a torque is just held; NaN where none is."""
    low, high = np.zeros(len(directions)), np.full(len(directions), 2.0 * surface.unit_force)
    turning = np.full(len(directions), torque)
    for _ in range(_HALVES):
        force = 0.5 * (low + high)
        held = _size(surface, force[:, None] * directions, turning, n) >= 1.0
        low, high = np.where(held, force, low), np.where(held, high, force)
    return np.where(low > 0.0, low, np.nan)

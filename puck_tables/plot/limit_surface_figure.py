"""The picture of a limit surface: sections through its axis, and the forces at constant torques."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.plot.style import COLORS, GREY, canvas, labelled
from puck_tables.plot.titles import legend_below, titled
from puck_tables.wrench.friction_hold import holds, slip_length
from puck_tables.wrench.surface import LimitSurface

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_LEVELS = (0.0, 0.5, 0.75, 0.9)  # of the largest torque
_STYLES = {"friction": "-", "ellipsoid": "--", "4th order": ":"}
_DIRECTIONS = 181  # of a section: every two degrees
_HALVES = 40  # of a force


def draw(surface: LimitSurface) -> Figure:
    """Force against torque, and forces at constant torques; of friction and of its models."""
    figure = canvas(10.5, 5.2)
    left, right = figure.subplots(1, 2)
    draw_on(left, surface)
    turn = np.linspace(0.0, 2.0 * np.pi, _DIRECTIONS)
    directions = np.stack([np.cos(turn), np.sin(turn)], axis=-1)
    most = float(np.max(surface.torque))
    for level, color in zip(_LEVELS, COLORS, strict=False):
        for n, style in enumerate(_STYLES.values()):
            force = _force_at(surface, directions, level * most, n)
            right.plot(
                *(force[:, None] * directions).T, linestyle=style, color=color,
                label="" if n else f"M = {level * most:.3g} N m",
            )  # fmt: skip
    labelled(right, "force F_x / N", "force F_y / N")
    right.set_aspect("equal", adjustable="datalim")
    legend_below(right, columns=4, down=0.11)
    puck = surface.puck
    kind = f"δ = {puck.delta:.4g}" if puck.shape is None else f"base {puck.shape.name}"
    more = f", {puck.body.kind}" if puck.shape is None and puck.body.kind else ""
    titled(figure, f"limit surface, {kind}{more}")
    return figure


def draw_on(axes: Axes, surface: LimitSurface) -> None:
    """Force against torque alone: of a round puck any force, of a base along its axes."""
    turn = np.linspace(-0.5 * np.pi, 0.5 * np.pi, _DIRECTIONS)
    torque = slip_length(surface.puck) * np.sin(turn)
    for name, style in _STYLES.items():
        axes.plot([], [], linestyle=style, color=GREY, label=name)
    for axis, color in ((0, COLORS[0]), (1, COLORS[2])):
        force = np.zeros((turn.size, 2))
        force[:, axis] = np.cos(turn)
        label = "" if surface.heading is None else f"force along {'xy'[axis]}"
        for n, style in enumerate(_STYLES.values()):
            size = _size(surface, force, torque, n)
            axes.plot(
                size * force[:, axis], size * torque, linestyle=style, color=color,
                label="" if n else label,
            )  # fmt: skip
        if surface.heading is None:
            break
    labelled(axes, "force F / N", "torque M / (N m)")
    axes.legend(frameon=False)


def _size(surface: LimitSurface, force: FloatArray, torque: FloatArray, n: int) -> FloatArray:
    """By what wrenches may be multiplied, by friction or a model of it."""
    if n > 0:
        return 1.0 / (surface.ellipsoid, surface.quartic)[n - 1].gauge(force, torque)
    if surface.heading is not None:
        return holds(surface.puck, force, torque, 0.0).margin
    length, wanted = surface.puck.radius, np.hypot(force[:, 0], force[:, 1])
    there = np.arctan2(surface.torque / length, surface.force)
    reach = np.hypot(surface.torque / length, surface.force)
    size = np.interp(np.arctan2(torque / length, wanted), there, reach)
    return np.asarray(size / np.hypot(torque / length, wanted))


def _force_at(surface: LimitSurface, directions: FloatArray, torque: float, n: int) -> FloatArray:
    """The force in each direction with which a torque is just held; NaN where none is."""
    low, high = np.zeros(len(directions)), np.full(len(directions), 2.0 * surface.unit_force)
    turning = np.full(len(directions), torque)
    for _ in range(_HALVES):
        force = 0.5 * (low + high)
        held = _size(surface, force[:, None] * directions, turning, n) >= 1.0
        low, high = np.where(held, force, low), np.where(held, high, force)
    return np.where(low > 0.0, low, np.nan)

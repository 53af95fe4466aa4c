"""The picture of a limit surface: its section, the models, the twists; and how far they are off."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.plot.style import COLORS, GREY, canvas, labelled
from puck_tables.plot.titles import legend_below, titled
from puck_tables.wrench.models import SurfaceModel
from puck_tables.wrench.surface import LimitSurface

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_ARROWS = 13  # along the curve: more run into each other


def draw(surface: LimitSurface) -> Figure:
    """The section with normals and twists, and the errors of the models over the slip angle."""
    figure = canvas(10.5, 4.8)
    left, right = figure.subplots(1, 2, width_ratios=(1.0, 1.15))
    draw_on(left, surface)
    degrees = np.degrees(surface.slip_angle)
    models = ((surface.ellipsoid, "ellipsoid"), (surface.quartic, "4th order"))
    for number, (model, name) in enumerate(models, start=1):
        off = 100.0 * (1.0 / model.gauge(surface.force, surface.torque) - 1.0)
        right.plot(degrees, off, color=COLORS[number], label=name)
    right.axhline(0.0, color=GREY, linewidth=0.8)
    labelled(right, "slip angle φ = atan2(rω, v) / °", "model − law / % of the wrench")
    right.set_xticks(range(-90, 91, 30))
    right.legend(frameon=False)
    puck = surface.puck
    kind = f", {puck.body.kind}" if puck.body.kind else ""
    titled(figure, f"limit surface, δ = {puck.delta:.4g}{kind}")
    return figure


def draw_on(axes: Axes, surface: LimitSurface) -> None:
    """The section alone."""
    force, torque = surface.force, surface.torque
    axes.plot(force, torque, color=COLORS[0], linewidth=2.0, label="friction of the law")
    for number, model in enumerate((surface.ellipsoid, surface.quartic), start=1):
        axes.plot(*_section(model), color=COLORS[number], linestyle="--", linewidth=1.2,
                  label=("ellipsoid", "4th order")[number - 1])  # fmt: skip
    picked = np.linspace(0, force.size - 1, _ARROWS).round().astype(int)
    unit, radius = surface.unit_force, surface.puck.radius
    phi = surface.slip_angle[picked]
    normals = surface.normal_force[picked], surface.normal_torque[picked]
    for x, y, label, color, width in (
        (np.cos(phi), np.sin(phi), "twist (v, rω)", GREY, 0.012),
        (*normals, "normal", COLORS[0], 0.004),
    ):
        axes.quiver(
            force[picked], torque[picked], x, y, color=color, angles="uv", scale=9.0, width=width,
            label=label,
        )  # fmt: skip
    axes.set(xlabel="force |F| / N", ylabel="torque M / (N m)")
    axes.set_xlim(-0.04 * unit, 1.4 * unit)
    reach = 1.35 * float(np.max(torque))
    axes.set_ylim(-reach, reach)
    axes.set_aspect(1.0 / radius, adjustable="box")
    axes.grid(color="#e4e4e4", linewidth=0.6)
    legend_below(axes, down=0.12)


def _section(model: SurfaceModel) -> tuple[FloatArray, FloatArray]:
    """The curve on which a model's gauge is 1."""
    angle = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 361)
    force, torque = model.a * np.cos(angle), model.b * np.sin(angle)
    size = model.gauge(force, torque)
    return force / size, torque / size

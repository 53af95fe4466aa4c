"""Picture of force and torque on the floor over ε = v/(rω)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from puck_tables.plot.style import BLUE, GREEN, ORANGE, canvas, labelled
from puck_tables.plot.titles import noted, titled
from puck_tables.reference.floor_reaction import FloorFriction

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw(friction: FloorFriction) -> Figure:
    """Shares of fN and fNr over ε."""
    figure = canvas(7.0, 4.6)
    draw_on(figure.add_subplot(), friction)
    titled(figure, f"{friction.case.label}: on the floor")
    return figure


def draw_on(axes: Axes, friction: FloorFriction) -> None:
    """Shares of fN and fNr over ε on given axes."""
    order = np.argsort(friction.epsilon)
    shown = order[(friction.epsilon[order] > 0.0) & np.isfinite(friction.epsilon[order])]
    for name, colour, label in (
        ("share_along", BLUE, "F∥/(fN)"), ("share_across", GREEN, "F⊥/(fN)"),
        ("share_torque", ORANGE, "M/(fNr)"),
    ):  # fmt: skip
        row = getattr(friction, name)[shown]
        axes.plot(friction.epsilon[shown], row, color=colour, label=label,
                  marker="." if shown.size < 30 else "")  # fmt: skip
    axes.set_xscale("log")
    labelled(axes, "ε = v/(rω)", "")
    if shown.size < order.size:  # the axis is logarithmic
        noted(axes, f"{order.size - shown.size} of {order.size} without slide or without spin")
    axes.legend(frameon=False)

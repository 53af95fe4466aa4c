"""Picture of a forecast: how well a film would tell the friction, over speed and spin."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from puck_tables.fitting.forecast import Forecast
from puck_tables.plot.style import LAUNCH, NO_VALUE, canvas, colour_bar
from puck_tables.plot.titles import titled

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_SPEEDS, _SPINS = 9, 13  # launches along both axes: as many as cells can hold a number
_ACROSS = 3  # panels in a row
_WIDEST = 2.0  # times the launch's own
_RIM = 3.0  # rω/v at the end of the spins, at least


def draw(result: Forecast) -> Figure:
    """Maps of the standard errors of all numbers."""
    across = min(len(result.free), _ACROSS)
    down = -(-len(result.free) // across)
    figure = canvas(5.2 * across + 0.6, 4.0 * down + 0.4)
    for n, name in enumerate(result.free, start=1):
        _draw_map(figure.add_subplot(down, across, n), result, name)
    camera = result.camera
    marks = "no angle marks" if camera.angle_noise is None else f"{1e3 * camera.angle_noise:g} mrad"
    titled(
        figure, f"{camera.fps:g} frames a second, {1e3 * camera.place_noise:g} mm, {marks}: "
        + ", ".join(f"{name} ± {result[name]:.2g}" for name in result.free),
    )  # fmt: skip
    return figure


def draw_on(panel: Axes, result: Forecast) -> None:
    """The map of the first number alone."""
    _draw_map(panel, result, result.free[0])


def _draw_map(panel: Axes, result: Forecast, name: str) -> None:
    from matplotlib.colors import LogNorm

    speed = float(np.hypot(*result.velocity))
    largest_speed = _WIDEST * max(speed, result.puck.radius * abs(result.spin))
    largest_spin = max(_WIDEST * abs(result.spin), _RIM * speed / result.puck.radius)
    speeds = np.linspace(0.1, 1.0, _SPEEDS) * largest_speed
    spins = np.linspace(0.0, largest_spin, _SPINS)
    errors = result.over(speeds, spins, name)
    shown = np.where(np.isfinite(errors), errors, np.nan)
    if np.isfinite(shown).any():
        norm = LogNorm(float(np.nanmin(shown)), float(np.nanmax(shown)))
        mesh = panel.pcolormesh(
            spins, speeds, shown, norm=norm, shading="nearest", cmap="viridis_r", rasterized=True
        )
        colour_bar(panel, mesh, f"standard error of {name}")
    panel.set_facecolor(NO_VALUE)
    panel.plot(abs(result.spin), speed, **LAUNCH)
    panel.set(xlabel="launch spin / rad/s", ylabel="launch speed / m/s",
              title=f"{name}; grey: not determined")  # fmt: skip

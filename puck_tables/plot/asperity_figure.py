"""The picture of friction from asperities: greatest and mean force against speed, and landings."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from puck_tables.chetaev.asperity_forces import LEAP, AsperityCurve
from puck_tables.plot.panels import Panel, Picture, PlotCurve, draw_panel
from puck_tables.plot.panels import draw as panels_drawn

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw(curve: AsperityCurve) -> Figure:
    """Greatest force, mean force and phase of landing against the speed."""
    support = curve.asperity
    title = (
        f"a = {support.amplitude:.4g} m, 2πb = {2.0 * np.pi * support.length:.4g} m, "
        f"|Y| = {support.load:.4g} N, m = {support.mass:.4g} kg: V₀ = {support.lift_speed:.4g} m/s"
    )
    return panels_drawn(Picture(title, _panels(curve), 3.4))


def draw_on(axes: Axes, curve: AsperityCurve) -> None:
    """The greatest force alone."""
    draw_panel(axes, _panels(curve)[0])


def _panels(curve: AsperityCurve) -> list[Panel]:
    support = curve.asperity
    scaled = curve.held_speed / support.lift_speed
    unit = support.load * support.slope
    coulomb = PlotCurve(scaled, curve.crude / unit, "Coulomb, |Y| a/b", dashed=True)
    across = "speed V/V₀  (above 1 the point leaves the crests)"
    return [
        Panel(across, "greatest force / (|Y| a/b)", [
            PlotCurve(scaled, curve.greatest / unit, "held speed:\n−Y + m(a/b²)V² cos θ", leap=1.0),
            PlotCurve(scaled, curve.undriven / unit, "not driven:\nexact λ", leap=1.0), coulomb,
        ], "greatest force in contact (none where the point only hops)"),
        Panel(across, "mean force / (|Y| a/b)", [
            PlotCurve(scaled, curve.mean / unit, "mean, with\nall landings", leap=LEAP), coulomb,
        ], "mean force: what landings lose; never above Coulomb's"),
        Panel(across, "landing θ₁ / rad", [
            PlotCurve(scaled, curve.landing_phase, "lands at θ₁,\nthen slides", leap=1.0),
            PlotCurve(scaled, steepest(scaled), "greatest force\non a rise, θ*", dashed=True),
        ], "on the next rise: trough 0, steepest slope π/2, crest π"),
    ]  # fmt: skip


def steepest(scaled: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """θ*: cos θ* = (√(1 + 8w²) − 1)/(4w), w = (V/V₀)²."""
    w = scaled**2
    return np.asarray(np.arccos(2.0 * w / (1.0 + np.sqrt(1.0 + 8.0 * w * w))))

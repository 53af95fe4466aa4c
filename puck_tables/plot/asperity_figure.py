"""The picture of friction from asperities: greatest and mean force against speed, and landings."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.chetaev.asperity_forces import LEAP, AsperityCurve
from puck_tables.plot.style import BLUE, GREY, ORANGE, canvas
from puck_tables.plot.titles import titled

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw(result: AsperityCurve) -> Figure:
    """Greatest force, mean force and phase of landing against the speed."""
    figure, support = canvas(8.6, 10.2), result.asperity
    greatest, mean, landing = figure.subplots(3, 1)
    draw_on(greatest, result)
    scaled = result.held_speed / support.lift_speed
    w = scaled**2
    steepest = np.arccos(2.0 * w / (1.0 + np.sqrt(1.0 + 8.0 * w * w)))  # cos θ* in one form of it
    _draw_force(mean, result, {"mean, with\nall landings": result.mean}, "mean force", LEAP)
    mean.set_title("mean force: what landings lose; never above Coulomb's", fontsize=10)
    _draw(landing, scaled, result.landing_phase, "lands at θ₁,\nthen slides", BLUE, 1.0)
    _for_reference(landing, scaled, steepest, "greatest force\non a rise, θ*")
    landing.set_title("on the next rise: trough 0, steepest slope π/2, crest π", fontsize=10)
    landing.set_ylabel("landing θ₁ / rad")
    titled(
        figure,
        f"a = {support.amplitude:.4g} m, 2πb = {2.0 * np.pi * support.length:.4g} m, "
        f"|Y| = {support.load:.4g} N, m = {support.mass:.4g} kg: V₀ = {support.lift_speed:.4g} m/s",
    )
    return figure


def draw_on(axes: Axes, result: AsperityCurve) -> None:
    """The greatest force alone."""
    series = {
        "held speed:\n−Y + m(a/b²)V² cos θ": result.greatest,
        "not driven:\nexact λ": result.undriven,
    }
    _draw_force(axes, result, series, "greatest force", 1.0)
    axes.set_title("greatest force in contact (none where the point only hops)", fontsize=10)


def _draw_force(
    axes: Axes, result: AsperityCurve, forces: dict[str, FloatArray], what: str, leap: float
) -> None:
    """Forces over Coulomb's, and that."""
    scaled = result.held_speed / result.asperity.lift_speed
    for (label, force), colour in zip(forces.items(), (BLUE, ORANGE), strict=False):
        _draw(axes, scaled, force / result.crude, label, colour, leap)
    _for_reference(axes, scaled, np.ones_like(scaled), "Coulomb, |Y| a/b")
    axes.set_ylabel(f"{what} / (|Y| a/b)")


def _draw(axes: Axes, x: FloatArray, y: FloatArray, label: str, colour: str, leap: float) -> None:
    """A curve; where neighbours differ by more than ``leap`` dots: a line would be made up."""
    leaps = np.flatnonzero(np.abs(np.diff(y)) > leap)
    ends = np.union1d(leaps, leaps + 1)
    broken = np.insert(x, leaps + 1, np.nan), np.insert(y, leaps + 1, np.nan)
    axes.plot(*broken, color=colour, linewidth=1.8, label=label)
    axes.plot(x[ends], y[ends], ".", color=colour, markersize=4)


def _for_reference(axes: Axes, x: FloatArray, y: FloatArray, label: str) -> None:
    """A thin grey curve, and what goes with the last of a panel."""
    axes.plot(x, y, "--", color=GREY, linewidth=1.2, label=label)
    axes.set_xlabel("speed V/V₀  (above 1 the point leaves the crests)")
    axes.margins(y=0.08)
    axes.grid(color="#e4e4e4", linewidth=0.6)
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)

"""The picture of friction from asperities: greatest and mean force against speed, and landings."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt

from puck_tables.chetaev.asperity_curve import LEAP, AsperityCurve
from puck_tables.panels import Curve, Panel, Picture, draw


def plot_asperity(curve: AsperityCurve, path: str | Path, overwrite: bool = False) -> None:
    """Draw greatest force, mean force and phase of landing against the speed.

    Parameters
    ----------
    curve : AsperityCurve
    path : .png, .svg or .pdf
    overwrite : whether an existing file may be replaced

    Raises
    ------
    InputError
        If the ending is not known.
    MissingExtraError
        If matplotlib is not installed.
    OutputError
        If the file exists or cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> from puck_tables import Asperity, asperity_curve
    >>> curve = asperity_curve(Asperity(1.0, 4.0, 1.0, 1.0), np.linspace(0.0, 9.0, 50))
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     plot_asperity(curve, folder + "/curve.png")
    """
    support = curve.asperity
    scaled = curve.speed / support.lift_speed
    unit = support.load * support.slope
    coulomb = Curve(scaled, curve.crude / unit, "Coulomb, |Y| a/b", dashed=True)
    across = "speed V/V₀  (above 1 the point leaves the crests)"
    panels = [
        Panel(across, "greatest force / (|Y| a/b)", [
            Curve(scaled, curve.greatest / unit, "held speed:\n−Y + m(a/b²)V² cos θ", leap=1.0),
            Curve(scaled, curve.undriven / unit, "not driven:\nexact λ", leap=1.0), coulomb,
        ], "greatest force in contact (none where the point only hops)"),
        Panel(across, "mean force / (|Y| a/b)", [
            Curve(scaled, curve.mean / unit, "mean, with\nall landings", leap=LEAP), coulomb,
        ], "mean force: what landings lose; never above Coulomb's"),
        Panel(across, "landing θ₁ / rad", [
            Curve(scaled, curve.landing_phase, "lands at θ₁,\nthen slides", leap=1.0),
            Curve(scaled, steepest(scaled), "greatest force\non a rise, θ*", dashed=True),
        ], "on the next rise: trough 0, steepest slope π/2, crest π"),
    ]  # fmt: skip
    title = (
        f"a = {support.amplitude:.4g} m, 2πb = {2.0 * np.pi * support.length:.4g} m, "
        f"|Y| = {support.load:.4g} N, m = {support.mass:.4g} kg: V₀ = {support.lift_speed:.4g} m/s"
    )
    draw(Picture(title, panels, 3.4), path, overwrite)


def steepest(scaled: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """θ*: cos θ* = (√(1 + 8w²) − 1)/(4w), w = (V/V₀)²."""
    w = scaled**2
    return np.asarray(np.arccos(2.0 * w / (1.0 + np.sqrt(1.0 + 8.0 * w * w))))

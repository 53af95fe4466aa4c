"""The figures of the paper, by numbers: known values stand where the curves pass."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from pucks import simulate
from reference import REFERENCE_RUNS

from paper import figures


def test_stops_of_figure_4_and_paths_of_figure_3():
    for delta in (0.0, 1.0):
        lines = figures.stops_against_spin(delta).panels[0].lines
        for spin in (1.0, 5.0):
            at = np.flatnonzero(lines[0].x == spin)[0]
            found = [float(curve.y[at]) for curve in lines]
            assert found == pytest.approx(REFERENCE_RUNS[delta, spin], abs=1e-10)
    spin_rich = figures.paths().panels[0].lines[-1]  # v = 5, ω = 25
    assert spin_rich.x[-1] == pytest.approx(25 * 2.257241156461, abs=1e-7)
    assert spin_rich.y[-1] == pytest.approx(-25 * 0.308477350409, abs=1e-7)
    labels = [curve.label[-3:] for curve in figures.paths().panels[0].lines]
    assert set(labels) == {"(B)", "(C)"}


def test_limit_angle_of_figure_2():
    curve = figures.limit_angles().panels[0].lines[0]
    at = {0.0: 0.992313778946643533, 0.5: 0.987079101411475736, 1.0: 0.975464553235532779}
    for delta, angle in at.items():
        assert curve.y[np.flatnonzero(curve.x == delta)[0]] == pytest.approx(angle, abs=1e-14)
    assert np.all(np.diff(curve.y) < 0.0)


@pytest.mark.parametrize(
    ("figure", "duration"), [(figures.steel_puck, 0.52), (figures.rubber_puck, 0.38)]
)
def test_ratios_of_figures_5_and_6(figure: Callable[[], Any], duration: float):
    *lines, limit = figure().panels[0].lines
    for curve in lines:
        assert curve.x[0] == 0.0
        assert duration * 0.9999 < curve.x[-1] < duration
        assert abs(curve.y[-1] / limit.y[0] - 1.0) < 0.01
        assert np.all(np.diff(np.abs(curve.y - limit.y[0])) < 0.0)
    # the launch that the label names stops when it should
    speed, spin = (float(part.split(" = ")[1].split()[0]) for part in lines[1].label.split(","))
    radius, height, f = (0.03, 0.019, 0.2) if duration == 0.52 else (0.037, 0.025, 0.6)
    run = simulate(
        (speed, 0.0), spin, radius=radius, delta=2 * f * height / radius, decel=f * 9.80665
    )
    assert run.stop_time == pytest.approx(duration, rel=0.03)


def test_surfaces_of_figures_7_to_10():
    at = lambda curve, phi: float(np.interp(phi, curve.x, curve.y))  # noqa: E731
    p = figures.patch_integrals().panels[0].lines
    ends_of = {"a": (1, 1), "b": (1 / 4, 1 / 3), "c": (0, -1 / 3), "d": (1 / 4, 2 / 3),
               "e": (-1 / 4, 0)}  # fmt: skip
    for curve, (first, last) in zip(p, ends_of.values(), strict=True):
        assert (at(curve, 0.0), at(curve, np.pi / 2)) == pytest.approx((first, last), abs=1e-14)
    reserve = figures.pressure_reserves().panels[0].lines
    along, spin = (panel.lines for panel in figures.friction_along_and_spin().panels)
    across = figures.friction_across().panels[0].lines
    for i, delta in enumerate(figures.FAMILY):
        assert at(reserve[i], 0.0) == pytest.approx(1.0 - delta**2, abs=1e-14)
        assert at(reserve[i], np.pi / 2) == pytest.approx((1.0 + delta**2 / 9) ** 2, abs=1e-14)
        assert at(along[i], np.pi / 2) == pytest.approx(9 / (9 + delta**2), abs=1e-14)
        assert at(spin[i], 0.0) == pytest.approx((4 - delta**2) / 8, abs=1e-14)
        assert at(across[i], 0.0) == pytest.approx(delta / 4, abs=1e-14)


def test_phase_portrait_of_figure_11():
    rate, grows, falls, attracts, repels = figures.phase_portrait().panels[0].lines
    for arrows, sign in ((grows, 1.0), (falls, -1.0)):
        assert np.all(sign * np.interp(arrows.x, rate.x, rate.y) > 0.0)
    for points, slope in ((attracts, -1.0), (repels, 1.0)):
        inside = np.clip(points.x, -1.57, 1.57)  # one-sided at ±π/2
        for x in inside:
            ahead, behind = np.interp([x + 0.01, x - 0.01], rate.x, rate.y)
            assert slope * (ahead - behind) > 0.0
    np.testing.assert_allclose(np.interp(attracts.x, rate.x, rate.y), 0.0, atol=1e-3)

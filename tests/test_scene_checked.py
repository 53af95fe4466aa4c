"""The error estimate of a map over a scene, against the same map at a much finer tolerance."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import puck_tables as pt
from puck_tables.world.prepare import STEP_SHARE, prepared

SPINS = list(np.linspace(-20.0, 20.0, 8))  # all of them are checked


def scene(tol: float) -> pt.Scene:
    return pt.Scene(
        pt.Puck(0.04, friction=0.1), pt.Floor(slope=0.05), pt.Launch((1.0, 0.3), spin=SPINS),
        walls=[pt.Wall((0.3, 0.0), normal=(-1.0, 0.0), restitution=0.6)], tol=tol,
    )  # fmt: skip


@pytest.mark.parametrize("tol", [1e-4, 1e-7])
def test_it_is_at_least_half_of_the_error_and_at_most_tol(tol: float) -> None:
    rough, fine = scene(tol).sweep(), scene(1e-12).sweep()
    alone = [scene(tol).at({"launch.spin": spin}).simulate([]) for spin in SPINS]
    unit = np.array([run.speed_scale / run.rate_scale for run in alone])
    speed = np.array([run.speed_scale for run in alone])
    late = np.abs(rough.end_time - fine.end_time) / unit
    far = np.hypot(rough.x - fine.x, rough.y - fine.y) / (speed * unit)
    assert 0.5 * max(late.max(), far.max()) <= rough.error_estimate <= tol
    assert rough.dataset().attributes["error_estimate"] == rough.error_estimate


def test_a_map_that_is_wrong_somewhere_is_seen() -> None:
    found = scene(1e-7).sweep()
    x = found.columns["x"].copy()
    x[3] += 1e-3
    wrong = replace(found, columns={**found.columns, "x": x})
    assert wrong.error_estimate > 1e-4


def test_of_no_run_with_an_end_there_is_none() -> None:
    found = scene(1e-7).sweep()
    wrong = replace(found, end=np.full_like(found.end, 7))
    assert math.isnan(wrong.error_estimate)


@pytest.mark.parametrize("slope", [0.0, 0.05])
def test_a_run_alone_is_done_once_and_its_estimate_holds(slope: float) -> None:
    """Looked up, or integrated: with finer steps only where check runs miss the default ``tol``."""
    rng = np.random.default_rng(31)
    for _ in range(8):
        puck = pt.Puck(0.04, height=float(rng.uniform(0.0, 0.1)), friction=0.2)
        launch = pt.Launch(tuple(rng.normal(size=2).tolist()), float(rng.normal() * 30.0))
        one = pt.Scene(puck, pt.Floor(slope=slope), launch)
        run, fine = one.simulate(), replace(one, tol=1e-12).simulate()
        assert "closer than" not in run.why
        far = math.hypot(run.last["x"] - fine.last["x"], run.last["y"] - fine.last["y"])
        late = abs(run.end_time - fine.end_time) * run.rate_scale / run.speed_scale
        error = max(far * run.rate_scale / run.speed_scale**2, late)
        assert error <= run.error_estimate <= one.tol


STRIPS = pt.Floor(strips=pt.Strips((0.1, 0.18, 0.21), (0.2, 0.05, 0.4, 0.1), direction=0.4))


def _ends(scene: pt.Scene, share: float) -> np.ndarray:
    """Place and turned rim at rest of a puck of 5 cm, in Q²/J, with steps of a share of ``tol``."""
    start = prepared(scene)
    start.engine.scale[2] *= share / STEP_SHARE
    world = pt.World.since(start)
    world.come_to_rest()
    speed, rate = start.engine.scale[:2]
    return world.state()[0, :3] * [1.0, 1.0, 0.05] * rate / speed**2


def test_steps_are_as_long_as_tol_allows() -> None:
    """No check run mends these: they keep ``tol``, and with steps of ten times the error do not."""
    rng, misses = np.random.default_rng(5), []
    for _ in range(24):
        launch = pt.Launch(tuple(rng.normal(size=2).tolist()), float(rng.normal() * 12.0))
        one = pt.Scene(pt.Puck(0.05, 0.03, 0.2), STRIPS, launch, tol=1e-6)
        true = _ends(replace(one, tol=1e-10), STEP_SHARE)
        misses.append([np.abs(_ends(one, k * STEP_SHARE) - true).max() / 1e-6 for k in (1, 10)])
    rough = np.max(misses, axis=0)
    assert rough[0] <= 1.0 < rough[1]


@pytest.mark.parametrize("tol", [1e-3, 1e-6, 1e-9])
@pytest.mark.parametrize("over", [1e-2, 1e-3, 1e-4])
def test_a_slip_that_hardly_begins_is_told(tol: float, over: float) -> None:
    """A force that passes what friction holds by so little, for a moment, as its rows go up."""
    hold = 0.2 * 9.80665
    rows = [[0, 0, 0, 0], [0.7, 0, 0, 0], [0.8, (1.0 + over) * hold, 0, 0], [0.9, 0, 0, 0]]
    puck, force = pt.Puck(0.1, friction=0.2, mass=1.0), pt.Force(over_time=rows)
    run = pt.Scene(puck, launch=pt.Launch((1.0, 0.0)), force=force, time=2.0, tol=tol).simulate()
    assert [event.what for event in run.events] == ["stick", "slip", "stick"]
    longer = 0.1 * over / (1.0 + over)  # it slips before the peak; v is 0 again after √2 + 1 of it
    unit = run.speed_scale / run.rate_scale
    stop = 0.8 + (1.0 + math.sqrt(2.0)) * longer
    assert run.stop_times[0] == pytest.approx(stop, abs=tol * unit, rel=0.0)

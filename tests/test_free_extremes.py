"""Launches at the ends of floating point: a status or a sentence, never an index or a NaN."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from pucks import aim, simulate, sweep
from scenes import simulate_scene

from puck_tables import resultants, states, stop
from puck_tables.errors import InputError
from puck_tables.motion import limit_ratio

LARGEST = 1.7976931348623157e308


def test_stops_of_overflow_launches_have_a_status():
    for options in ({}, {"delta": 2.0, "tol": 1e-4}, {"gyration": 3.0, "tol": 1e-4}):
        for method in ("look-up", "adaptive"):
            found = stop(
                [[1.0, 0.0], [LARGEST, LARGEST], [1.0, 0.0], [1e-9, 0.0]], [1.0, 1.0, LARGEST, 0.0],
                radius=1.7e308, method=method, **options,
            )  # fmt: skip
            assert found.status.tolist() == [2, 2, 2, 0]
            assert np.isnan(found.path_length[:3]).all()
            assert np.isfinite(found.body_angle[3])


def test_what_overflows_by_the_length_of_a_motion_only():
    """Q/J fits, the stop time of a puck of much inertia is 23 times as much."""
    for method in ("look-up", "adaptive"):
        found = stop((1e-10, 0.0), 1e-8, decel=1e-315, gyration=3.0, tol=1e-4, method=method)
        assert found.status == 2
        assert np.isnan(found.stop_time)
    assert stop((1e-9, 0.0), 5e-9, decel=4e-317).status == 2
    for ask in (lambda **o: simulate((1e-10, 0.0), 1e-8, **o),
                lambda **o: states((1e-10, 0.0), 1e-8, 1.0, **o)):  # fmt: skip
        with pytest.raises(InputError, match="too large"):
            ask(decel=1e-315, gyration=3.0)


def test_the_largest_speeds_are_looked_up_as_others():
    small = stop((1.0, 0.0), 0.9)
    large = stop((1e308, 0.0), 0.9e308, decel=1e308, radius=1.0, delta=0.5)
    assert large.status in (0, 2)
    if large.status == 0:
        assert large.stop_time == pytest.approx(float(small.stop_time), rel=1e-14)
    huge = stop((5e307, 0.0), 4.5e307, decel=1.7e308)
    assert huge.status == 0
    assert huge.stop_time == pytest.approx(float(small.stop_time) * 5.0 / 17.0, rel=1e-14)


@pytest.mark.parametrize("options", [{}, {"delta": 2.0}, {"gyration": 3.0}])
def test_a_spin_is_kept_where_only_slip_over_radius_overflows(options: dict):
    puck = {"radius": 1e-310, "decel": 1e300, **options}
    seen = states((1.0, 0.0), 1e300, [0.0, 2.5e-301], **puck)
    run = simulate((1.0, 0.0), 1e300, times=[0.0, 2.5e-301], **puck)
    for found in (seen, run):
        assert np.isfinite(found.spin).all()
        assert found.spin[0] == pytest.approx(1e300, rel=1e-12)


def test_masked_values_are_refused_alike():
    masked = np.ma.masked_array([0.1, 0.2, 0.3], [False, True, False])
    for ask in (
        lambda: stop((1.0, 0.0), masked), lambda: stop((1.0, 0.0), 1.0, delta=masked),
        lambda: states((1.0, 0.0), 1.0, masked), lambda: states((1.0, 0.0), masked, 1.0),
        lambda: sweep(masked, 1.0), lambda: resultants(masked, 0.5), lambda: limit_ratio(masked),
        lambda: simulate((1.0, 0.0), 1.0, times=masked), lambda: simulate((1, 0), masked[1]),
        lambda: aim(masked[:2]), lambda: aim((2.0, 0.1), spin=masked[1]),
        lambda: simulate((1.0, 0.0), 1.0, delta=np.ma.masked),
    ):  # fmt: skip
        with pytest.raises(InputError, match="masked"):
            ask()
    with pytest.raises(InputError):
        stop((1.0, 0.0), [1.0, np.ma.masked])
    whole = stop((1.0, 0.0), np.ma.masked_array([1.0, 2.0]))  # nothing masked
    assert (whole.stop_time == stop((1.0, 0.0), [1.0, 2.0]).stop_time).all()


@pytest.mark.parametrize(
    "change",
    [
        {"puck": {"radius": 1e160, "height": 0.02, "mass": 0.2}},
        {"puck": {"radius": 0.04, "height": 0.02, "mass": 5e-324}},
        {"puck": {"radius": 1e-320, "height": 0.0, "mass": 1.0}},
        {"launch": {"velocity": [1e200, 0.0], "spin": 1e200}},
    ],
)
@pytest.mark.parametrize("slope", [0.0, 0.1])
def test_scenes_out_of_floating_point_are_refused(change: dict, slope: float):
    scene = {
        "puck": {"radius": 0.04, "height": 0.02, "mass": 0.2, "friction": 0.15},
        "floor": {"slope": slope},
        "launch": {"velocity": [1.0, 0.0], "spin": 60.0}, **change,
    }  # fmt: skip
    with pytest.raises(InputError):
        simulate_scene(scene)


BOUNDS = """
import numpy as np
import puck_tables as pt
from puck_tables.errors import PuckError
rng = np.random.default_rng(1)
ends = [5e-324, 1e-300, 1e-154, 1.0, 3.0, 1e154, 1e300, 1.7e308]
for puck in ({}, {"delta": 1.0}, {"delta": 2.0}, {"gyration": 3.0}):
    for tol in (1e-3, 1e-8):
        for method in (None, "look-up", "adaptive"):
            v, w = rng.choice(ends, (300, 2)), rng.choice(ends, 300)
            J, r = rng.choice(ends, 300), rng.choice(ends, 300)
            found = pt.stop(v, w, decel=J, radius=r, tol=tol, method=method, **puck)
            good = found.status == 0
            for name in ("stop_time", "path_length", "turn_angle", "body_angle"):
                assert np.isfinite(getattr(found, name)[good]).all(), (puck, tol, method, name)
    for n in range(60):
        try:
            pt.states(v[n], w[n], [0.0, 1e-9, 1.0, 1e300], decel=J[n], radius=r[n], **puck)
        except PuckError:
            pass
"""


@pytest.mark.nightly
def test_no_index_leaves_its_table(tmp_path: Path):
    """The same by numba's own check of bounds, in code compiled for it."""
    environment = {
        **os.environ, "NUMBA_BOUNDSCHECK": "1", "NUMBA_DISABLE_JIT": "0",
        "NUMBA_CACHE_DIR": str(tmp_path),
    }  # fmt: skip
    done = subprocess.run(
        [sys.executable, "-c", BOUNDS], env=environment, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr

"""Pure functions of arrays in xarray and dask, and datasets as launches."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from puck_tables import Puck, state_arrays, states, stop, stop_arrays
from puck_tables.errors import InputError

xarray = pytest.importorskip("xarray")
OUTPUTS = ("stop_time", "stop_x", "stop_y", "path_length", "turn_angle", "body_angle")
VX, SPIN = np.linspace(0.1, 2.0, 23), np.linspace(-4.0, 4.0, 31)


def test_they_are_stop_and_states():
    found = stop_arrays(VX[:, None], 0.3, SPIN, delta=0.7, radius=0.5)
    velocity = np.stack(np.broadcast_arrays(VX[:, None], 0.3), axis=-1)
    for name, values in zip(OUTPUTS, found, strict=True):
        truth = getattr(stop(velocity, SPIN, delta=0.7, radius=0.5), name)  # of two passes
        np.testing.assert_allclose(values, truth, rtol=0.0, atol=2e-8)
    moved = state_arrays(1.0, 0.2, SPIN, 0.5)
    truth = states((1.0, 0.2), SPIN, 0.5)
    for name, values in zip(("x", "y", "orientation", "vx", "vy", "spin"), moved, strict=True):
        np.testing.assert_array_equal(values, getattr(truth, name))


@pytest.mark.parametrize("kind", [{}, {"pressure": "ring", "gyration": 1.0, "tol": 1e-6}])
def test_no_element_depends_on_the_others(kind: dict[str, Any]):
    whole = stop_arrays(VX[:, None], 0.0, SPIN, **kind)  # more launches than make a section worth
    for part in (slice(0, 1), slice(4, 9)):
        for one, other in zip(stop_arrays(VX[part], 0.0, SPIN[3], **kind), whole, strict=True):
            assert one.tobytes() == other[part, 3].tobytes()


def test_xarray_and_dask_take_them_as_they_are():
    array = pytest.importorskip("dask.array")
    vx = xarray.DataArray(VX, dims="speed")
    spin = xarray.DataArray(SPIN, dims="spin")
    lazy = xarray.apply_ufunc(
        stop_arrays, vx.chunk(speed=7), 0.0, spin.chunk(spin=11), output_core_dims=[[]] * 6,
        dask="parallelized", output_dtypes=[float] * 6,
    )  # fmt: skip
    truth = stop_arrays(VX[:, None], 0.0, SPIN)
    for one, other in zip(lazy, truth, strict=True):
        assert one.chunks is not None
        assert one.transpose("speed", "spin").compute().values.tobytes() == other.tobytes()
    blocks = array.apply_gufunc(
        stop_arrays, "(),(),()->(),(),(),(),(),()", array.from_array(VX[:, None], chunks=(5, 1)),
        0.0, array.from_array(SPIN, chunks=10), output_dtypes=[float] * 6,
    )  # fmt: skip
    assert blocks[1].compute().tobytes() == truth[1].tobytes()
    moved = xarray.apply_ufunc(
        state_arrays, vx.chunk(speed=7), 0.0, spin, 0.5, output_core_dims=[[]] * 6,
        dask="parallelized", output_dtypes=[float] * 6,
    )  # fmt: skip
    np.testing.assert_array_equal(
        moved[0].transpose("speed", "spin").values, state_arrays(VX[:, None], 0.0, SPIN, 0.5)[0]
    )


def test_empty_arrays_stay_empty():
    assert [one.shape for one in stop_arrays(np.empty((0, 3)))] == [(0, 3)] * 6


def test_a_dataset_of_launches_is_swept():
    puck = Puck.similar()
    table = xarray.Dataset(
        {"launch_speed": ("shot", [1.0, 2.0, 1.5]), "radius": ("shot", [1.0, 1.0, 2.0])},
        {"launch_spin": ("launch_spin", [0.0, 5.0], {"units": "rad/s"})},
    )
    found = puck.sweep(launches=table, delta=0.5)
    assert found.stop_time.shape == (3, 2)
    assert found.dims == ("shot", "launch_spin")
    truth = stop(np.stack([[1.0, 2.0, 1.5], [0.0] * 3], -1)[:, None, :], [0.0, 5.0], delta=0.5,
                 radius=np.array([1.0, 1.0, 2.0])[:, None])  # fmt: skip
    np.testing.assert_allclose(found.stop_y, truth.stop_y, rtol=0.0, atol=2e-8)
    again = found.to_xarray()
    assert again.launch_speed.values.tolist() == [1.0, 2.0, 1.5]
    grid = puck.sweep(spin=[0.0, 1.0], speed=[1.0, 2.0, 3.0])
    ranges = grid.to_xarray().coords.to_dataset()  # ranges of one map for another
    assert puck.sweep(launches=ranges).stop_x.tobytes() == grid.stop_x.tobytes()


@pytest.mark.parametrize(
    ("table", "more", "said"),
    [
        ({}, {}, "the dataset has no launches: give it variables of"),
        ({"speed": ("n", [1.0])}, {}, "speed is no number of a launch"),
        ({"launch_speed": ("n", [1.0], {"units": "km/h"})}, {}, "is in km/h: it must be in m/s"),
        ({"launch_speed": ("n", [-1.0])}, {}, "speed must not be negative"),
        ({"launch_speed": ("n", [1.0])}, {"speed": 2.0}, "stands in the dataset"),
        ({"launch_speed": ("n", [1.0])}, {"spin": [1.0, 2.0]}, "put lists into it"),
        ({"launch_speed": ("n", [1.0])}, {"velocity": (1.0, 0.0)}, "clash"),
        ({"launch_speed": ("n", np.empty(0))}, {}, "no launches"),
    ],
)
def test_datasets_that_are_no_launches(table: Any, more: dict[str, Any], said: str):
    with pytest.raises(InputError, match=said):
        Puck.similar().sweep(launches=xarray.Dataset(table), **more)
    with pytest.raises(InputError, match=r"must be an xarray\.Dataset"):
        Puck.similar().sweep(launches=[1.0])  # type: ignore[arg-type]

"""Stops and states of arrays: however they lie in memory, and whatever shares the work."""

from __future__ import annotations

import math
import pickle

import numpy as np
import pytest

from puck_tables import Puck, states, stop
from puck_tables.errors import InputError
from puck_tables.kernels.compile import kernel
from puck_tables.kernels.elementary import cosine_sine_of, exp_of, log_of

COUNT = 40_000  # more than one chunk, and more than is copied


@pytest.fixture(scope="module")
def launches() -> tuple[np.ndarray, ...]:
    rng = np.random.default_rng(15)
    velocity, spin = rng.normal(size=(COUNT, 2)), 2.0 * rng.normal(size=COUNT)
    velocity[:5], spin[3:8] = 0.0, 0.0
    return velocity, spin, rng.random(COUNT), rng.uniform(0.0, 3.0, COUNT)


def test_any_number_of_threads_gives_the_same_bits(launches):
    velocity, spin, delta, time = launches
    one, two = (stop(velocity, spin, delta=delta, threads=n) for n in (1, 2))
    assert one == two
    one, two = (states(velocity, spin, time, delta=delta, threads=n) for n in (1, 2))
    assert one == two
    with pytest.raises(InputError, match="threads must be a whole number from 1"):
        stop((1.0, 0.0), threads=0)
    with pytest.raises(InputError, match="threads must be a whole number from 1"):
        Puck.similar().states((1.0, 0.0), 1.0, 1.0, threads=1.5)


def test_how_arrays_lie_in_memory_does_not_matter(launches):
    velocity, spin, delta, _ = launches
    expected = stop(velocity, spin, delta=delta)
    apart = np.asfortranarray(velocity)
    spread = np.zeros((COUNT, 4))
    spread[:, 1:3] = velocity
    every = np.zeros(2 * COUNT)
    every[::2] = spin
    fixed = delta.copy()
    fixed.flags.writeable = False
    for given in (
        (apart, spin, delta), (spread[:, 1:3], every[::2], delta), (velocity, spin, fixed),
        (velocity[::-1].copy()[::-1], spin[::-1].copy()[::-1], delta),
    ):  # fmt: skip
        assert np.array_equal(
            stop(*given[:2], delta=given[2]).stop_position, expected.stop_position
        )
    square = stop(velocity.reshape(200, 200, 2), spin.reshape(200, 200), delta=delta[:200])
    assert square.stop_time.shape == (200, 200)
    alone = stop(velocity[200], spin[200], delta=delta[0])
    assert float(square.stop_time[1, 0]) == float(alone.stop_time)


def test_what_is_asked_later_is_of_the_launches_as_they_were(launches):
    velocity, spin, delta, _ = (column.copy() for column in launches)
    held = stop(velocity, spin, delta=delta)
    kept = pickle.loads(pickle.dumps(stop(velocity, spin, delta=delta)))
    few = stop(velocity[:100], spin[:100], delta=delta[:100])
    spin[[10, 11]] = spin[[11, 10]]
    with pytest.raises(InputError, match="have been changed since"):
        _ = held.path_length
    velocity[:] = 9.0
    assert np.array_equal(few.path_length, kept.path_length[:100])


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("name", ["velocity", "spin", "delta", "decel", "radius", "time"])
def test_one_bad_number_among_many_is_refused(launches, name: str, bad: float):
    velocity, spin, delta, time = (column.copy() for column in launches)
    given = {
        "velocity": velocity, "spin": spin, "delta": delta, "time": time,
        "decel": np.ones(COUNT), "radius": np.ones(COUNT),
    }  # fmt: skip
    given[name].reshape(-1)[COUNT - 3] = bad
    with pytest.raises(InputError, match=name):
        states(**given)
    if name != "time":
        given.pop("time")
        with pytest.raises(InputError, match=name):
            stop(**given)


def test_functions_of_loops_are_those_of_numpy():
    @kernel
    def fill(x: np.ndarray, angle: np.ndarray, out: np.ndarray) -> None:
        for n in range(x.size):
            out[0, n] = log_of(x[n])
            out[1, n] = exp_of(-abs(angle[n]))
            out[2, n], out[3, n] = cosine_sine_of(angle[n])

    rng = np.random.default_rng(2)
    x = np.concatenate([10.0 ** rng.uniform(-300.0, 300.0, 500), rng.uniform(0.5, 2.0, 500)])
    angle = np.concatenate([rng.uniform(-700.0, 700.0, 500), rng.uniform(-1.0, 1.0, 500)])
    out = np.empty((4, 1000))
    fill(x, angle, out)
    np.testing.assert_allclose(out[0], np.log(x), rtol=3e-16, atol=1e-300)
    np.testing.assert_allclose(out[1], np.exp(-np.abs(angle)), rtol=5e-16)
    np.testing.assert_allclose(out[2:], [np.cos(angle), np.sin(angle)], rtol=0, atol=3e-16)


@pytest.mark.parametrize("delta", [2.0, 0.5 + 1.5 * (np.arange(16385) % 2)], ids=["tall", "mixed"])
def test_stops_of_tall_pucks_know_their_launches_too(delta):
    """They were refused as changed, whatever had been done with them."""
    rng = np.random.default_rng(16)
    velocity, spin = rng.normal(size=(16385, 2)), rng.normal(size=16385)
    found = stop(velocity, spin, delta=delta, tol=1e-5)
    np.testing.assert_array_equal(found.dataset().columns["launch_spin"].values, spin)
    spin[7] += 1.0
    with pytest.raises(InputError, match="changed"):
        found.dataset()


@pytest.mark.parametrize("launch", [((1.0, -0.5), 4.0), ((0.0, 0.0), -2.0), ((-0.0, 1.0), 0.0)])
def test_one_puck_at_few_times_as_among_others(launch):
    """It takes a way of its own, to the same bits."""
    (vx, vy), spin = launch
    times = np.array([0.0, 0.3, 1.1, 50.0])
    alone = states((vx, vy), spin, times)
    single = [states((vx, vy), spin, float(time)) for time in times]
    among = states(np.tile([vx, vy], (4, 1)), np.full(4, spin), times)
    for name in ("x", "y", "heading", "orientation", "speed", "spin"):
        np.testing.assert_array_equal(getattr(alone, name), getattr(among, name))
        np.testing.assert_array_equal([getattr(one, name) for one in single], getattr(among, name))


def test_one_puck_is_refused_as_others_are():
    for time, spin, words in (
        (-1.0, 1.0, "negative"),
        (math.nan, 1.0, "finite"),
        (1.0, math.inf, "spin"),
    ):
        with pytest.raises(InputError, match=words):
            states((1.0, 0.0), spin, time)
    with pytest.raises(InputError, match="too large for floating point"):
        states((1e200, 0.0), 1.0, 1.0)

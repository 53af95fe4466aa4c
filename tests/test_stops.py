"""Stops in bulk and maps of them."""

from __future__ import annotations

import math

import numpy as np
import pytest
from pucks import simulate, sweep

from puck_tables import Table, stop
from puck_tables._core.executor import run_chunks
from puck_tables._core.memory import check_memory
from puck_tables.errors import AccuracyError, InputError

ARRAYS = (
    "stop_time", "stop_x", "stop_y", "path_length", "turn_angle", "body_angle", "status",
)  # fmt: skip


@pytest.mark.parametrize("way", ["look-up", "integrated"])
def test_stop_agrees_with_simulate_and_broadcasts(way: str, table: Table):
    v0 = np.array([[1.0, 0.0], [0.3, -2.0], [0.0, 0.0]])
    w0 = np.array([[3.0], [-0.2], [0.0], [1e-9]])
    chosen = table if way == "integrated" else None
    result = stop(v0, w0, delta=0.8, decel=2.0, radius=0.1, table=chosen)
    assert result.method == way
    assert result.stop_time.shape == (4, 3)
    assert result.stop_position.shape == (4, 3, 2)
    assert np.all(result.status == 0)
    for i in range(4):
        for j in range(3):
            run = simulate(v0[j], w0[i, 0], delta=0.8, decel=2.0, radius=0.1)
            q = math.hypot(*v0[j], 0.1 * w0[i, 0])
            assert result.stop_time[i, j] == pytest.approx(run.stop_time, abs=1e-7 * q)
            np.testing.assert_allclose(
                result.stop_position[i, j], run.stop_position, rtol=0, atol=1e-7 * q * q
            )
            assert result.path_length[i, j] == pytest.approx(run.path_length, abs=1e-7 * q * q)
            assert result.body_angle[i, j] == pytest.approx(run.body_angle, abs=2e-6 * q * q)
            assert result.turn_angle[i, j] == pytest.approx(run.turn_angle, abs=1e-5)


def test_integration_reaches_the_accuracy_it_promises(table: Table):
    rng = np.random.default_rng(11)
    u = np.concatenate([rng.uniform(-18, 18, 300), rng.uniform(-0.5, 0.5, 100)])
    delta = rng.random(400)
    v0 = np.stack([1.0 / np.hypot(1.0, np.exp(u)), 0.0 * u], axis=-1)
    w0 = np.sqrt(1.0 - v0[:, 0] ** 2)
    truth = stop(v0, w0, delta=delta, tol=2e-10)
    assert truth.method == "look-up"
    for accuracy in (1e-2, 1e-3, 1e-5, 1e-7, 1e-8):
        result = stop(v0, w0, delta=delta, tol=accuracy, table=table)
        assert np.abs(result.stop_time - truth.stop_time).max() <= accuracy + 2e-10
        assert np.abs(result.stop_position - truth.stop_position).max() <= accuracy + 2e-10


@pytest.mark.parametrize(
    ("arguments", "options", "words"),
    [
        (((1, 0, 0), 1.0), {}, "two components"),
        (((1, 0), [1.0, math.inf]), {}, "spin"),
        (((1, 0), 1.0), {"delta": 1.5, "table": Table.shipped("stops")}, "outside this table"),
        (((1, 0), 1.0), {"delta": -0.5}, "delta"),
        (((1, 0), 1.0), {"radius": [1.0, 0.0]}, "radius"),
        (((1, 0), 1.0), {"decel": 0.0}, "decel"),
        (((1, 0), [1.0, 2.0, 3.0]), {"delta": [0.1, 0.2]}, "broadcast"),
    ],
)
def test_bad_launches(arguments: tuple, options: dict, words: str):
    with pytest.raises(InputError, match=words):
        stop(*arguments, **options)


def test_accuracy_out_of_reach():
    with pytest.raises(AccuracyError, match=r"1e-13 .*to 0\.01"):
        stop((1, 0), 1.0, tol=1e-14)
    with pytest.raises(AccuracyError, match=r"to 0\.01"):
        stop((1, 0), 1.0, tol=0.1)


@pytest.mark.parametrize("way", ["look-up", "integrated"])
def test_same_bits_for_any_threads_and_chunks(way: str, table: Table):
    chosen = table if way == "integrated" else None
    grid = {
        "spin": np.linspace(-3, 3, 23),
        "speed": np.linspace(0, 2, 17),
        "delta": np.array([0.0, 0.4, 1.0]),
    }
    base = sweep(threads=1, chunk=10**6, table=chosen, **grid)
    for threads, chunk in ((2, 64), (2, 7), (1, 1), (3, 100)):
        other = sweep(threads=threads, chunk=chunk, table=chosen, **grid)
        for name in ARRAYS:
            assert getattr(other, name).tobytes() == getattr(base, name).tobytes()
    alone = stop((grid["speed"][5], 0.0), grid["spin"][3], delta=0.4, table=chosen)
    # a map takes all outputs in one pass, a stop its place by as coarse a cut as is good enough
    allowed = 2e-9 if way == "look-up" else 0.0
    assert float(alone.stop_time) == pytest.approx(base.stop_time[1, 5, 3], rel=0.0, abs=allowed)


def test_axes_only_of_what_is_ranged():
    assert list(sweep().axes) == ["launch_speed", "launch_spin"]
    assert sweep().stop_time.shape == (41, 41)
    assert list(sweep([1.0, 2.0], velocity=(0.0, 1.0)).axes) == ["launch_spin"]
    assert list(sweep(1.0, [0.5, 1.0], delta=[0.0, 1.0]).axes) == ["delta", "launch_speed"]
    single = sweep(1.0, 2.0)
    assert single.stop_time.shape == ()
    assert single.fixed == {
        "decel": 1.0, "radius": 1.0, "delta": 0.5, "launch_speed": 2.0, "launch_spin": 1.0,
    }  # fmt: skip


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"velocity": (1, 0), "speed": 1.0}, "give one of them"),
        ({"speed": [-1.0, 1.0]}, "negative"),
        ({"spin": [[1.0]]}, "list of numbers"),
        ({"spin": []}, "list of numbers"),
        ({"chunk": 0}, "chunk must be"),
        ({"chunk": -5}, "chunk must be"),
        ({"threads": 0}, "threads must be"),
        ({"threads": "2"}, "threads must be"),
        ({"delta": [0.0, 4.0]}, "tips"),
        ({"radius": -1.0}, "radius"),
        ({"velocity": ((1, 0), (2, 0))}, "velocity must be one"),
    ],
)
def test_bad_maps(options: dict, words: str):
    with pytest.raises(InputError, match=words):
        sweep(**options)


def test_a_map_too_large_says_how_large():
    with pytest.raises(InputError, match=r"1000000 x 1000000 launches would need .* GiB"):
        check_memory((10**6, 10**6), 160)


def test_executor_raises_the_first_error_and_drops_the_rest():
    seen: list[int] = []

    def work(start: int, stop: int) -> None:
        seen.append(start)
        if start == 20:
            raise RuntimeError("chunk")

    with pytest.raises(RuntimeError, match="chunk"):
        run_chunks(work, 10_000, 10, threads=2)
    assert len(seen) < 100
    done: list[tuple[int, int]] = []
    run_chunks(lambda a, b: None, 95, 10, threads=2, progress=lambda d, t: done.append((d, t)))
    assert done[-1] == (95, 95)

"""Launches that scatter: the same bits for any cutting, the right distribution, and summaries."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from commands import invoke

from puck_tables import Launch, Normal, Puck, Scene, Uniform, stop
from puck_tables.bulk.summary import chance_of, inside_of
from puck_tables.errors import InputError

PUCK = Puck.similar()
SPREADS: dict[str, Any] = {"spin": Normal(5.0, 0.2), "speed": Uniform(0.9, 1.1)}
COUNT = 20_000


def test_the_same_bits_for_any_chunks_and_threads():
    whole = PUCK.sample(COUNT, 7, **SPREADS)
    for threads, chunk in ((1, 1001), (3, 77), (2, 4096)):
        assert PUCK.sample(COUNT, 7, **SPREADS, threads=threads, chunk=chunk) == whole
    assert PUCK.sample(COUNT, 8, **SPREADS) != whole
    fewer = PUCK.sample(100, 7, **SPREADS)
    assert fewer.stop_x.tobytes() == whole.stop_x[:100].tobytes()
    other = PUCK.sample(COUNT, 7, spin=Normal(5.0, 0.2), speed=1.0)  # a stream for each name
    assert other.launch_spin.tobytes() == whole.launch_spin.tobytes()


def test_the_stops_are_those_of_the_launches_drawn():
    found = PUCK.sample(500, 7, **SPREADS, heading=Normal(0.0, 0.1))
    heading = found.launch_heading
    velocity = found.launch_speed[:, None] * np.stack([np.cos(heading), np.sin(heading)], -1)
    truth = stop(velocity, found.launch_spin)
    np.testing.assert_allclose(found.stop_x, truth.stop_x, atol=1e-14)
    np.testing.assert_allclose(found.stop_y, truth.stop_y, atol=1e-14)


@pytest.mark.parametrize(
    ("spread", "name"), [(Normal(5.0, 0.2), "norm"), (Uniform(0.9, 1.1), "uniform")]
)
def test_what_is_drawn_has_its_distribution(spread: Any, name: str):
    from scipy import stats

    drawn = spread.drawn("spin", 3, 0, 200_000)
    where = (5.0, 0.2) if name == "norm" else (0.9, 0.2)
    assert stats.kstest(drawn, name, args=where).pvalue > 1e-3
    other = spread.drawn("speed", 3, 0, 200_000)
    assert abs(np.corrcoef(drawn, other)[0, 1]) < 0.01
    assert abs(np.corrcoef(drawn[1:], drawn[:-1])[0, 1]) < 0.01


def test_summaries_are_those_of_numpy():
    found = PUCK.sample(COUNT, 7, **SPREADS)
    assert found.mean()["stop_x"] == pytest.approx(np.mean(found.stop_x), rel=1e-13)
    pair = np.stack([found.stop_x, found.stop_y])
    np.testing.assert_allclose(found.covariance(("stop_x", "stop_y")), np.cov(pair), rtol=1e-12)
    np.testing.assert_allclose(
        found.quantiles([0.1, 0.9])["stop_time"], np.quantile(found.stop_time, [0.1, 0.9])
    )
    across, along, density = found.density(50)
    area = np.outer(np.diff(across), np.diff(along))
    assert (density * area).sum() == pytest.approx(1.0, abs=1e-12)
    hits = (np.hypot(found.stop_x - 2.2, found.stop_y + 0.16) <= 0.1).sum()
    one = found.chance((2.2, -0.16, 0.1))
    assert one.value == hits / COUNT and one.low < one.value < one.high
    box = found.chance((2.0, -0.2, 2.2, 0.0))
    corners = [(2.0, -0.2), (2.2, -0.2), (2.2, 0.0), (2.0, 0.0)]
    assert found.chance(corners).value == pytest.approx(box.value, abs=1e-12)


def test_the_linear_spread_agrees_where_it_is_linear():
    """Covariance by the Jacobian, which shares no code with samples."""
    found = PUCK.sample(COUNT, 7, spin=Normal(5.0, 0.02), speed=Normal(1.0, 0.005))
    jacobian = stop((1.0, 0.0), 5.0, jacobian=True).jacobian[1:3][:, [0, 2]]
    linear = jacobian @ np.diag([0.005**2, 0.02**2]) @ jacobian.T
    np.testing.assert_allclose(found.covariance(("stop_x", "stop_y")), linear, rtol=0.04)


def test_regions():
    x, y = np.array([0.5, 1.5, 0.1]), np.array([0.5, 0.5, 0.9])
    assert inside_of([(0, 0), (1, 0), (1, 1)], x, y - 0.01).tolist() == [True, False, False]
    assert chance_of(0, 100).low == 0.0 < chance_of(0, 100).high < 0.04
    for bad in ((0, 0, -1.0), (1, 0, 0, 1), [(0, 0), (1, 1)], (0, 0), (0, 0, np.nan)):
        with pytest.raises(InputError, match="region"):
            inside_of(bad, x, y)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({}, "samples need a spread"),
        ({"spin": 5.0}, "samples need a spread"),
        ({"spin": [5.0, 6.0], "speed": Normal(1.0, 0.1)}, "samples have no ranges"),
        ({"radius": Normal(1.0, 0.5)}, "samples of radius must be greater than 0 m"),
        ({"speed": Uniform(-0.1, 0.1)}, "samples of speed must not be negative"),
        ({"delta": Uniform(0.9, 1.5)}, "are too many"),
        ({"gyration": Uniform(0.6, 0.8)}, "are too many"),
        ({"height": Normal(0.3, 0.01), "delta": 0.5}, "delta and height clash"),
        ({"weight": Normal(1.0, 0.1)}, "weight is no number of a launch"),
    ],
)
def test_samples_that_cannot_be_drawn_are_refused(given: dict[str, Any], said: str):
    with pytest.raises(InputError, match=said):
        PUCK.sample(5000, 7, **given)


def test_spreads_that_are_none_are_refused():
    for make in (lambda: Normal(1.0, 0.0), lambda: Normal(1.0, -1.0), lambda: Uniform(1.0, 1.0),
                 lambda: Uniform(2.0, 1.0), lambda: Normal(np.nan, 1.0)):  # fmt: skip
        with pytest.raises(InputError):
            make()
    for count, seed in ((1, 0), (10**10, 0), (2.5, 0), (10, -1), (10, 2**64)):
        with pytest.raises(InputError, match="must be a whole number"):
            PUCK.sample(count, seed, **SPREADS)  # type: ignore[arg-type]
    with pytest.raises(InputError, match="give it to sample"):
        PUCK.sweep(spin=Normal(1.0, 0.1))  # type: ignore[arg-type]


def test_samples_of_a_scene():
    scene = Scene(Puck(0.04, friction=0.1), launch=Launch((1.0, 0.0), spin=3.0))
    spreads = {"launch.velocity[0]": Normal(1.0, 0.01), "launch.spin": Normal(3.0, 0.2)}
    found = scene.sample(300, 7, spreads)
    assert found == scene.sample(300, 7, spreads, threads=1, chunk=11)
    drawn = found.columns
    truth = scene.puck.stop(
        np.stack([drawn["launch_velocity_0"], np.zeros(300)], -1), drawn["launch_spin"], tol=1e-9
    )
    np.testing.assert_allclose(found.x, truth.stop_x, atol=1e-9)
    for bad, said in (({}, "need a spread"), ({"launch.wing": Normal(1.0, 0.1)}, "wing")):
        with pytest.raises(InputError, match=said):
            scene.sample(10, 7, bad)


def test_the_command_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.chdir(tmp_path)

    def invoked(*words: str) -> Any:
        return invoke("sweep", *words)

    spreads = ["--spread", "w0=normal:5:0.2", "--spread", "speed=uniform:0.9:1.1"]
    scene = ["--scene", "incline", "--spread", "launch.spin=normal:5:0.2"]
    result = invoked("--random", "5000", "--seed", "7", *spreads, "--inside", "2.2,-0.16,0.1",
                     "-o", "s.h5", "--plot", "s.png")  # fmt: skip
    assert result.exit_code == 0, result.stderr
    same = PUCK.sample(5000, 7, **SPREADS)
    assert result.stdout.rstrip() == same.within((2.2, -0.16, 0.1)).summary()
    assert Path("s.png").stat().st_size > 10_000
    for words, said in (
        (["--random", "10"], "--random needs a --spread"),
        (["--spread", "w0=normal:5:0.2"], "--spread is for samples"),
        (["--seed", "7"], "--seed is for samples"),
        (["--random", "10", "--spread", "w0=5"], "is no spread"),
        (["--random", "10", "--spread", "w0=normal:5:0"], "deviation"),
        (["--random", "10", "--spread", "mass=normal:5:1"], "does not scatter"),
        (["--random", "10", *spreads, "--w0", "5"], "clash"),
        (["--random", "10", *spreads, "--delta", "0:1:5"], "cannot range"),
        (["--random", "10", *spreads, "--inside", "1,2"], "region"),
        (["--random", "1000000000", *spreads], "GiB"),
        (["--random", "10", *spreads, "-o", "s.xyz"], ".parquet, .zarr"),
        (["--random", "10", "--scene", "incline"], "like launch.spin=normal:5:0.2"),
        (["--random", "10", *scene, "--set", "launch.spin=3"], "--spread and --set"),
        (["--random", "10", *scene, "--w0", "3"], "--w0 and --spread launch.spin clash"),
        (["--random", "10", *scene, "--spread", "puck.friction=uniform:-1:0.2"], "in the middle"),
    ):
        refused = invoked(*words)
        assert (refused.exit_code, said in refused.stderr) == (2, True), refused.stderr


@pytest.mark.thorough
def test_samples_of_a_scene_on_the_command_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.chdir(tmp_path)
    words = ["--scene", "incline", "--random", "50", "--spread", "launch.spin=normal:5:0.2"]
    told = "Puck on an incline over launch.spin normal:5.0:0.2 rad/s: 50 at rest"
    said = set()
    for more in ([], ["-o", "s.h5"], ["--plot", "s.png"], ["-o", "s.zarr"]):
        result = invoke("sweep", *words, *more)
        assert result.exit_code == 0, result.stderr
        assert told in result.stderr.splitlines()
        said.add(result.stdout)
    assert len(said) == 1  # one summary, wherever the samples are kept


def test_many_samples_of_a_store_are_not_read_unasked(tmp_path, monkeypatch):
    pytest.importorskip("zarr")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("puck_tables.cli.sweep.SUMMED", 10)
    words = ["sweep", "--random", "11", "--spread", "w0=normal:5:0.2", "-o", "s.zarr"]
    quiet = invoke(*words)
    assert (quiet.exit_code, quiet.stdout) == (0, "")
    assert "summed up only with --plot or --inside" in quiet.stderr
    asked = invoke(*words, "--inside", "2.2m,-16cm,10cm")
    assert asked.exit_code == 0, asked.stderr
    assert "ends inside (2.2, -0.16, 0.1) m" in asked.stdout and "stop_x m  " in asked.stdout
    assert "at decel = 1 m/s^2, radius = 1 m, delta = 0.5, launch" in asked.stderr
    for more in (["--inside", "2.2,-0.16,0.1"], ["--plot", "s.png"]):
        vast = [*words[:1], "--random", "1000000000", *words[3:5], "-o", "vast.zarr", *more]
        refused = invoke(*vast)
        assert refused.exit_code == 2, refused.stderr
        assert "--plot and --inside read a whole store" in refused.stderr
    assert not (tmp_path / "vast.zarr").exists()

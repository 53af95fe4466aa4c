"""Aiming: the inverse problem, its answers verified forward by an independent integrator."""

from __future__ import annotations

import csv
import json
import math
from pathlib import Path

import numpy as np
import pytest
from commands import invoke
from pucks import aim, simulate
from reference import states

from puck_tables import stop
from puck_tables.errors import InputError
from puck_tables.motion import limit_ratio

TARGET = (2.0, 0.1)


def forward(found) -> np.ndarray:
    puck = {"delta": found.puck.delta, "decel": found.puck.decel, "radius": found.puck.radius}
    return stop(found.launch_velocity, found.launch_spin, **puck, tol=1e-11).stop_position


@pytest.mark.parametrize("delta", [0.0, 0.5, 1.0])
def test_every_launch_of_the_family_arrives(delta: float):
    found = aim((-0.3, 0.4), delta=delta, decel=0.8, radius=0.05, count=12)
    assert found.launch_spin.size == 23  # the slide without spin once
    np.testing.assert_allclose(forward(found), [(-0.3, 0.4)] * 23, rtol=0, atol=1e-10)
    assert np.all(found.miss < 1e-10)
    assert np.all(np.diff(found.launch_spin) > 0.0)
    np.testing.assert_allclose(found.launch_speed, found.launch_speed[::-1], rtol=1e-12)


def test_answers_arrive_by_scipy_too():
    """To a second before the stop, then on by the rest that simulate gives."""
    for launch in zip(
        *(lambda a: (a.launch_velocity, a.launch_spin, a.stop_time))(aim(TARGET, stop_time=3.0)),
        strict=True,
    ):
        v0, w0, time = launch
        vx, vy, rim, x, y, _ = states(tuple(v0), w0, 0.5, np.array([0.0, time - 1.0]))[:, -1]
        rest = simulate((vx, vy), rim, delta=0.5, exact=True)
        assert rest.stop_time == pytest.approx(1.0, abs=1e-9)
        assert (x + rest.stop_position[0], y + rest.stop_position[1]) == pytest.approx(
            TARGET, abs=1e-9
        )


def test_a_spin_a_speed_or_a_time_picks():
    by_spin = aim(TARGET, spin=-5.0)
    assert by_spin.launch_spin.tolist() == pytest.approx([-5.0], rel=1e-13)
    by_speed = aim(TARGET, speed=1.5)
    assert by_speed.launch_speed == pytest.approx([1.5, 1.5], rel=1e-13)
    by_time = aim(TARGET, stop_time=3.0)
    assert by_time.stop_time == pytest.approx([3.0, 3.0], rel=1e-13)
    for found in (by_spin, by_speed, by_time):
        assert forward(found) == pytest.approx(
            np.array([TARGET] * found.launch_spin.size), abs=1e-9
        )
    assert by_speed.launch_spin[0] == pytest.approx(-by_speed.launch_spin[1], rel=1e-13)


def test_the_limit_motion_is_found_by_its_ratio():
    ratio = float(limit_ratio(0.5))
    run = simulate((1.0, 0.0), ratio, delta=0.5, exact=True)
    found = aim(run.stop_position, spin=ratio)
    assert found.launch_velocity[0] == pytest.approx([1.0, 0.0], abs=1e-10)
    assert found.stop_time[0] == pytest.approx(run.stop_time, rel=1e-10)


def test_ends_of_the_family():
    distance = math.hypot(*TARGET)
    slide = aim(TARGET, spin=0.0)
    assert slide.launch_speed[0] == pytest.approx(math.sqrt(2.0 * distance), rel=1e-15)
    assert slide.launch_heading[0] == pytest.approx(math.atan2(0.1, 2.0), rel=1e-15)
    for options in ({"speed": slide.launch_speed[0]}, {"stop_time": slide.stop_time[0]}):
        assert aim(TARGET, **options).miss.max() < 1e-9
    fast = aim(TARGET, spin=1e9)
    assert fast.miss[0] < 1e-9
    assert fast.stop_time[0] == pytest.approx(0.75e9, rel=1e-9)
    for options in ({"spin": 1e300}, {"stop_time": 1e300}, {"speed": 1e-200}, {"spin": 1e-290}):
        with pytest.raises(InputError, match="out of the range of floating point"):
            aim(TARGET, **options)
    assert aim((1.0, 0.0), speed=math.sqrt(2.0)).launch_spin.tolist() == [0.0]


@pytest.mark.parametrize("scale", [1e-12, 1e9])
def test_answers_scale(scale: float):
    base, far = aim(TARGET, count=3), aim(np.array(TARGET) * scale**2, count=3)
    np.testing.assert_allclose(far.launch_velocity, base.launch_velocity * scale, rtol=1e-12)
    np.testing.assert_allclose(far.stop_time, base.stop_time * scale, rtol=1e-12)


def test_bounds_hold_and_are_reached():
    found = aim(TARGET, max_speed=1.7, max_spin=10.0, count=9)
    assert found.launch_speed.max() == pytest.approx(1.7, rel=1e-12)
    assert np.abs(found.launch_spin).max() == pytest.approx(10.0, rel=1e-12)
    loose = aim(TARGET, max_speed=5.0, max_spin=1.0)
    assert loose.launch_spin.min() == pytest.approx(-1.0, rel=1e-12)
    assert 0.0 in loose.launch_spin


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"speed": 3.0}, "the fastest has 2.00124883 m/s and no spin"),
        ({"stop_time": 1.0}, "the quickest takes 2.00124883 s and has no spin"),
        ({"max_speed": 0.1, "max_spin": 1.0}, "at 0.1 m/s it takes 46.29"),
        ({"spin": 5.0, "max_speed": 0.5}, "takes 0.906268093 m/s and 5 rad/s: out of the bounds"),
    ],
)
def test_no_solution_is_an_answer(options: dict, words: str):
    found = aim(TARGET, **options)
    assert found.launch_spin.size == 0
    assert found.launch_velocity.shape == (0, 2)
    assert words in found.answer


def test_the_target_under_the_puck():
    assert "any spin alone" in aim((0.0, 0.0)).answer
    spinning = aim((0.0, 0.0), spin=-3.0, radius=0.5)
    assert (spinning.launch_velocity.tolist(), spinning.launch_spin.tolist()) == (
        [[0.0, 0.0]],
        [-3.0],
    )
    assert spinning.stop_time.tolist() == [0.75 * 1.5]
    assert aim((0.0, 0.0), stop_time=0.75).launch_spin.tolist() == [-1.0, 1.0]
    assert "no launch with speed" in aim((0.0, 0.0), speed=1.0).answer


@pytest.mark.parametrize(
    ("arguments", "options", "words"),
    [
        ((TARGET,), {"spin": 1.0, "speed": 1.0}, "give one of them"),
        (((1.0,),), {}, "one place"),
        ((TARGET,), {"speed": -1.0}, "speed must be greater"),
        ((TARGET,), {"max_spin": 0.0}, "max_spin must be greater"),
        ((TARGET,), {"delta": 4.0}, "tips"),
        ((TARGET,), {"count": 0}, "count"),
        ((TARGET,), {"spin": math.inf}, "spin"),
        (((math.nan, 0.0),), {}, "target"),
    ],
)
def test_bad_aims(arguments: tuple, options: dict, words: str):
    with pytest.raises(InputError, match=words):
        aim(*arguments, **options)


def run(*arguments: str):
    return invoke("aim", *arguments)


def test_command_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.chdir(tmp_path)
    shown = run("--target", "2,0.1", "--w0", "5")
    assert shown.exit_code == 0
    assert "answer  1 launch\n" in shown.stdout
    data = json.loads(run("--target", "2,0.1", "--time", "3", "--json").stdout)
    assert data["stop_time"] == pytest.approx([3.0, 3.0])
    saved = run("--target", "2,0.1", "-o", "aim.csv", "--plot", "aim.png")
    assert saved.exit_code == 0
    rows = list(csv.DictReader(Path("aim.csv").read_text().splitlines()))
    assert len(rows) == 15
    assert float(rows[0]["launch_spin[rad/s]"]) < float(rows[1]["launch_spin[rad/s]"])
    assert Path("aim.png").read_bytes().startswith(b"\x89PNG")
    none = run("--target", "2,0.1", "--time", "1", "--plot", "none.png")
    assert (none.exit_code, Path("none.png").exists()) == (0, False)
    assert "quickest" in none.stdout
    again = run("--target", "2,0.1", "-o", "aim.csv")
    assert again.exit_code == 1
    assert "exists already" in again.stderr
    for options, words in (
        (["--w0", "1", "--time", "2"], "--w0 and --time clash"),
        (["-o", "aim.txt"], ".csv"),
        (["--count", "0"], "count"),
    ):
        refused = run("--target", "2,0.1", *options)
        assert refused.exit_code == 2
        assert words in refused.stderr


def test_nothing_to_draw_is_said(tmp_path: Path):
    with pytest.raises(InputError, match="nothing to draw"):
        aim(TARGET, stop_time=1.0).plot(tmp_path / "none.png")

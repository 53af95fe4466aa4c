"""Samples of boards: what runs alone give, failures counted, those that leave play told."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from boards import draw, puck_at
from commands import invoke

import puck_tables as pt
from puck_tables import Normal, Scene, Uniform
from puck_tables.scene.library import as_toml
from puck_tables.scene.run import ENDS, REFUSED

PLACES = ("x", "y", "orientation", "in_play")
SHOT: dict[str, Any] = {
    "puck[0].launch.velocity[1]": Normal(0.0, 0.05), "puck[0].launch.spin": Normal(0.0, 8.0),
}  # fmt: skip


def shot(**more: Any) -> Scene:
    """A cue sent at a red before a pocket, into which it may fall."""
    cue, red = puck_at(0.0, 0.0, (1.9, 0.0), name="cue"), puck_at(0.3, 0.0, name="red")
    return Scene(pucks=[cue, red], pockets=[pt.Pocket((0.8, 0.02), 0.06)], **more)


def judged(scene: Scene, found: Any, runs: Any) -> None:
    """Each of these runs is what its numbers give alone."""
    for run in runs:
        alone = scene.at(found.numbers(run)).simulate()
        for name in PLACES:
            assert found.columns[name][run] == pytest.approx(alone.last[name], abs=1e-9), name
        assert found.end_time[run] == pytest.approx(alone.end_time, abs=1e-9)
        assert found.impacts[run] == alone.impacts
        assert ENDS[found.end[run]] == alone.end


@pytest.mark.thorough
@pytest.mark.parametrize("seed", range(3))
def test_a_sample_of_a_drawn_board_is_what_runs_alone_give(seed: int):
    """Launches, which are done together, and a number that makes each run another board."""
    scene = draw(seed, 4)
    whole, some = range(4), np.random.default_rng(seed).permutation(4)[:2].tolist()
    spreads: dict[str, Any] = {f"puck[{n}].launch.spin": Normal(0.0, 5.0) for n in whole}
    spreads |= {f"puck[{n}].launch.velocity[0]": Uniform(-0.3, 0.3) for n in some
                if scene.pucks[n].launch.velocity is not None}  # fmt: skip
    spreads |= {f"puck[{some[0]}].mass": Uniform(0.05, 0.2)} if seed else {}
    found = scene.sample(24, seed, spreads)
    assert found.x.shape == (24, 4) and found.ended == 24
    judged(scene, found, range(0, 24, 3))


def test_a_sample_of_a_board_is_what_runs_alone_give():
    scene = shot()
    found = scene.sample(60, 7, SHOT)
    assert found == scene.sample(60, 7, SHOT, threads=1, chunk=7)
    judged(scene, found, range(0, 60, 12))
    drawn = SHOT["puck[0].launch.spin"].drawn("puck[0].launch.spin", 7, 0, 60)
    assert found.columns["puck_0_launch_spin"].tolist() == drawn.tolist()
    left = found["red"]["in_play"] == 0.0
    assert 0 < left.sum() < 60
    assert found.of("red").left_play.value == left.mean()
    stays = found.x[~left, 1]
    assert found.of("red").mean()["x"] == pytest.approx(stays.mean(), rel=1e-13)
    assert found.of(1).chance((0.0, -9.0, 9.0, 9.0)).value == (~left).mean()
    with pytest.raises(pt.InputError, match="of several pucks, and a summary is of one"):
        found.mean()
    told = found.within((0.8, 0.0, 0.3)).summary()
    assert "red orientation rad  " in told
    assert f"red leaves play with a chance of {left.mean():.6g} (95 %" in told
    assert "cue ends inside (0.8, 0, 0.3) m with a chance of 0 (95 %" in told


def test_a_draw_that_fails_is_counted_and_said():
    """Drawn places of which some overlap, by plain geometry."""
    cue, red = puck_at(0.0, 0.0, (1.0, 0.0)), puck_at(0.065, 0.0)
    spreads = {"puck[1].launch.position[0]": Normal(0.065, 0.01)}
    found = Scene(pucks=[cue, red]).sample(40, 3, spreads)
    overlap = found.columns["puck_1_launch_position_0"] < 0.06
    assert 0 < overlap.sum() < 40
    assert (found.end == REFUSED).tolist() == overlap.tolist()
    assert np.isnan(found.x[overlap]).all() and np.isfinite(found.x[~overlap]).all()
    (line,) = found.without_end()
    first = found.columns["puck_1_launch_position_0"][overlap][0]
    assert line.startswith(f"{overlap.sum()} of 40 runs: refused; the first at")
    assert f"position[0] = {first:.10g}" in line and "overlap" in line
    assert found.of(0).ended == 40 - overlap.sum()


@pytest.mark.parametrize("order", [1, -1])
@pytest.mark.parametrize("board", [False, True])
def test_a_launch_that_cannot_be_takes_no_other_along(board: bool, order: int):
    puck = puck_at(0.0, 0.0, (1.0, 0.0))
    path, values = "launch.velocity[0]", [1.0, 2.0, 1e160][::order]
    one = Scene(pt.Puck(0.03, friction=0.2), launch=pt.Launch((1.0, 0.0)), ranges={path: values},
                floor=pt.Floor(slope=0.01))  # fmt: skip
    two = Scene(pucks=[puck, puck_at(5.0, 1.0)], ranges={f"puck[0].{path}": values})
    ends = (two if board else one).sweep()
    assert ends.end.tolist() == [0, 0, REFUSED][::order]


@pytest.mark.parametrize("pucks", [0, 1])
def test_what_stands_far_away_changes_no_map_and_no_sample(pucks: int):
    """A post makes a board of it; its columns stay what they were, and so does their shape."""
    puck, launch = pt.Puck(0.03, friction=0.2), pt.Launch((1.0, 0.1), spin=9.0)
    parts: Any = {"pucks": [puck_at(0.0, 0.0, (1.0, 0.1), 9.0)]} if pucks else {
        "puck": puck, "launch": launch}  # fmt: skip
    own = "puck[0]." if pucks else ""
    free, far = Scene(**parts), Scene(**parts, posts=[pt.Post((7.0, 0.0), 0.1)])
    spreads: Any = {f"{own}launch.spin": Normal(9.0, 1.0)}
    near, away = (scene.sample(20, 1, spreads) for scene in (free, far))
    assert near.x.shape == away.x.shape == ((20, 1) if pucks else (20,))
    for name in (*PLACES, "end_time", "impacts"):
        np.testing.assert_allclose(near.columns[name], away.columns[name], atol=2e-8)
    assert near.columns["in_play"].all() and away.ended == 20


def test_a_map_of_a_board_says_how_far_its_runs_may_be_off():
    ends = shot(ranges={"puck[0].launch.spin": [0.0, 4.0, 9.0]}).sweep()
    assert 0.0 < ends.error_estimate < 1e-6
    ends.columns["x"][1, 0] += 1e-3  # the cue of one run
    assert ends.of("cue").error_estimate > 1e-4 and ends.of("red").error_estimate < 1e-6


def test_a_puck_over_an_edge_rests_nowhere():
    edge = pt.Edge((0.5, 0.0), normal=(-1.0, 0.0))
    scene = Scene(pt.Puck(0.04, friction=0.1), launch=pt.Launch((1.0, 0.0)), edges=[edge])
    found = scene.sample(200, 5, {"launch.velocity[0]": Normal(1.0, 0.1)})
    speeds = found.columns["launch_velocity_0"]
    over = speeds**2 / (2.0 * 0.1 * scene.puck.gravity) > 0.5
    assert (found.in_play == 0.0).tolist() == over.tolist() and 0 < over.sum() < 200
    assert found.ended == 200 and found.left_play.value == over.mean()
    assert found.mean()["x"] == pytest.approx(found.x[~over].mean(), rel=1e-13)
    assert "leaves play with a chance of" in found.summary()


def test_a_picture_of_samples_counts_every_puck():
    found = shot(title="A shot").sample(60, 7, SHOT)
    figure = found.plot()
    words = [text.get_text() for text in figure.legends[0].get_texts()]
    left = int((found["red"]["in_play"] == 0.0).sum())
    assert {"cue: 60 in play", f"red: {60 - left} in play", f"red: {left} left play"} <= set(words)
    assert "puck[0].launch.spin normal:0.0:8.0 rad/s" in figure.get_suptitle().replace("\n", " ")
    own = found.of("red").within((-1.0, -1.0, 0.5, 1.0), (9.0, 0.0, 0.1)).plot()
    assert own.axes[0].get_title("left").endswith(f"; {left} of 60 samples left play")
    chance = found.of("red").chance((-1.0, -1.0, 0.5, 1.0)).value
    assert [text.get_text() for text in own.axes[0].texts] == [f"{100.0 * chance:.3g} %", "0 %"]


@pytest.mark.thorough
def test_samples_of_a_board_on_the_command_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    pytest.importorskip("zarr")
    monkeypatch.chdir(tmp_path)
    Path("shot.toml").write_text(as_toml(shot()))
    spreads = [word for path, one in SHOT.items() for word in ("--spread", f"{path}={one}")]
    words = ["sweep", "--scene", "shot.toml", "--random", "60", "--seed", "7", *spreads,
             "--inside", "0.8,0,0.3"]  # fmt: skip
    truth = shot().sample(60, 7, SHOT)
    for more in (["-o", "s.csv"], ["-o", "s.h5", "--plot", "s.png"], ["-o", "s.zarr"]):
        result = invoke(*words, *more)
        assert result.exit_code == 0, result.stderr
        assert result.stdout.rstrip() == truth.within((0.8, 0.0, 0.3)).summary()
        assert "60 at rest" in result.stderr
    rows = Path("s.csv").read_text().splitlines()
    assert len(rows) == 121 and rows[0].startswith("puck[1],puck_0_launch_velocity_1[m/s]")
    assert [row.split(",")[3] for row in rows[1:5]] == ["cue", "red", "cue", "red"]
    assert shot().sample(60, 7, SHOT, store="s.zarr").load() == truth
    for wrong, said in (("launch.spin", "pucks"), ("puck[7].launch.spin", "puck[7]")):
        refused = invoke(*words[:5], "--spread", f"{wrong}=normal:5:1")
        assert (refused.exit_code, said in refused.stderr) == (2, True), refused.stderr

"""Maps over scenes: the same bits however they are cut, single runs, and after any interruption."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scenes import simulate_scene, sweep_scene

from puck_tables.errors import InputError
from puck_tables.results import Map
from puck_tables.scene.entries import set_path
from puck_tables.scene.run import ENDS


def tables() -> dict[str, Any]:
    """Launches onto a wall on an incline of strips, with ranges in nested places."""
    return {
        "puck": {"radius": 0.2, "height": 0.3},
        "floor": {
            "slope": 0.05,
            "strips": {"borders": [0.5], "friction": [0.2, "0.1:0.3:3"]},
        },
        "launch": {"velocity": ["1:3:5", 0.4], "spin": "-5:5:4"},
        "wall": [{"point": [1.5, 0.0], "normal": [-1.0, 0.0], "restitution": "0.2:0.8:2"}],
        "tol": 1e-6,
    }  # fmt: skip


def same(one: Map, other: Map) -> bool:
    return np.array_equal(one.end, other.end) and all(
        np.array_equal(column, other.columns[name]) for name, column in one.columns.items()
    )


@pytest.fixture(scope="module")
def whole() -> Map:
    return sweep_scene(tables())


def test_axes_are_the_ranges(whole: Map) -> None:
    assert list(whole.axes) == [
        "floor.strips.friction[1]", "launch.velocity[0]", "launch.spin", "wall[0].restitution",
    ]  # fmt: skip
    assert whole.end.shape == (3, 5, 4, 2)


@pytest.mark.parametrize(("threads", "chunk"), [(1, 7), (2, 1), (2, 33), (3, 1000)])
def test_same_bits_however_it_is_cut(whole: Map, threads: int, chunk: int) -> None:
    assert same(whole, sweep_scene(tables(), threads=threads, chunk=chunk))


@pytest.mark.parametrize("index", [(0, 0, 0, 0), (1, 4, 2, 1), (2, 3, 3, 0)])
def test_the_same_as_single_runs(whole: Map, index: tuple[int, ...]) -> None:
    """To rounding: each is compiled for itself, and a compiler chooses where to fuse a·b + c."""
    single = tables()
    for (path, values), i in zip(whole.axes.items(), index, strict=True):
        set_path(single, path, float(values[i]))
    run = simulate_scene(single)
    for name in whole.columns.keys() & run.last.keys():
        assert whole.columns[name][index] == pytest.approx(run.last[name], abs=1e-13), name
    assert whole.columns["end_time"][index] == pytest.approx(run.end_time, abs=1e-13)
    assert whole.columns["impacts"][index] == sum(e[1] == "impact" for e in run.events)


def test_look_up_agrees_with_single_runs() -> None:
    scene = {
        "puck": {"radius": 0.2, "height": 0.3, "friction": 0.2}, "floor": {"velocity": [0.3, 0.1]},
        "launch": {"velocity": ["1:3:3", 0.4], "spin": 4.0},
    }  # fmt: skip
    ends = sweep_scene(scene)
    for i, speed in enumerate((1.0, 2.0, 3.0)):
        set_path(scene, "launch.velocity[0]", speed)
        run = simulate_scene(scene)
        for name in ("x", "y", "orientation", "vx", "vy", "heat_dry", "work_support"):
            assert ends.columns[name][i] == pytest.approx(run.last[name], rel=1e-7, abs=1e-7), name
        assert ends.columns["end_time"][i] == pytest.approx(run.end_time, rel=1e-8)


class Cut(Exception):
    """The end of the process, as far as the sweep can tell."""


def test_it_goes_on_after_an_interruption(whole: Map, tmp_path: Path) -> None:
    pytest.importorskip("zarr")
    path, calls = tmp_path / "kept.zarr", []

    def stop(done: int, total: int) -> None:
        calls.append(done)
        if done > total // 3:
            raise Cut

    with pytest.raises(Cut):
        sweep_scene(tables(), threads=1, chunk=10, store=path, progress=stop)
    assert path.exists() and calls[-1] < whole.end.size
    assert same(whole, sweep_scene(tables(), threads=2, chunk=10, store=path).load())
    assert same(whole, sweep_scene(tables(), chunk=10, store=path).load())  # nothing left to do


def test_a_scene_without_a_range_is_no_sweep() -> None:
    with pytest.raises(InputError, match="no number of the scene is a range"):
        sweep_scene({"puck": {"radius": 1.0}})


def test_a_range_with_one_bad_end_is_refused() -> None:
    scene = tables()
    scene["wall"][0]["restitution"] = "0.5:1.5:3"
    with pytest.raises(
        InputError, match=r"wall\[0\]\.restitution = '0\.5:1\.5:3': must be a range"
    ):
        sweep_scene(scene)


def test_a_range_is_no_single_run() -> None:
    with pytest.raises(InputError, match=r"launch\.spin: a range makes many runs"):
        simulate_scene({"puck": {"radius": 1.0}, "launch": {"spin": "0:1:2"}})


def test_runs_that_never_stop_get_a_status_and_the_others_go_on() -> None:
    scene = tables()
    scene["puck"]["friction"] = 0.2
    scene["floor"] = {"slope": "0:0.4:5"}
    scene["wall"] = []
    ends = sweep_scene(scene)
    steep = np.tan(ends.axes["floor.slope"]) > 0.2
    assert list(np.unique(ends.end[~steep])) == [ENDS.index("at rest")]
    assert list(np.unique(ends.end[steep])) == [ENDS.index("no end found")]
    assert np.isnan(ends.columns["x"][steep]).all() and np.isfinite(ends.columns["x"][~steep]).all()
    told = ends.without_end()
    assert len(told) == 1
    assert "60 of 100 runs: no end found; the first at floor.slope = 0.2" in told[0]
    assert "give a time" in told[0]


@pytest.mark.parametrize(
    ("path", "values", "word", "said"),
    [
        ("puck.friction", "0:0.3:4", "refused", "nothing brings the puck to rest"),
        ("puck.height", "0.1:4:5", "refused", "tips over"),
        ("launch.position[0]", "0:2:5", "refused", "reaches through it by"),
        ("launch.spin", "1:1e200:3", "refused", "too fast for floating point"),
    ],
)
def test_no_run_takes_the_others_along(path: str, values: str, word: str, said: str) -> None:
    scene: dict[str, Any] = {
        "puck": {"radius": 0.2, "friction": 0.3},
        "launch": {"velocity": [1.0, 0.0], "position": [0.0, 0.0]},
        "wall": [{"point": [1.5, 0.0], "normal": [-1.0, 0.0]}],
    }  # fmt: skip
    set_path(scene, path, values)
    ends = sweep_scene(scene)
    good = ends.end == ENDS.index("at rest")
    assert 1 <= good.sum() < ends.end.size
    assert set(ends.end[~good]) == {ENDS.index(word)}
    assert said in ends.without_end()[0]
    for i in np.flatnonzero(good):
        set_path(scene, path, float(ends.axes[path][i]))
        alone = simulate_scene(scene, [0.0])  # which may take it for a free puck
        assert ends.columns["x"][i] == pytest.approx(alone.last["x"], abs=1e-8)


def test_a_sweep_in_which_nothing_has_an_end_is_refused() -> None:
    scene = {"puck": {"radius": 1.0}, "launch": {"velocity": [1.0, 0.0], "spin": "0:1:2"}}
    with pytest.raises(InputError, match=r"every run of this sweep is refused.* puck to rest"):
        sweep_scene(scene)
    scene["puck"]["friction"] = "4:5:2"
    scene["puck"]["height"] = 1.0
    with pytest.raises(InputError, match="puck: delta = 8: a puck with delta"):
        sweep_scene(scene)

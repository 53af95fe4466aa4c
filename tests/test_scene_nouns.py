"""A scene made of the nouns that a user knows: the same puck, parts, ranges, many launches."""

from __future__ import annotations

import pickle
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray

import puck_tables as pt
from puck_tables.errors import InputError
from puck_tables.scene.entries import tables_of
from puck_tables.scene.library import as_toml

PUCK = pt.Puck(radius=0.04, height=0.02, friction=0.15, mass=0.2)
LAUNCH = pt.Launch((0.8, 0.1), spin=20.0)


def test_the_puck_of_a_scene_is_the_puck_of_free_motion() -> None:
    free = PUCK.simulate((0.8, 0.1), 20.0)
    run = pt.Scene(PUCK, launch=LAUNCH).simulate()
    assert run.scene.puck is PUCK
    unit, far = run.speed_scale / run.rate_scale, run.error_estimate + free.error_estimate
    assert run.end_time == pytest.approx(free.stop_time, abs=far * unit)
    assert (run.last["x"], run.last["y"]) == pytest.approx(
        free.stop_position, abs=far * unit * run.speed_scale
    )


def test_a_scene_says_the_same_from_python_and_from_tables() -> None:
    made = pt.Scene(
        PUCK, pt.Floor(slope=0.05), LAUNCH,
        walls=[pt.Wall((0.5, 0.0), normal=(-1.0, 0.0), restitution=0.5)],
    )  # fmt: skip
    tables = {
        "puck": {"radius": 0.04, "height": 0.02, "friction": 0.15, "mass": 0.2},
        "floor": {"slope": 0.05}, "launch": {"velocity": [0.8, 0.1], "spin": 20.0},
        "wall": [{"point": [0.5, 0.0], "normal": [-1.0, 0.0], "restitution": 0.5}],
    }  # fmt: skip
    assert made == pt.Scene.from_tables(tables)
    assert made != replace(made, title="another")
    assert pt.Scene.from_tables(tables_of(made)) == made
    assert pickle.loads(pickle.dumps(made)) == made


@pytest.mark.parametrize(
    "spins", ["0:20:3", [0.0, 10.0, 20.0], (0, 10, 20), np.array([0.0, 10.0, 20.0])]
)
def test_a_list_or_an_array_where_a_number_stands_is_a_range(spins: object) -> None:
    scene = pt.Scene(PUCK, launch=pt.Launch((0.8, 0.1), spin=spins))  # type: ignore[arg-type]
    assert scene.ranges["launch.spin"].tolist() == [0.0, 10.0, 20.0]
    assert scene.launch.spin == 0.0
    with pytest.raises(pt.InputError, match=r"launch\.spin: a range makes many runs"):
        scene.simulate()
    one_by_one = [scene.at({"launch.spin": w}).simulate([0.0]).last["x"] for w in (0.0, 10.0, 20.0)]
    assert np.abs(scene.sweep().x - one_by_one).max() <= 1e-9


def test_numbers_of_the_puck_range_by_their_path_and_survive_a_change() -> None:
    heights = [0.0, 0.01, 0.02]
    scene = replace(pt.Scene(PUCK, launch=LAUNCH, ranges={"puck.height": heights}), title="heights")
    assert scene.ranges["puck.height"].tolist() == heights and scene.puck.height == 0.0
    stops = scene.sweep()
    alone = [float(replace(PUCK, height=h).stop((0.8, 0.1), 20.0).stop_time) for h in heights]
    assert stops.end_time.tolist() == pytest.approx(alone, abs=1e-9)


def test_a_range_that_is_not_even_is_written_as_a_list() -> None:
    scene = pt.Scene(PUCK, launch=pt.Launch(spin=[0.0, 1.0, 5.0]))  # type: ignore[arg-type]
    assert "spin = [0.0, 1.0, 5.0]" in as_toml(scene)


def test_many_launches_go_one_by_one(tmp_path: Path) -> None:
    velocities = np.array([[0.8, 0.1], [0.2, -0.5], [0.0, 0.3]])
    spins, places = [20.0, -5.0, 0.0], [[0.0, 0.0], [0.1, 0.0], [0.0, 0.2]]
    floor = pt.Floor(slope=0.05)
    scene = pt.Scene(PUCK, floor, pt.Launch(velocities, spins, places))  # type: ignore[arg-type]
    stops = scene.sweep()
    assert stops.x.shape == (3,)
    for n in range(3):
        launch = pt.Launch(tuple(velocities[n]), spins[n], tuple(places[n]))
        run = pt.Scene(PUCK, floor, launch).simulate([0.0])
        assert stops.end_time[n] == pytest.approx(run.end_time, abs=1e-9)
        assert stops.y[n] == pytest.approx(run.last["y"], abs=1e-9)
    again = pt.Scene.from_tables({**tables_of(scene), "launch": {
        "velocity": velocities.tolist(), "spin": spins, "position": places,
    }})  # fmt: skip
    assert again == scene
    assert replace(scene, title="").ranges["launch"].tolist() == scene.ranges["launch"].tolist()
    stops.save(tmp_path / "stops.h5")
    with xarray.open_dataset(tmp_path / "stops.h5") as data:
        assert data["launch_spin"].values.tolist() == spins
        assert data["launch_spin"].dims == ("launch",)


def test_many_launches_beside_a_range_are_its_product_also_where_each_is_checked() -> None:
    velocities = [[0.4, 0.0], [0.0, 0.6]]
    wall = pt.Wall((0.05, 0.0), normal=(-1.0, 0.0), restitution=0.5)
    scene = pt.Scene(
        PUCK,
        pt.Floor(slope=[0.0, 0.05]),
        pt.Launch(velocities, [1.0, 2.0]),
        walls=[wall],  # type: ignore[arg-type]
    )
    stops = scene.sweep()
    assert stops.x.shape == (2, 2) and list(stops.axes) == ["launch", "floor.slope"]
    run = pt.Scene(PUCK, pt.Floor(slope=0.05), pt.Launch((0.4, 0.0), 1.0), walls=[wall]).simulate()
    assert stops.x[0, 1] == pytest.approx(run.last["x"], abs=1e-9)
    assert stops.impacts[0, 1] == len([e for e in run.events if e.what == "impact"])


def test_launches_of_different_number_are_refused() -> None:
    with pytest.raises(pt.InputError, match=r"launch\.spin: 3 values for 2 launches: give one"):
        pt.Scene(PUCK, launch=pt.Launch([[1.0, 0.0], [2.0, 0.0]], spin=[1.0, 2.0, 3.0]))  # type: ignore[arg-type]
    with pytest.raises(pt.InputError, match="must be rows of vx, vy, spin, x, y"):
        pt.Scene(PUCK, ranges={"launch": np.zeros((3, 2))})


def test_rows_stand_where_a_file_may_be_named(tmp_path: Path) -> None:
    force, law = [[0.0, 0.02, 0.0], [1.0, 0.0, 0.01]], [[0.0, 0.2], [0.5, 0.15], [2.0, 0.15]]
    ends = []
    for named in (False, True):
        for name, rows in (("force", force), ("law", law)):
            np.savetxt(tmp_path / f"{name}.csv", rows, delimiter=",", fmt="%.17g")
        over_time = str(tmp_path / "force.csv") if named else np.array(force)
        by_speed = str(tmp_path / "law.csv") if named else law
        scene = pt.Scene(
            PUCK, pt.Floor(law=by_speed), LAUNCH, force=pt.Force(over_time=over_time),  # type: ignore[arg-type]
            tol=1e-5,
        )  # fmt: skip
        assert named or pt.Scene.from_tables(tables_of(scene)) == scene
        ends.append(scene.simulate([0.0]).last)
    assert ends[0] == ends[1]


def test_a_pressure_law_of_ones_own_stands_in_a_scene() -> None:
    law = pt.profile_law([0.0, 1.0], [1.0, 0.2])
    puck = replace(PUCK, pressure=law)
    run = pt.Scene(puck, launch=LAUNCH).simulate([0.0])
    assert run.end_time == pytest.approx(float(puck.stop((0.8, 0.1), 20.0).stop_time), abs=1e-8)


def test_what_is_wrong_is_told_when_the_scene_is_made() -> None:
    with pytest.raises(pt.InputError) as caught:
        pt.Scene(
            PUCK,
            pt.Floor(slope=[0.1, 7.0], downhill=np.ma.array([1.0, 2.0], mask=[0, 1])),  # type: ignore[arg-type]
            pt.Launch(spin=[]),  # type: ignore[arg-type]
        )
    lines = str(caught.value).splitlines()
    assert lines[0] == "scene: 3 errors"
    assert "floor.slope[1] = 7.0: must be a number >= 0 and < 1.5708 rad" in lines[1]
    assert "floor.downhill[1] = masked" in lines[2]
    assert "launch.spin = []: must be a number in rad/s, or a list of 1 to" in lines[3]


def test_a_puck_without_friction_is_for_scenes() -> None:
    puck = pt.Puck(0.04)
    for ask in (puck.simulate, puck.stop):
        with pytest.raises(pt.InputError, match="a puck with friction = 0 never stops"):
            ask((1.0, 0.0))
    run = pt.Scene(puck, launch=LAUNCH, time=2.0).simulate()
    assert run.last["x"] == pytest.approx(1.6, rel=1e-12)


def test_a_changed_copy_keeps_the_ranges_of_the_parts_that_it_keeps() -> None:
    scene = pt.Scene(PUCK, pt.Floor(slope=[0.0, 0.05]), pt.Launch([[1, 0], [0, 1]]))  # type: ignore[arg-type]
    assert list(replace(scene, title="a").ranges) == ["launch", "floor.slope"]
    other = replace(scene, floor=pt.Floor(slope=[0.1, 0.2]))  # type: ignore[arg-type]
    assert other.ranges["floor.slope"].tolist() == [0.1, 0.2]
    assert list(replace(scene, floor=pt.Floor(slope=0.1)).ranges) == ["launch"]
    assert list(replace(scene, launch=pt.Launch((1.0, 0.0))).ranges) == ["floor.slope"]
    assert replace(scene, launch=pt.Launch([[3, 0], [4, 0]])).ranges["launch"][0, 0] == 3.0  # type: ignore[arg-type]
    again = pickle.loads(pickle.dumps(scene))
    assert again == scene and list(replace(again, title="b").ranges) == list(scene.ranges)


@pytest.mark.parametrize(
    ("parts", "words"),
    [
        ({"floor": pt.Floor(slope=[0.0, 0.1]), "ranges": {"floor.slope": [0.2]}}, "slope: given"),
        ({"launch": pt.Launch([[1, 0]], [1]), "ranges": {"launch.spin": [3]}}, "spin: given"),
        ({"launch": pt.Launch([[1, 0]]), "ranges": {"launch": np.ones((2, 6))}}, "launch: given"),
        ({"constraint": pt.Constraint("rail", side_slip=1.0)}, "side_slip: a rail has none"),
        ({"constraint": pt.Constraint("blade", reach=3.0)}, "reach: a blade has none"),
        ({"launch": pt.Launch([[1, 0], [1]])}, r"launch.velocity = .* rows of two"),
        ({"launch": pt.Launch(([1, 2, 3], [0, 1, 2]))}, r"launch.velocity = .* rows of two"),
        ({"floor": pt.Floor(velocity=[[1, 0], [0, 1]])}, "not rows of them"),
        ({"floor": pt.Floor(law=[[0.0, 0.1]])}, "floor.law: speeds and values"),
        ({"force": pt.Force(over_time=[[1, 0, 0], [0, 0, 0]])}, "row 2: 0 after 1: the times must"),
        ({"ranges": {3: [1]}}, "ranges must be a mapping from paths"),
        ({"walls": pt.Wall((1, 0), normal=(1, 0))}, r"a list of tables, \[\[wall\]\], or of Wall"),
        ({"floor": None}, "floor = None: must be a table or a Floor"),
        ({"edges": [1]}, r"edge\[0\] = 1: must be a table or an Edge"),
    ],
)  # fmt: skip
def test_what_contradicts_or_means_nothing_is_refused(parts: dict, words: str) -> None:
    with pytest.raises(pt.InputError, match=words):
        pt.Scene(PUCK, **parts)


def test_many_launches_beside_a_range_stand_whole_in_a_table(tmp_path: Path) -> None:
    launches = pt.Launch([[0.8, 0.5], [0.2, 0.9]], spin=[60.0, -20.0])  # type: ignore[arg-type]
    stops = pt.Scene(PUCK, pt.Floor(slope=[0.0, 0.05, 0.1]), launches).sweep()  # type: ignore[arg-type]
    table = stops.to_pandas()
    assert len(table) == 6
    assert table["launch_spin"].tolist() == [60.0] * 3 + [-20.0] * 3
    assert table["floor_slope"].tolist() == [0.0, 0.05, 0.1] * 2
    assert table["x"].tolist() == stops.x.ravel().tolist()
    stops.save(tmp_path / "stops.csv")
    assert len((tmp_path / "stops.csv").read_text().splitlines()) == 7
    assert stops.to_pandas().columns.tolist()[:2] == ["launch", "floor_slope"]


def test_a_second_place_of_an_edge_is_refused_with_what_to_write():
    """Both normals that are named stand across the line through both places."""
    rng = np.random.default_rng(35)
    for _ in range(20):
        ends = (rng.normal(size=(2, 2)) * 10.0 ** rng.integers(-3, 3)).round(6)
        first, second = (tuple(end.tolist()) for end in ends)
        with pytest.raises(InputError) as refused:
            pt.Edge(first, second)
        said = str(refused.value)
        assert f"write Edge({first!r}, normal={second!r})" in said
        across = np.array(re.findall(r"\((-?[\d.e+-]+), (-?[\d.e+-]+)\)", said)[-2:], float)
        assert np.abs(across @ (ends[1] - ends[0])).max() < 1e-4 * (across**2).sum()
        assert (across[0] == -across[1]).all()
    for odd in (0.5, "plastic:0.1", (1.0,), None, ("a", "b")):
        with pytest.raises(InputError, match="write Edge"):
            pt.Edge((0.0, 0.0), odd)


@pytest.mark.parametrize("length", [1e-9, 3.0, 1e12])
def test_a_normal_has_any_length(length: float):
    given = np.random.default_rng(7).normal(size=2)
    given /= np.hypot(*given)
    ends = []
    for long in (1.0, length):
        wall = pt.Wall(tuple(-0.3 * given), normal=tuple(long * given), restitution=0.5)
        puck = pt.Puck(radius=0.04, friction=0.1)
        start = pt.Launch(velocity=tuple(-given), spin=4.0)
        ends.append(pt.Scene(puck, launch=start, walls=[wall]).simulate().last)
    assert [ends[0][name] for name in ("x", "y")] == pytest.approx(
        [ends[1][name] for name in ("x", "y")], rel=1e-9
    )


def test_a_puck_of_a_board_is_a_puck():
    free, sent = pt.Puck(0.03, friction=0.1), pt.Launch((1.0, 0.0))
    puck = pt.Puck(0.03, friction=0.1, name="red", launch=sent)
    assert repr(puck).startswith("Puck(radius=0.03, friction=0.1, ")
    assert "colour" not in repr(puck)
    assert puck.stop((1.0, 0.0)).stop_time == free.stop((1.0, 0.0)).stop_time
    with pytest.raises(InputError, match=r"its own name, launch: .* beside it, Scene\(puck, la"):
        pt.Scene(puck)
    alone, board = pt.Scene(free, launch=sent).simulate(), pt.Scene(pucks=[puck]).simulate()
    assert alone.last["x"] == board.last["x"][0]


FORCED = [
    {"force": pt.Force((0.0, 0.1))}, {"path": [[0, 0, 0]]}, {"constraint": pt.Constraint("rail")},
]  # fmt: skip


@pytest.mark.parametrize("what", FORCED, ids=lambda what: next(iter(what)))
@pytest.mark.parametrize("verb", ["simulate", "stop", "states", "sweep", "sample", "aim"])
def test_what_moves_a_puck_besides_friction_is_not_left_out(what: dict, verb: str):
    puck = pt.Puck(0.03, friction=0.1, **what)
    asked = {
        "states": {"velocity": (1.0, 0.0), "spin": 0.0, "time": 0.1},
        "sweep": {"speed": [1.0, 2.0]}, "aim": {"target": (1.0, 0.0)},
        "sample": {"speed": pt.Normal(1.0, 0.1), "count": 9},
    }  # fmt: skip
    with pytest.raises(InputError, match=f"has a {next(iter(what))}, which acts in a scene alone"):
        getattr(puck, verb)(**asked.get(verb, {"velocity": (1.0, 0.0)}))

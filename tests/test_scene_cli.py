"""Scenes from the command line: every scene that comes along, options, ranges, refusals, files."""

import json
import tomllib

import numpy as np
import pytest
import xarray
from commands import invoke
from scenes import simulate_scene

from puck_tables.scene.library import find_scene, shipped_scenes

ENDS = {
    **dict.fromkeys(("air-hockey", "air-hockey-mallet", "air-table", "turntable"), "time is up"),
    "washer-on-conveyor": "carried",
}


@pytest.mark.thorough
@pytest.mark.parametrize("name", shipped_scenes())
def test_every_scene_that_comes_along_runs_and_its_ledger_closes(name, tmp_path):
    picture = tmp_path / "scene.png"
    result = invoke("simulate", "--scene", name, "--json", "--plot", picture)
    assert result.exit_code == 0, result.stderr
    told = json.loads(result.stdout)
    assert told["energy_residual"] < max(1e-8, told["scene"]["tol"])
    assert told["end"].startswith(ENDS.get(name, "at rest"))
    assert picture.stat().st_size > 10_000
    assert invoke("scene", "check", name).exit_code == 0


def test_scenes_are_listed_and_shown():
    listed = invoke("scene", "list").stdout
    assert len(listed.splitlines()) == len(shipped_scenes()) >= 9
    assert 'title = "Puck on an incline"' in invoke("scene", "show", "incline").stdout


def test_options_are_numbers_of_the_scene():
    by_option = invoke(
        "simulate", "--scene", "incline", "--w0", "30", "--friction", "0.2", "--json"
    )
    changes = ("--set", "launch.spin=30", "--set", "puck.friction=0.2")
    by_set = invoke("simulate", "--scene", "incline", *changes, "--json")
    assert by_option.stdout == by_set.stdout != ""
    plain = invoke("simulate", "--v0", "1,0", "--w0", "5", "--json")
    scene = invoke("simulate", "--v0", "1,0", "--w0", "5", "--set", "puck.mass=1", "--json")
    assert json.loads(scene.stdout)["x"] == pytest.approx(
        json.loads(plain.stdout)["stop_position"][0], rel=1e-9
    )


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("simulate", "--scene", "nowhere"), "no file nowhere"),
        (("simulate", "--scene", "incline", "--set", "x"), "PATH=VALUE"),
        (("simulate", "--scene", "incline", "--set", "floor.slop=1"), "floor.slop: no such entry"),
        (("simulate", "--scene", "incline", "--set", "wall[3].x=1"), "no such entry to set"),
        (("simulate", "--scene", "incline", "--set", "launch.spin=0:1:5"), "run a sweep"),
        (("simulate", "--scene", "incline", "--exact"), "--exact has no place in a scene"),
        (("simulate", "--scene", "incline", "--set", "floor.slope=0.5"), "it may never stop"),
        (("sweep", "--scene", "incline"), "no number of the scene is a range"),
        (("scene", "show", "nothing"), "there are air-hockey"),
        (("simulate", "--scene", "pivoted-disc", "--v0", "1,1"), "the pivot allows"),
        (("simulate", "--scene", "air-hockey", "--set", "launch.position=[9,9]"), "wall[1]"),
    ],
)
def test_refusals_are_one_clear_sentence(arguments, words):
    result = invoke(*arguments)
    assert result.exit_code == 2
    assert words in result.stderr
    assert "Traceback" not in result.stderr


def test_a_base_beside_set_is_that_of_the_scene():
    belt = ("--v0", "0,0", "--set", "floor.velocity=[0.3,0]")
    result = invoke("simulate", "--base", "box:10cmx6cm", "--friction", "0.4", *belt)
    assert "base box:10cmx6cm" in result.stdout and "f g = 3.92266 m/s^2" in result.stdout
    assert f"carried by the floor after {0.3 / (0.4 * 9.80665):.9g} s" in result.stdout
    for more, words in ((("--delta", "1"), "--base and --delta clash"), ((), "0.3 s")):
        result = invoke("simulate", "--base", "box:10cmx6cm", *more, *belt)
        assert words in result.stdout + result.stderr


def test_a_map_over_a_scene_opens_in_xarray_and_equals_single_runs(tmp_path):
    file = tmp_path / "map.h5"
    ranges = ("--set", "floor.slope=0:0.1:3", "--w0", "0:60:4")
    result = invoke("sweep", "--scene", "incline", *ranges, "-o", file)
    assert result.exit_code == 0, result.stderr
    assert list(tmp_path.iterdir()) == [file]
    with xarray.open_dataset(file, engine="h5netcdf") as data:
        assert data["x"].shape == (3, 4)
        tables = find_scene("incline")
        tables["floor"]["slope"], tables["launch"]["spin"] = 0.05, 40.0
        single = simulate_scene(tables, [0.0])
        unit = single.speed_scale / single.rate_scale
        far = 2.0 * single.scene.tol * unit
        assert float(data["end_time"][1, 2]) == pytest.approx(single.end_time, abs=far)
        far *= single.speed_scale
        assert float(data["x"][1, 2]) == pytest.approx(single.last["x"], abs=far)
    table = invoke("sweep", "--scene", "incline", *ranges)
    assert table.stdout.splitlines()[0].startswith("floor_slope[rad],launch_spin[rad/s],x[m]")
    assert len(table.stdout.splitlines()) == 13
    assert "12 at rest" in table.stderr


def test_states_of_a_scene_as_files(tmp_path):
    for ending in (".h5", ".csv", ".jsonl"):
        file = tmp_path / f"run{ending}"
        assert invoke("simulate", "--scene", "incline", "--frames", "5", "-o", file).exit_code == 0
        again = invoke("simulate", "--scene", "incline", "-o", file)
        assert again.exit_code == 1
        assert "exists" in again.stderr
    assert len((tmp_path / "run.csv").read_text().splitlines()) == 6
    with xarray.open_dataset(tmp_path / "run.h5", engine="h5netcdf") as data:
        rows = [json.loads(line) for line in (tmp_path / "run.jsonl").read_text().splitlines()]
        assert np.array_equal(data["heat_dry"], [row["heat_dry"] for row in rows])
        kept = tomllib.loads(data["scene"].item())
        assert simulate_scene(kept, [0.0]).end_time == data.attrs["end_time"]


@pytest.mark.thorough
def test_the_curve_of_an_asperity_is_the_friction_law_of_a_scene(tmp_path):
    law = tmp_path / "rough.csv"
    rough = ("--amplitude", "1e-5", "--wavelength", "1e-3", "--speeds", "0:0.2:21")
    assert invoke("asperity", *rough, "--law", law).exit_code == 0
    scene = tmp_path / "rough.toml"
    scene.write_text(
        "[puck]\nradius = 0.01\n[floor]\nlaw = 'rough.csv'\n"  # beside the scene
        "[launch]\nvelocity = [0.09, 0.0]\nspin = 9.0\n"
    )
    result = invoke("simulate", "--scene", scene, "--json", "--explain")
    assert result.exit_code == 0, result.stderr
    told = json.loads(result.stdout)
    assert (told["end"], told["energy_residual"] < 1e-8) == ("at rest", True)
    assert "integrated from impact to impact: friction law" in result.stderr
    slow = f"{0.9 * 2 * np.pi * 1e-5 / 1e-3}"  # Coulomb's a/b is a bound for the slow ones
    assert told["end_time"] < 0.18 / (float(slow) * 9.80665)
    fast = invoke("simulate", "--scene", scene, "--set", "launch.velocity=[0.3,0]")
    assert fast.exit_code == 2
    assert "0.2 m/s" in fast.stderr

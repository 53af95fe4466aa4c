"""Files of scenes say all: units, meanings, and the scene itself with the files that it names."""

from __future__ import annotations

import json
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray
from commands import invoke
from scenes import simulate_scene, sweep_scene

from puck_tables import InputError, Scene
from puck_tables.scene.library import read_scene
from puck_tables.scene.run import ENDS

FORCE = "t,Fx,Fy\n0,0.1,0\n# Gewicht\n1,0,0\n"


def tables(folder: Path) -> dict[str, Any]:
    (folder / "force.csv").write_text(FORCE)
    return {
        "title": "Ünter einer Kraft",
        "puck": {"radius": 0.04, "mass": 0.2, "gyration": "0.5:0.9:3", "friction": 0.2},
        "floor": {"slope": "0:0.4:3"},
        "launch": {"velocity": [1.0, 0.3], "spin": "0:30:2"},
        "force": {"over_time": str(folder / "force.csv")},
    }


def test_a_map_has_units_meanings_and_its_scene(tmp_path: Path) -> None:
    stops = sweep_scene(tables(tmp_path))
    stops.save(tmp_path / "map.h5")
    with xarray.open_dataset(tmp_path / "map.h5", engine="h5netcdf") as data:
        assert data["floor_slope"].attrs["units"] == "rad"
        assert data["launch_spin"].attrs["units"] == "rad/s"
        assert data["puck_gyration"].attrs["units"] == "1"
        assert "radius of gyration" in data["puck_gyration"].attrs["long_name"]
        meanings = data["end"].attrs["flag_meanings"].split()
        assert len(meanings) == len(data["end"].attrs["flag_values"]) == len(ENDS)
        found = {meanings[code] for code in np.unique(data["end"])}
        assert found == {"at_rest", "no_end_found"}
        assert data["force_over_time"].item() == FORCE
        kept = tomllib.loads(data["scene"].item())
    assert kept["title"] == "Ünter einer Kraft"
    again = sweep_scene(kept)
    assert np.array_equal(again.columns["x"], stops.columns["x"], equal_nan=True)
    stops.save(tmp_path / "map.csv")
    head = (tmp_path / "map.csv").read_text().splitlines()[0]
    assert head.startswith("puck_gyration[1],floor_slope[rad],launch_spin[rad/s],x[m]")


def test_a_run_has_its_scene_however_long(tmp_path: Path) -> None:
    wall = {"point": [90.123456789, 0.0], "normal": [-1.0, 0.123456789]}
    scene = {**tables(tmp_path), "wall": [wall] * 1500}  # 64 kB is the most of an attribute
    scene["puck"]["gyration"], scene["floor"]["slope"], scene["launch"]["spin"] = 0.5, 0.1, 3.0
    run = simulate_scene(scene)
    run.save(tmp_path / "run.h5")
    with xarray.open_dataset(tmp_path / "run.h5", engine="h5netcdf") as data:
        assert len(data["scene"].item()) > 1 << 16
        assert data["force_over_time"].item() == FORCE
        assert Scene.from_tables(tomllib.loads(data["scene"].item())) == run.scene
    (tmp_path / "force.csv").write_text("t,Fx,Fy\n0,9,0\n1,0,0\n")
    run.save(tmp_path / "later.h5")  # what was run, not what stands there now
    with xarray.open_dataset(tmp_path / "later.h5", engine="h5netcdf") as data:
        assert data["force_over_time"].item() == FORCE


def test_json_and_report_carry_inputs_and_units() -> None:
    told = invoke("simulate", "--scene", "air-hockey", "--json")
    run = json.loads(told.stdout)
    assert run["scene"]["wall"][1]["restitution"] == 0.85
    units = run["units"]
    assert (units["heat_dry"], units["spin"], units["scene.wall.point"]) == ("J", "rad/s", "m")
    numbers = {name for name, value in run.items() if isinstance(value, float)}
    assert numbers - {"energy_residual", "error_estimate"} <= set(units)
    assert simulate_scene(run["scene"], [0.0]).last["x"] == run["x"]
    text = invoke("simulate", "--scene", "air-hockey").stdout
    for part in (
        "launch     velocity (2, 1.3) m/s, spin -30 rad/s", "drag       sliding 0.006 kg/s",
        "wall[3]    point (0, 1) m", "time       10 s",
    ):  # fmt: skip
        assert part in text


def test_the_command_names_the_runs_without_an_end() -> None:
    steep = ("--set", "floor.slope=0.1:0.3:3", "--set", "launch.spin=30")
    result = invoke("sweep", "--scene", "incline", *steep)
    assert result.exit_code == 0
    assert "1 at rest, 2 no end found" in result.stderr
    assert "2 of 3 runs: no end found; the first at floor.slope = 0.2: none by" in result.stderr
    assert result.stdout.count("no end found") == 2


def test_a_scene_written_by_powershell_is_read(tmp_path: Path) -> None:
    """Its '>' writes UTF-16 with a mark of the order of its bytes, and line ends of its own."""
    text = invoke("scene", "show", "incline").stdout.replace("\n", "\r\n")
    for name, content in (
        ("le", text.encode("utf-16")),
        ("be", b"\xfe\xff" + text.encode("utf-16-be")),
    ):
        (tmp_path / f"{name}.toml").write_bytes(content)
        assert Scene.load(tmp_path / f"{name}.toml") == Scene.load("incline")


def test_a_key_of_very_many_parts_is_refused_at_once(tmp_path: Path) -> None:
    rng = np.random.default_rng(17)
    for n in range(6):
        parts = [["a", '"b c"', "puck", "'x'"][k] for k in rng.integers(0, 4, 30_000)]
        key = [".", " . "][n % 2].join(parts)
        text = [f"{key} = 1", f"[{key}]\n", f"a = {{ {key} = 1 }}"][n % 3]
        (tmp_path / "deep.toml").write_text(f"title = 'a.b.c'\n# {'.' * 200}\n{text}\n")
        with pytest.raises(InputError, match="a key in it has more than 50 parts"):
            read_scene(tmp_path / "deep.toml")
    (tmp_path / "plain.toml").write_text(f"# {'.' * 200}\ntitle = '{'v1.2 ' * 30}'\n")
    assert read_scene(tmp_path / "plain.toml")["title"].startswith("v1.2")

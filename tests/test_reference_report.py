"""What puck reference prints, saves and draws of a case."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
from commands import invoke

from puck_tables import floor_friction, reference_case
from puck_tables.reference.case_text import lines_of


@pytest.mark.parametrize(
    "asked", [["coin", "--dt", "0.02"], ["coin", "--epsilon", "0:2:5"], ["take-out", "--fps", "9"]]
)
def test_json_on_stdout_has_the_columns_of_the_file(asked: list[str], tmp_path: Path):
    path = tmp_path / "a.json"
    result = invoke("reference", *asked, "--json", "-o", path)
    assert result.exit_code == 0, result.output
    told, saved = json.loads(result.stdout), json.loads(path.read_text())
    assert told["columns"] == saved["columns"]
    assert told["case"] == asked[0] and len(told["columns"]) > 8


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("annulus", f"pressure annulus:0.5, gyration {math.sqrt(0.625)!r} r"),
        ("incline-at", f"slope = {math.atan(0.2)!r} rad, downhill = {-0.5 * math.pi!r} rad"),
        ("belt", "velocity = [0.5, 0] m/s"),
        ("turntable", "turning = 4 rad/s"),
        ("astride-stop", "borders = [0.1, 0.16] m, strips.friction = [0.15, 0.4, 0.1], "
         "strips.direction = 0 rad"),
        ("take-out", "delta = 0.016, restitution = 0.9, tangential = 0, rim = 0.1"),
        ("take-out", "m after 0.3716080056"),
        ("rebound", "point = [0.2, 0] m, normal = [-1, 0], restitution = 0.8"),
    ],
)  # fmt: skip
def test_the_numbers_of_a_case_have_all_digits_and_units(name: str, words: str):
    assert words in "\n".join(lines_of(reference_case(name, times=[0.0])).values())
    told = "".join(lines_of(reference_case("coin", times=[0.0])).values())
    assert "pressure" not in told and "gyration" not in told


@pytest.mark.parametrize(
    ("name", "labels", "outlines"),
    [
        ("coin", {"launch", "at rest"}, 2),
        ("astride-stop", {"f = 0.15", "f = 0.4", "f = 0.1"}, 2),
        ("rebound", {"wall", "impact of the rim"}, 3),
        ("take-out", {"red", "yellow", "impact"}, 4),
    ],
)
def test_pictures_show_floor_walls_and_pucks(name: str, labels: set[str], outlines: int):
    answer = reference_case(name)
    plane = answer.plot().axes[0]
    assert plane.get_aspect() == 1.0
    assert labels <= set(plane.get_legend_handles_labels()[1])
    drawn = [(one.get_path(), one.get_patch_transform()) for one in plane.patches]
    widths = [np.ptp(part[:, 0]) for path, there in drawn for part in path.to_polygons(there)]
    assert np.isclose(widths, 2 * answer.pucks[0].radius, rtol=1e-3).sum() == outlines


def test_pictures_show_the_bend_and_no_rounding():
    """The coin's bend of 0.07 mm fills its panel; a path along y has no width of 1e-19 m."""
    low, high = reference_case("coin").plot().axes[1].get_ylim()
    assert 7.3e-5 < high - low < 9e-5
    low, high = reference_case("astride-spin").plot().axes[1].get_xlim()
    assert high - low > 1e-5


def test_rows_left_out_are_said():
    told = invoke("reference", "coin", "--friction").stdout.splitlines()
    assert told[-1].startswith("one row in 4 of 81: ") and len(told) == 2 + 21 + 1
    whole = invoke("reference", "coin", "--epsilon", "0:2:20").stdout
    assert len(whole.splitlines()) == 2 + 20


@pytest.mark.parametrize("ending", ["csv", "json", "jsonl", "h5"])
def test_every_file_has_its_bounds(ending: str, tmp_path: Path):
    answer = reference_case("take-out", dt=0.2)
    path = tmp_path / f"a.{ending}"
    answer.save(path)
    if ending == "csv":
        lines = path.read_text().splitlines()
        assert lines[0].endswith("time_bound[s],place_bound[m],speed_bound[m/s]")
        assert len(lines) == 1 + 2 * answer.time.size
        assert all("take-out (version 1)" in line for line in lines[1:])
    elif ending == "json":
        whole = json.loads(path.read_text())
        assert whole["columns"]["place_bound"] == {
            "unit": "m", "long_name": "what places, and r times angles, may at most be wrong by",
            "dims": [],
            "values": answer.place_bound,
        }  # fmt: skip
        assert (whole["case"], whole["version"]) == ("take-out", 1)
    elif ending == "jsonl":
        first = json.loads(path.read_text().splitlines()[0])
        assert first["time_bound"] == answer.time_bound
        assert first["case"] == "take-out (version 1)"
    else:
        import h5py

        with h5py.File(path) as file:
            assert file["place_bound"][()] == answer.place_bound
            assert file["epsilon"].shape == (answer.time.size, 2)
            assert (file.attrs["case"], file.attrs["version"]) == ("take-out", 1)


def test_rows_of_forces_name_their_case(tmp_path: Path):
    floor_friction("coin", [1.0]).save(tmp_path / "a.csv")
    head, row = (tmp_path / "a.csv").read_text().splitlines()
    assert dict(zip(head.split(","), row.split(","), strict=True))["case"] == "coin (version 1)"

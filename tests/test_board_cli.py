"""Scenes of several pucks from the command line: reports, files, changes, refusals."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest
import xarray
from commands import invoke

from puck_tables import Scene


def test_a_report_says_first_what_happened() -> None:
    said = invoke("simulate", "--scene", "carrom-break").stdout
    run = Scene.load("carrom-break").simulate()
    first, second = said.splitlines()[:2]
    told = f"18 of 20 pucks come to rest after {run.end_time:.4g} s and {run.impacts} impacts."
    assert first == told
    assert second == "2 fall into pockets (white 1, black 2)."
    rows = {line[:9].strip(): line for line in said.splitlines()}
    assert f"in pocket 1 at {run.stop_times[0]:.6g} s" in rows["white 1"]
    striker = run.names.index("striker")
    assert f"{run.last['x'][striker]:.6g}" in rows["striker"]
    assert f"stops at {run.stop_times[striker]:.6g} s" in rows["striker"]
    assert f"{run.last['heat_impact']:.6g} J impacts; ledger misses under 1e-14 of it" in said


def test_what_still_moves_and_what_is_driven_is_told() -> None:
    said = invoke("simulate", "--scene", "air-hockey-mallet").stdout
    assert said.startswith("Time is up after 3 s and 12 impacts: 1 puck still moves.")
    assert "None leaves play." in said and "  driven\n" in said and " m/s\n" in said


def test_a_driven_mallet_comes_not_to_rest_and_goals_are_told() -> None:
    said = invoke("simulate", "--scene", "air-hockey-goals").stdout
    assert said.startswith("No puck is left after 3 s and 2 impacts.\n1 goes over an edge (puck).")
    assert "\nline at 1.00893 s: puck and right goal, " in said


def test_what_nobody_can_know_is_said(tmp_path: Path) -> None:
    rows = ["time = 60.0\n[drag]\nsliding = 1e-6\n"]
    for n in range(6):
        rows.append(f'[[puck]]\nradius = 0.05\nname = "{n}"\n[puck.launch]\n'
                    f"position = [{0.2 * n + 0.1}, {0.3 + 0.07 * n}]\n"
                    f"velocity = [{1.0 - 0.3 * n}, {0.5 + 0.1 * n}]\n")  # fmt: skip
    for point, normal in (("[0,0]", "[1,0]"), ("[1.2,1]", "[-1,0]"), ("[0,0]", "[0,1]"),
                          ("[0,1]", "[0,-1]")):  # fmt: skip
        rows.append(f"[[wall]]\npoint = {point}\nnormal = {normal}\n")
    (tmp_path / "gas.toml").write_text("\n".join(rows))
    said = invoke("simulate", "--scene", tmp_path / "gas.toml")
    assert said.exit_code == 0, said.stderr
    assert "nobody can know the end: launches that differ by 1e-9 end up to" in said.stdout


def test_nothing_moves() -> None:
    still = ("--set", "puck[0].launch.velocity=[0,0]")
    said = invoke("simulate", "--scene", "newtons-row", *still).stdout
    assert said.splitlines()[:2] == [
        "6 pucks: nothing moves.", "Send one off: --set puck[0].launch.velocity=[1,0]"
    ]  # fmt: skip


def test_numbers_of_a_puck_are_set_by_its_number() -> None:
    changed = invoke("simulate", "--scene", "newtons-row", "--set", "puck[0].launch.velocity=[2,0]",
                   "--json")  # fmt: skip
    told = json.loads(changed.stdout)
    run = Scene.load("newtons-row").at({"puck[0].launch.velocity": [2.0, 0.0]}).simulate()
    assert told["end_time"] == run.end_time
    assert [one["x"] for one in told["pucks"]] == run.last["x"].tolist()
    assert [one["stop_time"] for one in told["pucks"]] == run.stop_times.tolist()
    moving = json.loads(invoke("simulate", "--scene", "air-table", "--json").stdout)
    assert [one["stop_time"] for one in moving["pucks"]] == [None, None]


@pytest.mark.parametrize("ending", ["h5", "csv", "jsonl", "parquet"])
def test_states_go_into_files(tmp_path: Path, ending: str) -> None:
    file = tmp_path / f"run.{ending}"
    ended = invoke("simulate", "--scene", "air-table", "--times", "0:2:5", "-o", file)
    assert ended.exit_code == 0, ended.stderr
    run = Scene.load("air-table").simulate([0.0, 0.5, 1.0, 1.5, 2.0])
    if ending == "h5":
        with xarray.open_dataset(file, engine="h5netcdf") as found:
            assert found.x.dims == ("time", "puck") and (found.x == run.x).all()
    elif ending == "parquet":
        import pandas

        assert len(pandas.read_parquet(file)) == 10
    else:
        assert len(file.read_text().splitlines()) == 10 + (ending == "csv")


def test_pictures_and_movies_are_written_and_told(tmp_path: Path) -> None:
    picture, movie = tmp_path / "run.png", tmp_path / "run.html"
    arguments = ("simulate", "--scene", "shuffleboard-two-stones", "--plot", str(picture),
                 "--movie", str(movie), "--explain")  # fmt: skip
    ended = invoke(*arguments)
    assert ended.exit_code == 0 and f"wrote {movie}" in ended.stderr
    assert "2 pucks looked up from impact or border to the next" in ended.stderr
    assert picture.stat().st_size > 10_000 and movie.stat().st_size < 1_000_000
    assert invoke(*arguments).exit_code == 0  # they can be made again
    one = invoke("simulate", "--v0", "1,0", "--w0", "5", "--movie", tmp_path / "one.html")
    assert one.exit_code == 0 and (tmp_path / "one.html").exists()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--radius", "0.1"), "puck[0]"),
        (("--v0", "1,0"), "puck[0].launch"),
        (("--delta", "1"), "--delta has no place in a scene"),
        (("--set", "puck[9].mass=1"), "no such entry to set"),
        (("--set", "puck[0].launch.speed=1"), "there are: velocity, spin"),
        (("--set", "puck[0].colour=blau"), "did you mean 'blue'?"),
        (("--set", "puck[1].launch.position=[0.03,0]"), "overlap by 0.03 m"),
        (("--set", "puck[0].mass=1:2:3"), "a range makes many runs; give one number"),
        (("--movie", "run.avi"), "one of .html, .gif, .mp4"),
        (("--movie", "/nowhere/run.html"), "the folder /nowhere does not exist"),
        (("--plot", "a.png", "--movie", "a.png"), "one of .html, .gif, .mp4"),
    ],
)
def test_refusals_are_one_sentence_and_leave_nothing(arguments, words, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    ended = invoke("simulate", "--scene", "newtons-row", *arguments)
    assert ended.exit_code in (1, 2) and words in ended.stderr
    assert "Traceback" not in ended.stderr and ended.stdout == ""
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("command", "option", "path"),
    [
        ("simulate", "friction", "puck[{}].friction"),
        ("simulate", "w0", "puck[{}].launch.spin"),
        ("simulate", "mass", "puck[{}].mass"),
        ("sweep", "w0", "puck[{}].launch.spin"),
        ("sweep", "height", "puck[{}].height"),
    ],
)
def test_a_number_of_the_only_puck_is_refused_with_what_to_write(command, option, path):
    """And what it says is what does it."""
    low, high = sorted(np.random.default_rng(19).uniform(0.001, 0.02, 2).round(4).tolist())
    value = f"{low!r}" if command == "simulate" else f"{low!r}:{high!r}:3"
    only = path.replace("puck[{}].launch", "launch").replace("puck[{}]", "puck")
    for given in ((f"--{option}", value), ("--set", f"{only}={value}")):
        ended = invoke(command, "--scene", "newtons-row", *given)
        assert ended.exit_code == 2 and ended.stdout == ""
        assert "here each has its own" in ended.stderr and "and so on to puck[" in ended.stderr
        written = re.findall(r'--set "([^"]*)"', ended.stderr)
        assert written == [f"{path.format(0)}={value}"]
        assert invoke(command, "--scene", "newtons-row", "--set", *written).exit_code == 0


def test_a_sweep_of_several_pucks_says_where_each_ends() -> None:
    ended = invoke("sweep", "--scene", "newtons-row", "--set", "puck[0].mass=0.1:0.2:3")
    assert ended.exit_code == 0
    assert len(ended.stdout.splitlines()) == 1 + 3 * 6
    assert "6 pucks" in ended.stderr and "3 at rest" in ended.stderr


def test_check_says_how_pucks_would_be_moved() -> None:
    assert "20 pucks looked up" in invoke("scene", "check", "carrom-break").stdout
    checked = invoke("scene", "check", "air-hockey-mallet").stdout
    assert "1 puck driven along a path" in checked and "1 puck in closed form" in checked
    assert "Carrom: the break" in invoke("scene", "list").stdout
    assert "[[puck]]" in invoke("scene", "show", "crokinole").stdout
    fields = invoke("scene", "fields").stdout
    assert "puck[0].launch.velocity" in fields and "a colour, '#rrggbb'" in fields


def test_what_the_floor_and_the_air_took_is_told() -> None:
    more = ("--set", "drag.quadratic=0.01", "--set", "lateral.strength=0.1")
    said = invoke("simulate", "--scene", "curling-take-out", *more).stdout
    assert " J floor, " in said and " J drag, " in said
    assert said.count("empirical: no dry friction over the contact explains it") == 1

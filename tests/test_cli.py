"""The commands as a person types them: results, refusals, exit codes, nothing lost."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import click
import numpy as np
import pandas
import pytest
import xarray
from click.testing import Result
from commands import invoke
from puck_tables.cli.main import main
from pucks import simulate

from puck_tables import Puck, Table

PUCK = [sys.executable, "-c", "from puck_tables.cli.main import main; main(prog_name='puck')"]


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def refused(result: Result, code: int, *words: str) -> str:
    """One sentence on stderr, nothing on stdout, no traceback."""
    assert result.exit_code == code, result.output
    assert isinstance(result.exception, SystemExit)
    assert result.stdout == ""
    lines = result.stderr.strip().splitlines()
    errors = [line for line in lines if line.startswith("Error: ")]
    assert len(errors) == 1, result.stderr
    assert lines[-1] == errors[0]
    for word in words:
        assert word in errors[0]
    assert "Traceback" not in result.output
    return errors[0]


def test_the_first_command_says_what_was_assumed():
    result = invoke("simulate", "--v0", "1,0", "--w0", "5")
    assert result.exit_code == 0
    for words in (
        "r = 1 m, delta = 0.5, f g = 1 m/s^2\n", "B: spin-rich", "3.96299205 s",
        "(2.21395163, -0.15716", "v/(r w) tends to 0.6604943", "residual", "error estimate",
    ):  # fmt: skip
        assert words in result.stdout
    assert "a default one: --help" in result.stderr
    assert str(Puck.similar().simulate((1.0, 0.0), 5.0, frames=1)) + "\n" == result.stdout
    assert "defaults" not in invoke("simulate", "--v0", "1,0", "--delta", "0.5").stdout
    sized = invoke("simulate", "--v0", "1,0", "--radius", "25mm")
    assert "f g is a default: give --friction and --height, or --decel.\n" in sized.stderr
    assert "a default one" in invoke("simulate", "--v0", "1,0", "--mass", "0.1").stderr


def test_json_is_one_object_with_the_promised_keys():
    result = invoke("simulate", "--v0", "1,0", "--w0", "5", "--json")
    found = json.loads(result.stdout)
    assert result.stdout.count("\n") == 1
    assert set(found) >= {
        "stop_time", "stop_position", "regime", "delta", "decel", "limit_angle", "turn_angle",
        "body_angle", "path_length", "energy_residual", "method",
    }  # fmt: skip
    assert found["stop_position"] == list(simulate((1, 0), 5.0).stop_position)


def test_a_real_puck():
    arguments = ["--v0", "2,0", "--w0", "30", "--radius", "0.0381", "--height", "0.0254"]
    found = json.loads(invoke("simulate", *arguments, "--friction", "0.1", "--json").stdout)
    assert found["delta"] == pytest.approx(2 * 0.1 * 0.0254 / 0.0381)
    assert found["decel"] == pytest.approx(0.980665)
    moon = invoke("simulate", *arguments, "--friction", "0.1", "--gravity", "1.62", "--json")
    assert json.loads(moon.stdout)["decel"] == pytest.approx(0.162)
    heavy = invoke("simulate", *arguments, "--friction", "0.1", "--mass", "0.17", "--json")
    assert json.loads(heavy.stdout)["kinetic_energy"] == pytest.approx(
        0.5 * 0.17 * (4 + 0.5 * (0.0381 * 30) ** 2)
    )


@pytest.mark.parametrize("ending", ["h5", "csv", "jsonl"])
def test_saved_trajectories_open_elsewhere(folder: Path, ending: str):
    name = f"run.{ending}"
    result = invoke("simulate", "--v0", "1,0", "--w0", "5", "--frames", "20", "-o", name)
    assert result.exit_code == 0
    assert f"wrote {name}" in result.stderr
    if ending == "h5":
        with xarray.open_dataset(name, engine="h5netcdf") as data:
            assert data.x.dims == ("time",)
            assert data.x.attrs["units"] == "m"
            assert data.attrs["regime"] == "B"
            x = data.x.values
    elif ending == "csv":
        frame = pandas.read_csv(name)
        assert list(frame.columns)[:3] == ["time[s]", "x[m]", "y[m]"]
        x = frame["x[m]"].to_numpy()
    else:
        frame = pandas.read_json(name, lines=True)
        assert set(frame.columns) == {
            "time", "x", "y", "vx", "vy", "heading", "orientation", "speed", "spin", "slip_speed",
            "slip_angle",
        }  # fmt: skip
        x = frame["x"].to_numpy()
    np.testing.assert_allclose(x, simulate((1, 0), 5.0, frames=20).x, rtol=1e-12)


def test_times_from_the_command_line():
    invoke("simulate", "--v0", "1,0", "--times", "0,0.5,7", "-o", "a.csv")
    np.testing.assert_allclose(pandas.read_csv("a.csv")["x[m]"], [0.0, 0.375, 0.5], rtol=1e-12)
    invoke("simulate", "--v0", "1,0", "--times", "0:1:3", "-o", "b.csv")
    np.testing.assert_allclose(pandas.read_csv("b.csv")["time[s]"], [0.0, 0.5, 1.0])


@pytest.mark.thorough
@pytest.mark.parametrize("start", [["--w0", "5"], ["--w0", "0"], ["--v0", "0,0", "--w0", "1"]])
def test_pictures_are_drawn_for_every_regime(folder: Path, start: list[str]):
    assert invoke("simulate", "--v0", "1,0", *start, "--plot", "run.png").exit_code == 0
    assert Path("run.png").read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"
    assert invoke("simulate", "--v0", "0,0", "--plot", "rest.svg").exit_code == 0


def test_sweep_writes_labelled_maps_and_draws_them():
    result = invoke(
        "sweep", "--speed", "0:2:5", "--w0", "-3:3:7", "--delta", "0:1:3", "-o", "map.h5",
        "--plot", "map.png",
    )  # fmt: skip
    assert result.exit_code == 0
    assert result.stdout == ""
    with xarray.open_dataset("map.h5", engine="h5netcdf") as data:
        assert dict(data.sizes) == {"delta": 3, "launch_speed": 5, "launch_spin": 7}
        assert data.stop_time.dims == ("delta", "launch_speed", "launch_spin")
        assert data.stop_x.attrs["units"] == "m"
        assert data.launch_spin.attrs["units"] == "rad/s"
        assert data.status.attrs["flag_meanings"] == "stopped step_limit overflow"
        at = data.sel(delta=0.5, launch_speed=1.0, launch_spin=-2.0)
        run = simulate((1, 0), -2.0)
        assert float(at.stop_time) == pytest.approx(run.stop_time, abs=1e-6)
        assert float(at.stop_y) == pytest.approx(run.stop_position[1], abs=1e-6)
    assert invoke("sweep", "--w0", "0:10:11", "--v0", "1,0", "--plot", "curve.png").exit_code == 0


def test_sweep_prints_csv_without_an_output():
    result = invoke("sweep", "--w0", "0:10:3", "--v0", "1,0", "--delta", "1")
    rows = result.stdout.splitlines()
    assert rows[0].startswith("launch_spin[rad/s],stop_time[s],stop_x[m],stop_y[m]")
    assert len(rows) == 4
    assert float(rows[2].split(",")[1]) == pytest.approx(4.000188799127, abs=1e-6)
    assert "3 stopped" in result.stderr
    assert len(invoke("sweep").stdout.splitlines()) == 1 + 41 * 41


def test_build_info_validate(folder: Path):
    built = invoke("build-tables", "--accuracy", "1e-6", "-o", "rough.h5")
    assert built.exit_code == 0
    assert Table.load("rough.h5").metadata["command"].startswith("puck ")
    assert invoke("build-tables", "--cells", "32", "-o", "hand.h5").exit_code == 0
    told = invoke("info", "rough.h5").stdout
    for words in ("69 phi x 4 delta", "tolerance   1e-06", "uniform pressure", "right"):
        assert words in told
    assert "default table" in invoke("info").stdout
    judged = invoke("validate", "rough.h5")
    assert judged.exit_code == 0
    assert judged.stdout.count("pass") == 12
    near = invoke("simulate", "--v0", "1,0", "--w0", "5", "--table", "rough.h5", "--tol", "1e-5",
                "--json")  # fmt: skip
    assert json.loads(near.stdout)["stop_time"] == pytest.approx(3.96299205, abs=5e-5)


def test_validate_ends_with_3_when_a_table_is_out_of_its_tolerance(monkeypatch: pytest.MonkeyPatch):
    table = replace(Table.shipped(), tolerance=1e-13)
    monkeypatch.setattr("puck_tables.cli.tables.tables_named", lambda file: [table])
    result = invoke("validate")
    assert result.exit_code == 3
    assert "FAIL" in result.stdout
    assert "Error: the table is out of its own tolerance" in result.stderr


V0 = ["simulate", "--v0", "1,0"]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["simulate", "--v0", "1"], ["two numbers with a comma"]),
        (["simulate", "--v0", "one,0"], ["'one' is not a number"]),
        (["simulate", "--v0", "nan,0"], ["'nan' is not a finite number"]),
        (["simulate"], ["--v0"]),
        ([*V0, "--w0", "inf"], ["--w0", "finite"]),
        ([*V0, "--radius", "-1"], ["radius must be greater than 0"]),
        ([*V0, "--decel", "0"], ["decel must be greater than 0"]),
        ([*V0, "--radius", "1", "--height", "1", "--friction", "-1"], ["friction"]),
        ([*V0, "--radius", "1", "--height", "1", "--friction", "1", "--gravity", "0"], ["gravity"]),
        ([*V0, "--radius", "1", "--height", "2.1", "--friction", "1"], ["delta = 4.2", "tips"]),
        ([*V0, "--pressure", "foam"], ["foam", "annulus:INNER"]),
        ([*V0, "--gyration", "0.05"], ["gyration", "from 0.1 to 10"]),
        ([*V0, "--delta", "2", "--tol", "1e-13"], ["tol must be from 1e-11"]),
        ([*V0, "--delta", "-0.1"], ["delta", "must not be negative"]),
        ([*V0, "--delta", "2", "--exact"], ["delta", "from 0 to below 2"]),
        (["build-tables", "-o", "table.csv"], ["ends in .h5"]),
        ([*V0, "--delta", "1.1", "--exact"], ["part of the base is lifted", "law of full contact"]),
        ([*V0, "--height", "1", "--delta", "0.5"], ["--height and --delta clash"]),
        ([*V0, "--friction", "1", "--decel", "0.5"], ["--friction and --decel clash"]),
        ([*V0, "--friction", "0.1", "--radius", "1"], ["--friction needs --height"]),
        ([*V0, "--gravity", "9.8"], ["--gravity needs --radius and --height and --friction"]),
        ([*V0, "--frames", "0"], ["frames must be a whole number from 1"]),
        ([*V0, "--frames", "5", "--times", "1"], ["one of them"]),
        ([*V0, "--times", "2:1:5"], ["STOP must be greater"]),
        ([*V0, "--times", "-1,2"], ["times"]),
        ([*V0, "--w0", "2", "--tol", "1e-14"], ["tol must be from 1e-13"]),
        ([*V0, "--method", "euler"], ["'euler'"]),
        ([*V0, "--exact", "--table", "x.h5"], ["--exact and --table clash"]),
        ([*V0, "-o", "run.xlsx"], [".h5, .csv, .json, .jsonl"]),
        ([*V0, "--plot", "run.bmp"], [".png"]),
        ([*V0, "-o", "a.csv", "--plot", "a.csv"], ["a.csv: the ending", ".png"]),
        (["sweep", "--w0", "5:1:10"], ["STOP must be greater than START"]),
        (["sweep", "--w0", "1:5"], ["START:STOP:COUNT"]),
        (["sweep", "--w0", "-1e308:1e308:3"], ["too wide"]),
        ([*V0, "--radius", "1e-308", "--height", "1e308", "--friction", "1"], ["floating point"]),
        (["sweep", "--w0", "1:5:1e3"], ["COUNT"]),
        (["sweep", "--w0", "0:1:999999999999"], ["COUNT"]),
        (["sweep", "--w0", "0:1:1000000", "--speed", "0:1:1000000"], ["would need", "GiB"]),
        (["sweep", "--v0", "1,0", "--speed", "1"], ["--v0 and --speed clash"]),
        (["sweep", "--speed", "-1:1:5"], ["speed must not be negative"]),
        (["sweep", "--w0", "1", "--plot", "x.png"], ["needs a range"]),
        (["sweep", "--height", "1", "--delta", "0:1:5"], ["clash"]),
        (["sweep", "-o", "map.txt"], [".h5, .csv"]),
        (["build-tables", "--cells", "3"], ["from 4"]),
    ],
)
def test_bad_input_is_one_sentence_and_writes_nothing(folder, arguments, words):
    refused(invoke(*arguments), 2, *words)
    assert list(folder.iterdir()) == []


@pytest.mark.parametrize("name", main.commands)
def test_an_option_of_one_value_is_taken_once(name: str):
    commands = [([name], main.commands[name])]
    if isinstance(commands[0][1], click.Group):
        commands = [([name, one], command) for one, command in commands[0][1].commands.items()]
    for words, command in commands:
        for option in command.params:
            if isinstance(option, click.Option):
                flags = [option.opts[0], [*option.opts, *option.secondary_opts][-1]]
                value = [] if option.is_flag else ["1"]
                both = [word for flag in flags for word in (flag, *value)]
                once = option.secondary_opts or not option.is_flag
                result = invoke(*words, *both, "--help")
                if option.multiple or not once:
                    assert result.exit_code == 0
                else:
                    refused(result, 2, f"{option.opts[0]}", "is given twice: give it once")


def test_pictures_without_matplotlib_say_what_to_install(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    refused(invoke(*V0, "--plot", "run.png"), 1, "pip install matplotlib")


def test_help_and_version_are_quick_and_load_nothing_heavy():
    for argument in ("--help", "--version"):
        best = min(_seconds(argument) for _ in range(5))
        assert best < 0.2, best
    heavy = (
        "import sys, puck_tables, puck_tables.cli.main; "
        "print([m for m in ('numpy', 'numba', 'h5py', 'scipy', 'matplotlib') if m in sys.modules])"
    )
    found = subprocess.run(
        [sys.executable, "-c", heavy], capture_output=True, text=True, check=True
    )
    assert found.stdout == "[]\n"


def _seconds(argument: str) -> float:
    """Of processor time: how long it takes beside other work says nothing."""
    kept = {key: value for key, value in os.environ.items() if key != "PYTHONDONTWRITEBYTECODE"}
    before = os.times()
    subprocess.run([*PUCK, argument], capture_output=True, check=True, env=kept)  # as installed
    after = os.times()
    spent = after.children_user + after.children_system
    return spent - before.children_user - before.children_system


def test_odd_names_and_numbers(folder: Path):
    refused(invoke(*V0, "-o", "x" * 300 + ".csv"), 1, "name too long")
    refused(invoke(*V0, "-o", "/dev/stdout", "--overwrite"), 2, ".h5, .csv, .json, .jsonl")
    Path("pipe.csv").unlink(missing_ok=True)
    os.mkfifo("pipe.csv")
    refused(invoke(*V0, "-o", "pipe.csv", "--overwrite"), 1, "not a regular file")
    for count in ("²", "1_0", "9" * 5000, "+5"):
        refused(invoke("sweep", "--w0", f"0:1:{count}"), 2, "COUNT")
    for number in ("1_0", "１", ""):
        refused(invoke("simulate", "--v0", f"{number},0"), 2, "is not a number")
    assert [path.name for path in folder.iterdir()] == ["pipe.csv"]
    assert invoke(*V0, "-o", "\udcff.csv").exit_code == 0


def test_a_link_is_followed(folder: Path):
    Path("real.csv").write_text("mine")
    Path("link.csv").symlink_to("real.csv")
    refused(invoke(*V0, "-o", "link.csv"), 1, "exists already")
    assert invoke(*V0, "-o", "link.csv", "--overwrite").exit_code == 0
    assert Path("link.csv").is_symlink()
    assert Path("real.csv").read_text().startswith("time[s]")


@pytest.mark.thorough
def test_everything_printed_is_ascii():
    """Redirected output of consoles that know no Greek must not fail."""
    for arguments in (
        ["--help"], ["simulate", "--help"], ["sweep", "--help"], ["build-tables", "--help"],
        ["info", "--help"], ["validate", "--help"], ["info"], ["validate"], [*V0, "--w0", "5"],
        [*V0, "--json"], ["sweep", "--w0", "0:1:2"],
    ):  # fmt: skip
        assert invoke(*arguments).output.isascii(), arguments


def test_the_table_that_is_read_is_never_replaced():
    invoke("build-tables", "--accuracy", "1e-6", "-o", "t.h5")
    for command in (["sweep"], V0):
        result = invoke(*command, "--tol", "1e-4", "--table", "t.h5", "-o", "t.h5",
                      "--overwrite")  # fmt: skip
        refused(result, 2, "is read by this command")
    assert Table.load("t.h5").tolerance == 1e-6


@pytest.mark.thorough
def test_tables_of_every_kind(folder: Path):
    for arguments, name, words in (
        (["--pressure", "annulus:0.8", "--accuracy", "1e-5"], "stone.h5", "annulus:0.8 pressure"),
        (["--kind", "stops", "--cells", "16"], "stops.h5", "33 phi x 9"),
    ):
        built = invoke("build-tables", *arguments, "-o", name)
        assert built.exit_code == 0, built.stderr
        assert words in built.stdout
        assert invoke("info", name).stdout.splitlines()[1:] == built.stdout.splitlines()[1:]
    judged = invoke("validate", "stone.h5")
    assert (judged.exit_code, judged.stdout.count("pass")) == (0, 9)
    refused(invoke("build-tables", "--pressure", "square"), 2, "no pressure law is called 'square'")
    refused(
        invoke("build-tables", "--pressure", "ring", "--kind", "stops"), 2, "--pressure goes with"
    )


@pytest.mark.thorough
def test_pucks_of_every_kind():
    v0 = ["--v0", "1,0", "--tol", "1e-6"]
    report = invoke("simulate", *v0, "--w0", "5", "--delta", "2").stdout
    for words in ("100 % of the base loaded at the launch, falling to 92.97 %; lifts at 3.7995",
                  "section", "delta = 2"):  # fmt: skip
        assert words in report
    report = invoke("simulate", *v0, "--w0", "0.3", "--delta", "1.2").stdout
    assert "all of it from 0.9244" in report
    assert "part of it lifted throughout" in invoke("simulate", *v0, "--delta", "2").stdout
    report = invoke("simulate", *v0, "--w0", "1", "--pressure", "ring", "--delta", "0").stdout
    assert "pressure ring, k/r = 0.707107" in report
    assert "the spin dies out before the sliding" in report
    report = invoke("simulate", *v0, "--w0", "1", "--pressure", "hertz", "--delta", "0").stdout
    assert "the sliding dies out before the spin" in report
    tall = invoke("simulate", *v0, "--w0", "5", "--delta", "2", "--json", "-o", "run.h5",
                "--plot", "run.png")  # fmt: skip
    found = json.loads(tall.stdout)
    assert (found["contact_closes"], found["pressure"]) == (None, "uniform")
    with xarray.open_dataset("run.h5", engine="h5netcdf") as data:
        assert data.attrs["contact_opens"] == found["contact_opens"]
        assert "contact_closes" not in data.attrs
    assert invoke("simulate", *v0, "--w0", "1", "--pressure", "ring", "--delta", "0", "--plot",
                "ring.png").exit_code == 0  # fmt: skip
    swept = invoke("sweep", *v0, "--w0", "0:2:3", "--pressure", "annulus:0.8", "--gyration", "0.9",
                 "--explain")  # fmt: skip
    assert len(swept.stdout.splitlines()) == 4
    assert "sections of pressure annulus:0.8, k/r = 0.9" in swept.stderr
    aimed = invoke("aim", "--target", "2,0.1", "--w0", "5", "--gyration", "1")
    assert "1 launch" in aimed.stdout
    assert "k/r = 1" in aimed.stdout

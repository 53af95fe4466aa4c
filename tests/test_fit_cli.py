"""``puck fit`` and ``puck simulate --fit`` from the command line."""

from __future__ import annotations

import json
from pathlib import Path

import h5py
import numpy as np
import pytest
from commands import invoke

import puck_tables as pt

TIMES = np.arange(100) / 60.0


@pytest.fixture(scope="module")
def film(tmp_path_factory):
    puck = pt.Puck(radius=0.0381, height=0.0254, friction=0.15)
    path = puck.states((1.5, 0.4), 40.0, TIMES)
    rng = np.random.default_rng(2)
    columns = [TIMES, path.x + 3e-4 * rng.normal(size=100), path.y + 3e-4 * rng.normal(size=100),
               np.angle(np.exp(1j * (path.orientation + 5e-3 * rng.normal(size=100))))]  # fmt: skip
    file = tmp_path_factory.mktemp("films") / "film.csv"
    rows = [",".join(f"{value:.9f}" for value in row) for row in zip(*columns, strict=True)]
    file.write_text("t [s],x [m],y [m],angle [rad]\n" + "\n".join(rows) + "\n")
    return file


def test_a_film_becomes_numbers_a_file_a_picture_and_a_run(film, tmp_path):
    out, picture = tmp_path / "fit.json", tmp_path / "fit.png"
    done = invoke("fit", film, "--radius", 0.0381, "-o", out, "--plot", picture, "--hold-out", 0.3)
    assert done.exit_code == 0, done.output
    assert "The friction coefficient is 0.1" in done.stdout
    assert "held out" in done.stdout and "95 %" in done.stdout
    assert picture.read_bytes()[1:4] == b"PNG"
    saved = json.loads(out.read_text())
    assert saved["numbers"]["friction"]["value"] == pytest.approx(0.15, rel=1e-3)
    again = invoke("simulate", "--fit", out, "--json")
    assert again.exit_code == 0, again.output
    told = json.loads(again.stdout)
    assert told["launch_velocity"] == pytest.approx([1.5, 0.4], abs=5e-3)
    assert told["friction"] == saved["numbers"]["friction"]["value"]


def test_json_and_known_numbers(film):
    done = invoke("fit", film, "--radius", 0.0381, "--height", 0.0254, "--json")
    told = json.loads(done.stdout)
    assert told["numbers"]["friction"]["how"] == "found"
    assert told["numbers"]["height"]["how"] == "known"
    assert told["numbers"]["delta"]["how"] == "follows"
    held = invoke("fit", film, "--radius", 0.0381, "--fix", "delta=0.2", "--prior",
                  "friction=0.2:0.5", "--start", "friction=0.3", "--bound", "friction=0.01:1",
                  "--noise", "0.0003,0.005", "--json")  # fmt: skip
    assert held.exit_code == 0, held.output
    assert json.loads(held.stdout)["noise"] == [0.0003, 0.005]


def test_what_is_not_determined_is_said(film):
    done = invoke("fit", film, "--radius", 0.0381, "--free", "friction,gravity,height")
    assert done.exit_code == 0
    assert "not determined" in done.stdout and "Measure one of them" in done.stdout


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ((), "--radius"),
        (("--radius", 0.0381, "--height", 0.02, "--free", "height"), "leave out one"),
        (("--radius", 0.0381, "--friction", 0.2, "--fix", "friction=0.2"), "say the same"),
        (
            ("--radius", 0.0381, "--prior", "friction=0.2"),
            "prior of friction must be a value and a standard deviation, got [0.2]",
        ),
        (("--radius", 0.0381, "--fix", "delta"), "NAME=VALUE"),
        (("--radius", 0.0381, "--fix", "delta=x"), "delta must be a number, got 'x'"),
        (("--radius", 0.0381, "--fix", "delta=1_0"), "delta must be a number, got '1_0'"),
        (("--radius", 0.0381, "--bound", "height=1cm:0.02"), "give each of these numbers its unit"),
        (("--radius", 0.0381, "--prior", "friction=0.2:x"), "must be a number, got 'x'"),
        (("--radius", 0.0381, "--noise", "1,2,3"), "of places (m) and of angles (rad)"),
        (("--radius", -1), "radius"),
        (("--radius", 0.0381, "-o", "fit.txt"), "one of .h5, .csv, .json, .jsonl, .parquet\n"),
        (("--radius", 0.0381, "--free", ""), "--free '' must be names with commas"),
        (("--radius", 0.0381, "--laws", "uniform,"), "must be names with commas"),
        (("--radius", 0.0381, "--wall", "1,2"), "two points"),
        (("--radius", 0.0381, "--wall", "1,2:3"), "two points"),
        (("--radius", 0.0381, "--rows", "1"), "first and of the last line of the picture"),
        (("--radius", 0.0381, "--jitter", "x"), "find"),
    ],
)
def test_a_refusal_is_a_sentence(film, arguments, words):
    done = invoke("fit", film, *arguments)
    assert done.exit_code == 2
    assert words in done.stderr and "Traceback" not in done.stderr


def test_files_are_kept_and_others_refused(film, tmp_path):
    out = tmp_path / "fit.json"
    out.write_text("mine")
    done = invoke("fit", film, "--radius", 0.0381, "-o", out)
    assert done.exit_code == 1 and out.read_text() == "mine"
    for text in ("mine", "[]", '{"kind": "puck-tables fit 1"}', "[" * 10**5):
        out.write_text(text)
        done = invoke("simulate", "--fit", out)
        assert done.exit_code == 2 and "no file of puck fit" in done.stderr, text
    out.write_text('{"kind": "puck-tables fit 9"}')
    assert "reads puck-tables fit 1: fit again" in invoke("simulate", "--fit", out).stderr
    assert invoke("simulate", "--fit", out, "--v0", "1,0").exit_code == 2
    assert invoke("simulate", "--track", "1", "--v0", "1,0").exit_code == 2


def test_a_number_at_its_bound_has_no_error(film, tmp_path):
    files = tmp_path / "fit.json", tmp_path / "fit.h5"
    for out in files:
        done = invoke("fit", film, "--radius", 0.0381, "--bound", "friction=0.16:0.3", "-o", out)
        assert done.exit_code == 0, done.output
    shown = dict(line.split(maxsplit=1) for line in done.stdout.splitlines() if " " in line)
    for name in ("friction", "decel", "height"):  # the others follow from it
        assert "(at its bound)" in shown[name] and "+-" not in shown[name]
    assert "at its bound" not in shown["delta"] and "+-" in shown["delta"]
    assert "friction coefficient is 0.16 (at its bound)" in done.stdout
    told = json.loads(files[0].read_text())["numbers"]
    for name in ("friction", "decel", "height"):
        assert told[name]["error"] is None and told[name]["at_bound"] is True
    assert told["delta"]["error"] > 0.0 and told["delta"]["at_bound"] is False
    with h5py.File(files[1]) as saved:
        names = [name.decode() for name in saved["number_name"][()]]
        errors = dict(zip(names, saved["number_error"][()], strict=True))
    assert np.isnan([errors["friction"], errors["decel"]]).all() and errors["delta"] > 0.0


def test_walls_and_rows_are_read(tmp_path: Path):
    """Points on the command line, as help shows them; a bad one is named."""
    saved = str(tmp_path / "run.csv")
    words = ["--v0", "2,0.3", "--w0", "40", "--radius", "0.0381"]
    words += ["--height", "0.0254", "--friction", "0.15"]
    command = invoke("simulate", *words, "--frames", "60", "-o", saved)
    assert command.exit_code == 0, command.stderr
    for option in (["--rows", "1.0,-0.2"], ["--wall", "9,0:9,2"]):
        found = invoke("fit", saved, "--radius", "0.0381", *option)
        assert found.exit_code == 0, found.stderr
        value = found.stdout.split("The friction coefficient is ")[1].split()[0]
        assert float(value) == pytest.approx(0.15, rel=1e-6)
    wrong = invoke("fit", saved, "--radius", "0.0381", "--rows", "1.0")
    assert (
        wrong.exit_code and "rows must be y in m of the first and of the last line" in wrong.stderr
    )

"""``puck export`` and ``export_source``: what they write, and what they refuse."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import pytest
from commands import invoke
from conftest import ROOT

import puck_tables as pt


@pytest.mark.parametrize(
    ("language", "name"), [("c", "puck.c"), ("c", "puck.h"), ("js", "puck.mjs"), ("python", "p.py")]
)
def test_a_file_is_written_whole(tmp_path: Path, language: str, name: str):
    path = tmp_path / name
    options = ["export", "--language", language, "--what", "resultants", "-o", str(path)]
    done = invoke(*options)
    assert done.exit_code == 0 and f"wrote {path}" in done.stderr and not done.stdout
    assert path.read_text() == pt.export_source(language, "resultants").text
    again = invoke(*options)
    assert again.exit_code == 1 and "exists already" in again.stderr
    assert invoke(*options, "--overwrite").exit_code == 0


def test_a_base_has_its_wrench_in_a_file(tmp_path: Path):
    path = tmp_path / "box.js"
    options = ["export", "--language", "js", "--base", "box:20cmx10cm", "-o", str(path)]
    done = invoke(*options, "--what", "wrench")
    assert done.exit_code == 0
    source = pt.export_source("js", "wrench", puck=pt.Puck(base="box:0.2x0.1"))
    assert path.read_text() == source.text
    refused = invoke(*options, "--overwrite")
    assert refused.exit_code != 0 and "a base 'wrench' is exported" in refused.stderr


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--language", "fortran", "-o", "a.f90"], ["'fortran'", "c, js, python"]),
        (["--language", "c", "-o", "a.js"], ["a.js", ".c or .h"]),
        (["--language", "c", "-o", "a"], ["ends in .c"]),
        (["--language", "c", "--tol", "1e-10", "-o", "a.c"], ["from 1e-09 to 0.01", "1e-10"]),
        (["--language", "c", "--tol", "0.1", "-o", "a.c"], ["tol must be from"]),
        (["--language", "c", "--tol", "nan", "-o", "a.c"], ["finite"]),
        (["--language", "c", "--what", "path", "-o", "a.c"], ["'path'", "stop, state"]),
        (["--language", "c", "--what", "", "-o", "a.c"], ["choose stop, state"]),
        (["--language", "c", "-o", "nowhere/a.c"], ["nowhere does not exist"]),
        (["--language", "c", "--target", "x86_64-linux", "-o", "a.c"], ["--target is for a board"]),
        (["--language", "c", "--scene", "crokinole", "-o", "a.c"], ["a header, which ends in .h"]),
        (["--language", "python", "--scene", "crokinole", "-o", "a.py"], ["exported to c and js"]),
        (["--language", "c"], ["--output"]),
        (["-o", "a.c"], ["--language"]),
    ],
)
def test_bad_input_is_one_sentence(tmp_path, monkeypatch, options, words):
    monkeypatch.chdir(tmp_path)
    done = invoke("export", *options)
    assert done.exit_code in (1, 2)
    assert "Traceback" not in done.stderr and done.stderr.count("Error: ") == 1
    assert all(word in done.stderr for word in words), done.stderr
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ((3,), "language must be"),
        (("c", 3), "what must be"),
        (("c", [3]), "called 3"),
        (("c", []), "nothing to export"),
        (("c", "stop", "fine"), "tol must be"),
        (("c", "stop", True), "tol"),
        (("c", "stop", float("inf")), "tol"),
    ],
)
def test_the_library_refuses_the_same(arguments: tuple[object, ...], words: str):
    with pytest.raises(pt.InputError, match=words):
        pt.export_source(*arguments)  # type: ignore[arg-type]


def test_any_error_between_is_made():
    source = pt.export_source("c", ["resultants", "stop", "stop"], 3e-3)
    assert source.what == ("stop", "resultants") and "0.003" in source.text
    assert repr(source).startswith("Source(c, stop, resultants to 0.003, ")


@pytest.mark.skipif(shutil.which("node") is None, reason="no Node here")
def test_the_program_of_the_page_prints_what_it_says(tmp_path: Path):
    text = (ROOT / "docs" / "export.md").read_text(encoding="utf-8")
    program = re.search(r"```js\n(.*?)```", text, re.DOTALL)[1]
    told = re.findall(r"//.*: (.*)", program)
    pt.export_source("js", ["stop", "state"], 1e-4).save(tmp_path / "puck.js")
    tells = re.sub(
        r"//.*", "console.log(Array.from(out, one => one.toFixed(2)).join(', '));", program
    )
    (tmp_path / "main.mjs").write_text(tells)
    said = subprocess.run(["node", "main.mjs"], cwd=tmp_path, capture_output=True, text=True)
    lines = said.stdout.splitlines()
    assert len(told) == 2 and len(lines) == 2, said.stderr
    assert all(line.startswith(one) for line, one in zip(lines, told, strict=True)), lines

"""Exported files of other pressure laws answer as the library does, within the stated error."""

from __future__ import annotations

import ast
from pathlib import Path

import numpy as np
import pytest
from commands import invoke
from exported import RUNNERS, units
from law_exports import SPREAD, by_library, puck_under, text_under
from rarely import few

import puck_tables as pt

ALL = "stop,state,resultants"


def judged(law: str, language: str, what: str, tol: float, folder: Path, count: int) -> None:
    make, _ = RUNNERS[language]
    run = make(text_under(law, language, what, tol), folder)
    for name, (rows, wanted) in by_library(law, count).items():
        if name not in what and not (name == "turn" and "state" in what):
            continue
        found, codes = run(name, np.ascontiguousarray(rows))
        assert not codes.any(), name
        scale = 1.0 if name == "resultants" else units(rows, name)
        assert (np.abs(found - wanted) / scale).max() <= tol, name


@pytest.mark.thorough
@pytest.mark.parametrize("language", RUNNERS)
def test_a_washer_equals_the_library(language: str, tmp_path: Path):
    judged("annulus:0.8", language, ALL, 1e-4, tmp_path, 300)


@pytest.mark.nightly
@pytest.mark.parametrize(("what", "tol"), [(ALL, 1e-4), (ALL, 1e-6), ("stop,resultants", 1e-9)])
@pytest.mark.parametrize("law", SPREAD)
def test_every_law_equals_the_library(law: str, what: str, tol: float, tmp_path: Path):
    judged(law, "c", what, 10.0 * tol if law == "ring" and tol < 1e-6 else tol, tmp_path, 10_000)


@pytest.mark.nightly
def test_stops_on_a_ring_are_refused_where_splines_end():
    """Its friction has a logarithm at the line on which its motions end."""
    with pytest.raises(pt.errors.AccuracyError, match="ask for a larger tol"):
        pt.export_source("c", "stop", 1e-9, puck_under("ring"))


@pytest.mark.thorough
@pytest.mark.parametrize("law", few(2, [*SPREAD, "galin homogeneous", "annulus:0.8 homogeneous"]))
def test_size_of_a_law(law: str):
    name, *homogeneous = law.split()
    puck = puck_under(name, 0.5**0.5 if homogeneous else None)
    sizes = {one: len(pt.export_source(one, ALL, 1e-4, puck).text.encode()) for one in RUNNERS}
    assert max(sizes.values()) <= 30_000, sizes


def test_heights_beyond_full_contact_are_refused():
    names: dict[str, object] = {}
    exec(text_under("hertz", "python", "stop", 1e-4), names)
    out = [0.0] * 5
    assert names["stop"](1.0, 0.0, 5.0, 0.8, 1.0, 1.0, out) == 0  # type: ignore[operator]
    assert names["stop"](1.0, 0.0, 5.0, 0.81, 1.0, 1.0, out) == 1  # type: ignore[operator]
    assert np.isnan(out).all()


@pytest.mark.thorough
@pytest.mark.parametrize(("law", "gyration"), [("hertz", 0.5**0.5), ("uniform", 0.9)])
def test_states_that_cannot_be_kept_are_refused_and_stops_are_not(law: str, gyration: float):
    """Such pucks, where they are flat, end in pure spin: states have no limit inside."""
    puck = puck_under(law, gyration)
    with pytest.raises(pt.errors.AccuracyError, match="stops and resultants alone"):
        pt.export_source("c", "state", 1e-4, puck)
    assert "delta <= " in repr(pt.export_source("c", "stop", 1e-4, puck))


def test_a_profile_with_a_name_that_ends_a_comment():
    law = pt.profile_law([0.0, 1.0], [1.0, 0.5], name='*/ int x; /*\n"""')
    puck = pt.Puck(radius=1.0, pressure=law)
    c, python = (pt.export_source(one, "resultants", 1e-3, puck).text for one in ("c", "python"))
    assert "*/ int" not in c
    ast.parse(python)


@pytest.mark.thorough
def test_the_command_writes_the_same_file(tmp_path: Path):
    path = tmp_path / "puck.js"
    options = ["--language", "js", "--what", "stop", "--tol", "1e-4", "-o", str(path)]
    kind = ["--pressure", "annulus:0.8", "--gyration", repr(SPREAD["annulus:0.8"])]
    done = invoke("export", *options, *kind)
    assert done.exit_code == 0, done.output
    assert path.read_text() == text_under("annulus:0.8", "js", "stop", 1e-4)
    assert "delta <= 1.64" in done.stderr


@pytest.mark.parametrize(
    ("kind", "words"),
    [
        (["--pressure", "hurtz"], "no pressure law is called 'hurtz'"),
        (["--pressure", "annulus:2"], "inner radius"),
        (["--gyration", "0"], "gyration"),
    ],
)
def test_bad_kinds_of_pucks(kind: list[str], words: str, tmp_path: Path):
    path = tmp_path / "puck.c"
    done = invoke("export", "--language", "c", *kind, "-o", path)
    assert done.exit_code != 0 and done.stderr.count("Error: ") == 1
    assert words in done.stderr and not path.exists()


def test_what_is_no_puck():
    with pytest.raises(pt.InputError, match="puck must be"):
        pt.export_source("c", "stop", 1e-4, "hertz")  # type: ignore[arg-type]

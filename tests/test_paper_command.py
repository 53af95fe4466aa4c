"""``puck paper``: what it writes, prints and refuses."""

from __future__ import annotations

import csv
import sys
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner, Result
from puck_tables.cli.main import main

from puck_tables.paper import figures
from puck_tables.paper.claim import Claim, equal


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def puck(*arguments: str) -> Result:
    return CliRunner().invoke(main, arguments)


FILES = ["claims.csv", *(f"figure_{n:02}.png" for n in range(2, 12))]


@pytest.mark.thorough
def test_the_command_writes_prints_and_says_what_it_wrote(
    subjects: dict[str, list[Claim]], claims: list[Claim], monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr("puck_tables.paper.claims.all_claims", lambda show: subjects)
    result = puck("paper", "--out", "deep/er")
    assert result.exit_code == 0, result.output
    assert sorted(path.name for path in Path("deep/er").iterdir()) == FILES
    for name in FILES:
        assert f"wrote deep/er/{name}" in result.stderr
    for name in FILES[1:]:
        picture = Path("deep/er", name).read_bytes()
        assert picture[:8] == b"\x89PNG\r\n\x1a\n"
        assert len(picture) > 15_000
    with open("deep/er/claims.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["statement"] for row in rows] == [claim.statement for claim in claims]
    assert {row["verdict"] for row in rows} == {"ok", "erratum"}
    np.testing.assert_allclose(
        [float(row["computed"]) for row in rows], [claim.computed for claim in claims]
    )
    assert f"{len(claims)} claims: {len(claims) - 4} ok, 4 errata of the paper, 0 differ" in (
        result.stdout
    )
    assert all(claim.statement in result.stdout for claim in claims)
    assert "wrote" not in result.stdout
    assert result.output.isascii()
    assert puck("paper", "--help").output.isascii()


def no_work() -> None:
    raise AssertionError("work was done before the outputs were checked")


@pytest.fixture
def idle(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("puck_tables.paper.claims.all_claims", lambda show: no_work())


@pytest.mark.usefixtures("idle")
@pytest.mark.parametrize("name", FILES)
def test_existing_files_are_kept(name: str):
    Path("out").mkdir()
    Path("out", name).write_text("mine")
    result = puck("paper", "--out", "out")
    assert result.exit_code == 1
    assert f"out/{name} exists already; use --overwrite" in result.stderr
    assert result.stdout == ""
    assert [path.name for path in Path("out").iterdir()] == [name]
    assert Path("out", name).read_text() == "mine"


@pytest.mark.usefixtures("idle")
def test_refusals(monkeypatch: pytest.MonkeyPatch):
    assert puck("paper").exit_code == 2
    Path("file").write_text("mine")
    for place in ("file", "file/below", "/proc/out"):
        result = puck("paper", "--out", place, "--overwrite")
        assert result.exit_code == 1
        assert f"Error: cannot make the folder {place}: " in result.stderr
        assert result.stdout == ""
    assert Path("file").read_text() == "mine"
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    result = puck("paper", "--out", "new")
    assert result.exit_code == 1
    assert 'pip install "puck-tables[plot]"' in result.stderr
    assert not Path("new").exists()


def test_a_claim_that_differs_ends_with_3(monkeypatch: pytest.MonkeyPatch):
    wrong = equal("Prop. 4", "critical delta", 1.0, 1.1, 1e-12)
    monkeypatch.setattr("puck_tables.paper.claims.all_claims", lambda show: {"Patch": [wrong]})
    monkeypatch.setattr("puck_tables.paper.figures.FIGURES", {2: figures.limit_angles})
    Path("out").mkdir()
    Path("out/claims.csv").write_text("old")
    result = puck("paper", "--out", "out", "--overwrite")
    assert result.exit_code == 3
    assert "DIFFERS" in result.stdout
    assert "Error: a claim differs" in result.stderr
    assert "critical delta" in Path("out/claims.csv").read_text()
    assert Path("out/figure_02.png").exists()

"""Tables the program keeps for itself: built once, never trusted blindly, easily cleared away."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from commands import invoke
from puck_tables.cli.tables import kept_files
from pucks import simulate

import puck_tables as pt
from puck_tables._core.own_folder import _said
from puck_tables.errors import AccuracyError, InputError
from puck_tables.kernels.cache import cache_folder
from puck_tables.stopping import stop_section
from puck_tables.table import friction_section, table_store
from puck_tables.table.resultant_table import ResultantTable

RADII = np.linspace(0.0, 1.0, 5)


@pytest.fixture(autouse=True)
def kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder of kept tables: an own one for each test."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setattr("sys.platform", "linux")
    _said.clear()
    stop_section.stop_section_for.cache_clear()  # other tests have asked for the same
    return tmp_path / "cache" / "puck-tables" / "tables"


@pytest.fixture
def builds(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The laws that were tabulated."""
    names: list[str] = []
    true = ResultantTable.built

    def counted(of: pt.Law, *given: object, **named: object) -> pt.Table:
        names.append(of.name)
        return true(of, *given, **named)

    monkeypatch.setattr(ResultantTable, "built", counted)
    return names


def test_built_once_then_read(kept: Path, builds: list[str], capsys: pytest.CaptureFixture[str]):
    first = pt.table_for("annulus:0.8", accuracy=1e-5)
    second = pt.table_for("annulus:0.8", accuracy=1e-5)
    assert builds == ["annulus:0.8"]
    np.testing.assert_array_equal(first.values, second.values)
    assert (second.tolerance, second.accuracy) == (1e-5, first.accuracy)
    (path,) = kept.iterdir()
    assert re.fullmatch(r"annulus-0\.8-1e-05-[0-9a-f]{16}\.h5", path.name)
    assert capsys.readouterr() == ("", "")
    pt.table_for("annulus:0.8", accuracy=1e-4)
    pt.table_for("ring", accuracy=1e-4)
    assert builds == ["annulus:0.8", "annulus:0.8", "ring"]


def test_inner_radii_that_differ_late_are_two_laws(builds: list[str]):
    a, b = (pt.table_for(f"annulus:0.812345{d}", accuracy=1e-4) for d in (6, 7))
    assert len(builds) == 2
    assert a.pressure_law != b.pressure_law
    assert a.validate(points=200).passed


def test_a_profile_is_its_values_not_its_name(builds, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("a.csv").write_text("rho,W\n0,2\n0.5,2\n1,1\n")
    Path("b.csv").write_text("0,20\n0.5,20\n1,10\n")  # the same shape
    tables = [pt.table_for(name, accuracy=1e-4) for name in ("a.csv", "b.csv")]
    assert builds == ["profile"]
    Path("a.csv").write_text("rho,W\n0,2\n0.5,2\n1,1.001\n")
    other = pt.table_for("a.csv", accuracy=1e-4)
    assert len(builds) == 2
    assert other.resultants(0.5, 0.5).spin != tables[0].resultants(0.5, 0.5).spin
    same = pt.table_for(pt.profile_law([0.0, 0.5, 1.0], [2.0, 2.0, 1.001]), accuracy=1e-4)
    assert len(builds) == 2
    assert same.validate(points=200).passed


def test_a_table_of_other_sources_is_not_todays(builds: list[str], monkeypatch: pytest.MonkeyPatch):
    pt.table_for("ring", accuracy=1e-4)
    monkeypatch.setattr(table_store, "source_digest", lambda *folders: "another version")
    pt.table_for("ring", accuracy=1e-4)
    assert len(builds) == 2


def test_the_digest_of_sources_sees_what_computes_a_table(tmp_path: Path):
    from puck_tables._core.sources import source_digest

    parts = ("contact", "kernels", "table")
    seen = {source_digest(*parts), source_digest(), source_digest("motion")}
    assert len(seen) == 3


HARMS = (
    "flip", "cut", "empty", "text", "folder", "full folder", "pipe", "link", "another",
)  # fmt: skip


@pytest.mark.parametrize("harm", HARMS)
def test_a_damaged_one_is_said_and_built_again(harm, kept, builds, capsys):
    whole = pt.table_for("ring", accuracy=1e-4)
    (path,) = kept.iterdir()
    content = path.read_bytes()
    if harm == "flip":
        path.write_bytes(content[:5000] + bytes([content[5000] ^ 4]) + content[5001:])
    elif "folder" in harm:
        path.unlink()
        path.mkdir()
        if harm == "full folder":
            (path / "mine").write_text("mine")
    elif harm == "pipe":
        path.unlink()
        os.mkfifo(path)
    elif harm == "link":
        other = kept.parent / "mine.txt"
        other.write_text("mine")
        path.unlink()
        path.symlink_to(other)
    elif harm == "another":  # whole, but not what its name says
        pt.table_for("ring", accuracy=1e-3)
        (other,) = set(kept.iterdir()) - {path}
        other.replace(path)
        builds.pop()
    else:
        path.write_bytes({"cut": content[:-1], "empty": b"", "text": b"puck"}[harm])
    capsys.readouterr()
    again = pt.table_for("ring", accuracy=1e-4)
    np.testing.assert_array_equal(again.values, whole.values)
    assert builds == ["ring", "ring"]
    said = capsys.readouterr()
    assert said.out == ""
    assert f"{path} is " in said.err
    assert "built again" in said.err
    if harm == "link":
        assert other.read_text() == "mine"
    if harm == "full folder":
        assert "not kept for the next time" in said.err
        assert (path / "mine").read_text() == "mine"
    else:
        pt.table_for("ring", accuracy=1e-4)
        assert len(builds) == 2


def test_a_folder_that_cannot_be_written_is_said_once(builds, monkeypatch, capsys):
    monkeypatch.setenv("XDG_CACHE_HOME", "/proc/none")  # not even root can write there
    for _ in range(2):
        assert pt.table_for("ring", accuracy=1e-4).tolerance == 1e-4
    assert len(builds) == 2
    said = capsys.readouterr().err.splitlines()
    assert len(said) == 1
    assert said[0].startswith("the table is used but not kept for the next time: ")


def test_a_full_disk_is_said_and_leaves_nothing(kept, monkeypatch, capsys):
    def full(descriptor: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.fsync", full)
    assert pt.table_for("ring", accuracy=1e-4).tolerance == 1e-4
    assert "No space left on device" in capsys.readouterr().err
    assert list(kept.iterdir()) == []


def test_no_home_at_all(monkeypatch: pytest.MonkeyPatch, tmp_path: Path):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("XDG_CACHE_HOME", "relative")  # void by the specification
    monkeypatch.setattr("os.path.expanduser", lambda path: path)
    assert table_store.tables_folder() is None
    assert pt.table_for("ring", accuracy=1e-4).tolerance == 1e-4
    assert kept_files() == []
    assert list(tmp_path.iterdir()) == []


def test_where_each_system_keeps_them(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("sys.platform", "darwin")
    assert table_store.tables_folder() == Path.home() / "Library/Caches/puck-tables/tables"
    monkeypatch.setattr("sys.platform", "win32")
    monkeypatch.setenv("LOCALAPPDATA", "/app")
    assert table_store.tables_folder() == Path("/app/puck-tables/tables")
    monkeypatch.setattr("sys.platform", "linux")
    monkeypatch.delenv("XDG_CACHE_HOME")
    assert table_store.tables_folder() == Path.home() / ".cache/puck-tables/tables"


@pytest.mark.thorough
def test_builders_at_once_leave_one_whole_table(kept: Path):
    code = "import puck_tables as pt; print(pt.table_for('galin', 1e-6).resultants(0.3, 0.5).spin)"
    compiled = str(Path(cache_folder() or "").parent)  # the tables are what is to be made anew
    running = [
        subprocess.Popen(
            [sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
            env={**os.environ, "NUMBA_CACHE_DIR": compiled},
        ) for _ in range(3)
    ]  # fmt: skip
    said = [process.communicate() for process in running]
    assert [process.returncode for process in running] == [0] * 3
    assert len({out for out, _ in said}) == 1
    (path,) = kept.iterdir()
    assert pt.Table.load(path).tolerance == 1e-6


def test_bad_requests():
    with pytest.raises(InputError, match="no pressure law is called"):
        pt.table_for("square")
    for accuracy in (1e-14, 1.0):
        with pytest.raises(AccuracyError, match="from 1e-11"):
            pt.table_for("ring", accuracy=accuracy)
    for accuracy in ("fine", float("nan")):
        with pytest.raises(InputError, match="accuracy must be a"):
            pt.table_for("ring", accuracy=accuracy)
    with pytest.raises(InputError, match="cannot be told from another"):
        pt.table_for(replace(pt.law_of("ring"), name="mine"))


def test_progress_is_told():
    told: list[tuple[int, int]] = []
    pt.table_for("ring", accuracy=1e-4, progress=lambda done, total: told.append((done, total)))
    assert len(told) > 3
    assert all(0 < done <= total for done, total in told)
    assert told == sorted(told, key=lambda pair: pair[::-1])  # a finer grid begins anew


def test_the_friction_of_a_tall_puck_is_kept(kept: Path, monkeypatch: pytest.MonkeyPatch):
    built: list[float] = []
    true = friction_section.friction_section

    def counted(law: pt.Law, delta: float, accuracy: float) -> pt.Table:
        built.append(delta)
        return true(law, delta, accuracy)

    monkeypatch.setattr(friction_section, "friction_section", counted)
    friction_section.friction_for.cache_clear()  # other tests have asked for the same
    first = simulate((1.0, 0.0), 5.0, delta=1.5, tol=1e-5)
    times = len(built)
    assert times == len(list(kept.iterdir())) > 0
    friction_section.friction_for.cache_clear()  # as in another process
    again = simulate((1.0, 0.0), 5.0, delta=1.5, tol=1e-5)
    assert len(built) == times
    assert again.stop_time == first.stop_time
    other = simulate((1.0, 0.0), 5.0, delta=1.5000001, tol=1e-5)
    assert len(built) > times
    assert other.stop_time != first.stop_time
    listed = invoke("tables").stdout
    assert listed.count("friction section") == len(list(kept.iterdir()))
    monkeypatch.setattr(table_store, "MOST_ALIKE", 3)
    for delta in (1.1, 1.2, 1.3):
        friction_section.friction_for(pt.law_of("uniform"), delta, 1e-4)
    assert sorted(path.name[:8] for path in kept.iterdir()) == ["tall-1.1", "tall-1.2", "tall-1.3"]
    simulate((1.0, 0.0), 5.0, delta=0.5, pressure="ring", tol=1e-5)
    assert "ring" not in invoke("tables").stdout  # made in no time


def test_stops_of_other_pucks_are_kept(kept: Path, monkeypatch: pytest.MonkeyPatch):
    """The second sweep over a height, pressure or gyration prepares nothing anew."""
    pucks = (
        {"delta": 1.5}, {"pressure": "ring", "delta": 0.5}, {"delta": 0.5, "gyration": 0.9},
        {"pressure": pt.profile_law([0.0, 1.0], [1.0, 0.5], name="stone.csv"), "delta": 0.4},
    )  # fmt: skip
    launches = (1.0, 0.0), np.linspace(0.0, 4.0, 301)
    first = [pt.stop(*launches, tol=1e-5, **one) for one in pucks]
    names = [path.name for path in kept.iterdir() if path.name.startswith("stops-")]
    assert len(names) == len(pucks)
    stop_section.stop_section_for.cache_clear()  # as in another process

    def refused(*what: object) -> None:
        raise AssertionError("it is tabulated again")

    monkeypatch.setattr(stop_section, "stop_section", refused)
    for one, before in zip(pucks, first, strict=True):
        again = pt.stop(*launches, tol=1e-5, **one)
        np.testing.assert_array_equal(again.stop_time, before.stop_time)
        np.testing.assert_array_equal(again.turn_angle, before.turn_angle)
        assert again.selections == before.selections
    with pytest.raises(AssertionError, match="tabulated again"):
        pt.stop(*launches, tol=1e-6, **pucks[0])
    assert invoke("tables").stdout.count("stop section") == len(pucks)
    own = pt.Table.build("ring", 1e-8)
    with pytest.raises(AssertionError, match="tabulated again"):  # of a table of one's own: not
        pt.stop(*launches, tol=1e-5, table=own, **pucks[1])


def test_a_law_that_borrows_a_name_is_not_taken_for_it(kept: Path):
    """Its stops are neither read nor kept under that name."""
    launches = (1.0, 0.0), np.linspace(0.0, 4.0, 301)
    true = pt.stop(*launches, tol=1e-5, pressure="ring", delta=0.5)
    false = replace(pt.law_of("galin"), name="ring")
    stops = pt.stop(*launches, tol=1e-5, pressure=false, delta=0.5)
    assert np.abs(stops.stop_time - true.stop_time).max() > 1e-3
    galin = pt.stop(*launches, tol=1e-5, pressure="galin", delta=0.5)
    np.testing.assert_array_equal(stops.stop_time, galin.stop_time)
    assert len([path for path in kept.iterdir() if path.name.startswith("stops-")]) == 2


def test_listed_removed_and_cleaned(kept: Path, tmp_path: Path):
    for law in ("ring", "hertz"):
        pt.table_for(law, accuracy=1e-4)
    names = sorted(path.name for path in kept.iterdir())
    (kept / names[0]).write_bytes(b"damaged")
    mine = [kept / "mine.h5", kept / "notes.txt", kept / "link-0123456789abcdef.h5"]
    mine[0].write_text("mine")
    mine[1].write_text("mine")
    mine[2].symlink_to(mine[1])
    listed = json.loads(invoke("tables", "--json").stdout)
    found = {entry["name"]: entry for entry in listed}
    assert set(found) == {"resultants.h5", "stops.h5", *names}
    assert [found[name]["whole"] for name in names] == [False, True]
    ring = found[names[1]]
    assert (ring["pressure_law"], ring["accuracy"]) == ("ring", 1e-4)
    assert (ring["bytes"], ring["place"]) == ((kept / names[1]).stat().st_size, str(kept))
    shown = invoke("tables")
    assert shown.output.isascii()
    assert [line.split()[0] for line in shown.stdout.splitlines()[3:5]] == names
    assert "damaged" in shown.stdout
    assert f"kept in {kept}" in shown.stdout

    removed = invoke("tables", "--remove", names[0])
    assert (removed.exit_code, removed.stdout) == (0, f"removed {kept / names[0]}\n")
    for name in (names[0], "resultants.h5", "mine.h5", "notes.txt", "../../x", mine[2].name):
        refused = invoke("tables", "--remove", name)
        assert (refused.exit_code, refused.stdout) == (2, "")
        assert f"no table {name} is kept" in refused.stderr
    left = kept / f".puck-{0:016}.part"  # of a builder that was killed while writing
    left.write_text("x")
    cleaned = invoke("tables", "--clean")
    assert cleaned.stdout == f"removed {kept / names[1]}\n"
    assert sorted(path.name for path in kept.iterdir()) == sorted(path.name for path in mine)
    assert mine[1].read_text() == "mine"
    assert "nothing to remove" in invoke("tables", "--clean").stdout
    assert invoke("tables", "--clean", "--json").exit_code == 2

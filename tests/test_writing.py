"""Every command that writes, at every place where it cannot: nothing lost, nothing half written."""

from __future__ import annotations

import os
import resource
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path

import pytest
from commands import invoke

from puck_tables._core import safe_write
from puck_tables.accuracy.method_errors import shipped_errors
from puck_tables.stopping.stop_table import StopTable

# {} is the output without its ending; the path that is written is the one that follows
COMMANDS: dict[str, tuple[list[str], str]] = {
    "simulate csv": (["simulate", "--v0", "1,0", "-o", "{}.csv"], "{}.csv"),
    "simulate h5": (["simulate", "--v0", "1,0", "-o", "{}.h5"], "{}.h5"),
    "simulate jsonl": (["simulate", "--v0", "1,0", "-o", "{}.jsonl"], "{}.jsonl"),
    "simulate png": (["simulate", "--v0", "1,0", "--plot", "{}.png"], "{}.png"),
    "scene csv": (["simulate", "--scene", "incline", "-o", "{}.csv"], "{}.csv"),
    "scene h5": (["simulate", "--scene", "incline", "-o", "{}.h5"], "{}.h5"),
    "scene png": (["simulate", "--scene", "incline", "--plot", "{}.png"], "{}.png"),
    "sweep scene": (
        ["sweep", "--scene", "incline", "--set", "launch.spin=0:9:3", "-o", "{}.h5"], "{}.h5"
    ),
    "asperity csv": (["asperity", "--speeds", "0:9:9", "-o", "{}.csv"], "{}.csv"),
    "asperity png": (["asperity", "--speeds", "0:9:9", "--plot", "{}.png"], "{}.png"),
    "sweep csv": (["sweep", "--w0", "0:1:9", "-o", "{}.csv"], "{}.csv"),
    "sweep h5": (["sweep", "--w0", "0:1:9", "-o", "{}.h5"], "{}.h5"),
    "sweep png": (["sweep", "--w0", "0:1:9", "--plot", "{}.png"], "{}.png"),
    "aim csv": (["aim", "--target", "2,0.1", "-o", "{}.csv"], "{}.csv"),
    "aim png": (["aim", "--target", "2,0.1", "--plot", "{}.png"], "{}.png"),
    "build resultants": (["build-tables", "--accuracy", "1e-5", "-o", "{}.h5"], "{}.h5"),
    "build stops": (["build-tables", "--kind", "stops", "--cells", "8", "-o", "{}.h5"], "{}.h5"),
    "build law": (["build-tables", "--pressure", "ring", "--cells", "8", "-o", "{}.h5"], "{}.h5"),
    "tradeoff csv": (["tradeoff", "-o", "{}.csv"], "{}.csv"),
    "tradeoff h5": (["tradeoff", "-o", "{}.h5"], "{}.h5"),
}  # fmt: skip

_built = StopTable.built


@cache
def built_once(of: str, cells: int) -> StopTable:
    return _built(of, cells=cells)


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An own folder, and little work: what is done there has tests of its own."""
    from puck_tables.tradeoff import measurement

    measured = measurement.TradeOff(shipped_errors(), {"processor": "any"}, 25, 80.0)
    monkeypatch.setattr(measurement, "measure", lambda quick, show: measured)
    monkeypatch.setattr(
        StopTable, "built", lambda of, accuracy, cells, progress: built_once(of, cells)
    )
    monkeypatch.chdir(tmp_path)
    return tmp_path


def puck(name: str, place: str, *more: str) -> tuple[int, str]:
    result = invoke(*([part.format(place) for part in COMMANDS[name][0]] + [*more]))
    assert result.exit_code == 0 or isinstance(result.exception, SystemExit), result.exception
    return result.exit_code, result.stderr


def refused(name: str, place: str, *more: str) -> str:
    """One sentence on stderr, exit code 1."""
    code, said = puck(name, place, *more)
    assert code == 1, said
    assert said.count("Error: ") == 1
    assert said.splitlines()[-1].startswith("Error: ")
    return said


def content(folder: Path) -> dict[str, bytes]:
    return {str(path): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.mark.thorough
@pytest.mark.parametrize("name", COMMANDS)
def test_files_that_exist_are_kept(name: str, folder: Path):
    path = Path(COMMANDS[name][1].format("old"))
    path.parent.mkdir(exist_ok=True)
    path.write_text("mine")
    assert "exists already; use --overwrite" in refused(name, "old")
    assert path.read_text() == "mine"
    code, said = puck(name, "old", "--overwrite")
    assert (code, f"wrote {path}" in said) == (0, True), said
    assert path.stat().st_size > 100
    assert not list(folder.rglob(".puck-*"))


@pytest.mark.parametrize("name", COMMANDS)
def test_places_where_nothing_can_be_written(name: str, folder: Path):
    """/proc takes no files, not even from root; what is there already is no file to replace."""
    assert "cannot " in refused(name, "/proc/none")
    path = Path(COMMANDS[name][1].format("at"))
    for make in (Path.mkdir, os.mkfifo, lambda path: path.symlink_to("/dev/full")):
        path.parent.mkdir(exist_ok=True)
        make(path)
        said = refused(name, "at", "--overwrite")
        assert f"cannot write {path}" in said
        path.rmdir() if path.is_dir() else path.unlink()
    assert "none does not exist" in refused(name, "none/at")
    assert content(folder) == {}


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write anywhere")
def test_a_read_only_folder(folder: Path):
    folder.chmod(0o500)
    for name in COMMANDS:
        assert "cannot " in refused(name, "at")


@pytest.mark.thorough
@pytest.mark.parametrize("name", COMMANDS)
def test_a_folder_that_vanishes_during_the_work(name, folder, monkeypatch):
    target = Path("gone", COMMANDS[name][1].format("new"))
    target.parent.mkdir(parents=True)
    true: Callable[..., object] = safe_write.new_part

    def gone(*given: object, **named: object) -> object:
        shutil.rmtree("gone", ignore_errors=True)
        return true(*given, **named)

    monkeypatch.setattr(safe_write, "new_part", gone)
    assert "No such file or directory" in refused(name, "gone/new")
    assert not Path("gone").exists()


@contextmanager
def little_room() -> Iterator[None]:
    """No file may grow beyond 600 bytes, pytest's own neither: a full disk, without a patch."""
    room = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (600, room[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, room)


@pytest.mark.parametrize("name", COMMANDS)
def test_a_full_disk(name: str, folder: Path):
    path = folder / COMMANDS[name][1].format("old")
    path.write_text("mine")
    with little_room():
        said = refused(name, "old", "--overwrite").splitlines()[-1]
    assert said.startswith("Error: cannot ") and "File too large" in said
    assert content(folder) == {str(path): b"mine"}


@pytest.mark.thorough
def test_no_room_for_compiled_code(folder: Path):
    """A full cache disk costs time, not the answer."""
    code = (
        "import resource; resource.setrlimit(resource.RLIMIT_FSIZE, (600, 600))\n"
        "import puck_tables as p; print(float(p.motion.limit_ratio(0.0)))"
    )
    ended = subprocess.run(
        [sys.executable, "-c", code], env={**os.environ, "NUMBA_CACHE_DIR": str(folder)},
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert (round(float(ended.stdout), 12), ended.stderr) == (1.531389372174, "")
    assert content(folder) == {}

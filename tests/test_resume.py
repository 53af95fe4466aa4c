"""A resumed sweep goes on with its own work only: whatever determines a bit is known again."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pucks import sweep
from scenes import sweep_scene

from puck_tables import Table, profile_law
from puck_tables._core import checkpoint as kept_work
from puck_tables._core.checkpoint import Checkpoint, work_digest
from puck_tables.errors import InputError, OutputError

W0 = np.linspace(0.1, 5.0, 7)
PLAIN: dict[str, Any] = {"spin": W0, "speed": [0.5, 1.0], "delta": 0.5, "tol": 1e-8}
INTEGRATED: dict[str, Any] = {"spin": W0, "velocity": (1.0, 0.0), "tol": 1e-5, "method": "rk4"}
OTHER: dict[str, Any] = {"spin": W0, "velocity": (1.0, 0.0), "pressure": "ring", "tol": 1e-5}


def changed_table() -> Any:
    """As the one that comes along, but in one bit."""
    table = Table.shipped("stops")
    values = table.values.copy()
    values[5, 5, 0] = np.nextafter(values[5, 5, 0], 2.0)
    return replace(table, values=values)


CHANGES: list[tuple[dict[str, Any], dict[str, Any]]] = [
    (PLAIN, {"spin": np.nextafter(W0, 9.0)}), (PLAIN, {"spin": W0[::-1].copy()}),
    (PLAIN, {"speed": [0.5, 1.5]}), (PLAIN, {"delta": 0.5000001}), (PLAIN, {"radius": 2.0}),
    (PLAIN, {"decel": 2.0}), (PLAIN, {"tol": 1e-4}), (PLAIN, {"method": "adaptive"}),
    (PLAIN, {"method": "rk4"}), (PLAIN, {"table": changed_table}),
    (PLAIN, {"table": Table.shipped}), (PLAIN, {"gyration": 0.9}), (PLAIN, {"pressure": "ring"}),
    (PLAIN, {"chunk": 5}),
    (INTEGRATED, {"method": "adaptive"}), (INTEGRATED, {"method": None}),
    (INTEGRATED, {"tol": 1e-6}), (INTEGRATED, {"velocity": (1.0, 1e-9)}),
    (INTEGRATED, {"velocity": (0.0, 1.0)}),
    (INTEGRATED, {"table": lambda: Table.build(accuracy=1e-9)}),
    (OTHER, {"pressure": "annulus:0.9"}), (OTHER, {"gyration": 1.0}), (OTHER, {"tol": 1e-4}),
    (OTHER, {"method": "adaptive"}), (OTHER, {"method": "rk4"}),
    (OTHER, {"pressure": lambda: profile_law([0.0, 1.0], [1.0, 0.5])}),
]  # fmt: skip


def made(arguments: dict[str, Any]) -> dict[str, Any]:
    return {name: value() if callable(value) else value for name, value in arguments.items()}


@pytest.mark.parametrize(("base", "change"), CHANGES)
def test_progress_is_refused_when_any_argument_changed(
    base: dict[str, Any], change: dict[str, Any], tmp_path: Path
):
    path = tmp_path / "a.progress"
    first = sweep(**base, checkpoint=path)
    whole = path.read_bytes()
    with pytest.raises(InputError, match="is not what is done of this work"):
        sweep(**made({**base, **change}), checkpoint=path)
    assert path.read_bytes() == whole
    again = sweep(**base, checkpoint=path)
    np.testing.assert_array_equal(again.stop_time, first.stop_time)


def test_progress_of_other_sources_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    sweep(**PLAIN, checkpoint=tmp_path / "a.progress")
    monkeypatch.setattr(kept_work, "source_digest", lambda: "after an edit")
    with pytest.raises(InputError, match="is not what is done"):
        sweep(**PLAIN, checkpoint=tmp_path / "a.progress")


def test_a_profile_changed_under_its_name_is_other_work(tmp_path: Path):
    file = tmp_path / "profile.csv"
    file.write_text("0,1\n1,0.5\n")
    given = {**OTHER, "pressure": str(file)}
    sweep(**given, checkpoint=tmp_path / "a.progress")
    file.write_text("0,1\n1,0.5000001\n")
    with pytest.raises(InputError, match="is not what is done"):
        sweep(**given, checkpoint=tmp_path / "a.progress")


def scene_of(folder: Path) -> dict[str, Any]:
    """A scene with all the files that one may name."""
    (folder / "force.csv").write_text("t,Fx,Fy\n0,0.01,0\n9,0,0\n")
    (folder / "profile.csv").write_text("0,1\n1,0.5\n")
    return {
        "puck": {
            "radius": 0.04, "mass": 0.2, "friction": 0.15, "pressure": str(folder / "profile.csv"),
        },
        "floor": {"slope": "0.01:0.05:3"},
        "force": {"over_time": str(folder / "force.csv")},
        "launch": {"velocity": [0.5, 0.1], "spin": 3.0}, "run": {"tol": 1e-4},
    }  # fmt: skip


def edited(name: str, text: str) -> Callable[[dict[str, Any], Path], None]:
    return lambda scene, folder: (folder / name).write_text(text) and None


def put(part: str, name: str, value: Any) -> Callable[[dict[str, Any], Path], None]:
    return lambda scene, folder: scene[part].__setitem__(name, value)


SCENE_CHANGES = {
    "the force": edited("force.csv", "t,Fx,Fy\n0,0.01,0\n9,0,0.0001\n"),
    "the profile": edited("profile.csv", "0,1\n1,0.6\n"),
    "a range": put("floor", "slope", "0.01:0.06:3"),
    "the friction": put("puck", "friction", 0.16),
    "the radius": put("puck", "radius", 0.05),
    "the mass": put("puck", "mass", 0.3),
    "the spin": put("launch", "spin", 3.0000001),
    "the velocity": put("launch", "velocity", [0.5, 0.2]),
    "the tolerance": put("run", "tol", 1e-5),
    "a time": put("run", "time", 100.0),
    "a file in place of another": put("force", "over_time", ""),
}


@pytest.mark.parametrize("name", SCENE_CHANGES)
def test_progress_of_a_scene_is_refused_when_any_input_changed(name: str, tmp_path: Path):
    path, scene = tmp_path / "a.progress", scene_of(tmp_path)
    sweep_scene(scene, checkpoint=path)
    whole = path.read_bytes()
    SCENE_CHANGES[name](scene, tmp_path)
    with pytest.raises(InputError, match="is not what is done"):
        sweep_scene(scene, checkpoint=path)
    assert path.read_bytes() == whole


def test_a_friction_law_that_changed_is_other_work():
    texts = ("0,0.3\n1,0.2\n", "0,0.3\n1,0.21\n")
    folder = Path.cwd()
    file = folder / "law.txt"  # no ending tells that it is a file
    digests = set()
    try:
        for text in texts:
            file.write_text(text)
            files = kept_work.files_named({"floor": {"law": "law.txt"}})
            digests.add(work_digest(files=files))
    finally:
        file.unlink()
    assert len(digests) == 2


def test_a_file_that_changes_while_it_is_swept_ends_the_sweep(tmp_path: Path):
    scene = scene_of(tmp_path)

    def changes(done: int, total: int) -> None:
        edited("force.csv", "t,Fx,Fy\n0,0.02,0\n9,0,0\n")(scene, tmp_path)

    with pytest.raises(InputError, match=r"was changed while it was swept .*force\.csv"):
        sweep_scene(scene, chunk=1, threads=1, progress=changes, checkpoint=tmp_path / "a.progress")


def test_a_progress_file_cut_in_use_costs_nothing(tmp_path: Path):
    """Memory that maps a file dies with it (SIGBUS)."""
    path = tmp_path / "a.progress"
    rng = np.random.default_rng(1)
    parts = rng.random((4, 2, 3))
    with Checkpoint(path, "work", 2, 12, 3) as kept:
        for i, part in enumerate(parts):
            kept.put(3 * i, 3 * i + 3, part, np.full(3, i, np.int8))
            with open(path, "r+b") as file:
                file.truncate(100 if i == 1 else 4096)
        np.testing.assert_array_equal(kept.values, np.concatenate(parts, axis=1))
        assert kept.status.tolist() == [0, 0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 3]
        assert not kept.is_done(0)
    with pytest.raises(InputError, match="is not what is done"):
        Checkpoint(path, "work", 2, 12, 3)


def test_what_is_kept_of_a_progress_file_with_holes(tmp_path: Path):
    path = tmp_path / "a.progress"
    parts = np.random.default_rng(2).random((4, 2, 3))
    with Checkpoint(path, "work", 2, 11, 3) as kept:
        for start in (0, 9):
            stop = min(start + 3, 11)
            kept.put(start, stop, parts[0][:, : stop - start], np.ones(stop - start, np.int8))
    with Checkpoint(path, "work", 2, 11, 3) as kept:
        assert [kept.is_done(start) for start in (0, 3, 6, 9)] == [True, False, False, True]
        np.testing.assert_array_equal(kept.values[:, 9:], parts[0][:, :2])
        assert kept.status[9:].tolist() == [1, 1]


def test_a_full_disk_is_a_sentence(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    class Full:
        """A file on a full disk."""

        def __init__(self, file: Any) -> None:
            self.file = file

        def __getattr__(self, name: str) -> Any:
            return getattr(self.file, name)

        def write(self, content: bytes) -> int:
            return int(self.file.write(content[:10]))

    with Checkpoint(tmp_path / "a.progress", "work", 1, 4, 2) as kept:
        kept._file = Full(kept._file)
        with pytest.raises(OutputError, match="No space left"):
            kept.put(0, 2, np.ones((1, 2)), np.zeros(2, np.int8))
        assert not kept.is_done(0)


def test_what_does_not_say_what_it_is_is_refused():
    with pytest.raises(TypeError, match="does not say what it is"):
        work_digest(law=lambda u: u)
    arrays = [np.zeros(2), np.zeros(2, np.float32), np.zeros((1, 2)), np.zeros(3), 0.0, [0.0, 0.0]]
    assert len({work_digest(x=array) for array in arrays}) == len(arrays)

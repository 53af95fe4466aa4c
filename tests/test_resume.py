"""A resumed sweep goes on with its own work only: whatever determines a bit is known again."""

from __future__ import annotations

import pickle
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pucks import sweep
from scenes import sweep_scene
from test_one_store import content

from puck_tables import Scene, Table, profile_law
from puck_tables._core import digest as kept_work
from puck_tables._core.digest import work_digest
from puck_tables.errors import InputError
from puck_tables.scene.entries import set_path
from puck_tables.world.runs import Runs

pytest.importorskip("zarr")
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


CHANGES: list[tuple[dict[str, Any], list[dict[str, Any]]]] = [
    (PLAIN, [
        {"spin": np.nextafter(W0, 9.0)}, {"spin": W0[::-1].copy()}, {"speed": [0.5, 1.5]},
        {"delta": 0.5000001}, {"radius": 2.0}, {"decel": 2.0}, {"tol": 1e-4},
        {"method": "adaptive"}, {"method": "rk4"}, {"table": changed_table},
        {"table": Table.shipped}, {"gyration": 0.9}, {"pressure": "ring"},
    ]),
    (INTEGRATED, [
        {"method": "adaptive"}, {"method": None}, {"tol": 1e-6}, {"velocity": (1.0, 1e-9)},
        {"velocity": (0.0, 1.0)}, {"table": lambda: Table.build(accuracy=1e-9)},
    ]),
    (OTHER, [
        {"pressure": "annulus:0.9"}, {"gyration": 1.0}, {"tol": 1e-4}, {"method": "adaptive"},
        {"method": "rk4"}, {"pressure": lambda: profile_law([0.0, 1.0], [1.0, 0.5])},
    ]),
]  # fmt: skip


def made(arguments: dict[str, Any]) -> dict[str, Any]:
    return {name: value() if callable(value) else value for name, value in arguments.items()}


@pytest.mark.parametrize(("base", "changes"), CHANGES, ids=["plain", "integrated", "other"])
def test_a_store_is_refused_when_any_argument_changed(base, changes, tmp_path):
    path = tmp_path / "a.zarr"
    first = sweep(**base, store=path).load()
    whole = content(path)
    for change in changes:
        with pytest.raises(InputError, match="holds other work"):
            sweep(**made({**base, **change}), store=path)
        assert content(path) == whole, change
    again = sweep(**base, store=path, chunk=3).load()
    np.testing.assert_array_equal(again.stop_time, first.stop_time)


def test_a_store_of_other_sources_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    sweep(**PLAIN, store=tmp_path / "a.zarr")
    monkeypatch.setattr(kept_work, "program", lambda: ("after an edit",))
    with pytest.raises(InputError, match="holds other work"):
        sweep(**PLAIN, store=tmp_path / "a.zarr")


def test_a_profile_changed_under_its_name_is_other_work(tmp_path: Path):
    file = tmp_path / "profile.csv"
    file.write_text("0,1\n1,0.5\n")
    given = {**OTHER, "pressure": str(file)}
    sweep(**given, store=tmp_path / "a.zarr")
    file.write_text("0,1\n1,0.5000001\n")
    with pytest.raises(InputError, match="holds other work"):
        sweep(**given, store=tmp_path / "a.zarr")


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
        "launch": {"velocity": [0.5, 0.1], "spin": 3.0}, "tol": 1e-4,
    }  # fmt: skip


def edited(name: str, text: str) -> Callable[[dict[str, Any], Path], None]:
    return lambda scene, folder: (folder / name).write_text(text) and None


def put(path: str, value: Any) -> Callable[[dict[str, Any], Path], None]:
    return lambda scene, folder: set_path(scene, path, value)


SCENE_CHANGES = {
    "the force": edited("force.csv", "t,Fx,Fy\n0,0.01,0\n9,0,0.0001\n"),
    "the profile": edited("profile.csv", "0,1\n1,0.6\n"),
    "a range": put("floor.slope", "0.01:0.06:3"), "the friction": put("puck.friction", 0.16),
    "the radius": put("puck.radius", 0.05), "the mass": put("puck.mass", 0.3),
    "the spin": put("launch.spin", 3.0000001), "the velocity": put("launch.velocity", [0.5, 0.2]),
    "the tolerance": put("tol", 1e-5), "a time": put("time", 100.0),
    "a file in place of another": put("force.over_time", ""),
}  # fmt: skip


def test_a_store_of_a_scene_is_refused_when_any_input_changed(tmp_path: Path):
    path = tmp_path / "a.zarr"
    sweep_scene(scene_of(tmp_path), store=path)
    whole = content(path)
    for name, change in SCENE_CHANGES.items():
        change(scene := scene_of(tmp_path), tmp_path)
        with pytest.raises(InputError, match="holds other work"):
            sweep_scene(scene, store=path)
        assert content(path) == whole, name


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


def test_a_file_that_changes_while_it_is_swept_ends_the_sweep(tmp_path, monkeypatch):
    scene, once = scene_of(tmp_path), Runs.of

    def changes(self: Runs, start: int, stop: int) -> Any:
        """After the first run, whenever the thread that is told of it wakes up."""
        found = once(self, start, stop)
        edited("force.csv", "t,Fx,Fy\n0,0.02,0\n9,0,0\n")(scene, tmp_path)
        return found

    with monkeypatch.context() as within:
        within.setattr(Runs, "of", changes)
        with pytest.raises(InputError, match=r"was changed while it was swept .*force\.csv"):
            sweep_scene(scene, chunk=1, threads=1)
    work = Runs(Scene.from_tables(scene_of(tmp_path)), 1)
    sent = pickle.dumps(work)
    edited("force.csv", "t,Fx,Fy\n0,0.03,0\n9,0,0\n")(scene, tmp_path)
    with pytest.raises(InputError, match="was changed while it was swept"):  # nor on a worker
        pickle.loads(sent).of(0, 1)


def test_what_does_not_say_what_it_is_is_refused():
    with pytest.raises(TypeError, match="does not say what it is"):
        work_digest(law=lambda u: u)
    arrays = [np.zeros(2), np.zeros(2, np.float32), np.zeros((1, 2)), np.zeros(3), 0.0, [0.0, 0.0]]
    assert len({work_digest(x=array) for array in arrays}) == len(arrays)

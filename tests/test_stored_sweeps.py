"""Sweeps into a Zarr store: whole blocks or none, checked, gone on with, and the same bytes."""

from __future__ import annotations

import errno
import itertools
import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from commands import invoke
from test_one_store import content

from puck_tables import Puck, Scene
from puck_tables._core import safe_write
from puck_tables.bulk.store import Blocks
from puck_tables.errors import InputError, OutputError
from puck_tables.scene.entries import set_path
from puck_tables.scene.library import find_scene

zarr = pytest.importorskip("zarr")

PUCK = Puck.similar()
GRID: dict[str, Any] = {"spin": np.linspace(-3.0, 3.0, 301), "speed": np.linspace(0.0, 2.0, 200)}
OUTPUTS = ("stop_time", "stop_x", "stop_y", "path_length", "turn_angle", "body_angle", "status")


def test_a_store_holds_the_bits_of_the_map(tmp_path: Path):
    path = tmp_path / "m.zarr"
    whole, kept = PUCK.sweep(**GRID), PUCK.sweep(**GRID, store=path, threads=1)
    assert kept.load() == whole
    again = PUCK.sweep(**GRID, store=tmp_path / "n.zarr", threads=3, chunk=77)
    assert content(again.path) == content(path)
    xarray = pytest.importorskip("xarray")
    with xarray.open_zarr(path) as data:
        for name in OUTPUTS:
            assert data[name].values.tobytes() == getattr(whole, name).tobytes()
            assert data[name].dtype == getattr(whole, name).dtype
        assert data.stop_time.units == "s"
        assert data.launch_spin.values.tolist() == GRID["spin"].tolist()
    assert kept.to_xarray().stop_x.dims == ("launch_speed", "launch_spin")


def test_what_is_damaged_or_missing_is_done_again_and_nothing_else(tmp_path: Path):
    path = tmp_path / "m.zarr"
    PUCK.sweep(**GRID, store=path)
    before = content(path)
    blocks = sorted((path / "stop_x" / "c").rglob("*/0"))
    assert len(blocks) >= 4
    flipped = bytearray(blocks[0].read_bytes())
    flipped[100] ^= 1
    blocks[0].write_bytes(flipped)
    blocks[1].write_bytes(b"")
    blocks[2].unlink()
    blocks[3].write_bytes(bytes(len(flipped)))  # as a crash of the machine may leave it
    kept = {file: file.stat().st_mtime_ns for file in (path / "stop_y" / "c").rglob("*/0")}
    PUCK.sweep(**GRID, store=path)
    assert content(path) == before
    touched = {file for file, when in kept.items() if file.stat().st_mtime_ns != when}
    assert len(touched) == 4


def test_blocks_of_launches_too_large_are_results_too(tmp_path: Path):
    grid = {"spin": [0.0, 1.0], "speed": np.linspace(1e160, 1e161, 9)}
    with pytest.raises(InputError, match="too large for floating point"):
        PUCK.sweep(**grid, store=tmp_path / "m.zarr")
    some = PUCK.sweep(spin=[0.0], speed=[1.0, 1e160], store=tmp_path / "n.zarr")
    assert some.tally.counts == {0: 1, 2: 1}
    assert np.isnan(some.load().stop_x[1, 0])


def test_a_full_disk_is_a_sentence_and_what_is_kept_stays(tmp_path, monkeypatch):
    true, calls = safe_write.hold, itertools.count()

    def hold(descriptor: int) -> None:
        if next(calls) > 40:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        true(descriptor)

    path = tmp_path / "m.zarr"
    monkeypatch.setattr(safe_write, "hold", hold)
    with pytest.raises(OutputError, match="No space left"):
        PUCK.sweep(**GRID, store=path, threads=1)
    monkeypatch.undo()
    assert len(list((path / "status" / "made").iterdir())) > 0
    assert PUCK.sweep(**GRID, store=path).load() == PUCK.sweep(**GRID)


def test_places_where_no_store_can_be(tmp_path: Path):
    for place in ("/proc/none.zarr", tmp_path / "none" / "m.zarr"):
        with pytest.raises(OutputError, match="cannot write"):
            PUCK.sweep([1.0], 1.0, store=place)
    with pytest.raises(InputError, match=r"must have the ending \.zarr"):
        PUCK.sweep([1.0], 1.0, store=tmp_path / "m.h5")
    with pytest.raises(InputError, match="a cluster writes to a Zarr store"):
        PUCK.sweep([1.0], 1.0, cluster="local:2")


@pytest.mark.parametrize("scene", ["incline", "carrom-break"])
def test_maps_of_scenes_and_boards_in_a_store(scene: str, tmp_path: Path):
    ranges = {"incline": {"launch.spin": [0.0, 9.0, 20.0]}, "carrom-break": {
        "puck[0].launch.velocity[0]": [0.5, 1.0]}}[scene]  # fmt: skip
    given = find_scene(scene)
    for path, values in ranges.items():
        set_path(given, path, values)
    ranged = Scene.from_tables(given)
    whole, kept = ranged.sweep(), ranged.sweep(store=tmp_path / "m.zarr", threads=1)
    assert kept.load() == whole
    assert kept.explain()
    xarray = pytest.importorskip("xarray")
    with xarray.open_zarr(tmp_path / "m.zarr") as data:
        assert data.x.values.tobytes() == whole.columns["x"].tobytes()
        assert data.attrs["title"] == whole.scene.title


@pytest.mark.thorough
def test_the_command_line_writes_a_store_and_draws_it(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    words = ["sweep", "--w0", "0:5:30", "--speed", "0:2:20", "-o", "m.zarr", "--plot", "m.png"]
    for _ in range(2):
        result = invoke(*words, "--overwrite")
        assert result.exit_code == 0, result.stderr
        assert "600 stopped; look-up" in result.stderr
        assert Path("m.png").stat().st_size > 10_000
    result = invoke("sweep", "--w0", "0:5:31", "-o", "m.zarr")
    assert (result.exit_code, "holds other work" in result.stderr) == (2, True)


@pytest.mark.parametrize("shape", [(), (1,), (7,), (3, 10), (2, 3, 5), (4, 1, 6), (1, 1, 1)])
@pytest.mark.parametrize("size", [1, 2, 5, 6, 14, 1000])
def test_blocks_are_boxes_and_runs_that_cover_all_once(shape: tuple[int, ...], size: int):
    blocks, numbers = Blocks(shape, size), np.arange(int(np.prod(shape))).reshape(shape)
    seen: list[int] = []
    for block in range(blocks.count):
        start, stop = blocks.run(block)
        inside = numbers[blocks.slices(block)].ravel()
        assert inside.tolist() == list(range(start, stop))
        assert 1 <= inside.size <= max(size, 1)
        seen += inside.tolist()
    assert seen == list(range(numbers.size))

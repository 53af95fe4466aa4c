"""One store, several works: it belongs to one of them; nothing is mixed, lost or left behind."""

from __future__ import annotations

import itertools
import os
import random
import re
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rarely import nightly, thorough

from puck_tables import Puck
from puck_tables._core import partial_files
from puck_tables._core.safe_write import write_bytes
from puck_tables.bulk import store_folder
from puck_tables.errors import InputError, OutputError, PuckError
from puck_tables.stopping.stop_sweep import StopWork

zarr = pytest.importorskip("zarr")
pytestmark = pytest.mark.skipif(os.name == "nt", reason="locks of another kind")

PUCK = Puck.similar()
SPEEDS = np.linspace(0.0, 2.0, 64)
COLUMNS = ("stop_time", "stop_x", "stop_y", "path_length", "turn_angle", "body_angle", "status")


def grid(which: int) -> dict[str, Any]:
    return {"spin": np.linspace(-4.0, which, 60), "speed": SPEEDS, "chunk": 32}


def names(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


def refuse_wrong(store: Path, whole: bool) -> int:
    """Refuse a store that is not that of one work, with what is done of it; which work it is."""
    group = zarr.open_group(store, mode="r")
    which = round(float(group["launch_spin"][-1]))
    truth = PUCK.sweep(**grid(which))
    for name in ("launch_spin", "launch_speed"):
        np.testing.assert_array_equal(group[name][...], truth.axes[name])
    done = group["status"][...] >= 0
    assert done.all() or not whole
    for name in COLUMNS:
        np.testing.assert_array_equal(group[name][...][done], getattr(truth, name)[done])
    return which


def left(store: Path) -> list[str]:
    """What an end in the middle of writing leaves."""
    everywhere = [*store.parent.iterdir(), *(store.rglob("*") if store.exists() else ())]
    return [path.name for path in everywhere if re.search(r"part|\.new", path.name)]


# a sweep with pauses between its files, where others come in
SLOW = """
import random, sys, time
sys.path.insert(0, {tests!r})
from test_one_store import PUCK, grid
from puck_tables.bulk.store_folder import Place
from puck_tables.errors import PuckError
draw, put = random.Random({seed}), Place.put
def slow(self, key, content):
    time.sleep(draw.choice([0.0, 0.0, 0.002, 0.02]))
    put(self, key, content)
    time.sleep(draw.choice([0.0, 0.0, 0.002, 0.02]))
Place.put = slow
from puck_tables.stopping.stop_sweep import StopWork
StopWork.block = 300
try:
    PUCK.sweep(**grid({which}), threads={threads}, store="m.zarr", overwrite={overwrite})
except PuckError as error:
    sys.exit(str(error))
"""


def fight(draw: random.Random, folder: Path) -> None:
    """Two to four processes on one store, begun and killed at any moments; then one alone."""
    store = folder / "m.zarr"
    before = draw.random() < 0.6
    if before:
        PUCK.sweep(**grid(0), store=store)
    running: list[tuple[subprocess.Popen[str], float, bool]] = []
    for _ in range(draw.randint(2, 4)):
        code = SLOW.format(
            tests=str(Path(__file__).parent), seed=draw.random(), which=draw.randint(0, 3),
            threads=draw.randint(1, 2), overwrite=draw.random() < 0.7,
        )  # fmt: skip
        one = subprocess.Popen(
            [sys.executable, "-c", code], cwd=folder, stderr=subprocess.PIPE, text=True
        )
        killed = draw.random() < 0.4
        running.append((one, time.monotonic() + draw.uniform(1.5, 6.0), killed))
        time.sleep(draw.choice([0.0, 0.3, 1.0]))
    whole = before
    while running:
        for entry in list(running):
            one, due, killed = entry
            if one.poll() is None and killed and time.monotonic() > due:
                one.send_signal(draw.choice([signal.SIGKILL, signal.SIGTERM]))
                one.wait()
            if one.poll() is not None:
                running.remove(entry)
                said = one.communicate()[1]
                if one.returncode >= 0:  # it ended by itself
                    assert "Traceback" not in said, said
                    assert one.returncode == 0 or len(said.splitlines()) == 1, said
                whole = whole or one.returncode == 0
        time.sleep(0.05)
    if whole or store.exists():
        refuse_wrong(store, whole)
    last = draw.randint(0, 3)
    kept = PUCK.sweep(**grid(last), store=store, overwrite=True)
    assert refuse_wrong(store, True) == last
    assert kept.load() == PUCK.sweep(**grid(last))
    assert names(folder) == ["m.zarr"] and left(store) == []


@pytest.mark.parametrize("seed", [thorough(1), *map(nightly, range(2, 10))])
def test_processes_on_one_store(seed: int, tmp_path: Path):
    fight(random.Random(seed), tmp_path)


def content(store: Path) -> dict[str, bytes]:
    return {
        str(one.relative_to(store)): one.read_bytes() for one in store.rglob("*") if one.is_file()
    }


@pytest.fixture
def small_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(StopWork, "block", 400)


@pytest.mark.usefixtures("small_blocks")
@pytest.mark.parametrize("before", ["nothing", "whole"])
def test_whoever_lost_a_store_stops(before: str, tmp_path: Path):
    """The first is at work, and gave way to the second in the middle."""
    store = tmp_path / "m.zarr"
    if before != "nothing":
        PUCK.sweep(**grid(0), store=store)

    def taken(done: int, total: int) -> None:
        if not seen:
            seen.append(PUCK.sweep(**grid(2), store=store, overwrite=True))

    seen: list[Any] = []
    with pytest.raises(OutputError, match="taken over by another work"):
        PUCK.sweep(**grid(1), store=store, overwrite=before != "nothing", threads=1, progress=taken)
    assert refuse_wrong(store, True) == 2
    assert seen[0].load() == PUCK.sweep(**grid(2))
    with pytest.raises(InputError, match="holds other work"):
        PUCK.sweep(**grid(1), store=store)
    assert names(tmp_path) == ["m.zarr"] and left(store) == []


@pytest.mark.usefixtures("small_blocks")
def test_a_store_that_is_being_replaced_is_not_gone_on_with(tmp_path: Path):
    store = tmp_path / "m.zarr"
    PUCK.sweep(**grid(0), store=store)

    def at_once(done: int, total: int) -> None:
        with pytest.raises(InputError, match="is being replaced by another work"):
            PUCK.sweep(**grid(0), store=store)

    PUCK.sweep(**grid(1), store=store, overwrite=True, threads=1, progress=at_once)
    assert refuse_wrong(store, True) == 1


REFUSED = ("too large", "in the middle", "no table is so good", "a full disk")


@pytest.mark.usefixtures("small_blocks")
@pytest.mark.parametrize("why", REFUSED)
def test_what_is_refused_has_replaced_nothing(why, tmp_path, monkeypatch):
    (tmp_path / "here").mkdir()
    store = tmp_path / "here" / "m.zarr"
    PUCK.sweep([1.0, 2.0], 1.0, store=store)
    before = content(store)
    given: dict[str, Any] = {"store": store, "overwrite": True, "spin": [0.0], "speed": [1.0, 3.0]}
    if why == "in the middle":
        given |= grid(1)
    more: dict[str, Any] = {
        "too large": {"speed": np.linspace(1e160, 1e161, 9)}, "no table is so good": {"tol": 1e-30},
    }  # fmt: skip
    put, of, calls = store_folder.Place.put, StopWork.of, itertools.count()

    def full(self: Any, key: str, content: bytes) -> None:
        if next(calls) > 3:
            raise OutputError("no space left")
        put(self, key, content)

    def refusing(self: StopWork, start: int, stop: int) -> Any:
        if next(calls) > 5:
            raise InputError("a file that it reads was changed")
        return of(self, start, stop)

    with monkeypatch.context() as patch:
        if why == "a full disk":
            patch.setattr(store_folder.Place, "put", full)
        if why == "in the middle":
            patch.setattr(StopWork, "of", refusing)
        with pytest.raises(PuckError):
            PUCK.sweep(**given | more.get(why, {}))
    assert content(store) == before
    PUCK.sweep([1.0, 2.0], 1.0, store=store)
    assert names(store.parent) == ["m.zarr"]


@pytest.mark.usefixtures("small_blocks")
def test_a_store_that_replaces_another_goes_on_beside_it(tmp_path, monkeypatch):
    store = tmp_path / "m.zarr"
    PUCK.sweep(**grid(0), store=store)
    before = content(store)

    def end(done: int, total: int) -> None:
        if done > total // 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        PUCK.sweep(**grid(1), store=store, overwrite=True, threads=1, progress=end)
    assert content(store) == before
    counted: list[int] = []
    true = StopWork.of
    monkeypatch.setattr(
        StopWork, "of", lambda self, a, b: counted.append(b - a) or true(self, a, b)
    )
    PUCK.sweep(**grid(1), store=store, overwrite=True)
    assert 0 < sum(counted) < 60 * 64 // 2
    assert refuse_wrong(store, True) == 1
    assert names(tmp_path) == ["m.zarr"]


def test_a_store_killed_between_two_renames_is_found_again(tmp_path: Path):
    store = tmp_path / "m.zarr"
    PUCK.sweep(**grid(0), store=store)
    store.rename(store_folder.sibling_of(store))
    with pytest.raises(InputError, match="holds other work"):
        PUCK.sweep(**grid(1), store=store)
    assert refuse_wrong(store, True) == 0
    assert names(tmp_path) == ["m.zarr"]


@pytest.mark.usefixtures("small_blocks")
@pytest.mark.parametrize("seed", range(4))
def test_a_block_is_done_only_if_this_work_made_it(seed: int, tmp_path: Path):
    """Whole blocks of another work with the same shape, or of another place, marks and all."""
    draw, mine, other = random.Random(seed), tmp_path / "m.zarr", tmp_path / "n.zarr"
    for which, store in enumerate((mine, other)):
        PUCK.sweep(**grid(which), store=store)
    before = content(mine)
    files = sorted(name for name in before if re.search(r"/(c|made)/", name))
    for name in draw.sample(files, len(files) // 3):
        source = other / name if draw.random() < 0.5 else mine / draw.choice(files)
        if draw.random() < 0.5 or source.stat().st_size != (mine / name).stat().st_size:
            source = other / name
        (mine / name).write_bytes(source.read_bytes())
    assert content(mine) != before
    PUCK.sweep(**grid(0), store=mine)
    assert content(mine) == before


def harmed(draw: random.Random, path: Path) -> None:
    """A file deleted, cut, emptied, with a bit flipped, or its folder gone."""
    whole = path.read_bytes()
    kind = draw.choice(["gone", "cut", "empty", "flipped", "folder gone", "of another"])
    if kind == "gone":
        path.unlink()
    elif kind == "folder gone":
        for one in sorted(path.parent.rglob("*"), reverse=True):
            one.rmdir() if one.is_dir() else one.unlink()
    elif kind == "of another":
        path.write_bytes(b"{}" if path.suffix == ".json" else bytes(len(whole)))
    else:
        at = draw.randrange(len(whole))
        flipped = whole[:at] + bytes([whole[at] ^ 1 << draw.randrange(7)]) + whole[at + 1 :]
        path.write_bytes({"cut": whole[:at], "empty": b"", "flipped": flipped}[kind])


@pytest.mark.parametrize("seed", range(8))
def test_axes_and_labels_are_mended(seed: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    draw, store = random.Random(seed), tmp_path / "m.zarr"
    PUCK.sweep(**grid(0), store=store)
    before = content(store)
    kept = sorted(
        n for n in before if "/" in n and not re.search(r"^(st|path|turn|body).*/(c|made)", n)
    )
    assert any(name.startswith("launch_speed/c") for name in kept)
    for name in draw.sample(kept, draw.randint(1, 2)):
        if (store / name).exists():
            harmed(draw, store / name)
    capsys.readouterr()
    PUCK.sweep(**grid(0), store=store)
    assert "written anew" in capsys.readouterr().err
    refuse_wrong(store, True)
    now = content(store)
    assert now.keys() == before.keys()
    for name in before:
        assert now[name] == before[name] or name.endswith(".json"), name


def test_what_others_wrote_beside_the_labels_stays(tmp_path: Path):
    store = tmp_path / "m.zarr"
    PUCK.sweep(**grid(0), store=store)
    zarr.open_group(store, mode="r+").attrs["note"] = "mine"
    PUCK.sweep(**grid(0), store=store)
    assert zarr.open_group(store, mode="r").attrs["note"] == "mine"
    (store / "zarr.json").write_text("{}")
    with pytest.raises(InputError, match="no Zarr store of this program"):
        PUCK.sweep(**grid(0), store=store, overwrite=True)


@pytest.mark.parametrize("there", ["a store", "nothing", "other work", "a chain", "itself"])
def test_a_link_is_followed_and_stays(there: str, tmp_path: Path):
    disk, link = tmp_path / "disk", tmp_path / "m.zarr"
    disk.mkdir()
    link.symlink_to("disk/m.zarr" if there != "itself" else "m.zarr")
    if there == "a chain":
        (disk / "m.zarr").symlink_to("../other.zarr")
    if there == "itself":
        with pytest.raises((InputError, OutputError)):
            PUCK.sweep(**grid(1), store=link, overwrite=True)
        assert link.is_symlink()
        return
    if there != "nothing":
        PUCK.sweep(**grid(0 if there == "other work" else 1), store=link)
    kept = PUCK.sweep(**grid(1), store=link, overwrite=there == "other work")
    assert link.is_symlink() and os.readlink(link) == "disk/m.zarr"
    assert kept.load() == PUCK.sweep(**grid(1))
    at = tmp_path / "other.zarr" if there == "a chain" else disk / "m.zarr"
    assert refuse_wrong(at, True) == 1 and not at.is_symlink()
    assert left(at) == []


def test_parts_of_the_dead_are_removed_and_no_others(tmp_path: Path):
    """The living hold theirs; what is not called so, or is no file of one's own, stays."""
    held = [partial_files.new_part(tmp_path) for _ in range(3)]
    dead = [partial_files.new_part(tmp_path) for _ in range(3)]
    for path in (*held, *dead):
        path.mkdir() if path in (held[0], dead[0]) else path.write_text("x")
        partial_files.forget(path)
    (dead[0] / "inside").write_text("x")
    theirs = [tmp_path / name for name in (".puck-1.part", "x.part", ".puck-0123456789abcdef")]
    for path in theirs:
        path.write_text("x")
    link = tmp_path / ".puck-0123456789abcdef.part"
    link.symlink_to(theirs[0])
    code = (
        "import os, sys; from puck_tables._core.partial_files import hold\n"
        "for name in sys.argv[1:]: hold(os.open(name, os.O_RDONLY))\n"
        "print('held', flush=True); sys.stdin.read()"
    )
    with subprocess.Popen(
        [sys.executable, "-c", code, *map(str, held)], stdin=subprocess.PIPE,
        stdout=subprocess.PIPE, text=True,
    ) as living:  # fmt: skip
        assert living.stdout is not None and living.stdout.readline() == "held\n"
        write_bytes(tmp_path / "a.txt", b"x")
        stay = [*held, *theirs, link, tmp_path / "a.txt"]
        assert names(tmp_path) == sorted(path.name for path in stay)
        living.kill()
    partial_files.remove_dead(tmp_path)
    assert names(tmp_path) == sorted(path.name for path in stay[3:])


SWEEP = ["sweep", "--w0", "0:5:400", "--speed", "0:2:400", "--method", "adaptive", "-o", "m.zarr"]


@pytest.mark.thorough
@pytest.mark.parametrize("overwrite", [False, True])
def test_sigterm_ends_a_sweep_with_a_sentence_and_leaves_no_parts(overwrite: bool, tmp_path: Path):
    draw, code = random.Random(overwrite), "from puck_tables.cli.start import main; main()"
    if overwrite:
        PUCK.sweep(**grid(0), store=tmp_path / "m.zarr")
        before = content(tmp_path / "m.zarr")
    words = [*SWEEP, *["--overwrite"] * overwrite]
    ended = subprocess.Popen(
        [sys.executable, "-c", code, *words], cwd=tmp_path, stderr=subprocess.PIPE, text=True
    )
    store = tmp_path / (".m.zarr.new" if overwrite else "m.zarr")
    end = time.monotonic() + 90
    while len(list(store.glob("status/made/*"))) < 1 and time.monotonic() < end:
        time.sleep(0.01)
    time.sleep(draw.uniform(0.0, 0.5))
    ended.send_signal(signal.SIGTERM)
    said = ended.communicate(timeout=60)[1].splitlines()
    assert ended.returncode == 143
    assert re.fullmatch("Interrupted: m.zarr .* the same command goes on.", said[-1]), said
    assert [name for name in left(store) if name != store.name] == []
    if overwrite:
        assert content(tmp_path / "m.zarr") == before

"""Ends at any moment, two at one file, progress of other work: nothing lost, nothing half taken."""

from __future__ import annotations

import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from pucks import sweep

from puck_tables import Table
from puck_tables._core.checkpoint import Checkpoint
from puck_tables.errors import InputError, OutputError

PUCK = [sys.executable, "-c", "from puck_tables.cli.main import main; main()"]
# integrated, so that there is something to interrupt
GRID = {"spin": np.linspace(-3.0, 3.0, 150), "speed": np.linspace(0.0, 2.0, 150)}


def killed_after(seconds: float, command: list[str], folder: Path) -> int:
    """The exit code of a command that is killed unless it ends before."""
    process = subprocess.Popen(
        command, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    try:
        return process.wait(timeout=seconds)
    except subprocess.TimeoutExpired:
        process.send_signal(signal.SIGKILL)
        return process.wait()


def sweeps_killed(folder: Path, kills: int) -> int:
    """Kill a resumable sweep at random moments until it is done; returns how many kills it took."""
    load = "from puck_tables import Table; from test_faults import GRID, sweep; "
    work = (
        "m = sweep(**GRID, table=Table.shipped(), tol=1e-9, threads=1, checkpoint='m.progress'); "
        "m.save('m.h5', overwrite=True)"
    )
    code = f"import sys; sys.path.insert(0, {str(Path(__file__).parent)!r}); " + load + work
    moments = random.Random(12)
    for count in range(kills):
        if killed_after(moments.uniform(0.7, 1.6), [sys.executable, "-c", code], folder) == 0:
            return count
    assert killed_after(120.0, [sys.executable, "-c", code], folder) == 0
    return kills


def check_killed_sweeps(tmp_path: Path, kills: int) -> None:
    base = sweep(**GRID, table=Table.shipped(), tol=1e-9)
    assert sweeps_killed(tmp_path, kills) >= 1
    resumed = sweep(**GRID, table=Table.shipped(), tol=1e-9, checkpoint=tmp_path / "m.progress")
    for name in ("stop_time", "stop_x", "stop_y", "path_length", "turn_angle", "body_angle"):
        assert getattr(resumed, name).tobytes() == getattr(base, name).tobytes()
    import xarray

    with xarray.open_dataset(tmp_path / "m.h5", engine="h5netcdf") as data:
        assert data.stop_x.values.tobytes() == base.stop_x.tobytes()


def test_a_killed_sweep_goes_on(tmp_path: Path):
    check_killed_sweeps(tmp_path, kills=3)


@pytest.mark.nightly
def test_a_sweep_killed_twenty_times_goes_on(tmp_path: Path):
    check_killed_sweeps(tmp_path, kills=20)


def check_killed_builds(tmp_path: Path, kills: int) -> None:
    moments = random.Random(5)
    whole = 0
    for count in range(kills):
        kind = ("resultants", "stops")[count % 2]
        name = f"{count}.h5"
        command = [*PUCK, "build-tables", "--kind", kind, "--accuracy", "1e-5", "-o", name]
        killed_after(moments.uniform(0.5, 2.5), command, tmp_path)
        if (tmp_path / name).exists():
            assert Table.load(tmp_path / name).tolerance == 1e-5
            whole += 1
    assert whole < kills  # some kills came in time


def test_a_killed_build_leaves_no_half(tmp_path: Path):
    check_killed_builds(tmp_path, kills=4)


@pytest.mark.nightly
def test_twenty_killed_builds_leave_no_half(tmp_path: Path):
    check_killed_builds(tmp_path, kills=20)


def test_two_builders_at_one_file(tmp_path: Path):
    command = [*PUCK, "build-tables", "--accuracy", "1e-5", "-o", "one.h5"]
    both = [
        subprocess.Popen(command, cwd=tmp_path, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL)
        for _ in range(2)
    ]
    errors = [process.communicate()[1].decode() for process in both]
    assert sorted(process.returncode for process in both) == [0, 1]
    assert sum("exists already" in error or "cannot write" in error for error in errors) == 1
    assert Table.load(tmp_path / "one.h5").tolerance == 1e-5
    assert [path.name for path in tmp_path.iterdir()] == ["one.h5"]


def test_resume_on_the_command_line(tmp_path: Path):
    resultants = tmp_path / "rough.h5"
    subprocess.run([*PUCK, "build-tables", "--accuracy", "1e-6", "-o", resultants], check=True,
                   capture_output=True)  # fmt: skip
    command = [*PUCK, "sweep", "--speed", "0:2:250", "--w0", "0:5:250", "--table", "rough.h5",
               "--tol", "1e-5", "-o", "m.h5", "--resume", "--threads", "1"]  # fmt: skip
    process = subprocess.Popen(
        command, cwd=tmp_path, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    progress = tmp_path / "m.h5.progress"
    while not progress.exists() and process.poll() is None:
        time.sleep(0.01)
    process.send_signal(signal.SIGINT)
    error = process.communicate(timeout=60)[1]
    assert process.returncode == 130, error
    assert error.splitlines()[-1] == (
        "Interrupted: m.h5.progress keeps what is done; the same command goes on."
    )
    other = subprocess.run(
        [*command, "--speed", "0:1:250"], cwd=tmp_path, capture_output=True, text=True
    )
    assert (other.returncode, "begun with" in other.stderr) == (2, True)
    again = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert again.returncode == 0, again.stderr
    assert sorted(path.name for path in tmp_path.iterdir()) == ["m.h5", "rough.h5"]
    alone = subprocess.run([*PUCK, "sweep", "--resume"], capture_output=True, text=True)
    assert (alone.returncode, "--resume needs -o" in alone.stderr) == (2, True)


def test_a_damaged_chunk_is_done_again(tmp_path: Path):
    path = tmp_path / "a.progress"
    with Checkpoint(path, "work", 1, 10, 4) as kept:
        for start in (0, 4, 8):
            stop = min(start + 4, 10)
            kept.put(start, stop, np.ones((1, stop - start)), np.zeros(stop - start, np.int8))
    content = bytearray(path.read_bytes())
    content[-10] ^= 1  # in the last number, before two states
    path.write_bytes(content)
    with Checkpoint(path, "work", 1, 10, 4) as kept:
        assert [kept.is_done(start) for start in (0, 4, 8)] == [True, True, False]


def test_progress_of_other_work_and_of_another_process(tmp_path: Path):
    path = tmp_path / "a.progress"
    with Checkpoint(path, "work", 1, 10, 4), pytest.raises(InputError, match="another process"):
        Checkpoint(path, "work", 1, 10, 4)
    before = path.read_bytes()
    for digest, items in (("other", 10), ("work", 11)):
        with pytest.raises(InputError, match="begun with, or remove it"):
            Checkpoint(path, digest, 1, items, 4)
    assert path.read_bytes() == before
    with pytest.raises(OutputError, match="cannot keep"):
        Checkpoint(tmp_path / "none" / "a.progress", "work", 1, 10, 4)
    text = tmp_path / "text"
    text.write_text("puck")
    with pytest.raises(InputError, match="is not what is done"):
        Checkpoint(text, "work", 1, 10, 4)
    assert text.read_text() == "puck"

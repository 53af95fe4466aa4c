"""Ends at any moment, two at one file: nothing lost, nothing half taken."""

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
from rarely import nightly, thorough

from puck_tables import Table

MAIN = "from puck_tables.cli.main import main; main()"
STARTED = MAIN.replace("cli.main", "cli.start")  # as a user does
PUCK = [sys.executable, "-c", MAIN]
# a suite in the background ignores it
HEARING = "import signal; signal.signal(signal.SIGINT, signal.default_int_handler); "
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
    """Kill a sweep into a store at random moments until it is done; how many kills it took."""
    load = "from puck_tables import Table; from test_faults import GRID, sweep; "
    work = (
        "sweep(**GRID, table=Table.shipped(), tol=1e-9, threads=1, store='m.zarr').load()"
        ".save('m.h5', overwrite=True)"
    )
    code = f"import sys; sys.path.insert(0, {str(Path(__file__).parent)!r}); " + load + work
    moments = random.Random(12)
    for count in range(kills):
        if killed_after(moments.uniform(0.7, 1.6), [sys.executable, "-c", code], folder) == 0:
            return count
    assert killed_after(120.0, [sys.executable, "-c", code], folder) == 0
    return kills


@pytest.mark.parametrize("kills", [thorough(1), nightly(20)])
def test_a_killed_sweep_goes_on(tmp_path: Path, kills: int) -> None:
    pytest.importorskip("zarr")
    base = sweep(**GRID, table=Table.shipped(), tol=1e-9)
    assert sweeps_killed(tmp_path, kills) >= 1
    resumed = sweep(**GRID, table=Table.shipped(), tol=1e-9, store=tmp_path / "m.zarr").load()
    for name in ("stop_time", "stop_x", "stop_y", "path_length", "turn_angle", "body_angle"):
        assert getattr(resumed, name).tobytes() == getattr(base, name).tobytes()
    import xarray

    with xarray.open_dataset(tmp_path / "m.h5", engine="h5netcdf") as data:
        assert data.stop_x.values.tobytes() == base.stop_x.tobytes()


@pytest.mark.parametrize("kills", [thorough(2), nightly(20)])
def test_a_killed_build_leaves_no_half(tmp_path: Path, kills: int) -> None:
    def build(kind: str, name: str) -> list[str]:
        return [*PUCK, "build-tables", "--kind", kind, "--accuracy", "1e-5", "-o", name]

    moments, kinds = random.Random(5), ("resultants", "stops")
    times = []  # of a build to its end, on this machine
    for kind in kinds:
        start = time.monotonic()
        subprocess.run(build(kind, f"{kind}.h5"), cwd=tmp_path, check=True, capture_output=True)
        times.append(time.monotonic() - start)
    whole = 0
    for count in range(kills):
        name = f"{count}.h5"
        share = moments.uniform(0.2, 1.0)
        killed_after(share * times[count % 2], build(kinds[count % 2], name), tmp_path)
        if (tmp_path / name).exists():
            assert Table.load(tmp_path / name).tolerance == 1e-5
            whole += 1
    assert whole < kills  # some kills came in time


@pytest.mark.thorough
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


@pytest.mark.thorough
def test_a_store_on_the_command_line(tmp_path: Path):
    pytest.importorskip("zarr")
    resultants = tmp_path / "rough.h5"
    subprocess.run([*PUCK, "build-tables", "--accuracy", "1e-6", "-o", resultants], check=True,
                   capture_output=True)  # fmt: skip
    command = [*PUCK, "sweep", "--speed", "0:2:600", "--w0", "0:5:600", "--table", "rough.h5",
               "--tol", "1e-5", "-o", "m.zarr", "--threads", "1"]  # fmt: skip
    process = subprocess.Popen(
        [sys.executable, "-c", HEARING + STARTED, *command[len(PUCK) :]],
        cwd=tmp_path, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    while not (tmp_path / "m.zarr").exists() and process.poll() is None:
        time.sleep(0.01)
    process.send_signal(signal.SIGINT)
    error = process.communicate(timeout=60)[1]
    assert process.returncode == 130, error
    assert error.splitlines()[-1] == (
        "Interrupted: m.zarr keeps what is done; the same command goes on."
    )
    other = subprocess.run(
        [*command, "--speed", "0:1:600"], cwd=tmp_path, capture_output=True, text=True
    )
    assert (other.returncode, "begun with" in other.stderr) == (2, True)
    again = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert again.returncode == 0, again.stderr
    assert sorted(path.name for path in tmp_path.iterdir()) == ["m.zarr", "rough.h5"]

"""Ctrl-C at any moment: a sentence, exit code 130, and nothing goes on."""

from __future__ import annotations

import os
import subprocess
import sys

import numpy as np
import pytest

from puck_tables import stop
from puck_tables._core import executor

pytestmark = pytest.mark.skipif(os.name == "nt", reason="signals of another kind")

# interrupts itself when a module is about to be imported; {then} follows
AT_IMPORT = """
import hashlib, os, signal, sys, threading
signal.signal(signal.SIGINT, signal.default_int_handler)  # a suite in the background ignores it
class Finder:
    def find_spec(self, name, path=None, target=None):
        if name == {name!r}:
            sys.meta_path.remove(self)
            {then}
sys.meta_path.insert(0, Finder())
from puck_tables.cli.start import main
main()
"""
AT_ONCE = "os.kill(os.getpid(), signal.SIGINT)"
# what does not listen, as compiled code and compilers do not
DEAF = (
    "threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start(); "
    "hashlib.pbkdf2_hmac('sha256', b'', b'', (1 << 31) - 1)"
)


def interrupted(code: str, *words: str, folder=None) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-c", code, *words], capture_output=True, text=True, timeout=120,
        cwd=folder,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("name", "command"),
    [
        *((name, ["simulate", "--v0", "1,0"])
          for name in ("click", "puck_tables.cli.aim", "puck_tables.errors")),
        # its compiled modules would drop it and fail to be imported
        ("numba._devicearray", ["build-tables", "-o", "n.h5"]),
    ],
)  # fmt: skip
def test_while_something_is_imported(name, command, tmp_path):
    done = interrupted(AT_IMPORT.format(name=name, then=AT_ONCE), *command, folder=tmp_path)
    assert done.returncode == 130
    assert done.stderr == "Interrupted: nothing more was written.\n"
    assert done.stdout == ""
    assert not list(tmp_path.iterdir())


@pytest.mark.thorough
@pytest.mark.parametrize("then", [AT_ONCE, DEAF], ids=["listening", "deaf"])
def test_while_a_command_runs(then):
    code = AT_IMPORT.format(name="puck_tables.trajectory", then=then)
    done = interrupted(code, "simulate", "--v0", "1,0", "--w0", "5")
    assert done.returncode == 130
    assert done.stderr == "Interrupted: nothing more was written.\n"


@pytest.mark.thorough
def test_a_resumable_sweep_says_that_it_goes_on_even_when_it_is_deaf(tmp_path):
    code = AT_IMPORT.format(name="puck_tables.stopping.similarity_lookup", then=DEAF)
    pytest.importorskip("zarr")
    words = ["sweep", "--w0", "0:1:11", "-o", "m.zarr"]
    done = interrupted(code, *words, folder=tmp_path)
    assert done.returncode == 130
    assert done.stderr.splitlines()[-1] in (
        "Interrupted: m.zarr keeps what is done; the same command goes on.",
        "Interrupted: nothing more was written.",  # before there was anything to keep
    )
    assert (tmp_path / "m.zarr").exists() == ("m.zarr" in done.stderr)


CHUNKS = """
import os, signal, threading, time
from puck_tables._core.executor import in_slices, run_chunks
signal.signal(signal.SIGINT, signal.default_int_handler)
def endless(start, stop):
    in_slices(lambda a, b: time.sleep(0.05), 1_000_000_000)
def nested(start, stop):
    run_chunks(endless, 4, 1, threads=2)
threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
try:
    run_chunks({work}, 4, 1, threads=2)
except KeyboardInterrupt:
    print("ended", threading.active_count())
"""


@pytest.mark.parametrize("work", ["endless", "nested"])
def test_chunks_that_never_end_are_given_up(work):
    done = interrupted(CHUNKS.format(work=work))
    assert (done.returncode, done.stdout) == (0, "ended 1\n"), done.stderr


def test_slices_change_no_bit(monkeypatch):
    launches = {"velocity": (1.0, 0.0), "spin": np.linspace(0.0, 9.0, 37), "tol": 1e-7}
    for kind in ({"method": "adaptive"}, {"method": "rk4"}, {"delta": 1.5, "method": "rk4"}):
        whole = stop(**launches, **kind)
        monkeypatch.setattr(executor, "_FIRST_SLICE", 1)
        monkeypatch.setattr(executor, "_GROWTH", 1.0)
        cut = stop(**launches, **kind)
        monkeypatch.undo()
        for name in ("stop_time", "stop_position", "path_length", "body_angle"):
            assert getattr(cut, name).tobytes() == getattr(whole, name).tobytes()


def test_slices_cover_all_once():
    seen: list[int] = []
    executor.in_slices(lambda a, b: seen.extend(range(a, b)), 1000)
    assert seen == list(range(1000))

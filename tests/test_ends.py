"""Ends from outside: Ctrl-C and readers that go away; a sentence or nothing, and no halves."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
from importlib.resources import files
from pathlib import Path

import pytest

COMPILING = re.compile(r"^compiling .* for this machine, once: about \S+ s\n", re.MULTILINE)
MAIN = "from puck_tables.cli.main import main; main(prog_name='puck')"
# interrupts itself a moment after the work has begun, however slow that was
INTERRUPTED = """
import os, signal, sys, threading, time
signal.signal(signal.SIGINT, signal.default_int_handler)  # a suite in the background ignores it
def interrupt():
    while {module!r} not in sys.modules:
        time.sleep(0.01)
    time.sleep(0.3)
    os.kill(os.getpid(), signal.SIGINT)
threading.Thread(target=interrupt, daemon=True).start()
"""
LONG = {
    "build resultants": (
        "table.resultant_table", ["build-tables", "--cells", "60000", "-o", "n.h5"]
    ),
    "build stops": (
        "stopping.stop_check",
        ["build-tables", "--kind", "stops", "--accuracy", "1e-11", "-o", "n.h5"]
    ),
    "build law": (
        "table.resultant_table", ["build-tables", "--pressure", "hill.csv", "-o", "n.h5"]
    ),
    "validate": (
        "stopping.stop_check", ["validate", str(files("puck_tables.tables") / "stops.h5")]
    ),
    "sweep": (
        "stopping.stop_sweep", ["sweep", "--speed", "0:2:5000", "--w0", "0:5:5000", "-o", "m.h5"]
    ),
    "scenes": (
        "world.map",
        ["sweep", "--scene", "incline", "--set", "launch.spin=0:80:900000", "-o", "m.h5"],
    ),
    "aim": (
        "stopping.aim_at_targets", ["aim", "--target", "2,0.1", "--count", "9000", "-o", "a.csv"]
    ),
    "tradeoff": ("tradeoff.measurement", ["tradeoff", "-o", "t.h5"]),
}  # fmt: skip


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.thorough
@pytest.mark.parametrize("name", LONG)
def test_ctrl_c_ends_with_a_sentence_and_leaves_nothing(name: str, folder: Path):
    module, arguments = LONG[name]
    if name == "build law":
        rows = [f"{i / 300},{1.0 - 1e-6 * i * i}" for i in range(301)]
        Path("hill.csv").write_text("\n".join(rows))
    code = INTERRUPTED.format(module=f"puck_tables.{module}")
    code += "from puck_tables.cli.start import main; main()"
    ended = subprocess.run(
        [sys.executable, "-c", code, *arguments], capture_output=True, text=True, timeout=60
    )
    assert ended.returncode == 130, ended.stderr
    assert ended.stdout == ""
    assert ended.stderr.splitlines()[-1] == "Interrupted: nothing more was written."
    assert len(COMPILING.sub("", ended.stderr).splitlines()) == 1
    Path("hill.csv").unlink(missing_ok=True)
    assert list(folder.iterdir()) == []


PRINTING = [
    ["--help"], ["info"], ["tables"], ["scene", "list"],
    ["simulate", "--scene", "incline"],
    ["simulate", "--v0", "1,0"],
    ["simulate", "--v0", "1,0", "--json"], ["sweep"], ["aim", "--target", "2,0.1"],
    ["build-tables", "--accuracy", "1e-4"], ["validate", "rough.h5"],
]  # fmt: skip


@pytest.mark.thorough
@pytest.mark.parametrize("arguments", PRINTING, ids=" ".join)
def test_a_reader_that_has_gone_is_no_trouble(arguments: list[str]):
    """As after '| true': silence, and the code that shells give to a broken pipe."""
    if arguments[0] == "validate":
        from puck_tables import Table

        Table.build(accuracy=1e-4).save("rough.h5")
    read, write = os.pipe()
    os.close(read)
    ended = subprocess.run(
        [sys.executable, "-c", MAIN, *arguments], stdout=write, text=True,
        stderr=write if arguments[0] == "sweep" else subprocess.PIPE,  # which speaks there, too
    )  # fmt: skip
    os.close(write)
    assert ended.returncode == (1 if arguments == ["--help"] else 141)  # help is click's
    for line in (ended.stderr or "").splitlines():
        assert line.startswith(("wrote ", "compiling ", "validating: ", "tabulating: ")), (
            ended.stderr
        )


@pytest.mark.thorough
@pytest.mark.parametrize("unbuffered", ["", "1"])
def test_the_first_lines_are_read(unbuffered: str):
    command = f'"{sys.executable}" -c "{MAIN}" sweep --w0 0:1:20000 | head -2'
    ended = subprocess.run(
        command, shell=True, capture_output=True, text=True, check=True,
        env={**os.environ, "PYTHONUNBUFFERED": unbuffered},
    )  # fmt: skip
    assert ended.stdout.startswith("launch_spin[rad/s],stop_time[s]")
    assert ended.stdout.count("\n") == 2
    assert COMPILING.sub("", ended.stderr) == ""


@pytest.mark.thorough
def test_closed_stderr():
    run = f'"{sys.executable}" -c "{MAIN}"'
    subprocess.run(f"{run} sweep --w0 0:1:3 -o a.csv 2>&-", shell=True, check=True)
    assert Path("a.csv").exists()


@pytest.mark.thorough
@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no such device")
@pytest.mark.parametrize("unbuffered", ["", "1"])
@pytest.mark.parametrize("arguments", ["--help", "scene fields", "info", "simulate --v0 1,0"])
def test_a_full_device_is_a_sentence(arguments: str, unbuffered: str):
    with open("/dev/full", "w") as full:
        ended = subprocess.run(
            [sys.executable, "-c", MAIN, *arguments.split()], stdout=full, text=True,
            stderr=subprocess.PIPE, env={**os.environ, "PYTHONUNBUFFERED": unbuffered},
        )  # fmt: skip
    assert ended.returncode == 1
    told = COMPILING.sub("", ended.stderr)
    assert told == "Error: cannot write the results: No space left on device\n"


def test_a_signal_from_a_shell_that_ends():
    """SIGTERM leaves no half of a file either: there is none before it is whole."""
    process = subprocess.Popen(
        [sys.executable, "-c", MAIN, *LONG["sweep"][1]],
        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
    )  # fmt: skip
    with pytest.raises(subprocess.TimeoutExpired):
        process.wait(timeout=1.5)
    process.send_signal(signal.SIGTERM)
    assert process.wait(timeout=30) == -signal.SIGTERM
    assert not Path("m.h5").exists()


@pytest.mark.thorough
def test_a_file_that_takes_only_a_part_of_the_results():
    """Never code 0 for a map that is cut short, not even where Python does not buffer."""
    command = f'ulimit -f 64; "{sys.executable}" -c "{MAIN}" sweep --w0 0:1:20000 > map.csv'
    for unbuffered in ("", "1"):
        ended = subprocess.run(
            ["bash", "-c", command], capture_output=True, text=True,
            env={**os.environ, "PYTHONUNBUFFERED": unbuffered},
        )  # fmt: skip
        assert ended.returncode == 1
        assert "Error: cannot write the results: File too large" in ended.stderr

"""No command replaces what it reads, one output by another, or the rights of a file."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from commands import invoke

import puck_tables as pt
from puck_tables._core.safe_write import check_target, write_bytes
from puck_tables.errors import OutputError, PuckError

PUCK = [sys.executable, "-m", "puck_tables.cli.main"]
SCENE = """
[puck]
radius = 0.04
pressure = "profile.csv"
[floor]
friction = 0.15
[launch]
velocity = [0.5, 0.0]
[force]
file = "force.csv"
"""


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An own folder with files to read."""
    monkeypatch.chdir(tmp_path)
    Path("profile.csv").write_text("0,1\n1,0.5\n")
    Path("force.csv").write_text("t,Fx,Fy\n0,0.01,0\n9,0,0\n")
    Path("law.csv").write_text("0,0.3\n1,0.2\n")
    Path("scene.toml").write_text(SCENE)
    Path("link.h5").symlink_to("law.csv")
    Path("link.csv").symlink_to("profile.csv")
    os.link("force.csv", "hard.csv")
    return tmp_path


@pytest.mark.parametrize(
    "arguments",
    [
        "simulate --v0 1,0 --pressure profile.csv -o profile.csv",
        "simulate --v0 1,0 --pressure profile.csv -o link.csv",
        "simulate --v0 1,0 --pressure link.csv -o ./profile.csv",
        "sweep --w0 0:1:3 --pressure profile.csv -o profile.csv",
        "aim --target 1,0 --w0 1 --pressure profile.csv -o profile.csv",
        "build-tables --speed-law law.csv -o link.h5", "simulate --scene scene.toml -o force.csv",
        "simulate --scene scene.toml -o hard.csv", "simulate --scene scene.toml -o profile.csv",
        "sweep --scene scene.toml --set launch.spin=0:1:3 -o force.csv",
        "sweep --scene scene.toml --set launch.spin=0:1:3 -o link.csv",
    ],
)  # fmt: skip
def test_no_output_replaces_what_is_read(arguments: str, folder: Path):
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    ended = invoke(*arguments.split(), "--overwrite")
    assert ended.exit_code == 2, ended.output
    assert "is read by this command" in ended.stderr
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == before


@pytest.mark.parametrize("link", ["soft", "hard", "soft, to nothing", "the folder"])
def test_no_output_replaces_the_other(link: str, folder: Path):
    first, second = "a.csv", "a.png"
    if link == "soft, to nothing":
        Path(second).symlink_to(first)
    elif link == "the folder":
        (folder / "there").symlink_to(folder)
        Path(second).symlink_to(first)
        second = "there/a.png"
    else:
        Path(first).write_text("old")
        if link == "soft":
            Path(second).symlink_to(first)
        else:
            os.link(first, second)
    ended = invoke("simulate", "--v0", "1,0", "-o", first, "--plot", second, "--overwrite")
    assert ended.exit_code == 2
    assert "is named for two outputs" in ended.stderr
    assert not Path(first).exists() or Path(first).read_text() == "old"


@pytest.mark.parametrize("mode", [0o600, 0o640, 0o644, 0o400, 0o755])
def test_a_replaced_file_keeps_its_rights(mode: int, folder: Path):
    path = folder / "a.txt"
    path.write_bytes(b"old")
    path.chmod(mode)
    write_bytes(path, b"new", overwrite=True)
    assert (path.read_bytes(), path.stat().st_mode & 0o777) == (b"new", mode)


@pytest.mark.skipif(os.geteuid() != 0, reason="only root can give files away")
def test_a_replaced_file_keeps_its_owner(folder: Path):
    path = folder / "a.txt"
    path.write_bytes(b"old")
    os.chown(path, 1234, 1235)
    write_bytes(path, b"new", overwrite=True)
    assert (path.stat().st_uid, path.stat().st_gid) == (1234, 1235)


def test_new_files_have_the_rights_of_the_umask_from_all_threads(folder: Path):
    """In a process of its own: the umask is one for all threads."""
    code = (
        "import os, threading\n"
        "from puck_tables._core.safe_write import write_bytes\n"
        "os.umask(0o077)\n"
        "def work(n):\n"
        "    for k in range(60):\n"
        "        write_bytes(f'{n}-{k}.txt', b'x')\n"
        "crew = [threading.Thread(target=work, args=(n,)) for n in range(6)]\n"
        "[t.start() for t in crew]; [t.join() for t in crew]\n"
        "rights = {os.stat(p).st_mode & 0o777 for p in os.listdir() if p.endswith('.txt')}\n"
        "print(sorted(rights), oct(os.umask(0)))\n"
    )
    ended = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert ended.stdout == f"[{0o600}] 0o77\n"
    assert threading.active_count() >= 1


def test_the_umask_is_never_touched(folder: Path, monkeypatch: pytest.MonkeyPatch):
    def touched(mask: int) -> int:
        raise AssertionError("umask")

    monkeypatch.setattr(os, "umask", touched)
    write_bytes(folder / "a.txt", b"x")
    write_bytes(folder / "a.txt", b"y", overwrite=True)


def test_saving_in_a_deleted_folder_is_a_sentence(folder, tmp_path_factory, monkeypatch):
    gone = tmp_path_factory.mktemp("gone")
    monkeypatch.chdir(gone)
    gone.rmdir()
    for path in ("a.csv", "./a.csv", "b/a.csv"):
        with pytest.raises(OutputError, match="cannot write"):
            check_target(path)
        with pytest.raises(OutputError, match="cannot write"):
            write_bytes(path, b"x", overwrite=True)
    ended = invoke("simulate", "--v0", "1,0", "-o", "a.csv")
    assert ended.exit_code == 1
    assert ended.stderr.startswith("Error: cannot write a.csv")
    assert len(ended.stderr.splitlines()) == 1


@pytest.mark.parametrize("name", ["x" * 300, "x/" * 3000, "loop.toml", "shut/scene.toml"])
@pytest.mark.parametrize("command", ["simulate --scene", "scene check", "info", "validate"])
def test_what_cannot_be_read_does_not_say_written(name: str, command: str, folder: Path):
    Path("loop.toml").symlink_to("loop.toml")
    Path("shut").mkdir(mode=0)
    ended = invoke(*command.split(), name)
    assert ended.exit_code in (1, 2)
    assert "cannot write" not in ended.stderr
    assert len(ended.stderr.splitlines()) == 1
    for option in ("--table", "--pressure"):
        ended = invoke("simulate", "--v0", "1,0", option, f"{name}.csv")
        assert ended.exit_code in (1, 2)
        assert "cannot write" not in ended.stderr


def test_nothing_that_a_terminal_obeys_comes_from_files(folder: Path):
    """Titles, names of laws, entries: all that is printed of a file."""
    red = "\\u001b[31m"
    plain = SCENE.replace('pressure = "profile.csv"', "mass = 0.2")
    text = plain.replace("[puck]", f'title = "{red}red\\u0007"\n[puck]', 1)
    Path("red.toml").write_text(text)
    Path("bad.toml").write_text(text + f'[drag]\n"{red}" = 1\n')
    for arguments in (
        "scene check red.toml", "scene check bad.toml", "simulate --scene red.toml --explain",
        "sweep --scene red.toml --set launch.spin=0:1:3 -o a.csv --explain",
    ):  # fmt: skip
        ended = invoke(*arguments.split())
        assert "\x1b" not in ended.output
        assert "\x07" not in ended.output
        assert "x1b[31m" in ended.output, arguments


def test_names_that_no_file_can_have_get_a_sentence_at_every_writer():
    rng = np.random.default_rng(71)
    run, law = pt.Puck.similar().simulate((1.0, 0.0), frames=2), pt.SpeedLaw([0.0, 1.0], [0.1, 0.2])
    doors: list[tuple[Callable[[Any], object], str]] = [
        (run.plot, ".png"), (run.movie, ".html"), (run.save, ".h5"),
        (run.save, ".csv"), (law.to_csv, ".csv"), (check_target, ""),
    ]  # fmt: skip
    for write, ending in doors:
        long = "".join(chr(97 + n) for n in rng.integers(0, 26, rng.integers(300, 400)))
        names = (long, f"{long}/a", "x/" * 3000 + "a", "a\0")
        for name in names[: 1 if write == run.plot else 4]:  # it draws first
            with pytest.raises(PuckError, match="cannot write"):
                write(f"{name}{ending}")
        for wrong in (f"a{ending}".encode(), int(rng.integers(9)), 2.5, [f"a{ending}"]):
            with pytest.raises(PuckError, match=r"path must be a str or a Path, got a "):
                write(wrong)
    assert not [*Path().glob("a*"), *Path().glob(".puck*")]

"""Every command that takes a file, given every wrong one: a sentence, at once, nothing written."""

from __future__ import annotations

import os
import signal
import socket
from collections.abc import Iterator
from importlib.resources import files
from pathlib import Path

import h5py
import pytest
from commands import invoke
from kinds_of_table import small

from puck_tables.table.file import sealed

SHIPPED = {name: (files("puck_tables.tables") / f"{name}.h5").read_bytes() for name in
           ("resultants", "stops")}  # fmt: skip


class Waited(BaseException):
    """No command catches it, as it would a TimeoutError."""


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """An own folder; a command that waits for a file is interrupted."""
    monkeypatch.chdir(tmp_path)

    def waited(number: int, frame: object) -> None:
        raise Waited("the command waits for a file")

    before = signal.signal(signal.SIGALRM, waited)
    signal.alarm(20)
    yield tmp_path
    signal.alarm(0)
    signal.signal(signal.SIGALRM, before)


def newer(path: Path) -> None:
    path.write_bytes(SHIPPED["resultants"])
    with h5py.File(path, "r+") as file:
        file.attrs["format_version"] = "7.0"
    path.write_bytes(sealed(path.read_bytes()))


def stranger(path: Path) -> None:
    with h5py.File(path, "w") as file:
        file["x"] = 1.0


def listening(path: Path) -> None:
    with socket.socket(socket.AF_UNIX) as end:
        end.bind(path.name)


def large(path: Path) -> None:
    with open(path, "wb") as file:
        file.truncate(1 << 40)  # a hole: takes no room on the disk


MADE = {
    "missing": lambda path: None, "empty": Path.touch, "text": lambda path: path.write_text("puck"),
    "binary": lambda path: path.write_bytes(bytes(range(256)) * 8),
    "cut": lambda path: path.write_bytes(SHIPPED["resultants"][:50_000]),
    "first bytes": lambda path: path.write_bytes(SHIPPED["resultants"][:8]), "newer": newer,
    "stranger": stranger, "folder": Path.mkdir, "pipe": os.mkfifo, "socket": listening,
    "loop": lambda path: path.symlink_to(path.name),
    "zeros": lambda path: path.symlink_to("/dev/zero"),
    "null": lambda path: path.symlink_to("/dev/null"),
    "full": lambda path: path.symlink_to("/dev/full"),
    "memory": lambda path: path.symlink_to("/proc/self/mem"), "large": large,
}  # fmt: skip
WORDS = {
    "missing": "there is no table file", "newer": "format 7.0, newer", "cut": "digest",
    "first bytes": "digest", "stranger": "not a table of this program", "large": "too large",
    **dict.fromkeys(("empty", "text", "binary"), "not an HDF5 file"),
    **dict.fromkeys(("folder", "pipe", "socket", "zeros", "null", "full"), "not a regular file"),
}  # fmt: skip
READERS = [["info"], ["validate"], ["simulate", "--v0", "1,0", "--table"], ["sweep", "--table"]]


def refused(arguments: list[str], codes: tuple[int, ...]) -> str:
    result = invoke(*arguments)
    assert result.exit_code in codes, result.output
    assert isinstance(result.exception, SystemExit)
    assert result.stdout == ""
    assert result.stderr.count("\n") == 1, result.stderr
    assert result.stderr.startswith("Error: ")
    return result.stderr


@pytest.mark.parametrize("reader", READERS, ids=lambda reader: reader[0])
@pytest.mark.parametrize("shape", MADE)
def test_what_is_no_table(shape: str, reader: list[str], folder: Path):
    MADE[shape](Path("given.h5"))
    before = sorted(folder.iterdir())
    said = refused([*reader, "given.h5"], codes=(1,))
    assert "given.h5" in said
    assert WORDS.get(shape, "") in said
    assert sorted(folder.iterdir()) == before


@pytest.mark.parametrize(
    ("kind", "reader"), [("stops", READERS[2]), ("speed", READERS[2]), ("speed", READERS[3])]
)
def test_a_table_of_the_wrong_kind(kind: str, reader: list[str]):
    small(kind).save("given.h5")
    said = refused([*reader, "given.h5"], codes=(1, 2))
    assert f"holds '{kind}" in said


@pytest.mark.parametrize("reader", READERS[2:], ids=lambda reader: reader[0])
def test_a_table_of_another_puck(reader: list[str]):
    small("washer").save("given.h5")
    said = refused([*reader, "given.h5"], codes=(2,))
    assert "given.h5 is a table under the pressure law annulus:0.8, not uniform" in said


@pytest.mark.parametrize("shape", MADE)
def test_what_is_no_profile(shape: str, folder: Path):
    MADE[shape](Path("given.csv"))
    before = sorted(folder.iterdir())
    assert "given.csv" in refused(["build-tables", "--pressure", "given.csv"], codes=(2,))
    assert sorted(folder.iterdir()) == before


@pytest.mark.parametrize(
    "reader", [["simulate", "--scene"], ["sweep", "--scene"], ["scene", "check"]], ids=" ".join
)
@pytest.mark.parametrize("shape", MADE)
def test_what_is_no_scene(shape: str, reader: list[str], folder: Path):
    MADE[shape](Path("given.toml"))
    before = sorted(folder.iterdir())
    result = invoke(*reader, "given.toml")
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr.startswith("Error: ")  # then a line for each error in the scene
    assert sorted(folder.iterdir()) == before


@pytest.mark.parametrize("shape", [shape for shape in MADE if shape != "missing"])
def test_what_is_no_store_of_a_sweep(shape: str, folder: Path):
    pytest.importorskip("zarr")
    MADE[shape](Path("m.zarr"))
    before = sorted(folder.iterdir())
    for more in ([], ["--overwrite"]):
        assert "m.zarr" in refused(["sweep", "--w0", "0:1:3", "-o", "m.zarr", *more], codes=(1, 2))
        assert sorted(folder.iterdir()) == before

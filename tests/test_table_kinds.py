"""What every kind of table does alike: built, saved, loaded, described, judged, refused."""

from __future__ import annotations

import json
import re
import shutil
from collections.abc import Callable
from dataclasses import fields, replace
from importlib.resources import files
from pathlib import Path

import h5py
import numpy as np
import pytest
import xarray
from commands import invoke
from conftest import ROOT
from kinds_of_table import KINDS, LAW, answers, small
from rarely import few

from puck_tables import Table, law_of
from puck_tables.errors import AccuracyError, InputError, OutputError, TableError
from puck_tables.table.file import sealed

COMMAND = "puck build-tables, as a test has it"
# sizes of the axes, a function, and what the report says of the grid
GRIDS = {
    "resultants": ({"phi": 69, "delta": 4}, "spin", "69 phi x 4 delta nodes"),
    "washer": ({"phi": 49, "delta": 4}, "spin", "49 phi x 4 delta nodes"),
    "profile": ({"phi": 145, "delta": 4}, "spin", "145 phi x 4 delta nodes"),
    "stops": ({"phi": 33, "delta": 9}, "time", "33 phi x 9 delta nodes"),
    "section": ({"phi": 129}, "spin_share", "129 phi nodes"),
    "stop section": ({"phi": 129}, "along", "129 phi nodes"),
    "speed": ({"node": 968}, "p_d", "968 nodes in 8 patches"),
}
every_kind = pytest.mark.parametrize("kind", KINDS)


@pytest.fixture(scope="module")
def saved(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Path]:
    """The file of a small table of a kind, made once."""
    folder = tmp_path_factory.mktemp("tables")

    def path_of(kind: str) -> Path:
        path = folder / f"{kind}.h5"
        if not path.exists():
            small(kind).save(path, command=COMMAND)
        return path

    return path_of


def altered(path: Path, to: Path, edit: Callable[[h5py.File], object]) -> Path:
    """A copy changed by h5py and sealed again."""
    shutil.copy(path, to)
    with h5py.File(to, "r+") as opened:
        edit(opened)
    to.write_bytes(sealed(to.read_bytes()))
    return to


@every_kind
def test_round_trip_is_exact(kind: str, saved: Callable[[str], Path]):
    table, loaded = small(kind), Table.load(saved(kind))
    assert type(loaded) is type(table)
    np.testing.assert_array_equal(loaded.values, table.values)
    np.testing.assert_array_equal(answers(loaded), answers(table))
    assert (loaded.accuracy, loaded.tolerance) == (table.accuracy, table.tolerance)
    for one in fields(table):  # what the values follow from: laws, lines, grids
        if one.name not in ("values", "metadata", "source"):
            made, read = getattr(table, one.name), getattr(loaded, one.name)
            assert type(made) is type(read)
            assert np.all(np.asarray(made == read)), one.name
    assert not loaded.values.flags.writeable


@every_kind
def test_a_file_says_what_it_holds(kind: str, saved: Callable[[str], Path]):
    sizes, function, grid = GRIDS[kind]
    table = Table.load(saved(kind))
    for name in (
        "format", "format_version", "kind", "pressure_law", "algorithm", "interpretation",
        "valid_range", "method", "package_version", "library_versions", "created",
        "digest", "achieved_accuracy", "tolerance", *table.words,
    ):  # fmt: skip
        assert table.metadata[name], name
    assert table.metadata["command"] == COMMAND
    with xarray.open_dataset(saved(kind), engine="h5netcdf") as data:
        assert dict(data.sizes) == sizes
        assert set(table.functions) <= set(data.variables)
        assert all("units" in data[name].attrs for name in {*data.variables} - {"made_of"})
        assert function in data
    told = invoke("info", saved(kind)).stdout
    for words in (grid, f"{table.tolerance:g}", "right", COMMAND, table.pressure_law):
        assert words in told
    assert repr(table) == (
        f"<Table of {table.kind}: {table.pressure_law} pressure, {grid}, to {table.tolerance:g}, "
        f"{table.source}>"
    )


# that of stops takes long, and is judged in test_similarity too
@pytest.mark.thorough
@pytest.mark.parametrize("kind", few(len(KINDS) - 1, sorted(KINDS, key="stops".__eq__)))
def test_an_honest_table_passes_and_a_bold_or_bent_one_fails(kind, saved):
    judged = invoke("validate", saved(kind))
    assert judged.exit_code == 0, judged.output
    assert "FAIL" not in judged.stdout
    table = Table.load(saved(kind))
    assert not replace(table, tolerance=1e-3 * table.accuracy.worst).validate().passed
    bent = table.values.copy()
    bent[len(bent) // 3] *= 1.01
    assert not replace(table, values=bent).validate().passed


@every_kind
def test_nothing_is_overwritten_and_nothing_non_finite_is_saved(kind, saved, monkeypatch, tmp_path):
    table, path = small(kind), saved(kind)
    before = path.read_bytes()
    with pytest.raises(OutputError, match="exists already"):
        table.save(path)
    spoilt = table.values.copy()
    spoilt[0] = np.nan
    for unsaved, words in (
        (replace(table, values=spoilt), "without measured accuracy or with a non-finite"),
        (replace(table, accuracy=None), "without measured accuracy or with a non-finite"),
        *((replace(table, tolerance=one), "promises") for one in (float("inf"), 2.0, 0.0)),
    ):
        with pytest.raises(OutputError, match=words):
            unsaved.save(path, overwrite=True)

    def full(descriptor: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.fsync", full)
    with pytest.raises(OutputError, match="No space left on device"):
        table.save(tmp_path / "full.h5")
    assert path.read_bytes() == before
    assert list(tmp_path.iterdir()) == []


@every_kind
def test_cut_and_flipped_files_are_refused_before_hdf5_sees_them(
    kind: str, saved: Callable[[str], Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    def parsed(*given: object) -> None:
        raise AssertionError("HDF5 was given a file without a seal")

    monkeypatch.setattr(h5py, "File", parsed)
    whole = saved(kind).read_bytes()
    rng, path = np.random.default_rng(2012), tmp_path / "wrong.h5"
    end = len(whole)
    for position in {*rng.choice(end, 60, replace=False), *range(8), *range(end - 90, end, 3)}:
        content = bytearray(whole)
        content[position] ^= 1 << int(rng.integers(8))
        path.write_bytes(content)
        with pytest.raises(TableError):
            Table.load(path)
    bare = whole.rpartition(b"\npuck-tables")[0]
    for content in (bare, whole[:-1], *(whole[: int(s * end)] for s in (0.0, 0.01, 0.3, 0.999))):
        path.write_bytes(content)
        with pytest.raises(TableError, match=r"digest|not an HDF5 file"):
            Table.load(path)


@every_kind
def test_other_formats_kinds_and_strangers_are_refused_by_name(kind, saved, tmp_path):
    for version, words in (
        ("5.0", r"format 5\.0, newer than 4\.0 of this program: update puck-tables"),
        ("3.0", r"format 3\.0, older than 4\.0 of this program: build it again"),
    ):
        edited = altered(
            saved(kind),
            tmp_path / "other.h5",
            lambda f, v=version: f.attrs.update(format_version=v),
        )
        with pytest.raises(TableError, match=words):
            Table.load(edited)
    made = altered(saved(kind), tmp_path / "made.h5", lambda f: f.attrs.update(algorithm="mine; 9"))
    with pytest.raises(TableError, match="recipe that this program does not know"):
        Table.load(made)
    bare = altered(saved(kind), tmp_path / "bare.h5", lambda f: f.pop("made_of"))
    with pytest.raises(TableError, match="cannot be read as a table"):
        Table.load(bare)
    renamed = altered(saved(kind), tmp_path / "kind.h5", lambda f: f.attrs.update(kind="partial"))
    with pytest.raises(TableError, match="holds 'partial', not a table of 'resultants' or 'stops'"):
        Table.load(renamed)
    other = type(small("stops" if kind != "stops" else "resultants"))
    with pytest.raises(TableError, match=f"holds '{small(kind).kind}', not a table of"):
        other.load(saved(kind))


@pytest.mark.parametrize(
    ("of", "arguments", "error", "words"),
    [
        ("uniform", {"cells": 3}, InputError, "from 4"),
        ("stops", {"cells": 7}, InputError, "from 8"),
        ("hertz", {"cells": 10**7}, InputError, "from 4 to"),
        ("uniform", {"cells": 16, "accuracy": 1e-3}, InputError, "both"),
        ("stops", {"cells": 16, "accuracy": 1e-3}, InputError, "both"),
        ("uniform", {"accuracy": 1e-15}, AccuracyError, "from 1e-13"),
        ("uniform", {"accuracy": float("nan")}, AccuracyError, "accuracy"),
        ("hertz", {"accuracy": 1e-14}, AccuracyError, "from 1e-11"),
        ("stops", {"accuracy": 1e-13}, AccuracyError, "from 1e-11"),
        (LAW, {"accuracy": 1e-14}, AccuracyError, "from 1e-13"),
        (("uniform", 2.0), {"accuracy": 1e-15}, AccuracyError, "from 5e-13"),
        (("uniform", 3.98), {}, InputError, "more than one solution"),
        (("ring", 2.5), {}, InputError, "outside full contact"),
        ("square", {}, InputError, "no pressure law is called 'square'"),
        (7, {}, InputError, "not of 7"),
    ],
)
def test_bad_requests_are_refused(of: object, arguments: dict, error: type, words: str):
    with pytest.raises(error, match=words):
        Table.build(of, **arguments)


@pytest.mark.parametrize("of", few(3, ["uniform", "ring", LAW, "stops"]), ids=str)
def test_progress_is_told(of: object):
    told: list[tuple[int, int]] = []
    Table.build(of, 1e-5, progress=lambda done, total: told.append((done, total)))
    assert told
    assert all(0 < done <= total for done, total in told)


def test_laws_that_no_file_holds_are_not_saved(tmp_path: Path):
    for name in ("mine", "ring"):  # nor one that borrows a name
        law = replace(law_of("hertz"), name=name)
        with pytest.raises(OutputError, match=f"the pressure law {name} is a function"):
            Table.build(law, cells=8).save(tmp_path / "mine.h5")
    assert list(tmp_path.iterdir()) == []


def test_a_name_in_a_file_opens_no_other_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.chdir(tmp_path)
    Path("stone.csv").write_text("0,1\n0.5,2\n1,0.5\n")
    path = Path("stone.h5")
    small("profile").save(path)

    def emptied(opened: h5py.File) -> None:
        del opened["made_of"]
        opened["made_of"] = json.dumps({"law": {"pressure": "stone.csv"}})

    read: list[object] = []
    monkeypatch.setattr("puck_tables.contact.laws.numbers_of", read.append)
    with pytest.raises(TableError, match="neither names nor holds its pressure law"):
        Table.load(altered(path, Path("bare.h5"), emptied))
    assert read == []


def test_the_tables_that_come_along():
    folder = files("puck_tables.tables")
    sizes = [len(p.read_bytes()) for p in folder.iterdir() if p.name.endswith(".h5")]
    assert len(sizes) == 2
    assert sum(sizes) < 500_000
    assert Table.shipped() is Table.shipped("resultants")
    for kind, most in (("resultants", 2e-11), ("stops", 1e-10)):
        table = Table.shipped(kind)
        assert table.kind == kind
        assert table.accuracy.worst <= table.tolerance == most
    for kind in ("speed", "partial", "../tables/stops", "friction section"):
        with pytest.raises(InputError, match="comes along"):
            Table.shipped(kind)


def test_no_pickle_is_reachable():
    """Nothing of the package imports what can run code that stands in a file."""
    sources = [*(ROOT / "puck_tables").rglob("*.py"), *(ROOT / "cli").rglob("*.py")]
    for path in sources:
        text = path.read_text(encoding="utf-8")
        for word in (r"^ *import (pickle|marshal)\b", "allow_pickle=True", r"eval\(", r"exec\("):
            assert not re.search(word, text, re.MULTILINE), (path, word)

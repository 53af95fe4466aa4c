"""Table files made to do harm, each with a right seal: refused with bounded memory, run nothing."""

from __future__ import annotations

import resource
import shutil
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from importlib.resources import files
from pathlib import Path

import h5py
import numpy as np
import pytest
from conftest import ROOT

from puck_tables import (
    build_law_table,
    law_of,
    load_law_table,
    profile_law,
    save_law_table,
    validate_law,
)
from puck_tables.catalogue import load_any_table
from puck_tables.errors import InputError, TableError
from puck_tables.table.container import sealed

SHIPPED = {name: files("puck_tables.tables") / f"{name}.h5" for name in
           ("resultants", "stops", "partial")}  # fmt: skip
Edit = Callable[[h5py.File], object]


@pytest.fixture(scope="module")
def law_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("law") / "ring.h5"
    save_law_table(build_law_table(law_of("ring"), cells=8), path)
    return path


def forged(source: Path, to: Path, edit: Edit) -> Path:
    """A copy changed by h5py and sealed again: only the content digest is wrong."""
    shutil.copy(str(source), to)
    with h5py.File(to, "r+") as opened:
        edit(opened)
    to.write_bytes(sealed(to.read_bytes()))
    return to


def virtual(opened: h5py.File) -> None:
    shape = opened["phi"].shape
    del opened["phi"]
    layout = h5py.VirtualLayout(shape, "<f8")
    layout[...] = h5py.VirtualSource("/dev/zero", "phi", shape)
    opened.create_virtual_dataset("phi", layout)


def replaced(**given: object) -> Edit:
    def edit(opened: h5py.File) -> None:
        shape = opened["phi"].shape
        del opened["phi"]
        opened.create_dataset("phi", shape, **{"dtype": "<f8", **given})

    return edit


def linked(link: object) -> Edit:
    def edit(opened: h5py.File) -> None:
        del opened["phi"]
        opened["phi"] = link

    return edit


def object_pickled(opened: h5py.File) -> None:
    import pickle

    opened.attrs["tolerance"] = np.void(pickle.dumps(print))


FORGERIES: dict[str, tuple[Edit, str]] = {
    "an external link": (linked(h5py.ExternalLink("/dev/zero", "/phi")), "no root group"),
    "a soft link": (linked(h5py.SoftLink("/delta")), "missing or a link"),
    "a virtual dataset": (virtual, "plainly"),
    "values in another file": (replaced(external=[("/etc/hostname", 0, 7928)]), "plainly"),
    "a filter": (replaced(chunks=True, compression="gzip"), "plainly"),
    "vlen": (replaced(dtype=h5py.vlen_dtype(np.float64)), "do not fit"),
    "texts": (replaced(dtype=h5py.string_dtype()), "do not fit"),
    "references": (replaced(dtype=h5py.ref_dtype), "do not fit"),
    "an enum": (replaced(dtype=h5py.enum_dtype({"A": 1}, "i8")), "do not fit"),
    "big endian": (replaced(dtype=">f8"), "do not fit"),
    "a folder": (lambda f: (f.pop("phi"), f.create_group("phi")), "damaged"),
    "nothing": (lambda f: f.pop("phi"), "missing or a link"),
    "a pickle in an attribute": (object_pickled, "neither a number nor a text"),
    "an array in an attribute": (lambda f: f.attrs.create("n_phi", np.ones(8000)), "is an array"),
    "a reference in an attribute": (lambda f: f.attrs.create("kind", f.ref), "neither a number"),
}  # fmt: skip


@pytest.mark.parametrize("name", FORGERIES)
def test_only_plain_numbers_in_this_file_are_read(name: str, tmp_path: Path):
    edit, words = FORGERIES[name]
    with pytest.raises(TableError, match=words):
        load_any_table(forged(SHIPPED["resultants"], tmp_path / "forged.h5", edit))


def test_no_pickle_is_reachable():
    """Nothing of the package imports what can run code that stands in a file."""
    sources = [*(ROOT / "puck_tables").rglob("*.py"), *(ROOT / "cli").rglob("*.py")]
    for path in sources:
        text = path.read_text(encoding="utf-8")
        for word in ("import pickle", "allow_pickle=True", "eval(", "exec(", "import marshal"):
            assert word not in text, (path, word)


ABSURD: dict[str, list[dict[str, object]]] = {
    "resultants": [{"n_phi": 10**12 + 1}, {"n_delta": 10**12}, {"n_phi": "many"}, {"n_phi": -9},
                   {"n_phi": 1e12}, {"n_phi": 2**63 - 1, "n_delta": 2**63 - 1}],
    "stops": [{"cells": 10**12}, {"cells": -8}, {"cells": 1e300}],
    "partial": [{"cells": 10**12}, {"cells": 0}],
    "law": [{"cells": 10**12}, {"edges": "[" * 50_000}, {"edges": "[1e-300, 1.0]"},
            {"profile_rows": 10**12}, {"profile_rows": -1}, {"delta_max": "nan"}],
}  # fmt: skip


@pytest.mark.parametrize("kind", ABSURD)
def test_absurd_sizes_take_no_memory(kind: str, tmp_path: Path, law_file: Path):
    """Loaded by a process that may have 2 GiB of addresses: each is refused in a sentence."""
    source = law_file if kind == "law" else SHIPPED[kind]
    for count, attributes in enumerate(ABSURD[kind]):
        forged(source, tmp_path / f"{count}.h5", lambda f, given=attributes: f.attrs.update(given))
    code = (
        "import sys\n"
        "from puck_tables.catalogue import load_any_table\n"
        "from puck_tables.errors import TableError\n"
        "for path in sys.argv[1:]:\n"
        "    try:\n        load_any_table(path)\n    except TableError as error:\n"
        "        print(error)"
    )
    paths = sorted(str(path) for path in tmp_path.iterdir())
    ended = subprocess.run(
        [sys.executable, "-c", code, *paths], capture_output=True, text=True,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (2**31, 2**31)),
    )  # fmt: skip
    assert ended.returncode == 0, ended.stderr
    assert len(ended.stdout.splitlines()) == len(paths)


def test_arrays_larger_than_their_file_are_not_made(tmp_path: Path):
    """Chunks that were never written: 8 GB of numbers in a file of some kB."""

    def hollow(opened: h5py.File) -> None:
        for name in ("parallel", "perpendicular", "spin", "phi", "delta"):
            shape = {"phi": (1_000_001,), "delta": (1000,)}.get(name, (1_000_001, 1000))
            del opened[name]
            opened.create_dataset(name, shape=shape, dtype="<f8", chunks=True)
        opened.attrs.update(n_phi=1_000_001, n_delta=1000)

    path = forged(SHIPPED["resultants"], tmp_path / "hollow.h5", hollow)
    with pytest.raises(TableError, match="shorter than its arrays"):
        load_any_table(path)


@pytest.mark.parametrize("kind", ["resultants", "stops", "partial", "law"])
def test_every_flipped_bit_is_refused(kind: str, tmp_path: Path, law_file: Path):
    """Before HDF5 reads a byte: there are flips that make it hang."""
    whole = bytearray((law_file if kind == "law" else SHIPPED[kind]).read_bytes())
    rng = np.random.default_rng(7)
    path = tmp_path / "flipped.h5"
    path.write_bytes(whole)
    end = len(whole)
    positions = [*rng.choice(end, 60, replace=False), *range(8), *range(end - 90, end, 3)]
    for position in positions:
        bit = 1 << int(rng.integers(8))
        with open(path, "r+b") as file:  # one byte there and back: the files are large
            file.seek(position)
            file.write(bytes([whole[position] ^ bit]))
        with pytest.raises(TableError):
            load_any_table(path)
        with open(path, "r+b") as file:
            file.seek(position)
            file.write(bytes([whole[position]]))
    load_any_table(path)


def test_an_older_file_of_a_profile_is_read(tmp_path: Path):
    """Format 1 holds no profile: everything works but the judgement."""
    law = profile_law([0.0, 0.5, 1.0], [1.0, 2.0, 0.5], name="stone.csv")
    table = build_law_table(law, cells=8)
    new = tmp_path / "new.h5"
    loaded = save_law_table(table, new)
    assert loaded.passport["format_version"] == "2.0"
    np.testing.assert_array_equal(loaded.profile[0], [0.0, 0.5, 1.0])
    np.testing.assert_array_equal(loaded.profile[1], [0.5, 1.0, 0.25])
    assert validate_law(loaded, points=200).passed
    old = save_law_table(replace(table, profile=None), tmp_path / "old.h5")
    assert old.passport["format_version"] == "1.0"
    again = load_law_table(tmp_path / "old.h5")
    assert again.resultants(0.3, 0.2).spin == loaded.resultants(0.3, 0.2).spin
    with pytest.raises(InputError, match=r"does not hold the profile stone\.csv"):
        validate_law(again)
    assert validate_law(again, law, points=200).passed

"""Table files made to do harm, each with a right seal: refused with bounded memory, run nothing."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np
import pytest
from conftest import ROOT
from kinds_of_table import small

from puck_tables import Table
from puck_tables.errors import TableError
from puck_tables.table.file import sealed

Edit = Callable[[h5py.File], object]


@pytest.fixture(scope="module")
def saved(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Path]:
    """The file of a small table of a kind, made once."""
    folder = tmp_path_factory.mktemp("tables")

    def path_of(kind: str) -> Path:
        path = folder / f"{kind}.h5"
        if not path.exists():
            small(kind).save(path)
        return path

    return path_of


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
def test_only_plain_numbers_in_this_file_are_read(
    name: str, tmp_path: Path, saved: Callable[[str], Path]
):
    edit, words = FORGERIES[name]
    with pytest.raises(TableError, match=words):
        Table.load(forged(saved("resultants"), tmp_path / "forged.h5", edit))


def test_no_pickle_is_reachable():
    """Nothing of the package imports what can run code that stands in a file."""
    sources = [*(ROOT / "puck_tables").rglob("*.py"), *(ROOT / "cli").rglob("*.py")]
    for path in sources:
        text = path.read_text(encoding="utf-8")
        for word in (r"^ *import (pickle|marshal)\b", "allow_pickle=True", r"eval\(", r"exec\("):
            assert not re.search(word, text, re.MULTILINE), (path, word)


ABSURD: dict[str, list[dict[str, object]]] = {
    "resultants": [{"n_phi": 10**12 + 1}, {"n_phi": "many"}, {"n_phi": -9}, {"n_phi": 0},
                   {"n_phi": 1e12}, {"n_phi": 2**63 - 1}, {"n_phi": 70}],
    "profile": [{"profile_rows": 10**12}, {"profile_rows": -1}, {"profile_rows": 0},
                {"pressure_law": "annulus:1e-300"}, {"profile_rows": "nan"}],
    "section": [{"n_phi": 10**12}, {"n_phi": 0}, {"delta": 1e300}, {"delta": -1.0},
              {"cotangents": "[]"}, {"cotangents": "[" * 50_000}, {"cotangents": "[NaN]"},
              {"cotangents": "[1.0, 1.0]"}, {"cotangents": "[0.0, Infinity]"}],
    "stop section": [{"n_phi": 10**12}, {"n_phi": 3}, {"gyration": 1e300}, {"gyration": -1.0},
                     {"gyration": 0.05}, {"friction_error": -1.0}, {"delta": 3.0}],
    "stops": [{"cells": 10**12}, {"cells": -8}, {"cells": 0}, {"cells": 1e300}],
    "speed": [{"nodes": 10**12}, {"nodes": -1}, {"patches": 0}, {"breaks": "[" * 50_000},
              {"law_speeds": "[]"}, {"law_values": "null"}],
}  # fmt: skip


@pytest.mark.thorough
@pytest.mark.parametrize("kind", ABSURD)
def test_absurd_sizes_take_no_memory(kind: str, tmp_path: Path, saved: Callable[[str], Path]):
    """Loaded by a process that may have 2 GiB of addresses: each is refused in a sentence."""
    for count, attributes in enumerate(ABSURD[kind]):
        forged(
            saved(kind), tmp_path / f"{count}.h5", lambda f, given=attributes: f.attrs.update(given)
        )
    code = (
        "import resource, sys\n"
        "resource.setrlimit(resource.RLIMIT_AS, (2**31, 2**31))\n"
        "from puck_tables import Table\n"
        "from puck_tables.errors import TableError\n"
        "for path in sys.argv[1:]:\n"
        "    try:\n        Table.load(path)\n    except TableError as error:\n"
        "        print(error)"
    )
    paths = sorted(str(path) for path in tmp_path.iterdir())
    ended = subprocess.run([sys.executable, "-c", code, *paths], capture_output=True, text=True)
    assert ended.returncode == 0, ended.stderr
    assert len(ended.stdout.splitlines()) == len(paths)


def test_arrays_larger_than_their_file_are_not_made(tmp_path: Path, saved: Callable[[str], Path]):
    """Chunks that were never written: 8 GB of numbers in a file of some kB."""

    def hollow(opened: h5py.File) -> None:
        for name in ("parallel", "perpendicular", "spin", "phi"):
            shape = (250_000_001,) if name == "phi" else (250_000_001, 4)
            del opened[name]
            opened.create_dataset(name, shape=shape, dtype="<f8", chunks=True)
        opened.attrs.update(n_phi=250_000_001)

    path = forged(saved("resultants"), tmp_path / "hollow.h5", hollow)
    with pytest.raises(TableError, match="shorter than its arrays"):
        Table.load(path)

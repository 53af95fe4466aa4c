"""The only door to table files: HDF5 with metadata, refused unless whole and unaltered.

After the HDF5 content stands a line with its sha256, the seal: nothing without a right one is given
to the HDF5 library.  Whoever makes a file with a right seal is trusted as one whose code is run;
``puck validate`` judges the numbers of any table.

Layout: as :mod:`puck_tables.io.hdf5` writes results, a dataset per axis and per function over all
axes, what the values follow from as JSON in ``made_of``, everything else in attributes of the root.
The file is made and read in memory, so that a failing disk leaves no half of one.
"""

from __future__ import annotations

import hashlib
import io
import json
import platform
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables._core.safe_read import read_whole
from puck_tables._version import __version__
from puck_tables.errors import TableError
from puck_tables.io.columns import Dataset, Variable

FORMAT, FORMAT_VERSION = "puck-tables", "4.0"
MAX_FILE_BYTES = 1 << 31  # bytes: more is no table
_SEAL = b"\npuck-tables sha256 "  # before the digest of all that stands above it
AGAIN = "build it again with 'puck build-tables'"
_MADE_OF = "made_of"


def sealed(content: bytes) -> bytes:
    r"""HDF5 content with the line that proves it whole.

    >>> sealed(b"")[:20]
    b'\npuck-tables sha256 '
    """
    return content + _SEAL + hashlib.sha256(content).hexdigest().encode() + b"\n"


def encode(
    axes: Mapping[str, Variable], functions: Mapping[str, Variable], said: Mapping[str, object],
    made_of: object,
) -> bytes:  # fmt: skip
    """The bytes of a table file, sealed: axes, functions over all of them, attributes.

    ``made_of``: what the values follow from, as JSON has it.
    """
    import h5py

    from puck_tables.io import hdf5

    attributes = {
        "format": FORMAT, "format_version": FORMAT_VERSION, **said,
        "package_version": __version__,
        "library_versions": (
            f"python {platform.python_version()}, numpy {np.__version__}, "
            f"h5py {h5py.__version__}, HDF5 {h5py.version.hdf5_version}"
        ),
    }  # fmt: skip
    texts = {_MADE_OF: (json.dumps(made_of), "what the values follow from, as JSON")}
    return sealed(hdf5.encode(Dataset(axes, functions, attributes, texts)))


def read_content(path: str | Path) -> bytes:
    """The bytes of a table file, as :meth:`puck_tables.Table.load` takes it."""
    try:
        return read_whole(path, MAX_FILE_BYTES)
    except FileNotFoundError:
        raise TableError(
            f"there is no table file {path}: build one with 'puck build-tables -o FILE', "
            "or leave --table out to use the tables that come along"
        ) from None
    except OSError as error:
        raise TableError(f"cannot read {path}: {error.strerror or error}") from None


def decode(content: bytes, source: str) -> tuple[dict[str, Any], dict[str, FloatArray], Any]:
    """What a file says, its arrays by name, and what they follow from.

    >>> decode(b"puck", "my.h5")
    Traceback (most recent call last):
    ...
    puck_tables.errors.TableError: my.h5 is not an HDF5 file
    """
    if not content.startswith(b"\x89HDF\r\n\x1a\n"):
        raise TableError(f"{source} is not an HDF5 file")
    inside, seal, digest = content.rpartition(_SEAL)
    if not seal:
        raise TableError(
            f"{source} is not a table of this program, or one that was cut or edited: it does not "
            "end with its digest; give a file made by 'puck build-tables'"
        )
    if sealed(inside) != content:
        raise TableError(f"{source} was altered or damaged: it does not match its digest; {AGAIN}")
    import h5py

    with h5py.File(io.BytesIO(inside), "r") as file:
        said: dict[str, Any] = {
            name: value.item() if isinstance(value, np.generic) else value
            for name, value in file.attrs.items()
        }
        _refuse_format(said, source)
        arrays = {name: data[()] for name, data in file.items() if name != _MADE_OF}
        made_of = json.loads(file[_MADE_OF].asstr()[()])
    return said | {"digest": digest.decode().strip()}, arrays, made_of


def _refuse_format(said: dict[str, Any], source: str) -> None:
    if said.get("format") != FORMAT:
        raise TableError(f"{source} is an HDF5 file but not a table of this program")
    version = str(said.get("format_version"))
    major, ours = (one.split(".")[0] for one in (version, FORMAT_VERSION))
    if major != ours:
        newer = major.isdecimal() and int(major) > int(ours)
        raise TableError(
            f"{source} has table format {version}, {'newer' if newer else 'older'} than "
            f"{FORMAT_VERSION} of this program: " + ("update puck-tables" if newer else AGAIN)
        )

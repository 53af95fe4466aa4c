"""The only door to table files: HDF5 with metadata, refused unless whole, unaltered and usable.

After the HDF5 content stands a line with its sha256, the seal: nothing without a right one is given
to the HDF5 library.  Whoever makes a file with a right seal is trusted as one whose code is run;
``puck validate`` judges the numbers of any table.

Layout: one dimension scale per axis, one little-endian float64 dataset per function over all axes,
everything else in attributes of the root.  The file is made and read in memory, so that a failing
disk leaves no half of one.
"""

from __future__ import annotations

import hashlib
import io
import json
import math
import platform
from collections.abc import Mapping
from dataclasses import asdict
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables._core.safe_read import read_whole
from puck_tables._core.safe_write import as_utf8, write_bytes
from puck_tables._version import __version__
from puck_tables.errors import OutputError, TableError
from puck_tables.table.accuracy import Accuracy
from puck_tables.table.metadata import Axis, Record, kind_named

FORMAT, FORMAT_VERSION = "puck-tables", "3.0"
MAX_FILE_BYTES = 1 << 31  # bytes: more is no table
_SEAL = b"\npuck-tables sha256 "

# what every kind of table says of itself, besides its recipe
_ENTRIES: Mapping[str, type] = dict.fromkeys(
    (
        "format", "format_version", "title", "interpretation", "valid_range", "achieved_accuracy",
        "method", "package_version", "library_versions", "created", "command", "recipe_digest",
        "content_digest",
    ), str,
) | {"tolerance": float}  # fmt: skip
_SAID = ("title", "interpretation", "method")  # of a kind's words; the others are of the recipe
_WORDS = {int: "whole number", float: "finite number", str: "text"}
_SAME = 1e-14  # of axes


def recipe_digest(recipe: dict[str, Any]) -> str:
    """Digest of what determines the values of a table.

    Examples
    --------
    >>> recipe_digest({})[:8]
    '44136fa3'
    """
    return hashlib.sha256(json.dumps(recipe, sort_keys=True).encode()).hexdigest()


def sealed(content: bytes) -> bytes:
    r"""HDF5 content with the line that proves it whole.

    Examples
    --------
    >>> sealed(b"")[:20]
    b'\npuck-tables sha256 '
    """
    return content + _SEAL + hashlib.sha256(content).hexdigest().encode() + b"\n"


def save(table: Record, path: str | Path, overwrite: bool, command: str) -> Record:
    """Write a table, see :meth:`puck_tables.Table.save`."""
    if table.accuracy is None or not np.all(np.isfinite(table.values)):
        raise OutputError(
            "a table without measured accuracy or with a non-finite value is not saved"
        )
    if table.unsaveable is not None:
        raise OutputError(table.unsaveable)
    content = encode(table, command)
    written = decode(content, str(path), (table.kind,))
    if not np.array_equal(written.values, table.values):
        raise TableError(f"{path}: the table does not read back as it was written")
    write_bytes(path, content, overwrite)
    return written


def encode(table: Record, command: str) -> bytes:
    """The bytes of the file of a table with a measured accuracy, sealed."""
    import h5py

    assert table.accuracy is not None
    recipe = _recipe(table)
    attributes = {
        "Conventions": "CF-1.11",
        "format": FORMAT,
        "format_version": FORMAT_VERSION,
        **recipe,
        **{name: table.words[name] for name in _SAID},
        "valid_range": table.valid_range,
        "tolerance": table.tolerance,
        "achieved_accuracy": json.dumps(asdict(table.accuracy)),
        "package_version": __version__,
        "library_versions": (
            f"python {platform.python_version()}, numpy {np.__version__}, h5py {h5py.__version__}, "
            f"HDF5 {h5py.version.hdf5_version}"
        ),
        "created": datetime.now(UTC).isoformat(timespec="seconds"),
        "command": as_utf8(command),
        "recipe_digest": recipe_digest(recipe),
    }
    arrays: dict[str, FloatArray] = {}
    buffer = io.BytesIO()
    with h5py.File(buffer, "w") as file:

        def write(name: str, values: FloatArray, **said: str | float) -> None:
            file.create_dataset(name, data=values, dtype="<f8").attrs.update(said)
            arrays[name] = values

        def write_axis(name: str, axis: Axis) -> None:
            write(name, axis.values, units=axis.units, long_name=axis.long_name)

        for name, axis in table.axes.items():
            write_axis(name, axis)
            file[name].make_scale(name)
        for column, (name, long_name) in enumerate(table.functions.items()):
            largest = table.accuracy.largest[column]
            values = table.values[..., column]
            write(name, values, units="1", long_name=long_name, max_error=largest)
            for dimension, axis_name in enumerate(table.axes):
                file[name].dims[dimension].attach_scale(file[axis_name])
        for name, axis in table.curve.items():
            write_axis(name, axis)
        if table.curve:
            argument, function = table.curve
            file[argument].make_scale(argument)
            file[function].dims[0].attach_scale(file[argument])
        file.attrs.update(attributes)
        file.attrs["content_digest"] = _digest(attributes, arrays)
    return sealed(buffer.getvalue())


def _recipe(table: Record) -> dict[str, Any]:
    """What determines the values of a table."""
    maps = {name: text for name, text in table.words.items() if name not in _SAID}
    return {
        "kind": table.kind, "pressure_law": table.pressure_law, "algorithm": table.algorithm,
        **maps, **table.parameters,
    }  # fmt: skip


def read_content(path: str | Path) -> bytes:
    """The bytes of a table file.

    Raises
    ------
    TableError
        If it is missing, no regular file, too large or cannot be read.

    Examples
    --------
    >>> read_content("/nowhere/table.h5")
    Traceback (most recent call last):
    ...
    puck_tables.errors.TableError: there is no table file /nowhere/table.h5: build one with \
'puck build-tables -o FILE', or leave --table out to use the tables that come along
    """
    try:
        return read_whole(path, MAX_FILE_BYTES)
    except FileNotFoundError:
        raise TableError(
            f"there is no table file {path}: build one with 'puck build-tables -o FILE', "
            "or leave --table out to use the tables that come along"
        ) from None
    except OSError as error:
        raise TableError(f"cannot read {path}: {error.strerror or error}") from None


def decode(content: bytes, source: str, kinds: tuple[str, ...]) -> Record:
    """The table in the bytes of a file, of one of these kinds.

    Raises
    ------
    TableError
        If they are not a table, of another kind or format, altered, or none that this program can
        use.

    Examples
    --------
    >>> decode(b"puck", "my.h5", ("stops",))
    Traceback (most recent call last):
    ...
    puck_tables.errors.TableError: my.h5 is not an HDF5 file
    """
    if not content.startswith(b"\x89HDF\r\n\x1a\n"):
        raise TableError(f"{source} is not an HDF5 file")
    inside, seal, _ = content.rpartition(_SEAL)
    if not seal:
        raise TableError(
            f"{source} is not a table of this program, or one that was cut or edited: it does not "
            "end with its digest; give a file made by 'puck build-tables'"
        )
    if sealed(inside) != content:
        raise TableError(
            f"{source} was altered or damaged: it does not match its digest; "
            "build it again with 'puck build-tables'"
        )
    try:
        with np.errstate(all="ignore"):  # numbers that no table has are refused in the end
            return _read(inside, source, kinds)
    except TableError:
        raise
    except Exception as error:  # whatever numbers and texts of any kind and size lead to
        reason = str(error) if type(error) is ValueError else type(error).__name__
        raise TableError(
            f"{source} is damaged and cannot be read as a table ({reason}): "
            "build it again with 'puck build-tables'"
        ) from None


def _read(content: bytes, source: str, kinds: tuple[str, ...]) -> Record:
    import h5py

    with h5py.File(io.BytesIO(content), "r") as file:
        attributes: dict[str, Any] = {
            name: value.item() if isinstance(value, np.generic) else value
            for name, value in file.attrs.items()
        }
        everything = {name: np.asarray(dataset[()]) for name, dataset in file.items()}
    _refuse_format(attributes, source)
    name = str(attributes.get("kind"))
    if name not in kinds:
        wanted = " or ".join(f"'{kind}'" for kind in kinds)
        raise TableError(
            f"{source} holds '{name}', not a table of {wanted}: "
            "give a file made by 'puck build-tables'"
        )
    kind = kind_named(name)
    texts = dict.fromkeys(("kind", "pressure_law", "algorithm", *kind.words), str)
    for entry, type_ in {**_ENTRIES, **texts, **kind.entries}.items():
        found = attributes.get(entry)
        if type(found) is not type_ or (isinstance(found, float) and not math.isfinite(found)):
            raise ValueError(f"its entry {entry} is missing or no {_WORDS[type_]}")
    shapes = kind.shapes(attributes)
    arrays = {array: everything[array] for array in shapes}
    if any(arrays[array].shape != shape for array, shape in shapes.items()):
        raise ValueError("its arrays have not the sizes that it says")
    stated = attributes.pop("content_digest")
    if _digest(attributes, arrays) != stated:
        raise TableError(
            f"{source} was altered or damaged: its content does not match its digest; "
            "build it again with 'puck build-tables'"
        )
    table = kind(
        np.stack([arrays[function] for function in kind.functions], axis=-1),
        **kind.fields(attributes, arrays),
        tolerance=attributes["tolerance"],
        accuracy=Accuracy.read(attributes["achieved_accuracy"], len(kind.functions)),
        metadata={**attributes, "content_digest": stated},
        source=source,
    )
    _refuse_unusable(table, arrays)
    return table


def _refuse_format(attributes: dict[str, Any], source: str) -> None:
    if attributes.get("format") != FORMAT:
        raise TableError(f"{source} is an HDF5 file but not a table of this program")
    major, ours = (
        str(version).split(".")[0] for version in (attributes.get("format_version"), FORMAT_VERSION)
    )
    if major.isdecimal() and major != ours:
        newer = int(major) > int(ours)
        raise TableError(
            f"{source} has table format {attributes['format_version']}, "
            f"{'newer' if newer else 'older'} than {FORMAT_VERSION} of this program: "
            + ("update puck-tables" if newer else "build it again with 'puck build-tables'")
        )


def _refuse_unusable(table: Record, arrays: dict[str, FloatArray]) -> None:
    """Refuse a file whose digest is right but whose numbers this program cannot use."""
    recipe = _recipe(table)
    known = {**recipe, "recipe_digest": recipe_digest(recipe)}
    if any(table.metadata.get(name) != value for name, value in known.items()):
        raise TableError(f"{table.source} was made by a recipe that this program does not know")
    low, high, finest = table.bounds
    fixed = table.axes | table.curve
    if not (
        all(np.allclose(arrays[n], a.values, rtol=_SAME, atol=_SAME) for n, a in fixed.items())
        and np.all((table.values >= low) & (table.values <= high))
        and finest < table.tolerance < 1.0
    ):
        raise TableError(f"{table.source} has axes or values that this program cannot use")


def _digest(attributes: dict[str, Any], arrays: dict[str, FloatArray]) -> str:
    digest = hashlib.sha256(json.dumps(attributes, sort_keys=True).encode())
    for array in arrays.values():
        digest.update(json.dumps(array.shape).encode())
        digest.update(np.ascontiguousarray(array, dtype="<f8").tobytes())
    return digest.hexdigest()

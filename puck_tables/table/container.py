"""The only door to table files: HDF5 with a passport, refused unless whole and unaltered.

After the HDF5 content stands a line with its sha256, the seal.  Nothing without a right one is
read, and what is read is never given to the HDF5 library, which wrong metadata can make hang
(:mod:`puck_tables.table.plain_hdf5`).  What a kind of table puts into a file stands with that kind.

Layout: one dimension scale per axis, one little-endian float64 dataset per function over all axes,
everything else in attributes of the root.  Nothing else is read: no links, no filters, no objects.
The file is made and read in memory, so that a failing disk leaves no half of one.
"""

from __future__ import annotations

import hashlib
import io
import json
import math
import platform
from collections.abc import Callable, Mapping, Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, NamedTuple, Protocol, TypeVar

import numpy as np
import numpy.typing as npt

from puck_tables._version import __version__
from puck_tables.errors import OutputError, TableError
from puck_tables.real import instance
from puck_tables.safe_read import read_whole
from puck_tables.safe_write import write_bytes
from puck_tables.table.plain_hdf5 import PlainFile

FloatArray = npt.NDArray[np.float64]

FORMAT = "puck-tables"
FORMAT_VERSION = "2.0"  # the newest that is read; 2 may hold a curve
MAX_FILE_BYTES = 1 << 31
_SEAL = b"\npuck-tables sha256 "


class Field(NamedTuple):
    """An axis or a function: its name, its values, and its attributes in the file."""

    name: str
    values: FloatArray
    attributes: dict[str, Any]


class Contents(NamedTuple):
    """What stands in a file: attributes (with ``content_digest``) and arrays by name."""

    attributes: dict[str, Any]
    arrays: dict[str, FloatArray]


class Kind(NamedTuple):
    """How the tables of one kind stand in files.

    ``entries``: the attributes it has besides those of all kinds, and their types; ``shapes``: from
    the attributes to the shapes of the arrays, axes first; ``table_of``: the table of what was read
    from a source.
    """

    entries: Mapping[str, type]
    shapes: Callable[[dict[str, Any]], dict[str, tuple[int, ...]]]
    table_of: Callable[[Contents, str], Any]


# what every kind of table says of itself
_ENTRIES: Mapping[str, type] = dict.fromkeys(
    (
        "format", "format_version", "kind", "pressure_law", "algorithm", "title",
        "interpretation", "valid_range", "achieved_accuracy", "method", "package_version",
        "library_versions", "created", "command", "recipe_digest", "content_digest",
    ), str,
) | {"tolerance": float}  # fmt: skip
_WORDS = {int: "whole number", float: "finite number", str: "text"}


def recipe_digest(recipe: dict[str, Any]) -> str:
    """Digest of what determines the values of a table.

    Examples
    --------
    >>> recipe_digest({})[:8]
    '44136fa3'
    """
    return hashlib.sha256(json.dumps(recipe, sort_keys=True).encode()).hexdigest()


def encode(
    recipe: dict[str, Any],
    described: dict[str, Any],
    axes: list[Field],
    functions: list[Field],
    command: str,
    curve: tuple[Field, Field] | None = None,
) -> bytes:
    """The bytes of a table file.

    Parameters
    ----------
    recipe : what determines the values: kind, axes, algorithm; with its own digest in the file
    described : what else the file says: title, interpretation, range, accuracy
    axes, functions : the arrays; every function has all axes as its dimensions
    command : how the table was made
    curve : a function of one variable besides, as (argument, values)

    Returns
    -------
    bytes, sealed

    Examples
    --------
    >>> line = Field("x", np.zeros(2), {"units": "1"})
    >>> encode({"kind": "none"}, {}, [line], [], "by hand")[1:4]
    b'HDF'
    """
    import h5py  # not needed where tables are only read

    attributes = {
        "Conventions": "CF-1.11",
        "format": FORMAT,
        "format_version": "1.0" if curve is None else "2.0",  # the oldest that will do
        **recipe,
        **described,
        "package_version": __version__,
        "library_versions": (
            f"python {platform.python_version()}, numpy {np.__version__}, h5py {h5py.__version__}, "
            f"HDF5 {h5py.version.hdf5_version}"
        ),
        "created": datetime.now(UTC).isoformat(timespec="seconds"),
        "command": command,
        "recipe_digest": recipe_digest(recipe),
    }
    groups = [(axes, functions)] + ([] if curve is None else [([curve[0]], [curve[1]])])
    arrays: dict[str, FloatArray] = {}
    buffer = io.BytesIO()
    with h5py.File(buffer, "w") as file:
        for scales, fields in groups:
            for field in (*scales, *fields):
                data = file.create_dataset(field.name, data=field.values, dtype="<f8")
                data.attrs.update(field.attributes)
                arrays[field.name] = field.values
            for axis in scales:
                file[axis.name].make_scale(axis.name)
            for function in fields:
                for dimension, axis in enumerate(scales):
                    file[function.name].dims[dimension].attach_scale(file[axis.name])
        file.attrs.update(attributes)
        file.attrs["content_digest"] = _digest(attributes, arrays)
    return sealed(buffer.getvalue())


class Saved(Protocol):
    """What every kind of table has."""

    @property
    def values(self) -> FloatArray:
        """Node values."""

    @property
    def accuracy(self) -> Any:
        """Measured errors, or None."""

    @property
    def passport(self) -> dict[str, Any]:
        """What the file says of itself."""


AnySaved = TypeVar("AnySaved", bound=Saved)


def save(
    table: AnySaved,
    kind: type[AnySaved],
    path: str | Path,
    overwrite: bool,
    content_of: Callable[[AnySaved], bytes],
    table_of: Callable[[bytes, str], AnySaved],
) -> AnySaved:
    """Write a table to its file, read it back, and only then give it its name.

    Parameters
    ----------
    table : of class ``kind``, with a measured accuracy
    path, overwrite : as in :func:`puck_tables.save_table`
    content_of, table_of : how this kind of table becomes bytes, and back

    Returns
    -------
    The table as loaded from what was written.

    Raises
    ------
    InputError
        If it is of another class.
    OutputError
        If it has no measured accuracy or a non-finite value, or cannot be written.
    TableError
        If what was written does not read back as the same table.
    """
    instance("table", table, kind)
    if table.accuracy is None or not np.all(np.isfinite(table.values)):
        raise OutputError(
            "a table without measured accuracy or with a non-finite value is not saved"
        )
    content = content_of(table)
    written = table_of(content, str(path))
    if not np.array_equal(written.values, table.values):
        raise TableError(f"{path}: the table does not read back as it was written")
    write_bytes(path, content, overwrite)
    return written


def function_fields(
    names: Sequence[str], table: Saved, long_names: Mapping[str, str] | None = None
) -> list[Field]:
    """The functions of a table, the last axis of its values, with the error of each.

    Examples
    --------
    >>> from puck_tables import load_table
    >>> [field.name for field in function_fields(("parallel", "perpendicular"), load_table())]
    ['parallel', 'perpendicular']
    """
    fields = []
    for index, name in enumerate(names):
        attributes = {"units": "1", "max_error": table.accuracy.largest[index]}
        if long_names is not None:
            attributes["long_name"] = long_names[name]
        fields.append(Field(name, table.values[..., index], attributes))
    return fields


def sealed(content: bytes) -> bytes:
    r"""HDF5 content with the line that proves it whole.

    Examples
    --------
    >>> sealed(b"")[:20]
    b'\npuck-tables sha256 '
    """
    return content + _SEAL + hashlib.sha256(content).hexdigest().encode() + b"\n"


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


def read_table(content: bytes, source: str, kinds: Mapping[str, Kind]) -> Any:
    """The table in the bytes of a file, of one of these kinds.

    Raises
    ------
    TableError
        If they are not a table, of another kind or a newer format, altered, or none that this
        program can use.

    Examples
    --------
    >>> read_table(b"puck", "my.h5", {})
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


def _read(content: bytes, source: str, kinds: Mapping[str, Kind]) -> Any:
    file = PlainFile(content)
    attributes: dict[str, Any] = dict(file.attributes)
    if attributes.get("format") != FORMAT:
        raise TableError(f"{source} is an HDF5 file but not a table of this program")
    major = str(attributes.get("format_version")).split(".")[0]
    if major.isdecimal() and int(major) > int(FORMAT_VERSION.split(".")[0]):
        raise TableError(
            f"{source} has table format {attributes['format_version']}, newer than "
            f"{FORMAT_VERSION} of this program: update puck-tables"
        )
    name = str(attributes.get("kind"))
    if name not in kinds:
        wanted = " or ".join(f"'{kind}'" for kind in kinds)
        raise TableError(
            f"{source} holds '{name}', not a table of {wanted}: "
            "give a file made by 'puck build-tables'"
        )
    kind = kinds[name]
    for entry, type_ in {**_ENTRIES, **kind.entries}.items():
        found = attributes.get(entry)
        if type(found) is not type_ or (isinstance(found, float) and not math.isfinite(found)):
            raise ValueError(f"its entry {entry} is missing or no {_WORDS[type_]}")
    shapes = kind.shapes(attributes)
    if 8 * sum(map(math.prod, shapes.values())) > len(content):
        raise ValueError("it is shorter than its arrays")
    arrays = {array: file.array(array, shape) for array, shape in shapes.items()}
    stated = attributes.pop("content_digest")
    if _digest(attributes, arrays) != stated:
        raise TableError(
            f"{source} was altered or damaged: its content does not match its digest; "
            "build it again with 'puck build-tables'"
        )
    return kind.table_of(Contents({**attributes, "content_digest": stated}, arrays), source)


def _digest(attributes: dict[str, Any], arrays: dict[str, FloatArray]) -> str:
    digest = hashlib.sha256(json.dumps(attributes, sort_keys=True).encode())
    for array in arrays.values():
        digest.update(json.dumps(array.shape).encode())
        digest.update(np.ascontiguousarray(array, dtype="<f8").tobytes())
    return digest.hexdigest()

"""Table files of friction that depends on the slip speed: the same container, another kind.

Axes ``phi`` and ``fastest`` (v + r|ω|); functions ``parallel``, ``perpendicular``, ``spin``, with f
inside.  The friction law is kept in the file, so that the table can be judged from it alone.
"""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from puck_tables.contact.speed_law import SpeedLaw
from puck_tables.errors import OutputError, TableError
from puck_tables.real import instance
from puck_tables.table.container import (
    Contents,
    Field,
    Kind,
    encode,
    function_fields,
    read_content,
    read_table,
    save,
)
from puck_tables.table.grid import GRADING_POWER, PhiAxis
from puck_tables.table.oddities import odd_nodes
from puck_tables.table.speed_check import node_errors
from puck_tables.table.speed_grid import SpeedAxis
from puck_tables.table.speed_table import SpeedAccuracy, SpeedTable
from puck_tables.table.table import FUNCTIONS
from puck_tables.table.usable import accuracy_of, check_usable, refuse_wrong

MAX_POINTS = 2000  # HDF5 keeps no longer attribute
KIND = "friction with f(slip speed)"
ALGORITHM = "one integral over circles about the centre of rotation; splined on both sides; 1"

_INTERPRETATION = (
    "Friction on a puck of radius r, height h, mass m sliding with speed v and spin omega on a "
    "rough plane whose coefficient f depends on the local slip speed by the law in law_speeds, "
    "law_values, law_kind; weight N = m g, uniform pressure tilted linearly by the moment balance. "
    "phi = atan2(r omega, v). Force on the puck: -N cos(phi) parallel along its velocity, "
    "-N sin(phi) cos(phi) perpendicular across it (to the left), torque -(N r/2) sin(phi) spin "
    "about the vertical. Even in phi. Salnikova, Treschev, Gallyamov 2012, section 5, with f "
    "inside the integrals."
)
_PHI_MAP = (
    f"tan(phi - pi/4) = sign(xi) abs(xi)^{GRADING_POWER}, xi = (i - n)/n, i = 0 ... 2n; cubic "
    "splines in xi on each side, zero slope at pi/4, not-a-knot at 0 and pi/2"
)
_LARGEST = 1e3  # of a value over the largest f
# how many nodes are compared with the law as a file is read, and how well that is known
_NODES, _NODE_ERROR = 20, 1e-9
_SPEED_MAP = (
    "fastest = scale sinh(j/cells asinh(top/scale)), j = 0 ... cells; cubic spline in j with "
    "not-a-knot ends"
)


def save_speed_table(
    table: SpeedTable, path: str | Path, overwrite: bool = False, command: str = "library call"
) -> SpeedTable:
    """Write a table to an HDF5 file, read it back, and only then give it its name.

    Parameters
    ----------
    table : SpeedTable
        Of a :class:`puck_tables.SpeedLaw`, with a measured accuracy.
    path : path of the file
    overwrite : whether an existing file may be replaced
    command : how it was made, for the record

    Returns
    -------
    SpeedTable
        As loaded from what was written.

    Raises
    ------
    OutputError
        If its law is a function, which no file can hold, or has more than 2000 points; if the file
        exists (without ``overwrite``) or cannot be written.
    TableError
        If what was written does not read back as the same table.

    Examples
    --------
    >>> import tempfile
    >>> from puck_tables.table.speed_table import build_speed_table
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     table = build_speed_table(SpeedLaw([0.0, 1.0], [0.2, 0.3]), accuracy=1e-4)
    ...     saved = save_speed_table(table, folder + "/speed.h5")
    >>> float(saved.law(0.5))
    0.25
    """
    instance("table", table, SpeedTable)
    if table.law is None:
        raise OutputError(
            "the friction law of this table is a function, which a file cannot hold: give the law "
            "as a SpeedLaw of points"
        )
    if np.size(table.law.speeds) > MAX_POINTS:
        raise OutputError(
            f"the friction law has {np.size(table.law.speeds)} points: a file holds {MAX_POINTS}; "
            "give it with fewer"
        )
    return save(
        table, SpeedTable, path, overwrite, lambda chosen: _encode(chosen, command), _decode
    )


def load_speed_table(path: str | Path) -> SpeedTable:
    """Read a table of friction that depends on the slip speed.

    Parameters
    ----------
    path : path of an HDF5 table file

    Returns
    -------
    SpeedTable

    Raises
    ------
    TableError
        As :func:`puck_tables.load_table`.

    Examples
    --------
    >>> load_speed_table("/nowhere/table.h5")
    Traceback (most recent call last):
    ...
    puck_tables.errors.TableError: there is no table file /nowhere/table.h5: build one with \
'puck build-tables -o FILE', or leave --table out to use the tables that come along
    """
    return _decode(read_content(path), str(path))


def _recipe(
    law: SpeedLaw, phi_axis: PhiAxis, speed_axis: SpeedAxis, height_ratio: float
) -> dict[str, Any]:
    """What determines the values of a table."""
    return {
        "kind": KIND, "pressure_law": "uniform", "law_kind": law.kind,
        "law_speeds": json.dumps(np.asarray(law.speeds).tolist()),
        "law_values": json.dumps(np.asarray(law.values).tolist()),
        "phi_map": _PHI_MAP, "speed_map": _SPEED_MAP, "n_phi": phi_axis.size,
        "cells": speed_axis.cells, "top": speed_axis.top, "scale": speed_axis.scale,
        "height_ratio": height_ratio, "algorithm": ALGORITHM,
    }  # fmt: skip


def _encode(table: SpeedTable, command: str) -> bytes:
    assert table.accuracy is not None and table.law is not None
    described = {
        "title": "Friction of a sliding, spinning puck whose coefficient depends on the slip speed",
        "interpretation": _INTERPRETATION,
        "valid_range": f"|phi| <= pi/2, 0 <= v + r|omega| <= {table.speed_axis.top:g} m/s at "
        f"2h/r = {table.height_ratio:g}; refused outside",
        "tolerance": table.tolerance,
        "largest_f": table.largest_f,
        "achieved_accuracy": json.dumps(asdict(table.accuracy)),
        "method": "quadrature over circles about the centre of rotation, 1e-13",
    }
    nodes = _nodes(table.phi_axis, table.speed_axis)
    axes = [
        Field("phi", nodes["phi"], {"units": "rad", "long_name": "slip angle atan2(r omega, v)"}),
        Field("fastest", nodes["fastest"], {"units": "m/s", "long_name": "fastest slip v + r|w|"}),
    ]
    recipe = _recipe(table.law, table.phi_axis, table.speed_axis, table.height_ratio)
    return encode(recipe, described, axes, function_fields(FUNCTIONS, table), command)


def _nodes(phi_axis: PhiAxis, speed_axis: SpeedAxis) -> dict[str, npt.NDArray[np.float64]]:
    return {"phi": phi_axis.nodes(), "fastest": speed_axis.nodes()}


def _axes(attributes: dict[str, Any]) -> tuple[PhiAxis, SpeedAxis]:
    speeds = SpeedAxis(attributes["cells"], attributes["top"], attributes["scale"])
    return PhiAxis(attributes["n_phi"]), speeds


def shapes(attributes: dict[str, Any]) -> dict[str, tuple[int, ...]]:
    """Shapes of the arrays of a file with these attributes.

    Examples
    --------
    >>> shapes({"n_phi": 9, "cells": 4, "top": 1.0, "scale": 1.0})["spin"]
    (9, 5)
    """
    phi_axis, speed_axis = _axes(attributes)
    shape = (phi_axis.size, speed_axis.cells + 1)
    return {"phi": shape[:1], "fastest": shape[1:], **dict.fromkeys(FUNCTIONS, shape)}


def _decode(content: bytes, source: str) -> SpeedTable:
    table: SpeedTable = read_table(content, source, {KIND: STORED})
    return table


def table_of(contents: Contents, source: str) -> SpeedTable:
    """The table that stands in a file.

    Raises
    ------
    TableError
        If this program cannot use it.
    """
    attributes = contents.attributes
    axes, height_ratio = _axes(attributes), attributes["height_ratio"]
    speeds, values = (json.loads(attributes[name]) for name in ("law_speeds", "law_values"))
    law = SpeedLaw(speeds, values, attributes["law_kind"])
    recipe = _recipe(law, *axes, height_ratio)
    unit = attributes["largest_f"] or 1.0
    check_usable(contents, source, recipe, _nodes(*axes), (-_LARGEST * unit, _LARGEST * unit), 0.0)
    table = SpeedTable(
        *axes,
        height_ratio,
        np.stack([contents.arrays[name] for name in FUNCTIONS], axis=-1),
        attributes["largest_f"],
        law,
        tolerance=attributes["tolerance"],
        accuracy=accuracy_of(attributes, SpeedAccuracy, len(FUNCTIONS)),
        passport=attributes,
        source=source,
    )
    _check_some(table)
    return table


def _check_some(table: SpeedTable) -> None:
    """Refuse a table that is not of its law, as far as some nodes tell."""
    assert table.law is not None
    speeds = table.speed_axis.nodes()
    largest = float(np.max(table.law(speeds)))
    if abs(table.largest_f - largest) > _NODE_ERROR * largest:
        raise TableError(
            f"{table.source} says that f is {table.largest_f:g} at most, by its law it is "
            f"{largest:g}: it was altered"
        )
    rng = np.random.default_rng()
    rows, columns = table.values.shape[:2]
    odd = odd_nodes(table.values, (0, 1), _NODES)
    row = np.concatenate([odd[:, 0], rng.integers(0, rows, _NODES)])
    column = np.concatenate([odd[:, 1], rng.integers(0, columns, _NODES)])
    error = node_errors(table, row, column)
    refuse_wrong(table.source, error, _NODE_ERROR, "the friction law")


STORED = Kind(
    {"law_kind": str, "law_speeds": str, "law_values": str, "speed_map": str, "n_phi": int,
     "cells": int, "top": float, "scale": float, "height_ratio": float, "largest_f": float},
    shapes, table_of,
)  # fmt: skip

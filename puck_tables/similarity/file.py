"""Table files of stops, beside those of resultants: the same container, another kind.

Axes ``phi`` and ``delta``; functions as in :class:`puck_tables.similarity.stop_table.StopTable`.
"""

from __future__ import annotations

import json
from dataclasses import asdict
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np

from puck_tables.similarity.axes import HEIGHTS, SlipAxis, heights
from puck_tables.similarity.exact import end_values
from puck_tables.similarity.node_equations import (
    missed_by_curve,
    missed_by_stops,
    slopes_off_the_limit,
)
from puck_tables.similarity.stop_table import FUNCTIONS, UPPER_DELTA, StopAccuracy, StopTable
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
from puck_tables.table.usable import accuracy_of, check_usable, refuse_wrong

KIND = "stops"
ALGORITHM = "Dormand-Prince with closed forms at 2e-14, curve by Gauss quadrature; 1"

_INTERPRETATION = (
    "Where and when a uniform cylinder (radius r, height h) launched with speed v and spin omega "
    "on a rough plane stops, whole base loaded. Q = hypot(v, r omega), "
    "phi = atan2(r omega, v) >= 0, delta = 2 f h / r, J = f g. "
    "Stop time = (Q/J) time. Displacement along the launch velocity = "
    "(Q^2/J) cos(phi) along, to its left = (Q^2/J) delta sin(phi) cos(phi) across. Path length = "
    "(Q^2/J) cos(phi) length, body angle = (Q^2/(J r)) sin(phi) body. For omega < 0 the mirror "
    "image. Along a motion, with c = (r omega - v)/(r omega + v) and c0 its limit, ln Q = "
    "(ln|c - c0| + curve)/kappa - ln(1 + c)/A - ln(1 - c)/B and heading = h0 ln Q "
    "+ (h0/A) ln(1 + c) + ((h0 - h1)/B) ln(1 - c) + delta turn, up to constants; "
    "A = 1/2 + delta^2/8, B = (9 + 4 delta^2)/(36 + 4 delta^2), h1 = 9 delta/(36 + 4 delta^2), "
    "kappa = d ln|c - c0|/d ln Q and h0 = d heading/d ln Q at c0. "
    "Salnikova, Treschev, Gallyamov 2012, eq. 6.2-6.7 and section 7."
)
_PHI_MAP = (
    "tan(phi) below pi/4, cot(phi) above = q^4/(2 - q^4), q = xi (2 - xi), xi = i/cells from "
    "either end; cubic splines with zero end slopes in xi on either side of pi/4"
)
_DELTA_MAP = (
    "delta = sin(pi (2 j + 1)/(4 n_delta)); polynomial in delta^2, degree 7 for stops, "
    "8 for the curve"
)
_LARGEST, _NODE_ERROR = 10.0, 1e-12  # of a value, and how well some are known
_LONG_NAMES = {
    "time": "stop time J t/Q",
    "along": "displacement along the launch velocity J x/(Q^2 cos(phi))",
    "across": "displacement to its left J y/(Q^2 delta sin(phi) cos(phi))",
    "length": "path length J l/(Q^2 cos(phi))",
    "body": "body angle J r theta/(Q^2 sin(phi))",
    "curve": "regular part of ln Q along a motion, times kappa",
    "turn": "regular part of the heading along a motion, over delta",
}


def save_stop_table(
    table: StopTable, path: str | Path, overwrite: bool = False, command: str = "library call"
) -> StopTable:
    """Write a stop table to an HDF5 file, read it back, and only then give it its name.

    Parameters
    ----------
    table : StopTable
        With a measured accuracy, as :func:`puck_tables.build_stop_table` returns it.
    path : path of the file
    overwrite : whether an existing file may be replaced
    command : how it was made, for the record

    Returns
    -------
    StopTable
        As loaded from what was written.

    Raises
    ------
    OutputError
        If the file exists (without ``overwrite``) or cannot be written.
    TableError
        If what was written does not read back as the same table.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     saved = save_stop_table(load_stop_table(), folder + "/copy.h5")
    >>> saved.passport["kind"]
    'stops'
    """
    return save(table, StopTable, path, overwrite, lambda chosen: _encode(chosen, command), _decode)


def load_stop_table(path: str | Path | None = None) -> StopTable:
    """Read a stop table from its file, or the default one that comes with the package.

    Parameters
    ----------
    path : path of an HDF5 table file, optional

    Returns
    -------
    StopTable

    Raises
    ------
    TableError
        As :func:`puck_tables.load_table`.

    Examples
    --------
    >>> load_stop_table().tolerance
    1e-10
    """
    if path is None:
        return _default_table()
    return _decode(read_content(path), str(path))


@cache
def _default_table() -> StopTable:
    content = files("puck_tables.tables").joinpath("stops.h5").read_bytes()
    return _decode(content, "default stop table")


def _decode(content: bytes, source: str) -> StopTable:
    table: StopTable = read_table(content, source, {KIND: STORED})
    return table


def _recipe(axis: SlipAxis) -> dict[str, Any]:
    """What determines the values of a stop table."""
    return {
        "kind": KIND, "pressure_law": "uniform", "phi_map": _PHI_MAP, "delta_map": _DELTA_MAP,
        "cells": axis.cells, "n_delta": HEIGHTS, "delta_max": UPPER_DELTA, "algorithm": ALGORITHM,
    }  # fmt: skip


def shapes(attributes: dict[str, Any]) -> dict[str, tuple[int, ...]]:
    """Shapes of the arrays of a file with these attributes.

    Examples
    --------
    >>> shapes({"cells": 8})["time"]
    (17, 9)
    """
    shape = (SlipAxis(attributes["cells"]).size, HEIGHTS)
    return {"phi": shape[:1], "delta": shape[1:], **dict.fromkeys(FUNCTIONS, shape)}


def _encode(table: StopTable, command: str) -> bytes:
    assert table.accuracy is not None
    described = {
        "title": "Stops of a sliding, spinning puck",
        "interpretation": _INTERPRETATION,
        "valid_range": f"|phi| <= pi/2, 0 <= delta <= {UPPER_DELTA:g}; refused outside",
        "tolerance": table.tolerance,
        "achieved_accuracy": json.dumps(asdict(table.accuracy)),
        "method": "stops integrated with closed forms to 1e-15, curve by quadrature to 1e-14",
    }
    axes = [
        Field(
            "phi", table.axis.phi(), {"units": "rad", "long_name": "slip angle atan2(r omega, v)"}
        ),
        Field("delta", heights(), {"units": "1", "long_name": "dimensionless height 2 f h / r"}),
    ]
    return encode(
        _recipe(table.axis),
        described,
        axes,
        function_fields(FUNCTIONS, table, _LONG_NAMES),
        command,
    )


def table_of(contents: Contents, source: str) -> StopTable:
    """The stop table that stands in a file.

    Raises
    ------
    TableError
        If this program cannot use it.
    """
    axis = SlipAxis(contents.attributes["cells"])
    nodes = {"phi": axis.phi(), "delta": heights()}
    check_usable(contents, source, _recipe(axis), nodes, (-_LARGEST, _LARGEST), 0.1 / axis.cells**4)
    table = StopTable(
        axis,
        np.stack([contents.arrays[name] for name in FUNCTIONS], axis=-1),
        tolerance=contents.attributes["tolerance"],
        accuracy=accuracy_of(contents.attributes, StopAccuracy, len(FUNCTIONS)),
        passport=contents.attributes,
        source=source,
    )
    _check_some(table)
    return table


def _check_some(table: StopTable) -> None:
    """Refuse a table with wrong values, as far as the equations between its nodes show them.

    Nothing compiled is called: that would take a second.
    """
    axis, values = table.axis, table.values
    ends = np.abs(values[[0, -1], :, :5] - np.stack(end_values(heights())))
    refuse_wrong(table.source, ends, _NODE_ERROR, "elementary solutions")
    refuse_wrong(table.source, np.abs(values[axis.cells, :, 5:]), _NODE_ERROR, "the curve's origin")
    refuse_wrong(table.source, *missed_by_stops(axis, values), "the equations of motion")
    height = int(np.random.default_rng().integers(HEIGHTS))
    missed = missed_by_curve(axis, values, height, slopes_off_the_limit)
    refuse_wrong(table.source, *missed, "the curve of all motions")


STORED = Kind({"delta_map": str, "cells": int, "n_delta": int, "delta_max": float},
              shapes, table_of)  # fmt: skip

"""Table files of friction resultants.

Axes ``phi`` and ``delta``; functions ``parallel``, ``perpendicular``, ``spin``.  How files are
sealed, checked and refused stands in :mod:`puck_tables.table.container`.
"""

from __future__ import annotations

import json
from dataclasses import asdict
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np

from puck_tables.table.check import by_closed_form
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
from puck_tables.table.grid import GRADING_POWER, DeltaAxis, PhiAxis
from puck_tables.table.oddities import odd_nodes
from puck_tables.table.table import FUNCTIONS, Accuracy, Table
from puck_tables.table.usable import accuracy_of, check_usable, refuse_wrong

KIND = "resultants"
ALGORITHM = "elliptic integrals; friction ratios splined; 1"

_INTERPRETATION = (
    "Friction on a uniform cylinder (radius r, height h, mass m) sliding with speed v and spin "
    "omega on a rough plane, Coulomb coefficient f, weight N = m g, whole base loaded, uniform "
    "pressure tilted linearly by the moment balance. phi = atan2(r omega, v), delta = 2 f h / r. "
    "Force on the puck: -f N cos(phi) parallel along its velocity, "
    "-f N sin(phi) cos(phi) perpendicular across it (to the left), torque -(f N r / 2) sin(phi) "
    "spin about the vertical. Even in phi. Salnikova, Treschev, Gallyamov 2012, section 6."
)
_PHI_MAP = (
    f"tan(phi - pi/4) = sign(xi) |xi|^{GRADING_POWER}, xi = (i - n)/n, i = 0 ... 2n; cubic splines "
    "with zero end slopes in xi on either side of pi/4"
)
_DELTA_MAP = "delta = delta_max j/(n_delta - 1); cubic spline with not-a-knot ends"
_SPLINED = "1/parallel, perpendicular/parallel, spin/parallel"
# how much of a large table is compared with the truth as it is read, and how well that is known
_ROWS, _COLUMNS, _NODE_ERROR = 2001, 8, 1e-12
_LONG_NAMES = {
    "parallel": "friction resultant along the velocity, rho_parallel",
    "perpendicular": "friction resultant across the velocity, rho_perpendicular",
    "spin": "friction torque about the vertical, rho_omega",
}


def save_table(
    table: Table, path: str | Path, overwrite: bool = False, command: str = "library call"
) -> Table:
    """Write a table to an HDF5 file, read it back, and only then give it its name.

    Parameters
    ----------
    table : Table
        With a measured accuracy, as :func:`puck_tables.build_table` returns it.
    path : path of the file
    overwrite : whether an existing file may be replaced
    command : how it was made, for the record

    Returns
    -------
    Table
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
    >>> from puck_tables import build_table
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     saved = save_table(build_table(accuracy=1e-6), folder + "/rough.h5")
    >>> saved.passport["pressure_law"]
    'uniform'
    """
    return save(table, Table, path, overwrite, lambda chosen: _encode(chosen, command), _decode)


def load_table(path: str | Path | None = None) -> Table:
    """Read a table file, or the default table that comes with the package.

    Parameters
    ----------
    path : path of an HDF5 table file, optional

    Returns
    -------
    Table

    Raises
    ------
    TableError
        If the file is missing, not a table, of another kind or a newer format, or altered:
        its digest is checked at every load.

    Examples
    --------
    >>> table = load_table()
    >>> table.phi_axis.size, table.delta_axis.size
    (991, 4)
    """
    if path is None:
        return _default_table()
    return _decode(read_content(path), str(path))


@cache
def _default_table() -> Table:
    content = files("puck_tables.tables").joinpath("resultants.h5").read_bytes()
    return _decode(content, "default table")


def _recipe(phi_axis: PhiAxis, delta_axis: DeltaAxis) -> dict[str, Any]:
    """What determines the values of a table."""
    return {
        "kind": KIND, "pressure_law": "uniform", "phi_map": _PHI_MAP, "delta_map": _DELTA_MAP,
        "splined": _SPLINED, "n_phi": phi_axis.size, "n_delta": delta_axis.size,
        "delta_max": 1.0, "algorithm": ALGORITHM,
    }  # fmt: skip


def _encode(table: Table, command: str) -> bytes:
    assert table.accuracy is not None
    described = {
        "title": "Friction resultants of a sliding, spinning puck",
        "interpretation": _INTERPRETATION,
        "valid_range": f"|phi| <= pi/2, 0 <= delta <= {table.delta_axis.upper:g}; refused outside",
        "tolerance": table.tolerance,
        "achieved_accuracy": json.dumps(asdict(table.accuracy)),
        "method": "closed forms (complete elliptic integrals by the AGM), 2e-15",
    }
    axes = [
        Field(
            "phi",
            table.phi_axis.nodes(),
            {"units": "rad", "long_name": "slip angle atan2(r omega, v)"},
        ),
        Field(
            "delta",
            table.delta_axis.nodes(),
            {"units": "1", "long_name": "dimensionless height 2 f h / r"},
        ),
    ]
    return encode(
        _recipe(table.phi_axis, table.delta_axis),
        described,
        axes,
        function_fields(FUNCTIONS, table, _LONG_NAMES),
        command,
    )


def _decode(content: bytes, source: str) -> Table:
    table: Table = read_table(content, source, {KIND: STORED})
    return table


def shapes(attributes: dict[str, Any]) -> dict[str, tuple[int, ...]]:
    """Shapes of the arrays of a file with these attributes.

    Examples
    --------
    >>> shapes({"n_phi": 9, "n_delta": 4, "delta_max": 1.0})["spin"]
    (9, 4)
    """
    phi_axis, delta_axis = _axes(attributes)
    shape = (phi_axis.size, delta_axis.size)
    return {"phi": shape[:1], "delta": shape[1:], **dict.fromkeys(FUNCTIONS, shape)}


def _axes(attributes: dict[str, Any]) -> tuple[PhiAxis, DeltaAxis]:
    return PhiAxis(attributes["n_phi"]), DeltaAxis(attributes["n_delta"], attributes["delta_max"])


def table_of(contents: Contents, source: str) -> Table:
    """The table that stands in a file.

    Raises
    ------
    TableError
        If this program cannot use it.
    """
    phi_axis, delta_axis = _axes(contents.attributes)
    nodes = {"phi": phi_axis.nodes(), "delta": delta_axis.nodes()}
    check_usable(contents, source, _recipe(phi_axis, delta_axis), nodes, (0.0, 2.0),
                 0.25 / phi_axis.cells_per_side**4)  # fmt: skip
    table = Table(
        phi_axis,
        delta_axis,
        np.stack([contents.arrays[name] for name in FUNCTIONS], axis=-1),
        tolerance=contents.attributes["tolerance"],
        accuracy=accuracy_of(contents.attributes, Accuracy, len(FUNCTIONS)),
        passport=contents.attributes,
        source=source,
    )
    _check_some(table)
    return table


def _check_some(table: Table) -> None:
    """Refuse a table with wrong values, as far as a millisecond of closed forms finds them."""
    rows = np.arange(table.phi_axis.size)
    if rows.size > _ROWS:
        odd = odd_nodes(table.values[:, [0, -1]], (0,), _ROWS)[:, 0]
        rows = np.unique(np.concatenate([[0, rows.size // 2, rows.size - 1], odd,
                                         np.random.default_rng().choice(rows, 500)]))  # fmt: skip
    columns = np.arange(table.delta_axis.size)
    if columns.size > _COLUMNS:
        columns = np.random.default_rng().choice(columns, _COLUMNS)
    phi, delta = table.phi_axis.nodes()[rows, None], table.delta_axis.nodes()[columns]
    truth = np.stack(by_closed_form(phi, delta), axis=-1)
    error = np.abs(table.values[rows[:, None], columns] - truth)
    refuse_wrong(table.source, error, _NODE_ERROR, "the closed forms")


STORED = Kind({"delta_map": str, "splined": str, "n_phi": int, "n_delta": int, "delta_max": float},
              shapes, table_of)  # fmt: skip

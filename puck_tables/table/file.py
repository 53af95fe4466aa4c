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

from puck_tables.table.container import (
    Contents,
    Field,
    accuracy_of,
    check_usable,
    decode,
    encode,
    function_fields,
    read_content,
    save,
)
from puck_tables.table.grid import GRADING_POWER, DeltaAxis, PhiAxis
from puck_tables.table.table import FUNCTIONS, Accuracy, Table

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
    return table_of(decode(content, source, {KIND: shapes}), source)


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
    check_usable(contents, source, _recipe(phi_axis, delta_axis), nodes, positive="parallel")
    return Table(
        phi_axis,
        delta_axis,
        np.stack([contents.arrays[name] for name in FUNCTIONS], axis=-1),
        tolerance=contents.attributes["tolerance"],
        accuracy=Accuracy(**accuracy_of(contents.attributes)),
        passport=contents.attributes,
        source=source,
    )

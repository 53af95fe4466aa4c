"""Table files of partial contact: the same container as for full contact, another kind.

Axes ``phi`` and ``zeta``; functions ``parallel``, ``perpendicular``, ``spin``.
"""

from __future__ import annotations

import json
from dataclasses import asdict
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np

from puck_tables.contact import closed_form
from puck_tables.contact.integrals import slip_direction
from puck_tables.contact.one_sided import balance
from puck_tables.contact.opening import critical_delta
from puck_tables.contact.resultants import moment_balance
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
from puck_tables.table.oddities import odd_nodes
from puck_tables.table.partial_grid import FAST_END, TOP_DELTA, UPPER_DELTA, ZETA_END, PartialAxes
from puck_tables.table.partial_table import PartialTable
from puck_tables.table.table import FUNCTIONS, Accuracy
from puck_tables.table.usable import accuracy_of, check_usable, refuse_wrong

KIND = "partial contact"
ALGORITHM = "one-sided balance by quadrature; excess over full contact splined; 1"

_INTERPRETATION = (
    "Friction on a uniform cylinder (radius r, height h, mass m) sliding with speed v and spin "
    "omega on a rough plane, Coulomb coefficient f, weight N = m g, part of the base lifted: "
    "pressure max(0, a + b x + c y), a, b, c from the balance of force and moments. "
    "phi = atan2(r omega, v), delta = 2 f h / r. "
    "Force on the puck: -f N cos(phi) parallel along its velocity, "
    "-f N sin(phi) cos(phi) perpendicular across it (to the left), torque -(f N r / 2) sin(phi) "
    "spin about the vertical. Even in phi. Full contact at every phi beyond the last, and below "
    "delta_c(phi): the root of (1 - delta^2 sin^2(phi) p_b p_c)^2 = delta^2 cos^2(phi) p_a^2 "
    "(1 + delta^2 sin^2(phi) p_b^2) with the integrals p of Salnikova, Treschev, Gallyamov 2012, "
    "eq. 4.3-4.5; delta_c(0) = 1, delta_c(pi/4) = 1.1591385."
)
_PHI_MAP = (
    f"tan(phi - pi/4) = -xi^4 below pi/4, {FAST_END:g} xi^4 above, xi = i/cells from pi/4; cubic "
    "splines in xi on either side with zero slope at pi/4 and at phi = 0, not-a-knot at the end"
)
_DELTA_MAP = (
    f"delta = top - (top - delta_c) exp(-zeta^2), top = {TOP_DELTA:g} max(1, delta_c(phi)/"
    f"delta_c(pi/4)), zeta = {ZETA_END:.15f} j/cells; cubic spline with "
    "zero slope at zeta = 0, not-a-knot at the end"
)
_SPLINED = "parallel, perpendicular, spin less their values in full contact at the same place"
# how many balances are solved as a file is read, and how well they are known
_NODES, _NODE_ERROR = 4, 1e-10
_LONG_NAMES = {
    "parallel": "friction resultant along the velocity, rho_parallel",
    "perpendicular": "friction resultant across the velocity, rho_perpendicular",
    "spin": "friction torque about the vertical, rho_omega",
}


def save_partial_table(
    table: PartialTable, path: str | Path, overwrite: bool = False, command: str = "library call"
) -> PartialTable:
    """Write a table to an HDF5 file, read it back, and only then give it its name.

    Parameters
    ----------
    table : PartialTable
        With a measured accuracy, as :func:`puck_tables.table.partial_build.build_partial_table`
        returns it.
    path : path of the file
    overwrite : whether an existing file may be replaced
    command : how it was made, for the record

    Returns
    -------
    PartialTable
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
    ...     saved = save_partial_table(load_partial_table(), folder + "/copy.h5")
    >>> saved.passport["kind"]
    'partial contact'
    """
    return save(
        table, PartialTable, path, overwrite, lambda chosen: _encode(chosen, command), _decode
    )


def load_partial_table(path: str | Path | None = None) -> PartialTable:
    """Read a table of partial contact, or the default one that comes with the package.

    Parameters
    ----------
    path : path of an HDF5 table file, optional

    Returns
    -------
    PartialTable

    Raises
    ------
    TableError
        As :func:`puck_tables.load_table`.

    Examples
    --------
    >>> load_partial_table().tolerance
    1e-06
    """
    if path is None:
        return _default_table()
    return _decode(read_content(path), str(path))


@cache
def _default_table() -> PartialTable:
    content = files("puck_tables.tables").joinpath("partial.h5").read_bytes()
    return _decode(content, "default table of partial contact")


def _recipe(axes: PartialAxes) -> dict[str, Any]:
    """What determines the values of a table."""
    return {
        "kind": KIND, "pressure_law": "uniform", "phi_map": _PHI_MAP, "delta_map": _DELTA_MAP,
        "splined": _SPLINED, "cells": axes.cells, "delta_max": UPPER_DELTA,
        "algorithm": ALGORITHM,
    }  # fmt: skip


def _encode(table: PartialTable, command: str) -> bytes:
    assert table.accuracy is not None
    described = {
        "title": "Friction resultants of a sliding, spinning puck in partial contact",
        "interpretation": _INTERPRETATION,
        "valid_range": f"|phi| <= pi/2, delta_c(phi) <= delta <= {UPPER_DELTA:g}; refused above",
        "tolerance": table.tolerance,
        "achieved_accuracy": json.dumps(asdict(table.accuracy)),
        "method": "Newton on the balance of moments, tanh-sinh and Gauss quadrature, 1e-13",
    }
    slip = {"units": "rad", "long_name": "slip angle atan2(r omega, v)"}
    axes = [
        Field("phi", table.axes.phi(), slip),
        Field("zeta", table.axes.zeta(), {"units": "1", "long_name": "place between the heights"}),
    ]
    return encode(
        _recipe(table.axes),
        described,
        axes,
        function_fields(FUNCTIONS, table, _LONG_NAMES),
        command,
    )


def _decode(content: bytes, source: str) -> PartialTable:
    table: PartialTable = read_table(content, source, {KIND: STORED})
    return table


def shapes(attributes: dict[str, Any]) -> dict[str, tuple[int, ...]]:
    """Shapes of the arrays of a file with these attributes.

    Examples
    --------
    >>> shapes({"cells": 8})["spin"]
    (17, 9)
    """
    shape = PartialAxes(attributes["cells"]).shape
    return {"phi": shape[:1], "zeta": shape[1:], **dict.fromkeys(FUNCTIONS, shape)}


def table_of(contents: Contents, source: str) -> PartialTable:
    """The table that stands in a file.

    Raises
    ------
    TableError
        If this program cannot use it.
    """
    axes = PartialAxes(contents.attributes["cells"])
    nodes = {"phi": axes.phi(), "zeta": axes.zeta()}
    check_usable(contents, source, _recipe(axes), nodes, (0.0, 10.0), 50.0 / axes.cells**4)
    table = PartialTable(
        axes,
        np.stack([contents.arrays[name] for name in FUNCTIONS], axis=-1),
        tolerance=contents.attributes["tolerance"],
        accuracy=accuracy_of(contents.attributes, Accuracy, len(FUNCTIONS)),
        passport=contents.attributes,
        source=source,
    )
    _check_some(table)
    return table


def _check_some(table: PartialTable) -> None:
    """Refuse a table with wrong values, as far as a few balances of moments find them."""
    rng = np.random.default_rng()
    rows, columns = table.axes.shape
    # at the opening itself, ζ = 0, the balance is that of full contact
    odd = odd_nodes(table.values[:, 1:], (1, 0), _NODES) + np.array([0, 1])
    row = np.concatenate([odd[:, 0], rng.integers(0, rows, _NODES)])
    column = np.concatenate([odd[:, 1], rng.integers(1, columns, _NODES)])
    phi, delta = table.axes.phi()[row], table.axes.delta()[row, column]
    truth = np.stack(balance(phi, delta)[0], axis=-1)
    error = np.abs(table.values[row, column] - truth)
    refuse_wrong(table.source, error, _NODE_ERROR, "the balance of moments")
    phi = table.axes.phi()
    full = moment_balance(closed_form.integrals(phi), slip_direction(phi), critical_delta(phi))
    error = np.abs(table.values[:, 0] - np.stack(full, axis=-1))
    refuse_wrong(table.source, error, _NODE_ERROR, "the closed forms where contact opens")


STORED = Kind({"delta_map": str, "splined": str, "cells": int, "delta_max": float},
              shapes, table_of)  # fmt: skip

"""Table files under any pressure law: the same container, another kind.

Axes ``side`` (regions between the singular lines), ``xi`` (place in the region) and ``delta``;
functions ``parallel``, ``perpendicular``, ``spin``.  A tabulated law is there too, since format 2:
``profile_pressure`` over ``profile_radius``.
"""

from __future__ import annotations

import hashlib
import json
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from puck_tables.contact.laws import law_of
from puck_tables.errors import InputError, TableError
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
from puck_tables.table.grid import GRADING_POWER
from puck_tables.table.law_grid import LawAxis
from puck_tables.table.law_table import HEIGHTS, FloatArray, LawTable
from puck_tables.table.oddities import odd_nodes
from puck_tables.table.table import FUNCTIONS, Accuracy
from puck_tables.table.usable import accuracy_of, check_usable, refuse_wrong

_RADIUS, _PRESSURE = "profile_radius", "profile_pressure"

KIND = "resultants under a pressure law"
ALGORITHM = "integrals of the law; friction ratios splined on its regions; 1"

_INTERPRETATION = (
    "Friction on a puck of radius r, height h, mass m sliding with speed v and spin omega on a "
    "rough plane, Coulomb coefficient f, weight N = m g, whole base loaded by the named pressure "
    "law, tilted linearly by the moment balance. phi = atan2(r omega, v), delta = 2 f h / r. "
    "Force on the puck: -f N cos(phi) parallel along its velocity, "
    "-f N sin(phi) cos(phi) perpendicular across it (to the left), torque -(f N r / 2) sin(phi) "
    "spin about the vertical. Even in phi. Salnikova, Treschev, Gallyamov 2012, sections 3 and 6."
)
_PHI_MAP = (
    "sides in the order of phi, two for each edge: phi_e = atan(1/edge), tan(phi - phi_e) = "
    f"extent xi^{GRADING_POWER}, xi = 1 at phi = 0, pi/2 or half way to the next line; cubic "
    "splines in xi with zero slope at xi = 0 and at phi = 0 and pi/2, else not-a-knot"
)
_LARGEST = 1e3  # of a resultant: 64 stands in an extreme profile
# how many slip angles are compared with the law as a file is read, and how well that is known
_NODES, _NODE_ERROR, _SAME = 30, 1e-10, 1e-10
_DELTA_MAP = "delta = delta_max j/3; cubic spline with not-a-knot ends"
_SPLINED = "1/parallel, perpendicular/parallel, spin/parallel"


def save_law_table(
    table: LawTable, path: str | Path, overwrite: bool = False, command: str = "library call"
) -> LawTable:
    """Write a table to an HDF5 file, read it back, and only then give it its name.

    Parameters
    ----------
    table : LawTable
        With a measured accuracy.
    path : path of the file
    overwrite : whether an existing file may be replaced
    command : how it was made, for the record

    Returns
    -------
    LawTable
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
    >>> from puck_tables.contact.laws import law_of
    >>> from puck_tables.table.law_table import build_law_table
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     table = build_law_table(law_of("annulus:0.8"), cells=8)
    ...     saved = save_law_table(table, folder + "/washer.h5")
    >>> saved.passport["pressure_law"]
    'annulus:0.8'
    """
    return save(table, LawTable, path, overwrite, lambda chosen: _encode(chosen, command), _decode)


def load_law_table(path: str | Path) -> LawTable:
    """Read a table under a pressure law.

    Parameters
    ----------
    path : path of an HDF5 table file

    Returns
    -------
    LawTable

    Raises
    ------
    TableError
        As :func:`puck_tables.load_table`.

    Examples
    --------
    >>> load_law_table("/nowhere/table.h5")
    Traceback (most recent call last):
    ...
    puck_tables.errors.TableError: there is no table file /nowhere/table.h5: build one with \
'puck build-tables -o FILE', or leave --table out to use the tables that come along
    """
    return _decode(read_content(path), str(path))


def _recipe(name: str, axis: LawAxis, delta_max: float) -> dict[str, Any]:
    """What determines the values of a table."""
    return {
        "kind": KIND, "pressure_law": name, "edges": json.dumps(axis.edges), "phi_map": _PHI_MAP,
        "delta_map": _DELTA_MAP, "splined": _SPLINED, "cells": axis.cells,
        "delta_max": delta_max, "algorithm": ALGORITHM,
    }  # fmt: skip


def profile_digest(radius: FloatArray, pressure: FloatArray) -> str:
    """Digest of the values of a tabulated law, whatever it is called.

    Examples
    --------
    >>> profile_digest(np.array([0.0, 1.0]), np.array([1.0, 0.5]))[:8]
    'cb1d5201'
    """
    return hashlib.sha256(np.stack([radius, pressure]).astype("<f8").tobytes()).hexdigest()


def _encode(table: LawTable, command: str) -> bytes:
    assert table.accuracy is not None
    described = {
        "title": f"Friction resultants of a sliding, spinning puck, pressure law {table.law_name}",
        "interpretation": _INTERPRETATION,
        "valid_range": f"|phi| <= pi/2, 0 <= delta <= {table.delta_max:g}; refused outside",
        "tolerance": table.tolerance,
        "achieved_accuracy": json.dumps(asdict(table.accuracy)),
        "method": "closed forms and direct quadrature of the law's five integrals, 1e-13",
    }
    axes = [
        Field(name, values, {"units": "1", "long_name": long_name})
        for (name, values), long_name in zip(
            _nodes(table.axis, table.delta_max).items(),
            ("region, in the order of phi", "place in the region", "dimensionless height 2 f h/r"),
            strict=True,
        )
    ]
    recipe = _recipe(table.law_name, table.axis, table.delta_max)
    if table.profile is None:
        return encode(recipe, described, axes, function_fields(FUNCTIONS, table), command)
    radius, pressure = table.profile
    curve = (
        Field(_RADIUS, radius, {"units": "1", "long_name": "radius in units of that of the puck"}),
        Field(_PRESSURE, pressure, {"units": "1", "long_name": "pressure, largest 1"}),
    )
    recipe |= _profile_recipe(table.profile)
    return encode(recipe, described, axes, function_fields(FUNCTIONS, table), command, curve)


def _profile_recipe(profile: tuple[FloatArray, FloatArray] | None) -> dict[str, Any]:
    """What a tabulated law adds to the recipe."""
    if profile is None:
        return {}
    return {"profile_rows": profile[0].size, "profile_digest": profile_digest(*profile)}


def _nodes(axis: LawAxis, delta_max: float) -> dict[str, FloatArray]:
    return {
        "side": np.arange(float(len(axis.sides))),
        "xi": np.arange(axis.cells + 1) / axis.cells,
        "delta": np.linspace(0.0, delta_max, HEIGHTS),
    }


def _axis(attributes: dict[str, Any]) -> LawAxis:
    edges = tuple(float(edge) for edge in json.loads(attributes["edges"]))
    if not (edges and edges[-1] == 1.0 and edges[0] > 0.0 and np.all(np.diff(edges) > 0.0)):
        raise ValueError("edges")
    return LawAxis(edges, attributes["cells"])


def shapes(attributes: dict[str, Any]) -> dict[str, tuple[int, ...]]:
    """Shapes of the arrays of a file with these attributes.

    Examples
    --------
    >>> shapes({"edges": "[0.8, 1.0]", "cells": 8})["spin"]
    (4, 9, 4)
    """
    axis = _axis(attributes)
    shape = (len(axis.sides), axis.cells + 1, HEIGHTS)
    rows = attributes.get("profile_rows", 0)
    if type(rows) is not int or rows < 0:
        raise ValueError("its profile has no number of rows")
    profile = {_RADIUS: (rows,), _PRESSURE: (rows,)} if rows else {}
    return {
        "side": shape[:1], "xi": shape[1:2], "delta": shape[2:],
        **dict.fromkeys(FUNCTIONS, shape), **profile,
    }  # fmt: skip


def _decode(content: bytes, source: str) -> LawTable:
    table: LawTable = read_table(content, source, {KIND: STORED})
    return table


def table_of(contents: Contents, source: str) -> LawTable:
    """The table that stands in a file.

    Raises
    ------
    TableError
        If this program cannot use it.
    """
    attributes = contents.attributes
    axis, delta_max = _axis(attributes), attributes["delta_max"]
    name = attributes["pressure_law"]
    nodes = _nodes(axis, delta_max)
    profile = None
    if _RADIUS in contents.arrays:
        profile = contents.arrays[_RADIUS], contents.arrays[_PRESSURE]
        if _is_named(name):
            raise TableError(f"{source} holds a profile that is not the law it names, {name}")
        nodes |= {_RADIUS: profile[0], _PRESSURE: profile[1]}
    recipe = _recipe(name, axis, delta_max) | _profile_recipe(profile)
    check_usable(contents, source, recipe, nodes, (0.0, _LARGEST), 0.1 / axis.cells**4)
    table = LawTable(
        name,
        axis,
        delta_max,
        np.stack([contents.arrays[name] for name in FUNCTIONS], axis=-1),
        tolerance=attributes["tolerance"],
        accuracy=accuracy_of(attributes, Accuracy, len(FUNCTIONS)),
        passport=attributes,
        source=source,
        profile=profile,
    )
    if profile is not None or _is_named(name):  # else the file is from before format 2
        _check_some(table)
    return table


def _is_named(name: str) -> bool:
    """Whether a law is known by its name."""
    try:
        return not name.lower().endswith(".csv") and law_of(name).name == name
    except InputError:
        return False


def _check_some(table: LawTable) -> None:
    """Refuse a table that is not of its law, as far as some slip angles tell."""
    law = table.law
    if law.edges != table.axis.edges or abs(law.delta_max / table.delta_max - 1.0) > _SAME:
        raise TableError(f"{table.source} is not of the pressure law that it names, {law.name}")
    rng = np.random.default_rng()
    sides, cells = table.values.shape[:2]
    odd = odd_nodes(table.values, (1,), _NODES)
    side = np.concatenate([odd[:, 0], rng.integers(0, sides, _NODES)])
    place = np.concatenate([odd[:, 1], rng.integers(0, cells, _NODES)])
    heights = np.linspace(0.0, table.delta_max, HEIGHTS)
    truth = np.stack(law.resultants(table.axis.phi()[side, place, None], heights), axis=-1)
    error = np.abs(table.values[side, place] - truth)
    refuse_wrong(table.source, error, _NODE_ERROR, f"the law {law.name}")
    parallel = table.values[..., :1]  # in full contact the ratios are polynomials of degree 2 in δ
    ratios = np.concatenate([1.0 / parallel, table.values[..., 1:] / parallel], axis=-1)
    bent = np.abs(np.diff(ratios, 3, axis=2)) / (1.0 + np.abs(ratios).max(axis=2, keepdims=True))
    refuse_wrong(table.source, bent, _NODE_ERROR, "polynomials of the height")


STORED = Kind({"delta_map": str, "splined": str, "edges": str, "cells": int, "delta_max": float},
              shapes, table_of)  # fmt: skip

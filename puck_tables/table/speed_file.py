"""Table files of friction that depends on the slip speed: the same container, another kind.

Functions ``p_a``, ``p_b``, ``p_d``, ``p_e``, with f inside, over the nodes of all patches, and how
often each patch was halved along its two axes.  The friction law is kept in the file, so that the
table can be judged from it alone.
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
from puck_tables.table.speed_build import COARSEST_CELLS, FINEST_ACCURACY, HALVINGS, largest_f
from puck_tables.table.speed_check import node_errors, oddest
from puck_tables.table.speed_grid import patch_count
from puck_tables.table.speed_table import INTEGRALS, SpeedAccuracy, SpeedTable
from puck_tables.table.usable import accuracy_of, check_usable, refuse_wrong

FloatArray = npt.NDArray[np.float64]

MAX_POINTS = 2000  # HDF5 keeps no longer attribute
KIND = "friction with f(slip speed)"
ALGORITHM = "one integral over circles about the centre of rotation; quintic splines in patches; 2"

_INTERPRETATION = (
    "Friction on a puck of radius r, height h, mass m sliding with speed v and spin omega on a "
    "rough plane whose coefficient f depends on the local slip speed u by the law in law_speeds, "
    "law_values, law_kind; weight N = m g, uniform pressure tilted linearly by the moment balance. "
    "phi = atan2(r omega, v), Q = hypot(v, r omega), slip directions (e_x, e_y) in units of r: "
    "cos(phi) p_a = mean of f e_x, sin(phi) p_b = mean of f e_y x, sin(phi) p_d = mean of f (x e_y "
    "- y e_x), cos(phi) p_e = mean of f (x e_y - y e_x) y, p_c = p_b - p_d. With g = 2h/r, D = 1 - "
    "g^2 sin^2(phi) p_b p_c: force -N cos(phi) p_a/D along the velocity, -N sin(phi) cos(phi) g "
    "p_a p_b/D across it (to the left), torque -N r sin(phi) (p_d + g^2 cos^2(phi) p_a p_b p_e/D). "
    "Even in phi. Salnikova, Treschev, Gallyamov 2012, section 5, with f inside the integrals."
)
_MAP = (
    "U = v + r|omega|, W = |v - r|omega||; patches between the breaks b_k of U and W, for r|omega| "
    "< v and then for >, slab of U after slab. U <= b_1: U = b_1 xi, W = U zeta^4. b_k <= U <= "
    "b_k+1: U = b_k + (b_k+1 - b_k) xi^p; W = b_1/2 zeta^4, then W = b_l - (b_l - left end)(1 - "
    "zeta)^p up to b_k, p = 2 (3 where r|omega| < v and l = k); last U, W = b_k + (b_k+1 - b_k)(xi,"
    " zeta). Nodes uniform in xi and zeta, zeta fastest; quintic not-a-knot splines in both. Cells "
    f"= {COARSEST_CELLS} 2^halvings; halvings of a patch = 16 along xi + along zeta"
)
_LARGEST = 10.0  # of a value, over the largest f and u f'
# how many nodes are compared with the law as a file is read, and how well that is known
_NODES, _NODE_ERROR = 20, 1e-9


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
    >>> from puck_tables.table.speed_build import build_speed_table
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


def _recipe(law: SpeedLaw, breaks: FloatArray) -> dict[str, Any]:
    """What determines the values of a table, besides how often its patches are halved."""
    return {
        "kind": KIND, "pressure_law": "uniform", "law_kind": law.kind,
        "law_speeds": json.dumps(np.asarray(law.speeds).tolist()),
        "law_values": json.dumps(np.asarray(law.values).tolist()),
        "map": _MAP, "breaks": json.dumps(breaks.tolist()), "algorithm": ALGORITHM,
    }  # fmt: skip


def _encode(table: SpeedTable, command: str) -> bytes:
    assert table.accuracy is not None and table.law is not None
    described = {
        "title": "Friction of a sliding, spinning puck whose coefficient depends on the slip speed",
        "interpretation": _INTERPRETATION,
        "valid_range": f"|phi| <= pi/2, 0 <= v + r|omega| <= {table.top:g} m/s; refused outside",
        "tolerance": table.tolerance,
        "largest_f": table.largest_f,
        "achieved_accuracy": json.dumps(asdict(table.accuracy)),
        "method": "quadrature over circles about the centre of rotation, 1e-14",
        "nodes": len(table.values),
        "patches": len(table.cells),
    }
    node = Field("node", np.arange(float(len(table.values))), {"units": "1"})
    patch = Field("patch", np.arange(float(len(table.cells))), {"units": "1"})
    recipe = _recipe(table.law, table.breaks)
    return encode(
        recipe, described, [node], function_fields(INTEGRALS, table), command,
        (patch, Field("halvings", _halvings(table.cells), {"units": "1"})),
    )  # fmt: skip


def _halvings(cells: npt.NDArray[np.int64]) -> FloatArray:
    return np.asarray(np.log2(cells / COARSEST_CELLS) @ [16.0, 1.0])


def shapes(attributes: dict[str, Any]) -> dict[str, tuple[int, ...]]:
    """Shapes of the arrays of a file with these attributes.

    Examples
    --------
    >>> shapes({"nodes": 500, "patches": 2})["p_d"]
    (500,)
    """
    nodes, patches = (attributes["nodes"],), (attributes["patches"],)
    return {"node": nodes, **dict.fromkeys(INTEGRALS, nodes), "patch": patches, "halvings": patches}


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
    attributes, arrays = contents
    breaks, speeds, values = (
        np.array(json.loads(attributes[name]), np.float64)
        for name in ("breaks", "law_speeds", "law_values")
    )
    law = SpeedLaw(speeds, values, attributes["law_kind"])
    nodes, patches = attributes["nodes"], attributes["patches"]
    codes = np.clip(np.nan_to_num(arrays["halvings"]), 0.0, 255.0).astype(np.int64)
    cells = COARSEST_CELLS << np.minimum(np.stack([codes // 16, codes % 16], axis=-1), HALVINGS)
    if not (
        breaks.ndim == 1 and breaks.size > 1 and breaks[0] == 0.0 and np.all(np.diff(breaks) > 0.0)
        and breaks[-1] <= law.top_speed and patches == patch_count(breaks)
        and (cells + 1).prod(axis=1).sum() == nodes
    ):  # fmt: skip
        raise TableError(f"{source} has axes or values that this program cannot use")
    counted = {"node": np.arange(float(nodes)), "patch": np.arange(float(patches))}
    largest = largest_f(law, float(breaks[-1]))
    # every value is a mean of f, of u f', or of both
    steepest = float(np.max(speeds[1:] * np.abs(np.diff(values) / np.diff(speeds))))
    bound = _LARGEST * (largest + steepest)
    check_usable(
        contents, source, _recipe(law, breaks), counted | {"halvings": _halvings(cells)},
        (-bound, bound), 0.5 * FINEST_ACCURACY,
    )  # fmt: skip
    table = SpeedTable(
        breaks,
        cells,
        np.stack([arrays[name] for name in INTEGRALS], axis=-1),
        attributes["largest_f"],
        law,
        tolerance=attributes["tolerance"],
        accuracy=accuracy_of(attributes, SpeedAccuracy, len(INTEGRALS)),
        passport=attributes,
        source=source,
    )
    if abs(table.largest_f - largest) > _NODE_ERROR * largest:
        raise TableError(
            f"{source} says that f is {table.largest_f:g} at most, by its law it is {largest:g}: "
            "it was altered"
        )
    _check_some(table)
    return table


def _check_some(table: SpeedTable) -> None:
    """Refuse a table that is not of its law, as far as some nodes tell."""
    patch = np.random.default_rng().integers(0, len(table.cells), _NODES)
    place = np.random.default_rng().integers(0, table.cells[patch].T + 1)
    nodes = np.concatenate([oddest(table, _NODES), np.stack([patch, *place], axis=-1)])
    refuse_wrong(table.source, node_errors(table, nodes), _NODE_ERROR, "the friction law")


STORED = Kind(
    {"law_kind": str, "law_speeds": str, "law_values": str, "map": str, "breaks": str,
     "nodes": int, "patches": int, "largest_f": float},
    shapes, table_of,
)  # fmt: skip

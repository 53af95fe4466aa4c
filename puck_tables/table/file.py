"""The only door to table files: HDF5 with a passport, refused unless whole and unaltered.

After the HDF5 content stands a line with its sha256, checked before HDF5 reads a byte: damaged
files can make it hang.

Layout: dimension scales ``phi`` and ``delta``; datasets ``parallel``, ``perpendicular``, ``spin``
of shape (phi, delta), little-endian float64; everything else in attributes of the root.  The file
is made and read in memory, so that a failing disk leaves no half of one.
"""

from __future__ import annotations

import hashlib
import io
import json
import platform
from dataclasses import asdict
from datetime import UTC, datetime
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import numpy.typing as npt

from puck_tables._version import __version__
from puck_tables.errors import OutputError, TableError
from puck_tables.safe_write import write_bytes
from puck_tables.table.grid import GRADING_POWER, DeltaAxis, PhiAxis
from puck_tables.table.table import FUNCTIONS, Accuracy, Table

FORMAT = "puck-tables"
FORMAT_VERSION = "1.0"
KIND = "resultants"
_SEAL = b"\npuck-tables sha256 "
ALGORITHM = "elliptic integrals; friction ratios splined; 1"
MAX_FILE_BYTES = 1 << 31

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
    if table.accuracy is None or not np.all(np.isfinite(table.values)):
        raise OutputError(
            "a table without measured accuracy or with a non-finite value is not saved"
        )
    content = _encode(table, command)
    written = _decode(content, str(path))
    if not np.array_equal(written.values, table.values):
        raise TableError(f"{path}: the table does not read back as it was written")
    write_bytes(path, content, overwrite)
    return written


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
    source = str(path)
    try:
        if Path(path).exists() and not Path(path).is_file():
            raise TableError(f"cannot read {source}: it is not a regular file")
        if Path(path).stat().st_size > MAX_FILE_BYTES:
            raise TableError(f"{source} is too large to be a table")
        content = Path(path).read_bytes()
    except FileNotFoundError:
        raise TableError(
            f"there is no table file {source}: build one with 'puck build-tables -o FILE', "
            "or leave --table out to use the default table"
        ) from None
    except OSError as error:
        raise TableError(f"cannot read {source}: {error.strerror or error}") from None
    return _decode(content, source)


@cache
def _default_table() -> Table:
    content = files("puck_tables.tables").joinpath("resultants.h5").read_bytes()
    return _decode(content, "default table")


def _digest(attributes: dict[str, Any], arrays: list[npt.NDArray[np.float64]]) -> str:
    digest = hashlib.sha256(json.dumps(attributes, sort_keys=True).encode())
    for array in arrays:
        digest.update(json.dumps(array.shape).encode())
        digest.update(np.ascontiguousarray(array, dtype="<f8").tobytes())
    return digest.hexdigest()


def _recipe(phi_axis: PhiAxis, delta_axis: DeltaAxis) -> dict[str, Any]:
    """What determines the values of a table."""
    return {
        "kind": KIND, "pressure_law": "uniform", "phi_map": _PHI_MAP, "delta_map": _DELTA_MAP,
        "splined": _SPLINED, "n_phi": phi_axis.size, "n_delta": delta_axis.size,
        "delta_max": 1.0, "algorithm": ALGORITHM,
    }  # fmt: skip


def _encode(table: Table, command: str) -> bytes:
    recipe = _recipe(table.phi_axis, table.delta_axis)
    assert table.accuracy is not None
    attributes: dict[str, Any] = {
        "Conventions": "CF-1.11",
        "title": "Friction resultants of a sliding, spinning puck",
        "format": FORMAT,
        "format_version": FORMAT_VERSION,
        **recipe,
        "interpretation": _INTERPRETATION,
        "valid_range": f"|phi| <= pi/2, 0 <= delta <= {table.delta_axis.upper:g}; refused outside",
        "tolerance": table.tolerance,
        "achieved_accuracy": json.dumps(asdict(table.accuracy)),
        "method": "closed forms (complete elliptic integrals by the AGM), 2e-15",
        "package_version": __version__,
        "library_versions": (
            f"python {platform.python_version()}, numpy {np.__version__}, h5py {h5py.__version__}, "
            f"HDF5 {h5py.version.hdf5_version}"
        ),
        "created": datetime.now(UTC).isoformat(timespec="seconds"),
        "command": command,
        "recipe_digest": hashlib.sha256(json.dumps(recipe, sort_keys=True).encode()).hexdigest(),
    }
    phi, delta = table.phi_axis.nodes(), table.delta_axis.nodes()
    arrays = [phi, delta, *np.moveaxis(table.values, -1, 0)]
    buffer = io.BytesIO()
    with h5py.File(buffer, "w") as file:
        for name, nodes, unit, text in (
            ("phi", phi, "rad", "slip angle atan2(r omega, v)"),
            ("delta", delta, "1", "dimensionless height 2 f h / r"),
        ):
            axis = file.create_dataset(name, data=nodes, dtype="<f8")
            axis.make_scale(name)
            axis.attrs.update(units=unit, long_name=text)
        for index, name in enumerate(FUNCTIONS):
            data = file.create_dataset(name, data=arrays[2 + index], dtype="<f8")
            data.dims[0].attach_scale(file["phi"])
            data.dims[1].attach_scale(file["delta"])
            data.attrs.update(
                units="1", long_name=_LONG_NAMES[name], max_error=table.accuracy.largest[index]
            )
        file.attrs.update(attributes)
        file.attrs["content_digest"] = _digest(attributes, arrays)
    return sealed(buffer.getvalue())


def sealed(content: bytes) -> bytes:
    r"""HDF5 content with the line that proves it whole.

    Examples
    --------
    >>> sealed(b"")[:20]
    b'\npuck-tables sha256 '
    """
    return content + _SEAL + hashlib.sha256(content).hexdigest().encode() + b"\n"


def _decode(content: bytes, source: str) -> Table:
    if not content.startswith(b"\x89HDF\r\n\x1a\n"):
        raise TableError(f"{source} is not an HDF5 file")
    inside, seal, _ = content.rpartition(_SEAL)
    altered = TableError(
        f"{source} was altered or damaged: it does not match its digest; "
        "build it again with 'puck build-tables'"
    )
    if seal and sealed(inside) != content:
        raise altered
    try:
        with h5py.File(io.BytesIO(content), "r") as file:
            table = _read(file, source)
    except TableError:
        raise
    except Exception as error:  # whatever a damaged file makes h5py raise
        raise TableError(
            f"{source} is damaged and cannot be read as a table ({type(error).__name__}): "
            "build it again with 'puck build-tables'"
        ) from None
    if not seal:  # edited by another program, which dropped the line; read to name the reason
        raise altered
    return table


def _read(file: h5py.File, source: str) -> Table:
    attributes = {name: _plain(value) for name, value in file.attrs.items()}
    if attributes.get("format") != FORMAT:
        raise TableError(f"{source} is an HDF5 file but not a table of this program")
    major = str(attributes["format_version"]).split(".")[0]
    if not major.isdigit() or int(major) > int(FORMAT_VERSION.split(".")[0]):
        raise TableError(
            f"{source} has table format {attributes['format_version']}, newer than "
            f"{FORMAT_VERSION} of this program: update puck-tables"
        )
    if attributes.get("kind") != KIND:
        raise TableError(
            f"{source} holds '{attributes.get('kind')}', not a table of '{KIND}': "
            "give a file made by 'puck build-tables'"
        )
    phi_axis = PhiAxis(attributes["n_phi"])
    delta_axis = DeltaAxis(attributes["n_delta"], attributes["delta_max"])
    shape = (phi_axis.size, delta_axis.size)
    shapes = {"phi": shape[:1], "delta": shape[1:], **dict.fromkeys(FUNCTIONS, shape)}
    if any(file[n].shape != s or file[n].dtype != "<f8" for n, s in shapes.items()):
        raise TableError(f"{source} is damaged: its arrays do not fit its axes")
    if 24 * shape[0] * shape[1] > file.id.get_filesize():
        raise TableError(f"{source} is damaged: it is shorter than its arrays")
    arrays = [np.asarray(file[name][...]) for name in shapes]
    stated = attributes.pop("content_digest", None)
    if _digest(attributes, arrays) != stated:
        raise TableError(
            f"{source} was altered or damaged: its content does not match its digest; "
            "build it again with 'puck build-tables'"
        )
    if any(attributes[name] != value for name, value in _recipe(phi_axis, delta_axis).items()):
        raise TableError(f"{source} was made by a recipe that this program does not know")
    # The digest covers what the file says; the nodes must also be where the spline will look.
    if not (
        np.allclose(arrays[0], phi_axis.nodes(), rtol=0.0, atol=1e-14)
        and np.allclose(arrays[1], delta_axis.nodes(), rtol=0.0, atol=1e-14)
        and all(np.isfinite(array).all() for array in arrays)
        and (arrays[2] > 0.0).all()
        and 0.0 < attributes["tolerance"] < 1.0
    ):
        raise TableError(f"{source} has axes or values that this program cannot use")
    accuracy = json.loads(attributes["achieved_accuracy"])
    for key, value in accuracy.items():
        accuracy[key] = tuple(value) if isinstance(value, list) else value
    return Table(
        phi_axis,
        delta_axis,
        np.stack(arrays[2:], axis=-1),
        tolerance=attributes["tolerance"],
        accuracy=Accuracy(**accuracy),
        passport={**attributes, "content_digest": stated},
        source=source,
    )


def _plain(value: Any) -> Any:
    """An attribute as a plain Python value."""
    return value.item() if isinstance(value, np.generic) else value

"""Which format a file name asks for; a result written whole or not at all.

A new format is one module with ``encode(dataset) -> bytes``, and one line here.  And results as
objects of xarray and pandas, with their units.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from puck_tables._core.arrays import instance
from puck_tables._core.safe_write import write_bytes
from puck_tables.errors import InputError, MissingExtraError
from puck_tables.io.columns import Dataset

if TYPE_CHECKING:
    import pandas
    import xarray

STORE = ".zarr"  # written block by block, by sweeps alone: puck_tables.bulk.store
FORMATS = {".h5": "hdf5", ".csv": "csv", ".json": "json", ".jsonl": "jsonl", ".parquet": "parquet"}


def ending_of(path: str | Path, allowed: Any) -> str:
    """The ending of a file name, which chooses its format.

    Raises InputError if it is none of those allowed, or no name.

    >>> ending_of("run.csv", FORMATS)
    '.csv'
    """
    instance("path", path, str, Path)
    ending = Path(path).suffix.lower()
    if ending not in allowed:
        raise InputError(
            f"{path}: the ending of an output file chooses its format: one of {', '.join(allowed)}"
        )
    return ending


def encoder_for(path: str | Path) -> Callable[[Dataset], bytes]:
    """The function that encodes what is to be saved under a name.

    Raises InputError if its ending is not that of a format; MissingExtraError if the format needs a
    package that is not installed.

    >>> encoder_for("run.csv").__module__
    'puck_tables.io.csv'
    """
    module = import_module(f"puck_tables.io.{FORMATS[ending_of(path, FORMATS)]}")
    encode: Callable[[Dataset], bytes] = module.encode
    return encode


def save(dataset: Dataset, path: str | Path, overwrite: bool = False) -> None:
    """Write a result in the format that the ending of the name asks for.

    Raises InputError if its ending is not that of a format; MissingExtraError if the format needs a
    package that is not installed; OutputError if the file exists (without ``overwrite``) or cannot
    be written.

    >>> save(Dataset({}, {}), "run.txt")
    Traceback (most recent call last):
    ...
    puck_tables.errors.InputError: run.txt: the ending of an output file chooses its format: one \
of .h5, .csv, .json, .jsonl, .parquet
    """
    write_bytes(path, encoder_for(path)(dataset), overwrite)


def to_xarray(dataset: Dataset) -> xarray.Dataset:
    """Every column over its axes; units and long names as attributes.

    Raises MissingExtraError if xarray is not installed.

    >>> from puck_tables.io.columns import variable
    >>> time, x = (variable(name, [0.0, 1.0], ("time",)) for name in ("time", "x"))
    >>> to_xarray(Dataset({"time": time}, {"x": x})).x.units
    'm'
    """
    dataset_of = _xarray().Dataset
    attributes = {name: value for name, value in dataset.attributes.items() if value is not None}
    attributes |= {name: text for name, (text, _) in dataset.texts.items()}
    result: xarray.Dataset = dataset_of(
        *(
            {name: (one.dims, np.asarray(one.values), one.attributes) for name, one in part.items()}
            for part in (dataset.columns, dataset.axes)
        ),
        attributes,
    )
    return result


def open_store(path: str | Path) -> xarray.Dataset:
    """A Zarr store as an xarray.Dataset that reads when it is asked; with dask in its chunks.

    Raises MissingExtraError if xarray is not installed.
    """
    chunks: Any = {} if find_spec("dask") is not None else None
    dataset: xarray.Dataset = _xarray().open_zarr(path, chunks=chunks)
    return dataset


def _xarray() -> Any:
    try:
        import xarray
    except ImportError:
        raise MissingExtraError("to_xarray needs xarray: pip install xarray") from None
    return xarray


def to_pandas(dataset: Dataset) -> pandas.DataFrame:
    """The flat table, one row a state, a launch or a run; units in ``attrs``.

    Raises MissingExtraError if pandas is not installed.

    >>> from puck_tables.io.columns import variable
    >>> frame = to_pandas(Dataset({}, {"x": variable("x", [0.0, 1.0], ("time",))}))
    >>> frame.x.tolist(), frame.attrs["units"]
    ([0.0, 1.0], {'x': 'm'})
    """
    try:
        import pandas
    except ImportError:
        raise MissingExtraError("to_pandas needs pandas: pip install pandas") from None
    table = dataset.table()
    frame = pandas.DataFrame({name: one.values for name, one in table.items()})
    frame.attrs["units"] = {name: one.unit for name, one in table.items()}
    return frame

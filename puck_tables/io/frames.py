"""Results as objects of xarray and pandas, with their units."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from puck_tables.errors import MissingExtraError
from puck_tables.io.columns import Dataset

if TYPE_CHECKING:
    import pandas
    import xarray


def to_xarray(dataset: Dataset) -> xarray.Dataset:
    """Every column over its axes; units and long names as attributes.

    Raises
    ------
    MissingExtraError
        If xarray is not installed.

    Examples
    --------
    >>> from puck_tables.io.columns import variable
    >>> time, x = (variable(name, [0.0, 1.0], ("time",)) for name in ("time", "x"))
    >>> to_xarray(Dataset({"time": time}, {"x": x})).x.units
    'm'
    """
    dataset_of = _xarray().Dataset
    attributes = {name: value for name, value in dataset.attributes.items() if value is not None}
    attributes |= {name: text for name, (text, _) in dataset.texts.items()}
    found: xarray.Dataset = dataset_of(
        *(
            {name: (one.dims, np.asarray(one.values), one.attributes) for name, one in part.items()}
            for part in (dataset.columns, dataset.axes)
        ),
        attributes,
    )
    return found


def open_store(path: str | Path) -> xarray.Dataset:
    """A Zarr store as an xarray.Dataset that reads when it is asked; with dask in its chunks.

    Raises
    ------
    MissingExtraError
        If xarray is not installed.
    """
    chunks: Any = {} if find_spec("dask") is not None else None
    found: xarray.Dataset = _xarray().open_zarr(path, chunks=chunks)
    return found


def _xarray() -> Any:
    try:
        import xarray
    except ImportError:
        raise MissingExtraError("to_xarray needs xarray: pip install xarray") from None
    return xarray


def to_pandas(dataset: Dataset) -> pandas.DataFrame:
    """The flat table, one row a state, a launch or a run; units in ``attrs``.

    Raises
    ------
    MissingExtraError
        If pandas is not installed.

    Examples
    --------
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

"""HDF5 that xarray and h5py open: a dataset a column, with its axes, units and attributes (CF)."""

from __future__ import annotations

import io
from datetime import UTC, datetime

from puck_tables._version import __version__
from puck_tables.io.columns import Dataset

_BARE = "This is a netCDF dimension but not a netCDF variable."


def encode(dataset: Dataset) -> bytes:
    """A result as a labelled HDF5 file.

    >>> from puck_tables.io.columns import variable
    >>> time, x = (variable(name, [0.0, 1.0], ("time",)) for name in ("time", "x"))
    >>> encode(Dataset({"time": time}, {"x": x}, {"title": "a line"}))[1:4]
    b'HDF'
    """
    import h5py

    buffer = io.BytesIO()
    with h5py.File(buffer, "w") as file:
        for name, axis in dataset.axes.items():
            file.create_dataset(name, data=axis.values).make_scale(name)
        for name, column in dataset.columns.items():
            data = file.create_dataset(name, data=column.values)
            for position, axis_name in enumerate(column.dims):
                if axis_name not in file:  # without values of its own, as netCDF-4 writes it
                    size = data.shape[position]
                    file.create_dataset(axis_name, (size,), ">f4").make_scale(f"{_BARE}{size:10d}")
                data.dims[position].attach_scale(file[axis_name])
        for name, one in {**dataset.axes, **dataset.columns}.items():
            file[name].attrs.update(one.attributes)
        for name, (text, long_name) in dataset.texts.items():  # an attribute holds 64 kB at most
            file.create_dataset(name, data=text, dtype=h5py.string_dtype())
            file[name].attrs["long_name"] = long_name
        file.attrs.update({
            "Conventions": "CF-1.11", "source": f"puck-tables {__version__}",
            "created": datetime.now(UTC).isoformat(timespec="seconds"), **dataset.attributes,
        })  # fmt: skip
    return buffer.getvalue()

"""Parquet: the table of a result for data tools, with units in the metadata of its columns."""

from __future__ import annotations

import io

from puck_tables.errors import MissingExtraError
from puck_tables.io.columns import Dataset

try:
    import pyarrow
    import pyarrow.parquet
except ImportError:
    raise MissingExtraError("Parquet files need pyarrow: pip install pyarrow") from None


def encode(dataset: Dataset) -> bytes:
    """The table of a result as Parquet.

    >>> from puck_tables.io.columns import variable
    >>> encode(Dataset({}, {"x": variable("x", [0.0, 1.0], ("time",))}))[:4]
    b'PAR1'
    """
    table = dataset.table()
    fields = [
        pyarrow.field(
            name,
            pyarrow.array(one.values[:0]).type,
            metadata={"units": one.unit, "long_name": one.long_name},
        )
        for name, one in table.items()
    ]
    columns = [pyarrow.array(one.values) for one in table.values()]
    attributes = {
        name: str(value) for name, value in dataset.attributes.items() if value is not None
    }
    schema = pyarrow.schema(fields, metadata=attributes)
    buffer = io.BytesIO()
    pyarrow.parquet.write_table(pyarrow.Table.from_arrays(columns, schema=schema), buffer)
    return buffer.getvalue()

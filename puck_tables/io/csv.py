"""CSV: a header line ``name[unit]``, texts without; then one row a state, a launch or a run."""

from __future__ import annotations

import csv
import io

from puck_tables.io.columns import Dataset


def encode(dataset: Dataset) -> bytes:
    """The table of a result as CSV.

    >>> from puck_tables.io.columns import variable
    >>> speed = variable("speed", [1.5], ("time",))
    >>> encode(Dataset({}, {"speed": speed})).split()
    [b'speed[m/s]', b'1.5']
    """
    table, rows = dataset.rows()
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([f"{name}[{one.unit}]" if one.unit else name for name, one in table.items()])
    writer.writerows(rows)
    return text.getvalue().encode()

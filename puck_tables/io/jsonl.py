"""JSON lines: one object a state, a launch or a run; what is no number is null."""

from __future__ import annotations

import json
import math

from puck_tables.io.columns import Dataset


def encode(dataset: Dataset) -> bytes:
    """The table of a result as JSON lines.

    >>> from puck_tables.io.columns import variable
    >>> speed = variable("speed", [1.5, math.nan], ("time",))
    >>> encode(Dataset({}, {"speed": speed})).splitlines()
    [b'{"speed": 1.5}', b'{"speed": null}']
    """
    table, rows = dataset.rows()
    lines = [
        json.dumps(
            {
                name: None if isinstance(value, float) and not math.isfinite(value) else value
                for name, value in zip(table, row, strict=True)
            },
            allow_nan=False,
        )
        for row in rows
    ]
    return "".join(line + "\n" for line in lines).encode()

"""JSON: one object with the scalars, and every column with its unit; what is no number is null."""

from __future__ import annotations

import json
import math
from typing import Any

from puck_tables.io.columns import Dataset


def encode(dataset: Dataset) -> bytes:
    """A result as one JSON object.

    >>> from puck_tables.io.columns import variable
    >>> speed = variable("speed", [1.5, math.nan], ("time",))
    >>> json.loads(encode(Dataset({}, {"speed": speed}, {"case": "coin"})))["columns"]["speed"]
    {'unit': 'm/s', 'long_name': 'speed of the centre, v', 'dims': ['time'], 'values': [1.5, None]}
    """
    columns = {
        name: {
            "unit": one.unit, "long_name": one.long_name, "dims": list(one.dims),
            "values": _plain(one.readable().tolist()),
        } for name, one in {**dataset.axes, **dataset.columns}.items()
    }  # fmt: skip
    texts = {name: text for name, (text, _) in dataset.texts.items()}
    whole = {**_plain(dict(dataset.attributes)), "columns": columns, "texts": texts}
    return (json.dumps(whole, allow_nan=False) + "\n").encode()


def _plain(value: Any) -> Any:
    """Numbers of numpy and what is no number as JSON has them."""
    if isinstance(value, dict):
        return {name: _plain(one) for name, one in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(one) for one in value]
    if hasattr(value, "tolist"):
        return _plain(value.tolist())
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value

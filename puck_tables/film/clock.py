"""Times written as dates or as on a clock: 2025-12-11T10:30:45.12, 10:30:45.12, 30:45.12."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.errors import InputError

_DATE = re.compile(
    r"([0-9]{4}-[0-9]{2}-[0-9]{2})[T ]([0-9]{2}:[0-9]{2}:[0-9]{2})(?:[.,]([0-9]{1,9}))?"
    r"(Z|[+-][0-9]{2}:?[0-9]{2})?"
)
_CLOCK = re.compile(r"(?:([0-9]{1,3}):)?([0-9]{1,2}):([0-9]{1,2})(?:[.,]([0-9]{1,9}))?")
_NANO = 1e-9  # s


def is_clock(text: str) -> bool:
    """Whether a text is a time as here.

    Examples
    --------
    >>> is_clock("2025-12-11 10:30:45,5"), is_clock("1:02.5"), is_clock("12.5")
    (True, True, False)
    """
    return bool(_DATE.fullmatch(text) or _CLOCK.fullmatch(text))


def seconds(where: str, texts: Sequence[str]) -> FloatArray:
    """Times (n,) in s, from the first one on; NaN for empty texts; ``where``: for messages.

    Examples
    --------
    >>> seconds("a.csv", ["23:59:59.75", "", "24:00:00.5"]).tolist()
    [0.0, nan, 0.75]
    """
    nanos = [_nanos(where, text) if text else None for text in texts]
    first = next((one for one in nanos if one is not None), 0)
    return np.array([np.nan if one is None else (one - first) * _NANO for one in nanos])


def _nanos(where: str, text: str) -> int:
    """A time in whole nanoseconds: doubles hold no fraction of a second since 1970 to 1e-8."""
    if (result := _DATE.fullmatch(text)) is not None:
        date, clock, part, zone = result.groups()
        try:
            whole = int(np.datetime64(f"{date}T{clock}", "s").astype(np.int64))
        except ValueError:
            raise InputError(f"{where}: '{text:.40}' is no date") from None
        if zone not in (None, "Z"):
            sign, digits = (-1 if zone[0] == "-" else 1), zone[1:].replace(":", "")
            whole -= sign * (3600 * int(digits[:2]) + 60 * int(digits[2:]))
    elif (result := _CLOCK.fullmatch(text)) is not None:
        hours, minutes, secs, part = result.groups()
        whole = 3600 * int(hours or 0) + 60 * int(minutes) + int(secs)
    else:
        raise InputError(f"{where}: '{text:.40}' is no time as in the rows before")
    return whole * 10**9 + int((part or "0").ljust(9, "0"))

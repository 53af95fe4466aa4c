"""What the package's kernels are made with: compiled by numba, or left as they are written."""

from __future__ import annotations

from puck_tables.kernels.as_written import (
    BLOCK,
    LINE,
    bits_of,
    into_line,
    into_row,
    into_rows,
    number_of,
    row_of,
    rows_of,
    spline_polynomials,
    spline_slopes,
    spline_values,
    stream_line,
    summed,
    turn_square,
    weighted_rows,
)
from puck_tables.kernels.doors import (
    allocating,
    arrays_at_first,
    entry_of,
    inlined,
    inner,
    kernel,
    look_up,
    on_demand,
)
from puck_tables.kernels.patience import patience

__all__ = [
    "BLOCK", "LINE", "allocating", "arrays_at_first", "bits_of", "entry_of", "inlined", "inner",
    "into_line", "into_row", "into_rows", "kernel", "look_up", "number_of", "on_demand", "patience",
    "row_of", "rows_of", "spline_polynomials", "spline_slopes", "spline_values", "stream_line",
    "summed", "turn_square", "weighted_rows",
]  # fmt: skip

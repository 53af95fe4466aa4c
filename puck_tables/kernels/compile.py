"""What the package's kernels are made with: compiled by numba, or left as they are written."""

from __future__ import annotations

from puck_tables.kernels.as_written import BLOCK, LINE, as_written

if as_written():
    from puck_tables.kernels.as_written import (
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
    from puck_tables.kernels.as_written import unchanged as allocating
    from puck_tables.kernels.as_written import unchanged as inlined
    from puck_tables.kernels.as_written import unchanged as inner
    from puck_tables.kernels.as_written import unchanged as kernel
else:
    from puck_tables.kernels.blocks import (
        into_line,
        into_row,
        into_rows,
        row_of,
        rows_of,
        stream_line,
        turn_square,
    )
    from puck_tables.kernels.compiled import allocating, inlined, inner, kernel
    from puck_tables.kernels.vectors import (
        bits_of,
        number_of,
        spline_polynomials,
        spline_slopes,
        spline_values,
        summed,
        weighted_rows,
    )

__all__ = [
    "BLOCK", "LINE", "allocating", "bits_of", "inlined", "inner", "into_line", "into_row",
    "into_rows", "kernel", "number_of", "row_of", "rows_of", "spline_polynomials", "spline_slopes",
    "spline_values", "stream_line", "summed", "turn_square", "weighted_rows",
]  # fmt: skip

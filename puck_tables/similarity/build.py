"""Building a stop table: stops integrated one by one to rounding, the curve by quadrature.

The stops are integrated, not taken from the linear equations that T and X + iY satisfy: the
integrator exists, reaches 1e-15 with closed forms at a local tolerance of 2e-14, and leaves those
equations for the check.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from puck_tables.errors import AccuracyError, InputError
from puck_tables.executor import run_chunks
from puck_tables.similarity.axes import HEIGHTS, SlipAxis, heights
from puck_tables.similarity.check import measure
from puck_tables.similarity.curve import limits, regular_parts
from puck_tables.similarity.exact import end_values, exact_stops
from puck_tables.similarity.stop_table import FUNCTIONS, StopTable

FloatArray = npt.NDArray[np.float64]
Progress = Callable[[int, int], None]

DEFAULT_ACCURACY = 1e-10
FINEST_ACCURACY = 1e-11
_ERROR_CONSTANT = 0.62  # measured: largest error × cells⁴
_CHUNK = 64


def build_stop_table(
    accuracy: float | None = None, cells: int | None = None, progress: Progress | None = None
) -> StopTable:
    """Tabulate stops over slip angle and height, and measure how exact the result is.

    Parameters
    ----------
    accuracy : float, optional
        Largest error wanted, in units of Q/J (time), Q²/J (place, path) and Q²/(J r) (body angle),
        from 1e-11 to 0.01; default 1e-10.
    cells : int, optional
        Grid size by hand instead: cells on either side of φ = π/4, from 8 on.
    progress : callable (done, total), optional

    Returns
    -------
    StopTable
        With ``accuracy`` measured at random and adversarial points.

    Raises
    ------
    InputError
        If both ``accuracy`` and ``cells`` are given or a number is out of range.
    AccuracyError
        If the accuracy is out of reach.

    Notes
    -----
    Node values are exact to about 1e-15; the error of the splines falls like cells⁻⁴, down to the
    1e-12 of the polynomial in δ².

    Examples
    --------
    >>> table = build_stop_table(accuracy=1e-5)
    >>> table.axis.cells, table.accuracy.worst <= 1e-5
    (18, True)
    """
    if accuracy is not None and cells is not None:
        raise InputError(
            f"accuracy = {accuracy:g} and cells = {cells} both fix the grid: give one of them"
        )
    if cells is not None:
        table = tabulate(SlipAxis(cells), progress)
        measured = measure(table, _half(table))
        tolerance = float(f"{1.25 * measured.worst:.1e}")
        return replace(table, accuracy=measured, tolerance=max(tolerance, FINEST_ACCURACY))
    wanted = DEFAULT_ACCURACY if accuracy is None else accuracy
    if not FINEST_ACCURACY <= wanted <= 0.01:
        raise AccuracyError(
            f"the accuracy of a stop table must be from {FINEST_ACCURACY:g} to 0.01 (in units of "
            f"Q/J and Q^2/J), got {wanted:g}"
        )
    cells = max(8, 2 * math.ceil(0.5 * (_ERROR_CONSTANT / wanted) ** 0.25))
    while True:
        table = tabulate(SlipAxis(cells), progress)
        measured = measure(table, _half(table))
        if measured.worst <= wanted:
            return replace(table, accuracy=measured, tolerance=wanted)
        cells = 2 * math.ceil(0.55 * cells)


def _half(table: StopTable) -> StopTable | None:
    """The table on every other node."""
    if table.axis.cells % 2 or table.axis.cells < 16:
        return None
    return StopTable(SlipAxis(table.axis.cells // 2), table.values[::2])


def tabulate(axis: SlipAxis, progress: Progress | None = None) -> StopTable:
    """The node values of a stop table, without a measured accuracy.

    Examples
    --------
    >>> tabulate(SlipAxis(8)).values[8, :, 0].round(6).tolist()[::4]  # T at π/4
    [0.948026, 0.967044, 0.98618]
    """
    delta = heights()
    log_k = np.log(axis.ratio()[1:])
    inner = np.concatenate([log_k, -log_k[-2::-1]])  # all nodes but the two ends
    u, height = (grid.ravel() for grid in np.meshgrid(inner, delta, indexing="ij"))
    stops = np.empty((u.size, 5))

    def work(start: int, stop: int) -> None:
        stops[start:stop] = exact_stops(u[start:stop], height[start:stop])

    run_chunks(work, u.size, _CHUNK, None, progress)
    shaped = stops.reshape(inner.size, HEIGHTS, 5)
    values = np.empty((axis.size, HEIGHTS, len(FUNCTIONS)))
    large = 1.0 / np.hypot(1.0, np.exp(-np.abs(inner)))
    small = large * np.exp(-np.abs(inner))
    cosine = np.where(inner > 0.0, small, large)[:, None]
    sine = np.where(inner > 0.0, large, small)[:, None]
    values[1:-1, :, 0] = shaped[:, :, 0]
    values[1:-1, :, 1] = shaped[:, :, 1] / cosine
    values[1:-1, :, 2] = shaped[:, :, 2] / (delta * sine * cosine)
    values[1:-1, :, 3] = shaped[:, :, 3] / cosine
    values[1:-1, :, 4] = shaped[:, :, 4] / sine
    values[[0, -1], :, :5] = np.stack(end_values(delta))
    for j, one in enumerate(delta):
        parts = regular_parts(axis, float(one))
        values[:, j, 5] = limits(float(one)).kappa * parts[:, 0]
        values[:, j, 6] = parts[:, 1] / one
    return StopTable(axis, values)

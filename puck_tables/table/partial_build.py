"""Building the table of partial contact to an asked accuracy."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from puck_tables.contact.one_sided import balance
from puck_tables.errors import AccuracyError, InputError
from puck_tables.table.partial_check import measure
from puck_tables.table.partial_grid import PartialAxes
from puck_tables.table.partial_table import PartialTable

Progress = Callable[[int, int], None]

DEFAULT_ACCURACY = 1e-6
FINEST_ACCURACY = 1e-8
_ERROR_CONSTANT = 950.0  # measured: largest error × cells⁴


def build_partial_table(
    accuracy: float | None = None, cells: int | None = None, progress: Progress | None = None
) -> PartialTable:
    """Tabulate the resultants of partial contact up to δ = 3.9, and measure how exact they are.

    Parameters
    ----------
    accuracy : float, optional
        Largest error wanted in ρ_∥, ρ_⊥, ρ_ω (dimensionless), from 1e-8 to 0.01; default 1e-6.
    cells : int, optional
        Grid size by hand instead: cells in height and on either side of π/4, even, from 8 on.
    progress : callable (done, total), optional
        Called as slip angles are done.

    Returns
    -------
    PartialTable
        With ``accuracy`` measured at random and adversarial points.

    Raises
    ------
    InputError
        If both arguments are given or a number is out of range.
    AccuracyError
        If the accuracy is out of reach.

    Notes
    -----
    Node values come from :func:`puck_tables.contact.one_sided.balance` (1e-13), half a millisecond
    each; the error of the spline falls like cells⁻⁴.

    Examples
    --------
    >>> table = build_partial_table(accuracy=0.01)
    >>> table.axes.cells, table.accuracy.worst <= 0.01
    (20, True)
    """
    if accuracy is not None and cells is not None:
        raise InputError(
            f"accuracy = {accuracy:g} and cells = {cells} both fix the grid: give one of them"
        )
    if cells is not None:
        table = tabulate(PartialAxes(cells), progress)
        measured = measure(table, _half(table))
        return replace(table, accuracy=measured, tolerance=float(f"{1.25 * measured.worst:.1e}"))
    wanted = DEFAULT_ACCURACY if accuracy is None else accuracy
    if not FINEST_ACCURACY <= wanted <= 0.01:
        raise AccuracyError(
            f"the accuracy of a table of partial contact must be from {FINEST_ACCURACY:g} to 0.01 "
            f"(an absolute error of the dimensionless resultants), got {wanted:g}"
        )
    cells = max(8, 4 * math.ceil(0.25 * (_ERROR_CONSTANT / wanted) ** 0.25))
    while True:
        table = tabulate(PartialAxes(cells), progress)
        measured = measure(table, _half(table))
        if measured.worst <= wanted:
            return replace(table, accuracy=measured, tolerance=wanted)
        cells = 4 * math.ceil(0.2625 * cells)


def tabulate(axes: PartialAxes, progress: Progress | None = None) -> PartialTable:
    """The node values of a table of partial contact, without a measured accuracy.

    Examples
    --------
    >>> tabulate(PartialAxes(8)).values[0, 0].round(12).tolist()  # φ = 0, δ = 1
    [1.0, 0.25, 0.375]
    """
    delta = axes.delta()
    values = np.empty((*axes.shape, 3))
    for row, phi in enumerate(axes.phi()):
        rho, _ = balance(np.full(delta.shape[1], phi), delta[row])
        values[row] = np.stack(rho, axis=-1)
        if progress is not None:
            progress(row + 1, len(delta))
    return PartialTable(axes, values)


def _half(table: PartialTable) -> PartialTable | None:
    """The table on every other node."""
    if table.axes.cells % 4 or table.axes.cells < 16:
        return None
    return PartialTable(PartialAxes(table.axes.cells // 2), table.values[::2, ::2])

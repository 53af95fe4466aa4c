"""Law and grid to node values: building a table to an asked accuracy."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from puck_tables.contact import closed_form
from puck_tables.contact.integrals import PatchIntegrals, SlipDirection
from puck_tables.contact.resultants import moment_balance
from puck_tables.errors import AccuracyError, InputError
from puck_tables.table.check import measure
from puck_tables.table.grid import DeltaAxis, PhiAxis, checked_size
from puck_tables.table.table import Table

Progress = Callable[[int, int], None]

DEFAULT_ACCURACY = 2e-11
FINEST_ACCURACY = 1e-13
DEFAULT_N_DELTA = 4  # exact in full contact, see puck_tables.kernels.spline
_ERROR_CONSTANT = 1.2  # measured: largest error × (cells per side)⁴
_ROWS = 4096


def build_table(
    accuracy: float | None = None,
    n_phi: int | None = None,
    n_delta: int | None = None,
    progress: Progress | None = None,
) -> Table:
    """Tabulate the friction resultants on a graded grid, and measure how exact the result is.

    Parameters
    ----------
    accuracy : float, optional
        Largest error wanted in ρ_∥, ρ_⊥, ρ_ω (dimensionless), from 1e-13 to 0.01; default 2e-11.
    n_phi, n_delta : int, optional
        Grid sizes by hand instead: ``n_phi`` odd and ≥ 9, ``n_delta`` ≥ 4.  ``n_delta`` alone
        may go with ``accuracy``.
    progress : callable (done, total), optional
        Called as node rows are computed.

    Returns
    -------
    Table
        With ``accuracy`` measured at random and adversarial points.

    Raises
    ------
    InputError
        If both ``accuracy`` and ``n_phi`` are given or a size is out of range.
    AccuracyError
        If the accuracy is out of reach.

    Notes
    -----
    Node values come from the closed forms (2e-15); the error of the spline falls like n_phi⁻⁴.

    Examples
    --------
    >>> table = build_table(accuracy=1e-6)
    >>> table.phi_axis.size, table.accuracy.worst <= 1e-6
    (69, True)
    """
    if accuracy is not None and n_phi is not None:
        raise InputError(
            f"accuracy = {accuracy:g} and n_phi = {n_phi} both fix the grid: give one of them"
        )
    delta_axis = DeltaAxis(DEFAULT_N_DELTA if n_delta is None else n_delta)
    if n_phi is not None:
        table = tabulate(PhiAxis(n_phi), delta_axis, progress)
        measured = measure(table, _half(table))
        return replace(
            table,
            accuracy=measured,
            tolerance=_rounded_up(max(1.25 * measured.worst, FINEST_ACCURACY)),
        )
    wanted = DEFAULT_ACCURACY if accuracy is None else accuracy
    if not FINEST_ACCURACY <= wanted <= 0.01:
        raise AccuracyError(
            f"accuracy must be from {FINEST_ACCURACY:g} to 0.01 (an absolute error of the "
            f"dimensionless resultants), got {wanted:g}"
        )
    cells = max(4, math.ceil((_ERROR_CONSTANT / wanted) ** 0.25))
    while True:
        table = tabulate(PhiAxis(2 * cells + 1), delta_axis, progress)
        measured = measure(table, _half(table))
        if measured.worst <= wanted:
            return replace(table, accuracy=measured, tolerance=wanted)
        cells = math.ceil(1.1 * cells)


def tabulate(phi_axis: PhiAxis, delta_axis: DeltaAxis, progress: Progress | None = None) -> Table:
    """Node values by the closed forms, without a measured accuracy.

    Examples
    --------
    >>> tabulate(PhiAxis(9), DeltaAxis(4)).values.shape
    (9, 4, 3)
    """
    checked_size(phi_axis.size, delta_axis.size)
    nodes = phi_axis.slip_direction()
    values = np.empty((phi_axis.size, delta_axis.size, 3))
    for start in range(0, phi_axis.size, _ROWS):
        rows = slice(start, start + _ROWS)
        direction = SlipDirection(nodes.ratio[rows, None], nodes.fast_spin[rows, None])
        a, b, d = closed_form.shape_integrals(
            direction.ratio, direction.fast_spin.astype(np.float64)
        )
        p = PatchIntegrals(a, b, b - d, d, d - 2.0 * b)
        values[rows] = np.stack(moment_balance(p, direction, delta_axis.nodes()), axis=-1)
        if progress is not None:
            progress(min(start + _ROWS, phi_axis.size), phi_axis.size)
    return Table(phi_axis, delta_axis, values)


def _half(table: Table) -> Table | None:
    cells = table.phi_axis.cells_per_side // 2
    if cells < 4:
        return None
    return tabulate(PhiAxis(2 * cells + 1), table.delta_axis, None)


def _rounded_up(value: float) -> float:
    """To two digits, upwards."""
    scale = 10.0 ** (math.floor(math.log10(value)) - 1)
    return float(f"{math.ceil(value / scale) * scale:.1e}")

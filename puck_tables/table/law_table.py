"""A table of full contact under any pressure law: building, look-up, and how exact it is."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from puck_tables.contact.integrals import PatchIntegrals, checked_phi
from puck_tables.contact.laws import Law, law_of, profile_law
from puck_tables.contact.resultants import Resultants, checked_delta
from puck_tables.errors import AccuracyError, InputError
from puck_tables.real import broadcast
from puck_tables.table.fit import (
    clamped_coefficients,
    half_clamped_coefficients,
    not_a_knot_coefficients,
)
from puck_tables.table.law_grid import LawAxis
from puck_tables.table.table import Accuracy

FloatArray = npt.NDArray[np.float64]
Progress = Callable[[int, int], None]

HEIGHTS = 4  # the splined ratios are polynomials of degree 2 in δ
DEFAULT_ACCURACY = 1e-9
FINEST_ACCURACY = 1e-11
_ERROR_CONSTANT = 1.5  # measured under uniform pressure: largest error × cells⁴
_MAX_CELLS = 2048
_POINTS = 2400  # about as many slip angles are measured
_CHUNK = 256  # angles between two reports of progress


@dataclass(frozen=True)
class LawTable:
    """Friction resultants under a pressure law, 0 ≤ δ ≤ 4⟨x²⟩, with the spline through them.

    Parameters
    ----------
    law_name : str
    axis : LawAxis
    delta_max : float
        The largest δ: contact is full at every φ up to it.
    values : array (sides, cells + 1, 4, 3)
        ρ_∥, ρ_⊥, ρ_ω at the nodes of φ and at δ = 0, ⅓, ⅔ and 1 of ``delta_max``.
    tolerance, accuracy, passport, source
        As in :class:`puck_tables.table.table.Table`.
    profile : pair of arrays (n,), optional
        Radii and pressures of a tabulated law.
    """

    law_name: str
    axis: LawAxis
    delta_max: float
    values: FloatArray = field(repr=False)
    tolerance: float = 0.0
    accuracy: Accuracy | None = None
    passport: dict[str, Any] = field(default_factory=dict, repr=False)
    source: str = "memory"
    profile: tuple[FloatArray, FloatArray] | None = field(default=None, repr=False)

    @property
    def law(self) -> Law:
        """The law it is a table of.

        Raises
        ------
        InputError
            If it is a profile and the file, from before format 2, does not hold its values.
        """
        if self.profile is not None:
            return profile_law(*self.profile, name=self.law_name)
        if self.law_name.lower().endswith(".csv"):
            raise InputError(
                f"{self.source} does not hold the profile {self.law_name}: build it again"
            )
        return law_of(self.law_name)

    @cached_property
    def spline(self) -> tuple[FloatArray, FloatArray]:
        """Coefficients and sides as :mod:`puck_tables.kernels.law_spline` reads them."""
        parallel = self.values[..., 0]
        ratios = np.stack(
            [1.0 / parallel, self.values[..., 1] / parallel, self.values[..., 2] / parallel], -1
        )
        last = len(ratios) - 1
        along_eta = np.stack([
            # even about φ = 0 and π/2, where the first and the last side end
            clamped_coefficients(side) if k in (0, last) else half_clamped_coefficients(side)
            for k, side in enumerate(ratios)
        ])  # fmt: skip
        along_delta = not_a_knot_coefficients(np.moveaxis(along_eta, 2, 0))
        return np.ascontiguousarray(along_delta.transpose(1, 0, 2, 3)) / 36.0, np.array(
            self.axis.sides
        )

    def resultants(self, phi: npt.ArrayLike, delta: npt.ArrayLike) -> Resultants:
        """Interpolated resultants ρ_∥, ρ_⊥, ρ_ω.

        Parameters
        ----------
        phi : array_like, radians, in [−π/2, π/2]
        delta : array_like, dimensionless, in [0, delta_max]
            Broadcast against ``phi``.

        Returns
        -------
        Resultants
            Dimensionless arrays of the broadcast shape; ``accuracy`` says how exact.

        Raises
        ------
        InputError
            If an argument is not finite or outside its range; nothing is extrapolated.

        Examples
        --------
        >>> from puck_tables.contact.laws import law_of
        >>> table = build_law_table(law_of("annulus:0.8"), accuracy=1e-5)
        >>> float(table.resultants(0.0, 1.0).perpendicular.round(6))
        0.25
        """
        from puck_tables.kernels.law_spline import fill_law

        angle, height = broadcast(phi=checked_phi(phi), delta=checked_delta(delta))
        if not np.all(height <= self.delta_max):
            raise InputError(
                f"delta = {height[height > self.delta_max].flat[0]:g} is outside this table "
                f"(pressure law {self.law_name}: 0 <= delta <= {self.delta_max:g})"
            )
        out = np.empty((3, angle.size))
        fill_law(
            *self.spline,
            self.delta_max,
            np.ascontiguousarray(angle).reshape(-1),
            np.ascontiguousarray(height).reshape(-1),
            out,
        )
        return Resultants(*(row.reshape(angle.shape) for row in out))


def build_law_table(
    law: Law,
    accuracy: float | None = None,
    cells: int | None = None,
    progress: Progress | None = None,
) -> LawTable:
    """Tabulate the resultants under a pressure law, and measure how exact the result is.

    Parameters
    ----------
    law : Law
    accuracy : float, optional
        Largest error wanted, from 1e-11 to 0.01; default 1e-9.
    cells : int, optional
        Grid size by hand instead: cells on each side of each singular line, at least 8.
    progress : callable (done, all), optional
        Told how many slip angles are done; begins again where a finer grid is needed.

    Returns
    -------
    LawTable

    Raises
    ------
    InputError
        If both are given or a number is out of range.
    AccuracyError
        If the accuracy is out of reach.

    Examples
    --------
    >>> from puck_tables.contact.laws import law_of
    >>> table = build_law_table(law_of("hertz"), accuracy=1e-6)
    >>> table.delta_max, table.accuracy.worst <= 1e-6
    (0.8, True)
    """
    if accuracy is not None and cells is not None:
        raise InputError(
            f"accuracy = {accuracy:g} and cells = {cells} both fix the grid: give one of them"
        )
    if cells is not None:
        table, measured = _tabulate_and_measure(law, cells, progress)
        tolerance = max(1.25 * measured.worst, FINEST_ACCURACY)
        return replace(table, accuracy=measured, tolerance=float(f"{tolerance:.1e}"))
    wanted = DEFAULT_ACCURACY if accuracy is None else accuracy
    if not FINEST_ACCURACY <= wanted <= 0.01:
        raise AccuracyError(
            f"the accuracy of a table under a pressure law must be from {FINEST_ACCURACY:g} to "
            f"0.01 (an absolute error of the dimensionless resultants), got {wanted:g}"
        )
    cells = max(8, 2 * math.ceil(0.5 * (_ERROR_CONSTANT / wanted) ** 0.25))
    while cells <= _MAX_CELLS:
        table, measured = _tabulate_and_measure(law, cells, progress)
        if measured.worst <= wanted:
            return replace(table, accuracy=measured, tolerance=wanted)
        cells = 2 * math.ceil(0.6 * cells)
    raise AccuracyError(
        f"an accuracy of {wanted:g} under the pressure law {law.name} would take more than "
        f"{_MAX_CELLS} cells: {measured.worst:.1e} is what {_MAX_CELLS} about give"
    )


def _tabulate_and_measure(
    law: Law, cells: int, progress: Progress | None
) -> tuple[LawTable, Accuracy]:
    """A table with what it is worth, in the order of work of its slip angles."""
    if progress is not None:
        law = _reporting(law, 2 * len(law.edges) * (cells + 1) + _POINTS, progress)
    table = tabulate(law, cells)
    return table, measure(table, law)


def _reporting(law: Law, total: int, progress: Progress) -> Law:
    """The same law, telling how many slip angles it has been asked for."""
    done = 0

    def integrals(phi: npt.ArrayLike) -> PatchIntegrals:
        nonlocal done
        angle = np.ravel(asked := np.asarray(phi, dtype=np.float64))
        parts = []
        for start in range(0, angle.size, _CHUNK):
            parts.append(np.stack(law.integrals(angle[start : start + _CHUNK])))
            done += parts[-1].shape[1]
            progress(min(done, total), total)
        return PatchIntegrals(*np.concatenate(parts, axis=1).reshape(5, *asked.shape))

    return replace(law, integrals=integrals)


def tabulate(law: Law, cells: int) -> LawTable:
    """The node values of a table, without a measured accuracy.

    Examples
    --------
    >>> from puck_tables.contact.laws import law_of
    >>> tabulate(law_of("annulus:0.5"), 8).values.shape
    (4, 9, 4, 3)
    """
    axis = LawAxis(law.edges, cells)
    delta_max = float(f"{law.delta_max:.12g}")
    rho = law.resultants(axis.phi()[..., None], np.linspace(0.0, delta_max, HEIGHTS))
    return LawTable(law.name, axis, delta_max, np.stack(rho, axis=-1), profile=law.profile)


def measure(table: LawTable, law: Law, seed: int = 2012) -> Accuracy:
    """The errors of a table against the law itself, at random and adversarial points.

    Adversarial: both sides of every singular line and of 0 and π/2 at all distances, and the
    middles of cells.  ``order`` compares with the table on every other node.
    """
    rng = np.random.default_rng(seed)
    distance = 10.0 ** -rng.uniform(0.3, 16.0, 400)
    lines = np.array([side.line for side in table.axis.sides])
    near = rng.choice(np.append(lines, [0.0, 0.5 * np.pi]), 400) + distance * rng.choice(
        [-1, 1], 400
    )
    nodes = table.axis.phi()
    middles = (0.5 * (nodes[:, 1:] + nodes[:, :-1])).ravel()
    phi = np.concatenate([
        rng.uniform(0.0, 0.5 * np.pi, 1200), near, lines, [0.0, 0.5 * np.pi],
        rng.choice(middles, min(middles.size, 800), replace=False),
    ])  # fmt: skip
    phi = phi[(phi >= 0.0) & (phi <= 0.5 * np.pi)]
    delta = table.delta_max * rng.choice([0.0, 0.5, 1.0, *rng.random(5)], phi.size)
    truth = np.stack(law.resultants(phi, delta))
    error = np.abs(np.stack(table.resultants(phi, delta)) - truth)
    where = error.argmax(axis=1)
    order = 0.0
    if table.axis.cells % 2 == 0 and table.axis.cells >= 8:
        half_axis = LawAxis(table.axis.edges, table.axis.cells // 2)
        half = replace(table, axis=half_axis, values=table.values[:, ::2])
        half_error = np.abs(np.stack(half.resultants(phi, delta)) - truth).max()
        order = float(np.log2(half_error / error.max()))
    sliding = table.resultants(0.0, np.linspace(0.0, table.delta_max, 101))
    return Accuracy(
        largest=tuple(error.max(axis=1).tolist()),
        rms=tuple(np.sqrt((error**2).mean(axis=1)).tolist()),
        p999=tuple(np.quantile(error, 0.999, axis=1).tolist()),
        at_phi=tuple(phi[where].tolist()),
        at_delta=tuple(delta[where].tolist()),
        entry_residual=float(np.abs(sliding.parallel - 1.0).max()),
        order=order,
        points=phi.size,
    )

"""A stop table in memory: axes, node values, and the splines through them."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from puck_tables.contact.resultants import checked_delta
from puck_tables.errors import InputError
from puck_tables.executor import run_chunks
from puck_tables.similarity.axes import (
    CONSTANT_HEIGHTS,
    HEIGHTS,
    SlipAxis,
    height_polynomials,
    heights,
)
from puck_tables.similarity.curve import limits
from puck_tables.similarity.lookup import (
    CURVE_ROW,
    STOP_POWERS,
    STOP_ROW,
    row_width,
    stops_kernel,
)
from puck_tables.table.fit import clamped_coefficients

FloatArray = npt.NDArray[np.float64]

_CHUNK = 1 << 15

FUNCTIONS = ("time", "along", "across", "length", "body", "curve", "turn")
UPPER_DELTA = 1.0


@dataclass(frozen=True)
class StopAccuracy:
    """Errors of a stop table that were measured, not promised; dimensionless.

    One entry each for T, X, Y, path length and body angle, in units of Q/J, Q²/J and Q²/(J r), and
    for κR and S of the curve: the largest and the root mean square over random and adversarial
    points, and where the largest stands; the order of T against a table of half as many cells.
    """

    largest: tuple[float, ...]
    rms: tuple[float, ...]
    at_phi: tuple[float, ...]
    at_delta: tuple[float, ...]
    order: float
    points: int

    @property
    def worst(self) -> float:
        """The largest error of a stop."""
        return max(self.largest[:5])

    @property
    def states(self) -> float:
        """The largest error of anything that a state on the way is found with."""
        return max(self.largest)


@dataclass(frozen=True)
class StopTable:
    """Where and when any puck stops, as functions of slip angle φ and height δ alone.

    Parameters
    ----------
    axis : SlipAxis
    values : array (2 cells + 1, 9, 7)
        At the nodes of φ (ascending) and of δ (:func:`puck_tables.similarity.axes.heights`):
        ``time`` T; ``along`` X/cos φ; ``across`` Y/(δ sin φ cos φ); ``length`` path/cos φ; ``body``
        angle/sin φ (all: :mod:`puck_tables.similarity.lookup`); ``curve`` κR; ``turn`` S/δ
        (:mod:`puck_tables.similarity.curve`).
    tolerance : float
        The error the table promises for stops; 0 while it is not known.
    accuracy : StopAccuracy or None
        The errors that were measured when it was built.
    passport : dict
        What else its file says.
    source : str
        Where it came from, for messages.
    """

    axis: SlipAxis
    values: FloatArray = field(repr=False)
    tolerance: float = 0.0
    accuracy: StopAccuracy | None = None
    passport: dict[str, Any] = field(default_factory=dict, repr=False)
    source: str = "memory"

    def __post_init__(self) -> None:
        values = self.values.view()
        values.flags.writeable = False
        object.__setattr__(self, "values", values)

    @cached_property
    def stop_coefficients(self) -> FloatArray:
        """T, along, across as the kernels of curve_lookup read them."""
        return self._coefficients([0, 1, 2], STOP_POWERS, STOP_ROW, by_power=True)

    @cached_property
    def curve_coefficients(self) -> FloatArray:
        """Body angle, S/δ, path length, κR as the kernels of curve_lookup read them."""
        return self._coefficients([4, 6, 3, 5], HEIGHTS, CURVE_ROW, by_power=False)

    @cached_property
    def constants(self) -> FloatArray:
        """c₀, κ, h₀/δ and ln T(π/4) as polynomials in 2δ² − 1, (4, 14)."""
        rows = []
        for delta in heights(CONSTANT_HEIGHTS):
            at = limits(float(delta))
            rows.append([math.tanh(0.5 * at.u), at.kappa, at.turn / delta])
        polynomials = np.zeros((4, CONSTANT_HEIGHTS))
        polynomials[:3] = height_polynomials(np.array(rows), CONSTANT_HEIGHTS).T
        quarter = np.log(self.values[self.axis.cells, :, 0])
        polynomials[3, :HEIGHTS] = height_polynomials(quarter)
        return polynomials

    @cached_property
    def time_inverse(self) -> FloatArray:
        """From the time that is left to the slip ratio."""
        return self._inverse(with_time=True)

    @cached_property
    def turn_inverse(self) -> FloatArray:
        """From Q to the slip ratio."""
        return self._inverse(with_time=False)

    def _inverse(self, with_time: bool) -> FloatArray:
        from puck_tables.similarity.curve_lookup import fill_inverse

        values = np.empty((2, self.axis.cells + 1, HEIGHTS))
        fill_inverse(
            self.stop_coefficients, self.curve_coefficients, self.constants, with_time,
            heights(), values,
        )  # fmt: skip
        splines = clamped_coefficients(np.moveaxis(values, 1, 0)) / 6.0  # node, side, height
        by_power = height_polynomials(np.moveaxis(splines, 2, 0))
        return np.ascontiguousarray(by_power.transpose(2, 1, 0))

    def _coefficients(
        self, functions: list[int], powers: int, row: int, by_power: bool
    ) -> FloatArray:
        n = self.axis.cells
        values = self.values[:, :, functions]
        sides = np.stack([values[: n + 1], values[: n - 1 : -1]])  # both from k = 0 to k = 1
        splines = clamped_coefficients(np.moveaxis(sides, 1, 0)) / 6.0  # node, side, height, f
        powers_first = height_polynomials(np.moveaxis(splines, 2, 0), powers)
        # power, node, side, function → side, node, then the faster index last
        order = (2, 1, 0, 3) if by_power else (2, 1, 3, 0)
        ordered = powers_first.transpose(order).reshape(2, n + 3, -1)
        padded = np.zeros((2, n + 3, row))
        padded[:, :, : ordered.shape[2]] = ordered
        padded.flags.writeable = False
        return padded

    @cached_property
    def _cuts(self) -> dict[tuple[int, int], FloatArray]:
        return {}

    def cut(self, powers: int = STOP_POWERS, thinning: int = 1) -> FloatArray:
        """What :func:`puck_tables.similarity.lookup.stops_kernel` reads, as coarse as wanted.

        Parameters
        ----------
        powers : powers of 2δ² − 1 to keep for T; along and across keep one fewer, enough for them
        thinning : keep every so many nodes of the slip axis; divides ``axis.cells``

        Returns
        -------
        array (2, cells/thinning + 3, row_width(powers)), read-only
        """
        if (powers, thinning) in self._cuts:
            return self._cuts[powers, thinning]
        n = self.axis.cells // thinning
        values = self.values[::thinning, :, :3]
        sides = np.stack([values[: n + 1], values[: n - 1 : -1]])
        splines = np.moveaxis(clamped_coefficients(np.moveaxis(sides, 1, 0)) / 6.0, 2, 0)
        by_power = np.zeros((powers, *splines.shape[1:]))  # power, node, side, function
        by_power[..., 0] = height_polynomials(splines[..., 0], powers)
        by_power[:-1, ..., 1:] = height_polynomials(splines[..., 1:], powers - 1)
        rows = by_power.transpose(2, 1, 0, 3).reshape(2, n + 3, -1)[:, :, : row_width(powers)]
        kept = np.ascontiguousarray(rows)
        kept.flags.writeable = False
        self._cuts[powers, thinning] = kept
        return kept

    def stops(
        self, launches: FloatArray, powers: int = STOP_POWERS, thinning: int = 1
    ) -> tuple[FloatArray, int]:
        """Stop time, x, y (3, n) of checked launches (6, n); how many were too large.

        Parameters
        ----------
        launches : array (6, n): vx, vy, ω, δ, J, r
        powers, thinning : see :meth:`cut`

        Examples
        --------
        >>> from puck_tables import load_stop_table
        >>> launch = np.array([[1.0], [0.0], [5.0], [1.0], [1.0], [1.0]])
        >>> load_stop_table().stops(launch)[0].round(6).ravel().tolist()
        [4.000189, 2.257241, -0.308477]
        """
        out = np.empty((3, launches.shape[1]))
        return out, stops_kernel(powers)(launches, self.cut(powers, thinning), out)

    def known(self, launches: FloatArray) -> FloatArray:
        """What the table knows of checked launches (6, n), see :func:`fill_launches`; (14, n)."""
        from puck_tables.motion.path import TURN_SHARE
        from puck_tables.similarity.curve_lookup import LAUNCH_ROWS, fill_launches

        out = np.empty((LAUNCH_ROWS, launches.shape[1]))
        tables = (
            self.stop_coefficients, self.curve_coefficients, self.turn_inverse, self.constants,
        )  # fmt: skip

        def work(start: int, stop: int) -> None:
            part = np.empty((LAUNCH_ROWS, stop - start))
            fill_launches(np.ascontiguousarray(launches[:, start:stop]), *tables, TURN_SHARE, part)
            out[:, start:stop] = part

        run_chunks(work, launches.shape[1], _CHUNK)
        return out

    def checked_range(self, delta: npt.ArrayLike) -> FloatArray:
        """``delta`` as an array, refused outside the range of the table.

        Raises
        ------
        InputError
        """
        height = checked_delta(delta)
        if not np.all(height <= UPPER_DELTA):
            raise InputError(
                f"delta = {height[height > UPPER_DELTA].flat[0]!s} is outside this table "
                f"(0 <= delta <= {UPPER_DELTA:g}): beyond, the whole base does not stay loaded in "
                "every motion"
            )
        return height

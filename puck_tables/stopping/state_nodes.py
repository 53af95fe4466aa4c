"""The curve of all motions, inverted at the nodes of a stop table: for all of them at once.

From the place by the time that is left, or by Q, back to the ratio of speed and spin, and what
stands there; what it is see :mod:`puck_tables.stopping.similarity_lookup`.  Arrays (2 sides, nodes,
heights).
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.quadratic import basis
from puck_tables.stopping.axes import HEIGHTS, heights
from puck_tables.stopping.similarity_lookup import TINY, end_rates
from puck_tables.table.spline_fit import clamped_coefficients

_TIME, _ALONG, _ACROSS, _LENGTH, _BODY, _CURVE, _TURN = range(7)  # as the table has them
_FAST = np.array([False, True])[:, None, None]  # the side of r|ω| > v
_ROUNDING = 2e-16  # of a double
_LOOKS = 100  # at most


class InverseSolution:
    """Functions of a stop table at its nodes (2, cells + 1, 9, 7), and constants of its heights."""

    def __init__(self, constants: FloatArray, sides: FloatArray) -> None:
        delta = heights()
        self.delta, self.cells = delta, sides.shape[1] - 1
        self.slow, self.fast, self.spin_turn = end_rates(delta)  # type: ignore[arg-type]
        powers = (2.0 * delta * delta - 1.0) ** np.arange(constants.shape[1])[:, None]
        self.c0, self.kappa, turning, self.quarter = constants @ powers
        self.turning = delta * turning
        splines = clamped_coefficients(np.moveaxis(sides, 1, 0)) / 6.0
        self.splines = np.ascontiguousarray(splines.transpose(3, 1, 0, 2))

    def at(self, function: int, xi: FloatArray) -> FloatArray:
        """One function at places on the axis of slip (2, n, heights)."""
        place = xi * self.cells
        cell = np.clip(place.astype(np.int64), 0, self.cells - 1)
        weights = basis(place - cell)
        spline = self.splines[function]
        rows = (np.take_along_axis(spline, cell + k, axis=1) for k in range(4))
        return np.asarray(sum(w * row for w, row in zip(weights, rows, strict=True)))

    def ratios(self, with_time: bool) -> FloatArray:
        """2w/y at the nodes (2, cells + 1, heights), by the time that is left or by Q.

        By secants in a bracket, on the splines themselves, so that forward and back agree.
        """
        nodes = np.maximum(np.arange(self.cells) / self.cells, 1e-6)  # at the end a limit
        target = (4.0 * np.log(nodes * (2.0 - nodes)))[None, :, None]
        shape = (2, self.cells, HEIGHTS)
        place = np.broadcast_to(nodes[None, :, None], shape).copy()
        low, high = np.zeros(shape), np.ones(shape)
        before, off_before = np.full(shape, np.nan), np.full(shape, np.nan)
        result = np.zeros(shape, np.bool_)
        for _ in range(_LOOKS):
            error = self._log_y(place, with_time) - target
            low, high = np.where(error < 0.0, place, low), np.where(error < 0.0, high, place)
            with np.errstate(divide="ignore", invalid="ignore"):
                slope = (error - off_before) / (place - before)
                usual = 8.0 * (1.0 - place) / (place * (2.0 - place))  # were the ratio a constant
                slope = np.where(np.isfinite(slope), slope, usual)
                following = place - error / slope
            inside = (slope > 0.0) & (low < following) & (following < high)
            following = np.where(inside, following, 0.5 * (low + high))
            result |= np.abs(error) <= _ROUNDING * (1.0 - target)
            result |= ~((low < following) & (following < high))
            if result.all():
                break
            before, off_before = place, np.where(result, off_before, error)
            place = np.where(result, place, following)
        ratios = np.ones((2, self.cells + 1, HEIGHTS))
        ratios[:, :-1] = np.exp(4.0 * np.log(place * (2.0 - place)) - target)
        return ratios

    def _log_y(self, xi: FloatArray, with_time: bool) -> FloatArray:
        """Ln y at places on the axis of slip."""
        share = (xi * (2.0 - xi)) ** 4
        c, (plus, minus) = np.where(_FAST, 1.0 - share, share - 1.0), _end_logs(share)
        log_n = np.log(np.abs((c - self.c0) / self.c0)) + self.at(_CURVE, xi)
        log_n -= self.kappa * (plus / self.slow + minus / self.fast)
        if with_time:
            log_n += self.kappa * (np.log(self.at(_TIME, xi)) - self.quarter)
        power = np.exp(-np.abs(log_n))
        large = _FAST & (c > self.c0) & (log_n > 1.0)
        sign = np.where(_FAST & (c > self.c0), 1.0, -1.0)
        moderate = np.log1p(1.0 + sign * np.exp(np.minimum(log_n, np.where(_FAST, 1.0, 0.0))))
        fast = np.where(large, log_n + np.log1p(2.0 * power), moderate)
        return np.asarray(np.where(_FAST, -self.fast * fast, -self.slow * log_n) / self.kappa)

    def splined(self, with_time: bool) -> FloatArray:
        """2w/y, T, along, across, body angle, and the heading's regular part at the nodes.

        (2, cells + 1, heights, 6).
        """
        ratios, xi = self.ratios(with_time), np.arange(self.cells + 1) / self.cells
        share = np.minimum((xi * (2.0 - xi))[None, :, None] ** 4 * ratios, 1.0)
        q = np.sqrt(np.sqrt(share))
        place = 1.0 - np.sqrt((1.0 - share) / ((1.0 + q) * (1.0 + q * q)))
        functions = [self.at(f, place) for f in (_TIME, _ALONG, _ACROSS, _BODY)]
        by_slow, by_fast = self.turning / self.slow, (self.turning - self.spin_turn) / self.fast
        plus, minus = _end_logs(np.maximum(share, TINY))
        log = np.log(ratios)  # what is singular of the log of the share is taken out
        regular = np.where(_FAST, by_slow * plus + by_fast * log, by_slow * log + by_fast * minus)
        if with_time:
            regular -= self.turning * np.log(functions[0])
        regular = regular / self.delta + self.at(_TURN, place)
        return np.stack([ratios, *functions, regular], axis=-1)


def _end_logs(share: FloatArray) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """ln(1 + c) and ln(1 − c) from 2w."""
    small, large = np.log(share), np.log1p(1.0 - share)
    return np.where(_FAST, large, small), np.where(_FAST, small, large)

"""What answers are judged by, from outside the code that gives them.

Resultants: direct quadrature over the patch.  Stops: a file of a thousand launches, computed once
by a script of its own (``tests/golden/make_starts.py``: mpmath, nothing of the package) to 1e-13.
"""

from __future__ import annotations

import io
from dataclasses import dataclass
from importlib.resources import files

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.contact import quadrature
from puck_tables.contact.integrals import slip_direction
from puck_tables.contact.resultants import moment_balance


@dataclass(frozen=True)
class Points:
    """Slip angles and heights (n,), and the resultants there (3, n)."""

    phi: FloatArray
    delta: FloatArray
    resultants: FloatArray

    def errors(self, values: FloatArray) -> FloatArray:
        """The largest error of the three at every point (n,)."""
        error: FloatArray = np.abs(values - self.resultants).max(axis=0)
        return error


@dataclass(frozen=True)
class Starts:
    """Launches at u = ln(rω/v) and δ (n,), and T, X, Y in units of Q/J and Q²/J (n, 3)."""

    u: FloatArray
    delta: FloatArray
    stops: FloatArray

    def launches(self) -> FloatArray:
        """Launches (6, n) along x with Q = J = r = 1."""
        k = np.exp(-np.abs(self.u))
        large = 1.0 / np.hypot(1.0, k)
        one = np.ones_like(k)
        v = np.where(self.u > 0.0, k, one) * large
        rim = np.where(self.u > 0.0, one, k) * large
        return np.stack([v, 0.0 * k, rim, self.delta, one, one])

    def errors(self, values: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Errors of time and place (n,) of stops (3, n); no number is infinitely wrong."""
        off = np.nan_to_num(np.abs(values.T - self.stops), nan=np.inf)
        return off[:, 0], np.hypot(off[:, 1], off[:, 2])

    def some(self, chosen: npt.NDArray[np.bool_] | npt.NDArray[np.int64]) -> Starts:
        """Those that are chosen."""
        return Starts(self.u[chosen], self.delta[chosen], self.stops[chosen])


def golden_starts() -> Starts:
    """The launches that come with the package.

    Examples
    --------
    >>> golden_starts().stops.shape
    (1000, 3)
    """
    content = (files("puck_tables.tables") / "starts.npz").read_bytes()
    with np.load(io.BytesIO(content)) as file:
        return Starts(file["u"], file["delta"], np.stack([file[n] for n in "TXY"], axis=-1))


def random_points(count: int, seed: int = 1832) -> Points:
    """Half of them anywhere, half next to φ = 0, π/4 and π/2, with δ = 0 and 1 among the heights.

    Examples
    --------
    >>> random_points(12).resultants.shape
    (3, 12)
    """
    rng = np.random.default_rng(seed)
    phi = rng.uniform(0.0, 0.5 * np.pi, count)
    near = 10.0 ** -rng.uniform(0.2, 12.0, count)
    place = rng.integers(0, 4, count)
    beside = np.choose(
        place, [near, 0.25 * np.pi - near, 0.25 * np.pi + near, 0.5 * np.pi - near]
    ).clip(0.0, 0.5 * np.pi)
    phi = np.where(np.arange(count) % 2 == 0, phi, beside)
    delta = rng.choice([0.0, 1.0, -1.0], count, p=[0.1, 0.1, 0.8])
    delta = np.where(delta < 0.0, rng.random(count), delta)
    truth = moment_balance(quadrature.integrals(phi), slip_direction(phi), delta)
    return Points(phi, delta, np.stack(truth))

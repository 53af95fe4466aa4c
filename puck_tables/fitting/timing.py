"""Time stamps that jitter: what they add to the noise of places and angles.

A stamp that is off by σ_t moves what is seen by that time along the motion, u = (vx, vy, ω), so a
frame's x, y and angle have the covariance

    C = diag(σ², σ², σ_a²) + σ_t² u uᵀ .

Residuals are made independent along the motion, across it, and for the angle what is left when the
place has told of the time.  σ, σ_a and σ_t that are not given are the most likely ones, from

    −2 ln L = Σ ln det C + rᵀ C⁻¹ r ,   det C = σ⁴ σ_a² (1 + σ_t² (v²/σ² + ω²/σ_a²)) .
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray

_LEAST, _MOST = 1e-4, 30.0  # times the noise of a place over the speed: σ_t is looked for within


class Known(NamedTuple):
    """Whether the noise of places, of angles, and of time stamps is given."""

    place: bool
    angle: bool
    jitter: bool


def weights_of(
    noise: tuple[float, float], jitter: float, rates: FloatArray, placed: npt.NDArray[np.bool_]
) -> FloatArray:
    """What makes x, y and angle of frames independent and of unit variance, (n, 3, 3).

    Parameters
    ----------
    noise : m, rad
    jitter : s
    rates : (3, n), velocity m/s and spin rad/s
    placed : (n,), whether the place counts

    Examples
    --------
    >>> one = weights_of((1e-3, 1e-2), 1e-3, np.array([[0.0], [1.0], [0.0]]), np.array([True]))
    >>> abs(one[0]).sum(axis=1).round(3).tolist()  # along the motion, across it, angle
    [707.107, 1000.0, 100.0]
    """
    vx, vy, spin = rates
    speed = np.hypot(vx, vy)
    still = speed == 0.0
    cosine = np.where(still, 1.0, vx / np.where(still, 1.0, speed))
    sine = np.where(still, 0.0, vy / np.where(still, 1.0, speed))
    along = noise[0] ** 2 + (jitter * speed) ** 2
    turn = noise[1] ** 2 + (jitter * spin) ** 2
    told = np.where(placed, jitter**2 * speed * spin / along, 0.0)
    left = np.sqrt(turn - told**2 * along)
    out = np.zeros((speed.size, 3, 3))
    out[:, 0, 0], out[:, 0, 1] = cosine / np.sqrt(along), sine / np.sqrt(along)
    out[:, 1, 0], out[:, 1, 1] = -sine / noise[0], cosine / noise[0]
    out[:, 2, 0], out[:, 2, 1] = -told * cosine / left, -told * sine / left
    out[:, 2, 2] = 1.0 / left
    return out


def likeliest(
    noise: tuple[float, float], jitter: float, known: Known, deviations: FloatArray, rates:
    FloatArray, kept: npt.NDArray[np.bool_], share: float,
) -> tuple[tuple[float, float], float]:  # fmt: skip
    """The noise of places and angles, and σ_t, under which residuals are most likely.

    Parameters
    ----------
    noise, jitter : to begin with, or as given
    known : which is given
    deviations : (3, n), m and rad, NaN where no angle is
    rates : (3, n)
    kept : (3, n), whether the place along the motion, the angle, the place across it count
    share : of the squares that the unknowns have left
    """
    from scipy.optimize import minimize

    angled = kept[1] & np.isfinite(deviations[2])
    placed = kept[0]
    x, y, turn = (
        np.where(placed, deviations[0], 0.0),
        np.where(placed, deviations[1], 0.0),
        deviations[2],
    )
    turn = np.where(angled, turn, 0.0)
    vx, vy, spin = rates
    speed = float(np.sqrt(np.mean(vx**2 + vy**2))) or 1.0
    usual = noise[0] / speed
    begin = np.log([noise[0], noise[1], jitter if jitter > 0.0 else 0.3 * usual])
    free = [k for k, one in enumerate(known) if not one and (k != 1 or angled.any())]
    if not free:
        return noise, jitter
    factor = 1.0 / share

    def cost(logs: FloatArray) -> float:
        every = begin.copy()
        every[free] = logs
        place, angle, stamp = np.exp(2.0 * every)
        if known.jitter:
            stamp = jitter**2
        gain = placed * (vx**2 + vy**2) / place + angled * spin**2 / angle
        squares = (x**2 + y**2) / place + turn**2 / angle
        ahead = (x * vx + y * vy) / place + turn * spin / angle
        squares -= stamp * ahead**2 / (1.0 + stamp * gain)
        logarithm = (placed.sum() + kept[2].sum()) * math.log(place) + angled.sum() * math.log(
            angle
        )
        return float(logarithm + np.log1p(stamp * gain).sum() + factor * squares.sum())

    bounds = [
        (math.log(_LEAST * usual), math.log(_MOST * usual)) if k == 2
        else (begin[k] - 3.0, begin[k] + 3.0) for k in free
    ]  # fmt: skip
    result = begin.copy()
    result[free] = minimize(cost, begin[free], method="L-BFGS-B", bounds=bounds).x
    place, angle, stamp = np.exp(result).tolist()
    return (place, angle), jitter if known.jitter else stamp

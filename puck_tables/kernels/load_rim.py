"""Sums of the slip direction along the rim of a base, under Hertz's or Galin's pressure.

There the primitives of :mod:`puck_tables.kernels.load_parts` are polynomials in p alone, J_0 =
±(a_0 + a_1 p²), J_2 = ±(b_0 + b_1 p² + b_2 p⁴), − where a ray from C comes in, and J_1 = J_3 = 0.
With c the distance of C, e = (cos τ, sin τ) and p = c sin τ, sums along the rim are integrals over
τ of polynomials in cos τ and sin τ.
"""

from __future__ import annotations

import math

import numpy as np

from puck_tables.kernels.base_sums import HERTZ, Sums, plus
from puck_tables.kernels.compile import inlined, inner
from puck_tables.kernels.elementary import angle_of, cosine_sine_of

_FAR = 4.0  # radii: a C farther away is seen by series in 1/c
_SERIES = np.array([math.comb(2 * k, k) / 4.0**k / (2 * k + 7) for k in range(13)])


@inner
def _primitive(
    alpha: float, beta: float, tau: float, ex: float, ey: float, p: float, law: int
) -> Sums:
    """Of those sums, where rays leave."""
    square = p * p
    if law == HERTZ:
        k = 0.375 * math.pi
        a0, a1, b0, b1, b2 = k, -k, 0.25 * k, -0.5 * k, 0.25 * k
    else:
        k = 0.125 * math.pi
        a0, a1, b0, b1, b2 = 2.0 * k, 0.0, k, -k, 0.0
    # ∫ p^2m and ∫ p^2m sin² τ, over τ; of a far C over c τ
    if alpha < _FAR * beta:
        c = alpha / beta
        along, across, cc, odd = c, 1.0, c * c, ex * ey
        v0 = 0.5 * (tau - odd)
        v1 = 0.25 * (3.0 * v0 - odd * ey * ey)
        v2 = cc * cc * (5.0 * v1 - odd * ey * ey * ey * ey) / 6.0
        h0, h1, h2 = tau, cc * v0, cc * cc * v1
        v1 *= cc
    else:
        near = beta / alpha
        along, across, z, kk = 1.0, near, near * near * square, near * near
        h3 = 0.0
        for i in range(_SERIES.size - 1, -1, -1):
            h3 = h3 * z + _SERIES[i]
        h3 *= square * square * square * p
        h2 = (square * square * p * ex + 6.0 * kk * h3) / 5.0
        h1 = (square * p * ex + 4.0 * kk * h2) / 3.0
        h0 = p * ex + 2.0 * kk * h1
        v0, v1, v2 = kk * h1, kk * h2, kk * h3
    g0, g1, g2 = h0 - v0, h1 - v1, h2 - v2
    torn = across * ((a0 - b1) * g1 + (a1 - b2) * g2 - b0 * g0)
    bent = ey * ey * (0.5 * b0 + square * ((b1 - a0) / 4.0 + square * (b2 - a1) / 6.0))
    return (
        along * (a0 * g0 + a1 * g1),
        ey * p * (0.5 * a0 + 0.25 * a1 * square),
        square * (0.5 * a0 + 0.25 * a1 * square) + bent,
        torn,
        torn + across * (b0 * h0 + b1 * h1 + b2 * h2),
        -bent,
        ey * p * (b0 + square * (0.5 * b1 + square * b2 / 3.0)),
        along * (b0 * (v0 - g0) + b1 * (v1 - g1) + b2 * (v2 - g2)),
    )  # fmt: skip


@inlined
def _at_touch(alpha: float, beta: float, law: int) -> Sums:
    """The primitive where rays from outside touch the base."""
    near = beta / alpha
    across = math.sqrt((1.0 - near) * (1.0 + near))
    return _primitive(alpha, beta, angle_of(near, across), across, near, 1.0, law)


@inlined
def _up_to(alpha: float, beta: float, angle: float, law: int) -> Sums:
    """The sums along the rim up to an angle."""
    x, y = cosine_sine_of(angle)
    turning, away = beta - alpha * y, alpha * x  # the slip along the rim and out of the base
    inverse = 1.0 / math.sqrt(max(turning * turning + away * away, 1e-300))
    ex, ey = (away * x - turning * y) * inverse, (away * y + turning * x) * inverse
    inside = alpha < beta
    tau = angle + 0.5 * math.pi - angle_of(away, turning) if inside else angle_of(ey, ex)
    sums = _primitive(alpha, beta, tau, ex, ey, away * inverse, law)
    after = (angle - 0.5 * math.pi) / (2.0 * math.pi)  # the point of the rim next to C, in laps
    laps = float(np.floor(after)) + 1.0
    if inside or (turning >= 0.0 and laps == 0.0):
        return sums
    side, even, odd = 1.0, 0.0, 4.0 * laps
    if turning < 0.0:
        side, even, odd = -1.0, 2.0, odd + (2.0 if laps - after < 0.5 else -2.0)
    ends = _at_touch(alpha, beta, law)
    return (
        side * sums[0] + odd * ends[0], side * sums[1] + even * ends[1],
        side * sums[2] + even * ends[2], side * sums[3] + odd * ends[3],
        side * sums[4] + odd * ends[4], side * sums[5] + even * ends[5],
        side * sums[6] + even * ends[6], side * sums[7] + odd * ends[7],
    )  # fmt: skip


@inner
def loaded_rim(alpha: float, beta: float, start: float, turn: float, law: int) -> Sums:
    """An arc of the rim from the angle ``start`` over ``turn``."""
    end = _up_to(alpha, beta, start + turn, law)
    return plus(end, -1.0, _up_to(alpha, beta, start, law))

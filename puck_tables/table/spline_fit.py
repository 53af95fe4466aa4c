"""From node values to B-spline coefficients."""

from __future__ import annotations

import numpy as np

from puck_tables._core.arrays import FloatArray


def clamped_coefficients(values: FloatArray) -> FloatArray:
    """Coefficients of the uniform cubic spline with zero slope at both ends, along axis 0.

    Zero slopes make the spline even about both ends: the interpolation conditions
    (c_{i−1} + 4 c_i + c_{i+1})/6 = f_i of the reflected, periodic sequence are a circular
    convolution, divided out by a Fourier transform.

    ``values``: array (n + 1, …).  Returns array (n + 3, …).

    >>> clamped_coefficients(np.ones(5)).round(12).tolist()
    [1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0]
    """
    n = len(values) - 1
    spectrum = np.fft.rfft(np.concatenate([values, values[-2:0:-1]]), axis=0)
    symbol = (4.0 + 2.0 * np.cos(np.pi * np.arange(n + 1) / n)) / 6.0
    spectrum /= symbol.reshape(-1, *([1] * (values.ndim - 1)))
    c = np.fft.irfft(spectrum, 2 * n, axis=0)[: n + 1]
    return np.concatenate([c[1:2], c, c[-2:-1]])


def half_clamped_coefficients(values: FloatArray) -> FloatArray:
    """Coefficients of the uniform cubic spline with zero slope at its start, not-a-knot at its end.

    The clamped spline and a multiple of the one that vanishes at all nodes and is even about the
    start: its coefficients are powers of the root −2 + √3 of 1 + 4x + x² = 0.

    ``values``: array (n + 1, …), n ≥ 3.  Returns array (n + 3, …).

    >>> c = half_clamped_coefficients(np.arange(6.0) ** 2)
    >>> float(((c[1] + 23 * c[2] + 23 * c[3] + c[4]) / 48).round(12))  # at 1.5
    2.25
    """
    clamped = clamped_coefficients(values)
    from_start = np.arange(-1.0, len(values) + 1.0)
    nowhere = _ROOT ** (len(values) - from_start) + _ROOT ** (len(values) + from_start)
    jump = np.tensordot(_JUMP, clamped[-5:], 1) / np.dot(_JUMP, nowhere[-5:])
    return np.asarray(clamped - np.multiply.outer(nowhere, jump), dtype=np.float64)


_ROOT = -2.0 + 3.0**0.5  # of 1 + 4x + x² = 0
_JUMP = (1.0, -4.0, 6.0, -4.0, 1.0)  # of the third derivative at the last inner knots


def sided_coefficients(values: FloatArray, even: bool) -> FloatArray:
    """Coefficients on the sides of singular lines: slopes in ξ vanish at the lines.

    ``values``: array (sides, n + 1, …), from each line outwards; ``even``: whether they also vanish
    at φ = 0 and π/2, where the first and the last side end.  Returns array (sides, n + 3, …).

    >>> sided_coefficients(np.ones((4, 9, 2)), even=True).round(12).max()
    np.float64(1.0)
    """
    ends = (0, len(values) - 1) if even else ()
    return np.stack([
        clamped_coefficients(side) if k in ends else half_clamped_coefficients(side)
        for k, side in enumerate(values)
    ])  # fmt: skip


def height_terms(resultants: FloatArray, delta: FloatArray) -> FloatArray:
    """The friction ratios as polynomials of the height: a₀, a₂, b₁, c₀, c₂ of

        1/ρ_∥ = a₀ + a₂ δ²,    ρ_⊥/ρ_∥ = b₁ δ,    ρ_ω/ρ_∥ = c₀ + c₂ δ² .

    ``resultants``: array (…, n, 3) ρ_∥, ρ_⊥, ρ_ω in full contact; ``delta``: array (n,), the
    heights.  Returns array (…, 5).

    >>> delta = np.linspace(0.0, 1.0, 4)
    >>> sliding = np.stack([0 * delta + 1, delta / 4, (4 - delta**2) / 8], axis=-1)  # at φ = 0
    >>> height_terms(sliding, delta).round(12).tolist()
    [1.0, 0.0, 0.25, 0.5, -0.125]
    """
    parallel, across, spin = np.moveaxis(resultants, -1, 0)
    even = np.linalg.pinv(np.stack([np.ones_like(delta), delta**2]))
    odd = np.linalg.pinv(delta[None, :])
    terms = (1.0 / parallel) @ even, (across / parallel) @ odd, (spin / parallel) @ even
    return np.concatenate(terms, axis=-1)


def ratios_at(terms: FloatArray, delta: float) -> FloatArray:
    """The friction ratios at one height and their derivatives by it, from :func:`height_terms`.

    ``terms`` (n, 5); returns (n, 6).

    >>> ratios_at(np.array([[1.0, 0.0, 0.25, 0.5, -0.125]]), 1.0).tolist()
    [[1.0, 0.25, 0.375, 0.0, 0.25, -0.25]]
    """
    a0, a2, b1, c0, c2 = terms.T
    return np.stack([
        a0 + a2 * delta**2, b1 * delta, c0 + c2 * delta**2, 2.0 * a2 * delta, b1, 2.0 * c2 * delta
    ], axis=-1)  # fmt: skip

"""From node values to B-spline coefficients."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]

_ROUNDING = 2e-14


def clamped_coefficients(values: FloatArray) -> FloatArray:
    """Coefficients of the uniform cubic spline with zero slope at both ends, along axis 0.

    Parameters
    ----------
    values : array (n + 1, …)

    Returns
    -------
    array (n + 3, …)

    Notes
    -----
    Zero slopes make the spline even about both ends: the interpolation conditions
    (c_{i−1} + 4 c_i + c_{i+1})/6 = f_i of the reflected, periodic sequence are a circular
    convolution, divided out by a Fourier transform.

    Examples
    --------
    >>> clamped_coefficients(np.ones(5)).round(12).tolist()
    [1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0]
    """
    n = len(values) - 1
    spectrum = np.fft.rfft(np.concatenate([values, values[-2:0:-1]]), axis=0)
    symbol = (4.0 + 2.0 * np.cos(np.pi * np.arange(n + 1) / n)) / 6.0
    spectrum /= symbol.reshape(-1, *([1] * (values.ndim - 1)))
    c = np.fft.irfft(spectrum, 2 * n, axis=0)[: n + 1]
    return np.concatenate([c[1:2], c, c[-2:-1]])


def not_a_knot_coefficients(values: FloatArray) -> FloatArray:
    """Coefficients of the uniform cubic spline with not-a-knot ends, along axis 0.

    Parameters
    ----------
    values : array (n + 1, …), n ≥ 3

    Returns
    -------
    array (n + 3, …); cubics are reproduced exactly

    Examples
    --------
    >>> c = not_a_knot_coefficients(np.arange(4.0) ** 3)
    >>> float(((c[1] + 23 * c[2] + 23 * c[3] + c[4]) / 48).round(12))  # at 1.5
    3.375
    """
    system = _interpolation(len(values))
    system[0, :5] = system[-1, -5:] = _JUMP
    return _solved(system, values)


def half_clamped_coefficients(values: FloatArray) -> FloatArray:
    """Coefficients of the uniform cubic spline with zero slope at its start, not-a-knot at its end.

    Parameters
    ----------
    values : array (n + 1, …), n ≥ 3

    Returns
    -------
    array (n + 3, …)

    Notes
    -----
    The clamped spline and a multiple of the one that vanishes at all nodes and is even about the
    start: its coefficients are powers of the root −2 + √3 of 1 + 4x + x² = 0.

    Examples
    --------
    >>> c = half_clamped_coefficients(np.arange(6.0) ** 2)
    >>> float(((c[1] + 23 * c[2] + 23 * c[3] + c[4]) / 48).round(12))  # at 1.5
    2.25
    """
    clamped = clamped_coefficients(values)
    from_start = np.arange(-1.0, len(values) + 1.0)
    nowhere = _ROOT ** (len(values) - from_start) + _ROOT ** (len(values) + from_start)
    jump = np.tensordot(_JUMP, clamped[-5:], 1) / np.dot(_JUMP, nowhere[-5:])
    return np.asarray(clamped - np.multiply.outer(nowhere, jump), dtype=np.float64)


_ROOT = -2.0 + 3.0**0.5
_JUMP = (1.0, -4.0, 6.0, -4.0, 1.0)  # of the third derivative at the last inner knots


def _interpolation(size: int) -> FloatArray:
    """The system for coefficients, first and last row left free for the ends."""
    system = np.zeros((size + 2, size + 2))
    rows = np.arange(size)
    for offset, weight in enumerate((1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0)):
        system[rows + 1, rows + offset] = weight
    return system


def _solved(system: FloatArray, values: FloatArray) -> FloatArray:
    right = np.zeros((len(values) + 2, *values.shape[1:]))
    right[1:-1] = values
    flat = np.linalg.solve(system, right.reshape(len(values) + 2, -1))
    return np.asarray(flat, dtype=np.float64).reshape(right.shape)


def table_coefficients(resultants: FloatArray) -> FloatArray:
    """Spline coefficients of the friction ratios from tabulated resultants.

    Parameters
    ----------
    resultants : array (n_phi, n_delta, 3)
        ρ_∥, ρ_⊥, ρ_ω at the nodes.

    Returns
    -------
    array (2, n_delta + 2, n_eta + 3, 3)
        As :mod:`puck_tables.kernels.spline` reads it (B-spline weights over 36); side 0 is
        φ < π/4, η grows away from π/4.

    Examples
    --------
    >>> table_coefficients(np.ones((9, 4, 3))).shape
    (2, 6, 7, 3)
    """
    parallel = resultants[:, :, 0]
    ratios = np.stack(
        [1.0 / parallel, resultants[:, :, 1] / parallel, resultants[:, :, 2] / parallel], axis=-1
    )
    middle = len(ratios) // 2
    sides = np.stack([ratios[middle::-1], ratios[middle:]], axis=1)  # (eta, side, delta, function)
    along_eta = clamped_coefficients(sides)
    along_delta = not_a_knot_coefficients(np.moveaxis(along_eta, 2, 0))
    return np.ascontiguousarray(along_delta.transpose(2, 0, 1, 3)) / 36.0


def quadratic_coefficients(resultants: FloatArray, delta: FloatArray) -> FloatArray | None:
    """The same where the height enters as a polynomial; None where it does not.

    Parameters
    ----------
    resultants : array (n_phi, n_delta, 3)
        ρ_∥, ρ_⊥, ρ_ω at the nodes.
    delta : array (n_delta,)

    Returns
    -------
    array (2, n_eta + 3, 5), as :mod:`puck_tables.kernels.quadratic` reads it, or None

    Examples
    --------
    >>> quadratic_coefficients(np.ones((9, 4, 3)), np.linspace(0.0, 1.0, 4)) is None  # ρ_⊥ ∝ δ
    True
    """
    parallel = resultants[:, :, 0]
    even, odd = np.stack([np.ones_like(delta), delta**2]), delta[None, :]
    terms = []
    for values, powers in (
        (1.0 / parallel, even), (resultants[:, :, 1] / parallel, odd),
        (resultants[:, :, 2] / parallel, even),
    ):  # fmt: skip
        found = values @ np.linalg.pinv(powers)
        if not np.abs(found @ powers - values).max() <= _ROUNDING:
            return None
        terms.append(found)
    functions = np.concatenate(terms, axis=1)
    middle = len(functions) // 2
    sides = np.stack([functions[middle::-1], functions[middle:]], axis=1)
    return np.ascontiguousarray(np.moveaxis(clamped_coefficients(sides), 0, 1)) / 6.0

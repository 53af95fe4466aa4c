"""The equations that stops and the curve satisfy, at every node of a stop table at once.

Along a motion everything goes with ln Q, du/d ln Q = −ρ(u)
(:mod:`puck_tables.stopping.similarity`). What is left of time, way and angle gives, with N as
there, s = sin φ, c = cos φ and dψ/d ln Q = h,

    T − ρ T_u = N/ρ_∥,        (2 + i h) Z − ρ Z_u = c N/ρ_∥   (Z = X + iY),
    2 L − ρ L_u = c N/ρ_∥,    2 Θ − ρ Θ_u = s N/ρ_∥ ,

linear equations with one regular solution each.  Multiplied by du/dξ and with derivatives by ξ from
five neighbouring nodes, what they miss falls like cells⁻⁴ where all values are right; one altered
value is seen from about twice the error of the table on.  No motion is integrated: it takes some
milliseconds.
"""

from __future__ import annotations

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.contact import closed_form
from puck_tables.contact.integrals import PatchIntegrals, SlipDirection
from puck_tables.contact.resultants import moment_balance
from puck_tables.stopping.axes import SlipAxis, heights, ratio_at
from puck_tables.stopping.similarity import limits, regular_slopes

# measured: at most 67 and 1440 times cells⁻⁴ is missed by right values
_MISSED, _MISSED_BY_CURVE, _ROUNDING = 150.0, 3000.0, 1e-10


def missed_by_stops(axis: SlipAxis, values: FloatArray) -> tuple[FloatArray, float]:
    """What the first five functions at the nodes miss of their equations, and what is allowed.

    Parameters
    ----------
    axis : SlipAxis
    values : array (2 cells + 1, 9, 7), as in :class:`puck_tables.stopping.stop_table.StopTable`

    Returns
    -------
    array (2 sides, cells + 1, 9, 5), float

    Examples
    --------
    >>> from puck_tables.stopping.stop_table import StopTable
    >>> table = StopTable.shipped()
    >>> missed, allowed = missed_by_stops(table.axis, table.values)
    >>> bool(missed.max() < allowed < 1e-7)
    True
    """
    xi, k, stretch = _places(axis)
    delta = heights()
    small, large = (k / np.hypot(1.0, k))[:, None], (1.0 / np.hypot(1.0, k))[:, None]
    sides = []
    for fast, side in enumerate((values[: axis.cells + 1], values[: axis.cells - 1 : -1])):
        c, s = (small, large) if fast else (large, small)
        direction = SlipDirection(k[:, None], np.full_like(k[:, None], fast, dtype=np.bool_))
        a, b, d = closed_form.shape_integrals(direction.ratio, np.full_like(direction.ratio, fast))
        rho = moment_balance(PatchIntegrals(a, b, b - d, d, d - 2.0 * b), direction, delta)
        spin = rho.spin / rho.parallel
        norm = 1.0 / (c**2 + s**2 * spin)
        rate, way = (1.0 - spin) * norm, norm / rho.parallel
        turn = s * rho.perpendicular / rho.parallel * norm
        du = stretch[:, None] * (-1.0 if fast else 1.0)
        time, along, across, length, body = np.moveaxis(side[..., :5], -1, 0)
        by_xi = np.moveaxis(_derivative(side[..., :5], xi[1]), -1, 0)
        # of cos φ · along and the like, divided by cos φ; dc/du = −s² c, ds/du = c² s
        cross, both = delta * s, delta * (s * by_xi[2] + du * s * (c**2 - s**2) * across)
        x_by_xi, length_by_xi = by_xi[1] - du * s**2 * along, by_xi[3] - du * s**2 * length
        sides.append(np.stack([
            du * (time - way) - rate * by_xi[0],
            du * (2.0 * along - turn * cross * across - way) - rate * x_by_xi,
            du * (2.0 * cross * across + turn * along) - rate * both,
            du * (2.0 * length - way) - rate * length_by_xi,
            du * (2.0 * body - way) - rate * (by_xi[4] + du * c**2 * body),
        ], axis=-1))  # fmt: skip
    return np.abs(sides), _MISSED / axis.cells**4 + _ROUNDING


def missed_by_curve(axis: SlipAxis, values: FloatArray, height: int) -> tuple[FloatArray, float]:
    """The same of κR and S/δ at one of the nine heights: their slopes are known in closed form.

    Parameters
    ----------
    axis, values : as above
    height : index of the height

    Returns
    -------
    array (2 sides, cells + 1, 2), float

    Examples
    --------
    >>> from puck_tables.stopping.stop_table import StopTable
    >>> table = StopTable.shipped()
    >>> missed, allowed = missed_by_curve(table.axis, table.values, 4)
    >>> bool(missed.max() < allowed < 1e-6)
    True
    """
    xi, k, stretch = _places(axis)
    delta = float(heights()[height])
    own = values[:, height, 5:]
    sides = []
    for fast, side in enumerate((own[: axis.cells + 1], own[: axis.cells - 1 : -1])):
        sign = -1.0 if fast else 1.0
        kappa, by_u = _slopes(sign * np.log(k[1:]), delta)
        missed = _derivative(side, xi[1])
        missed[1:] -= sign * stretch[1:, None] * by_u * np.array([kappa, 1.0 / delta])
        sides.append(missed)
    return np.abs(sides), _MISSED_BY_CURVE / axis.cells**4 + _ROUNDING


def _slopes(u: FloatArray, delta: float) -> tuple[float, FloatArray]:
    """κ, and dR/du and dS/du at u (n,), (n, 2), by series next to the limit."""
    return limits(delta).kappa, np.stack(regular_slopes(u, delta), axis=-1)


def _places(axis: SlipAxis) -> tuple[FloatArray, FloatArray, FloatArray]:
    """ξ, the slip ratio k and d ln k/dξ (0 at the end, where nothing is divided by k)."""
    xi = np.arange(axis.cells + 1) / axis.cells
    k = ratio_at(xi)
    q = xi * (2.0 - xi)
    with np.errstate(divide="ignore", invalid="ignore"):
        stretch = 8.0 * q**3 * 2.0 * (1.0 - xi) / (2.0 - q**4) ** 2 / k
    stretch[0] = 0.0
    return xi, k, stretch


def _derivative(side: FloatArray, step: float) -> FloatArray:
    """Derivatives by ξ of functions at the nodes of a side, whose slopes vanish at its ends."""
    there = np.concatenate([side[2:0:-1], side, side[-2:-4:-1]])
    slope: FloatArray = (there[:-4] - 8.0 * there[1:-3] + 8.0 * there[3:-1] - there[4:]) / (
        12.0 * step
    )
    return slope

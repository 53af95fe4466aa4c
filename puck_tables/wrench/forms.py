"""What planar pushing takes for a limit surface: positive forms of the wrench.

A form q of F_x, F_y and M of order 2, an ellipsoid (Howe and Cutkosky 1996), or 4 (Zhou, Paolini,
Bagnell, Mason 2016) has the surface at q = 1 and the twist along its gradient.  It is fitted by
least squares of the radial error, g = q^(1/order), over wrenches of all directions; a form of order
4 that is not convex is mixed with the square of the ellipsoid until it is.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray, finite_array

_ROUNDS = 6  # of Gauss–Newton steps: four do
_HALVES = 20  # of the share of the ellipsoid
_SLACK = 1e-12  # of the largest curvature: less is rounding


@dataclass(frozen=True, eq=False)
class WrenchForm:
    """A form fitted to a limit surface.

    Parameters
    ----------
    powers : array (m, 3), of F_x, F_y and M, the rows of one sum: 2 or 4
    coefficients : array (m,), with forces over ``unit`` and torques over ``unit·length``
    unit, length : N, m
    error : largest relative error of a wrench, along its own direction
    normal_error : rad, largest angle between the normals of form and surface, in (F_x, F_y, M/l)
    """

    powers: npt.NDArray[np.int64]
    coefficients: FloatArray
    unit: float
    length: float
    error: float = 0.0
    normal_error: float = 0.0
    scale: FloatArray = field(init=False, repr=False)

    def __post_init__(self) -> None:
        scale = np.array([self.unit, self.unit, self.unit * self.length])
        object.__setattr__(self, "scale", scale)

    @property
    def order(self) -> int:
        """2 or 4."""
        return int(self.powers[0].sum())

    def _rows(self, force: npt.ArrayLike, torque: npt.ArrayLike) -> FloatArray:
        pushed, turned = finite_array("force", force, "N"), finite_array("torque", torque, "N m")
        both = np.broadcast_arrays(pushed[..., 0], pushed[..., 1], turned)
        return np.stack(both, axis=-1) / self.scale

    def gauge(self, force: npt.ArrayLike, torque: npt.ArrayLike) -> FloatArray:
        """How large a wrench is: 1 on the surface, less inside; it grows as the wrench.

        Parameters
        ----------
        force : array_like (…, 2), N, in the axes of the base
        torque : array_like (…), N m

        Returns
        -------
        array (…)

        Raises
        ------
        InputError
            If one is not a finite number.

        Examples
        --------
        >>> ball = WrenchForm(2 * np.eye(3, dtype=np.int64), np.ones(3), 2.0, 1.0)
        >>> ball.gauge((0.0, 1.0), 0.0).item()
        0.5
        """
        rows = self._rows(force, torque)
        values: FloatArray = monomials(rows, self.powers) @ self.coefficients
        return np.asarray(values ** (1.0 / self.order))

    def twist(self, force: npt.ArrayLike, torque: npt.ArrayLike) -> tuple[FloatArray, FloatArray]:
        """The slip that such a push leads to, of any length: the gradient of the form.

        Returns
        -------
        velocity (…, 2) and spin (…)

        Examples
        --------
        >>> ball = WrenchForm(2 * np.eye(3, dtype=np.int64), np.ones(3), 2.0, 0.5)
        >>> velocity, spin = ball.twist((0.0, 1.0), 0.25)
        >>> velocity.tolist(), float(spin)
        ([0.0, 0.5], 0.5)
        """
        slip = gradient(self._rows(force, torque), self.powers, self.coefficients) / self.scale
        return slip[..., :2], slip[..., 2]


def ellipsoid(
    points: FloatArray, normals: FloatArray, roots: FloatArray, unit: float, length: float
) -> WrenchForm:
    """The best ellipsoid through points (n, 3) of a surface, whose normals tell how good it is.

    ``roots`` (n,): of what each counts.

    >>> rows = np.random.default_rng(1).normal(size=(200, 3))
    >>> rows /= np.linalg.norm(rows, axis=1)[:, None]
    >>> found = ellipsoid(rows, rows, np.ones(200), 3.0, 0.1)
    >>> found.order, found.error < 1e-12, found.normal_error < 1e-7
    (2, True, True)
    """
    powers = _powers(2)
    return _judged(powers, _fit(points, roots, powers), points, normals, unit, length)


def quartic(
    points: FloatArray, normals: FloatArray, roots: FloatArray, unit: float, length: float
) -> WrenchForm:
    """The best form of order 4 likewise, convex.

    >>> rows = np.random.default_rng(1).normal(size=(200, 3))
    >>> rows /= np.linalg.norm(rows, axis=1)[:, None]
    >>> quartic(rows, rows, np.ones(200), 3.0, 0.1).error < 1e-12  # an ellipsoid is one
    True
    """
    powers = _powers(4)
    best = _fit(points, roots, powers)
    round_ = _square(_fit(points, roots, _powers(2)), powers)
    directions = points / np.linalg.norm(points, axis=1)[:, None]
    one, other = (_hessians(directions, powers, form) for form in (best, round_))

    def is_convex(share: float) -> bool:
        curvature = np.linalg.eigvalsh((1.0 - share) * one + share * other)
        return bool(curvature.min() >= -_SLACK * curvature.max())

    low, high = 0.0, 0.0 if is_convex(0.0) else 1.0
    for _ in range(_HALVES if high > 0.0 else 0):
        share = 0.5 * (low + high)
        low, high = (low, share) if is_convex(share) else (share, high)
    return _judged(powers, (1.0 - high) * best + high * round_, points, normals, unit, length)


def monomials(rows: FloatArray, powers: npt.NDArray[np.int64]) -> FloatArray:
    """Products of powers (…, m) of rows (…, 3).

    >>> monomials(np.array([2.0, 3.0, 1.0]), np.array([[2, 0, 0], [1, 1, 0]])).tolist()
    [4.0, 6.0]
    """
    of = rows[..., None] ** np.arange(powers.max() + 1.0)
    values: FloatArray = (
        of[..., 0, powers[:, 0]] * of[..., 1, powers[:, 1]] * of[..., 2, powers[:, 2]]
    )
    return values


def gradient(
    rows: FloatArray, powers: npt.NDArray[np.int64], coefficients: FloatArray
) -> FloatArray:
    """The gradient (…, 3) of a form at rows (…, 3).

    >>> gradient(np.array([2.0, 3.0, 1.0]), np.array([[2, 0, 0], [1, 1, 0]]), np.ones(2)).tolist()
    [7.0, 2.0, 0.0]
    """
    parts = [_along(powers, coefficients, axis) for axis in range(3)]
    return np.stack([monomials(rows, p) @ c for p, c in parts], axis=-1)


def _along(
    powers: npt.NDArray[np.int64], coefficients: FloatArray, axis: int
) -> tuple[npt.NDArray[np.int64], FloatArray]:
    """The derivative of a form along an axis."""
    lower = powers.copy()
    lower[:, axis] = np.maximum(lower[:, axis] - 1, 0)
    return lower, coefficients * powers[:, axis]


def _powers(order: int) -> npt.NDArray[np.int64]:
    return np.array(
        [(i, k, order - i - k) for i in range(order + 1) for k in range(order + 1 - i)], np.int64
    )


def _fit(points: FloatArray, roots: FloatArray, powers: npt.NDArray[np.int64]) -> FloatArray:
    """Coefficients of the least squares of 1/g − 1."""
    order, parts = int(powers[0].sum()), monomials(points, powers)
    coefficients = _least_squares(roots[:, None] * parts, roots)
    for _ in range(_ROUNDS):
        g = np.maximum(parts @ coefficients, 1e-3) ** (1.0 / order)
        change = parts * (-roots * g ** -(order + 1.0) / order)[:, None]
        coefficients = coefficients - _least_squares(change, roots * (1.0 / g - 1.0))
    return coefficients


def _least_squares(parts: FloatArray, wanted: FloatArray) -> FloatArray:
    return np.asarray(np.linalg.solve(parts.T @ parts, parts.T @ wanted))  # rounds make it right


def _square(two: FloatArray, powers: npt.NDArray[np.int64]) -> FloatArray:
    """The square of a form of order 2 as one of order 4."""
    place = {tuple(row): i for i, row in enumerate(powers.tolist())}
    coefficients = np.zeros(len(powers))
    for one, a in zip(_powers(2), two, strict=True):
        for other, b in zip(_powers(2), two, strict=True):
            coefficients[place[tuple((one + other).tolist())]] += a * b
    return coefficients


def _hessians(
    directions: FloatArray, powers: npt.NDArray[np.int64], coefficients: FloatArray
) -> FloatArray:
    """Second derivatives (n, 3, 3) of a form in directions (n, 3)."""
    hessian = np.empty((len(directions), 3, 3))
    for axis in range(3):
        hessian[:, axis] = gradient(directions, *_along(powers, coefficients, axis))
    return hessian


def _judged(
    powers: npt.NDArray[np.int64], coefficients: FloatArray, points: FloatArray,
    normals: FloatArray, unit: float, length: float,
) -> WrenchForm:  # fmt: skip
    """A form, and how far it is off."""
    g = (monomials(points, powers) @ coefficients) ** (1.0 / powers[0].sum())
    normal = gradient(points, powers, coefficients)
    across = np.linalg.norm(np.cross(normal, normals), axis=1)
    turned = np.arctan2(across, np.einsum("ni,ni->n", normal, normals))
    error = float(np.abs(1.0 / g - 1.0).max())
    return WrenchForm(powers, coefficients, unit, length, error, float(turned.max()))

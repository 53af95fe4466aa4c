"""What planar pushing takes for a limit surface: an ellipsoid, and a convex polynomial of order 4.

Both are a positive form g of the wrench, homogeneous, with the surface at g = 1 and the twist along
its gradient.  Of a round puck g depends on F = |(F_x, F_y)| and M alone:

    ellipsoid (Howe and Cutkosky 1996)           g² = (F/a)² + (M/b)²,
    order 4 (Zhou, Paolini, Bagnell, Mason 2016)  g⁴ = A F⁴ + B F² M² + C M⁴,

convex exactly for A, C > 0 and 0 ≤ B ≤ 6 √(A C) (its Hessian is then nowhere negative).  They are
fitted by least squares of the radial error 1/g − 1 over the wrenches of the curve.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.optimize import least_squares

from puck_tables._core.arrays import FloatArray
from puck_tables._core.real import finite_array

_MOST_CROSS = 6.0  # B/√(A C) of a convex form


@dataclass(frozen=True)
class SurfaceModel:
    """A form fitted to a limit surface.

    Parameters
    ----------
    order : 2 or 4
    a, b : N, N m
        The force without torque and the torque without force.
    cross : B/√(A C) of order 4; 2 for the ellipsoid
    error : largest relative error of a wrench, along its own direction
    normal_error : rad, largest angle between the normals of model and surface, in (F, M/r)
    """

    order: int
    a: float
    b: float
    cross: float
    error: float
    normal_error: float

    @property
    def coefficients(self) -> tuple[float, ...]:
        """Of F², M² (order 2), or F⁴, F² M², M⁴ (order 4), in N and N m."""
        if self.order == 2:
            return self.a**-2, self.b**-2
        return self.a**-4, self.cross * self.a**-2 * self.b**-2, self.b**-4

    @property
    def formula(self) -> str:
        """In words."""
        if self.order == 2:
            return f"(F/{self.a:.5g})^2 + (M/{self.b:.5g})^2 = 1"
        return (
            f"(F/{self.a:.5g})^4 + {self.cross:.5g} (F/{self.a:.5g})^2 (M/{self.b:.5g})^2 + "
            f"(M/{self.b:.5g})^4 = 1"
        )

    def _scaled(self, force: npt.ArrayLike, torque: npt.ArrayLike) -> tuple[FloatArray, FloatArray]:
        force, torque = finite_array("force", force, "N"), finite_array("torque", torque, "N m")
        return force / self.a, torque / self.b

    def gauge(self, force: npt.ArrayLike, torque: npt.ArrayLike) -> FloatArray:
        """How large a wrench is: 1 on the surface, less inside.

        Parameters
        ----------
        force, torque : arrays of one shape, N, N m

        Returns
        -------
        array of that shape

        Raises
        ------
        InputError
            If one is not a finite number.

        Examples
        --------
        >>> SurfaceModel(2, 2.0, 1.0, 2.0, 0.0, 0.0).gauge(1.0, 0.0).item()
        0.5
        """
        return _gauge(*self._scaled(force, torque), self.cross)

    def twist(self, force: npt.ArrayLike, torque: npt.ArrayLike) -> tuple[FloatArray, FloatArray]:
        """The direction of slip under a wrench: the gradient of the gauge, (v, ω) of any length.

        Of no wrench there is none: (0, 0).

        Examples
        --------
        >>> v, w = SurfaceModel(2, 2.0, 1.0, 2.0, 0.0, 0.0).twist(1.0, 0.5)
        >>> float(w / v)
        2.0
        """
        f, m = self._scaled(force, torque)
        return (2.0 * f**3 + self.cross * f * m**2) / self.a, (
            2.0 * m**3 + self.cross * f**2 * m
        ) / self.b


def _gauge(f: FloatArray, m: FloatArray, cross: float) -> FloatArray:
    return np.asarray((f**4 + cross * f**2 * m**2 + m**4) ** 0.25)


def ellipsoid(section: FloatArray, unit: float, radius: float) -> SurfaceModel:
    """The best ellipsoid, by least squares of the radial error.

    Parameters
    ----------
    section : array (4, n)
        F over ``unit``, M over ``unit·radius``, and the outward normals of that curve.

    Examples
    --------
    >>> phi = np.linspace(-np.pi / 2, np.pi / 2, 91)
    >>> circle = np.stack([np.cos(phi), np.sin(phi), np.cos(phi), np.sin(phi)])
    >>> found = ellipsoid(circle, 3.0, 0.5)
    >>> round(found.a, 6), round(found.b, 6), found.error < 1e-9, found.normal_error < 1e-9
    (3.0, 1.5, True, True)
    """
    return _fit(2, section, unit, radius)


def quartic(section: FloatArray, unit: float, radius: float) -> SurfaceModel:
    """The best convex polynomial of order 4, by least squares of the radial error.

    Examples
    --------
    >>> phi = np.linspace(-np.pi / 2, np.pi / 2, 91)
    >>> circle = np.stack([np.cos(phi), np.sin(phi), np.cos(phi), np.sin(phi)])
    >>> round(quartic(circle, 3.0, 0.5).cross, 6)  # an ellipsoid is one
    2.0
    """
    return _fit(4, section, unit, radius)


def _fit(order: int, section: FloatArray, unit: float, radius: float) -> SurfaceModel:
    force, torque, normal_force, normal_torque = section
    top = float(np.max(np.abs(torque)))
    count = 2 if order == 2 else 3
    # points count by the angle that they cover, seen from the middle of the scaled curve
    weight = np.sqrt(np.abs(np.gradient(np.arctan2(torque / top, force))))

    def missed(parameters: FloatArray) -> FloatArray:
        a, b, cross = [*parameters, 2.0][:3]
        return np.asarray(weight * (1.0 / _gauge(force / a, torque / b, cross) - 1.0))

    start, low = [1.0, top, 2.0][:count], [0.1, 0.1 * top, 0.0][:count]
    high = [10.0, 10.0 * top, _MOST_CROSS][:count]
    found = least_squares(missed, start, bounds=(low, high), xtol=1e-14, ftol=1e-14, gtol=1e-14).x
    a, b, cross = [float(x) for x in [*found, 2.0][:3]]
    error = float(np.abs(1.0 / _gauge(force / a, torque / b, cross) - 1.0).max())
    by_force, by_torque = SurfaceModel(order, a, b, cross, error, 0.0).twist(force, torque)
    turn = np.arctan2(by_torque, by_force) - np.arctan2(normal_torque, normal_force)
    turned = float(np.abs(np.arctan2(np.sin(turn), np.cos(turn))).max())
    return SurfaceModel(order, a * unit, b * unit * radius, cross, error, turned)

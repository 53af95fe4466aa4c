"""The limit surface: what force and torque friction takes up, over the direction of slip.

With the twist (v, ω) = Q (cos φ, sin φ/r), v along x, a pusher that keeps the slip going gives

    F_x = f N cos φ ρ_∥,   F_y = f N sin φ cos φ ρ_⊥,   M = ½ f N r sin φ ρ_ω.

Turned about the axis of the torque this curve is the surface.  For δ = 0 it is convex, F_y = 0, and
the twist is its outward normal: of all wrenches inside, the one on it takes the most power
(Goyal, Ruina, Papadopoulos 1991).  For δ > 0 friction tilts the load, and neither holds exactly.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables._core.real import real
from puck_tables.contact.laws import Law
from puck_tables.errors import InputError
from puck_tables.io.dataset import Dataset, variable
from puck_tables.wrench.base_surface import BaseSurface, base_surface
from puck_tables.wrench.friction_force import wrenches
from puck_tables.wrench.friction_surface import FrictionSurface
from puck_tables.wrench.models import SurfaceModel, ellipsoid, quartic

if TYPE_CHECKING:
    from puck_tables.motion.puck_spec import PuckSpec

LEAST, MOST, OF_A_ROUND = 5, 1_000_001, 181  # points of a curve
MOST_OF_A_BASE, OF_A_BASE = 1001, 31  # slip angles of a surface
_FINE = 1441  # angles for what does not depend on how many were asked for
_STEP = 1e-5  # rad, of differences for the normals
_COLUMNS = ("force_x", "force_y", "torque", "normal_force", "normal_torque")


@dataclass(frozen=True, eq=False, repr=False)
class LimitSurface(FrictionSurface):
    """Force and torque that friction takes up, over the direction of slip.

    Attributes
    ----------
    puck : Puck
    slip_angle : array (n,), rad
        φ = atan2(rω, v), from −π/2 to π/2, for a velocity along x.
    force_x, force_y, torque : arrays (n,), N, N, N m
        What a pusher gives that keeps this slip going; friction on the puck is against it.  With
        the mass of the puck, 1 kg where none was given; over ``unit_force`` f m g pure numbers.
    normal_force, normal_torque : arrays (n,)
        Outward unit normal of the surface in (|F|, M/r), good to 1e-6 but on singular lines of the
        pressure law.  For δ = 0 it is the twist, (cos φ, sin φ).
    ellipsoid, quartic : Model
        What planar pushing takes for the surface, fitted to it, with their errors.
    """

    slip_angle: FloatArray
    force_x: FloatArray
    force_y: FloatArray
    torque: FloatArray
    normal_force: FloatArray = field(repr=False)
    normal_torque: FloatArray = field(repr=False)

    picture: ClassVar[str] = "limit_surface"

    def __repr__(self) -> str:
        return self._said(f"delta = {self.puck.delta:.6g}")

    @cached_property
    def _section(self) -> FloatArray:
        """|F|, M/r over f m g and the normals at many angles, (4, n): the models are its own."""
        phi = np.linspace(-0.5 * np.pi, 0.5 * np.pi, _FINE)
        law, delta = self.puck.body.law, self.puck.delta
        along, across, turning = wrenches(law, delta, phi)
        return np.stack([np.hypot(along, across), turning, *_normals(law, delta, phi)])

    @cached_property
    def ellipsoid(self) -> SurfaceModel:
        """The best ellipsoid (F/a)² + (M/b)² = 1, by least squares of the radial error."""
        return ellipsoid(self._section, self.unit_force, self.puck.radius)

    @cached_property
    def quartic(self) -> SurfaceModel:
        """The best convex polynomial of order 4, A F⁴ + B F² M² + C M⁴ = 1, likewise."""
        return quartic(self._section, self.unit_force, self.puck.radius)

    @property
    def is_convex(self) -> bool:
        """Whether the surface is convex: its tangent turns one way, but for rounding.

        Examples
        --------
        >>> from puck_tables import Puck
        >>> Puck.similar(delta=0.0).limit_surface().is_convex
        True
        """
        f, m = np.diff(self._section[:2])
        return bool(np.all(f[:-1] * m[1:] - f[1:] * m[:-1] >= -1e-15))

    def explain(self) -> str:
        """How it was got, and how well the models fit."""
        one, two = self.ellipsoid, self.quartic
        return (
            f"friction of the law {self.puck.body.law.name}, delta = {self.puck.delta:.6g}; "
            f"{'convex' if self.is_convex else 'not convex'}\n"
            f"ellipsoid {one.formula}: off by at most {100.0 * one.error:.2g} % of the wrench, "
            f"normals by {math.degrees(one.normal_error):.2g} deg\n"
            f"quartic {two.formula}: off by at most {100.0 * two.error:.2g} %, normals by "
            f"{math.degrees(two.normal_error):.2g} deg"
        )

    def dataset(self) -> Dataset:
        """Forces, torques and normals over the slip angle."""
        dims = ("slip_angle",)
        columns = {name: variable(name, getattr(self, name), dims) for name in _COLUMNS}
        axes = {"slip_angle": variable("slip_angle", self.slip_angle, dims)}
        return Dataset(axes, columns, {
            "title": "Limit surface of a puck", **self.puck.described(),
            "unit_force": self.unit_force,
            "ellipsoid": list(self.ellipsoid.coefficients),
            "ellipsoid_error": self.ellipsoid.error,
            "quartic": list(self.quartic.coefficients), "quartic_error": self.quartic.error,
        })  # fmt: skip


def limit_surface(puck: PuckSpec, count: int | None) -> LimitSurface | BaseSurface:
    """The limit surface of a puck, as :meth:`puck_tables.Puck.limit_surface` has it."""
    if count is None:
        count = OF_A_ROUND if puck.shape is None else OF_A_BASE
    number, most = real("n", count, "points"), MOST if puck.shape is None else MOST_OF_A_BASE
    if not (number == int(number) and LEAST <= number <= most):
        raise InputError(f"n must be a whole number from {LEAST} to {most}, got {count}")
    if puck.friction == 0.0:
        raise InputError("a puck with friction = 0 has no limit surface: give friction > 0")
    if puck.shape is not None:
        return base_surface(puck, int(number))
    phi = np.linspace(-0.5 * np.pi, 0.5 * np.pi, int(number))
    law, delta, unit = puck.body.law, puck.delta, puck.mass * puck.decel
    along, across, turning = wrenches(law, delta, phi)
    normal = _normals(law, delta, phi)
    return LimitSurface(
        puck, phi, unit * along, unit * across, unit * puck.radius * turning, normal[0], normal[1]
    )


def _normals(law: Law, delta: float, phi: FloatArray) -> FloatArray:
    """Outward unit normals of the curve (|F|, M/r), array (2, n)."""
    end = 0.5 * np.pi
    inside = np.clip(phi, -end + _STEP, end - _STEP)

    def section_at(angle: FloatArray) -> FloatArray:
        along, across, turning = wrenches(law, delta, np.clip(angle, -end, end))
        return np.stack([np.hypot(along, across), turning])

    tangent = section_at(inside + _STEP) - section_at(inside - _STEP)
    normal: FloatArray = np.stack([tangent[1], -tangent[0]]) / np.hypot(*tangent)
    normal[:, np.abs(phi) == end] = 0.0  # there F vanishes like cos φ, and M is level
    normal[1] = np.where(np.abs(phi) == end, np.sign(phi), normal[1])
    return normal

"""The limit surface of a puck on a base: over the direction of slip and its share of spin.

With the twist Q (cos φ cos ψ, cos φ sin ψ, sin φ/k), ψ its direction in the axes of the base and k
the radius of gyration, a pusher that keeps the slip going gives the force and torque of
:meth:`puck_tables.Puck.wrench`, the other way.  Of a flat body the surface is convex, and the twist
its outward normal; C in a foot is a facet.  Where friction tilts the load neither holds exactly.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.io.dataset import Dataset, variable
from puck_tables.wrench.forms import WrenchForm, ellipsoid, quartic
from puck_tables.wrench.friction_force import wrench
from puck_tables.wrench.friction_hold import holds, twist
from puck_tables.wrench.friction_surface import FrictionSurface

if TYPE_CHECKING:
    from puck_tables.motion.puck_spec import PuckSpec

_DIRECTIONS = 2000  # of wrenches, for models and convexity
_SLACK = 1e-9  # of f m g: so much a convex surface may seem to bend in
_COLUMNS = ("force_x", "force_y", "torque", "normal_x", "normal_y", "normal_torque")


@dataclass(frozen=True, eq=False, repr=False)
class BaseSurface(FrictionSurface):
    """Force and torque that friction takes up under a base, over the twist.

    Attributes
    ----------
    puck : Puck
    heading : array (m,), rad
        ψ, of the slip in the axes of the base.
    slip_angle : array (n,), rad
        φ = atan2(kω, v), from −π/2 to π/2, k the radius of gyration.
    force_x, force_y, torque : arrays (m, n), N, N, N m
        What a pusher gives that keeps this slip going, in the axes of the base.
    normal_x, normal_y, normal_torque : arrays (m, n)
        Outward unit normal of the surface in (F_x, F_y, M/k); of a flat body it is the twist.
    ellipsoid, quartic : WrenchForm
        What planar pushing takes for the surface, fitted to it, with their errors.
    """

    heading: FloatArray
    slip_angle: FloatArray
    force_x: FloatArray
    force_y: FloatArray
    torque: FloatArray
    normal_x: FloatArray = field(repr=False)
    normal_y: FloatArray = field(repr=False)
    normal_torque: FloatArray = field(repr=False)

    picture: ClassVar[str] = "base_surface"

    def __repr__(self) -> str:
        return self._said(_named(self.puck))

    @cached_property
    def _sampled(self) -> tuple[FloatArray, FloatArray]:
        """Points (n, 3) of it over f m g and k in all directions of wrenches, and its normals."""
        length = self.puck.inertia_radius
        z = 1.0 - (2.0 * np.arange(_DIRECTIONS) + 1.0) / _DIRECTIONS
        turn = np.arange(_DIRECTIONS) * math.pi * (3.0 - math.sqrt(5.0))  # Fibonacci's lattice
        rows = np.stack([*(np.sqrt(1.0 - z * z) * (np.cos(turn), np.sin(turn))), z], axis=1)
        torque = length * rows[:, 2]
        margin = holds(self.puck, rows[:, :2], torque, 0.0).margin / self.unit_force
        found = twist(self.puck, -rows[:, :2], -torque, 0.0)
        return margin[:, None] * rows, _normals(self.puck, found.velocity, found.spin)

    @cached_property
    def ellipsoid(self) -> WrenchForm:
        """The best ellipsoid, by least squares of the radial error."""
        return ellipsoid(*self._sampled, self.unit_force, self.puck.inertia_radius)

    @cached_property
    def quartic(self) -> WrenchForm:
        """The best convex form of order 4 likewise."""
        return quartic(*self._sampled, self.unit_force, self.puck.inertia_radius)

    @cached_property
    def is_convex(self) -> bool:
        """Whether the surface is convex: all of it lies behind each of its tangent planes.

        Examples
        --------
        >>> from puck_tables import Puck
        >>> Puck(base="box:0.2x0.1", friction=0.3).limit_surface(7).is_convex
        True
        """
        points, normals = self._sampled
        beyond = points @ normals.T - np.einsum("ni,ni->n", points, normals)
        return bool(beyond.max() <= _SLACK)

    def explain(self) -> str:
        """How it was got, and how well the models fit."""
        lines = [
            f"friction under {_named(self.puck)}; {'convex' if self.is_convex else 'not convex'}"
        ]
        for name, form in (("ellipsoid", self.ellipsoid), ("quartic", self.quartic)):
            lines.append(
                f"{name}: off by at most {100.0 * form.error:.2g} % of the wrench, normals by "
                f"{math.degrees(form.normal_error):.2g} deg"
            )
        return "\n".join(lines)

    def dataset(self) -> Dataset:
        """Forces, torques and normals over the twist."""
        dims = ("heading", "slip_angle")
        columns = {name: variable(name, getattr(self, name), dims) for name in _COLUMNS}
        axes = {name: variable(name, getattr(self, name), (name,)) for name in dims}
        return Dataset(axes, columns, {
            "title": "Limit surface of a puck", **self.puck.described(),
            "unit_force": self.unit_force,
            "ellipsoid": self.ellipsoid.coefficients.tolist(),
            "ellipsoid_error": self.ellipsoid.error,
            "quartic": self.quartic.coefficients.tolist(), "quartic_error": self.quartic.error,
        })  # fmt: skip


def base_surface(puck: PuckSpec, count: int) -> BaseSurface:
    """The limit surface of a puck on a base, as :meth:`puck_tables.Puck.limit_surface` has it."""
    phi = np.linspace(-0.5 * np.pi, 0.5 * np.pi, count)
    psi = np.linspace(-np.pi, np.pi, 2 * count - 1)
    cosine = np.where(np.abs(phi) == 0.5 * np.pi, 0.0, np.cos(phi))
    directions = np.stack([np.cos(psi), np.sin(psi)], axis=-1)
    velocity = cosine[None, :, None] * directions[:, None]
    spin = np.broadcast_to(np.sin(phi) / puck.inertia_radius, velocity.shape[:2])
    found = wrench(puck, velocity, spin, 0.0, False)
    normal = _normals(puck, velocity, spin)
    return BaseSurface(
        puck, psi, phi, -found.force[..., 0], -found.force[..., 1], -found.torque,
        normal[..., 0], normal[..., 1], normal[..., 2],
    )  # fmt: skip


def _normals(puck: PuckSpec, velocity: FloatArray, spin: FloatArray) -> FloatArray:
    """Outward unit normals (…, 3), in (F_x, F_y, M/k), where friction is that of twists.

    Friction does not change along the twist t, and by J dt it moves in the surface; so the
    cofactors of J, scaled, are n ⊗ t.
    """
    scale = np.array([1.0, 1.0, puck.inertia_radius])
    slip = np.concatenate([velocity, spin[..., None]], axis=-1) * scale
    slip = slip / np.linalg.norm(slip, axis=-1)[..., None]
    if puck.lever == 0.0:
        twists: FloatArray = slip
        return twists
    found = wrench(puck, velocity, spin, 0.0, True)
    assert found.jacobian is not None
    slopes = found.jacobian / scale / scale[:, None]
    columns = np.moveaxis(slopes, -1, 0)
    normal = sum(
        slip[..., i, None] * np.cross(columns[(i + 1) % 3], columns[(i + 2) % 3]) for i in range(3)
    )
    back = np.concatenate([found.force, found.torque[..., None]], axis=-1) / scale
    outward = -np.sign(np.einsum("...i,...i->...", back, normal))
    unit: FloatArray = normal * (outward / np.linalg.norm(normal, axis=-1))[..., None]
    return unit


def _named(puck: PuckSpec) -> str:
    assert puck.shape is not None
    tall = f", f h/2 = {puck.lever:.6g} m" if puck.lever else ", flat"
    return f"the base {puck.shape.name}{tall}"

"""The limit surface: what force and torque friction takes up, over the direction of slip.

With the twist Q (cos φ cos ψ, cos φ sin ψ, sin φ/ℓ), ψ its direction in the axes of the base, ℓ the
radius of a round puck or the radius of gyration of another base, a pusher that keeps the slip going
gives the force and torque of :meth:`puck_tables.Puck.wrench`, the other way.  Of a flat body the
surface is convex, and the twist is its outward normal: of all wrenches inside, the one on it takes
the most power (Goyal, Ruina, Papadopoulos 1991); a centre of rotation in a foot is a facet.  Where
friction tilts the load neither holds exactly.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from puck_tables._core.arrays import FloatArray, whole
from puck_tables.errors import InputError
from puck_tables.io.columns import Dataset, following, variable
from puck_tables.result import Result
from puck_tables.wrench.forms import WrenchForm, ellipsoid, quartic
from puck_tables.wrench.friction_hold import holds, of_round, slip_length, twist, wrench

if TYPE_CHECKING:
    from puck_tables.motion.puck_spec import PuckSpec

LEAST, MOST, OF_A_ROUND = 5, 1_000_001, 181  # slip angles
MOST_OF_A_BASE, OF_A_BASE = 1001, 31  # points along a side of its grid: at most, unasked
# wrenches for models and convexity: slip angles by headings, enough for all products of order 8;
# directions in which those of a base lie
_ANGLES, _HEADINGS, _DIRECTIONS = 181, 9, 2000
_SLACK = 1e-9  # of f m g: so much a convex surface may seem to bend in
_COLUMNS = ("force_x", "force_y", "torque", "normal_x", "normal_y", "normal_torque")


@dataclass(frozen=True, eq=False, repr=False)
class LimitSurface(Result):
    """Force and torque that friction takes up, over the direction of slip.

    Attributes
    ----------
    puck : Puck
    heading : array (m,), rad, or None
        ψ, of the slip in the axes of the base; of a round puck None, its slip is along x.
    slip_angle : array (n,), rad
        φ = atan2(ℓω, v), from −π/2 to π/2; ℓ is the radius of a round puck, or the radius of
        gyration.
    force_x, force_y, torque : arrays (m, n), of a round puck (n,); N, N, N m
        What a pusher gives that keeps this slip going; friction on the puck is against it.  With
        the mass of the puck, 1 kg where none was given; over ``unit_force`` f m g pure numbers.
    normal_x, normal_y, normal_torque : arrays of the same shape
        Outward unit normal of the surface in (F_x, F_y, M/ℓ), good to 1e-6 but on singular lines of
        a pressure law; of a flat body it is the twist.
    ellipsoid, quartic : WrenchForm
        What planar pushing takes for the surface, fitted to it, with their errors.
    """

    puck: PuckSpec
    heading: FloatArray | None
    slip_angle: FloatArray
    force_x: FloatArray
    force_y: FloatArray
    torque: FloatArray
    normal_x: FloatArray = field(repr=False)
    normal_y: FloatArray = field(repr=False)
    normal_torque: FloatArray = field(repr=False)

    picture: ClassVar[str] = "limit_surface"

    def __getattr__(self, name: str) -> FloatArray:
        """A column that follows from others: ``force``, N."""
        return following(self, name)

    def __repr__(self) -> str:
        return f"LimitSurface({self.torque.size} twists, {_named(self.puck)}, {self._largest})"

    def __str__(self) -> str:
        return self.explain()

    @property
    def _largest(self) -> str:
        """How large forces and torques are, in words."""
        return f"up to {np.max(self.force):.6g} N and {np.max(self.torque):.6g} N m"

    @property
    def unit_force(self) -> float:
        """F m g, N: what slides without spin."""
        return self.puck.mass * self.puck.decel

    @cached_property
    def _sampled(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Points (n, 3) of it over f m g and ℓ, its normals, and the roots of weights (n,)."""
        if self.puck.shape is None:
            phi = np.linspace(-0.5 * np.pi, 0.5 * np.pi, _ANGLES)
            parts = _of_twists(self.puck, np.zeros(1), phi)[0]
            scaled = np.arctan2(parts[:, 2] / parts[-1, 2], np.hypot(parts[:, 0], parts[:, 1]))
            share = np.sqrt(np.gradient(scaled) * len(scaled))  # of the angle that each covers
            turn = 2.0 * np.pi * np.arange(_HEADINGS) / _HEADINGS
            c, s, none = np.cos(turn), np.sin(turn), 0.0 * turn
            about = np.array([[c, s, none], [-s, c, none], [none, none, none + 1.0]])
            turned = np.einsum("npi,ijk->kpnj", parts.reshape(-1, 2, 3), about)
            points, normals = turned.swapaxes(0, 1).reshape(2, -1, 3)
            return points, normals, np.tile(share, _HEADINGS)
        length = self.puck.inertia_radius
        z = 1.0 - (2.0 * np.arange(_DIRECTIONS) + 1.0) / _DIRECTIONS
        around = np.arange(_DIRECTIONS) * math.pi * (3.0 - math.sqrt(5.0))  # Fibonacci's lattice
        rows = np.stack([*(np.sqrt(1.0 - z * z) * (np.cos(around), np.sin(around))), z], axis=1)
        torque = length * rows[:, 2]
        margin = holds(self.puck, rows[:, :2], torque, 0.0).margin / self.unit_force
        slips = twist(self.puck, -rows[:, :2], -torque, 0.0)
        slip = np.concatenate([slips.velocity, slips.spin[:, None]], axis=1)
        return margin[:, None] * rows, _normals(self.puck, slip), np.ones(_DIRECTIONS)

    @cached_property
    def ellipsoid(self) -> WrenchForm:
        """The best ellipsoid, by least squares of the radial error."""
        return ellipsoid(*self._sampled, self.unit_force, slip_length(self.puck))

    @cached_property
    def quartic(self) -> WrenchForm:
        """The best convex form of order 4 likewise."""
        return quartic(*self._sampled, self.unit_force, slip_length(self.puck))

    @cached_property
    def is_convex(self) -> bool:
        """Whether the surface is convex: all of it lies behind each of its tangent planes.

        >>> from puck_tables import Puck
        >>> Puck(base="box:0.2x0.1", friction=0.3).limit_surface(7).is_convex
        True
        """
        points, normals, _ = self._sampled
        beyond = points @ normals.T - np.einsum("ni,ni->n", points, normals)
        return bool(beyond.max() <= _SLACK)

    def explain(self) -> str:
        """How it was got, and how well the models fit."""
        lines = [
            f"friction under {_named(self.puck)}; {'convex' if self.is_convex else 'not convex'}; "
            f"{self._largest}"
        ]
        for name, form in (("ellipsoid", self.ellipsoid), ("quartic", self.quartic)):
            lines.append(
                f"{name}: off by at most {100.0 * form.error:.2g} % of the wrench, normals by "
                f"{math.degrees(form.normal_error):.2g} deg"
            )
        return "\n".join(lines)

    def dataset(self) -> Dataset:
        """Forces, torques and normals over the twist."""
        dims = ("slip_angle",) if self.heading is None else ("heading", "slip_angle")
        columns = {name: variable(name, getattr(self, name), dims) for name in _COLUMNS}
        axes = {name: variable(name, getattr(self, name), (name,)) for name in dims}
        return Dataset(axes, columns, {
            "title": "Limit surface of a puck", **self.puck.described(),
            "unit_force": self.unit_force,
            "ellipsoid": self.ellipsoid.coefficients.tolist(),
            "ellipsoid_error": self.ellipsoid.error,
            "quartic": self.quartic.coefficients.tolist(), "quartic_error": self.quartic.error,
        })  # fmt: skip


def limit_surface(puck: PuckSpec, count: int | None) -> LimitSurface:
    """The limit surface of a puck, as :meth:`puck_tables.Puck.limit_surface` has it."""
    is_round = puck.shape is None
    if count is None:
        count = OF_A_ROUND if is_round else OF_A_BASE
    count = whole("n", count, LEAST, MOST if is_round else MOST_OF_A_BASE)
    if puck.friction == 0.0:
        raise InputError("a puck with friction = 0 has no limit surface: give friction > 0")
    phi = np.linspace(-0.5 * np.pi, 0.5 * np.pi, count)
    psi = np.zeros(1) if is_round else np.linspace(-np.pi, np.pi, 2 * count - 1)
    unit = puck.mass * puck.decel
    parts = _of_twists(puck, psi, phi) * [unit, unit, unit * slip_length(puck), 1.0, 1.0, 1.0]
    columns = np.moveaxis(parts[0] if is_round else parts, -1, 0)
    return LimitSurface(puck, None if is_round else psi, phi, *columns)


def _of_twists(puck: PuckSpec, psi: FloatArray, phi: FloatArray) -> FloatArray:
    """Forces over f m g, torques over ℓ too, and normals of twists, (m, n, 6)."""
    cosine = np.where(np.abs(phi) == 0.5 * np.pi, 0.0, np.cos(phi))
    directions = np.stack([np.cos(psi), np.sin(psi)], axis=-1)
    velocity = cosine[None, :, None] * directions[:, None]
    spin = np.broadcast_to(np.sin(phi) / slip_length(puck), velocity.shape[:2])
    slip = np.concatenate([velocity, spin[..., None]], axis=-1)
    back, _ = _friction(puck, slip, False)
    return np.concatenate([-back + 0.0, _normals(puck, slip)], axis=-1)


def _friction(puck: PuckSpec, slip: FloatArray, slopes: bool) -> tuple[FloatArray, FloatArray]:
    """Friction over f m g and ℓ of slips (…, 3), and its derivatives (…, 3, 3) by (v, ℓω)."""
    scale = np.array([1.0, 1.0, slip_length(puck)])
    if puck.shape is None:
        rows, out = slip.reshape(-1, 3).T, np.empty((slip.size // 3 if slopes else 0, 3, 3))
        force = of_round(puck.body.law, puck.delta, puck.radius, rows, out).T
        on_puck, change = force.reshape(slip.shape), out.reshape(-1, *slip.shape[1:], 3)
    else:
        unit = puck.mass * puck.decel
        whole = wrench(puck, slip[..., :2], slip[..., 2], 0.0, slopes)
        on_puck = np.concatenate([whole.force, whole.torque[..., None]], axis=-1) / unit
        change = np.empty(0) if whole.jacobian is None else whole.jacobian / unit
    return on_puck / scale, change / scale / scale[:, None] if slopes else change


def _normals(puck: PuckSpec, velocities: FloatArray) -> FloatArray:
    """Outward unit normals (…, 3), in (F_x, F_y, M/ℓ), where friction is that of twists (…, 3).

    Friction does not change along the twist t, and by J dt it moves in the surface; so the
    cofactors of J, scaled, are n ⊗ t.
    """
    slip = velocities * [1.0, 1.0, slip_length(puck)]
    slip = slip / np.linalg.norm(slip, axis=-1)[..., None]
    if puck.lever == 0.0:
        twists: FloatArray = slip
        return twists
    back, slopes = _friction(puck, velocities, True)
    columns = np.moveaxis(slopes, -1, 0)
    normal = sum(
        slip[..., i, None] * np.cross(columns[(i + 1) % 3], columns[(i + 2) % 3]) for i in range(3)
    )
    outward = -np.sign(np.einsum("...i,...i->...", back, normal))
    unit: FloatArray = normal * (outward / np.linalg.norm(normal, axis=-1))[..., None]
    return unit


def _named(puck: PuckSpec) -> str:
    if puck.shape is None:
        return f"the law {puck.body.law.name}, delta = {puck.delta:.6g}"
    tall = f", f h/2 = {puck.lever:.6g} m" if puck.lever else ", flat"
    return f"the base {puck.shape.name}{tall}"

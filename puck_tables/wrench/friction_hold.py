"""What friction does with a puck that slips, or with a force and a torque on it.

Force and torque of a slip, and their derivatives: under a base, and under a round puck with uniform
pressure in full contact, by closed forms (:mod:`puck_tables.kernels.base_friction`,
:mod:`puck_tables.kernels.base_hessian`).  Under other laws by the resultants
(:mod:`puck_tables.contact.closed_form`), u^⊥ the velocity turned by +90°,

    F = −f N (ρ_∥ u + sin φ ρ_⊥ u^⊥)/Q,   T = −½ f N r sin φ ρ_ω,   Q = hypot(u, r w).

It holds a wrench that is not larger than the one of its kind, F : T, that it has in some slip.  Of
round pucks that slip is looked for as scenes do (:mod:`puck_tables.scene.rest`), of others by
Newton's method (:mod:`puck_tables.kernels.base_twist`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import (
    FloatArray,
    broadcast,
    checked_flag,
    finite_array,
    velocity_array,
)
from puck_tables.contact.laws import Law
from puck_tables.errors import ContactError, InputError
from puck_tables.kernels.base_friction import grip
from puck_tables.kernels.base_hessian import grip_slopes
from puck_tables.kernels.base_twist import base_twist
from puck_tables.kernels.compile import allocating, kernel, patience
from puck_tables.motion.body import is_plain
from puck_tables.scene.by_speed import NO_LAW
from puck_tables.scene.ingredients import DryFriction
from puck_tables.scene.regions import load_limit, section_of
from puck_tables.scene.rest import SLACK, demand

if TYPE_CHECKING:
    from puck_tables.motion.puck_spec import PuckSpec

_STILL = 1e-6  # of Q: a speed below which force over speed is the derivative
_STEP = 1e-5  # rad, of the slip angle: central differences err by 1e-9 off singular lines
_TOL = 1e-9  # of the friction
_EXACT = 1e-10  # of it: by closed forms where there are


class Wrench(NamedTuple):
    """Force (…, 2), N, and torque (…), N m, of friction on a puck.

    ``jacobian``: array (…, 3, 3), their derivatives (rows F_x, F_y, torque) to v_x, v_y and the
    spin (columns), or None.
    """

    force: FloatArray
    torque: FloatArray
    jacobian: FloatArray | None = None

    def __str__(self) -> str:
        return f"force {self.force} N, torque {self.torque} N m"


def wrench(
    puck: PuckSpec, velocity: npt.ArrayLike, spin: npt.ArrayLike, angle: npt.ArrayLike,
    jacobian: bool,
) -> Wrench:  # fmt: skip
    """Friction of slips, as :meth:`puck_tables.Puck.wrench` has it."""
    checked_flag("jacobian", jacobian)
    moving = velocity_array(velocity)
    vx, vy, turning, turned = broadcast(
        velocity_x=moving[..., 0], velocity_y=moving[..., 1],
        spin=finite_array("spin", spin, "rad/s"), angle=finite_array("angle", angle, "rad"),
    )  # fmt: skip
    shape, load = vx.shape, puck.friction * puck.mass * puck.gravity
    size = np.maximum(np.maximum(np.abs(vx), np.abs(vy)), puck.radius * np.abs(turning)).ravel()
    if not size.all():
        raise InputError(
            "velocity and spin are both 0: friction of a puck at rest is what holds it, see holds"
        )
    rows = np.stack([one.ravel() for one in (vx, vy, turning)]) / size
    slopes = np.empty((size.size, 3, 3)) if jacobian else np.empty((0, 3, 3))
    if puck.shape is None and not (puck.body.law.can_lift and puck.delta <= 1.0):
        rows_out = of_round(puck.body.law, puck.delta, puck.radius, rows, slopes)
    else:
        rows_out = np.empty((3, size.size))
        _fill_forces(puck.packed_base, turned.ravel(), rows, rows_out, slopes)
    slopes *= load / size[: len(slopes), None, None]
    rows_out = load * rows_out + 0.0  # no negative zeros
    return Wrench(
        rows_out[:2].T.reshape(*shape, 2), rows_out[2].reshape(shape),
        slopes.reshape(*shape, 3, 3) if jacobian else None,
    )  # fmt: skip


def wrenches(law: Law, delta: float, phi: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """F_x, F_y and M/r over f N, each of the shape of ``phi``.

    >>> from puck_tables.contact.laws import law_of
    >>> [float(x.round(12)) for x in wrenches(law_of("uniform"), 0.0, np.array(np.pi / 2))]
    [0.0, 0.0, 0.666666666667]
    """
    rho = law.friction(phi, delta)
    cosine = np.where(np.abs(phi) == 0.5 * np.pi, 0.0, np.cos(phi))
    sine = np.sin(phi)
    return cosine * rho.parallel, sine * cosine * rho.perpendicular, 0.5 * sine * rho.spin


def of_round(
    law: Law, delta: float, radius: float, rows: FloatArray, slopes: FloatArray
) -> FloatArray:
    """Friction (3, n) over f N of slips (3, n) by the resultants; derivatives (n or 0, 3, 3)."""
    speed, rim = np.hypot(rows[0], rows[1]), radius * rows[2]
    phi, slip = np.arctan2(rim, speed), np.hypot(speed, rim)
    direction = np.where(speed > 0.0, rows[0] + 1j * rows[1], 1.0)
    direction = direction / np.abs(direction)

    def by(angle: FloatArray) -> FloatArray:
        """Friction along the velocity, across, and its torque over the radius."""
        side = np.where(np.abs(angle) > 0.5 * np.pi, -1.0, 1.0)  # beyond: as slips the other way
        along, across, turn = wrenches(law, delta, np.where(
            side > 0.0, angle, np.copysign(np.pi, angle) - angle
        ))  # fmt: skip
        return -np.stack([side * along, side * across, turn])

    along, across, turn = by(phi)
    force = direction * (along + 1j * across)
    if len(slopes):
        begin, end = phi - _STEP, phi + _STEP
        change = (by(end) - by(begin)) / (2.0 * _STEP * slip)
        cosine, sine = speed / slip, rim / slip
        # to the speed, to the velocity across over the speed, to r w
        still = speed < _STILL * slip
        normal = np.stack([-across, along]) / np.where(still, 1.0, speed)
        ahead = -sine * change
        normal = np.where(still, np.stack([-ahead[1], ahead[0]]), normal)
        local = np.zeros((3, 3, speed.size))
        local[:, 0], local[:, 2] = ahead, cosine * change
        local[0, 1], local[1, 1] = normal
        turned = np.zeros_like(local)
        turned[0, 0] = turned[1, 1] = direction.real
        turned[1, 0], turned[0, 1], turned[2, 2] = direction.imag, -direction.imag, 1.0
        slopes[...] = np.einsum("ikn,kln,jln->nij", turned, local, turned)
        slopes[:, 2, :] *= radius
        slopes[:, :, 2] *= radius
    return np.stack([force.real, force.imag, radius * turn])


@kernel
def _fill_forces(
    base: FloatArray, angle: FloatArray, rows: FloatArray, out: FloatArray, slopes: FloatArray
) -> None:
    """Friction over f N of slips (3, n) of a base turned by angles; derivatives, if wanted."""
    for n in range(rows.shape[1]):
        patience(1)
        c, s = math.cos(angle[n]), math.sin(angle[n])
        ux, uy, w = c * rows[0, n] + s * rows[1, n], c * rows[1, n] - s * rows[0, n], rows[2, n]
        if slopes.shape[0] == 0:
            fx, fy, torque = grip(base, ux, uy, w)
        else:
            one = slopes[n]
            fx, fy, torque = grip_slopes(base, ux, uy, w, one)
            for i in range(3):
                for j in range(3):
                    one[i, j] = -one[i, j]
            for i in range(3):  # to the axes of the floor
                x, y = one[i, 0], one[i, 1]
                one[i, 0], one[i, 1] = c * x - s * y, s * x + c * y
            for j in range(3):
                x, y = one[0, j], one[1, j]
                one[0, j], one[1, j] = c * x - s * y, s * x + c * y
        out[0, n], out[1, n], out[2, n] = s * fy - c * fx, -s * fx - c * fy, -torque


@dataclass(frozen=True, eq=False)
class Hold:
    """What friction does with a force and a torque on a puck at rest; arrays of one shape.

    ``held``: whether it takes them up; ``margin``: by what they could be multiplied until it slips,
    inf where nothing acts.
    """

    held: npt.NDArray[np.bool_]
    margin: FloatArray

    def __bool__(self) -> bool:
        return bool(self.held)

    def __str__(self) -> str:
        return f"held: {self.held}; it slips at {self.margin} times that"


class Twist(NamedTuple):
    """Velocity (…, 2), m/s, and spin (…), rad/s, of slips."""

    velocity: FloatArray
    spin: FloatArray

    def __str__(self) -> str:
        return f"velocity {self.velocity} m/s, spin {self.spin} rad/s"


def holds(
    puck: PuckSpec, force: npt.ArrayLike, torque: npt.ArrayLike, angle: npt.ArrayLike
) -> Hold:
    """Whether friction holds a puck, as :meth:`puck_tables.Puck.holds` has it."""
    if puck.friction == 0.0:
        raise InputError("a puck with friction = 0 holds nothing: give friction > 0")
    rows, _, shape = _in_its_axes(force, torque, angle)
    margin, heat, _ = _slips(puck, rows, _TOL)
    with np.errstate(divide="ignore", over="ignore"):
        held = (1.0 / margin - 1.0) * heat <= SLACK
    return Hold(held.reshape(shape), margin.reshape(shape))


def twist(
    puck: PuckSpec, force: npt.ArrayLike, torque: npt.ArrayLike, angle: npt.ArrayLike
) -> Twist:
    """The slip of a friction, as :meth:`puck_tables.Puck.twist` has it."""
    if puck.friction == 0.0:
        raise InputError("a puck with friction = 0 slips freely: give friction > 0")
    rows, turn, shape = _in_its_axes(force, torque, angle)
    if not rows.any(axis=0).all():
        raise InputError("force and torque are both 0: they tell no slip")
    _, _, slip = _slips(puck, -rows, _EXACT)
    velocity = turn * (slip[0] + 1j * slip[1])
    scale = np.hypot(np.abs(velocity), slip_length(puck) * slip[2])
    velocity = (velocity / scale).reshape(shape)
    return Twist(
        np.stack([velocity.real, velocity.imag], axis=-1) + 0.0, (slip[2] / scale).reshape(shape)
    )


def slip_length(puck: PuckSpec) -> float:
    """What makes spins speeds, m: the radius, or with a base the radius of gyration.

    >>> from puck_tables import Puck
    >>> slip_length(Puck(radius=0.04))
    0.04
    """
    return puck.radius if puck.shape is None else puck.inertia_radius


def _in_its_axes(
    force: npt.ArrayLike, torque: npt.ArrayLike, angle: npt.ArrayLike
) -> tuple[FloatArray, npt.NDArray[np.complex128], tuple[int, ...]]:
    """Wrenches (3, n) in the axes of the base, by what those are turned (n,), and their shape."""
    forces = velocity_array(force, "force", "fx, fy", "N")
    fx, fy, moment, turned = broadcast(
        force_x=forces[..., 0], force_y=forces[..., 1],
        torque=finite_array("torque", torque, "N m"), angle=finite_array("angle", angle, "rad"),
    )  # fmt: skip
    c, s = np.cos(turned), np.sin(turned)
    rows = np.stack([one.ravel() for one in (c * fx + s * fy, c * fy - s * fx, moment)])
    return rows, (c + 1j * s).ravel(), fx.shape


def _slips(
    puck: PuckSpec, rows: FloatArray, tol: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """By what wrenches (3, n) may be multiplied, the power over f N of their slips, and these."""
    # wrenches over their largest number, then over their largest force: no square, and no force of
    # a torque over the radius, leaves floating point
    largest = np.abs(rows).max(axis=0)
    acts = largest > 0.0
    largest = np.where(acts, largest, 1.0)
    rows = rows / largest
    unit = np.maximum(np.abs(rows[:2]).max(axis=0), np.abs(rows[2]) / puck.radius)
    unit = np.where(acts, unit, 1.0)
    share, heat, slip = np.zeros(unit.size), np.ones(unit.size), np.empty((3, unit.size))
    load = puck.friction * puck.mass * puck.gravity
    if puck.shape is None:
        plain = is_plain(puck.pressure, puck.gyration, puck.delta)
        section = load_limit(tol, puck.delta) if plain else section_of(puck, puck.delta, tol)
        coefficients = DryFriction(load, puck.delta, section, NO_LAW)
        _fill(coefficients, puck.radius, load * rows / unit, share, heat, slip)
        heat /= load
    else:
        base = puck.packed_base
        _fill_base(base, rows / unit, share, slip, np.empty(3), np.empty((3, 3)))
        if np.isnan(share).any():
            raise ContactError(
                "the slip under this force and torque was not found: of a tall body on a base it "
                "need not be the only one; a lower one has it"
            )
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        return np.where(acts, load / unit / share / largest, np.inf), heat, slip


@allocating
def _fill(
    coefficients: DryFriction, radius: float, rows: FloatArray, share: FloatArray, heat: FloatArray,
    slip: FloatArray,
) -> None:  # fmt: skip
    """The shares of wrenches (3, n), the power of friction in their slips, and these (3, n)."""
    for n in range(rows.shape[1]):
        patience(1)
        share[n], heat[n], slip[0, n], slip[1, n], slip[2, n] = demand(
            coefficients, radius, rows[0, n], rows[1, n], rows[2, n], False
        )


@kernel
def _fill_base(
    base: FloatArray, rows: FloatArray, share: FloatArray, slip: FloatArray, one: FloatArray,
    slopes: FloatArray,
) -> None:  # fmt: skip
    """The shares of wrenches over f N (3, n), where they act, and their slips (3, n)."""
    for n in range(rows.shape[1]):
        patience(1)
        fx, fy, torque = rows[0, n], rows[1, n], rows[2, n]
        if fx != 0.0 or fy != 0.0 or torque != 0.0:
            share[n] = 1.0 / base_twist(base, fx, fy, torque, one, slopes)
            slip[0, n], slip[1, n], slip[2, n] = one[0], one[1], one[2]

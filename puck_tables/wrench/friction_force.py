"""Force and torque of friction on a puck that slips, and their derivatives.

Under a base, and under a round puck with uniform pressure in full contact, by closed forms
(:mod:`puck_tables.kernels.base_friction`, :mod:`puck_tables.kernels.base_hessian`).  Under other
laws by the resultants (:mod:`puck_tables.contact.resultants`), u^⊥ the velocity turned by +90°,

    F = −f N (ρ_∥ u + sin φ ρ_⊥ u^⊥)/Q,   T = −½ f N r sin φ ρ_ω,   Q = hypot(u, r w).
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables._core.real import broadcast, checked_flag, finite_array, velocity_array
from puck_tables.contact.laws import Law
from puck_tables.errors import InputError
from puck_tables.kernels.base_friction import grip
from puck_tables.kernels.base_hessian import grip_slopes
from puck_tables.kernels.compile import kernel, patience

if TYPE_CHECKING:
    from puck_tables.motion.puck_spec import PuckSpec

_STILL = 1e-6  # of Q: a speed below which force over speed is the derivative
_STEP = 1e-5  # rad, of the slip angle: central differences err by 1e-9 off singular lines


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
        found = of_round(puck.body.law, puck.delta, puck.radius, rows, slopes)
    else:
        found = np.empty((3, size.size))
        _fill(puck.packed_base, turned.ravel(), rows, found, slopes)
    slopes *= load / size[: len(slopes), None, None]
    found = load * found + 0.0  # no negative zeros
    return Wrench(
        found[:2].T.reshape(*shape, 2), found[2].reshape(shape),
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
    way = np.where(speed > 0.0, rows[0] + 1j * rows[1], 1.0)
    way = way / np.abs(way)

    def by(angle: FloatArray) -> FloatArray:
        """Friction along the velocity, across, and its torque over the radius."""
        side = np.where(np.abs(angle) > 0.5 * np.pi, -1.0, 1.0)  # beyond: as slips the other way
        along, across, turn = wrenches(law, delta, np.where(
            side > 0.0, angle, np.copysign(np.pi, angle) - angle
        ))  # fmt: skip
        return -np.stack([side * along, side * across, turn])

    along, across, turn = by(phi)
    force = way * (along + 1j * across)
    if len(slopes):
        begin, end = phi - _STEP, phi + _STEP
        change = (by(end) - by(begin)) / (2.0 * _STEP * slip)
        cosine, sine = speed / slip, rim / slip
        # to the speed, to the velocity across over the speed, to r w
        still = speed < _STILL * slip
        beside = np.stack([-across, along]) / np.where(still, 1.0, speed)
        ahead = -sine * change
        beside = np.where(still, np.stack([-ahead[1], ahead[0]]), beside)
        local = np.zeros((3, 3, speed.size))
        local[:, 0], local[:, 2] = ahead, cosine * change
        local[0, 1], local[1, 1] = beside
        turned = np.zeros_like(local)
        turned[0, 0] = turned[1, 1] = way.real
        turned[1, 0], turned[0, 1], turned[2, 2] = way.imag, -way.imag, 1.0
        slopes[...] = np.einsum("ikn,kln,jln->nij", turned, local, turned)
        slopes[:, 2, :] *= radius
        slopes[:, :, 2] *= radius
    return np.stack([force.real, force.imag, radius * turn])


@kernel
def _fill(
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

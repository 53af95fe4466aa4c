"""What friction does with a force and a torque on a puck: whether it holds, or how it slips.

It holds a wrench that is not larger than the one of its kind, F : T, that it has in some slip.  Of
round pucks that slip is looked for as scenes do (:mod:`puck_tables.scene.rest`), of others by
Newton's method (:mod:`puck_tables.kernels.base_twist`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables._core.real import broadcast, finite_array, velocity_array
from puck_tables.errors import ContactError, InputError
from puck_tables.kernels.base_twist import base_twist
from puck_tables.kernels.compile import allocating, kernel, patience
from puck_tables.motion.body import is_plain
from puck_tables.scene.by_speed import NO_LAW
from puck_tables.scene.ingredients import DryFriction
from puck_tables.scene.regions import load_limit, section_of
from puck_tables.scene.rest import SLACK, demand

if TYPE_CHECKING:
    from puck_tables.motion.puck_spec import PuckSpec

_TOL = 1e-9  # of the friction
_EXACT = 1e-10  # of it: by closed forms where there are


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

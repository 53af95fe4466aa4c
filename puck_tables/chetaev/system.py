"""Point masses under linear velocity constraints with friction: one instant of the motion.

N. G. Chetaev, On certain constraints with friction, 1960, numbers its equations so.
Chetaev's axiom says that the reactions of constraints with friction do no work on the displacements
that the constraints admit and that are orthogonal to the velocity of every point (1.3).  Each
reaction is then a smooth part plus a part along the velocity, and the motion obeys

    m_i x_i″ = X_i + Σ_s λ_s a_i^(s) + μ_i x_i′ ,      Σ_i a_i^(s)·x_i′ + e^(s) = 0     (2.3), (2.4)

with the μ given.  Differentiating (2.4) along the motion leaves a symmetric positive definite
system for the λ,

    Σ_r (Σ_i a_i^(s)·a_i^(r)/m_i) λ_r = −Σ_i a_i^(s)·(X_i + μ_i x_i′)/m_i − d(a·x′ + e)/dt|_x′ .

The same matrix takes a velocity to the nearest admissible one (nearest in the kinetic energy), so
that rounding and integration never leave (2.4).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray, finite_array, shown
from puck_tables.errors import InputError

Constraints = Callable[[Any, Any], tuple[npt.ArrayLike, npt.ArrayLike]]
OfState = Callable[[FloatArray, FloatArray, float], npt.ArrayLike]

# Below this share of its own length a constraint is a combination of the others.
_INDEPENDENT = 1e-6
_COMPLEX_STEP = 1e-30  # its square vanishes beside 1: the derivative has no rounding


@dataclass(frozen=True)
class ConstrainedSystem:
    """Point masses, their constraints, forces and friction: Chetaev 1960, sections 1 and 2.

    Parameters
    ----------
    masses : array_like (n,), kg
        Finite and positive, else InputError.
    constraints : callable (x, t) → (a, e)
        ``x`` is (n, d) in m, d = 2 or 3, ``t`` in s; ``a`` is (s, n, d), ``e`` is (s,): the
        constraints Σ a·x′ + e = 0.  Unless ``rate`` is given it is differentiated by a complex
        step: it must be made of analytic functions that take complex numbers (NumPy's do).
    force : callable (x, v, t) → (n, d) or array_like (n, d), N
        The given forces X; none by default.
    friction : callable (x, v, t) → (n,) or array_like (n,), kg/s
        The multipliers μ of the velocities, negative where they brake; zero by default.
    rate : callable (x, v, t) → (s,), optional
        d(Σ a·v + e)/dt along the motion at fixed v, for constraints that take no complex numbers.

    Examples
    --------
    A bead on a rail at 30° (a is the normal of the rail), pressed by its weight:

    >>> rail = ConstrainedSystem([2.0], lambda x, t: ([[[-0.5, 0.75**0.5]]], [0.0]), [[0.0, -20.0]])
    >>> now = rail.instant(np.zeros((1, 2)), np.zeros((1, 2)), 0.0)
    >>> now.multipliers.round(6).tolist()  # 20 N cos 30°
    [17.320508]
    """

    masses: npt.ArrayLike
    constraints: Constraints
    force: OfState | npt.ArrayLike = 0.0
    friction: OfState | npt.ArrayLike = 0.0
    rate: OfState | None = None

    def __post_init__(self) -> None:
        masses = finite_array("masses", self.masses, "kg")
        if masses.ndim != 1 or masses.size == 0 or not (masses > 0.0).all():
            raise InputError(
                "masses must be one number greater than 0 kg for each point, got an array of shape "
                f"{masses.shape} with least value {masses.min(initial=np.inf):g}"
            )
        if not callable(self.constraints):
            raise InputError(
                f"constraints must be a function of (x, t), got {shown(self.constraints)}"
            )
        object.__setattr__(self, "masses", masses)

    def instant(self, position: FloatArray, velocity: FloatArray, time: float) -> Instant:
        """Accelerations and multipliers at a state, after its velocity is made admissible.

        InputError if a function gives another shape or what is not finite, or the constraints
        depend on each other.
        """
        shape = position.shape
        a, e = self.constrained(position, time)
        flat = a.reshape(len(e), -1)
        per_mass = np.repeat(1.0 / np.asarray(self.masses), shape[1])
        solve = _solver(flat, per_mass, time)
        residual = flat @ velocity.ravel() + e
        moving = (velocity.ravel() - per_mass * (flat.T @ solve(residual))).reshape(shape)

        def at(name: str, function: OfState | npt.ArrayLike, wanted: tuple[int, ...]) -> FloatArray:
            value = function(position, moving, time) if callable(function) else function
            values = finite_array(f"{name} at t = {time:g} s", value, "SI units")
            if values.shape not in ((), wanted):
                raise InputError(f"{name} must have the shape {wanted}, got {values.shape}")
            return np.broadcast_to(values, wanted)

        force = at("force", self.force, shape)
        friction = at("friction", self.friction, shape[:1])[:, None] * moving
        free = per_mass * (force + friction).ravel()
        multipliers = -solve(flat @ free + self.change(position, moving, time))
        smooth = flat.T @ multipliers
        return Instant(
            moving, (free + per_mass * smooth).reshape(shape), multipliers, smooth.reshape(shape),
            friction, force, a, e, residual,
        )  # fmt: skip

    def constrained(self, position: FloatArray, time: float) -> tuple[FloatArray, FloatArray]:
        """A (s, n, d) and e (s,), checked."""
        name = f"constraints at t = {time:g} s"
        a, e = self.constraints(position, time)
        matrix = finite_array(name, a, "SI units")
        drive = np.atleast_1d(finite_array(name, e, "SI units"))
        wanted = drive.size, *position.shape
        if drive.ndim != 1 or matrix.shape != wanted:
            raise InputError(
                f"constraints must return a of shape (s, n, d) = {wanted} and e of shape (s,), got "
                f"{matrix.shape} and {drive.shape}"
            )
        return matrix, drive

    def change(self, position: FloatArray, velocity: FloatArray, time: float) -> FloatArray:
        """d(Σ a·v + e)/dt along the motion at fixed v, array (s,)."""
        if self.rate is not None:
            return np.asarray(self.rate(position, velocity, time), dtype=np.float64)
        step = 1j * _COMPLEX_STEP
        try:
            a, e = self.constraints(position + step * velocity, time + step)
            turned = np.asarray(a).reshape(-1, velocity.size) @ velocity.ravel() + np.asarray(e)
        except TypeError as error:
            raise InputError(
                "the constraints must take complex numbers, by which they are differentiated; "
                f"write them with NumPy's functions, or give rate= ({error})"
            ) from None
        return np.asarray(turned.imag / _COMPLEX_STEP)


class Instant(NamedTuple):
    """What holds at one state: everything in SI units, (n, d) where nothing else is said."""

    velocity: FloatArray  # the admissible one nearest to the one given
    acceleration: FloatArray
    multipliers: FloatArray  # λ (s,)
    smooth: FloatArray  # Σ λ a, and
    friction: FloatArray  # μ x′: the two parts of the reactions
    force: FloatArray
    matrix: FloatArray  # a (s, n, d)
    drive: FloatArray  # e (s,)
    residual: FloatArray  # (s,): what the velocity given gives in (2.4)


def _solver(
    flat: FloatArray, per_mass: FloatArray, time: float
) -> Callable[[FloatArray], FloatArray]:
    """What solves for the λ, by Cholesky's factor of the Gram matrix of unit constraints."""
    from scipy.linalg import cho_solve
    from scipy.linalg.lapack import dpotrf

    gram = (flat * per_mass) @ flat.T
    length = np.sqrt(np.diag(gram))
    length[length == 0.0] = 1.0
    lower, which = dpotrf(gram / np.outer(length, length), lower=1)
    combined = np.diag(lower) < _INDEPENDENT
    if which or combined.any():
        raise InputError(
            f"constraint {which or int(combined.argmax()) + 1} at t = {time:g} s has no "
            "coefficients or can be combined from those before it: its force is not determined; "
            "leave it out"
        )

    def solve(right: FloatArray) -> FloatArray:
        solved = cho_solve((lower, True), right / length, check_finite=False) if right.size else 0.0
        return np.asarray(solved / length)

    return solve

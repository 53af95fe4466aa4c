"""The puck as a constrained system: N mass points of a rigid disc, each with friction of its own.

Every patch carries the load σ_i and has friction along its velocity u_i, as Chetaev's axiom wants.
Its multiplier is that of Coulomb's law with the root mean square of the slip over the patch,

    μ_i = −f σ_i/√(|u_i|² + ω² s²),   s² = π r²/(6N): mean square distance in a square of the area.

With |u_i| alone a patch under the centre of rotation sticks, and the puck of few patches turns
about it: a motion of N points, but not one of a disc.  The 2N − 3 constraints of a rigid body may
be kept (:func:`patch_system`) or eliminated by Lagrange's method (:func:`patch_stop`), which leaves
three equations at any N.

Patches lie on rings of equal width, 4(2k − 1) on the k-th, all of one area; a ring's radius is the
root mean square over its patches, so mass and moment of inertia are those of the disc at any N.
Sums over them are a midpoint rule in the radius, and the slip of a patch is wrong by the square of
its width: errors fall as 1/N.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray, one_velocity, positive, real, whole
from puck_tables.chetaev.motion import checked_tol
from puck_tables.chetaev.system import ConstrainedSystem
from puck_tables.errors import InputError

MAX_RINGS = 256  # 4 n² points: 262,144
MOST_PASSED, MOST_TURN = 1e6, 1e3  # patches times rad; rad
_TURNED = np.array([[0.0, 1.0], [-1.0, 0.0]])  # rows (x, y) by a right angle, to (−y, x)
# Q of the start at which the rest of the motion is taken as one at constant deceleration
_LAST = 1e-7


def disc_points(rings: int) -> FloatArray:
    """Places of the 4 rings² patches (n, 2), in units of the radius.

    >>> points = disc_points(3)
    >>> len(points), float((points**2).sum(axis=1).mean().round(12))  # ⟨ρ²⟩ = 1/2 on a disc
    (36, 0.5)
    """
    rings = whole("rings", rings, 1, MAX_RINGS)
    k = np.repeat(np.arange(1, rings + 1), 4 * (2 * np.arange(1, rings + 1) - 1))
    radius = np.sqrt(0.5 * ((k - 1) ** 2 + k**2)) / rings
    angle = 2.0 * np.pi * (np.arange(len(k)) - 4 * (k - 1) ** 2 + 0.5) / (4 * (2 * k - 1))
    return np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=-1)


def braking(points: FloatArray, velocity: FloatArray, rim: float, delta: float) -> FloatArray:
    """Each patch's load over its rms slip: −μ in units of f times the mean load; 0 at rest.

    ``points`` (n, 2) from the centre in units of the radius, axes fixed in space; ``velocity``
    (n, 2); ``rim``: rω.  The loads are 1 + b x + c y with the moments balanced: Σ σ x =
    (h/2) f Σ σ u/|u| are two linear equations for (b, c).

    >>> points = disc_points(8)
    >>> ahead = np.tile([1.0, 0.0], (len(points), 1))
    >>> bool(np.allclose(braking(points, ahead, 0.0, 0.5), 1.0 + 0.5 * points[:, 0]))  # b = δ
    True
    """
    slip = np.sqrt((velocity**2).sum(axis=1) + np.pi * rim * rim / (6.0 * len(velocity)))
    inverse = np.divide(1.0, slip, np.zeros(len(slip)), where=slip > 0.0)
    lever = points - 0.25 * delta * inverse[:, None] * velocity
    load = 1.0 + points @ np.linalg.solve(lever.T @ points, -lever.sum(axis=0))
    if load.min() < 0.0:
        raise InputError(
            f"delta = {delta:g}: a patch would be lifted; patches are for full contact, delta <= 1"
        )
    return np.asarray(load * inverse)


def patch_system(
    rings: int, *, delta: float = 0.0, decel: float = 1.0, radius: float = 1.0, mass: float = 1.0
) -> tuple[ConstrainedSystem, FloatArray]:
    """A sliding puck as 4 rings² mass points, all constraints of the rigid body kept.

    With ω taken from the first two points, u_i − u_1 = ω × (x_i − x_1) for the others, and the
    distance of the two: 2N − 3 constraints, linear in the velocities and independent.

    Parameters
    ----------
    rings : int, from 1 to 256
    delta, decel, radius, mass : float
        2fh/r in [0, 1], J = fg in m/s², r in m, m in kg; else InputError.

    Returns
    -------
    ConstrainedSystem, array (n, 2)
        The system, and the places of its points when the centre lies at the origin, m.

    Examples
    --------
    >>> system, points = patch_system(2)
    >>> len(points), len(system.constraints(points, 0.0)[1])
    (16, 29)
    """
    delta, decel, radius = _checked(delta, decel, radius)
    mass = positive("mass", mass, "kg")
    points = disc_points(rings) * radius
    count = len(points)
    others = np.arange(count - 2)

    def rigid(x: FloatArray, t: float) -> tuple[FloatArray, FloatArray]:
        base = x[1] - x[0]
        a = np.zeros((2 * count - 3, count, 2), dtype=x.dtype)
        a[0, 0], a[0, 1] = -base, base
        # ω |base|² = (n × base)·(u_2 − u_1), n × (x, y) = (−y, x)
        across = ((x[2:] - x[0]) @ _TURNED / (base @ base))[..., None] * (base @ _TURNED)
        of_others = a[1:].reshape(count - 2, 2, count, 2)
        of_others[others, :, others + 2] = np.eye(2)
        of_others[:, :, 0], of_others[:, :, 1] = across - np.eye(2), -across
        return a, np.zeros(len(a), dtype=x.dtype)

    def friction(x: FloatArray, v: FloatArray, t: float) -> FloatArray:
        arm, relative = (x - x.mean(axis=0)) / radius, v - v.mean(axis=0)
        rim = 2.0 * (arm @ _TURNED * relative).sum() / count
        return -(mass * decel / count) * braking(arm, v, rim, delta)

    return ConstrainedSystem(np.full(count, mass / count), rigid, friction=friction), points


def patch_stop(
    velocity: npt.ArrayLike,
    spin: float,
    rings: int,
    *,
    delta: float = 0.0,
    decel: float = 1.0,
    radius: float = 1.0,
    tol: float = 1e-8,
) -> tuple[float, FloatArray]:
    """When and where a puck of 4 rings² patches stops (Chetaev 1960, section 3).

    Lagrange's equations (3.5) for (x, y, θ).  As the friction multipliers depend on the velocities
    they enter as generalised forces.  Time runs as dt = (Q/J) dτ, in which the stop is infinitely
    far and every rate stays finite; from 1e-7 of Q on the deceleration is taken as constant.

    Parameters
    ----------
    velocity, spin : array_like (2,), m/s; float, rad/s
        InputError if the puck turns by more than some 1000 rad, or 1e6 over the number of patches.
    rings, delta, decel, radius
        As :func:`patch_system`.
    tol : float
        Local relative error of the integration; 1e-13 to 0.01, else AccuracyError.

    Returns
    -------
    float, array (2,)
        Stop time in s and place in m.

    Examples
    --------
    >>> time, place = patch_stop((1.0, 0.0), 0.0, 4)  # no spin: exact with any patches
    >>> round(time, 9), place.round(9)[0].item()
    (1.0, 0.5)
    """
    from scipy.integrate import solve_ivp

    delta, decel, radius = _checked(delta, decel, radius)
    tol, points = checked_tol(tol), disc_points(rings)
    (vx, vy), rim = one_velocity(velocity), radius * real("spin", spin, "rad/s")
    start = math.hypot(vx, vy, rim)
    if start == 0.0:
        return 0.0, np.zeros(2)
    # speeds in units of that of the start, times and lengths in what it takes to brake it
    last, length = start / decel, start / decel * start
    turn = length / radius  # rad, of a rim as fast as the start
    if not (math.isfinite(last) and math.isfinite(length)):
        raise InputError(
            "velocity, spin, radius and decel give a motion too large: use other units"
        )
    turns, most = abs(rim / start) * turn, min(MOST_TURN, MOST_PASSED / len(points))
    if turns > most:
        raise InputError(
            f"the puck turns by some {turns:.3g} rad, and {len(points)} patches are followed for "
            f"{most:.3g} at most: give less spin, more decel or fewer rings"
        )

    def slope(tau: float, state: FloatArray) -> FloatArray:
        vx, vy, rim, angle = state[:4]
        cosine, sine = math.cos(angle), math.sin(angle)
        places = points @ np.array([[cosine, sine], [-sine, cosine]])
        slip = rim * places @ _TURNED + [vx, vy]
        force = braking(places, slip, rim, delta)[:, None] * slip
        torque = (places @ _TURNED * force).sum() / len(points)
        Q = math.hypot(vx, vy, rim)
        return Q * np.array([*-force.mean(axis=0), -2.0 * torque, turn * rim, vx, vy, 1.0])

    def slow(tau: float, state: FloatArray) -> float:
        return math.hypot(*state[:3]) - _LAST

    slow.terminal = True  # type: ignore[attr-defined]
    first = np.array([vx, vy, rim, 0.0, 0.0, 0.0, 0.0]) / start
    # the speeds keep their digits down to their last values
    solved = solve_ivp(slope, (0.0, 1e3), first, "DOP853", rtol=tol, atol=tol * _LAST, events=slow)
    end = solved.y[:, -1]
    going = slope(0.0, end)  # Q times what changes in units of time
    left = going[-1] ** 3 / -float(end[:3] @ going[:3])
    return last * float(end[6] + left), length * (end[4:6] + 0.5 * left * end[:2])


def _checked(delta: float, decel: float, radius: float) -> tuple[float, float, float]:
    height = real("delta", delta, "2 f h / r")
    if not 0.0 <= height <= 1.0:
        raise InputError(f"delta must be from 0 to 1 (full contact) for patches, got {height:g}")
    return height, positive("decel", decel, "m/s^2"), positive("radius", radius, "m")

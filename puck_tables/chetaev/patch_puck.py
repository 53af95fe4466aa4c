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

from puck_tables._core.arrays import FloatArray
from puck_tables._core.real import one_velocity, positive, real, whole
from puck_tables.chetaev.motion import checked_tol
from puck_tables.chetaev.system import ConstrainedSystem
from puck_tables.errors import InputError

MAX_RINGS = 256  # 4 n² points: 262,144
MOST_PASSED, MOST_TURN = 1e6, 1e3  # patches times rad; rad
# Q of the start at which the rest of the motion is taken as one at constant deceleration
_LAST = 1e-7


def disc_points(rings: int) -> FloatArray:
    """Places of the 4 rings² patches (n, 2), in units of the radius.

    >>> points = disc_points(3)
    >>> len(points), float((points**2).sum(axis=1).mean().round(12))  # ⟨ρ²⟩ = 1/2 on a disc
    (36, 0.5)
    """
    rings = whole("rings", rings, 1, MAX_RINGS)
    k = np.arange(1, rings + 1)
    count = 4 * (2 * k - 1)
    radius = np.repeat(np.sqrt(0.5 * ((k - 1) ** 2 + k**2)) / rings, count)
    angle = np.concatenate([2.0 * np.pi * (np.arange(one) + 0.5) / one for one in count])
    places = radius * np.stack([np.cos(angle), np.sin(angle)])
    return np.ascontiguousarray(places.T)


def pressures(points: FloatArray, slip: FloatArray, delta: float) -> FloatArray:
    """Loads of the patches in units of their mean: 1 + b x + c y with the moments balanced.

    ``points`` (n, 2) from the centre in units of the radius, axes fixed in space; ``slip`` (n, 2):
    friction of each patch over f σ, turned round.  Σ σ x = (h/2) f Σ σ u/|u| are two linear
    equations for (b, c).

    >>> points = disc_points(8)
    >>> ahead = np.tile([1.0, 0.0], (len(points), 1))
    >>> bool(np.allclose(pressures(points, ahead, 0.5), 1.0 + 0.5 * points[:, 0]))  # b = δ at φ = 0
    True
    """
    if delta == 0.0:
        return np.ones(len(points))
    lever = points - 0.25 * delta * slip
    tilt = np.linalg.solve((lever.T @ points), -lever.sum(axis=0))
    load = np.asarray(1.0 + points @ tilt)
    if load.min() < 0.0:
        raise InputError(
            f"delta = {delta:g}: a patch would be lifted; patches are for full contact, delta <= 1"
        )
    return load


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
    delta, decel, radius, mass = _checked(delta, decel, radius, mass)
    points = disc_points(rings) * radius
    count = len(points)
    others = np.arange(2, count)

    def rigid(x: FloatArray, t: float) -> tuple[FloatArray, FloatArray]:
        base = x[1] - x[0]
        turned = np.stack([-base[1], base[0]])  # ω |base|² = turned·(u_2 − u_1)
        a = np.zeros((1 + 2 * (count - 2), count, 2), dtype=x.dtype)
        a[0, 0], a[0, 1] = -base, base
        arm = (x[2:] - x[0]) / (base @ base)
        for axis, across in ((0, -arm[:, 1]), (1, arm[:, 0])):
            rows = 2 * others - 3 + axis
            a[rows, others, axis] = 1.0
            a[rows, 0, axis] = -1.0
            a[rows, 1] -= across[:, None] * turned
            a[rows, 0] += across[:, None] * turned
        return a, np.zeros(len(a), dtype=x.dtype)

    def friction(x: FloatArray, v: FloatArray, t: float) -> FloatArray:
        arm, relative = (x - x.mean(axis=0)) / radius, v - v.mean(axis=0)
        rim = 2.0 * float((arm[:, 0] * relative[:, 1] - arm[:, 1] * relative[:, 0]).mean())
        inverse = _inverse_speed(v, rim)
        load = pressures(arm, v * inverse[:, None], delta)
        return -load * inverse * (mass * decel / count)

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
    """When and where a puck of 4 rings² patches stops.

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

    References
    ----------
    Chetaev 1960, section 3.

    Examples
    --------
    >>> time, place = patch_stop((1.0, 0.0), 0.0, 4)  # no spin: exact with any patches
    >>> round(time, 9), place.round(9)[0].item()
    (1.0, 0.5)
    """
    from scipy.integrate import solve_ivp

    delta, decel, radius, _ = _checked(delta, decel, radius, 1.0)
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
        slip = np.stack([vx - rim * places[:, 1], vy + rim * places[:, 0]], axis=-1)
        slip *= _inverse_speed(slip, rim)[:, None]
        force = pressures(places, slip, delta)[:, None] * slip
        torque = float((places[:, 0] * force[:, 1] - places[:, 1] * force[:, 0]).mean())
        Q = math.hypot(vx, vy, rim)
        return Q * np.array([*-force.mean(axis=0), -2.0 * torque, turn * rim, vx, vy, 1.0])

    def slow(tau: float, state: FloatArray) -> float:
        return math.hypot(*state[:3]) - _LAST

    slow.terminal = True  # type: ignore[attr-defined]
    # the speeds keep their digits down to their last values; angle, place and time are sums
    absolute = tol * np.array([_LAST, _LAST, _LAST, 1.0, 1.0, 1.0, 1.0])
    first = np.array([vx, vy, rim, 0.0, 0.0, 0.0, 0.0]) / start
    solved = solve_ivp(slope, (0.0, 1e3), first, "DOP853", rtol=tol, atol=absolute, events=slow)
    end = solved.y[:, -1]
    going = slope(0.0, end)  # Q times what changes in units of time
    left = going[-1] ** 3 / -float(end[:3] @ going[:3])
    return last * float(end[6] + left), length * (end[4:6] + 0.5 * left * end[:2])


def _inverse_speed(velocity: FloatArray, rim: float) -> FloatArray:
    """1/rms slip of the patches of a disc whose rim turns with the speed ``rim``; 0 at rest."""
    squared = (velocity**2).sum(axis=1) + np.pi * rim * rim / (6.0 * len(velocity))
    inverse = np.zeros(len(velocity))
    np.divide(1.0, np.sqrt(squared), inverse, where=squared > 0.0)
    return inverse


def _checked(
    delta: float, decel: float, radius: float, mass: float
) -> tuple[float, float, float, float]:
    height = real("delta", delta, "2 f h / r")
    if not 0.0 <= height <= 1.0:
        raise InputError(f"delta must be from 0 to 1 (full contact) for patches, got {height:g}")
    return (
        height, positive("decel", decel, "m/s^2"), positive("radius", radius, "m"),
        positive("mass", mass, "kg"),
    )  # fmt: skip

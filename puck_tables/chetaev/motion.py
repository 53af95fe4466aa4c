"""Motion of point masses under constraints with friction, with everything that can be checked.

Integrated by scipy's DOP853.  The right-hand side takes every velocity to the nearest admissible
one first, so the constraints hold to rounding at any tolerance; how far it had to go, the
``drift``, measures the integration.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray, finite_array, instance, real, shown
from puck_tables.chetaev.system import ConstrainedSystem, Instant
from puck_tables.errors import AccuracyError, InputError

FINEST, COARSEST = 1e-13, 1e-2  # relative: finer is rounding, looser is no answer
_ADMISSIBLE = 1e-9  # of the speeds, at the start
_RANK = 1e-9  # of the largest singular value: smaller ones are those of dependent constraints
_PROBE, _PROBE_SLACK = 1e-6, 1e-3  # difference quotient that judges the derivative at the start
_COUNT = 3  # works that are integrated along with the motion


@dataclass(frozen=True)
class ConstrainedMotion:
    """Positions, reactions and the account of work of a motion, k times of n points in d = 2 or 3.

    Attributes
    ----------
    time : array (k,), s
    position, velocity, acceleration, reaction : arrays (k, n, d), SI units
        And Σ λ a + μ x′, what the constraints do to each point, N.
    multipliers, matrix : arrays (k, s) and (k, s, n, d)
        λ, N where the coefficients a are unit vectors; these a.
    residual, drift : float
        Largest |Σ a·x′ + e| at the output times; largest distance (rms of all points, weighted by
        mass) from the integrated velocity to the admissible one, m/s.
    kinetic_energy, force_work, friction_work, support_work : arrays (k,), J
        Energy, and work since the first time: of the given forces, of friction Σ μ|x′|² (≤ 0
        where it brakes), and of moving supports, −∫ Σ λ e dt.
    """

    time: FloatArray
    position: FloatArray = field(repr=False)
    velocity: FloatArray = field(repr=False)
    acceleration: FloatArray = field(repr=False)
    multipliers: FloatArray = field(repr=False)
    reaction: FloatArray = field(repr=False)
    matrix: FloatArray = field(repr=False)
    residual: float
    drift: float
    kinetic_energy: FloatArray = field(repr=False)
    force_work: FloatArray = field(repr=False)
    friction_work: FloatArray = field(repr=False)
    support_work: FloatArray = field(repr=False)

    @property
    def energy_residual(self) -> float:
        """Largest |T − T₀ − all work|, J."""
        work = self.force_work + self.friction_work + self.support_work
        return float(np.abs(self.kinetic_energy - self.kinetic_energy[0] - work).max())

    def c_displacements(self, number: int) -> FloatArray:
        """A basis of the C-displacements at one output time, array (how many or 0, n, d).

        They are admissible, Σ a·δx = 0, and orthogonal to each point's velocity, (1.1).

        >>> rod = lambda x, t: ([[x[0] - x[1], x[1] - x[0]]], [0.0])
        >>> ends, going = [[1.0, 0.0], [-1.0, 0.0]], [[0.0, 1.0], [0.0, -1.0]]
        >>> run = constrained_motion(ConstrainedSystem([1.0, 1.0], rod), ends, going, [0.0, 1.0])
        >>> run.c_displacements(0).shape  # both ends along the rod
        (1, 2, 2)
        """
        from scipy.linalg import null_space

        velocity = self.velocity[number]
        across = np.eye(len(velocity))[:, :, None] * velocity
        rows = np.concatenate([self.matrix[number], across]).reshape(-1, velocity.size)
        length = np.linalg.norm(rows, axis=1, keepdims=True)
        free = null_space(rows / np.where(length > 0.0, length, 1.0), _RANK)
        return np.asarray(free.T.reshape(-1, *velocity.shape))

    @property
    def axiom_residual(self) -> float:
        """Largest work of the reactions on a unit C-displacement, over |reactions|: (1.3) says 0.

        NaN where the system has no C-displacements at any time, and nothing is said.
        """
        residuals = list[float]()
        for k, reaction in enumerate(self.reaction):
            size = float(np.linalg.norm(reaction))
            of_displacements = np.tensordot(self.c_displacements(k), reaction, axes=2)
            residuals += [abs(float(work)) / size for work in of_displacements if size > 0.0]
        return max(residuals, default=float("nan"))


def constrained_motion(
    system: ConstrainedSystem,
    position: npt.ArrayLike,
    velocity: npt.ArrayLike,
    times: npt.ArrayLike,
    *,
    tol: float = 1e-9,
    until: Callable[[FloatArray, FloatArray, float], float] | None = None,
) -> ConstrainedMotion:
    """Move point masses under linear velocity constraints with friction, (2.3) and (2.4).

    Parameters
    ----------
    system : ConstrainedSystem
    position, velocity : array_like (n, 2) or (n, 3), m and m/s
        At the first of ``times``; the velocity must satisfy the constraints, else InputError; so
        where these come to depend on each other on the way.
    times : array_like (k,), s
        At least two, ascending: the start, then when to report.
    tol : float
        Local error of the integration, relative; 1e-13 to 0.01, else AccuracyError; so where the
        integration gets stuck.
    until : callable (x, v, t) → float, optional
        The motion ends where it falls to zero; that state is then the last one reported.

    Examples
    --------
    A bead on a rail that rotates at Ω = 1 rad/s, μ/m = −1.5: q″ = q − 1.5 q′, so q = e^(t/2).

    >>> def rail(x, t):
    ...     across = np.array([-np.sin(t), np.cos(t)])
    ...     along = np.array([np.cos(t), np.sin(t)])
    ...     return [[across]], [-(x[0] @ along)]
    >>> bead = ConstrainedSystem([2.0], rail, friction=[-3.0])
    >>> run = constrained_motion(bead, [[1.0, 0.0]], [[0.5, 1.0]], [0.0, 1.0, 2.0])
    >>> np.hypot(*run.position[:, 0].T).round(8).tolist()
    [1.0, 1.64872127, 2.71828183]
    """
    from scipy.integrate import solve_ivp

    instance("system", system, ConstrainedSystem)
    x, v = finite_array("position", position, "m"), finite_array("velocity", velocity, "m/s")
    points = np.asarray(system.masses).size
    if x.ndim != 2 or x.shape[0] != points or x.shape[1] not in (2, 3) or v.shape != x.shape:
        raise InputError(
            f"position and velocity must have the shape ({points}, 2) or ({points}, 3), one row a "
            f"mass, got {x.shape} and {v.shape}"
        )
    t, tol = checked_times(times), checked_tol(tol)
    if until is not None and not callable(until):
        raise InputError(f"until must be a function of (x, v, t), got {shown(until)}")
    start = _checked_admissible(system, x, v, t)
    size, shape = x.size, x.shape

    def slope(time: float, state: FloatArray) -> FloatArray:
        x, v = state[: 2 * size].reshape(2, *shape)
        now = system.instant(x, v, time)
        powers = np.einsum("wnd,nd->w", [now.force, now.friction], now.velocity)
        of_drive = -now.multipliers @ now.drive
        return np.concatenate([now.velocity.ravel(), now.acceleration.ravel(), powers, [of_drive]])

    def ends(time: float, state: FloatArray) -> float:
        x, v = state[: 2 * size].reshape(2, *shape)
        return 1.0 if until is None else float(until(x, v, time))

    ends.terminal, ends.direction = True, -1  # type: ignore[attr-defined]
    # what errors are measured against where a coordinate passes zero: a length, speed, energy
    span = t[-1] - t[0]
    speed = float(np.abs(start.velocity).max() + np.abs(start.acceleration).max() * span) or 1.0
    scales = [float(np.abs(x).max()) + speed * span, speed, np.sum(system.masses) * speed**2]
    solved = solve_ivp(
        slope, (t[0], t[-1]), np.concatenate([x.ravel(), v.ravel(), np.zeros(_COUNT)]),
        method="DOP853", t_eval=t, rtol=tol, atol=tol * np.repeat(scales, [size, size, _COUNT]),
        events=ends,
    )  # fmt: skip
    if solved.status < 0:
        reached = solved.t[-1] if solved.t.size else t[0]
        raise AccuracyError(
            f"the integration got stuck after t = {reached:g} s: a force or a constraint changes "
            "too suddenly there; end the motion before with until=, or use a larger tol"
        )
    when, states = solved.t, solved.y.T
    if solved.status == 1:
        when = np.append(when, solved.t_events[0])
        states = np.concatenate([states, solved.y_events[0]])
    return _reported(system, when, states, shape)


def checked_times(times: npt.ArrayLike) -> FloatArray:
    """Times of a motion, the first of which is its start."""
    t = finite_array("times", times, "s")
    if t.ndim != 1 or t.size < 2 or not (np.diff(t) > 0.0).all():
        raise InputError("times must be two or more numbers in s, ascending, from the start on")
    return t


def checked_tol(tol: float) -> float:
    """A local error that the integrator can keep."""
    error = real("tol", tol, "relative")
    if not FINEST <= error <= COARSEST:
        raise AccuracyError(f"tol must be from {FINEST:g} to {COARSEST:g}, got {error:g}")
    return error


def _reported(
    system: ConstrainedSystem, when: FloatArray, states: FloatArray, shape: tuple[int, ...]
) -> ConstrainedMotion:
    size = shape[0] * shape[1]
    position, integrated = np.moveaxis(states[:, : 2 * size].reshape(-1, 2, *shape), 1, 0)
    instants = [system.instant(*row) for row in zip(position, integrated, when, strict=True)]
    columns = Instant(*(np.array(column) for column in zip(*instants, strict=True)))
    velocity, masses = columns.velocity, np.asarray(system.masses)[:, None]
    moved = (masses * (velocity - integrated) ** 2).sum(axis=(1, 2)) / masses.sum()
    residual = np.einsum("ksnd,knd->ks", columns.matrix, velocity) + columns.drive
    return ConstrainedMotion(
        when, position, velocity, columns.acceleration, columns.multipliers,
        columns.smooth + columns.friction, columns.matrix,
        float(np.abs(residual).max(initial=0.0)), float(np.sqrt(moved.max())),
        0.5 * (masses * velocity**2).sum(axis=(1, 2)), *states[:, 2 * size :].T,
    )  # fmt: skip


def _checked_admissible(
    system: ConstrainedSystem, x: FloatArray, v: FloatArray, times: FloatArray
) -> Instant:
    """The first instant; refuses a start that breaks a constraint, and a wrong derivative."""
    time, span = float(times[0]), float(times[-1] - times[0])
    start = system.instant(x, v, time)
    terms = np.abs(start.matrix).sum(axis=(1, 2)) * np.abs(v).max() + np.abs(start.drive)
    broken = np.abs(start.residual) > _ADMISSIBLE * terms
    if broken.any():
        which = int(np.argmax(broken))
        raise InputError(
            f"the velocity at the start breaks constraint {which + 1}: the sum of a·x' and e is "
            f"{start.residual[which]:g}, not 0; give a velocity that the constraints admit"
        )
    steps = (_PROBE * span, -_PROBE * span)
    nearby = [system.constrained(x + step * v, time + step) for step in steps]
    ahead, behind = (np.tensordot(a, v, axes=2) + e for a, e in nearby)
    change = system.change(x, v, time)
    allowed = _PROBE_SLACK * (np.abs(change) + terms / span)
    wrong = ~(np.abs((ahead - behind) / (2.0 * steps[0]) - change) <= allowed)
    if wrong.any():
        raise InputError(
            f"constraint {int(np.argmax(wrong)) + 1} changes otherwise along the motion than its "
            "derivative says: write it with analytic functions that take complex numbers (no abs, "
            "no real parts), or give rate="
        )
    return start

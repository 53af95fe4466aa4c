"""What one would write without this program: scipy over time, the same physics (J = r = 1).

And methods for the stop of bodies: a box, a box whose friction falls with speed, a curling stone.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.contact.friction_laws import CurlingLaw, FrictionLaw, StribeckLaw
from puck_tables.kernels.closed_form_kernel import friction_ratios
from puck_tables.kernels.compile import allocating
from puck_tables.puck import Puck
from puck_tables.scene.parts import Floor, Launch
from puck_tables.tradeoff.truth import Contender, Made, Question, kept_arrays
from puck_tables.world.scene import Scene

# tolerances that reach about 1e-4, 1e-6, 1e-8, 1e-11 for usual starts; the absolute one has to be
# small, or the steps jump over the stop and the solver trembles there for ever
_SETTINGS = (
    ("RK45", 1e-5, 1e-9), ("LSODA", 1e-5, 1e-7), ("LSODA", 1e-8, 1e-9), ("DOP853", 1e-6, 1e-10),
    ("DOP853", 1e-11, 1e-13),
)  # fmt: skip
_GRID = (20, 40)  # radial and angular patches
_END = 1e-8  # of Q, where the integration is called finished
_PATCH_END = 1e-3  # of Q₀, at which it counts as at rest
_MOST_CALLS = 20_000  # of the right-hand side: then it is given up


@allocating
def rates(t: float, state: FloatArray, delta: float) -> FloatArray:
    """d/dt of vx, vy, ω, x, y, friction by the compiled closed forms."""
    vx, vy, spin = state[0], state[1], state[2]
    speed, rim = math.hypot(vx, vy), abs(spin)
    q = math.hypot(speed, rim)
    fast = 1.0 if rim > speed else 0.0
    inverse, across, turning = friction_ratios(min(speed, rim) / max(speed, rim), fast, delta)
    along, left = -1.0 / (inverse * q), -across * spin / (inverse * q * q)
    out = np.empty(5)
    out[0], out[1] = along * vx - left * vy, along * vy + left * vx
    out[2], out[3], out[4] = -turning / inverse * spin / q, vx, vy
    return out


def _until_stopped(
    function: Any, start: tuple[float, ...], end: float, longest: float = 2.0, **options: Any
) -> FloatArray:
    """Time, x, y when Q of ``start`` has fallen to its ``end``; NaN if not within ``longest`` Q."""
    from scipy.integrate import solve_ivp

    q0, calls = math.hypot(*start[:3]), 0

    def left(t: float, state: FloatArray, *_: float) -> float:
        return math.hypot(*state[:3]) - end * q0

    def counted(t: float, state: FloatArray, *args: float) -> Any:
        nonlocal calls
        calls += 1
        if calls > _MOST_CALLS:  # stepped over the stop, where friction jumps, it trembles there
            raise TimeoutError
        return function(t, state, *args)

    left.terminal = True  # type: ignore[attr-defined]
    with suppress(TimeoutError):
        solution = solve_ivp(counted, (0.0, longest * q0), start, events=left, **options)
        if solution.status == 1:
            return np.array([solution.t[-1], *solution.y[3:5, -1]])
    return np.full(3, math.nan)


def scripted(stop: Callable[..., FloatArray], *fixed: Any) -> Made:
    """Nothing kept; ``stop`` asked of one launch after another: its velocities and what follows."""
    return None, lambda launches: np.stack([stop(*fixed, *one[:4]) for one in launches.T], axis=1)


def scipy_stop(
    method: str, rtol: float, atol: float, vx: float, vy: float, spin: float, delta: float
) -> FloatArray:
    """Stop time, x, y by ``solve_ivp`` on the closed forms."""
    return _until_stopped(
        rates, (vx, vy, spin, 0.0, 0.0), _END, method=method, rtol=rtol, atol=atol, args=(delta,)
    )


def scripts(easy: Question) -> Iterator[Contender]:
    """What one would write for stops of a homogeneous round puck."""
    for method, rtol, atol in _SETTINGS:
        make = partial(scripted, scipy_stop, method, rtol, atol)
        name, words = f"scipy {method}, closed forms", f"rtol={rtol:g} atol={atol:g}"
        yield Contender(easy, name, words, make, 1, outsider=True)
    words, make = f"patches={_GRID[0]}x{_GRID[1]}", partial(scripted, disc_by_patches)
    yield Contender(easy, "patches and scipy RK45", words, make, 1, outsider=True)


def patch_script(
    points: FloatArray, weights: FloatArray, gyration: float, height: float, gravity: float,
    friction: Callable[[FloatArray], FloatArray],
) -> Callable[[float, float, float], FloatArray]:  # fmt: skip
    """A function of vx, vy, ω to stop time, x, y: friction summed over patches, scipy's defaults.

    ``points`` (2, n), m, from the centre of mass, with ``weights`` (n,); ``gyration`` k and
    ``height`` of the centre of mass, m; ``gravity``, m/s²; ``friction``: at slip speeds (n,).
    """
    inertia = np.linalg.inv(weights * points @ points.T)

    def motion(t: float, state: FloatArray) -> list[float]:
        spin, cosine, sine = state[2] / gyration, math.cos(state[5]), math.sin(state[5])
        turn = np.array([[cosine, -sine], [sine, cosine]])
        x, y = turn @ points
        slip = np.stack([state[0] - spin * y, state[1] + spin * x])
        speed = np.hypot(*slip)
        pull = -weights * friction(speed) * slip / speed
        # the force F at the height of the centre of mass tilts the pressure, which changes F
        tilt = height * turn @ inertia @ turn.T
        force = np.linalg.solve(np.eye(2) + pull @ np.stack([x, y]).T @ tilt, pull.sum(axis=1))
        pressure = 1.0 - force @ tilt @ np.stack([x, y])
        torque = ((x * pull[1] - y * pull[0]) * pressure).sum()
        return [*(gravity * force), gravity * torque / gyration, state[0], state[1], spin]

    def stop(vx: float, vy: float, spin: float) -> FloatArray:
        launch = vx, vy, gyration * spin
        least = gravity * float(friction(np.array([math.hypot(*launch)]))[0])
        return _until_stopped(motion, (*launch, 0.0, 0.0, 0.0), _PATCH_END, 4.0 / least)

    return stop


def ring_patches(
    inner: float, outer: float, radial: int, angular: int
) -> tuple[FloatArray, FloatArray]:
    """Centres of patches between two radii, (2, n), and their weights, in proportion to areas."""
    radii = inner + (outer - inner) * (np.arange(radial) + 0.5) / radial
    angle = 2.0 * np.pi * (np.arange(angular) + 0.5) / angular
    points = np.multiply.outer(np.stack([np.cos(angle), np.sin(angle)]), radii).reshape(2, -1)
    weights = np.tile(radii, angular)
    return points, weights / weights.sum()


def disc_by_patches(vx: float, vy: float, spin: float, delta: float) -> FloatArray:
    """Stop time, x, y of a homogeneous round puck (J = r = 1) by such a script."""
    points, weights = ring_patches(0.0, 1.0, *_GRID)
    return patch_script(points, weights, 0.5**0.5, 0.25 * delta, 1.0, np.ones_like)(vx, vy, spin)


# of Q/(fg), Q²/(fg), asked for; sums under a law by speed take longer
_TOLS, _TOLS_OF_A_LAW = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10), (1e-6, 1e-8)
_GRIDS = (5, 10, 20)  # patches across the shorter way, twice as many along the other
_LAUNCHES = 24  # judged, and timed
_BY_SCIPY = 6  # of them asked of what takes a second


@dataclass(frozen=True)
class ThrownBody:
    """A puck on a base, how friction falls with the slip speed (m/s), and patches of the base.

    ``patches``: (x, y), m, of so many, (2, n), and their weights (n,); ``few``: of the points that
    a physics engine would have it stand on.
    """

    puck: Puck
    law: FrictionLaw | None
    patches: Callable[[int], tuple[FloatArray, FloatArray]]
    few: tuple[FloatArray, FloatArray]

    def friction(self, speed: FloatArray) -> FloatArray:
        """The coefficient at slip speeds (m/s)."""
        return speed * 0.0 + self.puck.friction if self.law is None else self.law.formula(speed)

    def units(self, launches: FloatArray) -> FloatArray:
        """Q/J, Q²/J and Q²/J of launches (3, n), with J = f g at the speed Q."""
        q = np.hypot(np.hypot(*launches[:2]), self.puck.inertia_radius * launches[2])
        return np.stack([q, q * q, q * q]) / (self.puck.gravity * self.friction(q))


def _of_a_box(count: int) -> tuple[FloatArray, FloatArray]:
    """Centres of equal patches of the box, and their weights."""
    x, y = (side * ((np.arange(n) + 0.5) / n - 0.5)
            for side, n in zip(_SIDES, (2 * count, count), strict=True))  # fmt: skip
    points = np.stack(np.meshgrid(x, y)).reshape(2, -1)
    return points, np.full(points.shape[1], 1.0 / points.shape[1])


_SIDES, _BAND = (0.2, 0.1), (0.0555, 0.0635)  # m
# m: of the box, (2, 4)
_CORNERS = 0.5 * np.array([[1.0, 1.0, -1.0, -1.0], [1.0, -1.0, 1.0, -1.0]]) * np.c_[_SIDES,]
_FEW = _CORNERS, np.full(4, 0.25)
_BOX = Puck(base="box:0.2x0.1", friction=0.25, height=0.04)
BODIES = {
    "box": ThrownBody(_BOX, None, _of_a_box, _FEW),
    "box, friction falls with speed": ThrownBody(
        replace(_BOX, friction=0.0, height=0.0), StribeckLaw(0.35, 0.2, 0.1), _of_a_box, _FEW
    ),
    "curling stone": ThrownBody(
        Puck(base="annulus:0.0635x0.0555", height=0.114, mass=19.96, gyration=0.1025),
        CurlingLaw(0.00200985, 0.06385782, 0.00626286),
        lambda count: ring_patches(*_BAND, count, 12 * count), ring_patches(*_BAND, 1, 12),
    ),
}  # fmt: skip


def contenders() -> Iterator[Contender]:
    """All methods to the stop of a body, and what one would write."""
    for name, body in BODIES.items():
        rows = kept_arrays("body_starts.npz")[name]  # vx, vy, ω of launches, and their stops
        launches = np.ascontiguousarray(rows[:3])
        question = Question(name, launches, rows[3:] / body.units(launches), launches)
        for tol in _TOLS if body.law is None else _TOLS_OF_A_LAW:
            make = partial(_integrated, body, tol)
            yield Contender(question, "sums over the base", f"tol={tol:g}", make, _LAUNCHES)
        some, make = question.some(slice(_BY_SCIPY)), partial(_scripted, body, *body.few)
        for patches in map(body.patches, _GRIDS):
            words, many = f"patches={patches[1].size}", partial(_scripted, body, *patches)
            yield Contender(some, "patches and scipy RK45", words, many, 2, outsider=True)
        yield Contender(some, "a few points, RK45", "", make, 2, outsider=True)


def _integrated(body: ThrownBody, tol: float) -> Made:
    """Many launches on one thread."""

    def run(launches: FloatArray) -> FloatArray:
        velocity: Any = launches[:2].T
        spin: Any = launches[2]
        if body.law is None:
            stops = body.puck.stop(velocity, spin, tol=tol, threads=1)
            numbers = stops.stop_time, stops.stop_x, stops.stop_y
        else:
            scene = Scene(body.puck, Floor(law=body.law), Launch(velocity, spin=spin), tol=tol)
            ends = scene.sweep(threads=1)
            numbers = ends.end_time, ends.x, ends.y
        return np.stack(numbers) / body.units(launches)

    return None, run


def _scripted(body: ThrownBody, points: FloatArray, weights: FloatArray) -> Made:
    """What one would write: friction summed over points, scipy's solver over time."""
    k, height, gravity = body.puck.inertia_radius, 0.5 * body.puck.height, body.puck.gravity
    _, run = scripted(patch_script(points, weights, k, height, gravity, body.friction))
    return None, lambda launches: run(launches) / body.units(launches)

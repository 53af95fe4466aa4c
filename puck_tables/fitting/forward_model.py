"""Where a launched puck is at the moments of a film, and how that depends on what is to be found.

Dry friction alone is looked up, or integrated (:mod:`puck_tables.fitting.unit_motions`).

Drag c, in 1/s, that brakes speed and spin alike, v′ = … − c v, ω′ = … − c ω, needs no motion of its
own: v = e^(−ct) V(s), ω = e^(−ct) W(s) with s = (e^(ct) − 1)/c, where V and W are those without
drag, since dry friction depends on their direction only.  So place = ∫ e^(−ct) V dt, by parts

    place = g + 2c ∫ g dt ,  g = e^(−2ct) X(s) ,

and so for every derivative of it; the integral by trapezia, corrected by g′ at their ends.  Drag of
the speed squared, or of the spin alone, is integrated (:mod:`puck_tables.fitting.speed_motion`).
For a homogeneous flat puck under uniform pressure linear drag is the law f(u) = f + (c/g) u of a
coefficient that rises (c > 0) or falls (c < 0) with the slip speed u.

Impacts join slides, of a puck of unit mass against a wall or of two pucks, by the law of
:mod:`puck_tables.motion.impact_law`.
Floor friction has no impulse.  The moment is that at which the rims touch.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.fitting.speed_motion import SPEED_ACCURACY, SpeedFriction, SpeedLaunch, speed_paths
from puck_tables.fitting.unit_motions import Sloped, UnitMotions
from puck_tables.motion.impact_law import along_normal, impulses

_SPEED_STEP = 1e-6  # of a slip at the rim, of a radius, of δ
# from the launch on, besides those asked for: places to 1e-8 of the path, as
# test_a_slide_with_drag_is_elementary tells
_MOMENTS, _DRAGGED = 129, 1e-8

VX, VY, SPIN, DELTA, DECEL, RADIUS, TIME = range(7)  # what states are differentiated to
PLACE, RATE = slice(0, 3), slice(3, 6)  # of a state: x, y, angle and vx, vy, spin


class Moving(NamedTuple):
    """What moves a puck: the scale J m/s², δ, r m, drag c 1/s, and its motions.

    ``by_speed``: f over slip speed, or drags of another kind, in place of the motions; J and δ are
    then those at rest.
    """

    decel: float
    delta: float
    radius: float
    drag: float
    motions: UnitMotions
    by_speed: SpeedFriction | None = None

    @property
    def accuracy(self) -> float:
        """Of a path, to which places are known."""
        if self.by_speed is not None:
            return SPEED_ACCURACY
        return max(self.motions.accuracy, _DRAGGED if self.drag != 0.0 else 0.0)

    def speed_launch(self, at: FloatArray) -> SpeedLaunch:
        """What is integrated of arguments (6,); J does nothing, f of the law is in its place."""
        assert self.by_speed is not None
        height = at[DELTA] * self.by_speed.gravity / self.decel  # 2h/r
        return SpeedLaunch(self.by_speed, height, float(at[RADIUS]), at[:2], float(at[SPIN]))

    def arguments(self, launch: FloatArray) -> FloatArray:
        """Of a launch (6,), what states are differentiated to: vx, vy, ω, δ, J, r."""
        return np.array([*launch[2:5], self.delta, self.decel, self.radius])


def states_of(moving: Moving, launch: FloatArray, times: FloatArray) -> FloatArray:
    """States (6, n) at times (n,) s after a launch: x, y (m), angle (rad), vx, vy (m/s), spin.

    ``launch`` (6,): x, y, vx, vy, spin, angle.

    >>> from puck_tables.fitting.unit_motions import unit_motions_of
    >>> plain = Moving(1.0, 0.5, 1.0, 0.0, unit_motions_of("uniform", 0.5**0.5))
    >>> launch = np.array([0.0, 0.0, 1.0, 0.0, 5.0, 0.0])
    >>> states_of(plain, launch, np.array([2.0]))[0].round(6).tolist()
    [1.590682]
    """
    if moving.by_speed is not None:
        alone = moving.speed_launch(moving.arguments(launch))
        return _placed(launch, speed_paths([alone], times)[0][0])
    return _placed(launch, _path(moving, launch, times, False)[0])


def states_and_slopes(
    moving: Moving, launch: FloatArray, times: FloatArray, nearby: Sequence[Moving] = ()
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """States (6, n), and their derivatives (n, 6, 7) to vx, vy, ω, δ, J, r and time.

    And how states differ (k, 6, n) under what moves a puck in hardly another way.
    """
    if moving.by_speed is not None:
        states, slopes, differ = _by_speed(moving, launch, times, nearby)
        return _placed(launch, states), slopes, differ
    states, slopes = _path(moving, launch, times, True)
    placed = _placed(launch, states)
    differ = np.zeros((len(nearby), *placed.shape))
    for one, change in zip(nearby, differ, strict=True):
        change[:] = states_of(one, launch, times) - placed
    return placed, slopes, differ


def _placed(launch: FloatArray, states: FloatArray) -> FloatArray:
    states[PLACE] += launch[[0, 1, 5], None]
    return states


def _path(moving: Moving, launch: FloatArray, times: FloatArray, want: bool) -> Sloped:
    """States from (0, 0) on, and derivatives if they are wanted."""
    c, at = moving.drag, moving.arguments(launch)
    motions = moving.motions.facing(launch[5])
    if not at[:3].any():
        return np.zeros((6, times.size)), np.zeros((times.size, 6, 7))
    grid = sooner = times
    if c != 0.0:
        grid = np.union1d(times, np.linspace(0.0, float(times.max(initial=0.0)), _MOMENTS))
        sooner = np.expm1(c * grid) / c
    if want:
        states, slopes = motions.states_and_slopes(at, sooner)
    else:
        states, slopes = motions.states(at[:, None], sooner[None])[:, 0], np.empty((0, 6, 7))
    if c == 0.0:
        return states, slopes
    slower, step, where = np.exp(-c * grid), np.diff(grid), np.searchsorted(grid, times)

    def dragged(rows: FloatArray) -> FloatArray:
        """Of places (3, …) and rates (3, …) on the grid those at the moments asked for."""
        rates = rows[RATE] * slower
        near = rows[PLACE] * slower**2
        rise = rates - 2.0 * c * near
        parts = 0.5 * step * (near[..., 1:] + near[..., :-1])
        parts -= step**2 / 12.0 * np.diff(rise, axis=-1)
        near[..., 1:] += 2.0 * c * np.cumsum(parts, axis=-1)
        return np.concatenate([near, rates])[..., where]

    moved = dragged(states)
    if not want:
        return moved, slopes
    out = np.moveaxis(dragged(np.moveaxis(slopes, 0, 2)), 2, 0)
    out[:, PLACE, TIME] = moved[RATE].T
    out[:, RATE, TIME] = slopes[where, RATE, TIME] - c * moved[RATE].T
    return moved, out


def _by_speed(
    moving: Moving, launch: FloatArray, times: FloatArray, nearby: Sequence[Moving]
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Where friction depends on the slip speed, no similarity helps: all by motions nearby."""
    at = moving.arguments(launch)
    scale = max(abs(at[VX]), abs(at[VY]), at[RADIUS] * abs(at[SPIN])) or 1.0
    sizes = {VX: scale, VY: scale, SPIN: scale / at[RADIUS], DELTA: 1.0, RADIUS: at[RADIUS]}
    steps = np.zeros((len(sizes), 6))
    for step, (k, size) in zip(steps, sizes.items(), strict=True):
        step[k] = _SPEED_STEP * size
    launches = [moving.speed_launch(at), *(moving.speed_launch(at + step) for step in steps)]
    launches += [one.speed_launch(one.arguments(launch)) for one in nearby]
    states, gains = speed_paths(launches, times)
    result, differ = states[0], states[1:] - states[0]
    slopes = np.zeros((times.size, 6, 7))
    for k, step, change in zip(sizes, steps, differ, strict=False):
        slopes[:, :, k] = change.T / step[k]
    slopes[:, PLACE, TIME], slopes[:, RATE, TIME] = result[RATE].T, gains.T
    return result, slopes, differ[len(steps) :]


def marked(path: FloatArray, numbers: Mapping[str, float]) -> FloatArray:
    """Places and angles (3, n) of what is tracked on a body with such ones."""
    x, y = numbers["mark_x"], numbers["mark_y"]
    if not x and not y:
        return path
    cosine, sine = np.cos(path[2]), np.sin(path[2])
    return np.stack([path[0] + cosine * x - sine * y, path[1] + sine * x + cosine * y, path[2]])


def turned(launch: FloatArray, states: FloatArray, slopes: FloatArray) -> FloatArray:
    """How states (6, n) change with the angle at which a body that is not round is launched."""
    out: FloatArray = -slopes[:, :, [VX, VY]] @ np.array([-launch[3], launch[2]])
    out[:, [0, 1]] += np.stack([launch[1] - states[1], states[0] - launch[0]], axis=1)
    out[:, [3, 4]] += np.stack([-states[4], states[3]], axis=1)
    return out.T.copy()


STEP = 1e-6  # of a number: of differences, forward and central
LEAST_NUMBER = 1e-2  # that a number is taken to be at least, in its unit, for a step
AS_LAUNCH = [0, 1, 3, 4, 5, 2]  # rows of a state
_NEWTON, _EXACT, _TOUCHES = 12, 1e-10, 1e-6  # of the radius


class WallLine(NamedTuple):
    """A straight wall: cos(angle) x + sin(angle) y = distance (m), the puck where it is less."""

    angle: float
    distance: float


class Rims(NamedTuple):
    """Restitution e, friction μ, tangential restitution β, and mass m₂ of what is met."""

    restitution: float
    friction: float
    tangential: float
    mass: float


class ImpactSpec(NamedTuple):
    """An impact that joins slides.

    ``time`` s: about when; ``reach`` s: it is looked for so near; ``films``: numbers of the one
    track that meets a wall, or of the two whose pucks meet; ``wall``: its number, −1 of two pucks.
    """

    time: float
    reach: float
    films: tuple[int, ...]
    wall: int


class Slide(NamedTuple):
    """A slide from ``since`` s on; its launch (6,): x, y, vx, vy, spin, angle."""

    since: float
    launch: FloatArray


class ImpactState(NamedTuple):
    """What happens at an impact.

    ``time`` s; ``place`` (2,) m of the first puck's centre; ``toward`` rad: the direction to what
    is met; ``ratio``: tangential over normal impulse; ``before``: states (6,) of the pucks there;
    ``touches``: whether the rims do, as they should; ``after``: the slides that follow.
    """

    time: float
    place: FloatArray
    toward: float
    ratio: float
    before: tuple[FloatArray, ...]
    touches: bool
    after: tuple[Slide, ...]


def state_at(moving: Moving, slide: Slide, time: float) -> FloatArray:
    """Launch numbers (6,) of a slide at a time, s."""
    return states_of(moving, slide.launch, np.array([time - slide.since]))[AS_LAUNCH, 0]


def impact_at(
    moving: Moving, gyration: float, rims: Rims, impact_spec: ImpactSpec, before: tuple[Slide, ...],
    wall: WallLine | None,
) -> ImpactState:  # fmt: skip
    """An impact, from the slides before it; ``gyration`` over r; ``wall``: None of two pucks.

    >>> from puck_tables.fitting.unit_motions import unit_motions_of
    >>> puck = Moving(1.0, 0.0, 0.1, 0.0, unit_motions_of("uniform", 0.5**0.5))
    >>> slide = Slide(0.0, np.array([0.0, 0.0, 2.0, 0.0, 0.0, 0.0]))
    >>> impact = impact_at(
    ...     puck, 0.5**0.5, Rims(0.5, 0.1, 0.0, np.inf), ImpactSpec(0.5, 1.0, (0,), 0), (slide,),
    ...     WallLine(0.0, 0.975))
    >>> round(impact.time, 9), impact.after[0].launch[2:4].round(9).tolist()  # 0.875 = 2t − t²/2
    (0.5, [-0.75, 0.0])
    """
    low = max(impact_spec.time - impact_spec.reach, *(slide.since for slide in before))
    high = max(impact_spec.time + impact_spec.reach, low)
    time = min(max(impact_spec.time, low), high)
    for _ in range(_NEWTON):
        states = [state_at(moving, slide, time) for slide in before]
        gap, approach, _, _ = gap_of(states, wall, moving.radius)
        if approach <= 0.0 or abs(gap) <= _EXACT * moving.radius:
            break
        time = min(max(time + gap / approach, low), high)
    after, toward, ratio = after_impact(states, moving.radius, gyration, rims, wall)
    return ImpactState(
        time, states[0][:2], toward, ratio, tuple(states), abs(gap) <= _TOUCHES * moving.radius,
        tuple(Slide(time, state) for state in after),
    )  # fmt: skip


def after_impact(
    states: Sequence[FloatArray], radius: float, gyration: float, rims: Rims, wall: WallLine | None
) -> tuple[list[FloatArray], float, float]:
    """States (6,) after an impact, the direction across, and tangential over normal impulse."""
    _, approach, slip, toward = gap_of(states, wall, radius)
    nx, ny, soft = math.cos(toward), math.sin(toward), 1.0 + 1.0 / rims.mass
    push, rub = 0.0, 0.0
    if approach > 0.0:
        push, rub = impulses(
            approach, slip, soft, (1.0 + gyration**-2) * soft, rims.restitution, rims.tangential,
            rims.friction,
        )  # fmt: skip
    kick = np.array([push * nx - rub * ny, push * ny + rub * nx])
    after = []
    for state, sign, mass in zip(states, (-1.0, 1.0), (1.0, rims.mass), strict=False):
        new = state.copy()
        new[2:4] += sign * kick / mass
        new[4] -= rub / (gyration**2 * radius * mass)
        after.append(new)
    return after, toward, rub / push if push > 0.0 else 0.0


def gap_of(
    states: Sequence[FloatArray], wall: WallLine | None, radius: float
) -> tuple[float, float, float, float]:
    """How far the rims are apart (m), how fast they close and slip (m/s), the direction across."""
    x, y, vx, vy, spin = states[0][:5].tolist()
    if wall is not None:
        nx, ny, toward = math.cos(wall.angle), math.sin(wall.angle), wall.angle
        gap = wall.distance - radius - (x * nx + y * ny)
    else:
        dx, dy, wx, wy, other = (states[1][:5] - [x, y, 0.0, 0.0, 0.0]).tolist()
        apart = math.hypot(dx, dy)
        nx, ny = (dx / apart, dy / apart) if apart > 0.0 else (1.0, 0.0)
        toward = math.atan2(ny, nx)
        gap, vx, vy, spin = apart - 2.0 * radius, vx - wx, vy - wy, spin + other
    return gap, *along_normal(vx, vy, radius * spin, nx, ny), toward


def slopes_after(
    impact: ImpactState, before: Sequence[tuple[FloatArray, FloatArray]], x: FloatArray,
    at: Callable[[FloatArray], tuple[float, float, Rims, WallLine | None]],
) -> list[FloatArray]:  # fmt: skip
    """The derivatives (7, m) of the slides after an impact to unknowns (m,).

    ``before``: those of the states there (6, m), and by time (6,); ``at``: radius m, radius of
    gyration over it, rims and wall under such unknowns.
    """
    slopes = [np.zeros((7, x.size)) for _ in before]

    def moved(k: int, by: float, later: float) -> list[FloatArray]:
        """States at the impact where an unknown is changed."""
        every = zip(impact.before, before, strict=True)
        return [state + by * (slope[:, k] + speed * later) for state, (slope, speed) in every]

    for k in range(x.size):
        step = STEP * max(abs(float(x[k])), LEAST_NUMBER)
        sides = [(by, *at(x + by * (np.arange(x.size) == k))) for by in (step, -step)]
        later = 0.0
        if impact.touches:
            one, two = (gap_of(moved(k, by, 0.0), wall, radius) for by, radius, _, _, wall in sides)
            approach = 0.5 * (one[1] + two[1])
            later = (one[0] - two[0]) / (2.0 * step * approach) if approach > 0.0 else 0.0
        ends = [after_impact(moved(k, by, later), radius, gyration, rims, wall)[0]
                for by, radius, gyration, rims, wall in sides]  # fmt: skip
        # a state holds x, y, vx, vy, spin, angle as a launch does
        for out, first, second in zip(slopes, *ends, strict=True):
            out[0, k], out[1:, k] = later, (first - second) / (2.0 * step)
    return slopes

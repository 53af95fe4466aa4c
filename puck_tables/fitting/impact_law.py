"""Slides that impacts join: a puck against a wall, or two pucks.

With n the direction to what is met, t = n turned by +90°, radius r and radius of gyration k of the
puck, the approach is u_n and the slip of the rims u_t,

    wall:       u_n = v·n ,             u_t = v·t + r ω ,
    two pucks:  u_n = (v₁ − v₂)·n ,     u_t = (v₁ − v₂)·t + r (ω₁ + ω₂) ,

and the impulses, of a puck of unit mass with m₂ = ∞ for a wall,

    1/m_n = 1 + 1/m₂ ,  1/m_t = (1 + r²/k²) (1 + 1/m₂) ,
    P_n = (1 + e) m_n u_n ,   P_t = (1 + e_t) m_t u_t , at most μ P_n in size,

change v₁ by −(P_n n + P_t t), v₂ by that over m₂, and the spins by −r P_t/k² each, over the mass.
Floor friction has no impulse.  The moment is that at which the rims touch.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.fitting.forward_model import Moving, states_of

AS_LAUNCH = [0, 1, 3, 4, 5, 2]  # rows of a state
_NEWTON, _EXACT, _TOUCHES = 12, 1e-10, 1e-6  # of the radius


class WallLine(NamedTuple):
    """A straight wall: cos(angle) x + sin(angle) y = distance (m), the puck where it is less."""

    angle: float
    distance: float


class Rims(NamedTuple):
    """Restitution e, friction μ, tangential restitution e_t, and mass m₂ of what is met."""

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

    Examples
    --------
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
        gap, approach, _ = gap_of(states, wall, moving.radius)
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
    _, approach, toward = gap_of(states, wall, radius)
    normal = np.array([math.cos(toward), math.sin(toward)])
    tangent = np.array([-normal[1], normal[0]])
    slip = float(states[0][2:4] @ tangent) + radius * float(states[0][4])
    if wall is None:
        slip += radius * float(states[1][4]) - float(states[1][2:4] @ tangent)
    lightness = 1.0 + 1.0 / rims.mass
    push = (1.0 + rims.restitution) * max(approach, 0.0) / lightness
    most = rims.friction * push if push > 0.0 else 0.0
    wish = (1.0 + rims.tangential) * slip / ((1.0 + gyration**-2) * lightness)
    rub = min(max(wish, -most), most)
    kick = push * normal + rub * tangent
    after = []
    for state, sign, mass in zip(states, (-1.0, 1.0), (1.0, rims.mass), strict=False):
        new = state.copy()
        new[2:4] += sign * kick / mass
        new[4] -= rub / (gyration**2 * radius * mass)
        after.append(new)
    return after, toward, rub / push if push > 0.0 else 0.0


def gap_of(
    states: Sequence[FloatArray], wall: WallLine | None, radius: float
) -> tuple[float, float, float]:
    """How far the rims are apart (m), how fast they close (m/s), and the direction across."""
    if wall is not None:
        normal = np.array([math.cos(wall.angle), math.sin(wall.angle)])
        gap = wall.distance - radius - float(states[0][:2] @ normal)
        return gap, float(states[0][2:4] @ normal), wall.angle
    across = states[1][:2] - states[0][:2]
    apart = math.hypot(*across)
    normal = across / apart if apart > 0.0 else np.array([1.0, 0.0])
    closing = float((states[0][2:4] - states[1][2:4]) @ normal)
    return apart - 2.0 * radius, closing, math.atan2(normal[1], normal[0])

"""Quasi-static pushing: a finger or a fence at a puck, that sticks there or slides along.

It moves straight, so slowly that forces of inertia count nothing; the puck moves with the twist of
:func:`puck_tables.kernels.base_push.push_twist`, and its place and angle are integrated.
"""

from __future__ import annotations

import cmath
import math
from bisect import bisect_right
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import ClassVar, NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.integrate import solve_ivp

from puck_tables._core.arrays import FloatArray, finite_array, instance, one_velocity, real, whole
from puck_tables.contact.base import Base
from puck_tables.errors import ContactError, InputError
from puck_tables.io.columns import Dataset, following, variable
from puck_tables.kernels.base_push import UNKNOWN
from puck_tables.motion.puck_spec import PuckSpec
from puck_tables.result import Result
from puck_tables.wrench.fence import Fence, Finger, OutlinePiece, Pushing, laid_on

_ON_IT = 1e-6  # of the reach: as far from the outline a finger may be
_TOL = 1e-10  # of the reach, and rad, of a step
_LONGEST, _MOST = 1000.0, 1_000_000  # path of what pushes over the reach; states
_MOST_LEGS = 1000  # in which the puck lies otherwise
CONTACTS = (
    "sticks", "slides left", "slides right", "apart", "flush, sticks", "flush, slides left",
    "flush, slides right",
)  # fmt: skip
_COLUMNS = ("x", "y", "orientation", "vx", "vy", "spin", "push_x", "push_y", "finger_x", "finger_y")


@dataclass(frozen=True, eq=False, repr=False)
class Push(Result):
    """A puck that a finger or a fence pushes, from :func:`puck_tables.push`.

    Attributes
    ----------
    puck : Puck
    time : array (n,), s
    x, y, orientation : arrays (n,), m, m, rad
        Displacement of the centre of mass, and angle of the body.
    vx, vy, spin : arrays (n,), m/s, m/s, rad/s
    push_x, push_y : arrays (n,), N
        Force of the finger on the puck.
    finger_x, finger_y : arrays (n,), m
        Where it acts, from where the centre of mass was at first: the place of the finger.
    contact : list of str
        What the finger does: sticks, slides left, slides right (as it sees the puck), or apart:
        it does not press on; of a fence that lies on a side flush, and the same.
    fence : Fence, or None: a finger
    fence_x, fence_y : arrays (n,), m
        Where the middle of that is, or the finger.
    end : str
        Why the states end.
    """

    puck: PuckSpec
    time: FloatArray
    x: FloatArray
    y: FloatArray
    orientation: FloatArray
    vx: FloatArray
    vy: FloatArray
    spin: FloatArray
    push_x: FloatArray
    push_y: FloatArray
    finger_x: FloatArray
    finger_y: FloatArray
    codes: npt.NDArray[np.int8] = field(repr=False)
    fence: Fence | None
    fence_x: FloatArray = field(repr=False)
    fence_y: FloatArray = field(repr=False)
    end: str

    picture: ClassVar[str] = "push"

    def __repr__(self) -> str:
        return (
            f"Push({self.time.size} states, {self.contact[0]}, {self.time[-1]:.6g} s: {self.end})"
        )

    def __str__(self) -> str:
        force = np.hypot(self.push_x, self.push_y)
        return (
            f"The puck moves by ({self.x[-1]:.6g}, {self.y[-1]:.6g}) m and turns by "
            f"{math.degrees(self.orientation[-1] - self.orientation[0]):.6g} degrees in "
            f"{self.time[-1]:.6g} s: {self.end}.\n"
            f"The {_name(self.fence)}: {', then '.join(dict.fromkeys(self.contact))}; its force is "
            f"{force.min():.4g} to {force.max():.4g} N."
        )

    def __getattr__(self, name: str) -> FloatArray:
        """A column that follows from others: ``speed`` (n,) m/s."""
        return following(self, name)

    @property
    def contact(self) -> list[str]:
        """What the finger does, of each state."""
        return [CONTACTS[code] for code in self.codes]

    def explain(self) -> str:
        """How it was got."""
        return (
            "quasi-static: the twist whose friction is along a force at the contact, within its "
            f"cone of friction; {self.end}"
        )

    def dataset(self) -> Dataset:
        """States over time."""
        columns = {name: variable(name, getattr(self, name), ("time",)) for name in _COLUMNS}
        columns["touch"] = variable("touch", self.codes, ("time",), CONTACTS)
        axes = {"time": variable("time", self.time, ("time",))}
        return Dataset(axes, columns, {
            "title": f"A puck that a {_name(self.fence)} pushes", **self.puck.described(),
            "end": self.end,
        })  # fmt: skip


class _Ending(NamedTuple):
    """What ends a push, where it falls to 0."""

    of: Callable[[float, FloatArray], float]
    terminal: bool = True
    direction: float = -1.0

    def __call__(self, t: float, y: FloatArray) -> float:
        return self.of(t, y)


def push(
    puck: PuckSpec, at: npt.ArrayLike | Fence, velocity: npt.ArrayLike, friction: float, *,
    angle: float = 0.0, duration: float = 0.0, frames: int = 101,
) -> Push:  # fmt: skip
    """Push a puck slowly with a finger, or with a fence.

    Parameters
    ----------
    puck : Puck
        On a base, or round under uniform pressure in full contact.
    at : (x, y), m, or a Fence
        Where the finger touches, on the outline of the base and in its axes.
    velocity : (vx, vy), m/s, of the finger or the fence over the floor
    friction : coefficient of friction between that and the puck, ≥ 0
    angle : rad, by which the base is turned at first
    duration : s; 0: how it begins, one state
    frames : how many states, equally spaced over the duration

    Raises
    ------
    InputError
        If the finger is not on the outline, the fence moves away, an argument is out of range, or
        the puck of a kind that this does not know.
    ContactError
        If no slip was found in which friction, finger and floor agree.

    Notes
    -----
    The force at the contact lies in its cone of friction, inside it where the finger sticks, and
    friction of the floor balances it: an interior of the cone leaves one unknown, an edge none.
    States end where the finger comes to a corner, or presses on no more.  A fence turns the puck
    about a corner until a side is flush; it stays so if the line along which the fence would move
    it, through the centre of mass, passes between the corners of that side.

    References
    ----------
    M. T. Mason, Mechanics and planning of manipulator pushing operations, Int. J. Robotics
    Research 5, 1986.  K. M. Lynch, M. T. Mason, Stable pushing, Int. J. Robotics Research 15, 1996.

    Examples
    --------
    >>> import puck_tables as pt
    >>> box = pt.Puck(base="box:0.2x0.1", friction=0.3, mass=2.0)
    >>> run = pt.push(box, (-0.1, 0.02), (0.05, 0.0), 0.5)
    >>> run.contact, float(run.spin[0].round(6))
    (['sticks'], -0.073397)
    """
    instance("puck", puck, PuckSpec)
    if puck.friction == 0.0:
        raise InputError("a puck with friction = 0 is not pushed slowly: give friction > 0")
    base = _base_of(puck)
    if not (grip := real("friction", friction, "a coefficient")) >= 0.0:
        raise InputError(f"friction of what pushes must not be negative, got {grip:g}")
    moving = complex(*one_velocity(velocity))
    speed = abs(moving)
    if not 0.0 < speed < math.inf:
        raise InputError(f"velocity of what pushes is {speed:g}: it pushes nothing")
    if not (span := speed * real("duration", duration, "s")) >= 0.0:
        raise InputError(f"duration must not be negative, got {duration:g} s")
    if not span <= _LONGEST * base.reach:
        raise InputError(
            f"a push of {span:g} m is longer than {_LONGEST:g} times the reach of the base"
        )
    frames = whole("frames", frames, 1, _MOST)
    turned = real("angle", angle, "rad")
    turn = cmath.rect(1.0, turned)
    parts = puck.packed_base, moving / speed, grip
    begun, fence = np.array([0.0, 0.0, turned]), None
    if isinstance(at, Fence):
        fence = at
        pushing: Pushing = laid_on(*parts, _points_of(base), at, begun)
    else:
        own, side = _touched(base, at)
        pushing = Finger(*parts, own * turn, side)
    if pushing.at(0.0, begun)[1] == UNKNOWN:
        raise ContactError(f"no slip was found in which {_name(fence)} and floor agree")
    legs, last, end = [_Leg(pushing, 0.0, lambda _: begun)], 0.0, "how it begins"
    if span > 0.0:
        legs, last, end = _followed(pushing, begun, span, base.reach, _name(fence))
    path = np.linspace(0.0, last, frames if last > 0.0 else 1)
    legs_at = [_leg_at(legs, s) for s in path.tolist()]
    x, y, orientation = np.array([state for state, *_ in legs_at]).T
    vx, vy, spin, push_x, push_y, place_x, place_y = np.array([rates for _, rates, _ in legs_at]).T
    load, start, heading = puck.friction * puck.mass * puck.gravity, pushing.start, pushing.heading
    return Push(
        puck, path / speed, x, y, orientation, speed * vx, speed * vy, speed * spin,
        load * push_x, load * push_y, place_x, place_y,
        np.array([code for *_, code in legs_at], np.int8), fence,
        start.real + path * heading.real, start.imag + path * heading.imag, end,
    )  # fmt: skip


class _Leg(NamedTuple):
    """A way of pushing, from where along the path, and the states along it."""

    pushing: Pushing
    begin: float
    states: Callable[[float], FloatArray]


def _leg_at(legs: list[_Leg], s: float) -> tuple[FloatArray, FloatArray, int]:
    """State, twist and force, and how it touches, so far along the path."""
    leg = legs[bisect_right(legs, s, key=lambda one: one.begin) - 1]
    state = leg.states(s)
    return state, *leg.pushing.at(s, state)


def _followed(
    pushing: Pushing, y: FloatArray, span: float, reach: float, name: str
) -> tuple[list[_Leg], float, str]:
    """The push along a path, leg by leg, until it ends; where that is, and why."""
    legs: list[_Leg] = []
    last = 0.0
    if pushing.presses(0.0, y) < 0.0:
        return [_Leg(pushing, 0.0, lambda _: y)], 0.0, "it does not press on"
    while len(legs) < _MOST_LEGS:
        run = solve_ivp(
            pushing.rate, (last, span), y, method="DOP853", rtol=1e-10,
            atol=np.array([_TOL * reach, _TOL * reach, _TOL]), dense_output=True,
            events=[_Ending(pushing.room), _Ending(pushing.presses)],
            max_step=min(0.05 * span, 0.25 * reach),
        )  # fmt: skip
        if not run.success:
            raise ContactError(f"the push could not be followed: {run.message}")
        legs.append(_Leg(pushing, last, run.sol))
        last, y = float(run.t[-1]), run.y[:, -1]
        if run.t_events[1].size:
            if pushing.at(last, y)[1] != UNKNOWN:
                return legs, last, f"the {name} presses on no more"
            raise ContactError(
                f"after {last / abs(span):.6g} of its path no slip was found in which {name} and "
                "floor agree"
            )
        after = pushing.after(last, y) if run.t_events[0].size else "time is up"
        if isinstance(after, str):
            return legs, last, after
        pushing = after
    raise ContactError(f"a puck that comes to lie on a fence {_MOST_LEGS} times is not followed")


def _base_of(puck: PuckSpec) -> Base:
    """What of a puck touches the floor, under linear pressure."""
    if puck.shape is not None:
        return puck.shape
    if not (puck.body.law.can_lift and puck.delta <= 1.0):
        raise InputError(
            "push knows pucks on a base, and round ones under uniform pressure in full contact: "
            "give a base, as base='annulus:0.05x0.03'"
        )
    return Base.disc(puck.radius)


def _points_of(base: Base) -> FloatArray:
    """Corners and rims that a fence may touch, (n, 3): from the centre of mass, and radii, m."""
    corners = [(x, y, 0.0) for outline in base.outlines for x, y in outline]
    rims = [(x, y, radius) for x, y, radius, sign in base.discs if sign > 0.0]
    points: FloatArray = np.array(corners + rims) - np.append(base.middle, 0.0)
    return points


def _name(fence: Fence | None) -> str:
    return "finger" if fence is None else "fence"


def _touched(base: Base, at: npt.ArrayLike) -> tuple[complex, OutlinePiece]:
    """A place on the outline of a base, from its centre of mass, and the piece on which it lies."""
    place = finite_array("at", at, "m")
    if place.shape != (2,):
        raise InputError("at must be two numbers (x, y), m, in the axes of the base")
    middle = complex(*base.middle)
    point = complex(*place.tolist()) - middle
    sides = [
        OutlinePiece(complex(x, y) - middle, complex(radius, 0.0), math.inf)
        for x, y, radius, sign in base.discs if sign > 0.0
    ]  # fmt: skip
    for outline in base.outlines:
        corners = [complex(*corner) - middle for corner in outline]
        for one, other in zip(corners, corners[1:] + corners[:1], strict=True):
            length = abs(other - one)
            sides.append(OutlinePiece(one, (other - one) / length, length))
    nearest = min(sides, key=lambda side: side.distance(point))
    if nearest.distance(point) > _ON_IT * base.reach:
        raise InputError(
            f"at ({place[0]:g}, {place[1]:g}) m the finger is {nearest.distance(point):.3g} m from "
            "the outline of the base: give a place on it, in the axes of the base"
        )
    if not math.isinf(nearest.length):
        share = nearest.place(point)[2]
        if min(share, nearest.length - share) < _ON_IT * base.reach:
            raise InputError(
                f"at ({place[0]:g}, {place[1]:g}) m the finger is at a corner, where the outline "
                "has no normal: move it along a side"
            )
    return point, nearest

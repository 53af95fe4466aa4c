"""Quasi-static pushing: a finger at the outline of a puck, that sticks there or slides along.

The finger moves straight, so slowly that forces of inertia count nothing; the puck moves with the
twist of :func:`puck_tables.kernels.base_push.push_twist`, and its place and angle are integrated.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import ClassVar, NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.integrate import solve_ivp

from puck_tables._core.arrays import FloatArray
from puck_tables._core.real import finite_array, instance, one_velocity, real, whole
from puck_tables.contact.base import Base
from puck_tables.errors import ContactError, InputError
from puck_tables.io.columns import following
from puck_tables.io.dataset import Dataset, variable
from puck_tables.kernels.base_friction import packed
from puck_tables.kernels.base_push import APART, UNKNOWN, push_twist
from puck_tables.motion.puck_spec import PuckSpec
from puck_tables.result import Result

_ON_IT = 1e-6  # of the reach: as far from the outline a finger may be
_TOL = 1e-10  # of the reach, and rad, of a step
_LONGEST, _MOST = 1000.0, 1_000_000  # path of a finger over the reach; states
CONTACTS = ("sticks", "slides left", "slides right", "apart")
_COLUMNS = ("x", "y", "orientation", "vx", "vy", "spin", "push_x", "push_y", "finger_x", "finger_y")


class _Side(NamedTuple):
    """A piece of an outline, from the centre of mass: a straight side or a circle (length inf).

    ``begin``: its beginning or middle; ``along``: its unit tangent, the base to the left, or 0 and
    the radius.
    """

    begin: complex
    along: complex
    length: float

    def place(self, finger: complex) -> tuple[complex, complex, float]:
        """Contact, normal into the base, and how far along the side a finger is."""
        if math.isinf(self.length):
            normal = (self.begin - finger) / abs(self.begin - finger)
            return self.begin - self.along.real * normal, normal, 0.0
        way = (finger - self.begin) / self.along
        return self.begin + way.real * self.along, 1j * self.along, way.real

    def distance(self, finger: complex) -> float:
        """How far it is from a finger."""
        contact, _, way = self.place(finger)
        end = self.begin + min(max(way, 0.0), self.length) * self.along
        return abs(finger - (contact if math.isinf(self.length) else end))


@dataclass(frozen=True, eq=False, repr=False)
class Push(Result):
    """A puck that a finger pushes, from :func:`puck_tables.push`.

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
        Place of the finger, from where the centre of mass was at first.
    contact : list of str
        What the finger does: sticks, slides left, slides right (as it sees the puck), or apart:
        it does not press on.
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
            f"The finger: {', then '.join(dict.fromkeys(self.contact))}; its force is "
            f"{force.min():.4g} to {force.max():.4g} N."
        )

    def __getattr__(self, name: str) -> FloatArray:
        """A column that follows from others: ``speed`` (n,) m/s."""
        column: FloatArray = following(self, name)
        return column

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
            "title": "A puck that a finger pushes", **self.puck.described(), "end": self.end,
        })  # fmt: skip


class _Ending(NamedTuple):
    """What ends a push, where it falls to 0."""

    of: Callable[[float, FloatArray], float]
    terminal: bool = True
    direction: float = -1.0

    def __call__(self, t: float, y: FloatArray) -> float:
        return self.of(t, y)


@dataclass(frozen=True)
class _Pushing:
    """A base, the piece of its outline that a finger touches, and the finger.

    Slow pushes do not depend on the speed: the finger moves by ``heading``, and its path is time.
    """

    base: FloatArray
    side: _Side
    finger: complex
    heading: complex
    friction: float

    def at(self, t: float, y: FloatArray) -> tuple[FloatArray, int, float]:
        """Twist and force over f N in the axes of the floor, how it touches, place on the side."""
        turn = complex(math.cos(y[2]), math.sin(y[2]))
        own = (self.finger + t * self.heading - complex(y[0], y[1])) / turn
        contact, normal, place = self.side.place(own)
        velocity, out = self.heading / turn, np.empty(5)
        code = push_twist(
            self.base, velocity.real, velocity.imag, contact.real, contact.imag, normal.real,
            normal.imag, self.friction, out, np.empty(3), np.empty((3, 3)),
        )  # fmt: skip
        moved, force = turn * complex(out[0], out[1]), turn * complex(out[3], out[4])
        return np.array([moved.real, moved.imag, out[2], force.real, force.imag]), code, place

    def rate(self, t: float, y: FloatArray) -> FloatArray:
        """The twist."""
        return self.at(t, y)[0][:3]

    def room(self, t: float, y: FloatArray) -> float:
        """How far the finger is from the ends of its side; never, of a circle."""
        place = self.at(t, y)[2]
        return 1.0 if math.isinf(self.side.length) else min(place, self.side.length - place)

    def presses(self, t: float, y: FloatArray) -> float:
        """1 where it presses on, −1 where it does not, or no slip was found."""
        return -1.0 if self.at(t, y)[1] in (APART, UNKNOWN) else 1.0


def push(
    puck: PuckSpec, at: npt.ArrayLike, velocity: npt.ArrayLike, friction: float, *,
    angle: float = 0.0, duration: float = 0.0, frames: int = 101,
) -> Push:  # fmt: skip
    """Push a puck slowly with a finger.

    Parameters
    ----------
    puck : Puck
        On a base, or round under uniform pressure in full contact.
    at : (x, y), m
        Where the finger touches, on the outline of the base and in its axes.
    velocity : (vx, vy), m/s, of the finger over the floor
    friction : coefficient of friction between finger and puck, ≥ 0
    angle : rad, by which the base is turned at first
    duration : s; 0: how it begins, one state
    frames : how many states, equally spaced over the duration

    Returns
    -------
    Push

    Raises
    ------
    InputError
        If the finger is not on the outline, an argument is out of range, or the puck of a kind
        that this does not know.
    ContactError
        If no slip was found in which friction, finger and floor agree.

    Notes
    -----
    The force at the contact lies in its cone of friction, inside it where the finger sticks, and
    friction of the floor balances it: an interior of the cone leaves one unknown, an edge none.
    States end where the finger comes to a corner, or presses on no more.

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
        raise InputError(f"friction of the finger must not be negative, got {grip:g}")
    moving = complex(*one_velocity(velocity))
    speed = abs(moving)
    if not 0.0 < speed < math.inf:
        raise InputError(f"velocity of the finger is {speed:g}: it pushes nothing")
    if not (span := speed * real("duration", duration, "s")) >= 0.0:
        raise InputError(f"duration must not be negative, got {duration:g} s")
    if not span <= _LONGEST * base.reach:
        raise InputError(
            f"a push of {span:g} m is longer than {_LONGEST:g} times the reach of the base"
        )
    frames = whole("frames", frames, 1, _MOST)
    turned = real("angle", angle, "rad")
    own, side = _touched(base, at)
    begun = own * complex(math.cos(turned), math.sin(turned))
    finger = _Pushing(packed(base, puck.lever), side, begun, moving / speed, grip)
    y = np.array([0.0, 0.0, turned])
    if finger.at(0.0, y)[1] == UNKNOWN:
        raise ContactError("no slip was found in which finger and floor agree")
    if span == 0.0:
        return _result(puck, finger, speed, np.zeros(1), y[:, None], "how it begins")
    return _followed(puck, finger, speed, y, span, frames, base.reach)


def _followed(
    puck: PuckSpec, finger: _Pushing, speed: float, y: FloatArray, span: float, count: int,
    reach: float,
) -> Push:  # fmt: skip
    """The push along a path of the finger, until it ends."""
    if finger.presses(0.0, y) < 0.0:
        return _result(puck, finger, speed, np.zeros(1), y[:, None], "it does not press on")
    run = solve_ivp(
        finger.rate, (0.0, span), y, method="DOP853", rtol=1e-10,
        atol=np.array([_TOL * reach, _TOL * reach, _TOL]), dense_output=True,
        events=[_Ending(finger.room), _Ending(finger.presses)],
        max_step=min(0.05 * span, 0.25 * reach),
    )  # fmt: skip
    if not run.success:
        raise ContactError(f"the push could not be followed: {run.message}")
    last = float(run.t[-1])
    end = "time is up"
    if run.t_events[0].size:
        end = "the finger comes to a corner"
    elif run.t_events[1].size:
        if finger.at(last, run.y[:, -1])[1] == UNKNOWN:
            raise ContactError(
                f"after {last / speed:.6g} s no slip was found in which finger and floor agree"
            )
        end = "the finger presses on no more"
    path = np.linspace(0.0, last, count)
    return _result(puck, finger, speed, path, run.sol(path), end)


def _result(
    puck: PuckSpec, finger: _Pushing, speed: float, path: FloatArray, states: FloatArray, end: str
) -> Push:
    found = [finger.at(s, states[:, n])[:2] for n, s in enumerate(path.tolist())]
    rows = np.array([one for one, _ in found]).T
    load = puck.friction * puck.mass * puck.gravity
    begin, heading = finger.finger, finger.heading
    place_x, place_y = begin.real + path * heading.real, begin.imag + path * heading.imag
    codes = np.array([code for _, code in found], np.int8)
    x, y, orientation = states
    vx, vy, spin, push_x, push_y = rows
    return Push(
        puck, path / speed, x, y, orientation, speed * vx, speed * vy, speed * spin,
        load * push_x, load * push_y, place_x, place_y, codes, end,
    )  # fmt: skip


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


def _touched(base: Base, at: npt.ArrayLike) -> tuple[complex, _Side]:
    """A place on the outline of a base, from its centre of mass, and the piece on which it lies."""
    place = finite_array("at", at, "m")
    if place.shape != (2,):
        raise InputError("at must be two numbers (x, y), m, in the axes of the base")
    middle = complex(*base.middle)
    point = complex(*place.tolist()) - middle
    sides = [
        _Side(complex(x, y) - middle, complex(radius, 0.0), math.inf)
        for x, y, radius, sign in base.discs if sign > 0.0
    ]  # fmt: skip
    for outline in base.outlines:
        corners = [complex(*corner) - middle for corner in outline]
        for one, other in zip(corners, corners[1:] + corners[:1], strict=True):
            length = abs(other - one)
            sides.append(_Side(one, (other - one) / length, length))
    nearest = min(sides, key=lambda side: side.distance(point))
    if nearest.distance(point) > _ON_IT * base.reach:
        raise InputError(
            f"at ({place[0]:g}, {place[1]:g}) m the finger is {nearest.distance(point):.3g} m from "
            "the outline of the base: give a place on it, in the axes of the base"
        )
    if not math.isinf(nearest.length):
        way = nearest.place(point)[2]
        if min(way, nearest.length - way) < _ON_IT * base.reach:
            raise InputError(
                f"at ({place[0]:g}, {place[1]:g}) m the finger is at a corner, where the outline "
                "has no normal: move it along a side"
            )
    return point, nearest

"""What pushes a base slowly: a finger on a piece of its outline, or a straight fence.

A fence touches a corner or a rim of the convex hull, or it lies flush on a side of that, two
points of which it presses.  Flush the base goes on without a turn, since friction of a
translation is along a line through the centre of mass, as long as that line meets the fence
between both points; else the base turns about the nearer of them.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray, positive, real
from puck_tables.errors import InputError
from puck_tables.kernels.base_friction import REACH
from puck_tables.kernels.base_push import APART, LEFT, RIGHT, STICKS, UNKNOWN, push_twist

_TOUCHES = 1e-8  # of the reach: how well the moment is known at which a corner meets a fence
_TURNS = "the puck turns about an end of the fence"
FLUSH = 4  # after how a finger touches: the same of a fence that lies flush


@dataclass(frozen=True)
class Fence:
    """A straight pusher, endless or of a width, which is moved up to a puck until it touches.

    ``facing``: rad, where its face looks, to the puck, in the axes of the floor; ``width``: m;
    ``offset``: m, how far to the left of the centre of mass its middle is at first.  What turns
    about an end of it is pushed there by a finger: the states end.

    >>> import puck_tables as pt
    >>> box = pt.Puck(base="box:0.2x0.1", friction=0.3)
    >>> run = pt.push(box, pt.Fence(), (0.05, 0.0), 0.3, angle=0.3, duration=8.0)
    >>> run.contact[0], run.contact[-1], abs(float(run.orientation[-1].round(6)))
    ('sticks', 'flush, sticks', 0.0)
    """

    facing: float = 0.0
    width: float = math.inf
    offset: float = 0.0

    def __post_init__(self) -> None:
        for name, unit in (("facing", "rad"), ("offset", "m")):
            object.__setattr__(self, name, real(name, getattr(self, name), unit))
        if self.width != math.inf:
            object.__setattr__(self, "width", positive("width", self.width, "m"))


class OutlinePiece(NamedTuple):
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
        share = (finger - self.begin) / self.along
        return self.begin + share.real * self.along, 1j * self.along, share.real

    def distance(self, finger: complex) -> float:
        """How far it is from a finger."""
        contact, _, share = self.place(finger)
        end = self.begin + min(max(share, 0.0), self.length) * self.along
        return abs(finger - (contact if math.isinf(self.length) else end))


@dataclass(frozen=True)
class Pushing:
    """A base under what pushes it, which moves by ``heading``: slow pushes have no speed.

    ``start``: where it is at first, from the centre of mass then; its path is time.
    """

    base: FloatArray
    heading: complex
    friction: float
    start: complex

    def touch(self, own: complex, turn: complex) -> tuple[complex, complex, float]:
        """Contact and normal in the axes of the base, turned so, and the room until it ends.

        ``own``: where what pushes is, in these axes.
        """
        raise NotImplementedError

    def after(self, t: float, y: FloatArray) -> Pushing | str:
        """What pushes where there is no more room, or why the states end."""
        raise NotImplementedError

    def own(self, t: float, y: FloatArray) -> tuple[complex, complex]:
        """Where what pushes is, in the axes of the base, and how these are turned."""
        turn = cmath.rect(1.0, y[2])
        return (self.start + t * self.heading - complex(y[0], y[1])) / turn, turn

    def at(self, t: float, y: FloatArray) -> tuple[FloatArray, int]:
        """Twist, force over f N and the place of that in the axes of the floor; how it touches."""
        own, turn = self.own(t, y)
        contact, normal, _ = self.touch(own, turn)
        velocity, out = self.heading / turn, np.empty(5)
        code = push_twist(
            self.base, velocity.real, velocity.imag, contact.real, contact.imag, normal.real,
            normal.imag, self.friction, out, np.empty(3), np.empty((3, 3)),
        )  # fmt: skip
        moved, force = turn * complex(out[0], out[1]), turn * complex(out[3], out[4])
        place = turn * contact + complex(y[0], y[1])
        return np.array([
            moved.real, moved.imag, out[2], force.real, force.imag, place.real, place.imag,
        ]), code  # fmt: skip

    def rate(self, t: float, y: FloatArray) -> FloatArray:
        """The twist."""
        return self.at(t, y)[0][:3]

    def room(self, t: float, y: FloatArray) -> float:
        """How far it is from touching otherwise."""
        return self.touch(*self.own(t, y))[2]

    def presses(self, t: float, y: FloatArray) -> float:
        """1 where it presses on, −1 where it does not, or no slip was found."""
        return -1.0 if self.at(t, y)[1] in (APART, UNKNOWN) else 1.0


@dataclass(frozen=True)
class Finger(Pushing):
    """A finger on a side."""

    side: OutlinePiece

    def touch(self, own: complex, turn: complex) -> tuple[complex, complex, float]:
        """The room is along the side."""
        contact, normal, place = self.side.place(own)
        ends = math.isinf(self.side.length)
        return contact, normal, 1.0 if ends else min(place, self.side.length - place)

    def after(self, t: float, y: FloatArray) -> str:
        """No corner has a normal."""
        return "the finger comes to a corner"


@dataclass(frozen=True)
class Along(Pushing):
    """A fence on one of the points (n, 3) of a base: places from the centre of mass, and radii.

    ``normal``: of the fence, in the axes of the floor; ``half``: its width; ``which``: the point.
    """

    points: FloatArray
    normal: complex
    half: float
    which: int

    def _gaps(self, own: complex, turn: complex) -> tuple[FloatArray, FloatArray]:
        """How far all points are from the fence, and how far along it, to the left."""
        away = (self.points[:, 0] + 1j * self.points[:, 1] - own) * (turn / self.normal)
        return away.real - self.points[:, 2], away.imag

    def touch(self, own: complex, turn: complex) -> tuple[complex, complex, float]:
        """The room is that of all other points to the fence, and of this one to its ends."""
        (gaps, along), normal = self._gaps(own, turn), self.normal / turn
        x, y, radius = self.points[self.which].tolist()
        room = self.half - abs(along[self.which])
        room = min(room, np.delete(gaps, self.which).min(initial=math.inf))
        return complex(x, y) - radius * normal, normal, float(room)

    def after(self, t: float, y: FloatArray) -> Pushing | str:
        """The fence flush on a side, or on the corner about which the base turns away from it."""
        own, turn = self.own(t, y)
        gaps, along = self._gaps(own, turn)
        touching = np.flatnonzero(gaps <= gaps.min() + _TOUCHES * self.base[REACH])
        first, last = touching[along[touching].argmin()], touching[along[touching].argmax()]
        direction = self.heading / self.normal
        slope = min(max(direction.imag / direction.real, -self.friction), self.friction)
        acts = _acts(own * turn / self.normal, slope)
        parts = self.base, self.heading, self.friction, self.start, self.points, self.normal
        inside = self.half - _TOUCHES * self.base[REACH]
        low, high = max(along[first], -inside), min(along[last], inside)
        if low > high:
            return "the puck comes to an end of the fence"
        if low <= acts <= high and first != last:
            return Flush(*parts, self.half, -1, slope)
        which = int(first if acts < low else last)
        return Along(*parts, self.half, which) if abs(along[which]) <= inside else _TURNS


def _acts(fence: complex, slope: float) -> float:
    """How far along a fence, at ``fence`` from the centre of mass in its axes, the force acts."""
    return slope * fence.real - fence.imag


@dataclass(frozen=True)
class Flush(Along):
    """A fence that lies on a side: base and force go ``slope`` times as far along as into it."""

    slope: float

    def at(self, t: float, y: FloatArray) -> tuple[FloatArray, int]:
        """In closed form: no turn, and f N along the motion."""
        own, turn = self.own(t, y)
        direction, push = self.heading / self.normal, complex(1.0, self.slope) * self.normal
        moved, force = direction.real * push, push / abs(push)
        place = self.start + t * self.heading
        place += 1j * self.normal * _acts(own * turn / self.normal, self.slope)
        code = LEFT if direction.imag / direction.real > self.slope else RIGHT
        code = STICKS if direction.imag / direction.real == self.slope else code
        return np.array([
            moved.real, moved.imag, 0.0, force.real, force.imag, place.real, place.imag,
        ]), FLUSH + code  # fmt: skip

    def room(self, t: float, y: FloatArray) -> float:
        """From the force to the nearer end of the fence."""
        own, turn = self.own(t, y)
        return min(1.0, self.half - abs(_acts(own * turn / self.normal, self.slope)))

    def after(self, t: float, y: FloatArray) -> str:
        """The force keeps to the base: it does not come past a corner of that."""
        return _TURNS


def laid_on(
    base: FloatArray, heading: complex, friction: float, points: FloatArray, fence: Fence,
    y: FloatArray,
) -> Pushing:  # fmt: skip
    """A fence that has been moved up to a base in the state y.

    Raises InputError if it moves away, or does not touch with its face.
    """
    normal = cmath.rect(1.0, fence.facing)
    if not (heading / normal).real > 0.0:
        raise InputError(
            f"the fence faces along {fence.facing:g} rad and does not move that way: give a "
            "velocity that leads it to the puck"
        )
    places = points[:, 0] + 1j * points[:, 1]
    edges = np.roll(places, -1) - places
    turns = (edges.conjugate() * np.roll(edges, -1)).imag
    if fence.width < math.inf and len(points) > 1 and (points[:, 2].any() or turns.min() < 0.0):
        raise InputError(
            "a fence of a width pushes convex polygons and discs: leave the width of this one out"
        )
    away = places * (cmath.rect(1.0, y[2]) / normal)
    start = normal * complex((away.real - points[:, 2]).min(), fence.offset)
    half = 0.5 * fence.width
    legs = Along(base, heading, friction, start, points, normal, half, 0).after(0.0, y)
    if isinstance(legs, str):
        raise InputError(
            "the fence touches with an end, or the puck turns about that at once: push there with "
            "a finger, or give it another offset or width"
        )
    return legs

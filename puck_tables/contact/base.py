"""The base of a puck that is not round, or whose centre of mass is not its middle: what touches.

A base is made of polygons and discs that do not overlap, with holes in them.  Its pressure is
linear over it, see :mod:`puck_tables.kernels.base_friction`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Self

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray, finite_array, instance, listed, positive
from puck_tables._core.own_folder import say
from puck_tables.contact.outlines import crossing, inside, overlap
from puck_tables.errors import ContactError, InputError

MOST_CORNERS = 10_000  # of an outline: all pairs of its sides are looked at for crossings
_RIM_POINTS = 4096  # of a disc, at which its pressure is looked at: it errs by 3e-7 of it
_CENTRED = 1e-9  # of the reach: the centre of mass is the middle of the base

Corners = tuple[tuple[float, float], ...]
# x, y, radius, and 1, −1 of a hole, or how hard a foot with a load of its own is pressed, over 1
Disc = tuple[float, float, float, float]


@dataclass(frozen=True)
class Base:
    """The base of a puck: what of it touches the floor.

    Made by :meth:`box`, :meth:`polygon`, :meth:`disc`, :meth:`annulus`, :meth:`feet`,
    :meth:`union`, or from a text by :func:`puck_tables.contact.named_base.base_of`.

    Parameters
    ----------
    outlines : tuple of outlines, each a tuple of corners (x, y), m
        Counter-clockwise; those of holes clockwise.
    discs : tuple of (x, y, radius, weight), m; weight −1: a hole, 1: pressed as all else is; of a
        foot with a load of its own how much harder
    centre : (x, y), m, of mass; left out: the middle of the area
    name : as a text of it is, or a short one

    Raises
    ------
    InputError
        If there is no area, corners cross, parts overlap, or a number is out of range.
    ContactError
        If the centre of mass lies so far out that part of the base would lift, or the body tip.

    Examples
    --------
    >>> base = Base.box(0.2, 0.1)
    >>> round(base.area, 6), round(base.reach, 6), round(base.gyration, 6)
    (0.02, 0.111803, 0.06455)
    """

    outlines: tuple[Corners, ...]
    discs: tuple[Disc, ...] = ()
    centre: tuple[float, float] | None = None
    name: str = field(default="base", compare=False)

    def __post_init__(self) -> None:
        if not self.outlines and not self.discs:
            raise InputError("a base needs an outline or a disc")
        area, first, _ = self._moments
        if not area > 0.0:
            raise InputError(f"base {self.name}: its area must be > 0 m^2, got {area:g}")
        middle = (float(first[0] / area), float(first[1] / area))
        centre = middle
        if self.centre is not None:
            place = finite_array("centre of mass", self.centre, "m")
            if place.shape != (2,):
                raise InputError("centre of mass must be two numbers (x, y), m")
            centre = (float(place[0]), float(place[1]))
            if math.dist(centre, middle) <= _CENTRED * self._reach_from(middle):
                centre = middle
        object.__setattr__(self, "centre", centre)
        if not self._pressures[0].min() > 0.0:
            raise ContactError(
                f"base {self.name}: with its centre of mass at ({centre[0]:g}, {centre[1]:g}) m "
                "part of it would lift, or the body tip; pressure that is linear over the base "
                f"needs it nearer to the middle, ({middle[0]:g}, {middle[1]:g}) m"
            )

    @classmethod
    def box(
        cls, length: float, width: float, *, centre: tuple[float, float] | None = None
    ) -> Self:  # fmt: skip
        """A rectangle about the origin, ``length`` along x, m; ``centre`` of mass (x, y), m.

        >>> round(Base.box(0.2, 0.1).area, 6)
        0.02
        """
        a, b = 0.5 * positive("length", length, "m"), 0.5 * positive("width", width, "m")
        corners = ((-a, -b), (a, -b), (a, b), (-a, b))
        return cls((corners,), (), centre, f"box:{2.0 * a:.12g}x{2.0 * b:.12g}")

    @classmethod
    def polygon(
        cls, corners: npt.ArrayLike, *, holes: Sequence[npt.ArrayLike] = (),
        centre: tuple[float, float] | None = None, name: str = "polygon",
    ) -> Self:  # fmt: skip
        """A polygon of corners (n, 2), m, in order; ``holes``: polygons that are left out of it.

        >>> round(Base.polygon([(0, 0), (0.1, 0), (0, 0.1)]).area, 6)
        0.005
        """
        outside = _corners_of(corners, name, 1.0)
        openings = tuple(
            _corners_of(hole, f"{name}: hole", -1.0) for hole in listed("holes", holes, "outlines")
        )
        for n, hole in enumerate(openings):
            if crossing(outside, hole) or not inside(outside, hole[0]):
                raise InputError(f"{name}: a hole must lie in the outline")
            if any(overlap(((hole[::-1],), ()), ((other[::-1],), ())) for other in openings[:n]):
                raise InputError(f"{name}: two holes overlap, touch, or one lies in the other")
        return cls((outside, *openings), (), centre, name)

    @classmethod
    def disc(cls, radius: float, *, centre: tuple[float, float] | None = None) -> Self:
        """A disc about the origin, m.

        >>> round(Base.disc(1.0).area, 6)
        3.141593
        """
        r = positive("radius", radius, "m")
        return cls((), ((0.0, 0.0, r, 1.0),), centre, f"disc:{r:.12g}")

    @classmethod
    def annulus(
        cls, radius: float, inner: float, *, centre: tuple[float, float] | None = None
    ) -> Self:
        """A disc about the origin with a round hole of the radius ``inner``, m.

        >>> round(Base.annulus(1.0, 0.5).gyration, 6)
        0.790569
        """
        r, hole = positive("radius", radius, "m"), positive("inner", inner, "m")
        if not hole < r:
            raise InputError(f"inner must be less than the radius, {r:g} m, got {hole:g}")
        discs = ((0.0, 0.0, r, 1.0), (0.0, 0.0, hole, -1.0))
        return cls((), discs, centre, f"annulus:{r:.12g}x{hole:.12g}")

    @classmethod
    def feet(
        cls, centres: npt.ArrayLike, radius: float, *, centre: tuple[float, float] | None = None,
        loads: npt.ArrayLike | None = None,
    ) -> Self:  # fmt: skip
        """Round feet of one radius, m, about ``centres`` (n, 2), m; they must not overlap.

        ``loads`` (n,) > 0, in any unit: of each foot while it stands, so that the centre of mass
        lies where they put it.  Left out: as pressure that is linear over all of them has it.

        >>> len(Base.feet([(0.1, 0.0), (-0.1, 0.1), (-0.1, -0.1)], 0.005).discs)
        3
        >>> round(Base.feet([(0.1, 0.0), (-0.1, 0.0)], 0.005, loads=[3.0, 1.0]).middle[0], 9)
        0.05
        """
        r, places = positive("radius", radius, "m"), finite_array("centres", centres, "m")
        if places.ndim != 2 or places.shape[1] != 2 or len(places) == 0:
            raise InputError("centres must be a list of places (x, y), m")
        shares = np.ones(len(places))
        if loads is not None:
            shares = finite_array("loads", loads, "")
            if centre is not None:
                raise InputError("loads of feet say where the centre of mass is: leave centre out")
            if shares.shape != (len(places),) or not (shares > 0.0).all():
                raise InputError(
                    f"loads must be {len(places)} numbers above 0, one for each foot, got {loads!r}"
                )
            shares = shares / shares.mean()
        discs = [
            cls((), ((x, y, r, share),), name="foot")
            for (x, y), share in zip(places.tolist(), shares.tolist(), strict=True)
        ]
        return cls.union(discs, centre=centre, name=f"{len(discs)} feet")

    @classmethod
    def union(
        cls, parts: Sequence[Base], *, centre: tuple[float, float] | None = None,
        name: str = "union",
    ) -> Self:  # fmt: skip
        """Several bases together, which must not overlap.

        >>> stem = Base.polygon([(-0.01, -0.2), (0.01, -0.2), (0.01, 0.0), (-0.01, 0.0)])
        >>> round(Base.union([stem, Base.feet([(0.0, 0.05)], 0.03)]).area, 6)
        0.006827
        """
        bases = listed("parts", parts, "bases")
        for base in bases:
            instance("a part of a union", base, Base)
        for i, one in enumerate(bases):
            for k, other in enumerate(bases[:i]):
                if overlap((one.outlines, one.discs), (other.outlines, other.discs)):
                    raise InputError(
                        f"parts {k} and {i} of the base overlap: move them apart, or give the "
                        "outline of both"
                    )
        outlines = tuple(outline for base in bases for outline in base.outlines)
        return cls(outlines, tuple(disc for base in bases for disc in base.discs), centre, name)

    @property
    def area(self) -> float:
        """Of what touches, m²."""
        return self._moments[0]

    @property
    def is_centred(self) -> bool:
        """Whether the centre of mass lies in the middle of the area."""
        area, first, _ = self._moments
        return self.middle == (float(first[0] / area), float(first[1] / area))

    @property
    def middle(self) -> tuple[float, float]:
        """The centre of mass, m."""
        assert self.centre is not None  # it has been found
        return self.centre

    @cached_property
    def reach(self) -> float:
        """How far the farthest point of it lies from the centre of mass, m."""
        return self._reach_from(self.middle)

    @property
    def gyration(self) -> float:
        """Radius of gyration about the vertical of a homogeneous body on this base, m."""
        area, first, second = self._moments
        return math.sqrt(float(np.trace(second) - first @ first / area) / area)

    @cached_property
    def about_centre(self) -> tuple[float, FloatArray, FloatArray]:
        """∫ dA, ∫ x dA (2,) and ∫ x x dA (2, 2), x from the centre of mass."""
        area, first, second = self._moments
        c = np.array(self.middle)
        own = np.zeros(2) if self.is_centred else first - area * c
        return area, own, second - np.outer(c, first) - np.outer(first, c) + area * np.outer(c, c)

    @cached_property
    def highest_lever(self) -> float:
        """How large friction times the height of the centre of mass may be, m.

        Up to it no state of motion lifts a part of the base.  The pressure at a place is linear in
        the force of friction, which is largest, f N, as the base slides without spin.

        >>> round(Base.box(0.2, 0.1).highest_lever, 9), round(Base.disc(0.04).highest_lever, 9)
        (0.01490712, 0.01)
        """
        flat, tilt = self._pressures
        return float((flat / np.maximum(np.hypot(tilt[0], tilt[1]), 1e-300)).min())

    def refuse_lift(self, friction: float, height: float) -> None:
        """Refuse a body of twice the height of its centre of mass under which part would lift.

        Raises
        ------
        ContactError

        Examples
        --------
        >>> Base.box(0.2, 0.1).refuse_lift(0.3, 0.05)
        """
        if not 0.5 * friction * height <= self.highest_lever:
            raise ContactError(
                f"friction {friction:g} and height {height:g} m: part of the base would lift; with "
                f"this friction it stays down up to a height of "
                f"{2.0 * self.highest_lever / friction:.6g} m"
            )

    @property
    def has_own_loads(self) -> bool:
        """Whether some of its feet have loads of their own.

        >>> Base.feet([(0.1, 0.0), (-0.1, 0.0)], 0.005, loads=[3.0, 1.0]).has_own_loads
        True
        """
        return any(abs(disc[3]) != 1.0 for disc in self.discs)

    @property
    def is_under_centre(self) -> bool:
        """Whether some of it lies right under the centre of mass: not in a hole, not between feet.

        >>> Base.box(0.2, 0.1).is_under_centre, Base.annulus(0.1, 0.05).is_under_centre
        (True, False)
        """
        (x, y), around = self.middle, 0
        for outline in self.outlines:
            for (px, py), (qx, qy) in zip(outline, (*outline[1:], outline[0]), strict=True):
                if (py > y) != (qy > y):
                    around += px + (y - py) / (qy - py) * (qx - px) > x
        around += sum(math.dist((x, y), disc[:2]) < disc[2] for disc in self.discs)
        return around % 2 == 1

    @property
    def _pressures(self) -> tuple[FloatArray, FloatArray]:
        """At its outermost points the pressure, and what a moment N x of the load adds to it."""
        area, first, second = self.about_centre
        balance = np.block([[np.array([[area]]), first[None, :]], [first[:, None], second]])
        points = self.points() - np.array(self.middle)
        parts = np.linalg.inv(balance) @ np.column_stack([np.ones(len(points)), points]).T
        return parts[0], parts[1:]

    def points(self) -> FloatArray:
        """Corners, and points on the rims of discs, (n, 2), m."""
        turn = np.linspace(0.0, 2.0 * np.pi, _RIM_POINTS, endpoint=False)
        circle = np.column_stack([np.cos(turn), np.sin(turn)])
        rims = [np.array(d[:2]) + d[2] * circle for d in self.discs if d[3] > 0.0]
        return np.concatenate([*map(np.array, self.outlines), *rims])

    def _reach_from(self, place: tuple[float, float]) -> float:
        corners = [math.dist(corner, place) for outline in self.outlines for corner in outline]
        rims = [math.dist(disc[:2], place) + disc[2] for disc in self.discs]
        return max(corners + rims)

    @cached_property
    def _moments(self) -> tuple[float, FloatArray, FloatArray]:
        """∫ dA, ∫ x dA and ∫ x x dA about the origin."""
        area, first, second = 0.0, np.zeros(2), np.zeros((2, 2))
        for outline in self.outlines:
            p = np.array(outline)
            q = np.roll(p, -1, axis=0)
            cross = p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]
            area += 0.5 * float(cross.sum())
            first = first + cross @ (p + q) / 6.0
            both = p + q
            outer = np.einsum("n,ni,nj->ij", cross, both, both)
            outer += np.einsum("n,ni,nj->ij", cross, p, p) + np.einsum("n,ni,nj->ij", cross, q, q)
            second = second + outer / 24.0
        for x, y, radius, sign in self.discs:
            own, place = sign * math.pi * radius * radius, np.array([x, y])
            area += own
            first = first + own * place
            second = second + own * (np.outer(place, place) + 0.25 * radius * radius * np.eye(2))
        return area, first, second


def _corners_of(corners: npt.ArrayLike, name: str, sense: float) -> Corners:
    """Checked corners, counter-clockwise, or clockwise where ``sense`` is −1."""
    points = finite_array(f"{name}: corners", corners, "m")
    if points.ndim != 2 or points.shape[1:] != (2,) or not 3 <= len(points) <= MOST_CORNERS:
        raise InputError(
            f"{name}: corners must be 3 to {MOST_CORNERS} places (x, y), m, got an array of shape "
            f"{points.shape}"
        )
    if np.array_equal(points[0], points[-1]):  # closed by itself
        points = points[:-1]
    if (points == np.roll(points, 1, axis=0)).all(axis=1).any():
        raise InputError(f"{name}: a corner stands twice in a row")
    x, y = (points - points.mean(axis=0)).T
    area = float(x @ np.roll(y, -1) - y @ np.roll(x, -1))
    outline = tuple(map(tuple, points.tolist()))
    if crossing(outline):
        raise InputError(f"{name}: its sides cross, or touch each other: give corners in order")
    if area * sense < 0.0:
        if sense > 0.0:
            say(f"{name}: its corners stand clockwise; they are taken the other way round")
        outline = outline[::-1]
    return outline

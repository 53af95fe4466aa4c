"""The parts of a scene besides its puck: plain records of what a user says.

Numbers are in SI units, angles in radians, counter-clockwise positive.  They are checked when a
:class:`puck_tables.Scene` is made of them.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import KW_ONLY, dataclass
from functools import wraps
from typing import Any, TypeVar

from puck_tables._core.fields import of
from puck_tables.contact.friction_laws import NAMED, FrictionLaw
from puck_tables.errors import InputError
from puck_tables.scene.restitution import Restitution, restitution_of

T = TypeVar("T")
Rows = tuple[tuple[float, ...], ...]


@dataclass(frozen=True)
class Orthotropic:
    """A floor that is rougher one way than the other, as brushed metal, felt and wood are.

    An element that slips along e feels −(f_x² e_x, f_y² e_y)/√(f_x² e_x² + f_y² e_y²) of its load,
    in the axes of the floor, or of the body that is so.  It may be the friction of a strip or a
    patch, too.  With a ``law`` over the slip speed it is so many times that.

    >>> from puck_tables import StribeckLaw
    >>> ice = Orthotropic((1.0, 0.5), law=StribeckLaw(0.3, 0.1, speed=0.2))
    >>> float(ice.friction[1] * ice.law(0.0))  # f across at rest
    0.15
    """

    friction: tuple[float, float] = of(
        "pair", low=0.0, above=True, acts="orthotropic friction",
        doc="along 'direction' and across it; beside 'law' factors of it",
    )  # fmt: skip
    direction: float = of("number", 0.0, "rad", doc="of the first of them, from x", acts="")
    fixed_to: str = of(
        "choice", "floor", choices=("floor", "body"), acts="",
        doc="what 'direction' is in: the floor, or the body, as that of a brushed sole is",
    )  # fmt: skip
    law: str | Rows | FrictionLaw = of(
        "rows", "", file="", kinds=NAMED, acts="",
        doc="over the slip speed, as floor.law: 'friction' are then factors of it",
    )  # fmt: skip
    kind: str = of(
        "choice", "orthotropic", choices=("orthotropic",), doc="in place of a number", acts=""
    )

    def largest(self, top: float) -> float:
        """The larger coefficient up to a slip speed, m/s, of a law that is read."""
        law: Any = self.law
        return max(self.friction) * (law.largest(top) if law else 1.0)


OWN_FRICTION = {**NAMED, "orthotropic": Orthotropic}  # of a stretch of the floor, besides numbers


@dataclass(frozen=True)
class Strips:
    """Regions of the floor between parallel borders; a base on several feels each of them."""

    borders: tuple[float, ...] = of(
        "numbers", unit="m", doc="ascending places along 'direction'", acts="strips"
    )
    friction: tuple[float | Rows | FrictionLaw | Orthotropic, ...] = of(
        "numbers", low=0.0, kinds=OWN_FRICTION, doc="one more than borders", acts=""
    )
    direction: float = of("number", 0.0, "rad", doc="across the borders, from x", acts="")
    across: tuple[float, ...] = of(
        "numbers", (), "m/s", doc="speeds of belts along 'direction', one a strip", acts="belts"
    )
    along: tuple[float, ...] = of(
        "numbers", (), "m/s", doc="along the borders, to the left of that", acts="belts"
    )


@dataclass(frozen=True)
class Patch:
    """A spot of the floor with a friction of its own, round or a polygon; wet, or rough."""

    friction: float | Rows | FrictionLaw | Orthotropic = of(
        "number", low=0.0, kinds=OWN_FRICTION, doc="in place of that around it", acts="patches"
    )
    centre: tuple[float, float] = of("pair", (0.0, 0.0), "m", doc="of a round one", acts="")
    radius: float = of("number", 0.0, "m", low=0.0, doc="of a round one", acts="")
    corners: str | Rows = of(
        "rows", (), file="", doc="CSV, SVG or rows of x, y in m, around a polygon", acts=""
    )
    velocity: tuple[float, float] | None = of(
        "pair", None, "m/s", doc="of a belt below its outline; left out: as around it",
        acts="belts",
    )  # fmt: skip


@dataclass(frozen=True)
class Grip:
    """A factor on friction over time: ice that is swept, a floor that gets wet.

    Straight between its rows; before and after them it stays what it was, and where a time stands
    twice it jumps.

    >>> swept = Grip([[0.0, 1.0], [2.0, 0.8]])
    """

    over_time: str | Rows = of(
        "rows", file="", doc="CSV or rows of t and a factor on friction, straight between",
        acts="friction over time",
    )  # fmt: skip
    where: str = of("text", "floor", doc="'floor', or 'strip 0', 'patch 0', ...", acts="")


@dataclass(frozen=True)
class Floor:
    """The plane: level or sloping, at rest or moving, of one friction or of several.

    What rests is held by ``static_ratio`` times the friction that brakes it in a slip, μ_s/μ_k.

    >>> Floor(slope=0.1, velocity=(0.5, 0.0)).downhill
    0.0
    >>> Floor(static_ratio=1.5).static_ratio * 0.2  # μ_s of a puck with friction=0.2
    0.30000000000000004
    """

    slope: float = of("number", 0.0, "rad", low=0.0, high=math.pi / 2, below=True, acts="slope")
    downhill: float = of("number", 0.0, "rad", doc="direction of steepest descent, from x", acts="")
    velocity: tuple[float, float] = of("pair", (0.0, 0.0), "m/s", doc="of a belt", acts="")
    turning: float = of("number", 0.0, "rad/s", doc="spin of a turntable", acts="turntable")
    centre: tuple[float, float] = of("pair", (0.0, 0.0), "m", doc="of the turntable", acts="")
    over_time: str | Rows = of(
        "rows",
        "",
        file="",
        doc="CSV or rows of t, vx, vy and perhaps spin, straight between, in place of velocity and "
        "turning: a tray that shakes",
        acts="moving floor",
    )
    static_ratio: float = of(
        "number", 1.0, low=1.0, doc="friction that holds at rest over that in a slip",
        acts="static friction",
    )  # fmt: skip
    strips: Strips | None = of("part", None, part=Strips)
    patches: tuple[Patch, ...] = of("parts", (), part=Patch, table="patch")
    grips: tuple[Grip, ...] = of("parts", (), part=Grip, table="grip")
    orthotropic: Orthotropic | None = of("part", None, part=Orthotropic)
    law: str | Rows | FrictionLaw = of(
        "rows",
        "",
        file="",
        kinds=NAMED,
        doc="CSV or rows of slip speed and f (m/s, or the unit in the heading; a cubic between "
        "that rises and falls only where they do), a SpeedLaw, or a law by name, in place of "
        "friction",
        acts="friction law",
    )


@dataclass(frozen=True)
class Launch:
    """Where and how it starts.

    Velocities (n, 2) are many launches; positions (n, 2), spins and orientations (n,) go with them
    one by one.  Any other list or array in place of a number is a range of its own.
    """

    velocity: tuple[float, float] | None = of("pair", None, "m/s", doc="of the centre", batch=True)
    spin: float = of("number", 0.0, "rad/s")
    position: tuple[float, float] = of("pair", (0.0, 0.0), "m", doc="of the centre", batch=True)
    orientation: float = of("number", 0.0, "rad", doc="of the body")
    time: float = of("number", 0.0, "s", low=0.0, doc="when; with several pucks only")


@dataclass(frozen=True)
class Drag:
    """Friction against the floor, linear as in a film or quadratic as in a wake."""

    sliding: float = of(
        "number", 0.0, "kg/s", low=0.0, doc="force over relative speed", acts="drag"
    )
    quadratic: float = of(
        "number", 0.0, "kg/m", low=0.0, doc="force over relative speed squared", acts="drag"
    )
    spinning: float = of(
        "number", 0.0, "N m s", low=0.0, doc="torque over relative spin", acts="drag"
    )
    spinning_quadratic: float = of(
        "number", 0.0, "N m s^2", low=0.0, doc="torque over relative spin squared", acts="drag"
    )


@dataclass(frozen=True)
class Lateral:
    """An empirical force across the motion: strength (v in m/s)^b (|w| in rad/s)^c sign w.

    b is ``speed_exponent``, c ``spin_exponent``; no force at a spin w below 1e-12 v per m, which
    rounding makes of no spin.

    It is to the left of the motion over the floor where the spin is counter-clockwise, and does no
    work there.  Players of curling fit it to the curl of their stones; no dry friction over the
    contact explains it.  With b < 1 a puck that slides ever slower while it still spins turns its
    way without end; a run that would follow that for over a million steps is refused.

    >>> stone = Lateral(0.163, speed_exponent=0.2)  # 20 kg, as the simulator FCV1 has it
    """

    strength: float = of(
        "number", 0.0, "N", doc="at 1 m/s and 1 rad/s; below 0 to the right",
        acts="lateral force (empirical)",
    )  # fmt: skip
    speed_exponent: float = of("number", 0.0, low=0.0, high=8.0, doc="of the speed in m/s", acts="")
    spin_exponent: float = of(
        "number", 0.0, low=0.0, high=8.0, doc="of the spin in rad/s; 0: its sign only", acts=""
    )


@dataclass(frozen=True)
class Force:
    """A force on the centre and a torque, constant and over time."""

    constant: tuple[float, float] = of("pair", (0.0, 0.0), "N", acts="force")
    torque: float = of("number", 0.0, "N m", acts="force")
    over_time: str | Rows = of(
        "rows",
        "",
        file="",
        doc="CSV or rows of t, Fx, Fy and perhaps torque, straight between",
        acts="force over time",
    )


def _one_place(part: type[T]) -> type[T]:
    """Refuse a second place without a name: whoever gives two means the ends of a line."""
    init: Callable[..., None] = part.__init__

    @wraps(init)
    def named(self: T, *places: Any, **rest: Any) -> None:
        if len(places) > 1:
            raise InputError(_two_places(part.__name__, *places[:2]))
        init(self, *places, **rest)

    part.__init__ = named  # type: ignore[assignment]
    return part


def _two_places(name: str, first: Any, second: Any) -> str:
    """What to write in place of two places."""
    said = (
        f"{name} takes one value without a name, a point: for the line through {first!r:.60} that "
        f"faces along {second!r:.60} write {name}({first!r:.60}, normal={second!r:.60})"
    )
    try:
        (ax, ay), (bx, by) = ((float(x), float(y)) for x, y in (first, second))
    except (TypeError, ValueError, OverflowError):
        return said
    return (
        f"{said}; for the whole line through both places normal=({by - ay:g}, {ax - bx:g}) or "
        f"({ay - by:g}, {bx - ax:g}), whichever points into the field (an {name.lower()} has "
        "no ends)"
    )


@dataclass(frozen=True)
class Wall:
    """A straight cushion that rims bounce off: a line without ends, a piece of one, or a polygon.

    ``Wall(point, normal=...)`` has no ends, and pucks on one side.  ``Wall(start, end)`` has two
    faces, and ends that are round points, as a post of radius 0.  ``Wall(corners=...)`` is closed,
    with one such wall from each corner to the next; pucks may be inside as well as outside.

    >>> board_end = Wall((1.0, 0.0), normal=(-1.0, 0.0), restitution=0.7)
    >>> beside_the_goal = Wall((1.0, 0.15), (1.0, 0.5), restitution=0.7)
    >>> island = Wall(corners=[[0.4, 0.2], [0.6, 0.2], [0.5, 0.3]])
    """

    start: tuple[float, float] | None = of("pair", None, "m", doc="of one with ends", acts="walls")
    end: tuple[float, float] | None = of("pair", None, "m", doc="of one with ends", acts="")
    _: KW_ONLY
    point: tuple[float, float] | None = of(
        "pair", None, "m", doc="any point of one without ends", acts="walls"
    )
    normal: tuple[float, float] | None = of(
        "pair", None, doc="of one without ends, into the field, any length", acts=""
    )
    corners: str | Rows = of(
        "rows", (), file="", doc="CSV, SVG or rows of x, y in m, around a closed one", acts="walls"
    )
    restitution: float | str | Restitution = restitution_of(1.0, acts="")
    tangential: float = of(
        "number",
        -1.0,
        low=-1.0,
        high=1.0,
        doc="-1: smooth, 0: the rim rolls off, 1: it reverses",
        acts="",
    )
    friction: float = of("number", math.inf, low=0.0, doc="limits the tangential impulse", acts="")

    def __post_init__(self) -> None:
        if self.normal is not None and self.point is None and self.end is None:
            object.__setattr__(self, "point", self.start)  # the one place without a name
            object.__setattr__(self, "start", None)


@_one_place
@dataclass(frozen=True)
class Edge:
    """A straight boundary that ends the run when the centre passes it: a line without ends."""

    point: tuple[float, float] = of("pair", unit="m", doc="any point of it", acts="edges")
    _: KW_ONLY
    normal: tuple[float, float] = of("pair", doc="into the field, any length", acts="")
    beyond: str = of(
        "choice", "nothing", choices=("nothing", "floor"), acts="",
        doc="what a puck hangs over there: nothing, as beside a table, or floor, as beyond a line",
    )  # fmt: skip


@dataclass(frozen=True)
class Constraint:
    """A linear constraint on the velocities."""

    kind: str = of("choice", choices=("rail", "pivot", "blade"), acts="constraint")
    angle: float = of(
        "number", 0.0, "rad",
        doc="direction of the rail; from the centre to the pivot, or along the blade, in the body",
        acts="",
    )  # fmt: skip
    reach: float = of(
        "number",
        0.0,
        "m",
        low=0.0,
        doc="from the centre to the pivot, which needs one > 0",
        acts="",
    )
    velocity: tuple[float, float] = of("pair", (0.0, 0.0), "m/s", doc="of rail or pivot", acts="")
    side_slip: float = of(
        "number", 0.0, "m/s", doc="of the blade over the floor, to its left", acts=""
    )

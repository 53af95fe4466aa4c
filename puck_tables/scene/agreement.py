"""What the parts of a scene say together: what is wrong between them, and what follows."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from puck_tables.contact.speed_law import SpeedLaw
from puck_tables.errors import InputError
from puck_tables.scene.forces import drive_of
from puck_tables.scene.parts import Constraint, Edge, Floor, Rows, Wall

if TYPE_CHECKING:
    from puck_tables.scene.scene import Scene

MATCH = 1e-9  # how well a launch must fit its constraint, of its speed
_SMALLEST, _LARGEST = 1e-100, 1e100
_NOT_OF = {"rail": ("reach", "side_slip"), "pivot": ("side_slip",), "blade": ("reach", "velocity")}


def disagreements(scene: Scene) -> list[str]:
    """What is wrong between fields that are each in range."""
    faults = []
    for name, value in (("radius", scene.puck.radius), ("mass", scene.puck.mass)):
        if not _SMALLEST <= value <= _LARGEST:  # the moment of inertia and its inverse are numbers
            faults.append(
                f"puck.{name} = {value:g}: must be from {_SMALLEST:g} to {_LARGEST:g} in a scene, "
                "use other units"
            )
    strips = scene.floor.strips
    if scene.floor.law and strips is not None:
        faults.append("floor.law and floor.strips: each takes the place of puck.friction, give one")
    if scene.floor.law and (scene.puck.pressure != "uniform"):
        faults.append("floor.law: known under uniform pressure only, not with puck.pressure")
    if strips is not None:
        if len(strips.friction) != len(strips.borders) + 1 or not strips.borders:
            faults.append(
                f"floor.strips.friction = {list(strips.friction)}: must be one number more than "
                f"floor.strips.borders ({len(strips.borders)})"
            )
        if any(b <= a for a, b in zip(strips.borders, strips.borders[1:], strict=False)):
            faults.append(f"floor.strips.borders = {list(strips.borders)}: must ascend")
    faults += _bad_rows(scene)
    if not scene.run.frames.is_integer():
        faults.append(f"run.frames = {scene.run.frames:g}: must be a whole number")
    lines: list[tuple[str, Wall | Edge]] = [(f"wall[{i}]", w) for i, w in enumerate(scene.walls)]
    lines += [(f"edge[{i}]", edge) for i, edge in enumerate(scene.edges)]
    for name, line in lines:
        if not 1e-100 < math.hypot(*line.normal) < 1e100:
            faults.append(f"{name}.normal = {list(line.normal)}: must have a direction")
            continue
        margin = scene.puck.radius if isinstance(line, Wall) else 0.0
        gap = distance(line, scene.launch.position) - margin
        if gap < -1e-12 * max(margin, math.hypot(*line.point)):
            what = "reaches through it" if margin > 0.0 else "is beyond it"
            faults.append(
                f"{name}: the puck at launch.position = {list(scene.launch.position)} "
                f"{what} by {-gap:.3g} m: move the launch, or turn the normal into the field"
            )
    hold = scene.constraint
    if hold is None:
        return faults
    if scene.walls:
        faults.append("constraint and wall: a scene has one of them, not both")
    for name in _NOT_OF[hold.kind]:
        if getattr(hold, name) not in (0.0, (0.0, 0.0)):
            faults.append(f"constraint.{name}: a {hold.kind} has none, leave it out")
    if hold.kind == "pivot" and not hold.reach > 0.0:
        faults.append(f"constraint.reach = {hold.reach:g}: a pivot needs a number > 0 m")
    return faults + _misfit(scene, hold)


def _bad_rows(scene: Scene) -> list[str]:
    """What is wrong with tables that stand in the scene; those in files are read when it runs."""
    faults = []
    law, force = scene.floor.law, scene.force.over_time
    for name, rows, made in (("floor.law", law, law_of_rows), ("force.over_time", force, drive_of)):
        if rows and not isinstance(rows, str):
            try:
                made(rows)
            except InputError as error:
                faults.append(str(error) if name in str(error) else f"{name}: {error}")
    return faults


def law_of_rows(rows: Rows) -> SpeedLaw:
    """The friction law of rows of slip speed and coefficient.

    Raises
    ------
    InputError
        If they are none.
    """
    if any(len(row) != 2 for row in rows):
        raise InputError("each row must be two numbers, slip speed in m/s and f")
    speeds, values = zip(*rows, strict=True)
    return SpeedLaw(speeds, values)


def _misfit(scene: Scene, hold: Constraint) -> list[str]:
    """A launch that its constraint does not allow."""
    wanted = launch_velocity(scene)
    given = scene.launch.velocity
    if given is None:
        return []
    scale = max(math.hypot(*given), math.hypot(*wanted), math.hypot(*hold.velocity))
    if math.dist(given, wanted) <= MATCH * max(scale, abs(hold.side_slip)):
        return []
    return [
        f"launch.velocity = {list(given)}: the {hold.kind} allows [{wanted[0]:.12g}, "
        f"{wanted[1]:.12g}] at this spin (leave it out where it follows from the spin)"
    ]


def launch_velocity(scene: Scene) -> tuple[float, float]:
    """The velocity of the centre at the launch, as the constraint allows it."""
    vx, vy = scene.launch.velocity or (0.0, 0.0)
    hold = scene.constraint
    if hold is None:
        return vx, vy
    if hold.kind == "pivot":
        bearing = scene.launch.orientation + hold.angle
        rim = scene.launch.spin * hold.reach
        return (
            hold.velocity[0] + rim * math.sin(bearing),
            hold.velocity[1] - rim * math.cos(bearing),
        )
    direction, side_slip, support = hold.angle, hold.side_slip, hold.velocity
    if hold.kind == "blade":  # it grips the floor
        direction += scene.launch.orientation
        support = floor_at(scene.floor, scene.launch.position)
    nx, ny = -math.sin(direction), math.cos(direction)
    off = nx * (vx - support[0]) + ny * (vy - support[1]) - side_slip
    return vx - off * nx, vy - off * ny


def floor_at(floor: Floor, place: tuple[float, float]) -> tuple[float, float]:
    """Velocity of the floor at a place, m/s.

    Examples
    --------
    >>> floor_at(Floor(velocity=(1.0, 0.0), turning=2.0), (0.0, 0.5))
    (0.0, 0.0)
    """
    return (
        floor.velocity[0] - floor.turning * (place[1] - floor.centre[1]),
        floor.velocity[1] + floor.turning * (place[0] - floor.centre[0]),
    )


def distance(line: Wall | Edge, place: tuple[float, float]) -> float:
    """How far a place is from a line, on the side its normal points to.

    Examples
    --------
    >>> distance(Edge((0.0, 1.0), (0.0, -2.0)), (5.0, 0.25))
    0.75
    """
    size = math.hypot(*line.normal)
    return sum((p - q) * n / size for p, q, n in zip(place, line.point, line.normal, strict=True))

"""What constraints allow of a launch."""

from __future__ import annotations

import math

from puck_tables.scene.parts import Constraint, Floor, Launch

MATCH = 1e-9  # how well a launch must fit its constraint, of its speed
_NOT_OF = {"rail": ("reach", "side_slip"), "pivot": ("side_slip",), "blade": ("reach", "velocity")}


def allowed_velocity(launch: Launch, hold: Constraint | None, floor: Floor) -> tuple[float, float]:
    """The velocity of the centre at a launch, as a constraint allows it, m/s.

    >>> allowed_velocity(Launch((1.0, 2.0)), Constraint("rail"), Floor())
    (1.0, 0.0)
    """
    vx, vy = launch.velocity or (0.0, 0.0)
    if hold is None:
        return vx, vy
    if hold.kind == "pivot":
        bearing = launch.orientation + hold.angle
        rim = launch.spin * hold.reach
        return (
            hold.velocity[0] + rim * math.sin(bearing),
            hold.velocity[1] - rim * math.cos(bearing),
        )
    direction, side_slip, support = hold.angle, hold.side_slip, hold.velocity
    if hold.kind == "blade":  # it grips the floor
        direction += launch.orientation
        support = floor_at(floor, launch.position)
    nx, ny = -math.sin(direction), math.cos(direction)
    off = nx * (vx - support[0]) + ny * (vy - support[1]) - side_slip
    return vx - off * nx, vy - off * ny


def floor_at(floor: Floor, place: tuple[float, float]) -> tuple[float, float]:
    """Velocity of the floor at a place, m/s.

    >>> floor_at(Floor(velocity=(1.0, 0.0), turning=2.0), (0.0, 0.5))
    (0.0, 0.0)
    """
    return (
        floor.velocity[0] - floor.turning * (place[1] - floor.centre[1]),
        floor.velocity[1] + floor.turning * (place[0] - floor.centre[0]),
    )


def misfits(launch: Launch, hold: Constraint | None, floor: Floor, path: str) -> list[str]:
    """What is wrong with a constraint and its launch, which stand under ``path``.

    >>> misfits(Launch(), Constraint("pivot"), Floor(), "")
    ['constraint.reach = 0: a pivot needs a number > 0 m']
    """
    if hold is None:
        return []
    faults = [
        f"{path}constraint.{name}: a {hold.kind} has none, leave it out"
        for name in _NOT_OF[hold.kind] if getattr(hold, name) not in (0.0, (0.0, 0.0))
    ]  # fmt: skip
    if hold.kind == "pivot" and not hold.reach > 0.0:
        faults.append(f"{path}constraint.reach = {hold.reach:g}: a pivot needs a number > 0 m")
    wanted, velocity = allowed_velocity(launch, hold, floor), launch.velocity
    if velocity is None:
        return faults
    scale = max(math.hypot(*velocity), math.hypot(*wanted), math.hypot(*hold.velocity))
    if math.dist(velocity, wanted) > MATCH * max(scale, abs(hold.side_slip)):
        faults.append(
            f"{path}launch.velocity = {list(velocity)}: the {hold.kind} allows [{wanted[0]:.12g}, "
            f"{wanted[1]:.12g}] at this spin (leave it out where it follows from the spin)"
        )
    return faults

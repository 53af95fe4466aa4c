"""What a scene is: a puck, a floor, a launch, and whatever acts on it.

Numbers are in SI units, angles in radians, counter-clockwise positive.  A scene file is TOML with a
table for each part; every number may be a range 'START:STOP:COUNT', which a sweep runs through.
"""

from __future__ import annotations

import dataclasses
import math
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from puck_tables._core.safe_read import read_whole
from puck_tables.contact.laws import HOMOGENEOUS
from puck_tables.errors import InputError
from puck_tables.motion.body import STANDARD_GRAVITY
from puck_tables.scene.fields import Reading, of, read_part

FloatArray = npt.NDArray[np.float64]

MAX_FILE = 1 << 20
MAX_NAMED = 1 << 26  # bytes of a file that a scene names
MAX_RUNS = 1_000_000_000  # of one sweep
MATCH = 1e-9  # how well a launch must fit its constraint, of its speed
_SMALLEST, _LARGEST = 1e-100, 1e100


@dataclass(frozen=True)
class Puck:
    """The body: an upright cylinder."""

    radius: float = of("number", unit="m", low=0.0, above=True, doc="of the base")
    height: float = of("number", 0.0, "m", low=0.0, doc="of the cylinder; 0: no tilt")
    mass: float = of("number", 1.0, "kg", low=0.0, above=True)
    gyration: float = of(
        "number", HOMOGENEOUS, low=0.1, high=10.0,
        doc="radius of gyration about the vertical over the radius",
    )  # fmt: skip
    pressure: str = of(
        "text", "uniform", file=".csv", doc="pressure law, as build-tables --pressure takes it"
    )


@dataclass(frozen=True)
class Strips:
    """Regions of the floor between parallel borders, which the centre of the puck crosses."""

    borders: tuple[float, ...] = of("numbers", unit="m", doc="ascending places along 'direction'")
    friction: tuple[float, ...] = of("numbers", low=0.0, doc="one more than borders")
    direction: float = of("number", 0.0, "rad", doc="across the borders, from x")


@dataclass(frozen=True)
class Floor:
    """The plane: rough, level or sloping, at rest or moving."""

    friction: float = of("number", 0.0, "", low=0.0, high=100.0, doc="Coulomb's coefficient f")
    gravity: float = of("number", STANDARD_GRAVITY, "m/s^2", low=0.0, above=True)
    slope: float = of("number", 0.0, "rad", low=0.0, high=math.pi / 2, below=True)
    downhill: float = of("number", 0.0, "rad", doc="direction of steepest descent, from x")
    velocity: tuple[float, float] = of("pair", (0.0, 0.0), "m/s", doc="of a belt")
    turning: float = of("number", 0.0, "rad/s", doc="spin of a turntable")
    centre: tuple[float, float] = of("pair", (0.0, 0.0), "m", doc="of the turntable")
    strips: Strips | None = of("part", None, part=Strips)
    law: str = of("text", "", file="", doc="CSV of slip speed in m/s and f, in place of 'friction'")


@dataclass(frozen=True)
class Launch:
    """Where and how it starts."""

    velocity: tuple[float, float] | None = of("pair", None, "m/s", doc="of the centre")
    spin: float = of("number", 0.0, "rad/s")
    position: tuple[float, float] = of("pair", (0.0, 0.0), "m", doc="of the centre")
    orientation: float = of("number", 0.0, "rad", doc="of the body")


@dataclass(frozen=True)
class Drag:
    """Viscous friction against the floor, as in an air cushion or a film."""

    sliding: float = of("number", 0.0, "kg/s", low=0.0, doc="force over relative speed")
    spinning: float = of("number", 0.0, "N m s", low=0.0, doc="torque over relative spin")


@dataclass(frozen=True)
class Force:
    """A force on the centre and a torque, constant and over time."""

    constant: tuple[float, float] = of("pair", (0.0, 0.0), "N")
    torque: float = of("number", 0.0, "N m")
    file: str = of(
        "text", "", file="", doc="CSV of t, Fx, Fy and perhaps torque, straight between rows"
    )


@dataclass(frozen=True)
class Wall:
    """A straight cushion that the rim of the puck bounces off."""

    point: tuple[float, float] = of("pair", unit="m", doc="any point of it")
    normal: tuple[float, float] = of("pair", doc="into the field, any length")
    restitution: float = of("number", 1.0, low=0.0, high=1.0)
    tangential: float = of(
        "number", -1.0, low=-1.0, high=1.0, doc="-1: smooth, 0: the rim rolls off, 1: it reverses"
    )
    friction: float = of("number", math.inf, low=0.0, doc="limits the tangential impulse")


@dataclass(frozen=True)
class Edge:
    """A straight boundary that ends the run when the centre passes it."""

    point: tuple[float, float] = of("pair", unit="m", doc="any point of it")
    normal: tuple[float, float] = of("pair", doc="into the field, any length")


@dataclass(frozen=True)
class Constraint:
    """A linear constraint on the velocities."""

    kind: str = of("choice", choices=("rail", "pivot", "blade"))
    angle: float = of(
        "number", 0.0, "rad",
        doc="direction of the rail; from the centre to the pivot, or along the blade, in the body",
    )  # fmt: skip
    reach: float = of("number", 0.0, "m", low=0.0, doc="from the centre to the pivot")
    velocity: tuple[float, float] = of("pair", (0.0, 0.0), "m/s", doc="of rail or pivot")
    side_slip: float = of("number", 0.0, "m/s", doc="of the blade over the floor, to its left")


@dataclass(frozen=True)
class Run:
    """How long, how close, how often."""

    time: float | None = of("number", None, "s", low=0.0, above=True, doc="until rest if left out")
    frames: float = of("number", 101.0, low=1.0, high=1e6, doc="states to save")
    tol: float = of("number", 1e-9, low=1e-12, high=1e-2, doc="error wanted, of Q/J and Q^2/J")


@dataclass(frozen=True)
class Scene:
    """All of it; ``checked``: made by :func:`scene_from`, which finds nothing wrong with it."""

    checked: ClassVar[bool] = False

    puck: Puck = of("part", part=Puck)
    floor: Floor = of("part", Floor(), part=Floor)
    launch: Launch = of("part", Launch(), part=Launch)
    drag: Drag = of("part", Drag(), part=Drag)
    force: Force = of("part", Force(), part=Force)
    wall: tuple[Wall, ...] = of("parts", (), part=Wall)
    edge: tuple[Edge, ...] = of("parts", (), part=Edge)
    constraint: Constraint | None = of("part", None, part=Constraint)
    run: Run = of("part", Run(), part=Run)
    title: str = of("text", "")


FILES = tuple(
    (part.name, spec.name, spec.metadata["kind"])
    for part in dataclasses.fields(Scene)
    if part.metadata["kind"].shape == "part"
    for spec in dataclasses.fields(part.metadata["kind"].part)
    if spec.metadata["kind"].file is not None
)


def scene_from(
    data: Mapping[str, Any] | Scene, source: str = "scene"
) -> tuple[Scene, dict[str, FloatArray]]:
    """A checked scene from nested tables or an unchecked one, and the ranges in it by path.

    Parameters
    ----------
    data : mapping or Scene
        As a TOML file gives it, or a :class:`Scene`, whose parts may also be tables.  Numbers may
        be numpy scalars, lists may be tuples or arrays of one dimension.
    source : str
        Its name, for messages.

    Returns
    -------
    scene, ranges
        A field that was given as a range stands at its first value.

    Raises
    ------
    InputError
        If anything is wrong: every error with its path, its value and what is allowed.

    Examples
    --------
    >>> scene, ranges = scene_from({"puck": {"radius": 0.04}, "launch": {"spin": "0:10:3"}})
    >>> scene.puck.mass, ranges["launch.spin"].tolist()
    (1.0, [0.0, 5.0, 10.0])
    >>> scene_from(Scene(Puck(np.float32(0.5)), launch=Launch(np.zeros(2))))[0].launch.velocity
    (0.0, 0.0)
    """
    if isinstance(data, Scene) and data.checked:
        return data, {}
    scene, ranges = scene_with_ranges(data, source)
    faults = _disagreements(scene)
    if faults:
        raise _refusal(source, faults)
    object.__setattr__(scene, "checked", True)
    return scene, ranges


def scene_with_ranges(
    data: Mapping[str, Any] | Scene, source: str
) -> tuple[Scene, dict[str, FloatArray]]:
    """The same, its entries checked one by one only: what they say together is up to the ranges.

    Raises
    ------
    InputError
    """
    reading = Reading([], {})
    scene = read_part(Scene, data, "", reading)
    runs = math.prod(found.count for found in reading.ranges.values())
    if runs > MAX_RUNS:  # before their numbers are made
        reading.errors.append(
            f"{len(reading.ranges)} ranges ({', '.join(list(reading.ranges)[:3])} ...) make more "
            f"than {MAX_RUNS:g} runs: give fewer or shorter ones"
        )
    if scene is None or reading.errors:
        raise _refusal(source, reading.errors)
    return scene, {path: found.numbers() for path, found in reading.ranges.items()}


def _refusal(source: str, faults: list[str]) -> InputError:
    head = f"{source}: {len(faults)} error{'s' if len(faults) != 1 else ''}"
    return InputError("\n  ".join([head, *faults]))


def read_scene(path: str | Path) -> dict[str, Any]:
    """The tables of a scene file.

    Raises
    ------
    InputError
        If it cannot be read or is not TOML.
    """
    try:
        tables = tomllib.loads(read_whole(path, MAX_FILE).decode("utf-8-sig"))
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror or error}") from None
    except UnicodeDecodeError as error:
        raise InputError(f"{path} is not text in UTF-8: see its byte {error.start}") from None
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"{path} is not a scene file (TOML): {error}") from None
    except (ValueError, RecursionError):
        raise InputError(
            f"{path}: a number in it has thousands of digits, or its lists are nested too deeply"
        ) from None
    for part, name, kind in FILES:  # beside the scene that names them
        value = tables.get(part, {}).get(name) if isinstance(tables.get(part), dict) else None
        if isinstance(value, str) and kind.names_file(value):
            tables[part][name] = str(Path(path).parent / value)
    return tables


def files_of(scene: Scene) -> dict[str, str]:
    """What stands in the files that a scene names, by the path of the entry that names them.

    Raises
    ------
    InputError
        If one cannot be read.

    Examples
    --------
    >>> files_of(Scene(Puck(0.04)))
    {}
    """
    texts = {}
    for part, name, kind in FILES:
        file = getattr(getattr(scene, part), name)
        if kind.names_file(file):
            try:
                text = read_whole(file, MAX_NAMED).decode("utf-8-sig", "replace")
            except OSError as error:
                raise InputError(f"cannot read {file}: {error.strerror or error}") from None
            texts[f"{part}.{name}"] = text.replace("\0", "\ufffd")
    return texts


def _disagreements(scene: Scene) -> list[str]:
    """What is wrong between fields that are each in range."""
    faults = []
    for name, value in (("radius", scene.puck.radius), ("mass", scene.puck.mass)):
        if not _SMALLEST <= value <= _LARGEST:  # the moment of inertia and its inverse are numbers
            faults.append(
                f"puck.{name} = {value:g}: must be from {_SMALLEST:g} to {_LARGEST:g} in a scene, "
                "use other units"
            )
    strips = scene.floor.strips
    if scene.floor.law and (strips is not None or scene.floor.friction > 0.0):
        faults.append("floor.law: it takes the place of floor.friction and floor.strips")
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
    if not scene.run.frames.is_integer():
        faults.append(f"run.frames = {scene.run.frames:g}: must be a whole number")
    lines: list[tuple[str, Wall | Edge]] = [(f"wall[{i}]", w) for i, w in enumerate(scene.wall)]
    lines += [(f"edge[{i}]", edge) for i, edge in enumerate(scene.edge)]
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
    if scene.wall:
        faults.append("constraint and wall: a scene has one of them, not both")
    if hold.kind == "pivot" and not hold.reach > 0.0:
        faults.append(f"constraint.reach = {hold.reach:g}: a pivot needs a number > 0 m")
    return faults + _misfit(scene, hold)


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

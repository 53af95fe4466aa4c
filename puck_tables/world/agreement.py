"""What is wrong between the parts of a scene."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from puck_tables._core.wording import meant
from puck_tables.errors import InputError
from puck_tables.motion.body import is_plain
from puck_tables.scene.by_speed import laws_in
from puck_tables.scene.floor_faults import floor_faults
from puck_tables.scene.floor_parts import (
    belts_of,
    frictions_on,
    has_belts,
    largest_of,
    needs_sums,
)
from puck_tables.scene.forces import is_stepped
from puck_tables.scene.launch_constraints import misfits
from puck_tables.scene.map_of_floor import follows_contour, may_lift
from puck_tables.scene.over_time import drive_of, last_factors
from puck_tables.scene.parts import Drag, Force, Lateral, Launch
from puck_tables.scene.pucks_and_posts import ScenePuck
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.scene.sides import ends_of_floor, shape_faults
from puck_tables.world.named_pucks import pucks_of, who
from puck_tables.world.paths import rows_of
from puck_tables.world.placement import misplaced

CUSHIONS = ("wall", "post", "arc")  # what rims may meet besides pucks
# of integrated states: coarser steps than for that are as long as the scene lets them, and check
# runs of the same steps tell nothing (test_no_estimate_is_too_small)
COARSEST = 1e-6
TABLE_ERROR = 1e-9  # of looked-up states: of places in Q²/J, of velocities in Q
_SMALLEST, _LARGEST = 1e-100, 1e100  # m, kg: squares of both are numbers


def refuse_endless(scene: SceneSpec) -> None:
    """Refuse a run that has no end of its own and is given none."""
    if scene.time is not None:
        return
    floor = scene.floor
    moves = bool(belts_of(floor).any()) or floor.turning != 0.0 or bool(floor.over_time)
    for number, puck in enumerate(pucks_of(scene)):
        under = frictions_under(scene, puck)
        grips = any(under) or bool(puck.path)
        viscous = [name for name, law in laws_in(scene).items() if law.largest(0.0) == 0.0]
        if viscous and not puck.path:
            raise InputError(
                f"{viscous[0]}: its friction is 0 at slip zero, so that nothing comes to "
                "rest: give a time"
            )
        if grips and not puck.path and not np.multiply(under, last_factors(floor)).any():
            raise InputError(
                f"floor.grip: friction is 0 in the end, so that {who(scene, number)} may never "
                "come to rest: give a time"
            )
        if not grips and not (scene.edges or scene.pockets):
            raise InputError(
                f"nothing brings {who(scene, number)} to rest (its friction is 0): give "
                "a time, or friction"
            )
        hold = puck.constraint
        if hold is not None and ((any(hold.velocity) and not moves) or hold.side_slip != 0.0):
            raise InputError(
                f"the {hold.kind} of {who(scene, number)} moves, so it never comes to rest: "
                "give a time"
            )


def frictions_under(scene: SceneSpec, puck: ScenePuck, fastest: float = 0.0) -> tuple[float, ...]:
    """Coulomb's coefficients under a puck: on each strip of the floor, then on each patch.

    Where they depend on the slip the largest, up to slips of ``fastest`` m/s: at 0 that at rest.

    >>> from puck_tables import Puck, Scene
    >>> frictions_under(Scene(pucks=[Puck(0.1, friction=0.2)]), Puck(0.1, friction=0.2))
    (0.2,)
    """
    floor = scene.floor
    return tuple(largest_of(one, fastest) for one in frictions_on(floor, puck.friction))


def has_closed_forms(puck: ScenePuck, friction: float) -> bool:
    """Whether closed forms hold for a friction of a puck, or it is 0."""
    delta = 2.0 * friction * puck.height / puck.radius
    if puck.shape is not None:
        return True  # in sums of its own, which are exact
    return friction == 0.0 or is_plain(puck.pressure, puck.gyration, delta)


def segment_error(scene: SceneSpec) -> float:
    """What segments may be wrong by, of Q²/J and Q; below that of tables none is looked up.

    >>> from puck_tables import Puck, Scene
    >>> men = [Puck(0.1, friction=0.2)]
    >>> [segment_error(Scene(pucks=men, tol=tol)) for tol in (1e-6, 1e-11)]
    [1e-09, 1e-11]
    """
    return min(TABLE_ERROR, scene.tol)


def steps_for(scene: SceneSpec) -> float:
    """What integrated segments may be wrong by, in the same units: alone what is asked, or less.

    Impacts multiply errors, and what presses cushions or pucks has to stay in touch.

    >>> from puck_tables import Launch, Puck, Scene
    >>> two = [Puck(0.1), Puck(0.1, launch=Launch(position=(1.0, 0.0)))]
    >>> steps_for(Scene(Puck(0.1), tol=1e-7)), steps_for(Scene(pucks=two, tol=1e-7))
    (1e-07, 1e-09)
    """
    meets = len(pucks_of(scene)) > 1 or any(getattr(scene, f"{name}s") for name in CUSHIONS)
    return segment_error(scene) if meets else min(scene.tol, COARSEST)


def is_integrated(scene: SceneSpec, puck: ScenePuck, friction: float) -> bool:
    """Whether the motion of a puck is integrated, on this friction, also while nothing touches it.

    >>> from puck_tables import Floor, Puck, Scene
    >>> is_integrated(Scene(pucks=[Puck(0.1)], floor=Floor(slope=0.1)), Puck(0.1), 0.1)
    True
    """
    drags, floor = scene.drag != Drag(), scene.floor
    unlike = bool(floor.law) or floor.orthotropic is not None or segment_error(scene) < TABLE_ERROR
    unlike = unlike or needs_sums(floor, puck.height) or bool(floor.over_time)
    unlike = unlike or follows_contour(scene.alone(puck))
    rough = friction > 0.0 and (drags or unlike or not has_closed_forms(puck, friction))
    turns = floor.turning != 0.0 and (friction > 0.0 or drags)
    more = floor.slope > 0.0 or puck.force != Force() or puck.constraint is not None
    more = more or is_stepped(scene.drag, scene.lateral)
    return not puck.path and (rough or turns or more)


def disagreements(scene: SceneSpec) -> list[str]:
    """What is wrong between fields that are each in range."""
    pucks = pucks_of(scene)
    faults = [*_not_here(scene), *_bad_floors(scene, pucks)]
    if not faults and has_belts(scene.floor):
        for name in ("drag", "lateral"):
            if getattr(scene, name) != (Drag() if name == "drag" else Lateral()):
                faults.append(
                    f"{name}: not known on belts of several velocities, floor.strips or "
                    "floor.patch; leave one out"
                )
    names = [puck.name for puck in pucks if puck.name]
    for name in sorted({name for name in names if names.count(name) > 1}):
        faults.append(f"puck.name = {name!r}: {names.count(name)} pucks have it, it must be of one")
    for number, puck in enumerate(pucks):
        faults += _of_one(scene, puck, f"puck[{number}]" if scene.pucks else "puck")
    for k, wall in enumerate(scene.walls):
        faults += [f"wall[{k}]: {fault}" for fault in shape_faults(wall)]
    normals = [(f"wall[{k}]", wall.normal) for k, wall in enumerate(scene.walls)]
    normals += [(f"edge[{k}]", edge.normal) for k, edge in enumerate(scene.edges)]
    for path, normal in normals:
        if normal is not None and not _SMALLEST < math.hypot(*normal) < _LARGEST:
            faults.append(f"{path}.normal = {list(normal)}: must have a direction")
    faults += _strange_lines(scene)
    faults += _strange_rims(scene)
    if not scene.frames.is_integer():
        faults.append(f"frames = {scene.frames:g}: must be a whole number")
    if faults:
        return faults
    return misplaced(scene, pucks)


def _strange_lines(scene: SceneSpec) -> Iterator[str]:
    """Painted lines that are neither straight nor round, or of which two have one name."""
    for k, line in enumerate(scene.lines):
        straight = line.start is not None and line.end is not None
        if straight == (line.radius > 0.0) or (line.start is None) != (line.end is None):
            yield f"line[{k}]: give its start and end, or a centre and a radius > 0 of a round one"
        elif straight and line.start == line.end:
            yield f"line[{k}].end = {line.end}: must lie elsewhere than its start"
    names = [line.name for line in scene.lines if line.name]
    for name in sorted({name for name in names if names.count(name) > 1}):
        yield f"line.name = {name!r}: {names.count(name)} lines have it, it must be of one"


def _not_here(scene: SceneSpec) -> Iterator[str]:
    """What a scene of several pucks does not take."""
    if not scene.pucks:
        return
    for name, part, default in (
        ("launch", scene.launch, Launch()), ("force", scene.force, Force()),
        ("constraint", scene.constraint, None),
    ):  # fmt: skip
        if part != default:
            yield f"{name}: each of several pucks has its own, puck[0].{name}"


def _bad_floors(scene: SceneSpec, pucks: tuple[ScenePuck, ...]) -> Iterator[str]:
    """What is wrong with the friction of the floor, and whose base it does not fit."""
    faults: dict[str, list[str]] = {}
    for number, puck in enumerate(pucks):
        for fault in () if puck.path else floor_faults(scene.alone(puck)):
            faults.setdefault(fault, []).append(who(scene, number))
    slides = sum(not puck.path for puck in pucks)
    for fault, names in faults.items():
        yield fault if len(names) == slides else f"{', '.join(names)}: {fault}"


def _of_one(scene: SceneSpec, puck: ScenePuck, path: str) -> Iterator[str]:
    """What is wrong with one of them."""
    for name, value in (("radius", puck.radius), ("mass", puck.mass)):
        if not _SMALLEST <= value <= _LARGEST:
            yield (
                f"{path}.{name} = {value:g}: must be from {_SMALLEST:g} to {_LARGEST:g} in a "
                "scene, use other units"
            )
    yield from _bad_base(scene, puck, path)
    if puck.path:
        for name, part, default in (
            ("launch", puck.launch, Launch(position=puck.launch.position)),
            ("force", puck.force, Force()), ("constraint", puck.constraint, None),
        ):  # fmt: skip
            if part != default:
                yield f"{path}.{name}: what is driven along a path has none, leave it out"
        try:
            rows_of(puck.path)
        except InputError as error:
            yield f"{path}.path: {error}"
        return
    rows = puck.force.over_time
    if rows and not isinstance(rows, str):
        try:
            drive_of(rows)
        except InputError as error:
            yield f"{path}.{error}"
    hold, alone = puck.constraint, f"{path}." if scene.pucks else ""
    yield from misfits(puck.launch, hold, scene.floor, alone)
    if hold is not None and scene.floor.over_time:
        yield f"{path}.constraint: not known beside floor.over_time; leave one out"
    if hold is not None and has_belts(scene.floor):
        yield (
            f"{path}.constraint: not known on belts of several velocities, floor.strips or "
            "floor.patch; leave one out"
        )
    if hold is not None and any(hold.velocity) and puck.launch.time > 0.0:
        yield (
            f"{path}.launch.time = {puck.launch.time:g}: a {hold.kind} that moves leads it "
            "at once, leave it out"
        )


def _bad_base(scene: SceneSpec, puck: ScenePuck, path: str) -> Iterator[str]:
    """What does not go with a base that is not round."""
    if puck.shape is None:
        return
    if puck.path:
        yield f"{path}.base: what is driven along a path needs no base, give its radius"
    elif puck.shape.has_own_loads:
        yield from _bad_feet(scene.alone(puck), path)
    if puck.has_rim:
        return
    met = [name for name in CUSHIONS if getattr(scene, f"{name}s")]
    met += ["puck"] if len(pucks_of(scene)) > 1 else []
    if met:
        yield (
            f"{path}.radius is missing: a body that may meet a {met[0]} needs a round rim around "
            f"its base, {path}.radius, of at least {puck.shape.reach:.6g} m"
        )
    usual = ScenePuck(1.0)
    for name in ("restitution", "tangential", "rim"):
        if getattr(puck, name) != getattr(usual, name):
            yield f"{path}.{name}: a base without a rim meets nothing, give {path}.radius, or none"


def _bad_feet(scene: SceneSpec, path: str) -> Iterator[str]:
    """Why friction is not known under feet with loads of their own."""
    floor, own = scene.floor, f"{path}.base: feet with loads of their own"
    alike = floor.strips is None and not floor.patches and not ends_of_floor(scene)
    if not alike or floor.law or floor.orthotropic is not None:
        yield (
            f"{own} are known on a floor of one coefficient, without edges; leave their loads out, "
            "or the strips, patches, laws, directions and edges"
        )
    elif may_lift(scene):
        yield f"{own} are known while none lifts: give a lower {path}.height, or no loads"


def _strange_rims(scene: SceneSpec) -> Iterator[str]:
    """What is wrong with the rims of pairs."""
    pucks = pucks_of(scene)
    known = {puck.name for puck in pucks} | {puck.colour for puck in pucks}
    for kind, ones in zip(CUSHIONS, (scene.walls, scene.posts, scene.arcs), strict=True):
        known |= {kind, *(f"{kind} {k}" for k in range(len(ones)))} if ones else set()
    called_so = {name for one in pucks for name in (one.name, one.colour)} - {""}
    for number, rim in enumerate(scene.rims):
        if rim.restitution is None and rim.tangential is None and rim.friction is None:
            yield (
                f"rim[{number}]: says nothing: give restitution, tangential or friction, or leave "
                "it out"
            )
        for side in ("puck", "partner"):
            called, may = getattr(rim, side), (called_so if side == "puck" else known - {""})
            if called not in may:
                more = "" if side == "puck" else ", or a cushion, 'wall 0' or all, 'wall'"
                yield (
                    f"rim[{number}].{side} = {called!r}: must be the name of a puck or the colour "
                    f"of pucks{more}{meant(called, sorted(may))}"
                )

"""All frictions of a floor, for one puck, packed."""

from __future__ import annotations

import math
from collections.abc import Hashable
from functools import lru_cache
from typing import Any

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.contact.base import Base
from puck_tables.contact.friction_laws import FrictionLaw
from puck_tables.contact.law_moments import packed_law
from puck_tables.contact.speed_law import SpeedLaw
from puck_tables.kernels.base_friction import packed, packed_round
from puck_tables.kernels.pressed_part import NARROWEST
from puck_tables.motion.puck_spec import PuckSpec
from puck_tables.scene.by_speed import LAW_SHARE, UNDER_LAW_ERROR, key_of, moments_of
from puck_tables.scene.floor_map import LOAD, MOST_EDGES, NO_FLOOR_MAP, PATCH_COLUMNS, FloorMap
from puck_tables.scene.floor_parts import (
    belts_of,
    directions_in,
    frictions_on,
    has_laws_by_place,
    has_sums,
    largest_of,
)
from puck_tables.scene.floor_patches import corners_of
from puck_tables.scene.over_time import does_turn, largest_factors
from puck_tables.scene.parts import Orthotropic
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.scene.sides import ends_of_floor, line_of

_NO_EDGES = np.empty((0, 3))
MANY = 10_000  # launches, from which on a table of a friction law pays


def floor_map_of(scene: SceneSpec, normal: float, top: float = 0.0) -> FloatArray:
    """All frictions of the floor of a scene, for its puck, packed; ``normal``: N.

    ``top``: up to which slip speed its laws are looked at, m/s.

    >>> from puck_tables import Floor, Puck, Scene, Strips
    >>> floor = Floor(strips=Strips((0.1,), (0.3, 0.1)))
    >>> floor_map_of(Scene(Puck(0.04), floor), 2.0)[23:26].tolist()
    [0.1, 0.6, 0.2]
    """
    floor, puck = scene.floor, scene.puck
    shape, strips = shape_under(scene, top), floor.strips
    if shape is None and not has_sums(floor, puck.height):
        return NO_FLOOR_MAP
    angle = 0.0 if strips is None else strips.direction
    rows, corners = [], [np.empty((0, 2))]
    for patch in floor.patches:
        begin, places = sum(map(len, corners)), corners_of(patch)
        middle, reach = np.array(patch.centre), patch.radius
        if len(places):
            middle = 0.5 * (places.min(axis=0) + places.max(axis=0))
            reach = float(np.hypot(*(places - middle).T).max())
            corners.append(places)
        rows.append([*middle, reach, begin, len(places), 0.0])
    frictions = frictions_on(floor, puck.friction)
    loads = normal * np.array([one if isinstance(one, float) else 1.0 for one in frictions])
    parts = np.array(rows).reshape(-1, PATCH_COLUMNS)
    strip_count = len(loads) - len(parts)
    parts[:, LOAD] = loads[strip_count:]
    there = (
        math.cos(angle), math.sin(angle),
        np.array(() if strips is None else strips.borders, np.float64),
        loads[:strip_count], parts, np.concatenate(corners),
    )  # fmt: skip
    lever = 0.5 * puck.height / normal
    base = packed(shape, lever) if shape else packed_round(puck.radius, puck.body.law, lever)
    kept = {_key_of(one): one for one in frictions if not isinstance(one, float)}
    which = [-1 if isinstance(one, float) else list(kept).index(_key_of(one)) for one in frictions]
    sure = shape is None or (puck.height == 0.0 and shape.is_under_centre)  # up to its centre
    laws = [_packed(one, top) for one in kept.values()]
    how = edges_under(scene), may_lift(scene, top), 0.0 if sure else NARROWEST
    turning = floor.turning if directions_in(floor) else 0.0
    return FloorMap(*there, base, laws, which, belts_of(floor), *how, turning).packed()


def _key_of(one: SpeedLaw | FrictionLaw | Orthotropic) -> Hashable:
    if not isinstance(one, Orthotropic):
        return key_of(one)
    law: Any = one.law
    return one.friction, one.direction, one.fixed_to, key_of(law) if law else None


def _packed(one: SpeedLaw | FrictionLaw | Orthotropic, top: float) -> FloatArray:
    """A law in one array, up to a slip speed, m/s."""
    if not isinstance(one, Orthotropic):
        return np.concatenate([[1.0, 1.0, 0.0, 0.0], packed_law(*moments_of(one, top))])
    axes = [*one.friction, one.direction, float(one.fixed_to == "floor")]
    law: Any = one.law
    return np.concatenate([axes, packed_law(*moments_of(law, top)) if law else [0.0]])


def may_lift(scene: SceneSpec, top: float = 0.0) -> bool:
    """Whether friction may lift a part of the base of the puck, which is then pressed one-sided.

    ``top``: up to which slip speed laws are looked at, m/s.

    >>> from puck_tables import Puck, Scene
    >>> [may_lift(Scene(Puck(base="box:0.2x0.1", friction=0.3, height=h))) for h in (0.05, 0.2)]
    [False, True]
    """
    shape = shape_under(scene, top)
    return shape is not None and _lifts(scene, shape, top)


def _lifts(scene: SceneSpec, shape: Base, top: float) -> bool:
    """Whether friction may lift a part of a base under the puck of a scene."""
    floor, puck = scene.floor, scene.puck
    if puck.height == 0.0:
        return False
    most = np.array([largest_of(one, top) for one in frictions_on(floor, puck.friction)])
    strongest = floor.static_ratio * float((largest_factors(floor) * most).max())
    return not 0.5 * strongest * puck.height <= shape.highest_lever


def edges_under(scene: SceneSpec) -> FloatArray:
    """The edges (e, 3) that leave its puck carried by the rest of its base; none: it is not.

    A unit normal into the floor and the place along it, m.  It is where the rest is pressed
    linearly: under uniform pressure or any base.

    >>> from puck_tables import Edge, Puck, Scene
    >>> puck = Puck(base="box:0.2x0.1", friction=0.3)
    >>> scene = Scene(puck, edges=[Edge((0.5, 0.0), normal=(-1.0, 0.0))])
    >>> edges_under(scene).tolist()
    [[-1.0, 0.0, -0.5]]
    """
    ends = ends_of_floor(scene)
    if len(ends) > MOST_EDGES or _pressed_base(scene.puck) is None:
        return _NO_EDGES
    return np.array([line_of(scene.edges[number]) for number in ends]).reshape(-1, 3)


def _pressed_base(puck: PuckSpec) -> Base | None:
    """The base of a puck that is pressed linearly; None: its pressure is another."""
    if puck.shape is not None:
        return puck.shape
    law = puck.body.law
    if law.name == "uniform":
        return _round_base(puck.radius, 0.0)
    if law.name.startswith("annulus:"):
        return _round_base(puck.radius, law.edges[0] * puck.radius)
    return None


@lru_cache(maxsize=256)
def _round_base(radius: float, inner: float) -> Base:
    """Kept: what is asked of it for each puck on each stretch takes some 0.5 ms to find."""
    return Base.annulus(radius, inner) if inner > 0.0 else Base.disc(radius)


def shape_under(scene: SceneSpec, top: float = 0.0) -> Base | None:
    """The base over which friction is summed in axes of its own; None: it is round in all ways.

    ``top``: up to which slip speed laws are looked at, m/s.

    >>> from puck_tables import Floor, Orthotropic, Puck, Scene
    >>> brushed = Orthotropic((0.1, 0.2), fixed_to="body")
    >>> shape_under(Scene(Puck(0.04), Floor(orthotropic=brushed))).reach
    0.04
    """
    puck = scene.puck
    if puck.shape is None and (follows_contour(scene, top) or len(edges_under(scene))):
        return _pressed_base(puck)
    return puck.shape


def follows_contour(scene: SceneSpec, top: float = 0.0) -> bool:
    """Whether friction of the puck of a scene is summed along the contour of its base everywhere.

    Beside laws by place, and where round pucks have no other sums: where friction may lift a part
    of the base but on a floor of one coefficient, and by a direction that is not the floor's.
    ``top``: up to which slip speed laws are looked at, m/s.

    >>> from puck_tables import Floor, Puck, Scene, Strips
    >>> halves = Floor(strips=Strips((0.0,), (0.1, 0.2)))
    >>> [follows_contour(Scene(Puck(0.04, height), halves)) for height in (0.02, 0.2)]
    [False, True]
    """
    floor, puck = scene.floor, scene.puck
    if puck.shape is not None or has_laws_by_place(floor):
        return True
    two = floor.orthotropic
    if two is not None:
        plain = two.fixed_to == "floor" and puck.body.law.name == "uniform"
        if not plain or does_turn(floor):
            return True
    elif floor.law:
        return _pressed_base(puck) is not None
    elif not has_sums(floor, puck.height):
        return False
    base = _pressed_base(puck) if puck.height > 0.0 else None
    return base is not None and _lifts(scene, base, top)


def sums_law(scene: SceneSpec, top: float, runs: int = 1) -> bool:
    """Whether friction by slip speed is summed under its puck where it could be looked up.

    A table takes seconds to build, and a quarter of the time to read: it is for many runs, for
    errors that sums do not promise, and for pressures without sums.
    ``top``: up to which slip speed the law is looked at, m/s; ``runs``: that share it.

    >>> from puck_tables import Floor, Puck, Scene, StribeckLaw
    >>> scene = Scene(Puck(0.04), Floor(law=StribeckLaw(0.3, 0.1, speed=0.2)))
    >>> sums_law(scene, 1.0), sums_law(scene, 1.0, runs=20_000)
    (True, False)
    """
    few = runs < MANY and LAW_SHARE * scene.tol >= UNDER_LAW_ERROR
    return follows_contour(scene, top) and (few or may_lift(scene, top))

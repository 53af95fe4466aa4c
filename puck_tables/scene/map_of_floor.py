"""All frictions of a floor, for one puck, packed."""

from __future__ import annotations

import math

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.contact.base import Base
from puck_tables.contact.law_moments import DEGREE, packed_law
from puck_tables.kernels.base_friction import packed, packed_round
from puck_tables.scene.floor_map import NO_GROUND, PATCH_COLUMNS, FloorMap
from puck_tables.scene.floor_parts import belts_of, needs_sums
from puck_tables.scene.floor_patches import corners_of
from puck_tables.scene.scene_spec import SceneSpec

Moments = tuple[FloatArray, FloatArray, FloatArray]

_AT_REST = (-1.0) ** np.arange(DEGREE + 1)  # powers of t at the beginning of a piece


def floor_map_of(scene: SceneSpec, normal: float, law: Moments | None = None) -> FloatArray:
    """All frictions of the floor of a scene, for its puck, packed; ``normal``: N.

    ``law``: moments of the friction over the slip speed, under a base that is not round.

    Examples
    --------
    >>> from puck_tables import Floor, Puck, Scene, Strips
    >>> floor = Floor(strips=Strips((0.1,), (0.3, 0.1)))
    >>> floor_map_of(Scene(Puck(0.04), floor), 2.0)[15:18].tolist()
    [0.1, 0.6, 0.2]
    """
    floor, puck = scene.floor, scene.puck
    one = floor.strips is None and not floor.patches and not needs_sums(floor, puck.height)
    shape, strips, axes = shape_under(scene), floor.strips, floor.orthotropic
    if one and shape is None:
        return NO_GROUND
    angle = 0.0 if strips is None else strips.direction
    rows, corners = [], [np.empty((0, 2))]
    for patch in floor.patches:
        begin, places = sum(map(len, corners)), corners_of(patch)
        middle, reach = np.array(patch.centre), patch.radius
        if len(places):
            middle = 0.5 * (places.min(axis=0) + places.max(axis=0))
            reach = float(np.hypot(*(places - middle).T).max())
            corners.append(places)
        rows.append([*middle, reach, begin, len(places), normal * patch.friction])
    friction = puck.friction if law is None else float(law[1][0, 0] @ _AT_REST)
    friction = friction if axes is None else min(axes.friction)
    there = (
        math.cos(angle), math.sin(angle),
        np.array(() if strips is None else strips.borders, np.float64),
        normal * np.array((friction,) if strips is None else strips.friction),
        np.array(rows).reshape(-1, PATCH_COLUMNS), np.concatenate(corners),
    )  # fmt: skip
    lever, over_slip = 0.5 * puck.height / normal, np.empty(0)
    if shape is None:
        base = packed_round(puck.radius, puck.body.law, lever)
        return FloorMap(*there, base, over_slip, belts_of(floor)).packed()
    if law is not None:
        over_slip = packed_law(law[0], normal * law[1], law[2])
    if axes is not None:
        turns = float(axes.fixed_to == "floor")
        over_slip = np.array([*np.multiply(normal, axes.friction), axes.direction, turns])
    return FloorMap(*there, packed(shape, lever), over_slip, belts_of(floor)).packed()


def shape_under(scene: SceneSpec) -> Base | None:
    """The base over which friction is summed in axes of its own; None: it is round in all ways.

    Examples
    --------
    >>> from puck_tables import Floor, Orthotropic, Puck, Scene
    >>> brushed = Orthotropic((0.1, 0.2), fixed_to="body")
    >>> shape_under(Scene(Puck(0.04), Floor(orthotropic=brushed))).reach
    0.04
    """
    puck, axes = scene.puck, scene.floor.orthotropic
    if puck.shape is None and axes is not None and axes.fixed_to == "body":
        return Base.disc(puck.radius)
    return puck.shape

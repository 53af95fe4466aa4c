"""A board with other friction and restitutions, drawn."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from puck_tables.contact.friction_laws import CurlingLaw
from puck_tables.scene.scene_spec import SceneSpec


def varied(scene: SceneSpec, spread: float, rng: np.random.Generator) -> SceneSpec:
    """The friction of all pucks, or of the law, times one factor; each restitution times its own.

    Factors are from 1 − spread to 1 + spread; no restitution goes beyond 1.

    Examples
    --------
    >>> from puck_tables import Scene
    >>> other = varied(Scene.load("carrom-break"), 0.1, np.random.default_rng(1))
    >>> round(other.pucks[0].friction, 6), round(other.walls[0].restitution, 6)
    (0.150355, 0.650182)
    """
    factor = rng.uniform(1.0 - spread, 1.0 + spread)
    bounce = {}

    def of(part: Any) -> Any:
        e = part.restitution
        if not isinstance(e, float):
            return part
        if e not in bounce:
            bounce[e] = rng.uniform(1.0 - spread, min(1.0 + spread, 1.0 / e) if e else 1.0)
        return replace(part, restitution=e * bounce[e])

    pucks = [of(replace(puck, friction=factor * puck.friction)) for puck in scene.pucks]
    floor, law = scene.floor, scene.floor.law
    if isinstance(law, CurlingLaw):
        floor = replace(floor, law=replace(law, a=factor * law.a, c=factor * law.c))
    walls, posts, arcs = (tuple(map(of, ones)) for ones in (scene.walls, scene.posts, scene.arcs))
    return replace(scene, pucks=tuple(pucks), floor=floor, walls=walls, posts=posts, arcs=arcs)

"""What stands on a board, and where its floor changes, as rows of the compiled engine.

And the laws of its rims as the engine reads them, and in words.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.scene.parts import Wall
from puck_tables.scene.pucks_and_posts import Arc, Post, ScenePuck
from puck_tables.scene.restitution import Restitution, restitution_law
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.scene.sides import corners_in, cushions_in, ends_of_floor, line_of, sides_in
from puck_tables.world import layout
from puck_tables.world.named_pucks import pucks_of


def _laws_of(scene: SceneSpec, first: int) -> tuple[FloatArray, dict[object, float]]:
    """The numbers of all laws of restitution, from a place on, and what number calls each."""
    laws: list[FloatArray] = [np.zeros(0)]
    called: dict[object, float] = {}
    for restitution in _restitutions(scene):
        key = restitution.numbers.tobytes() if isinstance(restitution, Restitution) else restitution
        if not isinstance(restitution, float | int) and key not in called:
            called[key] = -1.0 - first - sum(map(len, laws))
            laws.append(restitution_law(restitution).numbers)
    return np.concatenate(laws), called


def number_for(restitution: float | str | Restitution | None, called: dict[object, float]) -> float:
    """A restitution as one number: itself, or the place of its law; NaN where it is left out."""
    if restitution is None:
        return math.nan
    if isinstance(restitution, float | int):
        return float(restitution)
    return called[
        restitution.numbers.tobytes() if isinstance(restitution, Restitution) else restitution
    ]


def _restitutions(scene: SceneSpec) -> Iterator[float | str | Restitution]:
    """All restitutions of a scene."""
    parts: tuple[Any, ...] = (
        *pucks_of(scene), *scene.walls, *scene.posts, *scene.arcs, *scene.rims
    )  # fmt: skip
    for part in parts:
        if part.restitution is not None:
            yield part.restitution


def rims_of(
    scene: SceneSpec, pucks: list[ScenePuck]
) -> tuple[FloatArray, FloatArray, FloatArray, dict[object, float]]:
    """The array of :mod:`puck_tables.world.layout`; which kinds of rims discs and obstacles have.

    Those that the same rims of the scene name have one kind.  And by what numbers laws are called.
    """
    names = [(kind, f"{kind} {k}") for kind, k in _standing_in(scene)]
    if not scene.rims:
        laws, called = _laws_of(scene, 1)
        rims = np.concatenate([[0.0], laws])
        return rims, np.zeros(len(pucks)), np.zeros(len(names)), called
    sides = [side for rim in scene.rims for side in (rim.puck, rim.partner)]
    named = {puck.name for puck in pucks if puck.name}
    signs = [tuple(_is(puck, side, named) for side in sides) for puck in pucks]
    signs += [tuple(side in name and bool(side) for side in sides) for name in names]
    kinds = {sign: number for number, sign in enumerate(dict.fromkeys(signs))}
    first = 1 + len(kinds) ** 2
    meets = np.full((len(kinds), len(kinds)), -1.0)
    for row in range(len(scene.rims)):  # of several the last counts
        for sign, one in kinds.items():
            for other, two in kinds.items():
                if (sign[2 * row] and other[2 * row + 1]) or (sign[2 * row + 1] and other[2 * row]):
                    meets[one, two] = first + 3 * row
    laws, called = _laws_of(scene, first + 3 * len(scene.rims))
    pairs = [
        [number_for(rim.restitution, called), *(math.nan if one is None else one
         for one in (rim.tangential, rim.friction))] for rim in scene.rims
    ]  # fmt: skip
    makes = np.array([kinds[sign] for sign in signs], np.float64)
    rims = np.concatenate([[len(kinds)], meets.ravel(), np.ravel(pairs), laws])
    return rims, makes[: len(pucks)], makes[len(pucks) :], called


def _is(puck: ScenePuck, side: str, named: set[str]) -> bool:
    """Whether a side of a rim means a puck: its name, or else its colour."""
    return puck.name == side if side in named else bool(side) and puck.colour == side


def rule_of(scene: SceneSpec) -> str:
    """By which law pucks meet, in words.

    >>> from puck_tables import Puck, Scene
    >>> print(rule_of(Scene(pucks=[Puck(0.1, restitution="plastic:0.1")])))
    impacts by Walton's law: of two pucks the smaller of each number counts, a cushion has its own
    restitution plastic:0.1 at the speed of approach: Thornton 1997, Journal of Applied Mechanics 64
    """
    lines = [
        "impacts by Walton's law: of two pucks the smaller of each number counts, a cushion has "
        "its own"
    ]
    for number, rim in enumerate(scene.rims):
        own = ("restitution", "tangential", "friction")
        rules = ", ".join(
            f"{name} {_shown(getattr(rim, name))}" for name in own if getattr(rim, name) is not None
        )
        lines.append(f"rim[{number}]: {rim.puck} and {rim.partner} meet by {rules or 'the same'}")
    laws = {
        law.name: law for law in map(restitution_law, (
            one for one in _restitutions(scene) if not isinstance(one, float | int)
        ))
    }  # fmt: skip
    lines += [
        f"restitution {name} at the speed of approach: {law.source}" for name, law in laws.items()
    ]
    return "\n".join(lines)


def _shown(value: object) -> str:
    return f"{value:g}" if isinstance(value, float | int) else getattr(value, "name", str(value))


def obstacles_of(scene: SceneSpec, called: dict[object, float], makes: FloatArray) -> FloatArray:
    """Rows of :mod:`puck_tables.world.layout`: what stands, edges twice, then borders."""

    def rim(cushion: Wall | Post | Arc) -> list[float]:
        return [number_for(cushion.restitution, called), cushion.tangential, cushion.friction]

    rows: list[list[float]] = []
    sides = sides_in(scene)
    for number, wall in enumerate(scene.walls):
        if wall.point is not None:
            rows.append([layout.WALL, *line_of(wall), *rim(wall)])
        for side in sides:
            if side.wall == number:
                (nx, ny), (x, y) = side.normal, side.start
                row = [layout.SIDE, nx, ny, nx * x + ny * y, *rim(wall), 0.0, 0.0]
                rows.append([*row, *side.start, *side.end])
    for post in scene.posts:
        rows.append([layout.POST, *post.point, post.radius, *rim(post)])
    for arc in scene.arcs:
        rows.append([layout.ARC, *arc.point, arc.radius, *rim(arc), arc.start, arc.span])
    for corner in corners_in(scene):
        row = [layout.CORNER, *corner.point, 0.0, *rim(scene.walls[corner.wall]), 0.0, 0.0]
        rows.append([*row, *corner.one, *corner.other])
    for pocket in scene.pockets:
        rows.append([layout.POCKET, *pocket.point, pocket.radius])
    for edge in scene.edges:
        rows.append([layout.EDGE, *line_of(edge)])
    for number in ends_of_floor(scene):
        rows.append([layout.OVERHANG, *line_of(scene.edges[number]), 0.0, 0.0, 0.0, float(number)])
    borders = len(borders_of(scene))
    for number in range(borders + len(scene.floor.patches)):
        rows.append([layout.BORDER if number < borders else layout.PATCH, float(number)])
    table = np.zeros((len(rows), layout.OBSTACLE_COLUMNS))
    for place, one in enumerate(rows):
        table[place, : len(one)] = one
    table[:, layout.OBSTACLE_MAKE] = makes
    return table


def _standing_in(scene: SceneSpec) -> list[tuple[str, int]]:
    """Kind and number of what each row of the obstacles is of, in their order."""
    floor = ("border", range(len(borders_of(scene)))), ("patch", range(len(scene.floor.patches)))
    lists = (("pocket", range(len(scene.pockets))), ("edge", range(len(scene.edges))),
             ("edge", ends_of_floor(scene)), *floor)  # fmt: skip
    return cushions_in(scene) + [(kind, number) for kind, numbers in lists for number in numbers]


def obstacle_names(scene: SceneSpec) -> list[str]:
    """What the rows of the obstacles are called, in their order."""
    return [f"{kind} {number}" for kind, number in _standing_in(scene)]


def borders_of(scene: SceneSpec) -> tuple[float, ...]:
    """The borders of its strips."""
    return scene.floor.strips.borders if scene.floor.strips is not None else ()

"""The dry friction of the floor under every puck, as the compiled engine reads it.

Rows are all pucks at one place of the floor after the other, see
:mod:`puck_tables.world.floor_under`.
"""

from __future__ import annotations

import math
from functools import cache, partial
from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.quadratic import NO_SECTION
from puck_tables.scene.by_speed import NO_LAW, law_range, law_table, law_top, load_under
from puck_tables.scene.floor_map import NO_FLOOR_MAP
from puck_tables.scene.floor_parts import belts_of, count_parts, has_laws_by_place, needs_sums
from puck_tables.scene.friction import SPIN, VX, VY, X, Y
from puck_tables.scene.ingredients import BySpeed, Regions, Surface, floor_velocity
from puck_tables.scene.map_of_floor import edges_under, floor_map_of, follows_contour, sums_law
from puck_tables.scene.over_time import largest_factors
from puck_tables.scene.pucks_and_posts import ScenePuck
from puck_tables.scene.regions import axes_of, load_limit, of_one_shape, rubs_plainly, section_of
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.world.agreement import frictions_under, is_integrated
from puck_tables.world.engine_state import Engine
from puck_tables.world.floor_under import floor_of
from puck_tables.world.named_pucks import pucks_of

INTEGRATED, NOT_HELD = 1.0, 2.0  # see :mod:`puck_tables.world.layout`


def normal_on(scene: SceneSpec, puck: ScenePuck) -> float:
    """The force that presses a puck on the floor, N."""
    return puck.mass * puck.gravity * math.cos(scene.floor.slope)


def may_be_mixed(scene: SceneSpec) -> bool:
    """Whether a base may lie on several frictions, or hang over an edge: it is summed there."""
    if scene.floor.strips is not None or scene.floor.patches:
        return True
    return any(_may_hang(scene, puck) for puck in pucks_of(scene))


def _may_hang(scene: SceneSpec, puck: ScenePuck) -> bool:
    return not puck.path and len(edges_under(scene.alone(puck))) > 0


def floors_of(scene: SceneSpec, pucks: list[ScenePuck], fastest: float) -> FloatArray:
    """Deceleration, δ, whether it is integrated, and the velocity of the floor, (n, 5).

    Of every puck at every place of the floor.

    Astride the largest of them.  ``fastest``: a slip to which a friction law is looked at, m/s.
    """
    frictions = [_strongest_under(scene, puck, fastest) for puck in pucks]
    by_slip = bool(scene.floor.law) or scene.floor.orthotropic is not None
    rows = []
    for place in range(len(frictions[0])):
        for puck, friction in zip(pucks, frictions, strict=True):
            unheld = by_slip or bool(scene.floor.over_time) or _is_summed(scene, puck)
            how = NOT_HELD if unheld else float(is_integrated(scene, puck, friction[place]))
            rows.append(_row(scene, puck, friction[place], how))
    if may_be_mixed(scene):
        for puck, friction in zip(pucks, frictions, strict=True):
            rows.append(_row(scene, puck, max(friction), NOT_HELD))
    belts = np.repeat(belts_of(scene.floor), len(pucks), axis=0)
    missing = len(rows) - len(belts)  # astride, where it depends
    belts = np.concatenate([belts, np.tile(belts[:1], (missing, 1))])
    return np.column_stack([rows, belts])


def _strongest_under(scene: SceneSpec, puck: ScenePuck, fastest: float) -> list[float]:
    """The coefficients under a puck, on every stretch the largest that it ever has."""
    under = frictions_under(scene, puck, fastest)
    return (largest_factors(scene.floor) * under).tolist()


def _row(scene: SceneSpec, puck: ScenePuck, friction: float, how: float) -> list[float]:
    if puck.path:
        return [0.0, 0.0, 0.0]
    decel = friction * puck.gravity * math.cos(scene.floor.slope)
    if puck.shape is not None:
        return [decel, 0.0, how]  # its height stands with its base
    return [decel, 2.0 * friction * puck.height / puck.radius, how]


def regions_of(
    scene: SceneSpec, pucks: list[ScenePuck], floors: FloatArray, fastest: float, runs: int = 1
) -> Regions:
    """The dry friction of every puck everywhere: closed forms, or tables if one needs them.

    ``fastest``: the fastest slip of a rim for which a friction law is to hold, m/s; ``runs``: how
    many launches it is for.

    Raises InputError, ContactError if the friction law cannot be read, ends below the slips at the
    launches, or lifts a base; AccuracyError if the friction of one cannot be tabulated as fine as
    the scene asks.
    """
    normals = np.array([0.0 if puck.path else normal_on(scene, puck) for puck in pucks])
    count, delta = len(floors), floors[:, 1].copy()
    none = np.empty((count, *NO_SECTION.shape))
    if has_laws_by_place(scene.floor):
        return _by_place(scene, pucks, normals, floors, fastest)
    if scene.floor.law:
        return _by_slip(scene, pucks, normals, delta, fastest, runs)
    if scene.floor.orthotropic is not None:
        axes, factor = axes_of(scene.floor.orthotropic), float(largest_factors(scene.floor)[0])
        own = [None if puck.path or _is_summed(scene, puck) else axes for puck in pucks]
        return _of_one_law(scene, pucks, normals * factor * axes[:2].max(), delta, own, math.inf)
    there = [[(puck, f) for f in _strongest_under(scene, puck, 0.0)] for puck in pucks]
    places = [one for rows in zip(*there, strict=True) for one in rows]
    summed = np.array([_is_summed(scene, puck) for puck, _ in places])
    loads = np.array([
        0.0 if puck.path else normal_on(scene, puck) * friction for puck, friction in places
    ])  # fmt: skip
    limits, limit_at = none[: len(places)], cache(partial(load_limit, scene.tol))
    looks = [  # no matter at which height where it is summed
        (puck, 0.0 if sums else height, sums or friction == 0.0)
        for (puck, friction), height, sums in zip(
            places, delta[: len(places)].tolist(), summed.tolist(), strict=True
        )
    ]  # fmt: skip
    if all(
        at_hand or puck.shape is not None or rubs_plainly(puck, height)
        for puck, height, at_hand in looks
    ):
        if floors[:, 2].any():  # those that are integrated ask for friction often
            limits = np.stack([limit_at(height) for _, height, _ in looks])
    else:
        own = [
            None if at_hand else section_of(puck, height, scene.tol)
            for puck, height, at_hand in looks
        ]  # fmt: skip
        any_one = next(one for one in own if one is not None)
        limits = of_one_shape([any_one if one is None else one for one in own])
    floor_map, several = NO_FLOOR_MAP, may_be_mixed(scene)
    if several:
        most = loads.reshape(-1, len(pucks)).max(axis=0)
        loads = np.concatenate([loads, most])
        limits = np.concatenate([limits, limits[: len(pucks)]])
    if several or summed.any():
        floor_map = _grounds(scene, pucks, np.ones(len(pucks), np.bool_))
    is_summed = np.concatenate([summed, np.ones(count - len(places), np.bool_)])
    laws = np.zeros((len(pucks), 2), np.int64)
    return Regions(loads, delta, limits, NO_LAW, is_summed, floor_map, laws)


def _is_summed(scene: SceneSpec, puck: ScenePuck) -> bool:
    """Whether its friction is summed over its base everywhere, not looked up."""
    sums = needs_sums(scene.floor, puck.height)
    sums = sums and scene.floor.orthotropic is None and not scene.floor.law
    return not puck.path and (sums or follows_contour(scene.alone(puck)))


def _grounds(
    scene: SceneSpec, pucks: list[ScenePuck], summed: npt.NDArray[np.bool_], top: float = 0.0
) -> FloatArray:  # fmt: skip
    """The frictions under those pucks over whose bases they are summed, all of one length.

    ``top``: up to which slip their laws are looked at, m/s.
    """
    grounds = [
        floor_map_of(scene.alone(puck), normal_on(scene, puck), top) if sums else NO_FLOOR_MAP
        for puck, sums in zip(pucks, summed, strict=True)
    ]
    size = max(map(len, grounds))  # what they end with is room to work
    return np.concatenate([np.pad(own, (0, size - len(own))) for own in grounds])


def _by_place(
    scene: SceneSpec, pucks: list[ScenePuck], normals: FloatArray, floors: FloatArray,
    fastest: float,
) -> Regions:  # fmt: skip
    """By laws over the slip speed that differ by place: summed over every base, wherever it lies.

    Raises InputError, ContactError as :func:`regions_of`.
    """
    top = law_top(scene, fastest)
    most = np.array([
        [0.0] * count_parts(scene.floor) if puck.path else _strongest_under(scene, puck, top)
        for puck in pucks
    ])  # fmt: skip
    slide = np.array([not puck.path for puck in pucks])
    loads = normals * np.vstack([most.T, most.max(axis=1)])[: len(floors) // len(pucks)]
    return Regions(
        loads.ravel(), floors[:, 1].copy(), np.empty((len(floors), *NO_SECTION.shape)),
        BySpeed(np.array([1.0, top]), 0.0, 1.0, 1.0), np.tile(slide, len(loads)),
        _grounds(scene, pucks, slide, top), np.zeros((len(pucks), 2), np.int64),
    )  # fmt: skip


def _by_slip(
    scene: SceneSpec, pucks: list[ScenePuck], normals: FloatArray, delta: FloatArray,
    fastest: float, runs: int,
) -> Regions:  # fmt: skip
    """By a friction law over the slip speed: by tables, or summed along contours.

    Raises InputError, AccuracyError as :func:`regions_of`; ContactError if it lifts a base.
    """
    law, top, largest = law_range(scene, fastest)
    factor = float(largest_factors(scene.floor)[0])
    largest, static = largest * factor, scene.floor.static_ratio
    under = [
        None if puck.path or sums_law(scene.alone(puck), top, runs) else load_under(puck)
        for puck in pucks
    ]
    tables = {load: law_table(scene, law, top, load) for load in under if load is not None}
    for puck, load in zip(pucks, under, strict=True):
        if puck.shape is None and load is not None:
            tables[load].refuse_height(static * max(factor, 1.0) * 2.0 * puck.height / puck.radius)
    compiled = {load: table.compiled for load, table in tables.items()}
    own = [None if load is None else compiled[load] for load in under]
    return _of_one_law(scene, pucks, normals * largest, delta, own, top)


def _of_one_law(
    scene: SceneSpec, pucks: list[ScenePuck], loads: FloatArray, delta: FloatArray,
    tables: list[FloatArray | None], top: float,
) -> Regions:  # fmt: skip
    """By one law everywhere: by a table of each puck, or summed where it has none.

    ``loads``: f N at most; ``top``: up to which slip the law is looked at, m/s.
    """
    summed = np.array([
        own is None and not puck.path for own, puck in zip(tables, pucks, strict=True)
    ])  # fmt: skip
    hangs = np.array([_may_hang(scene, puck) for puck in pucks])
    floor_map = NO_FLOOR_MAP
    if (summed | hangs).any():
        floor_map = _grounds(scene, pucks, summed | hangs, top)
    each = {id(own): own for own in tables if own is not None}
    ends = np.cumsum([0, *map(len, each.values())])
    spans = dict(zip(each, pairwise(ends.tolist()), strict=True))
    laws = np.array([(0, 0) if own is None else spans[id(own)] for own in tables])
    by_slip = BySpeed(np.concatenate(list(each.values()) or [np.array([1.0, top])]), 0.0, 1.0, 1.0)
    several = np.ones(len(delta) - len(pucks), np.bool_)
    return Regions(
        np.resize(loads, len(delta)), delta, np.empty((len(delta), *NO_SECTION.shape)), by_slip,
        np.concatenate([summed, several]), floor_map, laws,
    )  # fmt: skip


def slip_of_rim(radius: float, surface: Surface, state: list[float]) -> float:
    """The fastest slip of a rim over the floor in a state (6,), m/s."""
    sx, sy, turning = floor_velocity(surface, state[X], state[Y])
    return math.hypot(state[VX] - sx, state[VY] - sy) + radius * abs(state[SPIN] - turning)


def velocities_under(engine: Engine, states: FloatArray) -> FloatArray:
    """Velocities and spins (n, 3) of the floor that discs in states (n, 6) are on."""
    belts: Any = floor_of(engine.surface, engine.discs.T)  # the same for arrays
    places: Any = states[:, X], states[:, Y]
    under = np.empty((len(states), 3))
    under[:, 0], under[:, 1], under[:, 2] = floor_velocity(belts, *places)
    return under


def fastest_rim(pucks: list[ScenePuck], states: FloatArray, surface: Surface) -> float:
    """The fastest in states (n, 6) and in launches to come, of all that slide, m/s."""
    most = 0.0
    for puck, state in zip(pucks, states.tolist(), strict=True):
        launch, launches = puck.launch, [state]
        if launch.time > 0.0:
            velocity = launch.velocity or (0.0, 0.0)
            launches.append([*state[: Y + 1], 0.0, *velocity, launch.spin])
        for start in () if puck.path else launches:
            most = max(most, slip_of_rim(puck.radius, surface, start))
    return most

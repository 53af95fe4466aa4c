"""Dry friction of every region of a scene's floor, for its puck, as the compiled loop reads it."""

from __future__ import annotations

import math

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables._core.real import rounded_up
from puck_tables.errors import AccuracyError
from puck_tables.kernels.section_spline import HEADER, RATIOS
from puck_tables.motion.body import body_of, is_plain
from puck_tables.motion.friction_source import closed_form_friction, table_friction
from puck_tables.scene.by_speed import NO_LAW, friction_by_speed, law_error
from puck_tables.scene.ground import NO_GROUND
from puck_tables.scene.ingredients import BySpeed, Regions
from puck_tables.scene.parts import Orthotropic
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.scene.zones import ground_of, zones_of
from puck_tables.table.friction_section import FINEST_ACCURACY
from puck_tables.table.resultant_table import ResultantTable

EXACT_BELOW = 1e-9  # friction by closed forms where a table's error would show
CLOSED_FORM_ERROR, TABLE_ERROR = 1e-14, 2e-11
SLICE_SHARE = 0.1  # of the error wanted


def regions_of(scene: SceneSpec, reach: float = 1.0) -> Regions:
    """Friction ratios in every region at the height that it has, or by slip speed.

    ``reach``: see :func:`puck_tables.scene.by_speed.friction_by_speed`.

    Raises
    ------
    InputError, ContactError
        If pressure law, gyration or height are out of range, or the friction law cannot be read.
    AccuracyError
        If the friction of the puck cannot be tabulated as fine as the scene asks.
    """
    puck, floor = scene.puck, scene.floor
    normal = puck.mass * puck.gravity * math.cos(floor.slope)
    if floor.law:
        by_speed, load = friction_by_speed(scene, normal, reach)
        return alone(load, np.zeros(1), closed_form_friction(0.0).coefficients[None, :], by_speed)
    if floor.orthotropic is not None:
        axes = axes_of(floor.orthotropic)
        load = np.array([normal * axes[:2].max()])
        by_direction = BySpeed(axes, 2.0 * puck.height / puck.radius, normal, 1.0)
        return alone(
            load, np.zeros(1), closed_form_friction(0.0).coefficients[None, :], by_direction
        )
    heights = scene.heights
    load = normal * np.array(scene.frictions)
    if all(is_plain(puck.pressure, puck.gyration, delta) for delta in heights):
        cuts = np.stack([plain_cut(scene.tol, delta) for delta in heights])
        return _under_zones(scene, normal, load, np.array(heights), cuts)
    accuracy = friction_error(scene)
    # how the mass is spread stands in the equations of the scene, not in its friction
    bodies = [body_of(puck.pressure, delta, puck.gyration) for delta in heights]
    try:
        slices = [body.friction(accuracy).coefficients for body in bodies]
    except AccuracyError as error:
        if error.reachable is None:
            raise
        raise AccuracyError(
            f"tol = {scene.tol:g} is out of reach under the pressure law {puck.pressure}: give "
            f"a tol (or --tol) of {rounded_up(error.reachable / SLICE_SHARE):g} or more"
        ) from None
    return _under_zones(scene, normal, load, np.array(heights), of_one_shape(slices))


def axes_of(two: Orthotropic) -> FloatArray:
    """Friction by direction as :func:`puck_tables.scene.orthotropic.ellipse_in` reads it."""
    return np.array([*two.friction, math.cos(two.direction), math.sin(two.direction)])


def alone(load: FloatArray, delta: FloatArray, cuts: FloatArray, by_speed: BySpeed) -> Regions:
    """Regions of which a base never lies on two at once."""
    return Regions(load, delta, cuts, by_speed, np.zeros(len(load), np.bool_), NO_GROUND)


def _under_zones(
    scene: SceneSpec, normal: float, load: FloatArray, delta: FloatArray, cuts: FloatArray
) -> Regions:
    """Friction in every zone, on every patch, and astride a patch, of that on strips and patches.

    Astride, load and δ are the largest that may be under the base.
    """
    zones, patches = zones_of(scene), len(scene.floor.patches)
    strips = len(load) - patches
    spans = [(one, two) for one, two in zip(zones.first, zones.last, strict=True)]
    spans += [(strips + k, strips + k) for k in range(patches)]
    if patches:
        spans.append((0, strips + patches - 1))
    return Regions(
        np.array([load[one : two + 1].max() for one, two in spans]),
        np.array([delta[one : two + 1].max() for one, two in spans]),
        cuts[[one for one, _ in spans]], NO_LAW,
        np.array([one != two for one, two in spans]), ground_of(scene, normal),
    )  # fmt: skip


def friction_error(scene: SceneSpec) -> float:
    """How wrong the friction ratios of :func:`regions_of` may be."""
    puck = scene.puck
    if scene.floor.law:
        return law_error(scene)
    if scene.floor.orthotropic is not None:
        return CLOSED_FORM_ERROR
    if all(is_plain(puck.pressure, puck.gyration, delta) for delta in scene.heights):
        return CLOSED_FORM_ERROR if scene.tol < EXACT_BELOW else TABLE_ERROR
    return max(SLICE_SHARE * scene.tol, FINEST_ACCURACY)


def plain_cut(tol: float, delta: float) -> FloatArray:
    """The friction ratios of a plain puck, good enough for an error wanted; empty: closed forms.

    From the table, which takes a tenth of the time, unless its errors would show.
    """
    if tol < EXACT_BELOW:
        return closed_form_friction(delta).coefficients
    return table_friction(delta, ResultantTable.shipped()).coefficients


def of_one_shape(slices: list[FloatArray]) -> FloatArray:
    """Slices (sides, columns) in one array: cells halved, last sides repeated; the same splines."""
    columns = max(part.shape[1] for part in slices)
    sides = max(part.shape[0] for part in slices)
    filled = []
    for part in slices:
        while part.shape[1] < columns:
            part = _halved(part)
        filled.append(np.concatenate([part, np.repeat(part[-1:], sides - len(part), axis=0)]))
    return np.stack(filled)


def _halved(part: FloatArray) -> FloatArray:
    """The same uniform cubic splines on cells of half the width, by knot insertion."""
    weights = part[:, HEADER:].reshape(len(part), -1, RATIOS)
    cells = weights.shape[1] - 3
    finer = np.empty((len(part), 2 * cells + 3, RATIOS))
    finer[:, 0::2] = 0.5 * (weights[:, :-1] + weights[:, 1:])
    finer[:, 1::2] = 0.125 * (weights[:, :-2] + 6.0 * weights[:, 1:-1] + weights[:, 2:])
    return np.concatenate([part[:, :HEADER], finer.reshape(len(part), -1)], axis=1)

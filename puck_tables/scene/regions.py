"""Friction ratios at one height, as good as a scene asks, and how wrong they may be."""

from __future__ import annotations

import math

import numpy as np

from puck_tables._core.arrays import FloatArray, rounded_up
from puck_tables.contact.laws import HOMOGENEOUS
from puck_tables.errors import AccuracyError
from puck_tables.kernels.quadratic import HEADER, RATIOS
from puck_tables.motion.body import body_of, is_plain
from puck_tables.motion.friction_source import closed_form_friction, table_friction
from puck_tables.motion.puck_spec import PuckSpec
from puck_tables.scene.by_speed import UNDER_LAW_ERROR, law_accuracy, law_top, laws_in, load_under
from puck_tables.scene.floor_parts import directions_in, has_laws_by_place
from puck_tables.scene.map_of_floor import follows_contour, sums_law
from puck_tables.scene.parts import Orthotropic
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.table.friction_section import FINEST_ACCURACY
from puck_tables.table.resultant_table import ResultantTable

EXACT_BELOW = 1e-9  # friction by closed forms where a table's error would show
# of friction over f N: by closed forms, by tables, and by direction
CLOSED_FORM_ERROR, TABLE_ERROR, DIRECTION_ERROR = 1e-14, 2e-11, 1e-12
SLICE_SHARE = 0.1  # of the error wanted


def section_of(puck: PuckSpec, delta: float, tol: float) -> FloatArray:
    """The friction ratios of a puck of any kind at a height, good enough for an error wanted.

    Raises AccuracyError if they cannot be tabulated as fine as that.
    """
    accuracy = max(SLICE_SHARE * tol, FINEST_ACCURACY)
    try:  # how the mass is spread stands in the equations, not in the friction
        return body_of(puck.pressure, delta, puck.gyration).friction(accuracy).coefficients
    except AccuracyError as error:
        if error.reachable is None:
            raise
        raise AccuracyError(
            f"tol = {tol:g} is out of reach under the pressure law {puck.pressure}: give "
            f"a tol (or --tol) of {rounded_up(error.reachable / SLICE_SHARE):g} or more"
        ) from None


def axes_of(two: Orthotropic) -> FloatArray:
    """Friction by direction as :func:`puck_tables.scene.orthotropic.ellipse_in` reads it."""
    return np.array([*two.friction, math.cos(two.direction), math.sin(two.direction)])


def friction_error(scene: SceneSpec) -> float:
    """How wrong the friction ratios under the puck of a scene may be."""
    puck = scene.puck
    if laws_in(scene):
        top, by_place = law_top(scene, 0.0), has_laws_by_place(scene.floor)
        load = None if by_place or sums_law(scene, top) else load_under(puck)
        return UNDER_LAW_ERROR if load is None else law_accuracy(scene.tol, load)
    if directions_in(scene.floor):
        return DIRECTION_ERROR
    if follows_contour(scene):
        return CLOSED_FORM_ERROR
    if all(rubs_plainly(puck, delta) for delta in scene.heights):
        return CLOSED_FORM_ERROR if scene.tol < EXACT_BELOW else TABLE_ERROR
    return max(SLICE_SHARE * scene.tol, FINEST_ACCURACY)


def rubs_plainly(puck: PuckSpec, delta: float) -> bool:
    """Whether the friction of a puck is that of a plain one, however its mass is spread.

    >>> from puck_tables import Puck
    >>> rubs_plainly(Puck(0.1, gyration=1.0), 0.0), rubs_plainly(Puck(0.1, pressure="ring"), 0.0)
    (True, False)
    """
    return is_plain(puck.pressure, HOMOGENEOUS, delta)


def load_limit(tol: float, delta: float) -> FloatArray:
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
    """Uniform cubic splines, unchanged, on cells of half the width, by knot insertion."""
    weights = part[:, HEADER:].reshape(len(part), -1, RATIOS)
    cells = weights.shape[1] - 3
    finer = np.empty((len(part), 2 * cells + 3, RATIOS))
    finer[:, 0::2] = 0.5 * (weights[:, :-1] + weights[:, 1:])
    finer[:, 1::2] = 0.125 * (weights[:, :-2] + 6.0 * weights[:, 1:-1] + weights[:, 2:])
    return np.concatenate([part[:, :HEADER], finer.reshape(len(part), -1)], axis=1)

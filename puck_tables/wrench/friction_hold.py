"""Whether friction holds a puck at rest under a force and a torque.

The answer is that of scenes (:mod:`puck_tables.scene.rest`): the wrench is held if it is not larger
than the one of its kind, F : T, on the curve of what friction has in some slip.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables._core.real import broadcast, finite_array, velocity_array
from puck_tables.errors import InputError
from puck_tables.kernels.compile import allocating, patience
from puck_tables.motion.body import is_plain
from puck_tables.scene.by_speed import NO_LAW
from puck_tables.scene.ingredients import Dry
from puck_tables.scene.regions import plain_cut, section_of
from puck_tables.scene.rest import SLACK, demand

if TYPE_CHECKING:
    from puck_tables.motion.puck_spec import PuckSpec

_TOL = 1e-9  # of the friction


@dataclass(frozen=True, eq=False)
class Hold:
    """What friction does with a force and a torque on a puck at rest; arrays of one shape.

    ``held``: whether it takes them up; ``margin``: by what they could be multiplied until it slips,
    inf where nothing acts.
    """

    held: npt.NDArray[np.bool_]
    margin: FloatArray

    def __bool__(self) -> bool:
        return bool(self.held)


def holds(puck: PuckSpec, force: npt.ArrayLike, torque: npt.ArrayLike) -> Hold:
    """Whether friction holds a puck, as :meth:`puck_tables.Puck.holds` has it."""
    if puck.friction == 0.0:
        raise InputError("a puck with friction = 0 holds nothing: give friction > 0")
    forces = _forces(force)
    turning = finite_array("torque", torque, "N m")
    fx, fy, moment = broadcast(force_x=forces[..., 0], force_y=forces[..., 1], torque=turning)
    rows = np.stack([one.ravel() for one in (fx, fy, moment)])
    plain = is_plain(puck.pressure, puck.gyration, puck.delta)
    section = plain_cut(_TOL, puck.delta) if plain else section_of(puck, puck.delta, _TOL)
    coefficients = Dry(puck.friction * puck.mass * puck.gravity, puck.delta, section, NO_LAW)
    # wrenches over their largest number, then over their largest force: no square, and no force of
    # a torque over the radius, leaves floating point
    largest = np.abs(rows).max(axis=0)
    acts = largest > 0.0
    largest = np.where(acts, largest, 1.0)
    rows = rows / largest
    unit = np.maximum(np.abs(rows[:2]).max(axis=0), np.abs(rows[2]) / puck.radius)
    unit = np.where(acts, unit, 1.0)
    share, heat = np.empty(unit.size), np.empty(unit.size)
    _fill(coefficients, puck.radius, coefficients.load * rows / unit, share, heat)
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        margin = np.where(acts, coefficients.load / unit / share / largest, np.inf)
        held = (1.0 / margin - 1.0) * heat <= SLACK * coefficients.load
    return Hold(held.reshape(fx.shape), margin.reshape(fx.shape))


def _forces(force: npt.ArrayLike) -> FloatArray:
    try:
        return velocity_array(force)
    except InputError as error:
        text = str(error).replace("velocity", "force").replace("m/s", "N")
        raise InputError(text.replace("(vx, vy)", "(fx, fy)")) from None


@allocating
def _fill(
    coefficients: Dry, radius: float, rows: FloatArray, share: FloatArray, heat: FloatArray
) -> None:
    """The shares of wrenches (3, n), and the power of friction in their slip."""
    for n in range(rows.shape[1]):
        patience(1)
        share[n], heat[n], _, _, _ = demand(
            coefficients, radius, rows[0, n], rows[1, n], rows[2, n], False
        )

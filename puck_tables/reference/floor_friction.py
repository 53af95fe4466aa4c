"""Force and torque of a case on the floor over the ratio ε = v/(rω) of the papers."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray, real_array
from puck_tables.errors import InputError
from puck_tables.io.columns import Dataset, variable
from puck_tables.motion.puck_spec import PuckSpec
from puck_tables.reference.cases import ReferenceCase, case_named
from puck_tables.reference.floor_reaction import is_one_friction, wrench
from puck_tables.result import Result
from puck_tables.world.agreement import pucks_of

USUAL = np.geomspace(0.01, 100.0, 81)
BOUND = 1e-11  # of a share: what the file promises
COLUMNS = (
    "slip_ratio", "slip_angle", "share_along", "share_across", "share_torque", "force_along",
    "force_across", "floor_torque",
)  # fmt: skip


@dataclass(frozen=True, eq=False, repr=False)
class FloorFriction(Result):
    """What a puck does to the floor at any ratio of sliding to spinning.

    ``epsilon`` (n,): v/(r|ω|); ``slip_ratio`` = r|ω|/v; ``slip_angle`` φ rad; ``force_along`` the
    slip and ``force_across``, to its left, N; ``floor_torque`` N m, in the sense of the spin; the
    same as ``share_along``, ``share_across`` of fN and ``share_torque`` of fNr.  Spin is taken as
    counter-clockwise: with the other sense the force across and the torque change sign.
    """

    case: ReferenceCase
    puck: PuckSpec
    slope: float
    epsilon: FloatArray
    slip_ratio: FloatArray
    slip_angle: FloatArray
    force_along: FloatArray
    force_across: FloatArray
    floor_torque: FloatArray

    picture: ClassVar[str] = "reference_friction"

    @property
    def load(self) -> float:
        """The Coulomb force fN, N."""
        puck = self.puck
        return puck.friction * puck.mass * puck.gravity * math.cos(self.slope)

    @property
    def share_along(self) -> FloatArray:
        """Force along over fN."""
        return self.force_along / self.load

    @property
    def share_across(self) -> FloatArray:
        """Force across over fN."""
        return self.force_across / self.load

    @property
    def share_torque(self) -> FloatArray:
        """Torque over fNr."""
        return self.floor_torque / (self.load * self.puck.radius)

    def __repr__(self) -> str:
        return f"FloorFriction({self.case.label}: {self.epsilon.size} ratios)"

    def explain(self) -> str:
        """How it was computed."""
        law = self.puck.body.law.name
        return f"resultants of the pressure law {law}, delta = {self.puck.delta:.6g}"

    def summary(self) -> dict[str, Any]:
        """The scalars, ready for JSON."""
        return {
            "case": self.case.name, "version": self.case.version, "title": self.case.title,
            "load": self.load, "radius": self.puck.radius, "delta": self.puck.delta,
            "share_bound": BOUND,
        }  # fmt: skip

    def dataset(self) -> Dataset:
        """Forces over ε."""
        dims = ("epsilon",)
        columns = {"case": variable("case", self.case.label, ())}
        columns |= {name: variable(name, getattr(self, name), dims) for name in COLUMNS}
        columns["share_bound"] = variable("share_bound", np.asarray(BOUND), ())
        axes = {"epsilon": variable("epsilon", self.epsilon, dims)}
        return Dataset(axes, columns, self.summary())


def floor_friction(name: str, epsilon: npt.ArrayLike | None = None) -> FloorFriction:
    """Force and torque of the puck of a case on the floor.

    Parameters
    ----------
    name : of the case
    epsilon : array_like (n,), ≥ 0, optional
        Ratios v/(r|ω|); 0 is a pure spin, inf a pure slide.  Left out: 81 from 0.01 to 100.

    Returns
    -------
    FloorFriction
        Shares of fN and fNr are off by at most 1e-11.

    Raises
    ------
    InputError
        If there is no such case, friction differs in it from place to place, or a ratio is
        negative.

    References
    ----------
    Salnikova, Treschev, Gallyamov 2012, section 6; the torque over ε for a flat disc: Farkas,
    Bartels, Unger, Wolf 2003.

    Examples
    --------
    >>> floor_friction("spin", [0.0]).share_torque.round(9).tolist()
    [0.666666667]
    """
    case = case_named(name)
    ratios = np.atleast_1d(real_array("epsilon", USUAL if epsilon is None else epsilon, "1"))
    if ratios.ndim != 1 or ratios.size == 0 or not (ratios >= 0.0).all():
        raise InputError("epsilon must be a list of ratios v/(r w) of 0 or more")
    phi = 0.5 * math.pi - np.arctan(ratios)
    phi[np.isinf(ratios)] = 0.0
    scene = case.scene()
    if not is_one_friction(scene.floor):
        raise InputError(
            f"in case {case.name} friction is not the same everywhere: force and torque follow "
            "from place and direction too, not from v/(r w) alone; take them over time from its "
            "states (floor_fx, floor_fy, floor_torque)"
        )
    puck = pucks_of(scene)[0]
    puck.refuse_base(f"a table of friction over v/(r w) of case {case.name}")
    with np.errstate(divide="ignore"):
        inverse = 1.0 / ratios
    slope = scene.floor.slope
    return FloorFriction(case, puck, slope, ratios, inverse, phi, *wrench(puck, phi, slope))

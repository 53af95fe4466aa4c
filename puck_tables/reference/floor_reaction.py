"""What a puck does to the floor: its slip over it, and the force and the torque that it passes on.

    F_∥ = fN cos φ ρ_∥,   F_⊥ = fN sin φ cos φ ρ_⊥,   M = (fNr/2) sin φ ρ_ω

along the slip, to its left, and about the vertical in the sense of the spin; φ = atan2(rω, v) of
velocity and spin relative to the floor (Salnikova, Treschev, Gallyamov 2012, section 6).  Where
friction differs from place to place, by direction or by speed, or a base is not round, no ratios
say it, and it is that of the scene.  A puck at rest on the floor passes on what other forces ask,
and what it takes to be moved along.

The papers have force and torque of a case over the ratio ε = v/(rω).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray, real_array
from puck_tables.errors import InputError
from puck_tables.io.columns import Dataset, variable
from puck_tables.motion.puck_spec import PuckSpec
from puck_tables.reference.cases import ReferenceCase, case_named
from puck_tables.result import Result
from puck_tables.scene.floor_parts import belts_of
from puck_tables.scene.over_time import drive_of, moves_at
from puck_tables.scene.parts import Floor
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.world.floor_forces import friction_at
from puck_tables.world.named_pucks import pucks_of


class SlipVelocity(NamedTuple):
    """Velocity and spin relative to the floor, arrays: m/s, m/s, rad/s."""

    vx: FloatArray
    vy: FloatArray
    spin: FloatArray

    def sizes(self, radius: float) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Speed v, speed of the rim r|ω|, and Q = hypot(v, rω), m/s.

        >>> one = np.ones(1)
        >>> slip = SlipVelocity(3.0 * one, 0.0 * one, -2.0 * one)
        >>> [size.round(4).item() for size in slip.sizes(2.0)]
        [3.0, 4.0, 5.0]
        """
        speed, rim = np.hypot(self.vx, self.vy), radius * np.abs(self.spin)
        return speed, rim, np.hypot(speed, rim)

    def beyond(self, least: float, radius: float) -> SlipVelocity:
        """Without a velocity, or a spin, of up to ``least``, m/s, which is none.

        >>> one = np.ones(1)
        >>> SlipVelocity(one, one, 1e-13 * one).beyond(1e-12, 1.0).spin.tolist()
        [0.0]
        """
        speed, rim, _ = self.sizes(radius)
        moves, spins = speed > least, rim > least
        return SlipVelocity(self.vx * moves, self.vy * moves, self.spin * spins)


def slip_over(floor: Floor, states: Mapping[str, FloatArray]) -> SlipVelocity:
    """Of states ``time``, ``x``, ``y``, ``vx``, ``vy``, ``spin`` over a floor that may move.

    Where strips move on their own it is the slip over the one under the centre.

    >>> state = {name: np.ones(1) for name in ("time", "x", "y", "vx", "vy", "spin")}
    >>> slip_over(Floor(velocity=(1.0, 0.0), turning=2.0), state)
    SlipVelocity(vx=array([2.]), vy=array([-1.]), spin=array([-1.]))
    """
    bx, by, turning = _velocity_under(floor, states)
    cx, cy = floor.centre
    return SlipVelocity(
        states["vx"] - bx + turning * (states["y"] - cy),
        states["vy"] - by - turning * (states["x"] - cx),
        states["spin"] - turning,
    )


def _velocity_under(floor: Floor, states: Mapping[str, FloatArray]) -> FloatArray:
    """Of the centre of the floor, m/s, or the strip under a puck, and the spin (3, n)."""
    moves, _ = moves_at(floor, states["time"])
    if floor.strips is None or floor.over_time:
        return moves
    east, north = math.cos(floor.strips.direction), math.sin(floor.strips.direction)
    place = east * states["x"] + north * states["y"]
    belts = belts_of(floor)[np.searchsorted(floor.strips.borders, place, "right")]
    return np.stack([belts[:, 0], belts[:, 1], moves[2]])


def ratios(slip: SlipVelocity, radius: float) -> tuple[FloatArray, FloatArray]:
    """ε = v/(r|ω|) of the papers, and r|ω|/v; both NaN at rest, where there is no ratio.

    >>> one = np.ones(1)
    >>> ratios(SlipVelocity(one, 0.0 * one, 2.0 * one), 1.0)
    (array([0.5]), array([2.]))
    """
    speed, rim, _ = slip.sizes(radius)
    with np.errstate(divide="ignore", invalid="ignore"):
        return speed / rim, rim / speed


def wrench(
    puck: PuckSpec, phi: FloatArray, slope: float = 0.0
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Force along the slip and to its left, N, and torque, N m, that a puck passes on.

    ``phi``: array (n,), rad, in [−π/2, π/2]; ``slope``: rad, of the floor.

    >>> from puck_tables import Puck
    >>> _, _, torque = wrench(Puck(0.05, friction=0.2, mass=0.1, gravity=9.81), np.array([np.pi/2]))
    >>> (torque / (0.2 * 0.1 * 9.81 * 0.05)).round(12).tolist()          # 2/3 of f m g r
    [0.666666666667]
    """
    rho = puck.body.law.friction(phi, puck.delta)
    load = puck.friction * puck.mass * puck.gravity * math.cos(slope)
    sine, cosine = np.sin(phi), np.cos(phi)
    return (
        load * cosine * rho.parallel,
        load * sine * cosine * rho.perpendicular,
        0.5 * load * puck.radius * sine * rho.spin,
    )


def is_one_friction(floor: Floor) -> bool:
    """Whether one coefficient holds everywhere, so that φ alone decides.

    >>> from puck_tables import Strips
    >>> is_one_friction(Floor()), is_one_friction(Floor(strips=Strips((0.1,), (0.3, 0.1))))
    (True, False)
    """
    return not (floor.strips or floor.patches or floor.law or floor.orthotropic)


def on_the_floor(
    puck: PuckSpec, scene: SceneSpec, states: Mapping[str, FloatArray], least: float = 0.0
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Force along x and y, N, and torque, N m, of a puck of a scene on the floor, state by state.

    ``least``: a slip Q, m/s, up to which it is at rest.

    >>> from puck_tables import Puck, Scene
    >>> puck = Puck(0.05, friction=0.5, mass=0.1, gravity=10.0)
    >>> moves = {name: np.zeros(2) for name in ("time", "x", "y", "vx", "vy", "spin")}
    >>> moves["vx"][0] = 1.0
    >>> [part.round(12).tolist() for part in on_the_floor(puck, Scene(puck), moves)]
    [[0.5, 0.0], [0.0, 0.0], [0.0, 0.0]]
    """
    floor = scene.floor
    slip = slip_over(floor, states)
    slides = slip.sizes(puck.radius)[2] > least
    fx, fy, torque = _passed_on(puck, scene, states)
    if is_one_friction(floor) and puck.shape is None:
        wrench = _by_ratios(puck, slip, floor.slope)
    else:
        angle = states.get("orientation", np.zeros_like(states["x"]))
        place = [states["x"], states["y"], angle]
        on_puck = friction_at(scene, np.stack([*place, *slip], axis=-1))
        wrench = -on_puck[:, 0], -on_puck[:, 1], -on_puck[:, 2]
    return (
        np.where(slides, wrench[0], fx),
        np.where(slides, wrench[1], fy),
        np.where(slides, wrench[2], torque),
    )


def _passed_on(
    puck: PuckSpec, scene: SceneSpec, states: Mapping[str, FloatArray]
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Force along x and y and torque of a puck at rest on the floor, which moves it along."""
    floor, force = scene.floor, scene.force
    moves, (ax, ay, turn) = moves_at(floor, states["time"])
    dx, dy = states["x"] - floor.centre[0], states["y"] - floor.centre[1]
    ax = ax - turn * dy - moves[2] ** 2 * dx - moves[2] * moves[1]
    ay = ay + turn * dx - moves[2] ** 2 * dy + moves[2] * moves[0]
    down = puck.gravity * math.sin(floor.slope)
    wrench = np.array([*force.constant, force.torque])[:, None]
    if force.over_time:
        rows = drive_of(force.over_time)
        wrench = wrench + np.stack(
            [np.interp(states["time"], rows[:, 0], one, 0.0, 0.0) for one in rows[:, 1:].T]
        )
    return (
        wrench[0] + puck.mass * (down * math.cos(floor.downhill) - ax),
        wrench[1] + puck.mass * (down * math.sin(floor.downhill) - ay),
        wrench[2] - puck.mass * puck.inertia_radius**2 * turn,
    )


def _by_ratios(
    puck: PuckSpec, slip: SlipVelocity, slope: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Force along x and y and torque of a puck that slips on one friction."""
    speed, rim, _ = slip.sizes(puck.radius)
    phi = np.arctan2(rim, speed) * np.where(slip.spin < 0.0, -1.0, 1.0)
    along, across, turn = wrench(puck, phi, slope)
    with np.errstate(divide="ignore", invalid="ignore"):
        ahead = np.where(speed > 0.0, np.stack([slip.vx, slip.vy]) / speed, 0.0)
    return along * ahead[0] - across * ahead[1], along * ahead[1] + across * ahead[0], turn


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

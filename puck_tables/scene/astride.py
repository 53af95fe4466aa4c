"""Dry friction on a base that lies on several frictions at once, each felt under its own part.

With e the direction of the slip, f its coefficient at a place and lengths in radii, the force is
−∫ f σ e dA.  The base stays loaded everywhere, σ = (N/A) (1 + b·x), and the balance of moments of a
puck of height h with the mean square ⟨x²⟩ of its pressure,

    ⟨x²⟩ N b = (h/2r) ∫ f σ e dA ,

is linear in b.  Nothing is symmetric here, so that its two components go together:

    (1 − κ S) b = κ s ,   s = (N/A) ∫ f e dA ,   S_jk = (N/A) ∫ f e_j x_k dA ,   κ = h/(2r ⟨x²⟩ N) .

|b| is at most κ f N for the largest f, which is δ/(4⟨x²⟩): where no strip or patch would lift the
base, none does astride.  Of other than uniform pressure 1/A becomes W/π, and the sums are those of
:mod:`puck_tables.scene.astride_pressure`.  They are of the whole base with the coefficient under
its centre, and of every part with what its own differs by.
"""

from __future__ import annotations

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.base_sums import ANY, Sums
from puck_tables.kernels.compile import inlined, inner
from puck_tables.scene.astride_parts import slip_of
from puck_tables.scene.astride_pressure import sums_under
from puck_tables.scene.base_on_floor import friction_held, friction_of_base
from puck_tables.scene.belts import friction_on_belts
from puck_tables.scene.ground import BELTS, LEVER, OVER_X, OVER_Y, PRESSURE, sum_over


@inlined
def tilted(sums: Sums, bx: float, by: float) -> tuple[float, float, float]:
    """∫ f σ e dA and its moment, of the pressure with the slopes (bx, by)."""
    return (
        sums[0] + bx * sums[2] + by * sums[3],
        sums[1] + bx * sums[4] + by * sums[5],
        sums[4] - sums[3] + bx * sums[6] + by * sums[7],
    )


@inner
def astride_friction(
    ground: FloatArray, radius: float, ux: float, uy: float, w: float,
    slip: float, moving: float,
) -> tuple[float, float, float, float]:  # fmt: skip
    """Force, torque and the power they take, at velocities relative to the floor; Q = ``slip``.

    ``moving`` 0: with the friction at slip zero, where it depends on the slip.
    """
    if ground[BELTS] != 0.0:
        return friction_on_belts(ground, radius, ux, uy, w, moving)
    if ground[PRESSURE] == ANY:
        return friction_of_base(ground, ux, uy, w, moving)
    to_unit = 1.0 / slip
    way = slip_of(to_unit * ux, to_unit * uy, to_unit * radius * w)
    mirrored = -1.0 if w < 0.0 else 1.0
    sums = sums_under(ground, radius, way, mirrored)
    lever = ground[LEVER]
    bx, by = 0.0, 0.0
    if lever > 0.0:
        xx, xy = 1.0 - lever * sums[2], -lever * sums[3]
        yx, yy = -lever * sums[4], 1.0 - lever * sums[5]
        turn = lever / (xx * yy - xy * yx)
        bx, by = turn * (yy * sums[0] - xy * sums[1]), turn * (xx * sums[1] - yx * sums[0])
    along, across, torque = tilted(sums, bx, by)
    power = slip * (way.along * along + way.turning * torque)
    across *= mirrored
    return (
        -along * way.cosine + across * way.sine,
        -along * way.sine - across * way.cosine,
        -mirrored * radius * torque,
        power,
    )


@inner
def held_friction(
    ground: FloatArray, radius: float, nx: float, ny: float, rim: float,
    bx: float, by: float,
) -> tuple[float, float, float]:  # fmt: skip
    """∫ f σ e dA and its moment over r at a slip of Q = 1, of a pressure with slopes (bx, by).

    Under a base of any shape these are the place of the load, m.  Of belts the one is summed that
    states are relative to.
    """
    if ground[BELTS] == 0.0:
        return _held(ground, radius, nx, ny, rim, bx, by)
    sum_over(ground, ground[OVER_X], ground[OVER_Y], False)
    held = _held(ground, radius, nx, ny, rim, bx, by)
    sum_over(ground, 0.0, 0.0, True)
    return held


@inner
def _held(
    ground: FloatArray, radius: float, nx: float, ny: float, rim: float,
    bx: float, by: float,
) -> tuple[float, float, float]:  # fmt: skip
    """The same of all that is summed."""
    if ground[PRESSURE] == ANY:
        fx, fy, turning = friction_held(ground, nx, ny, rim / radius, bx, by)
        return fx, fy, turning / radius
    way = slip_of(nx, ny, rim)
    mirrored = -1.0 if rim < 0.0 else 1.0
    sums = sums_under(ground, radius, way, mirrored)
    ahead = bx * way.cosine + by * way.sine
    aside = mirrored * (by * way.cosine - bx * way.sine)
    along, across, torque = tilted(sums, ahead, aside)
    across *= mirrored
    return (
        along * way.cosine - across * way.sine,
        along * way.sine + across * way.cosine,
        mirrored * torque,
    )

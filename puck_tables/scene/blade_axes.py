"""The velocity of a blade by its own axes, along it and to its left: a spin turns nothing there.

With e along the blade, n to its left and u = p e + q n over the floor,

    u′ = (p′ − θ′ q) e + (q′ + θ′ p) n .

In the axes of the laboratory u turns with the body, and steps would follow every turn of it; p and
q know nothing of that.  Within a step velocities of a blade are p, q; all else has u.
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined
from puck_tables.scene.equations import rates
from puck_tables.scene.friction import THETA, VX, VY
from puck_tables.scene.ingredients import BLADE, SLIDES, Phase


@inlined
def has_axes(phase: Phase) -> bool:
    """Whether a step has velocities by the blade's axes."""
    return phase.model.hold.kind == BLADE and phase.mode == SLIDES


@inlined
def _turned(x: float, y: float, angle: float) -> tuple[float, float]:
    cosine, sine = math.cos(angle), math.sin(angle)
    return cosine * x - sine * y, sine * x + cosine * y


@inlined
def by_blade(phase: Phase, y: FloatArray) -> None:
    """A state with u into one with p, q."""
    y[VX], y[VY] = _turned(y[VX], y[VY], -(y[THETA] + phase.model.hold.angle))


@inlined
def by_floor(phase: Phase, y: FloatArray) -> None:
    """A state with p, q into one with u."""
    y[VX], y[VY] = _turned(y[VX], y[VY], y[THETA] + phase.model.hold.angle)


@inlined
def rates_by_blade(phase: Phase, y: FloatArray, out: FloatArray, row: int) -> None:
    """Rates of u in out[row] into those of p, q, at a state ``y`` with p, q."""
    angle, turns = y[THETA] + phase.model.hold.angle, out[row, THETA]
    along, across = _turned(out[row, VX], out[row, VY], -angle)
    out[row, VX], out[row, VY] = along + turns * y[VY], across - turns * y[VX]


@inlined
def rates_in_step(phase: Phase, t: float, y: FloatArray, out: FloatArray, row: int) -> None:
    """:func:`puck_tables.scene.equations.rates` of a state within a step."""
    if not has_axes(phase):
        rates(phase, t, y, out, row)
        return
    along, across = y[VX], y[VY]
    by_floor(phase, y)
    rates(phase, t, y, out, row)
    y[VX], y[VY] = along, across
    rates_by_blade(phase, y, out, row)

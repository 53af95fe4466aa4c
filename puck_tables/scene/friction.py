"""Dry friction on a puck that slips in a given direction, and what walls take of a force.

With u, w the velocity and spin relative to the floor, Q = hypot(u, r w), sin φ = r w/Q (Salnikova,
Treschev, Gallyamov 2012, sections 4–6, with relative velocities)

    F = −f N (ρ_∥ u + sin φ ρ_⊥ u^⊥)/Q,   M = −½ f N r sin φ ρ_ω,   power −f N Q (cos²φ ρ_∥ +
    ½ sin²φ ρ_ω),

u^⊥ being u turned by +90°.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from puck_tables.kernels.compile import inlined, kernel
from puck_tables.motion.equations import ratios_at
from puck_tables.scene.ingredients import Dry

FloatArray = npt.NDArray[np.float64]

X, Y, THETA, VX, VY, SPIN = range(6)  # of a state


@inlined
def size(a: float, b: float, c: float) -> float:
    """√(a² + b² + c²); the scales of a scene keep the squares in range."""
    return math.sqrt(a * a + b * b + c * c)


@kernel
def dry_friction(
    dry: Dry, radius: float, ux: float, uy: float, w: float
) -> tuple[float, float, float, float]:
    """Force, torque and the power they take, at velocities relative to the floor."""
    load, rim = dry.load, radius * abs(w)
    slip = size(ux, uy, rim)
    if load == 0.0 or slip == 0.0:
        return 0.0, 0.0, 0.0, 0.0
    speed = size(ux, uy, 0.0)
    fast = rim > speed
    ratio = speed / rim if fast else rim / speed
    inverse, across, turning = ratios_at(ratio, fast, dry.cut, dry.delta)
    sine = radius * w / slip
    push = -load / (inverse * slip)
    bend = across * sine
    cos2 = (speed / slip) * (speed / slip)
    return (
        push * (ux - bend * uy),
        push * (uy + bend * ux),
        -0.5 * load * radius * sine * turning / inverse,
        load * slip * (cos2 + 0.5 * sine * sine * turning) / inverse,
    )


@inlined
def against_walls(leaning: FloatArray, fx: float, fy: float) -> tuple[float, float]:
    """A force without what the walls that the puck leans on take up; rows of unit normals."""
    for _ in range(1 if leaning.shape[0] < 2 else 40):  # a corner: each wall turns it to the other
        for i in range(leaning.shape[0]):
            push = leaning[i, 0] * fx + leaning[i, 1] * fy
            if push < 0.0:
                fx -= push * leaning[i, 0]
                fy -= push * leaning[i, 1]
    return fx, fy

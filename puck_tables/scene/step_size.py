"""How long a step of a scene may be, and how exact it has to be."""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined
from puck_tables.scene.equations import GIVEN, SIZE, kinetic_energy, slip_change
from puck_tables.scene.ingredients import Body, Phase

_ULP = 4e-16  # of a number: rounding of steps to it


@inlined
def follow_scales(scale: FloatArray, tolerance: float, body: Body, y: FloatArray) -> None:
    """Let the scales follow a motion that leaves them: no step is better than rounding.

    Energies are known to a share of the largest.
    """
    for i in range(GIVEN):
        scale[i] = max(scale[i], _ULP / tolerance * abs(y[i]))
    largest = kinetic_energy(body, y)
    for i in range(GIVEN, SIZE):
        largest = max(largest, abs(y[i]))
    for i in range(GIVEN, SIZE):
        scale[i] = max(scale[i], largest)


@inlined
def up_to_the_stop(
    phase: Phase, h: float, q: float, least: float, pull: float, reach: float, y: FloatArray,
    work: FloatArray,
) -> float:  # fmt: skip
    """The length of a step, no longer than where a slip q ≥ 0 leads.

    ``pull``: how fast the slip changes.  An implicit step takes at most the share ``reach`` of the
    time in which that is as much as the slip, or ``least``; explicit ones that share of what brakes
    it, or turns it.
    """
    near, radius = max(q, least), phase.model.body.radius
    brakes = -slip_change(radius, y, work) if q > 0.0 else 0.0
    most = pull / reach
    if phase.newton == 0.0 and brakes > 0.0:
        most = max(math.sqrt(max(pull * pull - brakes * brakes, 0.0)), brakes) / reach
    return near / most if h * most > near else h

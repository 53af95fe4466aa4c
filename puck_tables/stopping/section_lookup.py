"""Stops of one kind of puck by look-up, compiled."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, look_up, patience, weighted_rows
from puck_tables.kernels.quadratic import HEADER, basis, section_place
from puck_tables.stopping.lookup import LARGEST, SMALLEST
from puck_tables.stopping.stop_jacobian import OWN

_FUNCTIONS = 6  # outputs of a stop
_LOWEST = 1e-290  # below, a ratio of speeds loses digits: both are raised by a power of two


@inlined
def _place(speed: float, edge: float, section: FloatArray, width: int) -> tuple[int, int, float]:
    """Side, first number and place in the cell of speeds v and r|ω|."""
    larger = max(speed, edge)
    raised = 2.0**200 if larger < _LOWEST else 1.0
    ratio = (raised * min(speed, edge)) / (raised * larger) if larger > 0.0 else 0.0
    side, i, place = section_place(ratio, edge > speed, section, width)
    return side, i, place


@look_up
def fill_section_stops(
    launches: FloatArray, section: FloatArray, longest: float, out: FloatArray
) -> int:
    """Stops of launches (6, n): vx, vy, ω, δ, J, r, into ``out`` (6, n), see solvers.OUTPUTS.

    ``section`` holds the functions of :mod:`puck_tables.stopping.stop_section`; all launches are of
    its puck.  No direction is computed and nothing divided by zero.  Returns of how many
    ``longest`` times Q²/J or Q²/(J r) is too large.
    """
    patience(launches.shape[1])
    flat, too_large = section.reshape(-1), 0
    for n in range(launches.shape[1]):
        patience(1)
        vx, vy = launches[0, n], launches[1, n]
        decel, radius = launches[4, n], launches[5, n]
        rim = radius * launches[2, n]
        speed2, edge = vx * vx + vy * vy, abs(rim)
        slip2 = speed2 + rim * rim
        if (speed2 > SMALLEST) & (slip2 < LARGEST):
            speed, slip = math.sqrt(speed2), math.sqrt(slip2)
        else:
            speed = math.hypot(vx, vy)
            slip = math.hypot(speed, edge)
        side, i, place = _place(speed, edge, section, _FUNCTIONS)
        time, along, across, length, body, turn = weighted_rows(
            flat, side * section.shape[1] + i, basis(place), _FUNCTIONS
        )
        scale = slip / decel
        straight, left = scale * along, (rim / decel) * across
        out[0, n] = scale * time
        out[1, n] = straight * vx - left * vy
        out[2, n] = straight * vy + left * vx
        out[3, n] = scale * speed * length
        out[4, n] = rim / slip * turn if slip > 0.0 and speed > 0.0 else 0.0
        out[5, n] = scale * (rim / radius) * body
        size = longest * scale * slip
        too_large += 0 if abs(size / radius + size) < math.inf else 1
    return too_large


@look_up
def fill_section_slopes(
    speed: FloatArray, rim: FloatArray, section: FloatArray, good: npt.NDArray[np.bool_],
    out: FloatArray, left: npt.NDArray[np.bool_],
) -> None:  # fmt: skip
    """Natural derivatives (n, 5, 4) of stops at v and r|ω| (n,), not both 0, by splines.

    ``section`` holds the functions of :mod:`puck_tables.stopping.variational`, ``good`` says in
    which cells they are good; ``left`` (n,): which launches are in others, and left out.
    """
    patience(speed.size)
    flat, numbers = section.reshape(-1), out.reshape(-1)
    for n in range(speed.size):
        patience(1)
        side, i, place = _place(speed[n], rim[n], section, OWN)
        # a node is good whatever lies between
        left[n] = place > 0.0 and not good[side, (i - HEADER) // OWN]
        if not left[n]:
            own = weighted_rows(flat, side * section.shape[1] + i, basis(place), OWN)
            for k in range(OWN):
                numbers[OWN * n + k] = own[k]

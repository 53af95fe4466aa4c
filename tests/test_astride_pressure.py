"""Friction under other pressures on several frictions: against circles, and scenes with them."""

from __future__ import annotations

import math

import numpy as np
import pressure_judge
import pytest
from astride_judge import Ground

import puck_tables as pt
from puck_tables.scene.floor_forces import friction_at

CORNERS = np.array([[-0.5, -0.9], [1.4, -0.2], [0.1, 0.1], [0.3, 1.2]])
FLOORS = {
    "strips": (Ground([-0.3, 0.4], [0.3, 0.1, 0.2]),
               pt.Floor(strips=pt.Strips((-0.3, 0.4), (0.3, 0.1, 0.2)))),
    "round": (Ground([], [0.3], [(0.5, -0.4, 0.7, 0.05)]),
              pt.Floor(patches=[pt.Patch(0.05, (0.5, -0.4), 0.7)])),
    "polygon": (Ground([], [0.3], polygons=[(CORNERS, 0.05)]),
                pt.Floor(patches=[pt.Patch(0.05, corners=CORNERS.tolist())])),
}  # fmt: skip
CONE = [(0.2, 1.0), (0.6, 2.0), (1.0, 0.5)]
LAWS = {
    "ring": (None, 0.5, ()),
    "hertz": (lambda _, short: 1.5 * math.sqrt(short * (2.0 - short)), 0.2, ()),
    "galin": (lambda _, short: 0.5 / math.sqrt(short * (2.0 - short)), 1.0 / 3.0, ()),
}
SLIPS = [
    (1.0, 0.4, 0.0), (0.4, 0.9, -0.6), (0.3, -0.2, 0.8), (0.6, 0.8, 0.999), (0.0, 0.0, 1.0),
]  # fmt: skip


def found(pressure: str, floor: pt.Floor, slip: tuple[float, float, float], height: float):
    puck = pt.Puck(1.0, height=height, friction=0.3, gravity=1.0, pressure=pressure)
    state = np.array([[0.0, 0.0, 0.0, *slip]])
    return -friction_at(pt.Scene(puck, floor), state)[0]


@pytest.mark.parametrize("floor", FLOORS)
@pytest.mark.parametrize("pressure", LAWS)
def test_resultants_against_circles(pressure, floor):
    law, square, bends = LAWS[pressure]
    ground, surface = FLOORS[floor]
    for slip in SLIPS if pressure == "ring" else SLIPS[1:4]:
        truth = pressure_judge.friction(ground, slip, law, 0.5 * 0.8, square, bends)
        assert np.abs(found(pressure, surface, slip, 0.8) - truth).max() <= 1e-10, slip

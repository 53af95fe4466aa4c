"""Dry friction of any floor on a puck, state by state: what is integrated, to be read."""

from __future__ import annotations

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import kernel, patience
from puck_tables.scene.floor_map import OVER_X, OVER_Y
from puck_tables.scene.floor_parts import has_belts
from puck_tables.scene.friction import SPIN, VX, VY, friction_force
from puck_tables.scene.over_time import rows_passed
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.world.engine_state import Engine
from puck_tables.world.floor_under import friction_now
from puck_tables.world.layout import RADIUS, REGION
from puck_tables.world.prepare import prepared


@kernel
def _forces(engine: Engine, states: FloatArray, out: FloatArray) -> None:
    """Force and torque on the puck into out (n, 3) at states (n, 6) over the floor."""
    patience(states.shape[0])
    radius = engine.discs[0, RADIUS]
    passed = rows_passed(engine.forcing, engine.spans[0, 0], engine.spans[0, 1], 0.0)
    for n in range(states.shape[0]):
        patience(1)
        y = states[n]
        friction = friction_now(engine, 0, passed, 0.0, y)
        fx, fy, torque, _ = friction_force(friction, radius, y[VX], y[VY], y[SPIN])
        out[n, 0], out[n, 1], out[n, 2] = fx, fy, torque


def friction_at(scene: SceneSpec, states: FloatArray) -> FloatArray:
    """Force along x and y, N, and torque, N m, of the floor on the one puck of a scene, (n, 3).

    −∫ f σ e dA and its moment, e the direction of the slip; 0 without a slip.  A base over several
    frictions feels each under its own part, wherever it lies; where friction changes over time it
    is that at its start.  ``states``: (n, 6): x, y m, angle rad; velocity m/s and spin rad/s over
    the floor; in the laboratory where strips and patches have velocities of their own.

    >>> from puck_tables import Floor, Puck, Scene, Strips
    >>> halves = Floor(strips=Strips((0.0,), (0.78, 0.67)))
    >>> spins = np.array([[0.0, 0.0, 0.0, 0.0, 0.0, 20.0]])
    >>> force = friction_at(Scene(Puck(1.0, gravity=10.0), halves), spins)
    >>> (force.round(9) + 0.0).tolist()                      # (0.78 - 0.67) g/pi along the border
    [[0.0, 0.350140875, -4.833333333]]
    """
    engine = prepared(scene).engine
    engine.discs[0, REGION] = len(engine.regions.load) - 1  # astride, if it may lie so
    if has_belts(scene.floor):
        engine.regions.floor_map[[OVER_X, OVER_Y]] = 0.0
    out = np.zeros((len(states), 3))
    _forces(engine, states, out)
    return out

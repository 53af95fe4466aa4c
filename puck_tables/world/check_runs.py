"""How far a run is off: other runs from the same start tell, that err by more than it does."""

from __future__ import annotations

import math

import numpy as np

from puck_tables.errors import PuckError
from puck_tables.scene.friction import THETA, VX, X, Y
from puck_tables.scene.ingredients import FREE
from puck_tables.scene.regions import friction_error
from puck_tables.world import engine_state as g
from puck_tables.world.agreement import pucks_of, segment_error
from puck_tables.world.floors import velocities_under
from puck_tables.world.layout import HOLD, LIGHTNESS, NORMAL, TURNABILITY
from puck_tables.world.prepare import Start
from puck_tables.world.world import World

# of check runs: so many times the error of a step, and to which side launches are off
CHECKS = ((30.0, 1.0), (8.0, -1.0))
PROBES = 8  # states of one puck that are compared
LATER = 0.01  # of a run: by so much a check run may end later
# of what look-ups may err by, launches of one puck: places go with the square of the speed
OF_ONE = 0.5


def error_of(world: World, start: Start) -> float:
    """How far check runs are from a run at its end, and of one puck on the way and in time.

    Their steps are coarser; their launches are off by the error of a step, where anything is looked
    up by what that may be wrong by, and friction that is integrated by what its table may.  With
    the rounding of the look-up, for pucks that could slide far.  In units of Q/J and Q²/J.
    """
    pucks = pucks_of(start.scene)
    speed, rate = world._engine.scale[:2].tolist()
    length, now = speed * speed / rate, world.time
    radii, alone = np.array([puck.radius for puck in pucks]), len(pucks) == 1
    probes = now * np.arange(1, PROBES + 1) / PROBES if alone else np.array([now])
    states, stops = world.over(probes), world.motion_ends
    share, off = _launches_off(start, alone), 0.0
    if start.engine.floors[:, 2].any():
        slides = {
            (one.height, one.friction, one.pressure, one.shape is None): one
            for one in pucks
            if not one.path
        }
        off = max(friction_error(start.scene.alone(one)) for one in slides.values())
    gaps = []
    for coarser, sign in CHECKS:
        try:
            check = World.since(_otherwise(start, coarser, sign * share, sign * off))
            check._advance(now)
            gap = check.over(probes) - states
            gaps.append(
                float((np.hypot(gap[..., X], gap[..., Y]) + radii * np.abs(gap[..., THETA])).max())
                / length
            )
            if alone and stops[0] < math.inf:
                check._advance((1.0 + LATER) * now)
                gaps.append(min(abs(check.motion_ends[0] - stops[0]), LATER * now) * rate / speed)
        except PuckError:  # it meets what has no answer: so nearly did the run
            gaps.append(float(np.hypot(*np.ptp(states[-1, :, :2], axis=0))) / length)
    return max(gaps) + world.place_error / length


def _launches_off(start: Start, alone: bool) -> float:
    """By what share launches of check runs are off: of one puck by the error of a step at least."""
    if not alone:
        return segment_error(start.scene)
    looked_up = 0.0 if start.engine.floors[:, 2].all() else OF_ONE * segment_error(start.scene)
    return max(looked_up, float(start.engine.scale[2]))


def _otherwise(start: Start, coarser: float, share: float, friction: float) -> Start:
    """The start of a check run.

    Parameters
    ----------
    coarser : so many times the error of a step
    share : of their velocities and spins launches are off by so much, and in rad their headings
    friction : of what is integrated, off by so much
    """
    engine = g.copy_of(start.engine)
    states, launches = start.states.copy(), engine.launches.copy()
    scale = 1.0 + share
    cosine, sine = scale * math.cos(share), scale * math.sin(share)
    turned = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, scale]])
    launches[:, g.LAUNCH_VX :] = launches[:, g.LAUNCH_VX :] @ turned.T
    free = (engine.discs[:, LIGHTNESS] > 0.0) & (engine.discs[:, HOLD] == FREE)
    floor = velocities_under(engine, states)[free]
    states[free, VX:] = floor + (states[free, VX:] - floor) @ turned.T
    engine.scale[2] *= coarser
    engine.discs[:, NORMAL] *= 1.0 + friction
    # torques err to the other side, and by twice as much: all alike hardly change where rebounds lead
    engine.discs[:, TURNABILITY] *= 1.0 - 3.0 * friction
    regions = engine.regions._replace(load=engine.regions.load * (1.0 + friction))
    return start._replace(engine=engine._replace(launches=launches, regions=regions), states=states)

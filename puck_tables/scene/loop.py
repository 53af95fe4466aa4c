"""From a launch to the end of a scene: an adaptive integrator in time, with events.

Dormand–Prince 5(4).  Next to relative rest, where the direction of friction turns within Q/|Q′|, a
step is at most half of that: the stop is approached by halves, 43 steps to 1e-13 of the scale of
speeds, and then taken as reached.  Every event is found on a real step of the method from the last
step end, by Newton's method within a bracket, and becomes a step end.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables.kernels.compile import inlined, kernel
from puck_tables.motion.steppers import Tableau
from puck_tables.scene.boundaries import (
    BORDER,
    BOUNCES,
    EDGE,
    Boundaries,
    bounced,
    count_walls,
    first_crossing,
    left,
    normals,
)
from puck_tables.scene.equations import (
    ROW,
    SIZE,
    SPIN,
    VX,
    VY,
    X,
    Y,
    kinetic_energy,
    rates,
    relative_velocity,
)
from puck_tables.scene.ingredients import Model, floor_velocity, knots_of
from puck_tables.scene.rest import held_by_floor, seed
from puck_tables.scene.steps import STAGES, step

FloatArray = npt.NDArray[np.float64]

# how a run ends
AT_REST, CARRIED, TIME_UP, OVER_EDGE, STEP_LIMIT, EVENT_LIMIT, NOT_FINITE = range(7)
# what happens on the way
RESTS, SLIPS, LEANS = 0, 1, 3  # and those of boundaries

FRAME_COLUMNS = ROW + 3  # time, state, λ, carried, heat of impacts
EVENT_COLUMNS = 3 + SIZE  # time, what, which, state

_REST = 1e-13  # of the scale of speeds: as good as at rest
_SEED = 1e-12


class Ask(NamedTuple):
    """What is asked of a run.

    ``until``: s; ``to_the_end``: go on to it also when carried; ``tolerance``: local error per step
    in units of ``scale`` (10,); ``speed``: the scale of speeds, m/s; ``step_limit``.
    """

    until: float
    to_the_end: bool
    tolerance: float
    scale: FloatArray
    speed: float
    step_limit: int


@inlined
def _slipping(
    tableau: Tableau,
    t: float,
    h: float,
    inside: float,
    y: FloatArray,
    model: Model,
    region: int,
    leaning: FloatArray,
    scale: FloatArray,
    work: FloatArray,
    new: FloatArray,
    slip: FloatArray,
) -> float:
    """When within a step the floor loses a puck that it carries."""
    low, high = 0.0, h
    while True:
        middle = 0.5 * (low + high)
        if middle <= low or middle >= high:
            return high
        step(tableau, t, middle, inside, y, model, region, leaning, True, scale, work, new)
        if held_by_floor(t + middle, inside, new, model, region, leaning, slip):
            low = middle
        else:
            high = middle


@inlined
def _noted(row: FloatArray, t: float, what: int, which: int, y: FloatArray) -> None:
    row[0], row[1], row[2] = t, what, which
    for i in range(SIZE):
        row[3 + i] = y[i]


@inlined
def _framed(
    row: FloatArray,
    t: float,
    inside: float,
    y: FloatArray,
    model: Model,
    region: int,
    leaning: FloatArray,
    carried: bool,
    heat: float,
) -> None:
    row[0] = t
    rates(t, inside, y, model, region, leaning, carried, row[1 : 1 + ROW])
    for i in range(SIZE):  # the multipliers stay behind the state
        row[1 + i] = y[i]
    row[1 + ROW] = 1.0 if carried else 0.0
    row[2 + ROW] = heat


@kernel
def follow(
    model: Model,
    bounds: Boundaries | None,
    ask: Ask,
    tableau: Tableau,
    y: FloatArray,
    region: int,
    frames: FloatArray,
    rows: FloatArray,
    events: FloatArray,
) -> tuple[int, float, int, int, int, float]:
    """Run a scene from the state ``y`` (10,), which becomes the last one.

    ``frames`` (n,): ascending times for ``rows`` (n + 1, 15), the last of them the end;
    ``events`` (m, 13).

    Returns
    -------
    how it ended, when, number of events, of steps and of frames reached, heat of impacts
    """
    work = np.empty((STAGES + 1, ROW))
    new, trial, slip = np.empty(SIZE), np.empty(SIZE), np.empty(3)
    leans = np.zeros(count_walls(bounds), np.bool_)
    leaning = normals(bounds, leans)
    body, scale = model.body, ask.scale
    knots = knots_of(model.drive)
    t, carried, heat = 0.0, False, 0.0
    count, steps, frame = 0, 0, 0
    how = TIME_UP
    h = 1e-3 * ask.until
    settle = True  # whether what holds the puck has to be looked at
    while True:
        # the piece of time without a knot inside
        target = ask.until
        for knot in knots:
            if t < knot < target:
                target = knot
        if target <= t:
            break
        inside = 0.5 * (t + target)
        if model.dry is not None and settle:
            ux, uy, w = relative_velocity(model, y)
            if math.hypot(math.hypot(ux, uy), body.radius * w) <= _REST * ask.speed:
                was = carried
                y[VX] -= ux
                y[VY] -= uy
                y[SPIN] -= w
                carried = held_by_floor(t, inside, y, model, region, leaning, slip)
                if carried != was:
                    if count == len(events):
                        how = EVENT_LIMIT
                        break
                    _noted(events[count], t, RESTS if carried else SLIPS, region, y)
                    count += 1
                if not carried:
                    seed(y, slip, _SEED * ask.speed)
                else:
                    still = True  # nothing to come: the end
                    for knot in knots:
                        still = still and knot <= t
                    if model.surface is not None:
                        still = still and not ask.to_the_end and bounds is None
                    if still:
                        how = AT_REST if model.surface is None else CARRIED
                        break
                h = max(h, 1e-6 * (target - t))
        settle = False
        rates(t, inside, y, model, region, leaning, carried, work[0])
        if not carried and model.dry is not None:
            ux, uy, w = relative_velocity(model, y)
            _, _, turning = floor_velocity(model.surface, y[X], y[Y])
            slip_speed = math.hypot(math.hypot(ux, uy), body.radius * w)
            pull = math.hypot(  # of the relative velocity
                math.hypot(work[0, VX] + turning * y[VY], work[0, VY] - turning * y[VX]),
                body.radius * work[0, SPIN],
            )
            if h * pull > 0.5 * slip_speed:
                h = 0.5 * slip_speed / pull
        # a step
        landed = t + 1.1 * h >= target
        length = target - t if landed else h
        error = step(
            tableau, t, length, inside, y, model, region, leaning, carried, scale, work, new
        )
        steps += 1
        if steps > ask.step_limit:
            how = STEP_LIMIT
            break
        if not error <= ask.tolerance:
            shrink = 0.2 if not error < math.inf else max(0.2, 0.9 * (ask.tolerance / error) ** 0.2)
            h = length * shrink
            if (t + h == t and t > 0.0) or h < 1e-300:
                how = NOT_FINITE
                break
            continue
        h = length * min(5.0, 5.0 if error == 0.0 else 0.9 * (ask.tolerance / error) ** 0.2)
        happens, which, moment = first_crossing(
            bounds, tableau, t, length, inside, y, model, region, leans, leaning, carried, scale,
            work, new, trial,
        )  # fmt: skip
        if (carried and happens < 0) and not held_by_floor(
            t + length, inside, new, model, region, leaning, slip
        ):
            happens, which = SLIPS, region
            moment = _slipping(
                tableau, t, length, inside, y, model, region, leaning, scale, work, trial, slip
            )
        if happens >= 0:
            landed = False
            length = moment
            step(tableau, t, length, inside, y, model, region, leaning, carried, scale, work, new)
        # the frames on it
        end = target if landed else t + length
        while frame < len(frames) and frames[frame] <= end:
            part = frames[frame] - t
            step(tableau, t, part, inside, y, model, region, leaning, carried, scale, work, trial)
            _framed(
                rows[frame], frames[frame], inside, trial, model, region, leaning, carried, heat
            )
            frame += 1
        t = end
        for i in range(SIZE):
            y[i] = new[i]
        if landed and target < ask.until:
            settle = True
        ux, uy, w = relative_velocity(model, y)
        if not carried and (math.hypot(math.hypot(ux, uy), body.radius * w) <= _REST * ask.speed):
            settle = True
        if left(bounds, y, leans, ask.speed):
            leaning = normals(bounds, leans)
        if happens < 0:
            continue
        settle = True
        if happens == BORDER:
            region = which
        elif happens == BOUNCES:
            carried = False
            before = kinetic_energy(body, y)
            if bounced(bounds, which, body, y, leans, ask.speed):
                happens = LEANS
            leaning = normals(bounds, leans)
            heat += before - kinetic_energy(body, y)
        if count == len(events):
            how = EVENT_LIMIT
            break
        _noted(events[count], t, happens, which, y)
        count += 1
        if happens == SLIPS:
            carried = False
            held_by_floor(t, inside, y, model, region, leaning, slip)
            seed(y, slip, _SEED * ask.speed)
            settle = False
        if happens == EDGE:
            how = OVER_EDGE
            break
    while how == AT_REST and frame < len(frames):  # for ever
        _framed(rows[frame], frames[frame], t, y, model, region, leaning, carried, heat)
        frame += 1
    _framed(rows[frame], t, t, y, model, region, leaning, carried, heat)
    finite = True
    for i in range(SIZE):
        finite = finite and math.isfinite(y[i])
    return (how if finite else NOT_FINITE), t, count, steps, frame, heat

"""From a launch to the end of a scene: an adaptive integrator in time, with events.

Dormand–Prince 5(4).  Next to relative rest, where the direction of friction turns within Q/|Q′|, a
step is at most nine tenths of that: the stop is approached down to 1e-13 of the scale of speeds, in
13 steps or more, and then taken as reached.  Every event is found on a real step of the method from
the last step end, by Newton's method within a bracket, and becomes a step end.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables.kernels.compile import inlined, kernel
from puck_tables.scene.boundaries import (
    BORDER,
    BOUNCES,
    EDGE,
    Boundaries,
    bounced,
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
    slip_rate,
    slip_speed,
)
from puck_tables.scene.ingredients import (
    FREE,
    Dry,
    Model,
    Regions,
    Stretch,
    floor_velocity,
)
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
_NEAR = 0.9  # of the time in which the slip would end, at most, is a step


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
    stretch: Stretch, t: float, h: float, y: FloatArray, scale: FloatArray, work: FloatArray,
    new: FloatArray, slip: FloatArray,
) -> float:  # fmt: skip
    """When within a step the floor loses a puck that it carries."""
    low, high = 0.0, h
    while True:
        middle = 0.5 * (low + high)
        if middle <= low or middle >= high:
            return high
        step(stretch, t, middle, y, scale, work, new)
        if held_by_floor(stretch, t + middle, new, slip):
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
    row: FloatArray, stretch: Stretch, t: float, y: FloatArray, heat: float, work: FloatArray
) -> None:
    rates(stretch, t, y, work, 1)
    row[0] = t
    for i in range(SIZE):
        row[1 + i] = y[i]
    row[1 + SIZE], row[2 + SIZE] = work[1, SIZE], work[1, SIZE + 1]
    row[1 + ROW] = 1.0 if stretch.carried else 0.0
    row[2 + ROW] = heat


@inlined
def _dry(regions: Regions, region: int) -> Dry:
    return Dry(regions.load[region], regions.delta[region], regions.cuts[region])


@kernel
def follow(
    model: Model,
    regions: Regions,
    bounds: Boundaries,
    ask: Ask,
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
    work, last = np.empty((STAGES, ROW)), np.empty(ROW)
    new, trial, slip = np.empty(SIZE), np.empty(SIZE), np.empty(3)
    leans = np.zeros(len(bounds.walls), np.bool_)
    leaning, dry = normals(bounds, leans), _dry(regions, region)
    body, scale, surface, drive = model.body, ask.scale, model.surface, model.drive
    moves = surface.vx != 0.0 or surface.vy != 0.0 or surface.spin != 0.0
    unbounded = len(bounds.walls) + len(bounds.edges) + len(bounds.borders) == 0
    t, heat, carried, piece = 0.0, 0.0, False, 0
    count, steps, frame = 0, 0, 0
    how = TIME_UP
    h = 1e-3 * ask.until
    settle, known = True, False  # whether to look what holds the puck; whether work[0] is there
    while t < ask.until:
        while piece < len(drive) and drive[piece, 0] <= t:
            piece += 1
        target = min(drive[piece, 0], ask.until) if piece < len(drive) else ask.until
        if settle and dry.load > 0.0 and slip_speed(model, y) <= _REST * ask.speed:
            y[VX], y[VY], y[SPIN] = floor_velocity(surface, y[X], y[Y])
            was = carried
            carried = held_by_floor(Stretch(model, dry, leaning, piece, True), t, y, slip)
            if carried != was:
                if count == len(events):
                    how = EVENT_LIMIT
                    break
                _noted(events[count], t, RESTS if carried else SLIPS, region, y)
                count += 1
            if not carried:
                seed(y, slip, _SEED * ask.speed)
            elif piece == len(drive) and (not moves or (unbounded and not ask.to_the_end)):
                how = CARRIED if moves else AT_REST  # nothing is to come
                break
            h = max(h, 1e-6 * (target - t))
        stretch = Stretch(model, dry, leaning, piece, carried)
        if settle or not known:
            rates(stretch, t, y, work, 0)
        settle, known = False, True
        if not carried and dry.load > 0.0:
            near, pull = _NEAR * slip_speed(model, y), slip_rate(model, y, work)
            h = near / pull if h * pull > near else h
        # a step
        landed = t + 1.1 * h >= target
        length = target - t if landed else h
        error = step(stretch, t, length, y, scale, work, new)
        steps += 1
        if steps > ask.step_limit:
            how = STEP_LIMIT
            break
        if not error <= ask.tolerance:
            shrink = 0.1 if not error < math.inf else max(0.1, 0.9 * (ask.tolerance / error) ** 0.2)
            h = length * shrink
            if (t + h == t and t > 0.0) or h < 1e-300:
                how = NOT_FINITE
                break
            continue
        h = length * min(5.0, 5.0 if error == 0.0 else 0.9 * (ask.tolerance / error) ** 0.2)
        last[:] = work[STAGES - 1]
        happens, which, moment = first_crossing(
            bounds, stretch, region, leans, t, length, y, scale, work, new, trial
        )
        if carried and happens < 0 and not held_by_floor(stretch, t + length, new, slip):
            happens, which = SLIPS, region
            moment = _slipping(stretch, t, length, y, scale, work, trial, slip)
        if happens >= 0:
            landed = False
            length = moment
            step(stretch, t, length, y, scale, work, new)
        # the frames on it
        end = target if landed else t + length
        while frame < len(frames) and frames[frame] <= end:
            step(stretch, t, frames[frame] - t, y, scale, work, trial)
            _framed(rows[frame], stretch, frames[frame], trial, heat, work)
            frame += 1
        t = end
        y[:] = new
        work[0] = last
        known = model.hold.kind == FREE and not carried  # else the step ended a little beside it
        if landed and target < ask.until:
            settle = True
        if not carried and slip_speed(model, y) <= _REST * ask.speed:
            settle = True
        if left(bounds, y, leans, ask.speed):
            leaning = normals(bounds, leans)
            known = False
        if happens < 0:
            continue
        settle = True
        if happens == BORDER:
            region = which
            dry = _dry(regions, region)
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
            held_by_floor(stretch, t, y, slip)
            seed(y, slip, _SEED * ask.speed)
            carried, settle, known = False, False, False
        if happens == EDGE:
            how = OVER_EDGE
            break
    stretch = Stretch(model, dry, leaning, piece, carried)
    while how == AT_REST and frame < len(frames):  # for ever
        _framed(rows[frame], stretch, frames[frame], y, heat, work)
        frame += 1
    _framed(rows[frame], stretch, t, y, heat, work)
    finite = True
    for i in range(SIZE):
        finite = finite and math.isfinite(y[i])
    return (how if finite else NOT_FINITE), t, count, steps, frame, heat

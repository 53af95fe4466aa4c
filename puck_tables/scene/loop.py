"""From a launch to the end of a scene: an adaptive integrator in time, with events.

Dormand–Prince 5(4).  Next to relative rest, where the direction of friction turns within Q/|Q′|, a
step is at most half of that.  A puck that is about to rest, or that begins to slip, moves by a law
of its own (see :func:`puck_tables.scene.equations.rates`).  Every event is found on a real step of
the method from the last step end, by Newton's method within a bracket, and becomes a step end.
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
    kinetic_energy,
    rates,
    slip_rate,
    slip_side,
    slip_speed,
    stopping,
)
from puck_tables.scene.friction import SPIN, VX, VY, X, Y
from puck_tables.scene.ingredients import (
    CARRIED,
    FREE,
    NO_WAY,
    SLIDES,
    STARTS,
    STOPS,
    Dry,
    Model,
    Regions,
    Stretch,
    floor_velocity,
)
from puck_tables.scene.rest import SLACK, excess_at_rest, held_by_floor
from puck_tables.scene.steps import STAGES, step

FloatArray = npt.NDArray[np.float64]

# how a run ends
AT_REST, CARRIED_AWAY, TIME_UP, OVER_EDGE, STEP_LIMIT, EVENT_LIMIT, NOT_FINITE = range(7)
# what happens on the way
RESTS, SLIPS, LEANS = 0, 1, 3  # and those of boundaries

FRAME_COLUMNS = ROW + 3  # time, state, λ, carried, heat of impacts
EVENT_COLUMNS = 3 + SIZE  # time, what, which, state

_REST = 1e-13  # of the scale of speeds: as good as at rest
_LAST = 30.0  # times the local error: from there a stop goes straight
_HOP = 1e-15  # of the place: as high as a rebound must be
_NEAR = 0.5  # of the time in which the slip would end, at most, is a step


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
    new: FloatArray,
) -> float:  # fmt: skip
    """When within a step the floor loses a puck that it carries."""
    low, high = 0.0, h
    while True:
        middle = 0.5 * (low + high)
        if middle <= low or middle >= high:
            return high
        step(stretch, t, middle, y, scale, work, new)
        if held_by_floor(stretch, t + middle, new):
            low = middle
        else:
            high = middle


@inlined
def _equal_speeds(
    stretch: Stretch, t: float, h: float, y: FloatArray, scale: FloatArray, work: FloatArray,
    new: FloatArray,
) -> float:  # fmt: skip
    """When within a step φ passes π/4, where friction has one derivative and a bit; ``new`` then.

    By the method of false position, with the weight of an end that stays halved (Illinois).
    """
    low, high = 0.0, h
    first, last = slip_side(stretch.model, y), slip_side(stretch.model, new)
    sign = 1.0 if last > 0.0 else -1.0
    for _ in range(60):
        middle = (low * last - high * first) / (last - first)
        if not low < middle < high or high - low <= 1e-12 * h:
            break
        step(stretch, t, middle, y, scale, work, new)
        value = slip_side(stretch.model, new)
        if sign * value > 0.0:
            high, last, first = middle, value, 0.5 * first
        else:
            low, first, last = middle, value, 0.5 * last
    step(stretch, t, high, y, scale, work, new)
    return high


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
    row[1 + ROW] = 1.0 if stretch.mode == CARRIED else 0.0
    row[2 + ROW] = heat


@inlined
def _dry(regions: Regions, region: int) -> Dry:
    return Dry(regions.load[region], regions.delta[region], regions.cuts[region], regions.by_speed)


@inlined
def _followed(ask: Ask, excess: float) -> float:
    """The slip from which on its direction is followed, for an excess in units of friction.

    Before that the direction is wrong by about the excess.
    """
    return max(0.1 * ask.tolerance / excess, 10.0 * _REST) * ask.speed


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
    new, trial = np.empty(SIZE), np.empty(SIZE)
    leans = np.zeros(len(bounds.walls), np.bool_)
    leaning, dry = normals(bounds, leans), _dry(regions, region)
    body, scale, surface, drive = model.body, ask.scale, model.surface, model.drive
    moves = surface.vx != 0.0 or surface.vy != 0.0 or surface.spin != 0.0
    unbounded = len(bounds.walls) + len(bounds.edges) + len(bounds.borders) == 0
    t, heat, mode, piece, way = 0.0, 0.0, SLIDES, 0, NO_WAY
    count, steps, frame = 0, 0, 0
    wall, hit = -1, 0.0
    # by so much longer than the centre a spin takes to brake
    slow = max(1.0, 2.0 * body.inertia / (body.mass * body.radius * body.radius))
    how = TIME_UP
    h = 1e-3 * ask.until
    settle, known = True, False  # whether to look what holds the puck; whether work[0] is there
    while t < ask.until:
        while piece < len(drive) and drive[piece, 0] <= t:
            piece += 1
        target = min(drive[piece, 0], ask.until) if piece < len(drive) else ask.until
        q = slip_speed(model, y)
        if settle and dry.load > 0.0 and q <= _REST * ask.speed:
            y[VX], y[VY], y[SPIN] = floor_velocity(surface, y[X], y[Y])
            was = mode
            excess = excess_at_rest(Stretch(model, dry, leaning, piece, CARRIED, way), t, y)[0]
            mode = CARRIED if excess <= SLACK * dry.load else STARTS
            if excess == math.inf:  # where a constraint leads it the floor does not go
                mode = SLIDES
            if (mode == CARRIED) != (was == CARRIED):
                if count == len(events):
                    how = EVENT_LIMIT
                    break
                _noted(events[count], t, RESTS if mode == CARRIED else SLIPS, region, y)
                count += 1
            if mode == CARRIED and (
                piece == len(drive) and (not moves or (unbounded and not ask.to_the_end))
            ):
                how = CARRIED_AWAY if moves else AT_REST  # nothing is to come
                break
            h = max(h, 1e-6 * (target - t))
        elif settle:
            mode = SLIDES
        h = -q / way[3] if mode == STOPS else h
        stretch = Stretch(model, dry, leaning, piece, mode, way)
        if settle or not known:
            rates(stretch, t, y, work, 0)
        settle, known = False, True
        if mode == SLIDES and dry.load > 0.0:
            pull = slip_rate(model, y, work)
            near = _NEAR * max(q, _REST * ask.speed)
            h = near / pull if h * pull > near else h
            if 0.0 < q <= _LAST * ask.tolerance * ask.speed / slow:
                way = stopping(model, y, work)
                if way[3] < 0.0 and held_by_floor(stretch, t, y):
                    mode, known = STOPS, False
                    continue
        # a step
        landed = t + 1.1 * h >= target
        length = target - t if landed else h
        error = step(stretch, t, length, y, scale, work, new)
        steps += 1
        if steps > ask.step_limit:
            how = STEP_LIMIT
            break
        if mode == STARTS:  # the direction is followed from where that can be seen
            excess = excess_at_rest(stretch, t + length, new)[0]
            far = slip_speed(model, new) > 10.0 * _followed(ask, excess / dry.load)
            error = math.inf if far else error
        if not error <= ask.tolerance:
            shrink = 0.1 if not error < math.inf else max(0.1, 0.9 * (ask.tolerance / error) ** 0.2)
            h = length * shrink
            if (t + h == t and t > 0.0) or h < 1e-300:
                how = NOT_FINITE
                break
            continue
        h = length * min(5.0, 5.0 if error == 0.0 else 0.9 * (ask.tolerance / error) ** 0.2)
        if mode == SLIDES and slip_side(model, y) * slip_side(model, new) < 0.0:
            landed = False
            length = _equal_speeds(stretch, t, length, y, scale, work, new)
        last[:] = work[STAGES - 1]
        happens, which, moment = first_crossing(
            bounds, stretch, region, leans, t, length, y, scale, work, new, trial
        )
        if mode == CARRIED and happens < 0 and not held_by_floor(stretch, t + length, new):
            happens, which = SLIPS, region
            moment = _slipping(stretch, t, length, y, scale, work, trial)
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
        known = (
            model.hold.kind == FREE and mode == SLIDES == stretch.mode
        )  # else the step ended a little beside it
        q = slip_speed(model, y)
        if landed and target < ask.until:
            settle = True
        if mode in (SLIDES, STOPS) and q <= _REST * ask.speed:
            settle = True
        if mode == STARTS:
            excess = excess_at_rest(stretch, t, y)[0]
            if excess <= 0.0 or q >= _followed(ask, excess / dry.load):
                mode = SLIDES
        if left(bounds, y, leans, ask.speed):
            leaning = normals(bounds, leans)
            known = False
        if happens < 0:
            continue
        settle = True
        if happens == BORDER:
            region = which
            dry = _dry(regions, region)
            mode = CARRIED if mode == CARRIED and dry.load > 0.0 else SLIDES
        elif happens == BOUNCES:
            mode = SLIDES
            before = kinetic_energy(body, y)
            hops = which == wall and t - hit > 0.0  # too low for the digits of its place: none
            least = _HOP * (abs(y[X]) + abs(y[Y])) / (t - hit) if hops else 0.0
            if bounced(bounds, which, body, y, leans, ask.speed, least):
                happens = LEANS
            wall, hit = which, t
            leaning = normals(bounds, leans)
            heat += before - kinetic_energy(body, y)
        if count == len(events):
            how = EVENT_LIMIT
            break
        _noted(events[count], t, happens, which, y)
        count += 1
        if happens == SLIPS:
            mode, settle, known = STARTS, False, False
        if happens == EDGE:
            how = OVER_EDGE
            break
    stretch = Stretch(model, dry, leaning, piece, mode, way)
    if how == TIME_UP and mode == CARRIED and moves:
        how = CARRIED_AWAY
    while how == AT_REST and frame < len(frames):  # for ever
        _framed(rows[frame], stretch, frames[frame], y, heat, work)
        frame += 1
    _framed(rows[frame], stretch, t, y, heat, work)
    finite = True
    for i in range(SIZE):
        finite = finite and math.isfinite(y[i])
    return (how if finite else NOT_FINITE), t, count, steps, frame, heat

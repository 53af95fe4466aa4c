"""From a launch to the end of a scene: an adaptive integrator in time, with events.

The pair 8(5,3) (:mod:`puck_tables.scene.explicit`), or Radau IIA where the direction of the slip
settles much faster than the slip changes (next to the limit of what friction holds).  Next to
relative rest, where the direction of friction turns within Q over what changes it, a step is at
most half of that; one that ends with the slip may take more, and is graded
(:mod:`puck_tables.scene.grading`).  At the very end a slip stops on a straight line.  Every event
is found on a real step of the method from the last step end and becomes a step end.  Rebounds that
die out are a geometric series, of which only the first are taken one by one
(see :mod:`puck_tables.scene.settle`).
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import kernel, patience
from puck_tables.scene.at_once import met_at_once
from puck_tables.scene.boundaries import (
    BORDER,
    BORDER_NUMBER,
    BORDER_SIDE,
    BOUNCES,
    EDGE,
    Boundaries,
    first_crossing,
)
from puck_tables.scene.carried import leads_on
from puck_tables.scene.cushions import NX, NY
from puck_tables.scene.desk import Ask, Desk
from puck_tables.scene.equations import (
    FIRST,
    ROW,
    SIZE,
    acting_force,
    kinetic_energy,
    rates,
    settling_rates,
    slip_rate,
    slip_speed,
    to_laboratory,
)
from puck_tables.scene.explicit import STAGES
from puck_tables.scene.friction import SPIN, VX, VY, X, Y
from puck_tables.scene.grading import CLOSEST, left_after, stretched, towards_stop
from puck_tables.scene.ground import BORDERS as GROUND_BORDERS
from puck_tables.scene.ingredients import (
    CARRIED,
    FREE,
    NO_WAY,
    SLIDES,
    STOPS,
    Model,
    Regions,
    Stretch,
    floor_velocity,
    is_astride,
)
from puck_tables.scene.moments import (
    NOTHING,
    REST,
    cut_short,
    goes_straight,
    lost,
    rests_on,
)
from puck_tables.scene.outcome import (
    AT_REST,
    CARRIED_AWAY,
    CARRIED_ROUND,
    EVENT_LIMIT,
    NOT_FINITE,
    OVER_EDGE,
    STEP_LIMIT,
    TIME_UP,
)
from puck_tables.scene.overhang import come_over_edges, look_at_edges
from puck_tables.scene.patches import (
    ASTRIDE,
    after_patch,
    comes_at_most,
    dry_under,
    first_patch,
    look_at_patches,
    region_at,
)
from puck_tables.scene.records import BEFORE, framed, noted
from puck_tables.scene.settle import (
    bounced,
    departed,
    gripped,
    look_at_rims,
    look_at_walls,
    rims_after,
    settled,
    touching,
)
from puck_tables.scene.standstill import from_standstill
from puck_tables.scene.step_size import follow_scales, up_to_the_stop
from puck_tables.scene.steps import nudged, step

# what happens on the way
RESTS, SLIPS, LEANS = 0, 1, 3  # and those of boundaries
COMES_OVER, LEAVES = BORDER, 6  # the rim, a border
_PATCH = 8  # a border of a patch, until it is known which of both

_LAST = 30.0  # times the local error: from there a stop goes straight
_NEAR = 0.5  # of the time in which the slip would end, at most, is a step
_STIFF, _MILD = 0.8, 0.3  # of the time in which a slip settles: longer steps are implicit,
_SLOWLY = 0.1  # if the slip changes by less than this of itself meanwhile
_NEWTON, _FINEST_NEWTON = 1e-3, 1e-15  # of the local error: how well implicit steps are solved
_NUDGE = 0.3  # of its local error: by so much each step of a twin on a blade is put off its way
_SWING = 0.05  # rad that a carried puck turns, at most, in a step


@kernel
def follow(
    model: Model,
    regions: Regions,
    bounds: Boundaries,
    ask: Ask,
    start: FloatArray,
    region: int,
    frames: FloatArray,
    rows: FloatArray,
    events: FloatArray,
    desk: Desk,
) -> tuple[int, float, int, int, int, float]:
    """Run a scene from the state ``start`` (10,) in the laboratory.

    ``frames`` (n,): ascending times for ``rows`` (n + 1, 15), the last of them the end; ``events``
    (m, 16); ``desk``: to work on, see
    :func:`puck_tables.scene.desk.desk_for`.

    Returns
    -------
    how it ended, when, number of events, of steps and of frames reached, root of the sum of
    squares of the errors of steps, in units of ``ask.scale``
    """
    work, last, gaps, y, new, trial, contacts, at_once, lies, scale, hangs = desk
    at_once[0] = 0.0
    for i in range(SIZE):
        y[i], scale[i] = start[i], ask.scale[i]
    body, surface, drive, length_scale = model.body, model.surface, model.forces.drive, scale[X]
    unit = length_scale / ask.speed  # s
    radius, held_there = body.radius, model.hold.kind != FREE
    moves = surface.vx != 0.0 or surface.vy != 0.0 or surface.spin != 0.0
    pull_there = model.forces.x != 0.0 or model.forces.y != 0.0 or len(drive) > 0
    swings = surface.spin != 0.0 and pull_there  # else what a turning floor asks is constant
    until, around, crossed = ask.until, math.inf, 0  # the end of a whole turn that carries it
    patched = len(lies) > 0
    unbounded = len(bounds.walls) + len(bounds.edges) + len(bounds.borders) == 0
    several = len(bounds.walls) + len(bounds.edges) > 1
    look_at_walls(bounds, contacts, body, y, ask.speed)
    leaning = contacts.rows[: touching(bounds, contacts)]
    look_at_patches(regions.ground, lies, radius, y[X], y[Y])
    dry = dry_under(regions, region, lies)
    allowed, room, leans = ask.tolerance, contacts.room, contacts.leans
    to_laboratory(model, y, -1.0)
    t, heat, mode, piece, way, stiff = 0.0, 0.0, SLIDES, 0, NO_WAY, False
    resting, calm = False, 0.0  # whether its rest is noted; when rebounds have died out
    count, steps, frame, wrong = 0, 0, 0, 0.0
    # by so much longer than the centre a spin takes to brake
    slow = max(1.0, 2.0 * body.inertia / (body.mass * body.radius * body.radius))
    straight = max(_LAST * ask.tolerance / slow, 2.0 * REST) * ask.speed
    damps, turns = settling_rates(model, dry.load)
    how = TIME_UP
    h = 1e-2 * min(ask.until, unit)
    reach, closest, swing = _NEAR, CLOSEST, _SWING
    halved = False  # the step that ends here is cut in two
    clear = 0.0  # no patch's border is nearer to the rim
    if ask.twin > 0.0:
        h, reach, swing = ask.twin * h, (1.0 + ask.twin) * reach, (1.0 + ask.twin) * swing
        closest *= 1.0 - 0.2 * ask.twin
    settle, known = True, False  # whether to look what holds the puck; whether work[0] is there
    newton, again = 0.0, False  # again: the step before was too long
    stretch = Stretch(model, dry, leaning, piece, mode, way, newton, 0.0)
    count = look_at_edges(bounds.edges, radius, hangs, stretch, t, y, events, count)
    while t < until:
        patience(1)
        while piece < len(drive) and drive[piece, 0] <= t:
            piece += 1
        target = min(drive[piece, 0], until) if piece < len(drive) else until
        if calm > t:
            target = min(target, calm)
        target = min(target, around)
        if settle and leaning.shape[0] > 0:
            stretch = Stretch(model, dry, leaning, piece, mode, way, 0.0, 0.0)
            fx, fy = acting_force(stretch, t, y)
            to_laboratory(model, y, 1.0)
            before = kinetic_energy(body, y)
            if gripped(bounds, contacts, body, fx, fy, y, ask.speed):
                heat += before - kinetic_energy(body, y)
                leaning, mode = contacts.rows[: touching(bounds, contacts)], SLIDES
            to_laboratory(model, y, -1.0)
        q = slip_speed(radius, y)
        if settle and dry.load > 0.0 and q <= REST * ask.speed:
            y[VX] = y[VY] = y[SPIN] = 0.0
            mode = CARRIED
            if leaning.shape[0] > 0:
                to_laboratory(model, y, 1.0)
                look_at_rims(bounds, contacts, body, y, ask.speed)
                to_laboratory(model, y, -1.0)
                y[VX] = y[VY] = y[SPIN] = 0.0
                leaning = contacts.rows[: touching(bounds, contacts)]
            at_rest = Stretch(model, dry, leaning, piece, CARRIED, NO_WAY, 0.0, 0.0)
            mode, stiff, q = from_standstill(at_rest, ask.speed, t, y, work)
            if (mode == CARRIED) != resting and (t >= calm or mode != CARRIED):
                if count == len(events):
                    how = EVENT_LIMIT
                    break
                resting = mode == CARRIED
                where = region_at(regions.ground, y[X], y[Y])
                noted(events[count], model, t, RESTS if resting else SLIPS, where, y)
                count += 1
            if mode == CARRIED and t >= calm and not moves:
                if rests_on(model, dry, leaning, piece, y):
                    how = AT_REST  # nothing is to come
                    break
            elif mode == CARRIED and t >= calm and piece == len(drive) and not ask.to_the_end:
                if not swings and not leads_on(
                    surface, bounds, leans, regions.ground, lies, region, radius, y
                ):
                    how = CARRIED_AWAY
                    break
                if t >= around:  # and so it goes on for ever
                    how = CARRIED_ROUND if count > crossed else CARRIED_AWAY
                    break
                if surface.spin != 0.0 and around == math.inf:
                    around, crossed = t + 2.0 * math.pi / abs(surface.spin), count
                    until = max(until, around)
            around = around if mode == CARRIED else math.inf
            h = max(h, 1e-6 * (target - t))
            known = False
        elif settle:
            mode = SLIDES
            resting, around = False, math.inf
        h = -q / way[3] if mode == STOPS else h
        if mode == CARRIED and swings:
            h = min(h, swing / abs(surface.spin))
        if mode == CARRIED and is_astride(dry):  # what holds it changes from place to place
            sx, sy, _ = floor_velocity(surface, y[X], y[Y])
            h = min(h, swing * radius / max(math.hypot(sx, sy), 1e-300))
        if settle or not known:
            newton = 0.0
            if stiff and mode == SLIDES:
                newton = max(_NEWTON * ask.tolerance, _FINEST_NEWTON)
            stretch = Stretch(model, dry, leaning, piece, mode, way, newton, 0.0)
            rates(stretch, t, y, work, FIRST)
        settle, known = False, True
        ends = 0.0  # 1/s: of the slip
        if mode == SLIDES and dry.load > 0.0:
            pull = slip_rate(radius, work)
            least = REST * ask.speed
            h, ends = up_to_the_stop(stretch, h, q, least, pull, reach, closest, y, work)
            way, late = NO_WAY, 0.0
            if 0.0 < q <= straight:
                way, late = goes_straight(
                    stretch, ask.speed, ask.tolerance, unit, t, q, pull, slow, y, work
                )  # fmt: skip
            if way[3] < 0.0:
                mode, known = STOPS, False
                wrong += (late / unit) ** 2
                continue
        # a step
        landed = t + (1.0 if again else 1.1) * h >= target  # not what was too long
        length = target - t if landed else h
        bend = towards_stop(ends * length)
        stretch = Stretch(model, dry, leaning, piece, mode, way, newton, bend)
        error = step(stretch, t, length, y, scale, work, new)
        steps += 1
        if steps > ask.step_limit:
            how = STEP_LIMIT
            break
        power = 0.25 if newton > 0.0 else 0.125
        lifts = 0.0  # off a wall that the puck leant on: from where it leaves, it may come back
        for i in range(leaning.shape[0]):
            lifts = max(lifts, leaning[i, NX] * new[SIZE] + leaning[i, NY] * new[SIZE + 1])
        if lifts > ask.tolerance * length_scale and error <= allowed:
            h = 0.25 * length
            continue
        if not error <= allowed:
            shrink = 0.25 if newton > 0.0 else 0.1
            if error < math.inf:
                shrink = max(0.1, 0.9 * (allowed / error) ** power)
            h, again = stretched(bend, length, shrink), True
            if (t + h == t and t > 0.0) or h < 1e-300:
                how = NOT_FINITE
                break
            continue
        again = False
        grows = min(5.0, 5.0 if error == 0.0 else 0.9 * (allowed / error) ** power)
        h = left_after(bend) * stretched(bend, length, grows)
        stuck, length = cut_short(stretch, t, length, y, scale, work, new)
        if not math.isfinite(new[VX]):  # a shorter implicit step, which was not solved
            h, again = 0.25 * length, True
            continue
        landed = landed and stuck == NOTHING
        cut = landed or stuck != NOTHING
        for i in range(ROW):
            last[i] = work[STAGES - 1, i]
        happens, which, moment = -1, -1, math.inf
        if not unbounded:
            happens, which, moment = first_crossing(
                bounds, room, region, leans, stretch, t, length, y, scale, work, new, gaps, trial
            )
        if patched:
            far = comes_at_most(surface, length, work[0], last)
            if clear < far:
                patch, met, clear = first_patch(
                    regions.ground, lies, stretch, t, length, far, y, new, scale, work, last, trial
                )
                if met < moment:
                    happens, which, moment = _PATCH, patch, met
            clear -= far
        if mode == CARRIED and t >= calm:  # also before what it is carried to
            step(stretch, t, min(moment, length), y, scale, work, trial)
            slips = lost(stretch, t, min(moment, length), y, scale, work, trial)
            if slips < math.inf:
                happens, which, moment = SLIPS, region, slips
        if happens >= 0:
            landed, stuck, cut, length = False, NOTHING, True, moment
        halved = ask.twin > 0.0 and cut and not halved
        if halved:
            landed, stuck, happens, length = False, NOTHING, -1, ask.twin * length
        if halved or happens >= 0:
            error = step(stretch, t, length, y, scale, work, new)
            # astride the longer step may have passed over all; an implicit one is not solved
            if not error <= allowed and (is_astride(dry) or not error < math.inf):
                shrink = max(0.1, 0.9 * (allowed / error) ** power if error < math.inf else 0.1)
                h, halved = length * shrink, False
                continue
            for i in range(ROW):
                last[i] = work[STAGES - 1, i]
        wrong += error * error
        if len(hangs) > 0:
            count = come_over_edges(
                bounds.edges, radius, hangs, stretch, t, length, y, scale, work, last, new, gaps,
                trial, events, count,
            )  # fmt: skip
        # the frames on it
        end = target if landed else t + length
        while frame < len(frames) and frames[frame] <= end:
            step(stretch, t, frames[frame] - t, y, scale, work, trial)
            framed(rows[frame], stretch, frames[frame], trial, heat, work)
            frame += 1
        t = end
        for i in range(SIZE):
            y[i] = new[i]
        follow_scales(scale, ask.tolerance, body, y)
        for i in range(room.size):
            room[i] += bounds.walls[i, NX] * new[SIZE] + bounds.walls[i, NY] * new[SIZE + 1]
        for i in range(ROW):
            work[0, i] = last[i]
        known = happens < 0 and mode == SLIDES and not held_there and leaning.shape[0] == 0
        if ask.twin > 0.0 and happens < 0 and mode == SLIDES and q > straight:
            nudged(model, _NUDGE * min(error, allowed), steps, scale, y)
        before_it, q = q, slip_speed(radius, y)
        if newton > 0.0 or mode == SLIDES:
            settles = length * (damps + turns / q if q > 0.0 else damps)
            slowly = slip_rate(radius, work) < _SLOWLY * (damps * q + turns)
            was, stiff = stiff, slowly and settles > (_MILD if newton > 0.0 else _STIFF)
            known = known and stiff == was
        if landed and (target < until or t in (calm, around)):
            settle = True
        if mode in (SLIDES, STOPS) and q <= REST * ask.speed and q < before_it:
            settle = True
        if leaning.shape[0] > 0:
            to_laboratory(model, y, 1.0)
            before = kinetic_energy(body, y)
            changed = rims_after(bounds, contacts, body, y, stuck, ask.speed)
            if 0.0 < calm <= t:
                calm = 0.0
                settled(bounds, contacts, body, y, ask.speed)
                changed = True
            if mode != STOPS:  # its last slip is rounding
                changed = departed(bounds, contacts, y, ask.speed) or changed
            heat += before - kinetic_energy(body, y)
            to_laboratory(model, y, -1.0)
            if changed:
                leaning = contacts.rows[: touching(bounds, contacts)]
        if happens < 0:
            continue
        settle, image = True, -1
        if several and happens in (BOUNCES, EDGE):
            for i in range(SIZE):
                last[i] = y[i]
            to_laboratory(model, last, 1.0)
            happens, which, other, image = met_at_once(
                bounds, contacts, happens, which, ask.order, body, t, last, ask.speed, unit,
                ask.tolerance, new, trial,
            )  # fmt: skip
            if other >= 0:
                at_once[0] += 1.0
                if at_once[0] == 1.0:
                    first = which if happens == BOUNCES else len(bounds.walls) + which
                    at_once[1], at_once[2], at_once[3] = t, first, other
        if happens in (BORDER, _PATCH):
            if happens == BORDER:
                line = bounds.borders[min(region, which)]
                back = line[BORDER_SIDE] * (which - region) > 0.0
                region, which = which, int(line[BORDER_NUMBER])
            else:
                lies[which] = after_patch(regions.ground, which, lies[which], y[X], y[Y])
                clear = 0.0
                back = lies[which] != ASTRIDE
                which += int(regions.ground[GROUND_BORDERS])
            happens = LEAVES if back else COMES_OVER
            dry = dry_under(regions, region, lies)
            damps, turns = settling_rates(model, dry.load)
            stiff = stiff and dry.load > 0.0
            mode = CARRIED if mode == CARRIED and dry.load > 0.0 else SLIDES
            contacts.chain[0] = -1
        elif happens == BOUNCES:
            mode = SLIDES
            to_laboratory(model, y, 1.0)
            before = kinetic_energy(body, y)
            for row in range(count, min(count + 2, len(events))):  # of its image, too
                for i in range(3):
                    events[row, BEFORE + i] = y[VX + i]
            rest_time = bounced(
                bounds, contacts, which, image, body, y, t, floor_velocity(surface, y[X], y[Y]),
                ask.speed, unit, ask.tolerance,
            )  # fmt: skip
            heat += before - kinetic_energy(body, y)
            to_laboratory(model, y, -1.0)
            if rest_time >= 0.0:
                happens = LEANS
                calm = max(calm, t + rest_time) if rest_time > 0.0 else calm
                wrong += (rest_time / unit) ** 4
            leaning = contacts.rows[: touching(bounds, contacts)]
        if count + 1 >= len(events):
            how = EVENT_LIMIT
            break
        if happens == SLIPS:
            continue  # noted when it is known how
        noted(events[count], model, t, happens, which, y)
        count += 1
        if image >= 0:
            noted(events[count], model, t, happens, image, y)
            count += 1
        if happens == EDGE:
            how = OVER_EDGE
            break
    stretch = Stretch(model, dry, leaning, piece, mode, way, 0.0, 0.0)
    if how == TIME_UP and mode == CARRIED and moves and ask.to_the_end:
        how = CARRIED_AWAY
    if how == CARRIED_AWAY and around <= t and events[count - 1, 1] == RESTS:  # since then
        t = events[count - 1, 0]
        for i in range(SIZE):
            y[i] = events[count - 1, 3 + i]
        y[VX] = y[VY] = y[SPIN] = 0.0
        while frame > 0 and frames[frame - 1] > t:
            frame -= 1
    while how == AT_REST and frame < len(frames):  # for ever
        framed(rows[frame], stretch, frames[frame], y, heat, work)
        frame += 1
    framed(rows[frame], stretch, t, y, heat, work)
    finite = True
    for i in range(SIZE):
        finite = finite and math.isfinite(y[i])
    return (how if finite else NOT_FINITE), t, count, steps, frame, math.sqrt(wrong)

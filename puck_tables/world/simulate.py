"""One scene, from its start to its end, and how far that is off.

Other runs from the same start tell, that err by more than it does.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.errors import PuckError
from puck_tables.scene.friction import THETA, VX, X, Y
from puck_tables.scene.ingredients import FREE
from puck_tables.scene.library import files_of
from puck_tables.scene.regions import friction_error
from puck_tables.scene.run import (
    AT_REST,
    CARRIED_AWAY,
    CARRIED_ROUND,
    ENDS,
    IN_POCKET,
    OVER_EDGE,
    STATE,
    TIME_UP,
    TIPPED,
    Event,
    Run,
    residual,
)
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.world import engine_state as g
from puck_tables.world.agreement import segment_error, steps_for
from puck_tables.world.floor_under import moves_along
from puck_tables.world.floors import velocities_under
from puck_tables.world.lasting import at_rest_below
from puck_tables.world.layout import HOLD, INV_INERTIA, INV_MASS, NORMAL
from puck_tables.world.ledger import energies_of, energy_scale
from puck_tables.world.named_pucks import pucks_of
from puck_tables.world.plan import plan_of
from puck_tables.world.prepare import Start, prepared
from puck_tables.world.record import floor_under, reactions, rests_of, slips_over
from puck_tables.world.running import ascending
from puck_tables.world.world import World

# of check runs: so many times the error of a step, and to which side launches are off
CHECKS = ((30.0, 1.0), (8.0, -1.0))
PROBES = 8  # states of one puck that are compared
LATER = 0.01  # of a run: by so much a check run may end later
# of what look-ups may err by, launches of one puck: places go with the square of the speed
OF_ONE = 0.5
FINER, FINEST = 1 / 30, 1e-12  # of the tolerance before, tried one after the other
MOST_IN_VAIN = 2  # finer tolerances in a row that do not halve the estimate
_LEFT = {"pocket": ENDS[IN_POCKET], "edge": ENDS[OVER_EDGE], "tip": ENDS[TIPPED]}
MISSED = 1e-7  # of the ledger, where pucks pushed each other: their impacts were not solved


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

    ``coarser``: so many times the error of a step; ``share``: of their velocities and spins
    launches are off by so much, and in rad their headings; ``friction``: of what is integrated, off
    by so much.
    """
    engine = g.copy_of(start.engine)
    states, launches = start.states.copy(), engine.launches.copy()
    scale = 1.0 + share
    cosine, sine = scale * math.cos(share), scale * math.sin(share)
    turned = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, scale]])
    launches[:, g.LAUNCH_VX :] = launches[:, g.LAUNCH_VX :] @ turned.T
    free = (engine.discs[:, INV_MASS] > 0.0) & (engine.discs[:, HOLD] == FREE)
    floor = velocities_under(engine, states)[free]
    states[free, VX:] = floor + (states[free, VX:] - floor) @ turned.T
    engine.scale[2] *= coarser
    engine.discs[:, NORMAL] *= 1.0 + friction
    # torques to the other side, by twice as much: all alike hardly change where rebounds lead
    engine.discs[:, INV_INERTIA] *= 1.0 - 3.0 * friction
    regions = engine.regions._replace(load=engine.regions.load * (1.0 + friction))
    return start._replace(engine=engine._replace(launches=launches, regions=regions), states=states)


def simulate(scene: SceneSpec, times: npt.ArrayLike | None = None) -> Run:
    """A run of a scene, as :meth:`puck_tables.Scene.simulate` has it."""
    files, moments = files_of(scene), None if times is None else ascending(times)
    world, end, end_time, error = _close_enough(scene, moments)
    if moments is None:
        moments = np.linspace(0.0, end_time, int(scene.frames))
    elif end not in (ENDS[AT_REST], *_LEFT.values()):
        moments = moments[moments <= end_time]
    columns = columns_of(world, moments, end_time)
    if not scene.pucks:
        columns = {n: one if one.ndim == 1 else one[:, 0] for n, one in columns.items()}
    missed = residual(columns, energy_scale(world._engine))
    if world.groups > 0 and not missed <= MISSED:
        raise PuckError(g.TOGETHER.format(time=world.time))
    speed, rate = world._engine.scale[:2].tolist()
    model, why = plan_of(world.scene)  # with the finer steps that it took
    return Run(
        simulated=simulate,
        scene=scene.single(),
        model=model,
        why=why,
        end=end,
        end_time=end_time,
        names=world.names,
        events=_events(world),
        stop_times=world.motion_ends,
        energy_residual=missed,
        error_estimate=error + _late(world),
        speed_scale=speed,
        rate_scale=rate,
        steps=int(world._engine.counts[g.N_PIECES]),
        last={name: _number(row[-1]) for name, row in columns.items()},
        columns={name: row[:-1] for name, row in columns.items()},
        files=files,
    )


def run_on(world: World, moments: FloatArray | None) -> tuple[str, float]:
    """Run it; how and when it ends.

    Without a time until nothing more can happen; on a floor that moves to the last moment that is
    asked for.
    """
    until = world.scene.time
    if until is None and moves_along(world._engine.surface) and moments is not None:
        until = float(moments[-1]) if moments.size and moments[-1] > 0.0 else None
    if until is not None:
        world.advance(until)
        ends_of_motion = world.motion_ends
        moving = bool(world.moving.any())
        end_time = world.time if moving else float(ends_of_motion.max())
        along = moving and moves_along(world._engine.surface)
        rides = along and bool((ends_of_motion < math.inf).all())
        if rides and not world.state()[:, VX:].any():  # other belts rub it
            moving = rides = False
        end = ENDS[CARRIED_AWAY if rides else TIME_UP if moving else AT_REST]
    else:
        end_time, goes_round = world.come_to_rest()
        rides = bool(world.moving[world.in_play].any())
        end = ENDS[CARRIED_ROUND if goes_round else CARRIED_AWAY if rides else AT_REST]
    if len(world.names) == 1 and not world.in_play[0]:
        return _LEFT[world.events_since(0.0)[-1].what], float(world.motion_ends[0])
    return end, end_time


def columns_of(world: World, moments: FloatArray, end_time: float) -> dict[str, FloatArray]:
    """States, energies, and what becomes of each puck, over time; the last row is the end.

    Arrays (times, pucks); energies but kinetic ones are of all together, (times,).
    """
    wanted = np.minimum(np.append(moments, end_time), world.time)
    order = np.argsort(wanted, kind="stable")  # of what rests states are asked after the end, too
    times, back = wanted[order], np.argsort(order)
    alone_gone = len(world.names) == 1 and not world.in_play[0]
    if alone_gone:  # its run ends as it leaves
        times = np.minimum(times, np.nextafter(end_time, 0.0))
    states = world.over(times)
    near = at_rest_below(world._engine)
    in_play = np.ones(states.shape[:2])
    events = world._engine.events[: world._engine.counts[g.N_EVENTS]]
    for event in events[np.isin(events[:, g.WHAT], (g.POCKETED, g.OVER_EDGE, g.TIPS))]:
        in_play[times >= event[g.TIME], world._order[int(event[g.WHO])]] = 0.0
    in_play[back[-1]] *= 0.0 if alone_gone else 1.0
    discs = world._place
    every, then = np.tile(discs, len(times)), np.repeat(times, len(discs))
    slips = slips_over(world._engine, every, states.reshape(-1, 6), then).reshape(in_play.shape)
    columns = {
        **{name: states[..., n] for n, name in enumerate(STATE)},
        "in_play": in_play, "carried": np.where((slips <= near) & (in_play > 0.0), 1.0, 0.0),
        **energies_of(world, times, states),
    }  # fmt: skip
    if (world._engine.discs[:, HOLD] != FREE).any():
        own = world._order
        forces = reactions(world._engine, times, states[:, own], in_play[:, own])[:, discs]
        columns |= {"lambda_1": forces[..., 0], "lambda_2": forces[..., 1]}
    ordered = {name: values[back] for name, values in columns.items()}
    return {"time": np.append(moments, end_time), **ordered}


def _number(row: Any) -> Any:
    return float(row) if np.ndim(row) == 0 else row


def _events(world: World) -> list[Event]:
    """What the engine wrote down, with the moments at which pucks come to rest and leave it."""
    floor = world.scene.floor
    rests = [
        Event(time, what, world.names[world._order[disc]], floor_under(floor, x, y), x, y)
        for time, what, disc, x, y in rests_of(world._engine)
    ]
    return sorted([*world.events_since(0.0), *rests], key=lambda event: event.time)


class _Done(NamedTuple):
    """A run: how and when it ended, and what it may be wrong by, in units of Q/J and Q²/J."""

    world: World
    end: str
    end_time: float
    error: float


def _done(scene: SceneSpec, moments: FloatArray | None) -> _Done:
    start = prepared(scene)
    world = World.since(start)
    end, end_time = run_on(world, moments)
    return _Done(world, end, end_time, error_of(world, start))


def _close_enough(scene: SceneSpec, moments: FloatArray | None) -> _Done:
    """The run; of one puck again, with finer steps and no look-up, while ``tol`` is not kept.

    Of several launches decide, which nobody knows so well.
    """
    best, in_vain = _done(scene.single(), moments), 0
    alone, integrated = len(best.world.names) == 1, best.world._engine.floors[:, 2].all()
    tol = steps_for(scene) if integrated else segment_error(scene)
    while alone and best.error > scene.tol and tol > FINEST and in_vain < MOST_IN_VAIN:
        tol = max(FINER * tol, FINEST)
        try:
            finer = _done(replace(scene, tol=tol), moments)
        except PuckError:  # a friction law is known no better
            break
        in_vain = 0 if finer.error <= 0.5 * best.error else in_vain + 1
        best = finer if finer.error < best.error else best
    return best


def _late(world: World) -> float:
    """How long, in units of Q/J, the rebounds of one puck would have lasted that died out."""
    speed, rate, *_, late = world._engine.scale.tolist()
    return late * rate / speed if len(world.names) == 1 else 0.0

"""One scene of several pucks, from its start to its end."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables._core.real import finite_array
from puck_tables.errors import InputError, PuckError
from puck_tables.scene.library import files_of
from puck_tables.scene.run import STATE, Event, Run, residual
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.world import game as g
from puck_tables.world.agreement import flight_error, refuse_endless
from puck_tables.world.ledger import energies_of
from puck_tables.world.outcome import ways_of
from puck_tables.world.rests import STUCK, floor_under, rests_of, slips_over
from puck_tables.world.rim_laws import rule_of
from puck_tables.world.world import World

MISSED = 1e-7  # of the ledger, where pucks pushed each other: their impacts were not solved


def simulate(scene: SceneSpec, times: npt.ArrayLike | None = None) -> Run:
    """A run of a scene, as :meth:`puck_tables.Scene.simulate` has it."""
    world = World(scene)
    refuse_endless(world.scene)
    files = files_of(scene)
    world.advance(math.inf if scene.time is None else scene.time)
    moving = bool(world.moving.any())
    end_time = world.time if moving else world.last_motion
    columns = _columns(world, _moments(scene, times, end_time, moving), end_time)
    missed = residual(columns)
    if world.groups > 0 and not missed <= MISSED:
        raise PuckError(g.TOGETHER.format(time=world.time))
    speed, rate = world._game.pace[:2].tolist()
    ways = ways_of(scene)
    return Run(
        simulated=simulate,
        scene=world.scene,
        model=", ".join(ways.splitlines()),
        why=f"{ways}\n{rule_of(scene)}",
        end=_end(world, moving),
        end_time=end_time,
        names=world.names,
        events=_events(world),
        stop_times=world.stop_times,
        energy_residual=missed,
        error_estimate=_error(scene, world) * rate / speed**2,
        speed_scale=speed,
        rate_scale=rate,
        steps=int(world._game.counts[g.N_PIECES]),
        last={name: _number(row[-1]) for name, row in columns.items()},
        columns={name: row[:-1] for name, row in columns.items()},
        files=files,
    )


def _moments(
    scene: SceneSpec, times: npt.ArrayLike | None, end_time: float, moving: bool
) -> FloatArray:  # fmt: skip
    """When states are saved."""
    if times is None:
        return np.linspace(0.0, end_time, int(scene.frames))
    moments = np.atleast_1d(finite_array("times", times, "s"))
    if moments.ndim != 1 or (moments < 0.0).any() or (np.diff(moments) < 0.0).any():
        raise InputError("times must be a list of ascending numbers >= 0 s")
    return moments[moments <= end_time] if moving else moments


def _columns(world: World, moments: FloatArray, end_time: float) -> dict[str, FloatArray]:
    """States, energies, and what becomes of each puck, over time; the last row is now."""
    times = np.append(np.minimum(moments, world.time), world.time)
    states = world.over(times)
    near = STUCK * float(world._game.pace[0])
    in_play = np.ones(states.shape[:2])
    for event in world.events_since(0.0):
        if event.what in ("pocket", "edge"):
            in_play[times >= event.time, world.names.index(event.puck)] = 0.0
    discs = world._place
    slips = slips_over(world._game, np.broadcast_to(discs, in_play.shape).ravel(),
                       states.reshape(-1, 6)).reshape(in_play.shape)  # fmt: skip
    energies = energies_of(world, times)
    energies["kinetic_energy"] = energies["kinetic_energy"][:, discs]
    columns = {
        "time": np.append(moments, end_time),
        **{name: states[..., n] for n, name in enumerate(STATE)},
        "in_play": in_play, "carried": np.where((slips <= near) & (in_play > 0.0), 1.0, 0.0),
        **energies,
    }  # fmt: skip
    several = bool(world.scene.pucks)
    return {n: one if several or one.ndim == 1 else one[:, 0] for n, one in columns.items()}


def _number(row: Any) -> Any:
    return float(row) if np.ndim(row) == 0 else row


def _end(world: World, moving: bool) -> str:
    """How it ends."""
    if not world.scene.pucks and not world.in_play[0]:
        return "over the edge" if world.events_since(0.0)[-1].what == "edge" else "in a pocket"
    if not moving:
        return "at rest"
    slips = slips_over(world._game, world._place, world.state())
    carried = slips <= STUCK * float(world._game.pace[0])
    return "carried by the floor" if carried[world.in_play].all() else "time is up"


def _events(world: World) -> list[Event]:
    """What the engine wrote down, with the moments at which pucks come to rest and leave it."""
    floor = world.scene.floor
    rests = [
        Event(time, what, world.names[world._order[disc]], floor_under(floor, x, y), x, y)
        for time, what, disc, x, y in rests_of(world._game)
    ]
    return sorted([*world.events_since(0.0), *rests], key=lambda event: event.time)


def _error(scene: SceneSpec, world: World) -> float:
    """How far check runs end whose launches are off by what flights may be wrong by, m.

    With the rounding of the look-up, for pucks that could slide far.
    """
    last = world.state()
    gaps, own, share = [], world.place_error, flight_error(scene)
    for scale, turn in ((1.0 + share, share), (1.0 - share, -share)):
        check = World(scene)
        try:
            check.perturb(scale, turn)
            check.advance(world.time)
        except PuckError:  # it meets what has no answer: so nearly did the run
            gaps.append(float(np.hypot(*np.ptp(last[:, :2], axis=0))))
            continue
        gaps.append(float(np.hypot(*(check.state() - last)[:, :2].T).max()))
    return max(gaps) + own

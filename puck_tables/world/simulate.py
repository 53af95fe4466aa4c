"""One scene of several pucks, from its start to its end."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables._core.real import finite_array
from puck_tables.errors import InputError, PuckError
from puck_tables.scene.library import files_of
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.world.agreement import flight_error, refuse_endless
from puck_tables.world.game import TOGETHER
from puck_tables.world.ledger import ledger
from puck_tables.world.outcome import STATE, WorldRun
from puck_tables.world.world import World

MISSED = 1e-7  # of the ledger, where pucks pushed each other: their impacts were not solved


def simulate(scene: SceneSpec, times: npt.ArrayLike | None = None) -> WorldRun:
    """A run of a scene, as :meth:`puck_tables.Scene.simulate` has it."""
    world = World(scene)
    refuse_endless(world.scene)
    files = files_of(scene)
    world.advance(math.inf if scene.time is None else scene.time)
    books = ledger(world)
    if world.groups > 0 and not books["energy_residual"] <= MISSED:
        raise PuckError(TOGETHER.format(time=world.time))
    moving = bool(world.moving.any())
    end_time = world.time if moving else world.last_motion
    if times is None:
        moments = np.linspace(0.0, end_time, int(scene.frames))
    else:
        moments = np.atleast_1d(finite_array("times", times, "s"))
        if moments.ndim != 1 or (moments < 0.0).any() or (np.diff(moments) < 0.0).any():
            raise InputError("times must be a list of ascending numbers >= 0 s")
        if moving:
            moments = moments[moments <= end_time]
    states = world.over(np.minimum(moments, world.time))
    last = world.state()
    columns = {**_columns(states), "in_play": _in_play(world, moments)}
    return WorldRun(
        simulated=simulate,
        scene=world.scene,
        end="time is up" if moving else "at rest",
        end_time=end_time,
        names=world.names,
        events=world.events_since(0.0),
        time=moments,
        columns=columns,
        last={**_columns(last), "in_play": world.in_play.astype(np.float64)},
        stop_times=world.stop_times,
        **books,
        end_error=_error(scene, world, last),
        files=files,
    )


def _columns(states: FloatArray) -> dict[str, FloatArray]:
    """States (…, pucks, 6) by name."""
    return {name: states[..., n] for n, name in enumerate(STATE)}


def _in_play(world: World, times: FloatArray) -> FloatArray:
    """1 while a puck is on the board, array (times, pucks)."""
    on_board = np.ones((len(times), len(world.names)))
    for event in world.events_since(0.0):
        if event.what in ("pocket", "edge"):
            on_board[times >= event.time, world.names.index(event.puck)] = 0.0
    return on_board


def _error(scene: SceneSpec, world: World, last: FloatArray) -> float:
    """How far twins end whose launches are off by what flights may be wrong by, m.

    With the rounding of the look-up, for pucks that could slide far.
    """
    gaps, own, share = [], world.place_error, flight_error(scene)
    for scale, turn in ((1.0 + share, share), (1.0 - share, -share)):
        twin = World(scene)
        try:
            twin.perturb(scale, turn)
            twin.advance(world.time)
        except PuckError:  # it meets what has no answer: so nearly did the run
            gaps.append(float(np.hypot(*np.ptp(last[:, :2], axis=0))))
            continue
        gaps.append(float(np.hypot(*(twin.state() - last)[:, :2].T).max()))
    return max(gaps) + own

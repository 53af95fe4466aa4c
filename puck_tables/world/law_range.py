"""Up to which slip a friction law of the floor is known, as pucks get faster on the way."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.errors import ContactError, InputError
from puck_tables.scene.by_speed import FARTHER, end_of_laws, laws_in
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.world.engine_state import Engine, Whole
from puck_tables.world.floor_under import SURE, floor_of, law_goes_to
from puck_tables.world.floors import slip_of_rim
from puck_tables.world.layout import LIGHTNESS, RADIUS
from puck_tables.world.prepare import with_law_up_to
from puck_tables.world.segment_starts import CONCERNED, Room


def refuse_too_fast(engine: Engine, scene: SceneSpec, name: str, i: int, state: FloatArray) -> None:
    """Refuse a strike beyond what rows of the friction law of the floor say."""
    top = law_goes_to(engine.regions)
    fastest = slip_of_rim(
        engine.discs[i, RADIUS], floor_of(engine.surface, engine.discs[i]), state.tolist()
    )
    if fastest > top and top == end_of_laws(scene)[0]:
        raise InputError(
            f"{name}: its rim would slip at {fastest:.6g} m/s, and the friction law "
            f"{end_of_laws(scene)[1]} ends at {top:g} m/s: strike more softly, or give it more "
            "speeds"
        )


def with_law_for(
    engine: Engine, room: Room, scene: SceneSpec, order: Whole, names: Sequence[str], time: float
) -> Engine:
    """The state of the engine with friction that is known at all slips of those that set off now.

    Raises
    ------
    InputError
        If its law ends below one, or lifts part of a base there.
    """
    top = law_goes_to(engine.regions)
    if top == math.inf:
        return engine
    for i in np.flatnonzero(room.marks == CONCERNED):
        fastest = slip_of_rim(
            engine.discs[i, RADIUS],
            floor_of(engine.surface, engine.discs[i]),
            room.states[i].tolist(),
        )
        if engine.discs[i, LIGHTNESS] == 0.0 or fastest < SURE * top:
            continue
        if top == end_of_laws(scene)[0]:
            raise InputError(
                f"at {time:.6g} s the rim of {names[order[i]]} slips at {fastest:.6g} m/s, and the "
                f"friction law {end_of_laws(scene)[1]} ends at {top:g} m/s: nothing is known "
                "beyond; give it more speeds"
            )
        top = min(FARTHER * fastest, end_of_laws(scene)[0])
        try:
            engine = with_law_up_to(engine, scene, order, top)
        except ContactError as error:  # at the launch the heights were in order
            raise InputError(
                f"at {time:.6g} s the rim slips at {fastest:.6g} m/s, where friction by "
                f"{', '.join(laws_in(scene))} tilts the pressure so much that part of a base would "
                "lift: a slip that grows may never stop; give a shorter time, or less that drives "
                "it"
            ) from error
    return engine

"""All that the compiled engine of many pucks knows: discs, segments, what comes next, what was."""

from __future__ import annotations

from operator import itemgetter
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.scene.ingredients import Regions, Surface
from puck_tables.world.segment import SEGMENT_COLUMNS, Lookups

Whole = npt.NDArray[np.int64]

# what comes next for a disc, beside a partner (a disc ≥ 0, an obstacle −1 − k)
NOTHING, PATH_ENDS, LOOK_AGAIN = 1 << 40, (1 << 40) + 1, (1 << 40) + 2

# events; from PLACED on, as STRUCK, by hand
(
    IMPACT, CONTACT, PART, POCKETED, OVER_EDGE, REST, STRUCK, ENTERS, LEAVES, OVERHANGS, PASSES,
    TIPS, PLACED, REMOVED, ADDED, FORCED,
) = range(16)  # fmt: skip
EVENTS = (
    "impact", "contact", "part", "pocket", "edge", "rest", "launch", "entry", "exit", "overhang",
    "line", "tip", "placed", "removed", "added", "force",
)  # fmt: skip
# columns of an event, first those told, as :class:`puck_tables.scene.run.Event` has them: what,
# disc, partner, place of the contact, approach and slip before, normal and tangential impulse,
# energy lost; then the normal from the disc to its partner, what launches and driven bodies gave
# (of who leaves play: what went along), the work of constraints, in SI units
(
    TIME, WHAT, WHO, PARTNER, AT_X, AT_Y, APPROACH, SLIDE, PUSH, RUB, LOST, NORMAL_X, NORMAL_Y, GOT,
    LED,
) = range(15)  # fmt: skip
REPORTED, EVENT_COLUMNS = LOST + 1, 15

# why a run does not go on, whatever of it comes first, and where its ledger is wrong for the same
TOGETHER = (
    "by {time:.6g} s what touches meets again and again, or presses so that no forces satisfy the "
    "laws of all rims: that is not solved here; give restitutions from 0.5 on or smooth rims "
    "(tangential = -1), or move a puck"
)

LAUNCH_TIME, LAUNCH_I, LAUNCH_VX, LAUNCH_VY, LAUNCH_SPIN = range(5)
LAUNCH_COLUMNS = 5  # the five above

HISTORY_COLUMNS = 2 + SEGMENT_COLUMNS  # disc, kind, segment

# counts
(
    N_EVENTS, N_HISTORY, N_PIECES, N_HELD, N_LAUNCHES, N_IMPACTS, N_GROUPS, N_LOOKS, N_CONTACTS,
    N_AT_ONCE, N_WORK_ROWS,
) = range(11)  # fmt: skip
COUNTS = 11


class Engine(NamedTuple):
    """Everything, as arrays: a copy of them is a copy of the world.

    ``regions``: the dry friction of every disc everywhere on the floor, see
    :mod:`puck_tables.world.floor_under`; ``floors`` what of it stands in its row there (places · n,
    5): deceleration, δ, whether it is integrated, and the velocity of the floor, which a disc takes
    over when it comes there; ``surface``: how the floor moves, of belts the fastest; ``forcing``,
    ``spans`` (n, 2): what changes over time under each disc (:mod:`puck_tables.scene.over_time`),
    from its first row to the last + 1; ``rims``: the laws by which they meet
    (:mod:`puck_tables.world.layout`).  ``clock`` (1,): now.  ``group``
    (n,): discs of one number push each other, 0: none; ``held`` (…, 2): their contacts.
    ``next_time``, ``next_partner`` (n,).  ``launches`` (…, 5), ascending in time.  ``drives``
    (n, 2): the rows of ``pieces`` along which a disc is driven.  ``hangs`` (n, edges): whether its
    rim is over an edge.  ``work_rows``: where the energy of those went who were integrated, see
    :mod:`puck_tables.world.step_ledger`.  ``counts``: how many rows of
    events, history, pieces, works and held contacts are used, how many launches and what else was
    done, and the contacts of the event at work.  ``scale`` (5,): the scales of speed, m/s, and
    acceleration, m/s², the error of a step where motions are integrated, in units of them, the
    energy of the launches at the start, J, and how long the rebounds were to last that died out, s.
    """

    discs: FloatArray
    regions: Regions
    floors: FloatArray
    surface: Surface
    forcing: FloatArray
    spans: Whole
    rims: FloatArray
    obstacles: FloatArray
    lookups: Lookups
    clock: FloatArray
    kinds: Whole
    segments: FloatArray
    group: Whole
    held: Whole
    next_time: FloatArray
    next_partner: Whole
    launches: FloatArray
    pieces: FloatArray
    drives: Whole
    hangs: Whole
    events: FloatArray
    history: FloatArray
    work_rows: FloatArray
    counts: Whole
    scale: FloatArray


# what never changes: tables, floors and obstacles; in the ground it is written who lies where
_SHARED = ("floors", "surface", "forcing", "spans", "rims", "obstacles", "lookups", "launches")
_GROWS = ("pieces", "events", "history", "work_rows")  # rows are added after those that are counted
_STAYS = {*_SHARED, *_GROWS, "regions"}
_changing = itemgetter(*(k for k, name in enumerate(Engine._fields) if name not in _STAYS))


def copy_of(engine: Engine) -> Engine:
    """A state of the engine that goes on by itself from here; what never changes both have."""
    parts: dict[str, Any] = engine._asdict()
    regions = parts.pop("regions")
    own = {name: one if name in _SHARED else one.copy() for name, one in parts.items()}
    return Engine(regions=regions._replace(floor_map=regions.floor_map.copy()), **own)


def kept(engine: Engine) -> list[Any]:
    """What changes of a state, to go back to: what is added to it later is not counted there."""
    return [part.copy() for part in (*_changing(engine), engine.regions.floor_map)]


def go_back(engine: Engine, parts: list[Any]) -> None:
    """Make a state again what it was when its parts were kept."""
    for part, before in zip((*_changing(engine), engine.regions.floor_map), parts, strict=True):
        part[...] = before


def led_rows(engine: Engine) -> FloatArray:
    """The pieces (n, 21) of the ways along which discs are driven."""
    motions = [engine.pieces[first:last] for first, last in engine.drives.tolist() if first < last]
    return np.concatenate([engine.pieces[:0], *motions])

"""The engine played on: what it needs to go on, and why it does not."""

from __future__ import annotations

import math
from collections import deque
from typing import Any

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.errors import InputError, PuckError
from puck_tables.kernels.compile import entry_of
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.world import engine_state as g
from puck_tables.world.contact_row import FIRST_N, E
from puck_tables.world.engine import NOBODY, THOSE_LEFT, advance, lacks_rows
from puck_tables.world.lasting import with_law_for
from puck_tables.world.layout import EDGE, KIND, POCKET
from puck_tables.world.lone import LONGEST
from puck_tables.world.named_pucks import pucks_of
from puck_tables.world.record import states_now
from puck_tables.world.segment_starts import Room
from puck_tables.world.setting_off import (
    CROWDED,
    FULL,
    MISPLACED,
    OFF_TABLE,
    PAUSED,
    PUSHING,
    REACHED,
    TOO_SHORT,
    UNSEEN,
)

MOST_EVENTS, MOST_STEPS = 1_000_000, 1_000_000  # of a run: some 120 and 170 MB
CROWD = 1e-7  # of Q/J: 2000 events in less are a crowd
CROWDED_PUSHES, PUSHED_IN = 3000, 1e-3  # and so many new groups that push, in that share of Q/J


class Playing:
    """Pucks on a board, as the engine has them, up to now."""

    scene: SceneSpec
    names: tuple[str, ...]
    _engine: g.Engine
    _room: Room
    _order: g.Whole
    _place: g.Whole
    _obstacles: list[str]
    _entry: tuple[Any, Any] = None, None  # an engine, and what advances just that

    @property
    def time(self) -> float:
        """Now, s."""
        return float(self._engine.clock[0])

    def state(self) -> FloatArray:
        """X, y (m), angle (rad), vx, vy (m/s), spin (rad/s) of every puck now, array (pucks, 6)."""
        return self._all_now()[self._place]

    def _all_now(self) -> FloatArray:
        """States of every puck now, (pucks, 6), in the order of the engine."""
        return states_now(self._engine, self._room.work)

    def _or_as_before(self) -> _OrAsBefore:
        """What is done in it is done as a whole, or not at all."""
        return _OrAsBefore(self)

    def _advance(self, until: float, first: int = NOBODY) -> bool:
        """Let time pass, after an event by hand; False: what was given there is to be looked at."""
        mark, pushes = -math.inf, deque[float](maxlen=CROWDED_PUSHES)
        if lacks_rows(self._engine, self._room):
            self._grow()
        while True:
            how = self._play(until, first)
            if how in (REACHED, UNSEEN):
                return how == REACHED
            unit = float(self._engine.scale[0] / max(self._engine.scale[1], 1e-300))
            first = NOBODY
            if how == FULL:
                self._grow()
                first = THOSE_LEFT
            elif how == PUSHING:
                if self._engine.counts[g.N_PIECES] > MOST_STEPS:
                    raise self._no_end()
                self._engine = with_law_for(
                    self._engine, self._room, self.scene, self._order, self.names, self.time
                )
                full = len(pushes) == CROWDED_PUSHES
                if full and self.time - pushes[0] <= PUSHED_IN * unit:
                    raise PuckError(self._failure(CROWDED))
                pushes.append(self.time)
                self._push_on()
                first = THOSE_LEFT
            elif how == MISPLACED:
                raise InputError(self._overlap())
            elif how == PAUSED and self.time - mark > CROWD * unit:
                mark = self.time
            else:
                raise PuckError(self._failure(CROWDED if how == PAUSED else how))

    def _play(self, until: float, first: int) -> int:
        """Advance the engine, whose types are looked at once."""
        request = self._engine, until, first, self._room
        if self._entry[0] is not self._engine or self._entry[1] is None:
            self._entry = self._engine, entry_of(advance, *request)
        return (self._entry[1] or advance)(*request)

    def _push_on(self) -> None:
        """Send the groups that push now on their way."""
        from puck_tables.world import groups  # compiled where it is needed
        from puck_tables.world.group_paths import workplace_for

        place = workplace_for(self._engine, int(self._engine.counts[g.N_CONTACTS]))
        while (how := groups.push_on(self._engine, self._room, place)) == FULL:
            self._grow()
        if how != REACHED:
            raise PuckError(self._failure(how))

    def _failure(self, how: int) -> str:
        """Why it does not go on, in words."""
        if how == TOO_SHORT:
            return (
                f"at {self.time:.6g} s no step is short enough to follow a puck that is "
                "integrated: ask for a shorter run.time"
            )
        radii = np.array([puck.radius for puck in pucks_of(self.scene)])
        places = self.state()[:, :2]
        for number, puck in enumerate(pucks_of(self.scene)):
            if puck.path:
                gaps = np.hypot(*(places - places[number]).T) - radii - radii[number]
                near = np.flatnonzero(np.abs(gaps) < 1e-6 * radii[number])
                if near.size:
                    others = ", ".join(self.names[one] for one in near)
                    return (
                        f"{self.names[number]}, which is driven, squeezes {others} at "
                        f"{self.time:.6g} s against what does not give way: let its path end "
                        "before, drive it elsewhere, or leave more room"
                    )
        if how == OFF_TABLE:
            return self._off_table()
        return g.TOGETHER.format(time=self.time)

    def _overlap(self) -> str:
        """Who would lie in whom, in words."""
        one, other = self._room.contacts[0].tolist()
        name, depth, partner = self._name(one), float(self._room.work[0]), self._name(other)
        how = f"overlap {partner}"
        if other < 0:
            hole = self._engine.obstacles[-1 - other, KIND] in (POCKET, EDGE)
            how = f"lie in {partner}" if hole else f"reach through {partner}"
        return f"{name} would {how} by {depth:.3g} m: put it elsewhere"

    def _off_table(self) -> str:
        """Which impact is faster than its table of restitution goes."""
        count = self._engine.counts[g.N_CONTACTS]
        n = int(np.flatnonzero(self._room.rows[:count, E] < 0.0)[0])
        one, other = (self._name(number) for number in self._room.contacts[n])
        return (
            f"{one} and {other} meet at {self._room.rows[n, FIRST_N]:.6g} m/s, faster than their "
            "table of restitution goes: add a row to it for such a speed"
        )

    def _grow(self) -> None:
        """Twice the rows of what lacks some: events and segments, or pieces of paths and works."""
        if len(self._engine.events) > MOST_EVENTS:
            raise PuckError(self._failure(CROWDED))
        few, names = 0, ("events", "history")
        if not lacks_rows(self._engine, self._room):
            few, names = LONGEST, ("pieces", "work_rows")
            if len(self._engine.pieces) > MOST_STEPS:
                raise self._no_end()
        more: dict[str, Any] = {}
        for name in names:
            part = getattr(self._engine, name)
            more[name] = np.vstack([part, np.zeros((max(few, len(part)), part.shape[1]))])
        self._engine = self._engine._replace(**more)

    def _no_end(self) -> PuckError:
        """After a million steps."""
        lateral, long = self.scene.lateral, f"a million steps by {self.time:.6g} s"
        if lateral.strength != 0.0 and lateral.speed_exponent < 1.0:
            return InputError(
                f"{long}: the slower a puck that still spins, the faster a lateral force turns its "
                "way if lateral.speed_exponent is below 1; give one from 1 on, or end the run "
                "before with a time"
            )
        return PuckError(f"{long}, and no end: ask for a shorter time")

    def _name(self, partner: float) -> str:
        """A disc or an obstacle of the engine in words."""
        number = int(partner)
        return self._obstacles[-1 - number] if number < 0 else self.names[self._order[number]]


class _OrAsBefore:
    """Takes a world back to what it was where what is done fails."""

    def __init__(self, world: Playing) -> None:
        self._world = world

    def __enter__(self) -> None:
        self._before, self._parts = self._world.__dict__.copy(), g.kept(self._world._engine)

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        if kind is not None:
            g.go_back(self._before["_engine"], self._parts)
            self._world.__dict__.clear()
            self._world.__dict__.update(self._before)

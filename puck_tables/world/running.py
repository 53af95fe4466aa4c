"""A scene that runs: what is, was and will be, and what the engine needs to go on."""

from __future__ import annotations

import math
from collections import deque
from typing import Any, Self

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray, finite_array, real
from puck_tables.errors import InputError, PuckError
from puck_tables.kernels.compile import entry_of
from puck_tables.scene.pucks_and_posts import called_line
from puck_tables.scene.run import Event
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.world import engine_state as g
from puck_tables.world import passings
from puck_tables.world.agreement import refuse_endless
from puck_tables.world.contact_row import FIRST_N, E
from puck_tables.world.engine import EVERYBODY, NOBODY, THOSE_LEFT, advance, lacks_rows
from puck_tables.world.lasting import (
    GOES_ON,
    LEADS_ON,
    NEVER_ENDS,
    ROUND,
    fill_motion_ends,
    limits_of,
    next_target,
    with_law_for,
)
from puck_tables.world.layout import EDGE, KIND, POCKET
from puck_tables.world.lone import LONGEST
from puck_tables.world.named_pucks import called, pucks_of
from puck_tables.world.obstacles import obstacle_names
from puck_tables.world.passings import Passings
from puck_tables.world.prepare import Start, prepared, shipped_lookups
from puck_tables.world.record import Reported, states_at, states_now
from puck_tables.world.segment import GONE, START, moves_until
from puck_tables.world.segment_starts import room_for
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


class Running:
    """Pucks on a board from now on, with nobody's hand in it: see :class:`puck_tables.World`."""

    _entry: tuple[Any, Any] = None, None  # an engine, and what advances just that

    def __init__(self, scene: SceneSpec) -> None:
        if not isinstance(scene, SceneSpec):
            raise InputError(f"scene must be a Scene, got a {type(scene).__name__}")
        self._set_off(prepared(scene.single()))

    @classmethod
    def since(cls, start: Start) -> Self:
        """The world of a scene that is prepared."""
        world = object.__new__(cls)
        world._set_off(start)
        return world

    def _set_off(self, start: Start) -> None:
        self.scene, self._order = start.scene, start.order
        self._engine, self._room = g.copy_of(start.engine), room_for(len(start.order))
        self._room.states[:] = start.states
        self._described: dict[int, Reported] = {}  # until when what pushed back discs was told
        self._named()
        pucks = pucks_of(self.scene)
        rimless = [not pucks[number].has_rim for number in self._order]
        self._passings = Passings(self.scene.lines, len(self.names), rimless)
        self._advance(0.0, EVERYBODY)

    def _named(self) -> None:
        """Who is where in the engine's order, and what they are called."""
        self._place = np.argsort(self._order)
        pucks = pucks_of(self.scene)
        self.names = tuple(called(puck, number) for number, puck in enumerate(pucks))
        self._obstacles = obstacle_names(self.scene)

    def __repr__(self) -> str:
        title = f"{self.scene.title}, " if self.scene.title else ""
        moving = int(self.moving.sum())
        count = f"{len(self.names)} pucks, {moving} moving"
        return f"{type(self).__name__}({title}{count}, at {self.time:.6g} s)"

    @property
    def time(self) -> float:
        """Now, s."""
        return float(self._engine.clock[0])

    @property
    def in_play(self) -> npt.NDArray[np.bool_]:
        """Which pucks are in no pocket and over no edge, array (pucks,)."""
        return self._engine.kinds[self._place] != GONE

    @property
    def groups(self) -> int:
        """How many groups of pucks have pushed each other."""
        return int(self._engine.counts[g.N_GROUPS])

    @property
    def moving(self) -> npt.NDArray[np.bool_]:
        """Which pucks move, if only with the floor, array (pucks,)."""
        return (self._rests > self.time)[self._place]

    @property
    def _rests(self) -> FloatArray:
        """When each disc comes to rest if nothing happens before; −inf: it lies, inf: never."""
        segments = zip(self._engine.kinds.tolist(), self._engine.segments, strict=True)
        return np.array([moves_until(kind, segment) for kind, segment in segments])

    @property
    def stop_times(self) -> FloatArray:
        """When each puck came or will come to rest if nothing happens before, array (pucks,), s.

        Of one that has left play: when it left; inf: never.
        """
        rests: FloatArray = np.maximum(self._rests, self._engine.segments[:, START])
        return rests[self._place]

    @property
    def last_motion(self) -> float:
        """When the last puck came or will come to rest if nothing happens before, s."""
        return float(self.stop_times.max())

    @property
    def motion_ends(self) -> FloatArray:
        """Until when each puck has moved over its floor, or when it left play, array (pucks,), s.

        inf: it still moves; 0: it has lain there since the start.
        """
        found = np.empty(len(self.names))
        fill_motion_ends(self._engine, self._room, found)
        return found[self._place]

    def state(self) -> FloatArray:
        """X, y (m), angle (rad), vx, vy (m/s), spin (rad/s) of every puck now, array (pucks, 6)."""
        state: FloatArray = self._all_now()[self._place]
        return state

    def _all_now(self) -> FloatArray:
        """States of every puck now, (pucks, 6), in the order of the engine."""
        return states_now(self._engine, self._room.work)

    def at(self, time: float) -> FloatArray:
        """States (pucks, 6) at any time: as they were, or will be if nobody interferes.

        Raises
        ------
        InputError
            If the time is no number ≥ 0.
        """
        moment = real("time", time, "s")
        if not moment >= 0.0:
            raise InputError(f"time must not be negative, got {moment:g} s")
        world = self
        if moment > self.time:
            world = self.copy()
            world.advance(moment - self.time)
        return world._states(np.array([moment]))[0]

    def over(self, times: npt.ArrayLike) -> FloatArray:
        """States at times of the past, ascending, array (times, pucks, 6)."""
        moments = np.atleast_1d(finite_array("times", times, "s"))
        if moments.ndim != 1 or (np.diff(moments) < 0.0).any() or (moments < 0.0).any():
            raise InputError("times must be a list of ascending numbers >= 0 s")
        if moments.size and moments[-1] > self.time:
            raise InputError(
                f"times must not lie after now, {self.time:g} s: advance before, or use at"
            )
        return self._states(moments)

    def _states(self, times: FloatArray) -> FloatArray:
        states: FloatArray = states_at(self._engine, times)[:, self._place]
        return states

    def advance(self, duration: float) -> list[Event]:
        """Let time pass; what happened in it.

        Parameters
        ----------
        duration : s, ≥ 0; inf: until nothing more can happen

        Raises
        ------
        InputError
            If it is no such number, or inf where pucks never come to rest.
        PuckError
            If events crowd together without end.
        """
        endless = isinstance(duration, float) and duration == math.inf
        span = math.inf if endless else real("duration", duration, "s")
        if not span >= 0.0:
            raise InputError(f"duration must not be negative, got {span:g} s")
        before, until = int(self._engine.counts[g.N_EVENTS]), self.time + span
        passed = len(self._passings.rows)
        if span == math.inf:
            self.come_to_rest()
        elif self._next_moment() > until:
            self._engine.clock[0] = until
        else:
            with self._or_as_before():
                self._advance(until)
        self._passings.follow(self._engine)
        return self._events(before, passed)

    def _next_moment(self) -> float:
        """When something happens next, s."""
        done, later = int(self._engine.counts[g.N_LAUNCHES]), self._engine.launches
        coming = float(self._engine.next_time.min())
        return min(coming, float(later[done, 0])) if done < len(later) else coming

    def come_to_rest(self) -> tuple[float, bool]:
        """Let time pass until nothing more can happen; since when that is so, s.

        And whether a floor that turns goes on to carry pucks over the same borders, turn after
        turn: one whole turn is followed.

        Raises
        ------
        InputError, PuckError
            As :meth:`advance`.
        """
        refuse_endless(self.scene)
        with self._or_as_before():
            return self._come_to_rest()

    def _come_to_rest(self) -> tuple[float, bool]:
        limits, given = limits_of(self._engine, self._engine.scale[None, :2])
        ends, how, target = np.empty(len(self.names)), GOES_ON, self.time
        while how == GOES_ON:
            self._advance(target)
            how, target = next_target(self._engine, float(limits[0]), given, self._room, ends)
        who = "a puck" if len(self.names) > 1 else "the puck"
        if how == NEVER_ENDS:
            raise InputError(
                f"{who} still moves after {target:.4g} s, a hundred times what friction "
                "takes: it may never stop; give a time"
            )
        if how == LEADS_ON:
            raise InputError(
                f"after {target:.4g} s the floor still carries {who} towards a wall, an edge, a "
                "border or a patch, and it may slip there again; give a time"
            )
        if self._engine.surface.spin == 0.0:  # it was waited for what may come
            self._engine.clock[0] = target
        return float(target), how == ROUND

    def events_since(self, time: float) -> list[Event]:
        """What happened from a time on."""
        moment = real("time", time, "s")
        self._passings.follow(self._engine)
        times = self._engine.events[: self._engine.counts[g.N_EVENTS], g.TIME]
        passed = self._passings.rows[:, passings.TIME]
        return self._events(*(int(np.searchsorted(one, moment)) for one in (times, passed)))

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
        asked = self._engine, until, first, self._room
        if self._entry[0] is not self._engine or self._entry[1] is None:
            self._entry = self._engine, entry_of(advance, *asked)
        how: int = (self._entry[1] or advance)(*asked)
        return how

    def _push_on(self) -> None:
        """Send the groups that push now on their way."""
        from puck_tables.world import groups  # compiled where it is needed
        from puck_tables.world.group_paths import workplace_for

        place = workplace_for(self._engine, int(self._engine.counts[g.N_CONTACTS]))
        while (how := groups.push_on(self._engine, self._room, place)) == FULL:
            self._grow()
        if how != REACHED:
            raise PuckError(self._failure(how))

    @property
    def place_error(self) -> float:
        """The rounding of looked-up places, m: 1e-15 of Q²/J of the largest slip."""
        speed, rate = self._engine.scale[:2].tolist()
        return 1e-15 * speed / rate * speed

    def copy(self) -> Self:
        """A world of its own that goes on from here, to look ahead."""
        other = object.__new__(type(self))
        other.__dict__.update(self.__dict__)
        other._engine = g.copy_of(self._engine)
        other._room = room_for(len(self.names))
        other._passings = self._passings.copy()
        return other

    def __getstate__(self) -> dict[str, Any]:
        """All but the table that comes along (read back, of another type to numba) and the room."""
        parts: Any = self._engine
        own = {"_engine": parts._replace(lookups=None), "_room": None, "_entry": (None, None)}
        return self.__dict__ | own

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Take up what was written, with the table that comes along."""
        self.__dict__.update(state)
        self._engine = self._engine._replace(lookups=shipped_lookups())
        self._room = room_for(len(self.names))

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
                        "before, or leave more room"
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

    def _events(self, first: int, passed: int) -> list[Event]:
        count, lines = int(self._engine.counts[g.N_EVENTS]), self.scene.lines
        if first == count and passed == len(self._passings.rows):
            return []
        rows = self._engine.events[first:count]
        columns = [g.TIME, g.WHAT, g.WHO, g.PARTNER, g.AT_X, g.AT_Y, g.APPROACH, g.SLIDE, g.PUSH,
                   g.RUB, g.LOST]  # fmt: skip
        found = [
            Event(
                time,
                g.EVENTS[int(what)],
                self._name(who),
                "floor" if what == g.TIPS else self._name(partner),
                *numbers,
            )
            for time, what, who, partner, *numbers in rows[:, columns].tolist()
        ]
        found += [
            Event(time, g.EVENTS[int(what)], self._name(who), called_line(lines, int(k)), *numbers)
            for time, what, who, k, *numbers in self._passings.rows[passed:].tolist()
        ]
        return sorted(found, key=lambda event: event.time) if lines else found

    def _name(self, partner: float) -> str:
        """A disc or an obstacle of the engine in words."""
        number = int(partner)
        return self._obstacles[-1 - number] if number < 0 else self.names[self._order[number]]


class _OrAsBefore:
    """Takes a world back to what it was where what is done fails."""

    def __init__(self, world: Running) -> None:
        self._world = world

    def __enter__(self) -> None:
        self._before, self._parts = self._world.__dict__.copy(), g.kept(self._world._engine)

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        if kind is not None:
            g.go_back(self._before["_engine"], self._parts)
            self._world.__dict__.clear()
            self._world.__dict__.update(self._before)

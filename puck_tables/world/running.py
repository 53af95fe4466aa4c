"""A scene that runs: what is, was and will be."""

from __future__ import annotations

import math
from typing import Any, Self

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray, finite_array, real
from puck_tables.errors import InputError
from puck_tables.scene.pucks_and_posts import called_line
from puck_tables.scene.run import Event, number_of
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.world import engine_state as g
from puck_tables.world import passings
from puck_tables.world.agreement import refuse_endless
from puck_tables.world.engine import EVERYBODY
from puck_tables.world.lasting import (
    GOES_ON,
    LEADS_ON,
    NEVER_ENDS,
    ROUND,
    fill_motion_ends,
    limits_of,
    next_target,
)
from puck_tables.world.layout import INV_MASS
from puck_tables.world.named_pucks import names_of, pucks_of
from puck_tables.world.obstacles import obstacle_names
from puck_tables.world.passings import Passings
from puck_tables.world.playing import Playing
from puck_tables.world.prepare import Start, prepared, shipped_lookups
from puck_tables.world.record import Reported, pushed_back, states_at
from puck_tables.world.segment import GONE, START, moves_until
from puck_tables.world.segment_starts import room_for


class Running(Playing):
    """Pucks on a board from now on, with nobody's hand in it: see :class:`puck_tables.World`."""

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
        self.names = names_of(self.scene)
        self._obstacles = obstacle_names(self.scene)

    def __repr__(self) -> str:
        title = f"{self.scene.title}, " if self.scene.title else ""
        moving = int(self.moving.sum())
        count = f"{len(self.names)} pucks, {moving} moving"
        return f"{type(self).__name__}({title}{count}, at {self.time:.6g} s)"

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
        ends = np.empty(len(self.names))
        fill_motion_ends(self._engine, self._room, ends)
        return ends[self._place]

    def at(self, time: float) -> FloatArray:
        """States (pucks, 6) at a time: as they were, or will be if nobody interferes.

        ``time``: s, ≥ 0, else InputError.
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
        moments = ascending(times)
        if moments.size and moments[-1] > self.time:
            raise InputError(
                f"times must not lie after now, {self.time:g} s: advance before, or use at"
            )
        return self._states(moments)

    def _states(self, times: FloatArray) -> FloatArray:
        return states_at(self._engine, times)[:, self._place]

    def advance(self, duration: float) -> list[Event]:
        """Let time pass; what happened in it.

        ``duration``: s, ≥ 0; inf: until nothing more can happen.  InputError if it is no such
        number, or inf where pucks never come to rest; PuckError if events crowd together without
        end.
        """
        span = span_of(duration)
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
        turn: one whole turn is followed.  Errors as of :meth:`advance`.
        """
        refuse_endless(self.scene)
        with self._or_as_before():
            return self._come_to_rest()

    def _come_to_rest(self) -> tuple[float, bool]:
        limits, prescribed = limits_of(self._engine, self._engine.scale[None, :2])
        ends, how, target = np.empty(len(self.names)), GOES_ON, self.time
        while how == GOES_ON:
            self._advance(target)
            how, target = next_target(self._engine, float(limits[0]), prescribed, self._room, ends)
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

    def _events(self, first: int, passed: int) -> list[Event]:
        count, lines = int(self._engine.counts[g.N_EVENTS]), self.scene.lines
        if first == count and passed == len(self._passings.rows):
            return []
        rows = self._engine.events[first:count, : g.REPORTED]
        events = [
            Event(
                time,
                g.EVENTS[int(what)],
                self._name(who),
                "floor" if what == g.TIPS else self._name(partner),
                *numbers,
            )
            for time, what, who, partner, *numbers in rows.tolist()
        ]
        events += [
            Event(time, g.EVENTS[int(what)], self._name(who), called_line(lines, int(k)), *numbers)
            for time, what, who, k, *numbers in self._passings.rows[passed:].tolist()
        ]
        return sorted(events, key=lambda event: event.time) if lines else events

    def reaction(self, puck: int | str) -> FloatArray:
        """What pucks gave one that is driven since the last call, array (2,), N s.

        The impulses of impacts, and the forces, over their time, of pucks that it pushes.  NaN
        where several driven ones pushed the same pucks, for nobody knows how these share it.  What
        rims without a bound on their friction give as they grip at once is left out where a cushion
        takes part.  InputError if there is no such puck, or it is not driven.

        >>> from puck_tables import Puck, Scene
        >>> mallet = Puck(0.05, path=[[0, -0.2, 0]], name="mallet")
        >>> world = Scene(pucks=[mallet, Puck(0.03, mass=0.1, friction=0.1)]).world()
        >>> world.drive("mallet", (1.0, 0.0))
        >>> _ = world.advance(0.5)
        >>> world.reaction("mallet").round(6).tolist()                     # 2 m v, e = 1
        [-0.2, 0.0]
        """
        i = self._led(puck, False)
        impulse, reported = pushed_back(self._engine, i, self._described.get(i, Reported()))
        self._described = {**self._described, i: reported}
        return impulse

    def _in_play(self, puck: int | str) -> int:
        """The disc of a puck."""
        i = int(self._place[number_of(puck, self.names)])
        if self._engine.kinds[i] == GONE:
            raise InputError(f"{self._name(i)} is no longer in play: place puts it back")
        return i

    def _led(self, puck: int | str, in_play: bool = True) -> int:
        """The disc of a puck that is led."""
        i = self._in_play(puck) if in_play else int(self._place[number_of(puck, self.names)])
        if self._engine.discs[i, INV_MASS] > 0.0:
            raise InputError(
                f"{self._name(i)} is not led by hand: give it a path of one row, path=[[0, x, y]], "
                "or strike it"
            )
        return i


def ascending(times: npt.ArrayLike) -> FloatArray:
    """When states are wanted, checked."""
    moments = np.atleast_1d(finite_array("times", times, "s"))
    if moments.ndim != 1 or (moments < 0.0).any() or (np.diff(moments) < 0.0).any():
        raise InputError("times must be a list of ascending numbers >= 0 s")
    return moments


def span_of(duration: float) -> float:
    """How long time is to pass, s; infinite: until nothing more can happen."""
    if isinstance(duration, float) and duration == math.inf:
        return duration
    span = real("duration", duration, "s")
    if not span >= 0.0:
        raise InputError(f"duration must not be negative, got {span:g} s")
    return span

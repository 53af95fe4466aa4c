"""A scene that is played on: for a game, a robot, a look ahead."""

from __future__ import annotations

import math
from collections import deque
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables._core.real import finite_array, real
from puck_tables.errors import InputError, PuckError
from puck_tables.scene.friction import SPIN, VX, VY
from puck_tables.scene.holds import misfits
from puck_tables.scene.parts import Launch
from puck_tables.scene.pieces import called_line
from puck_tables.scene.run import Event, number_of
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.world import game as g
from puck_tables.world import passings
from puck_tables.world.agreement import called, pieces_of, refuse_endless
from puck_tables.world.departures import desk_for, room_for
from puck_tables.world.engine import (
    CROWDED,
    EVERYBODY,
    FULL,
    NOBODY,
    OFF_TABLE,
    PAUSED,
    PUSHING,
    REACHED,
    THOSE_LEFT,
    TOO_SHORT,
    advance,
    lacks_rows,
)
from puck_tables.world.flight import GONE, START, moves_until
from puck_tables.world.holds import response
from puck_tables.world.impact import FIRST_N, E
from puck_tables.world.lasting import (
    FOR_EVER,
    GOES_ON,
    LEADS_ON,
    ROUND,
    fill_motion_ends,
    limits_of,
    next_target,
)
from puck_tables.world.law_range import refuse_too_fast, with_law_for
from puck_tables.world.layout import LIGHTNESS, RADIUS
from puck_tables.world.lone import LONGEST
from puck_tables.world.passings import Passings
from puck_tables.world.prepare import Start, obstacle_names, prepared, set_pace, shipped_curves
from puck_tables.world.record import states_at

MOST_EVENTS, MOST_STEPS = 1_000_000, 1_000_000
CROWD = 1e-7  # of Q/J: 2000 events in less are a crowd
CROWDED_PUSHES, PUSHED_IN = 3000, 1e-3  # and so many new groups that push, in that share of Q/J


class World:
    """Pucks on a board, from now on.

    It is made by :meth:`puck_tables.Scene.world`.  Nothing is stepped: between two events every
    puck is on a curve that is known as a whole, so a call costs what happens in it.  The same calls
    give the same bits, also of copies and of what was saved.

    Parameters
    ----------
    scene : SceneSpec
        Without ranges.

    Raises
    ------
    InputError
        If a number of the scene is a range.

    Examples
    --------
    >>> from puck_tables import Launch, Piece, Scene
    >>> one = Piece(0.03, friction=0.1, launch=Launch((1.0, 0.0)))
    >>> two = Piece(0.03, friction=0.1, launch=Launch(position=(0.2, 0.0)))
    >>> world = Scene(pucks=[one, two]).world()
    >>> [event.what for event in world.advance(0.2)]
    ['impact']
    >>> world.state()[:, 3].round(6).tolist()
    [0.0, 0.803867]
    """

    def __init__(self, scene: SceneSpec) -> None:
        if not isinstance(scene, SceneSpec):
            raise InputError(f"scene must be a Scene, got a {type(scene).__name__}")
        self._set_off(prepared(scene.single()))

    @classmethod
    def since(cls, start: Start) -> World:
        """The world of a scene that is prepared."""
        world = object.__new__(cls)
        world._set_off(start)
        return world

    def _set_off(self, start: Start) -> None:
        self.scene, self._order = start.scene, start.order
        self._game, self._room = g.copy_of(start.game), room_for(len(start.order))
        self._room.states[:] = start.states
        self._desk = desk_for(self._game)
        self._named()
        pieces = pieces_of(self.scene)
        rimless = [not pieces[number].has_rim for number in self._order]
        self._passings = Passings(self.scene.lines, len(self.names), rimless)
        self._advance(0.0, EVERYBODY)

    def _named(self) -> None:
        """Who is where in the engine's order, and what they are called."""
        self._place = np.argsort(self._order)
        pieces = pieces_of(self.scene)
        self.names = tuple(called(piece, number) for number, piece in enumerate(pieces))

    def __repr__(self) -> str:
        title = f"{self.scene.title}, " if self.scene.title else ""
        moving = int(self.moving.sum())
        return f"World({title}{len(self.names)} pucks, {moving} moving, at {self.time:.6g} s)"

    @property
    def time(self) -> float:
        """Now, s."""
        return float(self._game.clock[0])

    @property
    def in_play(self) -> npt.NDArray[np.bool_]:
        """Which pucks are in no pocket and over no edge, array (pucks,)."""
        return self._game.kinds[self._place] != GONE

    @property
    def groups(self) -> int:
        """How many groups of pucks have pushed each other."""
        return int(self._game.counts[g.N_GROUPS])

    @property
    def moving(self) -> npt.NDArray[np.bool_]:
        """Which pucks move, if only with the floor, array (pucks,)."""
        return (self._rests > self.time)[self._place]

    @property
    def _rests(self) -> FloatArray:
        """When each disc comes to rest if nothing happens before; −inf: it lies, inf: never."""
        flights = zip(self._game.kinds.tolist(), self._game.flights, strict=True)
        return np.array([moves_until(kind, flight) for kind, flight in flights])

    @property
    def stop_times(self) -> FloatArray:
        """When each puck came or will come to rest if nothing happens before, array (pucks,), s.

        Of one that has left play: when it left; inf: never.
        """
        rests: FloatArray = np.maximum(self._rests, self._game.flights[:, START])
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
        fill_motion_ends(self._game, self._room, found)
        return found[self._place]

    def state(self) -> FloatArray:
        """X, y (m), angle (rad), vx, vy (m/s), spin (rad/s) of every puck now, array (pucks, 6)."""
        return self._states(np.array([self.time]))[0]

    def at(self, time: float) -> FloatArray:
        """The same at any time: as it was, or as it will be if nobody interferes.

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
        """The same at times of the past, ascending, array (times, pucks, 6)."""
        moments = np.atleast_1d(finite_array("times", times, "s"))
        if moments.ndim != 1 or (np.diff(moments) < 0.0).any() or (moments < 0.0).any():
            raise InputError("times must be a list of ascending numbers >= 0 s")
        if moments.size and moments[-1] > self.time:
            raise InputError(
                f"times must not lie after now, {self.time:g} s: advance before, or use at"
            )
        return self._states(moments)

    def _states(self, times: FloatArray) -> FloatArray:
        states: FloatArray = states_at(self._game, times)[:, self._place]
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
        before = int(self._game.counts[g.N_EVENTS]), len(self._passings.rows)
        if span == math.inf:
            self.come_to_rest()
        else:
            self._advance(self.time + span)
        self._passings.follow(self._game)
        return self._events(*before)

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
        limits, given = limits_of(self._game, self._game.pace[None, :2])
        ends, how, target = np.empty(len(self.names)), GOES_ON, self.time
        while how == GOES_ON:
            self._advance(target)
            how, target = next_target(self._game, float(limits[0]), given, self._room, ends)
        who = "a puck" if len(self.names) > 1 else "the puck"
        if how == FOR_EVER:
            raise InputError(
                f"{who} still moves after {target:.4g} s, a hundred times what friction "
                "takes: it may never stop; give a time"
            )
        if how == LEADS_ON:
            raise InputError(
                f"after {target:.4g} s the floor still carries {who} towards a wall, an edge, a "
                "border or a patch, and it may slip there again; give a time"
            )
        if self._game.surface.spin == 0.0:  # it was waited for what may come
            self._game.clock[0] = target
        return target, how == ROUND

    def events_since(self, time: float) -> list[Event]:
        """What happened from a time on."""
        moment = real("time", time, "s")
        self._passings.follow(self._game)
        times = self._game.events[: self._game.counts[g.N_EVENTS], g.TIME]
        passed = self._passings.rows[:, passings.TIME]
        return self._events(*(int(np.searchsorted(one, moment)) for one in (times, passed)))

    def strike(
        self, puck: int | str, velocity: npt.ArrayLike | None = None, spin: float | None = None,
        *, impulse: npt.ArrayLike | None = None, point: npt.ArrayLike | None = None,
    ) -> None:  # fmt: skip
        """Send a puck off, now: with a velocity and spin, or by an impulse at a point.

        Parameters
        ----------
        puck : its number, or its name
        velocity : (2,) m/s, spin : rad/s, optional
            Left out: as they are.
        impulse : (2,) N s, optional
            Beside them, at ``point`` (2,) m, of the laboratory; left out at its centre.

        Raises
        ------
        InputError
            If there is no such puck, it is not in play or driven, or a number is not finite.
        """
        i = int(self._place[number_of(puck, self.names)])
        if self._game.kinds[i] == GONE:
            raise InputError(f"{self.names[self._order[i]]} is no longer in play")
        if self._game.discs[i, LIGHTNESS] == 0.0:
            raise InputError(f"{self.names[self._order[i]]} is driven along its path")
        state = states_at(self._game, np.array([self.time]))[0, i]
        if velocity is not None:
            state[VX : VY + 1] = _pair("velocity", velocity, "m/s")
        if spin is not None:
            state[SPIN] = real("spin", spin, "rad/s")
        if impulse is not None:
            push, disc = _pair("impulse", impulse, "N s"), self._game.discs[i]
            arm = np.zeros(2) if point is None else _pair("point", point, "m") - state[:2]
            if math.hypot(*arm) > disc[RADIUS] * (1.0 + 1e-9):
                raise InputError(f"point must lie on the puck, at most {disc[RADIUS]:g} m from its "
                                 "centre")  # fmt: skip
            moment = float(arm[0] * push[1] - arm[1] * push[0])
            state[VX:] += response(disc, state, float(push[0]), float(push[1]), moment)
        elif point is not None:
            raise InputError("point is where an impulse acts: give the impulse, too")
        self._refuse_misfit(int(self._order[i]), state)
        refuse_too_fast(self._game, self.scene, self.names[self._order[i]], i, state)
        self._advance(self.time, i, state)

    def _refuse_misfit(self, number: int, state: FloatArray) -> None:
        """Refuse a velocity that the constraint of a puck does not allow."""
        x, y, angle, vx, vy, spin = state.tolist()
        launch = Launch((vx, vy), spin, (x, y), angle)
        hold = pieces_of(self.scene)[number].constraint
        for fault in misfits(launch, hold, self.scene.floor, ""):
            raise InputError(f"{self.names[number]}: {fault}".replace("launch.", ""))

    def _advance(self, until: float, struck: int = NOBODY, given: FloatArray | None = None) -> None:
        """Let time pass, after a disc was given the velocity of a state."""
        state = self._room.one if given is None else given
        unit = float(self._game.pace[0] / max(self._game.pace[1], 1e-300))
        mark, pushes = -math.inf, deque[float](maxlen=CROWDED_PUSHES)
        if lacks_rows(self._game, self._room):
            self._grow()
        if struck >= 0:
            set_pace(self._game, state[None] * np.ones((len(self._game.discs), 1)))
        while True:
            how = advance(self._game, until, struck, state, self._room, self._desk)
            if how == REACHED:
                return
            struck = NOBODY
            if how == FULL:
                self._grow()
                struck = THOSE_LEFT
            elif how == PUSHING:
                from puck_tables.world.groups import push_on  # compiled where it is needed

                if self._game.counts[g.N_PIECES] > MOST_STEPS:
                    raise self._no_end()
                self._game = with_law_for(
                    self._game, self._room, self.scene, self._order, self.names, self.time
                )
                full = len(pushes) == CROWDED_PUSHES
                if full and self.time - pushes[0] <= PUSHED_IN * unit:
                    raise PuckError(self._failure(CROWDED))
                pushes.append(self.time)
                self._game, struck = push_on(self._game, self._room), THOSE_LEFT
            elif how == PAUSED and self.time - mark > CROWD * unit:
                mark = self.time
            else:
                raise PuckError(self._failure(CROWDED if how == PAUSED else how))

    @property
    def place_error(self) -> float:
        """The rounding of looked-up places, m: 1e-15 of Q²/J of the largest slip."""
        speed, rate = self._game.pace[:2].tolist()
        return 1e-15 * speed / rate * speed

    def copy(self) -> World:
        """A world of its own that goes on from here, to look ahead."""
        other = object.__new__(World)
        other.scene, other._order = self.scene, self._order
        other._game = g.copy_of(self._game)
        other._room, other._desk = room_for(len(self.names)), desk_for(other._game)
        other._passings = self._passings.copy()
        other._named()
        return other

    def __getstate__(self) -> dict[str, Any]:
        """All but the table that comes along: read back, it would be of another type to numba."""
        parts: Any = self._game
        return {**self.__dict__, "_game": parts._replace(curves=None)}

    def __setstate__(self, state: dict[str, Any]) -> None:
        """As it was, with the table that comes along."""
        self.__dict__.update(state)
        self._game = self._game._replace(curves=shipped_curves())

    def _failure(self, how: int) -> str:
        """Why it does not go on, in words."""
        if how == TOO_SHORT:
            return (
                f"at {self.time:.6g} s no step is short enough to follow a puck that is "
                "integrated: ask for a shorter run.time"
            )
        radii = np.array([piece.radius for piece in pieces_of(self.scene)])
        places = self.state()[:, :2]
        for number, piece in enumerate(pieces_of(self.scene)):
            if piece.path:
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

    def _off_table(self) -> str:
        """Which impact is faster than its table of restitution goes."""
        count = self._game.counts[g.N_CONTACTS]
        n = int(np.flatnonzero(self._room.rows[:count, E] < 0.0)[0])
        one, other = (self._name(number) for number in self._room.contacts[n])
        return (
            f"{one} and {other} meet at {self._room.rows[n, FIRST_N]:.6g} m/s, faster than their "
            "table of restitution goes: add a row to it for such a speed"
        )

    def _grow(self) -> None:
        """Twice the rows of what lacks some: events and flights, or pieces of paths and works."""
        if len(self._game.events) > MOST_EVENTS:
            raise PuckError(self._failure(CROWDED))
        few, names = 0, ("events", "history")
        if not lacks_rows(self._game, self._room):
            few, names = LONGEST, ("pieces", "works")
            if len(self._game.pieces) > MOST_STEPS:
                raise self._no_end()
        more: dict[str, Any] = {}
        for name in names:
            part = getattr(self._game, name)
            more[name] = np.vstack([part, np.zeros((max(few, len(part)), part.shape[1]))])
        self._game = self._game._replace(**more)

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
        rows = self._game.events[first : self._game.counts[g.N_EVENTS]]
        columns = [g.TIME, g.WHAT, g.WHO, g.PARTNER, g.AT_X, g.AT_Y, g.APPROACH, g.SLIDE, g.PUSH,
                   g.RUB, g.LOST]  # fmt: skip
        found = [
            Event(time, g.EVENTS[int(what)], self._name(who), self._name(partner), *numbers)
            for time, what, who, partner, *numbers in rows[:, columns].tolist()
        ]
        lines = self.scene.lines
        found += [
            Event(time, g.EVENTS[int(what)], self._name(who), called_line(lines, int(k)), *numbers)
            for time, what, who, k, *numbers in self._passings.rows[passed:].tolist()
        ]
        return sorted(found, key=lambda event: event.time) if lines else found

    @cached_property
    def _obstacles(self) -> list[str]:
        return obstacle_names(self.scene)

    def _name(self, partner: float) -> str:
        """A disc or an obstacle of the engine in words."""
        number = int(partner)
        return self._obstacles[-1 - number] if number < 0 else self.names[self._order[number]]


def _pair(name: str, values: npt.ArrayLike, unit: str) -> FloatArray:
    pair = finite_array(name, values, unit)
    if pair.shape != (2,):
        raise InputError(f"{name} must be two numbers in {unit}, got the shape {pair.shape}")
    return pair

"""A scene that is played on: for a game, a robot, a look ahead, an agent that learns."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray, finite_array, positive, real
from puck_tables.errors import InputError
from puck_tables.scene.friction import SPIN, VX, VY
from puck_tables.scene.ingredients import FREE
from puck_tables.scene.launch_constraints import misfits
from puck_tables.scene.parts import Launch
from puck_tables.scene.pucks_and_posts import ScenePuck
from puck_tables.scene.run import number_of
from puck_tables.world import engine_state as g
from puck_tables.world.added import board_with, with_puck
from puck_tables.world.by_hand import (
    lead,
    led_state,
    refuse_off_hold,
    row_of,
    slips_of,
    two_of,
    with_force,
    with_room_to_lead,
)
from puck_tables.world.floor_under import law_goes_to, moves_along
from puck_tables.world.holds import response
from puck_tables.world.lasting import refuse_too_fast
from puck_tables.world.layout import HOLD, INV_MASS, RADIUS
from puck_tables.world.named_pucks import pucks_of
from puck_tables.world.paths import FOR_EVER
from puck_tables.world.prepare import set_scales
from puck_tables.world.running import Running
from puck_tables.world.segment import GONE
from puck_tables.world.segment_starts import BY_HAND, CURRENT, STALE, room_for

_ALL = slice(None)


class World(Running):
    """Pucks on a board, from now on.

    It is made by :meth:`puck_tables.Scene.world`.  Nothing is stepped: between two events every
    puck is on a curve that is known as a whole, so a call costs what happens in it.  The same calls
    give the same bits, also of copies and of what was saved.  A call that is refused, or fails,
    changes nothing.

    A puck whose ``path`` is one row, ``path=[[0, x, y]]``, is led by hand: :meth:`drive` moves it,
    and nothing that it meets does.  One of finite mass that a hand holds is any puck to which
    :meth:`strike` gives a velocity every frame.

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
    >>> from puck_tables import Launch, Puck, Scene
    >>> one = Puck(0.03, friction=0.1, launch=Launch((1.0, 0.0)))
    >>> two = Puck(0.03, friction=0.1, launch=Launch(position=(0.2, 0.0)))
    >>> world = Scene(pucks=[one, two]).world()
    >>> [event.what for event in world.advance(0.2)]
    ['impact']
    >>> world.state()[:, 3].round(6).tolist()
    [0.0, 0.803867]
    """

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
        i = self._in_play(puck)
        if self._engine.discs[i, INV_MASS] == 0.0:
            raise InputError(f"{self._name(i)} is driven along its path: drive leads it")
        row = row_of(None, None, velocity, spin)
        if impulse is not None:
            state, disc = self._all_now()[i], self._engine.discs[i]
            state = np.where(np.isnan(row), state, row)
            push = two_of("impulse", impulse, "N s")
            arm = np.zeros(2) if point is None else two_of("point", point, "m") - state[:2]
            if math.hypot(*arm) > disc[RADIUS] * (1.0 + 1e-9):
                raise InputError(f"point must lie on the puck, at most {disc[RADIUS]:g} m from its "
                                 "centre")  # fmt: skip
            moment = float(arm[0] * push[1] - arm[1] * push[0])
            row[VX:] = state[VX:] + response(disc, state, float(push[0]), float(push[1]), moment)
        elif point is not None:
            raise InputError("point is where an impulse acts: give the impulse, too")
        self._put(g.STRUCK, row, i)

    def place(
        self, puck: int | str, position: npt.ArrayLike | None = None, angle: float | None = None,
        velocity: npt.ArrayLike | None = None, spin: float | None = None,
    ) -> None:  # fmt: skip
        """Put a puck somewhere, now, also back from a pocket; an event says "placed".

        What it has then more of kinetic energy is booked as given.

        Parameters
        ----------
        puck : its number, or its name
        position : (2,) m, angle : rad, velocity : (2,) m/s, spin : rad/s, optional
            Left out: as they are.  One that comes back needs a position, and is at rest if left so.

        Raises
        ------
        InputError
            If there is no such puck, a number is not finite, or it would overlap a puck or a
            cushion, or lie in a hole: with whom, and by how much.

        Examples
        --------
        >>> from puck_tables import Puck, Scene
        >>> world = Scene(pucks=[Puck(0.03, friction=0.1)]).world()
        >>> world.place(0, (0.5, 0.0), velocity=(0.2, 0.0))
        >>> world.advance(9.0), world.state()[0, 0].round(6).item()      # 0.5 + v^2/2fg
        ([], 0.520394)
        """
        i = int(self._place[number_of(puck, self.names)])
        row = row_of(position, angle, velocity, spin)
        if self._engine.kinds[i] == GONE and position is None:
            raise InputError(f"{self._name(i)} is not in play: give the position to put it at")
        self._put(g.PLACED, row, i)

    def set_state(self, states: npt.ArrayLike) -> None:
        """Put all pucks into states, as :meth:`state` gives them; of each that changes an event.

        One out of play stays so where its row is what it was; else it comes back.

        Parameters
        ----------
        states : (pucks, 6): x, y m, angle rad, vx, vy m/s, spin rad/s

        Raises
        ------
        InputError
            If they are no such numbers, or pucks would overlap, as :meth:`place`.

        Examples
        --------
        >>> from puck_tables import Launch, Puck, Scene
        >>> world = Scene(pucks=[Puck(0.03, friction=0.1, launch=Launch((1.0, 0.0)))]).world()
        >>> start = world.state()
        >>> _ = world.advance(0.3)
        >>> world.set_state(start)                                       # again from where it was
        >>> world.state()[0].tolist()
        [0.0, 0.0, 0.0, 1.0, 0.0, 0.0]
        """
        rows = finite_array("states", states, "m, rad, m/s, rad/s")
        if rows.shape != (len(self.names), 6):
            raise InputError(
                f"states must be rows of 6 numbers for {len(self.names)} pucks, got the shape "
                f"{rows.shape}"
            )
        rows, kinds = rows.take(self._order, 0), self._engine.kinds
        if GONE in kinds.tolist():
            back = (kinds != GONE) | (rows != self._all_now()).any(axis=1)
            if back.any():
                self._put(g.PLACED, rows[back], np.flatnonzero(back))
        else:
            self._put(g.PLACED, rows, _ALL)

    def remove(self, puck: int | str) -> None:
        """Take a puck out of play, now; an event says "removed".  :meth:`place` brings it back.

        Raises
        ------
        InputError
            If there is no such puck in play.

        Examples
        --------
        >>> from puck_tables import Puck, Scene
        >>> world = Scene(pucks=[Puck(0.03, friction=0.1)]).world()
        >>> world.remove(0)
        >>> world.in_play.tolist(), world.events_since(0.0)[0].what
        ([False], 'removed')
        """
        self._put(g.REMOVED, row_of(None, None, None, None), self._in_play(puck))

    def add(self, puck: ScenePuck) -> int:
        """Put a new puck on the board, now, with its launch; its number.  An event says "added".

        Times of its launch, its path and its force count from now.  It takes some ms: arrays are
        made anew.

        Raises
        ------
        InputError
            If it does not go with the board, its name is taken, or it would overlap, as
            :meth:`place`.

        Examples
        --------
        >>> from puck_tables import Launch, Puck, Scene
        >>> world = Scene(pucks=[Puck(0.03, friction=0.1)]).world()
        >>> world.add(Puck(0.02, friction=0.1, launch=Launch((1.0, 0.0), position=(-0.2, 0.0))))
        1
        >>> [event.what for event in world.advance(0.2)]
        ['impact']
        """
        board = board_with(self.scene, puck)
        with self._or_as_before():
            start, state = with_puck(self._engine, board, self._order, self.time)
            self.scene, self._order, self._engine = start.scene, start.order, start.engine
            self._room = room_for(len(start.order))
            self._passings = self._passings.with_disc(puck.has_rim)
            self._named()
            self._put(g.ADDED, state, len(start.order) - 1)
        return len(self.names) - 1

    def drive(
        self, puck: int | str, velocity: npt.ArrayLike | None = None, spin: float = 0.0, *,
        towards: npt.ArrayLike | None = None, speed: float | None = None,
    ) -> None:  # fmt: skip
        """Move a puck that is led by hand, from now on until the next call: a mallet.

        It is one with a ``path``, of one row if it has no way of its own.  It goes straight on
        whatever it meets; walls, posts and arcs stop it, short of them by 1e-9 of its radius.

        Parameters
        ----------
        puck : its number, or its name
        velocity : (2,) m/s
            Or, in its place, ``towards`` (2,) m at a ``speed`` > 0, m/s: where it then stops.
        spin : rad/s

        Raises
        ------
        InputError
            If there is no such puck in play, it is not led by hand, or a number is not finite.
        PuckError
            If it squeezes pucks that touch it, now, against what does not give way: later
            :meth:`advance` raises that.

        Examples
        --------
        >>> from puck_tables import Puck, Scene
        >>> mallet = Puck(0.05, path=[[0, -0.2, 0]], name="mallet")
        >>> world = Scene(pucks=[mallet, Puck(0.03, friction=0.1)]).world()
        >>> world.drive("mallet", towards=(0.0, 0.0), speed=1.0)
        >>> [event.what for event in world.advance(9.0)]
        ['impact']
        >>> world.state().round(6)[:, 0].tolist()                        # v^2/2fg, v = 2 m/s
        [0.0, 2.039432]
        """
        i = self._led(puck)
        turn, state, duration = real("spin", spin, "rad/s"), led_state(self._engine, i), FOR_EVER
        if velocity is not None and towards is None and speed is None:
            state[VX : VY + 1] = two_of("velocity", velocity, "m/s")
        elif velocity is None and towards is not None and speed is not None:
            direction = two_of("towards", towards, "m") - state[:2]
            far, fast = math.hypot(*direction), positive("speed", speed, "m/s")
            duration = far / fast
            state[VX : VY + 1] = fast / far * direction if far > 0.0 else 0.0
        else:
            raise InputError("give a velocity, or towards, where to, with a speed")
        state[SPIN] = turn
        with self._or_as_before():
            self._lead(i, state, duration)
            self._engine.next_time[i], self._engine.next_partner[i] = self.time, g.PATH_ENDS
            self._engine.counts[g.N_AT_ONCE] = 0
            self._advance(self.time)

    def apply_force(
        self, puck: int | str, force: npt.ArrayLike, torque: float = 0.0, *, duration: float
    ) -> None:
        """Let a constant force act on a puck at its centre, from now on for a duration, s > 0.

        Beside all others, as ``Force.over_time`` of a scene.  A puck that was looked up until then
        is integrated from now on.  An event says "force".

        Parameters
        ----------
        puck : its number, or its name
        force : (2,) N, torque : N m

        Raises
        ------
        InputError
            If there is no such puck in play, it is driven, or a number is not finite.

        Examples
        --------
        >>> from puck_tables import Puck, Scene
        >>> world = Scene(pucks=[Puck(0.03, mass=1.0, friction=0.0, gravity=10.0)]).world()
        >>> world.apply_force(0, (2.0, 0.0), duration=0.5)
        >>> _ = world.advance(1.0)
        >>> world.state()[0, [0, 3]].round(9).tolist()            # F t^2/2m + F t/m 0.5 s
        [0.75, 1.0]
        """
        i = self._in_play(puck)
        if self._engine.discs[i, INV_MASS] == 0.0:
            raise InputError(f"{self._name(i)} is driven: no force moves it")
        push = np.append(two_of("force", force, "N"), real("torque", torque, "N m"))
        until = self.time + positive("duration", duration, "s")
        with self._or_as_before():
            self._engine = with_force(self._engine, self.scene, self._order, i, push, until)
            set_scales(self._engine, self._all_now())
            self._put(g.FORCED, row_of(None, None, None, None), i)

    def _lead(self, i: int, state: FloatArray, duration: float) -> None:
        """What is led goes on from a state."""
        self._engine = with_room_to_lead(self._engine)
        lead(self._engine, i, state, duration)
        if not np.hypot(state[VX], state[VY]) <= self._engine.scale[0]:
            set_scales(self._engine, np.zeros((len(self.names), 6)))

    def _put(self, what: int, rows: FloatArray, discs: int | slice | g.Whole) -> None:
        """Give discs their states, NaN: as it is, by an event; all or nothing."""
        room, by_hand = self._room, what in (g.STRUCK, g.PLACED, g.ADDED)
        with self._or_as_before():
            self._engine.counts[g.N_AT_ONCE] = 0
            for mark in (BY_HAND if by_hand else STALE, STALE):
                room.marks[:] = CURRENT
                room.marks[discs] = mark
                room.before[discs] = rows
                if self._advance(self.time, what):
                    return
                numbers = np.atleast_1d(np.arange(len(self.names))[discs])
                self._see_to(what, np.atleast_2d(rows), numbers)

    def _see_to(self, what: int, rows: FloatArray, discs: g.Whole) -> None:
        """Refuse what does not fit, see to the scales, and lead what is led from there."""
        engine, own = self._engine, self._engine.discs[discs]
        held, led = own[:, HOLD] != FREE, (own[:, INV_MASS] == 0.0) & (what != g.ADDED)
        law = law_goes_to(engine.regions) < math.inf
        sure = not (law or held.any() or led.any() or moves_along(engine.surface))
        if sure and (slips_of(own, rows) <= engine.scale[0]).all():
            return
        now = self._all_now()
        states = now.copy()
        states[discs] = np.where(np.isnan(rows), states[discs], rows)
        for i, is_held, is_led in zip(discs.tolist(), held.tolist(), led.tolist(), strict=True):
            if is_held:
                refuse_off_hold(engine, i, states[i], self._name(i))
                self._refuse_misfit(int(self._order[i]), states[i])
            if is_led and (states[i] != now[i]).any():
                self._lead(i, states[i], FOR_EVER)
            elif law:
                refuse_too_fast(engine, self.scene, self._name(i), i, states[i])
        if not sure or (slips_of(own, states[discs]) > engine.scale[0]).any():
            set_scales(self._engine, states)

    def _refuse_misfit(self, number: int, state: FloatArray) -> None:
        """Refuse a velocity that the constraint of a puck does not allow."""
        x, y, angle, vx, vy, spin = state.tolist()
        launch = Launch((vx, vy), spin, (x, y), angle)
        hold = pucks_of(self.scene)[number].constraint
        for fault in misfits(launch, hold, self.scene.floor, ""):
            raise InputError(f"{self.names[number]}: {fault}".replace("launch.", ""))

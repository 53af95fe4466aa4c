"""Many copies of a board at once, for whoever trains an agent, or plans by trying."""

from __future__ import annotations

import math
from typing import Any, Self

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray, finite_array, shown
from puck_tables.errors import InputError
from puck_tables.scene.friction import SPIN, THETA, VX, VY, X, Y
from puck_tables.scene.pucks_and_posts import called_line
from puck_tables.scene.run import Event, number_of
from puck_tables.world import engine_state as g
from puck_tables.world.agreement import refuse_endless
from puck_tables.world.bench import ALL_PUT, LED, LET_GO, REPORT_COLUMNS
from puck_tables.world.layout import INV_MASS
from puck_tables.world.running import span_of
from puck_tables.world.segment import GONE
from puck_tables.world.together import Together, of_boards

Boards = npt.ArrayLike | None


class Worlds(Together):
    """Copies of a board, each a :class:`puck_tables.World` of its own to the bit.

    All that is done to them is done at once, in compiled code on all cores; results depend neither
    on how many boards there are nor on the cores.  A board on which more than 2,000 things happen
    in a call is taken on alone for it, and so is one whose pucks push under a friction law over
    the slip speed.  By-hand calls on a floor that moves, and of pucks that a constraint leads, go
    board by board, too.  A call that is refused, or fails, changes no board.

    Parameters
    ----------
    scene : SceneSpec
        Without ranges.
    n : int
        How many, from 1 on.

    Attributes
    ----------
    time : FloatArray
        Of each board, array (n,), s.
    names : tuple of str
        Of the pucks.

    Raises
    ------
    InputError
        If a number of the scene is a range, or so many boards do not fit in memory.

    Examples
    --------
    >>> from puck_tables import Puck, Scene, Worlds
    >>> worlds = Worlds(Scene(pucks=[Puck(0.03, friction=0.1)]), 3)
    >>> worlds.strike(0, [[0.5, 0.0], [1.0, 0.0], [1.5, 0.0]])
    >>> worlds.advance(float("inf"))
    >>> worlds.state()[:, 0, 0].round(6).tolist()                      # v^2/2fg
    [0.127465, 0.509858, 1.147181]
    """

    def __len__(self) -> int:
        return self._n

    def __repr__(self) -> str:
        title = f"{self.scene.title}, " if self.scene.title else ""
        return f"Worlds({title}{self._n} boards of {len(self.names)} pucks)"

    @property
    def in_play(self) -> npt.NDArray[np.bool_]:
        """Which pucks are in no pocket and over no edge, array (n, pucks)."""
        return self._kinds(self._at)[:, self._place] != GONE

    @property
    def moving(self) -> npt.NDArray[np.bool_]:
        """Which pucks move, if only with the floor, array (n, pucks)."""
        return self._states(self._at, self.time)[1]

    def state(self) -> FloatArray:
        """X, y (m), angle (rad), vx, vy (m/s), spin (rad/s) of all pucks, array (n, pucks, 6)."""
        return self._states(self._at, self.time)[0]

    @property
    def events(self) -> dict[str, npt.NDArray[Any]]:
        """What happened in the last call, by boards: columns by name, arrays (events,).

        ``board``, its number, and what :class:`puck_tables.scene.run.Event` has: ``time``,
        ``what``, ``puck``, ``partner``, ``x``, ``y``, ``approach``, ``slip``, ``impulse``, ``rub``,
        ``lost``, in SI units.

        >>> from puck_tables import Launch, Puck, Scene, Worlds
        >>> one = Puck(0.03, friction=0.1, launch=Launch((1.0, 0.0)))
        >>> two = Puck(0.03, friction=0.1, launch=Launch(position=(0.2, 0.0)))
        >>> worlds = Worlds(Scene(pucks=[one, two]), 2)
        >>> worlds.advance(0.2)
        >>> [worlds.events[name].tolist() for name in ("board", "what", "partner")]
        [[0, 1], ['impact', 'impact'], ['puck 1', 'puck 1']]
        """
        rows = np.concatenate([np.zeros((0, REPORT_COLUMNS)), *self._described])
        obstacles, lines = self._first._obstacles, self.scene.lines
        late = rows[:, 4] < -len(obstacles)  # a line: sorted in as World does
        order = np.lexsort((-rows[:, 4] * late, rows[:, 3] * late, late, rows[:, 1] * bool(lines),
                            rows[:, 0]))  # fmt: skip
        rows = rows[order]
        board, what, who, partner = rows[:, [0, 2, 3, 4]].astype(int).T
        pucks = [self.names[number] for number in self._order]
        things = [called_line(lines, k) for k in range(len(lines))][::-1] + obstacles[::-1]
        columns = {"board": board, "time": rows[:, 1], "what": np.array(g.EVENTS)[what],
                 "puck": np.array(pucks)[who]}  # fmt: skip
        partners = np.array(["floor", *things, *pucks])
        columns["partner"] = partners[np.where(what == g.TIPS, 0, partner + len(things) + 1)]
        return columns | dict(zip(Event._fields[4:], rows[:, 5:].T, strict=True))

    def advance(self, duration: float) -> None:
        """Let time pass on all boards; :attr:`events` has what happened in it.

        Parameters
        ----------
        duration : s, ≥ 0; inf: until nothing more can happen on each, whose times then differ

        Raises
        ------
        InputError, PuckError
            As :meth:`puck_tables.World.advance`, with the number of the board; ``boards`` of the
            error are all on which it fails: reset these, or drive them otherwise, and call again.
        """
        span = span_of(duration)
        if span == math.inf:
            refuse_endless(self.scene)
        self._do(LET_GO, np.arange(self._n), lambda world, k: world.advance(span), span)

    def strike(
        self, puck: int | str, velocity: npt.ArrayLike | None = None,
        spin: npt.ArrayLike | None = None, *, boards: Boards = None,
    ) -> None:  # fmt: skip
        """Send a puck off, now, on all boards or some.

        Parameters
        ----------
        puck : its number, or its name
        velocity : (2,) or (boards, 2) m/s, spin : one or (boards,) rad/s, optional
            Left out: as they are.
        boards : numbers, or a mask (n,); all if left out

        Raises
        ------
        InputError
            If there is no such puck or board, it is not in play on one or driven, or a number is
            not finite.

        Examples
        --------
        >>> from puck_tables import Puck, Scene, Worlds
        >>> worlds = Worlds(Scene(pucks=[Puck(0.03, friction=0.1)]), 3)
        >>> worlds.strike(0, (1.0, 0.0), boards=[2])
        >>> worlds.state()[:, 0, 3].tolist()
        [0.0, 0.0, 1.0]
        """
        i, some = int(self._place[number_of(puck, self.names)]), self._some(boards)
        if self._first._engine.discs[i, INV_MASS] == 0.0:
            name = self.names[self._order[i]]
            raise InputError(f"{name} is driven along its path: drive leads it")
        self._refuse_gone(i, some)
        self._put(g.STRUCK, i, some, self._rows(len(some), None, None, velocity, spin))

    def place(
        self, puck: int | str, position: npt.ArrayLike | None = None,
        angle: npt.ArrayLike | None = None, velocity: npt.ArrayLike | None = None,
        spin: npt.ArrayLike | None = None, *, boards: Boards = None,
    ) -> None:  # fmt: skip
        """Put a puck somewhere, now, also back from a pocket, on all boards or some.

        As :meth:`puck_tables.World.place`.

        Parameters
        ----------
        puck : its number, or its name
        position : (2,) or (boards, 2) m, angle : one or (boards,) rad, optional
        velocity : (2,) or (boards, 2) m/s, spin : one or (boards,) rad/s, optional
            Left out: as they are.  One that comes back needs a position, and is at rest if left so.
        boards : numbers, or a mask (n,); all if left out

        Raises
        ------
        InputError
            If there is no such puck or board, a number is not finite, or it would overlap a puck or
            a cushion, or lie in a hole: on which board, with whom, and by how much.

        Examples
        --------
        >>> from puck_tables import Puck, Scene, Worlds
        >>> worlds = Worlds(Scene(pucks=[Puck(0.03, friction=0.1)]), 2)
        >>> worlds.place(0, [[0.5, 0.0], [0.6, 0.0]], velocity=(0.2, 0.0))
        >>> worlds.advance(9.0)
        >>> worlds.state()[:, 0, 0].round(6).tolist()                    # 0.5 + v^2/2fg
        [0.520394, 0.620394]
        """
        i, some = int(self._place[number_of(puck, self.names)]), self._some(boards)
        if position is None:
            self._refuse_gone(i, some)
        self._put(g.PLACED, i, some, self._rows(len(some), position, angle, velocity, spin))

    def remove(self, puck: int | str, *, boards: Boards = None) -> None:
        """Take a puck out of play, now, on all boards or some; :meth:`place` brings it back.

        Raises
        ------
        InputError
            If there is no such puck or board, or it is not in play on one.

        Examples
        --------
        >>> from puck_tables import Puck, Scene, Worlds
        >>> worlds = Worlds(Scene(pucks=[Puck(0.03, friction=0.1)]), 2)
        >>> worlds.remove(0, boards=[1])
        >>> worlds.in_play[:, 0].tolist()
        [True, False]
        """
        i, some = int(self._place[number_of(puck, self.names)]), self._some(boards)
        self._refuse_gone(i, some)
        self._put(g.REMOVED, i, some, np.full((len(some), 1, 6), math.nan))

    def copy(self, boards: Boards = None) -> Self:
        """Boards of their own that go on from here, to look ahead.

        Parameters
        ----------
        boards : numbers, which may come again, or a mask (n,); all if left out

        Raises
        ------
        InputError
            If there is no such board, or so many do not fit in memory.

        Examples
        --------
        >>> from puck_tables import Puck, Scene, Worlds
        >>> worlds = Worlds(Scene(pucks=[Puck(0.03, friction=0.1)]), 2)
        >>> worlds.strike(0, (1.0, 0.0), boards=[1])
        >>> tries = worlds.copy([1, 1, 0])
        >>> tries.state()[:, 0, 3].tolist(), len(worlds)
        ([1.0, 1.0, 0.0], 2)
        """
        return self._copied(self._some(boards, again=True))

    def drive(
        self, puck: int | str, velocity: npt.ArrayLike, spin: npt.ArrayLike = 0.0, *,
        boards: Boards = None,
    ) -> None:  # fmt: skip
        """Move a puck that is led by hand, from now on until the next call, on all boards or some.

        As :meth:`puck_tables.World.drive`.

        Parameters
        ----------
        puck : its number, or its name
        velocity : (2,) or (boards, 2) m/s, spin : one or (boards,) rad/s
        boards : numbers, or a mask (n,); all if left out

        Raises
        ------
        InputError
            If there is no such puck or board, it is not led by hand, or a number is not finite.
        PuckError
            If it squeezes pucks that touch it, now, against what does not give way.

        Examples
        --------
        >>> from puck_tables import Puck, Scene, Worlds
        >>> mallet = Puck(0.05, path=[[0, -0.2, 0]], name="mallet")
        >>> worlds = Worlds(Scene(pucks=[mallet, Puck(0.03, friction=0.1)]), 2)
        >>> worlds.drive("mallet", [[1.0, 0.0], [2.0, 0.0]])
        >>> worlds.advance(0.25)
        >>> worlds.state()[:, 1, 3].round(6).tolist()         # 2 V - f g t, from the impact on
        [1.872514, 3.813674]
        """
        i, some = self._first._led(puck, False), self._some(boards)
        self._refuse_gone(i, some)
        rows = np.zeros((len(some), 1, 6))
        rows[:, 0, VX : VY + 1] = self._each("velocity", velocity, "m/s", len(some), 2)
        rows[:, 0, SPIN] = self._each("spin", spin, "rad/s", len(some))
        self._do(LED, some, lambda world, k: world.drive(puck, rows[k, 0, VX : VY + 1],
                 float(rows[k, 0, -1])), 0.0, rows, np.array([i]))  # fmt: skip

    def set_state(self, states: npt.ArrayLike, *, boards: Boards = None) -> None:
        """Put all pucks into states, as :meth:`state` gives them, on all boards or some.

        As :meth:`puck_tables.World.set_state`: one out of play comes back where its row is new.

        Parameters
        ----------
        states : (pucks, 6) or (boards, pucks, 6): x, y m, angle rad, vx, vy m/s, spin rad/s
        boards : numbers, or a mask (n,); all if left out

        Raises
        ------
        InputError
            If they are no such numbers, or pucks would overlap: on which board, and by how much.
        """
        self._set(states, self._some(boards), False)

    def reset(self, boards: Boards = None, states: npt.ArrayLike | None = None) -> None:
        """Put boards back to the start of the scene, at time 0; or there into states.

        Parameters
        ----------
        boards : numbers, or a mask (n,); all if left out
        states : as for :meth:`set_state`, optional

        Raises
        ------
        InputError
            As :meth:`set_state`.

        Examples
        --------
        >>> from puck_tables import Launch, Puck, Scene, Worlds
        >>> worlds = Worlds(Scene(pucks=[Puck(0.03, friction=0.1, launch=Launch((1, 0)))]), 2)
        >>> worlds.advance(0.25)
        >>> worlds.reset([1])
        >>> worlds.time.tolist(), worlds.state()[:, 0, 3].round(6).tolist()
        ([0.25, 0.0], [0.754834, 1.0])
        """
        some = self._some(boards)
        if states is not None:
            self._set(states, some, True)
        else:
            self._at[some], self._described = 2 * self._n, []
            self.time = np.where(np.isin(np.arange(self._n), some), 0.0, self.time)

    def _set(self, states: npt.ArrayLike, some: g.Whole, anew: bool) -> None:
        """Put the pucks of boards into states, as they are or at their start."""
        rows = finite_array("states", states, "m, rad, m/s, rad/s")
        each, one = (len(some), len(self.names), 6), (len(self.names), 6)
        if rows.shape not in (each, one):
            raise InputError(f"states must have the shape {each}, or {one} for all, got "
                             f"{rows.shape}")  # fmt: skip
        rows = np.broadcast_to(rows, each)
        self._do(ALL_PUT, some, lambda world, k: world.set_state(rows[k]), 0.0,
                 rows[:, self._order].copy(), np.arange(len(self.names)), anew)  # fmt: skip

    def _some(self, boards: Boards, again: bool = False) -> g.Whole:
        """The numbers of boards, which come once if not ``again``."""
        if boards is None:
            return np.arange(self._n)
        try:
            numbers = np.atleast_1d(np.asarray(boards))
        except ValueError:  # rows that differ in length
            numbers = np.array([math.nan])
        if numbers.dtype == bool and numbers.shape == (self._n,):
            return np.flatnonzero(numbers)
        if numbers.ndim == 1 and (numbers.size == 0 or np.issubdtype(numbers.dtype, np.integer)):
            some = np.unique(numbers).astype(int)
            if (again or len(some) == numbers.size) and ((some >= 0) & (some < self._n)).all():
                return numbers.astype(int)
        once = "" if again else ", each once"
        raise InputError(f"boards must be numbers from 0 to {self._n - 1}{once}, or a mask of "
                         f"{self._n}, got {shown(boards)}")  # fmt: skip

    def _put(self, what: int, i: int, some: g.Whole, rows: FloatArray) -> None:
        """Give a disc states (boards, 1, 6), NaN: as it is, by an event."""
        self._do(what, some, lambda world, k: world._put(what, rows[k, 0], i), 0.0, rows,
                 np.array([i]))  # fmt: skip

    def _rows(self, count: int, position: Any, angle: Any, velocity: Any, spin: Any) -> FloatArray:
        """States (count, 1, 6) of what is given; NaN of the rest."""
        rows = np.full((count, 1, 6), math.nan)
        if position is not None:
            rows[:, 0, X : Y + 1] = self._each("position", position, "m", count, 2)
        if angle is not None:
            rows[:, 0, THETA] = self._each("angle", angle, "rad", count)
        if velocity is not None:
            rows[:, 0, VX : VY + 1] = self._each("velocity", velocity, "m/s", count, 2)
        if spin is not None:
            rows[:, 0, SPIN] = self._each("spin", spin, "rad/s", count)
        return rows

    def _refuse_gone(self, i: int, some: g.Whole) -> None:
        """Refuse boards where a disc has left play."""
        gone = some[self._kinds(self._at[some])[:, i] == GONE].tolist()
        if gone:
            error = InputError(
                f"{self.names[self._order[i]]} is no longer in play: place puts it back"
            )
            raise of_boards(dict.fromkeys(gone, error))

    def _each(self, name: str, values: Any, unit: str, count: int, *width: int) -> FloatArray:
        """Numbers for each board, or for all the same."""
        rows = finite_array(name, values, unit)
        if rows.shape not in (width, (count, *width)):
            raise InputError(f"{name} must have the shape {width} or {(count, *width)}, in {unit}, "
                             f"got {rows.shape}")  # fmt: skip
        return rows

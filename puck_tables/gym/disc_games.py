"""What a game of shots at discs is to an agent: its board, how it begins, a move, what is seen.

Carrom and crokinole, each as an exercise for one.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.errors import PuckError
from puck_tables.scene.parts import Launch
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.world.scene import Scene
from puck_tables.world.worlds import Worlds

Whole = npt.NDArray[np.int64]
Truth = npt.NDArray[np.bool_]


@dataclass
class Tables:
    """Boards that are played at once.

    ``moves`` (n,): made on each; ``failed`` (n,): where the last move could not be followed.
    """

    worlds: Worlds
    moves: Whole
    failed: Truth

    def advance(self, span: float) -> None:
        """Let time pass, s; a board on which that fails is put back to its start."""
        while True:
            try:
                return self.worlds.advance(span)
            except PuckError as error:
                if not error.boards:
                    raise
                boards = np.array(error.boards)
                self.worlds.reset(boards)
                self.failed[boards] = True

    def copy(self, boards: Whole) -> Tables:
        """Boards of their own that go on as some are, to look ahead."""
        return Tables(self.worlds.copy(boards), self.moves[boards], self.failed[boards])


class TableGame:
    """A game, the same for any number of boards."""

    scene: SceneSpec  # at its start
    actions: int  # numbers of an action, each from −1 to 1
    low: FloatArray  # between which lies what is seen, a number for each
    high: FloatArray
    places: slice | Whole  # which of them are places, m
    limit: int  # moves of a game at most

    def begin(self, tables: Tables, boards: Whole, rng: np.random.Generator) -> None:
        """Begin anew on some boards."""
        tables.worlds.reset(boards)
        tables.moves[boards], tables.failed[boards] = 0, False

    def move(
        self, tables: Tables, boards: Whole, actions: FloatArray, rng: np.random.Generator
    ) -> tuple[FloatArray, Truth]:
        """Make a move on some boards; what each earns, and where the game is over."""
        raise NotImplementedError

    def seen(self, tables: Tables) -> FloatArray:
        """What an agent sees of each board, array (n, numbers)."""
        raise NotImplementedError


def table(name: str) -> Scene:
    """A shipped scene whose pucks lie wholly on it until their centres are over an edge.

    What hangs is not summed: 1,600 weights of shuffleboard take 0.07 s in place of 13 s, fall
    alike, and lie elsewhere by 0.9 mm at most.
    """
    scene = Scene.load(name)
    return replace(scene, edges=tuple(replace(one, beyond="floor") for one in scene.edges))


def between(action: FloatArray, low: float, high: float) -> FloatArray:
    """Numbers from −1 to 1 as numbers between two others.

    >>> between(np.array([-1.0, 0.0, 1.0]), 2.0, 6.0).tolist()
    [2.0, 4.0, 6.0]
    """
    return low + 0.5 * (action + 1.0) * (high - low)


def observed_pucks(states: FloatArray, there: Truth) -> FloatArray:
    """X, y, m, of pucks (n, pucks, 6), and 1; zeros of those that are not there, (n, 3 pucks).

    >>> observed_pucks(np.ones((1, 2, 6)), np.array([[True, False]])).tolist()
    [[1.0, 1.0, 0.0, 0.0, 1.0, 0.0]]
    """
    places = np.where(there[:, :, None], states[:, :, :2], 0.0)
    return np.concatenate([places.reshape(len(states), -1), there], axis=1)


def sent(speed: FloatArray, direction: FloatArray) -> FloatArray:
    """Velocities (n, 2), m/s, of speeds along ways, rad from x.

    >>> sent(np.array([2.0]), np.array([0.0])).tolist()
    [[2.0, 0.0]]
    """
    return np.asarray(speed[:, None] * np.column_stack([np.cos(direction), np.sin(direction)]))


class ShotGame(TableGame):
    """One shot is a move: until all is at rest; it earns what the score becomes larger by."""

    def move(
        self, tables: Tables, boards: Whole, actions: FloatArray, rng: np.random.Generator
    ) -> tuple[FloatArray, Truth]:
        """A shot on each."""
        before = self.score(tables)[boards]
        self.shoot(tables, boards, actions, rng)
        tables.moves[boards] += 1
        return self.score(tables)[boards] - before, self.over(tables)[boards]

    def shoot(
        self, tables: Tables, boards: Whole, actions: FloatArray, rng: np.random.Generator
    ) -> None:
        """Send off what is shot, and wait until all is at rest."""
        raise NotImplementedError

    def send(
        self, tables: Tables, boards: Whole, numbers: Whole, at: FloatArray, velocity: FloatArray,
        spin: FloatArray | float = 0.0,
    ) -> None:  # fmt: skip
        """Place the puck of such a number on each board, send it off, and wait for the rest."""
        spins = np.broadcast_to(spin, len(boards))
        for number in np.unique(numbers).tolist():
            on = numbers == number
            tables.worlds.place(
                number, at[on], velocity=velocity[on], spin=spins[on], boards=boards[on]
            )
        tables.advance(np.inf)

    def score(self, tables: Tables) -> FloatArray:
        """Points on each board, array (n,)."""
        raise NotImplementedError

    def over(self, tables: Tables) -> Truth:
        """Where the game is over: after so many shots."""
        return tables.moves >= self.limit


def free_places(
    wanted: FloatArray, line: FloatArray, others: FloatArray, there: Truth, gaps: FloatArray
) -> tuple[FloatArray, Truth]:
    """The places (n, 2) nearest to those wanted on which nobody is, of a line (m, 2) of them.

    ``others`` (n, pucks, 2), ``there``: which are on the board; ``gaps`` (pucks,): how far away
    their centres must be.  And where there is any.

    >>> line, wanted = np.array([[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]]), np.array([[0.2, 0.0]])
    >>> there, gaps = np.array([[True]]), np.array([0.5])
    >>> free_places(wanted, line, np.array([[[0.1, 0.0]]]), there, gaps)[0].tolist()
    [[1.0, 0.0]]
    """
    count = len(wanted)
    places = np.concatenate([wanted[:, None], np.broadcast_to(line, (count, *line.shape))], axis=1)
    apart = np.hypot(*np.moveaxis(places[:, :, None] - others[:, None], -1, 0))
    free = ((apart > gaps) | ~there[:, None]).all(axis=2)
    far = np.where(free, np.hypot(*np.moveaxis(places - wanted[:, None], -1, 0)), np.inf)
    nearest = far.argmin(axis=1)
    return places[np.arange(count), nearest], free.any(axis=1)


class Carrom(ShotGame):
    """White men are to be pocketed, from the break on; 30 shots at most.

    An action is the place of the striker on its base line, ±0.21 m, its direction, ±80° to the line
    across, and its speed, 0.2 to 6 m/s; where a man is in the way, the nearest free place is taken.
    A white man earns 1, a black one −1, the queen 3, the striker in a pocket −1.  Seen are x, y, m,
    of all men and 1 for each on the board, then the share of shots made.
    """

    actions, limit, places = 3, 30, slice(0, 38)

    def __init__(self) -> None:
        scene = table("carrom-break")
        men, striker = scene.pucks[:-1], scene.pucks[-1]
        place = float(striker.launch.position[1])
        striker = replace(striker, launch=Launch(position=(0.0, place)))
        self.scene = replace(scene, pucks=(*men, striker), title="Carrom")
        self._line = np.column_stack([np.linspace(-0.21, 0.21, 85), np.full(85, place)])
        self._gaps = np.array([1.0001 * (man.radius + striker.radius) for man in men])
        worth = {"white": 1.0, "black": -1.0, "queen": 3.0}
        self._worth = np.array([worth[man.name.split()[0]] for man in men])
        self.high = np.ones(3 * len(men) + 1)
        self.low = np.concatenate([-self.high[:38], np.zeros(20)])

    def shoot(
        self, tables: Tables, boards: Whole, actions: FloatArray, rng: np.random.Generator
    ) -> None:
        """Place the striker, and send it off."""
        worlds, place = tables.worlds, self._line[0, 1]
        wanted = np.column_stack([0.21 * actions[:, 0], np.full(len(boards), place)])
        states, there = worlds.state()[boards], worlds.in_play[boards]
        at, free = free_places(wanted, self._line, states[:, :-1, :2], there[:, :-1], self._gaps)
        heading, speed = np.radians(80.0) * actions[:, 1], between(actions[:, 2], 0.2, 6.0)
        striker = np.full(free.sum(), len(self._worth))
        self.send(tables, boards[free], striker, at[free], sent(speed, 0.5 * np.pi - heading)[free])

    def score(self, tables: Tables) -> FloatArray:
        """What is in the pockets; the striker is there only just after its shot."""
        gone = ~tables.worlds.in_play
        return np.asarray(gone[:, :-1] @ self._worth - gone[:, -1])

    def over(self, tables: Tables) -> Truth:
        """Where no white man is left, or all shots are made."""
        whites = tables.worlds.in_play[:, :-1][:, self._worth == 1.0]
        return super().over(tables) | ~whites.any(axis=1)

    def seen(self, tables: Tables) -> FloatArray:
        """All men."""
        men = observed_pucks(tables.worlds.state()[:, :-1], tables.worlds.in_play[:, :-1])
        return np.column_stack([men, tables.moves / self.limit])


class Crokinole(ShotGame):
    """Eight discs to be shot at the hole and at three of the other side, which lie anywhere.

    An action is the place on the line of the own quarter, ±45°, the direction, ±30° to the middle,
    and the speed, 0.2 to 3 m/s.  Points are those of the own discs less those of the others: 20 in
    the hole, 15, 10 and 5 in the rings, all of a disc within; nobody has to hit anything.  Seen are
    x, y, m, of all discs, own first, and 1 for each on the board, then the share of shots made.
    """

    actions, limit, places = 3, 8, slice(0, 22)
    _RINGS = ((0.1016, 15.0), (0.2032, 10.0), (0.3048, 5.0))  # radius, m, and points
    _START, _THEIRS = 0.2948, 3  # m: on the outer line

    def __init__(self) -> None:
        scene = table("crokinole")
        own, their = scene.pucks[0], scene.pucks[1]
        turns = np.arange(self.limit + self._THEIRS) * 2.0 * np.pi / 11.0
        pucks = [
            replace(
                own if k < self.limit else their,
                name=f"disc {k + 1}" if k < self.limit else f"other {k - self.limit + 1}",
                launch=Launch(position=(0.25 * np.cos(turn), 0.25 * np.sin(turn))),
            )
            for k, turn in enumerate(turns.tolist())
        ]
        self.scene = replace(scene, pucks=tuple(pucks))
        self._radius = own.radius
        angles = np.linspace(-0.75, -0.25, 61) * np.pi
        self._line = self._START * np.column_stack([np.cos(angles), np.sin(angles)])
        self.high = np.ones(3 * len(pucks) + 1)
        self.low = np.concatenate([-self.high[:22], np.zeros(12)])

    def begin(self, tables: Tables, boards: Whole, rng: np.random.Generator) -> None:
        """Put the discs of the other side anywhere, a ring each."""
        super().begin(tables, boards, rng)
        for k in range(self.limit):
            tables.worlds.remove(k, boards=boards)
        for k, (low, high) in enumerate(((0.03, 0.07), (0.13, 0.18), (0.21, 0.24))):
            far, phi = rng.uniform(low, high, len(boards)), rng.uniform(-np.pi, np.pi, len(boards))
            tables.worlds.place(self.limit + k, sent(far, phi), boards=boards)

    def shoot(
        self, tables: Tables, boards: Whole, actions: FloatArray, rng: np.random.Generator
    ) -> None:
        """Place the next disc, and send it off."""
        worlds, turn = tables.worlds, -0.5 * np.pi + 0.25 * np.pi * actions[:, 0]
        wanted = self._START * np.column_stack([np.cos(turn), np.sin(turn)])
        states, there = worlds.state()[boards], worlds.in_play[boards]
        gaps = np.full(len(self.scene.pucks), 2.0001 * self._radius)
        at, free = free_places(wanted, self._line, states[:, :, :2], there, gaps)
        heading = np.arctan2(-at[:, 1], -at[:, 0]) + np.radians(30.0) * actions[:, 1]
        speed = between(actions[:, 2], 0.2, 3.0)
        number = tables.moves[boards]
        self.send(tables, boards[free], number[free], at[free], sent(speed, heading)[free])

    def score(self, tables: Tables) -> FloatArray:
        """Of own discs that were shot, less those of the others."""
        worlds, own = tables.worlds, np.arange(len(self.scene.pucks)) < self.limit
        far = np.hypot(*np.moveaxis(worlds.state()[:, :, :2], -1, 0))
        points = np.zeros(far.shape)
        for radius, worth in self._RINGS[::-1]:
            points[worlds.in_play & (far + self._radius < radius)] = worth
        shot = np.arange(far.shape[1]) < tables.moves[:, None]
        points[~worlds.in_play & (far < 0.02) & (shot | ~own)] = 20.0
        return points @ np.where(own, 1.0, -1.0)

    def seen(self, tables: Tables) -> FloatArray:
        """All discs."""
        discs = observed_pucks(tables.worlds.state(), tables.worlds.in_play)
        return np.column_stack([discs, tables.moves / self.limit])

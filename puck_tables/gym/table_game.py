"""What a game is to an agent: its board, how it begins, what a move does, what is seen."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.errors import PuckError
from puck_tables.scene.scene_spec import SceneSpec
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
    """A game, the same for any number of boards.

    Attributes
    ----------
    scene : SceneSpec
        The board at its start.
    actions : int
        Numbers of an action, each from −1 to 1.
    low, high : FloatArray
        Between which lies what is seen, a number for each.
    places : slice or numbers
        Which of them are places, m.
    limit : int
        Moves of a game at most.
    """

    scene: SceneSpec
    actions: int
    low: FloatArray
    high: FloatArray
    places: slice | Whole
    limit: int

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

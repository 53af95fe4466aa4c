"""Air hockey: two mallets, moved by velocities every sixtieth of a second, until a goal."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.gym.disc_games import TableGame, Tables, Truth, Whole, sent, table
from puck_tables.puck import Puck
from puck_tables.scene.parts import Launch
from puck_tables.scene.scene_spec import SceneSpec

_LONG, _WIDE = 2.2, 1.1  # m, of the table
_MALLET, _MASS = 0.0508, 0.17  # its radius, m, and mass, kg
_FASTEST = 4.0  # m/s, of a mallet
_HOME = 0.25  # m, from its goal
_SERVE = 1.0  # m/s at most
_ROOM = 2.0 * _MALLET  # m, that a mallet keeps from what bounds its half
_SIGHT = 100.0, 1e4  # m/s and rad/s: nothing is faster


def _scene() -> SceneSpec:
    """The shipped table with a mallet on each side, which a hand strikes every frame."""
    scene = table("air-hockey-goals")
    puck = replace(scene.pucks[0], launch=Launch(position=(0.5 * _LONG, 0.5 * _WIDE)))
    mallets = [
        Puck(
            _MALLET, friction=0.0, mass=_MASS, restitution=0.9, tangential=0.0, rim=0.2,
            name=name, colour=colour, launch=Launch(position=(x, 0.5 * _WIDE)),
        )
        for name, colour, x in (("left", "#0072b2", _HOME), ("right", "#d55e00", _LONG - _HOME))
    ]  # fmt: skip
    return replace(scene, pucks=(puck, *mallets), title="Air hockey", time=None)


class AirHockey(TableGame):
    """Both mallets: an action is vx, vy of the left one, then of the right, of 4 m/s each.

    Each keeps to its half.  It earns the left player 1 as the puck falls into the right goal, −1 as
    it falls into the left one, and the game is over; 20 s at most.  The puck is served from the
    middle at up to 1 m/s.  Seen are x, y of the own mallet, the other, and the puck, m, their vx,
    vy, m/s, and the spin of the puck, rad/s: by the left player, then the same by the right one,
    who sees the table, and moves, as if it were the left one.
    """

    actions, limit, span = 4, 1200, 1.0 / 60.0
    sides: tuple[int, ...] = (0, 1)

    def __init__(self) -> None:
        self.scene = _scene()
        fast, turning = _SIGHT
        one = [3.0, 3.0] * 3 + [fast] * 6 + [turning]
        self.high = np.array(one * len(self.sides))
        self.low, self.places = -self.high, np.flatnonzero(self.high == one[0])

    def begin(self, tables: Tables, boards: Whole, rng: np.random.Generator) -> None:
        """Serve."""
        super().begin(tables, boards, rng)
        turn, speed = rng.uniform(-np.pi, np.pi, len(boards)), rng.uniform(0.0, _SERVE, len(boards))
        tables.worlds.strike(0, sent(speed, turn), boards=boards)

    def move(
        self, tables: Tables, boards: Whole, actions: FloatArray, rng: np.random.Generator
    ) -> tuple[FloatArray, Truth]:
        """A frame; what it earns the left player."""
        states = tables.worlds.state()[boards]
        for side in (0, 1):
            own = actions[:, 2 * side : 2 * side + 2]
            if side:
                own = -own  # it sees the table from its end
            low = np.array([_ROOM + 0.5 * _LONG * side, _ROOM])
            high = np.array([0.5 * _LONG * (1 + side) - _ROOM, _WIDE - _ROOM])
            here = states[:, 1 + side, :2]
            velocity = np.clip(_FASTEST * own, (low - here) / self.span, (high - here) / self.span)
            tables.worlds.strike(1 + side, velocity, 0.0, boards=boards)
        tables.advance(self.span)
        tables.moves[boards] += 1
        over = ~tables.worlds.in_play[boards, 0]
        goal = np.sign(tables.worlds.state()[boards, 0, 0] - 0.5 * _LONG)
        return np.where(over, goal, 0.0), over

    def seen(self, tables: Tables) -> FloatArray:
        """By who plays."""
        return np.concatenate([self.observed_by(tables, side) for side in self.sides], axis=1)

    def observed_by(self, tables: Tables, side: int) -> FloatArray:
        """By the left player, 0, or the right one, 1, array (n, 13)."""
        states = tables.worlds.state()[:, [2, 1, 0] if side else [1, 2, 0]]
        if side:
            states[:, :, :2] = np.array([_LONG, _WIDE]) - states[:, :, :2]
            states[:, :, 3:5] *= -1.0
        n = len(states)
        parts = [states[:, :, :2].reshape(n, 6), states[:, :, 3:5].reshape(n, 6), states[:, 2, 5:]]
        return np.concatenate(parts, axis=1)


class AirHockeyAlone(AirHockey):
    """The left mallet against a simple player: an action is its vx, vy, of 4 m/s each.

    The other guards its goal, at 1.5 m/s, and hits what comes slowly into its half.  All else is as
    in :class:`AirHockey`; only what the left player sees is seen.
    """

    actions = 2
    sides = (0,)

    def move(
        self, tables: Tables, boards: Whole, actions: FloatArray, rng: np.random.Generator
    ) -> tuple[FloatArray, Truth]:
        """A frame, in which the other player moves, too."""
        theirs = guard(self.observed_by(tables, 1)[boards])
        return super().move(tables, boards, np.concatenate([actions, theirs], axis=1), rng)


def guard(seen: FloatArray, speed: float = 1.5) -> FloatArray:
    """Actions (n, 2) of a simple player who sees (n, 13), at a speed, m/s.

    It stays before its goal, level with the puck, and goes for a slow puck in its half.

    >>> seen = np.zeros((1, 13))
    >>> seen[0, :6] = 0.25, 0.55, 1.95, 0.55, 0.6, 0.55            # the puck lies before it
    >>> guard(seen).round(6).tolist()
    [[0.375, 0.0]]
    """
    own, puck, speeds = seen[:, :2], seen[:, 4:6], np.hypot(seen[:, 10], seen[:, 11])
    near = (puck[:, 0] < 0.5 * _LONG) & (speeds < speed) & (puck[:, 0] > own[:, 0])
    home = np.column_stack([np.full(len(seen), _HOME), np.clip(puck[:, 1], 0.4, 0.7)])
    path = np.where(near[:, None], puck, home) - own
    far = np.hypot(*path.T)[:, None]
    fast = np.minimum(speed, 10.0 * far) / _FASTEST  # m/s: it slows down as it arrives
    return np.asarray(np.divide(path * fast, far, out=np.zeros_like(path), where=far > 0.0))

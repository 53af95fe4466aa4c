"""A disc to be pushed by a finger to a place and an angle: what robots that push have to learn."""

from __future__ import annotations

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.gym.disc_games import TableGame, Tables, Truth, Whole, sent
from puck_tables.puck import Puck
from puck_tables.scene.pucks_and_posts import Line
from puck_tables.world.scene import Scene

_RADIUS, _FINGER = 0.05, 0.01  # m
_FASTEST = 0.25  # m/s, of the finger
_NEAR, _TURNED = 0.005, np.radians(5.0)  # m, rad: there


class PushToPose(TableGame):
    """A disc is pushed by a round finger from anywhere to the origin, to the angle 0.

    An action is vx, vy of the finger, of 0.25 m/s each, for 0.05 s; at most 200 of them.  Each
    earns what it brings the disc nearer, m, angles times the radius, and 1 more as it arrives, by
    5 mm and 5°: then the game is over.  Seen are x, y, m, of the disc and of the finger, and cosine
    and sine of the angle.
    """

    actions, limit, span, places = 2, 200, 0.05, slice(0, 4)

    def __init__(self) -> None:
        disc = Puck(_RADIUS, friction=0.3, restitution=0.0, tangential=0.0, rim=0.4, name="disc",
                     colour="steelblue")  # fmt: skip
        finger = Puck(
            _FINGER, path=((0.0, -0.3, 0.0),), restitution=0.0, tangential=0.0, rim=0.4,
            name="finger", colour="black",
        )  # fmt: skip
        lines = (
            Line(centre=(0.0, 0.0), radius=_RADIUS, name="there"),
            Line(centre=(0.0, 0.0), radius=8.0 * _RADIUS, name="around"),
        )  # what is shown
        self.scene = Scene(pucks=(disc, finger), lines=lines, title="Push to a pose")
        self.high = np.array([20.0] * 4 + [1.01] * 2)
        self.low = -self.high

    def begin(self, tables: Tables, boards: Whole, rng: np.random.Generator) -> None:
        """The disc anywhere some 10 to 20 cm away, the finger behind it."""
        super().begin(tables, boards, rng)
        count = len(boards)
        heading = rng.uniform(-np.pi, np.pi, count)
        disc = sent(rng.uniform(0.1, 0.2, count), heading)
        angle = rng.uniform(-0.5, 0.5, count)
        tables.worlds.place("disc", disc, angle, boards=boards)
        behind = disc + sent(np.full(count, 2.0 * _RADIUS), heading)
        tables.worlds.place("finger", behind, boards=boards)

    def move(
        self, tables: Tables, boards: Whole, actions: FloatArray, rng: np.random.Generator
    ) -> tuple[FloatArray, Truth]:
        """A push."""
        before = self._away(tables)[0][boards]
        tables.worlds.drive("finger", _FASTEST * actions, boards=boards)
        tables.advance(self.span)
        tables.moves[boards] += 1
        away, arrived = self._away(tables)
        return before - away[boards] + arrived[boards], arrived[boards]

    def _away(self, tables: Tables) -> tuple[FloatArray, Truth]:
        """How far each disc is, m, and which are there."""
        disc = tables.worlds.state()[:, 0]
        turned = np.abs((disc[:, 2] + np.pi) % (2.0 * np.pi) - np.pi)
        far = np.hypot(disc[:, 0], disc[:, 1])
        return far + _RADIUS * turned, (far < _NEAR) & (turned < _TURNED)

    def seen(self, tables: Tables) -> FloatArray:
        """Both, and how the disc is turned."""
        states = tables.worlds.state()
        angle = states[:, 0, 2]
        places = states[:, :, :2].reshape(-1, 4)
        return np.column_stack([places, np.cos(angle), np.sin(angle)])

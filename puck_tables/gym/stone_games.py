"""Games of two sides that send stones in turn: curling and shuffleboard; the end is counted."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.gym.disc_games import (
    ShotGame,
    Tables,
    Truth,
    Whole,
    between,
    observed_pucks,
    sent,
    table,
)
from puck_tables.puck import Puck
from puck_tables.scene.parts import Edge, Launch
from puck_tables.scene.pucks_and_posts import Line
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.world.scene import Scene

_INCH = 0.0254  # m


class StoneGame(ShotGame):
    """Each side sends its stones in turn, the other side first; the last stone earns the end.

    What waits lies behind the place of the throws.
    """

    start: tuple[float, float]
    fastest: float  # slip of a throw, m/s

    def __init__(self, scene: SceneSpec, own: Puck, their: Puck, high: float) -> None:
        x, gap = self.start[0], 2.5 * own.radius
        pucks = [
            replace(
                kind, name=f"{kind.name} {k + 1}",
                launch=Launch(position=(x - gap * (2 * k + 1 + side), self.start[1])),
            )
            for side, kind in ((1, own), (0, their)) for k in range(self.limit)
        ]  # fmt: skip
        fast = replace(pucks[0].launch, velocity=(-self.fastest, 0.0))  # a law is made for that
        pucks[0] = replace(pucks[0], launch=fast)
        self.scene = replace(scene, pucks=tuple(pucks))
        self._radius, stones = own.radius, 2 * self.limit
        self.places = slice(0, 2 * stones)
        self.high = np.append(np.full(2 * stones, high), np.ones(stones + 1))
        self.low = np.append(-self.high[: 2 * stones], np.zeros(stones + 1))

    def begin(self, tables: Tables, boards: Whole, rng: np.random.Generator) -> None:
        """All stones wait."""
        super().begin(tables, boards, rng)
        tables.worlds.strike(0, (0.0, 0.0), boards=boards)

    def shoot(
        self, tables: Tables, boards: Whole, actions: FloatArray, rng: np.random.Generator
    ) -> None:
        """A stone of the others, then one of one's own."""
        number = tables.moves[boards]
        for first, thrown in ((self.limit, self.theirs(rng, len(boards))), (0, actions)):
            self.send(tables, boards, first + number, *self.throw(thrown))
            self.clear(tables, boards, number + 1)

    def clear(self, tables: Tables, boards: Whole, thrown: Whole) -> None:
        """Take off what is not to lie where it stopped."""

    def throw(self, actions: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Places and velocities (n, 2), m and m/s, and spins (n,), rad/s."""
        raise NotImplementedError

    def theirs(self, rng: np.random.Generator, count: int) -> FloatArray:
        """Actions of the other side."""
        raise NotImplementedError

    def worth(self, places: FloatArray, there: Truth) -> tuple[FloatArray, FloatArray]:
        """How good the place of each stone is, smaller is better, and its points, (n, stones)."""
        raise NotImplementedError

    def score(self, tables: Tables) -> FloatArray:
        """After the last stone: the stones of one side that are better than all of the other."""
        places = tables.worlds.state()[:, :, :2]
        rank, points = self.worth(places, tables.worlds.in_play)
        rank = np.where(points > 0.0, rank, np.inf)
        own, others = rank[:, : self.limit], rank[:, self.limit :]
        mine = np.where(own < others.min(axis=1)[:, None], points[:, : self.limit], 0.0)
        yours = np.where(others < own.min(axis=1)[:, None], points[:, self.limit :], 0.0)
        return np.where(self.over(tables), mine.sum(axis=1) - yours.sum(axis=1), 0.0)

    def seen(self, tables: Tables) -> FloatArray:
        """All stones that were thrown, own first."""
        thrown = np.arange(self.limit) < tables.moves[:, None]
        there = tables.worlds.in_play & np.concatenate([thrown, thrown], axis=1)
        stones = observed_pucks(tables.worlds.state(), there)
        return np.column_stack([stones, tables.moves / self.limit])


class Curling(StoneGame):
    """An end of curling, eight stones each, with the last stone.

    An action is the speed at the near hog line, 1.8 to 3.2 m/s, the direction, ±5° to the line to
    the tee, and the spin, ±2 rad/s.  The others draw to the tee, with errors of 0.02 m/s and 0.15°
    (standard deviations).  The score of the end is earned with its last stone: one for each stone
    in the house that is nearer to the tee than all of the other side.  Stones short of the hog line
    are taken off.  Seen are x, y, m, from the tee, of the stones that were thrown, own first, and 1
    for each in play, then the share of stones thrown.
    """

    actions, limit, start, fastest = 3, 8, (-28.346, 0.0), 3.3
    _HOUSE, _HOG = 1.829, -6.401  # m
    _DRAW, _ERRORS = (2.088, 2.97, -1.57), (0.02, 0.15, 0.0)  # m/s, degrees, rad/s

    def __init__(self) -> None:
        scene = Scene.load("curling-draw")
        stone = Puck(
            radius=scene.puck.radius, base=scene.puck.base, height=scene.puck.height,
            mass=scene.puck.mass, gyration=scene.puck.gyration, friction=scene.puck.friction,
            restitution=0.9, tangential=0.0, rim=0.1,
        )  # fmt: skip
        far = 1.829 + stone.radius  # past the back line; 2.375 m is half of a sheet
        side = 2.375 - stone.radius
        edges = (
            Edge((far, 0.0), normal=(-1.0, 0.0), beyond="floor"),
            Edge((0.0, -side), normal=(0.0, 1.0), beyond="floor"),
            Edge((0.0, side), normal=(0.0, -1.0), beyond="floor"),
        )  # fmt: skip
        own = replace(stone, name="red", colour="firebrick")
        sheet = Scene(
            pucks=(own,), floor=scene.floor, lateral=scene.lateral, lines=scene.lines, edges=edges,
            tol=scene.tol, title="Curling: an end",
        )  # fmt: skip
        super().__init__(sheet, own, replace(stone, name="yellow", colour="gold"), 50.0)

    def throw(self, actions: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """From the near hog line."""
        speed, heading = between(actions[:, 0], 1.8, 3.2), np.radians(5.0) * actions[:, 1]
        at = np.broadcast_to(self.start, (len(actions), 2))
        return at, sent(speed, heading), 2.0 * actions[:, 2]

    def theirs(self, rng: np.random.Generator, count: int) -> FloatArray:
        """Draws to the tee, that curl from either side."""
        speed, heading, spin = (np.array(self._DRAW) + self._ERRORS * rng.normal(size=(count, 3))).T
        side = rng.choice([-1.0, 1.0], count)
        return np.column_stack([(speed - 2.5) / 0.7, side * heading / 5.0, side * spin / 2.0])

    def clear(self, tables: Tables, boards: Whole, thrown: Whole) -> None:
        """Stones that stopped short of the hog line."""
        at, there = tables.worlds.state()[boards, :, 0], tables.worlds.in_play[boards]
        short = there & (at - self._radius < self._HOG) & (at > self.start[0] - self._radius)
        for k in np.flatnonzero(short.any(axis=0)).tolist():
            tables.worlds.remove(k, boards=boards[short[:, k]])

    def worth(self, places: FloatArray, there: Truth) -> tuple[FloatArray, FloatArray]:
        """By the distance from the tee, if any of it is in the house."""
        far = np.hypot(*np.moveaxis(places, -1, 0))
        return far, np.where(there & (far < self._HOUSE + self._radius), 1.0, 0.0)


class Shuffleboard(StoneGame):
    """A frame of table shuffleboard, four weights each, with the last weight.

    An action is the place across, ±0.2 m, the speed, 1.2 to 2.4 m/s, the direction, ±2°, and the
    spin, ±10 rad/s.  The others send theirs for the end, with an error of 0.05 m/s.  The weights of
    one side that are beyond all of the other count: 3 in the last 6 in, 2 in the 6 in before, 1 up
    to 6 ft before the end.  Seen are x, y, m, of the weights that were sent, own first, and 1 for
    each on the table, then the share of weights sent.
    """

    actions, limit, start, fastest = 4, 4, (0.3, 0.0), 2.5
    _END = 6.3  # m, of the table
    _TO_THE_END = 1.85  # m/s

    def __init__(self) -> None:
        scene = table("shuffleboard-two-stones")
        own, their = scene.pucks
        marks = [self._END - inches * _INCH for inches in (6.0, 12.0, 72.0)]
        lines = tuple(Line((x, -0.255), (x, 0.255), name=f"{x:.2f} m") for x in marks)
        scene = replace(scene, lines=lines, title="Shuffleboard: a frame")
        super().__init__(scene, own, their, 8.0)

    def throw(self, actions: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """From the near end."""
        speed, heading = between(actions[:, 1], 1.2, 2.4), np.radians(2.0) * actions[:, 2]
        at = np.column_stack([np.full(len(actions), self.start[0]), 0.2 * actions[:, 0]])
        return at, sent(speed, heading), 10.0 * actions[:, 3]

    def theirs(self, rng: np.random.Generator, count: int) -> FloatArray:
        """Straight on, anywhere across, to the end."""
        speed, still = self._TO_THE_END + 0.05 * rng.normal(size=count), np.zeros(count)
        return np.column_stack([rng.uniform(-1.0, 1.0, count), (speed - 1.8) / 0.6, still, still])

    def worth(self, places: FloatArray, there: Truth) -> tuple[FloatArray, FloatArray]:
        """By the distance from the end, of its centre."""
        left = self._END - places[:, :, 0]
        points = np.select([left < 6.0 * _INCH, left < 12.0 * _INCH, left < 72.0 * _INCH],
                           [3.0, 2.0, 1.0])  # fmt: skip
        return left, np.where(there, points, 0.0)

"""How likely a launch on a board does what it is for, where nobody hits it exactly."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables._core.real import positive, real, whole
from puck_tables.bulk.summary import Chance, chance_of
from puck_tables.errors import InputError, PuckError
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.world.agreement import called, pucks_of
from puck_tables.world.worlds import Worlds

_TRIED = 400  # runs of each aim that is tried
_ROUNDS = 12  # of steps of the search, which are halved where none helps
_DEVIATIONS = 1.0  # of the scatter: its first steps


class Odds(NamedTuple):
    """Chances of a launch as it was found, and of the best aim beside it.

    ``found`` and ``best``: shares of the same ``count`` scattered runs, with 95 % intervals;
    ``velocity`` (vx, vy) m/s and ``spin`` rad/s: what to aim at for the best.  ``failed``: runs
    that could not be followed to their end, which count as misses.
    """

    found: Chance
    best: Chance
    velocity: tuple[float, float]
    spin: float
    failed: int


class Wish(NamedTuple):
    """Which puck is to end where on a board when which is sent off; ``pocket`` None: at a place."""

    scene: SceneSpec
    striker: str
    puck: str
    target: tuple[float, float]
    pocket: int | None


class _Range:
    """Copies of a board on which a launch is tried, scattered."""

    def __init__(self, wish: Wish, scatter: FloatArray, within: float, count: int) -> None:
        self._boards, self._within, self._wish = Worlds(wish.scene, count), within, wish
        self._scatter, self._count = scatter, count
        self._number = self._boards.names.index(wish.puck)
        self._until = math.inf if wish.scene.time is None else wish.scene.time
        self.failed = 0

    def hits(self, centre: FloatArray, draws: FloatArray) -> npt.NDArray[np.bool_]:
        """Which runs with heading, speed, spin about a centre (3,) do it; draws (runs, 3)."""
        some, boards = np.arange(len(draws)), self._boards
        heading, share, spin = (self._scatter * draws).T
        speed = centre[1] * (1.0 + share)
        boards.reset()
        velocities = speed[:, None] * _along(centre[0] + heading)
        boards.strike(self._wish.striker, velocities, centre[2] + spin, boards=some)
        lost = np.zeros(self._count, bool)
        lost[len(draws) :] = True
        while True:
            try:
                boards.advance(self._until)
                break
            except PuckError as error:
                if not error.boards:
                    raise
                lost[list(error.boards)] = True
                boards.remove(self._wish.striker, boards=list(error.boards))
        self.failed = int(lost[: len(draws)].sum())
        return (self._ends() & ~lost)[: len(draws)]

    def _ends(self) -> npt.NDArray[np.bool_]:
        """On which boards the puck is where it is to be."""
        if self._wish.pocket is None:
            places = self._boards.state()[:, self._number, :2]
            near = np.hypot(*(places - self._wish.target).T) <= self._within
            return np.asarray(near & self._boards.in_play[:, self._number])
        events, fallen = self._boards.events, np.zeros(self._count, bool)
        mine = (events["what"] == "pocket") & (events["puck"] == self._wish.puck)
        mine &= events["partner"] == f"pocket {self._wish.pocket}"
        fallen[events["board"][mine]] = True
        return fallen


def _along(heading: FloatArray) -> FloatArray:
    return np.stack([np.cos(heading), np.sin(heading)], axis=-1)


def odds_of(
    wish: Wish, start: FloatArray, heading: float, speed: float, spin: float,
    within: float | None, count: int, seed: int,
) -> Odds:  # fmt: skip
    """The odds of a launch (heading, speed, spin): see ``BoardAim.odds``."""
    pairs = (("heading", heading, "rad"), ("speed", speed, ""), ("spin", spin, "rad/s"))
    scatter = np.array([real(name, value, unit) for name, value, unit in pairs])
    if (scatter < 0.0).any() or not scatter.any():
        raise InputError("heading, speed and spin scatter by 0 or more, and one of them by more")
    if (within is None) == (wish.pocket is None):
        words = "give within, m: how near" if within is None else "leave within out: a pocket is"
        raise InputError(f"{words} the puck is to end")
    near = 0.0 if within is None else positive("within", within, "m")
    count, seed = whole("count", count, _TRIED), whole("seed", seed, 0)
    pucks = enumerate(pucks_of(wish.scene))
    if any(called(puck, n) == wish.striker and puck.launch.time > 0.0 for n, puck in pucks):
        raise InputError("odds are of a striker that is sent off at once: launch.time is 0")
    drawn = np.random.default_rng(seed).normal(size=(2, count, 3))
    boards = _Range(wish, scatter, near, count)
    best = _climb(boards, start, scatter * [1.0, start[1], 1.0], drawn[0, :_TRIED])
    found = boards.hits(start, drawn[1]).sum()
    failed, better = boards.failed, boards.hits(best, drawn[1]).sum()
    if better > found:
        failed = boards.failed
    else:
        best, better = start, found
    vx, vy = (best[1] * _along(best[:1])[0]).tolist()
    chances = chance_of(int(found), count), chance_of(int(better), count)
    return Odds(*chances, (vx, vy), float(best[2]), failed)


def _climb(
    boards: _Range, start: FloatArray, step: FloatArray, draws: FloatArray
) -> FloatArray:  # fmt: skip
    """The aim with the most hits of the same draws, from step to step."""
    centre, most = start, boards.hits(start, draws).sum()
    step = _DEVIATIONS * step
    for _ in range(_ROUNDS):
        moves = [sign * row for row in np.diag(step) if row.any() for sign in (1.0, -1.0)]
        hits = [boards.hits(centre + move, draws).sum() for move in moves]
        if max(hits) > most:
            centre, most = centre + moves[int(np.argmax(hits))], max(hits)
        else:
            step = 0.5 * step
    return centre

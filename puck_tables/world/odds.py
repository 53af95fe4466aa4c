"""How likely a launch on a board does what it is for, where nobody hits it exactly."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray, positive, real, whole
from puck_tables.bulk.summary import Chance, chance_of
from puck_tables.errors import InputError, PuckError
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.world.agreement import pucks_of
from puck_tables.world.targets import Target
from puck_tables.world.worlds import Worlds

_TRIED = 400  # runs of each aim that is tried
_ROUNDS = 12  # of steps of the search, which are halved where none helps


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

    def __str__(self) -> str:
        (vx, vy), degrees = self.velocity, math.degrees(1.0)
        aim = f"{math.hypot(vx, vy):.6g} m/s, heading {degrees * math.atan2(vy, vx):.5g} deg"
        lost = f"\n{self.failed} runs could not be followed to their end: misses"
        return (
            f"scattered so, the launch does it with a chance of {_words(self.found)}\n"
            f"the best aim found, {aim}, spin {self.spin:.5g} rad/s, with {_words(self.best)}"
            f"{lost if self.failed else ''}"
        )

    def summary(self) -> dict[str, Any]:
        """Chances and aim, ready for JSON."""
        chances = {"found": self.found._asdict(), "best": self.best._asdict()}
        return self._asdict() | chances


def _words(chance: Chance) -> str:
    return f"{chance.value:.3g} (95 %: {chance.low:.3g} to {chance.high:.3g})"


class _Trials:
    """A board on which a launch is tried, scattered."""

    def __init__(
        self, scene: SceneSpec, wanted: Target, scatter: FloatArray, within: float
    ) -> None:
        self._start, self._wanted, self._scatter = Worlds(scene, 1), wanted, scatter
        self._within, self._until = within, math.inf if scene.time is None else scene.time
        self.failed = 0

    def hits(self, centre: FloatArray, draws: FloatArray) -> npt.NDArray[np.bool_]:
        """Which runs with heading, speed, spin about a centre (3,) do it; draws (runs, 3)."""
        heading, share, spin = (self._scatter * draws).T
        speed = centre[1] * (1.0 + share)
        boards, runs = self._start.copy(np.zeros(len(draws), int)), np.arange(len(draws))
        velocities = speed[:, None] * _along(centre[0] + heading)
        boards.strike(self._wanted.striker, velocities, centre[2] + spin)
        hit = np.zeros(len(draws), bool)
        while runs.size:
            try:
                boards.advance(self._until)
                hit[runs] = self._ends(boards)
                break
            except PuckError as error:
                if not error.boards:
                    raise
                left = np.setdiff1d(np.arange(len(runs)), error.boards)
                runs, boards = runs[left], boards.copy(left) if left.size else boards
        self.failed = len(draws) - len(runs)
        return hit

    def _ends(self, boards: Worlds) -> npt.NDArray[np.bool_]:
        """On which boards the puck is where it is to be."""
        wanted = self._wanted
        if wanted.pocket < 0:
            places = boards.state()[:, wanted.puck, :2]
            near = np.hypot(*(places - wanted.place).T) <= self._within
            return np.asarray(near & boards.in_play[:, wanted.puck])
        events, fallen = boards.events, np.zeros(len(boards), bool)
        mine = (events["what"] == "pocket") & (events["puck"] == boards.names[wanted.puck])
        mine &= events["partner"] == f"pocket {wanted.pocket}"
        fallen[events["board"][mine]] = True
        return fallen


def _along(heading: FloatArray) -> FloatArray:
    return np.stack([np.cos(heading), np.sin(heading)], axis=-1)


def odds_of(
    scene: SceneSpec, wanted: Target, start: FloatArray, heading: float, speed: float, spin: float,
    within: float | None, count: int, seed: int,
) -> Odds:  # fmt: skip
    """The odds of a launch (heading, speed, spin): see ``BoardAim.odds``."""
    pairs = (("heading", heading, "rad"), ("speed", speed, ""), ("spin", spin, "rad/s"))
    scatter = np.array([real(name, value, unit) for name, value, unit in pairs])
    if (scatter < 0.0).any() or not scatter.any():
        raise InputError("heading, speed and spin scatter by 0 or more, and one of them by more")
    if (within is None) == (wanted.pocket < 0):
        words = "give within, m: how near" if within is None else "leave within out: a pocket is"
        raise InputError(f"{words} the puck is to end")
    near = 0.0 if within is None else positive("within", within, "m")
    count, seed = whole("count", count, _TRIED), whole("seed", seed, 0)
    if pucks_of(scene)[wanted.striker].launch.time > 0.0:
        raise InputError("odds are of a striker that is sent off at once: launch.time is 0")
    drawn = np.random.default_rng(seed).normal(size=(2, count, 3))
    boards = _Trials(scene, wanted, scatter, near)
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
    boards: _Trials, start: FloatArray, step: FloatArray, draws: FloatArray
) -> FloatArray:  # fmt: skip
    """The aim with the most hits of the same draws, from step to step."""
    centre, most = start, boards.hits(start, draws).sum()
    for _ in range(_ROUNDS):
        moves = [sign * row for row in np.diag(step) if row.any() for sign in (1.0, -1.0)]
        hits = [boards.hits(centre + move, draws).sum() for move in moves]
        if max(hits) > most:
            centre, most = centre + moves[int(np.argmax(hits))], max(hits)
        else:
            step = 0.5 * step
    return centre

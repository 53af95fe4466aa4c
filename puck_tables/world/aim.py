"""Aiming on a board: launches of one puck after which another, or it itself, ends at a place.

Into a pocket not single launches lead, but regions with a middle.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import (
    FloatArray,
    checked_progress,
    finite_array,
    positive,
    real,
    whole,
)
from puck_tables._core.waiting import Progress
from puck_tables.errors import InputError
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.world.aimed import BoardAim, aimed
from puck_tables.world.engine_state import Whole
from puck_tables.world.named_pucks import pucks_of, start_of
from puck_tables.world.shots import Landings, Shots, effort_for, good, headings_for, take_sample
from puck_tables.world.solving import HEADINGS, Which, stops_at
from puck_tables.world.targets import Target, lying_there, out_of_reach, target_of, without_pocket

_FIRST = 1e-7  # of the range: the first step from a launch to the ends of its interval
_LADDER = 24  # steps, each twice the one before
_PARTS, _DIVISIONS = 12, 4  # into how many parts a bracket of an end is cut, and how often
_WITHIN = 31  # places in an interval that are looked at
_TURNS = 2  # from the middle of one interval to that of the other
_MOST = 16  # regions
MOST_COUNT, MOST_IMPACTS, MOST_SPINS = 1000, 20, 1000  # launches, impacts of one, spins asked for
PLENTY = 3.0  # the greatest speed over that which slides the whole way
PLENTY_SPIN = 2.0  # the greatest rim speed over the speed
_LEAST = 1e-6  # of the greatest speed


class LaunchRegions(NamedTuple):
    """Launches (n, 2) in the middle, the widths (n, 2) of the intervals there, where they land."""

    launches: FloatArray
    widths: FloatArray
    landings: Landings


class Pocketing:
    """Regions of launches on a board that end in the obstacle ``outcome``, with few enough impacts.

    ``most``: how many; ``wanted``: whether by the way asked for; ``low``, ``high``: between which
    the speed (or spin) may be.
    """

    def __init__(
        self, shots: Shots, outcome: int, most: int, wanted: bool, low: float, high: float
    ) -> None:
        self.shots, self.outcome, self.most, self.wanted = shots, outcome, most, wanted
        self.low, self.high = low, high

    def falls(self, landings: Landings) -> Which:
        """Which of them end there."""
        return good(landings, self.most, self.wanted) & (landings.outcomes == self.outcome)

    def regions(self, launches: FloatArray) -> LaunchRegions:
        """The regions in which some of these launches lie, the widest first.

        Each is given by a launch half-way between the ends of both intervals through it, of the
        heading and of the speed (or spin); ends are those of what is met first.
        """
        landings = self.shots.land(launches)
        inside = np.flatnonzero(self.falls(landings))
        inside = self._some(inside, landings.prints)
        middles = launches[inside].copy()
        widths = np.zeros_like(middles)
        for turn in range(2 * _TURNS):
            axis = (turn + 1) % 2
            if len(middles):
                ends = self._interval(middles, axis)
                middles[:, axis] += 0.5 * (ends[:, 0] + ends[:, 1])
                widths[:, axis] = ends[:, 1] - ends[:, 0]
        landings = self.shots.land(middles)
        order = np.flatnonzero(self.falls(landings) & (widths > 0.0).all(axis=1))
        share = (widths / np.array([HEADINGS, self.high - self.low])).min(axis=1)
        kept: list[int] = []
        for n in order[np.argsort(-share[order], kind="stable")].tolist():
            gaps = middles[kept] - middles[n]
            gaps[:, 0] = (gaps[:, 0] + math.pi) % HEADINGS - math.pi
            same = landings.prints[kept] == landings.prints[n]
            if not (same & (np.abs(gaps) < 0.5 * widths[kept]).all(axis=1)).any():
                kept.append(n)
        return LaunchRegions(middles[kept], widths[kept], landings.at(np.array(kept, np.int64)))

    def _some(self, inside: Whole, prints: Whole) -> Whole:
        """A few of each sequence in turn."""
        seen: dict[int, int] = {}
        turns = []
        for n in inside.tolist():
            seen[int(prints[n])] = seen.get(int(prints[n]), 0) + 1
            turns.append(seen[int(prints[n])])
        return inside[np.argsort(turns, kind="stable")[:_MOST]]

    def _interval(self, middles: FloatArray, axis: int) -> FloatArray:
        """How far the intervals of one number reach to both sides, (n, 2)."""
        span = HEADINGS if axis == 0 else self.high - self.low
        ends = np.empty((len(middles), 2))
        for side, sign in enumerate((-1.0, 1.0)):
            room = np.full(len(middles), 0.5 * span)
            if axis == 1:
                room = sign * ((self.low, self.high)[side] - middles[:, 1])
            steps = np.minimum(_FIRST * span * 2.0 ** np.arange(_LADDER), room[:, None])
            inner, outer = self._last_in(middles, axis, sign, np.zeros_like(room), steps)
            for _ in range(_DIVISIONS):
                parts = np.linspace(0.0, 1.0, _PARTS + 1)[1:]
                steps = inner[:, None] + (outer - inner)[:, None] * parts
                inner, outer = self._last_in(middles, axis, sign, inner, steps)
            within = inner[:, None] * (np.arange(_WITHIN) + 1.0) / _WITHIN
            inner, _ = self._last_in(middles, axis, sign, np.zeros_like(room), within)
            ends[:, side] = sign * inner
        return ends

    def _last_in(
        self, middles: FloatArray, axis: int, sign: float, known: FloatArray, steps: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """The last of steps (n, k) from the middles before one leads out, and the next.

        The same where none does.  ``known`` (n,): one that does not.
        """
        tried = np.repeat(middles[:, None], steps.shape[1], axis=1)
        tried[:, :, axis] += sign * steps
        falls = self.falls(self.shots.land(tried.reshape(-1, 2))).reshape(steps.shape)
        last = np.where(falls.all(axis=1), steps.shape[1], np.argmin(falls, axis=1))[:, None]
        ladder = np.hstack([known[:, None], steps])
        after = np.minimum(last + 1, steps.shape[1])
        return (
            np.take_along_axis(ladder, last, 1)[:, 0], np.take_along_axis(ladder, after, 1)[:, 0]
        )  # fmt: skip


class Search(NamedTuple):
    """Headings by speeds at a ``spin``, or by spins at a ``speed``, from ``low`` to ``high``."""

    spin: float | None
    speed: float | None
    low: float
    high: float

    def velocities(self, launches: FloatArray) -> FloatArray:
        """From headings and speeds (or spins) (n, 2) to vx, vy, spin (n, 3)."""
        heading, second = launches.T
        speed = second if self.speed is None else np.full(len(launches), self.speed)
        spin = second if self.spin is None else np.full(len(launches), self.spin)
        return np.stack([speed * np.cos(heading), speed * np.sin(heading), spin], axis=1)

    def run(self, shots: Shots, wanted: Target, most: int, spare: Shots | None) -> Solutions:
        """What it finds; ``spare``: shots on the board without the pocket."""
        aimed_at = spare or shots
        effort = effort_for(shots)
        seconds = self.low + (self.high - self.low) * (np.arange(effort.rows) + 1.0) / effort.rows
        headings = headings_for(shots.scene, wanted.striker, effort.headings)
        has_through, itself = wanted.through >= 0, wanted.puck == wanted.striker
        sample = take_sample(aimed_at, headings, seconds, most, effort)
        fine = good(sample.landings, most, has_through) & (sample.landings.outcomes == 0)
        fine &= itself | (sample.landings.lengths > 0)
        close = shots.close_to(seconds.max())
        roots = stops_at(aimed_at, sample, fine, wanted.place, close, self.low, self.high)
        if spare is None:
            starts = self.velocities(roots.launches)
            return Solutions(starts, shots.sensitivities(starts))
        falling = Pocketing(
            shots, wanted.obstacle(shots.scene), most, has_through, self.low, self.high
        )  # fmt: skip
        sample = take_sample(shots, headings, seconds, most, effort)
        some = sample.launches[falling.falls(sample.landings)]
        regions = falling.regions(np.vstack([roots.launches, some]))
        return Solutions(self.velocities(regions.launches), regions.widths)


class Solutions(NamedTuple):
    """Launches vx, vy, spin (n, 3); (n, 2) how their ends change, or widths of their intervals."""

    starts: FloatArray
    margins: FloatArray


def aim(
    scene: SceneSpec, target: npt.ArrayLike | None, *, puck: int | str | None,
    striker: int | str | None, pocket: int | str | None, hits: int | str | None,
    spin: npt.ArrayLike | None, speed: float | None, max_speed: float | None,
    max_spin: float | None, max_impacts: int, count: int, progress: Progress | None,
) -> BoardAim:  # fmt: skip
    """Launches on a board, as :meth:`puck_tables.Scene.aim` has them."""
    checked_progress(progress)
    max_impacts = whole("max_impacts", max_impacts, 0, MOST_IMPACTS)
    count = whole("count", count, 1, MOST_COUNT)
    wanted = target_of(scene, target, pocket, puck, striker, hits)
    searches = _searches(scene, wanted, spin, speed, max_speed, max_spin)
    if wanted.pocket < 0 and wanted.puck != wanted.striker:
        lying = pucks_of(scene)[wanted.puck]
        if math.dist(start_of(lying), wanted.place) == 0.0 and lying.launch.velocity is None:
            return aimed(
                scene, wanted, "{puck} lies there: any launch that leaves it alone will do"
            )
    fastest = max(abs(one.speed or one.high) for one in searches)
    widest = max(abs(one.high if one.spin is None else one.spin) for one in searches)
    slip = fastest + pucks_of(scene)[wanted.striker].radius * widest
    limit, never = _limit(searches), out_of_reach(scene, wanted, fastest, widest)
    if never:
        return aimed(scene, wanted, f"no launch {limit} {never}", limit=limit)
    spare = without_pocket(scene, wanted)
    runs = left_out = 0
    solutions: list[Solutions] = []
    for patient in (False, True):
        for n, search in enumerate(searches):
            both = [
                Shots(board, *wanted[:3], max_impacts, search.velocities, slip, patient)
                for board in (scene, spare) if board is not None
            ]  # fmt: skip
            solutions.append(search.run(both[0], wanted, max_impacts, both[1] if spare else None))
            runs += sum(shots.runs for shots in both)
            left_out += sum(shots.left_out for shots in both)
            if progress is not None:
                progress(n + 1, len(searches))
        if any(len(one.starts) for one in solutions) or not left_out:
            break
        left_out = 0
    starts = np.vstack([one.starts for one in solutions])
    margins = np.vstack([one.margins for one in solutions])
    return aimed(
        scene, wanted, _answer(scene, wanted, limit, max_impacts, runs, left_out), starts, margins,
        of_spin=searches[0].speed is not None, count=count, limit=limit,
    )  # fmt: skip


def _limit(searches: list[Search]) -> str:
    """Which launches are looked for, in words."""
    speed, high = searches[-1].speed, searches[-1].high
    if speed is not None:
        return f"at {speed:.6g} m/s and up to {high:.6g} rad/s either way"
    spins = [f"{spin:.6g}" for spin in sorted({one.spin or 0.0 for one in searches})]
    ends = " to ".join(dict.fromkeys([spins[0], spins[-1]]))
    return f"up to {high:.6g} m/s {'without spin' if ends == '0' else f'at {ends} rad/s'}"


def _answer(
    scene: SceneSpec, wanted: Target, limit: str, most: int, runs: int, left_out: int
) -> str:
    """What is said where nothing was found: that it is a search, no proof."""
    words = (
        f"no launch {limit} with at most {most} impact{'' if most == 1 else 's'} found among "
        f"{runs} tried; that there is none is not proved"
    )
    there = lying_there(scene, wanted)
    if there:
        words += f"; {there} lies there and would have to move away"
    if left_out:
        words += f"; {left_out} in which pucks push each other could not be followed"
    return words


def _searches(
    scene: SceneSpec, wanted: Target, spin: npt.ArrayLike | None, speed: float | None,
    max_speed: float | None, max_spin: float | None,
) -> list[Search]:  # fmt: skip
    """One for each spin, or one over spins."""
    puck = pucks_of(scene)[wanted.striker]
    if spin is not None and speed is not None:
        raise InputError(
            "spin and speed are both given: a heading alone reaches no place; give one of them"
        )
    fastest = None if max_speed is None else positive("max_speed", max_speed, "m/s")
    widest = None if max_spin is None else positive("max_spin", max_spin, "rad/s")
    if speed is not None:
        chosen = positive("speed", speed, "m/s")
        if fastest is not None and chosen > fastest:
            raise InputError(f"speed = {chosen:g} m/s is above max_speed = {fastest:g} m/s")
        widest = PLENTY_SPIN * chosen / puck.radius if widest is None else widest
        return [Search(None, chosen, -widest, widest)]
    spins = np.atleast_1d(finite_array("spin", puck.launch.spin if spin is None else spin, "rad/s"))
    if spins.ndim != 1 or not 1 <= spins.size <= MOST_SPINS:
        raise InputError(f"spin must be a number or a list of at most {MOST_SPINS}")
    if widest is not None and np.abs(spins).max() > widest:
        raise InputError(
            f"spin = {spins[np.argmax(np.abs(spins))]:g} rad/s is above max_spin = {widest:g} rad/s"
        )
    if fastest is None:
        fastest = _plenty(scene, wanted)
    return [Search(real("spin", one, "rad/s"), None, _LEAST * fastest, fastest) for one in spins]


def _plenty(scene: SceneSpec, wanted: Target) -> float:
    """A speed that is surely enough: three times that which slides the whole way.

    Raises InputError if nothing brakes the striker.
    """
    pucks = pucks_of(scene)
    striker, puck = pucks[wanted.striker], pucks[wanted.puck]
    start = start_of(striker)
    length = math.dist(start, wanted.place)
    if wanted.puck != wanted.striker:
        length = math.dist(start, start_of(puck)) + math.dist(start_of(puck), wanted.place)
    if wanted.through >= 0:
        length += 2.0 * math.dist(start, start_of(pucks[wanted.through]))
    share = min(1.0, 2.0 * striker.mass / (striker.mass + puck.mass))
    decel = max(striker.decel, puck.decel)
    if striker.friction == 0.0:
        raise InputError("nothing brakes the striker (its friction is 0): give max_speed")
    return PLENTY * math.sqrt(2.0 * decel * max(length, striker.radius)) / share

"""Shots of one puck on a board: where another, or it itself, ends, for many launches at once.

A sample of them has headings by speeds (or spins), dense where the impacts of a puck change.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables._core.executor import keep_on
from puck_tables.errors import ContactError, PuckError
from puck_tables.scene.by_speed import end_of_laws
from puck_tables.scene.map_of_floor import MANY
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.stopping.stops import stop_on_base
from puck_tables.world.agreement import frictions_under, is_integrated, segment_error
from puck_tables.world.bulk import LENGTH, OUTCOME, PASSES, PRINT, follow_all, trace
from puck_tables.world.engine_state import Engine, Whole
from puck_tables.world.floor_under import SURE, law_goes_to
from puck_tables.world.floors import may_be_mixed, velocities_under
from puck_tables.world.named_pucks import pucks_of, start_of, with_launch
from puck_tables.world.plan import acting
from puck_tables.world.prepare import STEP_SHARE, Start, order_of, prepared, with_law_up_to
from puck_tables.world.setting_off import PUSHING, REACHED
from puck_tables.world.world import World

_AT_ONE = 48  # headings towards one disc that looks small
_SMALL = 8.0  # steps of the heading: less is small
_WIDER = 3.0  # by how much the headings towards a disc are more than it takes, for paths that bend
_CLOSEST = 1e-7  # rad: closer headings are not parted
_SHARES = (0.02, 0.1, 0.5)  # of the time that the striker may slide: then sequences are looked at
_STEP = 1e-7  # of a difference: rad, or of the speed
NO_SEQUENCE = -1  # the print of a run without an end


class Effort(NamedTuple):
    """How many headings, rows of speeds (or spins), and launches more where sequences change."""

    headings: int
    rows: int
    more: int


_FULL, _MANY, _SLOW = Effort(540, 28, 8000), Effort(360, 20, 4000), Effort(120, 10, 600)
_CROWD = 8  # pucks: runs of more take longer
_ROUNDS = 3  # times that gaps get three launches each: to 1/64 of a step of the sample


def effort_for(shots: Shots) -> Effort:
    """The less, the longer a run takes."""
    if shots.patient:
        return _SLOW
    return _FULL if len(pucks_of(shots.scene)) <= _CROWD else _MANY


class TriedLaunches(NamedTuple):
    """Launches (n, 2) with their rows (n,), and where they land; ordered by row and heading."""

    launches: FloatArray
    rows: Whole
    landings: Landings


def headings_for(scene: SceneSpec, striker: int, count: int) -> FloatArray:
    """Headings all around, rad, and closer ones towards pucks and posts that look small."""
    step = 2.0 * math.pi / count
    parts = [np.arange(count) * step]
    pucks = pucks_of(scene)
    x, y = start_of(pucks[striker])
    rims = [(start_of(puck), puck.radius) for puck in pucks]
    del rims[striker]
    rims += [(post.point, post.radius) for post in scene.posts]
    for (px, py), radius in rims:
        reach, distance = radius + pucks[striker].radius, math.hypot(px - x, py - y)
        half = math.asin(min(reach / max(distance, 1e-300), 1.0))
        if 2.0 * half < _SMALL * step:
            parts.append(
                math.atan2(py - y, px - x) + _WIDER * half * np.linspace(-1.0, 1.0, _AT_ONE)
            )
    return np.unique(np.concatenate(parts) % (2.0 * math.pi))


def take_sample(
    shots: Shots, headings: FloatArray, seconds: FloatArray, most: int, effort: Effort
) -> TriedLaunches:
    """Launches of all headings at all speeds (or spins), and more between sequences that differ.

    ``most``: impacts that a sequence may have.
    """
    launches = np.stack(np.meshgrid(headings, seconds), axis=2).reshape(-1, 2)
    rows = np.repeat(np.arange(len(seconds)), len(headings))
    sample = TriedLaunches(launches, rows, shots.land(launches))
    left = effort.more
    for _ in range(_ROUNDS):
        gaps = _gaps(sample, most)[: left // 3]
        if not len(gaps):
            break
        left -= 3 * len(gaps)
        sample = _with_more(shots, sample, gaps)
    return sample


def _gaps(sample: TriedLaunches, most: int) -> Whole:
    """Where the sequence changes from a launch to the next heading, those of few impacts first."""
    landings = sample.landings
    first, wide = _neighbours(sample)
    after = _next(sample)
    lengths = np.minimum(landings.lengths, landings.lengths[after])
    changes = (landings.prints != landings.prints[after]) & (lengths <= most) & (wide > _CLOSEST)
    changes &= first
    places = np.flatnonzero(changes)
    return places[np.lexsort((-wide[places], lengths[places]))]


def _next(sample: TriedLaunches) -> Whole:
    """The launch of the next heading in the same row, the last one's is the first."""
    after = np.arange(1, len(sample.rows) + 1)
    starts = np.flatnonzero(np.diff(sample.rows, prepend=-1))
    after[np.append(starts[1:], len(sample.rows)) - 1] = starts
    return after


def _neighbours(sample: TriedLaunches) -> tuple[FloatArray, FloatArray]:
    """Which have a next one, and how far it is, rad."""
    wide = (sample.launches[_next(sample), 0] - sample.launches[:, 0]) % (2.0 * math.pi)
    return wide > 0.0, wide


def _with_more(shots: Shots, sample: TriedLaunches, gaps: Whole) -> TriedLaunches:
    """The sample with three launches more in each of these gaps."""
    _, wide = _neighbours(sample)
    shares = np.array([0.25, 0.5, 0.75])
    headings = (sample.launches[gaps, 0, None] + wide[gaps, None] * shares) % (2.0 * math.pi)
    more = np.stack([headings, np.repeat(sample.launches[gaps, 1:], 3, axis=1)], axis=2)
    more = more.reshape(-1, 2)
    landings = sample.landings.before(shots.land(more))
    launches = np.vstack([sample.launches, more])
    rows = np.concatenate([sample.rows, np.repeat(sample.rows[gaps], 3)])
    order = np.lexsort((launches[:, 0], rows))
    return TriedLaunches(launches[order], rows[order], landings.at(order))


def good(landings: Landings, most: int, wanted: bool) -> FloatArray:
    """Which landings count: few enough impacts, by the way asked for, with an end."""
    fine = (landings.prints != NO_SEQUENCE) & (landings.lengths <= most)
    return fine & (landings.passes == 1) if wanted else fine


class Landings(NamedTuple):
    """Where runs end: x, y (n,) m, and after which impacts."""

    x: FloatArray
    y: FloatArray
    prints: Whole
    lengths: Whole
    outcomes: Whole
    passes: Whole

    def at(self, which: npt.NDArray[np.int64] | npt.NDArray[np.bool_]) -> Landings:
        """Some of them."""
        columns: Any = [one[which] for one in self]
        return Landings(*columns)

    def before(self, more: Landings) -> Landings:
        """These, then others."""
        columns: Any = [np.concatenate(pair) for pair in zip(self, more, strict=True)]
        return Landings(*columns)


class Shots:
    """A board of which the launch of one puck, the striker, is open.

    ``runs``, ``left_out``: how many were asked for, and how many of them were not followed.

    ``scene``: without ranges; ``striker``, ``puck``: numbers of the puck that is sent, and of the
    one whose end is looked for; ``through``: number of a puck that is to be hit on the way, or −1;
    ``most``: impacts that may lead the puck to its end; ``velocities``: from launches (n, 2) to vx,
    vy, spin (n, 3); ``patient``: whether runs in which pucks push each other are followed, one by
    one, which takes a thousand times as long.  Where pucks are integrated it is done.
    ``fastest``: slip of the striker's rim at a launch, on a floor at rest, m/s.
    """

    def __init__(
        self, scene: SceneSpec, striker: int, puck: int, through: int, most: int,
        velocities: Callable[[FloatArray], FloatArray], fastest: float, patient: bool = False,
    ) -> None:  # fmt: skip
        self.scene, self.striker, self.velocities = scene, striker, velocities
        self.until = math.inf if scene.time is None else scene.time
        start = _finely(scene)
        self._first, place = start.states, np.argsort(start.order)
        self._disc = int(place[striker])
        self._engine = _law_for_launches(fastest, scene, start, self._disc)
        self._watch = int(place[puck]), int(place[through]) if through >= 0 else -1, most
        pucks = pucks_of(scene)
        self.patient = (
            patient
            or may_be_mixed(scene)
            or any(
                is_integrated(scene, puck, friction)
                for puck in pucks
                for friction in frictions_under(scene, puck)
            )
        )
        self.runs = self.left_out = 0
        free = self.until == math.inf and not (scene.pucks or acting(scene))
        self._slides = free and scene.puck.shape is not None and scene.puck.pressure == "uniform"

    def land(self, launches: FloatArray) -> Landings:
        """Where the puck ends after launches (n, 2)."""
        return self.follow(self.velocities(launches))

    def follow(self, starts: FloatArray) -> Landings:
        """Where it ends after launches vx, vy, spin (n, 3)."""
        self.runs += len(starts)
        if self._slides:
            return self._slid(starts)
        ends = follow_all(
            self._engine, self._first, np.array([self._disc]), starts[:, None], self.until,
            self._watch,
        )  # fmt: skip
        x, y = ends.states[:, self._watch[0], 0], ends.states[:, self._watch[0], 1]
        few = ends.sequences[:, LENGTH] <= self._watch[2]
        pushing = np.flatnonzero((ends.how == PUSHING) & few)
        self.left_out += 0 if self.patient else len(pushing)
        for run in pushing if self.patient else ():
            keep_on()
            self._alone(starts[run], ends.sequences[run], ends.states[run], ends.how, int(run))
        moving = (ends.states[:, self._watch[0], 3:6] != 0.0).any(axis=1)
        sequences = ends.sequences
        open_yet = (ends.how != REACHED) | (moving & (sequences[:, OUTCOME] == 0))
        sequences[open_yet, PRINT] = NO_SEQUENCE
        return Landings(x, y, *sequences[:, [PRINT, LENGTH, OUTCOME, PASSES]].T)

    def _slid(self, starts: FloatArray) -> Landings:
        """Where a free puck on a base ends, which takes no board."""
        puck = pucks_of(self.scene)[self.striker]
        turn = cmath.rect(1.0, puck.launch.orientation)
        along = (starts[:, 0] + 1j * starts[:, 1]) / turn
        velocities = np.stack([along.real, along.imag], axis=1)
        stops = stop_on_base(puck, velocities, starts[:, 2], segment_error(self.scene), 1)
        x, y = stops.stop_position.T
        place = complex(*start_of(puck)) + (x + 1j * y) * turn
        none = np.zeros(len(starts), np.int64)
        prints = np.where(stops.status == 0, none, NO_SEQUENCE)
        return Landings(place.real, place.imag, prints, none, none, none)

    def board(self, start: FloatArray) -> SceneSpec:
        """The board with a launch vx, vy, spin (3,)."""
        return with_launch(self.scene, self.striker, start)

    def _alone(
        self, start: FloatArray, sequence: Whole, states: FloatArray, how: Whole, run: int
    ) -> None:
        """A run in which pucks push each other, or are integrated."""
        prints, marks = np.zeros(len(states), np.int64), np.zeros(len(states), np.int64)
        try:
            world = World.since(_finely(self.board(start)))
            for share in (*_SHARES, math.inf):
                world.advance(min(self.until, share * self._span(start)) - world.time)
                trace(world._engine, *self._watch[:2], prints, marks, sequence)
                if sequence[LENGTH] > self._watch[2]:
                    break
        except PuckError:
            return
        order = order_of(self.scene)
        states[:] = world.state()[order]
        states[~world.moving[order], 3:] = 0.0
        how[run] = REACHED

    def _span(self, start: FloatArray) -> float:
        """How long the striker may slide, s."""
        decel = pucks_of(self.scene)[self.striker].decel
        return math.hypot(start[0], start[1]) / decel if decel > 0.0 else math.inf

    def close_to(self, speed: float) -> float:
        """How near to a target is on it, m: the tolerance of the scene at a speed, m/s."""
        puck = pucks_of(self.scene)[self.striker]
        reach = speed * speed / puck.decel if puck.decel > 0.0 else puck.radius
        return self.scene.tol * max(reach, puck.radius)

    def sensitivities(self, starts: FloatArray) -> FloatArray:
        """How far the end moves per degree of heading and per cent of speed, (n, 2) m.

        inf where the sequence is another on both sides.
        """
        here = self.follow(starts)
        out = np.full((len(starts), 2), np.inf)
        for column, unit in enumerate((math.radians(1.0), 0.01)):
            for step in (-_STEP, _STEP):
                turned = starts.copy()
                if column == 0:
                    cosine, sine = math.cos(step), math.sin(step)
                    turned[:, :2] = starts[:, :2] @ np.array([[cosine, sine], [-sine, cosine]])
                else:
                    turned[:, :2] *= 1.0 + step
                there = self.follow(turned)
                moved = np.hypot(there.x - here.x, there.y - here.y) * unit / abs(step)
                same = there.prints == here.prints
                out[same, column] = moved[same]
        return out


def _finely(scene: SceneSpec) -> Start:
    """The start of runs whose differences are slopes: they step as finely as look-ups are good."""
    start = prepared(scene.single(), runs=MANY)  # a search follows thousands
    start.engine.scale[2] = STEP_SHARE * segment_error(scene)
    return start


def _law_for_launches(fastest: float, scene: SceneSpec, start: Start, disc: int) -> Engine:
    """The engine with laws by name known for a rim that is launched at up to ``fastest``, m/s.

    Runs that are faster are followed one by one.
    """
    sx, sy, turning = velocities_under(start.engine, start.states)[disc].tolist()
    floor = math.hypot(sx, sy) + pucks_of(scene)[start.order[disc]].radius * abs(turning)
    top = min((fastest + floor) / SURE, end_of_laws(scene)[0])
    if top <= law_goes_to(start.engine.regions):
        return start.engine
    try:
        return with_law_up_to(start.engine, scene, start.order, top, MANY)
    except ContactError:  # it lifts part of a base: a run alone says so
        return start.engine

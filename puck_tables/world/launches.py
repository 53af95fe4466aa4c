"""A sample of launches: headings by speeds (or spins), dense where the course of a puck changes."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.world.agreement import pucks_of, start_of
from puck_tables.world.engine_state import Whole
from puck_tables.world.shots import NO_COURSE, Landings, Shots

_AT_ONE = 48  # headings towards one disc that looks small
_SMALL = 8.0  # steps of the heading: less is small
_WIDER = 3.0  # by how much the headings towards a disc are more than it takes, for paths that bend
_CLOSEST = 1e-7  # rad: closer headings are not parted


class Effort(NamedTuple):
    """How many headings, rows of speeds (or spins), and launches more where courses change."""

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
    """Launches of all headings at all speeds (or spins), and more between courses that differ.

    ``most``: impacts that a course may have.
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
    """Where the course changes from a launch to the next heading, those of few impacts first."""
    landings = sample.landings
    first, wide = _neighbours(sample)
    after = _next(sample)
    lengths = np.minimum(landings.lengths, landings.lengths[after])
    changes = (landings.prints != landings.prints[after]) & (lengths <= most) & (wide > _CLOSEST)
    changes &= first
    found = np.flatnonzero(changes)
    return found[np.lexsort((-wide[found], lengths[found]))]


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
    fine = (landings.prints != NO_COURSE) & (landings.lengths <= most)
    return fine & (landings.passes == 1) if wanted else fine

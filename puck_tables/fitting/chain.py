"""How slides that follow impacts change with the unknowns.

The state at an impact changes with the launch of its slide and with what moves the puck; the moment
t with the gap of the rims, dt = dgap/u_n; the state after it with all of these, the wall and the
numbers of the rims.  Each link is a difference of its own, and the chain is their product.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.fitting.asked import Asked
from puck_tables.fitting.joined import Hit, Meeting, Slide, Wall, gap_of, state_at, struck
from puck_tables.fitting.launched import Moving
from puck_tables.fitting.parameters import LAUNCH, OF_IMPACTS
from puck_tables.fitting.seen import Seen

_STEP, _CURVE_STEP = 1e-6, 1e-4  # of a scale; of what changes the curve itself
_LEAST = 1e-2
_INSTANT = 1e-6  # s


class Chained(Protocol):
    """What is read of a :class:`puck_tables.fitting.problem.Problem`, which stands above."""

    @property
    def asked(self) -> Asked:
        """What is to be found of the puck."""

    @property
    def films(self) -> tuple[Seen, ...]:
        """The tracks."""

    @property
    def meetings(self) -> tuple[Meeting, ...]:
        """Impacts, in the order of time."""

    @property
    def names(self) -> tuple[tuple[int, str], ...]:
        """(track, name) of every unknown."""

    def found(self, x: FloatArray) -> dict[str, float]:
        """The numbers of the puck."""

    def found_walls(self, x: FloatArray) -> tuple[Wall, ...]:
        """The walls, of which some are found."""

    def moving(self, found: dict[str, float]) -> Moving:
        """How the puck moves with such numbers."""

    def slides(self, x: FloatArray) -> tuple[list[list[Slide]], list[Hit]]:
        """The slides of each track, and the impacts between them."""


def slopes_of_slides(problem: Chained, x: FloatArray) -> list[list[FloatArray]]:
    """The derivatives of each slide of each track (7, m): since when, then its launch.

    Parameters
    ----------
    problem : with or without impacts
    x : its unknowns (m,)
    """
    slides, hits = problem.slides(x)
    slopes = [[_first(problem, n, x.size)] for n in range(len(problem.films))]
    for meeting, hit in zip(problem.meetings, hits, strict=True):
        before = [
            _to_state(problem, x, slides[n][len(slopes[n]) - 1], slopes[n][-1], hit.time)
            for n in meeting.films
        ]
        for n, after in zip(meeting.films, _through(problem, x, meeting, hit, before), strict=True):
            slopes[n].append(after)
    return slopes


def _first(problem: Chained, n: int, size: int) -> FloatArray:
    """Of the first slide of a track."""
    found = np.zeros((7, size))
    for k, name in enumerate(LAUNCH):
        if (n, name) in problem.names:
            found[1 + k, problem.names.index((n, name))] = 1.0
    straight = problem.films[n].straight
    if straight is not None:
        for main in (1 + straight.main, 3 + straight.main):
            found[main + 1 - 2 * straight.main] = straight.slope * found[main]
    row = problem.films[n].row
    if row is not None and "readout" in problem.asked.free:
        found[0, problem.asked.free.index("readout")] = row[0]
    return found


def _to_state(
    problem: Chained, x: FloatArray, slide: Slide, slopes: FloatArray, time: float
) -> tuple[FloatArray, FloatArray]:
    """The derivatives (6, m) of a slide's state at a moment, and how fast it changes (6,)."""
    found = problem.found(x)
    moving = problem.moving(found)
    by_launch = np.eye(6)
    for k in range(2, 5) if slopes[3:6].any() else ():
        step = _STEP * max(abs(float(slide.launch[k])), _LEAST)
        ends = []
        for side in (1.0, -1.0):
            launch = slide.launch.copy()
            launch[k] += side * step
            ends.append(state_at(moving, slide._replace(launch=launch), time))
        by_launch[:, k] = (ends[0] - ends[1]) / (2.0 * step)
    instant = min(_INSTANT, time - slide.since)
    ends = [state_at(moving, slide, time + by) for by in (_INSTANT, -instant)]
    speed = (ends[0] - ends[1]) / (_INSTANT + instant)
    out = by_launch @ slopes[1:] - np.outer(speed, slopes[0])
    for k, name in enumerate(problem.asked.free):
        if name in OF_IMPACTS or name == "readout":
            continue
        step = _STEP * max(abs(found[name]), _LEAST)
        if problem.asked.changes_curve(name):
            step = _CURVE_STEP
        low, high = problem.asked.limits(name)
        values = [min(max(found[name] + side * step, low), high) for side in (1.0, -1.0)]
        ends = [state_at(problem.moving({**found, name: value}), slide, time) for value in values]
        out[:, k] += (ends[0] - ends[1]) / (values[0] - values[1])
    return out, speed


def _through(
    problem: Chained, x: FloatArray, meeting: Meeting, hit: Hit,
    before: list[tuple[FloatArray, FloatArray]],
) -> list[FloatArray]:  # fmt: skip
    """The derivatives (7, m) of the slides after an impact."""
    slopes = [np.zeros((7, x.size)) for _ in before]
    pair = meeting.wall < 0
    for k in range(x.size):
        step = _STEP * max(abs(float(x[k])), _LEAST)
        means = []
        for side in (1.0, -1.0):
            moved = x.copy()
            moved[k] += side * step
            found = problem.found(moved)
            wall = None if pair else problem.found_walls(moved)[meeting.wall]
            means.append((side * step, problem.asked.scales(found)[2], found, wall))
        later = 0.0
        if hit.touches:
            gaps = [
                gap_of(_shifted(hit, before, k, by, 0.0), wall, radius)
                for by, radius, _, wall in means
            ]
            approach = 0.5 * (gaps[0][1] + gaps[1][1])
            later = (gaps[0][0] - gaps[1][0]) / (2.0 * step * approach) if approach > 0.0 else 0.0
        ends = []
        for by, radius, found, wall in means:
            gyration = {**problem.asked.known(), **found}["gyration"]
            states = _shifted(hit, before, k, by, later)
            ends.append(struck(states, radius, gyration, problem.asked.rims(found, pair), wall)[0])
        for out, one, two in zip(slopes, *ends, strict=True):
            out[0, k], out[1:, k] = later, (one - two) / (2.0 * step)
    # a state holds x, y, vx, vy, spin, angle as a launch does
    return slopes


def _shifted(
    hit: Hit, before: list[tuple[FloatArray, FloatArray]], k: int, by: float, later: float
) -> list[FloatArray]:
    """States at an impact where an unknown is changed."""
    return [
        state + by * (slope[:, k] + speed * later)
        for state, (slope, speed) in zip(hit.before, before, strict=True)
    ]

"""The slides of tracks, from impact to impact, and how they change with the unknowns.

A state at an impact changes with the launch of its slide and with what moves the puck; the moment t
with the gap of the rims, dt = dgap/u_n; the state after it with all of these, the wall and the
numbers of the rims.  The law of impact is differenced, and the chain is their product.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.fitting.forward_model import (
    AS_LAUNCH,
    DECEL,
    DELTA,
    PLACE,
    RADIUS,
    SPIN,
    TIME,
    VX,
    VY,
    ImpactSpec,
    ImpactState,
    Moving,
    Slide,
    after_impact,
    gap_of,
    impact_at,
    states_and_slopes,
    states_of,
)
from puck_tables.fitting.parameters import LAUNCH, MARK, OWN_MOTION
from puck_tables.fitting.unknowns import NumbersOf, Unknowns

_STEP = 1e-6  # of a number: of differences, forward and central
_SHAPE_STEP = 1e-4  # of what has a curve of its own at each value
_LEAST = 1e-2  # that a number is taken to be at least, in its unit, for a step
_FRAMES = list[tuple[slice, FloatArray, Slide]]


class Slides(Unknowns):
    """How the pucks of some tracks move: in slides, of which impacts begin all but the first."""

    impact_specs: tuple[ImpactSpec, ...]

    def moving(self, result: NumbersOf) -> Moving:
        """What moves the puck."""
        return self.spec.moving(result, self.tall)

    def gyration(self, result: NumbersOf) -> float:
        """The radius of gyration over r."""
        return {**self.spec.known(), **result}["gyration"]

    def fastest(self, x: FloatArray) -> float:
        """The greatest slip at a launch, at the rim, m/s."""
        radius = self.spec.scales(self.numbers_at(x))[2]
        _, _, vx, vy, spin, _ = self.launches(x).T
        return float((np.hypot(vx, vy) + radius * np.abs(spin)).max())

    def slides(self, x: FloatArray) -> tuple[list[list[Slide]], list[ImpactState]]:
        """The slides of each track, in their order, and the impacts between them.

        Times are those after the start of the first track.
        """
        result, slides, impacts = self.numbers_at(x), [], []
        for film, launch in zip(self.films, self.launches(x), strict=True):
            late = 0.0 if film.row is None else self.spec.readout(result) * float(film.row[0])
            slides.append([Slide(film.start - self.films[0].start + late, launch)])
        if self.impact_specs:
            moving, walls = self.moving(result), self.estimated_walls(x)
            gyration = self.gyration(result)
        for impact_spec in self.impact_specs:
            wall = None if impact_spec.wall < 0 else walls[impact_spec.wall]
            before = tuple(slides[n][-1] for n in impact_spec.films)
            impact = impact_at(
                moving, gyration, self.spec.rims(result, wall is None), impact_spec, before, wall
            )
            for n, slide in zip(impact_spec.films, impact.after, strict=True):
                slides[n].append(slide)
            impacts.append(impact)
        return slides, impacts

    def times(self, n: int, result: NumbersOf) -> FloatArray:
        """The times of a track's frames after its first: lines of a picture are read in turn."""
        film = self.films[n]
        if film.row is None:
            return film.time
        late: FloatArray = self.spec.readout(result) * (film.row - film.row[0])
        return film.time + late

    def _parts(self, n: int, result: NumbersOf, slides: list[Slide]) -> _FRAMES:
        """The frames of each slide of a track, their times after its launch, and the slide."""
        times = self.times(n, result)
        if len(slides) == 1:
            return [(slice(0, times.size), times, slides[0])]
        since = np.array([slide.since - slides[0].since for slide in slides])
        firsts = np.searchsorted(times, since[1:])
        ends = [0, *np.maximum.accumulate(firsts).tolist(), times.size]
        return [
            (slice(ends[m], ends[m + 1]), times[ends[m] : ends[m + 1]] - since[m], slide)
            for m, slide in enumerate(slides)
        ]

    def states(self, x: FloatArray) -> list[FloatArray]:
        """The states (6, n) of the model at the frames of each track."""
        result = self.numbers_at(x)
        moving, (slides, _) = self.moving(result), self.slides(x)
        return [
            np.concatenate([
                states_of(moving, slide.launch, times)
                for _, times, slide in self._parts(n, result, track)
            ], axis=1) for n, track in enumerate(slides)
        ]  # fmt: skip

    def paths(self, x: FloatArray) -> list[FloatArray]:
        """Places and angles (3, n) of the model at the frames of each track."""
        mark = self.spec.mark(self.numbers_at(x))
        return [_marked(states[PLACE], mark) for states in self.states(x)]

    def paths_and_slopes(
        self, x: FloatArray
    ) -> Iterator[tuple[FloatArray, FloatArray, npt.NDArray[np.int64]]]:
        """Places and angles (3, n) of each track, derivatives (3, n, k), and to which unknowns."""
        result, slides, changes = self.numbers_at(x), self.slides(x)[0], self.slopes_of_slides(x)
        at, owners = _Along(self, result), np.array([track for track, _ in self.names])
        for n, film in enumerate(self.films):
            # slides may follow from launches of other tracks
            columns = np.flatnonzero(bool(self.impact_specs) | (owners == -1) | (owners == n))
            path = np.empty((3, film.time.size))
            slopes = np.empty((3, film.time.size, columns.size))
            parts = self._parts(n, result, slides[n])
            for (frames, times, slide), change in zip(parts, changes[n], strict=True):
                row = None if film.row is None else film.row[frames]
                of = at.states_and_slopes(slide, change[:, columns], times, PLACE, row)
                path[:, frames], slopes[:, frames] = of[0][PLACE], of[1]
            mark = self.spec.mark(result)
            arm = _marked(path, mark) - path  # which turns with the body
            slopes[0] -= arm[1][:, None] * slopes[2]
            slopes[1] += arm[0][:, None] * slopes[2]
            for k, name in enumerate(self.spec.free):
                if name in MARK:
                    slopes[..., k] += _marked(path, np.eye(2)[MARK.index(name)]) - path
            yield path + arm, slopes, columns

    def slopes_of_slides(self, x: FloatArray) -> list[list[FloatArray]]:
        """The derivatives of each slide of each track (7, m): since when, then its launch."""
        slopes = [[self._first(n, x.size)] for n in range(len(self.films))]
        if not self.impact_specs:
            return slopes
        slides, impacts = self.slides(x)
        at = _Along(self, self.numbers_at(x))
        for impact_spec, impact in zip(self.impact_specs, impacts, strict=True):
            before = []
            for n in impact_spec.films:  # how a state changes with the unknowns, and with time
                slide = slides[n][len(slopes[n]) - 1]
                since = np.array([impact.time - slide.since])
                _, out, speed = at.states_and_slopes(slide, slopes[n][-1], since, slice(6))
                before.append((out[AS_LAUNCH, 0], speed[AS_LAUNCH, 0]))
            after = _through(self, x, impact_spec, impact, before)
            for n, one in zip(impact_spec.films, after, strict=True):
                slopes[n].append(one)
        return slopes

    @cached_property
    def spots(self) -> dict[tuple[int, str], int]:
        """Where each unknown stands, by its track and name."""
        return {key: k for k, key in enumerate(self.names)}

    def _first(self, n: int, size: int) -> FloatArray:
        """Of the first slide of a track."""
        result, film = np.zeros((7, size)), self.films[n]
        for k, name in enumerate(LAUNCH):
            if (n, name) in self.spots:
                result[1 + k, self.spots[n, name]] = 1.0
        if film.straight is not None:
            for main in (1 + film.straight.main, 3 + film.straight.main):
                result[main + 1 - 2 * film.straight.main] = film.straight.slope * result[main]
        if film.row is not None and (-1, "readout") in self.spots:
            result[0, self.spots[-1, "readout"]] = film.row[0]
        return result


class _Along:
    """States along slides, and their derivatives, for numbers of the puck."""

    def __init__(self, problem: Slides, result: NumbersOf) -> None:
        spec = problem.spec
        self._problem, self._moving = problem, problem.moving(result)
        self._nearby: list[Moving] = []
        self._parts: list[tuple[int, float]] = []  # of the difference of each, by an unknown
        self._scales = np.zeros((7, len(spec.free)))  # which are the first unknowns
        for k, name in enumerate(spec.free):
            if not spec.changes_motion(name):
                self._scales[[DECEL, DELTA, RADIUS], k] = spec.slopes(result, name)
                continue
            value, (low, high) = result[name], spec.limits(name)
            step = _STEP * max(abs(value), _LEAST) * (1.0 if value < high else -1.0)
            ends = [value + step]
            if name in OWN_MOTION:  # known less well
                ends = [min(value + _SHAPE_STEP, high), max(value - _SHAPE_STEP, low)]
                step = ends[0] - ends[1]
            for end, part in zip(ends, (1.0 / step, -1.0 / step), strict=False):
                self._nearby.append(problem.moving({**result, name: end}))
                self._parts.append((k, part))

    def states_and_slopes(
        self, slide: Slide, change: FloatArray, times: FloatArray, rows: slice,
        row: FloatArray | None = None,
    ) -> tuple[FloatArray, FloatArray, FloatArray]:  # fmt: skip
        """States (6, n) at times (n,) after a launch, derivatives (k, n, m) of k rows, by time.

        ``change`` (7, m): of the slide; ``row`` (n,): how far down the picture the frames show it.
        """
        states, every, differ = states_and_slopes(self._moving, slide.launch, times, self._nearby)
        slopes = every[:, rows].swapaxes(0, 1)
        by = np.zeros(change.shape)
        by[[VX, VY, SPIN]], by[TIME] = change[3:6], -change[0]
        by[:, : self._scales.shape[1]] += self._scales
        out: FloatArray = (slopes.reshape(-1, 7) @ by).reshape(*slopes.shape[:2], -1)
        out[PLACE] += change[[1, 2, 6], None]
        if self._moving.motions.angle is not None:
            out += _turned(slide.launch, states, every)[rows, :, None] * change[6]
        for (k, part), difference in zip(self._parts, differ, strict=True):
            out[:, :, k] += part * difference[rows]
        if row is not None and (-1, "readout") in self._problem.spots:
            out[:, :, self._problem.spots[-1, "readout"]] += slopes[:, :, TIME] * row
        return states, out, slopes[:, :, TIME]


def _marked(path: FloatArray, mark: Sequence[float]) -> FloatArray:
    """Places and angles (3, n) of what is tracked on a body with such ones."""
    if not any(mark):
        return path
    (x, y), cosine, sine = mark, np.cos(path[2]), np.sin(path[2])
    return np.stack([path[0] + cosine * x - sine * y, path[1] + sine * x + cosine * y, path[2]])


def _turned(launch: FloatArray, states: FloatArray, slopes: FloatArray) -> FloatArray:
    """How states (6, n) change with the angle at which a body that is not round is launched."""
    out: FloatArray = -slopes[:, :, [VX, VY]] @ np.array([-launch[3], launch[2]])
    out[:, [0, 1]] += np.stack([launch[1] - states[1], states[0] - launch[0]], axis=1)
    out[:, [3, 4]] += np.stack([-states[4], states[3]], axis=1)
    return out.T.copy()


def _through(
    problem: Slides, x: FloatArray, impact_spec: ImpactSpec, impact: ImpactState,
    before: list[tuple[FloatArray, FloatArray]],
) -> list[FloatArray]:  # fmt: skip
    """The derivatives (7, m) of the slides after an impact."""
    slopes = [np.zeros((7, x.size)) for _ in before]
    pair = impact_spec.wall < 0
    for k in range(x.size):
        step = _STEP * max(abs(float(x[k])), _LEAST)
        means = []
        for side in (1.0, -1.0):
            moved = x.copy()
            moved[k] += side * step
            result = problem.numbers_at(moved)
            wall = None if pair else problem.estimated_walls(moved)[impact_spec.wall]
            means.append((side * step, problem.spec.scales(result)[2], result, wall))
        later = 0.0
        if impact.touches:
            gaps = [
                gap_of(_shifted(impact, before, k, by, 0.0), wall, radius)
                for by, radius, _, wall in means
            ]
            approach = 0.5 * (gaps[0][1] + gaps[1][1])
            later = (gaps[0][0] - gaps[1][0]) / (2.0 * step * approach) if approach > 0.0 else 0.0
        ends = []
        for by, radius, result, wall in means:
            gyration, rims = problem.gyration(result), problem.spec.rims(result, pair)
            states = _shifted(impact, before, k, by, later)
            ends.append(after_impact(states, radius, gyration, rims, wall)[0])
        for out, one, two in zip(slopes, *ends, strict=True):
            out[0, k], out[1:, k] = later, (one - two) / (2.0 * step)
    # a state holds x, y, vx, vy, spin, angle as a launch does
    return slopes


def _shifted(
    impact: ImpactState, before: list[tuple[FloatArray, FloatArray]], k: int, by: float,
    later: float,
) -> list[FloatArray]:  # fmt: skip
    """States at an impact where an unknown is changed."""
    return [
        state + by * (slope[:, k] + speed * later)
        for state, (slope, speed) in zip(impact.before, before, strict=True)
    ]

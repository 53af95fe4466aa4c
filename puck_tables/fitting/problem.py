"""The residuals of tracks under a puck and its launches, and their derivatives.

The unknowns are the free numbers of the puck, shared by all tracks, then the launch of each track,
then the walls that are found.  Impacts begin further slides, whose launches follow.  Residuals are
in units of the noise: x, y and angle of every frame, then the priors.  Where time stamps jitter
they are those along the motion, across it, and of the angle at what the place says of the time.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.fitting.fit_spec import FitSpec
from puck_tables.fitting.forward_model import (
    SPIN,
    TIME,
    VX,
    VY,
    Moving,
    path_of,
    path_with_slopes,
    rates_of,
)
from puck_tables.fitting.impact_derivatives import slopes_of_slides
from puck_tables.fitting.impact_law import ImpactSpec, ImpactState, Slide, WallLine, impact_at
from puck_tables.fitting.observations import Observations, Straight, wrapped
from puck_tables.fitting.parameters import LAUNCH
from puck_tables.fitting.timing import weights_of
from puck_tables.fitting.unknowns import NumbersOf, Unknowns

X, Y, TURN = range(3)  # of a path
PLACE, ANGLE, PRIOR, UNSEEN = range(4)  # kinds of residuals; of what does not count there are none
_CURVE_STEP = 1e-4
LAUNCH_NAMES = tuple(LAUNCH)


@dataclass(frozen=True, eq=False)
class Problem(Unknowns):
    """What least squares are asked.

    Parameters
    ----------
    spec : what is to be found of the puck
    films : the tracks
    noise : standard deviations of places (m) and angles (rad)
    tall : whether part of the base may lift
    whole : angles of each track in one piece (None: only up to whole turns)
    rests : whether the puck of each track rests until it is hit
    walls : that are met, None for those to be found
    impact_specs : impacts, in the order of time (s after the start of the first track)
    jitter : standard deviation of time stamps, s
    weights : what makes residuals of each track's frames independent (n, 3, 3); empty: the noise
    """

    spec: FitSpec
    films: tuple[Observations, ...]
    noise: tuple[float, float]
    tall: bool = False
    whole: tuple[FloatArray | None, ...] = ()
    rests: tuple[bool, ...] = ()
    walls: tuple[WallLine | None, ...] = ()
    impact_specs: tuple[ImpactSpec, ...] = ()
    jitter: float = 0.0
    weights: tuple[FloatArray, ...] = ()

    @cached_property
    def kinds(self) -> npt.NDArray[np.int64]:
        """What kind each residual is of."""
        kinds: list[npt.NDArray[np.int64]] = []
        for film in self.films:
            x, y, turn = counting_of(film)
            kinds += [np.where(x, PLACE, UNSEEN), np.where(y, PLACE, UNSEEN)]
            kinds.append(np.where(turn, ANGLE, UNSEEN)[self._angled(film)])
        return np.concatenate([*kinds, np.full(len(self.priors), PRIOR)]).astype(np.int64)

    def moving(self, result: NumbersOf) -> Moving:
        """What moves the puck."""
        return self.spec.moving(result, self.tall)

    def slides(self, x: FloatArray) -> tuple[list[list[Slide]], list[ImpactState]]:
        """The slides of each track, in their order, and the impacts between them.

        Times are those after the start of the first track.
        """
        result = self.numbers_at(x)
        slides = [
            [Slide(self._begin(n, result), launch)] for n, launch in enumerate(self.launches(x))
        ]
        impacts = []
        if self.impact_specs:
            moving, walls = self.moving(result), self.estimated_walls(x)
            gyration = {**self.spec.known(), **result}["gyration"]
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

    def _begin(self, n: int, result: NumbersOf) -> float:
        """When a track begins, s after the start of the first."""
        film = self.films[n]
        late = 0.0 if film.row is None else self.spec.readout(result) * float(film.row[0])
        return film.start - self.films[0].start + late

    def times(self, n: int, result: NumbersOf) -> FloatArray:
        """The times of a track's frames after its first: lines of a picture are read in turn."""
        film = self.films[n]
        if film.row is None:
            return film.time
        late: FloatArray = self.spec.readout(result) * (film.row - film.row[0])
        return film.time + late

    def _parts(
        self, n: int, result: NumbersOf, slides: list[Slide]
    ) -> list[tuple[slice, FloatArray, Slide]]:
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

    def paths(self, x: FloatArray) -> list[FloatArray]:
        """Places and angles (3, n) of the model at the frames of each track."""
        return self._along(x, path_of, True)

    def rates(self, x: FloatArray) -> list[FloatArray]:
        """Velocity and spin (3, n) of the model at the frames of each track."""
        return self._along(x, rates_of, False)

    def _along(self, x: FloatArray, of: Along, placed: bool) -> list[FloatArray]:
        result = self.numbers_at(x)
        moving, (slides, _) = self.moving(result), self.slides(x)
        tracks = []
        for n, track in enumerate(slides):
            parts = [
                of(moving, slide.launch[2:4], float(slide.launch[4]), times)
                + (slide.launch[[0, 1, 5], None] if placed else 0.0)
                for _, times, slide in self._parts(n, result, track)
            ]
            tracks.append(parts[0] if len(parts) == 1 else np.concatenate(parts, axis=1))
        return tracks

    def deviations(self, x: FloatArray) -> list[FloatArray]:
        """Model less what was seen (3, n) of each track, m and rad; NaN where no angle was."""
        return self._deviations(self.paths(x))

    def _deviations(self, paths: list[FloatArray]) -> list[FloatArray]:
        rows = []
        for n, (film, path) in enumerate(zip(self.films, paths, strict=True)):
            turn = np.full(film.time.size, np.nan)
            if film.angle is not None:
                whole = self.whole[n] if self.whole else None
                turn = path[TURN] - (film.angle if whole is None else whole)
                if whole is None:
                    turn = wrapped(turn)
            rows.append(np.stack([path[X] - film.place[:, 0], path[Y] - film.place[:, 1], turn]))
        return rows

    def residuals(self, x: FloatArray) -> FloatArray:
        """All of them, in units of the noise."""
        return self._residuals(x, self.paths(x))

    def _residuals(self, x: FloatArray, paths: list[FloatArray]) -> FloatArray:
        rows = [self.weighed(n, deviations) for n, deviations in enumerate(self._deviations(paths))]
        rows += [np.array([(x[k] - value) / spread]) for k, value, spread in self.priors]
        return np.concatenate(rows)

    def weighed(self, n: int, deviations: FloatArray) -> FloatArray:
        """What is off (3, n, …) in units of the noise, one frame's x after the other's, …"""
        angled = self._angled(self.films[n])
        if self.weights:
            known = np.where(
                angled.reshape(-1, *[1] * (deviations.ndim - 2)), deviations[TURN], 0.0
            )
            rows = np.einsum(
                "nab,bn...->an...", self.weights[n], np.stack([*deviations[:TURN], known])
            )
        else:
            rows = deviations / np.array([self.noise[0], self.noise[0], self.noise[1]]).reshape(
                -1, *[1] * (deviations.ndim - 1)
            )
        straight = self.films[n].straight
        if straight is not None and not self.weights:  # which lie along the motion
            rows[X] = straight.way[0] * rows[X] + straight.way[1] * rows[Y]
        if straight is not None or self.films[n].counts is not None:
            counts = counting_of(self.films[n])
            rows *= counts.reshape(3, -1, *[1] * (deviations.ndim - 2))
        return np.concatenate([rows[X], rows[Y], rows[TURN, angled]])

    def usual(self, rows: FloatArray) -> float:
        """The median size of residuals of what is seen."""
        return float(np.median(np.abs(rows[self.kinds != UNSEEN])))

    def jacobian(self, x: FloatArray) -> FloatArray:
        """Their derivatives, (residuals, unknowns)."""
        return self.residuals_and_jacobian(x)[1]

    def residuals_and_jacobian(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Both, from the same motions."""
        result = self.numbers_at(x)
        moving, (slides, _) = self.moving(result), self.slides(x)
        follow = slopes_of_slides(self, x) if self.impact_specs else []
        out = np.zeros((self.kinds.size, x.size))
        scales = {name: np.array(self.spec.slopes(result, name)) for name in self.spec.free}
        spots = {key: k for k, key in enumerate(self.names)}
        row, paths = 0, []
        for n, film in enumerate(self.films):
            path = np.empty((3, film.time.size))
            paths.append(path)
            whole = np.zeros((3, film.time.size, x.size))
            for m, (frames, times, slide) in enumerate(self._parts(n, result, slides[n])):
                velocity, spin = slide.launch[2:4], float(slide.launch[4])
                path[:, frames], slopes = path_with_slopes(moving, velocity, spin, times)
                path[:, frames] += slide.launch[[0, 1, 5], None]
                block = whole[:, frames]
                for name in self.spec.free:
                    k = spots[-1, name]
                    if self.spec.changes_motion(name):
                        block[:, :, k] = self._by_difference(result, name, times, slide)
                    else:
                        block[:, :, k] = np.einsum("k,kan->an", scales[name], slopes[3:TIME])
                    if name == "readout" and film.row is not None:
                        block[:, :, k] += slopes[TIME] * (film.row[frames] - film.row[0])
                if m == 0:
                    for name, axis in _SHIFTS.items():
                        if (n, name) in spots:
                            block[axis, :, spots[n, name]] = 1.0
                    for name, which in _PUSHES.items():
                        if (n, name) in spots:
                            block[:, :, spots[n, name]] = slopes[which]
                    if film.straight is not None:
                        self._along_line(n, block, slopes, film.straight)
                    continue
                since, place_x, place_y, *pushes, angle = follow[n][m]
                begin = np.zeros(x.size)
                if film.row is not None and (-1, "readout") in spots:
                    begin[spots[-1, "readout"]] = film.row[0]
                block -= slopes[TIME][:, :, None] * (since - begin)
                block += np.stack([place_x, place_y, angle])[:, None, :]
                for which, push in zip((VX, VY, SPIN), pushes, strict=True):
                    block += slopes[which][:, :, None] * push
            rows = self.weighed(n, whole)
            out[row : row + len(rows)] = rows
            row += len(rows)
        for n, (k, _, spread) in enumerate(self.priors):
            out[row + n, k] = 1.0 / spread
        return self._residuals(x, paths), out

    def _along_line(
        self, n: int, block: FloatArray, slopes: FloatArray, straight: Straight
    ) -> None:
        """What the other coordinate does with the main one, added to the derivatives (3, n, m)."""
        place, push = (LAUNCH_NAMES[straight.main + by] for by in (0, 2))
        spots = {name: k for k, (track, name) in enumerate(self.names) if track == n}
        if place in spots:
            block[1 - straight.main, :, spots[place]] = straight.slope
        if push in spots:
            block[:, :, spots[push]] += straight.slope * slopes[(VY, VX)[straight.main]]

    def _by_difference(
        self, result: NumbersOf, name: str, times: FloatArray, slide: Slide
    ) -> FloatArray:
        """The derivative of a path to what changes the curve itself."""
        low, high = self.spec.limits(name)
        ends = [min(max(result[name] + s * _CURVE_STEP, low), high) for s in (-1.0, 1.0)]
        path: list[FloatArray] = []
        for value in ends:
            moving = self.moving({**result, name: value})
            path.append(path_of(moving, slide.launch[2:4], float(slide.launch[4]), times))
        slope: FloatArray = (path[1] - path[0]) / (ends[1] - ends[0])
        return slope

    @staticmethod
    def _angled(film: Observations) -> npt.NDArray[np.bool_]:
        if film.angle is None:
            return np.zeros(film.time.size, bool)
        known: npt.NDArray[np.bool_] = np.isfinite(film.angle)
        return known

    def each(self) -> list[tuple[slice, slice, slice]]:
        """Where the residuals of each track stand: along x, along y, angles."""
        result, row = [], 0
        for film in self.films:
            n, angles = film.time.size, int(self._angled(film).sum())
            ends = row + n, row + 2 * n, row + 2 * n + angles
            result.append((slice(row, ends[0]), slice(ends[0], ends[1]), slice(ends[1], ends[2])))
            row = ends[2]
        return result

    def with_noise(
        self, noise: tuple[float, float], x: FloatArray,
        kept: npt.NDArray[np.bool_] | None = None, jitter: float | None = None,
    ) -> Problem:  # fmt: skip
        """The same with other noise; where time stamps jitter it depends on the motion ``x``.

        ``kept``: residuals that count: an angle is seen beside its place, if that counts.
        """
        moved = replace(self, noise=noise, jitter=self.jitter if jitter is None else jitter)
        if moved.jitter == 0.0:
            return moved
        weights = []
        for rates, (place, _, _) in zip(self.rates(x), self.each(), strict=True):
            placed = np.ones(rates.shape[1], bool) if kept is None else kept[place]
            weights.append(weights_of(noise, moved.jitter, rates, placed))
        return replace(moved, weights=tuple(weights))

    def with_films(self, films: tuple[Observations, ...]) -> Problem:
        """The same of other frames, before anything is known of their motion."""
        return replace(self, films=films, whole=(), weights=())


def counting_of(film: Observations) -> npt.NDArray[np.bool_]:
    """Whether x, or what lies along a line, y, and angle of each frame count (3, n)."""
    counts = np.ones((3, film.time.size), bool) if film.counts is None else film.counts.T.copy()
    if film.straight is not None:
        counts[X] = counts[film.straight.main]
        counts[Y] = False
    return counts


Along = Callable[[Moving, FloatArray, float, FloatArray], FloatArray]
_SHIFTS = {"launch_x": X, "launch_y": Y, "launch_angle": TURN}
_PUSHES = {"launch_vx": VX, "launch_vy": VY, "launch_spin": SPIN}

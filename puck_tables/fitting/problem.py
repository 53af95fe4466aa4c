"""The residuals of tracks under a puck and its launches, and their derivatives.

The unknowns are the free numbers of the puck, shared by all tracks, then the launch of each track,
then the walls that are found.  Impacts begin further slides, whose launches follow.  Residuals are
in units of the noise: x, y and angle of every frame, then the priors.  Where time stamps jitter
they are those along the motion, across it, and of the angle at what the place says of the time.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.fitting.fit_spec import FitSpec
from puck_tables.fitting.forward_model import RATE
from puck_tables.fitting.impact_law import ImpactSpec, WallLine
from puck_tables.fitting.observations import Observations, wrapped
from puck_tables.fitting.slides import Slides
from puck_tables.fitting.timing import weights_of

X, Y, TURN = range(3)  # of a path
PLACE, ANGLE, PRIOR, UNSEEN = range(4)  # kinds of residuals; of what does not count there are none


@dataclass(frozen=True, eq=False)
class Problem(Slides):
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
        out = np.zeros((self.kinds.size, x.size))
        row, paths = 0, []
        for n, (path, slopes) in enumerate(self.paths_and_slopes(x)):
            rows = self.weighed(n, slopes)
            out[row : row + len(rows)] = rows
            row += len(rows)
            paths.append(path)
        for n, (k, _, spread) in enumerate(self.priors):
            out[row + n, k] = 1.0 / spread
        return self._residuals(x, paths), out

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
        for states, (place, _, _) in zip(self.states(x), self.each(), strict=True):
            placed = np.ones(states.shape[1], bool) if kept is None else kept[place]
            weights.append(weights_of(noise, moved.jitter, states[RATE], placed))
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

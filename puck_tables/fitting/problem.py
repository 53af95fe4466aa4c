"""The residuals of tracks under a puck and its launches, and their derivatives.

The unknowns are the free numbers of the puck, shared by all tracks, then the launch of each track,
then the walls that are found.  Impacts begin further slides, whose launches follow.  Residuals are
in units of the noise: x, y and angle of every frame, then the priors.

Where time stamps jitter they are those along the motion, across it, and of the angle what is left
when the place has told of the time.  A stamp that is off by σ_t moves what is seen by that time
along the motion, u = (vx, vy, ω), so a frame's x, y and angle have the covariance

    C = diag(σ², σ², σ_a²) + σ_t² u uᵀ .

σ, σ_a and σ_t that are not given are the most likely ones, from

    −2 ln L = Σ ln det C + rᵀ C⁻¹ r ,   det C = σ⁴ σ_a² (1 + σ_t² (v²/σ² + ω²/σ_a²)) .
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.fitting.fit_spec import FitSpec
from puck_tables.fitting.forward_model import RATE, ImpactSpec, WallLine
from puck_tables.fitting.observations import Observations, wrapped
from puck_tables.fitting.slides import Slides

_LEAST, _MOST = 1e-4, 30.0  # times the noise of a place over the speed: σ_t is looked for within


class Known(NamedTuple):
    """Whether the noise of places, of angles, and of time stamps is given."""

    place: bool = False
    angle: bool = False
    jitter: bool = False


_NONE_KNOWN = Known()
EXACT = 1e-12  # of a cost: what a step still gains where a minimum is found
ROUGH = 1e-4  # of it, where only the size of residuals is asked


def weights_of(
    noise: tuple[float, float], jitter: float, rates: FloatArray, placed: npt.NDArray[np.bool_]
) -> FloatArray:
    """What makes x, y and angle of frames independent and of unit variance, (n, 3, 3).

    ``noise``: m, rad; ``jitter`` s; ``rates`` (3, n): velocity m/s and spin rad/s; ``placed`` (n,):
    whether the place counts.

    >>> one = weights_of((1e-3, 1e-2), 1e-3, np.array([[0.0], [1.0], [0.0]]), np.array([True]))
    >>> abs(one[0]).sum(axis=1).round(3).tolist()  # along the motion, across it, angle
    [707.107, 1000.0, 100.0]
    """
    vx, vy, spin = rates
    speed = np.hypot(vx, vy)
    still = speed == 0.0
    cosine = np.where(still, 1.0, vx / np.where(still, 1.0, speed))
    sine = np.where(still, 0.0, vy / np.where(still, 1.0, speed))
    along = noise[0] ** 2 + (jitter * speed) ** 2
    turn = noise[1] ** 2 + (jitter * spin) ** 2
    variance = np.where(placed, jitter**2 * speed * spin / along, 0.0)
    left = np.sqrt(turn - variance**2 * along)
    out = np.zeros((speed.size, 3, 3))
    out[:, 0, 0], out[:, 0, 1] = cosine / np.sqrt(along), sine / np.sqrt(along)
    out[:, 1, 0], out[:, 1, 1] = -sine / noise[0], cosine / noise[0]
    out[:, 2, 0], out[:, 2, 1] = -variance * cosine / left, -variance * sine / left
    out[:, 2, 2] = 1.0 / left
    return out


def likeliest(
    noise: tuple[float, float], jitter: float, known: Known, deviations: FloatArray, rates:
    FloatArray, kept: npt.NDArray[np.bool_], share: float,
) -> tuple[tuple[float, float], float]:  # fmt: skip
    """The noise of places and angles, and σ_t, under which residuals are most likely.

    ``deviations`` (3, n): m and rad, NaN where no angle is; ``rates`` (3, n); ``kept`` (3, n):
    whether the place along the motion, the angle, the place across it count; ``share``: of the
    squares that the unknowns have left.
    """
    from scipy.optimize import minimize

    placed, angled = kept[0], kept[1] & np.isfinite(deviations[2])
    x, y, turn = np.where([placed, placed, angled], deviations, 0.0)
    vx, vy, spin = rates
    speed = float(np.sqrt(np.mean(vx**2 + vy**2))) or 1.0
    usual = noise[0] / speed
    begin = np.log([noise[0], noise[1], jitter if jitter > 0.0 else 0.3 * usual])
    free = [k for k, one in enumerate(known) if not one and (k != 1 or angled.any())]
    if not free:
        return noise, jitter

    def cost(logs: FloatArray) -> float:
        every = begin.copy()
        every[free] = logs
        place, angle, stamp = np.exp(2.0 * every)
        if known.jitter:
            stamp = jitter**2
        gain = placed * (vx**2 + vy**2) / place + angled * spin**2 / angle
        squares = (x**2 + y**2) / place + turn**2 / angle
        ahead = (x * vx + y * vy) / place + turn * spin / angle
        squares -= stamp * ahead**2 / (1.0 + stamp * gain)
        logarithm = float(kept[[0, 2]].sum()) * math.log(place) + angled.sum() * math.log(angle)
        return float(logarithm + np.log1p(stamp * gain).sum() + squares.sum() / share)

    bounds = [
        (math.log(_LEAST * usual), math.log(_MOST * usual)) if k == 2
        else (begin[k] - 3.0, begin[k] + 3.0) for k in free
    ]  # fmt: skip
    result = begin.copy()
    result[free] = minimize(cost, begin[free], method="L-BFGS-B", bounds=bounds).x
    place, angle, stamp = np.exp(result).tolist()
    return (place, angle), jitter if known.jitter else stamp


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
    known : which noise is given, and not that of the residuals
    smooth : noise of places (m) and angles (rad) that no model judged
    level : what a step lowers the cost by, of it, where a minimum counts as found
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
    known: Known = _NONE_KNOWN
    smooth: tuple[float, float] = (math.nan, math.nan)
    level: float = EXACT

    @cached_property
    def angled(self) -> bool:
        """Whether any track has angles."""
        return any(film.angle is not None for film in self.films)

    @cached_property
    def size(self) -> float:
        """How far the farthest of the pucks goes along x or y, m."""
        return max(film.size for film in self.films)

    @cached_property
    def kinds(self) -> npt.NDArray[np.int64]:
        """What kind each residual is of."""
        kinds: list[npt.NDArray[np.int64]] = []
        for film in self.films:
            x, y, turn = counting_of(film)
            kinds += [np.where(x, PLACE, UNSEEN), np.where(y, PLACE, UNSEEN)]
            kinds.append(np.where(turn, ANGLE, UNSEEN)[self._angled(film)])
        return np.concatenate([*kinds, np.full(len(self.priors), PRIOR)]).astype(np.int64)

    def deviations(self, x: FloatArray, paths: list[FloatArray] | None = None) -> list[FloatArray]:
        """Model less what was seen (3, n) of each track, m and rad; NaN where no angle was.

        ``paths``: of the model, where they are known.
        """
        rows = []
        for n, (film, path) in enumerate(zip(self.films, paths or self.paths(x), strict=True)):
            turn = np.full(film.time.size, np.nan)
            if film.angle is not None:
                whole = self.whole[n] if self.whole else None
                turn = path[TURN] - (film.angle if whole is None else whole)
                if whole is None:
                    turn = wrapped(turn)
            rows.append(np.stack([path[X] - film.place[:, 0], path[Y] - film.place[:, 1], turn]))
        return rows

    def residuals(self, x: FloatArray, paths: list[FloatArray] | None = None) -> FloatArray:
        """All of them, in units of the noise; ``paths``: of the model, where they are known."""
        rows = [self.weighed(n, one) for n, one in enumerate(self.deviations(x, paths))]
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
            rows[X] = straight.direction[0] * rows[X] + straight.direction[1] * rows[Y]
        if straight is not None or self.films[n].counts is not None:
            counts = counting_of(self.films[n])
            rows *= counts.reshape(3, -1, *[1] * (deviations.ndim - 2))
        return np.concatenate([rows[X], rows[Y], rows[TURN, angled]])

    def least_noise(self, x: FloatArray) -> tuple[float, float]:
        """Of places (m) and of angles (rad): as well as motions are known."""
        moving = self.moving(self.numbers_at(x))
        radius, paths = moving.radius, self.paths(x)
        length = max(float((np.ptp(path, axis=1) * [1, 1, radius]).max()) for path in paths)
        return moving.accuracy * length, moving.accuracy * length / radius

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
        for n, (path, slopes, columns) in enumerate(self.paths_and_slopes(x)):
            rows = self.weighed(n, slopes)
            out[row : row + len(rows), columns] = rows
            row += len(rows)
            paths.append(path)
        for n, (k, _, spread) in enumerate(self.priors):
            out[row + n, k] = 1.0 / spread
        return self.residuals(x, paths), out

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
        """A problem with other noise; where time stamps jitter it depends on the motion ``x``.

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
        """A problem of other frames, before anything is known of their motion."""
        return replace(self, films=films, whole=(), weights=())


def counting_of(film: Observations) -> npt.NDArray[np.bool_]:
    """Whether x, or what lies along a line, y, and angle of each frame count (3, n)."""
    counts = np.ones((3, film.time.size), bool) if film.counts is None else film.counts.T.copy()
    if film.straight is not None:
        counts[X] = counts[film.straight.main]
        counts[Y] = False
    return counts

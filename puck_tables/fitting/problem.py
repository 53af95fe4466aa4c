"""The residuals of tracks under a puck and its launches, and the steps that make them least.

Residuals are in units of the noise: x, y and angle of every frame, then the priors.  Where time
stamps jitter they are those along the motion, across it, and of the angle what is left when the
place has told of the time.  A stamp that is off by σ_t moves what is seen by that time along the
motion, u = (vx, vy, ω), so a frame's x, y and angle have the covariance

    C = diag(σ², σ², σ_a²) + σ_t² u uᵀ .

Residuals of one kind in one track hang on few unknowns: turned in their space (QR) they become as
many rows as these and one more; squares, products with slopes and singular values stay.
Steps are those of Levenberg and Marquardt within bounds (δ ≥ 0); where the Jacobian has no full
rank, which is not rare here, they stand still.  Many starts go abreast, of which fewer and fewer go
on.  scipy's ``least_squares`` cannot stop and compare, and of so few unknowns its step costs twice
what the motion of a track costs.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.errors import InputError
from puck_tables.fitting.fit_spec import FitSpec
from puck_tables.fitting.forward_model import RATE, ImpactSpec, WallLine
from puck_tables.fitting.observations import Mask, Observations, wrapped
from puck_tables.fitting.slides import Slides


class Known(NamedTuple):
    """Whether the noise of places, of angles, and of time stamps is given."""

    place: bool = False
    angle: bool = False
    jitter: bool = False


EXACT = 1e-12  # of a cost: what a step still gains where a minimum is found
ROUGH = 1e-4  # of it, where only the size of residuals is asked


def weights_of(
    noise: tuple[float, float], jitter: float, rates: FloatArray, placed: Mask
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
    still, moving = speed == 0.0, np.where(speed == 0.0, 1.0, speed)
    cosine, sine = np.where(still, 1.0, vx / moving), np.where(still, 0.0, vy / moving)
    along, turn = noise[0] ** 2 + (jitter * speed) ** 2, noise[1] ** 2 + (jitter * spin) ** 2
    variance = np.where(placed, jitter**2 * speed * spin / along, 0.0)
    left = np.sqrt(turn - variance**2 * along)
    out = np.zeros((speed.size, 3, 3))
    out[:, 0, 0], out[:, 0, 1] = cosine / np.sqrt(along), sine / np.sqrt(along)
    out[:, 1, 0], out[:, 1, 1] = -sine / noise[0], cosine / noise[0]
    out[:, 2, 0], out[:, 2, 1] = -variance * cosine / left, -variance * sine / left
    out[:, 2, 2] = 1.0 / left
    return out


X, Y, TURN = range(3)  # of a path
PLACE, ANGLE, PRIOR, UNSEEN = range(4)  # kinds of residuals; of what does not count there are none


@dataclass(frozen=True, eq=False)
class Problem(Slides):
    """What least squares are asked."""

    spec: FitSpec
    films: tuple[Observations, ...]
    noise: tuple[float, float]  # standard deviations of places (m) and angles (rad)
    tall: bool = False  # whether part of the base may lift
    whole: tuple[FloatArray | None, ...] = ()  # angles in one piece (None: up to whole turns)
    rests: tuple[bool, ...] = ()  # whether the puck of each track rests until it is hit
    walls: tuple[WallLine | None, ...] = ()  # that are met, None for those to be found
    impact_specs: tuple[ImpactSpec, ...] = ()  # in the order of time after the first track's start
    jitter: float = 0.0  # standard deviation of time stamps, s
    # what makes residuals of each track's frames independent (n, 3, 3); empty: the noise
    weights: tuple[FloatArray, ...] = ()
    known: Known = field(default=Known())  # which noise is given, and not that of the residuals
    smooth: tuple[float, float] = (math.nan, math.nan)  # noise (m, rad) that no model judged
    level: float = EXACT  # what a step lowers the cost by, of it, where a minimum counts as found

    @cached_property
    def angled(self) -> bool:
        """Whether any track has angles."""
        return any(film.angle is not None for film in self.films)

    @cached_property
    def kinds(self) -> npt.NDArray[np.int64]:
        """What kind each residual is of."""
        kinds = list[npt.NDArray[np.int64]]()
        for film in self.films:
            x, y, turn = counting_of(film)
            kinds += [np.where(x, PLACE, UNSEEN), np.where(y, PLACE, UNSEEN)]
            kinds.append(np.where(turn, ANGLE, UNSEEN)[np.isfinite(film.angles)])
        return np.concatenate([*kinds, np.full(len(self.priors), PRIOR)]).astype(np.int64)

    def deviations(self, x: FloatArray, paths: list[FloatArray] | None = None) -> list[FloatArray]:
        """Model less what was seen (3, n) of each track, m and rad; NaN where no angle was.

        ``paths``: of the model, where they are known.
        """
        rows = []
        for n, (film, path) in enumerate(zip(self.films, paths or self.paths(x), strict=True)):
            whole = self.whole[n] if self.whole else None
            turn = path[TURN] - (film.angles if whole is None else whole)
            turn = wrapped(turn) if whole is None else turn
            rows.append(np.stack([path[X] - film.place[:, 0], path[Y] - film.place[:, 1], turn]))
        return rows

    def residuals(self, x: FloatArray, paths: list[FloatArray] | None = None) -> FloatArray:
        """All of them, in units of the noise; ``paths``: of the model, where they are known."""
        rows = [self.weighed(n, one) for n, one in enumerate(self.deviations(x, paths))]
        priors = [(x[k] - value) / spread for k, value, spread in self.priors]
        return np.concatenate([*rows, priors])

    def weighed(self, n: int, deviations: FloatArray) -> FloatArray:
        """What is off (3, n, …) in units of the noise, one frame's x after the other's, …"""
        film, each = self.films[n], (1,) * (deviations.ndim - 2)
        angled = np.isfinite(film.angles)
        if self.weights:
            turn = np.where(angled.reshape(-1, *each), deviations[TURN], 0.0)
            seen = np.stack([*deviations[:TURN], turn])
            rows = np.einsum("nab,bn...->an...", self.weights[n], seen)
        else:
            rows = deviations / np.array([self.noise[0], *self.noise]).reshape(3, 1, *each)
        if film.straight is not None and not self.weights:  # which lie along the motion
            rows[X] = film.straight.direction[0] * rows[X] + film.straight.direction[1] * rows[Y]
        if film.straight is not None or film.counts is not None:
            rows *= counting_of(film).reshape(3, -1, *each)
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

    def each(self) -> list[tuple[slice, slice, slice]]:
        """Where the residuals of each track stand: along x, along y, angles."""
        result, row = [], 0
        for film in self.films:
            n, angles = film.time.size, int(np.isfinite(film.angles).sum())
            ends = row + n, row + 2 * n, row + 2 * n + angles
            result.append((slice(row, ends[0]), slice(ends[0], ends[1]), slice(ends[1], ends[2])))
            row = ends[2]
        return result

    def with_noise(
        self, noise: tuple[float, float], x: FloatArray, kept: Mask | None = None,
        jitter: float | None = None,
    ) -> Problem:  # fmt: skip
        """A problem with other noise; where time stamps jitter it depends on the motion ``x``.

        ``kept``: residuals that count: an angle is seen beside its place, if that counts.
        """
        moved = replace(self, noise=noise, jitter=self.jitter if jitter is None else jitter)
        if moved.jitter == 0.0:
            return moved
        kept = np.ones(self.kinds.size, bool) if kept is None else kept
        every = zip(self.states(x), self.each(), strict=True)
        return replace(moved, weights=tuple(
            weights_of(noise, moved.jitter, state[RATE], kept[x]) for state, (x, *_) in every
        ))  # fmt: skip

    def with_films(self, films: tuple[Observations, ...]) -> Problem:
        """A problem of other frames, before anything is known of their motion."""
        return replace(self, films=films, whole=(), weights=())


def counting_of(film: Observations) -> Mask:
    """Whether x, or what lies along a line, y, and angle of each frame count (3, n)."""
    counts = np.ones((3, film.time.size), bool) if film.counts is None else film.counts.T.copy()
    if film.straight is not None:
        counts[X] = counts[film.straight.main]
        counts[Y] = False
    return counts


class Compact(NamedTuple):
    """``rows`` (k,), ``slopes`` (k, m), and the kinds (k,) of residuals that they stand for."""

    rows: FloatArray
    slopes: FloatArray
    kinds: npt.NDArray[np.int64]


def compact(problem: Problem, rows: FloatArray, slopes: FloatArray, kept: Mask | None) -> Compact:
    """Fewer rows for residuals (n,), derivatives (n, m); ``kept``: which count, all if None."""
    if kept is not None:
        rows, slopes = rows * kept, slopes * kept[:, None]
    few, slope, kinds = [], [], []
    for n, (x, y, turn) in enumerate(problem.each()):
        unknowns = enumerate(problem.names)
        moved = [k for k, (of, _) in unknowns if of in (-1, n) or problem.impact_specs]
        for part, kind in ((slice(x.start, y.stop), PLACE), (turn, ANGLE)):
            turned = triangle(np.column_stack([slopes[part][:, moved], rows[part]]))
            wide = np.zeros((len(turned), slopes.shape[1]))
            wide[:, moved] = turned[:, :-1]
            few.append(turned[:, -1])
            slope.append(wide)
            kinds.append(np.full(len(turned), kind))
    priors = problem.kinds == PRIOR
    every = (*few, rows[priors]), (*slope, slopes[priors]), (*kinds, problem.kinds[priors])
    return Compact(*(np.concatenate(one) for one in every))


def triangle(rows: FloatArray) -> FloatArray:
    """Rows of the same products, no more than columns: R of QR, part by part.

    As one, tall rows (n, m) make BLAS take threads, which wait for each other longer than they
    work.
    """
    size = max(_PART, 2 * rows.shape[1])
    while len(rows) > size:
        even = len(rows) // size * size
        parts = np.asarray(np.linalg.qr(rows[:even].reshape(-1, size, rows.shape[1]), mode="r"))
        rows = np.concatenate([parts.reshape(-1, rows.shape[1]), rows[even:]])
    return np.asarray(np.linalg.qr(rows, mode="r")) if len(rows) > rows.shape[1] else rows


Start = tuple[Problem, FloatArray]  # what is asked, and unknowns to begin with
_PART = 128  # rows, at the least
ROBUST = 3.0  # residuals that are larger count less
# steps, and how many starts then go on
FROM_AFAR = ((1, 10), (4, 5), (12, 4))
FROM_NEARBY = ((4, 2), (30, 1))
FROM_SLOWING = ((3, 3), (8, 2), (30, 1))
_DAMPED, _EASED, _HARDER = 1e-3, 0.1, 10.0
_LEAST = 1e-9  # damping: what is not seen stays where it is
_HARDEST = 1e6  # the damping where a start has arrived
_STEPS = 300  # to a minimum: a curved valley takes a hundred
_NOTHING = 1e-12  # of a cost, or of 1: what a last step would gain
_ROUNDING = 1e-24  # of the largest square of slopes
_APART = 1e-2  # starts that are nearer have met


def multi_start(
    starts: list[Start], rounds: tuple[tuple[int, int], ...], scale: float = math.inf,
    allowance: float = 0.0, kept: Mask | None = None, held: int | None = None,
) -> list[tuple[FloatArray, float]]:  # fmt: skip
    """Unknowns at the deepest minima that starts lead to, and the cost there, the deepest first.

    Starts, of the same residuals, that have met go on as one.  ``rounds``: steps, and how many
    starts go on after them; residuals r count squared, or of a ``scale`` s as ½ s² ln(1 + (r/s)²)
    with s at least twice their median; ``allowance``: what a start may cost more than the best and
    goes on, however many do; ``kept``: residuals that count, all where it is left out; ``held``:
    what stays.
    """
    walkers = [_Walker(problem, x, scale, kept, held) for problem, x in starts]
    for steps, most in rounds:
        for walker in walkers:
            for _ in range(steps):
                if not walker.arrived:
                    walker.step()
        every, walkers = sorted(walkers, key=lambda one: one.cost), []
        for one in every:  # those that no deeper one has met
            if all(np.abs(one.x - other.x).max() > _APART * np.abs(other.x).max()
                   for other in walkers):  # fmt: skip
                walkers.append(one)
        near = sum(one.cost < walkers[0].cost + allowance for one in walkers)
        walkers = walkers[: max(most, near)]
    return [(walker.x, walker.cost) for walker in walkers]


def minimise_robustly(problem: Problem, x: FloatArray, steps: int = 40) -> tuple[FloatArray, float]:
    """The unknowns at the minimum from a start, to a ten-thousandth of the robust cost there."""
    return multi_start([(problem, x)], ((steps, 1),), ROBUST)[0]


def minimise(problem: Problem, x: FloatArray, kept: Mask | None = None) -> tuple[FloatArray, float]:
    """The unknowns at the minimum from a start, and the cost, half the sum of squares, there.

    ``kept``: residuals that count, all where it is left out.
    """
    walker = _Walker(problem, x, math.inf, kept, None, problem.level)
    for _ in range(_STEPS):
        if not walker.arrived:
            walker.step()
    if not (math.isfinite(walker.cost) and np.isfinite(walker.slopes).all()):
        words = ", ".join(f"{n} {value:.3g}" for n, value in problem.numbers_at(walker.x).items())
        raise InputError(
            "the fit is led astray, to a motion that cannot be computed"
            f"{f' ({words})' if words else ''}: give bounds or a prior of what it finds,"
            " or find less"
        )
    return walker.x, walker.cost


class _Walker:
    """A start on its way."""

    def __init__(
        self, problem: Problem, x: FloatArray, scale: float, kept: Mask | None, held: int | None,
        level: float = ROUGH,
    ) -> None:  # fmt: skip
        self.problem, self.scale, self.held, self.level = problem, scale, held, level
        self.weights = 1.0 if kept is None else kept.astype(np.float64)
        self.x, self.damping, self.arrived = np.clip(x, *problem.limits), _DAMPED, False
        self.rows, self.slopes = self._at(self.x)

    def _at(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        rows, slopes = self.problem.residuals_and_jacobian(x)
        if self.held is not None:
            slopes[:, self.held] = 0.0
        return self.weights * rows, slopes

    @property
    def cost(self) -> float:
        """By the same scale for all."""
        return _cost(self.rows, self.scale)

    def step(self) -> None:
        """One step, or none where it leads up."""
        scale = max(self.scale, 2.0 * self.problem.usual(self.rows))
        slopes, weights = self.slopes, self.weights / (1.0 + (self.rows / scale) ** 2)
        square = (slopes.T * weights) @ slopes
        size = np.diag(square)
        seen = size > _ROUNDING * size.max()  # of the others slopes are rounding
        damped = square + np.diag(np.where(seen, self.damping * size, 1.0))
        down = slopes.T @ (weights * self.rows)
        change = np.linalg.solve(damped, down)
        if not np.isfinite(change).all():
            self.arrived = True
            return
        new = np.clip(self.x - change, *self.problem.limits)
        free = new == self.x - change
        if not free.all():  # some end on their bounds: the others step as these do, not as wanted
            short = down - damped @ np.where(free, 0.0, self.x - new)
            change[free] = np.linalg.solve(damped[free][:, free], short[free])
            new[free] = np.clip(self.x - change, *self.problem.limits)[free]
        change = self.x - new
        if change @ (down - 0.5 * (square @ change)) < _NOTHING * max(self.cost, 1.0):
            self.arrived = True
            return
        rows, slopes = self._at(new)
        before, after = _cost(self.rows, scale), _cost(rows, scale)
        if after < before:
            self.arrived = before - after < self.level * before
            self.x, self.rows, self.slopes = new, rows, slopes
            self.damping = max(_EASED * self.damping, _LEAST)
        else:
            self.arrived = self.damping > _HARDEST
            self.damping *= _HARDER


def _cost(rows: FloatArray, scale: float) -> float:
    if scale == math.inf:
        return 0.5 * float(rows @ rows)
    return 0.5 * scale * scale * float(np.log1p((rows / scale) ** 2).sum())

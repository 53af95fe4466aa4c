"""The most likely puck and launches, with frames that are no observations of it left out.

Outliers are recognised, dropped, and the rest is fitted by least squares: residuals beyond four
standard deviations, as one good frame in 16,000 has.  So the fit of clean tracks is that of least
squares, fully efficient, and intervals keep their coverage where one frame in twenty is wrong.

A mark that is lost for a frame, or a blurred one, lies beside its neighbours.  Frames that lie far
off together, and go there smoothly, are good ones: it is the model that is wrong.

Noise σ of places, σ_a of angles and σ_t of time stamps that are not given are the most likely, from

    −2 ln L = Σ ln det C + rᵀ C⁻¹ r ,   det C = σ⁴ σ_a² (1 + σ_t² (v²/σ² + ω²/σ_a²)) .
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.fitting.forward_model import RATE
from puck_tables.fitting.observations import MEDIAN, Mask
from puck_tables.fitting.problem import (
    ANGLE,
    PLACE,
    PRIOR,
    UNSEEN,
    Known,
    Problem,
    compact,
    minimise,
    minimise_robustly,
)

_AROUND = 4  # frames to either side
_IN_A_ROW = 5  # frames in a row that may be strays by chance
_LEAP, _MORE = 6.0, 3.0  # standard deviations, and times the way between frames beside


def outliers_of(deviations: FloatArray, limit: float, strict: bool) -> Mask:
    """Which frames (n,) are far off; of these only strays, if ``strict``.

    ``deviations`` (n, k): residuals of each frame in units of the noise; ``limit``: of the sum of
    their squares, from which on a frame seems to be none of the motion.

    >>> deviations = np.zeros((40, 1))
    >>> deviations[20:, 0] = np.linspace(0.0, 20.0, 20)  # a motion that is another
    >>> deviations[7] = 30.0
    >>> np.flatnonzero(outliers_of(deviations, 16.0, True)).tolist()
    [7]
    """
    outlying: Mask = (deviations**2).sum(axis=1) > limit
    if not strict or outlying.sum() < _IN_A_ROW:
        return outlying
    result = outlying.copy()
    usual = np.stack([
        np.median(deviations[max(0, n - _AROUND) : n + _AROUND + 1], axis=0) for n in
        range(len(deviations))
    ])  # fmt: skip
    together = outlying & (((deviations - usual) ** 2).sum(axis=1) <= limit)
    filled = np.pad(together, 1)  # over single frames that do not lie off with the others
    filled[2:-2] |= together[:-2] & together[2:]
    for start, stop in np.flatnonzero(np.diff(filled)).reshape(-1, 2).tolist():
        ends = (
            start > 0 and not _leaps(deviations, start),
            stop < len(deviations) and not _leaps(deviations, stop),
        )
        if stop - start >= _IN_A_ROW and any(ends):
            result[start:stop] &= ~together[start:stop]
    return result


def _leaps(deviations: FloatArray, at: int) -> bool:
    """Whether residuals leap between two frames, and not those beside."""
    steps = np.linalg.norm(np.diff(deviations[max(0, at - 3) : at + 3], axis=0), axis=1)
    middle = at - max(0, at - 3) - 1
    close = np.delete(steps, middle)
    return bool(steps[middle] > max(_LEAP, _MORE * float(np.median(close))))


FARTHEST = 4.0  # standard deviations of a frame that counts
_BY_CHANCE = math.erfc(FARTHEST / math.sqrt(2.0))
FARTHEST_PLACE = -2.0 * math.log(_BY_CHANCE)  # of two of them, squared
_MEDIAN_PLACE = 2.0 * math.log(2.0)  # of the square of two normal deviates
_WIDE = 1.4  # times the usual median: up to it a scatter may be chance
_FEW = 2.5  # residuals for each unknown
_LEAST_DEGREES = 0.5  # residuals: of less nothing is an outlier
_ROUNDS = 6  # of a fit, its noise and what is left out, at most
_CONVERGED = 1e-3  # of a standard deviation of the noise
_LEAST, _MOST = 1e-4, 30.0  # times the noise of a place over the speed: σ_t is looked for within
_AWAY = 1.5  # times the noise: a start so far off is fitted robustly first


@dataclass(frozen=True, eq=False)
class Estimate:
    """What is most likely.

    ``x`` (m,): the unknowns of ``problem``, whose noise is that of the residuals where none was
    given; ``kept``: residuals that count; ``residuals`` (n,) and ``jacobian`` (n, m) at ``x``;
    ``minima``: the deepest of one track, near which it was begun, where they are known.
    """

    problem: Problem
    x: FloatArray
    kept: Mask
    residuals: FloatArray
    jacobian: FloatArray
    minima: tuple[FloatArray, ...] = ()

    @property
    def chi2(self) -> float:
        """The sum of squares of the residuals that count."""
        return float(np.sum(self.residuals[self.kept] ** 2))

    @property
    def degrees(self) -> int:
        """Residuals that count, less the unknowns."""
        return int(self.kept.sum()) - self.x.size

    @property
    def size(self) -> float:
        """The usual size of residuals over the noise."""
        return math.sqrt(self.chi2 / max(self.degrees, 1))

    def at(self, x: FloatArray, problem: Problem | None = None) -> Estimate:
        """An estimate at other unknowns, perhaps of another problem with as many residuals."""
        problem = problem or self.problem
        rows, slopes = problem.residuals_and_jacobian(x)
        return Estimate(problem, x, self.kept, rows, slopes)

    @property
    def outliers(self) -> float:
        """The share of observations that are left out."""
        seen = self.problem.kinds <= ANGLE
        return float(1.0 - self.kept[seen].mean())


def estimate(problem: Problem, start: FloatArray, strict: bool = False) -> Estimate:
    """Fit, sort out, and fit again until the same frames are left out.

    ``start`` is put within its limits: that of several tracks may have a mean beyond.  Noise that
    is not known is that of the residuals in the end.  ``strict``: whether only strays are left out,
    and not frames that are off together.
    """
    x = np.clip(start, *problem.limits)
    problem = problem.with_noise(problem.noise, x)
    rows = problem.residuals(x)
    if problem.usual(rows) > _AWAY * MEDIAN:
        x, _ = minimise_robustly(problem, x)
        rows = problem.residuals(x)
    count = np.bincount(problem.kinds, minlength=UNSEEN + 1)[: PRIOR + 1]
    free = count[:PRIOR] * max(1.0 - x.size / count.sum(), 0.0)
    kept = _kept(problem, rows, np.where(problem.known[:2], math.inf, free).tolist(), strict)
    for _ in range(_ROUNDS):
        x, _ = minimise(problem, x, kept)
        rows, slopes = problem.residuals_and_jacobian(x)
        degrees = _freedoms(problem, rows, slopes, kept)
        noise, jitter = _noise(problem, x, rows, degrees, kept)
        change = float(np.abs(np.log(np.divide(noise, problem.noise))).max())
        change = max(change, abs(jitter - problem.jitter) / (jitter or 1.0))
        problem = problem.with_noise(noise, x, kept, jitter)
        rows = problem.residuals(x)
        again = _kept(problem, rows / _foreseen(slopes, kept), degrees, strict)
        if change < _CONVERGED and np.array_equal(again, kept):
            break
        kept = again
    x = _within(problem, x)
    return Estimate(problem, x, kept, rows, problem.residuals_and_jacobian(x)[1])


def _within(problem: Problem, x: FloatArray) -> FloatArray:
    """Unknowns with the height of the lowest of all pucks that move so, where many do."""
    spec = problem.spec
    delta, highest = spec.scales(problem.numbers_at(x))[1], spec.highest(problem.tall)
    if "height" not in spec.free or not delta > highest:
        return x
    lower = x.copy()
    lower[spec.free.index("height")] *= highest / delta
    return lower


def capped_squares(problem: Problem, x: FloatArray) -> list[FloatArray]:
    """Squares of the residuals of each frame of each track, an outlier as the farthest of none."""
    rows, result = problem.residuals(x), []
    for film, (one, two, turn) in zip(problem.films, problem.each(), strict=True):
        squares = np.minimum(rows[one] ** 2 + rows[two] ** 2, FARTHEST_PLACE)
        squares[np.isfinite(film.angles)] += np.minimum(rows[turn] ** 2, FARTHEST**2)
        result.append(squares)
    return result


def only_outliers(result: Estimate) -> bool:
    """Whether all frames that an estimate leaves out are strays."""
    slopes, kept = result.jacobian, result.kept
    rows = result.residuals / _foreseen(slopes, kept)
    degrees = _freedoms(result.problem, rows, slopes, kept)
    return np.array_equal(kept, _kept(result.problem, rows, degrees, True))


def _foreseen(slopes: FloatArray, kept: Mask) -> FloatArray:
    """How far off frames that are left out may be (n,): by what is not known of the motion, too."""
    result = np.ones(kept.size)
    if not kept.all():
        scaled = slopes / np.maximum(np.linalg.norm(slopes[kept], axis=0), 1e-300)
        covariance = np.linalg.pinv(scaled[kept].T @ scaled[kept], hermitian=True)
        variance = np.einsum("nk,kl,nl->n", scaled[~kept], covariance, scaled[~kept])
        result[~kept] = np.sqrt(1.0 + np.maximum(variance, 0.0))  # but for rounding
    return result


def _kept(problem: Problem, rows: FloatArray, degrees: list[float], strict: bool) -> Mask:
    """Residuals of frames that are no outliers; a place counts as a whole.

    ``degrees``: how many residuals tell the noise: it is the less sure the fewer they are, and
    those beyond it count no more in it.  So what is an outlier is farther off: by chance as seldom,
    under Student's t, as a good frame beyond four standard deviations that are known.
    """
    kept: Mask = problem.kinds != UNSEEN
    if rows.size < _FEW * len(problem.names):  # too few to tell what is one
        return kept
    each = problem.each()
    places = [np.stack([rows[x], rows[y]], axis=1) for x, y, _ in each]
    turns = [rows[turn, None] for _, _, turn in each]
    # where most are far off no frame is an outlier, but the noise is larger or the model wrong
    most_place = _farthest(2, degrees[PLACE]) * _wide(places, _MEDIAN_PLACE)
    most_turn = _farthest(1, degrees[ANGLE]) * _wide(turns, MEDIAN**2)
    for (x, y, turn), place, angle in zip(each, places, turns, strict=True):
        kept[x] = kept[y] = ~outliers_of(place, most_place, strict)
        kept[turn] = ~outliers_of(angle, most_turn, strict)
    kept &= problem.kinds != UNSEEN
    return kept


def _farthest(count: int, degrees: float) -> float:
    """The square of so many deviates over a noise that residuals told, that hardly any exceeds.

    >>> [round(_farthest(1, degrees) ** 0.5, 1) for degrees in (3.0, 30.0, 1e3, math.inf)]
    [32.6, 4.6, 4.0, 4.0]
    """
    if degrees == math.inf:
        return FARTHEST**2 if count == 1 else FARTHEST_PLACE
    from scipy.special import fdtri

    return count * float(fdtri(count, max(degrees, _LEAST_DEGREES), 1.0 - _BY_CHANCE))


def _wide(deviations: list[FloatArray], usual: float) -> float:
    """How much larger than the noise most squares are, 1 at least."""
    every = (np.concatenate(deviations) ** 2).sum(axis=1)
    return max(1.0, float(np.median(every)) / usual / _WIDE) if every.size else 1.0


def _noise(
    problem: Problem, x: FloatArray, rows: FloatArray, degrees: list[float], kept: Mask
) -> tuple[tuple[float, float], float]:
    """The noise that the residuals show, each kind less what the unknowns take, and the jitter.

    It is no smaller than motions are known, whose errors are no noise: of a film that was computed
    they would take numbers farther than a smaller noise says.
    """
    result, jitter, known = list(problem.noise), problem.jitter, problem.known
    if not all(known) and (jitter > 0.0 or not known.jitter):
        count = []
        for film, (along, across, turn) in zip(problem.films, problem.each(), strict=True):
            angled = np.isfinite(film.angles)
            angled[angled] = kept[turn]
            count.append(np.stack([kept[along], angled, kept[across]]))
        seen = int((kept & (problem.kinds <= ANGLE)).sum())
        noise, jitter = likeliest(
            problem.noise, jitter, known, np.concatenate(problem.deviations(x), axis=1),
            np.concatenate(problem.states(x), axis=1)[RATE], np.concatenate(count, axis=1),
            max(1.0 - x.size / seen, 0.1),
        )  # fmt: skip
        result = list(noise)
    else:
        for kind, free in enumerate(degrees):
            if not known[kind] and free > 1.0:
                mine = problem.kinds[kept] == kind
                result[kind] *= math.sqrt(float(np.sum(rows[kept][mine] ** 2)) / free)
    place, angle = (
        one if is_known else max(one, least)
        for one, is_known, least in zip(result, known[:2], problem.least_noise(x), strict=True)
    )
    return (place, angle), jitter


def _freedoms(problem: Problem, rows: FloatArray, slopes: FloatArray, kept: Mask) -> list[float]:
    """How many residuals told the noise of places, and of angles; infinite where it is given.

    Less what the unknowns take of them.
    """
    few = compact(problem, rows, slopes, kept)
    q, _ = np.linalg.qr(few.slopes)
    return [
        math.inf if problem.known[kind]
        else float((problem.kinds[kept] == kind).sum() - np.sum(q[few.kinds == kind] ** 2))
        for kind in (PLACE, ANGLE)
    ]  # fmt: skip


def freedom(result: Estimate) -> float:
    """Of the kinds of residuals that told their noise, how many the fewest are; inf if none did."""
    every = _freedoms(result.problem, result.residuals, result.jacobian, result.kept)
    kinds = result.problem.kinds[result.kept]
    return min((free for kind, free in enumerate(every) if (kinds == kind).any()), default=math.inf)


def likeliest(
    noise: tuple[float, float], jitter: float, known: Known, deviations: FloatArray,
    rates: FloatArray, kept: Mask, share: float,
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


def chi2_under(result: Estimate, noise: tuple[float, float]) -> float:
    """χ² under a noise, of all frames, with no residual beyond the farthest."""
    problem = result.problem.with_noise(noise, result.x, result.kept)
    total = sum(float(squares.sum()) for squares in capped_squares(problem, result.x))
    total += sum(((result.x[k] - value) / spread) ** 2 for k, value, spread in problem.priors)
    return total if math.isfinite(total) else math.inf

"""What an estimate is held against: friction over slip speed, other laws, frames held out.

Every law is fitted with the same unknowns to the same frames.  The noise is that of the law that
leaves least (or the one given), and a residual beyond four standard deviations counts as four, so
that no law gains by calling frames outliers.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.contact.laws import law_of
from puck_tables.errors import InputError
from puck_tables.fitting.certainty import Z95, Certainty
from puck_tables.fitting.estimate import Estimate, capped_squares, estimate
from puck_tables.fitting.fit_spec import FitSpec
from puck_tables.fitting.initial_estimate import (
    initial_estimate,
    nearest_start,
    starts_from_slowing,
)
from puck_tables.fitting.least_squares import minimise_robustly
from puck_tables.fitting.observations import FEWEST, MEDIAN, Observations, rests_from
from puck_tables.fitting.parameters import LAW_NUMBERS, NODES
from puck_tables.fitting.problem import ANGLE, PLACE, ROUGH, UNSEEN, Known, Problem
from puck_tables.fitting.speed_motion import LAWS
from puck_tables.fitting.whole_turns import on_another_floor

_ROUGHLY = 15  # steps
_FALLS = 0.99  # of the cost before: a floor that still comes nearer is followed
_NEAR = 3.0  # times the noise: floors that are fitted to the end
_FRAMES = 80  # that tell whether such a law may be the reason of a misfit
_LEAST = 0.02  # of the largest friction of a line: the smallest
_FAINTEST, _STRONGEST = 0.02, 10.0  # times one friction for all speeds: laws that some floor has
_SHARES = (0.0, 0.08, 0.3, 1.0)  # of the fastest slip
_ALL_KNOWN = Known(True, True, True)


def over_speeds(result: Estimate, speeds: tuple[float, ...], between: str) -> Estimate:
    """The estimate with a friction coefficient for each slip speed, from that of one for all."""
    if (fastest := result.problem.fastest(result.x)) > speeds[-1]:
        raise InputError(
            f"the puck slips at up to {fastest:.4g} m/s, but the last of the slip speeds is "
            f"{speeds[-1]:g} m/s: give speeds up to {math.ceil(10.0 * fastest) / 10.0:g}"
        )
    moved, start = _begun(result.problem, result.x, speeds)
    lines, _ = minimise_robustly(moved, start)
    spec = replace(moved.spec, between=between)
    return estimate(replace(moved, spec=spec), lines)


def on_a_floor(problem: Problem) -> Estimate:
    """The estimate of a floor that is compared with others: about, where it does not come near."""
    begun, x = nearest_start(problem, starts_from_slowing(problem))
    cost, falls = math.inf, True
    while falls:
        x, less = minimise_robustly(begun, x, _ROUGHLY)
        rows = problem.residuals(x)
        if problem.usual(rows) < _NEAR:
            return estimate(problem, x)
        cost, falls = less, less < _FALLS * cost
    noise = (problem.usual(rows) / MEDIAN * problem.noise[0], problem.noise[1])
    wider = problem if problem.known.place else problem.with_noise(noise, x)
    none = np.zeros((rows.size, x.size))
    return Estimate(wider, x, problem.kinds != UNSEEN, wider.residuals(x), none)


def tried(result: Estimate) -> Estimate:
    """About what a law over slip speed leaves of the frames of an estimate."""
    problem = result.problem
    top = problem.fastest(result.x)
    speeds = tuple(float(f"{1.1 * top * share:.2g}") for share in _SHARES)
    fewer = problem.with_films(tuple(film.thinned(_FRAMES) for film in problem.films))
    usual = problem.numbers_at(result.x)["friction"]
    bounds = {"friction": (_FAINTEST * usual, _STRONGEST * usual), **problem.spec.bounds}
    fewer = replace(fewer, known=_ALL_KNOWN, level=ROUGH, spec=replace(problem.spec, bounds=bounds))
    return over_speeds(replace(result, problem=fewer), speeds, "cubic")


def _begun(
    problem: Problem, x: FloatArray, speeds: tuple[float, ...]
) -> tuple[Problem, FloatArray]:
    """A problem of lines between slip speeds, with the friction of an estimate at each.

    Where drag besides friction is nearer to the tracks, which is a line, it is that of the line.
    Where f is the same at all speeds the slopes of a cubic jump: lines lead away from there.
    """
    spec = problem.spec.over(speeds, "linear")
    numbers, launches = problem.numbers_at(x), problem.launches(x)
    numbers.update({name: numbers["friction"] for name in spec.free if name in NODES})
    moved = replace(problem, spec=spec, weights=(), tall=False)
    start = moved.unknowns(numbers, launches, problem.estimated_walls(x))
    line = None if problem.impact_specs else on_another_floor(problem, x)
    if line is None:
        return moved, start
    there, _ = minimise_robustly(*line)
    result, gravity = line[0].numbers_at(there), problem.spec.known()["gravity"]
    values = result["friction"] + result["drag"] / gravity * np.array(speeds)
    values = np.maximum(values, _LEAST * values.max())
    numbers.update(dict(zip(NODES, values.tolist(), strict=False)))
    if "delta" in numbers:  # of the same height
        numbers["delta"] = min(numbers["delta"] * values[0] / numbers["friction"], 1.0)
    other = moved.unknowns(numbers, line[0].launches(there))
    near = [float((moved.residuals(one) ** 2).sum()) for one in (start, other)]
    return moved, other if near[1] < near[0] else start


def law_over(
    result: Estimate, covariance: FloatArray, at: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """The friction coefficient at slip speeds (n,) m/s, and its standard errors (n,)."""
    spec, numbers = result.problem.spec, result.problem.numbers_at(result.x)
    count = len(spec.speeds)
    slopes = np.zeros((at.size, count))
    for k, name in enumerate(spec.free[:count]):
        step = 1e-4 * numbers[name]
        ends = [spec.speed_law({**numbers, name: numbers[name] + by})(at) for by in (step, -step)]
        slopes[:, k] = (ends[0] - ends[1]) / (2.0 * step)
    spread = np.einsum("ni,ik,nk->n", slopes, covariance[:count, :count], slopes)
    return np.asarray(spec.speed_law(numbers)(at)), np.sqrt(spread)


# what may go with a pressure law, and what is then found besides
FLOORS = {
    "drag": ("drag",), "air": ("air",), "stribeck": LAW_NUMBERS, "hyperbola": LAW_NUMBERS,
    "two-valued": LAW_NUMBERS, "slope": ("slope_x", "slope_y"), "belt": ("belt_x", "belt_y"),
}  # fmt: skip
EVERY_FLOOR = "floors"  # of uniform pressure: all of these
_CONTENDS = 60.0  # of χ²: laws worse than the best by more are not fitted further


class LawScore(NamedTuple):
    """One law.

    ``chi2``: squares of residuals under the common noise; ``unknowns``: how many were found;
    ``weight``: its share of the Akaike weights exp(−½(χ² + 2 unknowns)); ``numbers``: what was
    found of the puck.
    """

    name: str
    chi2: float
    unknowns: int
    weight: float
    numbers: dict[str, float]


def compare(problem: Problem, variants: Mapping[str, FitSpec]) -> tuple[LawScore, ...]:
    """The laws named, best first, of the frames of a problem; those that contend are fitted on.

    Frames that another law leaves out at the ends may be those that tell.
    """
    fits, noise, known = dict[str, Estimate](), problem.noise, problem.known
    for name, question in variants.items():
        same = replace(problem, spec=question, known=known._replace(jitter=True))
        try:
            fits[name] = (
                on_a_floor(same) if question.integrated else initial_estimate(same, refit=False)
            )
        except InputError:
            if "+" not in name:  # no such floor leads to such a track
                raise
    place, angle = (
        noise[kind] if known[kind] else min(one.problem.noise[kind] for one in fits.values())
        for kind in range(2)
    )
    unknowns = np.array([one.x.size for one in fits.values()])
    chi2 = np.array([chi2_under(one, (place, angle)) for one in fits.values()])
    score = chi2 + 2.0 * unknowns
    near = score < score.min() + _CONTENDS
    for k, (name, before) in enumerate(fits.items()):
        if near[k] and not (known.place and known.angle):
            same = before.problem.with_noise((place, angle), before.x)
            one = estimate(replace(same, known=_ALL_KNOWN), before.x)
            if (less := chi2_under(one, (place, angle))) < chi2[k]:
                fits[name], chi2[k] = one, less
    score = chi2 + 2.0 * unknowns
    weight = np.exp(-0.5 * (score - score.min()))
    weight /= weight.sum()
    every = [*zip(fits.items(), *(one.tolist() for one in (chi2, unknowns, weight)), strict=True)]
    return tuple(
        LawScore(name, c, m, w, one.problem.numbers_at(one.x))
        for (name, one), c, m, w in (every[k] for k in np.argsort(score, kind="stable"))
    )


def variants_of(spec: FitSpec, names: Any) -> dict[str, FitSpec]:
    """What is asked of each law by its name."""
    if isinstance(names, str):
        raise InputError(f"laws must be a list of names, got the text '{names}'")
    floors = ["uniform", *(f"uniform+{one}" for one in FLOORS)]
    names = [more for name in names for more in (floors if name == EVERY_FLOOR else [name])]
    if len(set(names)) < len(names):
        raise InputError(f"laws {', '.join(names)}: name each law once")
    other = {"inner", *(one for numbers in FLOORS.values() for one in numbers)}
    plain = tuple(n for n in spec.free if n not in other)
    fixed = {n: v for n, v in spec.fixed.items() if n not in other}
    variants = {}
    for name in names:
        pressure, plus, floor = name.partition("+")
        if plus and floor not in FLOORS:
            raise InputError(f"laws {name}: behind + may stand {', '.join(FLOORS)}")
        puck, law = replace(spec.puck, pressure=law_of(pressure)), floor if floor in LAWS else ""
        free = plain + FLOORS.get(floor, ())
        variants[name] = replace(spec, puck=puck, free=free, fixed=fixed, law=law)
        if variants[name].integrated:
            variants[name].refuse_integrated()
    return variants


def chi2_under(result: Estimate, noise: tuple[float, float]) -> float:
    """χ² under a noise, of all frames, with no residual beyond the farthest."""
    problem = result.problem.with_noise(noise, result.x, result.kept)
    total = sum(float(squares.sum()) for squares in capped_squares(problem, result.x))
    total += sum(((result.x[k] - value) / spread) ** 2 for k, value, spread in problem.priors)
    return total if math.isfinite(total) else math.inf


_EACH = 7.0  # of χ², that each more number has to earn: ln n of a film of some hundred frames
_ALIKE = 10.0  # of that: floors that the film does not tell apart


def verdict(laws: tuple[LawScore, ...]) -> str:
    """Which of the laws compared a film supports, from the simplest up, in a sentence.

    A law counts by χ² + 7 for each number.

    >>> one = LawScore("uniform", 930.0, 8, 0.0, {})
    >>> verdict((one._replace(name="uniform+air", chi2=700.0, unknowns=9), one))
    'uniform+air is what the film supports: with 1 more number than uniform it leaves 230 less of \
chi^2, and no other law leaves less for its numbers.'
    """
    if len(laws) < 2:
        return ""
    ranked = sorted(laws, key=lambda one: one.chi2 + _EACH * one.unknowns)
    simplest = min(laws, key=lambda one: (one.unknowns, one.chi2))
    best = ranked[0]
    least = best.chi2 + _EACH * best.unknowns
    alike = [one.name for one in ranked[1:] if one.chi2 + _EACH * one.unknowns < least + _ALIKE]
    if best is simplest:
        said = (
            f"{best.name} is enough: no law with more numbers leaves so much less of chi^2 that "
            "they are worth it"
        )
    else:
        more = best.unknowns - simplest.unknowns
        words = f"{more} more number{'' if more == 1 else 's'} than"
        said = (
            f"{best.name} is what the film supports: with {words} {simplest.name} it leaves "
            f"{simplest.chi2 - best.chi2:.4g} less of chi^2, and no other law leaves less for its "
            "numbers"
        )
    if alike:
        said += f"; {', '.join(alike)} may be as right: the film does not tell"
    return f"{said}."


# of the frames, that may be held out: some that judge, and some to fit to
LEAST_SHARE, LARGEST_SHARE = 0.05, 0.9


@dataclass(frozen=True, eq=False)
class HeldOut:
    """Predictions of frames that the fit did not see.

    ``tracks``: whose later part it is; ``z_place`` (n,), ``z_angle`` (m,): what was seen less what
    was predicted, over the standard deviation of noise and prediction together; ``chance``: the
    range in which :attr:`rms` lies by chance, 95 of 100 times, if the model is right.
    """

    tracks: tuple[str, ...]
    z_place: FloatArray
    z_angle: FloatArray
    chance: tuple[float, float]

    @property
    def inside(self) -> float:
        """The share of observations within 95 % of their prediction."""
        every = np.abs(np.concatenate([self.z_place, self.z_angle]))
        return float(np.mean(every < Z95))

    @property
    def rms(self) -> float:
        """The root mean square of z; 1 where the model and its errors are right.

        An outlier counts as four.
        """
        every = np.clip(np.concatenate([self.z_place, self.z_angle]), -4.0, 4.0)
        return float(np.sqrt(np.mean(every**2)))


def split(
    films: tuple[Observations, ...], hold_out: float | tuple[str, ...], spread: float
) -> tuple[tuple[Observations, ...], tuple[npt.NDArray[np.bool_], ...]]:
    """The tracks with what is fitted of them alone, and which frames of each are predicted.

    That is the last share of the moving frames of each, or the later half of tracks that are named;
    ``spread`` m: noise of places.
    """
    if isinstance(hold_out, float) and not LEAST_SHARE <= hold_out <= LARGEST_SHARE:
        raise InputError(
            f"hold_out must be a share of the frames from {LEAST_SHARE:g} to {LARGEST_SHARE:g}, or "
            f"names of tracks, got {hold_out:g}"
        )
    names = [film.name for film in films]
    for name in () if isinstance(hold_out, float) else hold_out:
        if name not in names:
            raise InputError(f"hold_out names '{name}': the tracks are {', '.join(names)}")
    kept, later = [], []
    for film in films:
        share = hold_out if isinstance(hold_out, float) else 0.5 * (film.name in hold_out)
        moving = rests_from(film, spread)
        count = film.time.size if share == 0.0 else round((1.0 - share) * moving)
        if count < FEWEST + 2 and share > 0.0:
            raise InputError(
                f"{film.name} would keep {count} frames: hold out a smaller share, or other tracks"
            )
        after = np.arange(film.time.size) >= count
        kept.append(film.part(~after))
        later.append(after)
    return tuple(kept), tuple(later)


def predicted(
    part: Estimate, certainty: Certainty, films: tuple[Observations, ...],
    later: tuple[npt.NDArray[np.bool_], ...],
) -> HeldOut:  # fmt: skip
    """How far the frames held out are from their predictions."""
    whole = part.problem.with_films(films).with_noise(part.problem.noise, part.x)
    rows, slopes = whole.residuals(part.x), whole.jacobian(part.x)
    by_fit = np.einsum("ik,kl,il->i", slopes, certainty.covariance, slopes)
    z, chosen = -rows / np.sqrt(1.0 + by_fit), np.zeros(rows.size, bool)
    for film, (x, y, turn), after in zip(films, whole.each(), later, strict=True):
        chosen[x] = after
        chosen[y] = after & (film.straight is None)
        if film.angle is not None:
            chosen[turn] = after[np.isfinite(film.angle)]
    names = tuple(film.name for film, after in zip(films, later, strict=True) if after.any())
    noise_degrees = math.inf if certainty.degrees == math.inf else part.degrees
    return HeldOut(
        names, z[chosen & (whole.kinds == PLACE)], z[chosen & (whole.kinds == ANGLE)],
        _by_chance(slopes[chosen], by_fit[chosen], certainty.covariance, noise_degrees),
    )  # fmt: skip


def _by_chance(
    slopes: FloatArray, by_fit: FloatArray, covariance: FloatArray, noise_degrees: float
) -> tuple[float, float]:
    """Between which the rms of z lies with 95 %, over ``noise_degrees`` of its noise.

    The z of one motion err together: with R their correlations Σz² is as (n/ν) χ² of
    ν = n²/tr R² degrees (Satterthwaite), over the noise that was told as F.
    """
    from scipy.special import chdtri, fdtri

    weight = 1.0 / (1.0 + by_fit)
    shared = covariance @ (slopes.T * weight) @ slopes
    square = float(np.sum(weight**2 * (1.0 + 2.0 * by_fit)) + np.sum(shared * shared.T))
    degrees = by_fit.size**2 / square
    if noise_degrees == math.inf:
        ends = [chdtri(degrees, tail) / degrees for tail in (0.975, 0.025)]
    else:
        ends = [fdtri(degrees, noise_degrees, share) for share in (0.025, 0.975)]
    return math.sqrt(ends[0]), math.sqrt(ends[1])

"""Whether residuals are noise: what is left of a wrong model has a pattern."""

from __future__ import annotations

import math

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.fitting.estimate import Estimate
from puck_tables.fitting.forward_model import RATE
from puck_tables.fitting.timing import Known

NO_PATTERN = 1e-3  # probability of residuals so patterned by chance
JITTERY = 1.3  # residuals along the motion over those across it: more, and stamps may jitter
NOISY = 1.5  # times the noise of a smooth motion
_MAY_NOISY, _MAY_PATTERN = 1.3, 0.01  # the same, where that is hardly seen
_COMPUTED = 1e-7  # of the path: residuals of tracks that were computed, not seen
_NOWHERE, _FAR, _ANY = 20.0, 1e-3, 0.5  # times the noise; of the path; rad
_PARTS = 8
_ROUNDED = 0.45  # of a step: residuals of what is rounded, and of some noise
_MOVING, _ENOUGH = 0.1, 20  # of the greatest speed; frames


def chi_square_tail(value: float, degrees: int) -> float:
    """The probability that χ² exceeds a value.

    Examples
    --------
    >>> round(chi_square_tail(3.841459, 1), 6)
    0.05
    """
    from scipy.special import gammaincc

    return float(gammaincc(0.5 * degrees, 0.5 * value))


def runs(result: Estimate) -> float:
    """The probability of so few or so many changes of sign along the frames (Wald and Wolfowitz).

    Of all tracks, x, y and angles together.
    """
    deviations, variance = 0.0, 0.0
    for rows in _series(result):
        above = rows > 0.0
        n, plus = above.size, int(above.sum())
        minus = n - plus
        if plus < 2 or minus < 2:
            continue
        mean = 2.0 * plus * minus / n
        changes = int((above[1:] != above[:-1]).sum())
        deviations += changes - mean
        variance += mean * (2.0 * plus * minus - n) / (n * (n - 1.0))
    if variance == 0.0:
        return 1.0
    return math.erfc(abs(deviations) / math.sqrt(2.0 * variance))


def drift(result: Estimate) -> float:
    """The probability that means over eighths of the tracks are so far from 0 by chance."""
    total, degrees = 0.0, 0
    for rows in _series(result):
        for part in np.array_split(rows, min(_PARTS, rows.size)):
            total += part.sum() ** 2 / part.size
            degrees += 1
    scale = max(result.chi2 / max(result.degrees, 1), 1e-300)
    return chi_square_tail(total / scale, max(degrees - result.x.size, 1)) if degrees else 1.0


def excess_of(result: Estimate, smooth: tuple[float, float]) -> float:
    """The residuals over the noise (m, rad) that no model judged; 1 where that is not known."""
    size = math.sqrt(result.chi2 / max(result.degrees, 1))
    return max((
        size * own / other for own, other in zip(result.problem.noise, smooth, strict=True)
        if math.isfinite(other) and other > 0.0
    ), default=1.0)  # fmt: skip


def misfits(
    result: Estimate, known: Known, smooth: tuple[float, float], explained: float
) -> tuple[str, ...]:
    """Signs that a model does not fit.

    Parameters
    ----------
    result, known : the estimate, and which noise was given
    smooth : the noise (m, rad) that no model judged
    explained : the probability by chance of what a slope, drag or air would explain
    """
    told = []
    noise, chi2, degrees = result.problem.noise, result.chi2, max(result.degrees, 1)
    size = max(float(np.ptp(film.place, axis=0).max()) for film in result.problem.films)
    # smaller residuals are the errors of what is computed
    seen = noise[0] > _COMPUTED * size
    excess = excess_of(result, smooth)
    given = any(known[:2])
    if seen and not given and excess > NOISY:
        told.append(f"The residuals are {excess:.3g} times what smooth tracks would leave")
    if given and chi2 / degrees > 1.0 + 5.0 * math.sqrt(2.0 / degrees):
        told.append(f"The residuals are {math.sqrt(chi2 / degrees):.3g} times the noise given")
    by_chance = min(runs(result), drift(result), explained)
    if seen and by_chance < NO_PATTERN and not hidden(result):
        told.append(
            "The residuals are no noise, they have a pattern (probability by chance "
            f"{by_chance:.1g})"
        )
    return tuple(told)


def hidden(result: Estimate) -> bool:
    """Whether residuals are no more than rounding leaves, which is no noise."""
    films, noise = result.problem.films, result.problem.noise
    steps = [max(film.steps[kind] for film in films) for kind in range(2)]
    angled = any(film.angle is not None for film in films)
    size = math.sqrt(result.chi2 / max(result.degrees, 1))
    within = [
        step > 0.0 and size * own < _ROUNDED * step for step, own in zip(steps, noise, strict=True)
    ]
    return within[0] or (angled and within[1])


def may_misfit(
    result: Estimate, known: Known, smooth: tuple[float, float], explained: float
) -> bool:
    """Whether a model may not fit, or what is left is no noise; as :func:`misfits`.

    Below what is complained of that may bias numbers by far.
    """
    noisy = excess_of(result, smooth) > _MAY_NOISY
    pattern = not hidden(result) and min(runs(result), drift(result), explained) < _MAY_PATTERN
    return noisy or pattern or bool(misfits(result, known, smooth, explained))


def no_answer(result: Estimate, known: Known, smooth: tuple[float, float]) -> str:
    """A sentence where no motion comes near the tracks, and nothing is determined; else none."""
    size = max(float(np.ptp(film.place, axis=0).max()) for film in result.problem.films)
    usual = math.sqrt(result.chi2 / max(result.degrees, 1))
    times = max(excess_of(result, smooth), usual if any(known[:2]) else 0.0)
    angled = any(film.angle is not None for film in result.problem.films)
    if times > _NOWHERE and usual * result.problem.noise[0] > _FAR * size:
        far = f"the nearest is {times:.3g} times the noise off"
    elif angled and usual * result.problem.noise[1] > _ANY:
        far = f"angles are {usual * result.problem.noise[1]:.2g} rad off the nearest"
    else:
        return ""
    return (
        f"Nothing is determined: no motion of such a puck fits these tracks, {far}. What would "
        "tell: a start near the truth (--start), more frames a second, or a floor, a radius or "
        "units as they are"
    )


def lengthways(result: Estimate) -> float:
    """The spread of residuals along the motion over that across it, less what chance may do.

    Of frames that move, by three standard errors of such a ratio; 1 of too few.
    """
    along, across = [], []
    deviations, states = result.problem.deviations(result.x), result.problem.states(result.x)
    films = result.problem.films
    for film, (x, _, _), one, state in zip(
        films, result.problem.each(), deviations, states, strict=True
    ):
        if film.straight is not None:
            continue
        rate = state[RATE][:2]
        speed = np.hypot(*rate)
        moving = result.kept[x] & (speed > _MOVING * speed.max(initial=0.0))
        ahead = rate[:, moving] / speed[moving]
        along.append((one[:2, moving] * ahead).sum(axis=0))
        across.append(one[0, moving] * ahead[1] - one[1, moving] * ahead[0])
    one, two = (np.concatenate(part or [np.empty(0)]) for part in (along, across))
    if one.size < _ENOUGH or not two.any():
        return 1.0
    ratio = math.sqrt(float(np.mean(one**2) / np.mean(two**2)))
    return ratio * (1.0 - 3.0 / math.sqrt(one.size))


def _series(result: Estimate) -> list[FloatArray]:
    """Residuals that count, frame after frame."""
    return [
        rows
        for part in result.problem.each()
        for where in part
        if (rows := result.residuals[where][result.kept[where]]).size
    ]

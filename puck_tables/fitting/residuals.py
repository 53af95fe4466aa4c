"""Whether residuals are noise, and which small force would explain them, to first order.

What is left of a wrong model has a pattern.  A small push at one moment changes the motion after it
as another launch from there would.  With V(t) = ∂(vx, vy, ω)(t)/∂(vx, vy, ω)(0), which a fit has
anyway, a slope, drag or air change velocity and spin by

    δ(vx, vy, ω)(t) = ∫ V(t) V(s)⁻¹ (ax, ay, α)(s) ds .
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.fitting.certainty import Certainty, shifted_by
from puck_tables.fitting.estimate import Estimate
from puck_tables.fitting.forward_model import DELTA, RATE, Moving, states_and_slopes, states_of
from puck_tables.fitting.observations import noise_of
from puck_tables.fitting.problem import ANGLE, PLACE

NO_PATTERN = 1e-3  # probability of residuals so patterned by chance
JITTERY = 1.3  # residuals along the motion over those across it: more, and stamps may jitter
NOISY = 1.5  # times the noise of a smooth motion
_MAY_NOISY, _MAY_PATTERN = 1.3, 0.01  # the same, where that is hardly seen
_COMPUTED = 1e-7  # of the path: residuals of tracks that were computed, not seen
_NOWHERE, _FAR, _ANY = 20.0, 1e-3, 0.5  # times the noise; of the path; rad
_SELDOM, _RARE = 3.3, 2.4  # standard deviations: one film in 1,000, in 100; few scatter wider
_PARTS = 8  # of a track, whose means tell a drift
_ROUNDED = 0.45  # of a step: residuals of what is rounded, and of some noise
_MOVING, _ENOUGH = 0.1, 20  # of the greatest speed; frames


def runs(result: Estimate) -> float:
    """The probability of so few or so many changes of sign along the frames (Wald and Wolfowitz).

    Of all tracks, x, y and angles together.
    """
    deviations, variance = 0.0, 0.0
    for above in (rows > 0.0 for rows in _series(result)):
        n, plus = above.size, int(above.sum())
        if min(plus, n - plus) >= 2:
            mean = 2.0 * plus * (n - plus) / n
            deviations += int((above[1:] != above[:-1]).sum()) - mean
            variance += mean * (mean * n - n) / (n * (n - 1.0))
    return math.erfc(abs(deviations) / math.sqrt(2.0 * variance)) if variance else 1.0


def drift(result: Estimate) -> float:
    """The probability that means over eighths of the tracks are so far from 0 by chance."""
    from scipy.special import chdtrc

    every = [part for rows in _series(result)
             for part in np.array_split(rows, min(_PARTS, rows.size))]  # fmt: skip
    total = sum(part.sum() ** 2 / part.size for part in every) / max(result.size**2, 1e-300)
    return float(chdtrc(max(len(every) - result.x.size, 1), total)) if every else 1.0


def excess_of(
    result: Estimate, chance: float = 0.0, smooth: tuple[float, float] | None = None
) -> float:
    """The residuals over the noise that no model judged; 1 where that is not known.

    ``chance``: standard deviations by which that noise may be too small by chance, as that of few
    frames is: the logarithm of what n third differences tell scatters by 1.5/√n, as drawn ones do;
    ``smooth``: another such noise (m, rad) than that of the problem.
    """
    smooth = smooth or result.problem.smooth
    films, kinds = len(result.problem.films), result.problem.kinds
    thirds = [max((kinds == kind).sum() - 3 * films * (2 - kind), 1) for kind in (PLACE, ANGLE)]
    every = zip(thirds, result.problem.noise, smooth, strict=True)
    ratios = [(n, result.size * own / other) for n, own, other in every if 0.0 < other < math.inf]
    return max((one for n, one in ratios if not chance or math.log(one) > chance * 1.5 / n**0.5),
               default=1.0)  # fmt: skip


def misfits(result: Estimate, explained: float) -> tuple[str, ...]:
    """Signs that a model does not fit.

    ``explained``: the probability by chance of what a slope, drag or air would explain.
    """
    sentences = []
    seen = not computed(result)
    excess = excess_of(result, _SELDOM)
    is_known = any(result.problem.known[:2])
    if seen and not is_known and excess > NOISY:
        sentences.append(f"The residuals are {excess:.3g} times what smooth tracks would leave")
    if is_known and result.size**2 > 1.0 + 5.0 * math.sqrt(2.0 / max(result.degrees, 1)):
        sentences.append(f"The residuals are {result.size:.3g} times the noise given")
    by_chance = min(runs(result), drift(result), explained)
    if seen and by_chance < NO_PATTERN and not hidden(result):
        sentences.append(
            "The residuals are no noise, they have a pattern (probability by chance "
            f"{by_chance:.1g})"
        )
    return tuple(sentences)


def is_clean(result: Estimate, excess: float = 1.2, chance: float = 0.01) -> bool:
    """Whether what is left of a track is noise, no more than that of a smooth motion."""
    smooth = noise_of(list(result.problem.films))[0], math.nan  # angles tell whole turns, too
    noisy = excess_of(result, smooth=smooth) >= excess
    return not noisy and min(runs(result), drift(result)) > chance


def computed(result: Estimate) -> bool:
    """Whether residuals are so small that they are the errors of what is computed."""
    problem = result.problem
    least = max(
        _COMPUTED * max(film.size for film in problem.films),
        1.01 * problem.least_noise(result.x)[0],
    )
    return not problem.noise[0] > least


def hidden(result: Estimate) -> bool:
    """Whether residuals are no more than rounding leaves, which is no noise."""
    steps = np.max([film.steps for film in result.problem.films], axis=0)
    place, angle = result.size * np.array(result.problem.noise) < _ROUNDED * steps
    return bool(place or (result.problem.angled and angle))


def may_misfit(result: Estimate, explained: float) -> bool:
    """Whether a model may not fit, though :func:`misfits` has no sign: that may bias numbers."""
    pattern = not hidden(result) and min(runs(result), drift(result), explained) < _MAY_PATTERN
    return pattern or excess_of(result, _RARE) > _MAY_NOISY


def no_answer(result: Estimate) -> str:
    """A sentence where no motion comes near the tracks, and nothing is determined; else none."""
    usual, problem = result.size, result.problem
    size = max(film.size for film in problem.films)
    times = max(excess_of(result), usual if any(result.problem.known[:2]) else 0.0)
    if times > _NOWHERE and usual * problem.noise[0] > _FAR * size:
        far = f"the nearest is {times:.3g} times the noise off"
    elif problem.angled and usual * problem.noise[1] > _ANY:
        far = f"angles are {usual * problem.noise[1]:.2g} rad off the nearest"
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
    each = zip(films, result.problem.each(), deviations, states, strict=True)
    for film, (x, _, _), one, state in each:
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
    rows, kept = result.residuals, result.kept
    every = (rows[where][kept[where]] for part in result.problem.each() for where in part)
    return [one for one in every if one.size]


SLOPE, DRAG, AIR = (0, 1), (2,), (3,)  # forces: m/s² along x and y; 1/s; 1/m
_KINDS = {SLOPE: "a table out of level by {:.2g} degrees", DRAG: "drag", AIR: "air"}
_FORCES = 4  # columns of the four above
_MOMENTS = 32  # of a motion, between which the change by a force is a cubic
_ENDS = 0.9995  # of the motion: at its end nothing is carried on
_REST = 1e-3  # of the greatest slip
OUT_OF_LEVEL = 0.1  # degrees of a table that nobody levelled with care
_STEEP = 3.0  # degrees: nobody takes that for a level table
_ALIKE = 6.0  # of χ²: forces that explain about as much
_LAW = 0.2  # of a friction, by which it may change up to the fastest slip
# of the largest slope; of what a force does: less is computed inexactly
_RANK, _VISIBLE = 1e-9, 2e-3


class SideForces(NamedTuple):
    """What a slope, drag or air would do to a fit.

    ``chance``: the probability of residuals that one of them explains so well; ``words``: which
    may; ``level``: how well the slope is told, degrees; ``by_slope``: by how much it changes each
    number of the puck if the table is out of level by 0.1 degrees; ``by_law`` (m,): what a friction
    that grows by a fifth to the fastest slip does to the unknowns; ``biases`` (m, k): what each
    that may explain residuals would have done to them.
    """

    chance: float = 1.0
    words: str = ""
    level: float = 0.0
    by_slope: Mapping[str, float] = {}
    by_law: FloatArray = np.empty(0)
    biases: FloatArray = np.empty((0, 0))


def side_forces(result: Estimate, certainty: Certainty) -> SideForces:
    """What these forces do to an estimate; nothing is said of impacts and of laws over speed."""
    problem = result.problem
    if problem.impact_specs or problem.spec.speeds or any(problem.rests):
        return SideForces()
    kept, values = result.kept[:, None], problem.numbers_at(result.x)
    moving, rows = problem.moving(values), []
    for n, launch in enumerate(problem.launches(result.x)):
        rows.append(problem.weighed(n, _along(moving, launch, problem.times(n, values))))
    columns = np.concatenate([*rows, np.zeros((len(problem.priors), _FORCES))]) * kept
    changes = shifted_by(result, certainty, columns)
    slopes = result.jacobian * kept
    slopes = slopes / np.maximum(np.linalg.norm(slopes, axis=0), 1e-300)
    basis, sizes, _ = np.linalg.svd(slopes[:, np.equal(certainty.pinned, 0)], full_matrices=False)
    basis = basis[:, sizes > _RANK * sizes.max(initial=0.0)]
    left = result.residuals * result.kept
    left = left - basis @ (basis.T @ left)
    lengths = np.maximum(np.linalg.norm(columns, axis=0), 1e-300)
    columns = (columns - basis @ (basis.T @ columns)) / lengths
    if not left.any() or result.degrees <= _FORCES:
        return SideForces()
    shares = {kind: _explained(columns[:, kind], left, result.degrees) for kind in _KINDS}
    forces = {kind: one.force / lengths[list(kind)] for kind, one in shares.items()}
    decel = problem.spec.scales(values)[0]
    gravity = problem.spec.numbers(values)["gravity"]
    tilt = math.degrees(math.hypot(*forces[SLOPE]) / gravity)
    best = max(one.gain for one in shares.values())
    near = [kind for kind, one in shares.items() if one.gain > best - _ALIKE]
    if tilt > _STEEP and len(near) > 1:
        near = [kind for kind in near if kind != SLOPE]
    slope = np.hypot(*changes[:, SLOPE].T) * gravity * math.radians(OUT_OF_LEVEL)
    fastest = problem.fastest(result.x)
    # a slope that is asked for, or held, is not taken for granted
    granted = not {"slope_x", "slope_y"} & {*problem.spec.named}
    return SideForces(
        min(len(_KINDS) * min(one.chance for one in shares.values()), 1.0),
        " or ".join(_KINDS[kind].format(tilt) for kind in near),
        math.degrees(shares[SLOPE].error / lengths[list(SLOPE)].max() / gravity),
        dict(zip(problem.spec.free, slope.tolist(), strict=False)) if granted else {},
        changes[:, DRAG[0]] * _LAW * decel / max(fastest, 1e-300),
        np.stack([changes[:, kind] @ forces[kind] for kind in near], axis=1),
    )  # fmt: skip


class _Explained(NamedTuple):
    """The force that leaves least, χ² less, the chance of that, and the error of the force."""

    force: FloatArray
    gain: float
    chance: float
    error: float


def _explained(columns: FloatArray, rows: FloatArray, degrees: int) -> _Explained:
    """What forces (n, k), as shares of all they do, explain of residuals that no unknown does.

    What is left of them below :data:`_VISIBLE` is what is computed inexactly, and tells nothing.
    """
    from scipy.special import fdtrc

    basis, sizes, turned = np.linalg.svd(columns, full_matrices=False)
    kept = sizes > _VISIBLE
    basis, seen, turned = basis[:, kept], sizes[kept], turned[kept]
    along, left, count = basis.T @ rows, float(rows @ rows), seen.size
    less = float(along @ along)
    noise = max((left - less) / (degrees - count), 1e-300)
    chance = float(fdtrc(count, degrees - count, less / count / noise)) if count else 1.0
    error = math.sqrt(noise) / float(seen.min()) if count == sizes.size else math.inf
    return _Explained(-(along / seen) @ turned, less / noise, chance, error)


def _along(moving: Moving, launch: FloatArray, times: FloatArray) -> FloatArray:
    """What a unit of each force does to the places and angles of one motion, (3, n, forces).

    V(t) = ∂(vx, vy, ω)(t)/∂(vx, vy, ω)(0) carries changes on, from each moment to the next.
    """
    from scipy.interpolate import CubicSpline

    vx, vy, w = states_of(moving, launch, times)[RATE]
    belt = (0.0, 0.0) if moving.by_speed is None else moving.by_speed.belt
    slips = np.hypot(np.hypot(vx - belt[0], vy - belt[1]), moving.radius * w)
    moves = int((slips > _REST * slips.max()).sum())
    end = float(times[moves - 1]) if moves else 0.0
    if 1 < moves < times.size:  # it slows at about a constant rate until it stops
        before, last = slips[moves - 2 : moves]
        end += last / (before - last) * (end - float(times[moves - 2]))
    end *= _ENDS
    if not end > 0.0:
        return np.zeros((3, times.size, _FORCES))
    moments = np.linspace(0.0, end, _MOMENTS)
    states, slopes, _ = states_and_slopes(moving, launch, moments)
    moved, rates = slopes[:, RATE, :DELTA], states[RATE].T
    onwards = moved[1:] @ np.linalg.inv(moved[:-1])
    forces = np.zeros((_MOMENTS, 3, _FORCES))
    forces[:, [0, 1], [0, 1]] = 1.0
    forces[:, :, DRAG[0]] = -rates
    forces[:, :2, AIR[0]] = -rates[:, :2] * np.hypot(*rates[:, :2].T)[:, None]
    half = 0.5 * moments[1]
    changes = np.zeros_like(forces)
    for k, on in enumerate(onwards):
        changes[k + 1] = on @ (changes[k] + half * forces[k]) + half * forces[k + 1]
    path = CubicSpline(moments, changes).antiderivative()(np.minimum(times, end))
    return np.moveaxis(path, 0, 1)

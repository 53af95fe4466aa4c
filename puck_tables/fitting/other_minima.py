"""Which of the motions that fit a track is taken, and how far it is to be believed.

A likelihood may have more than one summit.

Without angles a puck that slides straight without spin looks as one that spins at the ratio which
every motion tends to: both lose speed at a constant rate, but not the same share of J.  A path
bends to a side that its spin and the tilt choose; one that is not seen to bend is its own mirror
image, and does not say which way the puck spins.

A summit that stands apart is told while χ² there is higher by less than :data:`RISE`, far beyond
the 95 % limit of one summit.  Of two motions whose paths differ by D standard deviations the χ² of
the wrong one is below that of the true one by T or more with probability Φ(−(D² + T)/(2 D)), at
most Φ(−√T): of 4², as for outliers, that is one film in 30,000, whatever the motions are.
"""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import replace
from itertools import product
from typing import NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.errors import InputError
from puck_tables.fitting.certainty import (
    Z95,
    Certainty,
    OtherMinimum,
    certainty_at,
    of_rounded,
    pinned_of,
    widened,
)
from puck_tables.fitting.estimate import FARTHEST, Estimate, chi2_under, estimate, freedom
from puck_tables.fitting.fit_spec import ALL, LAUNCH, WALL
from puck_tables.fitting.initial_estimate import initial_estimate
from puck_tables.fitting.inputs import refuse_wobbling
from puck_tables.fitting.numbers import Number, numbers_of
from puck_tables.fitting.observations import GIVE_NOISE, Mask
from puck_tables.fitting.problem import Problem, compact, minimise, multi_start
from puck_tables.fitting.residuals import (
    SideForces,
    excess_of,
    may_misfit,
    misfits,
    no_answer,
    side_forces,
)
from puck_tables.fitting.slowing import on_another_floor
from puck_tables.fitting.starts import (
    EXCLUDED,
    LESS,
    MISFIT,
    Judged,
    half_turns,
    is_slow,
    minima_of,
    preferred,
)

RISE = FARTHEST**2  # of χ², up to which another summit is told
_APART = 4.0  # standard errors: another summit
_SPIN = "launch_spin"
_LIMIT = 1.5  # about rω/v that all motions tend to
_TILT = 0.2  # any: without spin it does nothing
_MORE_TURNS = 3  # whole turns more from frame to frame, to either side
_TO_OTHERS = ((3, 6), (12, 3))  # steps, and how many starts then go on


def other_minima(
    result: Estimate, certainty: Certainty, excess: float = 1.0
) -> tuple[OtherMinimum, ...]:
    """Other summits whose χ² is higher by less than :data:`RISE`.

    With angles they are motions of whole turns more from frame to frame; without them those of
    other spins.  One of less than half a turn a frame is told as long as it may be taken.
    ``excess``: the residuals over the noise that frames beside each other show, by which turns are
    judged.
    """
    problem = result.problem
    marked = problem.angled
    apart = not problem.impact_specs
    signed = marked or not apart  # a wall tells a motion from its mirror image, as angles do
    single = len(problem.films) == 1
    if problem.spec.speeds or problem.spec.integrated or problem.spec.base is not None:
        return ()
    starts = list(result.minima)
    if not starts and apart and single:
        starts = minima_of(problem)
    if not marked and apart:
        starts += _of_other_spins(result)
    starts += _of_other_turns(result)
    # few residuals tell their noise badly, and χ² with it
    far = max(certainty.quantile / Z95, 1.0) ** 2
    other_fits: list[OtherMinimum] = []
    summits = [(result.x, *_known(result, certainty))]
    for start in starts:
        x, cost = minimise(problem, start, result.kept)
        rise = 2.0 * cost - result.chi2
        deviations = [
            (np.abs(x - one if signed else np.abs(x) - np.abs(one)) > far)[seen]
            for one, seen, far in summits
        ]
        most = far * RISE / (excess**2 if marked else 1.0)
        if is_slow(problem, x) and not is_slow(problem, result.x):
            # as long as it may be taken, in units of the residuals of the fast one
            most = EXCLUDED / excess**2
            if excess > MISFIT:
                most = max(most, (LESS**2 - 1.0) * far * result.chi2)
        if rise < most and all(one.any() for one in deviations):
            # what one motion tells another may not: each summit is as wide as it is
            there = result.at(x)
            x = np.where(there.jacobian.any(axis=0), x, start)  # what does nothing stays
            there = replace(there, x=x)
            own = certainty_at(there, certainty.degrees)
            summits.append((x, *_known(there, own)))
            other_fits.append(OtherMinimum(there, own, rise, _spun_otherwise(result, x, certainty)))
    return tuple(other_fits)


def taken(
    result: Estimate, other_fits: tuple[OtherMinimum, ...], excess: float
) -> OtherMinimum | None:
    """The motion that is taken in place of an estimate; None if that is.

    Of one that ran away any that did not is taken, of those that fit about as well.
    ``excess``: its residuals over the noise of smooth motions.
    """
    if not result.chi2 > 0.0:
        return None
    problem = result.problem
    if ran_away(problem, result.x):
        near = [one for one in other_fits if not ran_away(problem, one.estimate.x)]
        return min(near, key=lambda one: one.rise, default=None)
    motions = [
        Judged(is_slow(problem, x), excess**2 * (result.chi2 + rise), excess * math.sqrt(
            max(1.0 + rise / result.chi2, 0.0)))
        for x, rise in ((result.x, 0.0), *((one.estimate.x, one.rise) for one in other_fits))
    ]  # fmt: skip
    first = preferred(motions)
    if not motions[first].slow:
        for k, motion in enumerate(motions):
            x = other_fits[k - 1].estimate.x if k else result.x
            other = on_another_floor(problem, x) if motion.slow else None
            if other is not None:
                there, cost = minimise(*other, result.kept)
                size = excess * math.sqrt(2.0 * cost / result.chi2)
                one = Judged(is_slow(other[0], there), excess**2 * 2.0 * cost, size)
                if preferred([one, motions[first]]) == 0:
                    return other_fits[k - 1] if k else None
    return other_fits[first - 1] if first else None


def _spun_otherwise(result: Estimate, x: FloatArray, certainty: Certainty) -> tuple[int, ...]:
    """Tracks that spin otherwise: with angles by whole turns, else by more than their errors."""
    problem = result.problem
    change = np.abs(problem.launches(x)[:, 4] - problem.launches(result.x)[:, 4])
    least = [half_turns(film) for film in problem.films]
    for (n, name), variance in zip(problem.names, np.diag(certainty.covariance), strict=True):
        if name == _SPIN and problem.films[n].angle is None:
            least[n] = _APART * math.sqrt(variance)
    return tuple(np.flatnonzero(change > least).tolist())


def _of_other_turns(result: Estimate) -> list[FloatArray]:
    """Unknowns near other summits of tracks with angles: whole turns more from frame to frame."""
    problem = result.problem
    starts = []
    marked = [(k, n) for k, (n, name) in enumerate(problem.names)
              if name == _SPIN and problem.films[n].angle is not None]  # fmt: skip
    for (k, n), turns in product(marked, (-2.0, 2.0)):
        x = result.x
        for _ in range(_MORE_TURNS):  # as long as they are near
            x = x.copy()
            x[k] += turns * half_turns(problem.films[n])
            within = problem.limits[0][k] <= x[k] <= problem.limits[1][k]
            if not (within and _near(result, x, [])):
                break
            starts.append(x)
    return starts


def _of_other_spins(result: Estimate) -> list[FloatArray]:
    """Unknowns near other summits of tracks without angles, by spins of which a path may be.

    All tracks without spin, at the ratio that all motions tend to, or mirrored.
    """
    problem = result.problem
    if _SPIN in problem.spec.fixed or all(problem.spinless):
        return []
    launches = problem.launches(result.x)
    numbers = problem.numbers_at(result.x)
    decel, delta, radius = problem.spec.scales(numbers)
    speed = np.hypot(launches[:, 2], launches[:, 3])
    limit = _LIMIT * speed / radius
    starts = []
    candidates = (
        (np.zeros(limit.size), _TILT), (np.copysign(limit, launches[:, 4]), delta),
        (-np.copysign(limit, launches[:, 4]), 0.0), (-launches[:, 4], delta),
    )  # fmt: skip
    slip = np.hypot(speed, radius * launches[:, 4]).sum()
    for spins, tilt in candidates:
        other = launches.copy()
        other[:, 4] = spins
        # what slows the puck is about J times the share of its speed in the slip
        slows = decel * np.hypot(speed, radius * spins).sum() / slip
        x = problem.unknowns({**numbers, **problem.spec.with_scales(slows, tilt)}, other)
        starts.append((problem, x))
    walked = multi_start(starts, _TO_OTHERS, allowance=RISE, kept=result.kept)
    return [x for x, cost in walked if 2.0 * cost < result.chi2 + 2.0 * RISE]


def mirrored(result: Estimate, certainty: Certainty) -> tuple[int, ...]:
    """Tracks without angles that the opposite spin fits as well.

    Where the tilt is free it hardly differs from its least there, to which it then falls.
    """
    problem, low, high = result.problem, *result.problem.limits
    tilts = [k for k, (_, name) in enumerate(problem.names) if name in ("delta", "height")]
    errors = np.sqrt(np.diag(certainty.covariance))
    alike = []
    for k, (n, name) in enumerate(problem.names):
        if name != _SPIN or problem.films[n].angle is not None:
            continue
        for least in (True, False) if tilts else (False,):
            x = result.x.copy()
            x[k] = -x[k]
            if not low[k] <= x[k] <= high[k]:
                continue
            if least:
                x[tilts] = low[tilts]
            if not _near(result, x, tilts if least else []):
                continue
            there, cost = minimise(problem, x, result.kept)
            opposite = there[k] * result.x[k] < 0.0
            apart = opposite and abs(there[k] - result.x[k]) > Z95 * errors[k]
            if apart and 2.0 * cost < result.chi2 + RISE:
                alike.append(n)
                break
    return tuple(alike)


def _near(result: Estimate, x: FloatArray, held: list[int]) -> bool:
    """Whether χ² may come near that of the estimate, by what is linear in the unknowns."""
    problem = result.problem
    few = compact(problem, *problem.residuals_and_jacobian(x), result.kept)
    q, _ = np.linalg.qr(np.delete(few.slopes, held, axis=1))
    left = few.rows - q @ (few.rows @ q)
    return float(left @ left) < result.chi2 + 2.0 * EXCLUDED


def _known(result: Estimate, certainty: Certainty) -> tuple[Mask, FloatArray]:
    """Which numbers of the puck, and whether its spin, a summit tells; how far off another is."""
    names = result.problem.names
    spec = np.array([track == -1 or name == _SPIN for track, name in names], bool)
    seen = spec & ~np.array(certainty.undetermined, bool)
    return seen, _APART * np.sqrt(np.diag(certainty.covariance))


def without_spin(
    result: Estimate, numbers: dict[str, Number]
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """A sentence on the friction if no puck spun, and what is open then.

    None where friction is told, or they did spin.  The commonest film shows a slide without marks:
    its friction hangs on the spin that nobody saw.
    """
    problem = result.problem
    spec = problem.spec
    scale = next((name for name in ("friction", "decel") if name in spec.free), "")
    if (
        not scale or numbers[scale].determined or _SPIN in spec.fixed or problem.impact_specs
        or all(problem.spinless) or problem.angled
    ):  # fmt: skip
        return (), ()
    low, high = spec.bounds.get(_SPIN, (0.0, 0.0))
    if not low <= 0.0 <= high:
        return (), ()
    try:
        still = initial_estimate(replace(problem, spec=spec.spinning(0.0), weights=()), refit=False)
    except InputError:  # too few frames
        return (), ()
    noise = result.problem.noise
    if chi2_under(still, noise) > chi2_under(result, noise) + RISE:
        return (), ()
    values = numbers_of(still, certainty_at(still, freedom(still)))[0]
    number = values[scale]
    if not number.determined:
        return (), ()
    return (
        f"{scale} = {number.value:.4g} +- {number.error:.2g}{number.unit_behind} if it did not "
        "spin: --fix "
        "launch_spin=0 (fixed={'launch_spin': 0}).",
    ), tuple(name for name, one in values.items() if not one.determined)


_JUDGED = 2.5  # degrees of freedom that tell the noise of a kind
_BIAS = 2.0  # times what a force, to first order, would have done
_HARDLY = 10.0  # times: what is hardly seen makes no error wider than that


class JudgedMotion(NamedTuple):
    """The motion that is taken, and what is known of it.

    ``seen``: its certainty before anything nobody would believe took it all.
    """

    best: Estimate
    certainty: Certainty
    seen: Certainty
    other_fits: tuple[OtherMinimum, ...]
    unsigned: tuple[int, ...]
    forces: SideForces
    nowhere: str
    astray: str


def judged_motion(best: Estimate, bounds: Collection[str]) -> JudgedMotion:
    """Which motion is taken of those that fit as well, and how far it is to be believed.

    ``bounds``: names that the caller bounds.
    """
    certainty = judged_certainty(best)
    refuse_wobbling(best, certainty)
    excess = max(excess_of(best), 1.0)
    other_fits = other_minima(best, certainty, excess)
    other = taken(best, other_fits, excess)
    if other is not None:
        best = replace(estimate(best.problem, other.estimate.x), minima=best.minima)
        certainty = judged_certainty(best)
        other_fits = other_minima(best, certainty, max(excess_of(best), 1.0))
    unsigned = mirrored(best, certainty)
    forces = side_forces(best, certainty)
    # bounds that the caller gives may keep every motion away: that is said of the bound
    held_off = any(best.problem.names[k][1] in bounds for k in np.flatnonzero(certainty.pinned))
    if held_off:  # no force
        forces = forces._replace(biases=np.empty((0, 0)))
    complained = bool(misfits(best, forces.chance))
    most = math.inf if complained else _HARDLY
    may = complained or may_misfit(best, forces.chance)
    certainty = _wider(best, certainty, may, most, forces, bool(unsigned))
    nowhere = "" if held_off else no_answer(best)
    astray = nowhere or ran_away(best.problem, best.x)
    return JudgedMotion(
        best, certainty.lost() if astray else certainty, certainty, other_fits, unsigned, forces,
        nowhere, astray,
    )  # fmt: skip


def judged_certainty(best: Estimate) -> Certainty:
    """How well the unknowns of an estimate are known."""
    degrees = freedom(best)
    if degrees < _JUDGED:
        raise InputError(
            f"{best.residuals.size} observations of {best.x.size} unknowns are too few to judge "
            f"the noise of each kind by: {GIVE_NOISE}"
        )
    certainty = certainty_at(best, degrees)
    return replace(certainty, pinned=pinned_of(best, certainty))


def _wider(
    best: Estimate, certainty: Certainty, may_misfit: bool, most: float, forces: SideForces,
    unsigned: bool,
) -> Certainty:  # fmt: skip
    """Certainty where residuals are no independent noise, or nothing tells a floor from a spin."""
    if may_misfit or any(certainty.pinned):
        forced = may_misfit and forces.biases.size
        biases = _BIAS * forces.biases if forced else np.zeros((best.x.size, 1))
        certainty = widened(best, certainty, biases, most)
    elif any(any(film.steps) for film in best.problem.films):
        certainty = of_rounded(best, certainty)
    if unsigned and forces.by_law.size:  # its slowing alone tells friction from spin
        by_law = np.outer(forces.by_law, forces.by_law)
        certainty = certainty.wider(certainty.covariance + by_law, False)
    return certainty


def ran_away(problem: Problem, x: FloatArray) -> str:
    """A sentence where a launch lies on the end of what the film leaves it; else none."""
    for (track, name), value, low, high in zip(problem.names, x, *problem.limits, strict=True):
        if name in problem.spec.bounds or name not in (*LAUNCH, *WALL) or low == -math.inf:
            continue
        if min(value - low, high - value) <= _AT_END * (high - low):
            kind = ALL.get(name) or WALL[name]
            of = f" of {problem.films[track].name}" if track >= 0 else ""
            return (
                f"Nothing is determined: the fit runs away, {kind.words}{of} to {value:.3g} "
                f"{kind.unit}, the end of what is looked for, as nobody would believe: the tracks "
                "look alike all the way, or another law moves this puck. What would tell: angle "
                f"marks on the puck, or bounds of {name}, or its value, if it is known"
            )
    return ""


_AT_END = 1e-3  # of the width of a range

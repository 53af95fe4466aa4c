"""``fit``: the puck and the launches under which tracks are most likely.

Inputs are checked, tracks become observations, these and a forward model a problem of least
squares; its estimate is judged, and what was found is reported.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import NamedTuple

from puck_tables._core.arrays import instance
from puck_tables._core.waiting import Progress
from puck_tables.film.film import Track
from puck_tables.fitting.checked_spec import spec_of, variants_of, with_law
from puck_tables.fitting.coupled_fit import Impact, couple, impacts_apart, impacts_coupled, not_met
from puck_tables.fitting.estimate import Estimate, chi2_under, estimate
from puck_tables.fitting.fit_result import Fit
from puck_tables.fitting.fit_spec import DRAGS
from puck_tables.fitting.forecast import HeldOut, predicted, split
from puck_tables.fitting.impact_matching import Line, SlideIndex, slides_apart
from puck_tables.fitting.initial_estimate import begins_off, initial_estimate
from puck_tables.fitting.inputs import (
    Inputs,
    begin_jitter,
    checked_rows,
    checked_walls,
    observations_of,
    refuse_opening,
    refuse_tipping,
    refuse_unfit,
)
from puck_tables.fitting.law_scores import LawScore, compare
from puck_tables.fitting.misfit import misfit
from puck_tables.fitting.numbers import numbers_of
from puck_tables.fitting.observations import Observations, noise_of
from puck_tables.fitting.other_minima import (
    JudgedMotion,
    judged_certainty,
    judged_motion,
    without_spin,
)
from puck_tables.fitting.problem import Problem
from puck_tables.fitting.remarks import not_identifiable
from puck_tables.fitting.residuals import NO_PATTERN, NOISY, drift, is_clean, runs
from puck_tables.fitting.slowing import over_speeds
from puck_tables.kernels.patience import compiled_at_once
from puck_tables.puck import Puck

_GUESS = 1e-3  # of the track: noise to begin with where differences tell none
_MUCH = 0.1  # of the frames, left out at the ends


@compiled_at_once()
def fit(
    tracks: Track | Sequence[Track], puck: Puck, *, free: Iterable[str] | None = None,
    fixed: Mapping[str, float] | None = None,
    prior: Mapping[str, tuple[float, float]] | None = None,
    bounds: Mapping[str, tuple[float, float]] | None = None,
    start: Mapping[str, float] | None = None,
    noise: tuple[float | None, float | None] | None = None, since: float = -math.inf,
    until: float = math.inf, keep_all: bool = False, jitter: float | str | None = None,
    rows: tuple[float, float] | None = None, impacts: bool = False, walls: Sequence[Line] = (),
    slip_speeds: Sequence[float] | None = None, between: str = "cubic", law: str | None = None,
    laws: Sequence[str] = (), hold_out: float | Sequence[str] | None = None,
    progress: Progress | None = None,
) -> Fit:  # fmt: skip
    """Find a puck and its launches from tracks of it.

    Parameters
    ----------
    tracks : Track, or several of one puck
        Of free motion: slid, not rolled or pushed, until it rests or the film ends.  Frames at
        either end before or after something touches the puck are left out, if they are the smaller
        part: velocity or acceleration jump there, or it gets faster.
    puck : Puck
        What is known of it: its radius, and whatever ``free`` does not name.  On a base that is
        not round the angles of the tracks are those of its x axis; f and the height are then found
        (δ = 2fh/r with its reach for r, the gyration in m), without drags, laws and impacts, and
        the spin is taken as less than half a turn a frame.
    free : names, optional
        What is found besides the launches: friction or decel (f g), delta or height
        (δ = 2fh/r), radius, gravity, gyration (over r), inner (of an annulus), drag (1/s, of speed
        and spin alike: for a flat uniform puck f(u) = f + (drag/g) u of the slip speed u), air
        (1/m, of the speed squared: drag.quadratic of a scene over the mass), spin_drag (1/s),
        slope_x and slope_y (pull over g), belt_x and belt_y (m/s, of the floor), mark_x and mark_y
        (m: where what is tracked lies off the centre of mass, in the axes of the body).
        Without it friction, and delta where the puck has no height.
    fixed : values by name, held; also launch_spin and the like
    prior : (value, standard deviation) by name
    bounds : (low, high) by name
    start : values to begin with, by name, optional
    noise : (m, rad), standard deviations of places and angles
        None for either: that of the residuals.
    since, until : s, of the free motion, as the tracks count time
        No frame is left out at an end that is given.
    keep_all : whether all frames are of free motion: none is left out at the ends
    jitter : s, standard deviation of time stamps; 'find': that of the residuals along the motion
    rows : y in m of the first and of the last line of the picture, of a rolling shutter
        Frames are then later by ``readout`` (s, a number that is found) times how far down they
        show the puck.
    impacts : whether tracks may hold impacts, with walls or of two pucks
        They are found, and join the slides: restitution and rim_friction of walls are found too,
        pair_restitution and pair_friction of two pucks (and mass_ratio, if it is named in free).
        Where rims stop on what they meet, tangential restitution takes the place of friction.
    walls : lines ((x, y), (x, y)) in m, two points of each, where walls are known
        Others are found.  With walls impacts are looked for, whatever ``impacts`` says.
    slip_speeds : m/s, from 0 to the fastest slip, 2 to 8 of them
        The friction coefficient is found at each (friction_0, friction_1, …); of two it is f₀ + f₁u
        with u the slip speed.  It is one number where they are left out.
    between : cubic or linear, f between these speeds
        As :class:`SpeedLaw` takes it: a cubic that rises and falls only where f at the speeds does.
    law : 'stribeck', 'hyperbola' or 'two-valued', of friction over slip speed by three numbers
        friction (of fast slip), friction_rest and law_speed (m/s): :mod:`.speed_motion`.
    laws : names of pressure laws to compare, as :class:`Puck` takes them; with +drag, +air, +slope,
        +belt, +stribeck, +hyperbola or +two-valued what is then found, too; 'floors': all of these
        of uniform pressure, and :attr:`Fit.verdict` says which the film supports
    hold_out : share of the moving frames at the end of each track, or names of tracks
        Fitted without them (of a track named: without its later half), and predicted.
    progress : callable (done, total), optional

    Raises
    ------
    InputError
        If a name is not known, an argument is out of range, two clash, or there are fewer
        observations than unknowns.

    Notes
    -----
    Least squares of places and angles, weighted by their noise, with observations beyond four
    standard deviations left out, or farther where few of them tell the noise.  Errors are those of
    the Fisher matrix, intervals of the puck's numbers by profile likelihood where that differs by
    more than 2 %.  The cost of a track of 250 frames is some 0.1 s.

    What it calls is compiled at once, so that the first fit has the bits of the next.  On another
    kind of processor sums round otherwise: numbers that are determined then differ by up to some
    1e-5 of their errors, most of them by 1e-11.

    References
    ----------
    Salnikova, Treschev, Gallyamov 2012, sections 2 and 6: the motion; Levenberg 1944, Marquardt
    1963: the steps.

    Examples
    --------
    >>> import numpy as np
    >>> puck = Puck(radius=0.0381, height=0.0254, friction=0.15)
    >>> t = np.arange(120) / 60.0
    >>> path = puck.states((2.0, 0.5), 40.0, t)
    >>> noise = np.random.default_rng(1).normal(0.0, 3e-4, (120, 2))
    >>> track = Track(t, np.stack([path.x, path.y], axis=1) + noise, path.orientation, "film")
    >>> result = fit(track, Puck(radius=0.0381))
    >>> round(result["friction"].value, 3), round(result["height"].value, 3)
    (0.15, 0.025)
    """
    instance("puck", puck, Puck)
    lines = checked_walls(walls)
    spec = spec_of(
        puck, free, fixed or {}, prior or {}, bounds or {}, start or {}, impacts or bool(lines),
        rows is not None,
    )  # fmt: skip
    if law is not None:
        spec = with_law(spec, law)
    inputs = Inputs.of(spec, noise, jitter, slip_speeds, between, impacts, lines, hold_out)
    films = observations_of(tracks, since, until, keep_all, checked_rows(rows), puck.radius)
    refuse_unfit(spec, films, laws)
    observed = _observe(films, inputs)
    variants = variants_of(spec.alone(), laws)
    steps = 1 + len(variants) + (inputs.hold_out is not None)
    say = progress or (lambda done, total: None)
    estimates = _estimate_all(inputs, observed)
    say(1, steps)
    judged = judged_motion(estimates.best, inputs.spec.bounds)
    scores: tuple[LawScore, ...] = ()
    if variants:
        same = replace(observed.problem, jitter=estimates.slides.problem.jitter)
        scores = compare(same, variants)
        say(1 + len(variants), steps)
    held_out = None
    if inputs.hold_out is not None:  # the later part of tracks, predicted from the rest
        best = judged.best.problem
        earlier, later = split(best.films, inputs.hold_out, best.noise[0])
        fewer = best.with_films(earlier)
        followed = best.impact_specs or best.spec.speeds or best.spec.integrated
        part = estimate(fewer, judged.best.x) if followed else initial_estimate(fewer, refit=False)
        held_out = predicted(part, judged_certainty(part), best.films, later)
        say(steps, steps)
    return _reported(inputs, observed, estimates, judged, scores, held_out)


class _Observed(NamedTuple):
    """The observations: ``uncut`` tracks, the ``pieces`` of them between impacts in ``problem``."""

    uncut: tuple[Observations, ...]
    pieces: tuple[SlideIndex, ...]
    problem: Problem


class _Estimates(NamedTuple):
    """The estimate of ``slides`` with launches of their own, and that of all that was asked for.

    ``constant``: of one friction for all slip speeds; ``untied``: why slides are not joined.
    """

    slides: Estimate
    best: Estimate
    constant: Estimate
    untied: str


def _observe(films: tuple[Observations, ...], inputs: Inputs) -> _Observed:
    """What is fitted of the tracks, in the slides between impacts if these are looked for."""
    smooth = noise_of(list(films))
    size = max(film.size for film in films)
    guesses = (one if math.isfinite(one) else _GUESS * size for one in smooth)
    begin = [
        max(guess, 1e-9 * (size or 1.0)) if value is None else value
        for value, guess in zip(inputs.noise, guesses, strict=True)
    ]
    refuse_tipping(inputs.spec, films, begin[0])
    parts = films
    pieces: tuple[SlideIndex, ...] = ()
    rests: tuple[bool, ...] = ()
    if inputs.impacts:
        parts, pieces, rests = slides_apart(films, begin[0])
    jitter = begin_jitter(parts, begin[0]) if inputs.jitter is None else inputs.jitter
    if inputs.hold_out is not None:
        split(parts, inputs.hold_out, begin[0])
    problem = Problem(
        inputs.spec.alone(), parts, (begin[0], begin[1]), rests=rests, jitter=jitter,
        known=inputs.known, smooth=smooth,
    )  # fmt: skip
    return _Observed(films, pieces, problem)


def _estimate_all(inputs: Inputs, observed: _Observed) -> _Estimates:
    """The estimate, from slides apart to joined ones, from one friction to one over slip speed."""
    problem = observed.problem
    # what one friction leaves off at the ends need not be foreign where another is looked for
    late = bool(inputs.speeds) and not inputs.impacts
    drags = {*DRAGS} >= {*inputs.spec.integrated}  # a law may look like a touch
    best = slides = initial_estimate(problem, refit=drags and not late)
    if inputs.spec.integrated:
        refuse_opening(best)
    untied = ""
    if inputs.impacts:
        best, untied = couple(slides, observed.pieces, observed.uncut, inputs.spec, inputs.lines)
    constant = best
    if inputs.speeds:
        over = partial(over_speeds, speeds=inputs.speeds, between=inputs.between)
        best = over(constant)
        if late and not is_clean(best, NOISY, NO_PATTERN):
            slides = initial_estimate(problem, refit=True)
            if slides.problem.films != constant.problem.films:
                constant, best = slides, over(slides)
        refuse_opening(best)
    return _Estimates(slides, best, constant, untied)


def _reported(
    inputs: Inputs, observed: _Observed, estimates: _Estimates, judged: JudgedMotion,
    laws: tuple[LawScore, ...], held_out: HeldOut | None,
) -> Fit:  # fmt: skip
    """What was found, with what is to be said of it."""
    best, certainty = judged.best, judged.certainty
    numbers, launches = numbers_of(best, certainty, judged.other_fits, judged.unsigned)
    blind, open_then = ((), ()) if judged.nowhere else without_spin(best, numbers)
    numbers |= {name: numbers[name]._replace(error=math.inf) for name in open_then}
    lost = tuple(n for n in best.problem.spec.free if not numbers[n].determined)
    blind += (
        (f"{judged.astray}.",)
        if judged.astray
        else not_identifiable(best, judged.seen, lost, judged.other_fits, judged.unsigned)
    )
    impacts: tuple[Impact, ...] = ()
    if best.problem.impact_specs:
        impacts = impacts_coupled(best, certainty, numbers)
    elif inputs.impacts:
        impacts = impacts_apart(
            best, observed.pieces, certainty, [film.name for film in observed.uncut]
        )
    named = {film.name: film.frame for film in (*observed.uncut, *observed.problem.films)}
    left_out = tuple(  # how many frames at the start and the end of each are no free motion
        (film.name, int((named[film.name] < film.frame[0]).sum()),
         int((named[film.name] > film.frame[-1]).sum())) for film in best.problem.films
    )  # fmt: skip
    constant = chi2_under(estimates.constant, best.problem.noise) if inputs.speeds else math.nan
    result = Fit(
        given=inputs.spec.puck, numbers=numbers, launches=launches, chi2=best.chi2,
        degrees=best.degrees, noise=best.problem.noise, jitter=best.problem.jitter,
        noise_known=inputs.known, outliers=best.outliers, runs=runs(best), drift=drift(best),
        left_out=left_out,
        cut_off=_trimmed_ends(estimates.slides, observed.problem, left_out), blind=blind,
        astray=judged.astray, laws=laws, held_out=held_out, impacts=impacts,
        untied=estimates.untied, constant_chi2=constant, estimate=best, certainty=certainty,
        not_met=not_met(impacts, best.problem, inputs.lines) if inputs.impacts else (),
        forces=judged.forces, uncut=observed.uncut,
    )  # fmt: skip
    if result.complaints:
        said = misfit(estimates.slides, observed.problem, judged.forces, bool(inputs.speeds))
        result = replace(result, misfit=said)
    return result


def _trimmed_ends(
    best: Estimate, problem: Problem, left_out: tuple[tuple[str, int, int], ...]
) -> str:
    """A sentence where many frames are left out at the ends, and what they would change.

    Or where first ones that are off are not.
    """
    said = [
        f"{first} frames at the start and {last} at the end of {name}"
        for (name, first, last), film in zip(left_out, best.problem.films, strict=False)
        if first + last > _MUCH * (first + last + film.time.size)
    ]
    if not said:
        return begins_off(best)
    films = tuple(replace(film, cuttable=(False, False)) for film in problem.films)
    kept = initial_estimate(problem.with_films(films), refit=True)
    values = kept.problem.numbers_at(kept.x)
    numbers = ", ".join(f"{name} {value:.4g}" for name, value in values.items())
    more = kept.problem.noise[0] * kept.size / (best.problem.noise[0] * best.size or 1.0)
    return (
        f"{' and '.join(said)} are left out: something seems to touch the puck there. With all "
        f"frames (--keep-all, keep_all=True) it would be {numbers or 'as known'}, residuals "
        f"{more:.3g} times as large"
    )

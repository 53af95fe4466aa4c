"""``fit``: the puck and the launches under which tracks are most likely."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from puck_tables._core.real import instance, real
from puck_tables.errors import InputError
from puck_tables.film.puck_track import Track
from puck_tables.fitting.certainty import (
    Certainty,
    certainty_of,
    of_rounded,
    pinned_of,
    widened,
)
from puck_tables.fitting.coupled_fit import Impact, couple, impacts_apart, impacts_coupled, not_met
from puck_tables.fitting.estimate import Estimate, estimate, freedom
from puck_tables.fitting.fit_result import Fit
from puck_tables.fitting.fit_spec import FitSpec
from puck_tables.fitting.identifiability import not_identifiable, ran_away
from puck_tables.fitting.impact_matching import Line
from puck_tables.fitting.initial_estimate import initial_estimate
from puck_tables.fitting.inputs import (
    begin_noise,
    checked_jitter,
    checked_noise,
    checked_rows,
    checked_speeds,
    checked_walls,
    observations_of,
    refuse_faster,
    refuse_opening,
    refuse_tipping,
    refuse_wobbling,
)
from puck_tables.fitting.misfit import misfit
from puck_tables.fitting.model_comparison import (
    HeldOut,
    LawScore,
    chi2_under,
    compare,
    over_speeds,
    predicted,
    split,
    variants_of,
)
from puck_tables.fitting.numbers import numbers_of, plausible_for
from puck_tables.fitting.observations import Observations, noise_of
from puck_tables.fitting.other_minima import mirrored, other_minima, taken, without_spin
from puck_tables.fitting.problem import Known, Problem
from puck_tables.fitting.residuals import (
    SideForces,
    drift,
    excess_of,
    may_misfit,
    no_answer,
    runs,
    side_forces,
)
from puck_tables.fitting.touches import SlideIndex, slides_apart
from puck_tables.puck import Puck

Progress = Callable[[int, int], None]
_JUDGED = 2.5  # degrees of freedom that tell the noise of a kind
_MUCH = 0.1  # of the frames, left out at the ends
_BIAS = 2.0  # times what a force, to first order, would have done
_JITTER = 0.3  # times the noise of a place over the speed: to begin with


def fit(
    tracks: Track | Sequence[Track],
    puck: Puck,
    *,
    free: Iterable[str] | None = None,
    fixed: Mapping[str, float] | None = None,
    prior: Mapping[str, tuple[float, float]] | None = None,
    bounds: Mapping[str, tuple[float, float]] | None = None,
    start: Mapping[str, float] | None = None,
    noise: tuple[float | None, float | None] | None = None,
    since: float = -math.inf,
    until: float = math.inf,
    keep_all: bool = False,
    jitter: float | str | None = None,
    rows: tuple[float, float] | None = None,
    impacts: bool = False,
    walls: Sequence[Line] = (),
    slip_speeds: Sequence[float] | None = None,
    between: str = "cubic",
    laws: Sequence[str] = (),
    hold_out: float | Sequence[str] | None = None,
    progress: Progress | None = None,
) -> Fit:
    """Find a puck and its launches from tracks of it.

    Parameters
    ----------
    tracks : Track, or several of one puck
        Of free motion: slid, not rolled or pushed, until it rests or the film ends.  Frames at
        either end before or after something touches the puck are left out, if they are the smaller
        part: velocity or acceleration jump there, or it gets faster.
    puck : Puck
        What is known of it: its radius, and whatever ``free`` does not name.
    free : names, optional
        What is found besides the launches: friction or decel (J = f g), delta or height
        (δ = 2fh/r), radius, gravity, gyration, inner (radius of an annulus), drag (1/s, of speed
        and spin alike: for a flat uniform puck f(u) = f + (drag/g) u of the slip speed u).
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
    laws : names of pressure laws to compare, as :class:`Puck` takes them; with '+drag' of those
        with drag
    hold_out : share of the moving frames at the end of each track, or names of tracks
        Fitted without them (of a track named: without its later half), and predicted.
    progress : callable (done, total), optional

    Returns
    -------
    Fit

    Raises
    ------
    InputError
        If a name is not known, an argument is out of range, two clash, or there are fewer
        observations than unknowns.

    Notes
    -----
    Least squares of places and angles, weighted by their noise, with observations beyond four
    standard deviations left out.  Errors are those of the Fisher matrix, intervals of the puck's
    numbers by profile likelihood where that differs by more than 2 %.  The cost of a track of 250
    frames is some 0.1 s.

    References
    ----------
    Salnikova, Treschev, Gallyamov 2012, sections 2 and 6: the motion; scipy's ``least_squares``:
    the optimiser.

    Examples
    --------
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
    films = observations_of(tracks, since, until, keep_all, checked_rows(rows), puck.radius)
    lines = checked_walls(walls)
    impacts = impacts or bool(lines)
    spec = FitSpec.of(
        puck, free, fixed or {}, prior or {}, bounds or {}, start or {}, impacts, rows is not None
    )
    given, known_noise = checked_noise(noise)
    stamps = checked_jitter(jitter)
    speeds = checked_speeds(slip_speeds, between)
    if speeds:
        spec.over(speeds, between)
    known = Known(*known_noise, stamps is not None)
    judged = noise_of(list(films))
    begin = tuple(
        value if value is not None else begin_noise(one, films)
        for value, one in zip(given, judged, strict=True)
    )
    refuse_tipping(spec, films, begin[0])
    questions = variants_of(spec.alone(), laws)
    uncut = films
    pieces: tuple[SlideIndex, ...] = ()
    rests: tuple[bool, ...] = ()
    if impacts:
        films, pieces, rests = slides_apart(films, begin[0])
    problem = Problem(spec.alone(), films, (begin[0], begin[1]), rests=rests)
    problem = replace(problem, jitter=_begin_jitter(problem, begin[0], stamps))
    held = None if hold_out is None else _held(hold_out)
    if held is not None:
        split(films, held, begin[0])
    steps = 1 + len(laws) + (hold_out is not None)
    say = progress or (lambda done, total: None)
    best = slides = initial_estimate(problem, known, refit=True)
    untied = ""
    if impacts:
        best, untied = couple(slides, pieces, uncut, spec, lines, known)
    constant = best
    if speeds:
        refuse_faster(speeds, best)
        best = over_speeds(best, speeds, between, known)
        refuse_opening(best)
    say(1, steps)
    certainty = _certainty(best, known)
    refuse_wobbling(best, certainty)
    excess = max(excess_of(best, judged), 1.0)
    other_fits = other_minima(best, certainty, excess)
    other = taken(best, other_fits, excess)
    if other is not None:
        best = replace(estimate(best.problem, other.estimate.x, known), minima=best.minima)
        certainty = _certainty(best, known)
        other_fits = other_minima(best, certainty, max(excess_of(best, judged), 1.0))
    unsigned = mirrored(best, certainty)
    forces = side_forces(best, certainty)
    # bounds that the caller gives may keep every motion away: that is said of the bound
    held_off = any(
        best.problem.names[k][1] in spec.bounds for k in np.flatnonzero(certainty.pinned)
    )
    if held_off:  # no force
        forces = forces._replace(biases=np.empty((0, 0)))
    misfits = may_misfit(best, known, judged, forces.chance)
    certainty = _wider(best, certainty, misfits, forces, bool(unsigned))
    nowhere = "" if held_off else no_answer(best, known, judged)
    astray = nowhere or ran_away(best.problem, best.x)
    seen, certainty = certainty, certainty.lost() if astray else certainty
    numbers, launches = numbers_of(best, certainty, other_fits, unsigned)
    blind, open_then = ((), ()) if nowhere else without_spin(best, numbers, known)
    numbers |= {name: numbers[name]._replace(error=math.inf) for name in open_then}
    lost = tuple(n for n in best.problem.spec.free if not numbers[n].determined)
    scores: tuple[LawScore, ...] = ()
    if laws:

        def of_law(one: FitSpec, noise: tuple[float, float], fixed_noise: Known) -> Estimate:
            # frames that another law leaves out at the ends may be those that tell
            same = replace(problem, spec=one, noise=noise, jitter=slides.problem.jitter)
            return initial_estimate(same, fixed_noise._replace(jitter=True), refit=False)

        scores = compare(questions, (begin[0], begin[1]), known, of_law)
        say(1 + len(laws), steps)
    predictions = None
    if held is not None:
        predictions = _held_out(best, held, known)
        say(steps, steps)
    blind += (f"{astray}.",) if astray else not_identifiable(best, seen, lost, other_fits, unsigned)
    impact_states: tuple[Impact, ...] = ()
    if best.problem.impact_specs:
        impact_states = impacts_coupled(best, certainty, numbers)
    elif impacts:
        names = [film.name for film in uncut]
        impact_states = impacts_apart(best, pieces, certainty, names)
    left_out = _left_out((*films, *uncut), best.problem.films)
    result = Fit(
        given=puck,
        numbers=numbers,
        launches=launches,
        chi2=best.chi2,
        degrees=best.degrees,
        noise=best.problem.noise,
        jitter=best.problem.jitter,
        noise_known=known,
        smooth_noise=judged,
        outliers=best.outliers,
        runs=runs(best),
        drift=drift(best),
        left_out=left_out,
        cut_off=_trimmed_ends(slides, problem, known, left_out),
        blind=blind,
        astray=astray,
        laws=scores,
        held_out=predictions,
        impacts=impact_states,
        untied=untied,
        not_met=not_met(impact_states, best.problem, lines) if impacts else (),
        constant_chi2=chi2_under(constant, best.problem.noise) if speeds else math.nan,
        estimate=best,
        certainty=certainty,
        forces=forces,
        uncut=uncut,
    )
    if result.complaints:
        result = replace(result, misfit=misfit(slides, problem, known, forces, bool(speeds)))
    return result


def _begin_jitter(problem: Problem, noise: float, stamps: float | None) -> float:
    """The jitter as given, or a value to begin with, s."""
    if stamps is not None:
        return stamps
    lengths = [np.hypot(*np.diff(film.place, axis=0).T).sum() for film in problem.films]
    speed = float(sum(lengths)) / sum(float(film.time[-1]) for film in problem.films)
    return _JITTER * noise / max(speed, 1e-9)


def _certainty(best: Estimate, known: Known) -> Certainty:
    """How well the unknowns of an estimate are known."""
    degrees = freedom(best, known)
    if degrees < _JUDGED:
        raise InputError(
            f"{best.residuals.size} observations of {best.x.size} unknowns are too few to judge "
            "the noise of each kind by: give the noise, or more frames"
        )
    plausible = plausible_for(best.problem, best.x)
    certainty = certainty_of(best.jacobian[best.kept], plausible, degrees)
    return replace(certainty, pinned=pinned_of(best, certainty))


def _wider(
    best: Estimate, certainty: Certainty, misfits: bool, forces: SideForces, unsigned: bool
) -> Certainty:
    """The same where residuals are no independent noise, or nothing tells a floor from a spin."""
    if misfits or any(certainty.pinned):
        certainty = widened(best, certainty)
        if misfits and forces.biases.size:
            by_force = _BIAS**2 * forces.biases @ forces.biases.T
            certainty = certainty.wider(certainty.covariance + by_force, True)
    elif any(any(film.steps) for film in best.problem.films):
        certainty = of_rounded(best, certainty)
    if unsigned and forces.by_law.size:  # its slowing alone tells friction from spin
        by_law = np.outer(forces.by_law, forces.by_law)
        certainty = certainty.wider(certainty.covariance + by_law, False)
    return certainty


def _left_out(
    before: tuple[Observations, ...], after: tuple[Observations, ...]
) -> tuple[tuple[str, int, int], ...]:
    """How many frames at the start and the end of each track are no free motion."""
    named = {film.name: film for film in reversed(before)}
    return tuple(
        (
            left.name, int((named[left.name].frame < left.frame[0]).sum()),
            int((named[left.name].frame > left.frame[-1]).sum()),
        )
        for left in after
    )  # fmt: skip


def _trimmed_ends(
    best: Estimate, problem: Problem, known: Known, left_out: tuple[tuple[str, int, int], ...]
) -> str:
    """A sentence where many frames are left out at the ends, and what they would change."""
    said = [
        f"{first} frames at the start and {last} at the end of {name}"
        for (name, first, last), film in zip(left_out, best.problem.films, strict=False)
        if first + last > _MUCH * (first + last + film.time.size)
    ]
    if not said:
        return ""
    films = tuple(replace(film, cuttable=(False, False)) for film in problem.films)
    kept = initial_estimate(problem.with_films(films), known, refit=True)
    numbers = ", ".join(
        f"{name} {value:.4g}" for name, value in kept.problem.numbers_at(kept.x).items()
    )  # fmt: skip
    more = kept.problem.noise[0] * math.sqrt(kept.chi2 / max(kept.degrees, 1))
    more /= best.problem.noise[0] * math.sqrt(best.chi2 / max(best.degrees, 1)) or 1.0
    return (
        f"{' and '.join(said)} are left out: something seems to touch the puck there. With all "
        f"frames (--keep-all, keep_all=True) it would be {numbers or 'as known'}, residuals "
        f"{more:.3g} times as large"
    )


def _held(hold_out: Any) -> float | tuple[str, ...]:
    """A share of the frames, or names of tracks."""
    names: Any = (hold_out,) if isinstance(hold_out, str) else hold_out
    return tuple(names) if isinstance(names, list | tuple) else real("hold_out", names, "1")


def _held_out(best: Estimate, wanted: float | tuple[str, ...], known: Known) -> HeldOut:
    """The later part of tracks, predicted from the rest."""
    problem = best.problem
    films, later = split(problem.films, wanted, problem.noise[0])
    fewer = problem.with_films(films)
    if problem.impact_specs or problem.spec.speeds:
        part = estimate(fewer, best.x, known)
    else:
        part = initial_estimate(fewer, known, refit=False)
    return predicted(part, _certainty(part, known), problem.films, later)

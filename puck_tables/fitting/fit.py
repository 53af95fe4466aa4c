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
from puck_tables.fitting.asked import Asked
from puck_tables.fitting.blindness import blind_spots
from puck_tables.fitting.by_speed import over_speeds
from puck_tables.fitting.certainty import (
    Certainty,
    certainty_of,
    pinned_of,
    widened,
)
from puck_tables.fitting.doubts import ran_away
from puck_tables.fitting.estimate import Estimate, estimate, freedom
from puck_tables.fitting.fitted import fitted
from puck_tables.fitting.given import (
    begin_noise,
    films_of,
    jitter_given,
    noise_given,
    refuse_faster,
    refuse_opening,
    refuse_tipping,
    refuse_wobbling,
    rows_given,
    speeds_given,
    walls_given,
)
from puck_tables.fitting.held_out import HeldOut, predicted, split
from puck_tables.fitting.impacts import Piece, cut
from puck_tables.fitting.joining import Line
from puck_tables.fitting.laws import LawScore, chi2_under, compare, variants_of
from puck_tables.fitting.misread import misread
from puck_tables.fitting.numbers import numbers_of, plausible_for
from puck_tables.fitting.outcome import Fit
from puck_tables.fitting.problem import Problem
from puck_tables.fitting.residual_tests import drift, excess_of, may_misfit, no_answer, runs
from puck_tables.fitting.rivals import mirrored, rivals_of, taken
from puck_tables.fitting.seen import Seen, noise_of
from puck_tables.fitting.tied import Impact, impacts_apart, impacts_joined, not_met, tie
from puck_tables.fitting.timing import Known
from puck_tables.fitting.unspun import without_spin
from puck_tables.puck import Puck

Progress = Callable[[int, int], None]
_JUDGED = 2.5  # degrees of freedom that tell the noise of a kind
_MUCH = 0.1  # of the frames, left out at the ends
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
    >>> found = fit(track, Puck(radius=0.0381))
    >>> round(found["friction"].value, 3), round(found["height"].value, 3)
    (0.15, 0.025)
    """
    instance("puck", puck, Puck)
    films = films_of(tracks, since, until, keep_all, rows_given(rows), puck.radius)
    lines = walls_given(walls)
    impacts = impacts or bool(lines)
    asked = Asked.of(
        puck, free, fixed or {}, prior or {}, bounds or {}, start or {}, impacts, rows is not None
    )
    given, known_noise = noise_given(noise)
    stamps = jitter_given(jitter)
    speeds = speeds_given(slip_speeds, between)
    if speeds:
        asked.over(speeds, between)
    known = Known(*known_noise, stamps is not None)
    judged = noise_of(list(films))
    begin = tuple(
        value if value is not None else begin_noise(one, films)
        for value, one in zip(given, judged, strict=True)
    )
    refuse_tipping(asked, films, begin[0])
    questions = variants_of(asked.alone(), laws)
    uncut = films
    pieces: tuple[Piece, ...] = ()
    rests: tuple[bool, ...] = ()
    if impacts:
        films, pieces, rests = cut(films, begin[0])
    problem = Problem(asked.alone(), films, (begin[0], begin[1]), rests=rests)
    problem = replace(problem, jitter=_begin_jitter(problem, begin[0], stamps))
    held = None if hold_out is None else _held(hold_out)
    if held is not None:
        split(films, held, begin[0])
    steps = 1 + len(laws) + (hold_out is not None)
    say = progress or (lambda done, total: None)
    found = slides = fitted(problem, known, refit=True)
    untied = ""
    if impacts:
        found, untied = tie(slides, pieces, uncut, asked, lines, known)
    constant = found
    if speeds:
        refuse_faster(speeds, found)
        found = over_speeds(found, speeds, between, known)
        refuse_opening(found)
    say(1, steps)
    certainty = _certainty(found, known)
    refuse_wobbling(found, certainty)
    excess = max(excess_of(found, judged), 1.0)
    rivals = rivals_of(found, certainty, excess)
    other = taken(found, rivals, excess)
    if other is not None:
        found = replace(estimate(found.problem, other.estimate.x, known), minima=found.minima)
        certainty = _certainty(found, known)
        rivals = rivals_of(found, certainty, max(excess_of(found, judged), 1.0))
    unsigned = mirrored(found, certainty)
    if any(certainty.pinned) or may_misfit(found, known, judged):
        certainty = widened(found, certainty)
    # bounds that the caller gives may keep every motion away: that is said of the bound
    held_off = any(
        found.problem.names[k][1] in asked.bounds for k in np.flatnonzero(certainty.pinned)
    )
    nowhere = "" if held_off else no_answer(found, known, judged)
    astray = nowhere or ran_away(found.problem, found.x)
    seen, certainty = certainty, certainty.lost() if astray else certainty
    numbers, launches = numbers_of(found, certainty, rivals, unsigned)
    lost = tuple(n for n in found.problem.asked.free if not numbers[n].determined)
    scores: tuple[LawScore, ...] = ()
    if laws:

        def of_law(one: Asked, noise: tuple[float, float], fixed_noise: Known) -> Estimate:
            # frames that another law leaves out at the ends may be those that tell
            same = replace(problem, asked=one, noise=noise, jitter=slides.problem.jitter)
            return fitted(same, fixed_noise._replace(jitter=True), refit=False)

        scores = compare(questions, (begin[0], begin[1]), known, of_law)
        say(1 + len(laws), steps)
    predictions = None
    if held is not None:
        predictions = _held_out(found, held, known)
        say(steps, steps)
    blind = () if nowhere else without_spin(found, numbers, known)
    blind += (f"{astray}.",) if astray else blind_spots(found, seen, lost, rivals, unsigned)
    hits: tuple[Impact, ...] = ()
    if found.problem.meetings:
        hits = impacts_joined(found, certainty, numbers)
    elif impacts:
        names = [film.name for film in uncut]
        hits = impacts_apart(found, pieces, certainty, names)
    left_out = _left_out((*films, *uncut), found.problem.films)
    result = Fit(
        given=puck,
        numbers=numbers,
        launches=launches,
        chi2=found.chi2,
        degrees=found.degrees,
        noise=found.problem.noise,
        jitter=found.problem.jitter,
        noise_known=known,
        smooth_noise=judged,
        outliers=found.outliers,
        runs=runs(found),
        drift=drift(found),
        left_out=left_out,
        cut_off=_cut_off(slides, problem, known, left_out),
        blind=blind,
        astray=astray,
        laws=scores,
        held_out=predictions,
        impacts=hits,
        untied=untied,
        not_met=not_met(hits, found.problem, lines) if impacts else (),
        constant_chi2=chi2_under(constant, found.problem.noise) if speeds else math.nan,
        estimate=found,
        certainty=certainty,
        uncut=uncut,
    )
    if result.complaints:
        result = replace(result, misread=misread(slides, problem, known, bool(speeds)))
    return result


def _begin_jitter(problem: Problem, noise: float, stamps: float | None) -> float:
    """The jitter as given, or a value to begin with, s."""
    if stamps is not None:
        return stamps
    lengths = [np.hypot(*np.diff(film.place, axis=0).T).sum() for film in problem.films]
    speed = float(sum(lengths)) / sum(float(film.time[-1]) for film in problem.films)
    return _JITTER * noise / max(speed, 1e-9)


def _certainty(found: Estimate, known: Known) -> Certainty:
    """How well the unknowns of an estimate are known."""
    degrees = freedom(found, known)
    if degrees < _JUDGED:
        raise InputError(
            f"{found.residuals.size} observations of {found.x.size} unknowns are too few to judge "
            "the noise of each kind by: give the noise, or more frames"
        )
    plausible = plausible_for(found.problem, found.x)
    certainty = certainty_of(found.jacobian[found.kept], plausible, degrees)
    return replace(certainty, pinned=pinned_of(found, certainty))


def _left_out(
    before: tuple[Seen, ...], after: tuple[Seen, ...]
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


def _cut_off(
    found: Estimate, problem: Problem, known: Known, left_out: tuple[tuple[str, int, int], ...]
) -> str:
    """A sentence where many frames are left out at the ends, and what they would change."""
    said = [
        f"{first} frames at the start and {last} at the end of {name}"
        for (name, first, last), film in zip(left_out, found.problem.films, strict=False)
        if first + last > _MUCH * (first + last + film.time.size)
    ]
    if not said:
        return ""
    films = tuple(replace(film, cuttable=(False, False)) for film in problem.films)
    kept = fitted(problem.with_films(films), known, refit=True)
    numbers = ", ".join(
        f"{name} {value:.4g}" for name, value in kept.problem.found(kept.x).items()
    )  # fmt: skip
    more = kept.problem.noise[0] * math.sqrt(kept.chi2 / max(kept.degrees, 1))
    more /= found.problem.noise[0] * math.sqrt(found.chi2 / max(found.degrees, 1)) or 1.0
    return (
        f"{' and '.join(said)} are left out: something seems to touch the puck there. With all "
        f"frames (--keep-all, keep_all=True) it would be {numbers or 'as known'}, residuals "
        f"{more:.3g} times as large"
    )


def _held(hold_out: Any) -> float | tuple[str, ...]:
    """A share of the frames, or names of tracks."""
    names: Any = (hold_out,) if isinstance(hold_out, str) else hold_out
    return tuple(names) if isinstance(names, list | tuple) else real("hold_out", names, "1")


def _held_out(found: Estimate, wanted: float | tuple[str, ...], known: Known) -> HeldOut:
    """The later part of tracks, predicted from the rest."""
    problem = found.problem
    films, later = split(problem.films, wanted, problem.noise[0])
    fewer = problem.with_films(films)
    if problem.meetings or problem.asked.speeds:
        part = estimate(fewer, found.x, known)
    else:
        part = fitted(fewer, known, refit=False)
    return predicted(part, _certainty(part, known), problem.films, later)

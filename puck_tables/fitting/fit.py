"""``fit``: the puck and the launches under which tracks are most likely."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables._core.real import instance, real
from puck_tables.errors import InputError
from puck_tables.film.track import Track
from puck_tables.fitting.blindness import blind_spots
from puck_tables.fitting.certainty import certainty_of
from puck_tables.fitting.estimate import Estimate, estimate
from puck_tables.fitting.free_motion import trimmed
from puck_tables.fitting.held_out import HeldOut, predicted, split
from puck_tables.fitting.impacts import cut, impacts_of
from puck_tables.fitting.laws import LawScore, compare
from puck_tables.fitting.numbers import numbers_of, plausible_for
from puck_tables.fitting.outcome import Fit
from puck_tables.fitting.parameters import Asked
from puck_tables.fitting.problem import Problem
from puck_tables.fitting.residual_tests import drift, runs
from puck_tables.fitting.rivals import rivals_of
from puck_tables.fitting.seen import Seen, noise_of, rests_from, seen_in, turning_of
from puck_tables.fitting.starts import start_of
from puck_tables.puck import Puck

Progress = Callable[[int, int], None]
_LIFTS = 0.995  # δ from which on a uniform puck is fitted with part of its base lifted
MOST_FRAMES = 100_000
_STILL, _LEAST_TURN = 3.0, 1e-9  # times the noise; rad
_JUDGED = 10  # degrees of freedom that tell the noise
_GUESS = 1e-3  # of the track: noise to begin with where differences tell none


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
    impacts: bool = False,
    laws: Sequence[str] = (),
    hold_out: float | Sequence[str] | None = None,
    progress: Progress | None = None,
) -> Fit:
    """Find a puck and its launches from tracks of it.

    Parameters
    ----------
    tracks : Track, or several of one puck
        Of free motion: slid, not rolled or pushed, until it rests or the film ends.  Frames at
        either end that are none of it are left out, if they are the smaller part.
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
    impacts : whether tracks may hold impacts with walls
        They are cut there, and restitution and friction of the rim follow from both sides.
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
    films = _films(tracks, since, until)
    asked = Asked.of(puck, free, fixed or {}, prior or {}, bounds or {}, start or {})
    given, known = _noise(noise)
    judged = noise_of(list(films))
    begin = tuple(
        value if value is not None else _positive(one, films)
        for value, one in zip(given, judged, strict=True)
    )
    if impacts:
        films = cut(films, begin[0])
    steps = 1 + len(laws) + (hold_out is not None)
    say = progress or (lambda done, total: None)
    problem = Problem(asked, films, (begin[0], begin[1]))
    found = fitted(problem, known, refit=True)
    say(1, steps)
    certainty = certainty_of(found.jacobian[found.kept], plausible_for(found.problem, found.x))
    rivals = rivals_of(found, certainty)
    numbers, launches = numbers_of(found, certainty, rivals)
    lost = tuple(n for n in asked.free if not numbers[n].determined)
    scores: tuple[LawScore, ...] = ()
    if laws:

        def of_law(
            one: Asked, noise: tuple[float, float], fixed_noise: tuple[bool, bool]
        ) -> Estimate:
            # frames that another law leaves out at the ends may be those that tell
            return fitted(Problem(one, films, noise), fixed_noise, refit=False)

        if isinstance(laws, str):
            raise InputError(f"laws must be a list of names, got the text '{laws}'")
        scores = compare(asked, tuple(laws), (begin[0], begin[1]), known, of_law)
        say(1 + len(laws), steps)
    held = None
    if hold_out is not None:
        held = _held_out(found, hold_out, known)
        say(steps, steps)
    return Fit(
        given=puck,
        numbers=numbers,
        launches=launches,
        chi2=found.chi2,
        degrees=found.degrees,
        noise=found.problem.noise,
        noise_known=known,
        smooth_noise=judged,
        outliers=found.outliers,
        runs=runs(found),
        drift=drift(found),
        left_out=_left_out(films, found.problem.films),
        blind=blind_spots(found, certainty, lost, rivals),
        laws=scores,
        held_out=held,
        impacts=impacts_of(found, certainty) if impacts else (),
        estimate=found,
        certainty=certainty,
    )


def _left_out(before: tuple[Seen, ...], after: tuple[Seen, ...]) -> tuple[tuple[int, int], ...]:
    """How many frames at the start and the end of each track are no free motion."""
    return tuple(
        (int((one.frame < left.frame[0]).sum()), int((one.frame > left.frame[-1]).sum()))
        for one, left in zip(before, after, strict=True)
    )


def fitted(problem: Problem, known: tuple[bool, bool], refit: bool) -> Estimate:
    """The estimate of a problem, from starts of its own.

    Parameters
    ----------
    problem : Problem
    known : whether the noise of places and of angles is
    refit : whether frames at the ends that are no free motion are left out
    """
    left = _observations(problem) - len(problem.names) + len(problem.priors)
    if left <= 0:
        raise InputError(
            f"{_observations(problem)} observations cannot tell {len(problem.names)} unknowns: "
            "give more frames, or fix something"
        )
    angled = any(film.angle is not None for film in problem.films)
    if left < _JUDGED and not (known[0] and (known[1] or not angled)):
        raise InputError(
            f"{_observations(problem)} observations of {len(problem.names)} unknowns are too few "
            "to judge their noise by: give the noise, or more frames"
        )
    parts = [replace(problem, films=(film,)) for film in problem.films]
    starts = [start_of(part) for part in parts]
    found = estimate(problem, _joint_start(problem, parts, starts), known)
    found = _lifted(found, known)
    if refit:
        films = trimmed(found)
        if films != problem.films:
            return fitted(replace(problem, films=films), known, refit=False)
    return found


def _lifted(found: Estimate, known: tuple[bool, bool]) -> Estimate:
    """The same with part of the base lifted, where δ seems to be above that of full contact."""
    problem = found.problem
    law = problem.asked.puck.body.law
    delta = problem.asked.scales(problem.found(found.x))[1]
    if problem.tall or not law.can_lift or delta < _LIFTS:
        return found
    certainty = certainty_of(found.jacobian[found.kept], plausible_for(problem, found.x))
    if certainty.undetermined[: len(problem.asked.free)].count(True):
        return found
    return estimate(replace(problem, tall=True), found.x, known)


def _joint_start(
    problem: Problem, parts: list[Problem], starts: list[tuple[dict[str, float], FloatArray]]
) -> FloatArray:
    """The unknowns of all tracks from those of each: what is shared is their weighted mean."""
    if len(parts) == 1:
        return problem.unknowns(starts[0][0], starts[0][1][None])
    shared = len(problem.asked.free)
    weights, sums, launches = np.zeros((shared, shared)), np.zeros(shared), []
    for part, (values, launch) in zip(parts, starts, strict=True):
        x = part.unknowns(values, launch[None])
        spread = certainty_of(part.jacobian(x), plausible_for(part, x)).covariance
        if shared:
            weight = np.linalg.pinv(spread[:shared, :shared])
            weights += weight
            sums += weight @ x[:shared]
        launches.append(launch)
    mean = np.linalg.solve(weights, sums) if shared else sums
    return problem.unknowns(
        dict(zip(problem.asked.free, mean.tolist(), strict=True)), np.array(launches)
    )


def _held_out(
    found: Estimate, hold_out: float | Sequence[str], known: tuple[bool, bool]
) -> HeldOut:
    """The later part of tracks, predicted from the rest."""
    problem = found.problem
    names: Any = (hold_out,) if isinstance(hold_out, str) else hold_out
    wanted = tuple(names) if isinstance(names, list | tuple) else real("hold_out", names, "1")
    films, later = split(problem.films, wanted, problem.noise[0])
    part = fitted(replace(problem, films=films), known, refit=False)
    certainty = certainty_of(part.jacobian[part.kept], plausible_for(part.problem, part.x))
    return predicted(part, certainty, problem.films, later)


def _films(tracks: Any, since: float, until: float) -> tuple[Seen, ...]:
    """The tracks, checked, with different names.

    Raises
    ------
    InputError
    """
    if not isinstance(tracks, Track | Iterable):
        raise InputError(f"tracks must be a Track or several, got {tracks!r}")
    listed = [tracks] if isinstance(tracks, Track) else list(tracks)
    if not listed:
        raise InputError("there is no track to fit: give one or more")
    for track in listed:
        instance("tracks", track, Track)
    names = [track.name for track in listed]
    films = []
    for n, track in enumerate(listed):
        film = seen_in(track, since, until)
        if names.count(track.name) > 1:
            film = replace(film, name=f"{track.name} {n + 1}")
        films.append(film)
        _refuse_still(film)
    count = sum(film.time.size for film in films)
    if count > MOST_FRAMES:
        raise InputError(
            f"{count} frames are too many for one fit, {MOST_FRAMES} are enough: give every tenth, "
            "or a part (since, until)"
        )
    return tuple(films)


def _refuse_still(film: Seen) -> None:
    """Refuse a track of a puck that lies still.

    Raises
    ------
    InputError
    """
    place, angle = noise_of([film])
    spread = place if math.isfinite(place) else 0.0
    turning = turning_of(film)
    turns = turning is not None and float(np.nanstd(turning.angle)) > _STILL * max(
        angle if math.isfinite(angle) else 0.0, _LEAST_TURN
    )
    if rests_from(film, spread) == 0 and not turns:
        raise InputError(
            f"the puck of {film.name} lies still: a fit needs a track of a slide or a spin"
        )


def _noise(
    given: Any,
) -> tuple[tuple[float | None, float | None], tuple[bool, bool]]:
    """The noise as given, and which of it was.

    Raises
    ------
    InputError
    """
    if given is None:
        return (None, None), (False, False)
    try:
        place, angle = given
    except (TypeError, ValueError):
        raise InputError(
            f"noise must be (metres, radians), None for what is to be estimated, got {given!r:.40}"
        ) from None
    checked: list[float | None] = []
    for value, what, unit in ((place, "places", "m"), (angle, "angles", "rad")):
        if value is None:
            checked.append(None)
            continue
        number = real(f"the noise of {what}", value, unit)
        if not number > 0.0:
            raise InputError(f"the noise of {what} must be greater than 0 ({unit}), got {number:g}")
        checked.append(number)
    return (checked[0], checked[1]), (checked[0] is not None, checked[1] is not None)


def _positive(judged: float, films: tuple[Seen, ...]) -> float:
    """Noise to begin with."""
    size = max(float(np.ptp(film.place, axis=0).max()) for film in films)
    least = 1e-9 * (size or 1.0)
    return max(judged, least) if math.isfinite(judged) else max(_GUESS * size, least)


def _observations(problem: Problem) -> int:
    places: npt.NDArray[np.int64] = problem.kinds
    return int(places.size) - len(problem.priors)

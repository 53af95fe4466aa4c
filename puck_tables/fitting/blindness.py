"""What tracks cannot tell, in words, and what would tell it."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.fitting.certainty import Z95, Certainty, Rival, certainty_of
from puck_tables.fitting.estimate import Estimate
from puck_tables.fitting.numbers import plausible_for
from puck_tables.fitting.parameters import ALL, OF_IMPACTS, WALL
from puck_tables.fitting.problem import PRIOR, Problem
from puck_tables.fitting.seen import Seen

_MEMBER = 0.2
_TOLD_ALL = 2  # other motions that are told in full
_TOLD = 0.1  # of what is plausible: an error that says something
_BETTER = 0.2  # times the error of the film that there is
_SPINNING = 1.0  # rω/v of a launch with more spin
_FASTEST = 1e3  # m/s, of a rim: more spin than that is no advice
_LONGER = 2.5  # times as many frames: surely to rest
_MARKS = 10.0  # mrad, of angle marks that are not there yet
_ALIKE = "the tracks look alike whatever it is"
_SCALES = {"friction", "gravity", "height", "radius", "decel"}


def blind_spots(
    found: Estimate,
    certainty: Certainty,
    lost: tuple[str, ...],
    rivals: tuple[Rival, ...] = (),
    unsigned: tuple[int, ...] = (),
) -> tuple[str, ...]:
    """A sentence for each direction that the tracks do not see.

    ``lost``: numbers of the puck that are not determined, by whatever; ``rivals``: other motions
    that fit about as well; ``unsigned``: tracks that the opposite spin fits as well.
    """
    sentences = []
    marked = any(film.angle is not None for film in found.problem.films)
    sentences += [rival_sentence(rival, marked) for rival in rivals[:_TOLD_ALL]]
    if others := len(rivals[_TOLD_ALL:]):
        more = "motion of another spin fits" if others == 1 else "motions of other spins fit"
        sentences.append(f"{others} more {more} about as well.")
    if marked and any(rival.rise < -(Z95**2) for rival in rivals):
        sentences.append(
            "That many turns a frame fit better may well be the floor: where friction changes with "
            "the slip speed, as on an air table, it is no Coulomb floor."
        )
    sentences += [mirror_sentence(found.problem.films[n].name) for n in unsigned]
    seen: set[frozenset[int]] = set()
    covered = {found.problem.names[k][1] for k in np.flatnonzero(certainty.undetermined)}
    for name in lost:
        if name not in covered and not (rivals and name != "delta"):
            remedy = _remedy(found, [name], [(-1, name)])
            sentences.append(f"{name} is not determined: {_ALIKE}. {remedy}")
    for direction in certainty.blind:
        members = [int(k) for k in np.argsort(-np.abs(direction)) if abs(direction[k]) > _MEMBER]
        if frozenset(members) in seen:
            continue
        names = [_name(found.problem, k) for k in members]
        shared = [found.problem.names[k][1] for k in members if found.problem.names[k][0] == -1]
        if len(names) == 1:
            told = f"{names[0]} is not determined: {_ALIKE}"
        else:
            told = f"{' and '.join(names)} are not determined one by one: the tracks look alike " \
                f"when {_together(found.problem, certainty, members)}"  # fmt: skip
        remedy = _remedy(found, shared, [found.problem.names[k] for k in members])
        sentences.append(f"{told}. {remedy}")
        seen.add(frozenset(members))
    return tuple(sentences)


def rival_sentence(rival: Rival, marked: bool) -> str:
    """Another motion that fits about as well; ``marked``: whether angles are seen."""
    more = "more frames a second" if marked else "angle marks on the puck"
    words = ", ".join(
        f"{name.replace('_', ' ')} {value:.4g}" for name, value in rival.numbers.items()
    )
    close = "as well"
    if abs(rival.rise) > Z95**2:
        nearly = "nearly as well" if rival.rise > 0.0 else "a little better"
        close = f"{nearly} (chi^2 {'+' if rival.rise > 0.0 else '-'} {abs(rival.rise):.2g})"
    return (
        f"Another motion, of another spin, fits {close}: {words}. What would tell: {more}, or its "
        "launch spin, if it is known (launch_spin)."
    )


def mirror_sentence(track: str) -> str:
    """The mirror image of a motion along a straight line fits as well."""
    return (
        f"{ALL['launch_spin'].words} of {track} may be of either sign: the path is not seen to "
        "bend to a side. What would tell: angle marks on the puck, or a bound of launch_spin."
    )


def _name(problem: Problem, k: int) -> str:
    track, name = problem.names[k]
    if track == -1:
        return name
    if track < -1:
        return f"{WALL[name].words} {-1 - track}"
    return f"{ALL[name].words} of {problem.films[track].name}"


def _together(problem: Problem, certainty: Certainty, members: list[int]) -> str:
    """How members of a direction change together."""
    first, *others = members
    direction = certainty.blind[
        int(np.argmax(np.abs(certainty.blind[:, first]) + np.abs(certainty.blind[:, others[0]])))
    ]
    words = [f"{_name(problem, first)} rises"]
    for k in others:
        same = direction[k] * direction[first] > 0.0
        words.append(f"{_name(problem, k)} {'rises' if same else 'falls'}")
    return " and ".join(words) + " with it"


def _remedy(found: Estimate, shared: list[str], members: list[tuple[int, str]]) -> str:
    """What would tell, tried out on the film that it would give."""
    if len(shared) > 1 and set(shared) <= _SCALES:
        return f"Measure one of them otherwise and fix it or give a prior: {' or '.join(shared)}."
    if any(key[0] < -1 or key[1] in OF_IMPACTS for key in members):
        return "Fix it, or give it a prior."
    now = _errors(found.problem, found.x, members)
    told: list[str] = []
    for words, problem, x in _other_films(found):
        others = _errors(problem, x, members)
        enough = (others < _TOLD) & (others < _BETTER * now)
        if enough.all() and not any(one in words for one in told):
            told.append(words)
    if told:
        return f"What would tell: {', or '.join(told)}."
    return "Fix it, or give it a prior."


def _other_films(found: Estimate) -> list[tuple[str, Problem, FloatArray]]:
    """Films that could have been made instead, each with its unknowns."""
    values, launches = found.problem.found(found.x), found.problem.launches(found.x)
    problem = replace(
        found.problem, asked=found.problem.asked.alone(), weights=(), meetings=(), walls=(),
        rests=(),
    )  # fmt: skip
    x = problem.unknowns(values, launches)
    radius = problem.asked.scales(values)[2]
    films = []
    marked = problem
    if any(film.angle is None for film in problem.films):
        marked = replace(
            problem, films=tuple(_marked(film) for film in problem.films),
            noise=(problem.noise[0], min(problem.noise[1], 1e-3 * _MARKS)),
        )  # fmt: skip
        films.append(("angle marks on the puck", marked, marked.unknowns(values, launches)))
    faster = launches.copy()
    speed = np.hypot(faster[:, 2], faster[:, 3])
    spin = np.maximum(np.abs(faster[:, 4]), _SPINNING * speed / radius)
    faster[:, 4] = np.copysign(spin, faster[:, 4])
    least = float(spin.max())
    asks = not np.allclose(faster, launches) and "launch_spin" not in problem.asked.fixed
    if asks and least * radius < _FASTEST:
        moderate = _with_heights_inside(values)
        films.append(
            (f"more spin (some {least:.2g} rad/s)", problem, problem.unknowns(moderate, faster))
        )
        if marked is not problem:
            films.append((
                f"more spin (some {least:.2g} rad/s) and angle marks", marked,
                marked.unknowns(moderate, faster),
            ))  # fmt: skip
    longer = replace(problem, films=tuple(_longer(film) for film in problem.films))
    films.append(("a longer run, to the stop", longer, x))
    return films


def _with_heights_inside(values: dict[str, float]) -> dict[str, float]:
    """δ at a bound says nothing of what could be seen."""
    if "delta" in values:
        return {**values, "delta": min(max(values["delta"], 0.05), 0.9)}
    return values


def _errors(problem: Problem, x: FloatArray, members: list[tuple[int, str]]) -> FloatArray:
    """The errors of members, those of the puck if there are, in units of what is plausible."""
    slopes, plausible = problem.jacobian(x), plausible_for(problem, x)
    known = certainty_of(slopes[problem.kinds != PRIOR], plausible)
    wanted = [key for key in members if key[0] == -1] or members
    places = [problem.names.index(key) for key in wanted]
    errors: FloatArray = (known.errors / plausible)[places]
    return errors


def _marked(film: Seen) -> Seen:
    return replace(film, angle=np.zeros(film.time.size), counts=None)


def _longer(film: Seen) -> Seen:
    count = math.ceil(_LONGER * film.time.size)
    return replace(
        film, time=film.usual_step * np.arange(float(count)), place=np.zeros((count, 2)),
        angle=None if film.angle is None else np.zeros(count), frame=np.arange(count),
        row=None if film.row is None else np.resize(film.row, count), counts=None,
    )  # fmt: skip

"""What tracks cannot tell, what nobody would believe, and what else to know of a fit, in words."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.fitting.certainty import Z95, Certainty, OtherMinimum, certainty_of
from puck_tables.fitting.estimate import Estimate
from puck_tables.fitting.fit_spec import ALL, OF_IMPACTS, WALL
from puck_tables.fitting.numbers import KNOWN, EstimatedLaunch, Number
from puck_tables.fitting.observations import Observations
from puck_tables.fitting.problem import PRIOR, Problem
from puck_tables.fitting.residuals import (
    JITTERY,
    NO_PATTERN,
    OUT_OF_LEVEL,
    SideForces,
    computed,
    lengthways,
    misfits,
)
from puck_tables.puck import Puck

_GRIP, _SLICK = 5.0, 1e-4  # friction coefficients of dry surfaces are smaller, and larger
_TALL = 8.0  # radii: pucks are lower
_OTHER = 3.0  # times the radius that was given
_FAST, _FAST_RIM = 100.0, 300.0  # m/s: no puck on a film slides, or turns, faster
_HEAVIER = 100.0  # times the other puck
_UNTOLD = 5.0  # degrees of a slope that is not told
_UNITS = "the unit of the places, or of the times, the scale or the frames a second may be wrong"


def doubts(
    numbers: Mapping[str, Number], launches: Sequence[EstimatedLaunch], radius: float
) -> tuple[str, ...]:
    """A sentence for each number that was found and that no puck has; ``radius`` m: as given.

    >>> tall = Number(10.0, 0.1, 9.8, 10.2, "m", "follows")
    >>> said = doubts({"height": tall}, (), 0.026)[0]
    >>> said[:55], "the frames a second may be wrong" in said
    ('A height of 10 m is 385 times the radius, as no puck is', True)
    """
    said = []
    result = {
        name: one for name, one in numbers.items()
        if one.how != KNOWN and one.determined and math.isfinite(one.value)
    }  # fmt: skip
    friction, height, own = (result.get(name) for name in ("friction", "height", "radius"))
    if friction is not None and (friction.low > _GRIP or friction.high < _SLICK):
        than = "more" if friction.low > _GRIP else "less"
        said.append(
            f"A friction of {friction.value:.3g} is {than} than dry surfaces have: {_UNITS}"
        )
    true = radius if own is None else own.value
    if not said and height is not None and height.value > _TALL * true and height.low > true:
        said.append(
            f"A height of {height.value:.3g} m is {height.value / true:.3g} times the radius, as "
            "no puck is: the path bends for another reason, or the floor slopes; or "
            f"{_UNITS}; give the height if it is known"
        )
    if own is not None and not 1.0 / _OTHER < own.value / radius < _OTHER:
        said.append(
            f"A radius of {own.value:.3g} m was found where {radius:.3g} m was said: the scale, or "
            "the unit of the angles, may be wrong"
        )
    gyration = result.get("gyration")
    rim = radius if gyration is not None and gyration.unit == "m" else 1.0
    if gyration is not None and gyration.low > rim:
        said.append(
            f"A radius of gyration of {gyration.value / rim:.3g} r is that of no body within its "
            "rim: the radius, or the unit of the angles, may be wrong"
        )
    ratio = result.get("mass_ratio")
    if ratio is not None and not 1.0 / _HEAVIER < ratio.value < _HEAVIER:
        said.append(f"A mass ratio of {ratio.value:.3g} is that of no two pucks of one size")
    for one in launches:
        speed, rim = math.hypot(*one.velocity), true * abs(one.spin)
        if speed > _FAST:
            said.append(f"{one.name} slides at {speed:.3g} m/s, as no puck does: {_UNITS}")
        elif rim > _FAST_RIM and one.numbers["launch_spin"].determined:
            said.append(
                f"The rim of {one.name} turns at {rim:.3g} m/s, as no puck does: the unit of the "
                "angles or of the times may be wrong, or it turns by whole turns less"
            )
    return tuple(said)


def rounded(film: Observations) -> list[str]:
    """A sentence for what is rounded more coarsely than its noise is."""
    return [
        f"{what} of {film.name} are rounded to {step:.3g} {unit}, which is no noise where the puck "
        "is slow: frames in which one stays at a value and comes back, or ends there, count as "
        "two, and errors are those that parts of the frames show. Better give "
        "them as they were measured"
        for what, step, unit in zip(("Places", "Angles"), film.steps, ("m", "rad"), strict=True)
        if step
    ]


def taken_for_granted(forces: SideForces, numbers: Mapping[str, Number]) -> list[str]:
    """A sentence where a table out of level, by less than is seen, changes more than errors say.

    >>> friction = Number(0.15, 1e-4, 0.1498, 0.1502, "1", "found")
    >>> said = taken_for_granted(SideForces(level=0.7, by_slope={"friction": 0.0017}),
    ...                          {"friction": friction})
    >>> said[0][:74]
    'A level table is taken for granted: one out of level by 0.1 degrees would '
    """
    unseen = min(1.0, forces.level / OUT_OF_LEVEL)
    changes = [
        f"{name} by up to {change * unseen:.2g}" for name, change in forces.by_slope.items()
        if math.isfinite(numbers[name].error) and change * unseen > numbers[name].error
    ]  # fmt: skip
    if not changes:
        return []
    alone = f"tell its slope to {forces.level:.2g} degrees alone"
    return [
        "A level table is taken for granted: one out of level by "
        f"{min(OUT_OF_LEVEL, forces.level):.2g} degrees would change {' and '.join(changes)}, and "
        f"the tracks {'do not tell its slope' if forces.level >= _UNTOLD else alone}"
    ]


_MEMBER = 0.2  # component of a direction that is named
_IN_FULL = 2  # other motions that are told in full
_INFORMATIVE = 0.1  # of what is plausible: an error that says something
_BETTER = 0.2  # times the error of the film that there is
_SPINNING = 1.0  # rω/v of a launch with more spin
_FASTEST = 1e3  # m/s, of a rim: more spin than that is no advice
_LONGER = 2.5  # times as many frames: surely to rest
_MARKS = 10.0  # mrad, of angle marks that are not there yet
_ALIKE = "the tracks look alike whatever it is"
_SCALES = {"friction", "gravity", "height", "radius", "decel"}


def not_identifiable(
    result: Estimate, certainty: Certainty, lost: tuple[str, ...],
    minima: tuple[OtherMinimum, ...] = (), unsigned: tuple[int, ...] = (),
) -> tuple[str, ...]:  # fmt: skip
    """A sentence for each direction that the tracks do not see.

    ``lost``: numbers of the puck that are not determined, by whatever; ``minima``: other motions
    that fit about as well; ``unsigned``: tracks that the opposite spin fits as well.
    """
    marked = result.problem.angled
    sentences = [minimum_sentence(one, result, marked) for one in minima[:_IN_FULL]]
    if others := len(minima[_IN_FULL:]):
        more = "motion of another spin fits" if others == 1 else "motions of other spins fit"
        sentences.append(f"{others} more {more} about as well.")
    if marked and any(minimum.rise < -(Z95**2) for minimum in minima):
        sentences.append(
            "That many turns a frame fit better may well be the floor: where friction changes with "
            "the slip speed, as on an air table, it is no Coulomb floor."
        )
    sentences += [mirror_sentence(result.problem.films[n].name) for n in unsigned]
    seen: set[frozenset[int]] = set()
    covered = {result.problem.names[k][1] for k in np.flatnonzero(certainty.undetermined)}
    for name in lost:
        if name not in covered and not (minima and name != "delta"):
            remedy = _remedy(result, [name], [(-1, name)])
            sentences.append(f"{name} is not determined: {_ALIKE}. {remedy}")
    for direction in certainty.blind:
        members = [int(k) for k in np.argsort(-np.abs(direction)) if abs(direction[k]) > _MEMBER]
        if frozenset(members) in seen:
            continue
        names = [_name(result.problem, k) for k in members]
        shared = [result.problem.names[k][1] for k in members if result.problem.names[k][0] == -1]
        if len(names) == 1:
            sentence = f"{names[0]} is not determined: {_ALIKE}"
        else:
            sizes = np.abs(certainty.blind[:, members[:2]]).sum(axis=1)
            along = certainty.blind[int(np.argmax(sizes))][members]
            words = [f"{name} {'rises' if one * along[0] > 0.0 else 'falls'}"
                     for name, one in zip(names, along, strict=True)]  # fmt: skip
            sentence = (
                f"{' and '.join(names)} are not determined one by one: the tracks look alike when "
                f"{' and '.join(words)} with it"
            )
        remedy = _remedy(result, shared, [result.problem.names[k] for k in members])
        sentences.append(f"{sentence}. {remedy}")
        seen.add(frozenset(members))
    return tuple(sentences)


def minimum_sentence(minimum: OtherMinimum, taken: Estimate, marked: bool) -> str:
    """A sentence on a minimum that fits about as well; ``marked``: whether angles are seen."""
    more = "more frames a second" if marked else "angle marks on the puck"
    here, there = minimum._replace(estimate=taken).numbers, minimum.numbers
    said = [f"{name} {value:.4g} (here {here[name]:.4g})" for name, value in there.items()]
    words = ", ".join(said).replace("_", " ")
    close = "as well"
    if abs(minimum.rise) > Z95**2:
        nearly = "nearly as well" if minimum.rise > 0.0 else "a little better"
        close = f"{nearly} (chi^2 {'+' if minimum.rise > 0.0 else '-'} {abs(minimum.rise):.2g})"
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
    if track < -1:
        return f"{WALL[name].words} {-1 - track}"
    return name if track == -1 else f"{ALL[name].words} of {problem.films[track].name}"


def _remedy(result: Estimate, shared: list[str], members: list[tuple[int, str]]) -> str:
    """What would tell, tried out on the film that it would give."""
    if len(shared) > 1 and set(shared) <= _SCALES:
        return f"Measure one of them otherwise and fix it or give a prior: {' or '.join(shared)}."
    if any(key[0] < -1 or key[1] in OF_IMPACTS for key in members):
        return "Fix it, or give it a prior."

    def errors(problem: Problem, x: FloatArray) -> FloatArray:
        """Of members, those of the puck if there are, in units of what is plausible."""
        known = _by_tracks(problem, x)
        wanted = [key for key in members if key[0] == -1] or members
        places = [problem.names.index(key) for key in wanted]
        return np.asarray((known.errors / known.plausible)[places])

    now, cures = errors(result.problem, result.x), list[str]()
    for words, problem, x in _other_films(result.problem, result.x):
        enough = errors(problem, x) < np.minimum(_INFORMATIVE, _BETTER * now)
        if enough.all() and not any(one in words for one in cures):
            cures.append(words)
    return f"What would tell: {', or '.join(cures)}." if cures else "Fix it, or give it a prior."


def _other_films(problem: Problem, x: FloatArray) -> list[tuple[str, Problem, FloatArray]]:
    """Films that could have been made instead, each with its unknowns."""
    values, launches, spec = problem.numbers_at(x), problem.launches(x), problem.spec.alone()
    problem = replace(problem, spec=spec, weights=(), impact_specs=(), walls=(), rests=())
    radius, films, marked = spec.scales(values)[2], [], problem
    if any(film.angle is None for film in problem.films):
        seen = [replace(one, angle=np.zeros(one.time.size), counts=None) for one in problem.films]
        noise = problem.noise[0], min(problem.noise[1], 1e-3 * _MARKS)
        marked = replace(problem, films=tuple(seen), noise=noise)
        films.append(("angle marks on the puck", marked, marked.unknowns(values, launches)))
    faster = launches.copy()
    speed = np.hypot(faster[:, 2], faster[:, 3])
    spin = np.maximum(np.abs(faster[:, 4]), _SPINNING * speed / radius)
    faster[:, 4] = np.copysign(spin, faster[:, 4])
    least = float(spin.max())
    varies = not np.allclose(faster, launches) and "launch_spin" not in problem.spec.fixed
    if varies and least * radius < _FASTEST:
        moderate = dict(values)
        if "delta" in values:  # at a bound it says nothing of what could be seen
            moderate["delta"] = min(max(values["delta"], 0.05), 0.9)
        words = f"more spin (some {least:.2g} rad/s)"
        films.append((words, problem, problem.unknowns(moderate, faster)))
        if marked is not problem:
            films.append((f"{words} and angle marks", marked, marked.unknowns(moderate, faster)))
    longer = []
    for film in problem.films:
        count = math.ceil(_LONGER * film.time.size)
        longer.append(replace(
            film, time=film.usual_step * np.arange(float(count)), place=np.zeros((count, 2)),
            angle=None if film.angle is None else np.zeros(count), frame=np.arange(count),
            row=None if film.row is None else np.resize(film.row, count), counts=None,
        ))  # fmt: skip
    x = problem.unknowns(values, launches)
    return [*films, ("a longer run, to the stop", replace(problem, films=tuple(longer)), x)]


def spin_would_tell(result: Estimate) -> str:
    """What the same slide would tell if it spun and a mark on it were filmed; '' if not more.

    For a result whose tracks lie along a line without angles.
    """
    problem = replace(result.problem, spec=replace(result.problem.spec, bounds={}, start={}))
    for words, other, x in _other_films(problem, result.x):
        if "spin" not in words or "marks" not in words:
            continue
        errors = zip(other.spec.free, _by_tracks(other, x).errors, strict=False)
        gains = [f"{name} to +- {error:.2g}" for name, error in errors if 0.0 < error < math.inf]
        if gains:
            return f"With {words}, as it is otherwise, the film would tell {' and '.join(gains)}"
    return ""


def _by_tracks(problem: Problem, x: FloatArray) -> Certainty:
    """How well unknowns are known by tracks without priors."""
    slopes = problem.residuals_and_jacobian(x)[1][problem.kinds != PRIOR]
    return certainty_of(slopes, problem.plausible(x))


_WIDER = 1.5  # times: an error that is told to be widened


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Remarked:
    """A fit, as far as it says what to think of it."""

    given: Puck
    numbers: dict[str, Number]
    launches: tuple[EstimatedLaunch, ...]
    noise: tuple[float, float]
    jitter: float
    outliers: float
    drift: float
    untied: str
    not_met: tuple[str, ...]
    estimate: Estimate
    certainty: Certainty
    forces: SideForces
    misfit: str = ""

    @property
    def complaints(self) -> tuple[str, ...]:
        """Signs that the tracks are not those of such a puck."""
        words = [*misfits(self.estimate, self.forces.chance)]
        if words:
            words.append(
                "Standard errors are widened by what parts of the frames do to the numbers: they "
                "may still be too small"
            )
        words += filter(None, (self.untied, self.misfit))
        if self.outliers > 0.2:
            words.append(f"{100.0 * self.outliers:.3g} % of the observations had to be left out")
        return tuple(words)

    @property
    def doubts(self) -> list[str]:
        """What was found that nobody would believe."""
        return list(doubts(self.numbers, self.launches, self.given.radius))

    @property
    def remarks(self) -> tuple[str, ...]:
        """What to know of the numbers before they are used."""
        problem = self.estimate.problem
        said = [
            f"{name} is found, too, since it has a prior or bounds: without them it is known, "
            f"{float(getattr(self.given, name)):g}"
            for name in problem.spec.freed if hasattr(self.given, name)
        ]  # fmt: skip
        every = zip(problem.films, problem.spinless, strict=True)
        if straight := [film.name for film, spinless in every if spinless]:
            others = f" and {len(straight) - 1} more lie" if len(straight) > 1 else " lies"
            said.append(
                f"{straight[0]}{others} along a line and without angles: taken for a slide without "
                "spin. If it spun, friction may be up to 1.6 times as much (bounds or a start of "
                "launch_spin look for that)"
            )
        if all(problem.spinless) and (more := spin_would_tell(self.estimate)):
            said.append(more)
        said += [text for film in problem.films for text in rounded(film)]
        own = len(problem.spec.free) or self.estimate.x.size  # of the puck, if any is found
        # of several at their most rounding does not choose
        wider = [round(self.certainty.ratio(k), 6) for k in range(own)]
        is_said = bool(self.complaints) or computed(self.estimate)
        if self.certainty.widened and max(wider) > _WIDER and not is_said:
            name = problem.names[int(np.argmax(wider))][1]
            said.append(
                "What is left may be no noise, though that is hardly seen: standard errors are "
                f"widened by what parts of the frames do to the numbers, {max(wider):.2g} times "
                f"that of {name}"
            )
        for k, side in enumerate(self.certainty.pinned):
            if side:
                end, where = problem.limits[side > 0][k], "above" if side > 0 else "below"
                name = problem.names[k][1]
                if side > 0 and name == "friction" and end == problem.spec.steepest(name):
                    where += " (with more part of the base would lift: is the height right?)"
                if side < 0 and name == "delta" and problem.angled:  # a path turns with the spin
                    where += " (or angles, or y, grow the other way)"
                said.append(
                    f"{name} lies on the end of its range, {end:.6g}: what fits best may be "
                    f"{where}. So it has no standard error, and its interval, and errors and "
                    "intervals of the rest, may mislead"
                )
        air, mass = self.numbers.get("air"), self.given.mass
        if air is not None and mass != 1.0 and math.isfinite(air.error):
            said.append(
                f"air is {air.value * mass:.4g} +- {air.error * mass:.2g} kg/m over the mass of "
                f"{mass:g} kg: drag.quadratic of a scene"
            )
        said += (*self.not_met, *self.doubts)
        # stamps that jitter leave no drift, as another law does
        if self.jitter == 0.0 and self.noise[0] > 0.0 and self.drift > NO_PATTERN:
            ratio = lengthways(self.estimate)
            if ratio > JITTERY:
                said.append(
                    f"Residuals along the motion are {ratio:.3g} times those across it: the time "
                    "stamps may jitter (--jitter find)"
                )
        said += taken_for_granted(self.forces, self.numbers)
        return tuple(f"{text}." for text in said)

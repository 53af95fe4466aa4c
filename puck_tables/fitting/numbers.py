"""The numbers of a puck and of its launches, with what is known of each, and in a file of a fit."""

from __future__ import annotations

import json
import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray, one_velocity, real
from puck_tables._core.safe_read import read_whole
from puck_tables.errors import InputError
from puck_tables.fitting.certainty import (
    Certainty,
    Interval,
    OtherMinimum,
    certainty_at,
    interval_of,
)
from puck_tables.fitting.estimate import Estimate
from puck_tables.fitting.fit_spec import ALL, INTEGRATED, LAUNCH, NOTHING, PUCK, TINY
from puck_tables.fitting.impact_matching import slide_name
from puck_tables.fitting.problem import Problem
from puck_tables.puck import Puck

_ALL = 0.8  # of the range in which a number is looked for: an interval so wide tells nothing
_DECIMALS = 12  # of a value on the end of its range
_MUCH = {"friction": 1.0, "decel": 10.0}  # an error that says nothing
# after the point, of numbers below 1e-3 and of others: more are written with a power of ten
_DIGITS, _MOST = 9, 12
FREE, FOLLOWS, KNOWN = "found", "follows", "known"


class Number(NamedTuple):
    """One number.

    ``error``: its standard error, infinite where the tracks do not determine it, 0 where it was
    known, NaN where it, or what it follows from, lies on the end of its range; ``low``, ``high``:
    its 95 % interval; ``how``: found, follows (from what is found) or known; ``profiled``: whether
    the interval is that of the profile likelihood.
    """

    value: float
    error: float
    low: float
    high: float
    unit: str
    how: str
    profiled: bool = False

    @property
    def determined(self) -> bool:
        """Whether the tracks tell it."""
        return not math.isinf(self.error)

    @property
    def at_bound(self) -> bool:
        """Whether it, or what it follows from, lies on the end of its range: no error is known."""
        return math.isnan(self.error)

    @property
    def shown(self) -> str:
        """The value to six digits; 0 where it differs from 0 by what is computed alone."""
        return f"{round(self.value, _DECIMALS) + 0.0:.6g}"

    @property
    def unit_behind(self) -> str:
        """The unit as it stands behind a number, none of a number without one."""
        return "" if self.unit == "1" else f" {self.unit}"

    @property
    def written(self) -> str:
        """Value +- error, to two digits of the error, and the unit.

        >>> Number(0.15234, 0.00123, 0.1499, 0.1548, "m/s", FREE).written
        '0.1523 +- 0.0012 m/s'
        """
        if self.at_bound:
            return f"{self.shown}{self.unit_behind} (at its bound)"
        if not (self.error > 0.0 and math.isfinite(self.error)):
            return f"{self.value:.6g}{self.unit_behind}"
        digits = max(0, 1 - math.floor(math.log10(self.error)))
        if digits > (_DIGITS if abs(self.value) < 1e-3 else _MOST) and self.value != 0.0:
            power = max(0, digits + math.floor(math.log10(abs(self.value))))
            return f"{self.value:.{power}e} +- {self.error:.1e}{self.unit_behind}"
        return f"{self.value:.{digits}f} +- {self.error:.{digits}f}{self.unit_behind}"

    @property
    def interval(self) -> str:
        """Both ends of its 95 % interval, to two digits of what lies between; '' where unknown.

        >>> Number(0.3, 2.8e-10, 0.2999999994419, 0.3000000005580, "1", FREE).interval
        '0.29999999944 to 0.30000000056'
        """
        wide = 0.5 * (self.high - self.low)
        if self.how == KNOWN or not self.determined or not (0.0 < wide < math.inf):
            return ""
        digits = 1 - math.floor(math.log10(wide))
        if digits > _MOST:
            most = max(abs(self.low), abs(self.high))
            power = digits + math.floor(math.log10(most))
            return f"{self.low:.{power}e} to {self.high:.{power}e}"
        return " to ".join(f"{round(end, digits) + 0.0:.{max(0, digits)}f}"
                           for end in (self.low, self.high))  # fmt: skip


class EstimatedLaunch(NamedTuple):
    """How a track begins.

    ``name``: of the track; ``time`` s: of its first frame; then what was found there: ``place``
    (x, y) m, ``velocity`` (vx, vy) m/s, ``spin`` rad/s, ``angle`` rad; ``numbers``: the same by
    name, with errors.
    """

    name: str
    time: float
    place: tuple[float, float]
    velocity: tuple[float, float]
    spin: float
    angle: float
    numbers: Mapping[str, Number]


def numbers_of(
    result: Estimate, certainty: Certainty, other_fits: tuple[OtherMinimum, ...] = (),
    unsigned: tuple[int, ...] = (),
) -> tuple[dict[str, Number], tuple[EstimatedLaunch, ...]]:  # fmt: skip
    """All numbers of the puck, and of each launch.

    ``other_fits``: other summits of the likelihood; what they differ in, or do not tell, is not
    determined; ``unsigned``: tracks that do not tell which way the puck spins.
    """
    problem, x = result.problem, result.x
    spec, errors = problem.spec, certainty.errors
    values = problem.numbers_at(x)
    puck: dict[str, Number] = {}
    for k, name in enumerate(spec.free):
        interval, error = interval_of(result, certainty, k), float(errors[k])
        low, high = interval.low, interval.high
        if interval.profiled:  # the likelihood is no parabola: half of its width
            error = max(error, (high - low) / (2.0 * certainty.reach))
        for minimum in other_fits:
            there = interval_of(minimum.estimate, minimum.certainty, k)
            within = interval.low <= minimum.numbers[name] <= interval.high
            if not within or minimum.certainty.undetermined[k]:
                error = math.inf
            low, high = min(low, there.low), max(high, there.high)
            error = max(error, (high - low) / (2.0 * certainty.reach))
        least, largest = (float(limit[k]) for limit in problem.limits)
        if high - low >= _ALL * (largest - least) or error > _MUCH.get(name, math.inf):
            error = math.inf
        kind = spec.parameters[name].unit, FREE, interval.profiled
        puck[name] = Number(values[name], error, low, high, *kind)
    speed = puck.get("law_speed")
    if speed is not None and not math.isfinite(speed.error):
        # all slips are on one side of it, and tell one of the frictions alone
        slow = problem.fastest(x) < speed.value
        for name in {"law_speed", "friction" if slow else "friction_rest"} & {*puck}:
            puck[name] = puck[name]._replace(error=math.inf)
    # what follows is as much less certain as what it follows from
    widened, profiled = np.ones(x.size), False
    for k, name in enumerate(spec.free):
        if puck[name].profiled and 0.0 < errors[k] < math.inf and puck[name].determined:
            widened[k] = max(puck[name].error / errors[k], 1.0)
            profiled = True
    for name, value in spec.all_at(values).items():
        if name in puck or (name in NOTHING and value == 0.0):
            continue
        slope = _slope(problem, x, name)
        if not slope.any():
            puck[name] = Number(value, 0.0, value, value, spec.parameters[name].unit, KNOWN)
            continue
        size = max(abs(value), 1e-12)
        error = certainty.error_of(slope * widened, size)
        if math.isfinite(error) and certainty.follows_end(slope, size):
            error = math.nan
        seen = (k for k in np.flatnonzero(slope) if not certainty.undetermined[k])
        if any(not puck[spec.free[k]].determined for k in seen):
            error = math.inf
        number = quadratic(value, error, spec.parameters[name].unit, FOLLOWS, certainty.reach)
        of, ends = np.flatnonzero(slope), None
        if of.size == 1:  # from the ends of that one's
            one = spec.free[of[0]]
            if math.isfinite(puck[one].high):
                ends = _ends(problem, x, name, one, puck[one])
        known = not math.isinf(error)
        # where part of a base would lift the likelihood of a height ends, and has no width
        if ends is None and profiled and name == "height" and known and spec.base is None:
            ends = _profiled(result, certainty, name)
        tilt = puck.get("delta")
        if ends is None and known and name == "height" and tilt is not None and tilt.profiled:
            # f and r as found: that of f is far narrower
            ends = replace(_ends(problem, x, name, "delta", tilt), profiled=True)
        if ends is not None and ends.profiled and known:
            half = 0.5 * (ends.high - ends.low) / certainty.reach
            number = number._replace(error=error if math.isnan(error) else half, profiled=True)
        if ends is not None and known:
            number = number._replace(low=ends.low, high=ends.high)
        puck[name] = number._replace(low=max(number.low, PUCK[name].low))
    puck = {name: puck[name] for name in PUCK if name in puck}
    unsure = {*unsigned, *(n for minimum in other_fits for n in minimum.tracks)}
    return puck, _launches(result, certainty, unsure)


def _launches(
    result: Estimate, certainty: Certainty, unsure: Collection[int]
) -> tuple[EstimatedLaunch, ...]:
    """The launches of all slides; those after an impact follow from the first.

    ``unsure``: tracks of which motions of different spins fit as well.
    """
    problem, errors = result.problem, certainty.errors
    plausible = dict(zip(problem.names, certainty.plausible.tolist(), strict=True))
    slides, slopes = problem.slides(result.x)[0], problem.slopes_of_slides(result.x)
    launches = []
    for n, film in enumerate(problem.films):
        for m, slide in enumerate(slides[n]):
            numbers = {}
            row = slide.launch.tolist()
            for k, (name, value) in enumerate(zip(LAUNCH, row, strict=True)):
                error, how = 0.0, KNOWN
                if m > 0:
                    how = FOLLOWS
                    size = plausible.get((n, name), 1.0)
                    error = certainty.error_of(slopes[n][m][k + 1], size)
                elif (n, name) in problem.names:
                    error, how = float(errors[problem.names.index((n, name))]), FREE
                    if n in unsure and name == "launch_spin":
                        error = math.inf
                numbers[name] = quadratic(value, error, ALL[name].unit, how, certainty.reach)
            name = film.name if len(slides[n]) == 1 else slide_name(film.name, m)
            since = film.start + slide.since - slides[n][0].since
            px, py, vx, vy, spin, angle = row
            launches.append(EstimatedLaunch(name, since, (px, py), (vx, vy), spin, angle, numbers))
    return tuple(launches)


def quadratic(value: float, error: float, unit: str, how: str, reach: float) -> Number:
    """A number with the interval that its standard error says, ``reach`` of them wide."""
    return Number(value, error, value - reach * error, value + reach * error, unit, how)


def _ends(problem: Problem, x: FloatArray, name: str, one: str, number: Number) -> Interval:
    """The interval of what follows, from the ends of that of one number, the others as found."""
    values = problem.numbers_at(x)
    ends = [problem.spec.all_at({**values, one: end})[name] for end in (number.low, number.high)]
    return Interval(min(ends), max(ends), False)


def _profiled(result: Estimate, certainty: Certainty, name: str) -> Interval | None:
    """The interval of height by the profile likelihood, with height in place of δ as an unknown.

    None where δ is not found, or more is known of it than the tracks tell, or height is not bound
    by itself.
    """
    problem = result.problem
    spec = problem.spec
    if "delta" not in spec.free or "delta" in spec.priors or "delta" in spec.bounds:
        return None
    k = spec.free.index("delta")
    height = spec.all_at(problem.numbers_at(result.x))[name]
    other = replace(spec, free=tuple(name if one == "delta" else one for one in spec.free))
    moved = replace(problem, spec=other)
    x = result.x.copy()
    x[k] = height
    there = result.at(x, moved)
    own = certainty_at(there, certainty.degrees)
    if own.undetermined[k]:
        return None
    ratio = certainty.ratio(k)
    return interval_of(there, own, k).wider(height, ratio, 0.0, math.inf)


def _slope(problem: Problem, x: FloatArray, name: str) -> FloatArray:
    """How a number changes with the unknowns (m,)."""
    spec, values = problem.spec, problem.numbers_at(x)
    slope = np.zeros(x.size)
    for k, free in enumerate(spec.free):
        moved = spec.all_at({**values, free: values[free] + 1j * TINY})
        slope[k] = moved[name].imag / TINY
        if abs(slope[k] * values[free]) < 1e-13 * abs(moved[name].real):  # rounding
            slope[k] = 0.0
    return slope


KIND = "puck-tables fit 1"
_ENTRIES = {  # of a scene, that have what a free puck has not
    "drag": "drag.sliding and drag.spinning", "air": "drag.quadratic (air times mass)",
    "spin_drag": "drag.spinning", "slope_x": "floor.slope", "slope_y": "floor.slope",
    "belt_x": "floor.velocity", "belt_y": "floor.velocity", "friction_rest": "floor.law",
    "law_speed": "floor.law",
}  # fmt: skip


def as_json(value: Any) -> Any:
    """What JSON holds of a result, by names, with None for NaN and infinity: JSON has none."""
    if isinstance(value, Number):
        value = {**value._asdict(), "determined": value.determined, "at_bound": value.at_bound}
    elif isinstance(value, EstimatedLaunch):
        value = {"track": value.name, **value._asdict()}
        del value["name"]
    elif hasattr(value, "_asdict"):
        value = value._asdict()
    if isinstance(value, dict):
        return {name: as_json(one) for name, one in value.items()}
    if isinstance(value, list | tuple):
        return [as_json(one) for one in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return bool(value) if isinstance(value, np.bool_) else value


_LARGEST = 1 << 26  # bytes
_PUCK = ("height", "friction", "mass", "gravity", "gyration")


def puck_and_launch(
    path: str | Path, track: str | None = None
) -> tuple[Puck, dict[str, Any], tuple[str, ...]]:
    """The puck, and how it was launched, of a track in a file of ``puck fit -o fit.json``.

    That is the velocity (m/s), the spin (rad/s) and, on a base that is not round, the orientation
    (rad) of :meth:`Puck.simulate`.  And sentences on what its tracks did not determine, and on what
    is hard to believe.

    ``path``: .json; ``track``: its name or number, where the file has several.  Raises InputError
    if the file is none of a fit, has no such track, its puck has drag or friction over slip speed,
    or nobody would believe what was found.
    """
    fault = f"{path}: no file of puck fit (.json)"
    try:
        data: Any = json.loads(read_whole(path, _LARGEST))
    except (ValueError, RecursionError):
        raise InputError(fault) from None
    kind = data.get("kind") if isinstance(data, dict) else None
    if isinstance(kind, str) and kind != KIND and kind.startswith(KIND[:-1]):
        raise InputError(f"{path} is of {kind:.40}, and this version reads {KIND}: fit again")
    if kind != KIND:
        raise InputError(fault)
    try:
        launches = {str(one["track"]): one for one in data["launches"]}
        contact = ("base",) if "base" in data["puck"] else ("radius", "pressure")
        puck = Puck(**{name: data["puck"][name] for name in (*contact, *_PUCK)})
        drags = {
            name: real(name, data["numbers"][name]["value"], "")
            for name in ("drag", *INTEGRATED) if name in data["numbers"]
        }  # fmt: skip
        chosen = launches[_chosen(list(launches), track, path)]
        launch: dict[str, Any] = {
            "velocity": one_velocity(chosen["velocity"]),
            "spin": real("spin", chosen["spin"], "rad/s"),
        }
        if puck.shape is not None:
            launch["orientation"] = real("angle", chosen["angle"], "rad")
        unknown = tuple(str(one) for one in (*data["not_determined"], *data["doubts"]))
        astray, speeds = str(data["astray"]), [*data["slip_speeds"]]
    except (KeyError, TypeError, AttributeError):
        raise InputError(fault) from None
    refuse_unplayable(drags, speeds, astray, f"{path}: ")
    return puck, launch, unknown


def refuse_unplayable(
    drags: Mapping[str, float], speeds: Sequence[float], astray: str, where: str = ""
) -> None:
    """Refuse a puck that nobody would believe, or whose motion no free puck has.

    ``drags``: values of drag and :data:`INTEGRATED`; ``speeds``: slip speeds at which friction was
    found; ``astray``: why nobody would believe it; ``where``: what begins the sentence.
    """
    if astray:
        raise InputError(f"{where}{astray}: there is nothing to play")
    entries = {"friction over slip speed": "floor.law"} if speeds else {}
    entries |= {f"{n} of {one:.3g}": _ENTRIES[n] for n, one in drags.items() if one != 0.0}
    for what, entry in entries.items():
        raise InputError(
            f"{where}the puck was found with {what}, which a free puck has not: make a scene of "
            f"it, with {entry}"
        )


def _chosen(names: list[str], track: str | None, path: str | Path) -> str:
    """The name of a track."""
    listed = ", ".join(names)
    if track is None:
        if len(names) != 1:
            raise InputError(f"{path} has {len(names)} tracks: say which (--track): {listed}")
        return names[0]
    if track in names:
        return track
    if track.isascii() and track.isdigit() and 1 <= int(track) <= len(names):
        return names[int(track) - 1]
    raise InputError(f"{path} has no track '{track}': there are {listed}")

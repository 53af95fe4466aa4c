"""What a fit is given, checked before anything is fitted."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from typing import Any

import numpy as np

from puck_tables._core.arrays import instance, pair_of, positive, real
from puck_tables.contact.speed_law import KINDS
from puck_tables.errors import InputError
from puck_tables.film.film import Track, marks_of_one
from puck_tables.fitting.certainty import Certainty
from puck_tables.fitting.checked_spec import over, refuse_integrated
from puck_tables.fitting.estimate import Estimate
from puck_tables.fitting.fit_spec import MARK, MOST_NODES, FitSpec
from puck_tables.fitting.impact_matching import Line, turns
from puck_tables.fitting.observations import Observations, noise_of, observations_in, rests_from
from puck_tables.fitting.problem import Known
from puck_tables.fitting.starts import slowing_of

MOST_FRAMES = 100_000  # of all tracks: memory and time of a fit grow with them
FIND = "find"
_JITTER = 0.3  # times the noise of a place over the speed: to begin with
_NEAREST, _FARTHEST = 1e-30, 1e6  # m or s, of a track
_TWICE = 0.5  # of the frames: the same film again
_SLOWER = 0.3  # times the deceleration seen: friction is no less
_TIPS = 4.0  # δ
_LARGE, _LARGER = 2.0, 8.0  # m, and times its slide: a puck that hardly anybody films


@dataclass(frozen=True)
class Inputs:
    """What is said of tracks.

    ``spec``: what is to be found of the puck; ``noise`` (m, rad) and ``jitter`` (s), None for what
    is to be found; ``speeds`` m/s at which friction is, ``between`` which it goes so; ``impacts``:
    whether they are looked for; ``lines``: walls that are known; ``hold_out``: a share of the
    frames, or names of tracks; ``known``: which noise is given.
    """

    spec: FitSpec
    noise: tuple[float | None, float | None]
    jitter: float | None
    speeds: tuple[float, ...]
    between: str
    impacts: bool
    lines: tuple[Line, ...]
    hold_out: float | tuple[str, ...] | None

    @classmethod
    def of(
        cls, spec: FitSpec, noise: Any, jitter: Any, speeds: Any, between: Any, impacts: bool,
        lines: tuple[Line, ...], hold_out: Any,
    ) -> Inputs:  # fmt: skip
        """Checked."""
        checked = checked_speeds(speeds, between)
        if checked:
            over(spec, checked, between)
        if spec.integrated:
            refuse_integrated(spec)
        if spec.integrated and (impacts or lines):
            raise InputError(
                f"{' and '.join(spec.integrated)} cannot be found beside impacts: leave one of "
                "the two out"
            )
        later: Any = (hold_out,) if isinstance(hold_out, str) else hold_out
        if later is not None:
            listed = isinstance(later, list | tuple)
            later = tuple(later) if listed else real("hold_out", later, "1")
        impacts, own = impacts or bool(lines), checked_noise(noise)
        return cls(spec, own, checked_jitter(jitter), checked, between, impacts, lines, later)

    @property
    def known(self) -> Known:
        """Whether the noise of places, of angles and of time stamps is given."""
        place, angle = self.noise
        return Known(place is not None, angle is not None, self.jitter is not None)


def observations_of(
    tracks: Any, since: float, until: float, keep_all: bool, rows: tuple[float, float] | None,
    radius: float,
) -> tuple[Observations, ...]:  # fmt: skip
    """The tracks, checked, with different names.

    ``keep_all``: whether all their frames are of free motion; ``radius`` m: of the puck, two of
    which are never nearer than twice that; ``rows``: y in m of the first and the last line of the
    picture.
    """
    if not isinstance(tracks, Track | Iterable):
        raise InputError(f"tracks must be a Track or several, got {tracks!r}")
    listed = [tracks] if isinstance(tracks, Track) else list(tracks)
    if not listed:
        raise InputError("there is no track to fit: give one or more")
    for track in listed:
        instance("tracks", track, Track)
    if said := marks_of_one(listed, 2.0 * radius):
        raise InputError(f"{said}: two pucks of radius {radius:g} m are {2.0 * radius:g} m apart")
    names, films = [track.name for track in listed], []
    for n, track in enumerate(listed):
        film = observations_in(track, since, until, keep_all)
        if names.count(track.name) > 1:
            film = replace(film, name=f"{track.name} {n + 1}")
        if rows is not None:
            film = replace(film, row=(rows[0] - film.place[:, 1]) / (rows[0] - rows[1]))
        films.append(film)
        for what, extent, unit in (("places", film.size, "m"), ("times", film.time[-1], "s")):
            if extent and not _NEAREST < extent < _FARTHEST:  # no slide of a puck by its size
                raise InputError(
                    f"{film.name}: its {what} lie up to {extent:.3g} {unit} apart, which no puck "
                    "slides: say their unit, or leave out what is wrong"
                )
        _refuse_still(film, np.nan_to_num(noise_of([film])[0]))
    for one, other in combinations(films, 2):
        _refuse_twice(one, other)
    count = sum(film.time.size for film in films)
    if count > MOST_FRAMES:
        raise InputError(
            f"{count} frames are too many for one fit, {MOST_FRAMES} are enough: give every tenth, "
            "or a part (since, until)"
        )
    return tuple(films)


def refuse_unfit(spec: FitSpec, films: Sequence[Observations], laws: Any) -> None:
    """Refuse tracks that tell nothing of such a puck: of one of another size, or without angles."""
    farthest, radius = max(film.size for film in films), spec.known()["radius"]
    if radius > max(_LARGE, _LARGER * farthest):
        size = f"a radius of {radius:.4g} m"
        if spec.base is not None:
            size = f"base {spec.base.name} goes out to {radius:.4g} m from its centre, which"
        raise InputError(
            f"{size} is beyond a track that goes {farthest:.3g} m: lengths are in metres; write "
            "the unit (--radius 38mm, --base box:20cmx10cm), or say that of the track"
        )
    for film in (film for film in films if film.angle is None):
        if {*MARK} & spec.named:
            raise InputError(
                f"{film.name} has no angles, which a mark off the centre (mark_x, mark_y) needs: "
                "give them (two marks will do)"
            )
        if spec.base is not None:  # how it stands to its velocity tells most
            raise InputError(
                f"{film.name} has no angles: a body on a base slides as it stands to its velocity; "
                "give the angle of its x axis (two marks will do), or the radius of a round puck"
            )
    if laws and spec.base is not None:
        raise InputError("laws are compared of round pucks: leave them out with a base")


def refuse_wobbling(result: Estimate, certainty: Certainty) -> None:
    """Refuse a track of a puck that goes nowhere beyond what any slide leaves of its places."""
    problem = result.problem
    for n, film in enumerate(problem.films):
        speeds = [(n, name) for name in ("launch_vx", "launch_vy")]
        lost = [certainty.undetermined[k] for k, key in enumerate(problem.names) if key in speeds]
        if lost and all(lost):
            _refuse_still(film, problem.noise[0])


def _refuse_still(film: Observations, spread: float) -> None:
    """Refuse a track of a puck that does not leave its place by more than some spread (m)."""
    if rests_from(film, spread) == 0 and not turns(film):
        raise InputError(
            f"the puck of {film.name} lies still, within {1e3 * spread:.3g} mm of noise: a fit "
            "needs a track of a slide or a spin"
        )


def _refuse_twice(one: Observations, other: Observations) -> None:
    """Refuse a film that is given twice: it would count for two."""
    count = min(one.time.size, other.time.size)
    alike = (one.place[:count] == other.place[:count]).all(axis=1)
    if one.straight is not None:  # gates stand where they stand
        alike &= one.time[:count] == other.time[:count]
    frames = [
        set(zip((film.start + film.time).tolist(), *film.place.T.tolist(), strict=True))
        for film in (one, other)
    ]  # fmt: skip
    if max(int(alike.sum()), len(frames[0] & frames[1])) > _TWICE * count:
        raise InputError(
            f"{one.name} and {other.name} show the same frames, which would count twice: give each "
            "film once"
        )


def refuse_tipping(spec: FitSpec, films: tuple[Observations, ...], noise: float) -> None:
    """Refuse a height at which a puck that slows down as these would tip over."""
    known = spec.known()
    if "delta" in spec.named or "height" in spec.free or known["height"] == 0.0:
        return
    decel = known["decel"] if "decel" in spec.fixed else known["friction"] * known["gravity"]
    if {"decel", "friction", "gravity"} & {*spec.free}:
        decel = _SLOWER * min(slowing_of(film, noise) for film in films)
    tilt = 2.0 * decel * known["height"] / (known["gravity"] * known["radius"])
    if tilt > _TIPS:
        raise InputError(
            f"a puck of height {known['height']:g} m and radius {known['radius']:g} m that slows "
            f"down by {decel:.3g} m/s^2 or more would tip over (delta = 2 f h/r > {_TIPS:g}): give "
            "its height and radius in m"
        )


def checked_jitter(raw: Any) -> float | None:
    """The standard deviation of time stamps, s; None if it is to be found, 0 if there is none."""
    if raw is None:
        return 0.0
    if isinstance(raw, str) and raw == FIND:
        return None
    name = f"jitter, if not '{FIND}'," if isinstance(raw, str) else "jitter"
    return positive(name, raw, "s")


def checked_rows(raw: Any) -> tuple[float, float] | None:
    """Y of the first and the last line of a picture, m."""
    if raw is None:
        return None
    first, last = pair_of(
        "rows must be y in m of the first and of the last line of the picture", raw
    )
    first, last = real("the first of rows", first, "m"), real("the last of rows", last, "m")
    if first == last:
        raise InputError(f"rows must be two different places y (m), got {first:g} twice")
    return first, last


def checked_speeds(raw: Any, between: Any) -> tuple[float, ...]:
    """Slip speeds at which friction is found, m/s, none where it does not depend on them."""
    if between not in KINDS:
        raise InputError(f"between must be {' or '.join(KINDS)}, got {between!r:.40}")
    if raw is None:
        return ()
    if isinstance(raw, str) or not isinstance(raw, Iterable):
        raise InputError(f"the slip speeds must be a list of speeds in m/s, got {raw!r:.40}")
    speeds = tuple(real("a slip speed", value, "m/s") for value in raw)
    if not 2 <= len(speeds) <= MOST_NODES or speeds[0] != 0.0 or (np.diff(speeds) <= 0.0).any():
        raise InputError(
            f"the slip speeds must be 2 to {MOST_NODES} speeds in m/s that ascend from 0, got "
            f"{', '.join(f'{speed:g}' for speed in speeds)}"
        )
    return speeds


def refuse_opening(result: Estimate) -> None:
    """Refuse a puck so tall, for the largest friction that was found, that its base opens."""
    problem = result.problem
    numbers = problem.numbers_at(result.x)
    _, delta, _ = problem.spec.scales(numbers)
    largest = float(delta)
    if problem.spec.speeds or problem.spec.law:
        law = problem.spec.speed_law(numbers)
        largest *= float(law.largest(law.top_speed) / law(0.0))
    if largest > 1.0:
        raise InputError(
            f"where friction is largest delta = 2 f h/r is {largest:.4g}: a friction over slip "
            "speed, drags, slopes and belts are found where it is at most 1, so fix a lower height"
        )


def checked_walls(raw: Any) -> tuple[Line, ...]:
    """Walls, each by two points (x, y) m on it."""
    if isinstance(raw, str) or not isinstance(raw, Sequence):
        raise InputError("walls must be a list, each wall two points ((x, y), (x, y)) on it in m")
    lines = []
    for wall in raw:
        what = "a wall must be two points on it in m: ((x, y), (x, y)), or --wall 1.5,0:1.5,2"
        (ax, ay), (bx, by) = (pair_of(what, point) for point in pair_of(what, wall))
        ax, ay, bx, by = (real("a point of a wall", value, "m") for value in (ax, ay, bx, by))
        if (ax, ay) == (bx, by):
            raise InputError(
                f"a wall must be given by two different points, got ({ax:g}, {ay:g}) twice"
            )
        lines.append(((ax, ay), (bx, by)))
    return tuple(lines)


def checked_noise(raw: Any) -> tuple[float | None, float | None]:
    """The noise as given, None for what is to be found."""
    if raw is None:
        return None, None
    place, angle = pair_of(
        "noise must be two numbers, of places (m) and of angles (rad): (0.0003, 0.005), or "
        "--noise 0.3mm,0.3deg (one alone, or None: the other is found)", raw,
    )  # fmt: skip
    return (
        None if place is None else positive("the noise of places", place, "m"),
        None if angle is None else positive("the noise of angles", angle, "rad"),
    )


def begin_jitter(films: tuple[Observations, ...], noise: float) -> float:
    """Jitter of time stamps to begin with, s, where places have so much noise (m)."""
    lengths = [np.hypot(*np.diff(film.place, axis=0).T).sum() for film in films]
    speed = float(sum(lengths)) / sum(float(film.time[-1]) for film in films)
    return _JITTER * noise / max(speed, 1e-9)

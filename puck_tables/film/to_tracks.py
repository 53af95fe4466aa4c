"""From what a file holds to tracks in SI: times, units, axes, marks, and what was not seen."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables._core.units import PIXEL, factor
from puck_tables._core.wording import counted, meant
from puck_tables.errors import InputError
from puck_tables.film.film import Film, Track, TrackedBody, on_the_floor, summed
from puck_tables.film.reader_options import ReaderOptions

_SURE = 1.5  # likelihoods above are no shares of 1, whatever rounding or scoring did
_STAMPED = 1e3  # lengths of a film: a first time that is later is that of a clock
_EPOCH = (5e8, 4e9)  # s since 1970: 1985 to 2096
_SLOW = 1.0  # s between frames: more, and times are hardly in seconds
_FEWEST_STAMPS, _MOST_DIGITS = 6, 12  # of which is told that they round even frames; of each
_WHOLE = 1e-3  # of a unit: so near to whole ones clocks of years are
_FINE, _LOOSE = 1e-3, 1.1  # of a frame: rounding that nobody sees; of the unit: slope of the line
_SKIPS = 1.75  # of a usual step: more, and a frame was left out
_NTSC = 1.001  # 30/1.001 frames a second, and the like


def to_si(path: str | Path, film: Film, how: ReaderOptions) -> tuple[Track, ...]:
    """The tracks of a film.

    Raises InputError if something is left open, contradicts, or is no track.

    >>> marks = {"": np.array([[0.0, 1.0], [2.0, 1.0]])}
    >>> film = Film("table", [TrackedBody("", marks, frame=np.array([0.0, 1.0]))], unit="cm")
    >>> to_si("a.csv", film, ReaderOptions(fps=50.0))[0].place.tolist()
    [[0.0, 0.01], [0.02, 0.01]]
    """
    if any(body.turns for body in film.bodies):
        film.angle_unit = film.angle_unit or "rad"
    film.bodies = [on_the_floor(path, film, body, how.up) for body in film.bodies]
    scaled: list[str] = []
    scale = _Scale(path, film, how, scaled)
    times = [_times(path, film, flat, how) for flat in film.bodies]
    if how.fps is None:
        times = _of_even_frames(times)
    film.bodies = [summed(path, film, flat, time)
                   for flat, (time, _) in zip(film.bodies, times, strict=True)]  # fmt: skip
    notes, tracks, there = [film.kind, *film.notes, *scaled], [], list[str]()
    for body, (time, body_notes) in zip(film.bodies, times, strict=True):
        for mark, (centre, toward) in _pucks(path, film, body, how).items():
            puck = " ".join(filter(None, (body.name, mark)))
            there.append(puck)
            if how.pucks is not None and not {puck, body.name, mark} & set(how.pucks):
                continue
            name = f"{Path(path).name}{f': {puck}' if puck else ''}"
            place, angle, hidden = _visible(path, film, body, centre, toward, how, scale)
            rows = np.flatnonzero(~np.isnan(time))
            if (lost := np.flatnonzero(np.isnan(time) & np.isfinite(place).all(axis=1))).size:
                raise InputError(
                    f"{path}: row {lost[0] + 1} of its numbers has no time: give it one, or leave "
                    "its place empty, too"
                )
            try:
                track = Track(
                    time[rows], place[rows], None if angle is None else angle[rows], name,
                    (*notes, *body_notes, *hidden),
                )  # fmt: skip
            except InputError as error:  # one puck of many may spoil all
                many = len(film.bodies) > 1 and how.pucks is None
                hint = "; or say which pucks to read with pucks (--pucks)" if many else ""
                raise InputError(f"{name}: {error}{hint}") from None
            tracks.append(track)
    words = {part for name in there for part in (name, *name.split(" ", 1))}
    for name in how.pucks or ():
        if name not in words:
            listed = ", ".join(there[:8]) + (", ..." if len(there) > 8 else "")
            raise InputError(
                f"{path} has no puck '{name}'{meant(name, there)}. Its pucks: "
                f"{listed or 'none with a name'}"
            )
    if not tracks:
        raise InputError(f"{path} holds no puck")
    return tuple(tracks)


class _Scale:
    """From the unit and the axes of a file to metres with y to the left of x."""

    def __init__(self, path: str | Path, film: Film, how: ReaderOptions, notes: list[str]) -> None:
        if how.unit is not None and film.unit not in ("", how.unit, PIXEL):
            raise InputError(f"{path} gives places in {film.unit}: leave unit = '{how.unit}' out")
        length_unit = how.unit or (PIXEL if how.size is not None or how.plane is not None else "")
        if length_unit == PIXEL and film.unit not in ("", PIXEL):
            raise InputError(f"{path} gives places in {film.unit}: leave scale and marks out")
        if how.unit not in (None, PIXEL) and film.unit == PIXEL and film.kind == "trackpy table":
            film.unit = ""  # its user may have turned pixels into something else
        if film.unit == PIXEL and length_unit not in ("", PIXEL):
            raise InputError(f"{path} gives places in pixels: give scale or marks instead of unit")
        unit = length_unit or film.unit
        if not unit:
            raise InputError(
                f"{path} does not say the unit of x and y: give unit (--unit cm), or for pixels "
                "scale (--scale 0.5mm, the size of a pixel) or marks (--marks)"
                f"{_besides(film, how)}"
            )
        if unit == PIXEL and how.size is None and how.plane is None:
            raise InputError(
                f"{path} gives places in pixels: give the size of a pixel with scale (--scale "
                f"0.5mm), or four marks on the floor with marks (--marks){_besides(film, how)}"
            )
        self.plane = how.plane
        self.size = factor(unit, "length") if unit != PIXEL else how.size or 1.0
        down = how.y_down if how.y_down is not None else film.y_down
        self.down = self.plane is None and (unit == PIXEL if down is None else down)
        angles = {key for body in film.bodies for key in body.angles}
        self.radians = 1.0
        if angles:
            if film.angle_unit and how.angle_unit not in (None, film.angle_unit):
                raise InputError(f"{path} gives angles in {film.angle_unit}: leave angle_unit out")
            if not (angled := film.angle_unit or how.angle_unit):
                raise InputError(
                    f"{path} does not say the unit of its angles: give angle_unit (--angle-unit "
                    "deg)"
                )
            self.radians = factor(angled, "angle")
        if unit != PIXEL:
            notes.append(f"places in {unit}")
        elif how.size is not None:
            notes.append(f"places in pixels of {how.size * 1e3:.6g} mm")
        if self.plane is not None:
            notes.append(
                f"places in pixels, carried to the floor by {self.plane.count} marks"
                + (f", which they fit to {self.plane.residual * 1e3:.3g} mm"
                   if self.plane.residual else "")
                + ("; y lies to the right of x in the picture: all is seen as in a mirror"
                   if self.plane.mirrored else "")
            )  # fmt: skip
        if self.down:
            notes.append("y grows downwards in the file: y, and angles, are turned over")

    def place(self, points: FloatArray) -> FloatArray:
        """Places (n, 2) in m; NaN where a point is."""
        if self.plane is None:
            return points * [self.size, -self.size if self.down else self.size]
        result = np.full(points.shape, np.nan)
        there = np.isfinite(points).all(axis=1)
        result[there] = self.plane.place(points[there])
        return result

    def angle(self, points: FloatArray, angle: FloatArray) -> FloatArray:
        """Angles (n,) in rad of a body at points (n, 2)."""
        turned = angle * self.radians
        if self.plane is not None:
            return self.plane.angle(points, turned)
        return -turned if self.down else turned


def _besides(film: Film, how: ReaderOptions) -> str:
    """What else a file leaves open, behind what is asked of its places."""
    angled = any(body.angles for body in film.bodies) and not (film.angle_unit or how.angle_unit)
    timed = how.fps is not None or any(body.time is not None for body in film.bodies)
    more = ["angle_unit (--angle-unit deg)"] if angled else []
    more += [] if timed else ["frames a second (--fps 120)"]
    return f"; give {' and '.join(more)}, too" if more else ""


def _times(
    path: str | Path, film: Film, body: TrackedBody, how: ReaderOptions
) -> tuple[FloatArray, list[str]]:
    """Times in s, and what they are from."""
    size = len(next(iter(body.marks.values())))
    for clock in (body.frame, body.time):
        if clock is not None and np.isinf(clock).any():
            raise InputError(f"{path} has times or frame numbers that are no numbers")
    if how.fps is not None:
        if body.frame is not None:
            unused = "; its own times are not used" if body.time is not None else ""
            return body.frame / how.fps, [f"{how.fps:.9g} frames a second, as given{unused}"]
        if body.time is not None:
            raise InputError(f"{path} has times and no frame numbers: leave fps (--fps) out")
        return np.arange(size) / how.fps, [f"each row a frame, {how.fps:.9g} a second, as given"]
    if body.time is None:
        what = "frame numbers and no times" if body.frame is not None else "no times"
        row = "" if body.frame is not None else "; each row is then a frame"
        raise InputError(f"{path} has {what}: give frames a second with fps (--fps 120){row}")
    earliest = float(_all_times(film).min())
    stamps = (one for one in ("s", "ms", "us", "ns")
              if _EPOCH[0] < earliest * factor(one, "time") < _EPOCH[1])  # fmt: skip
    if not film.timed and (unit := next(stamps, "")):  # where no other gives a year of films
        film.timed = True
        film.notes.append(f"times in {unit} since 1970, as their size tells")
        for one in film.bodies:
            one.time = None if one.time is None else one.time * factor(unit, "time")
    there = _all_times(film)
    # a first time far from 0 for so short a film is a stamp: only the time between stamps counts
    first = float(there.min()) if abs(there.min()) > _STAMPED * np.ptp(there) > 0.0 else 0.0
    said = [f"times from its first frame on, {first:.15g} s of its clock"] if first else []
    if film.timed:
        return body.time - first, said
    apart = np.diff(body.time[~np.isnan(body.time)])
    if apart.size and np.median(apart) > _SLOW:
        raise InputError(
            f"{path} does not say the unit of its times, and frames would be "
            f"{np.median(apart):.4g} s apart: say it in the header, or with columns "
            "(--columns 't [ms],x,y')"
        )
    return body.time - first, ["times taken as seconds, of which the file says nothing", *said]


def _of_even_frames(
    times: list[tuple[FloatArray, list[str]]],
) -> list[tuple[FloatArray, list[str]]]:
    """Stamps that round the times of even frames become these: rounding is no jitter."""

    def are_whole(unit: npt.ArrayLike) -> bool:
        return bool((np.abs(stamps / unit - np.rint(stamps / unit)) < _WHOLE).all())

    stamps = np.unique(np.concatenate([time[~np.isnan(time)] for time, _ in times]))
    if stamps.size < _FEWEST_STAMPS:
        return times
    steps, size = np.diff(stamps), np.maximum(np.abs(stamps), np.diff(stamps).min())
    usual = float(steps[steps < _SKIPS * np.median(steps)].mean())
    units = (10.0 ** (np.floor(np.log10(size)) - digits) for digits in range(_MOST_DIGITS))
    unit = next((one.max() for one in units if are_whole(one.max()) or are_whole(one)), 0.0)
    frame = np.append(0.0, np.cumsum(np.maximum(np.rint(steps / usual), 1.0)))
    apart = frame - frame.mean()
    step = float(apart @ stamps / (apart @ apart))
    off, spread = np.ptp(stamps - step * frame), unit / math.sqrt(12.0 * float(apart @ apart))
    if unit < _FINE * usual or not _FINE * unit < off < _LOOSE * unit:
        return times
    rates = np.maximum([np.rint(1.0 / step), np.rint(_NTSC / step) / _NTSC], 1.0)
    usual = float(1.0 / rates[np.abs(1.0 / rates - step).argmin()])
    step = usual if abs(usual - step) < 3.0 * spread else step
    even = stamps[0] + step * frame
    note = f"times are rounded to {unit:.3g} s: taken as even, {1.0 / step:.6g} frames a second"
    even = np.append(even, np.nan)  # of what is no number, behind all stamps
    return [(even[np.searchsorted(stamps, time)], [*notes, note]) for time, notes in times]


def _all_times(film: Film) -> FloatArray:
    """The times of all bodies, 0 if there are none."""
    times = [body.time[np.isfinite(body.time)] for body in film.bodies if body.time is not None]
    there = np.concatenate([*times, np.empty(0)])
    return there if there.size else np.zeros(1)


def _alike(names: Sequence[str], wanted: Sequence[str]) -> dict[str, dict[str, str]]:
    """Pucks that have each of these marks under a name that is longer by the puck's, by puck.

    >>> _alike(["cm1", "ed1", "cm2", "ed2"], ["cm", "ed"])
    {'1': {'cm': 'cm1', 'ed': 'ed1'}, '2': {'cm': 'cm2', 'ed': 'ed2'}}
    """
    pucks: dict[str, dict[str, str]] = {}
    for mark in wanted:
        for name in names:
            if name != mark and (name.startswith(mark) or name.endswith(mark)):
                rest = name.removeprefix(mark) if name.startswith(mark) else name[: -len(mark)]
                pucks.setdefault(rest.strip(" _-.:"), {})[mark] = name
    return {
        puck: marks for puck, marks in sorted(pucks.items()) if len(marks) == len({*wanted})
    }  # fmt: skip


def _centre_and_toward(names: Sequence[str]) -> tuple[str, str]:
    """Marks to give as an example: those that several pucks have, or the first two."""
    stems = dict.fromkeys(name.strip("0123456789 _-.:") for name in names)
    first = [stem for stem in stems if stem and len(_alike(names, [stem])) > 1]
    both = (first[0], first[1]) if len(first) > 1 else (names[0], names[1])
    return both if len(_alike(names, both)) > 1 else (names[0], names[1])


def _pucks(
    path: str | Path, film: Film, body: TrackedBody, how: ReaderOptions
) -> dict[str, tuple[Sequence[str], str | None]]:  # fmt: skip
    """The pucks of a body by name: marks in whose middle each has its centre, that it points to."""
    names = list(body.marks)
    if how.centre is not None:
        wanted = [*how.centre, *([how.toward] if how.toward else [])]
        if not {*wanted} <= {*names} and (pucks := _alike(names, wanted)):
            return {
                puck: ([marks[one] for one in how.centre], marks.get(how.toward or ""))
                for puck, marks in pucks.items()
            }
        for name in wanted:
            if name not in names:
                raise InputError(
                    f"{path} has no mark '{name}'{meant(name, names)}. Its marks: "
                    f"{', '.join(filter(None, names[:8])) or 'none with a name'}"
                )
        return {"": (how.centre, how.toward)}
    named = {*names, *(f"{body.name} {mark}" for mark in names)} & {*(how.pucks or ())}
    if len(names) > 1 and film.jointed and not named:
        centre, toward = _centre_and_toward(names)
        raise InputError(
            f"{path} has the marks {', '.join(names[:8])}: if they are on one puck, or alike on "
            f"several, say which is its centre, or which are around it, and where its angle "
            f"points, with centre and toward (--centre {centre} --toward {toward}); if each is a "
            f"puck, name them with pucks (--pucks {','.join(names[:2])})"
        )
    if len(names) == 1 and body.name:
        return {"": (names, None)}
    return {name: ([name], None) for name in names}


def _visible(
    path: str | Path, film: Film, body: TrackedBody, centre: Sequence[str], toward: str | None,
    how: ReaderOptions, scale: _Scale,
) -> tuple[FloatArray, FloatArray | None, list[str]]:  # fmt: skip
    """Place and angle of a puck with NaN where it was not seen."""
    used = [*centre, *([toward] if toward else [])]
    shown = np.ones(len(body.marks[centre[0]]), bool)
    for mark in used:
        for name in ("", mark):
            if name in body.seen:
                shown &= body.seen[name]
    notes = []
    bound = film.likely if how.likelihood is None else how.likelihood
    likely = [body.likelihoods[m] for m in {*used, ""} if m in body.likelihoods]
    if how.likelihood is not None and not likely:
        raise InputError(f"{path} has no likelihoods: leave likelihood (--likelihood) out")
    if bound is not None and likely:
        highest = max(float(one[np.isfinite(one)].max(initial=0.0)) for one in likely)
        if highest > _SURE:
            raise InputError(
                f"{path} has likelihoods of up to {highest:.6g}: they must be 0 to 1; leave their "
                "column out with - in columns (--columns)"
            )
        faint = shown & ~np.all([one >= bound for one in likely], axis=0)
        shown &= ~faint
        count = int(np.count_nonzero(faint))
        notes.append(f"{counted(count, 'frame')} less likely than {bound:g} left out")
    points = {mark: np.where(shown[:, None], body.marks[mark], np.nan) for mark in used}
    places = {mark: scale.place(point) for mark, point in points.items()}
    place: FloatArray = np.mean([places[mark] for mark in centre], axis=0)
    if toward is not None:
        return place, direction(place, places[toward]), notes
    angle = _angle_column(path, body, centre)
    if angle is None:
        return place, None, notes
    middle: FloatArray = np.mean([points[mark] for mark in centre], axis=0)
    there = np.isfinite(middle).all(axis=1)
    turned = np.full(angle.shape, np.nan)
    turned[there] = scale.angle(middle[there], angle[there])
    return place, turned, notes


def _angle_column(path: str | Path, body: TrackedBody, centre: Sequence[str]) -> FloatArray | None:
    """The angles that are of a puck."""
    if not body.angles:
        return None
    for mark in centre:
        if mark in body.angles:
            return body.angles[mark]
    if len(body.marks) == 1 or len(centre) == len(body.marks):
        if len(body.angles) > 1 and "" not in body.angles:
            raise InputError(
                f"{path} has several columns of angles of one puck ({', '.join(body.angles)}): "
                "leave all but one out with - in columns (--columns)"
            )
        return body.angles.get("", next(iter(body.angles.values())))
    if "" in body.angles:
        raise InputError(
            f"{path} has angles and several pucks: say whose they are, with columns (--columns) "
            "such as t,red_x,red_y,red_angle"
        )
    return None


def direction(start: FloatArray, end: FloatArray) -> FloatArray:
    """The angle of the line from one mark to another, counter-clockwise from x, (n,) in rad.

    >>> direction(np.array([[0.0, 0.0]]), np.array([[0.0, 2.0]])).round(6).tolist()
    [1.570796]
    """
    apart = end - start
    angle: FloatArray = np.arctan2(apart[:, 1], apart[:, 0])
    angle[(apart == 0.0).all(axis=1)] = np.nan  # two marks at one place have no direction
    return angle

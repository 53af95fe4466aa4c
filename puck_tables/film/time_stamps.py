"""When the frames of a film are: by their numbers, by their times, even where these are rounded."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables._core.units import factor
from puck_tables.errors import InputError
from puck_tables.film.film import Film, TrackedBody
from puck_tables.film.reader_options import ReaderOptions

_STAMPED = 1e3  # lengths of a film: a first time that is later is that of a clock
_EPOCH = (5e8, 4e9)  # s since 1970: 1985 to 2096
_SLOW = 1.0  # s between frames: more, and times are hardly in seconds
_FEWEST_STAMPS, _MOST_DIGITS = 6, 12  # of which is told that they round even frames; of each
_TELLING = 3  # of the farthest stamps, where nearer ones have more digits behind the point
_WHOLE = 1e-3  # of a unit: so near to whole ones clocks of years are
_FINE, _LOOSE = 1e-3, 1.1  # of a frame: rounding that nobody sees; of the unit: slope of the line
_SKIPS = 1.75  # of a usual step: more, and a frame was left out
_NTSC, _LIKELY = 1.001, 3.0  # 30/1.001 frames a second, and the like; of the step's deviation


def times_of(
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
        even = np.arange(size) / how.fps
        words = f"each row a frame, {how.fps:.9g} a second, as given"
        if body.time is None:
            return even, [words]
        known = ~np.isnan(body.time)
        if known.any() and not (
            np.ptp((body.time - even)[known]) <= _LOOSE * _unit_of(np.unique(body.time[known]))
        ):
            raise InputError(
                f"{path} has times, and they are not those of {how.fps:.9g} frames a second, one a "
                "row: leave fps (--fps) out; or leave the times out where they are wrong, as of a "
                "film that is played slowly (--columns with - for them)"
            )
        return even, [f"{words}; its own times are not used"]
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


def _unit_of(stamps: FloatArray) -> float:
    """The power of ten that all of some ascending stamps are whole multiples of, to so many digits.

    >>> [round(_unit_of(np.array(s)), 9) for s in ([0.0, 0.033, 0.133], [0.3333, 1.1, 1.2, 1.667])]
    [0.001, 0.001]
    """

    def are_whole(unit: FloatArray | float) -> bool:
        return bool((np.abs(stamps / unit - np.rint(stamps / unit)) < _WHOLE).all())

    size = np.abs(stamps)
    size[size == 0.0] = size.max() or 1.0
    units = (10.0 ** (np.floor(np.log10(size)) - digits) for digits in range(_MOST_DIGITS))
    tell = (float(one.max()) for one in units if are_whole(one.max())
            or (are_whole(one) and np.count_nonzero(one == one.max()) >= _TELLING))  # fmt: skip
    return next(tell, 0.0)


def of_even_frames(
    times: list[tuple[FloatArray, list[str]]],
) -> list[tuple[FloatArray, list[str]]]:
    """Stamps that round the times of even frames become these: rounding is no jitter."""
    stamps = np.unique(np.concatenate([time[~np.isnan(time)] for time, _ in times]))
    if stamps.size < _FEWEST_STAMPS:
        return times
    steps, unit = np.diff(stamps), _unit_of(stamps)
    usual = float(steps[steps < _SKIPS * np.median(steps)].mean())
    frame = np.append(0.0, np.cumsum(np.maximum(np.rint(steps / usual), 1.0)))
    apart = frame - frame.mean()
    step = float(apart @ stamps / (apart @ apart))
    off, spread = np.ptp(stamps - step * frame), unit / math.sqrt(12.0 * float(apart @ apart))
    if unit < _FINE * usual or not _FINE * unit < off < _LOOSE * unit:
        return times
    rates = np.maximum([np.rint(1.0 / step), np.rint(_NTSC / step) / _NTSC], 1.0)
    nominal = float(1.0 / rates[np.abs(1.0 / rates - step).argmin()])
    step = nominal if abs(nominal - step) < _LIKELY * spread else step
    even = stamps[0] + step * frame
    note = f"times are rounded to {unit:.3g} s: taken as even, {1.0 / step:.6g} frames a second"
    even = np.append(even, np.nan)  # of what is no number, behind all stamps
    return [(even[np.searchsorted(stamps, time)], [*notes, note]) for time, notes in times]


def _all_times(film: Film) -> FloatArray:
    """The times of all bodies, 0 if there are none."""
    times = [body.time[np.isfinite(body.time)] for body in film.bodies if body.time is not None]
    there = np.concatenate([*times, np.empty(0)])
    return there if there.size else np.zeros(1)

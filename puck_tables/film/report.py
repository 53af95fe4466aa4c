"""What was read of a track, in sentences, and tracks as a table in SI."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables._core.wording import counted
from puck_tables.film.film import Track
from puck_tables.io.columns import Dataset, variable

_GAP = 1.5  # of the usual time from frame to frame
_JITTER = 0.01  # of a frame: less is rounding of stamps
_LEAP = 6.0  # of what it moves in frames near by
_OPPOSITE = 1.5  # of 2: a frame is that much against those beside
_FEW = 0.25  # of all frames
_NEAR = 7  # frames: three strays do not move their median


def described(track: Track) -> list[str]:
    """What a track holds, and what in it looks odd.

    >>> track = Track([0.0, 0.1, 0.2], [[0.0, 0.0], [0.2, 0.1], [0.4, 0.1]], name="a.csv")
    >>> print(*described(track), sep=chr(10))
    a.csv
      frames  3 from 0 s to 0.2 s, 10 a second; the puck is seen in all
      place   x from 0 m to 0.4 m, y from 0 m to 0.1 m
      angle   none
    """
    lines = [track.name, f"  frames  {_frames(track)}"]
    known = track.place[track.seen]
    (x0, y0), (x1, y1) = known.min(axis=0), known.max(axis=0)
    lines.append(f"  place   x from {x0:.6g} m to {x1:.6g} m, y from {y0:.6g} m to {y1:.6g} m")
    turned = 0 if track.angle is None else int(np.isfinite(track.angle).sum())
    lines.append("  angle   " + (f"seen in {counted(turned, 'frame')}" if turned else "none"))
    lines += [f"  hidden  {words}" for words in _hidden(track)]
    lines += [
        f"  odd     {words}" for words in [*_steps(track), *_leaps(track), *_exchanged(track)]
    ]
    if track.notes:
        lines.append(f"  read    {'; '.join(track.notes)}")
    return lines


def _frames(track: Track) -> str:
    size, seen = track.time.size, int(track.seen.sum())
    steps = np.diff(track.time)
    usual = steps[np.abs(steps - np.median(steps)) < 0.1 * np.median(steps)]
    rate = 1.0 / float(usual.mean())  # the mean of those without a gap: times may be rounded
    share = "all" if seen == size else f"{seen} ({100.0 * seen / size:.4g} %)"
    return (
        f"{size} from {track.time[0]:.6g} s to {track.time[-1]:.6g} s, {rate:.6g} a second; the "
        f"puck is seen in {share}"
    )


def _hidden(track: Track) -> list[str]:
    """The longest time in which the puck is not seen."""
    lost = np.flatnonzero(~track.seen)
    if not lost.size:
        return []
    runs = np.split(lost, np.flatnonzero(np.diff(lost) > 1) + 1)
    longest = max(runs, key=len)
    return [
        f"{counted(lost.size, 'frame')} in {counted(len(runs), 'stretch', 'stretches')}, the "
        f"longest from {track.time[longest[0]]:.6g} s to {track.time[longest[-1]]:.6g} s"
    ]


def _steps(track: Track) -> list[str]:
    """Times that are missing, or not evenly apart."""
    steps = np.diff(track.time)
    usual = float(np.median(steps))
    wide = np.flatnonzero(steps > _GAP * usual)
    result = []
    if wide.size:
        at = wide[np.argmax(steps[wide])]
        result.append(
            f"{counted(wide.size, 'gap')} in its times, the longest of {steps[at]:.4g} s after "
            f"{track.time[at]:.6g} s"
        )
    even = steps[steps <= _GAP * usual]
    jitter = float(np.sqrt(np.mean((even / usual - 1.0) ** 2)))
    if jitter > _JITTER:
        result.append(f"times from frame to frame vary by {100.0 * jitter:.3g} % (rms), kept so")
    return result


def _leaps(track: Track) -> list[str]:
    """Frames to which it moves much farther than to those near by: it was taken for another."""
    place, time = track.place[track.seen], track.time[track.seen]
    if len(place) < _NEAR:
        return []
    speed = np.hypot(*np.diff(place, axis=0).T) / np.diff(time)
    padded = np.pad(speed, _NEAR // 2, mode="edge")
    windows = np.lib.stride_tricks.sliding_window_view(padded, _NEAR)
    near: FloatArray = np.median(windows, axis=1)
    floor = float(np.median(speed))  # at rest every step is a leap
    leaps = np.flatnonzero(speed > _LEAP * np.maximum(near, floor))
    if not leaps.size:
        return []
    at = leaps[np.argmax(speed[leaps])]
    apart = float(np.hypot(*(place[at + 1] - place[at])))
    return [
        f"{counted(leaps.size, 'leap')}, the farthest of {apart:.4g} m before "
        f"{time[at + 1]:.6g} s: was something else taken for the puck?"
    ]


def _exchanged(track: Track) -> list[str]:
    """Frames that are half a turn off those beside: two marks were taken for each other."""
    if track.angle is None:
        return []
    time, angle = track.time[track.seen], np.exp(1j * track.angle[track.seen])
    neighbours = angle[2:] + angle[:-2]
    off = np.flatnonzero((angle[1:-1] * neighbours.conj()).real < -_OPPOSITE)
    if not off.size or off.size > _FEW * neighbours.size:  # fast ones are opposite all along
        return []
    return [
        f"{counted(off.size, 'angle')} half a turn off those beside, the first at "
        f"{time[1 + off[0]]:.6g} s: were two marks taken for each other?"
    ]


def dataset(tracks: Sequence[Track]) -> Dataset:
    """Tracks as one table, a row a frame: name (of several), time, x, y and orientation in SI.

    >>> track = Track([0.0, 0.1], [[0.0, 0.0], [0.2, 0.1]])
    >>> list(dataset([track]).columns)
    ['time', 'x', 'y']
    """
    place = np.concatenate([track.place for track in tracks])
    time = np.concatenate([track.time for track in tracks])
    columns = {"time": time, "x": place[:, 0], "y": place[:, 1]}
    if any(track.angle is not None for track in tracks):
        columns["orientation"] = np.concatenate([
            np.full(track.time.size, np.nan) if track.angle is None else track.angle
            for track in tracks
        ])  # fmt: skip
    named = {name: variable(name, values, ("row",)) for name, values in columns.items()}
    if len(tracks) > 1:
        names = [track.name for track in tracks for _ in range(track.time.size)]
        named = {"name": variable("name", names, ("row",)), **named}
    return Dataset({}, named, {"title": "tracks of pucks"})

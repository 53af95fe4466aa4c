"""What a file holds before anything is done to it, and the tracks of pucks that it becomes.

A file holds marks on bodies, frame by frame; two tracks may be two marks on one puck.  Of what was
followed in space a puck on a floor has places without height and turns about the vertical; of what
is known by its velocities or spins, these are summed over time.
"""

from __future__ import annotations

import codecs
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from itertools import combinations
from pathlib import Path
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray, real_array
from puck_tables._core.text import encoding_of
from puck_tables.errors import InputError

Flags = npt.NDArray[np.bool_]


@dataclass
class TrackedBody:
    """The rows of one body: a puck, or marks of which each is one.

    ``name``: '' where the file has none; ``marks``: places (n, 2) or (n, 3) by the names of the
    marks, in the unit and along the axes of the file; ``frame`` (n,): numbers; ``time`` (n,): s;
    ``angles`` (n,) of the body that a mark is of, in the unit of the file, under '' of all; the
    same for how likely a place is, whether it is one, and quaternions (n, 4) x, y, z, w.
    """

    name: str
    marks: dict[str, FloatArray]
    frame: FloatArray | None = None
    time: FloatArray | None = None
    angles: dict[str, FloatArray] = field(default_factory=dict)
    likelihoods: dict[str, FloatArray] = field(default_factory=dict)
    seen: dict[str, Flags] = field(default_factory=dict)
    turns: dict[str, FloatArray] = field(default_factory=dict)


@dataclass
class Film:
    """All bodies of a file, and what it says of them.

    ``kind``: of file, for messages; ``unit``, ``angle_unit``: '' where it does not say; ``y_down``:
    whether y grows downwards, None where it does not say; ``jointed``: whether the marks of a body
    are parts of it rather than pucks of their own; ``timed``: whether it names the unit of its
    times; ``likely``: the likelihood below which the writer of such files takes a place for none;
    ``up``: the axis of places in space that points up, '' where it does not say; ``rates``: whether
    velocities, or spins, stand in place of places and angles; ``notes``: what was found.
    """

    kind: str
    bodies: list[TrackedBody]
    unit: str = ""
    angle_unit: str = ""
    y_down: bool | None = None
    jointed: bool = False
    timed: bool = True
    likely: float | None = None
    up: str = ""
    rates: str = ""
    notes: list[str] = field(default_factory=list)

    def note(self, text: str) -> None:
        """Put a sentence to its notes, once."""
        if text not in self.notes:
            self.notes.append(text)


class Reader(NamedTuple):
    """A format of tracks that is no table of text.

    By the path of a file and how it begins, ``opens``: whether it is of it; ``film_of``: what it
    holds; or ``as_text``: a table of text that holds the same, which is then read as any other.
    """

    opens: Callable[[str | Path, bytes], bool]
    film_of: Callable[[str | Path, bytes], Film] | None = None
    as_text: Callable[[str | Path, bytes], bytes] | None = None


def first_text(path: str | Path, head: bytes) -> str:
    """What a file begins with, where it is a text that begins with a sign of XML or JSON.

    >>> first_text("a.trk", b" <object/>"), first_text("a.csv", b"t,x,y")
    ('<object/>', '')
    """
    signs = (b"<", b"{", b"[", codecs.BOM_UTF8, b"\xff\xfe", b"\xfe\xff")
    if not head[:400].lstrip().startswith(signs):
        return ""
    return head[:400].decode(encoding_of(path, head), errors="ignore").lstrip("\ufeff \t\r\n")


_KEPT = 0.05  # of their distance, by which that of two marks varies
_MOVED = 2.0  # times their distance: how far they go
_FEWEST, _MOST = 8, 30  # frames; tracks that are compared


@dataclass(frozen=True, eq=False)
class Track:
    """Where one puck was seen at what times.

    Parameters
    ----------
    time : array_like (n,), s, increasing
    place : array_like (n, 2), m
        x and y of the centre, y to the left of x (up on a picture); NaN where it was not seen.
    angle : array_like (n,), rad, optional
        Of the body, counter-clockwise, up to whole turns; NaN where it was not seen.
    name : str
        For reports: the file and the puck in it.
    notes : sequence of str
        How it was read, in sentences: what the file said, and what was done to it.

    Raises
    ------
    InputError
        If shapes differ, times do not increase or are not finite, places or angles are infinite,
        or the puck was seen in fewer than two frames.

    Examples
    --------
    >>> Track([0.0, 0.1], [[0.0, 0.0], [0.2, 0.0]], name="a").seen.tolist()
    [True, True]
    """

    time: FloatArray
    place: FloatArray
    angle: FloatArray | None = None
    name: str = "track"
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        time = real_array("time", self.time, "s")
        place = real_array("place", self.place, "m")
        if time.ndim != 1 or place.shape != (time.size, 2):
            raise InputError(
                f"time and place must be (n,) and (n, 2), got {time.shape} and {place.shape}"
            )
        if not np.isfinite(time).all():
            raise InputError("time must be finite")
        back = np.flatnonzero(np.diff(time) <= 0.0)
        if back.size:
            n = int(back[0]) + 1
            raise InputError(
                f"time must increase, but frame {n + 1} stands at {time[n]:.9g} s after "
                f"{time[n - 1]:.9g} s: sort the frames, or leave out the one that is twice"
            )
        angle: npt.NDArray[np.float64] | None = None
        if self.angle is not None:
            angle = real_array("angle", self.angle, "rad")
            if angle.shape != time.shape:
                raise InputError(f"angle must be ({time.size},) as time is, got {angle.shape}")
        endless = np.isinf(place).any(axis=1)
        endless |= False if angle is None else np.isinf(angle)
        if endless.any():
            raise InputError(
                f"the place or the angle of frame {int(endless.argmax()) + 1} is infinite: give a "
                "number, or NaN where none was seen"
            )
        fields = {"time": time, "place": place, "angle": angle, "notes": tuple(self.notes)}
        for name, value in fields.items():
            object.__setattr__(self, name, value)
        if (seen := int(np.count_nonzero(self.seen))) < 2:
            raise InputError(
                f"a track needs two frames or more where the puck is seen, here are {seen}"
            )

    @property
    def along_line(self) -> bool:
        """Whether all places have the same x, or the same y: of a track along a line."""
        known = self.place[self.seen]
        return bool((np.ptp(known, axis=0) == 0.0).any())

    @property
    def seen(self) -> npt.NDArray[np.bool_]:
        """Frames (n,) where the place is known."""
        return np.isfinite(self.place[:, 0] + self.place[:, 1])


def marks_of_one(tracks: Sequence[Track], nearest: float = np.inf) -> str:
    """A sentence if two tracks look like marks on one puck; empty if none do.

    ``nearest`` m: as far apart as two pucks are at least.

    >>> t = np.arange(20.0)
    >>> one, two = (Track(t, np.stack([t, 0.0 * t + y], axis=1), name=f"a: {y}") for y in (0, 1))
    >>> marks_of_one([one, two])[:66]
    'a: 0 and a: 1 keep a distance of 1 m: they look like two marks on '
    """
    for one, two in combinations(tracks[:_MOST], 2):
        _, first, second = np.intersect1d(one.time, two.time, return_indices=True)
        here, there = one.place[first], two.place[second]
        apart = np.hypot(*(here - there).T)
        known = np.isfinite(apart)
        if known.sum() < _FEWEST:
            continue
        usual = float(np.median(apart[known]))
        kept = float(np.median(np.abs(apart[known] - usual))) <= _KEPT * usual
        moved = float(np.ptp(here[known], axis=0).max()) > _MOVED * usual
        if kept and moved and 0.0 < usual < nearest:
            names = [track.name.rpartition(": ")[2] for track in (one, two)]
            return (
                f"{one.name} and {two.name} keep a distance of {usual:.3g} m: they look like two "
                f"marks on one puck, whose centre and angle they tell with centre and toward "
                f"(--centre {','.join(names)} --toward {names[0]})"
            )
    return ""


PLACES, ANGLES = "velocities", "spins"
NO_ACCELERATIONS = (
    "holds accelerations, which tell no place: an offset of a hundredth of g is 5 cm after 1 s and "
    "half a metre after 3 s, and a tilt of half a degree is such an offset. Film it, or log the "
    "gyroscope, whose spin over time is read"
)
_WORDS = {
    PLACES: "places summed from velocities, from (0, 0) on: their errors add up, so that errors of "
    "a fit are too small",
    ANGLES: "angles summed from spins; no places are told, it is taken to spin in place",
}
UPS = ("x", "y", "z")
_FLOOR = {"x": ((1, 1.0), (2, 1.0)), "y": ((0, 1.0), (2, -1.0)), "z": ((0, 1.0), (1, 1.0))}
_RISES = 0.2  # of the way along the floor: more is no floor
_STIRS = 0.01  # of the farthest coordinate: less is no way up or down
_UPSIDE = 0.5 * np.pi  # rad of tilt: that is another order of the four numbers
_ENDS = (2.0, 98.0)  # percent of the frames: lost marks are found anywhere


def summed(path: str | Path, film: Film, body: TrackedBody, time: FloatArray) -> TrackedBody:
    """A body with places from velocities, or angles from spins; as it is if it has them itself.

    By the trapezoidal rule, over frames where none is told as between those beside them.

    >>> body = TrackedBody("", {"": np.array([[2.0, 0.0], [2.0, 0.0], [1.0, 0.0]])})
    >>> film = Film("table", [body], rates=PLACES)
    >>> summed("a.csv", film, body, np.array([0.0, 0.5, 1.0])).marks[""][:, 0].tolist()
    [0.0, 1.0, 1.75]
    """
    if not film.rates:
        return body
    film.note(_WORDS[film.rates])

    def over_time(rates: FloatArray) -> FloatArray:
        known = np.isfinite(rates) & np.isfinite(time)
        if known.sum() < 2:
            raise InputError(f"{path} tells fewer than two {film.rates}")
        steps = np.diff(time[known])
        result = np.full(rates.shape, np.nan)
        result[known] = np.cumsum([0.0, *(0.5 * steps * (rates[known][1:] + rates[known][:-1]))])
        return result

    if film.rates == ANGLES:
        return replace(body, angles={name: over_time(one) for name, one in body.angles.items()})
    return replace(body, marks={
        name: np.stack([over_time(one) for one in points.T], axis=1)
        for name, points in body.marks.items()
    })  # fmt: skip


def on_the_floor(path: str | Path, film: Film, body: TrackedBody, up: str | None) -> TrackedBody:
    """A body with places (n, 2) and angles about the vertical, of one with places (n, 3) perhaps.

    ``film``: of which it is one, to which notes are put; ``up``: the axis that points up; None as
    the file, or most files, have it.

    >>> body = TrackedBody("", {"": np.array([[0.0, 1.0, 9.0], [2.0, 1.0, 8.0], [4.0, 1.0, 7.0]])})
    >>> on_the_floor("a.csv", Film("table", [body], up="y"), body, None).marks[""].tolist()
    [[0.0, -9.0], [2.0, -8.0], [4.0, -7.0]]
    """
    axis = up or film.up or "z"
    at = UPS.index(axis)
    marks = {}
    for name, points in body.marks.items():
        if points.shape[1] == 2:
            marks[name] = points
            continue
        flat = np.stack([sign * points[:, k] for k, sign in _FLOOR[axis]], axis=1)
        rise = _span(points[:, at])
        far = float(np.abs(points[np.isfinite(points)]).max(initial=0.0))
        length = max(_span(one) for one in flat.T)
        if up is None and rise > max(_RISES * length, _STIRS * far):
            raise InputError(
                f"{path} is of places in space, and {' '.join(filter(None, (body.name, name)))} "
                f"goes up and down by {rise:.3g} if {axis} points up: say which axis does (--up "
                f"{'y' if axis == 'z' else 'z'})"
            )
        marks[name] = flat
    if any(one.shape[1] == 3 for one in body.marks.values()):
        film.note(f"places in space, {axis} up: height left out (--up)")
    angles = dict(body.angles)
    for name, turns in body.turns.items():
        angles[name], tilt = about_vertical(turns, at)
        if not np.isfinite(tilt):
            raise InputError(f"{path}: its quaternions are all 0: leave them out (--columns)")
        film.note(
            f"angles about the vertical from quaternions, tilted by {np.degrees(tilt):.2g} degrees "
            "(median)"
        )
    return replace(body, marks=marks, angles=angles, turns={})


def about_vertical(turns: FloatArray, up: int = 2) -> tuple[FloatArray, float]:
    """The angle (n,) about an axis of quaternions (n, 4), x, y, z, w; and the median tilt, rad.

    A turn is one about the axis (twist), then one about a level axis, by the tilt (swing).  Where
    the order w, x, y, z has by far less tilt it is that.

    >>> angle, tilt = about_vertical(np.array([[0.0, 0.0, 0.6, 0.8], [0.0, 0.0, -0.6, -0.8]]))
    >>> np.unwrap(angle).round(4).tolist(), tilt
    ([1.287, 1.287], 0.0)
    """
    level = [k for k in range(3) if k != up]

    def read(q: FloatArray) -> tuple[FloatArray, float]:
        tilts = 2.0 * np.arctan2(np.hypot(*q[:, level].T), np.hypot(q[:, up], q[:, 3]))
        there = np.abs(q).sum(axis=1) > 0.0
        angle = np.where(there, 2.0 * np.arctan2(q[:, up], q[:, 3]), np.nan)
        return angle, float(np.median(tilts[there])) if there.any() else np.nan

    one, other = read(turns), read(np.roll(turns, -1, axis=1))
    return other if one[1] > _UPSIDE > 3.0 * other[1] else one


def _span(values: FloatArray) -> float:
    """How far values go, but for a few."""
    known = values[np.isfinite(values)]
    return float(np.diff(np.percentile(known, _ENDS))[0]) if known.size else 0.0

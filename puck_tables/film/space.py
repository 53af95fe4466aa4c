"""Places and turns on a floor of what was followed in space, or known by its velocities or spins.

In space they are taken without height and about the vertical; velocities are summed over time.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.errors import InputError
from puck_tables.film.film import Film, TrackedBody

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
        way = max(_span(one) for one in flat.T)
        if up is None and rise > max(_RISES * way, _STIRS * far):
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

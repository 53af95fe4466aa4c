"""The range in which each unknown is looked for: what physics and the film leave of it.

Where a film does not tell a number, or another law moves its puck, a fit runs away along what all
looks alike: a puck that turns ever faster under ever more friction slows down as drag does.  A
launch is no farther from the track than its size, no faster than the track by far, and its spin is
of a body that somebody filmed.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.fitting.asked import Asked
from puck_tables.fitting.parameters import LAUNCH, MOST, WALL
from puck_tables.fitting.seen import Seen

_DRAGGED = 100.0  # drag times the length of a film: nothing, or all there is, is left of a speed
_FASTER = 10.0  # times the fastest that a track goes from frame to frame
_RIM = 100.0  # times that speed: the rim, without angles
_TURNS = 20.0  # a frame, with angles
_PRIOR = 8.0  # standard deviations of a prior
_PLACES = ("launch_x", "launch_y")
_SPEEDS = ("launch_vx", "launch_vy")


def limits_of(
    asked: Asked, films: Sequence[Seen], names: Sequence[tuple[int, str]], tall: bool
) -> tuple[FloatArray, FloatArray]:
    """The least and the largest value of each unknown (m,), ``names`` as of a problem.

    No δ is higher than motions of such a puck are known; bounds of the caller's are taken as they
    are, and his start and prior lie within.
    """
    pairs = []
    for track, name in names:
        low, high = asked.limits(name)
        if name == "delta":
            high = min(high, asked.highest(tall))
        elif name in ("friction", "decel"):
            high = min(high, asked.steepest(name))
        elif name == "drag":
            most = min(_DRAGGED / max(float(film.time[-1]) for film in films), MOST["drag"])
            low, high = max(low, -most), min(high, most)
        elif name not in asked.bounds and name in (*LAUNCH, *WALL):
            own = films if track < 0 else [films[track]]
            low, high = _of_films(name, own, asked.puck.radius)
            wanted = [asked.start[name]] if name in asked.start else []
            if name in asked.priors:
                value, spread = asked.priors[name]
                wanted += [value - _PRIOR * spread, value + _PRIOR * spread]
            low, high = min([low, *wanted]), max([high, *wanted])
        pairs.append((low, high))
    ends = np.array(pairs).reshape(-1, 2)
    return ends[:, 0], ends[:, 1]


def _of_films(name: str, films: Sequence[Seen], radius: float) -> tuple[float, float]:
    """The range of a number of a launch, or of a wall that the pucks of some tracks meet."""
    place = np.concatenate([film.place for film in films])
    size = max(float(np.ptp(place, axis=0).max()), radius)
    if name in _PLACES:
        along = place[:, _PLACES.index(name)]
        return float(along.min()) - size, float(along.max()) + size
    if name == "wall_distance":
        most = float(np.hypot(*place.T).max()) + size + 2.0 * radius
        return -most, most
    fastest = max(
        float((np.hypot(*np.diff(film.place, axis=0).T) / np.diff(film.time)).max())
        for film in films
    )  # fmt: skip
    fastest = max(fastest, 1e-3 * radius / max(float(film.time[-1]) for film in films))
    if name in _SPEEDS:
        return -_FASTER * fastest, _FASTER * fastest
    if name == "launch_spin":
        most = _RIM * fastest / radius
        for film in films:
            if film.angle is not None:
                most = max(most, 2.0 * math.pi * _TURNS / film.usual_step)
        return -most, most
    return -math.inf, math.inf  # an angle begins anew after each turn

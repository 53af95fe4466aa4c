"""Velocities, or spins, that a file has in place of places and angles: summed over time."""

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

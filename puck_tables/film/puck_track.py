"""Tracks of pucks on a film, and such as are two marks on one puck."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray, real_array
from puck_tables.errors import InputError

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
        for field, value in fields.items():
            object.__setattr__(self, field, value)
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
        known: npt.NDArray[np.bool_] = np.isfinite(self.place[:, 0] + self.place[:, 1])
        return known


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

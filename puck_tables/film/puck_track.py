"""The track of one puck on a film."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables._core.real import real_array
from puck_tables.errors import InputError


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
        fields: tuple[tuple[str, FloatArray | None], ...] = (
            ("time", time), ("place", place), ("angle", angle),
        )  # fmt: skip
        for field, value in fields:
            object.__setattr__(self, field, value)
        object.__setattr__(self, "notes", tuple(self.notes))
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

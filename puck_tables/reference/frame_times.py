"""The times of an engine's frames."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray, positive
from puck_tables.errors import InputError
from puck_tables.reference.log import times_in
from puck_tables.trajectory import MAX_FRAMES, checked_times

FRAMES = 101  # moments of a case


def frame_times(
    end: float, *, dt: float | None = None, fps: float | None = None,
    times: npt.ArrayLike | str | Path | None = None,
) -> FloatArray:  # fmt: skip
    """Times (n,) in s of the frames of a motion that ends at ``end``.

    ``end``: s; ``dt``: s, between two frames, the first of them at 0; the last is the first at or
    after the end; ``fps``: frames a second, in place of ``dt``; ``times``: s, ≥ 0, or a file of
    them, in place of both; without any of the three 101 frames from 0 to the end.  Raises
    InputError if two of them are given, one is not positive, or frames would be more than 1e6.

    >>> frame_times(0.25, fps=10).tolist()
    [0.0, 0.1, 0.2, 0.3]
    """
    if sum(one is not None for one in (dt, fps, times)) > 1:
        raise InputError("dt, fps and times all choose the frames: give one of them")
    if isinstance(times, str | Path):
        return checked_times(times_in(times))
    if times is not None:
        return checked_times(times)
    if dt is not None:
        name, per_second = "dt", 1.0 / positive("dt", dt, "s")
    elif fps is not None:
        name, per_second = "fps", positive("fps", fps, "frames a second")
    else:
        return np.linspace(0.0, end, FRAMES)
    count = end * per_second
    if not count < MAX_FRAMES - 1:
        raise InputError(
            f"{name} gives {count:.3g} frames to the end at {end:.6g} s, at most {MAX_FRAMES}: "
            "give fewer"
        )
    frames: FloatArray = np.arange(math.ceil(count * (1.0 - 1e-12)) + 1, dtype=np.float64)
    return frames * dt if dt is not None else frames / per_second

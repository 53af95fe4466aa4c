"""Stops of pucks on one base that is not round: each launch is integrated."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables._core.executor import in_slices, run_chunks
from puck_tables._core.real import real
from puck_tables.accuracy.method_errors import Selection
from puck_tables.contact.base import Base
from puck_tables.kernels.base_friction import packed
from puck_tables.motion.base_motion import STATE_SIZE
from puck_tables.motion.base_slides import OUT_ROWS, WHY_INTEGRATED, fill_slides, local_error
from puck_tables.stopping.launch_arrays import Launches
from puck_tables.stopping.solvers import OUTPUTS, First, Status

_CHUNK = 64  # slides that a thread takes at once


class BaseSolver:
    """Stops of pucks on one base, any launches, heights and radii of gyration.

    Parameters
    ----------
    shape, tol : the base, and the largest error, of Q/(fg) and Q²/(fg), Q = hypot(v, kω)
    """

    method = "integrated"
    selections: tuple[Selection, ...] = ()
    launched = ("launch_vx", "launch_vy", "launch_spin")
    outputs = tuple(name for name in OUTPUTS if name != "turn_angle")

    def __init__(self, shape: Base, tol: float) -> None:
        self.tol = real("tol", tol, "dimensionless")
        self.local, self._shape = local_error(self.tol), shape
        self._base = packed(shape, 0.0)

    @property
    def explanation(self) -> str:
        """What was taken, and why."""
        return (
            f"Asked: an error of at most {self.tol:.3g} of Q/(f g) (times) and "
            "Q^2/(f g) (places).\n"
            f"Taken: each launch integrated, order 8, steps that err by {self.local:.2g} at most.\n"
            f"{WHY_INTEGRATED}"
        )

    @property
    def source(self) -> str:
        """What the stops come from, in words."""
        return f"friction integrated over base {self._shape.name}"

    @property
    def work(self) -> dict[str, Any]:
        """What determines the bits besides the launches."""
        return {"by": self.method, "base": self._base, "local": self.local}

    def first(self, launches: Launches, threads: int | None) -> First:
        """All of the outputs of checked launches."""
        values, status = self.all(launches.matrix, threads)
        mark = launches.mark() if launches.is_held else 0
        return First(values[0], values[1:3].T, status, mark, values[3:])

    def all(self, launches: FloatArray, threads: int | None = 1) -> tuple[FloatArray, Status]:
        """Outputs (6, n), as of round pucks, and status (n,) of launches (6, n)."""
        count = launches.shape[1]
        none = np.empty(0), np.zeros(count + 1, np.int64)
        out, _, status = followed(self._base, launches, self.local, *none, threads)
        return out[: len(OUTPUTS)], status


def followed(
    base: FloatArray, launches: FloatArray, local: float, moments: FloatArray,
    ends: npt.NDArray[np.int64], threads: int | None,
) -> tuple[FloatArray, FloatArray, Status]:  # fmt: skip
    """What comes out of launches (6, n), their states at moments, and status, shared by threads."""
    count = launches.shape[1]
    out, status = np.empty((OUT_ROWS, count)), np.empty(count, np.int8)
    states = np.empty((moments.size, STATE_SIZE))

    def work(start: int, stop: int) -> None:
        some = np.ascontiguousarray(launches[:, start:stop])
        part = np.empty((OUT_ROWS, stop - start))
        first, last = ends[start], ends[stop]
        own = ends[start : stop + 1] - first
        fill_slides(
            base, some, local, own, moments[first:last], part, states[first:last],
            status[start:stop],
        )  # fmt: skip
        out[:, start:stop] = part

    if threads == 1:
        in_slices(work, count)
    else:
        run_chunks(work, count, _CHUNK, threads)
    return out, states, status

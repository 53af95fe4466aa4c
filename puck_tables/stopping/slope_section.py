"""Derivatives of stops of one kind of puck: splines over the slip angle, or each launch by itself.

What is splined are the derivatives in natural units (:func:`puck_tables.stopping.variational
.unit_stops`): a launch costs a look-up and the way back to SI units, once a second or two were
spent on the splines.  They carry broken powers of φ at both ends, by one smaller than those of the
stop, and may be too steep there, or next to a line of the friction, for any spline: launches in
such cells, few as these are, are integrated.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables._core.executor import run_chunks
from puck_tables.motion.body import UnitPuck
from puck_tables.stopping.variational import unit_stops, variations_of
from puck_tables.table.singular_lines import lines_of
from puck_tables.table.slip_axis import sides_of
from puck_tables.table.slip_spline import refinements

MANY = 3000  # launches of one height from which on splines cost less than integrating each
SPLINE_ERROR = 3e-8  # of Q, J, r: a third of what derivatives are promised to
# a side, doubled between: finer costs more than integrating
_COARSEST_CELLS, _FINEST_CELLS = 32, 512
_NEAR = 0.25  # of a side in ξ, 1/256 of it in φ: what may be too steep
_CHUNK = 1 << 13  # launches that a thread takes at once


class SlopeSection(NamedTuple):
    """Twenty functions of φ, and in which cells (sides, cells) they are good.

    Time, along, to the left, path, body angle, by the four columns of
    :func:`puck_tables.stopping.variational.unit_stops` each.
    """

    coefficients: FloatArray
    good: npt.NDArray[np.bool_]


@lru_cache(maxsize=16)
def slope_section(body: UnitPuck) -> SlopeSection:
    """Tabulate the derivatives of the stops of one kind of puck.

    Notes
    -----
    The error is measured in the middles of all cells.
    """
    friction = variations_of(body)
    sides = sides_of(lines_of(body.law, body.delta)[::-1], ends_too=True)

    def at(phi: FloatArray) -> FloatArray:
        cosine = np.where(phi >= 0.5 * np.pi, 0.0, np.cos(phi))
        return unit_stops(friction, cosine, np.sin(phi)).reshape(phi.size, -1)

    for spline, xi, off in refinements(at, sides, False, _COARSEST_CELLS, _FINEST_CELLS):
        found = SlopeSection(spline.coefficients, off.max(axis=2) <= SPLINE_ERROR)
        if found.good[:, xi > _NEAR].all():
            break
    return found


def stop_slopes_of(body: UnitPuck, launches: FloatArray, threads: int | None = None) -> FloatArray:
    """Derivatives (n, 5, 6) of the stops of launches (6, n) of one kind of puck, none at rest.

    >>> from puck_tables.motion.body import body_of
    >>> launches = np.array([[1.0], [0.0], [0.0], [2.0], [1.0], [1.0]])
    >>> result = stop_slopes_of(body_of("uniform", 2.0, 0.5**0.5), launches)
    >>> result[0, 1].round(6).tolist()  # x of a slide: v²/2J
    [1.0, 0.0, 0.0, 0.0, -0.5, 0.0]
    """
    from puck_tables.stopping.section_lookup import fill_section_slopes
    from puck_tables.stopping.stop_jacobian import fill_placed_stops

    count, friction = launches.shape[1], variations_of(body)
    own, left = np.empty((count, 5, 4)), np.ones(count, np.bool_)
    speed, rim = np.hypot(launches[0], launches[1]), np.abs(launches[5] * launches[2])
    friction.refuse_limit(speed, rim)
    if count >= MANY and not friction.limits:
        section = slope_section(body)

        def work(start: int, stop: int) -> None:
            part = slice(start, stop)
            fill_section_slopes(speed[part], rim[part], *section, own[part], left[part])

        run_chunks(work, count, _CHUNK, threads)
    if left.any():
        slip = np.hypot(speed, rim)[left]
        own[left] = unit_stops(friction, speed[left] / slip, rim[left] / slip)
    out = np.empty((count, 5, 6))

    def place(start: int, stop: int) -> None:
        some = np.ascontiguousarray(launches[:, start:stop])
        fill_placed_stops(some, own[start:stop], out[start:stop])

    run_chunks(place, count, _CHUNK, threads)
    return out

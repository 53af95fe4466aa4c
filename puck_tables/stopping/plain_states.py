"""States of plain pucks by look-up, and their derivatives where they are wanted."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.motion.state import HEADING, SPIN, STATE_ROWS
from puck_tables.stopping.launch_arrays import CHUNK, DELTA, Launches, in_chunks, launches_in
from puck_tables.stopping.similarity_lookup import LAUNCH_COLUMNS, SLIP, SPEED0
from puck_tables.stopping.state_values import directions, looked_up, refuse_times
from puck_tables.stopping.stop_table import StopTable

_TINY = 1e-25  # slip ratio of the neighbours of pure motions, whose derivatives these have
_SMALL, _LEAST = 1e-200, 1e-300  # slip speeds: below, one part of it may be no normal number
_STOPPED = 9.0  # Q/J: a time after all stops
_MANY = 1 << 12  # moments for which it pays to have all functions at their height
_AT_ONCE = 1 << 11  # launches of which all that is known stays in the cache


def all_looked_up(
    table: StopTable, launches: Launches, which: npt.NDArray[np.int64], moments: FloatArray,
    threads: int | None, slopes: FloatArray | None = None,
) -> FloatArray:  # fmt: skip
    """States (6, n) of plain launches, with headings from x; derivatives into ``slopes``."""
    if which.size == launches.size == 1 and moments.size <= CHUNK and slopes is None:
        found = table.states_of_one(launches, moments)
        if found is not None:
            heading = found[HEADING]
            heading += directions(launches.vx, launches.vy)
            return found
    if which.size:
        pucks = table.pucks(launches, threads)
        found = looked_up(table, pucks, which, moments, threads)
        if slopes is not None:
            fill_state_slopes(table, pucks, which, moments, found, slopes, threads)
        turned = directions(pucks[0], pucks[1])
        found[HEADING] += turned[which] if which.size > 1 else turned
        return found
    from puck_tables.stopping.state_lookup import PUCK_ROWS, fill_orbit_states

    out, orbit, bad = np.empty((STATE_ROWS, moments.size)), table.orbit_coefficients, [0]

    def work(start: int, stop: int) -> None:  # what is known of the launches stays in the cache
        for first in range(start, stop, _AT_ONCE):
            last = min(first + _AT_ONCE, stop)
            pucks, _ = table.fill_pucks(PUCK_ROWS, launches, first, last)
            bad.append(fill_orbit_states(pucks, which, moments, first, last, orbit, out))
            if slopes is not None:
                _fill_slopes(table, pucks, which, moments, out, slopes, first, last, threads=1)
            out[HEADING, first:last] += directions(pucks[0], pucks[1])

    in_chunks(work, moments.size, threads)
    if any(bad):
        refuse_times(moments)
    return out


def fill_state_slopes(
    table: StopTable, pucks: FloatArray, which: npt.NDArray[np.int64], moments: FloatArray,
    found: FloatArray, out: FloatArray, threads: int | None = None,
) -> None:  # fmt: skip
    """Derivatives of the states ``found`` (6, n) of plain ``pucks`` (20, m) into ``out`` (n, 6, 7).

    Those that :func:`puck_tables.stopping.state_values.looked_up` found at ``moments`` (n,);
    ``which``: (n,), (1,), or (0,), where each puck has one moment.
    """
    seen = np.ascontiguousarray(found)
    _fill_slopes(table, pucks, which, moments, seen, out, 0, moments.size, threads)


def _fill_slopes(
    table: StopTable, pucks: FloatArray, which: npt.NDArray[np.int64], moments: FloatArray,
    found: FloatArray, out: FloatArray, begin: int, end: int, threads: int | None,
) -> None:  # fmt: skip
    """The same from ``begin`` to ``end``, of which the first puck is where ``which`` is (0,)."""
    from puck_tables.stopping.state_jacobian import fill_state_jacobians
    from puck_tables.stopping.stop_jacobian import is_streamed

    natural, pure, slopes = pucks, _pure(pucks), table.slopes
    if pure is not None:
        moments, out = moments[begin:end], out[begin:end]
        natural, found = _beside_pure(table, pucks, pure, which, moments, found[:, begin:end])
        begin, end = 0, moments.size
    if which.size == end - begin == 1 and pucks.shape[1] == 1:
        which = which[:0]  # a moment of its own, of which all is found in one call
    known = pucks, natural, table.height_constants
    facts, section = np.empty((0, 0)), np.empty((2, 0, 0))
    if which.size:
        from puck_tables.stopping.launch_facts import fill_launch_facts
        from puck_tables.stopping.similarity_rates import FACTS

        facts = np.empty((FACTS, pucks.shape[1]))
        fill_launch_facts(*known, slopes.states, slopes.rates, facts)
    if end - begin >= _MANY and (pucks[DELTA] == pucks[DELTA, 0]).all():
        from puck_tables.stopping.similarity_rates import SECTION_WIDTH, fill_section

        section = np.empty((*slopes.states.shape[:2], SECTION_WIDTH))
        fill_section(pucks[DELTA, 0].item(), slopes.states, slopes.rates, section)
    streamed = is_streamed(out)

    def work(start: int, stop: int) -> None:
        fill_state_jacobians(
            *known, facts, which, moments, found, begin + start, begin + stop, slopes.states,
            slopes.rates, section, streamed, out,
        )  # fmt: skip

    in_chunks(work, end - begin, threads)


def _pure(pucks: FloatArray) -> npt.NDArray[np.bool_] | None:
    """Which pucks begin in a pure motion, or are the slowest; None: not one."""
    speed, slip = pucks[LAUNCH_COLUMNS + SPEED0], pucks[LAUNCH_COLUMNS + SLIP]
    rim = np.abs(pucks[5] * pucks[2])
    less = np.minimum(speed, rim)
    if less.size and less.min() > max(_TINY * float(slip.max()), _SMALL):
        return None
    pure: npt.NDArray[np.bool_] = (less <= _TINY * slip) | (slip < _SMALL)
    return pure if pure.any() else None


def _beside_pure(
    table: StopTable, pucks: FloatArray, pure: npt.NDArray[np.bool_],
    which: npt.NDArray[np.int64], moments: FloatArray, found: FloatArray,
) -> tuple[FloatArray, FloatArray]:  # fmt: skip
    """What is known of ``pucks`` and their states, of a neighbour where a motion is pure.

    Neighbours have Q = J = r = 1 and ω > 0; so have those that stand for the slowest pucks.
    """
    speed, slip = pucks[LAUNCH_COLUMNS + SPEED0], pucks[LAUNCH_COLUMNS + SLIP]
    rim, unit = np.abs(pucks[5] * pucks[2]), np.maximum(slip, _LEAST)
    beside = np.ones((LAUNCH_COLUMNS, int(pure.sum())))
    beside[0], beside[1] = np.maximum((speed / unit)[pure], _TINY), 0.0
    beside[2], beside[3] = np.maximum((rim / unit)[pure], _TINY), pucks[3, pure]
    natural, seen = pucks.copy(), found.copy()
    natural[:, pure] = table.pucks(launches_in(beside))
    each = np.broadcast_to(which, moments.shape) if which.size else np.arange(moments.size)
    here = np.flatnonzero(pure[each])
    mine = each[here]
    times = np.minimum(moments[here] / unit[mine] * pucks[4, mine], _STOPPED)
    states = looked_up(table, natural, mine, times)
    states[HEADING] *= np.where(pucks[2, mine] >= 0.0, 1.0, -1.0)
    states[SPIN] /= pucks[5, mine]
    seen[:, here] = states
    return natural, seen

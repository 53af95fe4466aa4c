"""Values of states at moments: looked up for plain pucks, integrated for few others.

Of plain pucks with their derivatives where they are wanted.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray, finite_array
from puck_tables._core.executor import run_chunks
from puck_tables.errors import InputError
from puck_tables.motion.body import UnitPuck
from puck_tables.motion.friction_source import source_of
from puck_tables.motion.state import HEADING, SPIN, STATE_ROWS, T
from puck_tables.motion.unit_motion import frame_of, solve
from puck_tables.stopping.launch_arrays import CHUNK, Launches, in_chunks, launches_in
from puck_tables.stopping.similarity_lookup import LAUNCH_COLUMNS, SLIP, SPEED0
from puck_tables.stopping.stop_table import StopTable

_TINY = 1e-25  # slip ratio of the neighbours of pure motions, whose derivatives these have
_SMALL, _LEAST = 1e-200, 1e-300  # slip speeds: below, one part of it may be no normal number
_STOPPED = 9.0  # Q/J: a time after all stops
_AT_ONCE = 1 << 11  # launches of which all that is known stays in the cache
TOL = 1e-9  # of Q/J, Q²/J, as a look-up of plain pucks is good to


def all_looked_up(
    table: StopTable, launches: Launches, which: npt.NDArray[np.int64], moments: FloatArray,
    threads: int | None, slopes: FloatArray | None = None,
) -> FloatArray:  # fmt: skip
    """States (6, n) of plain launches, with headings from x; derivatives into ``slopes``."""
    if which.size == launches.size == 1 and moments.size <= CHUNK and slopes is None:
        result = table.states_of_one(launches, moments)
        if result is not None:
            heading = result[HEADING]
            heading += directions(launches.vx, launches.vy)
            return result
    if which.size:
        pucks = table.pucks(launches, threads)
        result = looked_up(table, pucks, which, moments, threads)
        if slopes is not None:
            fill_state_slopes(table, pucks, which, moments, result, slopes, threads)
        turned = directions(pucks[0], pucks[1])
        result[HEADING] += turned[which] if which.size > 1 else turned
        return result
    from puck_tables.stopping.state_lookup import PUCK_ROWS, fill_states_at

    out, splines, bad = np.empty((STATE_ROWS, moments.size)), table.state_coefficients, [0]

    def work(start: int, stop: int) -> None:  # what is known of the launches stays in the cache
        for first in range(start, stop, _AT_ONCE):
            last = min(first + _AT_ONCE, stop)
            pucks, _ = table.fill_pucks(PUCK_ROWS, launches, first, last)
            bad.append(fill_states_at(pucks, which, moments, first, last, splines, out))
            if slopes is not None:
                fill_state_slopes(table, pucks, which, moments, out, slopes, 1, first, last)
            out[HEADING, first:last] += directions(pucks[0], pucks[1])

    in_chunks(work, moments.size, threads)
    if any(bad):
        refuse_times(moments)
    return out


def fill_state_slopes(
    table: StopTable, pucks: FloatArray, which: npt.NDArray[np.int64], moments: FloatArray,
    result: FloatArray, out: FloatArray, threads: int | None = None, begin: int = 0, end: int = -1,
) -> None:  # fmt: skip
    """Derivatives of states ``result`` (6, n) of plain ``pucks`` (20, m) into ``out`` (n, 6, 7).

    Those that :func:`puck_tables.stopping.state_values.looked_up` found at ``moments`` (n,);
    ``which``: (n,), (1,), or (0,), where each puck has one moment.  From ``begin`` to ``end``,
    −1 the last, alone; where ``which`` is (0,) pucks begin there, too.
    """
    from puck_tables.stopping.state_jacobian import fill_state_jacobians
    from puck_tables.stopping.stop_jacobian import is_streamed

    generic, pure, slopes = pucks, _pure(pucks), table.slopes
    end = moments.size if end < 0 else end
    if pure is not None:
        moments, out = moments[begin:end], out[begin:end]
        generic, result = _away_from_pure(table, pucks, pure, which, moments, result[:, begin:end])
        begin, end = 0, moments.size
    if which.size == end - begin == 1 and pucks.shape[1] == 1:
        which = which[:0]  # a moment of its own, of which all is found in one call
    known = pucks, generic, table.height_constants
    facts = np.empty((0, 0))
    if which.size:
        from puck_tables.stopping.similarity_rates import FACTS, fill_launch_facts

        facts = np.empty((FACTS, pucks.shape[1]))
        fill_launch_facts(*known, slopes.states, slopes.rates, facts)
    streamed = is_streamed(out)

    def work(start: int, stop: int) -> None:
        fill_state_jacobians(
            *known, facts, which, moments, result, begin + start, begin + stop, slopes.states,
            slopes.rates, streamed, out,
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


def _away_from_pure(
    table: StopTable, pucks: FloatArray, pure: npt.NDArray[np.bool_],
    which: npt.NDArray[np.int64], moments: FloatArray, result: FloatArray,
) -> tuple[FloatArray, FloatArray]:  # fmt: skip
    """What is known of ``pucks`` and their states, of a neighbour where a motion is pure.

    Neighbours have Q = J = r = 1 and ω > 0; so have those that stand for the slowest pucks.
    """
    speed, slip = pucks[LAUNCH_COLUMNS + SPEED0], pucks[LAUNCH_COLUMNS + SLIP]
    rim, unit = np.abs(pucks[5] * pucks[2]), np.maximum(slip, _LEAST)
    nearby = np.ones((LAUNCH_COLUMNS, int(pure.sum())))
    nearby[0], nearby[1] = np.maximum((speed / unit)[pure], _TINY), 0.0
    nearby[2], nearby[3] = np.maximum((rim / unit)[pure], _TINY), pucks[3, pure]
    generic, seen = pucks.copy(), result.copy()
    generic[:, pure] = table.pucks(launches_in(nearby))
    each = np.broadcast_to(which, moments.shape) if which.size else np.arange(moments.size)
    here = np.flatnonzero(pure[each])
    mine = each[here]
    times = np.minimum(moments[here] / unit[mine] * pucks[4, mine], _STOPPED)
    states = looked_up(table, generic, mine, times)
    states[HEADING] *= np.where(pucks[2, mine] >= 0.0, 1.0, -1.0)
    states[SPIN] /= pucks[5, mine]
    seen[:, here] = states
    return generic, seen


def refuse_times(moments: FloatArray) -> None:
    """Refuse times that are no numbers, or negative."""
    times = finite_array("time", moments, "s")
    if not np.all(times >= 0.0):
        raise InputError(f"time must not be negative, got {times.min():g} s")


def directions(vx: FloatArray, vy: FloatArray) -> FloatArray:
    """Of launches, 0 for those without speed."""
    result: FloatArray = np.arctan2(vy, vx)
    # only where vx is zero may both be, or minus zero
    if (vx.item() == 0.0) if vx.size == 1 else not vx.all():
        result[(vx == 0.0) & (vy == 0.0)] = 0.0
    return result


def looked_up(
    table: StopTable, pucks: FloatArray, which: npt.NDArray[np.int64], moments: FloatArray,
    threads: int | None = None,
) -> FloatArray:  # fmt: skip
    """States (6, n) of plain ``pucks`` (20, m), ``which`` (n,) or (1,) at ``moments`` (n,)."""
    from puck_tables.stopping.state_lookup import fill_states_at

    out, splines, bad = np.empty((STATE_ROWS, moments.size)), table.state_coefficients, [0]

    def work(start: int, stop: int) -> None:
        bad.append(fill_states_at(pucks, which, moments, start, stop, splines, out))

    in_chunks(work, moments.size, threads)
    if any(bad):
        refuse_times(moments)
    return out


def integrate(
    bodies: dict[float, UnitPuck], launches: FloatArray, pucks: npt.NDArray[np.int64],
    which: npt.NDArray[np.int64], moments: FloatArray, out: FloatArray, threads: int | None,
) -> None:  # fmt: skip
    """States of other ``pucks``, each integrated, into their places in ``out`` (6, n).

    Headings from x.
    """

    def work(puck: int, mine: npt.NDArray[np.int64]) -> None:
        launch = launches[:, puck]
        out[:, mine] = states_of(bodies[float(launch[3])], launch, moments[mine])
        out[HEADING, mine] += directions(launch[:1], launch[1:2])

    for_each(pucks, which, work, threads)


def for_each(
    pucks: npt.NDArray[np.int64], which: npt.NDArray[np.int64],
    work: Callable[[int, npt.NDArray[np.int64]], None], threads: int | None,
) -> None:  # fmt: skip
    """Call ``work(puck, its moments)`` for those of ``pucks`` that have some, by ``which`` (n,)."""
    order = np.argsort(which, kind="stable")
    first = np.searchsorted(which[order], pucks)
    last = np.searchsorted(which[order], pucks, side="right")

    def some(start: int, stop: int) -> None:
        for n in range(start, stop):
            if first[n] < last[n]:
                work(int(pucks[n]), order[first[n] : last[n]])

    run_chunks(some, pucks.size, 1, threads)


def states_of(
    body: UnitPuck, launch: FloatArray, times: FloatArray, tol: float = TOL
) -> FloatArray:
    """States of one puck at times (n,) s, integrated.

    ``launch``: array (6,): vx, vy, ω, δ, J, r; ``times``: array (n,), s, ≥ 0; ``tol``: of Q/J,
    Q²/J.  Returns array (6, n): x, y, heading from that at the launch, body angle, v, ω.

    >>> from puck_tables.motion.body import body_of
    >>> launch = np.array([1.0, 0.0, 0.0, 2.0, 1.0, 1.0])
    >>> states = states_of(body_of("uniform", 2.0, 0.5**0.5), launch, np.array([0.5, 2.0]))
    >>> states[0].round(12).tolist()
    [0.375, 0.5]
    """
    vx, vy, spin, _, decel, radius = launch.tolist()
    frame = frame_of((vx, vy), spin, decel, radius)
    if frame.slip == 0.0:
        return np.zeros((STATE_ROWS, times.size))
    source = source_of(body)
    run, _ = solve(source, frame.speed, frame.rim, tol)
    unit_states = run.states(frame.unit_times(times, float(run.stop[T]) * frame.time))
    return np.stack(frame.states(*unit_states))

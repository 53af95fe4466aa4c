"""Values of states at moments: looked up for plain pucks, integrated for others."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables._core.executor import run_chunks
from puck_tables._core.real import finite_array
from puck_tables.errors import InputError
from puck_tables.motion.body import UnitPuck
from puck_tables.motion.frame import frame_of
from puck_tables.motion.friction_source import source_of
from puck_tables.motion.state import HEADING, STATE_ROWS, T
from puck_tables.motion.unit_motion import solve
from puck_tables.stopping.launch_arrays import in_chunks
from puck_tables.stopping.stop_table import StopTable

TOL = 1e-9  # of Q/J, Q²/J, as a look-up of plain pucks is good to


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


def states_of(body: UnitPuck, launch: FloatArray, times: FloatArray) -> FloatArray:
    """States of one puck at times (n,) s, integrated.

    Parameters
    ----------
    body : Body
    launch : array (6,): vx, vy, ω, δ, J, r
    times : array (n,), s, ≥ 0

    Returns
    -------
    array (6, n)
        x, y, heading from that at the launch, body angle, v, ω.

    Examples
    --------
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
    run, _ = solve(source, frame.speed, frame.rim, TOL)
    natural = run.states(frame.unit_times(times, float(run.stop[T]) * frame.time))
    return np.stack(frame.states(*natural))

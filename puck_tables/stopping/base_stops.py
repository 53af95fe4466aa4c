"""Stops and states in bulk of pucks on bases that are not round."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import checked_threads, real_view
from puck_tables.errors import InputError
from puck_tables.motion.base_slides import LONGEST, WHY_INTEGRATED, local_error
from puck_tables.motion.puck_spec import PuckSpec
from puck_tables.motion.state import STATE_ROWS
from puck_tables.stopping.launch_arrays import TOO_LARGE, Launches, fits, launches_of
from puck_tables.stopping.solvers import BaseSolver, followed
from puck_tables.stopping.state_values import refuse_times
from puck_tables.stopping.states import States, each_of, moments_of, states_in
from puck_tables.stopping.stops import Stops

STATES_TOL = 1e-9  # of Q/(fg), Q²/(fg), as the states of other pucks are good to


def stop_on_base(
    puck: PuckSpec, velocity: npt.ArrayLike, spin: npt.ArrayLike, tol: float, threads: int | None
) -> Stops:
    """Where launches of a puck on a base stop, as :meth:`puck_tables.Puck.stop` has it."""
    checked_threads(threads)
    assert puck.shape is not None
    puck.refuse_lift()
    solver = BaseSolver(puck.shape, tol)
    return Stops(solver, _launches(puck, velocity, spin), threads, None, None, 0.0)


def states_on_base(
    puck: PuckSpec, velocity: npt.ArrayLike, spin: npt.ArrayLike, time: npt.ArrayLike,
    threads: int | None,
) -> States:  # fmt: skip
    """States of a puck on a base, as :meth:`puck_tables.Puck.states` has them."""
    checked_threads(threads)
    assert puck.shape is not None
    launches = _launches(puck, velocity, spin)
    rows = launches.matrix
    if not fits(rows, LONGEST).all():
        raise InputError(TOO_LARGE)
    which, moments, shape = moments_of(launches, real_view("time", time, "s"))
    refuse_times(moments)
    each = each_of(which, moments.size)
    order = np.lexsort((moments, each))
    ends = np.searchsorted(each[order], np.arange(launches.size + 1))
    slip = np.hypot(np.hypot(rows[0], rows[1]), rows[5] * rows[2])
    unit = np.where(slip > 0.0, slip / rows[4], 1.0)
    base, local = puck.packed_base, local_error(STATES_TOL)
    in_order = (moments / unit[each])[order]
    _, found, status = followed(base, rows, local, in_order, ends, threads)
    if status.any():
        raise InputError(TOO_LARGE)
    out = np.empty((STATE_ROWS, moments.size))
    out[:, order] = found.T
    told = f"{launches.size} pucks integrated, to 1e-9 of Q and Q^2/(f g).\n{WHY_INTEGRATED}"
    return states_in(out, moments, launches, which, shape, told)


def _launches(puck: PuckSpec, velocity: npt.ArrayLike, spin: npt.ArrayLike) -> Launches:
    """Launches with f z in place of δ, and the radius of gyration in place of the radius."""
    launches = launches_of(velocity, spin, puck.lever, puck.decel, puck.inertia_radius)
    launches.refuse_bad()
    return launches

"""Methods for the state of a puck at a moment between launch and stop.

The judge is the integrator with closed forms at its finest, with a step of its own to every moment;
the look-up shares nothing with it but the stops its table was built from.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import Any

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.accuracy.methods import LOOK_UP, FrictionForm, Method, Scheme
from puck_tables.kernels.quadratic import NO_COLUMNS
from puck_tables.kernels.section_spline import NO_SECTION
from puck_tables.motion.limits import log_ratio
from puck_tables.motion.path import integrate, states_at
from puck_tables.motion.state import SIZE, STATE_ROWS
from puck_tables.motion.tableaus import DORMAND_PRINCE
from puck_tables.stopping.launch_arrays import launches_in
from puck_tables.stopping.stop_table import StopTable
from puck_tables.table.resultant_table import ResultantTable
from puck_tables.tradeoff.scipy_methods import rates
from puck_tables.tradeoff.truth import DELTA, Contender, Question, Run, kept

_PUCKS, _MOMENTS, _SCIPY_PUCKS = 40, 100, 4  # and moments of each; of scipy, which is slow, fewer
_LOCAL = (1e-6, 1e-8, 1e-10, 1e-12)  # of a step: the settings measured
_FINEST = 2e-14  # of a step: truth


def contenders() -> Iterator[Contender]:
    """All methods to a state."""
    rng = np.random.default_rng(5)
    stops = StopTable.shipped()
    angle = np.concatenate([rng.uniform(0.05, 1.5, _PUCKS - 2), [1e-3, 1.57]])
    one = np.ones(_PUCKS)
    launches = np.stack([np.cos(angle), 0.0 * one, np.sin(angle), DELTA * one, one, one])
    times = stops.known(launches)[0][:, None] * np.sort(rng.random((_PUCKS, _MOMENTS)), axis=1)
    truth = _integrated(times, _FINEST, NO_COLUMNS)(launches)
    states = Question("state", launches, truth, launches)
    yield Contender(
        states, LOOK_UP.name, "",
        lambda: (stops.launch_coefficients, stops.state_coefficients, stops.turn_coefficients),
        lambda _: _looked_up(times, stops),
    )  # fmt: skip
    for source in (FrictionForm.TABLE, FrictionForm.CLOSED_FORMS):
        exact = source is FrictionForm.CLOSED_FORMS
        columns = NO_COLUMNS if exact else ResultantTable.shipped().columns
        for local in _LOCAL:
            yield Contender(
                states, Scheme(Method.ADAPTIVE, source).name, f"local={local:g}",
                kept(columns), partial(_integrated, times, local),
            )  # fmt: skip
    for rtol, atol in ((1e-4, 1e-7), (1e-8, 1e-10), (1e-11, 1e-13)):
        yield Contender(
            states.some(slice(_SCIPY_PUCKS)), "scipy DOP853, closed forms",
            f"rtol={rtol:g} atol={atol:g}", kept({"rtol": rtol, "atol": atol}),
            partial(_by_scipy, times), _SCIPY_PUCKS, outsider=True,
        )  # fmt: skip


def _integrated(times: FloatArray, local: float, columns: FloatArray) -> Run:
    """Step ends of every puck, and from them every moment."""
    section = ResultantTable.shipped().section(DELTA) if columns.size else NO_SECTION
    z, y, result = np.empty(20_000), np.empty((20_000, SIZE)), np.empty(SIZE + 1)
    q, states = np.empty(_MOMENTS), np.empty((_MOMENTS, SIZE))

    def run(launches: FloatArray) -> FloatArray:
        out = np.zeros((3, *times.shape))
        for n, (vx, _, spin) in enumerate(launches[:3].T):
            _, count = integrate(
                log_ratio(vx, spin), DORMAND_PRINCE, 0.0, local, 1.0, section, DELTA, z.size, z, y,
                result,
            )  # fmt: skip
            states_at(
                times[n], z[:count], y[:count], result, DORMAND_PRINCE, section, DELTA, q, states
            )
            out[1:, n] = states[:, 3:5].T
        return out

    return run


def _looked_up(times: FloatArray, stops: StopTable) -> Run:
    """Every moment from the stop table."""
    from puck_tables.stopping.state_lookup import fill_states_at

    which, moments = np.repeat(np.arange(_PUCKS), _MOMENTS), times.ravel()
    out, answers = np.empty((STATE_ROWS, moments.size)), np.zeros((3, *times.shape))

    def run(launches: FloatArray) -> FloatArray:
        pucks = stops.pucks(launches_in(launches), threads=1)
        fill_states_at(pucks, which, moments, 0, moments.size, stops.state_coefficients, out)
        answers[1:] = out[:2].reshape(2, *times.shape)
        return answers

    return run


def _by_scipy(times: FloatArray, tolerances: dict[str, Any]) -> Run:
    """``solve_ivp`` with its states at given times."""
    from scipy.integrate import solve_ivp

    def run(launches: FloatArray) -> FloatArray:
        out = np.zeros((3, launches.shape[1], _MOMENTS))
        for n, launch in enumerate(launches[:3].T):
            solution = solve_ivp(
                rates, (0.0, times[n, -1]), [*launch, 0.0, 0.0], "DOP853", t_eval=times[n],
                args=(DELTA,), **tolerances,
            )  # fmt: skip
            out[1:, n] = solution.y[3:5]
        return out

    return run

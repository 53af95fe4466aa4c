"""Methods for the state of a puck at a moment between launch and stop."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.accuracy.methods import LOOK_UP, FrictionForm, Method, Scheme
from puck_tables.kernels.section_spline import NO_SECTION
from puck_tables.motion.limits import log_ratio
from puck_tables.motion.path import integrate, states_at
from puck_tables.motion.state import SIZE, STATE_ROWS
from puck_tables.motion.tableaus import DORMAND_PRINCE
from puck_tables.stopping.launch_arrays import launches_in
from puck_tables.stopping.stop_table import StopTable
from puck_tables.table.resultant_table import ResultantTable
from puck_tables.tradeoff.contender import Contender, Ready
from puck_tables.tradeoff.scipy_methods import rates

Run = Callable[[], FloatArray]  # x, y of every moment of every puck (pucks, moments, 2)

QUESTION = "state"
DELTA = 0.5  # dimensionless: that of a puck that nothing is said of
_PUCKS, _MOMENTS, _SCIPY_PUCKS = 40, 100, 4  # and moments of each; of scipy, which is slow, fewer
_LOCAL = (1e-6, 1e-8, 1e-10, 1e-12)  # of a step: the settings measured
_FINEST = 2e-14  # of a step: truth


class StateTask:
    """Pucks, moments (as shares of their stop times) and where they are then.

    The judge is the integrator with closed forms at its finest, with a step of its own to every
    moment; the look-up shares nothing with it but the stops its table was built from.
    """

    def __init__(self, table: ResultantTable, stops: StopTable) -> None:
        rng = np.random.default_rng(5)
        self.table, self.stops = table, stops
        angle = np.concatenate([rng.uniform(0.05, 1.5, _PUCKS - 2), [1e-3, 1.57]])
        self.launches = np.stack([
            np.cos(angle), 0.0 * angle, np.sin(angle),
            np.full(_PUCKS, DELTA), np.ones(_PUCKS), np.ones(_PUCKS),
        ])  # fmt: skip
        self.shares = np.sort(rng.random((_PUCKS, _MOMENTS)), axis=1)
        self.times = stops.known(self.launches)[0][:, None] * self.shares
        self.truth = self.integrated(_FINEST, exact=True)()

    def integrated(self, local: float, exact: bool) -> Run:
        """Step ends of every puck, and from them every moment."""
        cut = NO_SECTION if exact else self.table.section(DELTA)
        z, y, result = np.empty(20_000), np.empty((20_000, SIZE)), np.empty(SIZE + 1)

        def run() -> FloatArray:
            places = np.empty((_PUCKS, _MOMENTS, 2))
            q, states = np.empty(_MOMENTS), np.empty((_MOMENTS, SIZE))
            for n, (vx, _, spin) in enumerate(self.launches[:3].T):
                _, count = integrate(
                    log_ratio(vx, spin), DORMAND_PRINCE, 0.0, local, 1.0, cut, DELTA, z.size, z, y,
                    result,
                )  # fmt: skip
                states_at(
                    self.times[n], z[:count], y[:count], result, DORMAND_PRINCE, cut, DELTA, q,
                    states,
                )  # fmt: skip
                places[n] = states[:, 3:5]
            return places

        return run

    def looked_up(self) -> Run:
        """Every moment from the stop table."""
        from puck_tables.stopping.state_lookup import fill_orbit_states

        which = np.repeat(np.arange(_PUCKS), _MOMENTS)
        moments, out = self.times.ravel(), np.empty((STATE_ROWS, _PUCKS * _MOMENTS))
        launches, orbit = launches_in(self.launches), self.stops.orbit_coefficients

        def run() -> FloatArray:
            pucks = self.stops.pucks(launches, threads=1)
            fill_orbit_states(pucks, which, moments, 0, moments.size, orbit, out)
            return np.moveaxis(out[:2].reshape(2, _PUCKS, _MOMENTS), 0, -1)

        return run

    def by_scipy(self, rtol: float, atol: float) -> Run:
        """``solve_ivp`` with its states at given times."""
        from scipy.integrate import solve_ivp

        def run() -> FloatArray:
            places = []
            for launch, times in zip(self.launches.T[:_SCIPY_PUCKS], self.times, strict=False):
                solution = solve_ivp(
                    rates, (0.0, times[-1]), [*launch[:3], 0.0, 0.0], "DOP853", t_eval=times,
                    rtol=rtol, atol=atol, args=(DELTA,),
                )  # fmt: skip
                places.append(solution.y[3:5].T)
            return np.stack(places)

        return run


def contenders(task: StateTask) -> Iterator[Contender]:
    """All methods to a state."""

    def contender(
        method: str, setting: str, make: Callable[[], Run], size: int, outsider: bool = False
    ) -> Contender:
        def ready(_: object) -> Ready:
            run = make()
            places = run()
            off = places - task.truth[: len(places)]
            error = np.hypot(off[..., 0], off[..., 1]).ravel()
            return Ready(run, error.size, 0.0 * error, error, bytes=size)

        return Contender(QUESTION, method, setting, lambda: None, ready, outsider)

    stops = task.stops
    tables = (stops.launch_coefficients, stops.orbit_coefficients, stops.turn_coefficients)
    yield contender(LOOK_UP.name, "", task.looked_up, sum(table.nbytes for table in tables))
    for source in (FrictionForm.TABLE, FrictionForm.CLOSED_FORMS):
        method, exact = Scheme(Method.ADAPTIVE, source).name, source is FrictionForm.CLOSED_FORMS
        for local in _LOCAL:
            size = 0 if exact else task.table.columns.nbytes
            yield contender(
                method, f"local={local:g}",
                partial(task.integrated, local, exact), size,
            )  # fmt: skip
    for rtol, atol in ((1e-4, 1e-7), (1e-8, 1e-10), (1e-11, 1e-13)):
        yield contender(
            "scipy DOP853, closed forms", f"rtol={rtol:g} atol={atol:g}",
            partial(task.by_scipy, rtol, atol), 0, outsider=True,
        )  # fmt: skip

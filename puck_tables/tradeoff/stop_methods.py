"""Methods for the stop of a launch: looked up, integrated, and what others do."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial

import numpy as np

from puck_tables._core.arrays import FloatArray, aligned
from puck_tables.accuracy.methods import INTEGRATED, LOOK_UP, FrictionForm
from puck_tables.kernels.quadratic import NO_COLUMNS, room_for_section, section_at
from puck_tables.kernels.section_spline import NO_SECTION
from puck_tables.motion.bulk_stops import fill_stops
from puck_tables.motion.limits import log_ratio
from puck_tables.motion.path import integrate
from puck_tables.motion.state import SIZE
from puck_tables.motion.steppers import TABLEAUS, Stepping
from puck_tables.motion.tableaus import RK4
from puck_tables.stopping.launch_arrays import launches_in
from puck_tables.stopping.lookup import stops_kernel
from puck_tables.stopping.stop_table import StopTable
from puck_tables.table.resultant_table import ResultantTable
from puck_tables.tradeoff.contender import Contender, Ready
from puck_tables.tradeoff.literature_models import PADE_MATCHED, as_table, pade_at_best
from puck_tables.tradeoff.scipy_methods import PATCH_GRID, SCIPY_SETTINGS, patch_script, scipy_stop
from puck_tables.tradeoff.truth import Points, Starts

QUESTION, TRAJECTORY = "stop", "trajectory"
SCATTERED = 40_000  # launches timed
DELTA = 0.5  # dimensionless: that of a puck that nothing is said of
_CUTS = ((2, 6), (3, 6), (4, 6), (5, 3), (6, 2), (6, 1), (7, 1))  # powers, thinning
# fixed: the settings measured
_STEPS = (5, 6, 8, 10, 12, 16, 20, 24, 32, 48, 64, 96, 128, 192, 256)
_STEPS_EXACT = (512, 1024)  # where the table's own error would show
# of a step: the settings measured
_LOCAL = (1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12)
_LOCAL_EXACT = (1e-13, 2e-14)  # of a step, with closed forms only
_EASY = 16  # starts that outsiders are judged at, none of them adversarial
_STEP_LIMIT = 100_000  # more is a motion that does not end


class StopTask:
    """Launches: scattered ones for the clock, those of the truth for the error."""

    def __init__(
        self, truth: Starts, flat: Points, table: ResultantTable, stops: StopTable
    ) -> None:
        rng = np.random.default_rng(11)
        self.truth, self.flat = truth, flat
        self.table, self.stops = table, stops
        one = np.ones(SCATTERED)
        self.scattered = np.stack([
            *rng.uniform(-1.0, 1.0, (2, SCATTERED)), rng.uniform(-5.0, 5.0, SCATTERED),
            rng.random(SCATTERED), one, one,
        ])  # fmt: skip
        self.same_height = self.scattered.copy()
        self.same_height[3] = DELTA
        self.judged = truth.launches()
        size = np.abs(truth.u)
        moderate = np.flatnonzero((size < 4.0) & (size > 0.05) & (np.abs(truth.u - 0.4) > 0.1))
        self.easy = truth.some(rng.choice(moderate, _EASY, replace=False))
        self.flat_starts = truth.some(truth.delta == 0.0)


def contenders(task: StopTask) -> Iterator[Contender]:
    """All methods to a stop, and to a trajectory with its steps recorded."""
    for powers, thinning in _CUTS:
        yield Contender(
            QUESTION, LOOK_UP.name, f"powers={powers} thinning={thinning}",
            partial(_fresh_section, task.stops, powers, thinning, np.float64),
            partial(_looked_up, task, powers),
        )  # fmt: skip
    for powers, thinning in ((5, 3), (7, 1)):
        yield Contender(
            QUESTION, LOOK_UP.name + ", float32", f"powers={powers} thinning={thinning}",
            partial(_fresh_section, task.stops, powers, thinning, np.float32),
            partial(_looked_up, task, powers),
        )  # fmt: skip
    for scheme in INTEGRATED:
        exact, tableau = scheme.source is FrictionForm.CLOSED_FORMS, TABLEAUS[scheme.method]
        if tableau.e.any():
            for local in _LOCAL + (_LOCAL_EXACT if exact else ()):
                stepping = Stepping(tableau, 0.0, local)
                yield from _integrations(task, scheme.name, f"local={local:g}", stepping, exact)
        else:
            for steps in _STEPS + (_STEPS_EXACT if exact else ()):
                stepping = Stepping(tableau, float(steps), 1.0)
                yield from _integrations(task, scheme.name, f"steps={steps}", stepping, exact)
    yield from _outsiders(task)


def _fresh_section(stops: StopTable, powers: int, thinning: int, dtype: type) -> FloatArray:
    return aligned(StopTable(stops.values).thinned(powers, thinning).astype(dtype))


def _looked_up(task: StopTask, powers: int, coefficients: object) -> Ready:
    assert isinstance(coefficients, np.ndarray)
    fill = stops_kernel(powers)

    def run(launches: FloatArray, out: FloatArray) -> None:
        fill(*launches_in(launches).part(0, launches.shape[1]), coefficients, *out, 1)

    judged = np.empty((3, task.judged.shape[1]))
    run(task.judged, judged)
    out = np.empty((3, SCATTERED))
    return Ready(
        lambda: run(task.scattered, out), SCATTERED, *task.truth.errors(judged),
        bytes=coefficients.nbytes,
    )  # fmt: skip


def _integrations(
    task: StopTask, method: str, setting: str, stepping: Stepping, exact: bool
) -> Iterator[Contender]:
    def coefficients() -> FloatArray:
        return NO_COLUMNS if exact else task.table.columns

    def items_for(expensive: float) -> int:
        return int(np.clip(2000.0 / expensive, 8.0, 1000.0))

    tableau, steps, local = stepping
    few = items_for(steps / 8.0 if steps else max(1.0, 10.0 - 3.0 * np.log10(local)))

    def stop(built: object) -> Ready:
        assert isinstance(built, np.ndarray)
        launches = np.ascontiguousarray(task.same_height[:, :few])

        def run(which: FloatArray) -> FloatArray:
            out = np.empty((6, which.shape[1]))
            status = np.empty(which.shape[1], np.int8)
            fill_stops(which, tableau, steps, local, built, NO_SECTION, out, status)
            return out

        errors = task.truth.errors(run(task.judged)[:3])
        return Ready(lambda: run(launches), few, *errors, bytes=built.nbytes)

    def trajectory(built: object) -> Ready:
        assert isinstance(built, np.ndarray)
        z, y, result = np.empty(20_000), np.empty((20_000, SIZE)), np.empty(SIZE + 1)
        height, one_height = -1.0, room_for_section(built)

        def run(which: FloatArray) -> FloatArray:
            nonlocal height
            out = np.empty((3, which.shape[1]))
            for n, (vx, vy, spin, delta) in enumerate(which[:4].T):
                if not exact and delta != height:
                    section_at(built, delta, one_height)
                    height = delta
                u = log_ratio(np.hypot(vx, vy), abs(spin))
                integrate(
                    u, tableau, steps, local, 1.0, one_height, delta, _STEP_LIMIT, z, y, result
                )
                out[:, n] = result[2:5]
            return out

        generic = np.isfinite(task.truth.u)
        errors = task.truth.some(generic).errors(run(task.judged[:, generic]))
        launches = np.ascontiguousarray(task.same_height[:, : min(few, 100)])
        return Ready(lambda: run(launches), launches.shape[1], *errors, bytes=built.nbytes)

    yield Contender(QUESTION, method, setting, coefficients, stop)
    yield Contender(TRAJECTORY, method, setting, coefficients, trajectory)


def _outsiders(task: StopTask) -> Iterator[Contender]:
    def outside(method: str, setting: str, stop_of: Callable[..., FloatArray]) -> Contender:
        def ready(_: object) -> Ready:
            easy = task.easy.launches()
            stops = np.stack([stop_of(*launch[:4]) for launch in easy.T], axis=-1)
            launch = (*task.same_height[:3, 0], DELTA)
            return Ready(lambda: stop_of(*launch), 1, *task.easy.errors(stops))

        return Contender(QUESTION, method, setting, lambda: None, ready, outsider=True)

    for method, rtol, atol in SCIPY_SETTINGS:
        yield outside(
            f"scipy {method}, closed forms", f"rtol={rtol:g} atol={atol:g}",
            partial(scipy_stop, method, rtol, atol),
        )  # fmt: skip
    yield outside(
        "patches and scipy RK45", f"patches={PATCH_GRID[0]}x{PATCH_GRID[1]}", patch_script
    )

    def modelled(method: str, build: Callable[[], ResultantTable]) -> Contender:
        def ready(table: object) -> Ready:
            assert isinstance(table, ResultantTable)
            launches = np.ascontiguousarray(task.same_height[:, :500])

            def run(which: FloatArray) -> FloatArray:
                out, status = np.empty((6, which.shape[1])), np.empty(which.shape[1], np.int8)
                fill_stops(which, RK4, 64.0, 1.0, table.columns, NO_SECTION, out, status)
                return out[:3]

            errors = task.flat_starts.errors(run(task.flat_starts.launches()))
            return Ready(lambda: run(launches), 500, *errors)

        return Contender(QUESTION, method, "", build, ready, outsider=True)

    yield modelled("Pade, slopes matched", lambda: as_table("pade", *PADE_MATCHED))
    yield modelled(
        "Pade, fitted", lambda: as_table("pade", *pade_at_best(task.flat.phi, task.flat.resultants))
    )
    yield modelled("limit surface", lambda: as_table("limit surface"))

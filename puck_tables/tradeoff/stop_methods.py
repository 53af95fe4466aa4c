"""Methods for the stop of a launch: looked up, integrated, and what others do."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
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
from puck_tables.tradeoff.literature_models import MODELS, as_table
from puck_tables.tradeoff.scipy_methods import (
    PATCH_GRID,
    SCIPY_SETTINGS,
    disc_by_patches,
    scipy_stop,
)
from puck_tables.tradeoff.truth import DELTA, Contender, Question, Run, filled, golden_starts, kept

_SECTIONS = ((2, 6), (3, 6), (4, 6), (5, 3), (6, 2), (6, 1), (7, 1))  # powers, thinning
# fixed: the settings measured
_STEPS = (5, 6, 8, 10, 12, 16, 20, 24, 32, 48, 64, 96, 128, 192, 256)
_STEPS_EXACT = (512, 1024)  # where the table's own error would show
# of a step: the settings measured
_LOCAL = (1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12)
_LOCAL_EXACT = (1e-13, 2e-14)  # of a step, with closed forms only
_STEP_LIMIT = 100_000  # more is a motion that does not end


def contenders() -> Iterator[Contender]:
    """All methods to a stop, and to a trajectory with its steps recorded."""
    stops, easy, u = golden_starts()
    for kind, dtype, sections in (
        ("", np.float64, _SECTIONS), (", float32", np.float32, ((5, 3), (7, 1)))
    ):  # fmt: skip
        for powers, thinning in sections:
            yield Contender(
                stops, LOOK_UP.name + kind, f"powers={powers} thinning={thinning}",
                partial(_fresh_section, powers, thinning, dtype), partial(_looked_up, powers),
            )  # fmt: skip
    timed = stops.timed.copy()
    timed[3] = DELTA
    stops, easy = replace(stops, timed=timed), replace(easy, timed=timed)
    trajectories = replace(stops.some(np.isfinite(u)), name="trajectory")
    for scheme in INTEGRATED:
        exact, tableau = scheme.source is FrictionForm.CLOSED_FORMS, TABLEAUS[scheme.method]
        columns = NO_COLUMNS if exact else ResultantTable.shipped().columns
        settings: list[tuple[str, Stepping, float]] = []  # in words, of what cost
        if tableau.e.any():
            for local in _LOCAL + (_LOCAL_EXACT if exact else ()):
                cost = max(1.0, 10.0 - 3.0 * np.log10(local))
                settings.append((f"local={local:g}", Stepping(tableau, 0.0, local), cost))
        else:
            for steps in _STEPS + (_STEPS_EXACT if exact else ()):
                stepping = Stepping(tableau, float(steps), 1.0)
                settings.append((f"steps={steps}", stepping, steps / 8.0))
        for words, stepping, cost in settings:
            items = int(np.clip(2000.0 / cost, 8.0, 1000.0))
            for question, integrated, most in (
                (stops, _integrated, items), (trajectories, _recorded, min(items, 100))
            ):  # fmt: skip
                yield Contender(
                    question, scheme.name, words, kept(columns),
                    partial(integrated, stepping), most,
                )  # fmt: skip
    yield from _outsiders(easy, stops.some(stops.inputs[3] == 0.0))


def _fresh_section(powers: int, thinning: int, dtype: type) -> FloatArray:
    table = StopTable(StopTable.shipped().values)
    return aligned(table.thinned(powers, thinning).astype(dtype))


def _looked_up(powers: int, coefficients: FloatArray) -> Run:
    fill = stops_kernel(powers)
    return filled(
        lambda launches, out: fill(
            *launches_in(launches).part(0, launches.shape[1]), coefficients, *out, 1
        )
    )


def _integrated(stepping: Stepping, columns: FloatArray) -> Run:
    def fill(launches: FloatArray, out: FloatArray) -> None:
        status = np.empty(launches.shape[1], np.int8)
        fill_stops(launches, *stepping, columns, NO_SECTION, out, status)

    return filled(fill, rows=6)


def _recorded(stepping: Stepping, columns: FloatArray) -> Run:
    z, y, result = np.empty(20_000), np.empty((20_000, SIZE)), np.empty(SIZE + 1)
    height, section = -1.0, room_for_section(columns)

    def fill(launches: FloatArray, out: FloatArray) -> None:
        nonlocal height
        for n, (vx, vy, spin, delta) in enumerate(launches[:4].T):
            if columns.size and delta != height:
                section_at(columns, delta, section)
                height = delta
            u = log_ratio(np.hypot(vx, vy), abs(spin))
            integrate(u, *stepping, 1.0, section, delta, _STEP_LIMIT, z, y, result)
            out[:, n] = result[2:5]

    return filled(fill)


def _outsiders(easy: Question, low: Question) -> Iterator[Contender]:
    scripts: list[tuple[str, str, Callable[..., FloatArray]]] = [
        (f"scipy {method}, closed forms", f"rtol={rtol:g} atol={atol:g}",
         partial(scipy_stop, method, rtol, atol))
        for method, rtol, atol in SCIPY_SETTINGS
    ]  # fmt: skip
    grid = f"patches={PATCH_GRID[0]}x{PATCH_GRID[1]}"
    for method, setting, stop_of in [*scripts, ("patches and scipy RK45", grid, disc_by_patches)]:
        yield Contender(
            easy, method, setting, kept(stop_of),
            lambda stop_of: lambda launches: np.stack([stop_of(*one[:4]) for one in launches.T], 1),
            1, outsider=True,
        )  # fmt: skip
    for method in MODELS:
        yield Contender(
            low, method, "", partial(as_table, method),
            lambda table: _integrated(Stepping(RK4, 64.0, 1.0), table.columns), 500, outsider=True,
        )  # fmt: skip

"""Methods for the stop of a launch, its trajectory, and its states at moments before the stop.

Looked up, integrated, and what others do.  States are judged by the integrator with closed forms at
its finest, with a step of its own to every moment; the look-up shares nothing with it but the stops
its table was built from.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial

import numpy as np

from puck_tables._core.arrays import FloatArray, aligned
from puck_tables.accuracy.methods import INTEGRATED, LOOK_UP, FrictionForm, Method, Scheme
from puck_tables.kernels.quadratic import NO_COLUMNS, NO_SECTION, room_for_section, section_at
from puck_tables.motion.bulk_stops import fill_stops
from puck_tables.motion.limits import log_ratio
from puck_tables.motion.path import integrate, states_at
from puck_tables.motion.state import SIZE, STATE_ROWS
from puck_tables.motion.steppers import DORMAND_PRINCE, RK4, TABLEAUS, Stepping
from puck_tables.stopping.launch_arrays import launches_in
from puck_tables.stopping.lookup import stops_kernel
from puck_tables.stopping.stop_table import StopTable
from puck_tables.table.resultant_table import ResultantTable
from puck_tables.tradeoff.resultant_methods import MODELS, as_table
from puck_tables.tradeoff.scipy_methods import rates, scripts
from puck_tables.tradeoff.truth import DELTA, Contender, Made, Question, filled, golden_starts

_SECTIONS = ((2, 6), (3, 6), (4, 6), (5, 3), (6, 2), (6, 1), (7, 1))  # powers, thinning
_SINGLE = ((5, 3), (7, 1))  # of which in float32
# fixed steps and local errors of a step: the settings measured, and those with closed forms only,
# where the table's own error would show
_STEPS = (5.0, 6.0, 8.0, 10.0, 12.0, 16.0, 20.0, 24.0, 32.0, 48.0, 64.0, 96.0, 128.0, 192.0, 256.0)
_STEPS_EXACT = (512.0, 1024.0)
_LOCAL = (1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12)
_LOCAL_EXACT = (1e-13, 2e-14)
_LOCAL_OF_STATES, _FINEST = (1e-6, 1e-8, 1e-10, 1e-12), 2e-14  # of a step: measured; truth
_STEP_LIMIT, _ROOM = 100_000, 20_000  # more is a motion that does not end; steps kept
_PUCKS, _MOMENTS, _SCIPY_PUCKS = 40, 100, 4  # and moments of each; of scipy, which is slow, fewer


def contenders() -> Iterator[Contender]:
    """All methods to a stop, to a trajectory with its steps recorded, and to a state."""
    stops, easy, u = golden_starts()
    for kind, dtype, sections in (("", np.float64, _SECTIONS), (", float32", np.float32, _SINGLE)):
        for powers, thinning in sections:
            words, make = f"{powers=} {thinning=}", partial(_looked_up, powers, thinning, dtype)
            yield Contender(stops, LOOK_UP.name + kind, words, make)
    timed = stops.timed.copy()
    timed[3] = DELTA
    stops, easy = replace(stops, timed=timed), replace(easy, timed=timed)
    trajectories = replace(stops.some(np.isfinite(u)), name="trajectory")
    for scheme in INTEGRATED:
        columns, tableau = _columns(scheme.source), TABLEAUS[scheme.method]
        exact = not columns.size
        steppings = [Stepping(tableau, one, 1.0) for one in _STEPS + exact * _STEPS_EXACT]
        if tableau.e.any():
            steppings = [Stepping(tableau, 0.0, one) for one in _LOCAL + exact * _LOCAL_EXACT]
        for one in steppings:
            words, cost = f"steps={one.steps:g}", one.steps / 8.0
            if not one.fixed:
                words, cost = f"local={one.local:g}", max(1.0, 10.0 - 3.0 * np.log10(one.local))
            items, most = (int(np.clip(2000.0 / cost, 8.0, end)) for end in (1000.0, 100.0))
            integrated = partial(_integrated, one, columns)
            recorded = partial(_recorded, one, columns)
            yield Contender(stops, scheme.name, words, integrated, items)
            yield Contender(trajectories, scheme.name, words, recorded, most)
    yield from scripts(easy)
    low = stops.some(stops.inputs[3] == 0.0)
    for model in MODELS:
        yield Contender(low, model, "", partial(_by_model, model), 500, outsider=True)
    yield from _of_states()


def _of_states() -> Iterator[Contender]:
    rng, stops = np.random.default_rng(5), StopTable.shipped()
    angle = np.concatenate([rng.uniform(0.05, 1.5, _PUCKS - 2), [1e-3, 1.57]])
    one = np.ones(_PUCKS)
    launches = np.stack([np.cos(angle), 0.0 * one, np.sin(angle), DELTA * one, one, one])
    times = stops.known(launches)[0][:, None] * np.sort(rng.random((_PUCKS, _MOMENTS)), axis=1)
    truth = _states(times, _FINEST, NO_COLUMNS)[1](launches)
    states = Question("state", launches, truth, launches)
    yield Contender(states, LOOK_UP.name, "", partial(_looked_up_states, times, stops))
    for source in (FrictionForm.TABLE, FrictionForm.CLOSED_FORMS):
        method = Scheme(Method.ADAPTIVE, source).name
        for local in _LOCAL_OF_STATES:
            make = partial(_states, times, local, _columns(source))
            yield Contender(states, method, f"local={local:g}", make)
    few, name = states.some(slice(_SCIPY_PUCKS)), "scipy DOP853, closed forms"
    for rtol, atol in ((1e-4, 1e-7), (1e-8, 1e-10), (1e-11, 1e-13)):
        words, make = f"rtol={rtol:g} atol={atol:g}", partial(_states_by_scipy, times, rtol, atol)
        yield Contender(few, name, words, make, _SCIPY_PUCKS, outsider=True)


def _columns(source: FrictionForm | None) -> FloatArray:
    """What friction is computed from; nothing by closed forms."""
    exact = source is FrictionForm.CLOSED_FORMS
    return NO_COLUMNS if exact else ResultantTable.shipped().columns


def _looked_up(powers: int, thinning: int, dtype: type) -> Made:
    table = StopTable(StopTable.shipped().values)
    kept, fill = aligned(table.thinned(powers, thinning).astype(dtype)), stops_kernel(powers)
    return kept, filled(
        lambda inputs, out: fill(*launches_in(inputs).part(0, inputs.shape[1]), kept, *out, 1)
    )


def _integrated(stepping: Stepping, columns: FloatArray) -> Made:
    def fill(launches: FloatArray, out: FloatArray) -> None:
        status = np.empty(launches.shape[1], np.int8)
        fill_stops(launches, *stepping, columns, NO_SECTION, out, status)

    return columns, filled(fill, rows=6)


def _by_model(model: str) -> Made:
    return None, _integrated(Stepping(RK4, 64.0, 1.0), as_table(model).columns)[1]


def _recorded(stepping: Stepping, columns: FloatArray) -> Made:
    z, y, result = np.empty(_ROOM), np.empty((_ROOM, SIZE)), np.empty(SIZE + 1)
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

    return columns, filled(fill)


def _states(times: FloatArray, local: float, columns: FloatArray) -> Made:
    """Step ends of every puck, and from them every moment."""
    section = ResultantTable.shipped().section(DELTA) if columns.size else NO_SECTION
    z, y, result = np.empty(_ROOM), np.empty((_ROOM, SIZE)), np.empty(SIZE + 1)
    q, states = np.empty(_MOMENTS), np.empty((_MOMENTS, SIZE))
    stepping = Stepping(DORMAND_PRINCE, 0.0, local)

    def run(launches: FloatArray) -> FloatArray:
        out = np.zeros((3, *times.shape))
        for n, (vx, _, spin) in enumerate(launches[:3].T):
            u = log_ratio(vx, spin)
            _, count = integrate(u, *stepping, 1.0, section, DELTA, z.size, z, y, result)
            ends = z[:count], y[:count], result
            states_at(times[n], *ends, DORMAND_PRINCE, section, DELTA, q, states)
            out[1:, n] = states[:, 3:5].T
        return out

    return columns, run


def _looked_up_states(times: FloatArray, stops: StopTable) -> Made:
    from puck_tables.stopping.state_lookup import fill_states_at

    which, moments = np.repeat(np.arange(_PUCKS), _MOMENTS), times.ravel()
    out, answers = np.empty((STATE_ROWS, moments.size)), np.zeros((3, *times.shape))
    kept = stops.launch_coefficients, stops.state_coefficients, stops.turn_coefficients

    def run(launches: FloatArray) -> FloatArray:
        pucks = stops.pucks(launches_in(launches), threads=1)
        fill_states_at(pucks, which, moments, 0, moments.size, stops.state_coefficients, out)
        answers[1:] = out[:2].reshape(2, *times.shape)
        return answers

    return kept, run


def _states_by_scipy(times: FloatArray, rtol: float, atol: float) -> Made:
    from scipy.integrate import solve_ivp

    def run(launches: FloatArray) -> FloatArray:
        out = np.zeros((3, launches.shape[1], _MOMENTS))
        for n, launch in enumerate(launches[:3].T):
            span, start = (0.0, times[n, -1]), [*launch, 0.0, 0.0]
            out[1:, n] = solve_ivp(
                rates,
                span,
                start,
                "DOP853",
                times[n],
                args=(DELTA,),
                rtol=rtol,
                atol=atol,
            ).y[3:5]
        return out

    return None, run

"""One scene, from its launch to its end, by the cheapest exact model."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from puck_tables._core.real import finite_array
from puck_tables.errors import AccuracyError, InputError, PuckError
from puck_tables.scene.friction import SPIN, THETA, VX, VY, X, Y
from puck_tables.scene.library import files_of
from puck_tables.scene.loop import (
    EVENT_COLUMNS,
    EVENT_LIMIT,
    FRAME_COLUMNS,
    NOT_FINITE,
    STEP_LIMIT,
    TIME_UP,
)
from puck_tables.scene.outcome import ENDS, EVENTS, LEDGER, Event, SceneRun, ledger_residual
from puck_tables.scene.plain import run_plain
from puck_tables.scene.plan import Plan, ingredients, out_of_reach, plan_for
from puck_tables.scene.prepare import MAX_EVENTS, Prepared, prepare
from puck_tables.scene.regions import friction_error, law_name, speed_law
from puck_tables.scene.scene import Scene

FloatArray = npt.NDArray[np.float64]


def simulate(scene: Scene, times: npt.ArrayLike | None = None) -> SceneRun:
    """A run of a scene, as :meth:`puck_tables.Scene.simulate` has it."""
    whole = scene.single()
    moments = None if times is None else _checked(times)
    files = files_of(whole)
    needed = out_of_reach(whole)
    plan = plan_for(needed)
    if plan.plain:
        run = run_plain(whole, needed, plan, moments)
    else:
        run = _integrated(whole, plan, moments)
    return replace(run, files=files)


COARSER = 30.0  # the steps of a twin may err by so much more
FINER = (1.0, 1 / 30, 1 / 900, 1 / 27000)  # of the tolerance asked: tried one after the other
FINEST = 1e-12
STEP_SHARE = 0.1  # of the sum of the errors of steps, which are those of order 4
PROBES = 7  # states on the way that are compared too

FAILURES = {
    STEP_LIMIT: "no end after a million steps, at {time:.6g} s: ask for a shorter run.time",
    EVENT_LIMIT: "100000 events by {time:.6g} s: they crowd together without end (rebounds, or a "
    "border); move the launch, or end the run before with run.time",
    NOT_FINITE: "the motion leaves floating point at {time:.6g} s: use other units",
}


def _checked(times: npt.ArrayLike) -> FloatArray:
    moments = np.atleast_1d(finite_array("times", times, "s"))
    if moments.ndim != 1 or not np.all(moments >= 0.0) or not np.all(np.diff(moments) >= 0.0):
        raise InputError("times must be a list of ascending numbers >= 0 s")
    return moments


def is_endless(scene: Scene) -> bool:
    """Whether a scene has no friction and says neither where nor when it ends."""
    return scene.run.time is None and not scene.edges and "no dry friction" in ingredients(scene)


def _integrated(scene: Scene, plan: Plan, times: FloatArray | None) -> SceneRun:
    """Run it at a tolerance of which a coarser twin tells that the error asked is kept."""
    last = None if times is None or not times.size else float(times[-1])
    events = np.empty((MAX_EVENTS, EVENT_COLUMNS))
    prepared, estimate = _close_enough(scene, last, events)
    if times is None:
        _, end_time, *_ = prepared.follow(np.empty(0), np.empty((1, FRAME_COLUMNS)), events)
        times = np.linspace(0.0, end_time, int(scene.run.frames))
    rows = np.empty((len(times) + 1, FRAME_COLUMNS))
    how, end_time, count, steps, reached, _ = prepared.follow(times, rows, events)
    _refuse_failed(scene, how, end_time, prepared.ask.to_the_end)
    columns = columns_of(rows[: reached + 1], prepared)
    energy = kinetic(prepared.state[[VX, VY, SPIN]], prepared)
    return SceneRun(
        scene=scene,
        plan=plan,
        end=ENDS[how],
        end_time=end_time,
        events=[
            Event(float(e[0]), EVENTS[int(e[1])], int(e[2]), float(e[3 + X]), float(e[3 + Y]))
            for e in events[:count]
        ],
        energy_residual=ledger_residual(columns, float(energy)),
        error_estimate=estimate,
        speed_scale=prepared.speed,
        rate_scale=prepared.rate,
        steps=steps,
        last={name: float(column[-1]) for name, column in columns.items()},
        columns={name: column[:-1] for name, column in columns.items()},
    )


def _close_enough(scene: Scene, last: float | None, events: FloatArray) -> tuple[Prepared, float]:
    """The scene at the coarsest tolerance that keeps the one asked, and its error estimate.

    Where finer steps help no more, rounding or what is known of friction has the last word.
    """
    asked = scene.run.tol
    prepared, estimate = prepare(scene, last), math.inf
    if is_endless(scene):
        raise InputError(
            "nothing brings this scene to rest (puck.friction is 0): give run.time, or friction"
        )
    for finer in FINER:
        tol = max(asked * finer, min(asked, FINEST))
        try:
            closer = prepare(replace(scene, run=replace(scene.run, tol=tol)), last)
        except AccuracyError:  # a friction law is known no better
            break
        better = _estimate(closer, events)
        if not better <= 0.5 * estimate and estimate < math.inf:
            break
        prepared, estimate = closer, better
        if estimate <= asked or tol <= FINEST:
            break
    return prepared, estimate


def _estimate(prepared: Prepared, events: FloatArray) -> float:
    """How far a coarser twin is from a run, in units of Q/J and Q²/J: at its end, and on the way.

    Errors grow alike in both, and its own are much larger.
    """
    ends = [np.empty((PROBES + 1, FRAME_COLUMNS)) for _ in range(2)]
    how, end_time, *_ = prepared.follow(np.empty(0), ends[0], events, COARSER)
    if how in (TIME_UP, STEP_LIMIT, EVENT_LIMIT):  # else the run itself tells
        _refuse_failed(prepared.scene, how, end_time, prepared.ask.to_the_end)
    probes = end_time * np.arange(1, PROBES + 1) / (PROBES + 1)
    both_runs = [
        prepared.follow(probes, rows, events, coarser)
        for rows, coarser in zip(ends, (COARSER, 1.0), strict=True)
    ]
    reached = [run[4] for run in both_runs]
    both = min(reached)
    states = [
        np.concatenate([rows[:both], rows[n : n + 1]])
        for rows, n in zip(ends, reached, strict=True)
    ]
    gap = np.abs(states[0] - states[1])
    radius, unit = prepared.model.body.radius, prepared.speed / prepared.rate
    place = np.hypot(gap[:, 1 + X], gap[:, 1 + Y]) + radius * gap[:, 1 + THETA]
    worst = max(gap[-1, 0] / unit, place.max() / (prepared.speed * unit))
    # where events end the steps both may take the same: the errors of steps tell then
    return float(worst + STEP_SHARE * both_runs[1][5] + friction_error(prepared.scene))


def _refuse_failed(scene: Scene, how: int, end_time: float, to_the_end: bool) -> None:
    """Say why a run has no end."""
    if how in (TIME_UP, STEP_LIMIT) and scene.run.time is None and not to_the_end:
        long = "a million steps" if how == STEP_LIMIT else "a thousand times what friction takes"
        raise InputError(
            f"the puck still moves after {end_time:.4g} s, {long}: it may never stop; give run.time"
        )
    if how == NOT_FINITE and scene.floor.law:  # a state beyond the law is never reached
        top = speed_law(scene).top_speed
        raise InputError(
            f"at {end_time:.6g} s the rim slips faster than the friction law {law_name(scene)} "
            f"goes ({top:g} m/s): nothing is known beyond; give it more speeds"
        )
    if how in FAILURES:
        raise PuckError(FAILURES[how].format(time=end_time))


def columns_of(rows: FloatArray, prepared: Prepared) -> dict[str, FloatArray]:
    """Rows of the loop (n, 15) by the names of :data:`LEDGER`."""
    columns = dict(zip(LEDGER[:-1], rows.T, strict=True))
    columns["kinetic_energy"] = kinetic(rows.T[[1 + VX, 1 + VY, 1 + SPIN]], prepared)
    return columns


def kinetic(velocities: FloatArray, prepared: Prepared) -> FloatArray:
    """½ m v² + ½ I ω² of rows vx, vy, ω (3, …)."""
    vx, vy, spin = velocities
    body = prepared.model.body
    energy: FloatArray = 0.5 * body.mass * (vx * vx + vy * vy) + 0.5 * body.inertia * spin * spin
    return energy

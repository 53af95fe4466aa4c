"""One scene, from its launch to its end, by the cheapest exact model."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables._core.real import finite_array
from puck_tables.contact.speed_law import SpeedLaw
from puck_tables.errors import AccuracyError, ContactError, InputError, PuckError
from puck_tables.scene.at_once import AS_IT_COMES, FIRST_BY_NUMBER, LAST_BY_NUMBER
from puck_tables.scene.boundaries import BOUNCES
from puck_tables.scene.by_speed import FARTHER, FARTHEST, law_name, speed_law
from puck_tables.scene.friction import SPIN, THETA, VX, VY, X, Y
from puck_tables.scene.library import files_of
from puck_tables.scene.loop import LEANS
from puck_tables.scene.one_run import events_of, run_of
from puck_tables.scene.outcome import (
    ENDS,
    EVENT_LIMIT,
    LEDGER,
    NOT_FINITE,
    STEP_LIMIT,
    TIME_UP,
    UNDECIDED,
)
from puck_tables.scene.plain import run_plain
from puck_tables.scene.plan import Plan, ingredients, out_of_reach, plan_for
from puck_tables.scene.prepare import MAX_EVENTS, Prepared, Twin, prepare
from puck_tables.scene.records import EVENT_COLUMNS, FRAME_COLUMNS
from puck_tables.scene.regions import friction_error
from puck_tables.scene.run import Run
from puck_tables.scene.scene_spec import SceneSpec


def simulate(scene: SceneSpec, times: npt.ArrayLike | None = None) -> Run:
    """A run of a scene, as :meth:`puck_tables.Scene.simulate` has it."""
    whole = scene.single()
    moments = None if times is None else _checked(times)
    files = files_of(whole)
    needed = out_of_reach(whole)
    plan = plan_for(needed)
    if plan.plain:
        run = run_plain(whole, needed, plan, moments, simulate)
    else:
        run = _integrated(whole, plan, moments)
    return replace(run, files=files)


# two, for one may err as the run does by chance
TWINS = (Twin(30.0, 0.5), Twin(8.0, 0.3))
FINER = 1 / 30  # of the tolerance before: tried one after the other
FINEST, COARSEST = 1e-12, 1e-3
TRIALS = 4  # at most, but where two lines are met at once
ALIKE = 2.0  # times the gap more, where the steps of a run err as much as the twin's
PROBES = 7  # states on the way that are compared too
MOST_IN_VAIN = 2  # finer tolerances in a row that do not halve the estimate

FAILURES = {
    STEP_LIMIT: "no end after a million steps, at {time:.6g} s: ask for a shorter time",
    EVENT_LIMIT: "100000 events by {time:.6g} s: they crowd together without end (rebounds, or a "
    "border); move the launch, or end the run before with a time",
    NOT_FINITE: "the motion leaves floating point at {time:.6g} s: use other units",
    UNDECIDED: "it meets two lines at the same moment, and what follows depends on which is first: "
    "move the launch, or a wall",
}


def _checked(times: npt.ArrayLike) -> FloatArray:
    moments = np.atleast_1d(finite_array("times", times, "s"))
    if moments.ndim != 1 or not np.all(moments >= 0.0) or not np.all(np.diff(moments) >= 0.0):
        raise InputError("times must be a list of ascending numbers >= 0 s")
    return moments


def is_endless(scene: SceneSpec) -> bool:
    """Whether a scene has no friction and says neither where nor when it ends."""
    return scene.time is None and not scene.edges and "no dry friction" in ingredients(scene)


class _Followed(NamedTuple):
    """One run: how it ended, its states at the times asked and at the end, and the rest."""

    how: int
    end_time: float
    events: int
    steps: int
    wrong: float
    at_once: FloatArray
    states: FloatArray
    last: FloatArray


def _followed(
    prepared: Prepared, times: FloatArray, events: FloatArray, twin: Twin | None = None,
    order: int = AS_IT_COMES,
) -> _Followed:  # fmt: skip
    rows = np.empty((len(times) + 1, FRAME_COLUMNS))
    found, at_once = prepared.follow(times, rows, events, twin, order)
    how, end_time, count, steps, reached, wrong = found
    how, end_time = int(how), float(end_time)  # as written they may be of NumPy
    return _Followed(how, end_time, count, steps, wrong, at_once, rows[:reached], rows[reached])


def _integrated(scene: SceneSpec, plan: Plan, times: FloatArray | None) -> Run:
    """Run it at a tolerance of which a coarser twin tells that the error asked is kept."""
    if is_endless(scene):
        raise InputError(
            "nothing brings this scene to rest (puck.friction is 0): give a time, or friction"
        )
    prepared, run, estimate, events = _close_enough(scene, times)
    columns = columns_of(np.vstack([run.states, run.last]), prepared)
    energy = kinetic(prepared.state[[VX, VY, SPIN]], prepared)
    exact = {
        "error_estimate": estimate, "speed_scale": prepared.speed, "rate_scale": prepared.rate,
        "steps": run.steps, "simulated": simulate,
    }  # fmt: skip
    return run_of(
        scene, plan, ENDS[run.how], run.end_time, events_of(events, scene), columns, float(energy),
        exact,
    )  # fmt: skip


def _close_enough(
    scene: SceneSpec, times: FloatArray | None
) -> tuple[Prepared, _Followed, float, FloatArray]:
    """The scene at the coarsest tolerance that keeps the one asked, its run, estimate and events.

    Where finer steps help no more, rounding or what is known of friction has the last word.
    """
    asked = scene.tol
    last = None if times is None or not times.size else float(times[-1])
    room = np.empty((MAX_EVENTS, EVENT_COLUMNS))
    found: list[tuple[Prepared, _Followed, float, FloatArray]] = []
    in_vain, trials, tol, doubt = 0, 0, asked, 0.0
    while True:
        try:
            finer = replace(scene, tol=tol)
            prepared, run, estimate, doubt = _within_law(finer, last, times, room)
        except AccuracyError:  # a friction law is known no better
            if not found:
                raise
            break
        trials, in_vain = trials + 1, in_vain + 1
        if not found or estimate <= 0.5 * found[-1][2]:
            found.append((prepared, run, estimate, room[: run.events].copy()))
            in_vain = 0
        if estimate <= asked or tol <= FINEST:
            break
        if doubt <= asked and (trials == TRIALS or in_vain == MOST_IN_VAIN):
            break
        # the table of a law costs more the finer it is, and its error goes with its tolerance
        share = max(FINER, 0.5 * asked / estimate) if scene.floor.law else FINER
        tol = max(share * tol, FINEST)
    if doubt > asked:
        raise InputError(_met_at_once(scene, run.at_once))
    for coarser in (10.0 * asked, 100.0 * asked):  # finer steps may only add up rounding
        if found[-1][2] > asked and coarser <= COARSEST and not scene.floor.law:
            near = replace(scene, tol=coarser)
            prepared, run, estimate, doubt = _within_law(near, last, times, room)
            if estimate < found[-1][2] and doubt <= asked:
                found.append((prepared, run, estimate, room[: run.events].copy()))
    return found[-1]


class _BeyondLaw(InputError):
    """The slip goes beyond what the table of a friction law holds."""


def _within_law(
    scene: SceneSpec, last: float | None, times: FloatArray | None, room: FloatArray
) -> tuple[Prepared, _Followed, float, float]:
    """The scene, its run, estimate and doubt; the table of a law by name goes on as is needed."""
    reach, grown = 1.0, ""
    while True:
        try:
            prepared = prepare(scene, last, reach)
        except ContactError as error:  # not of the slip at the launch
            if not grown:
                raise
            raise InputError(
                f"{grown}, where friction by this law tilts the pressure so much that part of the "
                "base would lift: a slip that grows may never stop; give a shorter time, or "
                "less that drives it"
            ) from error
        try:
            return prepared, *_estimated(prepared, times, room)
        except _BeyondLaw as beyond:
            if isinstance(speed_law(scene), SpeedLaw) or reach >= FARTHEST:
                raise
            grown = str(beyond).partition(",")[0].replace(f"{FARTHEST:g} ", f"{reach:g} ")
            reach *= FARTHER


def _met_at_once(scene: SceneSpec, at_once: FloatArray) -> str:
    """Why a run has no end: it is not known which of two lines is first."""
    _, when, *numbers = at_once.tolist()
    walls = len(scene.walls)
    one, other = (
        f"wall[{int(n)}]" if n < walls else f"edge[{int(n) - walls}]" for n in sorted(numbers)
    )
    return (
        f"the puck meets {one} and {other} at the same moment, {when:.10g} s, and what follows "
        "depends on which of them is first: move the launch, or one of them, or end the run before "
        "with a time"
    )


def _estimated(
    prepared: Prepared, times: FloatArray | None, events: FloatArray
) -> tuple[_Followed, float, float]:
    """A run, and how far coarser twins are from it, in units of Q/J and Q²/J, on the way and last.

    Errors grow alike in both, and its own are much larger: a gap to one whose steps err no more,
    because it could take no longer ones, may be small by chance, and counts for more.  Also how far
    off it is if, of two lines that it meets at once, the other one is first.
    """
    first = _followed(prepared, np.empty(0), events)
    _refuse_failed(prepared, first)
    if times is None:
        times = np.linspace(0.0, first.end_time, int(prepared.scene.frames))
    probes = first.end_time * np.arange(1, PROBES + 1) / (PROBES + 1)
    hits, unit = _hits(events, first), prepared.speed / prepared.rate
    near = prepared.scene.tol * unit
    trials: list[tuple[Twin | None, int]] = [(twin, AS_IT_COMES) for twin in TWINS]
    if first.at_once[0] > 0.0:
        trials += [(None, FIRST_BY_NUMBER), (None, LAST_BY_NUMBER)]
    others = []
    for trial in trials:
        other = _followed(prepared, probes, events, *trial)
        others.append((other, _late(_hits(events, other), hits, near)))
    whole = np.concatenate([probes, times])
    place = np.argsort(whole, kind="stable")
    run = _followed(prepared, whole[place], events)
    probed = place[: len(run.states)] < PROBES
    seen = run._replace(states=run.states[probed])
    gaps = [max(_gap(prepared, other, seen), late / unit) for other, late in others]
    alike = [min(1.0, run.wrong / max(other.wrong, 1e-300)) for other, _ in others]
    gap = max((1.0 + ALIKE * a) * g for a, g in zip(alike, gaps[: len(TWINS)], strict=False))
    doubt = max([0.0, *gaps[len(TWINS) :]])
    error = max(gap, doubt) + run.wrong + friction_error(prepared.scene)
    return run._replace(states=run.states[~probed]), error, doubt


def _hits(events: FloatArray, run: _Followed) -> list[tuple[float, list[float]]]:
    """The walls that a run hits, one after the other, and when it does until it stays or leaves."""
    series: list[tuple[float, list[float]]] = []
    stays = True
    for time, what, wall in events[: run.events, :3].tolist():
        if what in (BOUNCES, LEANS):
            if stays or series[-1][0] != wall:
                series.append((wall, []))
            series[-1][1].append(time)
            stays = what == LEANS
    return series


def _late(
    one: list[tuple[float, list[float]]], other: list[tuple[float, list[float]]], near: float
) -> float:
    """By how much, s, rebounds at one wall differ of runs that come there within ``near`` s.

    The velocity between them is as good.  How many they take one by one may differ.
    """
    late = 0.0
    for (wall, times), (facing, moments) in zip(one, other, strict=False):
        if wall != facing or abs(times[0] - moments[0]) > near:
            break
        late = max(late, *(abs(t - s) for t, s in zip(times, moments, strict=False)))
    return late


def _gap(prepared: Prepared, twin: _Followed, run: _Followed) -> float:
    """How far apart two runs are at the states that both reached, and at their ends."""
    seen = min(len(twin.states), len(run.states))
    gap = np.abs(
        np.vstack([twin.states[:seen], twin.last]) - np.vstack([run.states[:seen], run.last])
    )
    radius, unit = prepared.model.body.radius, prepared.speed / prepared.rate
    place = np.hypot(gap[:, 1 + X], gap[:, 1 + Y]) + radius * gap[:, 1 + THETA]
    return float(max(gap[-1, 0] / unit, place.max() / (prepared.speed * unit)))


def _refuse_failed(prepared: Prepared, run: _Followed) -> None:
    """Say why a run has no end."""
    scene, how, end_time = prepared.scene, run.how, run.end_time
    to_the_end = prepared.ask.to_the_end
    if how == TIME_UP and not to_the_end and run.last[LEDGER.index("carried")]:
        raise InputError(
            f"after {end_time:.4g} s the floor still carries the puck towards a wall, an edge, a "
            "border or a patch, and it may slip there again; give a time"
        )
    if how == STEP_LIMIT and scene.lateral.strength != 0.0 and scene.lateral.speed_exponent < 1.0:
        raise InputError(
            f"a million steps by {end_time:.6g} s: the slower a puck that still spins, the faster "
            "a lateral force turns its way if lateral.speed_exponent is below 1; give one from 1 "
            "on, or end the run before with a time"
        )
    if how in (TIME_UP, STEP_LIMIT) and scene.time is None and not to_the_end:
        long = "a million steps" if how == STEP_LIMIT else "a thousand times what friction takes"
        raise InputError(
            f"the puck still moves after {end_time:.4g} s, {long}: it may never stop; give a time"
        )
    if how == NOT_FINITE and scene.floor.law:  # a state beyond the law is never reached
        law = speed_law(scene)
        if isinstance(law, SpeedLaw):
            raise _BeyondLaw(
                f"at {end_time:.6g} s the rim slips faster than the friction law {law_name(scene)} "
                f"goes ({law.top_speed:g} m/s): nothing is known beyond; give it more speeds"
            )
        raise _BeyondLaw(
            f"at {end_time:.6g} s the rim slips {FARTHEST:g} times faster than at the launch, "
            "beyond the table of the friction law: give a shorter time, or more friction"
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

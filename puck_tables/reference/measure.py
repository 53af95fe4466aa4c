"""One run of an engine against the exact answer."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.errors import InputError
from puck_tables.reference.answer import Answer
from puck_tables.reference.floor_reaction import ratios, slip_over
from puck_tables.reference.log import Log
from puck_tables.reference.threshold import Rest, Threshold, rest_of_rows, why_no_rest

_LATE = 1.5  # steps: a log may begin after the first of them
_OFF = 0.02  # of Q and Q²/J: a launch that is off by more is another
_STEP_OFF = 3.0  # steps of J: what an engine may be off by after the first of them


@dataclass(frozen=True)
class MeasuredRun:
    """A run and its errors: theirs less the exact.

    Over ``time`` (n,) s, up to the end of the case: ``dx``, ``dy`` m, ``place`` = hypot m,
    ``speed`` m/s (size of the difference of velocities), ``spin`` rad/s, ``angle`` rad,
    ``epsilon`` (of those seen, ``seen_epsilon``, less the exact, ``exact_epsilon``); None where the
    log has no such column.  ``rest``: when and where theirs is below the threshold, None: it is not
    within the log; ``exact_rest``: the same read from rows of the exact motion at the same times,
    so that rows far apart make no error; ``stop_place`` m: how far from the exact stop it lies at
    the end of the log, None: it is not at rest there; ``why``: why it tells nothing of rest.
    """

    log: Log
    step: float
    time: FloatArray
    dx: FloatArray
    dy: FloatArray
    place: FloatArray
    angle: FloatArray | None
    speed: FloatArray | None
    spin: FloatArray | None
    seen_speed: FloatArray | None
    seen_rim: FloatArray | None
    seen_epsilon: FloatArray | None
    exact_epsilon: FloatArray
    rest: Rest | None
    exact_rest: Rest | None
    stop_place: float | None
    why: str

    @property
    def epsilon(self) -> FloatArray | None:
        """Error of ε over time; NaN where either is at rest."""
        return None if self.seen_epsilon is None else self.seen_epsilon - self.exact_epsilon

    def worst(self, name: str) -> float:
        """The largest size of an error over time; NaN where there is none."""
        row = getattr(self, name)
        return math.nan if row is None or row.size == 0 else float(np.abs(row).max())


def measured(
    log: Log, answer: Answer, puck: int | None, thresholds: tuple[Threshold, ...],
    step: float | None = None,
) -> MeasuredRun:  # fmt: skip
    """Hold a run against the answer.

    ``puck``: which of several; ``thresholds``: below which it counts as at rest; ``step``: s, of
    the engine; left out, the distance of its rows.  Raises InputError if its times do not start at
    the launch, or its first row is not that of the case.

    >>> from puck_tables.reference.answer import reference_case
    >>> exact = reference_case("slide", dt=0.1)
    >>> log = Log("a", exact.time, exact.x + 1e-3, exact.y, None, None, None, None, 0.1, ())
    >>> float(measured(log, exact, None, ()).place.max().round(9))
    0.001
    """
    _refuse_other_launch(log, answer, puck)
    end_time = answer.end_time_of(puck)
    until = answer.end_time if answer.end == "time is up" else math.inf
    rows = log.time <= until * (1.0 + 1e-12)
    time = np.minimum(log.time[rows], until)
    exact = answer(np.maximum(time, 0.0)).states_of(puck)
    radius = answer.pucks[puck or 0].radius
    dx, dy = log.x[rows] - exact["x"], log.y[rows] - exact["y"]
    angle = None
    if log.angle is not None:
        off = log.angle[rows] - exact["orientation"]
        off -= off[0] if log.time[0] == 0.0 else 2.0 * np.pi * np.round(off[0] / (2.0 * np.pi))
        angle = np.unwrap(off)
    mine = slip_over(answer.floor, exact)
    exact_epsilon, _ = ratios(mine, radius)
    speed = spin = seen_speed = seen_rim = seen_epsilon = None
    theirs = {"time": log.time, "x": log.x, "y": log.y}
    if log.spin is not None:
        spin = log.spin[rows] - exact["spin"]
        theirs["spin"] = log.spin
    if log.vx is not None and log.vy is not None:
        speed = np.hypot(log.vx[rows] - exact["vx"], log.vy[rows] - exact["vy"])
        theirs |= {"vx": log.vx, "vy": log.vy}
    rest = exact_rest = stop_place = None
    lacks = {"velocities": log.vx is None, "spin": log.spin is None}
    without = " and ".join(name for name, lacking in lacks.items() if lacking)
    why = f"no {without} in it, so nothing of rest" if without else ""
    if len(theirs) == 6:
        slip = slip_over(answer.floor, {name: row[rows] for name, row in theirs.items()})
        seen_epsilon, _ = ratios(slip, radius)
        seen_speed, seen_rim, _ = slip.sizes(radius)
        if answer.end != "time is up":
            rest = rest_of_rows(time, theirs, answer, puck, thresholds)
            why = why_no_rest(time, theirs, answer, puck, thresholds) if rest is None else ""
            more = np.arange(time[-1] + log.step, end_time + 2.0 * log.step, log.step)
            longer = np.concatenate([time, more])  # a log may end with the rest in it
            exactly = answer(np.maximum(longer, 0.0)).states_of(puck)
            exact_rest = rest_of_rows(longer, exactly, answer, puck, thresholds)
            if rest is not None and answer.end == "at rest":
                end = answer([end_time]).states_of(puck)
                stop_place = math.dist((log.x[-1], log.y[-1]), (end["x"][0], end["y"][0]))
    return MeasuredRun(
        log, log.step if step is None else step, time, dx, dy, np.hypot(dx, dy), angle, speed,
        spin, seen_speed, seen_rim, seen_epsilon, exact_epsilon, rest, exact_rest, stop_place, why,
    )  # fmt: skip


def _refuse_other_launch(log: Log, answer: Answer, puck: int | None) -> None:
    """Refuse a log that does not start at the launch of the case."""
    first = float(log.time[0])
    case = answer.case.name
    end_time = answer.end_time_of(puck)
    tiny = 1e-9 * end_time
    if first < -tiny or first > _LATE * log.step + tiny:
        raise InputError(
            f"{log.name}: its times start at {first:.6g} s, and must start at the launch, 0 s, or "
            f"a step later: say when the launch is with launch_time (--launch-time), if it is in "
            "the file"
        )
    if first > end_time:
        raise InputError(f"{log.name}: its first row is later than the end of case {case}")
    exact = answer([max(first, 0.0)]).states_of(puck)
    q, j = answer.speed_scale, answer.rate_scale
    late = _STEP_OFF * j * first
    for names, scale, unit in (
        (("x", "y"), q * q / j, "m"), (("vx", "vy"), q, "m/s"), (("spin",), 1.0, "rad/s"),
    ):  # fmt: skip
        rows = [getattr(log, name) for name in names]
        if any(row is None for row in rows):
            continue
        theirs = [float(row[0]) for row in rows]
        ours = [float(exact[name][0]) for name in names]
        size = q / answer.pucks[puck or 0].radius if names == ("spin",) else scale
        allowed = _OFF * size + (late * size / q)
        if math.dist(theirs, ours) > allowed:
            shown = [f"({', '.join(f'{one:.6g}' for one in both)})" for both in (theirs, ours)]
            raise InputError(
                f"{log.name}: its first row is not the launch of case {case}: {', '.join(names)} = "
                f"{shown[0]} {unit} at {first:.6g} s, and must be {shown[1]}: check units, axes "
                "and when the launch is"
            )

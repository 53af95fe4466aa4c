"""Runs of an engine against the exact answer to a case: what is error, and what is truth."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from puck_tables._core.arrays import instance, positive
from puck_tables.errors import InputError
from puck_tables.io.columns import Dataset, Variable, variable
from puck_tables.reference.answer import Answer, reference_case
from puck_tables.reference.log import LogHow, read_log
from puck_tables.reference.measure import MeasuredRun, measured
from puck_tables.reference.threshold import Rest, Threshold, exact_rest, threshold_of, usual
from puck_tables.result import Result

_SHOWN = 1e-3  # of a ratio: what rows show otherwise is said
_CONVERGING = {
    "rest_time_error": "stop time", "stop_place_error": "stop place",
    "place_error_max": "place on the way", "speed_error_max": "velocity on the way",
    "spin_error_max": "spin on the way",
}  # fmt: skip
FALLS = 0.25  # the order below which errors do not fall
_EVEN = 1.0  # orders further apart are none


@dataclass(frozen=True, eq=False, repr=False)
class Comparison(Result):
    """Runs held against the answer to a case, by falling step.

    ``answer``: exact; ``puck``: which of several; ``runs``: one of each file;
    ``thresholds``: below which a puck counts as at rest; ``exact_rest``: when, where and with which
    ε the exact motion is below them, None where it does not stop.

    Columns (runs,): ``step`` s; ``rest_time`` s and ``rest_time_error`` s, when it is below the
    thresholds, and that less the time that the exact motion shows in the same rows;
    ``stop_place_error`` m, of the place at the end of the file; ``place_error_max`` m,
    ``speed_error_max`` m/s, ``spin_error_max`` rad/s, ``angle_error_max`` rad: the largest on the
    way; ``epsilon_seen`` at the thresholds and ``epsilon_error``, that less the ε that the exact
    motion shows in the same rows.  NaN where a file does not tell.
    """

    answer: Answer
    puck: int | None
    runs: tuple[MeasuredRun, ...]
    thresholds: tuple[Threshold, ...]
    exact_rest: Rest | None

    picture: ClassVar[str] = "comparison"

    @property
    def end_time(self) -> float:
        """When the case ends for the puck that is compared, s."""
        return self.answer.end_time_of(self.puck)

    @property
    def whose(self) -> str:
        """The name of the puck with a blank behind it; nothing of a single one."""
        return "" if self.puck is None else f"{self.answer.names[self.puck]} "

    @property
    def transient(self) -> float | None:
        """Exact ε at the thresholds less its limit: no error of any engine; None: there is none."""
        limit, rest = self.answer.limit_epsilon, self.exact_rest
        if limit is None or rest is None or not math.isfinite(rest.epsilon + limit):
            return None
        return rest.epsilon - limit

    def rows(self) -> list[dict[str, float]]:
        """The numbers of each run, by the names of columns."""
        return [self._row(one) for one in self.runs]

    def _row(self, run: MeasuredRun) -> dict[str, float]:
        exact, seen = run.exact_rest, run.rest
        both = exact is not None and seen is not None
        nan = math.nan
        return {
            "step": run.step,
            "rest_time": seen.time if seen is not None else nan,
            "rest_time_error": seen.time - exact.time if both else nan,  # type: ignore[union-attr]
            "stop_place_error": nan if run.stop_place is None else run.stop_place,
            "place_error_max": run.worst("place"),
            "speed_error_max": run.worst("speed"),
            "spin_error_max": run.worst("spin"),
            "angle_error_max": run.worst("angle"),
            "epsilon_seen": seen.epsilon if seen is not None else nan,
            "epsilon_error": seen.epsilon - exact.epsilon if both else nan,  # type: ignore[union-attr]
        }  # fmt: skip

    def convergence(self) -> dict[str, str]:
        """What the errors of several runs do as the step falls, in words."""
        rows = self.rows()
        steps = [row["step"] for row in rows]
        if len(rows) < 2:
            return {}
        return {
            words: verdict(steps, [row[name] for row in rows])
            for name, words in _CONVERGING.items()
            if all(math.isfinite(row[name]) for row in rows)
        }

    def untold(self) -> list[str]:
        """What files do not tell, and why."""
        return [f"{run.log.name}: {run.why}" for run in self.runs if run.why]

    def truths(self) -> list[str]:
        """What is no error of an engine though it differs from a number of the literature."""
        answer, exact = self.answer, self.exact_rest
        lines = []
        if exact is not None:
            met = ", ".join(map(str, self.thresholds))
            lines.append(
                f"the threshold {met} is met {self.end_time - exact.time:.4g} s before the exact "
                "stop: a stop read there is early by that, in truth"
            )
        if exact is not None and self.transient is not None:
            lines.append(
                f"v/(r w) is {exact.epsilon:.6g} there, {self.transient:+.3g} off its limit "
                f"{answer.limit_epsilon:.6g}: the limit is reached at the stop alone, so this is "
                "truth and not error"
            )
        for run in self.runs:
            read = run.exact_rest
            if exact is not None and read is not None and _differ(read.epsilon, exact.epsilon):
                lines.append(
                    f"in rows {run.log.step:.4g} s apart ({run.log.name}) the exact motion itself "
                    f"would show v/(r w) = {read.epsilon:.6g} at the threshold: only what differs "
                    "from that is counted as error"
                )
        puck = answer.puck_at_end
        if answer.limit_epsilon is not None and puck is not None and puck.delta > 0.0:
            lines.append(
                f"the limit {answer.limit_epsilon:.6g} is that of this puck with delta = "
                f"{puck.delta:.4g} where it stops; 0.653 is that of a flat homogeneous disc"
            )
        if answer.end == "carried by the floor":
            lines.append("at rest on the floor the puck is carried on by it: it has no stop place")
        if answer.end == "time is up":
            lines.append("the motion of this case does not stop while it is followed")
        return lines

    def remarks(self) -> dict[str, list[str]]:
        """What is said of the runs besides their numbers, by headings."""
        fallen = [f"{words}: {what}" for words, what in self.convergence().items()]
        worst = {
            "not told": self.untold(), "as the step falls": fallen,
            "truth and not error": self.truths(),
        }  # fmt: skip
        return {head: texts for head, texts in worst.items() if texts}

    def __repr__(self) -> str:
        count = len(self.runs)
        return f"Comparison({self.answer.case.label}: {count} run{'s' if count != 1 else ''})"

    def explain(self) -> str:
        """How the answer was computed, and how files were read."""
        notes = [f"{run.log.name}: {'; '.join(run.log.notes) or 'as it says'}" for run in self.runs]
        return "\n".join([self.answer.explain(), *notes])

    def summary(self) -> dict[str, Any]:
        """All numbers, ready for JSON; what is not known is null."""
        exact = self.exact_rest
        return {
            "case": self.answer.case.name,
            "version": self.answer.case.version,
            "end": self.answer.end,
            "puck": self.whose.strip() or None,
            "end_time": self.end_time,
            "thresholds": [str(one) for one in self.thresholds],
            "exact_rest": None if exact is None else _known(exact._asdict()),
            "limit_epsilon": self.answer.limit_epsilon,
            "transient_epsilon": self.transient,
            "bounds": {
                n: getattr(self.answer, n) for n in ("time_bound", "place_bound", "speed_bound")
            },
            "runs": [
                {"file": run.log.name, "why": run.why or None, **_known(row)}
                for run, row in zip(self.runs, self.rows(), strict=True)
            ],
            "convergence": self.convergence(),
            "truths": self.truths(),
        }

    def dataset(self) -> Dataset:
        """One row a run."""
        rows = self.rows()
        columns: dict[str, Variable] = {
            "case": variable("case", self.answer.case.label, ()),
            "file": variable("file", [run.log.name for run in self.runs], ("run",)),
        }
        for name in rows[0]:
            columns[name] = variable(name, np.array([row[name] for row in rows]), ("run",))
        summary = self.summary()
        kept = {
            name: summary[name] for name in ("case", "version", "end", "end_time", "thresholds")
        }
        if self.puck is not None:
            kept["puck"] = summary["puck"]
        if self.transient is not None:
            kept |= {"limit_epsilon": summary["limit_epsilon"], "transient_epsilon": self.transient}
        axes = {"run": variable("run", np.arange(len(rows)), ("run",))}
        return Dataset(axes, columns, kept)


def _differ(one: float, other: float) -> bool:
    """Whether rows show another ratio than there is."""
    return math.isfinite(one + other) and abs(one - other) > _SHOWN * abs(other)


def _known(numbers: dict[str, float]) -> dict[str, float | None]:
    return {name: one if math.isfinite(one) else None for name, one in numbers.items()}


def compare(
    files: str | Path | Sequence[str | Path], case: str, *, columns: str | None = None,
    unit: str | None = None, angle_unit: str | None = None, up: str | None = None,
    puck: str | None = None, launch_time: float = 0.0,
    thresholds: Sequence[str] = (), steps: Sequence[float] | None = None,
) -> Comparison:  # fmt: skip
    """Hold runs of an engine against the exact answer to a case.

    Parameters
    ----------
    files : path, or several of falling step
        Tables with columns t, x, y and, for all that is said, an angle or a quaternion qw, qx, qy,
        qz, velocities vx, vy and the spin w, in any order, with units in the header.
    case : name of the case
    columns : headings in place of those in the files, '-' for a column to leave out
    unit, angle_unit : of lengths and angles, where a file does not say (velocities: a second)
    up : 'y' or 'z', the axis that points up, of places with three
    puck : name of the puck, of a case of several
    launch_time : s, when the launch is
    thresholds : speeds and spins below which the engine says rest: '0.1rad/s', '1mm/s'
        Left out: hypot(v, rω) below a hundredth of that of the launch.
    steps : s, of the engine in each file; left out, the distance of its rows

    Raises
    ------
    InputError
        If there is no such case, a file cannot be read, its units or axes cannot be told, or it
        does not start at the launch of the case.

    Examples
    --------
    >>> import tempfile
    >>> exact = reference_case("coin", dt=0.001)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     exact.save(folder + "/theirs.csv")
    ...     found = compare(folder + "/theirs.csv", "coin", thresholds=["0.1rad/s"])
    >>> found.rows()[0]["place_error_max"], round(found.exact_rest.epsilon, 5)
    (0.0, 0.66486)
    """
    paths = [files] if isinstance(files, str | Path) else list(files)
    if not paths:
        raise InputError("there is no file to compare")
    instance("thresholds", thresholds, list, tuple)
    answer = reference_case(case, times=[0.0])
    number = answer.puck_number(puck)
    how = LogHow(columns, unit, angle_unit, up, puck, launch_time, number)
    limits = tuple(threshold_of(one) for one in thresholds) or (usual(answer),)
    sizes: list[float | None] = [None] * len(paths)
    if steps is not None:
        if len(steps) != len(paths):
            raise InputError(f"steps are {len(steps)} and files {len(paths)}: give one for each")
        sizes = [positive("steps", one, "s") for one in steps]
    runs = [
        measured(read_log(path, how), answer, number, limits, size)
        for path, size in zip(paths, sizes, strict=True)
    ]
    runs.sort(key=lambda one: -one.step)
    if len({run.step for run in runs}) < len(runs):
        raise InputError(
            "two files have the same step: say the steps of the engine with steps (--steps), or "
            "compare them one by one"
        )
    return Comparison(answer, number, tuple(runs), limits, exact_rest(answer, number, limits))


def orders(steps: Sequence[float], errors: Sequence[float]) -> list[float]:
    """The order p of error ~ step^p between neighbours, from the largest step on.

    Returns list of float: one less than steps; NaN where an error is 0 or not known.

    >>> orders([0.1, 0.05, 0.025], [4.0, 1.0, 0.25])
    [2.0, 2.0]
    """
    ordered = sorted(zip(steps, errors, strict=True), reverse=True)
    result = []
    for (h1, e1), (h2, e2) in pairwise(ordered):
        known = all(math.isfinite(e) and e != 0.0 for e in (e1, e2))
        result.append(math.log(abs(e1 / e2)) / math.log(h1 / h2) if known else math.nan)
    return result


def verdict(steps: Sequence[float], errors: Sequence[float]) -> str:
    """In words, what the last of these orders says.

    >>> verdict([0.1, 0.05], [4.0, 1.0]), verdict([0.1, 0.05], [1.0, 1.0])
    ('order 2.00', 'does not fall with the step (order 0.00): it is of the model, not of the step')
    """
    order = orders(steps, errors)
    if not order or not math.isfinite(order[-1]):
        return "not known"
    if order[-1] < FALLS:
        return (
            f"does not fall with the step (order {order[-1]:.2f}): it is of the model, not of the "
            "step"
        )
    numbers = ", ".join(f"{one:.2f}" for one in order)
    if max(order) - min(order) > _EVEN:
        return f"falls unevenly (orders {numbers}): no order can be told"
    return f"order {numbers}"

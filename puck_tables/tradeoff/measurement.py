"""All methods measured on this machine: errors once, costs in rounds that share the noise."""

from __future__ import annotations

import os
import platform
import time
from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from functools import partial
from importlib.metadata import version
from timeit import timeit
from typing import Any, ClassVar

import numpy as np

from puck_tables._version import __version__
from puck_tables.accuracy.method_errors import MeasuredMethod
from puck_tables.io.dataset import Dataset, variable
from puck_tables.kernels.patience import compiled_at_once
from puck_tables.result import Result
from puck_tables.tradeoff import body_methods, resultant_methods, state_methods, stop_methods
from puck_tables.tradeoff.truth import Contender, random_points

Progress = Callable[[int, int], None]

REPEATS, QUICK_REPEATS = 25, 5  # of a measurement, of which the least time counts
_POINTS, _QUICK_POINTS = 4000, 1000  # at which errors are looked for
_SHORTEST = 1e-3  # s; below it a round repeats the run


@dataclass(frozen=True, eq=False, repr=False)
class TradeOff(Result):
    """What was measured.

    ``methods``; the ``machine`` in words; ``repeats``; ``seconds`` it all took.
    """

    methods: tuple[MeasuredMethod, ...]
    machine: dict[str, str]
    repeats: int
    seconds: float

    picture: ClassVar[str] = "tradeoff"

    def __repr__(self) -> str:
        return f"TradeOff({len(self.methods)} methods, {self.repeats} rounds)"

    def explain(self) -> str:
        """How it was got."""
        return f"medians of {self.repeats} rounds on one thread of this machine"

    def dataset(self) -> Dataset:
        """Methods with their errors and costs; the machine as attributes."""
        names = [field.name for field in fields(MeasuredMethod)]
        columns = {name: variable(name, self._column(name), ("contender",)) for name in names}
        told = [f"{method.question}: {method.name}" for method in self.methods]
        return Dataset({"contender": variable("contender", told, ("contender",))}, columns, {
            "title": "Accuracy against cost of methods to friction resultants, stops and states",
            "repeats": self.repeats, "seconds": self.seconds,
            **{f"machine_{k}": v for k, v in self.machine.items()},
        })  # fmt: skip

    def _column(self, name: str) -> Any:
        values = [getattr(method, name) for method in self.methods]
        return values if isinstance(values[0], str) else np.asarray(values)


@compiled_at_once()
def measure(quick: bool = False, progress: Progress | None = None) -> TradeOff:
    """Measure accuracy against cost of every method of answering, on one thread of this machine.

    Parameters
    ----------
    quick : bool
        Fewer repeats and points: under a minute instead of some.
    progress : callable (done, total), optional

    Returns
    -------
    TradeOff

    Notes
    -----
    Errors: against :mod:`puck_tables.tradeoff.truth`.  Costs: every round runs every method once
    (or for a millisecond, if that is longer), in turn; the median over the rounds is reported, with
    the distance between the quartiles.
    """
    begin = time.perf_counter()
    machine = describe()
    repeats = QUICK_REPEATS if quick else REPEATS
    points = random_points(_QUICK_POINTS if quick else _POINTS)
    contenders = [
        *resultant_methods.contenders(points),
        *stop_methods.contenders(),
        *state_methods.contenders(),
        *body_methods.contenders(),
    ]
    total = 2 * len(contenders) + repeats
    runs, methods = [], []
    for number, contender in enumerate(contenders):
        run, count, answers, method = _prepared(contender)
        runs.append((run, count, answers))
        methods.append(method)
        if progress is not None:
            progress(2 * number + 2, total)
    costs = np.empty((len(runs), repeats))  # ns
    for repeat in range(repeats):
        for n, (run, count, answers) in enumerate(runs):
            costs[n, repeat] = 1e9 * timeit(run, number=count) / (count * answers)
        if progress is not None:
            progress(2 * len(runs) + repeat + 1, total)
    low, middle, high = np.quantile(costs, [0.25, 0.5, 0.75], axis=1)
    timed = (
        replace(method, ns=float(ns), ns_spread=float(spread))
        for method, ns, spread in zip(methods, middle, high - low, strict=True)
    )
    return TradeOff(tuple(timed), machine, repeats, time.perf_counter() - begin)


def _prepared(contender: Contender) -> tuple[Callable[[], object], int, int, MeasuredMethod]:
    """A run for the clock, how often a round repeats it, how much it answers, and its errors."""
    question = contender.question
    start = time.perf_counter()
    built = contender.build()
    build = time.perf_counter() - start
    run = contender.prepare(built)
    time_error, place_error = question.errors(run(question.inputs))
    error = np.maximum(time_error, place_error)
    clocked = partial(run, np.ascontiguousarray(question.timed[:, : contender.items]))
    answers = np.size(clocked()) // 3
    count = max(1, int(_SHORTEST / timeit(clocked, number=1)))
    return clocked, count, answers, MeasuredMethod(
        question.name, contender.method, contender.setting, int(contender.outsider),
        error=float(error.max()), median_error=float(np.median(error)),
        time_error=float(time_error.max()), place_error=float(place_error.max()),
        ns=0.0, ns_spread=0.0, bytes=_bytes(built), build_s=build,
    )  # fmt: skip


def _bytes(built: object) -> int:
    """Of the tables that a method keeps."""
    each = built if isinstance(built, tuple) else (built,)
    return sum(one.nbytes for one in each if isinstance(one, np.ndarray))


def describe() -> dict[str, str]:
    """The machine a measurement was made on, in words: processor, system and versions."""
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    load = f"{os.getloadavg()[0]:.1f}" if hasattr(os, "getloadavg") else "unknown"
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            named = [line.partition(":")[2].strip() for line in file if "model name" in line]
    except OSError:
        named = []
    return {
        "processor": (named or [platform.processor() or platform.machine()])[0],
        "cores": str(cores), "load": f"{load} at the start",
        "system": f"{platform.system()} {platform.machine()}",
        "python": platform.python_version(),
        **{name: version(name) for name in ("numpy", "numba", "scipy")},
        "puck-tables": __version__,
    }  # fmt: skip

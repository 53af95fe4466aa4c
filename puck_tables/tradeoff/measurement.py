"""All methods measured on this machine: errors once, costs in rounds that share the noise."""

from __future__ import annotations

import os
import platform
import re
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, fields, replace
from functools import partial
from importlib.metadata import version
from pathlib import Path
from timeit import timeit
from typing import ClassVar

import numpy as np

from puck_tables._core.executor import usable_cores
from puck_tables._core.waiting import Progress
from puck_tables._version import __version__
from puck_tables.accuracy.method_errors import MeasuredMethod
from puck_tables.io.columns import Dataset, variable
from puck_tables.kernels.patience import compiled_at_once
from puck_tables.result import Result
from puck_tables.tradeoff import motion_methods, resultant_methods, scipy_methods
from puck_tables.tradeoff.truth import Contender, random_points

REPEATS, QUICK_REPEATS = 25, 5  # of a measurement, of which the least time counts
_POINTS, _QUICK_POINTS = 4000, 1000  # at which errors are looked for
_SHORTEST = 1e-3  # s; below it a round repeats the run


@dataclass(frozen=True, eq=False, repr=False)
class TradeOff(Result):
    """Methods with their errors and costs, the machine in words, rounds, what it all took in s."""

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
        columns, dims = {}, ("contender",)
        for name in (field.name for field in fields(MeasuredMethod)):
            row = [getattr(method, name) for method in self.methods]
            values = row if isinstance(row[0], str) else np.asarray(row)
            columns[name] = variable(name, values, dims)
        names = [f"{method.question}: {method.name}" for method in self.methods]
        return Dataset({"contender": variable("contender", names, dims)}, columns, {
            "title": "Accuracy against cost of methods to friction resultants, stops and states",
            "repeats": self.repeats, "seconds": self.seconds,
            **{f"machine_{k}": v for k, v in self.machine.items()},
        })  # fmt: skip


@compiled_at_once()
def measure(quick: bool = False, progress: Progress | None = None) -> TradeOff:
    """Measure accuracy against cost of every method of answering, on one thread of this machine.

    ``quick``: fewer repeats and points.  Errors are against :mod:`puck_tables.tradeoff.truth`.
    Every round runs every method once (or for a millisecond, if that is longer), in turn; the
    median over the rounds is the cost, with the distance between the quartiles.
    """
    begin, machine = time.perf_counter(), describe()
    repeats, count = (QUICK_REPEATS, _QUICK_POINTS) if quick else (REPEATS, _POINTS)
    contenders = [
        *resultant_methods.contenders(random_points(count)), *motion_methods.contenders(),
        *scipy_methods.contenders(),
    ]  # fmt: skip
    progress = progress or (lambda done, total: None)
    total = 2 * len(contenders) + repeats
    runs, methods = [], []
    for number, contender in enumerate(contenders):
        run, method = _prepared(contender)
        runs.append(run)
        methods.append(method)
        progress(2 * number + 2, total)
    costs = np.empty((len(runs), repeats))  # ns
    for repeat in range(repeats):
        costs[:, repeat] = [run() for run in runs]
        progress(2 * len(runs) + repeat + 1, total)
    low, middle, high = np.quantile(costs, [0.25, 0.5, 0.75], axis=1)
    timed = (
        replace(method, ns=float(ns), ns_spread=float(spread))
        for method, ns, spread in zip(methods, middle, high - low, strict=True)
    )
    return TradeOff(tuple(timed), machine, repeats, time.perf_counter() - begin)


def _prepared(contender: Contender) -> tuple[Callable[[], float], MeasuredMethod]:
    """What runs it and says the ns an answer took, for a millisecond or once, and its errors."""
    question = contender.question
    start = time.perf_counter()
    kept, run = contender.make()
    build = time.perf_counter() - start
    time_error, place_error = question.errors(run(question.inputs))
    error = np.maximum(time_error, place_error)
    clocked = partial(run, np.ascontiguousarray(question.timed[:, : contender.items]))
    answers = np.size(clocked()) // 3
    count = max(1, int(_SHORTEST / timeit(clocked, number=1)))
    arrays = kept if isinstance(kept, tuple) else (kept,)
    method = MeasuredMethod(
        question.name, contender.method, contender.setting, int(contender.outsider),
        error=float(error.max()), median_error=float(np.median(error)),
        time_error=float(time_error.max()), place_error=float(place_error.max()),
        ns=0.0, ns_spread=0.0, build_s=build,
        bytes=sum(one.nbytes for one in arrays if isinstance(one, np.ndarray)),
    )  # fmt: skip
    return lambda: 1e9 * timeit(clocked, number=count) / (count * answers), method


def describe() -> dict[str, str]:
    """The machine a measurement was made on, in words: processor, system and versions."""
    load = f"{os.getloadavg()[0]:.1f}" if hasattr(os, "getloadavg") else "unknown"
    about, named = Path("/proc/cpuinfo"), list[str]()
    with suppress(OSError):
        named = re.findall(r"model name\s*: (.*)", about.read_text("utf-8"))
    return {
        "processor": (named or [platform.processor() or platform.machine()])[0],
        "cores": str(usable_cores()), "load": f"{load} at the start",
        "system": f"{platform.system()} {platform.machine()}",
        "python": platform.python_version(),
        **{name: version(name) for name in ("numpy", "numba", "scipy")},
        "puck-tables": __version__,
    }  # fmt: skip

"""All methods measured on this machine: errors once, costs in rounds that share the noise."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import Any, ClassVar

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.accuracy.method_errors import MeasuredMethod
from puck_tables.io.dataset import Dataset, variable
from puck_tables.kernels.patience import compiled_at_once
from puck_tables.result import Result
from puck_tables.stopping.stop_table import StopTable
from puck_tables.table.resultant_table import ResultantTable
from puck_tables.tradeoff import resultant_methods, state_methods, stop_methods
from puck_tables.tradeoff.contender import Contender, Ready
from puck_tables.tradeoff.machine import describe
from puck_tables.tradeoff.truth import Points, golden_starts, random_points

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
    chosen = points.delta == 0.0
    flat = Points(points.phi[chosen], points.delta[chosen], points.resultants[:, chosen])
    table, stop_table = ResultantTable.shipped(), StopTable.shipped()
    contenders: list[Contender] = [
        *resultant_methods.contenders(resultant_methods.ResultantTask(points, flat)),
        *stop_methods.contenders(stop_methods.StopTask(golden_starts(), flat, table, stop_table)),
        *state_methods.contenders(state_methods.StateTask(table, stop_table)),
    ]
    total, done = 2 * len(contenders) + repeats, 0

    def step(count: int = 1) -> None:
        nonlocal done
        done += count
        if progress is not None:
            progress(done, total)

    readies, build_seconds = [], []
    for contender in contenders:
        start = time.perf_counter()
        built = contender.build()
        build_seconds.append(time.perf_counter() - start)
        readies.append(contender.ready(built))
        step(2)
    costs = np.empty((len(readies), repeats))
    loops = [_loops(ready) for ready in readies]
    for repeat in range(repeats):
        for n, (ready, count) in enumerate(zip(readies, loops, strict=True)):
            costs[n, repeat] = _seconds(ready, count) / (count * ready.items)
        step()
    methods = map(_measured, contenders, readies, build_seconds, costs)
    return TradeOff(tuple(methods), machine, repeats, time.perf_counter() - begin)


def _loops(ready: Ready) -> int:
    ready.run()
    once = _seconds(ready, 1)
    return max(1, int(_SHORTEST / once))


def _seconds(ready: Ready, count: int) -> float:
    start = time.perf_counter()
    for _ in range(count):
        ready.run()
    return time.perf_counter() - start


def _measured(
    contender: Contender, ready: Ready, build: float, costs: FloatArray
) -> MeasuredMethod:
    error = np.maximum(ready.time_error, ready.place_error)
    low, middle, high = 1e9 * np.quantile(costs, [0.25, 0.5, 0.75])
    return MeasuredMethod(
        contender.question, contender.method, contender.setting, int(contender.outsider),
        error=float(error.max()), median_error=float(np.median(error)),
        time_error=float(ready.time_error.max()), place_error=float(ready.place_error.max()),
        ns=float(middle), ns_spread=float(high - low), bytes=ready.bytes, build_s=build,
    )  # fmt: skip

"""All methods measured on this machine: errors once, costs in rounds that share the noise."""

from __future__ import annotations

import time
import tracemalloc
from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import Any, ClassVar

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.accuracy.front import MeasuredMethod
from puck_tables.io.dataset import Dataset, variable
from puck_tables.kernels.patience import compiled_at_once
from puck_tables.motion.limits import limit_ratio
from puck_tables.result import Result
from puck_tables.stopping.launch_arrays import launches_in
from puck_tables.stopping.lookup import stops_kernel
from puck_tables.stopping.stop_table import StopTable
from puck_tables.table.resultant_table import ResultantTable
from puck_tables.tradeoff import resultant_methods, state_methods, stop_methods
from puck_tables.tradeoff.call_overhead import CallCost, measured_doors
from puck_tables.tradeoff.contender import Contender, Ready
from puck_tables.tradeoff.literature_models import PADE_MATCHED, fitted_pade, pade_limit_ratio
from puck_tables.tradeoff.machine import Machine, measured_machine
from puck_tables.tradeoff.truth import Points, known_starts, random_points

Progress = Callable[[int, int], None]

REPEATS, QUICK_REPEATS = 25, 5  # of a measurement, of which the least time counts
_POINTS, _QUICK_POINTS = 4000, 1000  # at which errors are looked for
_LARGEST_SWEEP, _QUICK_SWEEP = 8, 6  # powers of ten
_LARGEST_BATCH, _QUICK_BATCH = 7, 6  # of a door
_CHUNK = 10_000  # points a call
_POWERS, _THINNING = 6, 2  # the look-up that growth is measured with
_SHORTEST = 1e-3  # s; below it a round repeats the run


@dataclass(frozen=True, eq=False, repr=False)
class TradeOff(Result):
    """What was measured.

    ``methods``; growth of a sweep by look-up in chunks: ``stops`` (n,), ``stop_ns`` (n,) for each,
    ``peak_bytes`` (n,) of memory; the ``doors`` against the size of the batch; ``limit_ratios``:
    rω/v at the stop of a flat puck by name; the ``machine``; ``repeats``; ``seconds`` it all took.
    """

    methods: tuple[MeasuredMethod, ...]
    stops: FloatArray
    stop_ns: FloatArray
    peak_bytes: FloatArray
    doors: tuple[CallCost, ...]
    limit_ratios: dict[str, float]
    machine: Machine
    repeats: int
    seconds: float

    picture: ClassVar[str] = "tradeoff"

    def __repr__(self) -> str:
        return f"TradeOff({len(self.methods)} methods, {self.repeats} rounds)"

    def explain(self) -> str:
        """How it was got."""
        return f"medians of {self.repeats} rounds on one thread of this machine"

    def dataset(self) -> Dataset:
        """Methods with their errors and costs; the growth of a sweep; the machine as attributes."""
        names = [field.name for field in fields(MeasuredMethod)]
        columns = {
            name: variable(name, _values(self.methods, name), ("contender",)) for name in names
        }
        growth = {
            name: variable(name, getattr(self, name), ("stops",))
            for name in ("stop_ns", "peak_bytes")
        }
        doors = {
            f"door_{name}": variable(f"door_{name}", _values(self.doors, name), ("door",))
            for name in ("batch", "threads", "ns")
        }
        doors_told = [f"{door.name}: {door.outputs}" for door in self.doors]
        told = [f"{method.question}: {method.name}" for method in self.methods]
        axes = {
            "contender": variable("contender", told, ("contender",)),
            "stops": variable("stops", self.stops, ("stops",)),
            "door": variable("door", doors_told, ("door",)),
        }
        return Dataset(axes, columns | growth | doors, {
            "title": "Accuracy against cost of methods to friction resultants, stops and states",
            "repeats": self.repeats, "seconds": self.seconds,
            "peak_flops": self.machine.flops, "peak_bandwidth": self.machine.bandwidth,
            **{f"machine_{k}": v for k, v in self.machine.description.items()},
            **{f"limit_ratio_{k}": v for k, v in self.limit_ratios.items()},
        })  # fmt: skip


def _values(rows: tuple[MeasuredMethod, ...] | tuple[CallCost, ...], name: str) -> Any:
    values = [getattr(row, name) for row in rows]
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
    machine = measured_machine()
    repeats = QUICK_REPEATS if quick else REPEATS
    points = random_points(_QUICK_POINTS if quick else _POINTS)
    chosen = points.delta == 0.0
    flat = Points(points.phi[chosen], points.delta[chosen], points.resultants[:, chosen])
    table, stop_table = ResultantTable.shipped(), StopTable.shipped()
    contenders: list[Contender] = [
        *resultant_methods.contenders(resultant_methods.ResultantTask(points, flat)),
        *stop_methods.contenders(stop_methods.StopTask(known_starts(), flat, table, stop_table)),
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
    stops, stop_ns, peak_bytes = _growth(_QUICK_SWEEP if quick else _LARGEST_SWEEP)
    a, b = fitted_pade(flat.phi, flat.resultants)
    return TradeOff(
        tuple(
            _measured(contender, ready, seconds, cost, machine)
            for contender, ready, seconds, cost in zip(
                contenders, readies, build_seconds, costs, strict=True
            )
        ),
        stops, stop_ns, peak_bytes, measured_doors(_QUICK_BATCH if quick else _LARGEST_BATCH),
        {
            "truth": float(limit_ratio(0.0)),
            "Pade, slopes matched": pade_limit_ratio(*PADE_MATCHED),
            "Pade, fitted": pade_limit_ratio(a, b),
            "limit surface": float("inf"),
        },
        machine, repeats, time.perf_counter() - begin,
    )  # fmt: skip


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
    contender: Contender, ready: Ready, build: float, costs: FloatArray, machine: Machine
) -> MeasuredMethod:
    error = np.maximum(ready.time_error, ready.place_error)
    low, middle, high = 1e9 * np.quantile(costs, [0.25, 0.5, 0.75])
    limit_ns, limit = machine.limit(ready.work, ready.traffic)
    return MeasuredMethod(
        contender.question, contender.method, contender.setting, int(contender.outsider),
        error=float(error.max()), median_error=float(np.median(error)),
        time_error=float(ready.time_error.max()), place_error=float(ready.place_error.max()),
        ns=float(middle), ns_spread=float(high - low), bytes=ready.bytes, build_s=build,
        limit_ns=limit_ns, limit=limit,
    )  # fmt: skip


def _growth(largest: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Stops by look-up in chunks, from a thousand to 10^largest: ns for each and peak memory."""
    counts = np.array([10.0**power for power in range(3, largest + 1)])
    nanoseconds, peaks = np.empty(counts.size), np.empty(counts.size)
    fill, coefficients = stops_kernel(_POWERS), StopTable.shipped().cut(_POWERS, _THINNING)
    _fill(fill, np.ones((6, 1)), coefficients, np.empty((3, 1)))  # compiled before the clock starts
    for n, count in enumerate(counts):
        tracemalloc.start()
        rounds = [_sweep(fill, coefficients, int(count)) for _ in range(_growth_rounds(count))]
        nanoseconds[n] = 1e9 * float(np.median(rounds)) / count
        peaks[n] = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
    return counts, nanoseconds, peaks


def _growth_rounds(count: float) -> int:
    return int(np.clip(1e7 / count, 1, 50))


def _fill(
    fill: Callable[..., object], launches: FloatArray, coefficients: FloatArray, out: FloatArray
) -> None:
    """Stops of launches (6, n) into ``out`` (3, n)."""
    fill(*launches_in(launches).part(0, launches.shape[1]), coefficients, *out, 1)


def _sweep(fill: Callable[..., object], coefficients: FloatArray, count: int) -> float:
    """Seconds for so many stops, a chunk at a time, of which only the longest is kept."""
    start = time.perf_counter()
    size = min(_CHUNK, count)
    launches, out = np.ones((6, size)), np.empty((3, size))
    launches[2], longest = np.linspace(0.0, 4.0, size), 0.0
    for first in range(0, count, size):
        launches[3] = first / count
        _fill(fill, launches, coefficients, out)
        longest = max(longest, float(out[0].max()))
    return time.perf_counter() - start

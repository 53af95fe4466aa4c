"""Cost of the doors against the size of the batch: checks, broadcasting and results included."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables._core.executor import usable_cores
from puck_tables.puck import Puck
from puck_tables.stopping.aim_at_targets import aim
from puck_tables.stopping.states import states
from puck_tables.stopping.stops import stop

_ROUNDS, _AT_LEAST = 5, 0.02  # a batch is asked so often, and so many seconds
_LONG = 0.3  # s, of which one more call tells enough
_AIM_LARGEST = 5  # power of ten
_STEP = 2  # powers of two from one size to the next


@dataclass(frozen=True)
class CallCost:
    """What one call costs: ``ns`` for each of ``batch`` questions, on ``threads`` threads."""

    name: str
    outputs: str
    threads: int
    batch: int
    ns: float


@dataclass(frozen=True)
class _Questions:
    """As many random questions as the largest batch; one is asked with plain numbers."""

    velocity: FloatArray
    spin: FloatArray
    delta: FloatArray
    time: FloatArray
    place: FloatArray

    def stop(self, n: int, threads: int) -> Callable[[], object]:
        if n == 1:
            return lambda: stop((1.0, 0.5), 2.0, threads=threads)
        return lambda: stop(self.velocity[:n], self.spin[:n], delta=self.delta[:n], threads=threads)

    def all_outputs(self, n: int, threads: int) -> Callable[[], object]:
        ask = self.stop(n, threads)
        return lambda: ask().path_length  # type: ignore[attr-defined]

    def many_times(self, n: int, threads: int) -> Callable[[], object]:
        moments = 0.5 if n == 1 else self.time[:n]
        return lambda: states((1.0, 0.5), 2.0, moments, threads=threads)

    def many_pucks(self, n: int, threads: int) -> Callable[[], object]:
        if n == 1:
            return self.many_times(1, threads)
        return lambda: states(
            self.velocity[:n], self.spin[:n], self.time[:n], delta=self.delta[:n], threads=threads
        )

    def aim(self, n: int, threads: int) -> Callable[[], object]:
        puck = Puck.similar()
        place, spin = (self.place[:n], self.spin[:n]) if n > 1 else (self.place[0], self.spin[0])
        return lambda: aim(
            puck, place, spin=spin, speed=None, stop_time=None, max_speed=None, max_spin=None,
            count=8, threads=threads,
        )  # fmt: skip


def measured_doors(largest: int) -> tuple[CallCost, ...]:
    """Cost of every door for batches of 1, 100, … 10^largest questions, by one thread and by all.

    Examples
    --------
    >>> one = measured_doors(0)[0]
    >>> one.name, one.batch, one.ns > 1000.0
    ('stop', 1, True)
    """
    rng, size = np.random.default_rng(15), 10**largest
    ask = _Questions(
        rng.normal(size=(size, 2)), rng.normal(size=size), rng.random(size),
        rng.uniform(0.0, 3.0, size), rng.uniform(0.1, 2.0, (min(size, 10**_AIM_LARGEST), 2)),
    )  # fmt: skip
    doors = (
        ("stop", "time, place", ask.stop, largest),
        ("stop", "all six", ask.all_outputs, largest),
        ("states", "one puck, many times", ask.many_times, largest),
        ("states", "many pucks, one time each", ask.many_pucks, largest),
        ("aim", "launches of a spin", ask.aim, min(largest, _AIM_LARGEST)),
    )
    found = []
    for name, outputs, door, top in doors:
        for power in sorted({*range(0, top, _STEP), top}):
            for threads in sorted({1, usable_cores()}):
                seconds = _median(door(10**power, threads))
                found.append(CallCost(name, outputs, threads, 10**power, 1e9 * seconds / 10**power))
    return tuple(found)


def _median(call: Callable[[], object]) -> float:
    call()
    start = time.perf_counter()
    call()
    once = time.perf_counter() - start
    count, rounds = max(1, int(_AT_LEAST / _ROUNDS / max(once, 1e-9))), [once]
    for _ in range(_ROUNDS if once < _LONG else 1):
        start = time.perf_counter()
        for _ in range(count):
            call()
        rounds.append((time.perf_counter() - start) / count)
    return float(np.median(rounds))

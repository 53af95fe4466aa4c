"""What do the doors add to their kernels, and arrays save over one question after the other?

The first line of each group is the rival that the ratios are to.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from puck_tables import Puck, states, stop
from puck_tables.stopping.launches import CHUNK, launches_of
from puck_tables.stopping.lookup import STOP_POWERS, stops_kernel
from puck_tables.stopping.stop_table import StopTable

LAUNCHES, FEW, TARGETS = 1_000_000, 200, 100_000


def random_launches(rng: np.random.Generator, n: int) -> tuple[np.ndarray, ...]:
    return rng.normal(size=(n, 2)), rng.normal(size=n), rng.random(n)


@pytest.mark.benchmark(group="stops of a million launches")
@pytest.mark.parametrize(
    "way", ["kernel alone", "time and place", "all six", "tall pucks, all six"]
)
def test_stops(measure: Any, rng: np.random.Generator, way: str):
    velocity, spin, delta = random_launches(rng, LAUNCHES)
    tall = Puck.similar(delta=2.0)
    tall.stop(velocity, spin)
    time, x, y = (np.empty(LAUNCHES) for _ in range(3))
    launches = launches_of(velocity, spin, delta, 1.0, 1.0)
    cut = StopTable.shipped().cut()

    def kernel() -> None:
        for first in range(0, LAUNCHES, CHUNK):
            part = slice(first, min(first + CHUNK, LAUNCHES))
            some = launches.part(part.start, part.stop)
            stops_kernel(STOP_POWERS)(*some, cut, time[part], x[part], y[part], 1)

    ways = {
        "kernel alone": kernel,
        "time and place": lambda: stop(velocity, spin, delta=delta, threads=1),
        "all six": lambda: stop(velocity, spin, delta=delta, threads=1).path_length,
        "tall pucks, all six": lambda: tall.stop(velocity, spin, threads=1),
    }
    measure(way, ways[way], items=LAUNCHES, unit="stop")


@pytest.mark.benchmark(group="states of many pucks, one time each")
@pytest.mark.parametrize("way", ["one after the other", "at once"])
def test_states(measure: Any, rng: np.random.Generator, way: str):
    n = FEW if way == "one after the other" else LAUNCHES
    velocity, spin, delta = random_launches(rng, n)
    times = rng.uniform(0.0, 2.0, n)
    rows = list(zip(velocity.tolist(), spin.tolist(), times.tolist(), delta.tolist(), strict=True))

    def one_by_one() -> None:
        for v, w, t, d in rows:
            states(v, w, t, delta=d)

    ways = {
        "one after the other": one_by_one,
        "at once": lambda: states(velocity, spin, times, delta=delta, threads=1),
    }
    measure(way, ways[way], items=n, unit="state")


@pytest.mark.benchmark(group="launches to many targets")
@pytest.mark.parametrize("way", ["one after the other", "at once", "at once, a tall puck"])
def test_aims(measure: Any, rng: np.random.Generator, way: str):
    n = FEW if way == "one after the other" else TARGETS
    targets, spins = rng.uniform(-2.0, 2.0, (n, 2)), rng.normal(size=n)
    puck = Puck.similar(delta=2.0 if "tall" in way else 0.5)

    def one_by_one() -> None:
        for target, spin in zip(targets, spins.tolist(), strict=True):
            puck.aim(target, spin=spin)

    ask = one_by_one if n == FEW else lambda: puck.aim(targets, spin=spins, threads=1)
    found = puck.aim(targets[:FEW], spin=spins[:FEW])
    measure(way, ask, items=n, unit="target", error=found.miss.max())

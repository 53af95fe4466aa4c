"""What do the doors add to their kernels, and arrays save over one question after the other?

The first line of each group is the rival that the ratios are to.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from puck_tables import Puck, states, stop
from puck_tables.stopping.launch_arrays import CHUNK, launches_of
from puck_tables.stopping.lookup import STOP_POWERS, stops_kernel
from puck_tables.stopping.stop_table import StopTable

LAUNCHES, FEW, TARGETS = 1_000_000, 200, 100_000


def random_launches(rng: np.random.Generator, n: int) -> tuple[np.ndarray, ...]:
    return rng.normal(size=(n, 2)), rng.normal(size=n), rng.random(n)


@pytest.mark.benchmark(group="stops of a million launches")
@pytest.mark.parametrize(
    "way",
    [
        "kernel alone", "time and place", "the same, two threads", "all six", "tall pucks, all six",
        "rival: integrated, tol 1e-8",
    ],
)  # fmt: skip
def test_stops(measure: Any, rng: np.random.Generator, way: str):
    n = FEW if "rival" in way else LAUNCHES
    velocity, spin, delta = random_launches(rng, n)
    tall = Puck.similar(delta=2.0)
    tall.stop(velocity, spin)
    time, x, y = (np.empty(n) for _ in range(3))
    launches = launches_of(velocity, spin, delta, 1.0, 1.0)
    coefficients = StopTable.shipped().thinned()

    def kernel() -> None:
        for first in range(0, n, CHUNK):
            part = slice(first, min(first + CHUNK, n))
            some = launches.part(part.start, part.stop)
            stops_kernel(STOP_POWERS)(*some, coefficients, time[part], x[part], y[part], 1)

    ways = {
        "kernel alone": kernel,
        "time and place": lambda: stop(velocity, spin, delta=delta, threads=1),
        "the same, two threads": lambda: stop(velocity, spin, delta=delta, threads=2),
        "all six": lambda: stop(velocity, spin, delta=delta, threads=1).path_length,
        "tall pucks, all six": lambda: tall.stop(velocity, spin, threads=1),
        "rival: integrated, tol 1e-8": lambda: stop(
            velocity, spin, delta=delta, tol=1e-8, method="adaptive", threads=1
        ),
    }
    measure(way, ways[way], items=n, unit="stop")


@pytest.mark.benchmark(group="states of many pucks, one time each")
@pytest.mark.parametrize("way", [
    "one after the other", "at once", "of another law, integrated", "of another law, looked up",
])  # fmt: skip
def test_states(measure: Any, rng: np.random.Generator, way: str):
    n = FEW if way == "one after the other" or "integrated" in way else LAUNCHES
    velocity, spin, delta = random_launches(rng, n)
    other = Puck.similar(delta=0.6, pressure="hertz", gyration=0.6)
    times = rng.uniform(0.0, 2.0, n)
    rows = list(zip(velocity.tolist(), spin.tolist(), times.tolist(), delta.tolist(), strict=True))

    def one_by_one() -> None:
        for v, w, t, d in rows:
            states(v, w, t, delta=d)

    ways = {
        "one after the other": one_by_one,
        "at once": lambda: states(velocity, spin, times, delta=delta, threads=1),
    } | dict.fromkeys(
        ("of another law, integrated", "of another law, looked up"),
        lambda: other.states(velocity, spin, times, threads=1),
    )  # fmt: skip
    measure(way, ways[way], items=n, unit="state")


@pytest.mark.benchmark(group="states of one puck")
@pytest.mark.parametrize("way", ["at a million times", "rival: simulate, at 9999 times"])
def test_frames(measure: Any, way: str):
    puck = Puck.similar()
    times = np.linspace(0.0, 3.9, 9_999 if "rival" in way else LAUNCHES)
    ways = {
        "at a million times": lambda: puck.states((1.0, 0.0), 5.0, times),
        "rival: simulate, at 9999 times": lambda: puck.simulate((1.0, 0.0), 5.0, times=times),
    }
    measure(way, ways[way], items=times.size, unit="state")


@pytest.mark.benchmark(group="a map of a million stops")
@pytest.mark.parametrize("way", ["in memory", "to the file"])
def test_maps(measure: Any, tmp_path: Path, way: str):
    spin, speed = np.linspace(-5.0, 5.0, 1000), np.linspace(0.0, 2.0, 1000)

    def map_of_stops() -> None:
        found = Puck.similar().sweep(spin, speed)
        if way == "to the file":
            found.save(tmp_path / "map.h5", overwrite=True)

    measure(way, map_of_stops, unit="map")


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

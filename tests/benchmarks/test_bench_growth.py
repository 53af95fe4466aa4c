"""How does the cost of stops by look-up grow with their number, and with what is asked of them?"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from puck_tables import Table
from puck_tables.accuracy.front import shipped_front
from puck_tables.stopping.exact import exact_stops
from puck_tables.stopping.launches import launches_in
from puck_tables.stopping.lookup import stops_kernel

FloatArray = npt.NDArray[np.float64]

CUTS = [
    (int(way.number("powers")), int(way.number("thinning")))
    for way in shipped_front()
    if way.question == "stop" and way.method == "look-up"
]
LAUNCHES = 40_000


def launches(count: int, rng: np.random.Generator) -> FloatArray:
    one = np.ones(count)
    return np.stack([
        *rng.uniform(-1.0, 1.0, (2, count)), rng.uniform(-5.0, 5.0, count), rng.random(count),
        one, one,
    ])  # fmt: skip


@pytest.mark.benchmark(group="stops by look-up, one thread, by tolerance")
@pytest.mark.parametrize(("powers", "thinning"), CUTS)
def test_look_up(measure: Any, rng: np.random.Generator, powers: int, thinning: int) -> None:
    columns, out = launches(LAUNCHES, rng), np.empty((3, LAUNCHES))
    fill, coefficients = stops_kernel(powers), Table.shipped("stops").cut(powers, thinning)
    given = launches_in(columns).part(0, LAUNCHES)
    fill(*given, coefficients, *out, 1)
    some = columns[:, :500]
    speed = np.hypot(some[0], some[1])
    truth = exact_stops(np.log(np.abs(some[2]) / speed), some[3])
    error = np.abs(out[0, :500] / np.hypot(speed, some[2]) - truth[:, 0]).max()
    measure(
        f"{powers} powers, every {thinning}. node", lambda: fill(*given, coefficients, *out, 1),
        items=LAUNCHES, unit="point", error=float(error),
    )  # fmt: skip


@pytest.mark.benchmark(group="stops by look-up, one thread, by number")
@pytest.mark.parametrize("count", [10**3, 10**4, 10**5, 10**6, 10**7])
def test_growth(measure: Any, rng: np.random.Generator, count: int) -> None:
    chunk = min(count, 10_000)
    columns, out = launches(chunk, rng), np.empty((3, chunk))
    fill, coefficients = stops_kernel(6), Table.shipped("stops").cut(6, 2)

    given = launches_in(columns).part(0, chunk)

    def sweep() -> None:
        for _ in range(count // chunk):
            fill(*given, coefficients, *out, 1)

    measure(f"{count:.0e} stops", sweep, items=count, unit="point")

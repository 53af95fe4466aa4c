"""How does the cost of stops by look-up grow with their number, and with what is asked of them?"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from puck_tables import stop
from puck_tables.stopping.exact import exact_stops

LAUNCHES, JUDGED = 40_000, 500


def launches(count: int, rng: np.random.Generator) -> tuple[np.ndarray, ...]:
    return rng.uniform(-1.0, 1.0, (count, 2)), rng.uniform(-5.0, 5.0, count), rng.random(count)


@pytest.mark.benchmark(group="stops by look-up, one thread, by tolerance")
@pytest.mark.parametrize("tol", [1e-2, 1e-4, 1e-6, 1e-7, 1e-8, 1e-9, 2e-10])
def test_look_up(measure: Any, rng: np.random.Generator, tol: float) -> None:
    velocity, spin, delta = launches(LAUNCHES, rng)
    time = stop(velocity, spin, delta=delta, tol=tol).stop_time[:JUDGED]
    speed, rim = np.hypot(*velocity[:JUDGED].T), np.abs(spin[:JUDGED])
    truth = exact_stops(np.log(rim / speed), delta[:JUDGED])[:, 0]
    error = np.abs(time / np.hypot(speed, rim) - truth).max()
    measure(
        f"tol {tol:.0e}", lambda: stop(velocity, spin, delta=delta, tol=tol, threads=1),
        items=LAUNCHES, unit="point", error=float(error),
    )  # fmt: skip


@pytest.mark.benchmark(group="stops by look-up, one thread, by number")
@pytest.mark.parametrize("count", [10**3, 10**4, 10**5, 10**6, 10**7])
def test_growth(measure: Any, rng: np.random.Generator, count: int) -> None:
    velocity, spin, delta = launches(count, rng)
    measure(
        f"{count:.0e} stops", lambda: stop(velocity, spin, delta=delta, threads=1), items=count,
        unit="point",
    )  # fmt: skip

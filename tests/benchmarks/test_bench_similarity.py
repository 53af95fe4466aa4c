"""Stops and states by look-up, beside the integrator at the same accuracy in the same run."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import puck_tables
from puck_tables import Table
from puck_tables.contact.laws import HOMOGENEOUS
from puck_tables.motion.state import STATE_ROWS
from puck_tables.stopping.curve_lookup import fill_states
from puck_tables.stopping.launches import launches_in
from puck_tables.stopping.lookup import STOP_POWERS, stops_kernel
from puck_tables.stopping.per_height import SolverPerHeight
from puck_tables.stopping.solvers import LookUp

FloatArray = npt.NDArray[np.float64]

STOPS = pytest.mark.benchmark(group="stops: scattered launches, random delta")
STATES = pytest.mark.benchmark(group="states at any time")
MAPS = pytest.mark.benchmark(group="a map of a million stops, to the file")

MANY, FEW = 1 << 20, 1 << 12
ACCURACY = 1e-8


@pytest.fixture(scope="module")
def launches() -> FloatArray:
    """Launches (6, n): any direction, spin and height."""
    rng = np.random.default_rng(20120601)
    one = np.ones(MANY)
    return np.stack([*rng.normal(size=(2, MANY)), 2.0 * rng.normal(size=MANY), rng.random(MANY),
                     one, one])  # fmt: skip


@pytest.fixture(scope="module")
def truth(launches: FloatArray) -> FloatArray:
    """Stops of the first few, integrated with closed forms."""
    few = launches[:, :FEW]
    return np.array([
        [run.stop_time, *run.stop_position]
        for run in (
            puck_tables.simulate(v[:2], v[2], delta=v[3], exact=True, tol=1e-12, frames=1)
            for v in few[:, :400].T
        )
    ]).T  # fmt: skip


def largest_error(stops: FloatArray, launches: FloatArray, truth: FloatArray) -> float:
    """In units of Q/J and Q²/J."""
    count = truth.shape[1]
    q = np.hypot(np.hypot(*launches[:2, :count]), launches[2, :count])
    return float((np.abs(stops[:3, :count] - truth) / np.stack([q, q * q, q * q])).max())


@STOPS
def test_look_up(measure: Any, launches: FloatArray, truth: FloatArray) -> None:
    table, fill = Table.shipped("stops").cut(), stops_kernel(STOP_POWERS)
    out = np.empty((3, MANY))
    given = launches_in(launches).part(0, MANY)
    fill(*given, table, *out, 1)
    measure(
        "look-up, kernel: time, x, y",
        lambda: fill(*given, table, *out, 1),
        items=MANY,
        unit="point",
        error=largest_error(out, launches, truth),
    )


@STOPS
def test_look_up_two_threads(measure: Any, launches: FloatArray, truth: FloatArray) -> None:
    table, fill = Table.shipped("stops").cut(), stops_kernel(STOP_POWERS)
    halves = [launches_in(part).part(0, MANY // 2) for part in np.split(launches, 2, axis=1)]
    outs = [np.empty((3, MANY // 2)) for _ in halves]
    with ThreadPoolExecutor(2) as pool:

        def both() -> None:
            list(pool.map(lambda half, out: fill(*half, table, *out, 1), halves, outs))

        both()
        error = largest_error(outs[0], launches, truth)
        measure("the same, two threads", both, items=MANY, unit="point", error=error)


@STOPS
def test_look_up_all(measure: Any, launches: FloatArray, truth: FloatArray) -> None:
    solver = LookUp(Table.shipped("stops"))
    part = np.ascontiguousarray(launches[:, : 1 << 16])
    error = largest_error(solver.all(part)[0], launches, truth)
    measure(
        "look-up: also path, turn, body angle",
        lambda: solver.all(part),
        items=part.shape[1],
        unit="point",
        error=error,
    )


@STOPS
def test_public_stop(measure: Any, launches: FloatArray, truth: FloatArray) -> None:
    velocity = np.ascontiguousarray(launches[:2].T)

    def stops() -> puck_tables.Stops:
        return puck_tables.stop(velocity, launches[2], delta=launches[3])

    found = stops()
    measure(
        "puck_tables.stop",
        stops,
        items=MANY,
        unit="point",
        error=largest_error(np.stack([found.stop_time, *found.stop_position.T]), launches, truth),
    )


@STOPS
def test_integrated(measure: Any, launches: FloatArray, truth: FloatArray) -> None:
    solver = SolverPerHeight("uniform", HOMOGENEOUS, ACCURACY, None, Table.shipped())
    few = np.ascontiguousarray(launches[:, :FEW])
    solver.prepare(few[3])
    measure(
        "rival: integrated, RK4 and the table of resultants",
        lambda: solver.all(few),
        items=FEW,
        unit="point",
        error=largest_error(solver.all(few)[0], launches, truth),
    )


@STATES
@pytest.mark.parametrize("order", ["puck by puck", "in random order"])
def test_states(measure: Any, launches: FloatArray, order: str) -> None:
    table = Table.shipped("stops")
    few = np.ascontiguousarray(launches[:, :FEW])
    known = table.known(few)
    rng = np.random.default_rng(3)
    which = rng.integers(0, FEW, MANY)
    if order == "puck by puck":
        which.sort()
    times = known[0, which] * rng.random(MANY)
    pucks = np.concatenate([few, known]).T.copy()
    out = np.empty((STATE_ROWS, MANY))
    measure(
        f"look-up, kernel: a million states of 4096 pucks, {order}",
        lambda: fill_states(
            pucks, which, times, table.stop_coefficients, table.curve_coefficients,
            table.time_inverse, out,
        ),
        items=MANY,
        unit="state",
    )  # fmt: skip


@STATES
@pytest.mark.parametrize("frames", [1_000_000, 9_999])
def test_frames(measure: Any, frames: int) -> None:
    name = "flow, one puck" if frames > 10_000 else "rival: simulate, states by Newton on RK steps"
    times = np.linspace(0.0, 3.9, frames)
    measure(
        f"{name}, {frames} times",
        (lambda: puck_tables.stopping.states((1.0, 0.0), 5.0, times))
        if frames > 10_000
        else (lambda: puck_tables.simulate((1.0, 0.0), 5.0, times=times)),
        items=frames,
        unit="state",
    )


@MAPS
def test_map(measure: Any, tmp_path: Path) -> None:
    spin, speed = np.linspace(-5.0, 5.0, 1000), np.linspace(0.0, 2.0, 1000)

    def map_to_file() -> None:
        puck_tables.Puck.similar().sweep(spin, speed).save(tmp_path / "map.h5", overwrite=True)

    measure("sweep and save_map, 1000 x 1000", map_to_file, unit="map")

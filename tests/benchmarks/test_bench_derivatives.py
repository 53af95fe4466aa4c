"""Stops and states with their derivatives, beside the values alone and beside differences."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import puck_tables

FloatArray = npt.NDArray[np.float64]

STOPS = pytest.mark.benchmark(group="stops with derivatives: scattered launches, random delta")
STATES = pytest.mark.benchmark(group="states with derivatives: 256 moments of 256 pucks")

MANY, PUCKS = 1 << 16, 256


@pytest.fixture(scope="module")
def launches() -> FloatArray:
    """Launches (6, n): any direction, spin and height."""
    rng = np.random.default_rng(20120601)
    one = np.ones(MANY)
    return np.stack([*rng.normal(size=(2, MANY)), 2.0 * rng.normal(size=MANY), rng.random(MANY),
                     one, one])  # fmt: skip


def stops(launches: FloatArray, jacobian: bool = False) -> puck_tables.results.Stops:
    vx, vy, spin, delta, decel, radius = launches
    velocity = np.stack([vx, vy], axis=-1)
    return puck_tables.stop(
        velocity, spin, delta=delta, decel=decel, radius=radius, jacobian=jacobian
    )


@STOPS
def test_time_and_place(measure: Any, launches: FloatArray) -> None:
    measure("time and place", lambda: stops(launches), items=MANY, unit="point")


@STOPS
def test_all_five(measure: Any, launches: FloatArray) -> None:
    measure("also path and body angle", lambda: stops(launches).body_angle, items=MANY,
            unit="point")  # fmt: skip


@STOPS
def test_with_jacobian(measure: Any, launches: FloatArray) -> None:
    measure("time and place, and derivatives of all five by six", lambda: stops(launches, True),
            items=MANY, unit="point")  # fmt: skip


@STOPS
def test_differences(measure: Any, launches: FloatArray) -> None:
    """Central differences of all five, at the step that is best for them."""
    few = launches[:, : MANY // 16].copy()
    few[3] = 0.1 + 0.8 * few[3]

    def differences() -> FloatArray:
        columns = []
        for column in range(6):
            step = np.zeros((6, 1))
            step[column] = 1e-4
            ends = [stops(few + sign * step) for sign in (1.0, -1.0)]
            columns.append(ends[0].body_angle - ends[1].body_angle)
        return np.stack(columns)

    measure("rival: central differences", differences, items=few.shape[1], unit="point")


@STATES
@pytest.mark.parametrize("jacobian", [False, True])
def test_states(measure: Any, launches: FloatArray, jacobian: bool) -> None:
    some = launches[:, :PUCKS, None]
    times = np.linspace(0.0, 1.0, MANY // PUCKS)
    velocity = np.stack([some[0], some[1]], axis=-1)
    measure(
        "states and derivatives of six by seven" if jacobian else "states",
        lambda: puck_tables.states(velocity, some[2], times, delta=some[3], jacobian=jacobian),
        items=MANY,
        unit="state",
    )

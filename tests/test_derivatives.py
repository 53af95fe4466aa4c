"""Derivatives of stops and states, judged by complex steps through a motion of their own."""

from __future__ import annotations

import math

import numpy as np
import pytest
from derivative_truth import state_truth, stop_truth

from puck_tables import Puck, Table, states, stop
from puck_tables.errors import InputError
from puck_tables.motion import limit_angle

BOUND = 1e-7  # in units of Q, J and r of the launch, as promised


def adversarial(seed: int, count: int) -> np.ndarray:
    """Launches (6, n) with Q = J = r = 1: anywhere, and next to all that is singular."""
    rng = np.random.default_rng(seed)
    delta = rng.random(count)
    delta[::7], delta[3::7] = 0.0, 1.0
    # complex steps cannot straddle the ends
    delta = np.clip(delta, 1e-9, 1.0 - 1e-9)
    kind, off = np.arange(count) % 5, 10.0 ** rng.uniform(-6.0, -1.0, count)
    off *= np.where(rng.random(count) < 0.5, -1.0, 1.0)
    phi = rng.uniform(0.05, 1.5, count)
    middle = [None, 0.25 * math.pi, 0.0, 0.5 * math.pi, None]
    for n in range(count):
        at = float(limit_angle(delta[n])) if kind[n] == 4 else middle[kind[n]]
        if at is not None:
            phi[n] = at + off[n]
    phi = np.where(phi > 0.5 * math.pi, math.pi - phi, np.abs(phi))
    way = rng.uniform(0.0, 2.0 * math.pi, count)
    around = np.where(rng.random(count) < 0.5, -1.0, 1.0)
    one = np.ones(count)
    return np.stack([
        np.cos(phi) * np.cos(way), np.cos(phi) * np.sin(way), around * np.sin(phi), delta, one, one
    ])  # fmt: skip


def scaled(launches: np.ndarray) -> np.ndarray:
    """The same with other speeds, frictions and radii, each its own."""
    rng = np.random.default_rng(1)
    slip, decel, radius = np.exp(rng.uniform(-1.5, 1.5, (3, launches.shape[1])))
    vx, vy, rim, delta, _, _ = launches
    return np.stack([slip * vx, slip * vy, slip * rim / radius, delta, decel, radius])


def arguments(launches: np.ndarray) -> dict:
    return {"delta": launches[3], "decel": launches[4], "radius": launches[5]}


def stop_errors(launches: np.ndarray) -> np.ndarray:
    """Largest errors of the Jacobians of stops, one a launch."""
    found = stop(launches[:2].T, launches[2], **arguments(launches), jacobian=True)
    _, truth = stop_truth(launches)
    return np.abs(found.jacobian - truth.transpose(2, 0, 1)).max(axis=(1, 2))


def state_errors(launches: np.ndarray, share: np.ndarray) -> np.ndarray:
    """Largest errors of the Jacobians of states where Q has fallen to a share."""
    times, values, truth = state_truth(launches, share)
    found = states(launches[:2].T, launches[2], times, **arguments(launches), jacobian=True)
    got = np.stack([getattr(found, name) for name in found.JACOBIAN_ROWS])
    assert np.abs(got - values).max() <= 1e-9
    return np.abs(found.jacobian - truth.transpose(2, 0, 1)).max(axis=(1, 2))


@pytest.mark.thorough
def test_stops_next_to_all_that_is_singular():
    assert stop_errors(adversarial(1, 40)).max() <= BOUND


@pytest.mark.thorough
def test_states_next_to_all_that_is_singular():
    share = np.exp(-(np.random.default_rng(2).uniform(0.0, 1.0, 20) ** 2) * math.log(1e3))
    assert state_errors(adversarial(3, 20), share).max() <= BOUND


@pytest.mark.nightly
def test_two_thousand_launches():
    launches = adversarial(5, 2000)
    share = np.exp(-(np.random.default_rng(6).uniform(0.0, 1.0, 2000) ** 2) * math.log(1e3))
    assert stop_errors(launches).max() <= BOUND
    assert state_errors(launches, share).max() <= BOUND


def test_units_are_those_of_the_arguments():
    """Every entry scales as its row and column do, whatever Q, J and r are."""
    one = adversarial(7, 30)
    other = scaled(one)
    slip = np.hypot(np.hypot(*other[:2]), other[2] * other[5])
    decel, radius = other[4:]
    time, place, turn = slip / decel, slip**2 / decel, slip**2 / decel / radius
    by = [slip, slip, slip / radius, np.ones(30), decel, radius]
    pure = stop(one[:2].T, one[2], **arguments(one), jacobian=True).jacobian
    found = stop(other[:2].T, other[2], **arguments(other), jacobian=True).jacobian
    for row, unit in enumerate((time, place, place, place, turn)):
        for column, argument in enumerate(by):
            got = found[:, row, column] * argument / unit
            assert got == pytest.approx(pure[:, row, column], abs=1e-12)
    share = 0.7 * stop(one[:2].T, one[2], **arguments(one)).stop_time
    pure = states(one[:2].T, one[2], share, **arguments(one), jacobian=True).jacobian
    found = states(other[:2].T, other[2], share * time, **arguments(other), jacobian=True).jacobian
    for row, unit in enumerate((place, place, turn, slip, slip, slip / radius)):
        for column, argument in enumerate([*by, time]):
            got = found[:, row, column] * argument / unit
            assert got == pytest.approx(pure[:, row, column], abs=1e-9)


@pytest.mark.parametrize("launch", [(1.0, 0.0, 0.0), (0.0, 0.0, -2.0)])
def test_pure_motions_have_the_limit_of_their_neighbours(launch: tuple[float, float, float]):
    vx, _, spin = launch
    near = ((vx, 0.0), 1e-13) if spin == 0.0 else ((0.0, 1e-13), spin)
    exact = (vx, 0.0), spin
    for delta in (0.0, 0.5, 1.0):
        one, two = (stop(*each, delta=delta, jacobian=True).jacobian for each in (exact, near))
        if spin != 0.0:  # the path is as long as the speed is great: a cone
            assert np.isnan(one[3, :2]).all()
            one[3, :2] = two[3, :2]
        assert one == pytest.approx(two, abs=1e-7)  # |φ|^0.6
        time = [0.0, 0.3, 0.7]
        one, two = (
            states(*each, time, delta=delta, jacobian=True).jacobian for each in (exact, near)
        )
        assert one == pytest.approx(two, abs=1e-7)


@pytest.mark.parametrize("scale", [1e-300, 1e-160, 1e150])
def test_largest_and_smallest_speeds(scale: float):
    """With v, rω and J scaled alike times stay, and places scale."""
    one, other = (
        stop((0.6 * q, 0.3 * q), 0.7 * q, delta=0.4, decel=q, jacobian=True).jacobian
        * np.array([q, q, q, 1.0, q, 1.0]) / np.array([1.0, q, q, q, q])[:, None]
        for q in (1.0, scale)
    )  # fmt: skip
    assert one == pytest.approx(other, abs=1e-14)
    one, other = (
        states((0.6 * q, 0.3 * q), 0.7 * q, 0.3, delta=0.4, decel=q, jacobian=True).jacobian
        * np.array([q, q, q, 1.0, q, 1.0, 1.0]) / q
        for q in (1.0, scale)
    )  # fmt: skip
    assert one == pytest.approx(other, abs=1e-14)


@pytest.mark.parametrize("tiny", [1e-20, 1e-40, 1e-200, 1e-300])
def test_slip_ratios_as_small_as_numbers_get(tiny: float):
    """The first derivatives are those of the pure motion."""
    times = [0.0, 1e-300, 0.2, 0.7]
    for pure, near in (
        (((1.0, 0.0), 0.0), ((1.0, 0.0), tiny)),
        (((0.0, 0.0), 1.0), ((tiny, 0.0), 1.0)),
    ):
        for delta in (0.0, 1.0):
            one, two = (
                states(*each, times, delta=delta, jacobian=True).jacobian for each in (pure, near)
            )
            assert one == pytest.approx(two, abs=1e-9)


def test_pure_spin_in_elementary_functions():
    """Next to it rω falls linearly, and the velocity like its power (ρ_∥ + iρ_⊥)/(4/3)."""
    delta, spin, time = 0.7, 3.0, 1.1
    left = 1.0 - time / (0.75 * spin)
    power = 0.75 * (9.0 + 3.0j * delta) / (9.0 + delta**2)
    fall = left**power
    way = 0.75 * spin * (1.0 - left * fall) / (power + 1.0)
    found = states((0.0, 0.0), spin, time, delta=delta, jacobian=True)
    assert found.derivative("vx", "vx") == pytest.approx(fall.real, abs=1e-9)
    assert found.derivative("vy", "vx") == pytest.approx(fall.imag, abs=1e-9)
    assert found.derivative("x", "vy") == pytest.approx(-way.imag, abs=1e-9)
    assert found.derivative("y", "vy") == pytest.approx(way.real, abs=1e-9)
    assert found.derivative("spin", "spin") == pytest.approx(1.0, abs=1e-9)
    assert found.derivative("orientation", "decel") == pytest.approx(-4 / 6 * time**2, abs=1e-9)


def test_by_time_is_velocity_and_acceleration():
    times = np.linspace(0.0, 3.9, 14)
    found = states((0.8, 0.6), 5.0, times, delta=0.4, jacobian=True)
    for row, velocity in (("x", found.vx), ("y", found.vy), ("orientation", found.spin)):
        assert found.derivative(row, "time") == pytest.approx(velocity, abs=1e-9)
    power = found.vx * found.derivative("vx", "time") + found.vy * found.derivative("vy", "time")
    power += 0.5 * found.spin * found.derivative("spin", "time")
    assert np.all(power < 0.0)


def test_from_the_stop_on_it_is_that_of_the_stop():
    launch = (1.0, -0.4), 2.0
    ends = stop(*launch, jacobian=True)
    found = states(*launch, [1.00000001 * float(ends.stop_time), 50.0], jacobian=True)
    of_stop = ends.jacobian[[1, 2, 4]]
    for jacobian in found.jacobian:
        assert jacobian[:3, :6] == pytest.approx(of_stop, abs=1e-12)
        assert not jacobian[3:].any()
        assert not jacobian[:, 6].any()


def test_values_are_the_same_bits_with_and_without():
    launches = adversarial(11, 200)
    for launch in (launches, scaled(launches)):
        many = launch[:2].T, launch[2]
        one, two = (stop(*many, **arguments(launch), jacobian=flag) for flag in (False, True))
        assert np.array_equal(one.stop_time, two.stop_time)
        assert np.array_equal(one.stop_position, two.stop_position)
        one, two = (
            states(*many, 0.4, **arguments(launch), jacobian=flag) for flag in (False, True)
        )
        assert one == two


def test_pucks_side_by_side_change_no_bit():
    """Whatever blocks the moments of one puck fall into, and whichever puck is beside it."""
    rng = np.random.default_rng(13)
    velocity, spin, height = rng.normal(size=(7, 2)), rng.normal(size=7), rng.uniform(0, 1, 7)
    times = rng.uniform(0.0, 1.5, 61)
    rows = states(velocity[:, None], spin[:, None], times, delta=height[:, None], jacobian=True)
    columns = states(velocity, spin, times[:, None], delta=height, jacobian=True)
    for k in range(7):
        alone = states(velocity[k], spin[k], times, delta=height[k], jacobian=True)
        for found, part in ((rows, k), (columns, (slice(None), k))):
            assert np.array_equal(found.jacobian[part], alone.jacobian)
            for name in ("x", "y", "vx", "vy", "spin"):  # angles are added up in another order
                assert np.array_equal(getattr(found, name)[part], getattr(alone, name))


def test_many_moments_of_a_puck_change_no_bit():
    """Whether functions are looked up by itself, beside neighbours, or all at once before."""
    times = np.linspace(0.0, 2.5, 3000)
    whole = states((1.0, 0.2), 2.0, times, delta=0.7, jacobian=True).jacobian
    close = states((1.0, 0.2), 2.0, times[:900], delta=0.7, jacobian=True).jacobian
    apart = states((1.0, 0.2), 2.0, times[::17], delta=0.7, jacobian=True).jacobian
    alone = states((1.0, 0.2), 2.0, times[40], delta=0.7, jacobian=True).jacobian
    each = [np.broadcast_to(one, 900) for one in (1.0, 0.2, 2.0)]
    own = states(np.stack(each[:2], axis=-1), each[2], times[:900], delta=0.7, jacobian=True)
    assert np.array_equal(close, whole[:900])
    assert np.array_equal(apart, whole[::17])
    assert np.array_equal(alone, whole[40])
    assert np.array_equal(own.jacobian, close)


def test_threads_change_no_bit():
    rng = np.random.default_rng(12)
    velocity, spin, heights = rng.normal(size=(70_000, 2)), rng.normal(size=70_000), [0.3, 0.9]
    times = rng.uniform(0.0, 2.0, 35_000)
    one, two = (
        [
            stop(velocity, spin, threads=threads, jacobian=True).jacobian,
            states((1.0, 0.2), 2.0, times, delta=np.array(heights)[:, None], threads=threads,
                   jacobian=True).jacobian,
        ]
        for threads in (1, 2)
    )  # fmt: skip
    for first, second in zip(one, two, strict=True):
        assert np.array_equal(first, second)
    some = slice(1000, 70_000, 7919)  # whatever else is in a block
    alone = stop(velocity[some], spin[some], jacobian=True).jacobian
    assert np.array_equal(alone, one[0][some])
    assert np.array_equal(
        states((1.0, 0.2), 2.0, times[-5:], delta=0.9, jacobian=True).jacobian, one[1][1, -5:]
    )


def test_shapes_and_names():
    found = states(np.ones((3, 1, 2)), 2.0, np.linspace(0.0, 1.0, 4), jacobian=True)
    assert found.jacobian.shape == (3, 4, 6, 7)
    assert np.array_equal(found.derivative("vx", "decel"), found.jacobian[..., 3, 4])
    ends = Puck.similar().stop(np.ones((5, 2)), 1.0, jacobian=True)
    assert ends.jacobian.shape == (5, 5, 6)
    assert Puck.similar().stop((1.0, 0.0), 1.0, jacobian=True).jacobian.shape == (5, 6)
    assert ends.derivative("body_angle", "radius").shape == (5,)
    # the order of pucks and times does not matter
    velocity, times = np.random.default_rng(1).normal(size=(6, 2)), np.linspace(0.0, 1.0, 3)
    one = states(velocity[:, None], 1.0, times, jacobian=True).jacobian
    two = states(velocity, 1.0, times[:, None], jacobian=True).jacobian
    assert np.array_equal(one, two.swapaxes(0, 1))


@pytest.mark.thorough
def test_a_table_of_ones_own_has_derivatives():
    rough = Table.build("stops", cells=64)
    exact, own = (
        stop((1.0, 0.2), 2.0, tol=1e-5, table=table, jacobian=True).jacobian
        for table in (None, rough)
    )
    assert own == pytest.approx(exact, abs=1e-5)


def test_refusals():
    with pytest.raises(InputError, match=r"launch \[1, 0\] is at rest"):
        stop(np.array([[(1.0, 0.0)], [(0.0, 0.0)]]), 0.0, jacobian=True)
    with pytest.raises(InputError, match="call with jacobian=True"):
        stop((1.0, 0.0), 1.0).derivative("stop_x", "vx")
    with pytest.raises(InputError, match="by must be one of vx, vy, spin"):
        stop((1.0, 0.0), 1.0, jacobian=True).derivative("stop_x", "mass")
    assert not states((0.0, 0.0), 0.0, [0.0, 1.0], jacobian=True).jacobian.any()

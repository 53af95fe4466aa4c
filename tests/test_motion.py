"""Trajectories: against references that share no code, orders, events, regimes, symmetry."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pucks import simulate
from reference import REFERENCE_RUNS, states

from puck_tables import Table, resultants, stop
from puck_tables.errors import AccuracyError, ContactError, InputError
from puck_tables.motion import approach_exponent, curvature_slope, limit_angle, limit_ratio, regime


def deviation(run: object, truth: tuple[float, float, float]) -> float:
    return float(np.abs(np.subtract((run.stop_time, *run.stop_position), truth)).max())


@pytest.mark.parametrize("start", REFERENCE_RUNS)
def test_reference_runs(start: tuple[float, float]):
    delta, k = start
    truth = REFERENCE_RUNS[start]
    assert deviation(simulate((1, 0), k, delta=delta), truth) <= 1e-9 * (1 + k * k)  # asked: 1e-7
    exact = simulate((1, 0), k, delta=delta, exact=True, tol=1e-13)
    assert deviation(exact, truth) <= 2e-12  # asked: 1e-10; the references are given to 1e-12
    bulk = stop((1, 0), k, delta=delta)
    assert np.abs(bulk.stop_position - truth[1:]).max() <= 1e-7
    assert abs(bulk.stop_time - truth[0]) <= 1e-7


@pytest.mark.parametrize("k", [0.05, 0.2, 0.9])
@pytest.mark.parametrize("delta", [0.0, 1.0])
def test_rk4_keeps_order_4_across_the_singular_angle(k: float, delta: float):
    """From rω < v the path crosses φ = π/4 on its way to the limit angle."""
    truth = simulate((1, 0), k, delta=delta, exact=True, tol=1e-13)
    target = (truth.stop_time, *truth.stop_position)
    accuracies = 10.0 ** -np.arange(5.5, 10.5, 0.5)
    runs = [simulate((1, 0), k, delta=delta, exact=True, tol=a, method="rk4") for a in accuracies]
    errors = [deviation(run, target) for run in runs]
    steps = [run.selection.number("steps") for run in runs]
    assert len(set(steps)) >= 8
    order = -np.polyfit(np.log(steps), np.log(errors), 1)[0]
    assert order >= 3.8, (order, errors)


@pytest.mark.parametrize("method", ["adaptive", "rk4"])
@pytest.mark.parametrize("accuracy", [1e-4, 1e-6, 1e-8])
def test_accuracy_asked_is_reached_and_the_estimate_is_honest(method: str, accuracy: float):
    rng = np.random.default_rng(8)
    ratios = np.concatenate([10.0 ** rng.uniform(-6, 6, 30), 1.0 + rng.uniform(-1e-3, 1e-3, 10)])
    for k, delta in zip(ratios, rng.random(40), strict=True):
        run = simulate((1, 0), k, delta=delta, tol=accuracy, method=method)
        truth = simulate((1, 0), k, delta=delta, tol=1e-13, exact=True)
        q = math.hypot(1.0, k)
        error = max(
            abs(run.stop_time - truth.stop_time) / q,
            *(np.abs(np.subtract(run.stop_position, truth.stop_position)) / q**2),
        )
        assert error <= accuracy, (k, delta)
        assert error <= 3.0 * run.error_estimate, (k, delta)


@pytest.mark.parametrize("start", [((1.0, 0.0), 5.0), ((0.3, -0.4), -0.7), ((-1.0, 2.0), 1.0)])
@pytest.mark.parametrize("delta", [0.0, 0.5, 1.0])
def test_states_against_scipy_on_textbook_formulas(start, delta):
    v0, w0 = start
    stop_time = simulate(v0, w0, delta=delta).stop_time
    times = np.linspace(0.0, 0.95 * stop_time, 40)
    truth = states(v0, w0, delta, times)
    for options in ({"exact": True, "tol": 1e-12}, {"tol": 1e-10}):
        run = simulate(v0, w0, delta=delta, times=times, **options)
        mine = np.stack([
            run.speed * np.cos(run.heading), run.speed * np.sin(run.heading), run.spin,
            run.x, run.y, run.orientation,
        ])  # fmt: skip
        assert np.abs(mine - truth).max() <= 3e-9
        np.testing.assert_allclose(run.slip_speed, np.hypot(run.speed, run.spin), rtol=1e-12)
        np.testing.assert_allclose(np.tan(run.slip_angle), run.spin / run.speed, rtol=1e-10)


def test_frames_and_times_are_the_same_solution():
    by_frames = simulate((1, 0.5), 2.0, frames=50, exact=True, tol=1e-12)
    shuffled = np.random.default_rng(0).permutation(50)
    by_times = simulate((1, 0.5), 2.0, times=by_frames.time[shuffled], exact=True, tol=1e-12)
    np.testing.assert_array_equal(by_times.x, by_frames.x[shuffled])
    coarse = simulate((1, 0.5), 2.0, times=by_frames.time, method="rk4", tol=1e-7)
    assert np.abs(coarse.x - by_frames.x).max() < 5e-7
    assert np.abs(coarse.heading - by_frames.heading)[:-1].max() < 1e-4
    assert by_frames.time[0] == by_frames.x[0] == by_frames.orientation[0] == 0.0
    assert (by_frames.x[-1], by_frames.y[-1]) == pytest.approx(by_frames.stop_position, abs=1e-15)


def test_states_after_the_stop_are_at_rest():
    run = simulate((1, 0), 5.0, times=[0.0, 1e9, 3.0, 3.97])
    assert run.speed[1] == run.spin[1] == run.slip_speed[1] == 0.0
    assert (run.x[1], run.y[1]) == run.stop_position
    assert run.orientation[1] == run.body_angle
    assert run.slip_angle[1] == run.slip_angle[3] == 0.0
    assert run.speed[3] == 0.0 < run.speed[2]


def test_states_next_to_the_stop_follow_the_limit_motion():
    run = simulate((1, 0), 5.0, exact=True, tol=1e-12)
    left = 10.0 ** -np.arange(2.0, 9.0)
    near = simulate((1, 0), 5.0, times=run.stop_time - left, exact=True, tol=1e-12)
    rho = float(resultants(run.limit_angle, 0.5).parallel)  # there Q falls at the rate ρ∥ J
    slope = near.slip_speed[-3:] / left[-3:]
    np.testing.assert_allclose(slope, slope[-1], rtol=1e-3)
    assert slope[-1] == pytest.approx(rho, rel=1e-5)
    gap = np.abs(near.slip_angle - run.limit_angle)
    exponent = np.polyfit(np.log(near.slip_speed[3:]), np.log(gap[3:]), 1)[0]
    assert exponent == pytest.approx(0.6772, abs=2e-3)  # |φ − φ₀| ~ Q^κ, κ(0.5) = 0.6772


def test_every_regime_is_named_and_exact():
    rest = simulate((0, 0), 0.0)
    assert (rest.regime, rest.stop_time, rest.stop_position) == ("A", 0.0, (0.0, 0.0))
    spin = simulate((0, 0), -3.0, decel=2.0, radius=0.5)
    assert spin.regime == "B0"
    assert spin.stop_time == pytest.approx(0.75 * 0.5 * 3.0 / 2.0, rel=1e-15)
    assert spin.body_angle == pytest.approx(-3.0 * spin.stop_time / 2.0, rel=1e-15)
    assert spin.stop_position == (0.0, 0.0)
    assert spin.turn_angle == 0.0
    slide = simulate((3, 4), 0.0, decel=2.0, delta=0.9)
    assert (slide.regime, slide.stop_time, slide.turn_angle) == ("C0", 2.5, 0.0)
    assert slide.stop_position == pytest.approx((3.75, 5.0), rel=1e-15)
    for delta in (0.0, 0.5, 1.0):
        ratio = math.tan(float(limit_angle(delta)))
        limit = simulate((1, 0), ratio, delta=delta, frames=30)
        assert limit.regime == "D"
        np.testing.assert_allclose(limit.slip_angle[:-1], limit.limit_angle, rtol=1e-12)
        assert simulate((1, 0), 1.001 * ratio, delta=delta).regime == "B"
        assert simulate((1, 0), 0.999 * ratio, delta=delta).regime == "C"
        # the spiral in elementary functions against the integrator next to it
        beside = simulate((1, 0), ratio * (1 + 1e-10), delta=delta, exact=True, tol=1e-12)
        assert beside.regime == "B"
        assert deviation(limit, (beside.stop_time, *beside.stop_position)) <= 1e-9
        assert limit.turn_angle == pytest.approx(beside.turn_angle, abs=1e-8)
        assert limit.body_angle == pytest.approx(beside.body_angle, abs=1e-9)
        assert limit.path_length == pytest.approx(beside.path_length, abs=1e-9)
    for start, name in ((((1e-12, 0), 1.0), "B"), (((1, 0), 1e-12), "C"), (((0, 0), 0.0), "A")):
        assert simulate(*start).regime == regime(*start) == name
    assert regime((0, 1), math.tan(float(limit_angle(0.5))) / 0.3, radius=0.3) == "D"
    for bad in (((1, 0, 0), 1.0), ((1, 0), math.nan), ((1, 0), [1.0, 2.0])):
        with pytest.raises(InputError):
            regime(*bad)


def test_limits_as_functions_agree_with_the_motion():
    for delta in (0.3, 1.0):
        run = simulate((1, 0), 3.0, delta=delta, exact=True, tol=1e-13)
        left = run.stop_time - 10.0 ** -np.linspace(2, 5.5, 60)
        near = simulate((1, 0), 3.0, delta=delta, times=left, exact=True, tol=1e-13)
        gap = np.log(np.abs(near.slip_angle - run.limit_angle))
        kappa = np.diff(gap) / np.diff(np.log(near.slip_speed))
        assert kappa[-1] == pytest.approx(float(approach_exponent(delta)), abs=1e-3)
        # radius of curvature R = −(path per turn); its slope along the path at the stop is −Λ/δ
        path = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(near.x), np.diff(near.y)))])
        radius = np.abs(np.diff(path) / np.diff(near.heading))
        middle = 0.5 * (path[1:] + path[:-1])
        slope = np.diff(radius)[-5:] / np.diff(middle)[-5:]
        assert slope.mean() == pytest.approx(-float(curvature_slope(delta)) / delta, rel=0.02)
    assert float(limit_ratio(0.0)) == pytest.approx(1.53138937217390986, rel=1e-15)
    with pytest.raises(ContactError, match="0 <= delta <= 1"):
        curvature_slope(1.5)
    with pytest.raises(ContactError, match="0 <= delta <= 1"):
        approach_exponent(1.5)


def test_pure_motions_are_limits_of_generic_ones():
    for k in (1e-3, 1e-6, 1e-12, 1e-100, 1e-300):
        nearly = simulate((1, 0), k, exact=True, tol=1e-12)
        assert abs(nearly.stop_time - 1.0) <= 0.8 * k**1.5 + 1e-12
        spun = simulate((k, 0), 1.0, exact=True, tol=1e-12)
        assert abs(spun.stop_time - 0.75) <= k + 1e-12
        assert spun.path_length == pytest.approx(spun.stop_position[0], rel=0.1)


def test_energy_is_accounted_for_and_never_grows():
    for delta in (0.0, 0.5, 1.0):
        for k in (1e-3, 0.3, 1.0, 1.5, 8.0, 1e4):
            run = simulate((1, 0), k, delta=delta, exact=True, tol=1e-12, frames=200)
            assert run.energy_residual <= 1e-11
            energy = 0.5 * (run.speed**2 + 0.5 * run.spin**2)
            assert np.all(np.diff(energy) < 0.0)
            assert energy[0] == pytest.approx(run.kinetic_energy, rel=1e-12)
            rough = simulate((1, 0), k, delta=delta, tol=1e-4, method="rk4")
            assert run.energy_residual < rough.energy_residual <= 1e-2


def test_turn_is_read_at_a_thousandth_and_its_rate_continues_it():
    run = simulate((1, 0), 0.4, delta=0.8, exact=True, tol=1e-12, frames=200_001)
    at = int(np.argmin(np.abs(run.slip_speed - 1e-3 * run.slip_speed[0])))
    decades = math.log(run.slip_speed[0] * 1e-3 / run.slip_speed[at])
    assert run.turn_angle == pytest.approx(run.heading[at] - decades * run.turn_rate, abs=1e-3)
    assert run.turn_rate < 0.0
    assert simulate((1, 0), 0.4, delta=0.0).turn_angle == 0.0
    assert simulate((1, 0), 0.4, delta=0.0).stop_position[1] == 0.0


def numbers(largest: float) -> st.SearchStrategy[float]:
    """Zero, or magnitudes whose squares are far from underflow."""
    small = st.floats(-largest, largest, allow_nan=False)
    return small.filter(lambda x: x == 0.0 or abs(x) >= 1e-100)


@settings(max_examples=60, deadline=None, derandomize=True)
@given(
    vx=numbers(5.0), vy=numbers(5.0), w=numbers(50.0), delta=st.floats(0, 1),
    angle=st.floats(-3, 3), scale=st.floats(1e-3, 1e3), decel=st.floats(0.01, 100),
    radius=st.floats(0.01, 10),
)  # fmt: skip
def test_symmetries(vx, vy, w, delta, angle, scale, decel, radius):
    options = {"delta": delta, "decel": decel, "radius": radius, "tol": 1e-9}
    base = simulate((vx, vy), w, frames=20, **options)
    q = math.hypot(vx, vy, radius * w)
    time, length = q / decel, q * q / decel

    mirrored = simulate((vx, -vy), -w, frames=20, **options)
    tiny = 1e-300
    np.testing.assert_allclose(mirrored.x, base.x, rtol=0, atol=1e-13 * length + tiny)
    np.testing.assert_allclose(mirrored.y, -base.y, rtol=0, atol=1e-13 * length + tiny)
    assert mirrored.turn_angle == -base.turn_angle
    assert mirrored.body_angle == -base.body_angle

    c, s = math.cos(angle), math.sin(angle)
    turned = simulate((c * vx - s * vy, s * vx + c * vy), w, **options)
    assert turned.stop_time == pytest.approx(base.stop_time, abs=3e-9 * time + tiny)
    x, y = base.stop_position
    np.testing.assert_allclose(
        turned.stop_position, (c * x - s * y, s * x + c * y), rtol=0, atol=3e-9 * length + tiny
    )

    scaled = simulate((scale * vx, scale * vy), scale * w, **options)
    assert scaled.stop_time == pytest.approx(scale * base.stop_time, abs=3e-9 * scale * time)
    np.testing.assert_allclose(
        scaled.stop_position, np.multiply(scale**2, base.stop_position),
        rtol=0, atol=3e-9 * scale**2 * length + tiny,
    )  # fmt: skip

    energy = 0.5 * (base.speed**2 + 0.5 * (radius * base.spin) ** 2)
    assert np.all(np.diff(energy) <= 1e-15 * energy[0])
    assert np.all(base.spin * w >= 0.0)
    assert np.all(np.diff(np.abs(base.spin)) <= 1e-15 * abs(w))
    moving = base.time < base.stop_time
    if vx or vy:
        assert np.all(base.speed[moving] > 0.0)
    if w:
        assert np.all(base.spin[moving] != 0.0)
    assert base.speed[-1] == base.spin[-1] == 0.0


def test_speed_and_spin_keep_their_digits_at_both_ends():
    for tiny in (1e-9, 1e-12, 1e-17, 1e-100, 1e-300):
        assert simulate((tiny, 0), 1.0, frames=2).speed[0] == pytest.approx(tiny, rel=1e-12)
        assert simulate((1, 0), tiny, frames=2).spin[0] == pytest.approx(tiny, rel=1e-12)
    with pytest.raises(InputError, match="too large for floating point"):
        simulate((1e-7, 0), 1e154, radius=5e-324)
    tiny = simulate((1e-8, 0), 1e154, radius=5e-324, frames=2)  # only Q/r overflows
    assert tiny.spin[0] == pytest.approx(1e154, rel=1e-12)
    with pytest.raises(InputError, match="spin must be a number"):
        simulate((1, 0), 10**400)


def test_above_delta_1_the_law_holds_state_by_state():
    run = simulate((1, 0), 8.0, delta=1.2, exact=True)
    assert run.regime == "B"
    # above 1.5723 the limit motion itself is outside, whatever the start and the accuracy
    assert simulate((1, 0), 1e5, delta=1.572, exact=True).regime == "B"
    for w0, accuracy in ((54.6, 1e-2), (1e5, 1e-9), (1e8, 1e-12)):
        with pytest.raises(ContactError):
            simulate((1, 0), w0, delta=1.573, exact=True, tol=accuracy)
    with pytest.raises(ContactError, match="part of the base is lifted"):
        simulate((1, 0), 0.5, delta=1.2, exact=True)
    with pytest.raises(ContactError):
        simulate((1, 0), 1.5, delta=1.9, exact=True)
    with pytest.raises(ContactError):
        simulate((1, 0), 0.0, delta=1.01, exact=True)
    with pytest.raises(InputError, match="outside this table"):
        simulate((1, 0), 8.0, delta=1.2, table=Table.shipped())


@pytest.mark.parametrize(
    ("arguments", "error", "words"),
    [
        (((1,), 0.0), InputError, "two components"),
        (((1, 2, 3), 0.0), InputError, "two components"),
        ((([1, 0], [2, 0]), 0.0), InputError, "velocity must be one"),
        (((1, math.nan), 0.0), InputError, "finite"),
        (((1, 0), math.inf), InputError, "spin must be a finite number"),
        (((1, 0), "fast"), InputError, "spin must be a number"),
        (((1e200, 0), 0.0), InputError, "too large for floating point"),
    ],
)
def test_bad_launches(arguments: tuple, error: type, words: str):
    with pytest.raises(error, match=words):
        simulate(*arguments)


@pytest.mark.parametrize(
    ("options", "error", "words"),
    [
        ({"radius": 0.0}, InputError, "radius must be greater than 0"),
        ({"decel": -1.0}, InputError, "decel must be greater than 0"),
        ({"mass": 0.0}, InputError, "mass"),
        ({"delta": -0.1}, InputError, "delta"),
        ({"delta": math.nan}, InputError, "delta"),
        ({"frames": 0}, InputError, "frames must be a whole number from 1"),
        ({"frames": 10**12}, InputError, "frames must be a whole number from 1"),
        ({"frames": 3, "times": [1.0]}, InputError, "one of them"),
        ({"times": [-1.0]}, InputError, "times"),
        ({"times": []}, InputError, "times"),
        ({"times": [math.nan]}, InputError, "times"),
        ({"tol": 1e-16}, AccuracyError, "1e-13"),
        ({"tol": 1e-16, "exact": True}, AccuracyError, "1e-13"),
        ({"tol": 1e-11, "table": Table.shipped()}, AccuracyError, "of the table|1.1e-10"),
        ({"method": "euler"}, InputError, "method"),
        ({"tol": "fine"}, InputError, "tol must be a number"),
        ({"frames": 2.5}, InputError, "frames"),
    ],
)
def test_bad_options(options: dict, error: type, words: str):
    with pytest.raises(error, match=words):
        simulate((1, 0), 5.0, **options)

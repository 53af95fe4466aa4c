"""Stops and states by look-up, judged by the integrator, by scipy, by elementary solutions."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from pucks import simulate, sweep
from reference import REFERENCE_RUNS
from reference import states as reference_states
from scipy.integrate import quad

from puck_tables import Table, states, stop
from puck_tables.errors import AccuracyError, InputError
from puck_tables.motion import limit_ratio
from puck_tables.stopping import similarity
from puck_tables.stopping.exact import exact_stops
from puck_tables.stopping.lookup import SlipAxis, height_polynomials, heights, ratio_at
from puck_tables.stopping.similarity import limits, regular_parts, regular_slopes
from puck_tables.stopping.similarity_lookup import STOP_X, STOP_Y
from puck_tables.stopping.stop_check import launch_points, launches_at, looked_up, tabulate
from puck_tables.stopping.stop_table import StopTable


@pytest.fixture(scope="module")
def rough() -> StopTable:
    return Table.build("stops", cells=32)


# ---- stops


def test_reference_runs():
    for (delta, k), (time, x, y) in REFERENCE_RUNS.items():
        result = stop((1.0, 0.0), k, delta=delta, tol=2e-10)
        q = math.hypot(1.0, k)
        assert result.method == "look-up"
        assert float(result.stop_time) == pytest.approx(time, abs=2e-10 * q)
        assert result.stop_position == pytest.approx([x, y], abs=2e-10 * q * q)


def test_default_table_at_adversarial_points():
    """Down to 1e-16 from φ = 0, π/4, π/2 and from δ = 0, 1: far inside 3e-9."""
    table = Table.shipped("stops")
    u, delta = launch_points(table.axis, 600, seed=99)
    error = np.abs(looked_up(table, u, delta) - exact_stops(u, delta)).max(axis=0)
    assert np.all(error <= 1.1e-10)
    assert table.accuracy.worst <= table.tolerance == 1e-10
    assert table.accuracy.order == pytest.approx(4.0, abs=0.15)


@pytest.mark.thorough
def test_order_through_the_singular_angles():
    """Twice the cells, a sixteenth of the error, where T and X carry k^1.6, k² ln k, x³ ln x."""
    u = np.concatenate([np.linspace(-9, -2, 40), np.linspace(-0.1, 0.1, 41), np.linspace(1, 7, 40)])
    delta = np.linspace(0.0, 1.0, u.size)
    truth = exact_stops(u, delta)
    errors = [
        np.abs(looked_up(tabulate(StopTable, SlipAxis(n)), u, delta) - truth).max(axis=0)
        for n in (32, 64)
    ]
    assert np.all(np.log2(errors[0] / errors[1]) > 3.6)


def test_integrated_and_looked_up_agree_for_any_puck():
    rng = np.random.default_rng(5)
    v0, w0 = rng.normal(size=(300, 2)), rng.normal(size=300) * 40.0
    puck = {"delta": rng.random(300), "decel": 0.7, "radius": 0.05}
    one = stop(v0, w0, **puck, tol=2e-10)
    two = stop(v0, w0, **puck, tol=1e-9, table=Table.shipped())
    assert two.method == "integrated"
    q = np.hypot(np.hypot(*v0.T), 0.05 * w0)
    assert np.all(np.abs(one.stop_time - two.stop_time) <= 1.2e-9 * q / 0.7)
    scale = q**2 / 0.7
    position = np.abs(one.stop_position - two.stop_position).max(axis=-1)
    assert np.all(position <= 1.2e-9 * scale)
    assert np.all(np.abs(one.path_length - two.path_length) <= 2e-9 * scale)
    assert np.all(np.abs(one.body_angle - two.body_angle) <= 2e-9 * scale / 0.05)
    assert np.all(np.abs(one.turn_angle - two.turn_angle) <= 1e-6)


def test_symmetry_holds_to_rounding():
    """(v, ω) → (λ A v, λ det A ω): O(2) and scale."""
    v, w, delta = np.array([0.8, -0.3]), 1.7, 0.6
    base = stop(v, w, delta=delta)
    turned = stop(1e-9 * np.array([0.3, 0.8]), 1e-9 * w, delta=delta)
    assert float(turned.stop_time) == pytest.approx(1e-9 * float(base.stop_time), rel=1e-14)
    x, y = base.stop_position * 1e-18
    assert turned.stop_position == pytest.approx([-y, x], rel=1e-13)
    mirrored = stop(v * (1, -1), -w, delta=delta)
    assert mirrored.stop_position == pytest.approx(base.stop_position * (1, -1), rel=1e-14)
    assert float(mirrored.turn_angle) == -float(base.turn_angle)


@pytest.mark.parametrize("scale", [1e-307, 1e-160, 1e-120, 1e120])
def test_scale_free_to_the_ends_of_floating_point(scale: float):
    decel = 1e-140 if scale > 1.0 else 1.0
    base = stop((1.0, 0.4), 2.0, delta=0.3)
    far = stop((scale, 0.4 * scale), 2.0 * scale, delta=0.3, decel=decel * scale)
    assert float(far.stop_time) * decel == pytest.approx(float(base.stop_time), rel=1e-14)


def test_subnormal_launches():
    tiny = stop((1e-310, 0.0), 1e-310)
    run = simulate((1e-310, 0.0), 1e-310)
    assert float(tiny.stop_time) == pytest.approx(run.stop_time, rel=1e-9)
    assert tiny.status == 0


def test_a_table_of_the_wrong_kind_is_said():
    for call, words in (
        (lambda: stop((1, 0), 1.0, table="coarse.h5"), "resultants or stops, got a str"),
        (lambda: states((1, 0), 1.0, 1.0, table=Table.shipped()), "stops, got one of resultants"),
        (
            lambda: simulate((1, 0), 1.0, table=Table.shipped("stops")),
            "resultants, got one of stops",
        ),
    ):
        with pytest.raises(InputError, match=f"table must be a Table of {words}"):
            call()


def test_pure_motions_are_exact_by_either_way():
    for table in (None, Table.shipped()):
        result = stop([(1, 0), (0, 0), (0, 2), (0, 0)], [0, 1, 0, 0], delta=0.7, table=table)
        assert result.stop_time.tolist() == [1.0, 0.75, 2.0, 0.0]
        assert result.stop_position.tolist() == [[0.5, 0.0], [0.0, 0.0], [0.0, 2.0], [0.0, 0.0]]
        assert result.body_angle.tolist() == [0.0, 0.375, 0.0, 0.0]


def test_end_values_are_those_of_the_motion():
    """The elementary limits at φ → 0, π/2 against launches close to them."""
    delta = heights()
    k = 1e-4
    values = tabulate(StopTable, SlipAxis(8)).values[[0, -1], :, :5]
    for sign, at_end in zip((-1.0, 1.0), values, strict=True):
        u = np.full_like(delta, -sign * math.log(k))
        exact = exact_stops(u, delta)
        vx, _, w = launches_at(u, delta)[:3]
        scaled = exact / np.stack([1 + 0 * vx, vx, delta * vx * w, vx, w], axis=-1)
        np.testing.assert_allclose(scaled, at_end, rtol=0, atol=2e-5)


def test_regular_slopes_pass_the_limit_smoothly():
    tiny, wide = 1e-12, similarity._NEAR_LIMIT
    for delta in (0.1, 0.4, 0.8, 1.0):
        u0 = limits(delta).u
        near = u0 + np.array([-wide - tiny, -wide + tiny, -tiny, tiny, wide - tiny, wide + tiny])
        for slope in regular_slopes(near, delta):
            assert np.all(np.abs(np.diff(slope)[[0, 2, 4]]) < 4e-12)


def test_parts_are_the_integrals_of_their_slopes():
    cells, delta = 24, 0.6
    ends = np.log(ratio_at(np.array([0.5, 0.75, 1.0])))
    parts = regular_parts(SlipAxis(cells), delta)[[12, 18, 24]]
    for k in range(2):
        truth = [
            quad(lambda u, k=k: float(regular_slopes(np.array(u), delta)[k]), *pair, epsabs=1e-13)[
                0
            ]
            for pair in pairwise(ends)
        ]
        np.testing.assert_allclose(np.diff(parts[:, k]), truth, rtol=0, atol=3e-12)


def test_polynomials_of_the_height_are_as_exact_as_they_say():
    """The constants of the curve, and stops of launches between the heights of the table."""
    delta = np.random.default_rng(2).uniform(0.05, 1.0, 12)
    at = [limits(float(one)) for one in delta]
    truth = np.array([[math.tanh(0.5 * one.u), one.kappa, one.turn] for one in at])
    truth[:, 2] /= delta
    constants = Table.shipped("stops").constants[:3].T
    found = np.polynomial.polynomial.polyval(2.0 * delta**2 - 1.0, constants).T
    np.testing.assert_allclose(found, truth, rtol=0, atol=1e-12)
    nodes = heights()
    for u in (-1.0, 0.5):
        stops = exact_stops(np.full(nodes.size, u), nodes)
        stops[:, 2] /= nodes  # Y is odd in δ
        found = np.polynomial.polynomial.polyval(2.0 * delta**2 - 1.0, height_polynomials(stops)).T
        found[:, 2] *= delta
        np.testing.assert_allclose(found, exact_stops(np.full(12, u), delta), rtol=0, atol=1e-11)


# ---- states


def test_states_against_the_integrator():
    rng = np.random.default_rng(8)
    ends = [*(10.0 ** -np.arange(1, 13, 2)), 0.0]
    ratios = [*np.exp(rng.normal(size=25)), *ends, *(1.0 / np.array(ends[:-1]))]
    ratios += [
        1.0, 1.0 - 1e-12, 1.0 + 1e-7, float(limit_ratio(0.4)), float(limit_ratio(0.4)) + 1e-9,
    ]  # fmt: skip
    for k in ratios:
        v, w = 1.0 / math.hypot(1.0, k), k / math.hypot(1.0, k)
        delta = 0.4 if k > 1.4 else float(rng.choice([0.0, rng.random(), 1.0]))
        shares = np.concatenate([[0.0, 1e-9, 0.5, 1.0 - 1e-6, 1.0 - 1e-9], rng.random(6)])
        run = simulate((0.0, v), -w, delta=delta, exact=True, tol=1e-13,
                       times=shares * float(stop((0.0, v), w, delta=delta).stop_time))  # fmt: skip
        got = states((0.0, v), -w, run.time, delta=delta)
        for name in ("x", "y", "speed", "spin", "orientation", "slip_speed"):
            error = np.abs(getattr(got, name) - getattr(run, name)).max()
            assert error <= 1e-9, (name, k, delta)
        assert np.all(np.abs(got.heading - run.heading) * run.speed <= 1e-9)
        assert np.all(np.abs(got.slip_angle - run.slip_angle) * run.slip_speed <= 1e-9)


def test_states_against_scipy():
    times = np.linspace(0.0, 1.2, 7)
    vx, vy, rim, x, y, angle = reference_states((0.6, -0.8), 1.3, 0.5, times)
    got = states((0.6, -0.8), 1.3, times, delta=0.5)
    np.testing.assert_allclose(got.x, x, atol=1e-9)
    np.testing.assert_allclose(got.y, y, atol=1e-9)
    np.testing.assert_allclose(got.speed * np.cos(got.heading), vx, atol=1e-9)
    np.testing.assert_allclose(got.speed * np.sin(got.heading), vy, atol=1e-9)
    np.testing.assert_allclose(got.spin, rim, atol=1e-9)
    np.testing.assert_allclose(got.orientation, angle, atol=1e-9)


def test_a_state_launched_anew_goes_on():
    """Flow(t₁ + t₂) = states(t₂) of states(t₁)."""
    first = states((1.0, 0.5), 3.0, 0.7, delta=0.9)
    v1 = first.speed * np.array([np.cos(first.heading), np.sin(first.heading)])
    second = states(v1, first.spin, [0.4, 5.0], delta=0.9)
    whole = states((1.0, 0.5), 3.0, [1.1, 5.7], delta=0.9)
    np.testing.assert_allclose(first.x + second.x, whole.x, atol=3e-9)
    np.testing.assert_allclose(first.y + second.y, whole.y, atol=3e-9)
    np.testing.assert_allclose(second.spin, whole.spin, atol=3e-9)


def test_launch_and_rest_are_exact_in_any_order():
    at = states((3.0, 4.0), 2.0, [1e9, 0.0, 1e300], radius=0.5)
    end = stop((3.0, 4.0), 2.0, radius=0.5, tol=2e-10)
    assert at.speed.tolist() == [0.0, 5.0, 0.0]
    assert at.spin.tolist() == [0.0, 2.0, 0.0]
    assert (at.x[1], at.y[1], at.orientation[1]) == (0.0, 0.0, 0.0)
    launch = np.array([[3.0], [4.0], [2.0], [0.5], [1.0], [0.5]])
    known = Table.shipped("stops").known(launch)
    np.testing.assert_allclose([at.x[0], at.y[2]], known[[STOP_X, STOP_Y], 0], rtol=1e-15)
    assert np.abs(end.stop_position - known[[STOP_X, STOP_Y], 0]).max() <= 2e-10 * (25 + 1)
    resting = states((0.0, 0.0), 0.0, [0.0, 1.0])
    assert resting.x.tolist() == resting.speed.tolist() == [0.0, 0.0]


def test_states_broadcast_over_pucks_and_times():
    v0 = np.array([[1.0, 0.0], [0.0, 2.0], [0.5, 0.5]])
    times = np.linspace(0.0, 3.0, 5)
    grid = states(v0[:, None, :], np.array([1.0, -2.0, 0.0])[:, None], times, delta=0.2)
    assert grid.x.shape == (3, 5)
    alone = states(v0[1], -2.0, times[3], delta=0.2)
    assert float(alone.y) == grid.y[1, 3]
    assert float(alone.heading) == grid.heading[1, 3]


@pytest.mark.parametrize(
    ("arguments", "options", "words"),
    [
        (((1, 0), 1.0, -1.0), {}, "time must not be negative"),
        (((1, 0), 1.0, math.nan), {}, "time must be finite"),
        (((1, 0), 1.0, 1.0), {"delta": 4.2}, "tips"),
        (((1, 0), [1.0, 2.0], [1.0, 2.0, 3.0]), {}, "broadcast"),
        (((1e200, 0), 1.0, 1.0), {}, "too large"),
    ],
)
def test_bad_states(arguments: tuple, options: dict, words: str):
    with pytest.raises(InputError, match=words):
        states(*arguments, **options)


def test_many_frames_are_looked_up():
    run = simulate((1.0, 0.3), -5.0, frames=10_001)
    assert "look-up" in run.method
    few = simulate((1.0, 0.3), -5.0, times=run.time[::1000])
    assert "look-up" not in few.method
    for name in ("x", "y", "orientation", "spin", "slip_speed"):
        error = np.abs(getattr(run, name)[::1000] - getattr(few, name)).max()
        assert error <= 2e-9 * 26.0, name
    assert run.slip_angle[-1] == few.slip_angle[-1] == 0.0


@pytest.mark.parametrize(
    ("v0", "w0"), [((1.0, 0.3), -5.0), ((1.0, 0.0), 0.0), ((0.0, 0.0), 2.0), ((0.0, 0.0), 0.0)]
)
def test_the_slip_angle_is_that_of_the_velocities_everywhere(v0: tuple[float, float], w0: float):
    times = [0.0, 0.3, 50.0]
    run, seen = simulate(v0, w0, times=times), states(v0, w0, times)
    assert run.slip_angle[-1] == seen.slip_angle[-1] == 0.0
    for found in (run, seen):
        expected = np.arctan2(found.spin, found.speed)
        np.testing.assert_allclose(found.slip_angle, expected, rtol=1e-13)
    again = simulate(v0, w0, frames=1)(times)
    for name in ("time", "x", "y", "heading", "orientation", "spin", "slip_angle"):
        assert np.array_equal(getattr(again, name), getattr(run, name)), name


# ---- the table


@pytest.mark.thorough
def test_validation_passes_and_can_fail(rough: StopTable):
    assert rough.validate().passed
    bent = rough.values.copy()
    bent[20, 4, 0] += 1e-4
    report = replace(rough, values=bent).validate()
    failed = {(check.name, check.function) for check in report.checks if not check.passed}
    assert {("integrator", "time"), ("equation", "time")} <= failed


@pytest.mark.nightly
def test_validation_of_a_bent_curve_fails_there_alone(rough: StopTable):
    bent = rough.values.copy()
    bent[40, 4, 5] += 1e-3
    report = replace(rough, values=bent).validate()
    failed = {c.function for c in report.checks if not c.passed}
    assert "curve" in failed
    assert failed <= {"curve", "turn"}


def test_accuracies_out_of_range():
    with pytest.raises(AccuracyError, match="--kind stops"):
        stop((1, 0), 1.0, tol=1e-11, table=Table.shipped("stops"))
    with pytest.raises(AccuracyError, match="closed forms reaches 1e-13"):
        sweep(tol=1e-11, method="look-up")


@pytest.mark.thorough
def test_a_rough_stop_table_says_what_it_can(rough: StopTable):
    with pytest.raises(AccuracyError, match="that of the stop table"):
        stop((1, 0), 1.0, table=rough)
    found = stop((1, 0), 5.0, delta=1.0, table=rough, tol=1e-5)
    assert float(found.stop_time) == pytest.approx(4.000188799127, abs=5.2 * rough.tolerance)
    assert sweep([0.0, 1.0], table=rough, tol=1e-4).method == "look-up"

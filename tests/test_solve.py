"""The loop that refines, the frame of a launch, methods and their steppers."""

from __future__ import annotations

import math

import numpy as np
import pytest
from pucks import simulate

from puck_tables import Puck, Table, stop
from puck_tables.accuracy import methods
from puck_tables.accuracy.method_errors import select, shipped_errors
from puck_tables.accuracy.methods import INTEGRATORS, METHODS, FrictionForm, Method, Scheme
from puck_tables.contact.laws import HOMOGENEOUS
from puck_tables.errors import AccuracyError, InputError
from puck_tables.motion.body import body_of, plain_up_to
from puck_tables.motion.friction_source import (
    FullContact,
    Sections,
    closed_form_friction,
    source_of,
)
from puck_tables.motion.solve import ErrorEstimate, Setting, close_enough, refined
from puck_tables.motion.steppers import DORMAND_PRINCE, RK4, TABLEAUS, Stepping, tableau_of
from puck_tables.motion.unit_motion import frame_of, integrated


def test_the_loop_ends_at_the_first_setting_that_is_good_enough():
    tried: list[int] = []

    def attempt(n: int) -> tuple[str, ErrorEstimate]:
        tried.append(n)
        return f"result {n}", ErrorEstimate(0.6 * 10.0**-n, 0.3 * 10.0**-n, 0.05 * 10.0**-n)

    result, error, setting = close_enough(1, attempt, lambda n, _: n + 1, 1e-3, "it")
    assert (result, setting, tried) == ("result 3", 3, [1, 2, 3])
    assert error.total == pytest.approx(0.95e-3)


def test_what_no_setting_reaches_is_refused_with_what_can_be_asked():
    def attempt(n: int) -> tuple[None, ErrorEstimate]:
        return None, ErrorEstimate(1e-6, 2e-6)

    with pytest.raises(AccuracyError, match=r"tol = 1e-09 is out of reach for it.*6e-06 or more"):
        close_enough(1, attempt, lambda n, _: n + 1 if n < 4 else None, 1e-9, "it")


def test_what_errs_most_is_refined():
    setting = Setting(Stepping(DORMAND_PRINCE, 0.0, 1e-6), 1e-7)
    by_friction = refined(setting, ErrorEstimate(1e-9, 1e-8), 1e-9, lambda a: 0.1 * a)
    assert by_friction.accuracy == pytest.approx(1e-8)
    assert by_friction.stepping is setting.stepping
    assert refined(setting, ErrorEstimate(1e-9, 1e-8), 1e-9, lambda a: None) is None
    by_steps = refined(setting, ErrorEstimate(1e-8, 1e-9), 1e-9, lambda a: 0.1 * a)
    assert by_steps.accuracy == setting.accuracy
    assert by_steps.stepping.local == pytest.approx(1e-7)
    fixed = Setting(Stepping(RK4, 10.0, 1.0), 1e-7)
    finer = refined(fixed, ErrorEstimate(1e-7, 0.0), 1e-7 / 4.0, lambda a: None)
    assert finer.stepping.steps == 17.0  # order 4: an eighth of the error is wanted
    for stepping in (Stepping(RK4, 4096.0, 1.0), Stepping(DORMAND_PRINCE, 0.0, 1e-15)):
        assert (
            refined(Setting(stepping, 0.0), ErrorEstimate(1e-7, 0.0), 1e-9, lambda a: None) is None
        )


def test_a_motion_that_the_table_is_too_coarse_for_goes_by_closed_forms():
    source = FullContact(0.5)
    assert source.next_accuracy(2e-11) == 0.0
    assert source.next_accuracy(0.0) is None
    assert FullContact(0.5, Table.shipped()).next_accuracy(2e-11) is None
    for tol in 10.0 ** -np.arange(9.0, 12.0, 0.25):
        run = simulate((1.0, 0.0), 5.0, tol=tol, frames=1)
        assert run.error_estimate <= tol
        assert run.selection.tol == tol


def test_where_friction_comes_from_is_asked_once():
    assert plain_up_to("uniform", HOMOGENEOUS) == 1.0
    for pressure, gyration in (("ring", HOMOGENEOUS), ("uniform", 0.9)):
        assert plain_up_to(pressure, gyration) == -math.inf
        assert isinstance(source_of(body_of(pressure, 0.5, gyration)), Sections)
    assert isinstance(source_of(body_of("uniform", 1.0, HOMOGENEOUS)), FullContact)
    assert isinstance(source_of(body_of("uniform", 1.0 + 1e-15, HOMOGENEOUS)), Sections)
    for tall in (2.0, 3.0):
        with pytest.raises(InputError, match="from 0 to below 2 with closed forms"):
            source_of(body_of("uniform", tall, HOMOGENEOUS), exact=True)
    with pytest.raises(InputError, match="outside this table"):
        simulate((1.0, 0.0), 1.0, delta=3.0, table=Table.shipped())


def test_the_frame_turns_mirrors_and_scales():
    run = Puck.similar(delta=0.7).simulate((1.0, 0.0), 2.0, frames=5)
    for velocity, spin, decel, radius in (
        ((0.0, 3.0), 3.0, 2.0, 2.0),
        ((-2.0, 0.0), -8.0, 0.5, 0.5),
    ):
        frame = frame_of(velocity, spin, decel, radius)
        v = math.hypot(*velocity)
        assert (frame.speed, frame.rim) == (v, radius * abs(spin))
        east, north = np.divide(velocity, v)
        scaled = Puck.similar(delta=0.7, decel=decel, radius=radius).simulate(
            velocity, math.copysign(2.0 * v / radius, spin), frames=5
        )
        length, side = v * v / decel, math.copysign(1.0, spin)
        np.testing.assert_allclose(scaled.time, run.time * v / decel, rtol=1e-13)
        along, left = length * run.x, side * length * run.y
        np.testing.assert_allclose(scaled.x, along * east - left * north, atol=1e-13 * length)
        np.testing.assert_allclose(scaled.y, along * north + left * east, atol=1e-13 * length)
    still = frame_of((0.0, 0.0), 0.0, 1.0, 1.0)
    assert still.unit_times(np.array([0.0, 1.0]), 0.0).tolist() == [math.inf, math.inf]


def test_methods_are_named_once():
    assert [method.value for method in METHODS] == ["look-up", "rk4", "adaptive"]
    assert set(TABLEAUS) == set(INTEGRATORS)
    measured = {row.scheme for row in shipped_errors()} - {None}
    assert measured == set(methods.MEASURED.values())
    for name in ("euler", "", "RK4", "LOOK_UP", 4, ("rk4",)):
        with pytest.raises(InputError, match="method must be one of look-up, rk4, adaptive"):
            stop((1.0, 0.0), 1.0, method=name)
        with pytest.raises(InputError, match="method must be one of rk4, adaptive"):
            simulate((1.0, 0.0), 1.0, method=name)
    taken = select("stop", 1e-4, (Scheme(Method.RK4, FrictionForm.TABLE),))
    assert taken.scheme.name == "rk4, table"


def test_any_tableau_is_taken_by_the_same_loop():
    """Kutta's method of order 3 with fixed steps; the pair 3(2) of Bogacki and Shampine."""
    friction = closed_form_friction(0.8)
    truth = integrated(0.9, friction, Stepping(DORMAND_PRINCE, 0.0, 1e-14)).stop
    third = tableau_of([[], [1 / 2], [-1.0, 2.0]], [1 / 6, 2 / 3, 1 / 6], [], 3)
    counts = np.array([80.0, 160.0, 320.0])
    errors = [
        np.abs(integrated(0.9, friction, Stepping(third, n, 1.0)).stop - truth)[2:5].max()
        for n in counts
    ]
    order = -np.polyfit(np.log(counts), np.log(errors), 1)[0]
    assert 2.6 <= order <= 3.4
    pair = tableau_of(
        [[], [1 / 2], [0.0, 3 / 4], [2 / 9, 1 / 3, 4 / 9]], [2 / 9, 1 / 3, 4 / 9, 0.0],
        [[-5 / 72, 1 / 12, 1 / 9, -1 / 8]], 3,
    )  # fmt: skip
    assert pair.reused
    assert not third.reused
    for local in (1e-6, 1e-8):
        run = integrated(0.9, friction, Stepping(pair, 0.0, local))
        assert np.abs(run.stop - truth)[2:5].max() <= 100.0 * local

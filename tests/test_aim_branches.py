"""Every branch of the launches that reach a target is found, also where speed and time turn."""

from __future__ import annotations

import math

import numpy as np
import pytest
from any_puck import stops_by_truth
from pucks import aim, simulate
from rarely import few

from puck_tables import stop
from puck_tables.contact.laws import HOMOGENEOUS
from puck_tables.errors import InputError
from puck_tables.motion.body import body_of
from puck_tables.stopping.aim_lookup import RIM, SPEED, TIME
from puck_tables.stopping.launch_family import launch_curve

U = np.linspace(-6.0, 4.0, 401)


def scanned(delta: float, gyration: float) -> np.ndarray:
    """Ln v, ln r|ω| and ln t₀ at U of launches that stop at 1 m, J = 1: by ``stop``, (3, n)."""
    q = 1.0 / np.hypot(1.0, np.exp(U))
    v0 = np.stack([q, 0.0 * q], axis=-1)
    found = stop(v0, q * np.exp(U), delta=delta, gyration=gyration, tol=1e-9, method="adaptive")
    log_q = -0.5 * np.log(np.hypot(*found.stop_position.T))
    speed = log_q + np.log(q)
    return np.stack([speed, speed + U, log_q + np.log(found.stop_time)])


@pytest.mark.thorough
@pytest.mark.parametrize(
    "puck", few(2, [((3.9, HOMOGENEOUS),), ((0.5, 5.0),), ((3.6, 10.0),), ((2.0, 0.3),)])
)
def test_all_wishes_against_a_scan(puck: tuple[float, float]):
    delta, gyration = puck
    curve = scanned(delta, gyration)
    rng = np.random.default_rng(5)
    for name, row in (("speed", SPEED), ("spin", RIM), ("stop_time", TIME)):
        for value in [*rng.choice(curve[row], 12), *rng.uniform(*np.sort(curve[row])[[0, -1]], 6)]:
            wanted = value + 1e-5  # not on a point of the scan
            at = np.flatnonzero((curve[row][:-1] < wanted) != (curve[row][1:] < wanted))
            found = aim((1.0, 0.0), **{name: math.exp(wanted)}, delta=delta, gyration=gyration)
            u = np.log(np.abs(found.launch_spin)) - np.log(found.launch_speed)
            for n in at:
                inside = (u >= U[n] - 1e-6) & (u <= U[n + 1] + 1e-6)
                assert inside.sum() == (1 if name == "spin" else 2), (puck, name, wanted)
            within = np.isfinite(u) & (u > U[0]) & (u < U[-1])
            extra = within.sum() - at.size * (1 if name == "spin" else 2)
            # two more may lie between two points of the scan, on both sides of a turn
            assert extra == 0 or np.abs(np.diff(np.sort(u[within])))[::1].min() < U[1] - U[0]
            assert found.miss.max(initial=0.0) <= 1e-9


@pytest.mark.thorough
def test_the_fastest_launch_of_a_tall_puck_spins():
    options = {"delta": 3.9, "gyration": 0.1}
    run = simulate((0.99736, 0.0), 0.072611, **options)
    found = aim(run.stop_position, speed=0.99736, **options)
    assert (
        np.abs(found.launch_spin - 0.072611).min() <= 1e-4
    )  # next to the turn the spin hardly matters
    distance = math.hypot(*run.stop_position)
    assert math.sqrt(2.0 * distance) < 0.99736
    none = aim(run.stop_position, speed=1.1, **options)
    assert none.launch_spin.size == 0
    assert "rad/s either way" in none.answer
    fastest = float(none.answer.split("the fastest has ")[1].split(" m/s")[0])
    again = aim(run.stop_position, speed=fastest, **options)  # as it was printed
    assert again.launch_spin.size >= 2
    assert again.miss.max() <= 1e-9
    between = aim(run.stop_position, max_speed=0.99726, count=6, **options)
    assert between.launch_speed.max() <= 0.99726 * (1.0 + 1e-11)
    gap = aim(run.stop_position, max_speed=math.sqrt(2.0 * distance), count=40, **options)
    ratio = np.unique(np.round(np.abs(gap.launch_spin) / gap.launch_speed, 9))
    assert gap.launch_speed.max() <= math.sqrt(2.0 * distance) * (1.0 + 1e-11)
    assert ratio.size >= 40  # each sense of spin has them all, or the slide alone once


def test_between_two_folds_both_ranges_are_sampled():
    """δ = 3.9: the speed falls, grows and falls: a bound may leave two ranges of slip angles."""
    section = launch_curve(body_of("uniform", 3.9, HOMOGENEOUS))
    turns = [n for n in range(1, section.u.size - 1)
             if -1.0 < section.u[n] < 0.5
             and (section.values[n, SPEED] - section.values[n - 1, SPEED])
             * (section.values[n, SPEED] - section.values[n + 1, SPEED]) > 1e-20]  # fmt: skip
    low, high = section.values[turns, SPEED].min(), section.values[turns, SPEED].max()
    assert high - low > 1e-3
    bound = math.exp(0.5 * (low + high))
    found = aim((1.0, 0.0), max_speed=bound, delta=3.9, count=7)
    u = np.log(np.abs(found.launch_spin)) - np.log(found.launch_speed)
    lowest = section.u[turns[int(section.values[turns, SPEED].argmin())]]
    highest = section.u[turns[int(section.values[turns, SPEED].argmax())]]
    assert lowest < highest
    assert (u < highest).any()
    assert (u > highest).any()
    assert found.launch_speed.max() <= bound * (1.0 + 1e-11)
    assert found.launch_spin.size == 14


@pytest.mark.parametrize("delta", few(1, [0.7, 0.0, 0.3, 1.0]))
def test_quantities_of_a_plain_puck_never_turn(delta: float):
    u = np.linspace(-9.0, 9.0, 1801)
    q = 1.0 / np.hypot(1.0, np.exp(u))
    found = stop(np.stack([q, 0.0 * q], axis=-1), q * np.exp(u), delta=delta, tol=1e-12)
    log_q = -0.5 * np.log(np.hypot(*found.stop_position.T))
    speed = log_q + np.log(q)
    assert np.all(np.diff(speed) < 0.0)
    assert np.all(np.diff(speed + u) > 0.0)
    assert np.all(np.diff(log_q + np.log(found.stop_time)) > 0.0)


@pytest.mark.thorough
@pytest.mark.parametrize("gyration", few(1, [10.0, 0.3, 3.0]))
def test_fast_spins_hit_too(gyration: float):
    """Places next to pure spin are as small as cos φ and keep their digits."""
    for w0 in (1e2, 1e4):
        found = aim((2.0, 0.1), spin=w0, gyration=gyration)
        u = math.log(w0) - math.log(found.launch_speed[0])
        _, x, y, *_ = stops_by_truth("uniform", 0.5, gyration, np.array([u]))[:, 0]
        place = (
            (x + 1j * y)
            * (found.launch_speed[0] ** 2 + w0**2)
            * np.exp(1j * found.launch_heading[0])
        )
        assert abs(place - (2.0 + 0.1j)) <= 2e-6
        assert found.miss[0] <= 1e-9


def test_what_leaves_floating_point_is_said():
    tiny = {"radius": 1e-300}
    for options in ({"spin": 1e-300, **tiny}, {"max_spin": 1e-300, **tiny}, {"radius": 5e-324},
                    {"spin": 1e-300, "delta": 2.0, **tiny}, {"speed": 1e-290}):  # fmt: skip
        try:
            found = aim((2.0, 0.1), **options)
        except InputError as error:
            assert "floating point" in str(error)
        else:
            assert np.isfinite(found.launch_velocity).all()
            assert found.miss.max() <= 1e-9
    for target in ((1.7e308, 1.7e308), (1.7e308, 0.0)):
        with pytest.raises(InputError, match="use larger units"):
            aim(target, spin=1.0)
    with pytest.raises(InputError, match="other units"):
        aim((0.0, 0.0), stop_time=1e300, radius=1e-300, decel=1e200)

"""Slides of pucks on bases of any shape: known answers, symmetries, and scipy as the judge."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from base_judge import Judge
from rarely import few
from scipy.integrate import solve_ivp

from puck_tables import Base, Puck
from puck_tables.errors import AccuracyError, ContactError, InputError
from puck_tables.kernels.as_written import as_written
from puck_tables.kernels.base_friction import base_friction, packed

BOX = Base.box(0.2, 0.1)
TRIANGLE = Base.polygon([(0.0, 0.0), (0.12, 0.0), (0.0, 0.09)])
OFF_CENTRE = Base.disc(0.05, centre=(0.01, 0.0))
JUDGED = 2e-10  # of Q/J, Q²/J: what the judge errs by, seen as its steps are made finer
OFF_GYRATION = math.sqrt(0.05**2 / 2 - 0.01**2)


def turned(velocity: tuple[float, float], angle: float) -> np.ndarray:
    """A vector turned by an angle."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([c * velocity[0] - s * velocity[1], s * velocity[0] + c * velocity[1]])


# physics by an independent program, scipy's DOP853 at 1e-12: time, place, angle of the body
KNOWN = {
    "triangle": (
        Puck(base=TRIANGLE, friction=0.25), (0.8, 0.0), -15.0, 0.0,
        (0.4234099378, 0.1608519283, 0.0011112212, -3.4301195933),
    ),
    "box": (
        Puck(base=BOX, friction=0.3), (1.0, 0.0), 10.0, math.pi / 6,
        (0.4421850099, 0.2097666929, 0.0019267285, 3.0053561162),
    ),
    "disc off its centre": (
        Puck(base=OFF_CENTRE, friction=0.2, gyration=OFF_GYRATION), (1.0, 0.0), 20.0, 0.0,
        (0.6756148494, 0.3187052185, -0.0001404809, 7.3656062776),
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", KNOWN)
def test_known_answers(name: str):
    puck, velocity, spin, angle, expected = KNOWN[name]
    run = puck.simulate(turned(velocity, -angle), spin)
    place = turned(run.stop_position, angle)
    found = [run.stop_time, *place, run.body_angle + angle]
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-8)
    one = puck.stop(turned(velocity, -angle), spin, tol=1e-9)
    found = [float(one.stop_time), *turned(one.stop_position, angle), float(one.body_angle) + angle]
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-8)


def test_a_polygon_of_four_corners_is_a_box():
    corners = [(-0.1, -0.05), (0.1, -0.05), (0.1, 0.05), (-0.1, 0.05)]
    one, other = (
        Puck(base=base, friction=0.3, height=0.04).stop((1.0, 0.3), 12.0)
        for base in (BOX, Base.polygon(corners))
    )
    assert one.stop_time == other.stop_time
    assert one.body_angle == other.body_angle


@pytest.mark.parametrize("height", [0.0, 0.06, 0.125])
def test_a_base_that_is_a_disc_is_the_round_puck(height: float):
    numbers = {"friction": 0.2, "height": height}
    base, round_one = Puck(base="disc:0.05", **numbers), Puck(radius=0.05, **numbers)
    v = np.array([[1.0, 0.0], [0.3, -0.4], [1e-4, 0.0]])
    spin = np.array([[20.0], [-3.0], [1e-5], [300.0]])
    one, other = base.stop(v, spin, tol=1e-11), round_one.stop(v, spin, tol=1e-11)
    unit = np.hypot(np.hypot(*v.T), 0.05 * spin) / round_one.decel
    length = unit * unit * round_one.decel
    assert (np.abs(one.stop_time - other.stop_time) / unit).max() < 1e-10
    assert (np.abs(one.stop_position - other.stop_position) / length[..., None]).max() < 1e-10
    assert (0.05 * np.abs(one.body_angle - other.body_angle) / length).max() < 1e-10
    times = [0.0, 0.1, 0.5]
    states = [puck.states((1.0, 0.5), 30.0, times) for puck in (base, round_one)]
    for name in ("x", "y", "vx", "vy", "spin", "orientation"):
        one, other = (getattr(found, name) for found in states)
        np.testing.assert_allclose(one, other, rtol=0, atol=2e-8)


def test_polygons_of_many_corners_tend_to_the_disc_at_order_2():
    disc = Puck(base="disc:0.05", friction=0.2, height=0.05).stop((1.0, 0.0), 20.0, tol=1e-11)

    def off(count: int) -> float:
        turn = 2.0 * np.pi * np.arange(count) / count
        corners = 0.05 * np.column_stack([np.cos(turn), np.sin(turn)])
        gyration = 0.05 / math.sqrt(2.0)
        base = Puck(base=Base.polygon(corners), friction=0.2, height=0.05, gyration=gyration)
        found = base.stop((1.0, 0.0), 20.0, tol=1e-11)
        return abs(float(found.stop_time - disc.stop_time))

    errors = np.array([off(count) for count in (24, 48, 96, 192)])
    np.testing.assert_allclose(np.log2(errors[:-1] / errors[1:]), 2.0, atol=0.05)


def test_a_flat_base_slides_straight_without_spin():
    for base, gyration in ((TRIANGLE, None), (BOX, None), (OFF_CENTRE, 0.03)):
        puck = Puck(base=base, friction=0.3, gyration=gyration)
        found = puck.stop((0.6, 0.8), 0.0)
        np.testing.assert_allclose(found.stop_time, 1.0 / puck.decel, rtol=1e-14)
        straight = np.array([0.6, 0.8]) * 0.5 / puck.decel
        np.testing.assert_allclose(found.stop_position, straight, rtol=1e-13)
        assert abs(found.body_angle) < 1e-15
        run = puck.simulate((0.6, 0.8))
        assert (run.regime, run.steps) == ("slide last", 0)


def test_pure_spin_of_a_symmetric_base_stays_pure_spin():
    puck = Puck(base=Base.box(0.1, 0.1), friction=0.5)
    run = puck.simulate((0.0, 0.0), 8.0)
    arm = 0.3825978582 * 0.1  # torque over f N, of a square that turns in place
    np.testing.assert_allclose(
        run.stop_time, 8.0 * puck.gyration**2 / (puck.decel * arm), rtol=1e-9
    )
    assert math.hypot(*run.stop_position) < 1e-16
    assert run.regime == "spin last"


def test_a_bar_is_its_line():
    # ends at v = kω, with C at ±L/√12, where friction takes √(2/3) f of Q
    thin = Puck(base=Base.box(1.0, 1e-5), friction=0.3)
    run = thin.simulate((0.0, 1.0), 3.0, tol=1e-7)  # friction of so thin a base is off by 3e-10
    assert run.regime == "together"
    late = run([0.999 * run.stop_time])
    assert late.slip_angle[0] == pytest.approx(math.pi / 4, abs=2e-3)
    fall = late.slip_speed[0] / (0.001 * run.stop_time) / thin.decel
    assert fall == pytest.approx(math.sqrt(2.0 / 3.0), abs=1e-3)


@pytest.mark.parametrize(
    ("base", "ends", "fall", "axis"),
    [
        (BOX, (0.7115, 0.7027), 0.8677, math.pi / 2),
        (Base.box(0.1, 0.1), (0.6778, 0.7353), 0.9054, math.pi / 4),
    ],
)  # fmt: skip
def test_how_boxes_end(base: Base, ends: tuple[float, float], fall: float, axis: float):
    # launched in the end direction it stays there: the whole slide is at one direction
    puck = Puck(base=base, friction=0.3)
    velocity = ends[0] * np.array([math.cos(axis), math.sin(axis)])
    spin = ends[1] / puck.gyration
    lasts = puck.simulate(velocity * 1e-3, spin * 1e-3)  # it hardly turns on so short a way
    assert lasts.stop_time * puck.decel / 1e-3 == pytest.approx(1.0 / fall, abs=1e-4)
    near = lasts(0.99 * lasts.stop_time)
    assert math.tan(near.slip_angle[0]) == pytest.approx(ends[1] / ends[0], abs=1e-3)


def test_the_end_of_a_box_is_told():
    run = Puck(base=BOX, friction=0.3).simulate((1.0, 0.0), 10.0)
    assert run.regime == "together"
    assert "v : k|w| = 0.7115 : 0.7027." in run.explain()
    tall = Puck(base=Base.box(0.1, 0.1), friction=0.3, height=0.06).simulate((1.0, 0.2), 10.0)
    assert "still turning by 0.1" in tall.explain()
    small = Puck(base=BOX, friction=0.3, gyration=0.02).simulate((1.0, 0.2), 10.0)
    assert small.regime == "slide last"
    large = Puck(base=BOX, friction=0.3, gyration=0.5).simulate((1.0, 0.2), 10.0)
    assert large.regime == "spin last"


def test_feet_end_turning_about_one_of_them():
    """The centre of rotation late in a slide, from its states, lies in a foot, or in none."""
    feet, radius = np.array([(0.08, 0.0), (-0.05, 0.06), (-0.05, -0.06)]), 0.002
    middle = feet.mean(axis=0)
    found = set()
    for gyration, spin in ((None, 12.0), (0.12, -20.0), (0.12, 30.0), (0.12, 40.0), (0.14, 12.0)):
        puck = Puck(base=Base.feet(feet, radius), friction=0.3, gyration=gyration)
        run = puck.simulate((0.5, 0.2), spin)
        late = run([(1.0 - 1e-5) * run.stop_time])
        vx, vy, w, angle = (getattr(late, n)[0] for n in ("vx", "vy", "spin", "orientation"))
        x, y = -vy / w, vx / w
        c, s = math.cos(angle), math.sin(angle)
        centre = np.array([c * x + s * y, c * y - s * x])
        away = np.hypot(*(feet - middle - centre).T).min()
        assert run.regime == ("pivot" if away < radius else "together")
        found.add(run.regime)
    assert found == {"pivot", "together"}


@pytest.mark.parametrize(
    ("sides", "height", "regime"),
    [((0.1, 0.1), 0.0, "together"), ((0.1, 0.1), 0.06, "cycle"), ((0.2, 0.1), 0.06, "together")],
)
def test_tall_and_nearly_symmetric_bodies_end_in_no_direction(sides, height, regime):
    """By the judge: the direction of (v, kω), settles while Q falls by e^60, or not."""
    a, b = 0.5 * sides[0], 0.5 * sides[1]
    k = math.sqrt((sides[0] ** 2 + sides[1] ** 2) / 12.0)
    judge = Judge([[(-a, -b), (a, -b), (a, b), (-a, b)]], [], 0.3 * 0.5 * height, k)

    def change(_: float, e: np.ndarray) -> np.ndarray:  # over −ln Q
        force, torque = judge.friction(e[0], e[1], e[2] / k)
        pull = np.array([*force, torque / k])
        return (pull - (pull @ e) * e / (e @ e)) / -(pull @ e)

    start = np.array([1.0, 0.2, 0.8]) / math.sqrt(1.68)
    late = solve_ivp(change, (0.0, 60.0), start, rtol=1e-9, atol=1e-11).y[:, -1]
    turns = float(np.hypot.reduce(change(0.0, late)))
    if regime == "cycle":
        assert turns > 0.05
    else:  # it dies out, as fast as a square allows
        assert turns < 0.01
    run = Puck(base=Base.box(*sides), friction=0.3, height=height).simulate((1.0, 0.2), 10.0)
    assert run.regime == regime


def test_scales_of_length_mass_and_gravity():
    small = Puck(base=BOX, friction=0.3, height=0.04)
    large = Puck(
        base=Base.box(0.6, 0.3), friction=0.3, height=0.12, mass=7.0, gravity=2.0 * small.gravity
    )
    one = small.simulate((1.0, 0.5), 9.0, frames=7)
    rate = math.sqrt(2.0 / 3.0)  # of time
    other = large.simulate((3.0 * rate, 1.5 * rate), 9.0 * rate, frames=7)
    np.testing.assert_allclose(one.stop_time, other.stop_time * rate, rtol=1e-9)
    np.testing.assert_allclose(3.0 * one.x, other.x, atol=1e-9)
    np.testing.assert_allclose(one.orientation, other.orientation, atol=1e-8)


def test_energy_never_grows_and_is_accounted_for():
    puck = Puck(base=TRIANGLE, friction=0.4, height=0.02, mass=2.0)
    run = puck.simulate((1.0, -0.7), -25.0, frames=200)
    assert (np.diff(run.slip_speed) < 0.0).all()
    assert run.energy_residual < 1e-10
    assert run.kinetic_energy == pytest.approx(run.slip_speed[0] ** 2)
    assert run.error_estimate < 1e-9


def test_states_are_those_of_the_simulation():
    puck = Puck(base=TRIANGLE, friction=0.3, height=0.02)
    velocity, spin = np.array([[1.0, 0.0], [0.2, -0.6], [0.0, 0.0]]), np.array([7.0, -30.0, 0.0])
    times = np.array([0.4, 0.0, 0.05, 3.0])
    found = puck.states(velocity[:, None, :], spin[:, None], times)
    assert found.x.shape == (3, 4)
    for n in range(2):
        run = puck.simulate(velocity[n], spin[n], times=times, tol=1e-11)
        for name in ("x", "y", "orientation", "vx", "vy", "spin", "slip_speed", "slip_angle"):
            np.testing.assert_allclose(
                getattr(found, name)[n], getattr(run, name), rtol=0, atol=1e-7
            )
    assert not found.x[2].any()
    # velocities are rates of places
    near = puck.states((1.0, 0.0), 7.0, 0.1 + 1e-5 * np.array([-1.0, 0.0, 1.0]))
    for place, rate in (("x", "vx"), ("y", "vy"), ("orientation", "spin")):
        rows = getattr(near, place)
        assert (rows[2] - rows[0]) / 2e-5 == pytest.approx(getattr(near, rate)[1], abs=1e-7)


def test_threads_and_cutting_change_no_bit():
    puck = Puck(base=TRIANGLE, friction=0.3)
    rng = np.random.default_rng(5)
    v, w = rng.normal(size=(300, 2)), rng.normal(size=300) * 20.0
    one, two = puck.stop(v, w, threads=1), puck.stop(v, w, threads=2)
    assert np.array_equal(one.stop_time, two.stop_time)
    alone = puck.stop(v[77], w[77])
    assert float(alone.stop_time) == one.stop_time[77]
    assert np.array_equal(alone.stop_position, one.stop_position[77])


def test_kernels_as_they_are_written():
    from puck_tables.motion.base_slides import fill_slides, launch_rows

    puck = Puck(base=TRIANGLE, friction=0.3, height=0.02)
    launch = launch_rows(puck, np.array([[1.0, 0.2]]), np.array([5.0]))
    base = packed(TRIANGLE, puck.lever)
    results = []
    for run in (fill_slides, fill_slides.py_func):
        out, states, status = np.empty((10, 1)), np.empty((2, 6)), np.empty(1, np.int8)
        run(base, launch, 1e-6, np.array([0, 2]), np.array([0.3, 2.0]), out, states, status)
        results.append(np.concatenate([out.ravel(), states.ravel()]))
    if not as_written():
        one, other = (
            results  # rounding, where 1e-7 of Q is left, tells in how its direction changes
        )
        np.testing.assert_allclose(np.delete(one, 8), np.delete(other, 8), rtol=1e-9, atol=1e-12)
        assert one[8] == pytest.approx(other[8], rel=1e-7)


def random_slide(seed: int) -> tuple[Puck, np.ndarray, float]:
    """A puck on a polygon, feet, an off-centre disc, a box or a ring, and a launch of it."""
    rng = np.random.default_rng([38, seed])
    while True:
        try:
            kind = seed % 5
            if kind == 0:
                turn = np.sort(rng.uniform(0.0, 2.0 * np.pi, rng.integers(3, 8)))
                rays = 0.1 * rng.uniform(0.3, 1.0, turn.size)
                base = Base.polygon(np.column_stack([rays * np.cos(turn), rays * np.sin(turn)]))
            elif kind == 1:
                turn = np.sort(rng.uniform(0.0, 2.0 * np.pi, rng.integers(3, 5)))
                centres = 0.1 * np.column_stack([np.cos(turn), np.sin(turn)])
                base = Base.feet(centres, 10.0 ** rng.uniform(-2.5, -1.5))
            elif kind == 2:
                base = Base.disc(0.05, centre=tuple(rng.uniform(-0.008, 0.008, 2)))
            elif kind == 3:
                base = Base.box(*(0.1 * 10.0 ** rng.uniform(-1.0, 0.5, 2)))
            else:
                base = Base.annulus(0.05, 0.05 * rng.uniform(0.1, 0.9))
        except (InputError, ContactError):
            continue
        break
    friction = rng.uniform(0.05, 1.0)
    height = rng.integers(2) * rng.uniform(0.0, 2.0 * base.highest_lever / friction)
    gyration = base.reach * 10.0 ** (
        rng.uniform(-0.5, 0.1) if rng.random() < 0.8 else rng.uniform(-1, 1)
    )
    puck = Puck(base=base, friction=friction, height=height, gyration=gyration)
    phi = rng.uniform(0.0, 0.5 * np.pi) if rng.random() < 0.8 else 10.0 ** rng.uniform(-5.0, 0.0)
    heading = rng.uniform(0.0, 2.0 * np.pi)
    q = math.sqrt(10.0 ** rng.uniform(-1.0, 1.7) * puck.decel * gyration)  # of Q²/(J k)
    velocity = q * math.cos(phi) * np.array([math.cos(heading), math.sin(heading)])
    return puck, velocity, rng.choice([-1.0, 1.0]) * q * math.sin(phi) / gyration


@pytest.mark.parametrize("seed", range(10))
def test_friction_is_that_of_the_judge(seed: int):
    puck, _, _ = random_slide(seed)
    judge, base = Judge.of_puck(puck), packed(puck.shape, puck.lever)
    rng = np.random.default_rng(seed)
    for _ in range(40):
        w = rng.normal()
        u = rng.normal(size=2) * judge.reach * abs(w) * 10.0 ** rng.uniform(-3.0, 2.0)
        force, torque = judge.friction(*u, w)
        found = base_friction(base, 0.0, *u, w)
        np.testing.assert_allclose(found[:2], force, rtol=0, atol=1e-11)
        assert abs(found[2] - torque) < 1e-11 * judge.reach


def keeps_its_tolerance(seed: int) -> None:
    puck, velocity, spin = random_slide(seed)
    truth = Judge.of_puck(puck).slide(velocity, spin, puck.decel)
    q0 = math.hypot(*velocity, puck.gyration * spin)
    time, length = q0 / puck.decel, q0 * q0 / puck.decel
    assert puck.shape is not None
    scale = np.array([time, length, length, length, length / puck.shape.reach])
    for tol in (1e-3, 1e-6, 1e-9):
        one = puck.stop(velocity, spin, tol=tol)
        assert one.status == 0
        found = [one.stop_time, *one.stop_position, one.path_length, one.body_angle]
        off = np.abs(np.array(found) - truth) / scale
        assert off.max() <= tol + JUDGED, (seed, puck, tol, off)


@pytest.mark.thorough
@pytest.mark.parametrize("block", few(1, range(12)))
def test_every_slide_keeps_its_tolerance(block: int):
    """Blocks of twenty random slides: 240 in all."""
    for seed in range(20 * block, 20 * (block + 1)):
        keeps_its_tolerance(seed)


@pytest.mark.thorough
def test_a_slide_of_a_flywheel_keeps_its_tolerance():
    """It takes 22 Q/J: what steps err by has the time to grow."""
    keeps_its_tolerance(545)


@pytest.mark.parametrize(
    ("ask", "words"),
    [
        (lambda p: p.simulate((1, 0), 1.0, method="rk4"), "method is of round pucks"),
        (lambda p: p.simulate((1, 0), 1.0, exact=True), "exact is of round pucks"),
        (lambda p: p.stop((1, 0), 1.0, jacobian=True), "jacobian is of round pucks"),
        (lambda p: p.stop((1, 0), 1.0).turn_angle, "turn_angle is of round pucks"),
        (lambda p: p.states((1, 0), 1.0, 0.1, jacobian=True), "jacobian is of round pucks"),
        (lambda p: p.states((1, 0), 1.0, -0.1), "time must not be negative"),
        (lambda p: p.aim((1, 0)), "aim is of round pucks: .* Scene"),
        (lambda p: p.regime((1, 0), 1.0), "regime is of round pucks"),
        (lambda p: p.limit_ratio, "limit_ratio is of round pucks"),
        (lambda p: p.simulate((1, 0, 0)), "two components"),
        (lambda p: p.simulate((1, math.nan)), "finite"),
        (lambda p: p.simulate((1e200, 0)), "too large for floating point"),
        (lambda p: p.simulate((1, 0), frames=0), "frames must be"),
        (lambda p: replace(p, friction=0.0).stop((1, 0)), "never stops"),
    ],
)
def test_what_makes_no_sense_is_refused(ask: Callable[[Puck], Any], words: str):
    with pytest.raises(InputError, match=words):
        ask(Puck(base=BOX, friction=0.3))


def test_tolerances_out_of_reach():
    puck = Puck(base=BOX, friction=0.3)
    for tol in (1e-13, 0.1):
        with pytest.raises(AccuracyError, match=r"from 1e-12 to 0\.01"):
            puck.simulate((1, 0), 1.0, tol=tol)
    assert puck.stop((1e200, 0.0), 1.0).status == 2


def test_results_have_files_and_no_columns_of_round_pucks():
    puck = Puck(base=BOX, friction=0.3)
    run, stops = puck.simulate((1.0, 0.0), 10.0, frames=3), puck.stop((1.0, 0.0), [1.0, 10.0])
    assert run.turn_angle is run.turn_rate is run.limit_angle is None
    told = run.summary()
    assert told["base"] == "box:0.2x0.1"
    assert told["units"]["gyration"] == "m"
    assert not {"delta", "radius", "pressure"} & {*told, *run.dataset().attributes}
    assert not {"delta", "turn_angle"} & {*stops.dataset().columns}
    assert {"stop_time", "body_angle", "stop_distance"} <= {*stops.dataset().columns}

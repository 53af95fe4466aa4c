"""The benchmark cases: their answers by integrators that share nothing with the package."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
from any_puck import stops_by_truth
from base_judge import Judge
from pucks_judge import Disc, Floor, Line, play
from rarely import thorough
from rays_judge import friction_of
from reference import states as flat_states
from scipy.integrate import solve_ivp
from test_reference_astride import shares_off

from puck_tables import InputError, compare, floor_friction, reference_case
from puck_tables.reference.cases import CASES, case_named

FREE = ("coin", "slide-spin-0.2", "slide-spin-0.5", "slide-spin-1", "slide-spin-2", "slide-spin-5",
        "tall-0.5", "tall-1")  # fmt: skip
NOT_YET = 0.97  # of the way to the stop, where scipy still has its digits


def puck_of(name: str) -> tuple[float, float, float]:
    """r, J and δ from what the case says."""
    puck = case_named(name).tables["puck"]
    j = puck["friction"] * puck["gravity"]
    return puck["radius"], j, 2.0 * puck["friction"] * puck["height"] / puck["radius"]


def test_every_case_says_what_it_is():
    names = [case.name for case in CASES]
    assert len(set(names)) == len(names)
    page = Path(__file__).parents[1] / "docs/reference-cases.md"
    assert f"Here are {len(names)}, named" in page.read_text(encoding="utf-8")
    assert all(case.version >= 1 and case.title and case.tests for case in CASES)


@pytest.mark.parametrize("name", FREE)
def test_free_cases_by_an_independent_integrator(name: str):
    """Within the bound, and that below 1e-10 of Q/J and Q²/J."""
    r, j, delta = puck_of(name)
    launch = case_named(name).tables["launch"]
    v, rim = launch["velocity"][0], r * launch["spin"]
    q = math.hypot(v, rim)
    answer = reference_case(name)
    assert answer.share_bound <= 1e-10
    times = np.linspace(0.05, NOT_YET, 7) * answer.end_time
    z = flat_states((v / q, 0.0), rim / q, delta, times * j / q)
    length, back = q * q / j, [3, 4, 5, 0, 1, 2]
    truth = z[back] * np.array([length, length, length / r, q, q, q / r])[:, None]
    assert shares_off(answer, times, truth).max() < 2e-10  # the judge's own error next to the bound


@pytest.mark.parametrize("name", ["coin", "slide-spin-2", "tall-1"])
def test_stops_by_an_independent_integrator(name: str):
    """In ln Q by the judge's friction: the stop itself, to the bound and rounding of the judge."""
    from reference import friction

    r, j, delta = puck_of(name)
    launch = case_named(name).tables["launch"]
    v, rim = launch["velocity"][0], r * launch["spin"]
    q = math.hypot(v, rim)

    def rates(_: float, z: np.ndarray) -> list[float]:  # dt = Q dτ
        size = math.exp(z[0])
        vx, vy, w = math.cos(z[1]) * math.cos(z[2]), math.cos(z[1]) * math.sin(z[2]), math.sin(z[1])
        ax, ay, aw = friction(vx, vy, w, delta)
        c, s = math.cos(z[2]), math.sin(z[2])
        along, across = ax * c + ay * s, -ax * s + ay * c
        fall = math.cos(z[1]) * along + w * aw
        turn = math.cos(z[1]) * aw - w * along
        return [fall, turn, across / math.cos(z[1]), size, size * size * vx, size * size * vy]

    start = [0.0, math.atan2(rim, v), 0.0, 0.0, 0.0, 0.0]
    found = solve_ivp(rates, (0.0, 36.0), start, "DOP853", rtol=1e-12, atol=1e-13)
    time, x, y = found.y[3:, -1]
    answer = reference_case(name)
    last = answer.last()
    assert abs(answer.end_time * j / q - time) < 1e-10
    assert abs(last["x"] * j / q**2 - x) < 1e-10
    assert abs(last["y"] * j / q**2 - y) < 1e-10


def body(name: str) -> tuple[Judge, float, float]:
    """Its judge, J and the angle at the launch; the centre of mass in the origin."""
    tables = case_named(name).tables
    puck, shapes = tables["puck"], {
        "box": ([[(-0.1, -0.05), (0.1, -0.05), (0.1, 0.05), (-0.1, 0.05)]], []),
        "box-tall": ([[(-0.1, -0.05), (0.1, -0.05), (0.1, 0.05), (-0.1, 0.05)]], []),
        "bar": ([[(-0.15, -0.005), (0.15, -0.005), (0.15, 0.005), (-0.15, 0.005)]], []),
        "triangle": ([[(-0.05, -0.05), (0.1, -0.05), (-0.05, 0.1)]], []),
        "off-centre": ([], [(-0.01, 0.0, 0.05, 1.0)]),
        "three-feet": ([], [(x + 0.02 / 3.0, y, 0.005, 1.0)
                            for x, y in ((0.08, 0.0), (-0.05, 0.06), (-0.05, -0.06))]),
    }  # fmt: skip
    gyrations = {
        "box": math.sqrt((0.04 + 0.01) / 12.0), "bar": math.sqrt((0.09 + 1e-4) / 12.0),
        "triangle": math.sqrt(2.0 * 0.15**2 / 18.0), "off-centre": 0.036,
    }  # fmt: skip
    friction = puck["friction"]
    k = gyrations.get(name.removesuffix("-tall"))
    if k is None:  # of three discs about their centre
        k = math.sqrt(0.005**2 / 2.0 + np.mean([x * x + y * y for x, y, _, _ in shapes[name][1]]))
    judge = Judge(*shapes[name], friction * 0.5 * puck["height"], k)
    return judge, friction * puck["gravity"], tables["launch"]["orientation"]


@pytest.mark.parametrize(
    "name",
    [
        "box", "triangle",
        *map(thorough, ("box-tall", "bar", "off-centre", "three-feet")),
    ],
)  # fmt: skip
def test_bodies_by_an_independent_integrator(name: str):
    """Their stops, in the axes of the body at the launch."""
    judge, decel, angle = body(name)
    launch = case_named(name).tables["launch"]
    c, s = math.cos(angle), math.sin(angle)
    vx, vy = launch["velocity"]
    time, x, y, _, turn = judge.slide((c * vx + s * vy, c * vy - s * vx), launch["spin"], decel)
    answer = reference_case(name, times=[0.0])
    last, q, j = answer.last(), answer.speed_scale, answer.rate_scale
    assert answer.share_bound <= 1e-10
    assert abs(answer.end_time - time) < 2e-10 * q / j
    place = np.array([c * x - s * y, s * x + c * y])
    assert np.abs(place - [last["x"], last["y"]]).max() < 2e-10 * q * q / j
    assert abs(last["orientation"] - angle - turn) < 2e-10 * q * q / j / judge.k


@pytest.mark.parametrize("name", [case.name for case in CASES if "base" in case.tables["puck"]])
def test_files_of_a_body_have_all_its_numbers(name: str, tmp_path: Path):
    """And held against itself as a log it has no error."""
    answer = reference_case(name, dt=0.05)
    told = json.loads(json.dumps(answer.summary()))
    assert told["delta"] is None and told["scene"]["puck"]["base"]
    answer.save(tmp_path / "exact.h5")
    answer.save(tmp_path / "exact.csv")
    found = compare(tmp_path / "exact.csv", name).rows()[0]
    assert found["place_error_max"] == found["speed_error_max"] == found["angle_error_max"] == 0.0


def test_a_flat_body_thrown_without_a_spin_goes_straight():
    answer = reference_case("box-straight")
    assert np.abs(answer.orientation - 0.5).max() < 1e-12 and answer.floor_torque.max() < 1e-12
    assert np.abs(answer.y - 0.2 * answer.x).max() < 1e-12


def test_the_force_of_a_body_on_the_floor_is_what_brakes_it():
    """F = m a, by differences of second order of its velocity."""
    answer = reference_case("triangle")
    times = np.array([0.1, 0.2])
    gap = 1e-4
    before, after, here = (answer(times + shift) for shift in (-gap, gap, 0.0))
    mass = case_named("triangle").tables["puck"]["mass"]
    for speed, force in (("vx", "floor_fx"), ("vy", "floor_fy")):
        pull = mass * (getattr(after, speed) - getattr(before, speed)) / (2.0 * gap)
        assert np.abs(getattr(here, force) + pull).max() < 1e-5


def test_the_slip_of_a_box_on_belts_is_over_the_one_under_its_centre():
    answer = reference_case("box-belts", times=[0.0, 0.6])
    assert answer.x[0] < 0.0 < answer.x[1]
    speeds = np.hypot(answer.vx - [0.5, 0.2], answer.vy)
    turn = reference_case("box-belts").pucks[0].radius * answer.spin
    np.testing.assert_allclose(answer.slip_speed, np.hypot(speeds, turn), rtol=1e-12, atol=1e-12)


def test_the_coin():
    answer = reference_case("coin")
    assert round(answer.end_time, 7) == 0.1238118
    assert [round(1e3 * answer.last()[axis], 4) for axis in "xy"] == [11.6283, -0.0736]


def test_elementary_cases_and_the_threshold_of_a_slope():
    g, f, r = 9.81, 0.2, 0.05
    spin, slide = reference_case("spin"), reference_case("slide")
    assert spin.end_time == pytest.approx(0.75 * r * 20.0 / (f * g), rel=1e-12)
    assert slide.end_time == pytest.approx(1.0 / (f * g), rel=1e-12)
    assert slide.last()["x"] == pytest.approx(0.5 / (f * g), rel=1e-12)
    steep = reference_case("incline-above")
    assert steep.end == reference_case("incline-at").end == "time is up"
    assert reference_case("incline-below").end == "at rest"


def discs_of_the_take_out() -> list[Disc]:
    """The pucks of the case, for the judge."""
    tables = case_named("take-out").tables["puck"]
    discs = []
    for one in tables:
        (x, y), launch = one["launch"].get("position", (0.0, 0.0)), one["launch"]
        vx, vy = launch.get("velocity", (0.0, 0.0))
        state = np.array([x, y, 0.0, vx, vy, launch.get("spin", 0.0)])
        # the judge has its own gravity
        f = one["friction"] * one["gravity"] / 9.80665
        height = one["height"] * one["friction"] / f
        discs.append(Disc(one["radius"], one["mass"], f, height, state, one["restitution"],
                          one["tangential"], one["rim"]))  # fmt: skip
    return discs


def test_the_take_out_by_an_independent_integrator():
    """Within its own bound, up to the judge's threshold of rest."""
    told = play(Floor(), discs_of_the_take_out(), [], 2.0)
    answer = reference_case("take-out")
    assert answer.share_bound <= 1e-10
    assert len(told.impacts) == 1
    assert abs(told.impacts[0][0] - answer.run.events[0].time) < answer.time_bound
    stops = np.column_stack([answer.last()["x"], answer.last()["y"]])
    assert np.abs(stops - told.states[:, :2]).max() < answer.place_bound


@pytest.mark.parametrize("time", [0.1, 0.35])
def test_the_take_out_on_its_way(time: float):
    """Places, angles, velocities and spins before and after the impact, within the bounds."""
    truth = play(Floor(), discs_of_the_take_out(), [], time).states
    answer = reference_case("take-out")
    ours = answer([time])
    r, place = answer.pucks[0].radius, answer.place_bound
    for n, (name, bound) in enumerate((
        ("x", place), ("y", place), ("orientation", place / r), ("vx", answer.speed_bound),
        ("vy", answer.speed_bound), ("spin", answer.speed_bound / r),
    )):  # fmt: skip
        assert np.abs(ours.columns[name][0] - truth[:, n]).max() <= bound


def test_each_puck_of_the_take_out_has_a_stop_of_its_own():
    """The judge's red still slips five milliseconds before, by about J times that."""
    answer = reference_case("take-out")
    red = play(Floor(), discs_of_the_take_out(), [], answer.end_time_of(0) - 5e-3).states[0]
    assert math.hypot(*red[3:5], 0.05 * red[5]) == pytest.approx(5e-3 * 0.2 * 9.81, rel=0.2)
    assert answer.end_time_of(0) < answer.end_time_of(1) == answer.end_time


def test_the_rebound_by_an_independent_integrator():
    tables = case_named("rebound").tables
    one, wall, launch = tables["puck"], tables["wall"][0], tables["launch"]
    f = one["friction"] * one["gravity"] / 9.80665
    state = np.array([0.0, 0.0, 0.0, *launch["velocity"], launch["spin"]])
    height = one["height"] * one["friction"] / f
    disc = Disc(one["radius"], one["mass"], f, height, state, 1.0, 0.0)
    line = Line((-1.0, 0.0), -wall["point"][0], wall["restitution"], wall["tangential"],
                wall["friction"])  # fmt: skip
    told, answer = play(Floor(), [disc], [line], 2.0), reference_case("rebound")
    assert abs(told.impacts[0][0] - answer.run.events[0].time) < 1e-10
    last = answer.last()
    assert np.abs(told.states[0, :2] - [last["x"], last["y"]]).max() < 1e-9


@pytest.mark.thorough
@pytest.mark.parametrize("name", ["annulus", "tall-2"])
def test_other_pucks_by_another_integrator(name: str):
    """On the friction of the law itself, which a grid judges: no table, none of the motion."""
    tables, answer = case_named(name).tables, reference_case(name)
    puck, launch = tables["puck"], tables["launch"]
    ratio = puck["radius"] * launch["spin"] / launch["velocity"][0]
    law, gyration = puck.get("pressure", "uniform"), puck.get("gyration", math.sqrt(0.5))
    truth = stops_by_truth(law, answer.pucks[0].delta, gyration, np.array([math.log(ratio)]))
    q, j = answer.speed_scale, answer.rate_scale
    last = answer.last()
    ours = [answer.end_time * j / q, last["x"] * j / q**2, last["y"] * j / q**2]
    assert np.abs(np.array(ours) - truth[:3, 0]).max() < 1e-10


@pytest.mark.parametrize("name", ["coin", "tall-1", "turntable", "incline-above"])
def test_forces_on_the_floor_are_what_the_puck_lacks(name: str):
    """Newton's third law: from differences of its velocities, and what else acts."""
    answer = reference_case(name)
    step = 1e-5 * answer.end_time
    middle = np.linspace(0.2, 0.8, 4) * answer.end_time
    before, at, after = (answer(middle + n * step) for n in (-1.0, 0.0, 1.0))
    puck, floor = answer.pucks[0], answer.floor
    down = puck.gravity * math.sin(floor.slope)
    rates = [(getattr(after, n) - getattr(before, n)) / (2.0 * step) for n in ("vx", "vy", "spin")]
    fx = puck.mass * (down * math.cos(floor.downhill) - rates[0])
    fy = puck.mass * (down * math.sin(floor.downhill) - rates[1])
    torque = -0.5 * puck.mass * puck.radius**2 * rates[2]
    load = puck.friction * puck.mass * puck.gravity
    for mine, truth, unit in (
        (at.floor_fx, fx, load), (at.floor_fy, fy, load),
        (at.floor_torque, torque, load * puck.radius),
    ):  # fmt: skip
        assert np.abs(mine - truth).max() < 1e-6 * unit


@pytest.mark.parametrize("name", ["slide-spin-1", "annulus", "tall-1"])
def test_friction_over_epsilon_by_points_on_rays(name: str):
    """Shares of fN and fNr, the pressure tilted until moments balance."""
    puck, inner = case_named(name).tables["puck"], 0.5 if name == "annulus" else 0.0
    delta = 2.0 * puck["friction"] * puck["height"] / puck["radius"]
    found = floor_friction(name, [0.3, 3.0])
    shares = np.stack([found.share_along, found.share_across, found.share_torque], axis=1)
    for epsilon, mine in zip((0.3, 3.0), shares, strict=True):
        truth = friction_of(
            [(0.0, 0.0, 1.0), (0.0, 0.0, max(inner, 1e-3))],
            lambda x, y: (np.hypot(x, y) < 1.0) & (np.hypot(x, y) > inner),
            lambda x, y, ex, ey: (ex, ey), (epsilon, 0.0, 1.0), 0.25 * delta,
        )  # fmt: skip
        assert mine == pytest.approx(-truth, abs=1e-10)


def test_frames_of_an_engine():
    coin = reference_case("coin", fps=240)
    assert coin.time.tolist() == [n / 240 for n in range(31)]
    assert coin.time[-2] < coin.end_time <= coin.time[-1]
    assert coin.speed[-1] == coin.spin[-1] == coin.floor_torque[-1] == 0.0
    shuffled = coin([0.1, 0.0, 0.05])
    assert shuffled.x.tolist() == [coin([t]).x[0] for t in (0.1, 0.0, 0.05)]


def test_frames_from_a_file(tmp_path: Path):
    list_of, log = tmp_path / "times.txt", tmp_path / "log.csv"
    list_of.write_text("0\n0.02\n0.04\n")
    log.write_text("x [m],t [ms]\n9,0\n9,20\n9,40\n")
    for path in (list_of, log):
        assert reference_case("coin", times=path).time.round(12).tolist() == [0.0, 0.02, 0.04]


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"dt": 0.0}, "dt"), ({"dt": 1e-9}, "frames"), ({"dt": 0.1, "fps": 3}, "one of them"),
        ({"times": [-1.0]}, ">= 0"), ({"times": "none.txt"}, "cannot read"),
    ],
)  # fmt: skip
def test_frames_refused(given: dict, words: str):
    with pytest.raises(InputError, match=words):
        reference_case("coin", **given)


def test_an_unknown_case_names_the_nearest():
    with pytest.raises(InputError, match=r"did you mean 'turntable'.*Cases: coin, spin"):
        reference_case("turn-table")
    with pytest.raises(InputError, match=r"followed for 1\.5 s"):
        reference_case("incline-at", times=[2.0])

"""Several pucks: what pushes, what is integrated, what is refused, and worlds that are kept."""

from __future__ import annotations

import math
from typing import Any

import pytest
from boards import puck_at
from rarely import few

import puck_tables as pt

J = 0.2 * 9.80665  # of the pucks of boards.py


def mallet(*rows: tuple[float, float, float]) -> pt.Puck:
    return pt.Puck(0.05, path=rows, name="mallet", restitution=0.0)


def test_a_mallet_pushes_until_it_stops():
    """By hand: at t = 0.3 the puck has come to 0.18 m at 1 m/s, and slides on 1/2J."""
    scene = pt.Scene(
        pucks=[mallet((0, -0.2, 0), (0.3, 0.1, 0), (1, 0.1, 0)), puck_at(0, 0, restitution=0.0)]
    )
    run = scene.simulate()
    assert run.last["x"][1] == pytest.approx(0.18 + 0.5 / J, abs=1e-9)
    assert [event.what for event in run.events] == ["impact", "contact", "stick"]


def test_two_equal_pucks_that_stick_slide_as_one():
    one, two = puck_at(0, 0, (1.0, 0.0), restitution=0.0), puck_at(0.2, 0, restitution=0.0)
    run = pt.Scene(pucks=[one, two]).simulate()
    speed = math.sqrt(1.0 - 2 * J * 0.14)
    assert run.last["x"][1] == pytest.approx(0.2 + (speed / 2) ** 2 / (2 * J), abs=1e-9)
    assert run.last["x"][1] - run.last["x"][0] == pytest.approx(0.06, abs=1e-12)


def test_a_heavy_puck_pushes_a_light_one_that_brakes_more():
    """E = 0: they go on together, braked by (M f + m F) g/(M + m)."""
    heavy = puck_at(0, 0, (1.0, 0.0), mass=1.0, friction=0.1, restitution=0.0, height=0.0)
    light = puck_at(0.06, 0, mass=0.25, friction=0.3, restitution=0.0, height=0.0)
    run = pt.Scene(pucks=[heavy, light]).simulate()
    decel = (1.0 * 0.1 + 0.25 * 0.3) / 1.25 * 9.80665
    assert run.end_time == pytest.approx(0.8 / decel, abs=1e-9)
    assert run.last["x"][0] == pytest.approx(0.8**2 / (2 * decel), abs=1e-9)


def test_a_curling_ring_is_integrated():
    ring: dict[str, Any] = {"radius": 0.145, "height": 0.02, "friction": 0.01,
                            "pressure": "annulus:0.8", "gyration": 0.7}  # fmt: skip
    free = pt.Puck(**ring).simulate((2.0, 0.1), 1.5)
    run = pt.Scene(pucks=[pt.Puck(**ring, launch=pt.Launch((2.0, 0.1), 1.5))]).simulate()
    assert run.end_time == pytest.approx(free.stop_time, rel=1e-9)
    assert (run.last["x"][0], run.last["y"][0]) == pytest.approx(free.stop_position, abs=4e-8)


@pytest.mark.thorough
@pytest.mark.parametrize("restitution", few(1, [0.5, 0.0, 1.0]))
def test_a_squeeze_is_refused_by_name(restitution: float):
    way = mallet((0, -0.2, 0), (1, 0.22, 0))  # its rim to 0.27: a puck has no room
    scene = pt.Scene(
        pucks=[way, puck_at(0, 0, restitution=restitution)],
        walls=[pt.Wall((0.3, 0.0), normal=(-1.0, 0.0), restitution=restitution)],
    )
    with pytest.raises(pt.PuckError, match="mallet, which is driven, squeezes"):
        scene.simulate()


@pytest.mark.parametrize(
    ("how", "words"),
    [
        ({"pucks": [puck_at(0, 0), puck_at(0.05, 0)]}, "puck 0 and puck 1 overlap by 0.01 m"),
        ({"pucks": [puck_at(0, 0, name="a"), puck_at(1, 0, name="a")]}, "2 pucks have it"),
        ({"pucks": [puck_at(0, 0)], "floor": pt.Floor(law=[[1, 0.2]])}, "floor.law: speeds"),
        ({"pucks": [puck_at(0, 0)], "walls": [pt.Wall((0, -0.02), normal=(0, 1))]},
         "reaches through it by"),
        ({"pucks": [puck_at(0, 0)], "pockets": [pt.Pocket((0, 0.01), 0.02)]}, "lies in it by"),
        (
            {"pucks": [puck_at(0, 0)], "pockets": [pt.Pocket((0, 1.0), 0.6)],
             "walls": [pt.Wall((-0.5, 0), normal=(1, 0)), pt.Wall((0.5, 0), normal=(-1, 0))]},
            "wider than the board, 1 m between wall[0] and wall[1]",
        ),
        ({"pucks": [pt.Puck(0.03, path=[[0, 0, 0], [0, 1, 0]])]}, "row 2: 0 again: the times"),
        ({"pucks": [pt.Puck(0.03, path=[[1, 0, 0], [2, 1, 0]])]}, "must begin at t = 0"),
        ({"pucks": [puck_at(0, 0)], "launch": pt.Launch((1.0, 0.0))}, "each of several pucks"),
        ({"puck": pt.Puck(0.1), "pucks": [puck_at(0, 0)]}, "give one puck with its launch, or a"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_a_sentence(how: dict[str, Any], words: str):
    with pytest.raises(pt.InputError) as error:
        pt.Scene(**how)
    assert words in str(error.value)


@pytest.mark.parametrize(
    ("who", "how", "words"),
    [
        (7, {}, "no puck 7: there are 2"),
        ("strikr", {}, "no puck 'strikr'"),
        (0, {"velocity": (1.0,)}, "velocity must be two numbers in m/s"),
        (0, {"impulse": (1.0, 0.0), "point": (9.0, 0.0)}, "point must lie on the puck"),
        (0, {"point": (0.0, 0.0)}, "give the impulse, too"),
        (1, {"velocity": (1.0, 0.0)}, "is driven along its path"),
    ],
)
def test_a_strike_that_cannot_be_is_a_sentence(who: Any, how: dict[str, Any], words: str):
    world = pt.Scene(pucks=[puck_at(0, 0), mallet((0, -0.2, 0), (1, -0.2, 0))]).world()
    with pytest.raises(pt.InputError) as error:
        world.strike(who, **how)
    assert words in str(error.value)


def test_a_column_in_place_of_a_puck_is_told_how_it_is_got():
    run = pt.Scene(pucks=[puck_at(0, 0)]).simulate()
    with pytest.raises(pt.InputError, match=r"the column of all of them is \.x"):
        run["x"]


def test_an_impulse_at_the_rim_spins():
    world = pt.Scene(pucks=[puck_at(0, 0)]).world()
    world.strike(0, impulse=(0.1, 0.0), point=(0.0, -0.03))
    vx, vy, spin = world.state()[0, 3:]
    assert (vx, vy) == pytest.approx((1.0, 0.0))
    assert spin == pytest.approx(0.1 * 0.03 / (0.5 * 0.1 * 0.03**2))


def test_a_sweep_is_what_single_runs_are():
    scene = pt.Scene(
        pucks=[puck_at(0, 0, (1.0, 0.0), restitution=0.6, tangential=0.0), puck_at(0.2, 0.01)],
        ranges={"puck[0].launch.velocity[0]": [0.8, 1.2, 2.0], "puck[1].mass": [0.05, 0.2]},
    )
    ends = scene.sweep(threads=2, chunk=2)
    for i, speed in enumerate((0.8, 1.2, 2.0)):
        for k, mass in enumerate((0.05, 0.2)):
            numbers = {"puck[0].launch.velocity[0]": speed, "puck[1].mass": mass}
            run = scene.at(numbers).simulate()
            assert ends.x[i, k] == pytest.approx(run.last["x"], abs=1e-14)
            assert ends.end_time[i, k] == pytest.approx(run.end_time, abs=1e-14)
            assert ends.impacts[i, k] == run.impacts
    assert ends.to_xarray().x.dims == ("puck_0_launch_velocity_0", "puck_1_mass", "puck")


def test_the_plan_says_how_each_puck_is_moved():
    ring = pt.Puck(0.1, friction=0.1, pressure="ring", launch=pt.Launch(position=(0.5, 0.0)))
    scene = pt.Scene(pucks=[puck_at(0, 0), ring])
    assert scene.simulate().explain().splitlines()[:2] == [
        "1 puck looked up from impact to impact (puck 0)",
        "1 puck integrated from impact to impact: no closed forms (puck 1)",
    ]
    slope = pt.Scene(pucks=[puck_at(0, 0, friction=0.0)], floor=pt.Floor(0.1), time=0.1)
    assert slope.simulate().explain().startswith("1 puck integrated from impact to impact: slope\n")


@pytest.mark.parametrize("speed, friction", [(1.0, 1e-14), (1e8, 0.1), (1e160, 0.1)])
def test_pucks_that_would_slide_beyond_all_digits_are_refused(speed: float, friction: float):
    """Places are good to a share of Q²/J: looked up they passed through each other unseen."""
    one = pt.Puck(0.03, friction=friction, launch=pt.Launch((speed, 0.0)))
    two = pt.Puck(0.03, friction=friction, launch=pt.Launch(position=(0.2, 0.001)))
    with pytest.raises(pt.InputError, match=r"use speeds up to|use other units"):
        pt.Scene(pucks=[one, two]).simulate()
    world = pt.Scene(pucks=[pt.Puck(0.03, friction=friction), two]).world()
    with pytest.raises(pt.InputError, match=r"use speeds up to|use other units"):
        world.strike(0, velocity=(speed, 0.0))
    assert not world.moving.any()

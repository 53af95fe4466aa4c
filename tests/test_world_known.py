"""Several pucks where the answer is known by hand, by symmetry or by a law of conservation."""

from __future__ import annotations

import math

import numpy as np
import pytest
from boards import draw, hexagon, puck_at

import puck_tables as pt


def impacts(scene: pt.Scene, until: float = math.inf) -> list:
    world = scene.world()
    return [event for event in world.advance(until) if event.what == "impact"]


def just_after(scene: pt.Scene) -> np.ndarray:
    """States at the first impact."""
    world = scene.world()
    first = impacts(scene, 10.0)[0].time
    world.advance(first)
    return world.state()


def test_equal_smooth_pucks_swap_their_velocities_head_on():
    one, two = puck_at(0.0, 0.0, (1.0, 0.0)), puck_at(0.2, 0.0, (-0.5, 0.0))
    before = pt.Scene(pucks=[one, two]).world()
    scene = pt.Scene(pucks=[one, two])
    time = impacts(scene)[0].time
    after = just_after(scene)[:, 3:]
    slow = 0.2 * 9.80665 * time
    assert before.time == 0.0
    assert after == pytest.approx(np.array([[-0.5 + slow, 0, 0], [1.0 - slow, 0, 0]]), abs=1e-9)


@pytest.mark.parametrize("aside", [0.01, 0.03, 0.055])
def test_equal_smooth_pucks_part_at_a_right_angle(aside: float):
    after = just_after(pt.Scene(pucks=[puck_at(0, 0, (2.0, 0.0)), puck_at(0.3, aside)]))
    assert abs(after[0, 3:5] @ after[1, 3:5]) < 1e-12


def test_a_spinning_puck_against_one_at_rest_by_hand():
    """E = .8, β = 0, μ large: m_n = m/2, m_t = m/6 of equal discs, whose slip is v t + r ω."""
    one = puck_at(0, 0, (1.0, 0.0), 40.0, friction=1e-9, restitution=0.8, tangential=0.0)
    two = puck_at(0.1, 0.0, friction=1e-9, restitution=0.8, tangential=0.0)
    after = just_after(pt.Scene(pucks=[one, two]))
    m, r = 0.1, 0.03
    push, rub = 1.8 * (m / 2) * 1.0, (m / 6) * r * 40.0
    turn = r * rub / (0.5 * m * r * r)
    assert after[0, 3:] == pytest.approx([1.0 - push / m, -rub / m, 40.0 - turn], abs=1e-8)
    assert after[1, 3:] == pytest.approx([push / m, rub / m, -turn], abs=1e-8)


def test_rims_that_slide_take_no_more_than_friction():
    one = puck_at(0, 0, (1.0, 0.0), 400.0, friction=1e-9, tangential=0.5, rim=0.1)
    scene = pt.Scene(pucks=[one, puck_at(0.1, 0.0, friction=1e-9, tangential=0.5)])
    event = impacts(scene, 1.0)[0]
    assert event.rub == pytest.approx(0.1 * event.impulse)
    assert event.lost == pytest.approx(
        event.rub * event.slip - event.rub**2 * 3 / 0.1, rel=1e-12
    )  # μ P |u_t| − P_t²/2m_t, m_t = m/6


def test_a_wall_is_the_mirror_image_of_a_puck():
    launch, spin = (1.0, 0.4), 25.0
    how = {"restitution": 0.7}  # smooth: the rim of an image slides along with it
    wall = pt.Wall((0.2, 0.0), normal=(-1.0, 0.0), restitution=0.7)
    puck, far = puck_at(0, 0, launch, spin, **how), puck_at(-9.0, 9.0)  # a lone one may be refined
    alone = pt.Scene(pucks=[puck, far], walls=[wall]).simulate([0.4, 1.0])
    image = puck_at(0.4, 0.0, (-1.0, 0.4), -spin, **how)
    both = pt.Scene(pucks=[puck, image]).simulate([0.4, 1.0])
    for name in ("x", "y", "orientation", "spin", "vx"):
        assert both[0][name] == pytest.approx(alone[0][name], abs=1e-12), name


@pytest.mark.parametrize("count", [3, 5, 9])
def test_a_row_passes_an_impact_on(count: int):
    row = [puck_at(0.2 + 0.06 * n, 0.0) for n in range(count)]
    after = just_after(pt.Scene(pucks=[puck_at(0.0, 0.0, (1.0, 0.0)), *row]))
    assert after[-1, 3] > 0.5
    assert np.abs(after[:-1, 3:]).max() < 1e-12


def test_a_puck_between_two_is_hit_by_both_at_once():
    scene = pt.Scene(pucks=[
        puck_at(-0.2, 0.0, (1.0, 0.0), restitution=0.5), puck_at(0.0, 0.0, restitution=0.5),
        puck_at(0.2, 0.0, (-1.0, 0.0), restitution=0.5),
    ])  # fmt: skip
    after = just_after(scene)
    assert after[1, 3:] == pytest.approx([0.0, 0.0, 0.0], abs=1e-12)
    assert after[0, 3] == pytest.approx(-after[2, 3], abs=1e-12)
    assert -0.5 < after[0, 3] < 0.0


def test_a_symmetric_break_stays_symmetric():
    rack = [puck_at(x, y, restitution=0.9) for x, y in hexagon(2, 0.06)]
    striker = puck_at(-0.4, 0.0, (3.0, 0.0), restitution=0.9)
    scene = pt.Scene(pucks=[*rack, striker])
    first = impacts(scene)[0].time
    states = scene.world().at(first + 0.05)[:-1]
    mirrored = states * np.array([1.0, -1.0, -1.0, 1.0, -1.0, -1.0])
    gaps = np.abs(states[:, None, :2] - mirrored[None, :, :2]).sum(axis=2)
    other = gaps.argmin(axis=1)
    assert np.abs(states - mirrored[other])[:, [0, 1, 3, 4]].max() < 1e-11


@pytest.mark.parametrize("seed", range(6))
def test_the_numbering_of_pucks_and_walls_changes_no_bit(seed: int):
    scene = draw(seed, 8)
    turn = np.random.default_rng(seed).permutation(8)
    other = pt.Scene(pucks=[scene.pucks[n] for n in turn], walls=scene.walls[::-1])
    one, two = scene.simulate(), other.simulate()
    assert one.end_time == two.end_time
    assert np.array_equal(one.x[:, turn], two.x)
    assert np.array_equal(one.spin[:, turn], two.spin)


@pytest.mark.parametrize("scale", [0.5, 2.0, 8.0])
def test_faster_is_the_same_on_a_larger_board(scale: float):
    """On a level floor velocities × λ and places × λ² give the same picture, times × λ."""
    slow = [puck_at(0, 0, (1.0, 0.1), 30.0, height=0.0), puck_at(0.15, 0.02, height=0.0)]
    wide = scale**2
    fast = [
        puck_at(
            wide * p.launch.position[0], wide * p.launch.position[1],
            None if p.launch.velocity is None else tuple(scale * v for v in p.launch.velocity),
            p.launch.spin / scale, radius=wide * p.radius, height=0.0,
        )
        for p in slow
    ]  # fmt: skip
    one, two = (pt.Scene(pucks=pucks).simulate() for pucks in (slow, fast))
    assert two.end_time == pytest.approx(scale * one.end_time, rel=1e-12)
    assert two.last["x"] == pytest.approx(wide * one.last["x"], rel=1e-11)
    assert two.last["orientation"] == pytest.approx(one.last["orientation"], rel=1e-10, abs=1e-12)


def test_the_height_of_the_pucks_enters_only_by_delta():
    tall = [puck_at(0, 0, (1.0, 0.0), 30.0, height=0.03, friction=0.2), puck_at(0.15, 0.0)]
    flat = [puck_at(0, 0, (1.0, 0.0), 30.0, height=0.0, friction=0.2), puck_at(0.15, 0.0)]
    ends = [pt.Scene(pucks=pucks).simulate().last["y"][0] for pucks in (tall, flat)]
    assert abs(ends[1]) < 1e-12 < 1e-4 < abs(ends[0])


def test_a_post_stands():
    scene = pt.Scene(
        pucks=[puck_at(0, 0, (1.0, 0.0), restitution=0.5)],
        posts=[pt.Post((0.2, 0.0), 0.01, restitution=0.5)],
    )
    event = impacts(scene)[0]
    assert event.partner == "post 0"
    assert event.x == pytest.approx(0.19)
    speed = math.sqrt(1.0 - 2 * 0.2 * 9.80665 * 0.16)
    assert event.approach == pytest.approx(speed, rel=1e-9)
    assert just_after(scene)[0, 3] == pytest.approx(-0.5 * speed, rel=1e-9)


def test_an_arc_is_a_cushion_from_inside():
    whole = pt.Arc((0.0, 0.0), 0.3, restitution=1.0)
    scene = pt.Scene(pucks=[puck_at(0.1, 0.05, (3.0, 1.0), friction=0.05)], arcs=[whole])
    run = scene.simulate()
    assert run.impacts > 5
    assert np.hypot(run.x, run.y).max() <= 0.27 * (1 + 1e-12)
    half = pt.Arc((0.0, 0.0), 0.3, start=math.pi / 2, span=math.pi)
    out = pt.Scene(pucks=[puck_at(0.1, 0.0, (1.5, 0.0), friction=0.05)], arcs=[half]).simulate()
    assert out.impacts == 0
    assert out.last["x"][0] > 0.4
    back = pt.Scene(pucks=[puck_at(0.1, 0.0, (-1.5, 0.0), friction=0.05)], arcs=[half]).simulate()
    assert back.impacts == 1


def test_a_pocket_takes_the_puck_whose_centre_passes_its_rim():
    scene = pt.Scene(
        pucks=[puck_at(0, 0, (1.0, 0.0)), puck_at(0.0, 0.2, (1.0, 0.0))],
        pockets=[pt.Pocket((0.2, 0.0), 0.03)],
    )
    run = scene.simulate()
    event = run.events[0]
    assert (event.what, event.puck, event.partner) == ("pocket", "puck 0", "pocket 0")
    assert event.x == pytest.approx(0.17, abs=1e-12)
    assert run.last["in_play"].tolist() == [0.0, 1.0]
    assert run.last["x"][0] == pytest.approx(0.17, abs=1e-12)
    assert (run[0]["in_play"] == (run.time < event.time)).all()


def test_over_the_edge():
    scene = pt.Scene(
        pucks=[puck_at(0, 0, (1.0, 0.0), height=0.0)],
        edges=[pt.Edge((0.1, 0.0), normal=(-1.0, 0.0))],
    )
    run = scene.simulate()
    assert [event.what for event in run.events] == ["overhang", "edge"]
    assert run.events[0].x == pytest.approx(0.1 - scene.pucks[0].radius, abs=1e-12)
    assert run.last["in_play"].tolist() == [0.0]
    assert run.energy_residual < 1e-12


def test_a_driven_disc_hits_and_is_not_moved():
    way = [[0.0, -0.2, 0.0], [1.0, 0.8, 0.0], [2.0, 0.8, 0.0]]
    mallet = pt.Puck(0.05, path=way, name="mallet")
    run = pt.Scene(pucks=[mallet, puck_at(0.2, 0.0)]).simulate()
    event = run.events[0]
    assert event.time == pytest.approx(0.32, abs=1e-12)
    assert event.approach == pytest.approx(1.0, abs=1e-12)
    assert run["mallet"]["x"][-1] == pytest.approx(0.8)
    assert run.last["work_driven"] == pytest.approx(2 * 0.1 * 1.0 * 1.0, rel=0.5)
    assert run.energy_residual < 1e-12


def test_air_hockey_without_dry_friction_is_in_closed_form():
    drag = pt.Drag(sliding=0.006, quadratic=0.002, spinning=1e-6)
    one = puck_at(0, 0, (2.0, 1.0), 30.0, friction=0.0, mass=0.03)
    run = pt.Scene(pucks=[one], drag=drag, time=3.0).simulate([0.0, 1.0, 3.0])
    assert run.end == "time is up"
    rate, wake, speed = 0.2, 0.002 / 0.03, math.hypot(2.0, 1.0)
    grown = (1 - np.exp(-rate * run.time)) / rate
    assert np.hypot(run.x, run.y)[:, 0] == pytest.approx(np.log1p(wake * speed * grown) / wake)
    assert run.speed[:, 0] == pytest.approx(
        speed * np.exp(-rate * run.time) / (1 + wake * speed * grown)
    )
    inertia = 0.5 * 0.03 * 0.03**2
    assert run.spin[:, 0] == pytest.approx(30.0 * np.exp(-1e-6 / inertia * run.time))


def test_a_later_launch_is_like_one_with_the_clock_set_back():
    late = pt.Puck(0.03, friction=0.2, launch=pt.Launch((1.0, 0.0), 5.0, time=0.75))
    soon = pt.Puck(0.03, friction=0.2, launch=pt.Launch((1.0, 0.0), 5.0))
    one, two = (pt.Scene(pucks=[p]).simulate() for p in (late, soon))
    assert one.end_time == pytest.approx(two.end_time + 0.75, abs=1e-12)
    assert one.last["x"] == pytest.approx(two.last["x"], abs=1e-12)
    assert one.events[0].what == "launch"
    assert one.energy_residual < 1e-12


def test_every_impact_keeps_momentum_and_loses_what_it_says():
    scene = draw(3, 6, walls=False)
    world, masses = scene.world(), np.array([p.mass for p in scene.pucks])
    turns = np.array([0.5 * p.mass * p.radius**2 for p in scene.pucks])
    for event in impacts(scene):
        before = world.at(event.time - 1e-9)
        world.advance(event.time - world.time)
        after = world.state()

        def told(s: np.ndarray) -> np.ndarray:
            spin = turns @ s[:, 5] + masses @ (s[:, 0] * s[:, 4] - s[:, 1] * s[:, 3])
            energy = 0.5 * (masses @ (s[:, 3] ** 2 + s[:, 4] ** 2) + turns @ s[:, 5] ** 2)
            return np.array([masses @ s[:, 3], masses @ s[:, 4], spin, energy])

        change = told(after) - told(before)
        assert np.abs(change[:3]).max() < 1e-8  # in 1e-9 s friction takes some
        assert change[3] == pytest.approx(-event.lost, abs=1e-8)
        assert event.lost >= 0.0

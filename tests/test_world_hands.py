"""Worlds into which a hand reaches: pucks placed, taken, added, led, pushed, put into states."""

from __future__ import annotations

import math
import pickle
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from boards import cushions, draw, puck_at

import puck_tables as pt
from puck_tables.scene.run import residual
from puck_tables.world import engine_state as g
from puck_tables.world.ledger import energies_of, energy_scale

G = 9.80665
FRAME = 1.0 / 64.0  # s: times are exact


def mallet(x: float, y: float, **how: Any) -> pt.Puck:
    return pt.Puck(0.05, path=[[0.0, x, y]], name="mallet", **how)


def table() -> pt.Scene:
    """A mallet, three pucks, four walls, a pocket."""
    pucks = [
        mallet(-0.4, 0.0), puck_at(0.0, 0.0), puck_at(0.2, 0.1), puck_at(0.2, -0.1, name="last"),
    ]  # fmt: skip
    return pt.Scene(pucks=pucks, walls=cushions(), pockets=[pt.Pocket((0.55, 0.55), 0.03)])


def bits(world: pt.World) -> list[bytes]:
    """All that a world knows."""
    engine, counts = world._engine, world._engine.counts
    rows = {
        "events": g.N_EVENTS, "history": g.N_HISTORY, "work_rows": g.N_WORK_ROWS,
        "pieces": g.N_PIECES,
    }  # fmt: skip
    names = ("clock", "discs", "kinds", "segments", "group", "next_time", "next_partner", "counts",
             "drives", "hangs", "scale", "forcing", "spans", "launches")  # fmt: skip
    parts = [getattr(engine, name) for name in names]
    parts += [getattr(engine, name)[: counts[count]] for name, count in rows.items()]
    return [np.ascontiguousarray(part).tobytes() for part in parts] + [repr(world.names).encode()]


def missed(world: pt.World) -> float:
    """What the ledger misses, as a share."""
    moments = np.linspace(0.0, world.time, 7)
    return residual(energies_of(world, moments, world.over(moments)), energy_scale(world._engine))


def in_state(scene: pt.Scene, states: np.ndarray) -> pt.World:
    """A world built anew; what is led is driven on as it moves."""
    pucks = []
    for old, (x, y, angle, vx, vy, spin) in zip(scene.pucks, states.tolist(), strict=True):
        more: Any = {"launch": pt.Launch((vx, vy), spin, (x, y), angle)}
        if old.path:
            more = {"path": [[0.0, x, y, angle]]}
        own = ("radius", "height", "friction", "mass", "restitution", "tangential", "rim", "name")
        pucks.append(pt.Puck(**{name: getattr(old, name) for name in own}, **more))
    world = pt.Scene(pucks=pucks, walls=scene.walls, pockets=scene.pockets).world()
    for n, old in enumerate(scene.pucks):
        if old.path:
            world.drive(n, states[n, 3:5], states[n, 5])
    return world


def drawn_states(rng: np.random.Generator, scene: pt.Scene) -> np.ndarray:
    """Free places on the table, and velocities."""
    while True:
        places = rng.uniform(-0.5, 0.5, (len(scene.pucks), 2))
        gaps = np.hypot(*(places[:, None] - places[None]).transpose(2, 0, 1)) + np.eye(len(places))
        if gaps.min() > 0.11 and np.hypot(*(places - 0.55).T).min() > 0.05:
            break
    rest = np.column_stack([rng.uniform(-3, 3, len(places)), rng.normal(size=(len(places), 2)),
                            20.0 * rng.normal(size=len(places))])  # fmt: skip
    return np.hstack([places, rest])


def meddle(rng: np.random.Generator, world: pt.World, forces: bool = True) -> None:
    """A call drawn; one that is refused changes nothing."""
    who, v = int(rng.integers(1, len(world.names))), rng.normal(size=2)
    calls: list[Callable[[], Any]] = [
        lambda: world.place(who, rng.uniform(-0.5, 0.5, 2), velocity=v),
        lambda: world.place(who, angle=1.0, spin=float(10.0 * v[0])),
        lambda: world.strike(who, v, 5.0), lambda: world.drive(0, v),
        lambda: world.drive(0, towards=rng.uniform(-0.5, 0.5, 2), speed=0.7),
        lambda: world.remove(who), lambda: world.advance(float(rng.uniform(0.0, 0.1))),
    ]  # fmt: skip
    if forces:
        calls.append(lambda: world.apply_force(who, 0.3 * v, 1e-3, duration=0.05))
    before = bits(world)
    try:
        calls[int(rng.integers(len(calls)))]()
    except pt.PuckError:
        assert bits(world) == before


@pytest.mark.parametrize("seed", range(3))
def test_whatever_was_done_before_a_state_is_a_state(seed: int):
    rng, scene = np.random.default_rng([seed, 72]), table()
    world = scene.world()
    for _ in range(12):
        meddle(rng, world, forces=False)
    states = drawn_states(rng, scene)
    world.set_state(states)
    anew = in_state(scene, states)
    assert np.array_equal(world.state(), anew.state())
    start = world.time
    for until in (0.02, 0.05, 0.1):
        world.advance(start + until - world.time)
        anew.advance(until - anew.time)
        assert world.state() == pytest.approx(anew.state(), abs=1e-11)
    assert missed(world) < 1e-9


@pytest.mark.parametrize("seed", range(3))
def test_hands_at_the_start_are_another_scene_to_the_bit(seed: int):
    rng, scene = np.random.default_rng([seed, 73]), table()
    states = drawn_states(rng, scene)
    world = scene.world()
    for n in rng.permutation(4).tolist():  # out of the way first, then one by one
        world.remove(n)
    for n in rng.permutation(4).tolist():
        x, y, angle, vx, vy, spin = states[n]
        world.place(n, (x, y), angle)
        if n:
            world.strike(n, (vx, vy), spin)
        else:
            world.drive(n, (vx, vy), spin)
    anew = in_state(scene, states)
    world.advance(0.3)
    anew.advance(0.3)
    assert np.array_equal(world.state(), anew.state())


@pytest.mark.parametrize("seed", range(2))
def test_added_pucks_are_as_if_they_had_been_there(seed: int):
    scene = draw(seed, 6)
    world = pt.Scene(pucks=scene.pucks[:4], walls=scene.walls).world()
    assert [world.add(one) for one in scene.pucks[4:]] == [4, 5]
    whole = scene.world()
    assert np.array_equal(world.state(), whole.state())
    world.advance(0.5)
    whole.advance(0.5)
    assert np.array_equal(world.state(), whole.state())
    assert [one.what for one in world.events_since(0.0)][:2] == ["added", "added"]
    assert missed(world) < 1e-9


def test_a_puck_that_is_added_later_was_not_there():
    board = pt.Scene(pucks=[puck_at(0.0, 0.0, (1.0, 0.0))], walls=cushions())
    world = board.world()
    world.advance(0.25)
    before = world.over([0.0, 0.1, 0.25])
    late = puck_at(
        0.4, 0.3, (-0.5, 0.0), name="late", force=pt.Force(over_time=[[0, 1, 0], [1, 1, 0]])
    )
    assert world.add(late) == 1
    assert np.array_equal(world.over([0.0, 0.1, 0.25])[:, :1], before)
    assert world.at(0.1)[1].tolist() == [0.4, 0.3, 0.0, 0.0, 0.0, 0.0]
    assert world.state()[1].tolist() == [0.4, 0.3, 0.0, -0.5, 0.0, 0.0]
    soon = pt.Scene(
        pucks=[puck_at(0.4, 0.3, (-0.5, 0.0), force=late.force)], walls=cushions()
    ).world()
    world.advance(0.3)
    assert world.state()[1] == pytest.approx(soon.at(0.3)[0], abs=1e-12)
    with pytest.raises(pt.InputError, match="there is one of that name"):
        world.add(late)
    one = pt.Scene(pt.Puck(0.03, friction=0.2)).world()  # a scene of one puck gets a second one
    assert one.add(puck_at(0.3, 0.0, (-1.0, 0.0))) == 1
    assert "impact" in [event.what for event in one.advance(1.0)]


def test_a_base_may_be_added_among_discs():
    """Friction of discs alone is looked up: no map of the floor lies under them."""
    world, box = pt.Scene(pucks=[puck_at(0.0, 0.0, (1.0, 0.0))]).world(), pt.Base.box(0.03, 0.02)
    world.advance(0.125)
    late = pt.Puck(0.05, base=box, friction=0.2, launch=pt.Launch((1.0, 0.3), 9.0, (0.5, 0.5)))
    before = world.copy()
    assert world.add(late) == 1
    world.advance(0.25)
    assert world.state()[0] == pytest.approx(before.at(0.375)[0], abs=1e-9)
    assert world.state()[1] == pytest.approx(pt.Scene(pucks=[late]).world().at(0.25)[0], abs=1e-9)


@pytest.mark.parametrize("friction", [0.1, pt.Orthotropic((0.1, 0.2))])
def test_a_mallet_alone_is_a_board(friction: Any):
    floor = pt.Floor(patches=[pt.Patch(friction, radius=0.1)])
    scene = pt.Scene(pucks=[mallet(-0.4, 0.0)], floor=floor)
    assert scene.simulate().end == "at rest"
    world = scene.world()
    world.drive("mallet", (1.0, 0.0))
    world.add(puck_at(0.0, 0.0))
    assert world.advance(0.5)[0].what == "impact"


def test_a_frame_more_or_less_changes_nothing():
    scene = table()
    worlds = [scene.world(), scene.world()]
    for world in worlds:
        world.drive("mallet", (1.5, 0.1))
        world.strike("last", (0.3, 1.0), 10.0)
    whole = worlds[0].advance(0.5)
    parts = [event for _ in range(250) for event in worlds[1].advance(0.002)]
    assert whole == parts and len(whole) > 2
    assert worlds[1].state() == pytest.approx(worlds[0].state(), abs=1e-12)


def test_a_mallet_led_frame_by_frame_is_one_with_a_path():
    times = np.arange(41) * FRAME
    places = np.column_stack([-0.4 + 1.2 * times, 0.1 * np.sin(9.0 * times)])
    scene = table()
    rows = np.column_stack([times, places]).tolist()
    given = pt.Puck(0.05, path=rows, name="mallet")
    path = pt.Scene(pucks=[given, *scene.pucks[1:]], walls=scene.walls, pockets=scene.pockets)
    truth, world = path.world(), scene.world()
    for n in range(40):
        world.drive("mallet", (places[n + 1] - world.state()[0, :2]) / FRAME)
        assert [e.what for e in world.advance(FRAME)] == [e.what for e in truth.advance(FRAME)]
    world.drive("mallet", (0.0, 0.0))
    assert len(truth.events_since(0.0)) > 2
    assert world.state() == pytest.approx(truth.state(), abs=1e-11)
    assert missed(world) < 1e-9


def test_a_mallet_stops_where_it_was_to_go_and_at_cushions():
    world = table().world()
    world.drive(0, towards=(-0.3, 0.2), speed=0.5)
    world.advance(5.0)
    assert world.state()[0, :5] == pytest.approx([-0.3, 0.2, 0.0, 0.0, 0.0])
    assert world.stop_times[0] == pytest.approx(math.hypot(0.1, 0.2) / 0.5)
    world.drive(0, (-1.0, 0.0), 3.0)
    world.advance(1.0)
    assert world.state()[0, 0] == pytest.approx(-0.55, abs=1e-9)
    world.drive(0, (-1.0, 0.0))  # on into the wall: it stays
    world.advance(1.0)
    assert world.state()[0, 0] == pytest.approx(-0.55, abs=1e-9)
    world.drive(0, (0.0, 1.0))  # along it
    world.advance(0.1)
    assert world.state()[0, 1] == pytest.approx(0.3)
    posts = pt.Scene(pucks=[mallet(0.0, 0.0)], posts=[pt.Post((0.3, 0.03), 0.04)],
                     arcs=[pt.Arc((0.0, 0.0), 0.5)]).world()  # fmt: skip
    posts.drive(0, (1.0, 0.0))
    posts.advance(2.0)
    assert math.dist(posts.state()[0, :2], (0.3, 0.03)) == pytest.approx(0.09, abs=1e-9)
    posts.drive(0, (-1.0, 0.5))
    posts.advance(2.0)
    assert math.hypot(*posts.state()[0, :2]) == pytest.approx(0.45, abs=1e-9)


def test_a_mallet_that_touches_its_wall_from_the_start_goes_along_it():
    world = pt.Scene(pucks=[mallet(-0.55, 0.0), puck_at(0, 0)], walls=cushions()).world()
    world.drive(0, (0.0, 1.0))
    world.advance(0.2)
    assert world.state()[0, :2] == pytest.approx([-0.55, 0.2], abs=1e-12)


def test_a_mallet_that_goes_on_has_no_end():
    world = pt.Scene(pucks=[mallet(0.0, 0.0), puck_at(1.0, 0.0)]).world()
    world.drive(0, (-1.0, 0.0))
    assert world.stop_times.tolist() == [math.inf, 0.0]
    before = bits(world)
    with pytest.raises(pt.InputError, match="it may never stop"):
        world.advance(math.inf)
    assert bits(world) == before
    world.drive(0, (0.0, 0.0))
    assert not world.moving.any()


def test_what_pushes_back_is_told():
    """E = 0: m v at the impact, then f m g for as long as it is pushed."""
    world = pt.Scene(pucks=[mallet(-0.2, 0.0), puck_at(0.0, 0.0, restitution=0.0)]).world()
    world.drive(0, (0.5, 0.0))
    assert world.reaction(0).tolist() == [0.0, 0.0]
    world.advance(0.24)  # it is there
    world.advance(0.06)
    first = world.reaction(0)
    assert first == pytest.approx([-0.1 * 0.5 - 0.06 * 0.2 * 0.1 * G, 0.0], abs=1e-9)
    parts = []
    for _ in range(30):
        world.drive(0, (0.5, 0.0))
        world.advance(0.01)
        parts.append(world.copy().reaction(0))
        assert np.array_equal(world.reaction("mallet"), parts[-1])
    assert np.array(parts)[:, 0] == pytest.approx(-0.01 * 0.2 * 0.1 * G, abs=1e-9)
    world.drive(0, (0.0, 0.0))
    world.advance(1.0)
    assert world.reaction(0) == pytest.approx([0.0, 0.0], abs=1e-12)
    with pytest.raises(pt.InputError, match="puck 1 is not led by hand"):
        world.reaction(1)


@pytest.mark.parametrize("aside", [0.0, 0.02])
def test_what_a_mallet_gave_is_what_its_puck_has(aside: float):
    """Without friction of the floor momentum goes from one to the other alone."""
    how = {"restitution": 0.0, "tangential": 0.0, "rim": 0.2, "friction": 0.0}
    world = pt.Scene(pucks=[mallet(-0.2, 0.0, rim=0.2, tangential=0.0), puck_at(0, aside, **how)],
                     drag=pt.Drag(sliding=0.05), time=1.0).world()  # fmt: skip
    total = np.zeros(2)
    for n in range(60):
        world.drive(0, (0.6 + 0.4 * math.sin(0.2 * n), 0.05 * math.cos(0.1 * n)), 2.0)
        world.advance(FRAME)
        total += world.reaction(0)
    gone = 0.05 * (world.state()[1, :2] - [0.0, aside])  # drag is the way times its strength
    assert -total == pytest.approx(0.1 * world.state()[1, 3:5] + gone, abs=1e-8)
    assert world.groups > 0
    assert missed(world) < 1e-8


def test_a_push_over_a_time_is_that_of_a_scene():
    force, torque = (0.5, -0.2), 2e-3
    rows = [[0.0, *force, torque], [0.2, *force, torque]]
    launch = {"velocity": (0.4, 0.3), "spin": 9.0}
    alone = puck_at(0.0, 0.0, **launch, force=pt.Force(over_time=rows))
    truth = pt.Scene(pucks=[alone, puck_at(0.3, 0.1)], walls=cushions()).world()
    world = pt.Scene(
        pucks=[puck_at(0.0, 0.0, **launch), puck_at(0.3, 0.1)], walls=cushions()
    ).world()
    world.apply_force(0, force, torque, duration=0.2)
    truth.advance(0.4)
    world.advance(0.4)
    assert world.state() == pytest.approx(truth.state(), abs=1e-11)
    assert missed(world) < 1e-9
    assert len([e for e in world.events_since(0.0) if e.what == "force"]) == 1


def test_a_push_on_a_tray_that_turns_and_gets_wet_is_that_of_a_scene():
    tray = pt.Floor(
        over_time=[[0.0, 0.1, 0.0, 3.0], [0.3, 0.4, 0.2, 5.0]],
        grips=[pt.Grip([[0.1, 1.0], [0.3, 0.6]])], orthotropic=pt.Orthotropic((0.1, 0.3), 0.4),
    )  # fmt: skip
    launch = {"velocity": (0.4, 0.3), "spin": 9.0}
    rows = [[0.1, 0.05, -0.02, 1e-4], [0.35, 0.05, -0.02, 1e-4]]
    pushed = puck_at(0.0, 0.0, **launch, force=pt.Force(over_time=rows))
    truth = pt.Scene(pucks=[pushed], floor=tray, time=1.0, tol=1e-10).world()
    world = pt.Scene(pucks=[puck_at(0.0, 0.0, **launch)], floor=tray, time=1.0, tol=1e-10).world()
    world.advance(0.1)
    world.apply_force(0, (0.05, -0.02), 1e-4, duration=0.25)
    truth.advance(0.5)
    world.advance(0.4)
    assert world.state() == pytest.approx(truth.state(), abs=1e-9)
    assert missed(world) < 1e-9


def test_pushes_add_up_in_closed_form():
    """Two that overlap, of one that nothing brakes."""
    world = pt.Scene(pucks=[puck_at(0, 0, mass=1.0, friction=0.0)], time=1.0).world()
    world.advance(0.1)
    world.apply_force(0, (1.0, 0.0), duration=0.4)
    world.advance(0.2)
    world.apply_force(0, (2.0, 1.0), duration=0.3)
    world.advance(1.0)
    assert world.state()[0, 3:5] == pytest.approx([0.4 + 0.6, 0.3], abs=1e-12)
    x = 0.5 * 0.4**2 + 0.4 * 0.8 + 0.5 * 2.0 * 0.3**2 + 0.6 * 0.7
    assert world.state()[0, 0] == pytest.approx(x, abs=1e-12)
    assert missed(world) < 1e-9


def test_a_push_too_weak_leaves_it_lying_and_one_in_a_row_moves_all():
    pucks = [puck_at(0.06 * n, 0.0, restitution=0.0) for n in range(3)]
    world = pt.Scene(pucks=pucks).world()
    weight = 0.2 * 0.1 * G
    world.apply_force(0, (2.9 * weight, 0.0), duration=0.2)
    world.advance(0.3)
    assert world.state()[:, 0] == pytest.approx([0.0, 0.06, 0.12], abs=1e-15)
    world.apply_force(0, (4.0 * weight, 0.0), duration=0.2)
    world.advance(0.2)
    assert world.state()[:, 3] == pytest.approx([0.2 * weight / 0.3] * 3, abs=1e-9)
    assert missed(world) < 1e-8


@pytest.mark.parametrize("before", [0.02, 0.12])
def test_nobody_meets_a_puck_that_is_taken_away(before: float):
    """On its way to it, or as it pushes it."""
    pucks = [puck_at(0.0, 0.0, (1.0, 0.0), restitution=0.0),
             puck_at(0.11, 0.0, restitution=0.0, friction=0.4)]  # fmt: skip
    world = pt.Scene(pucks=pucks).world()
    world.advance(before)
    x, speed = world.state()[0, [0, 3]]
    world.remove(1)
    assert world.advance(math.inf) == [] and world.in_play.tolist() == [True, False]
    assert world.state()[0, 0] == pytest.approx(x + speed**2 / (2 * 0.2 * G), abs=1e-9)


def test_what_leant_on_a_puck_that_is_taken_away_slides_on():
    wall = pt.Wall((0.5, 0.0), normal=(-1.0, 0.0), restitution=0.5)
    pucks = [puck_at(x, 0.0, friction=0.15, restitution=0.5, height=0.0) for x in (0.0, 0.2)]
    world = pt.Scene(pucks=pucks, floor=pt.Floor(slope=0.3), walls=[wall]).world()
    world.advance(math.inf)
    assert world.state()[:, 0] == pytest.approx([0.41, 0.47], abs=1e-9)
    world.remove(1)
    assert world.moving.tolist() == [True, False]
    world.advance(math.inf)
    assert world.state()[0, 0] == pytest.approx(0.47, abs=1e-9)
    assert missed(world) < 1e-9


def test_back_from_a_pocket():
    pockets = [pt.Pocket((0.2, 0.0), 0.03)]
    world = pt.Scene(pucks=[puck_at(0, 0, (2.0, 0.0))], pockets=pockets).world()
    world.advance(1.0)
    assert not world.in_play[0]
    with pytest.raises(pt.InputError, match="puck 0 is not in play: give the position"):
        world.place(0, velocity=(1.0, 0.0))
    with pytest.raises(pt.InputError, match=r"puck 0 would lie in pocket 0 by 0\.02 m"):
        world.place(0, (0.19, 0.0))
    world.place(0, (-0.1, 0.0), velocity=(0.5, 0.0))
    assert world.in_play[0]
    fell, back = world.events_since(0.0)[-2:]
    assert (fell.what, back.what, back.puck, back.x) == ("pocket", "placed", "puck 0", -0.1)
    world.advance(math.inf)
    assert world.state()[0, 0] == pytest.approx(-0.1 + 0.25 / (2 * 0.2 * G), abs=1e-9)
    assert world.at(0.01)[0, 3] == pytest.approx(2.0 - 0.01 * 0.2 * G, abs=1e-9)
    assert missed(world) < 1e-9


def test_a_puck_put_over_a_border_and_an_edge_knows_it():
    floor = pt.Floor(strips=pt.Strips((0.2,), (0.1, 0.4)))
    edge = pt.Edge((0.6, 0.0), normal=(-1.0, 0.0))
    world = pt.Scene(pucks=[puck_at(0, 0)], floor=floor, edges=[edge]).world()
    world.place(0, (0.4, 0.0), velocity=(-0.5, 0.0))
    truth = pt.Scene(pucks=[puck_at(0.4, 0.0, (-0.5, 0.0))], floor=floor, edges=[edge]).world()
    world.advance(1.0)
    truth.advance(1.0)
    assert world.state() == pytest.approx(truth.state(), abs=1e-12)
    world.place(0, (0.58, 0.0), velocity=(0.0, 0.0), spin=0.0)
    assert world.events_since(0.0)[-1].what == "overhang"


def test_lines_are_passed_by_motion_and_by_no_hand():
    goal = pt.Line((0.3, -1.0), (0.3, 1.0), name="goal")
    world = pt.Scene(pucks=[puck_at(0, 0, friction=0.05)], lines=[goal]).world()
    world.place(0, (0.4, 0.0))
    world.place(0, (0.1, 0.0), velocity=(1.0, 0.0))
    assert world.add(puck_at(0.6, 0.2, (-1.0, 0.0), friction=0.05)) == 1
    told = [(e.what, e.puck) for e in world.advance(1.0) if e.partner == "goal"]
    for who in ("puck 0", "puck 1"):
        assert [what for what, one in told if one == who] == ["entry", "line", "exit"]
    assert [e.what for e in world.events_since(0.0)][:3] == ["placed", "placed", "added"]


REFUSED: list[tuple[Callable[[pt.World], Any], str]] = [
    (lambda w: w.place(1, (0.21, 0.1)), r"puck 1 would overlap puck 2 by 0\.05 m"),
    (lambda w: w.place(2, (0.59, 0.0)), r"puck 2 would reach through wall 1 by 0\.02 m"),
    (lambda w: w.place(2, (0.54, 0.54)), "puck 2 would lie in pocket 0 by 0.0159 m"),
    (lambda w: w.place(0, (0.0, 0.0)), r"mallet would overlap puck 1 by 0\.0359 m"),
    (lambda w: w.place("lst", (0.0, 0.0)), "did you mean 'last'"),
    (lambda w: w.place(1, (0.0, math.nan)), "position"),
    (lambda w: w.place(1, velocity=(1e200, 0.0)), "use other units"),
    (lambda w: w.set_state(np.zeros((4, 6))), "would overlap"),
    (lambda w: w.set_state(np.zeros((3, 6))), "rows of 6 numbers for 4 pucks"),
    (lambda w: w.add(puck_at(0.0, 0.01)), r"puck 4 would overlap puck 1 by 0\.0186 m"),
    (lambda w: w.add(puck_at(0.6, 0.0)), "reaches through it"),
    (lambda w: w.add(puck_at(0.5, 0.0, gravity=1.6)), "the pucks of this world have 9.8"),
    (lambda w: w.add("puck"), "puck must be a Puck, got a str"),
    (lambda w: w.drive(1, (1.0, 0.0)), "is not led by hand: give it a path of one row"),
    (lambda w: w.drive(0), "give a velocity, or towards"),
    (lambda w: w.drive(0, (1.0, 0.0), speed=1.0), "give a velocity, or towards"),
    (lambda w: w.drive(0, towards=(1.0, 0.0), speed=-1.0), "speed"),
    (lambda w: w.drive(0, (1e200, 0.0)), "use other units"),
    (lambda w: w.apply_force(0, (1.0, 0.0), duration=1.0), "mallet is driven: no force moves it"),
    (lambda w: w.apply_force(1, (1.0, 0.0), duration=0.0), "duration"),
    (lambda w: w.strike(0, (1.0, 0.0)), "is driven along its path: drive leads it"),
    (lambda w: w.strike(1, velocity=(1e200, 0.0)), "use other units"),
    (lambda w: w.advance(-1.0), "duration must not be negative"),
]


@pytest.mark.parametrize(("call", "words"), REFUSED)
def test_what_is_refused_changes_no_bit(call: Callable[[pt.World], Any], words: str):
    world = table().world()
    world.strike(1, (0.5, 0.2), 3.0)
    world.drive(0, (0.3, 0.0))
    world.advance(0.1)
    before = bits(world)
    with pytest.raises(pt.InputError, match=words):
        call(world)
    assert bits(world) == before


def test_a_puck_on_a_rail_stays_on_it():
    rail = pt.Constraint("rail", angle=0.0)
    world = pt.Scene(pucks=[puck_at(0.0, 0.1, constraint=rail)]).world()
    world.place(0, (0.3, 0.1), velocity=(0.5, 0.0))
    with pytest.raises(pt.InputError, match=r"puck 0 would be 0\.05 m off the rail"):
        world.place(0, (0.3, 0.15))
    world.advance(math.inf)
    assert world.state()[0, :2] == pytest.approx([0.3 + 0.25 / (2 * 0.2 * G), 0.1], abs=1e-9)


@pytest.mark.thorough
@pytest.mark.parametrize("restitution", [0.0, 0.7])
def test_a_squeeze_is_told_and_the_world_is_as_before(restitution: float):
    squeezed = puck_at(0.4, 0.0, restitution=restitution)
    world = pt.Scene(pucks=[mallet(0.0, 0.0), squeezed], walls=cushions()).world()
    world.drive(0, (1.0, 0.0))
    before, state = bits(world), world.state()
    with pytest.raises(pt.PuckError, match="mallet, which is driven, squeezes"):
        for _ in range(100):
            before, state = bits(world), world.state()
            world.advance(FRAME)
    assert bits(world) == before
    assert np.array_equal(world.state(), state)
    world.drive(0, (-1.0, 0.0))
    world.advance(0.3)
    assert world.state()[0, 0] == pytest.approx(state[0, 0] - 0.3, abs=1e-12)
    assert missed(world) < 1e-9


def test_copies_and_pickles_know_what_hands_did():
    rng, world = np.random.default_rng(5), table().world()
    for _ in range(20):
        meddle(rng, world)
    world.add(puck_at(-0.5, -0.5))
    copy, again = world.copy(), pickle.loads(pickle.dumps(world))
    before = bits(world)
    assert bits(copy) == before == bits(again) and len(pickle.dumps(world)) < 1_000_000
    times = np.linspace(0.0, 0.99 * world.time, 5)
    past = world.over(times)
    for one in (copy, again):
        one.drive(0, (0.4, 0.1))
        one.apply_force(4, (0.1, 0.1), duration=0.1)
        one.place(4, (-0.5, 0.5))
        one.advance(0.3)
        assert np.array_equal(one.over(times), past)
    assert bits(world) == before
    assert bits(copy) == bits(again)
    assert np.array_equal(copy.reaction(0), again.reaction(0))


@pytest.mark.parametrize("seed", range(6))
def test_many_hands_keep_the_books(seed: int):
    """States and gaps, too: nobody overlaps, all that is refused changes nothing."""
    rng, scene = np.random.default_rng([seed, 99]), table()
    world = scene.world()
    radii = np.array([one.radius for one in scene.pucks])
    for _ in range(60):
        meddle(rng, world)
        inside = np.flatnonzero(world.in_play)
        places = world.state()[inside, :2]
        gaps = np.hypot(*(places[:, None] - places[None]).transpose(2, 0, 1))
        gaps -= radii[inside][:, None] + radii[inside][None]
        assert (gaps + 9.0 * np.eye(len(inside))).min() > -1e-10
    assert missed(world) < 1e-8

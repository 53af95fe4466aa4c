"""A base over an edge is carried by what is left of it, and tips where its centre is over it.

Truth: closed forms of a box, and a judge that shares no code (:mod:`tests.judges.edge_judge`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from commands import invoke
from judges import edge_judge
from rarely import thorough
from rays_judge import friction_of

from puck_tables import (
    Base,
    Edge,
    Floor,
    Force,
    Grip,
    InputError,
    Launch,
    Orthotropic,
    Patch,
    Puck,
    Scene,
    StribeckLaw,
    Strips,
    Wall,
)
from puck_tables.scene.base_balance import sums_and_pressure
from puck_tables.scene.map_of_floor import floor_map_of
from puck_tables.scene.run import ENDS
from puck_tables.world.floor_forces import friction_at

LONG, WIDE, DECEL = 0.2, 0.1, 0.3 * 9.80665
BOX = Puck(base=Base.box(LONG, WIDE), friction=0.3)
CORNERS = 0.5 * np.array([[-LONG, -WIDE], [LONG, -WIDE], [LONG, WIDE], [-LONG, WIDE]])
FEET = 0.06 * np.array([[math.cos(k * math.pi / 3), math.sin(k * math.pi / 3)] for k in range(6)])
DOME = Puck(0.07, friction=0.3, pressure="hertz")
AHEAD = Edge((0.15, 0.0), normal=(-1.0, 0.0))


def polygon(rng: np.random.Generator) -> np.ndarray:
    """Corners about their centre of mass; some turn back."""
    count = int(rng.integers(3, 8))
    turn = 2.0 * math.pi * (np.arange(count) + rng.uniform(0.0, 0.7, count)) / count
    far = rng.uniform(0.06, 0.1, count)
    return np.column_stack([far * np.cos(turn), far * np.sin(turn)])


def over(rng: np.random.Generator, count: int) -> list[np.ndarray]:
    """Edges near the origin, which is on the floor."""
    turns = rng.uniform(0.0, 2.0 * math.pi) + rng.uniform(0.8, 2.2) * np.arange(count)
    gaps = rng.uniform(0.004, 0.06, count)
    return [np.array([math.cos(a), math.sin(a), -gap]) for a, gap in zip(turns, gaps, strict=True)]


def as_edges(rows: list[np.ndarray]) -> list[Edge]:
    return [Edge((nx * at, ny * at), normal=(nx, ny)) for nx, ny, at in rows]


def stribeck(u: np.ndarray) -> np.ndarray:
    return 0.1 + 0.2 * np.exp(-u / 0.3)


WOOD = edge_judge.Brushed(0.22, 0.3, 0.7)
ICE = edge_judge.Brushed(0.6, 1.0, 0.7, stribeck)
BY_GRIP = {
    None: Floor(), stribeck: Floor(law=StribeckLaw(0.3, 0.1, speed=0.3)),
    WOOD: Floor(orthotropic=Orthotropic((0.22, 0.3), 0.7)),
    ICE: Floor(orthotropic=Orthotropic((0.6, 1.0), 0.7, law=StribeckLaw(0.3, 0.1, speed=0.3))),
}  # fmt: skip


def thrown(seed: int, count: int) -> tuple[np.random.Generator, Base, np.ndarray, list[np.ndarray]]:
    """A polygon over its centre of mass, its corners about that, and edges."""
    rng = np.random.default_rng(seed)
    base = Base.polygon(polygon(rng))
    return rng, base, np.array(base.outlines[0]) - np.array(base.middle), over(rng, count)


@pytest.mark.parametrize("grip", BY_GRIP)
@pytest.mark.parametrize("tall", [0.0, 0.5, 0.95])
@pytest.mark.parametrize(("count", "seeds"), [(1, 3), (2, 3), thorough(1, 40), thorough(2, 40)])
def test_friction_is_that_of_the_judge(count: int, seeds: int, tall: float, grip: Any):
    """``tall``: of the lever from which on it would lift without an edge."""
    tips = 0
    for seed in range(seeds):
        rng, base, about, rows = thrown(seed, count)
        lever = tall * base.highest_lever
        if not base.is_under_centre:
            continue
        puck = Puck(base=base, friction=0.3, mass=2.0, height=lever / 0.15)
        scene = Scene(puck, BY_GRIP[grip], edges=as_edges(rows), launch=Launch((9.0, 0.0)))
        state = np.array([0.0, 0.0, rng.uniform(-3.0, 3.0), *rng.normal(0.0, 0.3, 2), 0.0])
        state[5] = rng.choice([-1.0, 1.0, 10.0]) * rng.uniform(0.3, 2.0)
        state[5] *= rng.choice([0.0, 1.0, 1.0, 1.0])
        told = friction_at(scene, state[None])[0] / (2.0 * 9.80665)
        told, arm = (told / 0.3, lever) if grip is None else (told, lever / 0.3)
        try:
            true = edge_judge.under(about, rows, state, arm, grip)
        except AssertionError:  # no pressure balances
            true = np.full(3, math.nan)
        tips += int(np.isnan(told[0]))
        np.testing.assert_allclose(told[:2], true[:2], atol=1e-8, err_msg=str(seed))
        np.testing.assert_allclose(told[2], true[2], atol=1e-9, err_msg=str(seed))
    assert tips == 0 if tall == 0.0 else tips > 0 or tall < 0.9 or grip is not None or seeds < 40


def test_a_disc_is_a_polygon_of_many_corners():
    turn = np.linspace(0.0, 2.0 * math.pi, 1500, endpoint=False)
    corners = 0.05 * np.column_stack([np.cos(turn), np.sin(turn)])
    for gap in (0.002, 0.03):
        rows = [np.array([0.6, 0.8, -gap])]
        state = np.array([0.0, 0.0, 0.4, 0.1, 0.2, 9.0])
        disc, brushed = Puck(base=Base.disc(0.05), friction=0.3, mass=1.0), Puck(0.05, mass=1.0)
        for grip, puck, unit in ((None, disc, 0.3), (WOOD, brushed, 1.0)):
            scene = Scene(puck, BY_GRIP[grip], Launch((0.1, 0.0)), edges=as_edges(rows))
            told = friction_at(scene, state[None])[0] / (unit * 9.80665)
            true = edge_judge.under(corners, rows, state, 0.0, grip)
            np.testing.assert_allclose(told, true, atol=1e-5)


def follow(run: Any, when: float, true: np.ndarray, seed: int) -> None:
    """A run is where a judge has it at a moment, and its energy never grew."""
    told = run(np.array([when]))
    for name, value in zip(("x", "y", "orientation", "vx", "vy"), true, strict=False):
        assert abs(float(np.ravel(getattr(told, name))[0]) - value) < 2e-6, (seed, name)
    assert abs(float(np.ravel(told.spin)[0]) - true[5]) < 2e-5, seed
    speeds = run(np.linspace(0.0, when, 200))
    energy = 0.5 * (speeds.vx**2 + speeds.vy**2 + (BOX.gyration * speeds.spin) ** 2)
    assert (np.diff(np.ravel(energy)) <= 0.0).all(), seed


def slid(seed: int) -> tuple[list[np.ndarray], np.ndarray, Launch]:
    """Edges, and how a box is thrown at them."""
    rng = np.random.default_rng(seed)
    rows = over(rng, 1 + seed % 2)
    state = np.array([0.0, 0.0, rng.uniform(-3.0, 3.0), *rng.normal(0.0, 0.3, 2), 0.0])
    state[5] = rng.uniform(3.0, 9.0)
    return rows, state, Launch((state[3], state[4]), spin=state[5], orientation=state[2])


@pytest.mark.parametrize(
    ("grip", "seeds"),
    [
        (None, (3,)), thorough(WOOD, (0, 3)), thorough(ICE, (0, 3)), thorough(None, range(6)),
    ],
)  # fmt: skip
def test_motion_is_that_of_the_judge(grip: Any, seeds: Sequence[int]):
    ends = set()
    for seed in seeds:
        rows, state, launch = slid(seed)
        run: Any = Scene(BOX, BY_GRIP[grip], edges=as_edges(rows), launch=launch).simulate()
        numbers = DECEL if grip is None else 9.80665, BOX.gyration, state, 0.0, grip
        follow(run, *edge_judge.slide(CORNERS, rows, *numbers), seed)
        ends.add(run.end)
    assert ends == {"over the edge", *(["at rest"] if len(seeds) > 1 else [])}


@pytest.mark.thorough
@pytest.mark.parametrize("grip", [None, stribeck, WOOD])
def test_motion_of_tall_bodies_is_that_of_the_judge(grip: Any):
    tall = replace(BOX, height=0.08)
    ends = set()
    for seed in (6, 8) if grip is None else (6,):
        rows, state, launch = slid(seed)
        rows = [row - [0.0, 0.0, 0.01] for row in rows]
        run: Any = Scene(tall, BY_GRIP[grip], edges=as_edges(rows), launch=launch).simulate()
        numbers = (DECEL, BOX.gyration, state, 0.012) if grip is None else (
            9.80665, BOX.gyration, state, 0.04, grip
        )  # fmt: skip
        follow(run, *edge_judge.slide(CORNERS, rows, *numbers), seed)
        ends.add(run.end)
    assert ends <= {"at rest", "tipped over"}


def test_a_tall_box_tips_where_its_load_comes_to_the_edge():
    """A strip of 3 d carries it, d from the load to the edge; narrower than 1e-3 it tips."""
    for height in (0.02, 0.05, 0.09):
        lever = 0.15 * height
        box = replace(BOX, height=height)
        run: Any = Scene(box, launch=Launch((1.0, 0.0)), edges=[AHEAD]).simulate()
        left = LONG / 2.0 + lever
        d = 1e-3 * left * WIDE / math.hypot(left, WIDE) / 3.0
        assert run.end == "tipped over"
        assert run.events[-1].what == "tip"
        assert abs(run.last["x"] - (0.15 - lever - d)) < 1e-6
        speed = math.sqrt(1.0 - 2.0 * DECEL * run.last["x"])
        assert abs(run.end_time - (1.0 - speed) / DECEL) < 1e-6
        assert abs(run.last["spin"]) < 1e-7


def test_a_push_tips_a_tall_box_at_rest():
    """It bears a push as long as that times the height of the centre is borne, m g d."""
    box = replace(BOX, height=0.08)
    for push, end in ((0.24, "at rest"), (0.26, "tipped over")):
        force = Force((push * box.gravity, 0.0))
        edges = [Edge((0.01, 0.0), normal=(-1.0, 0.0))]
        run: Any = Scene(box, edges=edges, force=force, time=1.0).simulate()
        assert run.end == end, push


@pytest.mark.parametrize("law", [None, StribeckLaw(0.3, 0.1, speed=0.3)])
def test_no_height_is_flat(law: Any):
    floor = Floor() if law is None else Floor(law=law)
    states = np.array([[0.0, 0.0, 0.4, 0.1, 0.2, 9.0], [0.0, 0.0, 0.1, 0.3, 0.0, 0.0]])
    flat, low = (
        friction_at(Scene(box, floor, Launch((1.0, 0.0)), edges=[AHEAD]), states)
        for box in (BOX, replace(BOX, height=1e-14))
    )
    np.testing.assert_allclose(low, flat, rtol=1e-12, atol=1e-15)


def test_strips_and_patches_are_felt_under_what_is_left():
    """Of a flat body friction is that under each part, of a pressure that knows nothing of it."""
    floors = (
        Floor(strips=Strips((0.01,), (0.2, 0.4))),
        Floor(patches=[Patch(0.4, corners=[[0.01, -1], [1, -1], [1, 1], [0.01, 1]])]),
    )
    for seed in range(12):
        rng, base, about, rows = thrown(seed, 1 + seed % 2)
        if not base.is_under_centre:
            continue
        state = np.array([0.0, 0.0, *rng.normal(0.0, 0.5, 4)])
        left = edge_judge.left_of(about, rows, state)
        law = edge_judge.pressure(left)
        part, true = edge_judge.pressed(left, law), np.zeros(3)
        for side, grip in ((-1.0, 0.2), (1.0, 0.4)):
            cut = edge_judge.beyond(part, np.array([side, 0.0]), side * 0.01)
            if len(cut) > 2:
                true += grip * edge_judge.friction(cut, law, state[3:5], state[5])
        for floor in floors:
            scene = Scene(Puck(base=base, friction=0.2), floor, Launch((1.0, 0.0)),
                          edges=as_edges(rows))  # fmt: skip
            told = friction_at(scene, state[None])[0] / 9.80665
            np.testing.assert_allclose(told, true, atol=1e-8, err_msg=str(seed))


@pytest.mark.parametrize("tall", [0.0, 0.5, 1.1])
def test_belts_are_felt_under_what_is_left(tall: float):
    """Friction is that under each part at its own slip, of the pressure that bears its moment.

    ``tall``: of the lever from which on it would lift without an edge.
    """
    known = 0
    for seed in range(24):
        rng, base, about, rows = thrown(seed, seed % 3)
        if not base.is_under_centre:
            continue
        z = tall * base.highest_lever / 0.4
        strips = Strips((0.01,), (0.2, 0.4), across=(0.5, -0.2), along=(0.0, 0.3))
        puck = Puck(base=base, height=2.0 * z)
        scene = Scene(puck, Floor(strips=strips), Launch((9.0, 0.0)), edges=as_edges(rows))
        state = np.array([0.0, 0.0, *rng.normal(0.0, 0.5, 4)])
        state[5] = rng.choice([-1.0, 1.0]) * rng.uniform(0.3, 2.0)  # slower, the judge cancels
        told = friction_at(scene, state[None])[0] / 9.80665
        if tall > 0.0 and np.isnan(told).any():  # it tips
            continue
        left, stands = edge_judge.left_of(about, rows, state), -z * told[:2]
        a, b, c = edge_judge.pressure(left - stands)
        law, true = np.array([a - stands @ (b, c), b, c]), np.zeros(3)
        for side, grip, belt in ((-1.0, 0.2, (0.5, 0.0)), (1.0, 0.4, (-0.2, 0.3))):
            part = edge_judge.pressed(left, law)
            cut = edge_judge.beyond(part, np.array([side, 0.0]), side * 0.01)
            if len(cut) > 2:
                true += grip * edge_judge.friction(cut, law, state[3:5] - belt, state[5])
        np.testing.assert_allclose(told, true, atol=1e-8, err_msg=str(seed))
        known += 1
    assert known > 8


def test_what_a_belt_carries_over_an_edge_tips_where_its_load_is():
    floor = Floor(strips=Strips((-0.5,), (0.3, 0.3), across=(0.4, 0.2)))
    for height in (0.0, 0.1):  # carried at rest: its load is under its centre
        box = replace(BOX, height=height)
        launch = Launch((0.2, 0.0), position=(-0.2, 0.0))
        run: Any = Scene(
            box, floor, launch, edges=[Edge((0.0, 0.0), normal=(-1.0, 0.0))]
        ).simulate()
        assert run.end in ("over the edge", "tipped over") and abs(run.last["x"]) < 1e-3
        assert abs(run.energy_residual) < 1e-9 and "tips" in str(run)
        assert run.last["work_support"] == run.last["heat_dry"] == 0.0  # one belt, at its velocity


def on_feet(state: np.ndarray, edge: float) -> np.ndarray:
    """Force and torque over f N on six feet of 2 mm; those beyond x = edge carry nothing."""
    feet = [(*foot, 0.002) for foot in FEET if foot[0] < edge]
    return friction_of(
        feet, lambda x, y: np.any([np.hypot(x - a, y - b) < r for a, b, r in feet], axis=0),
        lambda x, y, ex, ey: (ex, ey), state[3:],
    )  # fmt: skip


def test_feet_that_hang_carry_nothing():
    """Friction is that of a quadrature over those on the floor; it tips as two more leave it."""
    body = Puck(base=Base.feet(FEET, 0.002), friction=0.3, mass=1.0)
    edges = [Edge((0.05, 0.0), normal=(-1.0, 0.0))]
    for velocity, spin in (((0.1, 0.2), 9.0), ((0.3, 0.0), 1.0), ((0.0, 0.01), -20.0)):
        scene = Scene(body, launch=Launch((1.0, 0.0)), edges=edges)
        state = np.array([0.0, 0.0, 0.0, *velocity, spin])
        told = friction_at(scene, state[None])[0] / DECEL
        np.testing.assert_allclose(told, on_feet(state, 0.05), atol=1e-10)
    run: Any = Scene(body, launch=Launch((1.0, 0.0)), edges=[AHEAD]).simulate()
    assert run.end == "tipped over"
    assert abs(run.last["x"] - (0.15 - 0.03 + 0.002)) < 1e-5
    assert abs(run.last["spin"]) < 1e-7


def test_a_ring_is_carried_up_to_its_centre():
    ring = Puck(base=Base.annulus(0.06, 0.05), friction=0.3)
    run: Any = Scene(ring, launch=Launch((1.0, 0.0)), edges=[AHEAD]).simulate()
    assert run.end == "tipped over"
    assert 0.149 < run.last["x"] < 0.15
    turned: Any = Scene(ring, launch=Launch((1.0, 0.0), spin=20.0), edges=[AHEAD]).simulate()
    assert abs(turned.last["y"]) > 1e-4
    assert turned.energy_residual < 1e-8


FLOORS = [
    Floor(), Floor(law=StribeckLaw(0.3, 0.1, speed=0.3)), Floor(strips=Strips((0.02,), (0.3, 0.2))),
    Floor(static_ratio=1.4, grips=[Grip([[0.0, 1.0], [1.0, 0.6]])]),
]  # fmt: skip


@pytest.mark.parametrize(
    ("first", "inner", "floor"),
    [
        *((0, 0.0, floor) for floor in FLOORS),
        *((0, 0.7, floor) for floor in FLOORS if not floor.law),
        *(thorough(2, inner, floor) for inner in (0.0, 0.7) for floor in FLOORS),
    ],
)  # fmt: skip
def test_a_round_puck_is_the_disc_or_the_ring_of_its_radius(first: int, inner: float, floor: Floor):
    """It is looked up, or integrated, and comes over an edge, back from it, and over another."""
    law, hangs = f"annulus:{inner}" if inner else "uniform", 0
    tall = () if floor.grips else (0.05,)
    for height in (0.0, *tall):
        for seed in (first, first + 1):
            rng = np.random.default_rng(seed)
            puck = Puck(0.06, friction=0.3, height=height, pressure=law)
            base = Base.annulus(0.06, inner * 0.06) if inner else Base.disc(0.06)
            same = replace(
                puck, radius=None, pressure="uniform", base=base, gyration=puck.inertia_radius
            )
            edges = [
                Edge((0.2, 0.0), normal=(-1.0, rng.uniform(-0.3, 0.3))),
                Edge((0.0, 0.25), normal=(0.0, -1.0)),
            ]
            launch = Launch(
                (rng.uniform(0.6, 1.2), rng.uniform(0.2, 0.6)), spin=rng.normal(0.0, 20.0)
            )
            runs: list[Any] = [
                Scene(one, floor, launch, edges=edges).simulate() for one in (puck, same)
            ]
            one, other = runs
            assert one.end == other.end
            assert [event.what for event in one.events] == [event.what for event in other.events]
            assert abs(one.end_time - other.end_time) < 2e-6
            for name in ("x", "y", "orientation", "vx", "vy", "spin"):
                scale = 1.0 if name in ("x", "y", "vx", "vy") else 1.0 / 0.06
                assert abs(one.last[name] - other.last[name]) < 2e-6 * scale, (height, seed, name)
            hangs += sum(event.what == "overhang" for event in one.events)
    assert hangs > 0


def test_a_map_of_throws_has_the_ends_of_its_runs():
    for height in (0.0, 0.08):
        box = replace(BOX, height=height)
        scene: Any = Scene(box, launch=Launch((0.5, 0.2), spin=5.0), edges=[AHEAD])
        speeds = np.linspace(0.3, 1.2, 7)
        ranges = [[speed, 0.2] for speed in speeds.tolist()]
        found = replace(scene, launch=Launch(ranges, spin=5.0)).sweep()
        ends = set()
        for k, speed in enumerate(speeds):
            run = replace(scene, launch=Launch((speed, 0.2), spin=5.0)).simulate()
            assert ENDS[int(np.ravel(found.end)[k])] == run.end, (height, speed)
            for name in ("x", "y", "orientation", "spin"):
                there = float(np.ravel(getattr(found, name))[k])
                assert abs(there - run.last[name]) < 1e-6, (height, speed, name)
            ends.add(run.end)
        assert ends == {"at rest", "tipped over" if height else "over the edge"}


def test_a_box_lifts_from_a_quarter_of_its_length_on():
    for away in (0.08, 0.06, 0.05, 0.04, 0.01, 0.001):
        scene = Scene(BOX, launch=Launch((1.0, 0.0)), edges=[Edge((away, 0.0), normal=(-1, 0))])
        floor_map = floor_map_of(scene, 1.0)
        _, _, a, b, c = sums_and_pressure(floor_map, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, True)
        assert abs(c) * WIDE < 1e-9 * a
        if away >= LONG / 4.0:  # linear over the length s: its mean is d from the edge
            s = LONG / 2.0 + away
            ends = (a + b * away) * s * WIDE, (a + b * (away - s)) * s * WIDE
            np.testing.assert_allclose(ends, [4 - 6 * away / s, 6 * away / s - 2], atol=1e-9)
        else:  # a triangle of the length 3 d
            np.testing.assert_allclose(-a / b, away - 3.0 * away, rtol=1e-9)
            np.testing.assert_allclose((a + b * away) * 1.5 * away * WIDE, 1.0, rtol=1e-9)


def test_a_box_that_slides_square_to_an_edge_slows_down_as_ever_and_tips():
    run: Any = Scene(BOX, launch=Launch((1.0, 0.0)), edges=[AHEAD]).simulate()
    assert run.end == "over the edge"
    speed = math.sqrt(1.0 - 2.0 * DECEL * 0.15)
    assert abs(run.end_time - (1.0 - speed) / DECEL) < 1e-9
    assert abs(run.last["vx"] - speed) < 1e-9
    assert abs(run.last["spin"]) < 1e-9


@pytest.mark.parametrize("height", [0.0, 0.08])
def test_an_edge_that_no_corner_reaches_changes_nothing(height: float):
    launch, box = Launch((0.5, 0.1), spin=9.0), replace(BOX, height=height)
    alone: Any = Scene(box, launch=launch).simulate()
    beside: Any = Scene(box, launch=launch, edges=[Edge((9.0, 0.0), normal=(-1, 0))]).simulate()
    assert alone.last == beside.last


def test_what_is_carried_as_if_none_hung_in_the_air_says_so():
    edges = [Edge((0.12, 0.0), normal=(-1.0, 0.0))]
    tall, brushed = replace(BOX, height=0.08), Floor(orthotropic=Orthotropic((0.2, 0.3)))
    strips = Floor(strips=Strips((9.0,), (0.3, 0.2)))
    boards: list[tuple[Puck, Floor, str]] = [
        (BOX, Floor(), "tips"), (DOME, Floor(), "is a guess"), (tall, Floor(), "tips"),
        (BOX, strips, "tips"), (BOX, brushed, "tips"), (Puck(0.07), brushed, "tips"),
    ]  # fmt: skip
    for puck, floor, words in boards:
        run: Any = Scene(puck, floor, Launch((0.6, 0.0)), edges=edges).simulate()
        assert words in str(run), (puck, floor)
    piece = Puck(base=Base.box(LONG, WIDE), friction=0.3, name="a", launch=Launch((0.6, 0.0)))
    run = Scene(pucks=[piece], edges=edges).simulate()
    assert "tips" in str(run)


def test_beyond_a_line_of_the_rules_the_floor_goes_on():
    """It leaves play there, and until then nothing is otherwise than far from it."""
    puck, launch = replace(BOX, height=0.08), Launch((0.7, 0.2), spin=6.0)
    line = Edge((0.06, 0.0), normal=(-1.0, 0.0), beyond="floor")
    run: Any = Scene(puck, launch=launch, edges=[line]).simulate()
    alone: Any = Scene(puck, launch=launch).simulate()
    assert [event.what for event in run.events] == ["edge"]
    assert abs(float(np.ravel(alone(np.array([run.end_time])).x)[0]) - 0.06) < 1e-9
    assert abs(float(np.ravel(alone(np.array([run.end_time])).spin)[0]) - run.last["spin"]) < 1e-8


def test_the_command_line_says_so(tmp_path: Any):
    file = tmp_path / "table.toml"
    file.write_text(
        '[puck]\nbase = "box:0.2x0.1"\nfriction = 0.3\n[launch]\nvelocity = [1.0, 0.0]\n'
        "[[edge]]\npoint = [0.15, 0.0]\nnormal = [-1.0, 0.0]\n"
    )
    said = invoke("simulate", "--scene", file)
    assert said.exit_code == 0, said.output
    assert "over the edge after" in said.stdout
    assert "carries nothing" in said.stdout


def test_on_boards_too():
    box = {"base": Base.box(LONG, WIDE), "radius": 0.12, "friction": 0.3}
    one = Puck(**box, name="a", launch=Launch((0.9, 0.1), position=(-0.3, 0.02), spin=4.0))
    two = Puck(**box, name="b", launch=Launch((0.0, 0.0), position=(0.0, 0.0)))
    edges = [Edge((0.03, 0.0), normal=(-1.0, 0.0))]
    run: Any = Scene(pucks=[one, two], edges=edges).simulate()
    assert {event.what for event in run.events} >= {"impact", "overhang", "edge"}
    assert run.energy_residual < 1e-8


def test_one_that_slides_along_a_cushion_tips_as_one_that_is_free():
    """Square to the edge, against a smooth cushion that a force holds it to, with no friction."""
    box = Puck(0.12, base=Base.box(LONG, WIDE), friction=0.3, height=0.08)
    cushion = Wall((0.0, -0.12), normal=(0.0, 1.0), restitution=0.0, tangential=-1.0)
    ends = []
    for walls, force in (([], Force()), ([cushion], Force((0.0, -1.0)))):
        scene = Scene(box, launch=Launch((1.2, 0.0)), edges=[AHEAD], walls=walls, force=force)
        run: Any = scene.simulate()
        assert run.end == "tipped over"
        ends.append(run.last["x"])
    assert ("contact" in {event.what for event in run.events}) and abs(ends[0] - ends[1]) < 1e-4


def test_one_that_is_pushed_tips_too():
    """And the one behind it goes on, and tips where its own load is over the edge."""
    one = Puck(base=Base.box(LONG, WIDE), radius=0.12, friction=0.3, height=0.08, mass=1.0,
               restitution=0.0, name="one", launch=Launch((1.5, 0.0)),
               force=Force((4.0, 0.0)))  # fmt: skip
    other = Puck(base="box:0.1x0.1", radius=0.08, friction=0.3, height=0.1, mass=0.5,
                 restitution=0.0, name="other",
                 launch=Launch((0.0, 0.0), position=(0.21, 0.0)))  # fmt: skip
    edges = [Edge((0.3, 0.0), normal=(-1.0, 0.0))]
    run: Any = Scene(pucks=[one, other], edges=edges, time=1.0).simulate()
    tips = [event for event in run.events if event.what == "tip"]
    assert [event.puck for event in tips] == ["other", "one"]
    assert abs(tips[0].x - (0.3 - 0.3 * 0.05)) < 1e-3
    assert abs(tips[1].x - (0.3 - 0.3 * 0.04)) < 1e-3
    assert abs(run.energy_residual) < 1e-8


def test_one_that_lies_beyond_an_edge_is_refused():
    with pytest.raises(InputError, match="lies in it"):
        Scene(BOX, launch=Launch((0.1, 0.0)), edges=[Edge((-0.01, 0.0), normal=(-1.0, 0.0))])

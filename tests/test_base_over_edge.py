"""A base over an edge is carried by what is left of it, and tips where its centre is over it.

Truth: closed forms of a box, and a judge that shares no code (:mod:`tests.judges.edge_judge`).
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner
from judges import edge_judge
from puck_tables.cli.main import main

from puck_tables import Base, Edge, Floor, InputError, Launch, Puck, Scene, Strips
from puck_tables.scene.floor_map import PLACE_X
from puck_tables.scene.map_of_floor import edges_under, floor_map_of
from puck_tables.scene.over_edges import left_on_floor
from puck_tables.world.floor_forces import friction_at

LONG, WIDE, DECEL = 0.2, 0.1, 0.3 * 9.80665
BOX = Puck(base=Base.box(LONG, WIDE), friction=0.3)
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


@pytest.mark.parametrize("count", [1, 2])
def test_friction_is_that_of_the_judge(count: int):
    for seed in range(40):
        rng = np.random.default_rng(seed)
        corners = polygon(rng)
        base = Base.polygon(corners)
        about = np.array(base.outlines[0]) - np.array(base.middle)
        if not base.is_under_centre:
            continue
        rows = over(rng, count)
        puck = Puck(base=base, friction=0.3, mass=2.0)
        scene = Scene(puck, edges=as_edges(rows), launch=Launch((0.1, 0.0)))
        state = np.array([0.0, 0.0, rng.uniform(-3.0, 3.0), *rng.normal(0.0, 0.3, 2), 0.0])
        state[5] = rng.choice([0.0, -1.0, 1.0, 10.0]) * rng.uniform(0.3, 2.0)
        told = friction_at(scene, state[None])[0] / (2.0 * DECEL)
        true = edge_judge.under(about, rows, state)
        np.testing.assert_allclose(told[:2], true[:2], atol=1e-8, err_msg=str(seed))
        np.testing.assert_allclose(told[2], true[2], atol=1e-9, err_msg=str(seed))


def test_a_disc_is_a_polygon_of_many_corners():
    turn = np.linspace(0.0, 2.0 * math.pi, 1500, endpoint=False)
    corners = 0.05 * np.column_stack([np.cos(turn), np.sin(turn)])
    for gap in (0.002, 0.01, 0.03):
        rows = [np.array([0.6, 0.8, -gap])]
        scene = Scene(Puck(base=Base.disc(0.05), friction=0.3, mass=1.0), edges=as_edges(rows),
                      launch=Launch((0.1, 0.0)))  # fmt: skip
        state = np.array([0.0, 0.0, 0.4, 0.1, 0.2, 9.0])
        told = friction_at(scene, state[None])[0] / DECEL
        np.testing.assert_allclose(told, edge_judge.under(corners, rows, state), atol=1e-5)


def test_motion_is_that_of_the_judge():
    ends = set()
    for seed in range(6):
        rng = np.random.default_rng(seed)
        half = 0.5 * np.array([[-LONG, -WIDE], [LONG, -WIDE], [LONG, WIDE], [-LONG, WIDE]])
        rows = over(rng, 1 + seed % 2)
        state = np.array([0.0, 0.0, rng.uniform(-3.0, 3.0), *rng.normal(0.0, 0.3, 2), 0.0])
        state[5] = rng.uniform(3.0, 9.0)
        launch = Launch((state[3], state[4]), spin=state[5], orientation=state[2])
        run: Any = Scene(BOX, edges=as_edges(rows), launch=launch).simulate()
        when, true = edge_judge.slide(half, rows, DECEL, BOX.gyration, state)
        told = run(np.array([when]))
        for name, value in zip(("x", "y", "orientation", "vx", "vy"), true, strict=False):
            assert abs(float(np.ravel(getattr(told, name))[0]) - value) < 2e-6, (seed, name)
        assert abs(float(np.ravel(told.spin)[0]) - true[5]) < 2e-5, seed
        speeds = run(np.linspace(0.0, when, 200))
        energy = 0.5 * (speeds.vx**2 + speeds.vy**2 + (BOX.gyration * speeds.spin) ** 2)
        assert (np.diff(np.ravel(energy)) <= 0.0).all(), seed
        ends.add(run.end)
    assert ends == {"at rest", "over the edge"}


def test_a_box_lifts_from_a_quarter_of_its_length_on():
    for away in (0.08, 0.06, 0.05, 0.04, 0.01, 0.001):
        scene = Scene(BOX, launch=Launch((1.0, 0.0)), edges=[Edge((away, 0.0), normal=(-1, 0))])
        floor_map = floor_map_of(scene, 1.0, 0.0, edges_under(scene, BOX))
        floor_map[PLACE_X] = 0.0
        _, _, a, b, c = left_on_floor(floor_map, 0.0, 0.0)
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


def test_mirror_images():
    ends = []
    for side in (1.0, -1.0):
        launch = Launch((0.4, side * 0.2), spin=side * 7.0)
        edge = Edge((0.05, 0.0), normal=(-1.0, side * 0.3))
        run: Any = Scene(BOX, launch=launch, edges=[edge]).simulate()
        ends.append([run.last["x"], side * run.last["y"], side * run.last["orientation"]])
    np.testing.assert_allclose(ends[0], ends[1], atol=1e-9)


def test_an_edge_that_no_corner_reaches_changes_nothing():
    launch = Launch((0.5, 0.1), spin=9.0)
    alone: Any = Scene(BOX, launch=launch).simulate()
    beside: Any = Scene(BOX, launch=launch, edges=[Edge((9.0, 0.0), normal=(-1, 0))]).simulate()
    assert alone.last == beside.last


def test_what_is_carried_as_if_none_hung_in_the_air_says_so():
    edges = [Edge((0.12, 0.0), normal=(-1.0, 0.0))]
    feet = Puck(base=Base.feet([(0.05, 0.0), (-0.05, 0.05), (-0.05, -0.05)], 0.01), friction=0.3)
    tall = Puck(base=Base.box(LONG, WIDE), friction=0.1, height=0.1)
    strips = Floor(strips=Strips((9.0,), (0.3, 0.2)))
    boards: list[tuple[Puck, Floor, str]] = [
        (BOX, Floor(), "tips"), (feet, Floor(), "is a guess"), (tall, Floor(), "is a guess"),
        (BOX, strips, "is a guess"),
    ]  # fmt: skip
    for puck, floor, words in boards:
        run: Any = Scene(puck, floor, Launch((0.6, 0.0)), edges=edges).simulate()
        assert words in str(run), (puck, floor)
    piece = Puck(base=Base.box(LONG, WIDE), friction=0.3, name="a", launch=Launch((0.6, 0.0)))
    run = Scene(pucks=[piece], edges=edges).simulate()
    assert "tips" in str(run)


def test_the_command_line_says_so(tmp_path: Any):
    file = tmp_path / "table.toml"
    file.write_text(
        '[puck]\nbase = "box:0.2x0.1"\nfriction = 0.3\n[launch]\nvelocity = [1.0, 0.0]\n'
        "[[edge]]\npoint = [0.15, 0.0]\nnormal = [-1.0, 0.0]\n"
    )
    said = CliRunner().invoke(main, ["simulate", "--scene", str(file)])
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


def test_one_that_lies_beyond_an_edge_is_refused():
    with pytest.raises(InputError, match="lies in it"):
        Scene(BOX, launch=Launch((0.1, 0.0)), edges=[Edge((-0.01, 0.0), normal=(-1.0, 0.0))])

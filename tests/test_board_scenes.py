"""The scenes of several pucks that come along: what they are, how they end."""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np
import pytest

from puck_tables import Scene
from puck_tables.scene.library import shipped_scenes

BOARDS = [name for name in shipped_scenes() if Scene.load(name).pucks]
# how many impacts at least, and who leaves play
STORIES: dict[str, tuple[int, set[str]]] = {
    "air-hockey-goals": (2, {"puck"}), "air-hockey-mallet": (5, set()), "air-table": (4, set()),
    "bowling-row": (15, {"ball", "pin 1", "pin 5", "pin 7"}), "bumper-pool": (1, {"cue"}),
    "carrom-break": (40, {"white 1", "black 2"}), "crokinole": (2, {"shot"}),
    "curling-take-out": (2, {"yellow", "yellow 2"}), "newtons-row": (5, set()),
    "shuffleboard-two-stones": (1, {"blue"}), "sjoelen": (5, set()),
}  # fmt: skip


@pytest.fixture(scope="module")
def runs() -> dict[str, Any]:
    return {name: Scene.load(name).simulate() for name in BOARDS}


def test_every_story_is_of_a_scene() -> None:
    assert set(STORIES) == set(BOARDS)


@pytest.mark.parametrize("name", STORIES)
def test_a_scene_tells_its_story(runs: dict[str, Any], name: str) -> None:
    run, (impacts, gone) = runs[name], STORIES[name]
    assert run.impacts >= impacts
    assert {event.puck for event in run.events if event.what in ("pocket", "edge", "tip")} == gone
    assert run.energy_residual < 1e-12
    assert run.end_error < 1e-2 * min(puck.radius for puck in run.scene.pucks)  # to be retold


@pytest.mark.parametrize("name", BOARDS)
def test_no_pucks_overlap_between_frames(runs: dict[str, Any], name: str) -> None:
    run = runs[name]
    radii = [puck.radius for puck in run.scene.pucks]
    for one, other in itertools.combinations(range(len(radii)), 2):
        both = (run.in_play[:, one] > 0.0) & (run.in_play[:, other] > 0.0)
        apart = np.hypot(run.x[:, one] - run.x[:, other], run.y[:, one] - run.y[:, other])
        assert (apart[both] >= (radii[one] + radii[other]) * (1.0 - 1e-11)).all()


def test_the_rack_of_carrom_touches_and_has_its_colours() -> None:
    men = Scene.load("carrom-break").pucks[:19]
    places = np.array([man.launch.position for man in men])
    pairs = list(itertools.combinations(range(19), 2))
    gaps = np.array([math.dist(places[i], places[j]) for i, j in pairs]) - 2.0 * men[0].radius
    assert (np.abs(gaps) < 1e-12 * men[0].radius).sum() == 42  # of a hexagon with sides of three
    assert gaps.min() > -1e-12 * men[0].radius
    colours = [man.name.split()[0] for man in men]
    assert [colours.count(name) for name in ("white", "black", "queen")] == [9, 9, 1]


def test_the_last_of_newtons_row_takes_all(runs: dict[str, Any]) -> None:
    """Sliding without spin under J = f g: x = v²/2J from where it starts, by hand."""
    run = runs["newtons-row"]
    decel = 0.05 * 9.80665
    left = math.sqrt(1.0 - 2.0 * decel * 0.24)  # speed after 0.24 m, when the rims touch
    assert run["row 5"]["x"][-1] == pytest.approx(0.24 + left**2 / (2.0 * decel), rel=1e-9)
    assert run["first"]["x"][-1] == pytest.approx(-0.06, abs=1e-9)
    assert np.abs(run.last["y"]).max() == 0.0


def test_posts_of_crokinole_stand_on_their_circle_and_the_ditch_is_round() -> None:
    scene = Scene.load("crokinole")
    assert len(scene.posts) == 8 and len(scene.edges) == 24
    assert [math.hypot(*post.point) for post in scene.posts] == pytest.approx([0.1016] * 8)
    turns = np.diff(np.unwrap([math.atan2(*edge.point[::-1]) for edge in scene.edges]))
    assert turns == pytest.approx(np.full(23, 2.0 * math.pi / 24.0))


def test_a_goal_is_the_exit_of_its_line_into_the_slot(runs: dict[str, Any]) -> None:
    run = runs["air-hockey-goals"]
    goals = [event for event in run.events if event.partner == "right goal"]
    assert [event.what for event in goals] == ["entry", "line", "exit"]
    goes_in = goals[-1].time < next(event.time for event in run.events if event.what == "edge")
    assert goes_in and goals[-1].approach < 0.0 and abs(goals[1].y - 0.55) < 0.1524


def test_gates_and_compartments_of_sjoelen(runs: dict[str, Any]) -> None:
    """Four gates of 60 mm in the middle of compartments of 91 mm, with partitions of 12 mm."""
    run = runs["sjoelen"]
    corners = np.array(run.scene.walls[0].corners)
    gates = [(line.start[1], line.end[1]) for line in run.scene.lines]
    assert np.diff(gates).ravel() == pytest.approx([0.06] * 4)
    backs = np.sort(corners[corners[:, 0] == 2.0, 1]).reshape(4, 2)
    assert np.diff(backs).ravel() == pytest.approx([0.091] * 4)
    assert (backs[1:, 0] - backs[:-1, 1]) == pytest.approx([0.012] * 3)
    assert backs.mean(axis=1) == pytest.approx(np.mean(gates, axis=1))
    assert [(event.puck, event.partner) for event in run.events if event.what == "exit"] == [
        ("first", "three")
    ]
    assert run["first"]["x"][-1] > 1.6 + 0.026


def test_bumpers_leave_room_for_a_disc(runs: dict[str, Any]) -> None:
    scene = runs["bumper-pool"].scene
    posts, radius = scene.posts, scene.pucks[0].radius
    assert len(posts) == 12 and len(scene.pucks) == 8
    inner = sorted(math.hypot(*post.point) for post in posts)[:4]
    assert min(inner) - posts[0].radius > radius  # at the centre of the cross

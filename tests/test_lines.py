"""Painted lines: who passes them, and when."""

from __future__ import annotations

import math
import pickle

import numpy as np
import pytest
from commands import invoke

import puck_tables as pt
from puck_tables import Floor, InputError, Launch, Line, Puck, Scene, Wall

DECEL = 0.1 * 9.80665  # of the puck below
HOG = Line((0.5, -1.0), (0.5, 1.0), name="hog")


def slide(
    *lines: Line, velocity: tuple[float, float] = (1.5, 0.0), **more: object
) -> pt.results.Run:
    return Scene(Puck(0.05, friction=0.1), launch=Launch(velocity), lines=lines, **more).simulate()


def passed(run: pt.results.Run) -> list[tuple[str, str]]:
    return [(event.what, event.partner) for event in run.events if event.what != "stick"]


def test_a_slide_passes_when_it_has_gone_so_far():
    """X = v t − ½ f g t²: the rim, the centre, the rim."""
    events = slide(HOG).events[:3]
    assert [event.what for event in events] == ["entry", "line", "exit"]
    for event, way in zip(events, (0.45, 0.5, 0.55), strict=True):
        speed = math.sqrt(1.5**2 - 2.0 * DECEL * way)
        assert event.time == pytest.approx((1.5 - speed) / DECEL, abs=1e-12)
        assert event.approach == pytest.approx(-speed, abs=1e-12)  # to the right of its way
        assert (event.x, event.partner) == (pytest.approx(way, abs=1e-12), "hog")


def test_sides_have_signs():
    other_way = Line((0.5, 1.0), (0.5, -1.0))
    assert slide(other_way).events[1].approach > 0.0
    inwards = [event.approach > 0.0 for event in slide(Line(centre=(0.6, 0.0), radius=0.2)).events]
    assert inwards == [True] * 3 + [False] * 3 + [False]  # the last comes to rest


def test_it_must_be_between_the_ends():
    beside = Line((0.5, 0.03), (0.5, 1.0))
    assert passed(slide(beside)) == [("entry", "line 0"), ("exit", "line 0")]
    assert passed(slide(Line((0.5, 0.06), (0.5, 1.0)))) == []


def test_who_stops_short_has_not_passed():
    reach = 1.5**2 / (2.0 * DECEL)
    assert passed(slide(Line((reach + 0.06, -1.0), (reach + 0.06, 1.0)))) == []
    assert passed(slide(Line((reach + 0.04, -1.0), (reach + 0.04, 1.0)))) == [("entry", "line 0")]


def test_who_starts_on_a_line_has_passed_nothing():
    start = Line((0.0, -1.0), (0.0, 1.0))
    assert passed(slide(start)) == [("exit", "line 0")]
    assert passed(slide(start, velocity=(-1.5, 0.0))) == [("exit", "line 0")]


def test_a_line_changes_nothing():
    lines, bare = slide(HOG, velocity=(1.5, 0.3)), slide(velocity=(1.5, 0.3))
    assert np.array_equal(lines.x, bare.x) and lines.end_time == bare.end_time


def counted(away: np.ndarray, size: float) -> int:
    """How often a distance comes below a size, or goes above it."""
    return int((np.diff(np.abs(away) < size) != 0).sum())


SCENES = {
    "cushions": {"walls": [Wall((1.0, 0.0), normal=(-1, 0)), Wall((-1.0, 0.0), normal=(1, 0))]},
    "belt": {"floor": Floor(velocity=(0.3, -0.2)), "time": 4.0},
    "turntable": {"floor": Floor(turning=2.0, centre=(0.4, 0.0)), "time": 9.0},
    "slope": {"floor": Floor(slope=0.05, downhill=1.0)},
    "air": {"drag": pt.Drag(sliding=0.05), "time": 4.0},
}


@pytest.mark.parametrize("kind", SCENES)
def test_all_that_passes_is_told_and_nothing_else(kind: str):
    """Counted on states so close that none is missed; shallow passings are left out."""
    random = np.random.default_rng(3)
    more = SCENES[kind]
    puck = Puck(0.05, friction=0.0 if kind == "air" else 0.1, mass=0.2)
    for _ in range(4):
        ends = random.uniform(-0.7, 0.7, (3, 2, 2))
        lines = [Line(tuple(a), tuple(b)) for a, b in ends]
        lines.append(Line(centre=tuple(random.uniform(-0.4, 0.4, 2)), radius=0.3))
        angle = random.uniform(0.0, 2.0 * math.pi)
        launch = Launch((1.2 * math.cos(angle), 1.2 * math.sin(angle)), random.uniform(-9, 9))
        run = Scene(puck, launch=launch, lines=lines, **more).simulate()
        times = np.linspace(0.0, run.end_time, 40_001)
        told = run(times)
        at = np.stack([told.x, told.y], 1)
        for number, line in enumerate(lines):
            events = [event for event in run.events if event.partner == f"line {number}"]
            if line.radius:
                signed = line.radius - np.hypot(*(at - line.centre).T)
                near, there = np.abs(signed), np.ones(len(times), bool)
            else:
                a, b = np.array(line.start), np.array(line.end)
                along = ((at - a) @ (b - a)) / ((b - a) @ (b - a))
                there = (along >= 0.0) & (along <= 1.0)
                near = np.hypot(*(at - a - np.clip(along, 0.0, 1.0)[:, None] * (b - a)).T)
                signed = (b - a)[0] * (at - a)[:, 1] - (b - a)[1] * (at - a)[:, 0]
            centre = (np.diff(np.sign(signed)) != 0) & there[1:]
            crossings = [event for event in events if event.what == "line"]
            assert len(crossings) == centre.sum()
            assert np.allclose([e.time for e in crossings], times[1:][centre], atol=1e-3)
            assert sum(e.what != "line" for e in events) == counted(near, 0.05)


def test_a_world_tells_the_same_in_parts_and_in_copies():
    pieces = [
        Puck(0.03, friction=0.1, launch=Launch((1.4, 0.1), 20.0, (-0.5, 0.0))),
        Puck(0.03, friction=0.1, launch=Launch(position=(0.0, 0.0))),
    ]
    goal = Line((0.3, 1.0), (0.3, -1.0), name="goal")
    scene = Scene(pucks=pieces, lines=[goal, Line(centre=(0.0, 0.0), radius=0.2)])
    world, whole = scene.world(), scene.world()
    everything = whole.advance(3.0)
    parts, copies = [], []
    for _ in range(300):
        parts += world.advance(0.01)
        if world.time == pytest.approx(0.4):
            copies = pickle.loads(pickle.dumps(world)).advance(2.6)
    assert parts == everything == world.events_since(0.0)
    assert copies == [event for event in everything if event.time > world.time - 2.6]
    assert sum(event.partner == "goal" and event.what == "line" for event in parts) == 1


def test_a_base_without_a_rim_has_a_centre_only():
    box = Puck(base=pt.Base.box(0.2, 0.1), friction=0.1)
    run = Scene(box, launch=Launch((1.5, 0.0), 2.0), lines=[HOG]).simulate()
    assert passed(run) == [("line", "hog")]


@pytest.mark.parametrize(
    ("line", "said"),
    [
        (Line((0.0, 0.0)), r"line\[0\]: give its start and end, or a centre and a radius > 0"),
        (Line(), r"line\[0\]: give its start and end"),
        (Line((0.0, 0.0), (1.0, 0.0), radius=1.0), r"line\[0\]: give its start and end"),
        (Line((0.0, 0.0), (0.0, 0.0)), r"line\[0\].end = \(0.0, 0.0\): must lie elsewhere"),
        (Line(centre=(0.0, 0.0), radius=-1.0), r"line\[0\].radius = -1.0: must be a number >= 0"),
    ],
)
def test_what_is_no_line_is_refused(line: Line, said: str):
    with pytest.raises(InputError, match=said):
        Scene(Puck(0.1), lines=[line])
    with pytest.raises(InputError, match="2 lines have it"):
        Scene(Puck(0.1), lines=[HOG, HOG])


def test_lines_are_drawn(tmp_path):
    run = slide(HOG, Line(centre=(0.6, 0.0), radius=0.2, colour="firebrick"))
    labels = run.plot().axes[0].get_legend_handles_labels()[1]
    assert labels.count("line") == 1
    run.movie(tmp_path / "slide.html")
    assert '"painted":[{"colour":"#' in (tmp_path / "slide.html").read_text("utf-8")


def test_lines_of_a_file_are_reported(tmp_path):
    (tmp_path / "slide.toml").write_text(
        "[puck]\nradius = 0.05\nfriction = 0.1\n[launch]\nvelocity = [1.5, 0.0]\n"
        '[[line]]\nstart = [0.5, -1.0]\nend = [0.5, 1.0]\nname = "hog line"\n'
    )
    said = invoke("simulate", "--scene", tmp_path / "slide.toml")
    assert "line (hog line) at 0.38" in said.stdout

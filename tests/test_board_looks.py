"""Pictures and movies of several pucks show what was computed."""

from __future__ import annotations

import itertools
import json
import re
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.patches import Circle
from PIL import Image
from scipy.integrate import solve_ivp

from puck_tables import Edge, Floor, InputError, Launch, Post, Puck, Scene, Wall
from puck_tables._core.colours import brightness, is_colour
from puck_tables.errors import MissingExtraError, OutputError
from puck_tables.plot.animation import PALETTE, between, colour_of, film_of, path_of
from puck_tables.plot.movie import page
from puck_tables.plot.style import RED
from puck_tables.results import Trajectory

BOARDS = ("carrom-break", "crokinole", "curling-take-out", "air-hockey-mallet", "newtons-row")


@pytest.fixture(scope="module")
def runs() -> dict[str, Any]:
    return {name: Scene.load(name).simulate() for name in BOARDS}


def told_in(page: Path) -> dict[str, Any]:
    """The data of a movie."""
    found = re.search(r"const film = (\{.*\});\n", page.read_text(encoding="utf-8"))
    assert found is not None
    film: dict[str, Any] = json.loads(found[1])
    return film


def hermite(knots: np.ndarray, time: float) -> np.ndarray:
    """Place and angle between knots, as the page has it; of a Newton form of its own."""
    row = min(int(np.searchsorted(knots[:, 0], time, side="right")) - 1, len(knots) - 2)
    one, two = knots[row], knots[row + 1]
    h = two[0] - one[0]
    if h <= 0.0:
        return two[1:4]
    slope = (two[1:4] - one[1:4]) / h
    first, last = (slope - one[4:]) / h, (two[4:] - slope) / h
    s = time - one[0]
    third = (last - first) / h
    return one[1:4] + s * (one[4:] + s * (first + (s - h) * third))


@pytest.mark.parametrize("name", BOARDS)
def test_a_movie_moves_as_the_run_does(runs: dict[str, Any], name: str, tmp_path: Path) -> None:
    run = runs[name]
    run.movie(tmp_path / "run.html")
    assert (tmp_path / "run.html").stat().st_size < 1_000_000
    film = told_in(tmp_path / "run.html")
    assert [body["name"] for body in film["bodies"]] == list(run.names)
    times = np.sort(np.random.default_rng(3).uniform(0.0, run.end_time, 200))
    seen = run(times)
    size = max(film["box"][1] - film["box"][0], film["box"][3] - film["box"][2])
    for number, body in enumerate(film["bodies"]):
        knots = np.array(body["knots"])
        moved = np.array([hermite(knots, time) for time in times])
        gap = np.hypot(moved[:, 0] - seen.x[:, number], moved[:, 1] - seen.y[:, number])
        assert gap.max() < min(2e-4 * size, 0.02 * body["radius"])
        assert np.abs(moved[:, 2] - seen.orientation[:, number]).max() < 0.02
    events = [event for event in run.events if event.what in ("impact", "pocket", "edge")]
    assert [one["time"] for one in film["happenings"]] == [event.time for event in events]


def test_impacts_are_exact_in_a_movie(runs: dict[str, Any]) -> None:
    film = film_of(runs["carrom-break"])
    bodies = {body.name: body for body in film.bodies}
    for event in runs["carrom-break"].events:
        if event.what == "impact" and event.partner in bodies:
            one, other = bodies[event.puck], bodies[event.partner]
            moment = np.array([event.time])
            apart = between(one.knots, moment)[0, :2] - between(other.knots, moment)[0, :2]
            assert np.hypot(*apart) == pytest.approx(one.radius + other.radius, rel=1e-4)


def test_a_page_loads_nothing_and_names_end_no_script(tmp_path: Path) -> None:
    name = "</script><script>alert(1)</script>"
    scene = Scene(pucks=[Puck(0.1, friction=0.1, name=name)], title="<b>&amp;</b>\u2028")
    scene.simulate().movie(tmp_path / "run.html")
    page = (tmp_path / "run.html").read_text(encoding="utf-8")
    assert page.count("<script>") == page.count("</script>") == 1
    assert told_in(tmp_path / "run.html")["bodies"][0]["name"] == name
    assert not re.search(r"https?:|src=|href=|@import|url\(", page)
    assert "default-src 'none'" in page


@pytest.mark.skipif(shutil.which("node") is None, reason="needs node")
def test_the_script_of_a_page_runs(runs: dict[str, Any], tmp_path: Path) -> None:
    """In node, on a page that only counts: the clock goes, the slider sets it, discs are drawn."""
    runs["crokinole"].movie(tmp_path / "run.html")
    page = (tmp_path / "run.html").read_text(encoding="utf-8")
    stage = """
    let arcs = 0, frame = null;
    const parts = {};
    const brush = new Proxy({}, {get: (_, name) => name === "arc" ? () => { arcs += 1; } : () => {},
                               set: () => true});
    const part = id => parts[id] ??= {
      style: {}, children: [], checked: true, value: id === "speed" ? "1" : "0", clientWidth: 900,
      on: {}, addEventListener(name, act) { this.on[name] = act; }, getContext: () => brush,
      appendChild(child) { this.children.push(child); }};
    const document = {getElementById: part, querySelector: part, createTextNode: text => text,
                      createElement: () => part(Math.random())};
    const window = {innerHeight: 700, addEventListener() {},
                    requestAnimationFrame(act) { frame = act; }};
    """
    script = re.findall(r"<script>(.*)</script>", page, re.DOTALL)[0]
    play = """
    arcs = 0; frame(0); frame(100);
    const played = parts.clock.textContent, drawn = arcs;
    parts.at.value = "0.3"; parts.at.on.input();
    console.log(JSON.stringify([played, drawn, parts.clock.textContent, parts.play.textContent,
                                parts.marks.children.length, parts.names.children.length]));
    """
    (tmp_path / "page.js").write_text(stage + script + play, encoding="utf-8")
    ended = subprocess.run(["node", tmp_path / "page.js"], capture_output=True, text=True)
    assert ended.returncode == 0, ended.stderr[-600:]
    played, drawn, set_to, word, marks, names = json.loads(ended.stdout)
    assert played == "0.100 s of 0.729 s, 0 impacts"
    assert drawn >= 2 * (8 + 1 + 4)  # posts, a pocket and discs, twice
    assert set_to == "0.300 s of 0.729 s, 2 impacts" and word == "Play"
    assert (marks, names) == (2, 4)


@pytest.mark.skipif(shutil.which("node") is None, reason="needs node")
@pytest.mark.parametrize(
    "floor",
    [
        Floor(velocity=(0.3, -0.2)),
        Floor(turning=-2.0, centre=(0.4, 0.1)),
        Floor(velocity=(0.3, 0.1), turning=1.5, centre=(0.2, -0.1)),
    ],
    ids=["belt", "turntable", "both"],
)
def test_marks_of_a_movie_go_with_its_floor(floor: Floor, tmp_path: Path) -> None:
    """Arrows begin where the floor brings them, integrated by scipy, and point along it."""
    film = film_of(Puck.similar().simulate((1.0, 0.0)))._replace(
        floor=floor, box=(0.0, 1.0, -1.0, 1.0)
    )
    (tmp_path / "run.html").write_text(page(film), encoding="utf-8")
    told = json.dumps(told_in(tmp_path / "run.html"))
    drawing = re.search(r"function drawMotion.*?\n}\n", page(film), re.DOTALL)
    assert drawing is not None
    script = f"""
    const film = {told}, [left, right, low, high] = film.box;
    const scale = 1, px = x => x, py = y => -y;
    let seen = [];
    const note = (x, y) => seen.push([x, -y]), pen = {{moveTo: note, lineTo: note}};
    pen.beginPath = pen.stroke = () => {{}};
    {drawing[0]}
    console.log(JSON.stringify([0, 0.7].map(t => {{ seen = []; drawMotion(t); return seen; }})));
    """
    ended = subprocess.run(["node", "-"], input=script, capture_output=True, text=True)
    assert ended.returncode == 0, ended.stderr[-600:]

    def flow(_: float, at: np.ndarray) -> list[float]:
        x, y = at[0] - floor.centre[0], at[1] - floor.centre[1]
        return [floor.velocity[0] - floor.turning * y, floor.velocity[1] + floor.turning * x]

    before, after = (  # five points an arrow; the cross in the centre of a turntable has four
        np.array(points[: len(points) // 5 * 5]).reshape(-1, 5, 2)
        for points in json.loads(ended.stdout)
    )
    kept = 0
    for tail in before[:, 0]:
        x, y = solve_ivp(flow, (0.0, 0.7), tail, rtol=1e-10, atol=1e-10).y[:, -1]
        if 0.0 < x < 1.0 and -1.0 < y < 1.0:
            kept += 1
            assert np.hypot(*(after[:, 0] - (x, y)).T).min() < 1e-7
    assert kept > 10
    for tail, tip in after[:, :2]:
        vx, vy = flow(0.0, tail)
        assert np.cross([*(tip - tail), 0.0], [vx, vy, 0.0])[2] == pytest.approx(0.0, abs=1e-12)
        assert (tip - tail) @ (vx, vy) >= 0.0


def test_one_puck_has_a_movie_too(tmp_path: Path) -> None:
    run: Trajectory = Puck.similar().simulate((1.0, 0.0), 5.0)
    run.movie(tmp_path / "one.html")
    knots = np.array(told_in(tmp_path / "one.html")["bodies"][0]["knots"])
    assert knots[-1, 1:3] == pytest.approx(run.stop_position, rel=1e-7)
    ride = Scene.load("incline").simulate()
    ride.movie(tmp_path / "two.html")
    knots = np.array(told_in(tmp_path / "two.html")["bodies"][0]["knots"])
    assert knots[-1, 0] == pytest.approx(ride.end_time)


@pytest.mark.thorough
def test_a_trail_bends_up_to_its_puck() -> None:
    puck = Puck(0.03, height=0.06, friction=0.25)
    film = film_of(puck.simulate((1.0, 0.0), 60.0))
    body = film.bodies[0]
    assert len(body.knots) < 20  # few, between which the way is bent
    for share in (0.3, 0.5, 0.77, 1.0):
        until = share * film.end_time
        (x, y), place = path_of(body, until).T, between(body.knots, np.array([until]))[0]
        assert (x[-1], y[-1]) == tuple(place[:2])
        way = between(body.knots, np.linspace(0.0, until, 2001))
        off = np.abs(np.interp(way[:, 0], x, y) - way[:, 1]).max()
        assert off < 5e-5  # a dot of the picture is 6e-4 m wide


def test_what_lies_still_has_a_movie_too(tmp_path: Path) -> None:
    still = Scene(pucks=[Puck(0.1, friction=0.1)]).simulate()
    still.movie(tmp_path / "still.html")
    still.movie(tmp_path / "still.gif")
    still.plot(tmp_path / "still.png")
    assert told_in(tmp_path / "still.html")["end_time"] == 0.0


@pytest.mark.thorough
def test_a_gif_moves(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("puck_tables.plot.movie._SHORTEST", 1.0)
    puck = Puck(0.1, friction=0.5, launch=Launch((1.0, 0.0)))
    Scene(pucks=[puck]).simulate().movie(tmp_path / "run.gif")
    with Image.open(tmp_path / "run.gif") as movie:
        assert movie.n_frames > 20  # type: ignore[attr-defined]
        movie.seek(0)
        first = np.asarray(movie.convert("RGB")).astype(int)
        movie.seek(movie.n_frames - 1)  # type: ignore[attr-defined]
        last = np.asarray(movie.convert("RGB")).astype(int)
    assert (np.abs(first - last).max(axis=2) > 60).mean() > 0.02


def test_a_movie_replaces_nothing_unasked(runs: dict[str, Any], tmp_path: Path) -> None:
    (tmp_path / "run.html").write_text("mine")
    with pytest.raises(OutputError, match="exists already"):
        runs["newtons-row"].movie(tmp_path / "run.html")
    assert (tmp_path / "run.html").read_text() == "mine"
    runs["newtons-row"].movie(tmp_path / "run.html", overwrite=True)
    with pytest.raises(InputError, match=r"one of \.html, \.gif, \.mp4"):
        runs["newtons-row"].movie(tmp_path / "run.avi")
    assert [path.name for path in tmp_path.iterdir()] == ["run.html"]


def test_without_ffmpeg_an_mp4_is_refused(runs, tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(MissingExtraError, match="ffmpeg"):
        runs["newtons-row"].movie(tmp_path / "run.mp4")
    assert not list(tmp_path.iterdir())


def circles(axes: Any) -> list[tuple[float, float, float]]:
    return [
        (*map(float, patch.center), float(patch.radius))
        for patch in axes.patches
        if isinstance(patch, Circle) and np.isfinite(patch.center[0])
    ]


@pytest.mark.parametrize("name", BOARDS)
def test_discs_and_impacts_stand_where_they_are(runs: dict[str, Any], name: str) -> None:
    run = runs[name]
    axes = run.plot().axes[0]
    drawn = np.array(circles(axes))
    for number, puck in enumerate(run.scene.pucks):
        end = (run.last["x"][number], run.last["y"][number], puck.radius)
        assert np.abs(drawn - end).max(axis=1).min() < 1e-6
    assert axes.get_aspect() == 1.0
    marked = [line for line in axes.lines if line.get_color() == RED and line.get_marker() == "o"]
    places = [(event.x, event.y) for event in run.events if event.what == "impact"]
    assert np.allclose(marked[0].get_xydata(), places)


def test_no_legend_lies_on_a_board_and_few_are_named(runs: dict[str, Any]) -> None:
    for name, run in runs.items():
        figure = run.plot()
        figure.draw_without_rendering()
        (legend,) = figure.legends
        words = {text.get_text() for text in legend.get_texts()}
        named = set(run.names) if len(run.names) <= 8 else set()
        assert named <= words and {"impact", "start"} <= words, name
        box = legend.get_window_extent()
        assert not any(box.overlaps(axes.get_window_extent()) for axes in figure.axes)
        assert figure.bbox.x0 <= box.x0 and box.x1 <= figure.bbox.x1
    assert "driven" in {t.get_text() for t in runs["air-hockey-mallet"].plot().legends[0].texts}


def test_small_pucks_have_a_close_up(runs: dict[str, Any]) -> None:
    assert len(runs["curling-take-out"].plot().axes) == 2
    assert len(runs["crokinole"].plot().axes) == 1


def test_names_are_drawn_as_they_stand() -> None:
    names = ("$x_1^{", "_hidden", "a $\\frac{1}{2}$")
    pucks = [
        Puck(0.1, friction=0.1, name=name, launch=Launch((1.0, 0.0), position=(0.0, float(n))))
        for n, name in enumerate(names)
    ]
    figure = Scene(pucks=pucks).simulate().plot()
    figure.draw_without_rendering()
    words = {text.get_text().strip() for text in figure.legends[0].get_texts()}
    assert set(names) <= words


def test_a_board_is_drawn_to_its_corners() -> None:
    """Walls end where others begin; of a triangle three sides, and nothing beyond."""
    post = Post((0.3, 0.3), 0.02)
    walls = [
        Wall((0.0, 0.0), normal=(0.0, 1.0)),
        Wall((0.0, 0.0), normal=(2.0, 0.0)),
        Wall((1.0, 0.0), normal=(-1.0, -1.0)),
    ]
    film = film_of(Scene(pucks=[Puck(0.01, friction=0.1, launch=Launch(position=(0.1, 0.1)))],
                         walls=walls, posts=[post]).simulate())  # fmt: skip
    corners = {tuple(np.round(end, 9) + 0.0) for line in film.lines
               for end in zip(line.x, line.y, strict=True)}  # fmt: skip
    assert corners == {(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)}
    assert film.box[0] < 0.0 and film.box[1] > 1.0
    open_side = film_of(Scene(pucks=[Puck(0.01, friction=0.1)],
                              edges=[Edge((5e6, 0.0), normal=(-1.0, 0.0))]).simulate())  # fmt: skip
    assert open_side.lines == [] and open_side.box[1] < 0.1


def test_colours_differ_also_in_grey() -> None:
    greys = [brightness(colour) for colour in PALETTE]
    assert all(abs(a - b) > 0.1 for a, b in itertools.pairwise(greys))
    many = [colour_of(number) for number in range(3 * len(PALETTE))]
    assert len(set(many)) == len(many) - 1  # black cannot be darker
    assert all(map(is_colour, many))


@pytest.mark.parametrize("colour", ["blau", "#12345", "red;", 3, "C0", "#12345g", "url(x)"])
def test_a_colour_that_nobody_knows_is_refused_where_it_is_given(colour: Any) -> None:
    with pytest.raises(InputError, match="must be a colour, '#rrggbb' or a name of CSS"):
        Puck(0.1, colour=colour)
    with pytest.raises(InputError, match=r"puck\[0\]\.colour = "):
        Scene.from_tables({"puck": [{"radius": 0.1, "friction": 0.1, "colour": colour}]})


def test_every_colour_that_is_taken_can_be_drawn() -> None:
    from matplotlib.colors import CSS4_COLORS, to_hex

    from puck_tables._core.colours import COLOURS

    assert {name: f"#{digits}" for name, digits in COLOURS.items()} == {
        name: to_hex(colour) for name, colour in CSS4_COLORS.items()
    }
    Scene(pucks=[Puck(0.1, friction=0.1, colour="CornflowerBlue")]).simulate().plot()


def test_maps_of_long_boards_have_a_close_up_too(runs: dict[str, Any]) -> None:
    ranges = {"puck[0].launch.velocity[1]": [0.0, 0.01]}
    long, short = (
        replace(Scene.load(name), ranges=ranges).sweep().plot().axes
        for name in ("curling-take-out", "air-table")
    )
    assert (len(long), len(short)) == (2, 1)
    whole, close = (np.diff(axes.get_xlim())[0] for axes in long)
    assert close < 0.6 * whole
    assert long[1].get_title("left").startswith("close-up; ")

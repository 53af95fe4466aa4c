"""Pictures leave nothing out in silence: ends are drawn or counted, words inside, all is seen."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from matplotlib.collections import QuadMesh
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.text import Text
from scenes import sweep_scene

from puck_tables import (
    Drag,
    Floor,
    InputError,
    Launch,
    Normal,
    Post,
    Puck,
    Scene,
    Track,
    Uniform,
    Wall,
)
from puck_tables._core.colours import LEAST_CONTRAST, contrast, on_white
from puck_tables.plot import (
    board_ends_figure,
    floor_axes,
    sample_figure,
    scene_map_figure,
    style,
    tradeoff_figure,
)
from puck_tables.plot.animation import PALETTE, colour_of
from puck_tables.results import Map
from puck_tables.scene.run import ENDS, LAST_END

LONG = "Of a title that goes on and on, as of whoever names all that there is in a scene, " * 3
WORD = "x" * 150 + " " + "W" * 300


def drawn_ends(figure: Figure) -> tuple[int, int]:
    """How many marks of ends in play, and of those that left play, the first panel bears."""
    lines = [line for line in figure.axes[0].lines if line.get_linestyle() == "None"]
    stay, left = (
        sum(len(line.get_xdata()) for line in lines if line.get_marker() == marker)
        for marker in (".", "x")
    )
    return stay, left


def a_map(pucks: int, rng: np.random.Generator, shape: tuple[int, ...]) -> Map:
    """A map with ends of all kinds, drawn: of pucks in play, of such that left, and none."""
    pieces = [
        Puck(0.03, friction=0.1, name=f"{n} {WORD[: 40 * n]}", launch=Launch(position=(n, 0.0)))
        for n in range(pucks)
    ]
    ranges = {f"puck[0].launch.{name}": np.linspace(0.1, 1.0, n)
              for name, n in zip(("spin", "orientation"), shape, strict=False)}  # fmt: skip
    scene = Scene(pucks=pieces, title=LONG, ranges=ranges)
    end = rng.integers(0, len(ENDS), shape).astype(np.int8)
    end.flat[rng.integers(end.size)] = 0
    columns = {name: rng.normal(size=(*shape, pucks)) for name in ("x", "y")}
    columns["in_play"] = rng.integers(0, 2, (*shape, pucks)).astype(float)
    for values in columns.values():
        values[end > LAST_END] = np.nan
    names = tuple(piece.name for piece in pieces)
    return Map(scene=scene, names=names, columns=columns, end=end)


@pytest.mark.parametrize("pucks", [1, 3, 11])
def test_every_end_of_a_board_is_drawn_or_counted(pucks: int) -> None:
    rng = np.random.default_rng(pucks)
    ends = a_map(pucks, rng, (17, 13))
    figure = ends.plot()
    ended = int((ends.end <= LAST_END).sum())
    stay, left = drawn_ends(figure)
    assert stay == (ends.columns["in_play"] == 1.0).sum()
    assert stay + left == ended * pucks
    told = [text.get_text() for text in figure.legends[0].get_texts()]
    counts = [int(n) for words in told for n in re.findall(r"(\d+) (?:in|left) play", words)]
    assert sum(counts) == ended * pucks
    note = figure.axes[0].get_title("left")
    assert f"{ends.end.size - ended} of {ends.end.size} runs without an end" in note
    ends.end[...] = LAST_END + 1
    with pytest.raises(InputError, match="nothing to draw"):
        ends.plot()


def test_a_close_up_tells_what_lies_outside() -> None:
    ends = a_map(2, np.random.default_rng(5), (200,))
    for name in ("x", "y"):
        ends.columns[name][3:] *= 1e-3  # but three runs
    ends.columns["x"][np.isfinite(ends.columns["x"])] += 40.0  # far along a sheet
    ends.columns["in_play"][ends.end <= LAST_END] = 1.0
    figure = ends.plot()
    assert len(figure.axes) == 2
    x, y = (ends.columns[name].ravel() for name in ("x", "y"))
    (left, right), (low, high) = figure.axes[1].get_xlim(), figure.axes[1].get_ylim()
    beyond = np.isfinite(x) & ~((x >= left) & (x <= right) & (y >= low) & (y <= high))
    told = f"{beyond.sum()} of {np.isfinite(x).sum()} ends lie outside"
    assert told in figure.axes[1].get_title("left")


def gaussian(rng: np.random.Generator, count: int, ratio: float) -> np.ndarray:
    turn = rng.uniform(0.0, np.pi)
    turned = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    return np.asarray(turned @ (rng.normal(size=(2, count)) * [[1.0], [ratio]]))


@pytest.mark.parametrize("ratio", [1.0, 0.1, 0.01])
def test_the_lines_about_a_cloud_hold_what_they_say_however_thin_it_is(ratio: float) -> None:
    """Of a normal distribution they are ellipses: half of it within 1.18 deviations."""
    rng = np.random.default_rng(int(1 / ratio))
    for count in (1000, 20000):
        own = gaussian(rng, count, ratio)
        far = np.sqrt(np.einsum("in,ij,jn->n", own, np.linalg.inv(np.cov(own)), own))
        cloud = sample_figure.cloud_of(own[0] + 3.0, own[1])
        assert cloud is not None
        for held in (0.5, 0.95):
            inside = cloud.at_samples > np.quantile(cloud.at_samples, 1.0 - held)
            truly = far < np.sqrt(-2.0 * np.log(1.0 - held))
            assert (inside != truly).mean() < 0.08
        (x, y), cells = cloud.corners, cloud.density.size
        area = abs(
            np.diff(x, axis=0)[0, 0] * np.diff(y, axis=1)[0, 0]
            - np.diff(x, axis=1)[0, 0] * np.diff(y, axis=0)[0, 0]
        )
        assert cells > 10_000 and cloud.density.sum() * area == pytest.approx(1.0, abs=0.02)


def test_every_sample_is_in_sight_or_counted() -> None:
    rng = np.random.default_rng(3)
    found = Puck.similar().sample(
        400, 7, speed=Normal(1.0, 0.1), heading=Uniform(0.0, 0.5), spin=2.0
    )
    columns = found._own.columns
    for lost, far in ((0, 0), (30, 1)):
        columns["stop_x"].values[:lost] = np.nan
        columns["stop_y"].values[lost : lost + far] = 1e3 * rng.uniform(1.0, 2.0)
        figure = found.plot()
        panel = figure.axes[0]
        title, note = figure.get_suptitle(), panel.get_title("left")
        assert title.startswith(
            f"{400 - lost} samples" + f" and {lost} without an end" * (lost > 0)
        )
        assert (f"{far} of {400 - lost} samples lie outside" in note) == (far > 0)
        mesh = next(c for c in panel.collections if isinstance(c, QuadMesh))
        single = next(line for line in panel.lines if line.get_label() == "single samples")
        shown = np.isfinite(found.stop_x) & (np.abs(found.stop_y) < 10.0)
        cloud = sample_figure.cloud_of(found.stop_x[shown], found.stop_y[shown])
        assert cloud is not None and mesh.get_array() is not None
        bare = cloud.at_samples < sample_figure._COVERED * cloud.density.max()
        assert len(single.get_xdata()) == bare.sum() and shown.sum() == 400 - lost - far


@pytest.mark.parametrize("count", [2, 9, 49])
def test_few_samples_are_all_drawn(count: int) -> None:
    figure = Puck.similar().sample(count, count, speed=1.0, spin=Normal(0.0, 3.0)).plot()
    single = next(one for one in figure.axes[0].lines if one.get_label() == "single samples")
    assert len(single.get_xdata()) == count
    assert figure.axes[0].get_title("left") == "x and y of different scale"  # none lies outside
    assert figure.get_suptitle().endswith("launch_spin normal:0.0:3.0 rad/s")


def words(figure: Figure) -> Iterator[Text]:
    """All that is written but the numbers at axes."""
    legends = [axes.get_legend() for axes in figure.axes] + list(figure.legends)
    found = [text for legend in legends if legend for text in legend.get_texts()]
    for axes in figure.axes:
        found += [axes.title, axes._left_title, axes._right_title]  # type: ignore[attr-defined]
        found += [axes.xaxis.label, axes.yaxis.label, *axes.texts]
    found += [figure._suptitle] if figure.get_suptitle() else []  # type: ignore[attr-defined]
    yield from (text for text in found if text.get_text().strip() and text.get_visible())


def all_is_legible(figure: Figure) -> None:
    """No word leaves the picture, no title lies on another, no line is too pale on white."""
    figure.draw_without_rendering()
    told = list(words(figure))
    boxes = [text.get_window_extent() for text in told]
    for text, box in zip(told, boxes, strict=True):
        assert box.x0 >= -1.0 and box.x1 <= figure.bbox.x1 + 1.0, text.get_text()
        assert box.y0 >= -1.0 and box.y1 <= figure.bbox.y1 + 1.0, text.get_text()
        assert contrast(to_hex(text.get_color())) >= LEAST_CONTRAST, text.get_text()
    for (one, box), (two, other) in itertools.combinations(zip(told, boxes, strict=True), 2):
        shared = box.padded(-1.0).overlaps(other.padded(-1.0))
        assert not shared, (one.get_text(), two.get_text())
    for line in (line for axes in figure.axes for line in axes.lines):
        if len(line.get_xdata()) and line.get_color() != "white":  # a mark on a dark disc
            assert contrast(to_hex(line.get_color())) >= LEAST_CONTRAST, line.get_label()


def of_a_puck() -> Iterator[Any]:
    puck = Puck(0.0123456789, 0.0123456, 0.1234567, 0.1, 9.8123456, gyration=0.51234567)
    yield puck.simulate((1.23456789, -1.23456789), 123.456789)
    yield puck.simulate((0.0, 0.0), 9.0)
    yield puck.stop((1.0, 0.0), [1.0, 20.0, 300.0])
    yield puck.states((1.0, 0.0), 20.0, [0.0, 0.1, 9.0])
    for spins, speeds in (([3.0], [1.0]), ([3.0], np.linspace(0.0, 1.0, 9)), ([5.0, 1.0, 3.0], 1.0),
                          (np.linspace(0.0, 9.0, 12)[::-1], np.linspace(0.0, 1.0, 9))):  # fmt: skip
        yield puck.sweep(spins, speeds)
    middles = {"vx": 1.23456789, "vy": 0.12345678, "spin": 30.1234567}
    many = {name: Normal(value, 0.123456 * value) for name, value in middles.items()}
    yield puck.sample(100, 3, **many)
    yield puck.sample(9, 3, vx=1.0, spin=Uniform(0.0, 1e-9))
    yield puck.limit_surface()


def of_tracks() -> Iterator[Any]:
    from puck_tables.plot.track_figure import draw

    time, place = np.arange(9.0), np.random.default_rng(1).normal(size=(9, 2))
    place[3] = np.nan
    for count in (1, 5, 40):
        yield draw([Track(time, place + n, name=f"{n} {WORD}") for n in range(count)])


def of_boards() -> Iterator[Any]:
    for pucks in (2, 9):
        ends = a_map(pucks, np.random.default_rng(pucks), (9,))
        yield ends
        walls = [Wall((-0.5, 0.0), normal=(1.0, 0.0)), Wall((90.0, 0.0), normal=(-1.0, 0.0))]
        posts = [Post((float(pucks) + 1.0, 0.3), 0.05)]
        scene = Scene(pucks=ends.scene.pucks, walls=walls, posts=posts, title=WORD)
        yield scene.simulate()


def of_a_scene() -> Iterator[Any]:
    tables: dict[str, Any] = {
        "title": LONG, "puck": {"radius": 0.02, "friction": 0.3},
        "floor": {"strips": {"borders": [0.1 * n for n in range(1, 12)],
                             "friction": [0.1 + 0.012345 * n for n in range(12)]}},
        "wall": [{"point": [9.0, 0.0], "normal": [-1.0, 0.0]}],
        "launch": {"velocity": [1.0, 0.2]}, "drag": {"sliding": 0.01},
        "force": {"constant": [0.01, 0.0], "torque": 1e-5}, "tol": 1e-6,
    }  # fmt: skip
    yield Scene.from_tables(tables).simulate()
    ranged = {**tables, "launch": {"velocity": ["0.5:1:2", 0.2], "spin": [3.0, 1.0, 2.0]}}
    yield sweep_scene(ranged)
    yield sweep_scene({**tables, "launch": {"velocity": [1.0, 0.2], "spin": [3.0]}})


@pytest.mark.thorough
@pytest.mark.parametrize("kind", [of_a_puck, of_tracks, of_boards, of_a_scene])
def test_all_is_legible_whatever_it_is_called(kind: Any) -> None:
    for result in kind():
        all_is_legible(result if isinstance(result, Figure) else result.plot())


def test_what_is_out_of_sight_is_said() -> None:
    near, far = Wall((-0.025, 0.0), normal=(1.0, 0.0)), Wall((0.0, -5e3), normal=(0.0, 1.0))
    puck = Puck(0.02, friction=0.3)
    one = Scene(puck, launch=Launch((0.5, 0.0)), walls=[near, far]).simulate().plot()
    assert one.axes[0].get_title("left") == "out of sight: 1 wall"
    piece = Puck(0.02, friction=0.3, launch=Launch((0.5, 0.0)))
    two = Scene(pucks=[piece], walls=[near, far]).simulate().plot()
    assert two.axes[0].get_title("left") == "out of sight: 1 wall"


def test_how_runs_end_stands_over_the_axis_of_the_curves() -> None:
    floor, drag = Floor(slope=np.linspace(0.0, 0.05, 120)), Drag(sliding=[0.0, 0.1])
    launch = Launch((0.5, 0.0), spin=9.0)
    panels = Scene(Puck(0.04, friction=0.2), floor, launch, drag=drag).sweep().plot().axes
    assert panels[4].get_xlabel() == panels[5].get_xlabel() == "floor.slope / rad"
    assert panels[0].get_xlim() == pytest.approx((0.0, 0.05), abs=1e-3)
    marks = panels[0].lines[-1].get_xdata()
    assert 60 <= len(marks) <= 80  # of 240 that end alike: they hide no curve


def test_every_colour_is_seen_on_white() -> None:
    rng = np.random.default_rng(4)
    shares = np.linspace(0.0, 1.0, 20)
    fixed = [
        style.BLUE, style.GREY, *style.COLORS, floor_axes._MOVING, *tradeoff_figure._MORE_COLORS,
    ]  # fmt: skip
    fixed += [colour for colour, _ in scene_map_figure._LOOKS]
    fixed += [to_hex(style.shaded(share)) for share in shares]
    fixed += [to_hex(style.ramp()(share)) for share in shares]
    fixed += [on_white(colour_of(n)) for n in range(3 * len(PALETTE))]
    fixed += [on_white(f"#{n:06x}") for n in rng.integers(0, 1 << 24, 200).tolist()]
    assert min(map(contrast, [*fixed, on_white("white")])) >= LEAST_CONTRAST
    assert board_ends_figure.on_white("#0072b2") == "#0072b2"  # what is seen stays


def test_contrast_is_that_of_the_standard() -> None:
    """The example that WCAG is quoted with: #777777 on white is 4.48."""
    assert contrast("#777777") == pytest.approx(4.48, abs=0.005)
    assert contrast("black") == 21.0

"""Pictures show what was computed: the motion itself, all that is in the plane, and how it ends."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.collections import QuadMesh
from matplotlib.figure import Figure
from matplotlib.ticker import ScalarFormatter
from pucks import simulate, sweep
from rarely import few, nightly, thorough
from scenes import simulate_scene, sweep_scene

from puck_tables.chetaev.asperity_forces import asperity_curve
from puck_tables.chetaev.wavy_support import Asperity
from puck_tables.errors import InputError, OutputError
from puck_tables.motion import limit_ratio
from puck_tables.plot import style
from puck_tables.scene.library import find_scene
from puck_tables.scene.run import ENDS


@pytest.fixture
def drawn(tmp_path: Path) -> Any:
    """Draws into a file, and gives the figure that was saved."""
    return lambda result: result.plot(tmp_path / f"{len(list(tmp_path.iterdir()))}.png")


def words(figure: Figure) -> set[str]:
    legends = [axes.get_legend() for axes in figure.axes] + list(figure.legends)
    return {text.get_text() for legend in legends if legend for text in legend.get_texts()}


def marks(axes: Any, look: dict[str, Any]) -> list[tuple[float, float]]:
    """Where a panel bears a mark."""
    return [
        (float(line.get_xdata()[0]), float(line.get_ydata()[0]))
        for line in axes.lines
        if line.get_marker() == look["marker"] and line.get_color() == look["color"]
        and len(line.get_xdata()) == 1
    ]  # fmt: skip


def curve(axes: Any) -> np.ndarray:
    """The longest line of a panel, (n, 2)."""
    return np.asarray(max((line.get_xydata() for line in axes.lines), key=len))


@pytest.mark.parametrize(
    "asked",
    [{"times": [3.0, 1.0, 2.0, 0.0]}, *map(thorough, ({"times": [0.5, 1.0, 1.5]}, {"frames": 1}))],
)
def test_a_trajectory_is_drawn_whole_whatever_states_it_has(drawn: Any, asked: Any) -> None:
    run = simulate((1.0, 0.3), 5.0, **asked)
    figure = drawn(run)
    path = figure.axes[0]
    assert marks(path, style.LAUNCH) == [(0.0, 0.0)]
    assert marks(path, style.STOP) == [run.stop_position]
    fine = simulate((1.0, 0.3), 5.0, frames=2001)
    line = curve(path)
    gap = np.hypot(line[:, None, 0] - fine.x, line[:, None, 1] - fine.y).min(axis=0)
    assert gap.max() < run.path_length / 500  # half the way between two of its points
    time = curve(figure.axes[1])[:, 0]
    assert np.all(np.diff(time) > 0.0) and time[-1] == run.stop_time


def test_few_frames_do_not_cut_a_bouncing_path_off_its_walls(drawn: Any) -> None:
    tables = find_scene("air-hockey")
    tables["frames"] = 3
    run = simulate_scene(tables)
    figure = drawn(run)
    line = curve(figure.axes[0])
    bounces = [event for event in run.events if event.what == "impact"]
    assert len(bounces) > 3
    radius = run.scene.puck.radius
    for event in bounces:  # its rim is there
        away = np.hypot(line[:, 0] - event.x, line[:, 1] - event.y)
        assert away.min() == pytest.approx(radius, abs=1e-12)
    assert marks(figure.axes[0], style.LAUNCH) == [(0.4, 0.3)]
    assert marks(figure.axes[0], style.STOP) == [(run.last["x"], run.last["y"])]
    speed = curve(figure.axes[1])  # which leaps at an impact
    leap = np.flatnonzero(np.diff(speed[:, 0]) < 1e-12)
    assert len(leap) >= len(bounces) and np.abs(np.diff(speed[:, 1])[leap]).max() > 0.3


@pytest.mark.thorough
def test_a_path_of_many_turns_is_round(drawn: Any) -> None:
    tables = {
        "puck": {"radius": 0.02, "friction": 0.5}, "floor": {"turning": 9.0},
        "launch": {"position": [0.05, 0.0], "velocity": [0.0, 0.45], "spin": 9.0},
        "time": 60.0, "frames": 5,
    }  # fmt: skip
    figure = drawn(simulate_scene(tables))
    line = curve(figure.axes[0])
    assert np.abs(np.hypot(line[:, 0], line[:, 1]) - 0.05).max() < 1e-6
    assert np.hypot(*np.diff(line, axis=0).T).max() < 0.05 * 2.0 * np.pi / 50


WORDS = {
    "turntable": "floor: turntable 5 rad/s", "washer-on-conveyor": "floor: belt (0.5, 0) m/s",
    "coin-on-rail": "rail", "pivoted-disc": "pivot", "skate-blade": "blade",
    "incline": "downhill, slope 0.1 rad", "wet-patch": "f = 0.06", "shuffleboard": "edge",
    "air-hockey": "wall",
}  # fmt: skip


@pytest.mark.parametrize("name", few(2, WORDS))
def test_all_that_is_in_the_plane_is_labelled_and_no_legend_lies_on_a_panel(drawn, name):
    figure = drawn(simulate_scene(name))
    assert {WORDS[name], "launch"} <= words(figure)
    _legends_stand_outside(figure)


def _legends_stand_outside(figure: Figure) -> None:
    figure.draw_without_rendering()
    legends = [axes.get_legend() for axes in figure.axes] + list(figure.legends)
    boxes = [legend.get_window_extent() for legend in legends if legend]
    assert boxes
    for box in boxes:
        assert not any(box.overlaps(axes.get_window_extent()) for axes in figure.axes)
        assert figure.bbox.x0 <= box.x0 and box.x1 <= figure.bbox.x1
        assert figure.bbox.y0 <= box.y0 and box.y1 <= figure.bbox.y1


def test_what_pulls_is_labelled(drawn: Any, tmp_path: Path) -> None:
    (tmp_path / "force.csv").write_text("t,Fx,Fy\n0,0.1,0\n1,0,0\n")
    tables = {
        "puck": {"radius": 0.02, "friction": 0.5},
        "launch": {"velocity": [1.0, 0.0]}, "drag": {"sliding": 0.1},
        "force": {"constant": [0.1, 0.2], "torque": 1e-3, "over_time": str(tmp_path / "force.csv")},
    }  # fmt: skip
    run = simulate_scene(tables)
    figure = drawn(run)
    assert "force (0.1, 0.2) N" in words(figure)
    title = figure.axes[0].get_title("left")
    assert title == "also acting: drag, force over time, torque 0.001 N m"
    (tmp_path / "force.csv").write_text("t,Fx,Fy\n0,0.5,0\n1,0,0\n")
    with pytest.raises(InputError, match="has changed since the run"):
        drawn(run)


@pytest.mark.parametrize("delta", [0.0, 0.5])
def test_no_axis_has_an_offset_or_shows_rounding(drawn: Any, delta: float) -> None:
    ratio = float(limit_ratio(delta))
    figure = drawn(simulate((1.0, 0.0), ratio, delta=delta))
    for axes in figure.axes:
        for axis in (axes.xaxis, axes.yaxis):
            formatter = axis.get_major_formatter()
            assert isinstance(formatter, ScalarFormatter) and formatter.offset == 0
    low, high = figure.axes[2].get_ylim()  # the ratio, which is constant
    assert low < 1.0 / ratio < high and high - low > 0.01 / ratio


def incline(slopes: str, spins: str) -> Any:
    tables = find_scene("incline")
    tables["floor"]["slope"], tables["launch"]["spin"] = slopes, spins
    return sweep_scene(tables)


@pytest.mark.thorough
def test_few_values_are_curves_with_marks_for_ends(drawn: Any) -> None:
    stops = incline("0:0.2:5", "0:80:9")
    figure = drawn(stops)
    assert {"at rest", "no end found", "floor.slope: 0.15 rad"} <= words(figure)
    assert not any(isinstance(c, QuadMesh) for c in figure.axes[0].collections)
    _legends_stand_outside(figure)
    plain = drawn(sweep(np.linspace(0, 5, 9), np.array([1.0, 2.0]), delta=0.3))
    assert len(plain.axes[0].lines) == 2 and not plain.axes[0].collections
    _legends_stand_outside(plain)


@pytest.mark.parametrize("ranges", [("0:0.2:9", "0:80:9"), thorough(("0.05:0.2:9", "10:20:2"))])
def test_maps_tell_ends_apart(drawn: Any, ranges: tuple[str, str]) -> None:
    stops = incline(*ranges)
    figure = drawn(stops)
    assert {"at rest", "no end found"} <= words(figure)
    mesh = next(
        c for axes in figure.axes if axes.get_title() == "how it ends"
        for c in axes.collections if isinstance(c, QuadMesh)
    )  # fmt: skip
    curves = ranges[1] == "10:20:2"  # over the slope
    end = stops.end.T if curves else stops.end
    assert np.array_equal(np.asarray(mesh.get_array()).reshape(end.shape), end)
    assert mesh.axes.get_xlabel() == ("floor.slope / rad" if curves else "launch.spin / rad/s")
    colors = mesh.cmap(mesh.norm(np.arange(len(ENDS))))
    assert len({tuple(color) for color in colors}) == len(ENDS)


TITLES = ["$x_1^{", "a $\\frac{1}{2}$ b", "\N{ICE HOCKEY STICK AND PUCK} \u05d0"]


@pytest.mark.thorough
@pytest.mark.parametrize("title", TITLES)
def test_titles_are_drawn_as_they_stand(drawn: Any, title: str) -> None:
    tables = find_scene("incline")
    tables["title"] = title
    figure = drawn(simulate_scene(tables))
    assert figure.get_suptitle().startswith(f"{title}: at rest after")
    tables["launch"]["spin"] = "0:60:3"
    assert drawn(sweep_scene(tables)).get_suptitle() == title


@pytest.mark.thorough
def test_the_examples_of_asperity_show_all_that_happens() -> None:
    from puck_tables.cli.asperity import asperity

    found = re.findall(r"puck asperity .*?(?=puck asperity|$)", asperity.help, re.DOTALL)
    assert len(found) == 3
    for example in found:
        given = dict(re.findall(r"--(\w+) (\S+)", example))
        length = float(given.get("wavelength", 2e-5)) / (2.0 * np.pi)
        load = float(given.get("load", 1.0))
        bumps = Asperity(float(given.get("amplitude", 1e-6)), length, load, load / 9.80665)
        start, stop, count = given.get("speeds", f"0:{2.5 * bumps.lift_speed}:501").split(":")
        speeds = np.linspace(float(start), float(stop), int(count))
        curves = asperity_curve(bumps, speeds)
        between = asperity_curve(bumps, 0.5 * (speeds[1:] + speeds[:-1]))
        for name in ("mean", "greatest"):
            values = getattr(curves, name)
            error = np.abs(getattr(between, name) - 0.5 * (values[1:] + values[:-1]))
            assert (error / curves.crude[1:]).max() < 0.02, (example, name)
    coarse = asperity_curve(bumps, np.linspace(0.0, 7.0 * bumps.lift_speed, 201))
    assert coarse.leaps > 20 and curves.leaps == 0


KINDS = [
    ".png", *map(thorough, (".html", ".svg", ".pdf")),
    nightly(".gif"),
]  # fmt: skip


@pytest.mark.parametrize("kind", KINDS)
def test_a_picture_is_drawn_again_and_nothing_else_is_replaced(kind: str, tmp_path: Path) -> None:
    rng = np.random.default_rng(len(kind))
    path = tmp_path / f"a{kind}"
    for speed in rng.uniform(0.5, 2.0, 2):
        run = simulate((speed, 0.3), 5.0, frames=3)
        make = run.movie if kind in (".html", ".gif") else run.plot
        before = path.read_bytes() if path.exists() else b""
        make(path)
        assert len(path.read_bytes()) > 100 and path.read_bytes() != before
    numbers = "\n".join(",".join(f"{x:.6g}" for x in row) for row in rng.normal(size=(20, 3)))
    page = f"<!DOCTYPE html><html><head></head><body>{numbers}</body></html>"
    for content in (numbers.encode(), page.encode(), rng.bytes(300), b"%PDF-1.4\n" + rng.bytes(99)):
        path.write_bytes(content)
        with pytest.raises(OutputError, match="exists already"):
            make(path)
        assert path.read_bytes() == content
    make(path, overwrite=True)
    path.write_bytes(b"")  # as tempfile makes them
    make(path)
    assert path.stat().st_size > 100


def test_an_odd_backend_of_matplotlib_is_said(tmp_path: Path) -> None:
    """Pictures need none, but matplotlib does not start."""
    code = "import puck_tables as pt; pt.Puck.similar().simulate((1, 0)).plot('a.png')"
    ended = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=False,
        env={**os.environ, "MPLBACKEND": "nonsense"},
    )  # fmt: skip
    assert "InputError: matplotlib does not start: MPLBACKEND = 'nonsense'" in ended.stderr
    assert not list(tmp_path.iterdir())

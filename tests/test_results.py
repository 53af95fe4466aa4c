"""Every result can be saved, drawn, compared, pickled, and handed to xarray and pandas."""

from __future__ import annotations

import json
import math
import pickle
from collections.abc import Callable
from dataclasses import FrozenInstanceError, replace
from functools import cache, partial
from pathlib import Path

import numpy as np
import pandas
import pytest
import xarray
from matplotlib.figure import Figure
from scenes import simulate_scene, sweep_scene

from puck_tables import Puck, floor_friction, reference_case, states, stop
from puck_tables._core.lazy import above, names_above
from puck_tables.accuracy.method_errors import shipped_errors
from puck_tables.chetaev import Asperity, asperity_curve
from puck_tables.errors import ContactError, InputError, OutputError
from puck_tables.io.columns import COLUMNS
from puck_tables.io.formats import FORMATS
from puck_tables.result import Result
from puck_tables.tradeoff.measurement import TradeOff

PUCK = Puck.similar(delta=0.8)
SCENE = {
    "puck": {"radius": 0.04, "friction": 0.1},
    "launch": {"velocity": [1.0, 0.0], "spin": 20.0},
    "wall": [{"point": [0.3, 0.0], "normal": [-1.0, 0.0], "restitution": 0.5}],
}  # fmt: skip
RANGED = {**SCENE, "launch": {"velocity": ["0.5:1:3", 0.0], "spin": "0:20:4"}}
BOARD = {
    "puck": [
        {"radius": 0.04, "friction": 0.1, "launch": {"velocity": [1.0, 0.0], "spin": 20.0}},
        {"radius": 0.03, "friction": 0.2, "launch": {"position": [0.2, 0.01]}, "name": "other"},
    ],
    "wall": SCENE["wall"],
}
COUNTS = np.array([1, 2])
RESULTS: dict[str, Callable[[], Result]] = {
    "trajectory": lambda: PUCK.simulate((1.0, 0.2), 3.0),
    "stops": lambda: stop((1.0, 0.0), [[0.0, 1.0, 4.0], [2.0, 3.0, -1.0]], delta=0.8),
    "states": lambda: states((1.0, 0.0), 3.0, [0.1, 0.5, 0.2]),
    "map": lambda: PUCK.sweep(np.linspace(0.0, 4.0, 9), np.linspace(0.1, 1.0, 10)),
    "curve": lambda: PUCK.sweep(np.linspace(0.0, 4.0, 9), 1.0), "aim": lambda: PUCK.aim((2.0, 0.1)),
    "scene": lambda: simulate_scene(SCENE), "board": lambda: simulate_scene(BOARD),
    "scene map": lambda: sweep_scene(RANGED), "case": lambda: reference_case("coin"),
    "case of two": lambda: reference_case("take-out"),
    "friction over epsilon": lambda: floor_friction("coin"),
    "asperity": lambda: asperity_curve(Asperity(1.0, 4.0, 1.0, 1.0), np.linspace(0.0, 9.0, 30)),
    "trade-off": lambda: TradeOff(shipped_errors(), {"processor": "one"}, 1, 1.0),
}  # fmt: skip


@cache
def made(name: str) -> Result:
    return RESULTS[name]()


@pytest.mark.parametrize("name", RESULTS)
def test_it_is_drawn_whole_and_on_axes_of_others(name: str, tmp_path: Path):
    figure = made(name).plot(tmp_path / "picture.svg")
    assert isinstance(figure, Figure) and figure.axes
    assert (tmp_path / "picture.svg").stat().st_size > 1000
    own = Figure()
    panel = own.add_subplot(1, 2, 2)
    assert made(name).plot(ax=panel) is own
    assert panel.has_data()
    with pytest.raises(InputError, match="ending"):
        made(name).plot(tmp_path / "picture.gif")


@pytest.mark.parametrize("name", RESULTS)
@pytest.mark.parametrize("ending", FORMATS)
def test_files_of_every_format_hold_the_same_table(name: str, ending: str, tmp_path: Path):
    result, path = made(name), tmp_path / f"result{ending}"
    result.save(path)
    with pytest.raises(OutputError, match="exists"):
        result.save(path)
    frame = result.to_pandas()
    if ending == ".h5":
        with xarray.open_dataset(path, engine="h5netcdf") as data:
            for column, one in result.dataset().columns.items():
                np.testing.assert_array_equal(data[column].values, one.values)
                assert data[column].attrs["units"] == (one.unit or "1")
        return
    if ending == ".json":
        columns = json.loads(path.read_text())["columns"]
        for column, one in result.dataset().columns.items():
            mine = one.readable()
            if mine.dtype.kind == "f":  # null: no number
                mine = np.where(np.isfinite(mine), mine, np.nan)
            told = np.asarray(columns[column]["values"], mine.dtype)
            np.testing.assert_array_equal(told, mine)
            assert columns[column]["unit"] == one.unit
        return
    readers = {
        ".csv": partial(pandas.read_csv, keep_default_na=False, na_values=["nan"]),
        ".parquet": pandas.read_parquet,
        ".jsonl": partial(pandas.read_json, lines=True),
    }
    read = readers[ending](path)
    read.columns = [column.partition("[")[0] for column in read.columns]
    assert list(read.columns) == list(frame.columns)
    for column in frame.columns:
        if frame[column].dtype.kind == "f":
            np.testing.assert_allclose(read[column].astype(float), frame[column], rtol=1e-9)
        else:
            assert read[column].astype(str).tolist() == frame[column].astype(str).tolist()


@pytest.mark.parametrize("name", RESULTS)
def test_it_equals_itself_made_again_and_nothing_else(name: str):
    one, again = made(name), pickle.loads(pickle.dumps(made(name)))
    assert one == again and repr(one) == repr(again)
    others = [made(other) for other in RESULTS if other != name]
    assert all(one != other for other in others) and one != 3
    assert made("trajectory") != PUCK.simulate((1.0, 0.2), math.nextafter(3.0, 4.0))


@pytest.mark.parametrize("name", RESULTS)
def test_it_tells_of_itself_in_a_line_and_in_a_notebook(name: str):
    result = made(name)
    assert len(repr(result)) <= 130 and "\n" not in repr(result)
    assert "<table>" in result._repr_html_()
    assert result.explain()
    data = result.to_xarray()
    assert set(result.dataset().columns) == set(data.data_vars)


@pytest.mark.parametrize("name", names_above("report of "))
def test_what_is_told_of_a_result_is_there(name: str):
    assert callable(above(name))


def test_columns_of_one_name_are_one_quantity():
    for name in RESULTS:
        dataset = made(name).dataset()
        for column, one in {**dataset.axes, **dataset.columns}.items():
            if column in COLUMNS:  # ranges of scenes have names of their own
                assert one.unit == COLUMNS[column].unit, (name, column)


def test_pickles_hold_results_only():
    assert len(pickle.dumps(stop((1.0, 0.0), np.linspace(0.0, 5.0, 6)))) < 5000


def test_a_run_is_called_for_its_state_at_any_time():
    free, scene = made("trajectory"), made("scene")
    for run in (free, scene):
        assert run(run.time[[1, 3]]).x.tolist() == pytest.approx(run.x[[1, 3]].tolist(), abs=1e-9)  # type: ignore[operator,attr-defined]
        for name in ("x", "y", "vx", "vy", "speed", "heading", "orientation", "spin"):
            assert getattr(run, name).shape == run.time.shape  # type: ignore[attr-defined]
    speed = np.hypot(scene.vx, scene.vy)  # type: ignore[attr-defined]
    np.testing.assert_array_equal(scene.speed, speed)  # type: ignore[attr-defined]
    with pytest.raises(AttributeError, match="no colour"):
        scene.colour  # type: ignore[attr-defined]  # noqa: B018
    with pytest.raises(AttributeError, match="no orientaton \\(did you mean 'orientation'\\?\\)"):
        scene.orientaton  # type: ignore[attr-defined]  # noqa: B018


def test_a_puck_is_a_value():
    puck = Puck(0.0381, 0.0254, 0.1, mass=0.17)
    assert puck == Puck(np.float64(0.0381), 0.0254, np.float32(0.1).astype(float) * 0 + 0.1, 0.17)
    assert puck != replace(puck, mass=0.2) and len({puck, replace(puck)}) == 1
    assert pickle.loads(pickle.dumps(puck)) == puck
    with pytest.raises(FrozenInstanceError):
        puck.mass = 1.0  # type: ignore[misc]
    assert puck.delta == 2.0 * 0.1 * 0.0254 / 0.0381 and puck.decel == 0.1 * 9.80665
    similar = Puck.similar(delta=puck.delta, decel=puck.decel, radius=puck.radius, mass=0.17)
    one, two = puck.simulate((2.0, 0.0), 30.0), similar.simulate((2.0, 0.0), 30.0)
    assert one.stop_time == pytest.approx(two.stop_time, rel=1e-12)
    assert one.kinetic_energy == two.kinetic_energy
    assert puck.limit_epsilon == 1.0 / puck.limit_ratio


@pytest.mark.parametrize(
    ("given", "error", "words"),
    [
        ({"radius": 0.0}, InputError, "radius = 0.0: must be a number > 0 m"),
        ({"radius": "wide"}, InputError, "radius = 'wide': must be a number"),
        ({"height": -0.1}, InputError, "height = -0.1: must be a number >= 0 m"),
        ({"friction": math.nan}, InputError, "friction = nan: must be a number >= 0"),
        ({"mass": -1.0}, InputError, "mass = -1.0: must be a number > 0 kg"),
        ({"gyration": 20.0}, InputError, "in units of r, from 0.1 to 10 .*, got 20"),
        ({"pressure": "glue"}, InputError, "glue"),
        ({"height": 2.0}, ContactError, "tips"),
        ({"friction": 1e300, "gravity": 1e300}, InputError, "floating point"),
    ],
)
def test_no_puck_is_made_that_cannot_be(given: dict, error: type[Exception], words: str):
    with pytest.raises(error, match=words):
        Puck(**{"radius": 0.5, "height": 0.0, "friction": 0.9, **given})


def test_a_column_that_follows_from_others_stands_in_every_result_that_has_those(tmp_path: Path):
    puck = Puck.similar()
    stops = puck.sweep(spin=[0.0, 5.0], velocity=(1.0, 1.0))
    alone = puck.stop((1.0, 1.0), [0.0, 5.0])
    for result in (stops, alone):
        data = result.to_xarray()
        assert np.array_equal(
            data.stop_distance.values, np.hypot(data.stop_x.values, data.stop_y.values)
        )
        assert result.stop_bearing[0] == pytest.approx(0.25 * math.pi, abs=1e-15)
        assert data.stop_bearing.units == "rad"
        with pytest.raises(AttributeError, match="no stop_colour"):
            _ = result.stop_colour
    stops.save(tmp_path / "stops.csv")
    assert "stop_distance[m]" in (tmp_path / "stops.csv").read_text().splitlines()[0]
    run = simulate_scene({"puck": {"radius": 0.1, "friction": 0.1}, "launch": {"velocity": [3, 4]}})
    heading = run.to_xarray().heading.values[0]
    assert run.speed[0] == 5.0 and heading == pytest.approx(math.atan2(4.0, 3.0), abs=1e-15)

"""The knob: what is asked for is held at adversarial starts, and it says what it took, and why."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import numpy as np
import pytest
from commands import invoke
from mpmath import mp
from pucks import simulate, sweep
from rarely import nightly

from puck_tables import Table, stop
from puck_tables.accuracy.method_errors import (
    MARGIN,
    errors_from_csv,
    pareto,
    select,
    shipped_errors,
)
from puck_tables.accuracy.methods import INTEGRATED, LOOK_UP
from puck_tables.errors import AccuracyError, InputError, TableError
from puck_tables.stopping.stop_table import StopTable
from puck_tables.tradeoff.scipy_methods import BODIES

GOLDEN = Path(__file__).parent / "golden"
TOLERANCES = 10.0 ** -np.arange(3, 12)


@pytest.fixture(scope="module")
def starts() -> dict[str, np.ndarray]:
    """2000 launches nobody chose a method by: other seed and heights than those that ship."""
    with np.load(GOLDEN / "starts.npz") as file:
        return {name: file[name] for name in file.files}


def launched(starts: dict[str, np.ndarray], seed: int) -> dict[str, np.ndarray]:
    """The starts at random scales, in random directions, with either spin."""
    rng = np.random.default_rng(seed)
    u = starts["u"]
    n = u.size
    k = np.exp(-np.abs(u))
    large = 1.0 / np.hypot(1.0, k)
    q, decel, radius = 10.0 ** rng.uniform(-6, 6, n), 10.0 ** rng.uniform(-3, 3, n), rng.random(n)
    heading, side = rng.uniform(-np.pi, np.pi, n), rng.choice([-1.0, 1.0], n)
    speed = np.where(u > 0.0, k * large, large) * q
    rim = np.where(u > 0.0, large, k * large) * q
    time, place = q / decel, q * q / decel
    x, y = starts["X"] * place, side * starts["Y"] * place
    return {
        "v0": np.stack([speed * np.cos(heading), speed * np.sin(heading)], axis=-1),
        "w0": side * rim / radius,
        "delta": starts["delta"], "decel": decel, "radius": radius,
        "time": time, "place": place, "stop_time": starts["T"] * time,
        "x": x * np.cos(heading) - y * np.sin(heading),
        "y": x * np.sin(heading) + y * np.cos(heading),
    }  # fmt: skip


def errors(one: dict[str, np.ndarray], stop_time, stop_position) -> np.ndarray:
    off = np.hypot(stop_position[..., 0] - one["x"], stop_position[..., 1] - one["y"])
    return np.maximum(np.abs(stop_time - one["stop_time"]) / one["time"], off / one["place"])


@pytest.mark.parametrize("tol", TOLERANCES)
def test_no_stop_is_outside_the_tolerance(starts: dict[str, np.ndarray], tol: float):
    one = launched(starts, seed=int(-np.log10(tol)))
    assert starts["u"].size == 2000
    result = stop(
        one["v0"], one["w0"], delta=one["delta"], decel=one["decel"], radius=one["radius"], tol=tol
    )
    assert errors(one, result.stop_time, result.stop_position).max() <= tol
    assert (result.selections[0].scheme == LOOK_UP) == (tol > 5e-10)


@pytest.mark.parametrize("method", ["rk4", "adaptive", "look-up"])
def test_nor_with_a_method_of_one_s_choice(starts: dict[str, np.ndarray], method: str):
    for tol in (1e-3, 1e-5, 1e-7, 1e-9):
        one = launched(starts, seed=1)
        part = {name: values[::5] for name, values in one.items()}
        result = stop(
            part["v0"], part["w0"], delta=part["delta"], decel=part["decel"],
            radius=part["radius"], tol=tol, method=method,
        )  # fmt: skip
        assert result.selections[0].method == method
        assert errors(part, result.stop_time, result.stop_position).max() <= tol


@pytest.mark.parametrize("tol", TOLERANCES)
@pytest.mark.parametrize("step", [10, nightly(1)])
def test_no_trajectory_is_outside_the_tolerance(starts, step, tol):
    """Every tenth start, its own at each tolerance; or all of them."""
    numbers = range((int(-np.log10(tol)) - 3) % step, 2000, step)
    one = launched(starts, seed=99)
    for n in numbers:
        run = simulate(
            one["v0"][n], one["w0"][n], delta=one["delta"][n], decel=one["decel"][n],
            radius=one["radius"][n], tol=tol, frames=1,
        )  # fmt: skip
        single = {name: values[n] for name, values in one.items()}
        error = errors(single, run.stop_time, np.array(run.stop_position))
        assert error <= tol, (n, starts["u"][n], starts["delta"][n])


def test_the_coarsest_cut_is_not_within_the_finest_tolerance(starts: dict[str, np.ndarray]):
    """The test above can fail: a way that is too rough for a tolerance is outside it here."""
    one = launched(starts, seed=4)
    rough = stop(
        one["v0"], one["w0"], delta=one["delta"], decel=one["decel"], radius=one["radius"], tol=0.01
    )
    assert errors(one, rough.stop_time, rough.stop_position).max() > 1e-5


def test_the_cheapest_that_is_close_enough_is_taken():
    for question, methods in (("stop", (LOOK_UP, *INTEGRATED)), ("trajectory", INTEGRATED)):
        for tol in 10.0 ** -np.linspace(2, 12.9, 60):
            taken = select(question, tol, methods)
            assert MARGIN * taken.error <= tol
            rows = [row for row in shipped_errors() if row.question == question]
            (row,) = (r for r in rows if r.scheme == taken.scheme and r.setting == taken.setting)
            for other in rows:
                if other.scheme in methods and other.ns < row.ns:
                    assert MARGIN * other.error > tol


def test_what_it_cannot_reach_it_says():
    for methods, words in (((LOOK_UP,), "closed forms reaches 1e-13"), (INTEGRATED, "1e-13")):
        with pytest.raises(AccuracyError, match=words):
            select("stop", 1e-14, methods)
    with pytest.raises(AccuracyError, match=r"to 0\.01"):
        select("stop", 0.5)
    with pytest.raises(AccuracyError, match="tol must be from 1"):
        stop((1, 0), 1.0, tol=1e-11, table=Table.shipped())
    for options, words in (
        ({"method": "euler"}, "method must be one of"),
        ({"method": "look-up", "table": Table.shipped()}, "needs a table of stops"),
        ({"method": "rk4", "table": Table.shipped("stops")}, "needs a table of resultants"),
    ):
        with pytest.raises(InputError, match=words):
            stop((1, 0), 1.0, **options)


def test_the_shipped_front_is_read_and_damage_is_named():
    ways = shipped_errors()
    questions = {"resultants", "stop", "trajectory", "state", *BODIES}
    assert {way.question for way in ways} == questions
    with pytest.raises(TableError, match="damaged"):
        errors_from_csv("question,method\nstop,look-up\n")
    front = pareto(way for way in ways if way.question == "stop" and not way.outsider)
    assert front[0].scheme == LOOK_UP
    assert front[-1].method == "adaptive, closed forms"


def test_explain():
    def puck(*arguments: str):
        return invoke(*arguments)

    result = puck("sweep", "--w0", "1", "--speed", "1", "--tol", "1e-7", "--explain")
    assert result.exit_code == 0
    for words in (
        "Asked: an error of at most 1e-07",
        "Taken: look-up (powers=",
        "when measured.",
        "A cheaper method, look-up (powers=",
        "A closer method, ",
    ):
        assert words in result.stderr
    assert "Taken" not in result.stdout
    result = puck("simulate", "--v0", "1,0", "--w0", "5", "--tol", "1e-12", "--explain")
    assert "Taken: adaptive, closed forms (local=" in result.stderr
    result = puck("simulate", "--v0", "1,0", "--explain")
    assert "elementary functions" in result.stderr
    result = puck("sweep", "--w0", "1", "--method", "look-up", "--tol", "1e-12")
    assert result.exit_code == 2
    assert result.stderr.startswith("Error: tol must be from 1.")
    result = puck("sweep", "--w0", "1", "--method", "rk4", "--tol", "1e-4", "--explain")
    assert "Taken: rk4" in result.stderr


def test_sweep_and_stop_take_the_same_way():
    for tol in (1e-3, 1e-6, 1e-9, 1e-11):
        grid = sweep([0.5, 2.0], [1.0, 3.0], tol=tol)
        alone = stop((3.0, 0.0), 2.0, tol=tol)
        assert grid.selections == alone.selections
        # to the bit where it is integrated; by look-up a map has all outputs of the whole table
        allowed = tol * np.hypot(3.0, 2.0) if grid.method == "look-up" else 0.0
        assert abs(grid.stop_time[1, 1] - float(alone.stop_time)) <= allowed


def test_a_table_of_one_s_own_is_named_not_closed_forms():
    found = stop((1, 0), 5.0, table=Table.build(accuracy=1e-5), tol=1e-3)
    assert "the table memory" in found.explain()
    assert "closed forms" not in found.explain()
    with pytest.raises(AccuracyError, match=r"the table memory.*give a tol in that range"):
        stop((1, 0), 5.0, table=Table.build(accuracy=1e-5))


def test_a_stop_table_of_one_s_own_is_taken_whole():
    own = StopTable(Table.shipped("stops").values[::6], tolerance=2e-7)
    result = stop((1, 0), 5.0, table=own, tol=1e-3)
    assert result.selections == ()
    assert abs(float(result.stop_time) - 3.96299205) <= 5.2 * own.tolerance
    with pytest.raises(AccuracyError, match="2e-07"):
        stop((1, 0), 5.0, table=own, tol=1e-8)


@pytest.mark.thorough
def test_the_starts_are_what_their_script_computes(starts: dict[str, np.ndarray]):
    """One height of each file again, at full precision."""
    spec = importlib.util.spec_from_file_location("make_starts", GOLDEN / "make_starts.py")
    script = importlib.util.module_from_spec(spec)
    with mp.workdps(15):
        spec.loader.exec_module(script)
        path, seed, count = script.TARGETS[0]
        assert path.name == "starts.npz"
        again = script.table(seed, count, only={3})
    chosen = slice(3 * script.PER_HEIGHT, 4 * script.PER_HEIGHT)
    for name, values in again.items():
        np.testing.assert_allclose(values, starts[name][chosen], rtol=0, atol=1e-14, err_msg=name)
    source = (GOLDEN / "make_starts.py").read_text(encoding="utf-8")
    assert "puck_tables" not in source


@pytest.mark.thorough
def test_the_starts_agree_with_values_known_before():
    spec = importlib.util.spec_from_file_location("make_starts", GOLDEN / "make_starts.py")
    script = importlib.util.module_from_spec(spec)
    with mp.workdps(15):
        spec.loader.exec_module(script)
        found = script.stops(np.array([0.0, -np.inf, np.inf]), 1.0)
    expected = [[0.98647593897, 0.32409372866, -0.04297450852], [1.0, 0.5, 0.0], [0.75, 0.0, 0.0]]
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-11)

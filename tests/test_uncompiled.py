"""Single questions compile nothing, tell what compiled code tells, and give way to it in time."""

from __future__ import annotations

import json
import math
import os
import pickle
import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rarely import few

import puck_tables as pt
from puck_tables._core.arrays import FloatArray
from puck_tables.kernels import as_written, register_blocks, vectors
from puck_tables.kernels import compile as doors
from puck_tables.kernels.compile import Door, inner, kernel, patience
from puck_tables.kernels.patience import here, one_question

LAUNCH = ["simulate", "--v0", "1,0", "--w0", "5"]
PUCK = [sys.executable, "-c", "from puck_tables.cli.start import main; main()"]
COMPILED, AS_WRITTEN = {"NUMBA_DISABLE_JIT": "0"}, {"NUMBA_DISABLE_JIT": "1"}
THOROUGH = pytest.mark.thorough


def run(command: list[str], **environment: str) -> tuple[str, str]:
    """What a command says on stdout and stderr."""
    ended = subprocess.run(
        command, env={**os.environ, **environment}, capture_output=True, text=True, check=True
    )
    return ended.stdout, ended.stderr


def numbers(told: object) -> list[float]:
    """All numbers of a JSON document, in order."""
    if isinstance(told, dict):
        return [one for value in told.values() for one in numbers(value)]
    if isinstance(told, list):
        return [one for value in told for one in numbers(value)]
    return [float(told)] if isinstance(told, int | float) else []


@pytest.mark.parametrize(
    "arguments",
    [
        pytest.param(LAUNCH, id="launch"),
        pytest.param(["simulate", "--scene", "incline"], id="scene"),
        pytest.param(["aim", "--target", "2,0.1", "--w0", "5"], id="aim", marks=THOROUGH),
        pytest.param(["reference", "coin"], id="reference", marks=THOROUGH),
    ],
)
def test_the_command_compiles_nothing(arguments: list[str], tmp_path: Path):
    told, said = run([*PUCK, *arguments, "--json"], NUMBA_CACHE_DIR=str(tmp_path))
    assert "compiling" not in said
    assert not list(tmp_path.iterdir())
    assert len(numbers(json.loads(told))) > 5


# questions to a puck drawn anew, and what is taken of the answers
QUESTIONS = """
def simulated(pt, puck, v, w, at): return puck.simulate(v, w, times=[at]).x
def stopped(pt, puck, v, w, at): return puck.stop(v, w).stop_position
def states(pt, puck, v, w, at): return puck.states(v, w, at).x
def aimed(pt, puck, v, w, at): return puck.aim((0.2 * v[0], 0.1 * v[1])).launch_spin
def scene(pt, puck, v, w, at):
    floor, launch = pt.Floor(slope=0.02), pt.Launch(v, w)
    return pt.Scene(puck, launch=launch, floor=floor).simulate([at]).last["x"]
def board(pt, puck, v, w, at):
    r, there = puck.radius, pt.Launch(position=(2.5 * puck.radius, 0.01 * puck.radius))
    one, two = (pt.Puck(r, friction=0.2, launch=one) for one in (pt.Launch(v, w), there))
    world = pt.Scene(pucks=[one, two]).world()
    for _ in range(6):
        world.advance(at)
    return world.state()
"""
ASKED = """
import json, sys, numpy, puck_tables as pt
from puck_tables.kernels import compile as doors
doors.AT_FIRST *= 4.0  # of a machine that others share: what is asked is how much is computed
(radius, height, friction, vx, vy, spin, at), kind = json.loads(sys.argv[1])
puck = pt.Puck(radius=radius, height=height, friction=friction, **kind)
asked = [simulated, stopped, states, scene]
if not kind and puck.delta < 1.0:
    asked += [aimed, board]
answers = [numpy.ravel(ask(pt, puck, (vx, vy), spin, at)).tolist() for ask in asked]
print(json.dumps([answers, "numba" in sys.modules]))
"""


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("seed", "kind"),
    few(2, [(0, "plain"), (4, "tall"), (1, "plain"), (2, "pressure"), (3, "gyration")]),
)
def test_python_compiles_nothing_and_tells_what_compiled_code_tells(seed, kind, tmp_path):
    """But for aims of other than plain pucks, and boards of them."""
    rng = np.random.default_rng(seed)
    radius, friction = rng.uniform(0.02, 0.1), rng.uniform(0.1, 0.5)
    delta = rng.uniform(1.1, 1.8) if kind == "tall" else rng.uniform(0.2, 0.9)
    drawn = [
        radius, 0.5 * delta * radius / friction, friction, *rng.uniform(0.3, 1.5, 2),
        rng.uniform(-30.0, 30.0), rng.uniform(0.01, 0.1),
    ]  # fmt: skip
    law = rng.choice(["ring", "hertz", "galin", f"annulus:{rng.uniform(0.2, 0.9):.3f}"]).item()
    other = {"pressure": {"pressure": law}, "gyration": {"gyration": rng.uniform(0.5, 0.9)}}
    puck = [drawn, other.get(kind, {})]
    asked = [sys.executable, "-c", QUESTIONS + ASKED, json.dumps(puck)]
    told, said = run(asked, XDG_CACHE_HOME=str(tmp_path))
    answers, loaded = json.loads(told)
    slow = kind == "tall"  # which takes a second or so, and says so
    assert all(slow and "it runs in Python" in line for line in said.splitlines()), said
    assert not loaded
    assert not list(tmp_path.rglob("*.code"))
    compiled = json.loads(run(asked, **COMPILED)[0])[0]
    for found, expected in zip(answers, compiled, strict=True):
        # friction of a tall puck is tabulated both ways, to its own error
        rtol = 1e-8 if kind == "tall" else 1e-11
        np.testing.assert_allclose(found, expected, rtol=rtol, atol=0.01 * rtol)


@pytest.mark.thorough
@pytest.mark.parametrize("name", few(1, ["carrom-break", "wet-patch", "air-hockey"]))
def test_scenes_run_alike(name: str):
    command = [*PUCK, "simulate", "--scene", name, "--json"]
    told, compiled = run(command, **AS_WRITTEN)[0], run(command, **COMPILED)[0]
    found, expected = json.loads(told), json.loads(compiled)
    assert found.pop("steps", 0) == pytest.approx(expected.pop("steps", 0), rel=0.05)
    np.testing.assert_allclose(numbers(found), numbers(expected), rtol=1e-6, atol=1e-8)


@pytest.fixture
def patient(monkeypatch: pytest.MonkeyPatch) -> None:
    """Kernels run as they are written at first, in this thread."""
    monkeypatch.setattr(here, "at_once", False)


def is_compiled(door: Any) -> bool:
    assert isinstance(door, Door)
    return door._ready is not None and bool(door.compiled.overloads)


@inner
def _deeper(n: int, out: FloatArray) -> None:
    out[1] += 1.0 / (n + 1.0)


def counting() -> Any:
    """A door to a kernel that takes its time, and changes what it is given."""

    @kernel
    def count(items: int, loops: int, out: FloatArray) -> float:
        patience(items)
        for n in range(loops):
            patience(1)
            out[0] += math.sqrt(n)
            _deeper(n, out)
        return float(out[0])

    return count


@pytest.mark.usefixtures("patient")
def test_short_work_is_done_as_it_is_written(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(here, "kept_first", False)  # another process may have kept some
    count, out = counting(), np.zeros(2)
    assert count(1, 3, out) == 1.0 + math.sqrt(2.0)
    assert out.tolist() == [1.0 + math.sqrt(2.0), 1.0 + 0.5 + 1.0 / 3.0]
    assert not is_compiled(count)


@pytest.mark.usefixtures("patient")
@pytest.mark.parametrize(("items", "at_first"), [(1, 1e-3), (65, 1.5)])
def test_long_work_goes_on_compiled_from_what_it_was_given(items, at_first, monkeypatch):
    monkeypatch.setattr(doors, "AT_FIRST", at_first)
    count, out = counting(), np.array([1.0, 2.0])
    loops = 50_000
    total = count(items, loops, out)
    assert is_compiled(count)
    expected = [1.0, 2.0]
    for n in range(loops):
        expected[0] += math.sqrt(n)
        expected[1] += 1.0 / (n + 1.0)
    assert out.tolist() == expected
    assert total == expected[0]
    assert count.spent < 0.5  # and never tried again
    spent = count.spent
    count(1, 3, out)
    assert count.spent == spent


@pytest.mark.usefixtures("patient")
def test_what_takes_long_to_compile_runs_longer_and_says_so_once(monkeypatch, capsys):
    monkeypatch.setattr(doors, "_SILENT", 1e-3)
    monkeypatch.setattr(doors, "is_any_kept", lambda _: False)  # another process may keep some
    count = counting()
    count.seconds = 250.0
    for _ in range(2):
        count(1, 20_000, np.zeros(2))
    assert not is_compiled(count)
    assert capsys.readouterr().err == (
        "test_uncompiled.counting.<locals>.count is not compiled: it runs in Python, up to 100 s\n"
    )


@pytest.mark.usefixtures("patient")
@pytest.mark.parametrize(
    ("number", "at"),
    [
        (lambda x: 1.0 / x, 0.0),
        (lambda x: math.exp(x), 1e3),
        (lambda x: math.sqrt(x), -1.0),
        (lambda x: math.log(x), 0.0),
        (lambda x: x**1.5, -0.1),
        (lambda x: math.sqrt(x**1.5), -0.1),
    ],
)
def test_what_python_refuses_to_compute_is_compiled(number: Callable[[float], float], at: float):
    inside = inner(number)

    @kernel
    def marked(x: float, out: FloatArray) -> float:
        out[0] += 1.0
        return inside(x)

    with np.errstate(all="ignore"):
        expected = float(np.asarray(_numpy(number, at)))
    out = np.zeros(1)
    found = marked(at, out)
    assert found == expected or (math.isnan(found) and math.isnan(expected))
    assert out[0] == 1.0  # what was tried before has left no trace
    assert is_compiled(marked)


def _numpy(number: Callable[[Any], Any], at: float) -> Any:
    """The same by NumPy, which has inf and NaN."""
    named = {"exp": np.exp, "sqrt": np.sqrt, "log": np.log}
    apart = {**number.__globals__, "math": type("of_numpy", (), named)}
    return type(number)(number.__code__, apart)(np.float64(at))


@pytest.mark.usefixtures("patient")
def test_an_interrupt_leaves_what_was_given_as_it_was():
    def stop_it(out: FloatArray) -> None:
        out[0] = 7.0
        raise KeyboardInterrupt

    out = np.zeros(1)
    with pytest.raises(KeyboardInterrupt):
        kernel(stop_it)(out)
    assert out[0] == 0.0
    assert not here.as_written


def test_many_threads_compile_once(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(doors, "AT_FIRST", 1e-3)
    count, found, begin = counting(), [], threading.Barrier(8)

    def ask() -> None:
        here.at_once = False
        begin.wait()
        found.append(count(1, 20_000, np.zeros(2)))

    threads = [threading.Thread(target=ask) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(found) == 8
    assert len(set(found)) == 1
    assert len(count.compiled.overloads) == 1


@pytest.mark.usefixtures("patient")
def test_what_was_compiled_before_is_taken_unless_one_question_is_asked(monkeypatch, tmp_path):
    monkeypatch.setattr("puck_tables.kernels.kept_code.cache_folder", lambda: tmp_path)
    monkeypatch.setattr("puck_tables.kernels.cache._place", lambda: tmp_path)
    monkeypatch.setattr(here, "at_once", True)
    counting()(1, 3, np.zeros(2))  # kept
    monkeypatch.setattr(here, "at_once", False)
    with one_question():
        count = counting()
        count(1, 3, np.zeros(2))
        assert not is_compiled(count)
    count = counting()
    count(1, 3, np.zeros(2))
    assert is_compiled(count)
    assert sum(count.compiled.stats.cache_hits.values()) == 1


def test_the_switch_of_numba_leaves_functions_as_they_are():
    code = (
        "from puck_tables.kernels.compile import kernel, inlined\n"
        "def one(): pass\n"
        "print(kernel(one) is one, inlined(one) is one)"
    )
    assert run([sys.executable, "-c", code], **AS_WRITTEN)[0] == "True True\n"


def test_a_door_is_handed_to_other_processes_by_its_name():
    from puck_tables.motion.limits import log_ratio

    assert isinstance(log_ratio, Door)
    assert pickle.loads(pickle.dumps(log_ratio)) is log_ratio


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("NUMBA_NUM_THREADS", "0"), ("NUMBA_NUM_THREADS", "-2"), ("NUMBA_NUM_THREADS", "many"),
        ("NUMBA_CPU_FEATURES", "nonsense"),
    ],
)  # fmt: skip
def test_settings_at_which_numba_would_end_are_refused_before(name, value, monkeypatch):
    monkeypatch.setenv(name, value)
    with pytest.raises(pt.InputError, match=f"{name}={value}: set it to "):
        doors.read_settings()


@pytest.mark.parametrize(
    ("name", "value"),
    few(2, [("NUMBA_NUM_THREADS", "0"), ("NUMBA_OPT", "best"), ("NUMBA_BOUNDSCHECK", "x")]),
)
def test_settings_that_numba_cannot_use_are_refused_in_one_sentence(name, value, tmp_path):
    given = {**os.environ, **COMPILED, name: value, "NUMBA_CACHE_DIR": str(tmp_path)}
    ended = subprocess.run([*PUCK, *LAUNCH], env=given, capture_output=True, text=True)
    assert ended.returncode == 2
    assert ended.stdout == ""
    assert len(ended.stderr.splitlines()) == 1
    assert f"{name}={value}" in ended.stderr
    assert pt.errors.InputError.__name__ not in ended.stderr


@pytest.mark.parametrize("single", [False, True])
def test_operations_on_vectors_are_those_of_compiled_code(single: bool):
    rng = np.random.default_rng(8)
    c = rng.normal(size=200).astype(np.float32 if single else np.float64)

    @kernel
    def sums(c: FloatArray, w: float, s: float) -> tuple[Any, Any]:
        return (
            vectors.weighted_rows(c, 3, (w, 1.0 - w, 2.0 * w), 4),
            vectors.spline_values(c, 5, (w, 1.0 - w), s, 8, 3),
        )

    @kernel
    def polynomials(c: FloatArray, w: float, s: float) -> tuple[Any, Any]:
        return (
            vectors.spline_polynomials(c, 7, (w, 1.0 - w), s, 8, 4),
            vectors.spline_slopes(c, 7, (w, 1.0 - w), s, 4, 3),
        )

    w, s = 0.3, -0.7
    rows, values = sums(c, w, s)
    assert as_written.weighted_rows(c, 3, (w, 1.0 - w, 2.0 * w), 4) == rows
    assert as_written.spline_values(c, 5, (w, 1.0 - w), s, 8, 3) == values
    if not single:
        one, other = polynomials(c, w, s)
        assert as_written.spline_polynomials(c, 7, (w, 1.0 - w), s, 8, 4) == one
        assert as_written.spline_slopes(c, 7, (w, 1.0 - w), s, 4, 3) == other


def test_bits_and_rows_are_those_of_compiled_code():
    @kernel
    def there_and_back(number: float, block: FloatArray) -> tuple[Any, ...]:
        register_blocks.into_row(block, 1, 5, number)
        register_blocks.into_rows(block, 2, 5, (number, 2.0 * number))
        bits = vectors.bits_of(number)
        rows = register_blocks.rows_of(block, 1, 3, 5)
        return bits, vectors.number_of(bits + 1), register_blocks.row_of(block, 1, 5), rows

    for number in (1.0, -2.5e-300, 0.1):
        block, other = np.zeros(4 * as_written.BLOCK), np.zeros(4 * as_written.BLOCK)
        as_written.into_row(other, 1, 5, number)
        as_written.into_rows(other, 2, 5, (number, 2.0 * number))
        bits, rows = as_written.bits_of(number), as_written.rows_of(other, 1, 3, 5)
        found = bits, as_written.number_of(bits + 1), as_written.row_of(other, 1, 5), rows
        assert there_and_back(number, block) == found
        assert (block == other).all()


def test_lines_and_squares_are_those_of_compiled_code():
    @kernel
    def moved(source: FloatArray, out: FloatArray) -> None:
        register_blocks.into_line(out, 3, (source[0], source[1], 7.0, source[2]))
        register_blocks.turn_square(source, 1, 9, out, 8, 5)

    source, out, other = np.arange(40.0), np.zeros(40), np.zeros(40)
    moved(source, out)
    as_written.into_line(other, 3, (0.0, 1.0, 7.0, 2.0))
    as_written.turn_square(source, 1, 9, other, 8, 5)
    assert (out == other).all()
    assert out[8:12].tolist() == [1.0, 10.0, 19.0, 28.0]

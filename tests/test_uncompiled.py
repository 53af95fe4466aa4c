"""Short commands compile nothing, tell what compiled code tells, and give way to it in time."""

from __future__ import annotations

import json
import math
import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from puck_tables.cli import start, uncompiled

from puck_tables._core.arrays import FloatArray
from puck_tables.errors import InputError
from puck_tables.kernels import as_written, blocks, vectors
from puck_tables.kernels.cache import cache_folder
from puck_tables.kernels.compile import kernel

LAUNCH = ["simulate", "--v0", "1,0", "--w0", "5"]


def run(arguments: list[str], *, before: str = "", **environment: str) -> tuple[str, str]:
    """What a command says on stdout and stderr, after some Python."""
    code = f"from puck_tables.cli import uncompiled, start\n{before}\nstart.main()"
    ended = subprocess.run(
        [sys.executable, "-c", code, *arguments], env={**os.environ, **environment},
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    return ended.stdout, ended.stderr


def numbers(told: object) -> list[float]:
    """All numbers of a JSON document, in order."""
    if isinstance(told, dict):
        return [one for value in told.values() for one in numbers(value)]
    if isinstance(told, list):
        return [one for value in told for one in numbers(value)]
    return [float(told)] if isinstance(told, int | float) else []


THOROUGH = pytest.mark.thorough


@pytest.mark.parametrize(
    "arguments",
    [
        pytest.param(LAUNCH, id="launch"),
        pytest.param(["simulate", "--scene", "incline"], id="scene"),
        pytest.param(["aim", "--target", "2,0.1", "--w0", "5"], id="aim", marks=THOROUGH),
        pytest.param(["reference", "coin"], id="reference", marks=THOROUGH),
    ],
)
def test_nothing_is_compiled(arguments: list[str], tmp_path: Path):
    told, said = run([*arguments, "--json"], NUMBA_CACHE_DIR=str(tmp_path))
    assert not said
    assert not list(tmp_path.rglob("*.code"))
    assert len(numbers(json.loads(told))) > 5


COMPILED = {"NUMBA_DISABLE_JIT": "0"}


@pytest.mark.thorough
def test_numbers_are_those_of_compiled_code():
    told, compiled = run([*LAUNCH, "--json"])[0], run([*LAUNCH, "--json"], **COMPILED)[0]
    found, expected = (numbers(json.loads(one)) for one in (told, compiled))
    np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-15)
    assert found != expected  # to rounding: so the next test sees which is which


@pytest.mark.thorough
def test_what_takes_long_begins_anew_and_compiled():
    soon = "uncompiled.AT_FIRST, uncompiled._OTHERS = 1e-3, ('none', 1e-3)"
    again = run([*LAUNCH, "--json"], before=soon)[0]
    assert again == run([*LAUNCH, "--json"], **COMPILED)[0]


@pytest.mark.thorough
def test_a_table_is_built_by_compiled_code(tmp_path: Path):
    kept = {"NUMBA_CACHE_DIR": str(Path(cache_folder() or "").parent)}
    command, own = [*LAUNCH, "--delta", "2.07", "--json"], tmp_path / "own"
    soon = "uncompiled.AT_FIRST = 0.5"  # so that patience would end while the table is built
    told = run(command, before=soon, XDG_CACHE_HOME=str(tmp_path), **kept)[0]
    assert told == run(command, XDG_CACHE_HOME=str(own), **kept, **COMPILED)[0]


@pytest.mark.thorough
@pytest.mark.parametrize("name", ["wet-patch", "air-hockey", "carrom-break"])
def test_scenes_run_alike(name: str):
    command = ["simulate", "--scene", name, "--json"]
    told, compiled = run(command)[0], run(command, **COMPILED)[0]
    found, expected = json.loads(told), json.loads(compiled)
    assert found.pop("steps", 0) == pytest.approx(expected.pop("steps", 0), rel=0.05)
    np.testing.assert_allclose(numbers(found), numbers(expected), rtol=1e-6, atol=1e-8)


@pytest.fixture
def begun(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[str]]:
    """How often the command began anew, in a process as if it were a command's own."""
    anew: list[str] = []
    monkeypatch.setattr(start, "alone", True)
    monkeypatch.setattr(uncompiled, "_begin_compiled", lambda *_: anew.append("begun"))
    monkeypatch.setenv("NUMBA_DISABLE_JIT", "")
    monkeypatch.delenv("NUMBA_DISABLE_JIT")
    with np.errstate():
        yield anew


@pytest.mark.parametrize(
    "number",
    [
        lambda: 1.0 / 0.0,
        lambda: math.exp(1e3),
        lambda: math.sqrt(-1),
        lambda: math.floor(math.nan),
        lambda: math.sqrt((-0.1) ** 1.5),
    ],
)
def test_what_python_refuses_to_compute_is_compiled(number: Callable[[], float], begun: list[str]):
    with uncompiled.uncompiled():
        number()
    assert begun == ["begun"]


def test_a_refusal_stays_one(begun: list[str]):
    with pytest.raises(InputError, match="of input"), uncompiled.uncompiled():
        raise InputError("of input")
    assert not begun


def test_work_that_is_long_is_compiled(begun: list[str]):
    with uncompiled.uncompiled():
        as_written.long_work()
    assert begun == ["begun"]
    as_written.long_work()
    assert begun == ["begun"]  # outside nobody listens


def test_a_board_whose_compiled_code_is_kept_is_not_run_uncompiled(
    begun: list[str], monkeypatch: pytest.MonkeyPatch
):
    for kept in (False, True):
        monkeypatch.setattr(uncompiled, "_kept", lambda kernel, kept=kept: kept)
        with uncompiled.uncompiled():
            uncompiled.several_pucks()
        assert len(begun) == kept


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
    close = {"rtol": 1e-13, "atol": 1e-14}
    found = as_written.weighted_rows(c, 3, (w, 1.0 - w, 2.0 * w), 4)
    np.testing.assert_allclose(found, rows, **close)
    np.testing.assert_allclose(
        as_written.spline_values(c, 5, (w, 1.0 - w), s, 8, 3), values, **close
    )
    if not single:
        one, other = polynomials(c, w, s)
        found = as_written.spline_polynomials(c, 7, (w, 1.0 - w), s, 8, 4)
        np.testing.assert_allclose(found, one, **close)
        found = as_written.spline_slopes(c, 7, (w, 1.0 - w), s, 4, 3)
        np.testing.assert_allclose(found, other, **close)


def test_bits_and_rows_are_those_of_compiled_code():
    @kernel
    def there_and_back(number: float, block: FloatArray) -> tuple[Any, ...]:
        blocks.into_row(block, 1, 5, number)
        blocks.into_rows(block, 2, 5, (number, 2.0 * number))
        bits = vectors.bits_of(number)
        rows = blocks.rows_of(block, 1, 3, 5)
        return bits, vectors.number_of(bits + 1), blocks.row_of(block, 1, 5), rows

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
        blocks.into_line(out, 3, (source[0], source[1], 7.0, source[2]))
        blocks.turn_square(source, 1, 9, out, 8, 5)

    source, out, other = np.arange(40.0), np.zeros(40), np.zeros(40)
    moved(source, out)
    as_written.into_line(other, 3, (0.0, 1.0, 7.0, 2.0))
    as_written.turn_square(source, 1, 9, other, 8, 5)
    assert (out == other).all()
    assert out[8:12].tolist() == [1.0, 10.0, 19.0, 28.0]

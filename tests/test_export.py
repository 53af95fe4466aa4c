"""Exported files answer as the library does, within the error that they state, at every launch."""

from __future__ import annotations

import itertools
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from exported import RUNNERS, WIDTHS, answers, launches, runner, text_of, units
from rarely import thorough

import puck_tables as pt
from puck_tables.export.languages import LANGUAGES

POINTS = {"c": 20_000, "js": 20_000, "python": 1_000}
TOL = 1e-6  # of every run: to fit one error takes seconds
every_language = pytest.mark.parametrize("language", RUNNERS)


@cache
def by_library(count: int, tol: float) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Arguments and answers of the library, by function."""
    return answers(launches(count, 16), np.random.default_rng(61), pt.resultants, tol)


@every_language
@pytest.mark.parametrize("tol", [TOL, *map(thorough, (1e-4, 1e-9))])
def test_equal_to_the_library(language: str, tol: float, tmp_path: Path):
    run, count = runner(language, tol, tmp_path), POINTS[language] * (1 if tol == TOL else 5)
    for name, (rows, wanted) in by_library(count, max(1e-3 * tol, 1e-10)).items():
        found, codes = run(name, np.ascontiguousarray(rows))
        assert not codes.any(), name
        if name == "resultants":
            assert np.abs(found - wanted).max() <= 2e-14
        else:
            assert (np.abs(found - wanted) / units(rows, name)).max() <= tol, name


BAD = [np.nan, np.inf, -np.inf]
WRONG = [
    *((n, bad) for n in range(6) for bad in BAD),
    (3, -1e-12), (3, 1.0 + 1e-9), (4, 0.0), (4, -1.0), (5, 0.0), (5, -1.0), (6, -1e-9), (6, np.nan),
    (6, np.inf),
]  # fmt: skip


@every_language
def test_what_is_out_of_range_is_refused(language: str, tmp_path: Path):
    run = runner(language, TOL, tmp_path)
    for name in ("stop", "turn", "state"):
        wide = WIDTHS[name][0]
        rows = [[1.0, 0.0, 5.0, 0.5, 1.0, 1.0, 1.0][:wide] for _ in WRONG]
        for row, (n, value) in zip(rows, WRONG, strict=True):
            if n < wide:
                row[n] = value
        wrong = np.array([n < wide for n, _ in WRONG])
        found, codes = run(name, np.array(rows))
        np.testing.assert_array_equal(codes, wrong)
        np.testing.assert_array_equal(np.isnan(found).all(axis=1), wrong)
    angles = np.array([[1.6, 0.5], [-1.6, 0.5], [np.nan, 0.5], [0.1, 1.1], [0.1, -0.1]])
    found, codes = run("resultants", angles)
    assert np.isnan(found).all() and codes.tolist() == [1] * 5


@every_language
def test_the_largest_and_the_smallest_numbers(language: str, tmp_path: Path):
    """Either finite, and the library's, or refused as too large where the library refuses it."""
    run = runner(language, TOL, tmp_path)
    sizes = [0.0, 5e-324, 1e-310, 1e-200, -1e-60, 1.0, 1e90, 1e150, 1.7e308]
    rows = np.array([
        [vx, vy, spin, delta, decel, radius]
        for vx, vy, spin in itertools.product(sizes, [0.0, 1e-160, 2e150], sizes)
        for delta, decel, radius in ((0.0, 1.0, 1.0), (1.0, 1e-300, 1e-5), (0.5, 1e308, 1e20))
    ])  # fmt: skip
    found, codes = run("stop", rows)
    with np.errstate(over="ignore", invalid="ignore"):
        rim = rows[:, 5] * rows[:, 2]
        wanted = pt.stop(
            rows[:, :2], rows[:, 2], delta=rows[:, 3], decel=rows[:, 4], radius=rows[:, 5]
        )
        too_large = ~np.isfinite(rim) | (wanted.status != 0)
    assert set(codes.tolist()) == {0, 2}
    assert np.isnan(found[codes == 2]).all() and np.isfinite(found[codes == 0]).all()
    clear = too_large == (codes == 2)  # at the very edge of floating point either may be right
    assert clear.mean() > 0.99
    fine = ~too_large & (codes == 0)
    stops = np.column_stack([wanted.stop_time, wanted.stop_position])[fine]
    off = np.abs(found[fine, :3] - stops) / units(rows[fine], "stop")[:, :3]
    assert off.max() <= TOL
    for share in (0.3, 2.0):
        times = share * np.where(fine, wanted.stop_time, 1.0)
        states, state_codes = run("state", np.column_stack([rows, times]))
        np.testing.assert_array_equal(state_codes, codes)
        assert np.isfinite(states[codes == 0]).all()
    turns, turn_codes = run("turn", rows)
    np.testing.assert_array_equal(turn_codes, codes)
    assert np.isfinite(turns[codes == 0]).all()


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize(("tol", "most"), [(TOL, 38_000), thorough(1e-4, 30_000)])
def test_size_of_a_file(language: str, tol: float, most: int):
    assert len(text_of(language, "stop,state,resultants", tol).encode()) <= most


@every_language
@pytest.mark.parametrize("what", ["stop", "resultants"])
def test_a_part_stands_alone(language: str, what: str, tmp_path: Path):
    run = runner(language, TOL, tmp_path, what)
    rows, wanted = by_library(POINTS["python"], 1e-10)[what]
    found, _ = run(what, np.ascontiguousarray(rows))
    scale = units(rows, "stop") if what == "stop" else 1.0
    assert (np.abs(found - wanted) / scale).max() <= TOL
    others = {"stop": "MOTION", "resultants": "STOP"}  # words of what was not asked for
    assert others[what] not in text_of(language, what, TOL)


def test_a_file_notices_a_wrong_digit(tmp_path: Path):
    """The vectors in it are no ornament."""
    text = text_of("python", "stop", TOL)
    start = text.index("STOP = (") + 9
    end = text.index("\n)", start)
    numbers = text[start:end].replace("\n", "").rstrip(",").split(",")
    wrong = [str(int(float(one)) + 3_000_000) if n % 20 < 5 else one
             for n, one in enumerate(numbers)]  # fmt: skip
    names: dict[str, object] = {}
    exec(text[:start] + ",".join(wrong) + "," + text[end:], names)
    assert names["self_test"]() > 0  # type: ignore[operator]


def test_the_licence_is_the_package_s():
    licence = (Path(__file__).parent.parent / "LICENSE").read_text()
    for language in LANGUAGES:
        assert licence.strip() in text_of(language, "stop,state,resultants", TOL)

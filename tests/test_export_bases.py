"""Exported friction of bases, and steps of their motion, by judges of the tests."""

from __future__ import annotations

import shutil
from functools import cache
from itertools import product, starmap
from pathlib import Path

import numpy as np
import pytest
from base_judge import Judge
from exported import RUNNERS, Run
from rarely import thorough

import puck_tables as pt

FRAME = pt.Base.polygon(
    [(-1.0, -0.6), (1.0, -0.6), (1.0, 0.6), (-1.0, 0.6)],
    holes=[[(-0.7, -0.3), (0.7, -0.3), (0.7, 0.3), (-0.7, 0.3)]],
)
FEET = pt.Base.feet([(0.1, 0.0), (-0.05, 0.08), (-0.05, -0.08)], 0.02)
SMALL_FEET = pt.Base.feet([(0.08, 0.0), (-0.05, 0.06), (-0.05, -0.06)], 0.005, loads=[1, 2, 3])
PUCKS = {
    "box": pt.Puck(base="box:0.2x0.1", friction=0.3),
    "triangle": pt.Puck(base=pt.Base.polygon([(0.0, 0.0), (0.12, 0.0), (0.0, 0.09)]), friction=0.3),
    "frame": pt.Puck(base=FRAME, friction=0.3),
    "tall box": pt.Puck(base="box:0.2x0.1@0.01,-0.005", friction=0.3, height=0.02, gyration=0.07),
    "annulus": pt.Puck(base="annulus:0.1x0.06", friction=0.3),
    "disc": pt.Puck(base="disc:0.1@0.02,0.01", friction=0.2, height=0.01, gyration=0.06),
    "feet": pt.Puck(base=FEET, friction=0.2, height=0.02, gyration=0.08),
    "loaded feet": pt.Puck(base=SMALL_FEET, friction=0.3),
}
SLID = ("tall box",)  # by every run
LAUNCHES = np.array([[1.0, 0.3, 2.0], [0.2, -0.4, -25.0], [0.0, 0.0, 3.0], [0.5, 0.0, 0.0]])


def runner(language: str, puck: pt.Puck, folder: Path, steps: int = 100_000) -> Run:
    make, program = RUNNERS[language]
    if shutil.which(program) is None:
        pytest.skip(f"there is no {program} here")
    text = pt.export_source(language, "wrench", puck=puck).text
    assert text.count("part < 100000") == 1
    return make(text.replace("part < 100000", f"part < {steps}"), folder)


@cache
def frictions(name: str) -> tuple[np.ndarray, np.ndarray]:
    """Slips and angles of the body (n, 4), force and torque (n, 3), as the judge has it."""
    rng, judge, count = np.random.default_rng(8), Judge.of_puck(PUCKS[name]), 150
    edge = judge.polygons[0] if judge.polygons else np.eye(2) * judge.reach
    slips = rng.normal(size=(count, 3)) * [1.0, 1.0, 1.0 / judge.reach]
    slips[:, 2] *= 10.0 ** rng.uniform(-4.0, 3.0, count)
    slips[:20, 2] = 0.0
    slips[20:30, :2] = 0.0
    for n in range(30, 60):  # about corners and places on sides
        one, two = (edge[(n + m) % len(edge)] for m in range(2))
        at = one + (n % 4) / 4.0 * (two - one)
        slips[n, :2] = slips[n, 2] * np.array([at[1], -at[0]])
    rows, wanted = np.column_stack([slips, rng.uniform(-4.0, 4.0, count)]), []
    for ux, uy, w, angle in rows.tolist():
        c, s = np.cos(angle), np.sin(angle)
        force, torque = judge.friction(c * ux + s * uy, c * uy - s * ux, w)
        wanted.append([c * force[0] - s * force[1], s * force[0] + c * force[1], torque])
    return rows, np.array(wanted)


@pytest.mark.parametrize(
    ("name", "language"),
    [
        *((name, "c") for name in PUCKS),
        *product(("frame", "loaded feet"), ("js", "python")),
        *starmap(thorough, product(sorted({*PUCKS} - {"frame", "loaded feet"}), ("js", "python"))),
    ],
)
def test_friction_is_that_of_the_judge(name: str, language: str, tmp_path: Path) -> None:
    rows, wanted = frictions(name)
    found, codes = runner(language, PUCKS[name], tmp_path)("wrench", rows)
    assert not codes.any()
    np.testing.assert_allclose(found[:, :2], wanted[:, :2], atol=2e-13)
    torque, reach = wanted[:, 2], Judge.of_puck(PUCKS[name]).reach
    np.testing.assert_allclose(found[:, 2], torque, rtol=0.0, atol=4e-13 * reach)


@cache
def slides(name: str) -> np.ndarray:
    """When and where launches of a puck end, as the judge has it."""
    judge = Judge.of_puck(PUCKS[name])
    return np.array([judge.slide((vx, vy), w, 2.0, 1e-10) for vx, vy, w in LAUNCHES.tolist()])


@pytest.mark.parametrize("language", RUNNERS)
@pytest.mark.parametrize(
    "name", [pytest.param(one, marks=[pytest.mark.thorough] * (one not in SLID)) for one in PUCKS]
)
def test_steps_lead_to_the_stop_of_the_judge(name: str, language: str, tmp_path: Path) -> None:
    puck = PUCKS[name]
    run, k, steps = runner(language, puck, tmp_path), puck.gyration, 7
    stops, places = slides(name)[:, 0], slides(name)[:, [1, 2, 4]]
    state = np.zeros((len(LAUNCHES), 8))
    state[:, 3:6], state[:, 6], state[:, 7] = LAUNCHES, 2.0, 1.1 * stops / steps
    for _ in range(steps):
        state[:, :6], codes = run("step", state.copy())
        assert not codes.any()
    assert not state[:, 3:6].any()
    within = 0.5e-6 * np.sum((LAUNCHES * [1.0, 1.0, k]) ** 2, axis=1)[:, None] / [1.0, 1.0, k]
    assert (np.abs(state[:, :3] - places) <= within).all()


@pytest.mark.parametrize("language", RUNNERS)
def test_what_is_out_of_range_is_refused(language: str, tmp_path: Path) -> None:
    run = runner(language, PUCKS["box"], tmp_path, steps=1000)
    bad = np.array([
        [0.0, 0.0, 0.0, 1.0], [np.nan, 0, 0, 0], [1, np.inf, 0, 0], [1, 0, 0, np.nan],
    ])  # fmt: skip
    found, codes = run("wrench", bad)
    assert (codes == 1).all() and np.isnan(found).all()
    start = [0.0, 0.0, 0.0, 1.0, 0.0, 2.0]
    bad = np.array([[*start, 0.0, 1.0], [*start, 1.0, -1.0], [*start, np.nan, 1.0]])
    found, codes = run("step", bad)
    assert (codes == 1).all() and np.isnan(found).all()
    found, codes = run("step", np.array([[*start[:5], 1e9, 1.0, 1.0]]))
    assert codes[0] == 2 and np.isnan(found).all()


@pytest.mark.parametrize(
    ("puck", "what", "words"),
    [
        (pt.Puck(base="box:0.2x0.1", friction=0.3), "stop", "a base 'wrench' is exported"),
        (pt.Puck(0.1, friction=0.3), "wrench", "exported of a base"),
        (pt.Puck(base="box:0.2x0.1", friction=0.3, height=0.2), "wrench", "would lift"),
    ],
)  # fmt: skip
def test_what_is_not_exported_is_said(puck: pt.Puck, what: str, words: str) -> None:
    with pytest.raises(pt.PuckError, match=words):
        pt.export_source("c", what, puck=puck)


def test_a_file_tests_itself_at_every_error() -> None:
    puck = PUCKS["frame"]
    for tol in (1e-2, 1e-6, 1e-9):
        source = pt.export_source("python", "wrench", tol, puck)
        names: dict = {}
        exec(source.text, names)
        assert names["self_test"]() == 0
    assert repr(source).startswith("Source(python, wrench to 1e-09, base polygon")
    exec(source.text.replace("BASE_AREA = 1", "BASE_AREA = 2"), names)
    assert names["self_test"]() > 0

"""What docs/engines tells engines of the cases, and one engine that plays them if it is there."""

from __future__ import annotations

import importlib
import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from puck_tables import compare, reference_case
from puck_tables.reference.cases import CASES

SCRIPTS = Path(__file__).parents[1] / "docs/engines"
BODIES = [case.name for case in CASES if "base" in case.tables["puck"]]


@pytest.fixture
def scripts(monkeypatch: pytest.MonkeyPatch) -> Any:
    """The modules of the folder, by their names."""
    monkeypatch.syspath_prepend(SCRIPTS)
    return importlib.import_module


def told(name: str, scripts: Any) -> dict[str, Any]:
    """A case as engines get it."""
    case = reference_case(name, times=[0.0]).summary()
    scripts("run_all").describe(case["scene"]["puck"])
    return json.loads(json.dumps(case))


@pytest.mark.parametrize("name", ["box", "triangle", "off-centre", "three-feet"])
def test_a_base_is_told_by_its_parts(name: str, scripts: Any):
    solid = told(name, scripts)["scene"]["puck"]["solid"]
    rng = np.random.default_rng(3)
    places = rng.uniform(-1.0, 1.0, (200_000, 2)) * solid["reach"]
    within = np.zeros(len(places), bool)
    for part in solid["parts"]:
        if isinstance(part[0], float):
            within |= np.hypot(*(places - part[:2]).T) <= part[2]
        else:
            corners = np.array(part)
            sides = np.roll(corners, -1, axis=0) - corners
            across = places[:, None] - corners
            turn = sides[:, 0] * across[..., 1] - sides[:, 1] * across[..., 0]
            within |= (turn >= 0.0).all(axis=1)
    some = places[within]
    close = {"rel": 5.0 / math.sqrt(len(some))}  # of draws
    assert within.mean() * 4.0 * solid["reach"] ** 2 == pytest.approx(solid["area"], **close)
    assert (some**2).mean(axis=0) == pytest.approx(solid["square"], **close)
    if name != "off-centre":  # there the load is not even
        assert np.hypot(*some.T).mean() == pytest.approx(solid["arm"], **close)
    points = np.array(solid["points"])
    assert np.hypot(*points.T).mean() == pytest.approx(np.hypot(*some.T).mean(), rel=0.05)


@pytest.mark.parametrize(("name", "place"), [("box", 5.5), ("box-straight", 0.58)])
def test_an_engine_that_brakes_slide_and_spin_apart_is_off_by_so_much(
    name: str, place: float, scripts: Any, tmp_path: Path
):
    """In per cent of Q²/(fg), as the page has it; without a spin only by its step."""
    pytest.importorskip("pymunk")
    case, step = told(name, scripts), 4e-3
    log = scripts("with_pymunk").run(case["scene"], step, 1.3 * case["end_time"])
    log.write(tmp_path / "log.csv")
    row = compare(tmp_path / "log.csv", name, steps=[step]).rows()[0]
    length = case["speed_scale"] ** 2 / case["rate_scale"]
    assert 100.0 * row["place_error_max"] / length == pytest.approx(place, rel=0.05)


def test_all_engines_are_asked_of_the_bodies_that_they_can(scripts: Any):
    can = scripts("task").has_one_puck_and_no_cushion
    left_out = [name for name in BODIES if not can(told(name, scripts)["scene"])]
    assert left_out == ["break-away-force", "break-away-torque", "box-belts"]

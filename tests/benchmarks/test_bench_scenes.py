"""Scenes: what an ingredient costs beside the free puck, and a sweep with two of them."""

from __future__ import annotations

from typing import Any

import pytest
from scenes import sweep_scene

import puck_tables as pt
from puck_tables import Scene
from puck_tables.world.board_case import BoardCase

ONE = pytest.mark.benchmark(group="one launch in a scene, 1600 at once, one thread")
CROSSING = pytest.mark.benchmark(group="one launch over borders, 200 at once, one thread")
SWEEP = pytest.mark.benchmark(group="a scene with slope and drag, 100 x 100 launches")

PUCK = {"radius": 0.04, "height": 0.02, "mass": 0.2, "friction": 0.1}
SIDE = 40
RANGES = {"launch.velocity[0]": (0.1, 2.0), "launch.spin": (-50.0, 50.0)}

SCENES: dict[str, dict[str, Any]] = {
    "free puck": {},
    "slope": {"floor": {"slope": 0.03}},
    "belt": {"floor": {"velocity": [0.2, 0.1]}},
    "turntable": {"floor": {"turning": 0.5}, "time": 2.0},
    "strips": {"floor": {"strips": {"borders": [0.2, 0.4], "friction": [0.1, 0.05, 0.1]}}},
    "drag": {"drag": {"sliding": 0.05, "spinning": 1e-6}},
    "force": {"force": {"constant": [0.01, 0.0]}},
    "wall": {"wall": [{"point": [0.3, 0.0], "normal": [-1.0, 0.0], "restitution": 0.8}]},
    "edge": {"edge": [{"point": [9.0, 0.0], "normal": [-1.0, 0.0]}]},
    "blade": {"constraint": {"kind": "blade"}},
}


FLOORS: dict[str, dict[str, Any]] = {
    "none": {},
    "one border": {"strips": {"borders": [0.2], "friction": [0.1, 0.06]}},
    "two borders": {"strips": {"borders": [0.2, 0.4], "friction": [0.1, 0.05, 0.1]}},
    "a round patch": {"patch": [{"friction": 0.05, "centre": [0.3, 0.05], "radius": 0.1}]},
    "a polygon": {"patch": [{"friction": 0.05, "corners": [
        [0.2, -0.1], [0.4, -0.1], [0.4, 0.15], [0.2, 0.15],
    ]}]},
}  # fmt: skip


def whole(parts: dict[str, Any], **launch: Any) -> dict[str, Any]:
    return {"puck": PUCK, "launch": launch, **parts}


@ONE
def test_the_plain_integrator(measure: Any) -> None:
    import numpy as np

    speed, spin = np.meshgrid(*(np.linspace(*ends, SIDE) for ends in RANGES.values()))
    v0 = np.stack([speed.ravel(), 0.0 * speed.ravel()], axis=-1)

    def run() -> None:
        pt.stop(v0, spin.ravel(), delta=0.1, decel=0.980665, radius=0.04, tol=1e-9,
                method="adaptive")  # fmt: skip

    measure("plain integrator (stop, adaptive)", run, items=SIDE * SIDE, unit="trajectory")


@ONE
@pytest.mark.parametrize("name", SCENES)
def test_one_ingredient(measure: Any, name: str) -> None:
    import numpy as np

    case = BoardCase(Scene.from_tables(whole(SCENES[name], velocity=[1.0, 0.0])))
    grid = np.meshgrid(*(np.linspace(*ends, SIDE) for ends in RANGES.values()))
    launches = {path: values.ravel() for path, values in zip(RANGES, grid, strict=True)}
    measure(name, lambda: case.ends(launches, SIDE * SIDE), items=SIDE * SIDE, unit="trajectory")
    assert not np.isnan(case.ends(launches, SIDE * SIDE)[0]["x"]).any()


@CROSSING
@pytest.mark.parametrize("tol", [1e-6, 1e-9])
@pytest.mark.parametrize("floor", FLOORS)
@pytest.mark.parametrize("pressure", ["uniform", "hertz", "galin"])
def test_crossings(measure: Any, pressure: str, floor: str, tol: float) -> None:
    """Of launches that all go on beyond what lies there."""
    import numpy as np

    parts = {"floor": FLOORS[floor], "tol": tol, "puck": {**PUCK, "pressure": pressure}}
    case = BoardCase(Scene.from_tables({**whole({}, velocity=[1.5, 0.0]), **parts}))
    rng, count = np.random.default_rng(3), 200
    launches = {
        path: rng.uniform(low, high, count)
        for path, low, high in (
            ("launch.velocity[0]", 1.2, 2.0), ("launch.velocity[1]", -0.1, 0.1),
            ("launch.spin", -50.0, 50.0),
        )
    }  # fmt: skip
    measure(
        f"{pressure}, {floor}, {tol:.0e}", lambda: case.ends(launches, count), items=count,
        unit="trajectory",
    )  # fmt: skip
    assert case.ends(launches, count)[0]["x"].min() > 0.45


@SWEEP
@pytest.mark.parametrize("threads", [1, 2])
def test_sweep(measure: Any, threads: int) -> None:
    slope_and_drag = {**SCENES["slope"], **SCENES["drag"]}
    tables = whole(slope_and_drag, velocity=["0.1:2:100", 0.0], spin="-50:50:100")
    found = sweep_scene(tables)
    assert found.columns["energy_residual"].max() < 1e-8
    measure(
        f"{threads} thread{'s' if threads > 1 else ''}",
        lambda: sweep_scene(tables, threads=threads), items=10_000, unit="trajectory",
    )  # fmt: skip

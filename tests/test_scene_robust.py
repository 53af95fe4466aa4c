"""Scenes at the ends of everything: touching, squeezed, without friction, huge and tiny."""

from __future__ import annotations

import copy
import math
from typing import Any

import numpy as np
import pytest
from scenes import simulate_scene

from puck_tables.errors import InputError, PuckError

G = 9.80665


def scene(**parts: Any) -> dict[str, Any]:
    whole: dict[str, Any] = {
        "puck": {"radius": 0.5, "friction": 0.2},
        "launch": {"velocity": [2.0, 0.5], "spin": 3.0},
    }  # fmt: skip
    for part, values in parts.items():
        whole[part] = {**whole.get(part, {}), **values} if isinstance(values, dict) else values
    return whole


def wall(x: float, y: float, nx: float, ny: float, **more: float) -> dict[str, Any]:
    return {"point": [x, y], "normal": [nx, ny], **more}


CLOSED = {
    "touching a wall, into it": scene(wall=[wall(0.5, 0, -1, 0)]),
    "touching a wall, away": scene(wall=[wall(-0.5, 0, 1, 0)]),
    "along a wall": scene(
        wall=[wall(0, -0.5, 0, 1)], launch={"velocity": [2.0, 0.0], "spin": 0.0},
        drag={"sliding": 0.1},
    ),
    "bent into a wall": scene(
        wall=[wall(0, -0.5, 0, 1, restitution=0.5)], puck={"height": 1.0},
        launch={"velocity": [2.0, 0.0], "spin": 3.0},
    ),
    "in a corner": scene(wall=[wall(0.5, 0, -1, 0, restitution=0.5), wall(0, 0.5, 0, -1)]),
    "in a sharp corner": scene(
        wall=[wall(0, -0.5, 0, 1, restitution=0.7), wall(6.0, -0.5, -0.2, -1, restitution=0.7)]
    ),
    "along a gap": scene(
        wall=[wall(0, 0.5, 0, -1), wall(0, -0.5, 0, 1)], launch={"velocity": [2.0, 0.0]},
        puck={"height": 1.0},
    ),
    "rattling": scene(wall=[wall(0, 0.501, 0, -1), wall(0, -0.5, 0, 1)]),
    "squeezed on an incline": scene(
        wall=[wall(0, 0.5, 0, -1, restitution=0), wall(0, -0.5, 0, 1, restitution=0)],
        floor={"slope": 0.1, "downhill": 1.0},
    ),
    "on a border": scene(floor={"strips": {"borders": [0.0], "friction": [0.2, 0.4]}}),
    "on a border, leaving": scene(
        floor={"strips": {"borders": [0.0], "friction": [0.2, 0.4]}},
        launch={"velocity": [-2.0, 0.0]},
    ),
    "along a border": scene(
        floor={"strips": {"borders": [0.0], "friction": [0.2, 0.4], "direction": math.pi / 2}},
        launch={"velocity": [2.0, 0.0]}, puck={"height": 0.5},
    ),
    "on an edge, leaving": scene(edge=[wall(0, 0, -1, 0)]),
    "on an edge, entering": scene(edge=[wall(0, 0, 1, 0)]),
    "along a line of the rules": scene(
        edge=[{**wall(0, 0, 0, 1), "beyond": "floor"}],
        launch={"velocity": [2.0, 0.0], "spin": -3.0},
    ),
    "at rest": scene(launch={"velocity": [0.0, 0.0], "spin": 0.0}, floor={"slope": 0.1}),
    "at rest beyond the threshold, above a wall": scene(
        launch={"velocity": [0.0, 0.0], "spin": 0.0}, floor={"slope": 0.4},
        wall=[wall(2.0, 0, -1, 0, restitution=0.4, tangential=0.3)],
    ),
    "only spin": scene(launch={"velocity": [0.0, 0.0]}, drag={"spinning": 0.1}),
    "in the centre of a turntable": scene(
        floor={"turning": 2.0}, launch={"velocity": [0.0, 0.0], "spin": 5.0}
    ),
    "at rest in the centre of a turntable": scene(
        floor={"turning": 2.0}, launch={"velocity": [0.0, 0.0], "spin": 2.0}
    ),
    "ice, then sand": scene(
        floor={"strips": {"borders": [1.0, 2.0], "friction": [0.0, 0.0, 0.3]}}
    ),
    "a short run": scene(wall=[wall(9.0, 0, -1, 0)], time=1e-9),
    "ice": scene(puck={"friction": 0.0}, drag={"sliding": 0.3}, time=5.0),
    "nothing acts": scene(puck={"friction": 0.0}, time=5.0),
}  # fmt: skip


@pytest.mark.parametrize("what", CLOSED.values(), ids=CLOSED)
def test_it_ends_and_the_ledger_closes(what: dict[str, Any]) -> None:
    run = simulate_scene(what)
    assert run.end in ("at rest", "carried by the floor", "time is up", "over the edge")
    assert run.energy_residual <= 1e-8
    assert all(np.isfinite(column).all() for column in run.columns.values())
    radius, place = what["puck"]["radius"], np.stack([run.columns["x"], run.columns["y"]])
    for line in what.get("wall", []):
        normal = np.array(line["normal"]) / math.hypot(*line["normal"])
        assert (normal @ (place - np.array(line["point"])[:, None])).min() >= radius - 1e-12


@pytest.mark.thorough
def test_bounces_without_end_are_refused() -> None:
    """Hard walls with next to no room between them."""
    with pytest.raises(PuckError, match=r"meets again and again|crowd together"):
        simulate_scene(scene(wall=[wall(0, 0.5 + 1e-9, 0, -1), wall(0, -0.5, 0, 1)]))


def test_a_channel_as_wide_as_the_puck_lets_it_slide_along() -> None:
    run = simulate_scene(scene(wall=[wall(0, 0.5, 0, -1), wall(0, -0.5, 0, 1)]))
    assert run.end == "at rest" and abs(run.last["y"]) < 1e-15
    assert run.energy_residual < 1e-11  # a hundredth of tol, as steps err


def test_an_edge_that_it_leaves_at_once() -> None:
    run = simulate_scene(CLOSED["on an edge, leaving"])
    assert run.end == "over the edge" and run.end_time == 0.0
    assert simulate_scene(CLOSED["on an edge, entering"]).end == "at rest"


def test_ice_keeps_what_it_is_given() -> None:
    run = simulate_scene(CLOSED["nothing acts"])
    assert run.last["x"] == pytest.approx(10.0, rel=1e-13)
    assert run.last["orientation"] == pytest.approx(15.0, rel=1e-13)


@pytest.mark.parametrize("mass", [2.0**-100, 2.0**100])
@pytest.mark.parametrize("length", [2.0**-66, 2.0**66])
@pytest.mark.parametrize("time", [2.0**-20, 2.0**20])
def test_units_do_not_matter(mass: float, length: float, time: float) -> None:
    """The same scene with other units of mass, length and time, which round nothing."""
    speed = length / time
    one = scene(
        puck={"height": 0.4, "mass": 2.0}, floor={"slope": 0.1, "downhill": 1.0, "turning": 0.3},
        drag={"sliding": 0.2, "spinning": 0.1}, force={"constant": [0.3, -0.2], "torque": 0.1},
        wall=[wall(1.0, 0, -1, 0, restitution=0.6, tangential=0.2)], time=2.0,
    )  # fmt: skip
    other = copy.deepcopy(one)
    other["puck"] |= {"radius": 0.5 * length, "height": 0.4 * length, "mass": 2.0 * mass}
    other["puck"]["gravity"] = G * length / time**2
    other["floor"] |= {"turning": 0.3 / time}
    other["launch"] = {"velocity": [2.0 * speed, 0.5 * speed], "spin": 3.0 / time}
    other["drag"] = {"sliding": 0.2 * mass / time, "spinning": 0.1 * mass * length**2 / time}
    other["force"] = {
        "constant": [0.3 * mass * length / time**2, -0.2 * mass * length / time**2],
        "torque": 0.1 * mass * length**2 / time**2,
    }
    other["wall"][0]["point"] = [length, 0.0]
    other |= {"time": 2.0 * time}
    known, found = simulate_scene(one), simulate_scene(other)
    units = {
        "x": length, "y": length, "orientation": 1.0, "vx": speed, "vy": speed, "spin": 1.0 / time,
        "heat_dry": mass * speed**2, "heat_impact": mass * speed**2,
    }  # fmt: skip
    for name, unit in units.items():
        assert np.allclose(found.columns[name] / unit, known.columns[name], rtol=1e-12, atol=1e-12)


def test_the_launch_lies_beyond_the_numbers() -> None:
    with pytest.raises(InputError, match="too fast for floating point"):
        simulate_scene(scene(launch={"velocity": [1e200, 0.0]}, floor={"slope": 0.1}))


@pytest.mark.parametrize("first", [0.0, -1.0, 0.5])
def test_knots_before_the_launch_and_beyond_the_end(first: float, tmp_path: Any) -> None:
    """A constant force in a file is that force while it lasts."""
    path = tmp_path / "force.csv"
    np.savetxt(path, [[first, 1.5, 0.0], [1e3, 1.5, 0.0]], delimiter=",")
    run = simulate_scene(scene(force={"over_time": str(path)}, time=0.8))
    halves = simulate_scene(scene(force={"constant": [1.5, 0.0]}, time=0.8))
    if first <= 0.0:
        for name in ("x", "y", "spin"):
            assert run.last[name] == pytest.approx(halves.last[name], abs=1e-9)
    else:
        assert run.last["x"] < halves.last["x"] - 0.01


def test_times_in_any_legal_way() -> None:
    whole = scene(floor={"slope": 0.05})
    for times in ([0.3], (0.0, 0.3, 0.3), np.array([0.3, 1e9]), 0.3, np.float32([0.5])):
        run = simulate_scene(whole, times)
        assert len(run.columns["x"]) == np.size(times)
        assert run.columns["time"].tolist() == np.ravel(times).astype(float).tolist()
    assert len(simulate_scene(whole, []).columns["x"]) == 0
    for wrong in ([0.3, 0.1], [-1.0], [math.nan], [[0.1], [0.2]], "soon"):
        with pytest.raises(InputError, match="times"):
            simulate_scene(whole, wrong)  # type: ignore[arg-type]


def test_without_friction_nothing_moves_at_rest():
    """There is neither a speed nor a force for a scale of errors."""
    run = simulate_scene(
        scene(puck={"friction": 0.0}, launch={"velocity": [0, 0], "spin": 0}, time=1.0)
    )
    assert run.end == "at rest" and run.end_error < 1e-14


def test_what_is_hardly_launched_on_a_steep_slope_goes_as_from_rest():
    """Errors were held to a share of the launch, below the rounding of what came of it."""
    runs = [
        simulate_scene(scene(
            puck={"base": "box:0.6x0.4", "friction": 0.1}, floor={"slope": 0.3}, time=0.5,
            launch={"velocity": [-speed, 2 * speed], "spin": 0.0}))
        for speed in (0.0, 1e-12)
    ]  # fmt: skip
    assert runs[1].last["x"] == pytest.approx(runs[0].last["x"], abs=1e-10)

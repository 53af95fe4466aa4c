"""What friction holds at rest, against a search with friction by quadrature."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scenes import simulate_scene
from scipy.optimize import minimize_scalar

from puck_tables.contact.closed_form import moment_balance
from puck_tables.contact.integrals import slip_direction
from puck_tables.contact.quadrature import integrals

G = 9.80665


def scene(force: float, torque: float, **parts: Any) -> dict[str, Any]:
    """A puck at rest, r = 1 m, f m g = 1 N, under a force along a slanting line and a torque."""
    return {
        "puck": {
            "radius": 1.0, "mass": 1.0 / (0.2 * G), "height": parts.pop("height", 0.0),
            "friction": 0.2,
        },
        "floor": {**parts.pop("floor", {})},
        "force": {"constant": [0.8 * force, 0.6 * force], "torque": torque},
        "time": 1.0,
        **parts,
    }  # fmt: skip


def friction(phi: float, delta: float) -> tuple[float, float, float]:
    """Force along and across the slip and torque, in units of f N and f N r."""
    rho = moment_balance(integrals(phi), slip_direction(phi), delta)
    cosine, sine = math.cos(phi), math.sin(phi)
    return (
        cosine * float(rho.parallel),
        sine * cosine * float(rho.perpendicular),
        0.5 * sine * float(rho.spin),
    )


@pytest.mark.parametrize("ratio", [0.05, 0.3, 0.6, 2.0, 40.0])
def test_no_slip_gains_energy(ratio: float) -> None:
    """A flat puck: held up to the smallest s with s (F cos φ + T sin φ) = D(φ) for some φ."""

    def threshold(phi: float) -> float:
        along, _, turning = friction(phi, 0.0)
        heat = along * math.cos(phi) + turning * math.sin(phi)
        return heat / (math.cos(phi) + ratio * math.sin(phi))

    grid = np.linspace(0.0, 0.5 * math.pi, 181)
    best = grid[np.argmin([threshold(phi) for phi in grid])]
    limit = minimize_scalar(
        threshold, bounds=(max(best - 0.02, 0.0), min(best + 0.02, 0.5 * math.pi)),
        method="bounded", options={"xatol": 1e-9},
    ).fun  # fmt: skip
    for share, end in ((1.0 - 1e-9, "at rest"), (1.0 + 1e-9, "time is up")):
        force = share * limit
        assert simulate_scene(scene(force, ratio * force)).end == end


@pytest.mark.parametrize("phi", [0.2, 0.8, 1.2])
@pytest.mark.parametrize("height", [0.0, 1.0, 2.5])
@pytest.mark.parametrize("sense", [-1.0, 1.0])
def test_held_up_to_friction_in_a_slip(phi: float, height: float, sense: float) -> None:
    along, across, turning = friction(phi, 0.4 * height)
    force = math.hypot(along, across)
    for share, end in ((1.0 - 1e-9, "at rest"), (1.0 + 1e-7, "time is up")):
        run = simulate_scene(scene(share * force, sense * share * turning, height=height))
        assert run.end == end
    # it starts in that slip, turned from the force as friction is from the slip
    assert math.atan2(abs(run.last["spin"]), math.hypot(run.last["vx"], run.last["vy"])) == (
        pytest.approx(phi, abs=1e-5)
    )
    turned = math.atan2(run.last["vy"], run.last["vx"]) - math.atan2(0.6, 0.8)
    assert turned == pytest.approx(-sense * math.atan2(across, along), abs=1e-5)


@pytest.mark.parametrize("kind", ["rail", "blade"])
def test_a_guide_bears_what_is_across(kind: str) -> None:
    """Only the part along the guide counts: here 0.8 of the force."""
    hold = {"kind": kind, "angle": 0.0}
    for share, end in ((1.0 - 1e-9, "at rest"), (1.0 + 1e-9, "time is up")):
        assert simulate_scene(scene(share / 0.8, 0.0, constraint=hold)).end == end


def test_a_pivot_turns_in_one_way_only() -> None:
    reach = 0.7
    along, _, turning = friction(math.atan2(1.0, reach), 0.0)
    limit = turning + reach * along
    hold = {"kind": "pivot", "reach": reach}
    for share, end in ((1.0 - 1e-9, "at rest"), (1.0 + 1e-9, "time is up")):
        assert simulate_scene(scene(0.0, share * limit, constraint=hold)).end == end


def test_a_torque_that_grows_slips_and_follows_its_law(tmp_path: Any) -> None:
    """Spin alone: slips at (2/3) f N r, then I ω′ = T − (2/3) f N r."""
    path = tmp_path / "torque.csv"
    np.savetxt(path, [[0, 0, 0, 0], [2, 0, 0, 2]], delimiter=",")
    whole = scene(0.0, 0.0) | {"force": {"over_time": str(path)}, "time": 1.5}
    run = simulate_scene(whole)
    assert run.events[0].what == "slip"
    assert run.events[0].time == pytest.approx(2.0 / 3.0, rel=1e-9)
    inertia = 0.5 / (0.2 * G)
    assert run.last["spin"] == pytest.approx(0.5 * (1.5 - 2.0 / 3.0) ** 2 / inertia, rel=1e-8)


def test_a_force_that_grows_beside_a_torque(tmp_path: Any) -> None:
    """The slow start of a slip whose direction turns: no steps without number."""
    path = tmp_path / "force.csv"
    np.savetxt(path, [[0, 0, 0, 0.3], [1, 1.2, 0.1, 0.3]], delimiter=",")
    whole = scene(0.0, 0.0, height=1.0) | {"force": {"over_time": str(path)}, "time": 1.0}
    run = simulate_scene(whole)
    assert run.steps < 20_000
    assert run.energy_residual < 1e-9
    finest = simulate_scene({**whole, "time": 1.0, "tol": 1e-11})
    speed = abs(finest.last["vx"])
    for name in ("vx", "vy", "spin"):
        assert abs(run.last[name] - finest.last[name]) <= 1e-8 * speed

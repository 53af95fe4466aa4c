"""Cushions: nothing passes them, rebounds die out, the rim slides and rolls, wedges hold."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scenes import simulate_scene

G = 9.80665


def events(run: Any, what: str) -> list[float]:
    return [event.time for event in run.events if event.what == what]


def forces(folder: Path, rows: list[list[float]]) -> dict[str, str]:
    np.savetxt(folder / "force.csv", rows, delimiter=",", fmt="%.17g")
    return {"over_time": str(folder / "force.csv")}


@pytest.mark.parametrize("tol", [1e-3, 1e-6, 1e-9])
def test_a_wall_that_a_step_would_leap(tol: float, tmp_path: Path) -> None:
    """A force that grows: x is a cubic, which a step follows exactly, in and out of the wall."""
    slope = 5.90478678698
    run = simulate_scene({
        "puck": {"radius": 0.01}, "launch": {"velocity": [1.0, 0.2], "position": [0.01, 0.0]},
        "force": forces(tmp_path, [[0, -4, 0], [10, 10 * slope - 4, 0]]),
        "wall": [{"point": [0, 0], "normal": [1, 0], "restitution": 0.5}],
        "time": 1.9, "tol": tol,
    })  # fmt: skip
    roots = np.roots([slope / 6.0, -2.0, 1.0])
    assert events(run, "impact")[0] == pytest.approx(min(roots[roots > 0]), rel=1e-12)


@pytest.mark.parametrize("restitution", [0.0, 0.3, 0.9, 0.999, 1.0])
def test_rebounds_straight_down_a_slope_die_out(restitution: float) -> None:
    """Up at a₊, down at a₋ = g sin α ± f g cos α: each hop shorter by e √(a₋/a₊)."""
    r, f, slope, v0 = 0.04, 0.1, 0.4, 0.5
    up, down = (G * (math.sin(slope) + s * f * math.cos(slope)) for s in (1.0, -1.0))
    run = simulate_scene({
        "puck": {"radius": r, "friction": f}, "floor": {"slope": slope},
        "launch": {"velocity": [v0, 0.0]},
        "wall": [{"point": [0.2, 0], "normal": [-1, 0], "restitution": restitution}],
    })  # fmt: skip
    hits = math.sqrt(v0**2 + 2.0 * down * (0.2 - r))
    first = (hits - v0) / down
    back = restitution * hits
    ratio = restitution * math.sqrt(down / up)
    hop = back / up + back / math.sqrt(up * down)
    assert run.end == "at rest"
    assert [event.what for event in run.events][-2:] == ["contact", "stick"]
    # the last rebounds, lower than digits tell, are a contact, as the estimate says
    late = abs(run.end_time - first - hop / (1.0 - ratio)) * run.rate_scale / run.speed_scale
    assert late <= 1.1 * run.error_estimate <= 5e-6
    assert run.last["x"] == pytest.approx(0.2 - r, rel=1e-13)
    assert run.energy_residual < 1e-12


@pytest.mark.parametrize("friction", [0.1, 0.5])
def test_the_rim_slides_and_then_rolls_along_a_wall(friction: float) -> None:
    """No floor friction, pressed with P: v − rω falls at μP(1/m + r²/I) to 0; then it rolls."""
    m, r, push, v0 = 0.5, 0.1, 3.0, 0.8
    inertia = 0.5 * m * r * r
    rate = friction * push * (1.0 / m + r * r / inertia)
    stick = v0 / rate
    wall = {
        "point": [0.0, 0.0], "normal": [0.0, 1.0], "restitution": 0.5, "tangential": 0.0,
        "friction": friction,
    }  # fmt: skip
    run = simulate_scene({
        "puck": {"radius": r, "mass": m}, "launch": {"velocity": [v0, 0.0], "position": [0.0, r]},
        "force": {"constant": [0.0, -push]}, "wall": [wall], "time": 2.0 * stick + 1.0,
    }, [0.5 * stick])  # fmt: skip
    brake = friction * push / m
    assert run.columns["vx"][0] == pytest.approx(v0 - brake * 0.5 * stick, rel=1e-9)
    rolls = v0 - brake * stick
    assert run.last["vx"] == pytest.approx(rolls, rel=1e-9)
    # v = (v, 0), n = (0, 1): the rim at −r n slides with u = −v − r ω, so rolling has ω = −v/r
    assert run.last["spin"] == pytest.approx(-rolls / r, rel=1e-9)
    assert run.last["y"] == pytest.approx(r, abs=1e-14)
    assert run.energy_residual < 1e-12


@pytest.mark.parametrize("restitution", [0.3, 0.9, 0.99])
def test_oblique_rebounds_end_as_leaning_begins(restitution: float) -> None:
    """No friction: hops of 2v/a, each e times the last; then the puck slides on along the wall."""
    m, r, push, vn = 0.5, 0.1, 3.0, 0.6
    wall = {"point": [0.0, 0.0], "normal": [0.0, 1.0], "restitution": restitution}
    run = simulate_scene({
        "puck": {"radius": r, "mass": m}, "launch": {"velocity": [0.7, -vn], "position": [0.0, r]},
        "force": {"constant": [0.0, -push]}, "wall": [wall], "time": 60.0,
    })  # fmt: skip
    ends = 2.0 * restitution * vn * m / push / (1.0 - restitution)
    assert events(run, "contact")[0] == pytest.approx(ends, rel=3e-5)  # the last are too low
    assert (run.last["vy"], run.last["y"]) == (0.0, pytest.approx(r, abs=1e-15))
    assert run.last["x"] == pytest.approx(42.0, rel=1e-12)
    assert run.energy_residual < 1e-12


@pytest.mark.parametrize(
    ("half", "friction", "restitution", "rim"),
    [
        *((0.1, friction, e, {}) for friction in (0.0, 0.1) for e in (0.5, 0.9)),
        *((half, 0.1, 0.0, rim) for half in (0.1, 0.3, 0.6)
          for rim in ({}, {"tangential": 0.0, "friction": 0.3})),
    ],
)  # fmt: skip
def test_a_wedge_holds_a_puck_that_is_pushed_into_it(
    half: float, friction: float, restitution: float, rim: dict[str, float]
) -> None:
    """Without restitution at once: it leans on one wall, then on both."""
    r = 0.02
    run = simulate_scene({
        "puck": {"radius": r, "mass": 0.5, "friction": friction},
        "launch": {"velocity": [1.0, 0.3], "spin": 30.0, "position": [-1.5, 0.0]},
        "force": {"constant": [5.0, 0.0]},
        "wall": [
            {"point": [0, 0], "normal": [-math.sin(half), s * math.cos(half)],
             "restitution": restitution, **rim}
            for s in (-1, 1)
        ],
        "time": 5.0,
    })  # fmt: skip
    assert run.last["x"] == pytest.approx(-r / math.sin(half), rel=1e-12)
    assert abs(run.last["y"]) < 1e-14
    assert math.hypot(run.last["vx"], run.last["vy"]) < 1e-15
    assert run.last["spin"] == pytest.approx(0.0 if friction else 30.0, rel=1e-14)
    assert run.energy_residual < 1e-11
    if restitution == 0.0:
        caught = [(event.what, event.partner) for event in run.events if event.partner != "floor"]
        assert caught[:2] == [("impact", "wall 0"), ("contact", "wall 0")]
        assert ("contact", "wall 1") in caught[2:]
        assert run.events[-1].what == "stick" and run.end == "at rest"
        assert run.error_estimate <= 1e-8


def test_a_rough_corner_stops_a_spin() -> None:
    """Held by two walls, N₁ = Fx and N₂ = Fy bear it, the rim brakes with μ(N₁ + N₂) r."""
    r, m, mu, spin = 0.1, 0.5, 0.3, 20.0
    walls = [
        {"point": [0, 0], "normal": normal, "restitution": 0.0, "tangential": 0.0, "friction": mu}
        for normal in ([1, 0], [0, 1])
    ]
    run = simulate_scene({
        "puck": {"radius": r, "mass": m, "friction": 0.0},
        "launch": {"velocity": [0.0, 0.0], "spin": spin, "position": [r, r]},
        "force": {"constant": [-4.0, -3.0]}, "wall": walls, "time": 0.05,
    })  # fmt: skip
    # the spin pushes it along the walls: u = −rω at both, so friction is (0, +μN₁) and (−μN₂, 0)
    # in the frame of each wall; N₁ = 4 + s μ N₂ and N₂ = 3 − s μ N₁ with one sign s
    side = -1.0 if spin > 0 else 1.0
    one, two = np.linalg.solve([[1.0, side * mu], [-side * mu, 1.0]], [4.0, 3.0])
    torque = mu * (one + two) * r
    assert run.last["spin"] == pytest.approx(spin - torque / (0.5 * m * r * r) * 0.05, rel=1e-9)
    assert (run.last["x"], run.last["y"]) == (pytest.approx(r), pytest.approx(r))


def test_a_blade_grips_the_floor_it_stands_on() -> None:
    """At rest on a turntable, across the way that it goes: carried, not held back."""
    run = simulate_scene({
        "puck": {"radius": 0.1, "friction": 0.3}, "floor": {"turning": 1.0},
        "launch": {"velocity": [0.0, 0.5], "spin": 1.0, "position": [0.5, 0.0]},
        "constraint": {"kind": "blade"}, "time": 1.0,
    })  # fmt: skip
    assert run.columns["carried"].all() and run.stop_times.tolist() == [0.0]
    assert run.last["x"] == pytest.approx(0.5 * math.cos(1.0), rel=1e-11)
    assert run.last["orientation"] == pytest.approx(1.0, rel=1e-12)

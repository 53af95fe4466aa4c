"""The benchmark cases over borders of friction: by scans of the base, and by scipy."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
from astride_judge import Motion
from commands import invoke
from scipy.integrate import solve_ivp

from puck_tables import (
    Floor,
    InputError,
    Orthotropic,
    Puck,
    Scene,
    compare,
    floor_friction,
    reference_case,
)
from puck_tables.reference.answer import Answer
from puck_tables.reference.cases import CASES
from puck_tables.reference.floor_reaction import on_the_floor

ASTRIDE = ("astride-spin", "astride-crossing", "astride-stop")
_SHORT = 0.003  # s: friction bends, too, where the centre of rotation comes over a border
NOT_YET = 0.9999  # of the way to the stop, where the judge still has its digits


def by_scipy(answer: Answer, times: np.ndarray) -> np.ndarray:
    """States (6, n): from border to border, since friction bends where the rim meets one."""
    motion, launch = Motion(answer.run.scene), answer.run.scene.launch
    start = np.array([*launch.position, 0.0, *launch.velocity, launch.spin])
    strips, r = answer.floor.strips, answer.pucks[0].radius
    way = np.array([math.cos(strips.direction), math.sin(strips.direction)])

    def meets(place: float):
        def gap(_: float, y: np.ndarray) -> float:
            return float(y[:2] @ way) - place

        gap.terminal = True
        return gap

    waiting = [b + side * r for b in strips.borders for side in (-1.0, 1.0)]
    waiting = sorted(p for p in waiting if p > start[:2] @ way + 0.5 * r)
    found, now = np.empty((6, 0)), 0.0
    while now < times[-1]:
        # atol: shares of Q²/J for places, of Q for speeds
        q, j = answer.speed_scale, answer.rate_scale
        size = np.array([q * q / j] * 2 + [q * q / j / r] + [q] * 2 + [q / r])
        told = solve_ivp(
            motion.rates, (now, float(times[-1])), start, "DOP853", rtol=1e-13, atol=1e-13 * size,
            t_eval=times[times > now], events=[meets(p) for p in waiting[:1]], max_step=_SHORT,
        )  # fmt: skip
        assert told.success
        found = np.column_stack([found, told.y]) if told.y.size else found
        if told.status == 0:
            break
        now, start = float(told.t_events[0][0]), told.y_events[0][0]
        waiting.pop(0)
    return found


def shares_off(answer: Answer, times: np.ndarray, truth: np.ndarray) -> np.ndarray:
    """Gaps (6, n) to true states, in Q²/J, Q²/(J r), Q and Q/r."""
    told = answer(times)
    ours = np.stack([getattr(told, n) for n in ("x", "y", "orientation", "vx", "vy", "spin")])
    q, j, r = answer.speed_scale, answer.rate_scale, answer.pucks[0].radius
    length = q * q / j
    return np.abs(ours - truth) / np.array([length, length, length / r, q, q, q / r])[:, None]


@pytest.mark.thorough
@pytest.mark.parametrize("name", ASTRIDE)
def test_states_by_an_independent_integrator(name: str):
    """Within the bound printed, as small as the page says, to where 1e-4 of the time is left."""
    answer = reference_case(name)
    assert answer.end == "at rest"
    assert answer.share_bound <= (2e-10 if name == "astride-stop" else 1e-10)
    times = np.append(np.linspace(0.08, 0.95, 9), NOT_YET) * answer.end_time
    assert shares_off(answer, times, by_scipy(answer, times)).max() <= answer.share_bound


@pytest.mark.parametrize("name", ASTRIDE)
def test_forces_on_the_floor_by_scans_of_the_base(name: str):
    """All along, astride and not."""
    answer = reference_case(name)
    answer = answer(np.linspace(0.0, 0.99, 12) * answer.end_time)
    motion, puck = Motion(answer.run.scene), answer.pucks[0]
    load = 0.78 * puck.mass * puck.gravity
    states = np.stack([
        answer.x, answer.y, answer.orientation, answer.vx, answer.vy, answer.spin
    ])  # fmt: skip
    for n, state in enumerate(states.T):
        fx, fy, torque = -motion.force(state)
        mine = answer.floor_fx[n], answer.floor_fy[n], answer.floor_torque[n] / puck.radius
        assert mine == pytest.approx((fx, fy, torque / puck.radius), abs=1e-10 * load)
    assert answer(answer.end_time).floor_torque.tolist() == [0.0]


def test_the_limit_is_that_of_the_friction_it_stops_on():
    """A tall puck stops whole on the second strip: as a free puck of that friction would."""
    crossing = reference_case("astride-crossing")
    free = Puck(0.05, height=0.05, friction=0.35)
    assert crossing.limit_epsilon == free.limit_epsilon
    assert reference_case("astride-spin").limit_epsilon is None
    assert reference_case("astride-stop").limit_epsilon is None


@pytest.mark.parametrize(
    ("grain", "along"),
    [
        (Orthotropic((0.1, 0.3)), 0.1), (Orthotropic((0.3, 0.1)), 0.3),
        (Orthotropic((0.5, 1.0), law=[[0.0, 0.6], [1.0, 0.4], [2.0, 0.4]]), 0.2),
    ],
)  # fmt: skip
def test_the_force_on_a_floor_with_a_grain(grain: Orthotropic, along: float):
    puck = Puck(0.05, mass=0.1, gravity=10.0)
    scene = Scene(puck, Floor(orthotropic=grain))
    slides = {name: np.zeros(1) for name in ("time", "x", "y", "vy", "spin")} | {"vx": np.ones(1)}
    found = [float(part[0]) for part in on_the_floor(puck, scene, slides)]
    assert found == pytest.approx([along, 0.0, 0.0], abs=1e-14)


def test_a_log_of_it_is_compared(tmp_path: Path):
    exact, shifted = tmp_path / "exact.csv", tmp_path / "shifted.csv"
    answer = reference_case("astride-crossing", dt=0.002)
    answer.save(exact)
    rows = [line.split(",") for line in exact.read_text().splitlines()]
    place = next(n for n, name in enumerate(rows[0]) if name.startswith("y"))
    for row in rows[20:]:
        row[place] = repr(float(row[place]) + 1e-3)
    shifted.write_text("\n".join(",".join(row) for row in rows))
    assert compare(exact, "astride-crossing").rows()[0]["place_error_max"] == 0.0
    found = compare(shifted, "astride-crossing")
    assert found.rows()[0]["place_error_max"] == pytest.approx(1e-3, rel=1e-9)
    assert any("delta = 0.7 where it stops" in told for told in found.truths())


@pytest.mark.parametrize("name", ASTRIDE)
def test_friction_over_epsilon_is_refused(name: str):
    with pytest.raises(InputError, match=f"case {name} friction is not the same everywhere"):
        floor_friction(name, [1.0])


def test_the_command_line_says_where_the_borders_are():
    told = invoke("reference", "astride-spin").output
    assert "strips.borders = [0] m, strips.friction = [0.78, 0.67]" in told
    listed = json.loads(invoke("reference", "--json").output)
    assert [one["name"] for one in listed] == [case.name for case in CASES]
    assert {*ASTRIDE} < {case.name for case in CASES}

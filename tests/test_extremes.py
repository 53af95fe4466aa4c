"""Arguments pushed to their ends, each with a stated bound; the README's table of extremes."""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest

from puck_tables import flow, limit_ratio, load_stop_table, resultants, simulate, stop
from puck_tables.motion.equations import SIZE
from puck_tables.motion.path import STOPPED, integrate
from puck_tables.motion.steppers import RK4
from puck_tables.similarity.check import looked_up
from puck_tables.similarity.exact import exact_stops

V0, W0, DELTA = (0.6, -0.4), 1.7, 0.3
SCALES = [(1e-150, 1.0, 1.0), (1e150, 1e150, 1.0), (1e-100, 1e-150, 1.0), (1.0, 1e-150, 1e-150),
          (1e75, 1.0, 1e150), (1.0, 1e150, 1e150), (3e-7, 2e-9, 5e3)]  # fmt: skip


@pytest.mark.parametrize(("speed", "decel", "radius"), SCALES)
def test_answers_are_scale_free(speed: float, decel: float, radius: float):
    """Speeds, J and r from 1e-150 to 1e150: the same digits to 1e-14, places as far as they go."""
    base = {"stop": stop(V0, W0, delta=DELTA), "run": simulate(V0, W0, delta=DELTA, exact=True)}
    v0 = (V0[0] * speed, V0[1] * speed)
    w0 = W0 * (speed / radius)
    units = {"delta": DELTA, "decel": decel, "radius": radius}
    time, length = speed / decel, speed / decel * speed
    found = stop(v0, w0, **units)
    run = simulate(v0, w0, **units, exact=True, mass=1e-3, frames=3)
    state = flow(v0, w0, [0.4 * time], **units)
    middle = flow(V0, W0, [0.4], delta=DELTA)
    assert float(found.stop_time) / time == pytest.approx(float(base["stop"].stop_time), rel=1e-14)
    assert run.stop_time / time == pytest.approx(base["run"].stop_time, rel=1e-14)
    assert state.speed[0] / speed == pytest.approx(middle.speed[0], rel=1e-14)
    assert state.spin[0] / (speed / radius) == pytest.approx(middle.spin[0], rel=1e-14)
    if 1e-300 < length < 1e300:
        for got, wanted in ((found, base["stop"]), (run, base["run"])):
            np.testing.assert_allclose(
                np.array(got.stop_position) / length, wanted.stop_position, rtol=1e-13
            )
        assert state.x[0] / length == pytest.approx(middle.x[0], rel=1e-13)


def exact_resultants(phi: mpmath.mpf, delta: float) -> list[float]:
    """By the textbook combinations of elliptic integrals, with the digits they need."""
    s = mpmath.cot(phi)
    k2 = s * s if s < 1 else 1 / s**2
    E, K = mpmath.ellipe(k2), mpmath.ellipk(k2)
    if s < 1:
        a = mpmath.mpf(4) / 3 * ((s + 1 / s) * E + (s - 1 / s) * K)
        b = mpmath.mpf(4) / 45 * ((7 - 2 * s**2 + 3 / s**2) * E + (2 + s**2 - 3 / s**2) * K)
        d = mpmath.mpf(4) / 9 * ((4 - 2 * s**2) * E + (s**2 - 1) * K)
    else:
        a = mpmath.mpf(4) / 3 * ((1 + s**2) * E + (1 - s**2) * K)
        b = mpmath.mpf(4) / 45 * ((7 * s - 2 * s**3 + 3 / s) * E + (-8 * s + 2 * s**3 + 6 / s) * K)
        d = mpmath.mpf(4) / 9 * ((4 * s - 2 * s**3) * E + (-5 * s + 2 * s**3 + 3 / s) * K)
    cosine, sine = mpmath.cos(phi), mpmath.sin(phi)
    a, b, d = a / (mpmath.pi * cosine), b / (mpmath.pi * sine), d / (mpmath.pi * sine)
    D = 1 - delta**2 * sine**2 * b * (b - d)
    spin = 2 * (d + delta**2 * cosine**2 * a * b * (d - 2 * b) / D)
    return [float(x) for x in (a / D, delta * a * b / D, spin)]


@pytest.mark.parametrize("delta", [0.0, 5e-324, 1e-160, 1.0 - 2.0**-53, 1.0])
def test_resultants_next_to_the_special_angles(delta: float):
    """φ from 1e-300 (1e-16 where φ cannot come nearer) to 0.1 from 0, π/4 and π/2: 1e-14."""
    near = [10.0**-n for n in (1, 2, 4, 8, 12, 16)]
    angles = [*near, 1e-60, *(math.pi / 4 + s * n for n in near for s in (1, -1)),
              *(math.pi / 2 - n for n in near[:-1])]  # fmt: skip
    for phi in angles:
        with mpmath.workdps(30 + int(5 * max(0.0, -math.log10(min(phi, math.pi / 2 - phi))))):
            exact = exact_resultants(mpmath.mpf(phi), delta)
        got = resultants(phi, delta)
        assert [float(x) for x in got] == pytest.approx(exact, abs=1e-14), phi
    ends = resultants([1e-300, 5e-324], delta)
    assert ends.spin.tolist() == pytest.approx([(4 - delta**2) / 8] * 2, abs=1e-15)


def test_launches_on_the_edges_of_the_cells():
    """Where one polynomial piece meets the next: 1e-10, and no jump."""
    table = load_stop_table()
    ratio = table.axis.ratio()[1::9]
    u = np.concatenate([np.log(ratio), -np.log(ratio)])
    delta = np.linspace(0.0, 1.0, u.size)
    assert np.abs(looked_up(table, u, delta) - exact_stops(u, delta)).max() <= 1.1e-10
    below, above = (looked_up(table, np.nextafter(u, s * np.inf), delta) for s in (-1, 1))
    assert np.abs(above - below).max() <= 2e-15


def test_on_the_limit_ratio_nothing_moves_away():
    for delta in (0.0, 0.4, 1.0):
        ratio = float(limit_ratio(delta))
        run = simulate((1.0, 0.0), ratio, delta=delta, exact=True, frames=9)
        states = flow((1.0, 0.0), ratio, run.time, delta=delta)
        assert run.regime == "D"
        for speed, spin in ((run.speed, run.spin), (states.speed, states.spin)):
            moving = speed > 0.0
            assert moving[:-1].all()
            np.testing.assert_allclose(spin[moving] / speed[moving], ratio, rtol=1e-9)


def test_zeros_of_either_sign():
    base = stop((1.0, 0.0), 0.0)
    signed = stop((1.0, -0.0), -0.0)
    assert signed.stop_position.tolist() == base.stop_position.tolist()
    for w0 in (0.0, -0.0):
        run = simulate((0.0, -0.0), w0)
        assert (run.regime, run.stop_time, run.stop_position) == ("A", 0.0, (0.0, 0.0))
    still = flow((-0.0, 0.0), -2.0, [0.5, 1e9])
    assert still.x.tolist() == [0.0, 0.0]
    assert still.spin.tolist() == pytest.approx([-4.0 / 3.0, 0.0], abs=1e-15)


def test_a_million_steps_add_rounding_only():
    """RK4 with 1e6 steps: what is left is the rounding of a million sums, 1e-11."""
    result, none = np.empty(SIZE + 1), np.empty(0)
    status, steps = integrate(
        0.7, RK4, 1e6, 1.0, none, 0.6, 3_000_000, none, np.empty((0, SIZE)), result
    )
    assert status == STOPPED
    assert steps > 900_000
    exact = exact_stops(np.array([0.7]), np.array([0.6]))[0, :3]
    assert np.abs(result[2:5] - exact).max() <= 1e-11


def test_energy_closes_in_every_regime():
    """The work of friction accounts for the energy to 1e-10 of it, and energy never grows."""
    ratio = float(limit_ratio(0.7))
    for k in (0.0, 1e-200, 1e-6, 0.5, 1.0, ratio, 1.6, 40.0, 1e12):
        run = simulate((1.0, 0.0), k, delta=0.7, tol=1e-11, exact=True, frames=50)
        assert run.energy_residual <= 1e-10
        energy = run.speed**2 + 0.5 * run.spin**2
        assert np.all(np.diff(energy) <= 1e-13 * energy[0])
    spin = simulate((0.0, 0.0), 3.0, delta=0.7)
    assert spin.energy_residual <= 1e-10

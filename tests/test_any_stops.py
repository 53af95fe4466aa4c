"""Stops, maps, states and aims of every puck: against integration with truth friction."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from any_puck import stops_by_truth
from pucks import aim, simulate, sweep
from rarely import nightly, thorough
from test_any_puck import PUCKS, launch, starts

import puck_tables as pt
from puck_tables import law_of, states, stop
from puck_tables.contact.laws import HOMOGENEOUS
from puck_tables.errors import AccuracyError, InputError
from puck_tables.motion.body import body_of
from puck_tables.motion.friction_source import section_friction
from puck_tables.stopping.exact import integrated_stops
from puck_tables.stopping.per_height import ALONE, MANY
from puck_tables.stopping.stop_section import stop_section_for

QUICK = [PUCKS[2], PUCKS[6]]
TURNS = (("hertz", 0.8), ("ring", 0.8), ("annulus:0.8", 0.8), ("uniform", 2.0))


def stops_of(puck: tuple[str, float, float], u: np.ndarray, **options: object) -> np.ndarray:
    """T, X, Y, path length and body angle (5, n) by ``stop``."""
    law, delta, gyration = puck
    launches = [launch(one) for one in u]
    found = stop(
        np.array([v for v, _ in launches]), np.array([w for _, w in launches]), delta=delta,
        pressure=law, gyration=gyration, **options,
    )  # fmt: skip
    assert (found.status == 0).all()
    return np.stack([
        found.stop_time, *found.stop_position.T, found.path_length, found.body_angle,
    ])  # fmt: skip


@pytest.mark.parametrize(
    ("puck", "tolerances"),
    [*(thorough(puck, (1e-4, 1e-8)) for puck in QUICK),
     *(nightly(puck, 10.0 ** -np.arange(3.0, 11.0)) for puck in PUCKS)],
)  # fmt: skip
def test_tol_is_honoured_by_truth_friction(puck, tolerances):
    u = starts(*puck, np.random.default_rng(8))
    truth = stops_by_truth(*puck, u, 3e-14)  # at 3e-13 it is off by 7e-11 where the base lifts
    for tol in tolerances:
        for method in ("look-up", "adaptive", "rk4"):
            if method == "rk4" and tol < 1e-7:
                continue
            error = np.abs(stops_of(puck, u, tol=tol, method=method) - truth)
            assert error[:3].max() <= tol, (puck, tol, method, u[error[:3].max(axis=0).argmax()])
            assert error[3:].max() <= 2.0 * tol


@pytest.mark.parametrize("puck", PUCKS)
def test_a_stop_section_everywhere_against_integration(puck: tuple[str, float, float]):
    law, delta, gyration = puck
    body = body_of(*puck)
    found = stop_section_for(body, 1e-6)
    rng = np.random.default_rng(3)
    lines = np.array([0.0, *body.friction(1e-3).lines, 0.5 * np.pi])
    near = rng.choice(lines, 150) + 10.0 ** -rng.uniform(0.5, 12.0, 150) * rng.choice([-1, 1], 150)
    phi = np.concatenate([rng.uniform(0.0, 0.5 * np.pi, 250), near])
    phi = phi[(phi > 0.0) & (phi < 0.5 * np.pi)]
    u = np.log(np.tan(phi))
    truth = integrated_stops(
        u, np.full(u.size, delta), section_friction(body, 1e-8).coefficients, 1e-10
    )
    looked_up = stops_of((law, delta, gyration), u, tol=1e-6, method="look-up")
    assert np.abs(looked_up - truth[:, :5].T).max() <= 1.2 * found.error
    assert found.error <= 1e-6


def test_order_4_of_stop_sections():
    cells, errors = [], []
    body = body_of("uniform", 2.0, HOMOGENEOUS)
    for accuracy in (1e-4, 1e-6, 1e-8):
        found = stop_section_for(body, accuracy)
        cells.append(found.spline.cells)
        errors.append(found.spline.error[:5].max())
    assert -np.polyfit(np.log(cells), np.log(errors), 1)[0] >= 3.6


def test_what_is_taken_and_said():
    few = stop((1.0, 0.0), np.linspace(0.0, 5.0, 20), delta=2.0)
    many = stop((1.0, 0.0), np.linspace(0.0, 5.0, MANY), delta=2.0)
    assert (few.method, many.method) == ("integrated", "look-up")
    assert few.selections[0].error <= 1e-8 >= many.selections[0].error > 0.0
    assert "look-up, section, for 1 height, with 300 or more launches" in many.explain()
    assert np.abs(few.stop_time[[0, -1]] - many.stop_time[[0, -1]]).max() <= 2e-7
    both = stop((1.0, 0.0), 1.0, delta=[*np.full(MANY, 2.0), 1.5])
    assert both.method == "look-up and integrated"
    plain = stop((1.0, 0.0), 1.0, delta=[0.5, 1.0])
    assert plain.selections[0].scheme.name == "look-up"
    for options, error, words in (
        ({"delta": np.linspace(0.0, 3.0, 1000)}, InputError, "at most 500"),
        ({"delta": 4.0}, InputError, "tips"),
        ({"delta": 2.0, "tol": 1e-12}, AccuracyError, "from 1e-11"),
        ({"delta": 2.0, "tol": 2e-11, "method": "look-up"}, AccuracyError, "from 1e-10"),
        ({"delta": 2.0, "method": "euler"}, InputError, "method must be"),
        ({"pressure": "ring", "delta": 2.1}, InputError, "full contact"),
    ):
        with pytest.raises(error, match=words):
            stop((1.0, 0.0), 1.0, **options)
    huge = stop((1e200, 0.0), 1.0, delta=2.0)
    assert huge.status == 2
    assert np.isnan(huge.stop_time)
    rest = stop((0.0, 0.0), [0.0, -2.0], delta=2.0)
    assert rest.stop_time.round(14).tolist() == [0.0, 1.5]
    assert (rest.stop_position == 0.0).all()


def test_a_map_has_the_same_bits_however_it_is_cut(tmp_path: Path):
    spins, speeds = np.linspace(-3.0, 3.0, 23), np.linspace(0.0, 2.0, 17)
    seen: list[tuple[int, int]] = []
    options = {"delta": [0.5, 2.0], "pressure": "uniform", "tol": 1e-6}
    whole = sweep(spins, speeds, progress=lambda *done: seen.append(done), **options)
    assert whole.method == "look-up"
    assert seen == sorted(seen)
    assert seen[-1][0] == seen[-1][1]
    for threads, chunk in ((1, 1), (3, 7), (2, 10_000)):
        again = sweep(spins[:5], speeds[:3], threads=threads, chunk=chunk, **options)
        other = sweep(spins[:5], speeds[:3], **options)
        assert again.method == "look-up and integrated"
        np.testing.assert_array_equal(again.stop_x, other.stop_x)
        cut = sweep(spins, speeds, threads=threads, chunk=max(chunk, 100), **options)
        for name in ("stop_time", "stop_x", "stop_y", "turn_angle", "body_angle", "path_length"):
            np.testing.assert_array_equal(getattr(cut, name), getattr(whole, name))
    pytest.importorskip("zarr")
    kept = sweep(spins, speeds, store=tmp_path / "kept.zarr", **options).load()
    np.testing.assert_array_equal(kept.stop_y, whole.stop_y)
    with pytest.raises(InputError):
        sweep(spins, speeds, store=tmp_path / "kept.zarr", **{**options, "gyration": 0.9})


@pytest.mark.parametrize("puck", [PUCKS[2], PUCKS[6]])
def test_states_are_those_of_the_trajectory(puck: tuple[str, float, float]):
    law, delta, gyration = puck
    options = {"delta": delta, "pressure": law, "gyration": gyration, "radius": 0.3, "decel": 2.0}
    velocities, spins = np.array([(1.0, 0.5), (0.0, 0.0), (0.2, -0.1)]), np.array([2.0, 3.0, -9.0])
    times = np.array([0.0, 0.1, 0.3, 50.0])
    found = states(velocities[:, None, :], spins[:, None], times, **options)
    for n in range(3):
        run = simulate(velocities[n], spins[n], times=times, **options)
        for name in ("x", "y", "heading", "orientation", "speed", "spin"):
            error = getattr(found, name)[n] - getattr(run, name)
            assert np.abs(error).max() <= 1e-8, (n, name)


@pytest.mark.thorough
def test_aims_of_other_pucks_hit(tmp_path: Path):
    for options in (
        {"delta": 2.0}, {"pressure": "annulus:0.8", "gyration": 0.9}, {"gyration": 2.0, "delta": 0},
    ):  # fmt: skip
        for wish in ({"spin": 3.0}, {"speed": 1.5}, {"stop_time": 3.0}, {"count": 3}):
            found = aim((2.0, 0.3), **wish, **options)
            assert found.launch_spin.size >= 1
            assert found.miss.max() <= 1e-8
    aim((2.0, 0.3), delta=2.0, count=2).plot(tmp_path / "aim.png")
    turning = float(law_of("hertz").friction(0.5 * math.pi, 0.0).spin)
    spot = aim((0.0, 0.0), spin=2.0, pressure="hertz")
    assert spot.stop_time[0] == pytest.approx(2.0 / turning)


def test_a_tall_puck_may_be_aimed_in_three_ways():
    """Just below φ = π/4 the stop time of a puck with δ = 3.9 falls with its spin."""
    u = np.linspace(-0.5, 0.5, 81)
    friction = section_friction(body_of("uniform", 3.9, HOMOGENEOUS), 1e-6)
    stops = integrated_stops(u, np.full(u.size, 3.9), friction.coefficients, 1e-9)
    duration = stops[:, 0] / np.sqrt(np.hypot(stops[:, 1], stops[:, 2])) * math.sqrt(2.0)
    falling = np.flatnonzero(np.diff(duration) < 0.0)
    assert falling.size > 2
    middle = duration[[falling[0], falling[-1] + 1]].mean()
    found = aim((2.0, 0.0), stop_time=float(middle), delta=3.9)
    assert found.launch_spin.size == 6
    assert found.miss.max() <= 1e-8
    assert np.abs(found.stop_time - middle).max() <= 1e-8


@pytest.mark.thorough
@pytest.mark.parametrize(("law", "delta"), TURNS)
def test_how_far_headings_turn(law: str, delta: float) -> None:
    """Looked up to what the docstring says, of slides that hardly spin and spins that hardly slide.

    Against integration, which reads friction from other tables.
    """
    ratio = np.geomspace(1e-3, 1e3, 200)
    v = np.stack([1.0 / np.hypot(1.0, ratio), np.zeros(200)], axis=1)
    told = [
        stop(v, ratio * v[:, 0], delta=delta, pressure=law, tol=tol).turn_angle
        for tol in (1e-6, 1e-8, 1e-11)
    ]
    for found, tol in ((told[0], 1e-6), (told[1], 1e-8)):
        assert np.abs(found - told[2]).max() < 2000.0 * tol


@pytest.mark.parametrize("seed", range(2))
def test_few_launches_stop_where_many_do(seed: int):
    """Few are each tried themselves, many by a setting for all: to the tolerance it is the same."""
    rng = np.random.default_rng(seed)
    law = ["ring", f"annulus:{rng.uniform(0.2, 0.9):.3f}"][seed]
    puck = pt.Puck(rng.uniform(0.02, 0.1), 0.01, rng.uniform(0.1, 0.5), pressure=law)
    v, w = rng.uniform(-1.0, 1.0, (ALONE + 1, 2)), rng.uniform(-40.0, 40.0, ALONE + 1)
    v[0], w[1], w[2], v[2] = 0.0, 0.0, 0.0, 0.0
    few, many = puck.stop(v[:5], w[:5], tol=1e-8), puck.stop(v, w, tol=1e-8)
    slip = np.hypot(np.hypot(*v[:5].T), puck.radius * w[:5])
    allowed = 2e-8 * slip / puck.decel
    assert (np.abs(few.stop_time - many.stop_time[:5]) <= allowed).all()
    off = np.hypot(*(few.stop_position - many.stop_position[:5]).T)
    assert (off <= allowed * slip).all()
    for name in ("path_length", "body_angle", "turn_angle"):
        one, other = getattr(few, name), getattr(many, name)[:5]
        np.testing.assert_allclose(one, other, rtol=1e-5, atol=1e-9)
    assert "measured" in few.explain()

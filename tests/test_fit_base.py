"""Films of bodies on a base that is not round: a block of wood, a slider with three corners.

Truth is scipy's DOP853 over friction by ``judges/base_judge.py``.
"""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from base_judge import Judge
from commands import invoke
from rarely import few, thorough
from scipy.integrate import solve_ivp

import puck_tables as pt

G = 9.80665
NOISE = 3e-4, 4e-3
OUTLINES = {
    "box:0.2x0.1": [[-0.1, -0.05], [0.1, -0.05], [0.1, 0.05], [-0.1, 0.05]],
    "polygon:-0.05,-0.04;0.08,-0.03;0,0.07": [[-0.05, -0.04], [0.08, -0.03], [0.0, 0.07]],
}


def turn(angle: float) -> np.ndarray:
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.array([[cosine, -sine], [sine, cosine]])


def film(
    rng: np.random.Generator, name: str, noise: tuple[float, float] = NOISE
) -> tuple[pt.Track, pt.Puck, np.ndarray]:
    """A noisy film of a launch, the puck, and the launch: place, velocity, spin, angle."""
    friction, flat = rng.uniform(0.1, 0.4), pt.Puck(base=name)
    height = min(rng.uniform(0.02, 0.05), 1.8 * flat.shape.highest_lever / friction)
    puck = replace(flat, friction=friction, height=height)
    corners = np.array(OUTLINES[name]) - puck.shape.middle
    judge = Judge([corners], [], 0.5 * puck.friction * puck.height, puck.gyration)
    way, speed = rng.uniform(-np.pi, np.pi), rng.uniform(0.8, 2.0)
    spin = np.exp(rng.uniform(np.log(3.0), np.log(60.0))) * rng.choice([-1.0, 1.0])
    angle = rng.uniform(-3.0, 3.0)
    start = np.array([0.1, 0.2, speed * np.cos(way), speed * np.sin(way), spin, angle])

    def rates(_: float, y: np.ndarray) -> np.ndarray:
        force, torque = judge.friction(*(turn(y[5]).T @ y[2:4]), y[4])
        pull = puck.friction * G
        push = pull * turn(y[5]) @ force
        return np.array([*y[2:4], *push, pull * torque / puck.gyration**2, y[4]])

    slip = np.hypot(speed, puck.gyration * start[4])
    t = np.arange(0.0, rng.uniform(0.5, 0.8) * slip / (puck.friction * G), 1.0 / 120.0)
    true = solve_ivp(rates, (0.0, t[-1]), start, "DOP853", t, rtol=1e-9, atol=1e-11).y
    place = true[:2].T + noise[0] * rng.normal(size=(t.size, 2))
    return pt.Track(t, place, true[5] + noise[1] * rng.normal(size=t.size), "slide"), puck, start


def off(found: pt.results.Fit, puck: pt.Puck, start: np.ndarray) -> np.ndarray:
    """Friction, height, velocity, spin and angle less the truth, in standard errors."""
    launch = found.launches[0].numbers
    names = ("launch_vx", "launch_vy", "launch_spin", "launch_angle")
    rows = [(found["friction"], puck.friction), (found["height"], puck.height)]
    rows = rows[: 1 + (found["height"].how != "known")]
    rows += [(launch[name], true) for name, true in zip(names, start[2:], strict=True)]
    assert all(number.determined for number, _ in rows)
    return np.array([(number.value - true) / number.error for number, true in rows])


@pytest.mark.parametrize("name", OUTLINES)
@pytest.mark.parametrize("seed", few(1, range(6)))
def test_friction_and_height_of_a_block_are_found(seed: int, name: str):
    track, puck, start = film(np.random.default_rng([38, seed]), name)
    found = pt.fit(track, pt.Puck(base=name))
    assert np.abs(off(found, puck, start)).max() < 4.0
    assert found["friction"].error < 0.02 * puck.friction
    assert found.complaints == () and found.puck.shape == puck.shape
    assert found.puck.gyration == pytest.approx(puck.gyration)


@pytest.mark.thorough
def test_errors_of_blocks_are_right():
    rows = []
    for seed in range(60):
        track, puck, start = film(np.random.default_rng([39, seed]), [*OUTLINES][seed % 2])
        rows.append(off(pt.fit(track, pt.Puck(base=puck.base, height=puck.height)), puck, start))
    rows = np.array(rows)
    assert np.abs(rows).max() < 4.5
    assert ((rows**2).mean(axis=0) > 0.5).all() and ((rows**2).mean(axis=0) < 1.7).all()


@pytest.mark.thorough
def test_a_box_is_not_a_disc():
    """A round puck of the same reach and gyration does not fit a block's film, which is said."""
    name = "box:0.2x0.1"
    track, puck, _ = film(np.random.default_rng([38, 1]), name)
    found = pt.fit(track, pt.Puck(base=name))
    reach = puck.shape.reach
    disc = pt.fit(track, pt.Puck(reach, gyration=puck.gyration / reach))
    assert found.complaints == () and disc.complaints
    assert disc["friction"].error > 10.0 * found["friction"].error


@pytest.mark.parametrize(
    ("factor", "more", "words"),
    [thorough(1.0, 0.5 * np.pi, "those of the y axis"),
     thorough(-1.0, 0.0, "grew the other way"),
     thorough(np.degrees(1.0), 0.0, "were in degrees")],
)  # fmt: skip
def test_angles_that_are_told_otherwise_are_named(factor: float, more: float, words: str):
    track, puck, _ = film(np.random.default_rng([38, 1]), "box:0.2x0.1")
    told = replace(track, angle=factor * track.angle + more)
    found = pt.fit(told, pt.Puck(base=puck.base, height=puck.height))
    assert found.complaints and words in found.misfit


def test_a_spin_that_is_not_followed_is_a_sentence():
    """Of a body that comes to rest, whose angles are in degrees and said to be in rad."""
    time, rng = np.arange(60) / 60.0, np.random.default_rng(3)
    run = pt.Puck(base="box:0.2x0.1", friction=0.3).simulate((1.2, 0.3), spin=8.0)
    x, y, angle = (np.interp(time, run.time, one) for one in (run.x, run.y, run.orientation))
    place = np.stack([x, y], axis=1) + NOISE[0] * rng.normal(size=(60, 2))
    angle += NOISE[1] * rng.normal(size=60)
    for factor, more in ((180.0 / np.pi, {}), (1.0, {"fixed": {"launch_spin": 500.0}})):
        with pytest.raises(pt.InputError, match="half a turn a frame"):
            pt.fit(pt.Track(time, place, factor * angle), pt.Puck(base="box:0.2x0.1"), **more)


def test_what_follows_from_a_tilt_that_is_not_told_is_not_told():
    """A block that hardly turns tells f, and no height: neither has an error."""
    t, rng = np.arange(60) / 120.0, np.random.default_rng(38)
    place = np.stack([1.5 * t - 0.5 * 0.2 * G * t * t, 0.0 * t], axis=1)
    place += NOISE[0] * rng.normal(size=place.shape)
    track = pt.Track(t, place, NOISE[1] * rng.normal(size=t.size), "straight")
    found = pt.fit(track, pt.Puck(base="box:0.2x0.1"))
    assert abs(found["friction"].value - 0.2) < 4.0 * found["friction"].error
    assert not found["delta"].determined and not found["height"].determined


def slopes_off(best) -> dict[str, float]:
    """Of the slopes of residuals by each number, how far the worst is off its finite difference."""
    problem, x, off = best.problem, best.x, {}
    slopes = problem.residuals_and_jacobian(x)[1]
    for k, name in enumerate(problem.names):
        step = 1e-4 * max(abs(x[k]), 0.1)
        moved = [problem.residuals(x + sign * step * np.eye(x.size)[k]) for sign in (1.0, -1.0)]
        by = (moved[0] - moved[1]) / (2.0 * step)
        off[name] = np.abs(slopes[:, k] - by).max() / np.abs(by).max()
    return off


def test_slopes_are_those_of_motions_nearby():
    track, puck, _ = film(np.random.default_rng([38, 2]), "box:0.2x0.1")
    best = pt.fit(track, pt.Puck(base=puck.base), free=("friction", "delta", "gyration")).estimate
    assert max(slopes_off(best).values()) < 1e-3, slopes_off(best)


def test_a_disc_as_a_base_is_a_round_puck():
    """The forecast of a film, and what is found of it."""
    numbers, launch = {"friction": 0.2, "height": 0.02}, pt.Launch((1.2, 0.3), spin=20.0)
    pucks = pt.Puck(base="disc:0.04", **numbers), pt.Puck(0.04, **numbers)
    on_base, plain = (pt.fisher(puck, launch, pt.Camera(120.0, *NOISE)) for puck in pucks)
    assert on_base.names == plain.names
    np.testing.assert_allclose(on_base.errors, plain.errors, rtol=1e-3)
    with pytest.raises(pt.InputError, match="give angle_noise"):
        pt.fisher(pucks[0], launch, pt.Camera(120.0, NOISE[0]))
    rng, t = np.random.default_rng(38), np.arange(50) / 120.0
    true = pucks[1].states(launch.velocity, launch.spin, t)
    place = np.stack([true.x, true.y], axis=1) + NOISE[0] * rng.normal(size=(50, 2))
    track = pt.Track(t, place, true.orientation + NOISE[1] * rng.normal(size=50), "disc")
    one, two = (pt.fit(track, replace(puck, height=0.0)) for puck in pucks)
    for name in ("friction", "delta"):
        assert abs(one[name].value - two[name].value) < 0.01 * two[name].error
        assert one[name].error == pytest.approx(two[name].error, rel=0.01)


def test_what_is_of_round_pucks_is_refused():
    track, puck, _ = film(np.random.default_rng([38, 3]), "box:0.2x0.1")
    flat = replace(puck, height=0.0)
    for how, words in (
        ({"impacts": True}, "cut the film before the first"),
        ({"free": ("friction", "radius")}, "radius is found"),
        ({"free": ("friction", "drag")}, "drag is found"),
        ({"free": ("friction", "air")}, "air is found"),
        ({"slip_speeds": (0.0, 1.0)}, "of round pucks alone"),
        ({"law": "stribeck"}, "of round pucks alone"),
        ({"laws": ["uniform", "hertz"]}, "laws are compared of round pucks"),
    ):
        with pytest.raises(pt.InputError, match=words):
            pt.fit(track, flat, **how)
    with pytest.raises(pt.InputError, match="has no angles"):
        pt.fit(replace(track, angle=None), flat)
    with pytest.raises(pt.InputError, match="a round one slides alike"):
        pt.Puck(0.04, height=0.0, friction=0.2).simulate((1.0, 0.0), orientation=1.0)


@pytest.mark.parametrize("name", few(1, OUTLINES))
def test_a_block_slides_as_it_stood_at_its_launch(name: str):
    track, puck, start = film(np.random.default_rng([38, 5]), name, (0.0, 0.0))
    how = {"spin": start[4], "orientation": start[5], "times": track.time}
    run = puck.simulate(start[2:4], **how)
    np.testing.assert_allclose(run.x + start[0], track.place[:, 0], atol=1e-8)
    np.testing.assert_allclose(run.y + start[1], track.place[:, 1], atol=1e-8)
    np.testing.assert_allclose(run.orientation, track.angle, atol=1e-7)
    speeds = np.gradient(track.place, track.time, axis=0, edge_order=2)
    np.testing.assert_allclose(np.stack([run.vx, run.vy], axis=1), speeds, atol=5e-3)
    rest = run(np.array([run.stop_time]))
    np.testing.assert_allclose((rest.x[0], rest.y[0]), run.stop_position, atol=1e-9)
    assert run.summary()["launch_orientation"] == start[5]
    found = pt.fit(track, pt.Puck(base=name)).simulate(times=track.time)
    np.testing.assert_allclose(found.x, run.x, atol=1e-6)
    np.testing.assert_allclose(found.orientation, run.orientation, atol=1e-5)


@pytest.mark.thorough
def test_gyration_of_a_base_is_in_metres():
    """As the puck has it: what is found, held, bounded or known of it."""
    track, puck, _ = film(np.random.default_rng([38, 1]), "box:0.2x0.1")
    names = ("friction", "gyration")
    known = pt.Puck(base=puck.base, height=puck.height)
    found = pt.fit(track, known, free=names, prior={"gyration": (0.06, 0.02)})
    assert found["gyration"].unit == "m"
    assert abs(found["gyration"].value - puck.gyration) < 4.0 * found["gyration"].error < 0.004
    assert found.puck.gyration == found["gyration"].value
    held = pt.fit(track, known, fixed={"gyration": puck.gyration})
    usual = pt.fit(track, known)
    assert held["friction"] == usual["friction"] and usual["gyration"].unit == "m"
    assert usual["gyration"].value == pytest.approx(puck.gyration, rel=1e-12)
    with pytest.raises(pt.InputError, match=r"gyration must be from 0.0111803 to 1.11803 \(m\)"):
        pt.fit(track, known, fixed={"gyration": 2.0})


def test_a_prior_of_the_height_finds_the_height():
    track, puck, _ = film(np.random.default_rng([38, 1]), "box:0.2x0.1")
    alone = pt.fit(track, pt.Puck(base=puck.base))["height"]
    told = pt.fit(track, pt.Puck(base=puck.base), prior={"height": (puck.height, 1e-4)})["height"]
    assert told.how == "found" and told.error < 1.1e-4 < alone.error
    assert abs(told.value - puck.height) < 4e-4


@pytest.mark.parametrize("round_", [thorough(False), True])
def test_a_mark_off_the_centre_is_named_and_found(round_: bool):
    """Of a block as of a disc; its slopes are those of motions nearby."""
    rng, mark = np.random.default_rng([38, 3]), np.array([0.03, -0.02])
    track, puck, start = film(rng, "box:0.2x0.1", (0.0, 0.0))
    known = pt.Puck(base=puck.base)
    if round_:
        known, start = pt.Puck(0.1), np.array([0.0, 0.0, 1.2, 0.3, 8.0, 0.0])
        puck, t = replace(known, friction=0.2, height=0.03), np.arange(80) / 120.0
        true = puck.states(start[2:4], start[4], t)
        track = pt.Track(t, np.stack([true.x, true.y], axis=1), true.orientation, "disc")
    place = track.place + np.array([turn(a) @ mark for a in track.angle])
    place += NOISE[0] * rng.normal(size=place.shape)
    angle = track.angle + NOISE[1] * rng.normal(size=place.shape[0])
    off_centre = replace(track, place=place, angle=angle)
    assert "--free friction,delta,mark_x,mark_y" in pt.fit(off_centre, known).misfit
    found = pt.fit(off_centre, known, free=("friction", "delta", "mark_x", "mark_y"))
    assert found.complaints == ()
    assert np.abs(off(found, puck, start)).max() < 4.0
    for name, true in zip(("mark_x", "mark_y"), mark, strict=True):
        assert abs(found[name].value - true) < 4.0 * found[name].error < 0.01
    assert max(slopes_off(found.estimate).values()) < 2e-3, slopes_off(found.estimate)
    held = pt.fit(off_centre, known, fixed={"mark_x": mark[0], "mark_y": mark[1]})
    assert held["friction"].error < found["friction"].error
    with pytest.raises(pt.InputError, match="mark_x, mark_y" if round_ else "has no angles"):
        pt.fit(replace(off_centre, angle=None), known, fixed={"mark_x": 0.03, "mark_y": 0.0})


def test_a_base_far_larger_than_its_slide_is_refused():
    track, _, _ = film(np.random.default_rng([38, 1]), "box:0.2x0.1")
    for known in (pt.Puck(base="box:20x10"), pt.Puck(38.0)):
        with pytest.raises(pt.InputError, match=r"lengths are in metres.*box:20cmx10cm"):
            pt.fit(track, known)


def test_the_command(tmp_path: Path):
    track, puck, _ = film(np.random.default_rng([38, 4]), "box:0.2x0.1")
    rows = np.column_stack([track.time, track.place, track.angle])
    file, saved = tmp_path / "block.csv", tmp_path / "fit.json"
    np.savetxt(file, rows, delimiter=",", header="t [s],x [m],y [m],angle [rad]", comments="")
    words = ["fit", str(file), "--base", "box:20cmx10cm", "--height", str(puck.height)]
    result = invoke(*words, "-o", saved, "--plot", tmp_path / "a.png")
    assert result.exit_code == 0, result.stderr
    assert "base            box:0.2x0.1" in result.stdout
    assert "not determined" not in result.stdout
    value = float(result.stdout.split("The friction coefficient is ")[1].split()[0])
    assert value == pytest.approx(puck.friction, rel=0.02)
    again = invoke("simulate", "--fit", saved, "--json")
    run = pt.fit(pt.read_tracks(file), pt.Puck(base=puck.base, height=puck.height)).simulate()
    assert json.loads(again.stdout)["stop_position"] == pytest.approx(run.stop_position, rel=1e-12)
    prior = invoke(*words[:4], "--prior", "height=0.04")
    assert prior.exit_code and "prior of height must be a value and a standard" in prior.stderr
    few = tmp_path / "few.csv"
    few.write_text("".join(file.read_text().splitlines(keepends=True)[:6]))
    short = invoke("fit", few, "--radius", "0.1")
    assert short.exit_code and "--noise 0.0003,0.005" in short.stderr
    both = invoke(*words, "--pressure", "hertz")
    assert both.exit_code and "round pucks" in both.stderr

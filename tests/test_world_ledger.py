"""Where the energy of pucks that push each other goes, judged by hand and by another integrator."""

from __future__ import annotations

import math

import numpy as np
import pytest
from boards import draw, puck_at
from pushing_judge import Judge

import puck_tables as pt
from puck_tables.scene.run import HEATS, WORK_NAMES, residual
from puck_tables.world.ledger import energies_of

G = 9.80665
NODES, WEIGHTS = np.polynomial.legendre.leggauss(16)


def test_a_mallet_that_pushes_works_against_the_floor():
    """It comes at v, e = 0, and goes on for s at v: m v² in the impact, f m g s after it."""
    mallet = pt.Puck(0.05, path=[[0.0, -0.2, 0.0], [1.0, 0.3, 0.0], [3.0, 0.3, 0.0]])
    puck = puck_at(0.0, 0.0, restitution=0.0)
    run = pt.Scene(pucks=[mallet, puck]).simulate()
    m, v, pushed = 0.1, 0.5, 0.2 * 0.1 * G * 0.5 * (1.0 - 0.24)
    assert run.last["work_driven"] == pytest.approx(m * v * v + pushed, rel=1e-9)
    assert run.last["heat_dry"] == pytest.approx(pushed + 0.5 * m * v * v, rel=1e-9)
    assert run.last["heat_impact"] == pytest.approx(0.5 * m * v * v, rel=1e-9)
    assert run.last["heat_rims"] == 0.0
    assert run.energy_residual < 1e-10


def judged(world: pt.World, judge: Judge, until: float) -> dict[str, float]:
    """Heats and works from now on, by Gauss quadrature over runs of the judge."""
    start, t0 = world.state(), world.time
    totals = {"heat_dry": 0.0, "heat_rims": 0.0, "work_driven": 0.0}
    for node, weight in zip(NODES, WEIGHTS, strict=True):
        t = t0 + 0.5 * (until - t0) * (1.0 + node)
        states, _, _ = judge.run(start, t0, t)
        q, v = states[:, :3].ravel(), states[:, 3:].ravel()
        accelerations, pushes, slips = judge.solved(t, q, v)
        share = 0.5 * weight * (until - t0)
        totals["heat_dry"] -= share * float(judge.forces(v) @ v)
        totals["heat_rims"] += share * float(
            sum(push[1] * slip for push, slip in zip(pushes, slips, strict=True))
        )
        # what a driven body gives is what contacts do to the others, with the heat of the rims
        masses = judge.discs[:, [1, 1, 2]].ravel()
        free = [3 * i + k for i in judge.free for k in range(3)]
        given = (masses * accelerations - judge.forces(v))[free] @ v[free]
        totals["work_driven"] += share * float(given)
    totals["work_driven"] += totals["heat_rims"]
    return totals


def booked(world: pt.World, until: float) -> dict[str, float]:
    """The same from the ledger of the world."""
    start = world.time
    world.advance(until - world.time)
    moments = np.array([start, world.time])
    found = energies_of(world, moments, world.over(moments))
    assert residual(found) < 1e-9
    return {name: float((row[1] - row[0]).sum()) for name, row in found.items()}


def rim_of(judge: Judge, world: pt.World) -> int:
    """How the rims slip now: −1, 0 or 1."""
    state = world.state()
    slip = judge.solved(world.time, state[:, :3].ravel(), state[:, 3:].ravel())[2][0]
    return 0 if abs(slip) < 1e-9 else int(math.copysign(1.0, slip))


@pytest.mark.parametrize(("friction", "span"), [(0.1, 0.05), (0.4, 0.1), (math.inf, 0.1)])
@pytest.mark.parametrize("turning", [0.0, 3.0])
def test_an_oblique_push_is_booked_as_another_integrator_has_it(friction, span, turning):
    way = [[0.0, -0.12, 0.0, 0.0], [2.0, 0.88, 0.0, 2.0 * turning]]
    how = {"restitution": 0.0, "tangential": 0.0, "rim": friction}
    puck = puck_at(0.0, 0.02, (0.0, 0.0), -4.0, height=0.0, **how)
    mallet = pt.Puck(0.05, path=way, restitution=0.0, tangential=0.0, rim=friction)
    world = pt.Scene(pucks=[mallet, puck]).world()
    first = next(e for e in world.copy().advance(1.0) if e.what == "contact")
    world.advance(first.time)
    v = (0.5, 0.0, turning)

    def path(t: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        return np.array([-0.12 + 0.5 * t, 0.0, turning * t]), np.array(v), np.zeros(3)

    discs = [[0.05, 1.0, 1.0, 0.0, 0, 0, 0], [0.03, 0.1, 0.5 * 0.1 * 0.03**2, 0.2 * G, 0, 0, 0]]
    judge = Judge(discs, [(0, 1, friction, 0)], given={0: path})
    rim = rim_of(judge, world)
    judge = Judge(discs, [(0, 1, friction, rim)], given={0: path})
    truth = judged(world, judge, world.time + span)
    found = booked(world, world.time + span)
    scale = max(map(abs, truth.values()))
    assert truth["work_driven"] > 0.0
    for name, value in truth.items():
        assert abs(found[name] - value) < 1e-8 * scale, (name, rim)


def test_rims_of_a_group_are_booked_as_another_integrator_has_them():
    how = {"radius": 0.05, "restitution": 0.0, "tangential": 0.0, "rim": 0.3, "height": 0.0}
    one = puck_at(0.0, 0.0, (1.0, 0.0), 30.0, mass=0.4, friction=0.5 / G, **how)
    two = puck_at(0.1, 0.0, (1.0, 0.0), mass=0.1, friction=2.0 / G, **how)
    world = pt.Scene(pucks=[one, two]).world()
    discs = [[0.05, m, 0.5 * m * 0.05**2, decel, 0, 0, 0] for m, decel in ((0.4, 0.5), (0.1, 2.0))]
    truth = judged(world, Judge(discs, [(0, 1, 0.3, 1)]), 0.1)
    found = booked(world, 0.1)
    assert truth["heat_rims"] > 1e-3 * truth["heat_dry"]
    for name in ("heat_dry", "heat_rims"):
        assert found[name] == pytest.approx(truth[name], rel=1e-8)
    assert found["work_driven"] == 0.0


def test_a_slope_works_and_the_floor_heats():
    """F m g cos α s is heat; straight down, from rest to rest at a wall, e = 0."""
    slope, puck = 0.3, puck_at(0.0, 0.0, (0.0, -0.1), restitution=0.0)
    wall = pt.Wall((0.0, -0.2), normal=(0.0, 1.0), restitution=0.0)
    floor = pt.Floor(slope=slope, downhill=-0.5 * math.pi)
    run = pt.Scene(pucks=[puck], walls=[wall], floor=floor, posts=[pt.Post((9, 9), 1)]).simulate()
    assert run.last["heat_dry"] == pytest.approx(0.2 * 0.1 * G * math.cos(slope) * 0.17, rel=1e-9)
    assert run.last["work_given"] == pytest.approx(0.1 * G * math.sin(slope) * 0.17, rel=1e-9)
    assert run.energy_residual < 1e-9


@pytest.mark.parametrize("seed", [1, 4])
def test_a_board_on_a_slope_keeps_its_books(seed: int):
    plain = draw(seed, 5)
    floor = pt.Floor(slope=0.1, downhill=1.0)
    scene = pt.Scene(pucks=plain.pucks, walls=plain.walls, floor=floor, time=0.6)
    run = scene.simulate()
    start = np.array([p.launch.position for p in scene.pucks])
    moved = np.stack([run.last["x"], run.last["y"]], axis=1) - start
    down = G * math.sin(0.1) * np.array([math.cos(1.0), math.sin(1.0)])
    masses = np.array([p.mass for p in scene.pucks])
    assert run.last["work_given"] == pytest.approx(float(masses @ (moved @ down)), rel=1e-8)
    assert run.energy_residual < 1e-9
    assert (
        min(run.last["heat_dry"], run.last["heat_rims"], run.last["heat_impact"]) > -1e-15
    )  # J, rounding


@pytest.mark.parametrize("seed", range(3))
def test_a_mallet_in_a_crowd_keeps_its_books(seed: int):
    crowd = draw(seed, 6, walls=False, speed=0.2)
    aim = crowd.pucks[0].launch.position[1]
    way = [[0.0, -0.9, aim - 0.01], [2.4, 0.5, aim], [2.7, 0.5, aim]]
    mallet = pt.Puck(0.06, path=way, restitution=0.2, tangential=0.0, rim=0.3)
    run = pt.Scene(pucks=[*crowd.pucks, mallet]).simulate()
    assert run.energy_residual < 1e-9
    assert run.last["work_driven"] > 0.0
    assert (
        min(run.last["heat_dry"], run.last["heat_rims"], run.last["heat_impact"]) > -1e-15
    )  # J, rounding


def test_rims_that_grip_at_the_start():
    """Nothing presses them together, but a rim without a bound on its friction grips at once."""
    one = pt.Puck(0.03, friction=0.1, tangential=0.0, launch=pt.Launch(spin=20.0))
    two = pt.Puck(0.03, friction=0.1, tangential=0.0, launch=pt.Launch(position=(0.06, 0.0)))
    run = pt.Scene(pucks=[one, two]).simulate()
    assert run.last["energy_given"] == pytest.approx(0.25 * 0.03**2 * 20.0**2, rel=1e-14)
    assert run.energy_residual < 1e-9


def test_a_stint_that_is_over_at_once_has_no_heat():
    """A row in touch and one in its nook; the striker is there at the same moment."""
    high = 0.03 * math.sqrt(3.0)

    def puck_at(x: float, y: float, velocity: tuple[float, float] = (0.0, 0.0), spin: float = 0.0):
        launch = pt.Launch(velocity, spin, (x, y))
        return pt.Puck(0.03, friction=0.1, tangential=0.0, rim=0.3, launch=launch)

    pucks = [
        puck_at(-0.06, 0, (1.0, 0.0)), puck_at(0, 0), puck_at(0.06, 0),
        puck_at(0.03, high, spin=-20.0),
    ]  # fmt: skip
    run = pt.Scene(pucks=pucks).simulate()
    assert run.last["energy_given"] == pytest.approx(0.5 + 0.09, rel=1e-14)
    assert run.energy_residual < 1e-9


@pytest.mark.parametrize("seed", range(3))
def test_a_map_books_what_its_runs_do(seed: int):
    """Heats, works and energies at the end, of boards with a floor, edge, mallet or rail drawn."""
    rng = np.random.default_rng([seed, 5036])
    how: dict[str, float] = {"height": 0.01, "friction": float(rng.uniform(0.1, 0.3))}
    speeds = rng.uniform(0.3, 2.5, 3).tolist()
    cue = pt.Puck(0.04, **how, launch=pt.Launch((speeds, 0.1), float(rng.normal(0.0, 9.0))))
    rail = pt.Constraint("rail", angle=1.5, velocity=(0.2, 0.0)) if seed == 1 else None
    launch = pt.Launch((0.2, 0.0) if rail else None, position=(0.3, float(rng.uniform(0.0, 0.02))))
    pucks = [cue, pt.Puck(0.05, **how, launch=launch, constraint=rail)]
    if seed == 2:
        pucks.append(pt.Puck(0.05, path=[[0.0, 0.9, 0.0], [1.0, 0.1, 0.0], [2.0, 0.9, 0.0]]))
    floor = [pt.Floor(slope=0.08), pt.Floor(velocity=(0.05, 0.1)), pt.Floor()][seed]
    edge = pt.Edge((0.5, 0.0), normal=(-1.0, 0.2))
    board = pt.Scene(pucks=pucks, floor=floor, edges=[edge] if seed != 2 else [], time=1.2)
    ends, path = board.sweep(), "puck[0].launch.velocity[0]"
    assert ends.energy_residual.max() < 1e-9
    for k, speed in enumerate(speeds):
        run = board.at({path: speed}).simulate()
        largest = max(float(np.max(np.abs(run.last[name]))) for name in (*HEATS, *WORK_NAMES))
        for name in (*HEATS, *WORK_NAMES, "energy_given", "energy_gone", "kinetic_energy"):
            np.testing.assert_allclose(ends.columns[name][k], run.last[name], atol=1e-7 * largest)

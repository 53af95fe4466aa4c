"""Scenes of every puck: friction laws over the slip speed, other pressures, tall pucks, strips."""

import math
import re

import numpy as np
import pytest
from commands import invoke
from rarely import thorough
from scenes import simulate_scene
from scipy.integrate import quad, solve_ivp

import puck_tables as pt
from puck_tables import Scene
from puck_tables.motion.body import STANDARD_GRAVITY
from puck_tables.scene import map_of_floor
from puck_tables.scene.by_speed import _kept_table
from puck_tables.table import speed_build

PUCK = {"radius": 0.04, "height": 0.02, "mass": 0.2}
LAUNCH = {"velocity": [0.8, 0.1], "spin": 12.0}


def law(folder, rows):
    path = folder / "law.csv"
    path.write_text("".join(f"{u},{f}\n" for u, f in rows))
    return str(path)


def test_a_constant_law_is_a_coefficient(tmp_path):
    by_law = {"law": law(tmp_path, [(0.0, 0.15), (1.0, 0.15), (3.0, 0.15)])}
    runs = [
        simulate_scene({"puck": puck, "floor": {**floor, "slope": 0.05}, "launch": LAUNCH})
        for puck, floor in ((PUCK, by_law), ({**PUCK, "friction": 0.15}, {}))
    ]
    assert runs[0].end == runs[1].end == "at rest"
    for name in ("time", "x", "y", "orientation", "heat_dry"):
        assert runs[0].last[name] == pytest.approx(runs[1].last[name], rel=1e-9)
    assert runs[0].energy_residual < 1e-9


@pytest.mark.parametrize("by_name", [False, True])
def test_a_coefficient_in_proportion_to_speed_is_viscous(tmp_path, by_name):
    rate = 0.5  # f = rate · u: the motion decays like exp(−rate g t), sliding and spin apart
    points = [(u, rate * u) for u in (0.0, 0.5, 1.0, 2.0)]
    floor = {"law": pt.PowerLaw(rate, 1.0) if by_name else law(tmp_path, points)}
    run = simulate_scene({"puck": {"radius": 0.04}, "floor": floor, "launch": LAUNCH, "time": 0.4})
    left = math.exp(-rate * STANDARD_GRAVITY * 0.4)
    assert run.end == "time is up"
    assert run.last["vx"] == pytest.approx(0.8 * left, rel=1e-9)
    assert run.last["spin"] == pytest.approx(12.0 * left, rel=1e-9)
    assert run.energy_residual < 1e-8


@pytest.mark.thorough
def test_the_slope_that_a_law_holds_is_that_of_slip_zero(tmp_path):
    rows = [(0.0, 0.3), (0.2, 0.1), (2.0, 0.1)]
    for slope, stays in ((0.99 * math.atan(0.3), True), (1.01 * math.atan(0.3), False)):
        floor = {"law": law(tmp_path, rows), "slope": slope}
        run = simulate_scene({"puck": {"radius": 0.04}, "floor": floor, "time": 0.3})
        assert (run.end == "at rest") is stays
        assert (run.last["x"] == 0.0) is stays


@pytest.mark.parametrize(
    "puck",
    [
        {"radius": 0.04, "height": 0.25},  # δ = 1.875: part of the base lifts
        {"radius": 0.04, "height": 0.02, "pressure": "annulus:0.8", "gyration": 0.9},
        {"radius": 0.04, "height": 0.01, "pressure": "galin", "gyration": 0.6},
    ],
)
def test_other_pucks_integrated_as_scenes_go_as_they_go_free(puck):
    free = {"puck": {**puck, "friction": 0.15}, "launch": LAUNCH}
    held = simulate_scene({**free, "drag": {"sliding": 1e-300}})
    plain = simulate_scene(free)
    assert "drag" in held.why and "drag" not in plain.why
    scale = 0.94**2 / (0.15 * STANDARD_GRAVITY)
    assert held.end_time == pytest.approx(plain.end_time, abs=3e-9)
    for name in ("x", "y"):
        assert held.last[name] == pytest.approx(plain.last[name], abs=2e-9 * scale)


def test_slices_of_strips_are_brought_to_one_shape_and_stay_the_same_splines():
    strips = {"borders": [0.1, 0.2], "friction": [0.02, 0.2, 0.1]}
    puck = {"radius": 0.04, "height": 0.09, "pressure": "annulus:0.5"}
    scene = Scene.from_tables({"puck": puck, "floor": {"strips": strips}, "launch": LAUNCH})
    regions = scene.world()._engine.regions
    from puck_tables.kernels.quadratic import section_ratios

    alone = regions.limits[~regions.summed]
    for n, delta in enumerate(2 * np.array(strips["friction"]) * 0.09 / 0.04):
        for phi in np.linspace(0.01, 1.56, 41):
            k = min(math.tan(phi), 1.0 / math.tan(phi))
            inverse, across, spin = section_ratios(k, phi > math.pi / 4, alone[n])
            truth = pt.law_of("annulus:0.5").resultants(phi, delta)
            assert inverse == pytest.approx(float(1.0 / truth.parallel), abs=2e-9)
            assert across == pytest.approx(float(truth.perpendicular / truth.parallel), abs=2e-9)
            assert spin == pytest.approx(float(truth.spin / truth.parallel), abs=2e-9)
    run = simulate_scene({"puck": puck, "floor": {"strips": strips}, "launch": LAUNCH})
    assert [event.what for event in run.events] == ["entry", "exit", "entry", "exit", "stick"]
    assert run.energy_residual < 1e-8


@pytest.mark.parametrize(
    ("floor", "words"),
    [
        ({"law": "none.csv"}, "none.csv"),
        ({"law": "none.csv", "strips": {"borders": [1.0], "friction": [0.1, 0.2]}}, "give one"),
    ],
)
def test_laws_that_cannot_be_are_refused(floor, words):
    with pytest.raises(pt.errors.PuckError, match=words):
        simulate_scene({"puck": PUCK, "floor": floor, "launch": LAUNCH})


def as_by_quadrature(tables, friction):
    """A launch under a law as by DOP853 with friction from quadrature: no table, no events."""
    (radius, height), g = (tables["puck"][name] for name in ("radius", "height")), STANDARD_GRAVITY

    def rates(t, y):
        vx, vy, w = y[3:]
        v, rim = math.hypot(vx, vy), radius * abs(w)
        phi, Q = math.atan2(rim, v), math.hypot(v, rim)
        rho = pt.contact.speed_resultants(phi, Q, friction, 2.0 * height / radius)
        sine = math.copysign(rim / Q, w)
        along, left = g * float(rho.parallel) / Q, g * sine * float(rho.perpendicular) / Q
        turning = g / radius * sine * float(rho.spin)
        return [vx, vy, w, -along * vx + left * vy, -along * vy - left * vx, -turning]

    launch, times = tables["launch"], [0.1, 0.2, 0.3]
    start = [0.0, 0.0, 0.0, *launch["velocity"], launch["spin"]]
    truth = solve_ivp(
        rates, (0.0, 0.3), start, "DOP853", times, rtol=1e-12, atol=1e-13, max_step=0.02
    ).y
    run = simulate_scene(tables, times)
    for name, row in zip(("x", "y", "orientation", "vx", "vy", "spin"), truth, strict=True):
        unit = 0.94 if name in ("x", "y", "vx", "vy") else 0.94 / radius
        assert run.columns[name] == pytest.approx(row, abs=tables["tol"] * unit)


@pytest.mark.thorough
@pytest.mark.parametrize("tol", [1e-6, 1e-9])
def test_a_law_with_corners_keeps_the_tolerance_of_the_scene(tmp_path, tol):
    points = [0.0, 0.2, 0.5, 0.9, 2.0], [0.3, 0.12, 0.2, 0.2, 0.1]
    floor = {"law": law(tmp_path, zip(*points, strict=True))}
    as_by_quadrature(
        {"puck": PUCK, "floor": floor, "launch": LAUNCH, "tol": tol}, pt.SpeedLaw(*points)
    )


def test_the_table_of_a_law_is_built_once_kept_and_listed(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    path = law(tmp_path, [(0.0, 0.2), (0.7, 0.1), (2.0, 0.15)])
    scene = tmp_path / "scene.toml"
    scene.write_text(
        f"[puck]\nradius = 0.04\npressure = 'ring'\n[floor]\nlaw = {path!r}\n"
        "[launch]\nvelocity = [1.0, 0.0]\n"
    )
    words = ["simulate", "--scene", str(scene), "--w0", "9", "--tol", "1e-5"]
    said = []
    for _ in range(2):
        _kept_table.cache_clear()
        done = invoke(*words)
        assert done.exit_code == 0, done.output
        said.append("tabulating the friction law" in done.stderr)
    assert said == [True, False]
    assert "slip-speed-cubic-1e-06" in invoke("tables").stdout
    (kept,) = (tmp_path / "cache" / "puck-tables" / "tables").iterdir()
    kept.write_bytes(kept.read_bytes()[:-100])
    _kept_table.cache_clear()
    done = invoke(*words)
    assert done.exit_code == 0
    assert "is damaged, or another table than its name says: it is built again" in done.stderr


TALL, ANNULUS = pt.Puck(0.04, height=0.02), pt.Puck(0.04, pressure="annulus:0.6")


@pytest.mark.parametrize("puck", [TALL, thorough(ANNULUS)])
def test_many_launches_look_up_the_law_that_a_few_sum(puck, monkeypatch):
    monkeypatch.setattr(map_of_floor, "MANY", 5000)
    floor, launch = pt.Floor(law=pt.StribeckLaw(0.3, 0.1, speed=0.2)), pt.Launch((0.8, 0.1))

    def swept(every):
        speeds, spins = np.linspace(0.0, 1.0, 50)[::every], np.linspace(-30.0, 30.0, 100)[::every]
        ranges = {"launch.velocity[0]": speeds, "launch.spin": spins}
        before = _kept_table.cache_info()
        found = pt.Scene(puck, floor, launch, tol=1e-7, ranges=ranges).sweep()
        return found, _kept_table.cache_info() != before

    (few, looked_up), (many, built) = swept(7), swept(1)
    assert (looked_up, built) == (False, True)
    for name, unit in (("x", 1.0), ("y", 1.0), ("end_time", 1.0), ("orientation", puck.radius)):
        missed = unit * np.abs(getattr(many, name)[::7, ::7] - getattr(few, name))
        assert 0.0 < missed.max() < 1e-8


@pytest.mark.thorough
def test_a_tolerance_that_the_corners_do_not_allow_is_refused_with_one_that_they_do(
    tmp_path, monkeypatch
):
    monkeypatch.setattr(speed_build, "MAX_NODES", 100_000)
    rows = [(0.0, 0.3), (0.3, 0.3), (0.301, 0.1), (2.0, 0.1)]
    floor = {"law": law(tmp_path, rows)}
    puck = {"radius": 0.04, "pressure": "annulus:0.5"}
    scene = {"puck": puck, "floor": floor, "launch": LAUNCH, "tol": 9e-10}
    with pytest.raises(
        pt.errors.AccuracyError, match=r"out of reach of a table of .*with its corners"
    ) as refused:
        simulate_scene(scene)
    tol = float(re.search(r"--tol\) of (\S+) or more", str(refused.value)).group(1))
    assert 1e-9 < tol < 1e-2
    assert simulate_scene({**scene, "tol": tol}).end == "at rest"


@pytest.mark.parametrize("pressure", ["uniform", thorough("hertz")])
def test_a_law_holds_up_to_the_speed_that_it_says(pressure: str):
    """It was refused there, "ends at 2 m/s"; a sweep said that the run may never stop."""
    floor = pt.Floor(law=[[0.0, 0.3], [1.0, 0.2], [2.0, 0.1]])
    scene = pt.Scene(pt.Puck(0.04, pressure=pressure), floor, pt.Launch((1.2, 1.6)))
    brakes = pt.SpeedLaw([0.0, 1.0, 2.0], [0.3, 0.2, 0.1])
    length = quad(lambda u: u / (9.80665 * float(brakes(u))), 0.0, 2.0, points=[1.0])[0]
    run = scene.simulate()
    assert abs(math.hypot(run.last["x"], run.last["y"]) - length) < 1e-6
    ends = pt.Scene(scene.puck, floor, pt.Launch([(1.2, 1.6), (1.2, 1.7)])).sweep()
    assert abs(ends.x[0] - run.last["x"]) < 1e-6
    assert "faster than a law goes" in ends.without_end()[0]

"""Scenes that once went wrong, found by people who tried to break them."""

import math

import numpy as np
import pytest
from commands import invoke
from rarely import thorough
from scenes import simulate_scene, sweep_scene

import puck_tables as pt
from puck_tables.errors import InputError


@pytest.mark.parametrize("degrees", [5, 10, 30])
def test_a_wedge_of_two_walls_holds_what_is_pressed_into_it(degrees):
    half, r = math.radians(degrees), 0.1  # the puck touches both walls
    walls = [
        {
            "point": [r * math.sin(half), -s * r * math.cos(half)],
            "normal": [-math.sin(half), s * math.cos(half)],
        }
        for s in (1, -1)
    ]
    scene = {"puck": {"radius": r}, "floor": {"slope": 0.1}, "wall": walls, "time": 1.0}
    run = simulate_scene(scene)
    assert (abs(run.last["x"]), abs(run.last["vx"])) <= (1e-12, 1e-12)
    assert run.energy_residual < 1e-8


@pytest.mark.parametrize("gyration", [0.1, 3.0, 10.0])
def test_tol_is_kept_however_the_mass_is_spread(gyration):
    scene = {
        "puck": {"radius": 0.04, "gyration": gyration, "friction": 0.1}, "floor": {"slope": 0.02},
        "launch": {"velocity": [1.0, 0.0], "spin": 50.0}, "frames": 1, "tol": 1e-12,
    }  # fmt: skip
    unit = math.hypot(1.0, 2.0) / (0.1 * 9.80665)
    exact = simulate_scene(scene).end_time
    for tol in (1e-6, 1e-9):
        scene["tol"] = tol
        assert abs(simulate_scene(scene).end_time - exact) <= tol * unit


def test_scenes_that_never_end_are_refused_also_with_a_frame_and_in_a_sweep():
    scene = {
        "puck": {"radius": 0.04, "friction": 0.1}, "floor": {"turning": 3.0},
        "launch": {"velocity": [0.1, 0.0], "position": [0.2, 0.0]},
    }  # fmt: skip
    for times in (None, [0.0]):
        with pytest.raises(InputError, match="may never stop"):
            simulate_scene(scene, times)
    with pytest.raises(InputError, match="may never stop"):
        sweep_scene({**scene, "launch": {**scene["launch"], "spin": "0:1:2"}})
    with pytest.raises(InputError, match="nothing brings the puck to rest"):
        simulate_scene({"puck": {"radius": 0.04}})


def test_runs_of_a_sweep_that_fail_are_not_a_number(tmp_path):
    (tmp_path / "law.csv").write_text("0,0.2\n3,0.2\n")
    scene = {
        "puck": {"radius": 0.04}, "floor": {"law": str(tmp_path / "law.csv")},
        "launch": {"velocity": [0.5, 0.0], "spin": "0:500:3"},
    }  # fmt: skip
    stops = sweep_scene(scene)
    assert stops.end[0] == 0 and not np.isnan(stops.columns["x"][0])
    assert np.isnan(stops.columns["x"][1:]).all()
    assert np.isnan(stops.columns["energy_residual"][1:]).all()


@pytest.mark.thorough
def test_a_law_that_jumps_is_tabulated_in_bounded_time(tmp_path):
    (tmp_path / "law.csv").write_text("0,0.1\n0.24,0.12\n0.25,0\n0.3,0\n0.31,0.2\n0.6,0.2\n")
    run = simulate_scene({
        "puck": {"radius": 0.04}, "floor": {"law": str(tmp_path / "law.csv")},
        "launch": {"velocity": [0.4, 0.0], "spin": 3.0}, "time": 1.5, "tol": 1e-6,
    })  # fmt: skip
    assert run.energy_residual < 1e-6


def test_names_files_and_clashes(tmp_path):
    file = tmp_path / "mine.toml"
    file.write_bytes(b"\xef\xbb\xbf[puck]\nradius = 0.04\nfriction = 0.1\n")  # a BOM
    assert simulate_scene(file).end == "at rest"
    twice = ["--set", "launch.spin=1", "--set", "launch.spin=2"]
    for words in (["--w0", "1", "--set", "launch.spin=2"], twice):
        result = invoke("simulate", "--scene", "incline", *words)
        assert result.exit_code == 2 and "clash" in result.stderr


@pytest.mark.parametrize("tol", [1e-6, 1e-10])
def test_a_base_beside_a_puck_of_another_pressure_has_no_table_to_agree_with(tol):
    """Both slide straight, v²/(2 f g); it ended in a traceback of numpy."""
    speed, f = 0.5, 0.2
    pucks = [
        pt.Puck(0.06, base="box:0.1x0.06", friction=f, launch=pt.Launch((speed, 0.0))),
        pt.Puck(0.04, pressure="annulus:0.7", friction=f,
                launch=pt.Launch((speed, 0.0), position=(0.0, 1.0))),
    ]  # fmt: skip
    run = pt.Scene(pucks=pucks, tol=tol).simulate()
    assert np.abs(run.last["x"] - speed**2 / (2.0 * f * 9.80665)).max() <= 1e-9


def test_a_force_that_grows_over_rows_moves_what_rests_whenever_it_came_to_rest():
    """Two of ten had no end: the slip came in a step that rounding left nothing of."""
    f, rows = 0.2, [[0.3, 0.0, 0.0], [0.6, 4.0, 0.0]]
    slips = 0.3 + 0.3 * f * 9.80665 / 4.0
    for k in range(10):
        scene = pt.Scene(pt.Puck(1.0, friction=f), force=pt.Force(over_time=rows), time=0.6)
        world = scene.world()
        world.advance(0.13 + 1e-4 * k)
        world.strike(0, velocity=(0.0, 0.0))  # a new path
        world.advance(0.6 - world.time)
        assert abs(world.state()[0, 0] - (4.0 / 0.3) * (0.6 - slips) ** 3 / 6.0) <= 1e-9


@pytest.mark.parametrize("aside", [0.0, 0.1])
def test_what_is_pushed_on_a_rough_floor_tips_where_no_pressure_balances(aside):
    """By hand: its load lies at the front, of which s is on the rough strip; askew it was refused.

    p falls to 0 over a width w from the front, or is (1 + b x)/L; friction times the height of the
    centre is then the load's place, until s is 6.5396 mm, where no w or b is left.
    """
    length, low, high, z = 0.1, 0.1, 0.6, 0.15
    wide, full = np.linspace(1e-6, length, 200_001), np.linspace(0.0, 2.0 / length, 200_001)

    def is_carried(s):
        share = np.where(wide > s, 1.0 - (1.0 - np.minimum(s / wide, 1.0)) ** 2, 1.0)
        lifted = 0.5 * length - wide / 3.0 - z * (low + (high - low) * share)
        share = s / length + full * s * (0.5 - 0.5 * s / length)
        pressed = full * length**2 / 12.0 - z * (low + (high - low) * share)
        return max(lifted.max(), pressed.max()) >= 0.0

    least, most = 0.0, 0.05
    for _ in range(40):
        s = 0.5 * (least + most)
        least, most = (s, most) if is_carried(s) else (least, s)
    tall = pt.Puck(0.08, base="box:0.1x0.1", height=2.0 * z, restitution=0.0, name="tall",
                   launch=pt.Launch((1.0, 0.0), position=(0.17, 0.0)))  # fmt: skip
    flat = pt.Puck(0.08, restitution=0.0, force=pt.Force((2.0, 0.0)), name="flat",
                   launch=pt.Launch((1.2, aside)))  # fmt: skip
    floor = pt.Floor(strips=pt.Strips(borders=(0.5,), friction=(low, high)))
    run = pt.Scene(pucks=[tall, flat], floor=floor, time=0.8).simulate()
    assert [one.puck for one in run.events if one.what == "tip"] == ["tall"]
    assert abs(run["tall"]["x"][-1] - (0.5 - 0.5 * length + least)) <= (1e-7, 1e-5)[aside > 0.0]
    assert run.energy_residual < 1e-8


@pytest.mark.parametrize("friction", [thorough(0.297), 0.31])
def test_what_is_carried_to_the_end_of_its_slip_rests_there(friction):
    """A third of its rim carries it to the end, where a step beyond the stop told of a tip."""
    tall = pt.Puck(0.04, height=0.3, pressure="annulus:0.8")
    floor = pt.Floor(law=[[0.0, friction], [3.0, friction]])
    for launch in (pt.Launch((0.0752, 0.0), spin=2.0), pt.Launch((0.05, 0.0), spin=20.0)):
        run = pt.Scene(tall, floor, launch).simulate()
        assert (run.end, [event.what for event in run.events]) == ("at rest", ["stick"])
        assert run.energy_residual < 1e-9
    assert pt.Scene(tall, floor, pt.Launch((0.8, 0.1), spin=20.0)).simulate().end == "tipped over"

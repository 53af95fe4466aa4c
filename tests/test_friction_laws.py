"""Friction laws by name: their formulas, tables, scenes and sweeps, and what is refused."""

import math

import numpy as np
import pytest
from scipy.integrate import quad
from test_scene_law import as_by_quadrature

import puck_tables as pt
from puck_tables.contact.friction_laws import NAMED
from puck_tables.motion.body import STANDARD_GRAVITY
from puck_tables.table.speed_table import SpeedTable

PUCK = {"radius": 0.04, "height": 0.02, "mass": 0.2}
# of every law one or two, and the same law written down again
STRIBECK = {"kind": "stribeck", "static": 0.3, "kinetic": 0.1, "speed": 0.2}
LAWS = {
    "gauss": (
        {**STRIBECK, "exponent": 2.0, "viscous": 0.02},
        lambda u: 0.1 + 0.2 * np.exp(-((u / 0.2) ** 2)) + 0.02 * u,
    ),
    "root": ({**STRIBECK, "exponent": 0.5}, lambda u: 0.1 + 0.2 * np.exp(-np.sqrt(u / 0.2))),
    "curling": (
        {"kind": "curling", "a": 0.002, "b": 0.064, "c": 0.0063},
        lambda u: 0.002 / (u + 0.064) + 0.0063,
    ),
    "power": (
        {"kind": "power", "a": 0.05, "exponent": -0.5, "b": 0.05},
        lambda u: 0.05 / np.sqrt(u + 0.05),
    ),
}  # fmt: skip


def scene(law, **more):
    launch = {"velocity": [0.8, 0.1], "spin": 12.0}
    return {"puck": PUCK, "floor": {"law": law}, "launch": launch, **more}


@pytest.mark.thorough
@pytest.mark.parametrize("name", LAWS)
def test_a_sliding_puck_takes_the_time_and_the_way_of_the_integral_over_the_speed(name):
    law, f = LAWS[name]
    tol = 1e-9 if name == "gauss" else 1e-7
    tables = scene(law, launch={"velocity": [0.9, 0.0]}, tol=tol)
    run = pt.Scene.from_tables(tables).simulate()
    bends = [0.001, 0.01, 0.1, 0.3]
    brake = lambda v: STANDARD_GRAVITY * f(v)  # noqa: E731
    time = quad(lambda v: 1.0 / brake(v), 0.0, 0.9, points=bends, epsabs=1e-13, limit=400)[0]
    way = quad(lambda v: v / brake(v), 0.0, 0.9, points=bends, epsabs=1e-13, limit=400)[0]
    assert run.end == "at rest"
    unit = run.speed_scale / run.rate_scale
    assert run.end_time == pytest.approx(time, abs=tol * unit)
    assert run.last["x"] == pytest.approx(way, abs=tol * unit * run.speed_scale)
    assert run.error_estimate <= tol
    assert run.energy_residual < tol


@pytest.mark.thorough
@pytest.mark.parametrize(("name", "tol"), [("gauss", 1e-9), ("root", 1e-6)])
def test_sliding_and_spinning_by_a_law_is_the_motion_by_quadrature(name, tol):
    law, f = LAWS[name]
    as_by_quadrature(scene(law, tol=tol), f)


@pytest.mark.thorough
@pytest.mark.parametrize("name", LAWS)
def test_a_table_of_a_law_is_as_good_as_it_says_and_survives_a_file(name, tmp_path):
    law, f = LAWS[name]
    law = NAMED[law["kind"]](**law)
    table = pt.Table.build(law, 1e-6, top_speed=2.0)
    assert table.validate(points=60).passed
    u = np.linspace(0.0, 2.0, 7)
    assert law(u) == pytest.approx(f(u), rel=1e-14)
    table.save(tmp_path / "law.h5")
    again = SpeedTable.load(tmp_path / "law.h5")
    assert again.law == law.checked()
    phi, Q = np.array([0.0, 0.3, 1.0, 1.5]), np.array([1e-9, 0.01, 0.3, 1.3])
    assert np.array_equal(again.integrals(phi, Q).d, table.integrals(phi, Q).d)


@pytest.mark.thorough
def test_a_slip_that_grows_beyond_the_first_table_is_followed():
    """Down a slope, f = a u: v′ = g sin β − a g cos β v, far above the launch."""
    law, slope, a = pt.PowerLaw(0.001, 1.0), 0.5, 0.001
    tables = scene(law, launch={"velocity": [0.01, 0.0]}, time=3.0, tol=1e-7)
    tables["floor"]["slope"] = slope
    rate = a * STANDARD_GRAVITY * math.cos(slope)
    most = math.tan(slope) / a
    speed = most + (0.01 - most) * math.exp(-rate * 3.0)
    assert speed > 8.0
    assert pt.Scene.from_tables(tables).simulate().last["vx"] == pytest.approx(speed, rel=1e-7)
    tables["launch"]["spin"] = [0.0, 1.0]
    swept = pt.Scene.from_tables(tables).sweep()
    assert swept.vx[0] == pytest.approx(speed, rel=1e-6)


def test_numbers_of_a_law_are_ranges():
    tables = scene({**STRIBECK, "static": "0.2:0.3:2"}, tol=1e-5)
    swept = pt.Scene.from_tables(tables).sweep()
    assert list(swept.axes) == ["floor.law.static"]
    for static, time in zip((0.2, 0.3), swept.end_time, strict=True):
        one = pt.Scene.from_tables(scene({**STRIBECK, "static": static}, tol=1e-5))
        assert one.simulate().end_time == pytest.approx(time, abs=1e-4)
    assert swept.to_xarray().floor_law_static.values.tolist() == [0.2, 0.3]


@pytest.mark.parametrize(
    ("law", "words"),
    [
        ("stribeck", "a law by name is a table, floor.law.kind = 'stribeck'"),
        ({"kind": "stribek", "static": 0.1}, r"one of curling, power, stribeck .did you mean 'str"),
        ({"static": 0.1}, "floor.law.kind = None: must be one of"),
        ({**STRIBECK, "statik": 0.1}, "floor.law.statik: no such entry"),
        ({**STRIBECK, "static": -0.1}, "floor.law.static = -0.1: must be a number >= 0"),
        ({**STRIBECK, "exponent": 0.1}, "floor.law.exponent = 0.1: must be"),
        ({"kind": "curling", "a": 0.1, "b": 0.0}, "floor.law.b = 0.0: must be a number > 0 m/s"),
        ({"kind": "power", "a": 0.1, "exponent": -0.5}, "f has no bound at slip zero; give b > 0"),
        ({"kind": "power", "a": 0.1, "exponent": 0.5}, "f has a root at slip zero; give b > 0"),
    ],
)
def test_laws_that_cannot_be_are_refused_by_name(law, words):
    with pytest.raises(pt.InputError, match=words):
        pt.Scene.from_tables(scene(law))


def test_a_law_in_python_is_checked_where_it_is_used():
    with pytest.raises(pt.InputError, match="friction law curling: b = -1"):
        pt.CurlingLaw(0.1, -1.0)(0.5)
    with pytest.raises(pt.InputError, match=r"friction law power: exponent = -0\.5 with b = 0"):
        pt.Table.build(pt.PowerLaw(0.1, -0.5), top_speed=1.0)
    with pytest.raises(pt.InputError, match="needs top_speed"):
        pt.Table.build(pt.CurlingLaw(0.1, 1.0))


def test_a_law_of_points_may_be_that_of_a_floor_and_one_of_lines_says_what_to_write():
    rng = np.random.default_rng(31)
    speeds = np.append(0.0, np.cumsum(rng.uniform(0.5, 2.0, 6)))
    law = pt.SpeedLaw(speeds, rng.uniform(0.1, 0.3, 7))
    by_law, by_rows = (
        pt.Scene(pt.Puck(0.04), pt.Floor(law=one), launch=pt.Launch((0.5, 0.0)))
        for one in (law, [*zip(law.speeds, law.values, strict=True)])
    )
    assert by_law == by_rows
    with pytest.raises(pt.InputError, match=r"floor.law: a linear SpeedLaw .* law\(u\)\)"):
        pt.Scene(pt.Puck(0.04), pt.Floor(law=pt.SpeedLaw(speeds, law.values, "linear")))

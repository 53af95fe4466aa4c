"""Restitution that falls with speed, and pairs of rims with a law of their own."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
from boards import draw, puck_at
from scipy.integrate import solve_ivp

import puck_tables as pt
from puck_tables.scene.library import as_toml

ROWS = "speed,e\n0,0.9\n0.5,0.8\n1,0.6\n4,0.5\n"


def bounced(*pucks: pt.Puck, **board: object) -> tuple[float, float]:
    """Approach at the first impact of the first puck, and its restitution from the states then."""
    world = pt.Scene(pucks=pucks, **board).world()  # type: ignore[arg-type]
    event = world.copy().advance(2.0)[0]
    world.advance(event.time)
    vx = world.state()[:, 3]
    return event.approach, float((vx[1] - vx[0] if len(vx) > 1 else -vx[0]) / event.approach)


def meets(law: object, speed: float, other: object = 1.0, **board: object) -> tuple[float, float]:
    """The same of two that meet head-on, next to each other and fast."""
    one = puck_at(0.0, 0.0, (speed, 0.0), friction=1e-6, restitution=law, name="one", colour="red")
    two = puck_at(0.060001, 0.0, friction=1e-6, restitution=other, name="two", colour="blue")
    return bounced(one, two, **board)


def sphere(loss: float, speed: float) -> float:
    """Restitution of viscoelastic spheres, by the motion x″ + x^1.5 + 1.5 a √x x′ = 0.

    Until the force is 0 again; a in units in which x′ = 1 at first is C v^(1/5)/(1.5·1.15345).
    """
    a = loss * speed**0.2 / 1.15345 / 1.5

    def force(x: float, v: float) -> float:
        x = max(x, 0.0)
        return x**1.5 + 1.5 * a * math.sqrt(x) * v

    def ends(t: float, y: np.ndarray) -> float:
        return force(y[0], y[1]) if t > 1e-3 else 1.0

    ends.terminal = True  # type: ignore[attr-defined]
    found = solve_ivp(
        lambda _, y: [y[1], -force(y[0], y[1])], (0.0, 50.0), [0.0, 1.0], "DOP853",
        rtol=1e-11, atol=1e-13, events=ends,
    )  # fmt: skip
    return float(-found.y[1, -1])


@pytest.mark.parametrize("loss", [1e-3, 0.03, 0.3, 1.5, 5.0])
def test_viscoelastic_rims_are_those_of_the_equation_of_motion(loss: float):
    for speed in (1e-4, 0.3, 20.0):
        assert abs(pt.Viscoelastic(loss)(speed) - sphere(loss, speed)) < 9e-3
    small = loss * 1e-15**0.2
    series = 1.0 - small + 0.6 * small**2
    assert abs(pt.Viscoelastic(loss)(1e-15) - series) < 0.3 * small**2.5 + 3e-6 * small


@pytest.mark.parametrize("speed", [0.02, 0.0500001, 0.07, 0.3, 5.0])
def test_plastic_rims_are_those_of_work_and_energy(speed: float):
    """Hertz up to the yield point, then a straight line; back by Hertz with a wider radius."""
    v, m, k = 0.05, 1.0, 1.0
    deep = (0.5 * m * v * v * 2.5 / k) ** 0.4
    if speed <= v:
        assert pt.Plastic(v)(speed) == 1.0
        return
    first, slope = k * deep**1.5, 1.5 * k * math.sqrt(deep)
    left = 0.5 * m * (speed**2 - v**2)
    more = (-first + math.sqrt(first**2 + 2.0 * slope * left)) / slope
    most = first + slope * more
    wider = k * (deep + more) ** 1.5 / most
    back = (most / (k * math.sqrt(wider))) ** (2.0 / 3.0)
    assert pt.Plastic(v)(speed) == pytest.approx(
        math.sqrt(0.8 * most * back / m) / speed, rel=1e-12
    )


def test_two_meet_by_the_law_at_their_speed(tmp_path: Path):
    table = tmp_path / "rubber.csv"
    table.write_text(ROWS)
    for law, speed in ((pt.Plastic(0.1), 0.7), ("viscoelastic:0.25", 2.0), (str(table), 0.75)):
        approach, e = meets(law, speed)
        expected = {
            0.7: (1.2 * math.sqrt(3) * (1 - (0.1 / approach) ** 2 / 6)) ** 0.5
            * (0.1 / (0.1 + 2 * approach * math.sqrt(1.2 - 0.2 * (0.1 / approach) ** 2))) ** 0.25,
            2.0: sphere(0.25, approach),
        }.get(speed, 0.7)
        assert e == pytest.approx(expected, abs={0.7: 1e-9, 2.0: 1e-3}.get(speed, 0.03))
    for speed, value in ((0.5, 0.8), (1.0, 0.6), (4.0 - 1e-9, 0.5)):
        assert meets(str(table), speed)[1] == pytest.approx(value, abs=1e-5)


def test_of_two_laws_the_smaller_counts_at_that_speed():
    for speed in (0.2, 2.0):
        e = min(float(pt.Plastic(0.1)(speed)), float(pt.Viscoelastic(0.3)(speed)))
        assert meets(pt.Plastic(0.1), speed, pt.Viscoelastic(0.3))[1] == pytest.approx(e, abs=1e-5)
        assert meets(0.45, speed, pt.Plastic(0.1))[1] == pytest.approx(
            min(0.45, float(pt.Plastic(0.1)(speed))), abs=1e-5
        )


def test_a_cushion_may_have_a_law_also_for_a_single_puck():
    wall = {"point": (0.031, 0.0), "normal": (-1.0, 0.0)}
    one = puck_at(0.0, 0.0, (1.0, 0.0), friction=1e-6)
    for board in (
        {"walls": [pt.Wall(**wall, restitution="plastic:0.1")]},
        {"posts": [pt.Post((0.131, 0.0), 0.1, restitution="plastic:0.1")]},
        {"arcs": [pt.Arc((-0.1, 0.0), 0.131, restitution=pt.Plastic(0.1))]},
    ):
        approach, e = bounced(one, **board)
        assert e == pytest.approx(float(pt.Plastic(0.1)(approach)), abs=1e-9)
    puck, walls = pt.Puck(0.03, 0.01, 0.2, 0.1), [pt.Wall(**wall, restitution="plastic:0.1")]
    scene = pt.Scene(puck, launch=pt.Launch((1.0, 0.1), 5.0), walls=walls)
    run = scene.simulate()
    assert run.events[0].partner == "wall 0"
    assert run.energy_residual < 1e-12


def test_faster_than_the_table_is_refused_in_a_sentence(tmp_path: Path):
    table = tmp_path / "rubber.csv"
    table.write_text(ROWS)
    with pytest.raises(pt.PuckError, match=r"two meet at 5\.\d* m/s, faster than their table"):
        meets(str(table), 5.001)
    one = puck_at(0, 0, (1.0, 0.0), restitution=str(table))
    scene = pt.Scene(pucks=[one, puck_at(0.1, 0)], ranges={"puck[0].launch.velocity[0]": [1, 3, 9]})
    ends = scene.sweep()
    assert [ends.meanings[end] for end in ends.end.tolist()] == [
        "at rest", "at rest", "faster than a law goes",
    ]  # fmt: skip
    assert "run it alone" in ends.without_end()[0]


@pytest.mark.parametrize(("given", "says"), [
    ("viscoelastik:0.1", r"restitution: .*did you mean 'viscoelastic'\?"),
    ("plastic", "needs a number"), ("plastic:-1", "greater than 0 m/s"),
    ("plastic:nan", "finite"), ("0.5:x:3", "<= 1"), (1.5, "<= 1"), ("", "no law"),
    ("nowhere.csv", r"cannot read .*nowhere\.csv"), ([0.5, "plastic:1"], "must be a number"),
])  # fmt: skip
def test_a_law_that_does_not_exist_is_told(given: object, says: str):
    with pytest.raises(pt.InputError, match=says):
        pt.Scene(pucks=[puck_at(0, 0, restitution=given)])


@pytest.mark.parametrize(("text", "says"), [
    ("-0.1,0.5\n1,0.4\n", "ascend, from 0"), ("0,0.5\n1,1.4\n", "from 0 to 1, got 1.4"),
    ("0,0.5\n", "two or more"), ("0,0.5,1\n1,1,1\n", "must hold the columns v"),
    ("0,0.5\n2,0.3\n1,0.4\n", "line 3: 1 after 2"), ("0,x\n1,2\n", "column 2: 'x' is no number"),
    ("0,nan\n1,0.5\n", "line 1: it has no restitution"), ("", "is empty"),
])  # fmt: skip
def test_a_bad_table_is_told(tmp_path: Path, text: str, says: str):
    (tmp_path / "e.csv").write_text(text)
    with pytest.raises(pt.InputError, match=says) as told:
        pt.Scene(pucks=[puck_at(0, 0, restitution=str(tmp_path / "e.csv"))])
    assert "e.csv" in str(told.value)


@pytest.mark.parametrize("pair", [
    ("one", "two"), ("two", "one"), ("red", "blue"), ("one", "blue"), ("blue", "one"),
])  # fmt: skip
def test_a_pair_has_a_law_of_its_own(pair: tuple[str, str]):
    assert meets(0.9, 1.0, rims=[pt.Rim(*pair, restitution=0.3)])[1] == pytest.approx(0.3, abs=1e-9)


def test_of_several_rims_the_last_counts_and_others_are_not_meant():
    general, own = pt.Rim("red", "blue", restitution=0.3), pt.Rim("one", "two", restitution=0.5)
    assert meets(0.9, 1.0, rims=[general, own])[1] == pytest.approx(0.5, abs=1e-9)
    assert meets(0.9, 1.0, rims=[own, general])[1] == pytest.approx(0.3, abs=1e-9)
    same = pt.Rim("red", "red", restitution=0.1)
    assert meets(0.9, 1.0, rims=[own, same])[1] == pytest.approx(0.5, abs=1e-9)
    left_out = pt.Rim("one", "two", tangential=0.0)
    assert meets(0.9, 1.0, rims=[left_out])[1] == pytest.approx(0.9, abs=1e-9)
    law = pt.Rim("one", "two", restitution="plastic:0.1")
    approach, e = meets(0.3, 1.0, rims=[law])
    assert e == pytest.approx(float(pt.Plastic(0.1)(approach)), abs=1e-9)


def test_a_pair_has_its_own_friction_along_the_rims():
    one = puck_at(0, 0, (1.0, 0.0), 50.0, friction=1e-6, name="one")
    two = puck_at(0.060001, 0, friction=1e-6, name="two")
    rim = pt.Rim("one", "two", tangential=0.0, friction=0.05)
    event = pt.Scene(pucks=[one, two], rims=[rim]).world().advance(0.5)[0]
    assert event.rub == pytest.approx(0.05 * event.impulse, rel=1e-12)
    assert pt.Scene(pucks=[one, two]).world().advance(0.5)[0].rub == 0.0


@pytest.mark.parametrize("cushion", ["wall 1", "wall"])
def test_a_puck_may_meet_a_cushion_by_a_law_of_its_own(cushion: str):
    walls = [
        pt.Wall((-9.0, 0.0), normal=(1.0, 0.0)),
        pt.Wall((0.031, 0.0), normal=(-1.0, 0.0), restitution=0.8),
    ]
    one = puck_at(0.0, 0.0, (1.0, 0.0), friction=1e-6, name="one")
    rims = [pt.Rim("one", cushion, restitution=0.2)]
    assert bounced(one, walls=walls, rims=rims)[1] == pytest.approx(0.2, abs=1e-9)
    other = [pt.Rim("one", "wall 0", restitution=0.2)]
    assert bounced(one, walls=walls, rims=other)[1] == pytest.approx(0.8, abs=1e-9)


@pytest.mark.parametrize(("rim", "says"), [
    (("onne", "two"), r"rim\[0\]\.puck = 'onne': .*did you mean 'one'\?"),
    (("one", "wall 3"), "or a cushion"), (("wall 0", "one"), "name of a puck"),
    (("one", ""), "must be"),
])  # fmt: skip
def test_a_rim_of_nobody_is_told(rim: tuple[str, str], says: str):
    with pytest.raises(pt.InputError, match=says):
        meets(0.5, 1.0, rims=[pt.Rim(*rim)], walls=[pt.Wall((9, 0), normal=(-1, 0))])


def test_laws_and_pairs_stand_in_files(tmp_path: Path):
    (tmp_path / "e.csv").write_text(ROWS)
    (tmp_path / "board.toml").write_text("""
[[puck]]
radius = 0.03
friction = 0.1
name = "one"
restitution = "e.csv"
launch = {velocity = [1.0, 0.0]}
[[puck]]
radius = 0.03
friction = 0.1
name = "two"
launch = {position = [0.1, 0.0]}
[[wall]]
point = [0.3, 0.0]
normal = [-1.0, 0.0]
restitution = "viscoelastic:0.2"
[[rim]]
puck = "two"
partner = "wall 0"
friction = 0.3
tangential = 0.1
""")
    scene = pt.Scene.load(tmp_path / "board.toml")
    run = scene.simulate()
    (tmp_path / "again.toml").write_text(as_toml(scene))
    again = pt.Scene.load(tmp_path / "again.toml")
    assert again.simulate().events == run.events
    assert "e.csv" in run.explain()
    assert "rim[0]: two and wall 0 meet by tangential 0.1, friction 0.3" in run.explain()
    assert "viscoelastic" in json.dumps(run.summary())
    by_object = pt.Scene(pucks=scene.pucks, rims=scene.rims, walls=[
        pt.Wall((0.3, 0.0), normal=(-1.0, 0.0), restitution=pt.Viscoelastic(0.2))
    ])  # fmt: skip
    assert by_object.simulate().events == run.events
    assert 'restitution = "viscoelastic:0.2"' in as_toml(by_object)
    run.save(tmp_path / "run.h5")


@pytest.mark.parametrize("seed", [3, 5])
def test_boards_with_laws_lose_no_energy_and_know_no_numbering(seed: int):
    plain = draw(seed, 8)
    laws = ["plastic:0.05", "viscoelastic:0.3", 0.7, pt.RestitutionTable([0, 1, 50], [1, 0.8, 0.4])]
    pucks = [
        pt.Puck(**{**{n: getattr(p, n) for n in p.__dataclass_fields__},
                    "restitution": laws[k % 4], "name": f"p{k}"})
        for k, p in enumerate(plain.pucks)
    ]  # fmt: skip
    rims = [pt.Rim("p0", "p3", restitution=0.4), pt.Rim("p1", "wall", tangential=0.3)]
    one = pt.Scene(pucks=pucks, walls=plain.walls, rims=rims).simulate()
    turn = np.random.default_rng(seed).permutation(8)
    two = pt.Scene(pucks=[pucks[n] for n in turn], walls=plain.walls, rims=rims).simulate()
    assert np.array_equal(one.x[:, turn], two.x)
    assert one.energy_residual < 1e-9
    assert all(event.lost >= 0.0 for event in one.events)

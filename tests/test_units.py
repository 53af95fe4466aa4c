"""Numbers with a unit behind them, and lists: in fields, files, --set and options, drawn."""

from __future__ import annotations

import json
import math
import os
from pathlib import Path
from typing import Any

import click
import numpy as np
import pytest
from commands import invoke
from puck_tables.cli.values import NumberParam, RangeParam, Times, Vector

import puck_tables as pt
from puck_tables._core.quantities import FRICTION, unit_of
from puck_tables.bulk.spreads import spread_named
from puck_tables.contact.laws import law_of
from puck_tables.errors import InputError
from puck_tables.film.headings import headings

UNITS: dict[str, dict[str, float]] = {
    "m": {"m": 1.0, "cm": 0.01, "mm": 0.001, "in": 0.0254, "um": 1e-6, "ft": 0.3048},
    "m/s": {"m/s": 1.0, "cm/s": 0.01, "km/h": 1 / 3.6, "mm/s": 1e-3},
    "rad/s": {"rad/s": 1.0, "deg/s": math.pi / 180, "rpm": math.pi / 30},
    "rad": {"rad": 1.0, "deg": math.pi / 180, "turn": 2 * math.pi},
    "s": {"s": 1.0, "ms": 1e-3, "min": 60.0}, "kg": {"kg": 1.0, "g": 1e-3},
}  # fmt: skip


def drawn(rng: np.random.Generator, unit: str, low: float = 0.5, high: float = 2.0) -> Any:
    """A number as somebody may write it, and what it is in SI units."""
    name, size = list(UNITS[unit].items())[rng.integers(len(UNITS[unit]))]
    number = f"{float(rng.uniform(low, high)) / size:.9g}"
    return f"{number}{['', ' '][rng.integers(2)]}{name}", float(number) * size


def test_fields_and_files_take_units(tmp_path: Path):
    rng = np.random.default_rng(51)
    for _ in range(30):
        written = {name: drawn(rng, unit) for name, unit in (
            ("radius", "m"), ("height", "m"), ("mass", "kg"), ("vx", "m/s"), ("vy", "m/s"),
            ("spin", "rad/s"), ("x", "m"), ("downhill", "rad"), ("time", "s"),
        )}  # fmt: skip
        text, value = ({name: one[n] for name, one in written.items()} for n in (0, 1))
        (tmp_path / "a.toml").write_text(
            f"time = '{text['time']}'\n[puck]\n"
            f"radius = '{text['radius']}'\nheight = '{text['height']}'\n"
            f"mass = '{text['mass']}'\nfriction = 0.05\n"
            f"[launch]\nvelocity = ['{text['vx']}', '{text['vy']}']\nspin = '{text['spin']}'\n"
            f"position = ['{text['x']}', 0.0]\n[floor]\ndownhill = '{text['downhill']}'\n"
        )
        scene = pt.Scene.load(tmp_path / "a.toml")
        puck = pt.Puck(text["radius"], text["height"], 0.05, text["mass"])
        assert puck == scene.puck
        found = (
            puck.radius, puck.height, puck.mass, *scene.launch.velocity, scene.launch.spin,
            scene.launch.position[0], scene.floor.downhill, scene.time,
        )  # fmt: skip
        assert found == pytest.approx(list(value.values()), rel=1e-12)
    ranged = pt.Scene(pt.Puck("4cm", 0.0, 0.1), launch=pt.Launch((1.0, 0.0), "10rpm:20rpm:3"))
    assert ranged.ranges["launch.spin"] == pytest.approx(np.array([10, 15, 20]) * math.pi / 30)
    assert pt.Puck("25.4mm").radius == 0.0254 == pt.Puck("1in").radius  # to the last bit


@pytest.mark.parametrize("text", ["3.81 foo", "3 kg", "cm", "3 px", "1,5cm", "3cm2", "nan cm"])
def test_what_is_no_length_gets_a_sentence(text: str):
    with pytest.raises(
        InputError, match=r"radius = '.*': must be a number > 0 m, or with its unit"
    ):
        pt.Puck(text)
    ended = invoke("simulate", "--v0", "1,0", "--radius", text)
    assert ended.exit_code == 2 and "is not a number, or one with a unit as 25mm" in ended.stderr


def test_options_take_units_and_lists():
    rng = np.random.default_rng(52)
    for unit in UNITS:
        for _ in range(10):
            (a, first), (b, second) = drawn(rng, unit), drawn(rng, unit, 3.0, 4.0)
            assert NumberParam(unit).convert(a, None, None) == pytest.approx(first, rel=1e-12)
            assert Vector(unit).convert(f"{a},{b}", None, None) == pytest.approx((first, second))
            assert RangeParam(unit).convert(f"{b},{a},{b}", None, None) == pytest.approx(
                [second, first, second]
            )
            assert RangeParam(unit).convert(f"{a}:{b}:3", None, None) == pytest.approx(
                (first, second, 3)
            )
            assert Times(unit).convert(f"{a},{b}", None, None) == pytest.approx((first, second))


def test_spreads_take_units():
    rng = np.random.default_rng(55)
    for unit in UNITS:
        (a, first), (b, second) = drawn(rng, unit), drawn(rng, unit, 3.0, 4.0)
        found = spread_named(f"uniform:{a}:{b}", unit)
        assert (found.low, found.high) == pytest.approx((first, second), rel=1e-12)
        assert spread_named(f"normal:{b}:{a}", unit).deviation == pytest.approx(first, rel=1e-12)
        with pytest.raises(InputError, match=r"is no spread: .* with a unit as"):
            spread_named(f"normal:{a}:3 foo", unit)
    text, value = drawn(rng, "rad/s", 3.0, 4.0)
    how = ["sweep", "--random", "3", "--seed", "3", "--spread"]
    for scene, name in (([], "w0"), (["--scene", "incline"], "launch.spin")):
        means = []
        for spread in (f"normal:{text}:0.1rad/s", f"normal:{value!r}:0.1"):
            ended = invoke(*how, f"{name}={spread}", *scene)
            assert ended.exit_code == 0, ended.output
            means.append(ended.stdout)
        assert means[0] == means[1]


@pytest.mark.thorough
def test_commands_with_units_and_lists_answer_as_the_library_does():
    rng = np.random.default_rng(53)
    (r, radius), (h, height) = drawn(rng, "m", 0.03, 0.05), drawn(rng, "m", 0.01, 0.02)
    (v, speed), (w, spin) = drawn(rng, "m/s"), drawn(rng, "rad/s", 5.0, 9.0)
    real = ["--radius", r, "--height", h, "--friction", "0.1"]
    shot = invoke("simulate", "--v0", f"{v},0", "--w0", w, *real, "--json")
    expected = pt.Puck(radius, height, 0.1).stop((speed, 0.0), spin)
    assert json.loads(shot.stdout)["stop_time"] == pytest.approx(
        expected.stop_time.item(), rel=1e-8
    )
    listed = f"0,{w},2rad/s"
    ended = invoke("sweep", "--v0", f"{v},0", "--w0", listed, *real)
    rows = [line.split(",") for line in ended.stdout.splitlines()]
    at = rows[0].index("stop_time[s]")
    times = pt.Puck(radius, height, 0.1).stop((speed, 0.0), [0.0, spin, 2.0]).stop_time
    assert [float(row[at]) for row in rows[1:]] == pytest.approx(times.tolist(), rel=1e-8)
    scene = ["--scene", "incline", "--set", f"puck.radius={r}"]
    for spins in (["--w0", listed], ["--set", f"launch.spin={listed}"]):
        ended = invoke("sweep", *scene, *spins)
        found = [float(line.split(",")[0]) for line in ended.stdout.splitlines()[1:]]
        assert found == pytest.approx([0.0, spin, 2.0])


@pytest.mark.thorough
@pytest.mark.skipif(os.name == "nt", reason="names are text there")
def test_names_of_files_that_are_no_text(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.chdir(tmp_path)
    rng = np.random.default_rng(54)
    for n, ending in enumerate((".h5", ".csv", ".json", ".parquet")):
        name = os.fsdecode(bytes(rng.integers(0x80, 0xFF, 3).tolist())) + ".csv"
        Path(name).write_text("0,1\n0.5,2\n1,1\n")
        law_of(name).name.encode()
        pt.Puck.similar(pressure=name).simulate((1.0, 0.0)).save(f"run{ending}")
        build = ["build-tables", "--accuracy", "1e-3", "-o", f"{n}.h5"]
        made = invoke(*build, "--pressure", name)
        assert made.exit_code == 0, made.stderr
        assert invoke("info", f"{n}.h5").exit_code == 0


@pytest.mark.parametrize("seed", range(20))
def test_a_number_without_a_unit_beside_one_that_has_it_is_refused(seed: int):
    """In a list, a pair, a range, a spread, as an option, a field and in Python."""
    rng = np.random.default_rng([36, seed])
    unit = list(UNITS)[rng.integers(len(UNITS))]
    parts = [drawn(rng, unit)[0] for _ in range(2)]
    bare = int(rng.integers(2))
    parts[bare] = f"{rng.uniform(0.5, 2.0):.3g}"
    words = f"'{parts[bare]}' has none"
    for kind, text in ((Vector, "{},{}"), (RangeParam, "{},{}"), (RangeParam, "{}:{}:5")):
        with pytest.raises(click.BadParameter, match=words):
            kind(unit).convert(text.format(*parts), None, None)
    with pytest.raises(InputError, match=words):
        spread_named("normal:{}:{}".format(*parts), unit)
    if unit == "m/s":
        with pytest.raises(InputError, match=words):
            pt.Scene(pt.Puck(0.04), launch=pt.Launch(tuple(parts)))
    if unit == "rad/s":
        for spins in (parts, "{}:{}:3".format(*parts)):
            with pytest.raises(InputError, match=words):
                pt.Scene(pt.Puck(0.04), launch=pt.Launch(spin=spins))
    parts[bare] = "0"  # of any unit
    assert 0.0 in Vector(unit).convert(",".join(parts), None, None)


@pytest.mark.parametrize("seed", range(4))
def test_headings_with_a_factor_or_a_ratio_are_refused(seed: int, tmp_path: Path):
    rng = np.random.default_rng([39, seed])
    ten = 10 ** int(rng.integers(1, 4))
    for name in (f"{ten} x (cm)", f"x*{ten}", f"{ten / 1e4} x", "x/R", "x (Mm)"):
        with pytest.raises(InputError):
            headings(["t", name, name.replace("x", "y")])
    assert headings([f"{ten} x", f"{ten} y", "2 x", "2 y"])[0].puck == str(ten)
    for name in ("friction ratio", "mu_ratio", "friction fraction", "scaled COF"):
        with pytest.raises(InputError, match="is not the friction coefficient itself"):
            unit_of("law.csv", name, FRICTION)
    assert unit_of("law.csv", "mu [ratio]", FRICTION)[1] == 1.0

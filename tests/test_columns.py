"""Columns of numbers in files: names, units, separators, marks and order drawn at random."""

from __future__ import annotations

import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

import puck_tables as pt
from puck_tables._core.quantities import X, Y
from puck_tables._core.read_columns import numbers_of
from puck_tables.contact.law_moments import law_moments
from puck_tables.contact.laws import law_of
from puck_tables.errors import InputError
from puck_tables.reference.log import times_in
from puck_tables.scene.over_time import drive_of
from puck_tables.scene.restitution import restitution_law
from puck_tables.world.paths import rows_of

# how headings may be written, and units with their size
NAMES = {
    "speed": ["v", "u", "speed", "Sliding speed", "slip velocity", "Geschwindigkeit"],
    "f": ["f", "mu", "COF", "friction coefficient", "\u00b5", "Reibwert", "coeff of friction"],
    "e": ["e", "COR", "restitution", "coefficient of restitution"],
    "r": ["r", "rho", "radius", "Radius"], "p": ["p", "W", "pressure", "contact pressure"],
    "t": ["t", "time", "Zeit"], "x": ["x", "X"], "y": ["y", "y_pos"], "angle": ["angle", "theta"],
    "fx": ["Fx", "F_x", "force x"], "fy": ["Fy", "F_y"], "torque": ["torque", "Mz", "Moment"],
}  # fmt: skip
LENGTHS = {"m": 1.0, "mm": 1e-3, "cm": 0.01, "in": 0.0254, "um": 1e-6}
UNITS: dict[str, dict[str, float]] = {
    "speed": {"m/s": 1.0, "mm/s": 1e-3, "cm/s": 0.01, "m s^-1": 1.0, "mm/min": 1e-3 / 60.0,
              "km/h": 1.0 / 3.6, "in/s": 0.0254, "mph": 0.44704, "knots": 1852.0 / 3600.0},
    "f": {"": 1.0, "-": 1.0, "1": 1.0, "%": 0.01, "permille": 1e-3},
    "e": {"": 1.0, "1": 1.0, "%": 0.01},
    "r": LENGTHS, "p": {"kPa": 1.0, "Pa": 1.0, "": 1.0}, "t": {"s": 1.0, "ms": 1e-3, "min": 60.0},
    "x": LENGTHS, "y": LENGTHS, "angle": {"rad": 1.0, "deg": np.pi / 180.0, "turn": 2.0 * np.pi},
    "fx": {"N": 1.0, "mN": 1e-3, "kN": 1e3}, "fy": {"N": 1.0, "mN": 1e-3},
    "torque": {"N m": 1.0, "Nm": 1.0, "N mm": 1e-3, "mN m": 1e-3},
}  # fmt: skip
ENCODINGS = ["utf-8", "utf-8-sig", "utf-16"]


def drawn(rng: np.random.Generator, path: Path, columns: dict[str, np.ndarray]) -> Path:
    """A file of columns in SI units, written as somebody might."""
    separator, comma = [(",", False), (";", True), (";", False), ("\t", True)][rng.integers(4)]
    names, cells = [], []
    for name, values in columns.items():
        unit, size = list(UNITS[name].items())[rng.integers(len(UNITS[name]))]
        written = NAMES[name][rng.integers(len(NAMES[name]))]
        form = ["{} [{}]", "{} ({})"][rng.integers(2)]
        names.append(form.format(written, unit) if unit else written)
        cells.append([f"{value / size:.12g}" for value in values])
    if rng.random() < 0.5:
        names.append("n")
        cells.append([str(n) for n in range(len(cells[0]))])
    order = rng.permutation(len(names))
    rows = [[cells[n][k] for n in order] for k in range(len(cells[0]))]
    if comma:
        rows = [[cell.replace(".", ",") for cell in row] for row in rows]
    lines = [separator.join(names[n] for n in order), *(separator.join(row) for row in rows)]
    if rng.random() < 0.5:
        lines = ["# rig 7, PTFE on steel", *lines]
    lines.insert(int(rng.integers(2, len(lines))), "# a pause")
    path.write_bytes("\n".join(lines).encode(ENCODINGS[rng.integers(3)]))
    return path


def read_as(kind: str, path: Path) -> np.ndarray:
    """What the door of a kind of file makes of it, in columns."""
    if kind == "law":
        law = pt.SpeedLaw.from_csv(path)
        return np.array([law.speeds, law.values])
    if kind == "restitution":
        table: Any = restitution_law(str(path))
        return np.array([table.speeds, table.values])
    if kind == "profile":
        radii, pressure = law_of(str(path)).profile or ((), ())
        return np.array([radii, pressure])
    if kind == "corners":
        return numbers_of(path, (X, Y), 2, 10_000).rows.T
    if kind == "force":
        return drive_of(str(path)).T
    return rows_of(str(path)).T


KINDS = {
    "law": ("speed", "f"), "restitution": ("speed", "e"), "profile": ("r", "p"),
    "force": ("t", "fx", "fy", "torque"), "path": ("t", "x", "y", "angle"), "corners": ("x", "y"),
}  # fmt: skip


@pytest.mark.parametrize("kind", KINDS)
def test_a_file_is_read_however_it_is_written(kind: str, tmp_path: Path):
    rng = np.random.default_rng(list(KINDS).index(kind))
    for n in range(25):
        count = int(rng.integers(3, 9))
        first = np.append(0.0, np.cumsum(rng.uniform(0.01, 0.5, count - 1)))
        given = {KINDS[kind][0]: first}
        for name in KINDS[kind][1:]:
            given[name] = rng.uniform(0.05, 1.0, count)
        path = drawn(rng, tmp_path / f"{n}.csv", given)
        expected = np.array(list(given.values()))
        if kind == "profile":
            expected[0] /= expected[0, -1]
            expected[1] /= expected[1].max()
        assert_allclose(read_as(kind, path), expected, rtol=1e-10, atol=1e-12)


@pytest.mark.parametrize("heading", ["", "t [ms]\n", "time_ms\n", "# s\nt\n"])
@pytest.mark.parametrize("comma", [False, True])
def test_times_one_a_line(heading: str, comma: bool, tmp_path: Path):
    times = np.random.default_rng(16).uniform(0.0, 9.0, 20).round(4)
    text = heading + "\n".join(map(str, times.tolist()))
    (tmp_path / "t.txt").write_text(text.replace(".", ",") if comma else text)
    assert_allclose(times_in(tmp_path / "t.txt"), times * (1e-3 if "ms" in heading else 1.0))


def test_a_law_of_millimetres_stops_where_one_of_metres_does(tmp_path: Path):
    """Through the door of scenes; a unit not read would make the puck stop elsewhere."""
    rng = np.random.default_rng(13)
    speeds, values = np.append(0.0, np.cumsum(rng.uniform(0.2, 1.0, 4))), rng.uniform(0.1, 0.3, 5)
    stops = []
    for name, unit, size in (("a", "m/s", 1.0), ("b", "mm/s", 1e3), ("c", "cm/s", 1e2)):
        rows = [
            f"{size * v!r},{f!r}" for v, f in zip(speeds.tolist(), values.tolist(), strict=True)
        ]
        (tmp_path / f"{name}.csv").write_text("\n".join([f"Sliding speed ({unit}),COF", *rows]))
        floor = pt.Floor(law=str(tmp_path / f"{name}.csv"))
        launch = pt.Launch((0.8, 0.0), 10.0)
        scene = pt.Scene(pt.Puck(0.04, 0.02), floor, launch=launch, tol=1e-4)
        stops.append(scene.simulate().last["x"])
    assert_allclose(stops[1:], stops[0], rtol=1e-6)


def test_speeds_that_begin_above_0_and_speeds_given_twice(tmp_path, capsys):
    rng = np.random.default_rng(14)
    for n, (door, head) in enumerate(
        [(pt.SpeedLaw.from_csv, "v,mu"), (restitution_law, "v,e")] * 4
    ):
        each = np.cumsum(rng.uniform(0.1, 1.0, 5)).round(3)
        count = rng.integers(1, 4, 5)
        speeds = np.repeat(each, count)
        values = rng.uniform(0.1, 0.9, speeds.size).round(3)
        path = tmp_path / f"{n}.csv"
        rows = [f"{v},{f}" for v, f in zip(speeds.tolist(), values.tolist(), strict=True)]
        path.write_text("\n".join([head, *rows]))
        law: Any = door(str(path))
        means = [values[speeds == v].mean() for v in each]
        assert_allclose(law.speeds, np.append(0.0, each))
        assert_allclose(law.values, [means[0], *means])
        said = capsys.readouterr().err
        assert f"{path}: below its first speed, {each[0]:g} m/s" in said
        assert ("given more than once: the mean is taken" in said) == (count > 1).any()
        assert_allclose(law(0.5 * each[0]), means[0], rtol=1e-12)
        swapped = [rows[-1], *rows[:-1]]
        path.write_text("\n".join([head, *swapped]))
        with pytest.raises(InputError, match=r"\.csv, line 3: .* after .*: the speeds must ascend"):
            door(str(path))


@pytest.mark.parametrize(
    ("content", "said"),
    [
        ("speed [bar],mu\n0,.1\n1,.2\n", r"of its column 'speed \[bar\]' \(speed\) is not"),
        ("speed rpm,mu\n0,.1\n1,.2\n", "the unit of its column 'speed rpm'"),
        ("speed [ms],mu\n0,.1\n1,.2\n", "the unit of its column"),
        ("v,friction force [N]\n0,.1\n1,.2\n", "it is a pure number"),
        ("# in (mm/s)\n0,.1\n1,.2\n", "says 'mm/s' over its numbers, but not of which column"),
        ("t,mu\n0,.1\n1,.2\n", "must hold the columns"),
        ("v,u,mu\n0,1,.1\n1,2,.2\n", "2 columns of speed: 'v', 'u'"),
        ("v,a,b\n0,1,.1\n1,2,.2\n", "must hold the columns"),
        ("v,mu\n0,.1\n# a pause\n\n1,\n", "line 5: it has no friction coefficient"),
        ("v;mu\n0.5;0,1\n1,500;0,2\n", "line 3, column 1: '1,500' has a comma, other numbers a"),
        ("v;mu\n0,5;0,1\n1.500;0,2\n", "line 3, column 1: '1.500' has a point"),
        ('{"v": [0, 1]}', "looks like JSON"), ("PK\x03\x04", "a zip archive"),
    ],
)  # fmt: skip
def test_what_is_doubtful_is_refused(content: str, said: str, tmp_path: Path):
    path = tmp_path / "law.csv"
    path.write_text(content)
    with pytest.raises(InputError, match=said):
        pt.SpeedLaw.from_csv(path)


KNOWN = {"law": "v,mu", "restitution": "v,e", "profile": "rho,W", "force": "t,Fx,Fy",
         "path": "t,x,y"}  # fmt: skip
ROWS = "0,0,0,0\n.5,.5,.5,.5\n1,1,1,1\n"


def of_width(count: int) -> str:
    return "".join(",".join(row.split(",")[:count]) + "\n" for row in ROWS.split())


@pytest.mark.parametrize("kind", KNOWN)
def test_columns_that_are_not_read_are_named(kind, tmp_path, capsys):
    rng = np.random.default_rng(17)
    names, path = KNOWN[kind].split(","), tmp_path / f"{kind}.csv"
    strange = "".join(chr(97 + n) for n in rng.integers(0, 26, 9))
    at = int(rng.integers(len(names) + 1))
    path.write_text(",".join([*names[:at], strange, *names[at:]]) + "\n" + of_width(len(names) + 1))
    read_as(kind, path)
    assert f"{path}: column '{strange}' not read" in capsys.readouterr().err
    path.write_text(f"{KNOWN[kind]}\n{of_width(len(names))}")
    read_as(kind, path)
    assert "not read" not in capsys.readouterr().err


@pytest.mark.parametrize(
    ("kind", "heads"),
    [
        ("law", ["rpm,mu", "Hz,mu", "deg/s,COF", "N,mu", "1/s,f", "rpm,wert", "kHz,wert"]),
        ("restitution", ["rpm,e", "Hz,e", "(rad/s),e"]),
        ("force", ["frame,Fx,Fy", "Frame no,Fx,Fy", "image,Fx [N],Fy [N]"]),
        ("path", ["frame,x,y", "Bild,x [mm],y [mm]", "frames,x,y"]),
        ("profile", ["diameter,W", "diameter [N],W"]),
        ("law", ["v,mu x 10^2", "v,mu*1000", "v,mu (x100)", "v [10^-3 m/s],mu", "v,10^3 mu",
                 "v,mu/100", "v,mu (100)", "v,mu \u00d71000", "v,mu \u00b7 10\u00b2", "v,1000 mu",
                 "v x 1000,mu", "v,mu (0.01)", "v,COF [1e-2]", "v,mu_x100"]),
        ("law", ["v,mu (x1e-2)", "v,mu (e-2)", "v^2,mu", "log v,mu", "v/v0,mu", "speed ratio,mu",
                 "v,1/mu", "v,log mu", "v,mu/mu0", "sqrt(v),mu", "v\u00b2,mu"]),
        ("restitution", ["v,1-e", "v,e^2", "v^2,e", "ln v,e"]),
        ("force", ["t,Fx x 10^3,Fy", "t*1000,Fx,Fy", "t,Fx/Fmax,Fy/Fmax", "t/T,Fx,Fy",
                   "log t,Fx,Fy"]),
        ("path", ["t,x^2,y", "t,x/r,y", "log t,x,y"]),
        ("profile", ["r^2,W", "r,log p", "r,cumulative load"]),
    ],
)  # fmt: skip
def test_headings_of_another_quantity_or_with_a_factor_are_refused(kind, heads, tmp_path):
    for n, head in enumerate(heads):
        path = tmp_path / f"{n}.csv"
        path.write_text(f"{head}\n{of_width(head.count(',') + 1)}")
        with pytest.raises(
            InputError, match=r"must hold the co|is not known|factor|needs a|not the"
        ):
            read_as(kind, path)
    if "frame" in heads[0]:
        (tmp_path / "a.csv").write_text(f"{heads[0]}\n{of_width(3)}")
        with pytest.raises(InputError, match="of frames write their times, frame / frames"):
            read_as(kind, tmp_path / "a.csv")


def test_percent_and_units_alone_are_read_and_doubts_are_said(tmp_path, capsys):
    rng = np.random.default_rng(18)
    heads = ["v,mu%", "v,mu [%]", "v,COF (in %)", "v,mu percent", "v,mu in %", "m/s,mu (per cent)"]
    for n, head in enumerate(heads):
        f = rng.uniform(0.2, 0.3, 3).round(4)
        rows = "".join(f"{v},{100 * one:.6g}\n" for v, one in enumerate(f))
        (tmp_path / f"{n}.csv").write_text(f"{head}\n{rows}")
        assert_allclose(pt.SpeedLaw.from_csv(tmp_path / f"{n}.csv").values, f, rtol=1e-6)
    assert "percent" not in capsys.readouterr().err
    (tmp_path / "a.csv").write_text(f"mm/s,mu\n{rows}")
    law = pt.SpeedLaw.from_csv(tmp_path / "a.csv")
    assert_allclose(law.speeds, [0.0, 0.001, 0.002])
    assert f"{tmp_path / 'a.csv'}: its friction coefficients go up to" in capsys.readouterr().err
    (tmp_path / "b.csv").write_text("fast,slow\n0,.1\n1,.2\n")
    pt.SpeedLaw.from_csv(tmp_path / "b.csv")
    assert "its columns 'fast', 'slow' are taken as v [m/s], f" in capsys.readouterr().err


def test_a_profile_over_the_diameter_and_one_of_another_rim(tmp_path, capsys):
    radii = np.append(0.0, np.cumsum(np.random.default_rng(19).uniform(1.0, 9.0, 4)))
    rim = radii[-1] * 1e-3
    for head, size in (("r [mm],p", 1.0), ("diameter [mm],p", 2.0), ("Durchmesser (cm),p", 0.2)):
        path = tmp_path / f"{size}.csv"
        rows = "".join(f"{size * r:.12g},{9 - n}\n" for n, r in enumerate(radii))
        path.write_text(f"{head}\n{rows}")
        assert_allclose(law_of(str(path)).profile[0], radii / radii[-1], rtol=1e-9)  # type: ignore[index]
        said = f"{path.name} ends at {rim:g} m: pucks of another radius"
        pt.Puck(rim, pressure=str(path))
        assert said not in capsys.readouterr().err
        pt.Puck(1.3 * rim, pressure=str(path))
        assert said in capsys.readouterr().err


@pytest.mark.parametrize("way", ["names", "units below", "a comment", "none", "under a title"])
def test_headings_of_every_kind(way: str, tmp_path: Path):
    head, size = {
        "names": ("speed_mm_s mu\n", 1e-3), "units below": ("velocity cof\nmm/s -\n", 1e-3),
        "a comment": ("# v [mm/s] mu\n", 1e-3), "none": ("", 1.0),
        "under a title": ("the rig 7\n", 1.0),
    }[way]  # fmt: skip
    path = tmp_path / "law.csv"
    path.write_text(f"{head}0 .3\n100 .2\n250 .1\n")
    law: Any = pt.SpeedLaw.from_csv(path)
    assert_allclose(law.speeds, [0.0, 100.0 * size, 250.0 * size])
    assert law.values.tolist() == [0.3, 0.2, 0.1]


def test_laws_are_equal_to_themselves_and_to_what_is_pickled(tmp_path: Path):
    rng = np.random.default_rng(15)
    (tmp_path / "p.csv").write_text("r [mm],p [kPa]\n0,2\n10,3\n25,1\n")
    speeds = np.append(0.0, np.cumsum(rng.uniform(0.1, 1.0, 4)))
    values = rng.uniform(0.1, 0.3, 5)
    laws: list[Any] = [
        pt.SpeedLaw(speeds, values), pt.SpeedLaw(speeds, values, "linear"),
        pt.SpeedLaw(speeds, values[::-1]), pt.SpeedLaw(speeds[:3], values[:3]),
        *map(law_of, ("uniform", "hertz", "annulus:0.5", "annulus:0.6", str(tmp_path / "p.csv"))),
        pt.StribeckLaw(0.3, 0.1, speed=0.2), restitution_law("plastic:0.1"),
        pt.RestitutionTable(speeds, values),
    ]  # fmt: skip
    for n, one in enumerate(laws):
        for m, other in enumerate(laws):
            assert (one == other) is (n == m)
        again = pickle.loads(pickle.dumps(one))
        assert again == one and (type(one).__hash__ is None or hash(again) == hash(one))
        assert one != "a text"


def test_the_last_piece_of_a_law_ends_where_the_law_does():
    """A node of it was beyond, by rounding, of every tenth law: the scene was refused."""
    rng = np.random.default_rng(15)
    for top in rng.uniform(0.5, 5.0, 100):
        law = pt.SpeedLaw([0.0, 0.4 * top, top], [0.3, 0.25, 0.2], kind="cubic")
        ends, _, _ = law_moments(law, law.speeds)
        assert ends[-1] == top

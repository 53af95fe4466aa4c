"""Runs of engines held against the exact answer: errors put in are found, and refusals."""

from __future__ import annotations

import json
import math
from html import escape
from pathlib import Path

import numpy as np
import pytest
from commands import invoke

from puck_tables import InputError, compare, reference_case
from puck_tables.plot.comparison_figure import page
from puck_tables.reference.case_text import lines_of
from puck_tables.reference.log import turned

HEADER = "t [s],x [m],y [m],angle [rad],vx [m/s],vy [m/s],w [rad/s]"


def columns(name: str = "coin", dt: float = 1e-3) -> dict[str, np.ndarray]:
    exact = reference_case(name, times=np.arange(0.0, 1.1 * reference_case(name).end_time, dt))
    names = {"angle": "orientation", "w": "spin", "t": "time"}
    return {
        n: getattr(exact, names.get(n, n)).copy() for n in ("t", "x", "y", "angle", "vx", "vy", "w")
    }


def written(path: Path, rows: dict[str, np.ndarray], header: str = HEADER) -> Path:
    np.savetxt(path, np.column_stack(list(rows.values())), "%.15g", ",", header=header, comments="")
    return path


def test_errors_put_in_are_found(tmp_path: Path):
    rows = columns()
    shape = np.sin(20.0 * rows["t"])
    rows["x"] += 3e-6 * shape
    rows["w"] += 0.02 * shape
    found = compare(written(tmp_path / "a.csv", rows), "coin").rows()[0]
    assert found["place_error_max"] == pytest.approx(3e-6 * np.abs(shape).max(), rel=1e-6)
    assert found["spin_error_max"] == pytest.approx(0.02 * np.abs(shape).max(), rel=1e-6)
    assert max(found["speed_error_max"], found["angle_error_max"]) < 1e-13


def test_a_slow_clock_stops_late(tmp_path: Path):
    """Times 1 % too long: rest is late by 1 %."""
    rows = columns(dt=1e-4)
    rows["t"] *= 1.01
    found = compare(written(tmp_path / "a.csv", rows), "coin", thresholds=["1mm/s"])
    assert found.rows()[0]["rest_time_error"] == pytest.approx(
        0.01 * found.exact_rest.time, rel=2e-3
    )


def test_any_order_any_units_and_quaternions(tmp_path: Path):
    """The same run in millimetres, degrees and y up, its columns shuffled, is the same."""
    rows = columns()
    half = 0.5 * rows["angle"]
    base = np.array([0.5, 0.5, 0.5, 0.5])  # of a body whose axes lie elsewhere
    c, s = np.cos(half), np.sin(half)
    w0, x0, y0, z0 = base  # (c, 0, s, 0) times base
    q = np.column_stack([c * w0 - s * y0, c * x0 + s * z0, c * y0 + s * w0, c * z0 - s * x0])
    none = 0.0 * c
    shuffled = {
        "z": -1e3 * rows["y"], "qz": q[:, 3], "t": 1e3 * rows["t"], "wy": np.degrees(rows["w"]),
        "qw": q[:, 0], "x": 1e3 * rows["x"], "vz": -1e3 * rows["vy"], "qx": q[:, 1], "y": none,
        "qy": q[:, 2], "vx": 1e3 * rows["vx"], "vy": none,
    }  # fmt: skip
    head = ("pos_z [mm],qz,time [ms],omega_y (deg/s),qw,x [mm],v_z [mm/s],quat.x,y [mm],qy,"
            "vel x [mm/s],vy [mm/s]")  # fmt: skip
    path = written(tmp_path / "a.csv", shuffled, head)
    with pytest.raises(InputError, match="which axis points up"):
        compare(path, "coin")
    found = compare(path, "coin", up="y").rows()[0]
    assert max(found["place_error_max"], found["angle_error_max"]) < 1e-12
    assert max(found["speed_error_max"], found["spin_error_max"]) < 1e-11


def test_units_by_option(tmp_path: Path):
    path = written(tmp_path / "a.csv", columns(), "t,x,y,angle,vx,vy,w")
    with pytest.raises(InputError, match="does not say the unit of its column x"):
        compare(path, "coin")
    with pytest.raises(InputError, match=r"unit of its column angle.*--angle-unit"):
        compare(path, "coin", unit="m")
    assert compare(path, "coin", unit="m", angle_unit="rad").rows()[0]["place_error_max"] < 1e-14


def test_the_order_of_a_first_order_engine(tmp_path: Path):
    """Euler's method, half implicit, on f m g alone: order 1 in the place."""
    paths = []
    for dt in (4e-3, 2e-3, 1e-3):
        v = np.maximum(1.0 - 0.2 * 9.81 * dt * np.arange(math.ceil(0.55 / dt)), 0.0)
        x = np.concatenate([[0.0], np.cumsum(v[1:] * dt)])
        t = dt * np.arange(v.size)
        path = tmp_path / f"{dt:g}.csv"
        paths.append(
            written(
                path, {"t": t, "x": x, "y": 0 * x, "a": 0 * x, "vx": v, "vy": 0 * x, "w": 0 * x}
            )
        )
    found = compare(paths[::-1], "slide")
    assert [run.step for run in found.runs] == pytest.approx([4e-3, 2e-3, 1e-3])
    orders = found.convergence()["place on the way"].removeprefix("order ").split(", ")
    assert [float(one) for one in orders] == pytest.approx([1.0, 1.0], abs=0.02)


def test_an_error_of_the_model_does_not_fall(tmp_path: Path):
    paths = []
    for dt in (2e-3, 1e-3):
        rows = columns(dt=dt)
        rows["x"] *= 1.01
        paths.append(written(tmp_path / f"{dt:g}.csv", rows))
    found = compare(paths, "coin")
    assert "of the model" in found.convergence()["place on the way"]


def test_truth_at_a_finite_threshold_is_no_error(tmp_path: Path):
    found = compare(written(tmp_path / "a.csv", columns(dt=1e-4)), "coin", thresholds=["0.1 rad/s"])
    assert round(found.exact_rest.epsilon, 5) == 0.66486
    assert found.transient == pytest.approx(0.66486 - 0.65311, abs=2e-5)
    assert found.rows()[0]["epsilon_error"] == pytest.approx(0.0, abs=1e-9)
    assert any("truth and not error" in one for one in found.truths())


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda rows: rows | {"t": rows["t"] + 3.2}, "must start at the launch"),
        (lambda rows: rows | {"x": rows["x"] + 0.5}, "is not the launch of case coin"),
        (lambda rows: rows | {"vx": 2 * rows["vx"]}, "is not the launch of case coin"),
        (lambda rows: rows | {"w": -rows["w"]}, "is not the launch of case coin"),
        (lambda rows: {n: one[::-1] for n, one in rows.items()}, "times must increase"),
        (lambda rows: rows | {"vy": np.full(rows["t"].size, np.nan)}, "has no vy"),
        (lambda rows: {n: one[:2] for n, one in rows.items()}, "has 2 rows of .*at least three"),
        (lambda rows: {n: one[:1] for n, one in rows.items()}, "has 1 row of numbers"),
        (lambda rows: {n: one[:0] for n, one in rows.items()}, "has no rows below its header, 't"),
    ],
)  # fmt: skip
def test_what_is_no_run_of_the_case(change, words: str, tmp_path: Path):
    with pytest.raises(InputError, match=words):
        compare(written(tmp_path / "a.csv", change(columns())), "coin")


@pytest.mark.parametrize(
    ("header", "words"),
    [
        ("t [s],a [m],b [m],angle [rad],vx [m/s],vy [m/s],w [rad/s]",
         r"no column that is known as x or y \(its columns are t \[s\], a"),
        ("t [s],x [furlong],y [m],-,-,-,-", r"a\.csv: the unit of the column 'x \[furlong\]'"),
        ("t [s],x [m],y [kg],angle [rad],vx [m/s],vy [m/s],w [rad/s]", "unit of the column"),
        ("t [s],x [m],y [m],angle [rad],vx [m/s],v2,w [rad/s]", "one component"),
        ("t [s],x [m],y [m],angle [rad],vx [m/s],vx [m/s],w [rad/s]", "two columns of vx"),
        ("t [s],x [m],y [m],angle [rad],x_vel [m/s],v2,w [rad/s]", "one component"),
        ("t [s],x [m],y [m],qw,qx,qy,w [rad/s]", "all of qw, qx, qy, qz"),
        ("t [s],x [m],y [px],angle [rad],vx [m/s],vy [m/s],w [rad/s]", "unit of the column"),
    ],
)  # fmt: skip
def test_columns_that_cannot_be_told(header: str, words: str, tmp_path: Path):
    with pytest.raises(InputError, match=words):
        compare(written(tmp_path / "a.csv", columns(), header), "coin")


def test_quaternions_are_normalised_and_upright():
    unit = np.tile([1.0, 0.0, 0.0, 0.0], (3, 1))
    with pytest.raises(InputError, match="row 1 of its numbers has the length 2"):
        turned("a.csv", 2.0 * unit, 2)
    unit[2] = [math.cos(0.5), math.sin(0.5), 0.0, 0.0]
    with pytest.raises(InputError, match="tilted by 57 degrees from row 1 to row 3"):
        turned("a.csv", unit, 2)
    tilted = np.tile(unit[2], (3, 1))  # the axes of a body are not known
    assert np.array_equal(turned("a.csv", tilted, 2), np.zeros(3))


def of_the_take_out(path: Path, puck: int, until: float) -> Path:
    exact = reference_case("take-out", times=np.arange(0.0, until, 2e-3))
    names = ("x", "y", "orientation", "vx", "vy", "spin")
    return written(path, {"t": exact.time} | {name: exact.columns[name][:, puck] for name in names})


def test_the_stop_is_that_of_the_puck_compared(tmp_path: Path):
    """Red rests by 0.372 s, yellow by 0.490 s; half of J t is what a threshold is early by."""
    path = of_the_take_out(tmp_path / "red.csv", 0, 0.6)
    found = compare(path, "take-out", puck="red", thresholds=["2mm/s"])
    assert 0.371 < found.end_time < 0.372
    early = found.end_time - found.exact_rest.time
    assert 0.0 < early < 2.0 * 2e-3 / (0.2 * 9.81)
    assert found.rows()[0]["stop_place_error"] < 1e-12
    told = found.summary()
    assert (told["puck"], told["end_time"]) == ("red", found.end_time)
    assert found.dataset().attributes["end_time"] == found.end_time
    assert found.plot().axes[1].get_xlim()[1] == pytest.approx(1.15 * found.end_time)
    result = invoke("compare", path, "--case", "take-out", "--puck", "red")
    assert "exact: red at rest after 0.37160" in result.stdout
    text = page(found)
    assert "The puck red ends after 0.37160" in text
    assert all(escape(told) in text for told in lines_of(found.answer).values())


def test_the_files_of_the_reference_itself(tmp_path: Path):
    exact = reference_case("coin", dt=1e-3)
    exact.save(tmp_path / "a.csv")
    found = compare(tmp_path / "a.csv", "coin")
    assert found.rows()[0]["place_error_max"] == found.rows()[0]["spin_error_max"] == 0.0
    found.save(tmp_path / "b.csv")
    assert (tmp_path / "b.csv").read_text().splitlines()[1].startswith("0,coin (version 1),a.csv,")
    again = reference_case("coin", times=tmp_path / "a.csv")
    assert again.time.tolist() == exact.time.tolist()


def test_rows_of_several_pucks_one_below_the_other(tmp_path: Path):
    """By names, by numbers, in any order; and rows that a column only counts."""
    exact = reference_case("take-out", dt=0.01)
    exact.save(tmp_path / "a.csv")
    lines = (tmp_path / "a.csv").read_text().splitlines()
    head = lines[0].split(",")
    cells = [line.split(",") for line in lines[1:]]
    no_name = [",".join(row[:2] + row[4:]) for row in sorted(cells, key=lambda row: row[1])]
    assert head[1] == "puck[1]" and head[3] == "name"
    (tmp_path / "b.csv").write_text("\n".join([",".join(head[:2] + head[4:]), *no_name]) + "\n")
    for name in ("a.csv", "b.csv"):
        for puck in ("red", "yellow"):
            row = compare(tmp_path / name, "take-out", puck=puck).rows()[0]
            assert row["place_error_max"] == row["spin_error_max"] == 0.0
    other = (tmp_path / "a.csv").read_text().replace("red", "blue").replace("puck[1]", "n[1]")
    (tmp_path / "c.csv").write_text(other)
    with pytest.raises(InputError, match=r"several pucks, .* name \(blue, yellow\).*the puck red"):
        compare(tmp_path / "c.csv", "take-out", puck="red")
    with pytest.raises(InputError, match=r"rows of several pucks.*leave only those of one"):
        compare(tmp_path / "a.csv", "coin")
    counted = {"id": np.arange(columns()["t"].size, dtype=float)} | columns()
    found = compare(written(tmp_path / "d.csv", counted, "id," + HEADER), "coin")
    assert found.rows()[0]["place_error_max"] < 1e-14


def test_what_a_file_does_not_tell_is_said(tmp_path: Path):
    rows = columns()
    short = {name: row[:60] for name, row in rows.items()}
    trembling = rows | {"vx": np.where(rows["t"] == rows["t"][-1], 0.1, rows["vx"])}
    bare = {name: rows[name] for name in ("t", "x", "y")}
    paths = [
        written(tmp_path / "a.csv", rows), written(tmp_path / "b.csv", short),
        written(tmp_path / "c.csv", bare, "t [s],x [m],y [m]"),
        written(tmp_path / "d.csv", trembling),
    ]  # fmt: skip
    found = compare(paths, "coin", thresholds=["2 mm/s"], steps=[4e-3, 3e-3, 2e-3, 1e-3])
    said = [
        "b.csv: never below v < 0.002 m/s in its 0.059 s",
        "c.csv: no velocities and spin in it, so nothing of rest",
        "d.csv: not below v < 0.002 m/s in its last row, at 0.136 s",
    ]
    assert found.untold() == said
    whys = [run["why"] for run in found.summary()["runs"]]
    assert whys == [None, *(one[7:] for one in said)]
    words, text = str(found), page(found)
    assert all(one in words and escape(one) in text for one in said)
    assert "carried on by it" in str(compare(of_the_belt(tmp_path / "e.csv"), "belt"))


def test_chatter_without_spin_has_no_ratio(tmp_path: Path):
    """Its speed falls below the threshold where nothing spins but rounding."""
    rows = columns()
    after = rows["t"] > reference_case("coin").end_time
    rows["w"][after] = 1e-13
    rows["vx"][after] = 3e-3 * (np.arange(after.sum()) < after.sum() - 3)
    path = written(tmp_path / "a.csv", rows)
    found = compare(path, "coin", thresholds=["1mm/s", "0.1rad/s"])
    assert found.rows()[0]["rest_time"] > found.end_time
    assert math.isnan(found.rows()[0]["epsilon_seen"])
    assert math.isnan(found.rows()[0]["epsilon_error"])


def of_the_belt(path: Path) -> Path:
    return written(path, columns("belt", 5e-3))


@pytest.mark.parametrize("text", ["0.1", "fast", "-1 mm/s", "0rad/s", "1 kg", "1e999 m/s"])
def test_thresholds_refused(text: str, tmp_path: Path):
    with pytest.raises(InputError, match="a threshold is a speed or a spin"):
        compare(written(tmp_path / "a.csv", columns()), "coin", thresholds=[text])


@pytest.mark.thorough
def test_the_command(tmp_path: Path):
    path = written(tmp_path / "my <b>run.csv", columns(dt=2e-3))
    page, picture, table = tmp_path / "a.html", tmp_path / "a.png", tmp_path / "a.json"
    arguments = [
        "compare", str(path), "--case", "coin", "--report", str(page), "--plot", str(picture),
        "-o", str(table),
    ]  # fmt: skip
    result = invoke(*arguments)
    assert result.exit_code == 0, result.output
    assert "truth and not error" in result.stdout
    text = page.read_text()
    assert text.startswith("<!DOCTYPE html>") and "<svg" in text and "<b>run" not in text
    assert "src=" not in text and 'href="http' not in text and "<script" not in text
    assert picture.stat().st_size > 10_000
    assert json.loads(table.read_text())["columns"]["place_error_max"]["values"][0] < 1e-14
    before = page.read_bytes()
    again = invoke(*arguments)
    assert again.exit_code != 0 and "exists" in again.stderr and page.read_bytes() == before


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["reference", "cion"], "did you mean 'coin'"),
        (["reference", "coin", "--dt", "0.1", "--friction"], "of no motion"),
        (["reference", "coin", "--dt", "0"], "dt"),
        (["compare", "none.csv", "--case", "coin"], "cannot read"),
        (["compare", "none.csv", "--case", "nothing"], "there is no case"),
        (["compare", "none.csv", "--case", "take-out"], "has the pucks red, yellow"),
        (["compare", "none.csv", "--case", "coin", "--report", "a.txt"], ".html"),
    ],
)
def test_refused_in_a_sentence(arguments: list[str], words: str):
    result = invoke(*arguments)
    assert result.exit_code == 2 and words in result.stderr
    assert result.stderr.startswith("Error: ") and "Traceback" not in result.output

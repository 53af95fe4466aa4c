"""Tables of tracks in text files: any header, separator, encoding, unit; and what is refused."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from puck_tables import InputError, read_tracks

NAN = math.nan
# two frames of one puck, at (1, 2) and (1.5, 2.5) in the unit of the file, 0.1 s apart
ONE = {
    "units in brackets": ("t [s],x [cm],y [cm]\n0,1,2\n0.1,1.5,2.5\n", {}),
    "units behind": ("time_s,X_cm,Y_cm\n0,1,2\n0.1,1.5,2.5\n", {}),
    "other order": ("y (cm),t (s),x (cm)\n2,0,1\n2.5,0.1,1.5\n", {}),
    "unit given": ("t,x,y\n0,1,2\n0.1,1.5,2.5\n", {"unit": "cm"}),
    "capital unit": ("t,x,y\n0,1,2\n0.1,1.5,2.5\n", {"unit": "CM"}),
    "German": ("Zeit (ms);x in cm;y in cm\n0;1;2\n100;1,5;2,5\n", {}),
    "tabs, decimal comma": ("t\tx\ty\n0\t1\t2\n0,1\t1,5\t2,5\n", {"unit": "cm"}),
    "blanks": ("  t [s]   x [cm]  y [cm]\n  0  1   2\n 0.1  1.5 2.5\n", {}),
    "blanks, decimal comma": ("0,0 1,0 2,0\n0,1 1,5 2,5\n", {"columns": "t,x [cm],y [cm]"}),
    "strokes": ("t|x|y\n0|1|2\n.1|1.5|2.5\n", {"unit": "cm"}),
    "commas and blanks": ("t, x, y\n0, 1, 2\n0.1, 1.5, 2.5\n", {"unit": "cm"}),
    "quotes": ('"t";"x";"y"\n"0";"1";"2"\n"0,1";"1,5";"2,5"\n', {"unit": "cm"}),
    "Excel's first line": ("sep=;\nt;x;y\n0;1;2\n0,1;1,5;2,5\n", {"unit": "cm"}),
    "a row of units": ("t,x,y\ns,cm,cm\n0,1,2\n0.1,1.5,2.5\n", {}),
    "lines before": ("Lab 3,,\nt,x,y\n0,1,2\n0.1,1.5,2.5\n", {"unit": "cm"}),
    "NumPy's comment": ("# t x y\n0 1 2\n0.1 1.5 2.5\n", {"unit": "cm"}),
    "comments": ("% made by hand\nt,x,y\n0,1,2\n# lunch\n\n0.1,1.5,2.5\n", {"unit": "cm"}),
    "without a header": ("0,1,2\n0.1,1.5,2.5\n", {"unit": "cm", "columns": "t,x,y"}),
    "a column left out": ("0,9,1,2\n0.1,9,1.5,2.5\n", {"unit": "cm", "columns": "t,-,x,y"}),
    "another time": ("t,x,y,stop_time\n0,1,2,9\n0.1,1.5,2.5,9\n", {"unit": "cm"}),
    "other columns": ("t,note,x,y,v_x,vy\n0,a,1,2,9,9\n.1,b,1.5,2.5,9,9\n", {"unit": "cm"}),
    "a wrong header": ("x,t,y\n0,1,2\n.1,1.5,2.5\n", {"columns": "t [s],x [cm],y [cm]"}),
    "last separators": ("t,x,y,\n0,1,2,\n0.1,1.5,2.5,\n", {"unit": "cm"}),
    "exponents": ("t,x,y\n0e0,1.0E0,2\n1e-1,15E-1,+2.5\n", {"unit": "cm"}),
    "frames": ("frame,x,y\n7,1,2\n8,1.5,2.5\n", {"unit": "cm", "fps": 10.0}),
    "frames beside times": ("frame,t,x,y\n0,9,1,2\n1,9,1.5,2.5\n", {"unit": "cm", "fps": 10.0}),
    "steps": ("x,y,dt [ms]\n1,2,0\n1.5,2.5,100\n", {"unit": "cm"}),
    "rows are frames": ("x,y\n1,2\n1.5,2.5\n", {"unit": "cm", "fps": 10}),
    "old Mac lines": ("t,x,y\r0,1,2\r0.1,1.5,2.5\r", {"unit": "cm"}),
    "pixels": ("t,x_px,y_px\n0,20,-40\n.1,30,-50\n", {"scale": "0.5mm"}),
    "pixels, y up": ("t,x,y\n0,20,40\n.1,30,50\n", {"scale": 5e-4, "y_down": False}),
    "two units": ("t,x [cm],y [mm]\n0,1,20\n0.1,1.5,25\n", {}),
    "a name over all": ("Puck,,\nt,x,y\n0,1,2\n0.1,1.5,2.5\n", {"unit": "cm"}),
    "quoted decimal commas": ('"t","x","y"\n"0","1","2"\n"0,1","1,5","2,5"\n', {"unit": "cm"}),
    "names": ("Time (s),Ball position x (cm),Ball position y (cm)\n0,1,2\n.1,1.5,2.5\n", {}),
}


def read(folder: Path, text: str | bytes, **how):
    file = folder / "film.csv"
    file.write_bytes(text if isinstance(text, bytes) else text.encode())
    return read_tracks(file, **how)


@pytest.mark.parametrize("case", ONE)
def test_one_puck_however_it_is_written(tmp_path: Path, case: str):
    text, how = ONE[case]
    (track,) = read(tmp_path, text, **how)
    assert_allclose(track.time - track.time[0], [0.0, 0.1], rtol=1e-12)
    assert_allclose(track.place, [[0.01, 0.02], [0.015, 0.025]], rtol=1e-12)
    assert track.angle is None


@pytest.mark.parametrize(
    "encoding", ["utf-8", "utf-8-sig", "latin-1", "utf-16", "utf-16-le", "utf-16-be", "utf-32"]
)
def test_every_encoding_is_told(tmp_path: Path, encoding: str):
    text = "Zeit [s]\tx [µm]\ty [µm]\r\n0\t1\t2\r\n0,1\t1,5\t2,5\r\n"
    (track,) = read(tmp_path, text.encode(encoding))
    assert_allclose(track.place, [[1e-6, 2e-6], [1.5e-6, 2.5e-6]], rtol=1e-12)


TWO = {
    "numbers behind": "t,x1,y1,x2,y2\n0,1,2,5,6\n.1,1,3,5,7\n.2,1,4,,\n",
    "names before": "t,1_x,1_y,2_x,2_y\n0,1,2,5,6\n.1,1,3,5,7\n.2,1,4,,\n",
    "the same names": "t,x,y,x,y\n0,1,2,5,6\n.1,1,3,5,7\n.2,1,4,nan,nan\n",
    "names over them": "\t1\t\t2\t\nt\tx\ty\tx\ty\n0\t1\t2\t5\t6\n.1\t1\t3\t5\t7\n.2\t1\t4\t\t\n",
    "a row each": "id,t,x,y\n1,0,1,2\n2,0,5,6\n1,.1,1,3\n2,.1,5,7\n1,.2,1,4\n2,.2,,\n",
    "numbers and names": "puck,id,t,x,y\n7,1,0,1,2\n7,2,0,5,6\n7,1,.1,1,3\n7,2,.1,5,7\n"
    "7,1,.2,1,4\n7,2,.2,,\n",
    "one after the other": "x,y,t,puck\n1,4,.2,1\n1,2,0,1\n1,3,.1,1\n5,6,0,2\n5,7,.1,2\n,,.2,2\n",
    "own times": "t,x,y,t,x,y\n0,1,2,0,5,6\n.1,1,3,.1,5,7\n.2,1,4,.2,,\n",
}


@pytest.mark.parametrize("case", TWO)
def test_two_pucks_side_by_side_or_row_by_row(tmp_path: Path, case: str):
    one, two = read(tmp_path, TWO[case], unit="m")
    assert [one.name, two.name] == ["film.csv: 1", "film.csv: 2"]
    for track, place in (
        (one, [[1, 2], [1, 3], [1, 4]]), (two, [[5, 6], [5, 7], [NAN, NAN]]),
    ):  # fmt: skip
        assert_allclose(track.time, [0.0, 0.1, 0.2])
        assert_allclose(track.place, place)
    (chosen,) = read(tmp_path, TWO[case], unit="m", pucks="2")
    assert chosen.name == two.name


@pytest.mark.parametrize(
    ("heading", "cells"),
    [
        ("visible", "1 0 1"), ("seen", "true false true"), ("hidden", "0 1 0"),
        ("occluded", "no yes no"), ("state", "visible hidden visible"), ("hidden", " yes "),
        ("hidden", " 1 "),
        ("likelihood", "0.9 0.1 0.6"), ("confidence", "1 0 1"),
    ],
)  # fmt: skip
def test_flags_hide_frames(tmp_path: Path, heading: str, cells: str):
    rows = [f"0.{n},{n},{n},{cell}" for n, cell in enumerate(cells.split(" "))]
    (track,) = read(tmp_path, "\n".join([f"t,x,y,{heading}", *rows]), unit="m")
    assert track.seen.tolist() == [True, False, True]


def test_angles_have_a_unit_and_turn_with_y(tmp_path: Path):
    text = "t,x,y,{}\n0,1,2,90\n0.1,1.5,2.5,450\n"
    (up,) = read(tmp_path, text.format("theta [deg]"), unit="m")
    assert_allclose(up.angle, [0.5 * np.pi, 2.5 * np.pi])
    (down,) = read(tmp_path, text.format("angle"), scale=0.01, angle_unit="°")
    assert_allclose(down.angle, [-0.5 * np.pi, -2.5 * np.pi])
    assert any("downwards" in note for note in down.notes)
    with pytest.raises(InputError, match="angle_unit"):
        read(tmp_path, text.format("angle"), unit="m")


def test_marks_on_a_puck_give_its_centre_and_angle(tmp_path: Path):
    text = "t,a_x,a_y,b_x,b_y\n0,0,0,2,0\n0.1,1,1,1,3\n0.2,1,1,,\n"
    (middle,) = read(tmp_path, text, unit="m", centre="a,b", toward="b")
    assert_allclose(middle.place, [[1, 0], [1, 2], [NAN, NAN]])
    assert_allclose(middle.angle, [0.0, 0.5 * np.pi, NAN])
    (hub,) = read(tmp_path, text, unit="m", centre=["a"], toward="b")
    assert_allclose(hub.place, [[0, 0], [1, 1], [1, 1]])
    assert_allclose(hub.angle, [0.0, 0.5 * np.pi, NAN])
    with pytest.raises(InputError, match="no mark 'c'"):
        read(tmp_path, text, unit="m", centre="c")


TRACKMATE = """LABEL,ID,TRACK_ID,QUALITY,POSITION_X,POSITION_Y,POSITION_T,FRAME,RADIUS
Label,Spot ID,Track ID,Quality,X,Y,T,Frame,Radius
Label,Spot ID,Track ID,Quality,X,Y,T,Frame,R
,,,(quality),(pixel),(pixel),(sec),,(pixel)
ID3,3,0,1.5,10,20,0.0,0,5
ID4,4,1,1.5,11,21,0.0,0,5
ID5,5,0,1.5,12,22,0.5,1,5
ID6,6,1,1.5,13,23,0.5,1,5
"""


def test_a_number_of_the_row_is_no_puck(tmp_path: Path):
    one, two = read(tmp_path, TRACKMATE, scale=1.0)  # exported by TrackMate: four rows of names
    assert (one.name, two.name) == ("film.csv: 0", "film.csv: 1")
    assert_allclose(one.place, [[10, -20], [12, -22]])
    assert_allclose(two.time, [0.0, 0.5])
    (track,) = read(tmp_path, "id,t,x,y\n1,0,\N{MINUS SIGN}1,2\n2,1,3,4\n", unit="m")
    assert_allclose(track.place, [[-1, 2], [3, 4]])


@pytest.mark.parametrize(
    "times",
    [
        ["2025-12-11T23:59:59.950", "2025-12-12T00:00:00.050", "2025-12-12T00:00:00.150000"],
        ["2025-12-11 23:59:59,95+01:00", "2025-12-11 23:00:00,05Z", "2025-12-11 23:00:00,15Z"],
        ["10:59:59.95", "11:00:00.05", "11:00:00.15"], ["59:59.95", "60:00.05", "60:00.15"],
    ],
)  # fmt: skip
def test_dates_and_clocks_are_times(tmp_path: Path, times: list[str]):
    rows = [f"{time};{n};2;5" for n, time in enumerate(times)]
    (track,) = read(tmp_path, "\n".join(["timestamp;x [m];y [m];marker_id", *rows]))
    assert_allclose(track.time, [0.0, 0.1, 0.2], rtol=1e-12)
    with pytest.raises(InputError, match="column 1: 'lunch' is no time"):
        read(tmp_path, "\n".join(["timestamp;x [m];y [m];marker_id", *rows, "lunch;1;2;5"]))


def test_times_with_jitter_are_kept(tmp_path: Path):
    times = np.cumsum(0.01 + 0.002 * np.random.default_rng(4).uniform(-1, 1, 50)).tolist()
    (track,) = read(tmp_path, "t,x,y\n" + "".join(f"{t!r},1,2\n" for t in times), unit="m")
    assert track.time.tolist() == times


def stamped(folder: Path, times: np.ndarray, digits: int) -> np.ndarray:
    """The times of a track whose stamps have so many digits behind the point."""
    rows = "".join(f"{t:.{digits}f},{n},2\n" for n, t in enumerate(times))
    return read(folder, "t,x,y\n" + rows, unit="m")[0].time


@pytest.mark.parametrize("rate", [24.0, 30.0 / 1.001, 59.5, 120.0, 240.0, 480.0, 600.0])
@pytest.mark.parametrize("begin", [0.0, -0.3, 1.7e9])
def test_rounded_stamps_of_even_frames_are_these(tmp_path: Path, rate: float, begin: float):
    frames = np.delete(np.arange(90.0), [4, 31, 32])  # three are lost
    time = stamped(tmp_path, begin + frames / rate, 3)
    # a rate that is none of usual ones is told to 3e-4 of itself
    assert np.abs(np.diff(time) * rate - np.diff(frames)).max() < (1e-9 if rate != 59.5 else 3e-4)


def test_stamps_too_coarse_for_their_frames_ask_for_their_rate(tmp_path: Path):
    times = np.arange(90.0) / 240.0
    with pytest.raises(InputError, match="or give frames a second"):
        stamped(tmp_path, times, 2)
    text = "t,x,y\n" + "".join(f"{t:.2f},1,2\n" for t in times)
    (track,) = read(tmp_path, text, unit="m", fps=240.0)
    assert_allclose(track.time, times, rtol=1e-12)
    assert "its own times are not used" in track.notes[-1]
    with pytest.raises(InputError, match=r"not those of 230 frames a second.* film .* slowly"):
        read(tmp_path, text, unit="m", fps=230.0)


def test_one_stamp_behind_a_second_tells_no_digits(tmp_path: Path):
    times = np.round(np.linspace(0.0, 1.1, 12) + 0.012 * np.sin(np.arange(12)), 2)
    times[-1] = 1.1  # two digits, as all before it have behind the point
    assert_allclose(stamped(tmp_path, times, 2), times, rtol=1e-12)


def test_stamps_that_are_not_even_are_kept(tmp_path: Path):
    rng = np.random.default_rng(5)
    for times in (
        np.arange(80) / 120.0 + rng.normal(0.0, 1e-3, 80), np.cumsum(np.linspace(0.2, 0.4, 9)),
        np.arange(40) / 50.0, np.arange(5) / 60.0,
    ):  # fmt: skip
        rounded = np.round(np.sort(times), 3)
        assert_allclose(stamped(tmp_path, rounded, 3), rounded, rtol=1e-12)


@pytest.mark.thorough
def test_many_rows_are_read_block_by_block_as_few_are(tmp_path: Path):
    rng = np.random.default_rng(5)
    data = np.column_stack([np.arange(250_000) / 1000.0, rng.normal(size=(250_000, 2))])
    rows = [f"{t!r};{x!r};{y!r}".replace(".", ",") for t, x, y in data.tolist()]
    rows[200_000] = rows[200_000].split(";")[0] + ";;"  # one gap, in a block of its own
    rows[240_000] += "  "
    (track,) = read(tmp_path, "\n".join(["t;x [m];y [m]", *rows]))
    lost = np.flatnonzero(~track.seen).tolist()
    assert lost == [200_000]
    keep = np.arange(250_000) != 200_000
    assert np.array_equal(track.time, data[:, 0])
    assert np.array_equal(track.place[keep], data[keep, 1:])


BAD = {
    "": "is empty", "\n\n": "no rows of numbers", "hello\nworld\n": "no table of numbers",
    "hello,world\na,b\n": "no (table|rows) of numbers",
    "t,x,y\n0,1,2\n.2,3,4\n.1,1,2\n": "time must increase, but frame 3",
    "t,x,y\n0,1,2\n.2,3,4\n.2,1,2\n": "time must increase, but frame 3",
    "t,x,y\n0,1,2\n": "two frames", "t,x,y\n0,,\n1,,\n": "two frames.*here are 0",
    "t,x,y\n0,a,2\n1,b,3\n": "line 2, column 2: 'a' is no number",
    "t,x,y\n0,1,2\n1,2\n1.1,3,4\n": "line 3: 2 cells where other rows have 3",
    "t,x,y\n0,1,2\n1,2,3,4\n1.1,2,3\n": "line 3: 4 cells where other rows have 3",
    "t,x,y\n0,1,0,2,0,3\n0,2,1,2,2,3\n": "commas separate and are decimal marks",
    "t;x;y\n0,1;1.234,5;2\n0,2;2;3\n": "'1.234,5' has a thousands separator",
    't,x,y\n0,"1,000.5",2\n1,"1,001.5",3\n': "'1,000.5' has a thousands separator",
    "t;x;y\n0;1'000;2\n1;1'001;3\n": "\"1'000\" has a thousands separator",
    "t\tx\ty\n0.5\t1,000\t2\n1.5\t1,001\t3\n": "no thousands",
    "t,x,y\n0,1,2\n,2,3\n": "has no time: give it one, or leave its place empty",
    "t,x,y\n0,1,2\n8.3,2,3\n16.7,3,3\n": "unit of its times",
    "t,x,h\n0,1,2\n.1,2,3\n": "x without its y.*with - for what else",
    "t,x1,y1,x2\n0,1,2,3\n.1,2,3,4\n": "x of 2 without its y",
    "a,b,c\n0,1,3\n.1,2,4\n": "no columns x and y .*they are a, b, c",
    "x,y,t\n1,0,1,2\n2,.1,1,2\n": "3 names for 4 columns",
    "0,1,3\n.1,2,4\n": "has no header.*columns='t,x,y'",
    "x,y\n0,1\n1,2\n": "fps.*each row is then a frame",
    "frame,x,y\n0,1,2\n1,2,3\n": "frame numbers and no times.*fps",
    "t,x [cm],y [cm]\n0,1,2\n.1,1,2\n": "leave unit = 'm' out",
    "t,x [cm],y\n0,1,2\n.1,1,2\n": r"columns x and y are not all in one unit \(none said, cm\)",
    "t,x [cm],y [px]\n0,1,2\n.1,1,2\n": "not all in one unit",
    "t,x [furlong],y [furlong]\n0,1,2\n.1,1,2\n": "'furlong' is not known",
    "t,x_px,y_px\n0,1,2\n.1,2,3\n": "in pixels: give (the size|scale)",
    "t,x,y\n0,1e400,2\n.1,2,3\n": "of frame 1 is infinite",
    "t,x,y,visible\n0,1,2,1\n.1,2,3,7\n": "must be 0 or 1",
    "t,x,y,visible\n0,1,2,yes\n.1,2,3,perhaps\n": "'perhaps' does not say",
    "t,x,y,confidence\n0,1,2,95\n.1,2,3,90\n": "likelihoods of up to 95",
    "t,x,y,own_angle_rad,whole_angle_rad\n0,1,2,4,5\n.1,2,3,5,6\n": "several columns",
    "t_shutter,t_stored,x,y\n0,1,2,4\n.1,2,3,5\n": "two columns of time",
    "t,x1,y1,x2,y2,angle_deg\n0,1,2,3,4,5\n.1,1,2,3,4,5\n": "whose they are",
}  # fmt: skip


@pytest.mark.parametrize("text", BAD)
def test_what_is_wrong_is_said_in_a_sentence(tmp_path: Path, text: str):
    with pytest.raises(InputError, match=BAD[text]) as refused:
        read(tmp_path, text, unit="m")
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    ("how", "words"),
    [
        ({}, "does not say the unit of x and y"), ({"unit": "px"}, "size of a pixel"),
        ({"unit": "cms"}, "did you mean 'cm'"), ({"unit": 3}, "unit = 3"),
        ({"scale": 0}, "greater than 0"), ({"scale": "-1mm"}, "greater than 0"),
        ({"scale": "0.5"}, "a number and a unit"), ({"scale": "2px"}, "a length, not pixels"),
        ({"scale": "1mm", "unit": "cm"}, "leave unit = 'cm' out"), ({"fps": 0}, "fps"),
        ({"fps": math.nan}, "fps"), ({"fps": 3, "unit": "m"}, "leave fps"),
        ({"unit": "m", "columns": "t,x"}, "has 3 columns, and columns names 2"),
        ({"unit": "m", "pucks": "red"}, "no puck 'red'"),
        ({"unit": "m", "likelihood": 0.5}, "no likelihoods"), ({"likelihood": 2}, "0 to 1"),
        ({"unit": "m", "toward": "a"}, "needs centre"), ({"unit": "m", "pucks": ""}, "with commas"),
        ({"unit": "m", "pucks": 5}, "pucks must be"), ({"y_down": "no"}, "y_down must be"),
        ({"columns": 3}, "columns must be"), ({"angle_unit": "m"}, "angle_unit = 'm'"),
    ],
)  # fmt: skip
def test_what_is_asked_wrongly_is_said(tmp_path: Path, how: dict, words: str):
    with pytest.raises(InputError, match=words):
        read(tmp_path, "t,x,y\n0,1,2\n0.1,2,3\n", **how)


def test_all_that_a_file_leaves_open_is_asked_at_once(tmp_path: Path):
    with pytest.raises(InputError, match=r"--unit cm.*; give .*-unit deg.* and .*--fps 120.*, too"):
        read(tmp_path, "x,y,theta\n1,2,3\n2,3,4\n")


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"\x80\x04\x95abc", "a pickle"), (bytes(range(256)) * 20, "binary"),
        (b"\x00" * 100, "binary"), (b"\x1f\x8b\x08junk", "unpack"), (b"PAR1....", "Parquet"),
        (b'{"x": 1}', "JSON"), (b'{"x": [', "JSON"),
        (b'{"columns": {"time": {"values": [1]}, "x": {}, "y": {}}}', "JSON"),
        (b'{"time": [], "x": 1, "y": 2}', "JSON"), (b'{"a": ' * 9999, "JSON"), (b"[1]", "JSON"),
        (b"\x89PNG\r\n", "a picture"), (b"<html>", "a web page"), (b"\0\0\0\x18ftypmp42", "a film"),
        (b"x" * 300_000, "no table"),
    ],
)  # fmt: skip
def test_files_that_are_no_tables_are_named(tmp_path: Path, content: bytes, words: str):
    with pytest.raises(InputError, match=words):
        read(tmp_path, content)


def test_what_cannot_be_opened_is_said(tmp_path: Path):
    for path, words in ((tmp_path, "name a file in it"), (tmp_path / "no.csv", "No such file")):
        with pytest.raises(InputError, match=words):
            read_tracks(path)
    with pytest.raises(InputError, match="path must be"):
        read_tracks(3)  # type: ignore[arg-type]


@pytest.mark.parametrize("seed", range(6))
def test_a_place_on_a_line_is_a_track(tmp_path: Path, seed: int):
    rng = np.random.default_rng([35, 9, seed])
    name = rng.choice(["x", "position", "x_pos", "Displacement", "distance", "y"])
    unit, size = [("mm", 1e-3), ("cm", 1e-2), ("m", 1.0)][seed % 3]
    place, time = rng.uniform(-9.0, 9.0, 8).round(3), np.arange(8) / 50.0
    beside = rng.permutation(["v", "vx", "speed", "acceleration"])[: rng.integers(0, 3)].tolist()
    header = [f"{name} [{unit}]", "t [s]", *beside]
    rows = [[x, t, *rng.normal(size=len(beside))] for x, t in zip(place, time, strict=True)]
    text = "\n".join(",".join(map(str, row)) for row in [header, *rows])
    (track,) = read(tmp_path, text)
    along = 1 if name == "y" else 0
    np.testing.assert_allclose(track.place[:, along], size * place, rtol=1e-12)
    assert not track.place[:, 1 - along].any()
    assert any("along one line" in note for note in track.notes)


@pytest.mark.parametrize("seed", range(4))
def test_stamps_of_a_clock_count_from_the_first_frame(tmp_path: Path, seed: int):
    rng = np.random.default_rng([35, 10, seed])
    first = [1718117925.836, 1.7e12 + 5.0, 86012.5, -4.0e6][seed]
    unit, size = ("ms", 1e-3) if first > 1e12 else ("s", 1.0)
    steps = np.concatenate([[0.0], np.cumsum(rng.uniform(2e-3, 6e-3, 20))]).tolist()
    rows = [f"{first + t / size!r},{t},{t}" for t in steps]
    (track,) = read(tmp_path, f"t [{unit}],x [m],y [m]\n" + "\n".join(rows))
    assert track.time[0] == 0.0
    np.testing.assert_allclose(track.time, steps, atol=1e-6)
    assert any("times from its first frame on" in note for note in track.notes)
    (plain,) = read(tmp_path, "t [s],x [m],y [m]\n" + "\n".join(f"{3 + t},{t},{t}" for t in steps))
    assert plain.time[0] == 3.0


@pytest.mark.parametrize("seed", range(12))
def test_a_factor_or_a_function_in_a_heading_of_tracks_is_refused(seed: int, tmp_path: Path):
    rng = np.random.default_rng([36, seed])
    altered = [
        "{} (10^-3 {})", "{} (10 {})", "{} (1e-3 {})", "{}/2r [{}]", "log {} [{}]", "{}^2 ({})",
        "{} (x10 {})",
    ]  # fmt: skip
    heads, at = ["t (s)", "x (cm)", "y (cm)"], int(rng.integers(3))
    name, unit = heads[at].replace(")", "").split(" (")
    heads[at] = altered[rng.integers(len(altered))].format(name, unit)
    path = tmp_path / "a.csv"
    path.write_text(",".join(heads) + "\n0,1,2\n0.1,1.5,2.5\n0.2,1.9,3\n")
    with pytest.raises(InputError, match="stands in its heading"):
        read_tracks(path)

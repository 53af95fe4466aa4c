"""Files as laboratories, robots and phones write them: each kind is written here, and read back.

One motion, drawn, is written in each form, with the decimals, units and separators that such files
have, and what is read must be it to the last digit written.
"""

from __future__ import annotations

import json
import warnings
import zipfile
from collections.abc import Callable
from pathlib import Path
from xml.sax.saxutils import escape

import numpy as np
import pytest

from puck_tables import InputError, Track, read_tracks

FPS = 100.0
FRAMES = 30
Motion = tuple[np.ndarray, np.ndarray, np.ndarray]  # time (n,), places (n, 2) m, angle (n,) rad


@pytest.fixture
def motion() -> Motion:
    rng = np.random.default_rng(7)
    t = np.arange(FRAMES) / FPS
    place = np.stack([0.4 + 0.9 * t - 0.7 * t**2, -0.2 + 0.3 * t + 0.1 * t**2], axis=1)
    return t, place + rng.normal(0.0, 3e-4, place.shape), -0.4 + 9.0 * t - 2.0 * t**2


def lines(path: Path, *rows: str) -> Path:
    path.write_text("\n".join(rows) + "\n", encoding="utf-8")
    return path


def table(path: Path, head: str, columns, sign: str = ",", digits: int = 6, comma=False) -> Path:
    rows = [sign.join(f"{v:.{digits}f}" for v in row) for row in np.column_stack(columns)]
    return lines(path, head, *((row.replace(".", ",") if comma else row) for row in rows))


def mark(place: np.ndarray, angle: np.ndarray, r: float = 0.03) -> np.ndarray:
    return place + r * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def quaternion(angle: np.ndarray) -> np.ndarray:
    return np.stack([0 * angle, 0 * angle, np.sin(angle / 2), np.cos(angle / 2)], axis=1)


def check(track: Track, motion: Motion, places=True, angles=False, digits=1e-5, at=0.0) -> None:
    t, place, angle = motion
    np.testing.assert_allclose(track.time - track.time[0], t - t[0], rtol=0, atol=2e-6)
    if places:
        np.testing.assert_allclose(track.place, place + at, rtol=0, atol=digits)
    if angles:
        assert track.angle is not None
        apart = (track.angle - angle + np.pi) % (2.0 * np.pi) - np.pi
        np.testing.assert_allclose(apart, 0.0, atol=2e-3)
    else:
        assert track.angle is None


def space(place: np.ndarray, height: float = 0.012) -> np.ndarray:
    return np.column_stack([place, np.full(len(place), height)])


@pytest.mark.parametrize("form", ["2.0.0", "old", "named columns"])
def test_qualisys_marks_of_two_pucks(tmp_path: Path, motion: Motion, form: str):
    t, place, angle = motion
    marks = [place + 0.5, mark(place + 0.5, angle), place, mark(place, angle)]
    head = ["FILE_VERSION\t2.0.0"] if form == "2.0.0" else []
    head += [f"NO_OF_FRAMES\t{FRAMES}", "NO_OF_CAMERAS\t2", "NO_OF_MARKERS\t4", "FREQUENCY\t100",
             "DESCRIPTION\t--", "TIME_STAMP\t2025-11-16, 10:55:38.071\t215525.6",
             "DATA_INCLUDED\t3D", "MARKER_NAMES\tcm2\ted2\tcm1\ted1"]  # fmt: skip
    columns = [1e3 * space(one) for one in marks]
    if form == "named columns":
        names = [f"{m} {a}" for m in ("cm2", "ed2", "cm1", "ed1") for a in "XYZ"]
        head.append("\t".join(["Frame", "Time", *names]))
        columns = [np.arange(1.0, FRAMES + 1), t, *columns]
    rows = np.column_stack(columns)
    rows[3, -12:-9] = 0.0  # the centre of puck 2 is not seen
    body = ["\t".join(f"{v:.3f}" for v in row) for row in rows]
    if form == "named columns":
        body = ["\t".join([f"{n + 1}", *row.split("\t")[1:]]) for n, row in enumerate(body)]
    file = lines(tmp_path / "a.tsv", *head, *body)
    with pytest.raises(InputError, match="--centre cm --toward ed"):
        read_tracks(file)
    one, two = read_tracks(file, centre="cm", toward="ed")
    assert [one.name, two.name] == ["a.tsv: 1", "a.tsv: 2"]
    check(one, motion, angles=True, digits=6e-7)
    assert np.flatnonzero(~two.seen).tolist() == [3]
    lone = read_tracks(file, centre="cm2", toward="ed2")[0]
    np.testing.assert_array_equal(lone.place, two.place)


def test_qualisys_bodies(tmp_path: Path, motion: Motion):
    t, place, angle = motion
    turned = np.degrees((angle + np.pi) % (2 * np.pi) - np.pi)
    rows = np.column_stack([1e3 * space(place), 0 * t, 0 * t, turned, np.tile(0.0, (FRAMES, 10))])
    body = ["\t".join(f"{v:.4f}" for v in row) for row in rows]
    head = ["NO_OF_FRAMES\t30", "NO_OF_BODIES\t1", "FREQUENCY\t100", "BODY_NAMES\tpuck"]
    check(read_tracks(lines(tmp_path / "a.tsv", *head, *body))[0], motion, angles=True)


@pytest.mark.parametrize("sign", [",", ";"])
def test_vicon_trajectories(tmp_path: Path, motion: Motion, sign: str):
    _, place, angle = motion
    columns = np.column_stack([1e3 * space(place), 1e3 * space(mark(place, angle))])
    body = [f"{n + 101},0," + ",".join(f"{v:.4f}" for v in row) for n, row in enumerate(columns)]
    head = ["Trajectories", "100", ",,Puck:hub,,,Puck:rim,,", "Frame,Sub Frame,X,Y,Z,X,Y,Z",
            ",,mm,mm,mm,mm,mm,mm"]  # fmt: skip
    rows = [row.replace(",", sign) for row in [*head, *body, "", "Devices", "1000"]]
    check(read_tracks(lines(tmp_path / "a.csv", *rows), centre="hub", toward="rim")[0],
          motion, angles=True, digits=1e-7)  # fmt: skip


@pytest.mark.parametrize("kind", ["Rigid Body", "Marker"])
@pytest.mark.parametrize("unit", ["Meters", "Millimeters"])
def test_optitrack_takes(tmp_path: Path, motion: Motion, kind: str, unit: str):
    t, place, angle = motion
    size = 1.0 if unit == "Meters" else 1e3
    # y points up there: x, height, -y
    at = size * np.column_stack([place[:, 0], 0.011 + 0 * t, -place[:, 1]])
    turn = np.column_stack([0 * t, np.sin(angle / 2), 0 * t, np.cos(angle / 2)])
    if kind == "Rigid Body":
        columns, n = [turn, at], ("Rotation",) * 4 + ("Position",) * 3
        axes, name = "X,Y,Z,W,X,Y,Z", "Puck"
    else:
        columns, n, axes, name = [at], ("Position",) * 3, "X,Y,Z", "Unlabeled 7"
    head = [f"Format Version,1.23,Take Name,a,Capture Frame Rate,100.000000,Rotation Type,"
            f"Quaternion,Length Units,{unit},Coordinate Space,Global", "",
            ",," + ",".join([kind] * len(n)), ",," + ",".join([name] * len(n)),
            ",," + ",".join(["3:4"] * len(n)), ",," + ",".join(n),
            f"Frame,Time (Seconds),{axes}"]  # fmt: skip
    rows = np.column_stack([t, *columns])
    body = [f"{k}," + ",".join(f"{v:.6f}" for v in row) for k, row in enumerate(rows)]
    track = read_tracks(lines(tmp_path / "a.csv", *head, *body))[0]
    check(track, motion, angles=kind == "Rigid Body", digits=1e-6)


def test_track_row_columns(tmp_path: Path, motion: Motion):
    t, place, _ = motion
    rows = 1e3 * np.column_stack([place[:, 0], 0.01 + 0 * t, -place[:, 1]])
    head = ["PathFileType\t4\t(X/Y/Z)\ta.trc", "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits",
            "100.00\t100.00\t30\t1\tmm", "Frame#\tTime\tpuck\t\t",
            "\t\tX1\tY1\tZ1", ""]  # fmt: skip
    body = [f"{n + 1}\t{a:.5f}\t" + "\t".join(f"{v:.5f}" for v in row)
            for n, (a, row) in enumerate(zip(t, rows, strict=True))]  # fmt: skip
    check(read_tracks(lines(tmp_path / "a.trc", *head, *body))[0], motion)


def test_c3d(tmp_path: Path, motion: Motion):
    c3d = pytest.importorskip("c3d")
    _, place, angle = motion
    writer = c3d.Writer(point_rate=FPS, point_scale=-1.0)
    for one, two in zip(1e3 * space(place), 1e3 * space(mark(place, angle)), strict=True):
        rows = np.zeros((2, 5), np.float32)
        rows[0, :3], rows[1, :3] = one, two
        writer.add_frames([(rows, np.array([[]]))])
    writer.set_point_labels(["hub", "rim"])
    with open(tmp_path / "a.c3d", "wb") as file, warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of parts that this file does not have
        writer.write(file)
    how = {} if read_unit(tmp_path / "a.c3d") else {"unit": "mm"}
    track = read_tracks(tmp_path / "a.c3d", centre="hub", toward="rim", **how)[0]
    check(track, motion, angles=True, digits=1e-6)
    (tmp_path / "b.c3d").write_bytes((tmp_path / "a.c3d").read_bytes()[:900])
    with pytest.raises(InputError, match="damaged C3D"):
        read_tracks(tmp_path / "b.c3d")


def read_unit(file: Path) -> bool:
    try:
        read_tracks(file, centre="hub", toward="rim")
    except InputError as error:
        assert "--unit" in str(error)
        return False
    return True


@pytest.mark.parametrize("name", ["disk_id", "stone", "ball_id", "label", "body", "Track n°"])
def test_any_identity_column(tmp_path: Path, motion: Motion, name: str):
    _, place, _ = motion
    rows = [f"{n},{who},{1e3 * x + 500 * k:.4f},{1e3 * y:.4f}" for n, (x, y) in enumerate(place)
            for k, who in enumerate(("7", "9"))]  # fmt: skip
    file = lines(tmp_path / "a.csv", f"frame,{name},x_mm,y_mm", *rows)
    one, two = read_tracks(file, fps=100.0)
    assert (one.name, two.name) == ("a.csv: 7", "a.csv: 9")
    check(one, motion)
    check(two, motion, at=np.array([0.5, 0.0]))


def test_a_centre_and_a_mark_row_by_row(tmp_path: Path, motion: Motion):
    t, place, angle = motion
    columns = [np.arange(FRAMES), 3 + 0 * t, 1e3 * place, 1e3 * mark(place, angle), 54 + t]
    file = table(tmp_path / "a.csv", "frame,disk_id,cx_mm,cy_mm,mx_mm,my_mm,r_px", columns)
    with pytest.raises(InputError, match="--fps"):
        read_tracks(file)
    with pytest.raises(InputError, match="--centre c --toward m"):
        read_tracks(file, fps=100.0)
    check(read_tracks(file, fps=100.0, centre="c", toward="m")[0], motion, angles=True)


@pytest.mark.parametrize(
    "names", ["qx,qy,qz,qw", "orientation.x,orientation.y,orientation.z,orientation.w",
              "quat_x,quat_y,quat_z,quat_w", "Rot_X,Rot_Y,Rot_Z,Rot_W"],
)  # fmt: skip
def test_quaternions_tell_the_angle_and_the_tilt(tmp_path: Path, motion: Motion, names: str):
    t, place, angle = motion
    q = quaternion(angle)
    tilt = np.array([np.sin(0.02), 0.0, 0.0, np.cos(0.02)])  # by 0.04 rad about x
    q = np.stack([  # first the tilt, then the turn
        q[:, 3] * tilt[0], q[:, 2] * tilt[0], q[:, 2] * tilt[3], q[:, 3] * tilt[3]
    ], axis=1)  # fmt: skip
    columns = [t, place, 0.2 + 0 * t, q]
    file = table(tmp_path / "a.csv", f"Time,Pos_x,Pos_y,Pos_z,{names}", columns, digits=7)
    track = read_tracks(file, unit="m")[0]
    check(track, motion, angles=True, digits=1e-6)
    assert any("tilted by 2.3 degrees" in note for note in track.notes)


@pytest.mark.parametrize("form", ["{} {} {}", "[{}, {}, {}]", "({};{};{})"])
@pytest.mark.parametrize("first", [True, False])
def test_vectors_in_one_cell(tmp_path: Path, motion: Motion, form: str, first: bool):
    t, place, angle = motion
    sign = "," if form.startswith("{") else "\t"
    start = 1714476519.681
    rows = ["RosTime,PositionOfPuck,OrientationOfPuck".replace(",", sign)]
    for a, at, q in zip(t, space(place), quaternion(angle), strict=True):
        q = np.roll(q, 1) if first else q
        turn = " ".join(f"{v:.8f}" for v in q)
        rows.append(sign.join([f"{start + a:.6f}", form.format(*at.round(7)), turn]))
    track = read_tracks(lines(tmp_path / "a.csv", *rows), unit="m")[0]
    check(track, motion, angles=True)
    assert any("since 1970" in note for note in track.notes)


@pytest.mark.parametrize("form", ["rostopic echo -p", "bagpy", "PlotJuggler", "ros2"])
def test_tables_of_ros(tmp_path: Path, motion: Motion, form: str):
    t, place, angle = motion
    columns = [*space(place).T, *quaternion(angle).T]
    stamps = 1_600_000_000_000_000_000 + np.round(t * 1e9).astype(np.int64)
    axes = [f"position.{a}" for a in "xyz"] + [f"orientation.{a}" for a in "xyzw"]
    cells = [",".join(f"{c[n]:.7f}" for c in columns) for n in range(FRAMES)]
    if form == "rostopic echo -p":
        head = "%time,field.header.seq,field.header.stamp,field.header.frame_id," + ",".join(
            f"field.pose.{a}" for a in axes
        )
        rows = [f"{s + 31_000_000 + 7_000_000 * (n % 3)},{n},{s},world,{c}"
                for n, (s, c) in enumerate(zip(stamps, cells, strict=True))]  # fmt: skip
    elif form == "bagpy":
        head = "Time,header.seq,header.stamp.secs,header.stamp.nsecs,header.frame_id," + ",".join(
            f"pose.{a}" for a in axes
        )
        rows = [f"{s / 1e9 + 0.03:.6f},{n},{s // 10**9},{s % 10**9},world,{c}"
                for n, (s, c) in enumerate(zip(stamps, cells, strict=True))]  # fmt: skip
    elif form == "PlotJuggler":
        head = "__time," + ",".join(f"/mocap/puck/pose/{a.replace('.', '/')}" for a in axes)
        rows = [f"{s / 1e9:.6f},{c}" for s, c in zip(stamps, cells, strict=True)]
    else:
        head = "header.stamp.sec,header.stamp.nanosec,child_frame_id," + ",".join(
            f"pose.pose.{a}" for a in axes
        )
        rows = [f"{s // 10**9},{s % 10**9},puck,{c}" for s, c in zip(stamps, cells, strict=True)]
    check(read_tracks(lines(tmp_path / "a.csv", head, *rows))[0], motion, angles=True, digits=1e-7)


@pytest.mark.parametrize("unit", ["s", "ms", "us"])
def test_stamps_tell_their_unit(tmp_path: Path, motion: Motion, unit: str):
    t, place, _ = motion
    size = {"s": 1, "ms": 10**3, "us": 10**6}[unit]
    rows = [
        f"{1.7e9 * size + a * size:.3f},{x:.6f},{y:.6f}" for a, (x, y) in zip(t, place, strict=True)
    ]
    check(read_tracks(lines(tmp_path / "a.csv", "timestamp,x,y", *rows), unit="m")[0], motion)


CONTENT = "<Types xmlns='http://schemas.openxmlformats.org/package/2006/content-types'/>"


def xlsx(path: Path, head: list[str], rows: np.ndarray) -> Path:
    main = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
    body = "".join(
        f"<row r='{n}'>" + "".join(
            f"<c r='{'ABCDEFGH'[k]}{n}'><v>{v!r}</v></c>" for k, v in enumerate(row) if v == v
        ) + "</row>" for n, row in enumerate(rows.tolist(), start=2)
    )  # fmt: skip
    names = "".join(f"<c r='{'ABCDEFGH'[k]}1' t='s'><v>{k}</v></c>" for k in range(len(head)))
    shared = "".join(f"<si><t>{escape(one)}</t></si>" for one in head)
    with zipfile.ZipFile(path, "w") as file:
        file.writestr("[Content_Types].xml", CONTENT)
        file.writestr("xl/sharedStrings.xml", f"<sst xmlns='{main}'>{shared}</sst>")
        file.writestr("xl/worksheets/sheet1.xml", f"<worksheet xmlns='{main}'><sheetData>"
                      f"<row r='1'>{names}</row>{body}</sheetData></worksheet>")  # fmt: skip
    return path


def ods(path: Path, head: list[str], rows: np.ndarray) -> Path:
    spaces = " ".join(f"xmlns:{a}='urn:oasis:names:tc:opendocument:xmlns:{a}:1.0'"
                      for a in ("office", "table", "text"))  # fmt: skip
    first = "".join(f"<table:table-cell office:value-type='string'><text:p>{escape(one)}</text:p>"
                    "</table:table-cell>" for one in head)  # fmt: skip
    gap = "<table:table-cell/>"
    body = "".join("<table:table-row>" + "".join(
        gap if v != v else f"<table:table-cell office:value-type='float' office:value='{v!r}'>"
        f"<text:p>{str(round(v, 2)).replace('.', ',')}</text:p></table:table-cell>" for v in row
    ) + "</table:table-row>" for row in rows.tolist())  # fmt: skip
    empty = "<table:table-row table:number-rows-repeated='1048000'><table:table-cell "
    empty += "table:number-columns-repeated='1024'/></table:table-row>"
    with zipfile.ZipFile(path, "w") as file:
        file.writestr("mimetype", "application/vnd.oasis.opendocument.spreadsheet")
        file.writestr("content.xml", f"<office:document-content {spaces}><office:body>"
                      f"<office:spreadsheet><table:table><table:table-row>{first}"
                      f"</table:table-row>{body}{empty}</table:table></office:spreadsheet>"
                      "</office:body></office:document-content>")  # fmt: skip
    return path


@pytest.mark.parametrize("write", [xlsx, ods])
def test_spreadsheets(tmp_path: Path, motion: Motion, write: Callable[..., Path]):
    t, place, _ = motion
    rows = np.column_stack([t, 1e2 * place])
    rows[4, 1] = np.nan
    file = write(tmp_path / f"a.{write.__name__}", ["Time (s)", "x (cm)", "y (cm)"], rows)
    track = read_tracks(file)[0]
    assert np.flatnonzero(~track.seen).tolist() == [4]
    keep = np.arange(FRAMES) != 4
    np.testing.assert_allclose(track.place[keep], place[keep], rtol=0, atol=1e-15)
    assert len(read_tracks(file, columns="t [s],x [mm],y [mm]")) == 1
    file.write_bytes(file.read_bytes()[:-40])
    with pytest.raises(InputError, match="damaged spreadsheet"):
        read_tracks(file)


LINE = {
    "t, s": ("t,s", {"unit": "m"}), "with units": ("t (s),s (m)", {}),
    "PASCO": ("Time (s) Run #1,Position (m) Run #1", {}),
    "Logger Pro": ("Latest: Time (s),Latest: Position (m)", {}),
    "Graphical Analysis": ("Data Set 1:Time(s),Data Set 1:Position(m)", {}),
    "German": ("Zeit (s),Weg (m)", {}), "Spanish": ("Tiempo (s),Posición (m)", {}),
    "French": ("Temps (s),Distance (m)", {}), "Portuguese": ("Tempo (s),Posição (m)", {}),
    "Russian": ("Время (с),Положение (м)", {}),
}  # fmt: skip


@pytest.mark.parametrize("case", LINE)
@pytest.mark.parametrize("more", [False, True])
def test_positions_along_one_line(tmp_path: Path, motion: Motion, case: str, more: bool):
    t, place, _ = motion
    head, how = LINE[case]
    columns = [t, place[:, 0]]
    if more:
        head += f",{'Velocity (m/s)' if 'PASCO' not in case else 'Velocity (m/s) Run #1'}"
        columns.append(np.gradient(place[:, 0], t))
    sign, comma = (";", True) if case in ("German", "French", "Russian") else (",", False)
    file = table(tmp_path / "a.csv", head.replace(",", sign), columns, sign, 6, comma)
    track = read_tracks(file, **how)[0]
    check(track, (t, np.column_stack([place[:, 0], 0 * t]), t), digits=6e-7)
    assert any("along one line" in note for note in track.notes)


def test_two_runs_along_a_line_side_by_side(tmp_path: Path, motion: Motion):
    t, place, _ = motion
    head = "Run 1: Time (s),Run 1: Position (m),Run 2: Time (s),Run 2: Position (m)"
    file = table(tmp_path / "a.csv", head, [t, place[:, 0], t, place[:, 1]])
    one, two = read_tracks(file)
    np.testing.assert_allclose(one.place[:, 0], place[:, 0], atol=6e-7)
    np.testing.assert_allclose(two.place[:, 0], place[:, 1], atol=6e-7)


def test_text_of_logger_pro(tmp_path: Path, motion: Motion):
    t, place, _ = motion
    rows = [f"{a:.4f}\t{1e2 * x:.4f}\t{1e2 * y:.4f}" for a, (x, y) in zip(t, place, strict=True)]
    head = ["Vernier Format 2", "a.cmbl 5/5/2019 9:37:43 .", "Data Set", "Time\tX\tY", "t\tx\ty",
            "s\tcm\tcm", ""]  # fmt: skip
    check(read_tracks(lines(tmp_path / "a.txt", *head, *rows))[0], motion, digits=1e-6)


TONGUES = {
    "es": "tiempo (s);x (cm);y (cm);ángulo (grados)", "de": "Zeit in s;x in cm;y in cm;Winkel in °",
    "fr": "temps (secondes);x (cm);y (cm);angle (degrés)",
    "pt": "tempo (s);posição x (cm);posição y (cm);ângulo (graus)",
    "ru": "время, с;х, см;у, см;угол, град",
}  # fmt: skip


@pytest.mark.parametrize("tongue", TONGUES)
@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
def test_headings_in_other_tongues(tmp_path: Path, motion: Motion, tongue: str, encoding: str):
    t, place, angle = motion
    columns = [t, 1e2 * place, np.degrees(angle)]
    file = table(tmp_path / "a.csv", TONGUES[tongue], columns, ";", 4, comma=True)
    file.write_bytes(file.read_text("utf-8").encode(encoding))
    check(read_tracks(file)[0], motion, angles=True, digits=1e-6)


@pytest.mark.parametrize(
    ("head", "size"), [("t [s],vx [m/s],vy [m/s]", 1.0), ("t [s],v_x [cm/s],v_y [cm/s]", 1e2),
                       ("Time (s),Velocity x (mm/s),Velocity y (mm/s)", 1e3)],
)  # fmt: skip
def test_velocities_without_places_are_summed(tmp_path: Path, motion: Motion, head, size):
    t = motion[0]
    velocity = np.stack([0.9 - 1.4 * t, 0.3 + 0.2 * t], axis=1)
    file = table(tmp_path / "a.csv", head, [t, size * velocity], digits=7)
    track = read_tracks(file)[0]
    place = np.stack([0.9 * t - 0.7 * t**2, 0.3 * t + 0.1 * t**2], axis=1)
    check(track, (t, place, t), digits=1e-6)  # a straight line's sum is exact
    assert any("summed from velocities" in note for note in track.notes)


def test_a_scale_bar_in_the_picture(tmp_path: Path, motion: Motion):
    t, place, _ = motion
    pixels = place / 0.3 * 240.0 * [1, -1]
    file = table(tmp_path / "a.csv", "t [s],x [px],y [px]", [t, pixels])
    with pytest.raises(InputError, match="--scale"):
        read_tracks(file)
    check(read_tracks(file, scale="240px = 30cm")[0], motion)
    with pytest.raises(InputError, match="scale must be"):
        read_tracks(file, scale="0px = 30cm")


@pytest.mark.parametrize("app", ["phyphox", "Sensor Logger", "Physics Toolbox", "omega"])
def test_a_gyroscope_tells_spin_over_time(tmp_path: Path, app: str):
    t = np.arange(200) / 200.0
    spin = 12.0 - 8.0 * t
    zero = 0 * t
    name, head, columns = {
        "phyphox": ("raw.csv", '"Time (s)","Gyroscope x (rad/s)","Gyroscope y (rad/s)",'
                    '"Gyroscope z (rad/s)","Absolute (rad/s)"', [t, zero, zero, spin, spin]),
        "Sensor Logger": ("Gyroscope.csv", "time,seconds_elapsed,z,y,x",
                          [1e9 * t + 1.7e18, t, spin, zero, zero]),
        "Physics Toolbox": ("a.csv", "time,wx,wy,wz", [t, zero, zero, spin]),
        "omega": ("a.csv", "t [s],omega [deg/s]", [t, np.degrees(spin)]),
    }[app]  # fmt: skip
    how = {"angle_unit": "rad"} if app == "Physics Toolbox" else {}
    track = read_tracks(table(tmp_path / name, head, columns), **how)[0]
    np.testing.assert_allclose(track.angle, 12.0 * t - 4.0 * t**2, atol=1e-4)
    assert (track.place == 0.0).all()
    assert any("spin in place" in note for note in track.notes)


REFUSED = {
    "phyphox": ("a.csv", '"Time (s)","Linear Acceleration x (m/s^2)","Linear Acceleration y '
                '(m/s^2)","Linear Acceleration z (m/s^2)"\n0,1,2,9\n0.1,1,2,9\n', "gyroscope"),
    "Sensor Logger": ("Accelerometer.csv", "time,seconds_elapsed,z,y,x\n1,0,9,0,0\n2,1,9,0,0\n",
                      "accelerations"),
    "another sensor": ("Magnetometer.csv", "time,seconds_elapsed,z,y,x\n1,0,9,0,0\n2,1,9,0,0\n",
                       "Gyroscope.csv"),
    "ax, ay": ("a.csv", "t,ax,ay\n0,1,2\n1,1,2\n", "tell no place"),
    "up and down": ("a.csv", "t,x,y,z\n0,1,0.01,1\n1,2,0.01,2\n2,3,0.01,3\n", "--up y"),
    "2D of Qualisys": ("a.tsv", "NO_OF_FRAMES\t2\nDATA_INCLUDED\t2D\nMARKER_NAMES\ta\n1\t2\n1\t2\n",
                       "3D"),
    "no names": ("a.tsv", "NO_OF_FRAMES\t2\nFREQUENCY\t100\n1\t2\t3\n1\t2\t3\n", "header"),
    "Euler": ("a.csv", "Format Version,1.2,Rotation Type,XYZ,Length Units,Meters\n\n,,Rigid Body\n"
              ",,a\n,,1\n,,Rotation\nFrame,Time (Seconds),X\n0,0,1\n1,1,1\n", "Quaternion"),
    "no vicon": ("a.csv", "Devices\n100\nFrame,Sub Frame,X\n1,0,2\n2,0,2\n", "Trajectories"),
}  # fmt: skip


@pytest.mark.parametrize("case", REFUSED)
def test_what_tells_no_track_is_refused_with_what_does(tmp_path: Path, case: str):
    name, text, words = REFUSED[case]
    (tmp_path / name).write_text(text)
    with pytest.raises(InputError, match=words):
        read_tracks(tmp_path / name, unit="m")


def test_another_axis_up(tmp_path: Path, motion: Motion):
    t, place, _ = motion
    columns = [t, place[:, 0], 0.01 + 0 * t, -place[:, 1]]
    file = table(tmp_path / "a.csv", "t [s],x [m],y [m],z [m]", columns)
    with pytest.raises(InputError, match="--up y"):
        read_tracks(file)
    check(read_tracks(file, up="y")[0], motion)
    with pytest.raises(InputError, match="x, y or z"):
        read_tracks(file, up="w")


OTHERS = {
    "SSL-Vision": (
        "t_capture,camera_id,robot_id,x_mm,y_mm,orientation [rad]", [0, -1, 4, "mm"], True
    ),
    "ImageJ MTrackJ": (
        "Nr,TID,PID,t [sec],x [mm],y [mm],I [val]", [-1, -1, -1, 0, "mm", -1], False
    ),
    "idtracker.ai": ("time,x1 [cm],y1 [cm]", [0, "cm"], False),
    "robot": ("Timestamp (ms),pos_x (m),pos_y (m),heading_deg", ["ms", "m", -1], False),
}  # fmt: skip


@pytest.mark.parametrize("case", OTHERS)
def test_other_programs(tmp_path: Path, motion: Motion, case: str):
    t, place, angle = motion
    head, what, angled = OTHERS[case]
    sizes = {"mm": 1e3, "cm": 1e2, "m": 1.0}
    columns = []
    for one in what:
        if one in sizes:
            columns.append(sizes[one] * place)
        else:
            columns.append({0: t, "ms": 1e3 * t, -1: 0 * t + 1, 4: 0 * t + 4}[one])
    if angled:
        columns.append(angle)
    file = table(tmp_path / "a.csv", head, columns)
    check(read_tracks(file)[0], motion, angles=angled)


def test_trajectories_of_kinovea(tmp_path: Path, motion: Motion):
    t, place, _ = motion  # a hundred frames a second: hundredths are exact
    rows = [f"0:00:{int(a):02d}:{round(a * 100) % 100:02d} {100 * x:.4f} {100 * y:.4f} "
            for a, (x, y) in zip(t, place, strict=True)]  # fmt: skip
    head = ["#Kinovea Trajectory data export", "#T X Y", ""]
    file = lines(tmp_path / "a.txt", *head, *rows, "", *rows[:5], "")
    one, two = read_tracks(file, unit="cm")
    check(one, motion, digits=1e-6)
    assert two.time.size == 5
    with pytest.raises(InputError, match="line 4: 'a 2 3' is no time"):
        read_tracks(lines(tmp_path / "b.txt", *head, "a 2 3"), unit="cm")


def test_numbers_for_times_and_tables_of_kinovea(tmp_path: Path, motion: Motion):
    t, place, _ = motion
    rows = [f"{a:.4f} {100 * x:.4f} {100 * y:.4f}".replace(".", ",")
            for a, (x, y) in zip(t, place, strict=True)]  # fmt: skip
    head = ["#Kinovea Trajectory data export", "#T X Y", "", "# Trajectory 1"]
    file = lines(tmp_path / "a.txt", *head, *rows)
    check(read_tracks(file, unit="cm")[0], motion, digits=1e-6)
    check(read_tracks(file, columns="t [s],x [cm],y [cm]")[0], motion, digits=1e-6)
    names = "Time;Trajectory 1/0/X;Trajectory 1/0/Y"
    table = [row.replace(" ", ";") for row in rows]
    check(read_tracks(lines(tmp_path / "a.csv", names, *table), unit="cm")[0], motion, digits=1e-6)


@pytest.mark.parametrize("form", ["rows", "columns"])
def test_tables_in_json(tmp_path: Path, motion: Motion, form: str):
    t, place, angle = motion
    columns = {"t [s]": t, "x [cm]": 100 * place[:, 0], "y [cm]": 100 * place[:, 1],
               "theta [rad]": angle}  # fmt: skip
    cells = {name: one.tolist() for name, one in columns.items()}
    rows = [dict(zip(cells, row, strict=True)) for row in zip(*cells.values(), strict=True)]
    file = tmp_path / "a.json"
    file.write_text(json.dumps(rows if form == "rows" else cells))
    check(read_tracks(file)[0], motion, angles=True, digits=1e-12)
    file.write_text('{"t": [0, 1], "x": [1]}')
    with pytest.raises(InputError, match="equally long"):
        read_tracks(file)

"""Tracks from the files of Tracker, trackpy, DeepLabCut and SLEAP, and what is refused of them."""

from __future__ import annotations

import io
import math
import pickle
import zipfile
from pathlib import Path

import h5py
import numpy as np
import pytest
from lookalikes import deeplabcut, sleap, trk
from numpy.testing import assert_allclose

from puck_tables import InputError, read_tracks

PIXELS = {"fps": 10.0, "scale": "1mm"}


def saved(folder: Path, name: str, content: str | bytes) -> Path:
    file = folder / name
    file.write_bytes(content if isinstance(content, bytes) else content.encode())
    return file


def archive(members: dict[str, str | bytes]) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as file:
        for name, content in members.items():
            file.writestr(name, content)
    return buffer.getvalue()


def spoiled(content: bytes) -> bytes:
    """The same with bytes in the middle that are others."""
    middle = len(content) // 2
    return content[:middle] + bytes(20) + content[middle + 20 :]


def to_pixels(x: float, y: float, u0: float, v0: float, degrees: float, scale: float):
    """Tracker's way from places to pixels (its ImageCoordSystem): the other way round than ours."""
    cos, sin = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return (scale * cos * x - scale * sin * y + u0, -scale * sin * x - scale * cos * y + v0)


def test_places_in_tracker_stand_along_the_axes_of_their_frame(tmp_path: Path):
    axes = {0: (600.0, 500.0, 30.0, 2000.0), 3: (610.0, 480.0, -20.0, 1900.0)}
    places = {n: (0.1 * n, 0.02 * n * n) for n in (1, 2, 3, 5)}
    marks = {n: to_pixels(*place, *axes[0 if n < 3 else 3]) for n, place in places.items()}
    file = saved(tmp_path, "film.trk", trk({"mass A": marks}, axes, unit="cm", duration=4.0))
    (track,) = read_tracks(file)
    assert track.name == "film.trk: mass A"
    assert_allclose(track.time, [0.004, 0.008, 0.012, 0.016, 0.020])
    assert track.seen.tolist() == [True, True, True, False, True]
    wanted = 0.01 * np.array([places[n] for n in (1, 2, 3, 5)])
    assert_allclose(track.place[track.seen], wanted, rtol=0, atol=1e-12)
    (slow,) = read_tracks(file, fps=1000)  # filmed in slow motion
    assert_allclose(slow.time, [0.001, 0.002, 0.003, 0.004, 0.005])
    assert any("not used" in note for note in slow.notes)


def test_two_masses_are_two_pucks_or_two_marks_of_one(tmp_path: Path):
    axes = {0: (0.0, 0.0, 0.0, 100.0)}
    masses = {"hub": {0: (0.0, 0.0), 2: (100.0, 0.0)}, "rim": {0: (0.0, -10.0), 2: (90.0, 0.0)}}
    file = saved(tmp_path, "two.trk", trk(masses, axes, start=0, step=2, duration=500.0))
    assert [one.name for one in read_tracks(file)] == ["two.trk: hub", "two.trk: rim"]
    (track,) = read_tracks(file, centre="hub", toward="rim")
    assert_allclose(track.time, [0.0, 1.0])
    assert_allclose(track.place, [[0.0, 0.0], [1.0, 0.0]])
    assert_allclose(track.angle, [0.5 * np.pi, np.pi])


def test_without_a_scale_tracker_gives_pixels(tmp_path: Path):
    content = trk({"A": {0: (10.0, 20.0), 1: (30.0, 40.0)}}, {0: (320.0, 240.0, 0.0, 1.0)})
    file = saved(tmp_path, "plain.trk", content)
    with pytest.raises(InputError, match="in pixels: give the size"):
        read_tracks(file)
    (track,) = read_tracks(file, scale="1mm")
    assert_allclose(track.place, [[0.01, -0.02], [0.03, -0.04]])


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
def test_archives_of_tracker_hold_its_files(tmp_path: Path, encoding: str):
    content = trk({"A": {0: (10.0, 20.0), 1: (30.0, 40.0)}}, {0: (0.0, 0.0, 0.0, 10.0)})
    content = content.replace("UTF-8", encoding.upper())
    doctype = '?>\n<!DOCTYPE object SYSTEM "http://www.opensourcephysics.org/doctypes/osp10.dtd">'
    old = content.replace("?>", doctype, 1).encode(encoding)
    files = {"videos/a.mp4": b"\0" * 99, "__MACOSX/._one.trk": b"\0\5", "one.trk": old}
    (track,) = read_tracks(saved(tmp_path, "one.trz", archive(files)))
    assert_allclose(track.place, [[1.0, -2.0], [3.0, -4.0]])
    both = read_tracks(saved(tmp_path, "two.trz", archive({**files, "other.trk": old})))
    assert [track.name for track in both] == ["two.trz: one", "two.trz: other"]


BOMB = (
    '<?xml version="1.0"?><!DOCTYPE lolz [<!ENTITY lol "lol">'
    + "".join(f'<!ENTITY lol{n} "{f"&lol{n - 1 or str()};" * 10}">' for n in range(1, 10))
    + "]><object>&lol9;</object>"
)
GOOD = trk({"A": {0: (1.0, 2.0), 1: (2.0, 3.0)}}, {0: (0.0, 0.0, 0.0, 9.0)})


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("a.trk", BOMB, "entities"), ("a.trk", BOMB.encode("utf-16"), "entities"),
        ("a.trk", GOOD[:-40], "damaged XML"), ("a.xml", "<Tracks/>", "no file of Tracker"),
        ("a.trk", GOOD.replace("TrackerPanel", "TFrame"), "TFrame of Tracker"),
        ("a.trk", GOOD.replace("PointMass", "DynamicParticle"), "no point mass"),
        ("a.trk", GOOD.replace('name="xorigin"', 'name="x_origin"'), "'xorigin' is missing"),
        ("a.trk", GOOD.replace('name="[1]"', 'name="[one]"'), "no number of a frame"),
        ("a.trk", GOOD.replace('name="delta_t"', 'name="dt"'), "give frames a second with fps"),
        ("a.trk", GOOD.replace('name="length_unit"', 'name="unit"'), "unit of x and y"),
        ("a.trk", GOOD.replace('yscale" type="double">9', 'yscale" type="double">8'), "scales"),
        ("a.trz", archive({"a.txt": "x"}), "without a .trk"),
        ("a.trz", archive({"a.trk": GOOD})[:200], "not copied to its end .* Copy it once more"),
        ("a.trz", archive({"a.trk": GOOD})[100:-30], "not copied to its end .* save it again"),
        ("a.trz", spoiled(archive({"a.trk": GOOD})), "a.trk in it cannot be unpacked .* save it"),
        ("a.trz", archive({"a.trk": GOOD[:-40]}), "a.trk is damaged XML .* save it again"),
        ("a.trz", archive({"a.trk": GOOD}).replace(b"\x08\0", b"\x63\0"), "unpack it, and read"),
        ("a.trz", archive({"a.trk": b" " * ((1 << 26) + 1)}), "too large"),
        ("a.xlsx", archive({"xl/workbook.xml": "x"}), "no sheet with numbers"),
        ("a.ods", archive({"content.xml": "x"}), "a damaged spreadsheet"),
    ],
)  # fmt: skip
def test_what_is_wrong_with_files_of_tracker_is_said(tmp_path, name, content, words):
    with pytest.raises(InputError, match=words):
        read_tracks(saved(tmp_path, name, content))


def test_exports_of_tracker(tmp_path: Path):
    one = "mass_A\t\t\nt\tx\ty\n0.000E0\t1.2E1\t-1.3E1\n3.2E-2\t1.1E1\t-1.2E1\n"
    (track,) = read_tracks(saved(tmp_path, "one.txt", one), unit="cm")
    assert track.name == "one.txt: mass_A"
    assert_allclose(track.place, [[0.12, -0.13], [0.11, -0.12]])
    many = (
        "#multi:\n\tmass A\t\t\tmass B\t\t\t\nt\tx\ty\tv_{x}\tx\ty\tθ_{r}\t\n"
        "0,032\t30,47\t23,79\t\t-26,66\t22,55\t1\t\n0,064\t30\t23\t1,5\t-26\t22\t1\t\n"
    )
    a, b = read_tracks(saved(tmp_path, "many.txt", many), unit="cm")
    assert a.name == "many.txt: mass A"
    assert_allclose(a.time, [0.032, 0.064])
    assert_allclose(a.place, [[0.3047, 0.2379], [0.3, 0.23]])
    assert_allclose(b.place, [[-0.2666, 0.2255], [-0.26, 0.22]])


def test_tables_of_trackpy(tmp_path: Path):
    rows = [
        ",x,y,mass,size,ecc,signal,raw_mass,ep,frame,particle",
        "0,10.5,4.25,278.2,2.35,0.12,10.7,6474.0,0.10,3,0.0",
        "1,9.0,5.5,316.2,2.39,0.08,12.3,6711.0,0.06,0,7.0",
        "2,11.5,4.75,278.2,2.35,0.12,10.7,6474.0,0.10,1,0.0",
        "3,9.5,5.75,316.2,2.39,0.08,12.3,6711.0,0.06,1,7.0",
        "4,1.0,1.0,1.0,1.0,0.0,1.0,1.0,0.0,1,",
    ]
    one, two = read_tracks(saved(tmp_path, "tp.csv", "\n".join(rows)), **PIXELS)
    assert (one.name, two.name) == ("tp.csv: 0", "tp.csv: 7")
    assert_allclose(one.time, [0.1, 0.3])
    assert_allclose(one.place, [[0.0115, -0.00475], [0.0105, -0.00425]])
    assert_allclose(two.place, [[0.009, -0.0055], [0.0095, -0.00575]])
    lonely = "\n".join([*rows, "5,1,1,1,1,0,1,1,0,1,9"])
    file = saved(tmp_path, "tp.csv", lonely)
    with pytest.raises(InputError, match=r"tp.csv: 9: .*two frames.*--pucks"):
        read_tracks(file, **PIXELS)
    (chosen,) = read_tracks(file, **PIXELS, pucks=["7"])
    assert chosen.name == "tp.csv: 7"


LABELS = [("DLC", part, role) for part in ("hub", "rim") for role in ("x", "y", "likelihood")]
POSES = np.array([[10, 20, 1, 11, 20, 1], [10, 20, 0.3, 11, 20, 1], [10, 20, 1, 10, 22, 0.9]])


def pose_csv(labels: list[tuple[str, ...]]) -> str:
    names = ["scorer", "individuals", "bodyparts", "coords"]
    if len(labels[0]) == 3:
        names.remove("individuals")
    head = [
        ",".join([name, *column])
        for name, column in zip(names, zip(*labels, strict=True), strict=True)
    ]
    rows = [",".join(map(str, [n, *row])) for n, row in enumerate(POSES.tolist())]
    return "\n".join([*head, *rows])


@pytest.mark.parametrize("kind", ["csv", "h5"])
def test_poses_of_deeplabcut(tmp_path: Path, kind: str):
    file = tmp_path / f"pose.{kind}"
    if kind == "csv":
        file.write_text(pose_csv(LABELS))
    else:
        deeplabcut(file, LABELS, POSES)
    with pytest.raises(InputError, match=r"marks hub, rim.*--centre hub --toward rim"):
        read_tracks(file, **PIXELS)
    (track,) = read_tracks(file, **PIXELS, centre="hub", toward="rim")
    assert_allclose(track.time, [0.0, 0.1, 0.2])
    assert track.seen.tolist() == [True, False, True]
    assert_allclose(track.place[track.seen], [[0.01, -0.02]] * 2)
    assert_allclose(track.angle[track.seen], [0.0, -0.5 * np.pi], atol=1e-15)
    assert any("1 frame less likely" in note for note in track.notes)
    (all_seen,) = read_tracks(file, **PIXELS, centre="hub", likelihood=0.2)
    assert all_seen.seen.all()
    with pytest.raises(InputError, match="marks hub, rim"):
        read_tracks(file, **PIXELS, pucks="mouse")
    two = read_tracks(file, **PIXELS, pucks="hub,rim")
    assert [one.name for one in two] == [f"pose.{kind}: hub", f"pose.{kind}: rim"]


@pytest.mark.parametrize("kind", ["csv", "h5"])
def test_several_individuals_of_deeplabcut(tmp_path: Path, kind: str):
    labels = [("DLC", who, "hub", what) for who in ("a", "b") for what in ("x", "y", "likelihood")]
    file = tmp_path / f"pose.{kind}"
    if kind == "csv":
        file.write_text(pose_csv(labels))
    else:
        deeplabcut(file, labels, POSES)
    a, b = read_tracks(file, **PIXELS)
    assert (a.name, b.name) == (f"pose.{kind}: a", f"pose.{kind}: b")
    (chosen,) = read_tracks(file, **PIXELS, pucks="b")
    assert chosen.name == b.name
    assert_allclose(b.place, [[0.011, -0.02], [0.011, -0.02], [0.01, -0.022]])
    assert a.seen.tolist() == [True, False, True]


class Evil:
    def __reduce__(self):
        return (exec, ("raise SystemExit('ran')",))


@pytest.mark.parametrize(
    ("pickled", "words"),
    [
        (pickle.dumps([Evil()], protocol=0), "more than texts"), (b"(lp0\nVa\n", "cannot be read"),
        (b"g7\n.", "cannot be read"), (b"(t.", "cannot be read"), (b"junk", "cannot be read"),
        (pickle.dumps(["x", "y"] * 3, protocol=0), "none of DeepLabCut"),
        (pickle.dumps(LABELS[:3], protocol=0), "none of DeepLabCut"),
    ],
)  # fmt: skip
def test_pickles_in_files_of_deeplabcut_are_never_run(tmp_path: Path, pickled: bytes, words: str):
    file = deeplabcut(tmp_path / "pose.h5", LABELS, POSES)
    with h5py.File(file, "a") as opened:
        opened["df_with_missing/table"].attrs["values_block_0_kind"] = np.bytes_(pickled)
    with pytest.raises(InputError, match=words):
        read_tracks(file, **PIXELS)


def test_tables_of_sleap(tmp_path: Path):
    rows = [
        "track,frame_idx,instance.score,head.x,head.y,head.score,tail.x,tail.y,tail.score",
        "t0,0,0.93,101.5,55.25,0.97,140.5,55.25,0.88", "t1,0,0.93,1.5,5.25,0.97,1.5,6.25,0.88",
        "t0,3,0.51,103,57,0.20,,,", "t1,3,0.51,3,7,0.20,3,9,",
    ]  # fmt: skip
    file = saved(tmp_path, "sleap.csv", "\n".join(rows))
    one, two = read_tracks(file, **PIXELS, centre="head", toward="tail")
    assert (one.name, two.name) == ("sleap.csv: t0", "sleap.csv: t1")
    assert_allclose(one.time, [0.0, 0.3])
    assert_allclose(one.place, [[0.1015, -0.05525], [0.103, -0.057]])
    assert_allclose(one.angle, [0.0, math.nan])
    assert_allclose(two.angle, [-0.5 * np.pi] * 2)


@pytest.mark.parametrize("dims", [None, ("frame", "track", "node", "xy")])
def test_analysis_files_of_sleap(tmp_path: Path, dims: tuple[str, ...] | None):
    places = np.random.default_rng(6).uniform(0, 100, (2, 2, 3, 5))
    places[1, :, 0, 2] = np.nan
    file = sleap(tmp_path / "a.h5", places, ["hub", "rim", "up"], ["one", "two"], dims)
    one, two = read_tracks(file, **PIXELS, centre="hub,up", toward="rim")
    assert (one.name, two.name) == ("a.h5: one", "a.h5: two")
    middle = 0.5 * (places[0, :, 0] + places[0, :, 2])
    assert_allclose(one.place, 1e-3 * np.array([middle[0], -middle[1]]).T, rtol=1e-12)
    apart = places[0, :, 1] - middle
    assert_allclose(one.angle, np.arctan2(-apart[1], apart[0]), rtol=1e-12)
    assert two.seen.tolist() == [True, True, False, True, True]


def test_other_hdf5_is_refused(tmp_path: Path):
    bare = tmp_path / "bare.h5"
    with h5py.File(bare, "w") as file:
        file["x"] = [1.0]
    other = sleap(tmp_path / "odd.h5", np.zeros((1, 2, 3, 5)), "abc", "t")
    with h5py.File(other, "a") as file:
        file["tracks"].attrs["dims"] = '["camera", "xy", "node", "frame"]'
    flat = tmp_path / "flat.h5"
    with h5py.File(flat, "w") as file:
        file["tracks"] = np.zeros((3, 5))
    cut = tmp_path / "cut.h5"
    cut.write_bytes(bare.read_bytes()[:300])
    words = {bare: "none of DeepLabCut", other: "not known", flat: "tracks x 2", cut: "damaged"}
    for file, said in words.items():
        with pytest.raises(InputError, match=said):
            read_tracks(file, **PIXELS)

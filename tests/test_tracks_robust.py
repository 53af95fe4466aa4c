"""Damaged files of tracks end in tracks or in one sentence, whatever is wrong with them."""

from __future__ import annotations

import random
from pathlib import Path

import numpy as np
import pytest
from lookalikes import deeplabcut, sleap
from rarely import nightly
from test_tracks_text import ONE, TRACKMATE, TWO
from test_tracks_tools import GOOD, LABELS, POSES, archive, pose_csv

from puck_tables import InputError, Track, read_tracks
from puck_tables.film.report import dataset
from puck_tables.io import hdf5, json, jsonl

BITS = [
    b",", b";", b"\t", b" ", b"\n", b"\r", b'"', b"x", b"t", b"0", b"-", b".", b"nan", b"1e999",
    b"\0", b"\xff", b"[", b"]", b"#", b"frame", b"id", b"angle", b"{", b"/", b"in ", b"_", b"<",
]  # fmt: skip


def seeds(folder: Path) -> list[tuple[bytes, dict]]:
    pose = {"fps": 10, "scale": 1, "centre": "hub", "toward": "rim"}
    found = [(text.encode(), how) for text, how in ONE.values()]
    found += [(text.encode(), {"unit": "m"}) for text in TWO.values()]
    found += [(TRACKMATE.encode(), {"scale": 1}), (pose_csv(LABELS).encode(), pose)]
    found += [(GOOD.encode(), {}), (archive({"a.trk": GOOD}), {})]
    found.append((deeplabcut(folder / "d.h5", LABELS, POSES).read_bytes(), pose))
    saved = dataset([Track([0.0, 0.1, 0.2], [[1.0, 2.0]] * 3, [0.1] * 3, "a")] * 2)
    found += [(encode(saved), {}) for encode in (json.encode, hdf5.encode)]
    found.append((jsonl.encode(saved), {"unit": "m", "angle_unit": "rad"}))
    places = np.arange(40.0).reshape(2, 2, 2, 5)
    found.append((sleap(folder / "s.h5", places, ["hub", "rim"], "ab").read_bytes(), pose))
    return found


def damaged(content: bytes, rng: random.Random) -> bytes:
    data = bytearray(content)
    for _ in range(rng.randint(1, 3)):
        at, how = rng.randrange(len(data)), rng.random()
        if how < 0.4:
            data[at : at + rng.randint(0, 3)] = rng.choice(BITS)
        elif how < 0.6:
            data[at : at + rng.randint(1, 20)] = b""
        elif how < 0.8:
            data[at:at] = data[rng.randrange(len(data)) :][: rng.randint(1, 30)]
        else:
            data[at] = rng.randrange(256)
        data = data or bytearray(b"\n")
    return bytes(data)


@pytest.mark.parametrize(("seed", "count"), [(1, 400), nightly(2, 30_000)])
def test_damaged_files(seed: int, count: int, tmp_path: Path):
    rng, file, read = random.Random(seed), tmp_path / "film", 0
    given = seeds(tmp_path)
    for _ in range(count):
        content, how = rng.choice(given)
        file.write_bytes(damaged(content, rng))
        try:
            tracks = read_tracks(file, **how)
        except InputError as error:
            assert "\n" not in str(error)
            continue
        read += 1
        for track in tracks:
            assert np.isfinite(track.time).all()
            assert (np.diff(track.time) > 0.0).all()
            assert not np.isinf(track.place).any()
    assert 0 < read < count

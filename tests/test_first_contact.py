"""What somebody meets who has not read anything: plain words first, and guesses understood."""

from __future__ import annotations

import math

import pytest
from commands import invoke

from puck_tables import InputError, Scene
from puck_tables._core import own_folder

SCENE = {"puck": {"radius": 0.04}, "launch": {"velocity": [1.0, 0.0]}}


@pytest.mark.parametrize(
    ("launch", "first", "second"),
    [
        (["--v0", "1,0", "--w0", "5"], "stops after 3.963 s, 2.22 m", "bends to the right"),
        (["--v0", "0,1", "--w0", "-5"], "stops after 3.963 s, 2.22 m", "bends to the left"),
        (["--v0", "-1,0"], "stops after 1 s, 0.5 m", "Without spin its path is straight"),
        (["--v0", "1,0", "--w0", "5", "--delta", "0"], "stops after", "Its path is straight"),
        (["--v0", "0,0", "--w0", "5"], "spins on the spot", "It turns 1.492 times"),
        (["--v0", "0,0"], "lies still", "--v0"),
    ],
)
def test_the_report_begins_with_two_plain_sentences(launch: list[str], first: str, second: str):
    lines = invoke("simulate", *launch).stdout.splitlines()
    assert first in lines[0] and second in lines[1] and lines[2] == ""
    assert not any(word in "".join(lines[:2]) for word in ("delta", "Q", "phi", "J ="))


def test_degrees_are_understood_and_asked_for():
    floor = {"slope": "30deg", "downhill": "-90 deg"}
    scene = Scene.from_tables({**SCENE, "floor": floor})
    assert scene.floor.slope == math.radians(30.0)
    assert scene.floor.downhill == -0.5 * math.pi
    swept = invoke("sweep", "--scene", "incline", "--set", "floor.slope=0deg:5deg:2")
    assert [line.split(",")[0] for line in swept.stdout.splitlines()[1:]] == [
        "0.0", str(math.radians(5.0))
    ]  # fmt: skip
    with pytest.raises(InputError, match=r"slope = 30: .*if degrees are meant write '30deg'"):
        Scene.from_tables({**SCENE, "floor": {"slope": 30}})
    with pytest.raises(InputError, match="radius = '3deg': must be a number > 0 m"):
        Scene.from_tables({**SCENE, "puck": {"radius": "3deg"}, "floor": {}})


def test_what_was_meant_is_guessed():
    assert "did you mean 'air-hockey'?" in invoke("simulate", "--scene", "airhockey").stderr
    assert "Did you mean '--w0'?" in invoke("simulate", "--v0", "1,0", "--omega", "5").stderr
    assert "did you mean" not in invoke("simulate", "--scene", "zzz").stderr


def test_a_huge_puck_is_asked_for(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(own_folder, "_said", set())  # each sentence is said once
    real = ("--height", "0.025", "--friction", "0.1", "--v0", "2,0")
    huge = invoke("simulate", "--radius", "38", *real)
    assert huge.exit_code == 0
    assert huge.stderr.startswith("a radius beyond 10 m: lengths are in metres")
    assert "metres" not in invoke("simulate", "--radius", "0.038", *real).stderr

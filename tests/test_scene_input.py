"""Bad scenes: every error at once, each with its path, its value and what is allowed."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from puck_tables import Scene
from puck_tables.errors import InputError

GOOD: dict[str, Any] = {"puck": {"radius": 0.04}, "launch": {"velocity": [1.0, 0.0]}}


def fault(data: dict[str, Any]) -> str:
    with pytest.raises(InputError) as caught:
        Scene.from_tables(data, "my.toml")
    return str(caught.value)


def test_every_error_at_once() -> None:
    text = fault({
        "puck": {"radius": -1.0, "colour": "red", "friction": "rough"},
        "floor": {"velocity": [1.0], "slope": 2.0},
        "launch": {"spin": True, "position": [0.0, "here"]},
        "wall": [{"point": [1.0, 0.0], "normal": [0.0, 1.0], "restitution": 2.0}, 7],
        "constraint": {"kind": "glue"},
        "tol": float("nan"),
        "extra": {},
    })  # fmt: skip
    lines = text.splitlines()
    assert lines[0] == "my.toml: 12 errors"
    for expected in (
        "puck.radius = -1.0: must be a number > 0 m",
        "puck.colour: no such entry (there are: radius, height, friction, mass, gravity, ",
        "puck.friction = 'rough': must be a number >= 0",
        "floor.velocity = [1.0]: must be two numbers [x, y] in m/s",
        "floor.slope = 2.0: must be a number >= 0 and < 1.5708 rad",
        "launch.spin = True: must be a number in rad/s",
        "launch.position[1] = 'here': must be a number in m",
        "wall[0].restitution = 2.0: must be a number >= 0 and <= 1",
        "wall[1] = 7: must be a table",
        "constraint.kind = 'glue': must be one of rail, pivot, blade",
        "tol = nan: must be a number >= 1e-12 and <= 0.01",
        "extra: no such entry",
    ):
        assert any(line.strip().startswith(expected) for line in lines[1:]), (expected, text)


@pytest.mark.parametrize(
    ("more", "said"),
    [
        ({"puck": {}}, "puck: radius is missing: it must be a number > 0 m"),
        ({"launch": {"velocity": [10**400, 0]}}, "launch.velocity[0] = "),
        ({"floor": {"strips": {"borders": [0.0], "friction": [0.1]}}}, "must be one number more"),
        ({"floor": {"strips": {"borders": [1.0, 0.0], "friction": [1, 1, 1]}}}, "must ascend"),
        ({"floor": {"strips": {"borders": [], "friction": [0.1]}}}, "must be one number more"),
        ({"frames": 2.5}, "frames = 2.5: must be a whole number"),
        ({"time": 0.0}, "time = 0.0: must be a number > 0 s"),
        ({"wall": [{"point": [0, 0], "normal": [0, 0]}]}, "wall[0].normal = [0.0, 0.0]: must have"),
        ({"wall": [{"point": [0.01, 0], "normal": [-1, 0]}]}, "reaches through it by 0.03 m"),
        (
            {"edge": [{"point": [-1, 0], "normal": [-1, 0]}]},
            "the puck at [0.0, 0.0] lies in it by 1 m",
        ),
        (
            {"edge": [{"point": [0, -1e-6], "normal": [0, 1]}]},
            "sets off along it, its centre of mass 1e-06 m from it: whether it falls is not known",
        ),
        ({"constraint": {"kind": "pivot"}}, "constraint.reach = 0: a pivot needs a number > 0 m"),
        ({"constraint": {"kind": "rail", "angle": 1.0}}, "launch.velocity = [1.0, 0.0]: the rail"),
        ({"launch": {"spin": "0:1:1"}}, "launch.spin = '0:1:1': must be a range of 2 to 1000000"),
        ({"launch": {"spin": "0:1"}}, "or a range 'START:STOP:COUNT' of them"),
        ({"puck": []}, "puck is missing: it must be a table, or a list"),
        ({"wall": {"point": [9, 0]}}, "must be a list of tables, [[wall]]"),
    ],
)
def test_one_clear_sentence(more: dict[str, Any], said: str) -> None:
    assert said in fault({**GOOD, **more})


@pytest.mark.parametrize(
    ("text", "said"),
    [("", " is empty"), ("0,1\n1,2\n", r" must hold the columns t \[s\], Fx \[N\] and Fy"),
     ("0,1,2\n", ", line 1 is the only row"), ("0,1,2\n0,1,2\n", ", line 2: 0 again: the times"),
     ("1,0,0\n0,0,0\n", ", line 2: 0 after 1"), ("0,nan,0\n1,0,0\n", ", line 1: it has no force"),
     ("0,1,2\n1,2\n", ", line 2: 2 cells"), ("a,b,c\nd,e,f\n", " has no rows"),
     ("\x00", " is no text")],
)  # fmt: skip
def test_a_file_of_forces_that_is_none(text: str, said: str, tmp_path: Path) -> None:
    from scenes import simulate_scene

    path = tmp_path / "force.csv"
    path.write_text(text)
    puck = {"radius": 0.04, "friction": 0.1}
    scene = {**GOOD, "puck": puck, "force": {"over_time": str(path)}}
    with pytest.raises(InputError, match=r"force\.csv" + said):
        simulate_scene(scene)
    path.unlink()
    with pytest.raises(InputError, match="cannot read"):
        simulate_scene(scene)

"""Maps and samples of pucks on bases of any shape, and the command line's doors to them."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from commands import invoke
from rarely import thorough

from puck_tables import Floor, Launch, Normal, Puck, Scene, StribeckLaw, Uniform
from puck_tables.errors import ContactError, InputError
from puck_tables.world.board_case import BoardCase

PUCK = Puck(base="box:0.2x0.1", friction=0.3, height=0.02)


def test_a_map_has_the_bits_of_stops():
    speeds, spins = np.array([0.5, 1.0]), np.array([-10.0, 0.0, 5.0])
    found = PUCK.sweep(spins, speeds, heading=0.4, chunk=2)
    velocity = speeds[:, None, None] * np.array([np.cos(0.4), np.sin(0.4)])
    one = PUCK.stop(velocity, spins)
    assert found.outputs == ("stop_time", "stop_x", "stop_y", "path_length", "body_angle")
    for name in found.outputs:
        np.testing.assert_array_equal(getattr(found, name), getattr(one, name))
    assert found.dataset().attributes["base"] == "box:0.2x0.1"
    assert len(found.plot().axes) >= 6


def test_numbers_of_the_puck_range():
    found = PUCK.sweep(9.0, 1.0, height=[0.0, 0.02, 0.05], friction=[0.2, 0.3])
    assert found.dims == ("friction", "height")
    for i, friction in enumerate((0.2, 0.3)):
        for k, height in enumerate((0.0, 0.02, 0.05)):
            puck = Puck(base="box:0.2x0.1", friction=friction, height=height)
            np.testing.assert_allclose(
                found.stop_time[i, k], puck.stop((1.0, 0.0), 9.0).stop_time, rtol=1e-14
            )


def test_samples_sum_up():
    found = PUCK.sample(300, 3, spin=Normal(5.0, 0.3), speed=1.0, friction=Uniform(0.25, 0.35))
    assert set(found.mean()) == set(found.outputs)
    assert found.mean()["stop_x"] == pytest.approx(0.18, abs=0.01)
    assert found.chance((0.0, -1.0, 1.0, 1.0)).value == 1.0
    assert "integrated" in found.explain()


def test_a_store_has_the_same_bits(tmp_path: Path):
    pytest.importorskip("zarr")
    there = PUCK.sweep([0.0, 5.0], [0.5, 1.0], store=tmp_path / "map.zarr")
    np.testing.assert_array_equal(
        there.load().stop_time, PUCK.sweep([0.0, 5.0], [0.5, 1.0]).stop_time
    )


@pytest.mark.parametrize(
    ("ask", "words"),
    [
        (lambda: PUCK.sweep(1.0, 1.0, radius=[1.0, 2.0]), "radius of a sweep .* is of round pucks"),
        (lambda: PUCK.sweep(1.0, 1.0, delta=0.5), "delta of a sweep .* is of round pucks"),
        (lambda: PUCK.sweep(1.0, 1.0, pressure="hertz"), "pressure of a sweep"),
        (lambda: PUCK.sweep(1.0, 1.0, gyration=[0.1, 0.2]), "gyration of a sweep"),
        (lambda: PUCK.sweep(1.0, 1.0, method="look-up"), "method is of round pucks"),
        (lambda: PUCK.sample(9, radius=Normal(1.0, 0.1)), "radius of a sweep"),
    ],
)
def test_what_a_map_cannot_have_is_refused(ask: Callable[[], Any], words: str):
    with pytest.raises(InputError, match=words):
        ask()


def test_a_base_that_would_lift_is_refused():
    with pytest.raises(ContactError, match=r"it stays down up to 0\.0298"):
        PUCK.sweep(1.0, 1.0, height=[0.0, 5.0])


def asked(*arguments: str) -> tuple[int, str]:
    """Exit status and output of a command."""
    found = invoke(*arguments)
    return found.exit_code, found.output


def test_the_command_line_simulates(tmp_path: Path):
    corners = tmp_path / "triangle.csv"
    corners.write_text("x[m],y[m]\n0,0\n0.12,0\n0,0.09\n")
    launch = ("simulate", "--v0", "0.8,0", "--w0", "-15", "--friction", "0.25")
    code, said = asked(*launch, "--base", str(corners), "--json")
    assert code == 0
    run = json.loads(said)
    assert run["stop_time"] == pytest.approx(0.4234099378, abs=1e-8)
    assert run["turn_angle"] is None
    picture, film = tmp_path / "run.png", tmp_path / "run.html"
    code, said = asked(
        *launch, "--base", str(corners), "--plot", str(picture), "--movie", str(film)
    )
    assert code == 0
    assert "sliding and spinning end together" in said
    assert picture.stat().st_size > 10_000
    assert '"outline":[[[-0.04' in film.read_text("utf-8")


@pytest.mark.thorough
def test_a_gif_of_feet(tmp_path: Path):
    film = tmp_path / "run.gif"
    launch = ("simulate", "--v0", "1,0", "--base", "annulus:0.05x0.02@0.004,0")
    code, said = asked(*launch, "--gyration", "0.03", "--movie", str(film))
    assert code == 0, said
    assert film.read_bytes()[:3] == b"GIF"


def test_the_command_line_sweeps():
    launches = ("--speed", "0.5,1", "--w0", "0:10:3", "--friction", "0.3")
    code, said = asked("sweep", "--base", "box:20cmx10cm", *launches)
    assert code == 0
    assert "body_angle[rad]" in said
    assert "turn_angle" not in said
    spread = ("--random", "20", "--spread", "w0=normal:5:0.2")
    code, said = asked("sweep", "--base", "box:20cmx10cm", *spread)
    assert code == 0
    assert "stop_x" in said


@pytest.mark.parametrize("command", ["simulate --v0 1,0", "sweep --w0 0,1"])
@pytest.mark.parametrize(
    ("more", "words"),
    [
        ("--radius 1", "--base and --radius clash"),
        ("--delta 1", "--base and --delta clash"),
        ("--pressure hertz", "under a base it is linear"),
        ("--height 1cm", "--height needs --friction too"),
        ("--method rk4", "method is of round pucks"),
        ("--friction 0.3 --height 3", "part of the base would lift"),
    ],
)
def test_the_command_line_refuses(command: str, more: str, words: str):
    code, said = asked(*command.split(), "--base", "box:0.2x0.1", *more.split())
    assert code != 0
    assert words in said
    assert "Traceback" not in said


@pytest.mark.parametrize("body", [{"base": "box:0.2x0.1"}, thorough({"radius": 0.05})])
def test_under_a_law_fast_launches_end_with_the_others_as_they_do_alone(body, monkeypatch):
    """They need it farther than the first does: no run is made alone for that."""
    puck, floor = Puck(**body), Floor(law=StribeckLaw(0.35, 0.2, 0.1))
    velocity = np.array([[0.3, 0.1], [0.0, 0.02], [5.0, 0.0], [1.0, 1.0]])
    spin = np.array([0.5, 60.0, -9.0, 200.0])
    with monkeypatch.context() as patch:
        patch.setattr(BoardCase, "_run", None)
        ends = Scene(puck, floor, Launch(velocity, spin=spin)).sweep(threads=1)
    for n in range(len(spin)):
        one = Scene(puck, floor, Launch(velocity[n], spin=spin[n])).simulate([0.0])
        slip = math.hypot(*velocity[n], puck.inertia_radius * spin[n])
        unit = slip / (0.2 * puck.gravity)
        assert abs(ends.end_time[n] - one.end_time) <= 2e-6 * unit
        found = [ends.x[n] - one.last["x"], ends.y[n] - one.last["y"]]
        assert math.hypot(*found) <= 2e-6 * unit * slip

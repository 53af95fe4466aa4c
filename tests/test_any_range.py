"""Sweeps over any number of launch and puck, against single runs of such pucks."""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np
import pytest
from commands import invoke

from puck_tables import Puck
from puck_tables.errors import InputError

REAL = {"radius": 0.04, "height": 0.02, "friction": 0.2, "gravity": 9.0}
PUCK = Puck(**REAL)
RANGES: dict[str, list[float]] = {
    "radius": [0.03, 0.06], "height": [0.0, 0.05, 0.1], "friction": [0.1, 0.3],
    "gravity": [1.6, 9.8], "gyration": [0.5, 1.0],
}  # fmt: skip


def truth(heading: float = 0.0, **numbers: Any) -> Any:
    """A run of such a puck by itself, integrated."""
    puck = Puck(**{**REAL, **numbers})
    velocity = 1.3 * math.cos(heading), 1.3 * math.sin(heading)
    return puck.simulate(velocity, 40.0, frames=1)


@pytest.mark.parametrize("name", RANGES)
def test_a_range_of_one_number_is_the_pucks_that_have_it(name: str):
    found = PUCK.sweep(40.0, 1.3, **{name: RANGES[name]})
    assert list(found.axes) == [name]
    for n, value in enumerate(RANGES[name]):
        run = truth(**{name: value})
        assert found.stop_time[n] == pytest.approx(run.stop_time, abs=3e-8)
        place = [found.stop_x[n], found.stop_y[n]]
        np.testing.assert_allclose(place, run.stop_position, atol=3e-8)


def test_all_combinations_of_several_and_headings():
    found = PUCK.sweep(40.0, 1.3, radius=[0.03, 0.06], friction=[0.1, 0.3], heading=[0.0, 2.0])
    assert found.dims == ("friction", "radius", "launch_heading")
    assert found.fixed["height"] == 0.02 and "delta" not in found.fixed
    for place in itertools.product(range(2), repeat=3):
        friction, radius, heading = (found.axes[dim][i] for dim, i in zip(found.dims, place,
                                                                          strict=True))  # fmt: skip
        run = truth(friction=friction, radius=radius, heading=heading)
        where = [found.stop_x[place], found.stop_y[place]]
        np.testing.assert_allclose(where, run.stop_position, atol=3e-8)


def test_delta_stands_for_the_height_and_decel_for_the_gravity():
    by_delta = PUCK.sweep(40.0, 1.3, delta=[0.0, 0.2], friction=[0.2])
    by_height = PUCK.sweep(40.0, 1.3, height=[0.0, 0.02], friction=[0.2])
    np.testing.assert_allclose(by_delta.stop_y[0], by_height.stop_y[0], atol=1e-12)
    by_decel = PUCK.sweep(40.0, 1.3, decel=[1.8, 3.6])
    by_gravity = PUCK.sweep(40.0, 1.3, gravity=[9.0, 18.0])
    np.testing.assert_allclose(by_decel.stop_time, by_gravity.stop_time, rtol=1e-13)


def test_a_list_of_laws():
    found = PUCK.sweep([20.0, 40.0], 1.3, pressure=["uniform", "hertz"])
    assert found.laws == ("uniform", "hertz")
    run = truth(pressure="hertz")
    assert found.stop_x[1, 1] == pytest.approx(run.stop_position[0], abs=3e-8)
    assert set(found.to_pandas().pressure) == {"uniform", "hertz"}


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"delta": 0.5, "height": 0.1}, "delta and height clash"),
        ({"decel": 1.0, "gravity": 9.0}, "decel and gravity clash"),
        ({"radius": [0.0, 1.0]}, "radius must be greater than 0 m, got 0"),
        ({"friction": [-0.1]}, "friction must be greater than 0, got -0.1"),
        ({"height": [-0.1]}, "height must not be negative"),
        ({"gyration": [20.0]}, "gyration"),
        ({"gyration": np.linspace(0.2, 0.6, 501)}, "are too many"),
        ({"gyration": np.linspace(0.2, 0.6, 30), "delta": np.linspace(0, 1, 30)}, "are too many"),
        ({"delta": np.linspace(1.1, 3.0, 501)}, "501 different delta are too many"),
        ({"pressure": ["uniform"] * 1_000_000}, "a list of 1000000 pressure laws: give 1 to 100"),
        ({"pressure": []}, "a list of 0 pressure laws"),
        ({"pressure": ["uniform", "soft"]}, "soft"),
        ({"radius": 1e-200, "height": [1e200]}, "out of the range of floating point"),
        ({"speed": [[1.0]]}, "speed must be a number or a list"),
    ],
)
def test_what_cannot_range_is_refused(given: dict[str, Any], said: str):
    with pytest.raises(InputError, match=said):
        PUCK.sweep(**{"spin": 1.0, **given})


def invoked(*words: str) -> Any:
    return invoke("sweep", *words)


def test_the_command_line_ranges_them_too():
    table = invoked("--w0", "40", "--speed", "1.3", "--radius", "0.04", "--height", "0.02",
                    "--friction", "0.1:0.3:3", "--gravity", "9")  # fmt: skip
    assert table.exit_code == 0, table.stderr
    head, *rows = table.stdout.splitlines()
    assert head.startswith("friction[1],stop_time[s]") and len(rows) == 3
    assert float(rows[2].split(",")[1]) == pytest.approx(truth(friction=0.3).stop_time, abs=3e-8)
    scaled = invoked("--w0", "1", "--radius", "0.5:1:2", "--delta", "0.5")  # δ stays
    assert "delta = 0.5" in scaled.stderr
    for words, said in (
        (["--pressure", "annulus:0.1:0.9:1000000", "--w0", "1"], "more than 100 pressure laws"),
        (["--pressure", "uniform", "--pressure", "uniform"], "the same law twice"),
        (["--pressure", "annulus:a:b:3"], "annulus:START:STOP:COUNT"),
        (["--friction", "0.1:0.3:3"], "needs --radius and --height"),
    ):
        result = invoked(*words)
        assert (result.exit_code, said in result.stderr) == (2, True), result.stderr

"""Any arguments at all: an answer, a named status or one sentence; never a traceback or a NaN.

``pytest tests/test_fuzz.py --hypothesis-profile=nightly`` tries ten thousand.
"""

from __future__ import annotations

import json
import math
import signal
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from commands import invoke
from hostile import doors, hostile
from hypothesis import given
from hypothesis import strategies as st
from pucks import aim, simulate

from puck_tables import resultants, states, stop
from puck_tables.errors import PuckError

HARD = [
    0.0, -0.0, 1.0, -1.0, 0.5, 5e-324, 1e-308, 1e-160, 1e-12, 1.0 - 2.0**-53, 1.0 + 2.0**-52,
    1.5314, 2.0, 4.0, 1e12, 1e150, 1e160, 1.7e308, -1e-300, math.inf, -math.inf, math.nan,
]  # fmt: skip
number = st.one_of(st.sampled_from(HARD), st.floats(-10.0, 10.0), st.floats())
height = st.one_of(st.floats(0.0, 1.0), number)
positive = st.one_of(st.floats(0.01, 10.0), number)
text = st.one_of(
    number.map(repr),
    st.sampled_from(
        ["", " ", "1,2", "0:1:3", "nan", "1e999", "--w0", "١", "0x1", "1_0", "-", "a,b"]
    ),
)


@given(number, number, number, height, positive, positive)
def test_stops(vx: float, vy: float, w0: float, delta: float, decel: float, radius: float):
    try:
        found = stop((vx, vy), w0, delta=delta, decel=decel, radius=radius)
    except PuckError as error:
        assert str(error)
        return
    values = [float(found.stop_time), *found.stop_position]
    if int(found.status) == 0:
        assert np.isfinite(values).all()
        assert values[0] >= 0.0
    else:
        assert np.isnan(values).all()


@given(number, number, number, height, positive, positive, st.lists(number, min_size=0, max_size=4))
def test_states(vx, vy, w0, delta, decel, radius, times):
    puck = {"delta": delta, "decel": decel, "radius": radius}
    try:
        found = states((vx, vy), w0, times, **puck)
    except PuckError as error:
        assert str(error)
        return
    for name in ("x", "y", "heading", "orientation", "speed", "spin"):
        assert np.isfinite(getattr(found, name)).all(), name
    q = math.hypot(vx, vy, radius * w0)
    assert np.all(found.slip_speed <= q * (1.0 + 1e-9))


@given(number, number, height, positive, st.one_of(st.none(), number), st.one_of(st.none(), number))
def test_aims(x, y, delta, decel, w0, max_speed):
    try:
        found = aim((x, y), delta=delta, decel=decel, spin=w0, max_speed=max_speed, count=2)
    except PuckError as error:
        assert str(error)
        return
    assert found.answer
    assert np.isfinite(found.launch_velocity).all()
    assert np.isfinite(found.launch_spin).all()
    if found.launch_spin.size:
        q = np.hypot(found.launch_speed, found.launch_spin)
        scale = (q / decel * q).max()
        assert found.miss.max() <= 1e-9 * scale + 1e-300


@given(
    number, number, number, height, positive, positive, st.sampled_from([1e-13, 1e-9, 1e-3, 2.0])
)
def test_trajectories(vx, vy, w0, delta, decel, radius, accuracy):
    puck = {"delta": delta, "decel": decel, "radius": radius, "exact": True}
    try:
        run = simulate((vx, vy), w0, **puck, tol=accuracy, frames=5)
    except PuckError as error:
        assert str(error)
        return
    for name in ("x", "y", "heading", "orientation", "speed", "spin", "slip_speed", "slip_angle"):
        assert np.isfinite(getattr(run, name)).all(), name
    assert run.energy_residual <= max(1e-10, 10.0 * accuracy)
    assert np.all(np.diff(run.slip_speed) <= 1e-12 * run.slip_speed[0])


@given(number, number)
def test_resultants(phi: float, delta: float):
    try:
        rho = resultants(phi, delta)
    except PuckError as error:
        assert str(error)
        return
    assert np.isfinite([float(r) for r in rho]).all()


OPTIONS = {
    "simulate": ["--v0", "--w0", "--delta", "--radius", "--decel", "--times", "--tol", "--mass"],
    "sweep": ["--v0", "--w0", "--speed", "--delta", "--radius", "--height", "--tol"],
    "aim": ["--target", "--w0", "--speed", "--time", "--max-speed", "--max-spin", "--delta"],
}


@st.composite
def command_lines(draw: st.DrawFn) -> list[str]:
    command = draw(st.sampled_from(sorted(OPTIONS)))
    line = [command]
    pair = st.tuples(text, text).map(",".join)
    for option in draw(st.lists(st.sampled_from(OPTIONS[command]), max_size=5)):
        line += [option, draw(pair if option in ("--v0", "--target") else text)]
    if draw(st.booleans()):
        line += {"simulate": ["--json"], "aim": ["--json"]}.get(command, ["-o", "out.csv"])
    return line


@given(command_lines())
def test_command_lines(line: list[str]):
    with tempfile.TemporaryDirectory() as folder:
        if "-o" in line:
            line[line.index("-o") + 1] = str(Path(folder) / "out.csv")
        ended = invoke(*line)
        assert ended.exit_code in (0, 1, 2), (line, ended.exception)
        assert ended.exception is None or isinstance(ended.exception, SystemExit), line
        assert "Traceback" not in ended.stderr
        if ended.exit_code == 0 and "--json" in line:
            json.loads(ended.stdout, parse_constant=lambda name: 1 / 0)
        if ended.exit_code != 0:
            assert ended.stdout == ""
            assert list(Path(folder).iterdir()) == []
            assert len(ended.stderr.strip().splitlines()) <= 4


NO_ANSWER = 300  # s, of one call
QUICK = [name for name in doors() if name.startswith("pt.") or name in {
    "stop", "states", "stop_arrays", "state_arrays", "resultants", "critical_delta", "Puck",
    "limit_ratio", "regime", "Normal", "Uniform", "law_of", "profile_law",
    "StribeckLaw", "PowerLaw", "CurlingLaw", "SpeedLaw", "RestitutionTable", "Table.shipped",
    "Scene.load", "Scene.unit_of", "patch_stop", "patch_system", "Asperity", "Asperity.press",
    "constrained_motion", "asperity_motion", "stops.spread", "states.derivative", "export_source",
}]  # fmt: skip


@contextmanager
def watched(said: str) -> Iterator[None]:
    """A call that gives no answer ends in a failure, not in a wait without end."""

    def fail(*_: object) -> None:
        raise AssertionError(f"no answer after {NO_ANSWER} s: {said}")

    before = signal.signal(signal.SIGALRM, fail)
    signal.alarm(NO_ANSWER)
    try:
        yield
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)


def try_door(name: str, rng: np.random.Generator) -> None:
    """One argument or two are nobody's wish: an answer without NaN, or a sentence."""
    call, good = doors()[name]
    values = hostile()
    changed = rng.choice(list(good), min(int(rng.integers(1, 3)), len(good)), replace=False)
    bad: dict[str, Any] = {str(one): values[int(rng.integers(len(values)))] for one in changed}
    said = f"{name}({', '.join(f'{key}={value!r:.80}' for key, value in bad.items())})"
    try:
        with watched(said):
            found = call(**{**good, **bad})
    except PuckError as error:
        assert str(error), said
        long = any(isinstance(value, str) and len(value) > 1000 for value in bad.values())
        assert long or len(str(error)) < 2000, said
        return
    except Exception as error:
        raise AssertionError(said) from error
    for part in found if isinstance(found, tuple) else (found,):
        if isinstance(part, float | np.ndarray) and np.asarray(part).dtype.kind == "f":
            assert not np.isnan(part).any(), said


def test_hostile_arguments():
    rng = np.random.default_rng(35)
    for _ in range(2):
        for name in QUICK:
            try_door(name, rng)


@pytest.mark.thorough
@pytest.mark.parametrize("name", list(doors()))
def test_hostile_arguments_at_every_door(name: str):
    call, good = doors()[name]
    if not name.endswith((".load", ".from_csv")):
        call(**good)  # what is not replaced is good
    rng = np.random.default_rng(sum(map(ord, name)))
    for _ in range(30 * len(good)):
        try_door(name, rng)

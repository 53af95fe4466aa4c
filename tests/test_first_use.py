"""Whoever uses the program first, and in however many threads at once, gets an answer."""

from __future__ import annotations

import io
import os
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest
from rarely import few

import puck_tables as pt
from puck_tables._core.own_folder import say
from puck_tables.kernels.compile import Door
from puck_tables.kernels.patience import here

# a question for every public door that computes
DOORS = {
    "simulate": "PUCK.simulate((1.0, 0.2), 5.0).stop_time",
    "stop": "PUCK.stop((1.0, 0.2), 5.0).stop_time", "stop of": "pt.stop((1.0, 0.2), 5.0).stop_time",
    "stops": "pt.stop_arrays([1.0, 0.9], [0.2, 0.1], [5.0, 4.0])[0]",
    "states": "PUCK.states((1.0, 0.2), 5.0, 0.1).x",
    "states of": "pt.states((1.0, 0.2), 5.0, 0.1).x", "aim": "PUCK.aim((0.2, 0.1)).launch_spin",
    "sweep": "PUCK.sweep([0.0, 1.0], [1.0, 2.0]).stop_time",
    "sample": "PUCK.sample(4, seed=1, speed=pt.Normal(1.0, 0.1), spin=3.0).stop_time",
    "regime": "PUCK.regime((1.0, 0.2), 5.0)", "pull": "PUCK.limit_surface().unit_force",
    "wrench": "PUCK.wrench((1.0, 0.2), 5.0, jacobian=True).torque",
    "twist": "PUCK.twist((0.1, 0.2), 0.001).spin",
    "push": "pt.push(pt.Puck(base='box:0.2x0.1', friction=0.3), (-0.1, 0.0), (1.0, 0.1), 0.3).spin",
    "scene": "pt.Scene.load('incline').simulate().end_time",
    "world": "pt.Scene.load('newtons-row').world().advance(0.01)",
    "table": "pt.Table.shipped().resultants(0.3, 0.5).spin",
    "resultants": "pt.resultants(0.3, 0.5).spin", "limit": "pt.motion.limit_ratio(0.1)",
    "share": "pt.contact.loaded_share(0.3, 0.5)", "law": "pt.law_of('annulus:0.8').name",
    "case": "pt.reference_case('coin').time", "asperity": "pt.chetaev.Asperity",
    "export": "pt.export_source('c', tol=1e-3).text",
    "frame": "PUCK.stop((1.0, 0.2), 5.0).dataset()",
}  # fmt: skip
AT_ONCE = """
import sys, threading
import puck_tables as pt
sys.setswitchinterval(1e-5)
PUCK = pt.Puck(radius=0.04, height=0.02, friction=0.15)
begin, wrong = threading.Barrier(8), []
def ask(question):
    begin.wait()
    try:
        eval(question)
    except BaseException as error:
        wrong.append(f"{question}: {type(error).__name__}: {error}")
threads = [threading.Thread(target=ask, args=(question,)) for question in sys.argv[1:]]
[thread.start() for thread in threads]
[thread.join() for thread in threads]
print(*wrong, sep="\\n", end="")
"""


def failures(questions: list[str]) -> str:
    """What goes wrong where eight threads ask these first."""
    ended = subprocess.run(
        [sys.executable, "-c", AT_ONCE, *questions], capture_output=True, text=True, check=True
    )
    return ended.stdout


def test_eight_threads_may_ask_the_same_first() -> None:
    assert failures([DOORS["limit"]] * 8) == ""


@pytest.mark.thorough
@pytest.mark.parametrize("door", few(5, DOORS))
def test_eight_threads_may_use_any_door_first(door: str) -> None:
    assert failures([DOORS[door]] * 8) == ""


@pytest.mark.thorough
@pytest.mark.parametrize("seed", few(2, range(6)))
def test_eight_threads_may_use_different_doors_first(seed: int) -> None:
    drawn = np.random.default_rng(seed).choice(list(DOORS.values()), 8)
    assert failures(drawn.tolist()) == ""


def test_lines_of_many_threads_do_not_run_together(monkeypatch: pytest.MonkeyPatch) -> None:
    written: list[str] = []

    class Recorder(io.StringIO):
        def write(self, text: str, /) -> int:
            written.append(text)
            time.sleep(1e-4)  # another thread's turn
            return len(text)

    monkeypatch.setattr(sys, "stderr", Recorder())
    lines = [f"line {n % 8} of {n % 3} in {__name__}" for n in range(48)]
    threads = [threading.Thread(target=say, args=(line,)) for line in lines]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert sorted(written) == sorted({f"{line}\n" for line in lines})


FIT = """
import numpy as np
import puck_tables as pt
t = np.arange(60) / 60.0
path = pt.Puck(radius=0.04, height=0.025, friction=0.15).states((1.5, 0.3), 40.0, t)
noise = 3e-4 * np.random.default_rng(1).normal(size=(60, 2))
track = pt.Track(t, np.stack([path.x, path.y], axis=1) + noise, path.orientation, "film")
found = pt.fit(track, pt.Puck(radius=0.04))
print(found.summary(), found.estimate.jacobian.tobytes().hex())
"""


@pytest.mark.thorough
def test_a_first_fit_has_the_bits_of_the_next(tmp_path: Path) -> None:
    ask = [sys.executable, "-c", FIT]
    environment = {**os.environ, "XDG_CACHE_HOME": str(tmp_path)}
    first, second = (
        subprocess.run(ask, capture_output=True, text=True, check=True, env=environment).stdout
        for _ in range(2)
    )
    assert first == second


def test_a_fit_runs_nothing_as_it_is_written(monkeypatch: pytest.MonkeyPatch) -> None:
    called, run = set(), Door.__call__

    def noted(door: Door, *args: object) -> object:
        called.add((door.__name__, here.at_once))
        return run(door, *args)

    monkeypatch.setattr(here, "at_once", False)  # as it is outside of tests
    monkeypatch.setattr(Door, "__call__", noted)
    times = np.arange(30) / 60.0
    place = np.stack([times - 0.3 * times**2, np.sin(99.0 * times) * 1e-3], axis=1)
    pt.fit(pt.Track(times, place, 0.0 * times, "film"), pt.Puck(radius=0.04))
    assert called and all(at_once for _, at_once in called), called

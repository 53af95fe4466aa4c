"""How long does one stop take, one tight trajectory, and one start of the command line?

Errors: the larger of stop time in units of Q/J and stop place in units of Q²/J, against
``simulate(exact=True, tol=1e-13)``.  The rivals integrate the same physics over time with
scipy, so their small errors also judge that reference.
"""

from __future__ import annotations

import math
import os
import shutil
import subprocess
import sys
import sysconfig
import warnings
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
import pytest
from scipy.integrate import solve_ivp

import puck_tables
from puck_tables.accuracy.methods import Method
from puck_tables.contact.laws import HOMOGENEOUS
from puck_tables.kernels.closed_form_kernel import friction_ratios
from puck_tables.kernels.compile import allocating, kernel
from puck_tables.kernels.quadratic import NO_COLUMNS, NO_SECTION
from puck_tables.motion.friction_source import integration_selected
from puck_tables.motion.limits import log_ratio
from puck_tables.motion.path import integrate
from puck_tables.motion.state import SIZE, T, X, Y
from puck_tables.motion.steppers import DORMAND_PRINCE, stepping_of
from puck_tables.stopping.per_height import SolverPerHeight
from puck_tables.stopping.solvers import Integration
from puck_tables.table.resultant_table import ResultantTable
from puck_tables.tradeoff.scipy_methods import disc_by_patches

FloatArray = npt.NDArray[np.float64]

ONE_STOP = pytest.mark.benchmark(group="one stop at error 1e-6")
TIGHT = pytest.mark.benchmark(group="one trajectory, tight (1e-10)")
START = pytest.mark.benchmark(group="first and later start")

DELTA = 0.5  # with J = r = 1 everywhere
PUCK = puck_tables.Puck.similar(delta=DELTA)
LAUNCH = (1.0, 0.0, 5.0)  # vx, vy, ω of the single launch
LAUNCHES = 1000


# --- errors -----------------------------------------------------------------------------------


@cache
def reference(vx: float, vy: float, spin: float) -> FloatArray:
    """Stop time and place, exact to about 1e-13."""
    run = PUCK.simulate((vx, vy), spin, exact=True, tol=1e-13, frames=1)
    return np.array([run.stop_time, *run.stop_position])


def error_of(stop: npt.ArrayLike, launch: tuple[float, ...]) -> float:
    """Error of one (time, x, y): a NaN counts as infinite."""
    off = np.asarray(stop) - reference(*launch)
    q = math.hypot(*launch)
    error = max(abs(off[0]) / q, math.hypot(off[1], off[2]) / q**2)
    return error if error < math.inf else math.inf


@pytest.fixture
def launches(rng: np.random.Generator) -> FloatArray:
    """Launches (n, 6) scattered over directions, spins of both signs and slip ratios."""
    velocity, spin = rng.uniform(-1.0, 1.0, (LAUNCHES, 2)), rng.uniform(-5.0, 5.0, LAUNCHES)
    other = np.broadcast_to([DELTA, 1.0, 1.0], (LAUNCHES, 3))
    return np.column_stack([velocity, spin, other])


def largest_error(stops: FloatArray, launches: FloatArray) -> float:
    """Largest error of stops (n, 3)."""
    return max(error_of(s, tuple(row[:3])) for s, row in zip(stops, launches, strict=True))


# --- rival A: scipy over time, friction from the same compiled closed forms -----------------------


@allocating
def rates(t: float, state: FloatArray) -> FloatArray:
    """d/dt of vx, vy, ω, x, y."""
    vx, vy, spin = state[0], state[1], state[2]
    speed, rim = math.hypot(vx, vy), abs(spin)
    q = math.hypot(speed, rim)
    fast = 1.0 if rim > speed else 0.0
    inverse, across, turning = friction_ratios(min(speed, rim) / max(speed, rim), fast, DELTA)
    along, left = -1.0 / (inverse * q), -across * spin / (inverse * q * q)
    out = np.empty(5)
    out[0] = along * vx - left * vy
    out[1] = along * vy + left * vx
    out[2] = -turning / inverse * spin / q
    out[3] = vx
    out[4] = vy
    return out


@kernel
def slip_speed(state: FloatArray) -> float:
    return math.hypot(math.hypot(state[0], state[1]), state[2])


class Setting(NamedTuple):
    rtol: float
    atol: float
    calls: int = 0
    error: float = math.inf


class TooManyCalls(Exception):
    """Stepped over the stop, where friction jumps, and now trembles about it."""


def over_time(
    method: str, setting: Setting, end: float, function: Callable[..., Any] = rates
) -> Any:
    """The launch by scipy until the slip speed has fallen to ``end`` times its start."""
    start = np.array([*LAUNCH, 0.0, 0.0])
    q0 = slip_speed(start)

    def nearly_stopped(t: float, state: FloatArray) -> float:
        return slip_speed(state) - end * q0

    nearly_stopped.terminal = True  # type: ignore[attr-defined]
    return solve_ivp(
        function, (0.0, 2.0 * q0), start, method=method, rtol=setting.rtol, atol=setting.atol,
        events=nearly_stopped,
    )  # fmt: skip


def stop_of(solution: Any) -> FloatArray:
    """Time and place of the end event; NaN if it never came."""
    if solution.status != 1:
        return np.full(3, math.nan)
    return np.array([solution.t_events[0][-1], *solution.y_events[0][-1][3:]])


def tried(method: str, setting: Setting, end: float, most_calls: int = 5000) -> Setting:
    """The setting with the calls it took and the error it made; infinite if it failed."""
    calls = 0

    def counted(t: float, state: FloatArray) -> FloatArray:
        nonlocal calls
        calls += 1
        if calls > most_calls:
            raise TooManyCalls
        return rates(t, state)

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            solution = over_time(method, setting, end, counted)
    except (TooManyCalls, UserWarning):
        return setting
    return setting._replace(calls=calls, error=error_of(stop_of(solution), LAUNCH))


@cache
def cheapest(method: str, accuracy: float, end: float) -> Setting:
    """Of all tolerances that reach the accuracy, the one with the fewest calls.

    The absolute tolerance is varied too: near the stop only it keeps the steps from jumping over.
    """
    settings = [
        tried(method, Setting(10.0**-digits, share * 10.0**-digits), end)
        for digits in range(3, 13)
        for share in (1.0, 1e-2, 1e-4, 1e-6, 1e-8)
    ]
    good = [setting for setting in settings if setting.error <= accuracy]
    return min(good, key=lambda setting: setting.calls)


def time_rival(measure: Any, method: str, setting: Setting, end: float) -> None:
    measure.benchmark.extra_info.update(rtol=setting.rtol, atol=setting.atol, calls=setting.calls)
    measure(
        f"rival: scipy {method} over time, rtol {setting.rtol:.0e}",
        lambda: over_time(method, setting, end), unit="trajectory", error=setting.error,
    )  # fmt: skip


# --- one stop -------------------------------------------------------------------------------------

ACCURACY = 1e-6


@ONE_STOP
@pytest.mark.parametrize("way", ["look-up", "rk4", "adaptive"])
def test_stop_kernel(measure: Any, launches: FloatArray, way: str) -> None:
    solver = SolverPerHeight("uniform", HOMOGENEOUS, ACCURACY, way, None)
    columns = np.ascontiguousarray(launches.T)
    solver.prepare(columns[3])
    out, status = solver.all(columns)
    assert not status.any()
    measure(
        f"{solver.selections[0].scheme.name}, 1000 launches", lambda: solver.all(columns),
        items=LAUNCHES, unit="trajectory", error=largest_error(out[:3].T, launches),
    )  # fmt: skip


@ONE_STOP
def test_stop_public(measure: Any, table: ResultantTable, launches: FloatArray) -> None:
    velocity, spin = launches[:, :2].copy(), launches[:, 2].copy()

    def stop() -> puck_tables.results.Stops:
        return puck_tables.stop(velocity, spin, delta=DELTA, tol=ACCURACY)

    stops = np.column_stack([stop().stop_time, stop().stop_position])
    measure(
        "puck_tables.stop, 1000 launches", stop, items=LAUNCHES, unit="trajectory",
        error=largest_error(stops, launches),
    )  # fmt: skip


@ONE_STOP
@pytest.mark.parametrize("given", [True, False], ids=["table_given", "table_read"])
def test_stop_public_single(measure: Any, table: ResultantTable, given: bool) -> None:
    chosen = table if given else None

    def stop() -> puck_tables.results.Stops:
        return puck_tables.stop(LAUNCH[:2], LAUNCH[2], delta=DELTA, tol=ACCURACY, table=chosen)

    measure(
        "integrated, puck_tables.stop, 1 launch"
        if given
        else "look-up, puck_tables.stop, 1 launch",
        stop,
        unit="trajectory",
        error=error_of([float(stop().stop_time), *stop().stop_position], LAUNCH),
    )


@ONE_STOP
def test_stop_closed_forms(measure: Any, launches: FloatArray) -> None:
    selection = integration_selected("stop", ACCURACY, Method.RK4, None, exact=True)
    exact = Integration(NO_COLUMNS, NO_SECTION, stepping_of(selection), Method.RK4)
    columns = np.ascontiguousarray(launches.T)
    measure(
        "closed forms in the same loop, 1000 launches", lambda: exact.all(columns), items=LAUNCHES,
        unit="trajectory", error=largest_error(exact.all(columns)[0][:3].T, launches),
    )  # fmt: skip


@ONE_STOP
@pytest.mark.parametrize("method", ["RK45", "DOP853", "LSODA"])
def test_stop_rival_scipy(measure: Any, method: str) -> None:
    time_rival(measure, method, cheapest(method, ACCURACY, 1e-8), 1e-8)


@ONE_STOP
def test_stop_rival_patch_script(measure: Any) -> None:
    measure(
        "rival: plain script, 20 x 40 patches", lambda: disc_by_patches(*LAUNCH, DELTA),
        unit="trajectory", error=error_of(disc_by_patches(*LAUNCH, DELTA), LAUNCH),
    )  # fmt: skip


# --- one tight trajectory -------------------------------------------------------------------------

TIGHT_ACCURACY = 1e-10
TIGHT_TOL = 2e-10  # with a table of one's own its error counts five times


@TIGHT
@pytest.mark.parametrize("source", ["table", "closed forms"])
def test_tight_integrator(measure: Any, table: ResultantTable, source: str) -> None:
    coefficients = NO_SECTION
    if source == "table":
        coefficients = table.section(DELTA)
    s, y, result = np.empty(20_000), np.empty((20_000, SIZE)), np.empty(SIZE + 1)
    u, q = log_ratio(math.hypot(*LAUNCH[:2]), abs(LAUNCH[2])), math.hypot(*LAUNCH)

    def run() -> tuple[int, int]:
        return integrate(
            u, DORMAND_PRINCE, 0.0, 0.4 * TIGHT_ACCURACY, 1.0, coefficients, DELTA, s.size, s, y,
            result,
        )  # fmt: skip

    _, count = run()
    measure.benchmark.extra_info["steps"] = count - 1
    stop = [q * result[T], q * q * result[X], q * q * result[Y]]
    measure(f"{source}, integrator", run, unit="trajectory", error=error_of(stop, LAUNCH))


@TIGHT
@pytest.mark.parametrize("source", ["table", "closed forms"])
def test_tight_simulate(measure: Any, table: ResultantTable, source: str) -> None:
    exact = source != "table"

    def run() -> puck_tables.results.Trajectory:
        return PUCK.simulate(
            LAUNCH[:2], LAUNCH[2], tol=TIGHT_TOL, exact=exact,
            table=None if exact else table,
        )  # fmt: skip

    stop = [run().stop_time, *run().stop_position]
    measure(
        f"{source}, simulate (101 states, error estimate)", run, unit="trajectory",
        error=error_of(stop, LAUNCH),
    )  # fmt: skip


@TIGHT
@pytest.mark.parametrize("method", ["plain", "DOP853", "LSODA"])
def test_tight_rival_scipy(measure: Any, method: str) -> None:
    """DOP853 as anybody would ask for it, and at the cheapest tolerances that do."""
    end = 1e-12
    if method == "plain":
        time_rival(measure, "DOP853", tried("DOP853", Setting(1e-11, 1e-13), end), end)
    else:
        time_rival(measure, method, cheapest(method, TIGHT_ACCURACY, end), end)


# --- the command line -----------------------------------------------------------------------------

PUCK_COMMAND = shutil.which("puck", path=sysconfig.get_path("scripts"))
SIMULATE = [str(PUCK_COMMAND), "simulate", "--v0", "1,0", "--w0", "5"]
SCIPY = [sys.executable, "-c", "import numpy, scipy.integrate"]


@pytest.fixture(scope="module")
def bytecode(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the bytecode of everything that is imported: only kernels are ever compiled."""
    folder = tmp_path_factory.mktemp("bytecode")
    for command in (SIMULATE, SCIPY):
        start(command, folder, tmp_path_factory.mktemp("kernels"))
    return folder


def start(command: list[str], bytecode: Path, kernels: Path) -> None:
    environment = {**os.environ, "PYTHONPYCACHEPREFIX": str(bytecode)}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)
    environment["NUMBA_CACHE_DIR"] = str(kernels)
    subprocess.run(command, env=environment, check=True, capture_output=True)


@START
@pytest.mark.skipif(PUCK_COMMAND is None, reason="the command puck is not beside this Python")
@pytest.mark.parametrize(
    ("name", "command"),
    [
        ("puck simulate, later", SIMULATE), ("puck simulate, first", SIMULATE),
        ("puck --version", [SIMULATE[0], "--version"]),
        ("rival: python -c 'pass'", [sys.executable, "-c", "pass"]),
        (f"rival: python -c '{SCIPY[2]}'", SCIPY),
    ],
)  # fmt: skip
def test_start(
    measure: Any, bytecode: Path, tmp_path_factory: Any, name: str, command: list[str]
) -> None:  # fmt: skip
    """A process of its own, with one warm cache of kernels, or at first with a fresh one."""
    warm, first = tmp_path_factory.mktemp("kernels"), name.endswith("first")
    if not first:
        start(command, bytecode, warm)

    def arguments() -> tuple[tuple[Any, ...], dict[str, Any]]:
        return (command, bytecode, tmp_path_factory.mktemp("kernels") if first else warm), {}

    measure.benchmark.pedantic(start, setup=arguments, rounds=2 if first else 3, iterations=1)
    measure.book(name, 1, "start")

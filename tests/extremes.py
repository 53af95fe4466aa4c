"""Arguments pushed to their ends: what is asked, what is promised, and the worst as measured.

    python tests/extremes.py

prints the table of docs/accuracy.md.  The judges are mpmath, or closed forms written out here;
those of stops are the script of tests/golden, those of one-sided contact tests/strips.py.
"""

from __future__ import annotations

import importlib.util
import math
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import mpmath
import numpy as np
import strips
from mpmath import mp, mpf
from pucks import simulate

import puck_tables as pt

HERE = Path(__file__).resolve().parent
QUARTER, HALF = 0.25 * math.pi, 0.5 * math.pi
EPS = 2.0**-53
HEIGHTS = (0.0, 5e-324, 1e-160, 0.5, 1.0 - EPS, 1.0)
TINY = [10.0**-n for n in (300, 200, 100, 60, 30, 16, 12, 8, 4, 2, 1)]


class Row(NamedTuple):
    """What is asked, what is promised, and how to find the largest deviation."""

    name: str
    extreme: str
    unit: str
    bound: float
    measure: Callable[[], float]


ROWS: list[Row] = []


def row(extreme: str, unit: str, bound: float) -> Callable[[Callable[[], Iterator[float]]], object]:
    """Add a measurement, given by the deviations at all its points; NaN counts as infinite."""

    def add(deviations: Callable[[], Iterator[float]]) -> object:
        def worst() -> float:
            seen = np.abs(np.array([float(d) for d in deviations()]))
            return math.inf if np.isnan(seen).any() else float(seen.max())

        ROWS.append(Row(deviations.__name__, extreme, unit, bound, worst))
        return deviations

    return add


@cache
def judge() -> Any:
    """The script of the golden starts."""
    path = HERE / "golden" / "make_starts.py"
    spec = importlib.util.spec_from_file_location("make_starts", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def friction(phi: mpf, delta: mpf) -> tuple[mpf, mpf, mpf]:
    """ρ_∥, ρ_⊥, ρ_ω by textbook elliptic integrals, at the precision that mpmath is set to."""
    _, _, inverse, across, spin = judge().ratios(mp.log(mp.tan(phi)), delta)
    return 1 / inverse, across / inverse, spin / inverse


def at(point: float, gap: float, side: int) -> float:
    """A double next to a point, at this gap or the least there is."""
    moved = point + side * gap
    return moved if moved != point else math.nextafter(point, side * math.inf)


def angles() -> list[float]:
    """Both sides of 0, π/4 and π/2, of either sign; inside [−π/2, π/2] and without 0."""
    phi = [*TINY, *(at(QUARTER, gap, side) for gap in TINY for side in (-1, 1)),
           *(at(HALF, gap, -1) for gap in TINY)]  # fmt: skip
    return sorted({sign * p for p in phi if 0.0 < p < HALF for sign in (-1, 1)})


def exact_friction(phi: float, delta: float) -> list[float]:
    """ρ_∥, ρ_⊥, ρ_ω at a double, rounded once; the terms cancel to the third power of the gap."""
    gap = min(abs(phi), HALF - abs(phi))
    with mp.workdps(40 + int(4 * max(0.0, -math.log10(gap)))):
        return [float(x) for x in friction(mpf(abs(phi)), mpf(delta))]


@cache
def exact_frictions() -> np.ndarray:
    half = [phi for phi in angles() if phi > 0.0]
    rows = [[exact_friction(phi, d) for d in HEIGHTS] for phi in half]
    return np.array(rows[::-1] + rows)  # even in φ


@row("φ 1e-300 … 0.1 from 0, π/4, π/2, both sides; δ = 0, 5e-324, … 1 − ε, 1", "resultants", 1e-14)
def resultants_next_to_the_special_angles() -> Iterator[float]:
    rho = pt.resultants(np.array(angles())[:, None], np.array(HEIGHTS))
    yield from (np.stack(rho, axis=-1) - exact_frictions()).ravel()


@row("the same from the default table", "resultants", 2e-11)
def table_next_to_the_special_angles() -> Iterator[float]:
    rho = pt.Table.shipped().resultants(np.array(angles())[:, None], np.array(HEIGHTS))
    yield from (np.stack(rho, axis=-1) - exact_frictions()).ravel()


@row("δ on the curve where contact opens, × (1 ∓ 1e-15 … 1e-6)", "resultants", 1e-13)
def resultants_where_contact_opens() -> Iterator[float]:
    """The linear law is exact before, and off by (δ/δ_c − 1)^(5/2), below 1e-14, behind."""
    for phi in (1e-300, 1e-8, 0.3, QUARTER, 1.0, 1.2):
        critical = float(pt.contact.critical_delta(phi))
        for gap in (1e-15, 1e-12, 1e-9, 1e-6):
            for side in (-1.0, 1.0):
                delta = critical * (1.0 + side * gap)
                rho = pt.contact.one_sided_resultants(phi, delta)
                yield from np.array(rho) - exact_friction(phi, delta)


def one_sided_against_strips(delta: float) -> Iterator[float]:
    from puck_tables.contact.one_sided import balance  # for a first guess of two digits only

    for phi in (0.2, 0.5, 0.7, QUARTER - 0.006, QUARTER + 1e-3, 0.9):
        _, chord = balance(np.array([phi]), np.array([delta]))
        start = round(float(chord.offset[0]), 3), round(float(chord.bearing[0]), 3)
        rho = pt.contact.one_sided_resultants(phi, delta)
        yield from np.array(rho) - strips.resultants(phi, delta, start)


@row("δ = 3.9, one-sided contact", "resultants", 2e-12)
def one_sided_at_the_end_of_its_table() -> Iterator[float]:
    yield from one_sided_against_strips(3.9)


@row("δ = 3.9637, next to the fold", "resultants", 1e-11)
def one_sided_next_to_the_fold() -> Iterator[float]:
    yield from one_sided_against_strips(3.9637)


def close_to_tipping(gap: float) -> Iterator[float]:
    """Pure sliding under a load on a thin segment, by its moments: d from ⟨x⟩ = δ/4."""
    with mp.workdps(40):
        delta = 4 - mpf(gap)

        def mean(d: mpf, power: int) -> mpf:
            last = mp.acos(d)
            one = lambda t, k: (mp.cos(t) - d) * mp.sin(t) ** 2 * mp.cos(t) ** k  # noqa: E731
            load = mp.quad(lambda t: one(t, 0), [0, last])
            return mp.quad(lambda t: one(t, power), [0, last]) / load

        d = mp.findroot(lambda x: mean(x, 1) - delta / 4, (1 - gap / 2, 1 - gap / 3))
        spin = 2 * mean(d, 2) - delta**2 / 8
        truth = [1.0, float(delta / 4), float(spin)]
    rho = pt.contact.one_sided_resultants([0.0, 1e-300, -5e-324], 4.0 - gap)
    yield from (np.stack(rho, axis=-1) - truth).ravel()


@row("δ = 4 − 1/128, 4 − 1/1024, 4 − 1/8192 at φ = 0", "resultants", 1e-10)
def one_sided_next_to_tipping() -> Iterator[float]:
    for gap in (2.0**-7, 2.0**-10, 2.0**-13):
        yield from close_to_tipping(gap)


def scales() -> np.ndarray:
    """Speed, J, r and mass, ends and random, 1e-150 to 1e150, whose results are normal numbers."""
    rng = np.random.default_rng(150)
    ends = [(1e-150, 1.0, 1.0, 1.0), (1e150, 1e150, 1.0, 1.0), (1e-100, 1e-150, 1.0, 1e-150),
            (1.0, 1e-150, 1e-150, 1e150), (1e75, 1.0, 1e150, 1.0), (1.0, 1e150, 1e150, 1e-150),
            (1e150, 1.0, 1.0, 1e-5), (9e153, 1.0, 1.0, 1.0), (1e-153, 1.0, 1.0, 1.0)]  # fmt: skip
    drawn = np.vstack([ends, 10.0 ** rng.uniform(-150.0, 150.0, (150, 4))])
    v, decel, radius, mass = np.log10(drawn).T
    whole = np.abs([2 * v - decel, v - decel, v - radius, mass + 2 * v, 2 * v - decel - radius])
    return drawn[(whole < 306.0).all(axis=0)]


V0, W0, DELTA = (0.6, -0.4), 1.7, 0.3


@row("Q, r, J, mass and their products from 1e-306 to 1e306", "relative, to Q = r = J = 1", 1e-14)
def answers_are_scale_free() -> Iterator[float]:
    base, run = pt.stop(V0, W0, delta=DELTA), simulate(V0, W0, delta=DELTA, frames=1)
    state = pt.states(V0, W0, 0.4, delta=DELTA)
    for speed, decel, radius, mass in scales().tolist():
        with mp.workdps(40):
            v, j, r, m = (mpf(x) for x in (speed, decel, radius, mass))
            v0, w0 = [float(mpf(x) * v) for x in V0], float(mpf(W0) * v / r)
            seconds, metres = v / j, v * v / j
            units = {"delta": DELTA, "decel": decel, "radius": radius}
            found = pt.stop(v0, w0, **units)
            moved = simulate(v0, w0, **units, mass=mass, frames=1)
            there = pt.states(v0, w0, float(mpf(0.4) * seconds), **units)
            for got, wanted, unit in (
                (found.stop_time, base.stop_time, seconds),
                (found.stop_position[0], base.stop_position[0], metres),
                (found.stop_position[1], base.stop_position[1], metres),
                (moved.stop_time, run.stop_time, seconds),
                (moved.stop_position[0], run.stop_position[0], metres),
                (moved.path_length, run.path_length, metres),
                (moved.kinetic_energy, run.kinetic_energy, m * v * v),
                (there.x, state.x, metres),
                (there.speed, state.speed, v),
                (there.spin, state.spin, v / r),
            ):
                yield float(mpf(float(got)) / (mpf(float(wanted)) * unit) - 1)


@row("w0 = −0 against +0, v0 = (1, −0)", "any difference", 0.0)
def zeros_of_either_sign() -> Iterator[float]:
    base, signed = pt.stop((1.0, 0.0), 0.0), pt.stop((1.0, -0.0), -0.0)
    yield float(signed.stop_time - base.stop_time)
    yield from signed.stop_position - base.stop_position
    for w0 in (0.0, -0.0):
        run = simulate((0.0, -0.0), w0)
        yield from (run.stop_time, *run.stop_position, run.body_angle, run.path_length)


@row("v0 exactly 0: pure spin at 0 … past its stop", "r ω₀, r ω₀²/J", 1e-15)
def pure_spin() -> Iterator[float]:
    times = np.array([0.0, 1e-300, 0.1, 0.5, math.nextafter(1.5, 0.0), 1.5, 2.0, 1e9])
    for w0, radius in ((-2.0, 1.0), (2e100, 1e-100), (2e-100, 1e100)):
        left = np.maximum(0.0, 1.0 - times / 1.5)
        states = pt.states((0.0, 0.0), w0, times, radius=radius)
        run = simulate((0.0, -0.0), w0, radius=radius, times=times)
        for found in (states, run):
            yield from found.spin / w0 - left
            yield from found.orientation * radius / math.copysign(1.5, w0) - (1.0 - left**2)
            yield from np.abs(found.x) + np.abs(found.y) + found.speed
        yield run.stop_time / 1.5 - 1.0


@row("a state exactly on φ₀: the spiral in elementary functions", "Q, Q/(fg), Q²/(fg)", 1e-9)
def on_the_limit_angle() -> Iterator[float]:
    for delta in (0.0, 5e-324, 0.4, 1.0):
        with mp.workdps(40):
            u0 = judge().limit(mpf(delta))
            mp.dps = 40
            phi = mp.atan(mp.exp(u0))
            parallel, across, _ = friction(phi, mpf(delta))
            size, share = mp.sqrt(1 + mp.exp(2 * u0)), mp.sin(phi) * across / parallel
            stop_time = size / parallel
            for part in (0, 1e-9, 0.3, 0.9, 1 - 1e-9):
                time = float(part * stop_time)
                left = 1 - mpf(time) / stop_time
                place = size * mp.cos(phi) * stop_time / (2 + 1j * share)
                place *= 1 - left ** (2 + 1j * share)
                state = pt.states((1.0, 0.0), float(mp.exp(u0)), time, delta=delta)
                yield (float(state.speed) - float(left)) / float(size)
                yield (float(state.spin) - float(left * mp.exp(u0))) / float(size)
                yield float(abs(place - mpmath.mpc(float(state.x), float(state.y))) / size**2)
            found = pt.stop((1.0, 0.0), float(mp.exp(u0)), delta=delta, tol=1e-9)
            yield float((float(found.stop_time) - stop_time) / size)


@row("one frame only: the launch itself", "Q", 1e-15)
def one_frame() -> Iterator[float]:
    for w0 in (0.0, -5.0, 0.3, 1e-300):
        first = simulate((1.0, 0.0), w0, frames=1)
        yield from (first.time.size - 1, *first.time, *first.x, *first.y, *(first.speed - 1.0))
        yield from (first.spin - w0) / math.hypot(1.0, w0)


@row("states asked for at the stop, after it, at 1e9 s and 1e300 s", "any motion", 0.0)
def after_the_stop() -> Iterator[float]:
    for w0 in (0.0, -5.0, 0.3):
        end = simulate((1.0, 0.0), w0).stop_time
        times = [end, math.nextafter(end, 9.0), 1e9, 1e300]
        run = simulate((1.0, 0.0), w0, times=times)
        yield from (*(run.x - run.stop_position[0]), *(run.y - run.stop_position[1]))
        yield from (*run.speed, *run.spin)
        late = pt.states((1.0, 0.0), w0, times[2:])
        yield from (*np.diff(late.x), *np.diff(late.y), *late.speed, *late.spin)


HEIGHT = 0.37


@cache
def known_stops() -> tuple[np.ndarray, np.ndarray]:
    """Launches u = ln(rω/v) on edges of cells, the last 0.7, and T, X, Y by the script, 1e-13."""
    ratio = pt.Table.shipped("stops").axis.ratio()
    ratio = ratio[np.linspace(1, ratio.size - 2, 12).astype(int)]
    u = np.concatenate([np.log(ratio), -np.log(ratio), [0.7]])
    return u, judge().stops(u, HEIGHT)


@row("launches on the edges of the cells of the stop table", "Q/(fg), Q²/(fg)", 1.1e-10)
def launches_on_the_edges_of_cells() -> Iterator[float]:
    u, truth = known_stops()
    rim, speed = np.exp(np.minimum(u, 0.0)), np.exp(-np.maximum(u, 0.0))
    size = np.hypot(rim, speed)
    v0 = np.stack([speed / size, 0.0 * speed], axis=-1)
    found = pt.stop(v0, -rim / size, delta=HEIGHT, table=pt.Table.shipped("stops"))
    yield from found.stop_time - truth[:, 0]
    yield from (found.stop_position - truth[:, 1:] * [1.0, -1.0]).ravel()


@row("Runge–Kutta 4 with 1e6 steps", "Q/(fg), Q²/(fg)", 1e-11)
def a_million_steps() -> Iterator[float]:
    from puck_tables.kernels.quadratic import NO_SECTION
    from puck_tables.motion.path import STOPPED, integrate
    from puck_tables.motion.state import SIZE
    from puck_tables.motion.steppers import RK4

    result, none = np.empty(SIZE + 1), np.empty(0)
    status, steps = integrate(
        0.7, RK4, 1e6, 1.0, 1.0, NO_SECTION, HEIGHT, 3_000_000, none, np.empty((0, SIZE)), result
    )
    if status != STOPPED or steps < 900_000:
        yield math.nan
    yield from result[2:5] - known_stops()[1][-1]


def as_markdown() -> str:
    """The rows with what is measured now."""
    lines = ["| extreme | in units of | bound | measured worst |", "| --- | --- | --- | --- |"]
    for r in ROWS:
        lines.append(f"| {r.extreme} | {r.unit} | {r.bound:.2g} | {r.measure():.1e} |")
    return "\n".join(lines)


if __name__ == "__main__":
    print(as_markdown())

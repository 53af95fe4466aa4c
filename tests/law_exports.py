"""Exported files of pucks under other pressure laws, and the answers of the library to them."""

from __future__ import annotations

from functools import cache

import numpy as np
from exported import launches

import puck_tables as pt

# laws whose mass is spread as their pressure is: k² = 2⟨x²⟩
SPREAD = {"hertz": 0.4**0.5, "galin": (2.0 / 3.0) ** 0.5, "annulus:0.8": 0.82**0.5, "ring": 1.0}
SHARES_OF_HEIGHT = (0.0, 0.23, 0.61, 1.0)


def puck_under(law: str, gyration: float | None = None) -> pt.Puck:
    return pt.Puck(radius=1.0, pressure=law, gyration=gyration or SPREAD[law])


@cache
def text_under(law: str, language: str, what: str, tol: float) -> str:
    return pt.export_source(language, what, tol, puck_under(law)).text


@cache
def by_library(law: str, count: int) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Arguments and answers of the library, by function: heights that the fit does not know."""
    rows, rng = launches(count, 17), np.random.default_rng(62)
    tallest = puck_under(law).body.law.delta_max
    shares = rng.integers(0, len(SHARES_OF_HEIGHT), count)
    rows[:, 3] = np.array(SHARES_OF_HEIGHT)[shares] * tallest * (1.0 - 1e-15)
    kind = {"decel": rows[:, 4], "radius": rows[:, 5], "delta": rows[:, 3]}
    puck = {"pressure": law, "gyration": SPREAD[law]}
    stops = pt.stop(rows[:, :2], rows[:, 2], tol=1e-10, **kind, **puck)
    share = np.where(
        rng.random(count) < 0.3, 1.0 - 10.0 ** -rng.uniform(0.0, 8.0, count),
        rng.uniform(0.0, 1.02, count),
    )  # fmt: skip
    share[::50] = 0.0
    times = share * stops.stop_time
    there = pt.states(rows[:, :2], rows[:, 2], times, **kind, **puck)
    phi = rng.uniform(-0.5 * np.pi, 0.5 * np.pi, count)
    phi[::5] = 0.25 * np.pi * (1.0 + 1e-7 * rng.normal(0.0, 1.0, phi[::5].size))
    phi[:4] = 0.0, 0.5 * np.pi, -0.5 * np.pi, 0.25 * np.pi
    rho = puck_under(law).body.law.resultants(phi, rows[:, 3])
    return {
        "stop": (rows, np.column_stack([
            stops.stop_time, stops.stop_position, stops.path_length, stops.body_angle,
        ])),
        "turn": (rows, stops.turn_angle[:, None]),
        "state": (np.column_stack([rows, times]), np.column_stack([
            there.x, there.y, there.orientation, there.vx, there.vy, there.spin,
        ])),
        "resultants": (np.column_stack([phi, rows[:, 3]]), np.column_stack(list(rho))),
    }  # fmt: skip

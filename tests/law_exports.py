"""Exported files of pucks under other pressure laws, and the answers of the library to them."""

from __future__ import annotations

from functools import cache

import numpy as np
from exported import answers, launches

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
    puck = {"pressure": law, "gyration": SPREAD[law]}
    return answers(rows, rng, puck_under(law).body.law.resultants, **puck)

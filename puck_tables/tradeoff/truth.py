"""What methods are asked, and what their answers are judged by, from outside the code they run.

Resultants: direct quadrature over the patch.  Stops: a file of a thousand launches, computed once
by a script of its own (``tests/golden/make_starts.py``: mpmath, nothing of the package) to 1e-13.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from importlib.resources import files
from typing import Any

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.contact import quadrature
from puck_tables.contact.closed_form import moment_balance
from puck_tables.contact.integrals import slip_direction

Run = Callable[[FloatArray], FloatArray]  # from inputs (rows, n) to answers (3, n, …)
Made = tuple[Any, Run]  # what a method keeps, and how it answers
RESULTANTS = "resultants"
DELTA = 0.5  # dimensionless: that of a puck that nothing is said of
_TIMED = 40_000  # inputs timed


@dataclass(frozen=True, eq=False)
class Question:
    """Inputs (rows, n) with their true answers (3, n, …), and as many as are ``timed``.

    Inputs: φ and δ, or launches vx, vy, rω, δ, J, r.  Answers: ρ_∥, ρ_⊥, ρ_ω, or a time and a place
    in units of Q/J and Q²/J.
    """

    name: str
    inputs: FloatArray
    truth: FloatArray
    timed: FloatArray

    def some(self, chosen: slice | npt.NDArray[np.bool_] | npt.NDArray[np.int64]) -> Question:
        """With some of the inputs that are judged."""
        inputs = np.ascontiguousarray(self.inputs[:, chosen])
        return replace(self, inputs=inputs, truth=self.truth[:, chosen])

    def errors(self, answers: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Errors of time and place (n, …), of resultants 0 and the largest; NaN errs by ∞."""
        off = np.nan_to_num(np.abs(answers - self.truth), nan=np.inf)
        if self.name == RESULTANTS:
            return 0.0 * off[0], off.max(axis=0)
        return off[0], np.hypot(off[1], off[2])


@dataclass(frozen=True, eq=False)
class Contender:
    """A method before it is measured; ``items``: inputs answered at once on the clock, or all."""

    question: Question
    method: str
    setting: str
    make: Callable[[], Made]
    items: int | None = None
    outsider: bool = False


def filled(fill: Callable[[FloatArray, FloatArray], object], rows: int = 3) -> Run:
    """A run of a function that fills its answers in; the room for them is made once."""
    rooms: dict[int, FloatArray] = {}

    def run(inputs: FloatArray) -> FloatArray:
        size = inputs.shape[1]
        if size not in rooms:
            rooms[size] = np.empty((rows, size))
        fill(inputs, rooms[size])
        return rooms[size][:3]

    return run


def random_points(count: int) -> Question:
    """Half of them anywhere, half next to φ = 0, π/4, π/2, with δ = 0 and 1 among the heights."""
    rng = np.random.default_rng(1832)
    phi = rng.uniform(0.0, 0.5 * np.pi, count)
    near, quarter, half = 10.0 ** -rng.uniform(0.2, 12.0, count), 0.25 * np.pi, 0.5 * np.pi
    sides = [near, quarter - near, quarter + near, half - near]
    nearby = np.choose(rng.integers(0, 4, count), sides)
    phi = np.where(np.arange(count) % 2 == 0, phi, nearby.clip(0.0, half))
    delta = rng.choice([0.0, 1.0, -1.0], count, p=[0.1, 0.1, 0.8])
    delta = np.where(delta < 0.0, rng.random(count), delta)
    truth = np.stack(moment_balance(quadrature.integrals(phi), slip_direction(phi), delta))
    rng = np.random.default_rng(7)
    timed = np.stack([rng.uniform(0.0, half, _TIMED), rng.random(_TIMED)])
    return Question(RESULTANTS, np.stack([phi, delta]), truth, timed)


def kept_arrays(name: str) -> dict[str, FloatArray]:
    """The arrays in a file that comes with the package."""
    with (files("puck_tables.tables") / name).open("rb") as file, np.load(file) as arrays:
        return dict(arrays)


def golden_starts() -> tuple[Question, Question, FloatArray]:
    """Stops: of launches that come with the package; of a few that are not adversarial; ln(rω/v).

    The judged launches go along x with Q = J = r = 1.
    """
    file = kept_arrays("starts.npz")
    u, delta, truth = file["u"], file["delta"], np.stack([file[name] for name in "TXY"])
    k, one = np.exp(-np.abs(u)), np.ones_like(u)
    v, rim = np.where(u > 0.0, (k, one), (one, k)) / np.hypot(1.0, k)
    rng, one_timed = np.random.default_rng(11), np.ones(_TIMED)
    timed = np.stack([
        *rng.uniform(-1.0, 1.0, (2, _TIMED)), rng.uniform(-5.0, 5.0, _TIMED), rng.random(_TIMED),
        one_timed, one_timed,
    ])  # fmt: skip
    stops = Question("stop", np.stack([v, 0.0 * k, rim, delta, one, one]), truth, timed)
    size = np.abs(u)
    moderate = np.flatnonzero((size < 4.0) & (size > 0.05) & (np.abs(u - 0.4) > 0.1))
    return stops, stops.some(rng.choice(moderate, 16, replace=False)), u

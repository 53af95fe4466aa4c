"""Test vectors of exported files: launches of every kind, and what they lead to.

The answers come from the integrator with closed forms, not from the table that is exported; those
of resultants from quadrature, not from the closed form.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from puck_tables.contact.integrals import slip_direction
from puck_tables.contact.quadrature import integrals
from puck_tables.contact.resultants import moment_balance
from puck_tables.puck import Puck
from puck_tables.stopping.stops import stop

Cases = tuple[int, tuple[float, ...]]

# vx, vy, ω, δ, J, r: every class of motion, both senses, both ends of δ, small and large numbers
_LAUNCHES: Sequence[tuple[float, ...]] = (
    (2.0, 0.0, 30.0, 0.13, 0.98, 0.04),
    (1.0, 0.0, 5.0, 1.0, 1.0, 1.0),
    (1.0, 0.0, 1.0, 0.5, 1.0, 1.0),
    (0.3, -0.4, -0.7, 0.75, 2.5, 0.6),
    (-1.5, 0.2, 0.02, 0.4, 3.0, 0.1),
    (0.01, 0.02, -6.0, 0.9, 1.0, 0.5),
    (1.0, 1.0, 0.0, 0.6, 0.5, 2.0),
    (0.0, 0.0, -3.0, 0.3, 1.0, 0.25),
    (1.0, 0.0, 1.53138937217391, 0.0, 1.0, 1.0),
    (0.0, -1.0, 2.0, 0.0, 1.0, 1.0),
    (3e-7, 4e-7, 0.08, 1.0, 9.81, 1e-5),
    (2e5, -1e5, 900.0, 0.2, 0.1, 300.0),
)
_SHARES = (0.0, 0.1, 0.5, 0.9, 0.99)  # of the stop time
_ANGLES = (-0.5 * math.pi, -0.25 * math.pi, -0.3, 0.0, 0.8, 1.4)
_HEIGHTS = (0.0, 1.0)


def cases_of(functions: Sequence[str], tol: float) -> dict[str, Cases]:
    """Width of a vector and all their numbers, by function.

    Parameters
    ----------
    functions : of the exported file
    tol : of it; numbers have as many digits as tell it
    """
    made = {"stop": _stops, "state": _states, "turn": _turns, "resultants": _resultants}
    digits = round(-math.log10(tol)) + 3
    cases = {}
    for name in functions:
        width, rows = made[name]()
        given = {"stop": 6, "state": 7, "turn": 6, "resultants": 2}[name]
        numbers = [
            value if n % width < given else float(f"{value:.{digits}g}")
            for n, value in enumerate(rows)
        ]
        cases[name] = width, tuple(numbers)
    return cases


@lru_cache(maxsize=1)
def _stops() -> Cases:
    launches = np.array(_LAUNCHES)
    found = stop(
        launches[:, :2], launches[:, 2], delta=launches[:, 3], decel=launches[:, 4],
        radius=launches[:, 5], tol=1e-12, method="adaptive",
    )  # fmt: skip
    answers = (
        found.stop_time, found.stop_x, found.stop_y, found.path_length, found.body_angle,
    )  # fmt: skip
    rows = np.column_stack([launches, *answers])
    return rows.shape[1], tuple(rows.ravel().tolist())


@lru_cache(maxsize=1)
def _turns() -> Cases:
    launches = np.array([one for one in _LAUNCHES if one[2] != 0.0 and one[:2] != (0.0, 0.0)][:7])
    found = stop(
        launches[:, :2], launches[:, 2], delta=launches[:, 3], decel=launches[:, 4],
        radius=launches[:, 5], tol=1e-12, method="adaptive",
    )  # fmt: skip
    rows = np.column_stack([launches, found.turn_angle])
    return rows.shape[1], tuple(rows.ravel().tolist())


@lru_cache(maxsize=1)
def _states() -> Cases:
    rows: list[float] = []
    for (vx, vy, spin, delta, decel, radius), share in _moments():
        puck = Puck.similar(delta=delta, decel=decel, radius=radius)
        whole = stop((vx, vy), spin, delta=delta, decel=decel, radius=radius).stop_time.item()
        time = float(f"{share * whole:.4g}")
        run = puck.simulate((vx, vy), spin, times=[time], tol=1e-12, exact=True)
        there = (run.x, run.y, run.orientation, run.vx, run.vy, run.spin)
        rows += [vx, vy, spin, delta, decel, radius, time, *(float(one[0]) for one in there)]
    return 13, tuple(rows)


def _moments() -> list[tuple[tuple[float, ...], float]]:
    """Every launch at one of the shares of its time, one at all of them, and after its stop."""
    picked = [(one, _SHARES[n % len(_SHARES)]) for n, one in enumerate(_LAUNCHES)]
    return [*picked, *((_LAUNCHES[1], share) for share in (*_SHARES[3:], 1.5))]


@lru_cache(maxsize=1)
def _resultants() -> Cases:
    phi, delta = np.meshgrid(_ANGLES, _HEIGHTS, indexing="ij")
    rho = moment_balance(integrals(phi.ravel()), slip_direction(phi.ravel()), delta.ravel())
    rows = np.column_stack([phi.ravel(), delta.ravel(), *rho])
    return rows.shape[1], tuple(rows.ravel().tolist())

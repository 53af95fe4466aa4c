"""Test vectors of exported files: launches of every kind, and what they lead to.

The answers come from the integrator with closed forms, not from the table that is exported; those
of resultants from quadrature, not from the closed form.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.contact.closed_form import moment_balance
from puck_tables.contact.integrals import slip_direction
from puck_tables.contact.quadrature import integrals
from puck_tables.puck import Puck
from puck_tables.stopping.stops import Stops, stop

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
INPUTS = {"stop": 6, "state": 7, "turn": 6, "resultants": 2, "wrench": 4, "step": 3}  # numbers
_HEIGHTS = (0.0, 1.0)  # dimensionless: both ends of the tables


def cases_of(functions: Sequence[str], tol: float, kind: Puck) -> dict[str, Cases]:
    """Width of a vector and all their numbers, by function.

    ``functions``: of the exported file; ``tol``: of it; numbers have as many digits as tell it;
    ``kind``: whose pressure law and gyration.
    """
    made = {
        "stop": _stops, "state": _states, "turn": _turns, "resultants": _resultants,
        "wrench": _wrenches, "step": _steps,
    }  # fmt: skip
    digits = round(-math.log10(tol)) + 2
    cases = {}
    for name in functions:
        rows = made[name](kind)
        inputs = INPUTS[name]
        cases[name] = rows.shape[1], tuple(
            value if n < inputs else float(f"{value:.{digits}g}")
            for row in rows.tolist() for n, value in enumerate(row)
        )  # fmt: skip
    return cases


def _kind(puck: Puck) -> tuple[dict[str, Any], float, float]:
    """Pressure and gyration, how δ of a launch is scaled, and the error of answers."""
    if puck.body.has_closed_forms:
        return {}, 1.0, 1e-12
    law = puck.body.law
    return {"pressure": law, "gyration": puck.gyration}, law.delta_max, 1e-11


def _integrated(puck: Puck) -> FloatArray:
    """The launches of a kind of puck: of others three heights, for each must be prepared."""
    launches = np.array(_LAUNCHES)
    kind, tallest, _ = _kind(puck)
    if kind:
        launches = np.round(launches, 7)  # no limit ratio of theirs: fewer signs
        launches[:, 3] = np.floor(np.round(2.0 * launches[:, 3]) * 500.0 * tallest) / 1000.0
    return launches


def _looked_up(puck: Puck, launches: FloatArray) -> Stops:
    kind, _, tol = _kind(puck)
    return stop(
        launches[:, :2], launches[:, 2], delta=launches[:, 3], decel=launches[:, 4],
        radius=launches[:, 5], tol=tol, method="adaptive", **kind,
    )  # fmt: skip


def _stops(puck: Puck) -> FloatArray:
    launches = _integrated(puck)
    result = _looked_up(puck, launches)
    answers = (
        result.stop_time, result.stop_x, result.stop_y, result.path_length, result.body_angle,
    )  # fmt: skip
    return np.column_stack([launches, *answers])


def _turns(puck: Puck) -> FloatArray:
    launches = _integrated(puck)
    generic = (launches[:, 2] != 0.0) & (launches[:, :2] != 0.0).any(axis=1)
    launches = launches[generic][: 3 if _kind(puck)[0] else 7]
    return np.column_stack([launches, _looked_up(puck, launches).turn_angle])


def _states(puck: Puck) -> FloatArray:
    rows = []
    kind, _, tol = _kind(puck)
    launches = _integrated(puck)
    whole = _looked_up(puck, launches).stop_time
    for n, share in _moments()[: len(launches) + 1 if kind else None]:
        vx, vy, spin, delta, decel, radius = launches[n].tolist()
        thrown = Puck.similar(delta=delta, decel=decel, radius=radius, **kind)
        time = float(f"{share * whole[n]:.4g}")
        run = thrown.simulate((vx, vy), spin, times=[time], tol=tol, exact=not kind)
        there = (run.x, run.y, run.orientation, run.vx, run.vy, run.spin)
        rows.append([vx, vy, spin, delta, decel, radius, time, *(float(one[0]) for one in there)])
    return np.array(rows)


def _moments() -> list[tuple[int, float]]:
    """Every launch at one of the shares of its time, one at all of them, and after its stop."""
    picked = [(n, _SHARES[n % len(_SHARES)]) for n in range(len(_LAUNCHES))]
    return [*picked, *((1, share) for share in (1.5, *_SHARES[3:]))]


def _resultants(puck: Puck) -> FloatArray:
    kind, tallest, _ = _kind(puck)
    phi, share = (
        one.ravel() for one in np.meshgrid(_ANGLES[1 if kind else 0 :], _HEIGHTS, indexing="ij")
    )
    if kind:
        share = np.floor(1000.0 * share * tallest) / 1000.0
        rho = puck.body.law.resultants(phi, share)
    else:
        rho = moment_balance(integrals(phi), slip_direction(phi), share)
    return np.column_stack([phi, share, *rho])


def _slips(puck: Puck) -> FloatArray:
    """Vx, vy and spin of launches of a base: about places in it, on its rim, far away."""
    spins = np.array([0.0, 1e-3, 0.3, -1.0, 2.0, -9.0, 1e3])
    units = np.exp(1j * np.arange(spins.size))
    return np.column_stack([units.real, units.imag, np.round(spins / puck.gyration, 6)]).round(6)


def _of_unit(puck: Puck) -> Puck:
    """A body whose friction is 1 N, 1 m/s², and pressed alike."""
    return replace(puck, friction=1.0, height=puck.friction * puck.height, mass=1.0, gravity=1.0)


def _wrenches(puck: Puck) -> FloatArray:
    slips = _slips(puck)
    angles = np.round(0.7 * np.arange(len(slips)), 6)
    wrenches = _of_unit(puck).wrench(slips[:, :2], slips[:, 2], angles)
    return np.column_stack([slips, angles, wrenches.force, wrenches.torque])


def _steps(puck: Puck) -> FloatArray:
    rows, unit = [], _of_unit(puck)
    for vx, vy, spin in _slips(puck)[1:5].tolist():
        run = unit.simulate((vx, vy), spin, times=[0.5], tol=1e-10)
        there = (run.x, run.y, run.orientation, run.vx, run.vy, run.spin)
        rows.append([vx, vy, spin, *(float(one[0]) for one in there)])
    return np.array(rows)

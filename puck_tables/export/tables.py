"""The tables of a file: of plain pucks from what comes along, of all others made for them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from math import factorial

from puck_tables.errors import AccuracyError
from puck_tables.export.fit import (
    COARSE_ROUNDING,
    CONSTANT_SHARE,
    CURVE_SHARE,
    LAW_STOP_SHARE,
    ORBIT_SHARE,
    PATCH_SHARE,
    STOP_SHARE,
    Fitted,
    fitted,
    fitted_constants,
    functions_of,
)
from puck_tables.export.law_values import REACH, LawValues, law_values
from puck_tables.puck import Puck
from puck_tables.stopping.axes import height_polynomials
from puck_tables.stopping.stop_table import StopTable

Tables = tuple[dict[str, Sequence[float]], dict[str, float]]  # arrays, constants


def plain_tables(parts: tuple[str, ...], tol: float) -> Tables:
    """Homogeneous pucks under uniform pressure: from the stop table that comes along."""
    constants = {"TALLEST": 1.0, "STEEP": 2.0, "SPIN_TIME": 0.75, "LONGEST": 2.0}
    if parts == ("resultants",):
        return {}, constants
    return _written(_shipped(tol), constants)


@lru_cache(maxsize=8)
def _shipped(tol: float) -> dict[str, Fitted]:
    table = StopTable.shipped()
    stops, curve, inverse = functions_of(table)
    return {
        "STOP": fitted(stops, STOP_SHARE * tol, haste=2),
        "CURVE": fitted(curve, CURVE_SHARE * tol),
        "INVERSE": fitted(inverse, CURVE_SHARE * tol),
        "CONSTANTS": fitted_constants(table.constants, CONSTANT_SHARE * tol),
    }


def law_tables(kind: Puck, parts: tuple[str, ...], tol: float) -> Tables:
    """Any other kind of puck: its stops are integrated for it."""
    values = law_values(kind.body.law, kind.gyration, tol)
    constants = {
        "TALLEST": values.tallest, "STEEP": 2.0 / values.tallest**2,
        "SPIN_TIME": values.spin_time, "LONGEST": values.longest, "REACH": REACH,
        "SIDES": values.extents.size,
    }  # fmt: skip
    tables, constants = _written(_fitted_to(values, parts, tol), constants)
    lines = {"MARKS": values.marks.tolist(), "INVERSE_EXTENTS": (1.0 / values.extents).tolist()}
    return lines | tables, constants


def _fitted_to(values: LawValues, parts: tuple[str, ...], tol: float) -> dict[str, Fitted]:
    found = {}
    if "resultants" in parts:
        found["PATCH"] = fitted(values.patch, PATCH_SHARE * tol, rounding=COARSE_ROUNDING)
    if parts != ("resultants",):
        found["STOP"] = fitted(values.stops, LAW_STOP_SHARE * tol, rounding=COARSE_ROUNDING)
    if "state" in parts:
        try:
            orbits, constants = values.orbits
            found["ORBIT"] = fitted(orbits, ORBIT_SHARE * tol, rounding=COARSE_ROUNDING)
        except AccuracyError:
            raise AccuracyError(
                f"states of such pucks cannot be exported at tol {tol:g}, for their limit ratio "
                "lies next to 0, infinity or an edge of the load at some height: ask for a larger "
                "tol, for stops and resultants alone, or for another radius of gyration"
            ) from None
        polynomials = height_polynomials(constants, len(constants)).T
        found["CONSTANTS"] = fitted_constants(polynomials, CONSTANT_SHARE * tol)
    return found


def _written(fits: Mapping[str, Fitted], constants: Mapping[str, float]) -> Tables:
    """Numbers and constants of tables as the programs call them."""
    numbers: dict[str, Sequence[float]] = {
        name: table.numbers.ravel().tolist() for name, table in fits.items()
    }
    named = dict(constants)
    for name, table in fits.items():
        named |= {
            f"{name}_CELLS": table.cells, f"{name}_DEGREE": table.degree,
            f"{name}_POWERS": table.powers,
            f"{name}_QUANTUM": float(f"{table.quantum / factorial(table.degree):.15g}"),
        }  # fmt: skip
    return numbers, named

"""The tables of a file, made for its kind of puck."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from math import factorial

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.contact.base import Base
from puck_tables.errors import AccuracyError, InputError
from puck_tables.export.compact_tables import (
    SplineFit,
    fit_constants,
    spline_fit,
    spline_fits,
)
from puck_tables.export.law_values import REACH, LawValues, law_values
from puck_tables.export.program.base_step import BASE_RULE
from puck_tables.puck import Puck
from puck_tables.stopping.lookup import height_polynomials

Tables = tuple[dict[str, Sequence[float]], dict[str, float]]  # arrays, constants

# Of the error asked for: of the functions of a stop, of the orbits, of friction, and of what
# depends on the height alone, so that what is made of all of them keeps it (measured,
# tests/test_export.py and tests/test_export_laws.py).
_STOP, _MOTION, _PATCH, _CONSTANT = 0.42, 0.48, 0.22, 0.05
# of a slip that friction takes in a step, and so many times the least part of a base over its reach
_SHARE, _FEET = 0.05, 8.0


def round_tables(kind: Puck, parts: tuple[str, ...], tol: float) -> Tables:
    """Any puck on a round base."""
    values = law_values(kind.body.law, kind.gyration, tol)
    sides = values.extents.size
    constants = {
        "TALLEST": values.tallest, "STEEP": 2.0 / values.tallest**2,
        "SPIN_TIME": values.spin_time, "LONGEST": values.longest, "SIDES": sides,
    }  # fmt: skip
    tables, constants = _written(_fit_within(values, parts, tol), constants)
    lines = {
        "BORDERS": _short(values.borders), "ORIGINS": _short(values.origins),
        "SCALES": _short(1.0 / values.extents),
    }  # fmt: skip
    if "state" in parts:
        constants |= {"REACH": REACH, "END": values.limit_motions.end}
        lines["RATE_UNITS"] = values.limit_motions.rate_units
    return lines | tables, constants


@lru_cache(maxsize=8)  # one for files in all languages
def _fit_within(
    values: LawValues, parts: tuple[str, ...], tol: float
) -> dict[str, SplineFit | list[SplineFit]]:
    result: dict[str, SplineFit | list[SplineFit]] = {}
    if "resultants" in parts and values.law.name != "uniform":  # of that in closed form
        result["PATCH"] = spline_fit(values.patch, _PATCH * tol)
    if parts != ("resultants",):
        result["STOP"] = spline_fit(values.stops, _STOP * tol, haste=2)
    if "state" in parts:
        try:
            result["MOTION"] = spline_fits(values.limit_motions.parts, _MOTION * tol)
        except AccuracyError:
            raise AccuracyError(
                f"states of such pucks cannot be exported at tol {tol:g}, for their limit ratio "
                "lies next to 0, infinity or an edge of the load at some height: ask for stops "
                "and resultants alone (--what stop,resultants), for another radius of gyration, "
                "or for a larger tol (1e-2 at most)"
            ) from None
        of_heights = values.limit_motions.of_heights
        polynomials = height_polynomials(of_heights, len(of_heights)).T
        result["CONSTANTS"] = fit_constants(polynomials, _CONSTANT * tol)
    return result


def base_tables(kind: Puck) -> Tables:
    """The sides and discs of a base, and how it is pressed.

    Raises InputError if it has none; ContactError if part of it would lift.
    """
    shape = kind.shape
    if shape is None:
        raise InputError(
            "wrench and step are exported of a base, as base='box:0.2x0.1' or 'disc:0.04'"
        )
    shape.refuse_lift(kind.friction, kind.height)
    sides: list[float] = []
    for outline in shape.outlines:
        for one, two in zip(outline, outline[1:] + outline[:1], strict=True):
            along = np.subtract(two, one)
            length = float(np.hypot(*along))
            sides += [*np.subtract(one, shape.middle).tolist(), *(along / length).tolist(), length]
    discs = [
        number for x, y, radius, sign in shape.discs
        for number in (*np.subtract((x, y), shape.middle).tolist(), radius, sign)
    ]  # fmt: skip
    nodes, weights = np.polynomial.legendre.leggauss(BASE_RULE)
    tables: dict[str, Sequence[float]] = {
        "BASE_SIDES": sides or [0.0], "BASE_DISCS": discs or [0.0],
        "BASE_NODES": nodes.tolist(), "BASE_WEIGHTS": weights.tolist(),
    }  # fmt: skip
    area, first, second = shape.about_centre
    return tables, {
        "BASE_COUNT": len(sides) // 5, "BASE_DISC_COUNT": len(discs) // 4,
        "BASE_TILTED": int(kind.height > 0.0 or not shape.is_centred),
        "BASE_AREA": area, "BASE_FARTHEST": shape.reach, "BASE_SQUARE": kind.gyration**2,
        "BASE_X": float(first[0]), "BASE_Y": float(first[1]), "BASE_XX": float(second[0, 0]),
        "BASE_XY": float(second[0, 1]), "BASE_YY": float(second[1, 1]),
        "BASE_LEVER": 0.5 * kind.friction * kind.height, "BASE_SHARE": _share_of(shape),
    }  # fmt: skip


def _share_of(base: Base) -> float:
    """How much of a slip friction takes in a step; less where it turns about small feet."""
    feet = [radius for _, _, radius, weight in base.discs if weight > 0.0]
    sizes = [np.ptp(np.array(outline), axis=0).min() for outline in base.outlines] + feet
    least = 1.0 if len(sizes) == 1 else float(min(sizes)) / base.reach
    return _SHARE * min(1.0, _FEET * least)


def _written(
    fits: Mapping[str, SplineFit | list[SplineFit]], constants: Mapping[str, float]
) -> Tables:
    """Numbers and constants of tables as the programs call them.

    Of a table whose sides have cells of their own, where the rows of each begin and end; of tables
    apart, where the numbers of each begin, their cells, powers and quanta.
    """
    numbers: dict[str, Sequence[float]] = {}
    named = dict(constants)
    for name, table in fits.items():
        if isinstance(table, list):
            named[f"{name}_DEGREE"] = table[0].degree
            sizes = [one.numbers.size for one in table]
            numbers |= {
                name: [number for one in table for number in one.numbers.ravel().tolist()],
                f"{name}_ROWS": [0, *np.cumsum(sizes)[:-1].tolist()],
                f"{name}_CELLS": [one.cells[0] for one in table],
                f"{name}_POWERS": [one.powers for one in table],
                f"{name}_QUANTA": [_quantum(one) for one in table],
            }
            continue
        numbers[name] = table.numbers.ravel().tolist()
        named |= {
            f"{name}_DEGREE": table.degree, f"{name}_POWERS": table.powers,
            f"{name}_QUANTUM": _quantum(table),
        }  # fmt: skip
        numbers[f"{name}_ROWS"] = table.rows
    return numbers, named


def _short(places: FloatArray) -> list[float]:
    """Numbers that err by less than a launch is told from its neighbours."""
    return [float(f"{place:.12g}") for place in places]


def _quantum(table: SplineFit) -> float:
    """The unit of the numbers of a table, without the factorial of its degree."""
    return float(f"{table.quantum / factorial(table.degree):.15g}")

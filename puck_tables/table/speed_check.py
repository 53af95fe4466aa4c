"""A table of friction that depends on the slip speed judged by quadrature, at points of its own."""

from __future__ import annotations

import numpy as np

from puck_tables.contact.integrals import slip_direction
from puck_tables.contact.speed_quadrature import SpeedFunction, speed_resultants
from puck_tables.errors import InputError
from puck_tables.table.check import Check, CheckReport, worst_of
from puck_tables.table.speed_table import SpeedTable
from puck_tables.table.table import FUNCTIONS


def validate_speed(
    table: SpeedTable, law: SpeedFunction | None = None, points: int = 2000
) -> CheckReport:
    """Judge a table of friction that depends on the slip speed.

    Parameters
    ----------
    table : SpeedTable
    law : callable, optional
        The friction law, where the table was made of a function and does not hold it.
    points : how many points are compared at random, and as many next to φ = 0, π/4, π/2

    Returns
    -------
    CheckReport
        Deviations of F_∥/N, F_⊥/N and 2M/(N r) in units of the largest f; the second place of a
        deviation is v + r|ω| in m/s.

    Raises
    ------
    InputError
        If the law is a function and is not given.

    Examples
    --------
    >>> from puck_tables.table.speed_table import build_speed_table
    >>> def f(u):
    ...     return 0.2 + 0.1 * u
    >>> table = build_speed_table(f, 1.0, top_speed=1.0, accuracy=1e-4)
    >>> validate_speed(table, f, points=300).passed
    True
    """
    judge = table.law if law is None else law
    if judge is None:
        raise InputError("the friction law of this table is a function: give it as law=")
    rng = np.random.default_rng(1785)
    near = rng.choice([0.0, 0.25 * np.pi, 0.5 * np.pi], points)
    near += rng.choice([-1.0, 1.0], points) * 10.0 ** -rng.uniform(0.5, 15.0, points)
    checks: list[Check] = []
    for name, phi in (
        ("quadrature, random points", rng.uniform(0.0, 0.5 * np.pi, points)),
        ("quadrature, next to 0, pi/4, pi/2", np.clip(near, 0.0, 0.5 * np.pi)),
    ):
        U = table.speed_axis.top * rng.random(points) ** rng.choice([1.0, 4.0], points)
        ratio = slip_direction(phi).ratio
        Q = U * np.sqrt(1.0 + ratio**2) / (1.0 + ratio)
        got, truth = table.resultants(phi, Q), speed_resultants(phi, Q, judge, table.height_ratio)
        unit = table.largest_f or 1.0
        weights = np.cos(phi) / unit, np.sin(phi) * np.cos(phi) / unit, np.sin(phi) / unit
        checks += [
            worst_of(name, function, w * np.abs(a - b), phi, U, table.tolerance)
            for function, w, a, b in zip(FUNCTIONS, weights, got, truth, strict=True)
        ]
    return CheckReport(table.source, table.tolerance, tuple(checks))

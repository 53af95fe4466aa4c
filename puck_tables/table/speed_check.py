"""A table of friction that depends on the slip speed judged by quadrature, at points of its own."""

from __future__ import annotations

import numpy as np

from puck_tables.contact.speed_quadrature import SpeedFunction, speed_integrals
from puck_tables.errors import InputError
from puck_tables.table.check import Check, CheckReport, worst_of
from puck_tables.table.speed_table import INTEGRALS, SpeedTable


def validate_speed(
    table: SpeedTable, law: SpeedFunction | None = None, points: int = 2000
) -> CheckReport:
    """Judge a table of friction that depends on the slip speed.

    Parameters
    ----------
    table : SpeedTable
    law : callable, optional
        The friction law, where the table was made of a function and does not hold it.
    points : how many points are compared at random, as many next to φ = 0, π/4, π/2, and as many
        where a rim slips at one of the breaks; besides, one in every patch

    Returns
    -------
    CheckReport
        Deviations of cos φ p_a, sin φ p_b, sin φ p_d and cos φ p_e in units of the largest f; the
        second place of a deviation is v + r|ω| in m/s.

    Raises
    ------
    InputError
        If the law is a function and is not given.

    Examples
    --------
    >>> from puck_tables.table.speed_build import build_speed_table
    >>> def f(u):
    ...     return 0.2 + 0.1 * u
    >>> table = build_speed_table(f, top_speed=1.0, accuracy=1e-4)
    >>> validate_speed(table, f, points=300).passed
    True
    """
    judge = table.law if law is None else law
    if judge is None:
        raise InputError("the friction law of this table is a function: give it as law=")
    rng = np.random.default_rng()
    near = rng.choice([0.0, 0.25 * np.pi, 0.5 * np.pi], points)
    near += rng.choice([-1.0, 1.0], points) * 10.0 ** -rng.uniform(0.5, 15.0, points)
    U = table.top * rng.random((2, points)) ** rng.choice([1.0, 4.0], points)
    at_break = table.breaks[rng.integers(0, len(table.breaks), points)]
    at_break = at_break * (
        1.0 + rng.choice([-1.0, 1.0], points) * 10.0 ** -rng.uniform(1, 9, points)
    )
    other = table.top * rng.random(points)
    fastest, slowest = np.maximum(at_break, other), np.minimum(at_break, other)
    fastest = np.minimum(fastest, table.top)
    equal = 0.25 * np.pi + rng.choice([-1.0, 1.0], points) * np.arctan(slowest / fastest)
    inside = [patch.place(*rng.random((2, 1))) for patch in table.patches]
    ratio, Q = (np.ravel(part) for part in ([d.ratio for d, _ in inside], [q for _, q in inside]))
    fast = np.ravel([d.fast_spin for d, _ in inside])
    every = np.where(fast, np.arctan2(1.0, ratio), np.arctan(ratio))
    checks: list[Check] = []
    for name, phi, speeds in (
        ("quadrature, random points", rng.uniform(0.0, 0.5 * np.pi, points), U[0]),
        ("quadrature, next to 0, pi/4, pi/2", np.clip(near, 0.0, 0.5 * np.pi), U[1]),
        ("quadrature, a rim at a break", np.clip(equal, 0.0, 0.5 * np.pi), fastest),
        ("quadrature, in every patch", every, Q * (np.cos(every) + np.sin(every))),
    ):
        cosine, sine = np.cos(phi), np.sin(phi)
        Q = speeds / (cosine + sine) * (1.0 - 1e-15)
        got, truth = table.integrals(phi, Q), speed_integrals(phi, Q, judge)
        unit = table.largest_f or 1.0
        checks += [
            worst_of(name, integral, weight / unit * np.abs(a - b), phi, speeds, table.tolerance)
            for integral, weight, a, b in zip(
                INTEGRALS, (cosine, sine, sine, cosine), (got.a, got.b, got.d, got.e),
                (truth.a, truth.b, truth.d, truth.e), strict=True,
            )
        ]  # fmt: skip
    return CheckReport(table.source, table.tolerance, tuple(checks))

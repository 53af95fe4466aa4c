"""What a table is judged with: a report of deviations, each against what is allowed."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables._core.lazy import report_of


@dataclass(frozen=True)
class Check:
    """One line of a report: what was compared, the largest deviation, and what is allowed.

    ``at_second``: the place on the second axis, the height or a speed in m/s.
    """

    name: str
    function: str
    points: int
    deviation: float
    allowed: float
    at_phi: float
    at_second: float

    @property
    def passed(self) -> bool:
        """Whether the deviation is a number within what is allowed."""
        return bool(self.deviation <= self.allowed)


@dataclass(frozen=True)
class CheckReport:
    """All checks of one table.

    ``second``: what its second axis is, in words.
    """

    source: str
    tolerance: float
    checks: tuple[Check, ...]
    second: str = "delta"

    def __str__(self) -> str:
        """Every check, as ``puck validate`` prints them."""
        return report_of(self)

    @property
    def passed(self) -> bool:
        """Whether every check passed."""
        return all(check.passed for check in self.checks)


def compared(
    name: str, functions: Iterable[str], errors: Iterable[FloatArray], phi: FloatArray,
    second: FloatArray, allowed: float,
) -> list[Check]:  # fmt: skip
    """The lines of a report for errors of functions (functions, points); NaN is the largest.

    >>> places = np.array([0.1, 0.2])
    >>> compared("rule", ["spin"], np.array([[1e-9, 1e-7]]), places, places, 1e-8)[0].passed
    False
    """
    checks = []
    for function, error in zip(functions, errors, strict=True):
        size = np.abs(error)
        worst = int(np.argmax(np.where(np.isnan(size), np.inf, size)))
        checks.append(Check(
            name, function, size.size, float(size[worst]), allowed,
            float(phi[worst]), float(second[worst]),
        ))  # fmt: skip
    return checks


class Route(NamedTuple):
    """One way to judge a table: where, by what, and how far off it may be.

    ``error`` of φ and the second place (n,), as (functions, n).
    """

    name: str
    functions: Iterable[str]
    phi: FloatArray
    second: FloatArray
    error: Callable[[FloatArray, FloatArray], FloatArray]
    allowed: float


def judged(
    source: str, tolerance: float, routes: Sequence[Route],
    progress: Callable[[int, int], None] | None = None, second: str = "delta",
) -> CheckReport:  # fmt: skip
    """The report of a table by all these routes, one after the other.

    >>> places = np.array([0.1, 0.2])
    >>> rule = Route("rule", ["spin"], places, places, lambda phi, at: np.array([phi - at]), 1e-8)
    >>> judged("a table", 1e-8, [rule]).passed
    True
    """
    checks: list[Check] = []
    for done, one in enumerate(routes, 1):
        errors = one.error(one.phi, one.second)
        checks += compared(one.name, one.functions, errors, one.phi, one.second, one.allowed)
        if progress is not None:
            progress(done, len(routes))
    return CheckReport(source, tolerance, tuple(checks), second)

"""How good a table is: errors measured when it is built and kept, and what it is judged with.

A report of deviations, each against what is allowed.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict, dataclass
from typing import Any, NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables._core.lazy import report_of
from puck_tables._core.waiting import Progress


@dataclass(frozen=True)
class Accuracy:
    """Errors of a table that were measured, not promised, in the units of its kind.

    One entry a function: largest, root mean square and 99.9 % error over random and adversarial
    points, and where the largest stands: φ in radians, and the place on the second axis.
    ``promised``: the tolerance of the table is that of so many of the functions.  ``order``:
    against half as many cells; 0 where it was not measured.
    """

    largest: tuple[float, ...]
    rms: tuple[float, ...]
    p999: tuple[float, ...]
    at_phi: tuple[float, ...]
    at_second: tuple[float, ...]
    promised: int
    order: float
    points: int

    @property
    def worst(self) -> float:
        """The largest error of what the tolerance is promised for."""
        return max(self.largest[: self.promised])

    @classmethod
    def of(
        cls, errors: FloatArray, phi: FloatArray, second: FloatArray, coarse: FloatArray | None
    ) -> Accuracy:
        """From errors (functions, points) at points; ``coarse``: those with half as many cells.

        >>> places = np.array([0.1, 0.2])
        >>> Accuracy.of(np.array([[1e-9, 1e-8]]), places, places, np.array([[1.0, 1.6e-7]])).at_phi
        (0.2,)
        """
        where = np.where(np.isnan(errors), np.inf, errors).argmax(axis=1)
        largest = errors[np.arange(len(errors)), where]
        order = 0.0 if coarse is None else float(np.log2(coarse.max() / errors.max()))
        return cls(
            tuple(largest.tolist()), tuple(np.sqrt((errors**2).mean(axis=1)).tolist()),
            tuple(np.quantile(errors, 0.999, axis=1).tolist()), tuple(phi[where].tolist()),
            tuple(second[where].tolist()), len(errors), order, phi.size,
        )  # fmt: skip

    def text(self) -> str:
        """The measured errors in JSON."""
        return json.dumps(asdict(self))

    @classmethod
    def read(cls, text: str) -> Accuracy:
        """From the JSON of a file."""
        stated: dict[str, Any] = json.loads(text)
        stated |= {name: tuple(v) for name, v in stated.items() if isinstance(v, list)}
        return cls(**stated)


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
    progress: Progress | None = None, second: str = "delta",
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

"""How errors fall with the step: the observed order, and whether they fall at all."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

FALLS = 0.25  # the order below which errors do not fall
_EVEN = 1.0  # orders further apart are none


def orders(steps: Sequence[float], errors: Sequence[float]) -> list[float]:
    """The order p of error ~ step^p between neighbours, from the largest step on.

    Returns
    -------
    list of float
        One less than steps; NaN where an error is 0 or not known.

    Examples
    --------
    >>> orders([0.1, 0.05, 0.025], [4.0, 1.0, 0.25])
    [2.0, 2.0]
    """
    ordered = sorted(zip(steps, errors, strict=True), reverse=True)
    found = []
    for (h1, e1), (h2, e2) in pairwise(ordered):
        known = all(math.isfinite(e) and e != 0.0 for e in (e1, e2))
        found.append(math.log(abs(e1 / e2)) / math.log(h1 / h2) if known else math.nan)
    return found


def verdict(steps: Sequence[float], errors: Sequence[float]) -> str:
    """In words, what the last of these orders says.

    Examples
    --------
    >>> verdict([0.1, 0.05], [4.0, 1.0]), verdict([0.1, 0.05], [1.0, 1.0])
    ('order 2.00', 'does not fall with the step (order 0.00): it is of the model, not of the step')
    """
    found = orders(steps, errors)
    if not found or not math.isfinite(found[-1]):
        return "not known"
    if found[-1] < FALLS:
        return (
            f"does not fall with the step (order {found[-1]:.2f}): it is of the model, not of the "
            "step"
        )
    told = ", ".join(f"{one:.2f}" for one in found)
    if max(found) - min(found) > _EVEN:
        return f"falls unevenly (orders {told}): no order can be told"
    return f"order {told}"

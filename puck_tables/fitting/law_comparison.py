"""Pressure laws and friction laws beside each other, by their likelihood.

Every law is fitted with the same unknowns to the same frames.  The noise is that of the law that
leaves least (or the one given), and a residual beyond four standard deviations counts as four, so
that no law gains by calling frames outliers.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from puck_tables.contact.laws import law_of
from puck_tables.errors import InputError
from puck_tables.fitting.estimate import FARTHEST, FARTHEST_PLACE, Estimate
from puck_tables.fitting.fit_spec import FitSpec
from puck_tables.fitting.problem import PRIOR
from puck_tables.fitting.timing import Known

DRAG = "+drag"
_CONTENDS = 60.0  # of χ²: laws worse than the best by more are not fitted again

Fitted = Callable[[FitSpec, tuple[float, float], Known], Estimate]


class LawScore(NamedTuple):
    """One law.

    ``chi2``: squares of residuals under the common noise; ``unknowns``: how many were found;
    ``weight``: its share of the Akaike weights exp(−½(χ² + 2 unknowns)); ``numbers``: what was
    found of the puck.
    """

    name: str
    chi2: float
    unknowns: int
    weight: float
    numbers: dict[str, float]


def compare(
    variants: Mapping[str, FitSpec], noise: tuple[float, float], known: Known, fit_law: Fitted
) -> tuple[LawScore, ...]:
    """The laws named, best first; ``fit_law`` fits each with a noise, known or not."""
    names, questions = list(variants), list(variants.values())
    first = [fit_law(one, noise, known) for one in questions]
    common = [
        noise[kind] if known[kind] else min(one.problem.noise[kind] for one in first)
        for kind in range(2)
    ]
    unknowns = np.array([one.x.size for one in first])
    chi2 = np.array([chi2_under(one, (common[0], common[1])) for one in first])
    score = chi2 + 2.0 * unknowns
    again = list(first)
    for k in np.flatnonzero(score < score.min() + _CONTENDS):
        if not (known.place and known.angle):
            again[k] = fit_law(questions[k], (common[0], common[1]), Known(True, True, True))
            chi2[k] = chi2_under(again[k], (common[0], common[1]))
    score = chi2 + 2.0 * unknowns
    weight = np.exp(-0.5 * (score - score.min()))
    weight /= weight.sum()
    result = [
        LawScore(name, float(c), int(m), float(w), one.problem.numbers_at(one.x))
        for name, c, m, w, one in zip(names, chi2, unknowns, weight, again, strict=True)
    ]
    order = np.argsort(score, kind="stable")
    return tuple(result[k] for k in order)


def variants_of(spec: FitSpec, names: Any) -> dict[str, FitSpec]:
    """What is asked of each law by its name.

    Raises
    ------
    InputError
        If they are no list, a law is not known, or named twice.
    """
    if isinstance(names, str):
        raise InputError(f"laws must be a list of names, got the text '{names}'")
    if len(set(names)) < len(names):
        raise InputError(f"laws {', '.join(names)}: name each law once")
    return {name: _variant(spec, name) for name in names}


def _variant(spec: FitSpec, name: str) -> FitSpec:
    """The same question of another law."""
    drags = name.endswith(DRAG)
    law = law_of(name.removesuffix(DRAG))
    free = tuple(n for n in spec.free if n != "inner" and (n != "drag" or drags))
    if drags and "drag" not in free:
        free = (*free, "drag")
    fixed = {n: v for n, v in spec.fixed.items() if n != "inner"}
    return replace(spec, puck=replace(spec.puck, pressure=law), free=free, fixed=fixed)


def chi2_under(result: Estimate, noise: tuple[float, float]) -> float:
    """χ² under a noise, of all frames, with no residual beyond the farthest."""
    rows = result.problem.with_noise(noise, result.x, result.kept).residuals(result.x)
    total = float(np.sum(rows[result.problem.kinds == PRIOR] ** 2))
    for x, y, turn in result.problem.each():
        place = rows[x] ** 2 + rows[y] ** 2
        total += float(np.minimum(place, FARTHEST_PLACE).sum())
        total += float(np.minimum(rows[turn] ** 2, FARTHEST**2).sum())
    return total if math.isfinite(total) else math.inf

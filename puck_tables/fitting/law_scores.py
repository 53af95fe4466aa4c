"""Which laws fit tracks best.

Laws are compared by fits with the same unknowns to the same frames.  The noise is that of the law
that leaves least (or the one given), and a residual beyond four standard deviations counts as four,
so that no law gains by calling frames outliers.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from puck_tables.errors import InputError
from puck_tables.fitting.estimate import Estimate, chi2_under, estimate
from puck_tables.fitting.fit_spec import FitSpec
from puck_tables.fitting.initial_estimate import initial_estimate
from puck_tables.fitting.problem import Problem
from puck_tables.fitting.slowing import ALL_KNOWN, on_a_floor

_CONTENDS = 60.0  # of χ²: laws worse than the best by more are not fitted further


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


def compare(problem: Problem, variants: Mapping[str, FitSpec]) -> tuple[LawScore, ...]:
    """The laws named, best first, of the frames of a problem; those that contend are fitted on.

    Frames that another law leaves out at the ends may be those that tell.
    """
    fits, noise, known = dict[str, Estimate](), problem.noise, problem.known
    for name, question in variants.items():
        same = replace(problem, spec=question, known=known._replace(jitter=True))
        try:
            fits[name] = (
                on_a_floor(same) if question.integrated else initial_estimate(same, refit=False)
            )
        except InputError:
            if "+" not in name:  # no such floor leads to such a track
                raise
    place, angle = (
        noise[kind] if known[kind] else min(one.problem.noise[kind] for one in fits.values())
        for kind in range(2)
    )
    unknowns = np.array([one.x.size for one in fits.values()])
    chi2 = np.array([chi2_under(one, (place, angle)) for one in fits.values()])
    score = chi2 + 2.0 * unknowns
    near = score < score.min() + _CONTENDS
    for k, (name, before) in enumerate(fits.items()):
        if near[k] and not (known.place and known.angle):
            same = before.problem.with_noise((place, angle), before.x)
            one = estimate(replace(same, known=ALL_KNOWN), before.x)
            if (less := chi2_under(one, (place, angle))) < chi2[k]:
                fits[name], chi2[k] = one, less
    score = chi2 + 2.0 * unknowns
    weight = np.exp(-0.5 * (score - score.min()))
    weight /= weight.sum()
    every = [*zip(fits.items(), *(one.tolist() for one in (chi2, unknowns, weight)), strict=True)]
    return tuple(
        LawScore(name, c, m, w, one.problem.numbers_at(one.x))
        for (name, one), c, m, w in (every[k] for k in np.argsort(score, kind="stable"))
    )


_EACH = 7.0  # of χ², that each more number has to earn: ln n of a film of some hundred frames
_AS_RIGHT = 10.0  # of that: floors that the film does not tell apart


def verdict(laws: tuple[LawScore, ...]) -> str:
    """Which of the laws compared a film supports, from the simplest up, in a sentence.

    A law counts by χ² + 7 for each number.

    >>> one = LawScore("uniform", 930.0, 8, 0.0, {})
    >>> verdict((one._replace(name="uniform+air", chi2=700.0, unknowns=9), one))
    'uniform+air is what the film supports: with 1 more number than uniform it leaves 230 less of \
chi^2, and no other law leaves less for its numbers.'
    """
    if len(laws) < 2:
        return ""
    ranked = sorted(laws, key=lambda one: one.chi2 + _EACH * one.unknowns)
    simplest = min(laws, key=lambda one: (one.unknowns, one.chi2))
    best = ranked[0]
    least = best.chi2 + _EACH * best.unknowns
    alike = [one.name for one in ranked[1:] if one.chi2 + _EACH * one.unknowns < least + _AS_RIGHT]
    if best is simplest:
        said = (
            f"{best.name} is enough: no law with more numbers leaves so much less of chi^2 that "
            "they are worth it"
        )
    else:
        more = best.unknowns - simplest.unknowns
        words = f"{more} more number{'' if more == 1 else 's'} than"
        said = (
            f"{best.name} is what the film supports: with {words} {simplest.name} it leaves "
            f"{simplest.chi2 - best.chi2:.4g} less of chi^2, and no other law leaves less for its "
            "numbers"
        )
    if alike:
        said += f"; {', '.join(alike)} may be as right: the film does not tell"
    return f"{said}."

"""Which of the motions that fit is taken, and how far it is to be believed."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from puck_tables.errors import InputError
from puck_tables.fitting.certainty import (
    Certainty,
    OtherMinimum,
    certainty_of,
    of_rounded,
    pinned_of,
    widened,
)
from puck_tables.fitting.estimate import Estimate, estimate, freedom
from puck_tables.fitting.identifiability import ran_away
from puck_tables.fitting.inputs import refuse_wobbling
from puck_tables.fitting.numbers import plausible_for
from puck_tables.fitting.other_minima import mirrored, other_minima, taken
from puck_tables.fitting.problem import Known
from puck_tables.fitting.residuals import SideForces, excess_of, may_misfit, no_answer, side_forces

_JUDGED = 2.5  # degrees of freedom that tell the noise of a kind
_BIAS = 2.0  # times what a force, to first order, would have done


class JudgedMotion(NamedTuple):
    """The motion that is taken, and what is known of it.

    ``seen``: its certainty before anything nobody would believe took it all.
    """

    best: Estimate
    certainty: Certainty
    seen: Certainty
    other_fits: tuple[OtherMinimum, ...]
    unsigned: tuple[int, ...]
    forces: SideForces
    nowhere: str
    astray: str


def judged_motion(
    best: Estimate, known: Known, smooth: tuple[float, float], bounds: Collection[str]
) -> JudgedMotion:
    """Which motion is taken of those that fit as well, and how far it is to be believed.

    ``smooth``: the noise (m, rad) that no model judged; ``bounds``: names that the caller bounds.
    """
    certainty = judged_certainty(best, known)
    refuse_wobbling(best, certainty)
    excess = max(excess_of(best, smooth), 1.0)
    other_fits = other_minima(best, certainty, excess)
    other = taken(best, other_fits, excess)
    if other is not None:
        best = replace(estimate(best.problem, other.estimate.x, known), minima=best.minima)
        certainty = judged_certainty(best, known)
        other_fits = other_minima(best, certainty, max(excess_of(best, smooth), 1.0))
    unsigned = mirrored(best, certainty)
    forces = side_forces(best, certainty)
    # bounds that the caller gives may keep every motion away: that is said of the bound
    held_off = any(best.problem.names[k][1] in bounds for k in np.flatnonzero(certainty.pinned))
    if held_off:  # no force
        forces = forces._replace(biases=np.empty((0, 0)))
    misfits = may_misfit(best, known, smooth, forces.chance)
    certainty = _wider(best, certainty, misfits, forces, bool(unsigned))
    nowhere = "" if held_off else no_answer(best, known, smooth)
    astray = nowhere or ran_away(best.problem, best.x)
    return JudgedMotion(
        best, certainty.lost() if astray else certainty, certainty, other_fits, unsigned, forces,
        nowhere, astray,
    )  # fmt: skip


def judged_certainty(best: Estimate, known: Known) -> Certainty:
    """How well the unknowns of an estimate are known."""
    degrees = freedom(best, known)
    if degrees < _JUDGED:
        raise InputError(
            f"{best.residuals.size} observations of {best.x.size} unknowns are too few to judge "
            "the noise of each kind by: give the noise, or more frames"
        )
    plausible = plausible_for(best.problem, best.x)
    certainty = certainty_of(best.jacobian[best.kept], plausible, degrees)
    return replace(certainty, pinned=pinned_of(best, certainty))


def _wider(
    best: Estimate, certainty: Certainty, misfits: bool, forces: SideForces, unsigned: bool
) -> Certainty:
    """The same where residuals are no independent noise, or nothing tells a floor from a spin."""
    if misfits or any(certainty.pinned):
        certainty = widened(best, certainty)
        if misfits and forces.biases.size:
            by_force = _BIAS**2 * forces.biases @ forces.biases.T
            certainty = certainty.wider(certainty.covariance + by_force, True)
    elif any(any(film.steps) for film in best.problem.films):
        certainty = of_rounded(best, certainty)
    if unsigned and forces.by_law.size:  # its slowing alone tells friction from spin
        by_law = np.outer(forces.by_law, forces.by_law)
        certainty = certainty.wider(certainty.covariance + by_law, False)
    return certainty

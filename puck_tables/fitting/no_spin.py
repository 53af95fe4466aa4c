"""What a track without angles tells if its puck did not spin."""

from __future__ import annotations

from dataclasses import replace

from puck_tables.errors import InputError
from puck_tables.fitting.certainty import certainty_of
from puck_tables.fitting.estimate import Estimate, freedom
from puck_tables.fitting.initial_estimate import initial_estimate
from puck_tables.fitting.law_comparison import chi2_under
from puck_tables.fitting.numbers import Number, numbers_of, plausible_for
from puck_tables.fitting.other_minima import RISE
from puck_tables.fitting.timing import Known

_SPIN = "launch_spin"
_SCALES = ("friction", "decel")


def without_spin(
    result: Estimate, numbers: dict[str, Number], known: Known
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """A sentence on the friction if no puck spun, and what is open then.

    None where friction is told, or they did spin.  The commonest film shows a slide without marks:
    its friction hangs on the spin that nobody saw.
    """
    problem = result.problem
    spec = problem.spec
    (*scale, _) = (*(name for name in _SCALES if name in spec.free), "")
    if (
        not scale or numbers[scale[0]].determined or _SPIN in spec.fixed or problem.impact_specs
        or all(problem.spinless) or any(film.angle is not None for film in problem.films)
    ):  # fmt: skip
        return (), ()
    low, high = spec.bounds.get(_SPIN, (0.0, 0.0))
    if not low <= 0.0 <= high:
        return (), ()
    try:
        still = initial_estimate(
            replace(problem, spec=spec.spinning(0.0), weights=()), known, refit=False
        )
    except InputError:  # too few frames
        return (), ()
    noise = result.problem.noise
    if chi2_under(still, noise) > chi2_under(result, noise) + RISE:
        return (), ()
    plausible = plausible_for(still.problem, still.x)
    degrees = freedom(still, known)
    certainty = certainty_of(still.jacobian[still.kept], plausible, degrees)
    told = numbers_of(still, certainty)[0]
    number = told[scale[0]]
    if not number.determined:
        return (), ()
    unit = "" if number.unit == "1" else f" {number.unit}"
    return (
        f"{scale[0]} = {number.value:.4g} +- {number.error:.2g}{unit} if it did not spin: --fix "
        "launch_spin=0 (fixed={'launch_spin': 0}).",
    ), tuple(name for name, one in told.items() if not one.determined)

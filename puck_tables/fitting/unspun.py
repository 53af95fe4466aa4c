"""What a track without angles tells if its puck did not spin."""

from __future__ import annotations

from dataclasses import replace

from puck_tables.errors import InputError
from puck_tables.fitting.certainty import certainty_of
from puck_tables.fitting.estimate import Estimate, freedom
from puck_tables.fitting.fitted import fitted
from puck_tables.fitting.laws import chi2_under
from puck_tables.fitting.numbers import Number, numbers_of, plausible_for
from puck_tables.fitting.rivals import RISE
from puck_tables.fitting.timing import Known

_SPIN = "launch_spin"
_SCALES = ("friction", "decel")


def without_spin(found: Estimate, numbers: dict[str, Number], known: Known) -> tuple[str, ...]:
    """A sentence on the friction if no puck spun; none where it is told, or they did.

    The commonest film shows a slide without marks: its friction hangs on the spin that nobody saw.
    """
    problem = found.problem
    asked = problem.asked
    (*scale, _) = (*(name for name in _SCALES if name in asked.free), "")
    if (
        not scale or numbers[scale[0]].determined or _SPIN in asked.fixed or problem.meetings
        or all(problem.spinless) or any(film.angle is not None for film in problem.films)
    ):  # fmt: skip
        return ()
    low, high = asked.bounds.get(_SPIN, (0.0, 0.0))
    if not low <= 0.0 <= high:
        return ()
    try:
        still = fitted(replace(problem, asked=asked.spinning(0.0), weights=()), known, refit=False)
    except InputError:  # too few frames
        return ()
    noise = found.problem.noise
    if chi2_under(still, noise) > chi2_under(found, noise) + RISE:
        return ()
    plausible = plausible_for(still.problem, still.x)
    degrees = freedom(still, known)
    certainty = certainty_of(still.jacobian[still.kept], plausible, degrees)
    number = numbers_of(still, certainty)[0][scale[0]]
    if not number.determined:
        return ()
    unit = "" if number.unit == "1" else f" {number.unit}"
    return (
        f"{scale[0]} = {number.value:.4g} +- {number.error:.2g}{unit} if it did not spin: --fix "
        "launch_spin=0 (fixed={'launch_spin': 0}).",
    )

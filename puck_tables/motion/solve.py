"""The one loop that computes anew, finer and finer, until the tolerance holds."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple, TypeVar

from puck_tables._core.arrays import rounded_up
from puck_tables.errors import AccuracyError
from puck_tables.motion.steppers import Stepping

Result = TypeVar("Result")
AnySetting = TypeVar("AnySetting")

# of a step, and steps: beyond, rounding grows as steps get finer
FINEST_LOCAL, MOST_STEPS = 1e-15, 4096


class ErrorEstimate(NamedTuple):
    """The error of a result: by the steps of the integrator, by its friction, and the rest."""

    by_steps: float
    by_friction: float
    rounding: float = 0.0

    @property
    def total(self) -> float:
        """All of it."""
        return self.by_steps + self.by_friction + self.rounding


class Setting(NamedTuple):
    """How finely a motion is computed: its integrator, and the error of its friction."""

    stepping: Stepping
    accuracy: float

    @property
    def words(self) -> str:
        """The number that sets the error of the integrator."""
        stepping = self.stepping
        return f"steps={stepping.steps:g}" if stepping.fixed else f"local={stepping.local:g}"


def close_enough(
    setting: AnySetting, attempt: Callable[[AnySetting], tuple[Result, ErrorEstimate]],
    finer: Callable[[AnySetting, ErrorEstimate], AnySetting | None], tol: float, of: str,
) -> tuple[Result, ErrorEstimate, AnySetting]:  # fmt: skip
    """Compute with finer and finer settings until the estimated error is within the tolerance.

    ``setting``: to begin with; ``attempt``: computes with a setting, and estimates the error of its
    result; ``finer``: the setting to try next; None where there is none; ``tol``: the largest
    error; ``of``: what it is about, for the message.  Returns result, its error, the setting.
    Raises AccuracyError if no setting is fine enough; it says which tolerance is.

    >>> halves = lambda n: (n, ErrorEstimate(0.5**n, 0.0))
    >>> close_enough(1, halves, lambda n, error: n + 1, 0.1, "halves")[0]
    4
    """
    while True:
        result, error = attempt(setting)
        if error.total <= tol:
            return result, error, setting
        following = finer(setting, error)
        if following is None:
            raise AccuracyError(
                f"tol = {tol:g} is out of reach for {of}: give tol (--tol) of "
                f"{rounded_up(2.0 * error.total):g} or more"
            )
        setting = following


def refined(
    setting: Setting, error: ErrorEstimate, tol: float, friction: Callable[[float], float | None]
) -> Setting | None:
    """The next setting of a motion: better friction where that errs most, else finer steps.

    ``friction``: the accuracy to try after one; None where it is the finest.
    """
    stepping = setting.stepping
    if error.by_friction > error.by_steps:
        accuracy = friction(setting.accuracy)
        return None if accuracy is None else Setting(stepping, accuracy)
    if stepping.steps >= MOST_STEPS or (not stepping.fixed and stepping.local <= FINEST_LOCAL):
        return None
    gain = min(max(0.5 * tol / error.total, 0.1), 0.5)  # an error falls like the local one
    steps = gain ** (-1.0 / stepping.tableau.order)
    return Setting(stepping.finer(steps, gain, FINEST_LOCAL), setting.accuracy)

"""What to know of the numbers of a fit before they are used."""

from __future__ import annotations

import math

import numpy as np

from puck_tables.fitting.certainty import Certainty
from puck_tables.fitting.estimate import Estimate
from puck_tables.fitting.identifiability import (
    doubts,
    rounded,
    spin_would_tell,
    taken_for_granted,
)
from puck_tables.fitting.numbers import EstimatedLaunch, Number
from puck_tables.fitting.residuals import (
    JITTERY,
    NO_PATTERN,
    SideForces,
    computed,
    lengthways,
    misfits,
)
from puck_tables.puck import Puck

_WIDER = 1.5  # times: an error that is told to be widened


class Remarked:
    """A fit, as far as it says what to think of it."""

    given: Puck
    numbers: dict[str, Number]
    launches: tuple[EstimatedLaunch, ...]
    noise: tuple[float, float]
    jitter: float
    outliers: float
    drift: float
    untied: str
    not_met: tuple[str, ...]
    estimate: Estimate
    certainty: Certainty
    forces: SideForces
    misfit: str

    @property
    def complaints(self) -> tuple[str, ...]:
        """Signs that the tracks are not those of such a puck."""
        words = [*misfits(self.estimate, self.forces.chance)]
        if words:
            words.append(
                "Standard errors are widened by what parts of the frames do to the numbers: they "
                "may still be too small"
            )
        words += filter(None, (self.untied, self.misfit))
        if self.outliers > 0.2:
            words.append(f"{100.0 * self.outliers:.3g} % of the observations had to be left out")
        return tuple(words)

    @property
    def doubts(self) -> list[str]:
        """What was found that nobody would believe."""
        return list(doubts(self.numbers, self.launches, self.given.radius))

    @property
    def remarks(self) -> tuple[str, ...]:
        """What to know of the numbers before they are used."""
        problem = self.estimate.problem
        said = [
            f"{name} is found, too, since it has a prior or bounds: without them it is known, "
            f"{float(getattr(self.given, name)):g}"
            for name in problem.spec.freed if hasattr(self.given, name)
        ]  # fmt: skip
        every = zip(problem.films, problem.spinless, strict=True)
        if straight := [film.name for film, spinless in every if spinless]:
            others = f" and {len(straight) - 1} more lie" if len(straight) > 1 else " lies"
            said.append(
                f"{straight[0]}{others} along a line and without angles: taken for a slide without "
                "spin. If it spun, friction may be up to 1.6 times as much (bounds or a start of "
                "launch_spin look for that)"
            )
        if all(problem.spinless) and (more := spin_would_tell(self.estimate)):
            said.append(more)
        said += [text for film in problem.films for text in rounded(film)]
        own = len(problem.spec.free) or self.estimate.x.size  # of the puck, if any is found
        # of several at their most rounding does not choose
        wider = [round(self.certainty.ratio(k), 6) for k in range(own)]
        is_said = bool(self.complaints) or computed(self.estimate)
        if self.certainty.widened and max(wider) > _WIDER and not is_said:
            name = problem.names[int(np.argmax(wider))][1]
            said.append(
                "What is left may be no noise, though that is hardly seen: standard errors are "
                f"widened by what parts of the frames do to the numbers, {max(wider):.2g} times "
                f"that of {name}"
            )
        for k, side in enumerate(self.certainty.pinned):
            if side:
                end, where = problem.limits[side > 0][k], "above" if side > 0 else "below"
                name = problem.names[k][1]
                if side > 0 and name == "friction" and end == problem.spec.steepest(name):
                    where += " (with more part of the base would lift: is the height right?)"
                if side < 0 and name == "delta" and problem.angled:  # a path turns with the spin
                    where += " (or angles, or y, grow the other way)"
                said.append(
                    f"{name} lies on the end of its range, {end:.6g}: what fits best may be "
                    f"{where}. So it has no standard error, and its interval, and errors and "
                    "intervals of the rest, may mislead"
                )
        air, mass = self.numbers.get("air"), self.given.mass
        if air is not None and mass != 1.0 and math.isfinite(air.error):
            said.append(
                f"air is {air.value * mass:.4g} +- {air.error * mass:.2g} kg/m over the mass of "
                f"{mass:g} kg: drag.quadratic of a scene"
            )
        said += (*self.not_met, *self.doubts)
        # stamps that jitter leave no drift, as another law does
        if self.jitter == 0.0 and self.noise[0] > 0.0 and self.drift > NO_PATTERN:
            ratio = lengthways(self.estimate)
            if ratio > JITTERY:
                said.append(
                    f"Residuals along the motion are {ratio:.3g} times those across it: the time "
                    "stamps may jitter (--jitter find)"
                )
        said += taken_for_granted(self.forces, self.numbers)
        return tuple(f"{text}." for text in said)

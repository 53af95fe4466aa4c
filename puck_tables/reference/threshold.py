"""What an engine calls rest: slower than a threshold, and when that is."""

from __future__ import annotations

import re
from typing import NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables._core.units import unit_size
from puck_tables.errors import InputError
from puck_tables.reference.answer import Answer
from puck_tables.reference.floor_reaction import SlipVelocity, slip_over

_USUAL = 0.01  # of Q at the launch
_NO_SPIN = 1e-9  # of Q at the launch
_LOOKS, _ROUNDS = 513, 6  # angles looked at, and rounds that narrow down by as much


class Threshold(NamedTuple):
    """Slower than ``value`` in speed (m/s), spin (rad/s) or Q = hypot(v, rω) (m/s, 'slip')."""

    of: str
    value: float

    def __str__(self) -> str:
        name, unit = {"speed": ("v", "m/s"), "spin": ("|w|", "rad/s"), "slip": ("Q", "m/s")}[
            self.of
        ]
        return f"{name} < {self.value:.6g} {unit}"

    def excess(self, slip: SlipVelocity, radius: float) -> FloatArray:
        """How far above the threshold, over it: -1 at rest."""
        speed, rim, q = slip.sizes(radius)
        size = {"speed": speed, "spin": rim / radius, "slip": q}[self.of]
        return size / self.value - 1.0


def threshold_of(text: str) -> Threshold:
    """A threshold of speed or of spin, by its unit.

    Raises InputError if it is no positive number with a unit of either.

    >>> threshold_of("0.1rad/s"), threshold_of("2 mm/s")
    (Threshold(of='spin', value=0.1), Threshold(of='speed', value=0.002))
    """
    match = re.fullmatch(r"\s*([0-9.]+(?:[eE][-+]?[0-9]+)?)\s*([^0-9\s].*?)\s*", text)
    for of, kind in (("spin", "spin"), ("speed", "velocity")):
        size = None if match is None else unit_size(match[2], kind)
        if match is not None and size is not None:
            try:
                value = float(match[1]) * size
            except ValueError:
                break
            if 0.0 < value < np.inf:
                return Threshold(of, value)
    raise InputError(
        f"a threshold is a speed or a spin greater than 0 with its unit, such as 0.1rad/s or "
        f"1mm/s, got '{text:.40}'"
    )


def usual(answer: Answer) -> Threshold:
    """One hundredth of the slip at the launch.

    >>> from puck_tables.reference.answer import reference_case
    >>> str(usual(reference_case("slide")))
    'Q < 0.01 m/s'
    """
    return Threshold("slip", _USUAL * answer.speed_scale)


class Rest(NamedTuple):
    """From when on it is slower than all thresholds: time s, place m, ε = v/(r|ω|) there.

    NaN for ε where the rim is slower than 1e-9 of Q at the launch: that is no spin but rounding.
    """

    time: float
    x: float
    y: float
    epsilon: float


def rest_of_rows(
    time: FloatArray, states: dict[str, FloatArray], answer: Answer, puck: int | None,
    thresholds: tuple[Threshold, ...],
) -> Rest | None:  # fmt: skip
    """From when on a run is below the thresholds, by straight lines between its rows."""
    radius = answer.pucks[puck or 0].radius
    slip = slip_over(answer.floor, states)
    last, share = -1, 0.0
    for one in thresholds:
        above = one.excess(slip, radius)
        n = int(np.flatnonzero(above >= 0.0)[-1]) if (above >= 0.0).any() else -1
        if n == time.size - 1:
            return None
        part = above[n] / (above[n] - above[n + 1]) if n >= 0 else 0.0
        if n + part > last + share:
            last, share = n, float(part)
    if last < 0:
        last, share = 0, 0.0

    def at(row: FloatArray) -> float:
        return float(row[last] + share * (row[last + 1] - row[last]))

    speed, rim, _ = slip.sizes(radius)
    v, w = at(speed), at(rim)
    spins = w > _NO_SPIN * answer.speed_scale
    return Rest(at(time), at(states["x"]), at(states["y"]), v / w if spins else np.nan)


def why_no_rest(
    time: FloatArray, states: dict[str, FloatArray], answer: Answer, puck: int | None,
    thresholds: tuple[Threshold, ...],
) -> str:  # fmt: skip
    """Why :func:`rest_of_rows` has found none: the threshold above which a run ends."""
    slip = slip_over(answer.floor, states)
    for one in thresholds:
        above = one.excess(slip, answer.pucks[puck or 0].radius) >= 0.0
        if above.all():
            return f"never below {one} in its {time[-1]:.4g} s"
        if above[-1]:
            return f"not below {one} in its last row, at {time[-1]:.4g} s"
    return ""


def exact_rest(answer: Answer, puck: int | None, thresholds: tuple[Threshold, ...]) -> Rest | None:
    """From when on the exact motion is below the thresholds; None: not before it is left.

    >>> from puck_tables.reference.answer import reference_case
    >>> at = exact_rest(reference_case("coin"), None, (Threshold("spin", 0.1),))
    >>> round(at.epsilon, 5)
    0.66486
    """
    if answer.end == "time is up":
        return None
    low, high = 0.0, answer.end_time_of(puck)
    rest = None
    for _ in range(_ROUNDS):
        times = np.linspace(low, high, _LOOKS)
        states = answer(times).states_of(puck)
        radius = answer.pucks[puck or 0].radius
        slip = slip_over(answer.floor, states)
        above = np.max([one.excess(slip, radius) for one in thresholds], axis=0) >= 0.0
        n = int(np.flatnonzero(above)[-1]) if above.any() else 0
        rest = rest_of_rows(times, states, answer, puck, thresholds)
        if rest is None:  # slower only at the very end
            return Rest(high, float(states["x"][-1]), float(states["y"][-1]), np.nan)
        low, high = float(times[n]), float(times[min(n + 1, times.size - 1)])
        if not high - low > 1e-14 * answer.end_time_of(puck):
            break
    return rest

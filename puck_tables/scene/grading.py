"""Time within a step that goes ever slower towards where a slip stops.

A step over h is uniform in σ, 0 to 1, over times t + h G(σ): any G gives a step of the method, of
the same order, and the error that it estimates is its own.  So what G follows is only foreseen.

Where a slip stops, its direction changes like a power of what is left of it, so that steps uniform
in time must be ever shorter shares of that.  A step that takes the share s of what is left goes
uniformly from w = 1 to 1 − b, w⁴ being what is left and b = 1 − (1 − s)^(1/4) its bend; with it
runs down a slope take half the time.
"""

from __future__ import annotations

import math

from puck_tables.kernels.compile import inlined

_ROOM = 0.02  # a step that takes a smaller share of what is left is as good without a bend
CLOSEST = 0.87  # of what is left: no step takes more, nor if it is a tenth longer to land


@inlined
def towards_stop(share: float) -> float:
    """The bend of a step that takes this share of what is left; 0: uniform."""
    return 1.0 - math.sqrt(math.sqrt(1.0 - share)) if share > _ROOM else 0.0


@inlined
def powers_of(b: float) -> tuple[float, float, float, float]:
    """The coefficients of σ, σ², σ³ and σ⁴ in G."""
    if b == 0.0:
        return 1.0, 0.0, 0.0, 0.0
    one, two, three, four = 4.0 * b, -6.0 * b * b, 4.0 * b * b * b, -b * b * b * b
    scale = 1.0 / (one + two + three + four)
    return scale * one, scale * two, scale * three, scale * four


@inlined
def left_after(b: float) -> float:
    """The share of what is left before a slip stops that a step of this bend leaves."""
    left = 1.0 - b
    return left * left * left * left


@inlined
def stretched(b: float, h: float, factor: float) -> float:
    """A step of so many times the length, as it counts: where h is the share s, 1 − (1 − s)^factor.

    Until the next step begins, what is left has become less by 1 − s.
    """
    if b == 0.0:
        return h * factor
    return h * (1.0 - (1.0 - b) ** (4.0 * factor)) / (1.0 - left_after(b))

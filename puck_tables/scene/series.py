"""What rebounds that die out do to a rim: the rest of the series, in closed form where it has one.

After a rebound the next normal impulses are P q, P q², … and hops take τ, τ q, …  Between two of
them what acts changes the rim's slip u at a steady rate a, and each changes it by −(1 + e_τ) u, at
most by μ c P_j (c the compliance of the rim).  All this is of the order of the rest of the time R,
or is a slip that is reversed without end; so the impulses are given as one at the start, such that
the puck gets as far as with all of them, and one at the end.  That is right up to R².
"""

from __future__ import annotations

import math

from puck_tables.kernels.compile import kernel

_LONGEST = 200_000  # rebounds that are taken one by one
_NOTHING = 1e-18  # of the first: no impulse


@kernel
def rest_of_rim(
    slip: float, rate: float, hop: float, ratio: float, most: float, tangential: float
) -> tuple[float, float, bool]:
    """Changes of the rim's slip over the rest of a series: on average, in all; whether it rolls.

    ``slip``: after the last rebound; ``rate``: m/s² by what else acts; ``hop``: s to the next one;
    ``ratio``: of each to the one before; ``most``: m/s that the next one may change; ``tangential``
    : restitution e_τ.
    """
    total, area, u, tau, cap = 0.0, 0.0, slip, hop, most
    for _ in range(_LONGEST):
        area += total * tau
        u += rate * tau
        tau *= ratio
        wish = -(1.0 + tangential) * u
        change = min(max(wish, -cap), cap)
        total += change
        u += change
        cap *= ratio
        left = tau / (1.0 - ratio)
        if change != wish:
            budget = cap / (1.0 - ratio)
            least = abs(u) - abs(rate) * left - budget
            if (1.0 + tangential) * least >= cap:  # it slides for good
                sign = 1.0 if u > 0.0 else -1.0
                area += total * left - sign * budget * (left - tau / (1.0 - ratio * ratio))
                total -= sign * budget
                return area * (1.0 - ratio) / hop, total, False
        elif cap == math.inf:
            grows = abs(u)
        else:
            share = abs(tangential) / ratio
            grows = (abs(u) + abs(rate) * tau / (1.0 - share)) if share < 1.0 else math.inf
        if change == wish and (1.0 + tangential) * grows <= cap:  # reversed for good
            # u_j → −e_τ (u_j + a τ_j): one part follows the hops, the rest is reversed
            gap = ratio + tangential
            part = -tangential * rate / gap if abs(gap) > 1e-3 else 0.0
            squares = tau / (1.0 - ratio * ratio)
            area += (total - u) * left + (u - part * tau) * tau / (1.0 + tangential * ratio)
            area += part * tau * squares - rate * left * (left - squares)
            total -= u + rate * left
            return area * (1.0 - ratio) / hop, total, True
        if cap <= _NOTHING * most and tau <= _NOTHING * hop:
            break
    return area * (1.0 - ratio) / hop, total, abs(u) <= 1e-15 * (abs(slip) + most)

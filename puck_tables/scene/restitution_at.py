"""What a law of restitution says at a speed of approach, from the numbers that it is."""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inner

VISCOELASTIC, PLASTIC, TABLE = range(3)  # the first number of a law
BEYOND = -1.0  # the answer where a table has ended


@inner
def restitution_at(laws: FloatArray, first: int, speed: float) -> float:
    """The restitution by the law whose numbers begin at ``first``; BEYOND the end of a table."""
    kind, at = int(laws[first]), first + 1
    if kind == VISCOELASTIC:
        s2 = laws[at] * speed**0.2 / 1.15345
        s = math.sqrt(s2)
        top = 1.0 + 0.501086 * s
        return top / (top + s2 * (1.15345 + 0.577977 * s + 0.532178 * s2))
    if kind == PLASTIC:
        if speed <= laws[at]:
            return 1.0
        q = laws[at] / speed
        share = q / (q + 2.0 * math.sqrt(1.2 - 0.2 * q * q))
        return math.sqrt(1.2 * math.sqrt(3.0) * (1.0 - q * q / 6.0)) * share**0.25
    count = int(laws[at])
    at += 1
    if speed > laws[at + count - 1]:
        return BEYOND
    low, high = 0, count - 2
    while low < high:
        middle = (low + high + 1) // 2
        if laws[at + middle] <= speed:
            low = middle
        else:
            high = middle - 1
    s, c = speed - laws[at + low], at + count + 4 * low
    value = laws[c] + s * (laws[c + 1] + s * (laws[c + 2] + s * laws[c + 3]))
    return min(max(value, 0.0), 1.0)  # what rounding puts outside

"""Time within a step that goes slowly where friction bends, or where a slip stops.

A step over h is uniform in σ, 0 to 1, over times t + h G(σ): any G gives a step of the method, of
the same order, and the error that it estimates is its own.  So what G follows is only foreseen.

Where a slip stops, its direction changes like a power of what is left of it, so that steps uniform
in time must be ever shorter shares of that.  A step that takes the share s of what is left goes
uniformly from w = 1 to 1 − b, w⁴ being what is left and b = 1 − (1 − s)^(1/4) its bend.

Where the rim of a base meets a border or leaves it, friction is a series in the square root of the
time between, and where the centre of rotation passes one, it has a logarithm.  Between two such
moments steps go uniformly in u, 3u² − 2u³ being the share of the time between them that has passed:
to it both ends are smooth.  u is the place of a step, and its bend how far it comes.
"""

from __future__ import annotations

import math

from puck_tables.kernels.compile import inlined

Grade = tuple[float, float]  # the place of a step, and its bend
UNIFORM: Grade = (0.0, 0.0)
_TO_STOP = -1.0  # the place of a step towards where a slip stops
_ROOM = 0.02  # a step that takes a smaller share of what is left is as good without a bend
_STRETCH, _TWO = 1.1, 1.6  # times as far as it should: then one step is the last, or two are
CLOSEST = 0.87  # of what is left: no step takes more, nor if it is a tenth longer to land


@inlined
def towards_stop(share: float) -> Grade:
    """The grade of a step that takes this share of what is left."""
    if share <= _ROOM:
        return UNIFORM
    return _TO_STOP, 1.0 - math.sqrt(math.sqrt(1.0 - share))


@inlined
def _passed(u: float) -> float:
    return u * u * (3.0 - 2.0 * u)


@inlined
def _place(share: float) -> float:
    return 0.5 - math.sin(math.asin(1.0 - 2.0 * share) / 3.0)


@inlined
def between(since: float, left: float, h: float) -> Grade:
    """The grade of a step over h: friction bent so long ago, and will when so much is left."""
    whole = since + left
    place = _place(since / whole)
    return place, _place(min((since + h) / whole, 1.0)) - place


@inlined
def paced(since: float, left: float, pace: float) -> float:
    """How long a step between two such moments is that comes about so far; few are left short."""
    whole = since + left
    place = _place(since / whole)
    rest = 1.0 - place
    if rest <= _STRETCH * pace:
        return left
    return whole * _passed(place + (pace if rest > _TWO * pace else 0.6 * rest)) - since


@inlined
def powers_of(grade: Grade) -> tuple[float, float, float, float]:
    """The coefficients of σ, σ², σ³ and σ⁴ in G."""
    place, b = grade
    if b == 0.0:
        return 1.0, 0.0, 0.0, 0.0
    if place == _TO_STOP:
        one, two, three, four = 4.0 * b, -6.0 * b * b, 4.0 * b * b * b, -b * b * b * b
    else:
        one, two = 6.0 * place * (1.0 - place) * b, (3.0 - 6.0 * place) * b * b
        three, four = -2.0 * b * b * b, 0.0
    scale = 1.0 / (one + two + three + four)
    return scale * one, scale * two, scale * three, scale * four


@inlined
def left_after(grade: Grade) -> float:
    """The share of what is left before a slip stops that a step of this grade leaves; else 1."""
    left = 1.0 - grade[1]
    return left * left * left * left if grade[0] == _TO_STOP else 1.0


@inlined
def stretched(grade: Grade, h: float, factor: float) -> float:
    """A step of so many times the length, as it counts: where h is the share s, 1 − (1 − s)^factor.

    Until the next step begins, what is left has become less by 1 − s.
    """
    if grade[0] != _TO_STOP:
        return h * factor
    return h * (1.0 - (1.0 - grade[1]) ** (4.0 * factor)) / (1.0 - left_after(grade))

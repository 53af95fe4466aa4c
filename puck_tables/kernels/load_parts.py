"""Sums of the slip direction over parts of a round base under Hertz's or Galin's pressure.

As in :mod:`puck_tables.kernels.base_boundary`, of W = (3/2) √(1 − ρ²) or 1/(2 √(1 − ρ²)).  On a
line through the centre of rotation C the slip direction e is the same everywhere: with p = x·e and
the place s along it, ρ² = p² + s², and powers of s times W have elementary integrals J_k.  An area
is the line integral of what lies between C, or where a ray from C enters the base, and its
boundary,

    ∫ W s^k e dA = ∮ e (β J_{k+1} + α e_x J_k) (u·dx)/w² ,

u and w being the slip there and its size, in units of Q.
"""

from __future__ import annotations

import math

from puck_tables.kernels.compile import inlined
from puck_tables.kernels.elementary import angle_of

UNIFORM, RING, HERTZ, GALIN, TABLE = range(5)  # laws of pressure
Sums = tuple[float, float, float, float, float, float, float, float]


@inlined
def powers_along(
    law: int, s: float, q: float, turn: float, square: float
) -> tuple[float, float, float, float]:
    """Primitives of W s^k, k = 0 … 3, with q = √(square − s²) and s = √square sin(turn)."""
    if law == GALIN:
        return (
            0.5 * turn,
            -0.5 * q,
            0.25 * (square * turn - s * q),
            0.5 * q * (q * q / 3.0 - square),
        )
    cube = q * q * q
    return (
        0.75 * (s * q + square * turn),
        -0.5 * cube,
        0.1875 * (square * square * turn + s * q * (2.0 * s * s - square)),
        cube * (0.3 * q * q - 0.5 * square),
    )


@inlined
def loaded_at(
    alpha: float, beta: float, x: float, y: float, tx: float, ty: float, law: int, rim: bool
) -> Sums:
    """The integrands at a point of the boundary, with its direction (tx, ty); ``rim``: of the base.

    On the rim they are of where a ray leaves the base.
    """
    ux, uy = alpha - beta * y, beta * x
    w = max(math.sqrt(ux * ux + uy * uy), 1e-300)
    inverse = 1.0 / w
    ex, ey = ux * inverse, uy * inverse
    s, p = x * ey - y * ex, x * ex + y * ey
    room = (1.0 - x) * (1.0 + x) - y * y
    q = 0.0 if rim else math.sqrt(max(room, 0.0))
    square = s * s + q * q
    turn = 0.5 * math.pi if rim else angle_of(s, q)
    one = powers_along(law, s, q, turn, square)
    within = alpha < beta
    c = alpha / beta if within else 0.0
    begin = -c * ex if within else -math.sqrt(square)
    q = math.sqrt((1.0 - c) * (1.0 + c)) if within else 0.0
    turn = angle_of(begin, q)
    zero = powers_along(law, begin, q, turn, square)
    j0, j1, j2, j3 = one[0] - zero[0], one[1] - zero[1], one[2] - zero[2], one[3] - zero[3]
    far, share = alpha * ex, (ex * tx + ey * ty) * inverse
    a0, a1 = share * (beta * j1 + far * j0), share * (beta * j2 + far * j1)
    a2 = share * (beta * j3 + far * j2)
    at_x, at_y = p * ex * a0 + ey * a1, p * ey * a0 - ex * a1
    return (
        ex * a0, ey * a0, ex * at_x, ex * at_y, ey * at_x, ey * at_y,
        p * ex * a1 + ey * a2, p * ey * a1 - ex * a2,
    )  # fmt: skip

"""The law of impacts: what one contact passes on, after Walton 1993 with Coulomb's friction.

With n from the first to what it meets, t = n turned by +90°, Δ first − second, R the radii and ω
the spins, rims approach and slip by u_n and u_t, and pass on P_n n + P_t t:

    u_n = Δv·n ,   1/m_n = 1/m₁ + 1/m₂ ,   P_n = (1 + e) m_n u_n ,
    u_t = Δv·t + R₁ω₁ + R₂ω₂ ,   1/m_t = 1/m_n + R₁²/I₁ + R₂²/I₂ ,
    P_t = (1 + β) m_t u_t , at most μ P_n in size.

The energy lost is ½ m_n (1 − e²) u_n² with ½ m_t (1 − β²) u_t², or where the rims slide
μ P_n |u_t| − P_t²/2m_t; never less than nothing.  What stands has no 1/m and no 1/I.
"""

from __future__ import annotations

import math

from puck_tables.kernels.compile import inlined


@inlined
def along_normal(vx: float, vy: float, rim: float, nx: float, ny: float) -> tuple[float, float]:
    """u_n and u_t of Δv = (vx, vy) and ``rim`` = R₁ω₁ + R₂ω₂, in m/s."""
    return vx * nx + vy * ny, vy * nx - vx * ny + rim


@inlined
def impulses(
    un: float, ut: float, soft: float, slick: float, e: float, beta: float, mu: float
) -> tuple[float, float]:
    """P_n and P_t, N s, of approach and slip, m/s; ``soft``: 1/m_n, ``slick``: 1/m_t, 1/kg.

    >>> impulses(1.0, -1.0, 1.0, 3.0, 0.5, 0.0, 0.2), impulses(1.0, -1.0, 1.0, 3.0, 0.5, 0.5, 0.4)
    ((1.5, -0.30000000000000004), (1.5, -0.5))
    """
    pn, pt = (1.0 + e) * un / soft, (1.0 + beta) * ut / slick
    if abs(pt) > mu * pn:
        pt = math.copysign(mu * pn, ut)
    return pn, pt


def law_of_impulses(
    un: float, ut: float, soft: float, slick: float, pn: float, pt: float
) -> tuple[float, float, float]:
    """What impulses that are seen say: e, β if the rims did not slide all the time, μ if they did.

    >>> law_of_impulses(1.0, -1.0, 1.0, 3.0, 1.5, -0.375)
    (0.5, 0.125, -0.25)
    """
    return pn * soft / un - 1.0, pt * slick / ut - 1.0 if ut != 0.0 else 0.0, pt / pn

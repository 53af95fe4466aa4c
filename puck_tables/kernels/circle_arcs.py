"""Sums of the slip direction along arcs of circles about the centre of a base.

An arc begins opposite to the centre of rotation C, where its radius ρ is farthest from it, and ends
at a point at the angle η from there.  With A = α and B = β ρ the slip there is the third side w of
a triangle, w² = A² + B² + 2AB cos η.  Of its two other angles, τ, that of the slip, and η − τ, let
φ be the one next to the shorter side and r the shorter side over the longer; then Δ² = 1 − r² sin²φ
is the square of the cosine of the other one, and along the circle all sums are those of

    F = ∫ dφ/Δ ,   D = ∫ sin²φ dφ/Δ ,   E = F − r² D ,   T = ∫ sin²φ Δ dφ
      = (D + 2E − F − sin φ cos φ Δ)/3

and powers of sin φ.  F and D come by the arithmetic–geometric mean, with the angle φ_n/2ⁿ known by
how much the doubled angles fall short of being doubled: no digit is lost for r → 0 and for r → 1,
and there is no branch, so that a loop over many points does several at once.
"""

from __future__ import annotations

import math
from typing import Any

from puck_tables.contact import closed_form
from puck_tables.kernels.base_sums import Sums
from puck_tables.kernels.compile import inlined
from puck_tables.kernels.elementary import angle_of

_LEAST = 3e-5  # of √(1 − r²): closer to the circle through C an arc is as one there
_ON_C = 1e-28  # of the square of the slip: closer to C its direction is lost
_elliptic: Any = inlined(closed_form.elliptic)


@inlined
def _incomplete(sine: float, cosine: float, delta: float, shorter: float) -> tuple[float, float]:
    """F and D of an angle between −π and π; ``shorter``: √(1 − r²)."""
    a, b = 1.0, shorter
    inverse = 1.0 / delta
    # φ and its double, less by what it falls short: the mean of two directions
    turned_c, turned_s = cosine * inverse, b * sine * inverse
    mean_c, mean_s = cosine + turned_c, sine + turned_s
    angle = angle_of(abs(mean_s), abs(mean_c))
    angle = math.pi - angle if mean_c < 0.0 else angle
    angle = -angle if sine < 0.0 else angle
    cosine, sine = cosine * turned_c - sine * turned_s, sine * turned_c + cosine * turned_s
    a, b = 0.5 + 0.5 * b, math.sqrt(b)
    c_over = 0.25 / a  # c_n/r²; (1 − b)/2 = r²/(2 (1 + b))
    c = 0.5 * (1.0 - shorter)
    total, swing = c * c_over, c_over * sine
    share, power = 0.25, 2.0
    for n in range(4):
        delta = math.sqrt(a * a * cosine * cosine + b * b * sine * sine)
        inverse = 1.0 / delta
        product = sine * cosine * inverse
        short = (a - b) * product
        if n < 2:
            short = angle_of(short, (a * cosine * cosine + b * sine * sine) * inverse)
        else:  # its sine is small
            square = short * short
            more = 5.0 / 112.0 + square * (35.0 / 1152.0 + square * (63.0 / 2816.0))
            short = short * (1.0 + square * (1.0 / 6.0 + square * (0.075 + square * more)))
        angle = angle - share * short
        cosine, sine = (a * cosine * cosine - b * sine * sine) * inverse, (a + b) * product
        a, b = 0.5 * (a + b), math.sqrt(a * b)
        c_over = 0.25 * c * c_over / a
        c = 0.25 * c * c / a
        total, swing = total + power * c * c_over, swing + c_over * sine
        share, power = 0.5 * share, 2.0 * power
    # of one more step what is left
    doubled, per = 2.0 * sine * cosine, 2.0 / (a + b)
    first = (angle - 0.5 * share * (a - b) * doubled * per) * per
    swing += 0.25 * c * c_over * per * doubled
    return first, 0.5 * first + first * total - swing


@inlined
def arc_to(alpha: float, beta: float, x: float, y: float, rho: float, far: float) -> Sums:
    """The sums by the angle up to a point at the distance ``rho``; x = 0 counts as right of C.

    ``far`` 1: from opposite to C on, −1: from next to it.  Those that are the same on both sides of
    the line through C begin anywhere.
    """
    inverse = 1.0 / rho
    s, c = x * inverse, -y * inverse
    one, two = alpha, beta * rho
    ux, uy = alpha - beta * y, beta * x
    square = ux * ux + uy * uy
    lost, w = square < _ON_C, math.sqrt(max(square, _ON_C))
    outside = one >= two  # C is outside the circle
    long, short = (one, two) if outside else (two, one)
    per = 1.0 / long
    r = short * per
    back = 1.0 / w
    sine = 0.0 if lost else long * s * back
    cosine = 1.0 if lost else (short + long * c) * back
    rest = max(math.sqrt((long - short) * (long + short)) * per, _LEAST)
    delta = max((long + short * c) * back, rest)
    first, d = _incomplete(far * sine, far * cosine, delta, rest)
    rr, ss, turn = r * r, sine * sine, sine * cosine * delta
    e = first - rr * d
    t = (d + 2.0 * e - first - turn) / 3.0
    slow = e + r * sine
    fast = sine + r * (first - d)
    mild = t + turn + r * sine * (1.0 - 2.0 / 3.0 * ss)
    hard = sine - 2.0 / 3.0 * rr * sine * ss + r * (e - 2.0 * t)
    aside = rho * (e - t + 2.0 / 3.0 * r * sine * ss - turn)
    whole = one + two
    l0 = 2.0 * (1.0 - c) / (whole + w)
    l1 = l0 * (4.0 + 2.0 * c - whole * l0) / 6.0
    along = -rho * two * l1
    return (
        slow if outside else fast,
        two * l0,
        rho * (one * l0 + two * l1),
        -rho * (hard if outside else mild),
        r * aside if outside else aside,
        along,
        rho * rho * (two * l0 + one * l1),
        -rho * rho * (mild if outside else hard),
    )


@inlined
def circle_at(alpha: float, beta: float, rho: float) -> Sums:
    """The sums by the angle over a whole circle, by complete integrals."""
    one, two = alpha, beta * rho
    outside = one >= two
    long, short = (one, two) if outside else (two, one)
    r = short / long
    rest = (1.0 - r) * (1.0 + r)
    b, d, g = _elliptic(r)
    mild = 4.0 / 3.0 * (b + 2.0 * rest * d)
    hard = 4.0 / 3.0 * r * r * r * (d - g)
    aside = 4.0 / 3.0 * rho * (2.0 * b + rest * d)
    return (
        4.0 * (b + rest * d if outside else r * b),
        0.0,
        0.0,
        -rho * (hard if outside else mild),
        r * aside if outside else aside,
        0.0,
        0.0,
        -rho * rho * (mild if outside else hard),
    )

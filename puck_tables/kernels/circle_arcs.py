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
from typing import Any, NamedTuple

from puck_tables.contact import closed_form
from puck_tables.kernels.base_sums import Sums
from puck_tables.kernels.compile import inlined
from puck_tables.kernels.elementary import angle_of, direction_of

_STEPS = 4  # of the mean
_LEAST = 3e-5  # of √(1 − r²): closer to the circle through C an arc is as one there
_ON_C = 1e-28  # of the square of the slip: closer to C its direction is lost
# of √(1 − r²): below each it takes a step more than two, of which the last is but 3e-15 of F
_MORE_STEPS = (0.6, 0.1, 3e-3, 1e-5)
_CLOSEST = 1e-8  # of √(1 − r²): what is less is rounding
_NO_ARC = 1e-13  # rad: of what is shorter rounding says where it ends
_elliptic: Any = inlined(closed_form.elliptic)


@inlined
def _incomplete(
    sine: float, cosine: float, delta: float, shorter: float, steps: int, more: float
) -> tuple[float, float]:
    """F and D of an angle between −π and π, or so much more; ``shorter``: √(1 − r²)."""
    a, b = 1.0, shorter
    # φ and its double, less by what it falls short: the mean of two directions
    angle = direction_of(sine * (delta + b), cosine * (delta + a)) + more
    inverse = 1.0 / delta
    turned_c, turned_s = cosine * inverse, b * sine * inverse
    cosine, sine = cosine * turned_c - sine * turned_s, sine * turned_c + cosine * turned_s
    a, b = 0.5 + 0.5 * b, math.sqrt(b)
    c_over = 0.25 / a  # c_n/r²; (1 − b)/2 = r²/(2 (1 + b))
    c = 0.5 * (1.0 - shorter)
    total, swing = c * c_over, c_over * sine
    share, power = 0.25, 2.0
    for n in range(steps):
        delta = math.sqrt(a * a * cosine * cosine + b * b * sine * sine)
        inverse = 1.0 / delta
        product = sine * cosine * inverse
        short = (a - b) * product
        if n < steps - 2:
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
    first, d = _incomplete(far * sine, far * cosine, delta, rest, _STEPS, 0.0)
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


class ArcIntegrals(NamedTuple):
    """Of an arc between any two points, in the longer of its radius and how far C is: (F, D, E, T).

    ``r``, ``rest``: the shorter, and 1 − r²; ``first``, ``third``, ``fifth``: by how much sin φ and
    its powers differ; ``swing``: sin φ cos φ Δ³; then of its ends the mean of w, by how much w
    differs over 2 r, which is ``slope``, and the mean of cos η.
    """

    F: float
    D: float
    E: float
    T: float
    r: float
    rest: float
    first: float
    third: float
    fifth: float
    swing: float
    mean: float
    slope: float
    middle: float


@inlined
def _amplitude_at(
    r: float, off: float, shorter: float, c: float, s: float
) -> tuple[float, float, float, float]:
    """Sin φ, cos φ and Δ of the point at an angle η, and w."""
    ahead = s * s / (1.0 - c) - off if c < 0.0 else r + c
    w = math.sqrt(s * s + ahead * ahead)
    delta = math.sqrt(ahead * ahead + (shorter * s) ** 2)
    if not w > 0.0:
        return 0.0, -1.0, 1.0, 0.0
    back = 1.0 / w
    return s * back, ahead * back, delta * back, w


@inlined
def along_arc(
    r: float, off: float, bc: float, bs: float, ec: float, es: float, turn: float
) -> ArcIntegrals:
    """An arc over 0 < ``turn`` ≤ 2π, from η with a cosine and a sine to another; ``off``: 1 − r.

    F and E of what lies between are those of one angle, by the theorem of addition.
    """
    rest = off * (1.0 + r)
    shorter = max(math.sqrt(rest), _CLOSEST)
    s0, c0, d0, w0 = _amplitude_at(r, off, shorter, bc, bs)
    s1, c1, d1, w1 = _amplitude_at(r, off, shorter, ec, es)
    up, ahead = s1 * c0 * d0 - s0 * c1 * d1, c0 * c1 + s0 * s1 * d0 * d1
    back = 1.0 / math.sqrt(up * up + ahead * ahead)
    sine, cosine = up * back, ahead * back
    # beyond π: told from rounding below 0, and a whole turn from none
    past = (sine < 0.0 and (sine < -0.2 or cosine < 0.0)) or (turn > 3.0 and sine <= 0.0 < cosine)
    more, steps = (2.0 * math.pi if past and turn > _NO_ARC else 0.0), 2
    for k in range(len(_MORE_STEPS)):
        steps += 1 if shorter < _MORE_STEPS[k] else 0
    delta = math.sqrt(ahead * ahead + (shorter * up) ** 2) * back
    first, d = _incomplete(sine, cosine, delta, shorter, steps, more)
    product = sine * s0 * s1
    e, d = first - r * r * (d + product), d + product
    one, other = s1 * c1 * d1, s0 * c0 * d0
    t = (d + 2.0 * e - first - one + other) / 3.0
    third, fifth = s1 * s1 * s1 - s0 * s0 * s0, s1**5 - s0**5
    swing, both = one * d1 * d1 - other * d0 * d0, w0 + w1
    slope = (ec - bc) / both if both > 0.0 else 0.0
    return ArcIntegrals(
        first, d, e, t, r, rest, s1 - s0, third, fifth, swing, 0.5 * both, slope, 0.5 * (ec + bc)
    )  # fmt: skip


@inlined
def slips_along(arc: ArcIntegrals) -> tuple[float, float, float, float, float]:
    """∫ w dη times 1, cos η, cos² η, sin η and sin η cos η."""
    F, D, E, T, r, rest, first, third, fifth, swing, mean, g, middle = arc
    rr = r * r
    fourth = (swing - E + (2.0 + 4.0 * rr) * T) / 5.0  # r² ∫ sin⁴φ Δ dφ
    step = 2.0 * r * g  # by which w differs
    square = mean * mean + step * step / 12.0
    across = (middle - 0.25 * g * step) * square
    across += g * step * (5.0 / 12.0 * mean * mean + step * step / 80.0)
    return (
        E + 2.0 * r * first + rr * (F - D),
        (1.0 + rr) * first - 4.0 / 3.0 * rr * third + r * (2.0 * E + rest * D - 4.0 * T),
        (1.0 + rr) * E - 8.0 * rr * T + 8.0 * fourth - rest * D
        + 2.0 * r * (first - 2.0 / 3.0 * (1.0 + rr) * third + 0.8 * rr * fifth),
        -2.0 * g * square,
        -2.0 * g * across,
    )  # fmt: skip


@inlined
def slips_under(arc: ArcIntegrals) -> tuple[float, float, float, float, float]:
    """∫ dη/w times 1, cos η, cos² η, sin η and sin η cos η."""
    g = arc.slope
    return (
        arc.F, arc.first - arc.r * arc.D,
        arc.E - 2.0 * arc.T + arc.D - 2.0 / 3.0 * arc.r * arc.third,
        -2.0 * g, -2.0 * g * (arc.middle - arc.r * g * g / 3.0),
    )  # fmt: skip

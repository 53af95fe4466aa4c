"""Sums of the slip direction along borders under a base, under a tabulated pressure.

With P the sums along an arc about the centre of the base up to a point, and W a pressure that
depends on the distance ρ from there alone, those over a part that no arc enters by C are

    ∫ W e dA = −∮ W P ρ dρ

along its boundary, of which the rim takes nothing.  P is smooth along a border, but for where that
passes C or the centre; W, straight between its rows, bends.  So that panels are as short as they
are close to those two, on each P, and ρ P, is the polynomial through Gauss's nodes, and that
times W is integrated as it is: Legendre's P_k times a jump gives P_{k+1} − P_{k−1} where it is.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.base_sums import NOTHING, Sums, added
from puck_tables.kernels.circle_arcs import arc_to
from puck_tables.kernels.compile import inlined, inner, summed
from puck_tables.kernels.elementary import angle_of, cosine_sine_of

_NODES = 24  # of Gauss's rule an arc
_NODE, _WEIGHT = np.polynomial.legendre.leggauss(_NODES)
_LEGENDRE = np.ascontiguousarray(
    (np.polynomial.legendre.legvander(_NODE, _NODES - 1) * _WEIGHT[:, None]).T
)
_INVERSE = 1.0 / np.arange(1.0, _NODES + 1.0)
_REACH = 1.5  # of the ellipse about a panel, its long axis over the distance of its foci
_GAP = 1e-4  # radii: what is singular and closer to a border is as good as there
_FARTHEST = 20.0  # radii: and a C farther away


class Border(NamedTuple):
    """A border by a place u along it, 0 where it is next to the centre of the base.

    Straight, (x, y) + u (tx, ty), or of a circle with a radius about (x, y), u the angle from the
    direction (tx, ty).  It goes from ``low`` to ``high``, and crosses the ray from the centre
    through C at ``one`` and ``two``, if at all; a straight one is on one side of it up to ``one``
    and on another after that, −1 or 1, the latter right of it.
    """

    x: float
    y: float
    tx: float
    ty: float
    radius: float
    low: float
    high: float
    one: float
    two: float
    before: float
    after: float


@inlined
def _panel_to(a: float, place: float, gap: float) -> float:
    """How long a panel from a on may be next to what is singular at place ± i gap."""
    off = place - a
    return 2.0 * (_REACH * math.sqrt(off * off + gap * gap) - off) / (_REACH * _REACH - 1.0)


@inlined
def _bends(
    radii: FloatArray, places: FloatArray, pieces: FloatArray, turns: FloatArray, border: Border
) -> tuple[int, int]:
    """Where the pressure bends along a border, ascending, and its piece from there on.

    How many, and its piece where the border begins: how many rows are closer to the centre.
    """
    apart = math.sqrt(border.x * border.x + border.y * border.y)
    near, first, last = apart, 0, radii.size - 1
    if border.radius > 0.0:
        near = abs(apart - border.radius)
    while first < last and radii[first] <= near:
        first += 1
    if border.radius > 0.0:
        span = 4.0 * apart * border.radius
        while last > first and (radii[last - 1] - near) * (radii[last - 1] + near) >= span:
            last -= 1
        for i in range(last - first):
            square = max((radii[first + i] - near) * (radii[first + i] + near), 0.0)
            turns[i] = 2.0 * angle_of(math.sqrt(square), math.sqrt(max(span - square, 0.0)))
    else:
        for i in range(last - first):
            turns[i] = math.sqrt(max((radii[first + i] - near) * (radii[first + i] + near), 0.0))
    count, start = 0, last
    for n in range(last - first):  # inwards
        i = last - first - 1 - n
        if turns[i] < -border.low:
            if -turns[i] < border.high:
                places[count], pieces[count] = -turns[i], float(first + i)
                count += 1
        else:
            start = first + i
    for i in range(last - first):  # and out again
        if turns[i] > border.low:
            if turns[i] < border.high:
                places[count], pieces[count] = turns[i], float(first + i + 1)
                count += 1
        else:
            start = first + i + 1
    return count, start


@inlined
def _moments(
    base: FloatArray, slope: FloatArray, places: FloatArray, pieces: FloatArray, start: int,
    room: FloatArray, middle: float, half: float, wa: FloatArray, wb: FloatArray,
) -> None:  # fmt: skip
    """The weights of a panel in which the pressure bends, those of P and those of ρ P."""
    count = places.size
    t, before, here = room[:count], room[count : 2 * count], room[2 * count : 3 * count]
    more_a, more_b = room[3 * count : 4 * count], room[4 * count : 5 * count]
    piece = start
    for i in range(count):
        after = int(pieces[i])
        t[i] = (places[i] - middle) / half
        more_a[i], more_b[i] = base[after] - base[piece], slope[after] - slope[piece]
        before[i], here[i] = 1.0, 1.0
        piece = after
    for j in range(_NODES):
        wa[j], wb[j] = _WEIGHT[j] * base[start], _WEIGHT[j] * slope[start]
    for k in range(_NODES):
        of_a, of_b, twice, lower, per = 0.0, 0.0, 2.0 * k + 1.0, 1.0 * k, _INVERSE[k]
        for i in range(count):
            after = (twice * t[i] * here[i] - lower * before[i]) * per
            jump = 0.5 * (before[i] - after)
            of_a, of_b = summed(of_a, more_a[i] * jump), summed(of_b, more_b[i] * jump)
            before[i], here[i] = here[i], after
        for j in range(_NODES):
            wa[j] += of_a * _LEGENDRE[k, j]
            wb[j] += of_b * _LEGENDRE[k, j]


@inlined
def _node(
    alpha: float, beta: float, x: float, y: float, side: float, of_p: float, of_rho_p: float
) -> tuple[float, Sums]:
    rho = math.sqrt(x * x + y * y)
    at = side * max(abs(x), 1e-300) if y > 0.0 and side != 0.0 else x
    return of_p + rho * of_rho_p, arc_to(alpha, beta, at, y, rho)


@inner
def border_sums(
    rows: FloatArray, room: FloatArray, count: int, alpha: float, beta: float, border: Border
) -> Sums:
    """−∫ W P ρ dρ along a border.

    ``rows``: radii, and of the pieces of W = A + B ρ before and after each A and B, flat.
    """
    radii, base = rows[:count], rows[count : 2 * count + 1]
    slope = rows[2 * count + 1 : 3 * count + 2]
    places, pieces = room[: 2 * count], room[2 * count : 4 * count]
    wa, wb = room[4 * count : 4 * count + _NODES], room[4 * count + _NODES : 4 * count + 2 * _NODES]
    rest = room[4 * count + 2 * _NODES :]
    bends, piece = _bends(radii, places, pieces, rest, border)
    x, y, tx, ty, radius = border.x, border.y, border.tx, border.ty, border.radius
    c = alpha / beta if alpha < _FARTHEST * beta else _FARTHEST
    ahead, aside = (c - y) * ty - x * tx, (c - y) * tx + x * ty
    own, centre, gap, least, lap = math.sqrt(x * x + y * y), ahead, abs(aside), _GAP, math.inf
    per = own * radius
    if radius > 0.0:
        reach = math.sqrt(ahead * ahead + aside * aside)
        centre, gap = math.atan2(aside, ahead), abs(math.log(max(reach, 1e-300) / radius))
        own, least, lap = abs(math.log(own / radius)), min(_GAP / radius, 0.3), 2.0 * math.pi
    gap, own = max(gap, least), max(own, least)
    other = centre - lap if centre > 0.0 else centre + lap
    sums, a, k = NOTHING, border.low, 0
    while a < border.high:
        side, last = border.before, border.one
        if a >= border.one:
            side, last = border.after, border.two if a < border.two else border.high
        size = min(_panel_to(a, centre, gap), _panel_to(a, 0.0, own))
        if radius > 0.0:
            size = min(
                size, _panel_to(a, other, gap), _panel_to(a, lap, own), _panel_to(a, -lap, own)
            )
        if size > 0.5 * (last - a):
            size = last - a if size >= last - a else 0.5 * (last - a)
        half = 0.5 * size
        middle, end, first = a + half, a + size if size < last - a else last, k
        while k < bends and places[k] < end:
            k += 1
        if k > first:
            _moments(
                base, slope, places[first:k], pieces[first:k], piece, rest, middle, half, wa, wb
            )
            piece = int(pieces[k - 1])
        else:
            for j in range(_NODES):
                wa[j], wb[j] = _WEIGHT[j] * base[piece], _WEIGHT[j] * slope[piece]
        part = NOTHING
        if radius == 0.0:
            for j in range(_NODES):
                u = middle + half * _NODE[j]
                weight, here = _node(alpha, beta, x + u * tx, y + u * ty, side, wa[j], wb[j])
                part = added(part, -half * u * weight, here)
        else:
            for j in range(_NODES):
                cosine, sine = cosine_sine_of(middle + half * _NODE[j])
                cosine, aside = radius * cosine, radius * sine
                weight, here = _node(
                    alpha, beta, x + cosine * tx - aside * ty, y + cosine * ty + aside * tx,
                    0.0, wa[j], wb[j],
                )  # fmt: skip
                part = added(part, -half * per * sine * weight, here)
        sums = added(sums, 1.0, part)
        a = end
    return sums

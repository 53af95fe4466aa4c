"""Integrals along paths under a round base that is pressed by any round pressure.

With P the sums of the slip direction along an arc about the centre of the base up to a point of a
path (:mod:`puck_tables.kernels.circle_arcs`), F those of a whole circle, and W a pressure that
depends on the distance ρ from the centre alone, they are

    −∫ W P ρ dρ   along a border,    ∫ W F ρ dρ   along the ray through the centre of rotation C .

On every path ρ² = n² + m sin²θ, n the least distance from the centre, and 1 − ρ² = s + m cos²θ, s =
0 where it ends at the rim: so Hertz's W = (3/2) √(1 − ρ²) and Galin's 1/(2 √(1 − ρ²)) are no roots.

P and F are smooth, but at C, where they are as r ln r, and at the centre.  About a C that is close
θ is a cube of what Gauss's panels are laid on, and these are as short as they are close to what is
singular.  A tabulated W, straight between its rows, bends: there P, and ρ P, is the polynomial
through the nodes, and that times W is integrated as it is: Legendre's P_k times a jump gives
P_{k+1} − P_{k−1} where it is.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.base_friction import HEAD, PRESSURE, ROWS
from puck_tables.kernels.base_sums import GALIN, HERTZ, NOTHING, Sums, added, plus
from puck_tables.kernels.circle_arcs import arc_to, circle_at
from puck_tables.kernels.compile import inlined, inner, summed
from puck_tables.kernels.elementary import angle_of, cosine_sine_of
from puck_tables.kernels.polygon_sums import PIECE_COLUMNS

# how many nodes Gauss's rules have, and how short panels are for them: ellipses about them of
# which what is singular is not inside, by their long axes over the distances of their foci; 1e-10:
# test_resultants_against_circles
_COUNTS, _REACHES = np.array([10, 16, 24]), np.array([2.0, 1.3, 1.13])
_FINEST, _NODES = 2, 24
_SHORT = 0.5  # rad: what the first is good for
_REACH_OF_KINKS = 1.85  # where W bends, to interpolate is as good as a rule of half as many nodes
_RULES = [np.polynomial.legendre.leggauss(n) for n in _COUNTS]
_NODE, _WEIGHT = (np.stack([np.pad(r[k], (0, _NODES - len(r[k]))) for r in _RULES]) for k in (0, 1))
_LEGENDRE = np.ascontiguousarray(
    (np.polynomial.legendre.legvander(_NODE[_FINEST], _NODES - 1) * _WEIGHT[_FINEST][:, None]).T
)
_INVERSE = 1.0 / np.arange(1.0, _NODES + 1.0)  # to multiply is quicker than to divide
GAP, NONE = 3e-6, 9.0  # rad: closer to the centre a path passes it; what is not there is far off
_GAP_OF_C, _GAP_OF_KINKS = 1e-5, 0.1  # cubes leave no more of a C as close; where W bends
_CLOSE = 0.35  # of the length of a path: a C as close
NEXT_TO_C = 2.0  # in place of a side
_FIRST = HEAD + PIECE_COLUMNS  # behind the contour of a base
WHOLE, _MARKS, _WEIGHTS = 0, 4, 14  # in the room of a base, behind the θ of its rows

Five = tuple[float, float, float, float, float]


class Path(NamedTuple):
    """A path by the angle θ; from the foot (x, y) on along (tx, ty), ``along`` · sin θ.

    That is times √(1 − ``bent``² sin² θ) if it is an arc, and turns off by ``deep`` sin² θ to its
    left.  ``along`` 0: the ray from the centre.  ρ² = near² + room sin² θ, 1 − ρ² = spare + room
    cos² θ.  ``places`` ± i ``gaps``: what is singular, C first.
    """

    x: float
    y: float
    tx: float
    ty: float
    along: float
    bent: float
    deep: float
    near: float
    room: float
    spare: float
    places: Five
    gaps: Five


@inlined
def _cube_root(x: float, y: float) -> tuple[float, float]:
    """Of x + iy, y ≥ 0."""
    size, angle = float(np.cbrt(math.sqrt(x * x + y * y))), angle_of(y, abs(x))
    cosine, sine = cosine_sine_of((1.0 / 3.0) * (angle if x > 0.0 else math.pi - angle))
    return size * cosine, size * sine


@inlined
def _theta(first: float, scale: float, cubed: bool, v: float) -> float:
    return first + scale * (v * v * v if cubed else v)


@inlined
def _panel_to(a: float, place: float, gap: float, reach: float) -> float:
    """How long a panel from a on may be next to what is singular at place ± i gap."""
    off = place - a
    return 2.0 * (reach * math.sqrt(off * off + gap * gap) - off) / (reach * reach - 1.0)


@inlined
def room_of(base: FloatArray) -> int:
    """Where there is room to work: the θ of rows, the sums over a whole base, and more."""
    return _FIRST + 3 * int(base[ROWS]) + 2


@inlined
def find_kinks(base: FloatArray, path: Path) -> None:
    """Into the room of a base the θ > 0 of its rows, −1 of those always, 4 of those never met."""
    room = base[room_of(base) :]
    for i in range(int(base[ROWS])):
        rho = base[_FIRST + i]
        part = (rho - path.near) * (rho + path.near)
        rest = max(path.room - part, 0.0)
        angle = angle_of(math.sqrt(max(part, 0.0)), math.sqrt(rest)) if rest > 0.0 else 4.0
        room[i] = angle if part > 0.0 else -1.0


@inlined
def _kinks_between(base: FloatArray, one: float, other: float) -> bool:
    """Whether the pressure bends between two θ."""
    room, low, high, met = base[room_of(base) :], min(one, other), max(one, other), 0
    for i in range(int(base[ROWS])):
        met += 1 if room[i] > 0.0 and (low < room[i] < high or low < -room[i] < high) else 0
    return met > 0


@inlined
def _fill_weights(
    base: FloatArray, first: float, scale: float, cubed: bool, low: float, size: float, rule: int
) -> None:
    """The weights of P and of ρ P in a panel from ``low`` on, θ = ``first`` + ``scale`` v."""
    count, room = int(base[ROWS]), base[room_of(base) :]
    of_a = base[_FIRST + count : _FIRST + 2 * count + 1]
    of_b = base[_FIRST + 2 * count + 1 : _FIRST + 3 * count + 2]
    wa, wb = room[count + _WEIGHTS :], room[count + _WEIGHTS + _NODES :]
    rest = room[count + _WEIGHTS + 2 * _NODES :]
    t, before, here = rest[: 2 * count], rest[2 * count : 4 * count], rest[4 * count : 6 * count]
    more_a, more_b = rest[6 * count : 8 * count], rest[8 * count : 10 * count]
    begin, end = _theta(first, scale, cubed, low), _theta(first, scale, cubed, low + size)
    begin += 1e-12 * (end - begin)  # past a row where panels meet
    piece, met = 0, 0
    for i in range(count):
        piece += 1 if room[i] < abs(begin) else 0
        for sense in range(2):
            side = 1.0 if sense == 0 else -1.0
            place = side * room[i]
            if room[i] > 0.0 and (place - begin) * (place - end) < 0.0:
                v = (place - first) / scale
                v = float(np.cbrt(v)) if cubed else v
                t[met], before[met], here[met] = 2.0 * (v - low) / size - 1.0, 1.0, 1.0
                half = 0.5 * side if scale > 0.0 else -0.5 * side
                more_a[met] = half * (of_a[i + 1] - of_a[i])
                more_b[met] = half * (of_b[i + 1] - of_b[i])
                met += 1
    for j in range(_NODES):
        wa[j], wb[j] = _WEIGHT[rule, j] * of_a[piece], _WEIGHT[rule, j] * of_b[piece]
    if met == 0:
        return
    for k in range(_NODES):
        sum_a, sum_b, twice, lower, per = 0.0, 0.0, 2.0 * k + 1.0, 1.0 * k, _INVERSE[k]
        for i in range(met):
            after = (twice * t[i] * here[i] - lower * before[i]) * per
            part = before[i] - after
            sum_a, sum_b = summed(sum_a, more_a[i] * part), summed(sum_b, more_b[i] * part)
            before[i], here[i] = here[i], after
        for j in range(_NODES):
            wa[j] += sum_a * _LEGENDRE[k, j]
            wb[j] += sum_b * _LEGENDRE[k, j]


@inlined
def _loaded(
    path: Path, sine: float, cosine: float, rho: float, hertz: float, galin: float, weight: float,
    wa: float, wb: float,
) -> float:  # fmt: skip
    """W ρ dρ/dθ at a node of a weight."""
    root = math.sqrt(max(path.spare + path.room * cosine * cosine, 1e-300))
    law = wa + rho * wb + weight * (hertz * root + galin / root)
    return path.room * sine * cosine * law


@inner
def _panel(
    base: FloatArray, alpha: float, beta: float, path: Path, side: float, first: float,
    scale: float, cubed: bool, low: float, size: float, rule: int,
) -> Sums:  # fmt: skip
    """One panel; ``side`` as in :func:`between`."""
    count, law, room = int(base[ROWS]), int(base[PRESSURE]), base[room_of(base) :]
    wa, wb = room[count + _WEIGHTS :], room[count + _WEIGHTS + _NODES :]
    if count > 0:
        _fill_weights(base, first, scale, cubed, low, size, rule)
    hertz, galin = (1.5 if law == HERTZ else 0.0), (0.5 if law == GALIN else 0.0)
    half, sums = 0.5 * size, NOTHING
    middle, by = low + half, half * abs(scale) * (3.0 if cubed else 1.0)
    if path.along == 0.0:
        for j in range(_COUNTS[rule]):
            v = middle + half * _NODE[rule, j]
            square = v * v if cubed else 1.0
            cosine, sine = cosine_sine_of(first + scale * v * square)
            weight = _loaded(path, sine, cosine, sine, hertz, galin, _WEIGHT[rule, j], wa[j], wb[j])
            sums = added(sums, by * square * weight, circle_at(alpha, beta, sine))
        return sums
    rest, far = (1.0 - path.bent) * (1.0 + path.bent), -1.0 if side == NEXT_TO_C else 1.0
    forced = abs(side) == 1.0
    for j in range(_COUNTS[rule]):
        v = middle + half * _NODE[rule, j]
        square = v * v if cubed else 1.0
        cosine, sine = cosine_sine_of(first + scale * v * square)
        leg = path.bent * cosine
        ahead, aside = path.along * sine * math.sqrt(rest + leg * leg), path.deep * sine * sine
        x = path.x + ahead * path.tx - aside * path.ty
        y = path.y + ahead * path.ty + aside * path.tx
        rho = math.sqrt(x * x + y * y)
        weight = _loaded(path, sine, cosine, rho, hertz, galin, _WEIGHT[rule, j], wa[j], wb[j])
        x = side * max(abs(x), 1e-300) if y > 0.0 and forced else x
        here = arc_to(alpha, beta, x, y, max(rho, 1e-300), far)
        sums = added(sums, -by * square * weight, here)
    return sums


@inlined
def _longest(marks: FloatArray, v: float, reach: float) -> float:
    size = 1.0 - v
    for i in range(5):
        size = min(size, _panel_to(v, marks[i], marks[5 + i], reach))
    return size


@inner
def _interval(
    base: FloatArray, alpha: float, beta: float, path: Path, low: float, high: float, side: float
) -> Sums:
    """Sums over angles from low to high of a path that does not pass the centre of the base."""
    if not low < high:
        return NOTHING
    centre, gap, sums, rows = path.places[0], path.gaps[0], NOTHING, base[ROWS] > 0.0
    marks = base[room_of(base) + int(base[ROWS]) + _MARKS :]
    off = max(low - centre, centre - high, 0.0)
    cubed = math.sqrt(off * off + gap * gap) < _CLOSE * (high - low)
    for sense in range(2 if cubed else 1):  # up from the angle of C, and down if it is close
        first, begin, end, sign = low, 0.0, high - low, 1.0
        if cubed:
            first, begin, end = centre, low - centre, high - centre
            if sense == 1:
                begin, end, sign = -end, -begin, -1.0
        if not end > 1e-12 * (high - low):
            continue
        for i in range(5):
            x, y = sign * (path.places[i] - first) / end, path.gaps[i] / end
            marks[i], marks[5 + i] = _cube_root(x, y) if cubed else (x, y)
        if cubed and gap < _GAP_OF_C:
            marks[5] = _GAP_OF_KINKS if rows else NONE
        v, by = float(np.cbrt(max(begin / end, 0.0))) if cubed else 0.0, sign * end
        while v < 1.0:
            rule, left = 0 if end * (1.0 - v) < _SHORT else 1, 1.0 - v
            size = _longest(marks, v, _REACHES[rule])
            while rule < _FINEST and size < left:
                rule += 1
                size = _longest(marks, v, _REACHES[rule])
            if rows and _kinks_between(
                base, _theta(first, by, cubed, v), _theta(first, by, cubed, v + size)
            ):
                rule, size = _FINEST, _longest(marks, v, _REACH_OF_KINKS)
            size = 0.5 * left if 0.5 * left < size < left else size
            part = _panel(base, alpha, beta, path, side, first, by, cubed, v, size, rule)
            sums = plus(sums, 1.0, part)
            v = v + size if size < left else 1.0
    return sums


@inner
def between(
    base: FloatArray, alpha: float, beta: float, path: Path, low: float, high: float, side: float
) -> Sums:
    """−∫ W P ρ dρ between two angles of a path, of the ray ∫ W F ρ dρ.

    ``side``: −1 or 1 where it is certain on which side of the ray it is, else 0; ``NEXT_TO_C``:
    with the P of arcs that begin next to C, which does not jump on the ray.
    """
    middle = min(max(low, 0.0), high) if path.near < GAP else high
    sums = _interval(base, alpha, beta, path, low, middle, side)
    return plus(sums, 1.0, _interval(base, alpha, beta, path, middle, high, side))

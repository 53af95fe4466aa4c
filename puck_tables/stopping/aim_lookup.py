"""The launches that stop at one distance, looked up, compiled: values on their curve, and roots.

What :mod:`puck_tables.stopping.launch_family` integrates is read here off a table.  Of a plain puck
that is the stop table cut down to one height: with T = ``time``, X = cos φ · along,
Y = sin φ cos φ · across and the angle sin φ · body by which the puck turns, J = D = r = 1,

    ln Q = −½ (ln cos φ + ½ ln(along² + sin²φ across²)),   arg Z = atan2(sin φ across, along).

Of any other it is the curve itself in pieces, of the fifth degree in u = ln tan φ.
"""

from __future__ import annotations

import math

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, inner, kernel, patience, spline_values
from puck_tables.kernels.quadratic import basis
from puck_tables.stopping.lookup import WIDTH, slip_place

SPEED, RIM, TIME, TURN, DEFLECTION = range(5)
LOGS = 5  # quantities of a piece, the five above
SLIDE = 0.5 * math.log(2.0)  # ln v = ln t₀ of the slide without spin
POWERS = 6  # of a piece
PIECE = 2 + LOGS * POWERS  # where it begins, 1/width, then the powers of each quantity, ascending
NO_PIECES = np.empty((0, PIECE))
_NARROW = 1e-14  # of u, how narrow a bracket gets
_STEPS = 200  # of a root at most


@inlined
def _plain_logs(u: float, section: FloatArray) -> tuple[float, float, float, float, float, float]:
    """Ln v, ln r|ω|, ln t₀ and ln θ at a finite u; the stop along and across the launch."""
    k = math.exp(-abs(u))
    side, xi = slip_place(1.0, k) if u <= 0.0 else slip_place(k, 1.0)
    cells = section.shape[1] // WIDTH - 3
    place = xi * cells
    cell = min(int(place), cells - 1)
    at = side * section.shape[1] + cell * WIDTH
    time, along, across, body = spline_values(
        section.reshape(-1), at, basis(place - cell), 0.0, WIDTH, 1
    )
    larger = -0.5 * math.log1p(k * k)
    log_cosine, log_sine = larger - max(u, 0.0), larger + min(u, 0.0)
    left = math.exp(log_sine) * across
    log_q = -0.5 * (log_cosine + 0.5 * math.log(along * along + left * left))
    log_turn = 2.0 * log_q + log_sine + math.log(body)
    return log_q + log_cosine, log_q + log_sine, log_q + math.log(time), log_turn, along, left


@inlined
def _in_part(quantity: int, u: float, limits: FloatArray) -> float:
    """A quantity from the piece in which u is."""
    first, above = 0, limits.shape[0]
    while above - first > 1:
        middle = (first + above) // 2
        if limits[middle, 0] <= u:
            first = middle
        else:
            above = middle
    t = (u - limits[first, 0]) * limits[first, 1]
    at, value = 2 + POWERS * quantity, 0.0
    for power in range(POWERS - 1, -1, -1):
        value = value * t + limits[first, at + power]
    return value


@inner
def _above(
    u: float, quantity: int, wanted: float, section: FloatArray, limits: FloatArray
) -> float:
    """How much a quantity is above a value."""
    if limits.shape[0] > 0:
        return _in_part(quantity, u, limits) - wanted
    return _plain_logs(u, section)[quantity] - wanted


@inner
def _root(
    quantity: int, wanted: float, low: float, high: float, section: FloatArray, limits: FloatArray
) -> float:
    """The u between two where a quantity has a value, by Chandrupatla's method.

    Where the table does not tell it from that of both ends, the nearer of them.
    """
    a, b = low, high
    at_a = _above(a, quantity, wanted, section, limits)
    at_b = _above(b, quantity, wanted, section, limits)
    if (at_a > 0.0) == (at_b > 0.0):
        return a if abs(at_a) < abs(at_b) else b
    share = 0.5
    for _ in range(_STEPS):
        x = a + share * (b - a)
        here = _above(x, quantity, wanted, section, limits)
        if (here > 0.0) == (at_a > 0.0):
            c, at_c = a, at_a
        else:
            c, at_c = b, at_b
            b, at_b = a, at_a
        a, at_a = x, here
        width, least = abs(b - a), _NARROW * max(1.0, abs(a))
        if at_a == 0.0 or width <= 2.0 * least:
            break
        xi, phi = (a - b) / (c - b), (at_a - at_b) / (at_c - at_b)
        if phi * phi < xi and (1.0 - phi) * (1.0 - phi) < 1.0 - xi:
            share = at_a / (at_b - at_a) * at_c / (at_b - at_c)
            share += (c - a) / (b - a) * at_a / (at_c - at_a) * at_b / (at_c - at_b)
        else:
            share = 0.5
        share = min(max(share, least / width), 1.0 - least / width)
    return a if abs(at_a) < abs(at_b) else b


@kernel
def fill_logs(u: FloatArray, section: FloatArray, limits: FloatArray, out: FloatArray) -> None:
    """Ln v, ln r|ω|, ln t₀, ln θ, and arg Z for ω > 0 at ``u`` (n,) into ``out`` (n, 5); −∞ slides.

    ``section``: of a plain puck, :func:`puck_tables.stopping.lookup.at_height`;
    ``limits`` (m, 32): of any other; none of a plain one.
    """
    for n in range(u.size):
        patience(1)
        if u[n] == -math.inf:
            out[n, SPEED], out[n, RIM], out[n, TIME] = SLIDE, u[n], SLIDE
            out[n, TURN], out[n, DEFLECTION] = u[n], 0.0
        elif limits.shape[0] > 0:
            for quantity in range(LOGS):
                out[n, quantity] = _in_part(quantity, u[n], limits)
        else:
            speed, rim, time, turn, along, left = _plain_logs(u[n], section)
            out[n, SPEED], out[n, RIM], out[n, TIME], out[n, TURN] = speed, rim, time, turn
            out[n, DEFLECTION] = math.atan2(left, along)


@kernel
def fill_roots(
    quantity: int, wanted: FloatArray, low: FloatArray, high: FloatArray, section: FloatArray,
    limits: FloatArray, out: FloatArray,
) -> None:  # fmt: skip
    """The u (n,) between ``low`` and ``high`` (n,) where a quantity has ``wanted`` (n,)."""
    for n in range(wanted.size):
        patience(1)
        if low[n] == high[n]:
            out[n] = low[n]
        else:
            out[n] = _root(quantity, wanted[n], low[n], high[n], section, limits)

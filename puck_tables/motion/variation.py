"""How one motion changes with its launch and its height: variational equations.

Along a motion dy/dz = F(u, ψ; δ) (:mod:`puck_tables.motion.equations_of_motion`) a small change
of a parameter p changes the state at the same z by y_p,

    dy_p/dz = (∂F/∂y) y_p + ∂F/∂p,

which is integrated beside the motion itself.  For p = u₀, the slip at the launch, it begins with
u_p = 1; for δ with 0.  Nothing is differenced: ∂F needs the derivatives of the friction ratios by
u and δ (:mod:`puck_tables.table.friction_section`).

All is linear in y_p, so what is small next to pure sliding and pure spin keeps its digits.  Next to
a line of the friction, where the derivative by u is known badly, steps are as short as the distance
to it.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import allocating, inlined, kernel, patience
from puck_tables.kernels.quadratic import section_slopes
from puck_tables.motion.equations_of_motion import distance_to_line
from puck_tables.motion.path import STOPPED, integrate
from puck_tables.motion.state import LENGTH, PSI, SIZE, THETA, T, U, X, Y
from puck_tables.motion.steppers import Tableau

KEPT = 7  # of the state: all but the work of friction
BY_U, BY_HEIGHT = 1, 2  # blocks; the first is the motion itself
BLOCKS = 3  # with the motion itself
VARIED = BLOCKS * KEPT  # numbers of all blocks
_STAGES = 6  # Dormand and Prince's seventh only tells the error
_STEP_LIMIT = 20_000  # more is a motion that does not end
_SHARE, _NEAREST = 0.5, 1e-8  # of the distance to a line; how near to it a step may be as long
_LONGEST = 0.25  # in u: next to pure motions what counts grows like its exponential
# a launch of nearly pure motion still turns where little is left of Q, and its time tells so
_LAST, _TAIL_STEP = 1e-4, 0.25


@kernel
def variation_rates(z: float, y: FloatArray, section: FloatArray, out: FloatArray) -> None:
    """d/dz of a state and its two variations (21,), into ``out``, by all six functions."""
    u, turned = y[U], y[PSI]
    k = math.exp(-abs(u))
    large = 1.0 / math.sqrt(1.0 + k * k)
    fast = u > 0.0
    c, s = (k * large, large) if fast else (large, k * large)
    inverse, across, spin, inverse_u, across_u, spin_u, inverse_h, across_h, spin_h = (
        section_slopes(k, fast, section)
    )
    c2, s2 = c * c, s * s
    left = 1.0 - z
    q = left * left * left * left
    brake = 1.0 / (c2 + s2 * spin)
    norm = 4.0 / left * brake
    cosine, sine = math.cos(turned), math.sin(turned)
    rate = q * q * inverse * norm
    out[U] = (1.0 - spin) * norm
    out[PSI] = -s * across * norm
    out[T] = q * inverse * norm
    out[X], out[Y] = rate * c * cosine, rate * c * sine
    out[THETA], out[LENGTH] = rate * s, rate * c
    for block in range(1, BLOCKS):
        at = block * KEPT
        du, dturn = y[at + U], y[at + PSI]
        d_inverse, d_across, d_spin = inverse_u * du, across_u * du, spin_u * du
        if block == BY_HEIGHT:
            d_inverse = d_inverse + inverse_h
            d_across = d_across + across_h
            d_spin = d_spin + spin_h
        lost = -brake * (2.0 * s2 * c2 * (spin - 1.0) * du + s2 * d_spin)  # d ln N
        share = d_inverse + inverse * lost
        dc, ds = -c * s2 * du, s * c2 * du
        unit = q * q * norm
        out[at + U] = norm * ((1.0 - spin) * lost - d_spin)
        out[at + PSI] = -norm * (s * (d_across + across * lost) + ds * across)
        out[at + T] = q * norm * share
        ahead = unit * (c * share + dc * inverse)
        swing = rate * c * dturn
        out[at + X] = ahead * cosine - swing * sine
        out[at + Y] = ahead * sine + swing * cosine
        out[at + THETA] = unit * (s * share + ds * inverse)
        out[at + LENGTH] = ahead


@kernel
def advance(
    z: float, end: float, y: FloatArray, tableau: Tableau, section: FloatArray, work: FloatArray
) -> None:
    """A varied state (21,) from z to ``end``, in place; ``work`` (8, 21)."""
    state = work[_STAGES]
    while z < end:
        patience(1)
        variation_rates(z, y, section, work[0])
        h = end - z
        rate = abs(work[0, U])
        longest = min(_SHARE * distance_to_line(y[U], section) + _NEAREST, _LONGEST)
        if rate * h > longest:
            h = longest / rate
        for stage in range(1, _STAGES):
            for i in range(VARIED):
                total = 0.0
                for j in range(stage):
                    total += tableau.a[stage, j] * work[j, i]
                state[i] = y[i] + h * total
            variation_rates(z + tableau.c[stage] * h, state, section, work[stage])
        for i in range(VARIED):
            total = 0.0
            for j in range(_STAGES):
                total += tableau.b[j] * work[j, i]
            y[i] += h * total
        z = end if h == end - z else z + h


@inlined
def _to_the_stop(z: float, y: FloatArray, section: FloatArray, rates: FloatArray) -> None:
    """The last of the time, at constant angle; of all else too little is left to tell."""
    variation_rates(z, y, section, rates)
    # t goes on like q, so that dt/dz (1 − z)/4 is left
    share = 0.25 * (1.0 - z)
    for block in range(BLOCKS):
        y[block * KEPT + T] += share * rates[block * KEPT + T]


@kernel
def vary(
    z_path: FloatArray, u: float, tableau: Tableau, section: FloatArray, path: FloatArray,
    stop: FloatArray, work: FloatArray,
) -> None:  # fmt: skip
    """A motion from u₀ and its variations: at its step ends into ``path`` (n, 21), at the stop.

    ``z_path``: array (n,), where the steps of the motion end; ``u``: ln(rω/v) at the launch;
    ``section``: six functions, see
    :meth:`puck_tables.table.friction_section.FrictionSlopes.for_slopes`; ``path``: array (n, 21),
    or empty where nobody wants it; ``stop``: array (21,); ``work``: room (8, 21).
    """
    for i in range(VARIED):
        stop[i] = 0.0
    stop[U], stop[BY_U * KEPT + U] = u, 1.0
    for n in range(z_path.size):
        if n > 0:
            advance(z_path[n - 1], z_path[n], stop, tableau, section, work)
        if path.size > 0:
            for i in range(VARIED):
                path[n, i] = stop[i]
    z = z_path[-1]
    while 1.0 - z > _LAST:
        new = z + _TAIL_STEP * (1.0 - z)
        advance(z, new, stop, tableau, section, work)
        z = new
    _to_the_stop(z, stop, section, work[0])


@allocating
def fill_stop_variations(
    u: FloatArray, place_unit: FloatArray, delta: float, tableau: Tableau, tolerance: float,
    ratios: FloatArray, section: FloatArray, out: FloatArray,
) -> None:  # fmt: skip
    """Stops of launches at u (n,) and their variations into ``out`` (n, 21); NaN: no stop.

    ``ratios``, ``section``: friction for motions and for slopes, of one puck.  ``place_unit`` (n,)
    as :func:`puck_tables.motion.path.integrate` has it.
    """
    patience(u.size)
    z, y = np.empty(_STEP_LIMIT), np.empty((_STEP_LIMIT, SIZE))
    result, work = np.empty(SIZE + 1), np.empty((8, VARIED))
    nobody = np.empty((0, VARIED))
    for n in range(u.size):
        status, count = integrate(
            u[n], tableau, 0.0, tolerance, place_unit[n], ratios, delta, _STEP_LIMIT, z, y, result
        )
        if status == STOPPED:
            vary(z[:count], u[n], tableau, section, nobody, out[n], work)
        else:
            for i in range(VARIED):
                out[n, i] = math.nan


@allocating
def fill_state_variations(
    z: FloatArray, which: npt.NDArray[np.int64], z_path: FloatArray, path: FloatArray,
    stop: FloatArray, tableau: Tableau, section: FloatArray, out: FloatArray, rates: FloatArray,
) -> None:  # fmt: skip
    """Varied states at z (n,) of one motion into ``out`` (n, 21), and their d/dz into ``rates``.

    At rest, z = 1, that of the stop, and 0.  ``which`` (n,): the last step end before; ``path``,
    ``stop`` of :func:`vary`.
    """
    work = np.empty((8, VARIED))
    last = z_path.size - 1
    for n in range(z.size):
        patience(1)
        i, y = which[n], out[n]
        for j in range(VARIED):
            y[j] = path[i, j] if z[n] < 1.0 else stop[j]
            rates[n, j] = 0.0
        if z[n] == 1.0:
            continue
        if i < last:
            advance(z_path[i], z[n], y, tableau, section, work)
            variation_rates(z[n], y, section, rates[n])
            continue
        # at constant angle: the time that is left is like q
        variation_rates(z[n], y, section, rates[n])
        share = 0.25 * (1.0 - z[n])
        for block in range(BLOCKS):
            at = block * KEPT
            for j in range(T, KEPT):
                y[at + j] = stop[at + j]
            y[at + T] -= share * rates[n, at + T]

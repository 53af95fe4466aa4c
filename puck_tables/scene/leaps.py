"""A step from one kink of friction to the next, of a base on several frictions, by collocation.

Between two kinks friction is smooth in the graded time of :mod:`puck_tables.scene.grading`, and a
fast puck hardly changes its motion there: to integrate it is little more than a quadrature.  Rates
are looked up at Lobatto's points, where the motion was found to be before (Picard's iteration), and
integrated as a polynomial through them; each time at more points.  The error is what the last ones
have changed, times by how much less that was than the time before.  When the kink comes is foreseen
anew with every set of points, and the end of the step moved there.
"""

from __future__ import annotations

import math

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, inner
from puck_tables.scene.equations import ROW, SIZE, rates, rates_here
from puck_tables.scene.explicit import STAGES
from puck_tables.scene.friction import VX, X
from puck_tables.scene.grading import powers_of
from puck_tables.scene.ingredients import Stretch
from puck_tables.scene.kinks import next_kink

_DEGREES = (4, 8, 12, 16, 20, 24)  # of the polynomials, one after the other
_MOVES = 3  # places, and their velocities
_LEAST_GAIN = 0.03  # times the error before: better is not believed
_LEFT = 0.005  # of a step: from so close to its end the kink there is foreseen
_OFF = 0.1  # of a step: a kink farther off is another
_BEYOND = 5e-6  # of a step: so late it ends, so that the kink is passed
_STAYS = 3e-6  # of a step: nor is its end moved by less
_STATES = STAGES  # the first row of states, and
_RATES = _STATES + _DEGREES[-1] + 1  # that of rates
_FOUND = _RATES + _DEGREES[-1] + 1  # that of velocities anew,
_NEAR = _FOUND + _DEGREES[-1] + 1  # and that of rates next to the kink
WORK_ROWS = _NEAR + 1


def _points(degree: int) -> FloatArray:
    """Lobatto's, between 0 and 1."""
    slope = np.polynomial.legendre.Legendre.basis(degree).deriv()
    return 0.5 + 0.5 * np.concatenate([[-1.0], np.sort(slope.roots().real), [1.0]])


def _integrals(at: FloatArray, to: FloatArray) -> FloatArray:
    """What integrates the polynomial through values at some points from 0 to others."""
    basis = np.polynomial.legendre.legvander(2.0 * at - 1.0, len(at) - 1)
    upto = [
        0.5 * np.polynomial.legendre.Legendre.basis(k).integ(lbnd=-1.0)(2.0 * to - 1.0)
        for k in range(len(at))
    ]
    return np.asarray(np.linalg.solve(basis.T, np.array(upto)).T, np.float64)


_ALL = [_points(degree) for degree in _DEGREES]
_POINT = np.concatenate(_ALL)
_OWN = np.concatenate([_integrals(at, at).ravel() for at in _ALL])
_NEXT = np.concatenate([
    _integrals(at, to).ravel() for at, to in zip(_ALL, [*_ALL[1:], _ALL[-1]], strict=True)
])  # fmt: skip
_DEGREE = np.array(_DEGREES)


@inlined
def _moved(
    y: FloatArray, work: FloatArray, weights: FloatArray, row: int, points: int, out: int
) -> None:  # fmt: skip
    """Places and velocities at a point, from the rates at so many, into a row of states.

    By name, as in :mod:`puck_tables.scene.explicit`.
    """
    a, b, c = y[X], y[X + 1], y[X + 2]
    d, e, f = y[VX], y[VX + 1], y[VX + 2]
    for j in range(points):
        weight, at = weights[row + j], _RATES + j
        a, b, c = (
            a + weight * work[at, X], b + weight * work[at, X + 1], c + weight * work[at, X + 2]
        )  # fmt: skip
        d, e, f = (
            d + weight * work[at, VX], e + weight * work[at, VX + 1], f + weight * work[at, VX + 2]
        )  # fmt: skip
    work[out, X], work[out, X + 1], work[out, X + 2] = a, b, c
    work[out, VX], work[out, VX + 1], work[out, VX + 2] = d, e, f


@inner
def leap(
    stretch: Stretch, t: float, h: float, to_kink: bool, y: FloatArray, scale: FloatArray,
    work: FloatArray, new: FloatArray,
) -> tuple[float, float]:  # fmt: skip
    """A step from (t, y) over about h into ``new`` (12,); its error in ``scale``, and how long.

    As :func:`puck_tables.scene.steps.step`; ``to_kink``: its end is moved to the kink there, and
    it is given up where the points do not settle; its error then is inf.
    """
    slope, two, three, four = powers_of(stretch.grade)
    model, error, before = stretch.model, math.inf, math.inf
    points = _DEGREE[0] + 1
    for k in range(points):
        s = _POINT[k]
        gone = h * (s * (slope + s * (two + s * (three + s * four))))
        for i in range(_MOVES):
            work[_STATES + k, VX + i] = y[VX + i] + gone * work[0, VX + i]
            way = gone * (work[0, X + i] + 0.5 * gone * work[0, VX + i])
            work[_STATES + k, X + i] = y[X + i] + way
    for i in range(SIZE):
        new[i] = y[i] + h * work[0, i]
    first, own, onward = 0, 0, 0
    for level in range(_DEGREE.size):
        points = _DEGREE[level] + 1
        near = 1  # the last point from which on the kink is foreseen
        for j in range(points):
            s, row = _POINT[first + j], _RATES + j
            passed = s * (slope + s * (two + s * (three + s * four)))
            pace = h * (slope + s * (2.0 * two + s * (3.0 * three + s * (4.0 * four))))
            near = j if passed < 1.0 - _LEFT else near
            if j == 0:
                for i in range(ROW):
                    work[row, i] = work[0, i]
            elif pace > 1e-12 * h:
                rates_here(stretch, t + h * passed, work[_STATES + j], work, row)
            else:
                for i in range(ROW):
                    work[row, i] = 0.0
            if j == near:
                for i in range(ROW):
                    work[_NEAR, i] = work[row, i]
            for i in range(SIZE):
                work[row, i] *= pace
        # velocities, and by these the rates of places
        for k in range(1, points, 2):
            other = min(k + 1, points - 1)
            row, more = own + k * points, own + other * points
            a, b, c, d, e, f = y[VX], y[VX + 1], y[VX + 2], y[VX], y[VX + 1], y[VX + 2]
            for j in range(points):
                at, weight, second = _RATES + j, _OWN[row + j], _OWN[more + j]
                u, v, w = work[at, VX], work[at, VX + 1], work[at, VX + 2]
                a, b, c = a + weight * u, b + weight * v, c + weight * w
                d, e, f = d + second * u, e + second * v, f + second * w
            work[_FOUND + k, 0], work[_FOUND + k, 1], work[_FOUND + k, 2] = a, b, c
            work[_FOUND + other, 0], work[_FOUND + other, 1] = d, e
            work[_FOUND + other, 2] = f
        for k in range(1, points):
            s, row, state = _POINT[first + k], _RATES + k, _STATES + k
            pace = h * (slope + s * (2.0 * two + s * (3.0 * three + s * (4.0 * four))))
            for i in range(_MOVES):
                work[row, X + i] += pace * (work[_FOUND + k, i] - work[state, VX + i])
                work[state, VX + i] = work[_FOUND + k, i]
        if to_kink:
            s, state = _POINT[first + near], _STATES + near
            passed = s * (slope + s * (two + s * (three + s * four)))
            _moved(y, work, _OWN, own + near * points, points, state)
            left = next_kink(
                stretch.dry.by_speed.table, model.body.radius, model.surface, work[state],
                work[_NEAR], 0.0,
            )  # fmt: skip
            longer = passed + left / h + _BEYOND
            if _STAYS < abs(longer - 1.0) <= _OFF:
                for k in range(points):
                    s, row, state = _POINT[first + k], _RATES + k, _STATES + k
                    pace = slope + s * (2.0 * two + s * (3.0 * three + s * (4.0 * four)))
                    pace *= h * (longer - 1.0)
                    for i in range(_MOVES):
                        work[row, X + i] += pace * (work[state, VX + i] - y[VX + i])
                    for i in range(SIZE):
                        work[row, i] *= longer
                h *= longer
        change, last = 0.0, own + (points - 1) * points
        for i in range(SIZE):
            gone = 0.0
            for j in range(points):
                gone += _OWN[last + j] * work[_RATES + j, i]
            off = abs(y[i] + gone - new[i]) / scale[i]
            change = change if off <= change else off  # also where it is no number
            new[i] = y[i] + gone
            if i < 2:
                new[SIZE + i] = gone
        gain = change / before if level > 0 else 1.0
        error = 0.0 if change == 0.0 else max(gain, _LEAST_GAIN) * change
        before = change
        to_come = _DEGREE.size - 1 - level
        if error <= stretch.leap or to_come == 0:
            break
        if to_kink and level > 1 and not error * gain**to_come <= stretch.leap:
            error = math.inf
            break
        after = _DEGREE[level + 1] + 1
        for k in range(after):
            _moved(y, work, _NEXT, onward + k * points, points, _STATES + k)
        first, own, onward = first + points, own + points * points, onward + points * after
    rates(stretch, t + h, new, work, STAGES - 1)
    return error, h
